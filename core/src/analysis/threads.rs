//! The threads of a run, as many as its address space carries.

use zelus_linear_algebra::{address_space, parallel::ThreadPool};

use crate::communication::{cores, fair_threads};
use crate::diagnostics::{Diagnostic, Error, Result};

/// Threads of a run at most: more do not help, and a machine may not stand them.
const MOST: usize = 1024;

/// The pool of `wanted` threads, or of all that the machine has; of fewer, with a warning, where a limit of the address space
/// (`ulimit -v`) would abort the run.
///
/// # Errors
/// [`Error::System`] when not one thread fits, or none can be started.
pub(super) fn pool(wanted: Option<usize>) -> Result<(ThreadPool, Option<Diagnostic>)> {
    let asked = wanted.unwrap_or_else(fair_threads);
    let wanted = if asked == 0 { cores() } else { asked };
    if wanted > MOST {
        let fact = format!("{wanted} threads are asked for, {MOST} are the most that a run takes");
        let remedy = format!("this machine has {} cores: more threads take longer", cores());
        return Err(Diagnostic::error("threads", fact).remedy(remedy).into());
    }
    let (own, left) = (address_space::of_a_thread(), address_space::left());
    let fitting = left.map_or(wanted, |left| (left / own) as usize);
    if fitting == 0 {
        let [left, own] = [left.unwrap_or_default(), own].map(|bytes| bytes >> 20);
        let fact =
            format!("the limit of the address space (ulimit -v) leaves {left} MiB, and a thread reserves {own} MiB");
        return Err(Error::System(format!(
            "{fact}\n    raise the limit; what is reserved and not used takes no memory"
        )));
    }
    let pool = ThreadPool::new(if fitting < wanted { fitting } else { asked });
    let pool = pool.map_err(|error| Error::System(format!("cannot start threads: {error}")))?;
    let fewer = (fitting < wanted).then(|| {
        let mib = own >> 20;
        let fact =
            format!("{fitting} threads run in place of {wanted}: each reserves {mib} MiB of a limited address space");
        Diagnostic::warning("address-space", fact).remedy("raise the limit (ulimit -v); results are the same")
    });
    Ok((pool, fewer))
}
