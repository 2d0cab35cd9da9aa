//! Nodes between the corners of second-order cells, from these corners: multigrid goes from such cells to the linear ones of their corners.

use zelus_linear_algebra::Csr;

use super::dof_table::DofTable;
use crate::geometry::ReferenceCell;
use crate::model::{EntityKind, ModelPart, Owner};

/// Place of a node in a cell.
#[derive(Clone, Copy)]
enum Place {
    Nowhere,
    /// At a corner of some element.
    Corner,
    /// Between corners of this element, as its node with this local number.
    Between(u32, usize),
}

/// Corners, by local number, between which a node of a cell lies: those of its edge, else of its face, else all.
fn corners_around(cell: &'static ReferenceCell, local: usize) -> Vec<usize> {
    let of_facet = cell.edges.iter().chain(cell.faces).find(|facet| facet.nodes.contains(&local));
    let is_corner = |n: &usize| *n < cell.corners();
    match of_facet {
        Some(facet) => facet.nodes.iter().copied().filter(is_corner).collect(),
        None => (0..cell.corners()).collect(),
    }
}

/// The linear interpolation of all unknowns from those at corners of elements: rows of corners have one in their own column, those of
/// nodes between corners have the means of these. Without second-order elements it has no rows.
pub fn corner_interpolation(part: &ModelPart, dofs: &DofTable) -> Csr {
    let table = &part.elements;
    let cells = || {
        let of = |(at, kind): (usize, &&'static EntityKind)| Some((at as u32, kind.cell?.cell()));
        table.kinds.iter().enumerate().filter_map(of)
    };
    if !cells().any(|(_, cell)| cell.points.len() > cell.corners()) {
        return Csr::default();
    }
    let mut places = vec![Place::Nowhere; part.nodes.len()];
    for (element, cell) in cells() {
        for (local, &node) in table.nodes(element).iter().enumerate() {
            let place = &mut places[node as usize];
            match place {
                _ if local < cell.corners() => *place = Place::Corner,
                Place::Nowhere => *place = Place::Between(element, local),
                _ => {}
            }
        }
    }
    let mut matrix = Csr::empty(dofs.dofs().len());
    for (number, dof) in dofs.dofs().iter().enumerate() {
        match places[dof.node as usize] {
            Place::Between(element, local) if !dof.multiplier => {
                let (kind, nodes) = (table.kinds[element as usize], table.nodes(element));
                let corners = corners_around(kind.cell.expect("it has one").cell(), local);
                let share = 1.0 / corners.len() as f64;
                let numbers = corners.iter().filter_map(|&n| dofs.number_of(dof.variable, Owner::Node(nodes[n])));
                let mut columns: Vec<u32> = numbers.collect();
                columns.sort_unstable();
                matrix.values.extend(columns.iter().map(|_| share));
                matrix.columns.extend(columns);
            }
            _ => {
                matrix.columns.push(number as u32);
                matrix.values.push(1.0);
            }
        }
        matrix.row_starts[number + 1] = matrix.columns.len();
    }
    matrix
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Shape;

    /// ANALYTIC: on every reference cell the mean of the corners around a node is the node, to rounding.
    #[test]
    fn nodes_lie_in_the_middle_of_the_corners_around_them() {
        for shape in Shape::ALL {
            let cell = shape.cell();
            for local in cell.corners()..cell.points.len() {
                let corners = corners_around(cell, local);
                for axis in 0..3 {
                    let mean = corners.iter().map(|&n| cell.points[n][axis]).sum::<f64>() / corners.len() as f64;
                    assert!((mean - cell.points[local][axis]).abs() < 1e-15, "{shape:?} node {local}");
                }
            }
        }
    }
}
