//! Results of all steps as one file of VTK's HDF format (`.vtkhdf`), which ParaView reads from 5.12 on.
//!
//! Meshes that do not change are written once. Numbers that a step does not have are NaN there. Source: VTK documentation, "VTKHDF
//! File Format", version 2.0.

use std::collections::BTreeMap;
use std::io::Write;
use std::path::Path;

use hdf5_pure::{AttrValue, FileBuilder, GroupBuilder};
use zelus_core::diagnostics::{Diagnostic, Place, Result};
use zelus_core::io::replace_own_file;
use zelus_core::io::results::{Column, Dataset};

use crate::series::{meshes, read_series};

/// The version of the format.
const VERSION: [i64; 2] = [2, 0];

/// Writes the results of a series (`.pvd`), or of one file (`.vtu`, `.pvtu`), as one file; how many steps there were.
///
/// # Errors
/// A file that is missing, damaged or not of this program; one that cannot be written.
pub fn write_vtkhdf(from: &Path, to: &Path) -> Result<usize> {
    let (times, steps) = read_series(from)?;
    let mut file = FileBuilder::new();
    let mut root = file.create_group("VTKHDF");
    root.set_attr("Version", AttrValue::I64Array(VERSION.to_vec()));
    root.set_attr("Type", AttrValue::AsciiString("UnstructuredGrid".to_owned()));
    fill(&mut root, &times, &steps);
    file.add_group(root.finish());
    let bytes = file.finish().map_err(|why| {
        Diagnostic::error("unwritable", format!("the results cannot be written: {why}")).at(Place::file(to))
    })?;
    replace_own_file(to, |out| out.write_all(&bytes))?;
    Ok(steps.len())
}

/// Meshes one after another, and where that of each step begins: meshes, points, cells, connectivity.
#[derive(Default)]
struct Meshes {
    points: Vec<f64>,
    connectivity: Vec<i64>,
    offsets: Vec<i64>,
    types: Vec<u8>,
    /// Points, cells and connectivity of each mesh.
    counts: [Vec<i64>; 3],
    begins: Vec<[i64; 4]>,
}

impl Meshes {
    fn of(steps: &[Dataset]) -> Self {
        let mut all = Self::default();
        for (at, (step, mesh)) in steps.iter().zip(meshes(steps)).enumerate() {
            if mesh == at {
                all.add(step);
            } else {
                all.begins.push(all.begins[mesh]);
            }
        }
        all
    }

    fn add(&mut self, step: &Dataset) {
        let sizes =
            |own: &Self| [own.points.len() / 3, own.types.len(), own.connectivity.len()].map(|size| size as i64);
        let before = sizes(self);
        self.begins.push([self.counts[0].len() as i64, before[0], before[1], before[2]]);
        self.points.extend(step.points.as_flattened());
        let mut end = 0;
        self.offsets.push(end);
        for (shape, nodes) in step.cells.iter() {
            self.connectivity.extend(shape.cell().vtk_order.iter().map(|&place| i64::from(nodes[place])));
            end += nodes.len() as i64;
            self.offsets.push(end);
            self.types.push(shape.cell().vtk_type);
        }
        let after = sizes(self);
        for (counts, (after, before)) in self.counts.iter_mut().zip(after.into_iter().zip(before)) {
            counts.push(after - before);
        }
    }
}

fn fill(root: &mut GroupBuilder, times: &[f64], steps: &[Dataset]) {
    let meshes = Meshes::of(steps);
    let [points, cells, connectivity] = &meshes.counts;
    whole(root, "NumberOfPoints", points);
    whole(root, "NumberOfCells", cells);
    whole(root, "NumberOfConnectivityIds", connectivity);
    real(root, "Points", 3, &meshes.points);
    whole(root, "Connectivity", &meshes.connectivity);
    whole(root, "Offsets", &meshes.offsets);
    root.create_dataset("Types").with_u8_data(&meshes.types).with_shape(&[meshes.types.len() as u64]);

    let mut of_steps = root.create_group("Steps");
    of_steps.set_attr("NSteps", AttrValue::I64(steps.len() as i64));
    real(&mut of_steps, "Values", 1, times);
    let begin = |of: usize| meshes.begins.iter().map(|begin| begin[of]).collect::<Vec<_>>();
    whole(&mut of_steps, "PartOffsets", &begin(0));
    whole(&mut of_steps, "NumberOfParts", &vec![1; steps.len()]);
    whole(&mut of_steps, "PointOffsets", &begin(1));
    for (name, of) in [("CellOffsets", 2), ("ConnectivityIdOffsets", 3)] {
        // By kind of topology, of which there is one.
        of_steps.create_dataset(name).with_i64_data(&begin(of)).with_shape(&[steps.len() as u64, 1]);
    }
    let at_points: Vec<_> = steps.iter().map(|step| (step.points.len(), step.point_data.as_slice())).collect();
    let at_cells: Vec<_> = steps.iter().map(|step| (step.cells.len(), step.cell_data.as_slice())).collect();
    for (name, of) in [("PointData", at_points), ("CellData", at_cells)] {
        let mut data = root.create_group(name);
        let mut begins = of_steps.create_group(&format!("{name}Offsets"));
        let offsets: Vec<i64> = of
            .iter()
            .scan(0, |end, (count, _)| {
                let begin = *end;
                *end += *count as i64;
                Some(begin)
            })
            .collect();
        for (name, (components, values)) in columns(&of) {
            real(&mut data, name, components, &values);
            whole(&mut begins, name, &offsets);
        }
        root.add_group(data.finish());
        of_steps.add_group(begins.finish());
    }
    root.add_group(of_steps.finish());
}

/// The columns of all steps one after another, by name, with their numbers of components; steps have so many points or cells.
fn columns<'a>(steps: &[(usize, &'a [Column])]) -> BTreeMap<&'a str, (usize, Vec<f64>)> {
    let mut all = BTreeMap::new();
    for column in steps.iter().flat_map(|(_, columns)| columns.iter()) {
        all.entry(column.name.as_str()).or_insert((column.components, Vec::new()));
    }
    for (name, (components, values)) in &mut all {
        for (count, own) in steps {
            match own.iter().find(|column| column.name == *name && column.components == *components) {
                Some(column) => values.extend((0..column.values.len()).map(|at| column.values.get(at))),
                None => values.extend(std::iter::repeat_n(f64::NAN, count * *components)),
            }
        }
    }
    all
}

fn real(group: &mut GroupBuilder, name: &str, components: usize, values: &[f64]) {
    let count = (values.len() / components.max(1)) as u64;
    let shape = if components == 1 { vec![count] } else { vec![count, components as u64] };
    group.create_dataset(name).with_f64_data(values).with_shape(&shape);
}

fn whole(group: &mut GroupBuilder, name: &str, values: &[i64]) {
    group.create_dataset(name).with_i64_data(values).with_shape(&[values.len() as u64]);
}
