//! Messages in, readings and link out.

use super::*;
use vehicle::wire::{
    Misfit,
    message::{Ae, Has, Limits, MotionKind, Pong, Pose, PulseLengths, StationRanges, Tether},
};

fn inbox() -> Inbox {
    let stations = [("A".to_owned(), StationId(1)), ("B".to_owned(), StationId(2))];
    let mut inbox = Inbox::new(stations.into(), "run:robot".into());
    inbox.take(hello(), 0.0);
    inbox.take(ready(), 0.0);
    inbox.has_answered = true;
    inbox
}

fn ready() -> Heard<FromVehicle> {
    state(Mode::Ready, Commander::You)
}

fn hello() -> Heard<FromVehicle> {
    let limits =
        Limits { speed_m_per_s: 0.5, turn_rad_per_s: 1.0, acceleration_m_per_s2: 1.0, radius_m: 0.2 };
    Heard::Message(FromVehicle::Hello(Box::new(Hello {
        protocol: 1,
        name: "robot".into(),
        motion: MotionKind::Unicycle,
        limits,
        has: Has::default(),
        period_s: 0.05,
        stop_time_s: 0.3,
        lease_max_s: 0.5,
        session: None,
    })))
}

fn moved(seq: u64, forward_m: f64, turn_rad: f64) -> Readings {
    let odometry = Some(Odometry { over_s: 0.05, forward_m, sideways_m: 0.0, turn_rad });
    Readings { seq, stamp_s: 100.0 + 0.05 * seq as f64, odometry, ..Readings::default() }
}

fn say(inbox: &mut Inbox, readings: Readings, now_s: f64) {
    inbox.take(Heard::Message(FromVehicle::Readings(Box::new(readings))), now_s);
}

fn state(mode: Mode, commander: Commander) -> Heard<FromVehicle> {
    let text = Some("left track".to_owned());
    Heard::Message(FromVehicle::State(State { stamp_s: 0.0, mode, text, battery: None, commander }))
}

#[test]
fn motion_of_several_messages_is_added_up_and_duplicates_do_not_count() {
    let mut inbox = inbox();
    let quarter = std::f64::consts::FRAC_PI_2;
    for (seq, forward_m, turn_rad) in [(1, 1.0, quarter), (2, 2.0, 0.0), (2, 2.0, 0.0), (1, 1.0, quarter)] {
        say(&mut inbox, moved(seq, forward_m, turn_rad), 0.1);
    }
    let odometry = inbox.sense(0.1).readings.odometry;
    assert!(
        (odometry.forward_m - 1.0).abs() < 1e-12 && (odometry.sideways_m - 2.0).abs() < 1e-12,
        "{odometry:?}"
    );
    assert_eq!((inbox.sense(0.2).readings.odometry, inbox.link(0.2).heard), (world::Odometry::default(), 2));
}

#[test]
fn a_pose_makes_up_for_lost_messages() {
    let mut inbox = inbox();
    let at = |seq, x_m, y_m| Readings {
        pose: Some(Pose { x_m, y_m, heading_rad: std::f64::consts::FRAC_PI_2 }),
        ..moved(seq, 9.0, 9.0)
    };
    say(&mut inbox, at(1, 5.0, 5.0), 0.0);
    say(&mut inbox, at(4, 5.0, 5.3), 0.1);
    let sensed = inbox.sense(0.1);
    assert!((sensed.readings.odometry.forward_m - 0.3).abs() < 1e-12, "{:?}", sensed.readings.odometry);
    assert_eq!(inbox.link(0.1).missed, 2);
}

#[test]
fn a_scan_is_carried_to_the_end_of_its_tick() {
    let mut inbox = inbox();
    let scan = |range_m: f64| Scan {
        first_rad: 0.0,
        step_rad: 0.1,
        range_max_m: 80.0,
        sensor_m: [0.1, 0.0],
        ranges_m: vec![Some(range_m), None, Some(70.0)],
    };
    say(&mut inbox, Readings { scan: Some(scan(9.0)), ..moved(1, 0.5, 0.0) }, 0.1);
    say(&mut inbox, Readings { scan: Some(scan(2.0)), ..moved(2, 0.5, 0.0) }, 0.15);
    say(&mut inbox, moved(3, 0.25, 0.0), 0.2);
    say(&mut inbox, moved(4, 0.25, 0.0), 0.2);
    let carried = inbox.sense(0.2).readings.scan;
    // Longer distances do not fit into a scan.
    assert_eq!(carried.as_ref().and_then(|scan| scan.range_max_m), Some(LONGEST_M));
    let points: Vec<_> = carried.iter().flat_map(world::Scan::points).collect();
    let [point] = points[..] else { panic!("{points:?}") };
    assert!((point - world::Point::new(1.6, 0.0)).norm() < 1e-12, "{point}");
    assert_eq!(inbox.sense(0.3).readings.scan, None);
}

#[test]
fn readings_keep_the_last_cycle_the_contact_and_the_tether() {
    let mut inbox = inbox();
    let ranges = |station: &str| StationRanges { station: station.into(), ranges_m: vec![4.2] };
    let ae = Some(Ae { ranges: vec![ranges("A"), ranges("unknown")], ..Ae::default() });
    let tether = Some(Tether { paid_out_m: 3.5, pull_n: None });
    say(&mut inbox, Readings { ae, contact: Some(true), tether, ..moved(1, 0.0, 0.0) }, 0.1);
    say(&mut inbox, moved(2, 0.0, 0.0), 0.15);
    let sensed = inbox.sense(0.2).readings;
    assert_eq!(
        (sensed.ranges.len(), sensed.ranges[0].station, sensed.ranging_cycle),
        (1, StationId(1), true)
    );
    assert_eq!((sensed.contact, sensed.paid_out_m), (true, Some(3.5)));
    assert!(!inbox.sense(0.3).readings.contact);
}

#[test]
fn pulses_of_all_messages_of_a_tick_are_kept_by_station() {
    let mut inbox = inbox();
    let pulses = |sender: &str, receiver: &str| PulseLengths {
        sender: sender.into(),
        receiver: receiver.into(),
        lengths_m: vec![8.1, 8.2],
    };
    let first = vec![pulses("A", "unknown"), pulses("A", "B")];
    say(&mut inbox, Readings { pulses: first, ..moved(1, 0.0, 0.0) }, 0.1);
    say(&mut inbox, Readings { pulses: vec![pulses("B", "A")], ..moved(2, 0.0, 0.0) }, 0.15);
    let sensed = inbox.sense(0.2).readings;
    let pairs: Vec<_> =
        sensed.pulses.iter().map(|set| (set.sender, set.receiver, set.lengths_m.len())).collect();
    assert_eq!(pairs, [(StationId(1), StationId(2), 2), (StationId(2), StationId(1), 2)]);
    assert_eq!(
        inbox.notices.last_fault(),
        "readings: the scenario has no station `unknown`, only A, B; its readings are not used"
    );
    // Pulses do not count as a ranging cycle of the robot.
    assert!(!sensed.ranging_cycle && inbox.sense(0.3).readings.pulses.is_empty());
}

#[test]
fn ranges_that_arrive_too_late_are_dropped() {
    let mut inbox = inbox();
    inbox.take(Heard::Message(FromVehicle::Pong(Pong { echo_s: 0.0, stamp_s: 100.01 })), 0.02);
    assert_eq!(inbox.link(0.02).offset_s, Some(100.0));
    assert_eq!(inbox.link(0.02).offset_bound_s, Some(0.01));
    let late = Readings { ae: Some(Ae::default()), stamp_s: 100.1, ..moved(1, 0.2, 0.0) };
    say(&mut inbox, late, 0.9);
    let sensed = inbox.sense(0.9).readings;
    assert_eq!((sensed.ranging_cycle, sensed.odometry.forward_m), (false, 0.2));
    assert_eq!(inbox.link(0.9).age_p99_s, Some(0.8));
}

#[test]
fn each_trouble_is_a_state_of_the_link_with_its_reason() {
    let mut inbox = inbox();
    say(&mut inbox, moved(1, 0.0, 0.0), 1.0);
    let seen = |inbox: &Inbox, now_s| {
        let link = inbox.link(now_s);
        (link.state, link.why)
    };
    assert_eq!(seen(&inbox, 1.7).0, LinkState::Up);
    assert_eq!(seen(&inbox, 1.9), (LinkState::Lost, "its readings stopped".into()));
    for (heard, word, why) in [
        (state(Mode::Manual, Commander::You), LinkState::Manual, "left track"),
        (state(Mode::EmergencyStop, Commander::You), LinkState::EmergencyStop, "left track"),
        (state(Mode::Fault, Commander::You), LinkState::VehicleFault, "left track"),
        (
            state(Mode::Ready, Commander::OtherProgram),
            LinkState::OtherCommander,
            "another program is sending commands to it",
        ),
        (state(Mode::Ready, Commander::You), LinkState::Up, ""),
    ] {
        inbox.take(heard, 1.0);
        assert_eq!(seen(&inbox, 1.0), (word, why.to_owned()));
    }
    let misfit =
        || Misfit { field: "readings.odometry.forward_m".into(), what: "NaN is not a finite number".into() };
    for _ in 0..3 {
        assert_eq!(seen(&inbox, 1.0).0, LinkState::Up);
        inbox.take(Heard::Malformed(misfit()), 1.0);
    }
    let (state, why) = seen(&inbox, 1.0);
    assert!(state == LinkState::Faulty && why.ends_with(&misfit().to_string()), "{why}");
    inbox.close("the adapter has closed the link".into());
    assert_eq!(seen(&inbox, 1.0).0, LinkState::Closed);
}

/// The reason for which the link is lost after readings every 50 ms for 2 s.
fn lost_by(readings: impl Fn(u32) -> Readings) -> String {
    let mut inbox = inbox();
    for n in 0..=40_u32 {
        let now_s = 0.05 * f64::from(n);
        let echo_s = (now_s - 0.001).max(0.0);
        inbox.take(Heard::Message(FromVehicle::Pong(Pong { echo_s, stamp_s: 100.0 + now_s })), now_s);
        say(&mut inbox, readings(n), now_s);
    }
    let link = inbox.link(2.0);
    assert_eq!(link.state, LinkState::Lost, "{link:?}");
    link.why
}

#[test]
fn readings_that_arrive_without_being_new_are_told_from_readings_that_stopped() {
    let repeated = lost_by(|n| Readings { seq: 1, ..moved(n.into(), 0.0, 0.0) });
    assert_eq!(repeated, "its readings repeat the numbers of earlier ones");
    let frozen = lost_by(|n| Readings { stamp_s: 100.0, ..moved(n.into(), 0.0, 0.0) });
    assert_eq!(frozen, "the stamps of its readings (`stamp_s`) stand still");
    let mut inbox = inbox();
    for seq in [1, 1] {
        say(&mut inbox, moved(seq, 0.0, 0.0), 0.1);
    }
    assert_eq!(inbox.link(2.0).why, "its readings stopped");
}

#[test]
fn a_vehicle_that_restarts_is_told_at_once_and_its_numbers_and_poses_begin_again() {
    for first in [1, 700] {
        let mut inbox = inbox();
        let at = |seq, x_m| Readings {
            pose: Some(Pose { x_m, y_m: 0.0, heading_rad: 0.0 }),
            ..moved(seq, 0.0, 0.0)
        };
        say(&mut inbox, at(600, 5.0), 1.0);
        inbox.sense(1.0);
        inbox.take(hello(), 1.05);
        assert!(!inbox.may_drive(), "the tick under way must not move it again");
        say(&mut inbox, at(first, 0.0), 1.08);
        let sensed = inbox.sense(1.1);
        let trouble = sensed.live.and_then(|live| live.link).and_then(|link| link.trouble());
        assert_eq!(trouble.as_deref(), Some("the vehicle has restarted"), "{first}");
        assert_eq!(sensed.readings.odometry, world::Odometry::default(), "{first}: a new frame");
        say(&mut inbox, at(first + 1, 0.1), 1.15);
        let sensed = inbox.sense(1.2);
        assert!((sensed.readings.odometry.forward_m - 0.1).abs() < 1e-12, "{first}");
        let link = sensed.live.and_then(|live| live.link).expect("it changed");
        assert_eq!((link.state, link.heard, link.missed), (LinkState::Up, 3, 0), "{first}");
        assert!(inbox.may_drive());
    }
}

#[test]
fn a_stop_is_decided_by_readings_that_were_taken_after_it_was_sent() {
    let mut inbox = inbox();
    let stood = |inbox: &mut Inbox, now_s| inbox.sense(now_s).live.and_then(|live| live.stood);
    say(&mut inbox, moved(1, 0.0, 0.0), 1.0);
    inbox.take(Heard::Message(FromVehicle::Pong(Pong { echo_s: 1.0, stamp_s: 100.05 })), 1.0);
    inbox.commanded(false, 1.02);
    // The stream has not taken the stop yet, so a vehicle that stands still at this time proves nothing.
    (2..=5).for_each(|seq| say(&mut inbox, moved(seq, 0.0, 0.0), 0.95 + 0.05 * seq as f64));
    assert_eq!(stood(&mut inbox, 1.2), None);
    inbox.sent(&ToVehicle::Stop(vehicle::wire::message::Stop { seq: 1, stamp_s: 1.2 }), 1.2);
    for seq in 6..=20_u64 {
        let forward_m = if seq < 9 { 0.01 } else { 0.0 };
        let now_s = 0.95 + 0.05 * seq as f64;
        say(&mut inbox, moved(seq, forward_m, 0.0), now_s);
        let expected = (seq == 11).then_some(true);
        let found = stood(&mut inbox, now_s);
        assert_eq!(found.map(|stood| stood.confirmed), expected, "{seq}");
        assert!(found.is_none_or(|stood| (stood.after_s - 0.38).abs() < 1e-3), "{found:?}");
    }
    inbox.commanded(true, 2.0);
    assert_eq!(stood(&mut inbox, 2.0), None, "the motion waits to be sent");
    inbox.commanded(false, 2.0);
    assert!(stood(&mut inbox, 2.0).is_some(), "the brake: no motion was sent in between");
}

#[test]
fn a_vehicle_that_moves_without_an_order_is_told_as_such() {
    let mut inbox = inbox();
    inbox.commanded(false, 1.0);
    inbox.sent(&ToVehicle::Stop(vehicle::wire::message::Stop { seq: 1, stamp_s: 1.0 }), 1.0);
    let stood = |inbox: &mut Inbox, seq, forward_m| {
        let now_s = 1.0 + 0.05 * seq as f64;
        say(inbox, moved(seq, forward_m, 0.0), now_s);
        inbox.sense(now_s).live.and_then(|live| live.stood).map(|stood| (stood.confirmed, stood.moved))
    };
    let told: Vec<_> = [0.0, 0.0, 0.0, 0.0, 0.01, 0.01, 0.0, 0.0, 0.0, 0.0]
        .into_iter()
        .zip(1..)
        .filter_map(|(forward_m, seq)| stood(&mut inbox, seq, forward_m))
        .collect();
    assert_eq!(told, [(true, false), (false, true), (true, false)]);
}

#[test]
fn what_the_console_needs_is_named_if_the_vehicle_does_not_send_it() {
    let mut inbox = Inbox::new(BTreeMap::new(), String::new());
    inbox.take(hello(), 3.0);
    let seen = |inbox: &Inbox, now_s| (inbox.link(now_s).state, inbox.link(now_s).why);
    assert_eq!(seen(&inbox, 12.9).0, LinkState::Up, "it may still come");
    let missing = |why: &str| (LinkState::Lost, format!("within 10 s of `hello`, it sent no {why}"));
    assert_eq!(seen(&inbox, 13.1), missing("`readings` and no `state` and no `pong`"));
    say(&mut inbox, moved(1, 0.0, 0.0), 13.1);
    assert_eq!(seen(&inbox, 13.1), missing("`state` and no `pong`"));
    inbox.take(ready(), 13.1);
    inbox.has_answered = true;
    assert_eq!(seen(&inbox, 13.1).0, LinkState::Up);
    for n in 2..200 {
        say(&mut inbox, moved(n, 0.0, 0.0), 13.1 + 0.05 * n as f64);
    }
    let (state, why) = seen(&inbox, 20.0);
    assert!(state == LinkState::Lost && why.contains("no `state` for 6 s"), "{why}");
}

#[test]
fn a_malformed_hello_is_a_fault_of_its_own() {
    let mut inbox = inbox();
    say(&mut inbox, moved(1, 0.0, 0.0), 1.0);
    let misfit = Misfit { field: "hello.session".into(), what: "is missing".into() };
    inbox.take(Heard::Malformed(misfit), 1.0);
    let link = inbox.link(1.0);
    assert_eq!((link.state, link.why.as_str()), (LinkState::Faulty, "hello.session: is missing"));
}

#[test]
fn the_last_fault_of_a_vehicle_is_the_reason_for_the_end_of_its_link() {
    let mut inbox = inbox();
    inbox.take(state(Mode::Fault, Commander::You), 1.0);
    inbox.close("the adapter ended the connection".into());
    assert_eq!(inbox.closed(), Some("the adapter ended the connection; it had reported: left track"));
}

#[test]
fn the_link_is_reported_when_it_changes_and_every_ten_seconds() {
    let mut inbox = inbox();
    let mut reports = Vec::new();
    for tick in 0..250_u32 {
        let now_s = 0.1 * f64::from(tick);
        inbox.take(ready(), now_s);
        if !(150..170).contains(&tick) {
            say(&mut inbox, moved(u64::from(tick) + 1, 0.0, 0.0), now_s);
        }
        if let Some(link) = inbox.sense(now_s).live.and_then(|live| live.link) {
            reports.push((tick, link.state.word()));
        }
    }
    assert_eq!(reports, [(0, "up"), (100, "up"), (157, "lost"), (170, "up")]);
}

fn notices(inbox: &mut Inbox, now_s: f64) -> Vec<Notice> {
    inbox.sense(now_s).live.map(|live| live.notices).unwrap_or_default()
}

#[test]
fn another_vehicle_on_the_same_connection_is_described_and_not_driven() {
    let mut inbox = inbox();
    say(&mut inbox, moved(1, 0.0, 0.0), 1.0);
    inbox.sense(1.0);
    let other = |name: &str, speed_m_per_s: f64| {
        let Heard::Message(FromVehicle::Hello(mut hello)) = hello() else { unreachable!() };
        name.clone_into(&mut hello.name);
        hello.limits.speed_m_per_s = speed_m_per_s;
        Heard::Message(FromVehicle::Hello(hello))
    };
    inbox.take(other("b", 0.2), 1.05);
    say(&mut inbox, moved(1, 0.4, 0.0), 1.08);
    let sensed = inbox.sense(1.1);
    assert_eq!(sensed.readings.odometry, world::Odometry::default(), "it is not the robot of this run");
    let live = sensed.live.expect("live");
    let [Notice::OtherVehicle { vehicle, differs }] = &live.notices[..] else { panic!("{live:?}") };
    assert_eq!((vehicle.name.as_str(), vehicle.at.as_str()), ("b", "run:robot"));
    assert!((vehicle.speed_max_m_per_s - 0.2).abs() < 1e-12);
    let expected = ["`name` is \"b\" instead of \"robot\"", "`limits.speed_m_per_s` is 0.2 instead of 0.5"];
    assert_eq!(differs[..], expected);
    let link = live.link.expect("it changed");
    assert_eq!(link.state, LinkState::OtherVehicle);
    assert!(link.trouble().is_some_and(|why| why.contains(&expected.join(", "))), "{link:?}");
    say(&mut inbox, moved(2, 0.0, 0.0), 1.15);
    assert!(notices(&mut inbox, 1.2).is_empty() && !inbox.may_drive());
    assert_eq!(inbox.link(1.2).state, LinkState::OtherVehicle, "until the first vehicle is back");
    inbox.take(hello(), 1.25);
    say(&mut inbox, moved(1, 0.0, 0.0), 1.25);
    assert!(!inbox.may_drive() && notices(&mut inbox, 1.3).is_empty());
    assert!(inbox.may_drive());
}

#[test]
fn faulty_messages_between_good_ones_are_counted_with_the_first_and_the_last_fault() {
    let mut inbox = inbox();
    let mut told = Vec::new();
    for n in 0..211_u64 {
        let now_s = 0.1 * n as f64;
        inbox.take(ready(), now_s);
        if n > 10 {
            let field = if n == 11 { "readings.seq" } else { "state.mode" };
            let misfit = Misfit { field: field.into(), what: format!("wrong in {n}") };
            inbox.take(Heard::Malformed(misfit), now_s);
        }
        let stamp_s = 100.0 + now_s;
        say(&mut inbox, Readings { stamp_s, ..moved(n, 0.0, 0.0) }, now_s);
        told.extend(notices(&mut inbox, now_s));
    }
    let of = |count, last: u32| Notice::FaultyMessages {
        count,
        first: "readings.seq: wrong in 11".into(),
        last: if last == 11 {
            "readings.seq: wrong in 11".into()
        } else {
            format!("state.mode: wrong in {last}")
        },
    };
    assert_eq!(told, [of(1, 11), of(101, 111)]);
    assert_eq!(inbox.settled(22.0).notices, [of(200, 210)], "the rest at the end");
}

#[test]
fn a_clock_with_a_wrong_rate_is_named_once() {
    let mut inbox = inbox();
    let mut told = Vec::new();
    for n in 0..400_u64 {
        let now_s = 0.05 * n as f64;
        let stamp_s = 100.0 + 1.2 * now_s;
        inbox.take(ready(), now_s);
        let echo_s = (now_s - 0.002).max(0.0);
        inbox.take(Heard::Message(FromVehicle::Pong(Pong { echo_s, stamp_s })), now_s);
        say(&mut inbox, Readings { stamp_s, ..moved(n, 0.0, 0.0) }, now_s);
        told.extend(notices(&mut inbox, now_s));
    }
    let [Notice::ClockRate { field, rate, is_off: true }] = &told[..] else { panic!("{told:?}") };
    assert!(field == "pong.stamp_s" && (rate - 1.2).abs() < 1e-3, "{told:?}");
}

#[test]
fn a_stop_of_the_console_itself_is_not_the_silence_of_the_vehicle() {
    let mut inbox = inbox();
    let pong = |stamp_s| Heard::Message(FromVehicle::Pong(Pong { echo_s: stamp_s - 100.0, stamp_s }));
    inbox.sent(&ToVehicle::Ping(vehicle::wire::message::Ping { stamp_s: 1.0 }), 1.0);
    inbox.take(pong(101.0), 1.0);
    say(&mut inbox, moved(20, 0.0, 0.0), 1.0);
    assert_eq!(inbox.sense(1.0).live.and_then(|live| live.link).map(|link| link.state), Some(LinkState::Up));
    // The process is stopped for 4 s; the messages of this time wait to be read.
    let link = inbox.sense(5.0).live.and_then(|live| live.link).expect("it changed");
    assert_eq!((link.state, link.console_stopped_s), (LinkState::ConsoleStopped, 4.0));
    let why = "the console itself was stopped: it sent no commands for 4.0 s";
    assert_eq!(link.trouble().as_deref(), Some(why));
    assert_eq!(inbox.link(5.1).state, LinkState::Up, "the messages are being read");
    (21..=100).for_each(|seq| say(&mut inbox, moved(seq, 0.0, 0.0), 5.2));
    inbox.take(pong(105.2), 5.2);
    assert_eq!(inbox.sense(5.2).live.and_then(|live| live.link).map(|link| link.state), Some(LinkState::Up));
    // The vehicle is silent while the console runs.
    let lost = (0..20).map(|n| 5.3 + 0.1 * f64::from(n)).find_map(|now_s| {
        inbox.sense(now_s).live.and_then(|live| live.link).filter(|link| link.state != LinkState::Up)
    });
    assert_eq!(
        lost.map(|link| (link.state, link.why)),
        Some((LinkState::Lost, "its readings stopped".into()))
    );
}

#[test]
fn a_vehicle_that_is_silent_after_a_stop_of_the_console_is_lost() {
    let mut inbox = inbox();
    say(&mut inbox, moved(1, 0.0, 0.0), 1.0);
    inbox.sense(1.0);
    let states: Vec<_> = (0..20)
        .filter_map(|n| inbox.sense(5.0 + 0.1 * f64::from(n)).live.and_then(|live| live.link))
        .map(|link| link.state)
        .collect();
    assert_eq!(states, [LinkState::ConsoleStopped, LinkState::Up, LinkState::Lost]);
}

#[test]
fn the_place_of_half_a_line_before_a_silence_or_an_end_is_named() {
    let mut inbox = inbox();
    say(&mut inbox, moved(1, 0.0, 0.0), 1.0);
    inbox.stopped_in(Some("readings.odometry.turn_rad".into()));
    assert_eq!(inbox.link(1.1).why, "");
    let why = "its readings stopped, in the middle of a line: readings.odometry.turn_rad";
    assert_eq!(inbox.link(3.0).why, why);
    inbox.close("the adapter ended the connection".into());
    let why = "the adapter ended the connection; its last line is incomplete: readings.odometry.turn_rad";
    assert_eq!(inbox.closed(), Some(why));
}

#[test]
fn dead_channels_arrive_in_order_and_stay_unsaid_between_messages() {
    let mut inbox = inbox();
    say(&mut inbox, Readings { dead_channels: Some(vec![7, 3, 7]), ..moved(1, 0.0, 0.0) }, 0.1);
    say(&mut inbox, moved(2, 0.0, 0.0), 0.15);
    assert_eq!(inbox.sense(0.2).readings.dead_channels, Some(vec![3, 7]));
    assert_eq!(inbox.sense(0.3).readings.dead_channels, None);
    say(&mut inbox, Readings { dead_channels: Some(vec![]), ..moved(3, 0.0, 0.0) }, 0.35);
    assert_eq!(inbox.sense(0.4).readings.dead_channels, Some(vec![]));
}
