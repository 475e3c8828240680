//! The robot's estimated position, and whether it is reliable.

mod protection;
mod pulses;
mod scan_aid;
mod session;

use crate::{
    config::MissionConfig,
    event::{ClockOffset, EventKind},
};
use perception::Matched;
use planner_api::PoseEstimate;
use positioning::{
    Agreement, Doubt, Exclusion, Fix, FixError, Impossible, Integrity, MotionNoise, Positioner,
    PositionerConfig, RangeNoise, Sides, StationClocks,
};
use protection::Protection;
use pulses::PulseTests;
use scan_aid::ScanAid;
use session::Session;
use std::{
    collections::{BTreeMap, BTreeSet},
    mem::discriminant,
};
use world::{Point, Pose, PulseSet, RangeSet, Readings, StationId, World};

/// The positioner, together with the stations in use and the reliability of the position so far.
///
/// Used by each mission, and by the code that locates recorded readings.
#[derive(Clone)]
pub struct Locator {
    positioner: Positioner,
    /// The protection of the pose; `None` if the scenario states no risk.
    protection: Option<Protection>,
    scan_aid: ScanAid,
    pulses: PulseTests,
    /// The calibration from the last fixes; `None` if the scenario asks for none.
    session: Option<Session>,
    /// The doubt about the ranges, without that of the session calibration.
    doubt: Doubt,
    limit_m: f64,
    tick_s: f64,
    /// The largest speed and turn rate of the robot, metres and radians per second.
    fastest: [f64; 2],
    /// Stations that the operator has excluded.
    unused: BTreeSet<StationId>,
    left_out: BTreeMap<StationId, Exclusion>,
    last_cycle_failed: bool,
    lost: bool,
    alarmed: bool,
    impossible: Vec<Impossible>,
    sides: Sides,
}

impl Locator {
    /// Creates a locator at the surveyed start.
    pub fn new(config: &MissionConfig, drawing: &World) -> Self {
        let locating = &config.locating;
        let normal = RangeNoise::Gaussian { sigma_ratio: config.range_sigma_ratio };
        let positioner = PositionerConfig {
            start_sigma_m: config.start_sigma_m,
            heading_sigma_rad: config.start_heading_sigma_rad,
            noise: locating.noise.unwrap_or(normal),
            timing: locating.timing,
            scale_sigma_ratio: locating.scale_sigma_ratio,
            aggregation: locating.aggregation,
            solver: locating.solver,
            calibrate_sound_speed: locating.calibrate_sound_speed,
            boundary: Some(drawing.boundary.clone()),
            odometry: MotionNoise {
                sigma_per_m: config.odometry_sigma_per_m,
                turn_sigma_ratio: config.odometry_turn_sigma_per_rad,
                heading_sigma_per_tick_rad: config.gyro_sigma_rad_per_s * config.tick_s,
                way_sigma_ratio: 0.0,
                slip_chance: 0.0,
            },
            risk: locating.risk,
            clocks: locating.clocks.map(|clocks| clocks.config(config.tick_s)),
            ..PositionerConfig::new(drawing.stations.clone(), config.start)
        };
        Self {
            protection: locating.risk.map(|risk| Protection::new(&positioner, risk)),
            pulses: PulseTests::new(locating, positioner.noise, &drawing.stations),
            session: locating.session.map(|how| Session::new(how, &positioner)),
            positioner: Positioner::new(positioner),
            scan_aid: ScanAid::default(),
            doubt: Doubt::default(),
            limit_m: config.position_limit_m,
            tick_s: config.tick_s,
            fastest: [config.limits.v_max_m_per_s, config.limits.w_max_rad_per_s],
            unused: BTreeSet::new(),
            left_out: BTreeMap::new(),
            last_cycle_failed: false,
            lost: false,
            alarmed: false,
            impossible: Vec::new(),
            sides: Sides::One,
        }
    }

    /// Sets whether the ranges from a station are used from now on.
    pub(crate) fn use_station(&mut self, station: StationId, used: bool) {
        if used {
            self.unused.remove(&station);
        } else {
            self.unused.insert(station);
        }
    }

    /// Sets whether the task is done, so that pulses from now on are those after the run.
    pub(crate) fn end_ranging(&mut self, has_ended: bool) {
        self.pulses.note_end(has_ended);
    }

    /// Increases the uncertainty of the pose after an unmeasured motion of at most `most_m` metres and `most_rad`
    /// radians.
    pub fn wander(&mut self, most_m: f64, most_rad: f64) {
        self.positioner.wander(most_m, most_rad);
        self.session.iter_mut().for_each(|session| session.wander(most_m));
        self.protection.iter_mut().for_each(|protection| protection.guard.wander(most_m, most_rad));
    }

    /// Reduces the weight of the ranges in the next cycles.
    pub fn doubt(&mut self, doubt: Doubt) {
        self.doubt = doubt;
        self.positioner.doubt(doubt);
        self.protection.iter_mut().for_each(|protection| protection.guard.doubt(doubt));
    }

    /// Ranges in the last cycle that are impossible at any place in the tank.
    pub fn impossible(&self) -> &[Impossible] {
        &self.impossible
    }

    /// How well fixes and measured motion have agreed so far.
    pub fn agreement(&self) -> Agreement {
        self.positioner.agreement()
    }

    /// How the choice between the last fix and its mirror image was made.
    pub fn sides(&self) -> Sides {
        self.sides
    }

    /// Keeps the pose that the scan of this tick shows, `None` if it shows none. The next [`Locator::take`] uses it.
    pub fn keep_match(&mut self, matched: Option<Matched>) {
        self.scan_aid.keep(matched);
    }

    /// Processes the readings since the last tick, at a mission time, seconds; returns the resulting events.
    pub fn take(&mut self, readings: &Readings, t_s: f64) -> Vec<EventKind> {
        let aided = self.scan_aid.correct(&mut self.positioner);
        if readings.unmeasured_s > 0.0 {
            let [most_m_per_s, most_rad_per_s] = self.fastest;
            self.wander(most_m_per_s * readings.unmeasured_s, most_rad_per_s * readings.unmeasured_s);
        }
        let heading_rad = self.pose().heading_rad;
        self.session.iter_mut().for_each(|session| session.predict(&readings.odometry, heading_rad));
        self.positioner.predict(&readings.odometry);
        self.protection.iter_mut().for_each(|protection| protection.guard.predict(&readings.odometry));
        let mut events: Vec<EventKind> = aided.into_iter().collect();
        events.extend(self.test_stations(&readings.pulses));
        if readings.ranging_cycle {
            events.extend(self.cycle(readings, t_s));
        }
        events.extend(self.protection.iter_mut().flat_map(|protection| protection.events(&self.positioner)));
        events.push(EventKind::Estimated { pose: self.pose_estimate() });
        events.extend(self.check_limit());
        events
    }

    /// Evaluates the pulses that the stations exchanged.
    fn test_stations(&mut self, pulses: &[PulseSet]) -> Vec<EventKind> {
        let Some((event, agreeing)) = self.pulses.take(pulses) else { return Vec::new() };
        let mut events = vec![event];
        if let Some(test) = &agreeing {
            let changes = self.pulses.clock_changes(test);
            self.positioner.take_pulses(test);
            self.protection.iter_mut().for_each(|protection| protection.guard.take_pulses(test));
            self.pulses.doubt().into_iter().for_each(|doubt| self.doubt(doubt));
            // Beside a session calibration, the test corrects no range.
            if changes.len() > 1 && self.session.is_some() {
                self.protection.iter_mut().for_each(|protection| protection.guard.note_two_wrong());
            }
            events.extend((!changes.is_empty()).then_some(EventKind::ClocksChanged { changes }));
        }
        events
    }

    fn cycle(&mut self, readings: &Readings, t_s: f64) -> Vec<EventKind> {
        let heard = readings.ranges.iter().filter(|set| !self.unused.contains(&set.station));
        let mut heard: Vec<RangeSet> = heard.cloned().collect();
        if !heard.is_empty() {
            self.pulses.note_ranges();
        }
        self.pulses.correct(&mut heard);
        let mut events = Vec::new();
        if let Some(session) = &mut self.session {
            events = session.take(&heard, &self.positioner.estimate(), t_s);
        }
        let calibration = self.session.as_ref().map(Session::calibration);
        let mut result = match calibration {
            None => self.positioner.cycle(&heard),
            Some(calibration) => {
                self.positioner.doubt(self.doubt.beside(calibration.doubt()));
                self.positioner.cycle(&calibration.corrected(&heard))
            }
        };
        if let Some(protection) = &mut self.protection {
            protection.guard.cycle(&heard, &result.fix, calibration);
            // A wrong station may have spoilt the calibration, which one fix does not show: then only the pose has a
            // level.
            if let (Some(_), Ok(fix)) = (calibration, &mut result.fix) {
                fix.protection_level_m = None;
            }
        }
        (self.impossible, self.sides) = (std::mem::take(&mut result.impossible), result.sides);
        if let Ok(fix) = &mut result.fix {
            let by_order = fix.excluded.iter_mut().filter(|(station, _)| self.unused.contains(station));
            by_order.for_each(|(_, reason)| *reason = Exclusion::ByOrder);
            self.session.iter().for_each(|session| session.explain(fix));
        }
        events.extend(self.clocks());
        events.push(EventKind::Ranged { ranges: result.rangings });
        events.extend(self.heed(&result.fix));
        match result.fix {
            Ok(fix) => {
                events.extend(self.stations_changed(&fix));
                self.last_cycle_failed = false;
                events.push(EventKind::Fixed { fix });
            }
            Err(error) => {
                let repeated = std::mem::replace(&mut self.last_cycle_failed, true);
                events.push(EventKind::FixFailed { error, repeated });
            }
        }
        events
    }

    /// The estimated clock of each station: its offset and the change of the offset in an hour, metres; empty if they share
    /// one clock.
    pub(crate) fn clocks_m(&self) -> Vec<(StationId, f64, f64)> {
        let clocks = self.positioner.clocks().map(StationClocks::clocks_m).unwrap_or_default();
        let per_hour = 3600.0 / self.tick_s;
        clocks.into_iter().map(|(id, offset_m, drift_m)| (id, offset_m, drift_m * per_hour)).collect()
    }

    /// The clocks of the stations; `None` if they share one clock.
    fn clocks(&self) -> Option<EventKind> {
        let offsets = self.positioner.clocks()?.offsets_m();
        let offsets = offsets.map(|(station, offset_m)| ClockOffset { station, offset_m }).collect();
        Some(EventKind::ClocksEstimated { offsets })
    }

    /// Raises the alarm if the ranges contradict each other and leaving out a station does not resolve the contradiction.
    /// The next consistent fix clears the alarm. A cycle without information changes nothing.
    fn heed(&mut self, fix: &Result<Fix, FixError>) -> Option<EventKind> {
        let contradiction = match fix {
            Ok(fix) if fix.integrity == Integrity::Alarm => Some((fix.chi2, fix.degrees_of_freedom)),
            Ok(_) => None,
            Err(FixError::Inconsistent { chi2, degrees_of_freedom }) => Some((*chi2, *degrees_of_freedom)),
            Err(_) => return None,
        };
        let was_alarmed = std::mem::replace(&mut self.alarmed, contradiction.is_some());
        match contradiction {
            Some((chi2, degrees_of_freedom)) if !was_alarmed => {
                Some(EventKind::RangesInconsistent { chi2, degrees_of_freedom })
            }
            None if was_alarmed => Some(EventKind::RangesConsistent),
            _ => None,
        }
    }

    fn stations_changed(&mut self, fix: &Fix) -> Vec<EventKind> {
        let out: BTreeMap<StationId, Exclusion> = fix.excluded.iter().copied().collect();
        // A new reason is reported; new numbers with the same reason are not.
        let is_news = |(station, reason): &(&StationId, &Exclusion)| {
            self.left_out.get(station).is_none_or(|before| discriminant(before) != discriminant(*reason))
        };
        let newly_out = out.iter().filter(is_news);
        let back = self.left_out.keys().filter(|station| !out.contains_key(station));
        let events = newly_out
            .map(|(station, reason)| EventKind::StationRejected { station: *station, reason: *reason })
            .chain(back.map(|station| EventKind::StationRestored { station: *station }))
            .collect();
        self.left_out = out;
        events
    }

    fn check_limit(&mut self) -> Option<EventKind> {
        let error_m = self.error_95_m();
        let lost = error_m > self.limit_m;
        let changed = lost != std::mem::replace(&mut self.lost, lost);
        changed.then_some(if lost {
            EventKind::PositionLost { error_m, limit_m: self.limit_m }
        } else {
            EventKind::PositionRegained { error_m }
        })
    }

    /// Whether the ranges contradict each other, so that it is unknown which of them are correct.
    pub(crate) fn is_alarmed(&self) -> bool {
        self.alarmed
    }

    /// Whether the position error is beyond the limit.
    pub(crate) fn is_lost(&self) -> bool {
        self.lost
    }

    /// The longer semi-axis of the 95 % ellipse, metres.
    pub(crate) fn error_95_m(&self) -> f64 {
        self.positioner.error_95_m()
    }

    /// Estimated position, metres.
    pub(crate) fn position(&self) -> Point {
        self.pose().position
    }

    /// Estimated pose.
    pub(crate) fn pose(&self) -> Pose {
        self.positioner.estimate().pose
    }

    /// Estimated pose with its covariance, in the form that planners receive.
    pub fn pose_estimate(&self) -> PoseEstimate {
        let estimate = self.positioner.estimate();
        PoseEstimate {
            position: estimate.pose.position,
            heading_rad: estimate.pose.heading_rad,
            covariance: estimate.covariance,
        }
    }
}
