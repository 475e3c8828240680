use super::*;
use nalgebra::Isometry2;
use proptest::prelude::*;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use world::{Obstacle, ObstacleId, ObstacleMap, Shape, Vector, shape::ring_area_m2};

fn map_of(columns: usize, is_free: Vec<bool>) -> OccupancyMap {
    OccupancyMap {
        columns,
        is_free,
        cell_m: 0.5,
        tank_from_map: Isometry2::new(Vector::new(-3.0, 2.0), 0.3),
        unseen: None,
    }
}

fn drawn(rows: &[&str]) -> OccupancyMap {
    map_of(rows[0].len(), rows.iter().rev().flat_map(|row| row.chars().map(|c| c == '.')).collect())
}

fn obstacles(floor: &MapFloor) -> ObstacleMap {
    let obstacle = |(index, vertices): (usize, &Vec<Point>)| {
        let shape = Shape::Polygon { vertices: vertices.clone() };
        Obstacle { id: ObstacleId(index as u32), name: String::new(), shape, known: true }
    };
    let all: Vec<Obstacle> = floor.pieces.iter().enumerate().map(obstacle).collect();
    ObstacleMap::new(&floor.wall, &all)
}

/// Distance from a place to the nearest cell that is not free floor, metres; at most two cells.
fn cell_distance_m(map: &OccupancyMap, floor: &Component, place: Point) -> f64 {
    let at = map.tank_from_map.inverse_transform_point(&place) / map.cell_m;
    let (x, y) = (at.x.floor() as i32, at.y.floor() as i32);
    let around = (-2..=2).flat_map(|dx| (-2..=2).map(move |dy| [x + dx, y + dy]));
    let gap = |cell: i32, v: f64| (f64::from(cell) - v).max(v - f64::from(cell + 1)).max(0.0);
    let solid = around.filter(|cell| !floor.is_free(*cell));
    solid.map(|cell| gap(cell[0], at.x).hypot(gap(cell[1], at.y))).fold(2.0, f64::min) * map.cell_m
}

/// Checks points of a map's box: nothing solid is floor, no clearance is overstated, and no floor is lost beyond the
/// tolerance.
fn check(map: &OccupancyMap, tolerance_m: f64, n_points: usize) {
    let Some(floor) = MapFloor::new(map, None, Some(tolerance_m)) else { return };
    let (component, solids) = (Component::new(map, None).unwrap(), obstacles(&floor));
    assert!(floor.error_m <= tolerance_m + 1e-9);
    let mut random = Pcg64Mcg::seed_from_u64(7);
    let ([west, south], [east, north]) = (component.low.map(f64::from), component.high.map(f64::from));
    for _ in 0..n_points {
        let place = map.to_tank(random.random_range(west..east), random.random_range(south..north));
        let (cells_m, clear_m) = (cell_distance_m(map, &component, place), solids.clearance_m(place));
        assert!(clear_m <= cells_m + 1e-9 || cells_m >= 2.0 * map.cell_m, "{place}: {clear_m} but {cells_m}");
        assert!(
            cells_m <= 0.0 || clear_m > -1e-9 || cells_m <= floor.error_m + 1e-9,
            "{place}: {cells_m} lost"
        );
    }
}

/// Rooms with slanting and round walls, columns and specks.
fn rooms() -> OccupancyMap {
    let mut random = Pcg64Mcg::seed_from_u64(3);
    let is_free = |cell: usize| {
        let (x, y) = ((cell % 300) as f64, (cell / 300) as f64);
        let round = (x - 90.0).hypot(y - 100.0);
        let is_wall = (round - 70.0).abs() < 1.5 && y > 70.0
            || (y - 0.4 * x - 40.0).abs() < 2.0 && x > 170.0
            || (x - y - 60.0).abs() < 2.0 && y < 90.0
            || (x % 30.0 - 15.0).hypot(y % 40.0 - 20.0) < 3.3;
        (2.0..298.0).contains(&x) && (2.0..198.0).contains(&y) && !is_wall && !random.random_bool(0.002)
    };
    map_of(300, (0..300 * 200).map(is_free).collect())
}

#[test]
fn a_hundred_thousand_points_agree_with_the_cells() {
    check(&rooms(), 0.25, 100_000);
    check(&rooms(), 0.5, 100_000);
}

#[test]
fn only_the_floor_of_the_start_stays_free() {
    let map = drawn(&["#######", "#..#..#", "#..#..#", "#..#.##", "#######"]);
    let at = |x: f64, y: f64| map.to_tank(x, y);
    let left = MapFloor::new(&map, Some(at(1.5, 1.5)), None).unwrap();
    assert_eq!((left.n_free, left.n_free_in_map, left.pieces.len()), (6, 11, 0));
    let right = MapFloor::new(&map, Some(at(4.5, 3.5)), None).unwrap();
    assert_eq!((right.n_free, right.n_corners), (5, [6, 5]));
    let Boundary::Polygon { vertices } = &right.wall else { panic!("walls of maps are rectangles") };
    assert!((vertices[0] - at(4.0, 1.0)).norm() < 1e-12 && (vertices[2] - at(6.0, 4.0)).norm() < 1e-12);
    // Solid starts and starts beyond the map fall back to the largest floor.
    for start in [at(3.5, 2.5), at(99.0, 0.0)] {
        assert_eq!(MapFloor::new(&map, Some(start), None).unwrap().n_free, 6);
    }
    assert_eq!(MapFloor::new(&drawn(&["##"]), None, None), None);
}

#[test]
fn a_diagonal_wall_becomes_straight_and_a_dent_is_filled() {
    let stairs = drawn(&["......", "#.....", "##....", "###...", "####.."]);
    let floor = MapFloor::new(&stairs, None, None).unwrap();
    assert_eq!(floor.n_corners, [12, 5]);
    assert!((floor.error_m - 0.25).abs() < 1e-12);
    let dent = drawn(&[".....", ".....", "##.##", "#####"]);
    assert_eq!(MapFloor::new(&dent, None, None).unwrap().n_corners, [8, 4]);
    let slot = drawn(&[".....", ".....", "##.##", "##.##"]);
    assert_eq!(MapFloor::new(&slot, None, None).unwrap().n_corners, [8, 8]);
}

#[test]
fn without_tolerance_the_cells_are_kept_exactly() {
    let map = rooms();
    let floor = MapFloor::new(&map, None, Some(0.0)).unwrap();
    assert_eq!(floor.n_corners[0], floor.n_corners[1]);
    let solid_m2: f64 = floor.pieces.iter().map(|piece| ring_area_m2(piece)).sum();
    assert!((floor.wall.area_m2() - solid_m2 - floor.n_free as f64 * 0.25).abs() < 1e-6);
}

proptest! {
    #[test]
    fn any_map_is_kept_on_the_safe_side(
        cells in prop::collection::vec(prop::bool::weighted(0.7), 24 * 18),
        tolerance_m in prop::sample::select(vec![0.0, 0.25, 0.37, 0.5]),
    ) {
        check(&map_of(24, cells), tolerance_m, 1000);
    }

    #[test]
    fn pieces_are_convex_and_do_not_overlap(cells in prop::collection::vec(prop::bool::weighted(0.6), 20 * 20)) {
        let map = map_of(20, cells);
        let floor = MapFloor::new(&map, None, None).unwrap();
        let solids = obstacles(&floor);
        for (index, piece) in floor.pieces.iter().enumerate() {
            let n = piece.len();
            let side = |k: usize| piece[(k + 1) % n] - piece[k % n];
            let is_convex = (0..n).all(|k| side(k).perp(&side(k + 1)) > 1e-6);
            prop_assert!(is_convex);
            let middle = world::shape::mean_of(piece);
            let owners = solids.within(middle, 0.0);
            prop_assert_eq!(owners.iter().map(|near| near.index).collect::<Vec<_>>(), [index]);
        }
    }
}
