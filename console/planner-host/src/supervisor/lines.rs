//! Splits the output of a process into human-readable lines.

use foreign::plain;

/// The maximum number of lines kept until they are collected, enough for a panic's backtrace. Any further lines are
/// only counted.
const MOST: usize = 256;
/// The maximum length of a line, bytes.
const LONGEST: usize = 400;
/// The mark at the end of a line that was shortened.
const CUT: &[u8] = b" (rest of the line dropped)";

/// Lines that were printed but not yet collected.
#[derive(Debug, Default)]
pub(super) struct Lines {
    partial: Vec<u8>,
    /// Whether the current line was shortened; if so, its remaining bytes are ignored.
    is_cut: bool,
    whole: Vec<String>,
    n_dropped: usize,
}

impl Lines {
    /// Adds output.
    pub(super) fn extend(&mut self, bytes: &[u8]) {
        for byte in bytes {
            match byte {
                b'\n' => self.end_line(),
                _ if self.is_cut => {}
                _ if self.partial.len() < LONGEST => self.partial.push(*byte),
                _ => self.cut_line(),
            }
        }
    }

    /// Shortens a line that is too long, because it might never end.
    fn cut_line(&mut self) {
        self.partial.extend_from_slice(CUT);
        self.end_line();
        self.is_cut = true;
    }

    fn end_line(&mut self) {
        if std::mem::take(&mut self.is_cut) {
            return;
        }
        let text = plain(&String::from_utf8_lossy(&self.partial)).into_owned();
        self.partial.clear();
        if self.whole.len() < MOST {
            self.whole.push(text);
        } else {
            self.n_dropped += 1;
        }
    }

    /// Takes the lines since the last call.
    pub(super) fn take(&mut self) -> Vec<String> {
        let dropped = std::mem::take(&mut self.n_dropped);
        let mut lines = std::mem::take(&mut self.whole);
        if dropped > 0 {
            lines.push(format!("(lines dropped here: {dropped})"));
        }
        lines
    }

    /// Takes the lines since the last call, including an unfinished line. Use this when the process can print no more.
    pub(super) fn take_rest(&mut self) -> Vec<String> {
        if !self.partial.is_empty() {
            self.end_line();
        }
        self.take()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_whole_and_without_escapes() {
        let mut lines = Lines::default();
        lines.extend(b"one\ntw\x1b[31mo");
        assert_eq!(lines.take(), ["one"]);
        lines.extend(b"\nthr");
        assert_eq!(lines.take(), ["tw\u{fffd}[31mo"]);
        assert_eq!((lines.take_rest(), lines.take_rest()), (vec!["thr".to_owned()], vec![]));
    }

    #[test]
    fn a_flood_is_counted_and_not_kept() {
        let mut lines = Lines::default();
        lines.extend(&b"x\n".repeat(MOST + 3));
        let taken = lines.take();
        assert_eq!((taken.len(), taken[MOST].as_str()), (MOST + 1, "(lines dropped here: 3)"));
        lines.extend(&[b'x'; 10 * LONGEST]);
        let cut = lines.take_rest();
        assert_eq!((cut.len(), cut[0].len()), (1, LONGEST + CUT.len()), "without its end");
        lines.extend(b"xxx\nnext\n");
        assert_eq!(lines.take(), ["next"], "its rest is skipped");
    }
}
