//! The laws of the drive back, in simulated tanks with columns: the robot comes back without a contact, the tether is
//! unwound, and the run repeats byte for byte.

#![allow(clippy::unwrap_used, clippy::expect_used, reason = "tests")]

use flight::{Flight, answers::Answers};
use mission::{
    Answer, Ask, Event, EventKind, Given, Home, Mission, Note, Noted, Order, Outcome, Phase, PlannerInfo,
    Said, What, ask::PlanAsk, event::RecordedAnswers,
};
use planner_api::{Command, Plan, Status};
use proptest::prelude::*;
use scenario::Scenario;
use std::collections::VecDeque;
use world::{Point, shortest::GrownFloor};

/// Minimum distance between columns, and from columns to the wall and the anchor, metres; the robot fits through such a
/// gap.
const GAP_M: f64 = 0.9;
const TANK_M: f64 = 5.0;
const ANCHOR: Point = Point::new(0.0, -4.4);

/// A column: its centre, its radius in metres, and whether it is on the drawing.
type Column = (Point, f64, bool);

/// A planner whose plan wanders about the tank and passes columns on either side.
struct Wanderer {
    open: VecDeque<Ask>,
    places: Vec<Point>,
}

impl Wanderer {
    fn plan(&self, ask: &PlanAsk) -> Plan {
        let room_m = ask.site.limits.radius_m + ask.site.clearance_m + 0.02;
        let solids = ask.site.obstacles.iter().map(|obstacle| (&obstacle.outline, room_m));
        let floor = GrownFloor::new(&ask.site.boundary, room_m, solids);
        let mut path = vec![ask.start.position];
        for place in self.places.iter().chain([&ANCHOR]) {
            let here = *path.last().unwrap();
            if let Ok(way) = floor.shortest(here, *place, &mut || true) {
                path.extend(&way.points()[1..]);
            }
        }
        Plan { path, complete: true, ..Plan::default() }
    }
}

impl Answers for Wanderer {
    fn submit(&mut self, ask: Ask) {
        if ask.what != What::Close {
            self.open.push_back(ask);
        }
    }

    fn next(&mut self, _: &Mission) -> Option<Answer> {
        let Ask { id, what } = self.open.pop_front()?;
        let given = match what {
            What::Open { choice, .. } => Given::Opened(Box::new(info(&choice.id))),
            What::Reconfigure(_) => Given::Reconfigured,
            What::Plan(ask) => Given::Plan(self.plan(&ask)),
            What::Step(sensed) => {
                let onward = sensed.target - sensed.pose.position;
                let still = Command::still(Status::Waiting);
                let drive = |direction: world::Vector| Command::velocity(direction * 0.4);
                Given::Command(onward.try_normalize(1e-9).map_or(still, drive))
            }
            What::Snapshot => Given::State { bytes: 0 },
            What::Close => return None,
        };
        Some(Answer { ask: id, result: Ok(given), said: Said::default() })
    }
}

fn info(id: &str) -> PlannerInfo {
    PlannerInfo {
        id: id.into(),
        name: String::new(),
        version: "1.0".into(),
        about: String::new(),
        plugin: String::new(),
        sha256: String::new(),
        abi: String::new(),
        covers: true,
        snapshots: false,
        sandbox: None,
        parameters: Vec::new(),
    }
}

/// The answers in a journal.
struct Recorded(RecordedAnswers);

impl Answers for Recorded {
    fn submit(&mut self, ask: Ask) {
        self.0.submit(&ask);
    }

    fn next(&mut self, _: &Mission) -> Option<Answer> {
        self.0.next_answer().map(|(answer, _)| answer)
    }
}

fn scenario(columns: &[Column], seed: u64, has_tether: bool) -> Scenario {
    let column = |(at, radius_m, known): &Column| {
        format!(
            "[[obstacles]]\nkind = \"circle\"\ncenter_m = [{:.3}, {:.3}]\nradius_m = {radius_m:.3}\nknown = {known}\n",
            at.x, at.y
        )
    };
    let columns: String = columns.iter().map(column).collect();
    let tether = if has_tether { "[tether]\nreel_length_m = 90.0\n" } else { "" };
    let text = format!(
        "name = \"tank\"\nseed = {seed}\n[tank]\nradius_m = {TANK_M}\n{columns}[robot]\nmotion = \"unicycle\"\n\
         radius_m = 0.2\nspeed_max_m_per_s = 0.4\nturn_rate_max_deg_per_s = 60.0\nstart_m = [{}, {}]\n\
         start_heading_deg = 90.0\n[ae]\nperiod_s = 1.0\nrepetitions = 20\nstations = [\n\
         {{ name = \"A\", at_m = [5.0, 0.0] }},\n{{ name = \"B\", at_m = [-2.5, 4.33] }},\n\
         {{ name = \"C\", at_m = [-2.5, -4.33] }},\n{{ name = \"D\", at_m = [2.5, 4.33] }},\n]\n{tether}[mission]\n\
         kind = \"cover\"\nswath_m = 0.6\nclearance_m = 0.1\ncell_m = 0.1\ntime_limit_s = 3600.0\n\
         [planner]\nid = \"wanderer\"\n",
        ANCHOR.x, ANCHOR.y
    );
    let mut scenario = Scenario::parse(&text, "tank").unwrap_or_else(|errors| panic!("{}", errors.render()));
    if let Some(tether) = &mut scenario.mission.tether {
        tether.allow_uncertified = true;
        (tether.limits.wrap_max_rad, tether.limits.wrap_total_max_rad) = (99.0, 99.0);
    }
    scenario
}

/// A flight and its events.
struct Flown {
    flight: Flight,
    planner: Wanderer,
    n_ticks: u64,
    events: Vec<Event>,
}

impl Flown {
    fn tick(&mut self, orders: &[Order]) {
        self.n_ticks += 1;
        self.events.extend(self.flight.tick(orders, &mut self.planner));
    }

    /// Orders the robot back; waits for a few fixes if the ranges contradict each other by chance.
    fn order_back(&mut self) {
        for _ in 0..5 {
            self.tick(&[Order::DriveBack]);
            if self.flight.phase().is_return() || !self.refusal().is_some_and(|why| why.contains("ranges")) {
                return;
            }
            self.fly(10);
        }
    }

    /// The last refusal of an order.
    fn refusal(&self) -> Option<&str> {
        self.events.iter().rev().find_map(|event| match &event.kind {
            EventKind::OrderRefused { why, .. } => Some(why.as_str()),
            _ => None,
        })
    }

    fn fly(&mut self, ticks: usize) {
        (0..ticks).for_each(|_| self.tick(&[]));
    }

    fn ended(&self) -> Option<(Outcome, &str)> {
        self.events.iter().rev().find_map(|event| match &event.kind {
            EventKind::Ended { outcome, reason } => Some((*outcome, reason.as_str())),
            _ => None,
        })
    }

    fn position(&self) -> Point {
        let truth = self.events.iter().rev().find_map(|event| match &event.kind {
            EventKind::Truth { pose, .. } => Some(pose.position),
            _ => None,
        });
        truth.unwrap()
    }

    fn has_touched(&self) -> bool {
        self.events.iter().any(|event| matches!(event.kind, EventKind::Truth { collided: true, .. }))
    }

    /// True length of tether out, metres.
    fn out_m(&self) -> Option<f64> {
        self.events.iter().rev().find_map(|event| match event.kind {
            EventKind::TetherTruth { length_m, .. } => Some(length_m),
            _ => None,
        })
    }
}

fn columns() -> impl Strategy<Value = Vec<Column>> {
    let column = (-4.0..4.0_f64, -3.5..4.0_f64, 0.1..0.4_f64, prop::bool::weighted(0.7));
    prop::collection::vec(column, 1..9).prop_map(|drawn| {
        let mut placed: Vec<Column> = Vec::new();
        for (x, y, radius_m, known) in drawn {
            let at = Point::new(x, y);
            let is_apart = |(other, other_m, _): &Column| (at - other).norm() > radius_m + other_m + GAP_M;
            let is_inside = at.coords.norm() < TANK_M - radius_m - GAP_M;
            if is_inside && (at - ANCHOR).norm() > radius_m + GAP_M && placed.iter().all(is_apart) {
                placed.push((at, radius_m, known));
            }
        }
        placed
    })
}

/// The order that an event reports.
fn ordered(event: &Event) -> Option<Order> {
    match &event.kind {
        EventKind::Ordered { order } | EventKind::OrderRefused { order, .. } => Some(order.clone()),
        _ => None,
    }
}

/// Notes of an operator; one of them contains text that is not plain.
fn notes() -> [Order; 2] {
    let (alarm, text) = ("no_fix".to_owned(), "no fix".to_owned());
    let shelved =
        Noted::Shelved { alarm: alarm.clone(), text: text.clone(), for_s: 60.0, reason: "wet\u{7}\n".into() };
    let note = |what| Order::Note(Note { what, by: Some("Zoe".into()) });
    [note(Noted::Acknowledged { alarm, text }), note(shelved)]
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 48,
        failure_persistence: None,
        rng_seed: proptest::test_runner::RngSeed::Fixed(20_261_125),
        ..ProptestConfig::default()
    })]

    #[test]
    fn a_robot_that_drives_back_arrives_without_contact_and_unwinds_its_tether(
        columns in columns(),
        places in prop::collection::vec((-3.5..3.5_f64, -3.5..3.5_f64), 8..16),
        seed in 0..1000_u64,
        until in 200..1200_usize,
        has_tether in prop::bool::weighted(0.75),
        stops in prop::option::of(10..80_usize),
    ) {
        let scenario = scenario(&columns, seed, has_tether);
        let flight = Flight::prepare(&scenario, true);
        let places = places.into_iter().map(|(x, y)| Point::new(x, y)).filter(|at| at.coords.norm() < 4.0).collect();
        let planner = Wanderer { open: VecDeque::new(), places };
        let mut flown = Flown { flight, planner, n_ticks: 0, events: Vec::new() };
        flown.tick(&[Order::Start]);
        for _ in 0..until {
            if !matches!(flown.flight.phase(), Phase::Running(_)) {
                break;
            }
            flown.tick(&[]);
        }
        prop_assume!(flown.ended().is_none() && !flown.has_touched());
        flown.tick(&[Order::Hold]);
        flown.fly(20);
        let way = flown.flight.mission().way_back();
        // The ranges may contradict each other by chance.
        prop_assume!(!matches!(&way, Err(why) if why.contains("ranges")));
        let way = way.unwrap();
        prop_assert_eq!(way.to, if has_tether { Home::Anchor } else { Home::Start });
        prop_assert!(way.clearance_m > -0.05, "{:?}", way);
        flown.tick(&notes());
        flown.order_back();
        if let Some(ticks) = stops {
            flown.fly(ticks);
            flown.tick(&[Order::Hold]);
            flown.fly(20);
            let here = flown.position();
            flown.fly(5);
            prop_assert_eq!(flown.position(), here, "the robot stands still");
            flown.order_back();
        }
        // Half the maximum speed on average, and a turn at every decimetre.
        let most_ticks = (way.length_m / 0.02) as usize + 600;
        for _ in 0..most_ticks {
            if matches!(flown.flight.phase(), Phase::Ended(_)) {
                break;
            }
            flown.tick(&[]);
        }
        let place = way.to.word();
        let expected = format!("ended by operator: robot is back at the {place}");
        prop_assert_eq!(
            flown.ended(), Some((Outcome::Aborted, expected.as_str())),
            "{:?} {:?} {:?}", way, flown.flight.phase(), flown.refusal()
        );
        prop_assert!(!flown.has_touched());
        prop_assert!((flown.position() - ANCHOR).norm() < 0.4, "{}", flown.position());
        prop_assert!(flown.out_m().is_none_or(|out_m| out_m < 0.6), "{:?} m of tether out", flown.out_m());

        let mut again = Flight::prepare(&scenario, true);
        let mut answers = Recorded(RecordedAnswers::default());
        for tick in 0..flown.n_ticks {
            let before = |tick: u64| flown.events.partition_point(|event| event.tick < tick);
            let events = &flown.events[before(tick)..before(tick + 1)];
            answers.0.begin_tick(events.iter().map(|event| &event.kind));
            let orders: Vec<Order> = events.iter().filter_map(ordered).collect();
            prop_assert_eq!(again.tick(&orders, &mut answers), events);
        }
    }
}
