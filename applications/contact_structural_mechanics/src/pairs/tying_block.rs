//! A block of tied pairs of one pair of shapes.

use std::ops::Range;

use zelus_core::entities::{EntityBlock, EntityError, LocalSystems, LocalUnknown, StepView, Tangent, Want};
use zelus_core::geometry::{FacetShape, Shape};
use zelus_core::model::{EntityKind, ScalarVariable};

use super::facet_operators::FacetPair;
use crate::formulations::MeshTying;
use crate::mortar::Operators;
use crate::mortar::shapes::for_shapes;

/// What a block of ties is made from.
pub struct TyingRequest {
    /// The registered condition of this shape.
    pub entry: &'static EntityKind,
    /// The pairs.
    pub pairs: Vec<FacetPair>,
    /// Node indices of each pair: master nodes, then slave nodes.
    pub nodes: Vec<u32>,
    /// What is tied.
    pub tied: Vec<ScalarVariable>,
    /// The multiplier of each tied number.
    pub multipliers: Vec<ScalarVariable>,
    /// SCALE_FACTOR.
    pub scale_factor: f64,
}

/// The block of a pair of shapes (slave, master) and any number of tied components; `None` for shapes without ties.
pub fn tying_block(slave: Shape, master: Shape, request: TyingRequest) -> Option<Box<dyn EntityBlock>> {
    macro_rules! make {
        ($slave:ty, $master:ty, $end:literal) => {
            match request.tied.len() {
                1 => Some(TyingBlock::<$slave, $master, 1>::boxed(request)),
                count if count == <$slave>::SPACE => {
                    Some(TyingBlock::<$slave, $master, { <$slave>::SPACE }>::boxed(request))
                }
                _ => None,
            }
        };
    }
    for_shapes!(slave, master, make)?
}

/// Pairs of shapes with `C` tied numbers a node.
struct TyingBlock<S: FacetShape, M: FacetShape, const C: usize> {
    request: TyingRequest,
    operators: Vec<Operators<f64, S, M>>,
    unknowns: Vec<LocalUnknown>,
}

impl<S: FacetShape, M: FacetShape, const C: usize> TyingBlock<S, M, C> {
    fn boxed(request: TyingRequest) -> Box<dyn EntityBlock> {
        let row = |node: usize, variable: ScalarVariable| LocalUnknown::of_node(node as u8, variable);
        let mut unknowns = Vec::with_capacity(MeshTying::size::<S, M, C>());
        for node in 0..M::NODES + S::NODES {
            unknowns.extend(request.tied.iter().map(|&variable| row(node, variable)));
        }
        for node in M::NODES..M::NODES + S::NODES {
            unknowns.extend(request.multipliers.iter().map(|&variable| row(node, variable)));
        }
        let operators = request.pairs.iter().map(|pair| Operators {
            d: S::nodal(|j| S::nodal(|k| pair.operators.d[j][k])),
            m: S::nodal(|j| M::nodal(|l| pair.operators.m[j][l])),
        });
        Box::new(Self { operators: operators.collect(), unknowns, request })
    }

    fn values<N: FacetShape>(view: &StepView<'_>, nodes: &[u32], variables: &[ScalarVariable]) -> N::Nodal<[f64; C]> {
        N::nodal(|n| std::array::from_fn(|c| view.nodes.history.scalar(variables[c], nodes[n] as usize).unwrap_or(0.0)))
    }
}

impl<S: FacetShape, M: FacetShape, const C: usize> EntityBlock for TyingBlock<S, M, C> {
    fn entry(&self) -> &'static EntityKind {
        self.request.entry
    }

    fn members(&self) -> &[u32] {
        &[]
    }

    fn len(&self) -> usize {
        self.operators.len()
    }

    fn nodes(&self, at: usize) -> &[u32] {
        &self.request.nodes[at * (M::NODES + S::NODES)..(at + 1) * (M::NODES + S::NODES)]
    }

    fn unknowns(&self) -> &[LocalUnknown] {
        &self.unknowns
    }

    fn tangent(&self) -> Tangent {
        Tangent::Symmetric
    }

    fn is_active(&self, _at: usize, _view: &StepView<'_>) -> bool {
        true
    }

    fn local_systems(
        &self,
        view: &StepView<'_>,
        range: Range<usize>,
        want: Want,
        out: &mut LocalSystems,
    ) -> Result<(), EntityError> {
        let formulation = MeshTying { scale_factor: self.request.scale_factor };
        for (slot, at) in range.enumerate() {
            let (master, slave) = self.nodes(at).split_at(M::NODES);
            let (lhs, rhs) = out.entity(slot);
            formulation.residual::<S, M, C>(
                &self.operators[at],
                &Self::values::<M>(view, master, &self.request.tied),
                &Self::values::<S>(view, slave, &self.request.tied),
                &Self::values::<S>(view, slave, &self.request.multipliers),
                rhs,
            );
            if want == Want::Both {
                formulation.tangent::<S, M, C>(&self.operators[at], lhs);
            }
        }
        Ok(())
    }
}
