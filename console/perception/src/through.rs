//! Uses free space as evidence: rays that pass through the place where an obstacle should be.

use crate::{drawing::Drawing, rays::Rays, uncertain::Uncertain};
use geometry::Shape;
use std::collections::BTreeMap;
use world::ObstacleId;

/// Radius of the core of an obstacle, as a share of the obstacle's inner radius. Rays towards the core must end in the
/// obstacle.
const CORE: f64 = 0.6;
/// Minimum number of rays that must pass through the core.
const LEAST_RAYS: usize = 2;
/// Minimum radius of the core, metres.
const LEAST_CORE_M: f64 = 0.03;
/// A drawn obstacle is reported as missing after this number of scans that pass through its place, if none in between
/// shows it.
const MISSING_AFTER: u32 = 40;

/// The result of looking at a place in a scan.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Look {
    /// The scan shows something at the place.
    Hit,
    /// Rays pass through the place.
    Through,
    /// The scan does not show the place.
    Hidden,
}

/// Determines what a scan shows at the place of an obstacle. `range_m` is the maximum distance that can be measured, if
/// it is known.
pub(crate) fn look(rays: &Rays, shape: &Shape, pose: &Uncertain, range_m: Option<f64>) -> Look {
    let (center, inner_m) = match shape {
        Shape::Disc { center, radius_m } => (*center, *radius_m),
        other => (other.center(), -other.distance_m(other.center())),
    };
    let far_m = (center - rays.eye()).norm();
    let (core_m, gate_m) = (CORE * inner_m, pose.gate_m(far_m));
    // The core must be large enough for the rays to pass through it in spite of the error of the pose.
    if core_m < LEAST_CORE_M || far_m <= inner_m || core_m < 2.0 / 3.0 * pose.point_m2(far_m).sqrt() {
        return Look::Hidden;
    }
    let deepest_m = far_m + inner_m + gate_m;
    let (mut through, mut silent) = (0, 0);
    for ray in rays.towards(center, core_m) {
        let measured_m = rays.range_m[ray];
        if measured_m == f64::INFINITY {
            silent += usize::from(range_m.is_some_and(|most_m| deepest_m < most_m));
        } else if measured_m > deepest_m {
            through += 1;
        } else if measured_m >= far_m - inner_m - gate_m {
            return Look::Hit;
        } else {
            return Look::Hidden;
        }
    }
    // Single rays may be lost, but hardly ever several neighbouring ones.
    if through >= LEAST_RAYS || through + silent > LEAST_RAYS { Look::Through } else { Look::Hidden }
}

/// The drawn obstacles that are not where they are drawn: for each, the number of scans that passed through its place
/// since a scan showed it.
#[derive(Debug, Clone, Default)]
pub(crate) struct Missing {
    through: BTreeMap<ObstacleId, u32>,
}

impl Missing {
    /// Counts a scan; returns the obstacles to be reported now.
    pub(crate) fn look(
        &mut self,
        drawing: &Drawing<'_>,
        rays: &Rays,
        pose: &Uncertain,
        range_m: Option<f64>,
    ) -> Vec<(ObstacleId, u32)> {
        let mut missing = Vec::new();
        for (obstacle, ..) in &drawing.obstacles {
            match look(rays, &obstacle.shape, pose, range_m) {
                Look::Hidden => {}
                Look::Hit => {
                    self.through.remove(&obstacle.id);
                }
                Look::Through => {
                    let times = self.through.entry(obstacle.id).or_default();
                    *times = times.saturating_add(1);
                    if *times == MISSING_AFTER {
                        missing.push((obstacle.id, *times));
                    }
                }
            }
        }
        missing
    }
}
