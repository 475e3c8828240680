//! Paths that must not get a certificate although they look harmless, and harmless paths that look odd.

use super::*;
use geometry::Vector;
use std::f64::consts::PI;

/// A second opinion: the homotopy signature from rays with a different bearing, without any code of the certificate.
fn crossings_left(path: &[Point], columns: &[Obstacle]) -> Vec<(u32, bool)> {
    let ray = Vector::new(2.2_f64.cos(), 2.2_f64.sin());
    let mut signature: Vec<(u32, bool)> = Vec::new();
    for pair in path.windows(2) {
        let mut met: Vec<(f64, u32, bool)> = Vec::new();
        for column in columns {
            let center = column.shape.center();
            let (from, to) = (ray.perp(&(pair[0] - center)), ray.perp(&(pair[1] - center)));
            let share = from / (from - to);
            let ahead = ray.dot(&(pair[0] + (pair[1] - pair[0]) * share - center));
            if (from < 0.0) != (to < 0.0) && ahead > 0.0 {
                met.push((share, column.id.0, from < 0.0));
            }
        }
        met.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (_, id, ccw) in met {
            if signature.last() == Some(&(id, !ccw)) {
                signature.pop();
            } else {
                signature.push((id, ccw));
            }
        }
    }
    signature
}

fn lenient<'a>(path: &'a [Point], obstacles: &'a [Obstacle]) -> Case<'a> {
    let limits = Limits {
        reel_length_m: f64::INFINITY,
        wrap_max_rad: f64::INFINITY,
        wrap_total_max_rad: f64::INFINITY,
    };
    Case { limits, ..case(path, obstacles, &[]) }
}

/// A ring round a column, from its southern point and back to it; clockwise for negative turns.
fn ring(x: f64, y: f64, turns: f64) -> Vec<Point> {
    let steps = (turns.abs() * 24.0).round() as u32;
    let at = |k: u32| -PI / 2.0 + TAU * turns * f64::from(k) / f64::from(steps);
    (0..=steps).map(|k| Point::new(x + 1.5 * at(k).cos(), y + 1.5 * at(k).sin())).collect()
}

fn home_and_out(rings: &[Vec<Point>]) -> Vec<Point> {
    let mut path = vec![Point::origin()];
    for ring in rings {
        path.extend(ring);
        path.push(Point::origin());
    }
    path
}

fn columns_at(at: &[(f64, f64)]) -> Vec<Obstacle> {
    let mut columns: Vec<Obstacle> = Vec::new();
    for (x, y) in at {
        let here = Point::new(*x, *y);
        let is_clear = columns.iter().all(|c| (c.shape.center() - here).norm() > 1.4);
        if is_clear && here.coords.norm() > 1.2 {
            columns.push(column(columns.len() as u32, *x, *y));
        }
    }
    columns
}

/// A walk with room for the hull. After enough goals, it ends at the anchor as soon as the way to the anchor is free.
fn closed_walk(goals: &[(f64, f64)], columns: &[Obstacle]) -> Option<Vec<Point>> {
    let shapes: Vec<Shape> = columns.iter().map(|c| c.shape.clone()).collect();
    let grown = CableObstacles::grown(&WALL, &shapes, 0.3);
    let mut path = vec![Point::origin()];
    for (k, (x, y)) in goals.iter().enumerate() {
        let (last, next) = (path[path.len() - 1], Point::new(*x, *y));
        if next.coords.norm() < 9.6 && grown.is_open(last, next) {
            path.push(next);
            if k > goals.len() / 2 && grown.is_open(next, Point::origin()) {
                path.push(Point::origin());
                return Some(path);
            }
        }
    }
    None
}

#[test]
fn loops_are_refused_until_every_one_is_undone() {
    let columns = [column(0, 0.0, 5.0)];
    for turns in [1.0, 2.0, 5.0, -3.0] {
        let path = home_and_out(&[ring(0.0, 5.0, turns)]);
        let certificate = certify(&lenient(&path, &columns)).unwrap();
        assert!(
            !certificate.certified && certificate.crossings_left == turns.abs() as usize,
            "{turns}: {certificate:?}"
        );
        assert!(certificate.wrap_max_rad > TAU * turns.abs() - PI, "{turns}: {certificate:?}");
        let almost = home_and_out(&[ring(0.0, 5.0, turns), ring(0.0, 5.0, turns.signum() - turns)]);
        let certificate = certify(&lenient(&almost, &columns)).unwrap();
        assert_eq!((certificate.certified, certificate.crossings_left), (false, 1), "{turns}");
        let undone = home_and_out(&[ring(0.0, 5.0, turns), ring(0.0, 5.0, -turns)]);
        let certificate = certify(&lenient(&undone, &columns)).unwrap();
        assert!(
            certificate.certified && certificate.end_length_m.unwrap() < 1e-6,
            "{turns}: {certificate:?}"
        );
    }
}

#[test]
fn a_knot_that_winds_round_no_column_in_sum_is_refused() {
    // Round one column, round the other, back round the first, back round the second: every winding number is 0.
    let columns = [column(0, 0.0, 5.0), column(1, 5.0, 0.0)];
    let rings = [(0.0, 5.0, 1.0), (5.0, 0.0, 1.0), (0.0, 5.0, -1.0), (5.0, 0.0, -1.0)];
    let knot = home_and_out(&rings.map(|(x, y, turns)| ring(x, y, turns)));
    let certificate = certify(&lenient(&knot, &columns)).unwrap();
    assert!(!certificate.certified && certificate.crossings_left == 4, "{certificate:?}");
    assert!(certificate.end_length_m.unwrap() > 10.0);
    let nested = [rings[0], rings[1], (5.0, 0.0, -1.0), (0.0, 5.0, -1.0)];
    let undone = home_and_out(&nested.map(|(x, y, turns)| ring(x, y, turns)));
    assert!(certify(&lenient(&undone, &columns)).unwrap().certified);
}

#[test]
fn a_cut_crossed_and_crossed_back_is_crossed_twice() {
    let columns = [column(0, 4.0, 0.0)];
    let cuts = [points(&[(4.0, 0.0), (10.0, 0.0)])];
    let over = points(&[(0., 0.), (4., 3.), (8., 1.), (8., -1.), (8., 1.), (4., 3.), (0., 0.)]);
    let certificate = certify(&case(&over, &columns, &cuts)).unwrap();
    assert_eq!((certificate.certified, certificate.cut_crossings, certificate.crossings_left), (false, 2, 0));
    // A path that goes up to the cut, but no further, is allowed.
    let along = points(&[(0., 0.), (4., 3.), (8., 0.01), (9., 0.01), (4., 3.), (0., 0.)]);
    assert!(certify(&case(&along, &columns, &cuts)).unwrap().certified);
}

#[test]
fn a_hull_that_grazes_is_distinguished_from_one_that_scrapes() {
    let columns = [column(0, 4.0, 0.0)];
    for (gap_m, is_fine) in [(0.302, true), (0.298, true), (0.29, false), (0.0, false), (-0.3, false)] {
        let aside = 0.3 + gap_m;
        let path = points(&[(0., 0.), (2., aside), (6., aside), (2., aside), (0., 0.)]);
        assert_eq!(certify(&case(&path, &columns, &[])).unwrap().collisions == 0, is_fine, "{gap_m}");
    }
}

#[test]
fn a_path_that_leaves_the_floor_is_refused_even_between_its_points() {
    for path in [points(&[(0., 0.), (12., 0.), (0., 0.)]), points(&[(0., 0.), (9.8, 0.), (0., 0.)])] {
        assert!(certify(&lenient(&path, &[])).unwrap().collisions > 0);
    }
    let corners = [(-5., -5.), (5., -5.), (5., 5.), (1., 5.), (1., 0.5), (-1., 0.5), (-1., 5.), (-5., 5.)];
    let boundary = Boundary::Polygon { vertices: points(&corners) };
    let over = points(&[(0., 0.), (-3., 0.), (-3., 3.), (3., 3.), (3., 0.), (0., 0.)]);
    let certificate = certify(&Case { boundary: &boundary, ..lenient(&over, &[]) }).unwrap();
    assert!(
        certificate.collisions == 1 && certificate.reasons[0].contains("near the wall"),
        "{certificate:?}"
    );
    let round = points(&[(0., 0.), (-3., 0.), (-3., 3.), (-3., 0.), (3., 0.), (3., 3.), (3., 0.), (0., 0.)]);
    let certificate = certify(&Case { boundary: &boundary, room_m: 0.1, ..lenient(&round, &[]) }).unwrap();
    assert!(certificate.certified, "{certificate:?}");
}

#[test]
fn numbers_that_are_none_certify_nothing() {
    let path = points(&[(0., 0.), (3., 0.), (0., 0.)]);
    for bad in [f64::NAN, f64::INFINITY, 1e200, 1e308] {
        for k in 0..3 {
            let mut broken = path.clone();
            broken[k].y = bad;
            let certificate = certify(&lenient(&broken, &[column(0, 0.0, 5.0)])).unwrap();
            assert!(!certificate.certified, "{bad} at {k}");
        }
        let cuts = [vec![Point::new(4.0, bad), Point::new(5.0, 5.0)]];
        let certificate = certify(&Case { cuts: &cuts, ..lenient(&path, &[]) }).unwrap();
        assert!(bad.is_finite() || !certificate.certified, "{bad} in a cut");
    }
    let no_limit = Limits { reel_length_m: f64::NAN, ..lenient(&path, &[]).limits };
    assert!(!certify(&Case { limits: no_limit, ..lenient(&path, &[]) }).unwrap().certified);
    assert!(!certify(&Case { room_m: f64::NAN, ..lenient(&path, &[]) }).unwrap().certified);
}

#[test]
fn a_path_of_one_point_is_fine_at_the_anchor_only() {
    let at = |x: f64| certify(&lenient(&points(&[(x, 0.0)]), &[])).unwrap();
    assert!(at(0.0).certified && at(0.2).certified && !at(0.5).certified && !at(9.9).certified);
}

#[test]
fn a_path_that_ends_beside_the_anchor_is_certified_with_the_cable_reeled_in() {
    // Around the column and back to within 0.2 m of the anchor: the path has returned, but the cable is hooked.
    let columns = [column(0, 0.0, 3.0)];
    let mut path = home_and_out(&[ring(0.0, 3.0, 1.0)]);
    *path.last_mut().unwrap() = Point::new(0.2, 0.0);
    let certificate = certify(&lenient(&path, &columns)).unwrap();
    assert!(!certificate.certified && certificate.crossings_left == 1, "{certificate:?}");
}

#[test]
fn a_gate_narrower_than_a_cell_is_no_seal() {
    let chamber = points(&[(3.0, 3.02), (3.0, 5.0), (5.0, 5.0), (5.0, 3.0), (3.0, 3.0)]);
    let path = points(&[(0., 0.), (0., 5.), (0., 0.)]);
    let certified_with = |cuts: &[Vec<Point>]| certify(&Case { cuts, ..lenient(&path, &[]) }).unwrap();
    let shut = [points(&[(3.0, 3.0), (3.0, 5.0), (5.0, 5.0), (5.0, 3.0), (3.0, 3.0)])];
    assert!((certified_with(&shut).sealed_m2 - 4.0).abs() < 0.2);
    assert!(certified_with(&[chamber]).certified);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn a_walk_is_certified_exactly_if_its_signature_is_empty(
        at in prop::collection::vec((-8.0..8.0_f64, -8.0..8.0_f64), 1..14),
        goals in prop::collection::vec((-9.0..9.0_f64, -9.0..9.0_f64), 20..90),
    ) {
        let columns = columns_at(&at);
        let Some(path) = closed_walk(&goals, &columns) else { return Ok(()) };
        let signature = crossings_left(&path, &columns);
        let certificate = certify(&lenient(&path, &columns)).unwrap();
        prop_assert_eq!(certificate.certified, signature.is_empty(), "{:?} {:?}", signature, certificate.reasons);
        prop_assert_eq!(certificate.end_length_m.unwrap() < 1e-6, signature.is_empty());
        // A path that returns the way it came is always certified.
        let there_and_back: Vec<Point> = path.iter().chain(path.iter().rev()).copied().collect();
        prop_assert!(certify(&lenient(&there_and_back, &columns)).unwrap().certified);
    }

    #[test]
    fn doubled_points_and_split_pieces_change_nothing(
        at in prop::collection::vec((-8.0..8.0_f64, -8.0..8.0_f64), 1..10),
        goals in prop::collection::vec((-9.0..9.0_f64, -9.0..9.0_f64), 20..60),
        shares in prop::collection::vec(0.0..=1.0_f64, 60),
    ) {
        let columns = columns_at(&at);
        let Some(path) = closed_walk(&goals, &columns) else { return Ok(()) };
        let mut split = vec![path[0]; 3];
        for (pair, share) in path.windows(2).zip(shares.iter().cycle()) {
            let middle = pair[0] + (pair[1] - pair[0]) * *share;
            split.extend([middle, middle, pair[1], pair[1]]);
        }
        let (whole, parts) =
            (certify(&lenient(&path, &columns)).unwrap(), certify(&lenient(&split, &columns)).unwrap());
        prop_assert_eq!((whole.certified, whole.crossings_left), (parts.certified, parts.crossings_left));
        prop_assert!((whole.tether_length_max_m - parts.tether_length_max_m).abs() < 1e-6, "{} {}", whole.tether_length_max_m, parts.tether_length_max_m);
        prop_assert!((whole.wrap_max_rad - parts.wrap_max_rad).abs() < 1e-6);
        prop_assert!((whole.wrap_total_max_rad - parts.wrap_total_max_rad).abs() < 1e-6);
        prop_assert!((whole.end_length_m.unwrap() - parts.end_length_m.unwrap()).abs() < 1e-6);
    }

    #[test]
    fn a_way_into_a_ring_of_cuts_crosses_them_an_odd_number_of_times(
        goals in prop::collection::vec((-8..9_i32, -8..9_i32), 1..12),
        inside in (-3..4_i32, -3..4_i32),
    ) {
        // Everything lies on a lattice: the path runs through corners of the ring and along its sides.
        let ring = [points(&[(-4., -4.), (4., -4.), (4., 4.), (0., 4.), (-4., 4.), (-4., -4.)])];
        let mut path = points(&[(-9.0, -9.0)]);
        path.extend(goals.iter().map(|(x, y)| Point::new(f64::from(*x), f64::from(*y))));
        path.push(Point::new(f64::from(inside.0), f64::from(inside.1)));
        prop_assert_eq!(cuts::crossings(&path, &ring) % 2, 1, "{:?}", path);
    }
}
