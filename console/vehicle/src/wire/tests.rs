//! Lines that are right, wrong, damaged and divided.

use super::{
    FromSession, FromVehicle, Heard, Incoming, LINE_MAX, Reader, ToVehicle, Unknown, Writer,
    examples::{examples, to_session},
    message::{Drive, Mode, Odometry, Readings},
};
use proptest::prelude::*;

fn stream() -> Vec<u8> {
    examples("From the vehicle").iter().flat_map(|line| [line.as_bytes(), b"\n"].concat()).collect()
}

fn greeted() -> Reader<FromVehicle> {
    let mut reader = Reader::new(FromSession::default());
    let heard = reader.read(&[examples("From the vehicle")[0].as_bytes(), b"\n"].concat());
    assert!(matches!(&heard[..], [Heard::Message(FromVehicle::Hello(_))]), "{heard:?}");
    reader
}

/// The meaning of the last of these lines, as text.
fn told(lines: &[&str]) -> String {
    let mut reader = greeted();
    let mut last = None;
    for line in lines {
        let mut heard = reader.read(format!("{line}\n").as_bytes());
        // The part of a malformed state that counts follows its fault.
        let fault = heard.iter().position(|heard| matches!(heard, Heard::Malformed(_)));
        last = fault.map(|at| heard.swap_remove(at)).or_else(|| heard.pop());
    }
    match last {
        Some(Heard::Malformed(misfit)) => misfit.to_string(),
        other => format!("{other:?}"),
    }
}

#[test]
fn a_wrong_field_of_a_state_hides_neither_its_emergency_stop_nor_its_commander() {
    let state = |rest: &str| format!("{{\"type\": \"state\", \"stamp_s\": 5.0, {rest}}}\n");
    let cases = [
        (r#""mode": "emergency_stop", "battery": 87"#, "state.battery: 87", Some(Mode::EmergencyStop)),
        (r#""mode": "emergency_stop", "battery": NaN"#, "state.battery: NaN", Some(Mode::EmergencyStop)),
        (r#""battery": 87, "mode": "manual""#, "state.battery: 87", Some(Mode::Manual)),
        (r#""mode": "estop""#, "state.mode: unknown variant `estop`", Some(Mode::Fault)),
        (
            r#""mode": "ready", "battery": 87, "commander": "other_program""#,
            "state.battery",
            Some(Mode::Ready),
        ),
        (r#""mode": "ready", "battery": 87"#, "state.battery: 87", None),
        (r#""battery": 0.5"#, "state.mode: missing field", None),
    ];
    for (rest, named, mode) in cases {
        let heard = greeted().read(state(rest).as_bytes());
        let Heard::Malformed(misfit) = &heard[0] else { panic!("{heard:?}") };
        assert!(misfit.to_string().starts_with(named), "{misfit}");
        let counted = heard.iter().find_map(|heard| match heard {
            Heard::Message(FromVehicle::State(state)) => Some(state.mode),
            _ => None,
        });
        assert_eq!(counted, mode, "{rest}");
        let before_hello = Reader::<FromVehicle>::new(FromSession::default()).read(state(rest).as_bytes());
        assert_eq!(before_hello.len(), 1, "{before_hello:?}");
    }
}

#[test]
fn a_scan_with_far_fewer_rays_than_the_first_is_malformed() {
    let scan = |seq: u64, rays: usize| {
        let ranges = vec!["2.0"; rays].join(", ");
        format!(
            r#"{{"type": "readings", "seq": {seq}, "stamp_s": 5.0, "odometry": {{"over_s": 0.05, "forward_m": 0, "turn_rad": 0}}, "scan": {{"first_rad": 0, "step_rad": 0.03, "range_max_m": 8, "ranges_m": [{ranges}]}}}}"#
        )
    };
    let first = scan(1, 180);
    assert!(told(&[&first, &scan(2, 179)]).starts_with("Some(Message"));
    assert!(
        told(&[&first, &scan(2, 7)])
            .starts_with("readings.scan.ranges_m: 7 rays, but the first scan had 180")
    );
}

#[test]
fn a_number_is_named_in_few_characters() {
    let huge = r#"{"type": "state", "stamp_s": 5.0, "mode": "ready", "battery": 1e300}"#;
    assert_eq!(told(&[huge]), "state.battery: 1e300 is not between 0 and 1");
}

#[test]
fn a_wrong_line_is_named_by_its_field() {
    let readings = |rest: &str| format!(r#"{{"type": "readings", "seq": 1, "stamp_s": 5.0, {rest}}}"#);
    let cases = [
        (
            readings(r#""odometry": {"over_s": 0.05, "forward_m": NaN, "turn_rad": 0}"#),
            "readings.odometry.forward_m: NaN is not a finite number",
        ),
        (
            readings(r#""odometry": {"over_s": 0.05, "forward_m": -Infinity, "turn_rad": 0}"#),
            "readings.odometry.forward_m: -Infinity is not a finite number",
        ),
        (
            readings(r#""odometry": {"over_s": 0.05, "forward_m": 1e999, "turn_rad": 0}"#),
            "readings.odometry.forward_m: the number is too large",
        ),
        (
            readings(r#""odometry": {"over_s": 0.05, "forward_m": 5, "turn_rad": 0}"#),
            "readings.odometry.forward_m: 5 m in 0.05 s, but the vehicle's limit is 0.4 m/s",
        ),
        (
            readings(r#""odometry": {"over_s": 0.05, "forward_m": 0, "turn_rad": 2.8}"#),
            "readings.odometry.turn_rad: 2.8 rad in 0.05 s, but the vehicle's limit is 1 rad/s",
        ),
        (
            readings(r#""odometry": {"over_s": 0, "forward_m": 0, "turn_rad": 0}"#),
            "readings.odometry.over_s: 0 is out of range: greater than 0 and at most 10 is allowed",
        ),
        (
            readings(r#""odometry": {"over_s": 1, "forward_m": "far", "turn_rad": 0}"#),
            "readings.odometry.forward_m: invalid type: string \"far\", expected a number",
        ),
        (
            readings(
                r#""scan": {"first_rad": 0, "step_rad": 1, "range_max_m": 8, "ranges_m": [1, null, 2, 9]}"#,
            ),
            "readings.scan.ranges_m[3]: 9 is not between 0 and 8",
        ),
        (
            readings(r#""pulses": [{"sender": "A", "receiver": "A", "lengths_m": [1]}]"#),
            "readings.pulses[0].receiver: station A cannot hear itself",
        ),
        (
            readings(r#""pulses": [{"sender": "A", "receiver": "B", "lengths_m": [1, 1e308]}]"#),
            "readings.pulses[0].lengths_m[1]: 1e308 is not between -1000 and 1000",
        ),
        (
            readings(r#""ae": {"ranges": [{"station": "A", "ranges_m": [1, -2]}]}"#),
            "readings.ae.ranges[0].ranges_m[1]: -2 is out of range: greater than 0 and at most 1000 is allowed",
        ),
        (readings(r#""dead_channels": [3, 512]"#), "readings.dead_channels: 512"),
        (readings(r#""dead_channels": [-1]"#), "readings.dead_channels"),
        (r#"{"type": "readings", "stamp_s": 5}"#.into(), "readings.seq: missing field `seq`"),
        (r#"{"type": "readings", "seq": -1, "stamp_s": 5}"#.into(), "readings.seq: invalid value"),
        (r#"{"type": "readings", "seq": 1, "stamp_s"#.into(), "readings.seq: the line ends here, before"),
        (
            r#"{"type": "state", "stamp_s": 1, "mode": "asleep"}"#.into(),
            "state.mode: unknown variant `asleep`",
        ),
        (
            r#"{"type": "state", "stamp_s": 1, "mode": "fault", "text": "\u001b[2J"}"#.into(),
            "state.text: contains",
        ),
        (r#"{"seq": 1}"#.into(), "type: missing field `type`"),
        ("hello".into(), "the line is not a JSON object"),
        (r#"["bye"]"#.into(), "the line is not a JSON object"),
    ];
    for (line, expected) in cases {
        let said = told(&[&line]);
        assert!(said.starts_with(expected), "{line}\n  {said}\n  {expected}");
    }
}

#[test]
fn the_reason_for_a_malformed_line_is_short() {
    let long = "x".repeat(10_000);
    for line in [
        format!(r#"{{"type": "state", "stamp_s": "{long}", "mode": "ready"}}"#),
        format!(r#"{{"type": "state", "stamp_s": 1, "mode": "{long}"}}"#),
    ] {
        let said = told(&[&line]);
        assert!(said.starts_with("state.") && said.len() < 200, "{said}");
    }
}

#[test]
fn stamps_and_poses_must_fit_the_messages_before() {
    let at = |stamp: f64, x: f64| {
        format!(
            r#"{{"type": "readings", "seq": 1, "stamp_s": {stamp}, "pose": {{"x_m": {x}, "y_m": 0, "heading_rad": 0}}}}"#
        )
    };
    let after = |lines: [String; 2]| told(&[&lines[0], &lines[1]]);
    assert_eq!(
        after([at(9.0, 0.0), at(9.1, 5.0)]),
        "readings.pose.x_m: jumps by 5.000 m in 0.100 s, but the vehicle's limit is 0.4 m/s"
    );
    assert_eq!(after([at(9.0, 0.0), at(7.9, 0.0)]), "readings.stamp_s: goes back by 1.100 s, from 9 to 7.9");
    assert!(after([at(9.0, 0.0), at(8.1, 0.0)]).starts_with("Some(Message"), "reordered on its way");
    assert!(after([at(9.0, 0.0), at(29.0, 5.0)]).starts_with("Some(Message"), "in 20 s it can go there");
    let pong = |stamp: f64| format!(r#"{{"type": "pong", "echo_s": 1, "stamp_s": {stamp}}}"#);
    assert!(after([pong(9.0), at(7.0, 0.0)]).starts_with("Some(Message"), "they waited in the adapter");
    assert_eq!(after([pong(9.0), pong(7.0)]), "pong.stamp_s: goes back by 2.000 s, from 9 to 7");
}

#[test]
fn nothing_counts_before_hello_and_other_versions_are_refused() {
    let mut reader = Reader::<FromVehicle>::new(FromSession::default());
    let mut last = |line: &str| match reader.read(format!("{line}\n").as_bytes()).pop() {
        Some(Heard::Malformed(misfit)) => misfit.to_string(),
        other => format!("{other:?}"),
    };
    assert_eq!(last(r#"{"type": "readings", "seq": 1, "stamp_s": 5}"#), "type: readings before hello");
    let hello = examples("From the vehicle")[0];
    let newer = hello.replace("\"protocol\": 1", "\"protocol\": 2");
    assert_eq!(last(&newer), "hello.protocol: version 2, but this console uses version 1");
    assert_eq!(last(r#"{"type": "pong", "echo_s": 1, "stamp_s": 5}"#), "type: pong before hello");
    assert!(reader.is_faulty(), "three in a row");
    reader.read(format!("{hello}\n").as_bytes());
    assert!(!reader.is_faulty());
}

#[test]
fn over_datagrams_an_introduction_with_its_session_is_a_repetition() {
    let hello =
        |session: &str| examples("From the vehicle")[0].replace(", \"session\": 1764322", session) + "\n";
    let [first, second] = [", \"session\": 1", ", \"session\": 2"].map(hello);
    let greetings = |mut reader: Reader<FromVehicle>, lines: [&str; 3]| {
        let heard = lines.map(|line| reader.read(line.as_bytes()));
        heard.map(|heard| heard.iter().filter(|heard| matches!(heard, Heard::Message(_))).count())
    };
    let datagrams = || Reader::<FromVehicle>::new(FromSession::of_datagrams());
    assert_eq!(greetings(datagrams(), [&first, &first, &second]), [1, 0, 1]);
    // On a stream, nothing is repeated: the vehicle has started again.
    assert_eq!(greetings(Reader::new(FromSession::default()), [&first, &first, &second]), [1, 1, 1]);
    let Some(Heard::Malformed(misfit)) = datagrams().read(hello("").as_bytes()).pop() else {
        panic!("a restart could not be told")
    };
    assert_eq!(misfit.field, "hello.session");
}

#[test]
fn what_is_unknown_is_told_once() {
    let mut reader = greeted();
    let line = br#"{"type": "pong", "echo_s": 1, "stamp_s": 5, "new": {"deep": [1]}}
{"type": "song", "text": "la"}
"#;
    let key = |key: &str| Heard::Unknown(Unknown::Key { kind: "pong", key: key.into() });
    let first = reader.read(line);
    assert_eq!(first.len(), 4, "{first:?}");
    assert_eq!([&first[0], &first[1]], [&key("deep"), &key("new")]);
    assert_eq!(first[3], Heard::Unknown(Unknown::Kind("song".into())));
    let again = reader.read(line);
    assert!(matches!(&again[..], [Heard::Message(FromVehicle::Pong(_))]), "{again:?}");
    assert_eq!((reader.counts().messages, reader.counts().unknown_kinds), (3, 2));
}

#[test]
fn a_line_without_an_end_is_malformed_at_the_end_of_the_stream() {
    let mut reader = greeted();
    reader.read(br#"{"type": "pong", "echo_s": 1"#);
    let Some(Heard::Malformed(misfit)) = reader.finish() else { panic!("it did not end") };
    assert_eq!(misfit.to_string(), "echo_s: the line ends here, without a line feed");
    assert_eq!(reader.finish(), None);
}

#[test]
fn an_endless_line_becomes_a_fault() {
    let mut reader = greeted();
    let chunk = vec![b'['; 64 * 1024];
    let mut n = 0;
    while !reader.is_faulty() {
        reader.read(&chunk);
        n += 1;
    }
    assert!(n * chunk.len() <= 4 * LINE_MAX);
}

#[test]
fn commands_must_fit_the_vehicle() {
    let mut writer = Writer::<ToVehicle>::new(to_session());
    let mut said = |drive: Drive| {
        let mut line = Vec::new();
        let written = writer.write(&ToVehicle::Drive(drive), &mut line);
        assert_eq!(written.is_err(), line.is_empty());
        written.map_or_else(|misfit| misfit.to_string(), |()| String::from_utf8(line).expect("UTF-8"))
    };
    let good = Drive {
        seq: 1,
        stamp_s: 2.0,
        lease_s: 0.25,
        forward_m_per_s: 0.4,
        sideways_m_per_s: 0.0,
        turn_rad_per_s: 0.0,
    };
    assert!(said(good).ends_with("}\n"));
    assert_eq!(
        said(Drive { forward_m_per_s: -0.5, ..good }),
        "drive.forward_m_per_s: -0.5 m/s exceeds the vehicle's limit of 0.4 m/s"
    );
    assert_eq!(
        said(Drive { turn_rad_per_s: f64::NAN, ..good }),
        "drive.turn_rad_per_s: NaN is not between -20 and 20"
    );
    assert_eq!(
        said(Drive { sideways_m_per_s: 0.1, ..good }),
        "drive.sideways_m_per_s: is not 0, but the vehicle cannot move sideways"
    );
    assert_eq!(
        said(Drive { lease_s: 2.0, ..good }),
        "drive.lease_s: 2 s, but the vehicle honours 0.5 s at most"
    );
}

#[test]
fn no_number_is_written_that_is_not_finite() {
    let mut session = Writer::<FromVehicle>::new(greeted().session().clone());
    let odometry = Odometry { over_s: 0.1, forward_m: f64::NAN, sideways_m: 0.0, turn_rad: 0.0 };
    let readings = Readings { odometry: Some(odometry), ..Readings::default() };
    let mut line = Vec::new();
    let misfit = session.write(&FromVehicle::Readings(Box::new(readings)), &mut line).expect_err("NaN");
    assert_eq!((misfit.field.as_str(), line.len()), ("readings.odometry.forward_m", 0));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn the_messages_are_the_same_in_any_division(cuts in prop::collection::vec(0..4000_usize, 0..40)) {
        let stream = stream();
        let whole = Reader::<FromVehicle>::new(FromSession::default()).read(&stream);
        let mut cuts: Vec<usize> = cuts.into_iter().map(|cut| cut.min(stream.len())).collect();
        cuts.extend([0, stream.len()]);
        cuts.sort_unstable();
        let mut reader = Reader::<FromVehicle>::new(FromSession::default());
        let parts: Vec<_> = cuts.windows(2).flat_map(|cut| reader.read(&stream[cut[0]..cut[1]])).collect();
        prop_assert_eq!(parts, whole);
    }

    #[test]
    fn damage_is_named_and_never_passes_a_number_that_is_not_finite(damage in mutations::mutations()) {
        let bytes = mutations::mutated(&stream(), &damage);
        let mut reader = Reader::<FromVehicle>::new(FromSession::default());
        let heard = reader.read(&bytes);
        for heard in heard.into_iter().chain(reader.finish()) {
            match heard {
                Heard::Message(message) => {
                    // NaN is not equal to itself, and an infinite number is written as null.
                    let line = serde_json::to_string(&message).expect("plain structs");
                    let value: serde_json::Value = serde_json::from_str(&line).expect("JSON");
                    let again = FromVehicle::parse(value["type"].as_str().expect("a kind"), &line);
                    prop_assert_eq!(again.expect("finite"), message);
                }
                Heard::Malformed(misfit) => prop_assert!(!misfit.what.is_empty()),
                Heard::Unknown(_) => {}
            }
        }
    }

    #[test]
    fn damaged_commands_keep_within_the_limits(damage in mutations::mutations()) {
        let stream: Vec<u8> =
            examples("To the vehicle").iter().flat_map(|line| [line.as_bytes(), b"\n"].concat()).collect();
        let mut reader = Reader::<ToVehicle>::new(to_session());
        for heard in reader.read(&mutations::mutated(&stream, &damage)) {
            if let Heard::Message(ToVehicle::Drive(drive)) = heard {
                prop_assert!(drive.forward_m_per_s.abs() <= 0.4 + 1e-9 && drive.turn_rad_per_s.abs() <= 1.0 + 1e-9);
                prop_assert!(drive.lease_s > 0.0 && drive.lease_s <= 0.5 && drive.stamp_s.is_finite());
            }
        }
    }
}
