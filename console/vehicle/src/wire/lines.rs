//! Splits bytes into lines, however the bytes are divided, within a fixed amount of memory.

use super::LINE_MAX;

/// A part of the stream.
#[derive(Debug, PartialEq)]
pub(super) enum Piece<'a> {
    /// A line without its line feed.
    Line(&'a [u8]),
    /// [`LINE_MAX`] bytes and more without a line feed; they are dropped, as is the rest of that line.
    Overlong,
}

/// Splits a stream into lines.
#[derive(Debug, Clone, Default)]
pub(super) struct Lines {
    /// The beginning of a line that has not ended yet.
    rest: Vec<u8>,
    /// Whether the current line was too long, so that its rest is dropped.
    dropping: bool,
    /// Bytes dropped since the last time that [`Piece::Overlong`] was reported.
    dropped: usize,
}

impl Lines {
    /// Takes the next bytes, and hands out the lines that are complete.
    pub(super) fn take(&mut self, bytes: &[u8], mut each: impl FnMut(Piece)) {
        let mut parts = bytes.split(|byte| *byte == b'\n').peekable();
        while let Some(part) = parts.next() {
            self.append(part, &mut each);
            if parts.peek().is_some() {
                self.end(&mut each);
            }
        }
    }

    fn append(&mut self, part: &[u8], each: &mut impl FnMut(Piece)) {
        if !self.dropping && self.rest.len() + part.len() > LINE_MAX {
            self.dropping = true;
            self.dropped = self.rest.len();
            self.rest.clear();
            each(Piece::Overlong);
            // The bytes up to the limit are part of what was just reported.
            self.dropped += part.len();
            self.dropped -= LINE_MAX.min(self.dropped);
        } else if self.dropping {
            self.dropped += part.len();
        } else {
            self.rest.extend_from_slice(part);
        }
        while self.dropped >= LINE_MAX {
            self.dropped -= LINE_MAX;
            each(Piece::Overlong);
        }
    }

    fn end(&mut self, each: &mut impl FnMut(Piece)) {
        if !std::mem::take(&mut self.dropping) {
            each(Piece::Line(&self.rest));
        }
        self.dropped = 0;
        self.rest.clear();
    }

    /// The beginning of a line that has not ended yet.
    pub(super) fn unfinished(&self) -> Option<&[u8]> {
        (!self.rest.trim_ascii().is_empty()).then_some(&*self.rest)
    }

    /// Ends the stream: returns the line that was not ended.
    pub(super) fn finish(&mut self) -> Option<Vec<u8>> {
        let rest = std::mem::take(self).rest;
        (!rest.is_empty()).then_some(rest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn told(chunks: &[&[u8]]) -> Vec<String> {
        let mut lines = Lines::default();
        let mut told = Vec::new();
        for chunk in chunks {
            lines.take(chunk, |piece| {
                told.push(match piece {
                    Piece::Line(line) => String::from_utf8_lossy(line).into_owned(),
                    Piece::Overlong => "OVERLONG".into(),
                });
            });
            assert!(lines.rest.len() <= LINE_MAX);
        }
        told
    }

    #[test]
    fn lines_are_put_together_from_any_parts() {
        assert_eq!(told(&[b"ab", b"c\nd\n\ne", b"f"]), ["abc", "d", ""]);
        let longest = "x".repeat(LINE_MAX);
        assert_eq!(told(&[longest.as_bytes(), b"\nb\n"]), [longest.as_str(), "b"]);
    }

    #[test]
    fn a_line_that_is_too_long_is_dropped_and_the_next_one_is_read() {
        let long = vec![b'x'; LINE_MAX + 1];
        assert_eq!(told(&[&long, b"rest\nb\n"]), ["OVERLONG", "b"]);
        assert_eq!(told(&[b"y", &long[..LINE_MAX], b"\nb\n"]), ["OVERLONG", "b"]);
    }

    #[test]
    fn an_endless_line_is_reported_again_and_again() {
        let chunk = vec![b'x'; 64 * 1024];
        let chunks: Vec<&[u8]> = std::iter::repeat_n(&chunk[..], 160).collect();
        assert_eq!(told(&chunks).len(), 40);
    }
}
