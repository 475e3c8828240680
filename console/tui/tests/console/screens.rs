//! Stored screens: the text, and beside it the role of each cell.

use crate::fixture::{ASCII, PLAIN, RICH, Screen};
use mission::{EventKind, HoldReason, Order, Outcome, Resumes, TaskConfig};
use ratatui::Terminal;
use ratatui::backend::TestBackend;
use ratatui::buffer::Buffer;
use tui::{Caps, Key, Model, Msg, Recording, RunMsg, Theme, view, view_with};
use world::Point;

/// The sizes that the console is made for.
const SIZES: [(u16, u16); 4] = [(120, 36), (80, 24), (60, 16), (44, 10)];

/// Draws a model, and checks that every printed key has an effect.
pub(crate) fn drawn(model: &Model, caps: Caps, size: (u16, u16)) -> Buffer {
    crate::printed_keys::check(model, caps, size);
    drawn_as_is(model, caps, size)
}

/// Draws a model in which there may be texts of any kind.
pub(crate) fn drawn_as_is(model: &Model, caps: Caps, size: (u16, u16)) -> Buffer {
    let mut terminal = Terminal::new(TestBackend::new(size.0, size.1)).unwrap();
    terminal.draw(|frame| view(model, &caps, frame)).unwrap();
    terminal.backend().buffer().clone()
}

/// The characters of a screen.
pub(crate) fn text(buffer: &Buffer) -> String {
    rows(buffer, |cell| cell.symbol().to_owned())
}

fn rows(buffer: &Buffer, show: impl Fn(&ratatui::buffer::Cell) -> String) -> String {
    let width = usize::from(buffer.area.width).max(1);
    buffer.content.chunks(width).map(|row| row.iter().map(&show).collect::<String>() + "\n").collect()
}

/// One letter for the role of each cell; `_` for a blank cell.
pub(crate) fn roles(model: &Model, caps: Caps, size: (u16, u16)) -> String {
    let mut terminal = Terminal::new(TestBackend::new(size.0, size.1)).unwrap();
    terminal.draw(|frame| view_with(model, &caps, &Theme::labelled(), frame)).unwrap();
    rows(terminal.backend().buffer(), |cell| {
        let background = Theme::role_of(cell.bg);
        let role = if cell.symbol() == " " { background } else { Theme::role_of(cell.fg).or(background) };
        role.map_or('_', tui::Role::letter).into()
    })
}

fn store(name: &str, screen: &mut Screen) {
    store_at(name, screen, &SIZES);
}

/// Stores a screen at some sizes, and at 80x24 without colours.
pub(crate) fn store_at(name: &str, screen: &mut Screen, sizes: &[(u16, u16)]) {
    for size in sizes.iter().copied() {
        screen.send(Msg::Resize { width: size.0, height: size.1 });
        let text = text(&drawn(&screen.model, RICH, size));
        let roles = roles(&screen.model, RICH, size);
        insta::assert_snapshot!(format!("{name}_{}x{}", size.0, size.1), format!("{text}\n{roles}"));
    }
    let size = (80, 24);
    screen.send(Msg::Resize { width: size.0, height: size.1 });
    insta::assert_snapshot!(format!("{name}_80x24_no_colour"), text(&drawn(&screen.model, PLAIN, size)));
}

#[test]
fn idle() {
    store("idle", &mut Screen::idle());
}

#[test]
fn planning() {
    let mut screen = Screen::idle();
    let started = screen.mission.now(EventKind::Ordered { order: Order::Start });
    screen.hear(RunMsg::Events(vec![started]));
    screen.hear(RunMsg::Busy(Some(("Planning (tether-safe)".into(), Some(60.0)))));
    screen.pass(7.0);
    let events = screen.mission.wait(14);
    screen.hear(RunMsg::Events(events));
    screen.hear(RunMsg::BusyAt { share: 0.42, what: "candidate 2 of 3".into() });
    store("planning", &mut screen);
}

#[test]
fn running() {
    store("running", &mut Screen::running());
}

#[test]
fn running_with_letters_only() {
    let mut screen = Screen::running();
    for size in [(120, 36), (80, 24)] {
        screen.send(Msg::Resize { width: size.0, height: size.1 });
        insta::assert_snapshot!(
            format!("ascii_{}x{}", size.0, size.1),
            text(&drawn(&screen.model, ASCII, size))
        );
    }
}

#[test]
fn running_zoomed_and_followed() {
    let mut screen = Screen::running();
    screen.send(Msg::Resize { width: 120, height: 36 });
    screen.type_text("zzf");
    store("zoomed", &mut screen);
}

#[test]
fn held() {
    store("held", &mut Screen::held());
}

#[test]
fn position_lost() {
    let mut screen = Screen::running();
    screen.mission.sigma_m = 0.2;
    let mut events = screen.mission.wait(4);
    events.push(screen.mission.now(EventKind::PositionLost { error_m: 0.49, limit_m: 0.15 }));
    events.extend(screen.mission.wait(4));
    events.push(screen.mission.held_until(HoldReason::PositionLost, Resumes::WhenCleared));
    screen.hear(RunMsg::Events(events));
    store("lost", &mut screen);
}

#[test]
fn tethered() {
    let mut screen = Screen::tethered();
    store("tethered", &mut screen);
}

#[test]
fn large_screens() {
    let mut screen = Screen::tethered();
    for size in [(160, 45), (200, 60)] {
        screen.send(Msg::Resize { width: size.0, height: size.1 });
        let name = format!("large_{}x{}", size.0, size.1);
        insta::assert_snapshot!(name, text(&drawn(&screen.model, RICH, size)));
    }
}

#[test]
fn reading_the_map() {
    let mut screen = Screen::plated();
    screen.send(Msg::Resize { width: 120, height: 36 });
    screen.type_text("izz");
    screen.press([Key::Left, Key::Left, Key::Down]);
    for size in [(120, 36), (80, 24)] {
        screen.send(Msg::Resize { width: size.0, height: size.1 });
        let name = format!("reading_{}x{}", size.0, size.1);
        insta::assert_snapshot!(name, text(&drawn(&screen.model, RICH, size)));
    }
}

#[test]
fn no_return_path() {
    let mut screen = Screen::tethered();
    let message = mission::event::TetherAlarm::NoReturnPath.to_string();
    let held = screen.mission.held_until(HoldReason::Tether { message }, Resumes::WhenCleared);
    screen.hear(RunMsg::Events(vec![held]));
    store("no_return_path", &mut screen);
}

#[test]
fn fallback_plans() {
    let mut screen = Screen::running();
    let message = "planner rpf panicked during step".to_owned();
    let held = screen.mission.held_until(HoldReason::PlannerFault { message }, Resumes::ByFallback);
    screen.hear(RunMsg::Events(vec![held]));
    screen.hear(RunMsg::Busy(Some(("Planning (apf)".into(), Some(60.0)))));
    screen.pass(7.0);
    store("fallback", &mut screen);
}

#[test]
fn caught() {
    let mut screen = Screen::tethered();
    let events = screen.mission.caught();
    screen.hear(RunMsg::Events(events));
    store("caught", &mut screen);
}

#[test]
fn plan_refused() {
    let mut screen = Screen::tethered();
    let events = screen.mission.plan_refused();
    screen.hear(RunMsg::Events(events));
    store("plan_refused", &mut screen);
}

#[test]
fn planner_fault() {
    let mut screen = Screen::running();
    let events = screen.mission.planner_fails();
    screen.hear(RunMsg::Events(events));
    store("fault", &mut screen);
}

#[test]
fn ended() {
    let mut screen = Screen::running();
    let events = vec![screen.mission.ended(Outcome::Complete, "task complete")];
    screen.hear(RunMsg::Events(events));
    store("ended", &mut screen);
}

#[test]
fn a_scan_that_ended_in_a_collision_without_recording() {
    let mut screen = Screen::running();
    if let Some(about) = &mut screen.model.live.run.about {
        about.mission.task =
            TaskConfig::Cover { anchor: Point::new(-8.0, 0.0), regions: Vec::new(), tolerance_m: 0.2 };
    }
    let events = vec![screen.mission.ended(Outcome::Collision, "bumper contact")];
    let recording = Recording::Failed("the disk is full".into());
    screen.hear(RunMsg::Events(events));
    screen.hear(RunMsg::Health(tui::Health { recording, ..tui::Health::default() }));
    screen.pass(20.0);
    store("collision", &mut screen);
}

#[test]
fn help() {
    let mut screen = Screen::running();
    screen.type_text("?");
    store("help", &mut screen);
}

#[test]
fn commands() {
    let mut screen = Screen::running();
    screen.type_text(":plan");
    store("commands", &mut screen);
}

#[test]
fn planner_list() {
    let mut screen = Screen::held();
    screen.type_text("P");
    store("planners", &mut screen);
}

#[test]
fn parameters() {
    let mut screen = Screen::held();
    screen.type_text("p");
    store("parameters", &mut screen);
}

#[test]
fn refused_value() {
    let mut screen = Screen::held();
    screen.press([Key::Char('p'), Key::Enter, Key::Backspace, Key::Backspace, Key::Backspace]);
    screen.type_text("9");
    screen.press([Key::Enter]);
    store("refused", &mut screen);
}

#[test]
fn confirm_line() {
    let mut screen = Screen::idle();
    screen.type_text("S");
    store("confirm", &mut screen);
}

#[test]
fn swap_question() {
    let mut screen = Screen::held();
    screen.press([Key::Char('P'), Key::Down, Key::Enter]);
    store("swap", &mut screen);
}

#[test]
fn quit_question() {
    let mut screen = Screen::running();
    screen.press([Key::Ctrl('c'), Key::Ctrl('c')]);
    store("quit", &mut screen);
}

#[test]
fn layers_and_filter() {
    let mut screen = Screen::running();
    screen.type_text("L");
    store("layers", &mut screen);
    screen.press([Key::Esc]);
    screen.type_text("/station");
    store("filter", &mut screen);
}
