//! Pulses of stations in a file of readings.

use super::{Readable, located, scenario};
use mission::{EventKind, event::PulsePhase};
use positioning::Integrity;
use std::fmt::Write as _;
use world::{Point, Station};

/// Length by which every range is too long, as a share.
const SCALE: f64 = 0.03;
/// Offsets of the stations' clocks, metres; their mean is 0.
const OFFSETS_M: [f64; 6] = [0.6, -0.4, 0.2, -0.7, 0.5, -0.2];
const AT: Point = Point::new(3.0, 0.0);

/// Rows with pulses from every station to every other at a time.
fn pulses(text: &mut String, t_s: f64, stations: &[Station]) {
    scaled(text, t_s, stations, SCALE);
}

/// The same, with another share by which ranges are too long.
fn scaled(text: &mut String, t_s: f64, stations: &[Station], scale: f64) {
    for (from, sender) in stations.iter().enumerate() {
        for (to, receiver) in stations.iter().enumerate().filter(|(to, _)| *to != from) {
            let distance_m = (sender.position - receiver.position).norm();
            let length_m = distance_m * (1.0 + scale) + OFFSETS_M[to] - OFFSETS_M[from];
            writeln!(text, "{t_s},{},{},{length_m}", sender.name, receiver.name).unwrap();
        }
    }
}

/// Rows with ranges of the robot at a time.
fn ranges(text: &mut String, t_s: f64, stations: &[Station]) {
    for (station, offset_m) in stations.iter().zip(OFFSETS_M) {
        let range_m = (station.position - AT).norm() * (1.0 + SCALE) + offset_m;
        writeln!(text, "{t_s},,{},{range_m}", station.name).unwrap();
    }
}

/// Readings with pulses before, during and after the run.
fn readings(with_pulses: bool) -> Readable {
    let stations = scenario().sim.world.stations;
    let mut text = "t_s,sender,station,range_m\n".to_owned();
    for (t_s, is_pulse) in
        [(0.0, true), (5.0, false), (6.0, false), (20.0, true), (30.0, false), (90.0, true)]
    {
        match (is_pulse, with_pulses) {
            (true, true) => pulses(&mut text, t_s, &stations),
            (true, false) => {}
            (false, _) => ranges(&mut text, t_s, &stations),
        }
    }
    Readable::new("r.csv", text)
}

fn fixes(readable: &Readable) -> Vec<Point> {
    let scenario = scenario();
    let task = readable.task(&scenario);
    let (_, events) = located(&task, &task.survey().unwrap());
    let fix = |event: &mission::Event| match &event.kind {
        EventKind::Fixed { fix } => Some(fix.position),
        _ => None,
    };
    events.iter().filter_map(fix).collect()
}

#[test]
fn pulses_before_during_and_after_a_run_correct_its_ranges() {
    let (scenario, readable) = (scenario(), readings(true));
    let task = readable.task(&scenario);
    let survey = task.survey().unwrap();
    let phases: Vec<PulsePhase> = survey.pulses.iter().map(|pulsed| pulsed.phase).collect();
    assert_eq!(phases, [PulsePhase::Before, PulsePhase::Held, PulsePhase::After]);
    for pulsed in &survey.pulses {
        assert!((pulsed.test.scale.value - SCALE).abs() < 1e-6, "{pulsed:?}");
        assert_eq!((pulsed.test.integrity, pulsed.test.pulses), (Integrity::Ok, 30));
    }
    let found = fixes(&readable);
    assert_eq!(found.len(), 3);
    assert!(found.iter().all(|at| (at - AT).norm() < 0.02), "{found:?}");
    let without = fixes(&readings(false));
    assert!(without.iter().all(|at| (at - AT).norm() > 0.1), "{without:?}");
    let (_, events) = located(&task, &survey);
    let times: Vec<f64> = events
        .iter()
        .filter(|event| matches!(event.kind, EventKind::PulsesTested { .. }))
        .map(|event| event.t_s)
        .collect();
    assert_eq!(times, [0.0, 20.0, 90.0]);
}

#[test]
fn wrong_pulses_are_named_with_row_and_remedy() {
    let refused = |text: &str| Readable::new("r.csv", text).refused();
    let own = refused("t_s,sender,station,range_m\n0,A,A,3\n");
    assert!(own.contains("station A hears its own pulse; name the station that heard it"), "{own}");
    let unknown = refused("t_s,sender,station,range_m\n0,G,A,3\n");
    assert!(unknown.contains("the scenario has no station `G`"), "{unknown}");
    let nobody = refused("t_s,sender,station,range_m\n0,A,,\n");
    assert!(nobody.contains("station A sent a pulse, but the row has no reading"), "{nobody}");
    let one_way = refused("t_s,sender,station,range_m\n0,A,B,10\n1,,A,7\n1,,B,7\n1,,C,8\n");
    assert!(one_way.contains("pulses before the run: the pulses do not separate"), "{one_way}");
    let scenario = scenario();
    let text = "t_s,sender,station,tdoa_s\n0,A,B,0.01\n";
    let readable = Readable::new("r.csv", text);
    let task = crate::Task { sound_speed_m_s: Some(1200.0), ..readable.task(&scenario) };
    let differences = task.survey().unwrap_err().to_string();
    assert!(differences.contains("the pulse of station A needs its time of emission"), "{differences}");
    let readable = readings(true);
    let task = crate::Task { finds_sound_speed: true, ..readable.task(&scenario) };
    let twice = task.survey().unwrap_err().to_string();
    assert!(twice.contains("already give the speed of sound; leave out --find sound-speed"), "{twice}");
}

/// A file with pulses before the robot, in which one length is replaced.
fn replaced(length: &str) -> Readable {
    let stations = scenario().sim.world.stations;
    let mut text = "t_s,sender,station,range_m\n".to_owned();
    pulses(&mut text, 0.0, &stations);
    ranges(&mut text, 5.0, &stations);
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    let (start, _) = lines[3].rsplit_once(',').unwrap();
    lines[3] = format!("{start},{length}");
    Readable::new("r.csv", lines.join("\n") + "\n")
}

#[test]
fn a_pulse_of_an_impossible_length_is_a_bad_row() {
    for length in ["nan", "inf", "1e308", "65535", "-5", "0"] {
        let readable = replaced(length);
        let text = readable.refused();
        for part in
            ["r.csv, line 4, range_m:", &format!("`{length}` is impossible for a pulse"), "--skip-bad-rows"]
        {
            assert!(text.contains(part), "{length}: {text}");
        }
        let scenario = scenario();
        let task = crate::Task { skips_bad_rows: true, ..readable.task(&scenario) };
        let survey = task.survey().unwrap();
        assert_eq!((survey.bad, survey.pulses[0].test.pulses), (1, 29), "{length}");
        assert!((survey.pulses[0].test.scale.value - SCALE).abs() < 1e-6, "{length}");
    }
}

#[test]
fn a_speed_of_sound_that_pulses_make_implausible_is_refused() {
    for scale in [-0.5, 0.8] {
        let stations = scenario().sim.world.stations;
        let mut text = "t_s,sender,station,range_m\n".to_owned();
        scaled(&mut text, 0.0, &stations, scale);
        ranges(&mut text, 5.0, &stations);
        let text = Readable::new("r.csv", text).refused();
        assert!(
            text.contains("r.csv: pulses before the run: according to the pulses, all ranges are"),
            "{text}"
        );
        assert!(text.contains("check the unit of the pulses"), "{text}");
    }
}

#[test]
fn repetitions_of_a_pulse_that_are_copies_count_as_one() {
    let stations = scenario().sim.world.stations;
    let survey = |copies: u32| {
        let mut text = "t_s,sender,station,range_m\n".to_owned();
        (0..copies).for_each(|_| pulses(&mut text, 0.0, &stations));
        ranges(&mut text, 5.0, &stations);
        let (scenario, readable) = (scenario(), Readable::new("r.csv", text));
        readable.task(&scenario).survey().unwrap().pulses.remove(0).test
    };
    let (one, copies) = (survey(1), survey(1_000));
    assert_eq!((one.pulses, one.integrity), (copies.pulses, copies.integrity));
    assert!((one.scale.sigma / copies.scale.sigma - 1.0).abs() < 1e-6, "{one:?}, {copies:?}");
}

#[test]
fn a_test_that_contradicts_the_survey_corrects_nothing() {
    let stations = scenario().sim.world.stations;
    let mut moved = stations.clone();
    moved[1].position += world::Vector::new(0.0, 3.0);
    let mut text = "t_s,sender,station,range_m\n".to_owned();
    pulses(&mut text, 0.0, &moved);
    ranges(&mut text, 5.0, &stations);
    let (scenario, readable) = (scenario(), Readable::new("r.csv", text));
    let task = readable.task(&scenario);
    let survey = task.survey().unwrap();
    assert_eq!(survey.pulses[0].test.integrity, Integrity::Alarm);
    let (_, events) = located(&task, &survey);
    let ranged = events.iter().find_map(|event| match &event.kind {
        EventKind::Ranged { ranges } => Some(ranges[0].range_m),
        _ => None,
    });
    let as_read = (stations[0].position - AT).norm() * (1.0 + SCALE) + OFFSETS_M[0];
    assert!((ranged.unwrap() - as_read).abs() < 1e-6, "{ranged:?}, {as_read}");
}

/// A test after the run says nothing about the robot, which was not located then.
#[test]
fn a_pulse_test_after_the_run_does_not_lengthen_the_track() {
    let scenario = scenario();
    let readable = readings(true);
    let task = readable.task(&scenario);
    let (tally, events) = located(&task, &task.survey().unwrap());
    let last_s = |is_it: fn(&EventKind) -> bool| {
        events.iter().filter(|event| is_it(&event.kind)).map(|event| event.t_s).fold(0.0, f64::max)
    };
    let is_at = |is_it, t_s: f64| (last_s(is_it) - t_s).abs() < 1e-9;
    assert!(is_at(|kind| matches!(kind, EventKind::Estimated { .. }), 30.0));
    assert!(is_at(|kind| matches!(kind, EventKind::PulsesTested { .. }), 90.0));
    assert!(tally.error_95_m.is_some_and(|[_, most_m]| most_m < 30.0), "{tally:?}");
    assert!(events.windows(2).all(|pair| pair[0].t_s <= pair[1].t_s && pair[0].tick <= pair[1].tick));
}
