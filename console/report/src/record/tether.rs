//! The tether over a run, according to the estimated position.

use mission::{TetherConfig, event::taut_line};
use world::{
    Point,
    tether::{Limits, OwnGap},
};

/// Maximum number of tether lines stored for the picture; beyond that, every second line is dropped.
const MOST_LINES: usize = 400;

/// The tether in a tick.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TetherPoint {
    /// Mission time, seconds.
    pub t_s: f32,
    /// Length out according to the map, metres.
    pub length_m: f32,
    /// Largest wrap on one obstacle, radians.
    pub wrap_max_rad: f32,
    /// Total wrap, radians.
    pub wrap_total_rad: f32,
    /// Pull at the reel that taking up the tether needs, newtons; not a number if the scenario does not describe the
    /// reel.
    pub pull_n: f32,
}

/// The tether at a moment.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Lay {
    /// The figures.
    pub point: TetherPoint,
    /// The line from the anchor to the robot.
    pub line: Vec<Point>,
}

/// The tether over a run.
#[derive(Debug, Clone, PartialEq)]
pub struct TetherRecord {
    /// Limits of the tether.
    pub limits: Limits,
    /// Coefficient of friction between tether and steel.
    pub friction: f64,
    /// The tether in every tick.
    pub points: Vec<TetherPoint>,
    /// Some lines of the tether, evenly spaced in time.
    pub lines: Vec<Vec<Point>>,
    /// The moment of the greatest length paid out.
    pub longest: Lay,
    /// The moment of the largest total wrap.
    pub most_wrapped: Lay,
    /// The moment of the largest pull; `None` if the scenario does not describe the reel.
    pub most_pulled: Option<TetherPoint>,
    /// Pull of the reel, newtons.
    pub reel_pull_n: Option<f64>,
    /// Largest wrap on one obstacle, radians.
    pub wrap_max_rad: f64,
    /// Largest factor by which the wraps multiplied the pull.
    pub pull_factor_max: f64,
    /// Largest difference between the length paid out and the length according to the map, metres; absent without an
    /// encoder.
    pub reel_off_max_m: Option<f64>,
    /// How near the last certified plan leads the hull to its own taut tether on the way in; `None` if that was not computed.
    pub own_gap: Option<OwnGap>,
    anchor: Point,
    every: usize,
}

impl TetherRecord {
    pub(super) fn new(config: &TetherConfig) -> Self {
        Self {
            limits: config.limits,
            friction: config.friction,
            points: Vec::new(),
            lines: Vec::new(),
            longest: Lay::default(),
            most_wrapped: Lay::default(),
            most_pulled: None,
            reel_pull_n: config.reel.map(|reel| reel.pull_n),
            wrap_max_rad: 0.0,
            pull_factor_max: 1.0,
            reel_off_max_m: None,
            own_gap: None,
            anchor: config.anchor,
            every: 1,
        }
    }

    pub(super) fn lie(
        &mut self,
        point: TetherPoint,
        reel_off_m: Option<f64>,
        pull_factor: f64,
        (bends, robot): (&[Point], Point),
    ) {
        let line = || taut_line(self.anchor, bends, robot);
        if self.points.len().is_multiple_of(self.every) {
            self.lines.push(line());
            if self.lines.len() > MOST_LINES {
                let mut index = 0;
                self.lines.retain(|_| {
                    index += 1;
                    index % 2 == 1
                });
                self.every *= 2;
            }
        }
        self.points.push(point);
        let lay = || Lay { point, line: line() };
        if point.length_m > self.longest.point.length_m {
            self.longest = lay();
        }
        if point.wrap_total_rad > self.most_wrapped.point.wrap_total_rad {
            self.most_wrapped = lay();
        }
        if self.most_pulled.map_or(0.0, |most| most.pull_n) < point.pull_n {
            self.most_pulled = Some(point);
        }
        self.wrap_max_rad = self.wrap_max_rad.max(f64::from(point.wrap_max_rad));
        self.pull_factor_max = self.pull_factor_max.max(pull_factor);
        self.reel_off_max_m = match (self.reel_off_max_m, reel_off_m) {
            (Some(a), Some(b)) => Some(a.max(b)),
            (a, b) => a.or(b),
        };
    }
}
