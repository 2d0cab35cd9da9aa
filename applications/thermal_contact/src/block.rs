//! Heat between pairs of facets of one pair of shapes: ∫ h (T₁ − T₂)(δT₁ − δT₂) over the points at which they face each other.
//!
//! Heat that leaves one body enters the other at the same points by the same number, so that nothing is lost or gained; friction adds
//! its dissipation.

use std::ops::Range;
use std::sync::Arc;

use zelus_core::entities::{EntityBlock, EntityError, LocalSystems, LocalUnknown, Request, StepView, Tangent};
use zelus_core::model::{EntityKind, ScalarVariable};
use zelus_core::scalar::Real;

use crate::law::{ByTemperatures, ConductanceLaw, ContactPoint};

/// A point of a pair.
#[derive(Debug, Clone)]
pub struct Point {
    /// Shape functions of the master's nodes, then those of the slave's.
    pub n: Vec<f64>,
    /// Area that it stands for.
    pub weight: f64,
    /// How the bodies meet there.
    pub contact: ContactPoint,
    /// Heat of friction that enters slave and master (power per area).
    pub friction: [f64; 2],
}

/// Pairs with as many nodes each.
pub struct ConductanceBlock {
    entry: &'static EntityKind,
    /// Points of each pair.
    pairs: Vec<Vec<Point>>,
    /// Node indices of each pair: master nodes, then slave nodes.
    nodes: Vec<u32>,
    masters: usize,
    unknowns: Vec<LocalUnknown>,
    laws: Arc<[Box<dyn ConductanceLaw>]>,
}

impl ConductanceBlock {
    /// Pairs with `masters` nodes on the side of the master, for an `unknown` of heat.
    pub fn new(
        entry: &'static EntityKind,
        (pairs, nodes, masters): (Vec<Vec<Point>>, Vec<u32>, usize),
        unknown: ScalarVariable,
        laws: Arc<[Box<dyn ConductanceLaw>]>,
    ) -> Self {
        let each = nodes.len() / pairs.len().max(1);
        let unknowns = (0..each).map(|node| LocalUnknown::of_node(node as u8, unknown)).collect();
        Self { entry, pairs, nodes, masters, unknowns, laws }
    }

    /// Heat that passes from slave to master at a point, by temperatures there (power per area).
    fn flux(&self, point: &Point, [slave, master]: [f64; 2]) -> ByTemperatures {
        let temperatures = [ByTemperatures::variable(slave, 0), ByTemperatures::variable(master, 1)];
        let conductance = self
            .laws
            .iter()
            .fold(ByTemperatures::constant(0.0), |sum, law| sum + law.conductance(&point.contact, temperatures));
        conductance * (temperatures[0] - temperatures[1])
    }

    /// Temperatures of slave and master at a point.
    fn temperatures(&self, point: &Point, nodal: &[f64]) -> [f64; 2] {
        let sum = |range: Range<usize>| range.map(|i| point.n[i] * nodal[i]).sum();
        [sum(self.masters..nodal.len()), sum(0..self.masters)]
    }

    fn nodal(&self, view: &StepView<'_>, at: usize) -> Vec<f64> {
        let variable = self.unknowns[0].variable;
        let value = |&node: &u32| view.nodes.history.scalar(variable, node as usize).unwrap_or(0.0);
        self.nodes(at).iter().map(value).collect()
    }

    /// Heat that passes from slaves to masters, and heat of friction, of the pairs that `counts` admits by their nodes (power).
    pub fn flow(&self, view: &StepView<'_>, counts: impl Fn(&[u32]) -> bool) -> [f64; 2] {
        let mut sums = [0.0; 2];
        for at in (0..self.pairs.len()).filter(|&at| counts(self.nodes(at))) {
            let nodal = self.nodal(view, at);
            for point in &self.pairs[at] {
                sums[0] += point.weight * self.flux(point, self.temperatures(point, &nodal)).value();
                sums[1] += point.weight * point.friction.iter().sum::<f64>();
            }
        }
        sums
    }
}

impl EntityBlock for ConductanceBlock {
    fn entry(&self) -> &'static EntityKind {
        self.entry
    }

    fn members(&self) -> &[u32] {
        &[]
    }

    fn len(&self) -> usize {
        self.pairs.len()
    }

    fn nodes(&self, at: usize) -> &[u32] {
        let each = self.unknowns.len();
        &self.nodes[at * each..(at + 1) * each]
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
        request: Request,
        out: &mut LocalSystems,
    ) -> Result<(), EntityError> {
        let count = self.unknowns.len();
        // Contribution of a point to slave and to master nodes.
        let sign = |i: usize| if i < self.masters { 1.0 } else { -1.0 };
        for (slot, at) in range.enumerate() {
            let nodal = self.nodal(view, at);
            let (lhs, rhs) = out.entity(slot);
            for point in &self.pairs[at] {
                let flux = self.flux(point, self.temperatures(point, &nodal));
                for i in 0..count {
                    let friction = point.friction[usize::from(i < self.masters)];
                    rhs[i] += point.weight * point.n[i] * (sign(i) * flux.value() + friction);
                }
                if request == Request::Both {
                    for i in 0..count {
                        for j in 0..count {
                            let by = flux.gradient[usize::from(j < self.masters)];
                            lhs[i * count + j] -= sign(i) * point.weight * point.n[i] * by * point.n[j];
                        }
                    }
                }
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use zelus_convection_diffusion::variables::TEMPERATURE;
    use zelus_core::entities::require_kind;
    use zelus_core::model::{EntityRole, ModelPart};
    use zelus_core::parameters::Document;
    use zelus_core::registry::named;

    use crate::law::ContactConductanceEntry;

    fn law(text: &str) -> Box<dyn ConductanceLaw> {
        let node = Document::from_str(text, "deck.json").unwrap().root;
        let (entry, settings) = named::<ContactConductanceEntry>(&node, "law").unwrap();
        (entry.build)(&settings).unwrap()
    }

    #[test]
    fn tangents_are_differences_and_nothing_is_lost() {
        let laws = [
            law(r#"{"law": "radiation", "stefan_boltzmann_constant": 1e-3, "emissivity_of_slave": 0.7}"#),
            law(r#"{"law": "gas", "conductivity": 2.0, "jump_distance": 0.1}"#),
        ];
        let mut part = ModelPart::new("Heat");
        part.nodes = zelus_core::model::Nodes::new(vec![1, 2, 3, 4], vec![[0.0; 3]; 4]);
        part.nodes.history.add(&TEMPERATURE);
        let contact = ContactPoint { pressure: 0.0, gap: 0.3, touches: false, areas: [0.9, 1.2] };
        let point =
            |a: f64, b: f64| Point { n: vec![a, 1.0 - a, b, 1.0 - b], weight: 0.4, contact, friction: [0.0; 2] };
        let entry = require_kind(EntityRole::Condition, "ContactConductanceCondition2D2N").unwrap();
        let pairs = (vec![vec![point(0.2, 0.3), point(0.7, 0.9)]], vec![0, 1, 2, 3], 2);
        let block = ConductanceBlock::new(entry, pairs, TEMPERATURE.scalar(), Vec::from(laws).into());
        let mut at = |values: [f64; 4]| {
            part.nodes.history.values_mut(&TEMPERATURE, 0).copy_from_slice(&values);
            let mut out = LocalSystems::default();
            out.reset(1, 4, Request::Both);
            block.local_systems(&part.view(), 0..1, Request::Both, &mut out).unwrap();
            (out.lhs, out.rhs)
        };
        let values = [3.0, 4.0, 7.0, 5.5];
        let (lhs, rhs) = at(values);
        assert!(rhs.iter().sum::<f64>().abs() < 1e-14, "{rhs:?}");
        assert!(rhs[0] > 0.0 && rhs[2] < 0.0, "heat goes from the warmer slave to the master: {rhs:?}");
        for j in 0..4 {
            let mut moved = |step: f64| {
                let mut values = values;
                values[j] += step;
                at(values).1
            };
            let (more, less) = (moved(1e-5), moved(-1e-5));
            for i in 0..4 {
                let difference = (less[i] - more[i]) / 2e-5;
                assert!((lhs[i * 4 + j] - difference).abs() < 1e-7, "{i} {j}: {} {difference}", lhs[i * 4 + j]);
            }
        }
    }
}
