//! Constraints of one method as a block: residual −∂ℓ and tangent ∂²ℓ over positions and multipliers (eq. D.2).

use std::ops::Range;
use zelus_core::model::EntityKind;

use zelus_core::entities::{EntityBlock, EntityError, LocalSystems, LocalUnknown, Request, StepView, Tangent};
use zelus_core::scalar::Dual;

use crate::constraints::Constraint;
use crate::method::{ConstraintState, MULTIPLIERS, Method};
use crate::variables::POSITION;

/// Constraints of one kind of condition under one method.
pub struct ConstraintBlock<M: Method> {
    entry: &'static EntityKind,
    constraints: Vec<Constraint>,
    /// Positions, then the node of the constraint: `terms + 1` a constraint.
    nodes: Vec<u32>,
    unknowns: Vec<LocalUnknown>,
    method: std::sync::Arc<M>,
    /// State of each constraint; the interaction changes it between iterates.
    pub(crate) states: Vec<ConstraintState>,
}

impl<M: Method> ConstraintBlock<M> {
    /// The block of `constraints`, which have the same number of terms.
    pub(crate) fn new(entry: &'static EntityKind, constraints: Vec<Constraint>, method: std::sync::Arc<M>) -> Self {
        let terms = constraints.first().map_or(0, |constraint| constraint.terms.len()) as u8;
        let position = |node| LocalUnknown::of_node(node, POSITION.scalar());
        let multiplier = |m: usize| LocalUnknown::of_node(terms, MULTIPLIERS[m].scalar());
        let nodes_of = |c: &Constraint| c.terms.iter().map(|term| term.0).chain([c.node]).collect::<Vec<u32>>();
        Self {
            entry,
            nodes: constraints.iter().flat_map(nodes_of).collect(),
            unknowns: (0..terms).map(position).chain((0..M::MULTIPLIERS).map(multiplier)).collect(),
            states: vec![ConstraintState::default(); constraints.len()],
            constraints,
            method,
        }
    }

    /// The constraints in the order of their states.
    pub(crate) fn constraints(&self) -> &[Constraint] {
        &self.constraints
    }
}

impl<M: Method> EntityBlock for ConstraintBlock<M> {
    fn entry(&self) -> &'static EntityKind {
        self.entry
    }

    fn members(&self) -> &[u32] {
        &[]
    }

    fn len(&self) -> usize {
        self.constraints.len()
    }

    fn nodes(&self, at: usize) -> &[u32] {
        let size = self.nodes.len() / self.constraints.len();
        &self.nodes[at * size..(at + 1) * size]
    }

    fn unknowns(&self) -> &[LocalUnknown] {
        &self.unknowns
    }

    fn tangent(&self) -> Tangent {
        Tangent::Unsymmetric
    }

    fn is_active(&self, _at: usize, _view: &StepView<'_>) -> bool {
        true
    }

    fn local_systems(
        &self,
        view: &StepView<'_>,
        range: Range<usize>,
        _request: Request,
        out: &mut LocalSystems,
    ) -> Result<(), EntityError> {
        for (slot, at) in range.enumerate() {
            let constraint = &self.constraints[at];
            let mut multipliers = [Dual::<3>::from(0.0); 2];
            for (m, dual) in multipliers.iter_mut().enumerate().take(M::MULTIPLIERS) {
                let value = view.nodes.history.values(MULTIPLIERS[m], 0)[constraint.node as usize];
                *dual = Dual::variable(constraint.sign * value, 1 + m);
            }
            let gap = Dual::variable(constraint.gap(view.nodes).0, 0);
            let gradient = self.method.gradient(gap, multipliers, &self.states[at]);
            // Of each row and column: which variable of ℓ it is, and the derivative of that variable by the unknown.
            let positions = constraint.terms.iter().map(|&(_, a)| (0, a));
            let rows = positions.chain((0..M::MULTIPLIERS).map(|m| (1 + m, constraint.sign)));
            let derivative = [gradient.gap, gradient.multipliers[0], gradient.multipliers[1]];
            let size = self.unknowns.len();
            let (lhs, rhs) = out.entity(slot);
            for (i, (p, factor)) in rows.clone().enumerate() {
                rhs[i] -= factor * derivative[p].value;
                for (j, (q, other)) in rows.clone().enumerate().take(lhs.len()) {
                    lhs[i * size + j] += factor * other * derivative[p].gradient[q];
                }
            }
        }
        Ok(())
    }
}
