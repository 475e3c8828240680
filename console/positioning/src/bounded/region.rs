//! Where annuli overlap: mean and covariance of the positions left.

use nalgebra::{Matrix2, SymmetricEigen};
use world::{Point, Vector};

/// How often the rings are linearised to strips again, each time about a better position.
const RELINEARISATIONS: usize = 3;
/// Cells along each axis of the box in which the region is summed up.
const CELLS: u32 = 16;
/// The same where no polygon says where the region is.
const SEARCH_CELLS: u32 = 64;
/// The box is this much larger than the polygon, because rings are bent.
const MARGIN: f64 = 1.2;

/// The distances from a station that its ranges allow.
#[derive(Debug, Clone, Copy)]
pub(super) struct Annulus {
    pub at: Point,
    pub inner_m: f64,
    pub outer_m: f64,
    pub repetitions: i32,
}

impl Annulus {
    pub(super) fn middle_m(&self) -> f64 {
        f64::midpoint(self.inner_m, self.outer_m)
    }

    pub(super) fn width_m(&self) -> f64 {
        self.outer_m - self.inner_m
    }
}

/// The positions left, as a distribution.
#[derive(Debug, Clone, Copy)]
pub(super) struct Region {
    pub mean: Point,
    pub covariance: Matrix2<f64>,
}

impl Region {
    /// The overlap of the annuli near a place; `None` if there is none.
    pub(super) fn around(annuli: &[Annulus], near: Point) -> Option<Self> {
        match polygon_around(annuli, near) {
            Some(strips) => {
                Frame::of(&strips).and_then(|frame| frame.summed(annuli, CELLS)).or_else(|| moments(&strips))
            }
            // Close to a station rings are bent too much for strips.
            None => Self::searched(annuli, near),
        }
    }

    fn searched(annuli: &[Annulus], near: Point) -> Option<Self> {
        let reach_m = 2.0 * annuli.iter().map(Annulus::width_m).fold(0.0, f64::max);
        let wide = Frame { middle: near, axes: Matrix2::identity(), half: Vector::repeat(reach_m) };
        let found = wide.summed(annuli, SEARCH_CELLS)?;
        let sigmas = found.covariance.diagonal().map(|v| 4.0 * v.max(0.0).sqrt());
        let half = sigmas + Vector::repeat(2.0 * reach_m / f64::from(SEARCH_CELLS));
        let close = Frame { middle: found.mean, axes: Matrix2::identity(), half };
        close.summed(annuli, SEARCH_CELLS).or(Some(found))
    }
}

/// The overlap with the rings straightened to strips.
fn polygon_around(annuli: &[Annulus], near: Point) -> Option<Vec<Point>> {
    let mut at = near;
    let mut polygon = Vec::new();
    for _ in 0..RELINEARISATIONS {
        polygon = strips_at(annuli, at)?;
        at = moments(&polygon)?.mean;
    }
    Some(polygon)
}

fn strips_at(annuli: &[Annulus], at: Point) -> Option<Vec<Point>> {
    let reach_m = 4.0 * annuli.iter().map(Annulus::width_m).fold(0.0, f64::max) + 1e-3;
    let corner = |x: f64, y: f64| at + Vector::new(x, y) * reach_m;
    let mut polygon = vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
    for annulus in annuli {
        let away = at - annulus.at;
        let distance_m = away.norm();
        let direction = away.try_normalize(1e-6)?;
        polygon = clipped(&polygon, at, direction, annulus.outer_m - distance_m);
        polygon = clipped(&polygon, at, -direction, distance_m - annulus.inner_m);
        if polygon.len() < 3 {
            return None;
        }
    }
    Some(polygon)
}

/// The part of a convex polygon with `normal . (p - at) <= limit_m`.
fn clipped(polygon: &[Point], at: Point, normal: Vector, limit_m: f64) -> Vec<Point> {
    let excess = |p: Point| normal.dot(&(p - at)) - limit_m;
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for (a, b) in polygon.iter().zip(polygon.iter().cycle().skip(1)) {
        let (over_a, over_b) = (excess(*a), excess(*b));
        if over_a <= 0.0 {
            kept.push(*a);
        }
        if (over_a < 0.0 && over_b > 0.0) || (over_a > 0.0 && over_b < 0.0) {
            kept.push(a + (b - a) * (over_a / (over_a - over_b)));
        }
    }
    kept
}

/// Centroid and second moments of a polygon's area; `None` if it has none.
fn moments(polygon: &[Point]) -> Option<Region> {
    let origin = *polygon.first()?;
    let (mut area, mut first, mut second) = (0.0, Vector::zeros(), Matrix2::zeros());
    for pair in polygon.windows(2).skip(1) {
        let (b, c) = (pair[0] - origin, pair[1] - origin);
        let part = b.perp(&c) / 2.0;
        area += part;
        first += (b + c) * (part / 3.0);
        let sum = b + c;
        second += (b * b.transpose() + c * c.transpose() + sum * sum.transpose()) * (part / 12.0);
    }
    let mean = first / area;
    let region = Region { mean: origin + mean, covariance: second / area - mean * mean.transpose() };
    let is_sound = area > 0.0 && region.mean.iter().chain(region.covariance.iter()).all(|n| n.is_finite());
    is_sound.then_some(region)
}

/// A box in which a region is summed up, along the region's own axes.
struct Frame {
    middle: Point,
    axes: Matrix2<f64>,
    half: Vector,
}

impl Frame {
    /// The box around a polygon.
    fn of(polygon: &[Point]) -> Option<Self> {
        let Region { mean, covariance } = moments(polygon)?;
        let axes = SymmetricEigen::new(covariance).eigenvectors;
        let along = |p: &Point| axes.transpose() * (p - mean);
        let low = polygon.iter().map(along).fold(Vector::repeat(f64::INFINITY), |a, b| a.inf(&b));
        let high = polygon.iter().map(along).fold(Vector::repeat(f64::NEG_INFINITY), |a, b| a.sup(&b));
        let middle = mean + axes * ((low + high) / 2.0);
        Some(Self { middle, axes, half: (high - low) * (MARGIN / 2.0) })
    }

    /// Mean and covariance of the positions within the box that every annulus holds, by midpoints of its cells.
    fn summed(&self, annuli: &[Annulus], cells: u32) -> Option<Region> {
        let node = |k: u32| (2.0 * f64::from(k) + 1.0) / f64::from(cells) - 1.0;
        let (mut mass, mut first, mut second) = (0.0, Vector::zeros(), Matrix2::zeros());
        for (i, j) in (0..cells).flat_map(|i| (0..cells).map(move |j| (i, j))) {
            let offset = self.axes * Vector::new(node(i), node(j)).component_mul(&self.half);
            let weight = weight_at(annuli, self.middle + offset);
            mass += weight;
            first += offset * weight;
            second += offset * offset.transpose() * weight;
        }
        let mean = first / mass;
        // Within its cell a position is anywhere.
        let cell = Matrix2::from_diagonal(&(self.half / f64::from(cells)).map(|h| h * h / 3.0));
        let within = self.axes * cell * self.axes.transpose();
        let region =
            Region { mean: self.middle + mean, covariance: second / mass - mean * mean.transpose() + within };
        let is_sound =
            mass > 0.0 && region.mean.iter().chain(region.covariance.iter()).all(|n| n.is_finite());
        is_sound.then_some(region)
    }
}

/// Likelihood of a position up to a factor near 1; 0 outside any annulus.
pub(super) fn weight_at(annuli: &[Annulus], position: Point) -> f64 {
    let mut weight = 1.0;
    for annulus in annuli {
        let distance_m = (position - annulus.at).norm();
        if !(annulus.inner_m..=annulus.outer_m).contains(&distance_m) {
            return 0.0;
        }
        weight *= (annulus.inner_m / distance_m).powi(annulus.repetitions);
    }
    weight
}
