//! A model part: the mesh, its data, and its named sub parts. It knows nothing of the objects that compute on it.

use std::collections::BTreeMap;
use std::ops::Range;

use serde::{Deserialize, Serialize};

use super::constraint::MasterSlaveConstraint;
use super::entity_kind::EntityRole;
use super::entity_table::EntityTable;
use super::fields::Fields;
use super::geometries::Geometries;
use super::interface_surface::InterfaceSurface;
use super::mesh_share::{MeshShare, MeshSizes};
use super::nodes::Nodes;
use super::owner::Owner;
use super::process_info::ProcessInfo;
use super::properties::{Properties, PropertyValue};
use super::rigid_facet::RigidFacet;
use super::slave_nodes::SlaveNodes;
use super::sub_part::SubPart;
use super::table::Table;
use super::variable::ScalarVariable;
use crate::communication::Ranks;
use crate::diagnostics::{Diagnostic, Result, did_you_mean};

/// A root model part; sub parts select from it by index.
///
/// ```
/// use zelus_core::model::{ModelPart, Nodes, SubPart};
///
/// let mut part = ModelPart::new("Structure");
/// part.nodes = Nodes::new(vec![1, 7], vec![[0.0; 3], [2.0, 0.0, 0.0]]);
/// part.nodes.history.add_named("MOTION", 3);
/// part.tree.children.insert("Tip".to_owned(), SubPart { nodes: vec![1], ..SubPart::new("Tip") });
///
/// // Columns are flat: three numbers a node, in ascending order of the ids.
/// let tip = part.part("Structure.Tip")?.nodes[0] as usize;
/// part.nodes.history.field_mut("MOTION")?.levels[0][3 * tip] = 0.1;
/// assert_eq!(part.nodes.ids[tip], 7);
/// assert_eq!(part.nodes.history.level("MOTION", 0), [0.0, 0.0, 0.0, 0.1, 0.0, 0.0]);
/// # Ok::<(), zelus_core::Error>(())
/// ```
#[derive(Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct ModelPart {
    /// Name of the root, e.g. `Structure`.
    pub name: String,
    /// Nodes.
    pub nodes: Nodes,
    /// Slave nodes of interfaces: owners of unknowns beside the nodes.
    #[serde(default)]
    pub slave_nodes: SlaveNodes,
    /// Surfaces of the interfaces of the present stage, for results. They are made anew when a stage is initialised, and are in no
    /// saved run.
    #[serde(skip)]
    pub interface_surfaces: Vec<InterfaceSurface>,
    /// Facets of rigid shapes, by the index of their condition. As those surfaces, they are in no saved run.
    #[serde(skip)]
    pub rigid_facets: BTreeMap<u32, RigidFacet>,
    /// Elements as the mesh gives them.
    pub elements: EntityTable,
    /// Conditions as the mesh gives them.
    pub conditions: EntityTable,
    /// Cells that modelers may make elements and conditions of.
    pub geometries: Geometries,
    /// Properties by id.
    pub properties: BTreeMap<usize, Properties>,
    /// Tables by id.
    pub tables: BTreeMap<usize, Table>,
    /// Values stored on the part itself.
    pub data: BTreeMap<String, PropertyValue>,
    /// Time, counters, named values.
    pub info: ProcessInfo,
    /// The tree of sub parts; its root selects everything.
    pub tree: SubPart,
    /// Linear relations between unknowns.
    pub constraints: Vec<MasterSlaveConstraint>,
    /// The ranks that have this part, in whole or in shares.
    #[serde(skip)]
    pub ranks: Ranks,
    /// Share of this rank in a distributed mesh; `None` when this rank computes everything.
    pub share: Option<MeshShare>,
}

/// Nodes and slave nodes with all their values: the state that iterations change.
#[derive(Clone)]
pub struct NodalState {
    nodes: Nodes,
    slave_nodes: SlaveNodes,
}

impl ModelPart {
    /// An empty part.
    pub fn new(name: impl Into<String>) -> Self {
        let name = name.into();
        Self { tree: SubPart::new(name.clone()), name, ..Self::default() }
    }

    /// The sub part at a full dotted path (`Structure.Parts.Left`) or one relative to the root.
    ///
    /// # Errors
    /// Input error with the nearest names when there is none.
    pub fn part(&self, path: &str) -> Result<&SubPart> {
        self.tree.find(self.relative(path)).ok_or_else(|| self.no_part(path))
    }

    /// As [`ModelPart::part`], to change.
    ///
    /// # Errors
    /// As [`ModelPart::part`].
    pub fn part_mut(&mut self, path: &str) -> Result<&mut SubPart> {
        let relative = self.relative(path).to_owned();
        let problem = self.no_part(path);
        self.tree.find_mut(&relative).ok_or(problem)
    }

    /// The full path of the one part of this name, given without the root part, and the warning that says so.
    ///
    /// `None` where no part or several have it: below the root, or anywhere as decks of earlier versions name them.
    pub fn named_without_root(&self, name: &str) -> Option<(String, Diagnostic)> {
        let paths = self.tree.paths();
        let below =
            |path: &&String| path.strip_suffix(name).is_some_and(|above| above.is_empty() || above.ends_with('.'));
        let mut found = paths.iter().filter(below);
        let path = match paths.iter().find(|path| *path == name) {
            Some(path) => path,
            None => found.next().filter(|_| found.next().is_none())?,
        };
        let full = format!("{}.{path}", self.name);
        let fact = format!("the model part {name:?} is named without its root part; {full:?} is taken");
        let warning = Diagnostic::warning("old-deck", fact).remedy(format!("write \"{full}\""));
        Some((full, warning))
    }

    /// Changes the root of the tree and every sub part on the way down to `path`, which is changed last.
    pub fn along(&mut self, path: &str, mut change: impl FnMut(&mut SubPart)) {
        let relative = self.relative(path).to_owned();
        let mut names = relative.split('.');
        let mut at = Some(&mut self.tree);
        while let Some(part) = at {
            change(part);
            at = names.next().and_then(|name| part.children.get_mut(name));
        }
    }

    fn relative<'p>(&self, path: &'p str) -> &'p str {
        if path == self.name {
            return "";
        }
        path.strip_prefix(&self.name).and_then(|rest| rest.strip_prefix('.')).unwrap_or(path)
    }

    fn no_part(&self, path: &str) -> crate::diagnostics::Error {
        let known: Vec<String> = self.tree.paths();
        let full: Vec<String> = known.iter().map(|p| format!("{}.{p}", self.name)).collect();
        let remedy = did_you_mean(path, full.iter().map(String::as_str)).unwrap_or_else(|| {
            format!("the mesh has: {}", if full.is_empty() { "no sub parts".into() } else { full.join(", ") })
        });
        Diagnostic::error("unknown-model-part", format!("there is no model part {path:?}")).remedy(remedy).into()
    }

    /// Adds constraints, which get the ids after those there are; gives their places in [`ModelPart::constraints`].
    pub fn add_constraints(&mut self, new: impl IntoIterator<Item = MasterSlaveConstraint>) -> Range<usize> {
        let first = self.constraints.len();
        let next = self.constraints.iter().map(|constraint| constraint.id).max().unwrap_or(0) + 1;
        self.constraints.extend((next..).zip(new).map(|(id, constraint)| MasterSlaveConstraint { id, ..constraint }));
        let made = first..self.constraints.len();
        self.tree.constraints.extend(made.start as u32..made.end as u32);
        self.tree.normalise();
        made
    }

    /// Adds a copy of each of these nodes, which ascend, with their values and fixities; the copies join the sub parts of the originals.
    /// Gives the index of the first.
    ///
    /// # Panics
    /// When ranks share the part: they have no ids in common.
    pub fn add_copies_of_nodes(&mut self, originals: &[u32]) -> u32 {
        let (first, next) = (self.nodes.len() as u32, self.next_node_id());
        let mut copies = self.nodes.pick(originals);
        copies.ids = (next..next + originals.len()).collect();
        self.nodes.append(&copies);
        let copy_of = |node: u32| originals.binary_search(&node).ok().map(|at| first + at as u32);
        self.tree.add_nodes_beside(&copy_of);
        first
    }

    /// Adds a node without values to the root part; gives its index.
    ///
    /// # Panics
    /// As [`ModelPart::add_copies_of_nodes`].
    pub fn add_node(&mut self, position: [f64; 3]) -> u32 {
        let (at, id) = (self.nodes.len() as u32, self.next_node_id());
        self.nodes.append(&Nodes::new(vec![id], vec![position]));
        self.tree.nodes.push(at);
        at
    }

    fn next_node_id(&self) -> usize {
        assert!(self.share.is_none(), "ranks share {}: no node can be added", self.name);
        self.nodes.ids.last().map_or(1, |last| last + 1)
    }

    /// Whether this rank evaluates an entity between bodies with these nodes: who has the pairs of the last one does, which
    /// is one of the slave's.
    pub fn evaluates_pair(&self, nodes: &[u32]) -> bool {
        let rank = |share: &MeshShare| nodes.last().map_or(0, |&node| share.pairs[node as usize]);
        self.share.as_ref().is_none_or(|share| rank(share) as usize == self.ranks.rank())
    }

    /// Whether this rank owns a node with its unknowns.
    pub fn owns_node(&self, node: usize) -> bool {
        self.share.as_ref().is_none_or(|share| share.owns(node))
    }

    /// Whether this rank evaluates an entity of the elements or conditions.
    pub fn evaluates(&self, role: EntityRole, at: usize) -> bool {
        self.share.as_ref().is_none_or(|share| {
            let owners = if role == EntityRole::Element { &share.elements } else { &share.conditions };
            owners[at] as usize == self.ranks.rank()
        })
    }

    /// Whether this rank has every element at a node.
    pub fn has_all_at(&self, node: usize) -> bool {
        self.share.as_ref().is_none_or(|share| share.common[node])
    }

    /// Nodes, elements and conditions of the whole mesh, however many ranks share it.
    pub fn sizes(&self) -> MeshSizes {
        let own =
            || MeshSizes { nodes: self.nodes.len(), elements: self.elements.len(), conditions: self.conditions.len() };
        self.share.as_ref().map_or_else(own, |share| share.whole)
    }

    /// The part with these nodes and entities alone, ascending, and all constraints, whose nodes must be among them.
    #[must_use]
    pub fn kept(&self, nodes: &[u32], elements: &[u32], conditions: &[u32]) -> Self {
        let new = |kept: &[u32], count: usize| {
            let mut new = vec![u32::MAX; count];
            kept.iter().enumerate().for_each(|(at, &old)| new[old as usize] = at as u32);
            new
        };
        let new_nodes = new(nodes, self.nodes.len());
        let new_elements = new(elements, self.elements.len());
        let new_conditions = new(conditions, self.conditions.len());
        let mut tree = self.tree.clone();
        tree.renumber(&new_nodes, &new_elements, &new_conditions);
        let mut constraints = self.constraints.clone();
        for constraint in &mut constraints {
            constraint.slave.0 = new_nodes[constraint.slave.0 as usize];
            constraint.masters.iter_mut().for_each(|((node, _), _)| *node = new_nodes[*node as usize]);
        }
        Self {
            name: self.name.clone(),
            nodes: self.nodes.pick(nodes),
            slave_nodes: self.slave_nodes.kept(&new_nodes),
            interface_surfaces: Vec::new(),
            rigid_facets: BTreeMap::new(),
            elements: self.elements.pick(elements, &new_nodes),
            conditions: self.conditions.pick(conditions, &new_nodes),
            geometries: Geometries::default(),
            properties: self.properties.clone(),
            tables: self.tables.clone(),
            data: self.data.clone(),
            info: self.info.clone(),
            tree,
            constraints,
            ranks: self.ranks.clone(),
            share: None,
        }
    }

    /// Sets the number of time levels of nodes and slave nodes; new ones copy the oldest.
    pub fn set_levels(&mut self, levels: usize) {
        self.nodes.history.set_levels(levels);
        self.slave_nodes.history.set_levels(levels);
    }

    /// Mesh node at which an owner of unknowns stands.
    pub fn node_of(&self, owner: Owner) -> u32 {
        match owner {
            Owner::Node(node) => node,
            Owner::Slave(slave) => self.slave_nodes.mesh_node(slave),
        }
    }

    /// Value of an owner's variable at a time level (0 the present); `None` where there is no such column or level.
    pub fn value_of(&self, owner: Owner, variable: ScalarVariable, level: usize) -> Option<f64> {
        let (fields, index) = match owner {
            Owner::Node(node) => (&self.nodes.history, node),
            Owner::Slave(slave) => (&self.slave_nodes.history, slave),
        };
        fields.value(variable, index as usize, level)
    }

    /// Sets the value of an owner's variable at a time level, where its column has that level.
    pub fn set_value_of(&mut self, owner: Owner, variable: ScalarVariable, level: usize, value: f64) {
        let (fields, index): (&mut Fields, u32) = match owner {
            Owner::Node(node) => (&mut self.nodes.history, node),
            Owner::Slave(slave) => (&mut self.slave_nodes.history, slave),
        };
        fields.set_value(variable, index as usize, level, value);
    }

    /// Copy of all values of nodes and slave nodes.
    pub fn nodal_state(&self) -> NodalState {
        NodalState { nodes: self.nodes.clone(), slave_nodes: self.slave_nodes.clone() }
    }

    /// Puts back the values of nodes and slave nodes.
    pub fn restore(&mut self, state: NodalState) {
        (self.nodes, self.slave_nodes) = (state.nodes, state.slave_nodes);
    }

    /// A new time step: fields move back one level, time and step advance.
    pub fn clone_time_step(&mut self, time: f64) {
        self.nodes.history.advance();
        let levels = self.nodes.history.levels();
        if self.slave_nodes.history.levels() != levels {
            self.slave_nodes.history.set_levels(levels);
        }
        self.slave_nodes.history.advance();
        self.info.delta_time = time - self.info.time;
        self.info.time = time;
    }
}
