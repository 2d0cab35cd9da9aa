//! Surfaces: faces of elements, or the faces whose nodes are in a set.

use rustc_hash::FxHashSet;
use zelus_core::diagnostics::Result;

use super::abaqus_cells;
use super::cards::Card;
use super::model::{Model, Statement};
use super::sets::Kind;
use crate::faces::{Face, FaceCells, face_nodes, faces};

impl Model {
    /// Makes cells of the faces of all surfaces.
    pub(super) fn make_surfaces(&mut self, surfaces: &[&Statement]) {
        let mut boundary: Vec<Face> = faces(&self.mesh).into_values().filter(|face| !face.is_inner).collect();
        boundary.sort_unstable_by_key(|face| (face.element, face.number));
        let mut made = FaceCells::new(&self.mesh);
        for statement in surfaces {
            let (card, scope) = (&statement.card, &statement.scope);
            let Some(name) = self.tolerate(card.require("NAME")) else { continue };
            let is_of_nodes = card.says("TYPE", "NODE");
            card.says("TYPE", "ELEMENT");
            let mut found: Vec<(usize, usize)> = Vec::new();
            let mut nodes = Vec::new();
            self.each_row(card, &mut |model, row| {
                let (name, face) = (row.get(0), row.get(1));
                if is_of_nodes {
                    nodes.extend(model.found(card, name, row.line, scope, Kind::Nodes)?);
                    return Ok(());
                }
                let elements = model.found(card, name, row.line, scope, Kind::Elements)?;
                if face.is_empty() {
                    let all: FxHashSet<u32> = elements.into_iter().collect();
                    let own = boundary.iter().filter(|face| all.contains(&face.element));
                    found.extend(own.map(|face| (face.element as usize, face.number)));
                    return Ok(());
                }
                for element in elements {
                    found.push((element as usize, model.face_of(card, row.line, element, face)?));
                }
                Ok(())
            });
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
            let set = self.sets.set_mut(Kind::Surface, statement.home(), name);
            set.cells.extend(cells);
            set.nodes.extend(nodes);
        }
    }

    /// The number of the face that a file calls `S3` or `P3`.
    pub(super) fn face_of(&self, card: &Card, line: u32, element: u32, name: &str) -> Result<usize> {
        let shape = self.mesh.cells.shapes[element as usize];
        let number = name.trim_start_matches(['S', 's', 'P', 'p', 'E', 'e']).parse().ok();
        number.and_then(|number| abaqus_cells::face(shape, number)).ok_or_else(|| {
            let id = self.mesh.cells.ids[element as usize];
            card.wrong_at(line, format!("element {id} has no face {name:?}"))
        })
    }

    /// The group of a surface.
    pub(super) fn surface(&self, card: &Card, name: &str, line: u32) -> Result<String> {
        let found = self.sets.find(Kind::Surface, "", name).filter(|set| !set.cells.is_empty());
        let set = found.ok_or_else(|| card.wrong_at(line, format!("there is no surface {name} with faces")))?;
        Ok(set.group.clone())
    }
}
