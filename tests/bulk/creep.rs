//! Norton's creep: relaxation, constant stress, and the steady state of a pipe.

use serde_json::{Value, json};
use zelus_core::geometry::Shape;

use super::deck::{Deck, assert_close};
use super::grid::Grid;

const FREE: Value = Value::Null;

/// Relaxation of a bar whose strain is held from the first step on, which is short: σ = [σ_0^(1−n) + (n − 1) E A t]^(1/(1−n)). Backward
/// Euler is of first order: 4e-3 for 200 steps, half of it for 400.
#[test]
fn a_bar_relaxes_under_constant_strain() {
    let [young, n, coefficient, strain, end]: [f64; 5] = [200.0, 4.0, 1e-3, 0.01, 4.0];
    let grid = Grid::new(Shape::Hex8, &[1, 1, 1], |p| p);
    let exact = ((young * strain).powf(1.0 - n) + (n - 1.0) * young * coefficient * end).powf(1.0 / (1.0 - n));
    let error_of = |element: &str, steps: usize| {
        let variables = json!({"YOUNG_MODULUS": young, "POISSON_RATIO": 0.3, "NORTON_COEFFICIENT": coefficient,
            "NORTON_EXPONENT": n});
        let mut deck = Deck::new(&grid, element, "SmallStrainNortonCreep3D", variables);
        deck.steps(end / steps as f64, end).gauss("CAUCHY_STRESS_VECTOR").gauss("EQUIVALENT_CREEP_STRAIN");
        for axis in 0..3 {
            deck.fix(|p| p[axis] == 0.0, std::array::from_fn(|a| if a == axis { json!(0.0) } else { FREE }));
        }
        deck.fix(|p| p[0] == 1.0, [json!(strain), FREE, FREE]);
        let ran = deck.run();
        let stress = ran.gauss("CAUCHY_STRESS_VECTOR", steps - 1)[0].1[0];
        // the elastic strain and the creep strain are the strain of the bar
        let crept = ran.gauss("EQUIVALENT_CREEP_STRAIN", steps - 1)[0].1[0];
        assert_close(stress / young + crept, strain, 1e-9, "the strain");
        (stress / exact - 1.0).abs()
    };
    let [coarse, fine] = [200, 400].map(|steps| error_of("SmallDisplacementElement", steps));
    let mean = error_of("SmallDisplacementBbarElement", 200);
    println!("relaxation: off by {coarse:.2e} and {fine:.2e}, with mean dilatation {mean:.2e}");
    assert!(coarse < 4e-3 && fine < 0.55 * coarse && (mean - coarse).abs() < 1e-9, "{coarse:e} {fine:e} {mean:e}");
}

/// Constant stress: ε = σ/E + A σ^n t^(m+1)/(m + 1), exact in any step: 1e-8 of the iteration.
#[test]
fn a_bar_creeps_under_constant_stress() {
    let (young, nu, n, coefficient, stress) = (200.0, 0.3, 3.0, 0.02, 0.5);
    for m in [0.0, -0.5, 0.7] {
        let variables = json!({"YOUNG_MODULUS": young, "POISSON_RATIO": nu, "NORTON_COEFFICIENT": coefficient,
            "NORTON_EXPONENT": n, "NORTON_TIME_EXPONENT": m});
        let grid = Grid::new(Shape::Hex8, &[1, 1, 1], |p| p);
        let mut deck = Deck::new(&grid, "SmallDisplacementElement", "SmallStrainNortonCreep3D", variables);
        deck.steps(0.5, 2.0);
        for axis in 0..3 {
            deck.fix(|p| p[axis] == 0.0, std::array::from_fn(|a| if a == axis { json!(0.0) } else { FREE }));
        }
        deck.vector_load(
            |p| p[0] == 1.0,
            "SmallDisplacementSurfaceLoadCondition",
            "SURFACE_LOAD",
            [json!(stress), json!(0.0), json!(0.0)],
        );
        let ran = deck.run();
        let end = grid.nodes_where(|p| p == [1.0; 3])[0];
        for (step, t) in ran.times().into_iter().enumerate() {
            let crept = coefficient * f64::powf(stress, n) * t.powf(m + 1.0) / (m + 1.0);
            let [along, across, _] = ran.vector("DISPLACEMENT", end, step);
            assert_close(along, stress / young + crept, 1e-8, &format!("m = {m}, t = {t}"));
            assert_close(across, -nu * stress / young - 0.5 * crept, 1e-8, &format!("across, m = {m}, t = {t}"));
        }
    }
}

/// A long pipe under inner pressure in steady creep (Bailey, 1935): the radial velocity is √3/2 A (√3 p′/n)^n b²/r with
/// p′ = p/((b/a)^(2/n) − 1), and σ_r = p′ (1 − (b/r)^(2/n)). 1e-3 for 10 cells of second order, in plane strain as a ring with 8
/// elements in a quarter and as a solid of revolution.
#[test]
fn a_pipe_creeps_steadily_under_pressure() {
    let (a, b, pressure, n, coefficient): (f64, f64, f64, f64, f64) = (1.0, 2.0, 1.0, 4.0, 1e-3);
    let scale = pressure / ((b / a).powf(2.0 / n) - 1.0);
    let root = 3.0_f64.sqrt();
    let velocity = |r: f64| 0.5 * root * coefficient * (root * scale / n).powf(n) * b * b / r;
    let variables = json!({"YOUNG_MODULUS": 1e4, "POISSON_RATIO": 0.3, "NORTON_COEFFICIENT": coefficient,
        "NORTON_EXPONENT": n});
    let revolution = Grid::new(Shape::Quad8, &[10, 1], |p| [a + (b - a) * p[0], 0.1 * p[1], 0.0]);
    let quarter = Grid::new(Shape::Quad8, &[10, 8], super::elastic::ring(a, b));
    for (grid, element, law) in [
        (&revolution, "AxisymSmallDisplacementElement", "SmallStrainNortonCreepAxisym"),
        (&quarter, "SmallDisplacementElement", "SmallStrainNortonCreepPlaneStrain"),
    ] {
        let ring = element.starts_with("Small");
        let mut deck = Deck::new(grid, element, law, variables.clone());
        deck.steps(0.1, 4.0).gauss("CAUCHY_STRESS_VECTOR").gauss("UNIAXIAL_STRESS");
        let kind = if ring { "SmallDisplacementLineLoadCondition" } else { "AxisymLineLoadCondition" };
        if ring {
            deck.fix(|p| p[1] == 0.0, [FREE, json!(0.0), FREE]).fix(|p| p[1] == 1.0, [json!(0.0), FREE, FREE]);
        } else {
            deck.fix(|_| true, [FREE, json!(0.0), FREE]);
        }
        deck.scalar_load(|p| p[0] == 0.0, kind, "NEGATIVE_FACE_PRESSURE", json!(pressure));
        let ran = deck.run();
        let last = ran.times().len() - 1;
        for (end, r) in [(0.0, a), (1.0, b)] {
            let node = grid.nodes_where(|p| p == [end, 0.0, 0.0])[0];
            let [now, before] = [last, last - 1].map(|step| ran.vector("DISPLACEMENT", node, step)[0]);
            let found = (now - before) / 0.1;
            println!("{element}: velocity at r = {r} off by {:.2e}", found / velocity(r) - 1.0);
            assert_close(found, velocity(r), 1e-3, &format!("{element} r = {r}"));
        }
        if !ring {
            // q = √3/n p′ (b/r)^(2/n) lies between those at both ends
            let of = |r: f64| root / n * scale * (b / r).powf(2.0 / n);
            let found: Vec<f64> = ran.gauss("UNIAXIAL_STRESS", last).into_iter().map(|(_, q)| q[0]).collect();
            let (least, most) =
                (found.iter().copied().fold(f64::MAX, f64::min), found.iter().copied().fold(0.0, f64::max));
            assert!(least > of(b) && most < of(a) && most > 0.98 * of(a) && least < 1.02 * of(b), "{least} {most}");
        }
    }
}
