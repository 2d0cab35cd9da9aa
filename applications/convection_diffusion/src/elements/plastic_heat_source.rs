//! Heat of plastic flow in an element, which spreads evenly over it.

use zelus_core::entities::StepView;
use zelus_core::geometry::ShapeTable;
use zelus_structural_mechanics::elements::physical_gradients;

/// Data of elements: heat of plastic flow in a unit of time.
pub const PLASTIC_HEAT_POWER: &str = "PLASTIC_HEAT_POWER";

/// The heat of plastic flow by volume, in the plane by area; volumes are multiplied by `round` of the shape functions of a point.
pub(super) fn plastic_heat<const NODES: usize, const DIM: usize>(
    view: &StepView<'_>,
    element: u32,
    (rule, x): (&ShapeTable, &[[f64; 3]; NODES]),
    round: impl Fn(&[f64; NODES]) -> f64,
) -> f64 {
    match view.elements.data.level(PLASTIC_HEAT_POWER, 0).get(element as usize) {
        None | Some(0.0) => 0.0,
        Some(power) => power / volume::<NODES, DIM>(rule, x, round),
    }
}

/// The volume of an element, its points multiplied by `round` of their shape functions.
pub(super) fn volume<const NODES: usize, const DIM: usize>(
    rule: &ShapeTable,
    x: &[[f64; 3]; NODES],
    round: impl Fn(&[f64; NODES]) -> f64,
) -> f64 {
    let points = rule.dn::<NODES, DIM>().iter().zip(rule.n::<NODES>()).enumerate();
    points.map(|(g, (dn, n))| rule.weight(g) * physical_gradients(x, dn).1 * round(n)).sum()
}
