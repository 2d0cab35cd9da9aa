//! The functions of `shim.c`.

use std::ffi::{c_char, c_int, c_void};

/// A matrix with its solver, as the C side keeps it.
#[repr(C)]
pub(crate) struct Handle {
    _private: [u8; 0],
}

/// `zp_report`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct RawReport {
    pub(crate) rhs_norm: f64,
    pub(crate) residual_norm: f64,
    pub(crate) answer_norm: f64,
    pub(crate) matrix_norm: f64,
    pub(crate) seconds_setup: f64,
    pub(crate) seconds_solve: f64,
    pub(crate) iterations: i64,
    pub(crate) refinements: i64,
    pub(crate) null_pivots: i64,
    pub(crate) factor_error: i64,
    pub(crate) factor_detail: i64,
    pub(crate) reason: c_int,
    pub(crate) pc_failed: c_int,
}

impl RawReport {
    /// How much larger the answer is than the right-hand side, in units of the matrix.
    pub(crate) fn growth(&self) -> f64 {
        if self.rhs_norm > 0.0 { self.matrix_norm * self.answer_norm / self.rhs_norm } else { 0.0 }
    }
}

unsafe extern "C" {
    pub(crate) fn zp_message() -> *const c_char;
    pub(crate) fn zp_start() -> c_int;
    pub(crate) fn zp_end() -> c_int;
    pub(crate) fn zp_world() -> *const c_void;
    pub(crate) fn zp_rank_and_size(comm: *const c_void, rank: *mut c_int, size: *mut c_int) -> c_int;
    pub(crate) fn zp_largest(comm: *const c_void, own: i64, largest: *mut i64) -> c_int;
    pub(crate) fn zp_count(comm: *const c_void, own: i64, before: *mut i64, all: *mut i64) -> c_int;
    pub(crate) fn zp_gather(comm: *const c_void, own: *const f64, count: c_int, all: *mut f64) -> c_int;
    pub(crate) fn zp_fits(largest: i64) -> c_int;
    pub(crate) fn zp_create(
        comm: *const c_void,
        rows: i64,
        starts: *const i64,
        columns: *const i64,
        values: *const f64,
        symmetry: c_int,
        block: c_int,
        options: *const c_char,
        out: *mut *mut Handle,
    ) -> c_int;
    pub(crate) fn zp_destroy(solver: *mut Handle);
    pub(crate) fn zp_update(solver: *mut Handle, values: *const f64) -> c_int;
    pub(crate) fn zp_near_null_space(solver: *mut Handle, count: c_int, rows: i64, modes: *const f64) -> c_int;
    pub(crate) fn zp_solve(
        solver: *mut Handle,
        rows: i64,
        rhs: *const f64,
        answer: *mut f64,
        residual: *mut f64,
        refinements: c_int,
        report: *mut RawReport,
    ) -> c_int;
    pub(crate) fn zp_reason(reason: c_int) -> *const c_char;
    pub(crate) fn zp_unread_options(solver: *mut Handle, text: *mut c_char, size: c_int) -> c_int;
}
