//! Rigid bodies with mass and inertia at the reference node of a coupling.

use serde_json::{Value, json};
use zelus_core::geometry::Shape;
use zelus_core::vector3::{add, cross, scale};

use super::deck::{Deck, Ran, assert_close};
use super::grid::{Grid, Vec3};

const REFERENCE: &str = "Structure.Reference";

/// Massless elements whose nodes follow a reference node at a point, in steps of Newmark's method.
fn body<'a>(grid: &'a Grid, large: bool, dt: f64, end: f64, point: Vec3, more: Value) -> Deck<'a> {
    let dim = grid.shape.dim();
    let law = if dim == 2 { "KirchhoffSaintVenantPlaneStrain2DLaw" } else { "KirchhoffSaintVenant3DLaw" };
    let element = if large { "TotalLagrangianElement" } else { "SmallDisplacementElement" };
    let law = if large { law.to_owned() } else { law.replace("KirchhoffSaintVenant", "LinearElastic") };
    let density = more["density"].as_f64().unwrap_or(0.0);
    let material = json!({"YOUNG_MODULUS": 100.0, "POISSON_RATIO": 0.3, "DENSITY": density});
    let mut deck = Deck::new(grid, element, &law, material);
    deck.set("solver_type", json!("Dynamic")).set("scheme_type", json!("newmark"));
    deck.set("time_integration_method", json!("implicit")).set("max_iteration", json!(60)).steps(dt, end);
    let all = deck.nodes(|_| true);
    let mut settings = json!({"model_part_name": format!("Structure.{all}"), "reference_model_part_name": REFERENCE,
        "reference_point": point});
    for key in ["mass", "inertia", "centre_of_mass"] {
        if !more[key].is_null() {
            settings[key] = more[key].clone();
        }
    }
    deck.process("kinematic_coupling_process", settings);
    deck.output(&["ROTATION", "VELOCITY"]);
    deck
}

fn at_reference(deck: &mut Deck<'_>, variable: &str, value: Vec3, held: bool, end: Value) {
    let settings = json!({"model_part_name": REFERENCE, "variable_name": variable, "constrained": [held, held, held],
        "value": value, "interval": [0.0, end]});
    deck.process("assign_vector_variable_process", settings);
}

fn load(deck: &mut Deck<'_>, variable: &str, value: [&str; 3]) {
    let settings = json!({"model_part_name": REFERENCE, "variable_name": variable, "value": value});
    deck.process("assign_vector_variable_to_conditions_process", settings);
}

/// One cell, which masses at the reference node move.
fn cell(shape: Shape) -> Grid {
    Grid::new(shape, &[1, 1, 1][..shape.dim()], |p| p)
}

/// exp [θ]× v, by Rodrigues' formula.
fn rotated(theta: Vec3, v: Vec3) -> Vec3 {
    let t = theta.iter().map(|x| x * x).sum::<f64>().sqrt().max(1e-300);
    let first = cross(theta, v);
    let second = cross(theta, first);
    std::array::from_fn(|c| v[c] + t.sin() / t * first[c] + (1.0 - t.cos()) / (t * t) * second[c])
}

fn distance(a: Vec3, b: Vec3) -> f64 {
    (0..3).map(|c| (a[c] - b[c]).abs()).fold(0.0, f64::max)
}

/// ANALYTIC: force and moment on a body of mass m and inertia J, m ü = F and J θ̈ = M for small rotations, in the steps of Newmark's
/// method.
#[test]
fn force_and_moment_accelerate_a_body() {
    let (mass, dt) = (2.0, 0.1);
    for shape in [Shape::Quad4, Shape::Hex8] {
        let grid = cell(shape);
        let inertia = if shape.dim() == 2 { json!(0.3) } else { json!([0.2, 0.25, 0.3]) };
        let more = json!({"mass": mass, "inertia": inertia});
        let mut deck = body(&grid, false, dt, 0.5, [0.4, 0.3, 0.0], more);
        load(&mut deck, "POINT_LOAD", ["0.05*t", "-0.02*t", "0.0"]);
        load(&mut deck, "POINT_MOMENT", ["0.0", "0.0", "0.01*t"]);
        let ran = deck.run();
        let node = grid.nodes.len();
        let [mut shape_of, mut rate, mut before] = [0.0; 3];
        for step in 0..5 {
            // The motion under an acceleration that grows as t.
            let now = dt * (step + 1) as f64;
            shape_of += dt * rate + 0.25 * dt * dt * (before + now);
            rate += 0.5 * dt * (before + now);
            before = now;
            let what = format!("{shape:?} step {step}");
            assert_close(ran.vector("DISPLACEMENT", node, step)[0], 0.05 / mass * shape_of, 1e-9, &what);
            assert_close(ran.vector("DISPLACEMENT", node, step)[1], -0.02 / mass * shape_of, 1e-9, &what);
            assert_close(ran.vector("ROTATION", node, step)[2], 0.01 / 0.3 * shape_of, 1e-9, &what);
        }
    }
}

/// A block with density is as one without, whose reference node has its mass and its inertia, also where that node is not its centre:
/// large rotations by a moment and a force, with weight.
#[test]
fn a_block_is_as_its_mass_and_inertia() {
    for shape in [Shape::Quad4, Shape::Hex8] {
        let dim = shape.dim();
        let [a, b, c] = [2.0, 1.0, if dim == 2 { 1.0 } else { 0.5 }];
        let grid = Grid::new(shape, &[2, 2, 1][..dim], |p| [a * p[0], b * p[1], c * p[2]]);
        let centre = [0.5 * a, 0.5 * b, if dim == 2 { 0.0 } else { 0.5 * c }];
        let mass = 3.0 * a * b * c;
        let moment = |x: f64, y: f64| mass * (x * x + y * y) / 12.0;
        let inertia = match dim {
            2 => json!(moment(a, b)),
            _ => json!([moment(b, c), moment(a, c), moment(a, b)]),
        };
        let run = |more: Value, point: Vec3| {
            let mut deck = body(&grid, true, 0.1, 1.0, point, more);
            let way = if dim == 2 { ["0.0", "0.0", "7.0*t"] } else { ["2.0*t", "-1.0*t", "7.0*t"] };
            load(&mut deck, "POINT_MOMENT", way);
            load(&mut deck, "POINT_LOAD", ["6.0*t", "0.0", "0.0"]);
            let gravity = json!({"model_part_name": "Structure", "variable_name": "VOLUME_ACCELERATION",
                "constrained": [false, false, false], "value": [0.0, -9.81, 0.0], "interval": [0.0, "End"]});
            deck.process("assign_vector_variable_process", gravity);
            deck.run().displacements(&grid)
        };
        for point in [centre, [-0.3, 0.2, 0.0]] {
            let more = json!({"mass": mass, "inertia": inertia, "centre_of_mass": centre});
            let (found, expected) = (run(more, point), run(json!({"density": 3.0}), point));
            let off = found.iter().zip(&expected).map(|(a, b)| distance(*a, *b)).fold(0.0, f64::max);
            let size = expected.iter().flatten().fold(0.0_f64, |most, u| most.max(u.abs()));
            println!("{shape:?}: {off:.1e} of {size:.2}");
            assert!(size > 3.0 && off < 1e-8 * size, "{shape:?}: {off:e} of {size}");
        }
    }
}

/// ANALYTIC: a compound pendulum released from a right angle, J_O θ̈ = −m g s sin θ, passes its lowest point after a quarter of the
/// period 4 √(J_O/(m g s)) K(sin 45°), K = 1.854074677. Newmark's method is of second order.
#[test]
fn a_pendulum_swings() {
    let [mass, arm, inertia, gravity]: [f64; 4] = [2.0, 0.5, 0.3, 9.81];
    let frequency = (mass * gravity * arm / (inertia + mass * arm * arm)).sqrt();
    let quarter = 1.854_074_677_301_372 / frequency;
    let angle = |steps: usize, shape: Shape| {
        let grid = cell(shape);
        let inertia = if shape.dim() == 2 { json!(inertia) } else { json!([0.1, 0.25, inertia]) };
        let more = json!({"mass": mass, "inertia": inertia, "centre_of_mass": [arm, 0.0, 0.0]});
        let mut deck = body(&grid, true, quarter / steps as f64, quarter, [0.0; 3], more);
        at_reference(&mut deck, "DISPLACEMENT", [0.0; 3], true, json!("End"));
        let settings = json!({"model_part_name": REFERENCE, "variable_name": "VOLUME_ACCELERATION",
            "constrained": [false, false, false], "value": [0.0, -gravity, 0.0], "interval": [0.0, "End"]});
        deck.process("assign_vector_variable_process", settings);
        let settings = json!({"model_part_name": REFERENCE, "variable_name": "ANGULAR_ACCELERATION",
            "constrained": [false, false, false], "value": [0.0, 0.0, -frequency * frequency], "interval": [0.0, 0.0]});
        deck.process("assign_vector_variable_process", settings);
        deck.run().last("ROTATION", grid.nodes.len())[2] + std::f64::consts::FRAC_PI_2
    };
    for shape in [Shape::Quad4, Shape::Hex8] {
        let [coarse, fine] = [20, 40].map(|steps| angle(steps, shape));
        println!("{shape:?}: {coarse:.2e} {fine:.2e}");
        assert!(fine.abs() < 2e-3, "{shape:?}: {fine}");
        assert!((coarse / fine / 4.0 - 1.0).abs() < 0.1, "{shape:?}: {coarse} {fine}");
    }
}

/// ANALYTIC: a body that tumbles freely obeys Euler's equations J Ω̇ = J Ω × Ω in its own axes, integrated here by the method of Runge and
/// Kutta to 1e-10; its centre moves straight. Newmark's method is of second order.
#[test]
fn a_free_body_tumbles() {
    let (moments, spin, velocity) = ([1.0, 2.0, 2.6], [0.3, 1.0, 0.2], [0.1, -0.2, 0.3]);
    let end = 3.0;
    // The rotation by its unit vectors, in 3000 steps.
    let rate = |axes: [Vec3; 3], omega: Vec3| {
        let turn: Vec3 = (0..3).fold([0.0; 3], |sum, i| add(sum, scale(axes[i], omega[i])));
        let momentum: Vec3 = std::array::from_fn(|i| moments[i] * omega[i]);
        let torque = cross(momentum, omega);
        (axes.map(|axis| cross(turn, axis)), std::array::from_fn(|i| torque[i] / moments[i]))
    };
    type Motion = ([Vec3; 3], Vec3);
    let unit_vectors = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let mut now: Motion = (unit_vectors, spin);
    let h = end / 3000.0;
    let moved = |(axes, omega): Motion, (by, change): Motion, h: f64| {
        (std::array::from_fn(|i| add(axes[i], scale(by[i], h))), add(omega, scale(change, h)))
    };
    for _ in 0..3000 {
        let first = rate(now.0, now.1);
        let second = {
            let at = moved(now, first, 0.5 * h);
            rate(at.0, at.1)
        };
        let third = {
            let at = moved(now, second, 0.5 * h);
            rate(at.0, at.1)
        };
        let fourth = {
            let at = moved(now, third, h);
            rate(at.0, at.1)
        };
        for (way, weight) in [(first, 1.0), (second, 2.0), (third, 2.0), (fourth, 1.0)] {
            now = moved(now, way, weight * h / 6.0);
        }
    }
    let error = |steps: usize| {
        let grid = cell(Shape::Hex8);
        let more = json!({"mass": 2.0, "inertia": moments});
        let mut deck = body(&grid, true, end / steps as f64, end, [0.0; 3], more);
        at_reference(&mut deck, "VELOCITY", velocity, false, json!(0.0));
        at_reference(&mut deck, "ANGULAR_VELOCITY", spin, false, json!(0.0));
        let at_start = rate(unit_vectors, spin).1;
        at_reference(&mut deck, "ANGULAR_ACCELERATION", at_start, false, json!(0.0));
        let ran: Ran = deck.run();
        let node = grid.nodes.len();
        let centre = ran.last("DISPLACEMENT", node);
        assert!(distance(centre, scale(velocity, end)) < 1e-8, "centre at {centre:?}");
        let theta = ran.last("ROTATION", node);
        (0..3).map(|i| distance(rotated(theta, unit_vectors[i]), now.0[i])).fold(0.0, f64::max)
    };
    let [coarse, fine] = [60, 120].map(error);
    println!("{coarse:.2e} {fine:.2e}");
    assert!(fine < 1e-3, "{fine}");
    assert!((coarse / fine / 4.0 - 1.0).abs() < 0.1, "{coarse} {fine}");
}

/// ANALYTIC: a bar with a body at its end is stretched by its weight, m g L/EA, in a static analysis; force and moment of the support
/// are those of the weight on its arm.
#[test]
fn a_bar_bears_a_body() {
    let (length, young, weight, reach) = (4.0, 1e5, 2.0 * 9.81, 0.7);
    let grid = Grid::new(Shape::Hex8, &[4, 1, 1], |p| [length * p[0], p[1] - 0.5, p[2] - 0.5]);
    let mut deck = Deck::new(
        &grid,
        "SmallDisplacementElement",
        "LinearElastic3DLaw",
        json!({"YOUNG_MODULUS": young, "POISSON_RATIO": 0.0, "DENSITY": 0.0}),
    );
    deck.fix(|p| p[0] == 0.0, [json!(0.0), json!(0.0), json!(0.0)]);
    let end = deck.nodes(|p| p[0] == 1.0);
    let settings = json!({"model_part_name": format!("Structure.{end}"), "reference_model_part_name": REFERENCE,
        "reference_point": [length, 0.0, 0.0], "mass": 2.0, "centre_of_mass": [length, reach, 0.0]});
    deck.process("kinematic_coupling_process", settings);
    let gravity = json!({"model_part_name": "Structure", "variable_name": "VOLUME_ACCELERATION",
        "constrained": [false, false, false], "value": [9.81, 0.0, 0.0], "interval": [0.0, "End"]});
    deck.process("assign_vector_variable_process", gravity);
    deck.output(&["ROTATION"]);
    let ran = deck.run();
    assert_close(ran.last("DISPLACEMENT", grid.nodes.len())[0], weight * length / young, 1e-10, "stretch");
    let held = grid.nodes_where(|p| p[0] == 0.0);
    let [mut force, mut moment] = [[0.0; 3]; 2];
    for &node in &held {
        let reaction = ran.last("REACTION", node);
        force = add(force, reaction);
        moment = add(moment, cross(grid.nodes[node], reaction));
    }
    assert!(distance(force, [-weight, 0.0, 0.0]) < 1e-10 * weight, "{force:?}");
    assert!(distance(moment, [0.0, 0.0, weight * reach]) < 1e-9 * weight, "{moment:?}");
}

/// Masses that cannot be are named before the run.
#[test]
fn mistakes_are_named() {
    for (more, words) in [
        (json!({"mass": -1.0}), ["\"mass\"", "-1"]),
        (json!({"inertia": [1.0, 1.0, 1.0]}), ["inertia", "without \"mass\""]),
        (json!({"mass": 1.0, "inertia": [1.0, 1.0, 3.0]}), ["inertia", "larger than the sum of the others"]),
        (json!({"mass": 1.0, "inertia": 2.0}), ["inertia", "three positive moments"]),
    ] {
        let grid = cell(Shape::Hex8);
        let said = body(&grid, true, 0.1, 0.1, [0.0; 3], more).problem();
        words.iter().for_each(|word| assert!(said.contains(word), "no {word:?} in: {said}"));
    }
}
