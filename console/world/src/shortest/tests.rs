use super::*;
use crate::{
    ObstacleMap,
    tank::{Obstacle, ObstacleId},
};
use geometry::{Boundary, Shape, Vector, polyline};
use proptest::prelude::*;
use std::f64::consts::PI;

const ROUND: Boundary = Boundary::Circle { radius_m: 10.0 };

fn disc(x: f64, y: f64, radius_m: f64) -> Shape {
    Shape::Disc { center: Point::new(x, y), radius_m }
}

fn square(x: f64, y: f64, half: f64) -> Shape {
    let corner = |dx: f64, dy: f64| Point::new(x + dx * half, y + dy * half);
    Shape::Polygon {
        vertices: vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)],
    }
}

fn floor(boundary: &Boundary, shapes: &[Shape], keep_m: f64) -> GrownFloor {
    GrownFloor::new(boundary, keep_m, shapes.iter().map(|shape| (shape, keep_m)))
}

fn shortest(floor: &GrownFloor, start: (f64, f64), goal: (f64, f64)) -> Result<Way, NoWay> {
    floor.shortest(Point::new(start.0, start.1), Point::new(goal.0, goal.1), &mut || true)
}

#[test]
fn past_one_disc_it_is_two_tangents_and_an_arc() {
    let floor = floor(&ROUND, &[disc(0.0, 0.0, 0.7)], 0.3);
    let way = shortest(&floor, (-5.0, 0.0), (5.0, 0.0)).unwrap();
    let exact_m = 2.0 * 24.0_f64.sqrt() + PI - 2.0 * (0.2_f64).acos();
    assert!((way.length_m - exact_m).abs() < 1e-12, "{} {exact_m}", way.length_m);
    assert_eq!(way.pieces.len(), 3);
}

#[test]
fn a_way_may_begin_and_end_on_the_circle_it_turns_about() {
    let floor = floor(&ROUND, &[disc(0.0, 0.0, 0.7)], 0.3);
    for lift_m in [-5e-10, 0.0, 5e-10] {
        let way = shortest(&floor, (-1.0 - lift_m, 0.0), (0.0, 1.0 + lift_m)).unwrap();
        assert!((way.length_m - PI / 2.0).abs() < 1e-4, "{lift_m} {}", way.length_m);
    }
}

#[test]
fn a_free_way_is_straight() {
    let way = shortest(&floor(&ROUND, &[disc(0.0, 3.0, 1.0)], 0.2), (-5.0, 0.0), (5.0, 0.0)).unwrap();
    assert_eq!(way.points(), [Point::new(-5.0, 0.0), Point::new(5.0, 0.0)]);
}

#[test]
fn past_a_square_it_goes_along_the_side_and_round_the_corners() {
    let way = shortest(&floor(&ROUND, &[square(0.0, 0.0, 1.0)], 0.5), (-1.5, 1.2), (1.5, 1.2)).unwrap();
    // Both ends lie on the grown sides: up to the corner, a quarter turn about it, along the top, and back down.
    let part_m = (1.2_f64 - 1.0).hypot(0.0);
    assert!(way.length_m < 2.0 + PI * 0.5 && way.length_m > 2.0 + 2.0 * part_m);
    assert!(way.points().iter().all(|p| square(0.0, 0.0, 1.0).distance_m(*p) >= 0.5 - 1e-9));
}

#[test]
fn a_closed_ring_is_proved_to_be_closed_and_a_gap_is_found() {
    let ring = |n: u32, of: u32| -> Vec<Shape> {
        let bearing = |k: u32| 2.0 * PI * f64::from(k) / f64::from(of);
        (0..n).map(|k| disc(2.0 * bearing(k).cos(), 2.0 * bearing(k).sin(), 0.4)).collect()
    };
    let closed = floor(&ROUND, &ring(12, 12), 0.2);
    assert!(matches!(
        shortest(&closed, (-5.0, 0.0), (0.0, 0.0)),
        Err(NoWay::Unreachable { n_tangents: 1.. })
    ));
    let open = floor(&ROUND, &ring(11, 12), 0.2);
    assert!(shortest(&open, (-5.0, 0.0), (0.0, 0.0)).is_ok());
}

#[test]
fn a_wall_between_round_tank_and_column_leaves_no_way_behind_it() {
    let bar =
        Shape::Polyline { points: vec![Point::new(0.0, -12.0), Point::new(0.0, 9.5)], half_width_m: 0.1 };
    assert!(shortest(&floor(&ROUND, std::slice::from_ref(&bar), 0.21), (-5.0, 0.0), (5.0, 0.0)).is_err());
    assert!(shortest(&floor(&ROUND, &[bar], 0.19), (-5.0, 0.0), (5.0, 0.0)).is_ok());
}

#[test]
fn the_corner_of_a_straight_wall_is_turned_about() {
    let corner = |x: f64, y: f64| Point::new(x, y);
    let l_shaped = Boundary::Polygon {
        vertices: vec![
            corner(-5.0, -5.0),
            corner(5.0, -5.0),
            corner(5.0, 0.0),
            corner(0.0, 0.0),
            corner(0.0, 5.0),
            corner(-5.0, 5.0),
        ],
    };
    let way = shortest(&floor(&l_shaped, &[], 0.5), (4.0, -1.0), (-1.0, 4.0)).unwrap();
    assert_eq!(way.pieces.len(), 3);
    assert!(way.points().iter().all(|p| l_shaped.wall_distance_m(*p) >= 0.5 - 1e-9));
}

#[test]
fn ends_that_do_not_fit_are_named() {
    let floor = floor(&ROUND, &[disc(0.0, 0.0, 1.0), square(5.0, 0.0, 1.0)], 0.3);
    assert!(matches!(shortest(&floor, (0.5, 0.0), (3.0, 0.0)), Err(NoWay::StartBlocked { .. })));
    assert!(matches!(shortest(&floor, (2.0, 0.0), (5.0, 0.0)), Err(NoWay::GoalBlocked { .. })));
    assert!(matches!(shortest(&floor, (2.0, 0.0), (9.9, 0.0)), Err(NoWay::GoalBlocked { .. })));
    assert!(matches!(shortest(&floor, (f64::NAN, 0.0), (3.0, 0.0)), Err(NoWay::StartBlocked { .. })));
}

#[test]
fn a_point_robot_does_not_pass_through_walls_of_no_thickness() {
    let line =
        Shape::Polyline { points: vec![Point::new(0.0, -3.0), Point::new(0.0, 4.0)], half_width_m: 0.0 };
    let way = shortest(&floor(&ROUND, &[line], 0.0), (-4.0, 0.0), (4.0, 0.0)).unwrap();
    assert!((way.length_m - 10.0).abs() < 1e-4);
}

fn any_shape() -> impl Strategy<Value = Shape> {
    let at = || (-7.0..7.0_f64, -7.0..7.0_f64);
    prop_oneof![
        3 => (at(), 0.1..1.6_f64).prop_map(|((x, y), r)| disc(x, y, r)),
        2 => (at(), 0.2..1.4_f64, 0.0..PI).prop_map(|((x, y), half, turn)| {
            square(0.0, 0.0, half).transformed(&nalgebra::Isometry2::new(Vector::new(x, y), turn))
        }),
        1 => (at(), at(), 0.05..0.3_f64).prop_map(|((x, y), (u, v), half_width_m)| Shape::Polyline {
            points: vec![Point::new(x, y), Point::new(u, v), Point::new(u * 0.5, -v)],
            half_width_m,
        }),
    ]
}

/// The reference: Dijkstra over points just outside of every grown circle, with the obstacle map's own distances.
fn polygonised_m(map: &ObstacleMap, shapes: &[Shape], keep_m: f64, start: Point, goal: Point) -> Option<f64> {
    const N: u32 = 24;
    let circle = |at: Point, radius_m: f64| {
        (0..N).map(move |k| {
            let bearing = 2.0 * PI * f64::from(k) / f64::from(N);
            at + Vector::new(bearing.cos(), bearing.sin()) * (radius_m / (PI / f64::from(N)).cos() + 1e-4)
        })
    };
    let mut points = vec![start, goal];
    for shape in shapes {
        match shape {
            Shape::Disc { center, radius_m } => points.extend(circle(*center, radius_m + keep_m)),
            Shape::Polygon { vertices } => points.extend(vertices.iter().flat_map(|v| circle(*v, keep_m))),
            Shape::Polyline { points: line, half_width_m } => {
                points.extend(line.iter().flat_map(|v| circle(*v, half_width_m + keep_m)));
            }
        }
    }
    points.retain(|p| map.clearance_m(*p) >= keep_m);
    let mut way_m = vec![f64::INFINITY; points.len()];
    let mut done = vec![false; points.len()];
    way_m[0] = 0.0;
    loop {
        let open = (0..points.len()).filter(|i| !done[*i] && way_m[*i].is_finite());
        let next = open.min_by(|a, b| way_m[*a].total_cmp(&way_m[*b]))?;
        if next == 1 {
            return Some(way_m[1]);
        }
        done[next] = true;
        for other in 0..points.len() {
            let through_m = way_m[next] + (points[other] - points[next]).norm();
            if !done[other]
                && through_m < way_m[other]
                && map.segment_clearance_m(points[next], points[other]) >= keep_m
            {
                way_m[other] = through_m;
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(150))]

    #[test]
    fn among_many_corners_the_way_is_that_of_a_search_among_all(
        columns in prop::collection::vec((-9.0..9.0_f64, -9.0..9.0_f64, 0.05..0.5_f64), 60..140),
        from in (-8.0..8.0_f64, -8.0..8.0_f64),
        step in (-4.0..4.0_f64, -4.0..4.0_f64),
    ) {
        let shapes: Vec<Shape> = columns.iter().map(|(x, y, radius_m)| disc(*x, *y, *radius_m)).collect();
        let floor = floor(&ROUND, &shapes, 0.1);
        let (start, goal) = (Point::new(from.0, from.1), Point::new(from.0 + step.0, from.1 + step.1));
        let all: Vec<usize> = (0..floor.corners.len()).collect();
        if floor.check_ends(start, goal).is_ok() {
            let among_all = floor.search(start, goal, &all, &mut || true);
            prop_assert_eq!(floor.shortest(start, goal, &mut || true), among_all);
        }
    }

    #[test]
    fn a_shortest_way_is_clear_and_no_polygonised_way_is_shorter(
        shapes in prop::collection::vec(any_shape(), 1..9),
        straight in any::<bool>(),
        keep_m in 0.05..0.5_f64,
    ) {
        let corners = [(-9.0, -9.0), (9.0, -9.0), (8.0, 2.0), (3.0, 3.5), (2.0, 9.0), (-9.0, 8.0)];
        let polygon = Boundary::Polygon { vertices: corners.iter().map(|(x, y)| Point::new(*x, *y)).collect() };
        let boundary = if straight { polygon } else { ROUND };
        let obstacle = |(i, s): (usize, &Shape)| Obstacle {
            id: ObstacleId(i as u32), name: String::new(), shape: s.clone(), known: true,
        };
        let obstacles: Vec<Obstacle> = shapes.iter().enumerate().map(obstacle).collect();
        let map = ObstacleMap::new(&boundary, &obstacles);
        let (start, goal) = (Point::new(-8.0, -5.0), Point::new(7.0, 1.5));
        prop_assume!(map.clearance_m(start) > keep_m && map.clearance_m(goal) > keep_m);
        let floor = floor(&boundary, &shapes, keep_m);
        let reference_m = polygonised_m(&map, &shapes, keep_m, start, goal);
        match floor.shortest(start, goal, &mut || true) {
            Ok(way) => {
                let points = way.points();
                let drawn_m = polyline::length_m(&points);
                prop_assert!(drawn_m >= way.length_m - 1e-9 && drawn_m <= way.length_m * 1.0005);
                prop_assert_eq!((points[0], *points.last().unwrap()), (start, goal));
                for pair in points.windows(2) {
                    prop_assert!(map.segment_clearance_m(pair[0], pair[1]) >= keep_m - 1e-6);
                }
                if let Some(reference_m) = reference_m {
                    prop_assert!(way.length_m <= reference_m + 1e-9, "{} {}", way.length_m, reference_m);
                }
            }
            Err(error) => {
                let proved = matches!(error, NoWay::Unreachable { .. });
                prop_assert!(proved && reference_m.is_none(), "{error} but {reference_m:?}");
            }
        }
    }
}

#[test]
fn a_solid_in_pieces_is_as_good_as_a_whole_one() {
    let piece = |west: f64, south: f64, east: f64, north: f64| Shape::Polygon {
        vertices: geometry::shape::rectangle(Point::new(west, south), Point::new(east, north)),
    };
    let whole = floor(&ROUND, &[piece(0.0, -2.0, 3.0, 2.0)], 0.5);
    let pieces = [(0.0, -2.0, 1.0, 0.5), (0.0, 0.5, 1.0, 2.0), (1.0, -2.0, 3.0, 0.5), (1.0, 0.5, 3.0, 2.0)];
    let pieces = floor(&ROUND, &pieces.map(|(w, s, e, n)| piece(w, s, e, n)), 0.5);
    let length_m = |floor| shortest(floor, (-3.0, -0.4), (5.0, 0.3)).unwrap().length_m;
    assert!((length_m(&whole) - length_m(&pieces)).abs() < 1e-12);
    // The points where pieces meet along a straight side are not corners.
    assert_eq!((whole.corners.len(), pieces.corners.len()), (4, 4));
    assert!(pieces.spare_m(Point::new(1.0, 0.5)) < 0.0);
}
