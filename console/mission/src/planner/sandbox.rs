//! The sandbox of a planner's process, which is set up before any code of the plugin runs.

use serde::{Deserialize, Serialize};
use std::fmt;

/// The restrictions that the system enforces on the process of a planner, strongest level first. Nothing less than
/// [`Self::Full`] may be displayed as if it were full.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Sandbox {
    /// No access to files, the network, the terminal, other processes or their memory.
    Full,
    /// Only some of the restrictions of [`Self::Full`]; the text states why the other restrictions are missing.
    Partial(String),
    /// Only limits on memory and files; the text states why the other restrictions are missing.
    None(String),
}

impl fmt::Display for Sandbox {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Full => f.write_str("full"),
            Self::Partial(why) => write!(f, "partial ({why})"),
            Self::None(why) => write!(f, "none ({why})"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_less_than_full_says_why_in_texts_and_in_journals() {
        let partial = Sandbox::Partial("no Landlock".into());
        assert_eq!(partial.to_string(), "partial (no Landlock)");
        let json = |sandbox: &Sandbox| serde_json::to_string(sandbox).expect("JSON");
        assert_eq!(json(&Sandbox::Full), r#""full""#);
        assert_eq!(json(&partial), r#"{"partial":"no Landlock"}"#);
        assert_eq!(serde_json::from_str::<Sandbox>(&json(&partial)).expect("read"), partial);
    }
}
