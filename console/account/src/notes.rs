//! Notes that people make on a run: a remark, and bookmarks with times.

use serde::{Deserialize, Serialize};

/// Time, seconds, below which two bookmarks count as one.
const SAME_S: f64 = 0.005;
/// Longest text of a note, characters.
pub const MOST_LETTERS: usize = 500;
/// Maximum number of bookmarks of a run.
pub const MOST_BOOKMARKS: usize = 1000;

/// A moment in a run that a person wants to find again.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Bookmark {
    /// Mission time, seconds.
    pub t_s: f64,
    /// A label; may be empty.
    #[serde(default)]
    pub text: String,
}

/// The notes on a run.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Notes {
    /// A remark about the whole run; may be empty.
    #[serde(default)]
    pub remark: String,
    /// Bookmarks, ascending by time.
    #[serde(default)]
    pub bookmarks: Vec<Bookmark>,
}

impl Notes {
    /// Sets a bookmark; an existing bookmark at that time gets the new text.
    ///
    /// # Errors
    /// There are too many bookmarks, or the text is too long.
    pub fn mark(&mut self, t_s: f64, text: &str) -> Result<(), String> {
        let text = checked(text)?;
        match self.at(t_s) {
            Some(index) => self.bookmarks[index].text = text,
            None if self.bookmarks.len() >= MOST_BOOKMARKS => {
                return Err(format!("there are {MOST_BOOKMARKS} bookmarks already; remove one"));
            }
            None => {
                let index = self.bookmarks.partition_point(|other| other.t_s < t_s);
                self.bookmarks.insert(index, Bookmark { t_s, text });
            }
        }
        Ok(())
    }

    /// Removes the bookmark at a moment; returns whether there was one.
    pub fn unmark(&mut self, t_s: f64) -> bool {
        self.at(t_s).map(|index| self.bookmarks.remove(index)).is_some()
    }

    /// The bookmark at a moment.
    pub fn bookmark(&self, t_s: f64) -> Option<&Bookmark> {
        self.at(t_s).map(|index| &self.bookmarks[index])
    }

    /// Sets the remark about the whole run.
    ///
    /// # Errors
    /// The text is too long.
    pub fn remark(&mut self, text: &str) -> Result<(), String> {
        self.remark = checked(text)?;
        Ok(())
    }

    /// Normalizes the notes in a file: sorts them by time, and removes terminal control characters.
    ///
    /// # Errors
    /// The notes exceed a limit; the error is a sentence.
    pub fn tidied(mut self) -> Result<Self, String> {
        if self.bookmarks.len() > MOST_BOOKMARKS {
            return Err(format!(
                "there are {} bookmarks; the limit is {MOST_BOOKMARKS}",
                self.bookmarks.len()
            ));
        }
        self.remark = checked(&self.remark).map_err(|why| format!("remark: {why}"))?;
        for bookmark in &mut self.bookmarks {
            bookmark.text =
                checked(&bookmark.text).map_err(|why| format!("bookmark at {} s: {why}", bookmark.t_s))?;
        }
        self.bookmarks.retain(|bookmark| bookmark.t_s.is_finite());
        self.bookmarks.sort_by(|one, other| one.t_s.total_cmp(&other.t_s));
        Ok(self)
    }

    fn at(&self, t_s: f64) -> Option<usize> {
        self.bookmarks.iter().position(|bookmark| (bookmark.t_s - t_s).abs() < SAME_S)
    }
}

fn checked(text: &str) -> Result<String, String> {
    let text = text.trim();
    match text.chars().count() {
        0..=MOST_LETTERS => Ok(foreign::plain(text).into_owned()),
        letters => Err(format!("the text has {letters} characters; the limit is {MOST_LETTERS}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bookmarks_are_kept_in_order_and_a_moment_has_one() {
        let mut notes = Notes::default();
        for (t_s, text) in [(5.0, "five"), (1.0, " one "), (5.001, "again"), (9.0, "")] {
            notes.mark(t_s, text).expect("room");
        }
        let all: Vec<(f64, &str)> = notes.bookmarks.iter().map(|b| (b.t_s, b.text.as_str())).collect();
        assert_eq!(all, [(1.0, "one"), (5.0, "again"), (9.0, "")]);
        assert!(notes.unmark(9.0) && !notes.unmark(2.0) && notes.bookmark(1.0).is_some());
        assert!(notes.mark(2.0, &"x".repeat(MOST_LETTERS + 1)).is_err());
    }
}
