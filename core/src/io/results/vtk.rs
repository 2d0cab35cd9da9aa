//! The legacy VTK format in the layout of Kratos' own files.

use std::io::{self, Write};
use std::path::Path;

use super::dataset::{Cells, Column, Dataset, Values};
use super::number::scientific;
use crate::communication::Ranks;
use crate::diagnostics::Result;
use crate::io::replace_file;

/// How numbers are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum VtkFormat {
    /// Text with this many decimals.
    Ascii {
        /// Decimals after the point.
        precision: usize,
    },
    /// Four-byte numbers, most significant byte first.
    Binary,
}

/// Writes a legacy VTK file.
///
/// # Errors
/// [`crate::diagnostics::Error::System`] when the disk refuses.
pub fn write_vtk(ranks: &Ranks, path: &Path, data: &Dataset, format: VtkFormat) -> Result<()> {
    replace_file(ranks, path, |out| Vtk { out, format }.file(data))
}

struct Vtk<'a, W: Write> {
    out: &'a mut W,
    format: VtkFormat,
}

impl<W: Write> Vtk<'_, W> {
    fn file(&mut self, data: &Dataset) -> io::Result<()> {
        let kind = if self.format == VtkFormat::Binary { "BINARY" } else { "ASCII" };
        write!(self.out, "# vtk DataFile Version 4.0\nvtk output\n{kind}\nDATASET UNSTRUCTURED_GRID\n")?;
        writeln!(self.out, "POINTS {} float", data.points.len())?;
        for point in &data.points {
            self.row(point)?;
        }
        if !data.cells.is_empty() {
            self.cells(&data.cells)?;
        }
        writeln!(self.out, "POINT_DATA {}\nFIELD FieldData {}", data.points.len(), data.point_data.len())?;
        data.point_data.iter().try_for_each(|column| self.column(column, data.points.len()))?;
        if !data.cells.is_empty() {
            writeln!(self.out, "CELL_DATA {}\nFIELD FieldData {}", data.cells.len(), data.cell_data.len())?;
            data.cell_data.iter().try_for_each(|column| self.column(column, data.cells.len()))?;
        }
        Ok(())
    }

    fn cells(&mut self, cells: &Cells) -> io::Result<()> {
        writeln!(self.out, "\nCELLS {} {}", cells.len(), cells.len() + cells.points.len())?;
        for (shape, points) in cells.iter() {
            self.whole(points.len() as i32)?;
            for &place in shape.cell().vtk_order {
                if self.format != VtkFormat::Binary {
                    write!(self.out, " ")?;
                }
                self.whole(points[place] as i32)?;
            }
            self.end_line()?;
        }
        writeln!(self.out, "\nCELL_TYPES {}", cells.len())?;
        for shape in &cells.shapes {
            self.whole(shape.cell().vtk_type.into())?;
            self.end_line()?;
        }
        Ok(())
    }

    fn column(&mut self, column: &Column, count: usize) -> io::Result<()> {
        let kind = if matches!(column.values, Values::Whole(_)) { "int" } else { "float" };
        writeln!(self.out, "{} {} {count}  {kind}", column.name, column.components)?;
        match &column.values {
            Values::Whole(values) => values.iter().try_for_each(|&value| {
                self.whole(value)?;
                self.end_line()
            }),
            Values::Real(values) if column.components == 1 => values.iter().try_for_each(|&value| {
                // Scalars pass through single precision in Kratos even as text.
                self.real(f64::from(value as f32))?;
                self.end_line()
            }),
            Values::Real(values) => values.chunks_exact(column.components).try_for_each(|row| self.row(row)),
        }
    }

    /// Numbers of one line, each followed by a blank.
    fn row(&mut self, values: &[f64]) -> io::Result<()> {
        for &value in values {
            self.real(value)?;
            if self.format != VtkFormat::Binary {
                write!(self.out, " ")?;
            }
        }
        self.end_line()
    }

    fn real(&mut self, value: f64) -> io::Result<()> {
        match self.format {
            VtkFormat::Ascii { precision } => scientific(self.out, value, precision),
            VtkFormat::Binary => self.out.write_all(&(value as f32).to_be_bytes()),
        }
    }

    fn whole(&mut self, value: i32) -> io::Result<()> {
        match self.format {
            VtkFormat::Ascii { .. } => write!(self.out, "{value}"),
            VtkFormat::Binary => self.out.write_all(&value.to_be_bytes()),
        }
    }

    fn end_line(&mut self) -> io::Result<()> {
        if self.format == VtkFormat::Binary { Ok(()) } else { self.out.write_all(b"\n") }
    }
}
