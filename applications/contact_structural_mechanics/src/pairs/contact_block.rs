//! What the interaction asks of a block of pairs, whatever their family and their shapes.

use zelus_core::entities::{EntityBlock, StepView};

use super::pair::{Integral, Pair};

/// Whether this rank evaluates the pair with these nodes.
pub type Own<'a> = &'a (dyn Fn(&[u32]) -> bool + Sync);

/// A block of pairs as the interaction sees it.
pub trait ContactBlock: EntityBlock {
    /// The pairs.
    fn pairs(&self) -> &[Pair];

    /// The pairs, to change.
    fn pairs_mut(&mut self) -> &mut [Pair];

    /// Node indices on the slave side of the `at`-th pair.
    fn slave_nodes(&self, at: usize) -> &[u32];

    /// Gap, slip and area of every pair in the present configuration; those whose nodes are not `own` stay without overlap.
    fn integrate(&self, view: &StepView<'_>, own: Own<'_>) -> Vec<Integral>;

    /// Step start: keeps the operators of the `own` pairs against which slip is measured.
    fn keep_operators(&mut self, view: &StepView<'_>, own: Own<'_>);

    /// Lets the `own` pairs go on as they integrate now.
    fn keep_habits(&mut self, view: &StepView<'_>, own: Own<'_>);

    /// The same block for the assembly.
    fn as_entities(&self) -> &dyn EntityBlock;
}
