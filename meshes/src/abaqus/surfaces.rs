//! Surfaces: faces of elements, or the faces whose nodes are in a set.

use rustc_hash::FxHashSet;
use zelus_core::diagnostics::Result;

use super::abaqus_cells;
use super::cards::Card;
use super::model::{Model, group_name};
use crate::faces::{Face, FaceCells, face_nodes, faces};

/// A surface to be made when all elements are there.
pub(super) struct Surface {
    card: Card,
    scope: String,
    /// Name of its group.
    pub name: String,
}

impl Model {
    pub(super) fn add_surface(&mut self, card: &Card, scope: &str) -> Result<()> {
        let name = group_name(scope, card.require("NAME")?);
        self.surfaces.push(Surface { card: card.clone(), scope: scope.to_owned(), name });
        Ok(())
    }

    /// Makes cells of the faces of all surfaces and puts them into groups.
    pub(super) fn make_surfaces(&mut self) -> Result<()> {
        let surfaces = std::mem::take(&mut self.surfaces);
        let mut boundary: Vec<Face> = faces(&self.mesh).into_values().filter(|face| !face.is_inner).collect();
        boundary.sort_unstable_by_key(|face| (face.element, face.number));
        let mut made = FaceCells::new(&self.mesh);
        for surface in &surfaces {
            let card = &surface.card;
            let is_of_nodes = card.get("TYPE").is_some_and(|kind| kind.eq_ignore_ascii_case("NODE"));
            let mut found: Vec<(usize, usize)> = Vec::new();
            let mut nodes = Vec::new();
            for line in &card.lines {
                let (name, face) = (line.first().map_or("", String::as_str), line.get(1).map_or("", String::as_str));
                if is_of_nodes {
                    nodes.extend(self.found(card, name, &surface.scope, true)?);
                    continue;
                }
                let elements = self.found(card, name, &surface.scope, false)?;
                if face.is_empty() {
                    let all: FxHashSet<u32> = elements.into_iter().collect();
                    let own = boundary.iter().filter(|face| all.contains(&face.element));
                    found.extend(own.map(|face| (face.element as usize, face.number)));
                    continue;
                }
                for element in elements {
                    found.push((element as usize, self.face_of(card, element, face)?));
                }
            }
            if is_of_nodes {
                let all: FxHashSet<u32> = nodes.iter().copied().collect();
                let is_within = |face: &&Face| {
                    let (_, nodes) = face_nodes(&self.mesh, face.element as usize, face.number);
                    nodes.iter().all(|node| all.contains(node))
                };
                found.extend(boundary.iter().filter(is_within).map(|face| (face.element as usize, face.number)));
            }
            let cells: Vec<u32> =
                found.into_iter().map(|(element, number)| made.cell(&mut self.mesh, element, number)).collect();
            let group = self.mesh.group_mut(&surface.name);
            group.cells.extend(cells);
            group.nodes.extend(nodes);
        }
        self.surfaces = surfaces;
        Ok(())
    }

    /// The number of the face that a file calls `S3` or `P3`.
    pub(super) fn face_of(&self, card: &Card, element: u32, name: &str) -> Result<usize> {
        let shape = self.mesh.cells.shapes[element as usize];
        let number = name.trim_start_matches(['S', 's', 'P', 'p', 'E', 'e']).parse().ok();
        number.and_then(|number| abaqus_cells::face(shape, number)).ok_or_else(|| {
            let id = self.mesh.cells.ids[element as usize];
            card.wrong(format!("*{}: element {id} has no face {name:?}", card.keyword))
        })
    }
}
