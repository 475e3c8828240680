//! How a program begins, and what it says when it fails.

use flight::failure::{BAD_INPUT, INTERNAL, is_input};
use report::print::warn_line;
use std::{process::ExitCode, sync::Arc};

/// Reports a failure on stderr; the exit code distinguishes input errors from internal ones.
pub fn fail(error: &anyhow::Error) -> ExitCode {
    if is_input(error) {
        let text = error.to_string();
        let prefix = if text.starts_with("error") { "" } else { "error: " };
        warn_line(&format!("{prefix}{}", text.trim_end()));
        return ExitCode::from(BAD_INPUT);
    }
    warn_line(&format!("error: {error:#}"));
    ExitCode::from(INTERNAL)
}

/// Keeps other processes of the same user, planners among them, from reading or changing this one; leaves no core dump.
pub fn close_memory() {
    #[cfg(target_os = "linux")]
    {
        use rustix::process::{DumpableBehavior, set_dumpable_behavior};
        // Where the system refuses, planners are still closed off.
        let _ = set_dumpable_behavior(DumpableBehavior::NotDumpable);
    }
}

/// A file that may not grow (`ulimit -f`) is an error of the write, as a full disk is, and not the end of the process.
///
/// A handler that does nothing, because ignoring the signal would be inherited by the planners' processes.
pub fn survive_file_size_limit() {
    // Without a handler the signal ends the process, as it does by default.
    let _ = signal_hook::flag::register(libc::SIGXFSZ, Arc::default());
}
