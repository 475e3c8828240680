//! Reads acoustic-emission ranging: `[ae]`.

mod clocks;

pub(crate) use clocks::check_protection;

use super::{floor::Names, problem::Complaint, section::Section};
use mission::{Locating, spelling::nearest};
use positioning::{Aggregation, OnBias, RangeNoise, Risk, SessionConfig, SolverKind, SoundSpeed, Timing};
use sim::{AeConfig, BehindColumns, Disturbances, NoiseModel, StationFault, TimingErrors};
use world::{Boundary, Station, StationId};

/// The largest distance in metres by which a station may be outside the wall: sensors are mounted on the wall, and
/// drawings are rounded to centimetres.
const ON_WALL_M: f64 = 0.01;

/// Reads `[ae]` except for its stations.
pub(crate) fn ae(section: &Section<'_>) -> Option<AeConfig> {
    let (period_s, repetitions) = (section.number("period_s"), section.whole("repetitions"));
    let (noise, timing, clocks) = (noise(section), timing(section), clocks::true_clocks(section));
    let dropout_probability = section.number("dropout_probability");
    let (outages_s, disturbances) = (section.times("outages_s"), disturbances(section));
    let pulse_rest_s = section.has("pulse_rest_s").then(|| section.number("pulse_rest_s"));
    Some(AeConfig {
        period_s: period_s?,
        repetitions: repetitions? as u32,
        noise: noise?,
        timing: timing?,
        clocks: clocks?,
        pulse_rest_s: match pulse_rest_s {
            Some(rest_s) => Some(rest_s?),
            None => None,
        },
        dropout_probability: dropout_probability?,
        outages_s: outages_s?,
        disturbances: disturbances?,
    })
}

/// The estimator's settings for ranging. The estimator uses the stated scatter, but has no information about faults.
pub(crate) fn locating(section: &Section<'_>, ae: &AeConfig, stations: &[Station]) -> Option<Locating> {
    let (solver, aggregation) = (section.word("solver"), section.word("aggregation"));
    let calibrate_sound_speed = section.flag("calibrate_sound_speed");
    let noise = match ae.noise {
        NoiseModel::None => None,
        NoiseModel::Uniform { ratio } => Some(RangeNoise::Uniform { ratio }),
        NoiseModel::Triangular { ratio } => Some(RangeNoise::Triangular { ratio }),
        NoiseModel::Gaussian { sigma_ratio } => Some(RangeNoise::Gaussian { sigma_ratio }),
        NoiseModel::HeavyTailed { sigma_ratio } => Some(RangeNoise::HeavyTailed { sigma_ratio }),
    };
    if solver == Some("bounded") && noise.is_none_or(|noise| noise.bound_ratio().is_none()) {
        let must_be = "a different solver: only uniform and triangular noise have bounds";
        section.complain("solver", Complaint::OutOfRange(must_be.into()));
    }
    let TimingErrors { jitter_m, resolution_m } = ae.timing;
    if !ae.timing.is_none() {
        refuse_beside_timing(section, solver, aggregation);
    }
    if ae.clocks.is_emission_unknown {
        clocks::check(section, stations);
    }
    let behind = ae.disturbances.behind_columns;
    Some(Locating {
        noise,
        timing: Timing { jitter_m, resolution_m },
        scale_sigma_ratio: 0.0,
        aggregation: match aggregation? {
            "midrange" => Aggregation::Midrange,
            "trimmed-mean" => Aggregation::TrimmedMean,
            "posterior" => Aggregation::Posterior,
            _ => Aggregation::Mean,
        },
        solver: match solver? {
            _ if ae.clocks.is_emission_unknown => SolverKind::Differences,
            "linear" => SolverKind::Linear,
            "weighted-linear" => SolverKind::WeightedLinear,
            "bounded" => SolverKind::Bounded,
            "consensus" => SolverKind::Consensus,
            _ => SolverKind::Nls,
        },
        calibrate_sound_speed: calibrate_sound_speed?,
        risk: risk(section),
        session: session(section, calibrate_sound_speed?, stations.len()),
        clocks: clocks::expected(ae.clocks),
        pulse_rest_s: ae.pulse_rest_s,
        repetitions: ae.repetitions,
        needs_line_of_sight: !matches!(behind, BehindColumns::Heard | BehindColumns::Creeping),
    })
}

/// The risk for protection levels; `None` if the section states none.
fn risk(section: &Section<'_>) -> Option<Risk> {
    let stated = |key: &str| section.has(key).then(|| section.number(key)).flatten();
    let (risk, faults) = (stated("integrity_risk"), stated("station_faults_per_hour"));
    let default = Risk::default();
    (risk.is_some() || faults.is_some()).then(|| Risk {
        integrity_risk: risk.unwrap_or(default.integrity_risk),
        station_faults_per_hour: faults.unwrap_or(default.station_faults_per_hour),
    })
}

/// The calibration from the last fixes; `None` if it is off, or if a key is wrong.
fn session(section: &Section<'_>, calibrates_scale: bool, n_stations: usize) -> Option<SessionConfig> {
    let (model, on_bias) = (section.word("session_calibration"), section.word("biased_station"));
    let fixes = section.whole("session_fixes")?;
    let on_bias = if on_bias? == "correct" { OnBias::Correct } else { OnBias::Exclude };
    let sound_speed = match model? {
        "constant" => SoundSpeed::Constant,
        "linear" => SoundSpeed::Linear,
        _ => {
            section.refuse(&["session_fixes", "biased_station"], "session_calibration = \"off\"");
            return None;
        }
    };
    let least = SessionConfig::least_stations(false);
    if n_stations < least {
        let must_be = format!("\"off\" with fewer than {least} stations: none of them could be tested");
        section.complain("session_calibration", Complaint::OutOfRange(must_be));
    }
    if calibrates_scale {
        let must_be = "false: session_calibration also estimates the speed of sound";
        section.complain("calibrate_sound_speed", Complaint::OutOfRange(must_be.into()));
    }
    Some(SessionConfig { sound_speed, on_bias, fixes: fixes as usize })
}

/// Refuses methods that assume noise proportional to distance if the times also have errors.
fn refuse_beside_timing(section: &Section<'_>, solver: Option<&str>, aggregation: Option<&str>) {
    if solver == Some("bounded") {
        let must_be = "a different solver: noise.jitter_m and noise.resolution_m make the noise unbounded";
        section.complain("solver", Complaint::OutOfRange(must_be.into()));
    }
    if let Some("midrange" | "posterior") = aggregation {
        let must_be = "\"mean\" or \"trimmed-mean\" if noise.jitter_m or noise.resolution_m is set";
        section.complain("aggregation", Complaint::OutOfRange(must_be.into()));
    }
}

/// Reads the errors of the times from which ranges are computed.
fn timing(section: &Section<'_>) -> Option<TimingErrors> {
    if !section.has("noise") {
        return Some(TimingErrors::default());
    }
    let noise = section.table("noise")?;
    let (jitter_m, resolution_m) = (noise.number("jitter_m"), noise.number("resolution_m"));
    Some(TimingErrors { jitter_m: jitter_m?, resolution_m: resolution_m? })
}

/// Reads the disturbances of ranges other than scatter, except for faults of single stations.
fn disturbances(section: &Section<'_>) -> Option<Disturbances> {
    let (ping_dropout_probability, nlos_probability) =
        (section.number("ping_dropout_probability"), section.number("nlos_probability"));
    let (outlier_probability, outlier_factor) =
        (section.number("outlier_probability"), section.number("outlier_factor"));
    let (late_ping_probability, excess_range_mean_m) =
        (section.number("late_ping_probability"), section.number("excess_range_mean_m"));
    let behind = section.word("behind_columns");
    let (survey, sound) = (section.number("survey_sigma_m"), section.number("sound_speed_error_ratio"));
    Some(Disturbances {
        ping_dropout_probability: ping_dropout_probability?,
        outlier_probability: outlier_probability?,
        outlier_factor: outlier_factor?,
        late_ping_probability: late_ping_probability?,
        nlos_probability: nlos_probability?,
        excess_range_mean_m: excess_range_mean_m?,
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
pub(crate) fn faults(section: &Section<'_>, stations: &[Station]) -> Vec<StationFault> {
    section.tables("faults").iter().filter_map(|entry| fault(entry, stations)).collect()
}

fn fault(entry: &Section<'_>, stations: &[Station]) -> Option<StationFault> {
    let name = entry.text("station");
    let (from_s, to_s) = (entry.number("from_s"), entry.number("to_s"));
    let excess_range_m = entry.number("excess_range_m");
    let name = name?;
    let station = stations.iter().find(|station| station.name == name);
    if station.is_none() {
        let nearest = nearest(&name, stations.iter().map(|station| station.name.as_str()));
        let hint = nearest.map(|name| format!("; did you mean \"{name}\"?")).unwrap_or_default();
        entry.complain("station", Complaint::OutOfRange(format!("the name of a station{hint}")));
    }
    if from_s? >= to_s? {
        entry.complain("to_s", Complaint::OutOfRange(format!("greater than from_s, {} s", from_s?)));
    }
    Some(StationFault { station: station?.id, from_s: from_s?, to_s: to_s?, excess_range_m })
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
            noise.require("ratio", "add ratio = 0.05 for errors of at most 5 % of the distance");
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

/// The standard deviation of a range that the estimator expects, as a share of the range; never zero.
pub(crate) fn range_sigma_ratio(noise: NoiseModel) -> f64 {
    const LEAST: f64 = 1e-3;
    match noise {
        NoiseModel::None => LEAST,
        NoiseModel::Uniform { ratio } => (ratio / 3.0_f64.sqrt()).max(LEAST),
        NoiseModel::Triangular { ratio } => (ratio / 6.0_f64.sqrt()).max(LEAST),
        NoiseModel::Gaussian { sigma_ratio } | NoiseModel::HeavyTailed { sigma_ratio } => {
            sigma_ratio.max(LEAST)
        }
    }
}

/// Reads the stations of `[ae]`.
pub(crate) fn stations(section: &Section<'_>, boundary: Option<&Boundary>) -> Vec<Station> {
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
