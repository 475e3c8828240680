//! Computes how far a robot moves along an arc before its hull touches something.

use crate::motion::Arc;
use world::{ObstacleMap, Pose};

/// Minimum step along an arc, metres; the gap that remains at a contact is smaller than this.
const STEP_M: f64 = 1e-4;
/// Maximum number of steps along one arc; no realistic motion needs more steps.
const MAX_STEPS: usize = 20_000;

/// The result of moving along an arc.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Reached {
    pub pose: Pose,
    pub is_blocked: bool,
}

/// Moves along an arc to its end or to the first contact.
///
/// Every step is as long as the gap to the nearest solid object, so even thin objects are not missed. The heading turns
/// all the way even if the robot is blocked, because a round hull can turn on the spot. A hull that already overlaps
/// something can move in any way that does not increase the overlap.
pub(crate) fn sweep(map: &ObstacleMap, radius_m: f64, start: &Pose, arc: &Arc) -> Reached {
    let length_m = arc.way_m.abs();
    let gap_m = |share: f64| map.clearance_m(arc.pose_after(start, share).position) - radius_m;
    let (mut share, mut gap) = (0.0, gap_m(0.0));
    for _ in 0..MAX_STEPS {
        if share >= 1.0 || length_m == 0.0 {
            return Reached { pose: arc.pose_after(start, 1.0), is_blocked: false };
        }
        let next = (share + gap.max(STEP_M) / length_m).min(1.0);
        let next_gap = gap_m(next);
        // This is also false if the gap is NaN.
        let is_free = next_gap >= gap.min(0.0);
        if !is_free {
            break;
        }
        (share, gap) = (next, next_gap);
    }
    let heading_rad = arc.pose_after(start, 1.0).heading_rad;
    Reached { pose: Pose { heading_rad, ..arc.pose_after(start, share) }, is_blocked: true }
}

#[cfg(test)]
mod tests {
    use super::*;
    use world::{Boundary, Obstacle, ObstacleId, Point, Shape};

    fn map(shape: Shape) -> ObstacleMap {
        let obstacle = Obstacle { id: ObstacleId(1), name: "P1".into(), shape, known: true };
        ObstacleMap::new(&Boundary::Circle { radius_m: 10.0 }, &[obstacle])
    }

    fn ahead(way_m: f64) -> Arc {
        Arc { turn_first_rad: 0.0, way_m, turn_rad: 0.0 }
    }

    #[test]
    fn even_a_leap_does_not_pass_a_thin_pipe() {
        let pipe = Shape::Polyline {
            points: vec![Point::new(2.0, -5.0), Point::new(2.0, 5.0)],
            half_width_m: 0.001,
        };
        let reached = sweep(&map(pipe), 0.3, &Pose::new(0.0, 0.0, 0.0), &ahead(6.0));
        assert!(reached.is_blocked);
        assert!((reached.pose.position.x - 1.699).abs() < 2e-4, "{}", reached.pose.position);
    }

    #[test]
    fn a_robot_at_a_wall_can_turn_and_leave_but_not_go_on() {
        let map = map(Shape::Disc { center: Point::new(-5.0, 0.0), radius_m: 1.0 });
        let at_wall = sweep(&map, 0.3, &Pose::new(8.0, 0.0, 0.0), &ahead(5.0));
        assert!(at_wall.is_blocked && (at_wall.pose.position.x - 9.7).abs() < 2e-4);
        let pushed = sweep(&map, 0.3, &at_wall.pose, &Arc { turn_rad: 0.5, ..ahead(0.05) });
        assert!(pushed.is_blocked && (pushed.pose.heading_rad - 0.5).abs() < 1e-12);
        assert!(!sweep(&map, 0.3, &at_wall.pose, &ahead(-0.05)).is_blocked);
    }

    #[test]
    fn a_robot_that_overlaps_can_back_out() {
        let map = map(Shape::Disc { center: Point::new(1.0, 0.0), radius_m: 1.0 });
        let inside = Pose::new(-0.1, 0.0, 0.0);
        assert!(sweep(&map, 0.3, &inside, &ahead(0.05)).is_blocked);
        let out = sweep(&map, 0.3, &inside, &ahead(-0.5));
        assert!(!out.is_blocked && (out.pose.position.x + 0.6).abs() < 1e-9);
    }
}
