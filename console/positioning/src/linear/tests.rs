#![allow(clippy::unwrap_used, reason = "tests")]

use super::*;
use crate::{
    Aggregation, RangeNoise,
    draws::{Draws, exact, paper_stations, ring, skew_stations, stations},
};
use proptest::prelude::*;
use world::StationId;

fn ranging(id: u32, range_m: f64) -> Ranging {
    Ranging::single(StationId(id), range_m, 0.03)
}

/// Eq. 6-9 in the tank frame, by Cramer's rule.
fn as_printed(stations: &[Station], ranges_m: [f64; 3]) -> Point {
    let s = |i: usize| stations[i].position.coords;
    let x = |i: usize| s(2) - s(i);
    let y = |i: usize| {
        (ranges_m[i].powi(2) - ranges_m[2].powi(2) + s(2).norm_squared() - s(i).norm_squared()) / 2.0
    };
    let determinant = x(0).perp(&x(1));
    Point::new((y(0) * x(1).y - y(1) * x(0).y) / determinant, (x(0).x * y(1) - x(1).x * y(0)) / determinant)
}

proptest! {
    #[test]
    fn the_papers_layout_has_the_closed_form(a in 1.0..20.0_f64, b in 1.0..20.0_f64, c in 1.0..20.0_f64) {
        let ranges = [ranging(1, a), ranging(2, b), ranging(3, c)];
        let fix = LinearLs.solve(&ranges, &paper_stations(), None).unwrap();
        let closed = Point::new((b * b - a * a) / 30.0, (a * a + b * b - 2.0 * c * c) / 30.0);
        prop_assert!((fix.position - closed).norm() < 1e-9);
        prop_assert!((fix.conditioning - 1.0).abs() < 1e-9);
    }

    #[test]
    fn a_layout_without_symmetry_follows_the_printed_equations(
        a in 1.0..20.0_f64, b in 1.0..20.0_f64, c in 1.0..20.0_f64,
    ) {
        let stations = skew_stations();
        let fix = LinearLs.solve(&[ranging(1, a), ranging(2, b), ranging(3, c)], &stations, None).unwrap();
        prop_assert!((fix.position - as_printed(&stations, [a, b, c])).norm() < 1e-9);
    }

    #[test]
    fn exact_ranges_give_the_exact_point(
        places in prop::collection::vec((-20.0..20.0_f64, -20.0..20.0_f64), 3..8),
        x in -15.0..15.0_f64,
        y in -15.0..15.0_f64,
    ) {
        let (stations, truth) = (stations(&places), Point::new(x, y));
        prop_assume!(stations.iter().all(|s| (s.position - truth).norm() > 0.01));
        match LinearLs.solve(&exact(&stations, truth), &stations, None) {
            Ok(fix) => prop_assert!((fix.position - truth).norm() < 1e-8, "{}", fix.position),
            Err(error) => prop_assert!(matches!(error, FixError::Collinear { .. }), "{}", error),
        }
    }

    #[test]
    fn more_than_three_stations_are_solved_with_the_least_squares(
        errors in prop::collection::vec(-0.5..0.5_f64, 6),
    ) {
        let stations = ring(6, 7.0);
        let mut ranges = exact(&stations, Point::new(1.0, 2.0));
        ranges.iter_mut().zip(&errors).for_each(|(r, e)| r.range_m += e);
        let found = LinearLs.solve(&ranges, &stations, None).unwrap().position;
        let reference = (stations[5].position, ranges[5].range_m);
        // At the least squares, the misfits are orthogonal to the columns.
        let slope: Vector = stations[..5].iter().zip(&ranges).map(|(s, r)| {
            let offset = s.position - reference.0;
            let squares = reference.1.powi(2) - r.range_m.powi(2) + offset.norm_squared();
            offset * (offset.dot(&(found - reference.0)) - squares / 2.0)
        }).sum();
        prop_assert!(slope.norm() < 1e-8);
    }
}

#[test]
fn the_condition_number_is_the_ratio_of_the_singular_values() {
    for stations in [skew_stations(), ring(7, 5.0), stations(&[(7.5, 0.0), (-7.5, 0.0), (0.0, 0.5)])] {
        let anchors = anchored(&exact(&stations, Point::new(1.0, 1.0)), &stations).unwrap();
        let rows: Vec<f64> = anchors[..anchors.len() - 1]
            .iter()
            .flat_map(|a| (a.at - anchors[anchors.len() - 1].at).data.0[0])
            .collect();
        let values = nalgebra::DMatrix::from_row_slice(anchors.len() - 1, 2, &rows).singular_values();
        assert!((conditioning(&anchors) - values[0] / values[1]).abs() < 1e-9 * values[0] / values[1]);
    }
}

#[test]
fn the_mean_of_the_positions_is_the_position_of_the_root_mean_squares() {
    let (stations, mut draws) = (skew_stations(), Draws::new(0.05, 20, 3));
    let sets = draws.cycle(&stations, Point::new(2.0, -5.0));
    let single =
        |k: usize| as_printed(&stations, [sets[0].ranges_m[k], sets[1].ranges_m[k], sets[2].ranges_m[k]]);
    let mean = (0..20).map(|k| single(k).coords).sum::<Vector>() / 20.0;
    let rangings =
        Aggregation::RootMeanSquare.aggregate(&sets, &RangeNoise::Gaussian { sigma_ratio: 0.03 }).unwrap();
    let fix = LinearLs.solve(&rangings, &stations, None).unwrap();
    assert!((fix.position.coords - mean).norm() < 1e-9);
}

/// Mean and standard deviation of the error of the paper's estimator at a place.
fn moments(truth: Point, runs: usize) -> (Vector, Vector) {
    let (stations, mut draws) = (paper_stations(), Draws::new(0.05, 20, 11));
    let errors: Vec<Vector> = (0..runs)
        .map(|_| draws.rangings(&stations, truth, Aggregation::RootMeanSquare))
        .map(|rangings| LinearLs.solve(&rangings, &stations, None).unwrap().position - truth)
        .collect();
    let mean = errors.iter().sum::<Vector>() / runs as f64;
    let variance = errors.iter().map(|e| (e - mean).map(|c| c * c)).sum::<Vector>() / (runs - 1) as f64;
    (mean, variance.map(f64::sqrt))
}

#[test]
fn the_scatter_at_the_centre_is_that_of_first_order() {
    let (_, sigma) = moments(Point::origin(), 20_000);
    // (2 s / 30)^2 (l_A^4 + l_B^4 [+ 4 l_C^4]) / N; 20 000 runs determine a sigma to half a per cent.
    assert!((sigma.x / 0.0342 - 1.0).abs() < 0.02, "{sigma}");
    assert!((sigma.y / 0.0593 - 1.0).abs() < 0.02, "{sigma}");
}

#[test]
fn the_bias_points_away_from_the_circumcentre() {
    let (bias, sigma) = moments(Point::new(9.0, 3.0), 60_000);
    let expected = Vector::new(9.0, 3.0) * 0.05_f64.powi(2) / 3.0;
    let standard_error = sigma / 60_000.0_f64.sqrt();
    assert!((bias.x - expected.x).abs() < 4.0 * standard_error.x, "{bias} for {expected}");
    assert!((bias.y - expected.y).abs() < 4.0 * standard_error.y, "{bias} for {expected}");
    assert!(bias.x > 5.0 * standard_error.x);
}

#[test]
fn the_covariance_is_the_scatter() {
    for stations in [skew_stations(), ring(6, 7.0)] {
        let (truth, mut draws) = (Point::new(-3.0, -4.0), Draws::new(0.05, 20, 5));
        let (mut scatter, mut reported) = (Matrix2::zeros(), Matrix2::zeros());
        for _ in 0..10_000 {
            let fix = LinearLs
                .solve(&draws.rangings(&stations, truth, Aggregation::Mean), &stations, None)
                .unwrap();
            scatter += (fix.position - truth) * (fix.position - truth).transpose() / 10_000.0;
            reported += fix.covariance / 10_000.0;
        }
        assert!((scatter - reported).norm() < 0.05 * reported.norm(), "{scatter} {reported}");
    }
}

#[test]
fn the_mean_error_on_the_disc_is_that_of_the_reproduction() {
    let (stations, mut draws) = (paper_stations(), Draws::new(0.05, 20, 7));
    let error = |draws: &mut Draws| {
        let truth = draws.on_disc();
        let rangings = draws.rangings(&stations, truth, Aggregation::RootMeanSquare);
        (LinearLs.solve(&rangings, &stations, None).unwrap().position - truth).norm()
    };
    let mean = (0..10_000).map(|_| error(&mut draws)).sum::<f64>() / 10_000.0;
    assert!((mean - 0.1259).abs() < 0.004, "{mean}");
}

#[test]
fn stations_on_a_line_are_refused() {
    let stations = stations(&[(-5.0, 1.0), (0.0, 1.0), (5.0, 1.0)]);
    let answer = LinearLs.solve(&exact(&stations, Point::new(1.0, 3.0)), &stations, None);
    assert!(matches!(answer, Err(FixError::Collinear { conditioning, .. }) if conditioning > 1e6));
}

#[test]
fn the_reasons_against_a_fix_are_named() {
    let stations = paper_stations();
    let solve = |ranges: &[Ranging]| LinearLs.solve(ranges, &stations, None).unwrap_err();
    assert_eq!(solve(&[ranging(1, 5.0), ranging(2, 5.0)]), FixError::TooFewStations { have: 2, need: 3 });
    assert_eq!(
        solve(&[ranging(1, 5.0), ranging(2, 5.0), ranging(1, 5.0)]),
        FixError::DuplicateStation { station: StationId(1) }
    );
    assert_eq!(
        solve(&[ranging(1, 5.0), ranging(9, 5.0)]),
        FixError::UnknownStation { station: StationId(9) }
    );
    assert_eq!(solve(&[ranging(1, f64::NAN)]), FixError::BadRange { station: StationId(1) });
}
