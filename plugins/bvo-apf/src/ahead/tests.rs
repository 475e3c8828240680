#![allow(clippy::unwrap_used, reason = "tests")]

use super::*;
use crate::machine::tests::settings;
use geometry::{convex::Part, shape::rectangle};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use steering::{KnownMap, Solid};
use world::Boundary;

const HULL_M: f64 = 0.25;
const FLOOR: [(f64, f64); 4] = [(0.0, 0.0), (8.0, 0.0), (8.0, 6.0), (0.0, 6.0)];
/// A floor like [`FLOOR`], with a wall of 4 m that is part of the outline.
const SPUR: [(f64, f64); 8] =
    [(0.0, 0.0), (3.9, 0.0), (3.9, 4.0), (4.1, 4.0), (4.1, 0.0), (8.0, 0.0), (8.0, 6.0), (0.0, 6.0)];
/// A floor like [`FLOOR`], with two such walls, one from each side.
const BEND: [(f64, f64); 12] = [
    (0.0, 0.0),
    (2.9, 0.0),
    (2.9, 4.0),
    (3.1, 4.0),
    (3.1, 0.0),
    (8.0, 0.0),
    (8.0, 6.0),
    (5.1, 6.0),
    (5.1, 2.0),
    (4.9, 2.0),
    (4.9, 6.0),
    (0.0, 6.0),
];
const START: Point = Point::new(1.0, 1.0);
const GOAL: Point = Point::new(7.0, 1.0);

fn map(corners: &[(f64, f64)], boxes: &[[f64; 4]]) -> KnownMap {
    let solid = |(id, [x_0, y_0, x_1, y_1]): (usize, &[f64; 4])| {
        let vertices = rectangle(Point::new(*x_0, *y_0), Point::new(*x_1, *y_1));
        Solid::new(id as u32, Part::Polygon { vertices })
    };
    KnownMap {
        solids: boxes.iter().enumerate().map(solid).collect(),
        wall: Boundary::Polygon { vertices: corners.iter().map(|(x, y)| Point::new(*x, *y)).collect() },
        hull_m: HULL_M,
    }
}

fn walked(mode: Mode, map: KnownMap, start: Point, goal: Point) -> Ahead {
    let mut machine = Machine::new(settings(mode).for_trip((goal - start).norm()), map);
    if mode == Mode::Pre {
        return of_traps::<()>(&machine, start, goal, 0.1, || Ok(())).unwrap();
    }
    let walked = walk::<()>(&mut machine, start, goal, 0.1, || Ok(())).unwrap();
    Ahead { walked, tried: vec![], news: machine.news }
}

/// The length of a mode's path, metres, if the path arrives; no path comes too close to anything.
fn length_m(mode: Mode, map: &KnownMap) -> Option<f64> {
    let ahead = walked(mode, map.clone(), START, GOAL);
    let clearance_m = map.path_clearance_m(&ahead.walked.path, 1.0);
    assert!(clearance_m > 0.0, "{mode:?} {clearance_m}");
    ahead.walked.arrived.then(|| polyline::length_m(&ahead.walked.path))
}

fn assert_within(mode: Mode, map: &KnownMap, most_m: f64) {
    let length_m = length_m(mode, map);
    assert!(length_m.is_some_and(|length_m| length_m < most_m), "{mode:?} {length_m:?}");
}

#[test]
fn a_spur_of_the_outline_is_gone_round_by_every_mode_but_the_paper_s() {
    let map = map(&SPUR, &[]);
    assert_eq!(length_m(Mode::Literal, &map), None);
    assert_within(Mode::Hull, &map, 20.0);
    assert_within(Mode::Rollout, &map, 14.0);
    // The shortest path is 9.1 m long.
    assert_within(Mode::Pre, &map, 9.4);
}

#[test]
fn a_bend_is_left_even_where_no_side_can_be_chosen_in_thought() {
    let map = map(&BEND, &[]);
    let mut machine = Machine::new(settings(Mode::Pre).for_trip((GOAL - START).norm()), map.clone());
    machine.thought_left = 0;
    let ahead = of_traps::<()>(&machine, START, GOAL, 0.1, || Ok(())).unwrap();
    assert!(ahead.walked.arrived && map.path_clearance_m(&ahead.walked.path, 1.0) > 0.0);
}

#[test]
fn a_spur_that_is_an_obstacle_at_the_wall_is_gone_round_by_every_mode() {
    let map = map(&FLOOR, &[[3.9, 0.0, 4.1, 4.0]]);
    for mode in Mode::ALL {
        assert_within(mode, &map, 20.0);
    }
    assert_within(Mode::Pre, &map, 9.4);
}

#[test]
fn a_bend_of_two_spurs_is_followed() {
    let map = map(&BEND, &[]);
    assert_eq!(length_m(Mode::Literal, &map), None);
    for mode in [Mode::Hull, Mode::Rollout] {
        assert_within(mode, &map, 40.0);
    }
    // The shortest path is 10.8 m long.
    assert_within(Mode::Pre, &map, 11.2);
}

#[test]
fn a_room_of_walls_with_a_spur_in_it_is_no_trap() {
    let room = [
        [-0.2, -0.2, 8.2, 0.0],
        [8.0, 0.0, 8.2, 6.0],
        [-0.2, 6.0, 8.2, 6.2],
        [-0.2, 0.0, 0.0, 6.0],
        [3.9, 0.0, 4.1, 4.0],
    ];
    let map = map(&[(-1.2, -1.2), (9.2, -1.2), (9.2, 7.2), (-1.2, 7.2)], &room);
    assert_within(Mode::Pre, &map, 9.4);
}

#[test]
fn where_the_walk_in_thought_finds_no_way_every_other_is_tried_before_it_says_so() {
    let map = map(&FLOOR, &[[3.9, 0.0, 4.1, 6.0]]);
    let ahead = walked(Mode::Pre, map, START, GOAL);
    assert!(!ahead.walked.arrived && ahead.tried.iter().all(|tried| !tried.arrived));
    assert_eq!(ahead.tried.iter().map(|tried| tried.by).collect::<Vec<_>>(), ATTEMPTS);
}

#[test]
fn the_paper_s_own_result_stands_beside_a_way_along_the_outlines() {
    let ahead = walked(Mode::Pre, map(&SPUR, &[]), START, GOAL);
    let said: Vec<String> = ahead.tried.iter().map(ToString::to_string).collect();
    assert_eq!(ahead.tried[1].by, By::Mode(Mode::Literal));
    assert!(said[0].starts_with("simulated walk reaches the goal after"), "{said:?}");
    assert!(said[1].starts_with("mode literal ends at (3.") && said[1].ends_with(" m"), "{said:?}");
}

/// Side of a room, metres.
const SIDE_M: f64 = 3.0;

/// Rooms on a grid, joined by doors of 0.9 m: every room has a door to the north, and the rooms of the south row also
/// have one to the east.
fn rooms(seed: u64) -> KnownMap {
    let mut rng = Pcg64Mcg::seed_from_u64(seed);
    let (n_x, n_y) = (rng.random_range(2..5_u32), rng.random_range(2..5_u32));
    let mut walls: Vec<[f64; 4]> = Vec::new();
    for (x, y) in (0..n_x).flat_map(|x| (0..n_y).map(move |y| (x, y))) {
        let (west, south) = (SIDE_M * f64::from(x), SIDE_M * f64::from(y));
        let (east, north) = (west + SIDE_M, south + SIDE_M);
        let mut door = || rng.random_range(0.3..1.8);
        let (across, along) = (door(), door());
        if y + 1 < n_y {
            walls.push([west, north - 0.05, west + across, north + 0.05]);
            walls.push([west + across + 0.9, north - 0.05, east, north + 0.05]);
        }
        if x + 1 < n_x && y > 0 {
            walls.push([east - 0.05, south, east + 0.05, north]);
        } else if x + 1 < n_x {
            walls.push([east - 0.05, south, east + 0.05, south + along]);
            walls.push([east - 0.05, south + along + 0.9, east + 0.05, north]);
        }
    }
    let (width_m, height_m) = (SIDE_M * f64::from(n_x), SIDE_M * f64::from(n_y));
    map(&[(0.0, 0.0), (width_m, 0.0), (width_m, height_m), (0.0, height_m)], &walls)
}

#[test]
fn rooms_with_doors_are_planned_from_corner_to_corner() {
    for seed in 0..30 {
        let map = rooms(seed);
        let Boundary::Polygon { vertices } = &map.wall else { panic!("the floor is a rectangle") };
        let (start, goal) =
            (Point::new(1.5, vertices[2].y - 1.5), Point::new(vertices[2].x - 1.5, vertices[2].y - 1.5));
        let ahead = walked(Mode::Pre, map.clone(), start, goal);
        assert!(ahead.walked.arrived, "{seed} {:?}", ahead.tried);
        assert!(map.path_clearance_m(&ahead.walked.path, 1.0) > 0.0, "{seed}");
    }
}
