//! Places of problems in a scenario that options have changed, as places in the file of the user.

use super::ScenarioErrors;

/// Moves problems in a changed text to the lines of the text as the user wrote it. A problem in a line that an option added
/// has no place there; the name of the scenario states the option.
pub(super) fn as_written(original: &str, errors: ScenarioErrors) -> ScenarioErrors {
    let changed: Vec<&str> = errors.text.split_inclusive('\n').collect();
    let mut lines: Vec<&str> = original.split_inclusive('\n').collect();
    let origins = origins(&lines, &changed);
    for (line, origin) in changed.iter().zip(&origins) {
        if let Some(origin) = *origin {
            lines[origin] = *line;
        }
    }
    let begins = |lines: &[&str]| -> Vec<usize> {
        let begin = |end: &mut usize, line: &&str| {
            let begin = *end;
            *end += line.len();
            Some(begin)
        };
        lines.iter().scan(0, begin).collect()
    };
    let (here, there) = (begins(&changed), begins(&lines));
    let moved = |at: std::ops::Range<usize>| {
        let line = here.partition_point(|begin| *begin <= at.start).checked_sub(1)?;
        let begin = there[origins[line]?] + (at.start - here[line]);
        Some(begin..begin + at.len())
    };
    let text = lines.concat();
    let problems = errors.problems.into_iter().map(|mut problem| {
        problem.at = problem.at.and_then(&moved);
        problem
    });
    ScenarioErrors { problems: problems.collect(), text, shown_name: errors.shown_name }
}

/// For each line of a changed text, the index of the line from which it comes; `None` for a line that was added. Options
/// add, replace and remove lines, but do not move them.
fn origins(original: &[&str], changed: &[&str]) -> Vec<Option<usize>> {
    let mut at = 0;
    let origin = |(index, line): (usize, &&str)| {
        let (left, left_there) = (changed.len() - index, original.len() - at);
        let removed = original[at..].iter().take((left_there + 1).saturating_sub(left).max(1));
        if let Some(removed) = removed.clone().position(|other| other == line) {
            at += removed;
        } else {
            let is_replaced = changed.get(index + 1) == original.get(at + 1);
            if left_there == 0 || left > left_there && !is_replaced {
                return None;
            }
        }
        at += 1;
        Some(at - 1)
    };
    changed.iter().enumerate().map(origin).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_that_were_added_have_no_origin_and_the_others_keep_theirs() {
        let original = ["a\n", "b\n", "c\n"];
        let of = |changed: &[&str]| origins(&original, changed);
        assert_eq!(of(&original), [Some(0), Some(1), Some(2)]);
        assert_eq!(of(&["a\n", "new\n", "b\n", "c\n"]), [Some(0), None, Some(1), Some(2)]);
        assert_eq!(of(&["a\n", "b\n", "c\n", "new\n", "too\n"]), [Some(0), Some(1), Some(2), None, None]);
        assert_eq!(of(&["a\n", "B\n", "c\n"]), [Some(0), Some(1), Some(2)]);
        assert_eq!(of(&["A\n", "b\n", "new\n", "c\n"]), [Some(0), Some(1), None, Some(2)]);
        assert_eq!(of(&["a\n", "c\n"]), [Some(0), Some(2)]);
    }
}
