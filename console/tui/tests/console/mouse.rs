//! The mouse, and the cursor on the map.

use crate::fixture::{RICH, Screen};
use crate::screens::{drawn, text};
use ratatui::Terminal;
use ratatui::backend::TestBackend;
use tui::actions::ActionId;
use tui::{Cache, Effect, Key, Mouse, Msg, Target, view_cached};
use world::Point;

/// What lies at a place of the screen.
fn at(screen: &Screen, size: (u16, u16), column: u16, row: u16) -> Target {
    let mut cache = Cache::default();
    let mut terminal = Terminal::new(TestBackend::new(size.0, size.1)).unwrap();
    terminal.draw(|frame| view_cached(&screen.model, &RICH, &mut cache, frame)).unwrap();
    cache.places().target(column, row)
}

fn with_mouse(mut screen: Screen) -> Screen {
    let effects = screen.type_text(":mouse");
    assert_eq!(effects, []);
    assert_eq!(screen.press([Key::Enter]), [Effect::Mouse(true)]);
    screen.send(Msg::Resize { width: 120, height: 36 });
    screen
}

#[test]
fn a_click_reads_the_map_where_it_was_made() {
    let mut screen = with_mouse(Screen::running());
    let Target::Map(place) = at(&screen, (120, 36), 34, 14) else { panic!("the map is there") };
    assert!(place.x.abs() < 0.5 && place.y.abs() < 0.9, "the middle of the tank: {place}");
    screen.send(Msg::Mouse(Mouse::Click(Target::Map(Point::new(9.0, 2.0)))));
    let text = text(&drawn(&screen.model, RICH, (120, 36)));
    assert!(text.contains("cursor 9.00, 2.00 m  r 9.22 m, 13°"), "{text}");
    assert!(text.contains("─ scanned  AE ±"), "{text}");
    screen.press([Key::Esc]);
    assert_eq!(screen.model.ui.cursor, None);
}

#[test]
fn the_wheel_zooms_about_the_pointer_and_dragging_pans() {
    let mut screen = with_mouse(Screen::running());
    let on = Point::new(5.0, -3.0);
    screen.send(Msg::Mouse(Mouse::Wheel { up: true, on: Target::Map(on) }));
    let offset = screen.model.ui.map.offset;
    assert_eq!((screen.model.ui.map.zoom, offset.x, offset.y), (1, 2.5, -1.5));
    screen.send(Msg::Mouse(Mouse::Drag { from: Point::new(1.0, 1.0), to: Point::new(2.0, 1.5) }));
    let offset = screen.model.ui.map.offset;
    assert_eq!((offset.x, offset.y), (1.5, -2.0));
}

#[test]
fn a_click_on_a_key_does_what_the_key_does_and_only_the_keyboard_answers_questions() {
    let mut screen = with_mouse(Screen::held());
    let hold = at(&screen, (120, 36), 2, 35);
    assert_eq!(hold, Target::Key(ActionId::Hold));
    assert_eq!(screen.send(Msg::Mouse(Mouse::Click(hold))), []);
    let asked = screen.model.ui.overlay.clone();
    assert!(matches!(asked, tui::model::Overlay::Confirm(_)));
    for id in [ActionId::Accept, ActionId::Resume, ActionId::Step] {
        assert_eq!(screen.send(Msg::Mouse(Mouse::Click(Target::Key(id)))), []);
    }
    assert_eq!(screen.model.ui.overlay, asked);
}

#[test]
fn without_the_mouse_it_does_nothing() {
    let mut screen = Screen::held();
    let before = screen.model.clone();
    screen.send(Msg::Mouse(Mouse::Click(Target::Key(ActionId::Hold))));
    assert_eq!(screen.model, before);
}

#[test]
fn arrows_move_the_cursor_while_it_is_on_and_the_window_follows_it() {
    let mut screen = Screen::running();
    screen.type_text("zzzi");
    let before = screen.model.ui.cursor.unwrap();
    assert_eq!(before, Point::origin(), "the middle of what is seen");
    screen.press([Key::Right, Key::Up]);
    let after = screen.model.ui.cursor.unwrap();
    assert!(after.x > before.x && after.y > before.y);
    assert_eq!(screen.model.ui.map.offset, world::Vector::zeros());
    screen.press(vec![Key::Left; 400]);
    assert_eq!(screen.model.ui.cursor.map(|cursor| cursor.x), Some(-10.0));
    assert!(screen.model.ui.map.offset.x < -7.0);
}
