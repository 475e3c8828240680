//! The coverage pane: how much of the reachable and of the whole floor has been scanned, and what is left.

use super::look::{Look, fill, ranked};
use super::text;
use crate::model::coverage::Raster;
use crate::model::{Earlier, Live, Model, Pane, Run};
use crate::theme::Role;
use account::{Percent, Shares};
use mission::TaskConfig;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::Line;

/// Width of a label, of a share of the whole floor, and of the bar on a narrow screen, columns.
const LABEL: usize = 13;
const WHOLE: usize = 13;
const BAR: usize = 8;

/// The minimum width at which the pane uses full words, columns.
const WIDE: usize = 40;

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect) {
    let wide = usize::from(area.width) >= WIDE + 2;
    let bases = Bases::shown(look);
    let heading = format!("{}{:>WHOLE$}", bases.names[0], bases.names[1]);
    let block = look.pane(Pane::Coverage, "Coverage", if wide { &heading } else { "" });
    let inner = block.inner(area);
    let columns = usize::from(inner.width);
    let lines = if wide { wide_lines(look, &bases, columns) } else { narrow_lines(look, &bases) };
    fill(frame, area, block, ranked(lines, usize::from(inner.height)));
}

/// Whether no progress has been reported for two ticks although the mission is running.
fn is_stale(look: &Look) -> bool {
    let at_s = look.run.progress.as_ref().filter(|_| look.run.is_running()).map(|progress| progress.t_s);
    look.is_stale(at_s)
}

fn wide_lines(look: &Look, bases: &Bases, columns: usize) -> Vec<(u8, Line<'static>)> {
    let run = look.run;
    let [first_scanned, second_scanned] = bases.each(|percent| percent.scanned);
    let [first_to_do, second_to_do] = bases.each(|percent| percent.missed);
    let of_whole = |part: fn(&Percent) -> f64| percent(run, Raster::whole, part);
    let (margin, unreachable) = (of_whole(|percent| percent.margin), of_whole(|percent| percent.unreachable));
    let row = |rank: u8, label: &str, value: String| {
        (rank, look.line([(Role::Dim, format!(" {label:<LABEL$}")), (Role::Text, value)]))
    };
    // Each share is right-aligned with the name of the floor that it refers to.
    let first = columns.saturating_sub(LABEL + WHOLE + 3);
    let shares =
        |one: &str, other: &str| format!("{:>first$}{:>WHOLE$}", format!("{one} %"), format!("{other} %"));
    let mark = if is_stale(look) { "◌" } else { "" };
    let room = columns.saturating_sub(LABEL + 1);
    let out_of_reach = ["shell margin", "margin"].map(|name| format!("{unreachable} %, {name} {margin} %"));
    let out_of_reach = text::wording(out_of_reach, room);
    let overlap = run.coverage.as_ref().and_then(Raster::overlap).map_or_else(|| "-".into(), text::percent);
    let mut lines = vec![
        row(0, &format!("{mark}{}", word(look.model)), shares(&first_scanned, &second_scanned)),
        (1, look.line([(Role::Good, format!(" {}", bases.bar(columns.saturating_sub(2))))])),
        row(7, "unreachable", out_of_reach),
        row(5, "speed", pace(look.model, room)),
        row(4, way_label(run, room), way(run)),
        row(2, "time left", left(look, true)),
    ];
    // A drive to a goal or along a path has no floor to scan.
    if run.covers() {
        lines.insert(2, row(3, to_do_label(run), shares(&first_to_do, &second_to_do)));
    }
    // A drive to a goal scans on its way at most by chance.
    if !is_drive(run) {
        let after_speed = lines.len() - 2;
        lines.insert(after_speed, row(6, "overlap", format!("{overlap} % of scanned floor")));
    }
    lines.extend(channels(run, room).map(|strip| row(5, "channels", strip)));
    lines.extend(in_doubt(look.model).map(|words| {
        let label = (Role::Dim, format!(" {:<LABEL$}", "in doubt"));
        (1, look.line([label, (Role::Warn, text::wording(words, room))]))
    }));
    lines.extend(untestable(run).map(|share| row(4, "not testable", format!("{share} % of whole floor"))));
    lines
}

/// The channels of the instrument from left to right, as the robot sees them, and the numbers of the dead ones; `None`
/// if the instrument reads nothing.
fn channels(run: &Run, room: usize) -> Option<String> {
    let instrument = run.about.as_ref()?.mission.instrument.as_ref()?;
    let (count, dead) = (instrument.sampling?.channels, &run.dead_channels);
    if dead.is_empty() {
        return Some(format!("{count} work"));
    }
    let mark = |channel: u16| if dead.binary_search(&channel).is_ok() { '·' } else { '█' };
    let numbers: Vec<String> = dead.iter().map(ToString::to_string).collect();
    let numbers = format!("dead: {}", numbers.join(", "));
    let strip = format!("{} {numbers}", (0..count).rev().map(mark).collect::<String>());
    Some(text::wording([strip, numbers], room))
}

fn narrow_lines(look: &Look, bases: &Bases) -> Vec<(u8, Line<'static>)> {
    let run = look.run;
    let [first, second] = bases.each(|percent| percent.scanned);
    let [of_first, of_second] = bases.short;
    let text = |value: String| look.line([(Role::Text, format!(" {value}"))]);
    let left_or_missed = if run.has_missed() {
        format!("missed {} % of {of_first}", bases.each(|percent| percent.missed)[0])
    } else {
        format!("left {}", left(look, false))
    };
    let mark = if is_stale(look) { "◌" } else { " " };
    let doubt =
        in_doubt(look.model).map(|[_, short]| (1, look.line([(Role::Warn, format!(" in doubt {short}"))])));
    let lines = vec![
        (
            0,
            look.line([
                (Role::Good, format!(" {}", bases.bar(BAR))),
                (Role::Text, format!("{mark}{first:>5} % {of_first}")),
            ]),
        ),
        (3, text(format!("{:BAR$} {second:>5} % {of_second}", ""))),
        (2, text(format!("{} {}", way_label(run, 0), way(run)))),
        (1, text(left_or_missed)),
    ];
    doubt.into_iter().chain(lines).collect()
}

/// The floor in doubt, in a longer and a shorter wording; `None` if no floor is.
fn in_doubt(model: &Model) -> Option<[String; 2]> {
    let (area_m2, stations) = model.live.doubt()?;
    let since_s = model.live.in_doubt().first()?.floor.since_s;
    let short = format!("{} m², {stations}", text::number(area_m2, 1));
    Some([format!("{short}, since T+{}", text::clock(since_s)), short])
}

/// The two floors to which the scanned shares of a mission refer: the reachable and the whole floor; for a scan of a part
/// of the floor, the requested and the reachable floor; for a re-scan, the floor requested of it, and the reachable floor
/// scanned by all runs.
pub(crate) struct Bases {
    /// The shares; `None` before the first step.
    shares: Option<[Shares; 2]>,
    /// The names of the floors: as headings, and in a narrow pane.
    names: [&'static str; 2],
    short: [&'static str; 2],
    /// The floors in a sentence, without an article.
    pub floors: [&'static str; 2],
}

impl Bases {
    pub(crate) fn of(live: &Live) -> Self {
        Self::counted(live, Earlier::shares, Run::requested)
    }

    /// The same for a frame; the shares that need a look at every cell are counted again only if the floor has changed.
    pub(crate) fn shown(look: &Look) -> Self {
        let live = &look.model.live;
        Self::counted(
            live,
            |before, own| look.cache.borrow_mut().rescan(before, own),
            |run| look.cache.borrow_mut().requested(live.id, run),
        )
    }

    fn counted(
        live: &Live,
        of_rescan: impl Fn(&Earlier, &Raster) -> [Shares; 2],
        of_part: impl Fn(&Run) -> Option<Shares>,
    ) -> Self {
        let raster = live.run.coverage.as_ref().filter(|_| live.run.progress.is_some());
        match &live.scanned_before {
            Some(before) => Self {
                shares: raster.map(|own| of_rescan(before, own)),
                names: ["requested", "all runs"],
                short: ["requested", "all runs"],
                floors: ["requested floor", "floor requested of all runs"],
            },
            None if live.run.is_in_part() => Self {
                shares: raster.and_then(|own| Some([of_part(&live.run)?, own.reachable()])),
                names: ["requested", "reachable"],
                short: ["requested", "reachable"],
                floors: ["requested floor", "reachable floor"],
            },
            None => Self {
                shares: raster.map(|own| [own.reachable(), own.whole()]),
                names: ["reachable", "whole floor"],
                short: ["reachable", "whole"],
                floors: ["reachable floor", "whole floor"],
            },
        }
    }

    /// A share of each floor, as the report prints it; dashes before the first step.
    fn each(&self, part: fn(&Percent) -> f64) -> [String; 2] {
        let number = |shares: &Shares| text::number(part(&shares.percent), 1);
        self.shares
            .as_ref()
            .map_or_else(|| ["-".into(), "-".into()], |[one, other]| [number(one), number(other)])
    }

    /// The scanned shares of each floor; dashes before the first step.
    pub(crate) fn scanned(&self) -> [String; 2] {
        self.each(|percent| percent.scanned)
    }

    /// The scanned share of the first floor, as a sentence.
    pub(crate) fn sentence(&self) -> String {
        format!("{} % of {} scanned.", self.scanned()[0], self.floors[0])
    }

    fn bar(&self, columns: usize) -> String {
        let scanned = self.shares.as_ref().map_or(0.0, |[first, _]| first.percent.scanned / 100.0);
        text::bar(scanned, columns)
    }
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

/// What the tool did with the floor under it: a mission that does not scan passes over floor.
fn word(model: &Model) -> &'static str {
    if model.live.run.covers() || model.live.is_rescan() { "scanned" } else { "passed over" }
}

/// Whether the task is only to drive to a goal.
fn is_drive(run: &Run) -> bool {
    run.about.as_ref().is_some_and(|about| matches!(about.mission.task, TaskConfig::Goto { .. }))
}

/// The label for unscanned floor: still to do, or missed once the mission has ended.
fn to_do_label(run: &Run) -> &'static str {
    if run.has_ended() { "missed" } else { "to do" }
}

/// The speed over ground while the robot may move, the scanned floor per minute, and the scanned floor.
fn pace(model: &Model, room: usize) -> String {
    let run = &model.live.run;
    let scanned_m2 = run.coverage.as_ref().map_or(0.0, Raster::scanned_m2);
    let minutes = run.clock.moving_s / 60.0;
    let rate = if minutes > 0.2 { text::number(scanned_m2 / minutes, 1) } else { "-".into() };
    let speed = run.speed_m_per_s().map_or_else(|| "-".into(), |speed| text::number(speed, 2));
    let pace = format!("{speed} m/s, {rate} m²/min");
    let scanned = text::number(scanned_m2, 0);
    let what = word(model);
    text::wording([format!("{pace}, {scanned} m² {what}"), pace], room)
}

/// The label of the path that the task presets or, without one, of the planner's path; the two have different lengths.
/// `room` is the width of the value, columns; 0 in a narrow pane.
fn way_label(run: &Run, room: usize) -> &'static str {
    match run.about.as_ref().is_some_and(|about| about.preset_m.is_some()) {
        true if room > 0 => "preset path",
        true => "preset",
        false => "plan",
    }
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
