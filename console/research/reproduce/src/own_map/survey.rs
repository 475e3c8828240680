//! A survey, and its map against the tank.

use super::site;
use account::Fold;
use exploration::{SurveyMap, column_numbers};
use flight::{Flight, answers::Answers};
use mission::{Answer, Ask, EventKind, Mission, Order, Outcome, Phase};
use scenario::{Scenario, cover_of_map};
use serde::{Deserialize, Serialize};
use trials::tanks::Tank;

/// Distance of the centre and difference of the radius up to which a column on the map is a column of the tank, metres.
const SAME_M: [f64; 2] = [0.06, 0.05];

/// What a survey achieved.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Surveyed {
    /// Whether every frontier was visited; otherwise the reason.
    pub end: Result<(), String>,
    /// Number of columns of the tank, and of those that are on the map.
    pub columns: [usize; 2],
    /// Number of objects on the map that are not in the tank.
    pub unreal: usize,
    /// Largest errors of a centre and of a radius, metres; absent if no column is on the map.
    pub errors_m: Option<[f64; 2]>,
    /// Share of the floor within the wall that the scans have shown, 0 to 1.
    pub explored: f64,
    /// Mission time, seconds.
    pub time_s: f64,
    /// Length of the path, metres.
    pub path_m: f64,
    /// Smallest true distance of the hull from anything solid, metres.
    pub clearance_m: f64,
    /// Number of collisions.
    pub collisions: u64,
}

/// A survey asks no planner.
struct NoPlanner;

impl Answers for NoPlanner {
    fn submit(&mut self, _: Ask) {}

    fn next(&mut self, _: &Mission) -> Option<Answer> {
        None
    }
}

/// Surveys a tank; returns the result, and the scenario that covers the mapped floor with a planner, or the reason why the
/// map gives none.
pub(super) fn survey(tank: &Tank, seed: u64, planner: &str) -> (Surveyed, Result<String, String>) {
    let none = |why: String| Surveyed {
        end: Err(why),
        columns: [tank.columns.len(), 0],
        unreal: 0,
        errors_m: None,
        explored: 0.0,
        time_s: 0.0,
        path_m: 0.0,
        clearance_m: 0.0,
        collisions: 0,
    };
    let scenario = match Scenario::parse(&site::survey(tank, seed), "survey") {
        Ok(scenario) => scenario,
        Err(errors) => return (none(errors.render()), Err("no survey".into())),
    };
    let (fold, map, flight) = fly(&scenario);
    let summary = fold.summary();
    let reason = summary.reason.clone().unwrap_or_else(|| "no end".into());
    let Some(map) = map else { return (none(reason), Err("the survey made no map".into())) };
    let (found, unreal, errors_m) = compared(tank, &map);
    let is_complete = summary.outcome == Some(Outcome::Complete);
    let surveyed = Surveyed {
        end: if is_complete { Ok(()) } else { Err(reason) },
        columns: [tank.columns.len(), found],
        unreal,
        errors_m,
        explored: map.explored,
        time_s: summary.mission_time_s.unwrap_or_default(),
        path_m: summary.path_length_m.unwrap_or_default(),
        clearance_m: summary.clearance_min_m.unwrap_or_default(),
        collisions: summary.collisions.unwrap_or_default(),
    };
    let numbers = column_numbers(&map.columns, std::iter::empty());
    let EventKind::RunOpened(opened) = flight.opened().kind else { unreachable!("a flight opens its run") };
    let text = cover_of_map(&opened, "survey", (&map, &numbers), planner);
    (surveyed, text.map_err(|error| error.to_string()))
}

fn fly(scenario: &Scenario) -> (Fold, Option<SurveyMap>, Flight) {
    let mut flight = Flight::prepare(scenario, false);
    let mut fold = Fold::of_figures();
    fold.apply(&flight.opened());
    let mut map = None;
    let mut orders: &[Order] = &[Order::Start];
    while !matches!(flight.phase(), Phase::Ended(_)) {
        for event in flight.tick(orders, &mut NoPlanner) {
            fold.apply(&event);
            if let EventKind::Mapped { map: made } = event.kind {
                map = Some(SurveyMap::clone(&made));
            }
        }
        orders = &[];
    }
    (fold, map, flight)
}

/// The number of the tank's columns on the map, the number of other objects, and the largest errors of centre and radius.
fn compared(tank: &Tank, map: &SurveyMap) -> (usize, usize, Option<[f64; 2]>) {
    let nearest = |(center, radius_m): &(world::Point, f64)| {
        let errors = map
            .columns
            .iter()
            .map(|column| [(column.center - center).norm(), (column.radius_m - radius_m).abs()]);
        errors.min_by(|a, b| a[0].total_cmp(&b[0])).filter(|errors| (0..2).all(|k| errors[k] <= SAME_M[k]))
    };
    let errors: Vec<[f64; 2]> = tank.columns.iter().filter_map(nearest).collect();
    let worst = errors.iter().copied().reduce(|a, b| [a[0].max(b[0]), a[1].max(b[1])]);
    let n_objects = map.columns.len() + map.others.len();
    (errors.len(), n_objects.saturating_sub(errors.len()), worst)
}
