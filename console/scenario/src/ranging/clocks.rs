//! Reads the time of emission and the clocks of the stations.

use crate::{problem::Complaint, section::Section};
use mission::{Locating, OwnClocks};
use positioning::{SessionConfig, SolverKind, are_on_line, station_clocks};
use sim::Clocks;
use world::Station;

/// The least number of stations for a fix from differences: two for the position, one for the time of emission, one to
/// exclude mirror images.
const LEAST_STATIONS: usize = 4;
/// The least number of stations for a protection level from differences: the others must still give a fix without one.
const LEAST_PROTECTED: usize = 5;

/// The keys that describe the clocks of the stations.
const CLOCK_KEYS: [&str; 2] = ["clock_offset_sigma_m", "clock_drift_sigma_m_per_h"];

/// Reads the true times of emission and clocks.
pub(super) fn true_clocks(section: &Section<'_>) -> Option<Clocks> {
    // A word that is misspelt has its own message; the other keys are not judged by it.
    let emission_time = section.word("emission_time");
    let is_emission_unknown = emission_time == Some("unknown");
    let (offset_sigma_m, drift_sigma_m_per_h) =
        (section.number(CLOCK_KEYS[0]), section.number(CLOCK_KEYS[1]));
    if emission_time == Some("known") {
        section.refuse(&CLOCK_KEYS, "emission_time = \"known\"");
    }
    Some(Clocks {
        is_emission_unknown,
        offset_sigma_m: offset_sigma_m?,
        drift_sigma_m_per_h: drift_sigma_m_per_h?,
    })
}

/// The estimator's knowledge of the clocks; `None` if the stations share one clock.
pub(super) fn expected(clocks: Clocks) -> Option<OwnClocks> {
    let Clocks { offset_sigma_m, drift_sigma_m_per_h, .. } = clocks;
    let has_own = offset_sigma_m > 0.0 || drift_sigma_m_per_h > 0.0;
    has_own.then_some(OwnClocks { offset_sigma_m, drift_sigma_m_per_h })
}

/// Refuses what an unknown time of emission excludes: too few stations, stations on one line, and methods that need known
/// distances.
pub(super) fn check(section: &Section<'_>, stations: &[Station]) {
    let complain = |key: &str, must_be: String| section.complain(key, Complaint::OutOfRange(must_be));
    section.refuse(&["solver"], "emission_time = \"unknown\"");
    let n = stations.len();
    let has_own = CLOCK_KEYS.iter().any(|key| section.number(key).is_some_and(|sigma| sigma > 0.0));
    if n < LEAST_STATIONS {
        let why = "the position has two unknowns, the time of emission is a third, and one station excludes mirror images";
        complain("emission_time", format!("\"known\" with fewer than {LEAST_STATIONS} stations: {why}"));
    } else if are_on_line(stations) {
        let why = "every place has a mirror image with the same differences of arrival times";
        complain("emission_time", format!("\"known\" with all stations on one line: {why}"));
    } else if has_own && n < station_clocks::LEAST_STATIONS {
        let (least, why) = (station_clocks::LEAST_STATIONS, "with four, a wrong clock would not show");
        let key = CLOCK_KEYS.into_iter().find(|key| section.has(key)).unwrap_or(CLOCK_KEYS[0]);
        complain(key, format!("0 with fewer than {least} stations: {why}"));
    }
    if let Some("midrange" | "posterior") = section.word("aggregation") {
        let must_be = "\"mean\" or \"trimmed-mean\" with emission_time = \"unknown\"";
        complain("aggregation", must_be.into());
    }
    if section.flag("calibrate_sound_speed") == Some(true) {
        complain("calibrate_sound_speed", "false with emission_time = \"unknown\"".into());
    }
    if section.word("session_calibration").is_some_and(|model| model != "off") {
        check_session(n, has_own, complain);
    }
}

/// Refuses a session calibration that cannot tell a bias from an unknown clock, or that cannot test any station.
fn check_session(n: usize, has_own: bool, complain: impl Fn(&str, String)) {
    let least = SessionConfig::least_stations(true);
    if has_own {
        let why =
            "a bias of a station and the offset of its clock shift the same arrivals by the same length";
        let keys = format!("{} or {}", CLOCK_KEYS[0], CLOCK_KEYS[1]);
        complain("session_calibration", format!("\"off\" with {keys}: {why}"));
    } else if n < least {
        let why = "without one of them, the others give no fix";
        complain(
            "session_calibration",
            format!("\"off\" with fewer than {least} stations and emission_time = \"unknown\": {why}"),
        );
    }
}

/// Refuses a protection level for which the stations do not suffice if the time of emission is unknown.
pub(crate) fn check_protection(section: &Section<'_>, locating: &Locating, stations: &[Station]) {
    let n = stations.len();
    let is_short = (LEAST_STATIONS..LEAST_PROTECTED).contains(&n);
    if locating.solver == SolverKind::Differences && locating.risk.is_some() && is_short {
        let must_be = format!(
            "\"known\" with fewer than {LEAST_PROTECTED} stations and a protection level: without one of them, the \
             others give no fix"
        );
        section.complain("emission_time", Complaint::OutOfRange(must_be));
    }
}
