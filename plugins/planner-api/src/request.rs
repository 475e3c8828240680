//! The requests to a planner, and the information that they carry.

use crate::message;
use crate::site::{Obstacle, Site};
use nalgebra::{Matrix3, Point2};

/// An estimated pose and its covariance.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PoseEstimate {
    /// Position, metres.
    pub position: Point2<f64>,
    /// Heading, radians.
    pub heading_rad: f64,
    /// Covariance of x, y and heading, in metres and radians.
    #[cfg_attr(feature = "serde", serde(with = "geometry::symmetric"))]
    pub covariance: Matrix3<f64>,
}

/// The reason why a plan is requested.
#[derive(Debug, Clone, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
pub enum Reason {
    /// The mission begins.
    Start,
    /// The robot cannot continue along the plan.
    Blocked,
    /// The map has changed.
    MapChanged,
    /// The operator requests it.
    Operator,
    /// This planner takes over from a different one.
    Swap {
        /// Id of the previous planner.
        from: String,
    },
    /// This planner restarts after a fault.
    Recover,
}

/// What the mission requires from now on, lent by the console.
pub type Task<'a> = message::Task<&'a [Point2<f64>], &'a [&'a [Point2<f64>]]>;

/// The limits of a tether. The tether runs taut from the anchor to the robot, and may touch obstacles.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct TetherLimits {
    /// Length of tether on the reel, metres; infinite without a limit.
    pub reel_length_m: f64,
    /// Largest wrap angle around one obstacle, radians; infinite without a limit.
    pub wrap_max_rad: f64,
    /// Largest sum of the wrap angles around all obstacles, radians; infinite without a limit.
    pub wrap_total_max_rad: f64,
    /// The pull that moves the tether; `None` if the pull is not limited.
    pub pull: Option<TetherPull>,
}

/// The pull at the reel that takes up a taut tether. From the robot to the reel, it grows by the friction of the floor
/// on every metre, and by the factor e^(friction · wrap) round each obstacle.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct TetherPull {
    /// Friction of the floor on the tether, newtons per metre.
    pub floor_n_per_m: f64,
    /// Coefficient of friction of the tether on obstacles.
    pub friction: f64,
    /// Pull of the reel, newtons: the console refuses a plan that needs more.
    pub reel_n: f64,
    /// Pull that a plan should not exceed, newtons.
    pub preferred_n: f64,
}

/// A request for a plan, lent by the console.
///
/// ```
/// # use planner_api::{PlanRequest, Point2, Task};
/// # fn path_to_goal(request: &PlanRequest<'_>) -> Option<Vec<Point2<f64>>> {
/// let Task::Goto { goal, tolerance_m } = request.task else { return None };
/// let start = request.start.position;
/// let arrived = (goal - start).norm() <= tolerance_m;
/// Some(if arrived { vec![start] } else { vec![start, goal] })
/// # }
/// ```
pub type PlanRequest<'a> =
    message::PlanRequest<&'a [Point2<f64>], &'a [&'a [Point2<f64>]], &'a Reason, &'a Site<'a>, &'a Plan>;

impl<'a> PlanRequest<'a> {
    /// Creates the request of a robot that has not driven yet.
    pub fn new(reason: &'a Reason, start: PoseEstimate, task: Task<'a>, site: &'a Site<'a>) -> Self {
        Self { reason, start, task, site, previous: &[], under_way: None }
    }
}

/// A plan: a path to drive, the purposes of its stretches, and the cuts.
///
/// ```
/// use planner_api::{Plan, Point2};
///
/// let path = vec![Point2::new(0.0, 0.0), Point2::new(3.0, 4.0)];
/// let plan = Plan { path, cost: 5.0, complete: true, ..Plan::default() };
/// assert_eq!((plan.check(), plan.legs.len()), (Ok(()), 0));
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Plan {
    /// The points of the path, the start first.
    pub path: Vec<Point2<f64>>,
    /// The cost, in a measure of the planner's choice: the length in metres, unless the planner documents something
    /// else.
    pub cost: f64,
    /// Whether the path achieves the whole task.
    pub complete: bool,
    /// The purposes of the stretches of the path, in order; empty if the planner does not state them. Two consecutive
    /// legs may share a point. A stretch that belongs to no leg is treated as a transfer from one place to another.
    pub legs: Vec<Leg>,
    /// Lines that the tethered robot must never cross, whether it is on the path or off it.
    pub cuts: Vec<Vec<Point2<f64>>>,
}

impl Plan {
    /// The longest path that the console accepts, metres. The console may sample paths at centimetre spacing, and a
    /// longer path would exhaust its memory.
    pub const MOST_LENGTH_M: f64 = 1e6;

    /// Checks that all points are finite, that the path is not too long, and that the legs are within the path, in
    /// order, and share at most one point.
    ///
    /// ```
    /// use planner_api::{Leg, LegTag, Plan, Point2};
    ///
    /// let path = vec![Point2::new(0.0, 0.0), Point2::new(1.0, 0.0)];
    /// let legs = vec![Leg { tag: LegTag::Swath, first: 0, last: 2 }];
    /// let error = Plan { path, legs, ..Plan::default() }.check().unwrap_err();
    /// assert_eq!(error, "gave leg 0 from point 0 to 2 in a path of 2 points");
    /// ```
    ///
    /// # Errors
    /// States what is wrong; the text completes a sentence that begins with the planner's name.
    pub fn check(&self) -> Result<(), String> {
        let is_finite = |p: &Point2<f64>| p.x.is_finite() && p.y.is_finite();
        if let Some(index) = self.path.iter().position(|p| !is_finite(p)) {
            return Err(format!("gave a path whose point {index} is not finite"));
        }
        let (length_m, limit_m) = (self.length_m(), Self::MOST_LENGTH_M);
        // The sum of finite lengths may be infinite; this check refuses that, too.
        if length_m > limit_m {
            return Err(format!("gave a path of {length_m:.0} m; the limit is {limit_m:.0} m"));
        }
        if !self.cuts.iter().flatten().all(is_finite) {
            return Err("gave a cut with a point that is not finite".to_owned());
        }
        self.check_legs()
    }

    fn length_m(&self) -> f64 {
        self.path.windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum()
    }

    fn check_legs(&self) -> Result<(), String> {
        let mut from = 0;
        for (index, leg) in self.legs.iter().enumerate() {
            let (first, last, n) = (leg.first, leg.last, self.path.len());
            if first > last || last >= n {
                return Err(format!("gave leg {index} from point {first} to {last} in a path of {n} points"));
            }
            if first < from {
                return Err(format!(
                    "gave leg {index}, whose first point {first} is inside the previous leg"
                ));
            }
            from = last;
        }
        Ok(())
    }
}

/// The purpose of a stretch of a path.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
#[repr(u32)]
pub enum LegTag {
    /// The tool scans new floor.
    Swath = 0,
    /// The robot drives from the end of one lane to the beginning of another.
    Connector = 1,
    /// The robot retraces its path so that the tether is reeled in.
    Retract = 2,
    /// The robot drives to the first lane, or home.
    Travel = 3,
}

/// A stretch of a plan's path with its purpose.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Leg {
    /// The purpose.
    pub tag: LegTag,
    /// Index of the first point in [`Plan::path`].
    pub first: usize,
    /// Index of the last point, inclusive.
    pub last: usize,
}

impl LegTag {
    /// Returns the word for scripts and people.
    ///
    /// ```
    /// assert_eq!(planner_api::LegTag::Retract.word(), "retract");
    /// ```
    pub fn word(self) -> &'static str {
        match self {
            Self::Swath => "swath",
            Self::Connector => "connector",
            Self::Retract => "retract",
            Self::Travel => "travel",
        }
    }

    /// Converts a number that was passed across the boundary; `None` if it is not a tag.
    ///
    /// ```
    /// use planner_api::LegTag;
    ///
    /// assert_eq!(LegTag::from_number(1), Some(LegTag::Connector));
    /// assert_eq!(LegTag::from_number(4), None);
    /// ```
    pub fn from_number(number: u32) -> Option<Self> {
        [Self::Swath, Self::Connector, Self::Retract, Self::Travel]
            .into_iter()
            .find(|tag| *tag as u32 == number)
    }
}

/// A planner's view of one tick, lent by the console.
///
/// ```
/// use planner_api::{Command, Drive, Sensed};
/// # use planner_api::{Point2, PoseEstimate};
/// # let covariance = nalgebra::Matrix3::zeros();
/// # let pose = PoseEstimate { position: Point2::origin(), heading_rad: 0.0, covariance };
/// # let sensed = Sensed::new(0, 0.1, pose, Point2::new(3.0, 4.0));
///
/// let step = |sensed: &Sensed<'_>| Command::velocity((sensed.target - sensed.pose.position) * 0.1);
/// assert!(matches!(step(&sensed).drive, Drive::Velocity(v) if v.norm() == 0.5));
/// ```
pub type Sensed<'a> = message::Sensed<&'a [Point2<f64>], &'a [Obstacle<'a>]>;
