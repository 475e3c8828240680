//! Decodes the bytes that a terminal sends: keys, mouse reports, pastes, and the terminal's own answers.
//!
//! No input may prevent a HOLD from reaching the robot. Wherever a space arrives within a sequence that is not a key,
//! it is reported as [`Input::Stop`], and Ctrl-C is a key everywhere. Control strings and answers are swallowed without
//! being stored, so that no part of them is taken for keys; a sequence that breaks off ends when nothing follows for
//! [`Decoder::patience`].

mod csi;
mod osc;
#[cfg(test)]
mod tests;
mod utf8;

use crate::keys::{Key, KeyPress};
use csi::Csi;
use osc::ControlString;
use std::time::Duration;
use utf8::Utf8;

/// An input that the terminal has reported.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Input {
    /// A key went down, or repeats.
    Key(KeyPress),
    /// A key was released, or a key went down that the console does not use.
    OtherKey,
    /// A space that is not a key: it may be part of a paste or of an answer, or a key that arrived in the middle of one.
    /// It stops the robot, and has no other effect.
    Stop,
    /// Pasted text.
    Paste(String),
    /// The mouse.
    Mouse(Pointed),
    /// The background colour that was asked for: red, green and blue.
    Background([u8; 3]),
    /// The terminal's answer about its kind, which it sends after all answers that were asked for before.
    Kind,
}

/// A report of the mouse.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Pointed {
    /// The column, from 0.
    pub column: u16,
    /// The row, from 0.
    pub row: u16,
    /// What the mouse did.
    pub gesture: Gesture,
}

/// What the mouse did.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Gesture {
    /// The left button went down.
    Down,
    /// The mouse moved with the left button down.
    Drag,
    /// The left button went up.
    Up,
    /// The wheel turned one step.
    Wheel {
        /// Whether it turned away from the user.
        up: bool,
    },
}

const ESC: u8 = 0x1b;
/// Ctrl-C, as terminals send it in raw mode.
const INTERRUPT: u8 = 0x03;
/// A lone Esc is a key if nothing follows within this time.
const LONE_ESC: Duration = Duration::from_millis(50);
/// A sequence has broken off if nothing follows within this time.
const BROKEN_OFF: Duration = Duration::from_millis(300);
/// A paste has broken off if nothing follows within this time. The rest of a paste counts as keys, so this time is
/// longer than a connection usually stalls.
const PASTE_BROKEN_OFF: Duration = Duration::from_secs(5);
/// Maximum length of a paste, bytes; the rest of a longer paste is dropped.
const LONGEST_PASTE: usize = 1 << 16;
/// The end marker of a paste.
const PASTE_END: &[u8] = b"\x1b[201~";

/// Decodes a stream of bytes. The division of the stream does not matter, as long as no time limit is reached.
#[derive(Debug, Default)]
pub struct Decoder {
    state: State,
}

#[derive(Debug, Default)]
enum State {
    /// Between two inputs, or within a character.
    #[default]
    Ground,
    /// Within a character of several bytes; `is_alt` if Esc came before it.
    Character { utf8: Utf8, is_alt: bool },
    /// After Esc.
    Escape,
    /// After Esc O: one more byte.
    Ss3,
    /// After Esc [ [, as the Linux console sends function keys: one more byte.
    LinuxFunction,
    /// After Esc [ M: this many more bytes of an old mouse report.
    OldMouse(u8),
    /// After Esc [.
    Csi(Csi),
    /// Within a control string.
    String(ControlString),
    /// After Esc within a control string.
    StringEscape(ControlString),
    /// Within a paste; this many bytes of its end marker have been seen.
    Paste { text: Vec<u8>, ending: usize },
}

impl Decoder {
    /// Decodes bytes and appends what they contain.
    pub fn feed(&mut self, bytes: &[u8], inputs: &mut Vec<Input>) {
        for &byte in bytes {
            self.take(byte, inputs);
        }
    }

    /// How long to wait for the next byte; `None` if nothing is incomplete.
    pub fn patience(&self) -> Option<Duration> {
        match self.state {
            State::Ground => None,
            State::Escape | State::StringEscape(_) => Some(LONE_ESC),
            State::Paste { .. } => Some(PASTE_BROKEN_OFF),
            _ => Some(BROKEN_OFF),
        }
    }

    /// Ends an incomplete sequence, because nothing has followed.
    pub fn give_up(&mut self, inputs: &mut Vec<Input>) {
        match std::mem::take(&mut self.state) {
            State::Escape | State::StringEscape(_) => inputs.push(Input::Key(Key::Esc.into())),
            State::Paste { text, .. } => inputs.push(pasted(&text)),
            _ => {}
        }
    }

    fn take(&mut self, byte: u8, inputs: &mut Vec<Input>) {
        if byte == INTERRUPT {
            // The rest of a sequence is still swallowed.
            inputs.push(Input::Key(Key::Ctrl('c').into()));
            if matches!(self.state, State::Escape | State::Character { .. }) {
                self.state = State::Ground;
            }
            return;
        }
        let is_within = !matches!(self.state, State::Ground | State::Character { .. });
        if is_within && byte == b' ' && inputs.last() != Some(&Input::Stop) {
            inputs.push(Input::Stop);
        }
        self.state = match std::mem::take(&mut self.state) {
            State::Ground => ground(byte, inputs),
            State::Character { utf8, is_alt } => character(utf8, is_alt, byte, inputs),
            State::Ss3 => final_byte(csi::ss3(byte), inputs),
            State::LinuxFunction => final_byte(csi::linux_function(byte), inputs),
            State::OldMouse(0 | 1) => State::Ground,
            State::OldMouse(left) => State::OldMouse(left - 1),
            State::Csi(csi) => control_sequence(csi, byte, inputs),
            State::String(string) => control_string(string, byte, inputs),
            State::StringEscape(string) if byte == b'\\' => end_string(&string, inputs),
            State::Escape | State::StringEscape(_) => escape(byte, inputs),
            State::Paste { text, ending } => paste(text, ending, byte, inputs),
        };
    }
}

fn ground(byte: u8, inputs: &mut Vec<Input>) -> State {
    let key = match byte {
        ESC => return State::Escape,
        b'\r' => Key::Enter,
        b'\t' => Key::Tab,
        0x7f => Key::Backspace,
        0 => Key::Ctrl(' '),
        0x01..=0x1a => Key::Ctrl(char::from(byte - 1 + b'a')),
        0x1c..=0x1f => Key::Ctrl(char::from(byte - 0x1c + b'4')),
        0x20..=0x7e => Key::Char(char::from(byte)),
        0x80..=0x9f => return control(byte, inputs),
        _ => {
            return Utf8::begin(byte).map_or(State::Ground, |utf8| State::Character { utf8, is_alt: false });
        }
    };
    inputs.push(Input::Key(key.into()));
    State::Ground
}

/// A control character of eight bits: one byte instead of Esc and another.
fn control(byte: u8, inputs: &mut Vec<Input>) -> State {
    introduced(byte - 0x40).unwrap_or_else(|| {
        inputs.push(Input::OtherKey);
        State::Ground
    })
}

/// The sequence that Esc and this byte begin.
fn introduced(byte: u8) -> Option<State> {
    match byte {
        b'[' => Some(State::Csi(Csi::default())),
        b'O' => Some(State::Ss3),
        b']' | b'P' | b'X' | b'^' | b'_' => Some(State::String(ControlString::begin(byte))),
        _ => None,
    }
}

/// The byte after Esc.
fn escape(byte: u8, inputs: &mut Vec<Input>) -> State {
    if let Some(state) = introduced(byte) {
        return state;
    }
    match byte {
        ESC => {
            inputs.push(Input::Key(Key::Esc.into()));
            return State::Escape;
        }
        // Ctrl-Z also stops the robot.
        0x1a => inputs.push(Input::Key(Key::Ctrl('z').into())),
        0x80..=0x9f => return control(byte, inputs),
        0xa0.. => {
            return Utf8::begin(byte).map_or(State::Ground, |utf8| State::Character { utf8, is_alt: true });
        }
        // Alt and a key cannot be distinguished from Esc followed by a key. The Esc counts, because it moves nothing and
        // may cancel a question; the key does not count.
        _ => inputs.push(Input::Key(Key::Esc.into())),
    }
    State::Ground
}

fn character(mut utf8: Utf8, is_alt: bool, byte: u8, inputs: &mut Vec<Input>) -> State {
    if !(0x80..=0xbf).contains(&byte) {
        // The character has broken off.
        return ground(byte, inputs);
    }
    match utf8.take(byte) {
        None => return State::Character { utf8, is_alt },
        Some(Ok(letter @ '\u{80}'..='\u{9f}')) => return control(letter as u8, inputs),
        Some(Ok(_)) if is_alt => inputs.push(Input::Key(Key::Esc.into())),
        Some(Ok(letter)) => inputs.push(Input::Key(Key::Char(letter).into())),
        Some(Err(_)) => {}
    }
    State::Ground
}

fn final_byte(key: Option<Key>, inputs: &mut Vec<Input>) -> State {
    inputs.push(key.map_or(Input::OtherKey, |key| Input::Key(key.into())));
    State::Ground
}

fn control_sequence(mut csi: Csi, byte: u8, inputs: &mut Vec<Input>) -> State {
    match byte {
        b'[' if csi.is_empty() => State::LinuxFunction,
        b'M' if csi.is_empty() => State::OldMouse(3),
        0x20..=0x3f => {
            csi.take(byte);
            State::Csi(csi)
        }
        b'~' if csi.is(b"200") => State::Paste { text: Vec::new(), ending: 0 },
        0x40..=0x7e => {
            inputs.extend(csi.input(byte));
            State::Ground
        }
        ESC => State::Escape,
        // The byte is not part of a known sequence, so none of these bytes may count as a key.
        0x00..=0x1f | 0x7f => State::Csi(csi),
        0x80.. => ground(byte, inputs),
    }
}

fn control_string(mut string: ControlString, byte: u8, inputs: &mut Vec<Input>) -> State {
    match string.take(byte) {
        osc::Next::More => State::String(string),
        osc::Next::Escape => State::StringEscape(string),
        osc::Next::End => end_string(&string, inputs),
    }
}

fn end_string(string: &ControlString, inputs: &mut Vec<Input>) -> State {
    inputs.extend(string.background().map(Input::Background));
    State::Ground
}

fn paste(mut text: Vec<u8>, ending: usize, byte: u8, inputs: &mut Vec<Input>) -> State {
    if byte == PASTE_END[ending] {
        if ending + 1 == PASTE_END.len() {
            inputs.push(pasted(&text));
            return State::Ground;
        }
        return State::Paste { text, ending: ending + 1 };
    }
    // The end begins with its only Esc, so after a mismatch it can begin again only with this byte.
    let is_esc = byte == ESC;
    let more = PASTE_END[..ending].iter().copied().chain((!is_esc).then_some(byte));
    let room = LONGEST_PASTE.saturating_sub(text.len());
    text.extend(more.take(room));
    State::Paste { text, ending: usize::from(is_esc) }
}

fn pasted(text: &[u8]) -> Input {
    Input::Paste(String::from_utf8_lossy(text).into_owned())
}
