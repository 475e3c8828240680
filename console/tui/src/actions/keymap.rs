//! The key assignments: from the table, from a preset and from the operator.

mod presets;

pub use presets::PRESETS;

use super::{ACTIONS, Action, ActionId, Risk, context::together};
use crate::keys::Key;
use mission::spelling::nearest;
use presets::Changes;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Key assignments, and aliases for command lines.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Keymap {
    /// Keys by action, for actions whose keys differ from those in the table.
    changed: BTreeMap<String, Vec<Key>>,
    /// Command lines by alias.
    pub aliases: BTreeMap<String, String>,
    /// Whether sentences name commands instead of keys, because no keyboard is used.
    #[serde(default)]
    pub spells_commands: bool,
    /// Whether the arrow keys are named by words, because the terminal has no arrows.
    #[serde(default)]
    pub spells_arrows: bool,
}

/// An action with the keys that the operator assigns to it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Binding {
    /// The name of the action.
    pub action: String,
    /// The action's keys; an empty list unbinds the action.
    pub keys: Vec<Key>,
}

/// Why a binding is rejected, or a warning about it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Objection {
    /// The index of the binding in the list.
    pub binding: usize,
    /// The index of the key in the binding; `None` for the binding as a whole.
    pub key: Option<usize>,
    /// What is wrong, as a clause.
    pub what: String,
    /// The index of the earlier binding that uses the same key.
    pub other: Option<usize>,
    /// The consequence, as a clause.
    pub instead: String,
}

impl Keymap {
    /// The keys of an action.
    pub fn of<'a>(&'a self, action: &'a Action) -> &'a [Key] {
        self.changed.get(action.name).map_or(action.keys, Vec::as_slice)
    }

    /// The keys that open an input line on a screen without an overlay.
    pub fn line_openers(&self) -> Vec<Key> {
        let opens =
            |action: &&Action| matches!(action.id, ActionId::Commands | ActionId::Help | ActionId::Filter);
        ACTIONS.iter().filter(opens).flat_map(|action| self.of(action)).copied().collect()
    }

    /// The keys of an action as text.
    pub fn text(&self, action: &Action) -> String {
        self.texts(action).join(" ")
    }

    /// The text of each key of an action.
    pub fn texts(&self, action: &Action) -> Vec<String> {
        self.of(action).iter().map(|key| self.key_text(*key)).collect()
    }

    /// A key as text.
    pub fn key_text(&self, key: Key) -> String {
        let is_arrow =
            matches!(key, Key::Up | Key::Down | Key::Left | Key::Right | Key::CtrlLeft | Key::CtrlRight);
        if self.spells_arrows && is_arrow { key.name() } else { key.to_string() }
    }

    /// Replaces each `<end>`-style placeholder in a sentence with the key of the named action; for an action without
    /// a key, with its command. Without a keyboard, commands replace all of them. `<press>` is the verb before it.
    pub fn spelled(&self, sentence: &str) -> String {
        let mut parts = sentence.split('<');
        let mut text = parts.next().unwrap_or_default().to_owned();
        for part in parts {
            let named = part.split_once('>').and_then(|(name, after)| Some((self.spelling(name)?, after)));
            let (key, after) = named.unwrap_or_else(|| ("<".into(), part));
            text += &key;
            text += after;
        }
        text
    }

    /// How to run an action from the keyboard: its first key, or its command if it has no key.
    fn spelling(&self, name: &str) -> Option<String> {
        if name == "press" {
            return Some(if self.spells_commands { "Enter" } else { "Press" }.into());
        }
        let action = ACTIONS.iter().find(|action| action.name == name)?;
        if self.spells_commands {
            return Some(self.command(action));
        }
        Some(match self.key_of(action) {
            Some(key) => self.key_text(key),
            None if action.is_command() => format!(":{name}"),
            None => "(no key)".into(),
        })
    }

    /// The key with which a sentence names an action; `None` if the action has only a command.
    pub fn key_of(&self, action: &Action) -> Option<Key> {
        // One key holds, resumes and plays; another opens what is selected.
        let also = match action.id {
            ActionId::Resume | ActionId::Play => Some(ActionId::Hold),
            ActionId::Open => Some(ActionId::Accept),
            _ => None,
        };
        let also = also.and_then(|id| ACTIONS.iter().find(|action| action.id == id));
        self.of(action).first().or_else(|| self.of(also?).first()).copied()
    }

    /// How to run an action without a keyboard.
    fn command(&self, action: &Action) -> String {
        match action.id {
            ActionId::Accept => "`yes`".into(),
            ActionId::Cancel => "`no`".into(),
            _ if action.is_command() => format!("`{}`", action.name),
            _ => self
                .of(action)
                .first()
                .map_or_else(|| "(no key)".into(), |key| format!("`key {}`", key.name())),
        }
    }

    /// Combines a preset with the operator's own keys. An invalid binding is left out, and its action keeps the
    /// preset's keys.
    pub fn new(preset: Changes, bindings: &[Binding]) -> (Self, Vec<Objection>) {
        let base = Self::of_bindings(preset, &[]);
        let mut objections: Vec<Objection> = Vec::new();
        loop {
            let is_out = |index| objections.iter().any(|objection: &Objection| objection.binding == index);
            let taken: Vec<(usize, &Binding)> =
                bindings.iter().enumerate().filter(|(index, _)| !is_out(*index)).collect();
            let map = Self::of_bindings(preset, &taken);
            // Remove one binding at a time: the keys that its action keeps may conflict with another binding.
            match taken.iter().find_map(|(index, binding)| map.objection(&base, *index, binding, &taken)) {
                Some(objection) => objections.push(objection),
                None => return (map, objections),
            }
        }
    }

    fn of_bindings(preset: Changes, taken: &[(usize, &Binding)]) -> Self {
        let preset = preset.iter().map(|(name, keys)| ((*name).to_owned(), keys.to_vec()));
        let own = taken.iter().map(|(_, binding)| (binding.action.clone(), with_fixed(binding)));
        Self { changed: preset.chain(own).collect(), ..Self::default() }
    }

    fn objection(
        &self,
        base: &Self,
        index: usize,
        binding: &Binding,
        taken: &[(usize, &Binding)],
    ) -> Option<Objection> {
        let objection = |key, what, other| Objection {
            binding: index,
            key,
            what,
            other,
            instead: format!("{} keeps {}", binding.action, base.kept(&binding.action)),
        };
        let Some(action) = ACTIONS.iter().find(|action| action.name == binding.action) else {
            let known = ACTIONS.iter().map(|action| action.name);
            let remedy = nearest(&binding.action, known).map(|name| format!("did you mean {name}?"));
            let instead = remedy.unwrap_or_else(|| "see keys.md".into());
            return Some(Objection {
                instead,
                ..objection(None, format!("unknown action {:?}", binding.action), None)
            });
        };
        binding.keys.iter().enumerate().find_map(|(at, key)| {
            if action.risk != Risk::Safe && !is_deliberate(*key) {
                let what = format!(
                    "{:?} is too easy to press by accident for an action that {}",
                    key.name(),
                    deed(action.risk)
                );
                return Some(objection(Some(at), what, None));
            }
            let (other, screens) = self.holder(action, *key)?;
            let by = taken.iter().find(|(_, other_binding)| other_binding.action == other.name);
            let by = by.map(|(place, _)| *place);
            // If two bindings conflict, the later one is dropped.
            if by.is_some_and(|by| by > index) {
                return None;
            }
            let what = format!("{:?} is already {}{}", key.name(), other.name, in_brackets(&screens));
            Some(objection(Some(at), what, by))
        })
    }

    /// The keys of an action, in quotes.
    fn kept(&self, name: &str) -> String {
        let action = ACTIONS.iter().find(|action| action.name == name);
        let keys = action.map(|action| self.of(action)).unwrap_or_default();
        let names: Vec<String> = keys.iter().map(|key| format!("{:?}", key.name())).collect();
        if names.is_empty() { "no key".into() } else { names.join(", ") }
    }

    /// Another action that uses the key in one of this action's contexts, and the screens where the two conflict.
    fn holder(&self, action: &Action, key: Key) -> Option<(&'static Action, Vec<&'static str>)> {
        let rows = || ACTIONS.iter().filter(|row| row.id == action.id);
        let mut found: Option<(&Action, Vec<&str>)> = None;
        for contexts in together().filter(|contexts| rows().any(|row| row.works_in(contexts))) {
            let other = ACTIONS.iter().find(|other| {
                other.id != action.id && other.works_in(&contexts) && self.of(other).contains(&key)
            });
            let Some(other) = other else { continue };
            let (_, screens) = found.get_or_insert((other, Vec::new()));
            for screen in contexts.iter().filter_map(|context| context.screen()) {
                if !screens.contains(&screen) {
                    screens.push(screen);
                }
            }
        }
        found
    }
}

fn in_brackets(screens: &[&str]) -> String {
    // If the keys conflict on most screens, a list of these screens does not help the reader.
    if screens.is_empty() || screens.len() > 4 { String::new() } else { format!(" ({})", screens.join(", ")) }
}

fn deed(risk: Risk) -> &'static str {
    match risk {
        Risk::Safe => "is harmless",
        Risk::Changes => "changes how the robot moves; use a capital letter, F key or Ctrl",
        Risk::Moves => "moves the robot; use a capital letter, F key or Ctrl",
        Risk::Destroys => "ends the mission; use a capital letter, F key or Ctrl",
    }
}

/// Whether a key is unlikely to be pressed by mistake.
fn is_deliberate(key: Key) -> bool {
    match key {
        Key::Char(letter) => !letter.is_lowercase() && letter != ' ',
        Key::Ctrl(_) | Key::F(_) => true,
        _ => false,
    }
}

/// The keys of a binding, preceded by the action's permanent keys, which no binding can remove.
fn with_fixed(binding: &Binding) -> Vec<Key> {
    let is_fixed = |action: &&Action| {
        use ActionId::{Accept, Cancel, Commands, Hold, Interrupt};
        matches!(action.id, Accept | Cancel | Commands | Hold | Interrupt) && action.name == binding.action
    };
    let fixed = ACTIONS.iter().find(is_fixed).and_then(|action| action.keys.first());
    let own = binding.keys.iter().filter(|key| Some(*key) != fixed);
    fixed.into_iter().chain(own).copied().collect()
}

/// The terminal multiplexer that intercepts a key, so that it may never reach the console.
pub fn taken_by(key: Key) -> Option<&'static str> {
    match key {
        Key::Ctrl('a') => Some("screen"),
        Key::Ctrl('b') => Some("tmux"),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    type Pairs<'a> = &'a [(&'a str, &'a [Key])];

    fn bound(pairs: Pairs) -> (Keymap, Vec<String>) {
        let bindings: Vec<Binding> = pairs
            .iter()
            .map(|(action, keys)| Binding { action: (*action).to_owned(), keys: keys.to_vec() })
            .collect();
        let (map, objections) = Keymap::new(&[], &bindings);
        let said = objections.iter().map(|o| format!("{}: {}; {}", o.binding, o.what, o.instead));
        (map, said.collect())
    }

    fn keys(map: &Keymap, name: &str) -> Vec<Key> {
        map.of(ACTIONS.iter().find(|action| action.name == name).expect("an action")).to_vec()
    }

    #[test]
    fn no_preset_gives_a_key_to_two_actions() {
        for (name, changes) in PRESETS {
            let as_bindings: Vec<Binding> = changes
                .iter()
                .map(|(action, keys)| Binding { action: (*action).to_owned(), keys: keys.to_vec() })
                .collect();
            assert_eq!(Keymap::new(&[], &as_bindings).1, [], "{name}");
        }
    }

    #[test]
    fn what_cannot_be_bound_says_why_and_changes_nothing() {
        let f = Key::Char('f');
        let cases: [(Pairs, &str); 6] = [
            (
                &[("zoom-in", &[f])],
                "0: \"f\" is already follow (Plan, Mission, Replay, Result); zoom-in keeps \"z\"",
            ),
            (
                &[("zoom-in", &[Key::F(5)]), ("zoom-out", &[Key::F(5)])],
                "1: \"F5\" is already zoom-in (Plan, Mission, Replay, Result); zoom-out keeps \"Z\"",
            ),
            (&[("zoomin", &[f])], "0: unknown action \"zoomin\"; did you mean zoom-in?"),
            (
                &[("start", &[Key::Char('y')])],
                "0: \"y\" is too easy to press by accident for an action that moves the robot; use a capital letter, F key or Ctrl; \
                 start keeps \"S\"",
            ),
            (
                &[("end", &[Key::Char(' ')])],
                "0: \"space\" is too easy to press by accident for an action that ends the mission; use a capital letter, F key or \
                 Ctrl; end keeps \"X\"",
            ),
            (&[("redraw", &[Key::Ctrl('c')])], "0: \"Ctrl-C\" is already interrupt; redraw keeps \"Ctrl-L\""),
        ];
        for (pairs, said) in cases {
            assert_eq!(bound(pairs).1, [said]);
        }
    }

    #[test]
    fn sentences_name_the_keys_that_work() {
        let (map, _) = bound(&[("end", &[Key::F(9)]), ("zoom-in", &[])]);
        let sentence = "<planner>: change planner, <end>: end mission, <zoom-in>: zoom in, 3 < 4";
        assert_eq!(map.spelled(sentence), "P: change planner, F9: end mission, :zoom-in: zoom in, 3 < 4");
    }

    #[test]
    fn without_a_keyboard_sentences_name_commands() {
        let keys = Keymap { spells_commands: true, ..Keymap::default() };
        let sentence = "<press> <start>. <resume>: resume, <accept>: end, <cancel>: cancel. <help>";
        assert_eq!(
            keys.spelled(sentence),
            "Enter `start`. `resume`: resume, `yes`: end, `no`: cancel. `help`"
        );
        let keys = Keymap::default();
        assert_eq!(
            keys.spelled("<press> <start>. <resume>: resume. <play>: play."),
            "Press S. space: resume. space: play."
        );
    }

    #[test]
    fn keys_may_be_exchanged() {
        let (map, said) = bound(&[("zoom-in", &[Key::Char('f')]), ("follow", &[Key::Char('z')])]);
        assert_eq!(said, [""; 0]);
        assert_eq!(
            (keys(&map, "zoom-in"), keys(&map, "follow")),
            (vec![Key::Char('f')], vec![Key::Char('z')])
        );
    }

    #[test]
    fn an_action_that_keeps_its_key_keeps_it_from_others() {
        let (map, said) = bound(&[("zoom-in", &[Key::Char('f')]), ("follow", &[Key::Char('a')])]);
        assert_eq!(said.len(), 2, "{said:?}");
        assert_eq!(map, bound(&[]).0);
    }

    #[test]
    fn the_keys_to_stop_to_agree_and_to_cancel_stay() {
        let (map, said) =
            bound(&[("hold", &[Key::F(12)]), ("interrupt", &[]), ("accept", &[]), ("cancel", &[])]);
        assert_eq!(said, [""; 0]);
        assert_eq!(keys(&map, "hold"), [Key::Char(' '), Key::F(12)]);
        assert_eq!(keys(&map, "interrupt"), [Key::Ctrl('c')]);
        assert_eq!((keys(&map, "accept"), keys(&map, "cancel")), (vec![Key::Enter], vec![Key::Esc]));
    }
}
