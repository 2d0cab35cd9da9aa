//! What the ranks that share a system add up and tell each other.

use super::Assembler;
use crate::assembly::{Distribution, Numbering};
use crate::communication::Ranks;
use crate::model::{Carriers, Halo, Named, ScalarVariable, named};

impl Assembler {
    /// On several ranks: replaces what this rank has by the sum over all; collective.
    pub(super) fn add_up(&self, values: &mut [f64]) {
        if let Some(distribution) = &self.distribution {
            distribution.sum(values);
        }
    }

    /// The processes that assemble the system together.
    pub fn ranks(&self) -> &Ranks {
        &self.ranks
    }

    /// Which rank owns which unknown; `None` when one process computes everything.
    pub fn distribution(&self) -> Option<&Distribution> {
        self.distribution.as_ref()
    }

    /// The equations of all ranks; `None` when one process has them all.
    pub fn numbering(&self) -> Option<&Numbering> {
        self.numbering.as_ref()
    }

    /// The solution of all equations this rank has, from those it owns; collective.
    pub fn complete(&self, own: &[f64]) -> Vec<f64> {
        let (Some(numbering), Some(distribution)) = (&self.numbering, &self.distribution) else { return own.to_vec() };
        let unknowns = self.equations.unknowns();
        let mut all = vec![0.0; self.equations.unknown_count()];
        let places = numbering.own.iter().map(|&equation| unknowns[equation as usize] as usize);
        places.zip(own).for_each(|(number, value)| all[number] = *value);
        distribution.spread(&mut all);
        unknowns.iter().map(|&number| all[number as usize]).collect()
    }

    /// Whether an unknown counts here in sums over all ranks.
    pub fn counts(&self, number: usize) -> bool {
        self.distribution.as_ref().is_none_or(|distribution| distribution.is_own(number))
    }

    /// The sum of one number of each rank that has a share of the system; collective.
    pub fn total(&self, own: f64) -> f64 {
        self.distribution.as_ref().map_or(own, |distribution| distribution.ranks().total(own))
    }

    /// Σ a b over the unknowns of all ranks; collective.
    pub fn dot(&self, a: &[f64], b: &[f64]) -> f64 {
        let own = (0..a.len()).filter(|&number| self.counts(number)).map(|number| a[number] * b[number]).sum::<f64>();
        self.total(own)
    }
}

/// The nodes that carry each unknown on any rank; collective.
pub(super) fn carriers_of_all(own: Vec<Carriers>, nodes: usize, halo: &Halo) -> Vec<Carriers> {
    let names: Vec<String> = own.iter().map(|own| own.variable.to_string()).collect();
    let mut all: Vec<String> = halo
        .ranks
        .gather_bytes(names.join("\n").as_bytes())
        .iter()
        .flat_map(|text| String::from_utf8_lossy(text).lines().map(str::to_owned).collect::<Vec<_>>())
        .collect();
    all.sort_unstable();
    all.dedup();
    let scalar = |name: &String| match named(name).expect("unknowns are registered variables") {
        Named::Component(scalar) => scalar,
        Named::Whole(column, _) => ScalarVariable { column, component: None },
    };
    all.iter()
        .map(scalar)
        .map(|variable| {
            let mut carries = vec![0.0; nodes];
            let mine = own.iter().filter(|known| known.variable == variable).flat_map(|known| &known.nodes);
            mine.for_each(|&node| carries[node as usize] = 1.0);
            halo.sum(&mut carries);
            let list = (0..nodes as u32).filter(|&node| carries[node as usize] > 0.0).collect();
            Carriers::of_nodes(variable, list)
        })
        .collect()
}
