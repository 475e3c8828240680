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
const GAPS_M: [f64; 4] = [0.5, 0.8, 0.3, 0.2];
/// Distances of the end of the way from the anchor that are tried, as shares of the distance to the cable.
const END_SHARES: [f64; 3] = [1.02, 1.6, 2.5];
/// Number of directions from the anchor in which the way may end.
const DIRECTIONS: u32 = 24;
/// Slack up to which the robot first goes back the way it came until the cable pulls, metres. More of it lies in loops
/// across that way.
const TAUTENED_M: f64 = 0.5;
/// Distance by which the robot and the cable may move while the robot is held, metres, before the finding counts as new: the
/// noise of position and encoder.
const SAME_M: f64 = 0.1;
/// Length by which more cable may come off the reel on the way than was out at the order, metres: the cable is made taut
/// first.
const DRAWN_OUT_M: f64 = 0.3;
/// Length by which less cable may be off the reel than at the order, metres: more shows that the reel takes it up, and that it
/// does not lie where it lay.
const TAKEN_UP_M: f64 = 0.15;
/// Cable out beyond the taut line up to which it counts as following the robot, metres.
const FOLLOWS_M: f64 = 0.3;
/// Room, metres, that a way must leave beside the hull to the cable as it is expected to lie then.
const SPARE_M: f64 = 0.1;
/// Room, metres, beside the hull to the cable that a stopped reel has left, below which a robot under way is held. It is larger
/// than the room from which the search for a way beside the cable can begin (0.2 m), also after the distance of a tick and with the
/// points that are left out of the line of the cable.
const HELD_BEFORE_M: f64 = 0.28;
/// Share of the reel's pull up to which the pull that a taut cable needs lets a weak reel take it up suddenly: the cable does
/// not lie along the taut line then.
const SUDDEN: f64 = 1.3;
/// Distance between the places of a way at which a weak reel is imagined to take the cable up, in steps of the way.
const SUDDEN_STEPS: usize = 6;
/// Number of the shortest ways to each ring of ends that are tried against the moving cable.
const TRIED: usize = 3;
/// Cable by the encoder beyond the taut line, metres, above which it counts as still out at the anchor.
const STILL_OUT_M: f64 = 0.5;
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
pub enum Clearance {
    /// The robot may drive on.
    Free,
    /// The hull is about to reach the cable.
    InTheWay,
    /// The reel takes cable up again: the cable moves.
    TakenUp {
        /// Length off the reel, metres.
        out_m: f64,
        /// The same at the order, metres.
        known_m: f64,
    },
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
    pub fn trouble(self) -> Option<String> {
        match self {
            Self::Free => None,
            Self::InTheWay => Some(
                "hull about to reach the lying tether: it is nearer than it was believed to be; order the drive back again, \
                 or fetch the robot by hand"
                    .into(),
            ),
            Self::TakenUp { out_m, known_m } => Some(format!(
                "the reel takes the tether up again: {out_m:.1} m are out, {known_m:.1} m were out at the order, so the tether \
                 on the floor moves; wait until it rests, then order the drive back again"
            )),
            Self::DrawnOut { out_m, known_m } => Some(format!(
                "more tether comes off the reel: {out_m:.1} m are out, {known_m:.1} m were out at the order; it is caught, or \
                 does not lie where it was believed to lie"
            )),
        }
    }
}

impl Tether {
    /// Whether the cable lies on the floor, or will on the way home: it is slack or torn, or the reel has stopped or is too weak
    /// to take it up. Without a sensor of the pull, a cable that may be caught may also be slack.
    pub fn is_left_lying(&self) -> bool {
        self.lying.is_some()
            || self.way_to_tauten().is_some()
            || self.is_reel_too_weak()
            || self.take_up.has_stopped()
            || (self.is_snagged() && self.may_be_slack())
    }

    /// Whether the reel is known to have stopped.
    pub(crate) fn has_reel_stopped(&self) -> bool {
        self.take_up.has_stopped()
    }

    /// Whether a robot that drives straight on to a place comes near the cable that a stopped reel has left on the floor.
    pub(crate) fn is_left_before(&self, to: Point, world: &World) -> bool {
        let has_left = self.take_up.has_stopped() && self.torn().is_none();
        let (laid, out_m) = (self.laid.as_ref().filter(|_| has_left), self.payout.measured_m());
        laid.zip(out_m)
            .is_some_and(|(laid, out_m)| laid.is_approached(to, out_m, (self.hull_m, HELD_BEFORE_M), world))
    }

    /// Whether only the weakness of the reel keeps the cable on the floor.
    pub(crate) fn is_only_weak(&self) -> bool {
        self.is_reel_too_weak() && !self.take_up.has_stopped() && self.torn().is_none()
    }

    /// Whether a cable that seems caught may be slack instead, because a vehicle has no sensor of the pull.
    pub(super) fn may_be_slack(&self) -> bool {
        self.is_live && self.slack.measured().is_none()
    }

    /// Whether the finding is still that of another moment: while the robot is held, the way that was offered stays the way that
    /// is driven.
    pub(crate) fn is_as_before(&self, before: &Self) -> bool {
        let out_m = |tether: &Self| tether.payout.measured_m().unwrap_or(0.0);
        let finding =
            |tether: &Self| (tether.torn().is_some(), tether.take_up.has_stopped(), tether.is_snagged());
        (self.cable.tip() - before.cable.tip()).norm() < SAME_M
            && (out_m(self) - out_m(before)).abs() < SAME_M
            && finding(self) == finding(before)
            && self.lying == before.lying
    }

    /// Whether a hull that drives along a way comes onto no part of the cable on the floor, as far as the console can tell:
    /// neither as it lies and folds behind the robot, nor while a weak reel suddenly takes it up.
    pub(crate) fn is_clear(&self, way: &[Point], world: &World) -> bool {
        let Some(laid) = &self.laid else { return true };
        let (hull_m, out_m) = (self.hull_m + SPARE_M, self.payout.measured_m().unwrap_or(laid.length_m()));
        let strong_n = self.config.reel.filter(|_| self.torn().is_none() && !self.take_up.has_stopped());
        let strong_n = strong_n.map(|reel| SUDDEN * reel.pull_n);
        let (mut taut, mut steps) = (self.cable.clone(), 0..);
        laid.is_clear_along(way, out_m, hull_m, world, |laid| {
            taut.drag_to(laid.tip());
            let is_looked_at = steps.next().is_some_and(|step: usize| step.is_multiple_of(SUDDEN_STEPS));
            let needed_n = || {
                self.config.reel.map_or(0.0, |reel| taut.pull_at_anchor_n(reel.drag(self.config.friction)))
            };
            let may_move = is_looked_at && strong_n.is_some_and(|strong_n| needed_n() <= strong_n);
            !may_move || laid.is_clear_while_taken_up(taut.length_m(), hull_m, world)
        })
    }

    /// Why tether counts as still out at the anchor by the encoder alone, as a sentence; `None` if it is reeled in, or known to
    /// be slack.
    pub(crate) fn left_by_encoder(&self) -> Option<String> {
        let left_m = self.excess_m();
        let is_known = self.slack.measured().is_some() && self.lying.is_some();
        (self.torn().is_none() && !is_known && left_m > STILL_OUT_M).then(|| {
            format!("{left_m:.1} m of tether are still out by the encoder of the reel: take them up by hand")
        })
    }

    /// The way from the robot to a place beside the anchor, with `room_m` metres for the hull's centre, beside the cable on
    /// the floor; `None` if there is not enough room. Little slack is made taut first.
    ///
    /// Cost: at most a few hundred searches for a shortest path, most of them only if no way is found.
    pub fn way_beside(&self, world: &World, room_m: f64) -> Option<Vec<Point>> {
        let tauten = self.little_slack();
        // Cable that was dragged off a stopped reel is not made taut by going back: the robot may have come along its own
        // cable.
        let from_here = (tauten.is_none() || self.take_up.has_stopped()).then(Vec::new);
        tauten.into_iter().chain(from_here).find_map(|tauten| self.way_beside_after(&tauten, world, room_m))
    }

    /// The same, after a way on which little slack is made taut.
    fn way_beside_after(&self, tauten: &[Point], world: &World, room_m: f64) -> Option<Vec<Point>> {
        let start = tauten.last().copied().unwrap_or_else(|| self.cable.tip());
        let line = self.lies_after(tauten, world);
        GAPS_M.into_iter().find_map(|gap_m| {
            let by_m = self.hull_m + gap_m;
            // Closer than this, the cable leads away from the robot on every way.
            let lying = shortened(&line, by_m + 0.05);
            let whole = |way: Vec<Point>| {
                let mut path = vec![self.cable.tip()];
                path.extend(tauten.iter().copied().chain(way));
                path.dedup_by(|next, before| (*next - *before).norm() < 1e-6);
                Some(path).filter(|path| self.is_clear(path, world))
            };
            if (start - self.config.anchor).norm() <= END_SHARES[0] * by_m {
                return whole(vec![start]);
            }
            self.search(world, room_m, by_m, start, &lying, whole)
        })
    }

    /// Cable beyond the taut line, metres, by the encoder of the reel; 0 if it is not measured.
    pub(crate) fn excess_m(&self) -> f64 {
        self.payout.measured_m().map_or(0.0, |out_m| (out_m - self.cable.length_m()).max(0.0))
    }

    /// The shortest way from a place to one beside the anchor that keeps `by_m` metres from a line, winds the cable round
    /// nothing, and that `whole` accepts and completes.
    fn search(
        &self,
        world: &World,
        room_m: f64,
        by_m: f64,
        start: Point,
        lying: &[Point],
        whole: impl Fn(Vec<Point>) -> Option<Vec<Point>>,
    ) -> Option<Vec<Point>> {
        let shapes: Vec<Shape> = world.obstacles.iter().map(|obstacle| obstacle.shape.clone()).collect();
        let cable = Shape::Polyline { points: lying.to_vec(), half_width_m: 0.0 };
        let solids =
            shapes.iter().map(|shape| (shape, room_m)).chain((lying.len() > 1).then_some((&cable, by_m)));
        let floor = GrownFloor::new(&world.boundary, room_m, solids);
        let mut there = self.cable.clone();
        there.drag_to(start);
        let is_torn = self.torn().is_some();
        let winds_nothing = |way: &[Point]| {
            // Nothing leads from a torn cable to the anchor any more.
            if is_torn {
                return true;
            }
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
            ways.into_iter().map(|(_, way)| way).filter(|way| winds_nothing(way)).take(TRIED).find_map(&whole)
        })
    }

    /// The way on which little slack is made taut; `None` if there is none, or too much.
    fn little_slack(&self) -> Option<Vec<Point>> {
        let is_little = self.lying.is_none() && self.slack.loose_m() <= TAUTENED_M;
        self.way_to_tauten().filter(|_| is_little)
    }

    /// Where the cable lies, from the anchor to the robot, when the robot has driven a way.
    fn lies_after(&self, way: &[Point], world: &World) -> Vec<Point> {
        let Some(mut laid) = self.laid.clone() else { return self.cable.taut_line() };
        let out_m = self.payout.measured_m().unwrap_or_else(|| laid.length_m());
        for at in way {
            laid.step(*at, out_m, world);
        }
        laid.line()
    }

    /// Records where the cable lies. While cable is missing, the length off the reel says nothing about the cable at the robot,
    /// which keeps its length. Of a torn cable, only the piece at the robot lies there: as long as the cable was, less what the
    /// reel has drawn in since.
    pub(super) fn lay(&mut self, readings: &Readings, is_located: bool, world: &World) {
        let is_felt = self.is_live || readings.robot_pull_n.or(readings.reel_pull_n).is_some();
        let out_m = readings.paid_out_m.filter(|out_m| out_m.is_finite() && is_felt && is_located);
        let Some(out_m) = out_m else { return };
        let laid = self.laid.get_or_insert_with(|| Laid::along(&self.cable));
        if self.torn.found().is_some() {
            let whole_m = *self.whole_m.get_or_insert(laid.length_m());
            laid.tear(whole_m - self.torn.drawn_m());
        }
        let out_m = if self.torn.is_missing() { laid.length_m() } else { out_m };
        laid.step(self.cable.tip(), out_m, world);
    }

    /// Notes that the robot begins to drive beside a cable that lies on the floor.
    pub fn leave_lying(&mut self) {
        self.lying = Some(Lying { out_m: self.payout.measured_m().filter(|_| self.torn().is_none()) });
    }

    /// A cable that follows the robot lies along the taut line, and its length may fall: it is the measure for what comes after.
    pub(super) fn follow_lying(&mut self) {
        let follows = self.excess_m() <= FOLLOWS_M;
        // A reel that is seen to pull, and that is strong enough from here, has taken up what lay on the floor.
        let works = self.take_up.is_seen_to_pull() && !self.is_reel_too_weak() && self.slack.loose_m() == 0.0;
        if follows && works && self.torn().is_none() {
            self.lying = None;
        }
        let out_m = self.payout.measured_m().filter(|_| follows);
        if let (Some(lying), Some(out_m)) = (&mut self.lying, out_m) {
            lying.out_m = lying.out_m.map(|known_m| known_m.min(out_m));
        }
    }

    /// Notes that the robot takes up its task again: the rules for a cable that is not torn apply again.
    pub fn forget_lying(&mut self) {
        self.lying = self.lying.take().filter(|_| self.torn().is_some());
    }

    /// What is left to do about the cable when the robot is back beside it, as the end of a sentence.
    pub(crate) fn lies_words(&self) -> String {
        let slack_m = self.excess_m();
        if self.torn().is_some() {
            "; the broken tether lies on the floor".into()
        } else if self.left_by_encoder().is_some() {
            // The outcome says so.
            String::new()
        } else if slack_m > SLACK_M {
            format!("; {slack_m:.1} m of slack tether lie on the floor: take them up by hand")
        } else {
            String::new()
        }
    }

    /// What a cable on the floor means for the robot now; `None` if the robot was not ordered to drive beside it.
    pub fn beside_lying(&self) -> Option<Clearance> {
        let lying = self.lying.as_ref()?;
        if let Some((known_m, out_m)) = lying.out_m.zip(self.payout.measured_m()) {
            if out_m - known_m > DRAWN_OUT_M {
                return Some(Clearance::DrawnOut { out_m, known_m });
            }
            if known_m - out_m > TAKEN_UP_M {
                return Some(Clearance::TakenUp { out_m, known_m });
            }
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
