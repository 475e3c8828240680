//! Placeholder words that people write when they have no fact to state.

/// Placeholders for facts that are not known yet.
const PLACEHOLDERS: [&str; 6] = ["fixme", "lorem ipsum", "tba", "tbc", "tbd", "todo"];

/// Beginnings of texts that announce a fact instead of stating it.
const ANNOUNCED: [&str; 15] = [
    "to be added",
    "to be advised",
    "to be announced",
    "to be completed",
    "to be confirmed",
    "to be decided",
    "to be defined",
    "to be determined",
    "to be done",
    "to be filled",
    "to be provided",
    "to be supplied",
    "not yet",
    "still open",
    "will follow",
];

/// Words without content: a text that consists only of these states no fact.
const EMPTY: [&str; 58] = [
    "any",
    "applicable",
    "available",
    "been",
    "blank",
    "clear",
    "data",
    "done",
    "empty",
    "entered",
    "filled",
    "follow",
    "follows",
    "given",
    "has",
    "in",
    "info",
    "information",
    "is",
    "known",
    "later",
    "missing",
    "na",
    "nan",
    "nil",
    "no",
    "nobody",
    "none",
    "not",
    "nothing",
    "null",
    "open",
    "pending",
    "please",
    "provided",
    "recorded",
    "required",
    "so",
    "specified",
    "stated",
    "still",
    "tba",
    "tbc",
    "tbd",
    "text",
    "the",
    "this",
    "to",
    "todo",
    "unclear",
    "undefined",
    "unknown",
    "unspecified",
    "value",
    "was",
    "will",
    "yes",
    "yet",
];

/// Whether a text is a placeholder for a text that is still to be written: `TBD`, `todo: ask`, `xxx`, `...`, `?`.
///
/// ```
/// use account::is_placeholder;
/// assert!(["TBD", "xxx", "-", "?"].into_iter().all(is_placeholder) && !is_placeholder("Tbcom Ltd"));
/// ```
pub fn is_placeholder(text: &str) -> bool {
    let text = text.to_lowercase();
    let is_marked = PLACEHOLDERS.iter().any(|word| {
        text.trim_start().strip_prefix(word).is_some_and(|rest| !rest.starts_with(char::is_alphanumeric))
    });
    let letters = || text.chars().filter(|letter| letter.is_alphanumeric());
    is_marked || letters().all(|letter| letter == 'x')
}

/// Whether a text states no fact: a placeholder, `n.a.`, `none`, `to be done`, `not yet known`. A sentence that names
/// its subject does state a fact: `No remarks`, `None above 20 % of the thickness`.
///
/// ```
/// use account::says_nothing;
/// assert!(["n.a.", "none", "To be done", "unknown", "?"].into_iter().all(says_nothing));
/// assert!(!["No remarks", "None found", "7"].into_iter().any(says_nothing));
/// ```
pub fn says_nothing(text: &str) -> bool {
    let words = words(text);
    let joined = words.join(" ");
    let joined = joined.strip_prefix("still ").unwrap_or(&joined);
    let is_announced = ANNOUNCED
        .iter()
        .any(|begin| joined.strip_prefix(begin).is_some_and(|rest| rest.is_empty() || rest.starts_with(' ')));
    is_placeholder(text) || is_announced || words.iter().all(|word| EMPTY.contains(&&**word))
}

/// The words of a text in lower case; `n.a.`, `N/A` and `n a` are the same, and full-width letters equal normal ones.
fn words(text: &str) -> Vec<String> {
    let plain = |letter: char| match u32::from(letter) {
        wide @ 0xFF01..=0xFF5E => char::from_u32(wide - 0xFEE0).unwrap_or(letter),
        _ => letter,
    };
    let text: String = text.chars().map(plain).flat_map(char::to_lowercase).collect();
    let mut words: Vec<String> = Vec::new();
    for word in text.split(|letter: char| !letter.is_alphanumeric()).filter(|word| !word.is_empty()) {
        match words.last_mut() {
            Some(last) if last == "n" && matches!(word, "a" | "k") => "na".clone_into(last),
            _ => words.push(word.to_owned()),
        }
    }
    words
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn words_without_a_fact_say_nothing_however_they_are_written() {
        let empty = [
            "n.a.",
            "N/A",
            "n/a",
            "NA",
            "n. a.",
            "none",
            "None.",
            "NONE!",
            "nil",
            "-",
            "--",
            "?",
            "???",
            "...",
            "unknown",
            "(unknown)",
            "not known",
            "not yet known",
            "to be done",
            "To be done on Friday",
            "to be confirmed by the client",
            "TBD",
            "tbc",
            "todo: ask",
            "pending",
            "not applicable",
            "not available",
            "no",
            "nothing",
            "null",
            "yes",
            "ＮＡ",
            "later",
            "no information available",
            "is missing",
            "none given",
            "will follow",
            "not done",
            "xxx",
            "  ",
            "still to be done",
        ];
        for text in empty {
            assert!(says_nothing(text), "{text}");
        }
    }

    #[test]
    fn what_states_a_fact_does_not_say_nothing() {
        let facts = [
            "A",
            "7",
            "X-12",
            "T-07",
            "Todor Ivanov",
            "Nona Reyes",
            "No remarks",
            "None above 20 % of the thickness",
            "None found",
            "No drawing of the plates exists",
            "Rim inspected by hand",
            "2026-11-24 07:40, reference plate 12, within 0.3 mm",
            "Sludge below 5 mm",
            "Unknown column 7 m north of the manhole was left out",
            "Not scanned: sump grating in place",
            "N. A. Okafor",
            "Openshaw Terminals",
        ];
        for text in facts {
            assert!(!says_nothing(text), "{text}");
        }
    }

    proptest! {
        /// Case, marks and space around and between words change nothing.
        #[test]
        fn marks_do_not_make_a_fact(
            which in 0..EMPTY.len(), more in 0..EMPTY.len(), mark in "[ .,;:!?()/_-]{1,3}", upper in any::<bool>(),
        ) {
            let text = format!("{mark}{}{mark}{}{mark}", EMPTY[which], EMPTY[more]);
            let text = if upper { text.to_uppercase() } else { text };
            prop_assert!(says_nothing(&text), "{}", text);
            let with_fact = format!("{text} plate");
            let is_announced = ANNOUNCED.iter().any(|begin| words(&text).join(" ").starts_with(begin));
            prop_assert!(is_announced || is_placeholder(&text) || !says_nothing(&with_fact), "{}", with_fact);
        }
    }
}
