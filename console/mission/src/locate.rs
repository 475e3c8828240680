//! Where the robot believes to be, and whether that can be relied on.

use crate::{config::MissionConfig, event::EventKind};
use planner_api::PoseEstimate;
use positioning::{Exclusion, Fix, MotionNoise, Positioner, PositionerConfig};
use std::collections::BTreeSet;
use world::{Point, Pose, Readings, Station, StationId};

/// The positioner with its memory of which stations were used and whether the position was good.
pub struct Locator {
    positioner: Positioner,
    limit_m: f64,
    left_out: BTreeSet<StationId>,
    last_cycle_failed: bool,
    lost: bool,
}

impl Locator {
    /// A locator at the surveyed start.
    pub fn new(config: &MissionConfig, stations: &[Station]) -> Self {
        let positioner = Positioner::new(PositionerConfig {
            start_sigma_m: config.start_sigma_m,
            heading_sigma_rad: config.start_heading_sigma_rad,
            range_sigma_ratio: config.range_sigma_ratio,
            odometry: MotionNoise {
                sigma_per_m: config.odometry_sigma_per_m,
                turn_sigma_ratio: config.odometry_turn_sigma_per_rad,
                heading_sigma_per_tick_rad: config.gyro_sigma_rad_per_s * config.tick_s,
            },
            ..PositionerConfig::new(stations.to_vec(), config.start)
        });
        Self {
            positioner,
            limit_m: config.position_limit_m,
            left_out: BTreeSet::new(),
            last_cycle_failed: false,
            lost: false,
        }
    }

    /// Takes what was sensed since the last tick; tells what came of it.
    pub fn take(&mut self, readings: &Readings) -> Vec<EventKind> {
        self.positioner.predict(&readings.odometry);
        let mut events = if readings.ranging_cycle { self.cycle(readings) } else { Vec::new() };
        events.push(EventKind::Estimated { pose: self.pose_estimate() });
        events.extend(self.judge());
        events
    }

    fn cycle(&mut self, readings: &Readings) -> Vec<EventKind> {
        let result = self.positioner.cycle(&readings.ranges);
        let mut events = vec![EventKind::Ranged { ranges: result.rangings }];
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

    fn stations_changed(&mut self, fix: &Fix) -> Vec<EventKind> {
        let out: BTreeSet<StationId> = fix.excluded.iter().map(|(station, _)| *station).collect();
        let reason_of = |station: &StationId| {
            fix.excluded.iter().find(|(id, _)| id == station).map_or(Exclusion::Silent, |(_, reason)| *reason)
        };
        let newly_out = out.difference(&self.left_out);
        let back = self.left_out.difference(&out);
        let events = newly_out
            .map(|station| EventKind::StationExcluded { station: *station, reason: reason_of(station) })
            .chain(back.map(|station| EventKind::StationRegained { station: *station }))
            .collect();
        self.left_out = out;
        events
    }

    fn judge(&mut self) -> Option<EventKind> {
        let error_m = self.error_95_m();
        let lost = error_m > self.limit_m;
        let changed = lost != std::mem::replace(&mut self.lost, lost);
        changed.then_some(if lost {
            EventKind::PositionLost { error_m, limit_m: self.limit_m }
        } else {
            EventKind::PositionRegained { error_m }
        })
    }

    /// Whether the position error is beyond the limit.
    pub fn is_lost(&self) -> bool {
        self.lost
    }

    /// The longer half axis of the 95 % ellipse, metres.
    pub fn error_95_m(&self) -> f64 {
        self.positioner.error_95_m()
    }

    /// Estimated position, metres.
    pub fn position(&self) -> Point {
        self.pose().position
    }

    /// Estimated pose.
    pub fn pose(&self) -> Pose {
        self.positioner.estimate().pose
    }

    /// Estimated pose with its covariance, as planners read it.
    pub fn pose_estimate(&self) -> PoseEstimate {
        let estimate = self.positioner.estimate();
        PoseEstimate {
            position: estimate.pose.position,
            heading_rad: estimate.pose.heading_rad,
            covariance: estimate.covariance,
        }
    }
}
