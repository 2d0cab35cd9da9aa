//! Quantities at Gauss points, as means of entities, as values at nodes, and as they are.

use std::collections::{BTreeMap, BTreeSet};

use zelus_linear_algebra::parallel;

use super::quantity::GaussQuantity;
use crate::assembly::System;
use crate::communication::Ranks;
use crate::entities::{EntityBlock, Gauss, StepView};
use crate::geometry::Shape;
use crate::io::results::{Column, GaussResult};
use crate::model::{EntityRole, ModelPart};

/// Not in the selection.
const OUT: u32 = u32::MAX;

/// An entity whose values are visited.
struct Seen<'a> {
    shape: Option<Shape>,
    nodes: &'a [u32],
    is_active: bool,
}

/// Whether a block of this rank knows the quantity.
pub(super) fn is_known(system: &System, kind: EntityRole, quantity: &GaussQuantity) -> bool {
    let names = [Some(quantity.name.as_str()), quantity.vector.as_deref()];
    let knows = |known: &[&str]| names.into_iter().flatten().any(|name| known.contains(&name));
    system.blocks(kind).iter().any(|block| knows(block.gauss_variables()))
}

/// Whether an element of this rank gives the quantity: some laws know names that others do not. The first element of each material
/// answers for all.
pub(super) fn is_given(part: &ModelPart, system: &System, quantity: &GaussQuantity) -> bool {
    let view = part.view();
    let names = [Some(quantity.name.as_str()), quantity.vector.as_deref()];
    system.blocks(EntityRole::Element).iter().any(|block| {
        let known = block.gauss_variables();
        let Some(name) = names.into_iter().flatten().find(|name| known.contains(name)) else { return false };
        let mut asked = BTreeSet::new();
        let mut members = block.members().iter().enumerate();
        members.any(|(at, &member)| {
            asked.insert(part.elements.properties[member as usize])
                && values_of(block.as_ref(), &view, name, at).is_some()
        })
    })
}

/// Calls `visit` with the position in `selected`, the entity and its values for every element (or condition) of this rank
/// that knows the quantity, blocks and entities in their order.
fn visit(
    part: &ModelPart,
    system: &System,
    kind: EntityRole,
    selected: &[u32],
    quantity: &GaussQuantity,
    mut visit: impl FnMut(usize, &Seen<'_>, &Gauss),
) {
    let view = part.view();
    let mut position = vec![OUT; selected.iter().max().map_or(0, |&last| last as usize + 1)];
    for (at, &item) in selected.iter().enumerate() {
        position[item as usize] = at as u32;
    }
    for block in system.blocks(kind) {
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
            parallel::map(wanted.len(), 16, |at| values_of(block.as_ref(), &view, name, wanted[at].0));
        for ((at, row), gauss) in wanted.into_iter().zip(values) {
            let Some(gauss) = gauss.filter(|gauss| !gauss.weights.is_empty()) else { continue };
            let seen =
                Seen { shape: block.entry().cell, nodes: block.nodes(at), is_active: block.is_active(at, &view) };
            visit(row, &seen, &gauss);
        }
    }
}

/// The largest number of components that any rank has met; collective.
fn widest(ranks: &Ranks, components: usize) -> usize {
    ranks.gather_numbers(&[components as f64]).concat().into_iter().fold(1.0, f64::max) as usize
}

fn values_of(block: &dyn EntityBlock, view: &StepView<'_>, name: &str, at: usize) -> Option<Gauss> {
    block.gauss(view, name, at)
}

/// One value an entity: the plain mean of its Gauss points; zero where the quantity is not known. Collective.
pub(super) fn means(
    part: &ModelPart,
    system: &System,
    kind: EntityRole,
    selected: &[u32],
    quantity: &GaussQuantity,
) -> Column {
    let mut found: Vec<(usize, Vec<f64>)> = Vec::new();
    visit(part, system, kind, selected, quantity, |row, _, gauss| {
        let mut mean = vec![0.0; gauss.components];
        for values in gauss.values.chunks_exact(gauss.components) {
            mean.iter_mut().zip(values).for_each(|(mean, value)| *mean += value);
        }
        mean.iter_mut().for_each(|mean| *mean /= gauss.weights.len() as f64);
        found.push((row, mean));
    });
    let components = widest(&part.ranks, found.iter().map(|(_, mean)| mean.len()).max().unwrap_or(1));
    let mut values = vec![0.0; selected.len() * components];
    for (row, mean) in found {
        values[row * components..][..mean.len()].copy_from_slice(&mean);
    }
    Column::real(&quantity.name, components, values)
}

/// Weight of a Gauss point in means.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum GaussWeight {
    /// The volume it stands for.
    Volume,
    /// Alike.
    Point,
}

/// Sums over the Gauss points around each node, over all ranks.
struct NodalSums {
    components: usize,
    /// Σ w J |N_i| v, a row a node.
    values: Vec<f64>,
    /// Σ w J |N_i|.
    weights: Vec<f64>,
}

impl NodalSums {
    /// The sums over the selected entities that are active; collective.
    fn of(
        part: &ModelPart,
        system: &System,
        kind: EntityRole,
        selected: &[u32],
        quantity: &GaussQuantity,
        share: GaussWeight,
    ) -> Self {
        let mut components = 0;
        let mut sums: Vec<f64> = Vec::new();
        let mut weights = vec![0.0; part.nodes.len()];
        visit(part, system, kind, selected, quantity, |_, seen, gauss| {
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
                    let share = if share == GaussWeight::Volume { weight * shape.abs() } else { shape.abs() };
                    weights[node as usize] += share;
                    let sum = &mut sums[node as usize * components..][..gauss.components];
                    sum.iter_mut().zip(values).for_each(|(sum, value)| *sum += share * value);
                }
            }
        });
        let most = widest(&part.ranks, components);
        let mut values = widen(&sums, components, most, part.nodes.len());
        let components = most;
        if let Some(halo) = part.share.as_ref().map(|share| &share.halo) {
            halo.sum(&mut weights);
            let at = |node: u32, out: &mut Vec<u32>| {
                out.extend((0..components as u32).map(|c| node * components as u32 + c))
            };
            halo.expand(at).sum(&mut values);
        }
        Self { components, values, weights }
    }

    /// The mean of the values around a node; nothing where there are none.
    fn mean(&self, node: usize) -> Option<impl Iterator<Item = f64> + '_> {
        let weight = self.weights[node];
        let row = &self.values[node * self.components..][..self.components];
        (weight > 0.0).then(|| row.iter().map(move |sum| sum / weight))
    }
}

/// One value a node: Σ w J |N_i| v / Σ w J |N_i| over the Gauss points of the active entities around it, or without w J.
/// Collective.
pub(super) fn at_nodes(
    part: &ModelPart,
    system: &System,
    kind: EntityRole,
    selected: &[u32],
    nodes: &[u32],
    quantity: &GaussQuantity,
    share: GaussWeight,
) -> Column {
    let sums = NodalSums::of(part, system, kind, selected, quantity, share);
    let components = sums.components;
    let mut values = vec![0.0; nodes.len() * components];
    for (row, &node) in values.chunks_exact_mut(components).zip(nodes) {
        let mean = sums.mean(node as usize);
        row.iter_mut().zip(mean.into_iter().flatten()).for_each(|(value, mean)| *value = mean);
    }
    Column::real(&quantity.name, components, values)
}

/// A number at all nodes as [`at_nodes`] gives it by volume, `None` where no element around a node knows it. Collective.
pub(super) fn scalars_at_nodes(part: &ModelPart, system: &System, quantity: &GaussQuantity) -> Vec<Option<f64>> {
    if !part.ranks.any(is_given(part, system, quantity)) {
        return vec![None; part.nodes.len()];
    }
    let all: Vec<u32> = (0..part.elements.len() as u32).collect();
    let sums = NodalSums::of(part, system, EntityRole::Element, &all, quantity, GaussWeight::Volume);
    (0..part.nodes.len()).map(|node| sums.mean(node)?.next()).collect()
}

/// The rows of a table with more columns, zeros in the new ones.
fn widen(values: &[f64], from: usize, to: usize, rows: usize) -> Vec<f64> {
    let mut out = vec![0.0; rows * to];
    if from > 0 {
        out.chunks_exact_mut(to).zip(values.chunks_exact(from)).for_each(|(new, old)| new[..from].copy_from_slice(old));
    }
    out
}

/// The values as they are, in one result for each shape and number of points; stresses and strains in GiD's order. The first rank gets
/// those of all ranks; collective.
pub(super) fn as_they_are(
    part: &ModelPart,
    system: &System,
    kind: EntityRole,
    selected: &[u32],
    ids: &[usize],
    quantity: &GaussQuantity,
) -> Vec<GaussResult> {
    let mut out: Vec<GaussResult> = Vec::new();
    visit(part, system, kind, selected, quantity, |row, seen, gauss| {
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
    if part.share.is_some() { gathered(&part.ranks, &quantity.name, &out) } else { out }
}

/// The results of all ranks on rank 0, cells by their ids.
fn gathered(ranks: &Ranks, name: &str, own: &[GaussResult]) -> Vec<GaussResult> {
    let mut message = Vec::new();
    for result in own {
        let sizes = [result.shape as usize, result.points.len(), result.components, result.cells.len()];
        message.extend(sizes.map(|size| size as f64));
        message.extend(result.points.as_flattened());
        message.extend(result.cells.iter().map(|&id| id as f64));
        message.extend(&result.values);
    }
    // Local coordinates of the points, and for each cell its values.
    type Found = (Vec<[f64; 3]>, BTreeMap<usize, Vec<f64>>);
    let mut all: BTreeMap<[usize; 3], Found> = BTreeMap::new();
    for message in ranks.to_root(message) {
        let mut rest = &message[..];
        while let [shape, points, components, cells, more @ ..] = rest {
            let [shape, points, components, cells] = [shape, points, components, cells].map(|n| *n as usize);
            let (positions, more) = more.split_at(3 * points);
            let (ids, more) = more.split_at(cells);
            let (values, more) = more.split_at(cells * points * components);
            rest = more;
            let found = all.entry([shape, points, components]).or_default();
            found.0 = positions.as_chunks().0.to_vec();
            let rows = values.chunks_exact((points * components).max(1)).map(<[f64]>::to_vec);
            found.1.extend(ids.iter().map(|&id| id as usize).zip(rows));
        }
    }
    all.into_iter()
        .map(|([shape, _, components], (points, cells))| GaussResult {
            name: name.to_owned(),
            shape: Shape::ALL[shape],
            points,
            components,
            cells: cells.keys().copied().collect(),
            values: cells.into_values().flatten().collect(),
        })
        .collect()
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

/// The values of every Gauss point of every selected entity of this rank that knows the quantity: position and values.
pub(super) fn each(
    part: &ModelPart,
    system: &System,
    kind: EntityRole,
    selected: &[u32],
    quantity: &GaussQuantity,
    mut use_values: impl FnMut(usize, &Gauss),
) {
    visit(part, system, kind, selected, quantity, |row, _, gauss| use_values(row, gauss));
}

#[cfg(test)]
mod tests {
    use super::*;

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
