//! Gauss rules on the cells of an overlap: a segment, or a triangle.

use super::settings::IntegrationOrder;

/// A point of the unit interval [0, 1] and its weight; the weights of a rule add up to 1.
pub(crate) type LinePoint = (f64, f64);
/// Barycentric coordinates in a triangle and the weight; the weights of a rule add up to 1.
pub(crate) type TrianglePoint = ([f64; 3], f64);

/// Gauss–Legendre rules with 1 to 5 points.
pub(crate) fn line(order: IntegrationOrder) -> &'static [LinePoint] {
    match order.get() {
        1 => &[(0.5, 1.0)],
        2 => &[(0.211_324_865_405_187_1, 0.5), (0.788_675_134_594_812_9, 0.5)],
        3 => &[(0.112_701_665_379_258_31, 5.0 / 18.0), (0.5, 4.0 / 9.0), (0.887_298_334_620_741_7, 5.0 / 18.0)],
        4 => &[
            (0.069_431_844_202_973_71, 0.173_927_422_568_726_93),
            (0.330_009_478_207_571_87, 0.326_072_577_431_273_07),
            (0.669_990_521_792_428_1, 0.326_072_577_431_273_07),
            (0.930_568_155_797_026_3, 0.173_927_422_568_726_93),
        ],
        _ => &[
            (0.046_910_077_030_668, 0.118_463_442_528_094_54),
            (0.230_765_344_947_158_45, 0.239_314_335_249_683_23),
            (0.5, 0.284_444_444_444_444_44),
            (0.769_234_655_052_841_5, 0.239_314_335_249_683_23),
            (0.953_089_922_969_332, 0.118_463_442_528_094_54),
        ],
    }
}

/// Symmetric rules with 1, 3, 4, 6 and 12 points, exact to degree 1, 2, 3, 4 and 6.
pub(crate) fn triangle(order: IntegrationOrder) -> &'static [TrianglePoint] {
    const THIRD: f64 = 1.0 / 3.0;
    const SIXTH: f64 = 1.0 / 6.0;
    const A: f64 = 0.445_948_490_915_965;
    const A1: f64 = 1.0 - 2.0 * A;
    const WA: f64 = 0.223_381_589_678_011;
    const B: f64 = 0.091_576_213_509_771;
    const B1: f64 = 1.0 - 2.0 * B;
    const WB: f64 = 1.0 / 3.0 - WA;
    const C: f64 = 0.249_286_745_170_910_43;
    const C1: f64 = 1.0 - 2.0 * C;
    const WC: f64 = 0.116_786_275_726_379_37;
    const D: f64 = 0.063_089_014_491_502_23;
    const D1: f64 = 1.0 - 2.0 * D;
    const WD: f64 = 0.050_844_906_370_206_82;
    const E: f64 = 0.053_145_049_844_816_947;
    const F: f64 = 0.310_352_451_033_784_4;
    const G: f64 = 1.0 - E - F;
    const WE: f64 = 0.082_851_075_618_373_57;
    match order.get() {
        1 => &[([THIRD; 3], 1.0)],
        2 => &[
            ([4.0 * SIXTH, SIXTH, SIXTH], THIRD),
            ([SIXTH, 4.0 * SIXTH, SIXTH], THIRD),
            ([SIXTH, SIXTH, 4.0 * SIXTH], THIRD),
        ],
        3 => &[
            ([THIRD; 3], -27.0 / 48.0),
            ([0.6, 0.2, 0.2], 25.0 / 48.0),
            ([0.2, 0.6, 0.2], 25.0 / 48.0),
            ([0.2, 0.2, 0.6], 25.0 / 48.0),
        ],
        4 => &[
            ([A1, A, A], WA),
            ([A, A1, A], WA),
            ([A, A, A1], WA),
            ([B1, B, B], WB),
            ([B, B1, B], WB),
            ([B, B, B1], WB),
        ],
        _ => &[
            ([C1, C, C], WC),
            ([C, C1, C], WC),
            ([C, C, C1], WC),
            ([D1, D, D], WD),
            ([D, D1, D], WD),
            ([D, D, D1], WD),
            ([E, F, G], WE),
            ([F, G, E], WE),
            ([G, E, F], WE),
            ([F, E, G], WE),
            ([E, G, F], WE),
            ([G, F, E], WE),
        ],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ∫ of s^p over [0,1] is 1/(p+1).
    #[test]
    fn line_rules_are_exact_to_degree_2n_minus_1() {
        for n in 1..=5 {
            let rule = line(IntegrationOrder::new(n).unwrap());
            assert_eq!(rule.len(), n);
            for p in 0..2 * n as i32 {
                let sum: f64 = rule.iter().map(|(s, w)| w * s.powi(p)).sum();
                assert!((sum - 1.0 / f64::from(p + 1)).abs() < 1e-15, "{n} {p} {sum}");
            }
        }
    }

    /// The mean of ξ^p η^q over the unit triangle is 2 p! q! / (p+q+2)!.
    #[test]
    fn triangle_rules_are_exact_to_their_degree() {
        let factorial = |n: i32| (1..=n).map(f64::from).product::<f64>();
        for (n, (points, degree)) in [(1, 1), (3, 2), (4, 3), (6, 4), (12, 6)].into_iter().enumerate() {
            let rule = triangle(IntegrationOrder::new(n + 1).unwrap());
            assert_eq!(rule.len(), points);
            for p in 0..=degree {
                for q in 0..=degree - p {
                    let sum: f64 = rule.iter().map(|(b, w)| w * b[1].powi(p) * b[2].powi(q)).sum();
                    let exact = 2.0 * factorial(p) * factorial(q) / factorial(p + q + 2);
                    assert!((sum - exact).abs() < 1e-14, "{points} points, {p} {q}: {sum} {exact}");
                }
            }
        }
    }
}
