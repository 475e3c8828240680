//! Decides when the state of the vehicle is sent: after each change, and at least twice a second.

use crate::message::State;

/// Longest time between two messages, seconds. The protocol asks for one a second.
const PERIOD_S: f64 = 0.5;
/// Maximum length of a text, characters.
const TEXT_MAX: usize = 200;

/// Decides when to send the state, and remembers the state that was sent last.
#[derive(Debug, Clone, Default)]
pub struct Status {
    said: Option<State>,
}

impl Status {
    /// The state to send now; `None` if no message is due.
    pub fn say(&mut self, mut state: State) -> Option<State> {
        state.text = state.text.map(|text| readable(&text));
        let is_due = self.said.as_ref().is_none_or(|said| {
            state.stamp_s - said.stamp_s >= PERIOD_S
                || (said.mode, &said.text, said.commander) != (state.mode, &state.text, state.commander)
        });
        is_due.then(|| {
            self.said = Some(state.clone());
            state
        })
    }
}

/// The text without control characters, shortened.
fn readable(text: &str) -> String {
    text.chars().filter(|c| !c.is_control()).take(TEXT_MAX).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::message::{Commander, Mode};

    fn state(stamp_s: f64, mode: Mode) -> State {
        State { stamp_s, mode, text: None, battery: None, commander: Commander::You }
    }

    #[test]
    fn a_state_is_said_at_a_change_and_twice_a_second() {
        let mut status = Status::default();
        assert!(status.say(state(0.0, Mode::Ready)).is_some());
        assert!(status.say(state(0.4, Mode::Ready)).is_none());
        assert!(status.say(state(0.45, Mode::Manual)).is_some());
        assert!(status.say(state(0.9, Mode::Manual)).is_none());
        assert!(status.say(state(0.96, Mode::Manual)).is_some());
    }

    #[test]
    fn a_text_is_made_readable() {
        let long = State { text: Some("\u{7}ab\n".repeat(200)), ..state(0.0, Mode::Fault) };
        let said = Status::default().say(long).unwrap().text.unwrap();
        assert!(said.chars().count() == 200 && said.starts_with("abab"));
    }
}
