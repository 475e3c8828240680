//! Before the start, checks everything outside the screen that a mission depends on: plugins, disk, recorder, engine
//! and clock.

use super::{desk::Tools, inbox::RunOutbox, line::EngineHandle};
use mission::{Check, CheckOutcome};
use runs::{check_recorder, free_bytes};
use std::{
    path::Path,
    thread,
    time::{Duration, Instant, SystemTime},
};
use tui::RunMsg;

/// The longest acceptable response time of the engine; a slower engine would stop the robot too late.
const STOP_LIMIT: Duration = Duration::from_millis(50);
/// The longest wait for an answer from the engine.
const STOP_PATIENCE: Duration = Duration::from_secs(2);
/// The time over which the two clocks are compared, and the largest acceptable difference.
const CLOCK_SPAN: Duration = Duration::from_millis(100);
const CLOCK_LIMIT: Duration = Duration::from_millis(20);
/// The free space in bytes required beyond the expected size of the run.
const RESERVE_BYTES: u64 = 50_000_000;

/// Runs all checks on a separate thread and reports them to the screen.
pub(super) fn begin(tools: &Tools, engine: Option<EngineHandle>, screen: RunOutbox, needed_bytes: u64) {
    let (tools, fallback) = (tools.clone(), screen.clone());
    let began = thread::Builder::new().name("check".into()).spawn(move || {
        let logs = &tools.logs;
        let checks =
            vec![plugins(&tools), disk(logs, needed_bytes), recorder(logs), stop(engine.as_ref()), clock()];
        screen.send(RunMsg::Checked(checks));
    });
    if let Err(error) = began {
        let found = format!("checks failed: {error}");
        fallback.send(RunMsg::Checked(vec![check("system", CheckOutcome::Failed, found)]));
    }
}

fn check(what: &str, outcome: CheckOutcome, found: String) -> Check {
    Check { what: what.to_owned(), outcome, found }
}

/// Checks that the plugin files have not changed since they were surveyed.
fn plugins(tools: &Tools) -> Check {
    let found = tools.planners.get();
    let planners = &found.planners;
    let changed: Vec<&str> = planners
        .iter()
        .filter(|info| tools.plugins.sha256_of(&info.plugin).as_deref() != Some(&info.sha256))
        .map(|info| info.id.as_str())
        .collect();
    if changed.is_empty() {
        check("plugins", CheckOutcome::Passed, format!("files unchanged; planners: {}", planners.len()))
    } else {
        let found = format!("changed since the console was started: {}", changed.join(", "));
        check("plugins", CheckOutcome::Warning, found)
    }
}

fn disk(logs: &Path, needed_bytes: u64) -> Check {
    let needed_bytes = needed_bytes + RESERVE_BYTES;
    let megabytes = |bytes: u64| format!("{} MB", bytes / 1_000_000);
    match free_bytes(logs) {
        None => check("disk", CheckOutcome::Warning, "free space unknown".into()),
        Some(free) if free < needed_bytes => check(
            "disk",
            CheckOutcome::Failed,
            format!(
                "{} free, {} needed; delete runs or choose a different --logs",
                megabytes(free),
                megabytes(needed_bytes)
            ),
        ),
        Some(free) => check(
            "disk",
            CheckOutcome::Passed,
            format!("{} free, {} needed", megabytes(free), megabytes(needed_bytes)),
        ),
    }
}

fn recorder(logs: &Path) -> Check {
    let began = Instant::now();
    match check_recorder(logs) {
        Ok(bytes) => {
            let took_ms = began.elapsed().as_millis();
            check(
                "recorder",
                CheckOutcome::Passed,
                format!("wrote {bytes} bytes and read them back in {took_ms} ms"),
            )
        }
        Err(error) => check("recorder", CheckOutcome::Failed, error.to_string()),
    }
}

/// Measures how long an order to stop would wait for the engine.
fn stop(engine: Option<&EngineHandle>) -> Check {
    let Some(took) = engine.and_then(|engine| engine.measure(STOP_PATIENCE)) else {
        let found = format!("the engine did not answer within {} s", STOP_PATIENCE.as_secs());
        return check("stop", CheckOutcome::Failed, found);
    };
    let outcome = if took <= STOP_LIMIT { CheckOutcome::Passed } else { CheckOutcome::Warning };
    let took_ms = took.as_secs_f64() * 1e3;
    let answers = if took_ms < 0.1 { "< 0.1".to_owned() } else { format!("{took_ms:.1}") };
    let found = format!("engine answers in {answers} ms (limit {} ms)", STOP_LIMIT.as_millis());
    check("stop", outcome, found)
}

/// Checks that the wall clock runs at the same rate as the monotonic clock.
fn clock() -> Check {
    let (steady, wall) = (Instant::now(), SystemTime::now());
    thread::sleep(CLOCK_SPAN);
    let steady = steady.elapsed();
    let difference = wall.elapsed().map(|wall| wall.abs_diff(steady));
    match difference {
        Ok(difference) if difference <= CLOCK_LIMIT => check(
            "clock",
            CheckOutcome::Passed,
            format!("steady to within {:.1} ms", difference.as_secs_f64() * 1e3),
        ),
        Ok(difference) => check(
            "clock",
            CheckOutcome::Warning,
            format!("jumped by {:.0} ms: file times may be wrong", difference.as_secs_f64() * 1e3),
        ),
        Err(_) => check("clock", CheckOutcome::Warning, "jumped backwards: file times may be wrong".into()),
    }
}
