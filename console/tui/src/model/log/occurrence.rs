//! The part of an event that is kept by a log line.

use mission::EventKind;
use positioning::Ranging;
use serde::{Deserialize, Serialize};
use std::mem::{discriminant, size_of};
use world::Point;

/// The subject of a log line.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum What {
    /// A message about the console itself.
    Console,
    /// The opening of the run; the details are in the run itself.
    Opened,
    /// An event of the mission.
    Event(Box<Occurrence>),
}

/// An event of the mission without its paths and lists, and the circumstances at that time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Occurrence {
    /// The event.
    pub kind: EventKind,
    /// The robot's estimated state at the time.
    pub robot: Option<Robot>,
    /// For an event about a station: the station's last range.
    pub range: Option<Ranging>,
}

/// The robot's estimated state.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Robot {
    /// Position, metres, tank frame.
    pub at: Point,
    /// Heading, radians.
    pub heading_rad: f64,
    /// The 95 % error, metres.
    pub error_m: f64,
    /// Speed over ground, metres per second.
    pub speed_m_per_s: Option<f64>,
}

impl What {
    /// The mission event, if the line is about one.
    pub fn event(&self) -> Option<&Occurrence> {
        match self {
            Self::Event(occurrence) => Some(occurrence),
            Self::Console | Self::Opened => None,
        }
    }

    /// Whether two lines report the same kind of event.
    pub fn is_like(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Event(one), Self::Event(other)) => discriminant(&one.kind) == discriminant(&other.kind),
            _ => discriminant(self) == discriminant(other),
        }
    }

    /// The position of the event: where the station or the obstacle is; otherwise where the robot is.
    pub fn place(&self, station: impl Fn(world::StationId) -> Option<Point>) -> Option<Point> {
        let event = self.event()?;
        match &event.kind {
            EventKind::StationRejected { station: id, .. } | EventKind::StationRestored { station: id } => {
                station(*id)
            }
            EventKind::ObstacleFound { obstacle } => Some(obstacle.shape.center()),
            _ => event.robot.map(|robot| robot.at),
        }
    }

    /// Approximate memory use beyond the struct itself, bytes.
    pub(super) fn bytes(&self) -> usize {
        match self {
            Self::Console | Self::Opened => 0,
            Self::Event(_) => size_of::<Occurrence>() + 64,
        }
    }
}

/// The event without the parts that would make a long log large: only the ends of a path and only the name of a
/// planner are kept.
pub(in crate::model) fn slim(kind: &EventKind) -> EventKind {
    match kind {
        EventKind::Planned { ask, return_path, planner, reason, path, length_m, complete, .. } => {
            let ends = path.first().into_iter().chain(path.last()).copied().collect();
            EventKind::Planned {
                ask: *ask,
                return_path: *return_path,
                planner: planner.clone(),
                reason: reason.clone(),
                path: ends,
                length_m: *length_m,
                complete: *complete,
                legs: Vec::new(),
                cuts: Vec::new(),
            }
        }
        EventKind::Shadowed { of } => EventKind::Shadowed { of: Box::new(slim(of)) },
        other => {
            let mut kind = other.clone();
            match &mut kind {
                EventKind::PlannerChosen { info, .. }
                | EventKind::PlannerPrepared { info, .. }
                | EventKind::ShadowBegan { info, .. } => {
                    info.parameters.clear();
                }
                EventKind::PlannerFailed { fault, .. } => fault.partial.clear(),
                _ => {}
            }
            kind
        }
    }
}
