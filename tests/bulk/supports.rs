//! Supports along directions: rollers, symmetry planes, cylindrical and spherical supports.

use serde_json::{Value, json};
use zelus_core::geometry::Shape;

use super::deck::{Deck, Ran, assert_close};
use super::grid::{Grid, Vec3};

const FREE: Value = Value::Null;
const SUPPORT: &str = "assign_displacement_along_direction_process";

/// A rotation by 0.5 about z, in space by 0.7 about x after it.
fn turned(dim: usize, [x, y, z]: Vec3) -> Vec3 {
    let ((s, c), (t, d)) = (0.5_f64.sin_cos(), 0.7_f64.sin_cos());
    let [x, y] = [c * x - s * y, s * x + c * y];
    if dim == 2 { [x, y, z] } else { [x, d * y - t * z, t * y + d * z] }
}

/// Largest difference of two fields over the largest of the second.
fn difference(found: &[Vec3], expected: &[Vec3]) -> f64 {
    let size = expected.iter().flatten().fold(0.0_f64, |most, value| most.max(value.abs()));
    let off = found.iter().zip(expected).flat_map(|(a, b)| (0..3).map(|c| (a[c] - b[c]).abs()));
    off.fold(0.0, f64::max) / size
}

/// The part with nodes of a grid, for processes.
fn name(deck: &mut Deck<'_>, wanted: impl Fn(Vec3) -> bool) -> String {
    format!("Structure.{}", deck.nodes(wanted))
}

fn support(deck: &mut Deck<'_>, wanted: impl Fn(Vec3) -> bool, mut settings: Value) {
    settings["model_part_name"] = json!(name(deck, wanted));
    deck.process(SUPPORT, settings);
}

/// The supports of a block: planes through its corner, a prescribed motion of its far side, and a shear on another.
struct Block {
    element: &'static str,
    shape: Shape,
    /// End of the support of the second plane.
    until: f64,
    dynamic: bool,
}

impl Block {
    fn run(&self, is_turned: bool) -> (Grid, Ran) {
        let dim = self.shape.dim();
        let turn = |x: Vec3| if is_turned { turned(dim, x) } else { x };
        let grid = Grid::new(self.shape, &[3, 2, 2][..dim], |p| turn([2.0 * p[0], p[1], 1.5 * p[2]]));
        let (law, kind, load) = match dim {
            2 => ("LinearElasticPlaneStrain2DLaw", "LineLoadCondition", "LINE_LOAD"),
            _ => ("LinearElastic3DLaw", "SurfaceLoadCondition", "SURFACE_LOAD"),
        };
        let material = json!({"YOUNG_MODULUS": 100.0, "POISSON_RATIO": 0.3, "DENSITY": 2.0});
        let ran = {
            let mut deck = Deck::new(&grid, self.element, law, material);
            deck.steps(0.25, 1.0).set("residual_relative_tolerance", json!(1e-13));
            if self.dynamic {
                deck.set("solver_type", json!("Dynamic")).set("scheme_type", json!("bossak"));
                deck.set("time_integration_method", json!("implicit"));
            }
            let unit = |c: usize| turn(std::array::from_fn(|d| f64::from(u8::from(c == d))));
            for axis in 0..dim {
                let interval = if axis == 1 { json!([0.0, self.until]) } else { json!([0.0, "End"]) };
                if is_turned {
                    // The second plane by the normal of its faces.
                    let direction = if axis == 1 { json!("surface_normal") } else { json!(unit(axis)) };
                    support(&mut deck, |p| p[axis] == 0.0, json!({"direction": direction, "interval": interval}));
                } else {
                    let value: [Value; 3] = std::array::from_fn(|c| if c == axis { json!(0.0) } else { FREE });
                    let part = name(&mut deck, |p| p[axis] == 0.0);
                    let fixed: Vec<bool> = value.iter().map(|value| !value.is_null()).collect();
                    let settings = json!({"model_part_name": part, "variable_name": "DISPLACEMENT",
                        "constrained": fixed, "value": value, "interval": interval});
                    deck.process("assign_vector_variable_process", settings);
                }
            }
            let value = json!("0.05*t");
            support(&mut deck, |p| p[0] == 1.0, json!({"direction": unit(0), "value": value}));
            let force = turn([0.4, 1.0, if dim == 3 { 0.7 } else { 0.0 }]);
            deck.vector_load(|p| p[1] == 1.0, kind, load, force.map(|f| json!(format!("{f:?}*t"))));
            deck.run()
        };
        (grid, ran)
    }

    /// The turned block against the one along the axes: displacements, reactions and their balance.
    fn compare(&self) {
        let dim = self.shape.dim();
        let ((grid, straight), (_, oblique)) = (self.run(false), self.run(true));
        let step = straight.times().len() - 1;
        for of in [0, step / 2, step] {
            for name in ["DISPLACEMENT", "REACTION"] {
                let nodes = 0..grid.nodes.len();
                let expected: Vec<Vec3> = nodes.clone().map(|n| turned(dim, straight.vector(name, n, of))).collect();
                let found: Vec<Vec3> = nodes.map(|n| oblique.vector(name, n, of)).collect();
                let off = difference(&found, &expected);
                println!("{} {:?} {name} step {of}: {off:.1e}", self.element, self.shape);
                // A free motion of dynamics sums up the remainders of Newton's iteration.
                let most = if self.until < 1.0 { 1e-11 } else { 1e-12 };
                assert!(off < most, "{} {:?} {name} step {of}: off by {off:.2e}", self.element, self.shape);
            }
        }
        let balances = [&straight, &oblique].map(|ran| {
            let last = ran.report.steps.last().and_then(|step| step.balance.clone());
            last.expect("a balance").unknowns[0].clone()
        });
        let [plain, own] = &balances;
        let reactions = turned(dim, plain.forces.reactions);
        assert!(difference(&[own.forces.reactions], &[reactions]) < 1e-11, "{:?} {reactions:?}", own.forces);
        assert!(own.forces.relative < 1e-11, "{:?}", own.forces);
        assert!(own.moments.as_ref().is_some_and(|moments| moments.relative < 1e-10), "{:?}", own.moments);
    }
}

/// ANALYTIC: a turned model has the turned answer: planes that meet on edges and in a corner, a support that is released, one that
/// moves; small and large displacements, statics and dynamics.
#[test]
fn turned_blocks_have_turned_answers() {
    for (element, shape) in [
        ("SmallDisplacementElement", Shape::Quad4),
        ("SmallDisplacementElement", Shape::Hex8),
        ("SmallDisplacementElement", Shape::Tet10),
        ("TotalLagrangianElement", Shape::Hex8),
    ] {
        Block { element, shape, until: 1e30, dynamic: false }.compare();
    }
    Block { element: "SmallDisplacementElement", shape: Shape::Hex8, until: 1e30, dynamic: true }.compare();
    // Without the second plane the block is held by the others alone in dynamics.
    Block { element: "TotalLagrangianElement", shape: Shape::Quad4, until: 0.6, dynamic: true }.compare();
}

/// ANALYTIC (Lamé): a sector of a thick cylinder in plane strain between planes that only slide radially. With a free outer surface
/// u = (1+ν)/E p a²/(b²−a²) ((1−2ν) r + b²/r). With a cylindrical support there u = A (r − b²/r) and σ_r(a) = −p.
#[test]
fn thick_cylinder_between_tangential_supports() {
    let (a, b, pressure, young, nu) = (1.0, 2.0, 3.0, 1e6, 0.3);
    for is_held in [false, true] {
        let grid = Grid::new(Shape::Quad9, &[8, 8], |p| {
            let (r, angle) = (a + (b - a) * p[0], 0.2 + p[1]);
            [4.0 + r * angle.cos(), -1.0 + r * angle.sin(), 0.0]
        });
        let material = json!({"YOUNG_MODULUS": young, "POISSON_RATIO": nu});
        let mut deck = Deck::new(&grid, "SmallDisplacementElement", "LinearElasticPlaneStrain2DLaw", material);
        let origin = json!([4.0, -1.0, 0.0]);
        let around = json!({"direction": "tangential", "origin": origin});
        support(&mut deck, |p| p[1] == 0.0 || p[1] == 1.0, around);
        if is_held {
            support(&mut deck, |p| p[0] == 1.0, json!({"direction": "radial", "origin": origin}));
        }
        // The edge from the first to the last angle has the body on its right.
        let value = json!(pressure);
        deck.scalar_load(|p| p[0] == 0.0, "LineLoadCondition", "NEGATIVE_FACE_PRESSURE", value);
        let ran = deck.run();
        let (lambda, shear) = (young * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), young / (2.0 * (1.0 + nu)));
        let exact = |r: f64| {
            if is_held {
                // σ_r = 2 (λ+G) A + 2 G A b²/r² = −p at a.
                let factor = -pressure / (2.0 * (lambda + shear) + 2.0 * shear * b * b / (a * a));
                factor * (r - b * b / r)
            } else {
                let factor = (1.0 + nu) / young * pressure * a * a / (b * b - a * a);
                factor * ((1.0 - 2.0 * nu) * r + b * b / r)
            }
        };
        let nodes = 0..grid.nodes.len();
        let field = |n: usize| {
            let (x, y) = (grid.nodes[n][0] - 4.0, grid.nodes[n][1] + 1.0);
            let r = x.hypot(y);
            [exact(r) * x / r, exact(r) * y / r, 0.0]
        };
        let expected: Vec<Vec3> = nodes.map(field).collect();
        let off = difference(&ran.displacements(&grid), &expected);
        println!("cylinder, outer surface {}: {off:.1e}", if is_held { "held" } else { "free" });
        assert!(off < 1e-4, "{is_held}: off by {off:.2e}");
    }
}

/// ANALYTIC (Lamé): a sector of a hollow sphere between four planes through its centre, whose outer surface is moved by −δ along
/// its radius: u = A r + B/r² with u(b) = −δ and no pressure inside.
#[test]
fn hollow_sphere_in_a_spherical_support() {
    let (a, b, delta, young, nu) = (1.0, 2.0, 1e-3, 1e3, 0.3);
    let centre = [0.3, -0.2, 0.1];
    let grid = Grid::new(Shape::Hex20, &[4, 4, 4], |p| {
        let way = [1.0, 0.4 * p[0] - 0.1, 0.5 * p[1] - 0.2];
        let length = way.iter().map(|x| x * x).sum::<f64>().sqrt();
        let r = a + (b - a) * p[2];
        std::array::from_fn(|c| centre[c] + r * way[c] / length)
    });
    let material = json!({"YOUNG_MODULUS": young, "POISSON_RATIO": nu});
    let mut deck = Deck::new(&grid, "SmallDisplacementElement", "LinearElastic3DLaw", material);
    for (axis, end) in [(0, 0.0), (0, 1.0), (1, 0.0), (1, 1.0)] {
        support(&mut deck, |p| p[axis] == end, json!({"direction": "surface_normal"}));
    }
    support(&mut deck, |p| p[2] == 1.0, json!({"direction": "spherical", "origin": centre, "value": -delta}));
    let ran = deck.run();
    // σ_r = (3 λ + 2 G) A − 4 G B/r³ = 0 at a.
    let (lambda, shear) = (young * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), young / (2.0 * (1.0 + nu)));
    let ratio = (3.0 * lambda + 2.0 * shear) * a * a * a / (4.0 * shear);
    let factor = -delta / (b + ratio / (b * b));
    let field = |n: usize| {
        let arm: Vec3 = std::array::from_fn(|c| grid.nodes[n][c] - centre[c]);
        let r = arm.iter().map(|x| x * x).sum::<f64>().sqrt();
        arm.map(|x| factor * (r + ratio / (r * r)) * x / r)
    };
    let expected: Vec<Vec3> = (0..grid.nodes.len()).map(field).collect();
    let off = difference(&ran.displacements(&grid), &expected);
    println!("sphere: {off:.1e}");
    assert!(off < 1e-3, "off by {off:.2e}");
    // Pressure on the support: σ_r(b) over the outer area, to the centre.
    let outer = grid.nodes_where(|p| p[2] == 1.0);
    let inward: f64 = outer
        .iter()
        .map(|&n| {
            let (r, f) = (grid.nodes[n], ran.last("REACTION", n));
            (0..3).map(|c| f[c] * (r[c] - centre[c]) / b).sum::<f64>()
        })
        .sum();
    let stress = (3.0 * lambda + 2.0 * shear) * factor - 4.0 * shear * factor * ratio / b.powi(3);
    // Solid angle of the sector: four corners of atan(y z / √(1 + y² + z²)).
    let corner = |y: f64, z: f64| (y * z / (1.0 + y * y + z * z).sqrt()).atan();
    let angle = corner(0.3, 0.3) - corner(-0.1, 0.3) - corner(0.3, -0.2) + corner(-0.1, -0.2);
    // Edge nodes also carry forces of the side planes, at right angles to the radius.
    assert_close(inward, stress * angle * b * b, 2e-3, "pressure on the support");
}

/// ANALYTIC: a tilted bar drawn along its axis by an axial support: u = ε x along it, contraction across it by supports along the
/// radius of its axis, which stay consistent where they meet.
#[test]
fn axial_support_draws_a_bar() {
    let axis = turned(3, [0.0, 0.0, 1.0]);
    let grid = Grid::new(Shape::Hex8, &[2, 2, 3], |p| turned(3, [p[0] - 0.5, p[1] - 0.5, 4.0 * p[2]]));
    let material = json!({"YOUNG_MODULUS": 100.0, "POISSON_RATIO": 0.25});
    let mut deck = Deck::new(&grid, "SmallDisplacementElement", "LinearElastic3DLaw", material);
    let along = |value: f64| json!({"direction": "axial", "axis": axis.map(|a| 3.0 * a), "value": value});
    support(&mut deck, |p| p[2] == 0.0, along(0.0));
    support(&mut deck, |p| p[2] == 1.0, along(0.04));
    // The middle of the ends stays on the axis, and one side keeps its direction.
    for c in [0, 1] {
        let direction = turned(3, std::array::from_fn(|d| f64::from(u8::from(c == d))));
        support(&mut deck, |p| p[0] == 0.5 && p[1] == 0.5, json!({"direction": direction}));
    }
    let tangential = json!({"direction": "tangential", "axis": axis});
    support(&mut deck, |p| p[0] == 1.0 && p[1] == 0.5, tangential);
    let ran = deck.run();
    let field = |n: usize| {
        let p = grid.reference[n];
        turned(3, [-0.25 * 0.01 * (p[0] - 0.5), -0.25 * 0.01 * (p[1] - 0.5), 0.04 * p[2]])
    };
    let expected: Vec<Vec3> = (0..grid.nodes.len()).map(field).collect();
    let off = difference(&ran.displacements(&grid), &expected);
    assert!(off < 1e-12, "off by {off:.2e}");
    let force = ran.reaction(&grid.nodes_where(|p| p[2] == 1.0), 0);
    let pull: f64 = (0..3).map(|c| force[c] * axis[c]).sum();
    assert_close(pull, 100.0 * 0.01, 1e-12, "force of the bar");
}

/// Bad directions and supports that contradict are named with the node, before the run.
#[test]
fn mistakes_are_named() {
    let grid = Grid::new(Shape::Quad4, &[2, 2], |p| p);
    let run = |supports: &[(fn(Vec3) -> bool, Value)]| {
        let material = json!({"YOUNG_MODULUS": 1.0, "POISSON_RATIO": 0.3});
        let mut deck = Deck::new(&grid, "SmallDisplacementElement", "LinearElasticPlaneStrain2DLaw", material);
        supports.iter().for_each(|(wanted, settings)| support(&mut deck, wanted, settings.clone()));
        deck.problem()
    };
    let left: fn(Vec3) -> bool = |p| p[0] == 0.0;
    let low: fn(Vec3) -> bool = |p| p[1] == 0.0;
    let all: fn(Vec3) -> bool = |_| true;
    let slope = json!({"direction": [0.6, 0.8, 0.0]});
    let cases: [(Vec<(fn(Vec3) -> bool, Value)>, &str, &str); 8] = [
        (vec![(left, json!({}))], "missing-key", "direction"),
        (vec![(left, json!({"direction": "upwards"}))], "invalid-direction", "a word"),
        (vec![(left, json!({"direction": [0.0, 0.0, 1.0]}))], "invalid-direction", "no length"),
        (vec![(left, json!({"direction": "axial"}))], "invalid-direction", "along the axis z"),
        (vec![(left, json!({"direction": "radial"}))], "invalid-direction", "node 1"),
        (vec![(all, json!({"direction": "surface_normal"}))], "invalid-direction", "no face"),
        (
            vec![(left, slope.clone()), (left, json!({"direction": [-0.6, -0.8, 0.0], "value": 0.1}))],
            "contradicting-supports",
            "(-0.6",
        ),
        (
            vec![
                (left, json!({"direction": [1.0, 0.0, 0.0]})),
                (left, json!({"direction": [0.0, 2.0, 0.0]})),
                (low, json!({"direction": [0.6, 0.8, 0.0], "value": 1e-3})),
            ],
            "contradicting-supports",
            "node 1",
        ),
    ];
    for (supports, code, fact) in cases {
        let said = run(&supports);
        assert!(said.contains(code) && said.contains(fact), "{code} {fact}: {said}");
    }
}

/// ANALYTIC: a block on springs to the ground under its own forces: u = F/(n k).
#[test]
fn ground_springs_hold_a_free_body() {
    let grid = Grid::new(Shape::Hex8, &[2, 2, 2], |p| p);
    let material = json!({"YOUNG_MODULUS": 1e3, "POISSON_RATIO": 0.3});
    let mut deck = Deck::new(&grid, "SmallDisplacementElement", "LinearElastic3DLaw", material);
    let part = name(&mut deck, |_| true);
    deck.process("assign_ground_springs_process", json!({"model_part_name": part, "stiffness": [1.0, 2.0, 4.0]}));
    let load = json!({"model_part_name": part, "load": [0.27, 0.27, -0.27]});
    deck.process("distribute_load_on_surface_process", load);
    let ran = deck.run();
    for u in ran.displacements(&grid) {
        (0..3).for_each(|c| assert_close(u[c], [0.01, 0.005, -0.0025][c], 1e-9, "spring"));
    }
    let last = ran.report.steps.last().and_then(|step| step.balance.clone()).expect("a balance");
    let forces = &last.unknowns[0].forces;
    (0..3).for_each(|c| assert_close(forces.elements[c], -forces.loads[c], 1e-9, "balance"));
    for (stiffness, code) in [(json!([1.0, -1.0, 0.0]), "out-of-range"), (json!([0.0, 0.0, 0.0]), "out-of-range")] {
        let mut deck = Deck::new(
            &grid,
            "SmallDisplacementElement",
            "LinearElastic3DLaw",
            json!({"YOUNG_MODULUS": 1.0, "POISSON_RATIO": 0.3}),
        );
        let part = name(&mut deck, |_| true);
        deck.process("assign_ground_springs_process", json!({"model_part_name": part, "stiffness": stiffness}));
        let said = deck.problem();
        assert!(said.contains(code), "{said}");
    }
}
