//! Dead channels of the instrument as an event.

use serde::{Deserialize, Serialize};
use std::fmt;

/// Other channels of the instrument are dead than before.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct ChannelsJudged {
    /// The dead channels, in ascending order; empty if all channels work again. Channel 0 is on the right.
    pub dead: Vec<u16>,
    /// Number of channels of the instrument; 0 if the scenario does not state it.
    pub count: u16,
}

impl ChannelsJudged {
    /// Whether a dead channel has no place across the tool, so that nothing counts as scanned.
    pub fn is_without_place(&self) -> bool {
        self.dead.last().is_some_and(|channel| *channel >= self.count)
    }
}

/// What happened, as a sentence without a full stop.
impl fmt::Display for ChannelsJudged {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names: Vec<String> = self.dead.iter().map(ToString::to_string).collect();
        match names.as_slice() {
            [] => write!(f, "all channels of the instrument work again"),
            [one] => write!(f, "channel {one} of the instrument is dead"),
            many => write!(f, "channels {} of the instrument are dead", many.join(", ")),
        }?;
        if self.is_without_place() {
            write!(
                f,
                "; the scenario states {} channels, so the tool scans nothing: correct instrument.channels",
                self.count
            )
        } else if self.dead.is_empty() {
            Ok(())
        } else {
            write!(f, "; the floor under it does not count as scanned")
        }
    }
}
