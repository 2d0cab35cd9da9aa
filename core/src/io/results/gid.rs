//! The text files of GiD: a mesh (`.post.msh`) and results (`.post.res`).

use std::io::{self, Write};

use super::dataset::{Column, Dataset, Values};
use crate::geometry::Shape;

/// Whether cells are elements or conditions; part of the names GiD shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum GidKind {
    /// Elements.
    Element,
    /// Conditions.
    Condition,
}

impl GidKind {
    fn word(self) -> &'static str {
        if self == Self::Element { "element" } else { "condition" }
    }
}

/// A quantity at the Gauss points of the cells of one shape.
#[derive(Debug, Clone, PartialEq)]
pub struct GaussResult {
    /// Name of the quantity.
    pub name: String,
    /// Shape of the cells.
    pub shape: Shape,
    /// Local coordinates of the points, the same for all cells.
    pub points: Vec<[f64; 3]>,
    /// Numbers a point.
    pub components: usize,
    /// Ids of the cells.
    pub cells: Vec<usize>,
    /// `components` numbers a point, all points of a cell before the next cell.
    pub values: Vec<f64>,
}

impl GaussResult {
    /// The name of the set of points: cells of one shape and number of points share it.
    fn set(&self) -> String {
        format!("{}{}_{}gp_element", self.shape.cell().gid_name.to_lowercase(), self.shape.nodes(), self.points.len())
    }
}

/// Writes the meshes of one dataset, one for each shape in it, coordinates with the first mesh of a file.
///
/// # Errors
/// Errors of the writer.
pub fn write_gid_mesh(out: &mut impl Write, data: &Dataset, kind: GidKind, with_points: bool) -> io::Result<()> {
    let mut shapes = data.cells.shapes.clone();
    shapes.sort_unstable();
    shapes.dedup();
    let mut with_points = with_points;
    for shape in shapes {
        let (cell, n) = (shape.cell(), shape.nodes());
        let label = format!("Kratos_{}{n}_{}s", cell.gid_name, kind.word());
        writeln!(out, "MESH \"{label}\" dimension 3 ElemType {} Nnode {n}\nCoordinates", cell.gid_name)?;
        if with_points {
            for (id, [x, y, z]) in data.point_ids.iter().zip(&data.points) {
                writeln!(out, "{id} {x:?} {y:?} {z:?}")?;
            }
        }
        with_points = false;
        writeln!(out, "End Coordinates\nElements")?;
        for (at, (_, points)) in data.cells.iter().enumerate().filter(|(_, (own, _))| *own == shape) {
            write!(out, "{}", data.cells.ids[at])?;
            for &point in points {
                write!(out, " {}", data.point_ids[point as usize])?;
            }
            writeln!(out, " {}", data.cells.properties[at])?;
        }
        writeln!(out, "End Elements")?;
    }
    Ok(())
}

/// Writes the head of a file of results: its format and the sets of Gauss points used in it.
///
/// # Errors
/// Errors of the writer.
pub fn write_gid_results_head(out: &mut impl Write, gauss: &[GaussResult]) -> io::Result<()> {
    writeln!(out, "GiD Post Results File 1.0")?;
    let mut written: Vec<String> = Vec::new();
    for result in gauss {
        let set = result.set();
        if written.contains(&set) {
            continue;
        }
        writeln!(out, "GaussPoints \"{set}\" ElemType {}", result.shape.cell().gid_name)?;
        writeln!(out, "Number Of Gauss Points: {}", result.points.len())?;
        if result.shape.dim() < 2 {
            // GiD places the points of lines itself.
            writeln!(out, "Nodes not included\nNatural Coordinates: Internal")?;
        } else {
            writeln!(out, "Natural Coordinates: Given")?;
            for point in &result.points {
                let text: Vec<String> = point[..result.shape.dim()].iter().map(|x| format!("{x:?}")).collect();
                writeln!(out, "{}", text.join(" "))?;
            }
        }
        writeln!(out, "End GaussPoints")?;
        written.push(set);
    }
    Ok(())
}

/// Writes the columns over points and the Gauss results of one step, `label` being its time or number.
///
/// # Errors
/// Errors of the writer.
pub fn write_gid_step(
    out: &mut impl Write,
    label: f64,
    point_ids: &[usize],
    columns: &[Column],
    gauss: &[GaussResult],
) -> io::Result<()> {
    for column in columns {
        let kind = kind(column.components);
        writeln!(out, "Result \"{}\" \"Kratos\" {label:?} {kind} OnNodes\nValues", column.name)?;
        for (at, id) in point_ids.iter().enumerate() {
            write!(out, "{id}")?;
            let range = at * column.components..(at + 1) * column.components;
            match &column.values {
                Values::Real(values) => row(out, &values[range])?,
                Values::Whole(values) => values[range].iter().try_for_each(|value| write!(out, " {value}"))?,
            }
            writeln!(out)?;
        }
        writeln!(out, "End Values")?;
    }
    for result in gauss {
        let (kind, set) = (kind(result.components), result.set());
        writeln!(out, "Result \"{}\" \"Kratos\" {label:?} {kind} OnGaussPoints \"{set}\"\nValues", result.name)?;
        for (cell, id) in result.cells.iter().enumerate() {
            for point in 0..result.points.len() {
                if point == 0 {
                    write!(out, "{id}")?;
                }
                let at = (cell * result.points.len() + point) * result.components;
                row(out, &result.values[at..at + result.components])?;
                writeln!(out)?;
            }
        }
        writeln!(out, "End Values")?;
    }
    Ok(())
}

/// Matrices have the components (xx, yy, zz, xy, yz, xz).
fn kind(components: usize) -> &'static str {
    match components {
        1 => "Scalar",
        3 => "Vector",
        _ => "Matrix",
    }
}

fn row(out: &mut impl Write, values: &[f64]) -> io::Result<()> {
    values.iter().try_for_each(|value| write!(out, " {value:?}"))
}
