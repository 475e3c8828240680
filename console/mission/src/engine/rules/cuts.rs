//! A robot that has come off its plan across a cut would wind the cable on its way back to it.

use world::{Point, polyline, tether::crossings};

/// Distance from the end of a return path within which the plan behind it has begun, metres.
pub(in crate::engine) const HOME_M: f64 = 0.3;

/// The lines that the plan never crosses, and whether the robot has.
#[derive(Clone, Debug, Default)]
pub(in crate::engine) struct CutsRule {
    /// Each with whether the robot is beyond it.
    lines: Vec<(Vec<Point>, bool)>,
    /// Where the plan is bound to them from, after a return path; `None` once the robot has been there.
    from: Option<Point>,
    seen_at: Point,
}

impl CutsRule {
    /// The cuts of a plan that is to be flown from here, bound to them from a point on.
    pub(crate) fn new(lines: &[Vec<Point>], from: Option<Point>, here: Point) -> Self {
        Self { lines: lines.iter().map(|line| (line.clone(), false)).collect(), from, seen_at: here }
    }

    /// One tick with a position that can be relied on: whether the robot has strayed across a cut by more than its hull. On
    /// the line itself the estimate may scatter from side to side.
    pub(crate) fn update(&mut self, here: Point, radius_m: f64) -> bool {
        let before = std::mem::replace(&mut self.seen_at, here);
        if self.from.is_some_and(|from| (here - from).norm() > HOME_M) {
            return false;
        }
        self.from = None;
        for (line, is_beyond) in &mut self.lines {
            *is_beyond ^= crossings(&[before, here], std::slice::from_ref(line)) % 2 == 1;
        }
        self.lines.iter().any(|(line, is_beyond)| *is_beyond && polyline::distance_m(line, here) > radius_m)
    }

    /// The plan is given up, and its cuts with it.
    pub(crate) fn clear(&mut self) {
        self.lines.clear();
    }
}
