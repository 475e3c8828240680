//! A coverage mission.

use crate::study::Planners;
use flight::unrecorded;
use mission::Outcome;
use scenario::Scenario;
use serde::{Deserialize, Serialize};
use trials::tanks::Tank;

/// What a coverage mission achieved.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Covered {
    /// The reason why the mission is not complete; `None` if it is.
    pub unfinished: Option<String>,
    /// Share of the reachable floor that was truly scanned, and that was scanned according to the estimate, 0 to 1.
    pub scanned: [f64; 2],
    /// Number of collisions.
    pub collisions: u64,
    /// Smallest true distance of the hull from anything solid, metres.
    pub clearance_m: f64,
    /// Number of obstacles that were found although the drawing does not show them.
    pub found: u64,
    /// Mission time, seconds.
    pub time_s: f64,
    /// Length of the path, metres.
    pub path_m: f64,
    /// Longest tether, and tether still out at the end, metres.
    pub tether_m: [f64; 2],
    /// Largest wrap on one column, radians.
    pub wrap_rad: f64,
}

/// Runs a coverage mission.
///
/// # Errors
/// The scenario is refused.
pub(super) fn cover(planners: &Planners, text: &str, tank: &Tank) -> Result<Covered, String> {
    let scenario = Scenario::parse(text, "cover").map_err(|errors| errors.render())?;
    debug_assert_eq!(scenario.sim.world.boundary, tank.boundary);
    let summary = unrecorded::fly(&scenario, &mut planners.answers(&scenario), || false);
    let summary = summary.ok_or("stopped")?;
    let is_complete = summary.outcome == Some(Outcome::Complete);
    let truth = summary.coverage.and_then(|coverage| coverage.by_truth).map(|truth| truth.reachable);
    let tether = summary.tether;
    Ok(Covered {
        unfinished: (!is_complete).then(|| summary.reason.unwrap_or_default()),
        scanned: [truth.unwrap_or_default(), summary.coverage.map(|c| c.reachable).unwrap_or_default()],
        collisions: summary.collisions.unwrap_or_default(),
        clearance_m: summary.clearance_min_m.unwrap_or_default(),
        found: summary.obstacles_found,
        time_s: summary.mission_time_s.unwrap_or_default(),
        path_m: summary.path_length_m.unwrap_or_default(),
        tether_m: tether.map(|t| [t.tether_length_max_m, t.end_length_m]).unwrap_or_default(),
        wrap_rad: tether.map(|t| t.wrap_max_rad).unwrap_or_default(),
    })
}
