//! A reference node R with the mean motion of a cloud of nodes, whose weights are w_i and s_i ([`super::resultant`]).
//!
//! The rotation R of the cloud is that of its polar decomposition, Σ a_i × x_i = 0 with the rotated arms a_i = R s_i, and
//! x_R = Σ w_i x_i/A + d with d = R (X_R − c). A change of both is
//!
//! K δω = Σ a_i × δx_i, K = Σ (x_i·a_i) I − a_i x_iᵀ, δx_R = Σ w_i δx_i/A + δω × d.
//!
//! Force F and moment M of R reach node i as w_i F/A + q × a_i with Kᵀ q = M + d × F, whose moment about R is M at any rotation. For
//! small rotations K = J and a_i = s_i. The constraints eliminate the unknowns of R or, where supports prescribe them, as many unknowns
//! of the cloud. They are linearised at the present state: their weights are the derivatives, their constants make them exact there.

use std::ops::Range;

use nalgebra::Matrix3;
use zelus_core::diagnostics::{Diagnostic, Result};
use zelus_core::model::{MasterSlaveConstraint, ModelPart, NodeUnknown, ScalarVariable, Variable};
use zelus_core::processes::Target;
use zelus_core::vector3::{add, cross, dot, norm, scale, sub};

use super::constraints_of_process::passing_on;
use super::kinematic_coupling::KinematicCoupling;
use super::large_rotation::{RotatingCoupling, rotation_of, vector_at};
use super::reference_node::components;
use super::resultant::Resultant;
use super::rotation_stiffness::{Matrix, RotationTangent, add_scaled, of_arm};
use super::rotation_vector::{rotated, spin, vector_of};
use crate::variables::{
    ACCELERATION, ANGULAR_ACCELERATION, ANGULAR_VELOCITY, DISPLACEMENT, REACTION, REACTION_MOMENT, ROTATION, VELOCITY,
    WHOLE_TURNS,
};

/// Share of the largest weight that is round-off.
const ROUND_OFF: f64 = 1e-15;
/// Share of the largest weight of its row below which the pivot of a row is replaced.
const SMALL_PIVOT: f64 = 0.1;
/// Time level of the start of a step.
const START: usize = 1;

/// Row of an unknown of the reference node: Σ weight · u − unknown + constant = 0, with a weight for each node.
pub(super) struct Row {
    pub unknown: ScalarVariable,
    pub weights: Vec<[f64; 3]>,
    pub constant: f64,
}

/// A distributing coupling.
#[derive(Clone)]
pub(super) struct DistributingCoupling {
    pub target: Target,
    /// Reference node.
    pub reference: u32,
    /// The cloud with its weights.
    pub resultant: Resultant,
    /// Whether the unknowns of the reference node stay, and those of nodes are eliminated.
    pub leads: bool,
    /// A few nodes of the cloud far from each other, whose rotation is the one by which the forces of the reference node rotate in the
    /// tangent; none where that node leads. All nodes would couple each to each.
    pub sample: Vec<u32>,
    /// Masses that follow the reference node.
    pub masses: KinematicCoupling,
    /// Its constraints, by their place in the model part.
    pub made: Range<usize>,
}

/// The cloud at a state.
struct Cloud {
    /// Positions of the nodes, rotated arms a_i.
    x: Vec<[f64; 3]>,
    arms: Vec<[f64; 3]>,
    /// The centre, and d.
    centre: [f64; 3],
    offset: [f64; 3],
    /// K⁻¹.
    inverse: Matrix3<f64>,
}

impl Cloud {
    /// q with Kᵀ q = M.
    fn spread(&self, moment: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|c| (0..3).map(|r| self.inverse[(r, c)] * moment[r]).sum())
    }

    /// K⁻¹ Σ a_i × v_i.
    fn spin_of(&self, vectors: &[[f64; 3]]) -> [f64; 3] {
        let sum = self.arms.iter().zip(vectors).fold([0.0; 3], |sum, (a, v)| add(sum, cross(*a, *v)));
        std::array::from_fn(|r| (0..3).map(|c| self.inverse[(r, c)] * sum[c]).sum())
    }
}

/// Nodes of a sample.
const SAMPLE: usize = 8;

/// Some nodes of a cloud, each the farthest from those before.
pub(super) fn far_nodes(part: &ModelPart, resultant: &Resultant) -> Vec<u32> {
    let distance = |node: u32, from: [f64; 3]| norm(sub(part.nodes.initial[node as usize], from));
    let mut open: Vec<(u32, f64)> = resultant.nodes().map(|node| (node, distance(node, resultant.centre))).collect();
    let mut taken = Vec::new();
    while taken.len() < SAMPLE {
        let farthest = open.iter().copied().reduce(|most, own| if own.1 > most.1 { own } else { most });
        let Some((next, _)) = farthest.filter(|(_, distance)| *distance > 0.0) else { break };
        taken.push(next);
        for (node, least) in &mut open {
            let own = distance(*node, part.nodes.initial[next as usize]);
            *least = if taken.len() == 1 { own } else { least.min(own) };
        }
    }
    taken
}

fn unit(k: u8) -> [f64; 3] {
    std::array::from_fn(|c| f64::from(u8::from(c == usize::from(k))))
}

/// Terms beyond round-off of the largest.
fn relevant(terms: Vec<(NodeUnknown, [f64; 2])>) -> Vec<(NodeUnknown, [f64; 2])> {
    let size = |[weight, force]: [f64; 2]| weight.abs().max(force.abs());
    let largest = terms.iter().fold(0.0_f64, |most, (_, own)| most.max(size(*own)));
    terms.into_iter().filter(|(_, own)| size(*own) > ROUND_OFF * largest).collect()
}

impl DistributingCoupling {
    /// The rows for small rotations; `None` where nodes on a line do not determine a rotation.
    pub fn small_rows(&self, part: &ModelPart) -> Option<Vec<Row>> {
        let at = part.nodes.initial[self.reference as usize];
        let [translations, rotations] = components(part.info.domain_size);
        let row = |unknown, force, moment| {
            Some(Row { unknown, weights: self.resultant.forces(force, moment, at)?, constant: 0.0 })
        };
        let by_force = translations.iter().map(|&c| row(DISPLACEMENT.component(c), unit(c), [0.0; 3]));
        let by_moment = rotations.iter().map(|&c| row(ROTATION.component(c), [0.0; 3], unit(c)));
        by_force.chain(by_moment).collect()
    }

    /// The constraints for small rotations; `None` where nodes on a line do not determine a rotation.
    pub fn small_constraints(&self, part: &ModelPart) -> Option<Vec<MasterSlaveConstraint>> {
        Some(self.constraints(part.info.domain_size, &self.small_rows(part)?, &unit, &[]))
    }

    /// Displacement components of the nodes.
    fn of_nodes(&self, space: usize) -> Vec<NodeUnknown> {
        let unknowns = |node| (0..space).map(move |c| (node, DISPLACEMENT.component(c as u8)));
        self.resultant.nodes().flat_map(unknowns).collect()
    }

    /// The constraints of rows. The k-th rotation of a row is the k-th component of `spins` of the unknowns; `pivots` are those of the
    /// last constraints.
    fn constraints(
        &self,
        space: usize,
        rows: &[Row],
        spins: &dyn Fn(u8) -> [f64; 3],
        pivots: &[NodeUnknown],
    ) -> Vec<MasterSlaveConstraint> {
        let of_nodes = self.of_nodes(space);
        if self.leads {
            return self.nodes_follow(rows, &of_nodes, (space, spins), pivots);
        }
        let follows = |row: &Row| {
            let weights = row.weights.iter().flat_map(|weight| &weight[..space]);
            let terms = of_nodes.iter().copied().zip(weights.map(|weight| [*weight; 2])).collect();
            passing_on((self.reference, row.unknown), relevant(terms), row.constant)
        };
        rows.iter().map(follows).collect()
    }

    /// As many unknowns of the nodes by the others and those of the reference node: Gauss–Jordan elimination, by the pivots given as
    /// long as they are not small, else with full pivoting.
    fn nodes_follow(
        &self,
        rows: &[Row],
        of_nodes: &[NodeUnknown],
        (space, spins): (usize, &dyn Fn(u8) -> [f64; 3]),
        pivots: &[NodeUnknown],
    ) -> Vec<MasterSlaveConstraint> {
        let given: Vec<usize> =
            pivots.iter().filter_map(|pivot| of_nodes.iter().position(|own| own == pivot)).collect();
        let given = if given.len() == rows.len() { &given[..] } else { &[] };
        // Σ a u − Σ b u_R + c = 0, row by row, each scaled to its largest weight.
        let scaled = |(at, row): (usize, &Row)| {
            let weights = || row.weights.iter().flat_map(|weight| &weight[..space]);
            let factor = weights().fold(0.0_f64, |most, weight| most.max(weight.abs())).recip();
            let of_reference = (0..rows.len()).map(|other| if other == at { -factor } else { 0.0 });
            let constant = std::iter::once(factor * row.constant);
            weights().map(|weight| factor * weight).chain(of_reference).chain(constant).collect::<Vec<f64>>()
        };
        let mut system: Vec<Vec<f64>> = rows.iter().enumerate().map(scaled).collect();
        let mut pivots: Vec<Option<usize>> = vec![None; rows.len()];
        for &column in given.iter().chain(std::iter::repeat_n(&usize::MAX, rows.len())) {
            let open = || (0..rows.len()).filter(|&row| pivots[row].is_none());
            let size = |&(row, column): &(usize, usize)| system[row][column].abs();
            let entries = open().flat_map(|row| (0..of_nodes.len()).map(move |column| (row, column)));
            let Some(largest) = entries.max_by(|a, b| size(a).total_cmp(&size(b))) else { break };
            let own = open().map(|row| (row, column)).filter(|&(_, column)| column != usize::MAX);
            let own = own.max_by(|a, b| size(a).total_cmp(&size(b)));
            let is_fit = own.as_ref().is_some_and(|own| size(own) > SMALL_PIVOT * size(&largest));
            let (row, column) = if is_fit { own.unwrap_or(largest) } else { largest };
            pivots[row] = Some(column);
            let lead = system[row][column];
            system[row].iter_mut().for_each(|entry| *entry /= lead);
            let own = system[row].clone();
            for other in (0..rows.len()).filter(|&other| other != row) {
                let factor = system[other][column];
                system[other].iter_mut().zip(&own).for_each(|(entry, own)| *entry -= factor * own);
            }
        }
        let follows = |(row, pivot): (&Vec<f64>, &Option<usize>)| {
            let pivot = (*pivot)?;
            let is_pivot = |at: usize| pivots.contains(&Some(at));
            let others = (0..of_nodes.len()).filter(|&at| !is_pivot(at)).map(|at| (of_nodes[at], [-row[at]; 2]));
            let shares = &row[of_nodes.len()..][..rows.len()];
            // Rotations of the rows are spins: by the unknowns δω = T δθ.
            let of_reference = rows.iter().zip(shares).map(|(own, share)| {
                let weight = match own.unknown.component.filter(|_| own.unknown.column == ROTATION.name()) {
                    Some(l) => {
                        let column = spins(l);
                        let turned =
                            rows.iter().zip(shares).filter(|(other, _)| other.unknown.column == ROTATION.name());
                        turned.map(|(k, share)| share * column[usize::from(k.unknown.component.unwrap_or(0))]).sum()
                    }
                    None => *share,
                };
                ((self.reference, own.unknown), [-weight, -share])
            });
            let terms = relevant(others.chain(of_reference).collect());
            Some(passing_on(of_nodes[pivot], terms, -row[of_nodes.len() + rows.len()]))
        };
        system.iter().zip(&pivots).filter_map(follows).collect()
    }

    /// The cloud at positions of its nodes and a rotation; `None` where that has no derivative.
    fn cloud(&self, part: &ModelPart, x: Vec<[f64; 3]>, turned: &dyn Fn([f64; 3]) -> [f64; 3]) -> Option<Cloud> {
        let arms: Vec<[f64; 3]> = self.resultant.shares().map(|(_, _, s)| turned(s)).collect();
        let mut k = Matrix3::<f64>::zeros();
        for (x, a) in x.iter().zip(&arms) {
            let along = dot(*x, *a);
            (0..9).for_each(|at| {
                let (r, c) = (at / 3, at % 3);
                k[(r, c)] += if r == c { along } else { 0.0 } - a[r] * x[c];
            });
        }
        let inverse = match part.info.domain_size {
            2 => Matrix3::from_diagonal(&[0.0, 0.0, k[(2, 2)].recip()].into()),
            _ => k.try_inverse()?,
        };
        let shares = self.resultant.shares().zip(&x);
        let centre = shares.fold([0.0; 3], |sum, ((_, share, _), x)| add(sum, scale(*x, share)));
        let offset = turned(sub(part.nodes.initial[self.reference as usize], self.resultant.centre));
        inverse.iter().all(|entry| entry.is_finite()).then_some(Cloud { x, arms, centre, offset, inverse })
    }

    /// Present positions of the nodes.
    fn positions(&self, part: &ModelPart) -> Vec<[f64; 3]> {
        let position = |node: u32| add(part.nodes.initial[node as usize], vector_at(part, &DISPLACEMENT, node));
        self.resultant.nodes().map(position).collect()
    }

    /// The rows at a state of the cloud: the unknowns are u_R, and θ from `theta` on by spins.
    fn rows(&self, part: &ModelPart, cloud: &Cloud, theta: [f64; 3]) -> Vec<Row> {
        let [translations, rotations] = components(part.info.domain_size);
        let lag = cloud.spin_of(&cloud.x);
        let reference = part.nodes.initial[self.reference as usize];
        let motion = sub(add(add(cloud.centre, cloud.offset), cross(lag, cloud.offset)), reference);
        let row = |unknown, force: [f64; 3], moment: [f64; 3], value: f64| {
            let q = cloud.spread(moment);
            let weight =
                |((_, share, _), arm): ((u32, f64, [f64; 3]), &[f64; 3])| add(scale(force, share), cross(q, *arm));
            let weights: Vec<[f64; 3]> = self.resultant.shares().zip(&cloud.arms).map(weight).collect();
            let initial = self.resultant.nodes().map(|node| part.nodes.initial[node as usize]);
            let linear: f64 =
                weights.iter().zip(&cloud.x).zip(initial).map(|((w, x), from)| dot(*w, sub(*x, from))).sum();
            Row { unknown, weights, constant: value - linear }
        };
        let by_force = translations
            .iter()
            .map(|&c| row(DISPLACEMENT.component(c), unit(c), cross(cloud.offset, unit(c)), motion[usize::from(c)]));
        let by_moment = rotations.iter().map(|&c| {
            let at = usize::from(c);
            row(ROTATION.component(c), [0.0; 3], unit(c), theta[at] + lag[at])
        });
        by_force.chain(by_moment).collect()
    }

    fn unknown_rotation(&self) -> Diagnostic {
        let fact =
            format!("the nodes of {} have come onto a line or a point: their rotation is unknown", self.target.path);
        let problem = Diagnostic::error("moment-without-arm", fact).at(self.target.place.clone());
        problem.remedy("use kinematic_coupling_process, or couple a larger surface")
    }

    /// The constraints at the present state, and the rotation θ − β there.
    fn present(&self, part: &ModelPart, pivots: &[NodeUnknown]) -> Option<(Vec<MasterSlaveConstraint>, [f64; 3])> {
        let space = part.info.domain_size;
        let (last, turns) = (rotation_of(part, self.reference), vector_at(part, &WHOLE_TURNS, self.reference));
        let x = self.positions(part);
        if self.leads {
            let cloud = self.cloud(part, x, &|v| rotated(last, v))?;
            // Σ a u − T θ + (c + T θ at this state) = 0.
            let counted = spin(last, add(last, turns));
            let rows = self.rows(part, &cloud, counted);
            return Some((self.constraints(space, &rows, &|l| spin(last, unit(l)), pivots), last));
        }
        let rotation = self.resultant.rotation_to(&x, space)?;
        let theta = vector_of(&rotation, last);
        let cloud = self.cloud(part, x, &|v| rotation.map(|row| dot(row, v)))?;
        let rows = self.rows(part, &cloud, add(theta, turns));
        Some((self.constraints(space, &rows, &unit, pivots), theta))
    }

    /// Gives the reference node VELOCITY and ACCELERATION of the cloud at the start of the step, and the masses theirs.
    pub fn start(&self, part: &mut ModelPart, large: bool) {
        let at_start = |variable: &Variable<[f64; 3]>| -> Vec<[f64; 3]> {
            let Some(field) = part.nodes.history.get(variable.name()) else { return Vec::new() };
            self.resultant.nodes().map(|node| field.vector(START, node as usize)).collect()
        };
        let [velocities, mut accelerations] = [&VELOCITY, &ACCELERATION].map(at_start);
        if self.leads || velocities.iter().chain(&accelerations).all(|v| *v == [0.0; 3]) {
            return self.masses.start(part, large);
        }
        let theta = if large { rotation_of(part, self.reference) } else { [0.0; 3] };
        let Some(cloud) = self.cloud(part, self.positions(part), &|v| rotated(theta, v)) else { return };
        let mean = |vectors: &[[f64; 3]]| {
            self.resultant.shares().zip(vectors).fold([0.0; 3], |sum, ((_, share, _), v)| add(sum, scale(*v, share)))
        };
        let omega = cloud.spin_of(&velocities);
        let inward = |arm: [f64; 3]| if large { cross(omega, cross(omega, arm)) } else { [0.0; 3] };
        // Where no acceleration is given, the spin is steady.
        let is_given = accelerations.iter().any(|a| *a != [0.0; 3]);
        accelerations
            .iter_mut()
            .zip(&cloud.x)
            .filter(|_| is_given)
            .for_each(|(a, x)| *a = sub(*a, inward(sub(*x, cloud.centre))));
        let alpha = cloud.spin_of(&accelerations);
        let v = add(mean(&velocities), cross(omega, cloud.offset));
        let a = add(add(mean(&accelerations), cross(alpha, cloud.offset)), inward(cloud.offset));
        let all = [(&VELOCITY, v), (&ACCELERATION, a), (&ANGULAR_VELOCITY, omega), (&ANGULAR_ACCELERATION, alpha)];
        for (variable, value) in all {
            let Some(field) = part.nodes.history.get_mut(variable.name()) else { continue };
            field.levels[START][3 * self.reference as usize..][..3].copy_from_slice(&value);
        }
        self.masses.start(part, large);
    }
}

impl RotatingCoupling for DistributingCoupling {
    fn reference(&self) -> u32 {
        self.reference
    }

    fn follow(&mut self, part: &mut ModelPart, begins: bool) -> Result<()> {
        let own = &part.constraints[self.made.clone()];
        let pivots: Vec<NodeUnknown> = if begins { Vec::new() } else { own.iter().map(|own| own.slave).collect() };
        let (new, theta) = self.present(part, &pivots).ok_or_else(|| self.unknown_rotation())?;
        for (own, new) in part.constraints[self.made.clone()].iter_mut().zip(new) {
            (own.slave, own.masters, own.forces, own.constant) = (new.slave, new.masters, new.forces, new.constant);
        }
        let turns = vector_at(part, &WHOLE_TURNS, self.reference);
        self.masses.renew(part, theta, turns);
        Ok(())
    }

    fn sample(&self) -> &[u32] {
        &self.sample
    }

    fn tangent(&self, part: &ModelPart) -> Option<RotationTangent> {
        let space = part.info.domain_size;
        let mut theta = rotation_of(part, self.reference);
        let x = self.positions(part);
        if !self.leads {
            theta = vector_of(&self.resultant.rotation_to(&x, space)?, theta);
        }
        let cloud = self.cloud(part, x, &|v| rotated(theta, v))?;
        let share = if part.owns_node(self.reference as usize) { -1.0 } else { 0.0 };
        let mut loads = [&REACTION, &REACTION_MOMENT].map(|of| scale(vector_at(part, of, self.reference), share));
        if part.share.is_some() {
            part.ranks.sum(loads.as_flattened_mut());
        }
        let [force, moment] = loads;
        let q = cloud.spread(add(moment, cross(cloud.offset, force)));
        let of_node = |sum, (x, arm): (&[f64; 3], &[f64; 3])| {
            add_scaled(sum, of_arm(sub(*x, cloud.centre), cross(q, *arm)), -1.0)
        };
        let l = cloud.x.iter().zip(&cloud.arms).fold(of_arm(cloud.offset, force), of_node);
        let [translations, rotations] = components(space);
        if self.sample.is_empty() {
            return Some(RotationTangent {
                l,
                ways: rotations.iter().map(|&k| [unit(k), spin(theta, unit(k))]).collect(),
            });
        }
        let place = |node: &u32| add(part.nodes.initial[*node as usize], vector_at(part, &DISPLACEMENT, *node));
        let places: Vec<[f64; 3]> = self.sample.iter().map(place).collect();
        let centre = scale(places.iter().fold([0.0; 3], |sum, x| add(sum, *x)), (places.len() as f64).recip());
        let arms: Vec<[f64; 3]> = places.iter().map(|x| sub(*x, centre)).collect();
        let inertia = arms.iter().fold(Matrix::default(), |sum, arm| add_scaled(sum, of_arm(*arm, *arm), 1.0));
        let inverse = match space {
            2 => Matrix3::from_diagonal(&[0.0, 0.0, inertia[2][2].recip()].into()),
            _ => Matrix3::from_fn(|r, c| inertia[r][c]).try_inverse()?,
        };
        let way = |arm: &[f64; 3], c: u8| {
            let spin = cross(*arm, unit(c));
            let own: [f64; 3] = std::array::from_fn(|r| (0..3).map(|c| inverse[(r, c)] * spin[c]).sum());
            [own; 2]
        };
        let ways = arms.iter().flat_map(|arm| translations.iter().map(move |&c| way(arm, c))).collect();
        Some(RotationTangent { l, ways })
    }
}

#[cfg(test)]
mod tests {
    use zelus_core::model::{Nodes, SubPart};
    use zelus_core::parameters::Interval;

    use super::*;
    use crate::test_model::Random;

    type Vec3 = [f64; 3];

    /// A cloud of nodes about a reference node, the last one, at a rotation of its nodes and of the node, with some strain.
    fn model(space: usize, leads: bool, theta: Vec3) -> (ModelPart, DistributingCoupling) {
        let mut random = Random(3);
        let mut x: Vec<Vec3> = (0..6).map(|_| random.vector(1.0, space)).collect();
        x.push(random.vector(2.0, space));
        let mut part = ModelPart::new("test");
        part.info.domain_size = space;
        part.nodes = Nodes::new((1..=x.len()).collect(), x.clone());
        for variable in [&DISPLACEMENT, &ROTATION, &WHOLE_TURNS] {
            part.nodes.history.add(variable);
        }
        let selection = SubPart { nodes: (0..6).collect(), ..SubPart::new("cloud") };
        let resultant = Resultant::of(&part, &selection);
        for (node, &x) in x.iter().enumerate() {
            let u = add(sub(rotated(theta, x), x), random.vector(if node < 6 { 0.2 } else { 0.0 }, space));
            part.nodes.history.get_mut("DISPLACEMENT").expect("a column").levels[0][3 * node..][..3]
                .copy_from_slice(&u);
        }
        part.nodes.history.get_mut("ROTATION").expect("a column").levels[0][18..].copy_from_slice(&theta);
        let target = Target {
            path: "test".to_owned(),
            interval: Interval::ALWAYS,
            place: zelus_core::diagnostics::Place::command_line("test"),
            process: "coupling".to_owned(),
        };
        let masses = KinematicCoupling {
            reference: 6,
            arms: Vec::new(),
            coupled: Vec::new(),
            masses: Vec::new(),
            by_spins: !leads,
            made: 0..0,
        };
        (part, DistributingCoupling { target, reference: 6, resultant, leads, sample: Vec::new(), masses, made: 0..0 })
    }

    const CASES: [(usize, Vec3); 4] =
        [(2, [0.0, 0.0, 0.0]), (2, [0.0, 0.0, 2.5]), (3, [0.0, 0.0, 0.0]), (3, [1.1, -1.6, 1.4])];

    /// The rotation of the reference node is the polar one, and the weights are the derivatives of its motion, here against differences of fourth
    /// order; a change of its rotation is that of the rotated arms.
    #[test]
    fn weights_are_derivatives_of_the_motion() {
        for (space, theta) in CASES {
            let (part, coupling) = model(space, false, theta);
            let state = |h: f64, (node, c): (usize, usize)| {
                let mut moved = part.clone();
                moved.nodes.history.get_mut("DISPLACEMENT").expect("a column").levels[0][3 * node + c] += h;
                let (_, rotation) = coupling.present(&moved, &[]).expect("a rotation");
                let cloud =
                    coupling.cloud(&moved, coupling.positions(&moved), &|v| rotated(rotation, v)).expect("a cloud");
                assert!(norm(cloud.spin_of(&cloud.x)) < 1e-14);
                (rotation, add(cloud.centre, cloud.offset))
            };
            let (constraints, now) = coupling.present(&part, &[]).expect("a rotation");
            for (node, c) in (0..6).flat_map(|node| (0..space).map(move |c| (node, c))) {
                let difference = |part: usize, h: f64| {
                    let [(r, x), (s, y)] = [h, -h].map(|h| state(h, (node, c)));
                    scale(if part == 0 { sub(x, y) } else { sub(r, s) }, 0.5 / h)
                };
                let fine = |part: usize| {
                    sub(scale(difference(part, 1e-3), 4.0 / 3.0), scale(difference(part, 2e-3), 1.0 / 3.0))
                };
                let [motion, turned] = [fine(0), spin(now, fine(1))];
                for constraint in &constraints {
                    let (_, unknown) = constraint.slave;
                    let at = usize::from(unknown.component.expect("a component"));
                    let expected = if unknown.column == DISPLACEMENT.name() { motion[at] } else { turned[at] };
                    let own = (node as u32, DISPLACEMENT.component(c as u8));
                    let found = constraint.masters.iter().find(|(master, _)| *master == own).map_or(0.0, |own| own.1);
                    assert!((found - expected).abs() < 1e-8, "{space} {theta:?}: {found} {expected}");
                }
            }
        }
    }

    /// ANALYTIC: the nodes take a force and a moment of the reference node whole, about its present place, at any rotation.
    #[test]
    fn forces_and_moments_are_passed_on_whole() {
        for (space, theta) in CASES {
            let (part, coupling) = model(space, false, theta);
            let (constraints, _) = coupling.present(&part, &[]).expect("a rotation");
            let x = coupling.positions(&part);
            let value = |constraint: &MasterSlaveConstraint| {
                let own = |&((node, unknown), weight): &(NodeUnknown, f64)| {
                    weight * part.nodes.history.value(unknown, node as usize, 0).expect("a column")
                };
                constraint.constant + constraint.masters.iter().map(own).sum::<f64>()
            };
            let mut place = part.nodes.initial[6];
            for constraint in constraints.iter().filter(|own| own.slave.1.column == DISPLACEMENT.name()) {
                place[usize::from(constraint.slave.1.component.expect("a component"))] += value(constraint);
            }
            for constraint in &constraints {
                let (_, unknown) = constraint.slave;
                let (mut force, mut moment) = ([0.0; 3], [0.0; 3]);
                for &((node, of), weight) in &constraint.masters {
                    let own = scale(unit(of.component.expect("a component")), weight);
                    force = add(force, own);
                    moment = add(moment, cross(sub(x[node as usize], place), own));
                }
                let one = unit(unknown.component.expect("a component"));
                let wanted = if unknown.column == DISPLACEMENT.name() { [one, [0.0; 3]] } else { [[0.0; 3], one] };
                assert!(norm(sub(force, wanted[0])) < 1e-13, "{space} {theta:?}: {force:?}");
                assert!(norm(sub(moment, wanted[1])) < 1e-13, "{space} {theta:?}: {moment:?}");
            }
        }
    }

    /// Where the reference node leads, the constraints bring a state near the equations onto them with the square of its distance, and
    /// keep a motion of all other unknowns on them but for its square.
    #[test]
    fn eliminated_nodes_obey_the_equations() {
        for (space, theta) in CASES {
            let (mut part, coupling) = model(space, true, theta);
            let mut random = Random(7);
            let ways: Vec<Vec3> = (0..8).map(|_| random.vector(1.0, space)).collect();
            let value = |part: &ModelPart, (node, unknown): NodeUnknown| {
                part.nodes.history.value(unknown, node as usize, 0).expect("a column")
            };
            let moved = |part: &ModelPart, h: f64| {
                let mut moved = part.clone();
                let (constraints, _) = coupling.present(part, &[]).expect("a cloud");
                assert_eq!(constraints.len(), 3 * (space - 1));
                let turned =
                    components(space)[1].iter().map(|&c| ((6, ROTATION.component(c)), ways[7][usize::from(c) % space]));
                let displaced = (0..7_u32).flat_map(|node| (0..space as u8).map(move |c| (node, c)));
                let displaced =
                    displaced.map(|(node, c)| ((node, DISPLACEMENT.component(c)), ways[node as usize][usize::from(c)]));
                for (own, way) in displaced.chain(turned) {
                    moved.nodes.history.set_value(own.1, own.0 as usize, 0, value(part, own) + h * way);
                }
                let of = |constraint: &MasterSlaveConstraint| {
                    let sum = constraint.masters.iter().map(|&(own, weight)| weight * value(&moved, own)).sum::<f64>();
                    constraint.constant + sum
                };
                let values: Vec<f64> = constraints.iter().map(of).collect();
                for (constraint, value) in constraints.iter().zip(values) {
                    let (node, unknown) = constraint.slave;
                    moved.nodes.history.set_value(unknown, node as usize, 0, value);
                }
                moved
            };
            let lag = |part: &ModelPart| {
                let rotation = rotation_of(part, 6);
                let cloud = coupling.cloud(part, coupling.positions(part), &|v| rotated(rotation, v)).expect("a cloud");
                let place = add(part.nodes.initial[6], vector_at(part, &DISPLACEMENT, 6));
                norm(sub(add(cloud.centre, cloud.offset), place)) + norm(cloud.spin_of(&cloud.x))
            };
            let mut lags = vec![lag(&part)];
            for _ in 0..5 {
                part = moved(&part, 0.0);
                lags.push(lag(&part));
            }
            assert!(lags[0] > 0.05 && lags[5] < 1e-14, "{space} {theta:?}: {lags:?}");
            let [first, second] = [1e-2, 1e-3].map(|h| lag(&moved(&part, h)));
            assert!(first < 1e-2 && second < 0.02 * first, "{space} {theta:?}: {first:e} {second:e}");
        }
    }
}
