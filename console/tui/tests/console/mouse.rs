//! The mouse, and the cursor on the map.

use crate::fixture::{RICH, Screen, listed};
use crate::screens::{drawn, text};
use ratatui::Terminal;
use ratatui::backend::TestBackend;
use tui::actions::ActionId;
use tui::model::Overlay;
use tui::model::home::{Found, HomeList};
use tui::{Cache, Effect, Key, Mouse, Msg, Rows, Target, view_cached};
use world::Point;

/// The screen element at a position on the screen.
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
    let Target::Map(place) = at(&screen, (120, 36), 34, 13) else { panic!("the map is there") };
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
    assert!(matches!(asked, Overlay::Confirm(_)));
    for id in [ActionId::Accept, ActionId::Resume, ActionId::Step] {
        assert_eq!(screen.send(Msg::Mouse(Mouse::Click(Target::Key(id)))), []);
    }
    assert_eq!(screen.model.ui.overlay, asked);
}

/// Where a line of a list is on a screen of 120 columns and 36 rows, and the click on it.
fn row(screen: &Screen, list: Rows, index: usize) -> Msg {
    let places = (0..36).flat_map(|y| (0..120).map(move |x| (x, y)));
    let wanted = Target::Row(list, index);
    let found = places.map(|(x, y)| at(screen, (120, 36), x, y)).find(|target| *target == wanted);
    Msg::Mouse(Mouse::Click(found.unwrap_or_else(|| panic!("no {wanted:?}"))))
}

#[test]
fn a_click_selects_a_line_and_a_second_one_opens_it() {
    let mut screen = with_mouse(Screen::held());
    let scenarios = vec![listed("one", None), listed("two", None)];
    screen.send(Msg::Found(Box::new(Found { scenarios, ..Found::default() })));
    screen.type_text("1");
    let click = row(&screen, Rows::Scenarios, 1);
    assert_eq!((screen.send(click.clone()), screen.model.home.scenario), (vec![], 1));
    assert_eq!(screen.send(click), [], "a mission is in progress");
    screen.type_text("4");
    let click = row(&screen, Rows::Alarms, 1);
    screen.send(click.clone());
    assert_eq!(screen.model.ui.overlay, Overlay::None);
    let chosen = screen.model.live.run.alarms.table()[1].cause.clone();
    assert_eq!(screen.model.selected_alarm().map(|alarm| &alarm.cause), Some(&chosen));
    screen.send(click);
    let is_open =
        matches!(&screen.model.ui.overlay, Overlay::Remedies { cause, selected: 0, .. } if *cause == chosen);
    assert!(is_open);
    screen.press([Key::Esc, Key::Char('5')]);
    let click = row(&screen, Rows::Events, 3);
    screen.send(click.clone());
    assert_eq!((screen.model.ui.events.newer(), screen.model.ui.focus()), (3, tui::model::Pane::List));
    screen.send(click);
    assert_eq!(screen.model.ui.focus(), tui::model::Pane::Detail);
    screen.type_text("8");
    let click = row(&screen, Rows::Plugins, 1);
    assert_eq!((screen.send(click.clone()), screen.send(click)), (vec![], vec![]));
    assert_eq!((screen.model.ui.plugin, &screen.model.ui.overlay), (1, &Overlay::None));
}

#[test]
fn the_wheel_scrolls_the_list_under_it() {
    let mut screen = with_mouse(Screen::held());
    let scenarios = vec![listed("one", None), listed("two", None)];
    screen.send(Msg::Found(Box::new(Found { scenarios, ..Found::default() })));
    screen.type_text("1");
    screen.press([Key::Tab]);
    screen.send(Msg::Mouse(Mouse::Wheel { up: false, on: Target::Row(Rows::Scenarios, 0) }));
    assert_eq!((screen.model.home.list, screen.model.home.scenario), (HomeList::Scenarios, 1));
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
