//! The XML format of VTK, compressed, and the file that lists its steps.

use std::io::{self, Write};
use std::path::Path;

use flate2::Compression;
use flate2::write::ZlibEncoder;
use serde::{Deserialize, Serialize};
use zelus_linear_algebra::parallel;

use super::dataset::{Column, Dataset, Values};
use crate::communication::Ranks;
use crate::diagnostics::Result;
use crate::io::{replace_file, replace_own_file};

/// Bytes compressed at once; blocks are compressed in parallel.
const BLOCK: usize = 1 << 16;
/// Fast and small enough: higher levels cost several times more for a few per cent less.
const LEVEL: u32 = 4;

/// Writes a VTU file in double precision, its arrays appended, raw and compressed.
///
/// # Errors
/// [`crate::diagnostics::Error::System`] when the disk refuses.
pub fn write_vtu(ranks: &Ranks, path: &Path, data: &Dataset) -> Result<()> {
    replace_file(ranks, path, |out| vtu(out, data))
}

/// Writes the VTU file of this rank, whatever the other ranks write.
///
/// # Errors
/// [`crate::diagnostics::Error::System`] when the disk refuses this rank; the others do not know of it.
pub fn write_piece(path: &Path, data: &Dataset) -> Result<()> {
    replace_own_file(path, |out| vtu(out, data))
}

fn vtu(out: &mut impl Write, data: &Dataset) -> io::Result<()> {
    let mut arrays = Appended::default();
    writeln!(
        out,
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" \
         header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">\n<UnstructuredGrid>\n\
         <Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n<PointData>",
        data.points.len(),
        data.cells.len()
    )?;
    data.point_data.iter().try_for_each(|column| arrays.column(out, column))?;
    writeln!(out, "</PointData>\n<CellData>")?;
    data.cell_data.iter().try_for_each(|column| arrays.column(out, column))?;
    writeln!(out, "</CellData>\n<Points>")?;
    let points: Vec<u8> = data.points.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
    arrays.array(out, "Points", "Float64", 3, &points)?;
    writeln!(out, "</Points>\n<Cells>")?;
    let cells = data.cells.iter();
    let connectivity = cells.flat_map(|(shape, points)| shape.cell().vtk_order.iter().map(move |&at| points[at]));
    let connectivity: Vec<u8> = connectivity.flat_map(|point| i64::from(point).to_le_bytes()).collect();
    arrays.array(out, "connectivity", "Int64", 1, &connectivity)?;
    let ends = data.cells.shapes.iter().scan(0_i64, |end, shape| {
        *end += shape.nodes() as i64;
        Some(*end)
    });
    arrays.array(out, "offsets", "Int64", 1, &ends.flat_map(i64::to_le_bytes).collect::<Vec<u8>>())?;
    let types: Vec<u8> = data.cells.shapes.iter().map(|shape| shape.cell().vtk_type).collect();
    arrays.array(out, "types", "UInt8", 1, &types)?;
    write!(out, "</Cells>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_")?;
    out.write_all(&arrays.bytes)?;
    writeln!(out, "\n</AppendedData>\n</VTKFile>")
}

/// The name VTK has for the numbers of a column.
pub(super) fn type_of(values: &Values) -> &'static str {
    match values {
        Values::Real(_) => "Float64",
        Values::Whole(_) => "Int32",
    }
}

/// The compressed arrays of a file, one after another.
#[derive(Default)]
struct Appended {
    bytes: Vec<u8>,
}

impl Appended {
    fn column(&mut self, out: &mut impl Write, column: &Column) -> io::Result<()> {
        let bytes: Vec<u8> = match &column.values {
            Values::Real(values) => values.iter().flat_map(|x| x.to_le_bytes()).collect(),
            Values::Whole(values) => values.iter().flat_map(|x| x.to_le_bytes()).collect(),
        };
        self.array(out, &column.name, type_of(&column.values), column.components, &bytes)
    }

    /// Keeps an array and writes the tag that refers to it.
    fn array(
        &mut self,
        out: &mut impl Write,
        name: &str,
        kind: &str,
        components: usize,
        bytes: &[u8],
    ) -> io::Result<()> {
        writeln!(
            out,
            "<DataArray type=\"{kind}\" Name=\"{}\" NumberOfComponents=\"{components}\" format=\"appended\" \
             offset=\"{}\"/>",
            escape(name),
            self.bytes.len()
        )?;
        let block = |at: usize| compress(&bytes[at * BLOCK..((at + 1) * BLOCK).min(bytes.len())]);
        let blocks = parallel::map(bytes.len().div_ceil(BLOCK), 1, block);
        let blocks: Vec<Vec<u8>> = blocks.into_iter().collect::<io::Result<_>>()?;
        let head = [blocks.len(), BLOCK, bytes.len() % BLOCK].into_iter().chain(blocks.iter().map(Vec::len));
        self.bytes.extend(head.flat_map(|number| (number as u64).to_le_bytes()));
        blocks.iter().for_each(|block| self.bytes.extend_from_slice(block));
        Ok(())
    }
}

fn compress(bytes: &[u8]) -> io::Result<Vec<u8>> {
    let mut encoder = ZlibEncoder::new(Vec::with_capacity(bytes.len() / 2), Compression::new(LEVEL));
    encoder.write_all(bytes)?;
    encoder.finish()
}

/// Text as XML may hold it, in an attribute or between tags.
pub fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;")
}

/// A file of a PVD series.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PvdFile {
    /// Its time.
    pub time: f64,
    /// 0 for the mesh, above for a surface beside it: ParaView opens the parts of one time together.
    pub part: usize,
    /// Name of a surface; empty for the mesh.
    pub name: String,
    /// Its name relative to the PVD file.
    pub file: String,
}

/// Writes the PVD file of a series.
///
/// # Errors
/// [`crate::diagnostics::Error::System`] when the disk refuses.
pub fn write_pvd(ranks: &Ranks, path: &Path, files: &[PvdFile]) -> Result<()> {
    replace_file(ranks, path, |out| pvd(out, files))
}

fn pvd(out: &mut impl Write, files: &[PvdFile]) -> io::Result<()> {
    writeln!(out, "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n  <Collection>")?;
    for PvdFile { time, part, name, file } in files {
        let name = if name.is_empty() { String::new() } else { format!(" name=\"{}\"", escape(name)) };
        writeln!(out, "    <DataSet timestep=\"{time:?}\" part=\"{part}\"{name} file=\"{}\"/>", escape(file))?;
    }
    writeln!(out, "  </Collection>\n</VTKFile>")
}
