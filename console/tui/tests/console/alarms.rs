//! The alarms screen: the operator's actions on alarms.

use crate::fixture::{RICH, Screen};
use crate::screens::{drawn, text};
use crate::sizes;
use mission::event::TetherAlarm;
use mission::{EventKind, HoldReason, Note, Noted, Order, Outcome, Resumes, Severity};
use tui::actions::ActionId;
use tui::actions::keymap::{Binding, Keymap};
use tui::model::alarms::State;
use tui::model::ui::Ask;
use tui::model::{Cause, Overlay};
use tui::{Effect, Health, Key, Measured, Msg, Recording, RunMsg};

const SHOWN: tui::model::Screen = tui::model::Screen::Alarms;
const ENTER: [Key; 1] = [Key::Enter];

fn notice(screen: &Screen) -> &str {
    screen.model.notice().map_or("", |notice| notice.text.as_str())
}

fn shown(screen: &Screen, size: (u16, u16)) -> String {
    let shown = text(&drawn(&screen.model, RICH, size));
    shown.lines().map(|line| line.split_whitespace().collect::<Vec<_>>().join(" ") + "\n").collect()
}

fn hear(screen: &mut Screen, kind: EventKind) {
    let event = screen.mission.now(kind);
    screen.hear(RunMsg::Events(vec![event]));
}

fn pass(screen: &mut Screen, ticks: usize) {
    let wait = screen.mission.wait(ticks);
    screen.hear(RunMsg::Events(wait));
}

/// A run whose position was lost while a station was rejected, with a shelved alarm and some cleared ones.
fn troubled() -> Screen {
    let mut screen = Screen::tethered();
    let near = TetherAlarm::Reel { out_m: 24.6, reel_length_m: 30.0 };
    hear(&mut screen, EventKind::TetherAlarmRaised { alarm: near, reached: false });
    let wait = screen.mission.wait(40);
    screen.hear(RunMsg::Events(wait));
    screen.mission.sigma_m = 0.2;
    hear(&mut screen, EventKind::PositionLost { error_m: 0.49, limit_m: 0.15 });
    hear(&mut screen, EventKind::RangesInconsistent { chi2: 250.0, degrees_of_freedom: 1 });
    let wait = screen.mission.wait(4);
    screen.hear(RunMsg::Events(wait));
    hear(&mut screen, EventKind::Held { by: HoldReason::PositionLost, resumes: Resumes::WhenCleared });
    hear(&mut screen, EventKind::RangesConsistent);
    let shelved = Noted::Shelved {
        alarm: Cause::Station(world::StationId(4)).key(),
        text: String::new(),
        for_s: 1500.0,
        reason: "pump noise".into(),
    };
    screen.model.live.run.alarms.take(&Note { what: shelved, by: Some("lk".into()) }, 0.0);
    let events = screen.mission.planner_fails();
    screen.hear(RunMsg::Events(events[..1].to_vec()));
    let text = screen.model.live.run.alarms.get(&Cause::Planner).expect("an alarm").text.clone();
    let seen = Noted::Acknowledged { alarm: Cause::Planner.key(), text };
    screen.model.live.run.alarms.take(&Note { what: seen, by: Some("lk".into()) }, 0.0);
    screen.type_text("4");
    screen
}

#[test]
fn a_refused_change_of_parameters_is_a_warning_and_no_alarm() {
    let mut screen = Screen::running();
    let refused = screen.mission.change_refused();
    screen.hear(RunMsg::Events(vec![refused]));
    let notice = screen.model.notice().expect("the operator is told");
    assert_eq!(notice.severity, Severity::Warn);
    assert!(notice.text.ends_with("old values stay in effect"), "{}", notice.text);
    let run = &screen.model.live.run;
    assert!(run.alarms.get(&Cause::Planner).is_none() && run.planning.fault.is_none());
}

#[test]
fn alarms() {
    let mut screen = troubled();
    sizes::store("alarms", &mut screen, sizes::is_log);
    screen.press(ENTER);
    sizes::store("alarm_actions", &mut screen, sizes::is_log);
}

#[test]
fn after_the_end_an_alarm_offers_only_what_is_still_possible() {
    for cause in Cause::every() {
        let mut screen = Screen::running();
        screen.model.live.run.alarms.raise(cause.clone(), Severity::Crit, "what is wrong".into(), 1.0);
        screen.type_text("4");
        screen.model.ui.alarm = Some(cause.clone());
        let ended = screen.mission.ended(Outcome::Aborted, "ended by the operator");
        screen.hear(RunMsg::Events(vec![ended]));
        let guide = tui::guide::guide(&cause);
        let shown = shown(&screen, (200, 60));
        for remedy in guide.remedies {
            let words = screen.model.console.keys.spelled(remedy.text);
            let wants_the_mission = matches!(
                remedy.action,
                Some(
                    ActionId::Hold
                        | ActionId::Abort
                        | ActionId::Resume
                        | ActionId::Slower
                        | ActionId::DriveBack
                        | ActionId::Parameters
                        | ActionId::ChoosePlanner
                        | ActionId::FlyUncertified
                )
            ) || words.starts_with("Wait");
            assert!(!(wants_the_mission && shown.contains(&words)), "{cause:?}: {words}\n{shown}");
        }
        assert!(shown.contains("Acknowledge (a)."), "{cause:?}\n{shown}");
    }
}

#[test]
fn the_alarms_of_the_recorder_end_with_the_run() {
    for is_kept in [true, false] {
        let (mut screen, closed) = crate::overviews::ended();
        for cause in [Cause::Recording, Cause::RecorderLag] {
            screen.model.live.run.alarms.raise(cause, Severity::Crit, "what is wrong".into(), 1.0);
        }
        screen.hear(RunMsg::Closed(Box::new(tui::RunResult { is_kept, ..closed })));
        let is_active = |cause| screen.model.live.run.alarms.get(&cause).unwrap().is_active();
        assert_eq!((is_active(Cause::Recording), is_active(Cause::RecorderLag)), (!is_kept, false));
    }
}

#[test]
fn no_text_of_an_alarm_is_cut_where_there_is_room_for_its_panes() {
    for cause in Cause::every() {
        for (width, height) in [(120, 36), (80, 24)] {
            let mut screen = Screen::running();
            screen.send(Msg::Resize { width, height });
            let alarms = &mut screen.model.live.run.alarms;
            alarms.raise(cause.clone(), Severity::Crit, "what is wrong, in about as many words".into(), 1.0);
            screen.type_text("4");
            screen.model.ui.alarm = Some(cause.clone());
            let text = text(&drawn(&screen.model, RICH, (width, height)));
            assert!(!text.contains('…'), "{cause:?}\n{text}");
            let remedies = tui::guide::remedies(&cause, &screen.model.live.run);
            let words: Vec<&str> =
                text.split_whitespace().filter(|word| *word != "││" && *word != "│").collect();
            for sentence in remedies.map(|remedy| screen.model.console.keys.spelled(remedy.text)) {
                let last = sentence.split_whitespace().last().unwrap();
                assert!(words.contains(&last), "{cause:?}: {sentence}\n{text}");
            }
        }
    }
}

#[test]
fn the_selected_alarm_is_acknowledged_then_the_worst_then_all_of_them() {
    let mut screen = troubled();
    let unacknowledged = |screen: &Screen| {
        let open = screen.model.live.run.alarms.open().filter(|alarm| alarm.is_unacknowledged());
        open.map(|alarm| alarm.cause.clone()).collect::<Vec<_>>()
    };
    assert_eq!(unacknowledged(&screen).len(), 4);
    screen.press([Key::Down; 2]);
    assert_eq!(screen.model.ui.alarm, Some(Cause::Contradiction), "those whose cause persists come first");
    screen.type_text("a");
    assert_eq!(notice(&screen), "acknowledged: ranges contradict each other");
    assert!(!unacknowledged(&screen).contains(&Cause::Contradiction));
    assert_eq!(screen.type_text("a"), []);
    assert_eq!(notice(&screen), "the selected alarm needs no acknowledgement; select another");
    assert_eq!(unacknowledged(&screen).len(), 3, "no other alarm is taken instead");
    screen.type_text("3a");
    assert_eq!(unacknowledged(&screen), [Cause::Map, Cause::Tether("reel".into())], "elsewhere the worst");
    screen.type_text("4*");
    assert_eq!(unacknowledged(&screen), []);
    screen.type_text("*");
    assert_eq!(notice(&screen), "no unacknowledged alarms");
}

#[test]
fn an_alarm_is_shelved_with_minutes_and_a_reason_and_comes_back() {
    let mut screen = Screen::held();
    let station = Cause::Station(world::StationId(4));
    screen.type_text("4");
    screen.model.ui.alarm = Some(station.clone());
    let count = screen.model.live.run.alarms.count(Severity::Watch);
    screen.type_text("d61 pump");
    screen.press(ENTER);
    assert!(matches!(&screen.model.ui.overlay, Overlay::Shelve(shelving) if shelving.refusal.is_some()));
    screen.press([Key::Backspace; 7]);
    screen.type_text("15 pump noise");
    screen.press(ENTER);
    assert_eq!(screen.model.ui.overlay, Overlay::None);
    assert_eq!(screen.model.live.run.alarms.count(Severity::Watch), count - 1);
    let t_s = screen.model.live.run.clock.t_s;
    let state = |screen: &Screen| screen.model.live.run.alarms.get(&station).unwrap().state.clone();
    assert!(
        matches!(state(&screen), State::Shelved(shelf) if (shelf.until_s - t_s - 900.0).abs() < 1e-9 && shelf.active)
    );
    let wait = screen.mission.wait(1801);
    screen.hear(RunMsg::Events(wait));
    assert_eq!(state(&screen), State::Unacknowledged, "its time is over");
    screen.type_text("d15 noise");
    screen.press(ENTER);
    screen.type_text("d");
    assert_eq!(state(&screen), State::Unacknowledged, "it was taken back");
}

#[test]
fn an_alarm_that_has_cleared_is_no_reason_to_end_the_mission() {
    let mut screen = troubled();
    let ends = |screen: &Screen| shown(screen, (120, 36)).contains("End the mission");
    assert!(ends(&screen), "{}", shown(&screen, (120, 36)));
    screen.press([Key::Down; 2]);
    assert!(!ends(&screen), "{}", shown(&screen, (120, 36)));
}

#[test]
fn what_is_typed_for_an_alarm_that_cannot_be_shelved_does_not_move_the_robot() {
    let mut screen = Screen::held();
    let station = world::StationId(4);
    hear(&mut screen, EventKind::StationRestored { station });
    screen.type_text("4");
    screen.model.ui.alarm = Some(Cause::Station(station));
    for key in "d10 ".chars() {
        screen.press([Key::Char(key)]);
    }
    screen.press(ENTER);
    let overlay = &screen.model.ui.overlay;
    assert!(matches!(overlay, Overlay::Shelve(shelving) if shelving.refusal.is_some()), "{overlay:?}");
    assert!(matches!(screen.model.ui.screen, SHOWN) && !screen.model.live.run.is_running());
    screen.press([Key::Esc]);
    assert_eq!(screen.model.ui.overlay, Overlay::None);
}

#[test]
fn a_command_shelves_the_named_alarm_or_the_selected_one() {
    let line = |screen: &mut Screen, line: &str| {
        screen.model.console.notice = None;
        screen.type_text(&format!(":{line}"));
        screen.press(ENTER);
        assert_eq!(screen.model.ui.overlay, Overlay::None, "{line}");
        notice(screen).to_owned()
    };
    let cases = [
        ("", "shelve 15m \"pump noise\"", "no alarm is selected; name one (alarm=NAME) or go to 4"),
        ("4", "shelve 61m noise", "must be 1 to 60 minutes"),
        ("4", "shelve 15m", "reason missing; for example: 15 pump noise"),
        ("4", "shelve 15m \"pump noise\"", "shelved for 15 min: station S4 rejected"),
        (
            "",
            "shelve 15m reason=\"pump noise\" alarm=\"station S4 rejected\"",
            "shelved for 15 min: station S4 rejected",
        ),
    ];
    for (keys, typed, said) in cases {
        let mut screen = Screen::held();
        screen.type_text(keys);
        if !keys.is_empty() {
            screen.model.ui.alarm = Some(Cause::Station(world::StationId(4)));
        }
        assert_eq!(line(&mut screen, typed), said, "{typed}");
    }
}

#[test]
fn what_is_critical_or_over_cannot_be_shelved() {
    let mut screen = troubled();
    let refusal = |screen: &Screen| match &screen.model.ui.overlay {
        Overlay::Shelve(shelving) => shelving.refusal.clone(),
        _ => None,
    };
    screen.type_text("d");
    assert_eq!(refusal(&screen).as_deref(), Some("a CRIT alarm cannot be shelved"));
    screen.press([Key::Esc]);
    screen.press([Key::Down; 2]);
    screen.type_text("d");
    assert_eq!(refusal(&screen).as_deref(), Some("cleared alarms are acknowledged (a), not shelved"));
    let said = shown(&screen, (80, 24));
    assert!(said.contains("REFUSED: cleared alarms are acknowledged"), "{said}");
}

#[test]
fn a_reason_has_spaces_and_ctrl_c_holds_while_it_is_typed() {
    let mut screen = Screen::running();
    assert_eq!(screen.type_text("4d15 echo of the wall"), []);
    assert_eq!(screen.press([Key::Ctrl('c')]), [Effect::Order(Order::Hold)]);
    screen.press(ENTER);
    let shelved = |alarm: &&tui::model::Alarm| matches!(alarm.state, State::Shelved(_));
    assert_eq!(screen.model.live.run.alarms.list().iter().filter(shelved).count(), 1);
}

#[test]
fn the_actions_of_an_alarm_are_run_by_their_digits_and_what_moves_asks() {
    let mut screen = Screen::running();
    let events = screen.mission.planner_fails();
    screen.hear(RunMsg::Events(events));
    screen.type_text("4");
    screen.press(ENTER);
    assert!(matches!(screen.model.ui.overlay, Overlay::Remedies { .. }));
    assert_eq!(screen.model.ui.screen, SHOWN);
    assert_eq!(screen.type_text("1"), [], "it asks first");
    assert_eq!(screen.model.ui.overlay, Overlay::Confirm(Ask::Resume));
    screen.press([Key::Esc, Key::Enter, Key::Down, Key::Enter]);
    assert!(matches!(screen.model.ui.overlay, Overlay::Planners { .. }), "the second one, by Enter");
    screen.press([Key::Esc, Key::Enter]);
    screen.type_text("9");
    assert_eq!(screen.model.ui.screen, SHOWN, "a digit that is not an action does nothing");
    assert!(matches!(screen.model.ui.overlay, Overlay::Remedies { .. }));
}

#[test]
fn the_actions_of_an_alarm_stand_beside_the_keys_that_run_them() {
    let mut screen = troubled();
    let binding = Binding { action: "second-action".into(), keys: vec![Key::F(2)] };
    screen.model.console.keys = Keymap::new(&[], &[binding]).0;
    screen.send(Msg::Resize { width: 120, height: 36 });
    let shown = text(&drawn(&screen.model, RICH, (120, 36)));
    assert!(shown.contains(" F2 "), "{shown}");
}

#[test]
fn keeping_the_robot_held_holds_and_never_asks_to_resume() {
    let mut screen = troubled();
    let shown = |screen: &Screen| text(&drawn(&screen.model, RICH, (80, 24)));
    screen.press(ENTER);
    let resuming = shown(&screen);
    assert!(
        resuming.contains("· Wait: the mission resumes automatically"),
        "advice has no number\n{resuming}"
    );
    assert_eq!(screen.type_text("1"), [Effect::Order(Order::Hold)]);
    let events = screen.mission.obeyed(Order::Hold);
    screen.hear(RunMsg::Events(events));
    screen.press(ENTER);
    let held = shown(&screen);
    assert!(!held.contains("resumes automatically") && !held.contains("Stay held"), "{held}");
}

#[test]
fn a_station_is_excluded_and_an_alarm_acknowledged_from_the_list_of_actions() {
    let mut screen = Screen::running();
    screen.type_text("4");
    let station = Cause::Station(world::StationId(4));
    screen.model.ui.alarm = Some(station.clone());
    screen.press(ENTER);
    let excluded = Order::UseStation { station: world::StationId(4), used: false, by: None };
    assert_eq!(screen.type_text("3"), [Effect::Order(excluded)]);
    screen.model.console.preferences.operator = Some("lk".into());
    screen.press(ENTER);
    screen.type_text("4");
    let alarm = screen.model.live.run.alarms.get(&station).unwrap();
    assert_eq!(alarm.state, State::Acknowledged);
    let by = alarm.acknowledged.as_ref().and_then(|seen| seen.by.as_deref());
    assert_eq!(by, Some("lk"));
    screen.send(Msg::Resize { width: 120, height: 36 });
    let shown = text(&drawn(&screen.model, RICH, (120, 36)));
    assert!(shown.contains("at T+00:16:07, by lk") && shown.contains("ACTIVE, ack lk"), "{shown}");
}

#[test]
fn an_alarm_that_has_cleared_shows_its_peak_and_no_stale_value() {
    let mut screen = Screen::tethered();
    let near = |out_m| TetherAlarm::Reel { out_m, reel_length_m: 30.0 };
    hear(&mut screen, EventKind::TetherAlarmRaised { alarm: near(25.3), reached: false });
    pass(&mut screen, 3);
    hear(&mut screen, EventKind::TetherAlarmCleared { alarm: near(25.3) });
    pass(&mut screen, 11);
    screen.type_text("4");
    screen.model.ui.alarm = Some(Cause::Tether("reel".into()));
    let size = (120, 36);
    screen.send(Msg::Resize { width: size.0, height: size.1 });
    let shown = text(&drawn(&screen.model, RICH, size));
    let row = shown.lines().find(|line| line.contains("reel nearly out") && line.contains('>')).unwrap();
    let figures: Vec<&str> = row.split("reel nearly out").nth(1).unwrap().split_whitespace().collect();
    assert_eq!(figures, ["ok", "25.3", "m", "24.0", "m", "│"], "the limit is that of the alarm\n{shown}");
}

#[test]
fn a_reel_is_nearly_out_only_beyond_what_a_certified_plan_promises() {
    let reel = Cause::Tether("reel".into());
    let mut screen = Screen::tethered();
    let mut certified = screen.mission.certified(&[]);
    if let EventKind::Certified { certificate, .. } = &mut certified.kind {
        certificate.tether_length_max_m = 26.0;
    }
    screen.hear(RunMsg::Events(vec![certified]));
    let out = |screen: &mut Screen, out_m: f64| {
        for _ in 0..20 {
            screen.mission.wait(1);
            let mut cable = screen.mission.cable();
            if let EventKind::Tethered { paid_out_m, .. } = &mut cable.kind {
                *paid_out_m = Some(out_m);
            }
            screen.hear(RunMsg::Events(vec![cable]));
        }
    };
    let is_active =
        |screen: &Screen| screen.model.live.run.alarms.get(&reel).is_some_and(tui::model::Alarm::is_active);
    let near = TetherAlarm::Reel { out_m: 25.3, reel_length_m: 30.0 };
    hear(&mut screen, EventKind::TetherAlarmRaised { alarm: near, reached: false });
    out(&mut screen, 25.3);
    assert!(!is_active(&screen), "the plan needs 26 m");
    out(&mut screen, 27.5);
    assert!(is_active(&screen), "26 m, 2 % and 0.5 m are exceeded");
    let shown = text(&{
        screen.type_text("4");
        drawn(&screen.model, RICH, (120, 36))
    });
    let row = shown.lines().find(|line| line.contains("reel nearly out") && line.contains('>')).unwrap();
    assert!(row.contains("27.5 m") && row.contains("27.0 m"), "the limit is that of the alarm\n{shown}");
    out(&mut screen, 25.3);
    assert!(!is_active(&screen), "it is back within the promise");
    // A plan that is not certified promises nothing.
    let refused = vec![screen.mission.certified(&["collision"])];
    screen.hear(RunMsg::Events(refused));
    out(&mut screen, 25.3);
    assert!(is_active(&screen));
    let empty = TetherAlarm::Reel { out_m: 30.0, reel_length_m: 30.0 };
    hear(&mut screen, EventKind::TetherAlarmRaised { alarm: empty, reached: true });
    assert_eq!(screen.model.live.run.alarms.get(&reel).unwrap().severity, Severity::Crit);
}

#[test]
fn the_place_of_an_alarm_is_shown_in_the_middle_of_the_map() {
    let mut screen = Screen::running();
    screen.type_text("4");
    screen.model.ui.alarm = Some(Cause::Station(world::StationId(4)));
    screen.type_text("m");
    let station = crate::fixture::world().stations[3].position;
    assert_eq!(screen.model.ui.screen, tui::model::Screen::Mission);
    assert!((screen.model.ui.map_center(world::Point::origin(), None) - station).norm() < 1e-9);
    assert!(notice(&screen).contains("station S4 rejected"));
    screen.type_text("q");
    assert_eq!(screen.model.ui.screen, SHOWN);
}

#[test]
fn figures_follow_their_alarm_while_its_cause_persists() {
    let mut screen = troubled();
    let now = |screen: &Screen, cause: &Cause| {
        screen
            .model
            .live
            .run
            .alarms
            .get(cause)
            .and_then(|alarm| alarm.reading.clone())
            .unwrap_or_default()
            .now
    };
    let before = now(&screen, &Cause::PositionLost);
    let wait = screen.mission.wait(6);
    screen.hear(RunMsg::Events(wait));
    assert_ne!(now(&screen, &Cause::PositionLost), before);
    assert_eq!(now(&screen, &Cause::Contradiction), "χ² 250");
    hear(&mut screen, EventKind::PositionRegained { error_m: 0.1 });
    let after = now(&screen, &Cause::PositionLost);
    let wait = screen.mission.wait(6);
    screen.hear(RunMsg::Events(wait));
    assert_eq!(now(&screen, &Cause::PositionLost), after, "it is over");
}

#[test]
fn what_the_console_measures_of_itself_becomes_an_alarm_after_its_delay() {
    let mut screen = Screen::idle();
    let active = |screen: &Screen, cause: Cause| {
        screen.model.live.run.alarms.get(&cause).is_some_and(tui::model::Alarm::is_active)
    };
    let slow = |response_ms| Msg::Measured(Measured::Screen { response_ms, skipped: 0 });
    screen.send(slow(Some(40.0)));
    assert_eq!(screen.model.wakes_at_mono_s(), None, "quick enough while the robot stands");
    screen.send(slow(Some(140.0)));
    assert!(!active(&screen, Cause::Response));
    assert!(screen.model.wakes_at_mono_s().is_some(), "it is looked at again");
    screen.pass(2.5);
    screen.send(slow(Some(140.0)));
    assert!(active(&screen, Cause::Response));
    for _ in 0..2 {
        screen.pass(6.0);
        screen.send(slow(None));
    }
    assert!(!active(&screen, Cause::Response));
    assert_eq!(screen.model.wakes_at_mono_s(), None);
    screen.send(Msg::Measured(Measured::Disk(100 << 20)));
    assert!(active(&screen, Cause::Disk));
    screen.send(Msg::Measured(Measured::Screen { response_ms: None, skipped: 199 }));
    assert!(active(&screen, Cause::Frames));
    let lag =
        |recorder_lag| RunMsg::Health(Health { recording: Recording::On, recorder_lag, ..Health::default() });
    screen.hear(lag(5000));
    screen.pass(1.5);
    screen.hear(lag(5000));
    assert!(active(&screen, Cause::RecorderLag));
}

#[test]
fn a_limit_is_stricter_while_the_robot_moves() {
    let mut screen = Screen::running();
    let slow = Msg::Measured(Measured::Screen { response_ms: Some(40.0), skipped: 50 });
    screen.send(slow.clone());
    screen.pass(2.5);
    screen.send(slow);
    for cause in [Cause::Response, Cause::Frames] {
        let alarm = screen.model.live.run.alarms.get(&cause);
        assert!(alarm.is_some_and(tui::model::Alarm::is_active), "{cause:?}");
    }
}

#[test]
fn an_alarm_of_the_console_stays_when_another_run_is_opened() {
    let mut screen = Screen::idle();
    screen.send(Msg::Measured(Measured::Disk(100 << 20)));
    screen.model.live.run = tui::model::Run::default();
    screen.send(Msg::Measured(Measured::Disk(99 << 20)));
    assert_eq!(screen.model.live.run.alarms.count(Severity::Warn), 1);
}

#[test]
fn the_same_key_acknowledges_an_alarm_on_every_screen() {
    for digit in ["1", "2", "3", "4", "5", "6", "7", "8"] {
        let mut screen = troubled();
        let waiting = screen.model.live.run.alarms.open().filter(|alarm| alarm.is_unacknowledged()).count();
        screen.type_text(digit);
        screen.type_text("a");
        let left = screen.model.live.run.alarms.open().filter(|alarm| alarm.is_unacknowledged()).count();
        assert_eq!(left, waiting - 1, "screen {digit}");
    }
}

#[test]
fn the_position_error_is_marked_while_the_ranges_contradict_each_other() {
    let mut screen = Screen::running();
    screen.type_text("3");
    for size in [(120, 36), (80, 24)] {
        assert!(!shown(&screen, size).contains(" m, NOT RELIABLE"));
    }
    hear(&mut screen, EventKind::RangesInconsistent { chi2: 250.0, degrees_of_freedom: 1 });
    for size in [(120, 36), (80, 24)] {
        screen.send(Msg::Resize { width: size.0, height: size.1 });
        assert!(shown(&screen, size).contains(" m, NOT RELIABLE"), "{size:?}\n{}", shown(&screen, size));
    }
    hear(&mut screen, EventKind::RangesConsistent);
    assert!(!shown(&screen, (80, 24)).contains(" m, NOT RELIABLE"));
}

#[test]
fn what_passes_within_its_delay_is_an_event_and_no_alarm() {
    let mut screen = Screen::running();
    let raised = |screen: &Screen, cause: Cause| screen.model.live.run.alarms.get(&cause).is_some();
    hear(&mut screen, EventKind::RangesInconsistent { chi2: 250.0, degrees_of_freedom: 1 });
    pass(&mut screen, 2);
    hear(&mut screen, EventKind::RangesConsistent);
    pass(&mut screen, 10);
    assert!(!raised(&screen, Cause::Contradiction), "it had no effect on the robot");
    screen.type_text("5/contradict");
    screen.press(ENTER);
    assert_eq!(screen.model.ui.events.matches.len(), 1, "it is an event");
    hear(&mut screen, EventKind::RangesInconsistent { chi2: 250.0, degrees_of_freedom: 1 });
    let held = screen.mission.held_until(HoldReason::RangesInconsistent, Resumes::WhenCleared);
    screen.hear(RunMsg::Events(vec![held]));
    let alarm = screen.model.live.run.alarms.get(&Cause::Contradiction).expect("the robot is held for it");
    assert_eq!((alarm.severity, &alarm.state), (Severity::Crit, &State::Unacknowledged));
}

#[test]
fn an_alarm_says_that_the_robot_is_held_only_while_it_is() {
    let shown = |screen: &Screen, cause: &Cause| {
        let run = &screen.model.live.run;
        run.alarms.get(cause).map(|alarm| tui::guide::effect(alarm, run)).expect("an alarm")
    };
    for cause in Cause::every() {
        let mut screen = Screen::running();
        let alarms = &mut screen.model.live.run.alarms;
        alarms.raise(cause.clone(), Severity::Crit, "what is wrong".into(), 1.0);
        let driving = shown(&screen, &cause);
        assert!(!driving.contains("The robot is held until"), "{cause:?}: {driving}");
        let held = screen.mission.held(HoldReason::Operator);
        screen.hear(RunMsg::Events(vec![held]));
        let holds = !tui::guide::guide(&cause).holds.is_empty();
        assert_eq!(shown(&screen, &cause).starts_with("The robot is held"), holds, "{cause:?}");
        screen.model.live.run.about.as_mut().expect("a run").mission.live = true;
        assert_eq!(
            shown(&screen, &cause).starts_with("The robot has been commanded to stop."),
            holds,
            "{cause:?}"
        );
        let waits = |screen: &Screen| {
            let run = &screen.model.live.run;
            tui::guide::remedies(&cause, run).any(|remedy| remedy.text.contains("resumes automatically"))
        };
        assert!(!waits(&screen), "{cause:?}: only the operator ends this hold");
    }
}

#[test]
fn a_refused_plan_is_no_critical_alarm_while_another_one_is_made() {
    let mut screen = Screen::tethered();
    let refused = screen.mission.certified(&["hooked around C3"]);
    screen.hear(RunMsg::Events(vec![refused]));
    assert_eq!(screen.model.live.run.alarms.count(Severity::Crit), 0);
    let refused = screen.mission.plan_refused();
    screen.hear(RunMsg::Events(refused));
    assert_eq!(screen.model.live.run.alarms.count(Severity::Crit), 1);
}

#[test]
fn the_alarm_whose_actions_are_open_stays_selected() {
    let mut screen = Screen::tethered();
    screen.model.ui.go(SHOWN);
    screen.mission.sigma_m = 0.2;
    hear(&mut screen, EventKind::RangesInconsistent { chi2: 250.0, degrees_of_freedom: 1 });
    pass(&mut screen, 40);
    screen.press(ENTER);
    let near = TetherAlarm::NoReturnPath;
    hear(&mut screen, EventKind::TetherAlarmRaised { alarm: near, reached: true });
    hear(&mut screen, EventKind::RangesConsistent);
    pass(&mut screen, 40);
    assert_eq!(screen.model.live.run.alarms.table()[0].cause, Cause::Tether("return path".into()));
    assert_eq!(screen.model.selected_alarm().unwrap().cause, Cause::Contradiction);
    screen.press([Key::Esc]);
    assert_eq!(
        screen.model.selected_alarm().unwrap().cause,
        Cause::Contradiction,
        "after the list is closed, too"
    );
}

#[test]
fn an_obstacle_that_scans_do_not_show_raises_an_alarm_at_its_place() {
    let mut screen = Screen::tethered();
    let about = screen.model.live.run.about.as_ref().unwrap();
    let drawn = about.world.obstacles.iter().find(|obstacle| obstacle.known).unwrap().clone();
    hear(&mut screen, EventKind::NotThere { id: drawn.id, name: drawn.name.clone(), scans: 40 });
    let alarm = screen.model.live.run.alarms.get(&Cause::NotThere(drawn.name.clone())).unwrap();
    assert_eq!((alarm.severity, alarm.place), (Severity::Warn, Some(drawn.shape.center())));
    assert!(alarm.text.contains("40 scans went through its place"), "{}", alarm.text);
    screen.model.ui.go(SHOWN);
    assert!(shown(&screen, (120, 36)).contains("Correct the drawing"), "{}", shown(&screen, (120, 36)));
}

#[test]
fn the_numbers_of_an_open_list_of_actions_keep_their_actions() {
    let mut screen = Screen::running();
    screen.send(Msg::Resize { width: 120, height: 36 });
    let first =
        |cause: &Cause| tui::guide::remedies(cause, &screen.model.live.run).find_map(|remedy| remedy.action);
    let cause =
        Cause::every().into_iter().find(|cause| first(cause) == Some(ActionId::Hold)).expect("a cause");
    let alarms = &mut screen.model.live.run.alarms;
    alarms.raise(cause.clone(), Severity::Warn, "what is wrong".into(), 1.0);
    screen.model.ui.go(SHOWN);
    screen.model.ui.alarm = Some(cause);
    screen.press(ENTER);
    let numbered = |screen: &Screen| {
        let text = text(&drawn(&screen.model, RICH, (120, 36)));
        let rows = text.lines().filter_map(|line| line.rsplit_once("││").map(|(_, right)| right.to_owned()));
        let is_numbered = |row: &String| {
            row.trim_start_matches([' ', '>']).starts_with(|digit: char| digit.is_ascii_digit())
        };
        rows.filter(is_numbered).collect::<Vec<_>>()
    };
    let before = numbered(&screen);
    assert!(before[0].contains("HOLD the robot"), "{before:?}");
    let held = screen.mission.held(HoldReason::Operator);
    screen.hear(RunMsg::Events(vec![held]));
    assert_eq!(numbered(&screen), before);
    assert_eq!(screen.type_text("1"), []);
    assert_eq!(notice(&screen), "already held");
    assert!(matches!(screen.model.ui.overlay, Overlay::Remedies { .. }), "the list stays open");
    screen.press([Key::Esc, Key::Enter]);
    assert_ne!(numbered(&screen), before, "opened again, it has the actions of a hold");
}

#[test]
fn every_key_of_the_screen_works_while_the_list_of_actions_is_open() {
    let mut screen = troubled();
    screen.press(ENTER);
    let Overlay::Remedies { cause, .. } = &screen.model.ui.overlay else { panic!("the list must be open") };
    let cause = cause.clone();
    let effects = screen.type_text("a");
    let is_noted = |effect: &Effect| matches!(effect, Effect::Order(Order::Note(note)) if matches!(&note.what, Noted::Acknowledged { alarm, .. } if *alarm == cause.key()));
    assert!(effects.iter().any(is_noted), "{effects:?}");
    assert_eq!(screen.model.ui.overlay, Overlay::None);
}

#[test]
fn a_digit_beyond_the_actions_shows_its_screen_and_one_among_them_runs_its_action() {
    let mut screen = troubled();
    screen.press(ENTER);
    let Overlay::Remedies { steps, .. } = &mut screen.model.ui.overlay else {
        panic!("the list must be open")
    };
    steps.truncate(2);
    let before = screen.clone();
    for (digit, shown) in [("3", tui::model::Screen::Mission), ("6", tui::model::Screen::Review)] {
        let mut screen = before.clone();
        screen.type_text(digit);
        assert_eq!((screen.model.ui.screen, &screen.model.ui.overlay), (shown, &Overlay::None), "{digit}");
    }
    let mut screen = before;
    screen.type_text("1");
    assert_eq!(screen.model.ui.screen, SHOWN, "the first action runs");
}

#[test]
fn the_alarm_of_an_excluded_station_names_the_order_and_not_an_echo() {
    let mut screen = Screen::running();
    let excluded = screen.mission.excluded();
    screen.hear(RunMsg::Events(vec![excluded]));
    let station = world::StationId(4);
    let fix = screen.model.live.run.position.fix.as_mut().unwrap();
    fix.excluded = vec![(station, positioning::Exclusion::ByOrder)];
    screen.type_text("4");
    screen.model.ui.alarm = Some(Cause::Station(station));
    let shown = text(&drawn(&screen.model, RICH, (120, 36)));
    for words in
        ["station S4 excluded", "An operator excluded the station.", ":include", "Use station S4 again"]
    {
        assert!(shown.contains(words), "{words}\n{shown}");
    }
    assert!(!shown.contains("echo") && !shown.contains("as soon as its"), "{shown}");
    // The other reasons have advice of their own.
    let fix = screen.model.live.run.position.fix.as_mut().unwrap();
    fix.excluded = vec![(station, positioning::Exclusion::Silent)];
    let shown = text(&drawn(&screen.model, RICH, (120, 36)));
    assert!(shown.contains("station S4 rejected") && shown.contains("was not heard"), "{shown}");
}
