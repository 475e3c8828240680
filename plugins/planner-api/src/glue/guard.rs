//! Catches and reports panics, so that none unwinds into the console.

use super::services::HostServices;
use crate::{Code, PlannerError, Result};
use std::any::Any;
use std::backtrace::{Backtrace, BacktraceStatus};
use std::cell::RefCell;
use std::io::Write;
use std::panic::{AssertUnwindSafe, PanicHookInfo, catch_unwind};
use std::path::{Component, Path};
use std::sync::Once;

thread_local! {
    /// Source location of this thread's last panic, as `file:line`.
    static WHERE: RefCell<String> = const { RefCell::new(String::new()) };
}

/// The plugin links its own copy of the standard library, so its panic hook affects no other code.
static HOOK: Once = Once::new();

/// Runs the author's code. A refusal or panic becomes a code, and its sentence is reported to the console.
///
/// The sentence for a panic is `file:line: payload`.
pub(super) fn run(services: &HostServices, call: impl FnOnce() -> Result<()>) -> i32 {
    match caught(call) {
        Ok(Ok(())) => 0,
        Ok(Err(error)) => {
            services.error(&error.message);
            error.code as i32
        }
        Err(sentence) => {
            services.error(&sentence);
            Code::Panic as i32
        }
    }
}

/// Runs the author's code and ignores a panic.
pub(super) fn quietly(call: impl FnOnce()) {
    // A report would be useless: the instance is destroyed in any case.
    let _ = caught(call);
}

/// Runs work on a thread that a planner started. A panic there is returned as an error that the waiting call can pass
/// on. The console then receives the source location and text, as for any other panic; if the panic only ended its
/// thread, both would be lost.
///
/// ```
/// use planner_api::{Code, on_own_thread};
///
/// let half = std::thread::spawn(|| on_own_thread(|| Ok(0.5))).join().unwrap();
/// assert_eq!(half, Ok(0.5));
/// let panicked = on_own_thread::<()>(|| panic!("no such candidate")).unwrap_err();
/// assert_eq!(panicked.code, Code::Panic);
/// assert!(panicked.message.ends_with("no such candidate"));
/// ```
///
/// # Errors
/// The error that the work returns, or [`Code::Panic`] with `file:line: payload`.
pub fn on_own_thread<T>(work: impl FnOnce() -> Result<T>) -> Result<T> {
    without_unwinding(work).unwrap_or_else(|sentence| Err(PlannerError::new(Code::Panic, sentence)))
}

fn caught<T>(call: impl FnOnce() -> T) -> std::result::Result<T, String> {
    HOOK.call_once(|| std::panic::set_hook(Box::new(note)));
    without_unwinding(call)
}

/// Runs the author's code and returns the sentence for a panic. The sentence contains the source location only if a
/// call from the console has set the panic hook; tests that call planners directly keep their own hook.
fn without_unwinding<T>(call: impl FnOnce() -> T) -> std::result::Result<T, String> {
    catch_unwind(AssertUnwindSafe(call)).map_err(|payload| {
        let place = WHERE.with_borrow(Clone::clone);
        let sentence = format!("{place}: {}", text_of(&*payload));
        // Dropping the payload may itself panic.
        std::mem::forget(payload);
        sentence
    })
}

fn note(info: &PanicHookInfo<'_>) {
    let place = info.location().map(|at| format!("{}:{}", short(at.file()), at.line())).unwrap_or_default();
    let what = info.payload_as_str().unwrap_or_default();
    let trace = Backtrace::capture();
    if trace.status() == BacktraceStatus::Captured {
        let _ = writeln!(std::io::stderr(), "backtrace:\n{trace}panicked at {place}: {what}");
    } else if cfg!(panic = "abort") {
        // Nothing will catch this panic. The console shows the last line that a dead worker printed.
        let _ = writeln!(std::io::stderr(), "panicked at {place}: {what}");
    }
    // A thread that is being torn down has lost its thread-local storage, so the source location stays unknown.
    let _ = WHERE.try_with(|last| last.replace(place));
}

/// Shortens the absolute path of a source file so that it begins at its package. The same panic then reads the same on
/// every machine. Paths within the author's workspace are relative and stay as they are.
fn short(file: &str) -> String {
    if !Path::new(file).is_absolute() {
        return file.to_owned();
    }
    let names: Vec<&str> = Path::new(file)
        .components()
        .filter_map(|part| if let Component::Normal(name) = part { name.to_str() } else { None })
        .collect();
    let source = names.iter().rposition(|name| *name == "src").unwrap_or(names.len().saturating_sub(2));
    names[source.saturating_sub(1)..].join("/")
}

fn text_of(payload: &(dyn Any + Send)) -> &str {
    let owned = payload.downcast_ref::<String>().map(String::as_str);
    owned.or_else(|| payload.downcast_ref::<&str>().copied()).unwrap_or("the panic has no message")
}

#[cfg(test)]
mod tests {
    use super::short;

    #[test]
    fn a_place_reads_the_same_on_every_machine() {
        assert_eq!(short("plugins/apf/src/lib.rs"), "plugins/apf/src/lib.rs");
        let in_a_dependency = "/home/ann/.cargo/registry/src/index-1/nalgebra-0.35.0/src/base/matrix.rs";
        assert_eq!(short(in_a_dependency), "nalgebra-0.35.0/src/base/matrix.rs");
        assert_eq!(short("/a/b"), "a/b");
    }
}
