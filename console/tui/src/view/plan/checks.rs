//! The pre-flight checks in brief: what blocks the start and what warns, then what passed.

use crate::model::{Model, Pane};
use crate::theme::Role;
use crate::view::look::{Look, fill};
use crate::view::text;
use mission::{Check, CheckOutcome, Phase};
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::Line;

/// Width of the mark of a check, with the blanks around it, columns.
const MARK: usize = 6;

/// Checks that need attention.
struct Bad {
    role: Role,
    mark: &'static str,
    /// The name.
    what: String,
    /// The name and the reason.
    whole: String,
}

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect) {
    let checks = look.model.checks();
    let keys = if area.width >= 44 { look.keys("<preflight> all") } else { look.keys("<preflight>") };
    let room = usize::from(area.width)
        .saturating_sub(text::width(&keys) + text::width(&look.pane_key(Pane::Checks)) + 8);
    let title = text::wording(titles(look.model), room);
    let block = look.pane(Pane::Checks, &title, &keys);
    let columns = usize::from(block.inner(area).width).saturating_sub(1);
    let rows = usize::from(block.inner(area).height);
    let mut lines = bad_in(look, &bad(look.model), columns, rows);
    let good: Vec<&Check> = checks.iter().filter(|check| !is_bad(check)).collect();
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

/// The rows, with the frame, in which every check that needs attention has its reason; 0 if none does.
pub(super) fn rows(look: &Look, width: u16) -> u16 {
    let columns = usize::from(width).saturating_sub(3);
    let rows: usize = bad(look.model).iter().map(|bad| bad.lines(columns).len()).sum();
    if rows == 0 { 0 } else { (rows + 2).min(usize::from(u16::MAX)) as u16 }
}

/// The numbers of the checks that need attention before the start, with the key that lists them; `None` if there are none.
pub(super) fn in_a_line(look: &Look) -> Option<(Role, String)> {
    let role = bad(look.model).first()?.role;
    let counts = Counts::of(look.model).bad();
    let is_waiting = *look.run.phase() == Phase::Waiting;
    is_waiting.then(|| (role, look.keys(&format!("{counts}: <preflight>"))))
}

/// The checks that need attention: failed ones, then the items of the checklist that are not ticked as one, then warnings.
fn bad(model: &Model) -> Vec<Bad> {
    let checks = model.checks();
    let first_by_hand = checks.len() - model.n_by_hand();
    let (own, by_hand) = checks.split_at(first_by_hand);
    let of = |outcome: CheckOutcome, role: Role, mark: &'static str| {
        let found = own.iter().filter(move |check| check.outcome == outcome);
        found.map(move |check| Bad {
            role,
            mark,
            what: check.what.clone(),
            whole: format!("{}: {}", check.what, check.found),
        })
    };
    let open: Vec<&str> = by_hand
        .iter()
        .filter(|check| check.outcome == CheckOutcome::Failed)
        .map(|check| check.what.as_str())
        .collect();
    let what = open.join(", ");
    let to_tick = (!open.is_empty()).then(|| Bad {
        role: Role::Crit,
        mark: "TICK",
        whole: format!("{what}: not ticked"),
        what,
    });
    of(CheckOutcome::Failed, Role::Crit, "FAIL")
        .chain(to_tick)
        .chain(of(CheckOutcome::Warning, Role::Warn, "WARN"))
        .collect()
}

impl Bad {
    /// The name and the reason in as many lines as they need.
    fn lines(&self, columns: usize) -> Vec<String> {
        text::wrap(&self.whole, columns.saturating_sub(MARK))
    }

    /// The fewest lines in which the check is shown: a name without its reason says too little.
    fn least(&self, columns: usize) -> usize {
        text::wrap(text::first_clause(&self.whole), columns.saturating_sub(MARK)).len()
    }
}

/// The checks that need attention in a number of rows. Each has its reason, as far as it fits; checks for which no rows are
/// left are named in one line.
fn bad_in(look: &Look, bad: &[Bad], columns: usize, rows: usize) -> Vec<Line<'static>> {
    let least = |shown: usize| -> usize {
        let others = usize::from(shown < bad.len());
        bad[..shown].iter().map(|bad| bad.least(columns)).sum::<usize>() + others
    };
    let shown = (0..=bad.len()).rev().find(|shown| least(*shown) <= rows).unwrap_or(0);
    let mut spare = rows.saturating_sub(least(shown));
    let mut lines = Vec::new();
    for bad in &bad[..shown] {
        let needed = bad.lines(columns).len();
        let extra = (needed - bad.least(columns)).min(spare);
        spare -= extra;
        let words = text::clauses_in(&bad.whole, bad.least(columns) + extra, columns.saturating_sub(MARK));
        for (index, words) in words.into_iter().enumerate() {
            let front = if index == 0 {
                [(Role::Text, " "), (bad.role, bad.mark), (Role::Text, " ")]
            } else {
                [(Role::Text, ""), (Role::Text, "      "), (Role::Text, "")]
            };
            let front = front.map(|(role, words)| (role, words.to_owned()));
            lines.push(look.line(front.into_iter().chain([(Role::Text, words)])));
        }
    }
    if let Some(first) = bad.get(shown).filter(|_| rows > 0) {
        let words = named_in(&bad[shown..], columns.saturating_sub(MARK));
        lines.push(look.line([
            (Role::Text, " ".into()),
            (first.role, first.mark.to_owned()),
            (Role::Text, format!(" {words}")),
        ]));
    }
    lines
}

/// The names that fit into a line, with the number of the others.
fn named_in(bad: &[Bad], columns: usize) -> String {
    let first = |n: usize| {
        let more = bad.len() - n;
        let more =
            (more > 0).then(|| if n > 0 { format!("and {more} more") } else { format!("{more} checks") });
        bad[..n].iter().map(|bad| bad.what.clone()).chain(more).collect::<Vec<_>>().join(", ")
    };
    let mut wordings = (0..=bad.len()).rev().map(first);
    wordings.find(|words| text::width(words) <= columns).unwrap_or_default()
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

/// The numbers of checks by outcome.
struct Counts {
    ok: usize,
    failed: usize,
    /// Items of the checklist that are not ticked.
    to_tick: usize,
    warned: usize,
}

impl Counts {
    fn of(model: &Model) -> Self {
        let checks = model.checks();
        let (own, by_hand) = checks.split_at(checks.len() - model.n_by_hand());
        let count =
            |checks: &[Check], outcome| checks.iter().filter(|check| check.outcome == outcome).count();
        Self {
            ok: count(own, CheckOutcome::Passed) + count(by_hand, CheckOutcome::Ticked),
            failed: count(own, CheckOutcome::Failed),
            to_tick: count(by_hand, CheckOutcome::Failed),
            warned: count(own, CheckOutcome::Warning),
        }
    }

    /// What needs attention; empty if nothing does.
    fn bad(&self) -> String {
        let parts = [(self.failed, "FAIL"), (self.to_tick, "to tick"), (self.warned, "WARN")];
        let parts = parts.into_iter().filter(|(n, _)| *n > 0);
        parts.map(|(n, word)| format!("{n} {word}")).collect::<Vec<_>>().join(", ")
    }
}

/// The title with its counts, from the longest wording to the shortest.
fn titles(model: &Model) -> [String; 4] {
    let counts = Counts::of(model);
    let bad = counts.bad();
    let ok = format!("{} ok", counts.ok);
    let whole = if bad.is_empty() { ok.clone() } else { format!("{ok}, {bad}") };
    let brief = if bad.is_empty() { ok } else { bad };
    [format!("Pre-flight  {whole}"), format!("Pre-flight  {brief}"), format!("Checks  {brief}"), brief]
}

fn is_bad(check: &Check) -> bool {
    matches!(check.outcome, CheckOutcome::Failed | CheckOutcome::Warning)
}

/// Whether the finding is short enough for a summary.
fn has_figure(check: &Check) -> bool {
    check.outcome == CheckOutcome::Passed && text::width(&check.found) <= 24
}
