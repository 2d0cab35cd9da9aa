//! Loads that are given by their resultants: a force, a remote force, a moment.

use serde_json::{Value, json};
use zelus_core::geometry::Shape;
use zelus_core::vector3::{add, cross, sub};

use super::deck::{Deck, Ran, assert_close};
use super::grid::{Grid, Vec3};

const FREE: Value = Value::Null;
const FORCE: &str = "distribute_load_on_surface_process";
const RESULTANT: &str = "distribute_resultant_on_part_process";

fn zero() -> Value {
    json!(0.0)
}

fn loads(ran: &Ran) -> [Vec3; 3] {
    let last = ran.report.steps.last().and_then(|step| step.balance.clone());
    let own = &last.expect("a balance").unknowns[0];
    [own.forces.loads, own.moments.as_ref().expect("moments").loads, own.centre]
}

fn assert_vector(found: Vec3, expected: Vec3, size: f64, what: &str) {
    let off = (0..3).map(|c| (found[c] - expected[c]).abs()).fold(0.0, f64::max) / size;
    println!("{what}: {off:.1e}");
    assert!(off < 1e-12, "{what}: {found:?} instead of {expected:?}, off by {off:.2e}");
}

/// ANALYTIC: the load sums of the report are the force, and the moment with that of the force about the centre of the report, over
/// faces, edges and points of every shape. The body is stiff, since the report takes moments in the present geometry.
#[test]
fn resultants_are_exact() {
    let (force, moment, point) = ([3.0, -5.0, 2.0], [0.7, 11.0, -4.0], [3.0, 0.4, -2.0]);
    let map = |p: Vec3| [2.0 * p[0] + 0.3 * p[1] * p[2], p[1] - 0.2 * p[0] * p[0], 1.5 * p[2] + 0.1 * p[0]];
    for shape in [Shape::Hex8, Shape::Hex20, Shape::Tet4, Shape::Tet10, Shape::Prism6, Shape::Quad4, Shape::Quad8] {
        let dim = shape.dim();
        let grid = Grid::new(shape, &[3, 2, 2][..dim], |p| {
            let [x, y, z] = map(p);
            [x, y, if dim == 2 { 0.0 } else { z }]
        });
        let flat =
            |v: Vec3, c: [usize; 2]| std::array::from_fn(|d| if dim == 3 || c.contains(&d) { v[d] } else { 0.0 });
        let (force, moment, point) = (flat(force, [0, 1]), flat(moment, [2, 2]), flat(point, [0, 1]));
        let (law, kind) = match dim {
            2 => ("LinearElasticPlaneStrain2DLaw", "LineLoadCondition"),
            _ => ("LinearElastic3DLaw", "SurfaceLoadCondition"),
        };
        for has_faces in [true, false] {
            let material = json!({"YOUNG_MODULUS": 1e16, "POISSON_RATIO": 0.3});
            let mut deck = Deck::new(&grid, "SmallDisplacementElement", law, material);
            deck.fix(|p| p[0] == 0.0, [zero(), zero(), if dim == 3 { zero() } else { FREE }]);
            let wanted = |p: Vec3| p[0] == 1.0;
            let name = if has_faces { deck.facets(wanted, kind) } else { deck.nodes(wanted) };
            let by_time = |v: Vec3| v.map(|v| if v == 0.0 { zero() } else { json!(format!("{v:?}*t")) });
            let settings = json!({"model_part_name": format!("Structure.{name}"), "force": by_time(force),
                "moment": moment, "point": point});
            deck.process(RESULTANT, settings);
            let [found, about, centre] = loads(&deck.run());
            let what = format!("{shape:?}, {}", if has_faces { "faces" } else { "nodes" });
            assert_vector(found, force, 6.0, &format!("force on {what}"));
            assert_vector(about, add(moment, cross(sub(point, centre), force)), 20.0, &format!("moment on {what}"));
        }
    }
}

/// ANALYTIC: a force spread over a plane face is the traction F/A there; the interval ends before the last step.
#[test]
fn a_force_is_a_traction() {
    let grid = Grid::new(Shape::Hex20, &[2, 2, 2], |p| [2.0 * p[0], p[1], 1.5 * p[2]]);
    let run = |by_force: bool, end: f64| {
        let material = json!({"YOUNG_MODULUS": 1e4, "POISSON_RATIO": 0.3});
        let mut deck = Deck::new(&grid, "SmallDisplacementElement", "LinearElastic3DLaw", material);
        deck.steps(0.5, 1.0).fix(|p| p[0] == 0.0, [zero(), zero(), zero()]);
        let wanted = |p: Vec3| p[0] == 1.0;
        if by_force {
            let name = deck.facets(wanted, "SurfaceLoadCondition");
            let load = json!([1.5, "3.0*t", -4.5]);
            let settings =
                json!({"model_part_name": format!("Structure.{name}"), "load": load, "interval": [0.0, end]});
            deck.process(FORCE, settings);
        } else {
            let kind = "SmallDisplacementSurfaceLoadCondition";
            deck.vector_load(wanted, kind, "SURFACE_LOAD", [json!(1.0), json!("2.0*t"), json!(-3.0)]);
        }
        deck.run()
    };
    let (force, traction, released) = (run(true, 2.0), run(false, 2.0), run(true, 0.6));
    for node in grid.nodes_where(|p| p[0] == 1.0) {
        let (found, expected) = (force.last("DISPLACEMENT", node), traction.last("DISPLACEMENT", node));
        (0..3).for_each(|c| assert!((found[c] - expected[c]).abs() < 1e-12 * 3e-3, "{found:?} {expected:?}"));
        assert!(released.last("DISPLACEMENT", node).iter().all(|u| u.abs() < 1e-15));
    }
}

/// ANALYTIC: a moment on the end of a strip in plane stress is the linear traction of pure bending, u_y = −M x²/2EI on the axis, which
/// shapes of second order hold exactly.
#[test]
fn a_moment_bends_a_strip() {
    let (length, height, young, moment) = (10.0, 1.0, 1e6, 1.0);
    for shape in [Shape::Tri6, Shape::Quad8, Shape::Quad9] {
        let grid = Grid::new(shape, &[4, 2], |p| [length * p[0], height * (p[1] - 0.5), 0.0]);
        let law = json!({"YOUNG_MODULUS": young, "POISSON_RATIO": 0.3, "THICKNESS": 0.5});
        let mut deck = Deck::new(&grid, "SmallDisplacementElement", "LinearElasticPlaneStress2DLaw", law);
        deck.fix(|p| p[0] == 0.0, [zero(), FREE, FREE]).fix(|p| p[0] == 0.0 && p[1] == 0.5, [FREE, zero(), FREE]);
        let name = deck.facets(|p| p[0] == 1.0, "LineLoadCondition");
        let settings = json!({"model_part_name": format!("Structure.{name}"), "moment": [0.0, 0.0, moment]});
        deck.process(RESULTANT, settings);
        let ran = deck.run();
        let tip = grid.nodes_where(|p| p[0] == 1.0 && p[1] == 0.5)[0];
        let inertia = 0.5 * height * height * height / 12.0;
        let expected = 0.5 * moment * length * length / (young * inertia);
        assert_close(ran.last("DISPLACEMENT", tip)[1], expected, 1e-10, &format!("{shape:?}"));
    }
}

/// ANALYTIC: a follower force on a body that its supports rotate has the direction of the rotation at the start of the step.
#[test]
fn a_follower_force_rotates_with_its_part() {
    for shape in [Shape::Quad8, Shape::Hex8] {
        let dim = shape.dim();
        let grid = Grid::new(shape, &[2, 2, 2][..dim], |p| p);
        let law = if dim == 2 { "LinearElasticPlaneStrain2DLaw" } else { "LinearElastic3DLaw" };
        let material = json!({"YOUNG_MODULUS": 1e3, "POISSON_RATIO": 0.3});
        let mut deck = Deck::new(&grid, "TotalLagrangianElement", law, material);
        deck.steps(0.25, 1.0);
        let z = if dim == 2 { FREE } else { zero() };
        deck.fix(
            |p| p[0] == 0.0 || p[0] == 1.0,
            [json!("X*(cos(0.8*t)-1)-Y*sin(0.8*t)"), json!("X*sin(0.8*t)+Y*(cos(0.8*t)-1)"), z],
        );
        let name = deck.nodes(|p| p[0] == 1.0);
        let settings =
            json!({"model_part_name": format!("Structure.{name}"), "force": [2.0, 1.0, 0.0], "follower": true});
        deck.process(RESULTANT, settings);
        let (sine, cosine) = 0.6_f64.sin_cos();
        let expected = [2.0 * cosine - sine, 2.0 * sine + cosine, 0.0];
        assert_vector(loads(&deck.run())[0], expected, 2.0, &format!("follower on {shape:?}"));
    }
}

/// ANALYTIC: two forces on one face act together, and neither counts as listed twice.
#[test]
fn forces_on_one_face_add_up() {
    let grid = Grid::new(Shape::Hex8, &[2, 2, 2], |p| p);
    let mut deck = Deck::new(
        &grid,
        "SmallDisplacementElement",
        "LinearElastic3DLaw",
        json!({"YOUNG_MODULUS": 1e9, "POISSON_RATIO": 0.3}),
    );
    deck.fix(|p| p[0] == 0.0, [zero(), zero(), zero()]);
    let end = deck.facets(|p| p[0] == 1.0, "SurfaceLoadCondition");
    for force in [[0.0, 0.0, 4.0], [0.0, 3.0, 0.0]] {
        deck.process(FORCE, json!({"model_part_name": format!("Structure.{end}"), "load": force}));
    }
    let ran = deck.run();
    assert_vector(loads(&ran)[0], [0.0, 3.0, 4.0], 5.0, "two forces");
    let warnings = &ran.report.warnings;
    assert!(!warnings.iter().any(|words| words.contains("listed-twice")), "{warnings:?}");
}

/// ANALYTIC: an axial force on the whole turn is the traction F/A on a ring or a disc, A = π (b² − a²) whatever the facets, so that a rod or
/// tube without Poisson's ratio has σ = F/A and u = F L/(E A), and the report has the total. Nodes alone take equal shares.
#[test]
fn an_axial_force_on_a_body_of_revolution_is_exact() {
    let (young, force, length) = (1e4, 50.0, 3.0);
    for shape in [Shape::Tri3, Shape::Quad4, Shape::Tri6, Shape::Quad8, Shape::Quad9] {
        for inner in [0.0, 0.7] {
            for element in ["AxisymSmallDisplacementElement", "AxisymTotalLagrangianElement"] {
                let grid = Grid::new(shape, &[3, 2], |p| [inner + (2.0 - inner) * p[0], length * p[1], 0.0]);
                let is_linear = element.contains("Small");
                let law = if is_linear { "LinearElasticAxisym2DLaw" } else { "KirchhoffSaintVenantAxisym2DLaw" };
                let force = if is_linear { force } else { 1e-6 * force };
                let material = json!({"YOUNG_MODULUS": young, "POISSON_RATIO": 0.0});
                let mut deck = Deck::new(&grid, element, law, material);
                deck.fix(|p| p[1] == 0.0, [FREE, zero(), FREE]);
                if inner == 0.0 {
                    deck.fix(|p| p[0] == 0.0, [zero(), FREE, FREE]);
                }
                let ring = deck.facets(|p| p[1] == 1.0, "LineCondition");
                let load = json!([0.0, format!("{force:?}*t"), 0.0]);
                deck.process(FORCE, json!({"model_part_name": format!("Structure.{ring}"), "load": load}));
                let ran = deck.run();
                let what = format!("{element} {shape:?} {inner}");
                assert_vector(loads(&ran)[0], [0.0, force, 0.0], force, &what);
                let area = std::f64::consts::PI * (4.0 - inner * inner);
                for node in grid.nodes_where(|p| p[1] == 1.0) {
                    let u = ran.last("DISPLACEMENT", node);
                    let expected = force * length / (young * area);
                    let allowed = if is_linear { 1e-11 } else { 1e-7 };
                    assert_close(u[1], expected, allowed, &what);
                    assert!(u[0].abs() < allowed * expected, "{what}: {u:?}");
                }
            }
        }
    }
}

/// Loads that no ring takes are named before the run, with pressure as the remedy.
#[test]
fn resultants_that_a_ring_cannot_take_are_named() {
    let grid = Grid::new(Shape::Quad4, &[2, 2], |p| [1.0 + p[0], p[1], 0.0]);
    for (settings, words) in [
        (json!({"force": [1.0, 2.0, 0.0]}), "along the radius cancels"),
        (json!({"moment": [0.0, 0.0, 1.0]}), "no rotation on which a moment could act"),
        (json!({"force": [0.0, 1.0, 0.0], "point": [1.0, 0.0, 0.0]}), "\"point\" lies beside it"),
        (json!({"force": [0.0, 1.0, 0.0], "follower": true}), "keeps its direction"),
    ] {
        let material = json!({"YOUNG_MODULUS": 1.0, "POISSON_RATIO": 0.3});
        let mut deck = Deck::new(&grid, "AxisymSmallDisplacementElement", "LinearElasticAxisym2DLaw", material);
        deck.fix(|p| p[1] == 0.0, [FREE, zero(), FREE]);
        let mut settings = settings;
        settings["model_part_name"] = json!(format!("Structure.{}", deck.facets(|p| p[1] == 1.0, "LineCondition")));
        deck.process(RESULTANT, settings);
        let said = deck.problem();
        for word in ["axisymmetric-resultant", words, "PRESSURE"] {
            assert!(said.contains(word), "no {word:?} in: {said}");
        }
    }
}

/// A moment about a line of nodes and loads out of the plane are named before the run.
#[test]
fn mistakes_are_named() {
    let problem = |shape: Shape, module: &str, mut settings: Value, wanted: fn(Vec3) -> bool| {
        let grid = Grid::new(shape, &[2, 2, 2][..shape.dim()], |p| p);
        let law = if shape.dim() == 2 { "LinearElasticPlaneStrain2DLaw" } else { "LinearElastic3DLaw" };
        let mut deck =
            Deck::new(&grid, "SmallDisplacementElement", law, json!({"YOUNG_MODULUS": 1.0, "POISSON_RATIO": 0.3}));
        deck.fix(|p| p[0] == 0.0, [zero(), zero(), if shape.dim() == 3 { zero() } else { FREE }]);
        settings["model_part_name"] = json!(format!("Structure.{}", deck.nodes(wanted)));
        deck.process(module, settings);
        deck.problem()
    };
    let edge: fn(Vec3) -> bool = |p| p[0] == 1.0 && p[1] == 1.0;
    let about_edge = json!({"moment": [0.0, 0.0, 1.0]});
    let cases = [
        (problem(Shape::Hex8, RESULTANT, about_edge.clone(), edge), "moment-without-arm"),
        (problem(Shape::Quad4, RESULTANT, about_edge, edge), "moment-without-arm"),
        (problem(Shape::Quad4, RESULTANT, json!({"force": [0.0, 0.0, 1.0]}), edge), "out-of-plane"),
        (problem(Shape::Quad4, FORCE, json!({}), edge), "missing-key"),
        (problem(Shape::Quad4, FORCE, json!({"load": 3.0}), edge), "wrong-type"),
    ];
    for (said, code) in cases {
        assert!(said.contains(code), "{code}: {said}");
    }
}
