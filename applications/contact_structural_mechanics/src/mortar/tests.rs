//! Properties of the operators over all shape pairs.

use super::*;
use zelus_core::geometry::{FacetShape, Line2, NodeArray, Quadrilateral4, Triangle3};
use zelus_core::scalar::{Dual, Real};
use zelus_core::vector3::{add, cross, dot, normalised, scale, sub};

/// A fixed sequence of numbers in (−1, 1).
pub(crate) struct Noise(u64);

impl Noise {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1)
    }

    pub(crate) fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    fn vector(&mut self, size: f64, dim: usize) -> [f64; 3] {
        std::array::from_fn(|c| if c < dim { size * self.next() } else { 0.0 })
    }
}

/// A unit facet at the origin: on the x axis facing up, or in the plane z = 0 facing up.
pub(crate) fn unit_facet<S: FacetShape>() -> S::Nodal<[f64; 3]> {
    S::nodal(|n| {
        let [xi, eta] = S::corner(n);
        match S::CORNERS {
            2 => [0.5 - 0.5 * xi, 0.0, 0.0],
            3 => [xi, eta, 0.0],
            _ => [0.5 + 0.5 * xi, 0.5 + 0.5 * eta, 0.0],
        }
    })
}

/// The facet run through the other way round, so that it faces the other side.
pub(crate) fn flipped<S: FacetShape>(nodes: S::Nodal<[f64; 3]>) -> S::Nodal<[f64; 3]> {
    let all: Vec<u32> = (0..S::NODES as u32).collect();
    let order = zelus_core::geometry::reversed(S::SHAPE, &all);
    S::nodal(|n| nodes[order[n] as usize])
}

/// A pair with the facets' own normals everywhere.
fn pair<S: FacetShape, M: FacetShape>(
    slave: S::Nodal<[f64; 3]>,
    master: M::Nodal<[f64; 3]>,
) -> PairGeometry<f64, S, M> {
    let slave_normal = S::unit_normal(&slave, S::CENTRE);
    let master_normal = M::unit_normal(&master, M::CENTRE);
    PairGeometry {
        slave,
        master,
        nodal_normals: S::nodal(|_| slave_normal),
        slave_normal,
        master_normal,
        choices: Choices::default(),
    }
}

/// A partly overlapping pair with noise on nodes and normals.
pub(crate) fn random_pair<S: FacetShape, M: FacetShape>(seed: u64) -> PairGeometry<f64, S, M> {
    let mut noise = Noise::new(seed);
    let dim = S::SPACE;
    let shift = match dim {
        2 => [0.6 * noise.next(), -0.02, 0.0],
        _ => [0.15 + 0.3 * noise.next(), 0.1 + 0.3 * noise.next(), 0.02],
    };
    let slave = S::map(&unit_facet::<S>(), |x| add(x, noise.vector(0.06, dim)));
    let master = M::map(&flipped::<M>(unit_facet::<M>()), |x| add(add(scale(x, 1.1), shift), noise.vector(0.06, dim)));
    let mut pair = pair::<S, M>(slave, master);
    pair.nodal_normals = S::map(&pair.nodal_normals, |n| normalised(add(n, noise.vector(0.08, dim))));
    pair.slave_normal = normalised(add(pair.slave_normal, noise.vector(0.03, dim)));
    pair.master_normal = normalised(add(pair.master_normal, noise.vector(0.03, dim)));
    pair
}

/// The pair with displacement unknown `variable` (master first, node by node) moved by `step`.
pub(crate) fn displaced<S: FacetShape, M: FacetShape>(
    pair: &PairGeometry<f64, S, M>,
    variable: usize,
    step: f64,
) -> PairGeometry<f64, S, M> {
    let (node, c) = (variable / S::SPACE, variable % S::SPACE);
    let mut moved = *pair;
    if node < M::NODES {
        moved.master[node][c] += step;
    } else {
        moved.slave[node - M::NODES][c] += step;
    }
    moved
}

fn flat<T: Real, S: FacetShape, M: FacetShape>(operators: &Operators<T, S, M>) -> Vec<T> {
    let (d, m) = (operators.d.iter().flat_map(|row| row.iter()), operators.m.iter().flat_map(|row| row.iter()));
    d.chain(m).copied().collect()
}

fn value_of<S: FacetShape, M: FacetShape>(pair: &PairGeometry<f64, S, M>) -> Operators<f64, S, M> {
    operators(pair, &SegmentationSettings::default()).cells().expect("the facets overlap")
}

macro_rules! for_all_shapes {
    ($check:ident) => {
        $crate::with_pairs_of_shapes! { [$crate::mortar::tests::for_all_shapes] $check }
    };
    ($check:ident $(($s:ident, $m:ident, $end:literal))*) => {{
        use zelus_core::geometry;
        $($check::<geometry::$s, geometry::$m, { $crate::mortar::lanes::<geometry::$s, geometry::$m>(PairGeometry::<f64, geometry::$s, geometry::$m>::UNKNOWNS) }>();)*
    }};
}
pub(crate) use for_all_shapes;

fn derivative_matches_differences<S: FacetShape, M: FacetShape, const NU: usize>() {
    let shapes = [S::SHAPE, M::SHAPE];
    for axisymmetric in [None, (S::SPACE == 2).then_some(0.7)] {
        for order in 1..=5 {
            let settings = SegmentationSettings {
                axisymmetric,
                integration_order: IntegrationOrder::new(order).unwrap(),
                ..Default::default()
            };
            for seed in 0..if order == 2 { 40 } else { 4 } {
                let pair = random_pair::<S, M>(seed);
                let dual = |first| operators(&pair.seeded_from::<NU>(first), &settings).cells().map(|dual| flat(&dual));
                let Some(values) = dual(0) else { continue };
                let plain = operators(&pair, &settings).cells().unwrap();
                let scale = flat(&plain).iter().fold(0.0, |a: f64, b| a.max(b.abs()));
                for (a, b) in flat(&plain).iter().zip(values.iter().map(|x| x.value)) {
                    assert!((a - b).abs() < 1e-13 * scale, "seed {seed}: {a} {b}");
                }
                let mut gradient = values;
                for variable in 0..PairGeometry::<f64, S, M>::UNKNOWNS {
                    if variable > 0 && variable % NU == 0 {
                        gradient = dual(variable).expect("an overlap");
                    }
                    let h = 1e-6;
                    let at = |h| flat(&operators(&displaced(&pair, variable, h), &settings).cells().unwrap());
                    for (entry, (plus, minus)) in at(h).iter().zip(at(-h)).enumerate() {
                        let slope = (plus - minus) / (2.0 * h);
                        let exact = gradient[entry].gradient[variable % NU];
                        assert!(
                            (slope - exact).abs() < 1e-6 * slope.abs().max(scale),
                            "{shapes:?} seed {seed} order {order} entry {entry} variable {variable}: {slope} {exact}"
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn operators_have_exact_derivatives() {
    for_all_shapes!(derivative_matches_differences);
}

/// Derivatives by nodal normals, found by the normal of each point, are those of numbers that carry them through everything.
fn normals_of_nodes<S: FacetShape, M: FacetShape>() {
    let settings = SegmentationSettings::default();
    for seed in 0..8 {
        let pair = random_pair::<S, M>(seed);
        for first in (0..PairGeometry::<f64, S, M>::NORMALS).step_by(4) {
            let whole = operators(&pair.seeded_by_normals::<4>(first), &settings).cells();
            let found = operators_by_normals::<S, M, 4>(&pair, &settings, first).cells();
            assert_eq!(whole.is_some(), found.is_some());
            let (Some(whole), Some(found)) = (whole, found) else { continue };
            for (a, b) in flat(&whole).iter().zip(&flat(&found)) {
                assert!((a.value - b.value).abs() < 1e-13);
                let apart = a.gradient.iter().zip(&b.gradient).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                assert!(apart < 1e-12, "{:?} seed {seed}: {a:?} {b:?}", [S::SHAPE, M::SHAPE]);
            }
        }
    }
}

#[test]
fn normals_of_nodes_move_points_on_the_master() {
    normals_of_nodes::<Triangle3, Triangle3>();
    normals_of_nodes::<Triangle3, Quadrilateral4>();
    normals_of_nodes::<Quadrilateral4, Triangle3>();
    normals_of_nodes::<Quadrilateral4, Quadrilateral4>();
}

#[test]
fn normals_may_vary_too() {
    // All normals turn with one parameter; coordinates stay.
    let pair = random_pair::<Quadrilateral4, Quadrilateral4>(3);
    let turn = [0.03, -0.05, 0.02];
    let turned = |h: f64| {
        let mut moved = pair;
        let by = |n: [f64; 3]| add(n, scale(cross(turn, n), h));
        moved.nodal_normals = moved.nodal_normals.map(by);
        (moved.slave_normal, moved.master_normal) = (by(moved.slave_normal), by(moved.master_normal));
        moved
    };
    let mut dual = pair.as_constants::<Dual<1>>();
    let by = |n: [Dual<1>; 3]| {
        let change = cross(turn, n.map(|x| x.value));
        std::array::from_fn(|c| Dual { value: n[c].value, gradient: [change[c]] })
    };
    dual.nodal_normals = dual.nodal_normals.map(by);
    (dual.slave_normal, dual.master_normal) = (by(dual.slave_normal), by(dual.master_normal));
    let exact = operators(&dual, &SegmentationSettings::default()).cells().unwrap();
    let h = 1e-5;
    let (plus, minus) = (value_of(&turned(h)), value_of(&turned(-h)));
    for (x, (a, b)) in exact.m.iter().flatten().zip(plus.m.iter().flatten().zip(minus.m.iter().flatten())) {
        let slope = (a - b) / (2.0 * h);
        assert!((x.gradient[0] - slope).abs() < 1e-8, "{} {slope}", x.gradient[0]);
    }
}

fn partition_of_unity<S: FacetShape, M: FacetShape, const NU: usize>() {
    let shapes = [S::SHAPE, M::SHAPE];
    let mut diagonal = 0;
    for seed in 0..40 {
        let Some(o) = operators(&random_pair::<S, M>(seed), &SegmentationSettings::default()).cells() else {
            continue;
        };
        for j in 0..S::NODES {
            let (d, m): (f64, f64) = (o.d[j].iter().sum(), o.m[j].iter().sum());
            assert!((m - d).abs() < 1e-11, "row {j} of seed {seed}: {m} {d}");
        }
        assert!(S::NODES == 4 || S::CURVED || o.is_diagonal());
        diagonal += usize::from(S::CURVED || o.is_diagonal());
    }
    assert!(diagonal >= 25, "{shapes:?}: {diagonal}");
}

#[test]
fn d_is_diagonal_and_rows_of_m_add_up_to_it() {
    for_all_shapes!(partition_of_unity);
}

fn area<S: FacetShape, M: FacetShape>(pair: &PairGeometry<f64, S, M>) -> f64 {
    operators(pair, &SegmentationSettings::default())
        .cells()
        .map_or(0.0, |o| o.d.iter().flat_map(|row| row.iter()).sum())
}

#[test]
fn known_overlap_areas() {
    let up = |x: f64, y: f64| [x, y, 0.1];
    let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-14, "{a} {b}");
    // A unit square and one turned by 45° with the same centre: a regular octagon.
    let r = 0.5_f64.sqrt();
    let diamond = flipped::<Quadrilateral4>([up(0.5 + r, 0.5), up(0.5, 0.5 + r), up(0.5 - r, 0.5), up(0.5, 0.5 - r)]);
    close(
        area(&pair::<Quadrilateral4, Quadrilateral4>(unit_facet::<Quadrilateral4>(), diamond)),
        2.0 * (2.0_f64.sqrt() - 1.0),
    );
    // Shifted squares, shifted triangles, a triangle over a square, a small square in a triangle.
    let shifted = |dx, dy| flipped::<Quadrilateral4>(unit_facet::<Quadrilateral4>()).map(|x| add(x, [dx, dy, 0.2]));
    close(area(&pair::<Quadrilateral4, Quadrilateral4>(unit_facet::<Quadrilateral4>(), shifted(0.3, -0.4))), 0.7 * 0.6);
    let triangle = flipped::<Triangle3>(unit_facet::<Triangle3>()).map(|x| add(x, [0.25, 0.25, 0.1]));
    close(area(&pair::<Triangle3, Triangle3>(unit_facet::<Triangle3>(), triangle)), 0.125);
    close(
        area(&pair::<Quadrilateral4, Triangle3>(unit_facet::<Quadrilateral4>(), triangle)),
        0.5 - 2.0 * 0.25 * 0.25 / 2.0,
    );
    let small = flipped::<Quadrilateral4>(unit_facet::<Quadrilateral4>()).map(|x| add(scale(x, 0.3), [0.1, 0.2, 0.0]));
    close(area(&pair::<Triangle3, Quadrilateral4>(unit_facet::<Triangle3>(), small)), 0.09);
    // Lines.
    let master = [[0.4, -0.1, 0.0], [1.7, -0.1, 0.0]];
    close(area(&pair::<Line2, Line2>(unit_facet::<Line2>(), master)), 0.6);
}

fn planar_patch<S: FacetShape, M: FacetShape, const NU: usize>() {
    // On coincident planes a linear field crosses the interface unchanged: M f(x²) = D f(x¹). D and M are those of one
    // pair, so the slave part outside the overlap must not matter.
    for seed in 0..30 {
        let mut pair = random_pair::<S, M>(seed);
        let plane = S::SPACE - 1;
        pair.slave.iter_mut().chain(pair.master.iter_mut()).for_each(|x| x[plane] = 0.0);
        let up = std::array::from_fn(|c| f64::from(u8::from(c == plane)));
        (pair.nodal_normals, pair.slave_normal, pair.master_normal) = (S::nodal(|_| up), up, scale(up, -1.0));
        let Some(o) = operators(&pair, &SegmentationSettings::default()).cells() else { continue };
        let field = |x: [f64; 3]| [0.3 + 2.0 * x[0] - 0.7 * x[1], x[0], x[1]];
        for row in o.jump(&S::map(&pair.slave, field), &M::map(&pair.master, field)) {
            assert!(row.iter().all(|x| x.abs() < 1e-12), "seed {seed}: {row:?}");
        }
        for g in weighted_gap(&o, &pair.slave, &pair.master, &pair.nodal_normals) {
            assert!(g.abs() < 1e-15);
        }
    }
}

#[test]
fn linear_fields_are_mapped_exactly() {
    for_all_shapes!(planar_patch);
}

fn rigid<S: FacetShape, M: FacetShape, const NU: usize>() {
    let shapes = [S::SHAPE, M::SHAPE];
    let (angle, axis) = if S::SPACE == 2 { (0.8, [0.0, 0.0, 1.0]) } else { (1.1, normalised([0.3, -0.5, 0.7])) };
    let rotated = |x: [f64; 3]| {
        let (s, c) = f64::sin_cos(angle);
        add(add(scale(x, c), scale(cross(axis, x), s)), scale(axis, dot(axis, x) * (1.0 - c)))
    };
    let moved = |x: [f64; 3]| add(rotated(x), [3.0, -2.0, if S::SPACE == 2 { 0.0 } else { 5.0 }]);
    for seed in 0..20 {
        let before = random_pair::<S, M>(seed);
        let after = PairGeometry::<f64, S, M> {
            slave: S::map(&before.slave, moved),
            master: M::map(&before.master, moved),
            nodal_normals: S::map(&before.nodal_normals, rotated),
            slave_normal: rotated(before.slave_normal),
            master_normal: rotated(before.master_normal),
            choices: before.choices,
        };
        let settings = SegmentationSettings::default();
        let (Overlap::Cells(a), Overlap::Cells(b)) = (operators(&before, &settings), operators(&after, &settings))
        else {
            continue;
        };
        let scale = flat(&a).iter().fold(0.0, |a: f64, b| a.max(b.abs()));
        for (x, y) in flat(&a).iter().zip(flat(&b)) {
            assert!((x - y).abs() < 1e-10 * scale, "{shapes:?} seed {seed}: {x} {y}");
        }
        let gap_a: S::Nodal<f64> = weighted_gap(&a, &before.slave, &before.master, &before.nodal_normals);
        let gap_b: S::Nodal<f64> = weighted_gap(&b, &after.slave, &after.master, &after.nodal_normals);
        gap_a.iter().zip(gap_b.iter()).for_each(|(x, y)| assert!((x - y).abs() < 1e-11));
    }
}

#[test]
fn rigid_motions_change_nothing() {
    for_all_shapes!(rigid);
}

fn permuted<S: FacetShape, M: FacetShape, const NU: usize>() {
    let shapes = [S::SHAPE, M::SHAPE];
    for seed in 0..20 {
        let a = random_pair::<S, M>(seed);
        // Flat facets: on warped ones, and where cells differ, the rule is not exact and depends on the first vertex.
        let a = if S::SPACE == 2 { a } else { flattened(a) };
        let mut b = a;
        if S::SPACE > 2 {
            b.slave = S::nodal(|n| a.slave[turned::<S>(n, 1)]);
            b.nodal_normals = S::nodal(|n| a.nodal_normals[turned::<S>(n, 1)]);
            b.master = M::nodal(|n| a.master[turned::<M>(n, M::CORNERS - 1)]);
        }
        let settings =
            SegmentationSettings { integration_order: IntegrationOrder::new(5).unwrap(), ..Default::default() };
        let (Overlap::Cells(x), Overlap::Cells(y)) = (operators(&a, &settings), operators(&b, &settings)) else {
            continue;
        };
        for j in 0..S::NODES {
            for l in 0..M::NODES {
                let (pj, pl) = if S::SPACE > 2 { (turned::<S>(j, S::CORNERS - 1), turned::<M>(l, 1)) } else { (j, l) };
                let apart = (x.m[j][l] - y.m[pj][pl]).abs();
                assert!(apart < 1e-12, "{shapes:?} seed {seed}: {apart}");
            }
        }
    }
}

/// The node that takes the place of another when numbers begin that many corners later.
fn turned<S: FacetShape>(n: usize, by: usize) -> usize {
    match n / S::CORNERS {
        ring @ 0..=1 => ring * S::CORNERS + (n + by) % S::CORNERS,
        _ => n,
    }
}

/// The same pair as parallelograms or triangles in two parallel planes.
fn flattened<S: FacetShape, M: FacetShape>(mut pair: PairGeometry<f64, S, M>) -> PairGeometry<f64, S, M> {
    fn square<F: FacetShape>(x: &mut F::Nodal<[f64; 3]>) {
        x.iter_mut().for_each(|x| x[2] = 0.0);
        if F::CORNERS == 4 {
            x[3] = sub(add(x[0], x[2]), x[1]);
        }
        for n in F::CORNERS..F::NODES {
            let all = F::CORNERS as f64;
            x[n] = match n / F::CORNERS {
                1 => scale(add(x[n - F::CORNERS], x[(n + 1) % F::CORNERS]), 0.5),
                _ => (0..F::CORNERS).fold([0.0; 3], |sum, k| add(sum, scale(x[k], 1.0 / all))),
            };
        }
    }
    square::<S>(&mut pair.slave);
    square::<M>(&mut pair.master);
    (pair.nodal_normals, pair.slave_normal) = (S::nodal(|_| [0.0, 0.0, 1.0]), [0.0, 0.0, 1.0]);
    pair.master_normal = [0.0, 0.0, -1.0];
    pair
}

#[test]
fn numbering_of_nodes_does_not_matter() {
    for_all_shapes!(permuted);
}

fn apart<S: FacetShape, M: FacetShape, const NU: usize>() {
    let far = |dx: f64, dz: f64| {
        let up = if S::SPACE == 2 { [dx, dz, 0.0] } else { [dx, 0.0, dz] };
        pair::<S, M>(unit_facet::<S>(), M::map(&flipped::<M>(unit_facet::<M>()), |x| add(x, up)))
    };
    let settings = SegmentationSettings { distance_threshold: 0.5, ..Default::default() };
    let meet = |dx: f64, dz: f64| !matches!(operators(&far(dx, dz), &settings), Overlap::None);
    assert!(!meet(3.0, 0.0));
    assert!(!meet(1.0, 0.0), "facets that touch at an edge");
    // On lines the threshold counts against the normal.
    let distance = if S::SPACE == 2 { -0.6 } else { 0.6 };
    assert!(!meet(0.0, distance), "beyond the threshold");
    assert!(meet(0.0, -distance), "the threshold is signed");
    assert!(meet(0.5, 0.0));
}

#[test]
fn nothing_where_facets_do_not_meet() {
    for_all_shapes!(apart);
}

fn degenerate<S: FacetShape, M: FacetShape, const NU: usize>() {
    let shapes = [S::SHAPE, M::SHAPE];
    // Coincident facets, a node on an edge, a common edge, all with and without noise at rounding level.
    for (dx, scale_by) in [(0.0, 1.0), (0.5, 1.0), (0.25, 0.5), (0.0, 0.5), (-0.5, 2.0), (1.0 - 1e-9, 1.0)] {
        for noise in [0.0, 1e-16, 1e-14, 1e-12, 1e-10] {
            let mut random = Noise::new(7);
            let master = M::map(&flipped::<M>(unit_facet::<M>()), |x| {
                add(add(scale(x, scale_by), [dx, 0.0, 0.0]), random.vector(noise, S::SPACE))
            });
            let pair = pair::<S, M>(unit_facet::<S>(), master);
            let settings = SegmentationSettings::default();
            let (plain, dual) = (operators(&pair, &settings), operators(&pair.seeded_from::<NU>(0), &settings));
            let Overlap::Cells(dual) = dual else {
                assert!(!matches!(plain, Overlap::Cells(_)));
                continue;
            };
            for x in flat(&dual) {
                assert!(x.value.is_finite());
                let largest = x.gradient.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
                assert!(largest < 1e3, "{shapes:?} {dx} {scale_by} {noise}: {largest}");
            }
        }
    }
}

#[test]
fn coincident_nodes_and_edges_are_harmless() {
    for_all_shapes!(degenerate);
}

#[test]
fn several_masters_cover_a_slave_exactly() {
    let slave = [[0.05, 0.0, 0.0], [1.0, 0.1, 0.0], [0.9, 1.0, 0.0], [0.0, 0.9, 0.0]];
    let corner = |i: usize, j: usize, n: usize, x0: f64| [x0 + i as f64 / n as f64, x0 + j as f64 / n as f64, 0.0];
    let whole = 0.5 * cross(sub(slave[2], slave[0]), sub(slave[3], slave[1]))[2];
    // Grids whose lines pass through slave nodes and edges, or miss them.
    for (n, x0, count) in [(1, 0.0, 2), (2, -0.1, 4), (3, -0.05, 5), (10, 0.0, 12)] {
        let (mut quads, mut triangles) = (0.0, 0.0);
        for i in 0..count {
            for j in 0..count {
                let [a, b, c, d] = [(i, j), (i, j + 1), (i + 1, j + 1), (i + 1, j)].map(|(i, j)| corner(i, j, n, x0));
                quads += area(&pair::<Quadrilateral4, Quadrilateral4>(slave, [a, b, c, d]));
                triangles += area(&pair::<Quadrilateral4, Triangle3>(slave, [a, b, c]))
                    + area(&pair::<Quadrilateral4, Triangle3>(slave, [a, c, d]));
            }
        }
        // A sliver below the least overlap may be missing.
        assert!((quads - whole).abs() < 1e-13 && (triangles - whole).abs() < 1e-13, "{n}: {quads} {triangles}");
    }
}

fn reference_values<S: FacetShape, M: FacetShape, const NU: usize>() {
    let shapes = [S::SHAPE, M::SHAPE];
    let mut found = 0;
    for line in include_str!("reference_pairs.txt").lines().filter(|line| !line.starts_with('#')) {
        let numbers: Vec<f64> = line.split(' ').map(|x| x.parse().unwrap()).collect();
        if S::CURVED || M::CURVED || numbers[..2] != [S::NODES as f64, M::NODES as f64] {
            continue;
        }
        let mut rest = &numbers[2..];
        let mut vector = || {
            let (head, tail) = rest.split_first_chunk::<3>().unwrap();
            rest = tail;
            *head
        };
        let pair = PairGeometry::<f64, S, M> {
            slave: S::nodal(|_| vector()),
            master: M::nodal(|_| vector()),
            nodal_normals: S::nodal(|_| vector()),
            slave_normal: vector(),
            master_normal: vector(),
            choices: Choices::default(),
        };
        let o = value_of(&pair);
        let gap = weighted_gap(&o, &pair.slave, &pair.master, &pair.nodal_normals);
        let scale = rest[..S::NODES * S::NODES].iter().fold(0.0, |a: f64, b| a.max(b.abs()));
        assert_eq!(rest.len(), S::NODES * (S::NODES + M::NODES + 1));
        for (entry, (x, reference)) in flat(&o).iter().chain(gap.iter()).zip(rest).enumerate() {
            assert!((x - reference).abs() < 1e-10 * scale, "{shapes:?} entry {entry}: {x} {reference}");
        }
        found += 1;
    }
    assert!(S::CURVED || M::CURVED || found >= 2);
}

#[test]
fn values_of_the_reference_program() {
    for_all_shapes!(reference_values);
}

/// Cost of a quadrilateral pair; run with `--ignored --nocapture`.
#[test]
#[ignore = "a measurement"]
fn cost_of_operators() {
    fn measure<S: FacetShape, M: FacetShape, const NU: usize>() {
        let shapes = [S::SHAPE, M::SHAPE];
        let settings = SegmentationSettings::default();
        let pairs: Vec<_> = (0..50).map(random_pair::<S, M>).collect();
        let time = |f: &dyn Fn(&PairGeometry<f64, S, M>) -> f64| {
            let start = std::time::Instant::now();
            let sum: f64 = (0..40).flat_map(|_| &pairs).map(f).sum();
            (start.elapsed().as_secs_f64() / 2000.0 * 1e6, sum)
        };
        let (plain, a) = time(&|p| operators(p, &settings).cells().map_or(0.0, |o| o.m[0][0]));
        let (dual, b) =
            time(&|p| operators(&p.seeded_from::<NU>(0), &settings).cells().map_or(0.0, |o| o.m[0][0].value));
        assert!((a - b).abs() < 1e-9);
        println!("{shapes:?}: {plain:.2} µs plain, {dual:.2} µs dual, ratio {:.1}", dual / plain);
    }
    for_all_shapes!(measure);
}
