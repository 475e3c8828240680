//! Compares the console's measurements of itself with their limits.

use crate::model::alarms::{
    Reading,
    limit::{Edge, Watch},
};
use crate::model::{Cause, Measured, Model, Watches, health, health::ByMotion};
use mission::Severity;

/// Takes a measurement of the console itself.
pub(super) fn take(model: &mut Model, measured: Measured) {
    match measured {
        Measured::Screen { response_ms, skipped } => {
            // Without key presses, nobody is waiting.
            let response_ms = response_ms.unwrap_or(0.0);
            compare(model, &RESPONSE, response_ms);
            compare(model, &FRAMES, f64::from(skipped));
        }
        Measured::Disk(bytes) => compare(model, &DISK, bytes as f64 / f64::from(1 << 20)),
    }
}

/// Receives the number of ticks by which the recorder is behind.
pub(super) fn take_lag(model: &mut Model, ticks: u64) {
    compare(model, &RECORDER_LAG, ticks as f64);
}

/// A monitored figure of the console.
struct Figure {
    cause: Cause,
    severity: Severity,
    limit: ByMotion,
    unit: &'static str,
    watch: fn(&mut Watches) -> &mut Watch,
    text: &'static str,
}

const RESPONSE: Figure = Figure {
    cause: Cause::Response,
    severity: Severity::Watch,
    limit: health::RESPONSE_MS,
    unit: "ms",
    watch: |watches| &mut watches.response,
    text: "console responds slowly: key to frame",
};
const FRAMES: Figure = Figure {
    cause: Cause::Frames,
    severity: Severity::Watch,
    limit: health::FRAMES,
    unit: "in 10 s",
    watch: |watches| &mut watches.frames,
    text: "screen skips frames:",
};
const RECORDER_LAG: Figure = Figure {
    cause: Cause::RecorderLag,
    severity: Severity::Warn,
    limit: health::RECORDER_LAG,
    unit: "ticks",
    watch: |watches| &mut watches.recorder_lag,
    text: "recorder is behind by",
};
const DISK: Figure = Figure {
    cause: Cause::Disk,
    severity: Severity::Warn,
    limit: health::DISK_MB,
    unit: "MB",
    watch: |watches| &mut watches.disk,
    text: "disk space left for runs:",
};

fn compare(model: &mut Model, figure: &Figure, value: f64) {
    let Figure { cause, severity, limit, unit, watch, text } = figure;
    let limit = limit.of(model.live.may_move());
    let t_s = model.live.run.clock.t_s;
    let now_s = model.console.now.mono_s;
    let watch = watch(&mut model.console.watches);
    let edge = watch.take(limit, value, now_s);
    let run = &mut model.live.run;
    // A run opened since then does not have the alarms yet.
    let is_lost = watch.is_on() && run.alarms.get(cause).is_none();
    let edge = edge.or(is_lost.then_some(Edge::Raised));
    match edge {
        Some(Edge::Raised) => {
            let text = format!("{text} {value:.0} {unit}, limit {:.0} {unit}", limit.alarm);
            run.log.add(t_s, *severity, "console", text.clone());
            run.alarms.raise(cause.clone(), *severity, text, t_s);
            run.alarms.note(cause, run.log.newest().unwrap_or_default(), None);
        }
        Some(Edge::Cleared) => {
            run.alarms.clear(cause, t_s);
            let text = format!("{text} {value:.0} {unit}, back within limit");
            run.log.add(t_s, Severity::Info, "console", text);
            run.alarms.note(cause, run.log.newest().unwrap_or_default(), None);
        }
        None => {}
    }
    run.alarms.read(cause, t_s, || Reading {
        now: format!("{value:.0} {unit}"),
        limit: format!("{:.0} {unit}", limit.alarm),
        numbers: Some((value, Some(limit.alarm))),
    });
}
