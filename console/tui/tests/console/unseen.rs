//! A question that the operator cannot have read is not answered; a key that stops the robot always
//! counts.

use crate::fixture::Screen;
use mission::{EventKind, HoldReason, Order, Resumes};
use tui::{Effect, Key, KeyPress, Msg, RunMsg, model::Overlay};

/// Presses a key that was read after this frame had been drawn.
fn press(screen: &mut Screen, key: Key, seen: u64) -> Vec<Effect> {
    screen.send(Msg::Key(KeyPress { seen: Some(seen), ..key.into() }))
}

fn moves(effects: &[Effect]) -> bool {
    effects.iter().any(|effect| match effect {
        Effect::Order(order) => *order != Order::Hold,
        Effect::Quit { .. } | Effect::Check { .. } => true,
        _ => false,
    })
}

fn notice(screen: &Screen) -> String {
    screen.model.notice().map(|notice| notice.text.clone()).unwrap_or_default()
}

/// Every question, with the screen on which a key opens it.
fn questions() -> [(fn() -> Screen, Key); 5] {
    [
        (Screen::idle, Key::Char('S')),
        (Screen::held, Key::Char(' ')),
        (Screen::held, Key::Char('.')),
        (Screen::running, Key::Char('X')),
        (Screen::held, Key::Char('X')),
    ]
}

#[test]
fn keys_that_were_typed_ahead_answer_no_question() {
    for (screen, key) in questions() {
        let mut screen = screen();
        screen.send(Msg::Drawn(7));
        let effects = [press(&mut screen, key, 7), press(&mut screen, Key::Enter, 7)].concat();
        assert!(!moves(&effects), "{key}: {effects:?}");
        assert_ne!(screen.model.ui.overlay, Overlay::None, "{key}: the question stays open");
        assert_eq!(notice(&screen), "the question has just appeared; press Enter again", "{key}");
    }
}

#[test]
fn a_key_that_was_read_before_the_question_was_drawn_does_not_count_however_late_it_is_handled() {
    for (screen, key) in questions() {
        let mut screen = screen();
        screen.send(Msg::Drawn(7));
        press(&mut screen, key, 7);
        screen.pass(5.0);
        screen.send(Msg::Drawn(8));
        assert!(!moves(&press(&mut screen, Key::Enter, 7)), "{key}");
    }
}

#[test]
fn a_question_is_answered_once_it_has_been_on_the_screen_for_a_moment() {
    for (screen, key) in questions() {
        let mut screen = screen();
        press(&mut screen, key, 7);
        screen.send(Msg::Drawn(8));
        screen.pass(0.19);
        assert!(!moves(&press(&mut screen, Key::Enter, 8)), "{key}: too early");
        screen.pass(0.02);
        screen.send(Msg::Drawn(9));
        assert!(moves(&press(&mut screen, Key::Enter, 8)), "{key}");
    }
}

#[test]
fn a_key_of_a_script_answers_at_once() {
    for (screen, key) in questions() {
        let mut screen = screen();
        screen.press([key]);
        assert!(moves(&screen.press([Key::Enter])), "{key}");
    }
}

#[test]
fn what_a_key_was_answered_outlasts_the_hold_that_an_earlier_key_caused() {
    let mut screen = Screen::running();
    for key in [Key::Char('X'), Key::Char('b'), Key::Enter] {
        press(&mut screen, key, 0);
    }
    let event = screen.mission.now(EventKind::Held { by: HoldReason::Operator, resumes: Resumes::Never });
    screen.hear(RunMsg::Events(vec![event]));
    assert_ne!(notice(&screen), "");
}

#[test]
fn a_space_that_is_no_key_holds_a_moving_robot_and_does_nothing_else() {
    let mut screen = Screen::running();
    assert_eq!(screen.send(Msg::Stop), [Effect::Order(Order::Hold)]);
    let standing: [fn() -> Screen; 3] = [Screen::opened, Screen::held, Screen::idle];
    for mut screen in standing.map(|made| Box::new(made())) {
        let before = screen.model.clone();
        assert_eq!(screen.send(Msg::Stop), []);
        assert_eq!(screen.model, before);
    }
    // In an input line, a space is text.
    let mut screen = Screen::running();
    screen.type_text(":");
    assert_eq!(screen.send(Msg::Stop), []);
}
