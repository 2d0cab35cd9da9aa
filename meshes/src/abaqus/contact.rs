//! Ties and contact pairs, with the properties of their surface interactions.

use std::collections::BTreeMap;

use zelus_core::diagnostics::{Diagnostic, Result};
use zelus_core::vector3::{add, cross, dot, norm, scale, sub};

use super::cards::Card;
use super::model::{Model, Statement};
use super::sets::Kind;
use crate::conditions::{Clearance, Cyclic};
use crate::mesh::Pair;

/// Coefficient of friction that stands for no sliding at all.
const ROUGH: f64 = 1e9;

/// Properties of a surface interaction.
#[derive(Debug, Clone, Default)]
struct Interaction {
    friction: f64,
    is_tied: bool,
}

impl Model {
    /// Reads ties and contact pairs; surfaces have their groups.
    pub(super) fn read_contact(&mut self, statements: &[Statement]) {
        let mut all: BTreeMap<String, Interaction> = BTreeMap::new();
        let mut under_way = String::new();
        for Statement { card, .. } in statements {
            match card.keyword.as_str() {
                "SURFACE INTERACTION" => {
                    card.is_read.set(true);
                    under_way = card.get("NAME").unwrap_or_default().to_ascii_uppercase();
                    all.entry(under_way.clone()).or_default();
                }
                "FRICTION" => {
                    let friction = coefficient(card);
                    if card.rows.len() > 1 {
                        let fact = "*FRICTION: lines after the first are not read: the coefficient is one number";
                        self.report.push(card.left_out(fact));
                    }
                    if let Some(friction) = self.tolerate(friction) {
                        all.entry(under_way.clone()).or_default().friction = friction;
                    }
                }
                "SURFACE BEHAVIOR" => {
                    all.entry(under_way.clone()).or_default().is_tied = card.says("PRESSURE-OVERCLOSURE", "TIED");
                    self.behavior(card);
                }
                _ => {}
            }
        }
        for Statement { card, .. } in statements {
            let read = match card.keyword.as_str() {
                "CYCLIC SYMMETRY MODEL" => self.sector(card, statements),
                "CLEARANCE" => self.clearance(card),
                _ => Ok(()),
            };
            self.tolerate(read);
            // the model of the cyclic symmetry reads its tie
            let is_sector = card.parameters.iter().any(|own| own.name == "CYCLIC SYMMETRY");
            if is_sector {
                continue;
            }
            let is_tie = card.keyword == "TIE";
            if !is_tie && card.keyword != "CONTACT PAIR" {
                continue;
            }
            let name = card.get("INTERACTION").unwrap_or_default().to_ascii_uppercase();
            let law = all.get(&name).cloned().unwrap_or_default();
            let tied = is_tie || law.is_tied;
            let adjusted = !tied && card.get("ADJUST").is_some_and(|given| !given.eq_ignore_ascii_case("NO"));
            for sides in ["SURFACE TO SURFACE", "MORTAR", "LINMORTAR", "PGLINMORTAR"] {
                card.says("TYPE", sides);
            }
            if tied {
                // no strain arises from an initial gap, whether nodes are moved or not
                card.get("ADJUST");
            }
            self.each_row(card, &mut |model, row| {
                let slave = model.surface(card, row.get(0), row.line)?;
                let other = row.get(1);
                let master = if other.is_empty() { slave.clone() } else { model.surface(card, other, row.line)? };
                model.mesh.pairs.push(Pair { tied, slave, master, friction: law.friction, adjusted });
                Ok(())
            });
        }
    }

    /// Sides of a sector: those of the tie that the card names, around the axis of its two points.
    fn sector(&mut self, card: &Card, statements: &[Statement]) -> Result<()> {
        card.is_read.set(true);
        let count = card.number(card.require("N")?, card.place().line)?;
        let wanted = card.get("TIE").map(str::to_ascii_uppercase);
        let is_own = |tie: &Card| {
            let name = tie.parameters.iter().find(|own| own.name == "NAME").and_then(|_| tie.get("NAME"));
            let is_sector = tie.keyword == "TIE" && tie.parameters.iter().any(|own| own.name == "CYCLIC SYMMETRY");
            is_sector && wanted.as_ref().is_none_or(|wanted| name.is_some_and(|name| name.eq_ignore_ascii_case(wanted)))
        };
        let tie = statements.iter().map(|own| &own.card).find(|tie| is_own(tie));
        let tie = tie.ok_or_else(|| card.wrong("*CYCLIC SYMMETRY MODEL names no *TIE with CYCLIC SYMMETRY"))?;
        tie.is_read.set(true);
        tie.get("CYCLIC SYMMETRY");
        tie.get("POSITION TOLERANCE");
        card.get("NGRAPH");
        let row = tie.rows.first().ok_or_else(|| tie.wrong("*TIE has no surfaces"))?;
        let side = |name: &str| {
            let set = self.sets.find(Kind::Surface, "", name);
            set.map(|set| set.group.clone())
                .ok_or_else(|| tie.wrong_at(row.line, format!("there is no surface {name}")))
        };
        let (second, first) = (side(row.get(0))?, side(row.get(1))?);
        let Some(&[ax, ay, az, bx, by, bz]) = card.all_numbers()?.first_chunk::<6>() else {
            return Err(card.wrong("*CYCLIC SYMMETRY MODEL has two points of the axis: six numbers"));
        };
        let (origin, axis) = ([ax, ay, az], sub([bx, by, bz], [ax, ay, az]));
        if count < 1.0 || norm(axis) == 0.0 {
            return Err(card.wrong("*CYCLIC SYMMETRY MODEL has no sectors or no axis"));
        }
        let angle = 360.0 / count * self.sense(&first, &second, origin, axis);
        self.mesh.sectors.push(Cyclic { first, second, origin, axis, angle });
        Ok(())
    }

    /// 1 where the way from the first side to the second is one by the right-hand rule, otherwise −1.
    fn sense(&self, first: &str, second: &str, origin: [f64; 3], axis: [f64; 3]) -> f64 {
        let arm = |name: &str| {
            let group = self.mesh.group(name);
            let cells = group.into_iter().flat_map(|group| &group.cells);
            let of_cells = cells.flat_map(|&cell| self.mesh.cells.nodes(cell as usize));
            let nodes = group.into_iter().flat_map(|group| &group.nodes).chain(of_cells);
            let all: Vec<[f64; 3]> = nodes.map(|&node| sub(self.mesh.points[node as usize], origin)).collect();
            let sum = all.iter().fold([0.0; 3], |sum, point| add(sum, *point));
            scale(sum, 1.0 / all.len().max(1) as f64)
        };
        if dot(cross(arm(first), arm(second)), axis) < 0.0 { -1.0 } else { 1.0 }
    }

    fn clearance(&mut self, card: &Card) -> Result<()> {
        card.is_read.set(true);
        let line = card.place().line;
        let slave = self.surface(card, card.require("SLAVE")?, line)?;
        let master = self.surface(card, card.require("MASTER")?, line)?;
        let value = card.number(card.require("VALUE")?, line)?;
        self.mesh.clearances.push(Clearance { slave, master, value });
        Ok(())
    }

    fn behavior(&mut self, card: &Card) {
        card.is_read.set(true);
        card.says("PRESSURE-OVERCLOSURE", "HARD");
        if card.says("PRESSURE-OVERCLOSURE", "LINEAR") {
            let fact = "PRESSURE-OVERCLOSURE=LINEAR: contact is hard here, without the penetration of a stiffness";
            self.report.push(Diagnostic::note("not-taken-over", fact).at(card.place()));
        }
    }
}

fn coefficient(card: &Card) -> Result<f64> {
    card.is_read.set(true);
    if card.get("ROUGH").is_some() {
        return Ok(ROUGH);
    }
    card.rows.first().map_or(Ok(0.0), |row| card.number(row.get(0), row.line))
}
