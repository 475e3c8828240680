//! Real vehicles: the simulator behind the wire, and adapters that fail or lie.

use crate::{
    bench::{Bench, Ended, first_of, journal, journal_text, of_kind, scenario},
    looking_on::Console,
};
use flight::{Flight, answers::Answers};
use mission::{Answer, Ask, EventKind, Mission, event::RecordedAnswers};
use recording::Ticks;
use remote::Remote;
use rustix::process::{Pid, Signal, kill_process};
use serde_json::Value;
use std::{
    io::{BufRead, BufReader, Write},
    os::unix::net::{UnixListener, UnixStream},
    path::{Path, PathBuf},
    process::{Child, Stdio},
    sync::{
        Arc,
        atomic::{AtomicBool, AtomicU64, Ordering},
    },
    thread,
    time::{Duration, Instant},
};
use vehicle::port::{CannotInject, Command, Sensed, StationFault, Vehicle as Port, VehicleInfo};

/// Longest wait for something that must happen, on a machine of any speed.
const PATIENCE: Duration = Duration::from_mins(2);

pub(crate) const HELLO: &str = r#"{"type": "hello", "protocol": 1, "name": "liar", "motion": "unicycle", "limits": {"speed_m_per_s": 0.5, "turn_rad_per_s": 2.0, "acceleration_m_per_s2": 1.0, "radius_m": 0.25}, "has": {"odometry": true, "contact": true, "ae": true}, "period_s": 0.1, "stop_time_s": 0.5, "lease_max_s": 1.0}"#;

/// A simulator in a separate process.
pub(crate) struct Vehicle {
    process: Child,
    pub at: String,
}

impl Vehicle {
    pub(crate) fn offer(bench: &Bench, scenario: &Path, more: &[&str]) -> Self {
        let at = format!("unix:{}", bench.path().join("vehicle").display());
        let mut command = bench.command();
        command.args(["vehicle", "simulate"]).arg(scenario).args(["--listen", &at]).args(more);
        let mut process = command.stdout(Stdio::piped()).spawn().unwrap();
        let mut line = String::new();
        BufReader::new(process.stdout.take().unwrap()).read_line(&mut line).unwrap();
        assert!(line.contains("listens on"), "{line}");
        Self { process, at }
    }

    fn signal(&self, signal: Signal) {
        kill_process(Pid::from_child(&self.process), signal).unwrap();
    }
}

impl Drop for Vehicle {
    fn drop(&mut self) {
        // The process may already have ended.
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

/// The lines of a journal that do not depend on whether the robot is simulated inside the console.
fn decisions(run: &Path) -> Vec<Value> {
    let of_the_robot = ["truth", "tether_truth", "sensed", "link", "sent", "stood", "position_awaited"];
    let mut events = journal(run);
    events.retain(|event| !of_the_robot.iter().any(|kind| event["event"] == *kind));
    events[0].as_object_mut().unwrap().remove("vehicle");
    events[0]["mission"].as_object_mut().unwrap().remove("live");
    events
}

/// A mission of a few seconds.
pub(crate) fn short(bench: &Bench) -> PathBuf {
    let text = std::fs::read_to_string(scenario("goto-single-obstacle.toml")).unwrap();
    bench.file("short.toml", text.replace("goal_m = [3.5, 0.0]", "goal_m = [-2.5, 0.3]"))
}

fn fly(bench: &Bench, scenario: &Path, vehicle: &str) -> (Ended, PathBuf) {
    let flown = bench.fly(scenario, &["--vehicle", vehicle]);
    let run = bench.runs().pop().unwrap_or_else(|| panic!("{flown:?}"));
    (flown, run)
}

pub(crate) fn begun(bench: &Bench, arguments: &[&str]) -> (Child, PathBuf) {
    let mut command = bench.command();
    let child = command.args(arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let moves = |run: &PathBuf| of_kind(&journal(run), "sent").iter().any(|sent| !sent["drive"].is_null());
    until("the robot moves", || {
        bench.runs().last().is_some_and(|run| run.join("events.jsonl.zst").exists() && moves(run))
    });
    let run = bench.runs().pop().unwrap();
    (child, run)
}

fn until(what: &str, mut is_so: impl FnMut() -> bool) {
    let began = Instant::now();
    while !is_so() {
        assert!(began.elapsed() < PATIENCE, "never: {what}");
        thread::sleep(Duration::from_millis(20));
    }
}

#[test]
fn a_mission_behind_the_wire_decides_as_inside_and_its_journal_is_proven_without_the_vehicle() {
    for name in ["corridor", "crossing-carts", "moving-obstacles", "lost-and-found", "tether-out-and-back"] {
        let bench = Bench::new();
        let file = scenario(&format!("{name}.toml"));
        let inside = bench.fly(&file, &[]);
        let run_inside = bench.runs().remove(0);
        let (behind, run) = fly(&bench, &file, "loopback");
        assert_eq!((inside.code, behind.code), (Some(0), Some(0)), "{name}: {behind:?}");
        let (inside, behind) = (decisions(&run_inside), decisions(&run));
        let difference = inside.iter().zip(&behind).find(|(one, other)| one != other);
        assert!(difference.is_none() && inside.len() == behind.len(), "{name}: {difference:#?}");
        bench.prove(&run);
        let (_, again) = fly(&bench, &file, "loopback");
        assert_eq!(journal_text(&run), journal_text(&again), "{name}");
    }
}

#[test]
fn a_live_run_has_no_figure_that_needs_the_truth_and_its_reports_say_live() {
    let bench = Bench::new();
    let (flown, run) = fly(&bench, &short(&bench), "loopback");
    let report = flown.json();
    for absent in ["path_length_m", "collisions", "clearance_min_m", "positioning"] {
        assert_eq!(report[absent], Value::Null, "{absent}");
    }
    assert_eq!(report["violations"], serde_json::json!([]), "{report}");
    assert_eq!(report["vehicle"]["name"], "simulator of goto-single-obstacle");
    let name = run.to_str().unwrap();
    let text = bench.tankops(&["report", name]);
    assert!(text.out.starts_with("LIVE: simulator of goto-single-obstacle"), "{text:?}");
    assert!(text.out.contains("no figures that need the true position"), "{text:?}");
    let page = bench.tankops(&["report", name, "-o", "report.html"]);
    let html =
        std::fs::read_to_string(bench.path().join("report.html")).unwrap_or_else(|_| panic!("{page:?}"));
    assert!(html.contains("<b>LIVE</b>") && !html.contains("SIMULATION"));
    for (what, file) in [("--rrd", "again.rrd"), ("--mcap", "run.mcap"), ("--ranges", "readings.csv")] {
        let exported = bench.tankops(&["export", name, what, file]);
        assert_eq!(exported.code, Some(0), "{exported:?}");
    }
    let readings = std::fs::read_to_string(bench.path().join("readings.csv")).unwrap();
    assert!(readings.lines().nth(1).is_some_and(|line| line.ends_with(",,,")), "no true positions");
    assert!(readings.lines().filter(|line| line.contains(",A,")).count() > 20, "ranges of station A");
}

/// A vehicle behind a socket. Each tick waits for its readings, so that every tick has its own readings even on a slow
/// machine.
struct Patient {
    remote: Remote,
    ticks: u64,
}

impl Port for Patient {
    fn sense(&mut self) -> Sensed {
        self.ticks += 1;
        until("the readings of the tick arrive", || self.remote.heard() >= self.ticks);
        self.remote.sense()
    }

    fn act(&mut self, command: Command) {
        self.remote.act(command);
    }

    fn truth(&self) -> Option<world::Truth> {
        None
    }

    fn inject(&mut self, fault: StationFault) -> Result<(), CannotInject> {
        self.remote.inject(fault)
    }
}

/// The planners' answers of a recorded run.
struct Recorded(RecordedAnswers);

impl Answers for Recorded {
    fn submit(&mut self, ask: Ask) {
        self.0.submit(&ask);
    }

    fn next(&mut self, _: &Mission) -> Option<Answer> {
        self.0.next_answer().map(|(answer, _)| answer)
    }
}

#[test]
fn over_a_socket_the_mission_decides_as_inside() {
    let bench = Bench::new();
    let file = short(&bench);
    assert_eq!(bench.fly(&file, &[]).code, Some(0));
    let inside = bench.runs().remove(0);
    let scenario = flight::scenarios::read(&file, &scenario::Settings::default()).unwrap();
    let vehicle = Vehicle::offer(&bench, &file, &["--lockstep"]);
    let at = vehicle.at.parse().unwrap();
    let (remote, _) = Remote::connect(&at, false, &scenario.sim.world.stations).unwrap();
    let patient = Box::new(Patient { remote, ticks: 0 });
    let flight = Flight::prepare(&scenario, false);
    let mut flight = flight.with_vehicle(&scenario, patient, VehicleInfo::default());
    let mut answers = Recorded(RecordedAnswers::default());
    let mut ticks = Ticks::open(&recording::journal_of(&inside)).unwrap();
    let decided = |kind: &EventKind| {
        !matches!(
            kind,
            EventKind::RunOpened(_)
                | EventKind::Truth { .. }
                | EventKind::Sensed { .. }
                | EventKind::Link(_)
                | EventKind::Sent { .. }
                | EventKind::Stood { .. }
        )
    };
    while let Some(recorded) = ticks.next_tick().unwrap() {
        answers.0.begin_tick(recorded.events());
        let events = flight.tick(&recorded.orders(), &mut answers);
        let ours: Vec<&EventKind> =
            events.iter().map(|event| &event.kind).filter(|kind| decided(kind)).collect();
        let theirs: Vec<&EventKind> = recorded.events().filter(|kind| decided(kind)).collect();
        assert_eq!(ours, theirs, "tick {}", recorded.tick);
    }
    assert!(matches!(flight.phase(), mission::Phase::Ended(_)));
}

#[test]
fn an_adapter_that_ends_or_hangs_ends_an_unattended_run_which_is_kept_and_says_why() {
    let cases = [
        (Signal::KILL, "closed", "the link to the vehicle is closed"),
        (Signal::STOP, "lost", "the link to the vehicle is lost"),
    ];
    for (signal, state, why) in cases {
        let bench = Bench::new();
        let vehicle = Vehicle::offer(&bench, &scenario("goto-single-obstacle.toml"), &[]);
        let file = scenario("goto-single-obstacle.toml");
        let (child, run) = begun(&bench, &["run", file.to_str().unwrap(), "--vehicle", &vehicle.at]);
        vehicle.signal(signal);
        let ended = Ended::from(child.wait_with_output().unwrap());
        assert!(ended.code == Some(1) && ended.out.contains(why), "{ended:?}");
        let events = journal(&run);
        let lost =
            events.iter().position(|event| event["event"] == "link" && event["state"] == state).unwrap();
        let held = first_of(&events, "held").unwrap();
        assert!(
            lost < held
                && events[held]["by"]["vehicle"]["message"].as_str().unwrap().contains("cannot confirm")
        );
        assert!(
            of_kind(&events[held..], "sent").iter().all(|sent| sent["drive"].is_null()),
            "nothing moves again"
        );
        bench.prove(&run);
    }
}

#[test]
fn a_vehicle_stands_by_its_lease_when_its_console_hangs() {
    let bench = Bench::new();
    let file = scenario("goto-single-obstacle.toml");
    let vehicle = Vehicle::offer(&bench, &file, &[]);
    let (mut child, _) = begun(&bench, &["run", file.to_str().unwrap(), "--vehicle", &vehicle.at]);
    kill_process(Pid::from_child(&child), Signal::STOP).unwrap();
    // A second console looks on.
    let onlooker = UnixStream::connect(bench.path().join("vehicle")).unwrap();
    let mut messages =
        BufReader::new(onlooker).lines().map(|line| serde_json::from_str::<Value>(&line.unwrap()).unwrap());
    let mut still = 0;
    let mut is_other = false;
    while still < 5 || !is_other {
        let message = messages.next().unwrap();
        is_other |= message["commander"] == "other_console";
        if message["type"] == "readings" {
            let moved_m = message["odometry"]["forward_m"].as_f64().unwrap();
            still = if moved_m == 0.0 { still + 1 } else { 0 };
        }
    }
    child.kill().unwrap();
    child.wait().unwrap();
}

/// The refusal of an order while the link is down.
const CANNOT_DRIVE: &str = "the vehicle cannot be driven";

#[test]
fn after_a_lost_link_only_an_order_moves_the_robot_again() {
    let bench = Bench::new();
    let file = scenario("goto-single-obstacle.toml");
    let vehicle = Vehicle::offer(&bench, &file, &[]);
    let mut console = Console::open(bench.command(), &[file.to_str().unwrap(), "--vehicle", &vehicle.at]);
    console.hear("Enter `start` to start");
    console.order("speed 4\n");
    console.hear("a real vehicle runs in real time");
    console.order_until("start\nyes\n", "Mission running", CANNOT_DRIVE);
    let run = bench.runs().remove(0);
    let drives = || of_kind(&journal(&run), "sent").iter().filter(|sent| !sent["drive"].is_null()).count();
    until("the robot drives", || drives() > 0);
    vehicle.signal(Signal::STOP);
    console.hear("the link to the vehicle is lost");
    console.order("resume\n");
    console.hear(CANNOT_DRIVE);
    vehicle.signal(Signal::CONT);
    console.hear_all(&["link up", "stopped, confirmed by odometry"]);
    let before = drives();
    console.order_until("resume\nyes\n", "resumed", CANNOT_DRIVE);
    until("the robot drives again", || drives() > before);
    console.order("hold\n");
    console.hear("HELD");
    console.order("end\nyes\n");
    console.hear("Screen 7: Result.");
    assert_eq!(console.leave(), Some(1), "an aborted mission");
    let events = journal(&run);
    let held = first_of(&events, "held").unwrap();
    let resumed = first_of(&events, "resumed").unwrap();
    assert!(of_kind(&events[held..resumed], "sent").iter().all(|sent| sent["drive"].is_null()));
    assert!(of_kind(&events[resumed..], "sent").iter().any(|sent| !sent["drive"].is_null()));
    bench.prove(&run);
}

/// The answer to a command of the console: for a ping, a pong with the stamp of the readings with this number; for any
/// other command, an empty text.
fn answer(command: &Value, number: u64) -> String {
    let stamp_s = 0.1 * number as f64;
    let ready = format!("{{\"type\": \"state\", \"stamp_s\": {stamp_s:.1}, \"mode\": \"ready\"}}");
    let echo_s = command["stamp_s"].as_f64().filter(|_| command["type"] == "ping");
    let pong = |echo_s| {
        format!("{{\"type\": \"pong\", \"echo_s\": {echo_s}, \"stamp_s\": {stamp_s:.1}}}\n{ready}\n")
    };
    echo_s.map_or_else(String::new, pong)
}

/// An adapter that answers pings and, after its introduction, sends prepared texts until the console leaves. A text may
/// depend on its number, and on the number of texts since the first `drive`, which is 0 before that `drive`. Ten
/// numbers pass in a second.
pub(crate) fn liar(
    path: &Path,
    lie: impl Fn(u64, u64) -> Vec<u8> + Send + 'static,
) -> thread::JoinHandle<()> {
    let listener = UnixListener::bind(path).unwrap();
    thread::spawn(move || {
        let (mut stream, _) = listener.accept().unwrap();
        let heard = BufReader::new(stream.try_clone().unwrap());
        let (said, answered) = std::sync::mpsc::channel();
        thread::spawn(move || {
            for line in heard.lines().map_while(Result::ok) {
                let Ok(()) = said.send(serde_json::from_str::<Value>(&line).unwrap()) else { return };
            }
        });
        stream.write_all(format!("{HELLO}\n").as_bytes()).unwrap();
        let (began, mut since, mut number) = (Instant::now(), 0, 0);
        loop {
            // Stamps keep pace with the time, however slow the machine is: the number skips what it was too late for.
            number = (number + 1).max((began.elapsed().as_secs_f64() / 0.1) as u64);
            thread::sleep((Duration::from_millis(100) * number as u32).saturating_sub(began.elapsed()));
            let commands: Vec<Value> = answered.try_iter().collect();
            since += u64::from(since > 0 || commands.iter().any(|command| command["type"] == "drive"));
            let answers: String = commands.iter().map(|command| answer(command, number)).collect();
            let said = stream.write_all(answers.as_bytes());
            if said.and_then(|()| stream.write_all(&lie(number, since))).is_err() {
                return;
            }
        }
    })
}

/// Readings of a vehicle that moves by this distance between two of them.
pub(crate) fn driven(number: u64, forward_m: &str) -> Vec<u8> {
    readings(number, &format!(r#""odometry": {{"over_s": 0.1, "forward_m": {forward_m}, "turn_rad": 0}}"#))
}

#[test]
fn the_floor_that_a_live_run_missed_is_scanned_by_the_vehicle() {
    let bench = Bench::new();
    let scan = |file: &Path| {
        let vehicle = Vehicle::offer(&bench, file, &[]);
        let flown = bench.fly(file, &["--vehicle", &vehicle.at, "--set", "mission.time_limit_s=2"]);
        let run = bench.runs().pop().unwrap_or_else(|| panic!("{flown:?}"));
        bench.prove(&run);
        (run, vehicle.at.clone())
    };
    let (first, at) = scan(&scenario("cover-rooms.toml"));
    let made = bench.tankops(&["rescan", first.to_str().unwrap(), "-o", "again.toml"]);
    let advice = format!("again.toml --vehicle {at}`");
    assert!(made.out.contains("place the vehicle at the start") && made.out.contains(&advice), "{made:?}");
    let (second, _) = scan(&bench.path().join("again.toml"));
    assert!(first != second && of_kind(&journal(&second), "sensed").len() > 1);
}

/// Connects a run to an adapter that sends prepared texts after its introduction, and waits for the end of the run.
fn lied_to(lie: impl Fn(u64, u64) -> Vec<u8> + Send + 'static) -> Ended {
    let bench = Bench::new();
    let path = bench.path().join("liar");
    let liar = liar(&path, lie);
    let ended = bench.fly(&short(&bench), &["--vehicle", &format!("unix:{}", path.display())]);
    liar.join().unwrap();
    if let Some(run) = bench.runs().pop() {
        bench.prove(&run);
    }
    ended
}

fn readings(number: u64, more: &str) -> Vec<u8> {
    let stamp_s = 0.1 * number as f64;
    format!("{{\"type\": \"readings\", \"seq\": {number}, \"stamp_s\": {stamp_s:.1}, {more}}}\n").into_bytes()
}

#[test]
fn what_a_lying_adapter_says_is_named_with_its_field_and_holds_the_robot() {
    let nan = lied_to(|number, since| driven(number, if since < 5 { "0" } else { "NaN" }));
    let jump = lied_to(|number, since| driven(number, if since < 5 { "0" } else { "5" }));
    let half = lied_to(|number, _| {
        if number < 20 {
            readings(number, r#""contact": false"#)
        } else {
            b"{\"type\": \"readings\", \"seq\n".to_vec()
        }
    });
    let restarted = lied_to(|number, since| match since {
        // After the restart, the vehicle continues at once, with numbers above the earlier ones.
        5 => format!("{HELLO}\n").into_bytes(),
        _ => driven(number, "0"),
    });
    let long = lied_to(|_, _| vec![b'x'; 1 << 20]);
    let stopped = lied_to(|number, since| {
        let stop = r#"{"type": "state", "stamp_s": 2.0, "mode": "emergency_stop", "battery": 87}"#;
        let more = if since < 5 { String::new() } else { format!("{stop}\n") };
        [driven(number, "0"), more.into_bytes()].concat()
    });
    let driven_off = lied_to(|number, _| driven(number, "0.02"));
    let cases = [
        (nan, "readings.odometry.forward_m: NaN is not a finite number"),
        (jump, "readings.odometry.forward_m: 5 m in 0.1 s"),
        (half, "3 malformed lines without good readings in between; readings"),
        (restarted, "the vehicle has restarted"),
        (long, "the line is longer than"),
        (stopped, "the emergency stop of the vehicle is pressed"),
        (driven_off, "odometry does not show that it stands still"),
    ];
    for (ended, why) in cases {
        // If a mission could not start, the reason is on stderr.
        let said = format!("{}\n{}", ended.json()["reason"].as_str().unwrap(), ended.err);
        assert!(ended.code == Some(1) && said.contains(why), "{why}: {ended:?}");
    }
}

#[test]
fn a_vehicle_that_speaks_only_after_a_command_is_not_driven_before_its_first_readings() {
    let bench = Bench::new();
    let path = bench.path().join("shy");
    let listener = UnixListener::bind(&path).unwrap();
    let shy = thread::spawn(move || {
        let (mut stream, _) = listener.accept().unwrap();
        let lines = BufReader::new(stream.try_clone().unwrap()).lines();
        stream.write_all(format!("{HELLO}\n").as_bytes()).unwrap();
        let still = r#""odometry": {"over_s": 0.1, "forward_m": 0, "turn_rad": 0}"#;
        let (mut before, mut number) = (Vec::new(), 0);
        for line in lines {
            let command: Value = serde_json::from_str(&line.unwrap()).unwrap();
            match command["type"].as_str().unwrap() {
                "ping" => stream.write_all(answer(&command, number).as_bytes()).unwrap(),
                "drive" if number > 0 => break,
                kind => {
                    before.extend((number == 0).then(|| kind.to_owned()));
                    number += u64::from(before.len() >= 5);
                    stream
                        .write_all(&(1..=number).next_back().map_or(Vec::new(), |n| readings(n, still)))
                        .unwrap();
                }
            }
        }
        before
    });
    let ended = bench.fly(&short(&bench), &["--vehicle", &format!("unix:{}", path.display())]);
    assert_eq!(shy.join().unwrap(), ["stop"; 5], "{ended:?}");
    let run = bench.runs().pop().unwrap();
    assert!(
        ended.json()["reason"].as_str().unwrap().contains("the link to the vehicle is closed"),
        "{ended:?}"
    );
    bench.prove(&run);
}

#[test]
fn a_vehicle_that_drives_off_before_the_start_raises_an_alarm_and_is_not_started() {
    let bench = Bench::new();
    let path = bench.path().join("liar");
    let drives = Arc::new(AtomicBool::default());
    let (is_driven, moved) = (drives.clone(), AtomicU64::default());
    let liar = liar(&path, move |number, _| {
        // Once the vehicle has begun to move, it drives more than a metre.
        let before = moved.load(Ordering::Acquire);
        let moves = is_driven.load(Ordering::Acquire) || (1..60).contains(&before);
        moved.fetch_add(u64::from(moves), Ordering::AcqRel);
        driven(number, if moves { "0.02" } else { "0" })
    });
    let address = format!("unix:{}", path.display());
    let mut console =
        Console::open(bench.command(), &[short(&bench).to_str().unwrap(), "--vehicle", &address]);
    console.hear("stopped, confirmed by odometry");
    console.hear("Enter `start` to start");
    drives.store(true, Ordering::Release);
    console.hear("vehicle is moving without an order");
    console.order_until("start\n", "moving without an order; stop it by hand", CANNOT_DRIVE);
    drives.store(false, Ordering::Release);
    console.hear("stopped, confirmed by odometry");
    console.order_until("start\n", "plan again from here", CANNOT_DRIVE);
    assert_eq!(console.leave(), Some(0));
    assert!(bench.runs().is_empty(), "nothing was started");
    liar.join().unwrap();
}

#[test]
fn a_malformed_hello_is_named_by_its_own_fault() {
    let bench = Bench::new();
    let path = bench.path().join("liar");
    let listener = UnixListener::bind(&path).unwrap();
    let liar = thread::spawn(move || {
        let (mut stream, _) = listener.accept().unwrap();
        let hello = HELLO.replace("\"speed_m_per_s\": 0.5", "\"speed_m_per_s\": 1e300");
        let still = r#""odometry": {"over_s": 0.1, "forward_m": 0, "turn_rad": 0}"#;
        stream.write_all(format!("{hello}\n").as_bytes()).unwrap();
        let mut number = 1;
        while stream.write_all(&readings(number, still)).is_ok() {
            thread::sleep(Duration::from_millis(20));
            number += 1;
        }
    });
    let refused = bench.fly(&short(&bench), &["--vehicle", &format!("unix:{}", path.display())]);
    let why = "its introduction is malformed: hello.limits.speed_m_per_s: 1e300 is out of range";
    assert!(refused.code == Some(2) && refused.err.contains(why), "{refused:?}");
    liar.join().unwrap();
}

#[test]
fn a_run_waits_for_the_confirmed_stop_and_its_last_figures() {
    let bench = Bench::new();
    let file = short(&bench);
    let vehicle = Vehicle::offer(&bench, &file, &[]);
    let (flown, run) = fly(&bench, &file, &vehicle.at);
    let report = flown.json();
    assert_eq!(report["vehicle"]["stands"], true, "{flown:?}");
    assert!(report["vehicle"]["heard"].as_u64().unwrap() > 10, "{flown:?}");
    bench.prove(&run);
    // This vehicle ignores all commands and continues to move.
    let deaf = lied_to(|number, since| driven(number, if since < 5 { "0" } else { "0.02" }));
    assert!(deaf.code == Some(1) && deaf.json()["vehicle"]["stands"] == false, "{deaf:?}");
}

#[test]
fn ten_thousand_lines_a_second_leave_the_memory_flat() {
    let bench = Bench::new();
    let path = bench.path().join("liar");
    let listener = UnixListener::bind(&path).unwrap();
    let (begin, until_told) = std::sync::mpsc::channel();
    let liar = thread::spawn(move || {
        let (mut stream, _) = listener.accept().unwrap();
        let mut drain = stream.try_clone().unwrap();
        thread::spawn(move || std::io::copy(&mut drain, &mut std::io::sink()));
        stream.write_all(format!("{HELLO}\n").as_bytes()).unwrap();
        let () = until_told.recv().unwrap();
        let still = r#""odometry": {"over_s": 0.1, "forward_m": 0, "turn_rad": 0}"#;
        (0..300_u64).all(|block| {
            let lines: Vec<u8> = (1..=1000).flat_map(|line| readings(1000 * block + line, still)).collect();
            stream.write_all(&lines).is_ok()
        })
    });
    let address = format!("unix:{}", path.display());
    let console = Console::open(bench.command(), &[short(&bench).to_str().unwrap(), "--vehicle", &address]);
    // The vehicle has not sent odometry yet.
    console.hear("Start blocked: standstill.");
    let memory_kb = || -> u64 {
        let status = std::fs::read_to_string(format!("/proc/{}/status", console.pid())).unwrap();
        let line = status.lines().find(|line| line.starts_with("VmRSS:")).unwrap();
        line.split_whitespace().nth(1).unwrap().parse().unwrap()
    };
    // Threads and planners that are still starting do not count as growth.
    let (mut before_kb, mut still) = (0, 0);
    until("the memory is at rest", || {
        thread::sleep(Duration::from_millis(500));
        let last_kb = std::mem::replace(&mut before_kb, memory_kb());
        still = if before_kb.abs_diff(last_kb) < 500 { still + 1 } else { 0 };
        still == 6
    });
    begin.send(()).unwrap();
    assert!(liar.join().unwrap(), "300,000 lines were taken");
    let grown_kb = memory_kb().saturating_sub(before_kb);
    assert!(grown_kb < 20_000, "{grown_kb} kB more after 40 MB of lines");
    assert_eq!(console.leave(), Some(0));
}

#[test]
fn a_vehicle_that_does_not_fit_is_refused_with_every_reason() {
    let bench = Bench::new();
    let file = scenario("goto-single-obstacle.toml");
    let slow =
        std::fs::read_to_string(&file).unwrap().replace("speed_max_m_per_s = 0.4", "speed_max_m_per_s = 0.2");
    let slow = bench.file("slow.toml", slow);
    let vehicle = Vehicle::offer(&bench, &slow, &[]);
    let refused = bench.fly(&file, &["--vehicle", &vehicle.at, "--set", "vehicle.stop_max_s=0.1"]);
    assert!(refused.code == Some(2) && bench.runs().is_empty(), "{refused:?}");
    for why in [
        "does not fit scenario",
        "the vehicle's limit is 0.2",
        "`robot.speed_max_m_per_s`",
        "`vehicle.stop_max_s`",
    ] {
        assert!(refused.err.contains(why), "{why}: {refused:?}");
    }
    for (vehicle, why) in [
        (&["--vehicle"][..], "`vehicle.at`"),
        (&["--vehicle", "serial:1"], "is not a vehicle address"),
        (&["--vehicle", "tcp:192.0.2.1:9"], "`--vehicle-network` allows this"),
        (&["--vehicle", "unix:nowhere"], "cannot drive the vehicle at unix:nowhere"),
        (&["--vehicle", "run:true"], "it did not introduce the vehicle"),
    ] {
        let refused = bench.fly(&file, vehicle);
        assert!(refused.code == Some(2) && refused.err.contains(why), "{why}: {refused:?}");
    }
}
