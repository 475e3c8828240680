//! Determines which points of a scan the drawing explains.

use crate::{rays::Rays, uncertain::Uncertain};
use geometry::{
    Boundary, Point, Shape, Vector,
    polyline::{edges, nearest_on_segment},
    shape::ring_contains,
};
use nalgebra::{Matrix3, Vector3};
use world::Obstacle;

/// Number of standard deviations within which a point belongs to the drawing.
pub(crate) const GATE: f64 = 3.0;
/// A point is compared with a surface unless it is farther away than its gate by this distance, metres: rounding must not
/// decide.
const SPARE_M: f64 = 1e-6;
/// Largest squared distance of a corrected pose from the estimate, in squared standard deviations.
const MOST_CHI2: f64 = 30.0;
/// Number of rounds in which the pose is corrected with the points near the drawing.
const ROUNDS: usize = 3;

/// The relation of a point to the nearest surface of the drawing: its distance on the free side, metres, and the
/// direction away from the surface.
#[derive(Debug, Clone, Copy)]
struct Beside {
    distance_m: f64,
    away: Vector,
}

/// The parts of the drawing that a scan can show.
pub(crate) struct Drawing<'a> {
    pub boundary: &'a Boundary,
    /// The obstacles, each with a disc around it.
    pub obstacles: Vec<(&'a Obstacle, Point, f64)>,
}

impl<'a> Drawing<'a> {
    /// Collects the parts that are within reach of the rays.
    pub(crate) fn near(
        boundary: &'a Boundary,
        obstacles: impl Iterator<Item = &'a Obstacle>,
        eye: Point,
        reach_m: f64,
    ) -> Self {
        let around = |obstacle: &'a Obstacle| {
            let (center, radius_m) = disc_around(&obstacle.shape);
            ((center - eye).norm() - radius_m < reach_m).then_some((obstacle, center, radius_m))
        };
        Self { boundary, obstacles: obstacles.filter_map(around).collect() }
    }

    /// Finds, for each ray, the surface nearest to its point; `None` if the point is too far from every surface.
    fn beside(&self, rays: &Rays, pose: &Uncertain, buffers: &mut Buffers) {
        let Buffers { beside: found, gates_m } = buffers;
        found.clear();
        found.extend((0..rays.len()).map(|ray| {
            let beside = rays.range_m[ray].is_finite().then(|| self.beside_wall(rays.point(ray)))?;
            (beside.distance_m.abs() <= gates_m[ray]).then_some(beside)
        }));
        for (obstacle, center, radius_m) in &self.obstacles {
            let far_m = (center - rays.eye()).norm();
            for ray in rays.towards(*center, radius_m + pose.gate_m(far_m)) {
                let range_m = rays.range_m[ray];
                if !range_m.is_finite() || (range_m - far_m).abs() > radius_m + gates_m[ray] + SPARE_M {
                    continue;
                }
                let beside = beside_shape(&obstacle.shape, rays.point(ray));
                let best_m = found[ray].map_or(gates_m[ray], |best| best.distance_m.abs());
                if beside.distance_m.abs() <= best_m {
                    found[ray] = Some(beside);
                }
            }
        }
    }

    fn beside_wall(&self, point: Point) -> Beside {
        match self.boundary {
            Boundary::Circle { radius_m } => {
                let far = point.coords.norm();
                let away = if far > 0.0 { -point.coords / far } else { Vector::x() };
                Beside { distance_m: radius_m - far, away }
            }
            Boundary::Polygon { vertices } => beside_ring(vertices, point, ring_contains(vertices, point)),
        }
    }

    /// Corrects the pose so that the scan fits the drawing.
    pub(crate) fn correct(&self, rays: &mut Rays, pose: &Uncertain, buffers: &mut Buffers) -> Corrected {
        let Some(prior) = pose.information() else { return Corrected::not(pose) };
        gates(rays, pose, &mut buffers.gates_m);
        let mut corrected = Vector3::zeros();
        let mut information = prior;
        let mut points = 0;
        for _ in 0..ROUNDS {
            self.beside(rays, pose, buffers);
            let robot = rays.frame().translation.vector;
            let (mut normal, mut right) = (prior, -(prior * corrected));
            let weight = 1.0 / (pose.sigma_m * pose.sigma_m);
            points = buffers.beside.iter().flatten().count();
            for (ray, beside) in buffers.beside.iter().enumerate() {
                let Some(Beside { distance_m, away }) = beside else { continue };
                let arm = rays.point(ray).coords - robot;
                let slope = Vector3::new(away.x, away.y, away.y * arm.x - away.x * arm.y);
                normal += slope * slope.transpose() * weight;
                right -= slope * (weight * distance_m);
            }
            let Some(step) = normal.cholesky().map(|root| root.solve(&right)) else { break };
            if !step.iter().all(|x| x.is_finite()) {
                break;
            }
            rays.correct(&step);
            corrected += step;
            information = normal;
        }
        // A scan that fits only somewhere else was compared with the wrong surfaces.
        if (corrected.transpose() * prior * corrected)[(0, 0)] > MOST_CHI2 {
            rays.correct(&-corrected);
            return Corrected::not(pose);
        }
        Corrected {
            pose: pose.corrected(&information.try_inverse().unwrap_or_else(Matrix3::zeros)),
            by: corrected,
            prior,
            information,
            points,
        }
    }

    /// Determines, for each ray, whether the drawing explains it: the ray has no echo, or its point is on or behind the
    /// wall, or on or in an obstacle.
    pub(crate) fn explain(
        &self,
        rays: &Rays,
        pose: &Uncertain,
        buffers: &mut Buffers,
        explained: &mut Vec<bool>,
    ) {
        let gates_m = &mut buffers.gates_m;
        gates(rays, pose, gates_m);
        explained.clear();
        explained.extend((0..rays.len()).map(|ray| {
            !rays.range_m[ray].is_finite() || self.beside_wall(rays.point(ray)).distance_m <= gates_m[ray]
        }));
        for (obstacle, center, radius_m) in &self.obstacles {
            let far_m = (center - rays.eye()).norm();
            for ray in rays.towards(*center, radius_m + pose.gate_m(far_m + radius_m)) {
                let is_away = (rays.range_m[ray] - far_m).abs() > radius_m + gates_m[ray] + SPARE_M;
                explained[ray] = explained[ray]
                    || !is_away && beside_shape(&obstacle.shape, rays.point(ray)).distance_m <= gates_m[ray];
            }
        }
    }
}

/// A pose that was corrected by the drawing.
pub(crate) struct Corrected {
    /// The uncertainty that remains.
    pub pose: Uncertain,
    /// The correction of the pose: along x and y in metres, and a turn about the robot in radians.
    pub by: Vector3<f64>,
    /// The information about the pose before the correction, and after it.
    pub prior: Matrix3<f64>,
    pub information: Matrix3<f64>,
    /// Number of points that belong to something on the drawing.
    pub points: usize,
}

impl Corrected {
    /// A pose that nothing corrects.
    fn not(pose: &Uncertain) -> Self {
        let nothing = Matrix3::zeros();
        Self { pose: *pose, by: Vector3::zeros(), prior: nothing, information: nothing, points: 0 }
    }
}

/// Buffers that are kept from scan to scan.
#[derive(Debug, Clone, Default)]
pub(crate) struct Buffers {
    beside: Vec<Option<Beside>>,
    /// For each ray, the maximum distance of its point from the surface that it shows, metres.
    gates_m: Vec<f64>,
}

/// Computes the gate of each ray.
fn gates(rays: &Rays, pose: &Uncertain, gates_m: &mut Vec<f64>) {
    gates_m.clear();
    gates_m.extend(rays.range_m.iter().map(|range_m| pose.gate_m(*range_m)));
}

/// A disc around a shape.
pub(crate) fn disc_around(shape: &Shape) -> (Point, f64) {
    if let Shape::Disc { center, radius_m } = shape {
        return (*center, *radius_m);
    }
    let (low, high) = shape.bounds();
    (nalgebra::center(&low, &high), 0.5 * (high - low).norm())
}

fn beside_shape(shape: &Shape, point: Point) -> Beside {
    match shape {
        Shape::Disc { center, radius_m } => {
            let from = point - center;
            let far = from.norm();
            let away = if far > 0.0 { from / far } else { Vector::x() };
            Beside { distance_m: far - radius_m, away }
        }
        Shape::Polygon { vertices } => beside_ring(vertices, point, !ring_contains(vertices, point)),
        Shape::Polyline { points, half_width_m } => {
            let Beside { distance_m, away } =
                beside_nearest(points.windows(2).map(|w| (w[0], w[1])), point, true);
            Beside { distance_m: distance_m - half_width_m, away }
        }
    }
}

fn beside_ring(vertices: &[Point], point: Point, is_free: bool) -> Beside {
    beside_nearest(edges(vertices), point, is_free)
}

fn beside_nearest(edges: impl Iterator<Item = (Point, Point)>, point: Point, is_free: bool) -> Beside {
    let nearest = edges.map(|(a, b)| nearest_on_segment(a, b, point));
    let nearest = nearest.min_by(|a, b| (a - point).norm_squared().total_cmp(&(b - point).norm_squared()));
    let from = point - nearest.unwrap_or(point);
    let (far, side) = (from.norm(), if is_free { 1.0 } else { -1.0 });
    let away = if far > 1e-9 { from * (side / far) } else { Vector::zeros() };
    Beside { distance_m: side * far, away }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::{column, scan_of};
    use geometry::Pose;
    use world::{ObstacleId, Scanner};

    #[test]
    fn a_scan_corrects_the_pose_and_only_what_is_not_drawn_remains() {
        let boundary = Boundary::Circle { radius_m: 6.0 };
        let (drawn, found) = (column(1, 2.0, 1.0, 0.2), column(2, -1.5, 2.0, 0.15));
        let scanner = Scanner::default();
        let truth = Pose::new(0.5, -0.8, 0.3);
        let scan = scan_of(&scanner, &boundary, &[drawn.clone(), found.clone()], &truth, 4);
        let estimate = Pose::new(0.56, -0.87, 0.32);
        let mut rays = Rays::default();
        rays.take(&scan, &estimate.tank_from_robot());
        let covariance = Matrix3::from_diagonal(&Vector3::new(0.0036, 0.0036, 4e-4));
        let pose = Uncertain::estimated(0.02, &covariance);
        let drawing = Drawing::near(&boundary, [&drawn].into_iter(), estimate.position, 9.0);
        let mut buffers = Buffers::default();
        let left = drawing.correct(&mut rays, &pose, &mut buffers).pose;
        let off = rays.frame().translation.vector - truth.position.coords;
        assert!(off.norm() < 0.02, "{off}");
        assert!((rays.frame().rotation.angle() - 0.3).abs() < 0.01);
        let mut explained = Vec::new();
        drawing.explain(&rays, &left, &mut buffers, &mut explained);
        for ray in (0..rays.len()).filter(|ray| !explained[*ray]) {
            assert!(found.shape.distance_m(rays.point(ray)).abs() < 0.15, "{}", rays.point(ray));
        }
        assert!(explained.iter().filter(|is| !**is).count() >= 5);
        assert_eq!(drawn.id, ObstacleId(1));
    }

    /// The pose that a scan from (0.5, -0.8) shows to a robot whose estimate is somewhat off.
    fn matched_in(drawn: &[Obstacle]) -> crate::Matched {
        let boundary = Boundary::Circle { radius_m: 6.0 };
        let scan = scan_of(&Scanner::default(), &boundary, drawn, &Pose::new(0.5, -0.8, 0.3), 4);
        let estimate = Pose::new(0.56, -0.87, 0.32);
        let mut rays = Rays::default();
        rays.take(&scan, &estimate.tank_from_robot());
        let from = *rays.frame();
        let covariance = Matrix3::from_diagonal(&Vector3::new(0.0036, 0.0036, 4e-4));
        let pose = Uncertain::estimated(0.02, &covariance);
        let drawing = Drawing::near(&boundary, drawn.iter(), estimate.position, 9.0);
        let corrected = drawing.correct(&mut rays, &pose, &mut Buffers::default());
        crate::matching::matched(&from, &corrected, &world::Odometry::default()).unwrap()
    }

    #[test]
    fn a_scan_shows_the_pose_and_which_part_of_it_is_not_known() {
        let columns = [column(1, 2.0, 1.0, 0.2), column(2, -1.5, 2.0, 0.3), column(3, -2.0, -2.5, 0.3)];
        let crate::Matched { pose, covariance } = matched_in(&columns);
        let off = pose.position - Point::new(0.5, -0.8);
        assert!(off.norm() < 0.015 && (pose.heading_rad - 0.3).abs() < 0.01, "{pose:?}");
        assert!(covariance.diagonal().iter().all(|variance| *variance < 0.01), "{covariance}");
        // All headings look alike in an empty round tank; the distance from its middle does not.
        let crate::Matched { pose, covariance } = matched_in(&[]);
        let at = pose.position;
        let along = |way: Vector3<f64>| (way.transpose() * covariance * way)[(0, 0)] / way.norm_squared();
        assert!(along(Vector3::new(-at.y, at.x, 1.0)) > 1.0, "a turn about the middle: {covariance}");
        assert!(along(Vector3::new(at.x, at.y, 0.0)) < 0.02, "towards the middle: {covariance}");
    }
}
