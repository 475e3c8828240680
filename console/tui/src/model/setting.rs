//! A parameter of the active planner that is about to be changed, and the estimated effect of the change.

use super::{Live, Model, parameter};
use account::Estimate;
use mission::{Outcome, Outlook, ParamValue, PlannerChoice};

/// The figures that a change of a parameter may affect.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Figures {
    /// The length of the path, metres; 0 if the planner plans no path.
    pub length_m: f64,
    /// The time to drive it, seconds.
    pub time_s: f64,
    /// The scanned share of the reachable floor, 0 to 1; `None` for missions without a scan.
    pub scanned: Option<f64>,
    /// The minimum distance from the hull to anything solid, metres; `None` if it is not known.
    pub clearance_m: Option<f64>,
    /// The maximum length of tether out, metres; `None` without a tether.
    pub tether_m: Option<f64>,
    /// The largest wrap on one obstacle, radians; `None` without a tether.
    pub wrap_rad: Option<f64>,
}

/// The estimated effect of a change.
#[derive(Debug, Clone, PartialEq)]
pub enum Effect {
    /// The estimate is being computed; the share done, 0 to 1, if it is known.
    Computing(Option<f64>),
    /// Why the estimate failed, as a clause.
    Unknown(String),
    /// The estimate.
    Known {
        /// The figures without the change, if they are known.
        now: Option<Figures>,
        /// The figures with the change.
        then: Figures,
        /// A result of the change that the figures do not show, as a clause.
        remark: Option<String>,
    },
}

impl Model {
    /// The value of a parameter that is in effect, or was ordered last and takes effect soon; `None` if the two differ or
    /// the parameter is unknown.
    pub fn settled_value(&self, key: &str) -> Option<ParamValue> {
        let info = parameter::find(self.planner(), key)?;
        let planning = &self.live.run.planning;
        let value = parameter::value(planning.choice.as_ref(), info);
        let is_settled = |ordered: &PlannerChoice| parameter::value(Some(ordered), info) == value;
        planning.ordered.as_ref().is_none_or(is_settled).then_some(value)
    }
}

impl Live {
    /// The active planner with a parameter changed, on top of the changes that were ordered before.
    pub fn with_parameter(&self, key: &str, value: &ParamValue) -> Option<PlannerChoice> {
        let planning = &self.run.planning;
        let mut choice = planning.ordered.as_ref().or(planning.choice.as_ref())?.clone();
        choice.parameters.insert(key.to_owned(), value.clone());
        Some(choice)
    }

    /// The estimated effect of running the planner with changed parameters. Before the start, it is the estimate of the
    /// plan that the planner makes with them; afterwards, it is a forecast from the robot's position on.
    pub fn effect_of(&self, changed: &PlannerChoice) -> Effect {
        if self.waits() { self.effect_on_plan(changed) } else { self.effect_on_rest(changed) }
    }

    fn effect_on_plan(&self, changed: &PlannerChoice) -> Effect {
        let Some(ghost) = self.plans.ghost.as_ref().filter(|ghost| ghost.choice == *changed) else {
            return Effect::Unknown("the comparison was cancelled".into());
        };
        match &ghost.made {
            None => Effect::Computing(ghost.at.as_ref().map(|(share, _)| *share)),
            Some(Err(why)) => Effect::Unknown(why.clone()),
            Some(Ok(plan)) if plan.path.is_empty() => {
                Effect::Unknown("the planner drives step by step, without a path".into())
            }
            Some(Ok(plan)) => {
                let remark = (plan.certified == Some(false)).then(|| "NOT certified for the tether".into());
                Effect::Known { now: self.estimate().map(planned), then: planned(&plan.estimate), remark }
            }
        }
    }

    fn effect_on_rest(&self, changed: &PlannerChoice) -> Effect {
        let candidates = self.what_if.as_ref().map_or(&[][..], |what_if| &what_if.candidates);
        let Some(candidate) = candidates.iter().find(|candidate| candidate.choice == *changed) else {
            return Effect::Unknown("conditions have changed since the forecast began".into());
        };
        let covers = self.run.covers();
        match &candidate.made {
            None => Effect::Computing(candidate.at),
            Some(Err(why)) => Effect::Unknown(why.clone()),
            Some(Ok(forecast)) => {
                let first = candidates.first().and_then(|first| first.made.as_ref()?.as_ref().ok());
                let uncertified = forecast.certified == Some(false);
                let remark = ending(&forecast.outlook)
                    .or_else(|| uncertified.then(|| "NOT certified for the tether".into()));
                let now = first.map(|first| forecast_of(&first.outlook, covers));
                Effect::Known { now, then: forecast_of(&forecast.outlook, covers), remark }
            }
        }
    }
}

fn planned(estimate: &Estimate) -> Figures {
    let tether = estimate.tether.as_ref();
    Figures {
        length_m: estimate.length_m,
        time_s: estimate.time_s,
        scanned: estimate.reachable,
        clearance_m: estimate.clearance_min.map(|worst| worst.value),
        tether_m: tether.map(|tether| tether.length_max.value),
        wrap_rad: tether.map(|tether| tether.wrap_max.value),
    }
}

fn forecast_of(outlook: &Outlook, covers: bool) -> Figures {
    Figures {
        length_m: outlook.length_m,
        time_s: outlook.after_s,
        scanned: covers.then_some(outlook.reachable),
        clearance_m: outlook.clearance_min_m.is_finite().then_some(outlook.clearance_min_m),
        tether_m: outlook.tether_length_max_m,
        wrap_rad: outlook.wrap_max_rad,
    }
}

/// How a forecast ends if it does not complete the task, as a clause.
fn ending(outlook: &Outlook) -> Option<String> {
    match outlook.outcome {
        Some(Outcome::Complete) => None,
        Some(outcome) => Some(format!("it ends {}: {}", outcome.word(), outlook.reason)),
        None => Some(format!("it ends held: {}", outlook.reason.trim_start_matches("held: "))),
    }
}
