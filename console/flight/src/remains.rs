//! What planners leave beside their answers, kept in the folder of the run.

use mission::{Event, EventKind};
use planner_api::LogLevel;
use planner_host::{Crash, Host, Printed};
use runs::RunLog;

/// So many lines are shown at once.
const MOST_SHOWN: usize = 8;

/// Keeps what planners have printed and what is left of those that failed since the last time, in files of the run beside the
/// journal; gives the printed lines as events for whoever watches, which are not the journal's.
pub fn keep(host: &mut Host, mut log: Option<&mut RunLog>, (tick, t_s): (u64, f64)) -> Vec<Event> {
    let (printed, crashes, bad_ends) = (host.take_printed(), host.take_crashes(), host.take_bad_ends());
    if let Some(log) = &mut log {
        let lines =
            printed.iter().map(|Printed { planner, line }| format!("T+{t_s:.1} s  {planner}: {line}\n"));
        let ends = bad_ends.iter().map(|end| format!("T+{t_s:.1} s  {end}\n"));
        log.keep_output(&lines.chain(ends).collect::<String>());
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

/// The files of a crash, for `tankops replay-worker`.
fn files(crash: &Crash) -> [(&'static str, Vec<u8>); 3] {
    let Crash { fault, frames, output } = crash;
    let about = format!(
        "{}\nplugin: sha256 {}\ntankops {}\n",
        fault.message,
        fault.plugin_sha256.as_deref().unwrap_or("unknown"),
        env!("CARGO_PKG_VERSION"),
    );
    [("crash.txt", about.into()), ("frames.bin", frames.clone()), ("output.txt", output.clone().into())]
}
