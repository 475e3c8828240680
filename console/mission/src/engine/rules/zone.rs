//! A robot whose hull is in a no-go zone is held until an operator decides.

use super::seen::{Seen, Verdict};
use crate::phase::{Hold, HoldReason, Outcome, Resumes};

/// The rule has no state: the breach is reported once, in the tick in which the hull enters the zone.
pub(in crate::engine) struct ZoneRule;

impl ZoneRule {
    /// Processes one tick: holds a robot whose hull has just entered a zone; an unattended mission ends.
    pub(crate) fn update(seen: &Seen<'_>) -> Option<Verdict> {
        let zone = seen.breached?.to_owned();
        Some(if seen.config.attended {
            Verdict::Hold(Hold { by: HoldReason::ZoneBreached { zone }, resumes: Resumes::Never })
        } else {
            Verdict::End(Outcome::Aborted, format!("unattended hold: hull in zone {zone}"))
        })
    }
}
