//! The ranks of a run as a value that is passed on with shared data.

use std::fmt;
use std::ops::Deref;
use std::sync::{Arc, Mutex};

use super::communicator::{Communicator, Serial};
use crate::diagnostics::Error;

/// The ranks that run together, as one of them sees them; clones are the same ranks.
///
/// By default this rank is alone.
#[derive(Clone)]
pub struct Ranks(Arc<Together>);

struct Together {
    communicator: Box<dyn Communicator>,
    /// An error of this rank that the others do not know of yet.
    deferred: Mutex<Option<Error>>,
}

impl Ranks {
    /// The ranks that `communicator` joins.
    pub fn new(communicator: impl Communicator + 'static) -> Self {
        Self(Arc::new(Together { communicator: Box::new(communicator), deferred: Mutex::default() }))
    }

    pub(super) fn deferred_error(&self) -> &Mutex<Option<Error>> {
        &self.0.deferred
    }
}

/// For solvers that work where the rows are.
impl zelus_linear_algebra::Ranks for Ranks {
    fn rank(&self) -> usize {
        (**self).rank()
    }

    fn size(&self) -> usize {
        (**self).size()
    }

    fn gather(&self, own: &[f64]) -> Vec<f64> {
        self.gather_equal_numbers(own)
    }

    fn exchange_counted(&self, parts: &[Vec<f64>], counts: &[usize]) -> Vec<Vec<f64>> {
        (**self).exchange_counted(parts, counts)
    }

    fn exchange_numbers(&self, parts: &[Vec<f64>]) -> Vec<Vec<f64>> {
        (**self).exchange_numbers(parts)
    }

    fn exchange_indices(&self, parts: &[Vec<u32>]) -> Vec<Vec<u32>> {
        (**self).exchange_indices(parts)
    }
}

impl Default for Ranks {
    fn default() -> Self {
        Self::new(Serial)
    }
}

impl Deref for Ranks {
    type Target = dyn Communicator;

    fn deref(&self) -> &Self::Target {
        self.0.communicator.as_ref()
    }
}

impl fmt::Debug for Ranks {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "rank {} of {}", self.rank(), self.size())
    }
}

/// The same place among as many ranks.
impl PartialEq for Ranks {
    fn eq(&self, other: &Self) -> bool {
        (self.rank(), self.size()) == (other.rank(), other.size())
    }
}

impl Eq for Ranks {}
