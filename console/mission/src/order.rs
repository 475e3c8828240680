//! The operator's orders; they take effect at the start of the next tick.

use crate::{
    phase::{Outcome, StepTo},
    plan_id::PlanId,
    planner::{ParamValue, PlannerChoice},
};
use serde::{Deserialize, Serialize};
use world::{Point, StationId};

/// One order.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Order {
    /// While waiting: make the plan that the mission will begin with, or make it again. Nothing moves.
    Plan,
    /// Begin the mission with whatever plan is made, without showing the plan first. Refused where a start must name its
    /// plan ([`crate::MissionConfig::start_names_plan`]).
    Start,
    /// Begin the mission with the plan that the operator saw.
    StartPlan(PlanId),
    /// While waiting: record the checks made before the start, both by the console and by hand.
    NoteChecks(Vec<Check>),
    /// While held: record forecasts of how the mission would continue with certain planners.
    NoteOutlooks(Vec<Outlook>),
    /// Hold the robot.
    Hold,
    /// Resume.
    Resume,
    /// While held: move for one tick.
    Step,
    /// While held: move to the end of the lane or until the next event, then stand still again.
    StepTo(StepTo),
    /// While held because a plan was refused for the tether: run that plan and later ones, until one of them fails.
    FlyUncertified,
    /// While held: drive back to the anchor along the return path of the tether or, without a tether, to the start. The
    /// mission ends when the robot is there. See [`Mission::way_back`](crate::Mission::way_back).
    DriveBack,
    /// End the mission.
    Abort,
    /// End the mission because its process received a signal to exit.
    Terminate,
    /// While held or waiting: ask the active planner and the planner in shadow for their states, because the console
    /// has noticed that the process of one of them has ended. The answer of that planner is then a fault.
    CheckPlanner,
    /// While held or waiting: change to a different planner.
    ChoosePlanner(PlannerChoice),
    /// Start a planner in shadow: it plans and commands in parallel with the active one, without effect on the robot.
    Shadow(PlannerChoice),
    /// Promote the planner in shadow, without a hold.
    Promote,
    /// End the shadow.
    DropShadow,
    /// Take the better plan that is offered, once the robot is at the place where the plan begins.
    TakePlan,
    /// Change one parameter of the planner; while the mission runs, only live parameters can be changed.
    SetParameter {
        /// Key of the parameter.
        key: String,
        /// New value of the parameter.
        value: ParamValue,
    },
    /// Close the floor within this convex outline from now on: plans stay out of the zone, and the zone is not scanned.
    /// The corners are in metres, tank frame; [`outline`](crate::outline) makes the corners of boxes and circles. The
    /// mission gives the zone its name. See [`Mission::zone_cost`](crate::Mission::zone_cost).
    DrawZone(Vec<Point>),
    /// For training: make a station of the simulation faulty for a while. The mission records the order, but does not
    /// use it to locate the robot.
    Inject(Injection),
    /// Set whether the ranges from a station are used; the other stations still locate the robot.
    UseStation {
        /// Id of the station.
        station: StationId,
        /// Whether the ranges from the station are used.
        used: bool,
        /// The name of the person who gave the order, if the console knows it.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        by: Option<String>,
    },
    /// Record an action of the operator at the console; the record affects neither the robot nor the planner.
    Note(Note),
}

/// An action of the operator at the console.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Note {
    /// The action.
    pub what: Noted,
    /// The name of the person who carried out the action, if the console knows it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub by: Option<String>,
}

/// The kinds of action at the console. An alarm is recorded by its name, which is the same in every run, together with
/// the text that the operator saw.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Noted {
    /// The operator acknowledged an alarm.
    Acknowledged {
        /// Name of the alarm.
        alarm: String,
        /// Text of the alarm.
        text: String,
    },
    /// The operator shelved an alarm.
    Shelved {
        /// Name of the alarm.
        alarm: String,
        /// Text of the alarm.
        text: String,
        /// Duration, seconds of mission time.
        for_s: f64,
        /// The reason, in the operator's words.
        reason: String,
    },
    /// The operator unshelved an alarm.
    Unshelved {
        /// Name of the alarm.
        alarm: String,
        /// Text of the alarm.
        text: String,
    },
    /// The operator took over the parameters of a preset; the order that sets them follows.
    PresetTaken {
        /// Name of the preset.
        preset: String,
        /// Id of the planner.
        planner: String,
    },
}

impl Order {
    /// The order with its typed texts in plain form: on one line, and without hidden characters. Readers of journals
    /// replace such characters, so only a plain order is the same when a run is verified.
    #[must_use]
    pub(crate) fn plain(mut self) -> Self {
        let plain = |text: &mut String| *text = foreign::plain(text).into_owned();
        match &mut self {
            Self::Note(Note { what, by }) => {
                by.iter_mut().for_each(plain);
                match what {
                    Noted::Acknowledged { alarm, text } | Noted::Unshelved { alarm, text } => {
                        [alarm, text].into_iter().for_each(plain);
                    }
                    Noted::Shelved { alarm, text, reason, .. } => {
                        [alarm, text, reason].into_iter().for_each(plain);
                    }
                    Noted::PresetTaken { preset, planner } => [preset, planner].into_iter().for_each(plain),
                }
            }
            Self::UseStation { by, .. } | Self::Inject(Injection { by, .. }) => by.iter_mut().for_each(plain),
            Self::NoteChecks(checks) => {
                checks.iter_mut().flat_map(|check| [&mut check.what, &mut check.found]).for_each(plain);
            }
            Self::NoteOutlooks(outlooks) => {
                outlooks.iter_mut().map(|outlook| &mut outlook.reason).for_each(plain);
            }
            _ => {}
        }
        self
    }

    /// Whether the order stops a vehicle at once, before the tick that carries it out.
    pub fn brakes(&self) -> bool {
        matches!(self, Self::Hold | Self::Abort)
    }

    /// Whether the order begins the mission.
    pub fn is_start(&self) -> bool {
        matches!(self, Self::Start | Self::StartPlan(_))
    }
}

/// A fault of a simulated station, injected on purpose.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Injection {
    /// Id of the station.
    pub station: StationId,
    /// The kind of fault.
    pub fault: RangeFault,
    /// Duration, counted from the next tick, seconds of mission time.
    pub for_s: f64,
    /// The name of the person who injected the fault, if the console knows it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub by: Option<String>,
}

/// The kinds of fault that a station can have.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RangeFault {
    /// The station is silent.
    Dead,
    /// The ranges from the station are too long by this many metres.
    Offset(f64),
}

/// A check made before the start.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Check {
    /// The item that was checked.
    pub what: String,
    /// The result.
    pub outcome: CheckOutcome,
    /// The finding, as a sentence; for a check ticked by hand, the name of the person, or nothing.
    pub found: String,
}

/// The result of a check.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CheckOutcome {
    /// Passed.
    Passed,
    /// Ticked by hand.
    Ticked,
    /// Worth knowing; does not block the start.
    Warning,
    /// Blocks the start.
    Failed,
}

/// A forecast of how the mission would continue with a planner from the point at which it is held, computed from the
/// estimate and the map alone.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Outlook {
    /// The planner, with its parameters.
    pub choice: PlannerChoice,
    /// The outcome; absent if the robot would be held until an operator helps.
    pub outcome: Option<Outcome>,
    /// The reason, as a sentence.
    pub reason: String,
    /// Mission time left until the end, seconds.
    pub after_s: f64,
    /// Distance to drive until the end, metres.
    pub length_m: f64,
    /// Scanned share of the reachable floor at the end, 0 to 1.
    pub reachable: f64,
    /// Minimum distance from the hull to anything solid, metres.
    pub clearance_min_m: f64,
    /// Maximum length of cable out, metres; absent without a tether.
    pub tether_length_max_m: Option<f64>,
    /// Largest wrap on one obstacle, radians; absent without a tether.
    pub wrap_max_rad: Option<f64>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_people_typed_is_plain_and_a_plain_order_stays_as_it_is() {
        let what = Noted::Shelved {
            alarm: "no_fix".into(),
            text: "no fix".into(),
            for_s: 600.0,
            reason: "pump\n\u{1b}[31mon".into(),
        };
        let plain = Order::Note(Note { what, by: Some("Z\u{202e}oe".into()) }).plain();
        let Order::Note(Note { what: Noted::Shelved { reason, .. }, by }) = &plain else {
            panic!("{plain:?}")
        };
        assert_eq!((reason.as_str(), by.as_deref()), ("pump \u{fffd}[31mon", Some("Z\u{fffd}oe")));
        assert_eq!(plain.clone().plain(), plain);
    }
}
