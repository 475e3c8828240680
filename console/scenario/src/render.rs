//! Formats problems as text: file, line and column, the line itself with a marker under the position, and the remedy.

use super::problem::{Problem, ScenarioErrors};
use std::fmt::Write;

/// The number of problems shown in full; the rest are only counted.
const MOST_SHOWN: usize = 20;

/// The number of characters of a source line shown around the marker.
const WINDOW: usize = 100;

impl ScenarioErrors {
    /// All problems as text for people, one block each. The result contains no control characters from the file.
    pub fn render(&self) -> String {
        let mut text = String::new();
        for (i, problem) in self.problems.iter().take(MOST_SHOWN).enumerate() {
            if i > 0 {
                text.push('\n');
            }
            block(&mut text, &self.shown_name, &self.text, problem).expect("writing to a String cannot fail");
        }
        let rest = self.problems.len().saturating_sub(MOST_SHOWN);
        if rest > 0 {
            writeln!(text, "error: {}: further problems: {rest}", self.shown_name)
                .expect("writing to a String cannot fail");
        }
        text
    }
}

/// A position in a text.
struct Spot<'a> {
    line: usize,
    column: usize,
    /// The whole line.
    source: &'a str,
}

impl<'a> Spot<'a> {
    fn of(text: &'a str, at: usize) -> Self {
        let mut at = at.min(text.len());
        while !text.is_char_boundary(at) {
            at -= 1;
        }
        let start = text[..at].rfind('\n').map_or(0, |newline| newline + 1);
        let source = text[start..].lines().next().unwrap_or_default();
        Self {
            line: text[..start].matches('\n').count() + 1,
            column: text[start..at].chars().count() + 1,
            source,
        }
    }

    /// The line without control characters, cut to a window around the position, and the number of characters before
    /// the position in this window.
    fn shown(&self) -> (String, usize) {
        let first = (self.column - 1).saturating_sub(WINDOW / 2);
        let cut = |c: char| if foreign::is_plain(c) { c } else { ' ' };
        let shown: String = self.source.chars().skip(first).take(WINDOW).map(cut).collect();
        (shown.trim_end().to_owned(), self.column - 1 - first)
    }
}

fn block(text: &mut String, shown_name: &str, source: &str, problem: &Problem) -> std::fmt::Result {
    let Some(at) = &problem.at else {
        writeln!(text, "error: {shown_name}: {problem}")?;
        return help(text, 0, problem);
    };
    let spot = Spot::of(source, at.start);
    let (line, margin) = (spot.line, spot.line.to_string().len());
    writeln!(text, "error: {shown_name}:{line}:{}: {problem}", spot.column)?;
    let (shown, before) = spot.shown();
    let written = source.get(at.clone()).and_then(|value| value.lines().next()).unwrap_or_default();
    let room = shown.chars().count().saturating_sub(before);
    let carets = "^".repeat(written.chars().count().min(room).max(1));
    writeln!(text, "{:margin$} |", "")?;
    writeln!(text, "{line} | {shown}")?;
    writeln!(text, "{:margin$} | {:before$}{carets}", "", "")?;
    help(text, margin + 1, problem)
}

fn help(text: &mut String, indent: usize, problem: &Problem) -> std::fmt::Result {
    match problem.what.help() {
        Some(help) => writeln!(text, "{:indent$}help: {help}", ""),
        None => Ok(()),
    }
}
