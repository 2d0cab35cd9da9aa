//! The whole mesh with fields on it, also where several ranks have shares of it: paths lead through any of them.

use zelus_core::geometry::Shape;
use zelus_core::model::ModelPart;

use super::mesh::Mesh;

/// Gathers the shares of ranks to a whole part. Nodes count by their place in the whole mesh.
pub struct WholeMesh {
    /// Nodes that this rank owns.
    pub own: Vec<u32>,
    /// Places of the nodes that each rank owns.
    places: Vec<Vec<f64>>,
    /// Elements that fill space, in the order of their ids.
    elements: Vec<(Shape, Vec<u32>)>,
}

impl WholeMesh {
    /// Whole of a part, whose nodes may move afterwards. Collective.
    pub fn of(part: &ModelPart) -> Self {
        let own: Vec<u32> =
            (0..part.nodes.len()).filter(|&node| part.owns_node(node)).map(|node| node as u32).collect();
        let mine: Vec<f64> = own.iter().map(|&node| Self::place(part, node) as f64).collect();
        Self { own, places: part.ranks.gather_numbers(&mine), elements: elements(part) }
    }

    /// The place of a node of this rank.
    pub fn place(part: &ModelPart, node: u32) -> usize {
        part.share.as_ref().map_or(node, |share| share.places[node as usize]) as usize
    }

    /// A field on the whole mesh, from its values at the own nodes of each rank, in their order. Collective.
    pub fn field<const C: usize>(&self, part: &ModelPart, own: &[[f64; C]]) -> Vec<[f64; C]> {
        let all = part.ranks.gather_numbers(own.as_flattened());
        let mut field = vec![[0.0; C]; self.places.iter().map(Vec::len).sum()];
        for (places, values) in self.places.iter().zip(&all) {
            for (place, value) in places.iter().zip(values.as_chunks().0) {
                field[*place as usize] = *value;
            }
        }
        field
    }

    /// The elements, where their nodes are now. Collective.
    pub fn mesh(&self, part: &ModelPart) -> Mesh<'_> {
        let current: Vec<[f64; 3]> = self.own.iter().map(|&node| part.nodes.current[node as usize]).collect();
        Mesh { positions: self.field(part, &current), elements: &self.elements }
    }
}

/// The elements of all ranks that fill space. Collective.
fn elements(part: &ModelPart) -> Vec<(Shape, Vec<u32>)> {
    let rank = part.ranks.rank() as u32;
    let is_own = |at: usize| part.share.as_ref().is_none_or(|share| share.elements[at] == rank);
    let mut own = Vec::new();
    for at in (0..part.elements.len()).filter(|&at| is_own(at)) {
        if part.elements.kinds[at].cell.is_none_or(|cell| cell.dim() != part.info.domain_size) {
            continue;
        }
        let nodes = part.elements.nodes(at as u32);
        own.extend([part.elements.ids[at] as f64, nodes.len() as f64]);
        own.extend(nodes.iter().map(|&node| WholeMesh::place(part, node) as f64));
    }
    let mut elements = Vec::new();
    for all in part.ranks.gather_numbers(&own) {
        let mut rest = all.as_slice();
        while let [id, count, more @ ..] = rest {
            let (nodes, after) = more.split_at(*count as usize);
            let shape = Shape::of(part.info.domain_size, nodes.len()).expect("the shape of an element");
            elements.push((*id as usize, shape, nodes.iter().map(|&place| place as u32).collect()));
            rest = after;
        }
    }
    elements.sort_by_key(|(id, ..)| *id);
    elements.into_iter().map(|(_, shape, nodes)| (shape, nodes)).collect()
}
