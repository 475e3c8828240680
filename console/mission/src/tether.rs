//! The mission's estimate of the tether: the taut cable at the estimated pose, its alarms, and the evaluation of plans.
//!
//! Scatter of the position estimate does not wind the cable: if the estimate moves and then moves back, the two moves
//! cancel. As long as the error of the estimate is less than the radius of a column plus the radius of the hull, the
//! straight line between the estimated and the true position never crosses the middle of a column. The estimated and
//! the true path therefore pass every column on the same side (`world::tether`, module `sidestep`). If the position
//! counts as lost, the cable is not moved at all: it takes one straight move when the position is recovered.
//!
//! An obstacle that is found later may lie across the taut line. The path driven then determines on which side the
//! cable passes the obstacle. For this purpose the path is stored, and it is driven again in simulation among all
//! obstacles known now.

mod alarms;
mod beside;
mod certifying;
mod driven;
mod homeward;
mod laid;
mod payout;
mod slack;
mod survey;
mod take_up;
mod torn;

pub use beside::Clearance;
pub use certifying::certify_from_start;
pub(crate) use certifying::{ends_at_anchor, return_path_ends};

use crate::{
    config::TetherConfig,
    event::{EventKind, TetherAlarm, TetherContact},
};
use alarms::Alarms;
use beside::Lying;
use certifying::certified;
use driven::Driven;
use laid::Laid;
use payout::{Explained, Payout};
use planner_api::Plan;
use slack::{ReelState, Slack};
use std::sync::Arc;
use take_up::TakeUp;
use torn::{Found, Least, Torn};
use world::{
    ObstacleMap, Point, Readings, Shape, World,
    tether::{Bearing, Cable, CableObstacles, Certificate, TetherError, capstan_factor},
};

/// Amount by which a return path may fall short of the required room beside obstacles on the chart, metres: found
/// obstacles are placed with about this accuracy.
const CHART_M: f64 = 0.05;
/// How long there must be no return path before the alarm is raised, seconds.
const NO_HOME_S: f64 = 3.0;
/// Length of cable beyond the straight line to the robot above which cable counts as still out at the end, metres.
const LEFT_M: f64 = 0.3;

/// The tether during a mission.
#[derive(Clone)]
pub struct Tether {
    config: TetherConfig,
    hull_m: f64,
    cable: Cable,
    /// The obstacles, enlarged by the distance that the hull's centre must keep from them on a return path.
    roomy: Arc<CableObstacles>,
    /// The taut line left behind by the hull among these enlarged obstacles, moved by the robot like the cable; `None` if
    /// the hull does not fit at the anchor.
    hull: Option<Cable>,
    /// How long there has been no return path, seconds.
    without_home_s: f64,
    payout: Payout,
    slack: Slack,
    take_up: TakeUp,
    torn: Torn,
    /// Length of the cable when it was found torn, metres.
    whole_m: Option<f64>,
    /// Whether a vehicle drags the cable: a vehicle without a sensor of the pull is judged by its encoder alone.
    is_live: bool,
    /// The cable on the floor beside which the robot drives back, or the rest of a torn one.
    lying: Option<Lying>,
    /// Where the cable lies; `None` until its length off the reel and its pull have been measured.
    laid: Option<Laid>,
    driven: Driven,
    alarms: Alarms,
}

impl Tether {
    /// Creates a cable that runs straight from the anchor to the start.
    ///
    /// # Errors
    /// The anchor is inside an obstacle on the drawing, or outside the wall.
    pub fn new(config: &TetherConfig, hull_m: f64, world: &World, start: Point) -> Result<Self, TetherError> {
        let shapes = shapes(world);
        let mut cable = Cable::new(config.anchor, &world.boundary, &shapes)?;
        cable.drag_to(start);
        let roomy = Arc::new(CableObstacles::grown(&world.boundary, &shapes, home_room_m(hull_m)));
        Ok(Self {
            config: config.clone(),
            hull_m,
            cable,
            hull: hull_dragged(config.anchor, &roomy, &[start]),
            roomy,
            without_home_s: 0.0,
            payout: Payout::default(),
            slack: Slack::default(),
            take_up: TakeUp::default(),
            torn: Torn::default(),
            whole_m: None,
            is_live: false,
            lying: None,
            laid: None,
            driven: Driven::new(start),
            alarms: Alarms::default(),
        })
    }

    /// The same cable, dragged by a vehicle if `is_live`.
    #[must_use]
    pub(crate) fn live(self, is_live: bool) -> Self {
        Self { is_live, ..self }
    }

    /// Whether plans that cannot be certified may be run.
    pub fn flies_uncertified(&self) -> bool {
        self.config.allow_uncertified
    }

    /// Sets whether plans that cannot be certified may be run, by order of the operator.
    pub fn allow_uncertified(&mut self, fly: bool) {
        self.config.allow_uncertified = fly;
    }

    /// The estimated geometry of the cable.
    pub(crate) fn cable(&self) -> &Cable {
        &self.cable
    }

    /// Recomputes the cable among the obstacles known now, using the path driven.
    pub fn lay_again(&mut self, world: &World) {
        let shapes = shapes(world);
        let obstacles = Arc::new(CableObstacles::new(&world.boundary, &shapes));
        // If an obstacle covers the anchor, the estimate is wrong, so the cable is left unchanged.
        if let Ok(mut cable) = Cable::on(self.config.anchor, obstacles) {
            cable.drag_along(self.driven.points());
            cable.drag_to(self.cable.tip());
            self.roomy = Arc::new(CableObstacles::grown(&world.boundary, &shapes, home_room_m(self.hull_m)));
            self.hull = hull_dragged(self.config.anchor, &self.roomy, self.driven.points());
            self.drag_hull(cable.tip());
            self.cable = cable;
        }
    }

    /// Moves the cable to the robot's estimated position.
    pub fn drag_to(&mut self, here: Point) {
        self.driven.keep(here);
        self.slack.keep(here);
        self.cable.drag_to(here);
        self.drag_hull(here);
    }

    fn drag_hull(&mut self, here: Point) {
        if let Some(hull) = &mut self.hull {
            hull.drag_to(here);
        }
    }

    /// Updates the hull's return path. If the estimate has passed through a place without room for the hull, the hull's
    /// line may be on the wrong side of an obstacle; it is then laid along the cable again.
    fn home(&mut self, map: &ObstacleMap) -> Option<Vec<Point>> {
        let room_m = home_room_m(self.hull_m);
        let dragged = self.hull.as_ref().and_then(|hull| self.cable.return_path_of(hull, map, room_m));
        dragged.or_else(|| {
            let home = |hull: Cable| Some((self.cable.return_path_of(&hull, map, room_m)?, hull));
            let (home, hull) = self.cable.hulls_along(&self.roomy, room_m).find_map(home)?;
            self.hull = Some(hull);
            Some(home)
        })
    }

    /// Records the measured length paid out and the pull, and the time that has passed since the last call, seconds.
    /// `error_m` is the position error with which the cable was laid, metres; `None` while the position is lost.
    pub fn measure(&mut self, readings: &Readings, error_m: Option<f64>, world: &World, passed_s: f64) {
        let straight_m = (self.cable.tip() - self.config.anchor).norm();
        let least = error_m.map(|error_m| Least {
            taut_m: self.cable.length_m() - error_m,
            straight_m: self.is_live.then_some(straight_m - error_m),
        });
        let reel = self.config.reel;
        self.torn.take(readings, least, reel.as_ref(), passed_s);
        self.lay(readings, error_m.is_some(), world);
        if self.torn().is_some() {
            if self.lying.is_none() {
                self.leave_lying();
            }
            // What is left of the cable is neither slack nor caught.
            (self.payout, self.slack) = (Payout::default(), Slack::default());
            self.payout.take(readings.paid_out_m, None, self.config.limits.reel_length_m, passed_s);
            self.slack.take(
                None,
                pull_n(readings),
                ReelState { reel: reel.as_ref(), ..ReelState::default() },
            );
            return;
        }
        let (length_m, points) = (self.cable.length_m(), self.driven.points().len());
        self.take_up.take(readings, reel.as_ref(), passed_s);
        let pull_ratio = self.pull_needed_n().zip(reel).map_or(0.0, |(n, reel)| n / reel.pull_n);
        let explained = error_m.map(|error_m| Explained { length_m, error_m, points, pull_ratio });
        let excess_m = explained.and(readings.paid_out_m).map(|out_m| out_m - length_m);
        let has_stopped = self.take_up.has_stopped();
        let state = ReelState { reel: reel.as_ref(), has_stopped };
        let can_be_caught = self.slack.take(excess_m, pull_n(readings), state);
        let explained = explained.filter(|_| can_be_caught);
        self.payout.take(readings.paid_out_m, explained, self.config.limits.reel_length_m, passed_s);
        self.follow_lying();
        if self.payout.is_expected() {
            self.take_up.expect();
        }
        let is_weak = self.is_reel_too_weak();
        if self.payout.is_snagged() && !self.take_up.can_be_caught(readings, reel.as_ref(), is_weak) {
            self.payout.explain();
            if !has_stopped {
                self.slack.distrust();
            }
        }
    }

    /// The pull at the reel that taking up the cable needs, newtons; `None` if the scenario does not describe the reel.
    fn pull_needed_n(&self) -> Option<f64> {
        self.config.reel.map(|reel| self.cable.pull_at_anchor_n(reel.drag(self.config.friction)))
    }

    /// Whether more cable is out than expected from the map: the cable has caught on something unknown.
    pub fn is_snagged(&self) -> bool {
        self.payout.is_snagged()
    }

    /// The alarm of a torn cable; `None` for a whole one. A torn cable stays torn for the rest of the mission.
    pub(crate) fn torn(&self) -> Option<TetherAlarm> {
        let Found { out_m, needed_m, by_encoder_alone } = self.torn.found()?;
        Some(TetherAlarm::Broken { paid_out_m: out_m, needed_m, by_encoder_alone })
    }

    /// The path from the robot to the anchor that frees a caught cable and reels it in. It first goes back along the path
    /// driven to the last place where the cable length was as expected, and beyond it by some margin; from there, it
    /// returns along the cable, with `room_m` metres for the hull's centre. The obstacle that caught the cable lies
    /// beside that second part.
    pub fn way_out(&self, world: &World, room_m: f64) -> Option<Vec<Point>> {
        let driven = self.driven.points();
        let first = self.payout.points_to_go_back_to(driven.len());
        let mut way: Vec<Point> = driven[first..].iter().rev().copied().collect();
        let mut freed = self.cable.clone();
        freed.drag_along(&way);
        way.extend(Ground::new(world, room_m).way_along(&freed)?);
        Some(way)
    }

    /// The path from the robot back to shortly beyond the place where the cable last pulled; `None` unless the cable is slack.
    pub fn way_to_tauten(&self) -> Option<Vec<Point>> {
        self.slack.way_back()
    }

    /// Updates the cable after some time has passed; returns events for the alarms that were raised or cleared.
    pub fn update(&mut self, world: &World, map: &ObstacleMap, passed_s: f64) -> Vec<EventKind> {
        let return_length_m = self.home(map).map(|way| world::polyline::length_m(&way));
        let has_home = return_length_m.is_some() || self.torn().is_some();
        self.without_home_s = if has_home { 0.0 } else { self.without_home_s + passed_s };
        let limits = self.config.limits;
        let length_m = self.cable.length_m();
        let wrap_total_rad = self.cable.wrap_total_rad();
        let mut events = vec![EventKind::Tethered {
            length_m,
            free_m: limits.reel_length_m - self.payout.at_least_m(length_m),
            paid_out_m: self.payout.measured_m(),
            contacts: self.contacts(world),
            wrap_max_rad: self.cable.wrap_max_rad(),
            wrap_total_rad,
            pull_factor: capstan_factor(self.config.friction, wrap_total_rad),
            pull_n: self.pull_needed_n(),
            measured: self.slack.measured(),
            return_length_m,
            bends: bends(&self.cable),
        }];
        for (alarm, share) in self.alarms_with_shares(world) {
            events.extend(self.alarms.check(alarm, share));
        }
        events
    }

    /// Whether the hull fits along a return path on which the cable is reeled in.
    pub fn can_go_home(&self) -> bool {
        self.without_home_s == 0.0
    }

    /// The alarms of the cable, each with its current value as a share of the limit.
    fn alarms_with_shares(&self, world: &World) -> Vec<(TetherAlarm, f64)> {
        let limits = self.config.limits;
        let contacts = self.cable.contacts();
        let most = contacts.iter().max_by(|a, b| a.wrap_rad.abs().total_cmp(&b.wrap_rad.abs()));
        let on = most.map_or_else(String::new, |contact| name_of(world, contact.on));
        let explained_m = self.cable.length_m();
        let (out_m, reel_length_m) = (self.payout.at_least_m(explained_m), limits.reel_length_m);
        let (wrap_rad, sum_rad) = (self.cable.wrap_max_rad(), self.cable.wrap_total_rad());
        let (wrap_limit_rad, sum_limit_rad) = (limits.wrap_max_rad, limits.wrap_total_max_rad);
        let or_slack = self.may_be_slack();
        let snag = TetherAlarm::Snag { paid_out_m: out_m, explained_m, or_slack };
        if let Some(torn) = self.torn() {
            // Like a snag, a torn cable has no intermediate levels; the limits apply to a cable that leads to the robot.
            return vec![(torn, 2.0), (snag, 0.0), self.slack.alarm()];
        }
        vec![
            (TetherAlarm::Reel { out_m, reel_length_m }, out_m / reel_length_m),
            (TetherAlarm::Wrap { on, wrap_rad, limit_rad: wrap_limit_rad }, wrap_rad / wrap_limit_rad),
            (TetherAlarm::WrapTotal { sum_rad, limit_rad: sum_limit_rad }, sum_rad / sum_limit_rad),
            (TetherAlarm::NoReturnPath, self.without_home_s / NO_HOME_S),
            // A snag has no intermediate levels.
            (snag, if self.is_snagged() { 2.0 } else { 0.0 }),
            self.slack.alarm(),
        ]
    }

    fn contacts(&self, world: &World) -> Vec<TetherContact> {
        let contacts = self.cable.contacts();
        let contacts = contacts.iter().map(|contact| TetherContact {
            on: name_of(world, contact.on),
            wrap_rad: contact.wrap_rad,
            at: contact.last,
        });
        contacts.collect()
    }

    /// The path driven, from the anchor on, without the parts that were driven out and back.
    pub(crate) fn way_driven(&self) -> &[Point] {
        self.driven.points()
    }

    /// The robot's end of the cable, at its estimated position.
    pub fn tip(&self) -> Point {
        self.cable.tip()
    }

    /// The place where the cable is attached.
    pub fn anchor(&self) -> Point {
        self.config.anchor
    }

    /// The return path along the cable from the robot to the anchor, with `room_m` metres for the hull's centre.
    pub fn return_path(&self, world: &World, room_m: f64) -> Option<Vec<Point>> {
        let ground = Ground::new(world, room_m);
        ground.way_along(&self.cable).or_else(|| {
            let hull = hull_dragged(self.config.anchor, &ground.roomy, self.driven.points());
            hull.and_then(|mut hull| {
                hull.drag_to(self.cable.tip());
                self.cable.return_path_of(&hull, &ground.map, room_m)
            })
        })
    }

    /// Whether, as far as the tank is known now, the rest of a plan can be driven and the cable reeled in within its
    /// limits.
    pub fn bears(&self, rest: &[Point], world: &World, returns: bool) -> bool {
        certified(&self.config, 0.0, Some(&self.cable), rest, &[], world, returns).certified
    }

    /// Evaluates a plan, starting with the current geometry of the cable; `returns` states whether the cable must be
    /// reeled in at the end of the plan.
    ///
    /// If a plan first returns to the anchor along the cable, its cuts apply only from there on.
    pub fn certify(&self, plan: &Plan, world: &World, returns: bool) -> Certificate {
        let evaluate = |cable, path, cuts: &[Vec<Point>]| {
            certified(&self.config, self.hull_m, cable, path, cuts, world, returns)
        };
        let home = return_path_ends(plan, self.config.anchor);
        if home == 0 {
            return evaluate(Some(&self.cable), &plan.path, &plan.cuts);
        }
        let mut whole = evaluate(Some(&self.cable), &plan.path, &[]);
        let rest = evaluate(None, &plan.path[home..], &plan.cuts);
        (whole.cut_crossings, whole.sealed_m2) = (rest.cut_crossings, rest.sealed_m2);
        let more: Vec<String> = rest.reasons.into_iter().filter(|why| !whole.reasons.contains(why)).collect();
        whole.reasons.extend(more);
        whole.certified = whole.reasons.is_empty();
        whole
    }

    /// Evaluates a plan, starting with the geometry that the cable will have after a path has been driven.
    pub fn certify_after(&self, way: &[Point], plan: &Plan, world: &World, returns: bool) -> Certificate {
        let mut there = self.clone();
        there.cable.drag_along(way);
        there.certify(plan, world, returns)
    }

    /// Why cable counts as still out although the robot is back, as a sentence; `None` if the cable is reeled in.
    pub fn left_out(&self, world: &World) -> Option<String> {
        let mut cable = self.cable.clone();
        cable.drag_to(self.config.anchor);
        let left_m = cable.length_m();
        let on: Vec<String> = cable.contacts().iter().map(|c| name_of(world, c.on)).collect();
        let names = on.first().map_or_else(String::new, |first| format!(", hooked around {first}"));
        (left_m > LEFT_M).then(|| format!("{left_m:.1} m of tether still out{names}"))
    }
}

/// The measured pull: at the robot or, without a sensor there, at the reel, newtons.
fn pull_n(readings: &Readings) -> Option<f64> {
    readings.robot_pull_n.or(readings.reel_pull_n)
}

/// The bends of the taut cable between its ends.
fn bends(cable: &Cable) -> Vec<Point> {
    let line = cable.taut_line();
    line[1..line.len() - 1].to_vec()
}

/// The obstacles, enlarged by the distance that the hull's centre must keep from them.
struct Ground {
    roomy: Arc<CableObstacles>,
    map: ObstacleMap,
    room_m: f64,
}

impl Ground {
    fn new(world: &World, room_m: f64) -> Self {
        let roomy = Arc::new(CableObstacles::grown(&world.boundary, &shapes(world), room_m));
        Self { roomy, map: ObstacleMap::new(&world.boundary, &world.obstacles), room_m }
    }

    /// The path along a cable to its anchor.
    fn way_along(&self, cable: &Cable) -> Option<Vec<Point>> {
        cable.return_path(&self.roomy, &self.map, self.room_m)
    }
}

/// The taut line left behind by a hull that was moved from the anchor along a path.
fn hull_dragged(anchor: Point, roomy: &Arc<CableObstacles>, way: &[Point]) -> Option<Cable> {
    let mut hull = Cable::hull_at(anchor, roomy)?;
    hull.drag_along(way);
    Some(hull)
}

/// Room for the hull's centre on a return path, metres.
fn home_room_m(hull_m: f64) -> f64 {
    (hull_m - CHART_M).max(0.5 * hull_m)
}

fn shapes(world: &World) -> Vec<Shape> {
    world.obstacles.iter().map(|obstacle| obstacle.shape.clone()).collect()
}

fn name_of(world: &World, on: Bearing) -> String {
    match on {
        Bearing::Obstacle(index) => {
            world.obstacles.get(index).map_or_else(|| format!("obstacle {index}"), |o| o.name.clone())
        }
        Bearing::Wall => "a corner of the wall".into(),
    }
}
