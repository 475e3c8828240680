use super::*;
use crate::{Boundary, Obstacle, ObstacleId, Zone};

fn tank(discs: &[(f64, f64, f64)]) -> World {
    let obstacle = |(i, (x, y, r)): (usize, &(f64, f64, f64))| Obstacle {
        id: ObstacleId(i as u32),
        name: String::new(),
        shape: Shape::Disc { center: Point::new(*x, *y), radius_m: *r },
        known: true,
    };
    let obstacles = discs.iter().enumerate().map(obstacle).collect();
    World { boundary: Boundary::Circle { radius_m: 5.0 }, obstacles, stations: vec![], zones: vec![] }
}

fn kind(floor: &Floor, x: f64, y: f64) -> Cell {
    floor.kind(floor.cell_at(Point::new(x, y)).expect("in the grid"))
}

#[test]
fn floor_that_the_tool_cannot_reach_says_why() {
    let mut world = tank(&[(2.0, 0.0, 0.3)]);
    let shape = Shape::Disc { center: Point::new(-2.0, 0.0), radius_m: 1.0 };
    world.zones.push(Zone { name: "sump".into(), kind: ZoneKind::NoGo, shape });
    let floor = Floor::new(&world, 0.05, 0.5, 0.6, Point::origin());
    assert_eq!(kind(&floor, 4.9, 0.0), Cell::Margin);
    assert_eq!(kind(&floor, 4.7, 0.0), Cell::Reachable);
    assert_eq!(kind(&floor, 2.0, 0.4), Cell::Beside);
    assert_eq!(kind(&floor, 2.0, 0.0), Cell::Outside);
    assert_eq!(kind(&floor, -2.0, 0.0), Cell::NoGo);
    assert_eq!(kind(&floor, 0.0, 0.0), Cell::Reachable);
}

#[test]
fn a_gap_at_the_shell_that_is_too_narrow_is_beside_the_column_and_no_margin() {
    let floor = Floor::new(&tank(&[(4.1, 0.0, 0.3)]), 0.05, 0.5, 0.6, Point::origin());
    assert_eq!(kind(&floor, 4.72, 0.02), Cell::Beside);
    assert_eq!(kind(&floor, 4.92, 0.02), Cell::Margin);
    assert_eq!(kind(&floor, -4.72, 0.02), Cell::Reachable);
}

#[test]
fn asking_blocks_first_gives_the_same_floor_as_asking_every_cell() {
    let world = tank(&[(2.0, 0.0, 0.3), (2.9, 0.1, 0.2), (-1.0, 3.0, 0.5), (-4.6, 0.0, 0.2)]);
    for (cell_m, room_m) in [(0.05, 0.35), (0.1, 0.2), (0.03, 0.6)] {
        let mut maker = FloorMaker::new(&world, cell_m, room_m, 0.5, Point::origin());
        let map = ObstacleMap::new(&world.boundary, &world.obstacles);
        let clearance_m = |cell| map.clearance_m(maker.floor.center(cell)) as f32;
        let exact: Vec<f32> = (0..maker.floor.len()).map(clearance_m).collect();
        let n_asked =
            exact.iter().zip(&maker.clearance_m).filter(|(a, b)| a.to_bits() == b.to_bits()).count();
        assert!(n_asked < exact.len() / 2, "{n_asked} of {}", exact.len());
        let floor = maker.clone().into_floor();
        maker.clearance_m = exact;
        maker.classify(&world);
        assert_eq!(maker.into_floor(), floor, "cells of {cell_m} m, room of {room_m} m");
    }
}

#[test]
fn blocks_whose_middle_lies_on_the_side_of_a_box_are_asked_cell_by_cell() {
    let corner = |x: f64, y: f64| Point::new(1.4 + 0.6 * x, -1.4 + 0.4 * y);
    let vertices = vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
    let mut world = tank(&[]);
    world.boundary = Boundary::Polygon {
        vertices: [(-4.8, -2.8), (4.8, -2.8), (4.8, 2.8), (-4.8, 2.8)]
            .map(|(x, y)| Point::new(x, y))
            .to_vec(),
    };
    let shape = Shape::Polygon { vertices };
    world.obstacles.push(Obstacle { id: ObstacleId(0), name: String::new(), shape, known: true });
    let floor = Floor::new(&world, 0.05, 0.3, 0.6, Point::origin());
    let solid = (0..floor.len()).filter(|cell| floor.kind(*cell) == Cell::Outside).count();
    assert_eq!(solid, 24 * 16, "cells of a box of 1.2 m by 0.8 m");
}

#[test]
fn a_found_obstacle_gives_the_floor_that_it_would_have_given_from_the_start() {
    let (before, after) = (tank(&[(2.0, 0.0, 0.3)]), tank(&[(2.0, 0.0, 0.3), (-1.0, 2.0, 0.4)]));
    let make = |world: &World| FloorMaker::new(world, 0.05, 0.35, 0.5, Point::origin());
    let mut maker = make(&before);
    let mut updated = Floor::new(&before, 0.05, 0.35, 0.5, Point::origin());
    let map = ObstacleMap::new(&after.boundary, &after.obstacles);
    let changes = maker.update(&after, &map, &[after.obstacles[1].shape.clone()]);
    updated.change(&changes);
    let rebuilt = make(&after).into_floor();
    assert_eq!((&maker.into_floor(), &updated), (&rebuilt, &rebuilt));
    assert!(!changes.is_empty() && changes.len() < 200);
}

/// Places where the robot might stand, close together.
struct Stands {
    at: Vec<Point>,
    columns: usize,
}

const PITCH_M: f64 = 0.01;

impl Stands {
    fn new(world: &World) -> Self {
        let (low, high) = world.boundary.bounds();
        let count = |span_m: f64| (span_m / PITCH_M) as usize + 1;
        let (columns, rows) = (count(high.x - low.x), count(high.y - low.y));
        let place = |k: usize| low + Vector::new((k % columns) as f64, (k / columns) as f64) * PITCH_M;
        Self { at: (0..columns * rows).map(place).collect(), columns }
    }

    /// Marks the places with this much clearance to which the robot can drive from the start, step by step.
    fn with_room(&self, world: &World, room_m: f64, start: Point) -> Vec<bool> {
        let solid_m = |at: Point| {
            let zones = world.zones.iter().map(|zone| zone.shape.distance_m(at));
            let solids = world.obstacles.iter().map(|obstacle| obstacle.shape.distance_m(at)).chain(zones);
            solids.fold(world.boundary.wall_distance_m(at), f64::min)
        };
        let free: Vec<bool> = self.at.iter().map(|at| solid_m(*at) >= room_m).collect();
        let off_m = |k: &usize| (self.at[*k] - start).norm();
        let first = (0..free.len()).filter(|k| free[*k]).min_by(|a, b| off_m(a).total_cmp(&off_m(b)));
        let mut found = vec![false; free.len()];
        let mut open: Vec<usize> = first.into_iter().collect();
        while let Some(k) = open.pop() {
            if !std::mem::replace(&mut found[k], true) {
                let near = crate::coverage::neighbours(k, self.columns, free.len());
                open.extend(near.filter(|next| free[*next] && !found[*next]));
            }
        }
        found
    }

    fn reach(&self, from: &[bool], low: Point, place: Point, reach_m: f64) -> bool {
        let index = |m: f64| (m / PITCH_M).floor();
        let (first, last) = (place - low - Vector::repeat(reach_m), place - low + Vector::repeat(reach_m));
        let rows = index(first.y).max(0.0) as usize..=index(last.y).max(0.0) as usize + 1;
        let columns =
            index(first.x).max(0.0) as usize..=(index(last.x).max(0.0) as usize + 1).min(self.columns - 1);
        rows.flat_map(|row| columns.clone().map(move |column| row * self.columns + column))
            .any(|k| k < from.len() && from[k] && (self.at[k] - place).norm() <= reach_m)
    }
}

/// Three numbers of floor cells: those on which brute force and the floor disagree, those that brute force cannot
/// decide, and all.
fn disagreements(world: &World, cell_m: f64, room_m: f64, swath_m: f64, start: Point) -> [usize; 3] {
    let floor = Floor::new(world, cell_m, room_m, swath_m, start);
    let stands = Stands::new(world);
    let slack_m = PITCH_M * std::f64::consts::FRAC_1_SQRT_2;
    let sure = stands.with_room(world, room_m, start);
    let perhaps = stands.with_room(world, room_m - slack_m, start);
    let low = world.boundary.bounds().0;
    let [mut wrong, mut open, mut all] = [0; 3];
    for cell in (0..floor.len()).filter(|cell| floor.is_floor(*cell)) {
        let center = floor.center(cell);
        all += 1;
        let is_sure = stands.reach(&sure, low, center, swath_m / 2.0);
        let is_possible = is_sure || stands.reach(&perhaps, low, center, swath_m / 2.0 + slack_m);
        open += usize::from(is_sure != is_possible);
        let is_wrong = is_sure == is_possible && floor.is_reachable(cell) != is_sure;
        wrong += usize::from(is_wrong);
    }
    [wrong, open, all]
}

fn boxed(corners: &[(f64, f64)]) -> Vec<Point> {
    corners.iter().map(|(x, y)| Point::new(*x, *y)).collect()
}

fn obstacle(id: u32, shape: Shape) -> Obstacle {
    Obstacle { id: ObstacleId(id), name: String::new(), shape, known: true }
}

fn tanks() -> Vec<(&'static str, World)> {
    let round = |radius_m: f64, discs: &[(f64, f64, f64)]| World {
        boundary: Boundary::Circle { radius_m },
        ..tank(discs)
    };
    let rooms = |corners: &[(f64, f64)], discs: &[(f64, f64, f64)]| World {
        boundary: Boundary::Polygon { vertices: boxed(corners) },
        ..tank(discs)
    };
    let square = [(-2.5, -2.0), (2.5, -2.0), (2.5, 2.0), (-2.5, 2.0)];
    let bent = [(-3.0, -2.0), (3.0, -2.0), (3.0, 0.0), (0.4, 0.0), (0.4, 2.5), (-3.0, 2.5)];
    let slanting = [(-2.0, -2.0), (2.3, -1.1), (1.6, 2.2), (-2.4, 1.7)];
    let mut mixed = rooms(&square, &[(0.9, 0.4, 0.2)]);
    let walls = [
        Shape::Polygon { vertices: boxed(&[(-1.2, -0.6), (-0.2, -0.3), (-0.5, 0.4)]) },
        Shape::Polyline { points: boxed(&[(1.2, -1.2), (2.0, -0.7), (1.9, 0.1)]), half_width_m: 0.05 },
    ];
    mixed.obstacles.extend((7..).zip(walls).map(|(id, shape)| obstacle(id, shape)));
    let mut zoned = round(3.0, &[(1.0, 1.0, 0.3)]);
    let shape = Shape::Disc { center: Point::new(-1.2, -0.4), radius_m: 0.5 };
    zoned.zones.push(Zone { name: "sump".into(), kind: ZoneKind::NoGo, shape });
    vec![
        ("round", round(3.0, &[])),
        ("square", rooms(&square, &[])),
        ("bent", rooms(&bent, &[])),
        ("slanting", rooms(&slanting, &[(0.0, 0.3, 0.15)])),
        ("columns", round(3.0, &[(1.2, 0.0, 0.15), (-1.2, 0.3, 0.15), (0.1, 1.4, 0.2), (0.0, -1.6, 0.3)])),
        // Between these columns, and between one of them and the shell, the robot only just fits or only just does not
        // fit.
        ("gate", round(3.0, &[(0.0, 1.0, 0.2), (0.0, -0.13, 0.2), (0.0, -1.4, 0.2), (0.0, 2.2, 0.12)])),
        (
            "closed",
            round(
                3.0,
                &[(1.0, 0.0, 0.4), (1.0, 1.3, 0.4), (1.0, -1.3, 0.4), (1.1, 2.3, 0.3), (1.1, -2.3, 0.3)],
            ),
        ),
        ("pocket", round(3.0, &[(1.0, 0.0, 0.3), (-0.5, 0.9, 0.3), (-0.5, -0.9, 0.3)])),
        ("mixed", mixed),
        ("zoned", zoned),
    ]
}

#[test]
fn the_floor_in_reach_is_what_brute_force_finds_in_ten_tanks_whose_lanes_reach_the_shell() {
    for (name, world) in tanks() {
        for (cell_m, room_m, swath_m) in [(0.05, 0.35, 0.7), (0.05, 0.3, 0.6), (0.04, 0.4, 0.7)] {
            let [wrong, open, all] = disagreements(&world, cell_m, room_m, swath_m, Point::new(-1.9, 0.0));
            assert_eq!(wrong, 0, "{name}, cells of {cell_m} m, room of {room_m} m: of {all}, {open} open");
            assert!(20 * open < all, "{name}, room of {room_m} m: {open} open of {all}");
        }
    }
}

#[test]
fn a_passage_that_no_cell_shows_leads_on_and_one_that_is_too_narrow_by_a_hair_does_not() {
    for (gap_m, leads) in [(0.7005, true), (0.7001, true), (0.7, true), (0.6999, false), (0.69, false)] {
        // Two walls of boxes leave a passage 1.2 m long at the side of a tank; no row of cells lies in its middle.
        let mut world = tank(&[]);
        world.boundary =
            Boundary::Polygon { vertices: boxed(&[(0.0, 0.0), (6.0, 0.0), (6.0, 3.0), (0.0, 3.0)]) };
        let low = 1.113;
        let walls = [
            [(2.4, 0.0), (3.6, 0.0), (3.6, low), (2.4, low)],
            [(2.4, low + gap_m), (3.6, low + gap_m), (3.6, 3.0), (2.4, 3.0)],
        ];
        let walls = walls.map(|corners| Shape::Polygon { vertices: boxed(&corners) });
        world.obstacles = (0..).zip(walls).map(|(id, shape)| obstacle(id, shape)).collect();
        let floor = Floor::new(&world, 0.05, 0.35, 0.7, Point::new(1.0, 1.5));
        let beyond = kind(&floor, 5.0, 1.5);
        assert_eq!(beyond == Cell::Reachable, leads, "{gap_m}: {beyond:?}");
        assert_eq!(kind(&floor, 3.0, low + 0.35) == Cell::Reachable, leads, "in the passage of {gap_m}");
    }
}
