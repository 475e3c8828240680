//! A character of several bytes.

/// The bytes of a character so far.
#[derive(Debug, Clone, Copy)]
pub(super) struct Utf8 {
    bytes: [u8; 4],
    seen: usize,
    length: usize,
}

/// Bytes of the right number that are not a character.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct NotACharacter;

impl Utf8 {
    /// Begins a character; `None` if no character begins with this byte.
    pub(super) fn begin(byte: u8) -> Option<Self> {
        let length = match byte {
            0xc2..=0xdf => 2,
            0xe0..=0xef => 3,
            0xf0..=0xf4 => 4,
            _ => return None,
        };
        Some(Self { bytes: [byte, 0, 0, 0], seen: 1, length })
    }

    /// Takes a continuation byte, 0x80 to 0xbf; returns the character once it is complete.
    pub(super) fn take(&mut self, byte: u8) -> Option<Result<char, NotACharacter>> {
        self.bytes[self.seen] = byte;
        self.seen += 1;
        if self.seen < self.length {
            return None;
        }
        let text = std::str::from_utf8(&self.bytes[..self.length]).ok();
        Some(text.and_then(|text| text.chars().next()).ok_or(NotACharacter))
    }
}
