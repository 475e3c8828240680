//! The list of past runs.

use super::pane::{Pane, sentence};
use super::{border, note};
use crate::model::PastRun;
use crate::model::home::HomeList;
use crate::theme::Role;
use crate::update::Rows;
use crate::view::look::{Look, Parts};
use crate::view::past_run::{Began, name};
use crate::view::text;
use ratatui::Frame;
use ratatui::layout::Rect;

/// Width of the columns, each with one space.
const END: usize = 11;
const REACH: usize = 8;
const VERIFIED: usize = 4;
/// Width of a duration with and without hours, columns.
const TIME: (usize, usize) = (9, 6);
/// Minimum width of a remark, columns.
const REMARK: usize = 12;
/// Maximum width of a planner, columns.
const PLANNER: usize = 17;

/// The widths of the columns that depend on the runs; 0 for a column that does not fit.
#[derive(Clone, Copy)]
struct Columns {
    began: Began,
    name: usize,
    planner: usize,
    time: usize,
    remark: usize,
}

/// The columns that fit; if the names would be cut, the planner is left out.
fn columns(listed: &[&PastRun], room: usize) -> Columns {
    let is_long = listed.iter().any(|run| run.mission_time_s.is_some_and(|s| s >= 3600.0));
    let time = if is_long { TIME.0 } else { TIME.1 };
    let widest = |name: fn(&PastRun) -> &str| {
        listed.iter().map(|run| text::width(name(run))).max().unwrap_or(0).max(8) + 1
    };
    let began = Began::of(listed);
    let left = room.saturating_sub(1 + began.width() + END + time + REACH + VERIFIED);
    let planner = widest(|run| &run.planner).min(PLANNER);
    let planner = if left.saturating_sub(planner) >= widest(name) { planner } else { 0 };
    // What the names do not need is for remarks, if it is enough for a few words.
    let remark = left.saturating_sub(planner + widest(name));
    let remark = if remark >= REMARK { remark } else { 0 };
    Columns { began, name: left - planner - remark, planner, time, remark }
}

/// The mark of a verified run.
pub(in crate::view) fn verified(run: &PastRun) -> &'static str {
    if run.verified.is_some() { "  ✓v" } else { "" }
}

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect, about: bool) {
    let home = &look.model.home;
    let listed = home.runs();
    let room = usize::from(area.width).saturating_sub(2);
    let at = columns(&listed, room);
    let is_focused = home.list == HomeList::Runs;
    let selected = home.selected_run().filter(|_| about);
    let verified_too = if listed.iter().any(|run| run.verified.is_some()) { "✓v verified" } else { "" };
    let pane = Pane {
        border: border(look, HomeList::Runs),
        title: "Past runs, UTC",
        note: if is_focused && !verified_too.is_empty() && home.filter.is_empty() {
            verified_too.into()
        } else {
            note(look, HomeList::Runs)
        },
        heads: Some(heads(at)),
        rows: listed.iter().map(|run| row(run, at)).collect(),
        selected: is_focused.then_some(home.run),
        list: Rows::Runs,
        empty: empty(look).into(),
        about: selected.map(|run| (run.name.clone(), about_lines(run, room))),
    };
    pane.draw(look, frame, area);
}

/// The text of an empty list. The run that has just ended is not in the list before the folder has been read again.
fn empty(look: &Look) -> &'static str {
    match look.model.live.result.as_ref().is_some_and(|result| result.is_kept) {
        _ if !look.model.home.filter.is_empty() => " No run matches.",
        true => " Reading the runs...",
        false => " No runs yet.",
    }
}

fn heads(at: Columns) -> String {
    let planner = if at.planner > 0 { text::column("planner", at.planner) } else { String::new() };
    format!(
        " {}{}{planner}{}{}{:>REACH$}{}",
        text::column("began", at.began.width()),
        text::column("scenario", at.name),
        text::column("end", END),
        text::column("T+", at.time),
        "reach",
        if at.remark > 0 { format!("{:VERIFIED$}  remark", "") } else { String::new() }
    )
}

fn row(run: &PastRun, at: Columns) -> Parts {
    let took = run.mission_time_s.map_or_else(|| "-".into(), text::clock);
    let took = if at.time < TIME.0 { took.strip_prefix("00:").unwrap_or(&took) } else { &took };
    let reach = run.reachable.map_or_else(|| "-".into(), |share| format!("{} %", text::percent(share)));
    vec![
        (Role::Dim, at.began.text(run)),
        (Role::Text, text::column(&text::fit(name(run), at.name.saturating_sub(1)), at.name)),
        (Role::Dim, text::column(&text::fit(&run.planner, at.planner.saturating_sub(1)), at.planner)),
        (role(run), text::column(end_word(run), END)),
        (Role::Dim, text::column(took, at.time)),
        (Role::Text, format!("{reach:>REACH$}")),
        (Role::Good, text::column(verified(run), VERIFIED)),
        remark(run, at.remark),
    ]
}

/// The problem of a run, or the remark about it, in the rest of its row.
fn remark(run: &PastRun, columns: usize) -> (Role, String) {
    let (role, words) = match (&run.note, &run.remark) {
        (Some(note), _) => (Role::Warn, note),
        (None, Some(remark)) => (Role::Text, remark),
        (None, None) => return (Role::Text, String::new()),
    };
    let first = words.split(';').next().unwrap_or_default();
    let words = text::wording([words.clone(), first.to_owned()], columns.saturating_sub(2));
    (role, if columns > 0 { format!("  {}", text::fit(&words, columns - 2)) } else { String::new() })
}

/// The problem of a run, or the remark about it.
fn about_lines(run: &PastRun, columns: usize) -> Vec<Parts> {
    let verified = run.verified.as_ref().map(|at| format!("Verified {at} UTC."));
    match (&run.note, &run.remark) {
        (Some(note), _) => sentence(Role::Warn, &text::capitalized(note), columns),
        (None, Some(remark)) => sentence(Role::Text, &format!("Remark: {remark}"), columns),
        (None, None) => {
            let words = verified.unwrap_or_else(|| "Not verified.".into());
            sentence(Role::Dim, &words, columns)
        }
    }
}

/// The role of a run's end.
pub(in crate::view) fn role(run: &PastRun) -> Role {
    if matches!(run.end.as_str(), "complete" | "aborted" | "RUNNING") { Role::Text } else { Role::Warn }
}

/// How a run ended, in at most ten columns.
pub(in crate::view) fn end_word(run: &PastRun) -> &str {
    match run.end.as_str() {
        "RECORDING FAILED" => "REC FAILED",
        "time_limit" => "time limit",
        other => other,
    }
}
