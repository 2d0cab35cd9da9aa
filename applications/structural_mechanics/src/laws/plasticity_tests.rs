use zelus_core::model::{Properties, PropertyValue};

use super::small_strain_plasticity::remembered;
use super::*;
use crate::tensor::*;
use crate::test_model::{Random, near, size};

const E: f64 = 200.0;
const NU: f64 = 0.3;
const YIELD: f64 = 0.4;
const H: f64 = 20.0;
const LINEAR: &[(&str, f64)] = &[("YIELD_STRESS", YIELD), ("ISOTROPIC_HARDENING_MODULUS", H)];
const SATURATING: &[(&str, f64)] = &[
    ("YIELD_STRESS", YIELD),
    ("ISOTROPIC_HARDENING_MODULUS", 5.0),
    ("EXPONENTIAL_SATURATION_YIELD_STRESS", 0.7),
    ("HARDENING_EXPONENT", 30.0),
];
const PERFECT: &[(&str, f64)] = &[("YIELD_STRESS", YIELD), ("HARDENING_CURVE", 3.0)];
const SMALL: &str = "SmallStrainJ2Plasticity3DLaw";
const FINITE: &str = "FiniteStrainIsotropicPlasticity3DVonMisesVonMises";

fn properties(name: &str, values: &[(&str, f64)]) -> Properties {
    let mut properties = Properties::new(1);
    properties.law = Some(name.to_owned());
    for (name, value) in [("YOUNG_MODULUS", E), ("POISSON_RATIO", NU)].iter().chain(values) {
        properties.values.insert((*name).to_owned(), PropertyValue::Number(*value));
    }
    properties
}

fn law<const S: usize>(name: &str, values: &[(&str, f64)]) -> Box<dyn ConstitutiveLaw<S>>
where
    LawFactory: MakesLaw<S>,
{
    law_of(&properties(name, values), S == 3).unwrap()
}

/// A state of Green–Lagrange strain with this history; `f` is only there for measures other than PK2.
fn state<const S: usize>(strain: [f64; S], f: Tensor, history: &[f64]) -> StrainState<'_, S> {
    StrainState { strain, f, det_f: f.determinant(), small: false, history, ..StrainState::REST }
}

fn green<const S: usize>(f: &Tensor) -> [f64; S] {
    strain_vector(&(0.5 * (f.transpose() * f - IDENTITY)))
}

/// History after the strain, starting from `history`.
fn advanced<const S: usize>(law: &dyn ConstitutiveLaw<S>, strain: [f64; S], history: &[f64]) -> Vec<f64> {
    let mut next = history.to_vec();
    law.advance(&state(strain, IDENTITY, history), &mut next);
    next
}

fn check_tangent<const S: usize>(name: &str, values: &[(&str, f64)])
where
    LawFactory: MakesLaw<S>,
{
    let law = law::<S>(name, values);
    let mut random = Random(31);
    for round in 0..20 {
        let mut history = vec![0.0; 7];
        for _ in 0..round % 3 {
            let strain = std::array::from_fn(|_| 0.05 * random.next());
            history = advanced(law.as_ref(), strain, &history);
        }
        // the last rounds: equal stretches, and the state just accepted
        let strain: [f64; S] = match round {
            18 => strain_vector(&Tensor::from_diagonal(&[0.01, 0.01, -0.01].into())),
            _ => std::array::from_fn(|_| 0.05 * random.next()),
        };
        let mut d = [[0.0; S]; S];
        let stress = law.pk2(&state(strain, IDENTITY, &history), Some(&mut d));
        assert_eq!(stress, law.pk2(&state(strain, IDENTITY, &history), None));
        let h = 1e-6;
        for t in 0..S {
            let at = |step: f64| {
                let mut moved = strain;
                moved[t] += step;
                law.pk2(&state(moved, IDENTITY, &history), None)
            };
            let (plus, minus) = (at(h), at(-h));
            for s in 0..S {
                let slope = (plus[s] - minus[s]) / (2.0 * h);
                assert!(near(d[s][t], slope, 1e-6 * E), "{name} {round} D[{s}][{t}] {} {slope}", d[s][t]);
                assert!(near(d[s][t], d[t][s], 1e-12 * E), "{name}: D is symmetric");
            }
        }
        let after = advanced(law.as_ref(), strain, &history);
        let again = law.pk2(&state(strain, IDENTITY, &after), None);
        assert!((0..S).all(|s| near(again[s], stress[s], 1e-12 * E)), "{name}: the accepted state keeps its stress");
    }
}

#[test]
fn tangents_are_those_of_the_return() {
    for values in [LINEAR, SATURATING, PERFECT] {
        check_tangent::<6>(SMALL, values);
        check_tangent::<3>("SmallStrainJ2PlasticityPlaneStrain2DLaw", values);
        check_tangent::<4>("SmallStrainJ2PlasticityAxisym2DLaw", values);
        check_tangent::<6>(FINITE, values);
        check_tangent::<3>("FiniteStrainIsotropicPlasticityPlaneStrainVonMisesVonMises", values);
        check_tangent::<4>("FiniteStrainIsotropicPlasticityAxisymVonMisesVonMises", values);
    }
}

/// The lateral strain that leaves no lateral stress, by bisection, for an axial strain in a history.
fn lateral(law: &dyn ConstitutiveLaw<6>, axial: f64, history: &[f64]) -> [f64; 6] {
    let at = |lateral: f64| [axial, lateral, lateral, 0.0, 0.0, 0.0];
    let (mut low, mut high) = (-0.45, 0.9);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        let stress = law.pk2(&state(at(middle), IDENTITY, history), None)[1];
        if stress > 0.0 {
            high = middle;
        } else {
            low = middle;
        }
    }
    at(0.5 * (low + high))
}

/// Stress over strain of a bar with linear hardening, by its own history: plastic strain and equivalent plastic strain.
fn bar(strain: f64, plastic: &mut f64, alpha: &mut f64) -> f64 {
    let trial = E * (strain - *plastic);
    let excess = trial.abs() - YIELD - H * *alpha;
    let delta = excess.max(0.0) / (E + H);
    *plastic += delta * trial.signum();
    *alpha += delta;
    E * (strain - *plastic)
}

#[test]
fn a_bar_follows_the_closed_form_through_loading_and_unloading() {
    let law = law::<6>(SMALL, LINEAR);
    let (mut history, mut plastic, mut alpha) = (vec![0.0; 7], 0.0, 0.0);
    for strain in [0.001, 0.004, 0.01, 0.008, 0.005, -0.002, -0.006, 0.0, 0.012] {
        let whole = lateral(law.as_ref(), strain, &history);
        let stress = law.pk2(&state(whole, IDENTITY, &history), None);
        let expected = bar(strain, &mut plastic, &mut alpha);
        assert!(near(stress[0], expected, 1e-12) && size(&stress[1..]) < 1e-12, "{strain}: {stress:?} {expected}");
        history = advanced(law.as_ref(), whole, &history);
        let (tensor, own) = remembered(&history);
        assert!(near(own, alpha, 1e-14) && near(tensor[(0, 0)], plastic, 1e-14) && near(tensor.trace(), 0.0, 1e-15));
    }
}

/// With logarithmic strain and Kirchhoff stress a bar under finite strain has the closed form of small strain.
#[test]
fn a_stretched_bar_follows_the_closed_form_in_logarithms() {
    let law = law::<6>(FINITE, LINEAR);
    let (mut history, mut plastic, mut alpha) = (vec![0.0; 7], 0.0, 0.0);
    for log in [0.001, 0.1, 0.3, 0.299, 0.25, -0.2, -0.4, 0.5] {
        let stretch: f64 = f64::exp(log);
        let whole = lateral(law.as_ref(), 0.5 * (stretch * stretch - 1.0), &history);
        let stress = law.pk2(&state(whole, IDENTITY, &history), None);
        let expected = bar(log, &mut plastic, &mut alpha);
        assert!(near(stress[0] * stretch * stretch, expected, 1e-11), "{log}: {} {expected}", stress[0]);
        history = advanced(law.as_ref(), whole, &history);
        let (g, own) = remembered(&history);
        assert!(near(own, alpha, 1e-13) && near((IDENTITY + g).determinant(), 1.0, 1e-13));
        let mut out = Vec::new();
        assert!(law.internal(&state([0.0; 6], IDENTITY, &history), "PLASTIC_STRAIN_VECTOR", &mut out));
        assert!(near(out[0], plastic, 1e-13) && near(out[1], -0.5 * plastic, 1e-13));
    }
}

/// A motion that turns after the step R F gives the same S and history, and the Cauchy stress turned.
#[test]
fn finite_strain_does_not_see_rotations() {
    let law = law::<6>(FINITE, SATURATING);
    let mut random = Random(32);
    let mut deform = || IDENTITY + Tensor::from_fn(|_, _| 0.3 * random.next());
    let (s, c) = 0.8_f64.sin_cos();
    let turn = Tensor::new(c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0) * Tensor::new(1.0, 0.0, 0.0, 0.0, c, -s, 0.0, s, c);
    let (first, second) = (deform(), deform());
    let history = advanced(law.as_ref(), green(&first), &[0.0; 7]);
    assert!(remembered(&history).1 > 0.0);
    let turned = turn * second;
    let (mut a, mut b) = ([[0.0; 6]; 6], [[0.0; 6]; 6]);
    let cauchy = |f: &Tensor, d| law.stress(&state(green(f), *f, &history), StressMeasure::Cauchy, Some(d));
    let (plain, other) = (cauchy(&second, &mut a), cauchy(&turned, &mut b));
    let expected = stress_vector::<6>(&congruent(&turn, &stress_tensor(&plain)));
    assert!((0..6).all(|v| near(other[v], expected[v], 1e-12 * E)), "{other:?} {expected:?}");
    let pushed = push_forward(&a, &turn, 1.0);
    assert!((0..6).all(|v| (0..6).all(|w| near(b[v][w], pushed[v][w], 1e-11 * E))));
    // a rotation before the first step rotates the history with it
    let earlier = first * turn;
    let before = advanced(law.as_ref(), green(&earlier), &[0.0; 7]);
    let carried = congruent(&turn.transpose(), &remembered(&history).0);
    let found = remembered(&before).0;
    assert!((0..3).all(|i| (0..3).all(|j| near(found[(i, j)], carried[(i, j)], 1e-12))));
}

#[test]
fn small_strains_give_the_law_of_small_strain() {
    let (small, finite) = (law::<6>(SMALL, SATURATING), law::<6>(FINITE, SATURATING));
    let mut random = Random(33);
    let scale = 1e-3 * YIELD / E;
    let values = [("YIELD_STRESS", 1e-3 * YIELD), ("ISOTROPIC_HARDENING_MODULUS", 5.0)];
    let (tiny_small, tiny_finite) = (law::<6>(SMALL, &values), law::<6>(FINITE, &values));
    let strain: [f64; 6] = std::array::from_fn(|_| 10.0 * scale * random.next());
    let (a, b) = (
        tiny_small.pk2(&state(strain, IDENTITY, &[0.0; 7]), None),
        tiny_finite.pk2(&state(strain, IDENTITY, &[0.0; 7]), None),
    );
    assert!((0..6).all(|v| near(a[v], b[v], 1e-4 * size(&a))), "{a:?} {b:?}");
    // and they differ where strains are large
    let strain = strain.map(|e| e * 1e4);
    let (a, b) =
        (small.pk2(&state(strain, IDENTITY, &[0.0; 7]), None), finite.pk2(&state(strain, IDENTITY, &[0.0; 7]), None));
    assert!((0..6).any(|v| !near(a[v], b[v], 1e-2 * size(&a))));
}

#[test]
fn plane_strain_is_the_solid_without_strain_across() {
    let mut random = Random(34);
    for (plane, solid) in [
        (
            "SmallStrainIsotropicPlasticityPlaneStrainVonMisesVonMises",
            "SmallStrainIsotropicPlasticity3DVonMisesVonMises",
        ),
        ("FiniteStrainIsotropicPlasticityPlaneStrainVonMisesVonMises", FINITE),
    ] {
        let (plane, solid) = (law::<3>(plane, LINEAR), law::<6>(solid, LINEAR));
        let (mut a, mut b) = (vec![0.0; 7], vec![0.0; 7]);
        for _ in 0..4 {
            let [x, y, xy]: [f64; 3] = std::array::from_fn(|_| 0.03 * random.next());
            let whole = [x, y, 0.0, xy, 0.0, 0.0];
            let p = plane.pk2(&state([x, y, xy], IDENTITY, &a), None);
            let s = solid.pk2(&state(whole, IDENTITY, &b), None);
            assert!(near(p[0], s[0], 1e-12) && near(p[1], s[1], 1e-12) && near(p[2], s[3], 1e-12));
            (a, b) = (advanced(plane.as_ref(), [x, y, xy], &a), advanced(solid.as_ref(), whole, &b));
        }
        assert!(a.iter().zip(&b).all(|(a, b)| near(*a, *b, 1e-14)) && a[2] != 0.0);
    }
}

#[test]
fn curves_of_hardening() {
    let vector = |values: &[f64]| PropertyValue::Vector(values.to_vec());
    let mut curve = properties(SMALL, &[("YIELD_STRESS", YIELD), ("HARDENING_CURVE", 6.0)]);
    curve.values.insert("EQUIVALENT_STRESS_VECTOR_PLASTICITY_POINT_CURVE".into(), vector(&[1.0, 1.5, 1.6]));
    curve.values.insert("PLASTIC_STRAIN_VECTOR_PLASTICITY_POINT_CURVE".into(), vector(&[0.0, 0.1, 0.3]));
    let points = Hardening::of(&curve).unwrap();
    assert_eq!((points.at(0.0), points.at(0.4)), ((1.0, 5.0), (1.6, 0.0)));
    assert!(near(points.at(0.05).0, 1.25, 1e-14) && near(points.at(0.2).1, 0.5, 1e-14));
    let mut total = curve.clone();
    total.values.remove("PLASTIC_STRAIN_VECTOR_PLASTICITY_POINT_CURVE");
    let strains = [0.005, 0.1 + 1.5 / E, 0.3 + 1.6 / E];
    total.values.insert("TOTAL_STRAIN_VECTOR_PLASTICITY_POINT_CURVE".into(), vector(&strains));
    assert!(near(Hardening::of(&total).unwrap().at(0.05).0, 1.25, 1e-14));
    curve.values.insert("HARDENING_CURVE".into(), PropertyValue::Number(4.0));
    curve.values.insert("CURVE_FITTING_PARAMETERS".into(), vector(&[1.0, 2.0, -3.0]));
    curve.values.insert("PLASTIC_STRAIN_INDICATORS".into(), vector(&[0.1, 0.2]));
    curve.values.insert("TANGENCY_REGION2".into(), PropertyValue::Boolean(true));
    let polynomial = Hardening::of(&curve).unwrap();
    let (value, slope) = polynomial.at(0.05);
    assert!(near(value, 1.0 + 0.1 - 3.0 * 0.0025, 1e-14) && near(slope, 2.0 - 0.3, 1e-14));
    assert!(near(polynomial.at(0.15).1, 1.4, 1e-14) && polynomial.at(0.25).1 == 0.0);
    let refused = |values: &[(&str, f64)]| Hardening::of(&properties(SMALL, values)).unwrap_err().to_string();
    assert!(refused(&[("YIELD_STRESS", 1.0), ("HARDENING_CURVE", 1.0)]).contains("softens"));
    assert!(refused(&[("YIELD_STRESS", -1.0)]).contains("not positive"));
    assert!(refused(&[("YIELD_STRESS", 1.0), ("ISOTROPIC_HARDENING_MODULUS", -1.0)]).contains("falls"));
    assert!(refused(&[]).contains("have no YIELD_STRESS"));
}

/// In an elastic state a law answers as one that never yields, from the same history, and keeps that history.
#[test]
fn an_elastic_state_keeps_the_history() {
    for name in [SMALL, FINITE] {
        let [own, strong] = [YIELD, 1e6 * YIELD].map(|limit| law::<6>(name, &[("YIELD_STRESS", limit)]));
        let mut random = Random(7);
        let history = advanced(own.as_ref(), std::array::from_fn(|_| 0.05 * random.next()), &[0.0; 7]);
        assert!(history[6] > 0.0, "{name}: it has yielded");
        let strain: [f64; 6] = std::array::from_fn(|_| 0.05 * random.next());
        let state = StrainState { elastic: true, ..state(strain, IDENTITY, &history) };
        let [mut tangent, mut expected] = [[[0.0; 6]; 6]; 2];
        let found = own.pk2(&state, Some(&mut tangent));
        assert_eq!((found, tangent), (strong.pk2(&state, Some(&mut expected)), expected), "{name}");
        assert_ne!(found, own.pk2(&StrainState { elastic: false, ..state }, None), "{name}: it would yield");
        let mut next = history.clone();
        own.advance(&state, &mut next);
        assert!(size(&next.iter().zip(&history).map(|(a, b)| a - b).collect::<Vec<f64>>()) < 1e-14, "{name}");
    }
}
