//! The floor, with all solids grown so that the robot can be treated as a point.

use super::{
    bar::{Bar, Bars, TOUCH_M},
    corner::Corner,
};
use geometry::{
    Boundary, Point, Shape,
    polyline::{distance_to_ring_m, edges},
    shape::{reflex_corners, ring_contains},
};

use std::collections::{HashMap, HashSet};

/// Smallest radius of a disc or corner, metres: a path could lead across a disc of radius zero.
const LEAST_RADIUS_M: f64 = 1e-6;

/// A floor on which the robot is treated as a point, tank frame.
#[derive(Debug, Clone)]
pub struct GrownFloor {
    wall: Wall,
    rings: Vec<Vec<Point>>,
    bars: Bars,
    /// Sides that two polygons share: no path reaches them, but a given point may lie on one.
    seams: Vec<Bar>,
    pub(super) corners: Vec<Corner>,
}

#[derive(Debug, Clone)]
enum Wall {
    Round { radius_m: f64 },
    Straight { vertices: Vec<Point> },
}

impl GrownFloor {
    /// Creates a floor from a wall and outlines. The centre of the robot stays at least `wall_keep_m` away from the
    /// wall; each outline comes with its own minimum distance, metres.
    ///
    /// ```
    /// use world::{Boundary, Point, Shape, shortest::GrownFloor};
    /// let column = Shape::Disc { center: Point::new(4.0, 0.0), radius_m: 0.5 };
    /// let floor = GrownFloor::new(&Boundary::Circle { radius_m: 10.0 }, 0.5, [(&column, 0.5)]);
    /// assert!(floor.spare_m(Point::new(4.0, 0.0)) < 0.0);
    /// ```
    pub fn new<'a>(
        boundary: &Boundary,
        wall_keep_m: f64,
        solids: impl IntoIterator<Item = (&'a Shape, f64)>,
    ) -> Self {
        let mut parts = Parts::default();
        for (shape, keep_m) in solids {
            parts.add(shape, keep_m);
        }
        let wall = parts.enclose(boundary, wall_keep_m);
        parts.join_pieces();
        let Parts { bars, seams, circles, rings, .. } = parts;
        let bars = Bars::new(bars);
        let round_m = match wall {
            Wall::Round { radius_m } => Some(radius_m),
            Wall::Straight { .. } => None,
        };
        let corners = circles.into_iter().map(|(at, radius_m)| Corner::new(at, radius_m, &bars, round_m));
        let corners = corners.filter(|corner| !corner.free.is_empty()).collect();
        Self { wall, rings, bars, seams, corners }
    }

    /// Returns the distance from a point to the nearest grown solid, metres; negative where the robot does not fit.
    ///
    /// ```
    /// use world::{Boundary, Point, Shape, shortest::GrownFloor};
    /// let column = Shape::Disc { center: Point::new(4.0, 0.0), radius_m: 0.5 };
    /// let floor = GrownFloor::new(&Boundary::Circle { radius_m: 10.0 }, 0.5, [(&column, 0.5)]);
    /// assert_eq!(floor.spare_m(Point::origin()), 3.0);
    /// ```
    pub fn spare_m(&self, at: Point) -> f64 {
        let wall_m = match &self.wall {
            Wall::Round { radius_m } => radius_m - at.coords.norm(),
            Wall::Straight { vertices } if ring_contains(vertices, at) => f64::INFINITY,
            Wall::Straight { vertices } => -distance_to_ring_m(vertices, at),
        };
        let inside = self.rings.iter().filter(|ring| ring_contains(ring, at));
        let ring_m = inside.map(|ring| -distance_to_ring_m(ring, at)).fold(wall_m, f64::min);
        self.bars.iter().chain(&self.seams).map(|bar| bar.distance_m(at)).fold(ring_m, f64::min)
    }

    /// Whether the robot can drive straight from one point to another.
    ///
    /// ```
    /// use world::{Boundary, Point, Shape, shortest::GrownFloor};
    /// let column = Shape::Disc { center: Point::new(4.0, 0.0), radius_m: 0.5 };
    /// let floor = GrownFloor::new(&Boundary::Circle { radius_m: 10.0 }, 0.5, [(&column, 0.5)]);
    /// assert!(!floor.is_free(Point::new(0.0, 0.9), Point::new(8.0, 0.9)));
    /// assert!(floor.is_free(Point::new(0.0, 1.1), Point::new(8.0, 1.1)));
    /// ```
    pub fn is_free(&self, a: Point, b: Point) -> bool {
        let within = match self.wall {
            Wall::Round { radius_m } => a.coords.norm().max(b.coords.norm()) <= radius_m + TOUCH_M,
            Wall::Straight { .. } => true,
        };
        within && !self.bars.block(a, b)
    }
}

/// A floor under construction.
#[derive(Default)]
struct Parts {
    bars: Vec<Bar>,
    /// Sides of polygons, counter-clockwise.
    sides: Vec<Bar>,
    seams: Vec<Bar>,
    circles: Vec<(Point, f64)>,
    rings: Vec<Vec<Point>>,
}

impl Parts {
    fn add(&mut self, shape: &Shape, keep_m: f64) {
        match shape {
            Shape::Disc { center, radius_m } => self.add_line(&[*center], radius_m + keep_m),
            Shape::Polyline { points, half_width_m } => self.add_line(points, half_width_m + keep_m),
            Shape::Polygon { vertices } => {
                let radius_m = keep_m.max(LEAST_RADIUS_M);
                self.sides.extend(edges(vertices).map(|(a, b)| Bar { a, b, radius_m }));
                self.rings.push(vertices.clone());
            }
        }
    }

    fn add_line(&mut self, points: &[Point], radius_m: f64) {
        let radius_m = radius_m.max(LEAST_RADIUS_M);
        self.circles.extend(points.iter().map(|at| (*at, radius_m)));
        match points {
            [only] => self.bars.push(Bar { a: *only, b: *only, radius_m }),
            _ => self.bars.extend(points.windows(2).map(|w| Bar { a: w[0], b: w[1], radius_m })),
        }
    }

    /// Adds the sides and corners of polygons, except those hidden between adjacent polygons: no path reaches a shared
    /// side, or a corner that does not protrude.
    fn join_pieces(&mut self) {
        let bits = |at: Point| (at.x.to_bits(), at.y.to_bits());
        let key = |a: Point, b: Point, bar: &Bar| (bits(a), bits(b), bar.radius_m.to_bits());
        let all: HashSet<_> = self.sides.iter().map(|side| key(side.a, side.b, side)).collect();
        let is_seam = |side: &Bar| all.contains(&key(side.b, side.a, side));
        (self.seams, self.sides) = std::mem::take(&mut self.sides).into_iter().partition(is_seam);
        let mut leaving: HashMap<_, Vec<&Bar>> = HashMap::new();
        let mut n_arriving: HashMap<_, usize> = HashMap::new();
        for side in &self.sides {
            leaving.entry(bits(side.a)).or_default().push(side);
            *n_arriving.entry(bits(side.b)).or_default() += 1;
        }
        let mut seen = HashSet::new();
        for side in &self.sides {
            let next = leaving.get(&bits(side.b)).map_or(&[][..], Vec::as_slice);
            let is_hidden = match next {
                [next]
                    if n_arriving[&bits(side.b)] == 1
                        && next.radius_m.to_bits() == side.radius_m.to_bits() =>
                {
                    (side.b - side.a).perp(&(next.b - next.a)) <= 0.0
                }
                _ => false,
            };
            if !is_hidden && seen.insert((bits(side.b), side.radius_m.to_bits())) {
                self.circles.push((side.b, side.radius_m));
            }
        }
        self.bars.append(&mut self.sides);
    }

    /// Adds the wall: paths can turn only about corners that point into the tank.
    fn enclose(&mut self, boundary: &Boundary, keep_m: f64) -> Wall {
        let vertices = match boundary {
            Boundary::Circle { radius_m } => return Wall::Round { radius_m: radius_m - keep_m },
            Boundary::Polygon { vertices } => vertices.clone(),
        };
        let radius_m = keep_m.max(LEAST_RADIUS_M);
        self.circles.extend(reflex_corners(&vertices).map(|index| (vertices[index], radius_m)));
        self.bars.extend(edges(&vertices).map(|(a, b)| Bar { a, b, radius_m }));
        Wall::Straight { vertices }
    }
}
