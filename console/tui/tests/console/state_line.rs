//! The state line: what the robot is doing, and why it stands still.

use crate::fixture::{RICH, Screen};
use crate::screens::{drawn, text};
use mission::event::{Effort, PlanMade};
use mission::{AskId, EventKind, HoldReason, Order, Resumes, WorkerId};
use planner_api::{Leg, LegTag};
use tui::RunMsg;
use vehicle::port::{LinkSeen, LinkState};
use world::Point;

pub(crate) fn hear(screen: &mut Screen, kinds: impl IntoIterator<Item = EventKind>) {
    let events = kinds.into_iter().map(|kind| screen.mission.now(kind)).collect();
    screen.hear(RunMsg::Events(events));
}

/// The state line at 120x36.
pub(crate) fn state(screen: &Screen) -> String {
    let shown = text(&drawn(&screen.model, RICH, (120, 36)));
    let lines: Vec<&str> = shown.lines().map(str::trim).collect();
    lines[lines.len() - 2].to_owned()
}

fn offer() -> EventKind {
    let effort = |time_s| Effort { length_m: 860.0, rotation_rad: 190.0, time_s };
    EventKind::BetterPlanned(PlanMade {
        ask: AskId { worker: WorkerId(2), n: 2 },
        planner: "rpf".into(),
        path: vec![Point::new(2.0, 1.5), Point::new(4.0, 1.5)],
        complete: true,
        legs: Vec::new(),
        cuts: Vec::new(),
        flown: effort(2460.0),
        better: effort(2238.0),
        scans: None,
        objection: None,
    })
}

/// Position lost for two seconds, and recovered.
fn lost_and_recovered(screen: &mut Screen) {
    hear(screen, [EventKind::PositionLost { error_m: 0.5, limit_m: 0.15 }]);
    let drive = screen.mission.drive(4);
    screen.hear(RunMsg::Events(drive));
    assert!(state(screen).starts_with("POSITION LOST"), "{}", state(screen));
    hear(screen, [EventKind::PositionRegained { error_m: 0.1 }]);
}

#[test]
fn a_cleared_alarm_hides_neither_the_target_nor_a_better_plan() {
    let mut screen = Screen::running();
    lost_and_recovered(&mut screen);
    let target = state(&screen);
    assert!(target.starts_with("Next target: "), "{target}");
    assert!(target.contains("Position lost (cleared). a: acknowledge."), "{target}");
    hear(&mut screen, [offer()]);
    assert!(state(&screen).starts_with("Better plan: "), "{}", state(&screen));
    screen.type_text("a");
    assert!(!state(&screen).contains("cleared"), "{}", state(&screen));
}

#[test]
fn an_active_alarm_comes_before_a_cleared_one_that_is_worse() {
    let mut screen = Screen::running();
    lost_and_recovered(&mut screen);
    let alarms = &mut screen.model.live.run.alarms;
    alarms.raise(tui::model::Cause::Disk, mission::Severity::Warn, "disk space left: 150 MB".into(), 1.0);
    let line = state(&screen);
    assert!(line.starts_with("Little disk space left. a: acknowledge."), "{line}");
}

#[test]
fn a_drive_back_to_the_start_of_a_new_plan_is_explained() {
    let mut screen = Screen::running();
    let mut planned = screen.mission.planned(None);
    if let EventKind::Planned { path, legs, length_m, .. } = &mut planned {
        *path = [(0.0, 0.0), (4.0, 0.0), (4.0, 30.0)].map(|(x, y)| Point::new(x, y)).to_vec();
        *length_m = 34.0;
        *legs = vec![
            Leg { tag: LegTag::Retract, first: 0, last: 1 },
            Leg { tag: LegTag::Swath, first: 1, last: 2 },
        ];
    }
    let mut travels = planned.clone();
    if let EventKind::Planned { legs, .. } = &mut travels {
        legs[0].tag = LegTag::Travel;
    }
    hear(&mut screen, [planned]);
    let line = state(&screen);
    assert!(
        line.starts_with("Driving back along the tether to the start of the new plan: 4.0 m left."),
        "{line}"
    );
    hear(&mut screen, [travels]);
    let line = state(&screen);
    assert!(line.starts_with("Driving to the next lane: 4.0 m left."), "{line}");
    screen.model.live.run.planning.plan.as_mut().unwrap().driven_m = 0.0;
    screen.model.live.run.progress.as_mut().unwrap().done = 0.0;
    let line = state(&screen);
    assert!(line.starts_with("Driving to the first lane of the plan: 4.0 m left."), "{line}");
}

#[test]
fn a_planner_that_ends_during_a_hold_is_named_with_what_to_do() {
    let mut screen = Screen::held();
    let failed = screen.mission.planner_fails().remove(0);
    screen.hear(RunMsg::Events(vec![failed]));
    let line = state(&screen);
    assert!(line.starts_with("HELD by operator; planner has failed"), "{line}");
    assert!(line.contains("space: restart it and resume. P: change planner."), "{line}");
}

/// A live run that has been driving.
pub(crate) fn live() -> Screen {
    let mut screen = Screen::running();
    screen.model.live.run.about.as_mut().expect("a run").mission.live = true;
    hear(&mut screen, [link(LinkState::Up, "")]);
    screen
}

pub(crate) fn link(state: LinkState, why: &str) -> EventKind {
    EventKind::Link(LinkSeen { state, why: why.into(), heard: 900, ..LinkSeen::default() })
}

#[test]
fn a_vehicle_is_held_only_when_its_odometry_has_confirmed_the_stop() {
    let mut screen = live();
    let held = screen.mission.obeyed(Order::Hold);
    screen.hear(RunMsg::Events(held));
    hear(&mut screen, [EventKind::Sent { drive: None, lease_s: 0.25 }]);
    assert!(state(&screen).starts_with("STOPPING by operator"), "{}", state(&screen));
    hear(&mut screen, [EventKind::Stood { confirmed: true, after_s: 0.3, moved: false }]);
    assert!(state(&screen).starts_with("HELD by operator at "), "{}", state(&screen));
    hear(&mut screen, [EventKind::Stood { confirmed: false, after_s: 1.0, moved: false }]);
    let line = state(&screen);
    assert!(line.starts_with("STOP NOT CONFIRMED by operator"), "{line}");
    assert!(line.contains("use its emergency stop"), "{line}");
}

#[test]
fn a_hold_names_the_link_and_offers_only_what_it_allows() {
    let mut screen = live();
    let lost = LinkSeen { state: LinkState::Lost, why: "its readings stopped".into(), ..LinkSeen::default() };
    let message = lost.trouble().expect("a reason");
    hear(
        &mut screen,
        [
            EventKind::Link(lost),
            EventKind::Held { by: HoldReason::Vehicle { message }, resumes: Resumes::Never },
            EventKind::Stood { confirmed: false, after_s: 1.0, moved: false },
        ],
    );
    let line = state(&screen);
    assert!(line.starts_with("STOP NOT CONFIRMED: link to vehicle lost"), "{line}");
    assert!(line.contains("It may move: use its emergency stop."), "{line}");
    assert!(!line.contains("resume.") && line.contains("Cannot resume until the link is back."), "{line}");
    hear(&mut screen, [link(LinkState::Closed, "the adapter has ended")]);
    let line = state(&screen);
    assert!(line.contains("link to vehicle closed") && line.contains("only a new run connects"), "{line}");
    assert_eq!(screen.press([tui::Key::Char(' ')]), []);
    assert_eq!(screen.model.ui.overlay, tui::model::Overlay::None, "it cannot resume, so it does not ask");
    let why = screen.model.notice().expect("the reason").text.clone();
    assert!(why.contains("the link to the vehicle is closed"), "{why}");
    screen.model.console.notice = None;
    let shown = text(&drawn(&screen.model, RICH, (120, 36)));
    assert!(!shown.contains("resume…"), "{shown}");
    hear(
        &mut screen,
        [link(LinkState::Up, ""), EventKind::Stood { confirmed: true, after_s: 1.0, moved: false }],
    );
    let line = state(&screen);
    assert!(line.starts_with("HELD: vehicle is ready again"), "{line}");
    assert!(line.contains("space: resume."), "{line}");
}

#[test]
fn the_time_left_is_that_of_the_plan_until_the_pace_is_known() {
    let mut screen = Screen::idle();
    let ask = screen.model.live.run.planning.plan.as_ref().expect("a plan").ask;
    let mission = &screen.model.live.run.about.as_ref().expect("a run").mission;
    let world = crate::fixture::world();
    let estimate = account::Estimate::new(mission, &world, &crate::fixture::spiral(), true);
    let time_s = estimate.time_s;
    screen.hear(RunMsg::Estimated(ask, Box::new(estimate)));
    assert_eq!(screen.model.live.left_s(), Some(time_s));
    let begin = screen.mission.start();
    screen.hear(RunMsg::Events(begin));
    let drive = screen.mission.drive(20);
    screen.hear(RunMsg::Events(drive));
    let left_s = screen.model.live.left_s().expect("the promise of the plan");
    assert!(left_s < time_s && left_s > 0.9 * time_s, "{left_s} of {time_s} s");
    let shown = text(&drawn(&screen.model, RICH, (120, 36)));
    assert!(shown.contains(", ends T+") && !shown.contains("time left    -"), "{shown}");
}

#[test]
fn a_plan_made_on_the_way_has_a_time_left_at_the_promised_pace() {
    let mut screen = Screen::idle();
    let ask = screen.model.live.run.planning.plan.as_ref().expect("a plan").ask;
    let mission = &screen.model.live.run.about.as_ref().expect("a run").mission;
    let estimate = account::Estimate::new(mission, &crate::fixture::world(), &crate::fixture::spiral(), true);
    let time_s = estimate.time_s;
    screen.hear(RunMsg::Estimated(ask, Box::new(estimate)));
    let begin = screen.mission.start();
    screen.hear(RunMsg::Events(begin));
    let planned = screen.mission.planned(Some(AskId::from((WorkerId(7), 7))));
    hear(&mut screen, [planned]);
    assert!(screen.model.live.estimate().is_none(), "no estimate is made for it");
    let left_s = screen.model.live.left_s().expect("at the promised pace");
    assert!((left_s / time_s - 1.0).abs() < 0.1, "{left_s} of {time_s} s");
}

#[test]
fn the_question_about_resuming_says_what_moves_along_which_plan() {
    let mut screen = Screen::held();
    screen.press([tui::Key::Char(' ')]);
    for size in [(120, 36), (80, 24), (60, 16)] {
        let shown = text(&drawn(&screen.model, RICH, size));
        let flat = shown.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(
            flat.contains(
                "Resume? The robot will move. Enter: resume, Esc: cancel. rpf drives the plan on the map, "
            ),
            "{shown}"
        );
        assert!(flat.contains(" m left."), "{shown}");
    }
    screen.model.live.run.planning.plan = None;
    let shown = text(&drawn(&screen.model, RICH, (120, 36)));
    assert!(shown.contains("rpf plans first; then the robot moves."), "{shown}");
}

#[test]
fn parameters_are_offered_only_while_they_can_be_changed() {
    let mut screen = Screen::running();
    let footer = |screen: &Screen| {
        text(&drawn(&screen.model, RICH, (120, 36))).lines().last().unwrap_or_default().to_owned()
    };
    assert!(footer(&screen).contains("p parameters"), "{}", footer(&screen));
    let ended = screen.mission.ended(mission::Outcome::Complete, "path driven");
    screen.hear(RunMsg::Events(vec![ended]));
    assert!(!footer(&screen).contains("p parameters"), "{}", footer(&screen));
}

#[test]
fn a_tether_alarm_says_what_happened_and_where() {
    let mut screen = Screen::running();
    let message = "tether wraps 130° around column 3, limit 120°".to_owned();
    let held = screen.mission.held(HoldReason::Tether { message });
    screen.hear(RunMsg::Events(vec![held]));
    let line = state(&screen);
    assert!(line.starts_with("HELD: tether wraps 130° around column 3; robot at "), "{line}");
}

#[test]
fn the_screen_that_is_open_is_not_offered() {
    let mut screen = crate::overviews::ended().0;
    screen.type_text("3");
    assert!(state(&screen).contains("7: result. 1: home."), "{}", state(&screen));
    screen.type_text("1");
    assert!(state(&screen).contains("7: result.") && !state(&screen).contains("home."), "{}", state(&screen));
}

#[test]
fn a_question_keeps_the_state_of_a_held_robot_at_every_size() {
    for key in ["X", "P", "p", ".", " "] {
        for size in [(120, 36), (80, 24), (60, 16)] {
            let mut screen = Screen::held();
            screen.send(tui::Msg::Resize { width: size.0, height: size.1 });
            let alarms = &mut screen.model.live.run.alarms;
            alarms.raise(
                tui::model::Cause::Disk,
                mission::Severity::Warn,
                "disk space left: 150 MB".into(),
                1.0,
            );
            screen.type_text(key);
            let shown = text(&drawn(&screen.model, RICH, size));
            assert!(shown.contains("HELD by operator"), "{key}\n{shown}");
        }
    }
}

#[test]
fn a_run_that_waits_for_its_position_shows_when_the_time_limit_ends_it() {
    let mut screen = live();
    let held = EventKind::Held { by: HoldReason::PositionLost, resumes: Resumes::WhenCleared };
    let stood = EventKind::Stood { confirmed: true, after_s: 0.2, moved: false };
    hear(&mut screen, [held, EventKind::PositionAwaited { limit_m: 0.3, ends_t_s: 900.0 }, stood]);
    let line = state(&screen);
    assert!(line.contains("Resumes automatically when recovered."), "{line}");
    assert!(line.contains("Otherwise, it ends at T+00:15:00."), "{line}");
    hear(&mut screen, [EventKind::Resumed]);
    assert!(!state(&screen).contains("T+900"), "{}", state(&screen));
}

#[test]
fn the_end_of_a_live_mission_is_good_only_when_the_stop_is_confirmed() {
    let mut screen = live();
    let outcome = mission::Outcome::Complete;
    hear(
        &mut screen,
        [
            EventKind::Sent { drive: None, lease_s: 0.25 },
            EventKind::Ended { outcome, reason: "floor scanned".into() },
        ],
    );
    let line = state(&screen);
    assert!(line.starts_with("DONE: floor scanned. The stop is not confirmed yet."), "{line}");
    hear(&mut screen, [EventKind::Stood { confirmed: false, after_s: 1.0, moved: false }]);
    let line = state(&screen);
    assert!(line.starts_with("DONE: floor scanned. STOP NOT CONFIRMED: go to the vehicle."), "{line}");
    hear(&mut screen, [EventKind::Stood { confirmed: true, after_s: 1.0, moved: false }]);
    let line = state(&screen);
    assert!(line.starts_with("DONE: floor scanned. ") && !line.contains("onfirmed"), "{line}");
}

#[test]
fn the_state_names_only_keys_that_do_something_on_the_screen() {
    use tui::actions::{context::contexts, find};
    let refused = HoldReason::PlanRefused { message: "it would wind the tether".into() };
    let stuck = HoldReason::Stuck { message: "no progress at 2.0, 3.0 m".into() };
    for by in [HoldReason::Operator, HoldReason::PositionLost, refused, stuck] {
        let mut screen = Screen::running();
        let held = screen.mission.held(by.clone());
        screen.hear(RunMsg::Events(vec![held]));
        for (number, has_planner) in [("2", true), ("3", true), ("4", false), ("5", false), ("1", false)] {
            screen.type_text(number);
            let line = state(&screen);
            // The key changes the planner exactly where the line offers it.
            let contexts = contexts(&screen.model);
            let action = find::action_for(&screen.model.console.keys, tui::Key::Char('P'), &contexts);
            assert_eq!(action.is_some(), has_planner, "{by:?} on screen {number}");
            assert!(has_planner || !line.contains("P: "), "{by:?} on screen {number}: {line}");
        }
        // A list takes the keys of the screen.
        screen.type_text("3L");
        assert!(!state(&screen).contains("P: "), "{}", state(&screen));
    }
}

#[test]
fn the_operator_is_in_control_during_every_hold_that_only_an_order_ends() {
    let top =
        |screen: &Screen| text(&drawn(&screen.model, RICH, (120, 36))).lines().next().unwrap().to_owned();
    let mut screen = Screen::held();
    assert!(top(&screen).starts_with(" OPER ‖ HOLD"), "{}", top(&screen));
    // A zone drawn over the hull adds a reason for the hold, but changes nothing about who ends it.
    let zone = screen.mission.held(HoldReason::ZoneBreached { zone: "zone 1".into() });
    screen.hear(RunMsg::Events(vec![zone]));
    assert!(top(&screen).starts_with(" OPER ‖ HOLD"), "{}", top(&screen));
    let mut screen = Screen::running();
    let lost = screen.mission.held_until(HoldReason::PositionLost, Resumes::WhenCleared);
    screen.hear(RunMsg::Events(vec![lost]));
    assert!(top(&screen).starts_with(" AUTO ‖ HOLD"), "{}", top(&screen));
}
