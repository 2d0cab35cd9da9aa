//! Formats of mesh files, found by the name that decks give as `"input_type"`.

use std::path::{Path, PathBuf};

use super::import::{entity_names, import};
use super::mdpa::{self, MdpaDocument};
use crate::diagnostics::{Diagnostic, Place, Result};
use crate::model::ModelPart;
use crate::parameters::{Defaults, Node, Object, Settings, Value};
use crate::{register, registered_kind, registry};

/// Reads a file into a document whose ids are unique and whose references go to existing entities; gives the warnings with it. The
/// settings are those of the format.
pub type MeshReader = fn(&Path, &Settings) -> Result<(MdpaDocument, Vec<Diagnostic>)>;

/// Writes a document; warns of contents that the format cannot hold.
pub type MeshWriter = fn(&MdpaDocument, &Path) -> Result<Vec<Diagnostic>>;

registered_kind! {
    /// A format of mesh files, named by `"input_type"` and by the endings of its files.
    pub struct MeshFormatEntry("mesh_format", "input-type") {
        build: MeshReader;
        /// Endings of its files, without the dot.
        endings: &'static [&'static str] = &[],
        /// Function that writes it; `None` where it is read only.
        write: Option<MeshWriter> = None,
    }
}

impl MeshFormatEntry {
    /// The file that a deck names, with or without ending.
    pub fn file(&self, named: &Path) -> PathBuf {
        let has_ending = |ending: &&str| named.extension().is_some_and(|own| own.eq_ignore_ascii_case(ending));
        let mut name = named.as_os_str().to_owned();
        if let (false, Some(first)) = (self.endings.iter().any(has_ending), self.endings.first()) {
            name.push(".");
            name.push(first);
        }
        name.into()
    }

    /// Its settings: those of its keys that `given` has, over its defaults.
    ///
    /// # Errors
    /// Values of another type.
    pub fn settings(&self, given: &Node) -> Result<Settings> {
        let defaults = Defaults::parse(self.name, if self.defaults.is_empty() { "{}" } else { self.defaults })?;
        let is_own = |key: &str| defaults.entries().iter().any(|entry| entry.path == key);
        let members = given.as_object().into_iter().flat_map(Object::iter).filter(|member| is_own(&member.key));
        let own = Node::new(Value::Object(Object::from_members(members.cloned().collect())), &given.place());
        Ok(Settings::check(&own, &defaults)?.0)
    }
}

/// The format of a file by its ending.
pub fn format_of(path: &Path) -> Option<&'static MeshFormatEntry> {
    let ending = path.extension()?;
    let is_called = |format: &&MeshFormatEntry| format.endings.iter().any(|own| ending.eq_ignore_ascii_case(own));
    registry::all::<MeshFormatEntry>().into_iter().find(is_called)
}

/// Reads the mesh file that a deck names at `place` into `part`, in the format `format` with the settings `given`;
/// gives the warnings. Columns the part already has are kept and made longer.
///
/// # Errors
/// No such file; faults of the format; names that are not registered.
pub fn read_mesh_as(
    format: &MeshFormatEntry,
    given: &Node,
    path: &Path,
    place: &Place,
    part: &mut ModelPart,
) -> Result<Vec<Diagnostic>> {
    let path = &format.file(path);
    if !path.is_file() {
        return Err(Diagnostic::error("missing-file", format!("there is no mesh file {}", path.display()))
            .at(place.clone())
            .remedy("\"input_filename\" is relative to the deck and has no extension")
            .into());
    }
    let (document, mut warnings) = (format.build)(path, &format.settings(given)?)?;
    warnings.extend(import(&document, part)?);
    Ok(warnings)
}

fn read(path: &Path, _: &Settings) -> Result<(MdpaDocument, Vec<Diagnostic>)> {
    entity_names(|names| mdpa::read(path, names))
}

fn write(document: &MdpaDocument, path: &Path) -> Result<Vec<Diagnostic>> {
    mdpa::write(document, path).map(|()| Vec::new())
}

register! { MeshFormatEntry "mdpa",
    about: "the mesh file of Kratos: nodes, elements and conditions by name, sub model parts, values",
    source: "docs/mdpa.md",
    build: read,
    endings: &["mdpa"],
    write: Some(write),
}
