//! PETSc itself, running as long as somebody needs it, and the ranks it runs on.

use std::ffi::{CStr, c_int, c_void};

use zelus_linear_algebra::SolveError;

use crate::ffi;

/// PETSc running; ends when dropped, so keep it to the end of the program.
///
/// Where MPI is running already, as started by another crate, it is left running.
#[derive(Debug)]
pub struct Session(());

impl Session {
    /// Starts PETSc, and MPI when it is not running. Collective.
    ///
    /// # Errors
    /// [`SolveError::Failed`] when PETSc cannot start.
    pub fn start() -> Result<Self, SolveError> {
        // SAFETY: may be called at any time, also twice; it takes nothing.
        check("PETSc cannot start", unsafe { ffi::zp_start() })?;
        Ok(Self(()))
    }

    /// All ranks that were started together.
    pub fn world(&self) -> Communicator {
        // SAFETY: the pointer is to a static of PETSc, which is running.
        Communicator { raw: unsafe { ffi::zp_world() } }
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        // SAFETY: ends PETSc only when it was started by a session.
        unsafe { ffi::zp_end() };
    }
}

/// A communicator of MPI, known by where its handle is stored.
#[derive(Debug, Clone, Copy)]
pub struct Communicator {
    raw: *const c_void,
}

// SAFETY: the handle is only read; MPI is started with threads serialised, and every use is collective.
unsafe impl Send for Communicator {}

impl Communicator {
    /// The communicator whose `MPI_Comm` is stored at `handle`.
    ///
    /// # Safety
    /// `handle` points to a valid `MPI_Comm` of the MPI library PETSc is linked with, for as long as this is used.
    pub unsafe fn from_raw(handle: *const c_void) -> Self {
        Self { raw: handle }
    }

    pub(crate) fn raw(self) -> *const c_void {
        self.raw
    }

    /// Number of this rank, from 0, and number of ranks.
    pub fn rank_and_size(self) -> (usize, usize) {
        let (mut rank, mut size): (c_int, c_int) = (0, 1);
        // SAFETY: the communicator is valid, the results are written to locals.
        unsafe { ffi::zp_rank_and_size(self.raw, &mut rank, &mut size) };
        (rank as usize, size as usize)
    }

    /// Whether all ranks say so. Collective.
    pub(crate) fn all(self, own: bool) -> bool {
        self.largest(i64::from(!own)) == 0
    }

    /// The largest number of the ranks. Collective.
    pub(crate) fn largest(self, own: i64) -> i64 {
        let mut largest = own;
        // SAFETY: as above; all ranks take part, as the caller promises.
        unsafe { ffi::zp_largest(self.raw, own, &mut largest) };
        largest
    }

    /// The sum over the ranks before this one, and over all. Collective.
    pub(crate) fn count(self, own: i64) -> (i64, i64) {
        let (mut before, mut all) = (0, own);
        // SAFETY: as above.
        unsafe { ffi::zp_count(self.raw, own, &mut before, &mut all) };
        (before, all)
    }

    /// As many numbers of every rank, by rank. Collective.
    pub(crate) fn gather(self, own: &[f64]) -> Vec<f64> {
        let (_, size) = self.rank_and_size();
        let mut all = vec![0.0; own.len() * size];
        // SAFETY: `all` has room for the numbers of every rank.
        unsafe { ffi::zp_gather(self.raw, own.as_ptr(), own.len() as c_int, all.as_mut_ptr()) };
        all
    }
}

/// The error for a code of the C side, with the text that PETSc gave.
pub(crate) fn check(what: &str, code: c_int) -> Result<(), SolveError> {
    if code == 0 {
        return Ok(());
    }
    // SAFETY: the text is a static of the C side and ends in 0.
    let text = unsafe { CStr::from_ptr(ffi::zp_message()) }.to_string_lossy();
    let text = if text.is_empty() { format!("error {code}") } else { text.trim().to_owned() };
    Err(SolveError::Failed(format!("PETSc: {what}: {text}")))
}
