//! The operator's orders; they enter at the top of the next tick.

use crate::{
    phase::Outcome,
    plan_id::PlanId,
    planner::{ParamValue, PlannerChoice},
};
use serde::{Deserialize, Serialize};
use world::{Point, StationId};

/// One order.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Order {
    /// While waiting: make the plan that the mission will begin with, once more if there is one. Nothing moves.
    Plan,
    /// Begin the mission with whatever plan is made: nobody looks at one before. Refused where a start names its plan
    /// ([`crate::MissionConfig::start_names_plan`]).
    Start,
    /// Begin the mission with the plan that the operator saw.
    StartPlan(PlanId),
    /// While waiting: note what was checked before the start, by the console and by hand.
    NoteChecks(Vec<Check>),
    /// While held: note how the mission would go on with some planners, as it was forecast.
    NoteOutlooks(Vec<Outlook>),
    /// Stand still.
    Hold,
    /// Go on.
    Resume,
    /// While held: move for one tick.
    Step,
    /// While held: move until something happens, then stand still again.
    StepTo(StepTo),
    /// While held for a plan that was refused because of the tether: fly it, and later plans until one fails.
    FlyUncertified,
    /// End the mission here.
    Abort,
    /// End the mission here: the process that runs it was asked to exit by a signal.
    Terminate,
    /// While held or waiting: another planner takes over.
    ChoosePlanner(PlannerChoice),
    /// Fly a planner in shadow: it plans and commands beside the one that drives, and moves nothing.
    Shadow(PlannerChoice),
    /// The planner in shadow takes over, without a hold.
    Promote,
    /// End the shadow.
    DropShadow,
    /// Fly the better plan that is offered, from the place on where it begins.
    TakePlan,
    /// Change one parameter of the planner; while the mission runs only live ones.
    SetParameter {
        /// Which parameter.
        key: String,
        /// Its new value.
        value: ParamValue,
    },
    /// The robot must not enter the floor between these corners (metres, tank frame) from now on: plans keep off it, and what lies
    /// in it is not scanned. The mission gives the zone a name.
    DrawZone(Vec<Point>),
    /// For training: a station of the simulation fails for a while. The mission only notes it, and locates without knowing.
    Inject(Injection),
    /// Whether the ranges of a station are used; without them the robot is located by the others.
    UseStation {
        /// Which station.
        station: StationId,
        /// Whether they are.
        used: bool,
        /// Who ordered it, if the console knows.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        by: Option<String>,
    },
    /// Note what the operator did at the console; neither robot nor planner is concerned.
    Note(Note),
}

/// Something that the operator did at the console.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Note {
    /// What.
    pub what: Noted,
    /// Who did it, if the console knows.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub by: Option<String>,
}

/// What the operator did at the console. An alarm has a name that is the same in every run, and the words that the operator
/// saw.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Noted {
    /// The operator has seen an alarm.
    Acknowledged {
        /// Its name.
        alarm: String,
        /// Its words.
        text: String,
    },
    /// The operator has put an alarm aside.
    Shelved {
        /// Its name.
        alarm: String,
        /// Its words.
        text: String,
        /// For how long, seconds of mission time.
        for_s: f64,
        /// Why, in the words of the operator.
        reason: String,
    },
    /// The operator has taken back an alarm that was put aside.
    Unshelved {
        /// Its name.
        alarm: String,
        /// Its words.
        text: String,
    },
    /// The parameters of a preset were taken: the order that chooses them follows.
    PresetTaken {
        /// The name of the preset.
        preset: String,
        /// Whose parameters.
        planner: String,
    },
}

impl Order {
    /// Whether it begins the mission.
    pub fn is_start(&self) -> bool {
        matches!(self, Self::Start | Self::StartPlan(_))
    }
}

/// A fault of a simulated station, injected on purpose.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Injection {
    /// Which station.
    pub station: StationId,
    /// What is wrong with it.
    pub fault: RangeFault,
    /// For how long, from the next tick on, seconds of mission time.
    pub for_s: f64,
    /// Who injected it, if the console knows.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub by: Option<String>,
}

/// What is wrong with a station.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RangeFault {
    /// It is silent.
    Dead,
    /// Its ranges are too long by so many metres.
    Offset(f64),
}

/// What a robot moves to that is held and is let go for a while.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum StepTo {
    /// The end of the lane or connector under the robot; without lanes, a metre further.
    LaneEnd,
    /// The next event of WATCH or above.
    Event,
}

/// Something that was checked before the start.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Check {
    /// What.
    pub what: String,
    /// How it came out.
    pub outcome: CheckOutcome,
    /// What was found, as a sentence; for a tick by hand by whom, or nothing.
    pub found: String,
}

/// How a check came out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CheckOutcome {
    /// All right.
    Passed,
    /// Ticked by hand.
    Ticked,
    /// Worth knowing; it does not block the start.
    Warning,
    /// It blocks the start.
    Failed,
}

/// How a mission would go on with a planner from where it is held, as it was forecast from the estimate and the map alone.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Outlook {
    /// The planner, with its parameters.
    pub choice: PlannerChoice,
    /// How it would end; absent if it would be held until an operator helps.
    pub outcome: Option<Outcome>,
    /// Why, as a sentence.
    pub reason: String,
    /// Mission time until then, seconds.
    pub after_s: f64,
    /// Way until then, metres.
    pub length_m: f64,
    /// Scanned share of the reachable floor at the end, 0 to 1.
    pub reachable: f64,
    /// Least distance from the hull to anything solid, metres.
    pub clearance_min_m: f64,
    /// Most cable out, metres; absent without a tether.
    pub tether_length_max_m: Option<f64>,
    /// Largest wrap on one obstacle, radians; absent without a tether.
    pub wrap_max_rad: Option<f64>,
}
