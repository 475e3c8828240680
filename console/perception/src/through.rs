//! Free space as evidence: rays that go through a place where something should be.

use crate::{rays::Rays, uncertain::Uncertain};
use geometry::Shape;

/// Share of the inner radius of an obstacle that its core has; rays through the core must end in the obstacle.
const CORE: f64 = 0.6;
/// Number of rays through the core that a scan must have.
const LEAST_RAYS: usize = 2;
/// Smallest core, metres.
const LEAST_CORE_M: f64 = 0.03;

/// What a scan shows of a place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Look {
    /// Something is there.
    Hit,
    /// Rays go through it.
    Through,
    /// The scan does not show the place.
    Hidden,
}

/// What a scan shows of an obstacle. `range_m` is the greatest distance that is measured, if it is known.
pub(crate) fn look(rays: &Rays, shape: &Shape, pose: &Uncertain, range_m: Option<f64>) -> Look {
    let (center, inner_m) = match shape {
        Shape::Disc { center, radius_m } => (*center, *radius_m),
        other => (other.center(), -other.distance_m(other.center())),
    };
    let far_m = (center - rays.eye()).norm();
    let (core_m, gate_m) = (CORE * inner_m, pose.gate_m(far_m));
    // The rays must go through the core although the pose is not exact.
    if core_m < LEAST_CORE_M || far_m <= inner_m || core_m < 2.0 / 3.0 * pose.point_m2(far_m).sqrt() {
        return Look::Hidden;
    }
    let deepest_m = far_m + inner_m + gate_m;
    let (mut through, mut silent) = (0, 0);
    for ray in rays.towards(center, core_m) {
        let measured_m = rays.range_m[ray];
        if measured_m.is_infinite() {
            silent += usize::from(range_m.is_some_and(|most_m| deepest_m < most_m));
        } else if measured_m > deepest_m {
            through += 1;
        } else if measured_m >= far_m - inner_m - gate_m {
            return Look::Hit;
        } else {
            return Look::Hidden;
        }
    }
    // Single rays get lost, but hardly several side by side.
    if through >= LEAST_RAYS || through + silent > LEAST_RAYS { Look::Through } else { Look::Hidden }
}
