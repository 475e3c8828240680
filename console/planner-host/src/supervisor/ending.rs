//! Describes how a process ended, in words that are the same in every run.

use crate::wire::CHANNEL_LOST;
use foreign::is_plain;
use rustix::process::Signal;
use std::os::unix::process::ExitStatusExt;
use std::process::ExitStatus;

/// Maximum length of the line of output that is reported.
const LONGEST_LINE: usize = 160;

/// Describes the end of a process, such as "was killed by SIGSEGV (invalid memory access)". A process that closed its
/// socket and still had to be killed has no status.
pub(super) fn how_it_ended(status: Option<ExitStatus>) -> String {
    match status.map(|status| (status.signal(), status.code())) {
        Some((Some(signal), _)) if signal != CHANNEL_LOST.as_raw() => {
            format!("was killed by {}", signal_text(signal))
        }
        Some((_, Some(code))) => format!("ended its own process with exit code {code}"),
        _ => "lost its channel to the console".to_owned(),
    }
}

fn signal_text(number: i32) -> String {
    let (name, meaning) = match Signal::from_named_raw(number) {
        Some(Signal::ILL) => ("SIGILL", "illegal instruction"),
        Some(Signal::ABORT) => ("SIGABRT", "out of memory, stack overflow or a call to abort"),
        Some(Signal::BUS) => ("SIGBUS", "bad address"),
        Some(Signal::FPE) => ("SIGFPE", "arithmetic error, such as integer division by zero"),
        Some(Signal::KILL) => ("SIGKILL", "killed from outside, perhaps because memory ran out"),
        Some(Signal::SEGV) => ("SIGSEGV", "invalid memory access"),
        Some(Signal::XFSZ) => ("SIGXFSZ", "file size limit exceeded"),
        Some(Signal::TERM) => ("SIGTERM", "asked to terminate"),
        Some(Signal::INT) => ("SIGINT", "interrupted"),
        Some(Signal::HUP) => ("SIGHUP", "hung up"),
        Some(Signal::SYS) => ("SIGSYS", "a system call that no planner may make"),
        Some(Signal::PIPE) => ("SIGPIPE", "wrote to a closed channel"),
        Some(Signal::ALARM) => ("SIGALRM", "an alarm that it had set"),
        Some(Signal::VTALARM) => ("SIGVTALRM", "an alarm that it had set"),
        Some(Signal::PROF) => ("SIGPROF", "an alarm that it had set"),
        Some(Signal::USR1) => ("SIGUSR1", "sent by itself or from outside"),
        Some(Signal::USR2) => ("SIGUSR2", "sent by itself or from outside"),
        Some(Signal::TRAP) => ("SIGTRAP", "a breakpoint"),
        Some(Signal::QUIT) => ("SIGQUIT", "asked to terminate"),
        Some(Signal::XCPU) => ("SIGXCPU", "CPU time limit exceeded"),
        _ => return format!("signal {number}"),
    };
    format!("{name} ({meaning})")
}

/// Returns the last informative line, without control characters and without anything that differs from run to run.
pub(super) fn last_line(output: &[u8]) -> String {
    let text = String::from_utf8_lossy(output);
    let is_informative =
        |line: &&str| !line.trim().is_empty() && !line.starts_with("note: ") && !is_of_trace(line);
    let line = text.lines().rfind(is_informative).unwrap_or_default();
    let visible: String = line.chars().filter(|c| is_plain(*c)).collect();
    without_ids(&visible).trim().chars().take(LONGEST_LINE).collect()
}

/// Whether a line belongs to a backtrace, such as `12: main` and `at src/lib.rs:3`. Backtraces are left out because
/// they depend on the user's settings.
fn is_of_trace(line: &str) -> bool {
    let line = line.trim_start();
    let is_numbered = line.split_once(": ").is_some_and(|(number, _)| number.chars().all(is_digit));
    is_numbered || line.starts_with("at ") || line == "stack backtrace:"
}

/// Removes process and thread ids, such as the one in `thread 'main' (4711) panicked`, and the digits of addresses.
fn without_ids(line: &str) -> String {
    let mut kept = String::with_capacity(line.len());
    let mut rest = line;
    while let Some(c) = rest.chars().next() {
        if let Some(after) =
            rest.strip_prefix(" (").and_then(|r| r.trim_start_matches(is_digit).strip_prefix(')'))
        {
            rest = after;
        } else if let Some(after) = rest.strip_prefix("0x") {
            kept.push_str("0x..");
            rest = after.trim_start_matches(|d: char| d.is_ascii_hexdigit());
        } else {
            kept.push(c);
            rest = &rest[c.len_utf8()..];
        }
    }
    kept
}

fn is_digit(c: char) -> bool {
    c.is_ascii_digit()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exits_are_described_in_words() {
        let signalled = |number| how_it_ended(Some(ExitStatus::from_raw(number)));
        assert_eq!(signalled(11), "was killed by SIGSEGV (invalid memory access)");
        assert_eq!(signalled(0), "ended its own process with exit code 0");
        assert_eq!(signalled(70 << 8), "ended its own process with exit code 70");
        assert_eq!(signalled(CHANNEL_LOST.as_raw()), "lost its channel to the console");
        assert_eq!(signalled(2), "was killed by SIGINT (interrupted)");
        assert_eq!(signalled(31), "was killed by SIGSYS (a system call that no planner may make)");
        assert_eq!(signalled(12), "was killed by SIGUSR2 (sent by itself or from outside)");
        assert_eq!(signalled(14), "was killed by SIGALRM (an alarm that it had set)");
        assert_eq!(signalled(40), "was killed by signal 40");
        assert_eq!(how_it_ended(None), "lost its channel to the console");
    }

    #[test]
    fn the_last_line_carries_no_ids_addresses_or_escapes() {
        let output = b"first\nthread 'main' (4711) panicked at \x1b[31m0x7ffe12ab\nnote: run with\n\n";
        assert_eq!(last_line(output), "thread 'main' panicked at [31m0x..");
        assert_eq!(
            last_line(b"memory allocation of 1048576 bytes failed\n"),
            "memory allocation of 1048576 bytes failed"
        );
        assert_eq!(last_line(b""), "");
        assert_eq!(last_line(b"f(x) (a)"), "f(x) (a)");
        let with_trace =
            b"no memory\nstack backtrace:\n   0: alloc\n             at src/lib.rs:3\n  12: main\n";
        assert_eq!(last_line(with_trace), "no memory");
    }
}
