#![allow(clippy::unwrap_used, reason = "tests")]

use super::*;
use crate::{
    Aggregation, Integrity, Nls, PositionSolver,
    draws::{Draws, ring},
};
use world::Vector;

/// Ranges of a cycle with sound that is 2 % slower than assumed.
fn slow(draws: &mut Draws, stations: &[Station], truth: Point) -> Vec<Ranging> {
    let mut ranges = draws.rangings(stations, truth, Aggregation::Mean);
    for r in &mut ranges {
        r.range_m *= 1.02;
        r.sigma_m *= 1.02;
    }
    ranges
}

#[test]
fn a_session_finds_the_speed_of_sound() {
    let (stations, mut draws) = (ring(6, 7.5), Draws::new(0.05, 20, 5));
    let mut calibration = Calibration::new(&stations, Unknowns::default());
    for _ in 0..100 {
        let truth = draws.on_disc();
        calibration.take(&slow(&mut draws, &stations, truth), None).unwrap();
    }
    let (scale, sigma) = calibration.scale();
    assert!((scale - 0.02).abs() < 4.0 * sigma && sigma < 1e-3, "{scale} {sigma}");
    let (mut with, mut without) = (0.0, 0.0);
    for _ in 0..300 {
        let truth = draws.on_disc();
        let ranges = slow(&mut draws, &stations, truth);
        let fix = Nls.solve(&calibration.corrected(&ranges), &stations, None).unwrap();
        with += (fix.position - truth).norm() / 300.0;
        without += (Nls.solve(&ranges, &stations, None).unwrap().position - truth).norm() / 300.0;
    }
    assert!(with < 0.039 && without > 0.05, "{with} {without}");
}

#[test]
fn the_scale_becomes_surer_with_every_cycle_and_is_honest() {
    let stations = ring(8, 7.5);
    let (mut inside, runs) = (0, 60);
    for seed in 0..runs {
        let mut draws = Draws::new(0.05, 20, 100 + seed);
        let mut calibration = Calibration::new(&stations, Unknowns::default());
        let mut before = f64::INFINITY;
        for _ in 0..20 {
            let truth = draws.on_disc();
            if calibration.take(&slow(&mut draws, &stations, truth), None).unwrap() {
                assert!(calibration.scale().1 < before);
                before = calibration.scale().1;
            }
        }
        let (scale, sigma) = calibration.scale();
        inside += u64::from((scale - 0.02).abs() < 2.0 * sigma);
    }
    assert!(inside >= 50, "{inside} of {runs}");
}

#[test]
fn a_lying_station_does_not_spoil_the_scale() {
    let (stations, mut draws) = (ring(8, 7.5), Draws::new(0.05, 20, 6));
    let mut calibration = Calibration::new(&stations, Unknowns::default());
    for k in 0..100 {
        let truth = draws.on_disc();
        let mut ranges = slow(&mut draws, &stations, truth);
        if k % 2 == 0 {
            ranges[k % 8].range_m += 2.0;
        }
        calibration.take(&ranges, None).unwrap();
    }
    assert!(calibration.cycles() < 70, "{}", calibration.cycles());
    assert!((calibration.scale().0 - 0.02).abs() < 2e-3, "{:?}", calibration.scale());
}

#[test]
fn a_session_finds_where_the_stations_are() {
    let surveyed = ring(6, 7.5);
    let mut draws = Draws::new(0.05, 20, 7);
    let mut real = surveyed.clone();
    for station in &mut real {
        station.position += Vector::new(draws.bell(), draws.bell()) * 0.1;
    }
    let mut calibration =
        // If the speed of sound were free as well, a large array could not be distinguished from a low speed of sound.
        Calibration::new(&surveyed, Unknowns { survey_sigma_m: 0.1, sound_sigma_ratio: 0.0, offset_sigma_m: 0.0 });
    for _ in 0..400 {
        let truth = draws.on_disc();
        calibration.take(&draws.rangings(&real, truth, Aggregation::Mean), None).unwrap();
    }
    let (mut with, mut without) = (0.0, 0.0);
    let found = calibration.stations();
    // The session reveals only the shape of the array, not its position or rotation.
    let spread = |places: &[Station]| {
        let pairs = (0..6).flat_map(|i| (0..i).map(move |j| (i, j)));
        pairs
            .map(|(i, j)| {
                let length = |s: &[Station]| (s[i].position - s[j].position).norm();
                (length(places) - length(&real)).powi(2) / 15.0
            })
            .sum::<f64>()
            .sqrt()
    };
    assert!(spread(&found) < 0.35 * spread(&surveyed), "{} {}", spread(&found), spread(&surveyed));
    for _ in 0..300 {
        let truth = draws.on_disc();
        let ranges = draws.rangings(&real, truth, Aggregation::Mean);
        with += Nls.solve(&calibration.corrected(&ranges), &found, None).unwrap().chi2 / 300.0;
        without += Nls.solve(&ranges, &surveyed, None).unwrap().chi2 / 300.0;
    }
    assert!(with < 5.0 && without > 7.0, "{with} {without}");
}

#[test]
fn three_stations_contribute_nothing_and_nonsense_is_refused() {
    let stations = ring(3, 7.5);
    let mut draws = Draws::new(0.05, 20, 8);
    let mut calibration = Calibration::new(&stations, Unknowns::default());
    let truth = Point::new(1.0, 2.0);
    assert_eq!(calibration.take(&draws.rangings(&stations, truth, Aggregation::Mean), None), Ok(false));
    let nonsense = [Ranging::single(world::StationId(1), f64::NAN, 0.1)];
    assert!(matches!(calibration.take(&nonsense, None), Err(FixError::BadRange { .. })));
    assert!(calibration.scale().0.abs() < 1e-12);
}

#[test]
fn corrected_ranges_of_a_slow_medium_no_longer_alarm() {
    let (stations, mut draws) = (ring(8, 7.5), Draws::new(0.05, 20, 9));
    let mut calibration = Calibration::new(&stations, Unknowns::default());
    let (mut raw, mut good) = (0, 0);
    for k in 0..200 {
        let truth = draws.on_disc();
        let ranges = slow(&mut draws, &stations, truth);
        calibration.take(&ranges, None).unwrap();
        if k >= 50 {
            let is_ok =
                |ranges: &[Ranging]| Nls.solve(ranges, &stations, None).unwrap().integrity == Integrity::Ok;
            raw += u32::from(is_ok(&ranges));
            good += u32::from(is_ok(&calibration.corrected(&ranges)));
        }
    }
    assert!(good >= 144 && raw < 60, "{good} {raw}");
}

#[test]
fn a_session_finds_the_offset_of_the_clocks_with_and_without_the_speed_of_sound() {
    let stations = ring(8, 7.5);
    for (sound_sigma_ratio, offset_m) in [(0.0, 1.5), (0.02, 1.5), (0.02, -0.6)] {
        let unknowns = Unknowns { sound_sigma_ratio, survey_sigma_m: 0.0, offset_sigma_m: 5.0 };
        let mut draws = Draws::new(0.03, 20, 9);
        let mut cycle = || {
            let truth = draws.on_disc();
            let mut ranges = if sound_sigma_ratio > 0.0 {
                slow(&mut draws, &stations, truth)
            } else {
                draws.rangings(&stations, truth, Aggregation::Mean)
            };
            for range in &mut ranges {
                range.range_m += offset_m;
            }
            ranges.retain(|range| range.range_m > 0.0);
            ranges
        };
        let session: Vec<_> = (0..300).map(|_| cycle()).collect();
        let mut calibration = Calibration::new(&stations, unknowns);
        for _ in 0..6 {
            calibration = calibration.again();
            for ranges in &session {
                // A cycle whose position does not converge contributes nothing.
                let _ = calibration.take(ranges, None);
            }
        }
        let ((found_m, offset_sigma_m), (scale, scale_sigma)) = (calibration.offset_m(), calibration.scale());
        assert!(calibration.cycles() > 200, "{}", calibration.cycles());
        assert!(
            (found_m - offset_m).abs() < 4.0 * offset_sigma_m + 0.01 && offset_sigma_m < 0.1,
            "{found_m}"
        );
        let slower = if sound_sigma_ratio > 0.0 { 0.02 } else { 0.0 };
        assert!((scale - slower).abs() < 4.0 * scale_sigma + 1e-3, "{scale}");
    }
}
