//! Splits filters into words.

use std::ops::Range;

/// A word of a filter: text between separators, or in quotes.
pub(super) struct Word {
    /// The range of bytes in the text of the filter.
    pub at: Range<usize>,
    /// The word without its quotes.
    pub text: String,
    /// The position in `text` where the first quote opened, bytes.
    pub quoted_from: Option<usize>,
}

/// The words of a filter.
pub(super) fn words(text: &str) -> impl Iterator<Item = Word> {
    let mut letters = text.char_indices().peekable();
    std::iter::from_fn(move || {
        while letters.next_if(|(_, letter)| letter.is_whitespace()).is_some() {}
        let (start, _) = letters.peek().copied()?;
        let mut word = Word { at: start..text.len(), text: String::new(), quoted_from: None };
        let mut is_quoted = false;
        for (at, letter) in letters.by_ref() {
            match letter {
                '"' => {
                    is_quoted = !is_quoted;
                    word.quoted_from.get_or_insert(word.text.len());
                }
                letter if letter.is_whitespace() && !is_quoted => {
                    word.at.end = at;
                    break;
                }
                letter => word.text.push(letter),
            }
        }
        Some(word)
    })
}
