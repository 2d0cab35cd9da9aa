//! Ties nodes to those around them: u = Σ w_i u_i, with weights of linear radial functions.
//!
//! The weights solve `Σ_j |x_i − x_j| w_j = |x_i − x|` and are divided by their sum; between two nodes on a line that is linear
//! interpolation. Stresses pass on more smoothly through the mortar ties of `mesh_tying_process`.

use std::ops::Range;

use nalgebra::{DMatrix, DVector};

use super::point_grid::PointGrid;
use super::process::{Process, ProcessEntry, ProcessRequest};
use super::target::{check_unknowns, scalars_of};
use crate::assembly::System;
use crate::diagnostics::{Diagnostic, Place, Report, Result};
use crate::model::{MasterSlaveConstraint, Model, ScalarVariable};
use crate::register;
use crate::vector3::{norm, sub};

const MASTERS: &str = "master_model_part_name";
const SLAVES: &str = "slave_model_part_name";
const FEWEST: &str = "minimum_number_of_neighbouring_nodes";

struct TiesToNeighbours {
    root: String,
    /// Where the deck names the nodes that follow.
    place: Place,
    variables: Vec<ScalarVariable>,
    slaves: Vec<u32>,
    masters: Vec<u32>,
    radius: f64,
    fewest: usize,
    reforms: bool,
    /// The constraints it made, by their place in the model part.
    made: Range<usize>,
}

fn build(request: &mut ProcessRequest<'_>) -> Result<Box<dyn Process>> {
    let settings =
        &request.settings_with(|defaults| defaults.require(&["model_part_name", SLAVES, MASTERS, "variable_names"]))?;
    let root = settings.get_str("model_part_name")?.split('.').next().unwrap_or_default().to_owned();
    let part = request.model.root(&root).map_err(|e| e.at(&settings.key_place("model_part_name")))?;
    let nodes = |key: &str| -> Result<Vec<u32>> {
        let name = settings.get_str(key)?;
        Ok(part.part(name).map_err(|e| e.at(&settings.key_place(key)))?.nodes.clone())
    };
    let (slaves, masters) = (nodes(SLAVES)?, nodes(MASTERS)?);
    if let Some(both) = slaves.iter().find(|node| masters.contains(node)) {
        let fact = format!("node {} would follow itself: it belongs to both parts", part.nodes.ids[*both as usize]);
        return Err(settings.error(SLAVES, "listed-twice", fact).remedy("name parts without a node in common").into());
    }
    let fewest = settings.get_usize(FEWEST)?.max(1);
    if masters.len() < fewest {
        let fact = format!("\"{FEWEST}\" is {fewest}, and the part has {} nodes", masters.len());
        return Err(settings.error(MASTERS, "empty-part", fact).remedy("name a part with more nodes").into());
    }
    let radius = settings.get_f64("search_radius")?;
    if !(radius > 0.0 && radius.is_finite()) {
        let fact = format!("\"search_radius\" is {radius}");
        return Err(settings.error("search_radius", "out-of-range", fact).remedy("write a length above zero").into());
    }
    let mut variables = Vec::new();
    for name in settings.get_strings("variable_names")? {
        let found = scalars_of(&name, part.info.domain_size).ok_or_else(|| {
            let fact = format!("{name:?} is no variable of nodes");
            settings.error("variable_names", "unknown-variable", fact).remedy("name a scalar, a component or a vector")
        })?;
        variables.extend(found);
    }
    Ok(Box::new(TiesToNeighbours {
        root,
        place: settings.key_place(SLAVES),
        variables,
        slaves,
        masters,
        radius,
        fewest,
        reforms: settings.get_bool("reform_constraints_at_each_step")?,
        made: 0..0,
    }))
}

/// Weights of values at `points` at the place `x`; `None` where two points coincide.
fn weights(points: &[[f64; 3]], x: [f64; 3]) -> Option<Vec<f64>> {
    let distances = DMatrix::from_fn(points.len(), points.len(), |i, j| norm(sub(points[i], points[j])));
    let known = DVector::from_fn(points.len(), |i, _| norm(sub(points[i], x)));
    let solution = if points.len() == 1 { DVector::repeat(1, 1.0) } else { distances.lu().solve(&known)? };
    let sum = solution.sum();
    solution.iter().all(|w| (w / sum).is_finite()).then(|| solution.iter().map(|w| w / sum).collect())
}

impl TiesToNeighbours {
    /// The nodes that each node follows now, with weights.
    fn find(&self, model: &Model) -> Result<Vec<Vec<(u32, f64)>>> {
        let part = model.root(&self.root)?;
        let points: Vec<[f64; 3]> = self.masters.iter().map(|&node| part.nodes.current[node as usize]).collect();
        let cells = PointGrid::new(&points, self.radius);
        let follows = |&node: &u32| {
            let x = part.nodes.current[node as usize];
            let near = cells.near(x, self.fewest);
            let places: Vec<[f64; 3]> = near.iter().map(|&at| points[at as usize]).collect();
            let weights = weights(&places, x).ok_or_else(|| {
                let id = part.nodes.ids[node as usize];
                Diagnostic::error("singular", format!("two of the nodes around node {id} are at one place"))
                    .at(self.place.clone())
                    .remedy("merge them, or name one of them only")
            })?;
            Ok(near.iter().map(|&at| self.masters[at as usize]).zip(weights).collect())
        };
        self.slaves.iter().map(follows).collect()
    }
}

impl Process for TiesToNeighbours {
    fn initialize(&mut self, model: &mut Model) -> Result<()> {
        let found = self.find(model)?;
        let part = model.root_mut(&self.root)?;
        let of_node = |(&node, masters): (&u32, Vec<(u32, f64)>)| {
            let follows = move |&variable: &ScalarVariable| {
                let masters = masters.iter().map(|&(master, weight)| ((master, variable), weight));
                MasterSlaveConstraint::new((node, variable), masters.collect())
            };
            self.variables.iter().map(follows).collect::<Vec<_>>()
        };
        let new: Vec<_> = self.slaves.iter().zip(found).flat_map(of_node).collect();
        self.made = part.add_constraints(new);
        Ok(())
    }

    fn check(&self, model: &Model, system: &System, _warnings: &mut Report) -> Result<()> {
        let nodes = self.slaves.iter().chain(&self.masters);
        let unknowns = nodes.flat_map(|&node| self.variables.iter().map(move |&variable| (node, variable)));
        check_unknowns(model.root(&self.root)?, system, unknowns, &self.place)
    }

    fn begin_step(&mut self, model: &mut Model) -> Result<()> {
        if !self.reforms {
            return Ok(());
        }
        let found = self.find(model)?;
        let part = model.root_mut(&self.root)?;
        let own = part.constraints[self.made.clone()].chunks_exact_mut(self.variables.len());
        for (constraints, masters) in own.zip(found) {
            for constraint in constraints {
                let variable = constraint.slave.1;
                constraint.masters = masters.iter().map(|&(master, weight)| ((master, variable), weight)).collect();
            }
        }
        Ok(())
    }
}

register! { ProcessEntry "assign_master_slave_constraints_to_neighbours_process",
    aliases: &["AssignMasterSlaveConstraintsToNeighboursProcess"],
    about: "ties each node of a part to those of another around it",
    source: "eqs. D.12a–e",
    common: &[SLAVES, MASTERS],
    defaults: include_str!(concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../configs/processes/assign_master_slave_constraints_to_neighbours_process.json"
    )),
    build: build,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_interpolate_on_a_line_and_meet_values_at_nodes() {
        let points = [[0.0; 3], [1.0, 0.0, 0.0], [3.0, 0.0, 0.0]];
        let found = weights(&points, [1.5, 0.0, 0.0]).unwrap();
        assert!(found.iter().zip([0.0, 0.75, 0.25]).all(|(w, exact)| (w - exact).abs() < 1e-14), "{found:?}");
        let plane = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
        let found = weights(&plane, [0.0, 1.0, 0.0]).unwrap();
        assert!(found.iter().zip([0.0, 0.0, 1.0, 0.0]).all(|(w, exact)| (w - exact).abs() < 1e-14), "{found:?}");
        let found = weights(&plane, [0.5, 0.5, 0.0]).unwrap();
        assert!(found.iter().all(|w| (w - 0.25).abs() < 1e-14), "{found:?}");
        assert!(weights(&[[0.0; 3], [0.0; 3]], [1.0, 0.0, 0.0]).is_none());
    }
}
