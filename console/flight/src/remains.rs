//! Output and crash files of planners, saved in the folder of the run.

use mission::{Event, EventKind};
use planner_api::LogLevel;
use planner_host::{Crash, Host, Printed, digest_of, plugin_of};
use runs::RunLog;

/// Description of the failure.
pub const CRASH_FILE: &str = "crash.txt";
/// The last requests to the planner.
pub const FRAMES_FILE: &str = "frames.bin";
/// Start of the line that contains the digest of these requests.
const FRAMES_DIGEST: &str = "frames.bin: sha256 ";
/// Maximum number of lines shown at once.
const MOST_SHOWN: usize = 8;

/// Saves the lines that planners have printed since the last call, and the crash files of planners that have failed
/// since then, in files beside the journal. Returns the printed lines as events for display; they are not written to
/// the journal.
pub fn keep(host: &mut Host, mut log: Option<&mut RunLog>, (tick, t_s): (u64, f64)) -> Vec<Event> {
    let (printed, crashes, bad_ends) = (host.take_printed(), host.take_crashes(), host.take_bad_ends());
    if let Some(log) = &mut log {
        let lines =
            printed.iter().map(|Printed { planner, line }| format!("T+{t_s:.1} s  {planner}: {line}\n"));
        let ends = bad_ends.iter().map(|end| format!("T+{t_s:.1} s  {end}\n"));
        let faults = crashes
            .iter()
            .map(|crash| format!("T+{t_s:.1} s  {}; plugin {}\n", crash.fault.message, plugin_file(crash)));
        log.keep_output(&lines.chain(ends).chain(faults).collect::<String>());
        for crash in &crashes {
            log.keep_crash(&files(crash));
        }
    }
    let shown = printed.into_iter().take(MOST_SHOWN).map(|Printed { planner, line }| {
        EventKind::PlannerLogged { planner, level: LogLevel::Debug, message: line }
    });
    let ends = bad_ends.into_iter().map(|end| EventKind::PlannerLogged {
        message: end.to_string(),
        planner: end.planner,
        level: LogLevel::Warn,
    });
    shown.chain(ends).map(|kind| Event { tick, t_s, kind }).collect()
}

/// Path of the plugin that failed.
fn plugin_file(crash: &Crash) -> String {
    plugin_of(&crash.frames).map_or_else(|| "unknown".to_owned(), |file| file.display().to_string())
}

/// The crash files that `tankops replay-worker` reads.
fn files(crash: &Crash) -> [(&'static str, Vec<u8>); 3] {
    let Crash { fault, frames, output } = crash;
    let about = format!(
        "{}\nplugin: {}\nplugin: sha256 {}\n{FRAMES_DIGEST}{}\ntankops {}\n",
        fault.message,
        plugin_file(crash),
        fault.plugin_sha256.as_deref().unwrap_or("unknown"),
        digest_of(frames),
        env!("CARGO_PKG_VERSION"),
    );
    [(CRASH_FILE, about.into()), (FRAMES_FILE, frames.clone()), ("output.txt", output.clone().into())]
}

/// Checks that the requests saved for a crash are the original ones; `about` is the description saved with them.
///
/// # Errors
/// The requests do not match. The error text continues a sentence that begins with the name of their file.
pub fn check_frames(about: &str, frames: &[u8]) -> Result<(), String> {
    let kept = about.lines().find_map(|line| line.strip_prefix(FRAMES_DIGEST));
    match kept {
        None => Err(format!(
            "cannot be checked: {CRASH_FILE} beside it has no line `{FRAMES_DIGEST}...`; it was changed, or written by an older tankops"
        )),
        Some(kept) if kept.trim() == digest_of(frames) => Ok(()),
        Some(_) => Err(format!("was truncated or changed: its SHA-256 is not the one in {CRASH_FILE}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mission::planner::During;
    use mission::{Cause, Fault};

    #[test]
    fn frames_that_were_cut_or_changed_are_known_by_what_was_written_about_them() {
        let fault = Fault {
            planner: "p".into(),
            during: During::Step,
            cause: Cause::Died,
            message: "planner p died".into(),
            partial: Vec::new(),
            plugin_sha256: None,
        };
        let crash = Crash { fault, frames: vec![1, 2, 3], output: String::new() };
        let [(_, about), (_, frames), _] = files(&crash);
        let about = String::from_utf8(about).expect("text");
        assert_eq!(check_frames(&about, &frames), Ok(()));
        assert!(
            check_frames(&about, &frames[..2]).is_err_and(|why| why.starts_with("was truncated or changed"))
        );
        assert!(
            check_frames("planner p died\n", &frames).is_err_and(|why| why.starts_with("cannot be checked"))
        );
    }
}
