//! Facets that no mesh should have: without area, folded, needles, of any size and anywhere. Overlaps of them are finite, push both
//! sides alike and are no larger than the slave, or there is none.

use super::for_each_point;
use super::tests::{Noise, all_shapes};
use super::*;
use zelus_core::geometry::{FacetShape, Nodal};
use zelus_core::scalar::Real;
use zelus_core::vector3::{add, dot, norm, scale, sub};

/// Pairs of each two shapes.
const COUNT: u64 = 3000;
/// Relative difference of numbers that are the same.
const ROUND_OFF: f64 = 1e-7;
/// Largest round-off of a balance, by the size of the operators: the loss of dual functions at their worst condition.
const BALANCE: f64 = 1e-4;

/// A facet about the unit one with mistakes in it.
fn mistaken(shape: &FacetShape, noise: &mut Noise, flip: bool) -> Nodal<[f64; 3]> {
    let (count, space) = (shape.nodes, shape.space);
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let at = |n: usize| if flip { count - 1 - n } else { n };
    let place = |n: usize| if space == 2 { [1.0 - n as f64, 0.0, 0.0] } else { corners[n] };
    let size = [0.0, 1e-15, 1e-9, 0.05, 0.3][pick(noise, 5)];
    let mut nodes = shape.nodal(|n| {
        let shift = std::array::from_fn(|c| if c < space { size * noise.next() } else { 0.0 });
        add(place(at(n)), shift)
    });
    let (one, other) = (pick(noise, count), pick(noise, count));
    match pick(noise, 7) {
        0 => nodes[one] = nodes[other],
        1 => (nodes[one], nodes[other]) = (nodes[other], nodes[one]),
        2 => nodes[one] = scale(add(nodes[other], nodes[(other + 1) % count]), 0.5),
        3 => {
            let thin = [0.0, 1e-300, 1e-14, 1e-7][pick(noise, 4)];
            (0..count).for_each(|n| nodes[n][space - 2] *= thin);
        }
        _ => {}
    }
    nodes
}

fn pick(noise: &mut Noise, count: usize) -> usize {
    (((noise.next() + 1.0) * 0.5 * count as f64) as usize).min(count - 1)
}

/// Whether a facet turns the other way round, or not at all, at a corner.
fn is_folded(shape: &FacetShape, nodes: &[[f64; 3]]) -> bool {
    let normal = shape.area_normal(nodes, shape.centre);
    let edge = (0..shape.nodes).map(|n| norm(sub(nodes[n], nodes[(n + 1) % shape.nodes]))).fold(0.0, f64::max);
    let corners: [[f64; 2]; 4] = match shape.nodes {
        2 => return norm(normal) == 0.0,
        _ if norm(normal) <= 1e-7 * edge * edge => return true,
        3 => [[0.0; 2]; 4],
        _ => [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]],
    };
    let along = |corner: [f64; 2]| dot(shape.area_normal(nodes, corner), normal);
    corners.iter().any(|&corner| along(corner).is_nan() || along(corner) <= 1e-6 * dot(normal, normal))
}

fn unit(vector: [f64; 3], instead: [f64; 3]) -> [f64; 3] {
    let length = norm(vector);
    if length > 0.0 { scale(vector, 1.0 / length) } else { instead }
}

fn pair(slave_shape: &'static FacetShape, master_shape: &'static FacetShape, seed: u64) -> PairGeometry<f64> {
    let mut noise = Noise::new(seed);
    let space = slave_shape.space;
    let size = [1e-6, 1e-3, 1.0, 1.0, 1e3, 1e6][pick(&mut noise, 6)];
    let moved = if pick(&mut noise, 2) == 0 { 0.0 } else { 0.7 };
    let shift: [f64; 3] = std::array::from_fn(|c| if c < space { moved * noise.next() } else { 0.0 });
    let slave = mistaken(slave_shape, &mut noise, false).map(|x| scale(x, size));
    let master = mistaken(master_shape, &mut noise, true).map(|x| scale(add(x, shift), size));
    let up = if space == 2 { [0.0, 1.0, 0.0] } else { [0.0, 0.0, 1.0] };
    let slave_normal = unit(slave_shape.unit_normal(&slave, slave_shape.centre), up);
    let master_normal = unit(master_shape.unit_normal(&master, master_shape.centre), scale(up, -1.0));
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

fn holds(slave: &'static FacetShape, master: &'static FacetShape) {
    if slave.curved || master.curved {
        return; // the degenerate facets here have edges without curvature
    }
    let shapes = [slave, master];
    let settings = SegmentationSettings::default();
    let mut met = 0;
    for seed in 0..COUNT {
        let pair = pair(slave, master, seed);
        if pair.slave_normal.iter().chain(&pair.master_normal).any(|x| !x.is_finite()) {
            continue;
        }
        let mut covered = 0.0;
        let all = for_each_point(&pair, &settings, &mut |point| {
            covered += point.weight;
            let sum: f64 = point.slave.iter().sum();
            let is_one = (sum - 1.0).abs() < ROUND_OFF || is_folded(slave, &pair.slave);
            assert!(is_one, "{shapes:?} {seed}: shape functions of the slave add up to {sum}\n{pair:?}");
        });
        assert!(
            (all.is_finite() && covered.is_finite())
                || is_folded(slave, &pair.slave)
                || is_folded(master, &pair.master),
            "{shapes:?} {seed}: an overlap of {all}"
        );
        let Overlap::Cells(found) = operators(&pair, &settings) else { continue };
        met += 1;
        let numbers = found.d.iter().flat_map(|row| row.iter()).chain(found.m.iter().flat_map(|row| row.iter()));
        let largest = numbers.fold(0.0_f64, |most, x| most.max(x.abs()) + 0.0 * x);
        // Slivers on facets without area have no place on a master without area.
        if is_folded(slave, &pair.slave) && is_folded(master, &pair.master) {
            continue;
        }
        assert!(largest.is_finite(), "{shapes:?} {seed}: {found:?}\n{pair:?}");
        // Points go far on a master that is seen from its edge; the search leaves such pairs out.
        let faces = dot(pair.slave_normal, pair.master_normal) < -0.05;
        for node in
            (0..slave.nodes).filter(|_| faces && !is_folded(slave, &pair.slave) && !is_folded(master, &pair.master))
        {
            let (own, other): (f64, f64) = (found.d[node].iter().sum(), found.m[node].iter().sum());
            assert!((own - other).abs() <= BALANCE * largest, "{shapes:?} {seed}: pushes {own} and {other}\n{pair:?}");
        }
        let Overlap::Cells(dual) = operators(&pair.seeded_from(0), &settings) else {
            panic!("{shapes:?} {seed}: derivatives decide otherwise");
        };
        let same = |x: &Active, y: &f64| (x.value() - y).abs() <= ROUND_OFF * largest;
        assert!(
            dual.d
                .iter()
                .flat_map(|row| row.iter())
                .zip(found.d.iter().flat_map(|row| row.iter()))
                .all(|(x, y)| same(x, y)),
            "{shapes:?} {seed}"
        );
    }
    assert!(met > COUNT / 20, "{shapes:?}: {met} overlaps, too few to say anything");
}

#[test]
fn overlaps_of_degenerate_facets_are_finite_and_balanced() {
    all_shapes().for_each(|[slave, master]| holds(slave, master));
}

fn projections(slave: &'static FacetShape, master: &'static FacetShape) {
    if slave.curved || master.curved {
        return;
    }
    for seed in 0..COUNT {
        let pair = pair(slave, master, seed);
        let area = master.measure(&pair.master);
        let local = master.closest_point(&pair.master, pair.slave[0], master.centre);
        if local.iter().all(|x| x.is_finite()) {
            let place = zelus_core::geometry::interpolate(&master.values(local), &pair.master);
            assert!(place.iter().all(|x| x.is_finite()), "{:?} {seed}: {local:?} is at {place:?}", master);
        } else {
            assert!(
                is_folded(master, &pair.master),
                "{:?} {seed}: no place on an area of {area}: {:?}",
                master,
                pair.master
            );
        }
    }
}

#[test]
fn projections_on_degenerate_facets_are_somewhere_or_said_to_be_nowhere() {
    all_shapes().for_each(|[slave, master]| projections(slave, master));
}
