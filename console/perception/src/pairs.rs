//! Compares scans with earlier scans, by the motion between them: a scan that is mirrored or rotated contradicts itself
//! when the robot turns or drives, even if nothing is drawn but a round wall.
//!
//! A mirrored scan turns the wrong way, so a turn shows it. A scan that is rotated by half a turn moves the wrong way, so
//! a drive shows it.

use crate::{rays::Rays, uncertain::Uncertain};
use geometry::{Point, Vector};
use nalgebra::Isometry2;

/// Turn, radians, and drive, metres, after which a scan is compared with the earlier one.
const TURNED_RAD: f64 = 0.5;
const MOVED_M: f64 = 0.5;
/// Number of rays of the earlier scan that are compared; a comparison is rare, and only a few of them may hit something.
const RAYS: usize = 360;
/// Minimum number of rays that must say something for a comparison to count.
const LEAST_RAYS: usize = 12;
/// Number of comparisons before the first verdict, and the weight of a new one in the running mean.
const LEAST: u32 = 3;
const SMOOTHING: f64 = 0.3;
/// Distance by which a ray may miss what an earlier one hit, in addition to the errors of pose and distance: metres, and
/// as a share of the distance, for surfaces that the rays graze.
const ROOM_M: f64 = 0.1;
const ROOM: f64 = 0.05;
/// Share of the maximum distance up to which a ray must have an echo.
const IN_RANGE: f64 = 0.9;
/// Limits of the share of the rays that fit: below `WRONG`, the scan contradicts the earlier one; above `RIGHT`, it fits.
const WRONG: f64 = 0.5;
const RIGHT: f64 = 0.75;

/// How the directions of a scan could be wrong.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Way {
    AsItIs,
    Mirrored,
    Backwards,
}

impl Way {
    /// The true direction of a ray for its stated direction, robot frame; and the other way round.
    fn turned(self, direction: Vector) -> Vector {
        match self {
            Self::AsItIs => direction,
            Self::Mirrored => Vector::new(direction.x, -direction.y),
            Self::Backwards => -direction,
        }
    }
}

/// The shares of the rays that fit if a scan is taken as it is, and if its directions are wrong in one way.
#[derive(Debug, Clone, Copy)]
struct Contest {
    other: Way,
    compared: u32,
    as_it_is: f64,
    as_other: f64,
}

impl Contest {
    const fn between_as_it_is_and(other: Way) -> Self {
        Self { other, compared: 0, as_it_is: 0.0, as_other: 0.0 }
    }

    fn add(&mut self, share: impl Fn(Way) -> Option<f64>) {
        let Some((as_it_is, as_other)) = share(Way::AsItIs).zip(share(self.other)) else { return };
        let weight = if self.compared == 0 { 1.0 } else { SMOOTHING };
        self.compared = self.compared.saturating_add(1);
        self.as_it_is += weight * (as_it_is - self.as_it_is);
        self.as_other += weight * (as_other - self.as_other);
    }

    /// Whether the scans as they are have agreed with the motion.
    fn is_won(&self) -> bool {
        self.compared >= LEAST && self.as_it_is > RIGHT
    }

    fn is_lost(&self) -> bool {
        self.compared >= LEAST && self.as_it_is < WRONG && self.as_other > RIGHT
    }
}

/// An earlier scan: the robot's frame, and its echoes as directions and distances in that frame.
#[derive(Debug, Clone)]
struct Earlier {
    frame: Isometry2<f64>,
    echoes: Vec<(Vector, f64)>,
}

/// The comparisons so far, and the scan with which the next one is compared.
#[derive(Debug, Clone)]
pub(crate) struct Pairs {
    earlier: Option<Earlier>,
    by_turn: Contest,
    by_drive: Contest,
}

impl Default for Pairs {
    fn default() -> Self {
        Self {
            earlier: None,
            by_turn: Contest::between_as_it_is_and(Way::Mirrored),
            by_drive: Contest::between_as_it_is_and(Way::Backwards),
        }
    }
}

impl Pairs {
    /// Compares a scan with an earlier one if the robot has moved enough since then. `range_m` is the maximum distance
    /// that can be measured, if it is known; otherwise rays without an echo show nothing.
    pub(crate) fn compare(&mut self, rays: &Rays, pose: &Uncertain, range_m: Option<f64>) {
        if let Some(earlier) = &self.earlier {
            let since = earlier.frame.inverse() * rays.frame();
            let has_turned = since.rotation.angle().abs() >= TURNED_RAD;
            let has_moved = since.translation.vector.norm() >= MOVED_M;
            if !has_turned && !has_moved {
                return;
            }
            let share = |way| share(earlier, rays, (pose, range_m), way);
            if has_turned {
                self.by_turn.add(share);
            }
            if has_moved {
                self.by_drive.add(share);
            }
        }
        let step = (rays.len() / RAYS).max(1);
        let echo = |ray: usize| Some((rays.in_robot(ray), rays.range_m[ray])).filter(|(_, m)| m.is_finite());
        let echoes = (0..rays.len()).step_by(step).filter_map(echo).collect();
        self.earlier = Some(Earlier { frame: *rays.frame(), echoes });
    }

    /// Whether the motion shows that the directions of the scans are not wrong in this way.
    pub(crate) fn rule_out(&self, way: Way) -> bool {
        [&self.by_turn, &self.by_drive].into_iter().any(|contest| contest.other == way && contest.is_won())
    }

    /// The way in which the directions of the scans are wrong; `None` if they may be right.
    pub(crate) fn wrong(&self) -> Option<Way> {
        [&self.by_turn, &self.by_drive].into_iter().find(|contest| contest.is_lost()).map(|lost| lost.other)
    }
}

/// The share of the echoes of an earlier scan that a scan shows, too, of those that it must show; both scans are taken in
/// one way. `None` if too few must be shown.
fn share(
    earlier: &Earlier,
    rays: &Rays,
    (pose, range_m): (&Uncertain, Option<f64>),
    way: Way,
) -> Option<f64> {
    let (mut fit, mut missed) = (0_usize, 0_usize);
    for (direction, distance_m) in &earlier.echoes {
        let at = earlier.frame * Point::from(rays.sensor() + way.turned(*direction) * *distance_m);
        let to = at - rays.eye();
        let expected_m = to.norm();
        if range_m.is_some_and(|range_m| expected_m > IN_RANGE * range_m) {
            continue;
        }
        let Some(ray) = rays.nearest(way.turned(rays.frame().rotation.inverse() * to)) else { continue };
        let room_m = ROOM_M + ROOM * expected_m + pose.gate_m(expected_m);
        let beside = [-1, 0, 1].into_iter().filter_map(|by| rays.neighbour(ray, by));
        let measured = beside.map(|ray| rays.range_m[ray]);
        if measured.clone().any(|m| (m - expected_m).abs() <= room_m) {
            fit += 1;
        } else if measured.clone().all(|m| m > expected_m + room_m && (m.is_finite() || range_m.is_some())) {
            missed += 1;
        }
    }
    (fit + missed >= LEAST_RAYS).then(|| fit as f64 / (fit + missed) as f64)
}
