//! Restraint of each body: the rigid-body modes that supports leave free, and whether contact, friction or nothing restrains them.
//!
//! Bodies are connected elements. Unknowns are the rigid-body modes of each body that its elements do not resist, and those of nodes
//! without elements that constraints name; supports, constraints, ties and places in contact are rows over them. Motions that all
//! rows leave alone are free.

use std::collections::BTreeMap;

use nalgebra::{DMatrix, SymmetricEigen};

use crate::assembly::System;
use crate::diagnostics::{Diagnostic, Report};
use crate::entities::{Join, LocalSystems, Request, Tangent};
use crate::model::{MasterSlaveConstraint, ModelPart, NodeUnknown, NumberedBodies, Rates, ScalarVariable};
use crate::processes::{DirectionalPrescription, Prescription};
use crate::strategies::body_in_words;
use crate::vector3::{add, cross, dot, norm, scale, sub};

/// Largest number of modes that are analysed: the cost grows with their third power.
const MOST: usize = 120;
/// Share of the largest eigenvalue below which a motion meets no row.
const FREE: f64 = 1e-10;
/// Nodes of a body that show whether a motion moves any.
const SAMPLE: usize = 64;
/// Share of its terms below which an element does not resist a motion.
const RIGID: f64 = 1e-8;

/// A rigid-body mode of a body: u(x) = translation + rotation × (x − centre) / size.
struct Motion {
    body: usize,
    translation: [f64; 3],
    rotation: [f64; 3],
}

/// The bodies of a part and their motions; alike on all ranks but for `of_node`, which knows the nodes that are here.
struct Bodies<'a> {
    part: &'a ModelPart,
    /// Body of each node; `usize::MAX` for nodes of none.
    of_node: Vec<usize>,
    /// The first node (id) of each body, its centre and its size.
    bodies: Vec<(usize, [f64; 3], f64)>,
    motions: Vec<Motion>,
    /// Unknowns of nodes of no body in constraints, as reference nodes have: each is one more motion, after those of the bodies.
    others: BTreeMap<NodeUnknown, usize>,
}

/// Reports before the run, in statics, the restraint of bodies that supports leave free; gives whether there are such bodies and
/// contact restrains them all. Collective.
pub(super) fn report_restraints(
    part: &ModelPart,
    system: &System,
    prescribed: &[Prescription],
    along: &[DirectionalPrescription],
    problems: &mut Report,
) -> bool {
    let Some(column) = Rates::moving(&part.nodes.history) else { return false };
    let Some(joins): Option<Vec<Vec<Join>>> = system.interactions.iter().map(|own| own.joins(part)).collect() else {
        return false;
    };
    let joins: Vec<Join> = joins.into_iter().flatten().collect();
    let mut bodies = Bodies::of(part);
    bodies.find_motions(system);
    bodies.find_others(column);
    let count = bodies.count();
    if bodies.motions.is_empty() || count > MOST {
        return false;
    }
    let mut rows = Rows { gram: DMatrix::zeros(count, count) };
    bodies.drop_immobile(&mut rows);
    bodies.support(column, prescribed, &mut rows);
    bodies.support_along(column, along, &mut rows);
    bodies.elements_on_ground(system, &mut rows);
    let tied = |join: &&Join| join.normal.is_none();
    joins.iter().filter(tied).for_each(|join| rows.join(&bodies, join, true));
    let by_supports = rows.free(part);
    if by_supports.is_empty() {
        return false;
    }
    joins.iter().filter(|join| !tied(join)).for_each(|join| rows.join(&bodies, join, false));
    let by_contact = rows.free(part);
    joins.iter().filter(|join| join.friction).for_each(|join| rows.join(&bodies, join, true));
    let by_friction = rows.free(part);
    for at in 0..bodies.bodies.len() {
        let [own, smooth, rough] = [&by_supports, &by_contact, &by_friction].map(|free| bodies.motions_of(at, free));
        let Some(name) = body_in_words(part, bodies.bodies[at].0).filter(|_| own > 0) else { continue };
        let modes = format!("{name} has {own} rigid-body {}", if own == 1 { "mode" } else { "modes" });
        problems.push(if rough > 0 {
            let fact =
                format!("{modes} that supports leave free; initial contact leaves {rough}: nothing restrains it");
            let remedy = "support it in all directions, or check that contact or a tie meets it from the first step";
            Diagnostic::warning("held-by-nothing", fact).remedy(remedy)
        } else if smooth > 0 {
            Diagnostic::note(
                "held-by-friction",
                format!("{modes} restrained by contact only, {smooth} by friction only"),
            )
        } else {
            Diagnostic::note("held-by-contact", format!("{modes} restrained by contact only"))
        });
    }
    by_friction.is_empty()
}

impl<'a> Bodies<'a> {
    fn of(part: &'a ModelPart) -> Self {
        let NumberedBodies { of_node, first } = NumberedBodies::of(part);
        let mut boxes = vec![[[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]]; first.len()];
        for (body, &x) in of_node.iter().zip(&part.nodes.initial) {
            body.iter().for_each(|&body| boxes[body] = joined(boxes[body], [x; 2]));
        }
        for of_rank in part.ranks.gather_numbers(boxes.as_flattened().as_flattened()) {
            let ends = of_rank.as_chunks::<3>().0.as_chunks::<2>().0;
            boxes.iter_mut().zip(ends).for_each(|(own, other)| *own = joined(*own, *other));
        }
        let body = |(name, [low, high]): (usize, [[f64; 3]; 2])| {
            (name, scale(add(low, high), 0.5), norm(sub(high, low)).max(f64::MIN_POSITIVE))
        };
        let bodies = first.into_iter().zip(boxes).map(body).collect();
        let of_node = of_node.into_iter().map(|body| body.unwrap_or(usize::MAX)).collect();
        Self { part, of_node, bodies, motions: Vec::new(), others: BTreeMap::new() }
    }

    /// The unknowns of nodes of no body in constraints that relate bodies by `column`.
    fn find_others(&mut self, column: &str) {
        for own in self.part.constraints.iter().filter(|own| relates_motions(own, column)) {
            for (node, variable) in own.masters.iter().map(|(unknown, _)| *unknown).chain([own.slave]) {
                if self.of_node[node as usize] == usize::MAX || variable.column != column {
                    let next = self.motions.len() + self.others.len();
                    self.others.entry((node, variable)).or_insert(next);
                }
            }
        }
    }

    /// Number of motions of bodies and other nodes.
    fn count(&self) -> usize {
        self.motions.len() + self.others.len()
    }

    /// The rigid-body modes that an element of the body does not resist; collective.
    fn find_motions(&mut self, system: &System) {
        let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let space = self.part.info.domain_size;
        let rotations = if space == 2 { &axes[2..] } else { &axes[..] };
        let translations = axes[..space].iter().map(|&translation| (translation, [0.0; 3]));
        let all: Vec<_> = translations.chain(rotations.iter().map(|&r| ([0.0; 3], r))).collect();
        // Of each body, the motions as bits; below zero where no element of it is here.
        let mut free = vec![-1.0; self.bodies.len()];
        for block in &system.elements {
            for at in 0..block.len() {
                let body = self.of_node[block.nodes(at)[0] as usize];
                if block.nodes(at).len() < 2 || body == usize::MAX || free[body] >= 0.0 {
                    continue;
                }
                let size = block.unknowns().len();
                let mut out = LocalSystems::default();
                out.reset(1, size, Request::Both);
                if block.local_systems(&self.part.view(), at..at + 1, Request::Both, &mut out).is_err() {
                    continue;
                }
                free[body] = 0.0;
                for (bit, &(translation, rotation)) in all.iter().enumerate() {
                    let motion = Motion { body, translation, rotation };
                    let values: Vec<f64> = block
                        .unknowns()
                        .iter()
                        .map(|unknown| {
                            let moves = Rates::of(unknown.variable.column).is_some_and(|rates| rates.moves_mesh);
                            let node = block.nodes(at)[usize::from(unknown.node)];
                            if moves { self.value(&motion, node)[unknown.variable.offset()] } else { 0.0 }
                        })
                        .collect();
                    let (lhs, _) = out.entity(0);
                    let is_rigid = lhs.chunks_exact(size).all(|row| {
                        let terms = row.iter().zip(&values).map(|(k, u)| k * u);
                        let (sum, all) =
                            terms.fold((0.0, 0.0), |(sum, all): (f64, f64), term| (sum + term, all + term.abs()));
                        let largest = row.iter().fold(0.0_f64, |most, k| most.max(k.abs()));
                        sum.abs() <= RIGID * all.max(largest)
                    });
                    free[body] += if is_rigid { f64::from(1_u8 << bit) } else { 0.0 };
                }
            }
        }
        let of_ranks = self.part.ranks.gather_numbers(&free);
        for body in 0..self.bodies.len() {
            let bits = of_ranks.iter().map(|free| free[body]).find(|bits| *bits >= 0.0).unwrap_or(0.0) as u8;
            let own = all.iter().enumerate().filter(|(bit, _)| bits >> bit & 1 == 1);
            self.motions.extend(own.map(|(_, &(translation, rotation))| Motion { body, translation, rotation }));
        }
    }

    fn value(&self, motion: &Motion, node: u32) -> [f64; 3] {
        let (_, centre, size) = self.bodies[motion.body];
        let arm = scale(sub(self.part.nodes.initial[node as usize], centre), size.recip());
        add(motion.translation, cross(motion.rotation, arm))
    }

    /// Displacement of a node in a direction, by each rigid-body mode.
    fn row(&self, node: u32, direction: [f64; 3], factor: f64, row: &mut [f64]) {
        let body = self.of_node[node as usize];
        for (entry, motion) in row.iter_mut().zip(&self.motions).filter(|(_, motion)| motion.body == body) {
            *entry += factor * dot(self.value(motion, node), direction);
        }
    }

    /// Rows of motions in which no node moves, as the turning of a bar about itself.
    fn drop_immobile(&self, rows: &mut Rows) {
        let mut moved = Rows { gram: DMatrix::zeros(self.count(), self.count()) };
        self.others.values().for_each(|&at| moved.gram[(at, at)] = 1.0);
        let mut counts = vec![0; self.bodies.len()];
        self.of_node.iter().filter(|&&body| body != usize::MAX).for_each(|&body| counts[body] += 1);
        let strides: Vec<usize> = counts.iter().map(|count| count / SAMPLE + 1).collect();
        for (node, &body) in self.of_node.iter().enumerate().filter(|(_, body)| **body != usize::MAX) {
            counts[body] -= 1;
            if !counts[body].is_multiple_of(strides[body]) {
                continue;
            }
            for c in 0..3 {
                let mut row = vec![0.0; self.count()];
                self.row(node as u32, std::array::from_fn(|d| f64::from(u8::from(c == d))), 1.0, &mut row);
                moved.add(&row);
            }
        }
        moved.free(self.part).iter().for_each(|motion| rows.add(motion));
    }

    /// Rows of fixed unknowns and of linear constraints.
    fn support(&self, column: &'static str, prescribed: &[Prescription], rows: &mut Rows) {
        let axis = |c: usize| std::array::from_fn(|d| f64::from(u8::from(c == d)));
        let mut add = |terms: &[(NodeUnknown, f64)]| {
            let mut row = vec![0.0; self.count()];
            for &((node, variable), factor) in terms {
                match self.others.get(&(node, variable)) {
                    Some(&at) => row[at] += factor,
                    None if variable.column == column => self.row(node, axis(variable.offset()), factor, &mut row),
                    None => {}
                }
            }
            rows.add(&row);
        };
        for own in prescribed {
            own.values.iter().for_each(|&(node, _)| add(&[((node, own.variable), 1.0)]));
        }
        let components = (0..3_u8).map(|c| ScalarVariable { column, component: Some(c) });
        for variable in components {
            let fixed = (0..self.part.nodes.len() as u32).filter(|&node| self.part.nodes.is_fixed(variable, node));
            fixed.for_each(|node| add(&[((node, variable), 1.0)]));
        }
        for own in self.part.constraints.iter().filter(|own| relates_motions(own, column)) {
            let masters = own.masters.iter().map(|&(unknown, weight)| (unknown, -weight));
            let terms: Vec<_> = std::iter::once((own.slave, 1.0)).chain(masters).collect();
            add(&terms);
        }
    }

    /// Rows of supports along directions.
    fn support_along(&self, column: &'static str, along: &[DirectionalPrescription], rows: &mut Rows) {
        let own = along.iter().filter(|own| own.column == column);
        for &(node, direction, _) in own.flat_map(|own| &own.values) {
            let mut row = vec![0.0; self.count()];
            self.row(node, direction, 1.0, &mut row);
            rows.add(&row);
        }
    }

    /// Rows of elements of one node and of conditions with stiffness: they restrain their nodes.
    fn elements_on_ground(&self, system: &System, rows: &mut Rows) {
        let stiff = |tangent: Tangent| matches!(tangent, Tangent::Constant | Tangent::Symmetric);
        let points = system.elements.iter().filter(|block| !block.is_empty() && block.nodes(0).len() == 1);
        for block in points.chain(&system.conditions).filter(|block| stiff(block.tangent())) {
            for &node in (0..block.len()).flat_map(|at| block.nodes(at)) {
                for c in 0..3 {
                    let mut row = vec![0.0; self.count()];
                    self.row(node, std::array::from_fn(|d| f64::from(u8::from(c == d))), 1.0, &mut row);
                    rows.add(&row);
                }
            }
        }
    }

    /// How many of these free motions a body takes part in.
    fn motions_of(&self, body: usize, free: &[Vec<f64>]) -> usize {
        let of_body: Vec<usize> = (0..self.motions.len()).filter(|&at| self.motions[at].body == body).collect();
        let n = of_body.len();
        if n == 0 || free.is_empty() {
            return 0;
        }
        let own = DMatrix::from_fn(n, free.len(), |row, column| free[column][of_body[row]]);
        own.rank(1e-4)
    }
}

/// Whether a constraint holds now and relates unknowns by which nodes move.
fn relates_motions(own: &MasterSlaveConstraint, column: &str) -> bool {
    let mut unknowns = own.masters.iter().map(|(unknown, _)| unknown).chain([&own.slave]);
    own.active && own.set.is_none() && unknowns.any(|(_, variable)| variable.column == column)
}

/// The box around two.
fn joined([low, high]: [[f64; 3]; 2], [lower, higher]: [[f64; 3]; 2]) -> [[f64; 3]; 2] {
    std::array::from_fn(|end| {
        std::array::from_fn(|c| if end == 0 { low[c].min(lower[c]) } else { high[c].max(higher[c]) })
    })
}

/// The sum of rᵀr over all rows r, those of this rank.
struct Rows {
    gram: DMatrix<f64>,
}

impl Rows {
    fn add(&mut self, row: &[f64]) {
        let filled: Vec<usize> = (0..row.len()).filter(|&at| row[at] != 0.0).collect();
        for &i in &filled {
            filled.iter().for_each(|&j| self.gram[(i, j)] += row[i] * row[j]);
        }
    }

    /// Rows of a place where two bodies meet: along the normal, or in all directions.
    fn join(&mut self, bodies: &Bodies<'_>, join: &Join, whole: bool) {
        let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let directions = match join.normal {
            Some(normal) if !whole => vec![normal],
            _ => axes.to_vec(),
        };
        for direction in directions {
            let mut row = vec![0.0; bodies.count()];
            bodies.row(join.nodes[0], direction, 1.0, &mut row);
            let other = bodies.of_node[join.nodes[1] as usize];
            // The place where they meet, as a point of the other body.
            for (entry, motion) in row.iter_mut().zip(&bodies.motions).filter(|(_, motion)| motion.body == other) {
                *entry -= dot(bodies.value(motion, join.nodes[0]), direction);
            }
            self.add(&row);
        }
    }

    /// Orthonormal motions that no row of any rank meets; collective.
    fn free(&self, part: &ModelPart) -> Vec<Vec<f64>> {
        let mut gram = self.gram.clone();
        part.ranks.sum(gram.as_mut_slice());
        let SymmetricEigen { eigenvectors, eigenvalues } = SymmetricEigen::new(gram);
        let largest = eigenvalues.iter().copied().fold(0.0, f64::max);
        let none = |value: f64| value <= FREE * largest || largest == 0.0;
        let columns = (0..eigenvalues.len()).filter(|&at| none(eigenvalues[at]));
        columns.map(|at| eigenvectors.column(at).iter().copied().collect()).collect()
    }
}
