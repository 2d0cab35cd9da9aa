//! Block principal pivoting: which violated conditions of a complementarity problem are exchanged next.
//!
//! Júdice and Pires (1994): all violated conditions change sides at once as long as their number falls, and in a few more rounds
//! where it does not. Then the one with the highest index changes alone (Murty 1974) until the number is below its least so far.
//! With a P-matrix, as of frictionless contact in small motions, single exchanges are finite and the least number only falls: the
//! whole is finite.

/// Rounds in which all conditions are exchanged although their number has not fallen.
const PATIENCE: usize = 10;

/// The conditions to exchange.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Exchange {
    /// All that are violated.
    All,
    /// The violated one with the highest index.
    Last,
}

/// The count of violated conditions over the rounds of one problem.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BlockPivoting {
    fewest: usize,
    patience: usize,
}

impl Default for BlockPivoting {
    fn default() -> Self {
        Self { fewest: usize::MAX, patience: PATIENCE }
    }
}

impl BlockPivoting {
    /// The exchange of a round in which this number of conditions is violated.
    pub fn next(&mut self, violated: usize) -> Exchange {
        if violated < self.fewest {
            *self = Self { fewest: violated, patience: PATIENCE };
            return Exchange::All;
        }
        if self.patience == 0 {
            return Exchange::Last;
        }
        self.patience -= 1;
        Exchange::All
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_change_while_their_number_falls_and_one_where_it_does_not() {
        let mut rule = BlockPivoting::default();
        assert_eq!([5, 3, 3, 4].map(|violated| rule.next(violated)), [Exchange::All; 4]);
        (0..PATIENCE - 2).for_each(|_| assert_eq!(rule.next(3), Exchange::All));
        assert_eq!(
            [3, 7, 2, 2].map(|violated| rule.next(violated)),
            [Exchange::Last, Exchange::Last, Exchange::All, Exchange::All]
        );
    }
}
