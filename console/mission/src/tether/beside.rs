//! The way home beside a cable that lies on the floor, because its reel does not take it up or because it is torn.
//!
//! The console knows the length off the reel, the pull, the map and the path driven. From these it follows where the cable
//! lies (`laid`). On a way beside it, the cable folds behind the robot. The way ends beside the anchor: the cable begins
//! there, so the hull would stand on it.

use super::{Laid, Tether};
use crate::event::SLACK_M;
use geometry::{Vector, polyline, unit_vector};
use std::f64::consts::TAU;
use world::{Point, Readings, Shape, World, shortest::GrownFloor};

/// Distances between the edge of the hull and the line of the cable that are tried, in this order, metres. A cable that was
/// dragged sideways lags behind the taut line.
const GAPS_M: [f64; 3] = [0.5, 0.3, 0.15];
/// Distances of the end of the way from the anchor that are tried, as shares of the distance to the cable.
const END_SHARES: [f64; 3] = [1.02, 1.6, 2.5];
/// Number of directions from the anchor in which the way may end.
const DIRECTIONS: u32 = 24;
/// Slack up to which the robot first goes back the way it came until the cable pulls, metres. More of it lies in loops
/// across that way.
const TAUTENED_M: f64 = 0.5;
/// Length by which more cable may come off the reel on the way than was out at the order, metres: the cable is made taut
/// first.
const DRAWN_OUT_M: f64 = 0.3;
/// How much longer the taut line at the end of the way may be than the distance to the anchor, metres. If it is longer, the
/// way passes a column on another side than the cable.
const ROUND_M: f64 = 0.1;
/// Maximum number of times that a search for a path may ask whether to go on.
const MOST_STEPS: usize = 50_000;

/// The order to drive beside a cable that lies on the floor, or the rest of a torn one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Lying {
    /// Length off the reel at the order, metres; `None` if the cable is torn.
    out_m: Option<f64>,
}

/// What a cable on the floor means for a robot that drives beside it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Clearance {
    /// The robot may drive on.
    Free,
    /// The hull is about to reach the cable.
    InTheWay,
    /// More cable has come off the reel: it is caught, or not where it was believed to lie.
    DrawnOut {
        /// Length off the reel, metres.
        out_m: f64,
        /// The same at the order, metres.
        known_m: f64,
    },
}

impl Clearance {
    /// Why the robot must stop, as a sentence; `None` if it may drive on.
    pub(crate) fn trouble(self) -> Option<String> {
        match self {
            Self::Free => None,
            Self::InTheWay => Some("the hull is about to reach the tether that lies on the floor".into()),
            Self::DrawnOut { out_m, known_m } => Some(format!(
                "more tether comes off the reel: {out_m:.1} m are out, {known_m:.1} m were out at the order; it is caught, or \
                 does not lie where it was believed to lie"
            )),
        }
    }
}

impl Tether {
    /// Whether the cable lies on the floor: it is slack or torn, or the reel is too weak to take it up.
    pub fn is_left_lying(&self) -> bool {
        self.lying.is_some() || self.way_to_tauten().is_some() || self.is_reel_too_weak()
    }

    /// The way from the robot to a place beside the anchor, with `room_m` metres for the hull's centre, beside the cable on
    /// the floor; `None` if there is not enough room. Little slack is made taut first.
    ///
    /// Cost: at most a few hundred searches for a shortest path, most of them only if no way is found.
    pub fn way_beside(&self, world: &World, room_m: f64) -> Option<Vec<Point>> {
        let tauten = self.little_slack().unwrap_or_default();
        let start = tauten.last().copied().unwrap_or_else(|| self.cable.tip());
        let line = self.lies_along(world);
        let from_start = GAPS_M.into_iter().find_map(|gap_m| {
            let by_m = self.hull_m + gap_m;
            // Closer than this, the cable leads away from the robot on every way.
            let lying = shortened(&line, by_m + 0.05);
            if (start - self.config.anchor).norm() <= END_SHARES[0] * by_m || lying.len() < 2 {
                return Some(vec![start]);
            }
            self.search(world, room_m, by_m, start, &lying)
        })?;
        let mut path = vec![self.cable.tip()];
        path.extend(tauten.into_iter().chain(from_start));
        path.dedup_by(|next, before| (*next - *before).norm() < 1e-6);
        Some(path)
    }

    /// Cable beyond the taut line, metres, by the encoder of the reel; 0 if it is not measured.
    pub(crate) fn excess_m(&self) -> f64 {
        self.payout.measured_m().map_or(0.0, |out_m| (out_m - self.cable.length_m()).max(0.0))
    }

    /// The shortest way from a place to one beside the anchor that keeps `by_m` metres from a line and winds the cable
    /// round nothing.
    fn search(
        &self,
        world: &World,
        room_m: f64,
        by_m: f64,
        start: Point,
        lying: &[Point],
    ) -> Option<Vec<Point>> {
        let shapes: Vec<Shape> = world.obstacles.iter().map(|obstacle| obstacle.shape.clone()).collect();
        let cable = Shape::Polyline { points: lying.to_vec(), half_width_m: 0.0 };
        let solids = shapes.iter().map(|shape| (shape, room_m)).chain([(&cable, by_m)]);
        let floor = GrownFloor::new(&world.boundary, room_m, solids);
        let mut there = self.cable.clone();
        there.drag_to(start);
        let winds_nothing = |way: &[Point]| {
            let mut cable = there.clone();
            cable.drag_along(way);
            let straight_m = way.last().map_or(0.0, |end| (end - self.config.anchor).norm());
            cable.length_m() <= straight_m + ROUND_M
        };
        END_SHARES.into_iter().find_map(|share| {
            let ends = (0..DIRECTIONS).map(|k| {
                let away: Vector = unit_vector(TAU * f64::from(k) / f64::from(DIRECTIONS));
                self.config.anchor + away * (share * by_m)
            });
            let ways = ends.filter(|end| floor.spare_m(*end) > 0.0).filter_map(|end| {
                let mut steps = 0..MOST_STEPS;
                let way = floor.shortest(start, end, &mut || steps.next().is_some()).ok()?;
                Some((way.length_m, way.points()))
            });
            let mut ways: Vec<(f64, Vec<Point>)> = ways.collect();
            ways.sort_by(|a, b| a.0.total_cmp(&b.0));
            ways.into_iter().map(|(_, way)| way).find(|way| winds_nothing(way))
        })
    }

    /// The way on which little slack is made taut; `None` if there is none, or too much.
    fn little_slack(&self) -> Option<Vec<Point>> {
        let is_little = self.lying.is_none() && self.slack.loose_m() <= TAUTENED_M;
        self.way_to_tauten().filter(|_| is_little)
    }

    /// Where the cable lies when the robot begins to drive beside it, from the anchor to the robot.
    fn lies_along(&self, world: &World) -> Vec<Point> {
        let Some(mut laid) = self.laid.clone() else { return self.cable.taut_line() };
        if let (Some(way), Some(out_m)) = (self.little_slack(), self.payout.measured_m()) {
            for at in &way {
                laid.step(*at, out_m, world);
            }
        }
        laid.line()
    }

    /// Records where the cable lies. A torn cable stays as it was last, except where the robot draws it.
    pub(super) fn lay(&mut self, readings: &Readings, is_located: bool, world: &World) {
        let is_felt = readings.robot_pull_n.or(readings.reel_pull_n).is_some();
        let out_m = readings.paid_out_m.filter(|out_m| out_m.is_finite() && is_felt && is_located);
        let Some(out_m) = out_m else { return };
        let laid = self.laid.get_or_insert_with(|| Laid::along(&self.cable));
        let out_m = if self.torn.found().is_some() { laid.length_m() } else { out_m };
        laid.step(self.cable.tip(), out_m, world);
    }

    /// Notes that the robot begins to drive beside a cable that lies on the floor.
    pub(crate) fn leave_lying(&mut self) {
        self.lying = Some(Lying { out_m: self.payout.measured_m().filter(|_| self.torn().is_none()) });
    }

    /// Notes that the robot takes up its task again: the rules for a cable that is not torn apply again.
    pub(crate) fn forget_lying(&mut self) {
        self.lying = self.lying.take().filter(|_| self.torn().is_some());
    }

    /// What is left to do about the cable when the robot is back beside it, as the end of a sentence.
    pub(crate) fn lies_words(&self) -> String {
        let slack_m = self.excess_m();
        if self.torn().is_some() {
            "; the broken tether lies on the floor".into()
        } else if slack_m > SLACK_M {
            format!("; {slack_m:.1} m of slack tether lie on the floor: take them up by hand")
        } else {
            String::new()
        }
    }

    /// What a cable on the floor means for the robot now; `None` if the robot was not ordered to drive beside it.
    pub(crate) fn beside_lying(&self) -> Option<Clearance> {
        let lying = self.lying.as_ref()?;
        let drawn = lying.out_m.zip(self.payout.measured_m());
        let drawn = drawn.filter(|(known_m, out_m)| out_m - known_m > DRAWN_OUT_M);
        if let Some((known_m, out_m)) = drawn {
            return Some(Clearance::DrawnOut { out_m, known_m });
        }
        let still =
            self.laid.as_ref().map_or(&[][..], |laid| laid.without_end(3.0 * self.hull_m + GAPS_M[0]));
        let is_near = still.len() > 1 && polyline::distance_m(still, self.cable.tip()) < self.hull_m;
        Some(if is_near { Clearance::InTheWay } else { Clearance::Free })
    }
}

/// The part of a line before its last metres.
fn shortened(line: &[Point], by_m: f64) -> Vec<Point> {
    upto(line, polyline::length_m(line) - by_m)
}

/// The first metres of a line.
fn upto(line: &[Point], most_m: f64) -> Vec<Point> {
    let mut left_m = most_m;
    let mut part = Vec::new();
    for pair in line.windows(2) {
        if left_m <= 0.0 {
            break;
        }
        if part.is_empty() {
            part.push(pair[0]);
        }
        let length_m = (pair[1] - pair[0]).norm();
        let share = if length_m > left_m { left_m / length_m } else { 1.0 };
        part.push(pair[0] + (pair[1] - pair[0]) * share);
        left_m -= length_m;
    }
    part
}
