//! The unit of length that Kratos' numbers without a unit refer to, where a deck asks for them.
//!
//! Kratos multiplies *weighted* gaps, which hold an area, with E/h, and compares operators, which are areas, with a bare
//! number. Such numbers mean something in a unit of length only, and are chosen for bodies that measure about one in it.
//! Engineers' units step by thousands: µm, mm, m, km.

use zelus_core::communication::Ranks;
use zelus_core::diagnostics::Diagnostic;

/// The unit of length of a model, and the area that a penalty of weighted gaps is divided by (`penalty_of_weighted_gaps`).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PenaltyUnit {
    /// The unit (length).
    pub length: f64,
    /// Weight of a weighted gap beside a gap: an area, in the plane a length.
    pub measure: f64,
}

impl PenaltyUnit {
    /// Unit of these points; `by_length` in the plane, where weighted gaps hold a length. Collective.
    pub fn of(ranks: &Ranks, points: &[[f64; 3]], by_length: bool) -> Self {
        let length = unit_of_length(ranks, points);
        Self { length, measure: if by_length { length } else { length * length } }
    }

    /// The warning that a penalty, on which answers depend without multipliers, is Kratos' over the measure.
    pub fn warning(self) -> Option<Diagnostic> {
        let Self { length, measure } = self;
        let fact = format!(
            "the penalty is estimated as for a unit of length of {length:e}: it is Kratos' own over {measure:e}"
        );
        let remedy = format!(
            "for Kratos' own multiply \"stiffness_factor\" by {measure:e}; \"manual_ALM\" with \"penalty\" sets any other"
        );
        (length != 1.0).then(|| Diagnostic::warning("penalty-unit", fact).remedy(remedy))
    }
}

/// Power of a thousand in which points extend over about one: between 1/√1000 and √1000 (length).
///
/// The extent is the diagonal of the box around those of all ranks; 1 without any. In units a thousand times smaller it is a
/// thousand times the number, to the last bit. Collective.
fn unit_of_length(ranks: &Ranks, points: &[[f64; 3]]) -> f64 {
    let bounds = |c: usize| {
        let of = points.iter().map(|x| x[c]);
        let own = of.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], x| [least.min(x), most.max(x)]);
        let all = ranks.gather_numbers(&own);
        all.iter().fold((own[0], own[1]), |(least, most), of_rank| (least.min(of_rank[0]), most.max(of_rank[1])))
    };
    let sides = [0, 1, 2].map(bounds).map(|(least, most)| most - least);
    let extent = zelus_core::vector3::norm(sides);
    if extent.is_finite() && extent > 0.0 { 1000.0_f64.powi((extent.log10() / 3.0).round() as i32) } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn follows_the_unit_of_the_mesh() {
        let body = |extent: f64| unit_of_length(&Ranks::default(), &[[5.0, 5.0, 5.0], [5.0 + extent, 5.0, 5.0]]);
        assert_eq!([0.04, 1.0, 30.0].map(body), [1.0; 3]);
        assert_eq!([40.0, 1e3, 3e4].map(body), [1e3; 3]);
        assert_eq!([4e-5, 1e-3, 0.03].map(body), [1e-3; 3]);
        assert_eq!((unit_of_length(&Ranks::default(), &[]), body(0.0)), (1.0, 1.0));
    }
}
