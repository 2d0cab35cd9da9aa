//! The width of the band in which an element softens.

use zelus_core::geometry::{Shape, ShapeTable, mapping};
use zelus_core::model::StepMark;

/// Mark of the step data: bands are as wide as in Kratos.
pub const BANDS_AS_KRATOS: StepMark = StepMark::new("BANDS_AS_KRATOS");

/// The edge of the square or cube that has the size of the element, or of those it is a part of: two triangles and prisms, six tetrahedra.
///
/// As in Kratos: the largest distance of a corner from the mean of all.
pub(super) fn width(rule: &ShapeTable, x: &[[f64; 3]], as_kratos: bool) -> f64 {
    let shape = rule.shape();
    let (linear, dim) = (shape.linear(), shape.dim());
    if as_kratos {
        let corners = &x[..linear.nodes()];
        let centre: [f64; 3] =
            std::array::from_fn(|a| corners.iter().map(|x| x[a]).sum::<f64>() / corners.len() as f64);
        let distance = |x: &[f64; 3]| (0..3).map(|a| (x[a] - centre[a]).powi(2)).sum::<f64>().sqrt();
        return corners.iter().map(distance).fold(0.0, f64::max);
    }
    let share = match linear {
        Shape::Tri3 | Shape::Prism6 => 2.0,
        Shape::Pyramid5 => 3.0,
        Shape::Tet4 => 6.0,
        _ => 1.0,
    };
    (share * mapping::domain_size(shape, x)).powf(1.0 / dim as f64)
}
