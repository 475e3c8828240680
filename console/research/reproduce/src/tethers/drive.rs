//! A plan driven with a simulated cable.

use super::{FRICTION, reel};
use cable::{Chain, Law, Surfaces};
use mission::{
    TetherConfig,
    event::{EventKind, MeasuredPull, TetherAlarm},
    tether::{Clearance, Tether},
};
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;
use trials::tanks::{HULL_M, Tank};
use world::{
    ObstacleMap, Point, Readings, World, polyline,
    tether::{Cable, Limits},
};

/// Speed of the robot, metres per second.
const SPEED_M_PER_S: f64 = 0.3;
const TICK_S: f64 = 0.1;
/// Position error that the rules of the mission allow for, metres.
const ERROR_M: f64 = 0.05;
/// How long the reel takes up cable after the robot has returned, seconds.
const REST_S: f64 = 30.0;
/// Cable on the reel beyond the longest taut line, metres.
const SPARE_M: f64 = 20.0;
/// Farthest way back along the driven path to make a slack cable taut, metres.
const BACK_M: f64 = 3.0;
/// Speed of the mission beside a cable on the floor, metres per second.
const BESIDE_M_PER_S: f64 = 0.1;
/// Most orders to drive home after one hold.
const MOST_ORDERS: usize = 6;

/// What became of the cable on a drive.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Drive {
    /// Largest length of cable beyond the taut line, metres.
    pub excess_max_m: f64,
    /// Longest taut line, metres.
    pub longest_m: f64,
    /// How often the robot drove onto its own cable.
    pub times_over: usize,
    /// The same until the slack rule held the robot; all of them if it did not.
    pub times_over_before_hold: usize,
    /// Whether the slack rule held the robot.
    pub is_held: bool,
    /// Whether the cable was taut again after the robot had gone back along its path, without driving over the cable;
    /// `None` if it was not held.
    pub is_freed: Option<bool>,
    /// How often the robot drove onto its own cable on the way home after the hold, and how often it would have on the taut line;
    /// `None` if it was not held, or if the order was refused before the robot moved.
    pub times_over_home: Option<(usize, usize)>,
    /// How the way home after the hold ended; `None` if the robot was not held.
    pub home: Option<Home>,
    /// How often the cable counted as caught.
    pub snags: usize,
    /// Length of cable beyond the taut line after the return, metres.
    pub end_excess_m: f64,
}

/// How the orders to drive home ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(super) enum Home {
    /// The robot came home.
    There,
    /// The mission refused the first order, because the hull would not have been clear of the cable.
    Refused,
    /// The robot was held on the way, and further orders were refused or did not lead home.
    Held,
}

/// Drives a path with a cable on a reel whose pull is the needed one divided by a ratio, and that stops taking cable up
/// after a share of the path, if one is given. The drive goes on after a hold, as without the rules.
pub(super) fn drive(tank: &Tank, path: &[Point], ratio: f64, stops_at: Option<f64>) -> Drive {
    let world = tank.world();
    let way = polyline::resampled(path, SPEED_M_PER_S * TICK_S);
    let Some(mut taut) = taut(tank, &world) else { return Drive::default() };
    let (needed_n, longest_m) = needs(&taut, &way);
    let mut run = Run::new(tank, &world, needed_n / ratio, longest_m + SPARE_M);
    let mut drive = Drive { longest_m, ..Drive::default() };
    let mut was_over = false;
    let stops = stops_at.map(|share| (share * way.len() as f64) as usize);
    for (index, at) in way.iter().enumerate() {
        if stops == Some(index) {
            run.chain.stop_reel();
        }
        taut.drag_to(*at);
        let over = run.step(*at);
        drive.excess_max_m = drive.excess_max_m.max(run.chain.paid_out_m() - taut.length_m());
        let begins = usize::from(over && !was_over);
        was_over = over;
        drive.times_over += begins;
        if !drive.is_held {
            drive.times_over_before_hold += begins;
        }
        drive.snags += usize::from(run.is_raised(|alarm| matches!(alarm, TetherAlarm::Snag { .. })));
        if !drive.is_held && run.is_raised(|alarm| matches!(alarm, TetherAlarm::Slack { .. })) {
            drive.is_held = true;
            drive.is_freed = Some(run.clone().go_back_until_taut(&way[..=index]));
            let on_line = run.rules.return_path(&world, HULL_M).map_or(0, |way| run.times_over_on(&way));
            let (home, times) = run.clone().drive_home();
            drive.home = Some(home);
            drive.times_over_home = (home != Home::Refused).then_some((times, on_line));
        }
    }
    let end = way.last().copied().unwrap_or(tank.anchor);
    (0..(REST_S / TICK_S) as usize).for_each(|_| run.chain.step(end, &run.surfaces, TICK_S));
    drive.end_excess_m = run.chain.paid_out_m() - taut.length_m();
    drive
}

/// A taut cable at the anchor; `None` if the anchor is inside something solid.
pub(super) fn taut(tank: &Tank, world: &World) -> Option<Cable> {
    let shapes: Vec<_> = world.obstacles.iter().map(|obstacle| obstacle.shape.clone()).collect();
    Cable::new(tank.anchor, &tank.boundary, &shapes).ok()
}

/// The largest pull at the reel that a drive needs, newtons, and the longest taut line, metres.
fn needs(taut: &Cable, way: &[Point]) -> (f64, f64) {
    let drag = reel(0.0).drag(FRICTION);
    let mut taut = taut.clone();
    way.iter().fold((0.0_f64, 0.0_f64), |(needed_n, longest_m), at| {
        taut.drag_to(*at);
        (needed_n.max(taut.pull_at_anchor_n(drag)), longest_m.max(taut.length_m()))
    })
}

/// The law of a simulated cable on a reel that is twice as fast as the robot.
pub(super) fn law(pull_n: f64, length_m: f64) -> Law {
    let reel = reel(pull_n);
    Law {
        floor_n_per_m: reel.drag(FRICTION).floor_n_per_m,
        friction: FRICTION,
        pull_n,
        pay_out_n: reel.pay_out_n,
        speed_m_per_s: 2.0 * SPEED_M_PER_S,
        length_m,
    }
}

/// A drive in progress: the cable as it lies, and the rules of the mission.
#[derive(Clone)]
struct Run<'a> {
    world: &'a World,
    map: ObstacleMap,
    surfaces: Surfaces,
    chain: Chain,
    rules: Tether,
    /// The alarms whose limit was reached in the last tick.
    raised: Vec<TetherAlarm>,
    measured: Option<MeasuredPull>,
}

impl<'a> Run<'a> {
    fn new(tank: &Tank, world: &'a World, pull_n: f64, length_m: f64) -> Self {
        let config = TetherConfig {
            anchor: tank.anchor,
            // Only the pull is of interest.
            limits: Limits {
                reel_length_m: length_m,
                wrap_max_rad: 9.0 * TAU,
                wrap_total_max_rad: 9.0 * TAU,
            },
            friction: FRICTION,
            reel: Some(reel(pull_n)),
            allow_uncertified: true,
        };
        let law = law(pull_n, length_m);
        Self {
            world,
            map: ObstacleMap::new(&world.boundary, &world.obstacles),
            surfaces: Surfaces::new(&world.boundary, &world.obstacles, Chain::link_m(length_m)),
            chain: Chain::along(&[tank.anchor, tank.anchor], law).expect("two finite points"),
            rules: Tether::new(&config, HULL_M, world, tank.anchor).expect("the anchor is free"),
            raised: Vec::new(),
            measured: None,
        }
    }

    /// Moves the robot in a tick; returns whether it stands on its own cable.
    fn step(&mut self, at: Point) -> bool {
        self.chain.step(at, &self.surfaces, TICK_S);
        let readings = Readings {
            paid_out_m: Some(self.chain.paid_out_m()),
            reel_pull_n: Some(self.chain.pull_at_reel_n()),
            robot_pull_n: Some(self.chain.pull_at_robot_n()),
            ..Readings::default()
        };
        self.rules.drag_to(at);
        self.rules.measure(&readings, Some(ERROR_M), self.world, TICK_S);
        self.raised.clear();
        for event in self.rules.update(self.world, &self.map, TICK_S) {
            match event {
                EventKind::TetherAlarmRaised { alarm, reached: true } => self.raised.push(alarm),
                EventKind::Tethered { measured, .. } => self.measured = measured,
                _ => {}
            }
        }
        self.chain.is_under(HULL_M)
    }

    /// How often the robot drives onto its own cable on a way home.
    fn times_over_on(&self, way: &[Point]) -> usize {
        let mut run = self.clone();
        let (mut times, mut was_over) = (0, false);
        for at in polyline::resampled(way, SPEED_M_PER_S * TICK_S) {
            let is_over = run.step(at);
            times += usize::from(is_over && !was_over);
            was_over = is_over;
        }
        times
    }

    /// Drives home by orders, as the mission does: beside the cable slowly, until the robot is there or held. A held robot waits
    /// until the cable rests, and gets the next order. Returns how often the robot came onto its own cable.
    fn drive_home(mut self) -> (Home, usize) {
        let (mut times, mut was_over) = (0, false);
        let mut count = |is_over: bool| {
            times += usize::from(is_over && !was_over);
            was_over = is_over;
        };
        for order in 0..MOST_ORDERS {
            let is_beside = self.rules.is_left_lying();
            let way = if is_beside {
                self.rules.way_beside(self.world, HULL_M)
            } else {
                self.rules.way_home(self.world, HULL_M)
            };
            let Some(way) = way else {
                return (if order == 0 { Home::Refused } else { Home::Held }, times);
            };
            let speed_m_per_s = if is_beside {
                self.rules.leave_lying();
                BESIDE_M_PER_S
            } else {
                SPEED_M_PER_S
            };
            let mut is_held = false;
            for at in polyline::resampled(&way, speed_m_per_s * TICK_S) {
                count(self.step(at));
                let trouble = self.rules.beside_lying().and_then(Clearance::trouble);
                is_held = trouble.is_some()
                    || (!is_beside && self.is_raised(|alarm| matches!(alarm, TetherAlarm::Slack { .. })));
                if is_held {
                    break;
                }
            }
            if !is_held {
                return (Home::There, times);
            }
            let here = self.rules.tip();
            (0..(REST_S / TICK_S) as usize).for_each(|_| count(self.step(here)));
            self.rules.forget_lying();
        }
        (Home::Held, times)
    }

    /// Whether the last tick raised such an alarm.
    fn is_raised(&self, kind: impl Fn(&TetherAlarm) -> bool) -> bool {
        self.raised.iter().any(kind)
    }

    /// Goes back along the driven path until the cable pulls; returns whether it did so without driving over the cable.
    fn go_back_until_taut(mut self, driven: &[Point]) -> bool {
        let most = (BACK_M / (SPEED_M_PER_S * TICK_S)) as usize;
        for at in driven.iter().rev().take(most) {
            if self.step(*at) {
                return false;
            }
            if self.measured.is_some_and(|measured| measured.slack_m == 0.0) {
                return true;
            }
        }
        false
    }
}
