//! The review screen: past runs, details of the selected run, and the comparison of two runs.

mod compare;

use super::look::{Look, Parts, fill};
use super::{table, text};
use crate::model::ui::Arrangement;
use crate::model::{PastRun, Replay};
use crate::theme::Role;
use crate::update::Rows;
use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::text::Line;

/// Rows of the panes below the list, including frames.
const BELOW: (u16, u16) = (18, 10);
/// Width of the selected run's details when the comparison is shown, columns.
const ABOUT: u16 = 56;

pub(crate) fn draw(look: &Look, frame: &mut Frame, area: Rect, arrangement: Arrangement) {
    let wide = arrangement == Arrangement::Wide;
    let is_compared = look.model.live.replay.as_ref().is_some_and(|replay| replay.other.is_some());
    let rows = match arrangement {
        Arrangement::Wide => BELOW.0,
        _ if is_compared => BELOW.0.min(area.height.saturating_sub(6)),
        Arrangement::Paged => 0,
        _ => BELOW.1,
    };
    let [list, below] = Layout::vertical([Constraint::Fill(1), Constraint::Length(rows)]).areas(area);
    runs(look, frame, list);
    let compared = look.model.live.replay.as_ref().and_then(|replay| Some((replay, replay.other.as_ref()?)));
    match compared {
        Some((replay, other)) if wide => {
            let [left, right] =
                Layout::horizontal([Constraint::Length(ABOUT), Constraint::Fill(1)]).areas(below);
            about(look, frame, left);
            compare::draw(look, frame, right, (replay, other));
        }
        Some((replay, other)) => compare::draw(look, frame, below, (replay, other)),
        None if rows > 0 => about(look, frame, below),
        None => {}
    }
}

fn runs(look: &Look, frame: &mut Frame, area: Rect) {
    let (model, review) = (look.model, &look.model.review);
    let listed = review.runs(&model.home);
    let filter = if review.filter.is_empty() {
        look.keys("<filter> filter")
    } else {
        format!("`{}`", text::fit(&review.filter, 20))
    };
    let note = format!("{filter}  {} {}", look.keys("<sort> sort:"), review.sort.word());
    let block = look.block(Role::Focus, &format!("Runs  {}", listed.len()), &note);
    let inner = block.inner(area);
    let (columns, height) = (usize::from(inner.width), usize::from(inner.height).saturating_sub(1));
    let widths = widths(&listed, columns);
    let rows: Vec<Parts> =
        listed.iter().map(|run| row(run, mark(model.live.replay.as_deref(), run), widths)).collect();
    let selected = review.selected.min(rows.len().saturating_sub(1));
    let shown = table::window(selected, rows.len(), height);
    table::place(
        look,
        Rect { y: inner.y + 1, height: inner.height.saturating_sub(1), ..inner },
        Rows::Past,
        shown,
    );
    let mut lines = vec![look.line(head(widths))];
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
    scenario: usize,
    planner: usize,
    time: usize,
    notes: usize,
}

/// Width for how a run ended, including one blank, columns.
const END: usize = 10;
/// Width of mark, date, outcome and coverage, columns.
const FIXED: usize = 3 + 12 + END + 7;

/// The column widths; if space is short, the time is dropped first, then the planner.
fn widths(listed: &[&PastRun], columns: usize) -> Widths {
    let widest = |name: fn(&PastRun) -> &str| {
        listed.iter().map(|run| text::width(name(run))).max().unwrap_or(0).max(8) + 1
    };
    let time = if columns >= 100 { 9 } else { 0 };
    let room = columns.saturating_sub(FIXED + time);
    let planner = if columns >= 70 { widest(|run| &run.planner).min(room / 3) } else { 0 };
    let scenario = widest(|run| &run.scenario).min(room.saturating_sub(planner));
    Widths { scenario, planner, time, notes: room.saturating_sub(scenario + planner) }
}

fn head(widths: Widths) -> Parts {
    let words = [
        text::column("   began UTC", 15),
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
    let name = if run.scenario.is_empty() { &run.name } else { &run.scenario };
    vec![
        (Role::Title, format!("{mark} ")),
        (Role::Dim, text::column(&run.began, 12)),
        (Role::Text, text::column(name, widths.scenario)),
        (Role::Dim, text::column(&run.planner, widths.planner)),
        (role, text::column(&text::fit(&run.end, END - 1), END)),
        (Role::Dim, text::column(&time, widths.time)),
        (Role::Text, format!("{reach:>7}")),
        (Role::Dim, text::fit(&format!("  {}", notes(run)), widths.notes)),
    ]
}

/// Remarks, bookmarks and problems, shortest first.
fn notes(run: &PastRun) -> String {
    let bookmarks = (run.bookmarks > 0).then(|| format!("●{}", run.bookmarks));
    let all =
        bookmarks.into_iter().chain(run.remark.clone()).chain(run.note.as_ref().map(|_| "*".to_owned()));
    all.collect::<Vec<_>>().join(" ")
}

fn about(look: &Look, frame: &mut Frame, area: Rect) {
    let block = look.block(Role::Border, "Selected run", "");
    let columns = usize::from(block.inner(area).width).saturating_sub(2);
    let Some(run) = look.model.review.run(&look.model.home) else {
        return fill(frame, area, block, vec![look.line([(Role::Dim, " No run is selected.".into())])]);
    };
    let mut lines = wrapped(look, Role::Text, &run.name, columns);
    let end = format!("{} after {}", run.end, run.mission_time_s.map_or_else(|| "-".into(), text::clock));
    lines.extend(wrapped(look, Role::Text, &end, columns));
    if let Some(note) = &run.note {
        lines.extend(wrapped(look, Role::Warn, &format!("* {note}"), columns));
    }
    if let Some(remark) = &run.remark {
        lines.extend(wrapped(look, Role::Title, &format!("Remark: {remark}"), columns));
    }
    let replay = look.model.live.replay.as_ref().filter(|replay| replay.name == run.name);
    for bookmark in replay.iter().flat_map(|replay| &replay.notes.bookmarks) {
        let words = format!("● T+{} {}", text::clock(bookmark.t_s), bookmark.text);
        lines.extend(wrapped(look, Role::Text, &words, columns));
    }
    if replay.is_none() && run.bookmarks > 0 {
        let plural = if run.bookmarks == 1 { "" } else { "s" };
        let words = format!("● {} bookmark{plural}", run.bookmarks);
        lines.extend(wrapped(look, Role::Dim, &words, columns));
    }
    fill(frame, area, block, lines);
}

fn wrapped(look: &Look, role: Role, words: &str, columns: usize) -> Vec<Line<'static>> {
    let lines = text::wrap(words, columns).into_iter();
    lines.map(|line| look.line([(role, format!(" {}", text::fit(&line, columns)))])).collect()
}
