//! Results of all steps as XDMF: a text (`.xdmf`) that describes them, and an HDF5 file (`.h5`) beside it with the numbers.
//!
//! Meshes that do not change are written once. Each cell stands with the number of its kind before its nodes, in VTK's order, which is the one
//! that VTK's reader takes (9.7, all kinds); quantities of other numbers of components than 1 and 3 stand as matrices of one row. Source: "XDMF Model and Format", version 2.

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::Path;

use hdf5_pure::FileBuilder;
use zelus_core::diagnostics::{Diagnostic, Place, Result};
use zelus_core::geometry::Shape;
use zelus_core::io::replace_own_file;
use zelus_core::io::results::{Column, Dataset, escape};

use crate::series::{meshes, read_series};

/// Writes the results of a series (`.pvd`), or of one file (`.vtu`, `.pvtu`), as one text and one file of numbers; how many steps there were.
///
/// # Errors
/// A file that is missing, damaged or not of this program; one that cannot be written.
pub fn write_xdmf(from: &Path, to: &Path) -> Result<usize> {
    let (times, steps) = read_series(from)?;
    let heavy = to.with_extension("h5");
    let mut numbers =
        Numbers { file: FileBuilder::new(), name: escape(&heavy.file_name().unwrap_or_default().to_string_lossy()) };
    let mut grids = String::new();
    let mut known: Vec<String> = Vec::new();
    for (at, (step, mesh)) in steps.iter().zip(meshes(&steps)).enumerate() {
        known.push(if mesh == at { numbers.mesh(at, step) } else { known[mesh].clone() });
        let data = numbers.data(at, step);
        let _ = write!(
            grids,
            "<Grid Name=\"step {at}\" GridType=\"Uniform\">\n<Time Value=\"{:?}\"/>\n{}{data}</Grid>\n",
            times[at], known[at]
        );
    }
    let bytes = numbers.file.finish().map_err(|why| {
        Diagnostic::error("unwritable", format!("the results cannot be written: {why}")).at(Place::file(&heavy))
    })?;
    replace_own_file(&heavy, |out| out.write_all(&bytes))?;
    let text = format!(
        "<?xml version=\"1.0\"?>\n<Xdmf Version=\"2.0\">\n<Domain>\n<Grid Name=\"results\" GridType=\"Collection\" \
         CollectionType=\"Temporal\">\n{grids}</Grid>\n</Domain>\n</Xdmf>\n"
    );
    replace_own_file(to, |out| out.write_all(text.as_bytes()))?;
    Ok(steps.len())
}

/// The file of numbers.
struct Numbers {
    file: FileBuilder,
    /// As the text names it.
    name: String,
}

impl Numbers {
    /// Writes the mesh of a step; returns its description in the text.
    fn mesh(&mut self, at: usize, step: &Dataset) -> String {
        let cells = topology(step);
        let points = step.points.as_flattened();
        let mut group = self.file.create_group(&format!("mesh_{at}"));
        group.create_dataset("cells").with_i64_data(&cells).with_shape(&[cells.len() as u64]);
        group.create_dataset("points").with_f64_data(points).with_shape(&[step.points.len() as u64, 3]);
        self.file.add_group(group.finish());
        let name = &self.name;
        format!(
            "<Topology TopologyType=\"Mixed\" NumberOfElements=\"{}\">\n<DataItem Format=\"HDF\" NumberType=\"Int\" Precision=\"8\" \
             Dimensions=\"{}\">{name}:/mesh_{at}/cells</DataItem>\n</Topology>\n<Geometry GeometryType=\"XYZ\">\n<DataItem Format=\"HDF\" \
             NumberType=\"Float\" Precision=\"8\" Dimensions=\"{} 3\">{name}:/mesh_{at}/points</DataItem>\n</Geometry>\n",
            step.cells.len(),
            cells.len(),
            step.points.len()
        )
    }

    /// Writes the columns of a step; returns their description in the text.
    fn data(&mut self, at: usize, step: &Dataset) -> String {
        let mut said = String::new();
        for (center, columns) in [("Node", &step.point_data), ("Cell", &step.cell_data)] {
            let place = format!("step_{at}_{}", center.to_lowercase());
            let mut group = self.file.create_group(&place);
            for column in columns {
                let Column { name, components, values } = column;
                let values: Vec<f64> = (0..values.len()).map(|at| values.get(at)).collect();
                let count = values.len() / (*components).max(1);
                let (kind, shape) = match (*components as u64, count as u64) {
                    (1, count) => ("Scalar", vec![count]),
                    (3, count) => ("Vector", vec![count, 3]),
                    // Tensors would be read in another order.
                    (components, count) => ("Matrix", vec![count, 1, components]),
                };
                group.create_dataset(name).with_f64_data(&values).with_shape(&shape);
                let dimensions: Vec<String> = shape.iter().map(ToString::to_string).collect();
                let _ = write!(
                    said,
                    "<Attribute Name=\"{0}\" AttributeType=\"{kind}\" Center=\"{center}\">\n<DataItem Format=\"HDF\" NumberType=\"Float\" \
                     Precision=\"8\" Dimensions=\"{1}\">{2}:/{place}/{0}</DataItem>\n</Attribute>\n",
                    escape(name),
                    dimensions.join(" "),
                    self.name
                );
            }
            self.file.add_group(group.finish());
        }
        said
    }
}

/// The cells of a mesh, each with the number of its kind before its nodes; points and lines with their count of nodes, too.
fn topology(step: &Dataset) -> Vec<i64> {
    let mut out = Vec::new();
    for (shape, nodes) in step.cells.iter() {
        let kind = kind(shape);
        out.push(kind);
        if kind <= 2 {
            out.push(nodes.len() as i64);
        }
        out.extend(shape.cell().vtk_order.iter().map(|&place| i64::from(nodes[place])));
    }
    out
}

/// The number of a kind of cells: of points 1, of lines 2.
fn kind(shape: Shape) -> i64 {
    match shape {
        Shape::Point1 => 0x1,
        Shape::Line2 => 0x2,
        Shape::Line3 => 0x22,
        Shape::Tri3 => 0x4,
        Shape::Tri6 => 0x24,
        Shape::Quad4 => 0x5,
        Shape::Quad8 => 0x25,
        Shape::Quad9 => 0x23,
        Shape::Tet4 => 0x6,
        Shape::Tet10 => 0x26,
        Shape::Pyramid5 => 0x7,
        Shape::Pyramid13 => 0x27,
        Shape::Prism6 => 0x8,
        Shape::Prism15 => 0x28,
        Shape::Prism18 => 0x29,
        Shape::Hex8 => 0x9,
        Shape::Hex20 => 0x30,
        Shape::Hex27 => 0x32,
    }
}
