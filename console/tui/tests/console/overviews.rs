//! The screens around a mission: the scenarios and runs to open, the figures that a plan promises,
//! and the result.

use crate::fixture::{RICH, Screen, choice};
use crate::panes::missed_summary;
use crate::screens::{drawn, text};
use crate::sizes;
use account::{Estimate, Fold, Summary, estimate::Worst};
use mission::{AskId, EventKind, Order, Outcome, Outlook, Severity, WorkerId};
use tui::model::home::{Attention, Found, HomeList};
use tui::model::{Combination, Continued, Forecast, GhostPlan, PastRun, ScenarioEntry};
use tui::{Effect, Key, Msg, RunMsg, RunResult, Source};
use world::Point;

fn store(name: &str, screen: &mut Screen) {
    for (width, height) in [(120, 36), (80, 24), (60, 16)] {
        screen.send(Msg::Resize { width, height });
        let shown = text(&drawn(&screen.model, RICH, (width, height)));
        // Events are cut at the end of their line: Enter shows the whole of one.
        let cut = shown.split(['│', '\n']).find(|part| part.contains('…') && !part.contains("T+00:"));
        assert!(width < 80 || cut.is_none(), "{name} at {width}x{height}: {cut:?}");
        insta::assert_snapshot!(format!("{name}_{width}x{height}"), shown);
    }
}

fn scenario(name: &str, task: &str, planner: &str) -> ScenarioEntry {
    let about = Screen::idle().model.live.run.about;
    ScenarioEntry {
        source: Source::File(format!("scenarios/{name}.toml")),
        name: name.into(),
        about: "Round tank with five known columns".into(),
        task: task.into(),
        tank: "Ø12 m".into(),
        planner: planner.into(),
        expected: "complete, no collision".into(),
        problem: None,
        world: about.as_ref().map(|about| Box::new(about.world.clone())),
        mission: about.map(|about| Box::new(about.mission)),
    }
}

fn past(name: &str, end: &str, reachable: Option<f64>) -> PastRun {
    PastRun {
        name: format!("20261122T040049Z-{name}"),
        began: "22 Nov 04:00".into(),
        scenario: name.into(),
        planner: "rpf".into(),
        end: end.into(),
        began_unix_s: None,
        verified: None,
        mission_time_s: Some(875.0),
        reachable,
        note: None,
        remark: None,
        bookmarks: 0,
    }
}

/// The time at which the fixtures look at their runs: 40 minutes after the first one began.
const BEGAN_UNIX_S: f64 = 1_795_264_000.0 - 2400.0;

pub(crate) fn found() -> Found {
    let invalid = ScenarioEntry {
        problem: Some(
            "error: scenarios/depot.toml:14:1: unknown key `radus_m`, did you mean `radius_m`?".into(),
        ),
        world: None,
        mission: None,
        ..scenario("depot", "", "")
    };
    let demo =
        ScenarioEntry { source: Source::Demo, tank: "Ø20 m".into(), ..scenario("demo", "follow", "rpf") };
    let mut scenarios = vec![
        scenario("corridor", "goto", "navfn"),
        scenario("cover-circle", "cover", "tether-safe"),
        scenario("cover-unknown-columns", "cover", "tether-safe"),
        demo,
        invalid,
        scenario("goto-single-obstacle", "goto", "apf"),
    ];
    scenarios.extend((1..=8).map(|n| scenario(&format!("shift-{n}"), "cover", "hull-partition")));
    let point = |severity, kind: &str, text: &str| Attention {
        severity,
        kind: kind.into(),
        text: text.into(),
        run: None,
    };
    let mut runs = vec![
        PastRun {
            verified: Some("2026-11-22 04:21".into()),
            ..past("cover-circle", "complete", Some(0.997))
        },
        PastRun {
            note: Some("killed; the journal holds everything up to T+401.0 s".into()),
            ..past("corridor", "CRASHED", None)
        },
        past("goto-single-obstacle", "RECORDING FAILED", None),
        PastRun {
            remark: Some("second pass".into()),
            ..past("cover-unknown-columns", "aborted", Some(0.225))
        },
    ];
    for (index, run) in runs.iter_mut().enumerate() {
        run.began_unix_s = Some(BEGAN_UNIX_S - 50_000.0 * index as f64);
    }
    Found {
        scenarios,
        runs,
        logs: "logs".into(),
        free_bytes: Some(71_000_000_000),
        attention: vec![
            point(
                Severity::Warn,
                "CRASHED",
                "run corridor: killed; the journal holds everything up to T+401.0 s",
            ),
            point(
                Severity::Watch,
                "INVALID",
                "depot: scenarios/depot.toml:14:1: unknown key `radus_m`\n  help: did you mean `radius_m`?",
            ),
            point(Severity::Info, "ok", "runs will be kept in logs"),
        ],
    }
}

/// What is known about the first run in the list.
fn glimpse(screen: &Screen) -> tui::model::Glimpse {
    let run = screen.model.live.run.clone();
    let (_, result) = ended();
    let summary = Summary { holds: 2, obstacles_found: 1, ..*result.summary };
    tui::model::Glimpse::of(run, Some(Box::new(summary)), None)
}

#[test]
fn home() {
    let mut screen = Screen::idle();
    screen.send(Msg::Found(Box::new(found())));
    screen.type_text("1gjj");
    // A large screen shows the last run of the selected scenario.
    let asked = screen.send(Msg::Resize { width: 200, height: 60 });
    let key = ("20261122T040049Z-cover-unknown-columns".to_owned(), "aborted".to_owned());
    assert_eq!(asked, [Effect::Glimpse(key.clone())]);
    let known = glimpse(&screen);
    screen.send(Msg::Glimpsed(key, Ok(Box::new(known))));
    sizes::store("home", &mut screen, |_| false);
    screen.type_text("jj");
    let refused = screen.press([Key::Enter]);
    assert_eq!(refused, []);
    let said = screen.model.notice().map(|notice| notice.text.clone()).unwrap_or_default();
    assert!(said.starts_with("depot cannot be opened: line 14: unknown key"), "{said}");
}

#[test]
fn attention_can_be_read_whole_and_acts_on_its_run() {
    let mut screen = Screen::idle();
    let mut found = found();
    let long = "run corridor: re-scan the rest (:rescan); ".to_owned()
        + &"killed while it was being written; ".repeat(8);
    found.attention[0].text = long.clone() + "the end of the text";
    found.attention[0].run = Some("20261122T040049Z-corridor".into());
    screen.send(Msg::Found(Box::new(found)));
    for size in [(60, 16), (80, 24), (120, 36), (200, 60)] {
        screen.send(Msg::Resize { width: size.0, height: size.1 });
        screen.press([Key::Char('1')]);
        screen.model.home.list = HomeList::Attention;
        screen.model.home.is_read = true;
        let shown = text(&drawn(&screen.model, RICH, size));
        assert!(shown.contains("the end of the text"), "{size:?}\n{shown}");
        assert!(shown.contains("r: re-scan the rest."), "{size:?}\n{shown}");
    }
    let rescan = screen.press([Key::Char('r')]);
    let runs = Source::Rescan(vec!["20261122T040049Z-corridor".into()]);
    assert!(matches!(&rescan[..], [Effect::Open { source, .. }] if *source == runs), "{rescan:?}");
}

#[test]
fn a_filter_at_home_finds_words_and_ends_and_is_visible() {
    let mut screen = Screen::idle();
    screen.send(Msg::Found(Box::new(found())));
    screen.press([Key::Char('1')]);
    screen.model.home.list = HomeList::Runs;
    screen.model.home.filter = "corridor CRASHED".into();
    let names: Vec<&str> = screen.model.home.runs().iter().map(|run| run.scenario.as_str()).collect();
    assert_eq!(names, ["corridor"]);
    screen.model.home.filter = "nothing such".into();
    for size in [(60, 16), (80, 24), (120, 36), (200, 60)] {
        screen.send(Msg::Resize { width: size.0, height: size.1 });
        let shown = text(&drawn(&screen.model, RICH, size));
        assert!(shown.contains("`nothing such`"), "{size:?}\n{shown}");
        assert!(!shown.contains("Enter replays"), "{size:?}\n{shown}");
    }
}

#[test]
fn past_runs_at_home() {
    let mut screen = Screen::running();
    screen.send(Msg::Found(Box::new(found())));
    let held = screen.mission.obeyed(Order::Hold);
    screen.hear(RunMsg::Events(held));
    screen.type_text("1");
    let offered =
        |screen: &Screen| tui::update::offered(&screen.model, tui::actions::ActionId::Verify).is_ok();
    assert!(!offered(&screen), "no run is selected while the scenarios have the focus");
    screen.send(Msg::Resize { width: 120, height: 36 });
    let asked = screen.press([Key::Tab]);
    let key = ("20261122T040049Z-cover-circle".to_owned(), "complete".to_owned());
    assert_eq!(asked, [Effect::Glimpse(key.clone())]);
    assert!(offered(&screen));
    // A robot that may move needs processor and disk; afterwards, the run is read again.
    let resumed = screen.mission.obeyed(Order::Resume);
    assert_eq!(screen.hear(RunMsg::Events(resumed)), [Effect::StopGlimpsing]);
    let held = screen.mission.obeyed(Order::Hold);
    assert_eq!(screen.hear(RunMsg::Events(held)), [Effect::Glimpse(key.clone())]);
    let known = glimpse(&screen);
    screen.send(Msg::Glimpsed(key.clone(), Ok(Box::new(known))));
    sizes::store("home_runs", &mut screen, |_| false);
    let effects = screen.type_text("v");
    assert_eq!(effects, [Effect::Do(tui::Job::Verify(key.0))]);
    let said = screen.model.notice().map(|notice| notice.text.clone()).unwrap_or_default();
    assert_eq!(said, "verifying 20261122T040049Z-cover-circle...");
}

#[test]
fn attention_is_read_in_full() {
    let mut screen = Screen::idle();
    screen.send(Msg::Found(Box::new(found())));
    screen.type_text("1");
    screen.press([Key::BackTab, Key::Down, Key::Enter]);
    sizes::store("home_attention", &mut screen, |_| false);
    screen.send(Msg::Resize { width: 80, height: 24 });
    let shown = text(&drawn(&screen.model, RICH, (80, 24)));
    assert!(shown.contains("help: did you mean `radius_m`?"), "{shown}");
    screen.press([Key::Esc]);
    let shown = text(&drawn(&screen.model, RICH, (80, 24)));
    assert!(!shown.contains("help: did you mean"), "{shown}");
}

fn estimate(length_m: f64) -> Estimate {
    let worst = |value| Some(Worst { value, at: Point::new(-4.99, -0.61) });
    Estimate {
        length_m,
        time_s: length_m / 0.3,
        complete: true,
        reachable: None,
        clearance_min: worst(0.14),
        tether: None,
        accuracy_worst: worst(0.11),
        without_fix_m: 0.0,
    }
}

#[test]
fn plan() {
    let mut screen = Screen::idle();
    let ask = AskId { worker: WorkerId(0), n: 2 };
    let chosen = screen.mission.start().remove(1);
    let planned = screen.mission.now(screen.mission.planned(Some(ask)));
    screen.hear(RunMsg::Events(vec![chosen, planned]));
    screen.hear(RunMsg::Estimated(Some(ask), Box::new(estimate(462.8))));
    screen.type_text("2c");
    screen.press([Key::Enter]);
    let path = vec![Point::new(9.4, 0.0), Point::new(0.0, 0.0)];
    let ghost = GhostPlan { path, lanes: Vec::new(), estimate: estimate(391.2), certified: None };
    screen.hear(RunMsg::Compared(choice("spiral-tangent"), Ok(Box::new(ghost))));
    store("plan", &mut screen);
}

#[test]
fn preflight() {
    let mut screen = Screen::idle();
    screen.model.live.run.about.as_mut().unwrap().checklist =
        vec!["manway clear, tether handler in place".into()];
    screen.type_text("A");
    let check =
        |what: &str, outcome, found: &str| mission::Check { what: what.into(), outcome, found: found.into() };
    screen.hear(RunMsg::Checked(vec![
        check(
            "disk",
            mission::CheckOutcome::Failed,
            "12 MB free, 91 MB needed; delete runs or choose another --logs",
        ),
        check("stop", mission::CheckOutcome::Passed, "engine answers in 0.4 ms, limit 50 ms"),
    ]));
    store("preflight", &mut screen);
}

#[test]
fn result() {
    let (mut screen, closed) = ended();
    sizes::store("result", &mut screen, sizes::is_log);
    let scanned = RunResult { summary: Box::new(missed_summary()), ..closed };
    screen.hear(RunMsg::Closed(Box::new(scanned)));
    screen.send(Msg::Resize { width: 60, height: 16 });
    let pages =
        ["7 Result: Coverage", "7 Result: Missed:", "7 Result: Plates", "7 Result: Map", "7 Result  "];
    for page in pages {
        screen.press([Key::Tab]);
        let shown = text(&drawn(&screen.model, RICH, (60, 16)));
        assert!(
            shown.contains(&format!("┌─▸ {page}")) || shown.contains(&format!("┌─ {page}")),
            "{page}\n{shown}"
        );
    }
}

#[test]
fn result_of_an_aborted_mission() {
    let (mut screen, closed) = ended();
    let mut summary = missed_summary();
    let floor = summary.floor.as_mut().unwrap();
    let ahead =
        account::Area { reason: account::MissReason::NotReached, area_m2: 40.2, ..floor.missed[0].clone() };
    floor.missed.insert(0, ahead);
    floor.plates = serde_json::from_value(serde_json::json!([
        { "name": "R-03-05", "kind": "rectangular", "error_p95_m": 0.11, "error_max_m": 0.19, "area_m2": 6.4,
          "scanned": 0.9, "missed": 0.1, "unreachable": 0.0, "margin": 0.0,
          "percent": { "scanned": 90.0, "missed": 10.0, "unreachable": 0.0, "margin": 0.0 } },
        { "name": "A-01", "kind": "annular", "error_p95_m": 0.04, "error_max_m": 0.06, "area_m2": 2.4,
          "scanned": 1.0, "missed": 0.0, "unreachable": 0.0, "margin": 0.0,
          "percent": { "scanned": 100.0, "missed": 0.0, "unreachable": 0.0, "margin": 0.0 } },
    ]))
    .unwrap();
    let summary = Summary {
        outcome: Some(Outcome::Aborted),
        reason: Some("ended by the operator".into()),
        violations: Some(vec!["expected complete, actual aborted".into()]),
        ..summary
    };
    screen.hear(RunMsg::Closed(Box::new(RunResult { summary: Box::new(summary), ..closed })));
    sizes::store("result_aborted", &mut screen, sizes::is_log);
    let shown = text(&drawn(&screen.model, RICH, (200, 60)));
    assert!(shown.contains("Missed: 1 area, 0.75 m²; not reached: 1 area, 40.20 m²"), "{shown}");
    assert!(shown.contains("! expected complete, actual aborted"), "{shown}");
    for (size, line) in [
        ((120, 36), "Worst plate R-03-05: 95 % error 0.19 m!, limit 0.15 m"),
        ((80, 24), "Worst plate R-03-05: "),
    ] {
        screen.send(Msg::Resize { width: size.0, height: size.1 });
        let shown = text(&drawn(&screen.model, RICH, size));
        assert!(shown.contains(line), "{size:?}\n{shown}");
    }
}

#[test]
fn a_result_with_an_instrument_states_its_readings_and_the_untestable_floor() {
    let (mut screen, closed) = ended();
    let mut summary = missed_summary();
    let whole = &mut summary.floor.as_mut().unwrap().whole;
    (whole.untestable, whole.percent.untestable) = (0.173, 17.3);
    summary.readings = serde_json::from_value(serde_json::json!({
        "count": 916_948, "untestable": 159_550, "indications": 53,
        "deepest": { "t_s": 81.2, "at": [1.88, -1.02], "low": [1.85, -1.05], "high": [1.92, -1.0],
                     "error_m": 0.04, "depth_mm": 7.2, "depth_error_mm": 0.59, "readings": 44 },
    }))
    .unwrap();
    screen.hear(RunMsg::Closed(Box::new(RunResult { summary: Box::new(summary), ..closed })));
    let shown = text(&drawn(&screen.model, RICH, (200, 60)));
    assert!(shown.contains("untestable") && shown.contains(" 17.3 "), "{shown}");
    assert!(shown.contains("Readings: 916948; indications: 53; deepest 7.2 ±0.6 mm"), "{shown}");
}

#[test]
fn a_result_states_the_guaranteed_share_with_its_rule_and_the_protection_level() {
    let (mut screen, closed) = ended();
    let mut summary = missed_summary();
    summary.floor.as_mut().unwrap().reachable.percent.guaranteed = Some(84.2);
    let mut accuracy: account::Accuracy = serde_json::from_value(serde_json::json!({
        "mean_m": 0.04, "p95_m": 0.06, "max_m": 0.1, "limit_m": 0.15, "over_limit": 0.0, "fixes": 900,
        "stations_mean": 6.0, "stations_min": 6,
        "protection": { "p50_m": 0.146, "p95_m": 0.193, "max_m": 0.273, "unprotected": 0.021, "guarantees": true },
    }))
    .unwrap();
    let mut shown = |accuracy, size| {
        let summary = Box::new(Summary { accuracy: Some(accuracy), ..summary.clone() });
        screen.hear(RunMsg::Closed(Box::new(RunResult { summary, ..closed.clone() })));
        text(&drawn(&screen.model, RICH, size))
    };
    // The pane wraps its sentences between words.
    let wanted = ["Guaranteed by the protection", "84.2 %", "Protection level: median 0.15", "0.27 m"];
    for (size, wanted) in [((80, 24), &wanted[..2]), ((120, 36), &wanted[..]), ((200, 60), &wanted[..])] {
        let shown = shown(accuracy, size);
        assert!(wanted.iter().all(|words| shown.contains(words)), "{size:?}\n{shown}");
    }
    accuracy.protection.as_mut().unwrap().guarantees = false;
    let by_ellipse = shown(accuracy, (120, 36));
    assert!(by_ellipse.contains("Guaranteed by the 95 % ellipse:"), "{by_ellipse}");
}

#[test]
fn result_of_a_rescan() {
    let (mut screen, closed) = ended();
    let closed = RunResult { summary: Box::new(missed_summary()), ..closed };
    let earlier = vec!["20261122T030000Z-tank-07-rpf-42".into()];
    screen.hear(RunMsg::Continues(Ok(Continued { runs: earlier, left_at: None })));
    let runs = vec!["20261122T030000Z-tank-07-rpf-42".into(), closed.name.clone().unwrap()];
    let floor = closed.summary.floor.clone().unwrap();
    assert_eq!(
        screen.hear(RunMsg::Closed(Box::new(closed))),
        [Effect::Combine(runs.clone()), Effect::Look],
        "the runs are combined"
    );
    let mut all = floor;
    (all.reachable.percent.scanned, all.reachable.percent.missed) = (99.1, 0.9);
    all.missed.truncate(0);
    let cells = screen.model.live.run.coverage.as_ref().unwrap().floor().len() as u32;
    let (earlier, scanned) = (screen.model.live.earlier.clone(), vec![world::CellRun(0, cells)]);
    screen.hear(RunMsg::Combined(Ok(Box::new(Combination {
        earlier,
        floor: all,
        kinds: Vec::new(),
        taken_back: Some(account::Regained { area_m2: 20.8, again_m2: 20.8 }),
        scanned,
        not_requested: Vec::new(),
    }))));
    for size in [(60, 16), (80, 24), (120, 36), (200, 60)] {
        let shown = text(&drawn(&screen.model, RICH, size)).split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(shown.contains("99.1 %"), "the figure of all runs at {size:?}\n{shown}");
        assert!(
            size.0 < 80 || shown.contains("20.8"),
            "the floor that lost its guarantee at {size:?}\n{shown}"
        );
    }
    let scanned = screen.model.live.scanned().unwrap().reachable();
    assert!(scanned.missed == 0.0, "the map shows what the first run scanned: {scanned:?}");
    screen.model.live.run.planning.info.iter_mut().for_each(|planner| planner.covers = true);
    sizes::store("result_rescan", &mut screen, sizes::is_log);
    let effects = screen.type_text("r");
    assert!(
        matches!(&effects[..], [Effect::Open { source: Source::Rescan(again), .. }] if *again == runs),
        "the next re-scan is of what all runs missed: {effects:?}"
    );
}

#[test]
fn a_result_shows_the_whole_tank_although_the_mission_was_zoomed() {
    let (mut screen, closed) = ended();
    screen.type_text("3zz");
    assert!(screen.model.ui.map.zoom > 0);
    screen.hear(RunMsg::Closed(Box::new(closed)));
    assert_eq!(screen.model.ui.screen, tui::model::Screen::Result);
    assert_eq!(screen.model.ui.map, tui::model::ui::MapView::default());
}

/// A run that has ended, and its result.
pub(crate) fn ended() -> (Screen, RunResult) {
    let mut screen = Screen::running();
    let ended = screen.mission.ended(Outcome::Complete, "end of the preset path reached");
    let mut fold = Fold::new();
    for event in screen.mission.opening().iter().chain([&ended]) {
        fold.apply(event);
    }
    screen.hear(RunMsg::Events(vec![ended]));
    assert!(matches!(screen.model.live.run.phase(), mission::Phase::Ended(_)));
    let result = RunResult {
        summary: Box::new(Summary { holds: 2, ..fold.summary() }),
        name: Some("20261122T040049Z-tank-07-rpf-42".into()),
        kept: "run kept in logs/20261122T040049Z-tank-07-rpf-42".into(),
        is_kept: true,
    };
    screen.hear(RunMsg::Closed(Box::new(result.clone())));
    (screen, result)
}

/// A mission that is held, with the forecast of its own planner.
fn forecast() -> Screen {
    let mut screen = Screen::held();
    let effects = screen.type_text("w");
    assert_eq!(
        effects,
        [Effect::Forecast(vec![choice("rpf")])],
        "a preset path is flown by the planner that it has"
    );
    let outlook = Outlook {
        choice: choice("rpf"),
        outcome: Some(Outcome::Complete),
        reason: "end of the preset path reached".into(),
        after_s: 1520.0,
        length_m: 303.9,
        reachable: 0.971,
        clearance_min_m: 0.12,
        tether_length_max_m: None,
        wrap_max_rad: None,
    };
    let path = vec![Point::new(-0.8, 7.4), Point::new(0.0, 0.0)];
    screen.hear(RunMsg::Forecast(
        choice("rpf"),
        Ok(Box::new(Forecast { outlook, path, certified: Some(true) })),
    ));
    screen
}

#[test]
fn forecasts_are_also_said_in_sentences() {
    let mut said = tui::plain::Said::default();
    said.next(&Screen::held().model);
    let lines = said.next(&forecast().model);
    let of_it: Vec<_> = lines.iter().filter(|line| line.starts_with("What-if")).collect();
    assert_eq!(
        of_it,
        [
            "What-if rpf: complete after 00:25:20, 303.9 m, 97.1 % of reachable floor, clearance 0.12 m: end of the preset \
          path reached."
        ]
    );
    assert!(said.next(&forecast().model).is_empty(), "once");
}

#[test]
fn what_if() {
    let mut screen = forecast();
    screen.type_text("+");
    screen.press([Key::Enter]);
    screen.hear(RunMsg::ForecastAt(choice("spiral-tangent"), 0.42));
    sizes::store("what_if", &mut screen, |_| false);
    // In 7-bit characters, the arrow keys must not look like the keys for the speed.
    screen.model.console.keys.spells_arrows = true;
    let shown = text(&drawn(&screen.model, crate::fixture::ASCII, (120, 36)));
    assert!(shown.contains("right left select") && !shown.contains("> < select"), "{shown}");
    screen.model.console.keys.spells_arrows = false;
}

#[test]
fn a_forecast_is_chosen_with_a_question_and_what_was_compared_is_written_down() {
    let mut screen = forecast();
    screen.type_text("+");
    let added = screen.press([Key::Enter]);
    assert_eq!(added, [Effect::Forecast(vec![choice("spiral-tangent")])]);
    assert_eq!(screen.press([Key::Enter]), [], "it is not finished");
    let Some(Ok(mut made)) = screen.model.live.what_if.as_ref().unwrap().candidates[0].made.clone() else {
        panic!()
    };
    made.outlook.choice = choice("spiral-tangent");
    screen.hear(RunMsg::Forecast(choice("spiral-tangent"), Ok(Box::new(made))));
    let effects = screen.press([Key::Enter]);
    assert!(
        matches!(&effects[..], [Effect::Order(Order::NoteOutlooks(noted))] if noted.len() == 2),
        "{effects:?}"
    );
    assert_eq!(screen.press([Key::Enter]), [Effect::Order(Order::ChoosePlanner(choice("spiral-tangent")))]);
}

#[test]
fn forecasts_are_forgotten_when_the_robot_moves_again() {
    let mut screen = forecast();
    let resumed = screen.mission.obeyed(Order::Resume);
    assert_eq!(screen.hear(RunMsg::Events(resumed)), [Effect::StopForecasting]);
    assert_eq!((&screen.model.live.what_if, &screen.model.ui.overlay), (&None, &tui::model::Overlay::None));
}

#[test]
fn plugins() {
    let mut screen = Screen::running();
    let mut found = crate::fixture::planners();
    found[1].sha256 = "77aa".into();
    found[1].parameters.pop();
    found.push(crate::fixture::planner("navfn", "0.3", "Gradient of a navigation function"));
    screen.send(Msg::Planners { found, refused: screen.model.console.refused.clone() });
    screen.type_text("8");
    let changes = screen.model.console.reloaded.clone().unwrap();
    assert_eq!(changes, ["rpf: rebuilt, parameters -improved", "navfn: new, from spiral.so"]);
    sizes::store("plugins", &mut screen, |_| false);
    assert_eq!(screen.type_text("r"), [], "not while the robot moves");
    let mut screen = Screen::held();
    assert_eq!(screen.type_text("8r"), [Effect::Survey]);
}

#[test]
fn a_late_estimate_of_a_plan_that_was_replaced_is_not_shown() {
    let mut screen = Screen::idle();
    let ask = |n| AskId { worker: WorkerId(0), n };
    let planned = |screen: &Screen, n| vec![screen.mission.now(screen.mission.planned(Some(ask(n))))];
    let first = planned(&screen, 2);
    screen.hear(RunMsg::Events(first));
    let second = planned(&screen, 3);
    screen.hear(RunMsg::Events(second));
    screen.hear(RunMsg::Estimated(Some(ask(2)), Box::new(estimate(1.0))));
    assert_eq!(screen.model.live.estimate(), None);
    screen.hear(RunMsg::Estimated(Some(ask(3)), Box::new(estimate(2.0))));
    assert_eq!(screen.model.live.estimate().map(|estimate| estimate.length_m), Some(2.0));
    let kind = |event: &mission::Event| matches!(event.kind, EventKind::Planned { .. });
    assert!(planned(&screen, 4).iter().all(kind));
}
