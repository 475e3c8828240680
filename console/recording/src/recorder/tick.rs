//! The data of one tick.

use super::{
    lane::{Flat, flat},
    stream::At,
};
use mission::{
    EventKind,
    event::{MeasuredPull, taut_line},
};
use planner_api::{Drawing, Drive};
use positioning::{
    Fix, Ranging,
    fix::{ellipse_95, position_covariance},
};
use world::{Point, Pose, Scan};

/// The data that one tick has reported so far.
#[derive(Default)]
pub(crate) struct Tick {
    pub at: At,
    pub drawings: Vec<Drawing>,
    pub truth: Option<Truth>,
    pub estimate: Option<Estimate>,
    /// The planner's command; no event states that a held robot is commanded to stand still.
    commanded_m_per_s: Option<f64>,
    is_held: bool,
    /// Scanned share of the reachable floor.
    pub covered: Option<f64>,
    pub cross_track_m: Option<f64>,
    pub tether: Option<Tether>,
    pub true_tether_m: Option<f64>,
    /// The line of the true cable, in the ticks that state it.
    pub cable: Option<Vec<Flat>>,
    pub ranges: Option<Vec<Ranging>>,
    pub fix: Option<Fix>,
    /// Protection level, metres.
    pub protection_m: Option<f64>,
    /// Figures of the planner: name, value, unit.
    pub scalars: Vec<(String, f64, String)>,
    /// The latest estimated position.
    pub believed: Point,
    /// The estimated heading, radians.
    heading_rad: f64,
    /// The scan of this tick.
    scan: Option<Scan>,
    /// The latest target of the robot.
    pub target: Option<Point>,
    /// The anchor of the tether.
    anchor: Option<Point>,
    /// The latest true position.
    before: Option<(At, Point)>,
}

/// The true pose of the robot.
#[derive(Clone, Copy)]
pub(crate) struct Truth {
    pub pose: Pose,
    pub clearance_m: f64,
}

/// The estimated pose of the robot.
#[derive(Clone, Copy)]
pub(crate) struct Estimate {
    pub position: Point,
    /// Semi-axes, metres, and direction of the longer one, radians.
    pub ellipse_95: (f64, f64, f64),
}

/// The tether according to the estimate.
pub(crate) struct Tether {
    pub line: Vec<Flat>,
    pub contacts: Vec<Flat>,
    pub length_m: f64,
    pub return_length_m: Option<f64>,
    pub wrap_max_deg: f64,
    pub wrap_total_deg: f64,
    pub pull_n: Option<f64>,
    pub measured: Option<MeasuredPull>,
}

impl Tick {
    /// The first tick of a run; `anchor`: the anchor of the tether.
    pub(crate) fn first(at: At, start: Point, anchor: Option<Point>) -> Self {
        Self { at, believed: start, anchor, ..Self::default() }
    }

    /// The tick that follows this one.
    pub(crate) fn next(&self, at: At) -> Self {
        let before = self.truth.map(|truth| (self.at, truth.pose.position)).or(self.before);
        Self {
            before,
            is_held: self.is_held,
            target: self.target,
            ..Self::first(at, self.believed, self.anchor)
        }
    }

    /// Adds an event of the tick.
    pub(crate) fn apply(&mut self, event: &EventKind) {
        match event {
            EventKind::Truth { pose, clearance_m, .. } => {
                self.truth = Some(Truth { pose: *pose, clearance_m: *clearance_m });
            }
            EventKind::Estimated { pose } => {
                let ellipse_95 = ellipse_95(&position_covariance(&pose.covariance));
                self.believed = pose.position;
                self.heading_rad = pose.heading_rad;
                self.estimate = Some(Estimate { position: pose.position, ellipse_95 });
            }
            EventKind::Protected { level_m } => self.protection_m = *level_m,
            EventKind::Scanned { scan } => self.scan = Some((**scan).clone()),
            EventKind::Sensed { readings, .. } => self.scan.clone_from(&readings.scan),
            EventKind::Commanded { command, .. } => self.commanded_m_per_s = Some(speed(&command.drive)),
            EventKind::Held { .. } => self.is_held = true,
            EventKind::Resumed => self.is_held = false,
            EventKind::Drawn { drawings } => self.drawings.extend(drawings),
            EventKind::Ranged { ranges } => self.ranges = Some(ranges.clone()),
            EventKind::Fixed { fix } => self.fix = Some(fix.clone()),
            EventKind::Scalars { scalars } => self.scalars.extend_from_slice(scalars),
            EventKind::Progressed { covered_reachable, cross_track_m, target, .. } => {
                self.target = Some(*target);
                self.covered = Some(*covered_reachable);
                self.cross_track_m = *cross_track_m;
            }
            EventKind::TetherTruth { length_m, lies, .. } => {
                self.true_tether_m = Some(*length_m);
                let line = lies.as_ref().map(|lies| &lies.line).filter(|line| !line.is_empty());
                self.cable = line.map(|line| line.iter().copied().map(flat).collect());
            }
            EventKind::Tethered {
                length_m,
                contacts,
                wrap_max_rad,
                wrap_total_rad,
                pull_n,
                measured,
                return_length_m,
                bends,
                ..
            } => {
                self.tether = Some(Tether {
                    line: self.anchor.map_or_else(Vec::new, |anchor| {
                        taut_line(anchor, bends, self.believed).into_iter().map(flat).collect()
                    }),
                    contacts: contacts.iter().map(|contact| flat(contact.at)).collect(),
                    length_m: *length_m,
                    return_length_m: *return_length_m,
                    wrap_max_deg: wrap_max_rad.to_degrees(),
                    wrap_total_deg: wrap_total_rad.to_degrees(),
                    pull_n: *pull_n,
                    measured: *measured,
                });
            }
            _ => {}
        }
    }

    /// The scanned points of this tick, placed by the estimated pose; `None` without a scan.
    pub(crate) fn scanned(&self) -> Option<Vec<Flat>> {
        let estimate = self.estimate?;
        let pose = Pose { position: estimate.position, heading_rad: self.heading_rad };
        let tank_from_robot = pose.tank_from_robot();
        Some(self.scan.as_ref()?.points().map(|point| flat(tank_from_robot * point)).collect())
    }

    /// The speed that is sent to the robot.
    pub(crate) fn speed_sent_m_per_s(&self) -> Option<f64> {
        self.commanded_m_per_s.or(self.is_held.then_some(0.0))
    }

    /// Distance between estimate and truth, metres.
    pub(crate) fn error_m(&self) -> Option<f64> {
        Some((self.estimate?.position - self.truth?.pose.position).norm())
    }

    /// True speed since the previous tick.
    pub(crate) fn speed_m_per_s(&self) -> Option<f64> {
        let (then, from) = self.before.filter(|(then, _)| self.at.sim_ns > then.sim_ns)?;
        let seconds = (self.at.sim_ns - then.sim_ns) as f64 * 1e-9;
        Some((self.truth?.pose.position - from).norm() / seconds)
    }
}

fn speed(drive: &Drive) -> f64 {
    match drive {
        Drive::Twist { v_m_per_s, .. } => v_m_per_s.abs(),
        Drive::Velocity(velocity) => velocity.norm(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mission::{HoldReason, Resumes};

    #[test]
    fn a_held_robot_is_commanded_to_stand_until_it_is_resumed() {
        let held = EventKind::Held { by: HoldReason::Operator, resumes: Resumes::Never };
        let mut tick = Tick::first(At::default(), Point::origin(), None);
        assert_eq!(tick.speed_sent_m_per_s(), None);
        tick.apply(&held);
        let mut next = tick.next(At::default());
        assert_eq!((tick.speed_sent_m_per_s(), next.speed_sent_m_per_s()), (Some(0.0), Some(0.0)));
        next.apply(&EventKind::Resumed);
        assert_eq!(next.next(At::default()).speed_sent_m_per_s(), None);
    }
}
