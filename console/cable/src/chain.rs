//! The cable over time.

use crate::{
    feed::Feed,
    law::Law,
    solve::{Links, Solution, Step},
    surfaces::Surfaces,
};
use geometry::{Point, Vector, polyline};

/// Length of a link, metres, of a cable of up to [`MOST_LINKS`] links.
const LINK_M: f64 = 0.1;
/// Most links of a cable; a longer cable has longer links.
const MOST_LINKS: f64 = 1000.0;
/// Farthest way of a node in one step, in links.
const FARTHEST_LINKS: f64 = 0.5;
/// Most steps of one move.
const MOST_STEPS: f64 = 16.0;
/// Length of the link at a reel that has taken everything up, metres.
const LEAST_M: f64 = 1e-6;
/// Length of the cable that is stretched when the reel is empty, metres, above which the robot is held back.
const STRETCHED_M: f64 = 0.02;

/// A cable from the robot to its reel.
#[derive(Debug, Clone)]
pub struct Chain {
    law: Law,
    link_m: f64,
    links: Links,
    /// The solution of the last step.
    found: Solution,
}

impl Chain {
    /// The length of a link of a cable of a given length, metres.
    pub fn link_m(length_m: f64) -> f64 {
        LINK_M.max(length_m.min(1e5) / MOST_LINKS)
    }

    /// Creates a cable at rest along a line from the anchor to the robot, tank frame. A line of less than two points
    /// gives no cable.
    pub fn along(line: &[Point], law: Law) -> Option<Self> {
        let (anchor, robot) = (*line.first()?, *line.last()?);
        if line.len() < 2 || !line.iter().all(|point| point.x.is_finite() && point.y.is_finite()) {
            return None;
        }
        let law = law.bounded();
        let link_m = Self::link_m(law.length_m);
        let mut nodes: Vec<Point> = polyline::resampled(line, link_m);
        nodes.reverse();
        if nodes.len() < 2 {
            nodes = vec![robot, anchor];
        }
        let rest_m = nodes.windows(2).map(|pair| (pair[1] - pair[0]).norm()).collect();
        let links = Links { nodes, rest_m, torn: None };
        Some(Self { law, link_m, links, found: Solution::default() })
    }

    /// Moves the robot, and the cable with it; `passed_s` is the time that passes, seconds. A
    /// position that is not finite is ignored.
    pub fn step(&mut self, robot: Point, surfaces: &Surfaces, passed_s: f64) {
        if !(robot.x.is_finite() && robot.y.is_finite() && passed_s.is_finite() && passed_s > 0.0) {
            return;
        }
        let from = self.links.nodes[0];
        let way_m = (robot - from).norm().max(self.law.speed_m_per_s * passed_s);
        let steps = (way_m / (FARTHEST_LINKS * self.link_m)).ceil().clamp(1.0, MOST_STEPS);
        for _ in 0..steps as usize {
            self.advance((robot - from) / steps, surfaces, passed_s / steps);
        }
        self.links.nodes[0] = robot;
    }

    /// Moves the robot by a short way.
    fn advance(&mut self, robot: Vector, surfaces: &Surfaces, passed_s: f64) {
        let Law { pull_n, pay_out_n, speed_m_per_s, length_m, .. } = self.law;
        let (pull_n, pay_out_n) = if self.is_wound_up() { (0.0, 0.0) } else { (pull_n, pay_out_n) };
        let feed = Feed {
            in_n: pull_n,
            out_n: pull_n.max(pay_out_n),
            in_m: (speed_m_per_s * passed_s).min(FARTHEST_LINKS * self.link_m),
            out_m: (length_m - self.paid_out_m()).max(0.0),
        };
        let step = Step { links: &self.links, law: self.law, surfaces, robot, feed };
        step.solve(&mut self.found);
        let most_m = FARTHEST_LINKS * self.link_m;
        let last = self.links.nodes.len() - 1;
        self.links.nodes[0] += robot;
        for node in 1..last {
            let moved = self.found.moved[node];
            let moved = if moved.norm() > most_m { moved * (most_m / moved.norm()) } else { moved };
            self.links.nodes[node] += moved;
        }
        self.feed(self.found.feed_m);
    }

    /// Lengthens or shortens the link at the reel; adds or removes a node beside the anchor. A loose end stays there when it
    /// has come to the reel.
    fn feed(&mut self, feed_m: f64) {
        let Links { nodes, rest_m, torn } = &mut self.links;
        let last = rest_m.len() - 1;
        rest_m[last] = (rest_m[last] + feed_m).max(LEAST_M);
        let anchor = nodes[last + 1];
        if rest_m[last] > 1.5 * self.link_m {
            let share = self.link_m / rest_m[last];
            let between = nodes[last] + (anchor - nodes[last]) * share;
            nodes.insert(last + 1, between);
            let left_m = rest_m[last] - self.link_m;
            rest_m[last] = self.link_m;
            rest_m.push(left_m);
            let moved = self.found.moved[last];
            self.found.moved.insert(last + 1, moved);
        } else if last > 0 && rest_m[last] < 0.5 * self.link_m {
            if *torn == Some(last - 1) {
                (nodes[last], rest_m[last]) = (anchor, LEAST_M);
                return;
            }
            let joined_m = rest_m[last - 1] + rest_m[last];
            rest_m.pop();
            rest_m[last - 1] = joined_m;
            nodes.remove(last);
            self.found.moved.remove(last);
        }
    }

    /// Length of cable off the reel, metres; of a torn cable, up to its loose end.
    pub fn paid_out_m(&self) -> f64 {
        self.links.rest_m[self.links.torn.map_or(0, |torn| torn + 1)..].iter().sum()
    }

    /// Pull of the cable at the robot, newtons: next to nothing if the cable is slack there.
    pub fn pull_at_robot_n(&self) -> f64 {
        self.found.pull_n.first().copied().unwrap_or_default()
    }

    /// Pull of the cable at the reel, newtons.
    pub fn pull_at_reel_n(&self) -> f64 {
        self.found.pull_n.last().copied().unwrap_or_default()
    }

    /// Whether the robot has drawn the cable beyond the length on the reel.
    pub fn is_at_its_end(&self) -> bool {
        let links = self.links.nodes.windows(2).zip(&self.links.rest_m);
        let stretched_m: f64 =
            links.map(|(pair, rest_m)| ((pair[1] - pair[0]).norm() - rest_m).max(0.0)).sum();
        !self.is_torn() && self.paid_out_m() >= self.law.length_m - 1e-6 && stretched_m > STRETCHED_M
    }

    /// The line of the cable from the anchor or, if it is torn, from the loose end to the robot, tank frame, without points
    /// that lie within `by_m` metres of the line without them.
    pub fn line(&self, by_m: f64) -> Vec<Point> {
        let last = self.links.torn.unwrap_or(self.links.nodes.len() - 1);
        let nodes: Vec<Point> = self.links.nodes[..=last].iter().rev().copied().collect();
        let mut kept = vec![nodes[0]];
        thin(&nodes, by_m, &mut kept);
        kept
    }

    /// The reel stops taking the cable up.
    pub fn stop_reel(&mut self) {
        self.law.pull_n = 0.0;
    }

    /// Tears the cable where it is pulled most. Then each of the two pieces has a loose end, and the reel takes its piece up.
    /// A cable with fewer than three links off the reel stays whole.
    pub fn tear(&mut self) {
        let last = self.links.rest_m.len() - 1;
        let pull_n = |link: usize| self.found.pull_n.get(link).copied().unwrap_or_default();
        let most = (1..last).max_by(|a, b| pull_n(*a).total_cmp(&pull_n(*b)));
        self.links.torn = self.links.torn.or(most);
    }

    /// Whether the cable is torn.
    pub fn is_torn(&self) -> bool {
        self.links.torn.is_some()
    }

    /// Whether the reel has taken up a torn cable to its loose end.
    fn is_wound_up(&self) -> bool {
        let last = self.links.rest_m.len() - 1;
        self.links.torn.is_some_and(|torn| torn + 1 == last) && self.links.rest_m[last] <= LEAST_M
    }

    /// Whether the hull, a disc around the robot, stands on a part of the cable that does not lead straight away from it.
    pub fn is_under(&self, hull_m: f64) -> bool {
        let Links { nodes, rest_m, torn } = &self.links;
        let mut along_m = 0.0;
        nodes.windows(2).zip(rest_m).enumerate().any(|(link, (pair, link_m))| {
            along_m += link_m;
            let aside = polyline::nearest_on_segment(pair[0], pair[1], nodes[0]) - nodes[0];
            *torn != Some(link) && along_m > 3.0 * hull_m && aside.norm() < hull_m
        })
    }
}

/// Adds the points of a line after its first that are needed for a given accuracy, metres.
fn thin(line: &[Point], by_m: f64, kept: &mut Vec<Point>) {
    let (first, last) = (line[0], line[line.len() - 1]);
    let aside_m = |at: &Point| (polyline::nearest_on_segment(first, last, *at) - at).norm();
    let farthest = (1..line.len() - 1).max_by(|a, b| aside_m(&line[*a]).total_cmp(&aside_m(&line[*b])));
    match farthest.filter(|at| aside_m(&line[*at]) > by_m) {
        Some(at) => {
            thin(&line[..=at], by_m, kept);
            thin(&line[at..], by_m, kept);
        }
        None => kept.push(last),
    }
}
