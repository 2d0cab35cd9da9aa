use zelus_core::model::{Properties, PropertyValue};

use super::mullins::error_function;
use super::*;
use crate::tensor::*;
use crate::test_model::{Random, near};

const BULK: f64 = 50.0;

/// A material: name, numbers, lists; and W₁, W₂ at I₁, I₂ of the energies by invariants, written out again.
struct Case {
    name: &'static str,
    numbers: &'static [(&'static str, f64)],
    lists: &'static [(&'static str, &'static [f64])],
    slopes: Option<fn(f64, f64) -> [f64; 2]>,
}

const OGDEN: &[[f64; 2]] = &[[1.491, 1.3], [0.003, 5.0], [-0.024, -2.0]];

const CASES: [Case; 7] = [
    Case {
        name: "HyperElasticMooneyRivlin",
        numbers: &[("C10", 1.2), ("C01", 0.3)],
        lists: &[],
        slopes: Some(|_, _| [1.2, 0.3]),
    },
    Case {
        name: "HyperElasticMooneyRivlin",
        numbers: &[("C10", 1.2), ("C01", 0.3), ("C20", 0.1), ("C11", 0.05), ("C02", 0.02)],
        lists: &[],
        slopes: Some(|a, b| {
            let (a, b) = (a - 3.0, b - 3.0);
            [1.2 + 0.2 * a + 0.05 * b, 0.3 + 0.05 * a + 0.04 * b]
        }),
    },
    Case {
        name: "HyperElasticYeoh",
        numbers: &[("C10", 1.2), ("C20", -0.1), ("C30", 0.02)],
        lists: &[],
        slopes: Some(|a, _| [1.2 - 0.2 * (a - 3.0) + 0.06 * (a - 3.0).powi(2), 0.0]),
    },
    Case {
        name: "HyperElasticGent",
        numbers: &[("SHEAR_MODULUS", 2.0), ("GENT_LIMIT", 20.0)],
        lists: &[],
        slopes: Some(|a, _| [20.0 / (20.0 - (a - 3.0)), 0.0]),
    },
    Case {
        name: "HyperElasticArrudaBoyce",
        numbers: &[("SHEAR_MODULUS", 2.0), ("LOCKING_STRETCH", 2.5)],
        lists: &[],
        slopes: Some(|a, _| {
            let n = 6.25;
            let series =
                0.5 + a / (10.0 * n) + 11.0 * a * a / (350.0 * n * n) + 19.0 * a.powi(3) / (1750.0 * n.powi(3));
            [2.0 * (series + 519.0 * a.powi(4) / (134_750.0 * n.powi(4))), 0.0]
        }),
    },
    Case {
        name: "HyperElasticOgden",
        numbers: &[],
        lists: &[("OGDEN_MODULI", &[1.491, 0.003, -0.024]), ("OGDEN_EXPONENTS", &[1.3, 5.0, -2.0])],
        slopes: None,
    },
    Case {
        name: "HyperElasticBlatzKo",
        numbers: &[("SHEAR_MODULUS", 2.0), ("POISSON_RATIO", 0.3), ("BLATZ_KO_SHARE", 0.4)],
        lists: &[],
        slopes: None,
    },
];

fn properties(law: &str, numbers: &[(&str, f64)], lists: &[(&str, &[f64])]) -> Properties {
    let mut properties = Properties::new(1);
    properties.law = Some(law.to_owned());
    for (name, value) in numbers.iter().chain(&[("BULK_MODULUS", BULK)]) {
        properties.values.insert((*name).to_owned(), PropertyValue::Number(*value));
    }
    for (name, values) in lists {
        properties.values.insert((*name).to_owned(), PropertyValue::Vector(values.to_vec()));
    }
    properties
}

fn ending<const S: usize>() -> &'static str {
    ["PlaneStrain2DLaw", "Axisym2DLaw", "", "3DLaw"][S - 3]
}

fn law<const S: usize>(case: &Case, more: &[(&str, f64)], lists: &[(&str, &[f64])]) -> Box<dyn ConstitutiveLaw<S>>
where
    LawFactory: MakesLaw<S>,
{
    let name = format!("{}{}", case.name, ending::<S>());
    law_of(&properties(&name, &[case.numbers, more].concat(), &[case.lists, lists].concat()), S == 3).unwrap()
}

fn state<const S: usize>(f: Tensor, history: &[f64]) -> StrainState<'_, S> {
    let strain = strain_vector(&(0.5 * (f.transpose() * f - IDENTITY)));
    StrainState { strain, f, det_f: f.determinant(), small: false, step: [1.0, 1.5], history, ..StrainState::REST }
}

fn gradient<const S: usize>(random: &mut Random, amount: f64) -> Tensor {
    Tensor::from_fn(|i, j| {
        let is_free = S == 6 || (i < 2 && j < 2) || (S == 4 && i == j);
        IDENTITY[(i, j)] + if is_free { amount * random.next() } else { 0.0 }
    })
}

fn cauchy(law: &dyn ConstitutiveLaw<6>, f: Tensor) -> Tensor {
    stress_tensor(&law.stress(&state(f, &vec![0.0; law.history()]), StressMeasure::Cauchy, None))
}

fn diagonal(a: f64, b: f64, c: f64) -> Tensor {
    Tensor::from_diagonal(&[a, b, c].into())
}

/// ANALYTIC: σ_a − σ_b = 2 (λ_a² − λ_b²)(W₁ + λ_c² W₂), of Ogden Σ μ (λ_a^α − λ_b^α), where J = 1; 1e-10 of round-off.
#[test]
fn stretches_give_the_stresses_of_closed_forms() {
    for case in &CASES[..6] {
        let law = law::<6>(case, &[], &[]);
        for l in [0.5_f64, 0.8, 1.3, 2.0, 2.6] {
            for (kind, f) in [
                ("uniaxial", [l, 1.0 / l.sqrt(), 1.0 / l.sqrt()]),
                ("equibiaxial", [l.sqrt(), l.sqrt(), 1.0 / l]),
                ("planar", [l, 1.0, 1.0 / l]),
            ] {
                let sigma = cauchy(law.as_ref(), diagonal(f[0], f[1], f[2]));
                assert!(sigma.trace().abs() < 1e-10, "{}: the isochoric part has no pressure", case.name);
                let squares = f.map(|l| l * l);
                let (one, two) = (squares.iter().sum::<f64>(), squares.iter().map(|l| 1.0 / l).sum::<f64>());
                for (a, b, c) in [(0, 2, 1), (1, 2, 0)] {
                    let expected = match case.slopes {
                        Some(slopes) => {
                            let [first, second] = slopes(one, two);
                            2.0 * (squares[a] - squares[b]) * (first + squares[c] * second)
                        }
                        None => OGDEN.iter().map(|[mu, alpha]| mu * (f[a].powf(*alpha) - f[b].powf(*alpha))).sum(),
                    };
                    let found = sigma[(a, a)] - sigma[(b, b)];
                    assert!(
                        near(found, expected, 1e-10 * (1.0 + expected.abs())),
                        "{} {kind} {l}: {found} {expected}",
                        case.name
                    );
                }
            }
        }
    }
}

/// ANALYTIC: F = 1 + γ e₁ ⊗ e₂ has σ₁₂ = 2 γ (W₁ + W₂), of Ogden Σ μ (λ^α − λ^−α)/√(4 + γ²), and σ₁₁ − σ₂₂ = γ σ₁₂; 1e-10.
#[test]
fn simple_shear_gives_the_stresses_of_closed_forms() {
    for case in &CASES[..6] {
        let law = law::<6>(case, &[], &[]);
        for gamma in [0.01_f64, 0.4, 1.5] {
            let mut f = IDENTITY;
            f[(0, 1)] = gamma;
            let sigma = cauchy(law.as_ref(), f);
            let root = (4.0 + gamma * gamma).sqrt();
            let l = 0.5 * (root + gamma);
            let expected: f64 = match case.slopes {
                Some(slopes) => 2.0 * gamma * slopes(3.0 + gamma * gamma, 3.0 + gamma * gamma).iter().sum::<f64>(),
                None => OGDEN.iter().map(|[mu, alpha]| mu * (l.powf(*alpha) - l.powf(-alpha)) / root).sum(),
            };
            assert!(near(sigma[(0, 1)], expected, 1e-10), "{} {gamma}: {} {expected}", case.name, sigma[(0, 1)]);
            assert!(near(sigma[(0, 0)] - sigma[(1, 1)], gamma * expected, 1e-10), "{} {gamma}", case.name);
        }
    }
}

/// ANALYTIC: of Blatz's and Ko's foam (f = 0, ν = ¼) σ_a = μ (1 − 1/(J λ_a²)); of the others κ (J − 1) is the pressure: 1e-12.
#[test]
fn volumes_give_the_stresses_of_closed_forms() {
    let foam = Case {
        name: "HyperElasticBlatzKo",
        numbers: &[("SHEAR_MODULUS", 2.0), ("POISSON_RATIO", 0.25)],
        lists: &[],
        slopes: None,
    };
    let (f, j) = ([1.4_f64, 0.9, 0.7], 1.4 * 0.9 * 0.7);
    let sigma = cauchy(law::<6>(&foam, &[], &[]).as_ref(), diagonal(f[0], f[1], f[2]));
    for a in 0..3 {
        assert!(near(sigma[(a, a)], 2.0 * (1.0 - 1.0 / (j * f[a] * f[a])), 1e-12));
    }
    for case in &CASES[..6] {
        let sigma = cauchy(law::<6>(case, &[], &[]).as_ref(), diagonal(f[0], f[1], f[2]));
        assert!(near(sigma.trace() / 3.0, BULK * (j - 1.0), 1e-12), "{}", case.name);
    }
}

/// dS/dE by differences against the tangent, and the energy's slope against S: 1e-6 and 1e-7 of differences with the step 1e-5.
fn check<const S: usize>(
    name: &str,
    law: &dyn ConstitutiveLaw<S>,
    f: Tensor,
    history: &[f64],
    pressure: f64,
    has_energy: bool,
) {
    let base = StrainState { pressure, ..state::<S>(f, history) };
    let at = |t: usize, step: f64| {
        let mut strain = base.strain;
        strain[t] += step;
        StrainState { strain, ..base }
    };
    let mut d = [[0.0; S]; S];
    let stress = law.pk2(&base, Some(&mut d));
    assert_eq!(stress, law.pk2(&base, None), "{name}");
    let scale = d.as_flattened().iter().fold(1.0, |largest: f64, entry| largest.max(entry.abs()));
    let h = 1e-5;
    for t in 0..S {
        let (plus, minus) = (at(t, h), at(t, -h));
        let (a, b) = (law.pk2(&plus, None), law.pk2(&minus, None));
        for s in 0..S {
            let slope = (a[s] - b[s]) / (2.0 * h);
            assert!(near(d[s][t], slope, 1e-7 * scale), "{name} D[{s}][{t}] {} {slope}", d[s][t]);
            assert!(near(d[s][t], d[t][s], 1e-13 * scale), "{name}: D is symmetric");
        }
        if has_energy {
            let slope = (law.energy(&plus) - law.energy(&minus)) / (2.0 * h);
            assert!(near(stress[t], slope, 1e-7 * scale), "{name} S[{t}] {} {slope}", stress[t]);
        }
    }
}

fn check_derivatives<const S: usize>(case: &Case)
where
    LawFactory: MakesLaw<S>,
{
    let mut random = Random(5);
    for round in 0..4 {
        let f = gradient::<S>(&mut random, 0.25);
        check::<S>(case.name, law::<S>(case, &[], &[]).as_ref(), f, &[], 0.0, true);
        let mut held = law::<S>(case, &[], &[]);
        if held.leave_volume() {
            check::<S>("held", held.as_ref(), f, &[], 3.0, false);
        }
        if case.name.contains("BlatzKo") || round > 1 {
            continue;
        }
        let softening = [("MULLINS_R", 1.6), ("MULLINS_M", 0.3), ("MULLINS_BETA", 0.2)];
        check::<S>("softening", law::<S>(case, &softening, &[]).as_ref(), f, &[0.9], 0.0, true);
        let series: [(&str, &[f64]); 2] = [("PRONY_SHARES", &[0.3, 0.2]), ("PRONY_TIMES", &[0.4, 3.0])];
        for (numbers, begin) in [(&softening[..0], 1), (&softening[..], 0)] {
            let law = law::<S>(case, numbers, &series);
            let mut history: Vec<f64> = (0..21).map(|_| 0.5 * random.next()).collect();
            (history[0], history[1], history[2]) = (0.9, 1.0, 1.2);
            check::<S>("relaxation", law.as_ref(), f, &history[begin..begin + law.history()], 0.0, false);
        }
    }
}

#[test]
fn tangents_are_derivatives_and_stresses_come_from_the_energy() {
    for case in &CASES {
        check_derivatives::<6>(case);
        check_derivatives::<4>(case);
        check_derivatives::<3>(case);
    }
}

#[test]
fn rotations_turn_the_stress() {
    let (s, c) = 0.7_f64.sin_cos();
    let turn = Tensor::new(c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0);
    for case in &CASES {
        let law = law::<6>(case, &[], &[]);
        let f = gradient::<6>(&mut Random(6), 0.3);
        let error = (congruent(&turn, &cauchy(law.as_ref(), f)) - cauchy(law.as_ref(), turn * f)).norm();
        assert!(error < 1e-12 * BULK, "{}: {error:e}", case.name);
        assert!(cauchy(law.as_ref(), turn).norm() < 1e-13 * BULK, "{}", case.name);
    }
}

/// Exponents 2 and −2 are Mooney's and Rivlin's energy: stress and tangent agree to round-off, whether principal stretches are apart,
/// close or equal, and differences agree with the tangent there.
#[test]
fn equal_stretches_are_no_singularity() {
    let ogden = Case {
        name: "HyperElasticOgden",
        numbers: &[],
        lists: &[("OGDEN_MODULI", &[2.4, -0.6]), ("OGDEN_EXPONENTS", &[2.0, -2.0])],
        slopes: None,
    };
    let turned = gradient::<6>(&mut Random(8), 0.6);
    let turned = turned.qr().q();
    let (spectral, plain) = (law::<6>(&ogden, &[], &[]), law::<6>(&CASES[0], &[], &[]));
    for base in [[1.3, 1.3, 0.7], [1.0, 1.0, 1.0], [1.1, 1.1, 1.1], [0.6, 0.6, 1.9]] {
        for apart in [0.0, 1e-16, 1e-13, 1e-10, 1e-8, 1e-6, 1e-4, 1e-2, 0.1] {
            let f = diagonal(base[0], base[1] * (1.0 + apart), base[2] * (1.0 - 0.3 * apart)) * turned;
            let (mut first, mut second) = ([[0.0; 6]; 6], [[0.0; 6]; 6]);
            let a = spectral.pk2(&state(f, &[]), Some(&mut first));
            let b = plain.pk2(&state(f, &[]), Some(&mut second));
            let of_stress = (0..6).fold(0.0_f64, |most, s| most.max((a[s] - b[s]).abs()));
            let entries = first.as_flattened().iter().zip(second.as_flattened());
            let of_tangent = entries.fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
            assert!(
                of_stress < 1e-12 * BULK && of_tangent < 2e-12 * BULK,
                "{base:?} {apart}: {of_stress:e} {of_tangent:e}"
            );
            check::<6>("equal stretches", spectral.as_ref(), f, &[], 0.0, true);
            check::<6>("equal stretches", law::<6>(&CASES[5], &[], &[]).as_ref(), f, &[], 0.0, true);
        }
    }
}

/// ANALYTIC: strain that grows in the step Δt and stays gives S(t) = (1 − Σ g_i + Σ g_i ξ(Δt/τ_i) exp(−(t − Δt)/τ_i)) S_e, ξ(x) =
/// (1 − exp(−x))/x, of the isochoric part: 1e-13 in steps of any number.
#[test]
fn stress_relaxes_by_the_series() {
    let series: [(&str, &[f64]); 2] = [("PRONY_SHARES", &[0.3, 0.2]), ("PRONY_TIMES", &[0.4, 3.0])];
    let f = diagonal(1.5, 1.5_f64.sqrt().recip(), 1.5_f64.sqrt().recip());
    let (begin, end) = (0.1, 2.6);
    for case in &CASES[..6] {
        let elastic = cauchy(law::<6>(case, &[], &[]).as_ref(), f);
        let law = law::<6>(case, &[], &series);
        for steps in [1, 7] {
            let mut history = vec![0.0; law.history()];
            let mut times = vec![0.0, begin];
            times.extend((1..=steps).map(|k| begin + (end - begin) * f64::from(k) / f64::from(steps)));
            for pair in times.windows(2) {
                let before = history.clone();
                let now = StrainState { step: [pair[0], pair[1]], ..state(f, &before) };
                let stress = law.stress(&now, StressMeasure::Cauchy, None);
                law.advance(&now, &mut history);
                let after = StrainState { history: &history, ..now };
                let again = law.stress(&after, StressMeasure::Cauchy, None);
                assert!((0..6).all(|s| near(stress[s], again[s], 1e-13)), "an accepted step counts once");
                let held = |share: f64, time: f64| {
                    let x = begin / time;
                    share * ((1.0 - (-x).exp()) / x * (-(pair[1] - begin) / time).exp() - 1.0)
                };
                let factor = 1.0 + held(0.3, 0.4) + held(0.2, 3.0);
                assert!(
                    (0..3).all(|s| near(stress[s], factor * elastic[(s, s)], 1e-13)),
                    "{} at {}",
                    case.name,
                    pair[1]
                );
            }
        }
    }
}

/// ANALYTIC: below its largest energy W_m the material carries η times the elastic stress, η = 1 − erf((W_m − W)/(m + β W_m))/r.
#[test]
fn unloaded_rubber_is_softer() {
    for (x, expected) in
        [(0.1, 0.1124629160182849), (0.5, 0.5204998778130465), (1.0, 0.8427007929497149), (3.0, 0.9999779095030014)]
    {
        assert!(near(error_function(x), expected, 1e-15), "erf {x}");
    }
    let at = |l: f64| diagonal(l, l.sqrt().recip(), l.sqrt().recip());
    for case in &CASES[..6] {
        let elastic = law::<6>(case, &[], &[]);
        let law = law::<6>(case, &[("MULLINS_R", 1.6), ("MULLINS_M", 0.3), ("MULLINS_BETA", 0.2)], &[]);
        let mut history = vec![0.0];
        let loaded = state(at(2.0), &[0.0]);
        law.advance(&loaded, &mut history);
        let (largest, now) = (elastic.energy(&loaded), elastic.energy(&state(at(1.5), &[])));
        let factor = 1.0 - error_function((largest - now) / (0.3 + 0.2 * largest)) / 1.6;
        let (soft, stiff) = (law.pk2(&state(at(1.5), &history), None), elastic.pk2(&state(at(1.5), &[]), None));
        assert!(factor < 0.9 && (0..3).all(|s| near(soft[s], factor * stiff[s], 1e-13)), "{}", case.name);
        assert_eq!(law.pk2(&loaded, None), elastic.pk2(&loaded, None), "the primary path");
        let mut damage = Vec::new();
        assert!(law.internal(&state(at(1.5), &history), "DAMAGE", &mut damage) && near(damage[0], 1.0 - factor, 1e-15));
    }
}

/// ANALYTIC: F = θ F_m has the Cauchy stress of F_m, θ = 1 + α (T − T₀): 1e-12.
#[test]
fn rubber_expands() {
    let more = [("THERMAL_EXPANSION_COEFFICIENT", 1e-3), ("REFERENCE_TEMPERATURE", 300.0)];
    let f = gradient::<6>(&mut Random(9), 0.3);
    for case in &CASES {
        let name = format!("Thermal{}3DLaw", case.name);
        let warm = law_of::<6>(&properties(&name, &[case.numbers, &more].concat(), case.lists), false).unwrap();
        let of = |f: Tensor| {
            let state = StrainState { temperature: 350.0, ..state(f, &[]) };
            stress_tensor(&warm.stress(&state, StressMeasure::Cauchy, None))
        };
        assert!(of(1.05 * IDENTITY).norm() < 1e-12 * BULK, "{name}");
        let error = (of(1.05 * f) - cauchy(law::<6>(case, &[], &[]).as_ref(), f)).norm();
        assert!(error < 1e-12 * BULK, "{name}: {error:e}");
    }
}

/// The nominal stresses that are fitted are those of the law, and constants with a falling stress are found.
#[test]
fn instabilities_are_found() {
    for case in &CASES[..6] {
        let made = properties(case.name, case.numbers, case.lists);
        let energy = (EnergyKind::of_law(case.name).unwrap().make)(&made).unwrap();
        let law = law::<6>(case, &[], &[]);
        for (test, l2) in [
            (HomogeneousTest::Uniaxial, 1.5_f64.sqrt().recip()),
            (HomogeneousTest::Equibiaxial, 1.5),
            (HomogeneousTest::Planar, 1.0),
        ] {
            let sigma = cauchy(law.as_ref(), diagonal(1.5, l2, 1.0 / (1.5 * l2)));
            let expected = (sigma[(0, 0)] - sigma[(2, 2)]) / 1.5;
            assert!(near(test.nominal_stress(&energy, 1.5), expected, 1e-12), "{} {}", case.name, test.name());
        }
    }
    // equibiaxial tension: σ = 2 (λ² − λ⁻⁴)(C₁₀ + C₀₁ λ²), whose slope by ln λ is lost where C₀₁ < 0
    let energy =
        |c10: f64, c01: f64| Energy::Invariants(Box::new(MooneyRivlin { linear: [c10, c01], quadratic: [0.0; 3] }));
    assert_eq!(first_instability(&energy(1.0, 0.2)), None);
    let unstable = energy(1.0, -0.2);
    let (l, slope) = (1.4_f64, BiaxialResponse::of(&unstable, [1.4, 1.4]).stiffness[0]);
    let expected = 2.0 * (2.0 * l.powi(2) + 4.0 * l.powi(-4) - 0.2 * (4.0 * l.powi(4) + 2.0 * l.powi(-2)));
    assert!(near(slope[0] + slope[1], expected, 1e-12), "{slope:?} {expected}");
    let (test, stretch) = first_instability(&unstable).unwrap();
    assert!(test == HomogeneousTest::Equibiaxial && stretch > 0.5 && stretch < 2.0, "{test:?} {stretch}");
}

#[test]
fn wrong_constants_are_named_with_a_remedy() {
    let problem = |law: &str, numbers: &[(&str, f64)], lists: &[(&str, &[f64])]| {
        let properties = properties(law, numbers, lists);
        law_of::<6>(&properties, false).err().expect("an error").to_string()
    };
    let mooney = "HyperElasticMooneyRivlin3DLaw";
    assert!(problem(mooney, &[("C10", 1.0)], &[]).contains("C01"));
    assert!(problem(mooney, &[("C10", 1.0), ("C01", -1.2)], &[]).contains("shear modulus -0.3999"));
    let ogden = "HyperElasticOgden3DLaw";
    assert!(
        problem(ogden, &[], &[("OGDEN_MODULI", &[1.0]), ("OGDEN_EXPONENTS", &[1.0, 2.0])])
            .contains("one exponent for each")
    );
    assert!(problem(ogden, &[], &[("OGDEN_MODULI", &[1.0]), ("OGDEN_EXPONENTS", &[0.0])]).contains("other than 0"));
    assert!(problem(ogden, &[], &[("OGDEN_MODULI", &[-1.0]), ("OGDEN_EXPONENTS", &[2.0])]).contains("shear modulus"));
    let constants = [("C10", 1.0), ("C01", 0.2)];
    assert!(
        problem(mooney, &constants, &[("PRONY_SHARES", &[0.6, 0.5]), ("PRONY_TIMES", &[1.0, 2.0])]).contains("below 1")
    );
    assert!(problem(mooney, &constants, &[("PRONY_SHARES", &[0.5])]).contains("PRONY_TIMES"));
    assert!(
        problem(mooney, &[("C10", 1.0), ("C01", 0.2), ("MULLINS_R", 0.9), ("MULLINS_M", 1.0)], &[]).contains("above 1")
    );
    assert!(
        problem("HyperElasticBlatzKo3DLaw", &[("SHEAR_MODULUS", 1.0), ("POISSON_RATIO", 0.5)], &[])
            .contains("below 0.5")
    );
}

/// ANALYTIC: a shear strain that grows in the step Δt and stays: τ = G γ (1 − Σ g_i + Σ g_i ξ(Δt/τ_i) exp(−(t − Δt)/τ_i)), 1e-14;
/// the pressure does not relax.
#[test]
fn shear_relaxes_under_small_strain() {
    let numbers = [("YOUNG_MODULUS", 5.0), ("POISSON_RATIO", 0.25)];
    let made =
        properties("SmallStrainViscoelasticity3D", &numbers, &[("PRONY_SHARES", &[0.7]), ("PRONY_TIMES", &[2.0])]);
    let law = law_of::<6>(&made, false).unwrap();
    let strain = [0.1, 0.1, 0.1, 0.2, 0.0, 0.0];
    let mut history = vec![0.0; law.history()];
    for pair in [0.0, 0.5, 1.0, 4.0].windows(2) {
        let before = history.clone();
        let now = StrainState { strain, step: [pair[0], pair[1]], history: &before, ..StrainState::REST };
        let mut d = [[0.0; 6]; 6];
        let stress = law.pk2(&now, Some(&mut d));
        law.advance(&now, &mut history);
        let x: f64 = 0.25;
        let factor = 0.3 + 0.7 * (1.0 - (-x).exp()) / x * (-(pair[1] - 0.5) / 2.0).exp();
        assert!(near(stress[3], 2.0 * 0.2 * factor, 1e-14) && near(stress[0], 10.0 / 3.0 * 0.3, 1e-14), "{stress:?}");
    }
}
