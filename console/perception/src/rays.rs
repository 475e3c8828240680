//! The rays of a scan in the tank frame.

use geometry::{Point, Vector};
use nalgebra::{Isometry2, UnitComplex};
use std::f64::consts::TAU;
use world::{NO_ECHO, Scan};

/// The distance of a ray that hit something too near to be measured, or the robot itself: the ray shows neither an
/// object nor free space.
pub(crate) const TOO_NEAR: f64 = f64::NEG_INFINITY;

/// The rays of a scan, as seen from an estimated pose. The buffers are reused for the next scan.
#[derive(Debug, Clone, Default)]
pub(crate) struct Rays {
    first_rad: f64,
    step_rad: f64,
    /// Directions in the robot frame; they are computed again only if the layout of the scans changes.
    in_robot: Vec<Vector>,
    /// Position of the sensor in the robot frame, metres.
    sensor: Vector,
    /// The transform from the robot frame at the time of the scan to the tank frame.
    tank_from_robot: Isometry2<f64>,
    /// What follows from this transform: the heading, radians, and, in the tank frame, the position of the sensor, the
    /// directions of the rays, and the points that they hit.
    heading_rad: f64,
    eye: Point,
    directions: Vec<Vector>,
    points: Vec<Point>,
    /// Distances, metres; infinite without an echo, and [`TOO_NEAR`] for an echo from a place that is not known.
    pub range_m: Vec<f64>,
}

impl Rays {
    /// Takes a scan. The given pose is that of the robot at the end of the readings, which may be later than the scan.
    pub(crate) fn take(&mut self, scan: &Scan, tank_from_robot: &Isometry2<f64>) {
        let n = scan.ranges_mm.0.len();
        let layout = (scan.first_rad, scan.step_rad);
        if self.in_robot.len() != n || layout != (self.first_rad, self.step_rad) {
            (self.first_rad, self.step_rad) = layout;
            let direction = |k: usize| geometry::unit_vector(scan.first_rad + k as f64 * scan.step_rad);
            self.in_robot.clear();
            self.in_robot.extend((0..n).map(direction));
        }
        self.sensor = Vector::from(scan.sensor_m);
        let moved = Vector::new(scan.since.forward_m, scan.since.sideways_m);
        let since = Isometry2::new(moved, scan.since.turn_rad);
        self.tank_from_robot = tank_from_robot * since.inverse();
        let metres = |mm: &u16| match *mm {
            NO_ECHO => f64::INFINITY,
            0 => TOO_NEAR,
            mm => f64::from(mm) / 1000.0,
        };
        self.range_m.clear();
        self.range_m.extend(scan.ranges_mm.0.iter().map(metres));
        self.place();
    }

    /// Computes what follows from the pose.
    fn place(&mut self) {
        let turn = self.tank_from_robot.rotation;
        self.heading_rad = turn.angle();
        let eye = self.tank_from_robot * Point::from(self.sensor);
        self.eye = eye;
        self.directions.clear();
        self.directions.extend(self.in_robot.iter().map(|direction| turn * direction));
        self.points.clear();
        let rays = self.directions.iter().zip(&self.range_m);
        self.points.extend(rays.map(|(direction, range_m)| eye + direction * *range_m));
    }

    /// Ignores echoes from inside the hull, a disc with this radius in metres.
    pub(crate) fn ignore_hull(&mut self, hull_m: f64) {
        for (range_m, direction) in self.range_m.iter_mut().zip(&self.in_robot) {
            if range_m.is_finite() && (self.sensor + direction * *range_m).norm() < hull_m {
                *range_m = TOO_NEAR;
            }
        }
    }

    /// Moves the pose from which the scan was made by a small correction: along x and y in metres, and a turn about the
    /// robot in radians.
    pub(crate) fn correct(&mut self, by: &nalgebra::Vector3<f64>) {
        let place = self.tank_from_robot.translation.vector + Vector::new(by.x, by.y);
        let turn = self.tank_from_robot.rotation * UnitComplex::new(by.z);
        self.tank_from_robot = Isometry2::from_parts(place.into(), turn);
        self.place();
    }

    /// The transform from the robot frame at the time of the scan to the tank frame.
    pub(crate) fn frame(&self) -> &Isometry2<f64> {
        &self.tank_from_robot
    }

    /// Number of rays.
    pub(crate) fn len(&self) -> usize {
        self.range_m.len()
    }

    /// Whether the rays go all around.
    pub(crate) fn is_round(&self) -> bool {
        world::scan::is_round(self.len(), self.step_rad)
    }

    /// Angle between neighbouring rays, radians.
    pub(crate) fn step_rad(&self) -> f64 {
        self.step_rad.abs()
    }

    /// Direction of a ray in the robot frame.
    pub(crate) fn in_robot(&self, ray: usize) -> Vector {
        self.in_robot[ray]
    }

    /// Position of the sensor in the robot frame, metres.
    pub(crate) fn sensor(&self) -> Vector {
        self.sensor
    }

    /// The ray nearest to a direction in the robot frame; `None` if the direction is outside the field of view.
    pub(crate) fn nearest(&self, direction: Vector) -> Option<usize> {
        let angle_rad = direction.y.atan2(direction.x) - self.first_rad;
        let around = TAU / self.step_rad.abs();
        let ray = (angle_rad / self.step_rad).rem_euclid(around).round();
        let ray = if self.is_round() { ray.rem_euclid(around.round()) } else { ray };
        (ray < self.len() as f64).then_some(ray as usize)
    }

    /// Position of the sensor in the tank.
    pub(crate) fn eye(&self) -> Point {
        self.eye
    }

    /// Direction of a ray in the tank.
    pub(crate) fn direction(&self, ray: usize) -> Vector {
        self.directions[ray]
    }

    /// The point that a ray hit; only for rays with an echo.
    pub(crate) fn point(&self, ray: usize) -> Point {
        self.points[ray]
    }

    /// The direction halfway between a ray and the previous one, tank frame.
    pub(crate) fn before(&self, ray: usize) -> Vector {
        let half = UnitComplex::new(-0.5 * self.step_rad);
        half * self.direction(ray)
    }

    /// The direction halfway between a ray and the next one, tank frame.
    pub(crate) fn after(&self, ray: usize) -> Vector {
        let half = UnitComplex::new(0.5 * self.step_rad);
        half * self.direction(ray)
    }

    /// Whether the rays run counter-clockwise.
    pub(crate) fn is_counter_clockwise(&self) -> bool {
        self.step_rad > 0.0
    }

    /// The ray that is `by` rays after this one in the order of the scan; `None` beyond the end of a scan that is not
    /// all around.
    pub(crate) fn neighbour(&self, ray: usize, by: isize) -> Option<usize> {
        let n = self.len() as isize;
        let next = ray as isize + by;
        let next = if self.is_round() { next.rem_euclid(n.max(1)) } else { next };
        (0..n).contains(&next).then_some(next as usize)
    }

    /// The rays towards a disc, in the order of the scan; all rays if the sensor is inside the disc.
    pub(crate) fn towards(&self, center: Point, radius_m: f64) -> impl Iterator<Item = usize> + use<> {
        let to = center - self.eye();
        let far = to.norm();
        let half_rad = if far > radius_m { (radius_m / far).asin() } else { TAU };
        let n = self.len() as f64;
        let around = TAU / self.step_rad();
        let bearing_rad = to.y.atan2(to.x) - self.heading_rad - self.first_rad;
        let half = (half_rad / self.step_rad()).min(0.5 * around);
        let from = (bearing_rad / self.step_rad - half).rem_euclid(around);
        let part = move |from: f64| {
            let (low, high) = (from.ceil().max(0.0), (from + 2.0 * half).floor().min(n - 1.0));
            let count = if high >= low { (high - low) as usize + 1 } else { 0 };
            (0..count).map(move |k| low as usize + k)
        };
        // A disc in the direction in which the scan begins and ends is hit by the last and the first rays.
        let last = (from + 2.0 * half - around).floor().min(n - 1.0);
        let wrapped = if last >= 0.0 { last as usize + 1 } else { 0 };
        part(from).filter(move |ray| *ray >= wrapped).chain(0..wrapped)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::Pose;
    use world::Scanner;

    fn rays(scanner: &Scanner, pose: &Pose) -> Rays {
        let mut rays = Rays::default();
        let scan = scanner.scan((0..scanner.rays).map(|_| Some(2.0)));
        rays.take(&scan, &pose.tank_from_robot());
        rays
    }

    #[test]
    fn the_rays_towards_a_disc_are_those_that_meet_it() {
        let partly = Scanner { rays: 90, field_of_view_rad: 4.0, heading_rad: 1.0, ..Scanner::default() };
        for scanner in [Scanner::default(), partly, Scanner { rays: 7, ..Scanner::default() }] {
            let rays = rays(&scanner, &Pose::new(1.0, -2.0, 2.0));
            for k in 0..40 {
                let center = rays.eye() + geometry::unit_vector(f64::from(k) * 0.37) * 1.5;
                for radius_m in [0.1, 0.7, 1.4, 1.6] {
                    let meets = |ray: &usize| {
                        let (to, way) = (center - rays.eye(), rays.direction(*ray));
                        to.norm() < radius_m || (way.dot(&to) > 0.0 && way.perp(&to).abs() <= radius_m)
                    };
                    let wanted: Vec<usize> = (0..rays.len()).filter(meets).collect();
                    let mut found: Vec<usize> = rays.towards(center, radius_m).collect();
                    let starts = found.windows(2).filter(|pair| pair[1] != pair[0] + 1).count();
                    assert!(starts <= 1, "in order: {found:?}");
                    found.sort_unstable();
                    assert_eq!(found, wanted, "{k} {radius_m}");
                }
            }
        }
    }

    #[test]
    fn every_ray_is_the_nearest_to_its_own_direction() {
        let partly = Scanner { rays: 90, field_of_view_rad: 4.0, heading_rad: 1.0, ..Scanner::default() };
        for scanner in [Scanner::default(), partly] {
            let rays = rays(&scanner, &Pose::new(1.0, -2.0, 2.0));
            assert!((0..rays.len()).all(|ray| rays.nearest(rays.in_robot(ray)) == Some(ray)), "{scanner:?}");
        }
        let behind = rays(&partly, &Pose::new(0.0, 0.0, 0.0)).nearest(geometry::unit_vector(1.0 + 3.1));
        assert_eq!(behind, None);
    }

    #[test]
    fn points_are_placed_before_the_motion_since_the_scan() {
        let scanner = Scanner { rays: 4, offset_m: [0.5, 0.0], ..Scanner::default() };
        let mut scan = scanner.scan([None, None, Some(2.0), None].into_iter());
        scan.since.forward_m = 0.25;
        let mut rays = Rays::default();
        rays.take(&scan, &Pose::new(1.0, 0.0, 0.0).tank_from_robot());
        assert!((rays.point(2) - Point::new(3.25, 0.0)).norm() < 1e-12);
        rays.correct(&nalgebra::Vector3::new(0.0, 0.1, 0.0));
        assert!((rays.point(2) - Point::new(3.25, 0.1)).norm() < 1e-12);
    }
}
