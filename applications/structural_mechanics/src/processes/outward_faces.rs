//! Faces of a part with their outward sides: those of its conditions, or faces of elements all of whose nodes belong to it.

use std::collections::BTreeMap;

use zelus_core::geometry::{Shape, ShapeTable, mapping};
use zelus_core::model::{ModelPart, SubPart};
use zelus_core::vector3::{add, dot, scale, sub};

/// A face: a line in the plane, a surface in space.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct OutwardFace {
    /// Its shape.
    shape: Shape,
    /// Its nodes (index), in the order of the shape.
    nodes: Vec<u32>,
    /// 1 where its normal points out of the body, −1 where into it.
    side: f64,
}

impl OutwardFace {
    /// The outward normals at its nodes in the initial geometry, as long as the area there by local coordinates.
    fn normals<'a>(&'a self, part: &'a ModelPart) -> impl Iterator<Item = (u32, [f64; 3])> + 'a {
        let x: Vec<[f64; 3]> = self.nodes.iter().map(|&node| part.nodes.initial[node as usize]).collect();
        let points = ShapeTable::at_nodes(self.shape).points();
        let normal = move |point: [f64; 3]| scale(mapping::area_normal(self.shape, &x, point), self.side);
        self.nodes.iter().zip(points).map(move |(&node, point)| (node, normal(point.xi)))
    }
}

/// The faces of a part's conditions; where it has none, of the elements at its nodes.
pub(super) fn outward_faces(part: &ModelPart, selection: &SubPart) -> Vec<OutwardFace> {
    let dim = part.info.domain_size - 1;
    let around = elements_around(part, selection);
    let of_condition = |&at: &u32| {
        let shape = part.conditions.kinds[at as usize].cell.filter(|shape| shape.dim() == dim)?;
        let nodes = part.conditions.nodes(at).to_vec();
        let side = side(part, shape, &nodes, &around);
        Some(OutwardFace { shape, nodes, side })
    };
    let of_conditions: Vec<OutwardFace> = selection.conditions.iter().filter_map(of_condition).collect();
    if of_conditions.is_empty() { skin(part, selection, &around, dim) } else { of_conditions }
}

/// The sum of the outward normals of the faces at each node.
pub(super) fn nodal_normals(part: &ModelPart, faces: &[OutwardFace]) -> BTreeMap<u32, [f64; 3]> {
    let mut sums = BTreeMap::new();
    for (node, normal) in faces.iter().flat_map(|face| face.normals(part)) {
        let sum = sums.entry(node).or_insert([0.0; 3]);
        *sum = add(*sum, normal);
    }
    sums
}

/// The elements at each node of the part.
fn elements_around(part: &ModelPart, selection: &SubPart) -> BTreeMap<u32, Vec<u32>> {
    let on_conditions = selection.conditions.iter().flat_map(|&at| part.conditions.nodes(at));
    let mut around: BTreeMap<u32, Vec<u32>> =
        selection.nodes.iter().chain(on_conditions).map(|&node| (node, Vec::new())).collect();
    for element in 0..part.elements.len() as u32 {
        for node in part.elements.nodes(element) {
            around.entry(*node).and_modify(|list| list.push(element));
        }
    }
    around
}

/// The side of a face to which its normal points, by the element behind it; outward where there is none.
fn side(part: &ModelPart, shape: Shape, nodes: &[u32], around: &BTreeMap<u32, Vec<u32>>) -> f64 {
    let holds = |&&element: &&u32| nodes.iter().all(|node| part.elements.nodes(element).contains(node));
    let Some(&element) = around.get(&nodes[0]).and_then(|elements| elements.iter().find(holds)) else { return 1.0 };
    let x: Vec<[f64; 3]> = nodes.iter().map(|&node| part.nodes.initial[node as usize]).collect();
    let mean = |nodes: &[u32]| {
        let sum = nodes.iter().fold([0.0; 3], |sum, &node| add(sum, part.nodes.initial[node as usize]));
        scale(sum, (nodes.len() as f64).recip())
    };
    let outward = sub(mean(nodes), mean(part.elements.nodes(element)));
    if dot(mapping::vector_area(shape, &x), outward) < 0.0 { -1.0 } else { 1.0 }
}

/// Faces of one element only, all of whose nodes belong to the part.
fn skin(part: &ModelPart, selection: &SubPart, around: &BTreeMap<u32, Vec<u32>>, dim: usize) -> Vec<OutwardFace> {
    let mut elements: Vec<u32> = around.values().flatten().copied().collect();
    elements.sort_unstable();
    elements.dedup();
    let mut found: BTreeMap<Vec<u32>, (OutwardFace, usize)> = BTreeMap::new();
    for element in elements {
        let Some(shape) = part.elements.kinds[element as usize].cell.filter(|shape| shape.dim() == dim + 1) else {
            continue;
        };
        let own = part.elements.nodes(element);
        for facet in shape.cell().faces {
            let nodes: Vec<u32> = facet.nodes.iter().map(|&at| own[at]).collect();
            if nodes.iter().any(|node| selection.nodes.binary_search(node).is_err()) {
                continue;
            }
            let mut key = nodes.clone();
            key.sort_unstable();
            let side = side(part, facet.shape, &nodes, &BTreeMap::from([(nodes[0], vec![element])]));
            found.entry(key).or_insert((OutwardFace { shape: facet.shape, nodes, side }, 0)).1 += 1;
        }
    }
    found.into_values().filter(|(_, count)| *count == 1).map(|(face, _)| face).collect()
}
