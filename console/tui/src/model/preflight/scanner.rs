//! The check of the scanner before the start.

use super::{Model, check};
use mission::{Check, CheckOutcome};

impl Model {
    /// Whether the scans that have come so far can be used; `None` for a robot without a scanner.
    pub(super) fn scanner_check(&self) -> Option<Check> {
        let run = &self.live.run;
        run.about.as_ref()?.mission.sensor?;
        Some(match (&run.scanner.trouble, &run.scanner.scan) {
            (Some(why), _) => check("scanner", CheckOutcome::Failed, why.clone()),
            (None, None) => {
                check("scanner", CheckOutcome::Failed, "no scan has come yet; check again".into())
            }
            (None, Some(scan)) => {
                let echoes = scan.points.len();
                check("scanner", CheckOutcome::Passed, format!("{} rays, {echoes} with an echo", scan.rays))
            }
        })
    }
}
