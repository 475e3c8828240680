//! Problems in a scenario.

use foreign::NotUtf8;
use std::{fmt, ops::Range};
use thiserror::Error;

/// A problem, and its position.
#[derive(Debug, Clone, PartialEq)]
pub struct Problem {
    /// The path of the key, for example `tank.radius_m`; empty for the whole file.
    pub key: String,
    /// The value as written, shortened; `None` if there is no value.
    pub value: Option<String>,
    /// The bytes of the text that the problem concerns; `None` if there is no position to show.
    pub at: Option<Range<usize>>,
    /// The problem itself.
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

/// A problem with a value, a key or the file.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum Complaint {
    /// The file cannot be read.
    #[error("cannot be read: {0}")]
    Unreadable(String),
    /// The file is too large.
    #[error("larger than {limit_kb} kB, the limit for a scenario")]
    TooLarge {
        /// The largest accepted size in kilobytes.
        limit_kb: usize,
    },
    /// The file is not text in UTF-8.
    #[error("{0}")]
    NotText(NotUtf8),
    /// The text is not valid TOML.
    #[error("invalid TOML: {0}")]
    NotToml(String),
    /// A `--set`, `--planner` or `--seed` that cannot be applied.
    #[error("{0}")]
    BadSetting(String),
    /// A key that does not exist.
    #[error("unknown key")]
    UnknownKey {
        /// The remedy.
        remedy: String,
    },
    /// A required key is missing.
    #[error("missing")]
    Missing {
        /// The text to add.
        remedy: String,
    },
    /// A value of the wrong type.
    #[error("must be {wanted}")]
    WrongType {
        /// The required type.
        wanted: String,
        /// The remedy.
        remedy: String,
    },
    /// A number that is infinite or NaN.
    #[error("must be a finite number")]
    NotFinite,
    /// A number out of range.
    #[error("must be {0}")]
    OutOfRange(String),
    /// A word that is not one of the allowed words.
    #[error("must be one of {}", .words.join(", "))]
    UnknownWord {
        /// The allowed words.
        words: &'static [&'static str],
        /// The word that was probably meant.
        nearest: Option<&'static str>,
    },
    /// A key that has no effect together with another key.
    #[error("has no effect with {beside}")]
    OutOfPlace {
        /// The other key, with its value.
        beside: String,
    },
    /// A list that is too short.
    #[error("needs {need} or more entries, but has {have}")]
    TooFew {
        /// The number of entries.
        have: usize,
        /// The required number of entries.
        need: usize,
    },
    /// A list that is too long.
    #[error("has {have} entries; at most {most}")]
    TooMany {
        /// The number of entries.
        have: usize,
        /// The largest number of entries.
        most: usize,
    },
    /// Two items with the same name or position.
    #[error("is the same as that of {other}")]
    Duplicate {
        /// The first of the two items.
        other: String,
    },
    /// Fewer than two stations.
    #[error("only {have} given; at least 2 stations are needed")]
    TooFewStations {
        /// The number of stations.
        have: usize,
    },
    /// A polygon with an inward corner.
    #[error("not convex at [{}, {}]", .at.0, .at.1)]
    NotConvex {
        /// The inward corner.
        at: (f64, f64),
    },
    /// A polygon whose sides cross.
    #[error("sides {first} and {second} cross")]
    CrossingSides {
        /// The number of one side, from 1.
        first: usize,
        /// The number of the other side.
        second: usize,
    },
    /// A polygon without area, or a line without length.
    #[error("the points enclose no area")]
    Flat,
    /// Something that must be inside the tank, but is not.
    #[error("is {by_m:.3} m outside the tank")]
    OutsideTank {
        /// The distance outside the tank in metres.
        by_m: f64,
    },
    /// An obstacle that is completely outside the tank.
    #[error("is completely outside the tank")]
    WhollyOutside,
    /// A position where the hull would touch the wall.
    #[error("the hull would reach {by_m:.3} m into the wall")]
    InWall {
        /// The depth in metres.
        by_m: f64,
        /// The radius of the hull in metres.
        radius_m: f64,
    },
    /// A position inside an obstacle.
    #[error("is inside obstacle \"{name}\"")]
    InObstacle {
        /// The name of the obstacle.
        name: String,
    },
    /// A position where the hull would touch an obstacle.
    #[error("the hull would reach {by_m:.3} m into obstacle \"{name}\"")]
    HullInObstacle {
        /// The name of the obstacle.
        name: String,
        /// The depth in metres.
        by_m: f64,
        /// The radius of the hull in metres.
        radius_m: f64,
    },
    /// A position that the robot must not enter.
    #[error("is inside no-go zone \"{name}\"")]
    InNoGo {
        /// The name of the zone.
        name: String,
    },
    /// A start from which the robot could hardly move without touching something.
    #[error("the hull would be {room_mm:.3} mm from {what}")]
    NoRoomToStart {
        /// The nearest object.
        what: String,
        /// The distance between this object and the hull in millimetres.
        room_mm: f64,
        /// The required distance in millimetres.
        needed_mm: f64,
    },
    /// A position limit that is too large to mean anything in a tank of this size.
    #[error(
        "with a limit of {limit_m} m, a robot that could be anywhere in this tank would not count as lost"
    )]
    LimitOfTank {
        /// The given limit in metres.
        limit_m: f64,
        /// The largest accepted limit in metres.
        most_m: f64,
    },
    /// A spiral that does not fit in the tank.
    #[error("larger than the tank minus the robot's radius: at most {fits_m} m")]
    SpiralTooLarge {
        /// The largest outer radius that fits, in metres.
        fits_m: f64,
    },
    /// A path point at which the hull would touch the wall.
    #[error("point {number} at [{}, {}] is {by_m:.3} m too close to the wall for the hull", .at.0, .at.1)]
    PathInWall {
        /// The number of the point, from 1.
        number: usize,
        /// The coordinates of the point.
        at: (f64, f64),
        /// The missing distance in metres.
        by_m: f64,
    },
    /// Too many points for a path.
    #[error("{points} points; at most {limit}")]
    TooManyPoints {
        /// The number of points.
        points: u64,
        /// The largest number of points.
        limit: u64,
    },
    /// A coverage grid that is too fine.
    #[error("{cells} cells; at most {limit}")]
    TooManyCells {
        /// The number of cells.
        cells: u64,
        /// The largest number of cells.
        limit: u64,
        /// The smallest allowed cell edge in metres.
        fits_m: f64,
    },
    /// A mission that is too long for its tick.
    #[error("{ticks} ticks of {tick_s} s; at most {limit}")]
    TooManyTicks {
        /// The number of ticks.
        ticks: u64,
        /// The length of a tick in seconds.
        tick_s: f64,
        /// The largest number of ticks.
        limit: u64,
    },
    /// A planner that does not exist, or that refuses a value.
    #[error("{0}")]
    Planner(String),
    /// An occupancy map that cannot be used.
    #[error("{0}")]
    Map(String),
    /// Random obstacles that do not fit.
    #[error("only {placed} of them fit")]
    NoRoom {
        /// The number of obstacles that fit.
        placed: usize,
    },
}

impl Complaint {
    /// The remedy, unless the message makes it obvious.
    pub fn help(&self) -> Option<String> {
        let text = match self {
            Self::UnknownKey { remedy } | Self::Missing { remedy } | Self::WrongType { remedy, .. } => {
                remedy.clone()
            }
            Self::NotText(foreign) => foreign.remedy(),
            Self::TooLarge { .. } => "a scenario is a short TOML file; is this the right file?".into(),
            Self::NotToml(_) => "a scenario is TOML: `key = value` lines below `[section]` headers".into(),
            Self::UnknownWord { nearest: Some(word), .. } => format!("did you mean \"{word}\"?"),
            Self::OutOfPlace { .. } => "remove this key".into(),
            Self::TooFewStations { .. } => {
                "write at least 2 stations, as in stations = [{ name = \"A\", at_m = [4.0, 0.0] }, ...]; with 3 \
                 or more there is no mirror image, and with 4 or more a faulty station can be detected"
                    .into()
            }
            Self::NotConvex { .. } => "split it into convex polygons, one [[...]] entry each".into(),
            Self::CrossingSides { .. } => "list the corners in order around the outline".into(),
            Self::Flat => "write corners that are not all on one line".into(),
            Self::WhollyOutside => "move it onto the floor or remove it".into(),
            Self::InWall { radius_m, .. } | Self::HullInObstacle { radius_m, .. } => {
                format!("keep at least the robot's radius, {radius_m} m, away from anything solid")
            }
            Self::InObstacle { .. } | Self::InNoGo { .. } | Self::OutsideTank { .. } => {
                "choose a point on the free floor".into()
            }
            Self::NoRoomToStart { needed_mm, .. } => {
                format!("leave {needed_mm} mm, so that the robot can move off without touching anything")
            }
            Self::LimitOfTank { most_m, .. } => {
                format!("at most {most_m:.3} m, half the width of the tank; 0.5 is usual")
            }
            Self::SpiralTooLarge { fits_m } => format!("write outer_radius_m = {fits_m} or less"),
            Self::PathInWall { .. } => "keep the path at least the robot's radius away from the wall".into(),
            Self::TooManyPoints { .. } => "remove points, or use a larger step or pitch".into(),
            Self::TooManyCells { fits_m, .. } => format!("write cell_m = {fits_m} or more"),
            Self::TooManyTicks { .. } => "use a longer tick or a shorter time limit".into(),
            Self::NoRoom { .. } => "use fewer or smaller obstacles, or a smaller gap".into(),
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

/// All problems in a scenario, in the order of the text.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{}", self.first_line())]
pub struct ScenarioErrors {
    /// The name of the file in messages.
    pub shown_name: String,
    /// The text to which the problems refer.
    pub text: String,
    /// The problems; at least one.
    pub problems: Vec<Problem>,
}

impl ScenarioErrors {
    /// Creates an error with a single problem that concerns the whole file.
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
