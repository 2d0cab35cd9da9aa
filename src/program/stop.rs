//! Signals that ask the program to stop.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use signal_hook::consts::{SIGINT, SIGTERM, SIGXFSZ};
use signal_hook::flag;
use signal_hook::iterator::Signals;
use zelus_core::{Error, Result};

use super::say::say;

/// Whether SIGINT or SIGTERM has come; a second one ends the program at once, with 128 and its number as exit code.
pub(super) struct Stop(Arc<AtomicBool>);

impl Stop {
    /// From now on; the first signal is answered at once by a line where it `tells`.
    ///
    /// # Errors
    /// A system that does not let signals be listened to.
    pub(super) fn listen(tells: bool) -> Result<Self> {
        let unheard = |error| Error::System(format!("signals cannot be listened to: {error}"));
        let asked = Arc::new(AtomicBool::new(false));
        for signal in [SIGINT, SIGTERM] {
            // The order matters: the first signal finds the flag unset, and sets it.
            let second = flag::register_conditional_shutdown(signal, 128 + signal, Arc::clone(&asked));
            second.and_then(|_| flag::register(signal, Arc::clone(&asked))).map_err(unheard)?;
        }
        if tells {
            let mut signals = Signals::new([SIGINT, SIGTERM]).map_err(unheard)?;
            std::thread::spawn(move || {
                if signals.forever().next().is_some() {
                    say("stopping after this step; again to stop now");
                }
            });
        }
        // A file beyond the limit of its size is then an error of its writing, which is told, and no silent end.
        flag::register(SIGXFSZ, Arc::default()).map_err(unheard)?;
        Ok(Self(asked))
    }

    /// Whether a signal has come.
    pub(super) fn is_asked(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}
