//! The robot and its ranging: `[robot]` and `[ae]`.

use super::{floor::Names, problem::Complaint, section::Section, suggest};
use planner_api::{Limits, Motion};
use sim::{AeConfig, BehindColumns, Disturbances, NoiseModel, StationFault};
use world::{Boundary, Point, Station, StationId};

/// A station may lie this far behind the wall: sensors sit on it, and drawings are rounded to centimetres.
const ON_WALL_M: f64 = 0.01;

/// `[robot]` as read; the start may still follow from the mission.
#[derive(Debug, Clone, PartialEq)]
pub struct Robot {
    /// What it can do.
    pub limits: Limits,
    /// Largest change of speed, metres per second squared.
    pub acceleration_m_per_s2: f64,
    /// Where it starts, if given.
    pub start: Option<Point>,
    /// Heading at the start, radians, if given.
    pub start_heading_rad: Option<f64>,
    /// Standard deviation of the surveyed start, metres.
    pub start_sigma_m: f64,
    /// Standard deviation of the surveyed heading at the start, radians.
    pub start_heading_sigma_rad: f64,
    /// Average share of the way lost to slip.
    pub slip_mean: f64,
    /// Its standard deviation from tick to tick.
    pub slip_sigma: f64,
    /// Standard deviation of odometry as a share of the way.
    pub odometry_sigma_ratio: f64,
    /// Constant error of the gyro, radians per second.
    pub gyro_bias_rad_per_s: f64,
}

impl Robot {
    /// Standard deviation of the way as a share of it that the estimator may expect: odometry's own error and slip
    /// together, never less than 2 %.
    pub fn odometry_sigma_per_m(&self) -> f64 {
        let squares = [self.odometry_sigma_ratio, self.slip_mean, self.slip_sigma].map(|share| share * share);
        squares.iter().sum::<f64>().sqrt().max(0.02)
    }

    /// Standard deviation of a turn as a share of it that the estimator may expect, never less than 1 %.
    pub fn turn_sigma_per_rad(&self) -> f64 {
        self.odometry_sigma_ratio.max(0.01)
    }

    /// Standard deviation of the heading's drift that the estimator may expect, radians per second, never less than
    /// a good gyro's 3 degrees a minute.
    pub fn gyro_sigma_rad_per_s(&self) -> f64 {
        self.gyro_bias_rad_per_s.abs().max(0.05_f64.to_radians())
    }
}

/// Reads `[robot]`.
pub fn robot(section: &Section<'_>) -> Option<Robot> {
    let motion =
        section.word("motion").map(|word| if word == "point" { Motion::Point } else { Motion::Unicycle });
    let radius_m = section.number("radius_m");
    if motion == Some(Motion::Unicycle) && radius_m == Some(0.0) {
        let must_be = "greater than 0 m; only motion = \"point\" has no hull";
        section.complain("radius_m", Complaint::OutOfRange(must_be.into()));
    }
    let speed = section.number("speed_max_m_per_s");
    let turn_deg = section.number("turn_max_deg_per_s");
    let sensing_range_m = section.number("sensing_range_m");
    let acceleration = section.number("acceleration_m_per_s2");
    let start = section.point("start_m");
    let heading_deg = section.number("start_heading_deg");
    let start_sigma_m = section.number("start_sigma_m");
    let start_heading_sigma_deg = section.number("start_heading_sigma_deg");
    let (slip_mean, slip_sigma) = (section.number("slip_mean"), section.number("slip_sigma"));
    let odometry_sigma_ratio = section.number("odometry_sigma_ratio");
    let gyro_bias_deg = section.number("gyro_bias_deg_per_s");
    Some(Robot {
        limits: Limits {
            motion: motion?,
            v_max_m_per_s: speed?,
            w_max_rad_per_s: turn_deg?.to_radians(),
            radius_m: radius_m?,
            sensing_range_m: sensing_range_m?,
        },
        acceleration_m_per_s2: acceleration?,
        start,
        start_heading_rad: heading_deg.map(f64::to_radians),
        start_sigma_m: start_sigma_m?,
        start_heading_sigma_rad: start_heading_sigma_deg?.to_radians(),
        slip_mean: slip_mean?,
        slip_sigma: slip_sigma?,
        odometry_sigma_ratio: odometry_sigma_ratio?,
        gyro_bias_rad_per_s: gyro_bias_deg?.to_radians(),
    })
}

/// Reads `[ae]` without its stations.
pub fn ae(section: &Section<'_>) -> Option<AeConfig> {
    let (period_s, repetitions) = (section.number("period_s"), section.whole("repetitions"));
    let (noise, dropout) = (noise(section), section.number("dropout"));
    let (outages_s, disturbances) = (section.times("outages_s"), disturbances(section));
    Some(AeConfig {
        period_s: period_s?,
        repetitions: repetitions? as u32,
        noise: noise?,
        dropout: dropout?,
        outages_s: outages_s?,
        disturbances: disturbances?,
    })
}

/// What goes wrong with ranges besides their scatter, but for the faults of single stations.
fn disturbances(section: &Section<'_>) -> Option<Disturbances> {
    let (ping_dropout, nlos_chance) = (section.number("ping_dropout"), section.number("nlos_chance"));
    let (outlier_chance, outlier_factor) =
        (section.number("outlier_chance"), section.number("outlier_factor"));
    let (late_ping_chance, late_mean_m) =
        (section.number("late_ping_chance"), section.number("late_mean_m"));
    let behind = section.word("behind_columns");
    let (survey, sound) = (section.number("survey_sigma_m"), section.number("sound_speed_error_ratio"));
    Some(Disturbances {
        ping_dropout: ping_dropout?,
        outlier_chance: outlier_chance?,
        outlier_factor: outlier_factor?,
        late_ping_chance: late_ping_chance?,
        nlos_chance: nlos_chance?,
        late_mean_m: late_mean_m?,
        behind_columns: match behind? {
            "creeping" => BehindColumns::Creeping,
            "late" => BehindColumns::Late,
            "wall-echo" => BehindColumns::WallEcho,
            "silent" => BehindColumns::Silent,
            _ => BehindColumns::Heard,
        },
        survey_sigma_m: survey?,
        sound_speed_error_ratio: sound?,
        faults: Vec::new(),
    })
}

/// Reads the faults of single stations.
pub fn faults(section: &Section<'_>, stations: &[Station]) -> Vec<StationFault> {
    section.tables("faults").iter().filter_map(|entry| fault(entry, stations)).collect()
}

fn fault(entry: &Section<'_>, stations: &[Station]) -> Option<StationFault> {
    let name = entry.text("station");
    let (from_s, to_s) = (entry.number("from_s"), entry.number("to_s"));
    let late_m = entry.number("late_m");
    let name = name?;
    let station = stations.iter().find(|station| station.name == name);
    if station.is_none() {
        let nearest = suggest::nearest(&name, stations.iter().map(|station| station.name.as_str()));
        let hint = nearest.map(|name| format!("; did you mean \"{name}\"?")).unwrap_or_default();
        entry.complain("station", Complaint::OutOfRange(format!("the name of a station{hint}")));
    }
    if from_s? >= to_s? {
        entry.complain("to_s", Complaint::OutOfRange(format!("greater than {} s, the beginning", from_s?)));
    }
    Some(StationFault { station: station?.id, from_s: from_s?, to_s: to_s?, late_m })
}

fn noise(section: &Section<'_>) -> Option<NoiseModel> {
    if !section.has("noise") {
        return Some(NoiseModel::Uniform { ratio: 0.05 });
    }
    let noise = section.table("noise")?;
    let model = noise.word("model")?;
    let beside = format!("model = \"{model}\"");
    match model {
        "uniform" | "triangular" => {
            noise.refuse(&["sigma_ratio"], &beside);
            noise.require("ratio", "add ratio = 0.05 for at most 5 % of the distance");
            let ratio = noise.number("ratio")?;
            let is_uniform = model == "uniform";
            Some(if is_uniform { NoiseModel::Uniform { ratio } } else { NoiseModel::Triangular { ratio } })
        }
        "gaussian" | "heavy-tailed" => {
            noise.refuse(&["ratio"], &beside);
            noise.require(
                "sigma_ratio",
                "add sigma_ratio = 0.03 for a standard deviation of 3 % of the distance",
            );
            let sigma_ratio = noise.number("sigma_ratio")?;
            let is_normal = model == "gaussian";
            Some(if is_normal {
                NoiseModel::Gaussian { sigma_ratio }
            } else {
                NoiseModel::HeavyTailed { sigma_ratio }
            })
        }
        _ => {
            noise.refuse(&["ratio", "sigma_ratio"], &beside);
            Some(NoiseModel::None)
        }
    }
}

/// Standard deviation of one range as a share of it, as the estimator may expect it; never quite zero.
pub fn range_sigma_ratio(noise: NoiseModel) -> f64 {
    const LEAST: f64 = 1e-3;
    match noise {
        NoiseModel::None => LEAST,
        NoiseModel::Uniform { ratio } => (ratio / 3.0_f64.sqrt()).max(LEAST),
        NoiseModel::Triangular { ratio } => (ratio / 6.0_f64.sqrt()).max(LEAST),
        NoiseModel::Gaussian { sigma_ratio } | NoiseModel::HeavyTailed { sigma_ratio } => sigma_ratio.max(LEAST),
    }
}

/// Reads the stations of `[ae]`.
pub fn stations(section: &Section<'_>, boundary: Option<&Boundary>) -> Vec<Station> {
    let mut names = Names::default();
    let mut stations: Vec<Station> = Vec::new();
    let sections = section.tables("stations");
    for (i, entry) in sections.iter().enumerate() {
        let (name, at) = (entry.text("name").and_then(|_| names.of(entry, String::new)), entry.point("at_m"));
        let Some(position) = at else { continue };
        if let Some(twin) = stations.iter().find(|other| (other.position - position).norm() < ON_WALL_M) {
            entry.complain("at_m", Complaint::Duplicate { other: format!("station \"{}\"", twin.name) });
        }
        let by_m = boundary.map_or(0.0, |boundary| -boundary.wall_distance_m(position));
        if by_m > ON_WALL_M {
            entry.complain("at_m", Complaint::OutsideTank { by_m });
        }
        stations.extend(name.map(|name| Station { id: StationId(i as u32 + 1), name, position }));
    }
    if section.has("stations") && sections.len() < 2 && section.is_list("stations") {
        section.complain("stations", Complaint::TooFewStations { have: sections.len() });
    }
    stations
}
