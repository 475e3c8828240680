//! What can be wrong with a scenario.

use foreign::NotUtf8;
use std::{fmt, ops::Range};
use thiserror::Error;

/// One thing that is wrong, and where.
#[derive(Debug, Clone, PartialEq)]
pub struct Problem {
    /// Path of the key, as `tank.radius_m`; empty for the file as a whole.
    pub key: String,
    /// The value as written, shortened; absent where there is none.
    pub value: Option<String>,
    /// Bytes of the text that it concerns; absent when there is no text to point at.
    pub at: Option<Range<usize>>,
    /// What is wrong.
    pub what: Complaint,
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (&*self.key, &self.value) {
            ("", _) => write!(f, "{}", self.what),
            (key, None) => write!(f, "{key}: {}", self.what),
            (key, Some(value)) => write!(f, "{key} = {value}: {}", self.what),
        }
    }
}

/// What is wrong with a value, a key or the file.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum Complaint {
    /// The file cannot be read.
    #[error("cannot be read: {0}")]
    Unreadable(String),
    /// The file is too large.
    #[error("larger than {limit_kb} kB, which no scenario is")]
    TooLarge {
        /// Largest size accepted, kilobytes.
        limit_kb: usize,
    },
    /// The file is not text in UTF-8.
    #[error("{0}")]
    NotText(NotUtf8),
    /// The text is not TOML.
    #[error("not TOML: {0}")]
    NotToml(String),
    /// A `--set`, `--planner` or `--seed` that cannot be put in.
    #[error("{0}")]
    BadSetting(String),
    /// No such key.
    #[error("unknown key")]
    UnknownKey {
        /// What to do about it.
        remedy: String,
    },
    /// A key that must be given is not.
    #[error("missing")]
    Missing {
        /// What to write.
        remedy: String,
    },
    /// A value of another type.
    #[error("must be {wanted}")]
    WrongType {
        /// What it must be.
        wanted: String,
        /// What to do about it.
        remedy: String,
    },
    /// Infinite or not a number.
    #[error("must be a finite number")]
    NotFinite,
    /// A number out of range.
    #[error("must be {0}")]
    OutOfRange(String),
    /// A word that is not among the choices.
    #[error("must be one of {}", .words.join(", "))]
    UnknownWord {
        /// The choices.
        words: &'static [&'static str],
        /// The one that was probably meant.
        nearest: Option<&'static str>,
    },
    /// A key that means nothing beside another one.
    #[error("means nothing with {beside}")]
    OutOfPlace {
        /// The other one.
        beside: String,
    },
    /// A list that is too short.
    #[error("needs at least {need} entries, has {have}")]
    TooFew {
        /// How many there are.
        have: usize,
        /// How many it takes.
        need: usize,
    },
    /// A list that is too long.
    #[error("has {have} entries; at most {most}")]
    TooMany {
        /// How many there are.
        have: usize,
        /// How many at most.
        most: usize,
    },
    /// Two of a kind with one name or place.
    #[error("the same as that of {other}")]
    Duplicate {
        /// The first of them.
        other: String,
    },
    /// Fewer than two stations.
    #[error("{have} of at least 2 stations")]
    TooFewStations {
        /// How many there are.
        have: usize,
    },
    /// A polygon with a dent.
    #[error("not convex at [{}, {}]", .at.0, .at.1)]
    NotConvex {
        /// The corner that points inwards.
        at: (f64, f64),
    },
    /// A polygon whose sides cross.
    #[error("sides {first} and {second} cross")]
    CrossingSides {
        /// One side, counted from 1.
        first: usize,
        /// The other one.
        second: usize,
    },
    /// A polygon without area, or a line without length.
    #[error("the points enclose nothing")]
    Flat,
    /// Something that must stand on the floor and does not.
    #[error("lies {by_m:.3} m outside the tank")]
    OutsideTank {
        /// How far out.
        by_m: f64,
    },
    /// An obstacle no part of which is in the tank.
    #[error("lies wholly outside the tank")]
    WhollyOutside,
    /// A place where the hull would touch the wall.
    #[error("the hull would reach {by_m:.3} m into the wall")]
    InWall {
        /// How far.
        by_m: f64,
        /// Radius of the hull, metres.
        radius_m: f64,
    },
    /// A place in an obstacle.
    #[error("lies in obstacle \"{name}\"")]
    InObstacle {
        /// Which.
        name: String,
    },
    /// A place where the hull would touch an obstacle.
    #[error("the hull would reach {by_m:.3} m into obstacle \"{name}\"")]
    HullInObstacle {
        /// Which.
        name: String,
        /// How far.
        by_m: f64,
        /// Radius of the hull, metres.
        radius_m: f64,
    },
    /// A place where the robot must not be.
    #[error("lies in the no-go zone \"{name}\"")]
    InNoGo {
        /// Which.
        name: String,
    },
    /// A start from which the robot can hardly move without touching something.
    #[error("the hull would stand {room_mm:.3} mm from {what}")]
    NoRoomToStart {
        /// What stands there.
        what: String,
        /// Between it and the hull, millimetres.
        room_mm: f64,
        /// How much is needed, millimetres.
        needed_mm: f64,
    },
    /// A position error that would be accepted although it says nothing in a tank of this size.
    #[error("with a limit of {limit_m} m a robot that may be anywhere in this tank would not count as lost")]
    LimitOfTank {
        /// What is written, metres.
        limit_m: f64,
        /// The largest that is accepted, metres.
        most_m: f64,
    },
    /// A spiral that does not fit into the tank.
    #[error("larger than the tank less the robot's radius: {fits_m} m fit")]
    SpiralTooLarge {
        /// The largest outer radius that fits.
        fits_m: f64,
    },
    /// A path point where the hull would touch the wall.
    #[error("point {number} at [{}, {}] lies {by_m:.3} m too near to the wall for the hull", .at.0, .at.1)]
    PathInWall {
        /// Which point, from 1.
        number: usize,
        /// Where.
        at: (f64, f64),
        /// By how much.
        by_m: f64,
    },
    /// Too many points for a path.
    #[error("{points} points; at most {limit}")]
    TooManyPoints {
        /// How many.
        points: u64,
        /// How many at most.
        limit: u64,
    },
    /// Too fine a coverage grid.
    #[error("{cells} cells; at most {limit}")]
    TooManyCells {
        /// How many.
        cells: u64,
        /// How many at most.
        limit: u64,
        /// The smallest edge that is allowed here, metres.
        fits_m: f64,
    },
    /// Too long a mission for so short a tick.
    #[error("{ticks} ticks of {tick_s} s; at most {limit}")]
    TooManyTicks {
        /// How many.
        ticks: u64,
        /// How long each is.
        tick_s: f64,
        /// How many at most.
        limit: u64,
    },
    /// A planner that does not exist, or that refuses a value.
    #[error("{0}")]
    Planner(String),
    /// An occupancy map that cannot be taken.
    #[error("{0}")]
    Map(String),
    /// Random obstacles that do not fit.
    #[error("only {placed} of them found room")]
    NoRoom {
        /// How many did.
        placed: usize,
    },
}

impl Complaint {
    /// What to do about it, where that is not plain from the message.
    pub fn help(&self) -> Option<String> {
        let text = match self {
            Self::UnknownKey { remedy } | Self::Missing { remedy } | Self::WrongType { remedy, .. } => {
                remedy.clone()
            }
            Self::NotText(foreign) => foreign.remedy(),
            Self::TooLarge { .. } => "a scenario is a short TOML file; is this the right file?".into(),
            Self::NotToml(_) => "the format is TOML: `key = value` lines under `[section]` heads".into(),
            Self::UnknownWord { nearest: Some(word), .. } => format!("did you mean \"{word}\"?"),
            Self::OutOfPlace { .. } => "leave this key out".into(),
            Self::TooFewStations { .. } => {
                "give 2 stations or more, as stations = [{ name = \"A\", at_m = [4.0, 0.0] }, ...]; \
                 3 or more leave no mirror position, 4 or more let a faulty one be found"
                    .into()
            }
            Self::NotConvex { .. } => "split it into convex polygons, one [[...]] entry each".into(),
            Self::CrossingSides { .. } => "list the corners in order around the outline".into(),
            Self::Flat => "give corners that do not all lie on one line".into(),
            Self::WhollyOutside => "move it onto the floor or leave it out".into(),
            Self::InWall { radius_m, .. } | Self::HullInObstacle { radius_m, .. } => {
                format!("keep the robot's radius, {radius_m} m, away from anything solid")
            }
            Self::InObstacle { .. } | Self::InNoGo { .. } | Self::OutsideTank { .. } => {
                "choose a place on the free floor".into()
            }
            Self::NoRoomToStart { needed_mm, .. } => {
                format!("leave {needed_mm} mm, so that the robot can move off without touching it")
            }
            Self::LimitOfTank { most_m, .. } => {
                format!("at most {most_m:.3} m, half the width of the tank; 0.5 is usual")
            }
            Self::SpiralTooLarge { fits_m } => format!("write outer_radius_m = {fits_m}"),
            Self::PathInWall { .. } => "keep the robot's radius away from the wall".into(),
            Self::TooManyPoints { .. } => "leave points out, or take a larger step or pitch".into(),
            Self::TooManyCells { fits_m, .. } => format!("write cell_m = {fits_m} or more"),
            Self::TooManyTicks { .. } => "take a longer tick or a shorter time limit".into(),
            Self::NoRoom { .. } => "ask for fewer or smaller obstacles, or for a smaller gap".into(),
            Self::Unreadable(_)
            | Self::BadSetting(_)
            | Self::Planner(_)
            | Self::Map(_)
            | Self::NotFinite
            | Self::OutOfRange(_)
            | Self::UnknownWord { nearest: None, .. }
            | Self::TooFew { .. }
            | Self::TooMany { .. }
            | Self::Duplicate { .. } => return None,
        };
        Some(text)
    }
}

/// Everything that is wrong with a scenario, in the order of the text.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{}", self.first_line())]
pub struct ScenarioErrors {
    /// The file as it is called in messages.
    pub shown_name: String,
    /// The text that the problems point into.
    pub text: String,
    /// At least one.
    pub problems: Vec<Problem>,
}

impl ScenarioErrors {
    /// One problem that concerns the whole file.
    pub fn of_file(shown_name: &str, what: Complaint) -> Self {
        let problem = Problem { key: String::new(), value: None, at: None, what };
        Self { shown_name: shown_name.to_owned(), text: String::new(), problems: vec![problem] }
    }

    fn first_line(&self) -> String {
        let first = self.problems.first().map(ToString::to_string).unwrap_or_default();
        match self.problems.len() {
            0 | 1 => format!("{}: {first}", self.shown_name),
            n => format!("{}: {first} (and {} more)", self.shown_name, n - 1),
        }
    }
}
