//! Large rotations of distributing couplings (RBE3), masses at their reference nodes, and rotations beyond a turn.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use serde_json::{Value, json};
use zelus_core::geometry::{Shape, ShapeTable};
use zelus_core::vector3::{add, cross, dot, norm, scale, sub};

use super::deck::{Deck, Ran, assert_close};
use super::grid::{Grid, Vec3};

const FREE: Value = Value::Null;
const KINEMATIC: &str = "kinematic_coupling_process";
const DISTRIBUTING: &str = "distributing_coupling_process";
const REFERENCE: &str = "Structure.Reference";

fn zero() -> Value {
    json!(0.0)
}

/// Couples a part to a new reference node.
fn couple(deck: &mut Deck<'_>, process: &str, part: &str, (reference, point): (&str, Vec3), more: Value) {
    let mut settings = json!({"model_part_name": format!("Structure.{part}"), "reference_model_part_name": reference,
        "reference_point": point});
    more.as_object().into_iter().flatten().for_each(|(key, value)| settings[key] = value.clone());
    deck.process(process, settings);
}

fn load(deck: &mut Deck<'_>, variable: &str, value: [String; 3]) {
    let settings = json!({"model_part_name": REFERENCE, "variable_name": variable, "value": value});
    deck.process("assign_vector_variable_to_conditions_process", settings);
}

fn by_time(value: Vec3) -> [String; 3] {
    value.map(|v| format!("{v:?}*t"))
}

fn hold(deck: &mut Deck<'_>, variable: &str, value: [Value; 3]) {
    let constrained: Vec<bool> = value.iter().map(|v| !v.is_null()).collect();
    let settings = json!({"model_part_name": REFERENCE, "variable_name": variable, "constrained": constrained,
        "value": value, "interval": [0.0, "End"]});
    deck.process("assign_vector_variable_process", settings);
}

/// exp [θ]× v, by Rodrigues' formula.
fn rotated(theta: Vec3, v: Vec3) -> Vec3 {
    let t = norm(theta).max(1e-30);
    let first = cross(theta, v);
    let second = cross(theta, first);
    std::array::from_fn(|c| v[c] + t.sin() / t * first[c] + (1.0 - t.cos()) / (t * t) * second[c])
}

fn distance(a: Vec3, b: Vec3) -> f64 {
    norm(sub(a, b))
}

fn law(dim: usize) -> &'static str {
    if dim == 2 { "KirchhoffSaintVenantPlaneStrain2DLaw" } else { "KirchhoffSaintVenant3DLaw" }
}

/// Largest distance of displacements from those of a rigid rotation about a point, and of a motion of the point.
fn off_rigid(ran: &Ran, grid: &Grid, step: usize, (theta, point, way): (Vec3, Vec3, Vec3)) -> f64 {
    let off = |(node, &x): (usize, &Vec3)| {
        let arm = sub(x, point);
        distance(ran.vector("DISPLACEMENT", node, step), add(sub(rotated(theta, arm), arm), way))
    };
    grid.nodes.iter().enumerate().map(off).fold(0.0, f64::max)
}

/// ANALYTIC: a free body whose reference node rotates by 90° and by 360° rotates with it, without strain; force and moment of the
/// supports are zero to round-off of the stiffness 100. In the plane, and in space about an oblique axis.
#[test]
fn a_driven_body_rotates_without_strain() {
    for shape in [Shape::Quad4, Shape::Tri6, Shape::Hex8, Shape::Tet10] {
        let dim = shape.dim();
        let grid = Grid::new(shape, &[2, 2, 2][..dim], |p| [2.0 * p[0], p[1] - 0.3, p[2]]);
        let material = json!({"YOUNG_MODULUS": 100.0, "POISSON_RATIO": 0.3});
        let mut deck = Deck::new(&grid, "TotalLagrangianElement", law(dim), material);
        deck.steps(0.125, 1.0);
        let kind = if dim == 2 { "LineCondition" } else { "SurfaceCondition" };
        let face = deck.facets(|p| p[0] == 0.0, kind);
        let point = if dim == 2 { [-1.0, 0.4, 0.0] } else { [-1.0, 0.4, 0.8] };
        couple(&mut deck, DISTRIBUTING, &face, (REFERENCE, point), json!({"reference_node_leads": true}));
        let axis = if dim == 2 { [0.0, 0.0, 1.0] } else { [2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0] };
        let theta = scale(axis, TAU);
        let way = [0.5, -0.2, 0.0];
        let [motion, rotation] = [way, theta].map(|v| by_time(v).map(Value::from));
        let [x, y, z] = motion;
        hold(&mut deck, "DISPLACEMENT", [x, y, if dim == 2 { FREE } else { z }]);
        let [x, y, z] = rotation;
        hold(&mut deck, "ROTATION", if dim == 2 { [FREE, FREE, z] } else { [x, y, z] });
        deck.output(&["ROTATION", "REACTION_MOMENT"]);
        let ran = deck.run();
        for step in [1, 7] {
            let share = 0.125 * (step + 1) as f64;
            let off = off_rigid(&ran, &grid, step, (scale(theta, share), point, scale(way, share)));
            let node = grid.nodes.len();
            let [force, moment] = ["REACTION", "REACTION_MOMENT"].map(|of| norm(ran.vector(of, node, step)));
            println!("{shape:?} step {step}: off {off:.1e}, force {force:.1e}, moment {moment:.1e}");
            assert!(off < 1e-10 && force < 1e-10 * 100.0 && moment < 1e-10 * 100.0, "{shape:?} {step}");
        }
    }
}

/// The strip of the tests: length and height, Young's modulus, thickness 1 and no Poisson's ratio.
const STRIP: [f64; 3] = [20.0, 0.2, 1e6];

fn strip_moment() -> f64 {
    let [length, height, young] = STRIP;
    FRAC_PI_2 * young * height * height * height / 12.0 / length
}

/// The strip, and how it stands in the plane.
fn strip(angle: f64, unit: f64) -> Grid {
    let [length, height, _] = STRIP;
    let (sine, cosine) = angle.sin_cos();
    Grid::new(Shape::Quad8, &[40, 1], |p| {
        let [x, y] = [unit * length * p[0], unit * height * (p[1] - 0.5)];
        [cosine * x - sine * y, sine * x + cosine * y, 0.0]
    })
}

fn bend(grid: &Grid, (unit, force): (f64, f64), steps: f64, more: Value) -> Ran {
    let [length, _, young] = STRIP;
    let material = json!({"YOUNG_MODULUS": young * force / (unit * unit), "POISSON_RATIO": 0.0, "THICKNESS": unit});
    let mut deck = Deck::new(grid, "TotalLagrangianElement", "KirchhoffSaintVenantPlaneStress2DLaw", material);
    deck.steps(1.0 / steps, 1.0).set("max_iteration", json!(30));
    deck.fix(|p| p[0] == 0.0, [zero(), zero(), FREE]);
    let end = deck.facets(|p| p[0] == 1.0, "LineCondition");
    let tip = grid.nodes_where(|p| p[0] == 1.0 && p[1] == 0.5)[0];
    couple(&mut deck, DISTRIBUTING, &end, (REFERENCE, grid.nodes[tip]), more);
    let _ = length;
    load(&mut deck, "POINT_MOMENT", by_time([0.0, 0.0, strip_moment() * force * unit]));
    deck.output(&["ROTATION"]);
    deck.run()
}

/// ANALYTIC: a slender strip bent to a quarter of a circle by a dead moment, θ = M L/EI = π/2 within 1 % (strains are 0.8 %). The moment
/// of the supports is the applied one, the rotation of the reference node that of the polar decomposition of its edge, which stays
/// straight but for its strains; the work of the moment, by the trapezoidal rule, is the strain energy.
#[test]
fn a_moment_bends_a_strip() {
    let [length, height, young] = STRIP;
    let moment = strip_moment();
    let grid = strip(0.0, 1.0);
    let ran = bend(&grid, (1.0, 1.0), 10.0, json!({}));
    let node = grid.nodes.len();
    let iterations: Vec<usize> = ran.report.steps.iter().map(|step| step.iterations.len()).collect();
    println!("iterations {iterations:?}");
    let angle = ran.last("ROTATION", node)[2];
    println!("angle {:.3e}", angle / FRAC_PI_2 - 1.0);
    assert_close(angle, FRAC_PI_2, 1e-2, "rotation");
    let place = |node: usize| add(grid.nodes[node], ran.last("DISPLACEMENT", node));
    // ∫ x⊗r ds over the edge by Simpson's rule, with r along y: the middle has no arm.
    let [low, high] = [0.0, 1.0].map(|y| grid.nodes_where(|p| p[0] == 1.0 && p[1] == y)[0]);
    let edge = sub(place(high), place(low));
    let polar = (-edge[0]).atan2(edge[1]);
    println!("polar {:.1e}", angle - polar);
    assert!((angle - polar).abs() < 1e-12, "{angle} {polar}");
    let root = grid.nodes_where(|p| p[0] == 0.0);
    let reaction = root.iter().fold([0.0; 3], |sum, &node| add(sum, cross(place(node), ran.last("REACTION", node))));
    println!("root {:.1e}", reaction[2] / moment + 1.0);
    assert_close(-reaction[2], moment, 1e-8, "moment at the root");
    let work: f64 = (0..10)
        .map(|step| {
            let at = |step: usize| ran.vector("ROTATION", node, step)[2];
            let [first, last] = [step as f64, (step + 1) as f64].map(|t| 0.1 * t * moment);
            0.5 * (first + last) * (at(step) - if step == 0 { 0.0 } else { at(step - 1) })
        })
        .sum();
    let table = ShapeTable::get(Shape::Quad8, 4);
    let half = [0.5 * length / 40.0, 0.5 * height];
    let mut energy = 0.0;
    for cell in &grid.cells {
        let u: Vec<Vec3> = cell.iter().map(|&node| ran.last("DISPLACEMENT", node)).collect();
        for g in 0..table.len() {
            let mut f = [[1.0, 0.0], [0.0, 1.0]];
            for (slopes, u) in table.dn::<8, 2>()[g].iter().zip(&u) {
                (0..4).for_each(|at| f[at / 2][at % 2] += u[at / 2] * slopes[at % 2] / half[at % 2]);
            }
            let green =
                |i: usize, j: usize| 0.5 * (f[0][i] * f[0][j] + f[1][i] * f[1][j] - f64::from(u8::from(i == j)));
            let square = green(0, 0).powi(2) + green(1, 1).powi(2) + 2.0 * green(0, 1).powi(2);
            energy += 0.5 * young * square * table.weight(g) * half[0] * half[1];
        }
    }
    println!("work {:.1e}", work / energy - 1.0);
    assert_close(work, energy, 1e-4, "work");
}

/// ANALYTIC: the strip turned in the plane, and in other units, bends alike. With a reference node that leads, a prescribed rotation
/// needs the moment that gives it.
#[test]
fn directions_and_units_change_nothing() {
    let plain = bend(&strip(0.0, 1.0), (1.0, 1.0), 5.0, json!({}));
    let node = strip(0.0, 1.0).nodes.len();
    let expected = plain.last("ROTATION", node)[2];
    for (angle, unit, force) in [(0.7, 1.0, 1.0), (2.4, 1000.0, 1.0), (0.0, 1e-3, 1e3)] {
        let grid = strip(angle, unit);
        let ran = bend(&grid, (unit, force), 5.0, json!({}));
        assert_close(ran.last("ROTATION", node)[2], expected, 1e-8, &format!("{angle} {unit} {force}"));
        let (sine, cosine) = angle.sin_cos();
        let [x, y, _] = scale(plain.last("DISPLACEMENT", node), unit);
        let off = distance(ran.last("DISPLACEMENT", node), [cosine * x - sine * y, sine * x + cosine * y, 0.0]);
        assert!(off < 1e-8 * unit * STRIP[0], "{angle} {unit}: {off:e}");
    }
    let leading = bend(&strip(0.0, 1.0), (1.0, 1.0), 5.0, json!({"reference_node_leads": true}));
    assert_close(leading.last("ROTATION", node)[2], expected, 1e-8, "a leading node");
}

/// A bar in space of some direction, bent by a moment about two axes of its own and a force beyond its end; the moment of the supports.
#[test]
fn a_bar_in_space_takes_force_and_moment_whole() {
    let run = |turn: Vec3, leads: bool| {
        let grid = Grid::new(Shape::Hex20, &[6, 1, 1], |p| rotated(turn, [12.0 * p[0], p[1] - 0.5, p[2] - 0.5]));
        let material = json!({"YOUNG_MODULUS": 1e4, "POISSON_RATIO": 0.3});
        let mut deck = Deck::new(&grid, "TotalLagrangianElement", law(3), material);
        deck.steps(0.1, 1.0).set("max_iteration", json!(40));
        deck.fix(|p| p[0] == 0.0, [zero(), zero(), zero()]);
        let end = deck.facets(|p| p[0] == 1.0, "SurfaceCondition");
        let point = rotated(turn, [13.0, 0.4, -0.3]);
        couple(&mut deck, DISTRIBUTING, &end, (REFERENCE, point), json!({"reference_node_leads": leads}));
        let [force, moment] = [[0.5, 1.0, -0.7], [30.0, 20.0, 60.0]].map(|v| rotated(turn, v));
        load(&mut deck, "POINT_LOAD", by_time(force));
        load(&mut deck, "POINT_MOMENT", by_time(moment));
        deck.output(&["ROTATION"]);
        let ran = deck.run();
        let iterations: Vec<usize> = ran.report.steps.iter().map(|step| step.iterations.len()).collect();
        println!("{turn:?} {leads}: iterations {iterations:?}");
        let node = grid.nodes.len();
        let place = |node: usize, x: Vec3| add(x, ran.last("DISPLACEMENT", node));
        let at = place(node, point);
        let root = grid.nodes_where(|p| p[0] == 0.0);
        let [mut of_force, mut of_moment] = [[0.0; 3]; 2];
        for &node in &root {
            let reaction = ran.last("REACTION", node);
            of_force = add(of_force, reaction);
            of_moment = add(of_moment, cross(sub(place(node, grid.nodes[node]), at), reaction));
        }
        let [off_force, off_moment] =
            [distance(of_force, scale(force, -1.0)), distance(of_moment, scale(moment, -1.0))];
        println!("force {off_force:.1e}, moment {off_moment:.1e}");
        assert!(off_force < 1e-7 && off_moment < 1e-6, "{of_force:?} {of_moment:?} {moment:?}");
        let back = scale(turn, -1.0);
        (rotated(back, ran.last("DISPLACEMENT", node)), rotated(back, ran.last("ROTATION", node)))
    };
    let (u, theta) = run([0.0; 3], false);
    println!("{u:?} {theta:?}");
    assert!(norm(theta) > 0.5);
    for (turn, leads) in [([1.2, -0.4, 2.0], false), ([0.0; 3], true), ([1.2, -0.4, 2.0], true)] {
        let (other, rotation) = run(turn, leads);
        assert!(distance(u, other) < 1e-7 * norm(u), "{turn:?} {leads}: {other:?}");
        // The rotation vector turns with the bar.
        assert!(distance(theta, rotation) < 1e-7, "{turn:?} {leads}: {rotation:?} {theta:?}");
    }
}

/// ANALYTIC: for rotations of 1e-6 the coupling is the one for small rotations but for the square of that.
#[test]
fn small_rotations_are_as_before() {
    for shape in [Shape::Quad8, Shape::Hex20] {
        let dim = shape.dim();
        for leads in [false, true] {
            let grid = Grid::new(shape, &[3, 1, 1][..dim], |p| [4.0 * p[0], p[1] - 0.5, p[2]]);
            let run = |large: bool| {
                let material = json!({"YOUNG_MODULUS": 1e6, "POISSON_RATIO": 0.3});
                let mut deck = Deck::new(&grid, "TotalLagrangianElement", law(dim), material);
                deck.fix(|p| p[0] == 0.0, [zero(), zero(), if dim == 2 { FREE } else { zero() }]);
                let kind = if dim == 2 { "LineCondition" } else { "SurfaceCondition" };
                let end = deck.facets(|p| p[0] == 1.0, kind);
                let more = json!({"reference_node_leads": leads, "large_rotations": large});
                couple(&mut deck, DISTRIBUTING, &end, (REFERENCE, [5.0, 0.3, 0.0]), more);
                let [force, moment] = if dim == 2 {
                    [[1e-2, 2e-2, 0.0], [0.0, 0.0, 2e-2]]
                } else {
                    [[1e-2, 2e-2, -1e-2], [1e-2, -2e-2, 2e-2]]
                };
                load(&mut deck, "POINT_LOAD", by_time(force));
                load(&mut deck, "POINT_MOMENT", by_time(moment));
                deck.output(&["ROTATION"]).set("residual_relative_tolerance", json!(1e-12));
                let ran = deck.run();
                (ran.displacements(&grid), ran.last("ROTATION", grid.nodes.len()))
            };
            let ((large, theta), (small, before)) = (run(true), run(false));
            let off = large.iter().zip(&small).map(|(a, b)| distance(*a, *b)).fold(distance(theta, before), f64::max);
            println!("{shape:?} {leads}: {:.1e}, off {off:.1e}", norm(theta));
            assert!(norm(theta) > 2e-7 && norm(theta) < 5e-6 && off < 1e-10, "{theta:?} {off:e}");
        }
    }
}

/// Massless elements with a mass at the reference node of their distributing coupling, in steps of Newmark's method.
fn carried<'a>(grid: &'a Grid, large: bool, (dt, end): (f64, f64), point: Vec3, more: Value) -> Deck<'a> {
    let dim = grid.shape.dim();
    let element = if large { "TotalLagrangianElement" } else { "SmallDisplacementElement" };
    let law = if large { law(dim).to_owned() } else { law(dim).replace("KirchhoffSaintVenant", "LinearElastic") };
    let material = json!({"YOUNG_MODULUS": 1e4, "POISSON_RATIO": 0.3, "DENSITY": 0.0});
    let mut deck = Deck::new(grid, element, &law, material);
    deck.set("solver_type", json!("Dynamic")).set("scheme_type", json!("newmark"));
    deck.set("time_integration_method", json!("implicit")).set("max_iteration", json!(60)).steps(dt, end);
    let kind = if dim == 2 { "LineCondition" } else { "SurfaceCondition" };
    let end = deck.facets(|p| p[0] == 1.0, kind);
    couple(&mut deck, DISTRIBUTING, &end, (REFERENCE, point), more);
    deck.output(&["ROTATION", "VELOCITY", "ANGULAR_VELOCITY"]);
    deck
}

/// ANALYTIC: a force that grows with t on a mass that a light body carries, over 20 steps: the momentum is its impulse, m v = ∫ F dt, and
/// the moment gives J ω = ∫ M dt; the trapezoidal rule of Newmark's method is exact for both.
#[test]
fn a_carried_mass_takes_the_impulse() {
    for (shape, leads) in [Shape::Quad4, Shape::Hex8].into_iter().flat_map(|shape| [(shape, false), (shape, true)]) {
        let dim = shape.dim();
        let grid = Grid::new(shape, &[2, 2, 2][..dim], |p| p);
        let inertia = if dim == 2 { json!(0.3) } else { json!([0.2, 0.25, 0.3]) };
        let point = if dim == 2 { [1.4, 0.3, 0.0] } else { [1.4, 0.3, 0.6] };
        let mut deck = carried(
            &grid,
            false,
            (0.1, 2.0),
            point,
            json!({"mass": 2.0, "inertia": inertia, "reference_node_leads": leads}),
        );
        load(&mut deck, "POINT_LOAD", by_time([0.05, -0.02, 0.0]));
        load(&mut deck, "POINT_MOMENT", by_time([0.0, 0.0, 1e-3]));
        let ran = deck.run();
        let node = grid.nodes.len();
        for step in [0, 9, 19] {
            let time = 0.1 * (step + 1) as f64;
            let (v, omega) = (ran.vector("VELOCITY", node, step), ran.vector("ANGULAR_VELOCITY", node, step));
            let what = format!("{shape:?} {leads} step {step}");
            assert_close(2.0 * v[0], 0.5 * 0.05 * time * time, 1e-8, &what);
            assert_close(2.0 * v[1], -0.5 * 0.02 * time * time, 1e-8, &what);
            assert_close(0.3 * omega[2], 0.5 * 1e-3 * time * time, 1e-8, &what);
        }
    }
}

/// ANALYTIC: a mass m at the end of a light bar oscillates along it, u_n = v₀/ω sin nΩ with ω² = EA/(L m) and tan Ω/2 = ω Δt/2 in the steps of
/// Newmark's method; the initial velocity of the mass is that of the end.
#[test]
fn a_mass_at_the_end_of_a_bar_oscillates() {
    let (length, mass, young, dt, speed) = (4.0, 5.0, 1e4, 0.01, 0.2);
    let grid = Grid::new(Shape::Hex8, &[4, 1, 1], |p| [length * p[0], p[1] - 0.5, p[2] - 0.5]);
    let more = json!({"mass": mass});
    let mut deck = carried(&grid, false, (dt, 0.4), [length, 0.0, 0.0], more);
    deck.fix(|p| p[0] == 0.0, [zero(), zero(), zero()]);
    deck.fix(|_| true, [FREE, zero(), zero()]);
    let settings = json!({"model_part_name": "Structure", "variable_name": "VELOCITY",
        "constrained": [false, false, false], "value": [format!("{:?}*X", speed / length), "0.0", "0.0"],
        "interval": [0.0, 0.0]});
    deck.process("assign_vector_variable_process", settings);
    let ran = deck.run();
    // The bar is held across: its modulus is E (1 − ν)/((1 + ν)(1 − 2ν)).
    let omega = (young * 0.7 / (1.3 * 0.4) / (length * mass)).sqrt();
    let step_angle = 2.0 * (0.5 * omega * dt).atan();
    for step in [0, 10, 20, 39] {
        let expected = speed / omega * (step_angle * (step + 1) as f64).sin();
        let found = ran.vector("DISPLACEMENT", grid.nodes.len(), step)[0];
        assert!((found - expected).abs() < 1e-8 * speed / omega, "step {step}: {found} {expected}");
    }
}

/// ANALYTIC: a shaft that its reference node turns three times about an oblique axis: no strain, and ROTATION counts on to 6π, in the
/// report too. A distributing coupling at its other end counts alike.
#[test]
fn a_shaft_turns_three_times() {
    let axis = [2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0];
    let theta = scale(axis, 3.0 * TAU);
    let grid = Grid::new(Shape::Hex8, &[3, 1, 1], |p| [3.0 * p[0], p[1] - 0.5, p[2] - 0.5]);
    let material = json!({"YOUNG_MODULUS": 100.0, "POISSON_RATIO": 0.3});
    let mut deck = Deck::new(&grid, "TotalLagrangianElement", law(3), material);
    deck.steps(1.0 / 60.0, 1.0);
    let [start, end] = [0.0, 1.0].map(|x| deck.facets(move |p| p[0] == x, "SurfaceCondition"));
    let [point, far] = [[0.0, 0.2, 0.1], [3.5, 0.0, 0.0]];
    couple(&mut deck, KINEMATIC, &start, (REFERENCE, point), json!({}));
    couple(&mut deck, DISTRIBUTING, &end, ("Structure.Far", far), json!({}));
    hold(&mut deck, "DISPLACEMENT", [zero(), zero(), zero()]);
    hold(&mut deck, "ROTATION", by_time(theta).map(Value::from));
    deck.output(&["ROTATION", "REACTION_MOMENT"]);
    let ran = deck.run();
    let off = off_rigid(&ran, &grid, 59, (theta, point, [0.0; 3]));
    let moment = norm(ran.last("REACTION_MOMENT", grid.nodes.len()));
    println!("off {off:.1e}, moment {moment:.1e}");
    assert!(off < 1e-10 && moment < 1e-8, "{off:e} {moment:e}");
    for reference in [REFERENCE, "Structure.Far"] {
        for (c, axis) in ["X", "Y", "Z"].iter().enumerate() {
            let found = ran.last_number(&format!("ROTATION_{axis} of {reference}"));
            assert_close(found, theta[c], 1e-9, &format!("{reference} {axis}"));
        }
    }
}

/// ANALYTIC: a ball at the reference node of a distributing coupling, which a light body carries along: with the initial spin of the body both
/// turn three times, in space about an oblique axis, and the ball stays in its place.
#[test]
fn a_carried_ball_spins() {
    for shape in [Shape::Quad4, Shape::Hex8] {
        let dim = shape.dim();
        let axis = if dim == 2 { [0.0, 0.0, 1.0] } else { [2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0] };
        let omega = scale(axis, 3.0 * TAU);
        let grid = Grid::new(shape, &[1, 2, 1][..dim], |p| [p[0], p[1] - 0.5, if dim == 2 { 0.0 } else { p[2] - 0.5 }]);
        let point = [1.0, 0.0, 0.0];
        let more = json!({"mass": 2.0, "inertia": if dim == 2 { json!(0.4) } else { json!([0.4, 0.4, 0.4]) }});
        let mut deck = carried(&grid, true, (0.005, 1.0), point, more);
        let [x, y, z] = omega;
        let velocity =
            [format!("{y:?}*Z-({z:?})*Y"), format!("{z:?}*(X-1.0)-({x:?})*Z"), format!("{x:?}*Y-({y:?})*(X-1.0)")];
        let settings = json!({"model_part_name": "Structure", "variable_name": "VELOCITY",
            "constrained": [false, false, false], "value": velocity, "interval": [0.0, 0.0]});
        deck.process("assign_vector_variable_process", settings);
        let ran = deck.run();
        let node = grid.nodes.len();
        let slow = 200.0 * 2.0 * (0.5 * 0.005 * norm(omega)).atan() / norm(omega);
        let (theta, u) = (ran.last("ROTATION", node), ran.last("DISPLACEMENT", node));
        println!("{shape:?}: {:.1e} {:.1e}", distance(theta, scale(omega, slow)), norm(u));
        assert!(distance(theta, scale(omega, slow)) < 1e-6 && norm(u) < 1e-7, "{theta:?} {u:?}");
        let off = off_rigid(&ran, &grid, 199, (theta, point, [0.0; 3]));
        assert!(off < 1e-6, "{shape:?}: {off:e}");
    }
}

/// ANALYTIC: a ball that spins freely about an oblique axis for three turns keeps its angular velocity; its rotations are unknowns all the
/// while.
#[test]
fn a_ball_spins_three_times() {
    let omega = scale([2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0], 3.0 * TAU);
    let grid = Grid::new(Shape::Hex8, &[1, 1, 1], |p| p);
    let material = json!({"YOUNG_MODULUS": 100.0, "POISSON_RATIO": 0.3, "DENSITY": 0.0});
    let mut deck = Deck::new(&grid, "TotalLagrangianElement", law(3), material);
    deck.set("solver_type", json!("Dynamic")).set("scheme_type", json!("newmark"));
    deck.set("time_integration_method", json!("implicit")).set("max_iteration", json!(60)).steps(0.005, 1.0);
    let all = deck.nodes(|_| true);
    let more = json!({"mass": 2.0, "inertia": [0.4, 0.4, 0.4]});
    couple(&mut deck, KINEMATIC, &all, (REFERENCE, [0.5, 0.5, 0.5]), more);
    let settings = json!({"model_part_name": REFERENCE, "variable_name": "ANGULAR_VELOCITY",
        "constrained": [false, false, false], "value": omega, "interval": [0.0, 0.0]});
    deck.process("assign_vector_variable_process", settings);
    deck.output(&["ROTATION", "ANGULAR_VELOCITY"]);
    let ran = deck.run();
    let node = grid.nodes.len();
    let theta = ran.last("ROTATION", node);
    let iterations = ran.report.steps.iter().map(|step| step.iterations.len()).max();
    println!("{:.2e} {iterations:?}", distance(theta, omega) / norm(omega));
    // Newmark's method advances a spin of 0.094 a step by 2 tan⁻¹ of half of it: 0.07 % less.
    let slow = 200.0 * 2.0 * (0.5 * 0.005 * norm(omega)).atan();
    assert!(distance(theta, scale(omega, slow / norm(omega))) < 1e-6, "{theta:?} {omega:?}");
    let along = dot(theta, omega) / norm(omega);
    assert!(along > 5.9 * PI, "{along}");
}
