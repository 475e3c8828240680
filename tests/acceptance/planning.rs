//! The console while a planner makes a plan: no action of the operator has to wait for the plan.

use crate::{
    bench::{first_of, journal, of_kind, scenario},
    session::Session,
};
use serde_json::Value;

fn faulty(fault: &str) -> Session {
    let goto = scenario("goto-single-obstacle.toml");
    let arguments = format!("console {} --planner faulty --set fault={fault}", goto.display());
    Session::open(&arguments, 120, 36)
}

/// The console with a mission in progress; its planner must plan once more and misbehaves.
fn replanning(fault: &str) -> Session {
    let mut session = faulty(fault);
    session.start();
    session.see("▶ RUN");
    session.press(":");
    session.see("Tab complete");
    session.press("no-go 2,2 3,3\r");
    session.see("It closes");
    session.agree();
    session.see("Planning (faulty)");
    session
}

/// The events from the zone that made a new plan necessary; none until the zone is in the journal.
fn since_zone(events: &[Value]) -> &[Value] {
    first_of(events, "zone_drawn").map_or(&[], |at| &events[at..])
}

/// Leaves a console with a mission held or in progress, and returns the journal and the report.
fn leave(mut session: Session) -> (Session, Vec<Value>) {
    session.press("1q");
    aborted(session)
}

/// Confirms leaving, and returns the journal and the report.
fn aborted(mut session: Session) -> (Session, Vec<Value>) {
    assert_eq!(session.agree_to_leave(), "code=1");
    let events = journal(&session.run());
    assert_eq!(events.last().unwrap()["outcome"], "aborted");
    session.bench.prove(&session.run());
    (session, events)
}

/// Checks that the operator's hold came before the plan, and before the time limit of the plan.
fn assert_held_first(events: &[Value]) {
    let events = since_zone(events);
    let held = first_of(events, "held").expect("held");
    assert_eq!(events[held]["by"], "operator", "{}", events[held]);
    for kind in ["planned", "planner_failed"] {
        assert!(first_of(events, kind).is_none_or(|at| at > held), "{kind} came before the hold");
    }
}

#[test]
fn every_key_that_stops_holds_while_a_plan_is_being_made_and_the_console_leaves_in_good_order() {
    for key in [" ", "\x03", "1q"] {
        println!("key {key:?}");
        let mut session = replanning("replan_hang");
        session.press(key);
        session.see("‖ HOLD");
        // `q` on the first screen has already asked whether to leave.
        let (_, events) = if key == "1q" { aborted(session) } else { leave(session) };
        assert_held_first(&events);
        assert!(first_of(since_zone(&events), "planned").is_none());
    }
}

#[test]
fn a_plan_that_was_made_while_the_mission_was_held_is_flown_afterwards() {
    let mut session = replanning("replan_long");
    session.hold();
    session.until("the plan", |session| first_of(since_zone(&journal(&session.run())), "planned").is_some());
    assert!(session.text().contains("‖ HOLD"), "{}", session.text());
    session.resume();
    session.until("a command", |session| {
        let events = journal(&session.run());
        let resumed = first_of(&events, "resumed").map(|at| &events[at..]);
        resumed.is_some_and(|events| first_of(events, "commanded").is_some())
    });
    let (_, events) = leave(session);
    assert_held_first(&events);
    let events = since_zone(&events);
    assert_eq!(of_kind(events, "planned").len(), 1);
    assert!(first_of(events, "planned").unwrap() < first_of(events, "resumed").unwrap());
}

#[test]
fn a_planner_that_fails_while_the_mission_is_held_does_not_let_it_go() {
    let mut session = replanning("replan_hang");
    session.hold();
    session.until("the fault", |session| first_of(&journal(&session.run()), "planner_failed").is_some());
    session.see("‖ HOLD");
    let (_, events) = leave(session);
    assert_held_first(&events);
    assert!(of_kind(&events, "resumed").is_empty());
}

#[test]
fn another_planner_chosen_before_the_start_is_written_down_and_proven() {
    let goto = scenario("goto-single-obstacle.toml");
    let mut session = Session::open(&format!("console {} --planner apf", goto.display()), 120, 36);
    session.see("Press S to start");
    session.change_planner("rpf");
    session.until("the planner", |session| !session.text().contains("Change to"));
    session.see("rpf ");
    session.start();
    session.see("▶ RUN");
    session.finish();
    let run = session.run();
    let events = journal(&run);
    let chosen = of_kind(&events, "planner_chosen");
    let chosen: Vec<&str> = chosen.iter().filter_map(|event| event["choice"]["id"].as_str()).collect();
    assert!(matches!(chosen[..], ["apf", "rpf"] | ["rpf"]), "{chosen:?}");
    let orders: Vec<String> =
        of_kind(&events, "ordered").iter().map(|event| event["order"].to_string()).collect();
    let [planned, chosen, again, checked, started] = &orders[..] else { panic!("{orders:?}") };
    assert_eq!([planned, again], ["\"plan\"", "\"plan\""]);
    assert!(started.starts_with("{\"start_plan\":"), "{started}");
    assert!(
        chosen.contains("rpf") && checked.contains("note_checks") && checked.contains("passed"),
        "{orders:?}"
    );
    session.bench.prove(&run);
}

#[test]
fn what_makes_no_run_possible_is_said_before_the_screen_is_taken() {
    // The shell of the session wrote the file `before`.
    for (arguments, words) in [
        ("console --logs before", ["before", "not a folder"]),
        ("console --planner nonsense", ["nonsense", "there is no planner"]),
    ] {
        let mut session = Session::open(arguments, 200, 30);
        assert_eq!(session.back_in_the_shell(), "code=2", "{arguments}");
        let text = session.text();
        assert!(words.iter().all(|word| text.contains(word)), "{arguments}: {text}");
        assert!(!session.took_the_screen(), "{arguments}: {text}");
        assert!(session.bench.runs().is_empty());
    }
}

#[test]
fn a_run_that_is_deleted_in_flight_is_reported_at_once_and_at_the_end() {
    let goto = scenario("goto-single-obstacle.toml");
    let mut session = Session::open(&format!("console {}", goto.display()), 120, 36);
    session.see("Press S to start");
    session.press("<<<<");
    session.start();
    session.see("REC●");
    std::fs::remove_dir_all(session.run()).unwrap();
    session.see("REC✗");
    session.press("1q");
    assert_eq!(session.agree_to_leave(), "code=3");
    assert!(session.text().contains("NOT kept"), "{}", session.text());
}

#[test]
fn a_terminated_console_does_not_wait_for_the_plan() {
    let mut session = replanning("replan_hang");
    session.signal_console(rustix::process::Signal::TERM);
    assert_eq!(session.back_in_the_shell(), "code=143");
    let events = journal(&session.run());
    assert_held_first(&events);
    assert_eq!(events.last().unwrap()["event"], "ended");
    session.bench.prove(&session.run());
}

#[test]
fn a_start_waits_for_the_plan_and_names_the_one_that_was_seen() {
    let mut session = faulty("plan_long");
    session.see("Planning (faulty)");
    session.press("S");
    session.see("not started; start again when the plan is ready");
    session.start();
    session.see("▶ RUN");
    // The plan leads through a column, and the robot is held in front of it.
    let (session, events) = leave(session);
    let run = session.run();
    let orders: Vec<&Value> = of_kind(&events, "ordered").iter().map(|event| &event["order"]).collect();
    let named = orders.iter().filter_map(|order| order["start_plan"].as_str()).collect::<Vec<_>>();
    assert!(matches!(named[..], [plan] if plan.len() == 64), "{orders:?}");
    let start = events.iter().position(|event| event["order"]["start_plan"].is_string()).unwrap();
    assert!(first_of(&events, "planned").unwrap() < start, "the plan was there before");
    session.bench.prove(&run);
}

#[test]
fn a_start_is_refused_while_a_planner_is_being_opened_and_leaves_no_run() {
    let mut session = faulty("configure_hang");
    // On a busy machine the one-second time limit for opening may have passed.
    session.press("S\r");
    session.until("a refusal", |session| {
        ["not started; start again when the plan is ready", "tart blocked", "none; "]
            .iter()
            .any(|word| session.text().contains(word))
    });
    session.press("S\r");
    session.see("FAILED");
    assert!(!session.text().contains("▶ RUN"), "{}", session.text());
    session.press("1q");
    assert_eq!(session.back_in_the_shell(), "code=0");
    assert!(session.bench.runs().is_empty());
}

#[test]
fn a_planner_that_cannot_be_opened_blocks_the_start_and_another_one_flies() {
    let goto = scenario("goto-single-obstacle.toml");
    let arguments = format!("console {} --planner faulty --set fault=configure_panic", goto.display());
    let mut session = Session::open(&arguments, 120, 36);
    session.see("FAILED: planner faulty");
    session.press("S");
    session.see("tart blocked");
    session.press("A");
    session.see("[FAIL] planner");
    session.press("\x1b");
    // A key immediately after Esc would be read as Alt and that key.
    session.until("the closed list", |session| !session.text().contains("[FAIL] planner"));
    session.change_planner("rpf");
    session.see("Press S to start");
    assert!(session.bench.runs().is_empty());
    session.start();
    session.see("▶ RUN");
    session.finish();
    session.bench.prove(&session.run());
}

#[test]
fn a_mission_with_long_ticks_that_runs_slowly_starts() {
    let bench = crate::bench::Bench::new();
    let script = bench.file(
        "mission.txt",
        "start\nkey enter\nwait until phase running within 2m\nend\nkey enter\nwait until phase aborted\n",
    );
    let goto = scenario("goto-single-obstacle.toml");
    let words =
        ["console", goto.to_str().unwrap(), "--set", "mission.tick_s=0.5", "--speed", "0.25", "--script"];
    let ended = bench.tankops(&[&words[..], &[script.to_str().unwrap()]].concat());
    assert_eq!(ended.code, Some(0), "{ended:?}");
    bench.prove(&bench.runs()[0]);
}
