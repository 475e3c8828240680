//! At every size, the panes of the mission screen show whole texts and mark stale values.

use crate::fixture::{PLAIN, RICH, Screen, TICK_S, of_run};
use crate::screens::{drawn, text};
use account::Summary;
use mission::event::{MeasuredPull, TetherAlarm};
use mission::{Event, EventKind, HoldReason, Order, Outcome, Resumes, Severity};
use positioning::{FixError, Integrity};
use ratatui::style::Style;
use tui::model::Pane;
use tui::{Key, Msg, Redraw, RunMsg, redraw};

const SIZES: [(u16, u16); 5] = [(80, 24), (100, 30), (120, 36), (160, 45), (200, 60)];

/// Screens with every state whose words may be long.
fn states() -> Vec<(&'static str, Screen)> {
    let of = |mut screen: Screen, make: fn(&mut Screen) -> Vec<Event>| {
        let events = make(&mut screen);
        screen.hear(RunMsg::Events(events));
        screen
    };
    let integrity = |integrity: Integrity| {
        let mut screen = Screen::tethered();
        if let Some(fix) = &mut screen.model.live.run.position.fix {
            fix.integrity = integrity;
        }
        screen
    };
    vec![
        ("idle", Screen::idle()),
        ("running", Screen::running()),
        ("held", Screen::held()),
        ("tethered", Screen::tethered()),
        ("snagged", of(Screen::tethered(), |screen| screen.mission.caught())),
        ("refused", of(Screen::tethered(), |screen| screen.mission.plan_refused())),
        ("failed", of(Screen::tethered(), |screen| screen.mission.planner_fails())),
        (
            "ended",
            of(Screen::tethered(), |screen| vec![screen.mission.ended(Outcome::Complete, "task complete")]),
        ),
        ("lost", of(Screen::tethered(), lose)),
        ("no fix", of(Screen::tethered(), lose_fix)),
        ("suspect", integrity(Integrity::Suspect)),
        ("untested", integrity(Integrity::Untestable)),
        ("alarm", integrity(Integrity::Alarm)),
        ("result", result()),
    ]
}

#[test]
fn one_pane_or_chart_can_fill_the_screen_at_every_size() {
    for size in [(60, 16), (80, 24), (120, 36), (200, 60)] {
        let mut screen = Screen::tethered();
        screen.send(Msg::Resize { width: size.0, height: size.1 });
        screen.press([Key::Char('3'), Key::Char('F')]);
        let mut titles = Vec::new();
        for _ in 0..12 {
            let shown = text(&drawn(&screen.model, RICH, size));
            let frame = shown.lines().find(|line| line.contains('▸')).unwrap_or_default().to_owned();
            assert!(frame.starts_with('┌') && frame.ends_with('┐'), "{size:?}\n{shown}");
            assert_eq!(shown.matches('┌').count(), 1, "{size:?}: one pane\n{shown}");
            titles.push(frame);
            screen.press([Key::Tab]);
        }
        for title in [
            "Map",
            "Tether out, m",
            "Largest wrap, °",
            "95 % error, m",
            "Scanned, % of reachable",
            "Stations",
        ] {
            assert!(titles.iter().any(|frame| frame.contains(title)), "{size:?}: {title}: {titles:#?}");
        }
        screen.model.ui.pane = Pane::Chart(tui::model::ui::Chart::Error);
        let before = screen.model.ui.span_s;
        screen.press([Key::Char('z')]);
        assert!(screen.model.ui.span_s < before);
        screen.press([Key::Char('Z')]);
        assert_eq!((screen.model.ui.span_s, screen.model.ui.map.zoom), (before, 0));
        screen.press([Key::Char('F')]);
        let shown = text(&drawn(&screen.model, RICH, size));
        assert!(shown.matches('┌').count() > 1 || size.0 < 80, "{size:?}: all panes\n{shown}");
    }
}

/// The result of a scan on a tether, with an area that was missed.
fn result() -> Screen {
    let reason = "back at the anchor, 99.7 % of the 1011.8 m² of reachable floor scanned";
    let tether = serde_json::json!({
        "tether_length_max_m": 11.2, "wrap_max_rad": 0.94, "wrap_total_max_rad": 1.2, "loops": 0, "end_length_m": 0.4,
        "entangled": false
    });
    let summary = Summary {
        reason: Some(reason.into()),
        outcome: Some(Outcome::Complete),
        tether: Some(serde_json::from_value(tether).unwrap()),
        ..missed_summary()
    };
    let mut screen = Screen::tethered();
    let ended = screen.mission.ended(Outcome::Complete, reason);
    screen.hear(RunMsg::Events(vec![ended]));
    let kept = "run kept in logs/20261122T040049Z-tank-07-rpf-42".into();
    let result = tui::RunResult { summary: Box::new(summary), name: None, kept, is_kept: true };
    screen.hear(RunMsg::Closed(Box::new(result)));
    screen.type_text("7");
    screen
}

/// The summary of a run that missed an area.
pub(crate) fn missed_summary() -> Summary {
    let area = serde_json::json!({
        "at": [1.0, 2.0], "low": [0.5, 1.5], "high": [1.5, 2.5], "area_m2": 0.75, "plate": "R-03-05", "reason": "beyond_reel",
        "causes": [
            { "reason": "beyond_reel", "area_m2": 0.5, "measure": null,
              "text": "not planned: 1.3 m beyond the reach of the tether, lanes within 12.4 m of the anchor" },
            { "reason": "position_uncertain", "area_m2": 0.2, "measure": null,
              "text": "passed with position error 0.24 m, limit 0.15 m" },
            { "reason": "clearance", "area_m2": 0.05, "measure": null,
              "text": "not planned: 0.31 m from column C-north-east, hull and clearance 0.35 m" },
        ]
    });
    let shares = serde_json::json!({
        "area_m2": 1011.8, "scanned": 1.0, "missed": 0.0, "unreachable": 0.0, "margin": 0.0
    });
    let slivers = serde_json::json!({ "count": 0, "area_m2": 0.0 });
    let floor = serde_json::json!({
        "cell_m": 0.1, "swath_m": 0.6, "position_limit_m": 0.15, "whole": shares, "reachable": shares,
        "critical_zone": { "width_m": 0.075, "length_m": 113.1, "done_m": 24.6, "scanned": 0.2, "done": false, "why": null },
        "plates": [], "missed": [area], "slivers": slivers, "unreachable": [],
    });
    Summary { floor: Some(serde_json::from_value(floor).unwrap()), ..Summary::default() }
}

fn lose(screen: &mut Screen) -> Vec<Event> {
    screen.mission.sigma_m = 5.0;
    let mut events = screen.mission.wait(4);
    events.push(screen.mission.now(EventKind::PositionLost { error_m: 12.49, limit_m: 0.15 }));
    events.extend(screen.mission.wait(400));
    events.push(screen.mission.held(HoldReason::PositionLost));
    events
}

fn lose_fix(screen: &mut Screen) -> Vec<Event> {
    let mut events = screen.mission.wait(40);
    events.push(
        screen.mission.now(EventKind::FixFailed {
            error: FixError::TooFewStations { have: 0, need: 3 },
            repeated: false,
        }),
    );
    events
}

/// Whether a line holds words that others chose: of the log, of an alarm (the only lines so far indented), of a fault.
fn is_free(line: &str) -> bool {
    let is_indented = line.starts_with("   ") && !line.trim_start().starts_with(|c: char| c.is_ascii_digit());
    is_indented || ["T+00:", "fault", "rejected: "].iter().any(|word| line.contains(word))
}

#[test]
fn no_text_of_a_pane_is_cut() {
    for (name, mut screen) in states() {
        for (width, height) in SIZES {
            screen.send(Msg::Resize { width, height });
            let text = text(&drawn(&screen.model, RICH, (width, height)));
            // The line on top, the next step and the keys have rules of their own.
            let body: Vec<&str> = text.lines().skip(1).take(usize::from(height) - 3).collect();
            let cut = body
                .iter()
                .flat_map(|line| line.split('│'))
                .find(|part| part.contains('…') && !is_free(part));
            assert_eq!(cut, None, "{name} at {width}x{height}\n{text}");
        }
    }
}

#[test]
fn status_words_come_first_in_their_line() {
    let words = [("lost", "LOST ±"), ("no fix", "NO FIX"), ("suspect", "SUSPECT"), ("snagged", "UNKNOWN")];
    for (name, mut screen) in states() {
        for (width, height) in SIZES {
            screen.send(Msg::Resize { width, height });
            let mut buffer = drawn(&screen.model, PLAIN, (width, height));
            let area = buffer.area;
            buffer.set_style(area, Style::reset());
            let text = text(&buffer);
            let missing = words.iter().find(|(state, word)| *state == name && !text.contains(word));
            assert_eq!(missing, None, "{name} at {width}x{height}\n{text}");
        }
    }
}

#[test]
fn with_a_tether_speed_heading_and_command_stay_on_the_screen() {
    let mut screen = Screen::tethered();
    for (width, height) in SIZES {
        screen.send(Msg::Resize { width, height });
        let text = text(&drawn(&screen.model, RICH, (width, height)));
        for word in ["0.19 m/s", "187°", "0.20 m/s", "return path"] {
            assert!(text.contains(word), "{word} at {width}x{height}\n{text}");
        }
    }
}

/// The lines of the screen on which each kind of value stands, without the frame.
fn values(screen: &Screen, size: (u16, u16)) -> Vec<(&'static str, String)> {
    let text = text(&drawn(&screen.model, RICH, size));
    let labels = [
        ("position", "(limit 0.15)"),
        ("fix", " s old"),
        ("heard", "4 of 4"),
        ("residual", "mm RMS"),
        ("paid out", "m left"),
        ("return path", "CLEAR"),
        ("speed", "m/s, "),
        ("command", "°/s"),
        ("coverage", "passed over  "),
        ("map", "robot "),
    ];
    let line = |label: &str| {
        let body = text.lines().skip(1).flat_map(|line| line.split('│'));
        body.filter(|part| part.contains(label)).last().unwrap_or_default().to_owned()
    };
    labels.into_iter().map(|(name, label)| (name, line(label))).collect()
}

#[test]
fn values_without_a_fresh_sample_are_marked_within_two_periods() {
    let size = (120, 36);
    let mut screen = Screen::tethered();
    screen.send(Msg::Resize { width: size.0, height: size.1 });
    for (name, line) in values(&screen, size) {
        assert!(!line.is_empty(), "{name} is missing\n{}", text(&drawn(&screen.model, RICH, size)));
        assert!(!line.contains('◌'), "{name} is fresh: {line}");
    }
    // The clock continues and ticks arrive, but they contain none of the values that the panes show.
    let (tick, t_s) = (screen.model.live.run.clock.tick, screen.model.live.run.clock.t_s);
    let log = |passed: u64| Event {
        tick: tick + passed,
        t_s: t_s + passed as f64 * TICK_S,
        kind: EventKind::Uncounted { runs: vec![] },
    };
    // Ranges arrive every second tick; all other values arrive with every tick.
    screen.hear(RunMsg::Events((1..=5).map(log).collect()));
    for (name, line) in values(&screen, size) {
        assert!(line.contains('◌'), "{name} is old: {line}\n{}", text(&drawn(&screen.model, RICH, size)));
    }
}

#[test]
fn a_mission_of_which_nothing_is_heard_has_every_value_marked() {
    let size = (120, 36);
    let mut screen = Screen::tethered();
    screen.send(Msg::Resize { width: size.0, height: size.1 });
    screen.pass(2.5);
    for (name, line) in values(&screen, size) {
        assert!(line.contains('◌'), "{name} is old: {line}\n{}", text(&drawn(&screen.model, RICH, size)));
    }
}

#[test]
fn missed_areas_are_listed_on_a_large_screen_when_the_run_is_closed() {
    let mut screen = Screen::running();
    let ended = screen.mission.ended(Outcome::Complete, "task complete");
    screen.hear(RunMsg::Events(vec![ended]));
    let summary = Box::new(missed_summary());
    let result = tui::RunResult { summary, name: None, kept: String::new(), is_kept: false };
    screen.hear(RunMsg::Closed(Box::new(result)));
    screen.type_text("3");
    screen.send(Msg::Resize { width: 200, height: 60 });
    let text = text(&drawn(&screen.model, RICH, (200, 60)));
    assert!(text.contains("Missed areas  1") && text.contains("0.75 m² at 1.0, 2.0 m"), "{text}");
}

#[test]
fn the_end_is_given_in_mission_time() {
    let mut screen = Screen::running();
    for (width, height) in SIZES {
        screen.send(Msg::Resize { width, height });
        let text = text(&drawn(&screen.model, RICH, (width, height)));
        assert!(text.contains("T+00:46:57") && !text.contains("UTC"), "{text}");
    }
}

#[test]
fn a_robot_that_stands_still_is_drawn_once_a_second_and_news_at_once() {
    let mut screen = Screen::held();
    let telemetry = of_run(RunMsg::Events(screen.mission.wait(3)));
    assert_eq!(redraw(&screen.model, &telemetry), Redraw::Calm);
    let resumed = of_run(RunMsg::Events(screen.mission.obeyed(Order::Resume)));
    assert_eq!(redraw(&screen.model, &resumed), Redraw::Soon);
    let notice = Msg::Notice { severity: Severity::Info, text: "news".into() };
    assert_eq!(redraw(&screen.model, &notice), Redraw::Soon);
    let health = of_run(RunMsg::Health(tui::Health {
        recording: tui::Recording::On,
        reached_speed: Some(0.9),
        ..tui::Health::default()
    }));
    assert_eq!(redraw(&screen.model, &health), Redraw::No);
    assert_eq!(redraw(&Screen::running().model, &telemetry), Redraw::Soon);
}

#[test]
fn the_tether_pane_calls_no_plan_certified_that_is_not_flown() {
    let notes = |events: fn(&Screen) -> Vec<Event>| {
        let mut screen = Screen::tethered();
        let events = events(&screen);
        screen.hear(RunMsg::Events(events));
        let shown = text(&drawn(&screen.model, PLAIN, (120, 36)));
        ["no certified plan", "plan certified"].map(|note| shown.contains(note))
    };
    assert_eq!(notes(|_| Vec::new()), [false, true]);
    // One that fails in a step is restarted, and goes on with its plan.
    assert_eq!(notes(|screen| screen.mission.planner_fails()), [false, true]);
    assert_eq!(notes(|screen| vec![screen.mission.zone_drawn()]), [true, false]);
    assert_eq!(notes(|screen| screen.mission.planning_fails()), [true, false]);
    // A plan that is safe for the tether, and scans nothing.
    let no_way = |screen: &Screen| {
        let message = "plan of rpf scans none of the remaining 3.00 m²".to_owned();
        vec![screen.mission.certified(&[]), screen.mission.held(HoldReason::PlannerFault { message })]
    };
    assert_eq!(notes(no_way), [true, false]);
}

#[test]
fn on_a_large_terminal_each_pane_has_a_key_that_its_title_shows() {
    let mut screen = Screen::running();
    screen.send(Msg::Resize { width: 120, height: 36 });
    let shown = text(&drawn(&screen.model, RICH, (120, 36)));
    assert!(shown.contains("▸ F2 Map") && shown.contains("─ F3 Events"), "{shown}");
    screen.press([Key::F(3)]);
    let shown = text(&drawn(&screen.model, RICH, (120, 36)));
    assert!(shown.contains("▸ F3 Events") && shown.contains("─ F2 Map"), "{shown}");
    screen.press([Key::F(4)]);
    assert!(text(&drawn(&screen.model, RICH, (120, 36))).contains("▸ F4 Stations"));
    // On a smaller terminal, Tab is the way, and the key says so.
    screen.send(Msg::Resize { width: 80, height: 24 });
    screen.press([Key::F(2)]);
    let said = screen.model.notice().map(|notice| notice.text.clone()).unwrap_or_default();
    assert!(said.contains("Tab: next pane"), "{said}");
    assert!(!text(&drawn(&screen.model, RICH, (80, 24))).contains("F2"));
}

#[test]
fn a_terminal_too_small_for_a_map_uses_its_rows() {
    let mut screen = Screen::tethered();
    screen.send(Msg::Resize { width: 59, height: 15 });
    let shown = text(&drawn(&screen.model, RICH, (59, 15)));
    let blank = shown.lines().filter(|line| line.trim_matches(['│', ' ']).is_empty()).count();
    assert!(blank <= 1, "{blank} blank rows\n{shown}");
    for needed in ["tether 12.6 of 30.0 m", "fix ok", "time left", "station S4 rejected"] {
        assert!(shown.contains(needed), "{needed} is missing\n{shown}");
    }
    insta::assert_snapshot!("strip_59x15", shown);
}

#[test]
fn the_cursor_on_the_map_gives_the_reason_that_the_report_gives() {
    let screen = result();
    let area = screen.model.live.missed()[0].clone();
    assert_eq!(screen.model.live.missed_area(area.at), Some(&area));
    assert!(tui::handover::page(&screen.model).contains(&area.why().replace('<', "\\<")));
    let outside = world::Point::new(area.high.x + 50.0, area.at.y);
    assert_eq!(screen.model.live.missed_area(outside), None);
}

#[test]
fn the_pull_the_slack_and_the_loops_of_a_tether_are_shown() {
    let mut screen = Screen::tethered();
    let mut cable = screen.mission.cable();
    if let EventKind::Tethered { measured, .. } = &mut cable.kind {
        *measured = Some(MeasuredPull { pull_n: 3.4, slack_m: 0.16 });
    }
    let line = [(9.4, 0.0), (4.0, 3.0), (3.0, -3.0)].map(|(x, y)| world::Point::new(x, y)).to_vec();
    let lies = world::CableLies { line, under_hull: false, reel_pull_n: 3.4, torn: false };
    let truth = screen.mission.now(EventKind::TetherTruth {
        length_m: 12.0,
        wrap_max_rad: 0.0,
        wrap_total_rad: 0.0,
        detour_m: 0.0,
        lies: Some(Box::new(lies)),
    });
    screen.hear(RunMsg::Events(vec![cable, truth]));
    screen.type_text("3");
    for size in [(200, 60), (120, 36)] {
        screen.send(Msg::Resize { width: size.0, height: size.1 });
        let shown = text(&drawn(&screen.model, RICH, size));
        for words in ["3.4 N (no limit given)", "0.16 of 0.20 m", "tether, true"] {
            assert!(shown.contains(words), "{size:?} {words}:\n{shown}");
        }
    }
    // In a small pane, slack near its limit takes the place of the wrap.
    let mut cable = screen.mission.cable();
    if let EventKind::Tethered { measured, .. } = &mut cable.kind {
        *measured = Some(MeasuredPull { pull_n: 0.0, slack_m: 0.19 });
    }
    screen.hear(RunMsg::Events(vec![cable]));
    screen.send(Msg::Resize { width: 80, height: 24 });
    let shown = text(&drawn(&screen.model, RICH, (80, 24)));
    assert!(shown.contains("slack 0.19 of 0.20 m"), "{shown}");
}

#[test]
fn with_a_slack_tether_no_pane_claims_a_certified_plan_or_a_clear_return_path() {
    let mut screen = Screen::tethered();
    let certified = screen.mission.certified(&[]);
    screen.hear(RunMsg::Events(vec![screen.mission.cable(), certified]));
    screen.send(Msg::Resize { width: 120, height: 36 });
    screen.type_text("3");
    let sound = text(&drawn(&screen.model, RICH, (120, 36)));
    assert!(sound.contains("plan certified") && sound.contains("CLEAR"), "{sound}");
    let alarm = TetherAlarm::Slack { slack_m: 0.3, pull_n: 0.1 };
    let held = HoldReason::Tether { message: alarm.to_string() };
    let alarmed = screen.mission.now(EventKind::TetherAlarmRaised { alarm, reached: true });
    screen.hear(RunMsg::Events(vec![alarmed, screen.mission.held_until(held, Resumes::Never)]));
    for size in [(120, 36), (80, 24)] {
        screen.send(Msg::Resize { width: size.0, height: size.1 });
        screen.type_text("3");
        let shown = text(&drawn(&screen.model, RICH, size));
        assert!(!shown.contains("plan certified") && !shown.contains("CLEAR"), "{size:?}\n{shown}");
        assert!(shown.contains("see :return"), "{size:?}\n{shown}");
        screen.type_text("2");
        let shown = text(&drawn(&screen.model, RICH, size));
        assert!(shown.contains("tether SLACK") && !shown.contains("tether certified"), "{size:?}\n{shown}");
    }
}

#[test]
fn the_state_line_offers_the_drive_back_from_tether_that_lies_or_is_caught_until_no_way_back_is_found() {
    let reasons = [
        "tether snagged on an unmapped object: 7.8 m paid out, 6.7 m expected",
        "tether snagged or slack: 7.4 m paid out, 5.8 m expected",
        "the reel takes the tether up again: 8.3 m are out, 8.5 m were out at the order",
        "hull about to reach its own tether: the reel has stopped",
    ];
    for reason in reasons {
        let mut screen = Screen::tethered();
        let held = HoldReason::Tether { message: reason.into() };
        screen.hear(RunMsg::Events(vec![
            screen.mission.cable(),
            screen.mission.held_until(held, Resumes::Never),
        ]));
        screen.send(Msg::Resize { width: 120, height: 36 });
        let shown = text(&drawn(&screen.model, RICH, (120, 36)));
        assert!(shown.contains("drive back"), "{reason}\n{shown}");
        screen.hear(RunMsg::WayBack(Err("the hull does not fit".into())));
        let shown = text(&drawn(&screen.model, RICH, (120, 36)));
        assert!(!shown.contains("drive back"), "{reason}\n{shown}");
        screen.hear(RunMsg::Events(vec![screen.mission.now(EventKind::Resumed)]));
        assert_eq!(screen.model.live.way_back, None);
    }
}

#[test]
fn a_broken_tether_is_named_by_pane_and_alarm() {
    let mut screen = Screen::tethered();
    let alarm = TetherAlarm::Broken { paid_out_m: 0.0, needed_m: 5.2, by_encoder_alone: false };
    let held = HoldReason::Tether { message: alarm.to_string() };
    let alarmed = screen.mission.now(EventKind::TetherAlarmRaised { alarm, reached: true });
    let events = vec![screen.mission.cable(), alarmed, screen.mission.held_until(held, Resumes::Never)];
    screen.hear(RunMsg::Events(events));
    for size in [(120, 36), (80, 24)] {
        screen.send(Msg::Resize { width: size.0, height: size.1 });
        screen.type_text("3");
        let shown = text(&drawn(&screen.model, RICH, size));
        assert!(shown.lines().any(|line| line.contains("Tether") && line.contains("BROKEN")), "{shown}");
        screen.type_text("4");
        let shown = text(&drawn(&screen.model, RICH, size));
        assert!(shown.contains("tether BROKEN") && shown.contains("CRIT"), "{size:?}\n{shown}");
        assert!(shown.contains("Drive back beside the tether"), "{size:?}\n{shown}");
    }
}

#[test]
fn a_plan_is_not_certified_and_has_no_figures_of_a_tether_that_is_torn() {
    let mut screen = Screen::tethered();
    let alarm = TetherAlarm::Broken { paid_out_m: 1.6, needed_m: 5.2, by_encoder_alone: false };
    let certified = screen.mission.certified(&[]);
    let alarmed = screen.mission.now(EventKind::TetherAlarmRaised { alarm, reached: true });
    let held = screen.mission.held_until(HoldReason::Operator, Resumes::Never);
    screen.hear(RunMsg::Events(vec![screen.mission.cable(), certified, alarmed, held]));
    screen.send(Msg::Resize { width: 120, height: 36 });
    screen.type_text("2");
    let shown = text(&drawn(&screen.model, RICH, (120, 36)));
    assert!(shown.contains("tether TORN") && !shown.contains("tether certified"), "{shown}");
    assert!(shown.lines().any(|line| line.contains("wrap") && line.contains("torn")), "{shown}");
    assert!(shown.contains("HELD by operator; tether broken; robot at "), "{shown}");
    let check = screen.model.checks().into_iter().find(|check| check.what == "tether");
    assert!(check.is_some_and(|check| check.found.starts_with("TORN")), "{shown}");
    screen.type_text("3");
    let shown = text(&drawn(&screen.model, RICH, (120, 36)));
    assert!(shown.contains("torn        12.6 m off the reel (first 1.6 m)"), "{shown}");
}

#[test]
fn a_blocked_return_path_is_named_by_the_pane_and_the_alarm_at_every_size() {
    let mut screen = Screen::tethered();
    let mut cable = screen.mission.cable();
    if let EventKind::Tethered { return_length_m, .. } = &mut cable.kind {
        *return_length_m = None;
    }
    let alarm = TetherAlarm::NoReturnPath;
    let held = HoldReason::Tether { message: alarm.to_string() };
    let alarmed = screen.mission.now(EventKind::TetherAlarmRaised { alarm, reached: true });
    let events = vec![cable, alarmed, screen.mission.held_until(held, Resumes::WhenCleared)];
    screen.hear(RunMsg::Events(events));
    for size in [(200, 60), (120, 36), (80, 24), (60, 16)] {
        screen.send(Msg::Resize { width: size.0, height: size.1 });
        screen.type_text("3");
        let mut shown = text(&drawn(&screen.model, RICH, size));
        for _ in 0..6 {
            screen.press([Key::Tab]);
            shown += &text(&drawn(&screen.model, RICH, size));
        }
        assert!(
            shown.lines().any(|line| line.contains("return path") && line.contains("BLOCKED")),
            "{shown}"
        );
        screen.type_text("4");
        let shown = text(&drawn(&screen.model, RICH, size));
        assert!(shown.contains("return path BLOCKED"), "{size:?}\n{shown}");
    }
}
