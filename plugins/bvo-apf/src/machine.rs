//! The state machine: approach, retreat, seal, escape (Xu et al. 2022, section 4).

mod retreat;
mod trap;

pub use crate::news::News;
pub use retreat::Retreat;

use crate::{
    clusters::Clusters,
    escape::Escape,
    mouth::{FIRST_VIRTUAL, is_virtual},
    outline::{Follow, Outline},
    settings::MachineSettings,
};
use field::{Sides, oscillation::Oscillation};
use geometry::Braking;
use steering::{Body, Contact, Forces, KnownMap, Nearby, Side, guard, wall_contacts};
use world::{Point, Vector};

/// Maximum length of a detour, as a multiple of the circle around the group; a longer detour is considered to lead
/// nowhere.
const ROUNDS: f64 = 2.5;
/// Maximum number of rollout steps on one map: about a second where many parts are near.
const THOUGHT_MOST: usize = 30_000;
/// Maximum number of rollout steps for one choice of side.
const CHOICE_MOST: usize = 4_000;
/// A simulated robot stops instantly.
const IN_THOUGHT: Braking = Braking { acceleration_m_per_s2: 1e3, tick_s: 0.0 };

/// The current phase of the machine.
#[derive(Debug, Clone)]
pub enum Phase {
    /// Moving according to the field.
    Approach,
    /// Going back along its own track, out of a trap.
    Retreat(Retreat),
    /// Going around the trap.
    Escape(Escape),
    /// Following the outlines to the goal, because the wall is part of the trap.
    Follow(Follow),
    /// Given up.
    Stuck,
}

/// The next move.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Next {
    /// A displacement, at most one step long, metres.
    By(Vector),
    /// Back to a point of the robot's own track.
    Back(Point),
    /// No move: the machine has given up.
    Nowhere,
}

/// The complete state of the planner on a map.
#[derive(Debug, Clone)]
pub struct Machine {
    /// The settings.
    pub settings: MachineSettings,
    /// The map, virtual circles included.
    pub map: KnownMap,
    /// The forces of the last step.
    pub forces: Forces,
    /// Number of retreats.
    pub retreats: u32,
    /// Number of escapes.
    pub escapes: u32,
    /// The events so far; the planner removes them once it has reported them.
    pub news: Vec<News>,
    phase: Phase,
    clusters: Clusters,
    /// The outlines of the map; computed when first needed.
    outline: Option<Outline>,
    trail: Vec<Point>,
    began: Vec<(Point, Side)>,
    oscillation: Oscillation,
    nearby: Nearby,
    sides: Sides,
    next_id: u32,
    /// Whether this is a rollout; a rollout starts no further rollouts.
    in_thought: bool,
    /// Number of rollout steps left. With none left, the side is chosen without simulation.
    pub(crate) thought_left: usize,
}

impl Machine {
    /// Creates a machine that has not moved yet.
    pub fn new(settings: MachineSettings, map: KnownMap) -> Self {
        let next_id = map.solids.iter().filter(|s| is_virtual(s)).map(|s| s.id + 1).max();
        Self {
            clusters: Clusters::new(&map, settings.margin_m),
            outline: None,
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
            thought_left: THOUGHT_MOST,
            settings,
            map,
        }
    }

    /// Returns a copy of this machine, which must not have moved, with different settings. The margin must be the same.
    #[must_use]
    pub fn set_to(&self, settings: MachineSettings) -> Self {
        Self { settings, oscillation: Oscillation::new(settings.window_m, settings.step_m), ..self.clone() }
    }

    /// Returns a copy of this machine for simulation. The copy takes coarser steps, does not remember its track and
    /// keeps to one side.
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

    /// The current phase.
    pub fn phase(&self) -> &Phase {
        &self.phase
    }

    /// Sets the side of the detour in progress, if there is one.
    pub fn take_side(&mut self, side: Side) {
        match &mut self.phase {
            Phase::Escape(escape) if escape.side != side => escape.turn_back(),
            Phase::Follow(follow) => follow.side = side,
            Phase::Escape(_) | Phase::Approach | Phase::Retreat(_) | Phase::Stuck => {}
        }
    }

    /// The side of the detour in progress, and the distance once around the group, metres.
    pub fn going_round(&self) -> Option<(Side, f64)> {
        match &self.phase {
            Phase::Escape(escape) => Some((escape.side, escape.round_m())),
            Phase::Follow(follow) => {
                Some((follow.side, self.outline.as_ref().map_or(0.0, Outline::length_m)))
            }
            Phase::Approach | Phase::Retreat(_) | Phase::Stuck => None,
        }
    }

    /// The virtual circles.
    pub fn virtual_circles(&self) -> impl Iterator<Item = (Point, f64)> + '_ {
        self.map.solids.iter().filter(|s| is_virtual(s)).map(|s| (s.center, s.radius_m))
    }

    /// Adds the sensed bodies to the map. If that changes the map, the group of the detour is recomputed.
    pub fn learn(&mut self, bodies: &[Body]) {
        if self.map.learn(bodies) {
            self.outline = None;
            self.map_changed();
        }
    }

    /// Removes obstacles found to be moving from the map.
    pub fn forget(&mut self, movers: &[u32]) {
        if self.map.forget(movers) {
            self.outline = None;
            self.map_changed();
        }
    }

    fn map_changed(&mut self) {
        self.clusters = Clusters::new(&self.map, self.settings.margin_m);
        self.clusters_changed();
    }

    fn clusters_changed(&mut self) {
        self.nearby.forget();
        self.sides.forget();
        match &mut self.phase {
            Phase::Retreat(retreat) => retreat.members = self.clusters.closure(&self.map, &retreat.ids),
            Phase::Escape(escape) => escape.regroup(&self.map, &self.clusters),
            Phase::Approach | Phase::Follow(_) | Phase::Stuck => {}
        }
    }

    /// Decides the next step of a robot at a position, bound for a goal.
    pub fn next(&mut self, at: Point, goal: Point) -> Next {
        match self.phase {
            Phase::Retreat(_) => return self.retreat(at, goal),
            Phase::Follow(_) => return self.along_outlines(at, goal),
            Phase::Approach | Phase::Escape(_) | Phase::Stuck => {}
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
            Phase::Approach | Phase::Retreat(_) | Phase::Follow(_) => self.approach(at, goal),
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

    /// A step along a direction that keeps the distance to all solids.
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
        // The guard allows a distance to be used up in half a second, so the step is passed to it as a speed of twice
        // its length per second.
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
            // Turn back: this side leads nowhere.
            Phase::Escape(escape) => {
                escape.turn_back();
                escape.hug();
                self.oscillation.forget_for((ROUNDS * escape.round_m() / self.settings.step_m) as usize);
                self.count_escape(at);
            }
            Phase::Approach => self.leave_trap(at, goal),
            Phase::Retreat(_) | Phase::Follow(_) | Phase::Stuck => {}
        }
    }
}

#[cfg(test)]
pub(crate) mod tests;
