//! What holds each body: rigid motions that supports leave free, and whether contact, friction or nothing takes them.
//!
//! Bodies are connected elements. Of each, its rigid motions that its elements do not resist are unknowns; supports, constraints,
//! ties and places in contact are rows over them. Motions that all rows leave alone are free.

use nalgebra::{DMatrix, SymmetricEigen};

use crate::assembly::System;
use crate::diagnostics::{Diagnostic, Report};
use crate::entities::{Join, LocalSystems, Tangent, Want};
use crate::model::{ModelPart, Rates, ScalarVariable};
use crate::processes::Prescription;
use crate::strategies::body_of;
use crate::vector3::{add, cross, dot, norm, scale, sub};

/// Most motions that are looked at: the cost grows with their third power.
const MOST: usize = 120;
/// Share of the largest eigenvalue below which a motion meets no row.
const FREE: f64 = 1e-10;
/// Nodes of a body that show whether a motion moves any.
const SAMPLE: usize = 64;
/// Share of its terms below which an element does not resist a motion.
const RIGID: f64 = 1e-8;

/// A rigid motion of a body: u(x) = translation + rotation × (x − centre) / size.
struct Motion {
    body: usize,
    translation: [f64; 3],
    rotation: [f64; 3],
}

/// The bodies of a part and their motions.
struct Bodies<'a> {
    part: &'a ModelPart,
    /// Body of each node; `usize::MAX` for nodes of none.
    of_node: Vec<usize>,
    /// A node of each body, its centre and its size.
    bodies: Vec<(u32, [f64; 3], f64)>,
    motions: Vec<Motion>,
}

/// Says of bodies in statics that supports do not hold what does, before the run; one process only.
pub(super) fn tell_what_holds(part: &ModelPart, system: &System, prescribed: &[Prescription], problems: &mut Report) {
    let Some(column) = Rates::moving(&part.nodes.history).filter(|_| part.ranks.size() == 1) else { return };
    let Some(joins): Option<Vec<Vec<Join>>> = system.interactions.iter().map(|own| own.joins(part)).collect() else {
        return;
    };
    let joins: Vec<Join> = joins.into_iter().flatten().collect();
    let mut bodies = Bodies::of(part, system);
    bodies.find_motions(system);
    if bodies.motions.is_empty() || bodies.motions.len() > MOST {
        return;
    }
    let mut rows = Rows { gram: DMatrix::zeros(bodies.motions.len(), bodies.motions.len()) };
    bodies.drop_standing(&mut rows);
    bodies.support(column, prescribed, &mut rows);
    bodies.elements_on_ground(system, &mut rows);
    let tied = |join: &&Join| join.normal.is_none();
    joins.iter().filter(tied).for_each(|join| rows.join(&bodies, join, true));
    let by_supports = rows.free();
    if by_supports.is_empty() {
        return;
    }
    joins.iter().filter(|join| !tied(join)).for_each(|join| rows.join(&bodies, join, false));
    let by_contact = rows.free();
    joins.iter().filter(|join| join.friction).for_each(|join| rows.join(&bodies, join, true));
    let by_friction = rows.free();
    for at in 0..bodies.bodies.len() {
        let [own, smooth, rough] = [&by_supports, &by_contact, &by_friction].map(|free| bodies.motions_of(at, free));
        let name = bodies.name(at);
        if own == 0 {
            continue;
        }
        let supports = format!("supports leave {name} {own} rigid motions");
        problems.push(if rough > 0 {
            let fact = format!("{supports}, and contact as it begins leaves {rough}: nothing holds it");
            let remedy = "support it in all directions, or check that contact or a tie meets it from the first step";
            Diagnostic::warning("held-by-nothing", fact).remedy(remedy)
        } else if smooth > 0 {
            Diagnostic::note("held-by-friction", format!("{supports}, {smooth} of which friction alone holds"))
        } else {
            Diagnostic::note("held-by-contact", format!("{supports}, which contact alone holds"))
        });
    }
}

impl<'a> Bodies<'a> {
    fn of(part: &'a ModelPart, system: &System) -> Self {
        let mut parents: Vec<u32> = (0..part.nodes.len() as u32).collect();
        fn root(parents: &mut [u32], mut node: u32) -> u32 {
            while parents[node as usize] != node {
                parents[node as usize] = parents[parents[node as usize] as usize];
                node = parents[node as usize];
            }
            node
        }
        let mut used = vec![false; part.nodes.len()];
        for block in &system.elements {
            for nodes in (0..block.len()).map(|at| block.nodes(at)).filter(|nodes| nodes.len() > 1) {
                let first = root(&mut parents, nodes[0]);
                for &node in nodes {
                    used[node as usize] = true;
                    let other = root(&mut parents, node);
                    parents[other as usize] = first;
                }
            }
        }
        let mut of_node = vec![usize::MAX; part.nodes.len()];
        let mut roots: Vec<u32> = Vec::new();
        let mut boxes: Vec<[[f64; 3]; 2]> = Vec::new();
        let mut number = vec![usize::MAX; part.nodes.len()];
        for node in (0..part.nodes.len() as u32).filter(|&node| used[node as usize]) {
            let root = root(&mut parents, node) as usize;
            let x = part.nodes.initial[node as usize];
            if number[root] == usize::MAX {
                number[root] = roots.len();
                roots.push(node);
                boxes.push([x; 2]);
            }
            let [low, high] = &mut boxes[number[root]];
            (0..3).for_each(|c| (low[c], high[c]) = (low[c].min(x[c]), high[c].max(x[c])));
            of_node[node as usize] = number[root];
        }
        let body = |(node, [low, high]): (u32, [[f64; 3]; 2])| {
            (node, scale(add(low, high), 0.5), norm(sub(high, low)).max(f64::MIN_POSITIVE))
        };
        let bodies = roots.into_iter().zip(boxes).map(body).collect();
        Self { part, of_node, bodies, motions: Vec::new() }
    }

    /// The rigid motions that an element of the body does not resist.
    fn find_motions(&mut self, system: &System) {
        let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let space = self.part.info.domain_size;
        let mut seen = vec![false; self.bodies.len()];
        for block in &system.elements {
            for at in 0..block.len() {
                let body = self.of_node[block.nodes(at)[0] as usize];
                if block.nodes(at).len() < 2 || body == usize::MAX || std::mem::replace(&mut seen[body], true) {
                    continue;
                }
                let size = block.unknowns().len();
                let mut out = LocalSystems::default();
                out.reset(1, size, Want::Both);
                if block.local_systems(&self.part.view(), at..at + 1, Want::Both, &mut out).is_err() {
                    continue;
                }
                let translations = axes[..space].iter().map(|&translation| (translation, [0.0; 3]));
                let rotations = if space == 2 { &axes[2..] } else { &axes[..] };
                for (translation, rotation) in translations.chain(rotations.iter().map(|&r| ([0.0; 3], r))) {
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
                    if is_rigid {
                        self.motions.push(motion);
                    }
                }
            }
        }
    }

    fn value(&self, motion: &Motion, node: u32) -> [f64; 3] {
        let (_, centre, size) = self.bodies[motion.body];
        let arm = scale(sub(self.part.nodes.initial[node as usize], centre), size.recip());
        add(motion.translation, cross(motion.rotation, arm))
    }

    /// Motion of a node in a direction, by each rigid motion.
    fn row(&self, node: u32, direction: [f64; 3], factor: f64, row: &mut [f64]) {
        let body = self.of_node[node as usize];
        for (entry, motion) in row.iter_mut().zip(&self.motions).filter(|(_, motion)| motion.body == body) {
            *entry += factor * dot(self.value(motion, node), direction);
        }
    }

    /// Rows of motions in which no node moves, as the turning of a bar about itself.
    fn drop_standing(&self, rows: &mut Rows) {
        let mut moved = Rows { gram: DMatrix::zeros(self.motions.len(), self.motions.len()) };
        let mut counts = vec![0; self.bodies.len()];
        self.of_node.iter().filter(|&&body| body != usize::MAX).for_each(|&body| counts[body] += 1);
        let strides: Vec<usize> = counts.iter().map(|count| count / SAMPLE + 1).collect();
        for (node, &body) in self.of_node.iter().enumerate().filter(|(_, body)| **body != usize::MAX) {
            counts[body] -= 1;
            if !counts[body].is_multiple_of(strides[body]) {
                continue;
            }
            for c in 0..3 {
                let mut row = vec![0.0; self.motions.len()];
                self.row(node as u32, std::array::from_fn(|d| f64::from(u8::from(c == d))), 1.0, &mut row);
                moved.add(&row);
            }
        }
        moved.free().iter().for_each(|motion| rows.add(motion));
    }

    /// Rows of fixed unknowns and of linear constraints.
    fn support(&self, column: &'static str, prescribed: &[Prescription], rows: &mut Rows) {
        let axis = |c: usize| std::array::from_fn(|d| f64::from(u8::from(c == d)));
        let mut add = |terms: &[(u32, usize, f64)]| {
            let mut row = vec![0.0; self.motions.len()];
            terms.iter().for_each(|&(node, c, factor)| self.row(node, axis(c), factor, &mut row));
            rows.add(&row);
        };
        for own in prescribed.iter().filter(|own| own.variable.column == column) {
            own.values.iter().for_each(|&(node, _)| add(&[(node, own.variable.offset(), 1.0)]));
        }
        let components = (0..3_u8).map(|c| ScalarVariable { column, component: Some(c) });
        for variable in components {
            let fixed = (0..self.part.nodes.len() as u32).filter(|&node| self.part.nodes.is_fixed(variable, node));
            fixed.for_each(|node| add(&[(node, variable.offset(), 1.0)]));
        }
        for own in self.part.constraints.iter().filter(|own| own.active && own.slave.1.column == column) {
            let masters = own.masters.iter().map(|&((node, variable), weight)| (node, variable.offset(), -weight));
            let terms: Vec<_> = std::iter::once((own.slave.0, own.slave.1.offset(), 1.0)).chain(masters).collect();
            add(&terms);
        }
    }

    /// Rows of elements of one node and of conditions with stiffness: what they touch is held.
    fn elements_on_ground(&self, system: &System, rows: &mut Rows) {
        let stiff = |tangent: Tangent| matches!(tangent, Tangent::Constant | Tangent::Symmetric);
        let points = system.elements.iter().filter(|block| !block.is_empty() && block.nodes(0).len() == 1);
        for block in points.chain(&system.conditions).filter(|block| stiff(block.tangent())) {
            for &node in (0..block.len()).flat_map(|at| block.nodes(at)) {
                for c in 0..3 {
                    let mut row = vec![0.0; self.motions.len()];
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

    /// The smallest part that holds it, and a node.
    fn name(&self, body: usize) -> String {
        let node = self.bodies[body].0;
        let id = self.part.nodes.ids[node as usize];
        body_of(&self.part.tree, node)
            .map_or_else(|| format!("the body of node {id}"), |name| format!("the body of part {name} with node {id}"))
    }
}

/// The sum of rᵀr over all rows r.
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
            let mut row = vec![0.0; bodies.motions.len()];
            bodies.row(join.nodes[0], direction, 1.0, &mut row);
            let other = bodies.of_node[join.nodes[1] as usize];
            // The place where they meet, as a point of the other body.
            for (entry, motion) in row.iter_mut().zip(&bodies.motions).filter(|(_, motion)| motion.body == other) {
                *entry -= dot(bodies.value(motion, join.nodes[0]), direction);
            }
            self.add(&row);
        }
    }

    /// Orthonormal motions that no row meets.
    fn free(&self) -> Vec<Vec<f64>> {
        let SymmetricEigen { eigenvectors, eigenvalues } = SymmetricEigen::new(self.gram.clone());
        let largest = eigenvalues.iter().copied().fold(0.0, f64::max);
        let none = |value: f64| value <= FREE * largest || largest == 0.0;
        let columns = (0..eigenvalues.len()).filter(|&at| none(eigenvalues[at]));
        columns.map(|at| eigenvectors.column(at).iter().copied().collect()).collect()
    }
}
