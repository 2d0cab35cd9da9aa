//! Properties of the operators over all shape pairs.

use super::*;
use zelus_core::geometry::{FacetShape, LINE_2, Nodal, QUADRILATERAL_4, TRIANGLE_3};
use zelus_core::scalar::Real;
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
pub(crate) fn unit_facet(shape: &FacetShape) -> Nodal<[f64; 3]> {
    shape.nodal(|n| {
        let [xi, eta] = shape.corner(n);
        match shape.corners {
            2 => [0.5 - 0.5 * xi, 0.0, 0.0],
            3 => [xi, eta, 0.0],
            _ => [0.5 + 0.5 * xi, 0.5 + 0.5 * eta, 0.0],
        }
    })
}

/// The facet run through the other way round, so that it faces the other side.
pub(crate) fn flipped(shape: &FacetShape, nodes: &[[f64; 3]]) -> Nodal<[f64; 3]> {
    let all: Vec<u32> = (0..shape.nodes as u32).collect();
    let order = zelus_core::geometry::reversed(shape.shape, &all);
    shape.nodal(|n| nodes[order[n] as usize])
}

/// A pair with the facets' own normals everywhere.
fn pair(
    [slave_shape, master_shape]: [&'static FacetShape; 2],
    slave: Nodal<[f64; 3]>,
    master: Nodal<[f64; 3]>,
) -> PairGeometry<f64> {
    let slave_normal = slave_shape.unit_normal(&slave, slave_shape.centre);
    let master_normal = master_shape.unit_normal(&master, master_shape.centre);
    PairGeometry {
        slave_shape,
        master_shape,
        slave,
        master,
        nodal_normals: slave_shape.nodal(|_| slave_normal),
        slave_normal,
        master_normal,
        exact: None,
        choices: Choices::default(),
    }
}

/// A partly overlapping pair with noise on nodes and normals.
pub(crate) fn random_pair(slave: &'static FacetShape, master: &'static FacetShape, seed: u64) -> PairGeometry<f64> {
    let mut noise = Noise::new(seed);
    let dim = slave.space;
    let shift = match dim {
        2 => [0.6 * noise.next(), -0.02, 0.0],
        _ => [0.15 + 0.3 * noise.next(), 0.1 + 0.3 * noise.next(), 0.02],
    };
    let own = unit_facet(slave).map(|x| add(x, noise.vector(0.06, dim)));
    let other = flipped(master, &unit_facet(master)).map(|x| add(add(scale(x, 1.1), shift), noise.vector(0.06, dim)));
    let mut pair = pair([slave, master], own, other);
    pair.nodal_normals = pair.nodal_normals.map(|n| normalised(add(n, noise.vector(0.08, dim))));
    pair.slave_normal = normalised(add(pair.slave_normal, noise.vector(0.03, dim)));
    pair.master_normal = normalised(add(pair.master_normal, noise.vector(0.03, dim)));
    pair
}

/// The pair with displacement unknown `variable` (master first, node by node) moved by `step`.
pub(crate) fn displaced(pair: &PairGeometry<f64>, variable: usize, step: f64) -> PairGeometry<f64> {
    let (node, c) = (variable / pair.space(), variable % pair.space());
    let mut moved = *pair;
    if node < pair.master.len() {
        moved.master[node][c] += step;
    } else {
        moved.slave[node - pair.master.len()][c] += step;
    }
    moved
}

fn flat<T: Real>(operators: &Operators<T>) -> Vec<T> {
    let (d, m) = (operators.d.iter().flat_map(|row| row.iter()), operators.m.iter().flat_map(|row| row.iter()));
    d.chain(m).copied().collect()
}

fn value_of(pair: &PairGeometry<f64>) -> Operators<f64> {
    operators(pair, &SegmentationSettings::default()).cells().expect("the facets overlap")
}

/// Every two shapes of one space, slave and master.
pub(crate) fn all_shapes() -> impl Iterator<Item = [&'static FacetShape; 2]> {
    let all = FacetShape::all();
    let pairs = all.into_iter().flat_map(move |slave| all.map(|master| [slave, master]));
    pairs.filter(|[slave, master]| slave.space == master.space)
}

fn derivative_matches_differences(slave: &'static FacetShape, master: &'static FacetShape) {
    let shapes = [slave, master];
    // Pieces of facets of second order are integrated by the fourth order at least, and take long.
    let curved = slave.curved || master.curved;
    let orders = if curved { vec![2, 5] } else { (1..=5).collect() };
    for axisymmetric in [None, (slave.space == 2).then_some(0.7)] {
        for &order in &orders {
            let settings = SegmentationSettings {
                axisymmetric,
                integration_order: IntegrationOrder::new(order).unwrap(),
                ..Default::default()
            };
            for seed in 0..if curved {
                2
            } else if order == 2 {
                40
            } else {
                4
            } {
                let pair = random_pair(slave, master, seed);
                let dual = |first| operators(&pair.seeded_from(first), &settings).cells().map(|dual| flat(&dual));
                let Some(values) = dual(0) else { continue };
                let plain = operators(&pair, &settings).cells().unwrap();
                let scale = flat(&plain).iter().fold(0.0, |a: f64, b| a.max(b.abs()));
                for (a, b) in flat(&plain).iter().zip(values.iter().map(|x| x.value)) {
                    assert!((a - b).abs() < 1e-13 * scale, "seed {seed}: {a} {b}");
                }
                let mut gradient = values;
                for variable in 0..pair.unknowns() {
                    if variable > 0 && variable % LANES == 0 {
                        gradient = dual(variable).expect("an overlap");
                    }
                    let h = 1e-6;
                    let at = |h| flat(&operators(&displaced(&pair, variable, h), &settings).cells().unwrap());
                    for (entry, (plus, minus)) in at(h).iter().zip(at(-h)).enumerate() {
                        let slope = (plus - minus) / (2.0 * h);
                        let exact = gradient[entry].gradient[variable % LANES];
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
    all_shapes().for_each(|[slave, master]| derivative_matches_differences(slave, master));
}

/// Derivatives by nodal normals, found by the normal of each point, are those of numbers that carry them through everything.
#[test]
fn normals_of_nodes_move_points_on_the_master() {
    let settings = SegmentationSettings::default();
    for [slave, master] in all_shapes().filter(|[slave, _]| slave.space == 3) {
        for seed in 0..if slave.curved || master.curved { 2 } else { 8 } {
            let pair = random_pair(slave, master, seed);
            for first in (0..pair.normal_components()).step_by(LANES) {
                let whole = operators(&pair.seeded_by_normals(first), &settings).cells();
                let mut found = Operators::zero(slave, master);
                let points = PairPoints::new(&pair, &settings);
                let overlap = find_operators_by_normals(&pair, &settings, &points, first, &mut found);
                assert_eq!(whole.is_some(), overlap.cells().is_some());
                let Some(whole) = whole else { continue };
                for (a, b) in flat(&whole).iter().zip(&flat(&found)) {
                    assert!((a.value - b.value).abs() < 1e-13);
                    let apart = a.gradient.iter().zip(&b.gradient).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                    assert!(apart < 1e-12, "{:?} seed {seed}: {a:?} {b:?}", [slave, master]);
                }
            }
        }
    }
}

#[test]
fn normals_may_vary_too() {
    // All normals turn with one parameter; coordinates stay.
    let pair = random_pair(&QUADRILATERAL_4, &QUADRILATERAL_4, 3);
    let turn = [0.03, -0.05, 0.02];
    let turned = |h: f64| {
        let mut moved = pair;
        let by = |n: [f64; 3]| add(n, scale(cross(turn, n), h));
        moved.nodal_normals = moved.nodal_normals.map(&by);
        (moved.slave_normal, moved.master_normal) = (by(moved.slave_normal), by(moved.master_normal));
        moved
    };
    let mut dual = pair.as_constants::<Active>();
    let by = |n: [Active; 3]| {
        let change = cross(turn, n.map(|x| x.value));
        std::array::from_fn(|c| {
            let mut moved = n[c];
            moved.gradient[0] = change[c];
            moved
        })
    };
    dual.nodal_normals = dual.nodal_normals.map(by);
    (dual.slave_normal, dual.master_normal) = (by(dual.slave_normal), by(dual.master_normal));
    let exact = operators(&dual, &SegmentationSettings::default()).cells().unwrap();
    let h = 1e-5;
    let (plus, minus) = (value_of(&turned(h)), value_of(&turned(-h)));
    for (x, (a, b)) in flat(&exact).iter().zip(flat(&plus).iter().zip(&flat(&minus))) {
        let slope = (a - b) / (2.0 * h);
        assert!((x.gradient[0] - slope).abs() < 1e-8, "{} {slope}", x.gradient[0]);
    }
}

fn partition_of_unity(slave: &'static FacetShape, master: &'static FacetShape) {
    let shapes = [slave, master];
    let mut diagonal = 0;
    for seed in 0..40 {
        let Some(o) = operators(&random_pair(slave, master, seed), &SegmentationSettings::default()).cells() else {
            continue;
        };
        for j in 0..slave.nodes {
            let (d, m): (f64, f64) = (o.d[j].iter().sum(), o.m[j].iter().sum());
            assert!((m - d).abs() < 1e-11, "row {j} of seed {seed}: {m} {d}");
        }
        assert!(slave.nodes == 4 || slave.curved || o.is_diagonal());
        diagonal += usize::from(slave.curved || o.is_diagonal());
    }
    assert!(diagonal >= 25, "{shapes:?}: {diagonal}");
}

#[test]
fn d_is_diagonal_and_rows_of_m_add_up_to_it() {
    all_shapes().for_each(|[slave, master]| partition_of_unity(slave, master));
}

fn area(pair: &PairGeometry<f64>) -> f64 {
    operators(pair, &SegmentationSettings::default())
        .cells()
        .map_or(0.0, |o| o.d.iter().flat_map(|row| row.iter()).sum())
}

#[test]
fn known_overlap_areas() {
    let up = |x: f64, y: f64| [x, y, 0.1];
    let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-14, "{a} {b}");
    let (square, triangle) = (&QUADRILATERAL_4, &TRIANGLE_3);
    // The overlap of the unit facet of a shape and a facet of another one.
    let area_of = |slave: &'static FacetShape, master: &'static FacetShape, nodes: Nodal<[f64; 3]>| {
        area(&pair([slave, master], unit_facet(slave), nodes))
    };
    // A unit square and one turned by 45° with the same centre: a regular octagon.
    let r = 0.5_f64.sqrt();
    let diamond = flipped(square, &[up(0.5 + r, 0.5), up(0.5, 0.5 + r), up(0.5 - r, 0.5), up(0.5, 0.5 - r)]);
    close(area_of(square, square, diamond), 2.0 * (2.0_f64.sqrt() - 1.0));
    // Shifted squares, shifted triangles, a triangle over a square, a small square in a triangle.
    let shifted = |dx, dy| flipped(square, &unit_facet(square)).map(|x| add(x, [dx, dy, 0.2]));
    close(area_of(square, square, shifted(0.3, -0.4)), 0.7 * 0.6);
    let moved = flipped(triangle, &unit_facet(triangle)).map(|x| add(x, [0.25, 0.25, 0.1]));
    close(area_of(triangle, triangle, moved), 0.125);
    close(area_of(square, triangle, moved), 0.5 - 2.0 * 0.25 * 0.25 / 2.0);
    let small = flipped(square, &unit_facet(square)).map(|x| add(scale(x, 0.3), [0.1, 0.2, 0.0]));
    close(area_of(triangle, square, small), 0.09);
    // Lines.
    close(area_of(&LINE_2, &LINE_2, [[0.4, -0.1, 0.0], [1.7, -0.1, 0.0]].into()), 0.6);
}

fn planar_patch(slave: &'static FacetShape, master: &'static FacetShape) {
    // On coincident planes a linear field crosses the interface unchanged: M f(x²) = D f(x¹). D and M are those of one
    // pair, so the slave part outside the overlap must not matter.
    for seed in 0..30 {
        let mut pair = random_pair(slave, master, seed);
        let plane = slave.space - 1;
        pair.slave.iter_mut().chain(pair.master.iter_mut()).for_each(|x| x[plane] = 0.0);
        let up = std::array::from_fn(|c| f64::from(u8::from(c == plane)));
        (pair.nodal_normals, pair.slave_normal, pair.master_normal) = (slave.nodal(|_| up), up, scale(up, -1.0));
        let Some(o) = operators(&pair, &SegmentationSettings::default()).cells() else { continue };
        let field = |x: [f64; 3]| [0.3 + 2.0 * x[0] - 0.7 * x[1], x[0], x[1]];
        for row in o.jump(&pair.slave.map(field), &pair.master.map(field)).iter() {
            assert!(row.iter().all(|x| x.abs() < 1e-12), "seed {seed}: {row:?}");
        }
        for g in weighted_gap(&o, &pair.slave, &pair.master, &pair.nodal_normals).iter() {
            assert!(g.abs() < 1e-15);
        }
    }
}

#[test]
fn linear_fields_are_mapped_exactly() {
    all_shapes().for_each(|[slave, master]| planar_patch(slave, master));
}

fn rigid(slave: &'static FacetShape, master: &'static FacetShape) {
    let shapes = [slave, master];
    let (angle, axis) = if slave.space == 2 { (0.8, [0.0, 0.0, 1.0]) } else { (1.1, normalised([0.3, -0.5, 0.7])) };
    let rotated = |x: [f64; 3]| {
        let (s, c) = f64::sin_cos(angle);
        add(add(scale(x, c), scale(cross(axis, x), s)), scale(axis, dot(axis, x) * (1.0 - c)))
    };
    let moved = |x: [f64; 3]| add(rotated(x), [3.0, -2.0, if slave.space == 2 { 0.0 } else { 5.0 }]);
    for seed in 0..20 {
        let before = random_pair(slave, master, seed);
        let after = PairGeometry {
            slave_shape: slave,
            master_shape: master,
            slave: before.slave.map(moved),
            master: before.master.map(moved),
            nodal_normals: before.nodal_normals.map(rotated),
            slave_normal: rotated(before.slave_normal),
            master_normal: rotated(before.master_normal),
            exact: None,
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
        let gap_a: Nodal<f64> = weighted_gap(&a, &before.slave, &before.master, &before.nodal_normals);
        let gap_b: Nodal<f64> = weighted_gap(&b, &after.slave, &after.master, &after.nodal_normals);
        gap_a.iter().zip(gap_b.iter()).for_each(|(x, y)| assert!((x - y).abs() < 1e-11));
    }
}

#[test]
fn rigid_motions_change_nothing() {
    all_shapes().for_each(|[slave, master]| rigid(slave, master));
}

fn permuted(slave: &'static FacetShape, master: &'static FacetShape) {
    let shapes = [slave, master];
    for seed in 0..20 {
        let a = random_pair(slave, master, seed);
        // Flat facets: on warped ones, and where cells differ, the rule is not exact and depends on the first vertex.
        let a = if slave.space == 2 { a } else { flattened(a) };
        let mut b = a;
        if slave.space > 2 {
            b.slave = slave.nodal(|n| a.slave[turned(slave, n, 1)]);
            b.nodal_normals = slave.nodal(|n| a.nodal_normals[turned(slave, n, 1)]);
            b.master = master.nodal(|n| a.master[turned(master, n, master.corners - 1)]);
        }
        let settings =
            SegmentationSettings { integration_order: IntegrationOrder::new(5).unwrap(), ..Default::default() };
        let (Overlap::Cells(x), Overlap::Cells(y)) = (operators(&a, &settings), operators(&b, &settings)) else {
            continue;
        };
        for j in 0..slave.nodes {
            for l in 0..master.nodes {
                let (pj, pl) = match slave.space {
                    2 => (j, l),
                    _ => (turned(slave, j, slave.corners - 1), turned(master, l, 1)),
                };
                let apart = (x.m[j][l] - y.m[pj][pl]).abs();
                assert!(apart < 1e-12, "{shapes:?} seed {seed}: {apart}");
            }
        }
    }
}

/// The node that takes the place of another when numbers begin that many corners later.
fn turned(shape: &FacetShape, n: usize, by: usize) -> usize {
    match n / shape.corners {
        ring @ 0..=1 => ring * shape.corners + (n + by) % shape.corners,
        _ => n,
    }
}

/// The same pair as parallelograms or triangles in two parallel planes.
fn flattened(mut pair: PairGeometry<f64>) -> PairGeometry<f64> {
    fn square(shape: &FacetShape, x: &mut [[f64; 3]]) {
        let corners = shape.corners;
        x.iter_mut().for_each(|x| x[2] = 0.0);
        if corners == 4 {
            x[3] = sub(add(x[0], x[2]), x[1]);
        }
        for n in corners..shape.nodes {
            x[n] = match n / corners {
                1 => scale(add(x[n - corners], x[(n + 1) % corners]), 0.5),
                _ => (0..corners).fold([0.0; 3], |sum, k| add(sum, scale(x[k], 1.0 / corners as f64))),
            };
        }
    }
    square(pair.slave_shape, &mut pair.slave);
    square(pair.master_shape, &mut pair.master);
    (pair.nodal_normals, pair.slave_normal) = (pair.slave.map(|_| [0.0, 0.0, 1.0]), [0.0, 0.0, 1.0]);
    pair.master_normal = [0.0, 0.0, -1.0];
    pair
}

#[test]
fn numbering_of_nodes_does_not_matter() {
    all_shapes().for_each(|[slave, master]| permuted(slave, master));
}

fn apart(slave: &'static FacetShape, master: &'static FacetShape) {
    let far = |dx: f64, dz: f64| {
        let up = if slave.space == 2 { [dx, dz, 0.0] } else { [dx, 0.0, dz] };
        pair([slave, master], unit_facet(slave), flipped(master, &unit_facet(master)).map(|x| add(x, up)))
    };
    let settings = SegmentationSettings { distance_threshold: 0.5, ..Default::default() };
    let meet = |dx: f64, dz: f64| !matches!(operators(&far(dx, dz), &settings), Overlap::None);
    assert!(!meet(3.0, 0.0));
    assert!(!meet(1.0, 0.0), "facets that touch at an edge");
    // On lines the threshold counts against the normal.
    let distance = if slave.space == 2 { -0.6 } else { 0.6 };
    assert!(!meet(0.0, distance), "beyond the threshold");
    assert!(meet(0.0, -distance), "the threshold is signed");
    assert!(meet(0.5, 0.0));
}

#[test]
fn nothing_where_facets_do_not_meet() {
    all_shapes().for_each(|[slave, master]| apart(slave, master));
}

fn degenerate(slave: &'static FacetShape, master: &'static FacetShape) {
    let shapes = [slave, master];
    // Coincident facets, a node on an edge, a common edge, all with and without noise at rounding level.
    for (dx, scale_by) in [(0.0, 1.0), (0.5, 1.0), (0.25, 0.5), (0.0, 0.5), (-0.5, 2.0), (1.0 - 1e-9, 1.0)] {
        for noise in [0.0, 1e-16, 1e-14, 1e-12, 1e-10] {
            let mut random = Noise::new(7);
            let other = flipped(master, &unit_facet(master))
                .map(|x| add(add(scale(x, scale_by), [dx, 0.0, 0.0]), random.vector(noise, slave.space)));
            let pair = pair([slave, master], unit_facet(slave), other);
            let settings = SegmentationSettings::default();
            let (plain, dual) = (operators(&pair, &settings), operators(&pair.seeded_from(0), &settings));
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
    all_shapes().for_each(|[slave, master]| degenerate(slave, master));
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
                quads += area(&pair([&QUADRILATERAL_4; 2], slave.into(), [a, b, c, d].into()));
                let shapes = [&QUADRILATERAL_4, &TRIANGLE_3];
                triangles += area(&pair(shapes, slave.into(), [a, b, c].into()))
                    + area(&pair(shapes, slave.into(), [a, c, d].into()));
            }
        }
        // A sliver below the least overlap may be missing.
        assert!((quads - whole).abs() < 1e-13 && (triangles - whole).abs() < 1e-13, "{n}: {quads} {triangles}");
    }
}

fn reference_values(slave: &'static FacetShape, master: &'static FacetShape) {
    let shapes = [slave, master];
    let mut found = 0;
    for line in include_str!("reference_pairs.txt").lines().filter(|line| !line.starts_with('#')) {
        let numbers: Vec<f64> = line.split(' ').map(|x| x.parse().unwrap()).collect();
        if slave.curved || master.curved || numbers[..2] != [slave.nodes as f64, master.nodes as f64] {
            continue;
        }
        let mut rest = &numbers[2..];
        let mut vector = || {
            let (head, tail) = rest.split_first_chunk::<3>().unwrap();
            rest = tail;
            *head
        };
        let pair = PairGeometry {
            slave_shape: slave,
            master_shape: master,
            slave: slave.nodal(|_| vector()),
            master: master.nodal(|_| vector()),
            nodal_normals: slave.nodal(|_| vector()),
            slave_normal: vector(),
            master_normal: vector(),
            exact: None,
            choices: Choices::default(),
        };
        let o = value_of(&pair);
        let gap = weighted_gap(&o, &pair.slave, &pair.master, &pair.nodal_normals);
        let scale = rest[..slave.nodes * slave.nodes].iter().fold(0.0, |a: f64, b| a.max(b.abs()));
        assert_eq!(rest.len(), slave.nodes * (slave.nodes + master.nodes + 1));
        for (entry, (x, reference)) in flat(&o).iter().chain(gap.iter()).zip(rest).enumerate() {
            assert!((x - reference).abs() < 1e-10 * scale, "{shapes:?} entry {entry}: {x} {reference}");
        }
        found += 1;
    }
    assert!(slave.curved || master.curved || found >= 2);
}

#[test]
fn values_of_the_reference_program() {
    all_shapes().for_each(|[slave, master]| reference_values(slave, master));
}

/// Cost of a quadrilateral pair; run with `--ignored --nocapture`.
#[test]
#[ignore = "a measurement"]
fn cost_of_operators() {
    fn measure(slave: &'static FacetShape, master: &'static FacetShape) {
        let shapes = [slave, master];
        let settings = SegmentationSettings::default();
        let pairs: Vec<_> = (0..50).map(|seed| random_pair(slave, master, seed)).collect();
        let time = |f: &dyn Fn(&PairGeometry<f64>) -> f64| {
            let start = std::time::Instant::now();
            let sum: f64 = (0..40).flat_map(|_| &pairs).map(f).sum();
            (start.elapsed().as_secs_f64() / 2000.0 * 1e6, sum)
        };
        let (plain, a) = time(&|p| operators(p, &settings).cells().map_or(0.0, |o| o.m[0][0]));
        let (dual, b) = time(&|p| operators(&p.seeded_from(0), &settings).cells().map_or(0.0, |o| o.m[0][0].value));
        assert!((a - b).abs() < 1e-9);
        println!("{shapes:?}: {plain:.2} µs plain, {dual:.2} µs dual, ratio {:.1}", dual / plain);
    }
    all_shapes().for_each(|[slave, master]| measure(slave, master));
}
