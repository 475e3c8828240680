//! Trouble with a real vehicle that is named: another vehicle, faulty messages, a lost position, a console that was stopped.

use crate::{
    bench::{Bench, Ended, first_of, journal, of_kind, scenario},
    vehicle::{HELLO, Vehicle, begun, driven, liar, short},
};
use rustix::process::{Pid, Signal, kill_process};
use serde_json::Value;
use std::{
    io::{BufRead, BufReader},
    os::unix::net::UnixStream,
    thread,
    time::Duration,
};

/// Connects an unattended run to an adapter that sends prepared texts; the end of the run and its journal.
fn flown(lie: impl Fn(u64, u64) -> Vec<u8> + Send + 'static) -> (Ended, Vec<Value>) {
    let bench = Bench::new();
    let path = bench.path().join("liar");
    let liar = liar(&path, lie);
    let at = format!("unix:{}", path.display());
    let ended = bench.fly(&short(&bench), &["--vehicle", &at]);
    liar.join().unwrap();
    let run = bench.runs().pop().unwrap_or_else(|| panic!("{ended:?}"));
    bench.prove(&run);
    (ended, journal(&run))
}

/// The notices of a kind in a journal.
fn notices(events: &[Value], kind: &str) -> Vec<Value> {
    let all = of_kind(events, "noticed").into_iter();
    all.filter(|event| event["notice"] == *kind).cloned().collect()
}

#[test]
fn another_vehicle_on_the_same_connection_is_named_with_its_differences_and_not_driven() {
    let other = HELLO.replace("\"liar\"", "\"crawler-2\"").replace("\"radius_m\": 0.25", "\"radius_m\": 0.2");
    let lie = move |number, since| match since {
        5 => format!("{other}\n").into_bytes(),
        _ => driven(number, "0"),
    };
    let (ended, events) = flown(lie);
    let said = ended.json()["reason"].as_str().unwrap().to_owned();
    assert!(
        ended.code == Some(1) && said.contains("another vehicle answers on the same connection"),
        "{ended:?}"
    );
    let told = notices(&events, "other_vehicle");
    assert_eq!(told.len(), 1, "{told:?}");
    assert_eq!(told[0]["vehicle"]["name"], "crawler-2");
    let differs = told[0]["differs"].to_string();
    assert!(differs.contains("liar") && differs.contains("0.25"), "{differs}");
}

#[test]
fn faulty_messages_between_good_ones_are_counted_and_named_and_do_not_hold_the_robot() {
    let lie = |number: u64, _| {
        let bad: &[u8] =
            if number.is_multiple_of(2) { b"{\"type\": \"readings\", \"seq\": \"x\"}\n" } else { b"" };
        [bad, &driven(number, "0")].concat()
    };
    // The run ends because this vehicle never moves.
    let (ended, events) = flown(lie);
    let reason = ended.json()["reason"].as_str().unwrap().to_owned();
    assert!(reason.contains("standstill while the vehicle is driven"), "{reason}");
    let told = notices(&events, "faulty_messages");
    let last = told.last().unwrap_or_else(|| panic!("{ended:?}"));
    assert!(last["count"].as_u64().unwrap() > 1 && last["first"].to_string().contains("seq"), "{last}");
}

#[test]
fn an_unattended_run_without_a_position_says_until_when_it_waits() {
    let bench = Bench::new();
    let ended = bench.fly(&scenario("lost-and-found.toml"), &["--vehicle", "loopback"]);
    let events = journal(&bench.runs().pop().unwrap_or_else(|| panic!("{ended:?}")));
    let awaited = first_of(&events, "position_awaited").unwrap_or_else(|| panic!("{ended:?}"));
    let whole_s = events[awaited]["ends_t_s"].as_f64().unwrap() as u64;
    let ends = format!("T+{:02}:{:02}:{:02}", whole_s / 3600, whole_s / 60 % 60, whole_s % 60);
    assert!(ended.err.contains(&format!("the time limit ends the mission at {ends}")), "{}", ended.err);
    assert!(first_of(&events[awaited..], "resumed").is_some(), "the position comes back");
}

#[test]
fn a_console_that_was_stopped_says_so_and_sends_no_motion_when_it_continues() {
    let bench = Bench::new();
    let file = scenario("goto-single-obstacle.toml");
    let vehicle = Vehicle::offer(&bench, &file, &[]);
    let (child, run) = begun(&bench, &["run", file.to_str().unwrap(), "--vehicle", &vehicle.at]);
    let console = Pid::from_child(&child);
    kill_process(console, Signal::STOP).unwrap();
    // A second connection looks on.
    let onlooker = UnixStream::connect(bench.path().join("vehicle")).unwrap();
    let lines = BufReader::new(onlooker).lines().map_while(Result::ok);
    let mut messages = lines.map_while(|line| serde_json::from_str::<Value>(&line).ok());
    let moved_m = |message: &Value| message["odometry"]["forward_m"].as_f64();
    let mut still = 0;
    while still < 5 {
        still = moved_m(&messages.next().unwrap()).map_or(still, |m| if m == 0.0 { still + 1 } else { 0 });
    }
    // Longer than any pause of a console that runs.
    thread::sleep(Duration::from_secs(1));
    kill_process(console, Signal::CONT).unwrap();
    let ended = child.wait_with_output().unwrap();
    assert_eq!(ended.status.code(), Some(1), "{ended:?}");
    let stopped = of_kind(&journal(&run), "link").iter().any(|link| link["state"] == "console_stopped");
    assert!(stopped, "{ended:?}");
    bench.prove(&run);
    drop(vehicle);
    let moved: Vec<f64> = messages.filter_map(|message| moved_m(&message)).filter(|m| *m != 0.0).collect();
    assert!(moved.is_empty(), "{moved:?}: the vehicle moved when the console continued");
}
