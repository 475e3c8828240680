//! Finds actions by key, by name, and by what the operator types.

use super::context::Context;
use super::keymap::Keymap;
use super::{ACTIONS, Action, ActionId, Risk};
use crate::keys::Key;

/// The action that a key runs in the given contexts.
pub fn action_for(keys: &Keymap, key: Key, contexts: &[Context]) -> Option<&'static Action> {
    ACTIONS.iter().find(|action| action.works_in(contexts) && keys.of(action).contains(&key))
}

/// The row of an action; the first if the action has several.
pub fn row(id: ActionId) -> Option<&'static Action> {
    ACTIONS.iter().find(|action| action.id == id)
}

/// The actions that a sentence names by placeholders, such as `<planner>`; `<press>` is only a verb.
pub fn named_in(sentence: &str) -> impl Iterator<Item = &'static Action> {
    let names = sentence.split('<').skip(1).filter_map(|part| Some(part.split_once('>')?.0));
    names.filter_map(|name| ACTIONS.iter().find(|action| action.name == name))
}

/// Every action that is a command.
pub fn commands() -> impl Iterator<Item = &'static Action> {
    ACTIONS.iter().filter(|action| action.is_command())
}

/// The keys that work in these contexts without being commands: they move through a list or open its selected line.
pub fn keys_of(contexts: &[Context]) -> impl Iterator<Item = &'static Action> {
    ACTIONS.iter().filter(move |action| !action.is_command() && action.works_in(contexts))
}

/// The command with exactly this name or synonym.
pub fn named(word: &str) -> Option<&'static Action> {
    let word = squashed(word);
    let by = |names: fn(&Action) -> Vec<&str>| {
        commands().find(|action| names(action).iter().any(|name| squashed(name) == word))
    };
    by(|action| vec![action.name]).or_else(|| by(|action| action.synonyms.to_vec()))
}

/// How well a command matches the typed text, from the best match to the worst.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Match {
    /// The text equals the name or a synonym.
    Exact,
    /// The name begins with the text.
    Name,
    /// A synonym begins with the text.
    Synonym,
    /// The text consists of the initials of the name's words.
    Initials,
    /// The name contains the text.
    Within,
    /// Each typed word begins a word of the description.
    Description,
}

impl Match {
    /// Matches a command against the typed text. A command that moves the robot or ends the mission matches only the
    /// beginning of its names, so that it is not found by accident.
    pub fn of(action: &Action, typed: &str) -> Option<Self> {
        let found = Self::of_words(action, typed)?;
        (action.risk == Risk::Safe || found <= Self::Synonym).then_some(found)
    }

    fn of_words(action: &Action, typed: &str) -> Option<Self> {
        let word = squashed(typed);
        let name = squashed(action.name);
        let synonyms = || action.synonyms.iter().map(|synonym| squashed(synonym));
        if name == word || synonyms().any(|synonym| synonym == word) {
            Some(Self::Exact)
        } else if name.starts_with(&word) {
            Some(Self::Name)
        } else if synonyms().any(|synonym| synonym.starts_with(&word)) {
            Some(Self::Synonym)
        } else if initials(action.name).starts_with(&word) {
            Some(Self::Initials)
        } else if name.contains(&word) {
            Some(Self::Within)
        } else {
            is_described(action, typed).then_some(Self::Description)
        }
    }
}

fn is_described(action: &Action, typed: &str) -> bool {
    let about = action.about.to_lowercase();
    let words: Vec<&str> = about.split(|letter: char| !letter.is_alphanumeric()).collect();
    let typed = typed.to_lowercase();
    typed.split_whitespace().all(|part| words.iter().any(|word| word.starts_with(part)))
}

/// Converts to lower case and removes hyphens and spaces, so that `zoom in` matches `zoom-in`.
fn squashed(words: &str) -> String {
    words.to_lowercase().chars().filter(|letter| *letter != '-' && !letter.is_whitespace()).collect()
}

fn initials(name: &str) -> String {
    name.split('-').filter_map(|word| word.chars().next()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(name: &str, typed: &str) -> Option<Match> {
        Match::of(named(name).expect("a command"), typed)
    }

    #[test]
    fn each_way_to_match_in_its_order() {
        let cases = [
            ("zoom-in", "zoom in", Some(Match::Exact)),
            ("hold", "pause", Some(Match::Exact)),
            ("zoom-in", "zoo", Some(Match::Name)),
            ("hold", "pau", Some(Match::Synonym)),
            ("zoom-in", "zi", Some(Match::Initials)),
            ("whole-tank", "tank", Some(Match::Within)),
            ("whole-tank", "show tank", Some(Match::Description)),
            ("zoom-in", "zn", None),
            ("zoom-in", "xyzzy", None),
            // An action that moves the robot or ends the mission is not found by its description or by the middle of
            // its name.
            ("start", "mission", None),
            ("run-uncertified", "plan", None),
            ("run-uncertified", "certified", None),
            ("end", "mission", None),
            ("end", "abo", Some(Match::Synonym)),
        ];
        for (name, typed, expected) in cases {
            assert_eq!(found(name, typed), expected, "{name} for {typed}");
        }
    }

    #[test]
    fn synonyms_name_one_command_each() {
        let table = [
            ("hold", ["stop", "pause", "halt"].as_slice()),
            ("resume", &["continue"]),
            ("return", &["drive-back"]),
            ("leave", &["quit", "exit"]),
            ("end", &["abort", "finish"]),
            ("run-uncertified", &["fly-uncertified"]),
            ("speed", &["rate", "pace"]),
            ("acknowledge", &["silence"]),
        ];
        for (name, synonyms) in table {
            for synonym in synonyms {
                assert_eq!(named(synonym).map(|action| action.name), Some(name), "{synonym}");
            }
        }
        let mut all: Vec<&str> = commands().flat_map(|action| action.synonyms).copied().collect();
        let listed: usize = table.iter().map(|(_, synonyms)| synonyms.len()).sum();
        assert_eq!(all.len(), listed, "every synonym is in this table");
        all.extend(commands().map(|action| action.name));
        let count = all.len();
        all.sort_unstable();
        all.dedup();
        assert_eq!(all.len(), count, "no word names two commands");
    }
}
