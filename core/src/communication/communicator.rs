//! Collective operations of ranks, and the single rank that needs none.

/// Communication of the ranks of a run: MPI, or another way that a program brings.
///
/// `gather…`, `exchange…` and `or` are collective: every rank calls them, in the same order.
pub trait Communicator: Send + Sync {
    /// Number of this rank, from 0.
    fn rank(&self) -> usize;

    /// Number of ranks.
    fn size(&self) -> usize;

    /// The bytes of every rank, by rank.
    fn gather_bytes(&self, own: &[u8]) -> Vec<Vec<u8>>;

    /// The numbers of every rank, by rank.
    fn gather_numbers(&self, own: &[f64]) -> Vec<Vec<f64>>;

    /// The bytes of every rank, one after another; each gives as many bytes.
    fn gather_equal_bytes(&self, own: &[u8]) -> Vec<u8>;

    /// Sets each bit that is set on any rank; collective.
    fn or(&self, bytes: &mut [u8]);

    /// The numbers of every rank, one after another; rank r gives `counts[r]` numbers.
    fn gather_counted(&self, own: &[f64], counts: &[usize]) -> Vec<f64>;

    /// The numbers of every rank, one after another; each gives as many numbers, few.
    fn gather_equal_numbers(&self, own: &[f64]) -> Vec<f64> {
        self.gather_counted(own, &vec![own.len(); self.size()])
    }

    /// As [`Communicator::gather_counted`], for rank 0 alone; the others get nothing.
    fn gather_to_root(&self, own: &[f64], counts: &[usize]) -> Vec<f64>;

    /// Sends `parts[r]` to rank r; returns the numbers from each rank.
    fn exchange_numbers(&self, parts: &[Vec<f64>]) -> Vec<Vec<f64>>;

    /// Sends `parts[r]` to rank r; returns the indices from each rank.
    fn exchange_indices(&self, parts: &[Vec<u32>]) -> Vec<Vec<u32>>;

    /// As [`Communicator::exchange_numbers`], where `counts` says how many numbers come from each rank: only those who send and
    /// receive wait for each other.
    fn exchange_counted(&self, parts: &[Vec<f64>], counts: &[usize]) -> Vec<Vec<f64>> {
        debug_assert_eq!(parts.len(), counts.len(), "one count a rank");
        self.exchange_numbers(parts)
    }

    /// Tells the other ranks, from rank 0, that the run has failed; not collective.
    fn announce_failure(&self);

    /// Whether rank 0 has said that the run failed; not collective.
    fn failure_is_announced(&self) -> bool;

    /// Ends all ranks at once with this exit code; not collective.
    fn abort(&self, code: u8) -> !;

    /// These ranks as PETSc sees them, which is started when it is not running; `None` where they are not those of
    /// MPI. Collective.
    #[cfg(feature = "petsc")]
    fn petsc(&self) -> Option<crate::diagnostics::Result<zelus_petsc::Communicator>> {
        None
    }
}

/// One rank alone.
pub(super) struct Serial;

impl Communicator for Serial {
    fn rank(&self) -> usize {
        0
    }

    fn size(&self) -> usize {
        1
    }

    fn gather_bytes(&self, own: &[u8]) -> Vec<Vec<u8>> {
        vec![own.to_vec()]
    }

    fn gather_numbers(&self, own: &[f64]) -> Vec<Vec<f64>> {
        vec![own.to_vec()]
    }

    fn gather_equal_bytes(&self, own: &[u8]) -> Vec<u8> {
        own.to_vec()
    }

    fn or(&self, _bytes: &mut [u8]) {}

    fn gather_counted(&self, own: &[f64], _counts: &[usize]) -> Vec<f64> {
        own.to_vec()
    }

    fn gather_to_root(&self, own: &[f64], _counts: &[usize]) -> Vec<f64> {
        own.to_vec()
    }

    fn exchange_numbers(&self, parts: &[Vec<f64>]) -> Vec<Vec<f64>> {
        parts.to_vec()
    }

    fn exchange_indices(&self, parts: &[Vec<u32>]) -> Vec<Vec<u32>> {
        parts.to_vec()
    }

    fn announce_failure(&self) {}

    fn failure_is_announced(&self) -> bool {
        true
    }

    fn abort(&self, code: u8) -> ! {
        std::process::exit(i32::from(code))
    }
}
