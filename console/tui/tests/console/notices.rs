//! A notice to the operator covers nothing: neither the state, nor a question, nor a pane.

use crate::fixture::{PLAIN, Screen};
use crate::screens::{drawn, text};
use mission::{EventKind, HoldReason, Order, Resumes};
use tui::{Key, Msg, RunMsg};

const SIZES: [(u16, u16); 5] = [(200, 60), (120, 36), (80, 24), (60, 16), (40, 12)];

fn shown(screen: &Screen, size: (u16, u16)) -> String {
    text(&drawn(&screen.model, PLAIN, size))
}

fn hear(screen: &mut Screen, kind: EventKind) {
    let event = screen.mission.now(kind);
    screen.hear(RunMsg::Events(vec![event]));
}

#[test]
fn the_state_stays_while_something_is_said() {
    for size in SIZES {
        let mut screen = Screen::held();
        screen.send(Msg::Resize { width: size.0, height: size.1 });
        screen.press([Key::F(9)]);
        let shown = shown(&screen, size);
        assert!(shown.contains("HELD by operator"), "{size:?}\n{shown}");
        assert!(shown.contains("F9 does nothing here"), "{size:?}\n{shown}");
    }
}

#[test]
fn a_question_stays_while_something_is_said() {
    for size in SIZES {
        let mut screen = Screen::held();
        screen.send(Msg::Resize { width: size.0, height: size.1 });
        screen.press([Key::Char(' ')]);
        let text = "planner rpf answered 3 ticks late".to_owned();
        screen.send(Msg::Notice { severity: mission::Severity::Watch, text });
        let shown = shown(&screen, size);
        assert!(shown.contains("Resume? The robot will move. Enter:"), "{size:?}\n{shown}");
        assert!(shown.contains("Planner rpf answered 3 ticks late"), "{size:?}\n{shown}");
    }
}

#[test]
fn a_long_message_takes_more_rows_and_leaves_the_state_and_the_keys() {
    let mut screen = Screen::held();
    let text = format!("written: {}/events.jsonl", "folder/".repeat(60));
    screen.send(Msg::Notice { severity: mission::Severity::Info, text });
    for size in SIZES {
        let shown = shown(&screen, size);
        assert!(shown.contains("HELD by operator") && shown.contains("Written: "), "{size:?}\n{shown}");
        assert!(shown.contains("resume"), "{size:?}\n{shown}");
    }
}

#[test]
fn a_long_message_covers_no_certificate() {
    let mut screen = Screen::tethered();
    let text = format!("written: {}/events.jsonl", "folder/".repeat(60));
    for (key, size) in [("2", (120, 36)), ("3", (120, 36)), ("2", (200, 60)), ("3", (80, 24))] {
        screen.type_text(key);
        screen.send(Msg::Resize { width: size.0, height: size.1 });
        let before = shown(&screen, size);
        screen.send(Msg::Notice { severity: mission::Severity::Info, text: text.clone() });
        let after = shown(&screen, size);
        assert!(after.contains("Written: "), "{after}");
        for word in ["certified", "CLEAR"] {
            let count = |shown: &str| shown.matches(word).count();
            assert_eq!(count(&after), count(&before), "{word} {key} {size:?}\n{before}\n{after}");
        }
        screen.pass(60.0);
    }
}

#[test]
fn a_hold_and_a_new_critical_alarm_take_what_was_said_before_away() {
    let say = |screen: &mut Screen| {
        screen.send(Msg::Notice { severity: mission::Severity::Info, text: "written".into() });
        assert!(screen.model.notice().is_some());
    };
    // HOLD by a key, before the mission has answered.
    let mut screen = Screen::running();
    say(&mut screen);
    screen.press([Key::Char(' ')]);
    assert_eq!(screen.model.notice(), None);
    say(&mut screen);
    hear(&mut screen, EventKind::Held { by: HoldReason::Operator, resumes: Resumes::Never });
    assert_eq!(screen.model.notice(), None);
    // A hold for another reason.
    say(&mut screen);
    hear(&mut screen, EventKind::Held { by: HoldReason::PositionLost, resumes: Resumes::WhenCleared });
    assert_eq!(screen.model.notice(), None);
    // A critical alarm, which shows its own notice.
    let mut screen = Screen::running();
    hear(&mut screen, EventKind::PositionLost { error_m: 0.5, limit_m: 0.15 });
    say(&mut screen);
    let lasts = screen.mission.wait(3);
    screen.hear(RunMsg::Events(lasts));
    assert_eq!(screen.model.notice(), None);
    // Less than that takes nothing away.
    say(&mut screen);
    let wait = screen.mission.wait(3);
    screen.hear(RunMsg::Events(wait));
    hear(&mut screen, EventKind::Ordered { order: Order::Plan });
    assert!(screen.model.notice().is_some());
}

#[test]
fn that_a_key_is_not_assigned_is_said_for_two_seconds() {
    let mut screen = Screen::held();
    screen.press([Key::F(9)]);
    screen.pass(1.9);
    assert!(screen.model.notice().is_some());
    screen.pass(0.2);
    assert_eq!(screen.model.notice(), None);
}
