//! The state machine: approach, retreat, seal, escape (Xu et al. 2022, section 4).

use crate::{
    clusters::Clusters,
    escape::Escape,
    mouth::{FIRST_VIRTUAL, Mouth, is_virtual},
    settings::{MachineSettings, Mode},
    thought,
    view::View,
};
use field::{Sides, oscillation::Oscillation};
use geometry::Braking;
use std::{collections::BTreeSet, f64::consts::PI};
use steering::{Body, Contact, Forces, KnownMap, Nearby, Side, Solid, guard, wall_contacts};
use world::{Point, Vector};

/// The nearest solid on the way to the goal is looked for this far ahead, as a multiple of the law's range.
const AHEAD_RANGES: f64 = 2.0;

/// An escape that begins this near to an earlier one is another attempt at the same, metres.
const SAME_PLACE_M: f64 = 1.5;
/// Another attempt goes on until it is this much nearer to the goal than where it began, metres.
const GAIN_M: f64 = 1.0;

/// A way round may take this many times the circle about the group before it counts as leading nowhere.
const ROUNDS: f64 = 2.5;
/// On the way back the trap is examined again after this distance, metres.
const LOOK_BACK_M: f64 = 0.05;
/// A robot in thought stops at once.
const IN_THOUGHT: Braking = Braking { acceleration_m_per_s2: 1e3, tick_s: 0.0 };

/// What the machine is doing.
#[derive(Debug, Clone)]
pub enum Phase {
    /// Moving by the field.
    Approach,
    /// Going back along its own way, out of a trap.
    Retreat(Retreat),
    /// Going round what trapped it.
    Escape(Escape),
    /// Given up.
    Stuck,
}

/// A retreat under way.
#[derive(Debug, Clone)]
pub struct Retreat {
    ids: BTreeSet<u32>,
    members: Vec<usize>,
    mouth: Option<Mouth>,
    looked: Option<Point>,
}

/// Where to move next.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Next {
    /// By this much at most a step, metres.
    By(Vector),
    /// Back to a place of the own way.
    Back(Point),
    /// Nowhere: it has given up.
    Nowhere,
}

/// Something that the operator wants to know.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum News {
    /// The field oscillates in a trap: it goes back.
    Retreats {
        /// Where.
        at: Point,
    },
    /// The mouth was closed.
    Sealed {
        /// With so many virtual circles.
        circles: usize,
    },
    /// It goes round.
    Escapes {
        /// Where from.
        at: Point,
        /// On this side.
        side: Side,
    },
    /// The way to the goal is clear of what was gone round.
    Resumes {
        /// Where.
        at: Point,
    },
    /// It has tried often enough.
    GivesUp {
        /// Where.
        at: Point,
        /// After so many escapes.
        escapes: u32,
    },
}

/// The planner's whole state on a map.
#[derive(Debug, Clone)]
pub struct Machine {
    /// What it is set to.
    pub settings: MachineSettings,
    /// The map, virtual circles included.
    pub map: KnownMap,
    /// The forces of the last step.
    pub forces: Forces,
    /// How often it has retreated.
    pub retreats: u32,
    /// How often it has gone round something.
    pub escapes: u32,
    /// What happened since somebody last took it out.
    pub news: Vec<News>,
    phase: Phase,
    clusters: Clusters,
    trail: Vec<Point>,
    began: Vec<(Point, Side)>,
    oscillation: Oscillation,
    nearby: Nearby,
    sides: Sides,
    next_id: u32,
    /// Whether this is a rollout: it asks for no further ones.
    in_thought: bool,
}

impl Machine {
    /// A machine that has not moved yet.
    pub fn new(settings: MachineSettings, map: KnownMap) -> Self {
        let next_id = map.solids.iter().filter(|s| is_virtual(s)).map(|s| s.id + 1).max();
        Self {
            clusters: Clusters::new(&map, settings.margin_m),
            oscillation: Oscillation::new(settings.window_m, settings.step_m),
            nearby: Nearby::new(settings.law.rho_m + map.hull_m),
            sides: Sides::default(),
            forces: Forces::default(),
            phase: Phase::Approach,
            trail: Vec::new(),
            began: Vec::new(),
            retreats: 0,
            escapes: 0,
            news: Vec::new(),
            next_id: next_id.unwrap_or(FIRST_VIRTUAL),
            in_thought: false,
            settings,
            map,
        }
    }

    /// The same machine in thought: it takes coarser steps, remembers no way back and keeps to a side.
    #[must_use]
    pub fn thought(&self, step_m: f64) -> Self {
        let mut thought = self.clone();
        thought.settings.step_m = step_m;
        thought.oscillation = Oscillation::new(thought.settings.window_m, step_m);
        thought.forces = Forces::default();
        thought.news.clear();
        thought.trail.clear();
        thought.nearby.forget();
        thought.sides.forget();
        thought.in_thought = true;
        thought
    }

    /// What it is doing.
    pub fn phase(&self) -> &Phase {
        &self.phase
    }

    /// Makes it go round on a side instead, if it is going round anything.
    pub fn take_side(&mut self, side: Side) {
        if let Phase::Escape(escape) = &mut self.phase
            && escape.side != side
        {
            escape.turn_back();
        }
    }

    /// The circles that it made up.
    pub fn virtual_circles(&self) -> impl Iterator<Item = (Point, f64)> + '_ {
        self.map.solids.iter().filter(|s| is_virtual(s)).map(|s| (s.center, s.radius_m))
    }

    /// Takes what is sensed; the group being gone round is recomputed if that changes the map.
    pub fn learn(&mut self, bodies: &[Body]) {
        if self.map.learn(bodies) {
            self.map_changed();
        }
    }

    /// Takes off the map what was found to move.
    pub fn forget(&mut self, movers: &[u32]) {
        if self.map.forget(movers) {
            self.map_changed();
        }
    }

    fn map_changed(&mut self) {
        self.clusters = Clusters::new(&self.map, self.settings.margin_m);
        self.nearby.forget();
        self.sides.forget();
        match &mut self.phase {
            Phase::Retreat(retreat) => retreat.members = self.clusters.closure(&self.map, &retreat.ids),
            Phase::Escape(escape) => escape.regroup(&self.map, &self.clusters),
            Phase::Approach | Phase::Stuck => {}
        }
    }

    /// Decides the next step of a robot at a place that is bound for a goal.
    pub fn next(&mut self, at: Point, goal: Point) -> Next {
        if let Phase::Retreat(_) = self.phase {
            return self.retreat(at, goal);
        }
        let oscillates = self.oscillation.record(at, (goal - at).norm());
        if oscillates {
            self.answer_oscillation(at, goal);
        }
        self.trail.push(at);
        match &mut self.phase {
            Phase::Escape(escape) => {
                let (map, margin_m) = (&self.map, self.settings.margin_m);
                if escape.is_over(at, goal, map, margin_m, self.settings.step_m) {
                    self.news.push(News::Resumes { at });
                    self.phase = Phase::Approach;
                    self.oscillation.forget();
                    return self.approach(at, goal);
                }
                let way = escape.direction(at, self.settings.mode, map, &self.clusters, margin_m);
                self.forces = Forces { rotation: way * self.settings.law.k_rep, ..Forces::default() };
                self.step_along(at, way, self.settings.step_m)
            }
            Phase::Stuck => Next::Nowhere,
            Phase::Approach | Phase::Retreat(_) => self.approach(at, goal),
        }
    }

    fn approach(&mut self, at: Point, goal: Point) -> Next {
        let (map, nearby) = (&self.map, &mut self.nearby);
        self.forces = self.settings.law.forces(at, goal, map, nearby, &mut self.sides);
        let missing_m = (goal - at).norm();
        let Some(way) = self.forces.resultant().try_normalize(1e-12) else {
            return Next::By(Vector::zeros());
        };
        self.step_along(at, way, self.settings.step_m.min(missing_m))
    }

    /// A step along a direction that leaves the distance kept.
    fn step_along(&mut self, at: Point, way: Vector, length_m: f64) -> Next {
        let keep_m = self.settings.keep_m;
        let reach_m = keep_m + 2.0 * length_m;
        let (map, hull_m) = (&self.map, self.map.hull_m);
        let near = self.nearby.update(map, at).iter();
        let mut contacts: Vec<Contact> =
            near.filter_map(|index| map.solids[*index].contact(at, hull_m, reach_m)).collect();
        if self.nearby.sees_wall() {
            contacts.extend(wall_contacts(&map.wall, at, hull_m, reach_m));
        }
        if contacts.is_empty() {
            return Next::By(way * length_m);
        }
        // The guard lets a distance be used up in half a second: a step of it is one at twice the speed.
        let speed = 2.0 * length_m;
        let slid = guard::slide(way * speed, &contacts, keep_m, speed, &IN_THOUGHT) * 0.5;
        let full = slid.try_normalize(1e-9).map_or(slid, |along| along * length_m);
        let stays_clear =
            contacts.iter().all(|c| c.away.dot(&full) >= (keep_m - c.distance_m).min(0.0) - 1e-9);
        Next::By(if stays_clear { full } else { slid })
    }

    fn answer_oscillation(&mut self, at: Point, goal: Point) {
        self.oscillation.forget();
        match &mut self.phase {
            // This side leads nowhere.
            Phase::Escape(escape) => {
                escape.turn_back();
                escape.hug();
                self.oscillation.forget_for((ROUNDS * escape.round_m() / self.settings.step_m) as usize);
                self.count_escape(at);
            }
            Phase::Approach => self.leave_trap(at, goal),
            Phase::Retreat(_) | Phase::Stuck => {}
        }
    }

    fn leave_trap(&mut self, at: Point, goal: Point) {
        let Some(culprit) = self.culprit(at, goal) else { return };
        let attempts = self.began.iter().filter(|(place, _)| (place - at).norm() < SAME_PLACE_M).count();
        let members = if attempts == 0 { self.clusters.members(culprit) } else { self.all_near(at, culprit) };
        let gap_rad = |from: Point| {
            View::of(from, &self.map, &members, self.map.hull_m).map_or(2.0 * PI, |view| view.gap_rad)
        };
        if gap_rad(at) >= PI || gap_rad(goal) < PI {
            // A goal in the same trap is not sealed off: it is found along the outline.
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

    /// Everything that pushes the robot back here, and what belongs to it: between two groups the field may have a
    /// minimum though the robot would fit through.
    fn all_near(&self, at: Point, culprit: usize) -> Vec<usize> {
        let reach_m = self.settings.law.rho_m + self.map.hull_m;
        let near = self.map.solids.iter().filter(|s| s.distance(at).0 < reach_m);
        let ids = near.chain([&self.map.solids[culprit]]).map(|s| s.id).collect();
        self.clusters.closure(&self.map, &ids)
    }

    /// What holds the robot: the first solid on the way to the goal within twice the range, or else the nearest.
    fn culprit(&self, at: Point, goal: Point) -> Option<usize> {
        let ahead = at + (goal - at).cap_magnitude(AHEAD_RANGES * self.settings.law.rho_m);
        let hull_m = self.map.hull_m;
        let solids = || self.map.solids.iter().enumerate();
        let on_the_way = solids().filter(|(_, s)| s.segment_distance_m(at, ahead, hull_m) < hull_m);
        let nearest = |(i, s): (usize, &Solid)| (i, s.distance(at).0);
        let by_distance = |a: &(usize, f64), b: &(usize, f64)| a.1.total_cmp(&b.1);
        let first = on_the_way.map(nearest).min_by(by_distance);
        first.or_else(|| solids().map(nearest).min_by(by_distance)).map(|(index, _)| index)
    }

    fn retreat(&mut self, at: Point, goal: Point) -> Next {
        let hull_m = self.map.hull_m;
        let Phase::Retreat(retreat) = &mut self.phase else { return Next::Nowhere };
        let is_at_start = self.trail.is_empty();
        if let Some(back) = self.trail.last()
            && retreat.looked.is_some_and(|from| (from - at).norm() < LOOK_BACK_M)
        {
            let back = *back;
            self.trail.pop();
            return Next::Back(back);
        }
        retreat.looked = Some(at);
        let view = View::of(at, &self.map, &retreat.members, hull_m);
        let out = view.and_then(|view| match retreat.mouth {
            Some(mouth) if mouth.is_withdrawn(at, hull_m, view.gap_rad) => Some(mouth),
            _ if is_at_start && view.gap_rad >= PI => Some(Mouth::from_outside(at, &view)),
            // Deep in a spiral what looks like the mouth may not be one.
            seen => Mouth::left_behind(at, &view, seen.is_some()),
        });
        if let Some(mouth) = out {
            let ids = retreat.ids.clone();
            self.seal(at, goal, &mouth);
            let members = self.clusters.closure(&self.map, &ids);
            self.go_round(at, goal, members, false);
            return self.next(at, goal);
        }
        if let Some(back) = self.trail.pop() {
            return Next::Back(back);
        }
        // It began inside: there is no way back, and a seal would shut it in.
        let members = retreat.members.clone();
        self.go_round(at, goal, members, true);
        self.next(at, goal)
    }

    fn seal(&mut self, at: Point, goal: Point, mouth: &Mouth) {
        let circles = mouth.circles(&self.map, at, goal, self.next_id);
        self.news.push(News::Sealed { circles: circles.len() });
        self.next_id += circles.len() as u32;
        self.map.solids.extend(circles);
        self.map_changed();
    }

    fn go_round(&mut self, at: Point, goal: Point, members: Vec<usize>, hugs: bool) {
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

    /// Left, as in the paper, or the side that is shorter in thought.
    fn first_side(&self, at: Point, goal: Point) -> Side {
        let rolls_out = matches!(self.settings.mode, Mode::Rollout | Mode::Pre) && !self.in_thought;
        let goes_round = matches!(self.phase, Phase::Escape(_));
        if rolls_out && goes_round { thought::shorter_side(self, at, goal) } else { Side::Left }
    }

    fn count_escape(&mut self, at: Point) {
        self.escapes += 1;
        if self.escapes > self.settings.escapes_max {
            self.news.push(News::GivesUp { at, escapes: self.escapes - 1 });
            self.phase = Phase::Stuck;
        }
    }
}

#[cfg(test)]
mod tests;
