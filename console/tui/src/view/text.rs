//! Formats numbers and words for the screen.

pub(crate) use crate::model::log::clock;

use crate::model::history::SLOT_S;
use crate::model::{History, Speed};
use ratatui::text::Span;
use world::{Point, coverage::percent_text};

/// Width of the bar of a meter, columns.
pub(crate) const METER: usize = 8;
/// The share of its limit from which a value is close to it.
pub(crate) const CLOSE: f64 = 0.8;

/// A share as a percentage, without the per cent sign.
pub(crate) fn percent(share: f64) -> String {
    if share.is_finite() { percent_text(share, 1) } else { number(share, 1) }
}

/// A number with the given number of decimals; a dash if it is not finite.
pub(crate) fn number(value: f64, decimals: usize) -> String {
    if !value.is_finite() {
        return "-".into();
    }
    let text = format!("{value:.decimals$}");
    // A value that rounds to zero has no sign.
    if text.trim_start_matches('-').chars().all(|c| c == '0' || c == '.') {
        text.trim_start_matches('-').into()
    } else {
        text
    }
}

/// A count with its noun in singular or plural.
pub(crate) fn counted(n: usize, what: &str) -> String {
    format!("{n} {what}{}", if n == 1 { "" } else { "s" })
}

/// The coordinates of a place on the floor.
pub(crate) fn place(point: Point) -> String {
    format!("{}, {} m", number(point.x, 2), number(point.y, 2))
}

/// The simulation speed.
pub(crate) fn speed(speed: Speed) -> String {
    match speed {
        Speed::Times(factor) => format!("×{factor}"),
        Speed::Max => "×max".into(),
    }
}

/// How long ago something happened, in its largest unit: `12 s`, `4 min`, `2 h`, `3 d`; a dash if the time is unknown or
/// in the future.
pub(crate) fn ago(seconds: f64) -> String {
    const UNITS: [(f64, &str); 3] = [(86_400.0, "d"), (3600.0, "h"), (60.0, "min")];
    // Clocks that differ slightly must not look like an error.
    if !seconds.is_finite() || seconds < -60.0 {
        return "-".into();
    }
    let unit = UNITS.into_iter().find(|(length_s, _)| seconds >= *length_s);
    let (length_s, unit) = unit.unwrap_or((1.0, "s"));
    format!("{} {unit}", (seconds.max(0.0) / length_s).floor())
}

/// A heading in degrees, 0 to 359, counter-clockwise from east.
pub(crate) fn degrees(heading_rad: f64) -> String {
    let degrees = heading_rad.to_degrees().rem_euclid(360.0).round();
    number(if degrees >= 360.0 { 0.0 } else { degrees }, 0)
}

/// Text cut to a width; an ellipsis replaces the rest. The cut is between two words, because half a word or half a figure
/// misleads; a word that takes more than half of the width is cut inside.
pub(crate) fn fit(text: &str, columns: usize) -> String {
    if width(text) <= columns {
        return text.to_owned();
    }
    let mut cut = String::new();
    let mut letters = text.chars();
    for letter in letters.by_ref() {
        if width(&cut) + width(letter.encode_utf8(&mut [0; 4])) >= columns {
            if letter != ' ' {
                cut.truncate(whole_words(&cut, columns));
            }
            break;
        }
        cut.push(letter);
    }
    if columns > 0 {
        cut.push('…');
    }
    cut
}

/// The length of a text, bytes, without its last, incomplete word and the marks before it; the whole length if little
/// would remain.
fn whole_words(text: &str, columns: usize) -> usize {
    let words = text.rsplit_once(' ').map_or(text, |(words, _)| words);
    let words = words.trim_end_matches([' ', ',', ';', ':', '(', '-']);
    if 2 * width(words) >= columns { words.len() } else { text.len() }
}

/// The first wording that fits, in order from longest to shortest; the last one if none fits.
pub(crate) fn wording<const N: usize>(wordings: [String; N], columns: usize) -> String {
    let fits = wordings.iter().position(|words| width(words) <= columns).unwrap_or(N - 1);
    wordings.into_iter().nth(fits).unwrap_or_default()
}

/// As many leading clauses of a sentence as fit, for a row whose full sentence is shown elsewhere. The text ends in an
/// ellipsis only if not even the first clause fits. A clause has at least two words after its last colon, comma or question
/// mark and does not end within parentheses.
pub(crate) fn clauses(sentence: &str, columns: usize) -> String {
    let fitting = heads(sentence).rfind(|head| width(head) <= columns);
    fitting.map_or_else(|| fit(sentence, columns), str::to_owned)
}

/// As many leading clauses of a sentence as fit into a number of lines; if not even the first clause fits, the lines end in
/// an ellipsis.
pub(crate) fn clauses_in(sentence: &str, lines: usize, columns: usize) -> Vec<String> {
    let mut fitting =
        heads(sentence).map(|head| wrap(head, columns)).filter(|wrapped| wrapped.len() <= lines);
    fitting.next_back().unwrap_or_else(|| first_lines(wrap(sentence, columns), lines, columns))
}

/// The first clause of a sentence.
pub(crate) fn first_clause(sentence: &str) -> &str {
    heads(sentence).next().unwrap_or(sentence)
}

/// The leading clauses of a sentence, from the shortest beginning to the whole sentence.
fn heads(sentence: &str) -> impl DoubleEndedIterator<Item = &str> {
    let ends = sentence.match_indices([';', ':', ',']).map(|(at, _)| at);
    let ends = ends.filter(|at| sentence[at + 1..].starts_with(' '));
    let is_clause = |head: &&str| {
        let last = [": ", ", ", "? "].iter().fold(*head, |rest, end| rest.rsplit(end).next().unwrap_or(rest));
        last.contains(' ') && head.matches('(').count() == head.matches(')').count()
    };
    ends.map(|at| &sentence[..at]).filter(is_clause).chain([sentence])
}

/// As many names as fit, and how many more there are.
pub(crate) fn names(names: &[&str], columns: usize) -> String {
    let wordings = (0..names.len()).map(|left_out| match left_out {
        0 => names.join(" "),
        _ => format!("{} +{left_out}", names[..names.len() - left_out].join(" ")),
    });
    wordings.into_iter().find(|words| width(words) <= columns).unwrap_or_else(|| format!("{}", names.len()))
}

/// A sentence starting with a capital letter; a name such as `cell_m` keeps its small letter.
pub(crate) fn capitalized(sentence: &str) -> String {
    if sentence.split_whitespace().next().is_some_and(|first| first.contains('_')) {
        return sentence.to_owned();
    }
    let mut letters = sentence.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// Text padded or cut to an exact width.
pub(crate) fn column(text: &str, columns: usize) -> String {
    let cut = fit(text, columns);
    let blank = columns.saturating_sub(width(&cut));
    cut + &" ".repeat(blank)
}

/// The first lines of a text; if there are more, the last one ends in an ellipsis.
pub(crate) fn first_lines(mut lines: Vec<String>, most: usize, columns: usize) -> Vec<String> {
    if lines.len() > most {
        lines.truncate(most);
        if let Some(last) = lines.last_mut() {
            *last = fit(last, columns.saturating_sub(1)).trim_end_matches('…').to_owned() + "…";
        }
    }
    lines
}

/// The width of a text, columns.
pub(crate) fn width(text: &str) -> usize {
    Span::raw(text).width()
}

/// Units that stay in the line of their number.
const UNITS: [&str; 14] =
    ["m", "m²", "m²/min", "m/s", "mm", "s", "min", "h", "N", "%", "MB", "GB", "°/s", "deg/s"];

/// The words of a sentence; a number and its unit are one word.
fn words(sentence: &str) -> Vec<String> {
    let mut words: Vec<String> = Vec::new();
    for word in sentence.split_whitespace() {
        let unit = word.trim_end_matches([',', '.', ';', ':', ')']);
        let is_number = |before: &&mut String| before.ends_with(|letter: char| letter.is_ascii_digit());
        match words.last_mut().filter(is_number).filter(|_| UNITS.contains(&unit)) {
            Some(number) => {
                number.push(' ');
                number.push_str(word);
            }
            None => words.push(word.to_owned()),
        }
    }
    words
}

/// Wraps a sentence into lines of a given maximum width. A word that is too long for a line, such as a path, is divided; a
/// number and its unit are not.
pub(crate) fn wrap(sentence: &str, columns: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in words(sentence).iter().flat_map(|word| divided(word, columns)) {
        match lines.last_mut() {
            Some(line) if width(line) + 1 + width(&word) < columns => {
                line.push(' ');
                line.push_str(&word);
            }
            _ => lines.push(word),
        }
    }
    lines
}

/// A word in pieces of a maximum width, divided behind a mark such as `/` or `-`; a piece without a mark is divided between
/// two letters.
fn divided(word: &str, columns: usize) -> Vec<String> {
    const MARKS: [char; 5] = ['/', '-', '_', ',', '='];
    let mut pieces: Vec<String> = Vec::new();
    let mut rest = word;
    // A number and its unit are divided at their blank.
    if let Some((number, unit)) = word.split_once(' ').filter(|_| width(word) > columns) {
        return [divided(number, columns), divided(unit, columns)].concat();
    }
    while width(rest) > columns && columns > 0 {
        let ends = rest.char_indices().map(|(at, letter)| at + letter.len_utf8());
        let ends: Vec<usize> = ends.take_while(|end| width(&rest[..*end]) <= columns).collect();
        let marked = ends.iter().rev().find(|end| rest[..**end].ends_with(MARKS));
        let first = rest.chars().next().map_or(0, char::len_utf8);
        let end = marked.or(ends.last()).copied().unwrap_or(first);
        pieces.push(rest[..end].to_owned());
        rest = &rest[end..];
    }
    pieces.extend((!rest.is_empty()).then(|| rest.to_owned()));
    pieces
}

/// Items in lines of a maximum width, with a gap between the items of a line; a longer item is cut at its end.
pub(crate) fn wrap_items(items: &[String], columns: usize, gap: &str) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for item in items.iter().map(|item| fit(item, columns)) {
        match lines.last_mut() {
            Some(line) if width(line) + width(gap) + width(&item) <= columns => {
                line.push_str(gap);
                line.push_str(&item);
            }
            _ => lines.push(item),
        }
    }
    lines
}

/// The span of a sparkline of at most `most_s` seconds.
pub(crate) fn minutes(history: &History, most_s: usize) -> String {
    let [from_s, to_s] = history.span_s(most_s);
    format!("{} min", number((to_s - from_s) / 60.0, 0))
}

/// A bar, filled to a share.
pub(crate) fn bar(share: f64, columns: usize) -> String {
    let full = if share.is_finite() { (share.clamp(0.0, 1.0) * columns as f64).round() as usize } else { 0 };
    "█".repeat(full) + &"░".repeat(columns - full)
}

/// A meter: a bar that is full at the limit, with a mark at the share from which a value is close to the limit.
pub(crate) fn meter(share: f64) -> String {
    let mark = (CLOSE * METER as f64) as usize;
    let place = |(column, glyph)| if column == mark { '┊' } else { glyph };
    bar(share, METER).chars().enumerate().map(place).collect()
}

/// A sparkline of at most `most_s` seconds of a history, from 0 to `top`; each column shows the largest of its values
/// and is blank if it has none.
pub(crate) fn sparkline(history: &History, most_s: usize, top: f64, columns: usize) -> String {
    const STEPS: [char; 8] = ['▁', '▂', '▃', '▄', '▅', '▆', '▇', '█'];
    let mut largest: Vec<Option<f64>> = vec![None; columns];
    let [from_s, to_s] = history.span_s(most_s);
    let column = |t_s: f64| (t_s - from_s) / (to_s - from_s) * columns as f64;
    for (t_s, value) in history.since(from_s).filter_map(|(t_s, value)| Some((t_s, value?))) {
        // A value stands for its whole slot, which can be several columns wide.
        let first = column(t_s).floor() as usize;
        let end = (column(t_s + SLOT_S as f64).ceil() as usize).clamp(first + 1, columns.max(first + 1));
        for slot in largest.iter_mut().take(end).skip(first) {
            *slot = Some(slot.map_or(value, |before| before.max(value)));
        }
    }
    let step = |value: f64| {
        let share = if top > 0.0 && value.is_finite() { value / top } else { 1.0 };
        STEPS[((share.clamp(0.0, 1.0) * 7.0).round() as usize).min(7)]
    };
    largest.into_iter().map(|value| value.map_or(' ', step)).collect()
}

#[cfg(test)]
mod tests;
