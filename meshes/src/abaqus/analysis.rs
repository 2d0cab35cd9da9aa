//! Steps, amplitudes, supports, loads and temperatures.

use std::collections::BTreeMap;

use rustc_hash::FxHashMap;
use zelus_core::diagnostics::{Diagnostic, Result};
use zelus_core::vector3::scale;

use super::cards::{Card, Row};
use super::couplings::{SpecialNodes, direction_at};
use super::model::{Model, Statement};
use super::schedule::{Amplitude, Course, Entry, Schedule, Times};
use super::sets::Kind;
use crate::conditions::{Load, LoadKind, Prescribed, Support, Temperature};
use crate::faces::{FaceCells, corners, faces};
use crate::history::History;
use crate::mesh::{Mesh, Step};

/// Displacement components of a node; its rotations follow.
const DIRECTIONS: usize = 3;

/// Nodes of a support or temperature: a set, or a single node.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
enum Target {
    Group(String),
    Node(u32),
}

/// Contents of the cards of the steps, before they are sorted into groups.
struct Analysis {
    times: Times,
    step: usize,
    special: SpecialNodes,
    /// Nodes of supports with the number of their axes, in the order of the file.
    targets: Vec<(Target, Option<usize>)>,
    /// By number of the target and degree of freedom from 0.
    supports: Schedule<(usize, usize)>,
    /// Steps that lock a bolt.
    locked: BTreeMap<usize, usize>,
    /// By node and degree of freedom from 0.
    forces: Schedule<(u32, usize)>,
    /// By cell of a face.
    pressures: Schedule<u32>,
    tractions: Schedule<(u32, usize)>,
    accelerations: Schedule<(String, usize)>,
    /// By group and number of the axis.
    rotations: Schedule<(String, usize)>,
    axes_of_rotation: Vec<([f64; 3], [f64; 3])>,
    temperatures: Schedule<u32>,
    initial: BTreeMap<u32, f64>,
    /// Groups that loads name.
    named: Vec<String>,
}

impl Model {
    /// Reads the steps; sets, surfaces and materials are there.
    pub(super) fn read_analysis(&mut self, statements: &[Statement]) {
        let special = self.special_nodes(statements);
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
    fn amplitude_of(&mut self, card: &Card, all: &Analysis) -> Option<String> {
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

    fn distributed(&mut self, card: &Card, scope: &str, all: &mut Analysis, made: &mut FaceCells) -> Result<()> {
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
                    let group =
                        if row.get(0).is_empty() { String::new() } else { model.element_group(card, row, scope)? };
                    for i in (0..DIRECTIONS).filter(|&i| along[i] != 0.0) {
                        all.accelerations.add((group.clone(), i), entry(value * along[i]));
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
    fn new_name(&self, stem: &str) -> String {
        let number = (1..).find(|number| self.mesh.group(&format!("{stem}_{number}")).is_none()).unwrap_or(1);
        format!("{stem}_{number}")
    }

    /// A group of these nodes: one of those named with the same, or a new one.
    fn group_of_nodes(&mut self, mut nodes: Vec<u32>, stem: &str, named: &[String]) -> String {
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

    fn keep_supports(&mut self, all: &Analysis) {
        let courses = all.supports.courses(&all.times);
        // single nodes that are held alike are one group
        let mut single: BTreeMap<String, (Vec<u32>, Option<usize>, Vec<(usize, Course)>)> = BTreeMap::new();
        for (at, (target, axes)) in all.targets.iter().enumerate() {
            let own: Vec<(usize, Course)> =
                courses.iter().filter(|((of, _), _)| *of == at).map(|((_, i), course)| (*i, course.clone())).collect();
            match target {
                Target::Group(group) => self.keep_support(group, *axes, &own, all),
                Target::Node(node) if all.special.is_apart(*node) => self.keep_apart(*node, &own, all),
                Target::Node(node) => {
                    let kept = single.entry(format!("{axes:?}{own:?}")).or_insert((Vec::new(), *axes, own));
                    kept.0.push(*node);
                }
            }
        }
        let mut rest: Vec<_> = single.into_values().collect();
        rest.sort_by_key(|(nodes, ..)| nodes[0]);
        for (nodes, axes, own) in rest {
            let group = self.group_of_nodes(nodes, "Fixed", &[]);
            self.keep_support(&group, axes, &own, all);
        }
        for (bolt, step) in &all.locked {
            let until = step.checked_sub(2).and_then(|before| all.times.steps.get(before)).map(|step| step.end);
            self.mesh.bolts[*bolt].until = until;
        }
    }

    /// Supports of displacements of a group, one for each span of time.
    fn keep_support(&mut self, group: &str, axes: Option<usize>, courses: &[(usize, Course)], all: &Analysis) {
        for (direction, course) in courses.iter().filter(|(direction, _)| *direction < DIRECTIONS) {
            self.add_support(group, Prescribed::Displacement, *direction, course, axes, all);
        }
    }

    fn add_support(
        &mut self,
        group: &str,
        quantity: Prescribed,
        direction: usize,
        course: &Course,
        axes: Option<usize>,
        all: &Analysis,
    ) {
        let interval = (course.start, course.end);
        let axes = axes.map(|at| all.special.axes[at].clone());
        let supports = &mut self.mesh.supports;
        let is_same = |own: &Support| {
            own.group == group && own.quantity == quantity && own.interval == interval && own.axes == axes
        };
        let at = supports.iter().position(is_same).unwrap_or_else(|| {
            let values = [None, None, None];
            supports.push(Support { group: group.to_owned(), quantity, values, axes, interval });
            supports.len() - 1
        });
        supports[at].values[direction] = Some(course.value.clone());
    }

    /// Supports of a reference node, or the shortening of a bolt.
    fn keep_apart(&mut self, node: u32, courses: &[(usize, Course)], all: &Analysis) {
        if let Some(&bolt) = all.special.bolts.get(&node) {
            let along = courses.iter().find(|(direction, _)| *direction == 0);
            self.mesh.bolts[bolt].shortening = along.map(|(_, course)| course.value.clone());
            return;
        }
        let Some((reference, rotates)) = all.special.references.get(&node) else { return };
        for (direction, course) in courses {
            let is_rotation = *rotates || *direction >= DIRECTIONS;
            let quantity = if is_rotation { Prescribed::Rotation } else { Prescribed::Displacement };
            self.add_support(reference, quantity, direction % DIRECTIONS, course, None, all);
        }
    }

    fn keep_forces(&mut self, all: &Analysis) {
        let mut by_node: BTreeMap<u32, [History; 2 * DIRECTIONS]> = BTreeMap::new();
        for ((node, freedom), course) in all.forces.courses(&all.times) {
            by_node.entry(node).or_default()[freedom] = course.value;
        }
        let mut alike: BTreeMap<String, (Vec<u32>, [History; 3])> = BTreeMap::new();
        for (node, histories) in by_node {
            let [x, y, z, mx, my, mz] = histories;
            if let Some(&bolt) = all.special.bolts.get(&node) {
                self.mesh.bolts[bolt].force = Some(x);
                continue;
            }
            if let Some((reference, rotates)) = all.special.references.get(&node) {
                let (forces, moments) = if *rotates { ([mx, my, mz], [x, y, z]) } else { ([x, y, z], [mx, my, mz]) };
                for (kind, all) in [(0, forces), (1, moments)] {
                    if all.iter().any(|own| own.as_constant() != Some(0.0)) {
                        let kind = if kind == 0 { LoadKind::Force(all) } else { LoadKind::Moment(all) };
                        self.mesh.loads.push(Load { group: reference.clone(), kind });
                    }
                }
                continue;
            }
            let mut force = [x, y, z];
            if let Some(&axes) = all.special.axes_of.get(&node) {
                let axes = &all.special.axes[axes];
                let along = [0, 1, 2].map(|i| direction_at(axes, i, self.mesh.points[node as usize]));
                let component = |i: usize| {
                    let parts = along.iter().zip(&force).map(|(along, own)| own.scaled(along[i]));
                    parts.reduce(|sum, part| sum.plus(&part)).unwrap_or_default()
                };
                force = [component(0), component(1), component(2)];
            }
            let kept = alike.entry(format!("{force:?}")).or_insert((Vec::new(), force));
            kept.0.push(node);
        }
        let mut rest: Vec<_> = alike.into_values().collect();
        rest.sort_by_key(|(nodes, _)| nodes[0]);
        for (nodes, force) in rest {
            let group = self.group_of_nodes(nodes, "Forces", &all.named);
            self.mesh.loads.push(Load { group, kind: LoadKind::Force(force) });
        }
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

    fn keep_faces(&mut self, all: &Analysis) {
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

    fn keep_temperatures(&mut self, all: &Analysis) {
        let courses = all.temperatures.courses(&all.times);
        if courses.iter().all(|(_, course)| course.value.as_constant().is_some()) {
            // initial temperatures alone strain nothing
            return;
        }
        let mut initial = all.initial.values().copied();
        if let Some(first) = initial.next() {
            if initial.any(|value| value != first) {
                let fact = "initial temperatures differ: expansion begins at the first one";
                self.report.push(Diagnostic::warning("not-taken-over", fact));
            }
            let expansions = self.mesh.materials.iter_mut().filter_map(|own| own.expansion.as_mut());
            expansions.for_each(|own| own.reference = first);
        }
        let mut alike: BTreeMap<String, (Vec<u32>, History)> = BTreeMap::new();
        for (node, course) in courses {
            alike.entry(format!("{:?}", course.value)).or_insert((Vec::new(), course.value)).0.push(node);
        }
        for (nodes, value) in alike.into_values() {
            let group = self.group_of_nodes(nodes, "Temperature", &all.named);
            self.mesh.temperatures.push(Temperature { group, value });
        }
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
