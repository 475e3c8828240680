//! The floor that a tool cannot test because of the welds between the plates.

use super::PlateLayout;
use crate::{
    coverage::{Cell, Floor, clearances_m},
    obstacles::ObstacleMap,
    tank::{Obstacle, ObstacleId},
};
use geometry::{Boundary, Point, Shape, Vector};
use serde::{Deserialize, Serialize};

/// The smallest angle by which an outline turns at the corner of a plate, radians; an arc turns less between two of its
/// points.
const LEAST_TURN_RAD: f64 = 0.4;

/// The parts of the floor that a tool cannot test: a band on each side of every weld and along the shell, and a square
/// in every corner of a plate.
///
/// ```
/// use world::{Boundary, Cell, DeadBands, Floor, FloorMaker, PlateLayout, Point, RegularPlates, World};
/// # let boundary = Boundary::Circle { radius_m: 5.0 };
/// let tank = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
/// let plates = PlateLayout::Regular(RegularPlates { annular_m: 0.0, n_annular: 0, length_m: 6.0, width_m: 2.0 });
/// let bands = DeadBands { plates, band_m: 0.1, square_m: 0.3 };
/// let maker = FloorMaker::new(&tank, 0.1, 0.5, 0.6, Point::origin());
/// let floor = maker.with_dead_bands(&bands, &tank.boundary).into_floor();
/// let kind = |x, y| floor.kind(floor.cell_at(Point::new(x, y)).unwrap());
/// // A weld at y = 1 m; another one at x = 0 in the rows beside the middle one.
/// assert_eq!((kind(2.0, 1.05), kind(2.0, 1.25)), (Cell::Untestable, Cell::Reachable));
/// assert_eq!((kind(0.25, 1.25), kind(4.95, 0.0)), (Cell::Untestable, Cell::Untestable));
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DeadBands {
    /// The plates; their seams are the welds.
    pub plates: PlateLayout,
    /// Width of the band on each side of a weld, metres.
    pub band_m: f64,
    /// Edge of the square in each corner of a plate, metres.
    pub square_m: f64,
}

impl DeadBands {
    /// For each cell of a grid, whether its centre is in a band or a square.
    pub(crate) fn cells(&self, boundary: &Boundary, grid: &Floor) -> Vec<bool> {
        let seams = self.plates.seams(boundary);
        let bands = seams
            .iter()
            .filter(|_| self.band_m > 0.0)
            .map(|seam| Shape::Polyline { points: seam.clone(), half_width_m: self.band_m });
        let squares =
            seams.iter().filter(|_| self.square_m > 0.0).flat_map(|seam| squares(seam, self.square_m));
        let solid = |(index, shape): (usize, Shape)| Obstacle {
            id: ObstacleId(index as u32),
            name: String::new(),
            shape,
            known: true,
        };
        let welds: Vec<Obstacle> = bands.chain(squares).enumerate().map(solid).collect();
        let off_weld_m = clearances_m(grid, &ObstacleMap::new(boundary, &welds), 0.0);
        let off_shell_m = clearances_m(grid, &ObstacleMap::new(boundary, &[]), self.band_m);
        let is_dead = |(weld_m, shell_m): (f32, f32)| weld_m < 0.0 || f64::from(shell_m) < self.band_m;
        off_weld_m.into_iter().zip(off_shell_m).map(is_dead).collect()
    }
}

/// Marks which cells of a floor are untestable; empty if none is, as on most floors.
pub(crate) fn untestable(floor: &Floor) -> Vec<bool> {
    let marks: Vec<bool> = (0..floor.len()).map(|cell| floor.kind(cell) == Cell::Untestable).collect();
    if marks.contains(&true) { marks } else { Vec::new() }
}

/// The squares in the corners of the plates at a seam: on both sides of each end of an open seam, and at the convex
/// corners of a closed one, which runs counter-clockwise.
fn squares(seam: &[Point], edge_m: f64) -> Vec<Shape> {
    let at = |corner: Point, one: Vector, other: Vector| {
        let (one, other) = (one * edge_m, other * edge_m);
        let far = corner + one + other;
        let turns_left = one.perp(&other) > 0.0;
        let (second, last) = if turns_left { (one, other) } else { (other, one) };
        Shape::Polygon { vertices: vec![corner, corner + second, far, corner + last] }
    };
    let way = |from: Point, to: Point| (to - from).try_normalize(1e-9);
    let ([first, second, ..], [.., before, last]) = (seam, seam) else { return Vec::new() };
    if (first - last).norm() > 1e-9 {
        let ends = [(*first, way(*first, *second)), (*last, way(*last, *before))];
        let both = |(corner, along): (Point, Option<Vector>)| {
            let along = along?;
            let side = Vector::new(-along.y, along.x);
            Some([at(corner, along, side), at(corner, along, -side)])
        };
        return ends.into_iter().filter_map(both).flatten().collect();
    }
    let ring = &seam[1..];
    let corner = |k: usize| {
        let (before, corner, after) =
            (ring[(k + ring.len() - 1) % ring.len()], ring[k], ring[(k + 1) % ring.len()]);
        let (back, ahead) = (way(corner, before)?, way(corner, after)?);
        let turn_rad = (-back).perp(&ahead).atan2((-back).dot(&ahead));
        (turn_rad > LEAST_TURN_RAD).then(|| at(corner, back, ahead))
    };
    (0..ring.len()).filter_map(corner).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{DrawnPlate, FloorMaker, RegularPlates, World};

    fn floor(bands: &DeadBands, cell_m: f64) -> (World, Floor) {
        let boundary = Boundary::Circle { radius_m: 6.0 };
        let world = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
        let maker = FloorMaker::new(&world, cell_m, 0.3, 0.6, Point::origin());
        let floor = maker.with_dead_bands(bands, &world.boundary).into_floor();
        (world, floor)
    }

    fn untestable_m2(floor: &Floor) -> f64 {
        untestable(floor).iter().filter(|is| **is).count() as f64 * floor.cell_m2()
    }

    #[test]
    fn bands_and_squares_have_the_area_of_their_welds() {
        let plates = PlateLayout::Drawn {
            plates: vec![DrawnPlate {
                name: "P".into(),
                vertices_m: [(-2.0, -1.0), (2.0, -1.0), (2.0, 1.0), (-2.0, 1.0)]
                    .map(|(x, y)| Point::new(x, y))
                    .to_vec(),
            }]
            .into(),
        };
        let shell_m2 = std::f64::consts::PI * (36.0 - 5.9_f64.powi(2));
        let bands = DeadBands { plates: plates.clone(), band_m: 0.1, square_m: 0.0 };
        let expected_m2 = 12.0 * 0.2 - 4.0 * 0.01 + std::f64::consts::PI * 0.01 - 4.0 * 0.01 + 4.0 * 0.01;
        let is_m2 = untestable_m2(&floor(&bands, 0.01).1);
        assert!((is_m2 - shell_m2 - expected_m2).abs() < 0.05, "{is_m2} m²");
        let squares = DeadBands { plates, band_m: 0.0, square_m: 0.25 };
        let is_m2 = untestable_m2(&floor(&squares, 0.01).1);
        assert!((is_m2 - 4.0 * 0.0625).abs() < 1e-9, "{is_m2} m²");
    }

    #[test]
    fn a_seam_that_ends_at_another_one_has_two_squares_at_each_end_and_none_beyond() {
        let plates = RegularPlates { annular_m: 0.0, n_annular: 0, length_m: 6.0, width_m: 2.0 };
        let bands = DeadBands { plates: PlateLayout::Regular(plates), band_m: 0.0, square_m: 0.4 };
        let (_, floor) = floor(&bands, 0.05);
        let is = |x: f64, y: f64| floor.kind(floor.cell_at(Point::new(x, y)).unwrap()) == Cell::Untestable;
        // The middle rows meet at y = 0; a seam of the row below ends there at some x.
        let ends: Vec<f64> = plates_ends(&bands);
        assert!(!ends.is_empty());
        for x in ends {
            assert!(is(x + 0.3, -0.3) && is(x - 0.3, -0.3), "below, at {x}");
            assert!(!is(x + 0.3, -0.5) && !is(x + 0.5, -0.3), "beyond the square, at {x}");
            assert!(!is(x + 0.3, 0.3), "in the plate above, at {x}");
        }
    }

    /// Where seams that come from below end at y = 0.
    fn plates_ends(bands: &DeadBands) -> Vec<f64> {
        let seams = bands.plates.seams(&Boundary::Circle { radius_m: 6.0 });
        let ends = seams.iter().filter_map(|seam| {
            let (low, high) = (seam.first()?, seam.last()?);
            ((low.x - high.x).abs() < 1e-9 && high.y.abs() < 1e-6 && high.x.abs() < 5.0).then_some(high.x)
        });
        ends.collect()
    }

    #[test]
    fn an_obstacle_that_is_found_leaves_the_untestable_floor_as_it_was() {
        let plates = RegularPlates { annular_m: 0.5, n_annular: 8, length_m: 6.0, width_m: 1.8 };
        let bands = DeadBands { plates: PlateLayout::Regular(plates), band_m: 0.06, square_m: 0.2 };
        let (mut world, before) = floor(&bands, 0.05);
        let shape = Shape::Disc { center: Point::new(2.0, 0.0), radius_m: 0.3 };
        world.obstacles.push(Obstacle {
            id: ObstacleId(1),
            name: "C1".into(),
            shape: shape.clone(),
            known: false,
        });
        let mut maker = FloorMaker::of(&before, &world.as_drawn(), 0.3, 0.6, Point::origin());
        assert_eq!(maker.clone().into_floor(), before);
        let map = ObstacleMap::new(&world.boundary, &world.obstacles);
        maker.update(&world, &map, std::slice::from_ref(&shape));
        let after = maker.into_floor();
        for cell in 0..before.len() {
            let is_solid = shape.distance_m(before.center(cell)) < 0.0;
            let was = before.kind(cell) == Cell::Untestable;
            assert_eq!(after.kind(cell) == Cell::Untestable, was && !is_solid, "{}", before.center(cell));
        }
    }
}
