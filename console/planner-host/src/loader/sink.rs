//! The console's services in the worker: they copy what a planner passes, up to a limit.

use crate::Progress;
use crate::checks::limits::{MOST_CUTS, MOST_DRAWINGS, MOST_LOGS, MOST_PARAMS, MOST_POINTS, MOST_SCALARS};
use crate::wire::answer::Said;
use mission::{ParamInfo, ParamKind};
use nalgebra::Point2;
use planner_api::LogLevel;
use planner_api::abi::{self, Draw, Host, Leg, Param, Str, Vec2, output};
use std::ffi::c_void;

/// The maximum size of private state, bytes. States and plans that are too large are refused; surplus drawings, figures
/// and messages are counted and dropped.
const MOST_STATE_BYTES: usize = 1 << 20;
const LONGEST_MESSAGE: usize = 1024;
/// The maximum length of a text in a table, bytes.
pub(super) const LONGEST_TEXT: usize = 4096;

/// The console's side of a call: the deadline, whether drawings are shown, and the progress.
pub(crate) trait Watch {
    /// Returns 0 to continue, 1 if the call was cancelled, 2 if the deadline has passed.
    fn should_stop(&self) -> u32;
    /// Returns the time until the deadline, seconds.
    fn time_left_s(&self) -> f64;
    /// Whether drawings are shown.
    fn wants_drawing(&self) -> bool;
    /// Receives progress as soon as the planner reports it.
    fn take_progress(&self, progress: Progress);
}

/// Collects what a planner passes during one call.
pub(crate) struct Sink<'a> {
    watch: &'a dyn Watch,
    error: String,
    said: Said,
    n_dropped: usize,
    /// The limit that was exceeded, for data that is useless unless it is complete.
    pub(super) exceeds: Option<&'static str>,
    pub(super) params: Vec<ParamInfo>,
    pub(super) points: Vec<Point2<f64>>,
    pub(super) legs: Vec<Leg>,
    pub(super) cuts: Vec<Vec<Point2<f64>>>,
    n_cut_points: usize,
    pub(super) bytes: Vec<u8>,
}

impl<'a> Sink<'a> {
    /// Creates an empty sink.
    pub(crate) fn new(watch: &'a dyn Watch) -> Self {
        Self {
            watch,
            error: String::new(),
            said: Said::default(),
            n_dropped: 0,
            exceeds: None,
            params: Vec::new(),
            points: Vec::new(),
            legs: Vec::new(),
            cuts: Vec::new(),
            n_cut_points: 0,
            bytes: Vec::new(),
        }
    }

    /// Calls a function of the planner with these services.
    pub(super) fn during<R>(&mut self, call: impl FnOnce(*const Host) -> R) -> R {
        let host = Host {
            size: size_of::<Host>() as u32,
            abi_minor: abi::MINOR,
            ctx: (&raw mut *self).cast(),
            should_stop: Some(should_stop),
            time_left_s: Some(time_left_s),
            wants_drawing: Some(wants_drawing),
            error: Some(take_error),
            log: Some(take_log),
            param: Some(take_param),
            points: Some(take_points),
            draw: Some(take_draws),
            scalar: Some(take_scalar),
            bytes: Some(take_bytes),
            legs: Some(take_legs),
            cut: Some(take_cut),
            progress: Some(take_progress),
        };
        call(&raw const host)
    }

    /// Takes the sentence of a refusal.
    pub(super) fn take_error(&mut self) -> String {
        let error = std::mem::take(&mut self.error);
        if error.is_empty() { "no reason given".to_owned() } else { error }
    }

    /// Takes what was drawn, reported and logged; adds a message if anything was dropped.
    pub(crate) fn take_said(&mut self) -> Said {
        let mut said = std::mem::take(&mut self.said);
        if self.n_dropped > 0 {
            let dropped = format!(
                "dropped drawings, figures or messages: {}; there were too many, or they were not finite",
                self.n_dropped
            );
            said.logs.push((LogLevel::Warn, dropped));
        }
        said
    }
}

/// Prepares a text from the plugin for display: at most `most` bytes, without control characters.
pub(super) fn plain(raw: Str, most: usize) -> String {
    // SAFETY: the plugin promises that its texts have the stated length.
    foreign::plain(&unsafe { raw.to_text(most) }).into_owned()
}

/// Takes as many values as there is space for and counts the rest as dropped.
fn take<'v, T>(values: &'v [T], have: usize, most: usize, n_dropped: &mut usize) -> &'v [T] {
    let (taken, surplus) = values.split_at(values.len().min(most.saturating_sub(have)));
    *n_dropped += surplus.len();
    taken
}

/// Takes all values, or none if there is no space for all, because a part of a path would be a different path.
fn whole<'v, T>(
    values: &'v [T],
    have: usize,
    most: usize,
    exceeds: &mut Option<&'static str>,
    what: &'static str,
) -> &'v [T] {
    if values.len() <= most - have {
        return values;
    }
    *exceeds = Some(what);
    &[]
}

/// Returns the sink behind a service's first argument.
unsafe fn sink<'s>(ctx: *mut c_void) -> &'s mut Sink<'s> {
    // SAFETY: `during` passes the sink, nothing else uses it during the call, and services are called one at a time.
    unsafe { &mut *ctx.cast::<Sink<'s>>() }
}

unsafe extern "C" fn should_stop(ctx: *mut c_void) -> u32 {
    // SAFETY: `ctx` is the sink, here and in every service below.
    unsafe { sink(ctx) }.watch.should_stop()
}

unsafe extern "C" fn time_left_s(ctx: *mut c_void) -> f64 {
    // SAFETY: as above.
    unsafe { sink(ctx) }.watch.time_left_s()
}

unsafe extern "C" fn wants_drawing(ctx: *mut c_void) -> u32 {
    // SAFETY: as above.
    u32::from(unsafe { sink(ctx) }.watch.wants_drawing())
}

unsafe extern "C" fn take_error(ctx: *mut c_void, ptr: *const u8, len: usize) {
    // SAFETY: as above.
    unsafe { sink(ctx) }.error = plain(Str { ptr, len }, LONGEST_MESSAGE);
}

unsafe extern "C" fn take_log(ctx: *mut c_void, level: u32, ptr: *const u8, len: usize) {
    // SAFETY: as above.
    let sink = unsafe { sink(ctx) };
    if sink.said.logs.len() < MOST_LOGS {
        sink.said.logs.push((log_level(level), plain(Str { ptr, len }, LONGEST_MESSAGE)));
    } else {
        sink.n_dropped += 1;
    }
}

unsafe extern "C" fn take_points(ctx: *mut c_void, ptr: *const Vec2, n: usize) {
    // SAFETY: as above, and the plugin promises `n` points.
    let (sink, points) = unsafe { (sink(ctx), abi::slice(ptr, n)) };
    let taken = whole(
        points,
        sink.points.len(),
        MOST_POINTS,
        &mut sink.exceeds,
        "a path of more than 1000000 points",
    );
    sink.points.extend(taken.iter().copied().map(Point2::from));
}

unsafe extern "C" fn take_legs(ctx: *mut c_void, ptr: *const Leg, n: usize) {
    // SAFETY: as above, and the plugin promises `n` legs.
    let (sink, legs) = unsafe { (sink(ctx), abi::slice(ptr, n)) };
    let taken = whole(legs, sink.legs.len(), MOST_POINTS, &mut sink.exceeds, "more than 1000000 legs");
    sink.legs.extend_from_slice(taken);
}

unsafe extern "C" fn take_cut(ctx: *mut c_void, ptr: *const Vec2, n: usize) {
    // SAFETY: as above, and the plugin promises `n` points.
    let (sink, points) = unsafe { (sink(ctx), abi::slice(ptr, n)) };
    if sink.cuts.len() >= MOST_CUTS {
        sink.exceeds = Some("more than 10000 cuts");
        return;
    }
    let taken =
        whole(points, sink.n_cut_points, MOST_POINTS, &mut sink.exceeds, "cuts of more than 1000000 points");
    sink.n_cut_points += taken.len();
    sink.cuts.push(taken.iter().copied().map(Point2::from).collect());
}

unsafe extern "C" fn take_draws(ctx: *mut c_void, ptr: *const Draw, n: usize) {
    // SAFETY: as above, and the plugin promises `n` drawings.
    let (sink, draws) = unsafe { (sink(ctx), abi::slice(ptr, n)) };
    let taken = take(draws, sink.said.drawings.len(), MOST_DRAWINGS, &mut sink.n_dropped);
    let before = sink.said.drawings.len();
    sink.said.drawings.extend(taken.iter().filter_map(Draw::get));
    sink.n_dropped += taken.len() - (sink.said.drawings.len() - before);
}

unsafe extern "C" fn take_scalar(ctx: *mut c_void, name: Str, value: f64, unit: Str) {
    // SAFETY: as above.
    let sink = unsafe { sink(ctx) };
    if value.is_finite() && sink.said.scalars.len() < MOST_SCALARS {
        sink.said.scalars.push((plain(name, 64), value, plain(unit, 64)));
    } else {
        sink.n_dropped += 1;
    }
}

unsafe extern "C" fn take_progress(ctx: *mut c_void, share: f64, ptr: *const u8, len: usize) {
    // A share that is NaN carries no information.
    if share.is_finite() {
        let what = plain(Str { ptr, len }, Progress::LONGEST);
        // SAFETY: as above.
        unsafe { sink(ctx) }.watch.take_progress(Progress { share: share.clamp(0.0, 1.0), what });
    }
}

unsafe extern "C" fn take_bytes(ctx: *mut c_void, ptr: *const u8, n: usize) {
    // SAFETY: as above, and the plugin promises `n` bytes.
    let (sink, bytes) = unsafe { (sink(ctx), abi::slice(ptr, n)) };
    let taken = whole(
        bytes,
        sink.bytes.len(),
        MOST_STATE_BYTES,
        &mut sink.exceeds,
        "a state of more than 1048576 bytes",
    );
    sink.bytes.extend_from_slice(taken);
}

unsafe extern "C" fn take_param(ctx: *mut c_void, param: *const Param) {
    // SAFETY: as above.
    let sink = unsafe { sink(ctx) };
    if param.is_null() || sink.params.len() >= MOST_PARAMS {
        sink.n_dropped += 1;
        return;
    }
    // SAFETY: the plugin promises a parameter with the size that it states.
    sink.params.push(param_info(&unsafe { abi::copy_sized(param) }));
}

/// Converts a level that was passed across the boundary; an unknown level becomes a warning.
fn log_level(number: u32) -> LogLevel {
    match number {
        0 => LogLevel::Debug,
        1 => LogLevel::Info,
        _ => LogLevel::Warn,
    }
}

fn param_info(raw: &Param) -> ParamInfo {
    let text = |raw| plain(raw, LONGEST_TEXT);
    let (min, max, default) = (raw.min, raw.max, raw.default);
    let kind = match raw.kind {
        output::PARAM_INT => ParamKind::Int { min: min as i64, max: max as i64, default: default as i64 },
        output::PARAM_FLAG => ParamKind::Flag { default: default != 0.0 },
        output::PARAM_CHOICE => {
            let options: Vec<String> = text(raw.options).split('|').map(str::to_owned).collect();
            let default = options.get(default as usize).cloned().unwrap_or_default();
            ParamKind::Choice { options, default }
        }
        // A parameter kind from a later version is still a number.
        _ => ParamKind::Float { min, max, default },
    };
    ParamInfo {
        key: text(raw.key),
        label: text(raw.label),
        unit: text(raw.unit),
        help: text(raw.help),
        group: text(raw.group),
        kind,
        live: raw.flags & output::PARAM_LIVE != 0,
    }
}
