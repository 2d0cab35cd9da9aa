//! The rows of this rank without multipliers, for multigrid over all ranks.
//!
//! Every rank gets the rows of all nodes with multipliers, which are few, and condenses its own rows with them.

use rustc_hash::{FxHashMap, FxHashSet};
use zelus_linear_algebra::{Condensation, CondensationSettings, Csr, Layout, NotCondensable, Symmetry, System};

use crate::assembly::Numbering;
use crate::communication::Ranks;

/// Largest share of a multiplier on other slave nodes: nothing corrects here for terms that the condensation leaves out.
const OFF_NODE: f64 = 1e-14;

/// Place of the node of an equation in the whole mesh, and whether it is a multiplier, by the equation's number.
pub(super) type RowOwners = FxHashMap<u32, (u32, bool)>;

/// Owned rows of a condensed system, whose equations count over all ranks, those of rank 0 first.
pub(super) struct PetscCondensation {
    condensation: Condensation,
    /// Numbers of the equations that the condensation sees, ascending.
    seen: Vec<u32>,
    /// Equation of this rank for each of them, where it has one.
    here: Vec<Option<u32>>,
    /// Numbers of all multipliers, ascending.
    multipliers: Vec<u32>,
    /// Equations left that this rank owns, as it counts its equations.
    pub(super) own: Vec<u32>,
    /// Number of the first of them among all that are left.
    pub(super) first: usize,
    pub(super) row_starts: Vec<usize>,
    pub(super) columns: Vec<u64>,
    pub(super) values: Vec<f64>,
}

impl PetscCondensation {
    /// Condenses the rows `(number, columns, values)` of this rank; `row_owners` knows the equations in them, `multiplier` says
    /// which equations of this rank are multipliers. Collective.
    ///
    /// # Errors
    /// The same on all ranks: why the multipliers cannot be condensed, by numbers over all ranks.
    pub(super) fn new<'r>(
        ranks: &Ranks,
        rows: impl Iterator<Item = (u32, &'r [u64], &'r [f64])>,
        row_owners: &RowOwners,
        numbering: &Numbering,
        multiplier: &[bool],
        settings: &CondensationSettings,
    ) -> Result<Self, NotCondensable> {
        // Multipliers are on every rank.
        let of_here = numbering.numbers.iter().zip(multiplier).filter(|(_, multiplier)| **multiplier);
        let mut multipliers: Vec<u32> = of_here.map(|(&number, _)| number).collect();
        multipliers.sort_unstable();
        let (known, entries) = Self::rows_of_all(ranks, rows, row_owners, &multipliers);
        let mut seen: Vec<u32> = known.keys().copied().collect();
        seen.sort_unstable();
        let at = |number: u32| seen.partition_point(|&other| other < number);
        let mut places: Vec<u32> = known.values().map(|(place, _)| *place).collect();
        places.sort_unstable();
        places.dedup();
        let layout = Layout {
            node: seen.iter().map(|number| places.partition_point(|&p| p < known[number].0) as u32).collect(),
            multiplier: seen.iter().map(|number| known[number].1).collect(),
            ..Layout::default()
        };
        let triplets: Vec<(usize, usize, f64)> = entries.iter().map(|&(r, c, value)| (at(r), at(c), value)).collect();
        let matrix = Csr::from_triplets(seen.len(), &triplets);
        let settings = CondensationSettings { off_node: settings.off_node.min(OFF_NODE), ..*settings };
        let condensed = Condensation::new(&System::bulk(&layout, &matrix, Symmetry::General), &settings, 0);
        let refused = condensed.as_ref().err().map_or_else(Vec::new, |refused| encode(refused, &seen));
        if let Some(refused) = ranks.gather_numbers(&refused).iter().find(|refused| !refused.is_empty()) {
            return Err(decode(refused));
        }
        let condensation = condensed?;
        let own: Vec<u32> = numbering.own.iter().copied().filter(|&e| !multiplier[e as usize]).collect();
        let left_before = |number: u32| number as usize - multipliers.partition_point(|&m| m < number);
        let kept = condensation.equations();
        let bulk = condensation.system().bulk;
        let (mut row_starts, mut columns, mut values) = (vec![0], Vec::new(), Vec::new());
        for &equation in &own {
            let row = at(numbering.numbers[equation as usize]);
            let (of_row, of_values) = bulk.row(kept.partition_point(|&e| (e as usize) < row));
            let number = |&column: &u32| left_before(seen[kept[column as usize] as usize]) as u64;
            let mut entries: Vec<(u64, f64)> = of_row.iter().map(number).zip(of_values.iter().copied()).collect();
            entries.sort_unstable_by_key(|(column, _)| *column);
            columns.extend(entries.iter().map(|(column, _)| *column));
            values.extend(entries.iter().map(|(_, value)| *value));
            row_starts.push(columns.len());
        }
        let first = left_before(numbering.starts[ranks.rank()] as u32);
        let equations: FxHashMap<u32, u32> =
            numbering.numbers.iter().enumerate().map(|(equation, &number)| (number, equation as u32)).collect();
        let here = seen.iter().map(|number| equations.get(number).copied()).collect();
        Ok(Self { condensation, seen, here, multipliers, own, first, row_starts, columns, values })
    }

    /// The rows of this rank and those of all nodes with multipliers as (row, column, value), and the equations in them;
    /// collective.
    fn rows_of_all<'r>(
        ranks: &Ranks,
        rows: impl Iterator<Item = (u32, &'r [u64], &'r [f64])>,
        row_owners: &RowOwners,
        multipliers: &[u32],
    ) -> (RowOwners, Vec<(u32, u32, f64)>) {
        let with_multipliers: FxHashSet<u32> = multipliers.iter().map(|number| row_owners[number].0).collect();
        let mut known: RowOwners = multipliers.iter().map(|number| (*number, row_owners[number])).collect();
        let mut entries = Vec::new();
        // Row and column, each with its node and kind, and the value; numbers below 2^32 are exact in floating point.
        let mut shared = Vec::new();
        let packed = |number: u32| {
            let (place, multiplier) = row_owners[&number];
            [f64::from(number), f64::from(place), f64::from(u8::from(multiplier))]
        };
        for (row, columns, values) in rows {
            known.insert(row, row_owners[&row]);
            let of_row = columns.iter().map(|&column| column as u32).zip(values);
            if with_multipliers.contains(&row_owners[&row].0) {
                of_row.for_each(|(column, &value)| {
                    shared.extend(packed(row));
                    shared.extend(packed(column));
                    shared.push(value);
                });
            } else {
                for (column, &value) in of_row {
                    known.insert(column, row_owners[&column]);
                    entries.push((row, column, value));
                }
            }
        }
        for entry in ranks.gather_numbers(&shared).iter().flat_map(|list| list.chunks_exact(7)) {
            for equation in [&entry[..3], &entry[3..6]] {
                known.insert(equation[0] as u32, (equation[1] as u32, equation[2] != 0.0));
            }
            entries.push((entry[0] as u32, entry[3] as u32, entry[6]));
        }
        (known, entries)
    }

    /// Right-hand side of the rows of this rank, for one of the equations it has.
    pub(super) fn reduce(&self, rhs: &[f64]) -> Vec<f64> {
        let reduced = self.condensation.reduce(&self.of_seen(rhs));
        let mut of_here = vec![0.0; rhs.len()];
        for (&equation, value) in self.condensation.equations().iter().zip(reduced) {
            if let Some(here) = self.here[equation as usize] {
                of_here[here as usize] = value;
            }
        }
        self.own.iter().map(|&equation| of_here[equation as usize]).collect()
    }

    /// Completes a solution over the equations of this rank that has all but the multipliers.
    pub(super) fn recover(&self, rhs: &[f64], x: &mut [f64]) {
        let known = self.of_seen(x);
        let left: Vec<f64> = self.condensation.equations().iter().map(|&e| known[e as usize]).collect();
        let mut all = vec![0.0; known.len()];
        self.condensation.expand(&self.of_seen(rhs), &left, &mut all);
        for number in &self.multipliers {
            let at = self.seen.partition_point(|other| other < number);
            if let Some(here) = self.here[at] {
                x[here as usize] = all[at];
            }
        }
    }

    /// Number over all ranks of an equation that is left, by its number among those.
    pub(super) fn number_before(&self, left: usize) -> usize {
        let later = |number: usize, &multiplier: &u32| number + usize::from(multiplier as usize <= number);
        self.multipliers.iter().fold(left, later)
    }

    /// A vector over the equations of this rank as the condensation counts them; zero at those of others.
    fn of_seen(&self, values: &[f64]) -> Vec<f64> {
        self.here.iter().map(|here| here.map_or(0.0, |equation| values[equation as usize])).collect()
    }
}

fn encode(refused: &NotCondensable, seen: &[u32]) -> Vec<f64> {
    let number = |equation: usize| f64::from(seen[equation]);
    match *refused {
        NotCondensable::OffNode { multiplier, equation, share } => vec![number(multiplier), number(equation), share],
        NotCondensable::Undetermined { multiplier, share } => vec![number(multiplier), share],
    }
}

fn decode(refused: &[f64]) -> NotCondensable {
    let multiplier = refused[0] as usize;
    match refused[1..] {
        [equation, share] => NotCondensable::OffNode { multiplier, equation: equation as usize, share },
        _ => NotCondensable::Undetermined { multiplier, share: refused[1] },
    }
}
