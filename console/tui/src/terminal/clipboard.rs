//! Copies lines to the terminal's clipboard over any connection: OSC 52.

const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/// The bytes that make the terminal copy text to its clipboard. No text can break out of the escape sequence.
pub(super) fn sequence(text: &str) -> String {
    format!("\x1b]52;c;{}\x07", base64(text.as_bytes()))
}

fn base64(bytes: &[u8]) -> String {
    let letters = |chunk: &[u8]| {
        let byte = |index: usize| u32::from(chunk.get(index).copied().unwrap_or_default());
        let bits = byte(0) << 16 | byte(1) << 8 | byte(2);
        let length = chunk.len() + 1;
        [18, 12, 6, 0]
            .map(|shift| bits >> shift & 63)
            .into_iter()
            .enumerate()
            .map(move |(index, six)| if index < length { char::from(LETTERS[six as usize]) } else { '=' })
    };
    bytes.chunks(3).flat_map(letters).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_are_encoded_as_base64() {
        let table = [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("σ\x1b\x07", "z4MbBw==")];
        for (text, encoded) in table {
            assert_eq!(sequence(text), format!("\x1b]52;c;{encoded}\x07"));
        }
    }
}
