//! The pre-flight checks in brief: what blocks the start and what warns, then what passed.

use crate::model::Pane;
use crate::theme::Role;
use crate::view::look::{Look, fill};
use crate::view::text;
use mission::{Check, CheckOutcome};
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::Line;

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect) {
    let checks = look.model.checks();
    let keys = if area.width >= 44 { look.keys("<preflight> all") } else { look.keys("<preflight>") };
    let room = usize::from(area.width)
        .saturating_sub(text::width(&keys) + text::width(&look.pane_key(Pane::Checks)) + 8);
    let title = text::wording(titles(&checks, look.model.n_by_hand()), room);
    let block = look.pane(Pane::Checks, &title, &keys);
    let columns = usize::from(block.inner(area).width).saturating_sub(1);
    let rows = usize::from(block.inner(area).height);
    let (bad, good): (Vec<&Check>, Vec<&Check>) = checks.iter().partition(|check| is_bad(check));
    let mut lines = bad_in(look, &bad, columns, rows);
    let rest = rows.saturating_sub(lines.len());
    // The checks without a figure are a sentence, those with one a table. If the figures do not fit, only the names of the
    // checks are shown.
    let (figures, names): (Vec<&Check>, Vec<&Check>) =
        good.iter().copied().partition(|check| has_figure(check));
    let figures: Vec<String> =
        figures.into_iter().map(|check| format!("{} {}", check.what, check.found)).collect();
    let full = [names_of(&names, columns), text::wrap_items(&figures, columns, "   ")].concat();
    let passed = if full.len() <= rest { full } else { names_in(&good, columns, rest) };
    lines.extend(passed.into_iter().map(|line| look.line([(Role::Good, format!(" {line}"))])));
    fill(frame, area, block, lines);
}

/// The failed checks and the warnings in a number of rows. Each has a row of its own before one of them has a second, and
/// those without a row are counted.
fn bad_in(look: &Look, bad: &[&Check], columns: usize, rows: usize) -> Vec<Line<'static>> {
    let counted = bad.len() > rows;
    let shown = if counted { rows.saturating_sub(1) } else { bad.len() };
    let mut spare = rows.saturating_sub(shown);
    let mut lines = Vec::new();
    for check in &bad[..shown] {
        let whole = bad_lines(look, check, columns);
        let extra = whole.len().saturating_sub(1);
        if extra <= spare && !counted {
            spare -= extra;
            lines.extend(whole);
        } else {
            lines.push(bad_line(look, check, columns));
        }
    }
    if counted && rows == 1 {
        let names: Vec<&str> = bad.iter().map(|check| check.what.as_str()).collect();
        let (role, word) = mark(bad[0]);
        let text = text::fit(&format!(" {word}: {}", names.join(", ")), columns);
        lines.push(look.line([(role, text)]));
    } else if counted && rows > 0 {
        lines.push(look.line([(Role::Warn, format!(" and {} more", bad.len() - shown))]));
    }
    lines
}

/// The names of checks that passed, as a sentence in lines.
fn names_of(checks: &[&Check], columns: usize) -> Vec<String> {
    let names: Vec<String> = checks.iter().map(|check| check.what.clone()).collect();
    named(&names, columns)
}

/// The names that fit into a number of lines, with the number of the others.
fn names_in(checks: &[&Check], columns: usize, rows: usize) -> Vec<String> {
    let first = |n: usize| {
        let more = checks.len() - n;
        let more = (more > 0).then(|| format!("and {more} more"));
        let names: Vec<String> = checks[..n].iter().map(|check| check.what.clone()).chain(more).collect();
        named(&names, columns)
    };
    (0..=checks.len()).rev().map(first).find(|lines| lines.len() <= rows).unwrap_or_default()
}

fn named(names: &[String], columns: usize) -> Vec<String> {
    let lines = text::wrap_items(names, columns.saturating_sub(4), ", ").into_iter().enumerate();
    lines.map(|(index, line)| format!("{}{line}", if index == 0 { "ok: " } else { "" })).collect()
}

/// The title with its counts, from the longest wording to the shortest: what blocks or warns is left out last.
fn titles(checks: &[Check], by_hand: usize) -> [String; 4] {
    let count = |outcome: CheckOutcome| checks.iter().filter(|check| check.outcome == outcome).count();
    let ok = count(CheckOutcome::Passed) + count(CheckOutcome::Ticked);
    let (failed, warned) = (count(CheckOutcome::Failed), count(CheckOutcome::Warning));
    let failed = if failed > 0 { format!(", {failed} FAIL") } else { String::new() };
    let warned = if warned > 0 { format!(", {warned} WARN") } else { String::new() };
    let by_hand = if by_hand > 0 { format!(", {by_hand} by hand") } else { String::new() };
    let bad = format!("{failed}{warned}");
    let bad = bad.strip_prefix(", ").unwrap_or("ok");
    [
        format!("Pre-flight  {ok} ok{failed}{warned}{by_hand}"),
        format!("Pre-flight  {ok} ok{failed}{warned}"),
        format!("Pre-flight  {bad}"),
        "Pre-flight".to_owned(),
    ]
}

fn is_bad(check: &Check) -> bool {
    matches!(check.outcome, CheckOutcome::Failed | CheckOutcome::Warning)
}

/// Whether the finding is short enough for a summary.
fn has_figure(check: &Check) -> bool {
    check.outcome == CheckOutcome::Passed && text::width(&check.found) <= 24
}

/// The mark of a failed check or of a warning.
fn mark(check: &Check) -> (Role, String) {
    match check.outcome {
        CheckOutcome::Failed => (Role::Crit, "FAIL".into()),
        _ => (Role::Warn, "WARN".into()),
    }
}

/// A failed check or a warning in one line: the clauses that fit or, if only its name does, as many words as fit.
fn bad_line(look: &Look, check: &Check, columns: usize) -> Line<'static> {
    let (whole, room) = (format!("{}: {}", check.what, check.found), columns.saturating_sub(6));
    let clauses = text::clauses(&whole, room);
    let is_name = clauses.trim_end_matches('…') == check.what;
    let words = if is_name { text::wrap(&whole, room).into_iter().next() } else { None };
    let words = words.unwrap_or(clauses);
    look.line([(Role::Text, " ".into()), mark(check), (Role::Text, format!(" {words}"))])
}

/// A failed check or a warning with its reason, in as many lines as it needs.
fn bad_lines(look: &Look, check: &Check, columns: usize) -> Vec<Line<'static>> {
    let mut found =
        text::wrap(&format!("{}: {}", check.what, check.found), columns.saturating_sub(6)).into_iter();
    let first = format!(" {}", found.next().unwrap_or_default());
    let first = look.line([(Role::Text, " ".into()), mark(check), (Role::Text, first)]);
    let more = found.map(|words| look.line([(Role::Text, format!("      {words}"))]));
    std::iter::once(first).chain(more).collect()
}
