//! The walk over tying formulations: their block for every two shapes, with operators as a pair might have them.

use zelus::contact_structural_mechanics::pairs::{
    FacetOperators, FacetPair, Multiplier, PairKey, TyingFormulation, TyingFormulationEntry, condition_name,
};
use zelus::contact_structural_mechanics::tying::{TyingBlock, TyingRequest};
use zelus::structural_mechanics::variables::DISPLACEMENT;
use zelus_core::entities::{EntityBlock, Request, find_kind};
use zelus_core::geometry::Shape;
use zelus_core::model::{EntityRole, ModelPart, Nodes};
use zelus_core::registry::all;

use super::pairs::{FACETS, set, system};
use super::specimen::{Random, difference, size};

/// Operators that carry constants over: each row of D and M has the same sum.
fn operators(slaves: usize, masters: usize, random: &mut Random) -> FacetOperators {
    let mut out = FacetOperators::default();
    for j in 0..slaves {
        out.m[j][..masters].fill_with(|| 0.3 + 0.2 * random.next());
        out.d[j][j] = out.m[j].iter().sum();
    }
    out
}

fn block(formulation: &TyingFormulation, slave: Shape, master: Shape) -> Option<(ModelPart, Box<dyn EntityBlock>)> {
    let space = slave.dim() + 1;
    let multipliers = formulation.multiplier.unknowns(space);
    let tied = match formulation.multiplier {
        Multiplier::Scalar(_) | Multiplier::None | Multiplier::Body => {
            vec![DISPLACEMENT.component(0)]
        }
        Multiplier::Vector(_) => (0..space as u8).map(|c| DISPLACEMENT.component(c)).collect(),
    };
    let count = slave.nodes() + master.nodes();
    let mut part = ModelPart::new("walk");
    part.nodes = Nodes::new((1..=count).collect(), vec![[0.0; 3]; count]);
    part.nodes.history.add(&DISPLACEMENT);
    for &(name, components) in formulation.variables {
        part.nodes.history.add_named(name, components);
    }
    let entry = find_kind(EntityRole::Condition, &condition_name("MeshTyingMortarCondition", slave, master))?;
    let pair = FacetPair {
        key: PairKey { interface: 0, slave: 0, master: 0 },
        operators: operators(slave.nodes(), master.nodes(), &mut Random(3)),
    };
    let slaves: Vec<u32> = (master.nodes() as u32..count as u32).collect();
    let owners = part.slave_nodes.set("pair", &slaves).collect();
    if let Some((name, components)) = formulation.multiplier.column() {
        part.slave_nodes.history.add_named(name, components);
    }
    let request = TyingRequest {
        entry,
        pairs: vec![pair],
        nodes: (0..count as u32).collect(),
        owners,
        tied,
        multipliers,
        scale_factor: 1.7,
    };
    Some((part, Box::new(TyingBlock::new(slave, master, request))))
}

#[test]
fn ties_are_linear_symmetric_and_carry_rigid_shifts() {
    let formulations = all::<TyingFormulationEntry>().into_iter().map(|entry| (entry.name, &entry.build));
    let mut walked = 0;
    for (name, formulation) in formulations {
        for (slave, master) in FACETS.into_iter().flat_map(|s| FACETS.map(|m| (s, m))) {
            let Some((mut part, block)) = block(formulation, slave, master) else { continue };
            let block = block.as_ref();
            let n = block.unknowns().len();
            let mut random = Random(4);
            let values: Vec<f64> = (0..n).map(|_| random.next()).collect();
            values.iter().enumerate().for_each(|(row, value)| set(&mut part, block, row, *value));
            let out = system(&part, block, Request::Both);
            let label = format!("{name} {slave:?} on {master:?}");
            let product: Vec<f64> =
                (0..n).map(|i| -(0..n).map(|j| out.lhs[i * n + j] * values[j]).sum::<f64>()).collect();
            assert!(difference(&out.rhs, &product) < 1e-13 * size(out.lhs.iter().copied()), "{label}: b is not −K x");
            assert!((0..n * n).all(|e| out.lhs[e] == out.lhs[e % n * n + e / n]), "{label}: not symmetric");
            let multipliers = n - n * slave.nodes() / (master.nodes() + 2 * slave.nodes());
            (0..n).for_each(|row| set(&mut part, block, row, if row < multipliers { 0.4 } else { 0.0 }));
            let shifted = size(system(&part, block, Request::Residual).rhs);
            assert!(shifted < 1e-13, "{label}: a rigid shift leaves {shifted:e}");
            walked += 1;
        }
    }
    assert!(walked > 0, "no tying formulation is registered");
}
