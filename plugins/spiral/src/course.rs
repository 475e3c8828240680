//! The course to follow: preset points with stations and directions. They are checked once.

use planner_api::{Code, Config, Ctx, LogLevel, ParamSpec, PlanRequest, PlannerError, Result, Site, Task};
use std::{f64::consts::TAU, ops::Range};
use steering::{Keep, Room, solid_parts};
use world::{Point, Vector, geometry::wrap_angle_rad, polyline};

/// Largest distance between neighbouring points, metres: the step of the paper.
const SPACING_M: f64 = 0.2;
/// Maximum number of points of a course; longer courses are refused.
const MOST_POINTS: usize = 200_000;
/// Distance from the first point within which a start is on the course, metres.
const ON_COURSE_M: f64 = 1e-3;
/// Distance outside the floor that is attributed to rounding, metres.
const ROUNDING_M: f64 = 1e-6;
/// Distance below which turns of the path coincide, metres.
const LEAST_PITCH_M: f64 = 1e-3;

/// The points to follow, in order.
#[derive(Debug, Clone)]
pub(crate) struct Course {
    /// The points; the first one is the robot's position.
    pub points: Vec<Point>,
    /// Distance along the course to every point, metres.
    pub stations_m: Vec<f64>,
    /// The last point has been reached when the robot is within this distance of it, metres.
    pub tolerance_m: f64,
}

impl Course {
    /// Creates the course of a task, beginning at the robot.
    ///
    /// # Errors
    /// [`Code::Invalid`] if points are missing, not finite or too many, or if turns coincide.
    pub(crate) fn new(request: &PlanRequest<'_>) -> Result<Self> {
        let start = request.start.position;
        let (targets, tolerance_m) = match request.task {
            Task::Goto { goal, tolerance_m } => (vec![goal], tolerance_m),
            Task::Follow { targets, tolerance_m } => (targets.to_vec(), tolerance_m),
            Task::Cover { .. } => {
                let message = "this planner drives to points and along paths, but does not cover floors";
                return Err(PlannerError::new(Code::Unsupported, message));
            }
        };
        check_targets(&targets)?;
        if !start.x.is_finite() || !start.y.is_finite() {
            return Err(invalid("start coordinates must be finite numbers"));
        }
        let first = targets[0];
        let mut points = if (first - start).norm() > ON_COURSE_M { vec![start] } else { Vec::new() };
        points.extend(targets);
        let split = polyline::length_m(&points) / SPACING_M + points.len() as f64;
        if split > MOST_POINTS as f64 {
            let message = format!("the preset path has {split:.0} points; at most {MOST_POINTS} are allowed");
            return Err(invalid(message));
        }
        // This is slightly more than one step, so that rounding does not split gaps of exactly one step.
        let most_m = SPACING_M * (1.0 + 1e-6);
        let has_gaps = points.windows(2).any(|w| (w[1] - w[0]).norm() > most_m);
        let points = if has_gaps { polyline::resampled(&points, most_m) } else { points };
        let stations_m = polyline::stations_m(&points);
        Ok(Self { points, stations_m, tolerance_m })
    }

    /// Returns the index of the last point.
    pub(crate) fn last(&self) -> usize {
        self.points.len() - 1
    }

    /// Returns the unit vector along the course at a point.
    pub(crate) fn direction(&self, index: usize) -> Vector {
        let (before, after) = (index.saturating_sub(1), (index + 1).min(self.last()));
        (self.points[after] - self.points[before]).try_normalize(1e-12).unwrap_or_else(Vector::x)
    }

    /// Returns the unit vector from a point to the next one.
    pub(crate) fn leg(&self, index: usize) -> Vector {
        let from = index.min(self.last().saturating_sub(1));
        let along = self.points[(from + 1).min(self.last())] - self.points[from];
        along.try_normalize(1e-12).unwrap_or_else(Vector::x)
    }

    /// Returns how sharply the course itself turns at a point, radians per metre.
    pub(crate) fn turn_per_m(&self, index: usize) -> f64 {
        let before = self.leg(index.saturating_sub(1));
        let after = self.leg(index);
        let (first, end) = (index.saturating_sub(1), (index + 1).min(self.last()));
        let length_m = (self.stations_m[end] - self.stations_m[first]) / 2.0;
        before.perp(&after).atan2(before.dot(&after)).abs() / length_m.max(1e-9)
    }
}

/// Returns the space for the robot. The robot keeps `clearance_m` or the mission's clearance from obstacles, whichever
/// is larger. From the wall, it keeps the mission's clearance unless the course itself passes closer; the hull never
/// touches the wall.
///
/// # Errors
/// [`Code::Config`] when hull and clearance exceed the distance between the turns.
pub(crate) fn room(site: &Site<'_>, clearance_m: f64, course: &Course) -> Result<Room> {
    let hull_m = site.limits.radius_m;
    let obstacle_m = hull_m + site.clearance_m.max(clearance_m);
    check_pitch(obstacle_m, &course.points)?;
    let wall = site.boundary.to_owned();
    let nearest_m = course.points.iter().map(|p| wall.wall_distance_m(*p)).fold(f64::INFINITY, f64::min);
    let wall_m = (hull_m + site.clearance_m).min(nearest_m.max(hull_m));
    Ok(Room::new(site, Keep { obstacle_m, wall_m }))
}

/// Returns the distance between the first point and the point one full turn later, metres; `None` if the path turns
/// less than one and a half times around the centre.
fn pitch_m(points: &[Point]) -> Option<f64> {
    let mut turned_rad = 0.0_f64;
    let mut one_turn_on = None;
    for (index, pair) in points.windows(2).enumerate() {
        let bearing = |p: &Point| p.y.atan2(p.x);
        turned_rad += wrap_angle_rad(bearing(&pair[1]) - bearing(&pair[0]));
        if one_turn_on.is_none() && turned_rad.abs() >= TAU - 1e-9 {
            one_turn_on = Some(index + 1);
        }
        if turned_rad.abs() > 1.5 * TAU {
            return one_turn_on.map(|index| (points[0].coords.norm() - points[index].coords.norm()).abs());
        }
    }
    None
}

fn invalid(message: impl Into<String>) -> PlannerError {
    PlannerError::new(Code::Invalid, message)
}

/// Refuses a start outside the tank or with half of the hull in an obstacle. If the start is closer to something than
/// the clearance allows, logs that the path begins beside the start.
///
/// # Errors
/// [`Code::StartOutside`] or [`Code::StartOccupied`].
pub(crate) fn check_start(
    request: &PlanRequest<'_>,
    course: &Course,
    room: &Room,
    ctx: &Ctx<'_>,
) -> Result<()> {
    let (start, hull_m) = (request.start.position, request.site.limits.radius_m);
    let place = format!("the start ({:.2}, {:.2})", start.x, start.y);
    if room.wall().wall_distance_m(start) < -ROUNDING_M {
        return Err(PlannerError::new(Code::StartOutside, format!("{place} is outside the tank")));
    }
    // The estimated start may be slightly wrong, so it is refused only if half of the hull is inside an obstacle.
    let distances_m = solid_parts(request.site).map(|(_, part)| part.distance(start).0);
    let outline_m = distances_m.fold(f64::INFINITY, f64::min);
    if outline_m < hull_m / 2.0 || outline_m <= 0.0 {
        let message = format!("at {place}, the hull is {:.2} m inside an obstacle", hull_m - outline_m);
        return Err(PlannerError::new(Code::StartOccupied, message));
    }
    if room.spare_m(course.points[0]) < 0.0 {
        let message = format!(
            "{place} is closer to something solid than the clearance allows; the path begins beside the start"
        );
        ctx.log(LogLevel::Warn, &message);
    }
    Ok(())
}

/// Refuses preset points that are missing or not finite, and turns that coincide.
///
/// # Errors
/// [`Code::Invalid`].
pub(crate) fn check_targets(targets: &[Point]) -> Result<()> {
    if targets.is_empty() {
        return Err(invalid("there is no preset point to follow"));
    }
    if let Some(at) = targets.iter().position(|p| !p.x.is_finite() || !p.y.is_finite()) {
        return Err(invalid(format!("the coordinates of preset point {at} are not finite")));
    }
    if let Some(at) = targets.windows(2).position(|w| (w[1] - w[0]).norm() < 1e-9) {
        return Err(invalid(format!("preset points {at} and {} coincide; remove one of them", at + 1)));
    }
    if let Some(pitch_m) = pitch_m(targets).filter(|pitch_m| *pitch_m < LEAST_PITCH_M) {
        return Err(invalid(format!(
            "the turns of the preset path are only {pitch_m:.3} m apart; increase its pitch"
        )));
    }
    Ok(())
}

/// Refuses a hull and a clearance that together exceed the distance between the turns.
///
/// # Errors
/// [`Code::Config`].
pub(crate) fn check_pitch(keep_m: f64, points: &[Point]) -> Result<()> {
    let Some(pitch_m) = pitch_m(points).filter(|pitch_m| keep_m > *pitch_m) else { return Ok(()) };
    let message = format!(
        "hull and clearance need {keep_m:.2} m, but the turns of the preset path are {pitch_m:.2} m apart; \
         reduce the clearance or increase the pitch"
    );
    Err(PlannerError::new(Code::Config, message))
}

/// Refuses parameters that are negative or not finite.
///
/// # Errors
/// [`Code::Config`].
pub(crate) fn check_numbers(config: &Config<'_>, specs: &[ParamSpec]) -> Result<()> {
    let is_number = |value: f64| value.is_finite() && value >= 0.0;
    let Some(spec) = specs.iter().find(|spec| !is_number(config.float(spec.key))) else { return Ok(()) };
    let value = config.float(spec.key);
    Err(PlannerError::new(
        Code::Config,
        format!("{} is {value}; it must be a number of at least 0", spec.key),
    ))
}

/// Returns where a path along a course can begin: its first point, or the nearest free point around it.
pub(crate) fn nearest_free(course: &Course, room: &Room) -> Point {
    let start = course.points[0];
    places_about(start, 0..80).find(|place| room.spare_m(*place) >= 0.0).unwrap_or(start)
}

/// Returns points around a centre, nearest first, on rings that are 2.5 cm apart.
pub(crate) fn places_about(center: Point, rings: Range<u32>) -> impl Iterator<Item = Point> {
    rings.map(|k| f64::from(k) * 0.025).flat_map(move |radius_m| {
        let bearings = (0..48).map(|k| f64::from(k) * TAU / 48.0);
        bearings.map(move |a| center + Vector::new(a.cos(), a.sin()) * radius_m)
    })
}
