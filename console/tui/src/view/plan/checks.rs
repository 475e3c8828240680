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
    let mut lines: Vec<Line> = bad.into_iter().flat_map(|check| bad_lines(look, check, columns)).collect();
    // The checks without a figure are a sentence, those with one a table. If the figures do not fit, only the names of the
    // checks are shown.
    let (figures, names): (Vec<&Check>, Vec<&Check>) =
        good.iter().copied().partition(|check| has_figure(check));
    let figures: Vec<String> =
        figures.into_iter().map(|check| format!("{} {}", check.what, check.found)).collect();
    let full = [names_of(&names, columns), text::wrap_items(&figures, columns, "   ")].concat();
    let fits = lines.len() + full.len() <= rows;
    let passed = if fits { full } else { names_of(&good, columns) };
    lines.extend(passed.into_iter().map(|line| look.line([(Role::Good, format!(" {line}"))])));
    fill(frame, area, block, lines);
}

/// The names of checks that passed, as a sentence in lines.
fn names_of(checks: &[&Check], columns: usize) -> Vec<String> {
    let names: Vec<String> = checks.iter().map(|check| check.what.clone()).collect();
    let lines = text::wrap_items(&names, columns.saturating_sub(4), ", ").into_iter().enumerate();
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

/// A failed check or a warning with its reason, in as many lines as it needs.
fn bad_lines(look: &Look, check: &Check, columns: usize) -> Vec<Line<'static>> {
    let (role, word) = match check.outcome {
        CheckOutcome::Failed => (Role::Crit, "FAIL"),
        _ => (Role::Warn, "WARN"),
    };
    let mut found =
        text::wrap(&format!("{}: {}", check.what, check.found), columns.saturating_sub(6)).into_iter();
    let first = format!(" {}", found.next().unwrap_or_default());
    let first = look.line([(Role::Text, " ".into()), (role, word.into()), (Role::Text, first)]);
    let more = found.map(|words| look.line([(Role::Text, format!("      {words}"))]));
    std::iter::once(first).chain(more).collect()
}
