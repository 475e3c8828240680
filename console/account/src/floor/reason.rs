//! Reasons why floor was not scanned, or cannot be scanned.

use super::{areas::Explained, measure::Measure};
use serde::{Deserialize, Serialize};
use world::{Cell, beside_limit};

/// The reason why reachable floor was not scanned.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MissReason {
    /// The tool passed, but the position error was above the limit.
    PositionUncertain,
    /// The tool passed, but a channel that was dead touched the floor.
    DeadChannel,
    /// Beside an obstacle that was found during the run.
    FoundObstacle,
    /// Outside the areas that the mission had to scan.
    NotAsked,
    /// Beyond the lanes, which are narrower than the swath by the overlap.
    Narrow,
    /// No plan led to the floor, because a plan keeps hull and clearance from solid objects.
    Clearance,
    /// No plan led to the floor, although a lane that keeps hull and clearance from the solid object beside it has room
    /// there.
    NoLaneBeside,
    /// No plan led to the floor, because it is along a line that keeps the tether unwound.
    Wrap,
    /// No plan led to the floor.
    NotPlanned,
    /// The run had no plan.
    NoPlan,
    /// No plan led to the floor, because the floor is beyond the reach of the tether.
    BeyondReel,
    /// A plan led to the floor, but the mission ended first.
    NotReached,
    /// A plan led to the floor, but the robot passed to one side of it.
    PassedBeside,
    /// Scanned while a station was wrong, so that its guarantee was taken back.
    InDoubt,
}

/// The reason why floor is unreachable.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum OutOfReach {
    /// The robot keeps its distance from the shell.
    ShellMargin,
    /// The robot keeps its distance from an obstacle.
    BesideObstacle,
    /// In a no-go zone.
    NoGo,
    /// No passage to it is wide enough for the robot.
    ClosedOff,
}

impl OutOfReach {
    /// The reason why cells of a class are unreachable; `None` for other classes.
    pub fn of(kind: Cell) -> Option<Self> {
        match kind {
            Cell::Outside | Cell::Reachable | Cell::Untestable => None,
            Cell::Unreachable => Some(OutOfReach::ClosedOff),
            Cell::Margin => Some(OutOfReach::ShellMargin),
            Cell::Beside => Some(OutOfReach::BesideObstacle),
            Cell::NoGo => Some(OutOfReach::NoGo),
        }
    }
}

impl Explained for MissReason {
    fn sentence(self, measure: Option<&Measure>) -> String {
        let Some(measure) = measure else { return self.plainly().to_owned() };
        let Measure { value_m, limit_m, near, .. } = measure;
        let (limit_m, near) = (limit_m.unwrap_or(0.0), near.as_deref().unwrap_or("a solid object"));
        match self {
            Self::PositionUncertain => {
                let [error, limit] = beside_limit(*value_m, limit_m, 2);
                format!("passed with position error {error} m, limit {limit} m")
            }
            Self::DeadChannel => {
                format!("passed while {near} was dead, up to {value_m:.2} m from scanned floor")
            }
            Self::FoundObstacle => {
                // The obstacles that a run finds are named `found 1`, `found 2` and so on.
                let near = near.strip_prefix("found ").unwrap_or(near);
                format!("{} from obstacle {near}, found on the way", measure.range())
            }
            Self::NotAsked => format!("not requested, up to {value_m:.2} m outside the requested areas"),
            Self::Narrow => {
                format!("outside the outermost lane by {value_m:.2} m (lane width {limit_m:.2} m)")
            }
            Self::Clearance => {
                format!(
                    "not planned: {} from {near}, but hull and clearance require {limit_m:.2} m",
                    measure.range()
                )
            }
            Self::NoLaneBeside => {
                format!(
                    "not planned: {} from {near}, and no lane of the plan runs along it here",
                    measure.range()
                )
            }
            Self::Wrap => "not planned: would wind the tether".to_owned(),
            Self::NotPlanned => format!(
                "not planned: up to {value_m:.2} m from the planned lanes (lanes \
                are {limit_m:.2} m wide)"
            ),
            Self::NoPlan | Self::InDoubt => self.plainly().to_owned(),
            Self::BeyondReel => {
                format!(
                    "not planned: {value_m:.1} m beyond the reach of the tether; lanes are within \
                     {limit_m:.1} m of the anchor"
                )
            }
            Self::NotReached => {
                format!("planned, not reached: mission ended up to {value_m:.1} m earlier")
            }
            Self::PassedBeside => format!("planned, but the robot passed {value_m:.2} m to one side"),
        }
    }

    /// Floor that was not requested is not missed floor, so no area may contain both kinds.
    fn is_apart(self) -> bool {
        self == Self::NotAsked
    }
}

impl MissReason {
    /// The reason in at most 32 characters, for a list.
    pub fn briefly(self) -> &'static str {
        match self {
            Self::PositionUncertain => "position error above the limit",
            Self::DeadChannel => "dead channel",
            Self::FoundObstacle => "beside a found obstacle",
            Self::NotAsked => "not requested",
            Self::Narrow => "outside the outermost lane",
            Self::Clearance => "not planned (clearance)",
            Self::NoLaneBeside => "not planned (no lane along it)",
            Self::Wrap => "not planned (tether)",
            Self::NotPlanned => "not planned",
            Self::NoPlan => "the run had no plan",
            Self::BeyondReel => "not planned (beyond the tether)",
            Self::NotReached => "mission ended",
            Self::PassedBeside => "the robot passed to one side",
            Self::InDoubt => "scanned while a station was wrong",
        }
    }

    /// The reason without its value.
    pub fn plainly(self) -> &'static str {
        match self {
            Self::PositionUncertain => "passed, but the position error was above the limit",
            Self::DeadChannel => "passed, but a channel of the instrument was dead",
            Self::FoundObstacle => "beside an obstacle found during the run",
            Self::NotAsked => "not requested",
            Self::Narrow => "outside the outermost lane",
            Self::Clearance => "not planned (too little room for hull and clearance)",
            Self::NoLaneBeside => "not planned: no lane of the plan runs along the solid object here",
            Self::Wrap => "not planned: would wind the tether",
            Self::NotPlanned => "not planned",
            Self::NoPlan => "the run had no plan when it ended",
            Self::BeyondReel => "not planned (beyond the tether)",
            Self::NotReached => "planned, not reached: mission ended",
            Self::PassedBeside => "planned, but the robot passed to one side",
            Self::InDoubt => "scanned while a station was wrong, guarantee taken back",
        }
    }
}

impl OutOfReach {
    /// The reason without its value.
    pub fn plainly(self) -> &'static str {
        match self {
            Self::ShellMargin => "clearance from the shell",
            Self::BesideObstacle => "clearance from an obstacle",
            Self::NoGo => "in a no-go zone",
            Self::ClosedOff => "no passage wide enough",
        }
    }
}

impl Explained for OutOfReach {
    fn sentence(self, measure: Option<&Measure>) -> String {
        match (self, measure) {
            (Self::ShellMargin | Self::BesideObstacle, Some(measure)) => {
                let near = measure.near.as_deref().unwrap_or("a solid object");
                let limit_m = measure.limit_m.unwrap_or(0.0);
                format!("{} from {near}, but hull and clearance require {limit_m:.2} m", measure.range())
            }
            (Self::ClosedOff, Some(Measure { value_m, near, .. })) => {
                let by = near.as_ref().map(|zone| format!("closed off by {zone}: ")).unwrap_or_default();
                format!("{by}no passage at least {value_m:.2} m wide (hull and clearance)")
            }
            (Self::NoGo, Some(Measure { value_m, near, .. })) => {
                let zone = near.as_deref().unwrap_or("a no-go zone");
                format!("in {zone}, up to {value_m:.2} m from reachable floor")
            }
            (_, None) => self.plainly().to_owned(),
        }
    }
}
