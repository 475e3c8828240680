#![allow(clippy::unwrap_used, reason = "tests")]

use super::*;
use crate::draws::{Draws, ring};
use proptest::prelude::*;
use world::Vector;

const SIGMA_M: f64 = 0.02;

/// Pulses from every station to every other, with these errors.
fn pulses(stations: &[Station], scale: f64, offsets_m: &[f64], draws: &mut Draws) -> Vec<Pulse> {
    let mut pulses = Vec::new();
    for (from, sender) in stations.iter().enumerate() {
        for (to, receiver) in stations.iter().enumerate().filter(|(to, _)| *to != from) {
            let distance_m = (sender.position - receiver.position).norm();
            let length_m =
                distance_m * (1.0 + scale) + offsets_m[to] - offsets_m[from] + SIGMA_M * draws.bell();
            pulses.push(Pulse { sender: sender.id, receiver: receiver.id, length_m, sigma_m: SIGMA_M });
        }
    }
    pulses
}

/// The stated standard deviations are those of many tests, and not won by being wide.
#[test]
fn speed_of_sound_and_clocks_scatter_as_stated() {
    for n in [3, 4, 6, 8] {
        let stations = ring(n, 10.0);
        let mut draws = Draws::new(0.0, 1, 61);
        let mut offsets_m: Vec<f64> = (0..n).map(|_| 3.0 * draws.bell()).collect();
        let mean_m = offsets_m.iter().sum::<f64>() / f64::from(n);
        for offset_m in &mut offsets_m {
            *offset_m -= mean_m;
        }
        let (mut by_scale, mut by_offset) = (0.0, 0.0);
        for _ in 0..2_000 {
            let test = PulseTest::new(&pulses(&stations, -0.013, &offsets_m, &mut draws), &stations).unwrap();
            by_scale += ((test.scale.value + 0.013) / test.scale.sigma).powi(2) / 2_000.0;
            let first = test.offsets_m[0].1;
            by_offset += ((first.value - offsets_m[0]) / first.sigma).powi(2) / 2_000.0;
            assert!(test.scale.sigma < 1e-3 && first.sigma < SIGMA_M, "{n}: {test:?}");
        }
        assert!(
            (0.9..1.1).contains(&by_scale) && (0.9..1.1).contains(&by_offset),
            "{n}: {by_scale}, {by_offset}"
        );
    }
}

#[test]
fn sound_tests_rarely_alarm_and_a_station_off_its_place_is_named() {
    let stations = ring(6, 10.0);
    let mut draws = Draws::new(0.0, 1, 62);
    let (mut alarms, mut named) = (0, 0);
    for _ in 0..1_000 {
        let sound = PulseTest::new(&pulses(&stations, 0.01, &[0.0; 6], &mut draws), &stations).unwrap();
        alarms += u32::from(sound.integrity == Integrity::Alarm);
        let mut moved = stations.clone();
        moved[2].position += Vector::new(0.15, -0.1);
        let test = PulseTest::new(&pulses(&moved, 0.01, &[0.0; 6], &mut draws), &stations).unwrap();
        named += u32::from(test.integrity == Integrity::Alarm && test.suspect == Some(StationId(3)));
    }
    assert!(alarms <= 8, "{alarms} of 1000");
    assert!(named >= 990, "{named} of 1000");
}

#[test]
fn pulses_in_one_direction_or_between_separate_groups_determine_nothing() {
    let (stations, mut draws) = (ring(4, 10.0), Draws::new(0.0, 1, 63));
    let all = pulses(&stations, 0.0, &[0.0; 4], &mut draws);
    let with =
        |keeps: &dyn Fn(&Pulse) -> bool| -> Vec<Pulse> { all.iter().filter(|p| keeps(p)).copied().collect() };
    let from_first = with(&|pulse| pulse.sender == StationId(1));
    let in_pairs = with(&|pulse| (pulse.sender.0 <= 2) == (pulse.receiver.0 <= 2));
    for pulses in [Vec::new(), from_first, in_pairs] {
        assert_eq!(PulseTest::new(&pulses, &stations), Err(PulseError::NotDetermined), "{pulses:?}");
    }
    let to_itself = Pulse { receiver: StationId(1), ..all[0] };
    assert_eq!(PulseTest::new(&[to_itself], &stations), Err(PulseError::BadPulse { index: 0 }));
    let endless = Pulse { length_m: f64::NAN, ..all[0] };
    assert_eq!(PulseTest::new(&[all[0], endless], &stations), Err(PulseError::BadPulse { index: 1 }));
    let stranger = Pulse { sender: StationId(9), ..all[0] };
    let error = PulseError::UnknownStation { station: StationId(9) };
    assert_eq!(PulseTest::new(&[stranger], &stations), Err(error));
}

#[test]
fn between_two_tests_the_errors_change_linearly_and_outside_they_stay() {
    let (stations, mut draws) = (ring(4, 10.0), Draws::new(0.0, 1, 64));
    let mut exact = |scale: f64, offset_m: f64| {
        let offsets_m = [offset_m, -offset_m, 0.0, 0.0];
        let mut pulses = pulses(&stations, scale, &offsets_m, &mut draws);
        for pulse in &mut pulses {
            let offset_m = |id: StationId| offsets_m[id.0 as usize - 1];
            pulse.length_m = distance_m(pulse, &stations) * (1.0 + scale) + offset_m(pulse.receiver)
                - offset_m(pulse.sender);
        }
        PulseTest::new(&pulses, &stations).unwrap()
    };
    let series = PulseSeries { tests: vec![(100.0, exact(0.0, 0.2)), (300.0, exact(0.02, 0.4))] };
    for (t_s, scale, offset_m) in [(0.0, 0.0, 0.2), (100.0, 0.0, 0.2), (200.0, 0.01, 0.3), (900.0, 0.02, 0.4)]
    {
        let mut sets =
            vec![RangeSet { station: StationId(1), ranges_m: vec![7.0 * (1.0 + scale) + offset_m] }];
        series.correct(t_s, &mut sets);
        assert!((sets[0].ranges_m[0] - 7.0).abs() < 1e-9, "{t_s}: {sets:?}");
    }
    let untested = || vec![RangeSet { station: StationId(9), ranges_m: vec![7.0] }];
    let mut sets = untested();
    PulseSeries::default().correct(5.0, &mut sets);
    assert_eq!(sets, untested());
    series.correct(5.0, &mut sets);
    assert!(sets.is_empty(), "the clock of a station in no test is unknown: {sets:?}");
}

#[test]
fn clocks_that_changed_since_an_earlier_test_are_named() {
    let stations = ring(6, 10.0);
    let mut draws = Draws::new(0.0, 1, 9);
    let mut test = |offsets_m: &[f64]| {
        let made: Vec<Pulse> = (0..10).flat_map(|_| pulses(&stations, 0.02, offsets_m, &mut draws)).collect();
        PulseTest::new(&made, &stations).unwrap()
    };
    let before = test(&[0.2, 0.0, -0.1, 0.0, 0.0, 0.3]);
    assert_eq!(test(&[0.2, 0.0, -0.1, 0.0, 0.0, 0.3]).clock_changes_since(&before), []);
    let changed = test(&[0.7, 0.0, -0.1, 0.5, 0.0, 0.3]).clock_changes_since(&before);
    let named: Vec<(u32, bool)> =
        changed.iter().map(|(id, change)| (id.0, (change.value - 0.5).abs() < 0.15)).collect();
    assert_eq!(named, [(1, true), (4, true)], "{changed:?}");
}

proptest! {
    #[test]
    fn any_pulses_give_a_finite_test_or_a_reason(
        raw in prop::collection::vec((0u32..5, 0u32..5, prop::num::f64::ANY, prop::num::f64::ANY), 0..30),
    ) {
        let stations = ring(4, 10.0);
        let pulse = |(sender, receiver, length_m, sigma_m): &(u32, u32, f64, f64)| Pulse {
            sender: StationId(*sender), receiver: StationId(*receiver), length_m: *length_m, sigma_m: *sigma_m,
        };
        let pulses: Vec<Pulse> = raw.iter().map(pulse).collect();
        if let Ok(test) = PulseTest::new(&pulses, &stations) {
            prop_assert!(test.scale.value.is_finite() && test.scale.sigma.is_finite());
            prop_assert!(test.offsets_m.iter().all(|(_, o)| o.value.is_finite() && o.sigma.is_finite()));
        }
    }
}

#[test]
fn a_speed_of_sound_that_no_liquid_has_is_refused() {
    let (stations, mut draws) = (ring(6, 10.0), Draws::new(0.0, 1, 66));
    for scale in [-0.5, 0.31, 2.0] {
        let found = PulseTest::new(&pulses(&stations, scale, &[0.0; 6], &mut draws), &stations);
        assert!(matches!(found, Err(PulseError::Implausible { scale: told }) if (told - scale).abs() < 0.01));
    }
    let text = PulseError::Implausible { scale: 2.0 }.to_string();
    assert!(text.contains("200 % too long") && text.contains("at most 30 %"), "{text}");
    assert!(PulseTest::new(&pulses(&stations, 0.29, &[0.0; 6], &mut draws), &stations).is_ok());
}
