//! Forecast of the accuracy of fixes, place by place, with advised station positions: for scripts and people, and as
//! a picture.

mod checks;
mod mirror;

use crate::drawing::forecast::svg;
use account::estimate::forecast;
pub use checks::{CheckReport, risk_warning};
pub use mirror::{Mirrored, line_of_stations};
use mission::{MissionConfig, TaskConfig};
use positioning::{Accuracy, AccuracyMap, Advice};
use serde::Serialize;
use std::fmt::Write;
use world::{Point, World};

/// Largest error during a scan, with fixes and odometry filtered, as a share of the 95 % error of a single fix; from
/// simulated missions.
const FILTERED: f64 = 0.65;
/// Sensing range beyond the hull, metres, below which a robot detects nearby objects too late and relies on its
/// position alone.
const SHORT_SIGHTED_M: f64 = 0.5;
/// Maximum number of listed places beyond the limit.
const MOST_SHOWN: usize = 12;

/// A forecast for scripts.
#[derive(Debug, Serialize)]
pub struct ForecastReport<'a> {
    scenario: &'a str,
    limit_m: f64,
    stations: Vec<Placed<'a>>,
    mean_error_95_m: Option<f64>,
    p95_error_95_m: Option<f64>,
    worst_error_95_m: Option<f64>,
    blind_share: f64,
    beyond_limit_share: f64,
    beyond_limit_area_m2: f64,
    /// Floor that the ranges cannot distinguish from its mirror image; absent if there is none.
    #[serde(skip_serializing_if = "Option::is_none")]
    mirror: Option<Mirrored>,
    /// Places beyond the limit, the worst first.
    beyond_limit: Vec<Place>,
    map: &'a AccuracyMap,
    advice: Option<Advice>,
    #[serde(skip_serializing_if = "Option::is_none")]
    checks: Option<CheckReport>,
}

#[derive(Debug, Serialize)]
struct Placed<'a> {
    name: &'a str,
    at: Point,
}

#[derive(Debug, Serialize)]
struct Place {
    at: Point,
    #[serde(flatten)]
    accuracy: Accuracy,
}

impl<'a> ForecastReport<'a> {
    /// Computes the forecast of a scenario with this name over a map of its drawing.
    pub fn new(
        scenario: &'a str,
        mission: &MissionConfig,
        drawing: &'a World,
        map: &'a AccuracyMap,
        advice: Option<Advice>,
    ) -> Self {
        let limit_m = mission.position_limit_m;
        let mut errors: Vec<f64> = map.floor().filter_map(|(_, cell)| cell.error_95_m).collect();
        errors.sort_by(f64::total_cmp);
        let n_floor = map.floor().count().max(1) as f64;
        let beyond: Vec<Place> =
            map.beyond(limit_m).into_iter().map(|(at, accuracy)| Place { at, accuracy }).collect();
        let mean = errors.iter().sum::<f64>() / errors.len() as f64;
        Self {
            scenario,
            limit_m,
            stations: drawing
                .stations
                .iter()
                .map(|station| Placed { name: &station.name, at: station.position })
                .collect(),
            mean_error_95_m: (!errors.is_empty()).then_some(mean),
            p95_error_95_m: errors.get(errors.len() * 95 / 100).copied(),
            worst_error_95_m: errors.last().copied(),
            blind_share: 1.0 - errors.len() as f64 / n_floor,
            beyond_limit_share: beyond.len() as f64 / n_floor,
            beyond_limit_area_m2: beyond.len() as f64 * map.cell_m * map.cell_m,
            mirror: Mirrored::of(mission, drawing, map),
            beyond_limit: beyond,
            map,
            advice,
            checks: None,
        }
    }

    /// Adds how well the stations check each other.
    #[must_use]
    pub fn with_checks(self, checks: CheckReport) -> Self {
        Self { checks: Some(checks), ..self }
    }

    /// The forecast as an SVG document; rings mark the advised stations.
    pub fn svg(&self, drawing: &World) -> String {
        let places = self.advice.as_ref().map_or(&[][..], |advice| &advice.places);
        svg(drawing, self.map, self.limit_m, places)
    }

    /// The forecast as text.
    pub fn human(&self) -> String {
        let mut text = String::new();
        // Writing to a String cannot fail.
        let metres = |value: Option<f64>| value.map_or("none".into(), |m| format!("{m:.3} m"));
        let percent = |share: f64| share * 100.0;
        let _ = writeln!(text, "95 % error of a single fix, from the scatter of the ranges");
        let _ = writeln!(text, "mean      {}", metres(self.mean_error_95_m));
        let _ = writeln!(text, "p95       {}", metres(self.p95_error_95_m));
        let _ = writeln!(text, "worst     {}", metres(self.worst_error_95_m));
        let _ = writeln!(text, "no fix    {:.1} % of the floor", percent(self.blind_share));
        let _ = writeln!(
            text,
            "beyond    {:.1} % of the floor, {:.1} m², above the limit of {:.2} m or without a fix",
            percent(self.beyond_limit_share),
            self.beyond_limit_area_m2,
            self.limit_m
        );
        if let Some(mirror) = &self.mirror {
            let [first, second] = mirror.sentences();
            let _ = writeln!(text, "mirror    {first};\n          {second}");
        }
        for place in self.beyond_limit.iter().take(MOST_SHOWN) {
            let error = place.accuracy.error_95_m.map_or("no fix".into(), |m| format!("{m:.3} m"));
            let _ = writeln!(
                text,
                "  at {:6.2}, {:6.2} m  {error:9}  stations heard: {}",
                place.at.x, place.at.y, place.accuracy.heard
            );
        }
        let rest = self.beyond_limit.len().saturating_sub(MOST_SHOWN);
        if rest > 0 {
            let _ = writeln!(text, "  and {rest} more cells of {:.2} m", self.map.cell_m);
        }
        if let Some(checks) = &self.checks {
            text += &checks.human(self.map.cell_m);
        }
        if let Some(advice) = &self.advice {
            let _ = writeln!(
                text,
                "advice    {} stations on the wall: mean {:.3} m, worst {:.3} m, no fix on {:.1} % of the floor",
                advice.places.len(),
                advice.mean_error_95_m,
                advice.worst_error_95_m,
                percent(advice.blind_share)
            );
            for place in &advice.places {
                let _ = writeln!(text, "  at_m = [{:.3}, {:.3}]", place.x, place.y);
            }
        }
        text
    }
}

/// Warns if the clearance is so small that the position error may exceed it. This concerns scans, because the robot
/// senses its distance from columns but not from walls. It also concerns every mission of a robot that senses little
/// beyond its hull.
///
/// Takes as long as computing the map, which is one forecast for each of several thousand places.
pub fn clearance_warning(mission: &MissionConfig, drawing: &World) -> Option<String> {
    let (clearance_m, sensed_m) = (mission.clearance_m, mission.limits.sensing_range_m);
    let knows_by_position = matches!(mission.task, TaskConfig::Cover { .. }) || sensed_m < SHORT_SIGHTED_M;
    if !knows_by_position {
        return None;
    }
    let map = AccuracyMap::new(drawing, &forecast(mission, drawing));
    let expected_m = FILTERED * ForecastReport::new("", mission, drawing, &map, None).p95_error_95_m?;
    (clearance_m < expected_m).then(|| {
        format!(
            "the hull keeps {clearance_m:.2} m from solid objects (mission.clearance_m; at least 0.08 m \
             where ranges are noisy), but the position error will be up to about {expected_m:.2} m, so the \
             robot may touch objects that it does not sense; increase the clearance or improve the stations \
             (`tankops accuracy`)"
        )
    })
}

/// Warns if the stations are so nearly on a line that the ranges fit two positions, and states the criterion that
/// decides between the two.
///
/// Takes as long as computing the map.
pub fn mirror_warning(mission: &MissionConfig, drawing: &World) -> Option<String> {
    let map = AccuracyMap::new(drawing, &forecast(mission, drawing));
    let [first, second] = Mirrored::of(mission, drawing, &map)?.sentences();
    Some(format!("{first}; {second} (`tankops accuracy`)"))
}
