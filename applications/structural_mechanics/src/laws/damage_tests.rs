use zelus_core::model::{Properties, PropertyValue, Table};

use super::*;
use crate::test_model::{Random, near};

const E: f64 = 200.0;
const STRENGTH: f64 = 0.4;
const ENERGY: f64 = 0.02;
const BAND: f64 = 2.0;

fn properties(name: &str, softening: f64) -> Properties {
    let mut properties = Properties::new(1);
    properties.law = Some(name.to_owned());
    for (name, value) in [
        ("YOUNG_MODULUS", E),
        ("POISSON_RATIO", 0.3),
        ("YIELD_STRESS", STRENGTH),
        ("FRACTURE_ENERGY", ENERGY),
        ("SOFTENING_TYPE", softening),
        ("THERMAL_EXPANSION_COEFFICIENT", 1e-5),
        ("REFERENCE_TEMPERATURE", 20.0),
    ] {
        properties.values.insert(name.to_owned(), PropertyValue::Number(value));
    }
    properties
}

fn state<const S: usize>(strain: [f64; S], temperature: f64, band: f64, history: &[f64]) -> StrainState<'_, S> {
    StrainState { strain, temperature, band, history, ..StrainState::REST }
}

fn check_tangent<const S: usize>(name: &str)
where
    LawFactory: MakesLaw<S>,
{
    let mut random = Random(7);
    let mut grew = 0;
    for round in 0..40 {
        let mut properties = properties(name, f64::from(round % 2));
        let points = vec![[0.0, STRENGTH], [100.0, 0.5 * STRENGTH]];
        if name.contains("Thermal") {
            properties.tables.insert(("TEMPERATURE".to_owned(), "YIELD_STRESS".to_owned()), Table::new(points));
        }
        let law = law_of::<S>(&properties, S != 4 || name.contains("Plane")).unwrap();
        let temperature = 20.0 + f64::from(round);
        let mut history = vec![0.0; 2];
        for _ in 0..round % 3 {
            let strain = std::array::from_fn(|_| 0.004 * random.next());
            let before = history.clone();
            law.advance(&state(strain, temperature, BAND, &before), &mut history);
        }
        let strain: [f64; S] = std::array::from_fn(|_| 0.006 * random.next());
        let mut d = [[0.0; S]; S];
        let stress = law.pk2(&state(strain, temperature, BAND, &history), Some(&mut d));
        let h = 1e-8;
        for t in 0..S {
            let at = |step: f64| {
                let mut moved = strain;
                moved[t] += step;
                law.pk2(&state(moved, temperature, BAND, &history), None)
            };
            let (plus, minus) = (at(h), at(-h));
            for s in 0..S {
                let slope = (plus[s] - minus[s]) / (2.0 * h);
                assert!(near(d[s][t], slope, 1e-5 * E), "{name} {round} D[{s}][{t}] {} {slope}", d[s][t]);
            }
        }
        let mut after = history.clone();
        law.advance(&state(strain, temperature, BAND, &history), &mut after);
        grew += usize::from(after[1] > history[1]);
        assert!(after[1] >= history[1], "damage does not heal");
        let again = law.pk2(&state(strain, temperature, BAND, &after), None);
        assert!((0..S).all(|s| near(again[s], stress[s], 1e-12)), "{name}: the accepted state keeps its stress");
    }
    assert!(grew > 10, "{name}: {grew}");
}

#[test]
fn tangents_are_derivatives() {
    for surface in ["VonMises", "Rankine", "Tresca"] {
        for thermal in ["", "Thermal"] {
            let name = |form: &str| format!("SmallStrain{thermal}IsotropicDamage{form}{surface}");
            check_tangent::<6>(&name("3D"));
            check_tangent::<3>(&name("PlaneStrain"));
            check_tangent::<4>(&name("PlaneStrain"));
            check_tangent::<3>(&name("PlaneStress"));
        }
    }
}

/// A band that is pulled until it has broken takes G by area, whatever its width; half way its path back takes none.
#[test]
fn a_band_takes_its_fracture_energy() {
    for surface in ["VonMises", "Rankine", "Tresca"] {
        for softening in [0.0, 1.0] {
            for band in [0.1, 2.0, 20.0] {
                let law = law_of::<6>(&properties(&format!("SmallStrainIsotropicDamage3D{surface}"), softening), false)
                    .unwrap();
                let (end, steps) = (40.0 * ENERGY / (STRENGTH * band), 40_000);
                let mut history = vec![0.0; 2];
                let (mut work, mut last) = (0.0, 0.0);
                for step in 1..=steps {
                    let axial = end * f64::from(step) / f64::from(steps);
                    let strain = [axial, -0.3 * axial, -0.3 * axial, 0.0, 0.0, 0.0];
                    let before = history.clone();
                    let now = state(strain, 0.0, band, &before);
                    let stress = law.pk2(&now, None)[0];
                    work += 0.5 * (stress + last) * end / f64::from(steps);
                    last = stress;
                    law.advance(&now, &mut history);
                    if step == steps / 20 {
                        let back = state(strain.map(|e| 0.5 * e), 0.0, band, &history);
                        assert!(near(law.pk2(&back, None)[0], 0.5 * stress, 1e-12), "unloading is elastic");
                    }
                }
                let residue = 0.5 * last * end;
                let dissipated = (work - residue) * band;
                let error = (dissipated / ENERGY - 1.0).abs();
                assert!(error < 2e-3, "{surface} {softening} {band}: {error:e}");
            }
        }
    }
}

#[test]
fn wide_bands_would_snap_back() {
    let law = law_of::<6>(&properties("SmallStrainIsotropicDamage3DVonMises", 1.0), false).unwrap();
    assert!(near(law.widest_band(), 2.0 * E * ENERGY / (STRENGTH * STRENGTH), 1e-12));
}

/// Heated between walls, a bar carries E α ΔT until that is its strength, which falls with temperature: it breaks at 60 degrees above.
#[test]
fn heat_breaks_what_is_held() {
    let name = "SmallStrainThermalIsotropicDamagePlaneStressVonMises";
    let mut properties = properties(name, 1.0);
    properties.values.insert("THERMAL_EXPANSION_COEFFICIENT".to_owned(), PropertyValue::Number(2.5e-5));
    let points = vec![[20.0, STRENGTH], [120.0, 0.5 * STRENGTH]];
    properties.tables.insert(("TEMPERATURE".to_owned(), "YIELD_STRESS".to_owned()), Table::new(points));
    let law = law_of::<3>(&properties, true).unwrap();
    let history = [0.0; 2];
    let damaged = |above: f64| {
        let free = 1.3 * 2.5e-5 * above;
        let mut after = [0.0; 2];
        let held = state([0.0, free, 0.0], 20.0 + above, BAND, &history);
        assert!(near(law.pk2(&held, None)[1], 0.0, 1e-12), "free across");
        law.advance(&held, &mut after);
        after[1] > 0.0
    };
    // E α Δ = σ_y (1 − Δ/200)
    let limit = STRENGTH / (E * 2.5e-5 + STRENGTH / 200.0);
    assert!(!damaged(0.999 * limit) && damaged(1.001 * limit), "{limit}");
}
