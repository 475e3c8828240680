//! How the tether lay over a run, by the estimated position.

use mission::{TetherConfig, event::taut_line};
use world::{Point, tether::Limits};

/// At most so many lines of the tether are kept for its picture; every second is dropped when there are more.
const MOST_LINES: usize = 400;

/// How the tether lay in a tick.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TetherPoint {
    /// Mission time, seconds.
    pub t_s: f32,
    /// Tether out as the map explains it, metres.
    pub length_m: f32,
    /// Largest wrap on one obstacle, radians.
    pub wrap_max_rad: f32,
    /// Sum of all wraps, radians.
    pub wrap_total_rad: f32,
}

/// The tether at a moment.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Lay {
    /// The figures.
    pub point: TetherPoint,
    /// From the anchor to the robot.
    pub line: Vec<Point>,
}

/// How the tether lay over a run.
#[derive(Debug, Clone, PartialEq)]
pub struct TetherRecord {
    /// Its limits.
    pub limits: Limits,
    /// Friction of tether on steel.
    pub friction: f64,
    /// Every tick.
    pub points: Vec<TetherPoint>,
    /// Some of its lines, evenly over time.
    pub lines: Vec<Vec<Point>>,
    /// When most of it was out.
    pub longest: Lay,
    /// When its wraps were largest all together.
    pub most_wrapped: Lay,
    /// Largest wrap on one obstacle, radians.
    pub wrap_max_rad: f64,
    /// Largest factor by which the wraps multiplied the pull.
    pub pull_factor_max: f64,
    /// Largest difference between what the reel paid out and what the map explains, metres; absent without an encoder.
    pub reel_off_max_m: Option<f64>,
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
            wrap_max_rad: 0.0,
            pull_factor_max: 1.0,
            reel_off_max_m: None,
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
        self.wrap_max_rad = self.wrap_max_rad.max(f64::from(point.wrap_max_rad));
        self.pull_factor_max = self.pull_factor_max.max(pull_factor);
        self.reel_off_max_m = match (self.reel_off_max_m, reel_off_m) {
            (Some(a), Some(b)) => Some(a.max(b)),
            (a, b) => a.or(b),
        };
    }
}
