use zelus_core::model::{Properties, PropertyValue};

use super::*;
use crate::tensor::*;
use crate::test_model::{Random, near, size};

const E: f64 = 200.0;
const NU: f64 = 0.3;

fn law<const S: usize>(name: &str) -> Box<dyn ConstitutiveLaw<S>>
where
    LawFactory: MakesLaw<S>,
{
    let mut properties = Properties::new(1);
    properties.law = Some(name.to_owned());
    for (name, value) in [("YOUNG_MODULUS", E), ("POISSON_RATIO", NU)] {
        properties.values.insert(name.to_owned(), PropertyValue::Number(value));
    }
    law_of(&properties, S == 3).unwrap()
}

/// A state with deformation gradient `f`.
fn state<const S: usize>(f: Tensor) -> StrainState<'static, S> {
    let strain = strain_vector(&(0.5 * (f.transpose() * f - IDENTITY)));
    StrainState { strain, f, det_f: f.determinant(), small: false, ..StrainState::REST }
}

/// A random deformation gradient whose out-of-plane part suits `S` strains.
fn gradient<const S: usize>(random: &mut Random, amount: f64) -> Tensor {
    let mut f = IDENTITY;
    for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
        if S == 6 || (i < 2 && j < 2) || (S == 4 && i == j) {
            f[(i, j)] += amount * random.next();
        }
    }
    f
}

fn rotation(angle: f64) -> Tensor {
    let (s, c) = angle.sin_cos();
    Tensor::new(c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0)
}

/// dS/dE by differences of a law whose J follows the strain, against its tangent; and S = dW/dE.
fn check_derivatives<const S: usize>(name: &str)
where
    LawFactory: MakesLaw<S>,
{
    let law = law::<S>(name);
    let mut random = Random(5);
    for _ in 0..5 {
        let base = state::<S>(gradient::<S>(&mut random, 0.2));
        let at = |t: usize, step: f64| {
            let mut strain = base.strain;
            strain[t] += step;
            let c = IDENTITY + 2.0 * strain_tensor(&strain);
            StrainState { strain, f: base.f, det_f: c.determinant().sqrt(), small: false, ..StrainState::REST }
        };
        let mut d = [[0.0; S]; S];
        let stress = law.pk2(&base, Some(&mut d));
        let h = 1e-5;
        for t in 0..S {
            let (plus, minus) = (at(t, h), at(t, -h));
            let (a, b) = (law.pk2(&plus, None), law.pk2(&minus, None));
            for s in 0..S {
                assert!(near(d[s][t], (a[s] - b[s]) / (2.0 * h), 1e-6 * E), "{name} D[{s}][{t}]");
                assert!(near(d[s][t], d[t][s], 1e-12 * E), "{name}: D is symmetric");
            }
            let slope = (law.energy(&plus) - law.energy(&minus)) / (2.0 * h);
            assert!(near(stress[t], slope, 1e-7 * E), "{name} S[{t}] {} {slope}", stress[t]);
        }
    }
}

/// S does not see a rotation R F; Cauchy stress turns with it.
fn check_objectivity<const S: usize>(name: &str)
where
    LawFactory: MakesLaw<S>,
{
    let law = law::<S>(name);
    let mut random = Random(6);
    let f = gradient::<S>(&mut random, 0.2);
    let r = rotation(0.7);
    let (plain, turned) = (state::<S>(f), state::<S>(r * f));
    let (a, b) = (law.pk2(&plain, None), law.pk2(&turned, None));
    assert!((0..S).all(|s| near(a[s], b[s], 1e-12 * E)), "{name}");
    if law.ignores_measure(false) {
        return;
    }
    let sigma = congruent(&r, &stress_tensor(&law.stress(&plain, StressMeasure::Cauchy, None)));
    let turned = law.stress(&turned, StressMeasure::Cauchy, None);
    let expected = stress_vector::<S>(&sigma);
    assert!((0..S).all(|s| near(turned[s], expected[s], 1e-12 * E)), "{name}: Cauchy stress");
}

#[test]
fn tangents_are_derivatives_and_stresses_come_from_the_energy() {
    for kind in ["LinearElastic", "KirchhoffSaintVenant", "HyperElastic"] {
        check_derivatives::<6>(&format!("{kind}3DLaw"));
        check_derivatives::<3>(&format!("{kind}PlaneStrain2DLaw"));
        check_derivatives::<4>(&format!("{kind}Axisym2DLaw"));
    }
    check_derivatives::<3>("LinearElasticPlaneStress2DLaw");
    check_derivatives::<3>("KirchhoffSaintVenantPlaneStress2DLaw");
}

#[test]
fn rotations_do_not_strain() {
    for kind in ["LinearElastic", "KirchhoffSaintVenant", "HyperElastic"] {
        check_objectivity::<6>(&format!("{kind}3DLaw"));
        check_objectivity::<3>(&format!("{kind}PlaneStrain2DLaw"));
        check_objectivity::<4>(&format!("{kind}Axisym2DLaw"));
        let rest = state::<6>(rotation(1.1));
        assert!(size(&law::<6>(&format!("{kind}3DLaw")).stress(&rest, StressMeasure::Cauchy, None)) < 1e-12);
    }
}

#[test]
fn small_strains_agree_with_hooke() {
    let mut random = Random(7);
    let f = gradient::<6>(&mut random, 1e-7);
    let state = state::<6>(0.5 * (f + f.transpose()));
    let linear = law::<6>("LinearElastic3DLaw").pk2(&state, None);
    for name in ["KirchhoffSaintVenant3DLaw", "HyperElastic3DLaw"] {
        let stress = law::<6>(name).stress(&state, StressMeasure::Cauchy, None);
        assert!((0..6).all(|s| near(stress[s], linear[s], 1e-10)), "{name}");
    }
}

#[test]
fn hooke_in_one_direction() {
    // free lateral strain −ν ε gives σ = E ε
    let (f, e) = (IDENTITY, 1e-3);
    let solid =
        StrainState { strain: [e, -NU * e, -NU * e, 0.0, 0.0, 0.0], f, det_f: 1.0, small: false, ..StrainState::REST };
    let stress = law::<6>("LinearElastic3DLaw").pk2(&solid, None);
    assert!(near(stress[0], E * e, 1e-13) && size(&stress[1..]) < 1e-13);
    let plane = StrainState { strain: [e, -NU * e, 0.0], f, det_f: 1.0, small: false, ..StrainState::REST };
    let stress = law::<3>("LinearElasticPlaneStress2DLaw").pk2(&plane, None);
    assert!(near(stress[0], E * e, 1e-13) && stress[1].abs() < 1e-13);
    let shear = StrainState { strain: [0.0, 0.0, e], f, det_f: 1.0, small: false, ..StrainState::REST };
    assert!(near(law::<3>("LinearElasticPlaneStrain2DLaw").pk2(&shear, None)[2], E / (2.0 * (1.0 + NU)) * e, 1e-14));
}

#[test]
fn closed_forms_of_a_stretch() {
    // F = diag(l, 1, 1)
    let l: f64 = 1.3;
    let state = state::<6>(Tensor::from_diagonal(&[l, 1.0, 1.0].into()));
    let (lambda, mu) = (E * NU / ((1.0 + NU) * (1.0 - 2.0 * NU)), 0.5 * E / (1.0 + NU));
    let neo = law::<6>("HyperElastic3DLaw").stress(&state, StressMeasure::Cauchy, None);
    assert!(near(neo[0], (mu * (l * l - 1.0) + lambda * l.ln()) / l, 1e-12));
    assert!(near(neo[1], lambda * l.ln() / l, 1e-12) && near(neo[2], neo[1], 1e-13));
    let svk = law::<6>("KirchhoffSaintVenant3DLaw").stress(&state, StressMeasure::Cauchy, None);
    assert!(near(svk[0], l * (lambda + 2.0 * mu) * 0.5 * (l * l - 1.0), 1e-12));
    let almansi = law::<6>("KirchhoffSaintVenant3DLaw").almansi(&state);
    assert!(near(almansi[0], 0.5 * (1.0 - 1.0 / (l * l)), 1e-14));
}

#[test]
fn wrong_laws_are_refused_with_a_remedy() {
    let mut properties = Properties::new(7);
    assert!(law_of::<6>(&properties, false).err().unwrap().to_string().contains("no constitutive law"));
    properties.law = Some("LinearElastic3DLow".into());
    assert!(law_of::<6>(&properties, false).err().unwrap().to_string().contains("LinearElastic3DLaw"));
    properties.law = Some("LinearElasticPlaneStrain2DLaw".into());
    assert!(law_of::<6>(&properties, false).err().unwrap().to_string().contains("three-dimensional"));
    assert!(law_of::<3>(&properties, true).err().unwrap().to_string().contains("YOUNG_MODULUS"));
    properties.values.insert("YOUNG_MODULUS".into(), PropertyValue::Number(1.0));
    properties.values.insert("POISSON_RATIO".into(), PropertyValue::Number(0.5));
    assert!(law_of::<3>(&properties, true).err().unwrap().to_string().contains("between -1 and 0.5"));
}
