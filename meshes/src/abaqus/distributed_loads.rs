//! Loads of faces and bodies: pressures, tractions, gravity and rotation.

use std::collections::BTreeMap;

use rustc_hash::FxHashMap;
use zelus_core::diagnostics::Result;
use zelus_core::vector3::scale;

use super::analysis::{Analysis, DIRECTIONS};
use super::cards::{Card, Row};
use super::model::Model;
use super::schedule::Entry;
use super::sets::Kind;
use crate::conditions::{Load, LoadKind};
use crate::faces::{FaceCells, corners, faces};
use crate::history::History;
use crate::mesh::Mesh;

impl Model {
    /// Pressures, tractions and accelerations of a card.
    pub(super) fn distributed(
        &mut self,
        card: &Card,
        scope: &str,
        all: &mut Analysis,
        made: &mut FaceCells,
    ) -> Result<()> {
        card.says("OP", "MOD");
        if card.says("OP", "NEW") {
            all.pressures.renew(all.step);
            all.tractions.renew(all.step);
            all.accelerations.renew(all.step);
            all.rotations.renew(all.step);
        }
        let amplitude = self.amplitude_of(card, all);
        let step = all.step;
        let entry = |value: f64| Entry { step, amplitude: amplitude.clone(), value, is_rate: false };
        card.says("CONSTANT RESULTANT", "NO");
        card.says("FOLLOWER", "NO");
        self.each_row(card, &mut |model, row| {
            let kind = row.get(1).to_ascii_uppercase();
            let numbers = row.fields.iter().skip(2).filter(|field| !field.is_empty());
            let numbers = numbers.map(|field| card.number(field, row.line)).collect::<Result<Vec<f64>>>()?;
            let value = *numbers.first().ok_or_else(|| card.wrong_at(row.line, "a load has no value"))?;
            let direction = |at: usize| match numbers[at..] {
                [x, y, z] => Ok([x, y, z]),
                _ => Err(card.wrong_at(row.line, "a load has no direction")),
            };
            let unit = |vector: [f64; 3]| {
                let size = vector.iter().map(|x| x * x).sum::<f64>().sqrt();
                if size > 0.0 { Ok(scale(vector, 1.0 / size)) } else { Err(card.wrong_at(row.line, "no direction")) }
            };
            let is_pressure = kind.strip_prefix('P').is_some_and(|rest| rest.chars().all(|c| c.is_ascii_digit()));
            let is_of_surface = card.keyword == "DSLOAD";
            match kind.as_str() {
                "GRAV" if !is_of_surface => {
                    let along = unit(direction(1)?)?;
                    let mut groups = model.references_of_masses(row, scope, &all.special);
                    groups.push(if row.get(0).is_empty() {
                        String::new()
                    } else {
                        model.element_group(card, row, scope)?
                    });
                    for i in (0..DIRECTIONS).filter(|&i| along[i] != 0.0) {
                        for group in &groups {
                            all.accelerations.add((group.clone(), i), entry(value * along[i]));
                        }
                    }
                }
                "CENTRIF" if !is_of_surface => {
                    let [x, y, z, ref along @ ..] = numbers[1..] else {
                        return Err(card.wrong_at(row.line, "a centrifugal load has no axis"));
                    };
                    let along = <[f64; 3]>::try_from(along.to_vec());
                    let axis = unit(along.map_err(|_| card.wrong_at(row.line, "an axis has no direction"))?)?;
                    let group =
                        if row.get(0).is_empty() { String::new() } else { model.element_group(card, row, scope)? };
                    let known = all.axes_of_rotation.iter().position(|own| *own == ([x, y, z], axis));
                    let at = known.unwrap_or(all.axes_of_rotation.len());
                    if known.is_none() {
                        all.axes_of_rotation.push(([x, y, z], axis));
                    }
                    all.rotations.add((group, at), entry(value));
                }
                "TRVEC" if is_of_surface => {
                    let along = unit(direction(1)?)?;
                    let cells = model.faces_of_surface(card, row, all)?;
                    for cell in cells {
                        for i in (0..DIRECTIONS).filter(|&i| along[i] != 0.0) {
                            all.tractions.add((cell, i), entry(value * along[i]));
                        }
                    }
                }
                _ if is_pressure && is_of_surface => {
                    for cell in model.faces_of_surface(card, row, all)? {
                        all.pressures.add(cell, entry(value));
                    }
                }
                _ if is_pressure => {
                    for element in model.found(card, row.get(0), row.line, scope, Kind::Elements)? {
                        let number = model.face_of(card, row.line, element, &kind)?;
                        let cell = made.cell(&mut model.mesh, element as usize, number);
                        all.pressures.add(cell, entry(value));
                    }
                }
                _ => return Err(card.wrong_at(row.line, format!("a load of kind {kind} is not known"))),
            }
            Ok(())
        });
        Ok(())
    }

    fn faces_of_surface(&self, card: &Card, row: &Row, all: &mut Analysis) -> Result<Vec<u32>> {
        let group = self.surface(card, row.get(0), row.line)?;
        let cells = self.mesh.group(&group).map(|group| group.cells.clone()).unwrap_or_default();
        all.named.push(group);
        Ok(cells)
    }

    /// The group of a set of elements.
    fn element_group(&self, card: &Card, row: &Row, scope: &str) -> Result<String> {
        let set = self.sets.find(Kind::Elements, scope, row.get(0));
        let missing = || card.wrong_at(row.line, format!("there is no set of elements {}", row.get(0)));
        Ok(set.ok_or_else(missing)?.group.clone())
    }

    /// A group of these faces: one of those named with the same, or a new one.
    fn group_of_faces(&mut self, mut cells: Vec<u32>, stem: &str, named: &[String]) -> String {
        cells.sort_unstable();
        let is_same = |name: &&String| self.mesh.group(name).is_some_and(|group| group.cells == cells);
        if let Some(name) = named.iter().find(is_same) {
            return name.clone();
        }
        let name = self.new_name(stem);
        self.mesh.group_mut(&name).cells = cells;
        name
    }

    /// Thickness of the planar body of each loaded face; bodies of different thickness need loads of their own per length.
    fn thickness_of_faces(&self) -> impl Fn(&Mesh, u32) -> f64 + use<> {
        let is_even = self.mesh.dimension() == 3 || self.mesh.sections.iter().all(|own| own.thickness == 1.0);
        let owners = if is_even { FxHashMap::default() } else { faces(&self.mesh) };
        let mut of_element: FxHashMap<u32, f64> = FxHashMap::default();
        for section in self.mesh.sections.iter().filter(|_| !is_even) {
            let cells = self.mesh.group(&section.group).map(|group| group.cells.as_slice()).unwrap_or_default();
            of_element.extend(cells.iter().map(|&cell| (cell, section.thickness)));
        }
        move |mesh, cell| {
            let key = corners(mesh.cells.shapes[cell as usize], mesh.cells.nodes(cell as usize));
            owners.get(&key).and_then(|face| of_element.get(&face.element)).copied().unwrap_or(1.0)
        }
    }

    /// Loads of faces and bodies.
    pub(super) fn keep_faces(&mut self, all: &Analysis) {
        let thickness = self.thickness_of_faces();
        let mut alike: BTreeMap<String, (Vec<u32>, History)> = BTreeMap::new();
        for (cell, course) in all.pressures.courses(&all.times) {
            let key = format!("{}{:?}", thickness(&self.mesh, cell), course.value);
            alike.entry(key).or_insert((Vec::new(), course.value)).0.push(cell);
        }
        let mut rest: Vec<_> = alike.into_values().collect();
        rest.sort_by_key(|(cells, _)| cells[0]);
        for (cells, value) in rest {
            let group = self.group_of_faces(cells, "Pressure", &all.named);
            self.mesh.loads.push(Load { group, kind: LoadKind::Pressure(value) });
        }
        let mut by_cell: BTreeMap<u32, [History; 3]> = BTreeMap::new();
        for ((cell, direction), course) in all.tractions.courses(&all.times) {
            by_cell.entry(cell).or_default()[direction] = course.value;
        }
        let mut alike: BTreeMap<String, (Vec<u32>, [History; 3])> = BTreeMap::new();
        for (cell, value) in by_cell {
            let key = format!("{}{value:?}", thickness(&self.mesh, cell));
            alike.entry(key).or_insert((Vec::new(), value)).0.push(cell);
        }
        for (cells, value) in alike.into_values() {
            let group = self.group_of_faces(cells, "Traction", &all.named);
            self.mesh.loads.push(Load { group, kind: LoadKind::Traction(value) });
        }
        let mut by_group: BTreeMap<String, [History; 3]> = BTreeMap::new();
        for ((group, direction), course) in all.accelerations.courses(&all.times) {
            by_group.entry(group).or_default()[direction] = course.value;
        }
        let loads = by_group.into_iter().map(|(group, value)| Load { group, kind: LoadKind::Acceleration(value) });
        self.mesh.loads.extend(loads);
        for ((group, at), course) in all.rotations.courses(&all.times) {
            let (origin, axis) = all.axes_of_rotation[at];
            self.mesh.loads.push(Load { group, kind: LoadKind::Centrifugal { square: course.value, origin, axis } });
        }
    }
}
