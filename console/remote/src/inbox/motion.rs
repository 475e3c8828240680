//! The motion of a vehicle since the last tick.

use vehicle::wire::message::{Pose, Readings};
use world::Odometry;

/// The last pose of the vehicle in its own frame.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Motion {
    before: Option<Pose>,
}

impl Motion {
    /// Adds the motion of some readings to that of the tick. A pose takes precedence, because it also contains the
    /// motion in lost messages.
    pub(super) fn add(&mut self, sum: &mut Odometry, readings: &Readings) {
        let of_pose = readings.pose.map(|pose| self.before.replace(pose).map(|before| between(before, pose)));
        let moved = match (of_pose, readings.odometry) {
            // The first pose only tells where the vehicle is.
            (Some(moved), _) => moved,
            (None, Some(odometry)) => Some(Odometry {
                forward_m: odometry.forward_m,
                sideways_m: odometry.sideways_m,
                turn_rad: odometry.turn_rad,
            }),
            (None, None) => None,
        };
        let Some(moved) = moved else { return };
        *sum = if *sum == Odometry::default() { moved } else { after(*sum, moved) };
    }
}

fn between(before: Pose, now: Pose) -> Odometry {
    let (x, y) = (now.x_m - before.x_m, now.y_m - before.y_m);
    let (sin, cos) = before.heading_rad.sin_cos();
    Odometry {
        forward_m: x * cos + y * sin,
        sideways_m: y * cos - x * sin,
        turn_rad: now.heading_rad - before.heading_rad,
    }
}

/// A motion, followed by another one.
fn after(first: Odometry, second: Odometry) -> Odometry {
    let (sin, cos) = first.turn_rad.sin_cos();
    Odometry {
        forward_m: first.forward_m + second.forward_m * cos - second.sideways_m * sin,
        sideways_m: first.sideways_m + second.forward_m * sin + second.sideways_m * cos,
        turn_rad: first.turn_rad + second.turn_rad,
    }
}
