//! Rigid shapes as masters of contact: closed forms of indentation, rolling, and bad input.

use std::f64::consts::PI;

use serde_json::{Value, json};
use zelus_core::geometry::Shape;
use zelus_core::vector3::{add, cross, dot, norm, sub};

use super::deck::{Deck, Ran, assert_close};
use super::grid::{Grid, Vec3};

pub(super) const FREE: Value = Value::Null;
pub(super) const REFERENCE: &str = "Structure.Point";
pub(super) const TOOL: &str = "Structure.Tool";

pub(super) fn zero() -> Value {
    json!(0.0)
}

/// A grid graded away from its corner at x = 0 and the top: `fine` cells over 1.5 sizes, then `coarse` ones up to `far` sizes.
fn graded(shape: Shape, size: f64, [fine, coarse]: [usize; 2], far: f64) -> Grid {
    let count = fine + coarse;
    let place = move |s: f64| {
        let n = s * count as f64;
        if n <= fine as f64 {
            return 1.5 * size * n / fine as f64;
        }
        // Cells that grow by one ratio, the first as large as the fine ones.
        let (first, rest) = (1.5 * size / fine as f64, (far - 1.5) * size);
        let (mut low, mut high) = (1.0, 3.0);
        for _ in 0..100 {
            let q: f64 = 0.5 * (low + high);
            let sum = first * q * (q.powi(coarse as i32) - 1.0) / (q - 1.0);
            if sum < rest { low = q } else { high = q }
        }
        let q: f64 = 0.5 * (low + high);
        1.5 * size + first * q * (q.powf(n - fine as f64) - 1.0) / (q - 1.0)
    };
    let dim = shape.dim();
    Grid::new(shape, &[count, count, count][..dim], move |p| {
        let depth = -place(1.0 - p[dim - 1]);
        if dim == 2 { [place(p[0]), depth, 0.0] } else { [place(p[0]), place(p[1]), depth] }
    })
}

/// Contact of the side of a body with a tool of this shape at a position.
pub(super) fn contact(deck: &mut Deck<'_>, slave: &str, tool: Value, position: Vec3, more: Value) {
    let mut settings = json!({"model_part_name": TOOL, "reference_model_part_name": REFERENCE, "shape": tool,
        "position": position});
    more.as_object().into_iter().flatten().for_each(|(key, value)| settings[key] = value.clone());
    deck.process("rigid_shape_process", settings);
    deck.set("convergence_criterion", json!("contact_residual_criterion"));
    deck.set("contact_settings", json!({"mortar_type": "ALMContactFrictionless"}));
    deck.process(
        "alm_contact_process",
        json!({"model_part_name": "Structure", "contact_type": "Frictionless",
            "contact_model_part": {"0": [format!("Structure.{slave}"), TOOL]},
            "assume_master_slave": {"0": [format!("Structure.{slave}")]}}),
    );
}

/// Prescribes displacement or rotation of the reference node, `null` leaving a component free.
pub(super) fn hold(deck: &mut Deck<'_>, variable: &str, value: [Value; 3]) {
    let constrained: Vec<bool> = value.iter().map(|v| !v.is_null()).collect();
    let settings = json!({"model_part_name": REFERENCE, "variable_name": variable, "constrained": constrained,
        "value": value, "interval": [0.0, "End"]});
    deck.process("assign_vector_variable_process", settings);
}

/// A force on the reference node, which grows with t.
pub(super) fn press(deck: &mut Deck<'_>, force: Vec3) {
    let value = force.map(|v| json!(format!("{v:?}*t")));
    let settings = json!({"model_part_name": REFERENCE, "variable_name": "POINT_LOAD", "value": value});
    deck.process("assign_vector_variable_to_conditions_process", settings);
}

/// Radius and largest pressure of p² = p₀² (1 − x²/a²), by least squares over the nodes of the surface.
fn hertz(ran: &Ran, grid: &Grid, surface: &[usize]) -> [f64; 2] {
    let points: Vec<[f64; 2]> = surface
        .iter()
        .map(|&node| {
            let [x, p] = [grid.nodes[node][0], ran.scalar("CONTACT_PRESSURE", node)];
            [x * x, p * p]
        })
        .filter(|[_, p]| *p > 0.0)
        .collect();
    // The outermost nodes bear a part of their share.
    let edge = points.iter().map(|[x, _]| *x).fold(0.0, f64::max);
    let inner: Vec<[f64; 2]> = points.into_iter().filter(|[x, _]| *x < 0.7 * edge).collect();
    let count = inner.len() as f64;
    let mean = |of: &dyn Fn(&[f64; 2]) -> f64| inner.iter().map(of).sum::<f64>() / count;
    let (x, p) = (mean(&|own| own[0]), mean(&|own| own[1]));
    let slope = mean(&|own| (own[0] - x) * (own[1] - p)) / mean(&|own| (own[0] - x).powi(2));
    let top = p - slope * x;
    [(-top / slope).sqrt(), top.sqrt()]
}

/// ANALYTIC: Hertz' contact of a rigid cylinder, pressed by a force F a length on a half-plane in plane strain: a = √(4 F R/(π E*)),
/// p₀ = 2 F/(π a). The block is 30 half-widths wide and deep; 21 cells on the half-width.
#[test]
fn a_rigid_cylinder_indents_a_half_plane() {
    let (young, poisson, radius, width) = (1000.0, 0.3, 50.0, 1.0);
    let stiffness = young / (1.0 - poisson * poisson);
    let force = PI * stiffness * width * width / (4.0 * radius);
    for shape in [Shape::Quad4, Shape::Tri3] {
        let grid = graded(shape, width, [32, 18], 30.0);
        let material = json!({"YOUNG_MODULUS": young, "POISSON_RATIO": poisson});
        let mut deck = Deck::new(&grid, "SmallDisplacementElement", "LinearElasticPlaneStrain2DLaw", material);
        deck.fix(|p| p[1] == 0.0, [zero(), zero(), zero()]);
        deck.fix(|p| p[0] == 0.0, [zero(), FREE, FREE]);
        let top = deck.facets(|p| p[1] == 1.0 && p[0] < 0.7, "LineCondition");
        contact(&mut deck, &top, json!({"name": "cylinder", "radius": radius}), [0.0, radius, 0.0], json!({}));
        hold(&mut deck, "DISPLACEMENT", [zero(), FREE, FREE]);
        hold(&mut deck, "ROTATION", [FREE, FREE, zero()]);
        press(&mut deck, [0.0, -0.5 * force, 0.0]);
        deck.output(&["CONTACT_PRESSURE"]);
        let ran = deck.run();
        let surface = grid.nodes_where(|p| p[1] == 1.0);
        let [a, p0] = hertz(&ran, &grid, &surface);
        println!("{shape:?}: a {a:.4} of {width}, p0 {p0:.4} of {:.4}", 2.0 * force / (PI * width));
        assert_close(a, width, 0.01, "half-width");
        assert_close(p0, 2.0 * force / (PI * width), 0.02, "largest pressure");
    }
}

const YOUNG: f64 = 1000.0;
const POISSON: f64 = 0.3;

/// E* = E/(1 − ν²).
fn stiffness() -> f64 {
    YOUNG / (1.0 - POISSON * POISSON)
}

/// A half-space in the plane or about an axis, indented by a force on a tool.
fn indented(grid: &Grid, about_axis: bool, tool: Value, position: Vec3, force: f64) -> Ran {
    let material = json!({"YOUNG_MODULUS": YOUNG, "POISSON_RATIO": POISSON});
    let (element, law, condition) = match about_axis {
        true => ("AxisymSmallDisplacementElement", "LinearElasticAxisym2DLaw", "LineCondition"),
        false => ("SmallDisplacementElement", "LinearElasticPlaneStrain2DLaw", "LineCondition"),
    };
    let mut deck = Deck::new(grid, element, law, material);
    deck.fix(|p| p[1] == 0.0, [zero(), zero(), zero()]);
    deck.fix(|p| p[0] == 0.0, [zero(), FREE, FREE]);
    let top = deck.facets(|p| p[1] == 1.0 && p[0] < 0.7, condition);
    contact(&mut deck, &top, tool, position, json!({"facet_angle": 2.0}));
    if about_axis {
        let last = deck.last_process();
        last["alternative_formulations"] = json!({"axisymmetric": true});
    } else {
        hold(&mut deck, "DISPLACEMENT", [zero(), FREE, FREE]);
        hold(&mut deck, "ROTATION", [FREE, FREE, zero()]);
    }
    press(&mut deck, [0.0, -force, 0.0]);
    deck.output(&["CONTACT_PRESSURE"]);
    deck.run()
}

/// ANALYTIC: Hertz' contact of a rigid sphere in a model about an axis: a³ = 3 F R/(4 E*), p₀ = 3 F/(2π a²). As above.
#[test]
fn a_rigid_sphere_indents_a_half_space_about_an_axis() {
    let (radius, width) = (50.0, 1.0);
    let force = 4.0 * stiffness() * width * width * width / (3.0 * radius);
    let grid = graded(Shape::Quad4, width, [32, 18], 30.0);
    let ran = indented(&grid, true, json!({"name": "sphere", "radius": radius}), [0.0, radius, 0.0], force);
    let surface = grid.nodes_where(|p| p[1] == 1.0);
    let [a, p0] = hertz(&ran, &grid, &surface);
    let exact = 1.5 * force / (PI * width * width);
    println!("a {a:.4} of {width}, p0 {p0:.4} of {exact:.4}");
    assert_close(a, width, 0.01, "radius of contact");
    assert_close(p0, exact, 0.02, "largest pressure");
}

/// Largest error of the pressure p_m arccosh(a/r) at nodes from 0.2 a to 0.8 a.
fn off_cone(ran: &Ran, grid: &Grid, mean: f64, a: f64) -> f64 {
    let surface = grid.nodes_where(|p| p[1] == 1.0);
    let own = surface.into_iter().map(|node| (grid.nodes[node][0], ran.scalar("CONTACT_PRESSURE", node)));
    let inner = own.filter(|(r, _)| (0.2 * a..0.8 * a).contains(r));
    inner.map(|(r, p)| (p / (mean * (a / r).acosh()) - 1.0).abs()).fold(0.0, f64::max)
}

/// ANALYTIC: Sneddon's cone of the half angle α, F = ½ π E* a² cot α and p = ½ E* cot α arccosh(a/r); and the wedge in plane strain,
/// F = E* a cot α and p = E*/π cot α arccosh(a/x).
#[test]
fn a_rigid_cone_and_a_wedge_indent_a_half_space() {
    let (width, slope) = (1.0, 0.02_f64);
    let tool = json!({"name": "cone", "half_angle": (1.0 / slope).atan().to_degrees(), "height": 0.5});
    let grid = graded(Shape::Quad4, width, [64, 20], 30.0);
    for (about_axis, force, mean) in [
        (true, 0.5 * PI * stiffness() * width * width * slope, 0.5 * stiffness() * slope),
        (false, 0.5 * stiffness() * width * slope, stiffness() * slope / PI),
    ] {
        let ran = indented(&grid, about_axis, tool.clone(), [0.0; 3], force);
        let off = off_cone(&ran, &grid, mean, width);
        println!("about an axis {about_axis}: {off:.2e}");
        assert!(off < 0.02, "about an axis {about_axis}: {off}");
    }
}

/// ANALYTIC: Hertz' contact of a rigid sphere in space on a quarter of a block: a³ = 3 F R/(4 E*), p₀ = 3 F/(2π a²). The block is 15
/// radii wide; 10 cells on the radius.
#[test]
fn a_rigid_sphere_indents_a_half_space_in_space() {
    let (radius, width) = (50.0, 1.0);
    let force = 4.0 * stiffness() * width * width * width / (3.0 * radius);
    let grid = graded(Shape::Hex8, width, [15, 8], 15.0);
    let material = json!({"YOUNG_MODULUS": YOUNG, "POISSON_RATIO": POISSON});
    let mut deck = Deck::new(&grid, "SmallDisplacementElement", "LinearElastic3DLaw", material);
    deck.fix(|p| p[2] == 0.0, [zero(), zero(), zero()]);
    deck.fix(|p| p[0] == 0.0, [zero(), FREE, FREE]);
    deck.fix(|p| p[1] == 0.0, [FREE, zero(), FREE]);
    let top = deck.facets(|p| p[2] == 1.0 && p[0] < 0.65 && p[1] < 0.65, "SurfaceCondition");
    contact(&mut deck, &top, json!({"name": "sphere", "radius": radius}), [0.0, 0.0, radius], json!({}));
    hold(&mut deck, "DISPLACEMENT", [zero(), zero(), FREE]);
    hold(&mut deck, "ROTATION", [zero(), zero(), zero()]);
    press(&mut deck, [0.0, 0.0, -0.25 * force]);
    deck.output(&["CONTACT_PRESSURE"]);
    let ran = deck.run();
    let surface = grid.nodes_where(|p| p[2] == 1.0 && p[1] == 0.0);
    let [a, p0] = hertz(&ran, &grid, &surface);
    let exact = 1.5 * force / (PI * width * width);
    println!("a {a:.4} of {width}, p0 {p0:.4} of {exact:.4}");
    assert_close(a, width, 0.01, "radius of contact");
    assert_close(p0, exact, 0.02, "largest pressure");
}

/// A turn about a slanted axis, and a shift.
fn turned(p: Vec3) -> Vec3 {
    let axis = [1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0];
    let (sin, cos) = 0.7_f64.sin_cos();
    let (across, along) = (cross(axis, p), dot(axis, p) * (1.0 - cos));
    std::array::from_fn(|c| p[c] * cos + across[c] * sin + axis[c] * along)
}

/// A block below a tool that is pushed down, drawn aside and turned: force and moment of the tool, and those of the supports about
/// the reference node, in the axes of the block.
fn drawn(tool: &Value, height: f64, unit: f64, is_turned: bool, angle: f64) -> [Vec3; 4] {
    let place = |p: Vec3| if is_turned { add(turned(p), [3.0 * unit, -2.0 * unit, unit]) } else { p };
    let turn = |v: Vec3| if is_turned { turned(v) } else { v };
    let grid = Grid::new(Shape::Hex8, &[6, 4, 2], |p| {
        place([(3.0 * p[0] - 1.5) * unit, (2.0 * p[1] - 1.0) * unit, (p[2] - 1.0) * unit])
    });
    let material = json!({"YOUNG_MODULUS": YOUNG, "POISSON_RATIO": POISSON});
    let mut deck = Deck::new(&grid, "TotalLagrangianElement", "KirchhoffSaintVenant3DLaw", material);
    deck.fix(|p| p[2] == 0.0, [zero(), zero(), zero()]).steps(0.5, 1.0);
    let top = deck.facets(|p| p[2] == 1.0, "SurfaceCondition");
    let point = place([0.6 * unit, 0.3 * unit, (height + 0.2) * unit]);
    let more = json!({"axis": turn([0.0, 0.0, 1.0]), "first_axis": turn([1.0, 0.0, 0.0]), "facet_angle": angle, "reference_point": point});
    contact(&mut deck, &top, tool.clone(), place([0.1 * unit, 0.05 * unit, height * unit]), more);
    deck.last_process()["integration_order"] = json!(5);
    let way = turn([0.03 * unit, 0.01 * unit, -0.04 * unit]);
    hold(&mut deck, "DISPLACEMENT", way.map(|u| json!(format!("{u:?}*t"))));
    let rotation = turn([0.02, 0.005, 0.0]);
    hold(&mut deck, "ROTATION", rotation.map(|u| json!(format!("{u:?}*t"))));
    let ran = deck.run();
    let last = ran.times().len() - 1;
    let number = |name: &str| ["X", "Y", "Z"].map(|c| ran.last_number(&format!("{name}_{c} of {REFERENCE}")));
    let (force, moment) = (number("REACTION"), number("REACTION_MOMENT"));
    let at = add(point, way);
    let [mut of_supports, mut about] = [[0.0; 3]; 2];
    for node in grid.nodes_where(|p| p[2] == 0.0) {
        let reaction = ran.vector("REACTION", node, last);
        of_supports = add(of_supports, reaction);
        about = add(about, cross(sub(grid.nodes[node], at), reaction));
    }
    // Back to the axes of the block.
    let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(turn);
    [force, moment, of_supports, about].map(|v| axes.map(|axis| dot(axis, v)))
}

fn off(a: Vec3, b: Vec3) -> f64 {
    norm(sub(a, b)) / norm(b)
}

/// ANALYTIC: the force of a tool that is drawn across a block balances that of the supports to round-off, its moment to
/// gaps, which mortar methods close in the mean; and the answer is the same when all is
/// turned in space and shifted, and in other units (to the tolerance of the solver). Curved tools, rotating too. With
/// coarser facets the force changes by the dual functions of pairs, on a slave whose cells are as wide as the contact.
#[test]
fn force_and_moment_balance_wherever_the_shape_is() {
    let profile = json!({"name": "revolution", "start": [0.0, -2.0], "segments": [
        {"arc_to": [2.0, 0.0], "centre": [0.0, 0.0]}, {"line_to": [2.0, 1.0]}]});
    for (tool, height) in [
        (json!({"name": "sphere", "radius": 2.0}), 2.0),
        (profile, 2.0),
        (json!({"name": "cone", "half_angle": 60.0, "height": 1.0, "tip_radius": 2.0}), 0.0),
    ] {
        let [force, moment, of_supports, about] = drawn(&tool, height, 1.0, false, 5.0);
        let scaled = |v: Vec3| v.map(|x| -x);
        println!(
            "{tool}: {force:?} {moment:?}: {:.1e} {:.1e}",
            off(scaled(of_supports), force),
            off(scaled(about), moment)
        );
        assert!(force[2] < -0.5, "{tool}: {force:?}");
        assert!(off(scaled(of_supports), force) < 1e-8, "{tool}: {force:?} {of_supports:?}");
        assert!(off(scaled(about), moment) < 1e-3, "{tool}: {moment:?} {about:?}");
        let other = drawn(&tool, height, 1.0, true, 5.0);
        println!("turned: {:.1e} {:.1e}", off(other[0], force), off(other[1], moment));
        assert!(off(other[0], force) < 1e-9 && off(other[1], moment) < 1e-9, "{tool}: {other:?}");
        let coarse = drawn(&tool, height, 1.0, false, 12.0);
        println!("coarse: {:.1e} {:.1e}", off(coarse[0], force), off(coarse[1], moment));
        assert!(off(coarse[0], force) < 6e-2, "{tool}: {coarse:?}");
    }
    let (tool, large) = (json!({"name": "sphere", "radius": 2.0}), json!({"name": "sphere", "radius": 2000.0}));
    let ([force, ..], [other, ..]) = (drawn(&tool, 2.0, 1.0, false, 5.0), drawn(&large, 2.0, 1000.0, false, 5.0));
    assert!(off(other.map(|f| 1e-6 * f), force) < 1e-8, "{force:?} {other:?}");
}

/// ANALYTIC: a plane presses a block without Poisson's ratio uniformly: its reaction is E A u/L. The same by the lower face of a box of an
/// STL file, whose units are others.
#[test]
fn planes_and_stl_surfaces_press_a_block() {
    let corner = |n: usize| [[-1.0, 1.0][n & 1], [-1.0, 1.0][n >> 1 & 1], [0.0, 1.0][n >> 2 & 1]].map(|x| 2.0 * x);
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let mut text = String::from("solid box\n");
    for [a, b, c, d] in quads {
        for triangle in [[a, b, c], [a, c, d]] {
            text += "facet normal 0 0 0\n outer loop\n";
            triangle.map(corner).iter().for_each(|x| text += &format!("  vertex {} {} {}\n", x[0], x[1], x[2]));
            text += " endloop\nendfacet\n";
        }
    }
    text += "endsolid box\n";
    let folder = tempfile::tempdir().expect("a scratch folder");
    let file = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).expect("a file");
        path.display().to_string()
    };
    let whole = file("box.stl", &text);
    let grid = Grid::new(Shape::Hex8, &[3, 2, 2], |p| [p[0] - 0.5, p[1] - 0.5, p[2] - 1.0]);
    let deck = |tool: Value, axis: Vec3| {
        let material = json!({"YOUNG_MODULUS": YOUNG, "POISSON_RATIO": 0.0});
        let mut deck = Deck::new(&grid, "SmallDisplacementElement", "LinearElastic3DLaw", material);
        deck.fix(|p| p[2] == 0.0, [zero(), zero(), zero()]);
        let top = deck.facets(|p| p[2] == 1.0, "SurfaceCondition");
        contact(&mut deck, &top, tool, [0.0; 3], json!({"axis": axis}));
        hold(&mut deck, "DISPLACEMENT", [zero(), zero(), json!("-0.01*t")]);
        hold(&mut deck, "ROTATION", [zero(), zero(), zero()]);
        deck
    };
    let down = [0.0, 0.0, -1.0];
    let planes = [
        (json!({"name": "plane", "size": [4.0, 3.0]}), down),
        (json!({"name": "stl", "file_name": whole.clone(), "scale": 0.5}), [0.0, 0.0, 1.0]),
    ];
    for (tool, axis) in planes {
        let ran = deck(tool.clone(), axis).run();
        let found = ran.number(&format!("REACTION_Z of {REFERENCE}"), 0);
        println!("{tool}: {found}");
        assert_close(found, -0.01 * YOUNG, 1e-9, &format!("{tool}"));
    }
    // Faults of files, named before the run.
    let without = text.replacen("facet", "# facet", 0);
    let lines: Vec<&str> = without.lines().collect();
    let open = file("open.stl", &[&lines[..1], &lines[8..]].concat().join("\n"));
    let inverted = file("inverted.stl", &{
        let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
        (0..12).for_each(|k| lines.swap(1 + 7 * k + 2, 1 + 7 * k + 3));
        lines.join("\n")
    });
    for (path, words) in [
        (open.as_str(), "is not closed: 3 edges"),
        (inverted.as_str(), "turned inside out"),
        ("nothing.stl", "cannot be read"),
    ] {
        let said = deck(json!({"name": "stl", "file_name": path}), down).problem();
        assert!(said.contains(words) && said.contains("stl-file"), "no {words:?} in: {said}");
    }
}

/// Shapes and decks that cannot be are named before the run.
#[test]
fn impossible_shapes_are_named() {
    let grid = Grid::new(Shape::Quad4, &[4, 2], |p| [p[0], p[1] - 1.0, 0.0]);
    let problem = |tool: Value, more: Value, change: &dyn Fn(&mut Value)| {
        let material = json!({"YOUNG_MODULUS": YOUNG, "POISSON_RATIO": 0.0});
        let mut deck = Deck::new(&grid, "SmallDisplacementElement", "LinearElasticPlaneStrain2DLaw", material);
        deck.fix(|p| p[1] == 0.0, [zero(), zero(), zero()]);
        let top = deck.facets(|p| p[1] == 1.0, "LineCondition");
        contact(&mut deck, &top, tool, [0.5, 1.0, 0.0], more);
        hold(&mut deck, "DISPLACEMENT", [zero(), zero(), FREE]);
        hold(&mut deck, "ROTATION", [FREE, FREE, zero()]);
        change(
            deck.processes_mut().iter_mut().find(|own| own["python_module"] == "alm_contact_process").expect("contact"),
        );
        deck.problem()
    };
    let circle = || json!({"name": "cylinder", "radius": 1.0});
    let same = |_: &mut Value| {};
    let cases: [(Value, Value, &dyn Fn(&mut Value), &[&str]); 8] = [
        (json!({"name": "sfere"}), json!({}), &same, &["sfere", "sphere"]),
        (json!({"name": "sphere", "radius": -1.0}), json!({}), &same, &["radius"]),
        (json!({"name": "cone", "height": 0.1, "tip_radius": 1.0}), json!({}), &same, &["within its rounded tip"]),
        (json!({"name": "torus", "radius": 1.0, "tube_radius": 2.0}), json!({}), &same, &["crosses itself"]),
        (
            json!({"name": "extrusion", "segments": [{"to": [1.0, 0.0]}]}),
            json!({}),
            &same,
            &["neither a line nor an arc"],
        ),
        (circle(), json!({"axis": [0.0, 0.0, 1.0]}), &same, &["not in the plane"]),
        (
            circle(),
            json!({}),
            &|own| own["Parameters"]["assume_master_slave"] = json!({"0": [TOOL]}),
            &["rigid-shape-sides"],
        ),
        (circle(), json!({}), &|own| own["Parameters"]["assume_master_slave"] = json!({}), &["rigid-shape-sides"]),
    ];
    for (tool, more, change, words) in cases {
        let said = problem(tool.clone(), more, change);
        for word in words {
            assert!(said.contains(word), "{tool}: no {word:?} in: {said}");
        }
    }
}

/// The force that draws a cylinder across a block with friction is that of the same cylinder meshed finely and moved at all its nodes.
#[test]
fn a_shape_is_as_the_same_tool_meshed() {
    let (radius, way) = (2.0, [0.1, -0.05, 0.0]);
    let block = || Grid::new(Shape::Quad4, &[48, 10], |p| [4.0 * p[0] - 2.0, 1.5 * (p[1] - 1.0), 0.0]);
    let material = json!({"YOUNG_MODULUS": YOUNG, "POISSON_RATIO": POISSON, "FRICTION_COEFFICIENT": 0.25});
    let motion = || [json!(format!("{}*t*t", way[0])), json!(format!("{}*(2.0*t - t*t)", way[1])), zero()];
    let frictional = |deck: &mut Deck<'_>| {
        deck.set("contact_settings", json!({"mortar_type": "ALMContactFrictional"}));
        deck.last_process()["contact_type"] = json!("Frictional");
    };
    let grid = block();
    let mut deck = Deck::new(&grid, "SmallDisplacementElement", "LinearElasticPlaneStrain2DLaw", material.clone());
    deck.fix(|p| p[1] == 0.0, [zero(), zero(), zero()]).steps(0.1, 1.0);
    let top = deck.facets(|p| p[1] == 1.0, "LineCondition");
    contact(&mut deck, &top, json!({"name": "cylinder", "radius": radius}), [0.0, radius, 0.0], json!({}));
    frictional(&mut deck);
    hold(&mut deck, "DISPLACEMENT", motion());
    hold(&mut deck, "ROTATION", [zero(), zero(), zero()]);
    let clock = std::time::Instant::now();
    let ran = deck.run();
    let time_of_shape = clock.elapsed();
    let last = ran.times().len() - 1;
    let force = ["X", "Y"].map(|c| ran.last_number(&format!("REACTION_{c} of {REFERENCE}")));

    let mut grid = block();
    let sector = Grid::new(Shape::Quad4, &[96, 1], |p| {
        let (sin, cos) = (1.2 * (p[0] - 0.5)).sin_cos();
        let r = radius * (0.8 + 0.2 * p[1]);
        [r * sin, radius - r * cos, 0.0]
    });
    let first = grid.nodes.len();
    grid.nodes.extend(sector.nodes);
    grid.reference.extend(sector.reference.iter().map(|p| [p[0] + 10.0, p[1], p[2]]));
    grid.cells.extend(sector.cells.iter().map(|cell| cell.iter().rev().map(|node| node + first).collect::<Vec<_>>()));
    let mut deck = Deck::new(&grid, "SmallDisplacementElement", "LinearElasticPlaneStrain2DLaw", material);
    deck.fix(|p| p[0] < 5.0 && p[1] == 0.0, [zero(), zero(), zero()]).steps(0.1, 1.0);
    deck.fix(|p| p[0] > 5.0, motion());
    let slave = deck.facets(|p| p[0] < 5.0 && p[1] == 1.0, "LineCondition");
    let master = deck.facets(|p| p[0] > 5.0 && p[1] == 1.0, "LineCondition");
    deck.set("convergence_criterion", json!("contact_residual_criterion"));
    deck.process(
        "alm_contact_process",
        json!({"model_part_name": "Structure", "contact_type": "Frictional",
            "contact_model_part": {"0": [format!("Structure.{slave}"), format!("Structure.{master}")]},
            "assume_master_slave": {"0": [format!("Structure.{slave}")]}}),
    );
    frictional(&mut deck);
    let clock = std::time::Instant::now();
    let ran = deck.run();
    let time = clock.elapsed();
    let meshed = ran.reaction(&grid.nodes_where(|p| p[0] > 5.0), last);
    println!("{force:?}, meshed {meshed:?}; {time_of_shape:?}, meshed {time:?}");
    assert!(force[1] < -1.0 && force[0] > 0.2 * force[1].abs(), "{force:?}");
    (0..2).for_each(|c| assert_close(force[c], meshed[c], 0.01, "force of the meshed tool"));
}

/// ANALYTIC: a disc and a ball that roll down a slope of an angle α without slip: a = g sin α / (1 + J/(m r²)), 2/3 and 5/7 of g sin α, and
/// the rotation x/r. The weight grows with t/T, so that they do not bounce: x = a T²/6. Tolerance: the slope is soft, so that contact spans
/// several of its cells.
#[test]
fn a_disc_and_a_ball_roll_down_a_slope() {
    let (angle, gravity, mass, radius, end) = (0.2_f64, 9.81, 1.0, 1.0, 1.2);
    let ball = ["TotalLagrangianElement", "KirchhoffSaintVenant3DLaw"];
    let disc = ["TotalLagrangianElement", "KirchhoffSaintVenantPlaneStrain2DLaw"];
    for (shape, counts, share, [element, law]) in
        [(Shape::Quad4, &[60, 3, 0][..2], 0.5, disc), (Shape::Hex8, &[10, 4, 2], 0.4, ball)]
    {
        let dim = shape.dim();
        let grid = Grid::new(shape, counts, |p| {
            let depth = 0.4 * (p[dim - 1] - 1.0);
            if dim == 2 { [3.0 * p[0], depth, 0.0] } else { [p[0], 0.4 * (p[1] - 0.5), depth] }
        });
        let young = if dim == 2 { 2e3 } else { 4e3 };
        let material =
            json!({"YOUNG_MODULUS": young, "POISSON_RATIO": 0.3, "DENSITY": 1e-3, "FRICTION_COEFFICIENT": 0.6});
        let mut deck = Deck::new(&grid, element, law, material);
        deck.set("solver_type", json!("Dynamic")).set("scheme_type", json!("newmark"));
        deck.set("time_integration_method", json!("implicit")).steps(0.02, end);
        deck.fix(|p| p[dim - 1] == 0.0, [zero(), zero(), zero()]);
        let kind = if dim == 2 { "LineCondition" } else { "SurfaceCondition" };
        let top = deck.facets(|p| p[dim - 1] == 1.0, kind);
        let mut place = [if dim == 2 { 0.8 } else { 0.3 }, 0.0, 0.0];
        place[dim - 1] = radius + 1e-3;
        let inertia = share * mass * radius * radius;
        let (name, inertia) = if dim == 2 { ("cylinder", json!(inertia)) } else { ("sphere", json!(vec![inertia; 3])) };
        let body = json!({"mass": mass, "inertia": inertia, "facet_angle": if dim == 2 { 5.0 } else { 30.0 }});
        contact(&mut deck, &top, json!({"name": name, "radius": radius}), place, body);
        deck.set("contact_settings", json!({"mortar_type": "ALMContactFrictional"}));
        deck.last_process()["contact_type"] = json!("Frictional");
        let mut weight = [mass * gravity * angle.sin(), 0.0, 0.0];
        weight[dim - 1] = -mass * gravity * angle.cos();
        let settings = json!({"model_part_name": REFERENCE, "variable_name": "POINT_LOAD", "value": weight.map(|w| json!(format!("{w}*t/{end}")))});
        deck.process("assign_vector_variable_to_conditions_process", settings);
        let ran = deck.run();
        let way = ran.last_number(&format!("DISPLACEMENT_X of {REFERENCE}"));
        let about = if dim == 2 { "ROTATION_Z" } else { "ROTATION_Y" };
        let turn = ran.last_number(&format!("{about} of {REFERENCE}")).abs();
        let expected = gravity * angle.sin() / (1.0 + share) * end * end / 6.0;
        println!("{shape:?}: way {way:.4}, expected {expected:.4}; rotation {turn:.4}, {} steps", ran.times().len());
        assert_close(way, expected, 0.02, "way down the slope");
        assert_close(turn, expected / radius, 0.03, "rotation");
    }
}

/// A cylinder pressed into a block and drawn aside meets the same force by each formulation, with and without friction. Tolerance: Nitsche's
/// method, without multipliers, and the others differ by the size of cells, 20 to the radius.
#[test]
fn a_shape_is_a_master_of_each_formulation() {
    let grid = Grid::new(Shape::Quad4, &[80, 10], |p| [4.0 * p[0] - 2.0, 0.5 * (p[1] - 1.0), 0.0]);
    let force = |kind: &str, coefficient: f64| {
        let material = json!({"YOUNG_MODULUS": 100.0, "POISSON_RATIO": 0.3, "FRICTION_COEFFICIENT": coefficient});
        let mut deck = Deck::new(&grid, "SmallDisplacementElement", "LinearElasticPlaneStrain2DLaw", material);
        deck.fix(|p| p[1] == 0.0, [zero(), zero(), zero()]).steps(0.25, 1.0);
        let top = deck.facets(|p| p[1] == 1.0, "LineCondition");
        contact(&mut deck, &top, json!({"name": "cylinder", "radius": 1.0}), [0.0, 1.0, 0.0], json!({}));
        let friction = if coefficient > 0.0 { "Frictional" } else { "Frictionless" };
        deck.set("contact_settings", json!({"mortar_type": format!("{kind}Contact{friction}")}));
        deck.last_process()["contact_type"] = json!(friction);
        let process = deck.processes_mut().last_mut().expect("the process of contact");
        process["python_module"] = json!(format!("{}_contact_process", kind.to_lowercase()));
        hold(
            &mut deck,
            "DISPLACEMENT",
            [json!(format!("{}*t*t", 0.2 * coefficient)), json!("-0.1*(2.0*t - t*t)"), zero()],
        );
        hold(&mut deck, "ROTATION", [zero(), zero(), zero()]);
        let ran = deck.run();
        [0, 1].map(|c| ran.last_number(&format!("REACTION_{} of {REFERENCE}", ["X", "Y"][c])))
    };
    for coefficient in [0.0, 0.3] {
        let [whole, penalty, nitsche] = ["ALM", "Penalty", "Nitsche"].map(|kind| force(kind, coefficient));
        println!("μ {coefficient}: {whole:?}, penalty {penalty:?}, Nitsche {nitsche:?}");
        assert!(whole[1] < -10.0, "{whole:?}");
        let off = |other: [f64; 2]| (other[0] - whole[0]).hypot(other[1] - whole[1]) / whole[0].hypot(whole[1]);
        assert!(off(penalty) < 2e-3, "{whole:?} {penalty:?}");
        assert!(off(nitsche) < 0.015, "{whole:?} {nitsche:?}");
    }
}
