//! How well the stations check each other: per place, over the planned session, and with one more station.

use mission::MissionConfig;
use positioning::{
    AccuracyMap, Checks, Forecast, OneMore, Risk, SessionChecks,
    accuracy::checks::{Floor, NOT_SEPARABLE},
};
use serde::Serialize;
use std::fmt::Write;
use world::{ObstacleMap, Point, World, polyline};

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
            "level     median {}, 95 % of the floor {}; {:.1} % of the floor is not protected",
            metres(self.median_level_m),
            metres(self.p95_level_m),
            percent(self.unprotected_share)
        );
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
