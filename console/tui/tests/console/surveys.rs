//! A survey on the screen: before the start, on the way with its map, and at its end.

use crate::fixture::{ASCII, PLAIN, RICH, Screen, ScriptedMission, opened, tether};
use crate::screens::{drawn, roles, text};
use exploration::{CellState, Column, Grid};
use mission::event::{Explored, SurveyGoal, SurveyWay};
use mission::{CheckOutcome, Event, EventKind, Order, Outcome, TaskConfig};
use perception::Sensor;
use tui::{Effect, Msg, RunMsg};
use world::{Boundary, Floor, Point, Scanner};

const SIZES: [(u16, u16); 4] = [(200, 60), (120, 36), (80, 24), (60, 16)];
const WALL: Boundary = Boundary::Circle { radius_m: 10.0 };

/// The first event of a survey of a tank whose drawing shows only the wall.
fn begun() -> EventKind {
    let EventKind::RunOpened(mut run) = opened() else { unreachable!("the run opens first") };
    run.scenario = "survey-tank".into();
    run.world.obstacles.clear();
    let mission = &run.mission;
    let (cell_m, hull_m, swath_m) = (mission.cell_m, mission.limits.radius_m, mission.swath_m);
    run.floor = Floor::new(&run.world, cell_m, hull_m, swath_m, mission.start.position);
    run.mission.task = TaskConfig::Survey { anchor: Point::new(9.4, 0.0), tolerance_m: 0.2 };
    run.mission.tether = Some(tether());
    run.mission.sensor = Some(Sensor::of(&Scanner::default()));
    EventKind::RunOpened(run)
}

fn columns() -> Vec<Column> {
    let column = |x: f64, y: f64, radius_m: f64| Column {
        center: Point::new(x, y),
        radius_m,
        center_sigma_m: 0.012,
        radius_sigma_m: 0.011,
    };
    vec![column(3.5, 4.5, 0.4), column(5.0, 0.0, 0.4), column(0.5, 1.5, 0.15)]
}

/// What a robot that has driven from the anchor to the middle has seen: the floor within 6 m of its way, an object, and
/// three columns.
fn explored() -> Explored {
    let grid = Grid::of(&WALL);
    let state = |cell: usize| {
        let at = grid.center(cell);
        let from_way_m = (at - Point::new(at.x.clamp(2.0, 9.0), 0.0)).norm();
        let is_object = (2.0..3.5).contains(&at.x) && (-4.2..-3.8).contains(&at.y);
        let in_column = columns().iter().any(|column| (at - column.center).norm() < column.radius_m);
        match () {
            () if WALL.wall_distance_m(at) < 0.0 || from_way_m > 6.0 => CellState::Unseen,
            () if is_object || in_column => CellState::Solid,
            () => CellState::Free,
        }
    };
    let states: Vec<CellState> = (0..grid.len()).map(state).collect();
    Explored {
        share: 0.583,
        frontiers: [(-2.0, 3.0), (-3.2, -1.0), (-1.5, -4.0)].map(|(x, y)| Point::new(x, y)).into(),
        columns: columns(),
        cells: exploration::changes(&vec![CellState::Unseen; grid.len()], &states),
    }
}

/// A survey that is open and waits for its start.
fn waiting() -> Screen {
    let mut screen = Screen::opened();
    let way = [Point::new(9.4, 0.0), Point::new(-8.0, 0.0)];
    screen.mission = ScriptedMission::along(world::polyline::resampled(&way, 0.1));
    let events = vec![screen.mission.now(begun()), screen.mission.opening().remove(1)];
    let effects = screen.hear(RunMsg::Events(events));
    let plans = |effect: &Effect| matches!(effect, Effect::Order(Order::Plan));
    assert!(!effects.iter().any(plans), "a survey has no plan");
    screen
}

/// A survey on its way to a frontier.
fn under_way() -> Screen {
    let mut screen = waiting();
    let mut events = vec![screen.mission.now(EventKind::Ordered { order: Order::Start })];
    events.extend(survey_only(screen.mission.drive(74)));
    let path = [(2.0, 0.0), (0.0, 2.4), (-2.0, 3.0)].map(|(x, y)| Point::new(x, y)).to_vec();
    let length_m = world::polyline::length_m(&path);
    let way = SurveyWay { to: SurveyGoal::Frontier, path, length_m, beyond_tether: 1 };
    events.extend([
        screen.mission.now(EventKind::SurveyWay(way)),
        screen.mission.now(EventKind::Explored(explored())),
        screen.mission.cable(),
    ]);
    screen.hear(RunMsg::Events(events));
    screen.type_text("3");
    screen
}

/// The events of a survey: the tool scans nothing, and no planner draws.
fn survey_only(events: Vec<Event>) -> Vec<Event> {
    let is_of_tool = |event: &Event| {
        matches!(event.kind, EventKind::Covered { .. } | EventKind::Drawn { .. } | EventKind::Scalars { .. })
    };
    events.into_iter().filter(|event| !is_of_tool(event)).collect()
}

fn store(name: &str, screen: &mut Screen) {
    for (width, height) in SIZES {
        screen.send(Msg::Resize { width, height });
        let shown = text(&drawn(&screen.model, RICH, (width, height)));
        let roles = roles(&screen.model, RICH, (width, height));
        insta::assert_snapshot!(format!("{name}_{width}x{height}"), format!("{shown}\n{roles}"));
        let plain = text(&drawn(&screen.model, PLAIN, (width, height)));
        insta::assert_snapshot!(format!("{name}_{width}x{height}_no_colour"), plain);
    }
}

#[test]
fn before_the_start() {
    let mut screen = waiting();
    screen.type_text("2");
    store("survey_waits", &mut screen);
    screen.hear(RunMsg::Checked(Vec::new()));
    let failed = |check: &mission::Check| check.outcome == CheckOutcome::Failed && check.what != "scanner";
    assert!(!screen.model.checks().iter().any(failed), "{:?}", screen.model.checks());
}

#[test]
fn on_the_way() {
    store("survey_under_way", &mut under_way());
}

#[test]
fn the_pane_of_a_small_screen() {
    let mut screen = under_way();
    screen.send(Msg::Resize { width: 60, height: 16 });
    screen.model.ui.pane = tui::model::Pane::Coverage;
    let shown = text(&drawn(&screen.model, PLAIN, (60, 16)));
    insta::assert_snapshot!("survey_pane_60x16", shown);
}

#[test]
fn letters_tell_the_parts_of_the_map_apart() {
    let mut screen = under_way();
    screen.send(Msg::Resize { width: 120, height: 36 });
    let shown = text(&drawn(&screen.model, ASCII, (120, 36)));
    for word in ["not seen", "frontier", "column", "object", "this leg", "1-3"] {
        assert!(shown.contains(word), "{word}: {shown}");
    }
    assert!(shown.contains("\\\\\\"), "{shown}");
}

#[test]
fn the_layer_can_be_hidden() {
    let mut screen = under_way();
    screen.model.ui.layers.toggle(tui::model::ui::MapLayer::Explored);
    let shown = text(&drawn(&screen.model, PLAIN, (120, 36)));
    assert!(!shown.contains("not seen") && !shown.contains("f   frontier"), "{shown}");
}

/// Turns to the pane of the survey, as an operator does.
fn turn_to_survey(screen: &mut Screen) {
    for _ in 0..6 {
        if screen.model.ui.pane == tui::model::Pane::Coverage {
            return;
        }
        screen.press([tui::Key::Tab]);
    }
    panic!("Tab does not lead to the pane of the survey");
}

#[test]
fn tab_leads_to_the_list_of_the_columns_with_their_errors() {
    for (width, height) in [(120, 36), (80, 24), (60, 16)] {
        let mut screen = under_way();
        screen.send(Msg::Resize { width, height });
        let before = text(&drawn(&screen.model, PLAIN, (width, height)));
        assert_eq!(before.contains("3 found  Tab list"), width == 120, "{before}");
        turn_to_survey(&mut screen);
        let shown = text(&drawn(&screen.model, PLAIN, (width, height)));
        assert_eq!(shown.matches("±0.02").count(), 6, "{shown}");
        insta::assert_snapshot!(format!("survey_list_{width}x{height}"), shown);
    }
}

#[test]
fn a_survey_promises_no_figures_and_has_no_planner_to_change() {
    let mut screen = waiting();
    screen.type_text("2");
    screen.send(Msg::Resize { width: 120, height: 36 });
    let shown = text(&drawn(&screen.model, PLAIN, (120, 36)));
    assert!(shown.contains("A survey promises no figures") && !shown.contains("Promised"), "{shown}");
    assert!(
        shown.contains("A survey drives without a planner.") && !shown.contains("Not a scanning"),
        "{shown}"
    );
    assert!(shown.contains("tether") && shown.contains("30.0 m") && !shown.contains("-     "), "{shown}");
}

#[test]
fn the_alarm_about_the_reel_offers_what_a_survey_can_do() {
    let mut screen = under_way();
    let reel = mission::event::TetherAlarm::Reel { out_m: 25.0, reel_length_m: 30.0 };
    let alarm = screen.mission.now(EventKind::TetherAlarmRaised { alarm: reel, reached: false });
    screen.hear(RunMsg::Events(vec![alarm]));
    let later = survey_only(screen.mission.drive(6));
    screen.hear(RunMsg::Events(later));
    screen.type_text("4");
    let shown = text(&drawn(&screen.model, PLAIN, (200, 60)));
    assert!(shown.contains("A survey chooses its ways") && shown.contains("End the mission"), "{shown}");
    assert!(!shown.contains("certified plan") && !shown.contains("Change the planner"), "{shown}");
}

#[test]
fn at_the_end_the_map_stays() {
    let mut screen = under_way();
    let ended = screen.mission.ended(Outcome::Complete, "back at the anchor, 98.2 % of the floor seen");
    screen.hear(RunMsg::Events(vec![ended]));
    let survey = screen.model.live.run.survey.as_ref().unwrap();
    assert!(survey.way.is_none() && survey.columns.len() == 3);
    let shown = text(&drawn(&screen.model, PLAIN, (120, 36)));
    assert!(shown.contains("58.3 %") && shown.contains("way        ended"), "{shown}");
    let none_left = Explored { frontiers: Vec::new(), ..explored() };
    let events = vec![screen.mission.now(EventKind::Explored(none_left))];
    screen.hear(RunMsg::Events(events));
    let shown = text(&drawn(&screen.model, PLAIN, (120, 36)));
    assert!(shown.contains("frontiers  none left, 41.7 % not seen"), "{shown}");
}
