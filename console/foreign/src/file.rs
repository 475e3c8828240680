//! Files read within limits.

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

/// A text that is read whole is no longer than this where nothing smaller is asked for, bytes.
pub const MOST_TEXT_BYTES: u64 = 64 << 20;

/// Opens a regular file: a device or a pipe may never end. Never waits for the other end of a pipe.
///
/// # Errors
/// It is not a regular file, has holes (its length costs nothing, and no file that is written here has any), or cannot be opened.
pub fn open_regular(path: &Path) -> io::Result<File> {
    let file = OpenOptions::new().read(true).custom_flags(OFlags::NONBLOCK.bits() as i32).open(path)?;
    let about = file.metadata()?;
    if !about.is_file() {
        return Err(io::Error::new(ErrorKind::InvalidInput, "it is not a regular file"));
    }
    // Where the system cannot tell, the end of the file is the first hole.
    let first_hole = seek(&file, SeekFrom::Hole(0)).unwrap_or(about.len());
    seek(&file, SeekFrom::Start(0))?;
    if first_hole < about.len() {
        return Err(damaged(format!(
            "it is damaged: {} bytes long, and has a hole from byte {first_hole} on, where nothing was ever written",
            about.len()
        )));
    }
    Ok(file)
}

/// Opens a file that may be a pipe; then waits until its other end has written something or is closed.
///
/// Who wrote and left already is not missed, as long as somebody else keeps the pipe open.
///
/// # Errors
/// It cannot be opened.
pub fn open_waiting(path: &Path) -> io::Result<File> {
    let file =
        OpenOptions::new().read(true).custom_flags(OFlags::NONBLOCK.bits().cast_signed()).open(path)?;
    if file.metadata()?.file_type().is_fifo() {
        while poll(&mut [PollFd::new(&file, PollFlags::IN)], None) == Err(Errno::INTR) {}
    }
    fcntl_setfl(&file, fcntl_getfl(&file)? - OFlags::NONBLOCK)?;
    Ok(file)
}

/// The text of a regular file of at most [`MOST_TEXT_BYTES`].
///
/// # Errors
/// See [`read_at_most`].
pub fn read_regular(path: &Path) -> io::Result<String> {
    read_at_most(path, MOST_TEXT_BYTES)
}

/// The text of a regular file, which may not exceed `most_bytes`.
///
/// # Errors
/// It is not a regular file, is longer, cannot be read, or is not UTF-8.
pub fn read_at_most(path: &Path, most_bytes: u64) -> io::Result<String> {
    let file = open_regular(path)?;
    let length = file.metadata()?.len();
    if length > most_bytes {
        return Err(damaged(format!("it has {length} bytes, and at most {most_bytes} are read")));
    }
    // It may grow meanwhile.
    text_of(file, most_bytes)
}

/// The whole text of a reader, which may not exceed `most_bytes`.
///
/// # Errors
/// It gives more, cannot be read, or is not UTF-8: what it is instead, and what to do about it.
pub fn text_of(reader: impl Read, most_bytes: u64) -> io::Result<String> {
    let mut bytes = Vec::new();
    reader.take(most_bytes + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > most_bytes {
        return Err(damaged(format!("it has more than {most_bytes} bytes, which are not read")));
    }
    if let Some(other) = NotUtf8::of(&bytes) {
        return Err(damaged(format!("{other}; {}", other.remedy())));
    }
    String::from_utf8(bytes).map_err(|error| damaged(error.to_string()))
}

/// The text of a regular JSON file, which may not exceed `most_bytes`, nor a small multiple of that in memory.
///
/// # Errors
/// See [`read_at_most`]; it holds too many values.
pub fn read_json(path: &Path, most_bytes: u64) -> io::Result<String> {
    let text = read_at_most(path, most_bytes)?;
    if json_weight(text.as_bytes()) as u64 > MOST_GROWTH * most_bytes {
        return Err(damaged("it holds more values than any such file does".to_owned()));
    }
    Ok(text)
}

/// What a JSON file may weigh, as a multiple of its greatest length.
const MOST_GROWTH: u64 = 8;
/// What a number, word or key takes in memory as any value, and what a list or an object does, bytes.
const VALUE_BYTES: usize = 32;
const LIST_BYTES: usize = 176;

/// At most what the values of a JSON text take in memory when it is read as any value, bytes; signs within its texts count, too.
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

        // Kept open by somebody, as whoever waits for it does.
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
        assert_eq!(refused, "it has 8 bytes, and at most 7 are read");
        fs::write(&path, b"ab\nGr\xfcn").unwrap();
        let refused = read_regular(&path).unwrap_err().to_string();
        assert!(
            refused.starts_with("not UTF-8 but ISO-8859-1, by line 2; save it as UTF-8: `iconv"),
            "{refused}"
        );
    }
}
