use zelus_core::model::{Properties, PropertyValue};

use super::*;
use crate::test_model::{Random, near, size};

const E: f64 = 200.0;
const NU: f64 = 0.3;
const A: f64 = 2e-3;
const SPACE: &str = "SmallStrainNortonCreep3D";

fn properties(name: &str, [coefficient, exponent, of_time]: [f64; 3]) -> Properties {
    let mut properties = Properties::new(1);
    properties.law = Some(name.to_owned());
    for (name, value) in [
        ("YOUNG_MODULUS", E),
        ("POISSON_RATIO", NU),
        ("NORTON_COEFFICIENT", coefficient),
        ("NORTON_EXPONENT", exponent),
        ("NORTON_TIME_EXPONENT", of_time),
    ] {
        properties.values.insert(name.to_owned(), PropertyValue::Number(value));
    }
    properties
}

fn law<const S: usize>(name: &str, constants: [f64; 3]) -> Box<dyn ConstitutiveLaw<S>>
where
    LawFactory: MakesLaw<S>,
{
    law_of(&properties(name, constants), S == 3).unwrap()
}

fn state<const S: usize>(strain: [f64; S], step: [f64; 2], history: &[f64]) -> StrainState<'_, S> {
    StrainState { strain, step, history, ..StrainState::REST }
}

fn check_tangent<const S: usize>(name: &str, constants: [f64; 3])
where
    LawFactory: MakesLaw<S>,
{
    let law = law::<S>(name, constants);
    let mut random = Random(51);
    for round in 0..12 {
        let mut history = vec![0.0; 9];
        let step = |at: usize| [at as f64, at as f64 + 1.0];
        for at in 0..round % 3 {
            let before = history.clone();
            let strain = std::array::from_fn(|_| 0.05 * random.next());
            law.advance(&state(strain, step(at), &before), &mut history);
        }
        let (step, strain): (_, [f64; S]) = (step(round % 3), std::array::from_fn(|_| 0.05 * random.next()));
        let mut d = [[0.0; S]; S];
        let stress = law.pk2(&state(strain, step, &history), Some(&mut d));
        let h = 1e-6;
        for t in 0..S {
            let at = |by: f64| {
                let mut moved = strain;
                moved[t] += by;
                law.pk2(&state(moved, step, &history), None)
            };
            let (plus, minus) = (at(h), at(-h));
            for s in 0..S {
                let slope = (plus[s] - minus[s]) / (2.0 * h);
                assert!(near(d[s][t], slope, 1e-7 * E), "{name} {round} D[{s}][{t}] {} {slope}", d[s][t]);
                assert!(near(d[s][t], d[t][s], 1e-13 * E), "{name}: D is symmetric");
            }
        }
        // an accepted step does not creep once more
        let mut after = history.clone();
        law.advance(&state(strain, step, &history), &mut after);
        let again = law.pk2(&state(strain, step, &after), None);
        assert!((0..S).all(|s| near(again[s], stress[s], 1e-12 * E)), "{name}: the accepted state keeps its stress");
        assert!(after[6] > history[6], "{name} creeps");
    }
}

#[test]
fn tangents_are_those_of_the_step() {
    for constants in [[A, 1.0, 0.0], [A, 3.0, 0.0], [1e-9, 8.0, 0.0], [A, 3.0, -0.4]] {
        check_tangent::<6>(SPACE, constants);
        check_tangent::<3>("SmallStrainNortonCreepPlaneStrain", constants);
        check_tangent::<4>("SmallStrainNortonCreepAxisym", constants);
    }
}

/// Without time it is Hooke's law; after a long time a state of constant strain has no deviator left.
#[test]
fn creep_lies_between_hooke_and_a_fluid() {
    let strain = [0.01, -0.002, 0.003, 0.004, 0.0, -0.005];
    let creep = law::<6>(SPACE, [A, 3.0, 0.0]);
    let elastic = law_of::<6>(&properties("LinearElastic3DLaw", [A, 3.0, 0.0]), false).unwrap();
    let history = [0.0; 9];
    let (at_once, hooke) =
        (creep.pk2(&state(strain, [2.0, 2.0], &history), None), elastic.pk2(&state(strain, [0.0; 2], &[]), None));
    assert!((0..6).all(|s| near(at_once[s], hooke[s], 1e-13 * E)));
    let kept = StrainState { elastic: true, ..state(strain, [0.0, 1e18], &history) };
    assert_eq!(creep.pk2(&kept, None), at_once, "an elastic state does not creep");
    let at_last = creep.pk2(&state(strain, [0.0, 1e18], &history), None);
    let pressure = E / (1.0 - 2.0 * NU) / 3.0 * 0.011;
    assert!((0..3).all(|s| near(at_last[s], pressure, 1e-5)) && size(&at_last[3..]) < 1e-5, "{at_last:?}");
}

/// The strain of a bar without lateral stress whose axial strain, or axial stress, is that wanted: by bisection.
fn bar(law: &dyn ConstitutiveLaw<6>, axial: f64, step: [f64; 2], history: &[f64]) -> [f64; 6] {
    let at = |lateral: f64| [axial, lateral, lateral, 0.0, 0.0, 0.0];
    let (mut low, mut high) = (-1.0, 1.0);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if law.pk2(&state(at(middle), step, history), None)[1] > 0.0 { high = middle } else { low = middle }
    }
    at(0.5 * (low + high))
}

/// Relaxation of a bar at constant strain: σ = [σ_0^(1−n) + (n − 1) E A t]^(1/(1−n)). Backward Euler's error halves with the step.
#[test]
fn a_bar_relaxes() {
    let (strain, n, end) = (0.01, 4.0, 3.0);
    let law = law::<6>(SPACE, [A, n, 0.0]);
    let exact = ((E * strain).powf(1.0 - n) + (n - 1.0) * E * A * end).powf(1.0 / (1.0 - n));
    let error = |steps: usize| {
        let (mut history, mut stress) = (vec![0.0; 9], 0.0);
        for step in 0..steps {
            let times = [step, step + 1].map(|at| end * at as f64 / steps as f64);
            let whole = bar(law.as_ref(), strain, times, &history);
            stress = law.pk2(&state(whole, times, &history), None)[0];
            let before = history.clone();
            law.advance(&state(whole, times, &before), &mut history);
        }
        (stress / exact - 1.0).abs()
    };
    let [coarse, fine] = [error(100), error(200)];
    println!("relaxation: off by {coarse:.2e} and {fine:.2e}");
    assert!(coarse < 2e-2 && fine < 0.55 * coarse, "{coarse:e} {fine:e}");
}

#[test]
fn constants_are_checked() {
    let refused = |constants| law_of::<6>(&properties(SPACE, constants), false).err().unwrap().to_string();
    assert!(refused([A, 0.5, 0.0]).contains("NORTON_EXPONENT of properties 1 is 0.5"));
    assert!(refused([-A, 3.0, 0.0]).contains("NORTON_COEFFICIENT"));
    assert!(refused([A, 3.0, -1.0]).contains("NORTON_TIME_EXPONENT of properties 1 is -1"));
    let mut without = properties(SPACE, [A, 3.0, 0.0]);
    without.values.remove("NORTON_COEFFICIENT");
    assert!(law_of::<6>(&without, false).err().unwrap().to_string().contains("have no NORTON_COEFFICIENT"));
}

/// Constants over the temperature, with expansion: a bar at constant stress creeps by A(T), and expands freely by α ΔT.
#[test]
fn hot_bars_creep_faster() {
    let mut hot = properties("ThermalSmallStrainNortonCreep3D", [A, 3.0, 0.0]);
    for (name, value) in [("THERMAL_EXPANSION_COEFFICIENT", 1e-5), ("REFERENCE_TEMPERATURE", 20.0)] {
        hot.values.insert(name.to_owned(), PropertyValue::Number(value));
    }
    let table = zelus_core::model::Table::new(vec![[20.0, A], [520.0, 11.0 * A]]);
    hot.tables.insert(("TEMPERATURE".to_owned(), "NORTON_COEFFICIENT".to_owned()), table);
    let law = law_of::<6>(&hot, false).unwrap();
    assert!(law.expands() && law.depends_on_time());
    let stress = 0.5_f64;
    for (temperature, coefficient) in [(20.0, A), (270.0, 6.0 * A)] {
        let (crept, free) = (coefficient * stress.powi(3), 1e-5 * (temperature - 20.0));
        let lateral = -NU * stress / E - 0.5 * crept + free;
        let strain = [stress / E + crept + free, lateral, lateral, 0.0, 0.0, 0.0];
        let history = [0.0; 9];
        let found = law.pk2(&StrainState { temperature, ..state(strain, [4.0, 5.0], &history) }, None);
        assert!(near(found[0], stress, 1e-12) && size(&found[1..]) < 1e-12, "{temperature}: {found:?}");
    }
}
