//! Decodes text in the encodings that drawing programs, spreadsheets and editors write.

use encoding_rs::{Encoding, UTF_8, WINDOWS_1252};

/// Decodes a text: as UTF-8 or UTF-16 if possible; otherwise in the encoding that the file states or, if it states
/// none, in Western European Windows.
pub(crate) fn decoded(bytes: &[u8], said: Option<&'static Encoding>) -> String {
    let marked = Encoding::for_bom(bytes).map(|(encoding, _)| encoding);
    let wide = || Encoding::for_label(foreign::wide(bytes)?.as_bytes());
    let is_utf8 = || std::str::from_utf8(bytes).is_ok();
    let otherwise = || if is_utf8() { UTF_8 } else { said.unwrap_or(WINDOWS_1252) };
    let encoding = marked.or_else(wide).unwrap_or_else(otherwise);
    encoding.decode(bytes).0.into_owned()
}

/// The encoding for a code page named in a drawing (`$DWGCODEPAGE`), for example `ANSI_1252`.
pub(crate) fn code_page(name: &str) -> Option<&'static Encoding> {
    let number = name.trim().rsplit('_').next()?;
    let label = match number {
        "874" => "windows-874",
        "932" => "shift_jis",
        "936" => "gbk",
        "949" => "euc-kr",
        "950" => "big5",
        _ => return Encoding::for_label(format!("windows-{number}").as_bytes()),
    };
    Encoding::for_label(label.as_bytes())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wide_text(text: &str, bytes: fn(u16) -> [u8; 2], mark: &[u8]) -> Vec<u8> {
        mark.iter().copied().chain(text.encode_utf16().flat_map(bytes)).collect()
    }

    #[test]
    fn every_usual_encoding_of_a_name_is_read() {
        let all: [&[u8]; 7] = [
            "Stütze".as_bytes(),
            "\u{feff}Stütze".as_bytes(),
            b"St\xfctze",
            &wide_text("Stütze", u16::to_le_bytes, &[0xff, 0xfe]),
            &wide_text("Stütze", u16::to_be_bytes, &[0xfe, 0xff]),
            &wide_text("Stütze", u16::to_le_bytes, &[]),
            &wide_text("Stütze", u16::to_be_bytes, &[]),
        ];
        for bytes in all {
            assert_eq!(decoded(bytes, None), "Stütze");
        }
        assert_eq!(decoded(b"\xca\xee\xeb", code_page("ANSI_1251")), "Кол");
        assert_eq!(decoded(b"\x92\x8c", code_page("ANSI_932")), "柱");
    }
}
