//! `zelus import` and `zelus convert`: meshes from one format to another, surfaces as STL, and results of many files to one.

use std::path::PathBuf;

use zelus_core::Result;
use zelus_core::diagnostics::{Diagnostic, Place};
use zelus_core::io::Mark;
use zelus_core::io::mdpa::MdpaDocument;
use zelus_core::parameters::{Node, Object, Value};
use zelus_meshes::{RESULTS, format, write_stl};

use super::report::check_output;
use super::say::say;

/// The command line of `zelus import`.
#[derive(Debug, clap::Args)]
pub(super) struct Import {
    /// The mesh, e.g. part.msh, part.inp or part.vtu.
    file: PathBuf,
    /// The mesh file to write; by default beside the input, with the ending .mdpa.
    #[arg(short, long)]
    output: Option<PathBuf>,
    #[command(flatten)]
    how: How,
}

/// The command line of `zelus convert`.
#[derive(Debug, clap::Args)]
pub(super) struct Convert {
    /// The mesh to read, or the results (.pvd) of a run.
    from: PathBuf,
    /// The mesh to write; its ending selects the format. The surface of bodies goes into a file that ends in .stl. The results of all steps
    /// go into a file that ends in .vtkhdf, or in .xdmf with its numbers in one that ends in .h5.
    to: PathBuf,
    /// The part whose surface an STL file gets, by default the whole mesh.
    #[arg(long, value_name = "NAME")]
    part: Option<String>,
    #[command(flatten)]
    how: How,
}

/// How a mesh is read.
#[derive(Debug, clap::Args)]
struct How {
    /// The format of the mesh, whatever its ending; `zelus list mesh_format` shows them.
    #[arg(long)]
    format: Option<String>,
    /// Beginning of the names of elements, e.g. TotalLagrangianElement.
    #[arg(long, value_name = "NAME")]
    element_name: Option<String>,
    /// Beginning of the names of conditions, e.g. ThermalFace.
    #[arg(long, value_name = "NAME")]
    condition_name: Option<String>,
}

/// Writes a mesh of another program as an mdpa file.
pub(super) fn import(arguments: Import) -> Result<()> {
    let Import { file, output, how } = arguments;
    let to = output.unwrap_or_else(|| file.with_extension("mdpa"));
    convert(&Convert { from: file, to, part: None, how })
}

/// Writes a mesh in the format of the ending of its new name.
pub(super) fn convert(arguments: &Convert) -> Result<()> {
    let (from, to) = (&arguments.from, &arguments.to);
    let ending = to.extension().and_then(|ending| ending.to_str());
    if let Some((_, write)) = RESULTS.iter().find(|(known, _)| Some(*known) == ending) {
        check_output("the results", to, &[from], Mark::None)?;
        let steps = write(from, to)?;
        say(&format!("written: {}, {steps} steps", to.display()));
        return Ok(());
    }
    check_output("the mesh", to, &[from], Mark::None)?;
    if ending.is_some_and(|ending| ending.eq_ignore_ascii_case("stl")) {
        let (document, said) = read(arguments)?;
        said.iter().for_each(|problem| say(&problem.to_string()));
        let triangles = write_stl(&document, arguments.part.as_deref(), to)?;
        say(&format!("written: {}, {triangles} triangles", to.display()));
        return Ok(());
    }
    if arguments.part.is_some() {
        let problem = Diagnostic::error("mesh-format", format!("{} takes no part alone", to.display()));
        return Err(problem.remedy("write an STL file (.stl), or leave --part out").into());
    }
    let target = format(to, None)?;
    let write = target.write.ok_or_else(|| {
        let fact = format!("meshes of the format {} are read only", target.name);
        Diagnostic::error("mesh-format", fact).remedy("write .mdpa, .msh, .inp, .vtu or .stl")
    })?;
    let (document, mut said) = read(arguments)?;
    said.extend(write(&document, to)?);
    said.iter().for_each(|problem| say(&problem.to_string()));
    say(&counts(&document));
    say(&format!("written: {}", to.display()));
    Ok(())
}

fn read(arguments: &Convert) -> Result<(MdpaDocument, Vec<Diagnostic>)> {
    let (from, how) = (&arguments.from, &arguments.how);
    let source = format(from, how.format.as_deref())?;
    if !from.is_file() {
        return Err(Diagnostic::error("missing-file", format!("there is no mesh file {}", from.display())).into());
    }
    let place = Place::file(from);
    let mut given = Object::default();
    for (key, value) in [("element_name", &how.element_name), ("condition_name", &how.condition_name)] {
        if let Some(name) = value {
            let json = serde_json::json!({ key: name });
            let member = Node::from_json(&json, &place)?;
            member.as_object().into_iter().flat_map(Object::iter).for_each(|member| given.insert(member.clone()));
        }
    }
    (source.build)(from, &source.settings(&Node::new(Value::Object(given), &place))?)
}

/// Entities of a document, as a count in words.
pub(super) fn counts(document: &MdpaDocument) -> String {
    let mut out = format!("{} nodes", document.nodes.ids.len());
    for block in document.elements.iter().chain(&document.conditions) {
        out += &format!(", {} {}", block.ids.len(), block.name);
    }
    for part in &document.sub_model_parts {
        let held =
            [(part.elements.len(), "elements"), (part.conditions.len(), "conditions"), (part.nodes.len(), "nodes")];
        let held = held.iter().filter(|(count, _)| *count > 0).map(|(count, what)| format!("{count} {what}"));
        out += &format!("\n  part {}: {}", part.name, held.collect::<Vec<_>>().join(", "));
    }
    out
}
