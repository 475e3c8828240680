//! Splits a command line into words: `name {value | key=value}`, with values that contain spaces in double quotes.

use crate::model::palette::LineFault;
use std::ops::Range;

/// A word of a command line.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(in crate::update) struct Word {
    /// The word without quotes.
    pub text: String,
    /// The byte range in the line.
    pub at: Range<usize>,
}

/// Splits a line into words.
///
/// # Errors
/// Fails if a quote is not closed.
pub(in crate::update) fn words(line: &str) -> Result<Vec<Word>, LineFault> {
    let mut words: Vec<Word> = Vec::new();
    let (mut is_open, mut quote) = (false, None);
    for (at, letter) in line.char_indices() {
        match letter {
            '"' => quote = if quote.is_some() { None } else { Some(at) },
            _ if letter.is_whitespace() && quote.is_none() => {
                is_open = false;
                continue;
            }
            _ => {}
        }
        if !std::mem::replace(&mut is_open, true) {
            words.push(Word { text: String::new(), at: at..at });
        }
        if let Some(word) = words.last_mut() {
            word.at.end = at + letter.len_utf8();
            word.text.extend((letter != '"').then_some(letter));
        }
    }
    match quote {
        Some(at) => Err(LineFault { at: at..line.len(), what: "missing closing quote".into() }),
        None => Ok(words),
    }
}

/// The beginning of the last word of a text.
pub(in crate::update) fn word_begin(text: &str) -> usize {
    let mut begin = 0;
    let mut is_quoted = false;
    for (at, letter) in text.char_indices() {
        is_quoted ^= letter == '"';
        if letter.is_whitespace() && !is_quoted {
            begin = at + letter.len_utf8();
        }
    }
    begin
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_separated_by_spaces_outside_quotes() {
        type Expected<'a> = &'a [(&'a str, Range<usize>)];
        let cases: [(&str, Expected); 6] = [
            ("", &[]),
            ("speed 8", &[("speed", 0..5), ("8", 6..7)]),
            ("  set  k=2 ", &[("set", 2..5), ("k=2", 7..10)]),
            ("filter \"position lost\"", &[("filter", 0..6), ("position lost", 7..22)]),
            ("open planner=\"a b\"", &[("open", 0..4), ("planner=a b", 5..18)]),
            ("filter \"\"", &[("filter", 0..6), ("", 7..9)]),
        ];
        for (line, expected) in cases {
            let expected: Vec<Word> =
                expected.iter().map(|(text, at)| Word { text: (*text).into(), at: at.clone() }).collect();
            assert_eq!(words(line), Ok(expected), "{line}");
        }
    }

    #[test]
    fn a_quote_that_is_not_closed_is_pointed_at() {
        let fault = words("filter \"lost").expect_err("a fault");
        assert_eq!((fault.at, fault.what.as_str()), (7..12, "missing closing quote"));
    }

    #[test]
    fn the_word_at_the_end_begins_after_the_last_space_outside_quotes() {
        for (text, begin) in [("", 0), ("op", 0), ("open ", 5), ("open co", 5), ("filter \"a b", 7)] {
            assert_eq!(word_begin(text), begin, "{text}");
        }
    }
}
