//! Input to import: a file or standard input.

use crate::{
    error::{ImportError, LARGEST_BYTES, read_file},
    text::decoded,
};
use std::{
    io::{Read, stdin},
    path::Path,
};

/// The bytes of a drawing or a list.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Input {
    /// The name for messages.
    pub name: String,
    /// The complete contents.
    pub(crate) bytes: Vec<u8>,
    /// The kind according to the file name.
    kind: Option<InputKind>,
}

/// The kind of an input.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum InputKind {
    /// A DXF drawing.
    Drawing,
    /// A list of columns.
    List,
    /// A log of laser scans.
    Scans,
}

impl Input {
    /// Reads a file or, for `-`, standard input.
    ///
    /// # Errors
    /// The input cannot be read, or is empty or too large.
    pub fn read(path: &Path) -> Result<Self, ImportError> {
        if path == Path::new("-") {
            return Self::of_stdin();
        }
        let suffix = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        let kind = match suffix.as_str() {
            "dxf" => InputKind::Drawing,
            "csv" => InputKind::List,
            "log" | "clf" => InputKind::Scans,
            _ => {
                let what =
                    "only .dxf, .csv, .log and .clf files can be read: drawings, lists of columns, and scans";
                return Err(ImportError::of_file(path, what));
            }
        };
        Ok(Self { name: path.display().to_string(), bytes: read_file(path)?, kind: Some(kind) })
    }

    /// An input that was read elsewhere; its kind follows from its content.
    pub fn of_bytes(name: &str, bytes: &[u8]) -> Self {
        Self { name: name.into(), bytes: bytes.to_vec(), kind: None }
    }

    fn of_stdin() -> Result<Self, ImportError> {
        let mut input = Self { name: "standard input".into(), bytes: Vec::new(), kind: None };
        let read = stdin().take(LARGEST_BYTES + 1).read_to_end(&mut input.bytes);
        let wrong = match read {
            Err(error) => format!("cannot be read: {error}"),
            Ok(0) => "is empty".into(),
            Ok(n) if n as u64 > LARGEST_BYTES => {
                format!("more than {} MB; inputs may not be larger", LARGEST_BYTES / 1_000_000)
            }
            Ok(_) => return Ok(input),
        };
        Err(ImportError::of_input(&input, wrong))
    }

    /// The kind of the input, determined from the file name or, if the name does not show it, from the beginning of the
    /// content. A drawing begins with the number of a code alone on a line.
    pub fn kind(&self) -> InputKind {
        let is_code = |line: &str| line.trim().parse::<u16>().is_ok();
        let begins_as_drawing = || {
            let head = &self.bytes[..self.bytes.len().min(200)];
            head.starts_with(b"AutoCAD Binary DXF") || decoded(head, None).lines().next().is_some_and(is_code)
        };
        self.kind.unwrap_or_else(|| if begins_as_drawing() { InputKind::Drawing } else { InputKind::List })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_comes_without_a_name_is_known_by_how_it_begins() {
        let kind = |bytes: &[u8]| Input { name: String::new(), bytes: bytes.to_vec(), kind: None }.kind();
        assert_eq!(kind(b"  0\r\nSECTION\r\n"), InputKind::Drawing);
        assert_eq!(kind(b"999\nmade by hand\n0\nSECTION\n"), InputKind::Drawing);
        assert_eq!(kind(b"AutoCAD Binary DXF\r\n"), InputKind::Drawing);
        assert_eq!(kind(b"# survey\nx_m,y_m,radius_m\n1,2,0.3\n"), InputKind::List);
        assert_eq!(kind(b"name;x_m;y_m;diameter_m\n"), InputKind::List);
    }
}
