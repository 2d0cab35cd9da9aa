//! Asking for memory before it is read: processors do so themselves only within a page.

/// Bytes between the present and the prefetched address, where entries are read one after the other.
pub(crate) const AHEAD: usize = 6144;
/// Rows between one of which little is read and the one that is asked for.
pub(crate) const ROWS_AHEAD: usize = 16;
/// Bytes that come at a time.
const LINE: usize = 64;

/// Prefetches the cache line so many bytes behind the start of `values`; that may be beyond the end.
#[inline(always)]
pub(crate) fn prefetch<T>(values: &[T], bytes: usize) {
    let address = values.as_ptr().cast::<i8>().wrapping_add(bytes);
    #[cfg(target_arch = "x86_64")]
    // SAFETY: every such processor has the instruction, and it reads nothing that the program could see.
    unsafe {
        use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        _mm_prefetch::<_MM_HINT_T0>(address);
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = address;
}

/// Asks for as much as `values` take up, so many bytes behind their start.
#[inline(always)]
pub fn prefetch_as_many<T>(values: &[T], bytes: usize) {
    for line in 0..=size_of_val(values) / LINE {
        prefetch(values, bytes + LINE * line);
    }
}
