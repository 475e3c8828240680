//! Looking actions up: by key, and by letters of a name.

use super::context::{Context, of_screen};
use super::{ACTIONS, Action};
use crate::keys::Key;
use crate::model::Model;

/// The action of a key in some contexts.
pub fn action_for(key: Key, contexts: &[Context]) -> Option<&'static Action> {
    ACTIONS.iter().find(|action| action.keys.contains(&key) && action.works_in(contexts))
}

/// The commands whose name or description contains the letters of `typed` in that order, best first.
pub fn matching(typed: &str) -> Vec<&'static Action> {
    let mut found: Vec<(usize, &Action)> = ACTIONS
        .iter()
        .filter(|action| action.is_command())
        .filter_map(|action| {
            let by_name = distance(typed, action.name);
            // A hit in the name beats any hit in the description.
            let by_about = distance(typed, action.about).map(|far| far + 1000);
            by_name.or(by_about).map(|far| (far, action))
        })
        .collect();
    found.sort_by_key(|(far, action)| (*far, action.name.len()));
    found.into_iter().map(|(_, action)| action).collect()
}

/// The command list for what was typed; with nothing typed, the keys of other screens and panes come last.
pub fn listed(model: &Model, typed: &str) -> Vec<&'static Action> {
    let mut found = matching(typed);
    if typed.is_empty() {
        let here = [&[Context::Anywhere, Context::Screen], of_screen(model)].concat();
        found.sort_by_key(|action| !action.works_in(&here));
    }
    found
}

/// How far the letters of `typed` are spread over `text`, and how far in they begin; `None` if they are not there.
fn distance(typed: &str, text: &str) -> Option<usize> {
    let text: Vec<char> = text.to_lowercase().chars().collect();
    let mut at = 0;
    let mut first = None;
    for letter in typed.to_lowercase().chars().filter(|c| !c.is_whitespace()) {
        at += text[at..].iter().position(|c| *c == letter)? + 1;
        first.get_or_insert(at);
    }
    let first = first.unwrap_or(0);
    Some(2 * (at - first) + first)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_command_is_found_first_by_its_name() {
        for action in ACTIONS.iter().filter(|action| action.is_command()) {
            assert_eq!(
                matching(action.name).first().map(|found| found.id),
                Some(action.id),
                "{}",
                action.name
            );
        }
    }

    #[test]
    fn a_command_is_found_by_letters_in_order() {
        assert_eq!(matching("zin").first().map(|a| a.name), Some("zoom-in"));
        assert!(matching("xyzzy").is_empty());
        assert_eq!(matching("").len(), ACTIONS.iter().filter(|a| a.is_command()).count());
    }
}
