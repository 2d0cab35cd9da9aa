//! A cup drawn from an elastoplastic sheet about an axis, by rigid shapes and by the same tools meshed.

use std::f64::consts::PI;

use serde_json::{Value, json};
use zelus_core::geometry::Shape;

use super::deck::{Deck, assert_close};
use super::grid::{Grid, Vec3};

const BLANK: f64 = 50.0;
const THICKNESS: f64 = 1.0;
/// Force of the holder, reached at this time; from then on the punch moves by one in one of time.
const HOLDER: f64 = 2e4;
const CLAMPED: f64 = 0.25;
const TRAVEL: f64 = 3.0;

/// A segment of a profile: its end, and its centre if it is an arc.
type Segment = ([f64; 2], Option<[f64; 2]>);

/// Die, punch and holder as profiles (r, y), to whose left they lie.
fn tools() -> [([f64; 2], Vec<Segment>); 3] {
    let (shoulder, top) = ([34.5, -8.0], THICKNESS);
    [
        ([55.0, 0.0], vec![([34.5, 0.0], None), ([26.5, -8.0], Some(shoulder)), ([26.5, -15.0], None)]),
        ([0.0, top], vec![([19.0, top], None), ([25.0, top + 6.0], Some([19.0, top + 6.0])), ([25.0, 15.0], None)]),
        ([32.5, top + 2.0], vec![([34.5, top], Some([34.5, top + 2.0])), ([55.0, top], None)]),
    ]
}

/// Points on a profile: arcs in steps of 2°, lines in steps of 2.
fn chain(start: [f64; 2], segments: &[Segment]) -> Vec<[f64; 2]> {
    let mut out = vec![start];
    for (end, centre) in segments {
        let at = *out.last().expect("a point");
        let angle = |p: [f64; 2], c: [f64; 2]| (p[1] - c[1]).atan2(p[0] - c[0]);
        let way = [end[0] - at[0], end[1] - at[1]];
        let turn = centre.map_or(0.0, |c| (angle(*end, c) - angle(at, c)).rem_euclid(2.0 * PI));
        let count = match centre {
            Some(_) => (turn.to_degrees() / 2.0 - 1e-9).ceil() as usize,
            None => (way[0].hypot(way[1]) / 2.0).round() as usize,
        };
        let place = |share: f64| match centre {
            Some(c) => {
                let (sin, cos) = (angle(at, *c) + share * turn).sin_cos();
                let radius = (at[0] - c[0]).hypot(at[1] - c[1]);
                [c[0] + radius * cos, c[1] + radius * sin]
            }
            None => [at[0] + share * way[0], at[1] + share * way[1]],
        };
        out.extend((1..=count).map(|i| place(i as f64 / count as f64)));
    }
    out
}

/// A tool of one layer of cells on a profile, its other nodes one unit of length behind it.
fn meshed(front: &[[f64; 2]]) -> Grid {
    let count = front.len() - 1;
    Grid::new(Shape::Quad4, &[count, 1], |p| {
        let i = (p[0] * count as f64).round() as usize;
        let (a, b) = (front[i.saturating_sub(1)], front[(i + 1).min(count)]);
        let length = (b[0] - a[0]).hypot(b[1] - a[1]);
        [front[i][0] - p[1] * (b[1] - a[1]) / length, front[i][1] + p[1] * (b[0] - a[0]) / length, 0.0]
    })
}

/// Adds a body whose reference begins at `at` instead of 0.
fn add(grid: &mut Grid, other: Grid, at: f64) {
    let first = grid.nodes.len();
    grid.nodes.extend(other.nodes);
    grid.reference.extend(other.reference.iter().map(|p| [p[0] + at, p[1], p[2]]));
    grid.cells.extend(other.cells.iter().map(|cell| cell.iter().map(|node| node + first).collect::<Vec<_>>()));
}

/// Place of a tool in the reference of the grid.
fn place(tool: usize) -> f64 {
    10.0 * (tool + 1) as f64
}

fn is_of(tool: usize) -> impl Fn(Vec3) -> bool {
    move |p| (p[0] - place(tool) - 0.5).abs() < 1.0
}

/// A function of time: 0 up to `begin`, then even to `value` at `end`.
fn ramp(value: f64, begin: f64, end: f64) -> Value {
    json!(format!("{value:?}*(0.5 + 0.5*(abs(t - {begin:?}) - abs(t - {end:?}))/{:?})", end - begin))
}

fn assign(deck: &mut Deck<'_>, module: &str, path: &str, variable: &str, value: &[Value; 3]) {
    let constrained: Vec<bool> = value.iter().map(|v| !v.is_null()).collect();
    let mut settings =
        json!({"model_part_name": path, "variable_name": variable, "value": value, "interval": [0.0, "End"]});
    if module == "assign_vector_variable_process" {
        settings["constrained"] = json!(constrained);
    }
    deck.process(module, settings);
}

/// Forces of punch and die at every whole travel of the punch.
fn drawn(is_meshed: bool) -> Vec<[f64; 2]> {
    let mut grid = Grid::new(Shape::Quad4, &[40, 2], |p| [BLANK * p[0], THICKNESS * p[1], 0.0]);
    let sheet = |p: Vec3| p[0] < 2.0;
    if is_meshed {
        let tools = tools();
        (0..3).for_each(|tool| add(&mut grid, meshed(&chain(tools[tool].0, &tools[tool].1)), place(tool)));
    }
    let (element, law) = ("AxisymTotalLagrangianElement", "FiniteStrainIsotropicPlasticityAxisymVonMisesVonMises");
    let material = json!({"YOUNG_MODULUS": 2.1e5, "POISSON_RATIO": 0.3, "YIELD_STRESS": 250.0,
        "EXPONENTIAL_SATURATION_YIELD_STRESS": 400.0, "HARDENING_EXPONENT": 10.0, "ISOTROPIC_HARDENING_MODULUS": 200.0});
    let mut deck = Deck::new(&grid, element, law, material);
    deck.steps(0.25, CLAMPED + TRAVEL).set("residual_relative_tolerance", json!(1e-5)).set("max_iteration", json!(30));
    deck.set("convergence_criterion", json!("contact_residual_criterion"));
    deck.set("contact_settings", json!({"mortar_type": "ALMContactFrictional"}));
    deck.fix(|p| p[0] == 0.0, [json!(0.0), Value::Null, Value::Null]);
    let bottom = deck.facets(|p| sheet(p) && p[1] == 0.0, "LineCondition");
    let top = deck.facets(|p| sheet(p) && p[1] == 1.0, "LineCondition");
    let way = ramp(-TRAVEL, CLAMPED, CLAMPED + TRAVEL);
    let motions = [json!(0.0), way, Value::Null].map(|y| [json!(0.0), y, Value::Null]);
    let load = [json!(0.0), ramp(-HOLDER, 0.0, CLAMPED), json!(0.0)];
    let mut masters = Vec::new();
    for (tool, (motion, (start, segments))) in motions.iter().zip(tools()).enumerate() {
        let mut point = format!("Structure.Point{tool}");
        if is_meshed {
            masters.push(deck.facets(|p| is_of(tool)(p) && p[1] == 0.0, "LineCondition"));
            point = format!("Structure.{}", deck.nodes(is_of(tool)));
        } else {
            masters.push(format!("Tool{tool}"));
            let segments: Vec<Value> = segments
                .iter()
                .map(|(end, centre)| match centre {
                    Some(centre) => json!({"arc_to": end, "centre": centre}),
                    None => json!({"line_to": end}),
                })
                .collect();
            deck.process(
                "rigid_shape_process",
                json!({"model_part_name": format!("Structure.Tool{tool}"), "reference_model_part_name": point,
                    "facet_size": 2.0, "shape": {"name": "revolution", "start": start, "segments": segments}}),
            );
        }
        assign(&mut deck, "assign_vector_variable_process", &point, "DISPLACEMENT", motion);
        if motion[1].is_null() {
            let mut loaded = point.clone();
            if is_meshed {
                let settings = json!({"model_part_name": point, "master_variable_name": "DISPLACEMENT_Y"});
                deck.process("impose_rigid_movement_process", settings);
                loaded = format!("Structure.{}", deck.point(grid.nodes_where(is_of(tool))[0], "PointLoadCondition"));
            }
            assign(&mut deck, "assign_vector_variable_to_conditions_process", &loaded, "POINT_LOAD", &load);
        }
    }
    deck.process(
        "alm_contact_process",
        json!({"model_part_name": "Structure", "contact_type": "Frictional",
            "contact_model_part": {"0": [bottom, masters[0]], "1": [top, masters[1], masters[2]]},
            "assume_master_slave": {"0": [bottom], "1": [top]}, "friction_coefficients": {"0": 0.1, "1": 0.1},
            "alternative_formulations": {"axisymmetric": true}}),
    );
    let ran = deck.run();
    let accepted: Vec<usize> = (0..ran.report.steps.len()).filter(|&step| ran.report.steps[step].converged).collect();
    let times = ran.times();
    (1..=TRAVEL as usize)
        .map(|travel| {
            let step = times.iter().position(|t| (t - CLAMPED - travel as f64).abs() < 1e-9).expect("a step");
            [1, 0].map(|tool| match is_meshed {
                true => ran.reaction(&grid.nodes_where(is_of(tool)), step)[1],
                false => ran.number(&format!("REACTION_Y of Structure.Point{tool}"), accepted[step]),
            })
        })
        .collect()
}

/// The punch draws with the force of the same tools meshed, to 1 %: facets of meshed tools are flat and 2° wide. Die, punch and holder
/// balance to the tolerance of the solver.
#[test]
fn rigid_shapes_draw_a_cup_as_meshed_tools_do() {
    let (rigid, meshed) = (drawn(false), drawn(true));
    println!("punch and die: {rigid:?}, meshed {meshed:?}");
    for (own, other) in rigid.iter().zip(&meshed) {
        assert_close(own[0], other[0], 0.01, "force of the punch");
        for [punch, die] in [own, other] {
            assert_close(*die, HOLDER - punch, 1e-4, "force of the die");
        }
    }
    assert!(rigid[2][0] < 2.0 * rigid[0][0] && rigid[0][0] < -3e3, "{rigid:?}");
}
