//! Reads a journal, even if its writer was killed.

use super::{
    JournalError, fast,
    follow::Follow,
    frames,
    limits::{self, MOST_LINE_BYTES, Pace},
    lines::{Lines, is_packed},
    plain,
    unpacker::FrameStart,
};
use foreign::open_regular;
use mission::{Event, EventKind, event::JOURNAL_VERSION};
use serde::Deserialize;
use std::{
    io::{self, BufRead, Read, Seek, SeekFrom},
    path::{Path, PathBuf},
};

/// A line of a journal.
#[derive(Debug, Clone, PartialEq)]
pub struct JournalLine<'a> {
    /// The bytes in the file, without the newline.
    pub raw: &'a [u8],
    /// The event in plain characters ([`foreign::is_plain`]), except for the scenario text, which stays as it is in
    /// the file. Unknown keys and white space are only in `raw`.
    pub event: Event,
}

/// The place where the next event of a journal starts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct JournalPlace {
    /// Number of bytes of lines before it.
    pub bytes: u64,
    /// Number of lines before it.
    lines: usize,
    /// File offset at which to start reading to reach this place.
    frame: FrameStart,
}

impl JournalPlace {
    /// Number of bytes of the file before it; in a compressed file, those before the frame that contains it.
    pub fn file_bytes(&self) -> u64 {
        self.frame.file
    }
}

/// Reads a journal event by event: as an iterator, or line by line with the bytes of the file.
///
/// Reading ends after the first error. The reader holds one line at a time; a journal that exceeds a limit of valid
/// journals is an error.
pub struct JournalReader {
    lines: Lines,
    path: PathBuf,
    text: Vec<u8>,
    pace: Pace,
    is_verbatim: bool,
    /// Number of bytes of lines read so far.
    bytes: u64,
    line: usize,
    ended: bool,
    truncated: Option<String>,
    unended_bytes: u64,
}

/// Number of bytes read from the end of an uncompressed journal.
const END_BYTES: u64 = 1 << 20;

/// The part of the first line that is common to journals of all versions.
#[derive(Deserialize)]
struct Head {
    event: String,
    journal_version: u32,
}

impl JournalReader {
    /// Opens a journal.
    ///
    /// # Errors
    /// [`JournalError::Read`] if there is no journal.
    pub fn open(path: &Path) -> Result<Self, JournalError> {
        let file = open_regular(path).map_err(|error| read_error(path, &error))?;
        Self::of(file, path, FrameStart::default())
    }

    /// Opens a journal for comparison: texts keep all their characters, even those that are not plain.
    ///
    /// # Errors
    /// See [`JournalReader::open`].
    pub(super) fn open_verbatim(path: &Path) -> Result<Self, JournalError> {
        Ok(Self { is_verbatim: true, ..Self::open(path)? })
    }

    /// Opens a journal that may still be growing. At the end of the file the reader calls `goes_on`, which waits
    /// briefly and returns whether more data may come. The reader waits for the rest of a partial line.
    ///
    /// # Errors
    /// [`JournalError::Read`] if there is no journal.
    pub fn follow(path: &Path, goes_on: impl FnMut() -> bool + Send + 'static) -> Result<Self, JournalError> {
        let file = open_regular(path).map_err(|error| read_error(path, &error))?;
        Self::of(Follow::new(file, goes_on), path, FrameStart::default())
    }

    /// Opens a journal at a place that an earlier reader reached.
    ///
    /// # Errors
    /// [`JournalError::Read`] if the journal is gone.
    pub fn open_at(path: &Path, place: JournalPlace) -> Result<Self, JournalError> {
        let JournalPlace { bytes, lines, frame } = place;
        let failed = |error| read_error(path, &error);
        let mut file = open_regular(path).map_err(failed)?;
        file.seek(SeekFrom::Start(frame.file)).map_err(failed)?;
        let mut reader = Self::of(file, path, frame)?;
        io::copy(&mut reader.lines.text().take(bytes - frame.content), &mut io::sink()).map_err(failed)?;
        Ok(Self { bytes, line: lines, ..reader })
    }

    /// Opens a journal near its end, to find out how far it extends. The first line of the journal is not read,
    /// unless the journal is short. Lines are counted from the place where reading starts.
    ///
    /// # Errors
    /// See [`JournalReader::open`] and [`JournalReader::next_line`].
    pub fn open_end(path: &Path) -> Result<Self, JournalError> {
        let mut reader = Self::open(path)?;
        reader.next_line()?;
        let failed = |error| read_error(path, &error);
        let file = open_regular(path).map_err(failed)?;
        if is_packed(path) {
            let starts = frames::starts(&file).map_err(failed)?;
            return Self::open_at(path, place_in(starts.last().copied().unwrap_or_default()));
        }
        let length = file.metadata().map_err(failed)?.len();
        if length <= END_BYTES {
            return Self::open(path);
        }
        let mut end = Self::open_at(path, place_in(length - END_BYTES))?;
        // Reading starts in the middle of a line.
        let mut cut = end.lines.text().take(MOST_LINE_BYTES as u64);
        cut.skip_until(b'\n').map_err(failed)?;
        Ok(end)
    }

    /// Opens a journal at or shortly before the first event at a mission time, seconds. Little of the compressed data
    /// before that event is read. Lines are counted from the place where reading starts.
    ///
    /// # Errors
    /// See [`JournalReader::open`] and [`JournalReader::next_line`].
    pub fn open_near(path: &Path, t_s: f64) -> Result<Self, JournalError> {
        let mut reader = Self::open(path)?;
        if t_s <= 0.0 || !is_packed(path) {
            return Ok(reader);
        }
        reader.next_line()?;
        let failed = |error| read_error(path, &error);
        let starts = frames::starts(&open_regular(path).map_err(failed)?).map_err(failed)?;
        let (mut first, mut after) = (0, starts.len());
        while first + 1 < after {
            let middle = usize::midpoint(first, after);
            let begin =
                Self::open_at(path, place_in(starts[middle]))?.next_line()?.map(|line| line.event.t_s);
            *(if begin.is_some_and(|begin_s| begin_s < t_s) { &mut first } else { &mut after }) = middle;
        }
        Self::open_at(path, place_in(starts.get(first).copied().unwrap_or_default()))
    }

    /// Number of bytes of lines read so far.
    pub fn bytes(&self) -> u64 {
        self.bytes
    }

    /// The place where the next event starts.
    pub fn place(&self) -> JournalPlace {
        let frame = self.lines.frame_before(self.bytes);
        JournalPlace { bytes: self.bytes, lines: self.line, frame }
    }

    fn of(bytes: impl Read + Send + 'static, path: &Path, at: FrameStart) -> Result<Self, JournalError> {
        let lines = Lines::of(bytes, path, at).map_err(|error| read_error(path, &error))?;
        Ok(Self {
            lines,
            path: path.to_owned(),
            text: Vec::new(),
            pace: Pace::default(),
            is_verbatim: false,
            bytes: 0,
            line: 0,
            ended: false,
            truncated: None,
            unended_bytes: 0,
        })
    }

    /// Reads the next event with the bytes of its line; `None` at the end.
    ///
    /// # Errors
    /// See [`JournalError`]; a last line that is cut off is not an error.
    pub fn next_line(&mut self) -> Result<Option<JournalLine<'_>>, JournalError> {
        if self.ended {
            return Ok(None);
        }
        match self.read_event() {
            Ok(event) => {
                let raw = self.text.strip_suffix(b"\n").unwrap_or(&self.text);
                Ok(event.map(|event| JournalLine { raw, event }))
            }
            Err(error) => {
                self.ended = true;
                Err(error)
            }
        }
    }
    /// After the end: a text about what is missing, if the journal is empty or its last line is cut off.
    pub fn truncated(&self) -> Option<&str> {
        self.truncated.as_deref()
    }

    /// The error for a caller that needs the opening of the run, if the journal ends before the opening.
    pub fn not_opened(&self) -> JournalError {
        JournalError::NotOpened { path: self.path.clone() }
    }

    /// After the end: number of bytes after the last newline; 0 in a complete journal.
    ///
    /// These bytes may be a complete event that lacks only its newline; such an event is read like any other.
    pub fn unended_bytes(&self) -> u64 {
        self.unended_bytes
    }

    fn read_event(&mut self) -> Result<Option<Event>, JournalError> {
        self.text.clear();
        self.line += 1;
        // Memory used by one long line is freed.
        self.text.shrink_to(1 << 20);
        let mut line = self.lines.text().take(MOST_LINE_BYTES as u64 + 1);
        let read = line.read_until(b'\n', &mut self.text);
        let length = read.map_err(|error| self.unreadable(&error))?;
        if length > MOST_LINE_BYTES {
            return Err(self.damaged(1, limits::too_long()));
        }
        self.bytes += length as u64;
        if length == 0 {
            return Ok(self.end_of_file());
        }
        let whole = self.text.last() == Some(&b'\n');
        if !whole {
            self.cut_off(length);
        }
        match self.parse() {
            Ok(event) => Ok(Some(event)),
            Err(error @ JournalError::OtherVersion { .. }) => Err(error),
            Err(_) if !whole => Ok(None),
            Err(error) => Err(error),
        }
    }

    fn end_of_file(&mut self) -> Option<Event> {
        self.ended = true;
        if self.line == 1 {
            self.truncated = Some("the journal is empty".into());
        }
        None
    }

    fn cut_off(&mut self, length: usize) {
        self.ended = true;
        self.unended_bytes = length as u64;
        self.truncated = Some(format!("line {}, the last one, is cut off after {length} bytes", self.line));
    }

    fn parse(&mut self) -> Result<Event, JournalError> {
        if self.line == 1 {
            self.check_head()?;
        }
        let plain = if self.is_verbatim { None } else { plain::line(&self.text) };
        let text = plain.as_deref().unwrap_or(&self.text);
        let quick = if limits::is_bearable(text) { fast::event(text) } else { None };
        let mut event = match quick {
            Some(event) => event,
            None if !limits::is_light(text) => {
                return Err(self.damaged(1, "the line contains more values than any event does".to_owned()));
            }
            None => serde_json::from_slice(text)
                .map_err(|error| self.damaged(error.column().max(1), without_position(&error)))?,
        };
        if let (EventKind::RunOpened(run), true) = (&mut event.kind, plain.is_some()) {
            run.scenario_toml = self.scenario_as_written().unwrap_or_default();
        }
        self.pace.take(&event, self.text.len()).map_err(|why| self.damaged(1, why))?;
        Ok(event)
    }

    /// The text of the scenario, which is verified by its digest.
    fn scenario_as_written(&self) -> Option<String> {
        #[derive(Deserialize)]
        struct Written {
            scenario_toml: String,
        }
        serde_json::from_slice::<Written>(&self.text).ok().map(|written| written.scenario_toml)
    }

    fn damaged(&self, column: usize, why: String) -> JournalError {
        JournalError::Damaged { line: self.line, column, why, path: self.path.clone() }
    }

    fn unreadable(&self, error: &io::Error) -> JournalError {
        if error.kind() == io::ErrorKind::InvalidData {
            return self.damaged(1, error.to_string());
        }
        read_error(&self.path, error)
    }

    /// Checks that the first line opens a run, in the version that this program reads.
    fn check_head(&self) -> Result<(), JournalError> {
        let refuse = |why| JournalError::NotAJournal { why, path: self.path.clone() };
        let head: Head =
            serde_json::from_slice(&self.text).map_err(|error| refuse(without_position(&error)))?;
        if head.event != "run_opened" {
            return Err(refuse(format!("the first event is {}", head.event)));
        }
        let (theirs, ours) = (head.journal_version, JOURNAL_VERSION);
        if theirs != ours {
            return Err(JournalError::OtherVersion { theirs, ours, path: self.path.clone() });
        }
        Ok(())
    }
}

impl Iterator for JournalReader {
    type Item = Result<Event, JournalError>;

    fn next(&mut self) -> Option<Self::Item> {
        self.next_line().map(|line| line.map(|line| line.event)).transpose()
    }
}

/// The parser's message without its "at line 1 column 7": to the parser, every line is a separate document.
fn without_position(error: &serde_json::Error) -> String {
    let text = error.to_string();
    text.split_once(" at line ").map_or(text.clone(), |(sentence, _)| sentence.to_owned())
}

/// A place in a file for which the number of earlier lines is not known.
fn place_in(file: u64) -> JournalPlace {
    JournalPlace { frame: FrameStart { file, content: 0 }, bytes: 0, lines: usize::from(file > 0) }
}

fn read_error(path: &Path, error: &io::Error) -> JournalError {
    JournalError::Read { why: error.to_string(), path: path.to_owned() }
}
