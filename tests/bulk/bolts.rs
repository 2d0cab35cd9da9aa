//! Pretension of bolts: joint diagrams, sequences of bolts, sections that cannot be.

use serde_json::{Value, json};
use zelus_core::geometry::Shape;

use super::deck::{Deck, Ran};
use super::grid::{Grid, Vec3};

const FREE: Value = Value::Null;
const BOLT: &str = "bolt_pretension_process";

/// Adds a block to a grid; its places in the unit cube are shifted by `mark` along x.
fn add(grid: &mut Grid, divisions: &[usize], mark: f64, map: impl Fn(Vec3) -> Vec3) {
    let more = Grid::new(grid.shape, divisions, map);
    let first = grid.nodes.len();
    grid.nodes.extend(more.nodes);
    grid.reference.extend(more.reference.iter().map(|p| [p[0] + mark, p[1], p[2]]));
    grid.cells.extend(more.cells.iter().map(|cell| cell.iter().map(|node| node + first).collect()));
}

/// Length of the joint, and height of the contact in it.
const LENGTH: f64 = 4.0;
const CONTACT: f64 = 3.0;

fn is_of(mark: f64) -> impl Fn(Vec3) -> bool {
    move |p| p[0] >= mark - 0.5 && p[0] <= mark + 1.5
}

/// A joint: a bolt (mark 0) of stiffness 100, and clamped parts (marks 10 and 20) of stiffness 300 in contact, between a rigid head and
/// the ground. Everything moves along its axis only.
fn joint(shape: Shape, turn: &dyn Fn(Vec3) -> Vec3) -> Grid {
    let dim = shape.dim();
    let lay = |x: [f64; 2], y: [f64; 2]| {
        move |p: Vec3| {
            let [across, along, out] = if dim == 3 { [p[0], p[2], p[1]] } else { [p[0], p[1], 0.0] };
            turn([x[0] + (x[1] - x[0]) * across, y[0] + (y[1] - y[0]) * along, out])
        }
    };
    let divisions = |along: usize| if dim == 3 { vec![1, 1, along] } else { vec![1, along] };
    let mut grid = Grid::new(shape, &divisions(4), lay([0.0, 1.0], [0.0, LENGTH]));
    add(&mut grid, &divisions(3), 10.0, lay([2.0, 5.0], [0.0, CONTACT]));
    add(&mut grid, &divisions(1), 20.0, lay([2.0, 5.0], [CONTACT, LENGTH]));
    grid
}

/// Deck of a joint with the process of its bolt.
fn deck(grid: &Grid, mut settings: Value) -> (Deck<'_>, String) {
    let dim = grid.shape.dim();
    let law = if dim == 3 { "LinearElastic3DLaw" } else { "LinearElasticPlaneStress2DLaw" };
    let material = json!({"YOUNG_MODULUS": 400.0, "POISSON_RATIO": 0.0});
    let mut deck = Deck::new(grid, "SmallDisplacementElement", law, material);
    let along = dim - 1;
    deck.set("convergence_criterion", json!("contact_residual_criterion"));
    deck.set("contact_settings", json!({"mortar_type": "ALMContactFrictionless"}));
    deck.steps(1.0, 4.0);
    let bolt = format!("Structure.{}", deck.cells(is_of(0.0)));
    settings["model_part_name"] = json!(bolt);
    deck.process(BOLT, settings);
    // Guides across the axis.
    let guide = if dim == 3 { [json!(0.0), json!(0.0), FREE] } else { [json!(0.0), FREE, FREE] };
    deck.fix(|_| true, guide);
    let held: [Value; 3] = std::array::from_fn(|c| if c == along { json!(0.0) } else { FREE });
    deck.fix(|p| p[along] == 0.0 && p[0] < 15.0, held);
    let slave =
        deck.facets(|p| is_of(10.0)(p) && p[along] == 1.0, if dim == 3 { "SurfaceCondition" } else { "LineCondition" });
    let master =
        deck.facets(|p| is_of(20.0)(p) && p[along] == 0.0, if dim == 3 { "SurfaceCondition" } else { "LineCondition" });
    deck.process(
        "alm_contact_process",
        json!({"model_part_name": "Structure", "contact_type": "Frictionless",
            "contact_model_part": {"0": [format!("Structure.{slave}"), format!("Structure.{master}")]},
            "assume_master_slave": {"0": [format!("Structure.{slave}")]}}),
    );
    let head = deck.nodes(|p| p[along] == 1.0 && !is_of(10.0)(p));
    let variable = ["DISPLACEMENT_Y", "DISPLACEMENT_Z"][dim - 2];
    deck.process("impose_rigid_movement_process", json!({"model_part_name": head, "master_variable_name": variable}));
    let load = "5 if t < 2.5 else (13.333 if t < 3.5 else 14)";
    let load: [Value; 3] = std::array::from_fn(|c| if c == along { json!(load) } else { json!(0.0) });
    let settings = json!({"model_part_name": format!("Structure.{head}"), "load": load, "interval": [1.5, "End"]});
    deck.process("distribute_load_on_surface_process", settings);
    (deck, bolt)
}

fn axis(dim: usize) -> Vec3 {
    if dim == 3 { [0.0, 0.0, 1.0] } else { [0.0, 1.0, 0.0] }
}

/// Coordinates of the joint in space: its axis is z.
fn upright(dim: usize) -> impl Fn(Vec3) -> Vec3 {
    move |p| if dim == 3 { [p[0], p[2], p[1]] } else { p }
}

/// Force and shortening of the bolt, and the force on the ground below the clamped parts, in each step.
fn diagram(ran: &Ran, grid: &Grid, bolt: &str) -> Vec<[f64; 3]> {
    let along = grid.shape.dim() - 1;
    let ground = grid.nodes_where(|p| p[along] == 0.0 && is_of(10.0)(p));
    let numbers = |step: usize| {
        let [force, shortening] =
            ["force", "shortening"].map(|what| ran.number(&format!("{what} of bolt {bolt}"), step));
        [force, shortening, ran.reaction(&ground, step)[along]]
    };
    (0..ran.report.steps.len()).map(numbers).collect()
}

fn assert_near(found: &[f64], expected: &[f64], tolerance: f64, what: &str) {
    let off = found.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    println!("{what}: {off:.1e}");
    assert!(off < tolerance, "{what}: {found:?} instead of {expected:?}");
}

/// ANALYTIC: bolt and clamped parts are springs of stiffness 100 and 300. A preload of 10 shortens the section by 10/100 + 10/300. Then
/// the length is locked: an external load P gives the bolt 10 + P/4 and takes 3P/4 off the clamped parts, up to the separation at
/// P = 40/3; beyond it the bolt bears P alone. The tolerance is that of Newton's iteration.
#[test]
fn the_joint_diagram_is_exact() {
    for shape in [Shape::Hex8, Shape::Hex20, Shape::Tet4, Shape::Prism6, Shape::Quad4, Shape::Quad8, Shape::Tri3] {
        let dim = shape.dim();
        let grid = joint(shape, &upright(dim));
        let point = if dim == 3 { [0.5, 0.5, 1.9] } else { [0.5, 1.9, 0.0] };
        let settings = json!({"point": point, "normal": axis(dim), "force": "10*t", "interval": [0.0, 1.5]});
        let (deck, bolt) = deck(&grid, settings);
        let ran = deck.run();
        let found = diagram(&ran, &grid, &bolt);
        for step in &ran.report.steps {
            let forces = &step.balance.as_ref().expect("a balance").unknowns[0].forces;
            assert!(forces.relative < 1e-10, "{shape:?}: the force of the bolt acts between its sides: {forces:?}");
        }
        let locked = 10.0 / 100.0 + 10.0 / 300.0;
        let expected = [[10.0, 10.0], [11.25, 6.25], [13.33325, 0.00025], [14.0, 0.0]];
        for (step, ([bolt, shortening, clamp], [of_bolt, of_clamp])) in found.into_iter().zip(expected).enumerate() {
            let what = format!("{shape:?} step {step}");
            assert_near(&[bolt, clamp, shortening], &[of_bolt, of_clamp, locked], 1e-8, &what);
        }
    }
}

/// A rotation by 0.5 about z, in space by 0.7 about x after it.
fn turned(dim: usize, [x, y, z]: Vec3) -> Vec3 {
    let ((s, c), (t, d)) = (0.5_f64.sin_cos(), 0.7_f64.sin_cos());
    let [x, y] = [c * x - s * y, s * x + c * y];
    if dim == 2 { [x, y, z] } else { [x, d * y - t * z, t * y + d * z] }
}

/// A bar of 4 × 1 × 1 along `turned` x, fixed at both ends.
fn bar(shape: Shape, divisions: usize) -> Grid {
    let dim = shape.dim();
    let counts = [divisions, 2, 2];
    Grid::new(shape, &counts[..dim], |p| turned(dim, [LENGTH * p[0], p[1], p[2]]))
}

fn fixed_bar<'a>(grid: &'a Grid, element: &str) -> Deck<'a> {
    let dim = grid.shape.dim();
    let law = if dim == 3 { "LinearElastic3DLaw" } else { "LinearElasticPlaneStress2DLaw" };
    let mut deck = Deck::new(grid, element, law, json!({"YOUNG_MODULUS": 400.0, "POISSON_RATIO": 0.0}));
    let z = if dim == 3 { json!(0.0) } else { FREE };
    deck.fix(|p| p[0] == 0.0 || p[0] == 1.0, [json!(0.0), json!(0.0), z]);
    deck
}

/// ANALYTIC: a bar of stiffness 100 between walls, cut across an oblique axis by a plane between layers of elements or by faces: the force
/// F shortens it by F/100, the shortening s stretches it by 100 s, and each holds at locked length. Round-off alone differs.
#[test]
fn oblique_sections_are_exact() {
    for shape in
        [Shape::Hex8, Shape::Hex20, Shape::Hex27, Shape::Tet4, Shape::Tet10, Shape::Prism6, Shape::Quad8, Shape::Tri6]
    {
        let dim = shape.dim();
        let (force, shortening) = (6.0, 0.03);
        let [normal, point] = [[-3.0, 0.0, 0.0], [1.6, 0.2, 0.3]].map(|p| turned(dim, p));
        for (by_force, by_faces) in [(true, false), (false, false), (true, true)] {
            let grid = bar(shape, 5);
            let mut deck = fixed_bar(&grid, "SmallDisplacementElement");
            deck.steps(0.5, 2.0);
            let bolt = format!("Structure.{}", deck.cells(|_| true));
            let mut settings = json!({"model_part_name": bolt, "interval": [0.0, 1.2]});
            if by_faces {
                let kind = if dim == 3 { "SurfaceCondition" } else { "LineCondition" };
                // Each face is found from both sides: those of one side have normals along the bar.
                let section = deck.facets_once(|p| (p[0] - 0.4).abs() < 1e-9, kind);
                settings["section_model_part_name"] = json!(format!("Structure.{section}"));
            } else {
                (settings["point"], settings["normal"]) = (json!(point), json!(normal));
            }
            match by_force {
                true => settings["force"] = json!(format!("{force:?}*t")),
                false => settings["shortening"] = json!(format!("{shortening:?}*t")),
            }
            deck.process(BOLT, settings);
            let ran = deck.run();
            let last = if by_force { [force, force / 100.0] } else { [100.0 * shortening, shortening] };
            for step in 0..4 {
                let share = if step == 0 { 0.5 } else { 1.0 };
                let found = ["force", "shortening"].map(|what| ran.number(&format!("{what} of bolt {bolt}"), step));
                let expected = last.map(|value| share * value);
                assert_near(&found, &expected, 1e-11, &format!("{shape:?} {by_force} {by_faces} step {step}"));
            }
            let ends = [0.0, 1.0].map(|end| ran.reaction(&grid.nodes_where(|p| p[0] == end), 3));
            let pull = turned(dim, [last[0], 0.0, 0.0]);
            assert_near(&ends[1], &pull, 1e-10, &format!("{shape:?} reaction"));
            assert_near(&ends[0], &pull.map(|f| -f), 1e-10, &format!("{shape:?} reaction of the other end"));
        }
    }
}

/// ANALYTIC: where the whole skin may touch, the two sides of a section, which overlap, do not: the force F shortens a bar of stiffness
/// 100 by F/100.
#[test]
fn the_sides_of_a_section_are_not_in_contact() {
    for shape in [Shape::Hex8, Shape::Tet4, Shape::Quad4] {
        let grid = bar(shape, 5);
        let mut deck = fixed_bar(&grid, "SmallDisplacementElement");
        deck.set("convergence_criterion", json!("contact_residual_criterion"));
        deck.set("contact_settings", json!({"mortar_type": "ALMContactFrictionless"}));
        let bolt = format!("Structure.{}", deck.cells(|_| true));
        let [normal, point] = [[1.0, 0.0, 0.0], [1.6, 0.2, 0.3]].map(|p| turned(shape.dim(), p));
        deck.process(BOLT, json!({"model_part_name": bolt, "point": point, "normal": normal, "force": 6.0}));
        deck.process("alm_contact_process", json!({"model_part_name": "Structure", "contact_type": "Frictionless"}));
        let shortening = deck.run().number(&format!("shortening of bolt {bolt}"), 0);
        assert_near(&[shortening], &[0.06], 1e-10, &format!("{shape:?}"));
    }
}

/// ANALYTIC: two bars of stiffness 100 side by side between the ground and a plate on a spring, tightened one after the other: where the
/// second pulls the plate down by w₂ − w₁, the first loses its share at locked length.
#[test]
fn bolts_are_tightened_in_sequence() {
    let mut grid = Grid::new(Shape::Hex8, &[1, 1, 2], |p| [p[0], p[1], LENGTH * p[2]]);
    add(&mut grid, &[1, 1, 2], 10.0, |p| [2.0 + p[0], p[1], LENGTH * p[2]]);
    add(&mut grid, &[1, 1, 2], 20.0, |p| [4.0 + 2.0 * p[0], p[1], LENGTH * p[2]]);
    let material = json!({"YOUNG_MODULUS": 400.0, "POISSON_RATIO": 0.0});
    let mut deck = Deck::new(&grid, "SmallDisplacementElement", "LinearElastic3DLaw", material);
    deck.steps(1.0, 3.0);
    let mut bolts = Vec::new();
    for (mark, force, interval) in [(0.0, 10.0, [0.5, 1.5]), (10.0, 6.0, [1.5, 2.5])] {
        let bolt = format!("Structure.{}", deck.cells(is_of(mark)));
        let plane = json!({"model_part_name": bolt, "point": [0.0, 0.0, 2.0], "normal": [0.0, 0.0, 1.0],
            "force": force, "interval": interval});
        deck.process(BOLT, plane);
        bolts.push(bolt);
    }
    deck.fix(|_| true, [json!(0.0), json!(0.0), FREE]).fix(|p| p[2] == 0.0, [FREE, FREE, json!(0.0)]);
    let head = deck.nodes(|p| p[2] == 1.0);
    let settings = json!({"model_part_name": head, "master_variable_name": "DISPLACEMENT_Z"});
    deck.process("impose_rigid_movement_process", settings);
    let ran = deck.run();
    // The spring is the third bar, of stiffness 200. Step 1: 10 + 300 w₁ = 0. Step 2: 6 + 10 + 100 (w₂ − w₁) + 200 w₂ = 0.
    let first = -10.0 / 300.0;
    let second = -(6.0 + 10.0 - 100.0 * first) / 300.0;
    let held = 10.0 + 100.0 * (second - first);
    let expected = [[10.0, 100.0 * first], [held, 6.0], [held, 6.0]];
    for (step, expected) in expected.into_iter().enumerate() {
        let found = [0, 1].map(|at: usize| ran.number(&format!("force of bolt {}", bolts[at]), step));
        assert_near(&found, &expected, 1e-11, &format!("forces of step {step}"));
    }
}

/// Sections that cannot be, and settings that contradict each other, are named before the run.
#[test]
fn mistakes_are_named() {
    let problem = |change: &dyn Fn(&mut Value, &mut Deck<'_>)| {
        let grid = bar(Shape::Hex8, 5);
        let mut deck = fixed_bar(&grid, "SmallDisplacementElement");
        let bolt = deck.cells(|_| true);
        let mut settings = json!({"model_part_name": format!("Structure.{bolt}"), "force": 1.0,
            "point": turned(3, [1.6, 0.0, 0.0]), "normal": turned(3, [1.0, 0.0, 0.0])});
        change(&mut settings, &mut deck);
        deck.process(BOLT, settings);
        deck.problem()
    };
    let cases: [(&dyn Fn(&mut Value, &mut Deck<'_>), &[&str]); 9] = [
        (&|own, _| own["point"] = json!([50.0, 0.0, 0.0]), &["bolt-section", "misses Structure.Part"]),
        (&|own, _| own["normal"] = json!([0.0, 0.0, 0.0]), &["invalid-direction", "\"normal\" has no length"]),
        (&|own, _| own["normal"] = Value::Null, &["missing-key", "\"normal\" is not given"]),
        (&|own, _| own["shortening"] = json!(1.0), &["both tighten the bolt"]),
        (&|own, _| own["force"] = Value::Null, &["neither \"force\" nor \"shortening\""]),
        (
            &|own, deck| own["model_part_name"] = json!(format!("Structure.{}", deck.cells(|p| p[1] < 0.6))),
            &["bolt-section", "does not separate Structure.Part", "SmallDisplacementElement3D8N"],
        ),
        (
            &|own, deck| own["model_part_name"] = json!(format!("Structure.{}", deck.nodes(|_| true))),
            &["bolt-section", "has no solid elements"],
        ),
        (
            &|own, deck| {
                let copy = own.clone();
                deck.process(BOLT, copy);
            },
            &["two processes tighten Structure.Part"],
        ),
        (
            &|_, deck| {
                deck.fix(|p| (p[0] - 0.4).abs() < 1e-9, [json!(0.0), FREE, FREE]);
            },
            &["constraint-on-support", "bolt_pretension_process on Structure.Part", "a support prescribes it"],
        ),
    ];
    for (change, wanted) in cases {
        let said = problem(change);
        wanted.iter().for_each(|words| assert!(said.contains(words), "no {words:?} in: {said}"));
    }
    // Two bars in one part, and a ring that the plane cuts twice.
    let mut grid = Grid::new(Shape::Hex8, &[1, 1, 2], |p| p);
    add(&mut grid, &[1, 1, 2], 10.0, |p| [2.0 + p[0], p[1], p[2]]);
    let material = json!({"YOUNG_MODULUS": 1.0, "POISSON_RATIO": 0.0});
    let mut deck = Deck::new(&grid, "SmallDisplacementElement", "LinearElastic3DLaw", material);
    let bolt = format!("Structure.{}", deck.cells(|_| true));
    let plane = json!({"model_part_name": bolt, "point": [0.0, 0.0, 0.5], "normal": [0.0, 0.0, 1.0], "force": 1.0});
    deck.process(BOLT, plane);
    let said = deck.problem();
    assert!(said.contains("has several pieces"), "{said}");
}
