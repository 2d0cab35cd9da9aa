//! The mathematics of one entity, and the block that runs it over many.

use std::any::Any;
use std::collections::HashMap;
use std::ops::Range;

use serde::Serialize;
use serde::de::DeserializeOwned;
use zelus_linear_algebra::{State, parallel};

use super::assumed_small::AssumedSmall;
use super::block::{
    BlockRequest, EntityBlock, EntityError, Gauss, LocalSystems, LocalUnknown, NO_TRACTIONS, Request, Tangent,
};
use super::block_state::BlockState;
use super::face_point::FacePoint;
use super::together::together;
use super::view::StepView;
use crate::diagnostics::{Diagnostic, Report, Result, unfit};
use crate::model::{EntityKind, EntityRole, Properties};

/// Data of its entity that a kernel gets, beside the step's fields.
#[derive(Clone, Copy)]
pub struct EntityView<'a, const NODES: usize> {
    /// Index of the entity in the model part's table.
    pub index: u32,
    /// Node indices.
    pub nodes: &'a [u32; NODES],
    /// Its properties.
    pub properties: &'a Properties,
    /// Initial positions.
    pub initial: [[f64; 3]; NODES],
    /// Present positions.
    pub current: [[f64; 3]; NODES],
}

impl<const NODES: usize> EntityView<'_, NODES> {
    /// Three numbers a node of a vector column.
    pub fn vectors(&self, column: &[f64]) -> [[f64; 3]; NODES] {
        let mut out = [[0.0; 3]; NODES];
        for (out, &node) in out.iter_mut().zip(self.nodes) {
            let at = 3 * node as usize;
            *out = [column[at], column[at + 1], column[at + 2]];
        }
        out
    }

    /// One number a node of a scalar column.
    pub fn scalars(&self, column: &[f64]) -> [f64; NODES] {
        let mut out = [0.0; NODES];
        out.iter_mut().zip(self.nodes).for_each(|(out, &node)| *out = column[node as usize]);
        out
    }
}

/// The mathematics of one kind of element or condition with `NODES` nodes and `SIZE` unknowns.
///
/// `tangent · Δ = residual`; the residual is external minus internal forces. One value of the type serves one block; state
/// of single entities lives in `State`. A spring between a node and the ground, f = −c u, as a condition of decks:
///
/// ```
/// # use zelus_core::assembly::{Assembler, System};
/// # use zelus_core::entities::*;
/// # use zelus_core::geometry::Shape;
/// # use zelus_core::model::{EntityRole, ModelPart, Nodes, Properties};
/// # use zelus_core::{Result, register, register_variable};
/// register_variable! { pub LIFT: f64 = "Displacement of the ground spring."; }
///
/// struct GroundSpring;
///
/// impl Kernel<1, 1> for GroundSpring {
///     type State = ();
/// #   fn new(_: &BlockRequest<'_>) -> Result<Self> { Ok(Self) }
/// #   fn state(&self, _: &EntityView<'_, 1>, _: &StepView<'_>) -> Result<(), String> { Ok(()) }
/// #   fn tangent(&self) -> Tangent { Tangent::Symmetric }
///     fn unknowns() -> [LocalUnknown; 1] {
///         LocalUnknown::of_nodes(LIFT.scalar())
///     }
///
///     fn local_system(&self, spring: &EntityView<'_, 1>, _: &(), view: &StepView<'_>, _: Request,
///                     lhs: &mut [f64], rhs: &mut [f64; 1]) -> Result<(), String> {
///         let [u] = spring.scalars(view.nodes.history.values(&LIFT, 0));
///         rhs[0] -= 200.0 * u;
///         lhs.iter_mut().for_each(|k| *k += 200.0);
///         Ok(())
///     }
/// }
/// register! { ConditionEntry "GroundSpringCondition",
///     about: "a spring between a node and the ground",
///     source: "f = −c u",
///     cell: Some(Shape::Point1),
///     build: Build::Block(KernelBlock::<GroundSpring, 1, 1>::boxed),
/// }
/// # let mut part = ModelPart::new("Structure");
/// # part.nodes = Nodes::new(vec![1], vec![[0.0; 3]]);
/// # part.nodes.history.values_mut(&LIFT, 0)[0] = 0.5;
/// # part.properties.insert(0, Properties::new(0));
/// # part.conditions.push(1, require_kind(EntityRole::Condition, "GroundSpringCondition")?, 0, &[0]);
/// # part.conditions.finish();
/// # let mut system = System::default();
/// # system.make_blocks(&part)?;
/// # let mut assembler = Assembler::new(&part, &mut system, false);
/// // A part with one such condition, lifted by 0.5:
/// assembler.begin_step(&part, &system)?;
/// assert_eq!(assembler.residual(&part, &system, None)?, [-100.0]);
/// assembler.tangents(&part, &system, None)?;
/// assembler.reduce();
/// assert_eq!(assembler.system().bulk.get(0, 0), 200.0);
/// # Ok::<(), zelus_core::Error>(())
/// ```
pub trait Kernel<const NODES: usize, const SIZE: usize>: Send + Sync + Sized + 'static {
    /// History of one entity; advances only with an accepted step.
    type State: Clone + Send + Sync + Serialize + DeserializeOwned;

    /// The rows of the local system.
    fn unknowns() -> [LocalUnknown; SIZE];

    /// The rows of the local systems of this block, where its variables are chosen by the deck.
    fn own_unknowns(&self) -> [LocalUnknown; SIZE] {
        Self::unknowns()
    }

    /// The kernel for one block.
    ///
    /// # Errors
    /// Properties or data that the block lacks.
    fn new(request: &BlockRequest<'_>) -> Result<Self>;

    /// State of an entity before the first step.
    ///
    /// # Errors
    /// Properties that the entity lacks, or an unusable geometry.
    fn state(&self, entity: &EntityView<'_, NODES>, view: &StepView<'_>) -> Result<Self::State, String>;

    /// How the tangent behaves.
    fn tangent(&self) -> Tangent;

    /// Adds the residual, and the tangent row by row when `lhs` is not empty.
    ///
    /// # Errors
    /// Why the entity cannot be computed, e.g. that it is inverted.
    fn local_system(
        &self,
        entity: &EntityView<'_, NODES>,
        state: &Self::State,
        view: &StepView<'_>,
        request: Request,
        lhs: &mut [f64],
        rhs: &mut [f64; SIZE],
    ) -> Result<(), String>;

    /// Whether a constant-tangent kernel has external forces of its own in this step.
    fn has_external(&self, _view: &StepView<'_>) -> bool {
        false
    }

    /// See [`EntityBlock::has_storage`].
    fn has_storage(&self) -> bool {
        false
    }

    /// Adds the mass matrix row by row; `false` when the kind has none.
    fn mass(
        &self,
        _entity: &EntityView<'_, NODES>,
        _state: &Self::State,
        _view: &StepView<'_>,
        _lumped: bool,
        _out: &mut [f64],
    ) -> bool {
        false
    }

    /// Whether entities have a damping matrix of their own.
    fn has_damping(&self) -> bool {
        false
    }

    /// Adds the constant damping matrix row by row, force per velocity.
    fn damping(&self, _entity: &EntityView<'_, NODES>, _state: &Self::State, _out: &mut [f64]) {}

    /// Whether the entity has a history, as one that yields does.
    fn has_history(&self, _state: &Self::State) -> bool {
        false
    }

    /// The state after an accepted step.
    ///
    /// # Errors
    /// As [`Kernel::local_system`].
    fn accept(
        &self,
        _entity: &EntityView<'_, NODES>,
        _state: &mut Self::State,
        _view: &StepView<'_>,
    ) -> Result<(), String> {
        Ok(())
    }

    /// Whether [`Kernel::accept`] notes work that is done [`together`](super::together): it is then called in both rounds, and changes a
    /// state in one of them.
    fn accepts_together(&self) -> bool {
        false
    }

    /// Takes over the history of the entity from an earlier stage.
    fn inherit(&self, _state: &mut Self::State, _earlier: &Self::State) {}

    /// Whether a state read from a file can be that of an entity that begins with `own`, as lists of one length.
    fn fits(&self, _own: &Self::State, _saved: &Self::State) -> bool {
        true
    }

    /// A variable at the Gauss points.
    fn gauss(
        &self,
        _entity: &EntityView<'_, NODES>,
        _state: &Self::State,
        _view: &StepView<'_>,
        _variable: &str,
    ) -> Option<Gauss> {
        None
    }

    /// Names that [`Kernel::gauss`] answers.
    fn gauss_variables(&self) -> &'static [&'static str] {
        &[]
    }

    /// Warnings about the choice of this kernel for the requested entities.
    fn warnings(_request: &BlockRequest<'_>) -> Vec<Diagnostic> {
        Vec::new()
    }

    /// See [`EntityBlock::assumed_small`].
    fn assumed_small(&self, _entity: &EntityView<'_, NODES>, _view: &StepView<'_>) -> Option<AssumedSmall> {
        None
    }

    /// Reason why the entity cannot give the traction on its faces; `None` where [`Kernel::traction`] does.
    fn lacks_tractions(&self, _entity: &EntityView<'_, NODES>) -> Option<&'static str> {
        Some(NO_TRACTIONS)
    }

    /// As [`EntityBlock::traction`].
    ///
    /// # Errors
    /// An entity that has none, or is inverted.
    fn traction(
        &self,
        _entity: &EntityView<'_, NODES>,
        _point: &FacePoint,
        _displacements: &[[f64; 3]; NODES],
        _by: Option<&mut [[f64; 3]; SIZE]>,
    ) -> Result<[f64; 3], String> {
        Err(NO_TRACTIONS.to_owned())
    }
}

/// A block made of a kernel, a connectivity and a state for each entity.
pub struct KernelBlock<K: Kernel<NODES, SIZE>, const NODES: usize, const SIZE: usize> {
    members: Members,
    kernel: K,
    nodes: Vec<[u32; NODES]>,
    states: Vec<K::State>,
    unknowns: Vec<LocalUnknown>,
    warnings: Vec<Diagnostic>,
}

impl<K: Kernel<NODES, SIZE>, const NODES: usize, const SIZE: usize> KernelBlock<K, NODES, SIZE> {
    /// The block of the requested entities; the factory that registrations name.
    ///
    /// # Errors
    /// As [`Kernel::new`].
    pub fn boxed(request: &BlockRequest<'_>) -> Result<Box<dyn EntityBlock>> {
        let (members, nodes) = (Members::of(request), nodes_of(request, NODES));
        let kernel = K::new(request)?;
        Ok(Box::new(Self {
            members,
            unknowns: kernel.own_unknowns().to_vec(),
            kernel,
            nodes: nodes.as_chunks().0.to_vec(),
            states: Vec::new(),
            warnings: K::warnings(request),
        }))
    }

    #[inline(always)]
    fn gather<'a>(&'a self, at: usize, view: &StepView<'a>) -> EntityView<'a, NODES> {
        let nodes = &self.nodes[at];
        let (mut initial, mut current) = ([[0.0; 3]; NODES], [[0.0; 3]; NODES]);
        for (i, &node) in nodes.iter().enumerate() {
            initial[i] = view.nodes.initial[node as usize];
            current[i] = view.nodes.current[node as usize];
        }
        EntityView {
            index: self.members.indices[at],
            nodes,
            properties: &view.properties[&self.members.properties[at]],
            initial,
            current,
        }
    }

    fn error(&self, at: usize, view: &StepView<'_>, fact: String) -> EntityError {
        self.members.error(at, &self.nodes[at], view, fact)
    }
}

/// Errors of a block that are told at most.
const ERRORS: usize = 20;

/// The entities of a block, whatever its kernel.
struct Members {
    entry: &'static EntityKind,
    /// Indices in the table of the model part.
    indices: Vec<u32>,
    ids: Vec<usize>,
    properties: Vec<usize>,
}

impl Members {
    fn of(request: &BlockRequest<'_>) -> Self {
        let (table, indices) = (request.table, request.members.clone());
        Self {
            entry: request.entry,
            ids: indices.iter().map(|&m| table.ids[m as usize]).collect(),
            properties: indices.iter().map(|&m| table.properties[m as usize]).collect(),
            indices,
        }
    }

    fn error(&self, at: usize, nodes: &[u32], view: &StepView<'_>, fact: String) -> EntityError {
        EntityError {
            kind: self.entry.name,
            id: self.ids[at],
            nodes: nodes.iter().map(|&n| view.nodes.ids[n as usize]).collect(),
            fact,
            remedy: "check the order and the coordinates of its nodes; in a running analysis, take shorter steps",
        }
    }

    /// The error of entities with these facts, `size` nodes each.
    fn refuse(&self, facts: Vec<(usize, String)>, nodes: &[u32], size: usize, view: &StepView<'_>) -> Result<()> {
        let mut report = Report::new();
        for (at, fact) in facts.into_iter().take(ERRORS) {
            report.absorb::<()>(Err(self.error(at, &nodes[at * size..(at + 1) * size], view, fact).into()));
        }
        report.finish().map(|_| ())
    }

    /// Places of entities that an earlier block has, too: here and there.
    fn shared(&self, earlier: &Self) -> Vec<(usize, usize)> {
        let places: HashMap<usize, usize> = earlier.ids.iter().enumerate().map(|(at, &id)| (id, at)).collect();
        self.ids.iter().enumerate().filter_map(|(at, id)| Some((at, *places.get(id)?))).collect()
    }
}

/// Nodes of all members, `size` each.
fn nodes_of(request: &BlockRequest<'_>, size: usize) -> Vec<u32> {
    let mut out = Vec::with_capacity(size * request.members.len());
    request.members.iter().for_each(|&member| out.extend_from_slice(request.table.nodes(member)));
    assert_eq!(out.len(), size * request.members.len(), "registered node count");
    out
}

/// Result of `of` for each of so many entities, or the fault of one.
fn states_of<T: Send>(
    count: usize,
    of: &(dyn Fn(usize) -> Result<T, String> + Sync),
) -> Result<Vec<T>, Vec<(usize, String)>> {
    let (mut states, mut facts) = (Vec::with_capacity(count), Vec::new());
    for (at, found) in parallel::map(count, 64, of).into_iter().enumerate() {
        match found {
            Ok(state) => states.push(state),
            Err(fact) => facts.push((at, fact)),
        }
    }
    if facts.is_empty() { Ok(states) } else { Err(facts) }
}

/// Lets each state be changed, in the rounds of [`together`] where that is asked for.
fn change<T>(
    states: &mut [T],
    in_rounds: bool,
    by: &dyn Fn(usize, &mut T) -> Result<(), EntityError>,
) -> Result<(), EntityError> {
    let mut all = || states.iter_mut().enumerate().try_for_each(|(at, state)| by(at, state));
    if in_rounds { together(&mut all) } else { all() }
}

/// States out of a file that fit `own`.
fn resumed<T: DeserializeOwned>(
    state: Box<dyn State>,
    members: &Members,
    own: &[T],
    fits: &dyn Fn(&T, &T) -> bool,
) -> Result<Vec<T>> {
    let kind = members.entry.name;
    let states: Vec<T> = state.take::<BlockState>()?.states(kind, &members.ids)?;
    match own.iter().zip(&states).all(|(own, saved)| fits(own, saved)) {
        true => Ok(states),
        false => Err(unfit(format!("what {kind} remember is of other materials"))),
    }
}

/// Gives states those of the same entities before.
fn take_over<T>(shared: &[(usize, usize)], own: &mut [T], earlier: &[T], inherit: &dyn Fn(&mut T, &T)) {
    for &(here, there) in shared {
        if let (Some(state), Some(before)) = (own.get_mut(here), earlier.get(there)) {
            inherit(state, before);
        }
    }
}

impl<K: Kernel<NODES, SIZE>, const NODES: usize, const SIZE: usize> EntityBlock for KernelBlock<K, NODES, SIZE> {
    fn entry(&self) -> &'static EntityKind {
        self.members.entry
    }

    fn members(&self) -> &[u32] {
        &self.members.indices
    }

    fn nodes(&self, at: usize) -> &[u32] {
        &self.nodes[at]
    }

    fn unknowns(&self) -> &[LocalUnknown] {
        &self.unknowns
    }

    fn tangent(&self) -> Tangent {
        self.kernel.tangent()
    }

    fn is_active(&self, at: usize, view: &StepView<'_>) -> bool {
        let table = if self.members.entry.role == EntityRole::Element { view.elements } else { view.conditions };
        table.flags.is_active(self.members.indices[at] as usize)
    }

    fn initialize(&mut self, view: &StepView<'_>) -> Result<()> {
        let state = |at: usize| self.kernel.state(&self.gather(at, view), view);
        match states_of(self.nodes.len(), &state) {
            Ok(states) => self.states = states,
            Err(facts) => self.members.refuse(facts, self.nodes.as_flattened(), NODES, view)?,
        }
        Ok(())
    }

    fn local_systems(
        &self,
        view: &StepView<'_>,
        range: Range<usize>,
        request: Request,
        out: &mut LocalSystems,
    ) -> Result<(), EntityError> {
        for (slot, at) in range.enumerate() {
            if !self.is_active(at, view) {
                continue;
            }
            let (lhs, rhs) = out.entity(slot);
            let rhs = rhs.try_into().expect("buffer of SIZE rows");
            self.kernel
                .local_system(&self.gather(at, view), &self.states[at], view, request, lhs, rhs)
                .map_err(|fact| self.error(at, view, fact))?;
        }
        Ok(())
    }

    fn has_external(&self, view: &StepView<'_>) -> bool {
        self.kernel.has_external(view)
    }

    fn has_storage(&self) -> bool {
        self.kernel.has_storage()
    }

    fn mass(
        &self,
        view: &StepView<'_>,
        range: Range<usize>,
        lumped: bool,
        out: &mut LocalSystems,
    ) -> Result<bool, EntityError> {
        let mut any = false;
        for (slot, at) in range.enumerate() {
            if self.is_active(at, view) {
                let (lhs, _) = out.entity(slot);
                any |= self.kernel.mass(&self.gather(at, view), &self.states[at], view, lumped, lhs);
            }
        }
        Ok(any)
    }

    fn has_damping(&self) -> bool {
        self.kernel.has_damping()
    }

    fn damping(&self, view: &StepView<'_>, range: Range<usize>, out: &mut LocalSystems) {
        for (slot, at) in range.enumerate() {
            if self.is_active(at, view) {
                self.kernel.damping(&self.gather(at, view), &self.states[at], out.entity(slot).0);
            }
        }
    }

    fn has_history(&self, at: usize) -> bool {
        self.states.get(at).is_some_and(|state| self.kernel.has_history(state))
    }

    fn finalize_step(&mut self, view: &StepView<'_>) -> Result<(), EntityError> {
        if size_of::<K::State>() == 0 {
            return Ok(());
        }
        let mut states = std::mem::take(&mut self.states);
        let accept = |at: usize, state: &mut K::State| {
            self.kernel.accept(&self.gather(at, view), state, view).map_err(|fact| self.error(at, view, fact))
        };
        let result = change(&mut states, self.kernel.accepts_together(), &accept);
        self.states = states;
        result
    }

    fn state(&self) -> Option<Box<dyn State>> {
        if size_of::<K::State>() == 0 {
            return None;
        }
        Some(Box::new(BlockState::of(self.members.entry.name, &self.members.ids, &self.states)))
    }

    fn resume(&mut self, state: Box<dyn State>) -> Result<()> {
        self.states = resumed(state, &self.members, &self.states, &|own, saved| self.kernel.fits(own, saved))?;
        Ok(())
    }

    fn as_any(&self) -> Option<&dyn Any> {
        Some(self)
    }

    fn inherit(&mut self, earlier: &dyn EntityBlock) {
        let Some(earlier) = earlier.as_any().and_then(|block| block.downcast_ref::<Self>()) else { return };
        let shared = self.members.shared(&earlier.members);
        take_over(&shared, &mut self.states, &earlier.states, &|own, before| self.kernel.inherit(own, before));
    }

    fn gauss(&self, view: &StepView<'_>, variable: &str, at: usize) -> Option<Gauss> {
        self.kernel.gauss(&self.gather(at, view), &self.states[at], view, variable)
    }

    fn gauss_variables(&self) -> &'static [&'static str] {
        self.kernel.gauss_variables()
    }

    fn warnings(&self) -> &[Diagnostic] {
        &self.warnings
    }

    fn assumed_small(&self, view: &StepView<'_>, at: usize) -> Option<AssumedSmall> {
        self.kernel.assumed_small(&self.gather(at, view), view)
    }

    fn lacks_tractions(&self, view: &StepView<'_>, at: usize) -> Option<&'static str> {
        self.kernel.lacks_tractions(&self.gather(at, view))
    }

    fn traction(
        &self,
        view: &StepView<'_>,
        at: usize,
        point: &FacePoint,
        displacements: &[[f64; 3]],
        by: Option<&mut [[f64; 3]]>,
    ) -> Result<[f64; 3], EntityError> {
        let displacements = displacements.try_into().expect("one displacement a node");
        let by = by.map(|by| by.try_into().expect("one derivative an unknown"));
        self.kernel
            .traction(&self.gather(at, view), point, displacements, by)
            .map_err(|fact| self.error(at, view, fact))
    }
}
