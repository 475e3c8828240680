//! The objects close enough to matter within the horizon of a window.

use geometry::{convex::Part, polyline::edges};
use steering::{KnownMap, Solid};
use world::{Boundary, Point, Vector};

/// A round object.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Disc {
    /// The centre.
    pub center: Point,
    /// The radius, metres.
    pub radius_m: f64,
}

/// A straight bar: a piece of a pipe, or of a straight wall.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bar {
    from: Point,
    along: Vector,
    /// One over the squared length; 0 for a bar without length.
    inverse: f64,
    half_width_m: f64,
}

impl Bar {
    /// Creates the bar of all points within `half_width_m` of a segment.
    pub fn new(a: Point, b: Point, half_width_m: f64) -> Self {
        let along = b - a;
        let squared = along.norm_squared();
        let inverse = if squared > 1e-18 { 1.0 / squared } else { 0.0 };
        Self { from: a, along, inverse, half_width_m }
    }

    /// The squared distance of a point from the bar's centre line.
    fn squared(&self, point: Point) -> f64 {
        let off = point - self.from;
        let share = (off.dot(&self.along) * self.inverse).clamp(0.0, 1.0);
        (off - self.along * share).norm_squared()
    }
}

/// All objects that a robot might approach within the horizon.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct NearThings {
    /// Round objects.
    pub discs: Vec<Disc>,
    /// Straight objects, including sides of polygons and pieces of a straight wall.
    pub bars: Vec<Bar>,
    /// Radius of a round wall, metres, if it is near.
    pub round_wall_m: Option<f64>,
}

impl NearThings {
    /// Collects the objects within reach.
    pub fn of(map: &KnownMap, at: Point, reach_m: f64) -> Self {
        let mut near = Self::default();
        for solid in map.solids.iter().filter(|s| !s.is_beyond(at, reach_m)) {
            near.add(solid);
        }
        match &map.wall {
            Boundary::Circle { radius_m } => {
                near.round_wall_m = Some(*radius_m).filter(|radius_m| radius_m - at.coords.norm() < reach_m);
            }
            Boundary::Polygon { vertices } => {
                let bars = edges(vertices).map(|(a, b)| Bar::new(a, b, 0.0));
                near.bars.extend(bars.filter(|bar| bar.squared(at) < reach_m * reach_m));
            }
        }
        near
    }

    fn add(&mut self, solid: &Solid) {
        match &solid.part {
            _ if solid.corners().len() == 1 => {
                self.discs.push(Disc { center: solid.center, radius_m: solid.radius_m });
            }
            Part::Capsule { a, b, half_width_m } => self.bars.push(Bar::new(*a, *b, *half_width_m)),
            // The sides suffice: checked points are closer together than the hull is wide, so a path into the polygon
            // has a point near a side.
            Part::Polygon { vertices } => {
                self.bars.extend(edges(vertices).map(|(a, b)| Bar::new(a, b, 0.0)));
            }
        }
    }

    /// The smallest distance from a group of neighbouring points to any object, metres; at most `cap_m`.
    pub fn distance_m(&self, points: &[Point], cap_m: f64) -> f64 {
        let mut least = cap_m;
        let Some(first) = points.first() else { return least };
        let span_m = points.iter().map(|p| (p - first).norm_squared()).fold(0.0, f64::max).sqrt();
        for disc in &self.discs {
            // Skip objects so far from the first point that no other point can come close to them.
            let reach_m = least + span_m + disc.radius_m;
            if (first - disc.center).norm_squared() <= reach_m * reach_m {
                let squared = points.iter().map(|p| (p - disc.center).norm_squared());
                least = least.min(squared.fold(f64::INFINITY, f64::min).sqrt() - disc.radius_m);
            }
        }
        for bar in &self.bars {
            let reach_m = least + span_m + bar.half_width_m;
            if bar.squared(*first) <= reach_m * reach_m {
                let squared = points.iter().map(|p| bar.squared(*p));
                least = least.min(squared.fold(f64::INFINITY, f64::min).sqrt() - bar.half_width_m);
            }
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
        let near = NearThings::of(&map(), Point::origin(), 20.0);
        let way = [Point::new(0.5, 0.0), Point::new(1.0, 0.0)];
        assert!((near.distance_m(&way, 9.0) - 1.5).abs() < 1e-12);
        assert!((near.distance_m(&[Point::new(1.0, 2.5)], 9.0) - 0.4).abs() < 1e-12);
        assert!((near.distance_m(&[Point::new(-9.0, 0.0)], 9.0) - 1.0).abs() < 1e-12);
        assert!((near.distance_m(&way, 1.0) - 1.0).abs() < 1e-12);
    }
}
