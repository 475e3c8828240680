//! The record of a run over time and place: track, tether, stations, and incidents.

mod incidents;
mod stations;
mod tether;

pub use incidents::Incident;
pub use stations::StationRecord;
pub use tether::{Lay, TetherPoint, TetherRecord};

use incidents::Incidents;
use mission::{Event, EventKind, PlannerInfo};
use planner_api::LegTag;
use positioning::fix::{ellipse_95, position_covariance};
use stations::Stations;
use world::{Point, Pose};

/// Time between two stored values of the coverage, seconds.
const PROGRESS_S: f64 = 5.0;

/// Maximum number of stored planner changes.
const MOST_PLANNERS: usize = 1000;

/// The estimated position in a tick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrackPoint {
    /// Mission time, seconds.
    pub t_s: f32,
    /// East, metres.
    pub x_m: f32,
    /// North, metres.
    pub y_m: f32,
    /// Heading, radians.
    pub heading_rad: f32,
    /// 95 % error according to the covariance, metres.
    pub error_m: f32,
    /// Distance to the true position, metres; NaN outside simulation.
    pub true_error_m: f32,
}

impl TrackPoint {
    /// The position.
    pub fn position(&self) -> Point {
        Point::new(f64::from(self.x_m), f64::from(self.y_m))
    }
}

/// A span of mission time, seconds.
pub type Span = (f64, f64);

/// Everything that a report shows over time and place.
#[derive(Debug, Default)]
pub struct Record {
    /// The estimated position in every tick.
    pub track: Vec<TrackPoint>,
    /// Scanned share of the reachable floor over time.
    pub progress: Vec<(f64, f64)>,
    /// Times on a lane, and times off the lanes.
    pub scanning: [Vec<Span>; 2],
    /// The tether record; absent without a tether.
    pub tether: Option<TetherRecord>,
    /// The planners that were active, in order.
    pub planners: Vec<PlannerInfo>,
    truth: Option<(u64, Pose)>,
    stations: Stations,
    incidents: Incidents,
}

impl Record {
    /// An empty record.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds an event; events must come in the order of the journal.
    pub fn apply(&mut self, event: &Event) {
        self.incidents.apply(event);
        match &event.kind {
            EventKind::RunOpened(run) => {
                self.stations = Stations::new(&run.world.stations);
                self.tether = run.mission.tether.as_ref().map(TetherRecord::new);
            }
            EventKind::Truth { pose, .. } => self.truth = Some((event.tick, *pose)),
            EventKind::Estimated { pose } => {
                let error_m = ellipse_95(&position_covariance(&pose.covariance)).0;
                let truth = self.truth.filter(|(tick, _)| *tick == event.tick);
                let off = truth.map_or(f64::NAN, |(_, truth)| (truth.position - pose.position).norm());
                self.track.push(TrackPoint {
                    t_s: event.t_s as f32,
                    x_m: pose.position.x as f32,
                    y_m: pose.position.y as f32,
                    heading_rad: pose.heading_rad as f32,
                    error_m: error_m as f32,
                    true_error_m: off as f32,
                });
            }
            EventKind::Progressed { covered_reachable, leg, .. } => {
                if self.progress.last().is_none_or(|(t_s, _)| event.t_s - t_s >= PROGRESS_S) {
                    self.progress.push((event.t_s, *covered_reachable));
                }
                extend(&mut self.scanning[usize::from(*leg != Some(LegTag::Swath))], event.t_s);
            }
            EventKind::Tethered {
                length_m,
                paid_out_m,
                wrap_max_rad,
                wrap_total_rad,
                pull_factor,
                pull_n,
                bends,
                ..
            } => {
                let robot = self.track.last().map(|at| Point::new(f64::from(at.x_m), f64::from(at.y_m)));
                if let (Some(tether), Some(robot)) = (&mut self.tether, robot) {
                    let point = TetherPoint {
                        t_s: event.t_s as f32,
                        length_m: *length_m as f32,
                        wrap_max_rad: wrap_max_rad.abs() as f32,
                        wrap_total_rad: wrap_total_rad.abs() as f32,
                        pull_n: pull_n.map_or(f32::NAN, |pull_n| pull_n as f32),
                    };
                    let reel_off_m = paid_out_m.map(|out_m| (out_m - length_m).abs());
                    tether.lie(point, reel_off_m, *pull_factor, (bends, robot));
                }
            }
            EventKind::Certified { refused: false, certificate, .. } => {
                self.tether.iter_mut().for_each(|tether| tether.own_gap = certificate.own_gap);
            }
            EventKind::PlannerChosen { info, .. }
                if self.planners.len() < MOST_PLANNERS && self.planners.last() != Some(info) =>
            {
                self.planners.push((**info).clone());
            }
            EventKind::Fixed { fix } => self.stations.fix(fix),
            EventKind::ClocksEstimated { offsets } => self.stations.clocks(offsets),
            _ => {}
        }
    }

    /// The incidents in order; alarms and holds with their ends. If the run was cut off, the last incident states
    /// this.
    pub fn incidents(&self) -> Vec<Incident> {
        self.incidents.all()
    }

    /// The fixes, station by station.
    pub fn stations(&self) -> Vec<StationRecord> {
        self.stations.records()
    }

    /// The position estimated in the last tick up to a time; `None` before the first tick.
    pub fn at(&self, t_s: f64) -> Option<&TrackPoint> {
        let after = self.track.partition_point(|point| f64::from(point.t_s) <= t_s + 1e-3);
        self.track.get(after.checked_sub(1)?)
    }
}

/// Extends the last span if a moment follows it closely; if not, starts a new span.
fn extend(spans: &mut Vec<Span>, t_s: f64) {
    match spans.last_mut() {
        Some((_, to_s)) if t_s - *to_s < 2.0 => *to_s = t_s,
        _ => spans.push((t_s, t_s)),
    }
}
