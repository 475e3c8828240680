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
    let checks = model.checks();
    let first_by_hand = checks.len() - model.n_by_hand();
    let room = usize::from(columns).saturating_sub(4);
    let count = |outcome| checks.iter().filter(|check| check.outcome == outcome).count();
    let (blocking, warned) = (count(CheckOutcome::Failed), count(CheckOutcome::Warning));
    let failed = checks[..first_by_hand].iter().filter(|check| check.outcome == CheckOutcome::Failed).count();
    let blocks = Blocks { failed, not_ticked: blocking - failed };
    let rows =
        checks.iter().enumerate().map(|(index, check)| row(check, index >= first_by_hand, room)).collect();
    let mut below: Vec<Row> = checks
        .get(selected)
        .into_iter()
        .flat_map(|check| paragraph(Role::Dim, &format!("{}: {}", check.what, check.found), room))
        .collect();
    let verdict = match (model.live.preflight.is_checking, blocks.sentence()) {
        (true, _) => (Role::Watch, " Checking...".to_owned()),
        (false, None) => {
            (Role::Good, " Nothing blocks the start. The checks are repeated at the start.".to_owned())
        }
        (false, Some(why)) => (Role::Crit, format!(" Start is blocked: {why}.")),
    };
    below.push(vec![verdict]);
    // Here, where nothing moves yet, the key that holds the robot ticks an item.
    let tick = if model.n_by_hand() > 0 { " <hold>: tick " } else { "" };
    below.push(hint(&look.keys(&format!("{tick} <check-again>: check again  <cancel>: close"))));
    List {
        title: format!("Pre-flight  {} checks, {} by hand", first_by_hand, model.n_by_hand()),
        note: note(&blocks, warned).into(),
        rows,
        selected,
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

fn row(check: &Check, by_hand: bool, room: usize) -> Row {
    let (role, mark) = match (check.outcome, by_hand) {
        (CheckOutcome::Passed, _) => (Role::Good, "[ ok ]"),
        (CheckOutcome::Ticked, _) => (Role::Good, "[  x ]"),
        (CheckOutcome::Warning, _) => (Role::Warn, "[WARN]"),
        (CheckOutcome::Failed, true) => (Role::Crit, "[    ]"),
        (CheckOutcome::Failed, false) => (Role::Crit, "[FAIL]"),
    };
    let room = room.saturating_sub(7);
    let words = if by_hand {
        text::clauses(&format!(" by hand: {}", check.what), room)
    } else {
        let what = format!(" {} ", text::column(&check.what, WHAT));
        let found = text::clauses(&check.found, room.saturating_sub(text::width(&what)));
        what + &found
    };
    vec![(role, mark.to_owned()), (Role::Text, words)]
}
