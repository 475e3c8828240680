//! The exact shortest way for a disc among discs, polygons and polylines.
//!
//! Everything solid is grown by what the middle of the robot has to keep from it, so that the robot is a point: discs
//! stay discs, corners become arcs. The shortest way is then made of common tangents of those circles and of arcs
//! between them (the visibility graph of round obstacles). Tangents are looked for only where A* gets to, and tested
//! only when they come first in its queue. As nothing is rasterised, a search that ends empty-handed is a proof that
//! there is no way.
//!
//! Frame: the tank frame, metres, radians. Outlines may overlap; what touches is passable along but not across.
//! Cost: about `n` tangents for every arc that the search turns about, `n` the number of discs and corners.

mod bar;
mod corner;
mod search;
mod tangent;

use crate::{
    Boundary,
    geometry::{Point, Vector},
    polyline::edges,
    polyline::nearest_on_segment,
    shape::{Shape, ring_area_m2, ring_contains},
};
use bar::{Bar, Bars};
use corner::Corner;

/// Overlaps up to this count as touching, metres.
const TOUCH_M: f64 = 1e-9;
/// What has no extent at all gets this radius, or a way could lead across it, metres.
const LEAST_RADIUS_M: f64 = 1e-6;
/// Arcs are drawn this much outside the circle at most, metres, and with corners no sharper than this, radians.
const ARC_EXCESS_M: f64 = 4e-5;
const ARC_STEP_RAD: f64 = 0.2;

/// A floor on which the robot is a point.
#[derive(Debug, Clone)]
pub struct GrownFloor {
    wall: Wall,
    rings: Vec<Vec<Point>>,
    bars: Bars,
    corners: Vec<Corner>,
}

#[derive(Debug, Clone)]
enum Wall {
    Round { radius_m: f64 },
    Straight { vertices: Vec<Point> },
}

/// A piece of a way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Piece {
    /// Straight on.
    Straight {
        /// From here.
        from: Point,
        /// To there.
        to: Point,
    },
    /// About a grown disc or corner.
    Arc {
        /// Its centre.
        center: Point,
        /// Its radius, metres.
        radius_m: f64,
        /// Bearing of the first point from the centre, radians.
        from_rad: f64,
        /// Angle turned through, radians, counter-clockwise if positive.
        sweep_rad: f64,
    },
}

/// A shortest way.
#[derive(Debug, Clone, PartialEq)]
pub struct Way {
    /// Its pieces, each beginning where the one before ends.
    pub pieces: Vec<Piece>,
    /// Its length, metres.
    pub length_m: f64,
}

/// Why there is no shortest way.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum NoWay {
    /// The robot does not fit at the start.
    #[error("the start ({:.3}, {:.3}) is too near to something solid, by {by_m:.3} m", at.x, at.y)]
    StartBlocked {
        /// The start.
        at: Point,
        /// By how much, metres.
        by_m: f64,
    },
    /// The robot does not fit at the goal.
    #[error("the goal ({:.3}, {:.3}) is too near to something solid, by {by_m:.3} m", at.x, at.y)]
    GoalBlocked {
        /// The goal.
        at: Point,
        /// By how much, metres.
        by_m: f64,
    },
    /// Proved: no way leads from start to goal.
    #[error("there is no way: the search tried all {n_tangents} tangents that can be reached from the start")]
    Unreachable {
        /// Number of tangents tested.
        n_tangents: usize,
    },
    /// The caller wanted no answer any more.
    #[error("the search was stopped")]
    Stopped,
}

impl GrownFloor {
    /// A floor within a wall from which the middle of the robot keeps `wall_keep_m`, and outlines with the distance
    /// that it keeps from each, metres.
    pub fn new<'a>(
        boundary: &Boundary,
        wall_keep_m: f64,
        solids: impl IntoIterator<Item = (&'a Shape, f64)>,
    ) -> Self {
        let mut floor = Parts::default();
        for (shape, keep_m) in solids {
            floor.add(shape, keep_m);
        }
        let wall = floor.enclose(boundary, wall_keep_m);
        let Parts { bars, circles, rings } = floor;
        let bars = Bars::new(bars);
        let round_m = match wall {
            Wall::Round { radius_m } => Some(radius_m),
            Wall::Straight { .. } => None,
        };
        let corners = circles.into_iter().map(|(at, radius_m)| Corner::new(at, radius_m, &bars, round_m));
        let corners = corners.filter(|corner| !corner.free.is_empty()).collect();
        Self { wall, rings, bars, corners }
    }

    /// Distance by which a point is clear of everything grown, metres; negative where the robot does not fit.
    pub fn spare_m(&self, at: Point) -> f64 {
        let wall_m = match &self.wall {
            Wall::Round { radius_m } => radius_m - at.coords.norm(),
            Wall::Straight { vertices } if ring_contains(vertices, at) => f64::INFINITY,
            Wall::Straight { vertices } => -geometry::polyline::distance_to_ring_m(vertices, at),
        };
        let inside = self.rings.iter().filter(|ring| ring_contains(ring, at));
        let ring_m =
            inside.map(|ring| -geometry::polyline::distance_to_ring_m(ring, at)).fold(wall_m, f64::min);
        self.bars.iter().map(|bar| bar.distance_m(at)).fold(ring_m, f64::min)
    }

    /// Whether the straight way between two points is free.
    pub fn is_free(&self, a: Point, b: Point) -> bool {
        let within = match self.wall {
            Wall::Round { radius_m } => a.coords.norm().max(b.coords.norm()) <= radius_m + TOUCH_M,
            Wall::Straight { .. } => true,
        };
        within && !self.bars.block(a, b)
    }

    /// The shortest way from a start to a goal; `keep_going` is asked now and then whether the answer is still wanted.
    ///
    /// # Errors
    /// [`NoWay`]: an end does not fit, there is no way, or the caller stopped the search.
    pub fn shortest(
        &self,
        start: Point,
        goal: Point,
        keep_going: &mut dyn FnMut() -> bool,
    ) -> Result<Way, NoWay> {
        self.check_ends(start, goal)?;
        let all: Vec<usize> = (0..self.corners.len()).collect();
        self.search(start, goal, &all, keep_going)
    }

    /// A way pulled taut: the shortest one that bends only about what lies within `reach_m` of it.
    ///
    /// The way may touch what it likes; only its ends and its neighbourhood matter.
    ///
    /// # Errors
    /// As [`GrownFloor::shortest`], but [`NoWay::Unreachable`] only means that the neighbourhood was too small.
    pub fn pulled_taut(
        &self,
        way: &[Point],
        reach_m: f64,
        keep_going: &mut dyn FnMut() -> bool,
    ) -> Result<Way, NoWay> {
        let [start, .., goal] = way else { return Err(NoWay::Unreachable { n_tangents: 0 }) };
        self.check_ends(*start, *goal)?;
        let is_near = |corner: &Corner| {
            let near_m = corner.radius_m + reach_m;
            way.windows(2).any(|pair| {
                (corner.center - nearest_on_segment(pair[0], pair[1], corner.center)).norm_squared()
                    < near_m * near_m
            })
        };
        let near: Vec<usize> =
            (0..self.corners.len()).filter(|index| is_near(&self.corners[*index])).collect();
        self.search(*start, *goal, &near, keep_going)
    }

    fn check_ends(&self, start: Point, goal: Point) -> Result<(), NoWay> {
        // An end that is no number fits nowhere.
        let short_m = |at: Point| Some(-self.spare_m(at)).filter(|by_m| *by_m > TOUCH_M || by_m.is_nan());
        if let Some(by_m) = short_m(start) {
            return Err(NoWay::StartBlocked { at: start, by_m });
        }
        short_m(goal).map_or(Ok(()), |by_m| Err(NoWay::GoalBlocked { at: goal, by_m }))
    }

    fn search(
        &self,
        start: Point,
        goal: Point,
        corners: &[usize],
        keep_going: &mut dyn FnMut() -> bool,
    ) -> Result<Way, NoWay> {
        if (goal - start).norm() < TOUCH_M {
            return Ok(Way { pieces: vec![Piece::Straight { from: start, to: goal }], length_m: 0.0 });
        }
        search::Search::new(self, start, goal, corners).run(keep_going)
    }
}

impl Way {
    /// The way as a chain of straight pieces that never comes nearer than the way itself: arcs are drawn by tangents
    /// from outside, at most 0.04 mm too far out.
    pub fn points(&self) -> Vec<Point> {
        let mut points: Vec<Point> = Vec::new();
        for piece in &self.pieces {
            match *piece {
                Piece::Straight { from, to } => {
                    if points.is_empty() {
                        points.push(from);
                    }
                    points.push(to);
                }
                Piece::Arc { center, radius_m, from_rad, sweep_rad } => {
                    points.extend(tangent_corners(center, radius_m, from_rad, sweep_rad));
                }
            }
        }
        points.dedup();
        points
    }
}

/// Where tangents of an arc cross, from its first tangent to its last.
fn tangent_corners(
    center: Point,
    radius_m: f64,
    from_rad: f64,
    sweep_rad: f64,
) -> impl Iterator<Item = Point> {
    let step_rad = (8.0 * ARC_EXCESS_M / radius_m).sqrt().min(ARC_STEP_RAD);
    let n = (sweep_rad.abs() / step_rad).ceil().max(1.0);
    let half_rad = sweep_rad / n / 2.0;
    let outer_m = radius_m / half_rad.cos();
    (0..n as u32).map(move |k| {
        let bearing_rad = from_rad + half_rad * f64::from(2 * k + 1);
        center + Vector::new(bearing_rad.cos(), bearing_rad.sin()) * outer_m
    })
}

/// A floor under construction.
#[derive(Default)]
struct Parts {
    bars: Vec<Bar>,
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
                self.bars.extend(edges(vertices).map(|(a, b)| Bar { a, b, radius_m }));
                self.circles.extend(vertices.iter().map(|at| (*at, radius_m)));
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

    /// The wall: only corners that point into the tank can be turned about.
    fn enclose(&mut self, boundary: &Boundary, keep_m: f64) -> Wall {
        let vertices = match boundary {
            Boundary::Circle { radius_m } => return Wall::Round { radius_m: radius_m - keep_m },
            Boundary::Polygon { vertices } => vertices.clone(),
        };
        let radius_m = keep_m.max(LEAST_RADIUS_M);
        let side = ring_area_m2(&vertices).signum();
        let n = vertices.len();
        for (index, &at) in vertices.iter().enumerate() {
            let (before, after) = (vertices[(index + n - 1) % n], vertices[(index + 1) % n]);
            if (at - before).perp(&(after - at)) * side < 0.0 {
                self.circles.push((at, radius_m));
            }
            self.bars.push(Bar { a: at, b: after, radius_m });
        }
        Wall::Straight { vertices }
    }
}

#[cfg(test)]
mod tests;
