//! Two surveys of one floor, years apart: matches and rates against the truth, in random floors.
//!
//! A draw is a pair of surveys. The frame of the second one is turned, and its columns are drawn with a small error.
//! 30 % of the pits of the second survey are new; the others have grown by up to 2 mm. Both surveys measure place and
//! depth with errors, and show only pits whose measured depth is above the threshold.

use crate::study::{Block, Job, Result, Row, Sample, Study};
use ::surveys::{Column, Comparison, Indication, Survey, Tank, compare};
use nalgebra::{Matrix2, Rotation2};
use rand::{RngExt, SeedableRng};
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;
use world::{Boundary, Point, Vector};

/// The studies.
pub(crate) const STUDIES: &[Study] = &[Study {
    name: "two-surveys",
    about: "pairs of surveys of one floor: matches and rates against the truth, with position and sizing errors",
    layouts: 200,
    run,
}];

/// Radius of the tank, metres.
const RADIUS_M: f64 = 8.0;
/// Thickness of the floor, millimetres.
const THICKNESS_MM: f64 = 8.0;
/// Loss from which there is an indication, millimetres.
const THRESHOLD_MM: f64 = 1.6;
/// Number of columns.
const COLUMNS: usize = 6;
/// Standard deviation of the drawn place of a column on each axis, metres.
const DRAWN_M: f64 = 0.005;
/// Number of pits in the second survey, and how many of them are new.
const PITS: usize = 100;
const NEW: usize = 30;
/// Least distance between two pits, metres: closer ones are one indication.
const APART_M: f64 = 0.2;
/// The depth of a pit in the first survey, and of a new one in the second survey, millimetres.
const DEPTH_MM: [f64; 2] = [1.0, 5.0];
/// The most growth, millimetres.
const GROWTH_MM: f64 = 2.0;
/// Years between the surveys.
const YEARS: f64 = 3.0;
/// A position error of 5 cm, metres.
const POSITION_M: f64 = 0.05;
/// A sizing error of 10 %.
const SIZING: f64 = 0.1;
/// Ratio of the 95 % error of a position to its standard deviation on each axis.
const PER_SIGMA_95: f64 = 2.447_746_830_680_816;

/// The errors of a case.
#[derive(Debug, Clone, Copy)]
struct Errors {
    id: &'static str,
    /// Standard deviation of a position on each axis, metres.
    position_m: f64,
    /// Whether the sizing error is a share of the thickness, not of the depth.
    is_of_thickness: bool,
}

/// The readings of "a position error of 5 cm" and "a sizing error of 10 %".
const CASES: [Errors; 4] = [
    Errors { id: "5cm-95/10%-depth", position_m: POSITION_M / PER_SIGMA_95, is_of_thickness: false },
    Errors { id: "5cm-95/10%-thickness", position_m: POSITION_M / PER_SIGMA_95, is_of_thickness: true },
    Errors { id: "5cm-sigma/10%-depth", position_m: POSITION_M, is_of_thickness: false },
    Errors { id: "5cm-sigma/10%-thickness", position_m: POSITION_M, is_of_thickness: true },
];

/// A pit; `None` for its depth in the first survey if it is new.
struct Pit {
    at: Point,
    depths_mm: [Option<f64>; 2],
}

/// What became of the pits of a draw.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
struct Tally {
    /// Pits that both surveys show.
    in_both: usize,
    /// Those that were matched with themselves.
    matched: usize,
    /// Matches of two different pits.
    wrong: usize,
    /// Matched pits whose true rate is in the 95 % interval.
    covered: usize,
    /// Root of the mean squared residual of the columns, metres.
    residual_m: f64,
}

fn run(job: &Job<'_>) -> Result<Vec<Row>> {
    let cases = job.cases(CASES, |case| case.id.into())?;
    let methods = job.methods(["place-and-covariance"], |id| (*id).into())?;
    let done = job.runner.grid(&cases, &job.seeds(), |_, case, seed| Ok(draw(case, *seed)))?;
    let rows = cases.iter().zip(&done).map(|(case, draws)| rows(&job.block(case.id, methods[0], ""), draws));
    Ok(rows.flatten().collect())
}

fn rows(block: &Block<'_>, draws: &[Tally]) -> Vec<Row> {
    let sum = |of: fn(&Tally) -> usize| draws.iter().map(of).sum::<usize>();
    let share = |part: usize, of: usize| part as f64 / of.max(1) as f64;
    let (in_both, matched, wrong) = (sum(|t| t.in_both), sum(|t| t.matched), sum(|t| t.wrong));
    let all = matched + wrong;
    let residual: Sample = draws.iter().map(|tally| tally.residual_m).collect();
    vec![
        block.row("matched_rate", share(matched, in_both), "", in_both),
        block.row("false_match_rate", share(wrong, all), "", all),
        block.row("interval_cover_rate", share(sum(|t| t.covered), matched), "", matched),
        block.row("residual_median", residual.median(), "m", residual.len()),
    ]
}

/// Compares a pair of surveys; a pair that is refused counts as pairs that were not matched.
fn draw(errors: &Errors, seed: u64) -> Tally {
    let mut rng = Pcg64::seed_from_u64(seed.wrapping_mul(2_654_435_761).wrapping_add(42));
    let pits = pits(&mut rng);
    let columns: Vec<Point> = (0..COLUMNS).map(|_| on_disc(&mut rng)).collect();
    let turn = Rotation2::new(rng.random_range(0.0..TAU));
    let (first, of_first) = survey(errors, &pits, &columns, (0, Rotation2::identity()), &mut rng);
    let (second, of_second) = survey(errors, &pits, &columns, (1, turn), &mut rng);
    let in_both = of_first.iter().filter(|pit| of_second.contains(pit)).count();
    let tested = |_: Point| true;
    let Ok(Comparison { matched, registration, .. }) = compare([&first, &second], YEARS, [&tested, &tested])
    else {
        return Tally { in_both, ..Tally::default() };
    };
    let mut tally = Tally { in_both, ..Tally::default() };
    tally.residual_m = registration.residuals.iter().map(|residual| residual.rms_m).fold(0.0, f64::max);
    for (pair, growth) in &matched {
        let (one, other) = (of_first[pair.first], of_second[pair.second]);
        let [Some(before), Some(after)] = pits[one].depths_mm else { continue };
        if one != other {
            tally.wrong += 1;
            continue;
        }
        tally.matched += 1;
        let [low, high] = growth.rate_interval_mm_per_a;
        tally.covered += usize::from((low..=high).contains(&((after - before) / YEARS)));
    }
    tally
}

fn pits(rng: &mut Pcg64) -> Vec<Pit> {
    let mut pits: Vec<Pit> = Vec::new();
    while pits.len() < PITS {
        let at = on_disc(rng);
        if pits.iter().any(|pit| (pit.at - at).norm() < APART_M) {
            continue;
        }
        let depth_mm = rng.random_range(DEPTH_MM[0]..DEPTH_MM[1]);
        let grown_mm = rng.random_range(0.0..GROWTH_MM);
        let is_new = pits.len() < NEW;
        let depths_mm =
            if is_new { [None, Some(depth_mm)] } else { [Some(depth_mm), Some(depth_mm + grown_mm)] };
        pits.push(Pit { at, depths_mm });
    }
    pits
}

/// A survey in a turned frame, and the pit of each indication.
fn survey(
    errors: &Errors,
    pits: &[Pit],
    columns: &[Point],
    (which, turn): (usize, Rotation2<f64>),
    rng: &mut Pcg64,
) -> (Survey, Vec<usize>) {
    let column =
        |at: &Point| Column { name: "column".into(), at: turn * (at + off(DRAWN_M, rng)), size_m: 0.3 };
    let columns = columns.iter().map(column).collect();
    let (mut indications, mut of) = (Vec::new(), Vec::new());
    for (index, pit) in pits.iter().enumerate() {
        let Some(depth_mm) = pit.depths_mm[which] else { continue };
        let depth_sigma_mm = SIZING * if errors.is_of_thickness { THICKNESS_MM } else { depth_mm };
        let noise: f64 = StandardNormal.sample(rng);
        let measured_mm = depth_mm + depth_sigma_mm * noise;
        let at = turn * (pit.at + off(errors.position_m, rng));
        if measured_mm < THRESHOLD_MM {
            continue;
        }
        let covariance = Matrix2::identity() * errors.position_m.powi(2);
        let depth_sigma_mm = SIZING * if errors.is_of_thickness { THICKNESS_MM } else { measured_mm };
        indications.push(Indication {
            number: index,
            plate: None,
            at,
            low: at,
            high: at,
            covariance,
            depth_mm: measured_mm,
            depth_sigma_mm,
            is_cut: false,
        });
        of.push(index);
    }
    let boundary = Boundary::Circle { radius_m: RADIUS_M };
    let tank = Tank { boundary, columns, plates: None };
    let tested_m2 = std::f64::consts::PI * RADIUS_M.powi(2);
    (Survey { tank, thickness_mm: THICKNESS_MM, threshold_mm: THRESHOLD_MM, tested_m2, indications }, of)
}

fn off(sigma_m: f64, rng: &mut Pcg64) -> Vector {
    let [x, y]: [f64; 2] = [StandardNormal.sample(rng), StandardNormal.sample(rng)];
    Vector::new(x, y) * sigma_m
}

fn on_disc(rng: &mut Pcg64) -> Point {
    let (share, angle): (f64, f64) = (rng.random(), rng.random_range(0.0..TAU));
    Point::from(Vector::new(angle.cos(), angle.sin()) * (RADIUS_M * share.sqrt()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Seeds that the study does not use.
    const SEEDS: std::ops::Range<u64> = 90_000..90_040;

    #[test]
    fn most_pits_are_matched_few_wrongly_and_the_intervals_are_honest() {
        let draws: Vec<Tally> = SEEDS.map(|seed| draw(&CASES[0], seed)).collect();
        let block = Block { table: "t", case: "c", method: "m", note: "" };
        let figures: Vec<f64> = rows(&block, &draws).iter().filter_map(|row| row.ours).collect();
        let [matched, wrong, covered, residual_m] = figures[..] else { panic!("{figures:?}") };
        assert!(matched >= 0.95 && wrong <= 0.01, "{figures:?}");
        assert!((0.93..=0.97).contains(&covered) && residual_m < 0.02, "{figures:?}");
        assert_eq!(draw(&CASES[0], 90_000), draws[0]);
    }
}
