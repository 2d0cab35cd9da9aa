//! Results for GiD as text: a mesh file and a results file, or one pair a step.

use std::io::Write;
use std::path::PathBuf;

use serde::{Deserialize, Serialize};
use zelus_linear_algebra::{State, StateMapper, stored_as_bytes};

use super::control::OutputControl;
use super::gauss;
use super::output_columns::{CellChoice, Mesh};
use super::part_path::{NO_STEP, PartPath, append, no_output, one_of, warn_unused};
use super::quantity::{GaussQuantity, Quantity, flag_column, flag_list};
use crate::assembly::System;
use crate::communication::Ranks;
use crate::diagnostics::{Diagnostic, Result, unfit};
use crate::io::results::{
    Column, Dataset, GaussResult, GidKind, write_gid_mesh, write_gid_results_head, write_gid_step,
};
use crate::io::{FileUse, Mark, append_to_file, cut_file, length_of, replace_file};
use crate::model::{EntityRole, Model, ModelPart, SubPart};
use crate::parameters::{Defaults, Settings};
use crate::processes::{Process, ProcessEntry, ProcessRequest};
use crate::register;

/// Where the settings of the files are in `Parameters`.
const FILES: &str = "postprocess_parameters.result_file_configuration.";

/// Takes the mesh before the loop and writes it with the first results.
struct GidOutput {
    part: PartPath,
    control: OutputControl,
    /// Path of the files without their endings.
    base: PathBuf,
    folder: PathBuf,
    by_time: bool,
    single: bool,
    deformed: bool,
    elements: bool,
    conditions: bool,
    body: bool,
    history: Vec<Quantity>,
    values: Vec<Quantity>,
    flags: Vec<&'static str>,
    gauss: Vec<GaussQuantity>,
    written: Vec<PathBuf>,
    messages: Vec<Diagnostic>,
    /// The meshes of the one file for all steps, until the first is written.
    first: Option<Vec<(GidKind, Dataset)>>,
}

fn build(request: &mut ProcessRequest<'_>) -> Result<Box<dyn Process>> {
    let adapt = |defaults: Defaults| {
        defaults.require(&["model_part_name", "output_name"]).renamed(
            "postprocess_parameters.result_file_configuration.output_frequency",
            "postprocess_parameters.result_file_configuration.output_interval",
        )
    };
    let settings = &request.settings_with(adapt)?;
    let key = |name: &str| format!("{FILES}{name}");
    let flag = |name: &str| format!("{FILES}gidpost_flags.{name}");
    warnings(settings, request)?;
    let deformed = one_of(settings, &flag("WriteDeformedMeshFlag"), &["WriteUndeformed", "WriteDeformed"])? == 1;
    let parts = ["WriteElementsOnly", "WriteConditions", "WriteConditionsOnly"];
    let cells = one_of(settings, &flag("WriteConditionsFlag"), &parts)?;
    Ok(Box::new(GidOutput {
        part: PartPath::new(settings)?,
        control: OutputControl::new(settings, FILES)?,
        base: request.results.join(settings.get_str("output_name")?),
        folder: request.results.into(),
        by_time: one_of(settings, &key("file_label"), &["step", "time"])? == 1,
        single: one_of(settings, &flag("MultiFileFlag"), &["SingleFile", "MultipleFiles"])? == 0,
        deformed,
        elements: cells != 2,
        conditions: cells != 0,
        body: settings.get_bool(&key("body_output"))?,
        history: Quantity::shown(settings, &key("nodal_results"), request.report)?,
        values: Quantity::shown(settings, &key("nodal_nonhistorical_results"), request.report)?,
        flags: flag_list(settings, &key("nodal_flags_results"), request.report)?,
        gauss: GaussQuantity::shown(settings, &key("gauss_point_results"), request.report)?,
        written: Vec::new(),
        messages: Vec::new(),
        first: None,
    }))
}

fn warnings(settings: &Settings, request: &mut ProcessRequest<'_>) -> Result<()> {
    let mode = format!("{FILES}gidpost_flags.GiDPostMode");
    let modes = ["GiD_PostBinary", "GiD_PostAscii", "GiD_PostAsciiZipped", "GiD_PostHDF5"];
    if one_of(settings, &mode, &modes)? != 1 {
        let fact = format!("\"{}\" is written as text (.post.msh, .post.res)", settings.get_str(&mode)?);
        let problem = Diagnostic::warning("gid-text", fact).at(settings.key_place(&mode));
        request.report.push(problem.remedy("GiD reads both; write \"GiD_PostAscii\" to say so"));
    }
    let lists = ["plane_output", "elemental_conditional_flags_results", "additional_list_files"];
    let mut lists = lists.map(|key| format!("{FILES}{key}")).to_vec();
    lists.push("postprocess_parameters.point_data_configuration".to_owned());
    for key in lists {
        if !settings.items(&key)?.is_empty() {
            request.report.push(warn_unused(settings, &key, "cuts, points and flags of entities are not written"));
        }
    }
    let skin = format!("{FILES}skin_output");
    if settings.get_bool(&skin)? {
        request.report.push(warn_unused(settings, &skin, "the skin is not written"));
    }
    Ok(())
}

impl GidOutput {
    /// The file with an ending, with the label where every step has its own.
    fn path(&self, label: f64, ending: &str) -> PathBuf {
        let label = if self.single { String::new() } else { format!("_{label}") };
        append(&self.base, &format!("{label}.post.{ending}"))
    }

    /// Meshes of elements and conditions; of several ranks the first has them. Collective.
    fn meshes(&self, part: &ModelPart, selection: &SubPart) -> Vec<(GidKind, Dataset)> {
        let mut drawn = SubPart { children: Default::default(), ..selection.clone() };
        if self.conditions {
            drawn.nodes.extend(selection.conditions.iter().flat_map(|&c| part.conditions.nodes(c)));
        }
        let kinds = [
            (self.elements, CellChoice::Elements, GidKind::Element),
            (self.conditions, CellChoice::Conditions, GidKind::Condition),
        ];
        let mesh = |choice| Mesh::new(part, &drawn, choice, self.deformed).data;
        let whole = |mesh: Dataset| if part.share.is_some() { mesh.gathered(&part.ranks) } else { mesh };
        let wanted = kinds.into_iter().filter(|(wanted, ..)| *wanted);
        wanted.map(|(_, choice, kind)| (kind, whole(mesh(choice)))).collect()
    }

    /// Writes the file of the mesh; collective.
    fn write_mesh(&self, ranks: &Ranks, meshes: &[(GidKind, Dataset)], label: f64) -> Result<()> {
        replace_file(ranks, &self.path(label, "msh"), |out| {
            // GiD reads the points of all with the first that has cells.
            let mut with_points = true;
            for (kind, mesh) in meshes {
                write_gid_mesh(out, mesh, *kind, with_points)?;
                with_points &= mesh.cells.is_empty();
            }
            Ok(())
        })
    }

    /// The results to show; of several ranks the first has them. Collective.
    fn results(
        &self,
        part: &ModelPart,
        system: &System,
        selection: &SubPart,
    ) -> (Vec<usize>, Vec<Column>, Vec<GaussResult>) {
        let own = selection.nodes.iter().copied().filter(|&node| part.owns_node(node as usize));
        let nodes = &own.collect::<Vec<u32>>();
        let mut columns: Vec<Column> = Vec::new();
        columns.extend(self.history.iter().map(|q| q.gather(&part.nodes.history, nodes)));
        columns.extend(self.values.iter().map(|q| q.gather(&part.nodes.values, nodes)));
        columns.extend(self.flags.iter().map(|flag| flag_column(&part.nodes.flags, flag, nodes)));
        let gauss = self.gauss.iter().flat_map(|quantity| {
            gauss::as_they_are(part, system, EntityRole::Element, &selection.elements, &part.elements.ids, quantity)
        });
        let gauss = if self.elements { gauss.collect() } else { Vec::new() };
        let ids: Vec<usize> = nodes.iter().map(|&node| part.nodes.ids[node as usize]).collect();
        if part.share.is_none() {
            return (ids, columns, gauss);
        }
        let points = vec![[0.0; 3]; ids.len()];
        let shown = Dataset { point_ids: ids, points, point_data: columns, ..Dataset::default() }.gathered(&part.ranks);
        (shown.point_ids, shown.point_data, gauss)
    }

    fn label(&self, part: &ModelPart) -> f64 {
        if self.by_time { part.info.time } else { part.info.step as f64 }
    }

    /// The file that tells GiD which files belong together.
    fn write_list(&self, ranks: &Ranks) -> Result<()> {
        let folder = std::path::absolute(&self.folder).unwrap_or_else(|_| self.folder.clone());
        let name = folder.file_name().map_or_else(|| "results".into(), |name| name.to_string_lossy().into_owned());
        let kind = if self.single { "Single" } else { "Multiple" };
        replace_file(ranks, &self.folder.join(format!("{name}.post.lst")), |out| {
            writeln!(out, "{kind}")?;
            for path in &self.written {
                writeln!(out, "{}", path.strip_prefix(&self.folder).unwrap_or(path).display())?;
            }
            Ok(())
        })
    }
}

/// Files of results so far, with their lengths, and when output is wanted next.
#[derive(Serialize, Deserialize)]
#[serde(remote = "Self")]
struct GidOutputState {
    written: Vec<(PathBuf, u64)>,
    next: f64,
}

stored_as_bytes!(GidOutputState);

#[typetag::serde(name = "gid_output")]
impl State for GidOutputState {
    fn remap(&mut self, _mapper: &mut dyn StateMapper) {}
}

impl Process for GidOutput {
    fn drives(&self, _part: &ModelPart, _system: &System) -> bool {
        false
    }

    fn initialize(&mut self, model: &mut Model) -> Result<()> {
        self.part.find(model).map(|_| ())
    }

    fn before_loop(&mut self, model: &mut Model) -> Result<()> {
        let (part, selection) = self.part.find(model)?;
        if self.single && self.body {
            self.first = Some(self.meshes(part, selection));
        }
        Ok(())
    }

    fn is_output_step(&mut self, model: &Model) -> bool {
        self.body && self.part.find(model).is_ok_and(|(part, _)| self.control.wants(&part.info))
    }

    fn print_output(&mut self, model: &mut Model, system: &System) -> Result<()> {
        let (part, selection) = self.part.find(model)?;
        let label = self.label(part);
        let (ids, columns, gauss) = self.results(part, system, selection);
        let path = self.path(label, "res");
        if self.written.is_empty() {
            let by = "gid_output_process";
            let of_nodes = self.history.iter().chain(&self.values).filter_map(|own| own.missing_at_nodes(part, by));
            let missing = of_nodes.chain(self.gauss.iter().filter_map(|own| own.missing(part, system, by)));
            self.messages = missing.map(|warning| warning.at(self.part.place.clone())).collect();
        }
        if !self.single {
            self.write_mesh(&part.ranks, &self.meshes(part, selection), label)?;
        } else if self.written.is_empty() {
            let meshes = self.first.take().unwrap_or_else(|| self.meshes(part, selection));
            self.write_mesh(&part.ranks, &meshes, label)?;
        }
        if self.written.contains(&path) {
            append_to_file(&part.ranks, &path, |out| write_gid_step(out, label, &ids, &columns, &gauss))?;
        } else {
            replace_file(&part.ranks, &path, |out| {
                write_gid_results_head(out, &gauss)?;
                write_gid_step(out, label, &ids, &columns, &gauss)
            })?;
            self.written.push(path);
            self.write_list(&part.ranks)?;
        }
        self.control.written(&part.info);
        Ok(())
    }

    fn messages(&mut self) -> Vec<Diagnostic> {
        std::mem::take(&mut self.messages)
    }

    fn last_messages(&self, _model: &Model) -> Vec<Diagnostic> {
        let is_idle = self.body && self.written.is_empty();
        is_idle.then(|| no_output("gid_output_process", NO_STEP, &self.part.place)).into_iter().collect()
    }

    fn state(&self) -> Option<Box<dyn State>> {
        let written = self.written.iter().map(|path| (path.clone(), length_of(path))).collect();
        Some(Box::new(GidOutputState { written, next: self.control.next }))
    }

    fn resume(&mut self, model: &mut Model, state: Box<dyn State>) -> Result<()> {
        let GidOutputState { written, next } = state.take()?;
        if !written.iter().all(|(path, _)| path.to_string_lossy().starts_with(&*self.base.to_string_lossy())) {
            return Err(unfit("it names files of results that are none of this run"));
        }
        written.iter().try_for_each(|(path, length)| cut_file(&model.ranks, path, *length))?;
        self.written = written.into_iter().map(|(path, _)| path).collect();
        self.control.next = next;
        Ok(())
    }

    fn files(&self) -> Vec<FileUse> {
        vec![FileUse::WritesSeries(append(&self.base, ".post.res"), Mark::Begins(&["GiD Post Results File"]))]
    }

    fn outputs(&self) -> Vec<PathBuf> {
        self.written.first().cloned().into_iter().collect()
    }
}

register! { ProcessEntry "gid_output_process",
    aliases: &["GiDOutputProcess"],
    about: "writes text files for GiD: mesh (.post.msh) and results (.post.res)",
    defaults: include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../configs/processes/gid_output_process.json")),
    build: build,
}
