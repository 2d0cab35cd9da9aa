//! Neo-Hookean blocks in uniaxial and equibiaxial tension and simple shear, and pressure that follows.
//!
//! W = ½ λ ln²J − μ ln J + ½ μ (tr C − 3): principal Cauchy stress (μ (λ_i² − 1) + λ ln J)/J.

use serde_json::{Value, json};
use zelus_core::geometry::Shape;

use super::deck::{Deck, assert_close};
use super::grid::Grid;

const YOUNG: f64 = 100.0;
const NU: f64 = 0.3;
const FREE: Value = Value::Null;

fn lame() -> (f64, f64) {
    (YOUNG * NU / ((1.0 + NU) * (1.0 - 2.0 * NU)), 0.5 * YOUNG / (1.0 + NU))
}

/// The stretch across that leaves no stress there when `of_volume` gives J from it, by bisection.
fn across(of_volume: impl Fn(f64) -> f64) -> f64 {
    let (lambda, mu) = lame();
    let (mut low, mut high) = (0.1, 3.0);
    for _ in 0..200 {
        let middle: f64 = 0.5 * (low + high);
        if mu * (middle * middle - 1.0) + lambda * of_volume(middle).ln() > 0.0 {
            high = middle;
        } else {
            low = middle;
        }
    }
    0.5 * (low + high)
}

fn law() -> Value {
    json!({"YOUNG_MODULUS": YOUNG, "POISSON_RATIO": NU})
}

/// The state is uniform, so only the tolerance of the iteration is left: 1e-8.
#[test]
fn neo_hookean_tension_along_one_and_two_axes() {
    let (lambda, mu) = lame();
    let stretch: f64 = 1.8;
    for element in ["TotalLagrangianElement", "UpdatedLagrangianElement"] {
        for shape in [Shape::Hex8, Shape::Tet10] {
            for axes in [1, 2] {
                let grid = Grid::new(shape, &[2, 1, 1], |p| p);
                let mut deck = Deck::new(&grid, element, "HyperElastic3DLaw", law());
                let pulled = || json!(format!("{}*t", stretch - 1.0));
                deck.steps(0.25, 1.0).gauss("CAUCHY_STRESS_VECTOR");
                for axis in 0..3 {
                    let only = |value: Value| std::array::from_fn(|a| if a == axis { value.clone() } else { FREE });
                    deck.fix(|p| p[axis] == 0.0, only(json!(0.0)));
                    if axis < axes {
                        deck.fix(|p| p[axis] == 1.0, only(pulled()));
                    }
                }
                let ran = deck.run();
                let free = if axes == 1 { across(|l| stretch * l * l) } else { across(|l| stretch * stretch * l) };
                let volume = if axes == 1 { stretch * free * free } else { stretch * stretch * free };
                let expected = (mu * (stretch * stretch - 1.0) + lambda * volume.ln()) / volume;
                let corner = grid.nodes_where(|p| p == [1.0, 1.0, 1.0])[0];
                let u = ran.last("DISPLACEMENT", corner);
                assert_close(1.0 + u[2], free, 1e-8, &format!("{element} {shape:?} across, {axes} axes"));
                for (_, stress) in ran.gauss("CAUCHY_STRESS_VECTOR", ran.times().len() - 1) {
                    assert_close(stress[0], expected, 1e-8, &format!("{element} {shape:?} stress, {axes} axes"));
                    assert!(stress[2].abs() < 1e-7 && stress[3].abs() < 1e-7);
                }
            }
        }
    }
}

/// With W = ½ μ (J^(−2/3) tr C − 3) + ½ κ (J − 1)² the stress is σ = μ J^(−5/3) dev b + κ (J − 1) 1. Along x the bar is
/// pulled to 1.8, across nothing holds it; 1e-7 of the iteration, the bulk modulus being 500 times the other.
#[test]
fn tension_with_one_pressure_an_element() {
    let (young, nu, stretch): (f64, f64, f64) = (3.0, 0.499, 1.8);
    let (mu, bulk) = (0.5 * young / (1.0 + nu), young / (3.0 * (1.0 - 2.0 * nu)));
    let stress = |l: f64, own: f64| {
        let j = stretch * l * l;
        mu * j.powf(-5.0 / 3.0) * (own * own - (stretch * stretch + 2.0 * l * l) / 3.0) + bulk * (j - 1.0)
    };
    let (mut low, mut high) = (0.5, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if stress(middle, middle) > 0.0 { high = middle } else { low = middle }
    }
    let law = "HyperElasticIsotropicQuasiIncompressibleIshochoricNeoHookean3D";
    // A bar that has expanded by θ is one of another size.
    for (shape, thermal) in [(Shape::Hex8, 1.0), (Shape::Tet4, 1.0), (Shape::Hex8, 1.05), (Shape::Tet4, 0.95)] {
        let grid = Grid::new(shape, &[2, 1, 1], |p| p);
        let variables = json!({"YOUNG_MODULUS": young, "POISSON_RATIO": nu, "THERMAL_EXPANSION_COEFFICIENT": 1e-3,
            "REFERENCE_TEMPERATURE": 300.0});
        let law = format!("{}{law}", if thermal == 1.0 { "" } else { "Thermal" });
        let mut deck = Deck::new(&grid, "TotalLagrangianQ1P0MixedElement", &law, variables);
        deck.steps(0.1, 1.0).gauss("CAUCHY_STRESS_VECTOR").set("auxiliary_variables_list", json!(["TEMPERATURE"]));
        deck.process(
            "assign_scalar_variable_process",
            json!({"model_part_name": "Structure", "variable_name": "TEMPERATURE",
            "value": 300.0 + (thermal - 1.0) / 1e-3, "constrained": false}),
        );
        for axis in 0..3 {
            deck.fix(|p| p[axis] == 0.0, std::array::from_fn(|a| if a == axis { json!(0.0) } else { FREE }));
        }
        deck.fix(|p| p[0] == 1.0, [json!(format!("{}*t", thermal * stretch - 1.0)), FREE, FREE]);
        let ran = deck.run();
        let corner = grid.nodes_where(|p| p == [1.0, 1.0, 1.0])[0];
        let across = 1.0 + ran.last("DISPLACEMENT", corner)[2];
        assert_close(across, thermal * low, 1e-7, &format!("{shape:?} {thermal} across"));
        for (_, found) in ran.gauss("CAUCHY_STRESS_VECTOR", ran.times().len() - 1) {
            assert_close(found[0], stress(low, stretch), 1e-6, &format!("{shape:?} stress"));
        }
    }
}

/// F = 1 + γ e_x ⊗ e_y keeps the volume: σ_xy = μ γ, σ_xx = μ γ², the others 0.
#[test]
fn neo_hookean_simple_shear() {
    let (_, mu) = lame();
    let gamma = 0.9;
    for (element, law_name, shape) in [
        ("TotalLagrangianElement", "HyperElasticPlaneStrain2DLaw", Shape::Quad4),
        ("UpdatedLagrangianElement", "HyperElastic3DLaw", Shape::Prism6),
    ] {
        let grid = Grid::new(shape, &[2, 2, 2][..shape.dim()], |p| p);
        let mut deck = Deck::new(&grid, element, law_name, law());
        let edge = |p: [f64; 3]| p[..shape.dim()].iter().any(|x| *x == 0.0 || *x == 1.0);
        deck.steps(0.25, 1.0).gauss("CAUCHY_STRESS_VECTOR");
        deck.fix(edge, [json!(format!("{gamma}*t*Y")), json!(0.0), json!(0.0)]);
        let ran = deck.run();
        for (_, stress) in ran.gauss("CAUCHY_STRESS_VECTOR", 3) {
            let shear = if shape.dim() == 2 { stress[2] } else { stress[3] };
            assert_close(shear, mu * gamma, 1e-8, "shear");
            assert_close(stress[0], mu * gamma * gamma, 1e-8, "tension along the shear");
            assert!(stress[1].abs() < 1e-7);
        }
    }
}

/// A neo-Hookean cube under pressure on all free sides, which follows them: σ = −p exactly, and Newton's method converges
/// in few iterations only if the tangent holds the turn of the pressure. 1e-8 as above.
#[test]
fn pressure_that_follows_squeezes_a_cube() {
    let (lambda, mu) = lame();
    let pressure = 30.0;
    let grid = Grid::new(Shape::Hex8, &[2, 2, 2], |p| p);
    let mut deck = Deck::new(&grid, "TotalLagrangianElement", "HyperElastic3DLaw", law());
    for axis in 0..3 {
        deck.fix(|p| p[axis] == 0.0, std::array::from_fn(|a| if a == axis { json!(0.0) } else { FREE }));
        deck.scalar_load(|p| p[axis] == 1.0, "SurfaceLoadCondition", "POSITIVE_FACE_PRESSURE", json!(pressure));
    }
    let ran = deck.run();
    // μ (l² − 1) + 3 λ ln l = −p l³ by bisection
    let excess = |l: f64| mu * (l * l - 1.0) + 3.0 * lambda * l.ln() + pressure * l.powi(3);
    let (mut low, mut high) = (0.3, 1.0);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if excess(middle) > 0.0 {
            high = middle;
        } else {
            low = middle;
        }
    }
    let corner = grid.nodes_where(|p| p == [1.0, 1.0, 1.0])[0];
    assert_close(1.0 + ran.last("DISPLACEMENT", corner)[0], 0.5 * (low + high), 1e-8, "edge");
    let iterations = ran.report.steps[0].iterations.len();
    assert!(iterations <= 8, "{iterations} iterations: the tangent is not that of the load");
}

/// A load of one and a half times Young's modulus in one step: the first increments would turn the block inside out, and less is taken of
/// them. It acts on the face as it is, so that it is the Cauchy stress of the closed form; 1e-8 is the tolerance of the iteration.
#[test]
fn increments_that_turn_elements_inside_out_are_shortened() {
    let (lambda, mu) = lame();
    let load = 1.5 * YOUNG;
    let cauchy = |stretch: f64| {
        let volume = stretch * across(|l| stretch * l * l).powi(2);
        (mu * (stretch * stretch - 1.0) + lambda * volume.ln()) / volume
    };
    let (mut low, mut high) = (0.05, 1.0);
    for _ in 0..200 {
        let middle: f64 = 0.5 * (low + high);
        if cauchy(middle) < -load { low = middle } else { high = middle }
    }
    let grid = Grid::new(Shape::Hex8, &[2, 2, 2], |p| p);
    let mut deck = Deck::new(&grid, "TotalLagrangianElement", "HyperElastic3DLaw", law());
    for axis in 0..3 {
        deck.fix(|p| p[axis] == 0.0, std::array::from_fn(|a| if a == axis { json!(0.0) } else { FREE }));
    }
    let force = [json!(0.0), json!(0.0), json!(-load)];
    deck.set("max_iteration", json!(60)).vector_load(|p| p[2] == 1.0, "SurfaceLoadCondition", "SURFACE_LOAD", force);
    let ran = deck.run();
    assert_eq!(ran.report.steps.len(), 1, "no attempt has failed");
    let top = grid.nodes_where(|p| p[2] == 1.0)[0];
    assert_close(1.0 + ran.last("DISPLACEMENT", top)[2], low, 1e-8, "stretch");
}
