//! Von Mises plasticity: limit load of a thick cylinder, loading and unloading of a bar, history under cut steps.

use serde_json::{Value, json};
use zelus_core::geometry::Shape;

use super::deck::{Deck, assert_close};
use super::elastic::ring;
use super::grid::Grid;

const FREE: Value = Value::Null;
const SMALL: &str = "SmallStrainJ2PlasticityPlaneStrain2DLaw";

/// p = 2/√3 σ_y ln(b/a), the whole wall flowing.
fn limit(a: f64, b: f64, yield_stress: f64) -> f64 {
    2.0 / 3.0_f64.sqrt() * yield_stress * (b / a).ln()
}

/// The inner pressure that the prescribed widening of a quarter ring needs.
fn pressure_of_ring(element: &str, shape: Shape, law: &str, cells: usize, widening: f64) -> f64 {
    let (a, b) = (1.0, 2.0);
    let grid = Grid::new(shape, &[cells, cells], ring(a, b));
    let variables = json!({"YOUNG_MODULUS": 1000.0, "POISSON_RATIO": 0.3, "YIELD_STRESS": 1.0, "THICKNESS": 1.0,
        "ISOTROPIC_HARDENING_MODULUS": 0.0});
    let mut deck = Deck::new(&grid, element, law, variables);
    deck.steps(0.125, 1.0).set("max_iteration", json!(30));
    let radial = |axis: &str| json!(format!("{widening}*t*{axis}/sqrt(X**2+Y**2)"));
    deck.fix(|p| p[1] == 0.0, [FREE, json!(0.0), FREE])
        .fix(|p| p[1] == 1.0, [json!(0.0), FREE, FREE])
        .fix(|p| p[0] == 0.0, [radial("X"), radial("Y"), FREE]);
    let ran = deck.run();
    // the work over a unit widening, to which reactions of the planes of symmetry are perpendicular
    let work = |node: usize| {
        let (r, x) = (ran.last("REACTION", node), grid.nodes[node]);
        (r[0] * x[0] + r[1] * x[1]) / a
    };
    let inner = grid.nodes_where(|p| p[0] == 0.0);
    inner.into_iter().map(work).sum::<f64>() / (0.5 * std::f64::consts::PI * a)
}

/// A thick cylinder in plane strain carries the limit pressure: within 1 % for 8 cells. The plain element of first order
/// locks: it goes on hardening.
#[test]
fn the_limit_load_of_a_thick_cylinder_in_plane_strain() {
    let expected = limit(1.0, 2.0, 1.0);
    let run = |element, shape, widening| pressure_of_ring(element, shape, SMALL, 8, widening);
    let mean = run("SmallDisplacementBbarElement", Shape::Quad4, 0.02);
    let second = run("SmallDisplacementElement", Shape::Quad8, 0.02);
    println!("limit {expected}: mean dilatation {mean}, eight nodes {second}");
    assert_close(mean, expected, 1e-2, "mean dilatation");
    assert_close(second, expected, 1e-2, "eight nodes");
}

/// The same as a solid of revolution: the reaction of the inner edge is p 2πa times its height. 0.5 % for 20 cells.
#[test]
fn the_limit_load_of_a_thick_cylinder_as_a_solid_of_revolution() {
    let (a, b, height) = (1.0, 2.0, 0.1);
    let grid = Grid::new(Shape::Quad8, &[20, 1], |p| [a + (b - a) * p[0], height * p[1], 0.0]);
    let variables = json!({"YOUNG_MODULUS": 1000.0, "POISSON_RATIO": 0.3, "YIELD_STRESS": 1.0, "HARDENING_CURVE": 3,
        "FRACTURE_ENERGY": 1e9});
    let mut deck = Deck::new(&grid, "AxisymSmallDisplacementElement", "SmallStrainJ2PlasticityAxisym2DLaw", variables);
    deck.steps(0.1, 1.0).set("max_iteration", json!(30)).gauss("EQUIVALENT_PLASTIC_STRAIN");
    deck.fix(|_| true, [FREE, json!(0.0), FREE]).fix(|p| p[0] == 0.0, [json!("0.005*t"), FREE, FREE]);
    let ran = deck.run();
    let inner = grid.nodes_where(|p| p[0] == 0.0);
    let last = ran.times().len() - 1;
    let pressure = ran.reaction(&inner, last)[0] / (2.0 * std::f64::consts::PI * a * height);
    assert_close(pressure, limit(a, b, 1.0), 5e-3, "limit pressure");
    assert!(ran.gauss("EQUIVALENT_PLASTIC_STRAIN", last).iter().all(|(_, p)| p[0] > 0.0), "the whole wall flows");
}

/// A bar with linear hardening, its ends moved to and fro: σ = σ_y + E H/(E + H) (ε − σ_y/E) when first loaded, then
/// elastic until the yield surface, which has grown, is met on the other side. The state is uniform: 1e-9.
#[test]
fn a_bar_is_loaded_unloaded_and_loaded_the_other_way() {
    let (young, hardening, yield_stress) = (200.0, 20.0, 0.4);
    let grid = Grid::new(Shape::Hex8, &[1, 1, 1], |p| p);
    for law in ["SmallStrainJ2Plasticity3DLaw", "SmallStrainIsotropicPlasticity3DVonMisesVonMises"] {
        for element in ["SmallDisplacementElement", "SmallDisplacementBbarElement"] {
            let variables = json!({"YOUNG_MODULUS": young, "POISSON_RATIO": 0.3, "YIELD_STRESS": yield_stress,
                "ISOTROPIC_HARDENING_MODULUS": hardening});
            let mut deck = Deck::new(&grid, element, law, variables);
            deck.steps(1.0, 4.0).gauss("CAUCHY_STRESS_VECTOR").gauss("ACCUMULATED_PLASTIC_STRAIN");
            // strains 0.01, 0.008, -0.004, 0.012
            let path = "0.01-0.002*(t-1)-0.005*(t-1)*(t-2)+0.038/6*(t-1)*(t-2)*(t-3)";
            for axis in 0..3 {
                deck.fix(|p| p[axis] == 0.0, std::array::from_fn(|a| if a == axis { json!(0.0) } else { FREE }));
            }
            deck.fix(|p| p[0] == 1.0, [json!(path), FREE, FREE]);
            let ran = deck.run();
            let (mut plastic, mut alpha) = (0.0, 0.0);
            for (step, strain) in [0.01, 0.008, -0.004, 0.012].into_iter().enumerate() {
                let trial: f64 = young * (strain - plastic);
                let delta = (trial.abs() - yield_stress - hardening * alpha).max(0.0) / (young + hardening);
                plastic += delta * trial.signum();
                alpha += delta;
                let stress = young * (strain - plastic);
                for (_, found) in ran.gauss("CAUCHY_STRESS_VECTOR", step) {
                    assert_close(found[0], stress, 1e-9, &format!("{law} {element} step {step}"));
                }
                for (_, found) in ran.gauss("ACCUMULATED_PLASTIC_STRAIN", step) {
                    assert_close(found[0], alpha, 1e-9, "accumulated plastic strain");
                }
            }
        }
    }
}

/// A bar under strain that goes to and fro. Prager's hardening is exact: σ = σ_y + E C/(E + C) (ε − σ_y/E), and yielding the other way
/// begins 2 σ_y below the reversal (1e-9 of the iteration). Armstrong and Frederick's loop is σ = X ± σ_y with X = ± C/γ + (X_0 ∓ C/γ)
/// exp(∓ γ (ε_p − ε_p0)) over each branch: 6e-3 of C/γ for 100 steps a branch, first order in the step.
#[test]
fn a_bar_with_kinematic_hardening_in_a_loop() {
    let (young, yield_stress, modulus, rate) = (200.0, 0.4, 40.0, 80.0);
    let hex = Grid::new(Shape::Hex8, &[1, 1, 1], |p| p);
    let ring = Grid::new(Shape::Quad8, &[1, 1], |p| [p[0], p[1], 0.0]);
    let cases = [
        ("SmallDisplacementElement", "SmallStrainKinematicPlasticity3DVonMisesVonMises", &hex),
        ("SmallDisplacementBbarElement", "SmallStrainKinematicPlasticity3DVonMisesVonMises", &hex),
        ("AxisymSmallDisplacementElement", "SmallStrainKinematicPlasticityAxisymVonMisesVonMises", &ring),
    ];
    for (element, law, grid) in cases {
        // stress along y at the ends 0.02, -0.02 and 0.02 of the branches
        let run = |kind: usize, parameters: Value, steps: usize| {
            let variables = json!({"YOUNG_MODULUS": young, "POISSON_RATIO": 0.3, "YIELD_STRESS": yield_stress,
                "KINEMATIC_HARDENING_TYPE": kind, "KINEMATIC_PLASTICITY_PARAMETERS": parameters});
            let mut deck = Deck::new(grid, element, law, variables);
            deck.steps(1.0 / steps as f64, 3.0).gauss("CAUCHY_STRESS_VECTOR").gauss("PLASTIC_STRAIN_VECTOR");
            deck.gauss("BACK_STRESS_VECTOR");
            for axis in 0..grid.shape.dim() {
                deck.fix(|p| p[axis] == 0.0, std::array::from_fn(|a| if a == axis { json!(0.0) } else { FREE }));
            }
            deck.fix(|p| p[1] == 1.0, [FREE, json!("0.02*(t-1.5*(abs(t-1)+t-1)+2*(abs(t-2)+t-2))"), FREE]);
            deck.run()
        };
        let at = |ran: &super::deck::Ran, name: &str, step: usize| ran.gauss(name, step)[0].1[1];
        let tangent = young * modulus / (young + modulus);
        let first = yield_stress + tangent * (0.02 - yield_stress / young);
        let second = first - 2.0 * yield_stress - tangent * (0.04 - 2.0 * yield_stress / young);
        let linear = run(0, json!([modulus]), 4);
        assert_close(at(&linear, "CAUCHY_STRESS_VECTOR", 3), first, 1e-9, &format!("{element} pulled"));
        assert_close(at(&linear, "CAUCHY_STRESS_VECTOR", 7), second, 1e-9, &format!("{element} pushed"));
        assert_close(at(&linear, "BACK_STRESS_VECTOR", 7), (second + yield_stress) / 1.5, 1e-9, "the back stress");

        let steps = 100;
        let loops = run(1, json!([modulus, rate]), steps);
        let (limit, mut back, mut before, mut worst) = (modulus / rate, 0.0, 0.0, 0.0_f64);
        for (branch, sign) in [1.0, -1.0, 1.0].into_iter().enumerate() {
            let step = (branch + 1) * steps - 1;
            let plastic = at(&loops, "PLASTIC_STRAIN_VECTOR", step);
            back = sign * limit + (back - sign * limit) * f64::exp(-sign * rate * (plastic - before));
            before = plastic;
            worst = worst.max((at(&loops, "CAUCHY_STRESS_VECTOR", step) - back - sign * yield_stress).abs() / limit);
        }
        println!("{element}: loop of Armstrong and Frederick off by {worst:.2e} of C/γ");
        assert!(worst < 6e-3, "{element}: {worst:e}");
    }
}

/// Under finite strain Kirchhoff stress over logarithmic strain is the same law: after pulling to twice the length
/// τ = σ_y + E H/(E + H) (ln 2 − σ_y/E). The element is free to contract; 1e-8 of the iteration.
#[test]
fn a_bar_pulled_to_twice_its_length() {
    let (young, hardening, yield_stress) = (200.0, 20.0, 0.4);
    let variables = json!({"YOUNG_MODULUS": young, "POISSON_RATIO": 0.3, "YIELD_STRESS": yield_stress,
        "ISOTROPIC_HARDENING_MODULUS": hardening});
    for element in ["TotalLagrangianElement", "UpdatedLagrangianElement"] {
        let grid = Grid::new(Shape::Hex8, &[2, 1, 1], |p| p);
        let law = "FiniteStrainIsotropicPlasticity3DVonMisesVonMises";
        let mut deck = Deck::new(&grid, element, law, variables.clone());
        deck.steps(0.05, 1.0).gauss("KIRCHHOFF_STRESS_VECTOR").gauss("UNIAXIAL_STRESS");
        for axis in 0..3 {
            deck.fix(|p| p[axis] == 0.0, std::array::from_fn(|a| if a == axis { json!(0.0) } else { FREE }));
        }
        deck.fix(|p| p[0] == 1.0, [json!("1.0*t"), FREE, FREE]);
        let ran = deck.run();
        let last = ran.times().len() - 1;
        let slope = young * hardening / (young + hardening);
        let expected = yield_stress + slope * (2.0_f64.ln() - yield_stress / young);
        for name in ["KIRCHHOFF_STRESS_VECTOR", "UNIAXIAL_STRESS"] {
            for (_, stress) in ran.gauss(name, last) {
                assert_close(stress[0], expected, 1e-8, &format!("{element} {name}"));
            }
        }
        let iterations: usize = ran.report.steps.iter().map(|step| step.iterations.len()).max().expect("steps");
        assert!(iterations <= 6, "{element}: {iterations} iterations, the tangent is not consistent");
    }
}

/// A step to three times the length fails and is cut. Had its attempts left plastic strains behind, the end would not be that of the
/// closed form, which knows one pull only: 1e-6, by the looser iteration.
#[test]
fn a_cut_step_restores_the_plastic_strains() {
    let (young, hardening, yield_stress) = (200.0, 20.0, 0.4);
    let variables = json!({"YOUNG_MODULUS": young, "POISSON_RATIO": 0.3, "YIELD_STRESS": yield_stress,
        "ISOTROPIC_HARDENING_MODULUS": hardening});
    let grid = Grid::new(Shape::Hex8, &[2, 1, 1], |p| p);
    let law = "FiniteStrainIsotropicPlasticity3DVonMisesVonMises";
    let mut deck = Deck::new(&grid, "TotalLagrangianElement", law, variables);
    deck.steps(1.0, 1.0).set("max_iteration", json!(4)).gauss("UNIAXIAL_STRESS").gauss("EQUIVALENT_PLASTIC_STRAIN");
    deck.set("residual_relative_tolerance", json!(1e-6)).set("residual_absolute_tolerance", json!(1e-8));
    deck.set("continue_if_converging", json!(false));
    for axis in 0..3 {
        deck.fix(|p| p[axis] == 0.0, std::array::from_fn(|a| if a == axis { json!(0.0) } else { FREE }));
    }
    deck.fix(|p| p[0] == 1.0, [json!("2.0*t"), FREE, FREE]);
    let ran = deck.run();
    assert!(ran.report.steps.iter().any(|step| !step.converged), "no step was cut");
    let last = ran.times().len() - 1;
    let alpha = (young * 3.0_f64.ln() - yield_stress) / (young + hardening);
    for (_, found) in ran.gauss("EQUIVALENT_PLASTIC_STRAIN", last) {
        assert_close(found[0], alpha, 1e-6, "equivalent plastic strain");
    }
    for (_, found) in ran.gauss("UNIAXIAL_STRESS", last) {
        assert_close(found[0], yield_stress + hardening * alpha, 1e-6, "stress");
    }
}

/// Under a traction beyond the yield stress a perfectly plastic bar has no equilibrium: the run ends as not converged (exit code 3),
/// with the converged steps on disk, and names the place and the remedy. Steps are cut up to the yield stress.
#[test]
fn a_load_beyond_the_limit_ends_the_run_with_what_converged() {
    let grid = Grid::new(Shape::Hex8, &[2, 1, 1], |p| p);
    let variables = json!({"YOUNG_MODULUS": 200.0, "POISSON_RATIO": 0.3, "YIELD_STRESS": 0.4,
        "ISOTROPIC_HARDENING_MODULUS": 0.0});
    let mut deck = Deck::new(&grid, "SmallDisplacementElement", "SmallStrainJ2Plasticity3DLaw", variables);
    deck.steps(0.25, 1.0);
    for axis in 0..3 {
        deck.fix(|p| p[axis] == 0.0, std::array::from_fn(|a| if a == axis { json!(0.0) } else { FREE }));
    }
    let load = [json!("0.6*t"), json!(0.0), json!(0.0)];
    deck.vector_load(|p| p[0] == 1.0, "SurfaceLoadCondition", "SURFACE_LOAD", load);
    let (result, ran) = deck.attempt();
    let said = match result {
        Err(zelus_core::Error::NotConverged(said)) => said,
        other => panic!("{other:?}"),
    };
    for words in ["step ", "iteration", "DISPLACEMENT_", "of node", "of the step by", "are written", "Try"] {
        assert!(said.contains(words), "no {words:?} in {said}");
    }
    let times = ran.times();
    let last = times[times.len() - 1];
    assert!(times[..2] == [0.25, 0.5] && (0.6..=2.0 / 3.0 + 1e-9).contains(&last), "{times:?}: {said}");
}
