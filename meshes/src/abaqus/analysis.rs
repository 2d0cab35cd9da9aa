//! Steps, amplitudes, supports, loads and temperatures.

use std::collections::BTreeMap;

use zelus_core::diagnostics::Result;

use super::cards::{Card, Row};
use super::couplings::SpecialNodes;
use super::model::{Model, Statement};
use super::schedule::{Amplitude, Entry, Schedule, Times};
use super::sets::Kind;
use crate::conditions::{Prescribed, Support};
use crate::faces::FaceCells;
use crate::history::History;
use crate::mesh::Step;

/// Displacement components of a node; its rotations follow.
pub(super) const DIRECTIONS: usize = 3;

/// Nodes of a support or temperature: a set, or a single node.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Target {
    Group(String),
    Node(u32),
}

/// Contents of the cards of the steps, before they are sorted into groups.
pub(super) struct Analysis {
    pub times: Times,
    pub step: usize,
    pub special: SpecialNodes,
    /// Nodes of supports with the number of their axes, in the order of the file.
    pub targets: Vec<(Target, Option<usize>)>,
    /// By number of the target and degree of freedom from 0.
    pub supports: Schedule<(usize, usize)>,
    /// Steps that lock a bolt.
    pub locked: BTreeMap<usize, usize>,
    /// By node and degree of freedom from 0.
    pub forces: Schedule<(u32, usize)>,
    /// By cell of a face.
    pub pressures: Schedule<u32>,
    pub tractions: Schedule<(u32, usize)>,
    pub accelerations: Schedule<(String, usize)>,
    /// By group and number of the axis.
    pub rotations: Schedule<(String, usize)>,
    pub axes_of_rotation: Vec<([f64; 3], [f64; 3])>,
    pub temperatures: Schedule<u32>,
    pub initial: BTreeMap<u32, f64>,
    /// Groups that loads name.
    pub named: Vec<String>,
}

impl Model {
    /// Reads the steps; sets, surfaces and materials are there.
    pub(super) fn read_analysis(&mut self, statements: &[Statement]) {
        let special = self.special_nodes(statements);
        self.read_discrete(statements, &special);
        let mut all = Analysis {
            times: Times::default(),
            step: 0,
            special,
            targets: Vec::new(),
            supports: Schedule::new(false),
            locked: BTreeMap::new(),
            forces: Schedule::new(true),
            pressures: Schedule::new(true),
            tractions: Schedule::new(true),
            accelerations: Schedule::new(true),
            rotations: Schedule::new(true),
            axes_of_rotation: Vec::new(),
            temperatures: Schedule::new(false),
            initial: BTreeMap::new(),
            named: Vec::new(),
        };
        let mut made = FaceCells::new(&self.mesh);
        for Statement { card, scope, .. } in statements {
            let read = match card.keyword.as_str() {
                "AMPLITUDE" => all.amplitude(card),
                "STEP" => {
                    self.step(card, &mut all);
                    Ok(())
                }
                "STATIC" | "VISCO" => all.procedure(card),
                "BOUNDARY" => self.boundary(card, scope, &mut all),
                "CLOAD" => self.forces(card, scope, &mut all),
                "DLOAD" | "DSLOAD" => self.distributed(card, scope, &mut all, &mut made),
                "CONTACT INTERFERENCE" => self.interference(card, &all.times),
                "TEMPERATURE" | "INITIAL CONDITIONS" => self.temperatures(card, scope, &mut all),
                _ => Ok(()),
            };
            self.tolerate(read);
        }
        self.mesh.steps = all.times.steps.clone();
        self.keep_supports(&all);
        self.keep_forces(&all);
        self.keep_faces(&all);
        self.keep_temperatures(&all);
        self.hold_unused_freedoms();
    }

    /// Holds displacements and rotations of a reference node that no coupled component follows.
    fn hold_unused_freedoms(&mut self) {
        let mut held = Vec::new();
        for coupling in self.mesh.couplings.iter().filter(|own| own.is_rigid && own.components != [true; DIRECTIONS]) {
            let [x, y, z] = coupling.components;
            let unused =
                [(Prescribed::Displacement, [!x, !y, !z]), (Prescribed::Rotation, [!y && !z, !x && !z, !x && !y])];
            for (quantity, free) in unused {
                let own = |support: &&Support| support.group == coupling.reference && support.quantity == quantity;
                let is_given = |at: usize| self.mesh.supports.iter().filter(own).any(|own| own.values[at].is_some());
                let values = [0, 1, 2].map(|at| (free[at] && !is_given(at)).then(History::default));
                if values.iter().any(Option::is_some) {
                    held.push(Support { quantity, ..Support::of(coupling.reference.clone(), values) });
                }
            }
        }
        self.mesh.supports.extend(held);
    }

    fn step(&mut self, card: &Card, all: &mut Analysis) {
        card.is_read.set(true);
        all.step += 1;
        let start = all.times.steps.last().map_or(0.0, |step| step.end);
        all.times.steps.push(Step { start, end: start + 1.0, increment: None });
        card.says("AMPLITUDE", "RAMP");
        if card.says("AMPLITUDE", "STEP") {
            all.times.instant.insert(all.step);
        }
        self.mesh.is_large |= card.get("NLGEOM").is_some_and(|given| !given.eq_ignore_ascii_case("no"));
    }

    /// The amplitude that a card names; `None` with a warning where it is not there.
    pub(super) fn amplitude_of(&mut self, card: &Card, all: &Analysis) -> Option<String> {
        let name = card.get("AMPLITUDE")?.to_ascii_uppercase();
        if all.times.amplitudes.contains_key(&name) {
            return Some(name);
        }
        let fact = format!("there is no *AMPLITUDE {name} that is known: the load grows linearly");
        self.report.push(card.left_out(fact));
        None
    }

    /// Nodes of a field: those of a set stay together unless one of them is special.
    fn targets(&self, card: &Card, row: &Row, scope: &str, special: &SpecialNodes) -> Result<Vec<Target>> {
        if let Some(node) = self.single_node(row.get(0), scope) {
            return Ok(vec![Target::Node(node)]);
        }
        let nodes = self.found(card, row.get(0), row.line, scope, Kind::Nodes)?;
        let first = nodes.first().and_then(|node| special.axes_of.get(node));
        let are_mixed = nodes.iter().any(|&node| special.is_apart(node) || special.axes_of.get(&node) != first);
        if are_mixed {
            return Ok(nodes.into_iter().map(Target::Node).collect());
        }
        let group = self.sets.find(Kind::Nodes, scope, row.get(0)).map(|set| set.group.clone());
        Ok(group.filter(|_| !nodes.is_empty()).into_iter().map(Target::Group).collect())
    }

    fn boundary(&mut self, card: &Card, scope: &str, all: &mut Analysis) -> Result<()> {
        let is_rate = card.says("TYPE", "VELOCITY");
        card.says("TYPE", "DISPLACEMENT");
        card.says("OP", "MOD");
        if card.says("OP", "NEW") {
            all.supports.renew(all.step);
        }
        let is_fixed = card.get("FIXED").is_some();
        let amplitude = self.amplitude_of(card, all);
        self.each_row(card, &mut |model, row| {
            let (first, last) = match row.get(1).to_ascii_uppercase().as_str() {
                "ENCASTRE" | "PINNED" => (vec![1, 2, 3, 4, 5, 6], None),
                "XSYMM" => (vec![1, 5, 6], None),
                "YSYMM" => (vec![2, 4, 6], None),
                "ZSYMM" => (vec![3, 4, 5], None),
                first => {
                    let first = card.freedom(first, row.line)?;
                    let last = if row.get(2).is_empty() { first } else { card.freedom(row.get(2), row.line)? };
                    ((first..=last.max(first)).collect(), Some(()))
                }
            };
            let is_plain = last.is_some();
            let value = if row.get(3).is_empty() { 0.0 } else { card.number(row.get(3), row.line)? };
            if is_plain && first.iter().all(|freedom| !(1..=2 * DIRECTIONS).contains(freedom)) {
                let fact = format!("{} holds no displacement or rotation", row.fields.join(", "));
                return Err(card.wrong_at(row.line, fact));
            }
            for target in model.targets(card, row, scope, &all.special)? {
                let axes = match &target {
                    Target::Node(node) => all.special.axes_of.get(node).copied(),
                    Target::Group(_) => {
                        let nodes = model.found(card, row.get(0), row.line, scope, Kind::Nodes)?;
                        nodes.first().and_then(|node| all.special.axes_of.get(node)).copied()
                    }
                };
                if let (Target::Node(node), true) = (&target, is_fixed)
                    && let Some(&bolt) = all.special.bolts.get(node)
                {
                    all.locked.insert(bolt, all.step);
                    continue;
                }
                if is_fixed {
                    return Err(card.wrong_at(row.line, "FIXED holds nodes where they are: this line"));
                }
                let known = all.targets.iter().position(|own| *own == (target.clone(), axes));
                let at = known.unwrap_or_else(|| {
                    all.targets.push((target.clone(), axes));
                    all.targets.len() - 1
                });
                for freedom in first.iter().filter(|freedom| (1..=2 * DIRECTIONS).contains(*freedom)) {
                    let entry = Entry { step: all.step, amplitude: amplitude.clone(), value, is_rate };
                    all.supports.add((at, freedom - 1), entry);
                }
            }
            Ok(())
        });
        Ok(())
    }

    fn forces(&mut self, card: &Card, scope: &str, all: &mut Analysis) -> Result<()> {
        card.says("OP", "MOD");
        if card.says("OP", "NEW") {
            all.forces.renew(all.step);
        }
        let amplitude = self.amplitude_of(card, all);
        self.each_row(card, &mut |model, row| {
            let freedom = card.freedom(row.get(1), row.line)?;
            if !(1..=2 * DIRECTIONS).contains(&freedom) {
                let fact = format!("degree of freedom {freedom} is no displacement or rotation");
                return Err(card.wrong_at(row.line, fact));
            }
            let value = card.number(row.get(2), row.line)?;
            let nodes = model.found(card, row.get(0), row.line, scope, Kind::Nodes)?;
            if let Some(set) = model.sets.find(Kind::Nodes, scope, row.get(0)) {
                all.named.push(set.group.clone());
            }
            if freedom > DIRECTIONS && nodes.iter().any(|&node| !all.special.is_apart(node)) {
                return Err(card.wrong_at(row.line, "a moment acts on nodes without rotations"));
            }
            for node in nodes {
                let entry = Entry { step: all.step, amplitude: amplitude.clone(), value, is_rate: false };
                all.forces.add((node, freedom - 1), entry);
            }
            Ok(())
        });
        Ok(())
    }

    fn temperatures(&mut self, card: &Card, scope: &str, all: &mut Analysis) -> Result<()> {
        let is_initial = card.keyword == "INITIAL CONDITIONS";
        if is_initial && !card.says("TYPE", "TEMPERATURE") {
            return Ok(());
        }
        card.says("OP", "MOD");
        let amplitude = self.amplitude_of(card, all);
        self.each_row(card, &mut |model, row| {
            let value = card.number(row.get(1), row.line)?;
            if let Some(set) = model.sets.find(Kind::Nodes, scope, row.get(0)) {
                all.named.push(set.group.clone());
            }
            for node in model.found(card, row.get(0), row.line, scope, Kind::Nodes)? {
                if is_initial {
                    all.initial.insert(node, value);
                }
                let step = if is_initial { 0 } else { all.step };
                all.temperatures.add(node, Entry { step, amplitude: amplitude.clone(), value, is_rate: false });
            }
            Ok(())
        });
        Ok(())
    }

    /// A name that no group has yet.
    pub(super) fn new_name(&self, stem: &str) -> String {
        let number = (1..).find(|number| self.mesh.group(&format!("{stem}_{number}")).is_none()).unwrap_or(1);
        format!("{stem}_{number}")
    }

    /// A group of these nodes: one of those named with the same, or a new one.
    pub(super) fn group_of_nodes(&mut self, mut nodes: Vec<u32>, stem: &str, named: &[String]) -> String {
        nodes.sort_unstable();
        nodes.dedup();
        let is_same =
            |name: &&String| self.mesh.group(name).is_some_and(|group| group.cells.is_empty() && group.nodes == nodes);
        if let Some(name) = named.iter().find(is_same) {
            return name.clone();
        }
        let single = match &nodes[..] {
            &[node] => format!("Node_{}", self.mesh.node_ids[node as usize]),
            _ => String::new(),
        };
        let is_free = !single.is_empty() && self.mesh.group(&single).is_none_or(|group| group.nodes == nodes);
        let name = if is_free { single } else { self.new_name(stem) };
        self.mesh.group_mut(&name).nodes = nodes;
        name
    }
}

impl Analysis {
    fn amplitude(&mut self, card: &Card) -> Result<()> {
        let name = card.require("NAME")?.to_ascii_uppercase();
        let is_table = card.get("DEFINITION").is_none_or(|kind| kind.eq_ignore_ascii_case("TABULAR"));
        if card.get("USER").is_some() || !is_table {
            return Err(card.wrong(format!("*AMPLITUDE {name} is no table")));
        }
        card.is_read.set(true);
        let shift = |name: &str| card.get(name).map_or(Ok(0.0), |field| card.number(field, card.place().line));
        let (along, up) = (shift("SHIFTX")?, shift("SHIFTY")?);
        card.says("TIME", "STEP TIME");
        card.says("VALUE", "RELATIVE");
        card.says("DEFINITION", "TABULAR");
        let numbers = card.all_numbers()?;
        let table: Vec<[f64; 2]> = numbers.chunks_exact(2).map(|two| [two[0] + along, two[1] + up]).collect();
        if table.is_empty() || table.windows(2).any(|two| two[1][0] < two[0][0]) {
            return Err(card.wrong(format!("*AMPLITUDE {name} has no times that grow")));
        }
        let (is_total, is_absolute) = (card.says("TIME", "TOTAL TIME"), card.says("VALUE", "ABSOLUTE"));
        self.times.amplitudes.insert(name, Amplitude { table: History::of(table), is_total, is_absolute });
        Ok(())
    }

    fn procedure(&mut self, card: &Card) -> Result<()> {
        card.is_read.set(true);
        let is_fixed = card.get("DIRECT").is_some();
        let Some(step) = self.times.steps.last_mut() else { return Err(card.wrong("there is no *STEP before it")) };
        let numbers = card.rows.first().map(|row| card.numbers(row)).transpose()?.unwrap_or_default();
        if let Some(&period) = numbers.get(1).filter(|period| **period > 0.0) {
            step.end = step.start + period;
        }
        step.increment = numbers.first().copied().filter(|given| is_fixed && *given > 0.0);
        Ok(())
    }
}
