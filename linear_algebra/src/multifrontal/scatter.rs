//! Where each entry of a matrix goes in the fronts of its factorisation.

use crate::csr::Csr;
use crate::parallel;
use crate::symbolic::Symbolic;

/// One entry of the matrix.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Entry {
    /// Index in the values of the matrix.
    pub(crate) source: u32,
    /// Index in the pivot columns of the front, followed by the pivot rows right of the pivots.
    pub(crate) target: u32,
}

/// The entries of every front; those of the lower triangle (in elimination order) come first.
#[derive(Debug)]
pub(crate) struct Scatter {
    entries: Vec<Vec<Entry>>,
    lower: Vec<usize>,
}

impl Scatter {
    /// Finds the place of each entry of `pattern`; of a symmetric matrix only the lower triangle is kept.
    pub(crate) fn new(symbolic: &Symbolic, pattern: &Csr, symmetric: bool) -> Self {
        let transposed = (!symmetric).then(|| Transposed::new(pattern));
        let of_front = |front: usize| entries_of(symbolic, pattern, transposed.as_ref(), front);
        let (entries, lower) = parallel::map(symbolic.fronts.len(), 16, of_front).into_iter().unzip();
        Self { entries, lower }
    }

    /// The entries of a front, of both triangles or of the lower one.
    pub(crate) fn of(&self, front: usize, lower_only: bool) -> &[Entry] {
        let entries = &self.entries[front];
        if lower_only { &entries[..self.lower[front]] } else { entries }
    }
}

/// Columns of a pattern: row and place of each entry.
struct Transposed {
    starts: Vec<usize>,
    entries: Vec<(u32, u32)>,
}

impl Transposed {
    fn new(pattern: &Csr) -> Self {
        let mut starts = vec![0; pattern.rows + 1];
        for j in pattern.columns_of_entries() {
            starts[j as usize + 1] += 1;
        }
        for j in 0..pattern.rows {
            starts[j + 1] += starts[j];
        }
        let mut next = starts.clone();
        let mut entries = vec![(0, 0); pattern.entries()];
        for i in 0..pattern.rows {
            for (&j, at) in pattern.columns_of(i).iter().zip(pattern.row_starts[i] as u32..) {
                let slot = &mut next[j as usize];
                entries[*slot] = (i as u32, at);
                *slot += 1;
            }
        }
        Self { starts, entries }
    }

    fn column(&self, j: usize) -> &[(u32, u32)] {
        &self.entries[self.starts[j]..self.starts[j + 1]]
    }
}

fn entries_of(
    symbolic: &Symbolic,
    pattern: &Csr,
    transposed: Option<&Transposed>,
    front: usize,
) -> (Vec<Entry>, usize) {
    let front = &symbolic.fronts[front];
    let (begin, end, pivots, order) = (front.columns.start, front.columns.end, front.pivots(), front.order());
    let local = |position: usize| {
        if position < end {
            position - begin
        } else {
            pivots + front.rows.binary_search(&(position as u32)).expect("the front has every row of its entries")
        }
    };
    let mut entries = Vec::new();
    for p in front.columns.clone() {
        let j = symbolic.equation[p] as usize;
        let mut add = |i: u32, source: u32| {
            if let Some(q) = symbolic.position_of(i).filter(|&q| q >= p) {
                entries.push(Entry { source, target: (local(q) + (p - begin) * order) as u32 });
            }
        };
        match transposed {
            Some(transposed) => transposed.column(j).iter().for_each(|&(i, source)| add(i, source)),
            // A column of a symmetric matrix is its row.
            None => {
                let start = pattern.row_starts[j] as u32;
                pattern.columns_of(j).iter().zip(start..).for_each(|(&i, source)| add(i, source));
            }
        }
    }
    let lower = entries.len();
    if transposed.is_some() {
        for p in front.columns.clone() {
            let i = symbolic.equation[p];
            let start = pattern.row_starts[i as usize];
            for (at, &j) in pattern.columns_of(i as usize).iter().enumerate() {
                if let Some(q) = symbolic.position_of(j).filter(|&q| q > p) {
                    let target = match local(q) {
                        column if column < pivots => p - begin + column * order,
                        column => order * pivots + p - begin + (column - pivots) * pivots,
                    };
                    entries.push(Entry { source: (start + at) as u32, target: target as u32 });
                }
            }
        }
    }
    entries.shrink_to_fit();
    (entries, lower)
}
