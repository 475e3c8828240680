//! The checks of a real vehicle before the start: its link, and whether it stands still as commanded.

use super::{Model, check};
use mission::{Check, CheckOutcome};
use vehicle::port::LinkState;

impl Model {
    /// The checks of a real vehicle; none in a simulation.
    pub(super) fn vehicle_checks(&self) -> Vec<Check> {
        if !self.live.run.is_live() {
            return Vec::new();
        }
        let Some(vehicle) = &self.live.run.vehicle else {
            return vec![check("link", CheckOutcome::Failed, "no message from the vehicle yet".into())];
        };
        let link = &vehicle.link;
        let link = match (link.state, link.trouble()) {
            (LinkState::Up, _) | (_, None) => {
                let bound = link.offset_bound_s.map(|s| format!(", clock offset ±{:.1} ms", 1e3 * s));
                check("link", CheckOutcome::Passed, format!("up{}", bound.unwrap_or_default()))
            }
            (_, Some(why)) => check("link", CheckOutcome::Failed, why),
        };
        let stop = match vehicle.stands {
            Some(true) => (CheckOutcome::Passed, "the vehicle has stopped, confirmed by odometry"),
            Some(false) => {
                (CheckOutcome::Failed, "STOP NOT CONFIRMED: the vehicle moves, or odometry is missing")
            }
            None => (CheckOutcome::Failed, "odometry has not confirmed the stop yet; check again"),
        };
        let guard = if self.live.run.has_guard() {
            (CheckOutcome::Passed, "on: the scan limits the robot to speeds from which it can stop in time")
        } else {
            (
                CheckOutcome::Warning,
                "off: the vehicle has no scan, so it does not stop in front of unknown objects",
            )
        };
        vec![link, check("standstill", stop.0, stop.1.into()), check("guard", guard.0, guard.1.into())]
    }
}
