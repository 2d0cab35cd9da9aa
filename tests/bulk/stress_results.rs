//! Scalars of the stress by name, their extremes in the report, and reactions by support.

use serde_json::{Value, json};
use zelus_core::geometry::Shape;

use super::deck::{Deck, Ran, assert_close};
use super::grid::Grid;

const FREE: Value = Value::Null;
const YOUNG: f64 = 1000.0;
const POISSON: f64 = 0.25;
/// Lamé's constants of these: both 400.
const LAME: f64 = 400.0;
const YIELD: f64 = 0.9;
const ELEMENTS: [(&str, Shape); 4] = [
    ("SmallDisplacementElement", Shape::Hex8),
    ("SmallDisplacementElement", Shape::Tet10),
    ("SmallDisplacementBbarElement", Shape::Hex8),
    ("SmallDisplacementMixedVolumetricStrainElement", Shape::Tet4),
];
const NAMES: [&str; 7] = [
    "PRINCIPAL_CAUCHY_STRESS_VECTOR",
    "MAX_PRINCIPAL_STRESS",
    "MIN_PRINCIPAL_STRESS",
    "TRESCA_STRESS",
    "HYDROSTATIC_PRESSURE",
    "VON_MISES_STRESS",
    "SAFETY_FACTOR",
];

/// A cube under uniform strain, all nodes of which are moved; σ = λ tr ε 1 + 2 μ ε.
fn strained(element: &str, shape: Shape, material: Value, strain: [[f64; 3]; 3]) -> (Grid, Ran) {
    let grid = Grid::new(shape, &[2, 2, 2], |p| p);
    let ran = {
        let mut deck = Deck::new(&grid, element, "LinearElastic3DLaw", material);
        let row = |row: [f64; 3]| json!(format!("({:e})*x+({:e})*y+({:e})*z", row[0], row[1], row[2]));
        deck.fix(|_| true, strain.map(row));
        for name in NAMES {
            deck.gauss(name);
        }
        let lists = json!({"model_part_name": "Structure", "gauss_point_variables_extrapolated_to_nodes": NAMES});
        deck.process("vtu_output_process", lists);
        deck.run()
    };
    (grid, ran)
}

/// The stress with the rows (2, 0, 0), (0, 2, 3), (0, 3, 2), whose principal values are 5, 2 and −1, by 0.1: round-off of a solve.
#[test]
fn principal_stresses_and_what_follows_from_them() {
    let mean = 0.6 / (3.0 * LAME + 2.0 * LAME);
    let normal = (0.2 - LAME * mean) / (2.0 * LAME);
    let shear = 0.3 / (2.0 * LAME);
    let strain = [[normal, 0.0, 0.0], [0.0, normal, shear], [0.0, shear, normal]];
    let mises = 0.1 * 27.0_f64.sqrt();
    for (element, shape) in ELEMENTS {
        let material = json!({"YOUNG_MODULUS": YOUNG, "POISSON_RATIO": POISSON, "YIELD_STRESS": YIELD});
        let (_, ran) = strained(element, shape, material, strain);
        let expected: [&[f64]; 7] = [&[0.5, 0.2, -0.1], &[0.5], &[-0.1], &[0.6], &[-0.2], &[mises], &[YIELD / mises]];
        for (name, expected) in NAMES.into_iter().zip(expected) {
            for (_, values) in ran.gauss(name, 0) {
                assert_eq!(values.len(), expected.len(), "{name}");
                let pairs = values.iter().zip(expected);
                pairs.for_each(|(value, exact)| assert_close(*value, *exact, 1e-9, &format!("{name} of {element}")));
            }
        }
        let near = |found: f64, exact: f64, what: &str| assert_close(found, exact, 1e-9, what);
        let (largest, smallest) = (&ran.report.largest, &ran.report.smallest);
        near(largest["VON_MISES_STRESS"], mises, "largest von Mises stress");
        near(largest["MAX_PRINCIPAL_STRESS"], 0.5, "largest principal stress");
        near(largest["TRESCA_STRESS"], 0.6, "largest Tresca stress");
        near(largest["HYDROSTATIC_PRESSURE"], -0.2, "largest pressure, with its sign");
        near(smallest["MIN_PRINCIPAL_STRESS"], -0.1, "smallest principal stress");
        near(smallest["SAFETY_FACTOR"], YIELD / mises, "smallest safety factor");
    }
}

/// Without YIELD_STRESS there is no factor, with it material without stress has the largest one; a name that no element knows is
/// warned about.
#[test]
fn a_safety_factor_needs_a_yield_stress() {
    let none = [[0.0; 3]; 3];
    let (element, shape) = ELEMENTS[0];
    let (_, ran) = strained(element, shape, json!({"YOUNG_MODULUS": YOUNG, "POISSON_RATIO": POISSON}), none);
    assert!(!ran.report.smallest.contains_key("SAFETY_FACTOR"));
    let told = ran.report.warnings.iter().any(|words| words.contains("no-values") && words.contains("SAFETY_FACTOR"));
    assert!(told, "{:?}", ran.report.warnings);
    let material = json!({"YOUNG_MODULUS": YOUNG, "POISSON_RATIO": POISSON, "YIELD_STRESS_TENSION": YIELD});
    let (_, ran) = strained(element, shape, material, none);
    assert_close(ran.report.smallest["SAFETY_FACTOR"], 1000.0, 1e-12, "mean of the largest factor");
}

/// ANALYTIC: sheared beyond yield, ideal plasticity keeps γ − τ_y/G in √3 ε_p. The report has the strain without a word of the deck, and
/// that of an elastic law has none.
#[test]
fn plastic_strain_is_reported_where_a_law_has_it() {
    let (shear, lame, name) = (0.01, LAME, "EQUIVALENT_PLASTIC_STRAIN");
    let grid = Grid::new(Shape::Hex8, &[2, 2, 2], |p| p);
    for (law, exact) in [
        ("SmallStrainJ2Plasticity3DLaw", Some((shear - YIELD / 3f64.sqrt() / lame) / 3f64.sqrt())),
        ("LinearElastic3DLaw", None),
    ] {
        let material = json!({"YOUNG_MODULUS": YOUNG, "POISSON_RATIO": POISSON, "YIELD_STRESS": YIELD});
        let mut deck = Deck::new(&grid, "SmallDisplacementElement", law, material);
        deck.fix(|_| true, [json!(format!("{shear:e}*y")), json!(0.0), json!(0.0)]);
        let ran = deck.run();
        let found = ran.report.largest.get(name);
        assert_eq!(found.is_some(), exact.is_some(), "{law}");
        if let Some((found, exact)) = found.zip(exact) {
            assert_close(*found, exact, 1e-9, "largest plastic strain");
        }
    }
}

/// The extremes of a bent bar are at its clamped edge: the nodes of the report are where they should be.
#[test]
fn extremes_have_their_places() {
    let grid = Grid::new(Shape::Hex20, &[6, 1, 2], |p| [6.0 * p[0], p[1], p[2]]);
    let mut deck = Deck::new(
        &grid,
        "SmallDisplacementElement",
        "LinearElastic3DLaw",
        json!({"YOUNG_MODULUS": YOUNG, "POISSON_RATIO": 0.0}),
    );
    deck.fix(|p| p[0] == 0.0, [json!(0.0), json!(0.0), json!(0.0)]);
    deck.vector_load(|p| p[0] == 1.0, "SurfaceLoadCondition", "SURFACE_LOAD", [json!(0.0), json!(0.0), json!(-1e-3)]);
    let ran = deck.run();
    let place = |name: &str| ran.report.places[name];
    let top = place("MAX_PRINCIPAL_STRESS").position;
    assert!(top[0] < 0.51 && top[2] == 1.0, "{top:?}");
    assert_eq!(place("MIN_PRINCIPAL_STRESS").position[2], 0.0);
    let tip = place("DISPLACEMENT");
    assert_eq!(tip.position[0], 6.0);
    assert_eq!(grid.nodes[tip.node - 1], tip.position);
    let moved = ran.last("DISPLACEMENT", tip.node - 1);
    assert_close(moved.iter().map(|x| x * x).sum::<f64>().sqrt(), ran.report.largest["DISPLACEMENT"], 1e-12, "size");
}

/// A bar of unit section pulled by a strain of 1e-3 between two supports: ∓E ε along its axis, and a moment about the middle where a
/// support holds one half of the section. The node-components that a later process fixes, too, are of that process.
#[test]
fn reactions_by_support_add_up_to_the_balance() {
    let grid = Grid::new(Shape::Hex8, &[2, 2, 2], |p| [2.0 * p[0], p[1], p[2]]);
    let zero = || json!(0.0);
    let mut deck = Deck::new(
        &grid,
        "SmallDisplacementElement",
        "LinearElastic3DLaw",
        json!({"YOUNG_MODULUS": YOUNG, "POISSON_RATIO": POISSON}),
    );
    deck.fix(|p| p[0] == 0.0, [zero(), FREE, FREE])
        .fix(|p| p[1] == 0.0, [FREE, zero(), FREE])
        .fix(|p| p[2] == 0.0, [FREE, FREE, zero()])
        .fix(|p| p[0] == 1.0, [json!(2e-3), FREE, FREE])
        .fix(|p| p[0] == 0.0 && p[1] == 1.0, [zero(), FREE, FREE]);
    let ran = deck.run();
    let balance = ran.report.steps[0].balance.as_ref().expect("a balance");
    let supports = &balance.supports;
    assert_eq!(
        supports.iter().map(|own| own.part.as_str()).collect::<Vec<_>>(),
        ["Structure.Part0", "Structure.Part1", "Structure.Part2", "Structure.Part3", "Structure.Part4"]
    );
    let force = YOUNG * 1e-3;
    // a quarter of the section belongs to the three of nine nodes at y = 1
    for (at, exact) in [(0, -0.75 * force), (3, force), (4, -0.25 * force)] {
        assert_close(supports[at].reaction[0], exact, 1e-9, &supports[at].part);
    }
    for at in [1, 2] {
        assert!(supports[at].reaction.iter().all(|force| force.abs() < 1e-9), "{:?}", supports[at]);
    }
    // about (1, 0.5, 0.5): forces at y = 1, their arm 0.5
    assert_close(supports[4].moment[2], 0.25 * force * 0.5, 2e-3, "moment, arms shortened by the motion");
    let sum = |of: fn(&zelus_core::strategies::SupportReaction) -> [f64; 3]| {
        supports.iter().map(of).fold([0.0; 3], |sum, own| std::array::from_fn(|c| sum[c] + own[c]))
    };
    let displacement = &balance.unknowns[0];
    let moments = displacement.moments.expect("moments").reactions;
    for c in 0..3 {
        assert!((sum(|own| own.reaction)[c] - displacement.forces.reactions[c]).abs() < 1e-12, "{c}");
        assert!((sum(|own| own.moment)[c] - moments[c]).abs() < 1e-12, "{c}");
    }
}

/// A block on an inclined plane, pressed by p = 0.01 on unit area: the plane carries p along its normal, turned by the angle.
#[test]
fn a_support_along_a_direction_has_its_reaction() {
    let (s, c) = 0.4_f64.sin_cos();
    let turn = |p: [f64; 3]| [c * p[0] - s * p[1], s * p[0] + c * p[1], p[2]];
    let grid = Grid::new(Shape::Hex8, &[2, 2, 2], turn);
    let mut deck = Deck::new(
        &grid,
        "SmallDisplacementElement",
        "LinearElastic3DLaw",
        json!({"YOUNG_MODULUS": YOUNG, "POISSON_RATIO": 0.0}),
    );
    let mut roller = |wanted: fn([f64; 3]) -> bool, direction: [f64; 3]| {
        let part = deck.nodes(wanted);
        deck.process(
            "assign_displacement_along_direction_process",
            json!({"model_part_name": format!("Structure.{part}"), "direction": direction, "value": 0.0}),
        );
    };
    roller(|p| p[1] == 0.0, [-s, c, 0.0]);
    roller(|p| p[0] == 0.0, [c, s, 0.0]);
    roller(|p| p[2] == 0.0, [0.0, 0.0, 1.0]);
    deck.scalar_load(|p| p[1] == 1.0, "SurfaceLoadCondition", "POSITIVE_FACE_PRESSURE", json!(0.01));
    let ran = deck.run();
    let balance = ran.report.steps[0].balance.as_ref().expect("a balance");
    let supports = &balance.supports;
    assert_eq!(supports.len(), 3);
    for (found, exact) in supports[0].reaction.into_iter().zip([-0.01 * s, 0.01 * c, 0.0]) {
        assert!((found - exact).abs() < 1e-9, "{:?}", supports[0]);
    }
    for own in &supports[1..] {
        assert!(own.reaction.iter().all(|force| force.abs() < 1e-9), "{own:?}");
    }
}
