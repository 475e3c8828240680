//! The account of the papers: every equation, table, figure and claim, what became of it here, and what shows it.

mod pan;
mod wang;
mod xu;
mod yang;

use std::fmt::Write;

/// What became of an item of a paper.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum State {
    /// Here, and it agrees.
    Reproduced,
    /// It agrees by a number or a layout that was fitted to the printed values.
    Fitted,
    /// Here by a reading of what the text leaves open or prints wrong.
    Read,
    /// Something of ours stands in its place or goes beyond it.
    Ours,
    /// It was computed and does not come out.
    Missed,
    /// Not here.
    Absent,
}

impl State {
    /// For people.
    pub fn words(self) -> &'static str {
        match self {
            Self::Reproduced => "reproduced",
            Self::Fitted => "fitted",
            Self::Read => "read",
            Self::Ours => "ours",
            Self::Missed => "does not come out",
            Self::Absent => "not there",
        }
    }
}

/// An equation, table, figure or claim of a paper.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Item {
    /// Where in the paper: `Eq. 4`, `Table 1`, `Claim`.
    pub place: &'static str,
    /// What it is.
    pub what: &'static str,
    /// What became of it.
    pub state: State,
    /// The command that shows it; empty if nothing does.
    pub command: &'static str,
    /// What a reader must know: how it was read, what does not agree, why it is not there.
    pub why: &'static str,
}

/// A paper and all of its items.
#[derive(Debug, Clone, Copy)]
pub struct Paper {
    /// Author and year, as in `references.md`.
    pub name: &'static str,
    /// Its items, in the paper's order.
    pub items: &'static [Item],
}

/// The four papers.
pub const PAPERS: [Paper; 4] = [wang::PAPER, xu::PAPER, yang::PAPER, pan::PAPER];

const fn item(
    place: &'static str,
    what: &'static str,
    state: State,
    command: &'static str,
    why: &'static str,
) -> Item {
    Item { place, what, state, command, why }
}

/// The account for people.
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

    /// The words after `tankops` of a command.
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
            assert!(named.contains(study.name), "{} shows nothing of a paper", study.name);
        }
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
