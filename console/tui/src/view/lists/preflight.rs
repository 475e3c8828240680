//! The list of pre-flight checks.

use super::list::{List, hint, paragraph};
use crate::theme::Role;
use crate::view::look::{Look, Parts as Row};
use crate::view::text;
use mission::{Check, CheckOutcome};

/// Width of the names of the automatic checks, columns.
const WHAT: usize = 12;

pub(super) fn list(look: &Look, selected: usize, columns: u16) -> List {
    let model = look.model;
    let checks = model.grouped_checks();
    let room = usize::from(columns).saturating_sub(4);
    let by_hand = checks.iter().filter(|(_, item)| item.is_some());
    let not_ticked = by_hand.filter(|(check, _)| check.outcome == CheckOutcome::Failed).count();
    let count =
        |outcome| checks.iter().filter(|(check, item)| item.is_none() && check.outcome == outcome).count();
    let blocks = Blocks { failed: count(CheckOutcome::Failed), not_ticked };
    let warned = count(CheckOutcome::Warning);
    let rows: Vec<Vec<Row>> = checks.iter().map(|(check, item)| entry(check, item.is_some(), room)).collect();
    let first = rows.iter().take(selected).map(Vec::len).sum();
    let selected_rows = rows.get(selected).map_or(1, Vec::len);
    // Every other check is already shown in full.
    let chosen = checks.get(selected).filter(|(check, item)| {
        item.is_some() || matches!(check.outcome, CheckOutcome::Passed | CheckOutcome::Ticked)
    });
    let ticked = |check: &Check| format!("{}: ticked {}", check.what, check.found).trim_end().to_owned();
    let chosen = chosen.map(|(check, _)| match check.outcome {
        CheckOutcome::Ticked => ticked(check),
        _ => format!("{}: {}", check.what, check.found),
    });
    let mut below: Vec<Row> = chosen.iter().flat_map(|words| paragraph(Role::Dim, words, room)).collect();
    let verdict = match (model.live.preflight.is_checking, blocks.sentence()) {
        (true, _) => (Role::Watch, " Checking...".to_owned()),
        (false, None) => {
            let words = [
                "Nothing blocks the start. The checks are repeated at the start.",
                "Nothing blocks the start.",
            ];
            (Role::Good, format!(" {}", text::wording(words.map(str::to_owned), room)))
        }
        (false, Some(why)) => (Role::Crit, format!(" Start is blocked: {why}.")),
    };
    below.push(vec![verdict]);
    let tick = if model.n_by_hand() > 0 { " <accept>: tick " } else { "" };
    below.push(hint(&look.keys(&format!("{tick} <check-again>: check again  <cancel>: close"))));
    let parts = [
        (blocks.failed, "FAIL"),
        (warned, "WARN"),
        (blocks.not_ticked, "to tick"),
        (count(CheckOutcome::Passed) + model.n_by_hand() - blocks.not_ticked, "ok"),
    ];
    let parts: Vec<String> =
        parts.iter().filter(|(n, _)| *n > 0).map(|(n, word)| format!("{n} {word}")).collect();
    List {
        title: format!("Pre-flight  {}", parts.join(", ")),
        note: note(&blocks, warned).into(),
        rows: rows.concat(),
        selected: first,
        selected_rows,
        needed_below: 2,
        below,
        ..List::default()
    }
}

/// The checks that block the start: failed ones, and items that are not ticked.
struct Blocks {
    failed: usize,
    not_ticked: usize,
}

impl Blocks {
    fn sentence(&self) -> Option<String> {
        let failed = (self.failed > 0).then(|| format!("{} FAIL", self.failed));
        let not_ticked = (self.not_ticked > 0).then(|| format!("{} not ticked", self.not_ticked));
        let parts: Vec<String> = failed.into_iter().chain(not_ticked).collect();
        (!parts.is_empty()).then(|| parts.join(", "))
    }
}

fn note(blocks: &Blocks, warned: usize) -> &'static str {
    match (blocks, warned) {
        (Blocks { failed: 1.., .. }, _) => "FAIL",
        (Blocks { not_ticked: 1.., .. }, _) => "NOT TICKED",
        (_, 0) => "all passed",
        _ => "WARNINGS",
    }
}

/// The rows of a check: a failed check or a warning is shown in full, any other in one row.
fn entry(check: &Check, by_hand: bool, room: usize) -> Vec<Row> {
    let (role, mark) = match (check.outcome, by_hand) {
        (CheckOutcome::Passed, _) => (Role::Good, "[ ok ]"),
        (CheckOutcome::Ticked, _) => (Role::Good, "[  x ]"),
        (CheckOutcome::Warning, _) => (Role::Warn, "[WARN]"),
        (CheckOutcome::Failed, true) => (Role::Crit, "[    ]"),
        (CheckOutcome::Failed, false) => (Role::Crit, "[FAIL]"),
    };
    let room = room.saturating_sub(7);
    let front = |text: &str| vec![(role, mark.to_owned()), (Role::Text, text.to_owned())];
    if by_hand {
        return vec![front(&text::clauses(&format!(" by hand: {}", check.what), room))];
    }
    let what = format!(" {} ", text::column(&check.what, WHAT));
    let rest = room.saturating_sub(text::width(&what));
    let found = match check.outcome {
        CheckOutcome::Failed | CheckOutcome::Warning => text::wrap(&check.found, rest),
        CheckOutcome::Passed | CheckOutcome::Ticked => vec![text::clauses(&check.found, rest)],
    };
    let mut found = found.into_iter();
    let first = front(&(what.clone() + &found.next().unwrap_or_default()));
    let indent = " ".repeat(mark.len() + text::width(&what));
    let more = found.map(|words| vec![(Role::Text, format!("{indent}{words}"))]);
    std::iter::once(first).chain(more).collect()
}
