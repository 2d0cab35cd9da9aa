//! Outcome of a run, and the conditions of every state of contact: balance, complementarity, friction, facets covered.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use crate::grid::Vec3;
use crate::model::Model;
use crate::support::{Results, read_json};

/// Largest error of balance, as a share of the largest reaction: that of the default tolerance of residuals.
const BALANCE: f64 = 2e-3;
/// Share of the forces that strain bodies, Young's modulus times displacement, that is round-off.
const ROUND_OFF: f64 = 1e-9;
/// Forces that count in every state, as a share of the largest of the run.
const LEAST_FORCE: f64 = 1e-2;
/// Bounds that the default tolerances imply: of tension, of gaps in mesh sizes, and of the bound of friction.
const TRACTION: f64 = 2e-3;
const GAP: f64 = 1e-3;
/// Share of a facet's length that may be uncovered where both sides are polygons.
const COVERED: f64 = 0.02;

/// Share of a node's facets, of that of a neighbour, below which it is at the master's edge.
const BESIDE: f64 = 0.11;

/// An accepted step, by node.
pub struct State {
    /// When it is, from 0 to 1.
    pub time: f64,
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
                time: results.times()[step],
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

    /// Faults of accepted states, in words; `load` is the sum of the loads at a time from 0 to 1.
    pub fn faults(&self, model: &Model, load: impl Fn(f64) -> Vec3) -> Vec<String> {
        let mut faults = Vec::new();
        let forces = self.states.iter().map(|state| state.forces(model, load(state.time)));
        let largest = forces.fold(0.0, f64::max);
        for (number, state) in self.states.iter().enumerate() {
            let mut found: Vec<String> = state.out_of_balance(model, load(state.time), largest).into_iter().collect();
            found.extend(state.contact(model));
            found.extend(state.uncovered(model));
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

    /// Sum of the sizes of all reactions, or the load where that is more; at least the round-off of forces that strain the bodies,
    /// where supports carry nothing.
    fn forces(&self, model: &Model, load: Vec3) -> f64 {
        let supports: BTreeSet<usize> = model.supported.iter().copied().collect();
        let strained = model.largest_young() * self.displacement.iter().map(|u| norm(*u)).fold(0.0, f64::max);
        supports.into_iter().map(|n| norm(self.reaction[n])).sum::<f64>().max(norm(load)).max(ROUND_OFF * strained)
    }

    /// `largest` is the largest [`State::forces`] of the run.
    fn out_of_balance(&self, model: &Model, load: Vec3, largest: f64) -> Option<String> {
        let supports: BTreeSet<usize> = model.supported.iter().copied().collect();
        let sum = self.sum(&supports.into_iter().collect::<Vec<_>>());
        let size = self.forces(model, load).max(LEAST_FORCE * largest);
        let off = norm(std::array::from_fn(|c| sum[c] + load[c]));
        (off > BALANCE * size).then(|| format!("reactions and loads are out of balance by {off:.2e} of {size:.2e}"))
    }

    fn contact(&self, model: &Model) -> Vec<String> {
        let mut faults = Vec::new();
        let sizes = mesh_sizes(model);
        let beside = self.beside(model);
        let slaves: Vec<usize> = slaves(model).into_iter().filter(|n| !beside.contains(n)).collect();
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
            let Some(friction) = model.friction.filter(|friction| *friction > 0.0) else { continue };
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

    /// Nodes at the master's edge: the covered share of their facets is small against that of a neighbour.
    fn beside(&self, model: &Model) -> BTreeSet<usize> {
        let facets = || model.pairs.iter().flat_map(|[slave, _]| slave);
        let mut whole: BTreeMap<usize, f64> = BTreeMap::new();
        for facet in facets() {
            let x: Vec<Vec3> = facet.iter().map(|&n| self.position[n]).collect();
            facet.iter().for_each(|&n| *whole.entry(n).or_default() += direction(&x).1 / facet.len() as f64);
        }
        let share = |n: usize| self.area[n] / whole[&n];
        let small = |facet: &Vec<usize>| {
            let most = facet.iter().map(|&n| share(n)).fold(0.0, f64::max);
            facet.iter().copied().filter(|&n| share(n) < BESIDE * most).collect::<Vec<_>>()
        };
        facets().flat_map(small).collect()
    }

    /// Pressed nodes whose facets face the master all over integrate the whole of them.
    fn uncovered(&self, model: &Model) -> Vec<String> {
        let mut faults = Vec::new();
        for [slave, master] in &model.pairs {
            let mut area: BTreeMap<usize, Option<f64>> = BTreeMap::new();
            for facet in slave {
                let x: Vec<Vec3> = facet.iter().map(|&n| self.position[n]).collect();
                let (outward, measure) = direction(&x);
                let reach = norm(sub(x[1], x[0]));
                let faces = samples(&x)
                    .into_iter()
                    .all(|from| master.iter().any(|other| self.is_hit(from, outward, reach, other)));
                for &n in facet {
                    let sum = area.entry(n).or_insert(Some(0.0));
                    *sum = sum.filter(|_| faces).map(|sum| sum + measure / facet.len() as f64);
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

    /// Whether a ray from a point both ways along `ray`, up to half of `reach`, meets a facet that looks back.
    fn is_hit(&self, from: Vec3, ray: Vec3, reach: f64, facet: &[usize]) -> bool {
        let x: Vec<Vec3> = facet.iter().map(|&n| self.position[n]).collect();
        let (across, _) = direction(&x);
        let slope = dot(across, ray);
        let distance = dot(sub(x[0], from), across) / slope;
        if slope > -0.5 || distance.abs() >= 0.5 * reach {
            return false;
        }
        let foot: Vec3 = std::array::from_fn(|c| from[c] + distance * ray[c]);
        let within = |a: Vec3, b: Vec3| {
            let (along, to) = (sub(b, a), sub(foot, a));
            match x.len() {
                2 => (-1e-6..=1.0 + 1e-6).contains(&(dot(along, to) / dot(along, along))),
                _ => dot(cross(along, to), across) >= -1e-6 * dot(along, along),
            }
        };
        (0..x.len()).all(|at| within(x[at], x[(at + 1) % x.len()]))
    }
}

fn cross(a: Vec3, b: Vec3) -> Vec3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The unit normal of a facet and its length or area.
fn direction(x: &[Vec3]) -> (Vec3, f64) {
    let normal = match x {
        [a, b] => [b[1] - a[1], a[0] - b[0], 0.0],
        [a, b, c] => cross(sub(*b, *a), sub(*c, *a)).map(|x| 0.5 * x),
        [a, b, c, d] => cross(sub(*c, *a), sub(*d, *b)).map(|x| 0.5 * x),
        _ => unreachable!("facets have two to four nodes"),
    };
    let size = norm(normal);
    (normal.map(|x| x / size), size)
}

/// Points all over a facet, its corners among them.
fn samples(x: &[Vec3]) -> Vec<Vec3> {
    let mean =
        |weights: &[f64]| -> Vec3 { std::array::from_fn(|c| weights.iter().zip(x).map(|(w, x)| w * x[c]).sum()) };
    let steps = || (0..=4).map(|k| f64::from(k) / 4.0);
    match x.len() {
        2 => (0..=8).map(|k| f64::from(k) / 8.0).map(|s| mean(&[1.0 - s, s])).collect(),
        3 => steps()
            .flat_map(|s| steps().map(move |t| [(1.0 - s) * (1.0 - t), s * (1.0 - t), t]))
            .map(|w| mean(&w))
            .collect(),
        _ => {
            let weights = |s: f64, t: f64| [(1.0 - s) * (1.0 - t), s * (1.0 - t), s * t, (1.0 - s) * t];
            steps().flat_map(|s| steps().map(move |t| weights(s, t))).map(|w| mean(&w)).collect()
        }
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
