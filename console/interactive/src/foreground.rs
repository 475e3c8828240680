//! Keeps the console in the terminal's foreground group; only processes in this group may read keys. If another process
//! in the session took the terminal, the console would receive no keys, so the console takes the terminal back within
//! two seconds, or when the next key is pressed.
//!
//! A planner's worker cannot take the terminal: it leaves the session before any plugin code runs.

use rustix::{
    process::{Signal, getpgrp, getpid, kill_process},
    termios::{tcgetpgrp, tcsetpgrp},
};
use std::{
    env,
    io::{IsTerminal, stdin},
    process::{Command, ExitCode, Stdio},
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
};

/// Whether this process has given up the terminal on purpose.
#[derive(Clone)]
pub(super) struct Foreground(Arc<AtomicBool>);

impl Foreground {
    /// Detects whether the console was started in the background and has therefore given up the terminal.
    pub(super) fn new() -> Self {
        Self(Arc::new(AtomicBool::new(!has_terminal())))
    }

    /// Call this after a stopped process is continued: the job control that continued it also decided who owns the
    /// terminal.
    pub(super) fn continued(&self) {
        self.0.store(!has_terminal(), Ordering::SeqCst);
    }

    /// Handles a key that the system withheld from this process. By default, the system would stop the process.
    pub(super) fn missed_key(&self) {
        if self.0.load(Ordering::SeqCst) {
            let _ = kill_process(getpid(), Signal::STOP);
        } else {
            self.keep();
        }
    }

    /// Whether another process has taken the terminal.
    pub(super) fn is_lost(&self) -> bool {
        !self.0.load(Ordering::SeqCst) && !has_terminal() && stdin().is_terminal()
    }

    /// Takes the terminal back if another process has taken it. Also call this periodically: without a parent shell,
    /// the process receives no signal.
    ///
    /// The system stops a background process that takes the terminal, unless the process ignores SIGTTOU. A shell can
    /// make its child ignore this signal.
    pub(super) fn keep(&self) {
        if !self.is_lost() {
            return;
        }
        let Ok(program) = env::current_exe() else { return };
        let mut shell = Command::new("/bin/sh");
        shell.args(["-c", "trap '' TTOU; exec \"$0\" take-terminal"]).arg(program);
        let _ = shell.stdout(Stdio::null()).stderr(Stdio::null()).status();
    }
}

fn has_terminal() -> bool {
    tcgetpgrp(stdin()).is_ok_and(|group| group == getpgrp())
}

/// The hidden command `take-terminal`: gives the terminal to the group of this process.
pub fn take_terminal() -> ExitCode {
    if tcsetpgrp(stdin(), getpgrp()).is_ok() { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
