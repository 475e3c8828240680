//! Folds planner events into a run.

use crate::model::{Cause, Change, Offer, PlanShown, Run, Withdrawn, planning};
use mission::{
    BetterPlan, During, Event, EventKind, ParamValue, Phase, PlannerChoice, PlannerInfo, Severity,
    event::{PlanDropped, PlanMade, late_text},
};
use planner_api::{Command, Drawing, LegTag};

/// The maximum number of drawings kept for one tick.
const MAX_DRAWINGS: usize = 512;
/// The maximum number of figures kept for one tick.
const MAX_SCALARS: usize = 32;

impl Run {
    /// Folds in a planner event.
    pub(super) fn planned(&mut self, event: &Event, change: &mut Change) {
        match &event.kind {
            EventKind::PlannerPrepared { ask, .. } => self.planning.candidate = Some(ask.worker),
            EventKind::PlannerChosen { choice, info, .. } => {
                self.planning.candidate = None;
                self.seat(choice, info);
            }
            EventKind::ParametersChanged { choice, .. } => {
                self.planning.choice = Some(choice.clone());
                self.parameters_settled();
            }
            EventKind::Planned { ask, path, length_m, complete, legs, .. } => {
                // The planner is a candidate: its plan runs once it takes over.
                self.planning.proposed = ask.is_some_and(|ask| self.planning.candidate == Some(ask.worker));
                if self.planning.proposed {
                    return;
                }
                let begins_m = |with: &[LegTag]| PlanShown::begins_m(path, legs, with);
                let retract_m = begins_m(&[LegTag::Retract]);
                let lead_m = begins_m(&[LegTag::Retract, LegTag::Travel]);
                let (path, lanes) = planning::shown(path, legs, self.least_lane_m());
                let driven_m = self.driven_m();
                let (ask, length_m, complete, t_s) = (*ask, *length_m, *complete, event.t_s);
                let plan =
                    PlanShown { ask, path, lanes, length_m, complete, t_s, driven_m, retract_m, lead_m };
                self.planning.plan = Some(plan);
                self.planner_works();
            }
            EventKind::Commanded { command, .. } => self.command(event.t_s, *command),
            EventKind::Drawn { drawings } => self.draw(event.tick, drawings),
            EventKind::Scalars { scalars } => {
                self.planning.scalars = scalars.iter().take(MAX_SCALARS).cloned().collect();
                let shown = self.planning.scalars.iter();
                let histories = &mut self.planning.scalar_history;
                histories.retain(|name, _| shown.clone().any(|(other, ..)| other == name));
                for (name, value, _) in shown {
                    histories.entry(name.clone()).or_default().add(event.t_s, *value);
                }
            }
            // The planner continues with its old values.
            EventKind::PlannerFailed { fault, .. } if fault.refuses_change() => {
                self.planning.ordered = None;
                change.say(fault.severity(), fault.message.clone());
            }
            EventKind::PlannerFailed { fault, .. } => {
                self.planning.ordered = None;
                // A refused planner does not replace the active one.
                if self.planner_id() == Some(fault.planner.as_str()) {
                    self.planning.fault = Some(fault.clone());
                    if fault.during == During::Plan {
                        self.forget_certificate();
                    }
                }
                self.raise_as_logged(event, Cause::Planner);
                change.withdraw(Withdrawn::All);
            }
            // No alarm: the planner works again, but an earlier fault may still be unacknowledged.
            EventKind::PlannerLate { planner, ticks } => {
                change.say(Severity::Watch, late_text(planner, *ticks));
            }
            EventKind::BetterPlanned(PlanMade { path, legs, flown, better, scans, objection, .. }) => {
                self.planning.candidate = None;
                if objection.is_none() {
                    let (flown, better, scans, begins) = (*flown, *better, *scans, path.first().copied());
                    let is_taken = self
                        .about
                        .as_ref()
                        .is_some_and(|about| about.mission.better_plan == BetterPlan::Take);
                    let (path, lanes) = planning::shown(path, legs, self.least_lane_m());
                    let offer = Offer { flown, better, scans, begins, path, lanes, is_taken };
                    let next = if is_taken { "Change-over where it begins" } else { "<take-plan>: take" };
                    change.say(Severity::Watch, format!("{}. {next}", offer.sentence()));
                    self.planning.offer = Some(offer);
                }
            }
            EventKind::BetterPlanTaken(_) => {
                self.planning.offer = None;
                change.say(Severity::Info, "better plan taken");
            }
            EventKind::BetterPlanDropped(PlanDropped { why, .. }) => {
                self.planning.candidate = None;
                match self.planning.offer.take() {
                    Some(offer) if offer.is_taken => {
                        change.say(Severity::Warn, format!("accepted better plan dropped: {why}"));
                    }
                    Some(_) => change.say(Severity::Watch, format!("offer ended: {why}")),
                    None => {}
                }
            }
            EventKind::PlannerRejected { planner, why } => {
                (self.planning.candidate, self.planning.ordered) = (None, None);
                change.say(Severity::Warn, format!("planner {planner} will not take over: {why}"));
            }
            _ => {}
        }
    }

    /// Records an ordered change of a parameter of the active planner, in addition to earlier
    /// ordered changes.
    pub(super) fn order_parameter(&mut self, key: &str, value: &ParamValue) {
        let planning = &mut self.planning;
        let Some(mut choice) = planning.ordered.take().or_else(|| planning.choice.clone()) else { return };
        choice.parameters.insert(key.to_owned(), value.clone());
        planning.ordered = Some(choice);
    }

    /// Forgets the ordered parameters once they are in effect in the active planner.
    fn parameters_settled(&mut self) {
        let planning = &mut self.planning;
        planning.ordered.take_if(|ordered| planning.choice.as_ref() == Some(ordered));
    }

    /// The distance driven along the plans so far, metres.
    fn driven_m(&self) -> f64 {
        let driven = self.planning.plan.as_ref().zip(self.progress.as_ref());
        driven.map_or(0.0, |(plan, progress)| progress.done * (plan.driven_m + plan.length_m))
    }

    /// The minimum length of a straight stretch that counts as a lane, metres.
    pub(super) fn least_lane_m(&self) -> f64 {
        self.about.as_ref().map_or(0.0, |about| PlanShown::least_lane_m(&about.mission))
    }

    /// Makes a different planner active.
    fn seat(&mut self, choice: &PlannerChoice, info: &PlannerInfo) {
        if *self.phase() == Phase::Waiting {
            // Nothing has run yet, so the previous planner's plan no longer matters.
            self.planning.plan = None;
        }
        (self.planning.choice, self.planning.info) = (Some(choice.clone()), Some(info.clone()));
        self.parameters_settled();
        self.planning.scalars.clear();
        self.planning.scalar_history.clear();
        self.planning.drawings.clear();
        self.planner_works();
    }

    fn draw(&mut self, tick: u64, drawings: &[Drawing]) {
        if self.planning.drawings_tick != tick {
            self.planning.drawings.clear();
        }
        self.planning.drawings_tick = tick;
        let room = MAX_DRAWINGS.saturating_sub(self.planning.drawings.len());
        self.planning.drawings.extend(drawings.iter().take(room).copied());
    }

    fn command(&mut self, t_s: f64, command: Command) {
        self.planner_works();
        self.planning.command = Some((t_s, command));
    }

    pub(super) fn planner_works(&mut self) {
        self.planning.fault = None;
        self.clear(&Cause::Planner);
    }
}
