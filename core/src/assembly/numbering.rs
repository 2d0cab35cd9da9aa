//! The equations of all ranks in one row: those rank 0 owns come first, then those of rank 1 and so on.

use super::distribution::Distribution;
use super::dof_table::NONE;
use super::equations::Equations;

/// Numbers over all ranks of the equations this rank has.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Numbering {
    /// First number of each rank, and the number of all equations.
    pub starts: Vec<usize>,
    /// Number of each equation this rank has; [`NONE`](super::NONE) where unknowns are counted and one is inactive.
    pub numbers: Vec<u32>,
    /// Equations this rank owns, ascending, as they are counted here.
    pub own: Vec<u32>,
}

impl Numbering {
    /// The numbers of `equations`; collective.
    pub fn new(equations: &Equations, distribution: &Distribution) -> Self {
        let unknowns = equations.unknowns();
        let is_own = |&e: &u32| distribution.is_own(unknowns[e as usize] as usize);
        let own: Vec<u32> = (0..unknowns.len() as u32).filter(is_own).collect();
        let mut starts = vec![0];
        for count in distribution.ranks().gather_numbers(&[own.len() as f64]) {
            starts.push(starts[starts.len() - 1] + count[0] as usize);
        }
        let first = starts[distribution.ranks().rank()];
        // Numbers below 2^32 are exact in floating point.
        let mut of_unknowns = vec![0.0; equations.unknown_count()];
        own.iter().enumerate().for_each(|(at, &e)| of_unknowns[unknowns[e as usize] as usize] = (first + at) as f64);
        distribution.spread(&mut of_unknowns);
        let numbers = unknowns.iter().map(|&n| of_unknowns[n as usize] as u32).collect();
        Self { starts, numbers, own }
    }

    /// The same numbers where all unknowns count for equations, of which none follow others and some are inactive.
    pub(super) fn of_unknowns(&self, equations: &Equations) -> Self {
        let unknowns = equations.unknowns();
        let mut numbers = vec![NONE; equations.unknown_count()];
        unknowns.iter().zip(&self.numbers).for_each(|(&unknown, &number)| numbers[unknown as usize] = number);
        let own = self.own.iter().map(|&equation| unknowns[equation as usize]).collect();
        Self { starts: self.starts.clone(), numbers, own }
    }

    /// The number of an equation, where it has one.
    pub fn number(&self, equation: u32) -> Option<u32> {
        Some(self.numbers[equation as usize]).filter(|&number| number != NONE)
    }

    /// The equations that have a number, each with it.
    pub fn numbered(&self) -> impl Iterator<Item = (u32, u32)> + '_ {
        (0..).zip(&self.numbers).map(|(equation, &number)| (equation, number)).filter(|(_, number)| *number != NONE)
    }

    /// Equations each rank owns.
    pub fn counts(&self) -> Vec<usize> {
        self.starts.windows(2).map(|pair| pair[1] - pair[0]).collect()
    }

    /// The rank that owns an equation, by its number.
    pub fn owner(&self, number: u32) -> usize {
        self.starts.partition_point(|&start| start <= number as usize) - 1
    }

    /// Entries of a vector over its equations that this rank owns.
    pub fn own_of(&self, values: &[f64]) -> Vec<f64> {
        self.own.iter().map(|&e| values[e as usize]).collect()
    }
}
