//! The screens around a mission: what there is to open, what a plan promises, what was achieved.

use crate::fixture::{RICH, Screen, choice};
use crate::panes::missed_summary;
use crate::screens::{drawn, text};
use account::{Estimate, Fold, Summary, estimate::Worst};
use mission::{AskId, EventKind, Order, Outcome, Outlook, Severity, WorkerId};
use tui::model::home::{Attention, Found};
use tui::model::{Forecast, GhostPlan, PastRun, ScenarioEntry};
use tui::{Effect, Msg, RunMsg, RunResult, Source};
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
    ScenarioEntry {
        source: Source::File(format!("scenarios/{name}.toml")),
        name: name.into(),
        about: "Round tank with five known columns".into(),
        task: task.into(),
        tank: "Ø12 m".into(),
        planner: planner.into(),
        expected: "complete, no collision".into(),
        problem: None,
        world: None,
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

fn found() -> Found {
    let invalid = ScenarioEntry {
        problem: Some("scenarios/depot.toml:14:1: unknown key `radus_m`, did you mean `radius_m`?".into()),
        ..scenario("depot", "", "")
    };
    let scenarios = vec![
        scenario("corridor", "goto", "navfn"),
        scenario("cover-circle", "cover", "tether-safe"),
        invalid,
        scenario("goto-single-obstacle", "goto", "apf"),
    ];
    let point =
        |severity, kind: &str, text: &str| Attention { severity, kind: kind.into(), text: text.into() };
    Found {
        scenarios,
        runs: vec![
            past("cover-circle", "complete", Some(0.997)),
            past("corridor", "CRASHED", None),
            past("goto-single-obstacle", "RECORDING FAILED", None),
        ],
        logs: "logs".into(),
        free_bytes: Some(71_000_000_000),
        attention: vec![
            point(
                Severity::Warn,
                "CRASHED",
                "run corridor: killed; the journal holds everything up to T+401.0 s",
            ),
            point(Severity::Watch, "INVALID", "depot: scenarios/depot.toml:14:1: unknown key `radus_m`"),
            point(Severity::Info, "ok", "runs can be kept in logs"),
        ],
    }
}

#[test]
fn home() {
    let mut screen = Screen::idle();
    screen.send(Msg::Found(Box::new(found())));
    screen.type_text("1jj");
    store("home", &mut screen);
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
    screen.press([tui::Key::Enter]);
    let path = vec![Point::new(9.4, 0.0), Point::new(0.0, 0.0)];
    let ghost = GhostPlan { path, estimate: estimate(391.2), certified: None };
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
    store("result", &mut ended().0);
}

#[test]
fn result_of_a_rescan() {
    let (mut screen, closed) = ended();
    let closed = RunResult { summary: Box::new(missed_summary()), ..closed };
    screen.model.live.source = Some(Source::Rescan(vec!["20261122T030000Z-tank-07-rpf-42".into()]));
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
    screen.hear(RunMsg::Combined(Ok(Box::new(all))));
    screen.model.live.run.planning.info.iter_mut().for_each(|planner| planner.covers = true);
    store("result_rescan", &mut screen);
    let effects = screen.type_text("r");
    assert!(
        matches!(&effects[..], [Effect::Open { source: Source::Rescan(again), .. }] if *again == runs),
        "the next re-scan is of what all runs missed: {effects:?}"
    );
}

/// A run that has ended, and what it leaves.
fn ended() -> (Screen, RunResult) {
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
    screen.hear(RunMsg::Forecast(choice("rpf"), Ok(Box::new(Forecast { outlook, path }))));
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
    screen.press([tui::Key::Enter]);
    screen.hear(RunMsg::ForecastAt(choice("spiral-tangent"), 0.42));
    store("what_if", &mut screen);
}

#[test]
fn a_forecast_is_chosen_with_a_question_and_what_was_compared_is_written_down() {
    let mut screen = forecast();
    screen.type_text("+");
    let added = screen.press([tui::Key::Enter]);
    assert_eq!(added, [Effect::Forecast(vec![choice("spiral-tangent")])]);
    assert_eq!(screen.press([tui::Key::Enter]), [], "it is not finished");
    let Some(Ok(mut made)) = screen.model.live.what_if.as_ref().unwrap().candidates[0].made.clone() else {
        panic!()
    };
    made.outlook.choice = choice("spiral-tangent");
    screen.hear(RunMsg::Forecast(choice("spiral-tangent"), Ok(Box::new(made))));
    let effects = screen.press([tui::Key::Enter]);
    assert!(
        matches!(&effects[..], [Effect::Order(Order::NoteOutlooks(noted))] if noted.len() == 2),
        "{effects:?}"
    );
    assert_eq!(
        screen.press([tui::Key::Enter]),
        [Effect::Order(Order::ChoosePlanner(choice("spiral-tangent")))]
    );
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
    store("plugins", &mut screen);
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
