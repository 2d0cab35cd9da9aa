//! A block: all entities of one registered kind, with one computation behind one dispatch.

use std::any::Any;
use std::ops::Range;

use super::assumed_small::AssumedSmall;
use super::face_point::FacePoint;
use super::view::StepView;
use serde::{Deserialize, Serialize};
use zelus_linear_algebra::State;

use crate::diagnostics::{Diagnostic, Error, Result};
use crate::model::{EntityKind, EntityTable, ModelPart, Nodes, Owner, ScalarVariable};

/// The owner of a local unknown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LocalOwner {
    /// The mesh node at which it stands.
    Node,
    /// A slave node: its position in [`EntityBlock::slave_owners`].
    Slave(u8),
}

/// A row of a local system: which unknown of which local node or slave node.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LocalUnknown {
    /// Position of its mesh node in the entity's connectivity.
    pub node: u8,
    /// Its owner.
    pub owner: LocalOwner,
    /// The unknown.
    pub variable: ScalarVariable,
}

impl LocalUnknown {
    /// The unknown of a mesh node, by its position in the connectivity.
    pub const fn of_node(node: u8, variable: ScalarVariable) -> Self {
        Self { node, owner: LocalOwner::Node, variable }
    }

    /// The unknown of a slave node, by its position in [`EntityBlock::slave_owners`] and that of its mesh node.
    pub const fn of_slave(node: u8, slave: u8, variable: ScalarVariable) -> Self {
        Self { node, owner: LocalOwner::Slave(slave), variable }
    }

    /// One variable at each of the nodes.
    pub fn of_nodes<const NODES: usize>(variable: ScalarVariable) -> [Self; NODES] {
        std::array::from_fn(|node| Self::of_node(node as u8, variable))
    }

    /// The owner of this unknown in an entity with these nodes and slave nodes.
    pub fn owner_among(&self, nodes: &[u32], slaves: &[u32]) -> Owner {
        match self.owner {
            LocalOwner::Node => Owner::Node(nodes[usize::from(self.node)]),
            LocalOwner::Slave(at) => Owner::Slave(slaves[usize::from(at)]),
        }
    }
}

/// Behaviour of the tangent of a block, so that the framework can reuse a constant one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Tangent {
    /// None at all: the block only loads.
    Zero,
    /// The same in every iteration and step, symmetric; the internal force is tangent times unknowns.
    Constant,
    /// Depends on the state, symmetric.
    Symmetric,
    /// Depends on the state, not symmetric.
    Unsymmetric,
}

/// Requested parts of the local systems.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Request {
    /// The right-hand side only: external minus internal forces.
    Residual,
    /// Tangent (minus the derivative of the right-hand side) and right-hand side.
    Both,
    /// Only the external forces, e.g. body forces, of a block that has some apart ([`EntityBlock::has_external`]).
    External,
    /// Only minus the stored quantity, of a block that stores by its own equation ([`EntityBlock::has_storage`]).
    Storage,
}

/// Buffers for the local systems of a range of entities, one after another.
#[derive(Debug, Default)]
pub struct LocalSystems {
    /// Unknowns of one local system.
    pub size: usize,
    /// Rows of a tangent, see [`EntityBlock::equations`].
    rows: usize,
    /// `rows * size` numbers an entity, row by row; empty when no tangent is wanted.
    pub lhs: Vec<f64>,
    /// `size` numbers an entity.
    pub rhs: Vec<f64>,
}

impl LocalSystems {
    /// Zeroed buffers for `count` entities of `size` unknowns.
    pub fn reset(&mut self, count: usize, size: usize, request: Request) {
        self.reset_rows(count, [size, size], request);
    }

    /// Zeroed buffers for `count` entities whose tangents have so many rows and columns.
    pub fn reset_rows(&mut self, count: usize, [rows, size]: [usize; 2], request: Request) {
        (self.rows, self.size) = (rows, size);
        self.rhs.clear();
        self.rhs.resize(count * size, 0.0);
        self.lhs.clear();
        self.lhs.resize(if request == Request::Both { count * rows * size } else { 0 }, 0.0);
    }

    /// Tangent of the `at`-th entity of the range, empty when not wanted.
    pub fn lhs_of(&self, at: usize) -> &[f64] {
        let entries = self.rows * self.size;
        if self.lhs.is_empty() { &[] } else { &self.lhs[at * entries..(at + 1) * entries] }
    }

    /// Right-hand side of the `at`-th entity of the range.
    pub fn rhs_of(&self, at: usize) -> &[f64] {
        &self.rhs[at * self.size..(at + 1) * self.size]
    }

    /// Tangent (empty when not wanted) and right-hand side of the `at`-th entity of the range.
    pub fn entity(&mut self, at: usize) -> (&mut [f64], &mut [f64]) {
        let (n, entries) = (self.size, self.rows * self.size);
        let lhs = if self.lhs.is_empty() { &mut [][..] } else { &mut self.lhs[at * entries..(at + 1) * entries] };
        (lhs, &mut self.rhs[at * n..(at + 1) * n])
    }
}

/// Something wrong with one entity during computation.
#[derive(Debug, Clone, PartialEq)]
pub struct EntityError {
    /// Registered name of the kind.
    pub kind: &'static str,
    /// Id of the entity in the mesh.
    pub id: usize,
    /// Ids of its nodes.
    pub nodes: Vec<usize>,
    /// The fact.
    pub fact: String,
    /// The remedy.
    pub remedy: &'static str,
}

impl From<EntityError> for Error {
    fn from(e: EntityError) -> Self {
        let nodes: Vec<String> = e.nodes.iter().map(ToString::to_string).collect();
        let nodes = if nodes.is_empty() { String::new() } else { format!(" (nodes {})", nodes.join(" ")) };
        Diagnostic::error("entity", format!("{} {}{nodes}: {}", e.kind, e.id, e.fact)).remedy(e.remedy).into()
    }
}

/// Values at the Gauss points of one entity.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Gauss {
    /// Numbers a point.
    pub components: usize,
    /// `components` numbers a point.
    pub values: Vec<f64>,
    /// Integration weight times Jacobian of each point.
    pub weights: Vec<f64>,
    /// Shape functions, one row of nodes a point.
    pub shape: Vec<f64>,
}

/// Arguments from which a block is made.
pub struct BlockRequest<'a> {
    /// The registered kind.
    pub entry: &'static EntityKind,
    /// Indices of the entities in their table, ascending.
    pub members: Vec<u32>,
    /// The table, elements or conditions.
    pub table: &'a EntityTable,
    /// Nodes.
    pub nodes: &'a Nodes,
    /// The model part, for properties and step data.
    pub part: &'a ModelPart,
    /// Whether loads act on the initial configuration: they stand on bodies of small displacements.
    pub on_initial: bool,
}

/// All entities of one kind; writes the local systems of ranges of them.
///
/// Unknowns are rows in the same order for every entity. Local systems follow `tangent · Δ = residual`, the residual being
/// external minus internal forces and the tangent minus its derivative.
pub trait EntityBlock: Send + Sync {
    /// The registered kind.
    fn entry(&self) -> &'static EntityKind;

    /// Indices of the entities in the model part's table, in the order of the block; empty for pairs made by a search.
    fn members(&self) -> &[u32];

    /// Number of entities.
    fn len(&self) -> usize {
        self.members().len()
    }

    /// Whether there are none.
    fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Node indices of the `at`-th entity.
    fn nodes(&self, at: usize) -> &[u32];

    /// Indices of the slave nodes whose unknowns the `at`-th entity has, each at one of its mesh nodes. Blocks of interactions
    /// may have some; unknowns of elements and conditions are those of mesh nodes.
    fn slave_owners(&self, _at: usize) -> &[u32] {
        &[]
    }

    /// The rows of every local system.
    fn unknowns(&self) -> &[LocalUnknown];

    /// Number of unknowns, the first ones, in whose equations entities of the block have a part. The others have none: their rows are
    /// zero, and entities depend on them.
    fn equations(&self) -> usize {
        self.unknowns().len()
    }

    /// How the tangent behaves.
    fn tangent(&self) -> Tangent;

    /// Whether the `at`-th entity takes part now; an entity that does not contributes nothing.
    fn is_active(&self, at: usize, view: &StepView<'_>) -> bool;

    /// Once, before the first step: checks and prepares the entities.
    ///
    /// # Errors
    /// Every entity or property that cannot be computed with.
    fn initialize(&mut self, _view: &StepView<'_>) -> Result<()> {
        Ok(())
    }

    /// Writes the local systems of `range` into `out`, which is reset by the caller.
    ///
    /// # Errors
    /// The first entity that cannot be computed, e.g. an inverted element.
    fn local_systems(
        &self,
        view: &StepView<'_>,
        range: Range<usize>,
        request: Request,
        out: &mut LocalSystems,
    ) -> Result<(), EntityError>;

    /// Whether the block has external forces of its own in this step, and gives them apart ([`Request::External`]).
    fn has_external(&self, _view: &StepView<'_>) -> bool {
        false
    }

    /// Whether storage, as of heat, is part of the block's own equation, and it gives it apart ([`Request::Storage`]).
    fn has_storage(&self) -> bool {
        false
    }

    /// Writes the mass matrices of `range` into `out.lhs`; `false` when the kind has no mass.
    ///
    /// # Errors
    /// As [`EntityBlock::local_systems`].
    fn mass(
        &self,
        _view: &StepView<'_>,
        _range: Range<usize>,
        _lumped: bool,
        _out: &mut LocalSystems,
    ) -> Result<bool, EntityError> {
        Ok(false)
    }

    /// Whether the kind has a damping matrix of its own, beside Rayleigh's.
    fn has_damping(&self) -> bool {
        false
    }

    /// Writes the damping matrices of `range`, force per velocity, into `out.lhs`; they stay the same.
    fn damping(&self, _view: &StepView<'_>, _range: Range<usize>, _out: &mut LocalSystems) {}

    /// Whether the `at`-th entity has a history, as one that yields does.
    fn has_history(&self, _at: usize) -> bool {
        false
    }

    /// The step is accepted: history advances, once.
    ///
    /// # Errors
    /// As [`EntityBlock::local_systems`].
    fn finalize_step(&mut self, _view: &StepView<'_>) -> Result<(), EntityError> {
        Ok(())
    }

    /// State of its entities, for the file of a saved run.
    fn state(&self) -> Option<Box<dyn State>> {
        None
    }

    /// Restores the states of its entities from a saved run.
    ///
    /// # Errors
    /// The state of a block of other entities.
    fn resume(&mut self, _state: Box<dyn State>) -> Result<()> {
        Ok(())
    }

    /// Itself, for blocks of the next stage to look into; `None` when there is nothing to take over.
    fn as_any(&self) -> Option<&dyn Any> {
        None
    }

    /// Takes over the states of entities from an earlier stage's block, where it is of the same kind.
    fn inherit(&mut self, _earlier: &dyn EntityBlock) {}

    /// A variable at the Gauss points of the `at`-th entity; `None` when the kind does not know it.
    fn gauss(&self, _view: &StepView<'_>, _variable: &str, _at: usize) -> Option<Gauss> {
        None
    }

    /// Names that [`EntityBlock::gauss`] answers.
    fn gauss_variables(&self) -> &'static [&'static str] {
        &[]
    }

    /// Warnings about the choice of this kind for its entities, e.g. elements that lock with their material.
    fn warnings(&self) -> &[Diagnostic] {
        &[]
    }

    /// The number of the `at`-th entity that the theory of the kind takes to be small, in the present state; `None` where it takes none.
    fn assumed_small(&self, _view: &StepView<'_>, _at: usize) -> Option<AssumedSmall> {
        None
    }

    /// Reason why the `at`-th entity cannot give the traction on its faces; `None` where [`EntityBlock::traction`] does.
    fn lacks_tractions(&self, _view: &StepView<'_>, _at: usize) -> Option<&'static str> {
        Some(NO_TRACTIONS)
    }

    /// The traction P·N on a face of the `at`-th entity whose nodes have these displacements (force per initial area, in the
    /// plane times the thickness), and its derivative by each unknown of the block, where `by` is given.
    ///
    /// P is the first Piola–Kirchhoff stress of the entity's own law, the stress itself for small displacements: the traction
    /// that its nodal forces stand for.
    ///
    /// # Errors
    /// An entity that has none, or is inverted.
    fn traction(
        &self,
        _view: &StepView<'_>,
        _at: usize,
        _point: &FacePoint,
        _displacements: &[[f64; 3]],
        _by: Option<&mut [[f64; 3]]>,
    ) -> Result<[f64; 3], EntityError> {
        let (kind, nodes) = (self.entry().name, Vec::new());
        Err(EntityError {
            kind,
            id: 0,
            nodes,
            fact: NO_TRACTIONS.to_owned(),
            remedy: "take another contact formulation",
        })
    }
}

/// Message of entities without tractions.
pub(super) const NO_TRACTIONS: &str = "its stress is not stated as a function of the displacements of its nodes";
