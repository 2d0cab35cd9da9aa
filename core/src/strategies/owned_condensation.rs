//! The rows of this rank without multipliers, for multigrid over all ranks.
//!
//! Every rank gets the rows of all nodes with multipliers, which are few, and condenses its own rows with them.

use zelus_linear_algebra::{Condensation, CondensationSettings, Csr, Layout, NotCondensable, Symmetry, System};

use crate::communication::world;

/// Largest share of a multiplier on other slave nodes: nothing corrects here for what the condensation leaves out.
const OFF_NODE: f64 = 1e-14;

/// Owned rows of a condensed system; equations count over all ranks, those of rank 0 first.
pub(super) struct OwnedCondensation {
    condensation: Condensation,
    /// Equations left of each rank, as the whole system counts them.
    pub(super) equations: Vec<Vec<u32>>,
    pub(super) row_starts: Vec<usize>,
    pub(super) columns: Vec<u64>,
    pub(super) values: Vec<f64>,
}

impl OwnedCondensation {
    /// Condenses the rows `(equation, columns, values)` of this rank; `equations` are those of each rank. Collective.
    ///
    /// # Errors
    /// The same on all ranks: why the multipliers cannot be condensed.
    pub(super) fn new<'r>(
        rows: impl Iterator<Item = (u32, Vec<u32>, &'r [f64])>,
        equations: &[Vec<u32>],
        layout: &Layout,
        settings: &CondensationSettings,
    ) -> Result<Self, NotCondensable> {
        let world = world();
        let mut has_multipliers = vec![false; layout.node.iter().max().map_or(0, |&node| node as usize + 1)];
        let multipliers = layout.node.iter().zip(&layout.multiplier).filter(|(_, multiplier)| **multiplier);
        multipliers.for_each(|(&node, _)| has_multipliers[node as usize] = true);
        let mut triplets = Vec::new();
        // Row, column, value; numbers below 2^32 are exact in floating point.
        let mut shared = Vec::new();
        for (row, columns, values) in rows {
            let entries = columns.iter().zip(values);
            if has_multipliers[layout.node[row as usize] as usize] {
                entries.for_each(|(&column, &value)| shared.extend([f64::from(row), f64::from(column), value]));
            } else {
                triplets.extend(entries.map(|(&column, &value)| (row as usize, column as usize, value)));
            }
        }
        for entry in world.gather_numbers(&shared).iter().flat_map(|list| list.chunks_exact(3)) {
            triplets.push((entry[0] as usize, entry[1] as usize, entry[2]));
        }
        let matrix = Csr::from_triplets(layout.equations(), &triplets);
        let settings = CondensationSettings { off_node: settings.off_node.min(OFF_NODE), ..*settings };
        let condensed = Condensation::new(&System::bulk(layout, &matrix, Symmetry::General), &settings, 0);
        let refused = condensed.as_ref().err().map_or_else(Vec::new, encode);
        if let Some(refused) = world.gather_numbers(&refused).iter().find(|refused| !refused.is_empty()) {
            return Err(decode(refused));
        }
        let condensation = condensed?;
        let left: Vec<Vec<u32>> = equations
            .iter()
            .map(|list| list.iter().copied().filter(|&e| !layout.multiplier[e as usize]).collect())
            .collect();
        let kept = condensation.equations();
        let place = |equation: u32| kept.partition_point(|&e| e < equation);
        let mut number = vec![0_u64; kept.len()];
        left.iter().flatten().enumerate().for_each(|(new, &equation)| number[place(equation)] = new as u64);
        let bulk = condensation.system().bulk;
        let (mut row_starts, mut columns, mut values) = (vec![0], Vec::new(), Vec::new());
        for &equation in &left[world.rank()] {
            let (of_row, of_values) = bulk.row(place(equation));
            let mut entries: Vec<(u64, f64)> =
                of_row.iter().map(|&c| number[c as usize]).zip(of_values.iter().copied()).collect();
            entries.sort_unstable_by_key(|(column, _)| *column);
            columns.extend(entries.iter().map(|(column, _)| *column));
            values.extend(entries.iter().map(|(_, value)| *value));
            row_starts.push(columns.len());
        }
        Ok(Self { condensation, equations: left, row_starts, columns, values })
    }

    /// Right-hand side of the rows of this rank, for one of the whole system.
    pub(super) fn reduce(&self, rhs: &[f64]) -> Vec<f64> {
        let reduced = self.condensation.reduce(rhs);
        let kept = self.condensation.equations();
        let own = self.equations[world().rank()].iter();
        own.map(|&equation| reduced[kept.partition_point(|&e| e < equation)]).collect()
    }

    /// Completes a solution that has all but the multipliers.
    pub(super) fn recover(&self, rhs: &[f64], x: &mut [f64]) {
        let left: Vec<f64> = self.condensation.equations().iter().map(|&equation| x[equation as usize]).collect();
        self.condensation.expand(rhs, &left, x);
    }
}

fn encode(refused: &NotCondensable) -> Vec<f64> {
    match *refused {
        NotCondensable::OffNode { multiplier, equation, share } => vec![multiplier as f64, equation as f64, share],
        NotCondensable::Undetermined { multiplier, share } => vec![multiplier as f64, share],
    }
}

fn decode(refused: &[f64]) -> NotCondensable {
    let multiplier = refused[0] as usize;
    match refused[1..] {
        [equation, share] => NotCondensable::OffNode { multiplier, equation: equation as usize, share },
        _ => NotCondensable::Undetermined { multiplier, share: refused[1] },
    }
}
