//! Ties and contact pairs, with the properties of their surface interactions.

use std::collections::BTreeMap;

use zelus_core::diagnostics::{Diagnostic, Result};
use zelus_core::vector3::{add, cross, dot, norm, scale, sub};

use super::cards::Card;
use super::model::{Model, Statement};
use super::schedule::Times;
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
    stays: bool,
    is_rough: bool,
    soft: Vec<[f64; 2]>,
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
                        let own = all.entry(under_way.clone()).or_default();
                        (own.friction, own.is_rough) = (friction, card.get("ROUGH").is_some());
                    }
                }
                "SURFACE BEHAVIOR" => {
                    let own = all.entry(under_way.clone()).or_default();
                    own.is_tied = card.says("PRESSURE-OVERCLOSURE", "TIED");
                    own.stays = card.get("NO SEPARATION").is_some();
                    let soft = self.behavior(card);
                    own.soft = self.tolerate(soft).unwrap_or_default();
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
            // surfaces that neither open nor slide
            let tied = is_tie || law.is_tied || (law.stays && law.is_rough);
            let stays = law.stays && !tied;
            if stays && law.friction > 0.0 {
                let fact = "friction of surfaces with NO SEPARATION is left out: they slide freely";
                self.report.push(card.left_out(fact));
            }
            let friction = if stays { 0.0 } else { law.friction };
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
                let soft = if tied { Vec::new() } else { law.soft.clone() };
                model.mesh.pairs.push(Pair { tied, slave, master, friction, adjusted, stays, soft });
                Ok(())
            });
        }
        self.keep_soft(statements);
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

    /// Interference of two surfaces at the end of the step: the value of the amplitude there, which falls to 0 without one.
    pub(super) fn interference(&mut self, card: &Card, times: &Times) -> Result<()> {
        card.says("TYPE", "CONTACT PAIR");
        card.get("SHRINK");
        card.says("OP", "MOD");
        let end = match card.get("AMPLITUDE").map(str::to_ascii_uppercase) {
            None => 0.0,
            Some(name) => {
                let found = times.amplitudes.get(&name);
                let found = found.ok_or_else(|| card.wrong(format!("there is no *AMPLITUDE {name} that is known")))?;
                let step = times.steps.last().map_or((0.0, 1.0), |step| (step.start, step.end));
                found.table.at(if found.is_total { step.1 } else { step.1 - step.0 })
            }
        };
        self.each_row(card, &mut |model, row| {
            let slave = model.surface(card, row.get(0), row.line)?;
            let master = model.surface(card, row.get(1), row.line)?;
            let allowed = if row.get(2).is_empty() { 0.0 } else { card.number(row.get(2), row.line)? };
            let fact = if allowed * end == 0.0 {
                "*CONTACT INTERFERENCE: the overlap of the mesh presses in full from the first increment"
            } else {
                model.mesh.clearances.push(Clearance { slave, master, value: allowed * end });
                "*CONTACT INTERFERENCE: it acts in full from the first increment, whatever distance the mesh has"
            };
            model.report.push(Diagnostic::note("not-taken-over", fact).at(card.place_of(row.line)));
            Ok(())
        });
        Ok(())
    }

    /// Overclosures and pressures of soft contact; none of hard contact.
    fn behavior(&mut self, card: &Card) -> Result<Vec<[f64; 2]>> {
        card.is_read.set(true);
        card.says("PRESSURE-OVERCLOSURE", "HARD");
        if card.says("PRESSURE-OVERCLOSURE", "LINEAR") {
            let stiffness =
                card.rows.first().map(|row| card.numbers(row)).transpose()?.and_then(|own| own.first().copied());
            return Ok(stiffness.filter(|own| *own > 0.0).map(|own| vec![[0.0, 0.0], [1.0, own]]).unwrap_or_default());
        }
        if !card.says("PRESSURE-OVERCLOSURE", "TABULAR") {
            return Ok(Vec::new());
        }
        let mut rows = Vec::new();
        for row in &card.rows {
            let Some(&[pressure, depth]) = card.numbers(row)?.first_chunk::<2>() else {
                return Err(card.wrong_at(
                    row.line,
                    "a row of PRESSURE-OVERCLOSURE=TABULAR has a pressure and an overclosure".to_owned(),
                ));
            };
            rows.push([depth, pressure]);
        }
        Ok(rows)
    }

    /// Leaves soft contact out where a deck cannot have it: its pairs differ, or stand beside ties.
    fn keep_soft(&mut self, statements: &[Statement]) {
        let mut touching = self.mesh.pairs.iter().filter(|pair| !pair.tied);
        let first = touching.next().map(|pair| pair.soft.clone()).unwrap_or_default();
        let alike = touching.all(|pair| pair.soft == first);
        let is_alone = self.mesh.pairs.iter().all(|pair| !pair.tied && !pair.stays);
        let is_soft = self.mesh.pairs.iter().any(|pair| !pair.soft.is_empty());
        if !is_soft || alike && is_alone {
            return;
        }
        self.mesh.pairs.iter_mut().for_each(|pair| pair.soft.clear());
        let card = statements.iter().map(|own| &own.card).find(|card| card.keyword == "SURFACE BEHAVIOR");
        let why = if alike { "beside ties and NO SEPARATION" } else { "since pairs differ in it" };
        let fact = format!("the pressure by the overclosure is left out {why}: contact is hard here");
        let note = Diagnostic::note("not-taken-over", fact);
        self.report.push(card.map(|card| card.place()).into_iter().fold(note, Diagnostic::at));
    }
}

fn coefficient(card: &Card) -> Result<f64> {
    card.is_read.set(true);
    if card.get("ROUGH").is_some() {
        return Ok(ROUGH);
    }
    card.rows.first().map_or(Ok(0.0), |row| card.number(row.get(0), row.line))
}
