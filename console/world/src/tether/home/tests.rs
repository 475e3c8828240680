use super::*;
use crate::tank::{Obstacle, ObstacleId};
use geometry::{Boundary, Shape, Vector};
use proptest::prelude::*;

const WALL: Boundary = Boundary::Circle { radius_m: 6.0 };
const HULL_M: f64 = 0.25;

/// A floor with columns, a cable on it, and the same floor as a hull meets it.
struct Floor {
    cable: Cable,
    grown: Arc<CableObstacles>,
    map: ObstacleMap,
}

impl Floor {
    fn new(boundary: &Boundary, anchor: Point, columns: &[(f64, f64, f64)], room_m: f64) -> Self {
        let shapes: Vec<Shape> = columns.iter().map(|(x, y, r)| disc(*x, *y, *r)).collect();
        let obstacle = |shape: &Shape| Obstacle {
            id: ObstacleId(0),
            name: String::new(),
            shape: shape.clone(),
            known: true,
        };
        let obstacles: Vec<Obstacle> = shapes.iter().map(obstacle).collect();
        Self {
            cable: Cable::new(anchor, boundary, &shapes).unwrap(),
            grown: Arc::new(CableObstacles::grown(boundary, &shapes, room_m)),
            map: ObstacleMap::new(boundary, &obstacles),
        }
    }

    fn drag(mut self, way: &[(f64, f64)]) -> Self {
        for (x, y) in way {
            self.cable.drag_to(Point::new(*x, *y));
        }
        self
    }

    fn home(&self, room_m: f64) -> Option<Vec<Point>> {
        self.cable.return_path(&self.grown, &self.map, room_m)
    }
}

fn disc(x: f64, y: f64, radius_m: f64) -> Shape {
    Shape::Disc { center: Point::new(x, y), radius_m }
}

#[test]
fn the_way_home_keeps_the_hull_off_the_column_and_is_none_where_the_hull_does_not_fit() {
    let home = |columns: &[(f64, f64, f64)]| {
        let floor = Floor::new(&WALL, Point::new(-3.0, 0.0), columns, 0.4);
        floor.drag(&[(0.0, 0.5), (3.0, -1.0)]).home(0.4)
    };
    let way = home(&[(0.0, 0.0, 0.3)]).unwrap();
    assert!((way[0] - Point::new(3.0, -1.0)).norm() < 1e-9);
    assert!((way.last().unwrap() - Point::new(-3.0, 0.0)).norm() < 1e-9);
    assert!(polyline::distance_m(&way, Point::origin()) > 0.69);
    assert_eq!(home(&[(0.0, 0.0, 0.3), (0.0, 1.2, 0.3)]), None);
}

#[test]
fn a_cable_that_only_just_bears_on_a_column_leaves_the_hull_a_way_home() {
    let columns = [(0.3, 3.1, 0.2), (3.0, 0.8, 0.2), (1.2, -3.0, 0.2), (-3.2, -0.6, 0.2), (-0.4, 0.5, 0.25)];
    let floor = Floor::new(&WALL, Point::new(0.0, -5.4), &columns, 0.2);
    let way =
        [(-3.272_348_201_103_527, -0.056_393_239_078_822), (-3.301_148_122_138_845, -0.063_203_685_744_23)];
    assert!(floor.drag(&way).home(0.2).is_some());
}

#[test]
fn a_robot_beside_a_column_or_at_a_manhole_in_the_shell_steps_away_first() {
    let floor = Floor::new(&WALL, Point::new(-5.95, 0.0), &[(0.0, 0.0, 0.3)], HULL_M).drag(&[(0.0, 0.4)]);
    let way = floor.home(HULL_M).unwrap();
    assert!((way[0] - Point::new(0.0, 0.4)).norm() < 1e-9 && (way[1] - Point::new(0.0, 0.55)).norm() < 1e-3);
}

#[test]
fn a_way_home_round_an_inward_corner_of_the_wall_keeps_the_hull_off_it() {
    let corners = [(-4.0, -4.0), (4.0, -4.0), (4.0, 4.0), (0.0, 4.0), (0.0, 0.0), (-4.0, 0.0)];
    let wall = Boundary::Polygon { vertices: corners.map(|(x, y)| Point::new(x, y)).to_vec() };
    let floor = Floor::new(&wall, Point::new(-3.0, -0.5), &[], HULL_M).drag(&[(0.5, -0.5), (0.5, 3.0)]);
    let way = floor.home(HULL_M).unwrap();
    assert!((polyline::distance_m(&way, Point::origin()) - HULL_M).abs() < 0.01, "{way:?}");
}

/// A U-shaped floor, whose two arms are joined below a wall that ends in two inward corners.
fn u_shape(wide_m: f64) -> Vec<Point> {
    let corners = [
        (-6.0, -5.0),
        (6.0, -5.0),
        (6.0, 5.0),
        (wide_m, 5.0),
        (wide_m, -1.0),
        (-wide_m, -1.0),
        (-wide_m, 5.0),
        (-6.0, 5.0),
    ];
    corners.map(|(x, y)| Point::new(x, y)).to_vec()
}

#[test]
fn a_way_home_round_a_wall_between_two_arms_of_a_floor_never_leads_through_it() {
    for (wide_m, mirrored, turned_deg) in
        [(2.0, false, 0.0), (2.0, true, 0.0), (2.0, false, 90.0), (0.05, false, 200.0), (0.05, true, 30.0)]
    {
        let turn = nalgebra::Rotation2::new(f64::to_radians(turned_deg));
        let placed = |p: &Point| turn * Point::new(if mirrored { -p.x } else { p.x }, p.y);
        let wall = Boundary::Polygon { vertices: u_shape(wide_m).iter().map(placed).collect() };
        let mut floor = Floor::new(&wall, placed(&Point::new(-5.0, 4.0)), &[], 0.15);
        let way =
            [(-5.0, 4.0), (-5.0, -4.0), (5.76, -4.75), (5.76, 4.75), (2.26, 4.75), (2.26, -1.2), (0.0, -1.3)];
        for at in polyline::resampled(&way.map(|(x, y)| placed(&Point::new(x, y))), 0.05) {
            floor.cable.drag_to(at);
            let home =
                floor.home(0.15).unwrap_or_else(|| panic!("none from {at}, {wide_m} m, {turned_deg} deg"));
            let (home_m, cable_m) = (polyline::length_m(&home), floor.cable.length_m());
            assert!(home_m > cable_m - 0.02, "{home_m} m of {cable_m} m at {at}");
            let is_on_floor = |p: &Point| wall.wall_distance_m(*p) > 0.1;
            assert!(polyline::resampled(&home, 0.05).iter().all(is_on_floor), "{home:?}");
        }
    }
}

#[test]
fn a_cable_in_a_closed_gap_has_no_way_home_on_the_other_side_of_it() {
    // The gap is 0.4 m wide; there is enough room beyond either column.
    let columns = [(0.0, 0.5, 0.3), (0.0, -0.5, 0.3)];
    let floor = Floor::new(&WALL, Point::new(-3.0, 0.0), &columns, HULL_M).drag(&[(3.0, 0.0)]);
    assert_eq!(floor.home(HULL_M), None);
    let narrow = Floor::new(&WALL, Point::new(-3.0, 0.0), &columns, 0.19).drag(&[(3.0, 0.0)]);
    assert!(narrow.home(0.19).is_some());
}

#[test]
fn a_cable_that_passes_close_by_a_column_after_another_keeps_its_side_of_both() {
    let columns = [(-1.0765, 1.1354, 0.1), (-1.8657, 0.0, 0.1)];
    let floor = Floor::new(&WALL, Point::new(0.0, -5.4), &columns, HULL_M);
    let floor = floor.drag(&[(-3.3, 0.0), (-1.4, 0.6), (-0.5, 0.9), (0.0, 2.08)]);
    let way = floor.home(HULL_M).unwrap();
    assert!(way.iter().all(|p| p.x < -1.5 || p.y < 1.2 || p.x > -1e-9), "{way:?}");
}

/// The path of a hull among columns, as reported with some noise: the hull fits at every true position, but not at
/// every reported position.
fn driven(floor: &Floor, goals: &[(f64, f64)], noise: &[(f64, f64)]) -> Vec<Point> {
    let mut at = floor.grown.outside(floor.cable.anchor());
    let mut way = vec![at];
    for (x, y) in goals {
        let mut pieces = vec![at];
        floor.grown.go_round(at, Point::new(*x, *y), &mut pieces);
        let is_free = pieces.windows(2).all(|w| floor.map.obstacle_clearance_m(w[0], w[1]) > HULL_M - 1e-6);
        if is_free {
            at = pieces[pieces.len() - 1];
            way.extend(polyline::resampled(&pieces, 0.08));
        }
    }
    let off = noise.iter().cycle().map(|(x, y)| Vector::new(*x, *y));
    way.iter().zip(off).map(|(p, off)| p + off).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn wherever_a_hull_has_driven_there_is_a_way_home_however_its_position_is_off(
        columns in proptest::collection::vec((-4.5..4.5_f64, -4.5..4.5_f64, 0.1..0.4_f64), 1..14),
        goals in proptest::collection::vec((-3.8..3.8_f64, -3.8..3.8_f64), 1..16),
        noise in proptest::collection::vec((-0.08..0.08_f64, -0.08..0.08_f64), 40..60),
    ) {
        let anchor = Point::new(0.0, -5.4);
        let free: Vec<_> =
            columns.into_iter().filter(|(x, y, r)| x.hypot(*y) < 4.8 && (Point::new(*x, *y) - anchor).norm() > r + HULL_M).collect();
        let mut floor = Floor::new(&WALL, anchor, &free, HULL_M);
        for at in driven(&floor, &goals, &noise) {
            floor.cable.drag_to(at);
            let way = floor.home(HULL_M);
            prop_assert!(way.is_some(), "at {at}: {:?}", floor.cable.taut_line());
            let (way_m, cable_m) = (polyline::length_m(&way.unwrap()), floor.cable.length_m());
            prop_assert!(way_m > cable_m - 0.02, "{way_m} of {cable_m}");
        }
    }
}

#[test]
fn a_cable_that_lies_flat_along_a_box_has_a_way_home() {
    let (boundary, middle) = (Boundary::Circle { radius_m: 8.0 }, Point::new(0.96, -5.3));
    for heading_deg in [0.0, 20.0, 44.0, 45.0, 46.0, 50.0, 90.0] {
        let heading = nalgebra::Rotation2::new(f64::to_radians(heading_deg));
        let corner = |(x, y)| middle + heading * Vector::new(x, y);
        let corners = [(-0.31, -0.075), (0.31, -0.075), (0.31, 0.075), (-0.31, 0.075)];
        let shape = Shape::Polygon { vertices: corners.map(corner).to_vec() };
        let mut cable = Cable::new(Point::new(0.0, -6.9), &boundary, std::slice::from_ref(&shape)).unwrap();
        let grown = Arc::new(CableObstacles::grown(&boundary, std::slice::from_ref(&shape), 0.15));
        let obstacle = Obstacle { id: ObstacleId(0), name: String::new(), shape, known: true };
        let map = ObstacleMap::new(&boundary, &[obstacle]);
        let way = [(0.0, -6.9), (0.0, -5.5), (0.5, -4.5), (4.0, 3.0), (5.7, -0.3), (5.6, -1.0), (5.0, -2.0)];
        for at in polyline::resampled(&way.map(|(x, y)| Point::new(x, y)), 0.02) {
            cable.drag_to(at);
            let home = cable.return_path(&grown, &map, 0.15);
            assert!(home.is_some(), "{heading_deg} deg at {at}: {:?}", cable.taut_line());
        }
    }
}

#[test]
fn a_cable_along_a_wall_of_many_pieces_has_a_way_home() {
    // A wall of a public map (ipa-apartment), in the convex pieces into which the map reader divides it.
    let pieces: [&[(f64, f64)]; 9] = [
        &[(-2.3, -4.3), (-2.35, -4.25), (-2.4, -4.25), (-2.4, -4.6), (-2.3, -4.75)],
        &[(-2.4, -4.6), (-2.45, -4.6), (-2.35, -4.75), (-2.3, -4.75)],
        &[(-2.5, -6.8), (-2.45, -6.8), (-2.45, -6.05), (-3.05, -5.35), (-3.6, -5.3), (-4.25, -5.25)],
        &[(-2.45, -4.9), (-2.35, -5.0), (-2.35, -4.75), (-2.45, -4.6)],
        &[(-2.3, -5.0), (-2.35, -5.0), (-2.35, -5.1), (-2.3, -5.1)],
        &[(-2.5, -5.35), (-2.35, -5.35), (-2.35, -5.0), (-2.45, -4.9), (-2.5, -4.9)],
        &[(-2.45, -6.05), (-2.4, -6.05), (-2.4, -5.35), (-3.05, -5.35)],
        &[(-2.55, -7.6), (-2.5, -7.6), (-2.5, -6.8), (-4.25, -5.25), (-6.55, -7.35)],
        &[(-2.6, -8.4), (-2.55, -8.4), (-2.55, -7.6), (-6.55, -7.35)],
    ];
    let shapes = pieces.map(|corners| Shape::Polygon {
        vertices: corners.iter().map(|(x, y)| Point::new(*x, *y)).collect(),
    });
    let (boundary, room_m) = (Boundary::Circle { radius_m: 20.0 }, 0.15);
    let obstacles =
        shapes.clone().map(|shape| Obstacle { id: ObstacleId(0), name: String::new(), shape, known: true });
    let map = ObstacleMap::new(&boundary, &obstacles);
    let grown = Arc::new(CableObstacles::grown(&boundary, &shapes, room_m));
    let anchor = Point::new(-12.025, -3.075);
    let mut cable = Cable::new(anchor, &boundary, &shapes).unwrap();
    let mut dragged = Cable::hull_at(anchor, &grown).unwrap();
    let way = [(-12.025, -3.075), (-2.05, -4.0), (-2.05, -5.0), (-2.300_225, -8.330_446)];
    for at in polyline::resampled(&way.map(|(x, y)| Point::new(x, y)), 0.05) {
        cable.drag_to(at);
        let home = cable.return_path(&grown, &map, room_m);
        let home = home.unwrap_or_else(|| panic!("none from {at}: {:?}", cable.taut_line()));
        dragged.drag_to(at);
        let same = cable.return_path_of(&dragged, &map, room_m);
        assert!(
            same.is_some_and(|same| (polyline::length_m(&same) - polyline::length_m(&home)).abs() < 1e-6)
        );
        let (home_m, cable_m) = (polyline::length_m(&home), cable.length_m());
        assert!(home_m > cable_m - 0.02 && home_m < cable_m + 1.0, "{home_m} m of {cable_m} m at {at}");
    }
}
