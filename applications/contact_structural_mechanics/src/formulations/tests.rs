//! Tangents against central differences, balance of forces, and the algebra of single families.

use super::*;
use crate::families::alm_frictional::{AlmFrictional, SlipHistory};
use crate::families::alm_frictionless::AlmFrictionless;
use crate::families::alm_frictionless_components::AlmFrictionlessComponents;
use crate::families::penalty_by_node::PenaltyByNode;
use crate::families::penalty_frictional::PenaltyFrictional;
use crate::families::penalty_frictionless::PenaltyFrictionless;
use crate::friction_law::Bound;
use crate::kratos::FirstIterateTangent;
use crate::mortar::tests::{Noise, displaced, random_pair};
use crate::mortar::{Choices, OperatorThreshold, Operators, PairGeometry, SegmentationSettings, operators, tangential};
use zelus_core::geometry::{FacetShape, Line2, Line3, NodeArray, Quadrilateral4, Triangle3, Triangle6};
use zelus_core::vector3::{dot, normalised};

const PAIR: Augmentation = Augmentation::Pair;
const ALM: AlmFrictionless = AlmFrictionless { scale_factor: 1.7, augmentation: PAIR };
const COMPONENTS: AlmFrictionlessComponents = AlmFrictionlessComponents { scale_factor: 1.7, augmentation: PAIR };
const PENALTY: PenaltyFrictional = PenaltyFrictional { tangent_factor: 0.3 };

/// States of the slave nodes, starting with `first`.
fn nodes<S: FacetShape>(
    pair_normals: &S::Nodal<[f64; 3]>,
    noise: &mut Noise,
    states: [NodeState; 3],
) -> S::Nodal<SlaveNode> {
    let dim = S::SPACE;
    S::nodal(|j| SlaveNode {
        state: states[j % 3],
        penalty: 20.0 + 5.0 * noise.next(),
        compliance: 0.06,
        kept: 0.7,
        stiffness: 20.0,
        area: 1.3,
        dynamic_factor: 0.8 + 0.1 * noise.next(),
        friction: Bound { coefficient: 0.4, threshold: 0.0 },
        tangent: normalised(tangential(
            std::array::from_fn(|c| if c < dim { noise.next() } else { 0.0 }),
            pair_normals[j],
        )),
        turning: Turning::default(),
        held: Default::default(),
        held_weight: 1.0,
        carried: std::array::from_fn(|c| if c < dim { 0.1 * noise.next() } else { 0.0 }),
        traction: [0.0; 3],
    })
}

fn multipliers<S: FacetShape>(noise: &mut Noise) -> S::Nodal<[f64; 3]> {
    S::nodal(|_| std::array::from_fn(|c| if c < S::SPACE { noise.next() } else { 0.0 }))
}

const MIXES: [[NodeState; 3]; 5] = {
    use NodeState::{Inactive, Slip, Stick};
    [[Inactive; 3], [Slip; 3], [Stick; 3], [Slip, Inactive, Stick], [Stick, Slip, Inactive]]
};

fn check_tangent<F: Formulation, S: FacetShape, M: FacetShape, const LANES: usize>(
    formulation: &F,
    history: impl Fn(&PairGeometry<f64, S, M>) -> F::History<S, M>,
) {
    let shapes = [S::SHAPE, M::SHAPE];
    let settings = SegmentationSettings::default();
    let n = local_size::<F, S, M>();
    let (count, unknowns) = (F::MULTIPLIER.count(S::SPACE), PairGeometry::<f64, S, M>::UNKNOWNS);
    let mut checked = 0;
    for seed in 0..12 {
        for states in MIXES {
            let pair = random_pair::<S, M>(seed);
            if operators(&pair, &settings).cells().is_none() {
                continue;
            }
            let mut noise = Noise::new(seed + 100);
            let mut nodes = nodes::<S>(&pair.nodal_normals, &mut noise, states);
            if seed % 3 == 2 {
                nodes[0].held[0] = Held::Follows;
            }
            let lambda = multipliers::<S>(&mut noise);
            let history = history(&pair);
            let (mut lhs, mut rhs, mut plain) = (vec![0.0; n * n], vec![0.0; n], vec![0.0; n]);
            tangent(
                formulation,
                |first| pair.seeded_from::<LANES>(first),
                &settings,
                FirstIterateTangent::Exact,
                &nodes,
                &lambda,
                &history,
                (&mut lhs, n),
                &mut rhs,
            );
            residual(formulation, &pair, operators(&pair, &settings), &nodes, &lambda, &history, &mut plain);
            let size = plain.iter().fold(1e-3, |a: f64, b| a.max(b.abs()));
            rhs.iter().zip(&plain).for_each(|(a, b)| assert!((a - b).abs() < 1e-12 * size, "{a} {b}"));

            let at = |column: usize, step: f64| {
                let mut out = vec![0.0; n];
                let (mut moved, mut lambda) = (pair, lambda);
                if column < unknowns {
                    moved = displaced(&pair, column, step);
                } else {
                    lambda[(column - unknowns) / count][(column - unknowns) % count] += step;
                }
                residual(formulation, &moved, operators(&moved, &settings), &nodes, &lambda, &history, &mut out);
                out
            };
            let largest = lhs.iter().fold(1e-3, |a: f64, b| a.max(b.abs()));
            for column in 0..n {
                let h = 1e-6;
                for (row, (plus, minus)) in at(column, h).iter().zip(at(column, -h)).enumerate() {
                    let (slope, exact) = (-(plus - minus) / (2.0 * h), lhs[row * n + column]);
                    assert!(
                        (slope - exact).abs() < 1e-6 * largest,
                        "{} {shapes:?} seed {seed} {states:?} row {row} column {column}: {slope} {exact}",
                        std::any::type_name::<F>()
                    );
                }
            }
            // What is pushed on one side is pushed back on the other.
            for c in 0..S::SPACE {
                let total: f64 = plain[..unknowns].iter().skip(c).step_by(S::SPACE).sum();
                assert!(total.abs() < 1e-10 * size, "forces out of balance by {total}");
            }
            checked += 1;
        }
    }
    assert!(checked > 20);
}

/// Operators of a slightly different configuration, as if at the start of the step.
fn earlier<S: FacetShape, M: FacetShape>(pair: &PairGeometry<f64, S, M>) -> Operators<f64, S, M> {
    let mut before = *pair;
    before.master.iter_mut().for_each(|x| x[0] += 0.03);
    // D changes too, where the master covers the whole slave.
    before.slave[0][0] -= 0.01;
    operators(&before, &SegmentationSettings::default()).cells().unwrap()
}

fn slip_history<S: FacetShape, M: FacetShape>(pair: &PairGeometry<f64, S, M>) -> SlipHistory<S, M> {
    let mut noise = Noise::new(77);
    let dim = S::SPACE;
    let mut shifted = |x: [f64; 3]| std::array::from_fn(|c| if c < dim { x[c] + 0.1 * noise.next() } else { 0.0 });
    SlipHistory {
        previous: earlier(pair),
        last: LastState { slave: S::map(&pair.slave, &mut shifted), master: M::map(&pair.master, &mut shifted) },
    }
}

/// The pair before it turned, slid and deformed a little.
fn last_state<S: FacetShape, M: FacetShape>(pair: &PairGeometry<f64, S, M>) -> LastState<S, M> {
    slip_history(pair).last
}

fn frictional(area: f64) -> AlmFrictional {
    let operator_threshold = OperatorThreshold { share: 0.0, area };
    AlmFrictional {
        scale_factor: 1.7,
        tangent_factor: 0.3,
        operator_threshold,
        augmentation: PAIR,
        compliant: false,
        dynamic: false,
    }
}

fn all_families<S: FacetShape, M: FacetShape, const NU: usize>() {
    check_tangent::<_, S, M, NU>(&ALM, |_| ());
    check_tangent::<_, S, M, NU>(&COMPONENTS, |_| ());
    check_tangent::<_, S, M, NU>(&frictional(0.0), slip_history);
    check_tangent::<_, S, M, NU>(&AlmFrictional { augmentation: Augmentation::Node, ..frictional(0.0) }, slip_history);
    check_tangent::<_, S, M, NU>(
        &AlmFrictional { augmentation: Augmentation::Node, compliant: true, ..frictional(0.0) },
        slip_history,
    );
    check_tangent::<_, S, M, NU>(&AlmFrictionless { augmentation: Augmentation::Node, ..ALM }, |_| ());
    check_tangent::<_, S, M, NU>(&frictional(1e9), slip_history);
    check_tangent::<_, S, M, NU>(&PenaltyFrictionless, |_| ());
    check_tangent::<_, S, M, NU>(&PENALTY, last_state);
}

#[test]
fn tangents_match_differences() {
    all_families::<Line2, Line2, 8>();
    all_families::<Line3, Line2, 12>();
    all_families::<Line2, Line3, 12>();
    all_families::<Line3, Line3, 12>();
    all_families::<Triangle3, Triangle3, 18>();
    all_families::<Triangle3, Quadrilateral4, 21>();
    all_families::<Quadrilateral4, Triangle3, 21>();
    all_families::<Quadrilateral4, Quadrilateral4, 24>();
    all_families::<Triangle6, Quadrilateral4, 12>();
    all_families::<Triangle6, Triangle6, 12>();
}

/// Residuals of one family against lines of `reference_residuals.txt`; numbers are nodal vectors, then scalars.
fn check_references<F: Formulation>(
    formulation: &F,
    start: &[f64],
    lines: &[Vec<f64>],
    history: F::History<Line2, Line2>,
) {
    for line in lines {
        let vector = |i: usize| [line[3 * i], line[3 * i + 1], line[3 * i + 2]];
        let pair = PairGeometry { nodal_normals: [vector(4), vector(5)], ..line_pair(line, start) };
        let areas = operators(&pair, &SegmentationSettings::default()).cells().unwrap().d.map(|row| row[0] + row[1]);
        let nodes = std::array::from_fn(|j| SlaveNode {
            state: [NodeState::Inactive, NodeState::Stick, NodeState::Slip][line[30 + j] as usize],
            penalty: line[32 + j],
            // The reference program divides by the penalty, whatever the area.
            compliance: 0.0,
            kept: 0.0,
            stiffness: line[32 + j] * areas[j],
            area: areas[j],
            dynamic_factor: line[34 + j],
            friction: Bound { coefficient: 0.4, threshold: 0.0 },
            tangent: vector(8 + j),
            turning: Turning::default(),
            held: Default::default(),
            held_weight: 1.0,
            carried: [0.0; 3],
            traction: [0.0; 3],
        });
        let expected = &line[36..];
        let mut rhs = vec![0.0; expected.len()];
        let settings = SegmentationSettings::default();
        residual(formulation, &pair, operators(&pair, &settings), &nodes, &[vector(6), vector(7)], &history, &mut rhs);
        let size = expected.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
        for (row, (a, b)) in rhs.iter().zip(expected).enumerate() {
            assert!((a - b).abs() <= 1e-12 * size, "row {row}: {a} {b}");
        }
    }
}

/// Nodes from the first vectors of a line, facet normals from the start of the step.
fn line_pair(line: &[f64], start: &[f64]) -> PairGeometry<f64, Line2, Line2> {
    let vector = |of: &[f64], i: usize| [of[3 * i], of[3 * i + 1], of[3 * i + 2]];
    PairGeometry {
        slave: [vector(line, 0), vector(line, 1)],
        master: [vector(line, 2), vector(line, 3)],
        nodal_normals: [vector(line, 4), vector(line, 5)],
        slave_normal: vector(start, 6),
        master_normal: vector(start, 7),
        choices: Choices::default(),
    }
}

#[test]
fn residuals_of_the_reference_program() {
    let numbers = |text: &str| -> Vec<f64> { text.split(' ').map(|x| x.parse().unwrap()).collect() };
    let text = include_str!("reference_residuals.txt");
    let blocks = text.split("start ").skip(1);
    let mut families = 0;
    for block in blocks {
        let (head, rest) = block.split_once('\n').unwrap();
        let (family, start) = head.split_once(' ').unwrap();
        let start = numbers(start);
        let lines: Vec<_> = rest.lines().map(numbers).collect();
        let vector = |i: usize| [start[25 + 3 * i], start[26 + 3 * i], start[27 + 3 * i]];
        let previous = operators(&line_pair(&start, &start), &SegmentationSettings::default()).cells().unwrap();
        let history =
            SlipHistory { previous, last: LastState { slave: [vector(0), vector(1)], master: [vector(2), vector(3)] } };
        match family {
            "alm_frictional" => check_references(&frictional(start[24]), &start, &lines, history),
            _ => check_references(&COMPONENTS, &start, &lines, ()),
        }
        families += 1;
    }
    assert_eq!(families, 3);
}

/// One multiplier along the normal and the same as a vector push equally; their gap rows agree along the normal.
#[test]
fn scalar_and_components_agree() {
    let settings = SegmentationSettings::default();
    let pair = random_pair::<Quadrilateral4, Triangle3>(2);
    let mut noise = Noise::new(9);
    let mut nodes = nodes::<Quadrilateral4>(&pair.nodal_normals, &mut noise, [NodeState::Slip; 3]);
    nodes.iter_mut().for_each(|node| node.compliance = 0.0);
    let pressure: [f64; 4] = std::array::from_fn(|_| noise.next());
    let scalar = pressure.map(|p| [p, 0.0, 0.0]);
    let vector = std::array::from_fn(|j| pair.nodal_normals[j].map(|n| n * pressure[j]));
    let (mut a, mut b) = (vec![0.0; 25], vec![0.0; 33]);
    residual(&ALM, &pair, operators(&pair, &settings), &nodes, &scalar, &(), &mut a);
    residual(&COMPONENTS, &pair, operators(&pair, &settings), &nodes, &vector, &(), &mut b);
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
    let pair = PairGeometry::<f64, Quadrilateral4, Quadrilateral4> {
        slave,
        master,
        nodal_normals: [up; 4],
        slave_normal: up,
        master_normal: down,
        choices: Choices::default(),
    };
    let node = SlaveNode {
        state: NodeState::Slip,
        penalty: 50.0,
        compliance: 0.0,
        kept: 0.0,
        stiffness: 12.5,
        area: 0.25,
        dynamic_factor: 1.0,
        friction: Bound::default(),
        tangent: [1.0, 0.0, 0.0],
        turning: Turning::default(),
        held: Default::default(),
        held_weight: 1.0,
        carried: [0.0; 3],
        traction: [0.0, 0.0, 50.0 * -0.01],
    };
    let mut rhs = [0.0; 24];
    // Each slave node: D = 1/4, g = −0.01, force = 50 · 0.01 · 1/4 against the normal; of weighted gaps a quarter of it.
    let check = |force: f64, rhs: &[f64]| {
        for n in 0..4 {
            assert!((rhs[3 * n + 2] - force).abs() < 1e-14, "the master, below, is pushed up");
            assert!((rhs[12 + 3 * n + 2] + force).abs() < 1e-14, "the slave is pushed down");
        }
    };
    let (settings, none) = (SegmentationSettings::default(), [[0.0; 3]; 4]);
    residual(&PenaltyFrictionless, &pair, operators(&pair, &settings), &[node; 4], &none, &(), &mut rhs);
    check(50.0 * 0.0025 / 4.0, &rhs);
    let last = LastState { slave, master };
    residual(
        &PenaltyByNode { tangent_factor: 1.0 },
        &pair,
        operators(&pair, &settings),
        &[node; 4],
        &none,
        &last,
        &mut rhs,
    );
    check(50.0 * 0.01 / 4.0, &rhs);
}

#[test]
fn mesh_tying_is_symmetric_and_linear() {
    let pair = random_pair::<Quadrilateral4, Triangle3>(1);
    let operators = operators(&pair, &SegmentationSettings::default()).cells().unwrap();
    let tying = MeshTying { scale_factor: 2.5 };
    const N: usize = MeshTying::size::<Quadrilateral4, Triangle3, 3>();
    let mut noise = Noise::new(4);
    let mut unknowns = [0.0; N];
    unknowns.iter_mut().for_each(|x| *x = noise.next());
    let node = |n: usize| [unknowns[3 * n], unknowns[3 * n + 1], unknowns[3 * n + 2]];
    let (mut rhs, mut lhs) = ([0.0; N], vec![0.0; N * N]);
    tying.residual(
        &operators,
        &std::array::from_fn(node),
        &std::array::from_fn(|n| node(3 + n)),
        &std::array::from_fn(|n| node(7 + n)),
        &mut rhs,
    );
    tying.tangent::<Quadrilateral4, Triangle3, 3>(&operators, &mut lhs);
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
    fn measure<S: FacetShape, M: FacetShape, const NU: usize>() {
        fn one<F: Formulation, S: FacetShape, M: FacetShape, const NU: usize>(
            name: &str,
            formulation: &F,
            history: impl Fn(&PairGeometry<f64, S, M>) -> F::History<S, M>,
        ) {
            let shapes = [S::SHAPE, M::SHAPE];
            let settings = SegmentationSettings::default();
            let n = local_size::<F, S, M>();
            let (mut lhs, mut rhs) = (vec![0.0; n * n], vec![0.0; n]);
            let mut noise = Noise::new(1);
            let cases: Vec<_> = (0..50)
                .map(random_pair::<S, M>)
                .filter(|p| operators(p, &settings).cells().is_some())
                .map(|p| {
                    (
                        p,
                        nodes::<S>(&p.nodal_normals, &mut noise, [NodeState::Slip; 3]),
                        multipliers::<S>(&mut noise),
                        history(&p),
                    )
                })
                .collect();
            let start = std::time::Instant::now();
            for (pair, nodes, lambda, history) in (0..40).flat_map(|_| &cases) {
                residual(formulation, pair, operators(pair, &settings), nodes, lambda, history, &mut rhs);
            }
            let plain = start.elapsed().as_secs_f64();
            let start = std::time::Instant::now();
            for (pair, nodes, lambda, history) in (0..40).flat_map(|_| &cases) {
                tangent(
                    formulation,
                    |first| pair.seeded_from::<NU>(first),
                    &settings,
                    FirstIterateTangent::Exact,
                    nodes,
                    lambda,
                    history,
                    (&mut lhs, n),
                    &mut rhs,
                );
            }
            let dual = start.elapsed().as_secs_f64();
            let each = 1e6 / (40 * cases.len()) as f64;
            println!("{shapes:?} {name}: residual {:.2} µs, with tangent {:.2} µs", plain * each, dual * each);
        }
        one::<_, S, M, NU>("ALM scalar", &ALM, |_| ());
        one::<_, S, M, NU>("ALM components", &COMPONENTS, |_| ());
        one::<_, S, M, NU>("ALM frictional", &frictional(0.0), slip_history);
        one::<_, S, M, NU>("penalty frictional", &PENALTY, last_state);
    }
    measure::<Line2, Line2, 8>();
    measure::<Triangle3, Triangle3, 18>();
    measure::<Quadrilateral4, Quadrilateral4, 24>();
    measure::<Triangle6, Triangle6, 12>();
}

/// Tangential forces of the penalty method: they balance over both sides, oppose the slip, and are cut to the bound. A
/// rigid motion of the pair, however large, makes no slip and takes the carried traction along.
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
            let pair = PairGeometry::<f64, Quadrilateral4, Quadrilateral4> {
                slave: slave.map(place),
                master: master.map(place),
                nodal_normals: [free(up); 4],
                slave_normal: free(up),
                master_normal: free(down),
                choices: Choices::default(),
            };
            let node = SlaveNode {
                state,
                penalty: 50.0,
                compliance: 0.0,
                kept: 0.0,
                stiffness: 50.0,
                area: 0.25,
                dynamic_factor: 1.0,
                friction: Bound { coefficient: 0.4, threshold: 0.0 },
                tangent: free([-1.0, 0.0, 0.0]),
                turning: Turning::default(),
                held: Default::default(),
                held_weight: 1.0,
                carried: [0.01, 0.0, 0.0],
                traction: [0.0; 3],
            };
            // The slave has come along x by 0.02 since.
            let last = LastState { slave: slave.map(|x| [x[0] - 0.02, x[1], x[2]]), master };
            let mut rhs = [0.0; 24];
            residual(
                &PENALTY,
                &pair,
                operators(&pair, &SegmentationSettings::default()),
                &[node; 4],
                &[[0.0; 3]; 4],
                &last,
                &mut rhs,
            );
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
