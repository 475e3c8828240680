//! Simulates the scans of a scanner on the robot.

use crate::random::normal;
use geometry::unit_vector;
use rand::{Rng, RngExt};
use world::{Boundary, ObstacleMap, Pose, Scan, Scanner};

/// Minimum distance after its error has been added, metres: the resolution of a scan.
const NEAREST_M: f64 = 1e-3;

/// A scan by a robot at a pose. Each ray draws two random numbers, whatever it hits.
pub(crate) fn scan(
    scanner: &Scanner,
    map: &ObstacleMap,
    boundary: &Boundary,
    robot: &Pose,
    rng: &mut impl Rng,
) -> Scan {
    let from = scanner.pose(robot).position;
    let ray = |n: u32| {
        let angle = robot.heading_rad + scanner.first_rad() + f64::from(n) * scanner.step_rad();
        let direction = unit_vector(angle);
        let wall_m = boundary.ray_m(from, direction);
        let hit_m = map.ray_m(from, direction, scanner.range_m).unwrap_or(f64::INFINITY).min(wall_m);
        let (error_m, is_lost) = (scanner.sigma_m * normal(rng), rng.random::<f64>() < scanner.lost_share);
        // An error must not turn a hit into a distance of 0, which stands for an object that is too near to be
        // measured.
        let measured_m = if hit_m > NEAREST_M { (hit_m + error_m).max(NEAREST_M) } else { hit_m };
        (!is_lost).then_some(measured_m)
    };
    scanner.scan((0..scanner.rays).map(ray))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::RandomStreams;
    use std::f64::consts::{FRAC_PI_2, TAU};
    use world::{NO_ECHO, Obstacle, ObstacleId, Point, Shape};

    fn column() -> Obstacle {
        let shape = Shape::Disc { center: Point::new(0.0, 2.0), radius_m: 0.5 };
        Obstacle { id: ObstacleId(1), name: "column".into(), shape, known: false }
    }

    /// The distances in millimetres.
    fn scanned(scanner: &Scanner, boundary: &Boundary, pose: &Pose, seed: u64) -> Vec<u16> {
        let map = ObstacleMap::new(boundary, &[column()]);
        scan(scanner, &map, boundary, pose, &mut RandomStreams::new(seed).scanner).ranges_mm.0
    }

    const ROUND: Boundary = Boundary::Circle { radius_m: 5.0 };

    #[test]
    fn rays_end_at_columns_and_walls() {
        let square = [(-4.0, -3.0), (4.0, -3.0), (4.0, 3.0), (-4.0, 3.0)];
        let square = Boundary::Polygon { vertices: square.map(|(x, y)| Point::new(x, y)).to_vec() };
        // Rays to the west, south, east and north.
        let scanner = Scanner { rays: 4, range_m: 5.2, ..Scanner::default() }.exact();
        for (boundary, ahead, behind) in [(ROUND, [4000, NO_ECHO], 5000), (square, [3000, 5000], 3000)] {
            let (right, middle) = (Pose::new(1.0, 0.0, 0.0), Pose::new(0.0, 0.0, 0.0));
            let (right, middle) =
                (scanned(&scanner, &boundary, &right, 1), scanned(&scanner, &boundary, &middle, 1));
            assert_eq!([right[2], right[0]], ahead);
            assert_eq!([middle[3], middle[1]], [1500, behind]);
        }
    }

    #[test]
    fn the_mounting_moves_and_turns_the_rays() {
        let scanner =
            Scanner { rays: 4, offset_m: [0.5, 0.25], heading_rad: FRAC_PI_2, ..Scanner::default() }.exact();
        // The robot looks north; the scanner is ahead and on the left of its centre, and looks west.
        let found = scanned(&scanner, &ROUND, &Pose::new(0.25, 0.0, FRAC_PI_2), 1);
        assert_eq!(found[1], 1000, "the column, north of the scanner");
        let half = Scanner {
            rays: 3,
            field_of_view_rad: TAU / 2.0,
            heading_rad: 0.0,
            offset_m: [0.0; 2],
            ..scanner
        };
        assert_eq!(scanned(&half, &ROUND, &Pose::new(0.0, 0.0, 0.0), 1), [5000, 5000, 1500]);
    }

    #[test]
    fn errors_and_lost_rays_are_as_configured() {
        let scanner = Scanner { rays: 10_000, lost_share: 0.1, sigma_m: 0.05, ..Scanner::default() };
        let found = scanned(&scanner, &Boundary::Circle { radius_m: 1.0 }, &Pose::new(0.0, 0.0, 0.0), 3);
        let lost = found.iter().filter(|mm| **mm == NO_ECHO).count();
        assert!((900..1100).contains(&lost), "{lost}");
        let errors = found.iter().filter(|mm| **mm != NO_ECHO).map(|mm| f64::from(*mm) / 1000.0 - 1.0);
        let sigma_m = (errors.map(|error| error * error).sum::<f64>() / 9000.0).sqrt();
        assert!((sigma_m - 0.05).abs() < 0.003, "{sigma_m}");
        assert_eq!(
            found,
            scanned(&scanner, &Boundary::Circle { radius_m: 1.0 }, &Pose::new(0.0, 0.0, 0.0), 3)
        );
    }
}
