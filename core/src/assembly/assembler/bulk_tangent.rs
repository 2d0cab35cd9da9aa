//! The tangent of elements and conditions, on a pattern that lasts as long as the mesh.
//!
//! The constant tangents are summed once. Where all tangents are constant and nothing moves against inertia, that sum is
//! the present tangent, too; otherwise the present tangent has values of its own on the same pattern.

use std::ops::Range;
use std::time::Instant;

use zelus_linear_algebra::Csr;
use zelus_linear_algebra::vector::{clear, copy, zeros};

use super::bulk_traits::{BulkTraits, is_variable};
use crate::assembly::System;
use crate::assembly::bulk_matrix::{BulkPattern, block_numbers};
use crate::communication::Ranks;
use crate::diagnostics::Result;
use crate::entities::{EntityBlock, EntityError, LocalSystems, Request, Tangent};
use crate::model::{EntityRole, ModelPart};

/// Factors of mass and damping in a tangent, and Rayleigh's alpha and beta; zeros without inertia.
pub(super) type InertiaKey = [f64; 4];

/// Pattern, constant values and present values of the bulk's tangent. Follower loads are not in it.
#[derive(Default)]
pub(super) struct BulkTangent {
    pattern: BulkPattern,
    /// Numbers of the unknowns of each block of elements.
    element_numbers: Vec<Vec<u32>>,
    /// Numbers of the unknowns of each block of conditions.
    condition_numbers: Vec<Vec<u32>>,
    /// Sum of the constant tangents, empty where there are none; `None` until it is computed.
    constant: Option<Vec<f64>>,
    /// Values of the present tangent; `None` where they are the constant ones.
    present: Option<Vec<f64>>,
    /// Whether the present tangent is not symmetric.
    general: bool,
    /// Whether there is a present tangent.
    has_tangent: bool,
    /// Stamp of the graph that the present tangent is of.
    graph: u64,
    /// Inertia that is in the present tangent; `None` where it is to be computed anew.
    key: Option<InertiaKey>,
    /// Count of the changes of the bodies' initial shape that the values follow.
    shape: u64,
    /// Properties of the blocks.
    traits: BulkTraits,
}

impl BulkTangent {
    /// The pattern of the blocks of `system`, whose unknowns are numbered; collective.
    pub fn new(part: &ModelPart, system: &System) -> Self {
        let numbers = |blocks: &[Box<dyn EntityBlock>]| -> Vec<Vec<u32>> {
            blocks.iter().map(|block| block_numbers(block.as_ref(), &system.dofs)).collect()
        };
        Self {
            pattern: pattern_of(part, system, &[]),
            element_numbers: numbers(&system.elements),
            condition_numbers: numbers(&system.conditions),
            traits: BulkTraits::of(part, system),
            ..Self::default()
        }
    }

    /// Lays out the pattern anew, where nodes of `groups` share more than elements.
    pub fn lay_out(&mut self, part: &ModelPart, system: &System, groups: &[Vec<u32>]) {
        self.pattern = pattern_of(part, system, groups);
    }

    /// Drops all values: they are of another shape or pattern.
    pub fn forget(&mut self) {
        (self.present, self.constant, self.key) = (None, None, None);
    }

    /// Follows the initial shape of the bodies; whether it has changed, so that all values are dropped.
    pub fn follow_shape(&mut self, shape: u64) -> bool {
        let changed = self.shape != shape;
        if changed {
            self.shape = shape;
            self.forget();
        }
        changed
    }

    /// Lets the next tangent be computed anew: its inertia is another.
    pub fn forget_key(&mut self) {
        self.key = None;
    }

    /// Graph and inertia that the present tangent is of.
    pub fn origin(&self) -> (u64, Option<InertiaKey>) {
        (self.graph, self.key)
    }

    /// Takes up graph and inertia of the tangent of a saved run.
    pub fn resume(&mut self, graph: u64, key: Option<InertiaKey>) {
        (self.graph, self.key) = (graph, key);
    }

    /// Properties of the blocks.
    pub fn traits(&self) -> BulkTraits {
        self.traits
    }

    /// Whether the present tangent is not symmetric.
    pub fn is_general(&self) -> bool {
        self.general
    }

    /// Lets the present tangent count as not symmetric where it is so on any rank; collective.
    pub fn agree_on_symmetry(&mut self, ranks: &Ranks) {
        self.general = ranks.any(self.general);
    }

    /// Entries of the pattern.
    pub fn entries(&self) -> usize {
        self.pattern.matrix.entries()
    }

    /// The pattern over all unknowns.
    pub fn matrix(&self) -> &Csr {
        &self.pattern.matrix
    }

    /// Blocks of elements with the numbers of their unknowns.
    pub fn elements<'a>(&'a self, system: &'a System) -> impl Iterator<Item = (&'a dyn EntityBlock, &'a [u32])> {
        let blocks = system.elements.iter().map(AsRef::as_ref);
        blocks.zip(self.element_numbers.iter().map(Vec::as_slice))
    }

    /// Blocks of conditions with the numbers of their unknowns.
    pub fn conditions<'a>(&'a self, system: &'a System) -> impl Iterator<Item = (&'a dyn EntityBlock, &'a [u32])> {
        let blocks = system.conditions.iter().map(AsRef::as_ref);
        blocks.zip(self.condition_numbers.iter().map(Vec::as_slice))
    }

    /// Blocks of elements, then those of conditions, with the numbers of their unknowns.
    pub fn blocks<'a>(&'a self, system: &'a System) -> impl Iterator<Item = (&'a dyn EntityBlock, &'a [u32])> {
        self.elements(system).chain(self.conditions(system))
    }

    /// Adds the local matrices of a block, as `compute` writes them, to `values` on the pattern.
    ///
    /// # Errors
    /// The first entity that cannot be computed.
    pub fn add(
        &self,
        (block, numbers): (&dyn EntityBlock, &[u32]),
        values: &mut [f64],
        compute: &(dyn Fn(Range<usize>, &mut LocalSystems) -> std::result::Result<(), EntityError> + Sync),
    ) -> Result<()> {
        Ok(self.pattern.add(block, numbers, values, compute)?)
    }

    /// Adds the tangents of the `wanted` blocks to `values`.
    fn add_tangents(
        &self,
        part: &ModelPart,
        system: &System,
        wanted: impl Fn(&dyn EntityBlock) -> bool,
        values: &mut [f64],
    ) -> Result<()> {
        let view = part.view();
        for (block, numbers) in self.blocks(system).filter(|(block, _)| wanted(*block)) {
            let compute = |range, out: &mut LocalSystems| block.local_systems(&view, range, Request::Both, out);
            self.add((block, numbers), values, &compute)?;
        }
        Ok(())
    }

    /// Sums the constant tangents where that has not been done; the seconds that it took.
    ///
    /// # Errors
    /// An entity that cannot be computed.
    pub fn ensure_constant(&mut self, part: &ModelPart, system: &System) -> Result<f64> {
        if self.constant.is_some() {
            return Ok(0.0);
        }
        let start = Instant::now();
        let is_constant = |block: &dyn EntityBlock| block.tangent() == Tangent::Constant;
        let any = system.elements.iter().chain(&system.conditions).any(|block| is_constant(block.as_ref()));
        let mut values = zeros(if any { self.entries() } else { 0 });
        self.add_tangents(part, system, is_constant, &mut values)?;
        self.constant = Some(values);
        Ok(start.elapsed().as_secs_f64())
    }

    /// Sum of the constant tangents, empty where there are none.
    ///
    /// # Panics
    /// Before [`BulkTangent::ensure_constant`].
    pub fn constant(&self) -> &[f64] {
        self.constant.as_deref().expect("assembled before the first residual")
    }

    /// Tangents of elements, and of conditions that keep it symmetric; in the `memory` of earlier ones.
    ///
    /// # Errors
    /// An entity that cannot be computed.
    pub fn stiffness(&self, part: &ModelPart, system: &System, memory: Vec<f64>) -> Result<Vec<f64>> {
        let entries = self.entries();
        let mut values = if memory.len() == entries { memory } else { zeros(entries) };
        match self.constant() {
            [] => clear(&mut values),
            constant => copy(constant, &mut values),
        }
        let is_element = |block: &dyn EntityBlock| block.entry().role == EntityRole::Element;
        self.add_tangents(
            part,
            system,
            |block| is_variable(block) && (is_element(block) || block.tangent() == Tangent::Symmetric),
            &mut values,
        )?;
        Ok(values)
    }

    /// Whether the present tangent is of another graph, state or inertia than this.
    pub fn is_stale(&self, graph: u64, key: InertiaKey) -> bool {
        self.traits.variable_bulk || self.graph != graph || self.key != Some(key)
    }

    /// Whether there is a present tangent.
    pub fn has_tangent(&self) -> bool {
        self.has_tangent
    }

    /// The memory of the present values, which are gone.
    pub fn take_memory(&mut self) -> Vec<f64> {
        self.present.take().unwrap_or_default()
    }

    /// Takes up the present tangent: `values`, or the constant ones where that is `None`.
    pub fn set_tangent(&mut self, values: Option<Vec<f64>>, general: bool, graph: u64, key: InertiaKey) {
        (self.present, self.general, self.graph, self.key) = (values, general, graph, Some(key));
        self.has_tangent = true;
    }

    /// Adds `amount(n, |k|)` to the diagonal entry k of each unknown n, until the tangent is computed anew.
    pub fn add_to_diagonal(&mut self, amount: &dyn Fn(usize, f64) -> f64) {
        let mut values = self.present.take().or_else(|| self.constant.clone()).unwrap_or_default();
        if values.is_empty() {
            values = zeros(self.entries());
        }
        for n in 0..self.pattern.matrix.rows {
            if let Some(at) = self.pattern.matrix.find(n, n) {
                values[at] += amount(n, values[at].abs());
            }
        }
        (self.present, self.key) = (Some(values), None);
    }

    /// Values of the present tangent, none where no block has one; `None` before they are computed.
    pub fn values(&self) -> Option<&[f64]> {
        self.present.as_deref().or(self.constant.as_deref())
    }

    /// Values of the present tangent, once there are any.
    pub fn entries_in_use(&self) -> Option<&[f64]> {
        self.values().filter(|values| !values.is_empty())
    }

    /// Lends the present values to the matrix, for solvers that read both together, until [`BulkTangent::return_values`].
    pub fn lend_values(&mut self) {
        let values = self.present.as_mut().or(self.constant.as_mut());
        self.pattern.matrix.values = values.map(std::mem::take).unwrap_or_default();
    }

    /// Takes the values back from the matrix.
    pub fn return_values(&mut self) {
        let lent = std::mem::take(&mut self.pattern.matrix.values);
        if let Some(values) = self.present.as_mut().or(self.constant.as_mut()) {
            *values = lent;
        }
    }

    /// Subtracts the product of a matrix with these values on the pattern.
    pub fn mul_subtract(&self, values: &[f64], x: &[f64], y: &mut [f64]) {
        self.pattern.matrix.mul_vec_subtract_with(values, x, y);
    }
}

/// The pattern of elements and conditions, and of `groups` of nodes beside them.
fn pattern_of(part: &ModelPart, system: &System, groups: &[Vec<u32>]) -> BulkPattern {
    let blocks = system.elements.iter().chain(&system.conditions).map(AsRef::as_ref);
    let blocks = blocks.filter(|b: &&dyn EntityBlock| b.tangent() != Tangent::Zero);
    BulkPattern::new(&system.dofs, part.nodes.len(), blocks, groups, |node| part.owns_node(node))
}
