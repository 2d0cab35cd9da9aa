//! The unknowns and equations of a system over the ranks that share it.

use crate::assembly::{Distribution, Equations, Numbering, System};
use crate::communication::Ranks;
use crate::model::ModelPart;

/// Owners of the unknowns and numbers of the equations over all ranks; one rank alone has neither.
#[derive(Default)]
pub(super) struct ParallelLayout {
    ranks: Ranks,
    /// Owners of the unknowns.
    distribution: Option<Distribution>,
    /// Numbers of the equations.
    numbering: Option<Numbering>,
    /// Numbers where all unknowns count for equations; `None` where an unknown of any rank follows others.
    whole_numbering: Option<Numbering>,
}

impl ParallelLayout {
    /// Owners of the unknowns of `system`, which are numbered.
    pub fn new(part: &ModelPart, system: &System) -> Self {
        let distribution = Distribution::new(&system.dofs, part);
        Self { ranks: part.ranks.clone(), distribution, ..Self::default() }
    }

    /// Numbers the equations of all ranks; collective.
    pub fn number(&mut self, equations: &Equations) {
        self.numbering = self.distribution.as_ref().map(|d| Numbering::new(equations, d));
        let follows = self.ranks.any(equations.has_slaves());
        let numbering = self.numbering.as_ref().filter(|_| !follows);
        self.whole_numbering = numbering.map(|numbering| numbering.of_unknowns(equations));
    }

    /// The ranks that share the system.
    pub fn ranks(&self) -> &Ranks {
        &self.ranks
    }

    /// Owners of the unknowns; `None` when one rank has them all.
    pub fn distribution(&self) -> Option<&Distribution> {
        self.distribution.as_ref()
    }

    /// Numbers of the equations; `None` when one rank has them all.
    pub fn numbering(&self) -> Option<&Numbering> {
        self.numbering.as_ref()
    }

    /// Numbers where all unknowns count for equations; `None` when one rank has them all, or unknowns follow others.
    pub fn whole_numbering(&self) -> Option<&Numbering> {
        self.whole_numbering.as_ref()
    }

    /// On several ranks: replaces the values of this rank by their sums over all; collective.
    pub fn sum(&self, values: &mut [f64]) {
        if let Some(distribution) = &self.distribution {
            distribution.sum(values);
        }
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

    /// The solution of all equations of this rank, from those it owns; collective.
    pub fn complete(&self, equations: &Equations, own: &[f64]) -> Vec<f64> {
        let (Some(numbering), Some(distribution)) = (&self.numbering, &self.distribution) else { return own.to_vec() };
        let unknowns = equations.unknowns();
        let mut all = vec![0.0; equations.unknown_count()];
        let places = numbering.own.iter().map(|&equation| unknowns[equation as usize] as usize);
        places.zip(own).for_each(|(number, value)| all[number] = *value);
        distribution.spread(&mut all);
        unknowns.iter().map(|&number| all[number as usize]).collect()
    }
}
