//! Springs and masses at nodes: elements SPRING1, SPRING2, SPRINGA, MASS and ROTARYI, and the cards of their constants.

use std::collections::BTreeMap;

use zelus_core::diagnostics::{Diagnostic, Place, Result};

use super::cards::{Card, Row};
use super::couplings::SpecialNodes;
use super::model::{Model, Statement};
use super::sets::Kind;
use crate::conditions::{Discrete, DiscreteKind};

/// Displacement components of a node.
const DIRECTIONS: usize = 3;

/// Types of the elements, and their number of nodes.
const TYPES: [(&str, usize); 5] = [("SPRING1", 1), ("SPRING2", 2), ("SPRINGA", 2), ("MASS", 1), ("ROTARYI", 1)];

/// An element at nodes before a card gives its constants.
#[derive(Debug, Clone)]
pub(super) struct DiscreteElement {
    label: u32,
    kind: &'static str,
    nodes: Vec<u32>,
    place: Place,
    /// Whether a card has given or refused its constants.
    is_known: bool,
}

impl Model {
    /// Reads the elements of a card where they are springs or masses; `None` of other types.
    pub(super) fn add_discrete(&mut self, card: &Card, scope: &str) -> Option<()> {
        let wanted = card.get("TYPE")?;
        let &(kind, count) = TYPES.iter().find(|(name, _)| name.eq_ignore_ascii_case(wanted))?;
        let mut added = Vec::new();
        self.each_row(card, &mut |model, row| {
            let label = card.label(row.get(0), row.line)?;
            let mut nodes = Vec::with_capacity(count);
            for at in 1..=count {
                let found = model.found(card, row.get(at), row.line, scope, Kind::Nodes)?;
                nodes.extend(found.first());
            }
            // sets may list it: it is no cell
            model.omitted.insert((scope.to_owned(), label));
            model.discrete_of.insert((scope.to_owned(), label), model.discrete.len() as u32);
            added.push(model.discrete.len() as u32);
            let place = card.place_of(row.line);
            model.discrete.push(DiscreteElement { label, kind, nodes, place, is_known: false });
            Ok(())
        });
        if let Some(set) = card.get("ELSET") {
            self.list_discrete(scope, set, added);
        }
        Some(())
    }

    /// Adds springs and masses to a set of elements, and their nodes: loads of the set act there.
    pub(super) fn list_discrete(&mut self, home: &str, name: &str, members: Vec<u32>) {
        if members.is_empty() {
            return;
        }
        let nodes: Vec<u32> = members.iter().flat_map(|&at| &self.discrete[at as usize].nodes).copied().collect();
        let set = self.sets.set_mut(Kind::Elements, home, name);
        set.nodes.extend(nodes);
        set.discrete.extend(members);
    }

    /// Springs and masses that a card lists.
    pub(super) fn listed_discrete(&self, card: &Card, scope: &str) -> Vec<u32> {
        let own = |label: u32| self.discrete_of.get(&(scope.to_owned(), label)).copied();
        let mut out = Vec::new();
        for row in &card.rows {
            let labels: Vec<Option<u32>> = row.fields.iter().map(|field| field.parse().ok()).collect();
            match (card.get("GENERATE").is_some(), labels.as_slice()) {
                (true, [Some(first), Some(last), rest @ ..]) => {
                    let by = rest.first().copied().flatten().unwrap_or(1).max(1);
                    out.extend((*first..=*last).step_by(by as usize).filter_map(own));
                }
                (true, _) => {}
                (false, _) => {
                    for (field, label) in row.fields.iter().zip(labels) {
                        let set = self.sets.find(Kind::Elements, scope, field).filter(|_| label.is_none());
                        out.extend(label.and_then(own));
                        out.extend(set.into_iter().flat_map(|set| &set.discrete));
                    }
                }
            }
        }
        out
    }

    /// Reads the constants of springs and masses.
    pub(super) fn read_discrete(&mut self, statements: &[Statement], special: &SpecialNodes) {
        for Statement { card, scope, .. } in statements {
            let read = match card.keyword.as_str() {
                "SPRING" => self.springs(card, scope, special),
                "MASS" => self.masses(card, scope, special),
                "ROTARY INERTIA" => self.inertias(card, scope, special),
                _ => Ok(()),
            };
            self.tolerate(read);
        }
        let mut without: BTreeMap<&str, &Place> = BTreeMap::new();
        for own in self.discrete.iter().filter(|own| !own.is_known) {
            without.entry(own.kind).or_insert(&own.place);
        }
        let warning = |(kind, place): (&str, &Place)| {
            let fact = format!("elements {kind} without constants are left out");
            Diagnostic::warning("not-taken-over", fact).at(place.clone())
        };
        let warnings: Vec<Diagnostic> = without.into_iter().map(warning).collect();
        warnings.into_iter().for_each(|warning| self.report.push(warning));
    }

    /// The elements of the set that a card names, all of these types; they count as known from now on.
    fn own_elements(&mut self, card: &Card, scope: &str, kinds: &[&str]) -> Result<Vec<DiscreteElement>> {
        card.is_read.set(true);
        let name = card.require("ELSET")?;
        let set = self.sets.find(Kind::Elements, scope, name).map(|set| set.discrete.clone()).unwrap_or_default();
        let mut out = Vec::with_capacity(set.len());
        for at in set {
            let own = &mut self.discrete[at as usize];
            own.is_known = true;
            out.push(own.clone());
        }
        match out.iter().find(|own| !kinds.contains(&own.kind)) {
            Some(other) => {
                Err(card.wrong(format!("*{}: element {} is of type {}", card.keyword, other.label, other.kind)))
            }
            None if out.is_empty() => Err(card.wrong(format!("*{}: {name} has no {}", card.keyword, kinds.join(", ")))),
            None => Ok(out),
        }
    }

    fn springs(&mut self, card: &Card, scope: &str, special: &SpecialNodes) -> Result<()> {
        let elements = self.own_elements(card, scope, &["SPRING1", "SPRING2", "SPRINGA"])?;
        if elements.iter().any(|own| own.kind != elements[0].kind) {
            return Err(card.wrong("*SPRING: the elements are of different types"));
        }
        if card.get("NONLINEAR").is_some() {
            return Err(card.wrong("*SPRING, NONLINEAR: springs here are linear: their table"));
        }
        let mut rows = card.rows.iter();
        let is_axial = elements[0].kind == "SPRINGA";
        let direction = match if is_axial { None } else { rows.next() } {
            Some(row) => {
                let first = card.freedom(row.get(0), row.line)?;
                let second = if row.get(1).is_empty() { first } else { card.freedom(row.get(1), row.line)? };
                if !(1..=DIRECTIONS).contains(&first) || !(1..=DIRECTIONS).contains(&second) {
                    return Err(card.wrong_at(row.line, "nodes have no rotations: springs against them"));
                }
                if first != second && elements[0].kind == "SPRING2" {
                    return Err(card.wrong_at(row.line, "springs between different directions"));
                }
                Some(first - 1)
            }
            None if is_axial => None,
            None => return Err(card.wrong("*SPRING has no degree of freedom")),
        };
        let row = rows.next().ok_or_else(|| card.wrong("*SPRING has no stiffness"))?;
        let stiffness = card.number(row.get(0), row.line)?;
        if rows.next().is_some() {
            let fact = "*SPRING: lines after the first stiffness are not read: it does not depend on the temperature";
            self.report.push(card.left_out(fact));
        }
        for own in elements {
            if own.nodes.iter().any(|&node| special.is_apart(node)) {
                let fact = format!("*SPRING: element {} is at a reference node and is left out", own.label);
                self.report.push(card.left_out(fact));
                continue;
            }
            let mut by_direction = [0.0; DIRECTIONS];
            direction.into_iter().for_each(|at| by_direction[at] = stiffness);
            let kind = match own.kind {
                "SPRING1" => DiscreteKind::Ground(by_direction),
                "SPRING2" => DiscreteKind::Between(by_direction),
                _ => DiscreteKind::Axial(stiffness),
            };
            self.mesh.discrete.push(Discrete { nodes: own.nodes, kind });
        }
        Ok(())
    }

    fn masses(&mut self, card: &Card, scope: &str, special: &SpecialNodes) -> Result<()> {
        let elements = self.own_elements(card, scope, &["MASS"])?;
        let row = card.rows.first().ok_or_else(|| card.wrong("*MASS has no mass"))?;
        let mass = card.number(row.get(0), row.line)?;
        if mass < 0.0 {
            return Err(card.wrong_at(row.line, format!("a mass of {mass} is negative")));
        }
        for own in elements {
            let node = own.nodes[0];
            if !special.is_apart(node) {
                self.mesh.discrete.push(Discrete { nodes: own.nodes, kind: DiscreteKind::Mass(mass) });
                continue;
            }
            match self.rigid_body_of(node, special) {
                Some(body) => self.mesh.couplings[body].mass += mass,
                None => {
                    let fact =
                        format!("*MASS: element {} is at a reference node of no rigid body and is left out", own.label);
                    self.report.push(card.left_out(fact));
                }
            }
        }
        Ok(())
    }

    fn inertias(&mut self, card: &Card, scope: &str, special: &SpecialNodes) -> Result<()> {
        let elements = self.own_elements(card, scope, &["ROTARYI"])?;
        let numbers = card.all_numbers()?;
        let given: [f64; 6] = std::array::from_fn(|at| numbers.get(at).copied().unwrap_or(0.0));
        let [xx, yy, zz, xy, xz, yz] = given;
        if numbers.is_empty() || numbers.len() > given.len() {
            return Err(card.wrong("*ROTARY INERTIA has up to six numbers"));
        }
        let inertia = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
        for own in elements {
            match self.rigid_body_of(own.nodes[0], special) {
                Some(body) => {
                    let all = self.mesh.couplings[body].inertia.get_or_insert([[0.0; DIRECTIONS]; DIRECTIONS]);
                    all.as_flattened_mut().iter_mut().zip(inertia.as_flattened()).for_each(|(to, own)| *to += own);
                }
                None => {
                    let fact = format!(
                        "*ROTARY INERTIA: element {} is at a node without rotations and is left out",
                        own.label
                    );
                    self.report.push(card.left_out(fact));
                }
            }
        }
        Ok(())
    }

    /// Parts of the reference nodes at which a set of elements has masses.
    pub(super) fn references_of_masses(&self, row: &Row, scope: &str, special: &SpecialNodes) -> Vec<String> {
        let set = self.sets.find(Kind::Elements, scope, row.get(0));
        let nodes = set.into_iter().flat_map(|set| &set.discrete).map(|&at| self.discrete[at as usize].nodes[0]);
        nodes.filter_map(|node| special.references.get(&node)).map(|(name, _)| name.clone()).collect()
    }

    /// The rigid coupling that moves with a reference node.
    fn rigid_body_of(&self, node: u32, special: &SpecialNodes) -> Option<usize> {
        let (reference, _) = special.references.get(&node)?;
        self.mesh.couplings.iter().position(|own| own.is_rigid && own.reference == *reference)
    }
}
