//! Finds the trap that holds the robot, and chooses the way out.

use super::{CHOICE_MOST, Machine, News, Next, Phase, ROUNDS, Retreat};
use crate::{
    escape::Escape,
    mouth::Mouth,
    outline::{Follow, Outline},
    settings::{MachineSettings, Mode},
    thought,
    view::View,
};
use std::{cmp::Ordering, f64::consts::PI};
use steering::{Forces, Side, Solid};
use world::{Point, Vector};

/// Distance ahead within which the nearest solid on the way to the goal is sought, as a multiple of the law's range.
const AHEAD_RANGES: f64 = 2.0;
/// Distance from an earlier escape within which a new escape counts as another attempt at the same trap, metres.
const SAME_PLACE_M: f64 = 1.5;
/// Progress towards the goal, for each earlier attempt, after which a further attempt ends, metres. It is measured from
/// the place where the attempt began.
const GAIN_M: f64 = 1.0;
/// Tolerance for rounding when a path is compared with its margin, metres.
const ROUNDING_M: f64 = 1e-6;

impl Machine {
    pub(super) fn leave_trap(&mut self, at: Point, goal: Point) {
        if self.settings.mode != Mode::Literal && self.is_held_by_wall(at, goal) {
            return self.follow_outlines(at, goal);
        }
        let Some(culprit) = self.culprit(at, goal) else { return };
        let attempts = self.began.iter().filter(|(place, _)| (place - at).norm() < SAME_PLACE_M).count();
        let members = if attempts == 0 { self.clusters.members(culprit) } else { self.all_near(at, culprit) };
        let gap_rad = |from: Point| {
            View::of(from, &self.map, &members, self.map.hull_m).map_or(2.0 * PI, |view| view.gap_rad)
        };
        if gap_rad(at) >= PI || gap_rad(goal) < PI {
            // If the goal is in the same trap, the trap is not sealed: the robot finds the goal along the outline.
            let hugs = gap_rad(at) < PI;
            self.go_round(at, goal, members, hugs);
            return;
        }
        self.news.push(News::Retreats { at });
        self.retreats += 1;
        let view = View::of(at, &self.map, &members, self.map.hull_m);
        let mouth = view.and_then(|view| Mouth::seen(at, &view));
        let ids = members.iter().map(|index| self.map.solids[*index].id).collect();
        self.phase = Phase::Retreat(Retreat { ids, members, mouth, looked: None });
    }

    /// All solids that push the robot back here, with their clusters. The field may have a minimum between two groups
    /// even though the robot would fit between them.
    fn all_near(&self, at: Point, culprit: usize) -> Vec<usize> {
        let reach_m = self.settings.law.rho_m + self.map.hull_m;
        let near = self.map.solids.iter().filter(|s| s.distance(at).0 < reach_m);
        let ids = near.chain([&self.map.solids[culprit]]).map(|s| s.id).collect();
        self.clusters.closure(&self.map, &ids)
    }

    /// Whether the wall holds the robot, directly or through obstacles connected to it.
    fn is_held_by_wall(&mut self, at: Point, goal: Point) -> bool {
        let culprit = self.culprit(at, goal).map(|index| &self.map.solids[index]);
        let rank = self.rank(at, goal);
        let solid = culprit.map(|solid| (solid.id, rank(solid)));
        let outline = self.outline();
        let Some(wall) = outline.walls().map(rank).min_by(by_rank) else { return false };
        solid.is_none_or(|(id, solid)| outline.holds(id) || by_rank(&wall, &solid).is_lt())
    }

    /// The solid that holds the robot: the first one on the way to the goal within twice the range, or else the
    /// nearest.
    fn culprit(&self, at: Point, goal: Point) -> Option<usize> {
        let rank = self.rank(at, goal);
        let ranks = self.map.solids.iter().map(rank).enumerate();
        ranks.min_by(|a, b| by_rank(&a.1, &b.1)).map(|(index, _)| index)
    }

    /// Whether a solid is clear of the path to the goal, and its distance from the robot, metres.
    fn rank(&self, at: Point, goal: Point) -> impl Fn(&Solid) -> (bool, f64) + use<> {
        let ahead = at + (goal - at).cap_magnitude(AHEAD_RANGES * self.settings.law.rho_m);
        let hull_m = self.map.hull_m;
        move |solid| (solid.segment_distance_m(at, ahead, hull_m) >= hull_m, solid.distance(at).0)
    }

    fn outline(&mut self) -> &mut Outline {
        let MachineSettings { margin_m, step_m, .. } = self.settings;
        let reach_m = self.map.hull_m + margin_m + step_m;
        self.outline.get_or_insert_with(|| Outline::new(&self.map, &self.clusters, margin_m, reach_m))
    }

    /// Follows the outlines from here to the goal.
    pub fn follow_outlines(&mut self, at: Point, goal: Point) {
        let MachineSettings { mode, keep_m, margin_m, taut_margin_m, .. } = self.settings;
        let hull_m = self.map.hull_m;
        // A path that is pulled taut may use every gap in which it keeps its margin; a robot in flight needs more
        // space.
        let most_m = if mode == Mode::Pre { taut_margin_m + ROUNDING_M } else { margin_m };
        let follow = Follow::new(goal, self.outline(), Side::Left, hull_m + keep_m, hull_m + most_m);
        self.phase = Phase::Follow(follow);
        self.news.push(News::Follows { at });
        self.count_escape(at);
    }

    pub(super) fn along_outlines(&mut self, at: Point, goal: Point) -> Next {
        self.outline();
        let (Phase::Follow(follow), Some(outline)) = (&mut self.phase, &mut self.outline) else {
            return Next::Nowhere;
        };
        let mut before = follow.clone();
        let mut step = follow.step(at, goal, outline, self.settings.step_m);
        if follow.meets_something(&before, at) && self.rolls_out() {
            before.met = Some(at);
            self.phase = Phase::Follow(before);
            let side = self.shorter_side(at, goal);
            self.take_side(side);
            let (Phase::Follow(follow), Some(outline)) = (&mut self.phase, &mut self.outline) else {
                return Next::Nowhere;
            };
            step = follow.step(at, goal, outline, self.settings.step_m);
        }
        let Some(step) = step else {
            self.news.push(News::GivesUp { at, escapes: self.escapes });
            self.phase = Phase::Stuck;
            return Next::Nowhere;
        };
        let way = step.try_normalize(1e-12).unwrap_or_else(Vector::zeros);
        self.forces = Forces { rotation: way * self.settings.law.k_rep, ..Forces::default() };
        Next::By(step)
    }

    pub(super) fn go_round(&mut self, at: Point, goal: Point, members: Vec<usize>, hugs: bool) {
        let mut escape = Escape::new(&self.map, members, Side::Left);
        if hugs {
            escape.hug();
        }
        let is_here = |(place, _): &&(Point, Side)| (place - at).norm() < SAME_PLACE_M;
        let attempts = self.began.iter().filter(is_here).count();
        let before = self.began.iter().rfind(is_here).map(|(_, side)| *side);
        if attempts > 0 {
            escape.gain((goal - at).norm() - GAIN_M * attempts as f64);
        }
        self.oscillation.forget_for((ROUNDS * escape.round_m() / self.settings.step_m) as usize);
        self.phase = Phase::Escape(escape);
        self.count_escape(at);
        let side = before.map_or_else(|| self.first_side(at, goal), Side::other);
        self.began.push((at, side));
        self.take_side(side);
        if let Phase::Escape(escape) = &self.phase {
            self.news.push(News::Escapes { at, side: escape.side });
        }
    }

    /// The left side, as in the paper, or the side with the shorter simulated detour.
    fn first_side(&mut self, at: Point, goal: Point) -> Side {
        let goes_round = self.going_round().is_some();
        if goes_round && self.rolls_out() { self.shorter_side(at, goal) } else { Side::Left }
    }

    fn shorter_side(&mut self, at: Point, goal: Point) -> Side {
        let (side, steps) = thought::shorter_side(self, at, goal, self.thought_left.min(CHOICE_MOST));
        self.thought_left = self.thought_left.saturating_sub(steps);
        side
    }

    /// Whether both sides are simulated before one is chosen.
    fn rolls_out(&self) -> bool {
        matches!(self.settings.mode, Mode::Rollout | Mode::Pre) && !self.in_thought && self.thought_left > 0
    }

    pub(super) fn count_escape(&mut self, at: Point) {
        self.escapes += 1;
        if self.escapes > self.settings.escapes_max {
            self.news.push(News::GivesUp { at, escapes: self.escapes - 1 });
            self.phase = Phase::Stuck;
        }
    }
}

fn by_rank(a: &(bool, f64), b: &(bool, f64)) -> Ordering {
    a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))
}
