//! Fits a disc to the points of one view.
//!
//! An algebraic fit to the points alone is biased towards small discs when only an arc of a column is seen. The edges
//! determine the radius better: each edge of the column lies between the outermost ray that hits the column and the
//! next ray, which passes it.

use crate::rays::Rays;
use geometry::{Point, Vector};
use nalgebra::{Matrix2, Matrix3, Vector3};

/// Number of steps in the search for the best disc.
const STEPS: usize = 4;
/// Standard deviation of an unknown radius, metres.
const ANY_RADIUS_M: f64 = 0.5;
/// Smallest and largest radius of a disc, metres.
const RADII_M: (f64, f64) = (0.01, 2.0);
/// Standard deviation of an edge, as a share of the angle between two rays: the edge can be anywhere between them.
const EDGE_SIGMA: f64 = 0.29;
/// The same standard deviation if the next ray has no echo, because that ray may have been lost.
const LOOSE_EDGE_SIGMA: f64 = 0.6;

/// A radius with its variance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Radius {
    pub mean_m: f64,
    pub variance_m2: f64,
}

impl Radius {
    /// Combines this radius with `after`, the radius that follows from it and one view, so that only a share of the
    /// information from that view counts.
    pub(crate) fn with_share(&self, after: &Self, share: f64) -> Self {
        let before = 1.0 / self.variance_m2;
        let view = (1.0 / after.variance_m2 - before).max(0.0);
        let (information, all) = (before + share * view, before + view);
        // The mean moves in proportion to the share that the view contributes to all information.
        let moved_m = (after.mean_m - self.mean_m) * share * all / information;
        Self { mean_m: self.mean_m + moved_m, variance_m2: 1.0 / information }
    }
}

/// A disc as seen in one view, tank frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Fit {
    pub center: Point,
    /// Covariance of the centre due to the errors of the distances.
    pub covariance: Matrix2<f64>,
    pub radius: Radius,
    /// Mean of the squared deviations, each divided by its variance; about 1 for a disc.
    pub misfit: f64,
}

/// An edge of a disc: the direction of a line from the sensor that touches the disc, and the side of that line on which
/// the centre lies.
#[derive(Debug, Clone, Copy)]
struct Edge {
    direction: Vector,
    side: f64,
    sigma_rad: f64,
}

/// Fits a disc to points in the order of the scan. `before` is the radius as known before this view.
pub(crate) fn fit(rays: &Rays, of: &[usize], sigma_m: f64, before: Option<Radius>) -> Option<Fit> {
    let edges = edges(rays, of, sigma_m);
    let eye = rays.eye();
    let mut at = start(rays, of, before);
    let known = before.unwrap_or(Radius { mean_m: at.z, variance_m2: ANY_RADIUS_M * ANY_RADIUS_M });
    let mut information = Matrix3::zeros();
    let mut squares = 0.0;
    for _ in 0..STEPS {
        // The position of the centre is unknown; a little information keeps the equations regular.
        information = Matrix3::from_diagonal(&Vector3::new(1e-2, 1e-2, 1.0 / known.variance_m2));
        let mut right = Vector3::new(0.0, 0.0, (known.mean_m - at.z) / known.variance_m2);
        squares = 0.0;
        let mut add = |deviation: f64, slope: Vector3<f64>, sigma: f64| {
            let weight = 1.0 / (sigma * sigma);
            information += slope * slope.transpose() * weight;
            right -= slope * (deviation * weight);
            squares += deviation * deviation * weight;
        };
        for ray in of {
            let from = rays.point(*ray) - Point::new(at.x, at.y);
            let far = from.norm().max(1e-9);
            add(far - at.z, Vector3::new(-from.x / far, -from.y / far, -1.0), sigma_m);
        }
        for edge in edges.iter().flatten() {
            let to = Point::new(at.x, at.y) - eye;
            let aside = edge.side * edge.direction.perp(&to);
            let slope = Vector3::new(-edge.side * edge.direction.y, edge.side * edge.direction.x, -1.0);
            add(aside - at.z, slope, (to.norm() * edge.sigma_rad).max(1e-3));
        }
        let step = information.cholesky()?.solve(&right);
        at += step;
        at.z = at.z.clamp(RADII_M.0, RADII_M.1);
    }
    let covariance = information.try_inverse()?;
    let terms = of.len() + edges.iter().flatten().count();
    let misfit = squares / (terms as f64 - 1.5).max(1.0);
    let fit = Fit {
        center: Point::new(at.x, at.y),
        covariance: covariance.fixed_view::<2, 2>(0, 0).into_owned(),
        radius: Radius { mean_m: at.z, variance_m2: covariance[(2, 2)] },
        misfit,
    };
    at.iter().chain(covariance.iter()).all(|x| x.is_finite()).then_some(fit)
}

/// The first guess of a disc: in the middle of the rays, touched by the two outermost rays, and as far away as the
/// nearest point.
fn start(rays: &Rays, of: &[usize], before: Option<Radius>) -> Vector3<f64> {
    let (first, last) = (rays.direction(of[0]), rays.direction(of[of.len() - 1]));
    let nearest_m = of.iter().map(|ray| rays.range_m[*ray]).fold(f64::INFINITY, f64::min);
    let half_rad = 0.5 * (first.perp(&last).atan2(first.dot(&last)).abs() + rays.step_rad());
    let sin = half_rad.sin().clamp(1e-3, 0.8);
    let radius_m = before.map_or(nearest_m * sin / (1.0 - sin), |before| before.mean_m);
    let radius_m = radius_m.clamp(RADII_M.0, RADII_M.1);
    let middle = geometry::pose::direction_or(first + last, first);
    let center = rays.eye() + middle * (nearest_m + radius_m);
    Vector3::new(center.x, center.y, radius_m)
}

/// The edges that the scan shows: an edge is visible if the ray beside it passes the disc.
fn edges(rays: &Rays, of: &[usize], sigma_m: f64) -> [Option<Edge>; 2] {
    let (first, last) = (of[0], of[of.len() - 1]);
    let turn = if rays.is_counter_clockwise() { 1.0 } else { -1.0 };
    let edge = |ray: usize, by: isize, direction: Vector, side: f64| {
        let beside_m = rays.range_m[rays.neighbour(ray, by)?];
        let sigma = if beside_m.is_finite() { EDGE_SIGMA } else { LOOSE_EDGE_SIGMA };
        let goes_past = beside_m > rays.range_m[ray] + 5.0 * sigma_m;
        goes_past.then(|| Edge { direction, side, sigma_rad: sigma * rays.step_rad() })
    };
    [edge(first, -1, rays.before(first), turn), edge(last, 1, rays.after(last), -turn)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::{column, scan_of};
    use geometry::{Boundary, Pose};
    use world::Scanner;

    fn fits(radius_m: f64, far_m: f64) -> Vec<Fit> {
        let (scanner, column) = (Scanner::default(), column(1, far_m, 0.0, radius_m));
        let of = |seed: u32| {
            let pose = Pose::new(0.0, 0.0, f64::from(seed) * 0.013);
            let scan = scan_of(
                &scanner,
                &Boundary::Circle { radius_m: 60.0 },
                std::slice::from_ref(&column),
                &pose,
                u64::from(seed),
            );
            let mut rays = Rays::default();
            rays.take(&scan, &pose.tank_from_robot());
            let hits: Vec<usize> = rays
                .towards(Point::new(far_m, 0.0), radius_m)
                .filter(|ray| rays.range_m[*ray].is_finite())
                .collect();
            fit(&rays, &hits, scanner.sigma_m, None).unwrap()
        };
        (0..200).map(of).collect()
    }

    #[test]
    fn discs_are_fitted_without_bias_and_as_well_as_stated() {
        for (radius_m, far_m) in [(0.1, 1.0), (0.1, 2.5), (0.2, 2.0), (0.3, 4.0), (0.5, 1.5)] {
            let fits = fits(radius_m, far_m);
            let n = fits.len() as f64;
            let off: Vector = fits.iter().map(|fit| fit.center - Point::new(far_m, 0.0)).sum::<Vector>() / n;
            let larger_m = fits.iter().map(|fit| fit.radius.mean_m - radius_m).sum::<f64>() / n;
            assert!(off.norm() < 0.015 && larger_m.abs() < 0.015, "{radius_m} {far_m}: {off} {larger_m}");
            let square = |fit: &Fit| (fit.radius.mean_m - radius_m).powi(2) / fit.radius.variance_m2;
            let scatter = fits.iter().map(square).sum::<f64>() / n;
            assert!((0.2..2.5).contains(&scatter), "{radius_m} {far_m}: {scatter}");
        }
    }

    #[test]
    fn a_flat_side_is_no_disc() {
        let corner = |x: f64, y: f64| Point::new(x, y);
        let vertices = vec![corner(1.0, -0.3), corner(1.6, -0.3), corner(1.6, 0.3), corner(1.0, 0.3)];
        let crate_ =
            world::Obstacle { shape: geometry::Shape::Polygon { vertices }, ..column(1, 0.0, 0.0, 0.1) };
        let scanner = Scanner::default();
        let scan =
            scan_of(&scanner, &Boundary::Circle { radius_m: 60.0 }, &[crate_], &Pose::new(0.0, 0.0, 0.0), 1);
        let mut rays = Rays::default();
        rays.take(&scan, &nalgebra::Isometry2::identity());
        let hits: Vec<usize> = (0..rays.len()).filter(|ray| rays.range_m[*ray].is_finite()).collect();
        assert!(fit(&rays, &hits, 0.02, None).unwrap().misfit > 3.0);
        assert!(fits(0.2, 1.5).iter().map(|fit| fit.misfit).sum::<f64>() / 200.0 < 1.6);
    }
}
