//! The review screen: past runs, details of the selected run, and the comparison of two runs.

mod compare;

use super::look::{Look, Parts, fill};
use super::scroll::Extent;
use super::{past_run, run_details, table, text};
use crate::model::replay::Other;
use crate::model::ui::Arrangement;
use crate::model::{Glimpse, Pane, PastRun, Replay};
use crate::theme::Role;
use crate::update::Rows;
use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};

/// Rows of the panes below the list, including frames.
const BELOW: (u16, u16) = (18, 10);
/// Width of the selected run's details when the comparison is shown, columns.
const ABOUT: u16 = 56;
/// Columns from which the selected run is beside the list, and the width of its pane.
const LARGE: u16 = 170;
const DETAIL: u16 = 88;
/// The fewest rows of the list above a comparison on a large screen, including the frame.
const LEAST_LIST: u16 = 8;

/// How much of the details of the selected run is visible.
pub(crate) fn extent(look: &Look, area: Rect) -> Option<Extent> {
    let run = look.model.review.run(&look.model.home)?;
    Some(past_run::extent(look, detail(look, area)?, run))
}

/// The area of the selected run's details; `None` if a comparison takes their place.
fn detail(look: &Look, area: Rect) -> Option<Rect> {
    let arrangement = look.model.ui.arrangement();
    if arrangement == Arrangement::Paged {
        return Some(area);
    }
    if arrangement == Arrangement::Wide && area.width >= LARGE {
        return Some(
            Layout::horizontal([Constraint::Fill(1), Constraint::Length(DETAIL)]).areas::<2>(area)[1],
        );
    }
    let [_, below] =
        Layout::vertical([Constraint::Fill(1), Constraint::Length(rows(look, area, arrangement))])
            .areas(area);
    match compared(look) {
        Some(_) if arrangement == Arrangement::Wide => {
            Some(Layout::horizontal([Constraint::Length(ABOUT), Constraint::Fill(1)]).areas::<2>(below)[0])
        }
        Some(_) => None,
        None => Some(below),
    }
}

/// The rows below the list. A small screen shows one pane at a time.
fn rows(look: &Look, area: Rect, arrangement: Arrangement) -> u16 {
    match arrangement {
        Arrangement::Wide => BELOW.0,
        _ if compared(look).is_some() => BELOW.0.min(area.height.saturating_sub(6)),
        Arrangement::Narrow => BELOW.1,
        Arrangement::Paged | Arrangement::Strip => 0,
    }
}

pub(crate) fn draw(look: &Look, frame: &mut Frame, area: Rect, arrangement: Arrangement) {
    if arrangement == Arrangement::Paged && look.model.ui.focus() == Pane::Detail {
        return about(look, frame, area);
    }
    if arrangement == Arrangement::Wide && area.width >= LARGE {
        let [left, right] = Layout::horizontal([Constraint::Fill(1), Constraint::Length(DETAIL)]).areas(area);
        large(look, frame, left);
        return about(look, frame, right);
    }
    let rows = rows(look, area, arrangement);
    let [list, below] = Layout::vertical([Constraint::Fill(1), Constraint::Length(rows)]).areas(area);
    runs(look, frame, list);
    match compared(look) {
        Some(compared) if arrangement == Arrangement::Wide => {
            let [left, right] =
                Layout::horizontal([Constraint::Length(ABOUT), Constraint::Fill(1)]).areas(below);
            about(look, frame, left);
            compare::draw(look, frame, right, compared);
        }
        Some(compared) => compare::draw(look, frame, below, compared),
        None if rows > 0 => about(look, frame, below),
        None => {}
    }
}

/// Below the list, a large screen shows the details of the selected run, or a comparison.
fn large(look: &Look, frame: &mut Frame, area: Rect) {
    let wanted = (look.model.review.runs(&look.model.home).len() as u16).saturating_add(3);
    if let Some(compared) = compared(look) {
        let details = glimpse(look);
        let figures = if details.is_some() { compare::rows(look, compared) } else { BELOW.0 };
        let list = if details.is_some() { wanted.max(LEAST_LIST).min(area.height / 3) } else { area.height };
        let [list, below, rest] = Layout::vertical([
            Constraint::Max(list),
            Constraint::Length(figures),
            Constraint::Fill(u16::from(details.is_some())),
        ])
        .areas(area);
        runs(look, frame, list);
        if let Some(details) = details {
            run_details::draw(look, frame, rest, details, true);
        }
        return compare::draw(look, frame, below, compared);
    }
    let glimpse = glimpse(look);
    // The list keeps at least a third of the screen.
    let list = if glimpse.is_some() { wanted.max(area.height / 3).min(area.height / 2) } else { area.height };
    let [list, below] = Layout::vertical([Constraint::Length(list), Constraint::Fill(1)]).areas(area);
    runs(look, frame, list);
    if let Some(glimpse) = glimpse {
        run_details::draw(look, frame, below, glimpse, true);
    }
}

/// The details of the selected run, once they have been read.
fn glimpse<'a>(look: &Look<'a>) -> Option<&'a Glimpse> {
    let run = look.model.review.run(&look.model.home)?;
    look.model.home.glimpses.of(&run.name)?.as_ref().ok().map(|glimpse| &**glimpse)
}

/// The replayed run and the one with which it is compared.
fn compared<'a>(look: &Look<'a>) -> Option<(&'a Replay, &'a Other)> {
    let replay = look.model.live.replay.as_ref()?;
    Some((replay, replay.other.as_ref()?))
}

fn runs(look: &Look, frame: &mut Frame, area: Rect) {
    let (model, review) = (look.model, &look.model.review);
    let listed = review.runs(&model.home);
    let filter = if review.filter.is_empty() {
        look.keys("<filter> filter")
    } else {
        look.keys(&format!("filter `{}`  <cancel> clear", text::fit(&review.filter, 20)))
    };
    let note = format!("{filter}  {} {}", look.keys("<sort> sort:"), review.sort.word());
    let inner = look.block(Role::Focus, "", "").inner(area);
    let (columns, height) = (usize::from(inner.width), usize::from(inner.height).saturating_sub(1));
    let widths = widths(&listed, columns);
    let rows: Vec<Parts> =
        listed.iter().map(|run| row(run, mark(model.live.replay.as_deref(), run), widths)).collect();
    let selected = review.selected.min(rows.len().saturating_sub(1));
    let shown = table::window(selected, rows.len(), height);
    let block = look.pane(Pane::List, &format!("Runs  {}", table::counted(&shown, rows.len())), &note);
    let place = Rect { y: inner.y + 1, height: inner.height.saturating_sub(1), ..inner };
    table::place(look, place, Rows::Past, shown.clone());
    let mut lines: Vec<ratatui::text::Line> = vec![look.line(head(widths))];
    lines.extend(table::rows(look, rows, Some(selected), (columns, height)));
    if listed.is_empty() {
        let words = match &model.home.found {
            None => " Looking for runs...".to_owned(),
            Some(found) if found.runs.is_empty() => format!(" No runs in {}.", found.logs),
            Some(_) => look.keys(" No run contains all these words. <filter>, then <cancel>: clear filter."),
        };
        lines.push(look.line([(Role::Dim, words)]));
    }
    fill(frame, area, block, lines);
    table::bar(look, frame, place, &shown, listed.len());
}

/// The mark of the replayed run, or of the run with which it is compared.
fn mark(replay: Option<&Replay>, run: &PastRun) -> &'static str {
    let Some(replay) = replay else { return " " };
    let is_other = replay.other.as_ref().is_some_and(|other| other.name == run.name);
    match (replay.name == run.name, is_other) {
        (true, _) => "A",
        (_, true) => "B",
        _ => " ",
    }
}

/// The widths of the table columns.
#[derive(Clone, Copy)]
struct Widths {
    began: past_run::Began,
    scenario: usize,
    planner: usize,
    time: usize,
    notes: usize,
}

/// Width for how a run ended, including one blank, columns.
const END: usize = 10;
/// Width of the mark, the outcome and the coverage together, columns.
const FIXED: usize = 3 + END + 7;

/// The column widths; if space is short, the time is dropped first, then the planner.
fn widths(listed: &[&PastRun], columns: usize) -> Widths {
    let widest = |name: fn(&PastRun) -> &str| {
        listed.iter().map(|run| text::width(name(run))).max().unwrap_or(0).max(8) + 1
    };
    let time = if columns >= 100 { 9 } else { 0 };
    let began = past_run::Began::of(listed);
    let room = columns.saturating_sub(FIXED + began.width() + time);
    let planner = if columns >= 70 { widest(|run| &run.planner).min(room / 3) } else { 0 };
    let scenario = widest(|run| &run.scenario).min(room.saturating_sub(planner));
    Widths { began, scenario, planner, time, notes: room.saturating_sub(scenario + planner) }
}

fn head(widths: Widths) -> Parts {
    let words = [
        text::column("   began UTC", 3 + widths.began.width()),
        text::column("scenario", widths.scenario),
        text::column(if widths.planner > 0 { "planner" } else { "" }, widths.planner),
        text::column("end", END),
        text::column(if widths.time > 0 { "T+" } else { "" }, widths.time),
        "reach %".into(),
        if widths.notes > 7 { "  notes" } else { "" }.into(),
    ];
    vec![(Role::Dim, words.concat())]
}

fn row(run: &PastRun, mark: &str, widths: Widths) -> Parts {
    let time = run.mission_time_s.map_or_else(|| "-".into(), text::clock);
    let reach = run.reachable.map_or_else(|| "-".into(), text::percent);
    let is_sound = matches!(run.end.as_str(), "complete" | "aborted");
    let role = if is_sound { Role::Text } else { Role::Warn };
    let name = past_run::name(run);
    vec![
        (Role::Title, format!("{mark} ")),
        (Role::Dim, widths.began.text(run)),
        (Role::Text, text::column(name, widths.scenario)),
        (Role::Dim, text::column(&run.planner, widths.planner)),
        (role, text::column(&text::fit(&run.end, END - 1), END)),
        (Role::Dim, text::column(&time, widths.time)),
        (Role::Text, format!("{reach:>7}")),
        (Role::Dim, fitting_notes(run, widths.notes)),
    ]
}

/// The mark of a verified run, bookmarks, the remark, and the mark of a problem, shortest first.
fn notes(run: &PastRun) -> String {
    let verified = run.verified.as_ref().map(|_| "✓v".to_owned());
    let bookmarks = (run.bookmarks > 0).then(|| format!("●{}", run.bookmarks));
    let problem = run.note.as_ref().map(|_| "! problem".to_owned());
    let all = verified.into_iter().chain(bookmarks).chain(run.remark.clone()).chain(problem);
    all.collect::<Vec<_>>().join(" ")
}

/// The notes as far as they say something in a given width.
fn fitting_notes(run: &PastRun, columns: usize) -> String {
    let notes = text::fit(&format!("  {}", notes(run)), columns);
    if columns < LEAST_NOTES && notes.contains('…') { String::new() } else { notes }
}

/// The width from which a shortened note is shown, columns.
const LEAST_NOTES: usize = 8;

fn about(look: &Look, frame: &mut Frame, area: Rect) {
    if let Some(run) = look.model.review.run(&look.model.home) {
        return past_run::draw(look, frame, area, run);
    }
    let lines = vec![look.line([(Role::Dim, " No run is selected.".into())])];
    fill(frame, area, look.pane(Pane::Detail, "Selected run", ""), lines);
}
