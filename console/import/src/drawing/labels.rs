//! Texts in a drawing, which may be names of plates.

use super::groups::{Entity, unescaped};

/// The largest number of characters of a name; longer names are cut off.
const LONGEST: usize = 40;

/// Words in the tags of those attributes that contain a name or a number.
const NAME_TAGS: [&str; 12] =
    ["NO", "NR", "NUM", "NUMBER", "NUMMER", "NAME", "ID", "TAG", "MARK", "POS", "PLATE", "BLECH"];

/// The text of an entity on one line without formatting; `None` if it has no text.
pub(super) fn text(entity: &Entity) -> Option<String> {
    let plain = match entity.kind.as_str() {
        "TEXT" | "ATTRIB" => signs(entity.text(1)?),
        // Long texts are split into several groups.
        "MTEXT" => {
            let pieces = entity.groups().iter().filter(|(code, _)| *code == 3 || *code == 1);
            unformatted(&signs(&pieces.map(|(_, piece)| piece.as_str()).collect::<String>()))
        }
        _ => return None,
    };
    let plain = foreign::seen(&plain);
    let words: Vec<&str> = plain.split_whitespace().collect();
    let name: String = words.join(" ").chars().take(LONGEST).collect();
    (!name.is_empty()).then_some(name)
}

/// Whether the tag of an attribute indicates a name or a number.
pub(super) fn is_name_tag(attribute: &Entity) -> bool {
    let tag = attribute.text(2).unwrap_or_default().to_uppercase();
    let mut words = tag.split(|letter: char| !letter.is_alphabetic());
    words.any(|word| NAME_TAGS.contains(&word))
}

/// Decodes letters and signs written as `\U+00FC` and `%%c`; underlining is dropped.
fn signs(text: &str) -> String {
    let mut text = unescaped(text);
    let all = [("%%c", "Ø"), ("%%d", "°"), ("%%p", "±"), ("%%u", ""), ("%%o", ""), ("%%k", ""), ("%%%", "%")];
    for (code, sign) in all {
        text = text.replace(code, sign).replace(&code.to_uppercase(), sign);
    }
    text
}

/// Removes the formatting codes of a text: `{\fArial|b1;P-\H2x;07}` becomes `P-07`.
fn unformatted(text: &str) -> String {
    let mut plain = String::new();
    let mut letters = text.chars();
    while let Some(letter) = letters.next() {
        match letter {
            '{' | '}' => {}
            '\\' => match letters.next() {
                Some(sign @ ('\\' | '{' | '}')) => plain.push(sign),
                Some('P' | 'N' | 'X' | '~') => plain.push(' '),
                Some('A' | 'C' | 'c' | 'F' | 'f' | 'H' | 'p' | 'Q' | 'T' | 'W') => {
                    letters.by_ref().take_while(|letter| *letter != ';').for_each(drop);
                }
                Some('S') => {
                    let stacked = letters.by_ref().take_while(|letter| *letter != ';');
                    plain
                        .extend(stacked.map(|letter| if matches!(letter, '^' | '#') { '/' } else { letter }));
                }
                _ => {}
            },
            _ => plain.push(letter),
        }
    }
    plain
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formatting_is_no_part_of_a_name() {
        assert_eq!(unformatted(r"{\fArial|b1|i0;P-\H2x;07}\PS235"), "P-07 S235");
        assert_eq!(unformatted(r"\A1;\LA\l \S1^2; \{B\} \\"), r"A 1/2 {B} \");
        assert_eq!(signs("%%uPL%%u 7 %%C 3 \\U+00FC"), "PL 7 Ø 3 ü");
    }
}
