//! Tests with whole scans, from the first scan to obstacles on the chart.

mod many;
mod moving;
mod wrong;

use super::*;
use geometry::{Boundary, Point, Pose, Shape};
use nalgebra::{Matrix3, Vector3};
use world::{Obstacle, ObstacleId, ObstacleMap, Scan, Scanner};

/// A column.
pub(crate) fn column(id: u32, x: f64, y: f64, radius_m: f64) -> Obstacle {
    let shape = Shape::Disc { center: Point::new(x, y), radius_m };
    Obstacle { id: ObstacleId(id), name: format!("C{id}"), shape, known: true }
}

/// A generator of pseudo-random numbers, uniform from 0 to 1.
struct Noise(u64);

impl Noise {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) as f64) / f64::from(1_u32 << 31)
    }

    /// A number that is nearly normally distributed: the sum of twelve uniform numbers.
    fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.next()).sum::<f64>() - 6.0
    }
}

/// Simulates the scan of a scanner.
pub(crate) fn scan_of(
    scanner: &Scanner,
    boundary: &Boundary,
    obstacles: &[Obstacle],
    pose: &Pose,
    seed: u64,
) -> Scan {
    let map = ObstacleMap::new(boundary, obstacles);
    let mut noise = Noise(seed.wrapping_mul(77_777).wrapping_add(1));
    let eye = scanner.pose(pose).position;
    let ray = |n: u32| {
        let angle = pose.heading_rad + scanner.first_rad() + f64::from(n) * scanner.step_rad();
        let direction = geometry::unit_vector(angle);
        let hit_m =
            map.ray_m(eye, direction, 60.0).unwrap_or(f64::INFINITY).min(boundary.ray_m(eye, direction));
        let (error_m, is_lost) = (scanner.sigma_m * noise.normal(), noise.next() < scanner.lost_share);
        (!is_lost).then_some(hit_m + error_m)
    };
    scanner.scan((0..scanner.rays).map(ray))
}

/// A robot that scans while it drives.
struct Drive {
    boundary: Boundary,
    /// The obstacles that are in the tank, and those on the drawing.
    real: Vec<Obstacle>,
    drawn: Vec<Obstacle>,
    scanner: Scanner,
    perception: Perception,
    tick: u64,
    looked: Looked,
}

impl Drive {
    fn new(real: Vec<Obstacle>, drawn: Vec<Obstacle>) -> Self {
        let scanner = Scanner::default();
        let perception = Perception::new(Sensor::of(&scanner));
        let boundary = Boundary::Circle { radius_m: 6.0 };
        Self { boundary, real, drawn, scanner, perception, tick: 0, looked: Looked::default() }
    }

    /// Processes one scan; the estimated pose has an error of a few centimetres.
    fn scan(&mut self, pose: &Pose) {
        let scan = scan_of(&self.scanner, &self.boundary, &self.real, pose, self.tick);
        self.take(&scan, pose);
    }

    fn take(&mut self, scan: &Scan, pose: &Pose) {
        let wave = (self.tick as f64 * 0.05).sin();
        let estimate = Pose::new(
            pose.position.x + 0.04 * wave,
            pose.position.y - 0.03 * wave,
            pose.heading_rad + 0.01 * wave,
        );
        let map = ObstacleMap::new(&self.boundary, &self.drawn);
        let view = View {
            now_s: self.tick as f64 * 0.1,
            scan,
            pose: estimate,
            covariance: Matrix3::from_diagonal(&Vector3::new(0.0016, 0.0016, 2e-4)),
            boundary: &self.boundary,
            charted: &self.drawn,
            map: &map,
            hull_m: 0.2,
            reach_m: 4.0,
        };
        let looked = self.perception.look(&view);
        self.looked.not_there.extend(looked.not_there);
        self.tick += 1;
    }

    /// Drives along a straight line.
    fn along(&mut self, from: (f64, f64), to: (f64, f64), ticks: u32) {
        for k in 0..ticks {
            let share = f64::from(k) / f64::from(ticks);
            let at = |a: f64, b: f64| a + share * (b - a);
            let heading_rad = (to.1 - from.1).atan2(to.0 - from.0);
            self.scan(&Pose::new(at(from.0, to.0), at(from.1, to.1), heading_rad));
        }
    }

    fn shapes(&self) -> Vec<Shape> {
        self.perception.seen(&Pose::new(0.0, 0.0, 0.0)).map(|seen| seen.shape).collect()
    }
}

#[test]
fn columns_that_are_not_drawn_are_found_where_they_are() {
    let drawn = vec![column(1, 2.0, 2.0, 0.2), column(2, -3.0, 0.0, 0.25)];
    let hidden = [column(3, 0.5, -2.5, 0.12), column(4, 3.5, -0.5, 0.2), column(5, -0.6, 3.0, 0.15)];
    let mut drive = Drive::new(drawn.iter().chain(&hidden).cloned().collect(), drawn);
    drive.along((-1.0, -4.0), (2.0, 1.0), 150);
    let found = drive.shapes();
    assert_eq!(found.len(), 3, "{found:?}");
    for obstacle in &hidden {
        let Shape::Disc { center, radius_m } = obstacle.shape else { panic!() };
        let is_it = |shape: &Shape| match shape {
            Shape::Disc { center: c, radius_m: r } => {
                (c - center).norm() < 0.03 && (r - radius_m).abs() < 0.02
            }
            _ => false,
        };
        assert!(found.iter().any(is_it), "{} in {found:?}", obstacle.name);
    }
    assert_eq!((drive.perception.trouble(), drive.looked), (None, Looked::default()));
}

#[test]
fn a_crate_is_an_outline_and_no_disc() {
    let corner = |x: f64, y: f64| Point::new(x, y);
    let vertices = vec![corner(1.0, -0.4), corner(1.8, -0.4), corner(1.8, 0.4), corner(1.0, 0.4)];
    let mut real = vec![column(1, -3.0, 0.0, 0.25)];
    let drawn = real.clone();
    real.push(Obstacle { shape: Shape::Polygon { vertices }, ..column(2, 0.0, 0.0, 0.1) });
    let mut drive = Drive::new(real.clone(), drawn);
    drive.along((-1.0, -2.0), (3.2, -1.6), 100);
    drive.along((3.2, -1.6), (3.0, 2.0), 100);
    let found = drive.shapes();
    let [Shape::Polygon { vertices }] = &found[..] else { panic!("{found:?}") };
    assert!(vertices.iter().all(|corner| real[1].shape.distance_m(*corner).abs() < 0.12), "{vertices:?}");
    let area_m2 = geometry::shape::ring_area_m2(vertices).abs();
    assert!((0.5..0.95).contains(&area_m2), "{area_m2}");
}

#[test]
fn a_drawn_column_that_is_not_there_is_reported_once() {
    let drawn = vec![column(1, 2.0, 2.0, 0.2), column(2, 0.0, 0.0, 0.25)];
    let mut drive = Drive::new(vec![drawn[0].clone()], drawn);
    drive.along((-2.0, -2.0), (2.0, -2.0), 120);
    assert_eq!(drive.looked, Looked { not_there: vec![(ObstacleId(2), 40)] });
    assert!(drive.shapes().is_empty());
}

#[test]
fn what_has_been_removed_is_gone() {
    let mut drive = Drive::new(vec![column(7, 1.0, 1.0, 0.2)], Vec::new());
    drive.along((-2.0, 0.0), (0.0, 0.0), 60);
    assert_eq!(drive.shapes().len(), 1);
    drive.real.clear();
    drive.along((0.0, 0.0), (0.0, 2.0), 60);
    assert_eq!(drive.looked, Looked { not_there: vec![(ObstacleId(FIRST_ID), 20)] });
    assert_eq!(drive.perception.tracks(), 0);
    // What is back at a place on the chart is the same obstacle.
    drive.drawn = vec![column(FIRST_ID, 1.0, 1.0, 0.2)];
    drive.real = vec![column(7, 1.0, 1.0, 0.2)];
    drive.along((0.0, 2.0), (0.0, 0.0), 40);
    let ids: Vec<_> = drive.perception.seen(&Pose::new(0.0, 0.0, 0.0)).map(|seen| seen.id).collect();
    assert_eq!(ids, [ObstacleId(FIRST_ID)]);
}
