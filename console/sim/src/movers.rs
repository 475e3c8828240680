//! Moving obstacles.

use crate::config::{Mover, Track};
use nalgebra::{Isometry2, Vector2};
use world::{Boundary, Obstacle, ObstacleId, Point, Shape};

/// All moving obstacles of a tank.
#[derive(Debug, Clone, Default)]
pub(crate) struct Movers(Vec<Moving>);

/// One moving obstacle.
#[derive(Debug, Clone)]
struct Moving {
    /// Index into the obstacles.
    index: usize,
    course: Course,
}

#[derive(Debug, Clone)]
enum Course {
    Straight {
        velocity_m_per_s: Vector2<f64>,
    },
    /// Visits the stops in a cycle; `next` is the index of the next stop.
    Stops {
        stops: Vec<Point>,
        next: usize,
        speed_m_per_s: f64,
    },
}

impl Movers {
    /// Creates the moving obstacles; entries without an obstacle or a finite speed are ignored.
    pub(crate) fn new(movers: &[Mover], obstacles: &[Obstacle]) -> Self {
        let index_of = |id: ObstacleId| obstacles.iter().position(|obstacle| obstacle.id == id);
        let moving = |mover: &Mover| {
            let index = index_of(mover.id)?;
            let course = Course::new(&mover.track, obstacles[index].shape.center())?;
            Some(Moving { index, course })
        };
        Self(movers.iter().filter_map(moving).collect())
    }

    /// Whether there are no moving obstacles.
    pub(crate) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Moves all obstacles for `dt_s` seconds.
    pub(crate) fn advance(&mut self, obstacles: &mut [Obstacle], boundary: &Boundary, dt_s: f64) {
        for moving in &mut self.0 {
            let shape = &mut obstacles[moving.index].shape;
            let by = moving.course.advance(shape, boundary, dt_s);
            *shape = shape.transformed(&Isometry2::new(by, 0.0));
        }
    }
}

impl Course {
    fn new(track: &Track, from: Point) -> Option<Self> {
        match track {
            Track::Straight { velocity_m_per_s } => {
                let is_finite = velocity_m_per_s.iter().all(|v| v.is_finite());
                is_finite.then_some(Self::Straight { velocity_m_per_s: *velocity_m_per_s })
            }
            Track::Waypoints { points, speed_m_per_s } => {
                let there = std::iter::once(from).chain(points.iter().copied());
                let back = points.iter().rev().skip(1).copied();
                let stops: Vec<Point> = there.chain(back).collect();
                let is_fine = speed_m_per_s.is_finite() && stops.iter().all(|p| p.coords.norm().is_finite());
                is_fine.then_some(Self::Stops { stops, next: 1, speed_m_per_s: *speed_m_per_s })
            }
        }
    }

    /// The displacement in `dt_s` seconds, metres.
    fn advance(&mut self, shape: &Shape, boundary: &Boundary, dt_s: f64) -> Vector2<f64> {
        let at = shape.center();
        match self {
            Self::Straight { velocity_m_per_s } => {
                let (low, high) = shape.bounds();
                let reach_m = (high - low).max() / 2.0;
                let room_m = |at: Point| boundary.wall_distance_m(at) - reach_m;
                let next = at + *velocity_m_per_s * dt_s;
                if room_m(next) < 0.0 && room_m(next) < room_m(at) {
                    *velocity_m_per_s = -*velocity_m_per_s;
                }
                *velocity_m_per_s * dt_s
            }
            Self::Stops { stops, next, speed_m_per_s } => {
                let (mut here, mut left_m) = (at, *speed_m_per_s * dt_s);
                // Each stop is visited at most once per tick; if several stops coincided, they would otherwise be visited
                // forever.
                for _ in 0..stops.len() {
                    let way = stops[*next % stops.len()] - here;
                    if way.norm() > left_m {
                        return here + way * (left_m / way.norm()) - at;
                    }
                    left_m -= way.norm();
                    here += way;
                    *next = (*next + 1) % stops.len();
                }
                here - at
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn disc() -> Vec<Obstacle> {
        let shape = Shape::Disc { center: Point::origin(), radius_m: 0.5 };
        vec![Obstacle { id: ObstacleId(3), name: "M".into(), shape, known: false }]
    }

    fn places(track: Track, ticks: usize) -> Vec<Point> {
        let mut obstacles = disc();
        let mut movers = Movers::new(&[Mover { id: ObstacleId(3), track }], &obstacles);
        let mut step = || {
            movers.advance(&mut obstacles, &Boundary::Circle { radius_m: 5.0 }, 0.5);
            obstacles[0].shape.center()
        };
        (0..ticks).map(|_| step()).collect()
    }

    #[test]
    fn it_turns_back_at_the_wall() {
        let places = places(Track::Straight { velocity_m_per_s: Vector2::new(1.0, 0.0) }, 100);
        assert!(places.iter().all(|p| p.x.abs() <= 4.5 + 1e-9 && p.y == 0.0));
        assert!(places.iter().any(|p| p.x > 3.9) && places.iter().any(|p| p.x < -3.9));
    }

    #[test]
    fn it_goes_from_place_to_place_and_back() {
        let points = vec![Point::new(1.0, 0.0), Point::new(1.0, 2.0)];
        let places = places(Track::Waypoints { points, speed_m_per_s: 1.0 }, 12);
        assert!((places[1] - Point::new(1.0, 0.0)).norm() < 1e-9);
        assert!((places[5] - Point::new(1.0, 2.0)).norm() < 1e-9);
        assert!((places[11] - Point::origin()).norm() < 1e-9);
    }

    #[test]
    fn places_on_one_spot_and_speeds_without_a_number_do_no_harm() {
        let spot = Track::Waypoints { points: vec![Point::origin(); 3], speed_m_per_s: 1.0 };
        assert!(places(spot, 3).iter().all(|p| p.coords.norm() == 0.0));
        let wild = Track::Straight { velocity_m_per_s: Vector2::new(f64::NAN, 0.0) };
        assert!(places(wild, 3).iter().all(|p| p.coords.norm() == 0.0));
    }
}
