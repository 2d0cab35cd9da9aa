//! Properties of every registered element and condition on its cell, and of every contact formulation on every pair of shapes: tangents
//! are derivatives, rigid-body modes give the forces they must, the order of nodes does not matter.
//!
//! A kind is covered by being registered. A crate with kinds of its own includes this file in its tests.

#[path = "support/pairs.rs"]
mod pairs;
#[path = "support/specimen.rs"]
mod specimen;
#[path = "support/ties.rs"]
mod ties;

use zelus as _;
use zelus::structural_mechanics::laws::LawEntry;
use zelus::structural_mechanics::variables::DISPLACEMENT;
use zelus_core::entities::{Tangent, block_kinds};
use zelus_core::geometry::Shape;
use zelus_core::model::{EntityKind, EntityRole};
use zelus_core::registry::names;

use specimen::{Loads, Random, Specimen, Vec3, cell, difference, is_axisymmetric, is_linear, size};

/// Kinds whose tangent is the derivative only where there is no strain yet, as in the reference program.
/// (element, law, why)
const TANGENT_AT_REST: &[(&str, &str, &str)] = &[
    ("SmallDisplacement", "HyperElastic", "the law's matrix is the derivative by its own strain measure"),
    ("UpdatedLagrangian", "LinearElastic", "the law gives the same numbers as every stress measure"),
    ("SmallDisplacement", "ThermalHyperElastic", "the law's matrix is the derivative by its own strain measure"),
    ("UpdatedLagrangian", "ThermalElastic", "the law gives the same numbers as every stress measure"),
    ("UpdatedLagrangian", "ThermalLinear", "the law gives the same numbers as every stress measure"),
];

/// Every registered kind of body or boundary with a block, and a law that fits it; conditions have none, nor elements that do
/// without.
///
/// Kinds without a space, as springs on a number, have no motions to check.
fn kinds() -> Vec<(&'static EntityKind, Shape, Option<&'static str>)> {
    let mut out = Vec::new();
    for entry in block_kinds() {
        if entry.space == 0 {
            continue;
        }
        let shape = entry.cell.unwrap_or_else(|| panic!("{} has no cell", entry.name));
        if entry.role == EntityRole::Condition {
            out.push((entry, shape, None));
            continue;
        }
        let x = cell(shape, entry.space, 0.0, &mut Random(1));
        let fits = |law: &&str| Specimen::new(entry, Some(law), &x, &order(shape), Loads::Scalars).is_ok();
        if Specimen::new(entry, None, &x, &order(shape), Loads::Scalars).is_ok() {
            out.push((entry, shape, None));
            continue;
        }
        let laws: Vec<&str> = names::<LawEntry>().into_iter().filter(fits).collect();
        let why = || Specimen::new(entry, None, &x, &order(shape), Loads::Scalars).err();
        assert!(!laws.is_empty(), "no registered law fits {}: {:?}", entry.name, why());
        out.extend(laws.into_iter().map(|law| (entry, shape, Some(law))));
    }
    out
}

/// Laws of bars and mixtures, which need other elements and layers, and user materials, which need a library or a function.
const NOT_WALKED: [&str; 4] = ["Truss", "ParallelRuleOfMixtures", "UMAT", "FunctionLaw"];

#[test]
fn every_law_of_bodies_is_walked() {
    let walked: Vec<&str> = kinds().into_iter().filter_map(|(_, _, law)| law).collect();
    let left_out = |name: &&str| !walked.contains(name) && !NOT_WALKED.iter().any(|part| name.contains(part));
    let missing: Vec<&str> = names::<LawEntry>().into_iter().filter(left_out).collect();
    assert!(missing.is_empty(), "laws that fit no element with the usual constants: {missing:?}");
}

fn order(shape: Shape) -> Vec<u32> {
    (0..shape.nodes() as u32).collect()
}

fn label(entry: &EntityKind, law: Option<&str>) -> String {
    format!("{} {} ({}:{})", entry.name, law.unwrap_or_default(), entry.file, entry.line)
}

fn state(specimen: &Specimen, amount: f64, random: &mut Random) -> Vec<f64> {
    specimen.rows().iter().map(|_| amount * random.next()).collect()
}

#[test]
fn tangents_are_derivatives() {
    for (entry, shape, law) in kinds() {
        let name = label(entry, law);
        let mut random = Random(11);
        let at_rest = TANGENT_AT_REST
            .iter()
            .any(|(element, of_law, _)| entry.name.contains(element) && law.is_some_and(|law| law.starts_with(of_law)));
        let x = cell(shape, entry.space, 0.05, &mut random);
        let mut specimen = Specimen::new(entry, law, &x, &order(shape), Loads::Scalars).unwrap();
        // Cells with short edges must not turn inside out.
        let amount = match shape {
            Shape::Pyramid13 => 0.02,
            Shape::Prism18 => 0.03,
            _ => 0.05,
        };
        let u = state(&specimen, if at_rest { 1e-9 } else { amount }, &mut random);
        specimen.set(&u);
        let (k, rhs) = specimen.system();
        assert_eq!(specimen.residual(), rhs, "{name}: the residual depends on what is wanted");
        let n = rhs.len();
        let largest = size(k.iter().copied()).max(1e-3 * size(rhs.iter().copied()));
        // Where principal stresses are near each other, differences see how fast their directions turn.
        let by_principal = law.is_some_and(|law| law.ends_with("Rankine") || law.ends_with("Tresca"));
        let error = difference(&k, &specimen.difference_tangent(&u, if by_principal { 1e-6 } else { 1e-4 }));
        let tolerance = if at_rest || by_principal { 1e-5 } else { 1e-8 };
        assert!(error <= tolerance * largest, "{name}: the tangent is off by {error:e} of {largest:e}");
        let kind = specimen.block.tangent();
        let symmetric = (0..n * n).all(|e| (k[e] - k[e % n * n + e / n]).abs() <= 1e-13 * largest);
        assert!(symmetric || kind == Tangent::Unsymmetric, "{name}: {kind:?} but not symmetric");
        assert!(kind != Tangent::Zero || size(k.iter().copied()) == 0.0, "{name}: {kind:?} but not zero");
        if kind == Tangent::Constant {
            let other = state(&specimen, 0.5, &mut random);
            specimen.set(&other);
            assert_eq!(specimen.system().0, k, "{name}: {kind:?} but it changes");
        }
    }
}

/// A turn about z (the plane's own axis) and in space about another axis too, then a shift.
struct Motion {
    columns: [Vec3; 3],
    shift: Vec3,
}

impl Motion {
    fn new(entry: &EntityKind) -> Self {
        let angle: f64 = if is_axisymmetric(entry) { 0.0 } else { 0.7 };
        let tilt: f64 = if entry.space == 3 { 0.4 } else { 0.0 };
        let ((s, c), (t, k)) = (angle.sin_cos(), tilt.sin_cos());
        let shift = if is_axisymmetric(entry) { [0.0, 0.7, 0.0] } else { [0.4, -0.3, 0.5 * tilt] };
        // R = (turn about x by the tilt) · (turn about z by the angle)
        Self { columns: [[c, k * s, t * s], [-s, k * c, t * c], [0.0, -t, k]], shift }
    }

    fn turn(&self, v: Vec3) -> Vec3 {
        std::array::from_fn(|a| (0..3).map(|b| self.columns[b][a] * v[b]).sum())
    }

    fn displacement(&self, x: Vec3) -> Vec3 {
        let turned = self.turn(x);
        std::array::from_fn(|a| turned[a] - x[a] + self.shift[a])
    }

    /// The same for small angles: the antisymmetric part of the turn, and the shift.
    fn small_displacement(&self, x: Vec3) -> Vec3 {
        let skew = |a: usize, b: usize| 0.5 * (self.columns[b][a] - self.columns[a][b]);
        std::array::from_fn(|a| (0..3).map(|b| skew(a, b) * x[b]).sum::<f64>() + self.shift[a])
    }
}

/// Values of the unknowns for displacements of the nodes, volume kept; `None` when there are other unknowns.
fn displacements(specimen: &Specimen, of_node: impl Fn(usize) -> Vec3) -> Option<Vec<f64>> {
    let value = |(node, variable): (u32, zelus_core::model::ScalarVariable)| match variable.column {
        column if column == DISPLACEMENT.name() => Some(of_node(node as usize)[variable.offset()]),
        "VOLUMETRIC_STRAIN" => Some(0.0),
        _ => None,
    };
    specimen.rows().into_iter().map(value).collect()
}

#[test]
fn rigid_motions_strain_no_element() {
    let mut random = Random(12);
    for (entry, shape, law) in kinds().into_iter().filter(|(entry, ..)| entry.role == EntityRole::Element) {
        let x = cell(shape, entry.space, 0.05, &mut random);
        let mut specimen = Specimen::new(entry, law, &x, &order(shape), Loads::Scalars).unwrap();
        let motion = Motion::new(entry);
        let moved = |at: usize| {
            if is_linear(entry) { motion.small_displacement(x[at]) } else { motion.displacement(x[at]) }
        };
        let Some(u) = displacements(&specimen, moved) else { continue };
        specimen.set(&u);
        let force = size(specimen.residual());
        assert!(force < 1e-10, "{}: a rigid-body mode needs the force {force:e}", label(entry, law));
    }
}

#[test]
fn loads_that_follow_a_surface_turn_with_it() {
    let mut random = Random(13);
    for (entry, shape, law) in kinds().into_iter().filter(|(entry, ..)| entry.role == EntityRole::Condition) {
        let x = cell(shape, entry.space, 0.05, &mut random);
        let mut specimen = Specimen::new(entry, law, &x, &order(shape), Loads::Scalars).unwrap();
        // springs to the ground resist rigid-body modes, loads on the initial geometry do not follow them
        if matches!(specimen.block.tangent(), Tangent::Constant | Tangent::Zero) {
            continue;
        }
        let u: Vec<Vec3> = x.iter().map(|_| random.vector(0.1, entry.space)).collect();
        let Some(before) = displacements(&specimen, |at| u[at]) else { continue };
        specimen.set(&before);
        let force = specimen.residual();
        let motion = Motion::new(entry);
        let position = |at: usize| std::array::from_fn(|a| x[at][a] + u[at][a]);
        let after = displacements(&specimen, |at| {
            let more = motion.displacement(position(at));
            std::array::from_fn(|a| u[at][a] + more[a])
        });
        specimen.set(&after.expect("displacements only"));
        let turned: Vec<f64> = force
            .chunks(entry.space)
            .flat_map(|f| {
                let f = motion.turn(std::array::from_fn(|a| f.get(a).copied().unwrap_or(0.0)));
                f.into_iter().take(entry.space)
            })
            .collect();
        let error = difference(&turned, &specimen.residual());
        assert!(error <= 1e-12 * size(turned).max(1.0), "{}: off by {error:e}", label(entry, law));
    }
}

/// Orders of the nodes that give the same cell: images under affine maps, of positive determinant unless `mirrored`.
fn orders(shape: Shape, mirrored: bool) -> Vec<Vec<u32>> {
    let cell = shape.cell();
    let (dim, corners) = (cell.dim, cell.corners());
    // the frame: a corner and its neighbours along the first edges that leave it
    let frame: Vec<usize> = std::iter::once(0)
        .chain(cell.edges.iter().filter_map(|edge| match (edge.nodes[0], edge.nodes[1]) {
            (0, other) | (other, 0) => Some(other),
            _ => None,
        }))
        .take(dim + 1)
        .collect();
    let at = |node: usize| cell.points[node];
    let edge = |from: usize, to: usize| -> Vec3 { std::array::from_fn(|a| at(to)[a] - at(from)[a]) };
    let mut found = Vec::new();
    let mut images = vec![0; dim + 1];
    let count = corners.pow(dim as u32 + 1);
    for code in 0..count {
        let mut rest = code;
        for image in &mut images {
            *image = rest % corners;
            rest /= corners;
        }
        let columns: Vec<Vec3> = (1..=dim).map(|d| edge(images[0], images[d])).collect();
        let of_frame: Vec<Vec3> = (1..=dim).map(|d| edge(frame[0], frame[d])).collect();
        let (volume, reference) = (determinant(&columns), determinant(&of_frame));
        if (volume.abs() - reference.abs()).abs() > 1e-9 || (!mirrored && volume * reference < 0.0) {
            continue;
        }
        let order: Option<Vec<u32>> = (0..shape.nodes())
            .map(|node| {
                let weights = solve(&of_frame, edge(frame[0], node));
                let target: Vec3 = std::array::from_fn(|a| {
                    at(images[0])[a] + (0..dim).map(|d| weights[d] * columns[d][a]).sum::<f64>()
                });
                let same = |p: &Vec3| (0..3).all(|a| (p[a] - target[a]).abs() < 1e-9);
                cell.points.iter().position(same).map(|image| image as u32)
            })
            .collect();
        found.extend(order);
    }
    found
}

/// Determinant of the leading square part of one to three columns; 1 for none.
fn determinant(columns: &[Vec3]) -> f64 {
    match columns {
        [] => 1.0,
        [a] => a[0],
        [a, b] => a[0] * b[1] - a[1] * b[0],
        [a, b, c, ..] => {
            a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0])
        }
    }
}

/// Weights of the columns that add up to `v`, by Cramer's rule.
fn solve(columns: &[Vec3], v: Vec3) -> Vec<f64> {
    let whole = determinant(columns);
    let replaced = |d: usize| {
        let mut columns = columns.to_vec();
        columns[d] = v;
        determinant(&columns) / whole
    };
    (0..columns.len()).map(replaced).collect()
}

/// Tangent and right-hand side, rows sorted by node and variable.
fn sorted_system(specimen: &Specimen) -> (Vec<f64>, Vec<f64>) {
    let rows = specimen.rows();
    let mut by_node: Vec<usize> = (0..rows.len()).collect();
    by_node.sort_by_key(|&row| rows[row]);
    let (k, rhs) = specimen.system();
    let sorted = by_node.iter().flat_map(|&i| by_node.iter().map(move |&j| (i, j))).map(|(i, j)| k[i * rows.len() + j]);
    (sorted.collect(), by_node.iter().map(|&i| rhs[i]).collect())
}

#[test]
fn the_order_of_nodes_does_not_matter() {
    let mut random = Random(14);
    for (entry, shape, law) in kinds() {
        // turned over, a surface shows its other side: only forces that keep their direction stay the same
        for (loads, mirrored) in [(Loads::Scalars, false), (Loads::Vectors, shape.dim() < entry.space)] {
            let x = cell(shape, entry.space, 0.05, &mut random);
            let make = |order: &[u32]| Specimen::new(entry, law, &x, order, loads).unwrap();
            let mut first = make(&order(shape));
            let u = state(&first, 0.03, &mut random);
            let rows = first.rows();
            first.set(&u);
            let (k, rhs) = sorted_system(&first);
            let orders = orders(shape, mirrored);
            assert!(!orders.is_empty(), "{shape:?} has at least the order it is given in");
            for order in orders {
                let mut other = make(&order);
                let value = |row| u[rows.iter().position(|own| *own == row).expect("the same unknowns")];
                let values: Vec<f64> = other.rows().into_iter().map(value).collect();
                other.set(&values);
                let (l, other_rhs) = sorted_system(&other);
                let name = label(entry, law);
                // the four-point rule of the tetrahedron has eight digits
                let tolerance = if shape == Shape::Tet10 { 1e-7 } else { 1e-11 };
                let (force, stiffness) = (size(rhs.iter().copied()), size(k.iter().copied()));
                assert!(difference(&rhs, &other_rhs) <= tolerance * force.max(stiffness), "{name}: forces, {order:?}");
                assert!(difference(&k, &l) <= tolerance * stiffness, "{name}: tangent, {order:?}");
            }
        }
    }
}

#[test]
fn cells_have_their_symmetries() {
    let counts = [
        (Shape::Point1, 1),
        (Shape::Line2, 1),
        (Shape::Tri6, 3),
        (Shape::Quad9, 4),
        (Shape::Tet10, 12),
        (Shape::Prism15, 6),
        (Shape::Hex27, 24),
    ];
    for (shape, count) in counts {
        assert_eq!(orders(shape, false).len(), count, "{shape:?}");
    }
    assert_eq!(orders(Shape::Line3, true).len(), 2);
    assert_eq!(orders(Shape::Quad8, true).len(), 8);
}
