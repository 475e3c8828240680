//! A key that is held down neither confirms a question nor moves the robot.

use crate::fixture::Screen;
use mission::{Order, StepTo};
use std::time::Duration;
use tui::{Effect, Key, KeyPress, Msg, model::Overlay};

/// Presses a key again after this many milliseconds, and lets the time pass.
fn again(screen: &mut Screen, key: Key, after_ms: u64) -> Vec<Effect> {
    let mut effects = pass(screen, after_ms);
    let since_same = Some(Duration::from_millis(after_ms));
    effects.extend(screen.send(Msg::Key(KeyPress { since_same, ..key.into() })));
    effects
}

/// Lets time pass as the console does: when it is known whether a key was held, the model is told.
fn pass(screen: &mut Screen, ms: u64) -> Vec<Effect> {
    let mut effects = Vec::new();
    for _ in 0..ms {
        screen.pass(0.001);
        if screen.model.has_settled() {
            effects.extend(screen.send(Msg::Settled));
        }
    }
    effects
}

/// Holds a key down as a keyboard does: once, after a while for the second time, and then again and again.
fn hold_down(screen: &mut Screen, key: Key, first_ms: u64) -> Vec<Effect> {
    let mut effects = screen.press([key]);
    effects.extend(again(screen, key, first_ms));
    for _ in 0..40 {
        effects.extend(again(screen, key, 33));
    }
    effects.extend(pass(screen, 3000));
    effects
}

fn moves(effects: &[Effect]) -> Vec<&Order> {
    effects
        .iter()
        .filter_map(|effect| match effect {
            Effect::Order(Order::Note(_)) => None,
            Effect::Order(order) => Some(order),
            _ => None,
        })
        .collect()
}

#[test]
fn a_held_step_key_opens_the_line_and_steps_nothing() {
    for first_ms in [33, 250, 500, 660, 1500] {
        let mut screen = Screen::held();
        let effects = hold_down(&mut screen, Key::Char('.'), first_ms);
        assert_eq!(moves(&effects), Vec::<&Order>::new(), "{first_ms} ms");
        assert_eq!(screen.model.ui.overlay, Overlay::Stepping);
    }
}

#[test]
fn a_step_key_that_is_pressed_steps_once() {
    let mut screen = Screen::held();
    screen.press([Key::Char('.')]);
    // A press long after the first one takes effect at once.
    assert_eq!(moves(&again(&mut screen, Key::Char('.'), 5000)), [&Order::Step]);
    screen.model.live.asked = None;
    // A press soon after the first one takes effect once no repeat has followed.
    assert_eq!(moves(&again(&mut screen, Key::Char('.'), 600)), Vec::<&Order>::new());
    assert_eq!(moves(&pass(&mut screen, 299)), Vec::<&Order>::new());
    assert_eq!(moves(&pass(&mut screen, 2)), [&Order::Step]);
    screen.model.live.asked = None;
    // If another key was pressed in between, the press is not a repeat.
    assert_eq!(moves(&screen.press([Key::Char('}')])), [&Order::StepTo(StepTo::LaneEnd)]);
    screen.model.live.asked = None;
    assert_eq!(moves(&screen.press([Key::Enter])), [&Order::Step]);
}

#[test]
fn another_key_that_is_held_in_the_open_line_steps_once_and_no_more() {
    let keys = [
        (Key::Enter, Order::Step),
        (Key::Char('}'), Order::StepTo(StepTo::LaneEnd)),
        (Key::Char(']'), Order::StepTo(StepTo::Event)),
    ];
    for (key, step) in keys {
        for first_ms in [33, 500, 1000] {
            let mut screen = Screen::held();
            screen.press([Key::Char('.')]);
            let mut effects = screen.press([key]);
            screen.model.live.asked = None;
            effects.extend(again(&mut screen, key, first_ms));
            for _ in 0..40 {
                effects.extend(again(&mut screen, key, 33));
            }
            effects.extend(pass(&mut screen, 1000));
            assert_eq!(moves(&effects), [&step], "{key} after {first_ms} ms");
        }
    }
}

#[test]
fn a_held_enter_does_not_answer_the_question_that_it_has_opened() {
    for first_ms in [33, 500, 1000] {
        for line in ["start", "resume", "end"] {
            let mut screen = if line == "start" { Screen::idle() } else { Screen::held() };
            screen.type_text(&format!(":{line}"));
            let effects = hold_down(&mut screen, Key::Enter, first_ms);
            assert!(
                moves(&effects).into_iter().all(|order| *order == Order::Hold),
                "{line} after {first_ms} ms: {effects:?}"
            );
            assert!(screen.model.ui.overlay.is_question(), "{line}: it is still asked");
            assert!(!screen.model.live.preflight.is_starting);
        }
    }
}

#[test]
fn whatever_stops_the_robot_takes_back_a_press_that_waits() {
    for stop in [Key::Char(' '), Key::Ctrl('c')] {
        let mut screen = Screen::held();
        screen.press([Key::Char('.')]);
        again(&mut screen, Key::Char('.'), 600);
        screen.press([stop]);
        assert_eq!(moves(&pass(&mut screen, 1000)), Vec::<&Order>::new());
    }
    // So does a question that is not open any more.
    let mut screen = Screen::held();
    screen.press([Key::Char('.')]);
    again(&mut screen, Key::Char('.'), 600);
    screen.model.ui.overlay = Overlay::None;
    assert_eq!(moves(&pass(&mut screen, 1000)), Vec::<&Order>::new());
}

#[test]
fn keys_that_move_nothing_repeat_as_before_and_ctrl_c_twice_is_heard() {
    let mut screen = Screen::held();
    screen.press([Key::Ctrl('c')]);
    again(&mut screen, Key::Ctrl('c'), 150);
    assert_eq!(screen.model.ui.overlay, Overlay::Quit);
    let mut screen = Screen::running();
    screen.type_text("z");
    for _ in 0..3 {
        again(&mut screen, Key::Char('z'), 33);
    }
    assert_eq!(screen.model.ui.map.zoom, 4);
}
