//! The causes of alarms.

use mission::{EventKind, HoldReason};
use serde::{Deserialize, Serialize};
use vehicle::port::{LinkState, Notice};

/// The cause of an alarm; there is at most one alarm per cause.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum Cause {
    /// The position error is beyond the limit.
    PositionLost,
    /// The ranges contradict each other.
    Contradiction,
    /// The position is not protected against a wrong station.
    NotProtected,
    /// The ranges of a station are wrong by a constant length.
    Bias(world::StationId),
    /// A bias of a station and a wrong speed of sound cannot be told apart.
    NotSeparable,
    /// The pulses that the stations exchanged contradict their survey, or give no result.
    Pulses,
    /// No position can be computed from the ranges.
    NoFix,
    /// A station is not used in the fix.
    Station(world::StationId),
    /// Channels of the instrument are dead.
    DeadChannel,
    /// An obstacle was found that is not on the drawing.
    Map,
    /// The scans do not show an obstacle of this name where it is drawn or was found.
    NotThere(String),
    /// The tether is near or at a limit; the word names the limit.
    Tether(String),
    /// The last plan could not be certified for the tether.
    Certificate,
    /// The hull is in this no-go zone.
    Zone(String),
    /// The link to the vehicle is lost or faulty.
    Link,
    /// The vehicle cannot be driven: by hand, emergency stop or fault.
    Vehicle,
    /// The vehicle sends faulty messages between good ones.
    FaultyMessages,
    /// The vehicle's clock does not keep the rate of the console's.
    VehicleClock,
    /// The console itself was stopped during a live run.
    ConsoleStopped,
    /// The scan shows something in the robot's way, or is missing.
    Guard,
    /// The vehicle moves although it should stand.
    StopNotConfirmed,
    /// The planner failed.
    Planner,
    /// The robot makes no progress.
    Stuck,
    /// The run ended with an outcome other than complete.
    Ended,
    /// The run is not being recorded.
    Recording,
    /// The console that runs the watched mission has exited.
    Writer,
    /// A part of the console failed.
    Console,
    /// The console responds slowly to keys.
    Response,
    /// The console cannot draw as often as its data changes.
    Frames,
    /// The recorder is behind the mission.
    RecorderLag,
    /// The disk that holds the runs is almost full.
    Disk,
}

impl Cause {
    /// The cause that an event is about, whether the event raises the alarm, clears the alarm or follows from the
    /// cause.
    pub fn of(kind: &EventKind) -> Option<Self> {
        Some(match kind {
            EventKind::StationRejected { station, .. } | EventKind::StationRestored { station } => {
                Self::Station(*station)
            }
            EventKind::PositionLost { .. } | EventKind::PositionRegained { .. } => Self::PositionLost,
            EventKind::RangesInconsistent { .. } | EventKind::RangesConsistent => Self::Contradiction,
            EventKind::ProtectionLost { .. } | EventKind::ProtectionRegained { .. } => Self::NotProtected,
            EventKind::StationBiased { station, .. } | EventKind::StationUnbiased { station } => {
                Self::Bias(*station)
            }
            EventKind::NotSeparable { .. } | EventKind::Separable => Self::NotSeparable,
            EventKind::PulsesTested { .. }
            | EventKind::PulsesFailed { .. }
            | EventKind::ClocksChanged { .. } => Self::Pulses,
            EventKind::FixFailed { .. } => Self::NoFix,
            EventKind::ChannelsJudged(_) => Self::DeadChannel,
            EventKind::ObstacleFound { .. } => Self::Map,
            EventKind::NotThere { name, .. } => Self::NotThere(name.clone()),
            EventKind::TetherAlarmRaised { alarm, .. } | EventKind::TetherAlarmCleared { alarm } => {
                Self::Tether(alarm.word().to_owned())
            }
            EventKind::Noticed(notice) => Self::of_notice(notice),
            EventKind::Link(link) if link.state == LinkState::ConsoleStopped => Self::ConsoleStopped,
            EventKind::Link(link) if link.state.is_heard() && link.state != LinkState::Faulty => {
                Self::Vehicle
            }
            EventKind::Link(_) => Self::Link,
            EventKind::Stood { .. } => Self::StopNotConfirmed,
            EventKind::Certified { .. } => Self::Certificate,
            EventKind::ZoneBreached { zone, .. } | EventKind::ZoneLeft { zone } => Self::Zone(zone.clone()),
            EventKind::PlannerFailed { .. } | EventKind::PlannerChosen { .. } => Self::Planner,
            EventKind::Ended { .. } => Self::Ended,
            EventKind::Held { by, .. } => Self::of_hold(by)?,
            _ => return None,
        })
    }

    /// The cause's name in journals: the same in every run, whatever the alarm's text.
    pub fn key(&self) -> String {
        match self {
            Self::PositionLost => "position_lost".into(),
            Self::Contradiction => "contradiction".into(),
            Self::NotProtected => "not_protected".into(),
            Self::Bias(id) => format!("bias {}", id.0),
            Self::NotSeparable => "not_separable".into(),
            Self::Pulses => "pulses".into(),
            Self::NoFix => "no_fix".into(),
            Self::DeadChannel => "dead_channel".into(),
            Self::Station(id) => format!("station {}", id.0),
            Self::Map => "map".into(),
            Self::NotThere(name) => format!("not there {name}"),
            Self::Tether(word) => format!("tether {word}"),
            Self::Certificate => "certificate".into(),
            Self::Zone(zone) => format!("zone {zone}"),
            Self::Link => "link".into(),
            Self::Vehicle => "vehicle".into(),
            Self::FaultyMessages => "faulty_messages".into(),
            Self::VehicleClock => "vehicle_clock".into(),
            Self::ConsoleStopped => "console_stopped".into(),
            Self::Guard => "guard".into(),
            Self::StopNotConfirmed => "stop_not_confirmed".into(),
            Self::Planner => "planner".into(),
            Self::Stuck => "stuck".into(),
            Self::Ended => "ended".into(),
            Self::Recording => "recording".into(),
            Self::Writer => "writer".into(),
            Self::Console => "console".into(),
            Self::Response => "response".into(),
            Self::Frames => "frames".into(),
            Self::RecorderLag => "recorder_lag".into(),
            Self::Disk => "disk".into(),
        }
    }

    fn of_notice(notice: &Notice) -> Self {
        match notice {
            Notice::OtherVehicle { .. } => Self::Vehicle,
            Notice::FaultyMessages { .. } => Self::FaultyMessages,
            Notice::ClockRate { .. } => Self::VehicleClock,
        }
    }

    fn of_hold(by: &HoldReason) -> Option<Self> {
        match by {
            HoldReason::PositionLost => Some(Self::PositionLost),
            HoldReason::RangesInconsistent => Some(Self::Contradiction),
            HoldReason::PlannerFault { .. } | HoldReason::PlannerSilent { .. } => Some(Self::Planner),
            HoldReason::Stuck { .. } => Some(Self::Stuck),
            HoldReason::Guard { .. } => Some(Self::Guard),
            HoldReason::PlanRefused { .. } => Some(Self::Certificate),
            HoldReason::ZoneBreached { zone } => Some(Self::Zone(zone.clone())),
            HoldReason::Tether { .. }
            | HoldReason::Vehicle { .. }
            | HoldReason::Operator
            | HoldReason::Stepped
            | HoldReason::PlannerReplaced => None,
        }
    }

    /// Each cause once, for tests that go through all of them.
    #[doc(hidden)]
    pub fn every() -> Vec<Self> {
        let tether = [
            "reel",
            "wrap",
            "total wrap",
            "snag",
            "return path",
            "stray",
            "slack",
            "broken",
            "reel pull",
            "robot pull",
        ];
        let all: Vec<Self> = [
            Self::PositionLost,
            Self::Contradiction,
            Self::NotProtected,
            Self::Bias(world::StationId(1)),
            Self::NotSeparable,
            Self::Pulses,
            Self::NoFix,
            Self::DeadChannel,
            Self::Station(world::StationId(1)),
            Self::Map,
            Self::NotThere("column 5".into()),
            Self::Certificate,
            Self::Zone("no-go 1".into()),
            Self::Link,
            Self::Vehicle,
            Self::FaultyMessages,
            Self::VehicleClock,
            Self::ConsoleStopped,
            Self::Guard,
            Self::StopNotConfirmed,
            Self::Planner,
            Self::Stuck,
            Self::Ended,
            Self::Recording,
            Self::Writer,
            Self::Console,
            Self::Response,
            Self::Frames,
            Self::RecorderLag,
            Self::Disk,
        ]
        .into_iter()
        .chain(tether.map(|word| Self::Tether(word.into())))
        .collect();
        // A new cause fails to compile until it is added to the list above.
        for cause in &all {
            match cause {
                Self::PositionLost
                | Self::Contradiction
                | Self::NotProtected
                | Self::Bias(_)
                | Self::NotSeparable
                | Self::Pulses
                | Self::NoFix
                | Self::DeadChannel
                | Self::Station(_)
                | Self::Map
                | Self::NotThere(_)
                | Self::Tether(_)
                | Self::Certificate
                | Self::Zone(_)
                | Self::Link
                | Self::Vehicle
                | Self::FaultyMessages
                | Self::VehicleClock
                | Self::ConsoleStopped
                | Self::Guard
                | Self::StopNotConfirmed
                | Self::Planner
                | Self::Stuck
                | Self::Ended
                | Self::Recording
                | Self::Writer
                | Self::Console
                | Self::Response
                | Self::Frames
                | Self::RecorderLag
                | Self::Disk => {}
            }
        }
        all
    }
}
