//! Surveys of random tanks without a drawing, from the first scan to the map: every column is found, the free floor on
//! the map is the free floor of the tank, nothing is touched, and the tether keeps its limits.

#![allow(clippy::unwrap_used, reason = "tests")]

use exploration::{CellState, SurveyMap};
use flight::{Flight, answers::Answers};
use mission::{Answer, Ask, Event, EventKind, Mission, Order, Outcome, Phase};
use scenario::Scenario;
use std::{f64::consts::TAU, fmt::Write};
use world::{ObstacleMap, Point, Shape, World};

/// Minimum distance between a column and anything else, metres; the robot fits through such a gap.
const GAP_M: f64 = 0.9;
/// Distances within which a column on the map is a column of the tank, metres: centre and radius.
const SAME_M: (f64, f64) = (0.06, 0.05);

/// A survey asks no planner.
struct NoPlanner;

impl Answers for NoPlanner {
    fn submit(&mut self, ask: Ask) {
        panic!("a survey asked a planner: {ask:?}");
    }

    fn next(&mut self, _: &Mission) -> Option<Answer> {
        None
    }
}

/// A generator of pseudo-random numbers, uniform in a range.
struct Noise(u64);

impl Noise {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        low + (high - low) * ((self.0 >> 33) as f64) / f64::from(1_u32 << 31)
    }
}

/// A tank with columns at random places, none of which is on the drawing; every second tank has a tether.
fn tank(seed: u64) -> String {
    let mut noise = Noise(seed.wrapping_mul(7919).wrapping_add(17));
    let (tank_m, n) = (noise.between(4.0, 8.0), noise.between(3.0, 16.0) as usize);
    let mut placed: Vec<([f64; 2], f64)> = Vec::new();
    let mut obstacles = String::new();
    for _ in 0..40 * n {
        let radius_m = noise.between(0.08, 0.4);
        let from_center_m = (tank_m - GAP_M - radius_m) * noise.between(0.0, 1.0).sqrt();
        let (sin, cos) = noise.between(0.0, TAU).sin_cos();
        let at = [from_center_m * cos, from_center_m * sin];
        let gap_m = |(other, r): &([f64; 2], f64)| (at[0] - other[0]).hypot(at[1] - other[1]) - r - radius_m;
        if placed.len() < n
            && from_center_m > radius_m + 0.7
            && placed.iter().all(|other| gap_m(other) > GAP_M)
        {
            placed.push((at, radius_m));
            let [x, y] = at;
            let _ = write!(
                obstacles,
                "[[obstacles]]\nkind = \"circle\"\ncenter_m = [{x:.4}, {y:.4}]\nradius_m = {radius_m:.4}\nknown = false\n\n"
            );
        }
    }
    let tether = if seed.is_multiple_of(2) {
        let reel_m = 1.6 * tank_m;
        format!("[tether]\nreel_length_m = {reel_m:.2}\nwrap_max_deg = 150.0\nwrap_total_max_deg = 270.0\n\n")
    } else {
        String::new()
    };
    let station = |k: u32| {
        let (sin, cos) = (TAU * f64::from(k) / 5.0).sin_cos();
        format!("{{ name = \"S{k}\", at_m = [{:.3}, {:.3}] }}", (tank_m - 1e-3) * cos, (tank_m - 1e-3) * sin)
    };
    let stations: Vec<String> = (0..5).map(station).collect();
    format!(
        "name = \"survey-{seed}\"\nseed = {seed}\n\n[tank]\nradius_m = {tank_m:.4}\n\n{obstacles}[robot]\nmotion = \
         \"unicycle\"\nstart_m = [0.0, 0.0]\nstart_heading_deg = 90.0\nradius_m = 0.2\nspeed_max_m_per_s = 0.4\n\
         turn_rate_max_deg_per_s = 60.0\nacceleration_m_per_s2 = 0.5\nsensing_range_m = 2.0\nslip_mean = 0.02\n\
         slip_sigma = 0.01\nodometry_sigma_ratio = 0.02\ngyro_bias_deg_per_s = 0.02\n\n[robot.scanner]\nrays = 360\n\
         range_m = 8.0\nrate_hz = 5.0\nsigma_m = 0.02\nlost_share = 0.02\n\n[ae]\nperiod_s = 1.0\nrepetitions = 20\n\
         noise = {{ model = \"uniform\", ratio = 0.05 }}\nstations = [{}]\n\n{tether}[mission]\nkind = \"survey\"\n\
         clearance_m = 0.1\ntime_limit_s = 3600.0\nposition_limit_m = 0.3\n",
        stations.join(", ")
    )
}

fn parsed(text: &str) -> Scenario {
    Scenario::parse(text, "tank").unwrap_or_else(|errors| panic!("{}", errors.render()))
}

fn flown(scenario: &Scenario) -> Vec<Event> {
    let mut flight = Flight::prepare(scenario, false);
    let mut events = vec![flight.opened()];
    let mut orders: &[Order] = &[Order::Start];
    while !matches!(flight.phase(), Phase::Ended(_)) {
        events.extend(flight.tick(orders, &mut NoPlanner));
        orders = &[];
    }
    events
}

/// What a survey achieved.
#[derive(Debug)]
struct Result {
    outcome: Option<(Outcome, String)>,
    found: usize,
    of: usize,
    unreal: usize,
    others: usize,
    overlap: f64,
    explored: f64,
    collisions: usize,
    /// Smallest distance of the hull from anything solid, metres.
    clearance_m: f64,
    /// Longest cable and largest wrap on one object, metres and radians.
    cable: (f64, f64),
    center_max_m: f64,
    radius_max_m: f64,
}

impl Result {
    fn of(scenario: &Scenario, events: &[Event]) -> Self {
        let map = events.iter().rev().find_map(|event| match &event.kind {
            EventKind::Mapped { map } => Some(SurveyMap::clone(map)),
            _ => None,
        });
        let map = map.unwrap_or_else(|| panic!("{:?}", events.last()));
        let columns = columns(&scenario.sim.world);
        let errors = |(center, radius_m): &(Point, f64)| {
            let near =
                map.columns.iter().map(|c| ((c.center - center).norm(), (c.radius_m - radius_m).abs()));
            near.min_by(|a, b| a.0.total_cmp(&b.0)).filter(|(c, r)| *c < SAME_M.0 && *r < SAME_M.1)
        };
        let matched: Vec<(f64, f64)> = columns.iter().filter_map(errors).collect();
        let outcome = events.iter().find_map(|event| match &event.kind {
            EventKind::Ended { outcome, reason } => Some((*outcome, reason.clone())),
            _ => None,
        });
        let collided = |event: &&Event| matches!(event.kind, EventKind::Truth { collided: true, .. });
        let clearance_m = events.iter().filter_map(|event| match &event.kind {
            EventKind::Truth { clearance_m, .. } => Some(*clearance_m),
            _ => None,
        });
        let cable = events.iter().filter_map(|event| match &event.kind {
            EventKind::TetherTruth { length_m, wrap_max_rad, .. } => Some((*length_m, *wrap_max_rad)),
            _ => None,
        });
        Self {
            outcome,
            found: matched.len(),
            of: columns.len(),
            unreal: map.columns.len() - matched.len().min(map.columns.len()),
            others: map.others.len(),
            overlap: overlap(&scenario.sim.world, &map),
            explored: map.explored,
            collisions: events.iter().filter(collided).count(),
            clearance_m: clearance_m.fold(f64::INFINITY, f64::min),
            cable: cable.fold((0.0, 0.0), |most: (f64, f64), (m, rad)| (most.0.max(m), most.1.max(rad))),
            center_max_m: matched.iter().map(|error| error.0).fold(0.0, f64::max),
            radius_max_m: matched.iter().map(|error| error.1).fold(0.0, f64::max),
        }
    }
}

fn columns(world: &World) -> Vec<(Point, f64)> {
    let disc = |shape: &Shape| match shape {
        Shape::Disc { center, radius_m } => Some((*center, *radius_m)),
        _ => None,
    };
    world.obstacles.iter().filter_map(|obstacle| disc(&obstacle.shape)).collect()
}

/// Floor that is free and shown as free, as a share of the floor that is one or the other.
fn overlap(world: &World, map: &SurveyMap) -> f64 {
    let solid = ObstacleMap::new(&world.boundary, &world.obstacles);
    let (mut both, mut either) = (0.0, 0.0);
    for (cell, state) in map.states().unwrap().into_iter().enumerate() {
        let (is_free, shown) = (solid.clearance_m(map.grid.center(cell)) > 0.0, state == CellState::Free);
        both += f64::from(u8::from(is_free && shown));
        either += f64::from(u8::from(is_free || shown));
    }
    both / either
}

/// Seeds of the tanks; `SURVEY_SEEDS=300..310` chooses others. In the tank of seed 9118, no frontier could be reached at
/// first from the place where the robot began to drive back; in that of seed 9113, lost rays made a column hollow.
fn seeds() -> Vec<u64> {
    let chosen = std::env::var("SURVEY_SEEDS").ok();
    let range = chosen.as_deref().and_then(|text| text.split_once(".."));
    range.map_or(vec![1, 2, 9113, 9118], |(first, end)| {
        (first.parse().unwrap()..end.parse().unwrap()).collect()
    })
}

#[test]
fn random_tanks_are_mapped() {
    let each = |seed: u64| {
        let scenario = parsed(&tank(seed));
        let result = Result::of(&scenario, &flown(&scenario));
        println!("seed {seed}: {result:?}");
        (seed, scenario, result)
    };
    let threads: Vec<_> = seeds().into_iter().map(|seed| std::thread::spawn(move || each(seed))).collect();
    for (seed, scenario, result) in threads.into_iter().map(|thread| thread.join().unwrap()) {
        assert_eq!(
            result.outcome.as_ref().map(|outcome| outcome.0),
            Some(Outcome::Complete),
            "{seed}: {result:?}"
        );
        assert_eq!([result.found, result.unreal, result.others], [result.of, 0, 0], "{seed}: {result:?}");
        assert_eq!(result.collisions, 0, "{seed}: {result:?}");
        assert!(result.overlap >= 0.97 && result.explored > 0.95, "{seed}: {result:?}");
        assert!(result.center_max_m <= 0.04 && result.radius_max_m <= 0.03, "{seed}: {result:?}");
        if let Some(tether) = &scenario.mission.tether {
            let limits = tether.limits;
            assert!(result.cable.0 <= limits.reel_length_m, "{seed}: {result:?}");
            assert!(result.cable.1 <= limits.wrap_max_rad, "{seed}: {result:?}");
        }
    }
}

/// A scanner that looks forward only: the robot first turns once around. Without room for the hull anywhere, it ends with
/// the reason.
#[test]
fn a_scanner_with_a_narrow_view_is_turned_around_first() {
    let narrow = tank(1).replace("rays = 360\n", "rays = 90\nfield_of_view_deg = 90.0\n");
    let scenario = parsed(&narrow);
    let result = Result::of(&scenario, &flown(&scenario));
    assert_eq!(result.outcome.as_ref().map(|outcome| outcome.0), Some(Outcome::Complete), "{result:?}");
    assert!(result.explored > 0.95 && result.collisions == 0, "{result:?}");
    let mut posts = String::new();
    for k in 0..8 {
        let (sin, cos) = (TAU * f64::from(k) / 8.0).sin_cos();
        let at = format!("[{:.3}, {:.3}]", 0.4 * cos, 0.4 * sin);
        let _ = write!(
            posts,
            "[[obstacles]]\nkind = \"circle\"\ncenter_m = {at}\nradius_m = 0.06\nknown = false\n\n"
        );
    }
    let events = flown(&parsed(&tank(1).replacen("[robot]", &format!("{posts}[robot]"), 1)));
    let end = events.iter().find_map(|event| match &event.kind {
        EventKind::Ended { outcome, reason } => Some((*outcome, reason.clone())),
        _ => None,
    });
    let (outcome, reason) = end.unwrap();
    assert!(outcome == Outcome::Stuck && reason.contains("no free floor with room for the hull"), "{reason}");
}

/// In this tank, the way home follows the tether closely round a column. With little clearance, the noise of the scanner
/// could stop the robot there.
#[test]
fn the_way_home_along_the_tether_keeps_room_for_the_guard() {
    let scenario = parsed(&tank(20).replace("clearance_m = 0.1", "clearance_m = 0.05"));
    let result = Result::of(&scenario, &flown(&scenario));
    assert_eq!(result.outcome.as_ref().map(|outcome| outcome.0), Some(Outcome::Complete), "{result:?}");
    assert!(result.clearance_m > 0.05, "{result:?}");
}

#[test]
fn a_survey_repeats_event_by_event() {
    let text = tank(1).replace("time_limit_s = 3600.0", "time_limit_s = 60.0");
    let scenario = parsed(&text);
    let events = flown(&scenario);
    assert_eq!(events, flown(&scenario));
    let n_maps = events.iter().filter(|event| matches!(event.kind, EventKind::Mapped { .. })).count();
    let n_told = events.iter().filter(|event| matches!(event.kind, EventKind::Explored(_))).count();
    assert!(n_maps == 1 && (10..=13).contains(&n_told), "{n_maps} maps, {n_told} reports");
}

/// A scanner that sends half of the rays that the scenario states is named, and the survey makes no map of its scans.
#[test]
fn a_survey_with_a_wrong_scanner_ends_with_the_reason() {
    let mut scenario = parsed(&tank(1));
    scenario.sim.robot.scanner.as_mut().unwrap().rays = 180;
    let events = flown(&scenario);
    let judged =
        events.iter().any(|event| matches!(&event.kind, EventKind::ScannerJudged { trouble: Some(_) }));
    assert!(judged, "{:?}", events.last());
    assert!(
        !events.iter().any(|event| matches!(event.kind, EventKind::Mapped { .. })),
        "{:?}",
        events.last()
    );
}

#[test]
fn a_survey_without_a_scanner_or_with_a_planner_is_refused() {
    let message = |text: &str| Scenario::parse(text, "tank").unwrap_err().render();
    let (before, after) =
        tank(1).split_once("[robot.scanner]").map(|(a, b)| (a.to_owned(), b.to_owned())).unwrap();
    let without = before + after.split_once("\n\n").unwrap().1;
    assert!(message(&without).contains("robot.scanner"), "{}", message(&without));
    let planned = tank(1) + "\n[planner]\nid = \"tether-safe\"\n";
    assert!(message(&planned).contains("the mission itself drives"), "{}", message(&planned));
}
