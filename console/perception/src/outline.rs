//! The outline of an object that is not a disc. The outline is convex, and grows with every view.

use geometry::{Point, Shape};

/// Maximum number of corners.
const MOST_CORNERS: usize = 24;
/// Thickness, metres, below which an outline is a wall or a pipe.
const THIN_M: f64 = 0.12;
/// Maximum extent of an outline, metres; an object that is larger becomes several obstacles.
const LARGEST_M: f64 = 1.6;

/// The convex outline of the points seen so far, counter-clockwise.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Outline(Vec<Point>);

impl Outline {
    /// Adds a point unless it lies inside the outline or within `noise_m` metres of it.
    pub(crate) fn add(&mut self, point: Point, noise_m: f64) {
        if self.0.len() >= 3 && self.distance_m(point) <= noise_m {
            return;
        }
        if self.0.iter().any(|corner| (corner - point).norm() > LARGEST_M) {
            return;
        }
        self.0.push(point);
        self.0 = hull(&mut self.0);
        while self.0.len() > MOST_CORNERS {
            let flattest = (0..self.0.len()).min_by(|a, b| self.height_m2(*a).total_cmp(&self.height_m2(*b)));
            self.0.remove(flattest.unwrap_or(0));
        }
    }

    /// Distance of a point from the outline, metres; negative inside.
    fn distance_m(&self, point: Point) -> f64 {
        Shape::<&[Point]>::Polygon { vertices: &self.0[..] }.distance_m(point)
    }

    /// Twice the area of the triangle between a corner and its neighbours.
    fn height_m2(&self, corner: usize) -> f64 {
        let n = self.0.len();
        let (a, b, c) = (self.0[(corner + n - 1) % n], self.0[corner], self.0[(corner + 1) % n]);
        (b - a).perp(&(c - a)).abs()
    }

    /// Returns the outline as a shape: a polygon or, if it is thin, a line with a thickness; `None` if there are too
    /// few points.
    pub(crate) fn shape(&self) -> Option<Shape> {
        let (a, b) = self.ends()?;
        let along = geometry::pose::direction_or(b - a, geometry::Vector::x());
        let aside = |point: &Point| along.perp(&(point - a));
        let low = self.0.iter().map(aside).fold(f64::INFINITY, f64::min);
        let high = self.0.iter().map(aside).fold(f64::NEG_INFINITY, f64::max);
        if high - low > THIN_M && self.0.len() >= 3 {
            return Some(Shape::Polygon { vertices: self.0.clone() });
        }
        let middle = geometry::Vector::new(-along.y, along.x) * (0.5 * (low + high));
        let half_width_m = (0.5 * (high - low)).max(0.01);
        Some(Shape::Polyline { points: vec![a + middle, b + middle], half_width_m })
    }

    /// The two corners that are farthest apart.
    fn ends(&self) -> Option<(Point, Point)> {
        let pairs =
            self.0.iter().enumerate().flat_map(|(k, a)| self.0[k + 1..].iter().map(move |b| (*a, *b)));
        pairs.max_by(|(a, b), (c, d)| (a - b).norm_squared().total_cmp(&(c - d).norm_squared()))
    }

    /// Largest extent, metres.
    pub(crate) fn extent_m(&self) -> f64 {
        self.ends().map_or(0.0, |(a, b)| (a - b).norm())
    }

    /// Forgets all points.
    pub(crate) fn clear(&mut self) {
        self.0.clear();
    }

    /// Whether a point is inside the outline.
    #[cfg(test)]
    fn contains(&self, point: Point) -> bool {
        self.distance_m(point) <= 1e-9
    }
}

/// The convex hull of some points, counter-clockwise.
fn hull(points: &mut [Point]) -> Vec<Point> {
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    let half = |points: &mut dyn Iterator<Item = &Point>| {
        let mut side: Vec<Point> = Vec::new();
        for point in points {
            while let [.., a, b] = side[..]
                && (b - a).perp(&(point - b)) <= 0.0
            {
                side.pop();
            }
            side.push(*point);
        }
        side.pop();
        side
    };
    let (mut low, high) = (half(&mut points.iter()), half(&mut points.iter().rev()));
    low.extend(high);
    if low.is_empty() { points.first().copied().into_iter().collect() } else { low }
}

/// The difference between two shapes as far as it matters for paths: a distance in metres, or infinity for shapes of
/// different kinds.
pub fn change_m(before: &Shape, now: &Shape) -> f64 {
    match (before, now) {
        (Shape::Disc { center, radius_m }, Shape::Disc { center: c, radius_m: r }) => {
            (c - center).norm() + (r - radius_m).abs()
        }
        (Shape::Polygon { .. }, Shape::Polygon { vertices: now }) => farthest_m(before, now, 0.0),
        (Shape::Polyline { .. }, Shape::Polyline { points, half_width_m }) => {
            farthest_m(before, points, *half_width_m)
        }
        _ => f64::INFINITY,
    }
}

fn farthest_m(before: &Shape, corners: &[Point], room_m: f64) -> f64 {
    corners.iter().map(|corner| before.distance_m(*corner) + room_m).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::polyline::edges;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn an_outline_contains_its_points_and_is_convex(
            points in prop::collection::vec((0..40_i32, 0..40_i32), 3..60),
        ) {
            let points: Vec<Point> =
                points.iter().map(|(x, y)| Point::new(f64::from(*x) * 0.02, f64::from(*y) * 0.02)).collect();
            let mut outline = Outline::default();
            for point in &points {
                outline.add(*point, 0.0);
            }
            prop_assert!(outline.0.len() <= MOST_CORNERS);
            let turns: Vec<f64> = edges(&outline.0).zip(edges(&outline.0).skip(1)).map(|((a, b), (_, c))| (b - a).perp(&(c - b))).collect();
            prop_assert!(turns.iter().all(|turn| *turn >= 0.0));
            if outline.0.len() >= 3 && outline.0.len() < MOST_CORNERS {
                prop_assert!(points.iter().all(|point| outline.contains(*point)));
            }
        }
    }

    #[test]
    fn a_thin_outline_is_a_line() {
        let mut outline = Outline::default();
        (0..50).for_each(|k| outline.add(Point::new(f64::from(k) * 0.02, f64::from(k % 3) * 0.01), 0.0));
        let Some(Shape::Polyline { points, half_width_m }) = outline.shape() else { panic!("a line") };
        assert!((points[0] - points[1]).norm() > 0.95 && half_width_m < 0.02);
        outline.add(Point::new(0.5, 0.4), 0.0);
        assert!(matches!(outline.shape(), Some(Shape::Polygon { .. })));
        assert!(outline.extent_m() < 1.0);
    }
}
