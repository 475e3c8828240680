//! A run in a few lines, for the shell after the console has closed.

use super::{coverage, mission_time, outcome, path, title, warnings};
use account::Summary;

/// The most lines that are printed.
const MOST_LINES: usize = 12;
/// The width of the labels.
const LABEL: usize = 14;
/// The narrowest terminal for which lines are wrapped.
const NARROWEST: usize = 40;

/// A run in at most twelve lines of at most `columns` characters: how it ended, and where it is kept (`kept`, a
/// sentence). `name` is the name of the run's folder, if the full report can be printed from there. Lines are wrapped
/// between words; lines that do not fit are left out, least important first.
pub fn short(run: &Summary, kept: Option<&str>, name: Option<&str>, columns: usize) -> String {
    let columns = columns.max(NARROWEST);
    let wrapped = |label: &str, what: &str| wrap(label, what, columns);
    let begin = wrapped("", &title(run));
    let mut end = kept.map(|kept| wrapped("", kept)).unwrap_or_default();
    if let Some(name) = name {
        end.extend(wrapped("", &format!("Full report: tankops report {name}")));
    }
    let mut middle = vec![wrapped("outcome", &outcome(run))];
    middle.extend(warnings(run).iter().map(|warning| wrapped("WARNING", warning)));
    middle.extend(run.coverage.iter().flat_map(coverage).take(1).map(|line| wrapped("coverage", &line)));
    middle.extend(mission_time(run).map(|line| wrapped("mission time", &line)));
    middle.extend(path(run).map(|line| wrapped("path", &line)));
    let mut lines = begin;
    for part in middle {
        if lines.len() + part.len() + end.len() <= MOST_LINES {
            lines.extend(part);
        }
    }
    lines.extend(end);
    lines.join("\n") + "\n"
}

/// Wraps a text between words; further lines are indented like the first.
fn wrap(label: &str, what: &str, columns: usize) -> Vec<String> {
    let indent = if label.is_empty() { 0 } else { LABEL };
    let mut lines = vec![format!("{label:<indent$}")];
    for word in what.split(' ') {
        let line = lines.last_mut().expect("at least one line exists");
        let length = line.chars().count();
        if length > indent && length + 1 + word.chars().count() > columns {
            lines.push(format!("{:indent$}{word}", ""));
        } else {
            if length > indent {
                line.push(' ');
            }
            line.push_str(word);
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples;

    #[test]
    fn a_run_takes_at_most_twelve_lines_and_no_word_is_broken() {
        let run = samples::full_run();
        let kept = "run kept in logs/20261128T101112Z-cover-circle-tether-safe-1";
        for columns in [20, 40, 60, 80, 120, 200] {
            let text = short(&run, Some(kept), Some("20261128T101112Z"), columns);
            let lines: Vec<&str> = text.lines().collect();
            assert!(lines.len() <= MOST_LINES, "{columns}: {text}");
            assert!(text.replace('\n', " ").contains(kept), "{columns}: {text}");
            let whole = crate::human(&run);
            let words = |text: &str| text.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
            let known =
                [words(&whole), words(kept), words("Full report: tankops report 20261128T101112Z")].concat();
            assert!(words(&text).iter().all(|word| known.contains(word)), "{columns}: {text}");
            let too_long =
                |line: &&str| line.chars().count() > columns.max(NARROWEST) && line.trim().contains(' ');
            assert!(!lines.iter().any(too_long), "{columns}: {text}");
        }
    }

    #[test]
    fn what_matters_most_is_kept_on_a_narrow_terminal() {
        let run = samples::full_run();
        let text = short(&run, Some("run kept in logs/run"), Some("run"), 40);
        assert!(text.contains("outcome") && text.contains("run kept in"), "{text}");
    }
}
