//! Volumetric locking: plain displacement elements of first order are far too stiff where the material hardly changes its volume.

use zelus_core::diagnostics::Diagnostic;
use zelus_core::entities::{BlockRequest, ElementEntry};
use zelus_core::geometry::Shape;
use zelus_core::registry::find;

use crate::laws::{LawEntry, LawFactory, Rubber};

/// Poisson's ratio above which elements lock.
const HIGHEST_RATIO: f64 = 0.49;

/// Beginnings of the names of elements that do not lock, for small and for finite strain.
const WITHOUT_LOCKING: [[&str; 2]; 2] = [
    ["SmallDisplacementMixedVolumetricStrainElement", "SmallDisplacementBbarElement"],
    ["TotalLagrangianMixedVolumetricStrainElement", "TotalLagrangianQ1P0MixedElement"],
];

/// Beginnings of the names of elements with a linear pressure on the cell of a larger shape.
const LINEAR_PRESSURE: &str = "TotalLagrangianQ2P1MixedElement";

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
    let of_rubber = Rubber::poisson_ratio(properties);
    let ratio = of_rubber.or_else(|| properties.number("POISSON_RATIO")).filter(|ratio| *ratio > HIGHEST_RATIO)?;
    let constant = if of_rubber.is_some() { "BULK_MODULUS, Poisson's ratio" } else { "POISSON_RATIO" };
    let shape = request.entry.cell.filter(|shape| !second_order(*shape).is_empty())?;
    let law = properties.law.as_deref().and_then(find::<LawEntry>)?;
    if matches!(law.build, LawFactory::PlaneStress(_)) {
        return None;
    }
    let (kind, space) = (request.entry.name, request.entry.space);
    let stem = kind.strip_suffix(&shape.cell().suffix(space))?;
    let revolution = if request.entry.of_revolution { "Axisym" } else { "" };
    let mixed =
        WITHOUT_LOCKING[usize::from(finite)].map(|stem| format!("{revolution}{stem}{}", shape.cell().suffix(space)));
    let mut mixed = mixed.to_vec();
    if finite {
        mixed.extend(
            second_order(shape)
                .iter()
                .map(|shape| format!("{revolution}{LINEAR_PRESSURE}{}", shape.cell().suffix(space))),
        );
    }
    // an element that leaves the volume to the law goes with any law, the others with those of rubber
    let holds_pressure = |name: &String| name.contains("Q1P0") || name.contains("Q2P1");
    mixed.retain(|name| of_rubber.is_some() || law.name.contains("Ishochoric") || !holds_pressure(name));
    let larger = second_order(shape).iter().map(|shape| format!("{stem}{}", shape.cell().suffix(space)));
    let known: Vec<String> =
        mixed.into_iter().chain(larger).filter(|name| find::<ElementEntry>(name).is_some()).collect();
    let part = request.part.tree.smallest_with_element(first).unwrap_or(&request.part.name);
    let fact = format!(
        "{kind} of part {part} locks at {constant} {ratio} of properties {}: displacements may be several times too small",
        properties.id
    );
    let remedy = format!("use elements that do not lock above {HIGHEST_RATIO}: {}", known.join(", "));
    Some(Diagnostic::warning("locking", fact).at(properties.place.clone()).remedy(remedy))
}
