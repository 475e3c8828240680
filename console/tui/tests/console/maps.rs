//! The plan and the mission screen of a scan on a tether: lanes, marks, legend, what is promised and what is left out.

use crate::fixture::{ASCII, PLAIN, RICH, Screen, ScriptedMission, choice, tether};
use crate::screens::{drawn, roles, text};
use account::estimate::{TetherEstimate, Worst};
use account::{Estimate, LeftOut, Resumption};
use mission::{
    AskId, CheckOutcome, Event, EventKind, HoldReason, Order, Outcome, Resumes, TaskConfig, WorkerId,
};
use planner_api::{Leg, LegTag, Reason};
use ratatui::style::{Color, Modifier};
use tui::model::{Continued, GhostPlan, Pane};
use tui::{Key, Msg, RunMsg};
use world::Point;

const SIZES: [(u16, u16); 4] = [(200, 60), (120, 36), (80, 24), (60, 16)];
/// Distance between lanes, metres.
const LANE_M: f64 = 1.2;

/// Lanes from south to north and back through a round tank, each resampled, with their legs.
fn lanes() -> (Vec<Point>, Vec<Leg>) {
    lanes_every(LANE_M, 16)
}

/// A number of such lanes at a distance from each other, metres.
fn lanes_every(lane_m: f64, n: u32) -> (Vec<Point>, Vec<Leg>) {
    let (mut path, mut legs) = (Vec::new(), Vec::new());
    for lane in 0..n {
        let x = 9.0 - lane_m * f64::from(lane);
        let half_m = (9.4_f64.powi(2) - x * x).max(0.0).sqrt();
        let north_m = if lane % 2 == 0 { half_m } else { -half_m };
        let ends = [Point::new(x, -north_m), Point::new(x, north_m)];
        let first = path.len();
        if first > 0 {
            legs.push(Leg { tag: LegTag::Connector, first: first - 1, last: first });
        }
        path.extend(world::polyline::resampled(&ends, 0.1));
        legs.push(Leg { tag: LegTag::Swath, first, last: path.len() - 1 });
    }
    (path, legs)
}

fn estimate(length_m: f64) -> Estimate {
    let worst = |value, x, y| Worst { value, at: Point::new(x, y) };
    Estimate {
        length_m,
        time_s: length_m / 0.3,
        complete: true,
        reachable: Some(0.981),
        clearance_min: Some(worst(0.11, 4.2, -1.0)),
        tether: Some(TetherEstimate {
            length_max: worst(19.7, -8.6, 3.0),
            wrap_max: worst(0.87, -3.0, 6.0),
            wrapped: "C2".into(),
            wrap_total_max_rad: 1.2,
            end_length_m: 18.0,
            pull_max_n: None,
            own_gap_m: None,
        }),
        accuracy_worst: Some(worst(0.17, 7.8, 4.0)),
        without_fix_m: 0.0,
    }
}

fn left_out() -> LeftOut {
    let area = |x: f64, y: f64, m2: f64, reason: &str| {
        serde_json::json!({
            "at": [x, y], "low": [x, y], "high": [x, y], "area_m2": m2, "plate": null, "reason": reason, "causes": []
        })
    };
    let areas = [
        area(5.5, 0.4, 2.41, "clearance"),
        area(-4.6, 3.1, 1.98, "clearance"),
        area(-9.3, 0.2, 0.74, "narrow"),
    ];
    serde_json::from_value(serde_json::json!({
        "requested_m2": 290.0, "is_part": false, "areas": areas, "slivers": { "count": 4, "area_m2": 0.03 }
    }))
    .unwrap()
}

/// A re-scan: the scan resumes at a place on the way.
pub(crate) fn rescan() -> Screen {
    let mut screen = planned();
    let ask = Some(AskId { worker: WorkerId(0), n: 2 });
    let resumption = Resumption { at: Point::new(4.2, -3.0), after_m: 12.34, again_m2: 5.6 };
    let part = LeftOut { is_part: true, resumption: Some(resumption), ..left_out() };
    screen.hear(RunMsg::LeftOut(ask, Box::new(part)));
    screen.model.live.earlier = vec!["first".into()];
    screen
}

/// A scan on a tether that waits for its start, with its plan certified and estimated.
fn planned() -> Screen {
    let (path, legs) = lanes();
    let mut screen = Screen::idle();
    screen.mission = ScriptedMission::along(path.clone());
    if let Some(about) = &mut screen.model.live.run.about {
        about.mission.tether = Some(tether());
        about.mission.task =
            TaskConfig::Cover { anchor: Point::new(9.4, 0.0), regions: Vec::new(), tolerance_m: 0.2 };
        about.preset_m = None;
    }
    let ask = Some(AskId { worker: WorkerId(0), n: 2 });
    let length_m = world::polyline::length_m(&path);
    let planned = EventKind::Planned {
        ask,
        return_path: 0,
        planner: "rpf".into(),
        reason: Reason::Start,
        path,
        length_m,
        complete: true,
        legs,
        cuts: vec![],
    };
    let events = vec![screen.mission.now(planned), screen.mission.certified(&[])];
    screen.hear(RunMsg::Events(events));
    screen.hear(RunMsg::Estimated(ask, Box::new(estimate(length_m))));
    screen.hear(RunMsg::LeftOut(ask, Box::new(left_out())));
    let check = |what: &str, found: &str| mission::Check {
        what: what.into(),
        outcome: CheckOutcome::Passed,
        found: found.into(),
    };
    let checks = [check("disk", "77 GB free, 98 MB needed"), check("stop", "answers in 0.4 ms")];
    screen.hear(RunMsg::Checked(checks.into()));
    screen.type_text("2");
    screen
}

/// The same mission under way.
fn under_way() -> Screen {
    let mut screen = planned();
    let mut events = vec![screen.mission.now(EventKind::Ordered { order: Order::Start })];
    events.extend(screen.mission.drive(720));
    events.push(screen.mission.cable());
    screen.hear(RunMsg::Events(events));
    screen.type_text("3");
    screen
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
fn the_plan_before_the_start() {
    store("plan_of_lanes", &mut planned());
}

#[test]
fn what_the_plan_leaves_out() {
    let mut screen = planned();
    screen.send(Msg::Resize { width: 80, height: 24 });
    while screen.model.ui.pane != Pane::LeftOut {
        screen.press([Key::Tab]);
    }
    store("left_out", &mut screen);
}

#[test]
fn enter_on_the_plan_opens_an_area_or_says_why_not() {
    let said = |screen: &mut Screen| {
        screen.press([Key::Enter]);
        screen.model.notice().map(|notice| notice.text.clone()).unwrap_or_default()
    };
    let mut screen = planned();
    screen.send(Msg::Resize { width: 120, height: 36 });
    screen.model.ui.pane = Pane::Map;
    assert_eq!(said(&mut screen), "nothing to open in this pane; Tab: next pane, to Left out");
    screen.press([Key::Tab]);
    assert!(said(&mut screen).starts_with("map centred at"), "an area is listed");
    let mut whole = planned();
    whole.model.ui.pane = Pane::LeftOut;
    let ask = whole.model.live.run.planning.plan.as_ref().and_then(|plan| plan.ask);
    let none = LeftOut { areas: Vec::new(), ..left_out() };
    whole.hear(RunMsg::LeftOut(ask, Box::new(none)));
    assert_eq!(said(&mut whole), "nothing to open: the plan leaves out no area");
    let mut drive = Screen::idle();
    drive.type_text("2");
    assert!(said(&mut drive).contains("no list of floor"), "a drive leaves nothing out");
}

#[test]
fn the_plan_beside_what_is_now() {
    let mut screen = under_way();
    screen.type_text("2");
    store("plan_under_way", &mut screen);
}

#[test]
fn the_mission_on_lanes() {
    store("mission_on_lanes", &mut under_way());
}

#[test]
fn nothing_on_either_screen_is_cut() {
    let mut screens = vec![("plan", planned()), ("mission", under_way())];
    for (name, screen) in &mut screens {
        for (width, height) in [(200, 60), (160, 45), (120, 36), (100, 30), (80, 24), (60, 16)] {
            screen.send(Msg::Resize { width, height });
            for _ in 0..5 {
                let shown = text(&drawn(&screen.model, RICH, (width, height)));
                let cut = shown.split(['│', '\n']).find(|part| part.contains('…') && !part.contains("T+00:"));
                assert_eq!(cut, None, "{name} at {width}x{height}:\n{shown}");
                screen.press([Key::Tab]);
            }
        }
    }
}

/// A plan whose lanes are closer than the columns of the map.
fn dense() -> Screen {
    of_lanes(0.5, 37)
}

/// The plan screen with a plan of `n` lanes at a distance from each other, metres.
pub(crate) fn of_lanes(lane_m: f64, n: u32) -> Screen {
    let mut screen = Screen::idle();
    let (path, legs) = lanes_every(lane_m, n);
    if let Some(about) = &mut screen.model.live.run.about {
        (about.mission.swath_m, about.mission.scan.overlap_m) = (lane_m + 0.1, 0.1);
    }
    let ask = Some(AskId { worker: WorkerId(0), n: 2 });
    let length_m = world::polyline::length_m(&path);
    let planned = EventKind::Planned {
        ask,
        return_path: 0,
        planner: "rpf".into(),
        reason: Reason::Start,
        path,
        length_m,
        complete: true,
        legs,
        cuts: vec![],
    };
    let planned = screen.mission.now(planned);
    screen.hear(RunMsg::Events(vec![planned]));
    screen.hear(RunMsg::Estimated(ask, Box::new(estimate(length_m))));
    screen.type_text("2");
    screen
}

/// The same, beside the plan of a different planner: lanes from west to east.
fn dense_compared() -> Screen {
    let mut screen = dense();
    screen.type_text("c");
    screen.press([Key::Enter]);
    let (path, legs) = lanes_every(0.5, 37);
    let turned: Vec<Point> = path.iter().map(|at| Point::new(at.y, at.x)).collect();
    let mission = screen.model.live.run.about.as_ref().unwrap().mission.clone();
    let length_m = world::polyline::length_m(&turned);
    let plan = GhostPlan::new(&mission, &turned, &legs, estimate(length_m), None);
    screen.hear(RunMsg::Compared(choice("spiral-tangent"), Ok(Box::new(plan))));
    screen
}

#[test]
fn a_plan_with_close_lanes_is_drawn_as_lines() {
    store("plan_of_close_lanes", &mut dense());
}

#[test]
fn two_plans_with_close_lanes_can_be_told_apart() {
    store("plans_of_close_lanes", &mut dense_compared());
}

#[test]
fn what_the_plan_leaves_out_is_shown_on_the_map() {
    let mut screen = planned();
    screen.send(Msg::Resize { width: 120, height: 36 });
    screen.press([Key::Tab, Key::Char('j')]);
    let shown = text(&drawn(&screen.model, RICH, (120, 36)));
    assert!(shown.contains("> 1.98 m²") && shown.contains('◎'), "{shown}");
    screen.press([Key::Enter]);
    assert_eq!(screen.model.ui.cursor, Some(Point::new(-4.6, 3.1)));
    assert_eq!(screen.model.ui.screen, tui::model::Screen::Plan);
}

#[test]
fn the_place_where_a_re_scan_resumes_is_marked_and_named_in_the_question() {
    let mut screen = rescan();
    for (width, height) in SIZES {
        screen.send(Msg::Resize { width, height });
        let shown = text(&drawn(&screen.model, PLAIN, (width, height)));
        assert!(shown.contains("R   scan resumes"), "{shown}");
    }
    screen.send(Msg::Resize { width: 120, height: 36 });
    screen.type_text("S");
    let shown = text(&drawn(&screen.model, PLAIN, (120, 36)));
    let flat = shown.split_whitespace().collect::<Vec<_>>().join(" ");
    let words = "The scan resumes at 4.20, -3.00 m, after 12.3 m; 5.6 m² are scanned a second time.";
    assert!(flat.contains(words), "{shown}");
}

#[test]
fn before_a_re_scan_the_operator_reads_where_the_robot_must_stand() {
    let mut screen = rescan();
    let start = screen.model.live.run.about.as_ref().unwrap().mission.start.position;
    let left = |away_m: f64| Some(start + world::Vector::new(away_m, 0.0));
    let continues = |screen: &mut Screen, left_at| {
        let continued = Continued { runs: vec!["first".into()], left_at };
        screen.hear(RunMsg::Continues(Ok(continued)));
        let check = screen.model.checks().into_iter().find(|check| check.what == "robot");
        check.map(|check| (check.outcome, check.found))
    };
    assert_eq!(continues(&mut screen, None), None);
    let near = continues(&mut screen, left(0.1)).unwrap();
    assert_eq!(near, (CheckOutcome::Passed, "was left at the start, 0.1 m from it".into()));
    let (outcome, words) = continues(&mut screen, left(2.5)).unwrap();
    let wanted =
        format!("must stand at {:.2}, {:.2} m, tether reeled in; it was left 2.5 m from", start.x, start.y);
    assert!(outcome == CheckOutcome::Warning && words.starts_with(&wanted), "{words}");
    for (width, height) in [(120, 36), (200, 60)] {
        screen.send(Msg::Resize { width, height });
        let flat = |screen: &Screen| {
            let shown = text(&drawn(&screen.model, PLAIN, (width, height)));
            shown.split_whitespace().filter(|word| !word.contains('│')).collect::<Vec<_>>().join(" ")
        };
        let before = flat(&screen);
        assert!(before.contains("WARN robot: must stand at"), "the pre-flight checks\n{before}");
        screen.type_text("S");
        let asked = flat(&screen);
        assert!(asked.contains("tether reeled in; it was left 2.5 m from there"), "the question\n{asked}");
        screen.press([Key::Esc]);
    }
}

#[test]
fn a_promise_does_not_outlive_its_plan_before_the_start() {
    let mut screen = planned();
    assert!(screen.model.live.promised().is_some() && screen.model.live.left_out().is_some());
    let again = screen.mission.now(EventKind::Ordered { order: Order::Plan });
    screen.hear(RunMsg::Events(vec![again]));
    assert_eq!((screen.model.live.promised(), screen.model.live.left_out()), (None, None));
    let shown = text(&drawn(&screen.model, RICH, (120, 36)));
    assert!(!shown.contains("tether certified"), "{shown}");
}

#[test]
fn what_was_promised_stays_when_the_rest_is_planned_again() {
    let mut screen = under_way();
    let replanned = screen.mission.planned(Some(AskId { worker: WorkerId(0), n: 9 }));
    let events: Vec<Event> = vec![screen.mission.now(replanned)];
    screen.hear(RunMsg::Events(events));
    assert!(screen.model.live.estimate().is_none(), "the estimate is not that of the rest");
    assert!(screen.model.live.promised().is_some());
}

#[test]
fn floor_that_was_not_reached_differs_from_missed_floor() {
    let mut screen = under_way();
    let ended = screen.mission.ended(Outcome::Aborted, "aborted by the operator");
    screen.hear(RunMsg::Events(vec![ended]));
    screen.send(Msg::Resize { width: 120, height: 36 });
    let shown = text(&drawn(&screen.model, RICH, (120, 36)));
    assert!(shown.contains("not reached") && shown.contains('◦') && shown.contains("missed"), "{shown}");
    let ahead = screen.model.live.run.not_reached();
    assert!(ahead.iter().any(|is| *is) && ahead.iter().any(|is| !*is));
    assert!(shown.contains("standing"), "an ended robot has no speed: {shown}");
}

#[test]
fn a_critical_alarm_has_its_line_under_the_map() {
    let mut screen = under_way();
    let lost = EventKind::PositionLost { error_m: 0.49, limit_m: 0.15 };
    let events = vec![
        screen.mission.now(lost),
        screen.mission.held_until(HoldReason::PositionLost, Resumes::WhenCleared),
    ];
    screen.hear(RunMsg::Events(events));
    for (width, height) in SIZES {
        screen.send(Msg::Resize { width, height });
        let shown = text(&drawn(&screen.model, PLAIN, (width, height)));
        assert!(shown.contains("│ CRIT position lost"), "{shown}");
    }
}

#[test]
fn the_fill_of_scanned_floor_stays_within_the_wall() {
    let mut screen = under_way();
    screen.send(Msg::Resize { width: 120, height: 36 });
    let buffer = drawn(&screen.model, RICH, (120, 36));
    let area = buffer.area;
    for y in 0..area.height {
        // From the frame inwards, the map is unfilled up to the wall and under it.
        let row: Vec<_> = (1..69).map(|x| &buffer[(x, y)]).collect();
        let wall = row.iter().position(|cell| {
            ('\u{2801}'..='\u{28ff}').contains(&cell.symbol().chars().next().unwrap_or(' '))
        });
        let outside = &row[..wall.map_or(0, |wall| wall + 1)];
        let filled = outside.iter().filter(|cell| cell.bg != Color::Reset || "▀▄".contains(cell.symbol()));
        assert_eq!(filled.count(), 0, "row {y}");
    }
}

#[test]
fn the_labels_of_the_map_stand_on_the_background_of_the_terminal() {
    let mut screen = under_way();
    screen.send(Msg::Resize { width: 120, height: 36 });
    let buffer = drawn(&screen.model, RICH, (120, 36));
    let on_map = |x: &u16, y: &u16| (1..69).contains(x) && (3..29).contains(y);
    let cells = (0..120).flat_map(|x| (0..36).map(move |y| (x, y))).filter(|(x, y)| on_map(x, y));
    let labels: Vec<_> =
        cells.map(|at| &buffer[at]).filter(|cell| cell.modifier.contains(Modifier::BOLD)).collect();
    assert!(
        labels.iter().any(|cell| cell.symbol() == "C") && labels.iter().all(|cell| cell.bg == Color::Reset)
    );
}

#[test]
fn a_legend_of_letters_has_the_letters_of_the_map() {
    let mut screen = under_way();
    screen.send(Msg::Resize { width: 80, height: 24 });
    let shown = text(&drawn(&screen.model, ASCII, (80, 24)));
    assert!(
        shown.contains("~~  tether") && shown.contains(".. trail") || shown.contains("..  trail"),
        "{shown}"
    );
}

#[test]
fn the_check_of_a_plan_names_what_it_leaves_out() {
    let screen = planned();
    let checks = screen.model.checks();
    let plan = checks.iter().find(|check| check.what == "plan").expect("a check");
    assert!(plan.found.ends_with("m, 3 areas left out, 5.13 m²"), "{}", plan.found);
}

#[test]
fn a_warning_of_the_checks_carries_its_whole_reason_at_every_size_that_lists_them() {
    let reason = "4; ±0.17 m at 7.8, 4.0 m, limit 0.15 m";
    for size in [(200, 60), (120, 36), (80, 24)] {
        let mut screen = planned();
        screen.send(Msg::Resize { width: size.0, height: size.1 });
        if size.0 == 80 {
            screen.press([Key::Tab, Key::Tab]);
        }
        let shown = text(&drawn(&screen.model, RICH, size));
        let pane: String =
            shown.lines().filter_map(|line| line.rsplit_once("││").map(|(_, pane)| pane)).collect();
        let words = pane.replace('│', " ").split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(words.contains(reason), "{size:?}: {shown}");
    }
}

#[test]
fn while_the_robot_moves_the_plan_ahead_is_not_drawn_anew_far_from_it() {
    let mut screen = Screen::running();
    screen.type_text("3");
    let size = (120, 36);
    screen.send(Msg::Resize { width: size.0, height: size.1 });
    for _ in 0..8 {
        let before = drawn(&screen.model, RICH, size);
        let events = screen.mission.drive(1);
        screen.hear(RunMsg::Events(events));
        let after = drawn(&screen.model, RICH, size);
        // The map is on the left, between the tabs and the events.
        let changed = (4..26).flat_map(|y| (1..69).map(move |x| (x, y)));
        let changed: Vec<(u16, u16)> = changed.filter(|at| before[*at] != after[*at]).collect();
        // Those beside the robot, and a dot of a line that begins with it; the plan ahead has more than a hundred.
        assert!(changed.len() < 40, "{changed:?}\n{}\n{}", text(&before), text(&after));
    }
}

/// A mission under way on a floor of plates, with a tool that cannot test beside the welds.
fn welded() -> Screen {
    let mut screen = Screen::plated();
    let about = screen.model.live.run.about.as_ref().unwrap();
    let (plates, drawing) = (about.plates.clone().unwrap(), about.world.as_drawn());
    let bands = world::DeadBands { plates, band_m: 0.15, square_m: 0.5 };
    let floor = screen.model.live.run.coverage.as_ref().unwrap().floor();
    let maker = world::FloorMaker::of(floor, &drawing, 0.4, 0.6, Point::new(9.4, 0.0));
    let changes = maker.with_dead_bands(&bands, &drawing.boundary).into_floor().kinds();
    let events = vec![screen.mission.now(EventKind::FloorChanged { changes })];
    screen.hear(RunMsg::Events(events));
    screen
}

#[test]
fn floor_that_the_tool_cannot_test_is_on_the_map_in_the_legend_and_in_the_shares() {
    store("welds", &mut welded());
}

#[test]
fn no_warning_of_the_pre_flight_check_is_hidden_behind_another() {
    let mut screen = rescan();
    let check = |what: &str, found: &str| mission::Check {
        what: what.into(),
        outcome: CheckOutcome::Warning,
        found: found.into(),
    };
    let long = "leaves out 28 areas of the requested floor along the shell, because no lane runs there; the largest is 1.3 m²";
    let checks =
        [check("floor", long), check("robot", long), check("disk", long), check("clock", "is 2 s late")];
    screen.hear(RunMsg::Checked(checks.into()));
    for (width, height) in [(120, 36), (80, 24), (60, 16)] {
        screen.send(Msg::Resize { width, height });
        let shown = text(&drawn(&screen.model, PLAIN, (width, height)));
        let warned: Vec<String> = screen
            .model
            .checks()
            .into_iter()
            .filter(|check| check.outcome == CheckOutcome::Warning)
            .map(|check| check.what)
            .collect();
        // A small terminal counts them until Tab shows the pane.
        if width < 80 {
            assert!(shown.contains(&format!("{} WARN: A", warned.len())), "{shown}");
            continue;
        }
        let pane = beside_map(&screen, (width, height));
        let pane = pane.split("Pre-flight").last().unwrap_or_default();
        let named = warned.iter().filter(|what| pane.contains(what.as_str())).count();
        let rest = warned.len() - named;
        assert!(rest == 0 || pane.contains(&format!("and {rest} more")), "{named}\n{shown}");
        assert!(
            pane.contains("floor: leaves out 28 areas of the requested floor along the shell"),
            "{shown}"
        );
    }
}

/// The words in the column of panes beside the map.
pub(crate) fn beside_map(screen: &Screen, size: (u16, u16)) -> String {
    let shown = text(&drawn(&screen.model, PLAIN, size));
    let right = |line: &str| line.rsplit_once("││").map(|(_, right)| right.trim_end_matches('│').to_owned());
    let words: Vec<String> = shown.lines().filter_map(right).collect();
    words.join(" ").split_whitespace().collect::<Vec<_>>().join(" ")
}

#[test]
fn a_plan_made_on_the_way_shows_what_it_leaves_out_itself() {
    let mut screen = planned();
    let started = screen.mission.start();
    screen.hear(RunMsg::Events(started));
    let ask = Some(AskId { worker: WorkerId(1), n: 3 });
    let planned = screen.mission.now(screen.mission.planned(ask));
    screen.hear(RunMsg::Events(vec![planned]));
    screen.model.live.plans.planner = Some("tether-safe".into());
    let flat = |screen: &Screen| beside_map(screen, (120, 36));
    let before = flat(&screen);
    assert!(before.contains("The plan at the start scans 98.2 % of the requested floor"), "{before}");
    let mut now = left_out();
    now.areas.truncate(1);
    now.areas[0].area_m2 = 17.37;
    now.areas[0].reason = account::MissReason::NoLaneBeside;
    screen.hear(RunMsg::LeftOut(ask, Box::new(now)));
    let after = flat(&screen);
    assert!(
        after.contains("With this plan, the run scans 94.0 % of the requested floor (promised 98.2 %)"),
        "{after}"
    );
    assert!(after.contains("no lane"), "{after}");
    let whole = text(&drawn(&screen.model, PLAIN, (120, 36)));
    assert!(
        whole.contains("Left out  6.0 %, 17.40 m², 1 area") && whole.contains("Promised by tether-safe"),
        "{whole}"
    );
    let plan = screen.model.checks().into_iter().find(|check| check.what == "plan").unwrap();
    assert!(plan.found.contains("scans 94.0 % of requested; made on the way"), "{}", plan.found);
}

#[test]
fn the_reason_of_the_selected_area_is_shown_at_every_size() {
    let mut screen = planned();
    let ask = Some(AskId { worker: WorkerId(0), n: 2 });
    let mut many = left_out();
    let area = account::Area { reason: account::MissReason::NoLaneBeside, ..many.areas[0].clone() };
    many.areas = vec![area; 28];
    screen.hear(RunMsg::LeftOut(ask, Box::new(many)));
    for (width, height) in SIZES {
        screen.send(Msg::Resize { width, height });
        screen.model.ui.pane = Pane::LeftOut;
        let shown = text(&drawn(&screen.model, PLAIN, (width, height)));
        let flat = if width < 80 {
            shown.replace('│', " ").split_whitespace().collect::<Vec<_>>().join(" ")
        } else {
            beside_map(&screen, (width, height))
        };
        assert!(
            flat.to_lowercase().contains("no lane of this planner runs along"),
            "{width}x{height}\n{shown}"
        );
    }
}
