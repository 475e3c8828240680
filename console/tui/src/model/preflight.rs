//! The pre-flight check: automatic checks, and those that the operator ticks by hand.

mod pulses;
mod scanner;
mod survey;
mod vehicle;

use super::{Model, ui::Arrangement};
use account::LeftOut;
use mission::{Check, CheckOutcome, Phase, PlanId, Readiness, TaskConfig};
use serde::{Deserialize, Serialize};
use world::{beside_limit, coverage::percent_text};

/// The minimum number of stations for a position fix.
const LEAST_STATIONS: usize = 2;

/// The pre-flight check.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Preflight {
    /// The checks made outside the screen: disk, recorder, engine, clock; `None` before they are run.
    pub found: Option<Vec<Check>>,
    /// Whether the checks are running.
    pub is_checking: bool,
    /// Whether the mission will start as soon as all checks pass.
    pub is_starting: bool,
    /// The plan that was shown when the operator agreed to the start.
    #[serde(default)]
    pub seen: Option<PlanId>,
    /// Whether each item of the scenario's checklist is ticked.
    pub ticked: Vec<bool>,
}

impl Model {
    /// All checks: the automatic ones, failed ones first, then the checklist items.
    pub fn checks(&self) -> Vec<Check> {
        let preflight = &self.live.preflight;
        let found = preflight.found.iter().flatten().cloned();
        let mut checks: Vec<Check> = self.own_checks().into_iter().chain(found).collect();
        checks.sort_by_key(|check| std::cmp::Reverse(check.outcome));
        checks.extend(self.hand_checks());
        checks
    }

    /// All checks as the operator reads them: failed ones, warnings, the checklist, and those that passed. An item of
    /// the checklist comes with its place there.
    pub fn grouped_checks(&self) -> Vec<(Check, Option<usize>)> {
        let all = self.checks();
        let first_by_hand = all.len() - self.n_by_hand();
        let numbered = all.into_iter().enumerate();
        let mut grouped: Vec<(Check, Option<usize>)> =
            numbered.map(|(index, check)| (check, index.checked_sub(first_by_hand))).collect();
        grouped.sort_by_key(|(check, item)| match (item, check.outcome) {
            (None, CheckOutcome::Failed) => 0,
            (None, CheckOutcome::Warning) => 1,
            (Some(_), _) => 2,
            (None, CheckOutcome::Passed | CheckOutcome::Ticked) => 3,
        });
        grouped
    }

    /// The items of the scenario's checklist.
    fn hand_checks(&self) -> Vec<Check> {
        let items = self.live.run.about.iter().flat_map(|about| &about.checklist).enumerate();
        let by =
            self.console.preferences.operator.as_ref().map_or_else(String::new, |name| format!("by {name}"));
        items
            .map(|(index, item)| {
                let is_ticked = self.live.preflight.ticked.get(index).copied().unwrap_or(false);
                let outcome = if is_ticked { CheckOutcome::Ticked } else { CheckOutcome::Failed };
                let found = if is_ticked { by.clone() } else { "not ticked".to_owned() };
                Check { what: item.clone(), outcome, found }
            })
            .collect()
    }

    /// The number of items to tick by hand.
    pub fn n_by_hand(&self) -> usize {
        self.live.run.about.as_ref().map_or(0, |about| about.checklist.len())
    }

    /// The reason why the start is blocked, as a sentence; `None` if it is not.
    pub fn start_is_blocked(&self) -> Option<String> {
        self.blocking_check().map(|failed| format!("start blocked: {}: {}", failed.what, failed.found))
    }

    /// The reason why the start is blocked, as a sentence, judged only from the model and the items not ticked. The
    /// other checks are repeated when the start is ordered.
    pub(crate) fn start_is_blocked_here(&self) -> Option<String> {
        let mut checks = self.own_checks().into_iter().chain(self.hand_checks());
        let failed = checks.find(|check| check.outcome == CheckOutcome::Failed)?;
        Some(format!("start blocked: {}: {}", failed.what, failed.found))
    }

    /// The first check that blocks the start.
    pub(crate) fn blocking_check(&self) -> Option<Check> {
        self.checks().into_iter().find(|check| check.outcome == CheckOutcome::Failed)
    }

    /// The checks that need only the model.
    fn own_checks(&self) -> Vec<Check> {
        // Nothing is known of a mission whose scenario has not been read.
        if self.live.is_loading() {
            let found = "loading; the plan follows".to_owned();
            return vec![check("scenario", CheckOutcome::Failed, found), self.terminal_check()];
        }
        let mut checks = if self.live.run.is_survey() {
            self.survey_checks()
        } else {
            [self.planner_check(), self.plan_check()].into_iter().chain(self.tether_check()).collect()
        };
        checks.extend(self.place_check());
        checks.extend(self.vehicle_checks());
        checks.extend(self.scanner_check());
        checks.extend(self.pulse_check());
        checks.extend([self.station_check(), self.terminal_check()]);
        checks
    }

    fn planner_check(&self) -> Check {
        let planning = &self.live.run.planning;
        match (&planning.fault, self.planner()) {
            (Some(fault), _) => {
                let found = format!("{}; `:plan-again` replans, `:planner` changes it", fault.message);
                check("planner", CheckOutcome::Failed, found)
            }
            (None, Some(info)) => {
                let hash = info.sha256.get(..8).unwrap_or(&info.sha256);
                check(
                    "planner",
                    CheckOutcome::Passed,
                    format!("{} {}, ABI {}, sha256 {hash}", info.id, info.version, info.abi),
                )
            }
            (None, None) if self.live.awaits_plan() || self.live.busy.is_some() => {
                check("planner", CheckOutcome::Failed, "being started; the plan follows".into())
            }
            (None, None) => check("planner", CheckOutcome::Failed, "no planner found".into()),
        }
    }

    fn plan_check(&self) -> Check {
        let planning = &self.live.run.planning;
        let standing = self.live.run.standing.standing();
        match (&planning.plan, &self.live.busy) {
            (_, Some(busy)) if *self.live.run.phase() != Phase::Waiting => {
                check("plan", CheckOutcome::Warning, busy.how_far())
            }
            (_, Some(busy)) => check(
                "plan",
                CheckOutcome::Failed,
                format!("{}: not started; start again when the plan is ready", busy.how_far()),
            ),
            (_, None) if standing.readiness == Readiness::Preparing => {
                check("plan", CheckOutcome::Failed, "being made; start again when it is ready".into())
            }
            (None, None) if self.live.awaits_plan() => {
                check("plan", CheckOutcome::Failed, "follows; start when it is ready".into())
            }
            (Some(plan), None) if self.live.is_plan_of_the_way() => {
                let outcome = if plan.complete { CheckOutcome::Passed } else { CheckOutcome::Warning };
                let what = match self.live.left_out_by_plan() {
                    Some(left_out) => {
                        let scanned = percent_text(left_out.scanned(), 1);
                        format!("scans {scanned} % of requested")
                    }
                    None if plan.complete => "the whole task".to_owned(),
                    None => "only part of the task".to_owned(),
                };
                check("plan", outcome, format!("{what}; made on the way, {:.1} m", plan.length_m))
            }
            (Some(plan), None) if plan.complete => {
                let left_out = self.live.left_out().filter(|left_out| !left_out.areas.is_empty());
                let what = left_out.map_or_else(|| "the whole task".to_owned(), areas_left_out);
                check("plan", CheckOutcome::Passed, format!("{:.1} m, {what}", plan.length_m))
            }
            (Some(plan), None) => {
                let what = match self.live.left_out() {
                    Some(left_out) => {
                        let scanned = percent_text(left_out.scanned(), 1);
                        format!("scans {scanned} % of the requested floor{}", why_not_all(left_out))
                    }
                    None => "only part of the task".to_owned(),
                };
                check("plan", CheckOutcome::Warning, format!("{what}; {:.1} m", plan.length_m))
            }
            (None, None) => check(
                "plan",
                CheckOutcome::Failed,
                "planning has not begun, or was cancelled; `plan-again` plans".into(),
            ),
        }
    }

    fn tether_check(&self) -> Option<Check> {
        let run = &self.live.run;
        let tether = run.about.as_ref()?.mission.tether.as_ref()?;
        if run.is_tether_broken() {
            let found = "TORN: the certificate of the plan does not apply".to_owned();
            return Some(check("tether", CheckOutcome::Warning, found));
        }
        Some(match run.tether.as_ref().and_then(|tether| tether.certified) {
            Some(true) => match run.tether.as_ref().and_then(|tether| tether.warnings.first()) {
                Some(warning) => check("tether", CheckOutcome::Warning, format!("certified, but {warning}")),
                None => check("tether", CheckOutcome::Passed, "certified: can always be reeled in".into()),
            },
            Some(false) if tether.allow_uncertified => check(
                "tether",
                CheckOutcome::Warning,
                "tether NOT certified, but allowed by the scenario".into(),
            ),
            Some(false) => check(
                "tether",
                CheckOutcome::Failed,
                "tether NOT certified; change planner or parameters".into(),
            ),
            None => check("tether", CheckOutcome::Failed, "no certified plan yet".into()),
        })
    }

    /// For a re-scan: whether the run before it left the robot where the plan begins.
    fn place_check(&self) -> Option<Check> {
        let left_at = self.live.left_at?;
        let start = self.live.run.about.as_ref()?.mission.start.position;
        let near = || format!("was left at the start, {:.1} m from it", (left_at - start).norm());
        let words = self.must_stand();
        let outcome = if words.is_some() { CheckOutcome::Warning } else { CheckOutcome::Passed };
        Some(check("robot", outcome, words.unwrap_or_else(near)))
    }

    /// If the plan of a re-scan does not begin where the run before it left the robot: where the robot must stand, as
    /// the end of a sentence about the robot.
    pub(crate) fn must_stand(&self) -> Option<String> {
        let left_at = self.live.left_at?;
        let mission = &self.live.run.about.as_ref()?.mission;
        let TaskConfig::Cover { tolerance_m, .. } = mission.task else { return None };
        let start = mission.start.position;
        let away_m = (left_at - start).norm();
        let tether = if mission.tether.is_some() { ", tether reeled in" } else { "" };
        (away_m > tolerance_m).then(|| {
            format!(
                "must stand at {:.2}, {:.2} m{tether}; it was left {away_m:.1} m from there, at {:.2}, {:.2} m",
                start.x, start.y, left_at.x, left_at.y
            )
        })
    }

    fn station_check(&self) -> Check {
        let stations = self.live.run.about.as_ref().map_or(0, |about| about.world.stations.len());
        let limit_m = self.live.run.about.as_ref().map_or(f64::NAN, |about| about.mission.position_limit_m);
        let of_survey = self.live.run.is_survey().then(|| self.stations_on_the_floor(stations));
        if let Some(check) = of_survey.flatten() {
            return check;
        }
        // Once the mission has started, the figures are those that the operator saw before the start.
        let has_started = *self.live.run.phase() != Phase::Waiting;
        let estimate = if has_started { self.live.promised() } else { self.live.estimate() };
        let is_few = stations < LEAST_STATIONS;
        let stations = if has_started { format!("{stations} at the start") } else { stations.to_string() };
        let (outcome, found) = match estimate {
            _ if is_few => (CheckOutcome::Warning, format!("{stations}: position from odometry alone")),
            None => (CheckOutcome::Warning, format!("{stations}; accuracy along the path not known yet")),
            Some(estimate) if estimate.without_fix_m > 0.0 => (
                CheckOutcome::Warning,
                format!("{stations}; no fix on {:.1} m of the path", estimate.without_fix_m),
            ),
            Some(estimate) => match estimate.accuracy_worst {
                Some(worst) => {
                    let [error, limit] = beside_limit(worst.value, limit_m, 2);
                    if worst.value > limit_m {
                        let (x, y) = (worst.at.x, worst.at.y);
                        let found = format!("{stations}; ±{error} m at {x:.1}, {y:.1} m, limit {limit} m");
                        (CheckOutcome::Warning, found)
                    } else {
                        let found = format!("{stations}; at worst ±{error} m, limit {limit} m");
                        (CheckOutcome::Passed, found)
                    }
                }
                None => (CheckOutcome::Passed, stations),
            },
        };
        let level = self.live.run.level.map(|level| format!("; {}", level.words())).unwrap_or_default();
        check("AE stations", outcome, found + &level)
    }

    fn terminal_check(&self) -> Check {
        let size = format!("{}x{}", self.ui.width, self.ui.height);
        match self.ui.arrangement() {
            Arrangement::Wide | Arrangement::Narrow => check("terminal", CheckOutcome::Passed, size),
            Arrangement::Paged | Arrangement::Strip => check(
                "terminal",
                CheckOutcome::Warning,
                format!("{size}: not all panes fit; 80x24 is needed"),
            ),
        }
    }
}

/// The areas that a plan leaves out: `1 area left out, 0.40 m²`.
fn areas_left_out(left_out: &LeftOut) -> String {
    let area_m2: f64 = left_out.areas.iter().map(|area| area.area_m2).sum();
    let areas =
        if left_out.areas.len() == 1 { "1 area".into() } else { format!("{} areas", left_out.areas.len()) };
    format!("{areas} left out, {area_m2:.2} m²")
}

/// Why a plan leaves floor out, as the end of a sentence: the reason for the largest area.
fn why_not_all(left_out: &LeftOut) -> String {
    let Some(largest) = left_out.areas.first() else { return String::new() };
    let areas = match left_out.areas.len() {
        1 => "1 area left out".to_owned(),
        n => format!("{n} areas left out, the largest"),
    };
    format!("; {areas}, {:.2} m²: {}", largest.area_m2, largest.reason.briefly())
}

fn check(what: &str, outcome: CheckOutcome, found: String) -> Check {
    Check { what: what.to_owned(), outcome, found }
}
