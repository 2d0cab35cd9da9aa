//! Pictures for ParaView: `vtk_output_process` in Kratos' legacy form, `vtu_output_process` compressed with a PVD series.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use zelus_linear_algebra::{State, StateMapper, stored_as_bytes};

use super::control::{IntervalUnit, OutputControl};
use super::format::{OutputFormat, OutputFormatEntry, OutputFrame, SurfaceFrame, surface_series};
use super::output_columns::OutputColumns;
use super::part_path::{NO_STEP, PartPath, no_output};
use super::surfaces::surfaces;
use crate::assembly::System;
use crate::diagnostics::{Diagnostic, Place, Report, Result};
use crate::io::results::Dataset;
use crate::io::{FileUse, remove_series};
use crate::model::{Model, ModelPart, SubPart};
use crate::parameters::Defaults;
use crate::processes::{Process, ProcessEntry, ProcessRequest};
use crate::register;
use crate::registry::require;

/// Writes one file a step and part.
struct VtkOutput {
    part: PartPath,
    control: OutputControl,
    picture: OutputColumns,
    /// The state at the start until the first step is done: results of an earlier run stay as long.
    start: Vec<PartFrame>,
    format: Box<dyn OutputFormat>,
    /// The same for the last iterate of a step that has failed.
    format_of_failure: Box<dyn OutputFormat>,
    folder: PathBuf,
    /// Whether that folder is the pictures' own.
    in_folder: bool,
    /// Whether pictures of an earlier run are still to be removed.
    clears: bool,
    /// Whether the pictures of steps have points; `None` before the first.
    has_points: Option<bool>,
    messages: Vec<Diagnostic>,
    prefix: String,
    postfix: String,
    decimals: usize,
    sub_parts: bool,
    /// Place of the key that asks for the surfaces of interfaces; `None` where they are not written.
    surfaces: Option<Place>,
}

/// The picture of a part at a time.
struct PartFrame {
    path: String,
    data: Dataset,
    surfaces: Vec<SurfaceFrame>,
    time: f64,
    label: String,
}

fn adapt(defaults: Defaults) -> Defaults {
    defaults
        .require(&["model_part_name"])
        .renamed("output_frequency", "output_interval")
        .renamed("folder_name", "output_path")
        .renamed("write_properties_id", "write_ids")
        .renamed("gauss_point_variables", "gauss_point_variables_extrapolated_to_nodes")
}

fn build(request: &mut ProcessRequest<'_>, is_vtu: bool) -> Result<Box<dyn Process>> {
    let settings = &request.settings_with(adapt)?;
    let decimals = settings.get_usize("output_precision")?;
    let format = if is_vtu { "vtu" } else { settings.get_str("file_format")? };
    let format = require::<OutputFormatEntry>(format).map_err(|d| d.at(settings.key_place("file_format")))?;
    let in_folder = settings.get_bool("save_output_files_in_folder")?;
    let results = request.results;
    let surfaces = settings.get_bool("interface_surfaces")?.then(|| settings.key_place("interface_surfaces"));
    let (name, format, format_of_failure) = (format.name, (format.build)(settings)?, (format.build)(settings)?);
    if let Some(place) = surfaces.as_ref().filter(|_| !format.has_surfaces()) {
        let fact = format!("\"interface_surfaces\": files of the format \"{name}\" hold no surfaces of interfaces");
        let remedy = "use vtu_output_process, or \"file_format\": \"vtu\"";
        return Err(Diagnostic::error("no-interface-surfaces", fact).at(place.clone()).remedy(remedy).into());
    }
    let folder = if in_folder { results.join(settings.get_str("output_path")?) } else { results.into() };
    Ok(Box::new(VtkOutput {
        part: PartPath::new(settings)?,
        control: OutputControl::new(settings, "")?,
        picture: OutputColumns::new(settings, request.report)?,
        start: Vec::new(),
        format,
        format_of_failure,
        folder,
        in_folder,
        clears: in_folder,
        has_points: None,
        messages: Vec::new(),
        prefix: settings.get_str("custom_name_prefix")?.to_owned(),
        postfix: settings.get_str("custom_name_postfix")?.to_owned(),
        decimals,
        sub_parts: settings.get_bool("output_sub_model_parts")?,
        surfaces,
    }))
}

impl VtkOutput {
    /// Folder of the last iterate of a step that has failed.
    fn folder_of_failure(&self) -> PathBuf {
        let Some(name) = self.folder.file_name().filter(|_| self.in_folder) else {
            return self.folder.join("last_iterate");
        };
        self.folder.with_file_name(format!("{}_last_iterate", name.to_string_lossy()))
    }

    /// Pictures of the part, and of its sub parts where the deck asks for them. Collective.
    fn draw(&self, model: &Model, system: &System) -> Result<Vec<PartFrame>> {
        let (part, selection) = self.part.find(model)?;
        let label = match self.control.unit {
            IntervalUnit::Step => part.info.step.to_string(),
            IntervalUnit::Time => format!("{:.*}", self.decimals, part.info.time),
        };
        let drawn = |selection: &SubPart, path: String, surfaces: Vec<SurfaceFrame>| PartFrame {
            path,
            data: self.picture.draw(part, system, selection).data,
            surfaces,
            time: part.info.time,
            label: label.clone(),
        };
        let surfaces = match self.surfaces {
            Some(_) => surfaces(part, selection, self.picture.deformed),
            None => Vec::new(),
        };
        let mut all = vec![drawn(selection, self.part.path.clone(), surfaces)];
        for (name, child) in selection.children.iter().filter(|_| self.sub_parts) {
            let is_here = !child.nodes.is_empty() || !child.elements.is_empty() || !child.conditions.is_empty();
            if part.ranks.any(is_here) {
                all.push(drawn(child, format!("{}.{name}", self.part.path), Vec::new()));
            }
        }
        Ok(all)
    }

    /// Writes pictures; those of an earlier run go first. Collective.
    fn write(&mut self, model: &Model, pictures: &[PartFrame]) -> Result<()> {
        let (part, _) = self.part.find(model)?;
        for PartFrame { path, data, surfaces, time, label } in pictures {
            if self.clears {
                part.ranks.on_root(|| {
                    [self.folder.clone(), self.folder_of_failure()].iter().try_for_each(|own| self.clear(own, path))
                })?;
            }
            let (series, folder) = (self.series(path), &self.folder);
            self.format.write(&OutputFrame { part, data, surfaces, time: *time, folder, series: &series, label })?;
        }
        Ok(())
    }

    /// Writes the state at the start, where it waits. Collective.
    fn write_start(&mut self, model: &Model) -> Result<()> {
        let start = std::mem::take(&mut self.start);
        if !start.is_empty() {
            self.write(model, &start)?;
            self.clears = false;
        }
        Ok(())
    }

    /// The name of the pictures of a part.
    fn series(&self, path: &str) -> String {
        format!("{}{}{}", self.prefix, path.replace('.', "_"), self.postfix)
    }

    /// Removes the pictures that an earlier run has made of a part and of its interfaces, so that none is taken for one of this run.
    fn clear(&self, folder: &Path, path: &str) -> Result<()> {
        let series = self.series(path);
        remove_series(folder, &series, self.format.endings())?;
        remove_series(folder, &surface_series(&series), self.format.endings())
    }
}

/// Time of the next output, and the state of the format.
#[derive(Serialize, Deserialize)]
#[serde(remote = "Self")]
struct VtkOutputState {
    next: f64,
    clears: bool,
    format: Option<Box<dyn State>>,
}

stored_as_bytes!(VtkOutputState);

#[typetag::serde(name = "vtk_output")]
impl State for VtkOutputState {
    fn remap(&mut self, mapper: &mut dyn StateMapper) {
        self.format.iter_mut().for_each(|state| state.remap(mapper));
    }
}

impl Process for VtkOutput {
    fn drives(&self, _part: &ModelPart, _system: &System) -> bool {
        false
    }

    fn initialize(&mut self, model: &mut Model) -> Result<()> {
        self.part.find(model).map(|_| ())
    }

    fn check(&self, model: &Model, system: &System, warnings: &mut Report) -> Result<()> {
        let (part, selection) = self.part.find(model)?;
        self.picture.check(part, system).into_iter().for_each(|problem| warnings.push(problem));
        if let Some(place) = self.surfaces.as_ref().filter(|_| surfaces(part, selection, false).is_empty()) {
            let fact = format!("\"interface_surfaces\": {} has no facets with slave nodes", self.part.path);
            let remedy = "pairs of contact and ties by multipliers have surfaces, linear constraints have none";
            let warning = Diagnostic::warning("no-interface-surfaces", format!("{fact}, and no surface is written"));
            warnings.push(warning.at(place.clone()).remedy(remedy));
        }
        Ok(())
    }

    fn print_start(&mut self, model: &mut Model, system: &System) -> Result<()> {
        if self.picture.usual {
            self.start = self.draw(model, system)?;
        }
        Ok(())
    }

    fn end_step(&mut self, model: &mut Model, _system: &System) -> Result<()> {
        self.write_start(model)
    }

    fn is_output_step(&mut self, model: &Model) -> bool {
        self.part.find(model).is_ok_and(|(part, _)| self.control.wants(&part.info))
    }

    fn print_output(&mut self, model: &mut Model, system: &System) -> Result<()> {
        let pictures = self.draw(model, system)?;
        self.write(model, &pictures)?;
        if self.has_points.is_none() {
            let part = self.part.find(model)?.0;
            self.has_points = Some(part.ranks.any(pictures.iter().any(|picture| !picture.data.points.is_empty())));
            let missing = self.picture.missing(part, system).into_iter();
            self.messages.extend(missing.map(|warning| warning.at(self.part.place.clone())));
        }
        self.clears = false;
        self.control.written(&self.part.find(model)?.0.info);
        Ok(())
    }

    fn print_last_iterate(&mut self, model: &mut Model, system: &System) -> Result<Option<PathBuf>> {
        let pictures = self.draw(model, system)?;
        let (folder, failed) = (self.folder.clone(), self.folder_of_failure());
        let clears = std::mem::replace(&mut self.clears, false);
        self.folder.clone_from(&failed);
        std::mem::swap(&mut self.format, &mut self.format_of_failure);
        let written = self.write(model, &pictures);
        std::mem::swap(&mut self.format, &mut self.format_of_failure);
        (self.folder, self.clears) = (folder, clears);
        written.map(|()| Some(failed))
    }

    fn finalize(&mut self, model: &mut Model) -> Result<()> {
        let (part, _) = self.part.find(model)?;
        if part.ranks.is_root() { self.format.finish(&self.folder) } else { Ok(()) }
    }

    /// Formats have pictures to add yet.
    fn suspend(&mut self, _model: &mut Model) -> Result<()> {
        Ok(())
    }

    fn messages(&mut self) -> Vec<Diagnostic> {
        std::mem::take(&mut self.messages)
    }

    fn last_messages(&self, _model: &Model) -> Vec<Diagnostic> {
        let why = match self.has_points {
            Some(true) => return Vec::new(),
            Some(false) => "its part has no nodes",
            None => NO_STEP,
        };
        vec![no_output("output of pictures", why, &self.part.place)]
    }

    fn state(&self) -> Option<Box<dyn State>> {
        Some(Box::new(VtkOutputState { next: self.control.next, clears: self.clears, format: self.format.state() }))
    }

    fn resume(&mut self, _model: &mut Model, state: Box<dyn State>) -> Result<()> {
        let VtkOutputState { next, clears, format } = state.take()?;
        // The saved run may have written.
        (self.control.next, self.clears, self.has_points) = (next, clears, Some(true));
        format.map_or(Ok(()), |state| self.format.resume(state, &self.folder))
    }

    fn files(&self) -> Vec<FileUse> {
        let ending = self.format.endings()[0];
        let own = self.series(&self.part.path);
        let surfaces = self.surfaces.is_some().then(|| surface_series(&own));
        let file_use =
            |series: String| FileUse::WritesSeries(self.folder.join(format!("{series}.{ending}")), self.format.mark());
        [Some(own), surfaces].into_iter().flatten().map(file_use).collect()
    }

    fn outputs(&self) -> Vec<PathBuf> {
        self.format.outputs(&self.folder)
    }
}

register! { ProcessEntry "vtk_output_process",
    aliases: &["VtkOutputProcess"],
    about: "writes legacy VTK files for ParaView, laid out as Kratos writes them",
    defaults: include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../configs/processes/vtk_output_process.json")),
    like: &[("kratos", include_str!("../../../../configs/like_kratos/vtk_output_process.json"))],
    build: |request| build(request, false),
}

register! { ProcessEntry "vtu_output_process",
    aliases: &["VtuOutputProcess"],
    about: "writes compressed VTU files in double precision and a PVD file that lists them with their times; several ranks \
        write a piece each",
    defaults: include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../configs/processes/vtu_output_process.json")),
    like: &[("kratos", include_str!("../../../../configs/like_kratos/vtu_output_process.json"))],
    build: |request| build(request, true),
}
