//! No-go zones drawn on the map, with the cursor or the mouse.

use crate::fixture::{RICH, Screen};
use crate::screens::{drawn, text};
use mission::{Order, Outcome, ZoneCost};
use tui::model::{Overlay, ui::Ask, zone_draft::Form};
use tui::{Effect, Key, Mouse, Msg, Query, RunMsg, Target};
use world::Point;

const ENTER: [Key; 1] = [Key::Enter];

/// A screen on which a zone has been begun at a point.
pub(crate) fn begun(at: Point) -> Screen {
    let mut screen = Screen::running();
    screen.type_text("i");
    screen.model.ui.cursor = Some(at);
    screen.type_text("d");
    assert!(matches!(screen.model.ui.overlay, Overlay::ZoneDraft(_)));
    screen
}

/// A screen that asks whether to close a zone, with its cost.
pub(crate) fn asked() -> Screen {
    let mut screen = begun(Point::new(2.0, 1.0));
    screen.model.ui.cursor = Some(Point::new(5.0, 3.0));
    let effects = screen.press(ENTER);
    let corners = corners(&screen);
    assert_eq!(effects, [Effect::Ask(Query::ZoneCost(corners.clone()))]);
    let cost = ZoneCost { path_m: 12.34, closed_m2: 6.1, lost_m2: 4.2, ..ZoneCost::default() };
    screen.hear(RunMsg::ZoneCost(corners, Ok(cost)));
    screen
}

fn corners(screen: &Screen) -> Vec<Point> {
    match &screen.model.ui.overlay {
        Overlay::Confirm(Ask::DrawZone(corners)) => corners.clone(),
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_zone_across_the_way_back_along_the_tether_says_so_before_it_is_drawn() {
    let mut screen = asked();
    let corners = corners(&screen);
    let words = "It blocks the way back along the tether.";
    let shown = |screen: &Screen| text(&drawn(&screen.model, RICH, (120, 36)));
    assert!(!shown(&screen).contains(words));
    let cost = ZoneCost { blocks_way_back: true, ..ZoneCost::default() };
    screen.hear(RunMsg::ZoneCost(corners, Ok(cost)));
    let text = shown(&screen);
    assert!(text.contains(words), "{text}");
}

#[test]
fn a_box_is_drawn_corner_to_corner_and_asked_about_with_its_cost() {
    let mut screen = asked();
    let corners = corners(&screen);
    assert_eq!((corners[0], corners[2]), (Point::new(2.0, 1.0), Point::new(5.0, 3.0)));
    for size in [(120, 36), (80, 24), (60, 16)] {
        let shown = text(&drawn(&screen.model, RICH, size));
        let flat = shown.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(flat.contains("Close this floor? Enter: close, Esc: cancel."), "{shown}");
        assert!(flat.contains("12.3 m") && flat.contains("6.10 m²") && flat.contains("4.20 m²"), "{shown}");
    }
    assert_eq!(screen.press(ENTER), [Effect::Order(Order::DrawZone(corners))]);
}

#[test]
fn a_circle_and_a_polygon_are_drawn_too() {
    let mut circle = begun(Point::new(2.0, 1.0));
    circle.type_text("s");
    circle.model.ui.cursor = Some(Point::new(3.0, 1.0));
    circle.press(ENTER);
    let around = corners(&circle);
    assert!(around.iter().all(|corner| (corner - Point::new(2.0, 1.0)).norm() < 1.02), "{around:?}");
    let mut polygon = begun(Point::new(2.0, 1.0));
    polygon.type_text("ss");
    for (x, y) in [(4.0, 1.0), (4.0, 2.0)] {
        polygon.model.ui.cursor = Some(Point::new(x, y));
        assert_eq!(polygon.press(ENTER), []);
    }
    polygon.press([Key::Backspace]);
    polygon.type_text("c");
    assert_eq!(corners(&polygon), [(2.0, 1.0), (4.0, 1.0), (4.0, 2.0)].map(|(x, y)| Point::new(x, y)));
}

#[test]
fn the_mouse_draws_from_where_the_drag_began() {
    let mut screen = begun(Point::new(0.0, 0.0));
    screen.model.ui.mouse = true;
    let at = Point::new;
    for (from, to) in [(at(1.0, 1.0), at(2.0, 1.5)), (at(2.0, 1.5), at(3.0, 2.0))] {
        screen.send(Msg::Mouse(Mouse::Drag { from, to }));
    }
    screen.press(ENTER);
    let drawn = corners(&screen);
    assert_eq!((drawn[0], drawn[2]), (at(1.0, 1.0), at(3.0, 2.0)));
    // A click does not answer the question.
    assert_eq!(screen.send(Msg::Mouse(Mouse::Click(Target::Map(at(0.0, 0.0))))), []);
    assert_eq!(corners(&screen), drawn);
}

#[test]
fn a_zone_that_would_be_refused_says_so_and_is_not_sent() {
    let mut screen = begun(Point::new(2.0, 1.0));
    assert_eq!(screen.press(ENTER), [], "a box without area");
    screen.model.ui.cursor = Some(Point::new(5.0, 3.0));
    screen.press(ENTER);
    let asked = corners(&screen);
    screen.hear(RunMsg::ZoneCost(asked, Err("the robot is in the zone".into())));
    assert_eq!((screen.press(ENTER), &screen.model.ui.overlay), (vec![], &Overlay::None));
}

#[test]
fn a_zone_being_drawn_ends_with_its_mission_and_with_esc() {
    let mut screen = begun(Point::new(2.0, 1.0));
    let ended = screen.mission.ended(Outcome::Complete, "task complete");
    screen.hear(RunMsg::Events(vec![ended]));
    assert_eq!(screen.model.ui.overlay, Overlay::None);
    let mut screen = begun(Point::new(2.0, 1.0));
    screen.press([Key::Esc]);
    assert_eq!(screen.model.ui.overlay, Overlay::None);
    assert!(screen.model.ui.cursor.is_some(), "the cursor stays");
}

#[test]
fn hold_works_while_a_zone_is_drawn_and_the_drawing_stays() {
    let mut screen = begun(Point::new(2.0, 1.0));
    assert_eq!(screen.press([Key::Char(' ')]), [Effect::Order(Order::Hold)]);
    let Overlay::ZoneDraft(draft) = &screen.model.ui.overlay else { panic!("the drawing stays") };
    assert_eq!((draft.form, draft.points.len()), (Form::Box, 1));
}

#[test]
fn a_view_draws_nothing() {
    let mut screen = Screen::running();
    screen.model.live.access = tui::model::Access::LookOnly;
    screen.type_text("id");
    assert_eq!(screen.model.ui.overlay, Overlay::None);
    let said = screen.model.notice().map(|notice| notice.text.clone()).unwrap_or_default();
    assert!(said.starts_with("VIEW only"), "{said}");
}

#[test]
fn a_zone_being_drawn_is_on_the_map_with_its_corners_and_its_distance_to_the_hull() {
    let mut screen = begun(Point::new(-5.0, 5.0));
    screen.type_text("ss");
    let at = |x, y| Point::new(x, y);
    for corner in [at(-3.0, 5.0), at(-3.0, 6.5)] {
        screen.model.ui.cursor = Some(corner);
        screen.press(ENTER);
    }
    screen.model.ui.cursor = Some(at(-4.0, 7.0));
    for size in [(120, 36), (200, 60)] {
        let shown = text(&drawn(&screen.model, RICH, size));
        assert_eq!(shown.matches('■').count(), 3, "{shown}");
        let flat = shown.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(flat.contains("4 corners, ") && flat.contains(" m from the hull."), "{shown}");
    }
    screen.press([Key::Esc]);
    assert!(!text(&drawn(&screen.model, RICH, (120, 36))).contains('■'));
}
