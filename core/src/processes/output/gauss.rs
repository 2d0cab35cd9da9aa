//! Quantities at Gauss points, as means of entities, as values at nodes, and as they are.

use rayon::prelude::*;

use super::quantity::GaussQuantity;
use crate::communication::world;
use crate::entities::{EntityBlock, Gauss, StepView};
use crate::geometry::Shape;
use crate::io::results::{Column, GaussResult};
use crate::model::ModelPart;
use crate::registry::Kind;

/// Not in the selection.
const OUT: u32 = u32::MAX;

/// An entity whose values are visited.
struct Seen<'a> {
    shape: Option<Shape>,
    nodes: &'a [u32],
    is_active: bool,
}

/// Calls `visit` with the position in `selected`, the entity and its values for every element (or condition) that knows
/// the quantity, blocks and entities in their order; of several ranks each sees all. Collective.
fn visit(
    part: &ModelPart,
    kind: Kind,
    selected: &[u32],
    quantity: &GaussQuantity,
    mut visit: impl FnMut(usize, &Seen<'_>, &Gauss),
) {
    let view = part.view();
    let (blocks, table) = match kind {
        Kind::Element => (&part.element_blocks, &part.elements),
        _ => (&part.condition_blocks, &part.conditions),
    };
    let mut position = vec![OUT; selected.iter().max().map_or(0, |&last| last as usize + 1)];
    for (at, &item) in selected.iter().enumerate() {
        position[item as usize] = at as u32;
    }
    let is_shared = part.partition.is_some();
    let mut own = Vec::new();
    for block in blocks {
        let known = block.gauss_variables();
        let names = [Some(quantity.name.as_str()), quantity.vector.as_deref()];
        let Some(name) = names.into_iter().flatten().find(|name| known.contains(name)) else { continue };
        let wanted: Vec<(usize, usize)> = block
            .members()
            .iter()
            .enumerate()
            .filter_map(|(at, &member)| position.get(member as usize).filter(|&&p| p != OUT).map(|&p| (at, p as usize)))
            .collect();
        let values: Vec<Option<Gauss>> =
            wanted.par_iter().map(|&(at, _)| values_of(block.as_ref(), &view, name, at)).collect();
        for ((at, row), gauss) in wanted.into_iter().zip(values) {
            let Some(gauss) = gauss.filter(|gauss| !gauss.weights.is_empty()) else { continue };
            let is_active = block.is_active(at, &view);
            if is_shared {
                pack(row, is_active, &gauss, &mut own);
            } else {
                let seen = Seen { shape: block.entry().cell, nodes: block.nodes(at), is_active };
                visit(row, &seen, &gauss);
            }
        }
    }
    if is_shared {
        let mut all: Vec<(usize, bool, Gauss)> = world().gather_numbers(&own).iter().flat_map(|n| unpack(n)).collect();
        let order = |row: usize| {
            let at = selected[row];
            (table.kinds[at as usize].name, table.properties[at as usize], at)
        };
        all.sort_by_key(|(row, ..)| order(*row));
        for (row, is_active, gauss) in &all {
            let at = selected[*row];
            let seen = Seen { shape: table.kinds[at as usize].cell, nodes: table.nodes(at), is_active: *is_active };
            visit(*row, &seen, gauss);
        }
    }
}

/// Adds an entity's values to a message.
fn pack(row: usize, is_active: bool, gauss: &Gauss, out: &mut Vec<f64>) {
    let sizes = [gauss.components, gauss.values.len(), gauss.weights.len(), gauss.shape.len()];
    out.extend([row as f64, f64::from(u8::from(is_active))]);
    out.extend(sizes.map(|size| size as f64));
    [&gauss.values, &gauss.weights, &gauss.shape].into_iter().for_each(|list| out.extend_from_slice(list));
}

/// The entities of a message of [`pack`].
fn unpack(mut message: &[f64]) -> Vec<(usize, bool, Gauss)> {
    let mut out = Vec::new();
    while let [row, is_active, components, values, weights, shape, rest @ ..] = message {
        let (values, rest) = rest.split_at(*values as usize);
        let (weights, rest) = rest.split_at(*weights as usize);
        let (shape, rest) = rest.split_at(*shape as usize);
        let gauss = Gauss {
            components: *components as usize,
            values: values.to_vec(),
            weights: weights.to_vec(),
            shape: shape.to_vec(),
        };
        out.push((*row as usize, *is_active != 0.0, gauss));
        message = rest;
    }
    out
}

fn values_of(block: &dyn EntityBlock, view: &StepView<'_>, name: &str, at: usize) -> Option<Gauss> {
    block.gauss(view, name, at)
}

/// One value an entity: the plain mean of its Gauss points; zero where the quantity is not known.
pub(super) fn means(part: &ModelPart, kind: Kind, selected: &[u32], quantity: &GaussQuantity) -> Column {
    let mut found: Vec<(usize, Vec<f64>)> = Vec::new();
    visit(part, kind, selected, quantity, |row, _, gauss| {
        let mut mean = vec![0.0; gauss.components];
        for values in gauss.values.chunks_exact(gauss.components) {
            mean.iter_mut().zip(values).for_each(|(mean, value)| *mean += value);
        }
        mean.iter_mut().for_each(|mean| *mean /= gauss.weights.len() as f64);
        found.push((row, mean));
    });
    let components = found.iter().map(|(_, mean)| mean.len()).max().unwrap_or(1);
    let mut values = vec![0.0; selected.len() * components];
    for (row, mean) in found {
        values[row * components..][..mean.len()].copy_from_slice(&mean);
    }
    Column::real(&quantity.name, components, values)
}

/// What a Gauss point counts by in means.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Share {
    /// The volume it stands for.
    Volume,
    /// Alike.
    Point,
}

/// One value a node: Σ w J |N_i| v / Σ w J |N_i| over the Gauss points of the active entities around it, or without w J.
pub(super) fn at_nodes(
    part: &ModelPart,
    kind: Kind,
    selected: &[u32],
    nodes: &[u32],
    quantity: &GaussQuantity,
    share: Share,
) -> Column {
    let mut components = 0;
    let mut sums: Vec<f64> = Vec::new();
    let mut weights = vec![0.0; part.nodes.len()];
    visit(part, kind, selected, quantity, |_, seen, gauss| {
        if !seen.is_active {
            return;
        }
        if gauss.components > components {
            let wider = widen(&sums, components, gauss.components, part.nodes.len());
            (sums, components) = (wider, gauss.components);
        }
        let own = seen.nodes;
        for (point, weight) in gauss.weights.iter().enumerate() {
            let values = &gauss.values[point * gauss.components..][..gauss.components];
            for (&node, shape) in own.iter().zip(&gauss.shape[point * own.len()..]) {
                let share = if share == Share::Volume { weight * shape.abs() } else { shape.abs() };
                weights[node as usize] += share;
                let sum = &mut sums[node as usize * components..][..gauss.components];
                sum.iter_mut().zip(values).for_each(|(sum, value)| *sum += share * value);
            }
        }
    });
    let components = components.max(1);
    let mut values = vec![0.0; nodes.len() * components];
    for (row, &node) in values.chunks_exact_mut(components).zip(nodes) {
        let weight = weights[node as usize];
        if weight > 0.0 {
            row.iter_mut().zip(&sums[node as usize * components..]).for_each(|(value, sum)| *value = sum / weight);
        }
    }
    Column::real(&quantity.name, components, values)
}

/// The rows of a table with more columns, zeros in the new ones.
fn widen(values: &[f64], from: usize, to: usize, rows: usize) -> Vec<f64> {
    let mut out = vec![0.0; rows * to];
    if from > 0 {
        out.chunks_exact_mut(to).zip(values.chunks_exact(from)).for_each(|(new, old)| new[..from].copy_from_slice(old));
    }
    out
}

/// The values as they are, in one result for each shape and number of points; stresses and strains in GiD's order.
pub(super) fn as_they_are(
    part: &ModelPart,
    kind: Kind,
    selected: &[u32],
    ids: &[usize],
    quantity: &GaussQuantity,
) -> Vec<GaussResult> {
    let mut out: Vec<GaussResult> = Vec::new();
    visit(part, kind, selected, quantity, |row, seen, gauss| {
        let Some(shape) = seen.shape else { return };
        let count = gauss.weights.len();
        let (components, values) = gid_order(&quantity.name, gauss);
        let same = |r: &GaussResult| r.shape == shape && r.points.len() == count && r.components == components;
        let at = out.iter().position(same).unwrap_or_else(|| {
            out.push(GaussResult {
                name: quantity.name.clone(),
                shape,
                points: local_points(shape, gauss),
                components,
                cells: Vec::new(),
                values: Vec::new(),
            });
            out.len() - 1
        });
        out[at].cells.push(ids[selected[row] as usize]);
        out[at].values.extend(values);
    });
    out
}

/// Symmetric tensors as GiD reads them, (xx, yy, zz, xy, yz, xz); anything else as it is.
fn gid_order(name: &str, gauss: &Gauss) -> (usize, Vec<f64>) {
    let is_tensor = name.contains("STRESS") || name.contains("STRAIN");
    let ordered = |v: &[f64]| match *v {
        [xx, yy, xy] | [xx, xy, _, yy] => [xx, yy, 0.0, xy, 0.0, 0.0],
        [xx, xy, xz, _, yy, yz, _, _, zz] => [xx, yy, zz, xy, yz, xz],
        _ => [0.0; 6],
    };
    if is_tensor && matches!(gauss.components, 3 | 4 | 9) {
        return (6, gauss.values.chunks_exact(gauss.components).flat_map(ordered).collect());
    }
    (gauss.components, gauss.values.clone())
}

/// Local coordinates of the Gauss points: Σ N_i ξ_i.
fn local_points(shape: Shape, gauss: &Gauss) -> Vec<[f64; 3]> {
    let nodes = shape.cell().points;
    gauss
        .shape
        .chunks_exact(nodes.len())
        .map(|values| {
            let mut point = [0.0; 3];
            for (value, node) in values.iter().zip(nodes) {
                point.iter_mut().zip(node).for_each(|(x, xi)| *x += value * xi);
            }
            point
        })
        .collect()
}

/// The values of every Gauss point of every selected entity that knows the quantity: position and values.
pub(super) fn each(
    part: &ModelPart,
    kind: Kind,
    selected: &[u32],
    quantity: &GaussQuantity,
    mut use_values: impl FnMut(usize, &Gauss),
) {
    visit(part, kind, selected, quantity, |row, _, gauss| use_values(row, gauss));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_hold_what_was_packed() {
        let gauss = Gauss { components: 2, values: vec![1., 2.], weights: vec![3.], shape: vec![0.5, 0.5] };
        let mut message = Vec::new();
        pack(7, true, &gauss, &mut message);
        pack(9, false, &Gauss::default(), &mut message);
        assert_eq!(unpack(&message), [(7, true, gauss), (9, false, Gauss::default())]);
    }

    #[test]
    fn tensors_stand_in_the_order_of_gid() {
        let gauss = |values: &[f64]| Gauss { components: values.len(), values: values.to_vec(), ..Gauss::default() };
        let order = |name, values: &[f64]| gid_order(name, &gauss(values)).1;
        assert_eq!(order("PK2_STRESS_TENSOR", &[1., 4., 6., 4., 2., 5., 6., 5., 3.]), [1., 2., 3., 4., 5., 6.]);
        assert_eq!(order("PK2_STRESS_TENSOR", &[1., 4., 4., 2.]), [1., 2., 0., 4., 0., 0.]);
        assert_eq!(order("CAUCHY_STRESS_VECTOR", &[1., 2., 4.]), [1., 2., 0., 4., 0., 0.]);
        assert_eq!(order("CAUCHY_STRESS_VECTOR", &[1., 2., 3., 4., 5., 6.]), [1., 2., 3., 4., 5., 6.]);
        assert_eq!(order("DISPLACEMENT", &[1., 2., 3.]), [1., 2., 3.]);
        assert_eq!(order("VON_MISES_STRESS", &[7.]), [7.]);
    }
}
