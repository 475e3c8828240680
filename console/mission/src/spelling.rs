//! Finds the name that was probably meant, for the hint in a message about an unknown name.

/// The known name nearest to a misspelt one; `None` if more than a third of its letters, or more than four, are wrong.
///
/// The cost, for each known name, is the product of the lengths of the two names.
pub fn nearest<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let reach = (word.chars().count() / 3).clamp(1, 4);
    known
        .into_iter()
        .map(|candidate| (strsim::damerau_levenshtein(word, candidate), candidate))
        .filter(|(distance, _)| *distance <= reach)
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, candidate)| candidate)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slip_of_a_few_letters_is_understood_and_another_word_is_not() {
        let known = ["follow", "zoom-in", "zoom-out"];
        assert_eq!(nearest("folow", known), Some("follow"));
        assert_eq!(nearest("zoom-uot", known), Some("zoom-out"));
        assert_eq!(nearest("theme", known), None);
    }
}
