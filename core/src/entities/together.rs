//! Work of entities that is cheaper for many of them at once, as a call into another program is.
//!
//! A range of entities is computed in a first round, in which such work is noted. Where there is some, it is done together, and the range
//! is computed once more, with the results. Both rounds are of one thread.

use std::cell::{Cell, RefCell};

use super::EntityError;

/// Where the computation of a range of entities stands on this thread.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Round {
    /// There is none: work is done at once.
    Alone,
    /// Work is noted, and what is computed does not count. The number is that of the range.
    Noting(u64),
    /// Results of the noted work are taken in the order in which it was noted.
    Taking,
}

/// Does the work that a range has noted.
///
/// # Errors
/// The id of the element whose work fails, and why.
pub type Work = fn() -> Result<(), (usize, String)>;

const REMEDY: &str = "a shorter step may help where the deformation is the cause";

thread_local! {
    static ROUND: Cell<Round> = const { Cell::new(Round::Alone) };
    static RANGES: Cell<u64> = const { Cell::new(0) };
    static NOTED: RefCell<Vec<Work>> = const { RefCell::new(Vec::new()) };
}

/// The round of this thread.
pub fn round() -> Round {
    ROUND.get()
}

/// Notes work of this range, once for all entities that share it.
pub fn note(work: Work) {
    NOTED.with_borrow_mut(|noted| noted.push(work));
}

/// Ends the rounds of a range, however they end.
struct Rounds;

impl Drop for Rounds {
    fn drop(&mut self) {
        ROUND.set(Round::Alone);
        NOTED.with_borrow_mut(Vec::clear);
    }
}

/// Computes a range of entities: `compute` is called once, and again where entities have noted work.
///
/// ```
/// use std::cell::RefCell;
/// use zelus_core::entities::{Round, note, round, together};
///
/// thread_local! { static ROOTS: RefCell<Vec<f64>> = RefCell::default(); }
/// fn take_roots() -> Result<(), (usize, String)> {
///     ROOTS.with_borrow_mut(|numbers| numbers.iter_mut().for_each(|x| *x = x.sqrt()));
///     Ok(())
/// }
/// let mut found = Vec::new();
/// together(&mut || {
///     found.clear();
///     for (at, x) in [4.0, 9.0].into_iter().enumerate() {
///         match round() {
///             Round::Noting(_) if at == 0 => { note(take_roots); ROOTS.set(vec![x]) }
///             Round::Noting(_) => ROOTS.with_borrow_mut(|numbers| numbers.push(x)),
///             _ => found.push(ROOTS.with_borrow(|numbers| numbers[at])),
///         }
///     }
///     Ok(())
/// })?;
/// assert_eq!(found, [2.0, 3.0]);
/// # Ok::<(), zelus_core::entities::EntityError>(())
/// ```
///
/// # Errors
/// An error of `compute` or of the work.
pub fn together(compute: &mut dyn FnMut() -> Result<(), EntityError>) -> Result<(), EntityError> {
    let _rounds = Rounds;
    RANGES.set(RANGES.get() + 1);
    ROUND.set(Round::Noting(RANGES.get()));
    compute()?;
    let noted = NOTED.take();
    if noted.is_empty() {
        return Ok(());
    }
    for work in noted {
        work().map_err(|(id, fact)| EntityError { kind: "element", id, nodes: Vec::new(), fact, remedy: REMEDY })?;
    }
    ROUND.set(Round::Taking);
    compute()
}
