//! Going around a trap.

use crate::{clusters::Clusters, settings::Mode, view::View};
use std::{collections::BTreeSet, f64::consts::PI};
use steering::{KnownMap, Side, solid::disc_around, tangents};
use world::{Point, Vector};

/// Distance after which the hull of the group is recomputed, metres.
const LOOK_M: f64 = 0.25;
/// Distance ahead, on the way to the tangent point, beyond which solids are ignored for now, metres.
const AHEAD_M: f64 = 4.0;
/// Rate at which the distance to the group is corrected as the robot goes around it, per metre.
const HUG_PER_M: f64 = 2.0;
/// Number of times around the group after which its outline is followed closely, because the way out must be in one of
/// its bays.
const ROUNDS: f64 = 1.3;

/// A group of solids that the robot goes around.
#[derive(Debug, Clone)]
pub struct Escape {
    /// Ids of the obstacles and virtual circles in the group.
    pub ids: BTreeSet<u32>,
    /// The side on which the group is passed.
    pub side: Side,
    /// The members of the group as indices into the map.
    members: Vec<usize>,
    circle: (Point, f64),
    hugs: bool,
    until_m: f64,
    walked_m: f64,
    looked: Option<(Point, Look)>,
    checked_m: f64,
    /// The member that last blocked the straight path to the goal; it is checked first.
    barring: usize,
}

#[derive(Debug, Clone, Copy)]
enum Look {
    /// Outside the hull of the group: the corner at the end of the group, as seen by the robot.
    Toward((Point, f64)),
    /// Inside a bay.
    Within,
}

impl Escape {
    /// Starts going around the clusters of these solids.
    pub fn new(map: &KnownMap, members: Vec<usize>, side: Side) -> Self {
        let mut escape = Self {
            ids: members.iter().map(|index| map.solids[*index].id).collect(),
            side,
            members,
            circle: (Point::origin(), 0.0),
            hugs: false,
            until_m: f64::INFINITY,
            walked_m: 0.0,
            looked: None,
            checked_m: 0.0,
            barring: 0,
        };
        escape.measure(map);
        escape
    }

    /// Finds the members again after the map has changed.
    pub fn regroup(&mut self, map: &KnownMap, clusters: &Clusters) {
        self.members = clusters.closure(map, &self.ids);
        self.measure(map);
    }

    /// Follows every bay of the outline from now on.
    pub fn hug(&mut self) {
        self.hugs = true;
    }

    /// Makes the detour continue until the robot is closer to the goal than this, metres.
    pub fn gain(&mut self, until_m: f64) {
        self.until_m = until_m;
    }

    /// Changes to the other side.
    pub fn turn_back(&mut self) {
        self.side = self.side.other();
        self.looked = None;
    }

    /// The circle around the group, for drawing.
    pub fn circle(&self) -> (Point, f64) {
        self.circle
    }

    /// The circumference of the circle around the group, metres.
    pub fn round_m(&self) -> f64 {
        2.0 * PI * self.circle.1
    }

    /// Whether the straight path to the goal clears the group; checked every few centimetres.
    pub fn is_over(&mut self, at: Point, goal: Point, map: &KnownMap, margin_m: f64, step_m: f64) -> bool {
        self.walked_m += step_m;
        if self.walked_m < self.checked_m {
            return false;
        }
        self.checked_m = self.walked_m + 0.05;
        if self.walked_m > ROUNDS * self.round_m() {
            self.hugs = true;
        }
        let keep_m = map.hull_m + margin_m;
        (goal - at).norm() < self.until_m && !self.is_barred(at, goal, map, keep_m)
    }

    /// Whether a member is closer than this to the straight path.
    fn is_barred(&mut self, at: Point, goal: Point, map: &KnownMap, keep_m: f64) -> bool {
        let bars = |m: &usize| map.solids[*m].segment_distance_m(at, goal, keep_m) < keep_m;
        if self.members.get(self.barring).is_some_and(bars) {
            return true;
        }
        let first = self.members.iter().position(bars);
        self.barring = first.unwrap_or(self.barring);
        first.is_some()
    }

    /// The unit vector along the way around the group.
    pub fn direction(
        &mut self,
        at: Point,
        mode: Mode,
        map: &KnownMap,
        clusters: &Clusters,
        margin_m: f64,
    ) -> Vector {
        if mode == Mode::Literal && !self.hugs {
            let (center, radius_m) = self.circle;
            return tangents::to_disc(at, center, radius_m + map.hull_m, self.side).direction;
        }
        if self.hugs {
            return self.along_nearest(at, map, margin_m);
        }
        let reach_m = map.hull_m + margin_m;
        match self.look(at, map, clusters, margin_m) {
            Look::Toward((corner, radius_m)) => {
                tangents::to_disc(at, corner, radius_m + reach_m, self.side).direction
            }
            Look::Within => self.along_nearest(at, map, margin_m),
        }
    }

    fn look(&mut self, at: Point, map: &KnownMap, clusters: &Clusters, margin_m: f64) -> Look {
        if let Some((from, look)) = self.looked
            && (from - at).norm_squared() < LOOK_M * LOOK_M
        {
            return look;
        }
        let mut look = self.look_once(at, map, margin_m);
        for _ in 0..4 {
            let Look::Toward(corner) = look else { break };
            let Some(blocker) = self.blocker(at, corner, map, margin_m) else { break };
            for index in clusters.members(blocker) {
                self.ids.insert(map.solids[index].id);
                if !self.members.contains(&index) {
                    self.members.push(index);
                }
            }
            self.measure(map);
            look = self.look_once(at, map, margin_m);
        }
        self.looked = Some((at, look));
        look
    }

    fn look_once(&self, at: Point, map: &KnownMap, margin_m: f64) -> Look {
        let reach_m = map.hull_m + margin_m;
        // Slightly less than the margin that is kept, so that a robot beside the hull is considered to be outside.
        match View::of(at, map, &self.members, 0.9 * reach_m) {
            Some(view) if view.gap_rad >= PI => Look::Toward(view.edge(self.side).corner),
            _ => Look::Within,
        }
    }

    /// Finds another solid on the way to the tangent point.
    fn blocker(&self, at: Point, corner: (Point, f64), map: &KnownMap, margin_m: f64) -> Option<usize> {
        let reach_m = map.hull_m + margin_m;
        let tangent = tangents::to_disc(at, corner.0, corner.1 + reach_m, self.side);
        let touch = at + tangent.direction * tangent.length_m.min(AHEAD_M);
        let keep_m = map.hull_m + 0.5 * margin_m;
        let mut is_member = vec![false; map.solids.len()];
        self.members.iter().for_each(|index| is_member[*index] = true);
        let others = (0..map.solids.len()).filter(|index| !is_member[*index]);
        others
            .map(|index| (index, map.solids[index].segment_distance_m(at, touch, keep_m)))
            .filter(|(_, distance_m)| *distance_m < keep_m)
            .min_by(|a, b| a.1.total_cmp(&b.1))
            .map(|(index, _)| index)
    }

    /// The direction along the outline of the nearest member, at the margin.
    fn along_nearest(&self, at: Point, map: &KnownMap, margin_m: f64) -> Vector {
        let distances = self.members.iter().map(|index| map.solids[*index].distance(at));
        let nearest = distances.min_by(|a, b| a.0.total_cmp(&b.0));
        let Some((outline_m, away)) = nearest else { return Vector::x() };
        let off_m = outline_m - map.hull_m - margin_m;
        let correction = (-HUG_PER_M * off_m).clamp(-1.0, 1.0);
        (self.side.along(away) + away * correction).normalize()
    }

    fn measure(&mut self, map: &KnownMap) {
        let corners: Vec<_> =
            self.members.iter().flat_map(|m| map.solids[*m].corners().iter().copied()).collect();
        self.circle = if corners.is_empty() { (Point::origin(), 0.0) } else { disc_around(&corners) };
        self.looked = None;
    }
}
