//! Finds indications in readings.

use super::{Reading, ReadingsSummary};
use mission::Sampling;
use nalgebra::Matrix2;
use positioning::fix::ellipse_95;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use world::{Floor, Point};

/// Distance, in cells, within which readings above the threshold belong to the same indication. Two lanes place the
/// same pit in cells that differ by the position error.
const SAME_CELLS: isize = 2;
/// The least number of readings above the threshold in an indication; a single one may be noise.
const LEAST_READINGS: u32 = 2;
/// Readings of a run that are further apart in time belong to different passes, whose position errors are independent,
/// seconds.
const PASS_S: f64 = 5.0;
/// Upper ends of the classes of loss on a corrosion map, as shares of the nominal thickness; the last class has none.
pub const LOSS_CLASSES: [f64; 4] = [0.05, 0.1, 0.2, 0.4];
/// Half width of a 95 % interval, in standard deviations.
const SIGMAS_95: f64 = 1.96;

/// A loss of metal that readings show.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Finding {
    /// Mission time of the deepest reading, seconds.
    pub t_s: f64,
    /// The run of the deepest reading, counted from 0 in the order in which runs were combined.
    #[serde(default)]
    pub run: usize,
    /// The middle, weighted by depth, tank frame, metres.
    pub at: Point,
    /// South-west corner of the readings above the threshold, metres.
    pub low: Point,
    /// North-east corner of these readings, metres.
    pub high: Point,
    /// 95 % error of the position, metres.
    pub error_m: f64,
    /// Covariance of the position, square metres.
    #[serde(default, with = "world::geometry::symmetric")]
    pub covariance: Matrix2<f64>,
    /// The largest loss that a reading shows, millimetres.
    pub depth_mm: f64,
    /// Half width of the 95 % interval of a reading, millimetres.
    pub depth_error_mm: f64,
    /// Number of readings above the threshold.
    pub readings: u32,
}

/// The readings of a floor, by cell.
#[derive(Debug, Clone)]
pub struct Judge {
    sampling: Sampling,
    cells: Vec<CellReadings>,
    /// The cells with readings above the threshold.
    hits: BTreeMap<usize, Hit>,
}

/// The readings in a cell.
#[derive(Debug, Clone, Copy, Default)]
struct CellReadings {
    sum_mm: f32,
    least_mm: f32,
    count: u32,
    /// Mission time of the latest reading, seconds, and its run.
    t_s: f32,
    run: u32,
}

/// The readings above the threshold in a cell.
#[derive(Debug, Clone)]
struct Hit {
    run: usize,
    t_s: f64,
    depth_mm: f64,
    passes: Vec<Pass>,
    low: Point,
    high: Point,
    /// Sums of depth, and of depth times position.
    depths_mm: f64,
    moments: [f64; 2],
    count: u32,
}

/// The readings above the threshold of one pass of the instrument. Within a pass, their position errors are the same.
#[derive(Debug, Clone)]
struct Pass {
    run: usize,
    from_s: f64,
    to_s: f64,
    /// Sums of depth, and of depth times covariance.
    depths_mm: f64,
    covariances: Matrix2<f64>,
}

impl Pass {
    fn holds(&self, other: &Self) -> bool {
        self.run == other.run && other.from_s - PASS_S < self.to_s && self.from_s - PASS_S < other.to_s
    }

    fn join(&mut self, other: &Self) {
        (self.from_s, self.to_s) = (self.from_s.min(other.from_s), self.to_s.max(other.to_s));
        self.depths_mm += other.depths_mm;
        self.covariances += other.covariances;
    }
}

impl Hit {
    fn of(reading: &Reading, depth_mm: f64) -> Self {
        let Point { coords, .. } = reading.at;
        Self {
            run: 0,
            t_s: reading.t_s,
            depth_mm,
            passes: vec![Pass {
                run: 0,
                from_s: reading.t_s,
                to_s: reading.t_s,
                depths_mm: depth_mm,
                covariances: reading.covariance * depth_mm,
            }],
            low: reading.at,
            high: reading.at,
            depths_mm: depth_mm,
            moments: [depth_mm * coords.x, depth_mm * coords.y],
            count: 1,
        }
    }

    fn join(&mut self, other: &Self) {
        if other.depth_mm > self.depth_mm {
            (self.run, self.t_s, self.depth_mm) = (other.run, other.t_s, other.depth_mm);
        }
        for pass in &other.passes {
            self.take(pass.clone());
        }
        (self.low, self.high) = (self.low.inf(&other.low), self.high.sup(&other.high));
        self.depths_mm += other.depths_mm;
        self.moments = [self.moments[0] + other.moments[0], self.moments[1] + other.moments[1]];
        self.count += other.count;
    }

    /// The same readings, as those of a run.
    fn of_run(&self, run: usize) -> Self {
        let passes = self.passes.iter().map(|pass| Pass { run, ..pass.clone() }).collect();
        Self { run, passes, ..self.clone() }
    }

    /// Adds a pass. It may connect passes that were apart before.
    fn take(&mut self, mut new: Pass) {
        self.passes.retain(|pass| {
            let is_same = pass.holds(&new);
            if is_same {
                new.join(pass);
            }
            !is_same
        });
        self.passes.push(new);
    }

    /// The covariance of the mean place, weighted by depth, of passes with independent errors.
    fn covariance(&self) -> Matrix2<f64> {
        let of_pass = |pass: &Pass| pass.covariances * (pass.depths_mm / self.depths_mm.powi(2));
        self.passes.iter().map(of_pass).sum()
    }

    fn finding(&self, sigma_mm: f64) -> Finding {
        let covariance = self.covariance();
        Finding {
            t_s: self.t_s,
            run: self.run,
            at: Point::new(self.moments[0] / self.depths_mm, self.moments[1] / self.depths_mm),
            low: self.low,
            high: self.high,
            error_m: ellipse_95(&covariance).0,
            covariance,
            depth_mm: self.depth_mm,
            depth_error_mm: SIGMAS_95 * sigma_mm,
            readings: self.count,
        }
    }
}

impl Judge {
    /// No readings yet, on a floor with a number of cells.
    pub(super) fn new(sampling: Sampling, cells: usize) -> Self {
        Self { sampling, cells: vec![CellReadings::default(); cells], hits: BTreeMap::new() }
    }

    /// Adds a reading in a cell.
    pub(super) fn add(&mut self, cell: usize, reading: &Reading) {
        let thickness_mm = reading.thickness_mm as f32;
        let seen = &mut self.cells[cell];
        seen.least_mm = if seen.count == 0 { thickness_mm } else { seen.least_mm.min(thickness_mm) };
        seen.sum_mm += thickness_mm;
        seen.count += 1;
        seen.t_s = reading.t_s as f32;
        let depth_mm = self.sampling.thickness_mm - reading.thickness_mm;
        if depth_mm >= self.sampling.threshold_mm() {
            let hit = Hit::of(reading, depth_mm);
            self.hits.entry(cell).and_modify(|known| known.join(&hit)).or_insert(hit);
        }
    }

    /// Adds the readings of another run on the same floor; `run` is its place in the order of runs.
    pub fn join(&mut self, other: &Self, run: usize) {
        for (own, other) in self.cells.iter_mut().zip(&other.cells).filter(|(_, other)| other.count > 0) {
            own.least_mm = if own.count == 0 { other.least_mm } else { own.least_mm.min(other.least_mm) };
            own.sum_mm += other.sum_mm;
            own.count += other.count;
            (own.t_s, own.run) = (other.t_s, run as u32);
        }
        for (cell, hit) in &other.hits {
            let hit = hit.of_run(run);
            self.hits.entry(*cell).and_modify(|known| known.join(&hit)).or_insert(hit);
        }
    }

    /// The mean thickness in a cell, millimetres; `None` without readings.
    pub fn mean_mm(&self, cell: usize) -> Option<f64> {
        let seen = self.cells.get(cell).filter(|seen| seen.count > 0)?;
        Some(f64::from(seen.sum_mm) / f64::from(seen.count))
    }

    /// The smallest thickness that a reading shows in a cell, millimetres; `None` without readings.
    pub fn least_mm(&self, cell: usize) -> Option<f64> {
        self.cells.get(cell).filter(|seen| seen.count > 0).map(|seen| f64::from(seen.least_mm))
    }

    /// The class of the mean loss in a cell: the number of [`LOSS_CLASSES`] below it; `None` without readings.
    pub fn loss_class(&self, cell: usize) -> Option<u8> {
        let loss = 1.0 - self.mean_mm(cell)? / self.sampling.thickness_mm;
        Some(LOSS_CLASSES.iter().take_while(|limit| loss > **limit).count() as u8)
    }

    /// The run of the latest reading in a cell, and its mission time, seconds; `None` without readings.
    pub fn last_read(&self, cell: usize) -> Option<(usize, f64)> {
        let seen = self.cells.get(cell).filter(|seen| seen.count > 0)?;
        Some((seen.run as usize, f64::from(seen.t_s)))
    }

    /// Number of readings in a cell.
    pub fn count(&self, cell: usize) -> u32 {
        self.cells.get(cell).map_or(0, |seen| seen.count)
    }

    /// The indications, in order of run and time: readings above the threshold that are close together form one,
    /// whatever lane or run they are from.
    pub fn findings(&self, floor: &Floor) -> Vec<Finding> {
        let mut left = self.hits.clone();
        let mut found = Vec::new();
        while let Some((first, hit)) = left.pop_first() {
            let (mut all, mut open) = (hit, vec![first]);
            while let Some(cell) = open.pop() {
                for near in around(floor, cell) {
                    if let Some(hit) = left.remove(&near) {
                        all.join(&hit);
                        open.push(near);
                    }
                }
            }
            if all.count >= LEAST_READINGS {
                found.push(all.finding(self.sampling.sigma_mm));
            }
        }
        found.sort_by(|a, b| a.run.cmp(&b.run).then(a.t_s.total_cmp(&b.t_s)));
        found
    }
}

/// What readings show, with their number and the number of those that are not judged.
pub(super) fn summary(found: Vec<Finding>, count: u64, untestable: u64) -> ReadingsSummary {
    ReadingsSummary {
        count,
        untestable,
        indications: found.len() as u64,
        deepest: found.into_iter().max_by(|a, b| a.depth_mm.total_cmp(&b.depth_mm)),
        detected: None,
        false_calls: None,
    }
}

/// The cells around a cell.
fn around(floor: &Floor, cell: usize) -> impl Iterator<Item = usize> + use<> {
    let (width, height) = (floor.width as isize, floor.height as isize);
    let (column, row) = ((cell % floor.width) as isize, (cell / floor.width) as isize);
    let rows = (row - SAME_CELLS).max(0)..=(row + SAME_CELLS).min(height - 1);
    let columns = (column - SAME_CELLS).max(0)..=(column + SAME_CELLS).min(width - 1);
    rows.flat_map(move |row| columns.clone().map(move |column| (row * width + column) as usize))
}
