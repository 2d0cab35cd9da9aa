//! Supports, forces and temperatures over the steps, sorted into groups of nodes that have the same.

use std::collections::BTreeMap;

use zelus_core::diagnostics::Diagnostic;

use super::analysis::{Analysis, DIRECTIONS, Target};
use super::couplings::direction_at;
use super::model::Model;
use super::schedule::Course;
use crate::conditions::{Load, LoadKind, Prescribed, Support, Temperature};
use crate::history::History;

impl Model {
    /// Supports of groups and of single nodes, and the locks of bolts.
    pub(super) fn keep_supports(&mut self, all: &Analysis) {
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

    /// Forces of nodes that have the same.
    pub(super) fn keep_forces(&mut self, all: &Analysis) {
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

    /// Temperatures of nodes that have the same.
    pub(super) fn keep_temperatures(&mut self, all: &Analysis) {
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
