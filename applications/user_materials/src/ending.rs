//! Names the element whose material ends the program: by a signal, or by a STOP.

use std::cell::Cell;
use std::sync::Once;

use libc::{SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGSEGV, c_int};

thread_local! {
    /// Element id and Gauss point within a call on this thread; zeros outside.
    static WITHIN: Cell<(u64, u64)> = const { Cell::new((0, 0)) };
}

static INSTALL: Once = Once::new();

/// Exit code of a run that an entity ends.
const EXIT: c_int = 3;

/// Remembers the element and the Gauss point of a call while it lasts.
pub(crate) fn within<T>(element: usize, point: usize, call: impl FnOnce() -> T) -> T {
    INSTALL.call_once(install);
    WITHIN.set((element as u64, point as u64));
    let out = call();
    WITHIN.set((0, 0));
    out
}

fn install() {
    // SAFETY: the handlers do nothing but write to standard error and end the program.
    unsafe {
        for signal in [SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT] {
            let mut action: libc::sigaction = std::mem::zeroed();
            action.sa_sigaction = on_signal as *const () as usize;
            action.sa_flags = libc::SA_ONSTACK | libc::SA_NODEFER;
            libc::sigemptyset(&mut action.sa_mask);
            libc::sigaction(signal, &action, std::ptr::null_mut());
        }
        libc::atexit(on_exit);
    }
}

extern "C" fn on_signal(signal: c_int) {
    let (element, point) = WITHIN.get();
    if element > 0 {
        let name: &[u8] = match signal {
            SIGSEGV => b"SIGSEGV, a wrong address",
            SIGBUS => b"SIGBUS, a wrong address",
            SIGFPE => b"SIGFPE, a wrong operation on numbers",
            SIGILL => b"SIGILL, a wrong instruction",
            _ => b"SIGABRT, its own decision",
        };
        say(element, point, name);
        // SAFETY: ends the program without anything that could run once more.
        unsafe { libc::_exit(EXIT) }
    }
    // SAFETY: not of a user material: as if nothing had been installed.
    unsafe {
        libc::signal(signal, libc::SIG_DFL);
        libc::raise(signal);
    }
}

extern "C" fn on_exit() {
    // A STOP runs this on the thread that it ends.
    let (element, point) = WITHIN.get();
    if element > 0 {
        say(element, point, b"its own STOP");
        // SAFETY: ends the program; a STOP without a code would be a success.
        unsafe { libc::_exit(EXIT) }
    }
}

/// Writes one line to standard error, without allocating.
fn say(element: u64, point: u64, why: &[u8]) {
    let mut digits = [0_u8; 20];
    write(b"\nerror[user-material] element ");
    write(decimal(element, &mut digits));
    if point > 0 {
        write(b", Gauss point ");
        write(decimal(point, &mut digits));
    }
    write(b": the subroutine UMAT of its material ended the program by ");
    write(why);
    write(b"\n    compile it with checks (gfortran -g -fcheck=all -fbacktrace) and run the deck once more\n");
}

fn write(text: &[u8]) {
    // SAFETY: a buffer of that length.
    let _ = unsafe { libc::write(2, text.as_ptr().cast(), text.len()) };
}

fn decimal(mut number: u64, digits: &mut [u8; 20]) -> &[u8] {
    let mut at = digits.len();
    loop {
        at -= 1;
        digits[at] = b'0' + (number % 10) as u8;
        number /= 10;
        if number == 0 {
            return &digits[at..];
        }
    }
}
