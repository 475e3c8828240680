//! Control strings: long answers of the terminal, which are swallowed.

/// Maximum number of bytes kept of a string: enough for the answer about the background.
const KEPT: usize = 48;
/// A string longer than this, in bytes, is taken to be broken off.
const LONGEST: usize = 1 << 20;

/// A control string: OSC, DCS, SOS, PM or APC.
#[derive(Debug)]
pub(super) struct ControlString {
    is_osc: bool,
    kept: Vec<u8>,
    length: usize,
    /// The number of bytes of the current character that are still missing; within a character, 0x9c does
    /// not end the string.
    continues: u8,
}

/// What a byte means for a string.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Next {
    /// The string continues.
    More,
    /// The string ends if a backslash follows.
    Escape,
    /// The string has ended.
    End,
}

impl ControlString {
    /// Begins the string that is introduced by Esc and this byte.
    pub(super) fn begin(introducer: u8) -> Self {
        Self { is_osc: introducer == b']', kept: Vec::new(), length: 0, continues: 0 }
    }

    #[cfg(test)]
    pub(super) fn kept(&self) -> usize {
        self.kept.len()
    }

    pub(super) fn take(&mut self, byte: u8) -> Next {
        self.length += 1;
        let is_continuation = (0x80..=0xbf).contains(&byte) && self.continues > 0;
        match byte {
            0x1b => return Next::Escape,
            0x07 => return Next::End,
            0x9c if !is_continuation => return Next::End,
            _ if self.length > LONGEST => return Next::End,
            _ => {}
        }
        self.continues = match byte {
            _ if is_continuation => self.continues - 1,
            0xc2..=0xdf => 1,
            0xe0..=0xef => 2,
            0xf0..=0xf4 => 3,
            _ => 0,
        };
        if self.kept.len() < KEPT {
            self.kept.push(byte);
        }
        Next::More
    }

    /// The background colour, if the string is the answer to OSC 11: red, green and blue.
    pub(super) fn background(&self) -> Option<[u8; 3]> {
        let text = std::str::from_utf8(&self.kept).ok().filter(|_| self.is_osc)?;
        let colour = text.strip_prefix("11;")?;
        if let Some(hex) = colour.strip_prefix('#') {
            let digits = hex.len() / 3;
            let part = |at: usize| hex.get(at * digits..(at + 1) * digits).and_then(level);
            return Some([part(0)?, part(1)?, part(2)?]).filter(|_| hex.len() % 3 == 0);
        }
        let parts = colour.strip_prefix("rgb:").or_else(|| colour.strip_prefix("rgba:"))?;
        let mut parts = parts.split('/').map(level);
        Some([parts.next()??, parts.next()??, parts.next()??])
    }
}

/// A level of one to four hexadecimal digits, from 0 to 255.
fn level(digits: &str) -> Option<u8> {
    let most = match digits.len() {
        length @ 1..=4 => (1_u32 << (4 * length)) - 1,
        _ => return None,
    };
    let value = u32::from_str_radix(digits, 16).ok()?;
    u8::try_from((value * 255 + most / 2) / most).ok()
}
