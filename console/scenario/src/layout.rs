//! `[random_obstacles]`: columns at random positions; the same seed gives the same columns.

use super::{problem::Complaint, section::Section};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use world::{Boundary, Obstacle, ObstacleId, ObstacleMap, Point, Shape};

/// The number of positions tried for each obstacle.
const TRIES_PER_OBSTACLE: usize = 200;

/// The area in which the centres of random obstacles are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Sampling {
    /// Anywhere on the floor.
    Disk,
    /// Anywhere in the square or box around the tank, as in Wang et al. 2023, where one obstacle in five is outside the
    /// tank.
    Square,
}

/// The parameters of random obstacles.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct RandomObstacles {
    /// The number of obstacles.
    pub count: usize,
    /// The smallest and the largest radius in metres.
    pub radius_m: [f64; 2],
    /// The area in which the centres are drawn.
    pub sampling: Sampling,
    /// The smallest distance in metres between the outlines of two obstacles, including obstacles that are not random.
    pub min_gap_m: f64,
    /// The smallest distance in metres from an outline to the start and to the end of the mission.
    pub keep_clear_m: f64,
    /// Whether the obstacles are on the drawing.
    pub known: bool,
    /// The random seed.
    pub seed: u64,
}

/// Reads `[random_obstacles]`.
pub(crate) fn random_obstacles(section: &Section<'_>, scenario_seed: Option<u64>) -> Option<RandomObstacles> {
    let (count, radius_m) = (section.whole("count"), section.pair("radius_m"));
    let sampling = section.word("sampling");
    let (min_gap_m, keep_clear_m) = (section.number("min_gap_m"), section.number("keep_clear_m"));
    let known = section.flag("known");
    let own_seed = section.whole("seed").map(|seed| seed as u64);
    let seed = if section.has("seed") { own_seed } else { scenario_seed };
    let radius_m = radius_m?;
    if radius_m[0] > radius_m[1] {
        section.complain("radius_m", Complaint::OutOfRange("[smallest, largest]".into()));
        return None;
    }
    Some(RandomObstacles {
        count: count? as usize,
        radius_m,
        sampling: if sampling? == "disk" { Sampling::Disk } else { Sampling::Square },
        min_gap_m: min_gap_m?,
        keep_clear_m: keep_clear_m?,
        known: known?,
        seed: seed?,
    })
}

impl RandomObstacles {
    /// Adds the obstacles to `obstacles`; returns the number of obstacles placed.
    ///
    /// `free` holds the points to keep clear.
    pub(crate) fn place(&self, boundary: &Boundary, free: &[Point], obstacles: &mut Vec<Obstacle>) -> usize {
        let mut chance = Pcg64Mcg::seed_from_u64(self.seed);
        let by_hand = ObstacleMap::new(boundary, obstacles);
        let mut placed: Vec<(Point, f64)> = Vec::new();
        let next_id = obstacles.iter().map(|obstacle| obstacle.id.0 + 1).max().unwrap_or(1);
        for n in 0..self.count {
            let found = (0..TRIES_PER_OBSTACLE).map(|_| self.candidate(boundary, &mut chance)).find(
                |(center, radius_m)| {
                    self.is_on_clear_floor(boundary, free, *center, *radius_m)
                        && self.has_gaps(&by_hand, &placed, *center, *radius_m)
                },
            );
            let Some((center, radius_m)) = found else { return n };
            placed.push((center, radius_m));
            obstacles.push(Obstacle {
                id: ObstacleId(next_id + n as u32),
                name: format!("random {}", n + 1),
                shape: Shape::Disc { center, radius_m },
                known: self.known,
            });
        }
        self.count
    }

    fn candidate(&self, boundary: &Boundary, chance: &mut Pcg64Mcg) -> (Point, f64) {
        let (low, high) = boundary.bounds();
        let mut between = |from: f64, to: f64| from + (to - from) * chance.random::<f64>();
        let center = Point::new(between(low.x, high.x), between(low.y, high.y));
        (center, between(self.radius_m[0], self.radius_m[1]))
    }

    fn is_on_clear_floor(&self, boundary: &Boundary, free: &[Point], center: Point, radius_m: f64) -> bool {
        let on_floor = self.sampling == Sampling::Square || boundary.contains(center);
        on_floor && free.iter().all(|point| (center - point).norm() - radius_m >= self.keep_clear_m)
    }

    fn has_gaps(&self, by_hand: &ObstacleMap, placed: &[(Point, f64)], center: Point, radius_m: f64) -> bool {
        let gap_m = |(other, other_m): &(Point, f64)| (other - center).norm() - other_m - radius_m;
        self.min_gap_m == 0.0
            || (by_hand.obstacle_distance_m(center) - radius_m >= self.min_gap_m
                && placed.iter().all(|disc| gap_m(disc) >= self.min_gap_m))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn layout(sampling: Sampling, seed: u64) -> Vec<Obstacle> {
        let random = RandomObstacles {
            count: 39,
            radius_m: [0.05, 0.1],
            sampling,
            min_gap_m: 0.3,
            keep_clear_m: 1.0,
            known: true,
            seed,
        };
        let mut obstacles = Vec::new();
        let placed =
            random.place(&Boundary::Circle { radius_m: 10.0 }, &[Point::new(10.0, 0.0)], &mut obstacles);
        assert_eq!(placed, 39);
        obstacles
    }

    #[test]
    fn the_same_seed_gives_the_same_layout_and_another_one_another() {
        assert_eq!(layout(Sampling::Disk, 7), layout(Sampling::Disk, 7));
        assert_ne!(layout(Sampling::Disk, 7), layout(Sampling::Disk, 8));
    }

    #[test]
    fn gaps_and_the_start_are_kept_free() {
        let obstacles = layout(Sampling::Disk, 1);
        for (i, a) in obstacles.iter().enumerate() {
            assert!(a.shape.distance_m(Point::new(10.0, 0.0)) >= 1.0);
            assert!(a.shape.center().coords.norm() <= 10.0);
            for b in &obstacles[..i] {
                let Shape::Disc { radius_m, .. } = b.shape else { panic!("a disc") };
                assert!(a.shape.distance_m(b.shape.center()) - radius_m >= 0.3 - 1e-12);
            }
        }
    }

    #[test]
    fn the_square_reaches_beyond_the_wall() {
        let outside = |o: &&Obstacle| o.shape.center().coords.norm() > 10.0;
        assert!((1..5).any(|seed| layout(Sampling::Square, seed).iter().filter(outside).count() > 3));
    }

    #[test]
    fn a_full_floor_says_how_many_found_room() {
        let crowd = RandomObstacles {
            count: 100,
            radius_m: [0.5, 0.5],
            sampling: Sampling::Disk,
            min_gap_m: 0.5,
            keep_clear_m: 0.0,
            known: true,
            seed: 1,
        };
        let placed = crowd.place(&Boundary::Circle { radius_m: 2.0 }, &[], &mut Vec::new());
        assert!((1..20).contains(&placed));
    }
}
