//! Sets and surfaces by name, and the groups that they become.

use std::collections::BTreeMap;

use crate::mesh::{Group, Mesh, word};

/// Kinds of sets, each with names of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Kind {
    Nodes,
    Surface,
    Elements,
}

/// Members of a set.
#[derive(Debug, Clone, Default)]
pub(super) struct Set {
    /// The group, once all sets are there; before it the name as a word.
    pub group: String,
    pub nodes: Vec<u32>,
    pub cells: Vec<u32>,
    /// Springs and masses.
    pub discrete: Vec<u32>,
}

/// Kind, instance and name in capitals.
type Key = (Kind, String, String);

/// All sets; names are the same in any case.
#[derive(Debug, Default)]
pub(super) struct Sets {
    all: BTreeMap<Key, Set>,
    /// In the order of the file.
    order: Vec<Key>,
}

fn key(kind: Kind, scope: &str, name: &str) -> Key {
    (kind, scope.to_owned(), name.trim_matches('"').to_ascii_uppercase())
}

impl Sets {
    /// The set of an instance, or of the assembly where `scope` is empty; made where it is not there.
    pub(super) fn set_mut(&mut self, kind: Kind, scope: &str, name: &str) -> &mut Set {
        let key = key(kind, scope, name);
        let group = word(&if scope.is_empty() { name.to_owned() } else { format!("{scope}_{name}") });
        if !self.all.contains_key(&key) {
            self.order.push(key.clone());
        }
        self.all.entry(key).or_insert_with(|| Set { group, ..Set::default() })
    }

    /// The set that a name means within an instance: its own, that of the instance before a dot, or one of the assembly.
    pub(super) fn find(&self, kind: Kind, scope: &str, name: &str) -> Option<&Set> {
        let own = |scope: &str, name: &str| self.all.get(&key(kind, scope, name));
        let inner = || name.split_once('.').and_then(|(instance, name)| own(&instance.to_ascii_uppercase(), name));
        own(scope, name).or_else(inner).or_else(|| own("", name))
    }

    /// Makes a group of each set. Sets of different kinds with the same name are one group where they have the same nodes; otherwise
    /// names of surfaces and elements get an ending.
    pub(super) fn make_groups(&mut self, mesh: &mut Mesh) {
        let nodes_of = |mesh: &Mesh, set: &Set| {
            let mut all = set.nodes.clone();
            all.extend(set.cells.iter().flat_map(|&cell| mesh.cells.nodes(cell as usize)));
            all.sort_unstable();
            all.dedup();
            all
        };
        for kind in [Kind::Nodes, Kind::Surface, Kind::Elements] {
            for key in self.order.iter().filter(|key| key.0 == kind) {
                let set = self.all.get_mut(key).expect("each key of the order has a set");
                let ending = if kind == Kind::Surface { "Surface" } else { "Elements" };
                let mut name = set.group.clone();
                for attempt in 1.. {
                    let Some(known) = mesh.group(&name) else { break };
                    let known_set = Set { nodes: known.nodes.clone(), cells: known.cells.clone(), ..Set::default() };
                    let is_of_nodes = known.cells.is_empty() && kind != Kind::Nodes;
                    if is_of_nodes && nodes_of(mesh, &known_set) == nodes_of(mesh, set) {
                        break;
                    }
                    name = match (kind, attempt) {
                        (Kind::Nodes, _) => format!("{}_{}", set.group, attempt + 1),
                        (_, 1) => format!("{}_{ending}", set.group),
                        _ => format!("{}_{ending}_{attempt}", set.group),
                    };
                }
                set.group = name;
                if set.nodes.is_empty() && set.cells.is_empty() {
                    continue;
                }
                let group: &mut Group = mesh.group_mut(&set.group);
                group.nodes.extend(&set.nodes);
                group.cells.extend(&set.cells);
                for list in [&mut group.nodes, &mut group.cells] {
                    list.sort_unstable();
                    list.dedup();
                }
            }
        }
    }
}
