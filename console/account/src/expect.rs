//! Bounds that a scenario sets for its own run.

use crate::{figures::FigureId, summary::Summary};
use mission::Outcome;
use serde::{Deserialize, Serialize};
use std::fmt;
use world::coverage::percent_text;

/// The bounds; an absent bound is not checked.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Expect {
    /// The outcome of the run.
    pub outcome: Option<Outcome>,
    /// Maximum number of collisions.
    pub collisions_max: Option<u64>,
    /// Minimum distance from the hull to any solid object, metres.
    pub clearance_min_m: Option<f64>,
    /// Longest mission time, seconds.
    pub mission_time_max_s: Option<f64>,
    /// Longest true path, metres.
    pub path_length_max_m: Option<f64>,
    /// Minimum share of the reachable floor scanned.
    pub coverage_reachable_min: Option<f64>,
    /// Minimum share of the reachable floor scanned, according to the true position.
    pub coverage_truth_min: Option<f64>,
    /// Minimum share of the whole floor scanned.
    pub coverage_whole_min: Option<f64>,
    /// Minimum share of the floor within the wall that a survey has seen.
    pub explored_min: Option<f64>,
    /// Largest share of the scanned floor that was scanned more than once.
    pub overlap_max: Option<f64>,
    /// Minimum tracking precision.
    pub precision_min: Option<f64>,
    /// Minimum tracking recall.
    pub recall_min: Option<f64>,
    /// Largest root mean square distance from the preset points to the path, metres.
    pub rmse_max_m: Option<f64>,
    /// Largest root mean square cross-track distance, metres.
    pub cross_track_rmse_max_m: Option<f64>,
    /// Largest mean position error, metres.
    pub mean_error_max_m: Option<f64>,
    /// Largest 95th percentile of the position error, metres.
    pub p95_error_max_m: Option<f64>,
    /// Minimum share of the ticks with the true position inside the 95 % ellipse.
    pub in_95_ellipse_min: Option<f64>,
    /// Longest time without a position, seconds.
    pub position_lost_max_s: Option<f64>,
    /// Greatest length of cable paid out at any time, metres.
    pub tether_length_max_m: Option<f64>,
    /// Largest wrap of the cable on one obstacle, radians.
    pub wrap_max_rad: Option<f64>,
    /// Greatest length of cable paid out at the end, metres.
    pub tether_end_length_max_m: Option<f64>,
}

/// A bound that a run did not meet.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Miss {
    /// The key in `[expect]`.
    pub key: &'static str,
    /// The bound.
    pub bound: String,
    /// The figure of the run; absent if the run has no such figure.
    pub found: Option<String>,
}

impl fmt::Display for Miss {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let found = self.found.as_deref().unwrap_or("no value");
        match self.key {
            "outcome" => write!(f, "expected {}, actual {found}", self.bound),
            key => {
                let what = Bounded::of(key);
                let found =
                    self.found.as_deref().map_or_else(|| found.to_owned(), |found| what.with_unit(found));
                write!(
                    f,
                    "expected {} {}{} ({key}), actual {found}",
                    what.side,
                    what.with_unit(&self.bound),
                    what.name
                )
            }
        }
    }
}

/// A bounded figure in words.
struct Bounded {
    /// `at least` or `at most`.
    side: &'static str,
    /// The figure, after the bound with its unit.
    name: &'static str,
    unit: &'static str,
}

impl Bounded {
    fn of(key: &str) -> Self {
        let unit = match key {
            _ if key.ends_with("_m") => " m",
            _ if key.ends_with("_s") => " s",
            _ if key.ends_with("_deg") => "°",
            "collisions_max" => "",
            _ => " %",
        };
        let name = match key {
            "collisions_max" => " collisions",
            "clearance_min_m" => " of clearance",
            "mission_time_max_s" => " of mission time",
            "path_length_max_m" => " of path driven",
            "coverage_reachable_min" => " of the reachable floor scanned",
            "coverage_truth_min" => " of the reachable floor scanned by true position",
            "coverage_whole_min" => " of the whole floor scanned",
            "explored_min" => " of the floor explored",
            "overlap_max" => " of overlap",
            "precision_min" => " of precision",
            "recall_min" => " of recall",
            "rmse_max_m" => " of distance from the preset path (RMS)",
            "cross_track_rmse_max_m" => " of cross-track error (RMS)",
            "mean_error_max_m" => " of mean position error",
            "p95_error_max_m" => " of position error in 95 % of the ticks",
            "in_95_ellipse_min" => " of the ticks inside the 95 % ellipse",
            "tether_length_max_m" => " of tether out",
            "wrap_max_deg" => " of wrap on one obstacle",
            "tether_end_length_max_m" => " of tether out at the end",
            "position_lost_max_s" => " without a position",
            _ => "",
        };
        let side = if key.contains("_min") { "at least" } else { "at most" };
        Self { side, name, unit }
    }

    /// A figure with its unit; shares become per cent.
    fn with_unit(&self, figure: &str) -> String {
        match figure.parse::<f64>() {
            Ok(share) if self.unit == " %" => {
                let percent = format!("{:.4}", 100.0 * share);
                let percent = percent.trim_end_matches('0').trim_end_matches('.');
                format!("{percent} %")
            }
            _ => format!("{figure}{}", self.unit),
        }
    }
}

/// The side of a bound on which a figure must lie.
#[derive(Clone, Copy)]
enum Side {
    AtLeast,
    AtMost,
}

/// The bounds on figures that are computed with the true position, which a live run does not have.
const NEED_TRUTH: [&str; 16] = [
    "collisions_max",
    "clearance_min_m",
    "path_length_max_m",
    "coverage_truth_min",
    "overlap_max",
    "precision_min",
    "recall_min",
    "rmse_max_m",
    "cross_track_rmse_max_m",
    "mean_error_max_m",
    "p95_error_max_m",
    "in_95_ellipse_min",
    "tether_length_max_m",
    "wrap_max_deg",
    "tether_end_length_max_m",
    "position_lost_max_s",
];

impl Expect {
    /// Returns the figures with sentences about the bounds that were not met. The figures of a run that was cut off
    /// are not compared, because its result is unknown.
    #[must_use]
    pub fn evaluated(&self, run: Summary) -> Summary {
        if run.outcome.is_none() {
            return run;
        }
        Summary { violations: Some(self.check(&run).iter().map(ToString::to_string).collect()), ..run }
    }

    /// The expected end of the run, in a few words for the reader; empty if no bound concerns the end.
    pub fn words(&self) -> String {
        let outcome = self.outcome.map(|outcome| outcome.word().to_owned());
        let coverage = self
            .coverage_reachable_min
            .map(|share| format!("at least {} % of reachable floor", percent_text(share, 1)));
        let time = self.mission_time_max_s.map(|time_s| format!("within {:.0} min", (time_s / 60.0).ceil()));
        let collisions = self.collisions_max.filter(|most| *most == 0).map(|_| "no collision".to_owned());
        [outcome, coverage, time, collisions].into_iter().flatten().collect::<Vec<_>>().join(", ")
    }

    /// Returns the bounds that a run did not meet. An absent figure meets no bound, except in a live run, which has no
    /// figure that needs the true position.
    pub fn check(&self, run: &Summary) -> Vec<Miss> {
        use Side::{AtLeast, AtMost};
        let coverage = run.coverage;
        let (tracking, positioning) = (run.tracking, run.positioning);
        let tether = run.tether;
        let count = |n: Option<u64>| n.map(|n| n as f64);
        let figures = [
            ("collisions_max", AtMost, count(self.collisions_max), count(run.collisions)),
            ("clearance_min_m", AtLeast, self.clearance_min_m, run.clearance_min_m),
            ("mission_time_max_s", AtMost, self.mission_time_max_s, run.mission_time_s),
            ("path_length_max_m", AtMost, self.path_length_max_m, run.path_length_m),
            ("coverage_reachable_min", AtLeast, self.coverage_reachable_min, coverage.map(|c| c.reachable)),
            (
                "coverage_truth_min",
                AtLeast,
                self.coverage_truth_min,
                coverage.and_then(|c| c.by_truth).map(|truth| truth.reachable),
            ),
            ("coverage_whole_min", AtLeast, self.coverage_whole_min, coverage.map(|c| c.whole)),
            ("explored_min", AtLeast, self.explored_min, run.explored),
            ("overlap_max", AtMost, self.overlap_max, coverage.and_then(|c| c.overlap)),
            ("precision_min", AtLeast, self.precision_min, tracking.map(|t| t.precision)),
            ("recall_min", AtLeast, self.recall_min, tracking.map(|t| t.recall)),
            ("rmse_max_m", AtMost, self.rmse_max_m, tracking.and_then(|t| t.rmse_m)),
            (
                "cross_track_rmse_max_m",
                AtMost,
                self.cross_track_rmse_max_m,
                tracking.map(|t| t.cross_track_rmse_m),
            ),
            ("mean_error_max_m", AtMost, self.mean_error_max_m, positioning.map(|p| p.mean_error_m)),
            ("p95_error_max_m", AtMost, self.p95_error_max_m, positioning.map(|p| p.p95_m)),
            ("in_95_ellipse_min", AtLeast, self.in_95_ellipse_min, positioning.map(|p| p.in_95_ellipse)),
            ("tether_length_max_m", AtMost, self.tether_length_max_m, tether.map(|t| t.tether_length_max_m)),
            (
                "wrap_max_deg",
                AtMost,
                self.wrap_max_rad.map(f64::to_degrees),
                tether.map(|t| t.wrap_max_rad.to_degrees()),
            ),
            ("tether_end_length_max_m", AtMost, self.tether_end_length_max_m, tether.map(|t| t.end_length_m)),
            ("position_lost_max_s", AtMost, self.position_lost_max_s, positioning.map(|p| p.position_lost_s)),
        ];
        let misses =
            figures.into_iter().filter_map(|(key, side, bound, found)| miss(key, side, bound?, found));
        let is_unknown =
            |miss: &Miss| run.vehicle.is_some() && miss.found.is_none() && NEED_TRUTH.contains(&miss.key);
        let misses = misses.filter(|miss| !is_unknown(miss));
        self.miss_outcome(run).into_iter().chain(misses).collect()
    }

    fn miss_outcome(&self, run: &Summary) -> Option<Miss> {
        let bound = self.outcome.filter(|bound| run.outcome != Some(*bound))?;
        let found = run.outcome.map(|outcome| outcome.word().to_owned());
        Some(Miss { key: "outcome", bound: bound.word().to_owned(), found })
    }
}

fn miss(key: &'static str, side: Side, bound: f64, found: Option<f64>) -> Option<Miss> {
    let keeps = |found: f64| match side {
        Side::AtLeast => found >= bound,
        Side::AtMost => found <= bound,
    };
    let found = match found {
        Some(found) if keeps(found) => return None,
        found => found.map(|found| rounded(found, decimals(key), |found| !keeps(found))),
    };
    Some(Miss { key, bound: bound.to_string(), found })
}

/// Maximum number of decimals of a printed figure.
const MOST_DECIMALS: usize = 6;

/// Formats a figure with its usual number of decimals, or with more, up to [`MOST_DECIMALS`], if the rounded figure
/// would seem to meet the bound.
fn rounded(found: f64, decimals: usize, is_miss: impl Fn(f64) -> bool) -> String {
    let written = |decimals: usize| format!("{found:.decimals$}");
    let mut tries = (decimals..=MOST_DECIMALS).map(written);
    let is_miss = |text: &String| text.parse().is_ok_and(&is_miss);
    tries.find(is_miss).unwrap_or_else(|| written(MOST_DECIMALS))
}

/// Number of decimals of the figure that belongs to a bound, as in the table of figures. Shares are given to a tenth of
/// a per cent.
fn decimals(key: &str) -> usize {
    match key {
        "collisions_max" => 0,
        "clearance_min_m" => FigureId::TrueClearance.decimals(),
        "mean_error_max_m" | "p95_error_max_m" => FigureId::TrueError.decimals(),
        "tether_length_max_m" | "tether_end_length_max_m" => FigureId::TetherOut.decimals(),
        "wrap_max_deg" => FigureId::WrapLargest.decimals(),
        "mission_time_max_s" | "path_length_max_m" | "position_lost_max_s" => 1,
        _ => 3,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Coverage, VehicleRecord};

    #[test]
    fn a_run_within_its_bounds_misses_nothing() {
        let expect =
            Expect { outcome: Some(Outcome::Complete), collisions_max: Some(0), ..Expect::default() };
        let run = Summary { outcome: Some(Outcome::Complete), collisions: Some(0), ..Summary::default() };
        assert_eq!(expect.check(&run), []);
    }

    #[test]
    fn each_bound_that_is_not_kept_is_named_with_what_came_out() {
        let expect = Expect {
            outcome: Some(Outcome::Complete),
            path_length_max_m: Some(70.0),
            clearance_min_m: Some(0.1),
            ..Expect::default()
        };
        let run = Summary {
            outcome: Some(Outcome::Stuck),
            path_length_m: Some(70.123_45),
            clearance_min_m: Some(0.1),
            ..Summary::default()
        };
        let misses: Vec<String> = expect.check(&run).iter().map(ToString::to_string).collect();
        assert_eq!(
            misses,
            [
                "expected complete, actual stuck",
                "expected at most 70 m of path driven (path_length_max_m), actual 70.1 m"
            ]
        );
    }

    #[test]
    fn a_figure_has_the_decimals_of_its_kind_and_more_only_to_show_the_difference() {
        let miss = |bound, found| miss("coverage_reachable_min", Side::AtLeast, bound, Some(found)).unwrap();
        assert_eq!(
            miss(0.95, 0.229_641).to_string(),
            "expected at least 95 % of the reachable floor scanned (coverage_reachable_min), actual 23 %"
        );
        assert_eq!(miss(0.95, 0.949_97).found.unwrap(), "0.94997");
        assert_eq!(miss(0.95, 0.95 - 1e-9).found.unwrap(), "0.950000");
    }

    #[test]
    fn every_bound_has_words_and_a_unit() {
        for (key, words) in [
            (
                "coverage_truth_min",
                "expected at least 98.5 % of the reachable floor scanned by true position",
            ),
            ("tether_end_length_max_m", "expected at most 0.985 m of tether out at the end"),
            ("wrap_max_deg", "expected at most 0.985° of wrap on one obstacle"),
            ("position_lost_max_s", "expected at most 0.985 s without a position"),
        ] {
            let miss = Miss { key, bound: "0.985".into(), found: None };
            assert_eq!(miss.to_string(), format!("{words} ({key}), actual no value"));
        }
        assert!(NEED_TRUTH.iter().all(|key| !Bounded::of(key).name.is_empty()));
    }

    #[test]
    fn a_live_run_is_not_judged_by_figures_that_need_the_truth() {
        let expect =
            Expect { collisions_max: Some(0), coverage_reachable_min: Some(0.9), ..Expect::default() };
        let coverage = Coverage {
            reachable: 0.5,
            whole: 0.5,
            overlap: None,
            missed_area_m2: None,
            by_truth: None,
            taken_back: None,
        };
        let vehicle = Some(VehicleRecord::default());
        let run = Summary { vehicle, coverage: Some(coverage), ..Summary::default() };
        let misses: Vec<_> = expect.check(&run).iter().map(|miss| miss.key).collect();
        assert_eq!(misses, ["coverage_reachable_min"]);
    }

    #[test]
    fn a_figure_that_is_absent_keeps_no_bound() {
        let expect = Expect { recall_min: Some(0.0), ..Expect::default() };
        let misses = expect.check(&Summary::default());
        assert_eq!(misses[0].to_string(), "expected at least 0 % of recall (recall_min), actual no value");
    }
}
