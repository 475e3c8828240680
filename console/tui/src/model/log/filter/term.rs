//! One term of a filter.

use super::word::Word;
use crate::model::log::chunk::Line;
use mission::Severity;
use serde::{Deserialize, Serialize};
use std::cmp::Ordering;

/// The field names, as the screen lists them.
const FIELDS: &str = "sev source station t";

const SEVERITIES: [(&str, Severity); 5] = [
    ("debug", Severity::Debug),
    ("info", Severity::Info),
    ("watch", Severity::Watch),
    ("warn", Severity::Warn),
    ("crit", Severity::Crit),
];

/// One term of a filter.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Term {
    negated: bool,
    test: Test,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
enum Test {
    Severity(Compare, Severity),
    Source(Vec<String>),
    /// Station names, each preceded by the word "station".
    Station(Vec<String>),
    /// Mission time, seconds.
    Time(Compare, f64),
    /// Text anywhere in a line's source or text.
    Text(String),
}

/// The comparison between the term's value and the event's.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
enum Compare {
    Less,
    AtMost,
    Equal,
    AtLeast,
    More,
}

impl Compare {
    fn holds(self, order: Option<Ordering>) -> bool {
        order.is_some_and(|order| match self {
            Self::Less => order.is_lt(),
            Self::AtMost => order.is_le(),
            Self::Equal => order.is_eq(),
            Self::AtLeast => order.is_ge(),
            Self::More => order.is_gt(),
        })
    }
}

impl Term {
    pub(super) fn parse(word: &Word) -> Result<Self, String> {
        let text = word.text.as_str();
        let is_quoted = word.quoted_from == Some(0);
        let (negated, rest) = match text.strip_prefix('-').filter(|rest| !rest.is_empty() && !is_quoted) {
            Some(rest) => (true, rest),
            None => (false, text),
        };
        // Quoted words are plain text, whatever operators they contain.
        let plain = word.quoted_from.map_or(text, |from| &text[..from]);
        let plain = plain.get(usize::from(negated)..).unwrap_or_default();
        let test = match field(plain) {
            Some((name, compare, from)) => field_test(name, compare, &rest[from..])?,
            None => Test::Text(rest.to_lowercase()),
        };
        Ok(Self { negated, test })
    }

    pub(super) fn passes(&self, line: &Line) -> bool {
        let holds = match &self.test {
            Test::Severity(compare, severity) => compare.holds(line.severity.partial_cmp(severity)),
            Test::Source(names) => names.iter().any(|name| line.source() == name),
            Test::Station(names) => names.iter().any(|name| names_station(line.words, name)),
            Test::Time(compare, t_s) => compare.holds(line.t_s.partial_cmp(t_s)),
            Test::Text(text) => line.words.contains(text.as_str()),
        };
        holds != self.negated
    }

    /// The minimum severity, if the term requires one.
    pub(super) fn least(&self) -> Option<Severity> {
        match self.test {
            Test::Severity(Compare::AtLeast, severity) if !self.negated => Some(severity),
            _ => None,
        }
    }

    /// Whether the term asks for the messages of planners about their own work.
    pub(super) fn is_debug(&self) -> bool {
        matches!(self.test, Test::Severity(Compare::AtLeast | Compare::Equal, Severity::Debug))
            && !self.negated
    }
}

/// The field name, the comparison, and the start of the value; `None` for plain text.
fn field(word: &str) -> Option<(&str, Compare, usize)> {
    let sign = word.find(['=', ':', '<', '>'])?;
    let name = &word[..sign];
    if name.is_empty() || !name.bytes().all(|letter| letter.is_ascii_alphabetic()) {
        return None;
    }
    let rest = &word[sign..];
    let (compare, length) = match rest.as_bytes() {
        [b'>', b'=', ..] => (Compare::AtLeast, 2),
        [b'<', b'=', ..] => (Compare::AtMost, 2),
        [b'>', ..] => (Compare::More, 1),
        [b'<', ..] => (Compare::Less, 1),
        _ => (Compare::Equal, 1),
    };
    Some((name, compare, sign + length))
}

fn field_test(name: &str, compare: Compare, value: &str) -> Result<Test, String> {
    let name = name.to_ascii_lowercase();
    match (name.as_str(), compare) {
        ("sev" | "severity", _) => Ok(Test::Severity(compare, severity(value)?)),
        ("source", Compare::Equal) => Ok(Test::Source(list(value, "source=ae,tether")?)),
        ("station", Compare::Equal) => {
            let names = list(value, "station=C")?;
            Ok(Test::Station(names.iter().map(|name| format!("station {name}")).collect()))
        }
        ("source" | "station", _) => Err(format!("{name} takes only =")),
        ("t", Compare::Equal) => Err("t takes only < <= > >=".into()),
        ("t", _) => time_s(value).map(|t_s| Test::Time(compare, t_s)),
        _ => Err(format!("unknown field `{name}`; fields: {FIELDS}; quote text that contains = : < >")),
    }
}

/// The severity whose word begins with the given text.
fn severity(value: &str) -> Result<Severity, String> {
    let typed = value.to_ascii_lowercase();
    let mut found = SEVERITIES.iter().filter(|(word, _)| !typed.is_empty() && word.starts_with(&typed));
    match (found.next(), found.next()) {
        (Some((_, severity)), None) => Ok(*severity),
        _ => Err("sev must be debug, info, watch, warn or crit".into()),
    }
}

fn list(value: &str, example: &str) -> Result<Vec<String>, String> {
    let names: Vec<String> =
        value.split(',').filter(|name| !name.is_empty()).map(str::to_lowercase).collect();
    if names.is_empty() { Err(format!("value missing, for example {example}")) } else { Ok(names) }
}

/// Parses mission time, either as the screen writes it, with hours and minutes first, or as seconds.
fn time_s(value: &str) -> Result<f64, String> {
    let wrong = || "t must be hh:mm, hh:mm:ss or seconds".to_owned();
    let parts: Vec<&str> = value.trim_start_matches("T+").trim_end_matches('s').split(':').collect();
    let numbers: Vec<f64> = parts.iter().map_while(|part| part.parse().ok()).collect();
    match numbers[..] {
        _ if numbers.len() != parts.len() || !numbers.iter().all(|n| n.is_finite()) => Err(wrong()),
        [seconds] => Ok(seconds),
        [hours, minutes] => Ok(3600.0 * hours + 60.0 * minutes),
        [hours, minutes, seconds] => Ok(3600.0 * hours + 60.0 * minutes + seconds),
        _ => Err(wrong()),
    }
}

/// Whether the words name this station. A station whose name only begins with this name does not
/// count.
fn names_station(words: &str, station: &str) -> bool {
    let ends = |at: usize| !words[at..].starts_with(char::is_alphanumeric);
    words.match_indices(station).any(|(at, _)| ends(at + station.len()))
}
