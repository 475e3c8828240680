//! Checks that the sections fit together: start, goal, and the sizes of the grid and of the run.

use super::{problem::Complaint, section::Section};
use world::{Boundary, Floor, Obstacle, Point, PressureSensor, Zone, ZoneKind};

/// The largest number of cells of a coverage grid.
pub(crate) const MOST_CELLS: f64 = Floor::MOST_CELLS as f64;

/// The largest number of parallel lanes on a floor.
pub(crate) const MOST_LANES: f64 = 600.0;

/// The largest number of ticks of a run.
pub(crate) const MOST_TICKS: f64 = 1e7;

/// Slack for rounded numbers in files, in metres.
pub(crate) const ROUNDING_M: f64 = 1e-6;

/// The clearance in millimetres that a robot needs at its start. The robot keeps this far from obstacles that it
/// senses. With a smaller clearance, a small position error would put an obstacle within this distance. The mission
/// could then not tell whether the robot moves off or collides.
const START_ROOM_MM: f64 = 10.0;

/// The longest time in seconds that a robot may need, on average, to detect its medium.
const LONGEST_WAIT_S: f64 = 10.0;

/// Everything that a robot of a given radius could collide with.
pub(crate) struct Site<'a> {
    /// The wall.
    pub boundary: &'a Boundary,
    /// Obstacles, known or not.
    pub obstacles: &'a [Obstacle],
    /// The zones.
    pub zones: &'a [Zone],
    /// The radius of the hull in metres.
    pub radius_m: f64,
}

impl Site<'_> {
    /// The reason why the robot cannot be at a point, if any.
    pub(crate) fn objection(&self, place: Point) -> Option<Complaint> {
        self.wall(place).or_else(|| self.obstacle(place)).or_else(|| self.no_go(place))
    }

    /// The reason why the robot cannot start at a point that is otherwise possible, if any.
    pub(crate) fn objection_to_start(&self, place: Point) -> Option<Complaint> {
        let wall = ("the wall".to_owned(), self.boundary.wall_distance_m(place));
        let obstacle = |obstacle: &Obstacle| {
            (format!("obstacle \"{}\"", obstacle.name), obstacle.shape.distance_m(place))
        };
        let all = std::iter::once(wall).chain(self.obstacles.iter().map(obstacle));
        let (what, distance_m) = all.min_by(|one, other| one.1.total_cmp(&other.1))?;
        let room_mm = (distance_m - self.radius_m).max(0.0) * 1e3;
        (room_mm < START_ROOM_MM).then_some(Complaint::NoRoomToStart {
            what,
            room_mm,
            needed_mm: START_ROOM_MM,
        })
    }

    fn wall(&self, place: Point) -> Option<Complaint> {
        let distance_m = self.boundary.wall_distance_m(place);
        let by_m = self.radius_m - distance_m;
        if distance_m < -ROUNDING_M {
            Some(Complaint::OutsideTank { by_m: -distance_m })
        } else if by_m > ROUNDING_M {
            Some(Complaint::InWall { by_m, radius_m: self.radius_m })
        } else {
            None
        }
    }

    fn obstacle(&self, place: Point) -> Option<Complaint> {
        let distances = self.obstacles.iter().map(|obstacle| (obstacle.shape.distance_m(place), obstacle));
        let (distance_m, nearest) = distances.min_by(|a, b| a.0.total_cmp(&b.0))?;
        let (name, by_m) = (nearest.name.clone(), self.radius_m - distance_m);
        if distance_m < -ROUNDING_M {
            Some(Complaint::InObstacle { name })
        } else if by_m > ROUNDING_M {
            Some(Complaint::HullInObstacle { name, by_m, radius_m: self.radius_m })
        } else {
            None
        }
    }

    fn no_go(&self, place: Point) -> Option<Complaint> {
        let forbids = |zone: &&Zone| zone.kind == ZoneKind::NoGo && zone.shape.distance_m(place) < 0.0;
        self.zones.iter().find(forbids).map(|zone| Complaint::InNoGo { name: zone.name.clone() })
    }
}

/// Complains about a position limit, in metres, that no position in the tank can exceed.
pub(crate) fn check_position_limit(mission: &Section<'_>, boundary: &Boundary, limit_m: f64) {
    let (low, high) = boundary.bounds();
    let most_m = (high - low).min() / 2.0;
    if limit_m > most_m {
        mission.complain("position_limit_m", Complaint::LimitOfTank { limit_m, most_m });
    }
}

/// Complains about a pressure sensor that scatters so widely that the robot would wait too long at the start.
pub(crate) fn check_pressure(robot: &Section<'_>, tick_s: f64, sensor: Option<PressureSensor>) {
    let Some(sensor) = sensor else { return };
    // One reading is always allowed, however long a tick is.
    let most = (LONGEST_WAIT_S / tick_s).max(1.0);
    if sensor.readings_to_decide() > most {
        // Round down, so that the suggested number is accepted.
        let most_pa = (PressureSensor::largest_sigma_pa(sensor.depth_m, most) * 1e3).floor() / 1e3;
        let must_be = format!(
            "at most {most_pa} Pa at pressure_depth_m = {}: otherwise the robot would wait over \
             {LONGEST_WAIT_S} s for conclusive readings",
            sensor.depth_m
        );
        robot.complain("pressure_sigma_pa", Complaint::OutOfRange(must_be));
    }
}

/// The edge of a cell of the coverage grid in metres; complains about too many cells. A mission to a goal needs no fine
/// grid, so its cells are larger if the floor is too large for the default size.
pub(crate) fn cell_m(mission: &Section<'_>, boundary: Option<&Boundary>) -> Option<f64> {
    let cell_m = mission.number("cell_m")?;
    let Some((low, high)) = boundary.map(Boundary::bounds) else { return Some(cell_m) };
    let size = high - low;
    let cells = (size.x / cell_m).ceil() * (size.y / cell_m).ceil();
    if cells <= MOST_CELLS {
        return Some(cell_m);
    }
    // Round up to millimetres, with a reserve for cells cut at the edges.
    let fits_m = ((size.x * size.y / MOST_CELLS).sqrt() * 1010.0).ceil() / 1000.0;
    if !mission.has("cell_m") && matches!(mission.word("kind"), Some("goto" | "survey")) {
        return Some(fits_m);
    }
    let what = Complaint::TooManyCells { cells: cells as u64, limit: MOST_CELLS as u64, fits_m };
    mission.complain("cell_m", what);
    None
}

/// Complains if the swath, less the overlap, is so narrow that the floor would need too many lanes.
pub(crate) fn check_lanes(mission: &Section<'_>, boundary: &Boundary, swath_m: f64, overlap_m: f64) {
    let (low, high) = boundary.bounds();
    let across_m = (high - low).min();
    let lanes = across_m / (swath_m - overlap_m);
    if lanes > MOST_LANES {
        // Round up to millimetres, so that the suggested number is accepted.
        let fits_m = ((across_m / MOST_LANES + overlap_m) * 1000.0).ceil() / 1000.0;
        let of = if overlap_m > 0.0 { format!(" with overlap_m = {overlap_m}") } else { String::new() };
        let must_be = format!(
            "at least {fits_m} m{of}, for at most {MOST_LANES} parallel lanes (now {})",
            lanes as u64
        );
        mission.complain("swath_m", Complaint::OutOfRange(must_be));
    }
}

/// Complains about a run with too many ticks, or with less than one tick.
pub(crate) fn check_ticks(mission: &Section<'_>, tick_s: f64, time_limit_s: f64) {
    let ticks = time_limit_s / tick_s;
    if ticks > MOST_TICKS {
        let what = Complaint::TooManyTicks { ticks: ticks as u64, tick_s, limit: MOST_TICKS as u64 };
        mission.complain("time_limit_s", what);
    } else if ticks < 1.0 {
        mission.complain("time_limit_s", at_least_a_tick(tick_s));
    }
}

/// Complains about ranging more often than once per tick.
pub(crate) fn check_period(ae: &Section<'_>, tick_s: f64, period_s: f64) {
    if period_s < tick_s {
        ae.complain("period_s", at_least_a_tick(tick_s));
    }
}

fn at_least_a_tick(tick_s: f64) -> Complaint {
    Complaint::OutOfRange(format!("at least one tick, {tick_s} s"))
}
