//! The start-up of a program, and its messages when it fails.

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

/// Prevents other processes of the same user, including planners, from reading or changing this process; disables core
/// dumps.
pub fn close_memory() {
    #[cfg(target_os = "linux")]
    {
        use rustix::process::{DumpableBehavior, set_dumpable_behavior};
        // If the system refuses, planners are still sandboxed.
        let _ = set_dumpable_behavior(DumpableBehavior::NotDumpable);
    }
}

/// Makes a write beyond the file size limit (`ulimit -f`) fail with an error, as on a full disk, instead of ending the
/// process.
///
/// Installs a handler that does nothing. If the signal were ignored instead, the planners' processes would inherit this
/// setting.
pub fn survive_file_size_limit() {
    // If this fails, the signal ends the process, as it does by default.
    let _ = signal_hook::flag::register(libc::SIGXFSZ, Arc::default());
}
