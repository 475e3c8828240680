mod hostile;

use super::*;
use crate::{
    tank::{Obstacle, ObstacleId},
    tether::{Cable, CableObstacles, Limits},
};
use geometry::{Boundary, Point, Shape};
use proptest::prelude::*;
use std::f64::consts::TAU;

const WALL: Boundary = Boundary::Circle { radius_m: 10.0 };

fn column(index: u32, x: f64, y: f64) -> Obstacle {
    let shape = Shape::Disc { center: Point::new(x, y), radius_m: 0.3 };
    Obstacle { id: ObstacleId(index), name: format!("C{index}"), shape, known: true }
}

fn points(of: &[(f64, f64)]) -> Vec<Point> {
    of.iter().map(|(x, y)| Point::new(*x, *y)).collect()
}

fn case<'a>(path: &'a [Point], obstacles: &'a [Obstacle], cuts: &'a [Vec<Point>]) -> Case<'a> {
    Case {
        path,
        anchor: Point::origin(),
        cable: None,
        boundary: &WALL,
        obstacles,
        room_m: 0.3,
        limits: Limits { reel_length_m: 12.0, wrap_max_rad: 2.0, wrap_total_max_rad: 3.0 },
        pull: None,
        returns: true,
        cuts,
    }
}

#[test]
fn a_path_out_and_back_on_one_side_of_a_column_is_certified() {
    let columns = [column(0, 4.0, 0.0)];
    let cuts = [points(&[(4.0, 0.0), (10.0, 0.0)])];
    let path = points(&[(0., 0.), (4., 3.), (8., 2.), (8., 0.5), (4., 3.), (0., 0.)]);
    let certificate = certify(&case(&path, &columns, &cuts)).unwrap();
    assert!(certificate.certified, "{:?}", certificate.reasons);
    assert_eq!(
        (certificate.end_length_m, certificate.cut_crossings, certificate.collisions),
        (Some(0.0), 0, 0)
    );
    assert!((certificate.eccentricity_m - 68.0_f64.sqrt()).abs() < 1e-2, "{}", certificate.eccentricity_m);
}

#[test]
fn a_path_round_a_column_is_refused_with_its_name() {
    let columns = [column(0, 4.0, 0.0)];
    let path = points(&[(0., 0.), (4., 3.), (8., 0.), (4., -3.), (0., 0.)]);
    let cuts = [points(&[(4.0, 0.0), (10.0, 0.0)])];
    let certificate = certify(&case(&path, &columns, &cuts)).unwrap();
    assert!(!certificate.certified && certificate.cut_crossings == 1 && certificate.crossings_left == 1);
    assert!(certificate.end_length_m.is_some_and(|left_m| left_m > 7.9));
    let words = certificate.reasons.join("; ");
    assert!(
        words.contains("still out on return, hooked around C0") && words.contains("crosses a cut"),
        "{words}"
    );
    // A mission that need not return may end anywhere.
    let certificate = certify(&Case { returns: false, cuts: &[], ..case(&path, &columns, &[]) }).unwrap();
    assert_eq!((certificate.end_length_m, certificate.cut_crossings), (None, 0));
}

#[test]
fn limits_and_collisions_are_reported_with_place_and_figure() {
    let columns = [column(0, 4.0, 0.0), column(1, -4.0, 0.0)];
    let path = points(&[(0., 0.), (4., 0.5), (9.0, 0.0), (-9.5, 3.0), (-4.0, -0.8), (0.0, 0.0)]);
    let limits = Limits { reel_length_m: 9.0, wrap_max_rad: 0.1, wrap_total_max_rad: 0.2 };
    let certificate = certify(&Case { limits, ..case(&path, &columns, &[]) }).unwrap();
    let words = certificate.reasons.join("; ");
    for part in ["near C0", "the reel holds 9.0 m", "around C", "total tether wrap"] {
        assert!(words.contains(part), "{part}: {words}");
    }
}

#[test]
fn a_collision_is_reported_at_the_narrowest_place_with_its_obstacle() {
    let words = |path: &[(f64, f64)], columns: &[Obstacle]| {
        certify(&case(&points(path), columns, &[])).unwrap().reasons.join("; ")
    };
    // The point is far from the beginning of the segment.
    let by_the_wall = words(&[(0., 0.), (9.9, 0.), (0., 0.)], &[]);
    assert!(
        by_the_wall
            .contains("2 segments of the path lack clearance, the first at 9.90, 0.00 m near the wall"),
        "{by_the_wall}"
    );
    let past = words(&[(0., 0.), (0., 0.5), (8., 0.5), (9., 2.), (0., 2.), (0., 0.)], &[column(0, 4.0, 0.0)]);
    assert!(past.contains("1 segment of the path lacks clearance, at 4.00, 0.50 m near C0"), "{past}");
}

#[test]
fn a_path_that_does_not_come_back_or_is_no_path_is_refused() {
    let away = certify(&case(&points(&[(0., 0.), (5., 0.)]), &[], &[])).unwrap();
    assert!(away.reasons[0].contains("ends 5.00 m away from the anchor"), "{:?}", away.reasons);
    assert!(!certify(&case(&[], &[], &[])).unwrap().certified);
    let broken = certify(&case(&points(&[(0., 0.), (f64::NAN, 0.)]), &[], &[])).unwrap();
    assert!(broken.reasons.iter().any(|r| r.contains("not a finite number")), "{:?}", broken.reasons);
}

#[test]
fn cuts_that_seal_a_region_are_found_unless_the_path_has_been_inside() {
    let ring: Vec<Point> =
        (0..=8).map(|k| TAU * f64::from(k) / 8.0).map(|a| Point::new(5.0 + a.cos(), a.sin())).collect();
    let path = points(&[(0., 0.), (0., 5.), (0., 0.)]);
    let cuts = [ring];
    let certificate = certify(&case(&path, &[], &cuts)).unwrap();
    assert!((certificate.sealed_m2 - 2.83).abs() < 0.1, "{}", certificate.sealed_m2);
    assert!(certificate.reasons[0].contains("seal off"), "{:?}", certificate.reasons);
    let open = [cuts[0][1..].to_vec()];
    assert!(certify(&case(&path, &[], &open)).unwrap().sealed_m2.abs() < 1e-9);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn a_path_that_crosses_no_radial_cut_comes_back_with_an_empty_cable(
        bearings in prop::collection::vec(0.0..TAU, 1..10),
        goals in prop::collection::vec((-9.5..9.5_f64, -9.5..9.5_f64), 1..60),
    ) {
        let columns: Vec<Obstacle> = bearings
            .iter()
            .enumerate()
            .map(|(k, b)| column(k as u32, (2.0 + 0.7 * k as f64) * b.cos(), (2.0 + 0.7 * k as f64) * b.sin()))
            .collect();
        let cuts: Vec<Vec<Point>> = columns
            .iter()
            .map(|c| vec![c.shape.center(), Point::from(c.shape.center().coords.normalize() * 10.0)])
            .collect();
        let shapes: Vec<Shape> = columns.iter().map(|c| c.shape.clone()).collect();
        let grown = CableObstacles::grown(&WALL, &shapes, 0.3);
        let mut path = vec![Point::origin()];
        for (x, y) in goals.into_iter().chain([(0.0, 0.0)]) {
            let next = Point::new(x, y);
            let last = path[path.len() - 1];
            if next.coords.norm() < 9.7 && grown.is_open(last, next) && cuts::crossings(&[last, next], &cuts) == 0 {
                path.push(next);
            }
        }
        // The way home along the cable never crosses a cut either.
        let mut cable = Cable::new(Point::origin(), &WALL, &shapes).unwrap();
        cable.drag_along(&path);
        let home: Vec<Point> = cable.taut_line().into_iter().rev().collect();
        prop_assert_eq!(cuts::crossings(&home, &cuts), 0);
        path.extend(home);
        let certificate = certify(&Case { room_m: 0.0, ..case(&path, &columns, &cuts) }).unwrap();
        // A cut may pass another column too closely for the hull; nothing else can be wrong.
        prop_assert!(certificate.reasons.iter().all(|r| r.contains("seal off")), "{:?}", certificate.reasons);
        prop_assert_eq!((certificate.end_length_m, certificate.crossings_left), (Some(0.0), 0));
        prop_assert!(certificate.tether_length_max_m >= certificate.eccentricity_m - 1e-6);
    }
}
