//! Protection levels: a radius that the position error exceeds with no more than a stated probability, even if one
//! station is wrong.
//!
//! Method: solution separation (Brenner 1996; Blanch et al. 2015 for the shares of the risk). The hypotheses are that
//! every station is right, and, for each station, that this station alone is wrong by any amount. The position without a
//! station does not depend on the error of that station. The distance to this position, plus a multiple of its own
//! uncertainty, therefore bounds the error under that hypothesis, whether or not the error is noticed. If the other stations
//! are nearly on a line, the mirror image of that position counts, too, unless their ranges exclude it.

mod guard;
mod mirror;

pub use guard::{Guard, are_on_line};
pub(crate) use mirror::{Layout, other_side_m};

use crate::{
    anchor::Anchor,
    fix::Fix,
    quality::{LEAST_SPARED, alarm_limit, largest_variance},
};
use nalgebra::{Matrix2, Matrix3, Vector3};
use serde::{Deserialize, Serialize};
use world::{Point, Station, StationId};

/// Mean time for which a station stays wrong before it is found and repaired, hours. The probability that a station is
/// wrong at a given moment is the rate of faults times this time (an assumption).
pub const FAULT_LASTS_H: f64 = 1.0;
/// The largest share of positions beyond the level while a station is wrong. A fault lasts for many fixes, so a rare
/// fault must not use up the whole risk at once.
pub const MOST_WHILE_WRONG: f64 = 1e-3;
/// The solver either keeps all stations or leaves one out; each of these two cases has half of the risk.
const SELECTIONS: f64 = 2.0;
/// The share of a step that the curvature of the range circles may change: beyond it, two steps do not find the position
/// without a station.
const MOST_CURVED: f64 = 0.25;
/// The length of a step, metres, below which its curvature does no harm.
const NEAR_M: f64 = 0.05;
/// The length of a step, as a share of the distance to the nearest station, up to which the second order suffices: the third
/// changes the pull by less than 1 in 200.
const SHORT: f64 = 0.05;
/// The number of stations above the number of unknowns that a level needs: one for the fault, and one to exclude the
/// mirror image of the remaining stations.
const SPARE: usize = 2;

/// The risk that a scenario accepts, and the faults that it expects.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Risk {
    /// The largest probability that the error of one position exceeds its protection level.
    pub integrity_risk: f64,
    /// The number of faults of one station per hour.
    pub station_faults_per_hour: f64,
}

impl Default for Risk {
    /// A risk of 1e-5 per position, and one fault per station in 10,000 hours. Both are assumptions: no rate of faults
    /// of acoustic-emission stations is published.
    fn default() -> Self {
        Self { integrity_risk: 1e-5, station_faults_per_hour: 1e-4 }
    }
}

/// Why a pose is not protected.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Unprotected {
    /// Fewer stations than a level needs.
    #[error("too few stations to check each other")]
    TooFewStations,
    /// All stations are on one line, so that every place has a mirror image.
    #[error("all stations are on one line")]
    OnOneLine,
    /// Two wrong stations at once are more probable than the accepted risk.
    #[error("two wrong stations at once are more probable than the accepted risk")]
    TooRisky,
    /// The ranges fit neither sound stations nor a single wrong one.
    #[error("the ranges fit no single wrong station")]
    Contradiction,
    /// The session calibration or a pulse test has found two wrong stations at once.
    #[error("two stations were wrong at once, and it is uncertain which two")]
    TwoWrong,
    /// The last cycles gave no fix.
    #[error("the last cycles gave no fix")]
    Silent,
}

/// The numbers of standard deviations that a level allows for chance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Multipliers {
    /// While every station is right.
    pub fault_free: f64,
    /// While one station is wrong.
    pub one_fault: f64,
}

impl Risk {
    /// Returns the probability that a given station is wrong at a given moment.
    ///
    /// ```
    /// assert_eq!(positioning::Risk::default().prior(), 1e-4);
    /// ```
    pub fn prior(&self) -> f64 {
        (self.station_faults_per_hour * FAULT_LASTS_H).clamp(0.0, 1.0)
    }

    /// Returns the multipliers for a number of stations, of which the solver may have left one out. `None` if two
    /// stations are wrong at once with a probability above the accepted risk: then no level protects.
    ///
    /// ```
    /// use positioning::Risk;
    /// let all = Risk::default().multipliers(6, false).unwrap();
    /// assert!((5.0..5.1).contains(&all.fault_free) && (3.7..3.9).contains(&all.one_fault));
    /// // A choice between more selections needs more room for chance.
    /// assert!(Risk::default().multipliers(6, true).unwrap().one_fault > all.one_fault);
    /// // With one fault in 10 hours, two wrong stations are more probable than the accepted risk.
    /// assert_eq!(Risk { station_faults_per_hour: 0.1, ..Risk::default() }.multipliers(6, false), None);
    /// ```
    pub fn multipliers(&self, stations: usize, is_one_left_out: bool) -> Option<Multipliers> {
        let (n, prior) = (stations as f64, self.prior());
        let two_wrong = n * (n - 1.0) / 2.0 * prior * prior;
        // Half of the risk for the case without a fault, half for all cases with one fault.
        let share = (self.integrity_risk - two_wrong) / 2.0 / SELECTIONS;
        let ways = if is_one_left_out { n } else { 1.0 };
        let while_wrong = (share / (n * prior).max(f64::MIN_POSITIVE)).min(MOST_WHILE_WRONG / SELECTIONS);
        // A normal error in two dimensions, none of whose axes has more than one standard deviation, is longer than k
        // standard deviations with a probability of at most exp(-k^2 / 2).
        let sigmas = |probability: f64| (-2.0 * (probability / ways).ln()).max(0.0).sqrt();
        (share > 0.0).then(|| Multipliers { fault_free: sigmas(share), one_fault: sigmas(while_wrong) })
    }
}

/// Returns the protection level of a fix, metres. `None` if the fix is not protected: too few stations, a station that
/// the others cannot check, or residuals that fit no hypothesis of at most one wrong station.
///
/// `is_emission_free` states that all ranges are too long by one unknown length. Cost: about half a microsecond for
/// six stations.
///
/// ```
/// use positioning::{Nls, PositionSolver, Ranging, Risk, protection::level_m};
/// use world::{Point, Station, StationId};
/// let places = [(10.0, 0.0), (0.0, 10.0), (-10.0, 0.0), (0.0, -10.0), (7.0, 7.0), (-7.0, -7.0)];
/// let stations: Vec<Station> = (1..).zip(places)
///     .map(|(id, (x, y))| Station { id: StationId(id), name: String::new(), position: Point::new(x, y) })
///     .collect();
/// let at = Point::new(2.0, 1.0);
/// let range = |s: &Station| Ranging::single(s.id, (at - s.position).norm(), 0.1);
/// let mut ranges: Vec<Ranging> = stations.iter().map(range).collect();
/// let level = |ranges: &[Ranging]| {
///     let fix = Nls.solve(ranges, &stations, None).unwrap();
///     (level_m(&fix, &stations, &Risk::default(), false), fix)
/// };
/// let right_m = level(&ranges).0.unwrap();
/// ranges[0].range_m += 0.4;
/// let (wrong_m, fix) = level(&ranges);
/// assert!(wrong_m.unwrap() > right_m && (fix.position - at).norm() < wrong_m.unwrap());
/// // Two wrong stations that do not agree with each other.
/// ranges[1].range_m += 2.0;
/// ranges[4].range_m -= 2.0;
/// assert_eq!(level(&ranges).0, None);
/// ```
pub fn level_m(fix: &Fix, stations: &[Station], risk: &Risk, is_emission_free: bool) -> Option<f64> {
    let rejected = guard::rejected(fix);
    let unknowns = 2 + usize::from(is_emission_free);
    if fix.used.len() < unknowns + SPARE || rejected > 1 {
        return None;
    }
    let multipliers = risk.multipliers(fix.used.len() + rejected, rejected > 0)?;
    let seen = Seen::new(fix, stations, is_emission_free)?;
    let excess = largest_variance(&(fix.covariance - position_part(&seen.covariance)));
    let reach_m =
        |covariance: &Matrix2<f64>, sigmas: f64| sigmas * (largest_variance(covariance) + excess).sqrt();
    let degrees_of_freedom = u32::try_from(fix.used.len() - unknowns).ok()?;
    let limit_without = alarm_limit(degrees_of_freedom - 1);
    let mut is_explained = fix.chi2 <= alarm_limit(degrees_of_freedom);
    let mut level_m = reach_m(&position_part(&seen.covariance), multipliers.fault_free)
        + seen.other_side_m(None, &seen.whole(), multipliers.fault_free)?;
    for index in 0..seen.rows.len() {
        let without = seen.without(index)?;
        is_explained |= fix.chi2 - without.explained <= limit_without;
        let apart_m = without.shift_m.max(seen.other_side_m(Some(index), &without, multipliers.one_fault)?);
        level_m = level_m.max(apart_m + reach_m(&without.covariance, multipliers.one_fault));
    }
    Some(level_m).filter(|level_m| is_explained && level_m.is_finite())
}

fn position_part(covariance: &Matrix3<f64>) -> Matrix2<f64> {
    covariance.fixed_view::<2, 2>(0, 0).into_owned()
}

/// A range of a fix.
struct Row {
    id: StationId,
    station: Point,
    range_m: f64,
    residual_m: f64,
    variance: f64,
    /// 1 / variance.
    weight: f64,
    /// 1 / distance, per metre.
    per_m: f64,
    /// Derivatives of the range by x, y and the common length.
    by: Vector3<f64>,
}

impl Row {
    /// Returns the pull of the range on a position that is a step away from the fix.
    fn pull(&self, fix: Point, step: &Vector3<f64>) -> Vector3<f64> {
        let away = fix + step.xy() - self.station;
        let distance_m = away.norm().max(f64::MIN_POSITIVE);
        let pull = (self.range_m - distance_m - self.by.z * step.z) * self.weight;
        let by_metre = pull / distance_m;
        Vector3::new(away.x * by_metre, away.y * by_metre, self.by.z * pull)
    }

    /// Returns the same for a step that is short beside the distance: to the second order, without a root or a quotient.
    fn pull_near(&self, step: &Vector3<f64>) -> Vector3<f64> {
        let (along, level) = (self.by.xy(), step.xy());
        let ahead_m = along.dot(&level);
        let bend_m = 0.5 * (level.norm_squared() - ahead_m * ahead_m) * self.per_m;
        let pull = (self.residual_m - ahead_m - bend_m - self.by.z * step.z) * self.weight;
        let turned = along + (level - along * ahead_m) * self.per_m;
        Vector3::new(turned.x * pull, turned.y * pull, self.by.z * pull)
    }

    /// Returns the range with the error that it has at the fix.
    fn anchor(&self) -> Anchor {
        let sigma_m = self.variance.sqrt();
        Anchor::new(self.id, self.station, self.range_m, sigma_m, sigma_m)
    }
}

/// The ranges of a fix, and the covariance that they give.
struct Seen {
    rows: Vec<Row>,
    layout: Layout,
    covariance: Matrix3<f64>,
    position: Point,
    is_emission_free: bool,
}

/// The position without one station.
struct Without {
    /// Distance from the fix, metres.
    shift_m: f64,
    position: Point,
    covariance: Matrix2<f64>,
    /// The part of the chi-squared sum that leaves with the station.
    explained: f64,
}

impl Seen {
    fn new(fix: &Fix, stations: &[Station], is_emission_free: bool) -> Option<Self> {
        let by_length = f64::from(u8::from(is_emission_free));
        let mut rows = Vec::with_capacity(fix.residuals.len());
        // A known emission time has a column of zeros; the 1 on the diagonal keeps it at 0.
        let mut information = Matrix3::zeros();
        information[(2, 2)] = 1.0 - by_length;
        for residual in &fix.residuals {
            let station = stations.iter().find(|station| station.id == residual.station)?.position;
            let away = fix.position - station;
            let distance_m = away.norm();
            let per_m = 1.0 / distance_m;
            let by = Vector3::new(away.x * per_m, away.y * per_m, by_length);
            let variance = residual.sigma_m.powi(2);
            let weight = 1.0 / variance;
            information += by * by.transpose() * weight;
            let (residual_m, range_m) = (residual.residual_m, residual.residual_m + distance_m);
            rows.push(Row {
                id: residual.station,
                station,
                range_m,
                residual_m,
                variance,
                weight,
                per_m,
                by,
            });
        }
        let covariance = information.try_inverse()?;
        covariance.iter().all(|number| number.is_finite()).then_some(Self {
            layout: Layout::of(rows.iter().map(|row| (row.station, row.weight))),
            rows,
            covariance,
            position: fix.position,
            is_emission_free,
        })
    }

    /// Returns the position without a station; `None` if the other stations give none.
    ///
    /// A first step removes the range from the linear fit (Sherman and Morrison); a second one corrects for the
    /// curvature of the range circles.
    fn without(&self, index: usize) -> Option<Without> {
        let row = &self.rows[index];
        let pull = self.covariance * row.by;
        let spared = row.variance - row.by.dot(&pull);
        if spared.is_nan() || spared <= row.variance * LEAST_SPARED {
            return None;
        }
        let covariance = self.covariance + pull * pull.transpose() / spared;
        let first = -pull * (row.residual_m / spared);
        let second = covariance * self.gradient_without(index, &first);
        if second.xy().norm() > MOST_CURVED * first.xy().norm() && first.xy().norm() > NEAR_M {
            return None;
        }
        let step = first + second;
        Some(Without {
            shift_m: step.xy().norm().max(first.xy().norm()),
            position: self.position + step.xy(),
            covariance: position_part(&covariance),
            explained: row.residual_m.powi(2) / spared,
        })
    }

    /// The position with all stations: the fix.
    fn whole(&self) -> Without {
        Without {
            shift_m: 0.0,
            position: self.position,
            covariance: position_part(&self.covariance),
            explained: 0.0,
        }
    }

    /// Returns the distance from the fix to the mirror image of the position without a station, or with all stations,
    /// metres; 0 if the ranges of these stations exclude it.
    fn other_side_m(&self, left_out: Option<usize>, without: &Without, sigmas: f64) -> Option<f64> {
        let station = left_out.map(|index| (self.rows[index].station, self.rows[index].weight));
        if !self.layout.is_flat(station) {
            return Some(0.0);
        }
        let others = self.rows.iter().enumerate().filter(|(index, _)| Some(*index) != left_out);
        let anchors: Vec<Anchor> = others.map(|(_, row)| row.anchor()).collect();
        let away_m = other_side_m(&anchors, without.position, self.is_emission_free, sigmas * sigmas)?;
        Some(if away_m > 0.0 { away_m + without.shift_m } else { 0.0 })
    }

    /// Returns the pull of all ranges but one on a position that is a step away from the fix.
    fn gradient_without(&self, index: usize, step: &Vector3<f64>) -> Vector3<f64> {
        let shortest_m = 1.0 / self.rows.iter().map(|row| row.per_m).fold(0.0, f64::max);
        let is_short = step.xy().norm_squared() <= (SHORT * shortest_m).powi(2);
        let pulls = |row: &Row| if is_short { row.pull_near(step) } else { row.pull(self.position, step) };
        let [before, after] = [&self.rows[..index], &self.rows[index + 1..]];
        before.iter().map(pulls).sum::<Vector3<f64>>() + after.iter().map(pulls).sum::<Vector3<f64>>()
    }
}

#[cfg(test)]
mod tests;
