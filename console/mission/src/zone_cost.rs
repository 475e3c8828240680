//! The cost of a no-go zone, as known before it is drawn.

use serde::{Deserialize, Serialize};

/// The cost of a no-go zone.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct ZoneCost {
    /// Length of the part of the current plan that leads through the zone or too close to it, metres.
    pub path_m: f64,
    /// Reachable floor that would be closed, square metres: in the zone, beside it, and behind it.
    pub closed_m2: f64,
    /// The part of `closed_m2` that has not been scanned yet and is requested, square metres.
    pub lost_m2: f64,
    /// Whether a better plan that is offered or accepted would be dropped.
    pub drops_offer: bool,
    /// Whether the hull is in the zone, so that the robot is held as soon as the zone is drawn.
    pub holds: bool,
    /// Whether the robot would find no way back along its tether.
    #[serde(default)]
    pub blocks_way_back: bool,
}
