//! Scans that are spoiled on the wire: each is named before the start, and holds the robot under way.

use super::*;
use flight::answers::Answers;
use mission::{
    Answer, Ask, Event, EventKind, Given, Mission, Order, Phase, PlannerInfo, Said, What, phase::HoldReason,
};
use planner_api::{Command as Wanted, Plan};
use serde_json::{Value, json};
use std::{
    collections::VecDeque,
    f64::consts::TAU,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
};

/// Number of ticks within which a fault must be named: the guard waits for 0.5 s, and the comparison with the drawing
/// for a few scans.
const NAMED_WITHIN: usize = 60;
const RAYS: usize = 360;

const TANK: &str = r#"
name = "spoiled"
[tank]
radius_m = 5.0
[robot]
radius_m = 0.25
speed_max_m_per_s = 0.4
start_m = [-3.5, -0.8]
start_heading_deg = 0.0
[robot.scanner]
[mission]
kind = "goto"
goal_m = [3.0, -0.8]
time_limit_s = 120.0
[planner]
id = "ahead"
[ae]
stations = [
    { name = "A", at_m = [5.0, 0.0] },
    { name = "B", at_m = [0.0, 5.0] },
    { name = "C", at_m = [-5.0, 0.0] },
    { name = "D", at_m = [0.0, -5.0] },
]
[[obstacles]]
name = "column"
kind = "circle"
center_m = [-1.5, 1.4]
radius_m = 0.3
"#;

/// A survey of the same tank. The robot starts in the middle, and only the wall is drawn: no drawing can show that the
/// scans are mirrored or rotated.
fn survey() -> String {
    let (tank, _) = TANK.split_once("[[obstacles]]").expect("a column");
    let tank = tank
        .replace("start_m = [-3.5, -0.8]", "start_m = [0.0, 0.0]")
        .replace("[planner]\nid = \"ahead\"\n", "")
        .replace(
            "kind = \"goto\"\ngoal_m = [3.0, -0.8]\ntime_limit_s = 120.0",
            "kind = \"survey\"\ntime_limit_s = 600.0",
        );
    let columns = [(1.9, 1.3), (-2.4, 1.9), (0.6, -2.7), (-2.9, -1.6)];
    let column = |(x, y): (f64, f64)| {
        format!("[[obstacles]]\nkind = \"circle\"\ncenter_m = [{x}, {y}]\nradius_m = 0.25\nknown = false\n")
    };
    columns.into_iter().map(column).fold(tank, |text, column| text + &column)
}

/// What happens to the lines of the readings.
type Spoil = fn(&mut Value);

/// The loopback, with a fault on its wire that can be switched on.
struct Spoiled {
    inner: Loopback,
    spoil: Spoil,
    is_on: Arc<AtomicBool>,
}

impl Spoiled {
    /// Spoils a line that is about to be heard. Python's `json` writes numbers that JSON does not have as here.
    fn spoiled(&self, line: &[u8]) -> Vec<u8> {
        let mut message: Value = serde_json::from_slice(line).expect("a message");
        if !self.is_on.load(Ordering::Relaxed) || message["scan"].is_null() {
            return line.to_vec();
        }
        (self.spoil)(&mut message);
        let text = message.to_string();
        let words = [("\"NaN\"", "NaN"), ("\"Infinity\"", "Infinity"), ("\"-Infinity\"", "-Infinity")];
        let text = words.iter().fold(text, |text, (quoted, bare)| text.replace(quoted, bare));
        [text.as_bytes(), b"\n"].concat()
    }
}

impl Vehicle for Spoiled {
    fn sense(&mut self) -> Sensed {
        self.inner.sense()
    }

    fn act(&mut self, command: Command) {
        let lines = self.inner.answered(command).expect("a command that fits the vehicle");
        for line in lines {
            self.inner.take(&self.spoiled(&line));
        }
    }

    fn truth(&self) -> Option<Truth> {
        None
    }

    fn inject(&mut self, _: StationFault) -> Result<(), CannotInject> {
        Err(CannotInject)
    }
}

/// A planner that drives straight ahead.
#[derive(Default)]
struct Ahead(VecDeque<Ask>);

impl Answers for Ahead {
    fn submit(&mut self, ask: Ask) {
        self.0.push_back(ask);
    }

    fn next(&mut self, _: &Mission) -> Option<Answer> {
        // Closing a planner has no answer.
        self.0.retain(|ask| !matches!(ask.what, What::Close));
        let Ask { id, what } = self.0.pop_front()?;
        let given = match what {
            What::Open { choice, .. } => {
                let info = json!({
                    "id": choice.id, "name": "", "version": "1.0", "about": "", "plugin": "", "sha256": "", "abi": "",
                    "parameters": [],
                });
                let info: PlannerInfo = serde_json::from_value(info).expect("a planner");
                Given::Opened(Box::new(info))
            }
            What::Reconfigure(_) => Given::Reconfigured,
            What::Plan(ask) => {
                let from = ask.start.position;
                let path = vec![from, from + geometry::Vector::new(6.0, 0.0)];
                Given::Plan(Plan { path, ..Plan::default() })
            }
            What::Step(_) => Given::Command(Wanted::twist(0.3, 0.0)),
            What::Snapshot => Given::State { bytes: 0 },
            What::Close => return None,
        };
        Some(Answer { ask: id, result: Ok(given), said: Said::default() })
    }
}

/// A flight over a wire on which the readings can be spoiled, and its switch.
fn flight(spoil: Spoil) -> (Flight, Arc<AtomicBool>) {
    flight_of(TANK, spoil)
}

fn flight_of(text: &str, spoil: Spoil) -> (Flight, Arc<AtomicBool>) {
    let scenario = Scenario::parse(text, "spoiled").unwrap_or_else(|errors| panic!("{}", errors.render()));
    let (inner, info) = Loopback::of(&scenario).expect("a vehicle that fits the protocol");
    let is_on = Arc::new(AtomicBool::default());
    let info = VehicleInfo { has: vec!["odometry".into(), "scan".into()], ..info };
    let vehicle = Spoiled { inner, spoil, is_on: Arc::clone(&is_on) };
    (Flight::prepare(&scenario, true).with_vehicle(&scenario, Box::new(vehicle), info), is_on)
}

/// What the events say about the scans and the link.
fn named(events: &[Event]) -> Vec<String> {
    let text = |event: &Event| match &event.kind {
        EventKind::ScannerJudged { trouble: Some(why) } => Some(why.clone()),
        EventKind::Link(seen) => Some(seen.why.clone()),
        _ => None,
    };
    events.iter().filter_map(text).collect()
}

fn ranges(message: &mut Value) -> &mut Vec<Value> {
    message["scan"]["ranges_m"].as_array_mut().expect("distances")
}

/// Every kind of spoiled scan, and what names it.
const KINDS: [(Spoil, &str); 15] = [
    (|message| ranges(message).clear(), "readings.scan.ranges_m: is empty"),
    (
        |message| ranges(message).fill(Value::Null),
        "of the rays that must hit the wall or a column have an echo",
    ),
    (|message| ranges(message).fill("NaN".into()), "readings.scan.ranges_m[0]: NaN is not a finite number"),
    (|message| ranges(message).fill(json!(0.0)), "all distances of the scan are 0"),
    (|message| ranges(message).truncate(200), "the scan has 200 rays instead of 360"),
    (|message| ranges(message).truncate(7), "readings.scan.ranges_m: 7 rays, but the first scan had 360"),
    (|message| ranges(message).reverse(), "only if it is mirrored"),
    (|message| ranges(message).rotate_left(RAYS / 2), "only if it is rotated by half a turn"),
    (|message| message["scan"] = Value::Null, "so the guard is blind"),
    (|message| ranges(message)[41] = "NaN".into(), "readings.scan.ranges_m[41]: NaN is not a finite number"),
    (|message| ranges(message)[5] = "Infinity".into(), "readings.scan.ranges_m[5]: Infinity is not"),
    (|message| ranges(message)[5] = json!(-1.5), "readings.scan.ranges_m[5]: -1.5 is not between 0 and 8"),
    (|message| ranges(message)[9] = json!(99.0), "readings.scan.ranges_m[9]: 99 is not between 0 and 8"),
    (|message| ranges(message).resize(5000, json!(1.0)), "readings.scan.ranges_m"),
    (|message| message["scan"]["step_rad"] = json!(TAU * 2.0), "readings.scan.step_rad: 12.5"),
];

#[test]
fn every_kind_of_spoiled_scan_is_named_before_the_start() {
    for (spoil, why) in KINDS {
        let (mut flight, is_on) = flight(spoil);
        let mut planner = Ahead::default();
        let good: Vec<Event> = (0..20).flat_map(|_| flight.tick(&[], &mut planner)).collect();
        let said = named(&good);
        assert!(said.iter().all(String::is_empty), "{why}: {said:?}");
        is_on.store(true, Ordering::Relaxed);
        let bad: Vec<Event> = (0..NAMED_WITHIN).flat_map(|_| flight.tick(&[], &mut planner)).collect();
        assert!(named(&bad).iter().any(|said| said.contains(why)), "{why}: {:?}", named(&bad));
        assert_eq!(flight.phase(), &Phase::Waiting);
        let refused = flight.tick(&[Order::Start], &mut planner);
        assert!(!matches!(flight.phase(), Phase::Running(_)), "{why}: {refused:?}");
    }
}

#[test]
fn every_kind_of_spoiled_scan_holds_the_robot_under_way() {
    for (spoil, why) in KINDS {
        let (mut flight, is_on) = flight(spoil);
        let mut planner = Ahead::default();
        for tick in 0..30 {
            let orders = if tick == 5 { vec![Order::Start] } else { Vec::new() };
            flight.tick(&orders, &mut planner);
        }
        assert!(matches!(flight.phase(), Phase::Running(_)), "{why}: {:?}", flight.phase());
        is_on.store(true, Ordering::Relaxed);
        (0..NAMED_WITHIN).for_each(|_| drop(flight.tick(&[], &mut planner)));
        let Phase::Held(hold) = flight.phase() else { panic!("{why}: {:?}", flight.phase()) };
        let (HoldReason::Guard { message } | HoldReason::Vehicle { message }) = &hold.by else {
            panic!("{why}: {hold:?}")
        };
        assert!(message.contains(why), "{why}: {message}");
    }
}

/// Number of ticks within which a survey is held. That the directions are wrong shows only after some turns and drives.
const SURVEY_HELD_WITHIN: usize = 600;

#[test]
fn every_kind_of_spoiled_scan_holds_a_survey() {
    for (spoil, why) in KINDS {
        let (mut flight, is_on) = flight_of(&survey(), spoil);
        let mut planner = Ahead::default();
        for tick in 0..30 {
            let orders = if tick == 5 { vec![Order::Start] } else { Vec::new() };
            flight.tick(&orders, &mut planner);
        }
        assert!(matches!(flight.phase(), Phase::Running(_)), "{why}: {:?}", flight.phase());
        is_on.store(true, Ordering::Relaxed);
        let is_held = |_: &usize| {
            flight.tick(&[], &mut planner);
            !matches!(flight.phase(), Phase::Running(_))
        };
        let after = (0..SURVEY_HELD_WITHIN).find(is_held);
        let Phase::Held(hold) = flight.phase() else { panic!("{why}: {:?}", flight.phase()) };
        let (HoldReason::Guard { message } | HoldReason::Vehicle { message }) = &hold.by else {
            panic!("{why} after {after:?} ticks: {hold:?}")
        };
        assert!(message.contains(why), "{why} after {after:?} ticks: {message}");
    }
}
