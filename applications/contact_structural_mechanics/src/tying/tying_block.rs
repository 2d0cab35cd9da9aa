//! A block of tied pairs of one pair of shapes.

use std::ops::Range;

use zelus_core::entities::{EntityBlock, EntityError, LocalSystems, LocalUnknown, Request, StepView, Tangent};
use zelus_core::geometry::{Nodal, Shape};
use zelus_core::model::{EntityKind, Owner, ScalarVariable};

use crate::law::MeshTying;
use crate::mortar::Operators;
use crate::pairs::FacetPair;

/// Tied pairs of two shapes, to make a block of.
pub struct TyingRequest {
    /// The registered condition of this shape.
    pub entry: &'static EntityKind,
    /// The pairs.
    pub pairs: Vec<FacetPair>,
    /// Node indices of each pair: master nodes, then slave nodes.
    pub nodes: Vec<u32>,
    /// Owners of the multipliers of each pair, in the order of its slave's nodes.
    pub owners: Vec<u32>,
    /// The tied numbers.
    pub tied: Vec<ScalarVariable>,
    /// The multiplier of each tied number.
    pub multipliers: Vec<ScalarVariable>,
    /// SCALE_FACTOR.
    pub scale_factor: f64,
}

/// Tied pairs of two shapes.
pub struct TyingBlock {
    request: TyingRequest,
    formulation: MeshTying,
    slaves: usize,
    masters: usize,
    operators: Vec<Operators<f64>>,
    unknowns: Vec<LocalUnknown>,
}

impl TyingBlock {
    /// The block of pairs of two shapes (slave, master) with any number of tied components.
    pub fn new(slave: Shape, master: Shape, request: TyingRequest) -> Self {
        let (slaves, masters) = (slave.nodes(), master.nodes());
        let mut unknowns = Vec::new();
        for node in 0..masters + slaves {
            unknowns.extend(request.tied.iter().map(|&variable| LocalUnknown::of_node(node as u8, variable)));
        }
        for slave in 0..slaves {
            let row = |&variable| LocalUnknown::of_slave((masters + slave) as u8, slave as u8, variable);
            unknowns.extend(request.multipliers.iter().map(row));
        }
        let operators = request.pairs.iter().map(|pair| Operators {
            d: Nodal::new(slaves, |j| Nodal::new(slaves, |k| pair.operators.d[j][k])),
            m: Nodal::new(slaves, |j| Nodal::new(masters, |l| pair.operators.m[j][l])),
        });
        let formulation = MeshTying { scale_factor: request.scale_factor, components: request.tied.len() };
        Self { operators: operators.collect(), formulation, slaves, masters, unknowns, request }
    }
}

impl EntityBlock for TyingBlock {
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
        let size = self.masters + self.slaves;
        &self.request.nodes[at * size..(at + 1) * size]
    }

    fn slave_owners(&self, at: usize) -> &[u32] {
        &self.request.owners[at * self.slaves..(at + 1) * self.slaves]
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
        request: Request,
        out: &mut LocalSystems,
    ) -> Result<(), EntityError> {
        let mut values = Vec::with_capacity(self.unknowns.len());
        for (slot, at) in range.enumerate() {
            let (nodes, owners) = (self.nodes(at), self.slave_owners(at));
            values.clear();
            values.extend(self.unknowns.iter().map(|unknown| {
                let (history, at) = match unknown.owner_among(nodes, owners) {
                    Owner::Node(node) => (&view.nodes.history, node),
                    Owner::Slave(slave) => (&view.slave_nodes.history, slave),
                };
                history.scalar(unknown.variable, at as usize).unwrap_or(0.0)
            }));
            let (lhs, rhs) = out.entity(slot);
            self.formulation.residual(&self.operators[at], &values, rhs);
            if request == Request::Both {
                self.formulation.tangent(&self.operators[at], lhs);
            }
        }
        Ok(())
    }
}
