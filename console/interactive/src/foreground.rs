//! The terminal's foreground group: only its processes may read keys. Another process of the session that takes the terminal
//! would leave a console that hears nothing, so the console takes the terminal back, within a second or at the next key.
//!
//! A planner's worker cannot be that process: it has left the session before anything of a plugin runs.

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

/// Whether this process has left the terminal to others on purpose.
#[derive(Clone)]
pub(super) struct Foreground(Arc<AtomicBool>);

impl Foreground {
    /// A console that is started in the background has left it.
    pub(super) fn new() -> Self {
        Self(Arc::new(AtomicBool::new(!has_terminal())))
    }

    /// The process goes on after it was stopped: who continued it has decided who has the terminal.
    pub(super) fn continued(&self) {
        self.0.store(!has_terminal(), Ordering::SeqCst);
    }

    /// The system did not give this process a key, and would stop it if nobody listened.
    pub(super) fn missed_key(&self) {
        if self.0.load(Ordering::SeqCst) {
            let _ = kill_process(getpid(), Signal::STOP);
        } else {
            self.keep();
        }
    }

    /// Takes the terminal back if another process has taken it. To be called now and then, too: a process without a shell
    /// above it gets no signal.
    ///
    /// A process in the background that takes the terminal is stopped by the system unless it ignores that signal, which a
    /// shell can arrange for a child.
    pub(super) fn keep(&self) {
        if self.0.load(Ordering::SeqCst) || has_terminal() || !stdin().is_terminal() {
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

/// What the hidden command `take-terminal` runs: gives the terminal to the group of this process.
pub fn take_terminal() -> ExitCode {
    if tcsetpgrp(stdin(), getpgrp()).is_ok() { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
