use nalgebra::SMatrix;
use zelus_core::model::{Properties, PropertyValue};

use super::material_axes::{of_element, turned};
use super::*;
use crate::tensor::*;
use crate::test_model::{Random, near, size};

/// A unidirectional carbon fibre composite (GPa).
const FIBRE: &[(&str, f64)] = &[
    ("YOUNG_MODULUS_X", 140.0),
    ("YOUNG_MODULUS_Y", 10.0),
    ("YOUNG_MODULUS_Z", 8.0),
    ("POISSON_RATIO_XY", 0.3),
    ("POISSON_RATIO_YZ", 0.4),
    ("POISSON_RATIO_XZ", 0.25),
    ("SHEAR_MODULUS_XY", 5.0),
    ("SHEAR_MODULUS_YZ", 3.0),
    ("SHEAR_MODULUS_XZ", 4.0),
];
const SPACE: &str = "LinearElasticOrthotropic3DLaw";
const PLANE_STRESS: &str = "LinearElasticOrthotropic2DLaw";
const PLANE_STRAIN: &str = "LinearElasticOrthotropicPlaneStrain2DLaw";
const REVOLUTION: &str = "LinearElasticOrthotropicAxisym2DLaw";

fn properties(name: &str, values: &[(&str, f64)]) -> Properties {
    let mut properties = Properties::new(1);
    properties.law = Some(name.to_owned());
    for (name, value) in values {
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

fn matrix<const S: usize>(law: &dyn ConstitutiveLaw<S>, axes: Option<Tensor>) -> Matrix<S> {
    let mut d = [[0.0; S]; S];
    law.pk2(&StrainState { axes, ..StrainState::REST }, Some(&mut d));
    d
}

/// The compliance of a matrix.
fn compliance<const S: usize>(d: &Matrix<S>) -> SMatrix<f64, S, S> {
    SMatrix::<f64, S, S>::from_fn(|row, column| d[row][column]).try_inverse().unwrap()
}

fn check_isotropic<const S: usize>(orthotropic: &str, about_an_axis: Option<&str>, isotropic: &str)
where
    LawFactory: MakesLaw<S>,
{
    let (young, poisson): (f64, f64) = (200.0, 0.3);
    let shear = 0.5 * young / (1.0 + poisson);
    let constants: Vec<(&str, f64)> = FIBRE
        .iter()
        .map(|(name, _)| {
            (
                *name,
                if name.starts_with('Y') {
                    young
                } else if name.starts_with('P') {
                    poisson
                } else {
                    shear
                },
            )
        })
        .collect();
    let hooke = matrix(law::<S>(isotropic, &[("YOUNG_MODULUS", young), ("POISSON_RATIO", poisson)]).as_ref(), None);
    let angles = if S == 6 { [30.0, 50.0, 20.0] } else { [30.0, 0.0, 20.0] };
    for name in std::iter::once(orthotropic).chain(about_an_axis) {
        let law = law::<S>(name, &constants);
        for axes in [None, Some(turned(angles))] {
            let d = matrix(law.as_ref(), axes);
            let same = d.iter().flatten().zip(hooke.iter().flatten()).all(|(a, b)| near(*a, *b, 1e-12 * young));
            assert!(same, "{name}: {d:?} {hooke:?}");
        }
    }
}

#[test]
fn isotropic_constants_give_the_law_of_hooke_in_any_axes() {
    check_isotropic::<6>(SPACE, Some("LinearElasticTransverselyIsotropic3DLaw"), "LinearElastic3DLaw");
    check_isotropic::<3>(
        PLANE_STRAIN,
        Some("LinearElasticTransverselyIsotropicPlaneStrain2DLaw"),
        "LinearElasticPlaneStrain2DLaw",
    );
    check_isotropic::<3>(PLANE_STRESS, None, "LinearElasticPlaneStress2DLaw");
    check_isotropic::<4>(REVOLUTION, Some("LinearElasticTransverselyIsotropicAxisym2DLaw"), "LinearElasticAxisym2DLaw");
}

/// The compliance holds the engineering constants: ν_ij is the contraction along j under stress along i.
#[test]
fn constants_are_those_of_tests_along_the_axes() {
    let s = compliance(&matrix(law::<6>(SPACE, FIBRE).as_ref(), None));
    let value = |name: &str| FIBRE.iter().find(|(own, _)| *own == name).unwrap().1;
    for (i, axis) in ["X", "Y", "Z"].into_iter().enumerate() {
        assert!(near(s[(i, i)] * value(&format!("YOUNG_MODULUS_{axis}")), 1.0, 1e-12));
    }
    for (i, j, axes, shear) in [(0, 1, "XY", 3), (1, 2, "YZ", 4), (0, 2, "XZ", 5)] {
        let ratio = -s[(j, i)] / s[(i, i)];
        assert!(near(ratio, value(&format!("POISSON_RATIO_{axes}")), 1e-12), "{axes}: {ratio}");
        assert!(near(s[(shear, shear)] * value(&format!("SHEAR_MODULUS_{axes}")), 1.0, 1e-12), "{axes}");
    }
}

/// Off-axis tension: 1/E(θ) = c⁴/E_x + (1/G − 2ν/E_x) s²c² + s⁴/E_y, and the shear strain γ = σ η/E by coupling (Jones, Mechanics of
/// Composite Materials, eqs. 2.97 and 2.104).
#[test]
fn stress_at_an_angle_to_the_axes() {
    let law = law::<3>(PLANE_STRESS, FIBRE);
    let (ex, ey, nu, g) = (140.0, 10.0, 0.3, 5.0);
    for degrees in [0.0_f64, 15.0, 45.0, 70.0, 90.0] {
        let (s, c) = degrees.to_radians().sin_cos();
        let axes = of_element([c, s, 0.0], [0.0; 3], true).unwrap();
        let found = compliance(&matrix(law.as_ref(), axes));
        let along = c.powi(4) / ex + (1.0 / g - 2.0 * nu / ex) * (s * c).powi(2) + s.powi(4) / ey;
        let both = 2.0 * nu / ex - 1.0 / g;
        let coupling = (2.0 / ex + both) * s * c.powi(3) - (2.0 / ey + both) * s.powi(3) * c;
        assert!(near(found[(0, 0)], along, 1e-13), "{degrees}: {} {along}", found[(0, 0)]);
        assert!(near(found[(2, 0)], coupling, 1e-13), "{degrees}: {} {coupling}", found[(2, 0)]);
    }
}

fn check_energy<const S: usize>(name: &str)
where
    LawFactory: MakesLaw<S>,
{
    let mut random = Random(7);
    let law = law::<S>(name, FIBRE);
    let axes = Some(turned(if S == 6 { [30.0, 50.0, 20.0] } else { [35.0, 0.0, 0.0] }));
    let strain: [f64; S] = std::array::from_fn(|_| 0.01 * random.next());
    let mut d = [[0.0; S]; S];
    let at = |strain| StrainState { strain, axes, small: false, ..StrainState::REST };
    let stress = law.pk2(&at(strain), Some(&mut d));
    let h = 1e-4;
    for t in 0..S {
        let moved = |step: f64| {
            let mut moved = strain;
            moved[t] += step;
            at(moved)
        };
        let (plus, minus) = (moved(h), moved(-h));
        let slope = (law.energy(&plus) - law.energy(&minus)) / (2.0 * h);
        assert!(near(stress[t], slope, 1e-11), "{name}: {} {slope}", stress[t]);
        let (plus, minus) = (law.pk2(&plus, None), law.pk2(&minus, None));
        for s in 0..S {
            assert!(near(d[s][t], (plus[s] - minus[s]) / (2.0 * h), 1e-10), "{name} D[{s}][{t}]");
            assert!(near(d[s][t], d[t][s], 1e-13), "{name}: D is symmetric");
        }
    }
}

#[test]
fn stress_and_tangent_are_slopes_of_the_energy() {
    check_energy::<6>(SPACE);
    check_energy::<3>(PLANE_STRESS);
    check_energy::<3>(PLANE_STRAIN);
    check_energy::<4>(REVOLUTION);
}

/// Planar laws are parts of the law in space, with axes that turn in the plane.
#[test]
fn sections_are_the_solid_without_strain_or_stress_across() {
    let axes = Some(turned([25.0, 0.0, 0.0]));
    let solid = matrix(law::<6>(SPACE, FIBRE).as_ref(), axes);
    let plane = matrix(law::<3>(PLANE_STRAIN, FIBRE).as_ref(), axes);
    let ring = matrix(law::<4>(REVOLUTION, FIBRE).as_ref(), axes);
    for (i, a) in [0, 1, 3].into_iter().enumerate() {
        for (j, b) in [0, 1, 3].into_iter().enumerate() {
            assert!(near(plane[i][j], solid[a][b], 1e-12));
        }
    }
    for i in 0..4 {
        for j in 0..4 {
            assert!(near(ring[i][j], solid[i][j], 1e-12));
        }
    }
    let (free, solid) = (compliance(&matrix(law::<3>(PLANE_STRESS, FIBRE).as_ref(), axes)), compliance(&solid));
    for (i, a) in [0, 1, 3].into_iter().enumerate() {
        for (j, b) in [0, 1, 3].into_iter().enumerate() {
            assert!(near(free[(i, j)], solid[(a, b)], 1e-13));
        }
    }
}

/// The axes of the angles φ, θ, ψ in closed form, as Kratos writes them; EULER_ANGLES turn a material as axes of its elements do.
#[test]
fn euler_angles_turn_the_axes() {
    let [phi, theta, psi] = [33.0_f64, 71.0, -18.0];
    let ((s1, c1), (s2, c2), (s3, c3)) =
        (phi.to_radians().sin_cos(), theta.to_radians().sin_cos(), psi.to_radians().sin_cos());
    let expected = Tensor::new(
        c1 * c3 - s1 * c2 * s3,
        s1 * c3 + c1 * c2 * s3,
        s2 * s3, //
        -c1 * s3 - s1 * c2 * c3,
        -s1 * s3 + c1 * c2 * c3,
        s2 * c3, //
        s1 * s2,
        -c1 * s2,
        c2,
    );
    assert!(size((turned([phi, theta, psi]) - expected).as_slice()) < 1e-15);
    let mut with_angles = properties(SPACE, FIBRE);
    with_angles.values.insert("EULER_ANGLES".to_owned(), PropertyValue::Vector(vec![phi, theta, psi]));
    let by_angles = matrix(law_of::<6>(&with_angles, false).unwrap().as_ref(), None);
    let by_axes = matrix(law::<6>(SPACE, FIBRE).as_ref(), Some(expected));
    assert!(by_angles.iter().flatten().zip(by_axes.iter().flatten()).all(|(a, b)| near(*a, *b, 1e-12)));
    // in elements with axes the angles count from these
    let element = turned([10.0, 20.0, 30.0]);
    let both = matrix(law_of::<6>(&with_angles, false).unwrap().as_ref(), Some(element));
    let product = matrix(law::<6>(SPACE, FIBRE).as_ref(), Some(expected * element));
    assert!(both.iter().flatten().zip(product.iter().flatten()).all(|(a, b)| near(*a, *b, 1e-12)));
}

/// Layers at 0°, 60° and 120° are isotropic in the plane: A_11 = A_22, A_66 = (A_11 − A_12)/2, whatever the axes of the element.
#[test]
fn layers_in_three_directions_are_isotropic_together() {
    let mut mixture = properties("ParallelRuleOfMixturesLaw2D", &[]);
    mixture.law_lists.insert("combination_factors".to_owned(), vec![1.0; 3]);
    mixture.parts = vec![properties(PLANE_STRESS, FIBRE); 3];
    let angles = vec![0.0, 0.0, 0.0, 60.0, 0.0, 0.0, 120.0, 0.0, 0.0];
    mixture.values.insert("LAYER_EULER_ANGLES".to_owned(), PropertyValue::Vector(angles));
    let laminate = law_of::<3>(&mixture, true).unwrap();
    for axes in [None, Some(turned([17.0, 0.0, 0.0]))] {
        let a = matrix(laminate.as_ref(), axes);
        assert!(near(a[0][0], a[1][1], 1e-12) && near(a[2][2], 0.5 * (a[0][0] - a[0][1]), 1e-12), "{a:?}");
        assert!(near(a[0][2], 0.0, 1e-12) && near(a[1][2], 0.0, 1e-12), "{a:?}");
    }
    let short = PropertyValue::Vector(vec![0.0; 6]);
    mixture.values.insert("LAYER_EULER_ANGLES".to_owned(), short);
    let problem = law_of::<3>(&mixture, true).err().unwrap().to_string();
    assert!(problem.contains("LAYER_EULER_ANGLES") && problem.contains("write 9"), "{problem}");
}

#[test]
fn constants_without_a_positive_energy_are_refused() {
    let with = |name: &str, value: f64| {
        let change = |&(own, usual): &(&'static str, f64)| (own, if own == name { value } else { usual });
        FIBRE.iter().map(change).collect::<Vec<_>>()
    };
    let refused = |law: &str, (name, value): (&str, f64)| {
        law_of::<6>(&properties(law, &with(name, value)), false).err().unwrap().to_string()
    };
    assert!(refused(SPACE, ("YOUNG_MODULUS_Z", -1.0)).contains("YOUNG_MODULUS_Z of properties 1 is -1"));
    assert!(refused(SPACE, ("SHEAR_MODULUS_YZ", 0.0)).contains("SHEAR_MODULUS_YZ"));
    // √(140/10) = 3.741657
    assert!(refused(SPACE, ("POISSON_RATIO_XY", 3.75)).contains("within ±3.741657"));
    law::<6>(SPACE, &with("POISSON_RATIO_XY", 1.5));
    // each pair alone has a positive energy, all three have not
    assert!(refused(SPACE, ("POISSON_RATIO_YZ", 1.11)).contains("negative energy together"));
    let problem = law_of::<6>(&properties(SPACE, &FIBRE[1..]), false).err().unwrap().to_string();
    assert!(problem.contains("have no YOUNG_MODULUS_X"), "{problem}");
    let mut turned_out = properties(PLANE_STRAIN, FIBRE);
    turned_out.values.insert("EULER_ANGLES".to_owned(), PropertyValue::Vector(vec![0.0, 30.0, 0.0]));
    assert!(law_of::<3>(&turned_out, true).err().unwrap().to_string().contains("out of the plane by 30°"));
}

#[test]
fn axes_of_elements_are_perpendicular_and_complete() {
    assert_eq!(of_element([0.0; 3], [0.0; 3], false), Ok(None));
    assert!(of_element([1.0, 0.0, 0.0], [0.1, 1.0, 0.0], false).unwrap_err().contains("not perpendicular"));
    assert!(of_element([1.0, 0.0, 0.0], [0.0; 3], false).unwrap_err().contains("no LOCAL_AXIS_2"));
    assert!(of_element([1.0, 0.0, 0.1], [0.0; 3], true).unwrap_err().contains("not in the plane"));
    let axes = of_element([0.0, 0.0, 2.0], [3.0, 0.0, 0.0], false).unwrap().unwrap();
    assert_eq!(axes, Tensor::new(0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0));
    let quarter = of_element([0.0, 1.0, 0.0], [0.0; 3], true).unwrap().unwrap();
    assert_eq!(quarter, Tensor::new(0.0, 1.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 1.0));
}

/// Contact estimates its penalty by one modulus of a body.
#[test]
fn one_modulus_stands_for_a_material() {
    let of = |values: &[(&str, f64)]| representative_young(&properties(SPACE, values));
    assert_eq!(of(&[("YOUNG_MODULUS", 3.0), ("YOUNG_MODULUS_X", 9.0)]), Some(3.0));
    assert_eq!(of(&[("YOUNG_MODULUS_X", 9.0), ("YOUNG_MODULUS_Y", 1.0)]), Some(5.0));
    assert_eq!(of(FIBRE), Some(158.0 / 3.0));
    assert_eq!(of(&[]), None);
}
