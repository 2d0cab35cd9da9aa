//! Ties and contact pairs, with the properties of their surface interactions.

use std::collections::BTreeMap;

use zelus_core::diagnostics::{Diagnostic, Result};

use super::cards::Card;
use super::model::{Model, Statement};
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
