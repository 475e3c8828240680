//! Reads the robot: `[robot]`.

use super::{problem::Complaint, section::Section};
use planner_api::{Limits, Motion};
use world::{Amphibious, Pace, Point, PressureSensor, Scanner};

/// `[robot]` as read; the mission may still determine the start.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Robot {
    /// The limits of the robot, except for the length of a tick, which the mission sets.
    pub limits: Limits,
    /// The start position, if given.
    pub start: Option<Point>,
    /// The heading at the start in radians, if given.
    pub start_heading_rad: Option<f64>,
    /// The standard deviation of the surveyed start in metres.
    pub start_sigma_m: f64,
    /// The standard deviation of the surveyed heading at the start in radians.
    pub start_heading_sigma_rad: f64,
    /// The average share of the distance lost to slip.
    pub slip_mean: f64,
    /// The standard deviation of slip from tick to tick.
    pub slip_sigma: f64,
    /// The standard deviation of odometry errors, as a share of the distance.
    pub odometry_sigma_ratio: f64,
    /// The constant error of the gyro in radians per second.
    pub gyro_bias_rad_per_s: f64,
    /// The pressure sensor of an amphibious robot, if it has one.
    pub pressure: Option<PressureSensor>,
    /// The scanner, if it has one.
    pub scanner: Option<Scanner>,
    /// Whether its scans correct the estimated position.
    pub scanner_locates: bool,
}

impl Robot {
    /// The standard deviation that the estimator expects of a distance, as a share of the distance: the combined error
    /// of odometry and slip, at least 2 %.
    pub(crate) fn odometry_sigma_per_m(&self) -> f64 {
        let squares = [self.odometry_sigma_ratio, self.slip_mean, self.slip_sigma].map(|share| share * share);
        squares.iter().sum::<f64>().sqrt().max(0.02)
    }

    /// The standard deviation that the estimator expects of a turn, as a share of the turn; at least 1 %.
    pub(crate) fn turn_sigma_per_rad(&self) -> f64 {
        self.odometry_sigma_ratio.max(0.01)
    }

    /// The standard deviation of the heading's drift that the estimator expects, in radians per second; at least the
    /// drift of a good gyro, 3 degrees per minute.
    pub(crate) fn gyro_sigma_rad_per_s(&self) -> f64 {
        self.gyro_bias_rad_per_s.abs().max(0.05_f64.to_radians())
    }
}

/// Reads `[robot]`.
pub(crate) fn robot(section: &Section<'_>) -> Option<Robot> {
    let word = section.word("motion");
    let motion = word.map(|word| if word == "point" { Motion::Point } else { Motion::Unicycle });
    let radius_m = section.number("radius_m");
    if motion == Some(Motion::Unicycle) && radius_m == Some(0.0) {
        let must_be = "greater than 0 m; only a robot with motion = \"point\" has no hull";
        section.complain("radius_m", Complaint::OutOfRange(must_be.into()));
    }
    let amphibious = word.map(|word| amphibious(section, word));
    let one_pace = pace(section, ONE_PACE);
    let sensing_range_m = section.number("sensing_range_m");
    let acceleration = section.number("acceleration_m_per_s2");
    let start = section.point("start_m");
    let heading_deg = section.number("start_heading_deg");
    let start_sigma_m = section.number("start_sigma_m");
    let start_heading_sigma_deg = section.number("start_heading_sigma_deg");
    let (slip_mean, slip_sigma) = (section.number("slip_mean"), section.number("slip_sigma"));
    let odometry_sigma_ratio = section.number("odometry_sigma_ratio");
    let gyro_bias_deg = section.number("gyro_bias_deg_per_s");
    let scanner = match section.has("scanner").then(|| section.table("scanner")) {
        Some(section) => Some(scanner(&section?, radius_m?)?),
        None => None,
    };
    let amphibious = amphibious?;
    let pressure = if amphibious.is_some() { pressure(section) } else { None };
    // Planners get the faster of the two limits; the zones determine where the slower limit applies.
    let fastest = amphibious.map_or(one_pace?, |both| both.fastest());
    Some(Robot {
        limits: Limits {
            motion: motion?,
            v_max_m_per_s: fastest.v_max_m_per_s,
            w_max_rad_per_s: fastest.w_max_rad_per_s,
            radius_m: radius_m?,
            sensing_range_m: sensing_range_m?,
            acceleration_m_per_s2: acceleration?,
            // The mission sets the length of a tick.
            tick_s: 0.0,
            amphibious,
        },
        start,
        start_heading_rad: heading_deg.map(f64::to_radians),
        start_sigma_m: start_sigma_m?,
        start_heading_sigma_rad: start_heading_sigma_deg?.to_radians(),
        slip_mean: slip_mean?,
        slip_sigma: slip_sigma?,
        odometry_sigma_ratio: odometry_sigma_ratio?,
        gyro_bias_rad_per_s: gyro_bias_deg?.to_radians(),
        pressure,
        scanner: scanner.map(|(scanner, _)| scanner),
        scanner_locates: scanner.is_some_and(|(_, locates)| locates),
    })
}

/// Reads `[robot.scanner]`, for a hull of the given radius: the scanner, and whether its scans correct the position.
fn scanner(section: &Section<'_>, radius_m: f64) -> Option<(Scanner, bool)> {
    let rays = section.whole("rays");
    let field_of_view_deg = section.number("field_of_view_deg");
    let (range_m, rate_hz) = (section.number("range_m"), section.number("rate_hz"));
    let (sigma_m, lost_share) = (section.number("sigma_m"), section.number("lost_share"));
    let heading_deg = section.number("heading_deg");
    let locates = section.flag("locates");
    let offset_m = if section.has("offset_m") { section.pair("offset_m") } else { Some([0.0, 0.0]) };
    if let Some([x, y]) = offset_m
        && x.hypot(y) > radius_m
    {
        let must_be = format!("within the hull, at most {radius_m} m from its centre");
        section.complain("offset_m", Complaint::OutOfRange(must_be));
        return None;
    }
    if range_m? <= radius_m {
        let must_be = format!("greater than the radius of the hull, {radius_m} m");
        section.complain("range_m", Complaint::OutOfRange(must_be));
        return None;
    }
    let scanner = Scanner {
        rays: rays? as u32,
        field_of_view_rad: field_of_view_deg?.to_radians(),
        range_m: range_m?,
        rate_hz: rate_hz?,
        sigma_m: sigma_m?,
        lost_share: lost_share?,
        offset_m: offset_m?,
        heading_rad: heading_deg?.to_radians(),
    };
    Some((scanner, locates?))
}

/// The keys of the limits that apply everywhere, and of the limits that depend on the zone.
const ONE_PACE: [&str; 2] = ["speed_max_m_per_s", "turn_rate_max_deg_per_s"];
const ON_LAND: [&str; 2] = ["land_speed_max_m_per_s", "land_turn_rate_max_deg_per_s"];
const PRESSURE: [&str; 2] = ["pressure_sigma_pa", "pressure_depth_m"];
const UNDERWATER: [&str; 2] = ["underwater_speed_max_m_per_s", "underwater_turn_rate_max_deg_per_s"];

/// The limits on land and under water, for an amphibious robot; for other robots the keys are refused.
fn amphibious(section: &Section<'_>, motion: &str) -> Option<Amphibious> {
    let beside = format!("motion = \"{motion}\"");
    if motion != "amphibious" {
        section.refuse(&ON_LAND, &beside);
        section.refuse(&UNDERWATER, &beside);
        section.refuse(&["transition_ticks"], &beside);
        section.refuse(&PRESSURE, &beside);
        return None;
    }
    section.refuse(&ONE_PACE, &beside);
    let (land, underwater) = (pace(section, ON_LAND), pace(section, UNDERWATER));
    let transition_steps = section.whole("transition_ticks")? as u32;
    Some(Amphibious { land: land?, underwater: underwater?, transition_steps })
}

/// The pressure sensor, if any.
fn pressure(section: &Section<'_>) -> Option<PressureSensor> {
    let depth_m = section.number("pressure_depth_m");
    if !section.has("pressure_sigma_pa") {
        section.refuse(&["pressure_depth_m"], "pressure_sigma_pa missing");
        return None;
    }
    let sigma_pa = section.number("pressure_sigma_pa");
    Some(PressureSensor { depth_m: depth_m?, sigma_pa: sigma_pa? })
}

fn pace(section: &Section<'_>, keys: [&'static str; 2]) -> Option<Pace> {
    let (speed, turn_deg) = (section.number(keys[0]), section.number(keys[1]));
    Some(Pace { v_max_m_per_s: speed?, w_max_rad_per_s: turn_deg?.to_radians() })
}
