//! Everything anyone may know about a run.
//!
//! Journal, recording, screen and report are folds over this one enum. Events are past tense, self-contained and
//! carry neither wall-clock time nor anything else that would differ between two equal runs.

mod effort;
mod log_line;
mod measured;
mod recorded;
mod rounding;
mod severity;
mod shadow;
mod tether;

pub use effort::Effort;
pub use log_line::{LogLine, late_text};
pub use measured::{Asked, Measured, ToolTrack};
pub use recorded::RecordedAnswers;
pub(crate) use rounding::rounded_command;
pub use severity::Severity;
pub use shadow::{READY_AFTER, ShadowTally};
pub use tether::{TetherAlarm, TetherContact, taut_line};

use crate::{
    ask::AskId,
    config::MissionConfig,
    order::Order,
    phase::{HoldReason, Outcome, Resumes},
    planner::{Fault, PlannerChoice, PlannerInfo},
};
use planner_api::{Command, Drawing, Leg, LegTag, LogLevel, PoseEstimate, Reason};
use positioning::{Exclusion, Fix, FixError, Ranging};
use serde::{Deserialize, Serialize};
use world::tether::Certificate;
use world::{CellRun, KindRun, Medium, Obstacle, ObstacleId, Point, Pose, StationId, World, Zone};

/// Version of the journal's form; raised when an old reader could not read a new journal.
pub const JOURNAL_VERSION: u32 = 5;

/// One thing that happened.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Event {
    /// In which tick, from 0.
    pub tick: u64,
    /// Mission time at the top of that tick, seconds.
    pub t_s: f64,
    /// What happened.
    #[serde(flatten)]
    pub kind: EventKind,
}

/// What happened.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", tag = "event")]
pub enum EventKind {
    /// First event of every run: everything needed to repeat it.
    RunOpened(Box<RunOpened>),
    /// The operator gave an order and it was accepted.
    Ordered {
        /// The order.
        order: Order,
    },
    /// The operator gave an order that cannot be followed now.
    OrderRefused {
        /// The order.
        order: Order,
        /// Why, and what would be right.
        why: String,
    },
    /// How the cable truly lay at the top of this tick; reported by the simulator, never known to the mission.
    TetherTruth {
        /// Cable between anchor and robot, metres.
        length_m: f64,
        /// Largest wrap on one obstacle, radians.
        wrap_max_rad: f64,
        /// Sum of all wraps, radians.
        wrap_total_rad: f64,
        /// Cable that is out beyond the straight line from the anchor to the robot, metres.
        detour_m: f64,
    },
    /// How the cable lies, by the estimated pose.
    Tethered {
        /// Cable between anchor and robot as the map explains it, metres.
        length_m: f64,
        /// What the reel has paid out by its encoder, metres; absent without one.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        paid_out_m: Option<f64>,
        /// What is left on the reel, metres: the less by the two.
        free_m: f64,
        /// Where it bears, from the anchor on.
        contacts: Vec<TetherContact>,
        /// Largest wrap on one obstacle, radians.
        wrap_max_rad: f64,
        /// Sum of all wraps, radians.
        wrap_total_rad: f64,
        /// How many times harder the wraps make it to pull (capstan equation).
        pull_factor: f64,
        /// Length of the way back along the cable, metres; absent if the hull does not fit.
        return_length_m: Option<f64>,
        /// The points between the anchor and the robot at which the taut cable bends.
        bends: Vec<Point>,
    },
    /// The cable comes near to a limit, or has reached it.
    TetherAlarmRaised {
        /// Which limit.
        alarm: TetherAlarm,
        /// Whether it has been reached.
        reached: bool,
    },
    /// The cable is well within a limit again.
    TetherAlarmCleared {
        /// Which limit.
        alarm: TetherAlarm,
    },
    /// A plan was evaluated for the tether.
    Certified {
        /// Whose plan.
        planner: String,
        /// Whether it may not be flown.
        refused: bool,
        /// The judgement.
        certificate: Certificate,
    },
    /// Where the robot truly was at the top of this tick; reported by the simulator, never known to the mission.
    Truth {
        /// True pose.
        pose: Pose,
        /// Distance from the hull to the nearest solid thing, metres; negative in a collision.
        clearance_m: f64,
        /// Whether the hull touched something in this tick for the first time.
        collided: bool,
    },
    /// A ranging cycle ended: one aggregated range per station heard.
    Ranged {
        /// The ranges.
        ranges: Vec<Ranging>,
    },
    /// The ranges gave a position.
    Fixed {
        /// The fix.
        fix: Fix,
    },
    /// The ranges gave no position.
    FixFailed {
        /// Why.
        error: FixError,
        /// Whether the cycle before failed too; the log shows only the first of a row.
        repeated: bool,
    },
    /// A station was left out of a fix for the first time since it was used.
    StationRejected {
        /// Which station.
        station: StationId,
        /// Why.
        reason: Exclusion,
    },
    /// A station that had been left out is used again.
    StationRestored {
        /// Which station.
        station: StationId,
    },
    /// Where the robot believes it is.
    Estimated {
        /// Pose and covariance.
        pose: PoseEstimate,
    },
    /// The position error grew beyond the limit, or the fixes stopped.
    PositionLost {
        /// Half width of the 95 % error, metres.
        error_m: f64,
        /// The limit, metres.
        limit_m: f64,
    },
    /// The position error is within the limit again.
    PositionRegained {
        /// Half width of the 95 % error, metres.
        error_m: f64,
    },
    /// The ranges contradict each other, and leaving out a station does not resolve it.
    RangesInconsistent {
        /// Sum of the squared residuals over their variances.
        chi2: f64,
        /// Stations used minus two.
        degrees_of_freedom: u32,
    },
    /// The ranges agree again.
    RangesConsistent,
    /// An obstacle that is not on the drawing was seen for the first time.
    ObstacleFound {
        /// Its outline as estimated, tank frame.
        obstacle: Obstacle,
    },
    /// The operator drew a zone that the robot must not enter.
    ZoneDrawn {
        /// Its name and outline.
        zone: Zone,
    },
    /// A found obstacle turned out to stand elsewhere than first thought.
    ObstacleMoved {
        /// Which one.
        id: ObstacleId,
        /// Its outline as estimated now.
        obstacle: Obstacle,
    },
    /// A planner was opened that is to take over once it has a plan.
    PlannerPrepared {
        /// Which ask this answers.
        ask: AskId,
        /// Which, with its parameters.
        choice: PlannerChoice,
        /// Who it is.
        info: Box<PlannerInfo>,
    },
    /// A planner that was to take over does not; the one before stays.
    PlannerRejected {
        /// Which.
        planner: String,
        /// Why, as a sentence.
        why: String,
    },
    /// A planner took over.
    PlannerChosen {
        /// Which ask this answers; absent for one that was prepared before, and in journals up to version 2.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        ask: Option<AskId>,
        /// Which, with its parameters.
        choice: PlannerChoice,
        /// Who it is.
        info: Box<PlannerInfo>,
        /// Which planner drove before.
        from: Option<String>,
    },
    /// Parameters changed under way.
    ParametersChanged {
        /// Which ask this answers; absent in journals up to version 2.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        ask: Option<AskId>,
        /// The planner with its parameters as they are now.
        choice: PlannerChoice,
    },
    /// A plan was made.
    Planned {
        /// Which ask this answers; absent in journals up to version 2.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        ask: Option<AskId>,
        /// How many points of a return path along the tether the mission put before the planner's path.
        #[serde(default, skip_serializing_if = "is_zero")]
        return_path: usize,
        /// By whom.
        planner: String,
        /// Why.
        reason: Reason,
        /// The path.
        path: Vec<Point>,
        /// Its length, metres.
        length_m: f64,
        /// Whether it achieves the whole task.
        complete: bool,
        /// What the stretches of the path are for, as far as the planner says.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        legs: Vec<Leg>,
        /// Lines that the tethered robot never crosses.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        cuts: Vec<Vec<Point>>,
    },
    /// The planner answered a step, and this is what the robot was sent.
    Commanded {
        /// Which ask this answers; absent in journals up to version 2.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        ask: Option<AskId>,
        /// What was sent to the robot: the planner's command, within the robot's limits and so that it can stop.
        command: Command,
        /// What the planner asked for, where that would have been too fast to stop in time.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        asked: Option<Command>,
    },
    /// The robot has been driven more slowly than the planner asks for, for some time, so that it can stop; reported for the
    /// first of a row.
    SpeedLimited {
        /// The speed that the planner asks for, metres per second.
        asked_m_per_s: f64,
        /// The speed that the robot is sent, metres per second.
        sent_m_per_s: f64,
        /// What the robot would need to stop from the speed asked for, metres.
        needs_m: f64,
    },
    /// The robot stands until its pressure sensor has decided whether the floor under it is flooded; reported once.
    MediumAwaited,
    /// The pressure sensor has decided whether the floor under the robot is flooded, for the first time or differently than before.
    MediumKnown {
        /// What it has decided.
        medium: Medium,
        /// The reading that decided, pascals.
        pressure_pa: f64,
    },
    /// The planner explained itself in drawings.
    Drawn {
        /// The drawings.
        drawings: Vec<Drawing>,
    },
    /// The planner reported named figures.
    Scalars {
        /// Name, value, unit.
        scalars: Vec<(String, f64, String)>,
    },
    /// The planner said something.
    PlannerLogged {
        /// Which planner.
        planner: String,
        /// How loud.
        level: LogLevel,
        /// What.
        message: String,
    },
    /// A planner saved its private state, which the console keeps.
    Snapshotted {
        /// Which ask this answers, and the name of the state.
        ask: AskId,
        /// Length of the state, bytes; 0 if there was none to save.
        bytes: u64,
    },
    /// A planner's answer came too late to be used.
    Discarded {
        /// Which ask it answers.
        ask: AskId,
        /// The plan, if it is kept to in the next one.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        plan: Option<Box<EventKind>>,
    },
    /// A planner answered a step only after the tick it was asked for; reported for the first of a row.
    PlannerLate {
        /// Which planner.
        planner: String,
        /// For how many ticks the robot stood still.
        ticks: u64,
    },
    /// The planner failed.
    PlannerFailed {
        /// Which ask this answers; absent in journals up to version 2.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        ask: Option<AskId>,
        /// How.
        fault: Fault,
    },
    /// A planner was opened that flies in shadow from now on.
    ShadowBegan {
        /// Which ask this answers.
        ask: AskId,
        /// Which, with its parameters.
        choice: PlannerChoice,
        /// Who it is.
        info: Box<PlannerInfo>,
    },
    /// The planner in shadow did something that moved nothing: it planned, drew, said, commanded or failed. A command is as
    /// the planner gave it.
    Shadowed {
        /// What would have happened had it driven.
        of: Box<EventKind>,
    },
    /// The planner in shadow answered a step after the tick that followed it; the answer counts for nothing.
    ShadowMissed {
        /// Which ask it answers.
        ask: AskId,
        /// So many ticks late.
        ticks: u64,
    },
    /// The planner in shadow was ordered to take over and is not let; it stays in shadow.
    PromotionRefused {
        /// Which.
        planner: String,
        /// Why, as a sentence.
        why: String,
    },
    /// The planner in shadow took over in this tick; that it drives, its plan from here and the certificate of it follow.
    Promoted {
        /// Which.
        planner: String,
        /// What it had done in shadow.
        tally: ShadowTally,
    },
    /// No planner flies in shadow any more.
    ShadowEnded {
        /// Which did.
        planner: String,
        /// Why, as a sentence.
        why: String,
    },
    /// A plan for all that is left was made in the background, after a repair, from a place ahead on the plan that is flown.
    BetterPlanned {
        /// Which ask this answers.
        ask: AskId,
        /// By whom.
        planner: String,
        /// The path.
        path: Vec<Point>,
        /// Whether it achieves the whole task.
        complete: bool,
        /// What the stretches of the path are for, as far as the planner says.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        legs: Vec<Leg>,
        /// Lines that the tethered robot never crosses.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        cuts: Vec<Vec<Point>>,
        /// What the plan that is flown takes from there on.
        flown: Effort,
        /// What this one takes.
        better: Effort,
        /// Why it is not offered, as a sentence; absent if it is.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        objection: Option<String>,
    },
    /// The better plan took the place of the one that was flown, in this tick; that its planner drives, the plan from here and
    /// the certificate of it follow.
    BetterPlanTaken {
        /// By whom.
        planner: String,
        /// What the plan before would have taken from here on.
        flown: Effort,
        /// What this one takes.
        better: Effort,
    },
    /// No better plan is being made or offered any more.
    BetterPlanDropped {
        /// By whom it was to be.
        planner: String,
        /// Why, as a sentence.
        why: String,
    },
    /// Floor was scanned, by the estimated pose.
    Covered {
        /// Cells of the coverage grid that are new.
        runs: Vec<CellRun>,
    },
    /// The tool passed over floor, but the position was too uncertain for it to count as scanned.
    Uncounted {
        /// Cells of the coverage grid that were not scanned before.
        runs: Vec<CellRun>,
    },
    /// An obstacle that was found changed which cells are floor and which of them the tool can reach.
    FloorChanged {
        /// The cells, and what they are now.
        changes: Vec<KindRun>,
    },
    /// How far the mission is.
    Progressed {
        /// Share of the task done, 0 to 1.
        done: f64,
        /// Way along the preset path, metres; absent without one.
        along_m: Option<f64>,
        /// Distance from the preset path, metres; absent without one.
        cross_track_m: Option<f64>,
        /// Where the robot goes next.
        target: Point,
        /// Scanned share of the reachable floor, 0 to 1.
        covered_reachable: f64,
        /// Scanned share of the whole floor, 0 to 1.
        covered_whole: f64,
        /// What the stretch of the plan under the robot is for; absent if the planner does not say.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        leg: Option<LegTag>,
    },
    /// The robot was stopped.
    Held {
        /// Why, as a sentence.
        by: HoldReason,
        /// Whether the hold ends by itself.
        #[serde(default, skip_serializing_if = "Resumes::is_never")]
        resumes: Resumes,
    },
    /// The robot may move again.
    Resumed,
    /// Last event of a run that ended by itself or was ended in good order.
    Ended {
        /// How.
        outcome: Outcome,
        /// Why, as a sentence.
        reason: String,
    },
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes references")]
fn is_zero(n: &usize) -> bool {
    *n == 0
}

/// Everything needed to repeat a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RunOpened {
    /// [`JOURNAL_VERSION`] of the writer.
    pub journal_version: u32,
    /// Version of tankops.
    pub tankops_version: String,
    /// Name of the scenario.
    pub scenario: String,
    /// The scenario file as it was read, with command line settings already put in.
    pub scenario_toml: String,
    /// Start of every random choice.
    pub seed: u64,
    /// The tank as it truly is.
    pub world: World,
    /// The mission.
    pub mission: MissionConfig,
    /// The coverage grid: which cells are floor and which of them the tool can reach.
    pub floor: world::Floor,
    /// How the plates of the floor lie, if the drawing shows them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub plates: Option<world::PlateLayout>,
    /// What the operator ticks by hand before the start.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub checklist: Vec<String>,
    /// What was measured by others and located afterwards; absent for a run that was flown.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub measured: Option<Measured>,
}
