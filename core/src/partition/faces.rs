//! Faces of elements: where two elements meet, and where a body ends.

use crate::geometry::Shape;
use crate::model::ModelPart;

/// Corners that no face has.
const NONE: u32 = u32::MAX;

/// A face of an element, known by its corner nodes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Face {
    /// Node indices, ascending, filled up with [`NONE`]: the same for both elements that share the face.
    key: [u32; 4],
    /// The element.
    pub(super) element: u32,
    /// Its number in the element's shape.
    number: u8,
    /// Its nodes, mid-side nodes included.
    pub(super) nodes: u8,
}

impl Face {
    /// Its corner nodes, ascending.
    pub(super) fn corners(&self) -> &[u32] {
        &self.key[..self.key.iter().position(|&node| node == NONE).unwrap_or(4)]
    }

    /// Its shape.
    pub(super) fn shape(&self, part: &ModelPart) -> Shape {
        shape_of(part, self.element).cell().faces[usize::from(self.number)].shape
    }

    /// All its nodes, mid-side nodes included.
    pub(super) fn all<'p>(&self, part: &'p ModelPart) -> impl Iterator<Item = u32> + use<'p> {
        let nodes = part.elements.nodes(self.element);
        shape_of(part, self.element).cell().faces[usize::from(self.number)].nodes.iter().map(|&at| nodes[at])
    }

    /// Its corner nodes in the order that shows their outward side.
    pub(super) fn ordered<'p>(&self, part: &'p ModelPart) -> impl Iterator<Item = u32> + 'p {
        let nodes = part.elements.nodes(self.element);
        let facet = shape_of(part, self.element).cell().faces[usize::from(self.number)];
        facet.nodes[..facet.shape.cell().corners()].iter().map(|&at| nodes[at])
    }
}

/// Shape of an element; kinds without a cell count as points.
pub(super) fn shape_of(part: &ModelPart, element: u32) -> Shape {
    part.elements.kinds[element as usize].cell.unwrap_or(Shape::Point1)
}

/// All faces of elements that are not lines or points, those on the same corners next to each other.
pub(super) fn faces(part: &ModelPart) -> Vec<Face> {
    let mut out = Vec::new();
    for element in 0..part.elements.len() as u32 {
        let cell = shape_of(part, element).cell();
        if cell.dim < 2 {
            continue;
        }
        let nodes = part.elements.nodes(element);
        for (number, facet) in cell.faces.iter().enumerate() {
            let mut key = [NONE; 4];
            for (slot, &at) in key.iter_mut().zip(&facet.nodes[..facet.shape.cell().corners()]) {
                *slot = nodes[at];
            }
            key.sort_unstable();
            out.push(Face { key, element, number: number as u8, nodes: facet.nodes.len() as u8 });
        }
    }
    out.sort_unstable();
    out
}

/// Faces that belong to one element only, and pairs of elements that share one with its number of nodes.
pub(super) fn outer_and_shared(faces: &[Face]) -> (Vec<Face>, Vec<(u32, u32, u32)>) {
    let (mut outer, mut shared) = (Vec::new(), Vec::new());
    for same in faces.chunk_by(|a, b| a.key == b.key) {
        match same {
            [one] => outer.push(*one),
            more => shared.extend(more.windows(2).map(|f| (f[0].element, f[1].element, u32::from(f[0].nodes)))),
        }
    }
    (outer, shared)
}
