//! Rubber: inflated tubes and spheres, a twisted cylinder, bonded blocks, relaxation; nearly incompressible, κ/μ up to 10⁴.

use std::f64::consts::PI;

use serde_json::{Value, json};
use zelus_core::geometry::Shape;

use super::deck::{Deck, assert_close};
use super::elastic::ring;
use super::grid::Grid;

const FREE: Value = Value::Null;
const C10: f64 = 0.4;
const C01: f64 = 0.1;
/// μ = 2 (C₁₀ + C₀₁).
const MU: f64 = 1.0;

fn mooney(bulk: f64) -> Value {
    json!({"C10": C10, "C01": C01, "BULK_MODULUS": bulk})
}

/// ∫ f from `a` to `b` by Simpson's rule.
fn integral(a: f64, b: f64, f: impl Fn(f64) -> f64) -> f64 {
    let n = 2000;
    let h = (b - a) / f64::from(n);
    let weight = |k: i32| {
        if k == 0 || k == n {
            1.0
        } else if k % 2 == 1 {
            4.0
        } else {
            2.0
        }
    };
    (0..=n).map(|k| weight(k) * f(a + h * f64::from(k))).sum::<f64>() * h / 3.0
}

/// A tube of incompressible Mooney–Rivlin rubber, R from 1 to 2, whose inner radius becomes 1.5: with r² = R² + c and λ = r/R the inner
/// pressure is ∫ μ (λ² − λ⁻²) dr/r (Rivlin, 1949). The rubber is compressible with κ/μ = 10⁴: 1e-4 of it, and of the mesh. The pressure
/// of the body at Gauss points, ½ μ-terms included, lies on the exact curve: it does not oscillate.
#[test]
fn a_tube_is_inflated_in_plane_strain() {
    let (a, b, inner) = (1.0_f64, 2.0_f64, 1.5_f64);
    let c = inner * inner - a * a;
    let slope = |r: f64| {
        let square = r * r / (r * r - c);
        MU * (square - 1.0 / square) / r
    };
    let outer = (b * b + c).sqrt();
    let pressure = integral(inner, outer, slope);
    for (element, shape, divisions, tolerance) in [
        ("TotalLagrangianQ2P1MixedElement", Shape::Quad9, [4, 4], 2e-4),
        ("TotalLagrangianQ1P0MixedElement", Shape::Quad4, [12, 12], 5e-3),
        ("TotalLagrangianQ1P0MixedElement", Shape::Quad9, [6, 6], 1e-3),
        ("TotalLagrangianQ1P0MixedElement", Shape::Tri6, [8, 8], 5e-3),
        ("TotalLagrangianMixedVolumetricStrainElement", Shape::Tri3, [16, 16], 2e-2),
    ] {
        let grid = Grid::new(shape, &divisions, ring(a, b));
        let mut deck = Deck::new(&grid, element, "HyperElasticMooneyRivlinPlaneStrain2DLaw", mooney(1e4 * MU));
        deck.steps(0.1, 1.0).gauss("CAUCHY_STRESS_VECTOR").set("max_iteration", json!(30));
        if shape == Shape::Tri3 {
            // the forces of nodal volumes have the round-off of κ
            deck.set("residual_relative_tolerance", json!(1e-7));
        }
        deck.fix(|p| p[1] == 0.0, [FREE, json!(0.0), FREE]).fix(|p| p[1] == 1.0, [json!(0.0), FREE, FREE]);
        let load = json!(format!("{pressure}*t"));
        deck.scalar_load(|p| p[0] == 0.0, "LineLoadCondition", "NEGATIVE_FACE_PRESSURE", load);
        let ran = deck.run();
        let node = grid.nodes_where(|p| p == [0.0; 3])[0];
        let found = 1.0 + ran.last("DISPLACEMENT", node)[0];
        println!("{element} {shape:?}: inner radius off by {:.1e}", found / inner - 1.0);
        assert_close(found, inner, tolerance, &format!("{element} {shape:?}: inner radius"));
        // radial and hoop stress along the first sector: their difference is exact by λ, their level by the load
        let of_tests = ran.gauss("CAUCHY_STRESS_VECTOR", ran.times().len() - 1);
        let largest = of_tests.iter().flat_map(|(_, s)| s[..2].to_vec()).fold(0.0_f64, |most, s| most.max(s.abs()));
        let hoop = slope(inner) * inner - pressure;
        println!("  largest stress {largest:.4}, hoop stress at the hole {hoop:.4}");
        assert!(largest < 1.25 * hoop.max(pressure), "{element} {shape:?}: stresses up to {largest} instead of {hoop}");
    }
}

/// A sphere of the same rubber as a solid of revolution, R from 1 to 2, whose inner radius becomes 1.3: with r³ = R³ + c and λ = r/R the
/// pressure is ∫ 4 (λ² − λ⁻⁴)(C₁₀ + λ² C₀₁) dr/r (Green and Shield, 1950). 1e-4 of κ/μ = 10⁴, and of the mesh.
#[test]
fn a_sphere_is_inflated_about_its_axis() {
    let (a, b, inner) = (1.0_f64, 2.0_f64, 1.3_f64);
    let c = inner.powi(3) - a.powi(3);
    let slope = |r: f64| {
        let square = (r / (r.powi(3) - c).cbrt()).powi(2);
        4.0 * (square - 1.0 / (square * square)) * (C10 + square * C01) / r
    };
    let pressure = integral(inner, (b.powi(3) + c).cbrt(), slope);
    for (element, shape, divisions, tolerance) in [
        ("AxisymTotalLagrangianQ2P1MixedElement", Shape::Quad9, [4, 4], 6e-4),
        ("AxisymTotalLagrangianQ1P0MixedElement", Shape::Quad4, [12, 12], 5e-3),
    ] {
        let grid = Grid::new(shape, &divisions, ring(a, b));
        let mut deck = Deck::new(&grid, element, "HyperElasticMooneyRivlinAxisym2DLaw", mooney(1e4 * MU));
        deck.steps(0.1, 1.0).set("max_iteration", json!(30));
        deck.fix(|p| p[1] == 0.0, [FREE, json!(0.0), FREE]).fix(|p| p[1] == 1.0, [json!(0.0), FREE, FREE]);
        let load = json!(format!("{pressure}*t"));
        deck.scalar_load(|p| p[0] == 0.0, "AxisymLineLoadCondition", "NEGATIVE_FACE_PRESSURE", load);
        let ran = deck.run();
        for end in [0.0, 1.0] {
            let node = grid.nodes_where(|p| p == [0.0, end, 0.0])[0];
            let u = ran.last("DISPLACEMENT", node);
            println!("{element} {shape:?}: inner radius off by {:.1e}", (1.0 + u[end as usize]) / inner - 1.0);
            assert_close(1.0 + u[end as usize], inner, tolerance, &format!("{element}: inner radius"));
        }
    }
}

/// A cylinder of radius 1 twisted by ψ per length, its length held: torque ½ π μ ψ a⁴, normal force −½ π ψ² a⁴ (C₁₀ + 2 C₀₁) on the ends
/// (Rivlin, 1949). Torque 1e-3, force 2e-2 for 36 cells: those at
/// the ends of the diagonals have a corner of 180°. κ/μ = 10³.
#[test]
fn a_twisted_cylinder_pushes_its_ends_apart() {
    let (twist, height): (f64, f64) = (0.8, 0.25);
    let disc = |p: [f64; 3]| {
        let (u, v) = (2.0 * p[0] - 1.0, 2.0 * p[1] - 1.0);
        [u * (1.0 - 0.5 * v * v).sqrt(), v * (1.0 - 0.5 * u * u).sqrt(), height * p[2]]
    };
    let grid = Grid::new(Shape::Hex27, &[6, 6, 1], disc);
    let mut deck =
        Deck::new(&grid, "TotalLagrangianQ2P1MixedElement", "HyperElasticMooneyRivlin3DLaw", mooney(1e3 * MU));
    deck.steps(0.25, 1.0).set("max_iteration", json!(30));
    let angle = twist * height;
    let turned = [
        json!(format!("X*(cos({angle}*t)-1)-Y*sin({angle}*t)")),
        json!(format!("X*sin({angle}*t)+Y*(cos({angle}*t)-1)")),
        json!(0.0),
    ];
    deck.fix(|p| p[2] == 0.0, [json!(0.0), json!(0.0), json!(0.0)]).fix(|p| p[2] == 1.0, turned);
    let ran = deck.run();
    let last = ran.times().len() - 1;
    let top = grid.nodes_where(|p| p[2] == 1.0);
    let torque: f64 = top
        .iter()
        .map(|&node| {
            let (x, r) = (grid.nodes[node], ran.vector("REACTION", node, last));
            let (s, c) = angle.sin_cos();
            let (x, y) = (c * x[0] - s * x[1], s * x[0] + c * x[1]);
            x * r[1] - y * r[0]
        })
        .sum();
    let force = ran.reaction(&top, last)[2];
    let (of_torque, of_force) = (0.5 * PI * MU * twist, -0.5 * PI * twist * twist * (C10 + 2.0 * C01));
    println!("torque off by {:.1e}, force off by {:.1e}", torque / of_torque - 1.0, force / of_force - 1.0);
    assert_close(torque, of_torque, 1e-3, "torque");
    assert_close(force, of_force, 2e-2, "normal force");
}

/// A long block bonded to rigid plates, S = width/(2 thickness) = 5: the apparent modulus at small compression is 4/3 E (1 + S²) (Gent and
/// Lindley, 1959), an approximation with parabolic pressure: 3 %. The compressibility, κ/μ = 10⁴, enters as 1/E_a + 1/κ.
#[test]
fn a_bonded_block_is_stiff_by_its_shape() {
    let (width, thickness, strain) = (10.0, 1.0, 1e-3);
    let shape_factor: f64 = width / (2.0 * thickness);
    let bulk = 1e4 * MU;
    let expected = 1.0 / (1.0 / (4.0 / 3.0 * 3.0 * MU * (1.0 + shape_factor * shape_factor)) + 1.0 / bulk);
    for (element, shape, divisions) in [
        ("TotalLagrangianQ2P1MixedElement", Shape::Quad9, [20, 4]),
        ("TotalLagrangianQ1P0MixedElement", Shape::Quad4, [60, 12]),
    ] {
        let grid = Grid::new(shape, &divisions, |p| [width * p[0], thickness * p[1], 0.0]);
        let law = "HyperElasticOgdenPlaneStrain2DLaw";
        let constants = json!({"OGDEN_MODULI": [0.6, -0.4], "OGDEN_EXPONENTS": [2.0, -2.0], "BULK_MODULUS": bulk});
        let mut deck = Deck::new(&grid, element, law, constants);
        deck.fix(|p| p[1] == 0.0, [json!(0.0), json!(0.0), FREE]);
        deck.fix(|p| p[1] == 1.0, [json!(0.0), json!(format!("{}*t", -strain * thickness)), FREE]);
        let ran = deck.run();
        let force = -ran.reaction(&grid.nodes_where(|p| p[1] == 1.0), 0)[1];
        let found = force / (width * strain);
        println!("{element}: apparent modulus off by {:.2} %", 100.0 * (found / expected - 1.0));
        assert_close(found, expected, 0.03, element);
    }
}

/// Simple shear that grows in the first step and stays: τ = μ γ (1 − Σ g_i + Σ g_i ξ(Δt/τ_i) exp(−(t − Δt)/τ_i)), exact in steps of any
/// length: 1e-9 of the iteration.
#[test]
fn sheared_rubber_relaxes() {
    let (gamma, step) = (0.6, 0.5);
    for (element, law, shape) in [
        ("TotalLagrangianElement", "HyperElasticMooneyRivlin3DLaw", Shape::Hex8),
        ("TotalLagrangianQ1P0MixedElement", "HyperElasticMooneyRivlinPlaneStrain2DLaw", Shape::Quad4),
        ("SmallDisplacementElement", "SmallStrainViscoelasticityPlaneStrain", Shape::Quad4),
    ] {
        let grid = Grid::new(shape, &[1, 1, 1][..shape.dim()], |p| p);
        let constants = json!({"C10": C10, "C01": C01, "BULK_MODULUS": 100.0, "YOUNG_MODULUS": 2.5, "POISSON_RATIO": 0.25,
            "PRONY_SHARES": [0.3, 0.2], "PRONY_TIMES": [0.4, 3.0]});
        let mut deck = Deck::new(&grid, element, law, constants);
        deck.steps(step, 3.0).gauss("CAUCHY_STRESS_VECTOR");
        deck.fix(|_| true, [json!(format!("{gamma}*Y")), json!(0.0), json!(0.0)]);
        let ran = deck.run();
        for (at, t) in ran.times().into_iter().enumerate() {
            let branch = |share: f64, time: f64| {
                let x: f64 = step / time;
                share * ((1.0 - (-x).exp()) / x * (-(t - step) / time).exp() - 1.0)
            };
            let expected = MU * gamma * (1.0 + branch(0.3, 0.4) + branch(0.2, 3.0));
            let stress = &ran.gauss("CAUCHY_STRESS_VECTOR", at)[0].1;
            assert_close(stress[if shape.dim() == 2 { 2 } else { 3 }], expected, 1e-9, &format!("{element} at {t}"));
        }
    }
}

/// Simple shear to γ = 1.2 and back: W = ½ μ γ², and below its largest value τ = η μ γ, η = 1 − erf((W_m − W)/(m + β W_m))/r. The history
/// is that of accepted steps: 1e-9 of the iteration.
#[test]
fn unloaded_rubber_is_softer() {
    let (ratio, energy, slope): (f64, f64, f64) = (1.5, 0.2, 0.1);
    let grid = Grid::new(Shape::Hex8, &[1, 1, 1], |p| p);
    let constants = json!({"C10": C10, "C01": C01, "BULK_MODULUS": 100.0, "MULLINS_R": ratio, "MULLINS_M": energy,
        "MULLINS_BETA": slope});
    let mut deck = Deck::new(&grid, "TotalLagrangianQ1P0MixedElement", "HyperElasticMooneyRivlin3DLaw", constants);
    deck.steps(0.25, 2.0).gauss("CAUCHY_STRESS_VECTOR").gauss("DAMAGE");
    let shear = |t: f64| 1.2 * (0.5 * PI * t).sin();
    deck.fix(|_| true, [json!("1.2*sin(0.5*pi*t)*Y"), json!(0.0), json!(0.0)]);
    let ran = deck.run();
    let (largest, mut lost) = (0.5 * MU * 1.44, Vec::new());
    for (at, t) in ran.times().into_iter().enumerate() {
        let gamma = shear(t);
        let u = if t > 1.0 { (largest - 0.5 * MU * gamma * gamma) / (energy + slope * largest) } else { 0.0 };
        // erf by its integral
        let factor = 1.0 - 2.0 / PI.sqrt() * integral(0.0, u, |x| (-x * x).exp()) / ratio;
        let stress = ran.gauss("CAUCHY_STRESS_VECTOR", at)[0].1[3];
        assert!((stress - factor * MU * gamma).abs() < 1e-9, "at {t}: {stress} instead of {}", factor * MU * gamma);
        lost.push(ran.gauss("DAMAGE", at)[0].1[0]);
        assert!((lost[at] - (1.0 - factor)).abs() < 1e-9, "at {t}: {}", lost[at]);
    }
    assert!(lost[7] > 0.5, "{lost:?}");
}

/// Constants that lose stability within the stretches 0.5 to 2 are named before the run, and elements that lock are.
#[test]
fn unstable_constants_and_locking_are_named() {
    let grid = Grid::new(Shape::Quad4, &[1, 1], |p| p);
    let mut deck = Deck::new(
        &grid,
        "TotalLagrangianElement",
        "HyperElasticYeohPlaneStrain2DLaw",
        json!({"C10": 0.5, "C20": -0.1, "C30": 0.0, "BULK_MODULUS": 1e4}),
    );
    deck.fix(|_| true, [json!(0.0), json!(0.0), FREE]);
    let said = deck.run().report.warnings;
    let has = |words: &[&str]| said.iter().any(|text| words.iter().all(|word| text.contains(word)));
    assert!(has(&["HyperElasticYeoh", "is not stable from the", "stretch"]), "{said:?}");
    assert!(has(&["locks at BULK_MODULUS", "TotalLagrangianQ1P0MixedElement2D4N"]), "{said:?}");
}
