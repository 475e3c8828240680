//! The coverage pane: how much of the reachable and of the whole floor has been scanned, and what is left.

use super::look::{Look, fill, ranked};
use super::text;
use crate::model::coverage::Raster;
use crate::model::{Pane, Run};
use crate::theme::Role;
use account::{Percent, Shares};
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::Line;

/// The headings of the two columns of shares, on a wide screen.
const BASES: &str = "reachable  whole floor";
/// Width of a label, of a share of the whole floor, and of the bar on a narrow screen, columns.
const LABEL: usize = 13;
const WHOLE: usize = 13;
const BAR: usize = 8;

/// The minimum width at which the pane uses full words, columns.
const WIDE: usize = 40;

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect) {
    let wide = usize::from(area.width) >= WIDE + 2;
    let block = look.pane(Pane::Coverage, "Coverage", if wide { BASES } else { "" });
    let inner = block.inner(area);
    let columns = usize::from(inner.width);
    let lines = if wide { wide_lines(look, columns) } else { narrow_lines(look) };
    fill(frame, area, block, ranked(lines, usize::from(inner.height)));
}

/// Whether no progress has been reported for two ticks although the mission is running.
fn is_stale(look: &Look) -> bool {
    let at_s = look.run.progress.as_ref().filter(|_| look.run.is_running()).map(|progress| progress.t_s);
    look.is_stale(at_s)
}

fn wide_lines(look: &Look, columns: usize) -> Vec<(u8, Line<'static>)> {
    let run = look.run;
    let (reachable, whole) = shares(run);
    let of_whole = |part: fn(&Percent) -> f64| percent(run, Raster::whole, part);
    let (to_do, margin) = (of_whole(|percent| percent.missed), of_whole(|percent| percent.margin));
    let unreachable = of_whole(|percent| percent.unreachable);
    let to_do_reachable = percent(run, Raster::reachable, |percent| percent.missed);
    let row = |rank: u8, label: &str, value: String| {
        (rank, look.line([(Role::Dim, format!(" {label:<LABEL$}")), (Role::Text, value)]))
    };
    // Each share is right-aligned with the name of the floor that it refers to.
    let first = columns.saturating_sub(LABEL + WHOLE + 3);
    let shares = |of_reachable: String, of_whole: &str| {
        format!("{of_reachable:>first$}{:>WHOLE$}", format!("{of_whole} %"))
    };
    let mark = if is_stale(look) { "◌" } else { "" };
    let room = columns.saturating_sub(LABEL + 1);
    let untestable = untestable(run);
    let out_of_reach = [("shell margin", "not testable"), ("margin", "untestable"), ("margin", "untest.")]
        .map(|(name, not)| {
            let untestable = untestable.as_ref().map(|share| format!(", {not} {share} %"));
            format!("{unreachable} %, {name} {margin} %{}", untestable.unwrap_or_default())
        });
    let out_of_reach = text::wording(out_of_reach, room);
    let overlap = run.coverage.as_ref().and_then(Raster::overlap).map_or_else(|| "-".into(), text::percent);
    vec![
        row(0, &format!("{mark}scanned"), shares(format!("{reachable} %"), &whole)),
        (1, look.line([(Role::Good, format!(" {}", bar(run, columns.saturating_sub(2))))])),
        row(3, to_do_label(run), shares(format!("{to_do_reachable} %"), &to_do)),
        row(7, "unreachable", out_of_reach),
        row(5, "speed", pace(run, room)),
        row(6, "overlap", format!("{overlap} % of scanned floor")),
        row(4, way_label(run), way(run)),
        row(2, "time left", left(look, true)),
    ]
}

fn narrow_lines(look: &Look) -> Vec<(u8, Line<'static>)> {
    let run = look.run;
    let (reachable, whole) = shares(run);
    let text = |value: String| look.line([(Role::Text, format!(" {value}"))]);
    let left_or_missed = if run.has_missed() {
        format!("missed {} % of reachable", percent(run, Raster::reachable, |percent| percent.missed))
    } else {
        format!("left {}", left(look, false))
    };
    let mark = if is_stale(look) { "◌" } else { " " };
    vec![
        (
            0,
            look.line([
                (Role::Good, format!(" {}", bar(run, BAR))),
                (Role::Text, format!("{mark}{reachable:>5} % reachable")),
            ]),
        ),
        (3, text(format!("{:BAR$} {whole:>5} % whole", ""))),
        (2, text(format!("{} {}", way_label(run), way(run)))),
        (1, text(left_or_missed)),
    ]
}

/// The scanned shares of the reachable floor and of the whole floor; dashes before the first step.
pub(crate) fn shares(run: &Run) -> (String, String) {
    let scanned = |of: fn(&Raster) -> Shares| percent(run, of, |percent| percent.scanned);
    (scanned(Raster::reachable), scanned(Raster::whole))
}

/// A share of the floor, as the report prints it; a dash before the first step.
fn percent(run: &Run, of: fn(&Raster) -> Shares, part: fn(&Percent) -> f64) -> String {
    let raster = run.coverage.as_ref().filter(|_| run.progress.is_some());
    raster.map_or_else(|| "-".into(), |raster| text::number(part(&of(raster).percent), 1))
}

/// The share of the whole floor that the tool cannot test; `None` if the tool can test all floor.
fn untestable(run: &Run) -> Option<String> {
    let percent = run.coverage.as_ref()?.whole().percent.untestable;
    (percent > 0.0).then(|| text::number(percent, 1))
}

fn bar(run: &Run, columns: usize) -> String {
    text::bar(run.progress.as_ref().map_or(0.0, |progress| progress.covered_reachable), columns)
}

/// The label for unscanned floor: still to do, or missed once a mission whose task was to scan has ended.
fn to_do_label(run: &Run) -> &'static str {
    match (run.has_missed(), run.has_ended()) {
        (true, _) => "missed",
        (false, true) => "not scanned",
        (false, false) => "to do",
    }
}

/// The speed over ground while the robot may move, the scanned floor per minute, and the scanned floor.
fn pace(run: &Run, room: usize) -> String {
    let scanned_m2 = run.coverage.as_ref().map_or(0.0, Raster::scanned_m2);
    let minutes = run.clock.moving_s / 60.0;
    let rate = if minutes > 0.2 { text::number(scanned_m2 / minutes, 1) } else { "-".into() };
    let speed = run.speed_m_per_s().map_or_else(|| "-".into(), |speed| text::number(speed, 2));
    let pace = format!("{speed} m/s, {rate} m²/min");
    let scanned = text::number(scanned_m2, 0);
    text::wording([format!("{pace}, {scanned} m² scanned"), format!("{pace}, {scanned} m²"), pace], room)
}

fn way_label(run: &Run) -> &'static str {
    if run.about.as_ref().is_some_and(|about| about.preset_m.is_some()) { "path" } else { "plan" }
}

fn way(run: &Run) -> String {
    let preset_m = run.about.as_ref().and_then(|about| about.preset_m);
    match (preset_m, &run.progress) {
        (Some(preset_m), Some(progress)) => {
            let along = progress.along_m.map_or_else(|| "-".into(), |along_m| text::number(along_m, 1));
            format!("{along} m of {} m", text::number(preset_m, 1))
        }
        (Some(preset_m), None) => format!("0.0 m of {} m", text::number(preset_m, 1)),
        (None, _) => run
            .planning
            .plan
            .as_ref()
            .map_or_else(|| "- m".into(), |plan| format!("{} m", text::number(plan.length_m, 1))),
    }
}

/// The remaining mission time, and the mission time at the end.
pub(super) fn left(look: &Look, wide: bool) -> String {
    let run = look.run;
    let Some(left_s) = look.model.live.left_s() else {
        return if run.has_ended() { "ended".into() } else { "-".into() };
    };
    if run.clock.started_s.is_none() {
        return format!("{} from the start", text::clock(left_s));
    }
    let end = text::clock(run.clock.t_s + left_s);
    if wide {
        format!("{}, ends T+{end}", text::clock(left_s))
    } else {
        format!("{} to T+{end}", text::clock(left_s))
    }
}
