//! Restores the terminal: at exit, in a panic, and from a signal handler.

use crossterm::terminal::disable_raw_mode;
use std::io::{self, Write};
use std::panic;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, ThreadId};

/// Undoes everything that taking over the terminal does: ends the synchronized update, turns off mouse reports, focus
/// reports and bracketed paste, resets the text style, leaves the alternate screen and shows the cursor.
pub const RESTORE: &str =
    "\x1b[?2026l\x1b[?1006l\x1b[?1002l\x1b[?1000l\x1b[?1004l\x1b[?2004l\x1b[0m\x1b[?1049l\x1b[?25h";

/// Whether the console owns the terminal.
static TAKEN: AtomicBool = AtomicBool::new(false);
/// The thread that took over the terminal.
static OWNER: Mutex<Option<ThreadId>> = Mutex::new(None);

/// Records that this thread takes over the terminal.
pub(super) fn own() {
    modes::save();
    if let Ok(mut owner) = OWNER.lock() {
        *owner = Some(thread::current().id());
    }
    TAKEN.store(true, Ordering::SeqCst);
}

/// Whether the console owns the terminal.
pub(super) fn is_taken() -> bool {
    TAKEN.load(Ordering::SeqCst)
}

/// Restores the terminal. Does nothing if the console does not own it, so repeated calls are safe.
pub fn restore() {
    if TAKEN.swap(false, Ordering::SeqCst) {
        // If the terminal is closed, there is nowhere to report the error.
        let mut output = io::stdout();
        let _ = output.write_all(RESTORE.as_bytes()).and_then(|()| output.flush());
        let _ = disable_raw_mode();
    }
}

/// Restores the terminal from a signal handler: no lock, no allocation, two or three system calls.
///
/// Does nothing if the console does not own the terminal.
pub fn restore_from_signal() {
    if TAKEN.swap(false, Ordering::SeqCst) {
        modes::write_back();
    }
}

/// Installs a panic hook in front of the current one.
///
/// If the thread that owns the terminal panics, the hook restores the terminal and then calls the previous hook. If
/// any other thread panics while the console owns the terminal, nothing may be written to the screen: the hook passes
/// the thread's name, and the message with its source location, to `on_panic`.
pub fn install_panic_hook(on_panic: impl Fn(&str, &str) + Send + Sync + 'static) {
    let before = panic::take_hook();
    panic::set_hook(Box::new(move |info| {
        let mine = OWNER.lock().is_ok_and(|owner| *owner == Some(thread::current().id()));
        if !is_taken() || mine {
            restore();
            before(info);
            return;
        }
        let payload = info.payload();
        let said = payload
            .downcast_ref::<&str>()
            .copied()
            .or_else(|| payload.downcast_ref::<String>().map(String::as_str))
            .unwrap_or("panic without a message");
        let place = info.location().map(|at| format!(" ({}:{})", at.file(), at.line())).unwrap_or_default();
        on_panic(thread::current().name().unwrap_or("unnamed"), &format!("{said}{place}"));
    }));
}

#[cfg(unix)]
mod modes {
    use super::RESTORE;
    use rustix::termios::{OptionalActions, Termios, tcgetattr, tcsetattr};
    use std::sync::OnceLock;

    /// The terminal modes before the console first took over.
    static SAVED: OnceLock<Termios> = OnceLock::new();

    pub(super) fn save() {
        if let Ok(modes) = tcgetattr(rustix::stdio::stdin()) {
            let _ = SAVED.set(modes);
        }
    }

    pub(super) fn write_back() {
        if let Some(modes) = SAVED.get() {
            let _ = tcsetattr(rustix::stdio::stdin(), OptionalActions::Now, modes);
        }
        let _ = rustix::io::write(rustix::stdio::stdout(), RESTORE.as_bytes());
    }
}

#[cfg(not(unix))]
mod modes {
    pub(super) fn save() {}

    pub(super) fn write_back() {
        super::TAKEN.store(true, std::sync::atomic::Ordering::SeqCst);
        super::restore();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn giving_back_what_was_not_taken_does_nothing() {
        restore();
        restore_from_signal();
        assert!(!is_taken());
    }

    #[test]
    fn every_mode_that_is_set_is_unset() {
        for mode in ["2026l", "1006l", "1002l", "1000l", "1004l", "2004l", "1049l", "25h"] {
            assert!(RESTORE.contains(&format!("\x1b[?{mode}")), "{mode}");
        }
    }
}
