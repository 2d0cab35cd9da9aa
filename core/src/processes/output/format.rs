//! Formats of pictures: how points, cells and columns become files.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use zelus_linear_algebra::{State, StateMapper, stored_as_bytes};

use crate::diagnostics::Result;
use crate::io::Mark;
use crate::io::results::{Dataset, PvdFile, VtkFormat, write_piece, write_pvd, write_pvtu, write_vtk, write_vtu};
use crate::model::ModelPart;
use crate::parameters::Settings;
use crate::{register, registered_kind};

/// A picture of a model part in one step, for a format to write.
pub struct OutputFrame<'a> {
    /// The part, for its step data and the share of a rank.
    pub part: &'a ModelPart,
    /// Points, cells and columns; of several ranks the share of this one.
    pub data: &'a Dataset,
    /// Surfaces of interfaces beside the mesh; none where the deck does not ask for them, or the format has none
    /// ([`OutputFormat::has_surfaces`]).
    pub surfaces: &'a [SurfaceFrame],
    /// Folder of the files.
    pub folder: &'a Path,
    /// Name of the pictures of one part.
    pub series: &'a str,
    /// Its time.
    pub time: f64,
    /// Step or time in its name.
    pub label: &'a str,
}

/// The surface of an interface in one step. Every rank has it whole.
pub struct SurfaceFrame {
    /// Its place among the interfaces of the stage, from 0.
    pub number: usize,
    /// Its name.
    pub name: String,
    /// Points, facets and columns. Ids of points are those of mesh nodes, which several points may share.
    pub data: Dataset,
}

/// Name of the surfaces of interfaces beside the pictures of a series. The dot sets it apart from the series of sub parts, whose paths
/// are written with `_`.
pub(super) fn surface_series(series: &str) -> String {
    format!("{series}.interface")
}

/// Writes pictures.
pub trait OutputFormat: Send {
    /// Writes one picture. Collective.
    ///
    /// # Errors
    /// A file that cannot be written.
    fn write(&mut self, frame: &OutputFrame<'_>) -> Result<()>;

    /// Endings of its files, the first being that of each picture; those of an earlier run are removed before the first is written.
    fn endings(&self) -> &'static [&'static str];

    /// Whether it writes the surfaces of interfaces; a deck that asks another format for them is refused.
    fn has_surfaces(&self) -> bool {
        false
    }

    /// How its pictures are known.
    fn mark(&self) -> Mark {
        Mark::None
    }

    /// After the last picture, also of a run that has failed; asked of the root alone.
    ///
    /// # Errors
    /// A file that cannot be written.
    fn finish(&mut self, _folder: &Path) -> Result<()> {
        Ok(())
    }

    /// State between pictures, for the file of a saved run.
    fn state(&self) -> Option<Box<dyn State>> {
        None
    }

    /// Takes up a saved state of pictures in this folder.
    ///
    /// # Errors
    /// The state of another format; pictures that are gone.
    fn resume(&mut self, _state: Box<dyn State>, _folder: &Path) -> Result<()> {
        Ok(())
    }

    /// Files that a user opens; the folder unless the format has files that name the others.
    fn outputs(&self, folder: &Path) -> Vec<PathBuf> {
        vec![folder.to_owned()]
    }
}

/// Makes a format from the settings of the process that writes in it.
pub type OutputFormatFactory = fn(&Settings) -> Result<Box<dyn OutputFormat>>;

registered_kind! {
    /// A format that `file_format` of `vtk_output_process` names.
    pub struct OutputFormatEntry("output_format", "unknown-name") {
        build: OutputFormatFactory;
    }
}

/// Kratos' layout of the legacy format.
struct Legacy(VtkFormat);

impl OutputFormat for Legacy {
    fn write(&mut self, frame: &OutputFrame<'_>) -> Result<()> {
        let path = |series: &str| frame.folder.join(format!("{series}_0_{}.vtk", frame.label));
        let ranks = &frame.part.ranks;
        for surface in frame.surfaces {
            let series = format!("{}_{}", surface_series(frame.series), surface.number);
            write_vtk(ranks, &path(&series), &surface.data, self.0)?;
        }
        let path = path(frame.series);
        if frame.part.share.is_some() {
            return write_vtk(ranks, &path, &frame.data.gathered(ranks), self.0);
        }
        write_vtk(ranks, &path, frame.data, self.0)
    }

    fn endings(&self) -> &'static [&'static str] {
        &["vtk"]
    }

    fn has_surfaces(&self) -> bool {
        true
    }

    fn mark(&self) -> Mark {
        Mark::Begins(&["# vtk DataFile"])
    }
}

/// Compressed VTU, with a PVD file a series.
#[derive(Clone, Default, Serialize, Deserialize)]
#[serde(remote = "Self")]
struct Vtu {
    /// Files of every step written, by series.
    series: BTreeMap<String, Vec<PvdFile>>,
}

stored_as_bytes!(Vtu);

#[typetag::serde(name = "vtu")]
impl State for Vtu {
    fn remap(&mut self, _mapper: &mut dyn StateMapper) {}
}

impl Vtu {
    /// Writes a VTU file, or one a rank and a PVTU file that lists them; returns the name of the file to open. Collective.
    ///
    /// Ranks without cells and points write nothing, unless all are without. The list is written once all that it lists is.
    fn write_file(frame: &OutputFrame<'_>) -> Result<String> {
        let (own, name) = (frame.data, format!("{}_{}", frame.series, frame.label));
        let ranks = &frame.part.ranks;
        if frame.part.share.is_none() {
            let file = format!("{name}.vtu");
            write_vtu(ranks, &frame.folder.join(&file), own)?;
            return Ok(file);
        }
        let piece_file = |rank: usize| format!("{name}_{rank}.vtu");
        let is_empty = !ranks.any(!own.points.is_empty());
        let is_needed = !own.points.is_empty() || (is_empty && ranks.is_root());
        let path = frame.folder.join(piece_file(ranks.rank()));
        ranks.agree(if is_needed { write_piece(&path, own) } else { Ok(()) })?;
        let mut has_piece = vec![false; ranks.size()];
        has_piece[ranks.rank()] = is_needed;
        ranks.any_of(&mut has_piece);
        let pieces: Vec<String> = (0..ranks.size()).filter(|&rank| has_piece[rank]).map(piece_file).collect();
        let file = format!("{name}.pvtu");
        write_pvtu(ranks, &frame.folder.join(&file), own, &pieces)?;
        Ok(file)
    }
}

impl OutputFormat for Vtu {
    fn state(&self) -> Option<Box<dyn State>> {
        Some(Box::new(self.clone()))
    }

    fn resume(&mut self, state: Box<dyn State>, _folder: &Path) -> Result<()> {
        *self = state.take()?;
        Ok(())
    }

    fn write(&mut self, frame: &OutputFrame<'_>) -> Result<()> {
        let (ranks, time) = (&frame.part.ranks, frame.time);
        let mut files = vec![PvdFile { time, part: 0, name: String::new(), file: Self::write_file(frame)? }];
        for (at, surface) in frame.surfaces.iter().enumerate() {
            let file = format!("{}_{}_{}.vtu", surface_series(frame.series), surface.number, frame.label);
            write_vtu(ranks, &frame.folder.join(&file), &surface.data)?;
            files.push(PvdFile { time, part: at + 1, name: surface.name.clone(), file });
        }
        let steps = self.series.entry(frame.series.to_owned()).or_default();
        steps.extend(files);
        write_pvd(ranks, &frame.folder.join(format!("{}.pvd", frame.series)), steps)
    }

    fn endings(&self) -> &'static [&'static str] {
        &["vtu", "pvtu", "pvd"]
    }

    fn has_surfaces(&self) -> bool {
        true
    }

    fn mark(&self) -> Mark {
        Mark::Begins(&["<?xml", "<VTKFile"])
    }

    fn outputs(&self, folder: &Path) -> Vec<PathBuf> {
        self.series.keys().map(|series| folder.join(format!("{series}.pvd"))).collect()
    }
}

register! { OutputFormatEntry "ascii",
    about: "legacy VTK as text, laid out as Kratos writes it",
    build: |settings| Ok(Box::new(Legacy(VtkFormat::Ascii { precision: settings.get_usize("output_precision")? }))),
}
register! { OutputFormatEntry "binary",
    about: "legacy VTK in binary, laid out as Kratos writes it",
    build: |_| Ok(Box::new(Legacy(VtkFormat::Binary))),
}
register! { OutputFormatEntry "vtu",
    about: "compressed VTU in double precision with a PVD file that lists the steps; several ranks write a piece each",
    build: |_| Ok(Box::<Vtu>::default()),
}
