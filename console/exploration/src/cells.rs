//! The states of cells, and their text: runs, each as its length and a letter.

use serde::{Deserialize, Serialize};
use std::ops::Range;

/// The letter of cells whose state has not changed.
const SAME: char = '=';

/// The state of a cell of the map.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum CellState {
    /// Free floor.
    Free,
    /// Solid.
    Solid,
    /// Not seen.
    #[default]
    Unseen,
}

impl CellState {
    fn letter(self) -> char {
        match self {
            Self::Free => 'f',
            Self::Solid => 's',
            Self::Unseen => 'u',
        }
    }

    fn of(letter: char) -> Option<Self> {
        [Self::Free, Self::Solid, Self::Unseen].into_iter().find(|state| state.letter() == letter)
    }
}

/// The states of all cells as text.
pub(crate) fn text(states: &[CellState]) -> String {
    written(&states.iter().map(|state| state.letter()).collect::<Vec<_>>())
}

/// What has changed between two states of the same cells, as text: `f` now free, `s` now solid, `u` now not seen, `=` not
/// changed. Unchanged cells at the end are left out, so the text is empty if nothing has changed.
///
/// ```
/// use exploration::CellState::{Free, Unseen};
/// let text = exploration::changes(&[Unseen; 5], &[Unseen, Free, Free, Unseen, Unseen]);
/// assert_eq!(text, "1=2f");
/// assert_eq!(exploration::runs(&text, 5), Some(vec![(1..3, Free)]));
/// ```
pub fn changes(before: &[CellState], after: &[CellState]) -> String {
    let letter = |(before, after): (&CellState, &CellState)| {
        if before == after { SAME } else { after.letter() }
    };
    let letters: Vec<char> = before.iter().zip(after).map(letter).collect();
    let end = letters.iter().rposition(|letter| *letter != SAME).map_or(0, |last| last + 1);
    written(&letters[..end])
}

/// The cells and their states that a text of states or changes contains, for a map of `len` cells; cells that have not
/// changed are left out. `None` if the text is damaged.
pub fn runs(text: &str, len: usize) -> Option<Vec<(Range<usize>, CellState)>> {
    let (mut runs, mut at, mut length) = (Vec::new(), 0_usize, 0_usize);
    for letter in text.chars() {
        if let Some(digit) = letter.to_digit(10) {
            length = length.checked_mul(10)?.checked_add(digit as usize)?;
            continue;
        }
        if length == 0 || length > len - at {
            return None;
        }
        let cells = at..at + length;
        (at, length) = (cells.end, 0);
        if letter != SAME {
            runs.push((cells, CellState::of(letter)?));
        }
    }
    (length == 0).then_some(runs)
}

fn written(letters: &[char]) -> String {
    let runs = letters.chunk_by(|a, b| a == b);
    runs.flat_map(|run| [run.len().to_string(), run[0].to_string()]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn states() -> impl Strategy<Value = Vec<CellState>> {
        let state = prop_oneof![Just(CellState::Free), Just(CellState::Solid), Just(CellState::Unseen)];
        prop::collection::vec(state, 60)
    }

    proptest! {
        #[test]
        fn changes_make_the_later_states_of_the_earlier_ones(before in states(), after in states()) {
            let mut made = before.clone();
            for (cells, state) in runs(&changes(&before, &after), before.len()).unwrap() {
                made[cells].fill(state);
            }
            prop_assert_eq!(&made, &after);
            prop_assert_eq!(changes(&after, &after), "");
        }
    }

    #[test]
    fn damaged_changes_are_refused() {
        for text in ["3", "f", "0f", "4x", "3=3f", "99999999999999999999999f"] {
            assert_eq!(runs(text, 5), None, "{text}");
        }
    }
}
