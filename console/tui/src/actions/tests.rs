//! Properties of the table as a whole.

use super::context::together;
use super::*;
use crate::keys::Key;

#[test]
fn no_two_actions_share_a_key_where_both_work() {
    for contexts in together() {
        let here: Vec<&Action> = ACTIONS.iter().filter(|action| action.works_in(&contexts)).collect();
        for (index, one) in here.iter().enumerate() {
            for other in &here[index + 1..] {
                let shared = one.keys.iter().find(|key| other.keys.contains(key));
                assert_eq!(shared, None, "{} and {} in {contexts:?}", one.name, other.name);
            }
        }
    }
}

#[test]
fn nothing_that_moves_the_robot_lies_on_a_small_letter_or_on_space() {
    for action in ACTIONS.iter().filter(|action| action.risk != Risk::Safe) {
        for key in action.keys {
            let small = matches!(key, Key::Char(c) if c.is_lowercase() || *c == ' ');
            assert!(!small, "{} on {key}", action.name);
        }
        assert!(!action.repeats, "{} follows a repeating key", action.name);
    }
}

#[test]
fn names_are_plain_and_every_action_says_what_it_does() {
    for action in ACTIONS.iter() {
        assert!(action.name.chars().all(|c| c.is_ascii_lowercase() || c == '-'), "{}", action.name);
        assert!(!action.about.is_empty() && action.about.len() <= 40, "{}", action.name);
    }
}
