//! Condensed systems against whole ones, and systems that cannot be condensed.

mod samples;

use samples::{Brick, fix};
use zelus_linear_algebra::{
    Condensation, CondensationSettings, Csr, DirectSettings, Engine, KrylovSettings, Layout, MultigridSettings,
    Multipliers, NotCondensable, Preconditioner, SolveError, Symmetry, System, create,
};

/// Contact state, hence the equations of the multipliers of a slave node.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Kind {
    /// One multiplier along a normal.
    Normal,
    /// One a direction, all of them conditions.
    Stick,
    /// One a direction; those across the normal have equations of their own.
    Components,
    /// As components, with a tangential part that follows the normal one.
    Slip,
    /// Equations of their own only.
    Inactive,
    /// One inactive multiplier.
    InactiveNormal,
}

const KINDS: [Kind; 6] =
    [Kind::Normal, Kind::Stick, Kind::Components, Kind::Slip, Kind::Inactive, Kind::InactiveNormal];

struct Sample {
    layout: Layout,
    bulk: Csr,
    coupling: Csr,
}

impl Sample {
    fn system(&self) -> System<'_> {
        System {
            coupling: Some(&self.coupling),
            coupling_symmetric: false,
            shared: None,
            ..System::bulk(&self.layout, &self.bulk, Symmetry::PositiveDefinite)
        }
    }
}

/// Numbers between −1 and 1 without pattern.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

/// Two boxes of `n³` cells, the upper one held by the multipliers `kind` of its lowest nodes; `scale` is that of the multipliers, `off`
/// their coefficient at the next slave node, relative to their own. The equations `without` of the slave nodes (node, direction) are
/// left out.
fn pressed(
    n: usize,
    kind: impl Fn(usize) -> Kind,
    scale: f64,
    off: f64,
    without: impl Fn(usize, usize) -> bool,
) -> Sample {
    let (lower, upper) = (Brick::of_cubes([n; 3]), Brick::of_cubes([n; 3]));
    let (young, nodes) = (1e5, lower.nodes() + upper.nodes());
    let mut bulk = Vec::new();
    lower.stiffness(0, young, &mut bulk);
    upper.stiffness(lower.nodes(), young, &mut bulk);
    fix(&mut bulk, lower.layer(0).into_iter().flat_map(|node| 3 * node..3 * node + 3), young);
    // Springs, so that nothing is free where few nodes touch.
    bulk.extend((0..3 * nodes).map(|i| (i, i, 1e-3 * young)));
    let mut layout = Layout::blocked(nodes, 3);
    let mut coupling = Vec::new();
    let mut random = Random(88172645463325252);
    let slaves: Vec<usize> = upper.layer(0).iter().map(|node| node + lower.nodes()).collect();
    let masters = lower.layer(n);
    for (at, (&slave, &master)) in slaves.iter().zip(&masters).enumerate() {
        let kind = kind(at);
        let count = if matches!(kind, Kind::Normal | Kind::InactiveNormal) { 1 } else { 3 };
        let first = layout.node.len();
        layout.node.extend(vec![slave as u32; count]);
        layout.multiplier.extend(vec![true; count]);
        let penalty = 0.1 * scale * (1.5 + random.next());
        let own = -scale * scale / penalty;
        if matches!(kind, Kind::Inactive | Kind::InactiveNormal) {
            coupling.extend((0..count).map(|c| (first + c, first + c, own)));
            continue;
        }
        let mut normal = [0.3 * random.next(), 0.3 * random.next(), 1.0];
        let length = normal.iter().map(|x| x * x).sum::<f64>().sqrt();
        normal.iter_mut().for_each(|x| *x /= length);
        let (d, next) = (1.0 + 0.3 * random.next(), (at + 1) % slaves.len());
        let weights = [(slave, d), (master, -0.7 * d), (masters[next], -0.3 * d), (slaves[next], off * d)];
        for c in 0..3 {
            for e in 0..3 {
                let across = f64::from(u8::from(c == e)) - normal[c] * normal[e];
                // Rows of the conditions, with the terms of the motion of the operators.
                let direction = match kind {
                    Kind::Stick => f64::from(u8::from(c == e)),
                    _ => normal[c] * normal[e],
                };
                for (node, weight) in weights {
                    let entry = scale * weight * (direction + 0.02 * random.next());
                    if kind != Kind::Normal {
                        coupling.push((first + c, 3 * node + e, entry));
                    } else if c == 0 {
                        coupling.push((first, 3 * node + e, scale * weight * (normal[e] + 0.02 * random.next())));
                    }
                }
                if matches!(kind, Kind::Components | Kind::Slip) {
                    let follows =
                        if kind == Kind::Slip { 0.3 * normal[e] * if c == 0 { 1.0 } else { 0.2 } } else { 0.0 };
                    coupling.push((first + c, first + e, own * (across - follows)));
                }
                // The augmentation.
                for (node, weight) in weights {
                    coupling.push((3 * slave + c, 3 * node + e, penalty * d * weight * normal[c] * normal[e]));
                }
            }
            for (node, weight) in weights {
                if kind == Kind::Normal {
                    coupling.push((3 * node + c, first, scale * weight * normal[c]));
                } else {
                    coupling.push((3 * node + c, first + c, scale * weight));
                }
            }
        }
    }
    let equations = layout.equations();
    let is_left_out =
        |i: usize| i < 3 * nodes && slaves.iter().position(|&s| s == i / 3).is_some_and(|at| without(at, i % 3));
    let mut number = vec![usize::MAX; equations];
    let mut left = Layout::default();
    for i in (0..equations).filter(|&i| !is_left_out(i)) {
        number[i] = left.node.len();
        left.node.push(layout.node[i]);
        left.multiplier.push(layout.multiplier[i]);
    }
    let matrix = |triplets: &[(usize, usize, f64)]| {
        let kept = triplets.iter().filter(|(i, j, _)| number[*i] != usize::MAX && number[*j] != usize::MAX);
        let kept: Vec<(usize, usize, f64)> = kept.map(|&(i, j, value)| (number[i], number[j], value)).collect();
        Csr::from_triplets(left.equations(), &kept)
    };
    Sample { bulk: matrix(&bulk), coupling: matrix(&coupling), layout: left }
}

fn rhs(n: usize) -> Vec<f64> {
    let mut random = Random(2463534242);
    (0..n).map(|_| random.next()).collect()
}

fn worst(a: &[f64], b: &[f64]) -> f64 {
    let size = b.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / size
}

/// The answers of the whole and of the condensed system, both by the direct engine; displacements and multipliers apart.
fn both(sample: &Sample) -> [f64; 2] {
    let system = sample.system();
    let b = rhs(system.equations());
    let mut whole = vec![0.0; b.len()];
    create(Engine::Direct(DirectSettings::default())).solve(&system, &b, &mut whole).expect("regular");
    let condensation = Condensation::new(&system, &CondensationSettings::default(), 1).expect("condensable");
    let left = condensation.system();
    let mut u = vec![0.0; left.equations()];
    create(Engine::Direct(DirectSettings::default())).solve(&left, &condensation.reduce(&b), &mut u).expect("regular");
    let mut x = vec![0.0; b.len()];
    condensation.expand(&b, &u, &mut x);
    [false, true].map(|multiplier| {
        let of = |x: &[f64]| -> Vec<f64> {
            x.iter().zip(&sample.layout.multiplier).filter(|(_, m)| **m == multiplier).map(|(x, _)| *x).collect()
        };
        worst(&of(&x), &of(&whole))
    })
}

#[test]
fn condensed_and_whole_systems_have_one_answer() {
    for scale in [1e2, 1e5, 1e8] {
        for kind in KINDS {
            let differences = both(&pressed(3, |_| kind, scale, 0.0, |_, _| false));
            assert!(differences.iter().all(|d| *d < 1e-9), "{kind:?}, scale {scale:e}: {differences:?}");
        }
        let mixed = both(&pressed(4, |at| KINDS[at % KINDS.len()], scale, 0.0, |_, _| false));
        assert!(mixed.iter().all(|d| *d < 1e-9), "scale {scale:e}: {mixed:?}");
    }
}

#[test]
fn prescribed_displacements_of_slave_nodes_leave_conditions_that_others_carry() {
    for kind in [Kind::Normal, Kind::Components, Kind::Slip] {
        let differences = both(&pressed(3, |_| kind, 1e5, 0.0, |at, direction| at % 3 == 0 && direction < 2));
        assert!(differences.iter().all(|d| *d < 1e-9), "{kind:?}: {differences:?}");
    }
    let sample = pressed(3, |_| Kind::Stick, 1e5, 0.0, |at, direction| at == 5 && direction == 1);
    let refused = Condensation::new(&sample.system(), &CondensationSettings::default(), 1).expect_err("undetermined");
    let NotCondensable::Undetermined { multiplier, share } = refused else { panic!("{refused:?}") };
    assert!(sample.layout.multiplier[multiplier] && share < 1e-12, "{refused:?}");
}

fn gmres(settings: CondensationSettings) -> Engine {
    let multipliers = Multipliers::Condense(settings);
    let krylov =
        KrylovSettings { tolerance: 1e-11, iterations: 3000, preconditioner: Preconditioner::Ilu0, multipliers };
    Engine::Gmres { krylov, restart: 100 }
}

#[test]
fn what_couples_nodes_is_measured_named_and_corrected() {
    let system_with = |off: f64| pressed(3, |_| Kind::Stick, 1e5, off, |_, _| false);
    let large = system_with(0.1);
    let b = rhs(large.system().equations());
    let mut x = vec![0.0; b.len()];
    let mut solver = create(gmres(CondensationSettings::default()));
    let report = solver.solve(&large.system(), &b, &mut x).expect("the direct engine serves");
    let Some(NotCondensable::OffNode { multiplier, equation, share }) = solver.not_condensed() else {
        panic!("{report:?}")
    };
    assert!(large.layout.node[multiplier] != large.layout.node[equation] && (share - 0.1).abs() < 1e-3, "{share}");
    assert!(report.fallback.is_some_and(|why| why.contains("another node")));
    let strict = CondensationSettings { fallback: false, ..Default::default() };
    let refused = create(gmres(strict)).solve(&large.system(), &b, &mut x);
    assert!(matches!(refused, Err(SolveError::NotCondensable(NotCondensable::OffNode { .. }))), "{refused:?}");

    let small = system_with(1e-7);
    let report = solver.solve(&small.system(), &b, &mut x).expect("condensable");
    assert_eq!((report.engine, solver.not_condensed()), ("gmres, condensed", None), "{report:?}");
    assert!(report.relative_residual <= 1e-10, "{report:?}");
}

#[test]
fn iterative_engines_solve_condensed_systems() {
    for (kinds, symmetric) in [(&KINDS[..], false), (&KINDS[4..], true)] {
        let sample = pressed(6, |at| kinds[at % kinds.len()], 1e5, 0.0, |_, _| false);
        let system = sample.system();
        let b = rhs(system.equations());
        let mut whole = vec![0.0; b.len()];
        create(Engine::Direct(DirectSettings::default())).solve(&system, &b, &mut whole).expect("regular");
        let Engine::Gmres { krylov, .. } = gmres(CondensationSettings::default()) else { unreachable!("made above") };
        for preconditioner in [Preconditioner::BlockJacobi, Preconditioner::Ilu0] {
            let krylov = KrylovSettings { preconditioner, ..krylov.clone() };
            for engine in [Engine::ConjugateGradient(krylov.clone()), Engine::Gmres { krylov, restart: 200 }] {
                let is_gradient = matches!(engine, Engine::ConjugateGradient(_)) && symmetric;
                let mut x = vec![0.0; b.len()];
                let report = create(engine).solve(&system, &b, &mut x).expect("regular");
                let name = if is_gradient { "conjugate_gradient, condensed" } else { "gmres, condensed" };
                assert_eq!(report.engine, name, "{preconditioner:?}: {report:?}");
                assert!(worst(&x, &whole) < 1e-7, "{preconditioner:?}: {}", worst(&x, &whole));
            }
        }
    }
}

/// The system with a second set of multipliers at the first slave node, along another normal and with other masters.
fn with_second_set(first: &Sample, kind: Kind, normal: [f64; 3], scale: f64) -> Sample {
    let mut layout = first.layout.clone();
    let entries = |matrix: &Csr| -> Vec<(usize, usize, f64)> {
        let row =
            |i: usize| matrix.row(i).0.iter().zip(matrix.row(i).1).map(move |(&j, &value)| (i, j as usize, value));
        (0..matrix.rows).flat_map(row).collect()
    };
    let (bulk, mut coupling) = (entries(&first.bulk), entries(&first.coupling));
    let slave = layout.node[layout.multiplier.iter().position(|is| *is).expect("a multiplier")];
    let of_node = |node: u32| (0..first.layout.equations()).filter(move |&i| first.layout.node[i] == node);
    let own: Vec<usize> = of_node(slave).filter(|&i| !first.layout.multiplier[i]).collect();
    // Two nodes of the lower box, which has none with multipliers.
    let masters = [1, 2].map(|node| of_node(node).collect::<Vec<usize>>());
    let count = if matches!(kind, Kind::Normal | Kind::InactiveNormal) { 1 } else { 3 };
    let next = layout.equations();
    layout.node.extend(vec![slave; count]);
    layout.multiplier.extend(vec![true; count]);
    let diagonal = -10.0 * scale;
    let weights = [(&own, 0.8), (&masters[0], -0.5), (&masters[1], -0.3)];
    if matches!(kind, Kind::Inactive | Kind::InactiveNormal) {
        coupling.extend((0..count).map(|c| (next + c, next + c, diagonal)));
    } else {
        for (nodes, weight) in weights {
            for (c, &equation) in nodes.iter().enumerate() {
                if kind == Kind::Normal {
                    let entry = scale * weight * normal[c];
                    coupling.extend([(next, equation, entry), (equation, next, entry)]);
                    continue;
                }
                coupling.push((equation, next + c, scale * weight));
                coupling.extend((0..3).map(|row| (next + row, equation, scale * weight * normal[row] * normal[c])));
            }
        }
        if kind == Kind::Components {
            let across = |c: usize, e: usize| f64::from(u8::from(c == e)) - normal[c] * normal[e];
            coupling.extend((0..9).map(|at| (next + at / 3, next + at % 3, diagonal * across(at / 3, at % 3))));
        }
    }
    let matrix = |triplets: &[(usize, usize, f64)]| Csr::from_triplets(layout.equations(), triplets);
    Sample { bulk: matrix(&bulk), coupling: matrix(&coupling), layout }
}

/// Normals of a second set at a node whose first set has one near z.
const SECOND: [[f64; 3]; 2] = [[1.0, 0.0, 0.0], [0.8, 0.0, 0.6]];

#[test]
fn a_node_may_have_multipliers_of_two_sets() {
    let pairs = [
        (Kind::Normal, Kind::Normal),
        (Kind::Normal, Kind::Components),
        (Kind::Components, Kind::Components),
        (Kind::Slip, Kind::Components),
        (Kind::Stick, Kind::Inactive),
        (Kind::Inactive, Kind::Components),
        (Kind::Slip, Kind::Inactive),
        (Kind::Inactive, Kind::Inactive),
    ];
    let multigrid = MultigridSettings { tolerance: 1e-11, least: [0; 2], ..MultigridSettings::default() };
    for (scale, of_second, normal) in [(1e5, 1e5, SECOND[0]), (1e2, 1e2, SECOND[1]), (1e5, 1e-1, SECOND[0])] {
        for (first, second) in pairs {
            let sample = with_second_set(&pressed(2, |_| first, scale, 0.0, |_, _| false), second, normal, of_second);
            let differences = both(&sample);
            assert!(differences.iter().all(|d| *d < 1e-9), "{first:?} and {second:?}: {differences:?}");
            let system = sample.system();
            let b = rhs(system.equations());
            let (mut whole, mut x) = (vec![0.0; b.len()], vec![0.0; b.len()]);
            create(Engine::Direct(DirectSettings::default())).solve(&system, &b, &mut whole).expect("regular");
            let report = create(Engine::Multigrid(multigrid.clone())).solve(&system, &b, &mut x).expect("regular");
            let said = format!("{first:?} and {second:?}: {report:?}");
            assert_eq!((report.engine, &report.fallback), ("multigrid", &None), "{said}");
            assert!(worst(&x, &whole) < 1e-7, "{said}: {}", worst(&x, &whole));
        }
    }
}

#[test]
fn sets_that_say_the_same_twice_are_refused_by_name() {
    // Both hold all three directions of one node.
    let sample = with_second_set(&pressed(2, |_| Kind::Stick, 1e5, 0.0, |_, _| false), Kind::Normal, SECOND[1], 1e5);
    let refused = Condensation::new(&sample.system(), &CondensationSettings::default(), 1).expect_err("undetermined");
    let NotCondensable::Undetermined { multiplier, share } = refused else { panic!("{refused:?}") };
    assert!(multiplier + 1 == sample.layout.equations() && share < 1e-12, "{refused:?}");
    // Masters can move, so the whole system is regular: the direct engine serves, and says so.
    let b = rhs(sample.system().equations());
    let mut x = vec![0.0; b.len()];
    let multigrid = MultigridSettings { least: [0; 2], ..MultigridSettings::default() };
    for engine in [gmres(CondensationSettings::default()), Engine::Multigrid(multigrid)] {
        let report = create(engine).solve(&sample.system(), &b, &mut x).expect("the direct engine serves");
        assert!(report.fallback.is_some() && report.relative_residual < 1e-9, "{report:?}");
    }
}

#[test]
fn a_direction_that_two_multipliers_hold_against_rigid_walls_is_singular() {
    let layout = Layout { node: vec![0, 0, 0, 0], multiplier: vec![false, false, true, true], ..Layout::default() };
    let bulk = Csr::from_triplets(4, &[(0, 0, 2e5), (0, 1, 1e4), (1, 0, 1e4), (1, 1, 3e5)]);
    let both = [2, 3].into_iter().flat_map(|m| [(0, 0.6), (1, 0.8)].into_iter().map(move |(i, n)| (m, i, n)));
    let both: Vec<(usize, usize, f64)> = both.flat_map(|(m, i, n)| [(m, i, n), (i, m, n)]).collect();
    let sample = Sample { layout, bulk, coupling: Csr::from_triplets(4, &both) };
    let multigrid = MultigridSettings { least: [0; 2], ..MultigridSettings::default() };
    let engines = [Engine::Direct(DirectSettings::default()), gmres(CondensationSettings::default())];
    for engine in engines.into_iter().chain([Engine::Multigrid(multigrid)]) {
        let solved = create(engine).solve(&sample.system(), &[1.0, 2.0, 0.5, 0.7], &mut [0.0; 4]);
        assert!(solved.is_err(), "{solved:?}");
    }
}
