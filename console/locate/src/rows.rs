//! Reads a file as rows of cells, one at a time.

mod encoding;
mod messages;
mod text;

use crate::problem::Problem;
use csv::StringRecord;
use foreign::open_regular;
use messages::Messages;
use std::{
    fs::File,
    io::{self, BufRead, BufReader, Read, Seek},
    path::{Path, PathBuf},
};
use text::Text;

/// The first bytes of an MCAP file.
const MCAP: &[u8; 8] = b"\x89MCAP0\r\n";

/// A file that is read as rows.
#[allow(clippy::large_enum_variant, reason = "there is only one, for a whole file")]
pub(crate) enum Rows {
    /// Text; its first line names the columns.
    Csv { reader: csv::Reader<BufReader<Text>>, header: StringRecord, has_commas: bool, file: PathBuf },
    /// Messages that are JSON objects; their keys name the columns.
    Messages(Box<Messages>),
}

impl Rows {
    /// Opens a file: as MCAP by its content or the suffix `.mcap`, otherwise as text.
    ///
    /// # Errors
    /// The file cannot be read, or has no column names.
    pub(crate) fn open(file: &Path) -> Result<Self, String> {
        let mut opened = open_regular(file).map_err(|error| error.to_string())?;
        let mut magic = [0; MCAP.len()];
        let is_mcap = opened.read_exact(&mut magic).is_ok() && magic == *MCAP;
        opened.rewind().map_err(|error| error.to_string())?;
        if is_mcap || file.extension().is_some_and(|suffix| suffix.eq_ignore_ascii_case("mcap")) {
            return Ok(Self::Messages(Box::new(Messages::open(opened)?)));
        }
        Self::text(opened, file)
    }

    fn text(opened: File, path: &Path) -> Result<Self, String> {
        if let Some(wide) = encoding::wide(path) {
            return Err(wide);
        }
        let mut text = BufReader::with_capacity(1 << 16, Text::new(opened));
        let (delimiter, skip) = delimiter(&mut text).map_err(|error| error.to_string())?;
        let mut file = text.into_inner().into_file();
        file.seek(io::SeekFrom::Start(skip)).map_err(|error| error.to_string())?;
        let mut reader = csv::ReaderBuilder::new()
            .delimiter(delimiter)
            .comment(Some(b'#'))
            .trim(csv::Trim::All)
            .from_reader(BufReader::with_capacity(1 << 16, Text::new(file)));
        let header = match reader.headers() {
            Ok(header) => header.clone(),
            Err(error) => return Err(of_csv(&error, line_of(&reader), path).to_string()),
        };
        if header.is_empty() {
            return Err("empty; the first line must name the columns".into());
        }
        Ok(Self::Csv { reader, header, has_commas: delimiter != b',', file: path.to_owned() })
    }

    /// The names of the columns.
    pub(crate) fn header(&self) -> &StringRecord {
        match self {
            Self::Csv { header, .. } => header,
            Self::Messages(messages) => messages.header(),
        }
    }

    /// Whether numbers may have a decimal comma.
    pub(crate) fn has_commas(&self) -> bool {
        matches!(self, Self::Csv { has_commas: true, .. })
    }

    /// Reads the next row into `cells`; returns its line, or `None` at the end.
    ///
    /// # Errors
    /// The problem with the row. Unless [`Problem::is_end`] is true, the next row can still be read.
    pub(crate) fn next(&mut self, cells: &mut StringRecord) -> Result<Option<u64>, Problem> {
        match self {
            Self::Csv { reader, file, .. } => match reader.read_record(cells) {
                Ok(true) => Ok(Some(line_of(reader) - lines_within(cells))),
                Ok(false) => Ok(None),
                Err(error) => Err(of_csv(&error, line_of(reader), file)),
            },
            Self::Messages(messages) => messages.next(cells),
        }
    }
}

/// Returns the line that a reader has reached. After comments and empty lines, it is not known where a record began.
fn line_of(reader: &csv::Reader<BufReader<Text>>) -> u64 {
    reader.position().line().saturating_sub(1).max(1)
}

/// Counts the line breaks in quoted cells.
fn lines_within(cells: &StringRecord) -> u64 {
    cells.as_slice().bytes().filter(|byte| *byte == b'\n').count() as u64
}

fn of_csv(error: &csv::Error, line: u64, file: &Path) -> Problem {
    let is_end = matches!(error.kind(), csv::ErrorKind::Io(_));
    let what = match error.kind() {
        csv::ErrorKind::UnequalLengths { expected_len, len, .. } => {
            format!("{len} cell{}; the first line has {expected_len}", if *len == 1 { "" } else { "s" })
        }
        csv::ErrorKind::Utf8 { .. } => encoding::narrow(file, line),
        csv::ErrorKind::Io(error) => error.to_string(),
        _ => error.to_string(),
    };
    Problem { line, column: None, what, is_end }
}

/// Finds the separator of the cells, and the length of a byte order mark before the first one, bytes.
fn delimiter(text: &mut BufReader<Text>) -> io::Result<(u8, u64)> {
    let bytes = text.fill_buf()?;
    let skip = if bytes.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
    let mut lines = bytes[skip..].split(|byte| *byte == b'\n');
    let names = lines.find(|line| !line.starts_with(b"#")).unwrap_or_default();
    let delimiter = [b';', b'\t'].into_iter().find(|delimiter| names.contains(delimiter)).unwrap_or(b',');
    Ok((delimiter, skip as u64))
}
