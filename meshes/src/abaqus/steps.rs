//! Ties, contact, supports and loads.

use std::collections::BTreeMap;

use zelus_core::diagnostics::{Diagnostic, Result};

use super::cards::Card;
use super::model::{Model, group_name};
use crate::faces::FaceCells;
use crate::mesh::{Load, LoadKind, Pair, Support};

/// Contact pairs of the file, and loads on faces.
#[derive(Default)]
pub(super) struct Interactions {
    /// Coefficients of friction by surface interaction, in capitals.
    friction: BTreeMap<String, f64>,
    under_way: String,
    pairs: Vec<(Pair, String)>,
    /// Pressures on faces of elements: card, instance, set, face, value.
    pressures: Vec<(Card, String, String, String, f64)>,
}

impl Model {
    /// Reads a card that ties, lets touch, holds or loads; whether it is one.
    pub(super) fn interaction(&mut self, card: &Card, scope: &str) -> Result<bool> {
        match card.keyword.as_str() {
            "SURFACE INTERACTION" => self.interactions.under_way = card.require("NAME")?.to_ascii_uppercase(),
            "FRICTION" => {
                let coefficient = card.fields().next().map_or(Ok(0.0), |field| card.number(field))?;
                self.interactions.friction.insert(self.interactions.under_way.clone(), coefficient);
            }
            "TIE" | "CONTACT PAIR" => {
                let tied = card.keyword == "TIE";
                let law = card.get("INTERACTION").unwrap_or_default().to_ascii_uppercase();
                for line in &card.lines {
                    let name = |at: usize| line.get(at).map(|name| group_name("", name));
                    let Some(slave) = name(0) else { continue };
                    let master = name(1).filter(|name| !name.is_empty()).unwrap_or_else(|| slave.clone());
                    self.interactions.pairs.push((Pair { tied, slave, master, friction: 0.0 }, law.clone()));
                }
            }
            "BOUNDARY" | "CLOAD" | "DLOAD" | "DSLOAD" if self.step > 1 => {
                let fact =
                    format!("*{} of step {} is left out: a starter deck has the first step", card.keyword, self.step);
                self.report.push(Diagnostic::warning("not-taken-over", fact).at(card.place()));
            }
            "BOUNDARY" => self.boundary(card, scope)?,
            "CLOAD" => self.forces(card, scope)?,
            "DLOAD" | "DSLOAD" => self.pressures(card, scope)?,
            _ => return Ok(false),
        }
        Ok(true)
    }

    /// The group of a set or node, made where it is a single node.
    fn group_of(&mut self, card: &Card, field: &str, scope: &str) -> Result<String> {
        let nodes = self.found(card, field, scope, true)?;
        let is_label = field.rsplit('.').next().is_some_and(|last| last.parse::<u32>().is_ok());
        let name = group_name(scope, &if is_label { field.replace('.', ".Node_") } else { field.to_owned() });
        let name = if name.parse::<u32>().is_ok() { format!("Node_{name}") } else { name };
        self.mesh.group_mut(&name).nodes.extend(nodes);
        Ok(name)
    }

    fn boundary(&mut self, card: &Card, scope: &str) -> Result<()> {
        for line in &card.lines {
            let field = |at: usize| line.get(at).map(String::as_str).filter(|field| !field.is_empty());
            let held: [bool; 3] = match field(1).unwrap_or_default().to_ascii_uppercase().as_str() {
                "ENCASTRE" | "PINNED" => [true; 3],
                "XSYMM" => [true, false, false],
                "YSYMM" => [false, true, false],
                "ZSYMM" => [false, false, true],
                first => {
                    let first = card.label(first)?;
                    let last = field(2).map_or(Ok(first), |last| card.label(last))?;
                    [1, 2, 3].map(|direction| (first..=last.max(first)).contains(&direction))
                }
            };
            let value = field(3).map_or(Ok(0.0), |value| card.number(value))?;
            if held == [false; 3] {
                let fact = format!("*BOUNDARY holds {}, which is no displacement", line.join(", "));
                self.report.push(Diagnostic::warning("not-taken-over", fact).at(card.place()));
                continue;
            }
            let group = self.group_of(card, &line[0], scope)?;
            let all = &mut self.mesh.supports;
            let at = all.iter().position(|support| support.group == group).unwrap_or_else(|| {
                all.push(Support { group, values: [None; 3] });
                all.len() - 1
            });
            all[at].values.iter_mut().zip(held).filter(|(_, held)| *held).for_each(|(to, _)| *to = Some(value));
        }
        Ok(())
    }

    fn forces(&mut self, card: &Card, scope: &str) -> Result<()> {
        for line in &card.lines {
            let [name, direction, value] = &line[..] else {
                return Err(card.wrong("a force is a node or set, a direction and a value"));
            };
            let mut force = [0.0; 3];
            let direction = card.label(direction)? as usize;
            if let Some(to) = direction.checked_sub(1).and_then(|at| force.get_mut(at)) {
                *to = card.number(value)?;
                let group = self.group_of(card, name, scope)?;
                self.mesh.loads.push(Load { group, kind: LoadKind::Force(force) });
            } else {
                let fact = format!("*CLOAD acts on degree of freedom {direction}, which is no displacement");
                self.report.push(Diagnostic::warning("not-taken-over", fact).at(card.place()));
            }
        }
        Ok(())
    }

    fn pressures(&mut self, card: &Card, scope: &str) -> Result<()> {
        for line in &card.lines {
            let [name, kind, value, ..] = &line[..] else {
                return Err(card.wrong("a load is a set, a kind and a value"));
            };
            let is_pressure =
                kind.strip_prefix(['P', 'p']).is_some_and(|rest| rest.chars().all(|c| c.is_ascii_digit()));
            if !is_pressure {
                let fact = format!("*{} of kind {kind} is left out", card.keyword);
                self.report.push(Diagnostic::warning("not-taken-over", fact).at(card.place()));
            } else if card.keyword == "DSLOAD" {
                let kind = LoadKind::Pressure(card.number(value)?);
                self.mesh.loads.push(Load { group: group_name(scope, name), kind });
            } else {
                let value = card.number(value)?;
                self.interactions.pressures.push((card.clone(), scope.to_owned(), name.clone(), kind.clone(), value));
            }
        }
        Ok(())
    }

    /// Puts pairs and pressures into the mesh, once all surfaces are there.
    pub(super) fn make_interactions(&mut self) -> Result<()> {
        let Interactions { friction, pairs, pressures, .. } = std::mem::take(&mut self.interactions);
        for (mut pair, law) in pairs {
            pair.friction = friction.get(&law).copied().unwrap_or(0.0);
            if let Some(missing) = [&pair.slave, &pair.master].into_iter().find(|name| self.mesh.group(name).is_none())
            {
                let fact = format!("a pair names the surface {missing}, which is not there");
                self.report.push(Diagnostic::error("mesh-syntax", fact));
                continue;
            }
            self.mesh.pairs.push(pair);
        }
        let mut made = FaceCells::new(&self.mesh);
        for (card, scope, name, face, value) in pressures {
            let mut cells = Vec::new();
            for element in self.found(&card, &name, &scope, false)? {
                let number = self.face_of(&card, element, &face)?;
                cells.push(made.cell(&mut self.mesh, element as usize, number));
            }
            // all faces of a set under the same pressure are one group, whatever their numbers
            let same = |load: &&Load| load.kind == LoadKind::Pressure(value) && load.group.starts_with("Pressure_");
            let known = self.mesh.loads.iter().find(same).map(|load| load.group.clone());
            let group = known.unwrap_or_else(|| {
                let count = self.mesh.groups.iter().filter(|group| group.name.starts_with("Pressure_")).count();
                let group = format!("Pressure_{}", count + 1);
                self.mesh.loads.push(Load { group: group.clone(), kind: LoadKind::Pressure(value) });
                group
            });
            self.mesh.group_mut(&group).cells.extend(cells);
        }
        Ok(())
    }
}
