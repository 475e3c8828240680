//! How well the stations check each other: per place, over the planned session, and with one more station.

use mission::{Guarantee, MissionConfig};
use positioning::{
    AccuracyMap, Checks, Forecast, OneMore, Risk, SessionChecks, Unprotected,
    accuracy::checks::{Floor, NOT_SEPARABLE},
    are_on_line,
};
use serde::Serialize;
use std::fmt::Write;
use world::{ObstacleMap, Point, Station, World, polyline};

/// Distance between the places of a session that are taken from a path, metres.
const SESSION_STEP_M: f64 = 0.1;

/// Maximum number of listed places.
const MOST_DOUBTFUL: usize = 6;

/// How well the stations check each other, over the floor and over a session.
#[derive(Debug, Serialize)]
pub struct CheckReport {
    /// The risk for which levels are computed.
    risk: Risk,
    /// Whether the scenario states this risk; if not, it is the default.
    is_stated: bool,
    /// Why no place is protected; absent if a place is protected, or if the reason differs from place to place.
    #[serde(skip_serializing_if = "Option::is_none")]
    unprotected: Option<Unprotected>,
    /// Whether the stations have clocks of their own: the figures assume one clock.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    own_clocks: bool,
    /// Protection level of a fix in the middle of all places, metres; absent if half of the floor is not protected.
    median_level_m: Option<f64>,
    /// Protection level that 95 % of the floor does not exceed, metres; absent if more than 5 % is not protected.
    p95_level_m: Option<f64>,
    /// Share of the floor where a fix is not protected.
    unprotected_share: f64,
    /// Least detectable error of the worst station, with one fix at the median place, metres.
    median_detectable_m: Option<f64>,
    /// Share of the floor where one fix cannot tell a wrong station from a wrong speed of sound.
    not_separable_share: f64,
    /// Places without a level, and places where one fix cannot tell the two errors apart; the worst first.
    doubtful: Vec<Doubtful>,
    /// Whether the places of the session are those of the planned path; if not, they are spread over the floor.
    session_is_planned: bool,
    session: Option<SessionChecks>,
    /// The effect of one more station; absent if no place for it protects any floor.
    one_more: Option<OneMore>,
}

/// A place where the stations check each other badly.
#[derive(Debug, Serialize)]
struct Doubtful {
    at: Point,
    /// Absent without a fix.
    checks: Option<Checks>,
}

impl Doubtful {
    /// Larger is worse: first the correlation, and within it the level.
    fn badness(&self) -> (f64, f64) {
        let Some(checks) = self.checks else { return (f64::INFINITY, f64::INFINITY) };
        (checks.correlation, checks.level_m.unwrap_or(f64::INFINITY))
    }

    fn line(&self) -> String {
        let Self { at, checks } = self;
        let place = format!("  at {:6.2}, {:6.2} m", at.x, at.y);
        let Some(checks) = checks else { return format!("{place}  no fix") };
        let level = checks.level_m.map_or("not protected".into(), |m| format!("level {m:.3} m"));
        let least = metres(checks.detectable_m);
        let separable = if checks.is_separable() { "separable" } else { "not separable" };
        format!(
            "{place}  {level:13}  least error {least:7}  correlation {:.2}, {separable}",
            checks.correlation
        )
    }
}

/// The reason why no place can be protected; `None` if the stations allow levels.
fn why_unprotected(risk: &Risk, stations: &[Station]) -> Option<Unprotected> {
    if are_on_line(stations) {
        return Some(Unprotected::OnOneLine);
    }
    risk.multipliers(stations.len(), false).is_none().then_some(Unprotected::TooRisky)
}

/// Warns if the fault rate of the scenario makes every protection level impossible.
pub fn risk_warning(mission: &MissionConfig, drawing: &World) -> Option<String> {
    let risk = mission.locating.risk?;
    let stations = drawing.stations.len();
    if stations < 2 || risk.multipliers(stations, false).is_some() {
        return None;
    }
    let floor = match mission.scan.guarantee {
        Guarantee::Protection => ", so no floor will be guaranteed (mission.guarantee = \"protection\")",
        Guarantee::Ellipse => "",
    };
    Some(format!(
        "no position will be protected{floor}: with {} faults per station and hour (ae.station_faults_per_hour) and \
         {stations} stations, {} ({:e}, ae.integrity_risk); lower the rate of faults if you have evidence for it, or \
         accept a larger risk",
        risk.station_faults_per_hour,
        Unprotected::TooRisky,
        risk.integrity_risk
    ))
}

fn metres(length: Option<f64>) -> String {
    length.map_or("none".into(), |m| format!("{m:.3} m"))
}

impl CheckReport {
    /// Evaluates a map that contains the checks (see [`AccuracyMap::with_checks`]). `path` is the planned path of the
    /// robot, metres; without one, the session is spread over the floor.
    pub fn new(
        mission: &MissionConfig,
        drawing: &World,
        (map, forecast): (&AccuracyMap, &Forecast),
        path: Option<&[Point]>,
    ) -> Self {
        let risk = mission.locating.risk.unwrap_or_default();
        let known: Vec<Checks> = map.floor().filter_map(|(_, cell)| cell.checks).collect();
        let floor = Floor::new(&known, map.floor().count());
        let mut detectable_m: Vec<f64> = known.iter().filter_map(|checks| checks.detectable_m).collect();
        detectable_m.sort_by(f64::total_cmp);
        let is_doubtful =
            |checks: Option<Checks>| checks.is_none_or(|c| !c.is_separable() || c.level_m.is_none());
        let cells = map.floor().map(|(at, cell)| Doubtful { at, checks: cell.checks });
        let mut doubtful: Vec<Doubtful> = cells.filter(|place| is_doubtful(place.checks)).collect();
        doubtful.sort_by(|a, b| {
            let ((a_first, a_then), (b_first, b_then)) = (a.badness(), b.badness());
            b_first.total_cmp(&a_first).then(b_then.total_cmp(&a_then))
        });
        let places = path.map_or_else(
            || map.floor().map(|(at, _)| at).collect::<Vec<_>>(),
            |path| polyline::resampled(path, SESSION_STEP_M),
        );
        let obstacles = ObstacleMap::new(&drawing.boundary, &drawing.obstacles);
        Self {
            risk,
            is_stated: mission.locating.risk.is_some(),
            unprotected: why_unprotected(&risk, &drawing.stations).filter(|_| floor.p95_level_m().is_none()),
            own_clocks: mission.locating.clocks.is_some(),
            median_level_m: floor.median_level_m(),
            p95_level_m: floor.p95_level_m(),
            unprotected_share: floor.unprotected_share(),
            median_detectable_m: detectable_m.get(detectable_m.len() / 2).copied(),
            not_separable_share: floor.not_separable_share,
            doubtful,
            session_is_planned: path.is_some(),
            session: forecast.session_checks(&places, &drawing.stations, &obstacles),
            one_more: forecast.one_more(drawing, &risk),
        }
    }

    /// The lines of the report for people.
    pub(super) fn human(&self, cell_m: f64) -> String {
        let mut text = String::new();
        let percent = |share: f64| share * 100.0;
        let stated = if self.is_stated { "" } else { "; defaults, the scenario states no risk" };
        // Writing to a String cannot fail.
        let _ = writeln!(
            text,
            "How well the stations check each other (risk {:e} per position, {:e} faults per station and hour{stated})",
            self.risk.integrity_risk, self.risk.station_faults_per_hour
        );
        let _ = writeln!(
            text,
            "level     median {}, 95 % of the floor {}; {:.1} % of the floor is not protected{}",
            metres(self.median_level_m),
            metres(self.p95_level_m),
            percent(self.unprotected_share),
            self.unprotected.map_or_else(String::new, |why| format!(": {why}"))
        );
        if self.own_clocks {
            let _ = writeln!(
                text,
                "clocks    the stations have clocks of their own, but this forecast assumes one clock: a mission states a \
                 level only for the pose, and calibrates no session"
            );
        }
        let _ = writeln!(
            text,
            "one fix   least detectable error of a station: median {}; on {:.1} % of the floor, a wrong station and a \
             wrong speed of sound are not separable (correlation above {NOT_SEPARABLE})",
            metres(self.median_detectable_m),
            percent(self.not_separable_share)
        );
        for place in self.doubtful.iter().take(MOST_DOUBTFUL) {
            let _ = writeln!(text, "{}", place.line());
        }
        let rest = self.doubtful.len().saturating_sub(MOST_DOUBTFUL);
        if rest > 0 {
            let _ = writeln!(text, "  and {rest} more cells of {cell_m:.2} m");
        }
        let _ = writeln!(text, "session   {}", self.session_line());
        let _ = writeln!(text, "one more  {}", self.one_more_line());
        text
    }

    fn session_line(&self) -> String {
        let along = if self.session_is_planned { "along the planned path" } else { "spread over the floor" };
        let Some(session) = self.session else { return format!("no fix {along}") };
        let separable = if session.is_separable { "separable" } else { "not separable" };
        format!(
            "{} fixes {along}: {separable} (correlation {:.2}), least detectable error {} with an unknown speed of sound",
            session.fixes,
            session.correlation,
            metres(session.detectable_m)
        )
    }

    fn one_more_line(&self) -> String {
        let Some(more) = self.one_more else {
            return "no place for one more station protects any floor".into();
        };
        format!(
            "at_m = [{:.3}, {:.3}]: level of 95 % of the floor {} instead of {}; not separable on {:.1} % instead of \
             {:.1} %",
            more.at.x,
            more.at.y,
            metres(more.p95_level_m),
            metres(self.p95_level_m),
            more.not_separable_share * 100.0,
            self.not_separable_share * 100.0
        )
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;
    use crate::samples::round_tank;
    use account::estimate::forecast;
    use mission::OwnClocks;
    use world::StationId;

    /// A mission in a round tank with eight stations on the shell.
    fn with_faults_per_hour(station_faults_per_hour: f64) -> (MissionConfig, World) {
        let run = round_tank(0.1);
        let (mut mission, mut world) = (run.mission, run.world);
        mission.locating.risk = Some(Risk { station_faults_per_hour, ..Risk::default() });
        let at = |k: u32| {
            let angle = f64::from(k) * std::f64::consts::TAU / 8.0;
            Point::new(5.0 * angle.cos(), 5.0 * angle.sin())
        };
        let station = |k| Station { id: StationId(k), name: format!("S{k}"), position: at(k) };
        world.stations = (1..=8).map(station).collect();
        (mission, world)
    }

    fn said(mission: &MissionConfig, world: &World) -> String {
        let forecast = forecast(mission, world);
        let risk = mission.locating.risk.unwrap();
        let map = AccuracyMap::new(world, &forecast).with_checks(world, &forecast, &risk);
        CheckReport::new(mission, world, (&map, &forecast), None).human(map.cell_m)
    }

    #[test]
    fn a_rate_of_faults_that_allows_no_level_is_warned_of_and_is_the_stated_reason() {
        let (mut mission, world) = with_faults_per_hour(0.01);
        mission.scan.guarantee = Guarantee::Protection;
        let warning = risk_warning(&mission, &world).unwrap();
        assert_eq!(
            warning,
            "no position will be protected, so no floor will be guaranteed (mission.guarantee = \"protection\"): with 0.01 \
             faults per station and hour (ae.station_faults_per_hour) and 8 stations, two wrong stations at once are more \
             probable than the accepted risk (1e-5, ae.integrity_risk); lower the rate of faults if you have evidence for \
             it, or accept a larger risk"
        );
        let text = said(&mission, &world);
        assert!(
            text.contains("100.0 % of the floor is not protected: two wrong stations at once are more"),
            "{text}"
        );
        let (rare, world) = with_faults_per_hour(1e-4);
        assert_eq!(risk_warning(&rare, &world), None);
        let text = said(&rare, &world);
        assert!(text.contains(" 0.0 % of the floor is not protected\n"), "{text}");
    }

    #[test]
    fn a_forecast_for_stations_with_clocks_of_their_own_says_that_it_assumes_one_clock() {
        let (mut mission, world) = with_faults_per_hour(1e-4);
        assert!(!said(&mission, &world).contains("clocks    "));
        mission.locating.clocks = Some(OwnClocks { offset_sigma_m: 0.3, drift_sigma_m_per_h: 0.0 });
        assert!(said(&mission, &world).contains("clocks    the stations have clocks of their own"));
    }
}
