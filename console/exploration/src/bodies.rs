//! Connected solid objects: discs where the points say so, else outlines.

use crate::{
    circle::{Circle, fit},
    survey::Exploration,
};
use geometry::{Point, Shape, shape::convex_hull};
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// Number of cells that a gap within one object may have: the hull cannot pass, and rays leave such gaps.
const GAP_CELLS: usize = 2;
/// Minimum number of echoes from an object; fewer may be noise.
const LEAST_HITS: f64 = 8.0;
/// Maximum radius of a column, metres.
const LARGEST_M: f64 = 3.0;
/// Largest angle at the centre of a disc that may not have been seen, radians.
const UNSEEN_RAD: f64 = 0.56 * TAU;
/// Number of sectors in which the mean distance from the circle is computed, and the largest root mean square of these
/// means for a disc: metres, and as a share of the radius. A square of edge 0.4 m has 0.024 m.
const SECTORS: usize = 16;
const ROUND: (f64, f64) = (0.012, 0.03);
/// Number of echoes from which a sector has its full weight.
const MANY_HITS: f64 = 20.0;
/// The part of the radius within which no scan goes through a disc, and the share of its cells that may seem free.
const MIDDLE: f64 = 0.6;
const HOLLOW: f64 = 0.2;
/// Minimum radius of a circle that can be hollow, metres: errors of the pose move rays through small columns.
const HOLLOW_M: f64 = 0.25;
/// Maximum distance between the pieces of a column of which only two opposite sides have been seen, metres.
const APART_M: f64 = 1.5;
/// Standard deviation of the mean error of the poses from which an object was seen, metres.
const POSE_M: f64 = 0.01;
/// Maximum extent of an object, metres, up to which its convex hull stands for it; longer ones are cut into tiles.
const TILE_M: f64 = 1.0;

/// A column.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Column {
    /// Its centre.
    pub center: Point,
    /// Its radius, metres.
    pub radius_m: f64,
    /// Standard deviation of the centre along its worse axis, metres.
    pub center_sigma_m: f64,
    /// Standard deviation of the radius, metres.
    pub radius_sigma_m: f64,
}

impl Column {
    /// The 95 % errors of the centre, along its worse axis, and of the radius, metres.
    pub fn errors_95_m(&self) -> [f64; 2] {
        [self.center_sigma_m, self.radius_sigma_m].map(|sigma_m| 1.96 * sigma_m)
    }

    /// The column as a shape.
    pub fn shape(&self) -> Shape {
        Shape::Disc { center: self.center, radius_m: self.radius_m }
    }
}

/// A connected solid object that scans have shown.
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    /// The column, if the points say that the object is a disc.
    pub column: Option<Column>,
    /// The circle that fits the points best, whether the object is a disc or not.
    pub(crate) circle: Option<Circle>,
    /// The points of its surface, each with its number of echoes.
    points: Vec<(Point, f64)>,
}

impl Body {
    /// The object as convex shapes: the disc, or the convex hull of its points; a long object is cut into tiles.
    pub fn shapes(&self) -> Vec<Shape> {
        if let Some(column) = &self.column {
            return vec![column.shape()];
        }
        let points: Vec<Point> = self.points.iter().map(|(at, _)| *at).collect();
        let (low, high) = geometry::shape::bounds_of(&points);
        let tiles = ((high - low) / TILE_M).map(|n| n.ceil().max(1.0));
        let tile = |at: &Point| {
            let share = |v: f64, low: f64, n: f64| ((v - low) / TILE_M).floor().clamp(0.0, n - 1.0) as usize;
            share(at.y, low.y, tiles.y) * tiles.x as usize + share(at.x, low.x, tiles.x)
        };
        let mut cut: Vec<Vec<Point>> = vec![Vec::new(); (tiles.x * tiles.y) as usize];
        for at in &points {
            cut[tile(at)].push(*at);
        }
        cut.into_iter().filter(|points| !points.is_empty()).map(|points| hull_of(&points)).collect()
    }

    pub(crate) fn bounds(&self) -> (Point, Point) {
        let points: Vec<Point> = self.points.iter().map(|(at, _)| *at).collect();
        geometry::shape::bounds_of(&points)
    }
}

impl Exploration {
    /// The objects that scans have shown, in the order of their cells; the wall is left out.
    ///
    /// A column of which only opposite sides have been seen is one object, not two.
    pub fn bodies(&self) -> Vec<Body> {
        let groups = self.groups();
        let is_real =
            |points: &Vec<(Point, f64)>| points.iter().map(|(_, hits)| hits).sum::<f64>() >= LEAST_HITS;
        let points = groups.iter().map(|cells| self.points_of(cells)).filter(is_real);
        self.joined(points.map(|points| self.body(points)).collect())
    }

    fn body(&self, points: Vec<(Point, f64)>) -> Body {
        let circle = fit(&points, self.scanning.sigma_m);
        let is_disc =
            |circle: &Circle| is_disc(&points, circle, self.scanning.sigma_m) && !self.is_hollow(circle);
        let column = circle.filter(is_disc).map(|circle| column(&circle));
        Body { column, circle, points }
    }

    /// Whether scans have gone through the middle of a circle: the points on it then belong to several objects, or to a
    /// wall.
    fn is_hollow(&self, circle: &Circle) -> bool {
        let reach_m = MIDDLE * circle.radius_m;
        let reach = geometry::Vector::repeat(reach_m);
        let cells = self.grid.within(circle.center - reach, circle.center + reach);
        let (mut n, mut free) = (0.0, 0.0);
        for cell in cells.filter(|cell| (self.grid.center(*cell) - circle.center).norm() <= reach_m) {
            n += 1.0;
            free += f64::from(u8::from(self.is_free(cell)));
        }
        circle.radius_m >= HOLLOW_M && free > HOLLOW * n
    }

    /// The columns that scans have shown.
    pub fn columns(&self) -> Vec<Column> {
        self.bodies().iter().filter_map(|body| body.column).collect()
    }

    /// The connected groups of solid cells.
    fn groups(&self) -> Vec<Vec<usize>> {
        let mut is_open: Vec<bool> =
            (0..self.grid.len()).map(|cell| self.is_floor[cell] && self.is_solid(cell)).collect();
        let mut groups = Vec::new();
        for first in 0..self.grid.len() {
            if !std::mem::replace(&mut is_open[first], false) {
                continue;
            }
            let mut cells = vec![first];
            let mut at = 0;
            while at < cells.len() {
                for next in self.grid.around(cells[at], GAP_CELLS) {
                    if std::mem::replace(&mut is_open[next], false) {
                        cells.push(next);
                    }
                }
                at += 1;
            }
            groups.push(cells);
        }
        groups
    }

    /// The mean places of the echoes in and beside some cells. Echoes that scatter into cells that are free count, too:
    /// without them, the surface would be too far back.
    fn points_of(&self, cells: &[usize]) -> Vec<(Point, f64)> {
        let mut all: Vec<usize> = cells.iter().flat_map(|cell| self.grid.around(*cell, 1)).collect();
        all.sort_unstable();
        all.dedup();
        let point = |cell: usize| {
            let evidence = &self.evidence[cell];
            let hits = f64::from(evidence.hits);
            let [x, y] = evidence.sum_m.map(|sum_m| f64::from(sum_m) / hits);
            (hits > 0.0).then(|| (self.grid.center(cell) + geometry::Vector::new(x, y), hits))
        };
        all.into_iter().filter(|cell| self.is_floor[*cell]).filter_map(point).collect()
    }

    /// The objects, with the pieces of one disc joined.
    fn joined(&self, mut bodies: Vec<Body>) -> Vec<Body> {
        let mut at = 0;
        while at < bodies.len() {
            let partner = (at + 1..bodies.len()).find_map(|other| {
                let whole = self.one_disc(&bodies[at], &bodies[other])?;
                Some((other, whole))
            });
            match partner {
                Some((other, whole)) => {
                    bodies[at] = whole;
                    bodies.remove(other);
                }
                None => at += 1,
            }
        }
        bodies
    }

    /// Two objects as one disc, if they are pieces of one: at least one of them is not a disc by itself, and all points
    /// lie on a circle.
    fn one_disc(&self, one: &Body, other: &Body) -> Option<Body> {
        if one.column.is_some() && other.column.is_some() {
            return None;
        }
        let ((low, high), (other_low, other_high)) = (one.bounds(), other.bounds());
        let gap = (other_low - high).sup(&(low - other_high)).max();
        if gap > APART_M {
            return None;
        }
        let points: Vec<_> = one.points.iter().chain(&other.points).copied().collect();
        let body = self.body(points);
        body.column.is_some().then_some(body)
    }
}

fn is_disc(points: &[(Point, f64)], circle: &Circle, noise_m: f64) -> bool {
    circle.radius_m <= LARGEST_M && circle.gap_rad <= UNSEEN_RAD && is_round(points, circle, noise_m)
}

/// Whether the mean distance from the circle is small in every sector, apart from what noise explains. The errors of the
/// poses are about as large as the noise of the scanner.
fn is_round(points: &[(Point, f64)], circle: &Circle, noise_m: f64) -> bool {
    let mut sectors = [(0.0, 0.0); SECTORS];
    for (at, weight) in points {
        let from = at - circle.center;
        let turn = (from.y.atan2(from.x) / TAU).rem_euclid(1.0);
        let sector = &mut sectors[((turn * SECTORS as f64) as usize).min(SECTORS - 1)];
        sector.0 += weight;
        sector.1 += weight * (from.norm() - circle.radius_m);
    }
    let seen = sectors.iter().filter(|(weight, _)| *weight > 0.0);
    let (n, squares) = seen.fold((0.0, 0.0), |(n, sum), (weight, off_m)| {
        let by_noise = (2.0 * noise_m).powi(2) / weight;
        // A few stray echoes say little about a sector.
        let counts = weight.min(MANY_HITS);
        (n + counts, sum + counts * ((off_m / weight).powi(2) - by_noise).max(0.0))
    });
    let (least_m, share) = ROUND;
    n > 0.0 && (squares / n).sqrt() <= least_m + share * circle.radius_m
}

fn column(circle: &Circle) -> Column {
    let with_pose = |sigma_m: f64| sigma_m.hypot(POSE_M);
    Column {
        center: circle.center,
        radius_m: circle.radius_m,
        center_sigma_m: with_pose(circle.sigma_m[0]),
        radius_sigma_m: with_pose(circle.sigma_m[1]),
    }
}

fn hull_of(points: &[Point]) -> Shape {
    let hull = convex_hull(points);
    if hull.len() >= 3 {
        return Shape::Polygon { vertices: hull };
    }
    // Too few points for an area: a small disc around them.
    let center = geometry::shape::mean_of(points);
    let radius_m = points.iter().map(|at| (at - center).norm()).fold(0.01, f64::max);
    Shape::Disc { center, radius_m }
}
