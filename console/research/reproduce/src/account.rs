//! The account of the papers: every equation, table, figure and claim, its state in tankops, and the command that
//! demonstrates it.

mod pan;
mod wang;
mod xu;
mod yang;

use std::fmt::Write;

/// The state of an item of a paper in tankops.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum State {
    /// Implemented, and our result agrees with the paper.
    Reproduced,
    /// Our result agrees, but a number or a layout was fitted to the printed values.
    Fitted,
    /// Implemented with our interpretation, because the text leaves details open or prints them wrong.
    Read,
    /// Replaced or extended by our own work.
    Ours,
    /// Computed, but our result differs from the paper.
    Missed,
    /// Not implemented.
    Absent,
}

impl State {
    /// The state in human-readable words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Reproduced => "reproduced",
            Self::Fitted => "fitted",
            Self::Read => "read",
            Self::Ours => "ours",
            Self::Missed => "not reproduced",
            Self::Absent => "missing",
        }
    }
}

/// An equation, table, figure or claim of a paper.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Item {
    /// Place in the paper: `Eq. 4`, `Table 1`, `Claim`.
    pub place: &'static str,
    /// Description of the item.
    pub what: &'static str,
    /// State of the item.
    pub state: State,
    /// The command that demonstrates the item; empty if there is none.
    pub command: &'static str,
    /// A note for the reader: how we interpreted the item, what disagrees, or why it is missing.
    pub why: &'static str,
}

/// A paper and all of its items.
#[derive(Debug, Clone, Copy)]
pub struct Paper {
    /// Author and year, as in `references.md`.
    pub name: &'static str,
    /// The items of the paper, in its order.
    pub items: &'static [Item],
}

/// The four papers.
pub const PAPERS: [Paper; 4] = [wang::PAPER, xu::PAPER, yang::PAPER, pan::PAPER];

/// The studies of our own work, which show nothing of a paper.
const OWN: [&str; 2] = ["two-surveys", "tether-physics"];

const fn item(
    place: &'static str,
    what: &'static str,
    state: State,
    command: &'static str,
    why: &'static str,
) -> Item {
    Item { place, what, state, command, why }
}

/// Formats the account as human-readable text.
pub(crate) fn text() -> String {
    let mut text = String::new();
    for paper in PAPERS {
        // Writing to a String cannot fail.
        let _ = writeln!(text, "\n{}", paper.name);
        for Item { place, what, state, command, why } in paper.items {
            let _ = writeln!(text, "  {place:<16} {:<18} {what}", state.words());
            for line in [why, command].into_iter().filter(|line| !line.is_empty()) {
                let _ = writeln!(text, "  {:<35} {line}", "");
            }
        }
    }
    let _ = writeln!(text, "\nStudies of our own: {}", OWN.join(", "));
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{studies, study};
    use std::{collections::BTreeSet, path::Path};

    fn items() -> impl Iterator<Item = &'static Item> {
        PAPERS.iter().flat_map(|paper| paper.items)
    }

    /// The words of a command, without `tankops`.
    fn words(item: &'static Item) -> Vec<&'static str> {
        item.command.split_whitespace().skip(1).collect()
    }

    #[test]
    fn every_command_names_a_study_or_a_scenario_that_exists() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..");
        for item in items().filter(|item| !item.command.is_empty()) {
            assert!(item.command.starts_with("tankops "), "{item:?}");
            match words(item)[..] {
                ["reproduce", name, ..] => assert!(study(name).is_ok(), "{item:?}"),
                ["run" | "plan", file, ..] => assert!(root.join(file).is_file(), "{item:?}"),
                ["tune" | "planners", ..] => {}
                _ => panic!("{item:?}"),
            }
        }
    }

    #[test]
    fn every_study_is_named() {
        let named: BTreeSet<&str> =
            items().filter_map(|item| words(item).strip_prefix(&["reproduce"])?.first().copied()).collect();
        for study in studies() {
            let is_own = OWN.contains(&study.name);
            assert!(named.contains(study.name) != is_own, "{} shows nothing of a paper", study.name);
        }
        assert!(OWN.iter().all(|name| study(name).is_ok()));
    }

    #[test]
    fn what_is_not_reproduced_says_why_and_what_is_there_shows_it() {
        for item in items() {
            assert!(item.state == State::Reproduced || !item.why.is_empty(), "{item:?}");
            assert_eq!(item.command.is_empty(), item.state == State::Absent, "{item:?}");
        }
    }

    #[test]
    fn the_papers_are_those_of_the_references() {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/references.md");
        let references = std::fs::read_to_string(file).expect("the references");
        assert!(PAPERS.iter().all(|paper| references.contains(&format!("**{}.**", paper.name))));
    }
}
