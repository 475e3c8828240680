//! Whole explorations: a robot that drives from frontier to frontier, with scans and poses that have errors.

use super::*;
use geometry::{Boundary, Point, Pose, Shape, unit_vector};
use world::{Obstacle, ObstacleId, ObstacleMap, Scan, Scanner};

/// Room for the centre of the hull in these tests, metres.
const ROOM_M: f64 = 0.3;

/// The scanner of these tests.
const SCANNING: Scanning = Scanning { sigma_m: 0.02, range_m: Some(8.0), hull_m: 0.2 };

/// A generator of pseudo-random numbers, uniform from 0 to 1.
struct Noise(u64);

impl Noise {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) as f64) / f64::from(1_u32 << 31)
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }

    /// A number that is nearly normally distributed: the sum of twelve uniform numbers.
    fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.next()).sum::<f64>() - 6.0
    }
}

/// A tank with columns that the robot does not know.
struct Tank {
    boundary: Boundary,
    map: ObstacleMap,
    columns: Vec<(Point, f64)>,
    scanner: Scanner,
    noise: Noise,
}

impl Tank {
    fn new(radius_m: f64, shapes: &[Shape], seed: u64) -> Self {
        let boundary = Boundary::Circle { radius_m };
        let columns = shapes.iter().filter_map(|shape| match shape {
            Shape::Disc { center, radius_m } => Some((*center, *radius_m)),
            _ => None,
        });
        let columns = columns.collect();
        let obstacle = |(n, shape): (usize, &Shape)| Obstacle {
            id: ObstacleId(n as u32 + 1),
            name: format!("C{n}"),
            shape: shape.clone(),
            known: false,
        };
        let obstacles: Vec<_> = shapes.iter().enumerate().map(obstacle).collect();
        let map = ObstacleMap::new(&boundary, &obstacles);
        Self { boundary, map, columns, scanner: Scanner::default(), noise: Noise(seed) }
    }

    /// Columns at random places, with room for the hull between them, away from the start at the origin.
    fn random(seed: u64) -> Self {
        let mut noise = Noise(seed.wrapping_mul(7919).wrapping_add(13));
        let (radius_m, n) = (noise.between(4.0, 8.0), noise.between(3.0, 16.0) as usize);
        let mut placed: Vec<(Point, f64)> = Vec::new();
        for _ in 0..40 * n {
            let column_m = noise.between(0.08, 0.4);
            let from_center_m = (radius_m - 0.9 - column_m) * noise.next().sqrt();
            let at = Point::origin() + unit_vector(noise.between(0.0, std::f64::consts::TAU)) * from_center_m;
            let is_apart = |(other, m): &(Point, f64)| (at - other).norm() > column_m + m + 0.8;
            if placed.len() < n && at.coords.norm() > column_m + 0.6 && placed.iter().all(is_apart) {
                placed.push((at, column_m));
            }
        }
        let disc = |(center, radius_m): (Point, f64)| Shape::Disc { center, radius_m };
        Self::new(radius_m, &placed.into_iter().map(disc).collect::<Vec<_>>(), seed)
    }

    fn scan(&mut self, pose: &Pose) -> Scan {
        let (scanner, map, boundary, noise) = (&self.scanner, &self.map, &self.boundary, &mut self.noise);
        let eye = scanner.pose(pose).position;
        let ray = |n: u32| {
            let angle = pose.heading_rad + scanner.first_rad() + f64::from(n) * scanner.step_rad();
            let direction = unit_vector(angle);
            let hit_m =
                map.ray_m(eye, direction, 60.0).unwrap_or(f64::INFINITY).min(boundary.ray_m(eye, direction));
            let (error_m, is_lost) = (scanner.sigma_m * noise.normal(), noise.next() < scanner.lost_share);
            (!is_lost).then_some(hit_m + error_m)
        };
        scanner.scan((0..scanner.rays).map(ray))
    }

    /// Explores the tank until no frontier is left; returns the map, and whether the hull stayed clear of everything.
    fn explore(&mut self) -> (Exploration, f64) {
        let scanning = Scanning { range_m: Some(self.scanner.range_m), ..SCANNING };
        let mut exploration = Exploration::new(&self.boundary, scanning);
        let (mut pose, mut least_m, mut steps) = (Pose::new(0.0, 0.0, 0.3), f64::INFINITY, 0);
        self.look(&mut exploration, &pose, 0);
        let mut tried: Vec<Point> = Vec::new();
        for _ in 0..300 {
            let ways = exploration.ways(pose.position, ROOM_M, std::iter::empty());
            let views = || exploration.views(&ways).into_iter().map(|view| view.at);
            let goals = ways.frontiers(|_| true).into_iter().map(|frontier| frontier.at).chain(views());
            let Some(goal) = goals.into_iter().find(|goal| !tried.contains(goal)) else { break };
            tried.push(goal);
            let way = ways.to(goal).unwrap();
            for at in geometry::polyline::resampled(&way, 0.15).into_iter().skip(1).take(8) {
                let along = at - pose.position;
                pose = Pose::new(at.x, at.y, along.y.atan2(along.x));
                least_m = least_m.min(self.map.clearance_m(at));
                steps += 1;
                self.look(&mut exploration, &pose, steps);
            }
        }
        (exploration, least_m)
    }

    /// Adds a scan at an estimated pose that is off by about 2 cm and 0.5 degrees.
    fn look(&mut self, exploration: &mut Exploration, pose: &Pose, step: u32) {
        let scan = self.scan(pose);
        let wave = (f64::from(step) * 0.21).sin();
        let (x, y) = (pose.position.x + 0.02 * wave, pose.position.y - 0.015 * wave);
        exploration.add(&scan, &Pose::new(x, y, pose.heading_rad + 0.008 * wave), f64::from(step));
    }

    /// Shared part of the floor that is free and the floor that the map shows as free.
    fn overlap(&self, map: &SurveyMap) -> f64 {
        let (mut both, mut either) = (0.0, 0.0);
        for (cell, state) in map.states().unwrap().into_iter().enumerate() {
            let (is_free, shown) =
                (self.map.clearance_m(map.grid.center(cell)) > 0.0, state == CellState::Free);
            both += f64::from(u8::from(is_free && shown));
            either += f64::from(u8::from(is_free || shown));
        }
        both / either
    }
}

#[test]
fn a_frontier_that_was_reached_in_vain_is_driven_to_elsewhere() {
    let mut tank = Tank::new(9.0, &[], 3);
    let mut exploration = Exploration::new(&tank.boundary, SCANNING);
    let pose = Pose::new(0.0, 0.0, 0.0);
    (0..3).for_each(|step| tank.look(&mut exploration, &pose, step));
    let ways = exploration.ways(pose.position, ROOM_M, std::iter::empty());
    // The only frontier is the limit of what the scanner shows, all around.
    let [all] = ways.frontiers(|_| true)[..] else { panic!("{:?}", ways.frontiers(|_| true)) };
    let [other] = ways.frontiers(|at| (at - all.at).norm() > 0.5)[..] else { panic!("left out") };
    assert!((other.at - all.at).norm() > 0.5 && other.cost_m >= all.cost_m, "{all:?} {other:?}");
}

#[test]
fn random_tanks_are_explored_and_every_column_is_found() {
    for seed in 1..=6 {
        let mut tank = Tank::random(seed);
        let (exploration, least_m) = tank.explore();
        let map = exploration.map();
        let overlap = tank.overlap(&map);
        assert!(overlap > 0.97, "seed {seed}: {overlap}");
        assert!(least_m > 0.2, "seed {seed}: {least_m} m of room");
        assert_eq!(
            map.columns.len(),
            tank.columns.len(),
            "seed {seed}: {:?} {:?}",
            map.columns,
            tank.columns
        );
        assert!(map.others.is_empty(), "seed {seed}: {:?}", map.others);
        for (center, radius_m) in &tank.columns {
            let found = map.columns.iter().any(|column| {
                (column.center - center).norm() < 0.04 && (column.radius_m - radius_m).abs() < 0.03
            });
            assert!(found, "seed {seed}: {center} {radius_m} in {:?}", map.columns);
        }
    }
}

#[test]
fn a_crate_is_an_outline_and_no_column() {
    let vertices = geometry::shape::rectangle(Point::new(1.0, -0.4), Point::new(1.8, 0.4));
    let crate_ = Shape::Polygon { vertices };
    let mut tank = Tank::new(4.0, std::slice::from_ref(&crate_), 3);
    let map = tank.explore().0.map();
    assert!(map.columns.is_empty());
    let [Shape::Polygon { vertices }] = &map.others[..] else { panic!("{:?}", map.others) };
    assert!(vertices.iter().all(|corner| crate_.distance_m(*corner).abs() < 0.12), "{vertices:?}");
}

#[test]
fn a_column_seen_from_two_sides_only_is_one_column() {
    let mut tank = Tank::new(6.0, &[Shape::Disc { center: Point::new(0.0, 0.0), radius_m: 0.5 }], 5);
    let mut exploration = Exploration::new(&tank.boundary, SCANNING);
    for step in 0..20 {
        // From far away on both sides: the flanks, which the rays graze, stay unseen.
        for (side, n) in [(1.0, 0), (-1.0, 1)] {
            let pose = Pose::new(side * (1.5 + 0.11 * f64::from(step)), 0.0, 0.0);
            tank.look(&mut exploration, &pose, 2 * step + n);
        }
    }
    let bodies = exploration.bodies();
    assert_eq!(bodies.len(), 1, "{bodies:?}");
    let column = bodies[0].column.unwrap();
    assert!(column.center.coords.norm() < 0.04 && (column.radius_m - 0.5).abs() < 0.04, "{column:?}");
}

#[test]
fn the_same_scans_give_the_same_map_and_its_text_reads_back() {
    let map = |seed| Tank::random(seed).explore().0.map();
    let first = map(2);
    assert_eq!(first, map(2));
    assert_eq!(first.states().unwrap().len(), first.grid.len());
    let damaged = |cells: &str| SurveyMap { cells: cells.into(), ..first.clone() }.states();
    assert_eq!(
        [damaged(""), damaged("12x"), damaged("0f"), damaged("99999999999999999999999f")],
        [const { None }; 4]
    );
    assert_eq!(damaged(&first.cells[1..]), None);
}

#[test]
fn lost_rays_show_nothing() {
    let boundary = Boundary::Circle { radius_m: 5.0 };
    let mut exploration = Exploration::new(&boundary, SCANNING);
    let scanner = Scanner::default();
    // Four rays in a row are lost, as happens now and then if rays are lost one by one.
    let ray = |n: u32| (!(180..184).contains(&n)).then_some(2.0);
    exploration.add(&scanner.scan((0..360).map(ray)), &Pose::new(0.0, 0.0, 0.0), 0.0);
    let ahead = |y: f64| exploration.is_free_at(Point::new(3.0, y));
    assert!(exploration.is_free_at(Point::new(1.5, 0.3)) && ![0.0, 0.05, 0.1, 0.15].into_iter().any(ahead));
    assert!((0.1..0.2).contains(&exploration.share()), "{}", exploration.share());
}

#[test]
fn the_floor_under_the_hull_is_free() {
    let mut exploration = Exploration::new(&Boundary::Circle { radius_m: 5.0 }, SCANNING);
    let ahead = Scanner { rays: 90, field_of_view_rad: 0.5 * std::f64::consts::PI, ..Scanner::default() };
    exploration.add(&ahead.scan((0..90).map(|_| Some(2.0))), &Pose::new(1.0, 0.0, 0.0), 0.0);
    let is_free = |x: f64| exploration.is_free_at(Point::new(x, 0.0));
    assert!(is_free(0.9) && is_free(1.5) && !is_free(0.6));
}

#[test]
fn the_hull_keeps_away_from_shapes_that_no_scan_shows() {
    let mut tank = Tank::new(5.0, &[], 1);
    let (exploration, _) = tank.explore();
    let zone = Shape::Disc { center: Point::new(2.0, 0.0), radius_m: 1.0 };
    let ways = exploration.ways(Point::origin(), ROOM_M, std::iter::once(&zone));
    let way = ways.to(Point::new(4.0, 0.0)).unwrap();
    let places = geometry::polyline::resampled(&way, 0.02);
    assert!(places.iter().all(|at| zone.distance_m(*at) >= ROOM_M), "{way:?}");
    assert!(ways.to(Point::new(2.0, 0.0)).is_none());
}
