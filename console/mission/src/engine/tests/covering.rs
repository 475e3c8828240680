//! Coverage missions: lanes in alternate directions, the return to the anchor, and the path round obstacles that are
//! not on the drawing.

use super::*;
use planner_api::{Leg, LegTag};
use world::ObstacleMap;

/// Straight lanes over the regions or, without regions, over all floor. The path from one lane to the next leads along
/// the wall. Lanes pass obstacles on the nearer side. A lap along the wall at the end is optional; the lanes reach the
/// wall only with their ends.
pub(super) fn lanes(request: &PlanAsk, anchor: Point, has_lap: bool) -> Plan {
    let wall_m = 5.0 - request.site.limits.radius_m - request.site.clearance_m;
    let mut path = vec![request.start.position];
    let mut legs = Vec::new();
    let n_lanes = (2.0 * wall_m / request.site.swath_m).ceil() as usize;
    let lane = |lane: usize| -> Vec<Point> {
        let y = -wall_m + request.site.swath_m * lane as f64;
        let half_m = (wall_m.powi(2) - y * y).max(0.0).sqrt();
        let mut points: Vec<Point> =
            (0..=100).map(|k| Point::new(-half_m + 2.0 * half_m * f64::from(k) / 100.0, y)).collect();
        if lane % 2 == 1 {
            points.reverse();
        }
        points
    };
    let lap = |k| Point::new(f64::sin(f64::from(k) / 20.0), f64::cos(f64::from(k) / 20.0)) * wall_m;
    let lap = has_lap.then(|| (0..=126).map(lap).collect());
    for points in (0..n_lanes).map(lane).chain(lap) {
        let points: Vec<Point> =
            points.into_iter().filter(|p| is_wanted(request, *p)).map(|p| beside(request, p)).collect();
        let Some(begin) = points.first() else { continue };
        leg(&mut path, &mut legs, LegTag::Connector, |path| go_on(path, request, *begin));
        leg(&mut path, &mut legs, LegTag::Swath, |path| {
            for to in &points {
                go_on(path, request, *to);
            }
        });
    }
    leg(&mut path, &mut legs, LegTag::Travel, |path| go_on(path, request, anchor));
    Plan { path, complete: true, legs, ..Plan::default() }
}

/// Adds one leg to a path.
fn leg(path: &mut Vec<Point>, legs: &mut Vec<Leg>, tag: LegTag, extend: impl FnOnce(&mut Vec<Point>)) {
    let first = path.len() - 1;
    extend(path);
    legs.push(Leg { tag, first, last: path.len() - 1 });
}

/// Leads the path to a place: along the wall if both ends are at the wall, and round obstacles.
fn go_on(path: &mut Vec<Point>, request: &PlanAsk, to: Point) {
    let from = path[path.len() - 1];
    let n = ((to - from).norm() / 0.1).ceil().max(1.0) as u32;
    let between = (1..n).map(|k| from + (to - from) * (f64::from(k) / f64::from(n)));
    let wall_m = 5.0 - request.site.limits.radius_m - request.site.clearance_m;
    if n < 20 && [from, to].iter().all(|p| p.coords.norm() > wall_m - 1e-6) {
        path.extend(between.clone().map(|p| Point::from(p.coords.normalize() * wall_m)));
    }
    path.extend(between.filter_map(|p| Some(beside(request, p)).filter(|aside| *aside != p)));
    path.push(to);
}

/// The same lanes, with each lane driven forward, back and forward again.
pub(super) fn wasteful(lanes: &Plan) -> Plan {
    let mut plan = Plan { path: vec![lanes.path[0]], legs: vec![], ..lanes.clone() };
    for leg in &lanes.legs {
        let way = &lanes.path[leg.first + 1..=leg.last];
        let first = plan.path.len() - 1;
        plan.path.extend(way);
        if leg.tag == LegTag::Swath {
            plan.path.extend(way.iter().rev().skip(1).chain(way.iter().skip(1)));
        }
        plan.legs.push(Leg { first, last: plan.path.len() - 1, ..*leg });
    }
    plan
}

/// The same lanes without the last one.
pub(super) fn without_last_lane(mut lanes: Plan) -> Plan {
    let (Some(home), Some(swath)) = (lanes.legs.pop(), lanes.legs.pop()) else { return lanes };
    lanes.path.drain(swath.first + 1..home.last);
    let last = lanes.path.len() - 1;
    lanes.legs.push(Leg { first: last - 1, last, ..home });
    lanes
}

fn is_wanted(request: &PlanAsk, point: Point) -> bool {
    let TaskLeft::Cover { regions, .. } = &request.task else { return false };
    let is_near = |region: &Vec<Point>| {
        let near = Shape::Polygon { vertices: region.clone() };
        near.distance_m(point) < 0.2
    };
    regions.is_empty() || regions.iter().any(is_near)
}

/// Circles around the obstacles and zones, large enough for the hull.
fn kept_clear(request: &PlanAsk) -> impl Iterator<Item = (Point, f64)> {
    let room_m = request.site.limits.radius_m + request.site.clearance_m + 0.05;
    let drawn = request.site.obstacles.iter().map(|obstacle| &obstacle.outline);
    drawn.chain(request.site.zones.iter().map(|zone| &zone.outline)).map(move |shape| {
        let (low, high) = shape.bounds();
        let radius_m =
            if let Shape::Disc { radius_m, .. } = shape { *radius_m } else { (high - low).norm() / 2.0 };
        (low + (high - low) / 2.0, radius_m + room_m)
    })
}

/// The place itself or, if an obstacle is too close to it, the nearest place that is far enough away.
fn beside(request: &PlanAsk, point: Point) -> Point {
    let blocking = kept_clear(request).find(|(center, reach_m)| (point - center).norm() < *reach_m);
    blocking.map_or(point, |(center, reach_m)| center + (point - center).normalize() * reach_m)
}

pub(super) fn covering() -> MissionConfig {
    let start = Pose::new(0.0, -4.4, 0.0);
    let task = TaskConfig::Cover { anchor: start.position, regions: vec![], tolerance_m: 0.2 };
    MissionConfig { task, start, time_limit_s: 1000.0, ..config() }
}

pub(super) fn covered(flight: &Flight) -> f64 {
    flight
        .events
        .iter()
        .rev()
        .find_map(|event| match event.kind {
            EventKind::Progressed { covered_reachable, .. } => Some(covered_reachable),
            _ => None,
        })
        .unwrap()
}

fn reasons(flight: &Flight) -> Vec<Reason> {
    let reason = |event: &Event| match &event.kind {
        EventKind::Planned { reason, .. } => Some(reason.clone()),
        _ => None,
    };
    flight.events.iter().filter_map(reason).collect()
}

#[test]
fn a_coverage_mission_scans_the_floor_and_ends_back_at_the_anchor() {
    let mut flight = Flight::new(covering());
    flight.planner.drives_a_lap = true;
    flight.tick(&[Order::Start]);
    flight.fly(6000);
    assert_eq!(flight.ended(), Some(Outcome::Complete));
    assert!((flight.pose.position - covering().start.position).norm() < 0.3);
    assert!(covered(&flight) > 0.94, "{}", covered(&flight));
    let legs: Vec<LegTag> = flight
        .events
        .iter()
        .filter_map(|event| match event.kind {
            EventKind::Progressed { leg, .. } => leg,
            _ => None,
        })
        .collect();
    assert!(legs.contains(&LegTag::Swath) && legs.last() == Some(&LegTag::Travel));
}

#[test]
fn a_column_found_on_the_way_is_planned_around_and_what_is_scanned_stays_scanned() {
    let mut flight = Flight::new(covering());
    flight.tick(&[Order::Start]);
    for _ in 0..8000 {
        let relative = flight.pose.tank_from_robot().inverse() * Point::new(0.0, 1.0);
        flight.sightings.clear();
        if relative.coords.norm() < 2.0 {
            let shape_in_robot = Shape::Disc { center: relative, radius_m: 0.3 };
            flight.sightings = vec![Sighting { id: ObstacleId(7), shape_in_robot }];
        }
        flight.tick(&[]);
        assert!(relative.coords.norm() > 0.5, "the robot drove into the column");
    }
    assert_eq!(flight.ended(), Some(Outcome::Complete));
    assert_eq!(reasons(&flight)[..2], [Reason::Start, Reason::MapChanged]);
    let whole_m2 = std::f64::consts::PI * 25.0;
    assert!(flight.planner.regions_m2[1] < 0.8 * whole_m2, "{:?}", flight.planner.regions_m2);
    assert!(covered(&flight) > 0.92, "{}", covered(&flight));
    let changed = flight.events.iter().any(|event| matches!(event.kind, EventKind::FloorChanged { .. }));
    assert!(changed, "the cells under a column do not count as floor any more");
}

#[test]
fn an_area_without_floor_in_reach_is_named_when_the_rest_is_done() {
    let area = |x: f64, y: f64, half_m: f64| {
        let half = Vector::new(half_m, half_m);
        world::shape::rectangle(Point::new(x, y) - half, Point::new(x, y) + half)
    };
    let anchor = covering().start.position;
    let regions = vec![area(0.0, -3.0, 0.5), area(3.6, 3.6, 0.02)];
    let task = TaskConfig::Cover { anchor, regions, tolerance_m: 0.2 };
    let mut flight = Flight::new(MissionConfig { task, ..covering() });
    flight.tick(&[Order::Start]);
    flight.fly(6000);
    assert_eq!(flight.ended(), Some(Outcome::Complete));
    let reason = flight.events.iter().find_map(|event| match &event.kind {
        EventKind::Ended { reason, .. } => Some(reason.clone()),
        _ => None,
    });
    let named = "; the tool cannot reach any floor in the area around (3.6, 3.6)";
    assert!(reason.as_ref().is_some_and(|reason| reason.ends_with(named)), "{reason:?}");
}

#[test]
fn another_planner_goes_on_with_what_is_left() {
    let mut flight = Flight::new(covering());
    flight.planner.drives_a_lap = true;
    flight.tick(&[Order::Start]);
    flight.fly(1500);
    let before = covered(&flight);
    flight.tick(&[Order::Hold]);
    flight.tick(&[Order::ChoosePlanner(PlannerChoice { id: "other".into(), parameters: Parameters::new() })]);
    flight.tick(&[Order::Resume]);
    let left_m2 = flight.planner.regions_m2[1];
    let whole_m2 = std::f64::consts::PI * 25.0;
    assert!((left_m2 - (1.0 - before) * whole_m2).abs() < 3.0, "{left_m2} m² left after {before}");
    flight.fly(6000);
    assert_eq!(flight.ended(), Some(Outcome::Complete));
    assert_eq!(reasons(&flight), [Reason::Start, Reason::Swap { from: "straight".into() }]);
    assert!(covered(&flight) > 0.94, "{}", covered(&flight));
}

#[test]
fn floor_passed_with_an_uncertain_position_does_not_count() {
    let scan = ScanConfig { position_limit_m: Some(1e-6), ..ScanConfig::default() };
    let mut flight = Flight::new(MissionConfig { scan, ..covering() });
    flight.tick(&[Order::Start]);
    flight.fly(300);
    assert!(covered(&flight).abs() < f64::EPSILON);
    assert!(flight.events.iter().any(|event| matches!(event.kind, EventKind::Uncounted { .. })));
}

#[test]
fn a_planner_that_cannot_go_on_is_asked_some_times_and_then_the_robot_is_stuck() {
    let mut flight = Flight::new(MissionConfig { attended: false, ..covering() });
    flight.planner.stuck_from_tick = Some(100);
    flight.tick(&[Order::Start]);
    flight.fly(3000);
    assert_eq!(flight.ended(), Some(Outcome::Stuck));
    assert!((2..8).contains(&flight.planner.plans), "{} plans", flight.planner.plans);
}

#[test]
fn lanes_are_planned_closer_together_than_the_swath_is_wide() {
    let scan = ScanConfig { overlap_m: 0.1, ..ScanConfig::default() };
    let plans = |scan| {
        let mut flight = Flight::new(MissionConfig { scan, ..covering() });
        flight.tick(&[Order::Start]);
        let length_m = flight.events.iter().find_map(|event| match event.kind {
            EventKind::Planned { length_m, .. } => Some(length_m),
            _ => None,
        });
        length_m.unwrap()
    };
    assert!(plans(scan) > 1.15 * plans(ScanConfig::default()));
}

#[test]
fn a_plan_that_scans_nothing_of_what_is_asked_is_refused_with_the_reason() {
    let mut flight = Flight::new(MissionConfig { attended: true, ..covering() });
    flight.planner.leads_nowhere = true;
    flight.tick(&[Order::Start]);
    flight.fly(5);
    // The tether is not the reason, so running the plan uncertified is not the remedy.
    let Some(HoldReason::PlannerFault { message }) = flight.held_by() else {
        panic!("{:?}", flight.mission.phase())
    };
    assert!(message.contains("scans none of the remaining"), "{message}");
    assert!(refusal(&flight.tick(&[Order::FlyUncertified])).is_some());
}

#[test]
fn planners_steer_round_obstacles_where_they_are_seen_not_where_the_chart_has_them() {
    let column = |x| Shape::Disc { center: Point::new(x, -4.0), radius_m: 0.2 };
    let known = Obstacle { id: ObstacleId(3), name: "C".into(), shape: column(1.0), known: true };
    let world = World { obstacles: vec![known], ..drawing() };
    let mut chart = Chart::new(world, &covering(), 1);
    let pose = covering().start;
    let shown = |chart: &Chart| match chart.near(pose.position)[0].outline {
        Shape::Disc { center, .. } => center.x,
        _ => f64::NAN,
    };
    assert!((shown(&chart) - 1.0).abs() < 1e-9);
    let shape_in_robot = column(0.93).transformed(&pose.tank_from_robot().inverse());
    chart.sight([(ObstacleId(3), &shape_in_robot)].into_iter(), &pose);
    assert!((shown(&chart) - 0.93).abs() < 1e-9);
    chart.sight(std::iter::empty(), &pose);
    assert!((shown(&chart) - 1.0).abs() < 1e-9, "out of sight, the obstacle is at its drawn position");
}

#[test]
fn a_drawn_column_that_a_foreign_tracker_sees_is_not_found_again() {
    let column = |x, radius_m| Shape::Disc { center: Point::new(x, -4.0), radius_m };
    let known = Obstacle { id: ObstacleId(3), name: "C".into(), shape: column(1.0, 0.2), known: true };
    let mut chart = Chart::new(World { obstacles: vec![known], ..drawing() }, &covering(), 1);
    let pose = covering().start;
    let mut found = |id, seen: Shape| {
        let shape_in_robot = seen.transformed(&pose.tank_from_robot().inverse());
        let seen = chart.see(0.0, &[Sighting { id: ObstacleId(id), shape_in_robot }], &[], &pose);
        !seen.events.is_empty() && seen.changes_plans
    };
    let foreign = ObstacleId::FOREIGN.0;
    assert!(!found(foreign, column(1.06, 0.22)));
    let side = vec![Point::new(0.8, -4.1), Point::new(0.8, -3.9)];
    assert!(!found(foreign + 1, Shape::Polyline { points: side, half_width_m: 0.02 }));
    assert!(found(foreign + 2, column(1.15, 0.2)), "the object is beside the column");
    assert!(found(foreign + 3, column(1.0, 0.5)), "the object is larger than the column");
    assert!(found(9, column(1.06, 0.2)), "this tracker knows the drawing");
}

#[test]
fn whatever_changes_plans_is_on_the_map_by_which_they_are_checked() {
    let mut chart = Chart::new(drawing(), &covering(), 1);
    let pose = covering().start;
    let mut silent = 0;
    for tick in 0..60_u32 {
        // An obstacle moves for three seconds, and then stops.
        let x = 0.033 * f64::from(tick.min(31));
        let shape_in_robot = Shape::Disc { center: Point::new(x, 0.0), radius_m: 0.2 };
        let seen =
            chart.see(f64::from(tick) * 0.1, &[Sighting { id: ObstacleId(9), shape_in_robot }], &[], &pose);
        if seen.changes_plans || !seen.events.is_empty() {
            silent += u32::from(seen.events.is_empty());
            let (at, world) = (pose.position, chart.world());
            let as_it_is = ObstacleMap::new(&world.boundary, &world.obstacles).obstacle_distance_m(at);
            assert!((chart.map().obstacle_distance_m(at) - as_it_is).abs() < 1e-12, "tick {tick}");
        }
    }
    assert!(
        silent > 0,
        "the stop of the obstacle changes plans although it has hardly moved since the last report"
    );
}
