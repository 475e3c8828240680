//! One of the two surveys: its indications, its tank and its date.

use super::{SurveyPart, Surveyed};
use crate::document::{layers::Layers, thickness::thickness};
use account::{Date, Finding, Inspection, Judge};
use jiff::civil;
use mission::{RunOpened, Sampling};
use nalgebra::Matrix2;
use surveys::{Column, Indication, SIGMAS_95, Survey, Tank};
use world::{Floor, Point, Vector};

/// A survey that was read.
pub(super) struct Side<'a> {
    pub(super) part: SurveyPart,
    pub(super) survey: Survey,
    pub(super) date: civil::Date,
    pub(super) is_simulation: bool,
    judge: Judge,
    floor: &'a Floor,
}

impl<'a> Side<'a> {
    /// Reads the survey of a run.
    ///
    /// # Errors
    /// The run has no readings, or its day is not known.
    pub(super) fn read(surveyed: &Surveyed<'_>, layers: &Layers<'a>) -> Result<Self, String> {
        let past = surveyed.past;
        let date = date(&surveyed.inspection, &past.name)?;
        let read = thickness(std::slice::from_ref(past), layers);
        let (read, judge) = read.ok_or_else(|| {
            format!(
                "run {} has no readings of thickness: its scenario needs [instrument] with channels, and [wear] or an import with `tankops readings`",
                past.name
            )
        })?;
        let swath_m = layers.run.mission.swath_m;
        let indication = |(number, finding): (usize, &Finding)| {
            let sampling = read.sampling;
            Indication {
                number,
                plate: layers.plate_at(finding.at),
                at: finding.at,
                low: finding.low,
                high: finding.high,
                covariance: place_covariance(finding, &sampling, swath_m),
                depth_mm: finding.depth_mm,
                depth_sigma_mm: depth_sigma_mm(finding, &sampling, swath_m),
                is_cut: is_cut(finding, &sampling, swath_m, |at| is_read(&judge, layers.floor(), at)),
            }
        };
        let survey = Survey {
            tank: tank(layers.run),
            thickness_mm: read.sampling.thickness_mm,
            threshold_mm: read.sampling.threshold_mm(),
            tested_m2: read.tested_m2,
            indications: (1..).zip(&read.losses).map(indication).collect(),
        };
        let part = SurveyPart {
            run: past.name.clone(),
            inspected_on: date.to_string(),
            scenario: layers.run.scenario.clone(),
            tank_id: surveyed.inspection.tank_id.clone(),
            instrument: format!(
                "{}; {} channels, standard deviation of a reading {} mm, indications from {} % of {} mm",
                read.kind,
                read.sampling.channels,
                read.sampling.sigma_mm,
                100.0 * read.sampling.threshold,
                read.sampling.thickness_mm
            ),
            readings: read.readings,
            tested_m2: read.tested_m2,
            indications: read.losses.len(),
            journal_sha256: past.files.journal_sha256.clone(),
            readings_sha256: past.files.readings_sha256.clone(),
            doubts: past.files.doubts.clone(),
            cut_off: past.cut_off(),
        };
        let is_simulation = layers.run.measured.is_none() && past.summary.vehicle.is_none();
        Ok(Self { part, survey, date, is_simulation, judge, floor: layers.floor() })
    }

    /// Whether the survey has readings at a place and in all cells around it.
    pub(super) fn is_tested(&self, place: Point) -> bool {
        let rim = Vector::repeat(self.floor.cell_m);
        is_read(&self.judge, self.floor, [place - rim, place + rim])
    }
}

/// Whether untested floor lies within the spacing of the readings from the box around an indication. A loss that such
/// floor cuts has readings above the threshold up to it.
fn is_cut(
    finding: &Finding,
    sampling: &Sampling,
    swath_m: f64,
    is_read: impl Fn([Point; 2]) -> bool,
) -> bool {
    let rim = Vector::repeat(spacing_m(sampling, swath_m).max(sampling.pitch_m));
    !is_read([finding.low - rim, finding.high + rim])
}

/// Whether all cells in a box have readings that were judged.
fn is_read(judge: &Judge, floor: &Floor, [low, high]: [Point; 2]) -> bool {
    let size = high - low;
    let count = |m: f64| (m / floor.cell_m).ceil().max(1.0) as usize;
    let at = |k: usize, n: usize, m: f64| m * k as f64 / n as f64;
    let (columns, rows) = (count(size.x), count(size.y));
    let mut places = (0..=rows).flat_map(|row| {
        (0..=columns).map(move |column| low + Vector::new(at(column, columns, size.x), at(row, rows, size.y)))
    });
    places.all(|place| floor.cell_at(place).is_some_and(|cell| judge.count(cell) > 0))
}

/// The day of a survey.
fn date(inspection: &Inspection, run: &str) -> Result<civil::Date, String> {
    let stated = inspection.inspected_on.as_deref().ok_or_else(|| {
        format!(
            "run {run} does not state the day of its inspection; write inspected_on = \"2026-11-24\" into \
             [inspection] of its scenario, or into a file for --inspection-first or --inspection-second"
        )
    })?;
    let read = Date::read(stated).and_then(|date| date.to_string().parse().ok());
    read.ok_or_else(|| {
        format!("inspection.inspected_on of run {run} is {stated}; write a day, for example 2026-11-24")
    })
}

/// A contradiction between the facts about the tanks of two surveys.
pub(super) fn contradiction([first, second]: [&Inspection; 2]) -> Option<String> {
    let facts = |of: &Inspection| [("tank_id", of.tank_id.clone()), ("site", of.site.clone())];
    let both = facts(first).into_iter().zip(facts(second));
    both.filter_map(|((key, one), (_, other))| Some((key, one?, other?)))
        .find(|(_, one, other)| one.trim() != other.trim())
        .map(|(key, one, other)| format!("{key} is {one} in the first survey and {other} in the second one"))
}

/// The tank as drawn for a run.
fn tank(run: &RunOpened) -> Tank {
    let column = |obstacle: &world::Obstacle| {
        let (low, high) = obstacle.shape.bounds();
        Column { name: obstacle.name.clone(), at: obstacle.shape.center(), size_m: (high - low).max() }
    };
    Tank {
        boundary: run.world.boundary.clone(),
        columns: run.world.obstacles.iter().filter(|obstacle| obstacle.known).map(column).collect(),
        plates: run.plates.clone(),
    }
}

/// Distance between two channels, metres.
fn spacing_m(sampling: &Sampling, swath_m: f64) -> f64 {
    swath_m / f64::from(sampling.channels.max(1))
}

/// The covariance of the middle of an indication, square metres: of the position; of the middle of `n` readings within
/// its extent, `h² / 3n` on each axis with half the extent `h`; and of the grid of the readings, spacing squared over 12.
fn place_covariance(finding: &Finding, sampling: &Sampling, swath_m: f64) -> Matrix2<f64> {
    let half_m = (finding.high - finding.low) / 2.0;
    let middle = half_m.component_mul(&half_m) / (3.0 * f64::from(finding.readings.max(1)));
    let grid_m2 = (spacing_m(sampling, swath_m).powi(2) + sampling.pitch_m.powi(2)) / 24.0;
    finding.covariance + Matrix2::from_diagonal(&middle) + Matrix2::identity() * grid_m2
}

/// The standard deviation of the depth of an indication, millimetres: of a reading, and of missing the deepest place
/// between two channels.
///
/// For a pit whose depth `d` falls with the square of the distance from its middle, the extent above the threshold gives
/// its radius `R`. A channel passes its middle at a distance `u` that is even within half a spacing `s`, and shows
/// `d u² / R²` less; the standard deviation of `u²` is `s² / (6 √5)`.
fn depth_sigma_mm(finding: &Finding, sampling: &Sampling, swath_m: f64) -> f64 {
    let reading_mm = finding.depth_error_mm / SIGMAS_95;
    let spacing_m = spacing_m(sampling, swath_m);
    let half_m = ((finding.high - finding.low).max() / 2.0).max(spacing_m / 2.0);
    let above = (1.0 - sampling.threshold_mm() / finding.depth_mm).clamp(0.05, 1.0);
    let radius2_m2 = half_m * half_m / above;
    let missed_mm = finding.depth_mm * spacing_m * spacing_m / (6.0 * 5.0_f64.sqrt()) / radius2_m2;
    reading_mm.hypot(missed_mm)
}
