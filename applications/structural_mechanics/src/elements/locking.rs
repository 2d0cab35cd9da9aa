//! Volumetric locking: plain displacement elements of first order are far too stiff where the material hardly changes its volume.

use zelus_core::diagnostics::Diagnostic;
use zelus_core::entities::{BlockRequest, ElementEntry};
use zelus_core::geometry::Shape;
use zelus_core::registry::find;

use crate::laws::{LawEntry, LawFactory};

/// Poisson's ratio above which elements lock.
const HIGHEST_RATIO: f64 = 0.49;

/// Beginnings of the names of elements that do not lock, for small and for finite strain.
const WITHOUT_LOCKING: [[&str; 2]; 2] = [
    ["SmallDisplacementMixedVolumetricStrainElement", "SmallDisplacementBbarElement"],
    ["TotalLagrangianMixedVolumetricStrainElement", "TotalLagrangianQ1P0MixedElement"],
];

/// Shapes of second order on the cell of one of first order.
fn second_order(shape: Shape) -> &'static [Shape] {
    match shape {
        Shape::Tri3 => &[Shape::Tri6],
        Shape::Quad4 => &[Shape::Quad8, Shape::Quad9],
        Shape::Tet4 => &[Shape::Tet10],
        Shape::Pyramid5 => &[Shape::Pyramid13],
        Shape::Prism6 => &[Shape::Prism15, Shape::Prism18],
        Shape::Hex8 => &[Shape::Hex20, Shape::Hex27],
        _ => &[],
    }
}

/// The warning that the requested elements, whose strain follows their displacements alone, lock with their material.
pub(super) fn locking(request: &BlockRequest<'_>, finite: bool) -> Option<Diagnostic> {
    let &first = request.members.first()?;
    let properties = request.part.properties.get(&request.table.properties[first as usize])?;
    let ratio = properties.number("POISSON_RATIO").filter(|ratio| *ratio > HIGHEST_RATIO)?;
    let shape = request.entry.cell.filter(|shape| !second_order(*shape).is_empty())?;
    let law = properties.law.as_deref().and_then(find::<LawEntry>)?;
    if matches!(law.build, LawFactory::PlaneStress(_)) {
        return None;
    }
    let (kind, space) = (request.entry.name, request.entry.space);
    let stem = kind.strip_suffix(&shape.cell().suffix(space))?;
    let mixed = WITHOUT_LOCKING[usize::from(finite)].map(|stem| format!("{stem}{}", shape.cell().suffix(space)));
    let mixed = mixed.into_iter().filter(|_| !request.entry.of_revolution);
    let larger = second_order(shape).iter().map(|shape| format!("{stem}{}", shape.cell().suffix(space)));
    let known: Vec<String> = mixed.chain(larger).filter(|name| find::<ElementEntry>(name).is_some()).collect();
    let part = request.part.tree.smallest_with_element(first).unwrap_or(&request.part.name);
    let fact = format!(
        "{kind} of part {part} locks at POISSON_RATIO {ratio} of properties {}: displacements may be several times too small",
        properties.id
    );
    let remedy = format!("use elements that do not lock above {HIGHEST_RATIO}: {}", known.join(", "));
    Some(Diagnostic::warning("locking", fact).at(properties.place.clone()).remedy(remedy))
}
