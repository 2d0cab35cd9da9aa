use zelus_core::model::{Properties, PropertyValue};

use super::*;
use crate::test_model::{Random, near, size};

const E: f64 = 200.0;
const NU: f64 = 0.3;
const YIELD: f64 = 0.4;
const C: f64 = 40.0;
const RATE: f64 = 80.0;
const SPACE: &str = "SmallStrainKinematicPlasticity3DVonMisesVonMises";

fn properties(name: &str, kind: f64, parameters: &[f64], isotropic: f64) -> Properties {
    let mut properties = Properties::new(1);
    properties.law = Some(name.to_owned());
    for (name, value) in [
        ("YOUNG_MODULUS", E),
        ("POISSON_RATIO", NU),
        ("YIELD_STRESS", YIELD),
        ("ISOTROPIC_HARDENING_MODULUS", isotropic),
        ("KINEMATIC_HARDENING_TYPE", kind),
    ] {
        properties.values.insert(name.to_owned(), PropertyValue::Number(value));
    }
    let parameters = PropertyValue::Vector(parameters.to_vec());
    properties.values.insert("KINEMATIC_PLASTICITY_PARAMETERS".to_owned(), parameters);
    properties
}

fn law<const S: usize>(name: &str, kind: f64, parameters: &[f64], isotropic: f64) -> Box<dyn ConstitutiveLaw<S>>
where
    LawFactory: MakesLaw<S>,
{
    law_of(&properties(name, kind, parameters, isotropic), S == 3).unwrap()
}

fn state<const S: usize>(strain: [f64; S], history: &[f64]) -> StrainState<'_, S> {
    StrainState { strain, history, ..StrainState::REST }
}

fn advanced<const S: usize>(law: &dyn ConstitutiveLaw<S>, strain: [f64; S], history: &[f64]) -> Vec<f64> {
    let mut next = history.to_vec();
    law.advance(&state(strain, history), &mut next);
    next
}

fn check_tangent<const S: usize>(name: &str, kind: f64, parameters: &[f64], isotropic: f64)
where
    LawFactory: MakesLaw<S>,
{
    let law = law::<S>(name, kind, parameters, isotropic);
    let mut random = Random(41);
    let mut flows = 0;
    for round in 0..20 {
        let mut history = vec![0.0; 13];
        for _ in 0..round % 4 {
            let strain = std::array::from_fn(|_| 0.05 * random.next());
            history = advanced(law.as_ref(), strain, &history);
        }
        let strain: [f64; S] = std::array::from_fn(|_| 0.05 * random.next());
        let mut d = [[0.0; S]; S];
        let stress = law.pk2(&state(strain, &history), Some(&mut d));
        assert_eq!(stress, law.pk2(&state(strain, &history), None));
        let h = 1e-6;
        for t in 0..S {
            let at = |step: f64| {
                let mut moved = strain;
                moved[t] += step;
                law.pk2(&state(moved, &history), None)
            };
            let (plus, minus) = (at(h), at(-h));
            for s in 0..S {
                let slope = (plus[s] - minus[s]) / (2.0 * h);
                assert!(near(d[s][t], slope, 1e-6 * E), "{name} {round} D[{s}][{t}] {} {slope}", d[s][t]);
                let symmetric = near(d[s][t], d[t][s], 1e-12 * E);
                assert!(symmetric || !law.is_symmetric(true), "{name}: D is symmetric");
            }
        }
        let after = advanced(law.as_ref(), strain, &history);
        flows += usize::from(after[12] > history[12]);
        let again = law.pk2(&state(strain, &after), None);
        assert!((0..S).all(|s| near(again[s], stress[s], 1e-12 * E)), "{name}: the accepted state keeps its stress");
        // the von Mises stress of what is left of the back stress is the yield stress
        let mut out = Vec::new();
        assert!(law.internal(&state(strain, &after), "UNIAXIAL_STRESS", &mut out));
        assert!(near(out[0], YIELD + isotropic * after[12], 1e-12 * E), "{name}: {} on the surface", out[0]);
    }
    assert!(flows == 20, "{name}: every round flows");
}

#[test]
fn tangents_are_those_of_the_return() {
    for (kind, parameters, isotropic) in [
        (0.0, &[C][..], 0.0),
        (0.0, &[C], 20.0),
        (1.0, &[C, RATE], 0.0),
        (1.0, &[C, RATE], 20.0),
        (1.0, &[C, 0.0], 5.0),
    ] {
        check_tangent::<6>(SPACE, kind, parameters, isotropic);
        check_tangent::<3>("SmallStrainKinematicPlasticityPlaneStrainVonMisesVonMises", kind, parameters, isotropic);
        check_tangent::<4>("SmallStrainKinematicPlasticityAxisymVonMisesVonMises", kind, parameters, isotropic);
    }
}

/// Without kinematic hardening it is the law of isotropic hardening.
#[test]
fn without_a_back_stress_hardening_is_isotropic() {
    let mut random = Random(43);
    let isotropic = law_of::<6>(&properties("SmallStrainJ2Plasticity3DLaw", 0.0, &[0.0], 20.0), false).unwrap();
    let combined = law::<6>(SPACE, 1.0, &[0.0, RATE], 20.0);
    let (mut seven, mut thirteen) = (vec![0.0; 7], vec![0.0; 13]);
    for _ in 0..6 {
        let strain = std::array::from_fn(|_| 0.02 * random.next());
        let (one, other) = (isotropic.pk2(&state(strain, &seven), None), combined.pk2(&state(strain, &thirteen), None));
        assert!((0..6).all(|s| near(one[s], other[s], 1e-13 * E)), "{one:?} {other:?}");
        seven = advanced(isotropic.as_ref(), strain, &seven);
        thirteen = advanced(combined.as_ref(), strain, &thirteen);
    }
    assert!(seven[6] > 0.0 && near(seven[6], thirteen[12], 1e-14));
}

/// The strain of a bar without lateral stress at an axial strain, by bisection.
fn bar(law: &dyn ConstitutiveLaw<6>, axial: f64, history: &[f64]) -> [f64; 6] {
    let at = |lateral: f64| [axial, lateral, lateral, 0.0, 0.0, 0.0];
    let (mut low, mut high) = (-1.0, 1.0);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if law.pk2(&state(at(middle), history), None)[1] > 0.0 { high = middle } else { low = middle }
    }
    at(0.5 * (low + high))
}

/// Axial stress and axial plastic strain of a bar at the end of strains, each reached in as many steps.
fn path(law: &dyn ConstitutiveLaw<6>, ends: &[f64], steps: usize) -> Vec<[f64; 2]> {
    let (mut history, mut begin) = (vec![0.0; 13], 0.0);
    let mut out = Vec::new();
    for &end in ends {
        let mut stress = [0.0; 6];
        for step in 1..=steps {
            let strain = bar(law, begin + (end - begin) * step as f64 / steps as f64, &history);
            stress = law.pk2(&state(strain, &history), None);
            assert!(size(&stress[1..]) < 1e-12);
            history = advanced(law, strain, &history);
        }
        out.push([stress[0], history[0]]);
        begin = end;
    }
    out
}

/// Prager's hardening: σ = σ_y + E C/(E + C) (ε − σ_y/E), and after a reversal from σ_1 yielding begins at σ_1 − 2 σ_y (Bauschinger).
/// Exact in any step.
#[test]
fn linear_hardening_moves_the_yield_surface() {
    let law = law::<6>(SPACE, 0.0, &[C], 0.0);
    let tangent = E * C / (E + C);
    let first = YIELD + tangent * (0.02 - YIELD / E);
    let turn = 0.02 - 2.0 * YIELD / E;
    let back = first - 2.0 * YIELD + tangent * (-0.01 - turn);
    for steps in [1, 7] {
        let found = path(law.as_ref(), &[0.02, turn, -0.01], steps);
        let expected = [first, first - 2.0 * YIELD, back];
        for ([stress, _], expected) in found.iter().zip(expected) {
            assert!(near(*stress, expected, 1e-11), "{steps} steps: {stress} {expected}");
        }
        // elastic up to the reversed yield stress
        assert!(near(found[0][1], found[1][1], 1e-13));
    }
}

/// The loop of Armstrong and Frederick: X = ± C/γ + (X_0 ∓ C/γ) exp(∓ γ (ε_p − ε_p0)), σ = X ± σ_y. The return is implicit: the error
/// falls with the step, to 6e-3 of C/γ with 100 steps a branch and to a half of that with 200.
#[test]
fn a_loop_follows_the_exponentials() {
    let law = law::<6>(SPACE, 1.0, &[C, RATE], 0.0);
    let limit = C / RATE;
    let error = |steps: usize| {
        let found = path(law.as_ref(), &[0.02, -0.02, 0.02, -0.01], steps);
        let (mut back, mut before, mut worst): (f64, f64, f64) = (0.0, 0.0, 0.0);
        for ([stress, plastic], sign) in found.into_iter().zip([1.0, -1.0, 1.0, -1.0]) {
            back = sign * limit + (back - sign * limit) * (-sign * RATE * (plastic - before)).exp();
            before = plastic;
            worst = worst.max((stress - back - sign * YIELD).abs() / limit);
        }
        worst
    };
    let [coarse, fine] = [error(100), error(200)];
    println!("loop of Armstrong and Frederick: off by {coarse:.2e} and {fine:.2e} of C/γ");
    assert!(coarse < 6e-3 && fine < 0.55 * coarse && fine > 0.0, "{coarse:e} {fine:e}");
    // after long flow the stress stays at σ_y + C/γ
    let [[stress, _]] = path(law.as_ref(), &[0.5], 50)[..] else { unreachable!() };
    assert!(near(stress, YIELD + limit, 1e-9), "{stress}");
}

#[test]
fn parameters_are_checked() {
    let refused = |kind: f64, parameters: &[f64]| {
        law_of::<6>(&properties(SPACE, kind, parameters, 0.0), false).err().unwrap().to_string()
    };
    assert!(refused(2.0, &[C, RATE, 1.0]).contains("KINEMATIC_HARDENING_TYPE 2 of properties 1 is not there"));
    assert!(refused(1.0, &[C]).contains("has 1 numbers for KINEMATIC_HARDENING_TYPE 1"));
    assert!(refused(1.0, &[C, -1.0]).contains("not negative"));
    let mut without = properties(SPACE, 0.0, &[C], 0.0);
    without.values.remove("KINEMATIC_PLASTICITY_PARAMETERS");
    let problem = law_of::<6>(&without, false).err().unwrap().to_string();
    assert!(problem.contains("have no KINEMATIC_PLASTICITY_PARAMETERS"), "{problem}");
}

/// In an elastic state the law answers as one that never yields, from the same history, and keeps that history.
#[test]
fn an_elastic_state_keeps_the_history() {
    let own = law::<6>(SPACE, 1.0, &[C, RATE], 5.0);
    let mut random = Random(7);
    let history = advanced(own.as_ref(), std::array::from_fn(|_| 0.05 * random.next()), &[0.0; 13]);
    let strain: [f64; 6] = std::array::from_fn(|_| 0.05 * random.next());
    let elastic = StrainState { elastic: true, ..state(strain, &history) };
    let mut strong = properties(SPACE, 1.0, &[C, RATE], 5.0);
    strong.values.insert("YIELD_STRESS".to_owned(), PropertyValue::Number(1e6 * YIELD));
    let strong = law_of::<6>(&strong, false).unwrap();
    let [mut tangent, mut expected] = [[[0.0; 6]; 6]; 2];
    let found = own.pk2(&elastic, Some(&mut tangent));
    assert_eq!((found, tangent), (strong.pk2(&state(strain, &history), Some(&mut expected)), expected));
    assert_ne!(found, own.pk2(&state(strain, &history), None), "it would yield");
    let mut next = history.clone();
    own.advance(&elastic, &mut next);
    assert!(size(&next.iter().zip(&history).map(|(a, b)| a - b).collect::<Vec<f64>>()) < 1e-14);
}
