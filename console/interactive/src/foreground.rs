//! The terminal's foreground group: only its processes may read keys. Another process of the session that takes the terminal
//! would leave a console that hears nothing, so it takes the terminal back at the next key.
//!
//! A planner's worker cannot be that process: it has left the session before anything of a plugin runs.

use rustix::{
    process::{Signal, getpgrp, getpid, kill_process},
    termios::{tcgetpgrp, tcsetpgrp},
};
use std::{
    env,
    io::stdin,
    process::{Command, ExitCode, Stdio},
};

/// Whether this process has the terminal, or has left it to others on purpose.
pub(super) struct Foreground {
    is_left: bool,
}

impl Foreground {
    /// A console that is started in the background has left it.
    pub(super) fn new() -> Self {
        Self { is_left: !has_terminal() }
    }

    /// The process goes on after it was stopped: who continued it has decided who has the terminal.
    pub(super) fn continued(&mut self) {
        self.is_left = !has_terminal();
    }

    /// The system did not give this process a key.
    pub(super) fn missed_key(&self) {
        if self.is_left {
            // As without anybody listening to the signal.
            let _ = kill_process(getpid(), Signal::STOP);
        } else {
            take_back();
        }
    }
}

fn has_terminal() -> bool {
    tcgetpgrp(stdin()).is_ok_and(|group| group == getpgrp())
}

/// Takes the terminal back if another process has it; whether it was so and is no more.
///
/// A process in the background that takes the terminal is stopped by the system unless it ignores that signal, which a
/// shell can arrange for a child.
pub(super) fn take_back() -> bool {
    if has_terminal() {
        return false;
    }
    let Ok(program) = env::current_exe() else { return false };
    let mut shell = Command::new("/bin/sh");
    shell.args(["-c", "trap '' TTOU; exec \"$0\" take-terminal"]).arg(program);
    let _ = shell.stdout(Stdio::null()).stderr(Stdio::null()).status();
    has_terminal()
}

/// What the hidden command `take-terminal` runs: gives the terminal to the group of this process.
pub fn take_terminal() -> ExitCode {
    if tcsetpgrp(stdin(), getpgrp()).is_ok() { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
