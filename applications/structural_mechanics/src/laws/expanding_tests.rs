use zelus_core::model::{Properties, PropertyValue};

use super::*;
use crate::tensor::*;
use crate::test_model::{Random, near};

const E: f64 = 200.0;
const NU: f64 = 0.3;
const ALPHA: f64 = 1e-3;
const REFERENCE: f64 = 20.0;

const SPACE: [&str; 5] = [
    "SmallStrainJ2Plasticity3DLaw",
    "SmallStrainIsotropicPlasticity3DVonMisesVonMises",
    "FiniteStrainIsotropicPlasticity3DVonMisesVonMises",
    "KirchhoffSaintVenant3DLaw",
    "HyperElastic3DLaw",
];
const PLANE_STRAIN: [&str; 5] = [
    "SmallStrainJ2PlasticityPlaneStrain2DLaw",
    "SmallStrainIsotropicPlasticityPlaneStrainVonMisesVonMises",
    "FiniteStrainIsotropicPlasticityPlaneStrainVonMisesVonMises",
    "KirchhoffSaintVenantPlaneStrain2DLaw",
    "HyperElasticPlaneStrain2DLaw",
];
const REVOLUTION: [&str; 4] = [
    "SmallStrainJ2PlasticityAxisym2DLaw",
    "FiniteStrainIsotropicPlasticityAxisymVonMisesVonMises",
    "KirchhoffSaintVenantAxisym2DLaw",
    "HyperElasticAxisym2DLaw",
];
const PLANE_STRESS: &str = "KirchhoffSaintVenantPlaneStress2DLaw";

fn law<const S: usize>(name: &str, thermal: bool) -> Box<dyn ConstitutiveLaw<S>>
where
    LawFactory: MakesLaw<S>,
{
    let mut properties = Properties::new(1);
    properties.law = Some(format!("{}{name}", if thermal { "Thermal" } else { "" }));
    for (name, value) in [
        ("YOUNG_MODULUS", E),
        ("POISSON_RATIO", NU),
        ("YIELD_STRESS", 1.0),
        ("ISOTROPIC_HARDENING_MODULUS", 20.0),
        ("THERMAL_EXPANSION_COEFFICIENT", ALPHA),
        ("REFERENCE_TEMPERATURE", REFERENCE),
    ] {
        properties.values.insert(name.to_owned(), PropertyValue::Number(value));
    }
    law_of(&properties, S == 3).unwrap()
}

/// A deformation gradient near 1 with the zeros that so many components have.
fn gradient<const S: usize>(random: &mut Random, by: f64) -> Tensor {
    let pairs = pairs::<S>();
    Tensor::from_fn(|i, j| {
        let is_there = pairs.iter().any(|&(p, q)| (p, q) == (i, j) || (q, p) == (i, j));
        f64::from(u8::from(i == j)) + if is_there { by * random.next() } else { 0.0 }
    })
}

fn state<const S: usize>(f: Tensor, small: bool, temperature: f64, history: &[f64]) -> StrainState<'_, S> {
    let strain = if small { 0.5 * (f + f.transpose()) - IDENTITY } else { 0.5 * (f.transpose() * f - IDENTITY) };
    StrainState {
        strain: strain_vector(&strain),
        f,
        det_f: f.determinant(),
        small,
        temperature,
        history,
        ..StrainState::REST
    }
}

fn largest<const S: usize>(values: [f64; S]) -> f64 {
    values.iter().fold(0.0, |most: f64, value| most.max(value.abs()))
}

/// A body that is free expands without stress and without stored energy, whatever its law.
fn check_free<const S: usize>(name: &str)
where
    LawFactory: MakesLaw<S>,
{
    let law = law::<S>(name, true);
    let history = vec![0.0; law.history()];
    let stretch = 1.0 + ALPHA * 40.0;
    for small in [true, false] {
        let free = state::<S>(stretch * IDENTITY, small, REFERENCE + 40.0, &history);
        assert!(largest(law.pk2(&free, None)) < 1e-12 * E, "{name}: {:?}", law.pk2(&free, None));
        assert!(law.energy(&free).abs() < 1e-12 * E, "{name}");
        let cold = state::<S>(IDENTITY, small, REFERENCE, &history);
        assert_eq!(law.pk2(&cold, None), [0.0; S], "{name}");
    }
}

#[test]
fn what_is_free_expands_without_stress() {
    SPACE.into_iter().for_each(check_free::<6>);
    REVOLUTION.into_iter().for_each(check_free::<4>);
    check_free::<3>(PLANE_STRESS);
}

/// At the reference temperature it is the law itself, also in its history.
fn check_reference<const S: usize>(name: &str)
where
    LawFactory: MakesLaw<S>,
{
    let mut random = Random(3);
    let [own, expanding] = [false, true].map(|thermal| law::<S>(name, thermal));
    for small in [true, false] {
        let history = vec![0.0; own.history()];
        let at = state::<S>(gradient::<S>(&mut random, 0.02), small, REFERENCE, &history);
        let [mut first, mut second] = [(); 2].map(|()| history.clone());
        own.advance(&at, &mut first);
        expanding.advance(&at, &mut second);
        let [one, other] = [own.pk2(&at, None), expanding.pk2(&at, None)];
        assert!((0..S).all(|s| near(one[s], other[s], 1e-12 * E)), "{name}: {one:?} {other:?}");
        assert!(first.iter().zip(&second).all(|(a, b)| near(*a, *b, 1e-12)), "{name}: {first:?} {second:?}");
        assert!(near(own.energy(&at), expanding.energy(&at), 1e-12 * E), "{name}");
    }
}

#[test]
fn without_a_change_of_temperature_nothing_changes() {
    SPACE.into_iter().for_each(check_reference::<6>);
    PLANE_STRAIN.into_iter().for_each(check_reference::<3>);
    REVOLUTION.into_iter().for_each(check_reference::<4>);
    check_reference::<3>(PLANE_STRESS);
}

/// A specimen held on all sides is under a pressure 3 K α ΔT, to first order.
#[test]
fn what_is_held_is_under_pressure() {
    let rise = 0.01;
    let exact = -E / (1.0 - 2.0 * NU) * ALPHA * rise;
    for name in SPACE {
        let law = law::<6>(name, true);
        let history = vec![0.0; law.history()];
        for small in [true, false] {
            let stress = law.pk2(&state(IDENTITY, small, REFERENCE + rise, &history), None);
            assert!(stress[..3].iter().all(|s| near(*s, exact, 1e-4 * exact.abs())), "{name}: {stress:?} {exact}");
        }
    }
}

/// Plane strain is space without strain across the plane, in stress, tangent and memory.
#[test]
fn plane_strain_is_held_across() {
    let mut random = Random(5);
    for (plane_name, name) in PLANE_STRAIN.into_iter().zip(SPACE) {
        let (plane, space) = (law::<3>(plane_name, true), law::<6>(name, true));
        for (small, rise) in [(true, 30.0), (false, -20.0)] {
            let f = gradient::<3>(&mut random, 0.02);
            let history = vec![0.0; space.history()];
            let t = REFERENCE + rise;
            let (flat, solid) = (state::<3>(f, small, t, &history), state::<6>(f, small, t, &history));
            let (mut d3, mut d6) = ([[0.0; 3]; 3], [[0.0; 6]; 6]);
            let (s3, s6) = (plane.pk2(&flat, Some(&mut d3)), space.pk2(&solid, Some(&mut d6)));
            for (i, a) in [0, 1, 3].into_iter().enumerate() {
                assert!(near(s3[i], s6[a], 1e-12 * E), "{name}: {s3:?} {s6:?}");
                for (j, b) in [0, 1, 3].into_iter().enumerate() {
                    assert!(near(d3[i][j], d6[a][b], 1e-11 * E), "{name}: D[{i}][{j}] {} {}", d3[i][j], d6[a][b]);
                }
            }
            let [mut of_plane, mut of_space] = [(); 2].map(|()| history.clone());
            plane.advance(&flat, &mut of_plane);
            space.advance(&solid, &mut of_space);
            assert!(of_plane.iter().zip(&of_space).all(|(a, b)| near(*a, *b, 1e-12)), "{name}");
            let mut strain = Vec::new();
            if plane.internal(&flat, "PLASTIC_STRAIN_VECTOR", &mut strain) {
                assert_eq!(strain.len(), 3, "{name}");
            }
        }
    }
}

/// The tangent is the slope of the stress, and without plastic flow the stress is the slope of the energy.
fn check_tangent<const S: usize>(name: &str)
where
    LawFactory: MakesLaw<S>,
{
    let law = law::<S>(name, true);
    let mut random = Random(11);
    for round in 0..12 {
        let (small, t) = (round % 2 == 0, REFERENCE + 50.0 * random.next());
        let mut history = vec![0.0; law.history()];
        if round > 3 {
            let before = history.clone();
            law.advance(&state::<S>(gradient::<S>(&mut random, 0.03), small, t, &before), &mut history);
        }
        let at = state::<S>(gradient::<S>(&mut random, 0.03), small, t, &history);
        // Laws of small strain take small strain; those of finite strain read that of Green and Lagrange.
        if small && !name.contains("SmallStrain") && !name.contains("Kirchhoff") {
            continue;
        }
        let mut d = [[0.0; S]; S];
        let stress = law.pk2(&at, Some(&mut d));
        let h = 1e-6;
        for column in 0..S {
            let moved = |step: f64| {
                let mut moved = at;
                moved.strain[column] += step;
                if !small {
                    moved.det_f = (IDENTITY + 2.0 * strain_tensor(&moved.strain)).determinant().sqrt();
                }
                moved
            };
            let (plus, minus) = (law.pk2(&moved(h), None), law.pk2(&moved(-h), None));
            for row in 0..S {
                let slope = (plus[row] - minus[row]) / (2.0 * h);
                assert!(near(d[row][column], slope, 1e-5 * E), "{name}: D[{row}][{column}] {} {slope}", d[row][column]);
            }
            if law.history() == 0 {
                let slope = (law.energy(&moved(h)) - law.energy(&moved(-h))) / (2.0 * h);
                assert!(near(stress[column], slope, 1e-6 * E), "{name}: {} {slope}", stress[column]);
            }
        }
    }
}

#[test]
fn tangents_are_slopes() {
    SPACE.into_iter().for_each(check_tangent::<6>);
    PLANE_STRAIN.into_iter().for_each(check_tangent::<3>);
    REVOLUTION.into_iter().for_each(check_tangent::<4>);
    check_tangent::<3>(PLANE_STRESS);
}
