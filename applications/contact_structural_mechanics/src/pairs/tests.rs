//! Tangents against central differences, balance of forces, and the algebra of single formulations.

use super::*;
use crate::kratos::FirstIterateTangent;
use crate::law::{
    Augmentation, Bound, ContactLaw, DirectionRotation, FrictionEllipse, MeshTying, MultiplierConstraint, NodeState,
    SlaveNode,
};
use crate::laws::alm_frictional::AlmFrictional;
use crate::laws::alm_frictionless::AlmFrictionless;
use crate::laws::alm_frictionless_components::AlmFrictionlessComponents;
use crate::laws::penalty_by_node::PenaltyByNode;
use crate::laws::penalty_frictional::PenaltyFrictional;
use crate::laws::penalty_frictionless::PenaltyFrictionless;
use crate::mortar::tests::{Noise, displaced, random_pair};
use crate::mortar::{Choices, OperatorThreshold, Operators, PairGeometry, SegmentationSettings, operators, tangential};
use zelus_core::geometry::{FacetShape, LINE_2, LINE_3, Nodal, QUADRILATERAL_4, TRIANGLE_3, TRIANGLE_6};
use zelus_core::vector3::{dot, normalised};

const PAIR: Augmentation = Augmentation::Pair;
const ALM: AlmFrictionless = AlmFrictionless { scale_factor: 1.7, augmentation: PAIR };
const COMPONENTS: AlmFrictionlessComponents = AlmFrictionlessComponents { scale_factor: 1.7, augmentation: PAIR };
const PENALTY: PenaltyFrictional = PenaltyFrictional { tangent_factor: 0.3 };

/// States of the slave nodes, starting with `first`.
fn nodes(pair: &PairGeometry<f64>, noise: &mut Noise, states: [NodeState; 3]) -> Nodal<SlaveNode> {
    let dim = pair.space();
    pair.slave_shape.nodal(|j| SlaveNode {
        state: states[j % 3],
        penalty: 20.0 + 5.0 * noise.next(),
        compliance: 0.06,
        uzawa_pressure: 0.7,
        stiffness: 20.0,
        area: 1.3,
        dynamic_factor: 0.8 + 0.1 * noise.next(),
        friction: Bound { coefficient: 0.4, threshold: 0.0 },
        tangent: normalised(tangential(
            std::array::from_fn(|c| if c < dim { noise.next() } else { 0.0 }),
            pair.nodal_normals[j],
        )),
        rotation: DirectionRotation::default(),
        constraints: Default::default(),
        constraint_weight: 1.0,
        history_traction: std::array::from_fn(|c| if c < dim { 0.1 * noise.next() } else { 0.0 }),
        history_sliding: [0.0; 3],
        bond: None,
        traction: [0.0; 3],
    })
}

fn multipliers(pair: &PairGeometry<f64>, noise: &mut Noise) -> Nodal<[f64; 3]> {
    pair.slave_shape.nodal(|_| std::array::from_fn(|c| if c < pair.space() { noise.next() } else { 0.0 }))
}

const MIXES: [[NodeState; 3]; 5] = {
    use NodeState::{Inactive, Slip, Stick};
    [[Inactive; 3], [Slip; 3], [Stick; 3], [Slip, Inactive, Stick], [Stick, Slip, Inactive]]
};

/// A pair under a law, whose facets face each other.
fn system<'a>(
    law: &'a dyn ContactLaw,
    geometry: &'a PairGeometry<f64>,
    settings: &'a SegmentationSettings,
    nodes: &'a [SlaveNode],
    multipliers: &'a [[f64; 3]],
    history: &'a PairHistory,
) -> PairSystem<'a> {
    PairSystem { law, geometry, settings, nodes, multipliers, history, is_left: false, points: Default::default() }
}

/// Its right-hand side.
fn residual_of(system: &PairSystem<'_>) -> Vec<f64> {
    let mut rhs = vec![0.0; system.size()];
    system.residual(&system.present(&|| operators(system.geometry, system.settings)), &mut rhs);
    rhs
}

/// Its tangent and right-hand side.
fn tangent_of(system: &PairSystem<'_>) -> (Vec<f64>, Vec<f64>) {
    let n = system.size();
    let (mut lhs, mut rhs) = (vec![0.0; n * n], vec![0.0; n]);
    system.tangent(
        &|| system.present(&|| operators(system.geometry, system.settings)),
        &|first| system.geometry.seeded_from(first),
        FirstIterateTangent::Exact,
        (&mut lhs, n),
        &mut rhs,
        &mut Operators::room(),
    );
    (lhs, rhs)
}

/// The right-hand side of a pair under a law.
fn residual(
    law: &dyn ContactLaw,
    pair: &PairGeometry<f64>,
    nodes: &[SlaveNode],
    multipliers: &[[f64; 3]],
    history: &PairHistory,
) -> Vec<f64> {
    residual_of(&system(law, pair, &SegmentationSettings::default(), nodes, multipliers, history))
}

/// Tangent and right-hand side of a pair under a law.
fn tangent(
    law: &dyn ContactLaw,
    pair: &PairGeometry<f64>,
    nodes: &[SlaveNode],
    multipliers: &[[f64; 3]],
    history: &PairHistory,
) -> (Vec<f64>, Vec<f64>) {
    tangent_of(&system(law, pair, &SegmentationSettings::default(), nodes, multipliers, history))
}

/// Compares the first columns of a tangent with differences of the right-hand side, which `at` gives with an unknown moved by a step.
fn check_columns(lhs: &[f64], rows: usize, columns: usize, at: impl Fn(usize, f64) -> Vec<f64>, what: &str) {
    let (largest, h) = (lhs.iter().fold(1e-3, |a: f64, b| a.max(b.abs())), 1e-6);
    for column in 0..columns {
        for (row, (plus, minus)) in at(column, h).iter().zip(at(column, -h)).enumerate() {
            let (slope, exact) = (-(plus - minus) / (2.0 * h), lhs[row * rows + column]);
            assert!((slope - exact).abs() < 1e-6 * largest, "{what} row {row} column {column}: {slope} {exact}");
        }
    }
}

fn check_tangent(law: &dyn ContactLaw, slave: &'static FacetShape, master: &'static FacetShape) {
    let shapes = [slave, master];
    let mut checked = 0;
    for seed in 0..12 {
        for states in MIXES {
            let pair = random_pair(slave, master, seed);
            if operators(&pair, &SegmentationSettings::default()).cells().is_none() {
                continue;
            }
            let (count, unknowns) = (law.multiplier().count(pair.space()), pair.unknowns());
            let mut noise = Noise::new(seed + 100);
            let mut nodes = nodes(&pair, &mut noise, states);
            if seed % 3 == 2 {
                nodes[0].constraints.rules[0] = MultiplierConstraint::Crosspoint;
            }
            let lambda = multipliers(&pair, &mut noise);
            let history = history(&pair);
            let (lhs, rhs) = tangent(law, &pair, &nodes, &lambda, &history);
            let plain = residual(law, &pair, &nodes, &lambda, &history);
            let n = rhs.len();
            let size = plain.iter().fold(1e-3, |a: f64, b| a.max(b.abs()));
            rhs.iter().zip(&plain).for_each(|(a, b)| assert!((a - b).abs() < 1e-12 * size, "{a} {b}"));

            let at = |column: usize, step: f64| {
                let (mut moved, mut lambda) = (pair, lambda);
                if column < unknowns {
                    moved = displaced(&pair, column, step);
                } else {
                    lambda[(column - unknowns) / count][(column - unknowns) % count] += step;
                }
                residual(law, &moved, &nodes, &lambda, &history)
            };
            check_columns(&lhs, n, n, at, &format!("{shapes:?} seed {seed} {states:?}"));
            // Forces of both sides balance.
            for c in 0..pair.space() {
                let total: f64 = plain[..unknowns].iter().skip(c).step_by(pair.space()).sum();
                assert!(total.abs() < 1e-10 * size, "forces out of balance by {total}");
            }
            checked += 1;
        }
    }
    assert!(checked > 20);
}

/// Operators of a slightly different configuration, as if at the start of the step.
fn earlier(pair: &PairGeometry<f64>) -> Operators<f64> {
    let mut before = *pair;
    before.master.iter_mut().for_each(|x| x[0] += 0.03);
    // D changes too, where the master covers the whole slave.
    before.slave[0][0] -= 0.01;
    operators(&before, &SegmentationSettings::default()).cells().unwrap()
}

/// The pair before it rotated, slid and deformed a little.
fn history(pair: &PairGeometry<f64>) -> PairHistory {
    let mut noise = Noise::new(77);
    let dim = pair.space();
    let mut shifted = |x: [f64; 3]| std::array::from_fn(|c| if c < dim { x[c] + 0.1 * noise.next() } else { 0.0 });
    PairHistory {
        previous: Some(earlier(pair)),
        slave: pair.slave.map(&mut shifted),
        master: pair.master.map(&mut shifted),
    }
}

/// A pair that has not moved.
fn at_rest(pair: &PairGeometry<f64>) -> PairHistory {
    PairHistory { previous: None, slave: pair.slave, master: pair.master }
}

fn frictional(area: f64) -> AlmFrictional {
    let operator_threshold = OperatorThreshold { share: 0.0, area };
    AlmFrictional {
        scale_factor: 1.7,
        tangent_factor: 0.3,
        operator_threshold,
        augmentation: PAIR,
        regularised: false,
        dynamic: false,
        ellipse: FrictionEllipse::default(),
    }
}

#[test]
fn tangents_match_differences() {
    let shapes: [[&FacetShape; 2]; 10] = [
        [&LINE_2, &LINE_2],
        [&LINE_3, &LINE_2],
        [&LINE_2, &LINE_3],
        [&LINE_3, &LINE_3],
        [&TRIANGLE_3, &TRIANGLE_3],
        [&TRIANGLE_3, &QUADRILATERAL_4],
        [&QUADRILATERAL_4, &TRIANGLE_3],
        [&QUADRILATERAL_4, &QUADRILATERAL_4],
        [&TRIANGLE_6, &QUADRILATERAL_4],
        [&TRIANGLE_6, &TRIANGLE_6],
    ];
    let by_node = AlmFrictional { augmentation: Augmentation::Node, ..frictional(0.0) };
    let laws: [&dyn ContactLaw; 9] = [
        &ALM,
        &COMPONENTS,
        &frictional(0.0),
        &by_node,
        &AlmFrictional { regularised: true, ..by_node },
        &AlmFrictionless { augmentation: Augmentation::Node, ..ALM },
        &frictional(1e9),
        &PenaltyFrictionless,
        &PENALTY,
    ];
    for [slave, master] in shapes {
        laws.iter().for_each(|law| check_tangent(*law, slave, master));
    }
}

/// A pair whose facets face each other no more, at nodes that stick, slide and are open: the tangent of its slip.
#[test]
fn tangents_of_pairs_that_nodes_have_left_match_differences() {
    use NodeState::{Inactive, Slip, Stick};
    let law = AlmFrictional { augmentation: Augmentation::Node, ..frictional(0.0) };
    let settings = &SegmentationSettings::default();
    for [slave, master] in [[&LINE_2, &LINE_2], [&TRIANGLE_3, &QUADRILATERAL_4], [&TRIANGLE_6, &TRIANGLE_6]] {
        let pair = random_pair(slave, master, 1);
        let mut noise = Noise::new(3);
        let nodes = nodes(&pair, &mut noise, [Stick, Slip, Inactive]);
        let multipliers = multipliers(&pair, &mut noise);
        let history = history(&pair);
        let start = system(&law, &pair, settings, &nodes, &multipliers, &history);
        let (lhs, rhs) = tangent_of(&PairSystem { is_left: true, ..start });
        let unknowns = pair.unknowns();
        assert!(rhs[..unknowns].iter().all(|force| *force == 0.0), "no force acts there");
        assert!(rhs[unknowns..].iter().any(|row| row.abs() > 1e-3), "{rhs:?}");
        let at = |column: usize, step: f64| {
            let moved = displaced(&pair, column, step);
            let system = system(&law, &moved, settings, &nodes, &multipliers, &history);
            residual_of(&PairSystem { is_left: true, ..system })
        };
        check_columns(&lhs, rhs.len(), unknowns, at, &format!("{:?}", [slave, master]));
    }
}

/// Residuals of one formulation against lines of `reference_residuals.txt`; numbers are nodal vectors, then scalars.
fn check_references(law: &dyn ContactLaw, start: &[f64], lines: &[Vec<f64>], history: &PairHistory) {
    for line in lines {
        let vector = |i: usize| [line[3 * i], line[3 * i + 1], line[3 * i + 2]];
        let pair = PairGeometry { nodal_normals: [vector(4), vector(5)].into(), ..line_pair(line, start) };
        let areas = operators(&pair, &SegmentationSettings::default()).cells().unwrap().d.map(|row| row[0] + row[1]);
        let nodes: [SlaveNode; 2] = std::array::from_fn(|j| SlaveNode {
            state: [NodeState::Inactive, NodeState::Stick, NodeState::Slip][line[30 + j] as usize],
            penalty: line[32 + j],
            // The reference program divides by the penalty, whatever the area.
            compliance: 0.0,
            uzawa_pressure: 0.0,
            stiffness: line[32 + j] * areas[j],
            area: areas[j],
            dynamic_factor: line[34 + j],
            friction: Bound { coefficient: 0.4, threshold: 0.0 },
            tangent: vector(8 + j),
            rotation: DirectionRotation::default(),
            constraints: Default::default(),
            constraint_weight: 1.0,
            history_traction: [0.0; 3],
            history_sliding: [0.0; 3],
            bond: None,
            traction: [0.0; 3],
        });
        let expected = &line[36..];
        let rhs = residual(law, &pair, &nodes, &[vector(6), vector(7)], history);
        assert_eq!(rhs.len(), expected.len());
        let size = expected.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
        for (row, (a, b)) in rhs.iter().zip(expected).enumerate() {
            assert!((a - b).abs() <= 1e-12 * size, "row {row}: {a} {b}");
        }
    }
}

/// Nodes from the first vectors of a line, facet normals from the start of the step.
fn line_pair(line: &[f64], start: &[f64]) -> PairGeometry<f64> {
    let vector = |of: &[f64], i: usize| [of[3 * i], of[3 * i + 1], of[3 * i + 2]];
    PairGeometry {
        slave_shape: &LINE_2,
        master_shape: &LINE_2,
        slave: [vector(line, 0), vector(line, 1)].into(),
        master: [vector(line, 2), vector(line, 3)].into(),
        nodal_normals: [vector(line, 4), vector(line, 5)].into(),
        slave_normal: vector(start, 6),
        master_normal: vector(start, 7),
        exact: None,
        choices: Choices::default(),
    }
}

#[test]
fn residuals_of_the_reference_program() {
    let numbers = |text: &str| -> Vec<f64> { text.split(' ').map(|x| x.parse().unwrap()).collect() };
    let text = include_str!("reference_residuals.txt");
    let blocks = text.split("start ").skip(1);
    let mut formulations = 0;
    for block in blocks {
        let (head, rest) = block.split_once('\n').unwrap();
        let (formulation, start) = head.split_once(' ').unwrap();
        let start = numbers(start);
        let lines: Vec<_> = rest.lines().map(numbers).collect();
        let vector = |i: usize| [start[25 + 3 * i], start[26 + 3 * i], start[27 + 3 * i]];
        let previous = operators(&line_pair(&start, &start), &SegmentationSettings::default()).cells().unwrap();
        let history = PairHistory {
            previous: Some(previous),
            slave: [vector(0), vector(1)].into(),
            master: [vector(2), vector(3)].into(),
        };
        match formulation {
            "alm_frictional" => check_references(&frictional(start[24]), &start, &lines, &history),
            _ => check_references(&COMPONENTS, &start, &lines, &history),
        }
        formulations += 1;
    }
    assert_eq!(formulations, 3);
}

/// One multiplier along the normal and the same as a vector push equally; their gap rows agree along the normal.
#[test]
fn scalar_and_components_agree() {
    let pair = random_pair(&QUADRILATERAL_4, &TRIANGLE_3, 2);
    let mut noise = Noise::new(9);
    let mut nodes = nodes(&pair, &mut noise, [NodeState::Slip; 3]);
    nodes.iter_mut().for_each(|node| node.compliance = 0.0);
    let pressure: [f64; 4] = std::array::from_fn(|_| noise.next());
    let scalar = pressure.map(|p| [p, 0.0, 0.0]);
    let vector: [[f64; 3]; 4] = std::array::from_fn(|j| pair.nodal_normals[j].map(|n| n * pressure[j]));
    let a = residual(&ALM, &pair, &nodes, &scalar, &at_rest(&pair));
    let b = residual(&COMPONENTS, &pair, &nodes, &vector, &at_rest(&pair));
    assert_eq!((a.len(), b.len()), (25, 33));
    for (x, y) in a[..21].iter().zip(&b) {
        assert!((x - y).abs() < 1e-13);
    }
    for j in 0..4 {
        let along: f64 = (0..3).map(|c| b[21 + 3 * j + c] * pair.nodal_normals[j][c]).sum();
        assert!((along - a[21 + j]).abs() < 1e-13);
    }
}

/// An open pair without multipliers is stress-free; a closed active one presses the facets apart.
#[test]
fn sign_of_the_contact_force() {
    let slave = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let master = [3, 2, 1, 0].map(|n: usize| [slave[n][0], slave[n][1], -0.01]);
    let (up, down) = ([0.0, 0.0, 1.0], [0.0, 0.0, -1.0]);
    let pair = PairGeometry {
        slave_shape: &QUADRILATERAL_4,
        master_shape: &QUADRILATERAL_4,
        slave: slave.into(),
        master: master.into(),
        nodal_normals: [up; 4].into(),
        slave_normal: up,
        master_normal: down,
        exact: None,
        choices: Choices::default(),
    };
    let node = SlaveNode {
        state: NodeState::Slip,
        penalty: 50.0,
        compliance: 0.0,
        uzawa_pressure: 0.0,
        stiffness: 12.5,
        area: 0.25,
        dynamic_factor: 1.0,
        friction: Bound::default(),
        tangent: [1.0, 0.0, 0.0],
        rotation: DirectionRotation::default(),
        constraints: Default::default(),
        constraint_weight: 1.0,
        history_traction: [0.0; 3],
        history_sliding: [0.0; 3],
        bond: None,
        traction: [0.0, 0.0, 50.0 * -0.01],
    };
    // Each slave node: D = 1/4, g = −0.01, force = 50 · 0.01 · 1/4 against the normal; of weighted gaps a quarter of it.
    let check = |force: f64, rhs: &[f64]| {
        for n in 0..4 {
            assert!((rhs[3 * n + 2] - force).abs() < 1e-14, "the master, below, is pushed up");
            assert!((rhs[12 + 3 * n + 2] + force).abs() < 1e-14, "the slave is pushed down");
        }
    };
    let none = [[0.0; 3]; 4];
    check(50.0 * 0.0025 / 4.0, &residual(&PenaltyFrictionless, &pair, &[node; 4], &none, &at_rest(&pair)));
    let by_node = PenaltyByNode { tangent_factor: 1.0 };
    check(50.0 * 0.01 / 4.0, &residual(&by_node, &pair, &[node; 4], &none, &at_rest(&pair)));
}

#[test]
fn mesh_tying_is_symmetric_and_linear() {
    let pair = random_pair(&QUADRILATERAL_4, &TRIANGLE_3, 1);
    let operators = operators(&pair, &SegmentationSettings::default()).cells().unwrap();
    let tying = MeshTying { scale_factor: 2.5, components: 3 };
    const N: usize = 3 * (3 + 2 * 4);
    assert_eq!(tying.size(4, 3), N);
    let mut noise = Noise::new(4);
    let mut unknowns = [0.0; N];
    unknowns.iter_mut().for_each(|x| *x = noise.next());
    let (mut rhs, mut lhs) = ([0.0; N], vec![0.0; N * N]);
    tying.residual(&operators, &unknowns, &mut rhs);
    tying.tangent(&operators, &mut lhs);
    for row in 0..N {
        let product: f64 = (0..N).map(|column| lhs[row * N + column] * unknowns[column]).sum();
        assert!((product + rhs[row]).abs() < 1e-14);
        (0..N).for_each(|column| assert_eq!(lhs[row * N + column], lhs[column * N + row]));
    }
}

/// Cost of local systems; run with `--ignored --nocapture`.
#[test]
#[ignore = "a measurement"]
fn cost_of_local_systems() {
    let laws: [(&str, &dyn ContactLaw); 4] = [
        ("ALM scalar", &ALM),
        ("ALM components", &COMPONENTS),
        ("ALM frictional", &frictional(0.0)),
        ("penalty frictional", &PENALTY),
    ];
    for shape in [&LINE_2, &TRIANGLE_3, &QUADRILATERAL_4, &TRIANGLE_6] {
        let mut noise = Noise::new(1);
        let cases: Vec<_> = (0..50)
            .map(|seed| random_pair(shape, shape, seed))
            .filter(|pair| operators(pair, &SegmentationSettings::default()).cells().is_some())
            .map(|pair| {
                let nodes = nodes(&pair, &mut noise, [NodeState::Slip; 3]);
                (pair, nodes, multipliers(&pair, &mut noise), history(&pair))
            })
            .collect();
        for (name, law) in laws {
            let time = |run: &dyn Fn(&PairGeometry<f64>, &[SlaveNode], &[[f64; 3]], &PairHistory)| {
                let start = std::time::Instant::now();
                let all = (0..40).flat_map(|_| &cases);
                all.for_each(|(pair, nodes, lambda, history)| run(pair, nodes, lambda, history));
                start.elapsed().as_secs_f64() * 1e6 / (40 * cases.len()) as f64
            };
            let plain = time(&|pair, nodes, lambda, history| {
                std::hint::black_box(residual(law, pair, nodes, lambda, history));
            });
            let dual = time(&|pair, nodes, lambda, history| {
                std::hint::black_box(tangent(law, pair, nodes, lambda, history));
            });
            println!("{shape:?} {name}: residual {plain:.2} µs, with tangent {dual:.2} µs");
        }
    }
}

/// Tangential forces of the penalty method: they balance over both sides, oppose the slip, and are cut to the bound. A rigid-body
/// motion of the pair, however large, makes no slip and rotates the history traction.
#[test]
fn penalty_friction_acts_through_the_mortar_operators() {
    let slave = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let master = [3, 2, 1, 0].map(|n: usize| [slave[n][0], slave[n][1], -0.01]);
    let (up, down) = ([0.0, 0.0, 1.0], [0.0, 0.0, -1.0]);
    let turned = |x: [f64; 3]| [x[2] + 4.0, x[0] - 1.0, x[1] + 2.0];
    let turn = |v: [f64; 3]| [v[2], v[0], v[1]];
    for (state, expected) in
        [(NodeState::Stick, 0.3 * 50.0 * 0.02 / 4.0 - 0.01), (NodeState::Slip, 0.4 * 50.0 * 0.01 / 4.0)]
    {
        for rigid in [false, true] {
            let place = |x: [f64; 3]| if rigid { turned(x) } else { x };
            let free = |v: [f64; 3]| if rigid { turn(v) } else { v };
            let pair = PairGeometry {
                slave_shape: &QUADRILATERAL_4,
                master_shape: &QUADRILATERAL_4,
                slave: slave.map(place).into(),
                master: master.map(place).into(),
                nodal_normals: [free(up); 4].into(),
                slave_normal: free(up),
                master_normal: free(down),
                exact: None,
                choices: Choices::default(),
            };
            let node = SlaveNode {
                state,
                penalty: 50.0,
                compliance: 0.0,
                uzawa_pressure: 0.0,
                stiffness: 50.0,
                area: 0.25,
                dynamic_factor: 1.0,
                friction: Bound { coefficient: 0.4, threshold: 0.0 },
                tangent: free([-1.0, 0.0, 0.0]),
                rotation: DirectionRotation::default(),
                constraints: Default::default(),
                constraint_weight: 1.0,
                history_traction: [0.01, 0.0, 0.0],
                history_sliding: [0.0; 3],
                bond: None,
                traction: [0.0; 3],
            };
            // The slave has come along x by 0.02 since.
            let before = slave.map(|x| [x[0] - 0.02, x[1], x[2]]);
            let last = PairHistory { previous: None, slave: before.into(), master: master.into() };
            let rhs = residual(&PENALTY, &pair, &[node; 4], &[[0.0; 3]; 4], &last);
            for n in 0..4 {
                let force = |at: usize| [rhs[at + 3 * n], rhs[at + 3 * n + 1], rhs[at + 3 * n + 2]];
                let [along, across] = [free([1.0, 0.0, 0.0]), free([0.0, 1.0, 0.0])];
                assert!((dot(force(12), along) + expected / 4.0).abs() < 1e-14, "{state:?}: {rhs:?}");
                assert!((dot(force(0), along) - expected / 4.0).abs() < 1e-14, "{state:?}: {rhs:?}");
                assert!(dot(force(12), across).abs() < 1e-14 && dot(force(0), across).abs() < 1e-14);
            }
        }
    }
}
