//! The factors of all fronts one after the other, in memory that serves again.

use crate::columns;
use crate::dense_lu::Pivots;
use crate::symbolic::Symbolic;

/// In which precision factors are kept; they are always computed in double precision.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Precision {
    /// Eight bytes a number.
    Double,
    /// Four bytes a number, of which refinement makes up for the digits lost.
    Single,
}

/// Numbers in either precision.
#[derive(Debug)]
pub(super) enum Values {
    Double(Vec<f64>),
    Single(Vec<f32>),
}

/// The place of one trapezoid.
pub(super) enum Slot<'a> {
    Double(&'a mut [f64]),
    Single(&'a mut [f32]),
}

impl Default for Values {
    fn default() -> Self {
        Self::Double(Vec::new())
    }
}

impl Values {
    /// Makes room for numbers of any value.
    fn reserve(&mut self, len: usize, precision: Precision) {
        let fits = match self {
            Self::Double(values) => precision == Precision::Double && values.len() == len,
            Self::Single(values) => precision == Precision::Single && values.len() == len,
        };
        if !fits {
            // The old memory is given back before the new is asked for.
            *self = Self::default();
            *self = match precision {
                Precision::Double => Self::Double(vec![0.0; len]),
                Precision::Single => Self::Single(vec![0.0; len]),
            };
        }
    }

    fn slots(&mut self, starts: &[usize]) -> Vec<Slot<'_>> {
        match self {
            Self::Double(values) => pieces(values, starts).into_iter().map(Slot::Double).collect(),
            Self::Single(values) => pieces(values, starts).into_iter().map(Slot::Single).collect(),
        }
    }
}

/// The parts of `values` between consecutive `starts`; all empty when there are no values.
fn pieces<'a, T>(values: &'a mut [T], starts: &[usize]) -> Vec<&'a mut [T]> {
    let mut rest = values;
    let piece = |ends: &[usize]| {
        let len = if rest.is_empty() { 0 } else { ends[1] - ends[0] };
        let (piece, tail) = std::mem::take(&mut rest).split_at_mut(len);
        rest = tail;
        piece
    };
    starts.windows(2).map(piece).collect()
}

impl Slot<'_> {
    /// Keeps the trapezoid of a matrix whose column `k` is `column(k)`.
    pub(super) fn keep_columns<'c>(&mut self, order: usize, pivots: usize, column: impl Fn(usize) -> &'c [f64] + Sync) {
        match self {
            Self::Double(to) => columns::keep_columns(to, order, pivots, column),
            Self::Single(to) => columns::keep_columns(to, order, pivots, column),
        }
    }

    /// Keeps the trapezoid of a matrix whose row `i` is `row(i)`.
    pub(super) fn keep_rows<'c>(&mut self, order: usize, pivots: usize, row: impl Fn(usize) -> &'c [f64] + Sync) {
        match self {
            Self::Double(to) => columns::keep_rows(to, order, pivots, row),
            Self::Single(to) => columns::keep_rows(to, order, pivots, row),
        }
    }
}

/// Where the factors of one front go.
pub(super) struct FactorBlock<'a> {
    pub(super) lower: Slot<'a>,
    pub(super) upper: Slot<'a>,
    pub(super) pivots: &'a mut Pivots,
}

/// The factors `L` and, where it is another one, `Uᵀ`: a lower trapezoid for each front.
#[derive(Debug, Default)]
pub(super) struct Store {
    lower: Values,
    upper: Values,
    pub(super) pivots: Vec<Pivots>,
    /// Where the trapezoid of each front starts, and where the last one ends.
    starts: Vec<usize>,
    orders: Vec<[usize; 2]>,
}

impl Store {
    /// Makes room, whose numbers are of any value.
    pub(super) fn reserve(&mut self, symbolic: &Symbolic, symmetric: bool, precision: Precision) {
        let fronts = &symbolic.fronts[..symbolic.eliminated_fronts()];
        self.orders = fronts.iter().map(|front| [front.order(), front.pivots()]).collect();
        let mut end = 0;
        self.starts = vec![0];
        self.starts.extend(self.orders.iter().map(|&[order, pivots]| {
            end += columns::trapezoid(order, pivots);
            end
        }));
        self.lower.reserve(end, precision);
        self.upper.reserve(if symmetric { 0 } else { end }, precision);
        self.pivots.resize_with(fronts.len(), Pivots::default);
    }

    pub(super) fn precision(&self) -> Precision {
        match self.lower {
            Values::Double(_) => Precision::Double,
            Values::Single(_) => Precision::Single,
        }
    }

    pub(super) fn blocks(&mut self) -> Vec<FactorBlock<'_>> {
        let lower = self.lower.slots(&self.starts);
        let upper = self.upper.slots(&self.starts);
        let slots = lower.into_iter().zip(upper).zip(&mut self.pivots);
        slots.map(|((lower, upper), pivots)| FactorBlock { lower, upper, pivots }).collect()
    }

    /// The diagonal of the lower factor of a front.
    pub(super) fn diagonal(&self, front: usize) -> Vec<f64> {
        let [order, pivots] = self.orders[front];
        match &self.lower {
            Values::Double(values) => columns::diagonal(&values[self.starts[front]..], order, pivots),
            Values::Single(values) => columns::diagonal(&values[self.starts[front]..], order, pivots),
        }
    }

    /// Solves with `L` of a front; the rest of `local` loses the part of the pivots.
    pub(super) fn forward(&self, front: usize, local: &mut [f64]) {
        let (range, [_, pivots]) = (self.starts[front]..self.starts[front + 1], self.orders[front]);
        match &self.lower {
            Values::Double(values) => columns::forward(&values[range], pivots, local),
            Values::Single(values) => columns::forward(&values[range], pivots, local),
        }
    }

    /// Solves with `U`, or `Lᵀ` where there is no `U`, of a front, the entries of `local` after the pivots being known.
    pub(super) fn backward(&self, front: usize, symmetric: bool, local: &mut [f64]) {
        let (range, [_, pivots]) = (self.starts[front]..self.starts[front + 1], self.orders[front]);
        match if symmetric { &self.lower } else { &self.upper } {
            Values::Double(values) => columns::backward(&values[range], pivots, local),
            Values::Single(values) => columns::backward(&values[range], pivots, local),
        }
    }
}
