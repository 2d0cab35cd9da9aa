//! Pairs of a deck that have been in contact in a stage, and the report at its end of those that never were.

use std::collections::BTreeSet;

use serde::{Deserialize, Serialize};
use zelus_core::diagnostics::{Diagnostic, coordinates, counted};
use zelus_core::model::ModelPart;
use zelus_core::vector3::{norm, sub};

use crate::interface::{Interface, Roles, SlaveIndex};
use crate::results::{PartsOfPairs, name};
use crate::search::{Bounds, Tree};
use crate::slave_nodes::SlaveStates;
use crate::variables::NODAL_H;

/// Interfaces that have been in contact.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct InterfacesInContact {
    /// Interfaces of which a node was in contact.
    met: BTreeSet<usize>,
    /// Steps in which contact acted.
    steps: usize,
}

impl InterfacesInContact {
    /// A step is accepted in which contact acts.
    ///
    /// `slaves` are the slave nodes of each interface.
    pub(crate) fn accept(&mut self, slaves: &[Vec<SlaveIndex>], states: &SlaveStates) {
        self.steps += 1;
        for (at, slaves) in slaves.iter().enumerate() {
            if !self.met.contains(&at) && slaves.iter().any(|&slave| states[slave].law.active) {
                self.met.insert(at);
            }
        }
    }

    /// The warnings of pairs that never met.
    pub(crate) fn warnings(
        &self,
        part: &ModelPart,
        interfaces: &[Interface],
        parts: PartsOfPairs<'_>,
    ) -> Vec<Diagnostic> {
        let missed =
            interfaces.iter().enumerate().filter(|(at, of)| self.steps > 0 && !of.open && !self.met.contains(at));
        missed.filter_map(|(_, interface)| self.warning(part, interface, parts)).collect()
    }

    fn warning(&self, part: &ModelPart, interface: &Interface, parts: PartsOfPairs<'_>) -> Option<Diagnostic> {
        let [slaves, masters] = [Roles::Slave, Roles::Master].map(|role| interface.nodes_of(role));
        let place = |node: u32| part.nodes.current[node as usize];
        let tree = Tree::new(masters.iter().map(|&node| Bounds::of(&[place(node)])).collect());
        let distance = |a: u32, b: u32| norm(sub(place(a), place(b)));
        let mut nearest = (*slaves.first()?, *masters.first()?);
        for &slave in &slaves {
            let bounds = Bounds::of(&[place(slave)]).grown(distance(nearest.0, nearest.1));
            for master in tree.meeting(&bounds).into_iter().map(|at| masters[at as usize]) {
                if distance(slave, master) < distance(nearest.0, nearest.1) {
                    nearest = (slave, master);
                }
            }
        }
        let [slave, master] = [nearest.0, nearest.1].map(|node| {
            format!("{} at {}", part.nodes.ids[node as usize], coordinates(part.nodes.initial[node as usize]))
        });
        let fact = format!(
            "contact pair {} never met in {}: its nearest nodes are {slave} and {master}, {:.3e} apart at the end, where the mesh size is {:.3e}",
            name(&interface.key, parts),
            counted(self.steps, "step", "steps"),
            distance(nearest.0, nearest.1),
            part.nodes.values.values(&NODAL_H, 0)[nearest.0 as usize]
        );
        let remedy = "check that the pair names the faces that are to meet, and that loads or motions bring them together; take it out where they are not to meet";
        Some(Diagnostic::warning("never-met", fact).remedy(remedy))
    }
}
