//! Faces of elements: which belong to whom, and which are boundary.

use rustc_hash::FxHashMap;
use zelus_core::geometry::Shape;

use super::mesh::Mesh;

/// The corners of a face or cell, sorted: its key, whatever its orientation and order.
pub type Corners = [u32; 8];

/// The key of the cell with these nodes, corners first.
pub fn corners(shape: Shape, nodes: &[u32]) -> Corners {
    let mut key = [u32::MAX; 8];
    let count = shape.cell().corners();
    key[..count].copy_from_slice(&nodes[..count]);
    key.sort_unstable();
    key
}

/// A face of an element.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Face {
    /// Index of the element.
    pub element: u32,
    /// Number of the face among those of its reference cell.
    pub number: usize,
    /// Whether another element has it too.
    pub is_inner: bool,
}

/// The faces of all cells of the mesh's dimension, by their corners.
pub fn faces(mesh: &Mesh) -> FxHashMap<Corners, Face> {
    let dimension = mesh.dimension();
    let mut out: FxHashMap<Corners, Face> = FxHashMap::default();
    for element in (0..mesh.cells.len()).filter(|&cell| mesh.cells.shapes[cell].dim() == dimension) {
        for number in 0..mesh.cells.shapes[element].cell().faces.len() {
            let (shape, nodes) = face_nodes(mesh, element, number);
            let face = Face { element: element as u32, number, is_inner: false };
            out.entry(corners(shape, &nodes)).and_modify(|first| first.is_inner = true).or_insert(face);
        }
    }
    out
}

/// Shape and nodes of a face of an element, outward.
pub fn face_nodes(mesh: &Mesh, element: usize, number: usize) -> (Shape, Vec<u32>) {
    let face = mesh.cells.shapes[element].cell().faces[number];
    let nodes = mesh.cells.nodes(element);
    (face.shape, face.nodes.iter().map(|&local| nodes[local]).collect())
}

/// Makes cells of faces, each face once, whoever asks for it.
pub struct FaceCells {
    of: FxHashMap<Corners, u32>,
    next: u32,
}

impl FaceCells {
    /// Faces that the mesh has already.
    pub fn new(mesh: &Mesh) -> Self {
        let all = 0..mesh.cells.len();
        let of = all.map(|cell| (corners(mesh.cells.shapes[cell], mesh.cells.nodes(cell)), cell as u32)).collect();
        Self { of, next: mesh.cells.max_id() + 1 }
    }

    /// The cell of a face of an element.
    pub fn cell(&mut self, mesh: &mut Mesh, element: usize, number: usize) -> u32 {
        let (shape, nodes) = face_nodes(mesh, element, number);
        *self.of.entry(corners(shape, &nodes)).or_insert_with(|| {
            self.next += 1;
            mesh.cells.push(self.next - 1, shape, nodes)
        })
    }
}
