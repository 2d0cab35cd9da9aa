//! The mathematics of one entity, and the block that runs it over many.

use std::any::Any;
use std::collections::HashMap;
use std::ops::Range;

use serde::Serialize;
use serde::de::DeserializeOwned;
use zelus_linear_algebra::{State, parallel};

use super::block::{
    BlockRequest, EntityBlock, EntityError, Gauss, LocalSystems, LocalUnknown, NO_TRACTIONS, Tangent, Want,
};
use super::block_state::BlockState;
use super::face_point::FacePoint;
use super::view::StepView;
use crate::diagnostics::{Report, Result, unfit};
use crate::model::{EntityKind, Properties, Role};

/// What a kernel is told of its entity, beside the step's fields.
#[derive(Clone, Copy)]
pub struct Gather<'a, const NODES: usize> {
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

impl<const NODES: usize> Gather<'_, NODES> {
    /// Three numbers a node of a vector column.
    pub fn vectors(&self, column: &[f64]) -> [[f64; 3]; NODES] {
        std::array::from_fn(|i| {
            let at = 3 * self.nodes[i] as usize;
            [column[at], column[at + 1], column[at + 2]]
        })
    }

    /// One number a node of a scalar column.
    pub fn scalars(&self, column: &[f64]) -> [f64; NODES] {
        std::array::from_fn(|i| column[self.nodes[i] as usize])
    }
}

/// The mathematics of one kind of element or condition with `NODES` nodes and `SIZE` unknowns.
///
/// `tangent · Δ = residual`; the residual is external minus internal forces. One value of the type serves one block; state
/// of single entities lives in `State`.
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
    /// What the block's properties or data lack.
    fn new(request: &BlockRequest<'_>) -> Result<Self>;

    /// State of an entity before the first step.
    ///
    /// # Errors
    /// What the entity's properties lack, or a geometry that cannot be computed with.
    fn state(&self, entity: &Gather<'_, NODES>, view: &StepView<'_>) -> Result<Self::State, String>;

    /// How the tangent behaves.
    fn tangent(&self) -> Tangent;

    /// Adds the residual, and the tangent row by row when `lhs` is not empty.
    ///
    /// # Errors
    /// Why the entity cannot be computed, e.g. that it is inverted.
    fn local_system(
        &self,
        entity: &Gather<'_, NODES>,
        state: &Self::State,
        view: &StepView<'_>,
        want: Want,
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
        _entity: &Gather<'_, NODES>,
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
    fn damping(&self, _entity: &Gather<'_, NODES>, _state: &Self::State, _out: &mut [f64]) {}

    /// Whether the entity remembers what it went through, as one that yields does.
    fn remembers(&self, _state: &Self::State) -> bool {
        false
    }

    /// The state after an accepted step.
    ///
    /// # Errors
    /// As [`Kernel::local_system`].
    fn accept(
        &self,
        _entity: &Gather<'_, NODES>,
        _state: &mut Self::State,
        _view: &StepView<'_>,
    ) -> Result<(), String> {
        Ok(())
    }

    /// Takes over what the entity remembered in an earlier stage.
    fn inherit(&self, _state: &mut Self::State, _earlier: &Self::State) {}

    /// Whether a state read from a file can be that of an entity that begins with `own`, as lists of one length.
    fn fits(&self, _own: &Self::State, _saved: &Self::State) -> bool {
        true
    }

    /// A variable at the Gauss points.
    fn gauss(
        &self,
        _entity: &Gather<'_, NODES>,
        _state: &Self::State,
        _view: &StepView<'_>,
        _variable: &str,
    ) -> Option<Gauss> {
        None
    }

    /// Names that [`Kernel::gauss`] answers.
    fn gauss_variables() -> &'static [&'static str] {
        &[]
    }

    /// Why the entity cannot say what traction acts on its faces; `None` where [`Kernel::traction`] does.
    fn lacks_tractions(&self, _entity: &Gather<'_, NODES>) -> Option<&'static str> {
        Some(NO_TRACTIONS)
    }

    /// As [`EntityBlock::traction`].
    ///
    /// # Errors
    /// An entity that has none, or is inverted.
    fn traction(
        &self,
        _entity: &Gather<'_, NODES>,
        _point: &FacePoint,
        _displacements: &[[f64; 3]; NODES],
        _by: Option<&mut [[f64; 3]; SIZE]>,
    ) -> Result<[f64; 3], String> {
        Err(NO_TRACTIONS.to_owned())
    }
}

/// A block made of a kernel, a connectivity and a state for each entity.
pub struct KernelBlock<K: Kernel<NODES, SIZE>, const NODES: usize, const SIZE: usize> {
    entry: &'static EntityKind,
    kernel: K,
    members: Vec<u32>,
    ids: Vec<usize>,
    nodes: Vec<[u32; NODES]>,
    properties: Vec<usize>,
    states: Vec<K::State>,
    unknowns: Vec<LocalUnknown>,
}

impl<K: Kernel<NODES, SIZE>, const NODES: usize, const SIZE: usize> KernelBlock<K, NODES, SIZE> {
    /// The block of the requested entities; the factory that registrations name.
    ///
    /// # Errors
    /// As [`Kernel::new`].
    pub fn boxed(request: &BlockRequest<'_>) -> Result<Box<dyn EntityBlock>> {
        let table = request.table;
        let nodes =
            request.members.iter().map(|&m| table.nodes(m).try_into().expect("registered node count")).collect();
        let kernel = K::new(request)?;
        Ok(Box::new(Self {
            entry: request.entry,
            unknowns: kernel.own_unknowns().to_vec(),
            kernel,
            ids: request.members.iter().map(|&m| table.ids[m as usize]).collect(),
            properties: request.members.iter().map(|&m| table.properties[m as usize]).collect(),
            members: request.members.clone(),
            nodes,
            states: Vec::new(),
        }))
    }

    #[inline(always)]
    fn gather<'a>(&'a self, at: usize, view: &StepView<'a>) -> Gather<'a, NODES> {
        let nodes = &self.nodes[at];
        Gather {
            index: self.members[at],
            nodes,
            properties: &view.properties[&self.properties[at]],
            initial: std::array::from_fn(|i| view.nodes.initial[nodes[i] as usize]),
            current: std::array::from_fn(|i| view.nodes.current[nodes[i] as usize]),
        }
    }

    fn error(&self, at: usize, view: &StepView<'_>, fact: String) -> EntityError {
        error(self.entry, self.ids[at], &self.nodes[at], view, fact)
    }
}

/// Errors of a block that are told at most.
const ERRORS: usize = 20;

fn error(entry: &EntityKind, id: usize, nodes: &[u32], view: &StepView<'_>, fact: String) -> EntityError {
    EntityError {
        kind: entry.name,
        id,
        nodes: nodes.iter().map(|&n| view.nodes.ids[n as usize]).collect(),
        fact,
        remedy: "check the order and the coordinates of its nodes; in a running analysis, take shorter steps",
    }
}

fn refuse(errors: Vec<EntityError>) -> Result<()> {
    let mut report = Report::new();
    errors.into_iter().for_each(|error| _ = report.absorb::<()>(Err(error.into())));
    report.finish().map(|_| ())
}

/// Places in two lists of ids that both have: in the first and in the second.
fn shared(own: &[usize], earlier: &[usize]) -> Vec<(usize, usize)> {
    let places: HashMap<usize, usize> = earlier.iter().enumerate().map(|(at, &id)| (id, at)).collect();
    own.iter().enumerate().filter_map(|(at, id)| Some((at, *places.get(id)?))).collect()
}

impl<K: Kernel<NODES, SIZE>, const NODES: usize, const SIZE: usize> EntityBlock for KernelBlock<K, NODES, SIZE> {
    fn entry(&self) -> &'static EntityKind {
        self.entry
    }

    fn members(&self) -> &[u32] {
        &self.members
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
        let table = if self.entry.role == Role::Element { view.elements } else { view.conditions };
        table.flags.is_active(self.members[at] as usize)
    }

    fn initialize(&mut self, view: &StepView<'_>) -> Result<()> {
        let state = |at: usize| self.kernel.state(&self.gather(at, view), view);
        let found: Vec<Result<K::State, String>> = parallel::map(self.members.len(), 64, state);
        let (mut states, mut errors) = (Vec::with_capacity(found.len()), Vec::new());
        for (at, found) in found.into_iter().enumerate() {
            match found {
                Ok(state) => states.push(state),
                Err(fact) if errors.len() < ERRORS => errors.push(self.error(at, view, fact)),
                Err(_) => {}
            }
        }
        refuse(errors)?;
        self.states = states;
        Ok(())
    }

    fn local_systems(
        &self,
        view: &StepView<'_>,
        range: Range<usize>,
        want: Want,
        out: &mut LocalSystems,
    ) -> Result<(), EntityError> {
        for (slot, at) in range.enumerate() {
            if !self.is_active(at, view) {
                continue;
            }
            let (lhs, rhs) = out.entity(slot);
            let rhs = rhs.try_into().expect("buffer of SIZE rows");
            self.kernel
                .local_system(&self.gather(at, view), &self.states[at], view, want, lhs, rhs)
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

    fn remembers(&self, at: usize) -> bool {
        self.states.get(at).is_some_and(|state| self.kernel.remembers(state))
    }

    fn accept_step(&mut self, view: &StepView<'_>) -> Result<(), EntityError> {
        if size_of::<K::State>() == 0 {
            return Ok(());
        }
        let mut states = std::mem::take(&mut self.states);
        let result = states.iter_mut().enumerate().try_for_each(|(at, state)| {
            self.kernel.accept(&self.gather(at, view), state, view).map_err(|fact| self.error(at, view, fact))
        });
        self.states = states;
        result
    }

    fn state(&self) -> Option<Box<dyn State>> {
        if size_of::<K::State>() == 0 {
            return None;
        }
        Some(Box::new(BlockState::of(self.entry.name, &self.ids, &self.states)))
    }

    fn resume(&mut self, state: Box<dyn State>) -> Result<()> {
        let states: Vec<K::State> = state.take::<BlockState>()?.states(self.entry.name, &self.ids)?;
        if !self.states.iter().zip(&states).all(|(own, saved)| self.kernel.fits(own, saved)) {
            return Err(unfit(format!("what {} remember is of other materials", self.entry.name)));
        }
        self.states = states;
        Ok(())
    }

    fn as_any(&self) -> Option<&dyn Any> {
        Some(self)
    }

    fn inherit(&mut self, earlier: &dyn EntityBlock) {
        let Some(earlier) = earlier.as_any().and_then(|block| block.downcast_ref::<Self>()) else { return };
        for (own, before) in shared(&self.ids, &earlier.ids) {
            if let (Some(state), Some(before)) = (self.states.get_mut(own), earlier.states.get(before)) {
                self.kernel.inherit(state, before);
            }
        }
    }

    fn gauss(&self, view: &StepView<'_>, variable: &str, at: usize) -> Option<Gauss> {
        self.kernel.gauss(&self.gather(at, view), &self.states[at], view, variable)
    }

    fn gauss_variables(&self) -> &'static [&'static str] {
        K::gauss_variables()
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
