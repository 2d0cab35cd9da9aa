//! The file that lists the VTU pieces of several ranks, as ParaView opens them together.

use std::io::{self, Write};
use std::path::Path;

use super::dataset::{Column, Dataset};
use super::vtu::{escape, type_of};
use crate::communication::Ranks;
use crate::diagnostics::Result;
use crate::io::replace_file;

/// Writes a PVTU file: the columns that every piece has, those of `data`, and the pieces' files, relative to it.
///
/// # Errors
/// [`crate::diagnostics::Error::System`] when the disk refuses.
pub fn write_pvtu(ranks: &Ranks, path: &Path, data: &Dataset, pieces: &[String]) -> Result<()> {
    replace_file(ranks, path, |out| pvtu(out, data, pieces))
}

fn pvtu(out: &mut impl Write, data: &Dataset, pieces: &[String]) -> io::Result<()> {
    writeln!(
        out,
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"PUnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" \
         header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">\n<PUnstructuredGrid GhostLevel=\"0\">\n<PPointData>"
    )?;
    data.point_data.iter().try_for_each(|column| declare(out, column))?;
    writeln!(out, "</PPointData>\n<PCellData>")?;
    data.cell_data.iter().try_for_each(|column| declare(out, column))?;
    writeln!(out, "</PCellData>\n<PPoints>")?;
    declare(out, &Column::real("Points", 3, Vec::new()))?;
    writeln!(out, "</PPoints>")?;
    for piece in pieces {
        writeln!(out, "<Piece Source=\"{}\"/>", escape(piece))?;
    }
    writeln!(out, "</PUnstructuredGrid>\n</VTKFile>")
}

fn declare(out: &mut impl Write, column: &Column) -> io::Result<()> {
    let (kind, name) = (type_of(&column.values), escape(&column.name));
    writeln!(out, "<PDataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{}\"/>", column.components)
}
