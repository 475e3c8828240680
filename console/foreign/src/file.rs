//! Reads files within limits.

use crate::NotUtf8;
use rustix::{
    event::{PollFd, PollFlags, poll},
    fs::{OFlags, SeekFrom, fcntl_getfl, fcntl_setfl, seek},
    io::Errno,
};
use std::{
    fs::{File, OpenOptions},
    io::{self, ErrorKind, Read},
    os::unix::fs::{FileTypeExt, OpenOptionsExt},
    path::Path,
};

/// The greatest length of a text that is read in one piece, unless a smaller limit is given, bytes.
pub const MOST_TEXT_BYTES: u64 = 64 << 20;

/// Opens a regular file, and refuses devices and pipes, which may never end. Never waits for the other end of a pipe.
///
/// # Errors
/// The file is not regular, cannot be opened, or is sparse. A hole costs no disk space, so the length of a sparse
/// file means nothing; no file written by this project has holes.
pub fn open_regular(path: &Path) -> io::Result<File> {
    let file = OpenOptions::new().read(true).custom_flags(OFlags::NONBLOCK.bits() as i32).open(path)?;
    let about = file.metadata()?;
    if !about.is_file() {
        return Err(io::Error::new(ErrorKind::InvalidInput, "it is not a regular file"));
    }
    // Where the system does not report holes, the end of the file counts as the first hole.
    let first_hole = seek(&file, SeekFrom::Hole(0)).unwrap_or(about.len());
    seek(&file, SeekFrom::Start(0))?;
    if first_hole < about.len() {
        return Err(damaged(format!(
            "it is damaged: {} bytes long, with a hole at byte {first_hole} that was never written",
            about.len()
        )));
    }
    Ok(file)
}

/// Opens a file that may be a pipe. For a pipe, waits until the other end has written something or is closed.
///
/// Data from a writer that has already closed its end is not lost while another process keeps the pipe open.
///
/// # Errors
/// The file cannot be opened.
pub fn open_waiting(path: &Path) -> io::Result<File> {
    let file =
        OpenOptions::new().read(true).custom_flags(OFlags::NONBLOCK.bits().cast_signed()).open(path)?;
    let kind = file.metadata()?.file_type();
    if kind.is_file() {
        // A file of the system, such as the kernel's log, might wait for data forever.
        return Ok(file);
    }
    if kind.is_fifo() {
        while poll(&mut [PollFd::new(&file, PollFlags::IN)], None) == Err(Errno::INTR) {}
    }
    fcntl_setfl(&file, fcntl_getfl(&file)? - OFlags::NONBLOCK)?;
    Ok(file)
}

/// Reads the text of a regular file of at most [`MOST_TEXT_BYTES`].
///
/// # Errors
/// See [`read_at_most`].
pub fn read_regular(path: &Path) -> io::Result<String> {
    read_at_most(path, MOST_TEXT_BYTES)
}

/// Reads the text of a regular file of at most `most_bytes`.
///
/// # Errors
/// The file is not regular, is too long, cannot be read, or is not UTF-8.
pub fn read_at_most(path: &Path, most_bytes: u64) -> io::Result<String> {
    let file = open_regular(path)?;
    let length = file.metadata()?.len();
    if length > most_bytes {
        return Err(damaged(format!("it is {length} bytes long; the limit is {most_bytes}")));
    }
    // The file may grow while it is read.
    text_of(file, most_bytes)
}

/// Reads the whole text from a reader, at most `most_bytes`.
///
/// # Errors
/// The reader returns too many bytes, cannot be read, or is not UTF-8. In the last case the message names the
/// encoding and says what to do about it.
pub fn text_of(reader: impl Read, most_bytes: u64) -> io::Result<String> {
    let mut bytes = Vec::new();
    reader.take(most_bytes + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > most_bytes {
        return Err(damaged(format!("it is longer than the limit of {most_bytes} bytes")));
    }
    if let Some(other) = NotUtf8::of(&bytes) {
        return Err(damaged(format!("{other}; {}", other.remedy())));
    }
    String::from_utf8(bytes).map_err(|error| damaged(error.to_string()))
}

/// Reads the text of a regular JSON file of at most `most_bytes`. The memory that the values of the file need is
/// limited to a small multiple of `most_bytes`.
///
/// # Errors
/// See [`read_at_most`]; also if the file holds too many values.
pub fn read_json(path: &Path, most_bytes: u64) -> io::Result<String> {
    let text = read_at_most(path, most_bytes)?;
    if json_weight(text.as_bytes()) as u64 > MOST_GROWTH * most_bytes {
        return Err(damaged("it holds more values than any valid file of this kind".to_owned()));
    }
    Ok(text)
}

/// The greatest weight of a JSON file, as a multiple of its greatest length.
const MOST_GROWTH: u64 = 8;
/// The memory, in bytes, that a generic JSON value takes for a number, a word or a key, and for a list or an object.
const VALUE_BYTES: usize = 32;
const LIST_BYTES: usize = 176;

/// Returns an upper bound for the memory that the values of a JSON text take when it is read as a generic JSON value,
/// bytes. Commas, colons and brackets inside strings are counted, too.
pub fn json_weight(text: &[u8]) -> usize {
    let weight = |byte: &u8| match byte {
        b',' | b':' => VALUE_BYTES,
        b'[' | b'{' => LIST_BYTES,
        _ => 0,
    };
    text.len() + text.iter().map(weight).sum::<usize>()
}

fn damaged(what: String) -> io::Error {
    io::Error::new(ErrorKind::InvalidData, what)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]

    use super::*;
    use std::{fs, process::Command};

    #[test]
    fn a_pipe_a_device_and_a_folder_are_refused_at_once() {
        let folder = tempfile::tempdir().unwrap();
        let pipe = folder.path().join("pipe");
        assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
        for path in [pipe.as_path(), Path::new("/dev/zero"), folder.path()] {
            let refused = open_regular(path).unwrap_err().to_string();
            assert_eq!(refused, "it is not a regular file", "{}", path.display());
        }
    }

    #[test]
    fn a_pipe_is_waited_for_and_what_was_written_before_is_read() {
        let folder = tempfile::tempdir().unwrap();
        let pipe = folder.path().join("pipe");
        assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
        let late = std::thread::spawn({
            let pipe = pipe.clone();
            move || fs::write(pipe, "late").unwrap()
        });
        assert_eq!(text_of(open_waiting(&pipe).unwrap(), 100).unwrap(), "late");
        late.join().unwrap();

        // Another process keeps the pipe open, as a process that waits for the pipe does.
        let kept =
            OpenOptions::new().read(true).custom_flags(OFlags::NONBLOCK.bits() as i32).open(&pipe).unwrap();
        fs::write(&pipe, "early").unwrap();
        assert_eq!(text_of(open_waiting(&pipe).unwrap(), 100).unwrap(), "early");
        drop(kept);
        fs::write(folder.path().join("file"), "regular").unwrap();
        assert_eq!(text_of(open_waiting(&folder.path().join("file")).unwrap(), 100).unwrap(), "regular");
    }

    #[test]
    fn a_sparse_file_is_refused_whatever_its_length() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("sparse");
        fs::write(&path, [b'x'; 8192]).unwrap();
        assert!(open_regular(&path).is_ok());
        OpenOptions::new().write(true).open(&path).unwrap().set_len(1 << 40).unwrap();
        let refused = open_regular(&path).unwrap_err().to_string();
        assert!(refused.contains("1099511627776 bytes long") && refused.contains("a hole"), "{refused}");
    }

    #[test]
    fn json_of_many_small_lists_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.json");
        fs::write(&path, format!("[{}0]", r#"{"name": "a", "area_m2": 1.25},"#.repeat(1000))).unwrap();
        assert!(read_json(&path, 1 << 16).is_ok());
        fs::write(&path, format!("[{}0]", "[],".repeat(10_000))).unwrap();
        assert!(read_json(&path, 1 << 16).unwrap_err().to_string().contains("more values"));
        assert_eq!(json_weight(b"[1,2]"), 5 + 176 + 32);
    }

    #[test]
    fn no_more_is_read_than_is_asked_for() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("text");
        fs::write(&path, "12345678").unwrap();
        assert_eq!(read_at_most(&path, 8).unwrap(), "12345678");
        let refused = read_at_most(&path, 7).unwrap_err().to_string();
        assert_eq!(refused, "it is 8 bytes long; the limit is 7");
        fs::write(&path, b"ab\nGr\xfcn").unwrap();
        let refused = read_regular(&path).unwrap_err().to_string();
        assert!(
            refused.starts_with("ISO-8859-1 instead of UTF-8, judging by line 2; save it as UTF-8: `iconv"),
            "{refused}"
        );
    }
}
