//! The guard by the raw scan: the scanned points, and when the robot is held because of them.

use super::{
    super::Mission,
    super::known::Known,
    scan_fault::{MAX_AGE_S, ScanFault},
    speed,
    state::Limited,
};
use crate::{
    config::MissionConfig,
    event::{EventKind, rounded_command},
    governor::guard::{Guard, Guarded, Sent},
    phase::{Hold, HoldReason, Resumes},
};
use geometry::{Braking, Drive};
use perception::Sensor;
use planner_api::Command;
use world::{Odometry, Point, Readings, Scan, scan::carried};

/// Maximum number of ticks for which the robot has moved since its readings arrived.
const READING_TICKS: usize = 1;
/// Age of readings, seconds, above which nothing depends on how old they are: the link is lost before.
const READING_MAX_AGE_S: f64 = 1.0;
/// Distance, metres, that is added to the stopping distance at full speed; points farther from the hull than the sum
/// are dropped. This distance is longer than the one that the robot travels before its scan is too old.
const KEPT_M: f64 = 2.0;
/// The robot is held after this many scans in a row by which the hull could touch a point although the robot brakes
/// without delay. A single such scan may be noise; the robot brakes at once in any case.
const LATE_SCANS: u32 = 2;
/// Number of scans before the last one whose points count on the course.
const EARLIER_SCANS: usize = 3;
/// The robot is held if the guard has kept it from moving for this long, seconds.
const BLOCKED_S: f64 = 2.0;
/// Share of the requested speed below which the robot does not move.
const BLOCKED_SHARE: f64 = 0.1;
/// The guard is reported after it has limited the robot for this long, seconds.
const NAMED_AFTER_S: f64 = 0.5;

/// The state of the guard.
#[derive(Debug, Clone, Default)]
pub(in crate::engine) struct ScanGuard {
    /// The points of the last scan, in the robot frame now.
    points: Vec<Point>,
    /// The points of the scans before, the latest first, in the robot frame now; with less noise, if it is known.
    earlier: Vec<Vec<Point>>,
    /// The last scan and the motion since then, if the noise of the scanner is known: the robot brakes for every single
    /// point, but noise alone does not hold the robot.
    noisy: Option<Noisy>,
    /// Whether a scan has arrived.
    pub(super) has_scan: bool,
    /// Age of the last scan, or of the mission before the first one, seconds.
    pub(super) age_s: f64,
    /// The motion that the vehicle may still have to carry out, oldest first.
    sent: Vec<Sent>,
    /// Age of the newest readings on arrival, seconds.
    reading_age_s: f64,
    /// The point that limits the robot: distance from the hull, metres, and direction, radians.
    before: Option<(f64, f64)>,
    /// The number of scans in a row by which the hull touches a point even if the vehicle follows at once.
    late_scans: u32,
    /// Whether the hull could touch a point, and whether this began in this tick.
    is_late: bool,
    is_late_now: bool,
    blocked_s: f64,
    limited: Limited,
    /// The fault of the scans that was reported last.
    pub(super) told_fault: Option<ScanFault>,
}

impl ScanGuard {
    /// The motion sent that a vehicle may not have carried out yet when its readings were taken, if it follows a command
    /// after `reaction_s`.
    fn sent_for(&self, reaction_s: f64, tick_s: f64) -> &[Sent] {
        let ticks = ticks(reaction_s + self.reading_age_s, tick_s);
        &self.sent[self.sent.len().saturating_sub(ticks)..]
    }
}

/// The number of ticks whose motion can follow on readings that were taken `age_s` ago.
fn ticks(age_s: f64, tick_s: f64) -> usize {
    (age_s / tick_s).ceil() as usize + READING_TICKS
}

/// A scan from which noise can be removed.
#[derive(Debug, Clone)]
struct Noisy {
    scan: Scan,
    sigma_m: f64,
    /// The motion of each tick since the scan.
    moved: Vec<Odometry>,
}

impl Noisy {
    /// The points with less noise within a distance in metres from the robot, robot frame now.
    fn evened(&self, far_m: f64) -> Vec<Point> {
        let now = |point: Point| self.moved.iter().fold(point, carried);
        let points = near(&self.scan.evened(self.sigma_m), far_m);
        points.into_iter().map(now).collect()
    }
}

/// The points of a scan within a distance in metres from the robot.
fn near(scan: &Scan, far_m: f64) -> Vec<Point> {
    scan.points().filter(|point| point.coords.norm() <= far_m).collect()
}

impl Known {
    /// Takes the scan of a tick; `age_s` is the age of the readings.
    pub(in crate::engine) fn take_scan(&mut self, readings: &Readings, age_s: f64) {
        if self.config.guard_reaction_s.is_none() {
            return;
        }
        let far_m = reach_m(&self.config);
        let sigma_m = self.config.sensor.filter(Sensor::is_known).map(|sensor| sensor.sigma_m);
        let guard = &mut self.scan_guard;
        guard.reading_age_s = age_s.min(READING_MAX_AGE_S);
        for point in guard.earlier.iter_mut().flatten() {
            *point = carried(*point, &readings.odometry);
        }
        if let Some(scan) = &readings.scan {
            // Of a surface, noise must not remain for several scans; of a thin post, the points stay as they are.
            let evened = guard.noisy.as_ref().map(|noisy| noisy.evened(far_m));
            let mut before = std::mem::replace(&mut guard.points, near(scan, far_m));
            before = evened.unwrap_or(before);
            for point in &mut before {
                *point = carried(*point, &readings.odometry);
            }
            guard.earlier.truncate(EARLIER_SCANS - 1);
            guard.earlier.insert(0, before);
            guard.noisy = sigma_m.map(|sigma_m| Noisy { scan: scan.clone(), sigma_m, moved: Vec::new() });
            (guard.has_scan, guard.age_s) = (true, 0.0);
            return;
        }
        for point in &mut guard.points {
            *point = carried(*point, &readings.odometry);
        }
        // A scan that is too old holds the robot, whatever it shows.
        if let Some(noisy) = guard.noisy.as_mut().filter(|_| guard.age_s <= MAX_AGE_S) {
            noisy.moved.push(readings.odometry);
        }
        guard.age_s += self.config.tick_s;
    }

    /// Whether the guard waits for its first scan.
    pub(in crate::engine) fn awaits_scan(&self) -> bool {
        self.config.guard_reaction_s.is_some() && !self.scan_guard.has_scan
    }

    /// Limits a command by the scan; the robot must be able to stop before it touches any scanned point.
    pub(in crate::engine) fn guarded(&mut self, command: Command) -> Command {
        let Some(reaction_s) = self.config.guard_reaction_s else { return command };
        if !self.scan_guard.has_scan {
            return Command { drive: Drive::STILL, ..command };
        }
        let (here, tick_s) = (self.as_governed(), self.config.tick_s);
        let state = &self.scan_guard;
        let guard = Guard::new(&state.points, &here, state.sent_for(reaction_s, tick_s))
            .remembering(state.earlier.iter().map(Vec::as_slice));
        let Guarded { drive, before, is_late } = guard.guarded(&self.governor.momentum, command.drive);
        let evened =
            state.noisy.as_ref().filter(|_| is_late).map(|noisy| noisy.evened(reach_m(&self.config)));
        let touches = |reaction_s: f64| {
            let points = evened.as_ref().unwrap_or(&state.points);
            Guard::new(points, &here, state.sent_for(reaction_s, tick_s)).touches(&self.governor.momentum)
        };
        let is_late = is_late && touches(reaction_s);
        let is_certain = is_late && touches(0.0);
        let state = &mut self.scan_guard;
        state.before = before;
        state.is_late_now = is_late && !std::mem::replace(&mut state.is_late, is_late);
        // Between two scans, the points are the same with the same noise.
        let is_new = state.age_s == 0.0 || state.late_scans == 0;
        state.late_scans = if is_certain { state.late_scans + u32::from(is_new) } else { 0 };
        let is_blocked = before.is_some() && speed(drive) < BLOCKED_SHARE * speed(command.drive);
        state.blocked_s = if is_blocked { state.blocked_s + self.config.tick_s } else { 0.0 };
        if before.is_some() { rounded_command(Command { drive, ..command }) } else { command }
    }

    /// Remembers the drive of a tick until the vehicle has certainly followed it.
    pub(in crate::engine) fn remember_sent(&mut self, drive: Drive) {
        let Some(reaction_s) = self.config.guard_reaction_s else { return };
        let sent = Sent::of(&self.governor.momentum, drive, &self.as_governed());
        let kept = ticks(reaction_s + READING_MAX_AGE_S, self.config.tick_s);
        let state = &mut self.scan_guard;
        state.sent.push(sent);
        let over = state.sent.len().saturating_sub(kept);
        state.sent.drain(..over);
    }

    /// Reports the guard once it has limited the robot for long enough, and at once if the robot must stop.
    pub(in crate::engine) fn note_guard(&mut self, asked: Drive, sent: Drive) -> Option<EventKind> {
        let state = &mut self.scan_guard;
        let is_named = state.limited.update(state.before.is_some(), self.config.tick_s, NAMED_AFTER_S);
        let (gap_m, direction_rad) = state.before.filter(|_| is_named || state.is_late_now)?;
        let (asked_m_per_s, sent_m_per_s) = (speed(asked), speed(sent));
        Some(EventKind::Guarded { asked_m_per_s, sent_m_per_s, gap_m, direction_rad })
    }

    /// Why the guard stops the robot, as a clause.
    fn guard_stop(&self) -> Option<String> {
        self.config.guard_reaction_s?;
        if let Some(fault) = self.scan_fault() {
            return Some(fault.to_string());
        }
        let guard = &self.scan_guard;
        let (gap_m, direction_rad) = guard.before?;
        if guard.late_scans < LATE_SCANS && guard.blocked_s < BLOCKED_S {
            return None;
        }
        let (gap_m, side) = (gap_m.max(0.0), side(direction_rad));
        Some(format!("the scan shows something {gap_m:.2} m from the hull, {side}"))
    }
}

/// Distance from the robot's centre within which a point can matter until the next scan, metres.
fn reach_m(config: &MissionConfig) -> f64 {
    let fastest = config.limits.v_max_m_per_s;
    let age_s = if config.live { READING_MAX_AGE_S } else { 0.0 };
    let reaction_s = config.guard_reaction_s.unwrap_or_default() + age_s;
    config.limits.radius_m + Braking::of(&config.limits).distance_m(fastest) + fastest * reaction_s + KEPT_M
}

/// A direction in the robot frame in words.
pub(crate) fn side(direction_rad: f64) -> &'static str {
    match direction_rad.to_degrees() {
        degrees if degrees.abs() <= 30.0 => "ahead",
        degrees if degrees.abs() >= 150.0 => "behind",
        degrees if degrees >= 120.0 => "behind on the left",
        degrees if degrees <= -120.0 => "behind on the right",
        degrees if degrees >= 60.0 => "on the left",
        degrees if degrees <= -60.0 => "on the right",
        degrees if degrees > 0.0 => "ahead on the left",
        _ => "ahead on the right",
    }
}

impl Mission {
    /// Holds a moving robot that the guard has stopped; only an order ends that hold. Returns whether it was held.
    pub(in crate::engine) fn hold_by_guard(&mut self) -> bool {
        if !self.known.is_running() {
            return false;
        }
        let Some(message) = self.known.guard_stop() else { return false };
        self.known.scan_guard.late_scans = 0;
        self.known.scan_guard.blocked_s = 0.0;
        self.hold(Hold { by: HoldReason::Guard { message }, resumes: Resumes::Never });
        self.go_on_or_help();
        true
    }
}
