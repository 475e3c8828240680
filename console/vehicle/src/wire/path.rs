//! Finds places in a line of JSON without parsing its values, so that the field can be named even in a damaged line.

/// Maximum depth of nesting that is followed; messages have four levels.
const DEPTH_MAX: usize = 8;

#[derive(Debug)]
enum Level {
    Object(String),
    Array(usize),
}

/// Walks along a line, and keeps track of the current field.
struct Walk<'a> {
    line: &'a str,
    at: usize,
    levels: Vec<Level>,
    /// Levels beyond [`DEPTH_MAX`].
    deeper: usize,
}

impl<'a> Walk<'a> {
    fn new(line: &'a str) -> Self {
        Self { line, at: 0, levels: Vec::new(), deeper: 0 }
    }

    /// Advances to the next key, and returns it; ends at byte `end`.
    fn next_key(&mut self, end: usize) -> Option<&'a str> {
        while self.at < end.min(self.line.len()) {
            let byte = self.line.as_bytes()[self.at];
            self.at += 1;
            match byte {
                b'"' => {
                    if let Some(key) = self.key() {
                        return Some(key);
                    }
                }
                b'{' => self.enter(Level::Object(String::new())),
                b'[' => self.enter(Level::Array(0)),
                b'}' | b']' => self.leave(),
                b',' if self.deeper == 0 => {
                    if let Some(Level::Array(index)) = self.levels.last_mut() {
                        *index += 1;
                    }
                }
                _ => {}
            }
        }
        None
    }

    fn enter(&mut self, level: Level) {
        if self.levels.len() < DEPTH_MAX {
            self.levels.push(level);
        } else {
            self.deeper += 1;
        }
    }

    fn leave(&mut self) {
        if self.deeper > 0 {
            self.deeper -= 1;
        } else {
            self.levels.pop();
        }
    }

    /// Passes the rest of a string. Returns it if it is a key.
    fn key(&mut self) -> Option<&'a str> {
        let bytes = self.line.as_bytes();
        let start = self.at;
        while self.at < bytes.len() && bytes[self.at] != b'"' {
            self.at += 1 + usize::from(bytes[self.at] == b'\\');
        }
        let end = self.at.min(bytes.len());
        self.at = end + 1;
        let after = bytes.get(self.at..).unwrap_or_default();
        let is_key = after.iter().find(|byte| !byte.is_ascii_whitespace()) == Some(&b':');
        let key = self.line.get(start..end).filter(|_| is_key)?;
        if let (0, Some(Level::Object(own))) = (self.deeper, self.levels.last_mut()) {
            key.clone_into(own);
        }
        Some(key)
    }

    fn path(&self) -> String {
        let mut path = String::new();
        for level in &self.levels {
            match level {
                Level::Object(key) if path.is_empty() || key.is_empty() => path.push_str(key),
                Level::Object(key) => path.extend([".", key]),
                Level::Array(index) => path.extend(["[", &index.to_string(), "]"]),
            }
        }
        path
    }
}

/// The field at byte `end` of a line, such as `scan.ranges_m[3]`; empty outside all fields.
pub(super) fn field_at(line: &str, end: usize) -> String {
    let mut walk = Walk::new(line);
    while walk.next_key(end).is_some() {}
    walk.path()
}

/// All keys of a line, in order.
pub(super) fn keys(line: &str) -> impl Iterator<Item = &str> {
    let mut walk = Walk::new(line);
    std::iter::from_fn(move || walk.next_key(usize::MAX))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_is_named_by_its_keys_and_indices() {
        let line = r#"{"a": "x\": {", "b": {"c": [1, [2, 3], 4], "d": 5}, "e": 6}"#;
        let at = |sign: &str| field_at(line, line.find(sign).expect("in the line"));
        assert_eq!(at("x"), "a");
        assert_eq!(at("1"), "b.c[0]");
        assert_eq!(at("3"), "b.c[1][1]");
        assert_eq!(at("4"), "b.c[2]");
        assert_eq!(at("5"), "b.d");
        assert_eq!(at("6"), "e");
        assert_eq!(keys(line).collect::<Vec<_>>(), ["a", "b", "c", "d", "e"]);
    }

    #[test]
    fn damaged_lines_have_places_too() {
        assert_eq!(field_at(r#"{"a": {"b": NaN"#, 99), "a.b");
        assert_eq!(field_at(r#"{"a": {"b"#, 99), "a");
        assert_eq!(field_at(r#"{"a\"#, 99), "");
        assert_eq!(field_at(&"[".repeat(100), 99), "[0]".repeat(DEPTH_MAX));
        assert_eq!(field_at("}}]]", 99), "");
    }
}
