use super::{funnel::Funnel, *};
use geometry::{Boundary, Point, Shape, Vector};
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};

const WALL: Boundary = Boundary::Circle { radius_m: 50.0 };

fn disc(x: f64, y: f64, radius_m: f64) -> Shape {
    Shape::Disc { center: Point::new(x, y), radius_m }
}

fn square(x: f64, y: f64, half: f64) -> Shape {
    let corner = |dx: f64, dy: f64| Point::new(x + dx * half, y + dy * half);
    Shape::Polygon { vertices: vec![corner(-1., -1.), corner(1., -1.), corner(1., 1.), corner(-1., 1.)] }
}

fn cable(anchor: Point, shapes: &[Shape]) -> Cable {
    Cable::new(anchor, &WALL, shapes).unwrap()
}

/// A ring of points round a place, counter-clockwise.
fn loops(x: f64, y: f64, radius_m: f64, turns: f64) -> Vec<Point> {
    let steps = (turns.abs() * 40.0).ceil() as usize;
    (0..=steps)
        .map(|k| {
            let angle = TAU * turns * k as f64 / steps as f64;
            Point::new(x + radius_m * angle.cos(), y + radius_m * angle.sin())
        })
        .collect()
}

/// The polygon through points of a disc's outline, or the polygon itself.
fn ring_of(shape: &Shape, corners: u32) -> Vec<Point> {
    match shape {
        Shape::Disc { center, radius_m } => (0..corners)
            .map(|k| {
                let angle = TAU * (f64::from(k) + 0.37) / f64::from(corners);
                center + Vector::new(angle.cos(), angle.sin()) * *radius_m
            })
            .collect(),
        Shape::Polygon { vertices } => vertices.clone(),
        Shape::Polyline { .. } => unreachable!("not drawn by these tests"),
    }
}

fn keeps_away(shapes: &[Shape], a: Point, b: Point, room_m: f64) -> bool {
    let obstacles = CableObstacles::grown(&WALL, shapes, room_m);
    obstacles.is_open(a, b)
}

/// A walk from the anchor whose moves all keep some distance from the shapes.
fn walk(anchor: Point, goals: &[(f64, f64)], shapes: &[Shape], room_m: f64) -> Vec<Point> {
    let mut way = vec![anchor];
    for (x, y) in goals {
        let goal = Point::new(*x, *y);
        if keeps_away(shapes, *way.last().unwrap(), goal, room_m) {
            way.push(goal);
        }
    }
    way
}

fn apart(shapes: Vec<Shape>, anchor: Point, gap_m: f64) -> Vec<Shape> {
    let mut kept: Vec<Shape> = Vec::new();
    let reach = |s: &Shape| match s {
        Shape::Disc { radius_m, .. } => *radius_m,
        _ => ring_of(s, 0).iter().map(|p| (p - s.center()).norm()).fold(0.0, f64::max),
    };
    for shape in shapes {
        let clear = |s: &Shape| (s.center() - shape.center()).norm() > reach(s) + reach(&shape) + gap_m;
        if kept.iter().all(clear) && (shape.center() - anchor).norm() > reach(&shape) + gap_m {
            kept.push(shape);
        }
    }
    kept
}

fn places(most: usize) -> impl Strategy<Value = Vec<(f64, f64)>> {
    prop::collection::vec((-8.0..8.0_f64, -8.0..8.0_f64), 1..most)
}

#[test]
fn a_cable_without_obstacles_is_straight() {
    let mut cable = cable(Point::new(1.0, 0.0), &[]);
    cable.drag_along(&loops(0.0, 0.0, 3.0, 2.5));
    assert!((cable.length_m() - 4.0).abs() < 1e-9 && cable.is_straight());
}

#[test]
fn loops_round_a_column_are_counted_in_full() {
    for turns in [1.0_f64, 3.0, -2.0] {
        let mut cable = cable(Point::new(4.0, 0.0), &[disc(0.0, 0.0, 0.5)]);
        cable.drag_along(&loops(0.0, 0.0, 2.0, turns));
        let contacts = cable.contacts();
        assert_eq!(contacts.len(), 1);
        // The part of the turns that remains beside the tangents from anchor and robot.
        let ends = (0.5_f64 / 4.0).acos() + (0.5_f64 / 2.0).acos();
        let wrap = TAU * turns - ends.copysign(turns);
        assert!((contacts[0].wrap_rad - wrap).abs() < 1e-9, "{contacts:?}");
        let straight = (16.0_f64 - 0.25).sqrt() + (4.0_f64 - 0.25).sqrt();
        assert!((cable.length_m() - straight - 0.5 * wrap.abs()).abs() < 1e-9);
        assert_eq!(cable.signature().crossings().len(), turns.abs() as usize);
    }
}

#[test]
fn a_cable_round_a_pipe_and_a_box_bears_once_on_each() {
    let pipe =
        Shape::Polyline { points: vec![Point::new(2.0, -1.0), Point::new(2.0, 2.0)], half_width_m: 0.1 };
    let mut cable = cable(Point::origin(), &[pipe, square(6.0, 0.0, 1.0)]);
    cable.drag_along(&[
        Point::new(1.0, 4.0),
        Point::new(4.0, 4.0),
        Point::new(4.0, -4.0),
        Point::new(9.0, -4.0),
    ]);
    cable.drag_to(Point::new(9.0, 3.0));
    let on: Vec<Bearing> = cable.contacts().iter().map(|c| c.on).collect();
    assert_eq!(on, [Bearing::Obstacle(0), Bearing::Obstacle(1)]);
    assert!(cable.contacts()[0].wrap_rad < -PI / 4.0 && cable.contacts()[1].wrap_rad > PI / 2.0);
    assert!((geometry::polyline::length_m(&cable.taut_line()) - cable.length_m()).abs() < 1e-3);
}

#[test]
fn an_inward_corner_of_the_wall_bends_the_cable() {
    let corners = [(0., 0.), (8., 0.), (8., 8.), (4., 8.), (4., 4.), (0., 4.)];
    let boundary = Boundary::Polygon { vertices: corners.iter().map(|(x, y)| Point::new(*x, *y)).collect() };
    let mut cable = Cable::new(Point::new(1.0, 3.0), &boundary, &[]).unwrap();
    cable.drag_along(&[Point::new(6.0, 2.0), Point::new(5.0, 7.0)]);
    assert_eq!(cable.contacts()[0].on, Bearing::Wall);
    assert!((cable.length_m() - (10.0_f64.sqrt() + 10.0_f64.sqrt())).abs() < 1e-9);
}

#[test]
fn two_columns_that_overlap_are_bridged() {
    let shapes = [disc(0.0, 0.0, 1.0), disc(1.2, 0.0, 1.0), disc(0.1, 0.0, 0.3)];
    let mut cable = cable(Point::new(-3.0, 0.0), &shapes);
    cable.drag_along(&[Point::new(-1.5, 2.0), Point::new(2.7, 2.0), Point::new(4.2, 0.0)]);
    let straight = 3.0_f64.mul_add(3.0, -1.0).sqrt();
    let wrap = (1.0_f64 / 3.0).asin();
    assert!((cable.length_m() - (2.0 * straight + 1.2 + 2.0 * wrap)).abs() < 1e-9, "{}", cable.length_m());
    assert_eq!(cable.contacts().len(), 2);
}

#[test]
fn the_longest_cable_is_the_one_at_the_corner_farthest_out() {
    let way = [Point::new(-1.0, 2.0), Point::new(3.0, 1.0), Point::new(3.0, -1.0), Point::new(3.0, 1.0)];
    let longest = cable(Point::new(-3.0, 0.0), &[disc(0.0, 0.0, 0.5)]).at_longest(&way);
    assert!((longest.tip() - way[2]).norm() < 1e-12 && longest.contacts().len() == 1);
}

#[test]
fn an_anchor_must_stand_on_free_floor() {
    let inside = Cable::new(Point::new(2.1, 0.0), &WALL, &[disc(2.0, 0.0, 0.5)]).unwrap_err();
    assert!(inside.to_string().contains("inside an obstacle"), "{inside}");
    let outside = Cable::new(Point::new(60.0, 0.0), &WALL, &[]).unwrap_err();
    assert!(outside.to_string().contains("outside the wall"), "{outside}");
    assert!(Cable::new(Point::new(f64::NAN, 0.0), &Boundary::Circle { radius_m: 1.0 }, &[]).is_err());
    // Touching is allowed.
    assert!(Cable::new(Point::new(2.5, 0.0), &WALL, &[disc(2.0, 0.0, 0.5)]).is_ok());
}

#[test]
fn a_move_through_a_column_passes_it_on_the_side_of_its_centre() {
    for y in [0.1, -0.1] {
        let mut cable = cable(Point::new(-3.0, y), &[disc(0.0, 0.0, 0.5)]);
        cable.drag_to(Point::new(3.0, y));
        assert!(cable.length_m() > 6.0 && cable.contacts()[0].wrap_rad * y < 0.0);
    }
}

#[test]
fn a_tip_on_the_last_contact_goes_back_the_way_it_came() {
    // Tests every bearing, because the last digit of the tangent decides in which direction half a turn seems to go.
    for shape in [disc(2.0, 0.0, 0.3), square(2.0, 0.0, 0.3)] {
        for k in 0..720 {
            let out = |bearing_rad: f64, far_m: f64| {
                Point::new(2.0 + far_m * bearing_rad.cos(), far_m * bearing_rad.sin())
            };
            let around_rad = PI * (1.0 - f64::from(k) / 720.0);
            let anchor = out(around_rad + PI / 2.0, 3.0);
            let mut cable = cable(anchor, std::slice::from_ref(&shape));
            cable.drag_along(&[out(around_rad, 3.0), out(around_rad - PI / 2.0, 3.0)]);
            let home: Vec<Point> = cable.taut_line().into_iter().rev().collect();
            assert!(cable.wrap_total_rad() > 0.1, "{k}: the cable must bend");
            cable.drag_along(&home);
            assert!(cable.length_m() < 1e-9, "{k}: {:?}", cable.contacts());
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn random_walks_among_boxes_agree_with_the_funnel(at in places(8), goals in places(40), half in 0.1..1.0_f64) {
        let anchor = Point::new(0.05, -0.03);
        let shapes = apart(at.iter().map(|(x, y)| square(*x, *y, half)).collect(), anchor, 0.2);
        let rings: Vec<_> = shapes.iter().map(|s| ring_of(s, 0)).collect();
        let (mut cable, mut funnel) = (cable(anchor, &shapes), Funnel::new(anchor, &rings));
        for point in walk(anchor, &goals, &shapes, 0.01) {
            cable.drag_to(point);
            funnel.drag_to(point);
            prop_assert!((cable.length_m() - funnel.length_m()).abs() < 1e-6, "{} {}", cable.length_m(), funnel.length_m());
        }
    }

    #[test]
    fn walks_on_a_lattice_agree_with_the_funnel(
        at in prop::collection::vec((-5..5_i32, -5..5_i32), 1..12),
        goals in prop::collection::vec((-6..6_i32, -6..6_i32), 1..60),
    ) {
        // Every other move ends or turns exactly on a tangent of some box. The triangulation cannot handle places on
        // its edges, so it is asked about slightly shifted places.
        let aside = Vector::new(1.3e-7, 0.7e-7);
        let anchor = Point::origin();
        let shapes: Vec<Shape> =
            at.iter().map(|(x, y)| square(f64::from(*x) + 0.5, f64::from(*y) + 0.5, 0.25)).collect();
        let shapes = apart(shapes, anchor, 0.1);
        let goals: Vec<(f64, f64)> = goals.iter().map(|(x, y)| (f64::from(*x) * 0.5, f64::from(*y) * 0.5)).collect();
        let rings: Vec<_> = shapes.iter().map(|s| ring_of(s, 0)).collect();
        let (mut cable, mut funnel) = (cable(anchor, &shapes), Funnel::new(anchor + aside, &rings));
        for point in walk(anchor, &goals, &shapes, 0.01) {
            cable.drag_to(point);
            funnel.drag_to(point + aside);
            prop_assert!((cable.length_m() - funnel.length_m()).abs() < 1e-6, "{} {}", cable.length_m(), funnel.length_m());
        }
    }

    #[test]
    fn a_robot_that_drives_home_along_its_own_cable_reels_it_all_in(
        at in prop::collection::vec((-5..5_i32, -5..5_i32, any::<bool>()), 1..12),
        goals in prop::collection::vec((-6..6_i32, -6..6_i32), 1..40),
    ) {
        let anchor = Point::origin();
        let shape = |(x, y, is_box): (i32, i32, bool)| {
            let (x, y) = (f64::from(x) + 0.5, f64::from(y) + 0.5);
            if is_box { square(x, y, 0.25) } else { disc(x, y, 0.25) }
        };
        let shapes = apart(at.into_iter().map(shape).collect(), anchor, 0.1);
        let goals: Vec<(f64, f64)> = goals.iter().map(|(x, y)| (f64::from(*x) * 0.5, f64::from(*y) * 0.5)).collect();
        let mut cable = cable(anchor, &shapes);
        cable.drag_along(&walk(anchor, &goals, &shapes, 0.01));
        let home: Vec<Point> = cable.taut_line().into_iter().rev().collect();
        for point in home {
            let before_m = cable.length_m();
            cable.drag_to(point);
            prop_assert!(cable.length_m() < before_m + 1e-6, "{} {before_m}", cable.length_m());
        }
        prop_assert!(cable.length_m() < 1e-6 && cable.signature().crossings().is_empty(), "{:?}", cable.contacts());
    }

    #[test]
    fn random_walks_among_columns_agree_with_the_funnel(at in places(10), goals in places(40), radius in 0.05..0.8_f64) {
        let anchor = Point::new(0.05, -0.03);
        let shapes = apart(at.iter().map(|(x, y)| disc(*x, *y, radius)).collect(), anchor, 0.1);
        let rings: Vec<_> = shapes.iter().map(|s| ring_of(s, 96)).collect();
        let (mut cable, mut funnel) = (cable(anchor, &shapes), Funnel::new(anchor, &rings));
        for point in walk(anchor, &goals, &shapes, 0.01) {
            cable.drag_to(point);
            funnel.drag_to(point);
        }
        // A polygon of n corners in a circle is too short by (pi/n)^2/6 of the arc, and by a little at each tangent.
        let sum: f64 = cable.wrap_total_rad() + cable.contacts().len() as f64;
        prop_assert!((cable.length_m() - funnel.length_m()).abs() < 1e-6 + 2e-3 * radius * sum,
            "{} {}", cable.length_m(), funnel.length_m());
    }

    #[test]
    fn a_way_back_along_the_way_out_leaves_nothing(at in places(10), goals in places(40), radius in 0.0..0.8_f64) {
        let anchor = Point::new(0.05, -0.03);
        let shapes = apart(at.iter().map(|(x, y)| disc(*x, *y, radius)).collect(), anchor, 0.05);
        let mut way = walk(anchor, &goals, &shapes, 1e-3);
        let mut cable = cable(anchor, &shapes);
        cable.drag_along(&way);
        prop_assert!(cable.length_m() >= (cable.tip() - anchor).norm() - 1e-9);
        prop_assert!(cable.wrap_total_rad() >= cable.wrap_max_rad() - 1e-9);
        way.reverse();
        cable.drag_along(&way);
        prop_assert!(cable.length_m() < 1e-7 && cable.is_straight() && cable.signature().is_empty());
    }

    #[test]
    fn at_the_anchor_the_signature_is_empty_exactly_if_the_cable_is_in(at in places(10), goals in places(30), radius in 0.1..0.8_f64) {
        let anchor = Point::new(0.05, -0.03);
        let shapes = apart(at.iter().map(|(x, y)| disc(*x, *y, radius)).collect(), anchor, 0.05);
        let mut cable = cable(anchor, &shapes);
        cable.drag_along(&walk(anchor, &goals, &shapes, 0.0));
        cable.drag_to(anchor);
        prop_assert_eq!(cable.signature().is_empty(), cable.length_m() < 1e-6);
    }

    #[test]
    fn the_cable_enters_no_column_and_is_taut(at in places(10), goals in places(30), radius in 0.1..0.8_f64) {
        let anchor = Point::new(0.05, -0.03);
        let shapes = apart(at.iter().map(|(x, y)| disc(*x, *y, radius)).collect(), anchor, 0.05);
        let mut cable = cable(anchor, &shapes);
        for point in walk(anchor, &goals, &shapes, 0.0) {
            cable.drag_to(point);
            let line = cable.taut_line();
            prop_assert!((geometry::polyline::length_m(&line) - cable.length_m()).abs() < 1e-3 * cable.length_m().max(1.0));
            for pair in line.windows(2) {
                let middle = pair[0] + (pair[1] - pair[0]) * 0.5;
                prop_assert!(shapes.iter().all(|s| s.distance_m(middle) > -2e-3));
            }
        }
    }

    #[test]
    fn overlapping_obstacles_and_moves_through_them_break_nothing(
        at in prop::collection::vec((-3.0..3.0_f64, -3.0..3.0_f64, 0.0..1.5_f64, any::<bool>()), 1..12),
        goals in prop::collection::vec((-5.0..5.0_f64, -5.0..5.0_f64), 1..25),
    ) {
        let anchor = Point::new(-6.0, 0.0);
        let shapes: Vec<Shape> =
            at.iter().map(|(x, y, r, round)| if *round { disc(*x, *y, *r) } else { square(*x, *y, r + 0.01) }).collect();
        let mut cable = cable(anchor, &shapes);
        for (x, y) in &goals {
            cable.drag_to(Point::new(*x, *y));
            let length_m = cable.length_m();
            prop_assert!(length_m.is_finite() && length_m + 1e-6 >= (cable.tip() - anchor).norm());
            prop_assert!(cable.contacts().iter().all(|c| c.wrap_rad.is_finite()));
        }
    }

    #[test]
    fn an_estimate_that_strays_less_than_hull_and_column_winds_nothing(
        at in places(8),
        goals in places(30),
        radius in 0.1..0.5_f64,
        noise in prop::collection::vec((0.0..1.0_f64, 0.0..TAU), 400),
    ) {
        let (anchor, hull_m) = (Point::new(0.05, -0.03), 0.25);
        let shapes = apart(at.iter().map(|(x, y)| disc(*x, *y, radius)).collect(), anchor, 2.0 * hull_m);
        let way = geometry::polyline::resampled(&walk(anchor, &goals, &shapes, hull_m), 0.3);
        let (mut truth, mut guess) = (cable(anchor, &shapes), cable(anchor, &shapes));
        for (k, point) in way.iter().enumerate() {
            let (share, bearing) = noise[k % noise.len()];
            truth.drag_to(*point);
            // The points of the segment between two estimates are estimates, too: they must not stray further than the
            // two do.
            let far = share * (radius + hull_m - 0.16).max(0.0);
            guess.drag_to(point + Vector::new(bearing.cos(), bearing.sin()) * far);
        }
        truth.drag_to(anchor);
        guess.drag_to(*way.last().unwrap());
        guess.drag_to(anchor);
        prop_assert_eq!(truth.signature(), guess.signature());
        prop_assert!((truth.length_m() - guess.length_m()).abs() < 1e-6);
    }

    #[test]
    fn no_cable_is_shorter_than_the_shortest_way(at in places(10), goals in places(30), radius in 0.1..0.8_f64) {
        let anchor = Point::new(0.05, -0.03);
        let shapes = apart(at.iter().map(|(x, y)| disc(*x, *y, radius)).collect(), anchor, 0.05);
        let mut cable = cable(anchor, &shapes);
        let shortest = Geodesic::new(anchor, std::sync::Arc::clone(cable.obstacles()));
        let mut lengths = Vec::new();
        for point in walk(anchor, &goals, &shapes, 0.0) {
            cable.drag_to(point);
            let least_m = shortest.distance_m(point);
            prop_assert!(least_m >= (point - anchor).norm() - 1e-9 && least_m <= cable.length_m() + 1e-6,
                "{least_m} {}", cable.length_m());
            // If the cable is straight and its signature is empty, its length is the shortest distance.
            if cable.signature().is_empty() && cable.is_straight() {
                prop_assert!((least_m - cable.length_m()).abs() < 1e-6);
            }
            lengths.push((point, cable.length_m()));
        }
        // The search that goes no further than necessary finds the same distance.
        let farthest_m = lengths.iter().map(|(point, _)| shortest.distance_m(*point)).fold(0.0, f64::max);
        let found_m = Geodesic::farthest_m(anchor, std::sync::Arc::clone(cable.obstacles()), &lengths);
        prop_assert!((found_m - farthest_m).abs() <= 1e-6, "{found_m} {farthest_m}");
    }
}
