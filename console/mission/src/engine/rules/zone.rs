//! A robot whose hull is in a no-go zone is held until an operator decides, when it enters the zone and again if the
//! planner finds no way out.

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

    /// Processes one tick of a running robot: holds it if its hull is in a zone and its planner finds no way out. Driving
    /// back needs no planner.
    pub(crate) fn update_planner(seen: &Seen<'_>) -> Option<Verdict> {
        let zone = seen.in_zone.filter(|_| seen.planner.is_shut_in)?;
        let message = format!("planner {} finds no way out of zone {zone}", seen.planner.id);
        Some(Verdict::Hold(Hold { by: HoldReason::Stuck { message }, resumes: Resumes::Never }))
    }
}
