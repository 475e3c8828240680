//! Turns bytes into messages and named faults.

use super::{
    FAULT_AFTER, LINE_MAX,
    check::{Checked, Misfit, misfit},
    fields::fields_of,
    lines::{Lines, Piece},
    message::{
        Ae, Arrival, Bye, Channel, Commander, Difference, Drive, FromVehicle, Has, Hello, Limits, Mode,
        Odometry, Outline, Ping, Pong, Pose, PulseLengths, Readings, Scan, State, StationRanges, Stop,
        Tether, ToVehicle,
    },
    path::{field_at, keys},
    session::{FromSession, ToSession},
};
use serde::{Deserialize, de::DeserializeOwned};
use std::collections::BTreeSet;

/// Maximum number of unknown keys and kinds that are remembered and reported; further ones are only counted.
const UNKNOWN_MAX: usize = 64;
/// Maximum number of characters of an unknown key or kind that are kept.
const UNKNOWN_CHARS: usize = 64;
/// Maximum number of characters kept of the reason for a malformed line; the reason may quote the line.
const REASON_CHARS: usize = 160;

/// The meaning of a line.
#[derive(Debug, Clone, PartialEq)]
pub enum Heard<M> {
    /// A message.
    Message(M),
    /// A kind or a key that this version does not know. It was ignored, and is reported only once. If only a key was
    /// unknown, its message follows.
    Unknown(Unknown),
    /// A line that is not a valid message. It was ignored.
    Malformed(Misfit),
}

/// Something that this version of the protocol does not know.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub enum Unknown {
    /// A kind of message.
    Kind(String),
    /// A key in a message.
    Key {
        /// The kind of the message.
        kind: &'static str,
        /// The key.
        key: String,
    },
}

/// The number of lines of each sort.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Counts {
    /// Messages, without repetitions.
    pub messages: u64,
    /// Malformed lines.
    pub malformed: u64,
    /// Malformed lines since the last message.
    pub malformed_in_row: u32,
    /// Messages of unknown kinds.
    pub unknown_kinds: u64,
}

/// A direction of the wire.
pub trait Incoming: Sized {
    /// The earlier messages with which a message must agree.
    type Session;
    /// The kinds of messages, each with the keys that it may contain at any depth.
    fn kinds() -> Vec<(&'static str, Vec<&'static str>)>;
    /// Parses a message of a known kind.
    ///
    /// # Errors
    /// If a field of this kind is missing, or has a value of the wrong type.
    fn parse(kind: &str, line: &str) -> serde_json::Result<Self>;
    /// Checks the values of a message.
    ///
    /// # Errors
    /// The first value that is out of bounds.
    fn check(&self, session: &mut Self::Session) -> Result<(), Misfit>;
    /// The part of a malformed line that counts although another field is wrong.
    fn rest_of(_: &str, _: &Self::Session) -> Option<Self> {
        None
    }
    /// Whether a message only repeats an earlier one, so that it is left out.
    fn is_repeated(&self, _: &Self::Session) -> bool {
        false
    }
}

/// Reads one direction of the wire, however the bytes are divided. Keeps at most [`LINE_MAX`] bytes.
///
/// ```
/// use vehicle::wire::{FromSession, FromVehicle, Heard, Reader};
///
/// let mut reader = Reader::<FromVehicle>::new(FromSession::default());
/// assert!(reader.read(b"{\"type\": \"pong\", \"echo_s\": 1.5, \"sta").is_empty());
/// let heard = reader.read(b"mp_s\": NaN}\n");
/// let Heard::Malformed(fault) = &heard[0] else { panic!("NaN is not a JSON number") };
/// assert_eq!(fault.to_string(), "pong.stamp_s: NaN is not a finite number");
/// ```
#[derive(Debug, Clone)]
pub struct Reader<M: Incoming> {
    lines: Lines,
    session: M::Session,
    kinds: Vec<(&'static str, Vec<&'static str>)>,
    seen: BTreeSet<Unknown>,
    counts: Counts,
}

impl<M: Incoming> Reader<M> {
    /// A reader for a new connection.
    pub fn new(session: M::Session) -> Self {
        Self {
            lines: Lines::default(),
            session,
            kinds: M::kinds(),
            seen: BTreeSet::new(),
            counts: Counts::default(),
        }
    }

    /// The state that follows from the messages so far.
    pub fn session(&self) -> &M::Session {
        &self.session
    }

    /// The number of lines of each sort.
    pub fn counts(&self) -> Counts {
        self.counts
    }

    /// Whether [`FAULT_AFTER`] malformed lines in a row make the link faulty.
    pub fn is_faulty(&self) -> bool {
        self.counts.malformed_in_row >= FAULT_AFTER
    }

    /// Takes the next bytes, and returns the meaning of each line that ends in them.
    pub fn read(&mut self, bytes: &[u8]) -> Vec<Heard<M>> {
        let mut heard = Vec::new();
        let mut lines = std::mem::take(&mut self.lines);
        lines.take(bytes, |piece| match piece {
            Piece::Line(line) => self.line(line, &mut heard),
            Piece::Overlong => {
                let what = format!("the line is longer than {LINE_MAX} bytes");
                heard.push(self.malformed(Misfit { field: String::new(), what }));
            }
        });
        self.lines = lines;
        heard
    }

    /// The place at which the stream has stopped within a line, as a field; `None` between two lines.
    pub fn unfinished(&self) -> Option<String> {
        let line = String::from_utf8_lossy(self.lines.unfinished()?);
        let parts = [kind_of(&line), field_at(&line, line.len())];
        let field = parts.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join(".");
        Some(if field.is_empty() { "its kind is incomplete".into() } else { field })
    }

    /// Ends the stream: a line that was not ended is malformed.
    pub fn finish(&mut self) -> Option<Heard<M>> {
        let rest = self.lines.finish()?;
        let line = String::from_utf8_lossy(&rest);
        let what = "the line ends here, without a line feed".to_owned();
        Some(self.malformed(Misfit { field: field_at(&line, line.len()), what }))
    }

    fn malformed(&mut self, misfit: Misfit) -> Heard<M> {
        self.counts.malformed += 1;
        self.counts.malformed_in_row = self.counts.malformed_in_row.saturating_add(1);
        Heard::Malformed(misfit)
    }

    fn line(&mut self, line: &[u8], heard: &mut Vec<Heard<M>>) {
        if line.trim_ascii().is_empty() {
            return;
        }
        match self.message(line, heard) {
            Ok(Some(message)) => {
                self.counts.messages += 1;
                self.counts.malformed_in_row = 0;
                heard.push(Heard::Message(message));
            }
            Ok(None) => {}
            Err(misfit) => {
                let malformed = self.malformed(misfit);
                heard.push(malformed);
                let rest = std::str::from_utf8(line).ok().and_then(|line| M::rest_of(line, &self.session));
                heard.extend(rest.map(Heard::Message));
            }
        }
    }

    fn message(&mut self, line: &[u8], heard: &mut Vec<Heard<M>>) -> Result<Option<M>, Misfit> {
        let Ok(line) = std::str::from_utf8(line) else { return misfit("", "the line is not in UTF-8") };
        // serde reads structs from lists, too.
        if !line.trim_start().starts_with('{') {
            return misfit("", "the line is not a JSON object");
        }
        let head: Head = serde_json::from_str(line).map_err(|error| named("", line, &error))?;
        let Some((kind, known)) = self.kinds.iter().find(|(kind, _)| *kind == head.kind) else {
            self.counts.unknown_kinds += 1;
            self.unknown(Unknown::Kind(shortened(&head.kind)), heard);
            return Ok(None);
        };
        let kind = *kind;
        let unknown: BTreeSet<&str> =
            keys(line).filter(|key| *key != "type" && !known.contains(key)).collect();
        let message = M::parse(kind, line).map_err(|error| named(kind, line, &error))?;
        if message.is_repeated(&self.session) {
            return Ok(None);
        }
        message.check(&mut self.session)?;
        for key in unknown {
            self.unknown(Unknown::Key { kind, key: shortened(key) }, heard);
        }
        Ok(Some(message))
    }

    fn unknown(&mut self, unknown: Unknown, heard: &mut Vec<Heard<M>>) {
        if self.seen.len() < UNKNOWN_MAX && self.seen.insert(unknown.clone()) {
            heard.push(Heard::Unknown(unknown));
        }
    }
}

#[derive(Deserialize)]
struct Head {
    #[serde(rename = "type")]
    kind: String,
}

fn shortened(text: &str) -> String {
    text.chars().take(UNKNOWN_CHARS).collect()
}

/// The field and the reason of an error of serde.
fn named(kind: &str, line: &str, error: &serde_json::Error) -> Misfit {
    let said = error.to_string();
    let said = said.split(" at line ").next().unwrap_or_default();
    // Messages are single lines, so a column is a place in bytes.
    let at = error.column().min(line.len());
    let place = if said.starts_with("missing field") || said.starts_with("duplicate field") {
        said.split('`').nth(1).unwrap_or_default().to_owned()
    } else {
        field_at(line, at)
    };
    let kind = if kind.is_empty() { kind_of(line) } else { kind.to_owned() };
    let field = [kind, place].into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join(".");
    let what = match not_finite(line, at) {
        Some(number) if error.is_syntax() => format!("{number} is not a finite number"),
        _ if said == "number out of range" => "the number is too large".into(),
        _ if error.is_eof() => "the line ends here, before the object is complete".into(),
        _ => without_types(&said.chars().take(REASON_CHARS).collect::<String>()),
    };
    Misfit { field, what }
}

/// A message of serde without the names of Rust's types.
fn without_types(said: &str) -> String {
    let Some((before, expected)) = said.rsplit_once(", expected ") else { return said.to_owned() };
    let expected = match expected {
        "f64" | "f32" => "a number",
        "u8" | "u16" | "u32" | "u64" | "usize" => "a whole number of at least 0",
        "i64" | "i32" => "a whole number",
        other => other,
    };
    format!("{before}, expected {expected}")
}

/// The kind of a message that cannot be parsed, if the kind can be found.
fn kind_of(line: &str) -> String {
    word_of(line, "type").unwrap_or_default()
}

/// The word at a key of a line that cannot be parsed; `None` without the key, and empty if the value is not a word.
fn word_of(line: &str, key: &str) -> Option<String> {
    let after = line.split(&format!("\"{key}\"")).nth(1)?;
    let value = after.trim_start().strip_prefix(':').unwrap_or_default().trim_start();
    let word = value.strip_prefix('"').and_then(|rest| rest.split('"').next()).unwrap_or_default();
    let is_word =
        word.len() <= UNKNOWN_CHARS && word.bytes().all(|byte| byte.is_ascii_lowercase() || byte == b'_');
    Some(if is_word { word.to_owned() } else { String::new() })
}

/// The state in a malformed line, if the vehicle says that it does not obey, or if its mode cannot be read: each field
/// counts by itself, because a wrong battery must not hide an emergency stop.
fn alarming(line: &str) -> Option<State> {
    fn value<T: DeserializeOwned>(word: Option<String>) -> Option<T> {
        serde_json::from_value(word?.into()).ok()
    }
    if kind_of(line) != "state" {
        return None;
    }
    let (mode, commander) = (word_of(line, "mode"), word_of(line, "commander"));
    let is_unreadable = mode.as_ref().is_some_and(|mode| value::<Mode>(Some(mode.clone())).is_none());
    let mode = if is_unreadable { Mode::Fault } else { value(mode).unwrap_or(Mode::Ready) };
    let text = is_unreadable.then(|| "it sent a `state` whose `mode` is unknown".to_owned());
    let commander = value(commander).unwrap_or_default();
    let is_alarming = mode != Mode::Ready || commander != Commander::You;
    is_alarming.then_some(State { stamp_s: 0.0, mode, text, battery: None, commander })
}

/// A word for a number that is not finite, around a place in a line.
fn not_finite(line: &str, at: usize) -> Option<&'static str> {
    let bytes = line.as_bytes();
    let from = at.saturating_sub(2);
    let near = &bytes[from.min(bytes.len())..(at + 9).min(bytes.len())];
    ["-Infinity", "Infinity", "NaN"]
        .into_iter()
        .find(|word| near.windows(word.len()).any(|window| window == word.as_bytes()))
}

fn parsed<T: DeserializeOwned>(line: &str) -> serde_json::Result<T> {
    serde_json::from_str(line)
}

impl Incoming for FromVehicle {
    type Session = FromSession;

    fn kinds() -> Vec<(&'static str, Vec<&'static str>)> {
        let hello = [fields_of::<Hello>(), fields_of::<Limits>(), fields_of::<Has>()];
        let readings = [
            fields_of::<Readings>(),
            fields_of::<Odometry>(),
            fields_of::<Pose>(),
            fields_of::<Ae>(),
            fields_of::<StationRanges>(),
            fields_of::<PulseLengths>(),
            fields_of::<Arrival>(),
            fields_of::<Difference>(),
            fields_of::<Scan>(),
            fields_of::<Tether>(),
            fields_of::<Outline>(),
            fields_of::<Channel>(),
        ];
        vec![
            ("hello", hello.concat()),
            ("readings", readings.concat()),
            ("state", fields_of::<State>().to_vec()),
            ("pong", fields_of::<Pong>().to_vec()),
        ]
    }

    fn parse(kind: &str, line: &str) -> serde_json::Result<Self> {
        Ok(match kind {
            "hello" => Self::Hello(parsed(line)?),
            "readings" => Self::Readings(parsed(line)?),
            "state" => Self::State(parsed(line)?),
            _ => Self::Pong(parsed(line)?),
        })
    }

    fn check(&self, session: &mut FromSession) -> Checked {
        session.check(self)
    }

    fn rest_of(line: &str, session: &FromSession) -> Option<Self> {
        session.hello()?;
        alarming(line).map(Self::State)
    }

    fn is_repeated(&self, session: &FromSession) -> bool {
        session.is_repeated(self)
    }
}

impl Incoming for ToVehicle {
    type Session = ToSession;

    fn kinds() -> Vec<(&'static str, Vec<&'static str>)> {
        vec![
            ("drive", fields_of::<Drive>().to_vec()),
            ("stop", fields_of::<Stop>().to_vec()),
            ("ping", fields_of::<Ping>().to_vec()),
            ("bye", fields_of::<Bye>().to_vec()),
        ]
    }

    fn parse(kind: &str, line: &str) -> serde_json::Result<Self> {
        Ok(match kind {
            "drive" => Self::Drive(parsed(line)?),
            "stop" => Self::Stop(parsed(line)?),
            "ping" => Self::Ping(parsed(line)?),
            _ => Self::Bye(parsed(line)?),
        })
    }

    fn check(&self, session: &mut ToSession) -> Checked {
        session.check(self)
    }
}
