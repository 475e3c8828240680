//! What is near enough to matter within the horizon of a window.

use geometry::{convex::Part, polyline::edges};
use steering::{KnownMap, Solid};
use world::{Boundary, Point, Vector};

/// A round thing, perhaps moving.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Disc {
    /// Its middle now.
    pub center: Point,
    /// Its radius, metres.
    pub radius_m: f64,
    /// How it moves, metres per second.
    pub velocity: Vector,
}

/// A straight bar, perhaps moving: a piece of a pipe, or of a straight wall.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bar {
    from: Point,
    along: Vector,
    /// One over its squared length; 0 for a bar without length.
    inverse: f64,
    half_width_m: f64,
    velocity: Vector,
}

impl Bar {
    /// Everything within a distance of a segment.
    pub fn new(a: Point, b: Point, half_width_m: f64, velocity: Vector) -> Self {
        let along = b - a;
        let squared = along.norm_squared();
        let inverse = if squared > 1e-18 { 1.0 / squared } else { 0.0 };
        Self { from: a, along, inverse, half_width_m, velocity }
    }

    /// Squared distance of a point from its middle line, once the bar has moved by `moved`.
    fn squared(&self, point: Point, moved: Vector) -> f64 {
        let off = point - self.from - moved;
        let share = (off.dot(&self.along) * self.inverse).clamp(0.0, 1.0);
        (off - self.along * share).norm_squared()
    }
}

/// Everything that a robot might come near to within the horizon.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct NearThings {
    /// Round ones.
    pub discs: Vec<Disc>,
    /// Straight ones: sides of polygons and pieces of a straight wall among them.
    pub bars: Vec<Bar>,
    /// Radius of a round wall, metres, if it is near.
    pub round_wall_m: Option<f64>,
}

impl NearThings {
    /// What is within reach; `velocity_of` gives the velocity of an obstacle.
    pub fn of(map: &KnownMap, at: Point, reach_m: f64, velocity_of: impl Fn(u32) -> Vector) -> Self {
        let mut near = Self::default();
        for solid in map.solids.iter().filter(|s| !s.is_beyond(at, reach_m)) {
            near.add(solid, velocity_of(solid.id));
        }
        match &map.wall {
            Boundary::Circle { radius_m } => {
                near.round_wall_m = Some(*radius_m).filter(|radius_m| radius_m - at.coords.norm() < reach_m);
            }
            Boundary::Polygon { vertices } => {
                let bars = edges(vertices).map(|(a, b)| Bar::new(a, b, 0.0, Vector::zeros()));
                near.bars.extend(bars.filter(|bar| bar.squared(at, Vector::zeros()) < reach_m * reach_m));
            }
        }
        near
    }

    fn add(&mut self, solid: &Solid, velocity: Vector) {
        match &solid.part {
            _ if solid.corners().len() == 1 => {
                self.discs.push(Disc { center: solid.center, radius_m: solid.radius_m, velocity });
            }
            Part::Capsule { a, b, half_width_m } => self.bars.push(Bar::new(*a, *b, *half_width_m, velocity)),
            // The hull is wider than the way between two points, so none jumps over a side.
            Part::Polygon { vertices } => {
                self.bars.extend(edges(vertices).map(|(a, b)| Bar::new(a, b, 0.0, velocity)));
            }
        }
    }

    /// The least distance from points, reached one after the other `dt_s` apart, to everything, metres; no more than
    /// `cap_m`. The first point is reached after `dt_s`.
    pub fn distance_m(&self, points: &[Point], dt_s: f64, cap_m: f64) -> f64 {
        let mut least = cap_m;
        let Some(first) = points.first() else { return least };
        let span_m = points.iter().map(|p| (p - first).norm_squared()).fold(0.0, f64::max).sqrt();
        let last_s = dt_s * points.len() as f64;
        for disc in &self.discs {
            // Nothing that is too far from the first point for the others to come near.
            let reach_m = least + span_m + disc.radius_m + disc.velocity.norm() * last_s;
            if (first - disc.center).norm_squared() > reach_m * reach_m {
                continue;
            }
            let step = disc.velocity * dt_s;
            let mut center = disc.center;
            let mut squared = f64::INFINITY;
            for point in points {
                center += step;
                squared = squared.min((point - center).norm_squared());
            }
            least = least.min(squared.sqrt() - disc.radius_m);
        }
        for bar in &self.bars {
            let reach_m = least + span_m + bar.half_width_m + bar.velocity.norm() * last_s;
            if bar.squared(*first, Vector::zeros()) > reach_m * reach_m {
                continue;
            }
            let step = bar.velocity * dt_s;
            let mut moved = Vector::zeros();
            let mut squared = f64::INFINITY;
            for point in points {
                moved += step;
                squared = squared.min(bar.squared(*point, moved));
            }
            least = least.min(squared.sqrt() - bar.half_width_m);
        }
        if let Some(radius_m) = self.round_wall_m {
            let furthest = points.iter().map(|p| p.coords.norm_squared()).fold(0.0, f64::max).sqrt();
            least = least.min(radius_m - furthest);
        }
        least
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn map() -> KnownMap {
        let bar = Part::Capsule { a: Point::new(0.0, 3.0), b: Point::new(2.0, 3.0), half_width_m: 0.1 };
        KnownMap {
            solids: vec![Solid::disc(1, Point::new(3.0, 0.0), 0.5), Solid::new(2, bar)],
            wall: Boundary::Circle { radius_m: 10.0 },
            hull_m: 0.2,
        }
    }

    #[test]
    fn distances_are_those_of_the_nearest_thing_on_the_way() {
        let near = NearThings::of(&map(), Point::origin(), 20.0, |_| Vector::zeros());
        let way = [Point::new(0.5, 0.0), Point::new(1.0, 0.0)];
        assert!((near.distance_m(&way, 0.2, 9.0) - 1.5).abs() < 1e-12);
        assert!((near.distance_m(&[Point::new(1.0, 2.5)], 0.2, 9.0) - 0.4).abs() < 1e-12);
        assert!((near.distance_m(&[Point::new(-9.0, 0.0)], 0.2, 9.0) - 1.0).abs() < 1e-12);
        assert!((near.distance_m(&way, 0.2, 1.0) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn something_that_comes_along_is_met_where_it_will_be() {
        let velocity = |id| if id == 1 { Vector::new(-1.0, 0.0) } else { Vector::zeros() };
        let near = NearThings::of(&map(), Point::origin(), 20.0, velocity);
        let standing = [Point::origin(); 10];
        assert!((near.distance_m(&standing, 0.2, 9.0) - 0.5).abs() < 1e-12);
    }
}
