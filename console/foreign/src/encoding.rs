//! Detects the encoding of a text that should be UTF-8 but is not, and suggests what to do about it.

/// The number of bytes at the start of a text that are examined for an encoding with two bytes per character.
const BEGINNING: usize = 2000;

/// Returns the name of a two-byte encoding without a byte order mark, recognised by the zero bytes of Latin letters.
pub fn wide(bytes: &[u8]) -> Option<&'static str> {
    let head = &bytes[..bytes.len().min(BEGINNING) / 2 * 2];
    let zeros = |odd: usize| head.iter().skip(odd).step_by(2).filter(|byte| **byte == 0).count();
    let most = head.len() / 4;
    match (zeros(0), zeros(1)) {
        (0, odd) if odd > most => Some("UTF-16LE"),
        (even, 0) if even > most => Some("UTF-16BE"),
        _ => None,
    }
}

/// A text that should be UTF-8 but is not.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NotUtf8 {
    /// The line with the first byte that is not valid UTF-8, counted from 1.
    pub line: usize,
    /// The encoding that was recognised, under its `iconv` name; `None` if the bytes do not seem to be text.
    pub encoding: Option<&'static str>,
}

impl NotUtf8 {
    /// Finds the reason why bytes are not UTF-8: an invalid byte, or signs of a different encoding. Returns `None` if
    /// they are plain UTF-8.
    ///
    /// ```
    /// use foreign::NotUtf8;
    /// assert_eq!(NotUtf8::of("name = \"Öl\"".as_bytes()), None);
    /// let latin = NotUtf8::of(b"# 1\nname = \"\xd6l\"").unwrap();
    /// assert_eq!((latin.line, latin.encoding), (2, Some("ISO-8859-1")));
    /// ```
    pub fn of(bytes: &[u8]) -> Option<Self> {
        let of_whole = |encoding| Some(Self { line: 1, encoding: Some(encoding) });
        match bytes {
            [0xff, 0xfe, 0, 0, ..] | [0, 0, 0xfe, 0xff, ..] => return of_whole("UTF-32"),
            [0xff, 0xfe, ..] | [0xfe, 0xff, ..] => return of_whole("UTF-16"),
            _ => {}
        }
        if let Some(encoding) = wide(bytes) {
            return of_whole(encoding);
        }
        let at = std::str::from_utf8(bytes).err()?.valid_up_to();
        let line = bytes[..at].split(|byte| *byte == b'\n').count();
        let is_control = |byte: &u8| *byte < 0x20 && !b"\t\r\n\x0c".contains(byte);
        let encoding = match bytes {
            _ if bytes.iter().any(is_control) => None,
            // Only Windows encodings have letters and signs in this range.
            _ if bytes.iter().any(|byte| (0x80..0xa0).contains(byte)) => Some("WINDOWS-1252"),
            _ => Some("ISO-8859-1"),
        };
        Some(Self { line, encoding })
    }

    /// Returns the advice for the user.
    pub fn remedy(&self) -> String {
        match self.encoding {
            Some(encoding) => format!("save it as UTF-8: `iconv -f {encoding} -t UTF-8 FILE > NEW`"),
            None => "the file does not seem to be text; is this the right file?".into(),
        }
    }
}

impl std::fmt::Display for NotUtf8 {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match (self.encoding, self.line) {
            (Some(encoding), 1) => write!(f, "{encoding} instead of UTF-8, judging by the first line"),
            (Some(encoding), line) => write!(f, "{encoding} instead of UTF-8, judging by line {line}"),
            (None, line) => write!(f, "not text: line {line} is not UTF-8"),
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]

    use super::*;

    fn wide_text(text: &str, bytes: fn(u16) -> [u8; 2], mark: &[u8]) -> Vec<u8> {
        mark.iter().copied().chain(text.encode_utf16().flat_map(bytes)).collect()
    }

    #[test]
    fn an_encoding_is_recognised_with_its_line() {
        let told = |bytes: &[u8]| NotUtf8::of(bytes).map(|foreign| foreign.to_string());
        let text = "# a\n# b\nname = \"Öl\"\n";
        assert_eq!(told(text.as_bytes()), None);
        assert_eq!(told(&[b"\xef\xbb\xbf", text.as_bytes()].concat()), None);
        let latin: Vec<u8> = text.chars().map(|letter| letter as u8).collect();
        assert_eq!(told(&latin).unwrap(), "ISO-8859-1 instead of UTF-8, judging by line 3");
        assert_eq!(
            told(b"price = \x80").unwrap(),
            "WINDOWS-1252 instead of UTF-8, judging by the first line"
        );
        for (bytes, mark, name) in [
            (u16::to_le_bytes as fn(u16) -> [u8; 2], &[0xff_u8, 0xfe][..], "UTF-16"),
            (u16::to_be_bytes, &[0xfe, 0xff], "UTF-16"),
            (u16::to_le_bytes, &[], "UTF-16LE"),
            (u16::to_be_bytes, &[], "UTF-16BE"),
        ] {
            let foreign = NotUtf8::of(&wide_text(text, bytes, mark)).unwrap();
            assert_eq!(foreign.to_string(), format!("{name} instead of UTF-8, judging by the first line"));
            assert_eq!(foreign.remedy(), format!("save it as UTF-8: `iconv -f {name} -t UTF-8 FILE > NEW`"));
        }
        assert_eq!(told(b"\x7fELF\x01\n\xfe\xff").unwrap(), "not text: line 2 is not UTF-8");
    }
}
