//! What a run leaves, and what holds in every state of contact: balance, complementarity, friction, facets covered.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use crate::grid::Vec3;
use crate::model::Model;
use crate::support::{Results, read_json};

/// Largest error of balance, as a share of the largest reaction: what the default tolerance of residuals leaves.
const BALANCE: f64 = 2e-3;
/// Forces that count in all problems.
const LEAST_FORCE: f64 = 1e-3;
/// What the default tolerances leave of tension, of gaps in mesh sizes, and of the bound of friction.
const TRACTION: f64 = 2e-3;
const GAP: f64 = 1e-3;
/// Share of a facet's length that may be uncovered where both sides are polygons.
const COVERED: f64 = 0.02;

/// An accepted step, by node.
pub struct State {
    pub displacement: Vec<Vec3>,
    pub reaction: Vec<Vec3>,
    pub position: Vec<Vec3>,
    normal: Vec<Vec3>,
    /// Multiplier, the scalar one times the normal.
    pub multiplier: Vec<Vec3>,
    gap: Vec<f64>,
    slip: Vec<Vec3>,
    area: Vec<f64>,
}

/// All steps of a run.
pub struct Outcome {
    pub states: Vec<State>,
    /// Newton iterations in total.
    pub iterations: usize,
}

fn sub(a: Vec3, b: Vec3) -> Vec3 {
    std::array::from_fn(|c| a[c] - b[c])
}

fn dot(a: Vec3, b: Vec3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub fn norm(a: Vec3) -> f64 {
    dot(a, a).sqrt()
}

impl Outcome {
    /// Reads the files of a run.
    ///
    /// # Errors
    /// Files that are missing.
    pub fn read(model: &Model, folder: &Path) -> Result<Self, String> {
        let results = Results::read(&folder.join("results.json"))?;
        let areas = Results::read(&folder.join("areas.json"))?;
        let report = read_json(&folder.join("report.json"))?;
        let steps = report["steps"].as_array().ok_or("no steps")?.iter();
        let iterations = steps.map(|step| step["iterations"].as_array().map_or(0, Vec::len)).sum();
        let count = model.nodes.len();
        let scalar = |from: &Results, name: &str, step: usize| -> Vec<f64> {
            let values = from.nodal(name, step);
            (0..count).map(|n| values.get(&(model.look.id(n, count) as u64)).copied().unwrap_or(0.0)).collect()
        };
        // everything as the problem has it, however the deck looks at it
        let vector = |name: &str, step: usize, power: i32| -> Vec<Vec3> {
            let [x, y, z] = ["X", "Y", "Z"].map(|axis| scalar(&results, &format!("{name}_{axis}"), step));
            let unit = model.look.size.powi(power);
            (0..count).map(|n| model.look.back([x[n], y[n], z[n]]).map(|x| x / unit)).collect()
        };
        let area = model.dim as i32 - 1;
        let lengths = |values: Vec<f64>, power: i32| -> Vec<f64> {
            values.into_iter().map(|value| value / model.look.size.powi(power)).collect()
        };
        let state = |step: usize| {
            let (displacement, normal) = (vector("DISPLACEMENT", step, 1), vector("NORMAL", step, 0));
            let position = model.nodes.iter().zip(&displacement).map(|(x, u)| std::array::from_fn(|c| x[c] + u[c]));
            let multiplier = match model.friction {
                Some(_) => vector(model.multiplier(), step, 0),
                None => {
                    let size = scalar(&results, model.multiplier(), step);
                    normal.iter().zip(size).map(|(n, size)| n.map(|n| n * size)).collect()
                }
            };
            State {
                position: position.collect(),
                reaction: vector("REACTION", step, area),
                multiplier,
                gap: lengths(scalar(&results, "WEIGHTED_GAP", step), area + 1),
                slip: if model.friction.is_some() {
                    vector("WEIGHTED_SLIP", step, area + 1)
                } else {
                    vec![[0.0; 3]; count]
                },
                area: lengths(scalar(&areas, "NODAL_AREA", step), area),
                displacement,
                normal,
            }
        };
        Ok(Self { states: (0..results.len()).map(state).collect(), iterations })
    }

    /// The state at the end.
    pub fn last(&self) -> &State {
        self.states.last().expect("a step")
    }

    /// What no accepted state may show, in words; `load` is the sum of the loads at a time from 0 to 1.
    pub fn faults(&self, model: &Model, load: impl Fn(f64) -> Vec3) -> Vec<String> {
        let mut faults = Vec::new();
        for (number, state) in self.states.iter().enumerate() {
            let time = (number + 1) as f64 / self.states.len() as f64;
            let mut found: Vec<String> = state.out_of_balance(model, load(time)).into_iter().collect();
            found.extend(state.contact(model));
            if model.dim == 2 {
                found.extend(state.uncovered(model));
            }
            faults.extend(found.into_iter().map(|fault| format!("step {}: {fault}", number + 1)));
        }
        faults
    }
}

impl State {
    /// Sum of the reactions of some nodes.
    pub fn sum(&self, nodes: &[usize]) -> Vec3 {
        nodes.iter().fold([0.0; 3], |sum, &n| std::array::from_fn(|c| sum[c] + self.reaction[n][c]))
    }

    /// Moment of the reactions of some nodes about the z axis through a point.
    pub fn moment(&self, nodes: &[usize], about: Vec3) -> f64 {
        let arm = |n: usize| sub(self.position[n], about);
        nodes.iter().map(|&n| arm(n)[0] * self.reaction[n][1] - arm(n)[1] * self.reaction[n][0]).sum()
    }

    /// Slave nodes in contact.
    pub fn touching(&self, model: &Model) -> Vec<usize> {
        slaves(model).into_iter().filter(|&n| norm(self.multiplier[n]) > 0.0).collect()
    }

    fn out_of_balance(&self, model: &Model, load: Vec3) -> Option<String> {
        let supports: BTreeSet<usize> = model.supported.iter().copied().collect();
        let supports: Vec<usize> = supports.into_iter().collect();
        let sum = self.sum(&supports);
        let size = supports.iter().map(|&n| norm(self.reaction[n])).sum::<f64>().max(norm(load)).max(LEAST_FORCE);
        let off = norm(std::array::from_fn(|c| sum[c] + load[c]));
        (off > BALANCE * size).then(|| format!("reactions and loads are out of balance by {off:.2e} of {size:.2e}"))
    }

    fn contact(&self, model: &Model) -> Vec<String> {
        let mut faults = Vec::new();
        let sizes = mesh_sizes(model);
        let slaves = slaves(model);
        let normal = |n: usize| dot(self.multiplier[n], self.normal[n]);
        let largest = slaves.iter().map(|&n| normal(n).abs()).fold(0.0, f64::max);
        for &n in &slaves {
            let (pressure, h) = (-normal(n), sizes[&n]);
            let gap = if self.area[n] > 0.0 { self.gap[n] / self.area[n] } else { f64::INFINITY };
            let mut fault = |what: String| faults.push(format!("node {}: {what}", n + 1));
            if pressure < -TRACTION * largest {
                fault(format!("tension {:.2e} of {largest:.2e}", -pressure));
            }
            if gap < -GAP * h {
                fault(format!("{:.2e} mesh sizes deep", -gap / h));
            }
            if pressure > TRACTION * largest && gap > GAP * h {
                fault(format!("pressed by {pressure:.2e} of {largest:.2e} across a gap of {:.2e} mesh sizes", gap / h));
            }
            let Some(friction) = model.friction else { continue };
            let along = sub(self.multiplier[n], self.normal[n].map(|x| x * normal(n)));
            let bound = friction * pressure;
            if norm(along) > bound + TRACTION * friction * largest {
                fault(format!(
                    "friction {:.4e} above its bound {bound:.4e}, largest pressure {largest:.2e}",
                    norm(along)
                ));
            }
            let slip = norm(self.slip[n]) / self.area[n].max(1e-300);
            if pressure > TRACTION * largest && slip > GAP * h {
                if dot(along, self.slip[n]) < 0.0 {
                    fault(format!("friction {:.2e} along the slip of {:.2e} mesh sizes", norm(along), slip / h));
                } else if norm(along) < bound - 2.0 * TRACTION * friction * largest {
                    fault(format!("slides by {:.2e} mesh sizes at {:.4} of its bound", slip / h, norm(along) / bound));
                }
            }
        }
        faults.truncate(5);
        faults
    }

    /// Pressed nodes whose facets face the master all over integrate the whole of them.
    fn uncovered(&self, model: &Model) -> Vec<String> {
        let mut faults = Vec::new();
        for [slave, master] in &model.pairs {
            let mut area: BTreeMap<usize, Option<f64>> = BTreeMap::new();
            for facet in slave {
                let [a, b] = [facet[0], facet[1]].map(|n| self.position[n]);
                let length = norm(sub(b, a));
                let outward = [(b[1] - a[1]) / length, -(b[0] - a[0]) / length, 0.0];
                let faces = (0..=8).all(|k| {
                    let from = std::array::from_fn(|c| a[c] + (b[c] - a[c]) * f64::from(k) / 8.0);
                    master.iter().any(|other| self.is_hit(from, outward, length, other))
                });
                for &n in facet {
                    let sum = area.entry(n).or_insert(Some(0.0));
                    *sum = sum.filter(|_| faces).map(|sum| sum + 0.5 * length);
                }
            }
            for (n, whole) in area {
                let Some(whole) = whole.filter(|_| norm(self.multiplier[n]) > 0.0) else { continue };
                if self.area[n] < (1.0 - COVERED) * whole {
                    faults.push(format!(
                        "node {}: {:.3e} of {whole:.3e} of its facets is integrated",
                        n + 1,
                        self.area[n]
                    ));
                }
            }
        }
        faults.truncate(5);
        faults
    }

    /// Whether a ray from a point both ways along `direction`, up to half of `reach`, meets a facet that looks back.
    fn is_hit(&self, from: Vec3, direction: Vec3, reach: f64, facet: &[usize]) -> bool {
        let [c, d] = [facet[0], facet[1]].map(|n| self.position[n]);
        let along = sub(d, c);
        let cross = |a: Vec3, b: Vec3| a[0] * b[1] - a[1] * b[0];
        let by = cross(direction, along);
        let looks_back = -by > 0.5 * norm(along);
        let to = sub(c, from);
        let (distance, at) = (cross(to, along) / by, cross(to, direction) / by);
        looks_back && distance.abs() < 0.5 * reach && (-1e-6..=1.0 + 1e-6).contains(&at)
    }
}

fn slaves(model: &Model) -> Vec<usize> {
    let nodes: BTreeSet<usize> = model.pairs.iter().flat_map(|[slave, _]| slave.concat()).collect();
    nodes.into_iter().collect()
}

/// Length of the longest edge of the slave facets of each node.
fn mesh_sizes(model: &Model) -> BTreeMap<usize, f64> {
    let mut sizes = BTreeMap::new();
    for facet in model.pairs.iter().flat_map(|[slave, _]| slave) {
        for (at, &n) in facet.iter().enumerate() {
            let next = facet[(at + 1) % facet.len()];
            let length = norm(sub(model.nodes[n], model.nodes[next]));
            for n in [n, next] {
                let size: &mut f64 = sizes.entry(n).or_default();
                *size = size.max(length);
            }
        }
    }
    sizes
}
