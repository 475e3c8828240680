//! The readings of an instrument: where they were taken, what they show, and what was found.
//!
//! In a simulation, the readings follow from the true and the estimated track, the true thickness of the floor and the
//! seed. They are therefore computed from the events of the run, like its figures, and are not events themselves.

mod detection;
mod imported;
mod judge;
mod noise;
mod plates;
#[cfg(test)]
mod tests;
mod track;
mod worn;

pub use detection::{Detection, Detections};
pub use imported::Imported;
pub use judge::{Finding, Judge, LOSS_CLASSES};
pub use plates::PlateThickness;
pub use track::{Track, Whereabouts};

use mission::{InstrumentConfig, Sampling, event::RunOpened};
use nalgebra::{Matrix2, Matrix2x3};
use planner_api::PoseEstimate;
use serde::{Deserialize, Serialize};
use world::{Cell, Floor, Point, Pose, Vector, geometry::unit_vector};
use worn::Worn;

/// A reading of one channel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reading {
    /// Mission time, seconds.
    pub t_s: f64,
    /// Number of the channel; channel 0 is on the right.
    pub channel: u16,
    /// The place according to the estimated track, tank frame, metres.
    pub at: Point,
    /// Covariance of the place, square metres.
    pub covariance: Matrix2<f64>,
    /// Thickness of the floor, millimetres.
    pub thickness_mm: f64,
    /// Whether the instrument can test this place; readings beside welds are kept, but not judged.
    pub is_testable: bool,
}

/// The number of readings of a run, and what they show.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ReadingsSummary {
    /// Number of readings.
    pub count: u64,
    /// Number of readings that are not judged: beside welds or, for imported readings, where floor does not count as
    /// scanned.
    pub untestable: u64,
    /// Number of indications.
    pub indications: u64,
    /// The deepest indication; absent without indications.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub deepest: Option<Finding>,
    /// The probability of detection: the share of the true losses of at least a fifth of the thickness, among those whose
    /// deepest place was tested, that are in an indication; absent if the true losses are not known, or no such place
    /// was tested.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub detected: Option<f64>,
    /// Number of indications where no metal is lost; absent if the true losses are not known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub false_calls: Option<u64>,
}

/// The instrument on its way over a simulated floor.
#[derive(Debug, Clone)]
pub struct Survey {
    sampling: Sampling,
    swath_m: f64,
    seed: u64,
    worn: Worn,
    judge: Judge,
    before: Option<Before>,
    /// Way from the last pose to the next reading, metres.
    due_m: f64,
    count: u64,
    untestable: u64,
    latest: Vec<Reading>,
}

/// The previous pose.
#[derive(Debug, Clone, Copy)]
struct Before {
    t_s: f64,
    estimated: Pose,
    truth: Pose,
}

impl Survey {
    /// The instrument of a run; `None` if it reads no thickness, or if the true thickness is not known.
    pub(crate) fn new(run: &RunOpened) -> Option<Self> {
        let InstrumentConfig { sampling, .. } = run.mission.instrument.as_ref()?;
        let (sampling, wear) = ((*sampling)?, run.wear.as_ref()?);
        Some(Self {
            sampling,
            swath_m: run.mission.swath_m,
            seed: run.seed,
            worn: Worn::new(wear.clone()),
            judge: Judge::new(sampling, run.floor.len()),
            before: None,
            due_m: 0.0,
            count: 0,
            untestable: 0,
            latest: Vec::new(),
        })
    }

    /// Moves the instrument to a pose. It takes readings on the way there if floor on the way counts as scanned.
    /// Dead channels take none.
    pub(crate) fn visit(
        &mut self,
        (tick, t_s): (u64, f64),
        to: &PoseEstimate,
        truth: Pose,
        way: Way<'_>,
        is_dead: impl Fn(u16) -> bool,
    ) {
        self.latest.clear();
        let estimated = Pose { position: to.position, heading_rad: to.heading_rad };
        let now = Before { t_s, estimated, truth };
        let Some(from) = self.before.replace(now).filter(|_| way.counts) else {
            self.due_m = 0.0;
            return;
        };
        let way_m = (estimated.position - from.estimated.position).norm();
        let mut sample = 0;
        while self.due_m < way_m {
            let share = self.due_m / way_m;
            self.read((tick, sample), between(&from, &now, share), to, way.floor, &is_dead);
            self.due_m += self.sampling.pitch_m;
            sample += 1;
        }
        self.due_m -= way_m;
    }

    /// Takes a reading of every channel that works.
    fn read(
        &mut self,
        (tick, sample): (u64, u64),
        here: Before,
        estimate: &PoseEstimate,
        floor: &Floor,
        is_dead: &impl Fn(u16) -> bool,
    ) {
        for channel in (0..self.sampling.channels).filter(|channel| !is_dead(*channel)) {
            let offset_m = self.sampling.offset_m(channel, self.swath_m);
            let at = beside(here.estimated, offset_m);
            let Some(cell) = floor.cell_at(at).filter(|cell| floor.is_floor(*cell)) else { continue };
            let error = noise::normal([self.seed, tick, sample, u64::from(channel)]);
            let true_mm = self.worn.left_mm(beside(here.truth, offset_m));
            let reading = Reading {
                t_s: here.t_s,
                channel,
                at,
                covariance: covariance(estimate, here.estimated.heading_rad, offset_m),
                thickness_mm: (true_mm + self.sampling.sigma_mm * error).max(0.0),
                is_testable: floor.kind(cell) != Cell::Untestable,
            };
            self.count += 1;
            self.untestable += u64::from(!reading.is_testable);
            if reading.is_testable {
                self.judge.add(cell, &reading);
            }
            self.latest.push(reading);
        }
    }

    /// The readings that were taken on the way to the latest pose.
    pub fn latest(&self) -> &[Reading] {
        &self.latest
    }

    /// The readings of each piece of floor.
    pub fn judge(&self) -> &Judge {
        &self.judge
    }

    /// How the instrument reads.
    pub fn sampling(&self) -> Sampling {
        self.sampling
    }

    /// How the indications compare with the true losses of the simulated floor, given the indications and whether a
    /// place was tested.
    pub fn detections(&self, found: &[Finding], is_tested: impl Fn(Point) -> bool) -> Detections {
        detection::detections(self.worn.wear(), self.sampling, found, is_tested)
    }

    /// The number of readings, and what they show on a floor.
    pub(crate) fn summary(&self, floor: &Floor) -> ReadingsSummary {
        let found = self.judge.findings(floor);
        let is_tested = |at| floor.cell_at(at).is_some_and(|cell| self.judge.count(cell) > 0);
        let detections = self.detections(&found, is_tested);
        let summary = judge::summary(found, self.count, self.untestable);
        let false_calls = Some(detections.false_calls as u64);
        ReadingsSummary { detected: detections.share(), false_calls, ..summary }
    }
}

/// The floor on the way to a pose, and whether it counts as scanned.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Way<'a> {
    pub(crate) floor: &'a Floor,
    pub(crate) counts: bool,
}

fn between(from: &Before, to: &Before, share: f64) -> Before {
    let pose = |from: Pose, to: Pose| {
        let turn_rad = world::geometry::wrap_angle_rad(to.heading_rad - from.heading_rad);
        Pose {
            position: from.position + (to.position - from.position) * share,
            heading_rad: from.heading_rad + turn_rad * share,
        }
    };
    Before {
        t_s: from.t_s + (to.t_s - from.t_s) * share,
        estimated: pose(from.estimated, to.estimated),
        truth: pose(from.truth, to.truth),
    }
}

/// The place at a distance to the left of a pose, metres.
fn beside(pose: Pose, left_m: f64) -> Point {
    let ahead = unit_vector(pose.heading_rad);
    pose.position + Vector::new(-ahead.y, ahead.x) * left_m
}

/// The covariance of a place at a distance to the left of an estimated pose, square metres.
fn covariance(estimate: &PoseEstimate, heading_rad: f64, left_m: f64) -> Matrix2<f64> {
    let ahead = unit_vector(heading_rad) * left_m;
    let way = Matrix2x3::new(1.0, 0.0, -ahead.x, 0.0, 1.0, -ahead.y);
    way * estimate.covariance * way.transpose()
}
