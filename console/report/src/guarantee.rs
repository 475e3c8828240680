//! The rule by which floor is guaranteed, and the risk of a protection level, in words.

use account::{Accuracy, Protection};
use positioning::{Risk, protection::FAULT_LASTS_H};

/// The measure of the position error by which the runs of a report guarantee floor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Rule {
    /// The 95 % ellipse.
    Ellipse,
    /// The protection level.
    Protection,
    /// The protection level in some of the runs, the 95 % ellipse in the others.
    Both,
}

impl Rule {
    /// The rule of some runs, given by their accuracy statements.
    pub(crate) fn of<'a>(runs: impl IntoIterator<Item = Option<&'a Accuracy>>) -> Self {
        let is_by_level =
            |run: Option<&Accuracy>| run.and_then(|run| run.protection).is_some_and(|level| level.guarantees);
        let (mut by_level, mut by_ellipse) = (false, false);
        for run in runs {
            let is_by_level = is_by_level(run);
            by_level |= is_by_level;
            by_ellipse |= !is_by_level;
        }
        match (by_level, by_ellipse) {
            (true, true) => Self::Both,
            (true, false) => Self::Protection,
            (false, _) => Self::Ellipse,
        }
    }

    /// The measure, as a noun.
    pub(crate) fn measure(self) -> &'static str {
        match self {
            Self::Ellipse => "95 % ellipse",
            Self::Protection => "protection level",
            Self::Both => "protection level in some of the runs, and by the 95 % ellipse in the others",
        }
    }

    /// The definition of "guaranteed", as a phrase.
    pub(crate) fn definition(self) -> &'static str {
        match self {
            Self::Ellipse => "scanned for every position of the robot within its 95 % position error",
            Self::Protection => {
                "scanned for every position of the robot within its protection level, which also covers one wrong station"
            }
            Self::Both => {
                "scanned for every position of the robot within its protection level in some of the runs, and within its \
                 95 % position error in the others"
            }
        }
    }

    /// What the guarantee allows for, as a phrase.
    pub(crate) fn allowance(self) -> &'static str {
        match self {
            Self::Ellipse => "the position error",
            Self::Protection => "the protection level",
            Self::Both => "the protection level or the position error",
        }
    }

    /// What the guarantee allows for, as a sentence with what it leaves out; `is_sound_known` states that the runs
    /// measured the speed of sound.
    pub(crate) fn limitation(self, is_sound_known: bool) -> String {
        let (allows, survey) = match self {
            Self::Ellipse => ("the position error given by the covariance", "in the station survey"),
            Self::Protection => (
                "the protection level, which covers chance and one wrong station",
                "in the survey of several stations",
            ),
            Self::Both => (
                "the protection level in some of the runs, and for the position error given by the covariance in the \
                 others",
                "in the station survey",
            ),
        };
        let sound = if is_sound_known { "" } else { " in the speed of sound," };
        format!(
            "\u{201c}Guaranteed\u{201d} allows for {allows}, but not for errors in the heading, {survey},{sound} or in \
             the tool's offset on the robot."
        )
    }
}

/// The risk that a protection level accepts, and the faults that it assumes, as a phrase.
pub(crate) fn risk_text(Risk { integrity_risk, station_faults_per_hour }: &Risk) -> String {
    format!(
        "accepted risk {integrity_risk:e} for each position, assuming {station_faults_per_hour:e} faults per station and \
         hour that last {FAULT_LASTS_H:.0} h each"
    )
}

/// The protection levels of a run, as a sentence without a full stop.
pub(crate) fn protection_text(protection: &Protection) -> String {
    let Protection { p50_m, p95_m, max_m, unprotected, risk, .. } = protection;
    let levels = match (p50_m, p95_m, max_m) {
        (Some(median_m), Some(p95_m), Some(max_m)) => {
            format!("{median_m:.3} m median, {p95_m:.3} m p95, {max_m:.3} m maximum")
        }
        _ => "none".to_owned(),
    };
    let risk = risk.as_ref().map(|risk| format!("; {}", risk_text(risk))).unwrap_or_default();
    let never = crate::human::text::percent(*unprotected);
    format!("protection level {levels}: not protected in {never} of ticks{risk}")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn accuracy(guarantees: Option<bool>) -> Accuracy {
        let protection = |guarantees| Protection {
            p50_m: None,
            p95_m: None,
            max_m: None,
            unprotected: 1.0,
            guarantees,
            risk: Some(Risk::default()),
        };
        Accuracy {
            mean_m: 0.1,
            p95_m: 0.2,
            max_m: 0.3,
            limit_m: 0.5,
            over_limit: 0.0,
            fixes: 1,
            stations_mean: None,
            stations_min: None,
            protection: guarantees.map(protection),
        }
    }

    #[test]
    fn the_rule_of_several_runs_is_that_of_each_of_them() {
        let [plain, ellipse, level] = [None, Some(false), Some(true)].map(accuracy);
        let rule = |runs: &[Option<&Accuracy>]| Rule::of(runs.iter().copied());
        assert_eq!(rule(&[Some(&plain), Some(&ellipse), None]), Rule::Ellipse);
        assert_eq!(rule(&[Some(&level), Some(&level)]), Rule::Protection);
        assert_eq!(rule(&[Some(&level), None]), Rule::Both);
    }

    #[test]
    fn a_run_that_was_never_protected_has_no_figure_for_its_level() {
        let text = protection_text(&accuracy(Some(true)).protection.expect("levels"));
        assert_eq!(
            text,
            "protection level none: not protected in 100.0 % of ticks; accepted risk 1e-5 for each position, assuming 1e-4 \
             faults per station and hour that last 1 h each"
        );
    }
}
