use zelus_core::entities::find_kind;
use zelus_core::geometry::{Shape, mapping};
use zelus_core::model::{EntityRole, Variable};

use crate::test_model::{Random, Single, Vec3, near, reference_cell, size, weighted};
use crate::variables::*;

fn condition(name: &str, x: &[Vec3]) -> Single {
    Single::new(EntityRole::Condition, name, None, &[("THICKNESS", 0.5)], x)
}

fn set(single: &mut Single, variable: &Variable<f64>, value: f64) {
    single.part.conditions.data.values_mut(variable, 0)[0] = value;
}

fn set_vector(single: &mut Single, variable: &Variable<Vec3>, value: Vec3) {
    single.part.conditions.data.values_mut(variable, 0).copy_from_slice(&value);
}

const LINES: [(&str, usize); 2] = [("LineLoadCondition2D2N", 2), ("LineLoadCondition2D3N", 3)];
const RINGS: [(&str, usize); 2] = [("AxisymLineLoadCondition2D2N", 2), ("AxisymLineLoadCondition2D3N", 3)];
const SURFACES: [(&str, usize); 5] = [
    ("SurfaceLoadCondition3D3N", 3),
    ("SurfaceLoadCondition3D4N", 4),
    ("SurfaceLoadCondition3D6N", 6),
    ("SurfaceLoadCondition3D8N", 8),
    ("SurfaceLoadCondition3D9N", 9),
];

#[test]
fn follower_tangents_match_differences() {
    let mut random = Random(21);
    let cases = LINES.iter().chain(&RINGS).map(|c| (c, 1, 2)).chain(SURFACES.iter().map(|c| (c, 2, 3)));
    for ((name, nodes), dim, space) in cases {
        let x = random.cell(Shape::of(dim, *nodes).unwrap(), 0.1, space);
        let u: Vec<Vec3> = x.iter().map(|_| random.vector(0.2, space)).collect();
        let mut single = condition(name, &x);
        set(&mut single, &POSITIVE_FACE_PRESSURE, 1.5);
        let nodal = single.part.nodes.history.values_mut(&NEGATIVE_FACE_PRESSURE, 0);
        nodal.iter_mut().for_each(|p| *p = random.next());
        single.displace(&u);
        let (k, _) = single.system();
        let differences = single.difference_tangent(&u, space, true);
        let error = k.iter().zip(&differences).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
        assert!(error < 1e-9 * size(&k), "{name}: {error:e}");
    }
}

#[test]
fn the_stretch_of_loaded_areas_enters_from_the_second_iteration_on() {
    let mut random = Random(24);
    let cases = LINES.iter().chain(&RINGS).map(|c| (c, 1, 2)).chain(SURFACES.iter().map(|c| (c, 2, 3)));
    for ((name, nodes), dim, space) in cases {
        let x = random.cell(Shape::of(dim, *nodes).unwrap(), 0.1, space);
        let u: Vec<Vec3> = x.iter().map(|_| random.vector(0.2, space)).collect();
        let mut single = condition(name, &x);
        set_vector(&mut single, if dim == 1 { &LINE_LOAD } else { &SURFACE_LOAD }, [1.0, -2.0, 0.5]);
        single.displace(&u);
        assert_eq!(size(&single.system().0), 0.0, "{name}: without iterations the load stays where it was");
        single.part.info.nl_iteration = 2;
        let (k, _) = single.system();
        let differences = single.difference_tangent(&u, space, true);
        let error = k.iter().zip(&differences).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
        assert!(error < 1e-9 * size(&k) && size(&k) > 0.1, "{name}: {error:e}");
    }
}

#[test]
fn pressure_pushes_as_documented() {
    let mut line = condition("LineLoadCondition2D2N", &[[0.0, 0.0, 0.0], [2.0, 0.0, 0.0]]);
    set(&mut line, &NEGATIVE_FACE_PRESSURE, 3.0);
    assert_eq!(line.residual().map_near(&[0.0, 3.0, 0.0, 3.0]), None);
    let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let mut surface = condition("SurfaceLoadCondition3D4N", &square);
    set(&mut surface, &NEGATIVE_FACE_PRESSURE, 4.0);
    let up = [0.0, 0.0, 1.0];
    assert_eq!(surface.residual().map_near(&[up, up, up, up].concat()), None);
    set(&mut surface, &POSITIVE_FACE_PRESSURE, 4.0);
    assert_eq!(size(&surface.residual()), 0.0);
    set(&mut surface, &PRESSURE, 4.0);
    assert_eq!(surface.residual().map_near(&[up, up, up, up].concat()), None);
}

#[test]
fn loads_add_up_over_the_present_geometry() {
    let mut random = Random(22);
    let cases = LINES.iter().map(|c| (c, 1, 2)).chain(SURFACES.iter().map(|c| (c, 2, 3)));
    for ((name, nodes), dim, space) in cases {
        let shape = Shape::of(dim, *nodes).unwrap();
        let x = random.cell(shape, 0.0, space);
        let variable = if dim == 1 { &LINE_LOAD } else { &SURFACE_LOAD };
        let mut single = condition(name, &x);
        single.displace(&x);
        set_vector(&mut single, variable, [1.0, 2.0, 0.0]);
        single.set_nodal(variable, &vec![[0.5, 0.0, 0.0]; *nodes]);
        let rhs = single.residual();
        let size = mapping::domain_size(shape, &single.part.nodes.current);
        let sum: f64 = rhs.iter().step_by(space).sum();
        assert!(near(sum, 1.5 * size, 1e-12), "{name} {sum} {size}");
    }
}

#[test]
fn pressure_on_a_closed_body_balances() {
    let x = Random(23).cell(Shape::Hex8, 0.1, 3);
    let mut total = [0.0; 3];
    for face in Shape::Hex8.cell().faces {
        let nodes: Vec<Vec3> = face.nodes.iter().map(|&i| x[i]).collect();
        let mut single = condition("SurfaceLoadCondition3D4N", &nodes);
        set(&mut single, &PRESSURE, 2.0);
        single.residual().chunks(3).for_each(|f| (0..3).for_each(|a| total[a] += f[a]));
    }
    assert!(size(&total) < 1e-13);
}

/// All loads at once, on the cells of the element references.
#[test]
fn forces_agree_with_the_reference_program() {
    let mut found = 0;
    for line in include_str!("reference_loads.txt").lines().filter(|line| !line.starts_with('#')) {
        let (name, expected) = line.split_once(' ').unwrap();
        let expected: f64 = expected.parse().unwrap();
        let entry = find_kind(EntityRole::Condition, name).unwrap();
        let shape = entry.cell.unwrap();
        let (x, u) = reference_cell(shape, entry.space);
        let mut single = condition(name, &x);
        single.displace(&u);
        let vector = if shape.dim() == 1 { &LINE_LOAD } else { &SURFACE_LOAD };
        set_vector(&mut single, vector, [1.0, 2.0, 3.0]);
        for (variable, value) in [(&POSITIVE_FACE_PRESSURE, 1.5), (&NEGATIVE_FACE_PRESSURE, 0.7), (&PRESSURE, 0.4)] {
            set(&mut single, variable, value);
        }
        let loads: Vec<Vec3> = (0..x.len()).map(|i| [0.2 * i as f64, 0.1, -0.3 * i as f64]).collect();
        single.set_nodal(vector, &loads);
        let history = &mut single.part.nodes.history;
        for (i, p) in history.values_mut(&NEGATIVE_FACE_PRESSURE, 0).iter_mut().enumerate() {
            *p = 0.3 * i as f64;
        }
        for (i, p) in history.values_mut(&POSITIVE_FACE_PRESSURE, 0).iter_mut().enumerate() {
            *p = 0.1 * (i * i) as f64;
        }
        let rhs = single.residual();
        let value = weighted(&rhs);
        assert!(near(value, expected, 1e-12 * size(&rhs) * rhs.len() as f64), "{name}: {value} {expected}");
        found += 1;
    }
    assert_eq!(found, 11);
}

#[test]
fn point_loads_and_rings() {
    let mut point = condition("PointLoadCondition3D1N", &[[1.0, 2.0, 3.0]]);
    set_vector(&mut point, &POINT_LOAD, [1.0, 0.0, 2.0]);
    point.set_nodal(&POINT_LOAD, &[[0.0, 5.0, 0.0]]);
    assert_eq!(point.residual(), [1.0, 5.0, 2.0]);
    let mut ring = condition("AxisymPointLoadCondition2D1N", &[[2.0, 0.0, 0.0]]);
    set_vector(&mut ring, &POINT_LOAD, [1.0, 0.0, 0.0]);
    assert!(near(ring.residual()[0], 8.0 * std::f64::consts::PI, 1e-13));
}

#[test]
fn bare_boundaries_bring_nothing() {
    let single = condition("LineCondition2D2N", &[[0.0; 3], [1.0, 0.0, 0.0]]);
    assert!(single.block().unknowns().is_empty() && single.residual().is_empty());
}

trait MapNear {
    /// The first entry that differs, for a message.
    fn map_near(&self, expected: &[f64]) -> Option<(usize, f64, f64)>;
}

impl MapNear for Vec<f64> {
    fn map_near(&self, expected: &[f64]) -> Option<(usize, f64, f64)> {
        assert_eq!(self.len(), expected.len());
        let mut pairs = self.iter().zip(expected).enumerate();
        pairs.find(|(_, (a, b))| !near(**a, **b, 1e-14)).map(|(i, (a, b))| (i, *a, *b))
    }
}
