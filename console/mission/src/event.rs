//! The events of a run: everything that is known about it.
//!
//! The journal, the recording, the screen and the report are all derived from this one enum. Events are in the past
//! tense and self-contained. They do not contain the wall-clock time or anything else that would differ between two
//! equal runs.

mod better_plan;
mod channels;
mod clock_offset;
mod effort;
mod log_line;
mod measured;
mod offer;
mod pulse;
mod recorded;
mod rounding;
mod run_opened;
mod severity;
mod shadow;
mod survey;
mod tether;

pub use better_plan::{PlanDropped, PlanMade, PlanTaken};
pub use channels::ChannelsJudged;
pub use clock_offset::ClockOffset;
pub use effort::Effort;
pub use log_line::{LogLine, late_text};
pub use measured::{Asked, Measured, ToolTrack};
pub use offer::{OfferEnd, OfferStage, PlanScan, PlanScans};
pub use pulse::{
    PulsePhase, bias_text, change_text, clocks_changed_text, pulse_error_text, pulse_failure_text, pulse_text,
};
pub use recorded::RecordedAnswers;
pub(crate) use rounding::rounded_command;
pub use run_opened::RunOpened;
pub use severity::Severity;
pub use shadow::{READY_AFTER, ShadowTally};
pub use survey::{Explored, SurveyGoal, SurveyWay};
pub use tether::{MeasuredPull, SLACK_M, TetherAlarm, TetherContact, taut_line};

use crate::{
    ask::AskId,
    order::Order,
    phase::{HoldReason, Outcome, Resumes},
    planner::{Fault, PlannerChoice, PlannerInfo},
    way_back::WayBack,
};
use exploration::SurveyMap;
use planner_api::{Command, Drawing, Drive, Leg, LegTag, LogLevel, PoseEstimate, Reason};
use positioning::{Estimated, Exclusion, Fix, FixError, PulseError, PulseTest, Ranging, Unprotected};
use serde::{Deserialize, Serialize};
use vehicle::port::{LinkSeen, Notice};
use world::tether::Certificate;
use world::{
    CableLies, CellRun, KindRun, Medium, Obstacle, ObstacleId, Point, Pose, Readings, Scan, StationId, Zone,
};

/// Version of the journal format; raised when older readers can no longer read new journals.
pub const JOURNAL_VERSION: u32 = 5;

/// One event.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Event {
    /// Number of the tick, counted from 0.
    pub tick: u64,
    /// Mission time at the start of that tick, seconds.
    pub t_s: f64,
    /// The event itself.
    #[serde(flatten)]
    pub kind: EventKind,
}

/// The kinds of event.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, strum::VariantNames)]
#[serde(rename_all = "snake_case", tag = "event")]
#[strum(serialize_all = "snake_case")]
pub enum EventKind {
    /// First event of every run: everything that is needed to repeat the run.
    RunOpened(Box<RunOpened>),
    /// An order from the operator was accepted.
    Ordered {
        /// The order.
        order: Order,
    },
    /// An order from the operator was refused.
    OrderRefused {
        /// The order.
        order: Order,
        /// The reason why it was refused, and what would be accepted.
        why: String,
    },
    /// The true geometry of the cable at the start of this tick. The simulator reports the geometry; the mission does
    /// not know it.
    TetherTruth {
        /// Length of cable between anchor and robot, metres.
        length_m: f64,
        /// Largest wrap on one obstacle, radians.
        wrap_max_rad: f64,
        /// Sum of all wraps, radians.
        wrap_total_rad: f64,
        /// Length of cable beyond the straight line from the anchor to the robot, metres.
        detour_m: f64,
        /// How the cable lies; absent for one that is always taut.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        lies: Option<Box<CableLies>>,
    },
    /// The geometry of the cable, computed from the estimated pose.
    Tethered {
        /// Length of cable between anchor and robot, as expected from the map, metres.
        length_m: f64,
        /// Length paid out by the reel, as measured by its encoder, metres; absent without an encoder.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        paid_out_m: Option<f64>,
        /// Length left on the reel, metres, computed from the larger of `length_m` and `paid_out_m`.
        free_m: f64,
        /// Contacts with obstacles, in order from the anchor.
        contacts: Vec<TetherContact>,
        /// Largest wrap on one obstacle, radians.
        wrap_max_rad: f64,
        /// Sum of all wraps, radians.
        wrap_total_rad: f64,
        /// Factor by which the wraps multiply the force needed to pull the tether (capstan equation).
        pull_factor: f64,
        /// Pull at the reel that taking up this cable needs, newtons; absent if the scenario does not describe the reel.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pull_n: Option<f64>,
        /// The pull on the cable, as measured; absent without a sensor.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        measured: Option<MeasuredPull>,
        /// Length of the return path along the cable, metres; absent if the hull does not fit.
        return_length_m: Option<f64>,
        /// The bends of the taut cable between the anchor and the robot.
        bends: Vec<Point>,
    },
    /// The cable is near a limit, or has reached it.
    TetherAlarmRaised {
        /// The limit.
        alarm: TetherAlarm,
        /// Whether the limit has been reached; if not, the cable is only near it.
        reached: bool,
    },
    /// The cable is well within a limit again.
    TetherAlarmCleared {
        /// The limit.
        alarm: TetherAlarm,
    },
    /// The effect of a plan on the tether was evaluated.
    Certified {
        /// Id of the planner.
        planner: String,
        /// Whether the plan is refused.
        refused: bool,
        /// The certificate, or why there is none.
        certificate: Certificate,
    },
    /// The simulated scanner made a scan at the start of this tick. The scans of a real vehicle are part of
    /// [`EventKind::Sensed`].
    Scanned {
        /// The scan.
        scan: Box<Scan>,
    },
    /// The robot's true pose at the start of this tick. The simulator reports the pose; the mission does not know it.
    Truth {
        /// True pose.
        pose: Pose,
        /// Distance from the hull to the nearest solid object, metres; negative in a collision.
        clearance_m: f64,
        /// Whether the hull came into contact with something in this tick.
        collided: bool,
    },
    /// A ranging cycle ended, with one aggregated range per station heard.
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
        /// The reason.
        error: FixError,
        /// Whether the previous cycle had failed, too; the log shows only the first of several failures in a row.
        repeated: bool,
    },
    /// A station that was in use until now was left out of a fix.
    StationRejected {
        /// Id of the station.
        station: StationId,
        /// The reason.
        reason: Exclusion,
    },
    /// A station that had been left out is in use again.
    StationRestored {
        /// Id of the station.
        station: StationId,
    },
    /// The robot's estimated pose.
    Estimated {
        /// Pose and covariance.
        pose: PoseEstimate,
    },
    /// The protection level of the estimated pose that follows. Only in missions whose scenario states a risk.
    Protected {
        /// The level: a radius around the estimated position, metres; `None` if the pose is not protected.
        level_m: Option<f64>,
    },
    /// The pose is not protected: a wrong station could move it by any distance.
    ProtectionLost {
        /// The reason.
        why: Unprotected,
    },
    /// The pose is protected again.
    ProtectionRegained {
        /// The protection level, metres.
        level_m: f64,
    },
    /// The errors of the ranges, estimated from the last fixes. Only in missions with a session calibration.
    SessionCalibrated {
        /// Share by which all ranges are too long.
        scale: Estimated,
        /// Correlation of this share with the slip of the robot, 0 to 1; present only if the fixes cannot tell the two
        /// apart.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        slip_correlation: Option<f64>,
    },
    /// The stations sent pulses that the others heard.
    PulsesTested {
        /// The part of the run.
        phase: PulsePhase,
        /// The result.
        test: PulseTest,
    },
    /// Pulses show that clocks of stations have changed since the last usable test, although the stations share one clock:
    /// ranges since then were wrong.
    ClocksChanged {
        /// The change of each clock, relative to most of the others.
        changes: Vec<ClockOffset>,
    },
    /// The task is done, or the robot is back; it stands still until the stations have exchanged their last pulses.
    PulsesAwaited {
        /// Mission time at which the mission ends without them, seconds.
        until_s: f64,
    },
    /// The pulses of the stations give no calibration.
    PulsesFailed {
        /// The part of the run.
        phase: PulsePhase,
        /// The reason.
        why: PulseError,
    },
    /// The clocks of the stations. Only in missions whose stations share no common clock.
    ClocksEstimated {
        /// The offset of each station.
        offsets: Vec<ClockOffset>,
    },
    /// The ranges of a station are wrong by a constant length. Floor that was scanned since the bias may have begun is in
    /// doubt, so it is not guaranteed any more.
    StationBiased {
        /// Id of the station.
        station: StationId,
        /// Length by which its ranges are too long, metres.
        bias_m: Estimated,
        /// Earliest mission time at which the bias may have begun, seconds.
        since_s: f64,
        /// Whether the bias is subtracted from now on; if not, the station is not used.
        is_corrected: bool,
    },
    /// The ranges of a station that had a bias are right again.
    StationUnbiased {
        /// Id of the station.
        station: StationId,
    },
    /// The last fixes cannot tell a bias of a station from an error of the speed of sound, or the biases of two stations.
    NotSeparable {
        /// The largest correlation of a bias with the error of the speed of sound, 0 to 1.
        correlation: f64,
        /// Two stations of which one is wrong; absent if no bias is significant.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        stations: Option<[StationId; 2]>,
    },
    /// The last fixes can tell these errors apart again.
    Separable,
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
    /// The ranges contradict each other, and leaving out one station does not resolve the contradiction.
    RangesInconsistent {
        /// Sum of the squared residuals, each divided by its variance.
        chi2: f64,
        /// Number of stations used, minus two.
        degrees_of_freedom: u32,
    },
    /// The ranges agree again.
    RangesConsistent,
    /// An obstacle that is not on the drawing was seen for the first time.
    ObstacleFound {
        /// Estimated outline of the obstacle, tank frame.
        obstacle: Obstacle,
    },
    /// Scans went through the place of an obstacle on the chart, so the obstacle is not there.
    NotThere {
        /// Id of the obstacle.
        id: ObstacleId,
        /// Its name.
        name: String,
        /// Number of scans through its place since it was last seen.
        scans: u32,
    },
    /// The operator drew a zone that the robot must not enter.
    ZoneDrawn {
        /// Name and outline of the zone.
        zone: Zone,
    },
    /// The estimated position of a found obstacle changed.
    ObstacleMoved {
        /// Id of the obstacle.
        id: ObstacleId,
        /// New estimated outline of the obstacle.
        obstacle: Obstacle,
    },
    /// A planner that will take over once it has a plan was opened.
    PlannerPrepared {
        /// Id of the ask that this answers.
        ask: AskId,
        /// The planner, with its parameters.
        choice: PlannerChoice,
        /// Description of the planner.
        info: Box<PlannerInfo>,
    },
    /// A planner that was to take over was rejected; the current one stays.
    PlannerRejected {
        /// Id of the planner.
        planner: String,
        /// The reason, as a sentence.
        why: String,
    },
    /// A planner took over.
    PlannerChosen {
        /// Id of the ask that this answers; absent for a planner that was prepared in advance, and in journals up to
        /// version 2.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        ask: Option<AskId>,
        /// The planner, with its parameters.
        choice: PlannerChoice,
        /// Description of the planner.
        info: Box<PlannerInfo>,
        /// Id of the planner that was active before.
        from: Option<String>,
    },
    /// Parameters changed during the mission.
    ParametersChanged {
        /// Id of the ask that this answers; absent in journals up to version 2.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        ask: Option<AskId>,
        /// The planner with its new parameters.
        choice: PlannerChoice,
    },
    /// A plan was made.
    Planned {
        /// Id of the ask that this answers; absent in journals up to version 2.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        ask: Option<AskId>,
        /// Number of points in the return path along the tether that the mission put before the planner's path.
        #[serde(default, skip_serializing_if = "is_zero")]
        return_path: usize,
        /// Id of the planner.
        planner: String,
        /// The reason for the plan.
        reason: Reason,
        /// The path.
        path: Vec<Point>,
        /// Length of the path, metres.
        length_m: f64,
        /// Whether the plan achieves the whole task.
        complete: bool,
        /// The stretches of the path and their purposes, if the planner states them.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        legs: Vec<Leg>,
        /// Lines that the tethered robot never crosses.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        cuts: Vec<Vec<Point>>,
    },
    /// The planner answered a request for a step; the event contains the command that was sent to the robot.
    Commanded {
        /// Id of the ask that this answers; absent in journals up to version 2.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        ask: Option<AskId>,
        /// The command sent to the robot: the planner's command, brought within the robot's limits and slowed down if
        /// necessary so that the robot can stop.
        command: Command,
        /// The planner's own command, if it was too fast for the robot to stop in time.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        asked: Option<Command>,
    },
    /// For some time, the robot has been driven more slowly than the planner requests, so that it can stop. If there are
    /// several such periods in a row, only the first is reported.
    SpeedLimited {
        /// The speed requested by the planner, metres per second.
        asked_m_per_s: f64,
        /// The speed sent to the robot, metres per second.
        sent_m_per_s: f64,
        /// Distance that the robot would need to stop from the requested speed, metres.
        needs_m: f64,
    },
    /// The robot stands still until its pressure sensor has decided whether the floor under it is flooded; reported once.
    MediumAwaited,
    /// The pressure sensor has decided whether the floor under the robot is flooded, for the first time or with a new
    /// result.
    MediumKnown {
        /// The result.
        medium: Medium,
        /// The reading that led to the result, pascals.
        pressure_pa: f64,
    },
    /// The planner drew something to explain its decisions.
    Drawn {
        /// The drawings.
        drawings: Vec<Drawing>,
    },
    /// The planner reported named figures.
    Scalars {
        /// Names, values and units.
        scalars: Vec<(String, f64, String)>,
    },
    /// The planner logged a message.
    PlannerLogged {
        /// Id of the planner.
        planner: String,
        /// Level of the message.
        level: LogLevel,
        /// Text of the message.
        message: String,
    },
    /// A planner saved its private state, which the console keeps.
    Snapshotted {
        /// Id of the ask that this answers, which also names the state.
        ask: AskId,
        /// Length of the state, bytes; 0 if there was nothing to save.
        bytes: u64,
    },
    /// A planner's answer came too late to be used.
    Discarded {
        /// Id of the ask that was answered.
        ask: AskId,
        /// The late plan; present only if the planner will be asked to keep to it in the next plan.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        plan: Option<Box<EventKind>>,
    },
    /// A planner answered a request for a step only after the tick of the request; of several late answers in a row,
    /// only the first is reported.
    PlannerLate {
        /// Id of the planner.
        planner: String,
        /// Number of ticks for which the robot stood still.
        ticks: u64,
    },
    /// The planner failed.
    PlannerFailed {
        /// Id of the ask that this answers; absent in journals up to version 2.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        ask: Option<AskId>,
        /// Description of the fault.
        fault: Fault,
    },
    /// A planner that runs in shadow from now on was opened.
    ShadowBegan {
        /// Id of the ask that this answers.
        ask: AskId,
        /// The planner, with its parameters.
        choice: PlannerChoice,
        /// Description of the planner.
        info: Box<PlannerInfo>,
    },
    /// An action of the planner in shadow, without effect on the robot: it planned, drew, logged, commanded or failed. A
    /// command is recorded exactly as the planner gave it.
    Shadowed {
        /// The event that would have occurred if this planner had been the active one.
        of: Box<EventKind>,
    },
    /// The planner in shadow answered a request for a step too late: after the tick that follows the request. The
    /// answer is not used.
    ShadowMissed {
        /// Id of the ask that was answered.
        ask: AskId,
        /// Number of ticks by which the answer was late.
        ticks: u64,
    },
    /// The planner in shadow was ordered to take over but cannot; it stays in shadow.
    PromotionRefused {
        /// Id of the planner.
        planner: String,
        /// The reason, as a sentence.
        why: String,
    },
    /// The planner in shadow took over in this tick. The events for its activation, its plan from here on, and the
    /// certificate of that plan follow.
    Promoted {
        /// Id of the planner.
        planner: String,
        /// The planner's record in shadow.
        tally: ShadowTally,
    },
    /// No planner runs in shadow any more.
    ShadowEnded {
        /// Id of the planner that was in shadow.
        planner: String,
        /// The reason, as a sentence.
        why: String,
    },
    /// After a repair, a plan for the rest of the task was made in the background. It begins at a place ahead on the
    /// current plan.
    BetterPlanned(PlanMade),
    /// The better plan was taken in this tick. The events for the activation of its planner, the plan from here on, and
    /// the certificate of that plan follow.
    BetterPlanTaken(PlanTaken),
    /// The better plan was dropped, either while it was being made or after it had been offered.
    BetterPlanDropped(PlanDropped),
    /// A survey takes a way: to a frontier, or back.
    SurveyWay(SurveyWay),
    /// What a survey has explored so far.
    Explored(Explored),
    /// The map that a survey has made, at its end.
    Mapped {
        /// The map.
        map: Box<SurveyMap>,
    },
    /// The robot drives back by order, without a planner.
    ReturnBegan {
        /// The way.
        way: WayBack,
    },
    /// The hull entered a no-go zone, according to the estimated position.
    ZoneBreached {
        /// Name of the zone.
        zone: String,
        /// Depth of the hull in the zone, metres.
        depth_m: f64,
    },
    /// The hull has left the no-go zone.
    ZoneLeft {
        /// Name of the zone.
        zone: String,
    },
    /// Floor was scanned, according to the estimated pose.
    Covered {
        /// Newly scanned cells of the coverage grid.
        runs: Vec<CellRun>,
    },
    /// The tool passed over floor, but the position was too uncertain for it to count as scanned.
    Uncounted {
        /// Cells of the coverage grid that were not scanned before.
        runs: Vec<CellRun>,
    },
    /// A found obstacle changed which cells are floor, or which cells the tool can reach.
    FloorChanged {
        /// The changed cells and their new state.
        changes: Vec<KindRun>,
    },
    /// Progress of the mission.
    Progressed {
        /// Share of the task that is done, 0 to 1.
        done: f64,
        /// Distance along the preset path, metres; absent without one.
        along_m: Option<f64>,
        /// Distance from the preset path, metres; absent without one.
        cross_track_m: Option<f64>,
        /// The robot's next target.
        target: Point,
        /// Scanned share of the reachable floor, 0 to 1.
        covered_reachable: f64,
        /// Scanned share of the whole floor, 0 to 1.
        covered_whole: f64,
        /// Purpose of the stretch of the plan that the robot is on; absent if the planner does not state it.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        leg: Option<LegTag>,
    },
    /// The robot was stopped.
    Held {
        /// The reason.
        by: HoldReason,
        /// Whether the hold ends automatically.
        #[serde(default, skip_serializing_if = "Resumes::is_never")]
        resumes: Resumes,
    },
    /// Readings of a real vehicle arrived; a tick without this event had no readings. Occurs only in live runs, because
    /// a simulation computes its readings again.
    Sensed {
        /// The vehicle's own clock when it took the last of the readings, seconds.
        source_t_s: f64,
        /// The console's clock when the last of the readings arrived, seconds since the vehicle was connected.
        arrival_t_s: f64,
        /// The readings, as the mission used them.
        readings: Box<Readings>,
    },
    /// The state of the link to a real vehicle changed, or its periodic figures are due.
    Link(LinkSeen),
    /// A fact about a real vehicle was found, or has changed.
    Noticed(Notice),
    /// A command was sent to a real vehicle; of several commands to stand still in a row, only the first is reported.
    Sent {
        /// The motion; absent for a command to stand still.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        drive: Option<Drive>,
        /// Time for which the vehicle may carry out the motion without a further command, seconds.
        lease_s: f64,
    },
    /// Odometry has confirmed a commanded stop of a real vehicle, or has not confirmed it in time.
    Stood {
        /// Whether the stop is confirmed; if not, the vehicle is still moving although it should stand still by now.
        confirmed: bool,
        /// Time since the command to stand still, seconds.
        after_s: f64,
        /// Whether the vehicle has moved again after a confirmed stop, without an order.
        #[serde(default, skip_serializing_if = "std::ops::Not::not")]
        moved: bool,
    },
    /// The guard by the scan of a real vehicle has limited a command, so that the robot can stop in time.
    Guarded {
        /// The speed before the guard, metres per second.
        asked_m_per_s: f64,
        /// The speed that was sent, metres per second.
        sent_m_per_s: f64,
        /// Distance of the scanned point from the hull, metres; negative inside the disc that contains the hull.
        gap_m: f64,
        /// Direction of the point in the robot frame, radians, counter-clockwise from straight ahead.
        direction_rad: f64,
    },
    /// The scans of the robot's scanner cannot be used, for another reason than before, or can be used again.
    ScannerJudged {
        /// The reason, as a clause that ends with what to check; absent if the scans can be used.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        trouble: Option<String>,
    },
    /// Scans have begun to correct the estimated position, or have ceased to.
    ScanAided {
        /// The reason why they do not correct it, as a clause about the scans; absent if they do.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        trouble: Option<String>,
    },
    /// Other channels of the instrument are dead than before. It comes before the pose of its tick, and is about the floor
    /// that the tool passes from the pose of the tick before on.
    ChannelsJudged(ChannelsJudged),
    /// The robot may move again.
    Resumed,
    /// An unattended mission of a real vehicle is held because its position is not reliable. It resumes automatically when
    /// the position is reliable again; otherwise, its time limit ends it.
    PositionAwaited {
        /// Limit on the 95 % position error, metres.
        limit_m: f64,
        /// Mission time at which the time limit ends the mission, seconds.
        ends_t_s: f64,
    },
    /// The last event of every run that ended normally or by order.
    Ended {
        /// The outcome.
        outcome: Outcome,
        /// The reason, as a sentence.
        reason: String,
    },
}

impl EventKind {
    /// The names of all kinds, as in the key `event` of a journal.
    pub fn names() -> &'static [&'static str] {
        <Self as strum::VariantNames>::VARIANTS
    }
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes references")]
fn is_zero(n: &usize) -> bool {
    *n == 0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_names_of_the_kinds_are_those_in_a_journal() {
        let error = serde_json::from_str::<EventKind>("{\"event\": \"nosuch\"}")
            .expect_err("an unknown kind")
            .to_string();
        let known: Vec<&str> = error.split('`').skip(3).step_by(2).collect();
        assert_eq!(known, EventKind::names(), "{error}");
    }
}
