//! Couplings to reference nodes, bolts and linear relations between nodes.

use std::collections::BTreeMap;

use rustc_hash::FxHashMap;
use zelus_core::diagnostics::Result;
use zelus_linear_algebra::Components;

use super::cards::Card;
use super::materials::axes_of;
use super::model::{Model, Statement};
use super::sets::Kind;
use crate::conditions::{Axes, Bolt, Coupling, Equation};

/// Displacement components of a node.
const DIRECTIONS: usize = 3;

/// Nodes whose unknowns are not plain displacements along the axes of the space.
#[derive(Debug, Default)]
pub(super) struct SpecialNodes {
    /// Axes by `*TRANSFORM`, and the number of those of a node.
    pub axes: Vec<Axes>,
    pub axes_of: FxHashMap<u32, usize>,
    /// Name of the reference node, and whether its displacements are the rotations of that one.
    pub references: BTreeMap<u32, (String, bool)>,
    /// Number of the bolt.
    pub bolts: BTreeMap<u32, usize>,
}

impl SpecialNodes {
    /// Whether loads and supports of a node are not those of a node of the mesh.
    pub(super) fn is_apart(&self, node: u32) -> bool {
        self.references.contains_key(&node) || self.bolts.contains_key(&node)
    }
}

impl Model {
    /// Reads couplings, rigid bodies, bolts, transformed nodes and equations.
    pub(super) fn special_nodes(&mut self, statements: &[Statement]) -> SpecialNodes {
        let mut out = SpecialNodes::default();
        for (at, statement) in statements.iter().enumerate() {
            let (card, scope) = (&statement.card, statement.scope.as_str());
            let read = match card.keyword.as_str() {
                "TRANSFORM" => self.transform(card, scope, &mut out),
                "COUPLING" => {
                    let next = statements.get(at + 1).map(|next| next.card.as_ref());
                    self.coupling(card, scope, next, &mut out)
                }
                "RIGID BODY" => self.rigid_body(card, scope, &mut out),
                "PRE-TENSION SECTION" => self.bolt(card, scope, &mut out),
                _ => Ok(()),
            };
            self.tolerate(read);
        }
        for Statement { card, scope, .. } in statements {
            let read = match card.keyword.as_str() {
                "EQUATION" => self.equations(card, scope, &out),
                "MPC" => {
                    self.pins(card, scope);
                    Ok(())
                }
                _ => Ok(()),
            };
            self.tolerate(read);
        }
        out
    }

    fn transform(&mut self, card: &Card, scope: &str, out: &mut SpecialNodes) -> Result<()> {
        card.is_read.set(true);
        let nodes = self.found(card, card.require("NSET")?, 0, scope, Kind::Nodes)?;
        card.says("TYPE", "R");
        let axes = axes_of(card, &card.all_numbers()?, card.says("TYPE", "C"))?;
        out.axes.push(axes);
        out.axes_of.extend(nodes.into_iter().map(|node| (node, out.axes.len() - 1)));
        Ok(())
    }

    /// The node of a parameter, and the name of its part.
    fn reference(&mut self, card: &Card, scope: &str, parameter: &str) -> Result<(u32, String)> {
        let found = self.found(card, card.require(parameter)?, 0, scope, Kind::Nodes)?;
        let &[node] = &found[..] else { return Err(card.wrong(format!("{parameter} is one node"))) };
        let name = format!("Reference_{}", self.mesh.node_ids[node as usize]);
        Ok((node, name))
    }

    fn coupling(&mut self, card: &Card, scope: &str, next: Option<&Card>, out: &mut SpecialNodes) -> Result<()> {
        card.is_read.set(true);
        let (node, reference) = self.reference(card, scope, "REF NODE")?;
        card.get("CONSTRAINT NAME");
        let group = self.surface(card, card.require("SURFACE")?, card.place().line)?;
        let kind = next.filter(|next| matches!(next.keyword.as_str(), "KINEMATIC" | "DISTRIBUTING"));
        let kind = kind.ok_or_else(|| card.wrong("*COUPLING without *KINEMATIC or *DISTRIBUTING below it"))?;
        kind.is_read.set(true);
        let is_rigid = kind.keyword == "KINEMATIC";
        let mut components = [!is_rigid || kind.rows.is_empty(); DIRECTIONS];
        for row in &kind.rows {
            let first = kind.freedom(row.get(0), row.line)?;
            let last = if row.get(1).is_empty() { first } else { kind.freedom(row.get(1), row.line)? };
            (0..DIRECTIONS).filter(|at| (first..=last).contains(&(at + 1))).for_each(|at| components[at] = true);
        }
        let point = self.mesh.points[node as usize];
        let (mass, inertia) = (0.0, None);
        self.mesh.couplings.push(Coupling {
            group,
            reference: reference.clone(),
            point,
            is_rigid,
            components,
            mass,
            inertia,
        });
        out.references.insert(node, (reference, false));
        Ok(())
    }

    fn rigid_body(&mut self, card: &Card, scope: &str, out: &mut SpecialNodes) -> Result<()> {
        card.is_read.set(true);
        let (node, reference) = self.reference(card, scope, "REF NODE")?;
        let (kind, name) = match card.get("NSET") {
            Some(name) => (Kind::Nodes, name),
            None => (Kind::Elements, card.require("ELSET")?),
        };
        let set = self.sets.find(kind, scope, name).map(|set| set.group.clone());
        let group = set.ok_or_else(|| card.wrong(format!("there is no set {name}")))?;
        let point = self.mesh.points[node as usize];
        let components = [true; DIRECTIONS];
        let (own, mass, inertia) = (reference.clone(), 0.0, None);
        self.mesh.couplings.push(Coupling { group, reference: own, point, is_rigid: true, components, mass, inertia });
        if card.get("ROT NODE").is_some() {
            let (rotation, _) = self.reference(card, scope, "ROT NODE")?;
            out.references.insert(rotation, (reference.clone(), true));
        }
        out.references.insert(node, (reference, false));
        Ok(())
    }

    fn bolt(&mut self, card: &Card, scope: &str, out: &mut SpecialNodes) -> Result<()> {
        card.is_read.set(true);
        let (node, _) = self.reference(card, scope, "NODE")?;
        let name = card.require("SURFACE")?;
        let section = self.surface(card, name, card.place().line)?;
        // the body of the section: all elements that share nodes with each other, from its faces on
        let dimension = self.mesh.dimension();
        let components = Components::new(self.mesh.points.len());
        let is_element = |cell: &usize| self.mesh.cells.shapes[*cell].dim() == dimension;
        for cell in (0..self.mesh.cells.len()).filter(is_element) {
            self.mesh.cells.nodes(cell).windows(2).for_each(|two| components.join(two[0], two[1]));
        }
        let faces = self.mesh.group(&section).map(|group| group.cells.clone()).unwrap_or_default();
        let Some(&face) = faces.first() else { return Err(card.wrong(format!("the surface {name} has no faces"))) };
        let body = components.first(self.mesh.cells.nodes(face as usize)[0]);
        let is_own = |cell: &usize| components.first(self.mesh.cells.nodes(*cell)[0]) == body;
        let cells: Vec<u32> =
            (0..self.mesh.cells.len()).filter(is_element).filter(is_own).map(|cell| cell as u32).collect();
        let group = format!("Bolt_{}", self.mesh.bolts.len() + 1);
        self.mesh.group_mut(&group).cells = cells;
        out.bolts.insert(node, self.mesh.bolts.len());
        self.mesh.bolts.push(Bolt { group, section, force: None, shortening: None, until: None });
        Ok(())
    }

    fn equations(&mut self, card: &Card, scope: &str, special: &SpecialNodes) -> Result<()> {
        card.is_read.set(true);
        let fields: Vec<(&str, u32)> = card.fields().collect();
        let mut at = 0;
        while let Some(&(count, line)) = fields.get(at) {
            let count: usize =
                count.parse().map_err(|_| card.wrong_at(line, format!("{count:?} is no number of terms")))?;
            let is_held = count <= fields.len();
            let terms = fields.get(at + 1..at + 1 + 3 * count.min(fields.len())).filter(|_| is_held && count > 0);
            let terms = terms.ok_or_else(|| card.wrong_at(line, "an equation has too few terms"))?;
            at += 1 + 3 * count;
            let made = self.equation(card, scope, terms, special);
            self.tolerate(made);
        }
        Ok(())
    }

    /// One relation, or one for each node of the sets that it names.
    fn equation(&mut self, card: &Card, scope: &str, terms: &[(&str, u32)], special: &SpecialNodes) -> Result<()> {
        let mut parts = Vec::new();
        for term in terms.chunks(3) {
            let (direction, line) = term[1];
            let direction = card.freedom(direction, line)?;
            if !(1..=DIRECTIONS).contains(&direction) {
                return Err(card.wrong_at(line, format!("degree of freedom {direction} is no displacement")));
            }
            let nodes = self.found(card, term[0].0, line, scope, Kind::Nodes)?;
            if nodes.iter().any(|&node| special.is_apart(node)) {
                return Err(card.wrong_at(line, format!("{} is a reference node: this equation", term[0].0)));
            }
            parts.push((nodes, direction - 1, card.number(term[2].0, line)?));
        }
        let count = parts.iter().map(|(nodes, ..)| nodes.len()).max().unwrap_or(0);
        if parts.iter().any(|(nodes, ..)| nodes.len() != 1 && nodes.len() != count) {
            return Err(card.wrong("*EQUATION: its sets have different numbers of nodes"));
        }
        for at in 0..count {
            let mut all: Vec<(u32, usize, f64)> = Vec::new();
            for (nodes, direction, factor) in &parts {
                let node = nodes[if nodes.len() == 1 { 0 } else { at }];
                let Some(&axes) = special.axes_of.get(&node) else {
                    all.push((node, *direction, *factor));
                    continue;
                };
                let along = direction_at(&special.axes[axes], *direction, self.mesh.points[node as usize]);
                all.extend((0..DIRECTIONS).map(|i| (node, i, along[i] * factor)).filter(|term| term.2 != 0.0));
            }
            self.mesh.equations.push(Equation { terms: all });
        }
        Ok(())
    }

    /// Nodes that move together; other kinds of multi-point constraints are named.
    fn pins(&mut self, card: &Card, scope: &str) {
        self.each_row(card, &mut |model, row| {
            let kind = row.get(0).to_ascii_uppercase();
            if !matches!(kind.as_str(), "PIN" | "TIE") {
                return Err(card.wrong_at(row.line, format!("kind {kind} is not known")));
            }
            let mut nodes = [0; 2];
            for (at, node) in nodes.iter_mut().enumerate() {
                let found = model.found(card, row.get(at + 1), row.line, scope, Kind::Nodes)?;
                let &[one] = &found[..] else { return Err(card.wrong_at(row.line, "it joins two nodes")) };
                *node = one;
            }
            let equation = |i| Equation { terms: vec![(nodes[0], i, 1.0), (nodes[1], i, -1.0)] };
            model.mesh.equations.extend((0..DIRECTIONS).map(equation));
            Ok(())
        });
    }
}

/// The unit vector of a direction of axes at a point.
pub(super) fn direction_at(axes: &Axes, direction: usize, point: [f64; 3]) -> [f64; 3] {
    use zelus_core::vector3::{cross, dot, norm, scale, sub};
    match axes {
        Axes::Cartesian(all) => all[direction],
        Axes::Cylindrical { origin, axis } => {
            let arm = sub(point, *origin);
            let radial = sub(arm, scale(*axis, dot(arm, *axis)));
            let radial = if norm(radial) > 0.0 { scale(radial, 1.0 / norm(radial)) } else { radial };
            [radial, cross(*axis, radial), *axis][direction]
        }
    }
}
