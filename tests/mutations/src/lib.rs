//! Random damage to bytes, for tests that feed damaged input to a reader.
//!
//! Mutations of good input reach deeper into a reader than random bytes, which fail at the first one. Cases come from
//! proptest, so they are seeded and bounded in number, and a failing case is shrunk.

use proptest::prelude::*;

/// One change. Places are shares of the length, 0 to 1, so that they are valid for any length of the input.
#[derive(Debug, Clone)]
pub enum Mutation {
    /// Replaces a byte.
    Replace(f64, u8),
    /// Inserts text that often breaks readers.
    Insert(f64, &'static str),
    /// Removes some bytes.
    Delete(f64, usize),
    /// Duplicates some bytes.
    Repeat(f64, usize),
    /// Cuts off the end.
    Truncate(f64),
}

/// Numbers, brackets and keys that have broken readers in the past.
const TOKENS: [&str; 22] = [
    "0",
    "-1",
    "-0.0",
    "1e308",
    "1e-320",
    "nan",
    "-inf",
    "null",
    "true",
    "18446744073709551616",
    "99999999999999999999999",
    "\"",
    "\\u0000",
    "\n",
    "\r\n",
    "[",
    "]",
    "{}",
    "[[[[[[[[",
    "=",
    "# ",
    "\u{fffd}",
];

fn mutation() -> impl Strategy<Value = Mutation> {
    let at = || 0.0..=1.0_f64;
    prop_oneof![
        4 => (at(), any::<u8>()).prop_map(|(at, byte)| Mutation::Replace(at, byte)),
        4 => (at(), prop::sample::select(&TOKENS[..])).prop_map(|(at, token)| Mutation::Insert(at, token)),
        2 => (at(), 1_usize..200).prop_map(|(at, n)| Mutation::Delete(at, n)),
        2 => (at(), 1_usize..200).prop_map(|(at, n)| Mutation::Repeat(at, n)),
        1 => at().prop_map(Mutation::Truncate),
    ]
}

/// One to six changes.
pub fn mutations() -> impl Strategy<Value = Vec<Mutation>> {
    prop::collection::vec(mutation(), 1..=6)
}

/// The bytes after these changes.
pub fn mutated(bytes: &[u8], mutations: &[Mutation]) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    for mutation in mutations {
        apply(&mut bytes, mutation);
    }
    bytes
}

fn apply(bytes: &mut Vec<u8>, mutation: &Mutation) {
    let place = |share: f64| ((share * bytes.len() as f64) as usize).min(bytes.len());
    match *mutation {
        Mutation::Replace(at, byte) => {
            let at = place(at);
            if let Some(old) = bytes.get_mut(at) {
                *old = byte;
            }
        }
        Mutation::Insert(at, token) => {
            let at = place(at);
            bytes.splice(at..at, token.bytes());
        }
        Mutation::Delete(at, n) => {
            let at = place(at);
            bytes.drain(at..(at + n).min(bytes.len()));
        }
        Mutation::Repeat(at, n) => {
            let at = place(at);
            let again = bytes[at..(at + n).min(bytes.len())].to_vec();
            bytes.splice(at..at, again);
        }
        Mutation::Truncate(at) => {
            let at = place(at);
            bytes.truncate(at);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_change_does_what_it_says_also_at_the_ends() {
        let changed = |mutation| String::from_utf8(mutated(b"abcdef", &[mutation])).expect("ASCII");
        assert_eq!(changed(Mutation::Replace(0.5, b'X')), "abcXef");
        assert_eq!(changed(Mutation::Replace(1.0, b'X')), "abcdef");
        assert_eq!(changed(Mutation::Insert(1.0, "=")), "abcdef=");
        assert_eq!(changed(Mutation::Delete(0.5, 99)), "abc");
        assert_eq!(changed(Mutation::Repeat(0.0, 2)), "ababcdef");
        assert_eq!(changed(Mutation::Truncate(0.0)), "");
        assert_eq!(mutated(b"", &[Mutation::Delete(0.3, 4), Mutation::Repeat(0.9, 2)]), b"");
    }
}
