//! A past run that is played back: the list of runs, the keys of a replay, two runs side by side.

use crate::fixture::{RICH, Screen};
use crate::screens::{drawn, text};
use crate::sizes;
use account::{Coverage, Fold, Notes, Summary};
use mission::{Event, Severity};
use std::sync::OnceLock;
use tui::actions::ACTIONS;
use tui::model::home::Found;
use tui::model::replay::{Mark, MarkKind, Reel, Side};
use tui::model::{Model, PastRun, Screen as Name};
use tui::update::act;
use tui::{Effect, Job, Key, Msg, ReplayMsg, RunId, RunMsg, Transport};

const SPACE: Key = Key::Char(' ');
const A: &str = "20261122T040049Z-tank-07-rpf-42";
const B: &str = "20261121T093000Z-tank-07-apf-42";

fn past(name: &str, planner: &str, end: &str) -> PastRun {
    PastRun {
        name: name.into(),
        began: "22 Nov 04:00".into(),
        scenario: "tank-07".into(),
        planner: planner.into(),
        end: end.into(),
        began_unix_s: None,
        verified: None,
        mission_time_s: Some(967.5),
        reachable: (end == "complete").then_some(0.969),
        note: (end == "CRASHED").then(|| "killed; the journal holds everything up to T+401.0 s".into()),
        remark: (planner == "rpf").then(|| "second pass after cleaning".into()),
        bookmarks: usize::from(planner == "rpf"),
    }
}

fn found() -> Found {
    let crashed = past("20261120T120000Z-tank-08-rpf-spiral-1", "spiral-tangent", "CRASHED");
    Found {
        runs: vec![past(A, "rpf", "complete"), past(B, "apf", "aborted"), crashed],
        logs: "logs".into(),
        ..Found::default()
    }
}

/// The events of a run, in the ticks in which they happened.
fn events() -> Vec<Event> {
    let mut mission = Screen::idle().mission;
    let mut events = mission.opening();
    events.extend(mission.start());
    events.extend(mission.drive(1400));
    events.push(mission.excluded());
    events.extend(mission.drive(200));
    events
}

fn summary(share: f64, path_m: f64) -> Box<Summary> {
    let mut fold = Fold::new();
    for event in &events() {
        fold.apply(event);
    }
    let coverage = Coverage {
        reachable: share,
        whole: 0.9 * share,
        overlap: Some(0.17),
        missed_area_m2: Some(1.5),
        by_truth: None,
        taken_back: None,
    };
    Box::new(Summary { coverage: Some(coverage), path_length_m: Some(path_m), ..fold.summary() })
}

/// A run that is played back, with another one beside it.
pub(crate) fn replaying(is_compared: bool) -> Screen {
    static MADE: [OnceLock<Screen>; 2] = [OnceLock::new(), OnceLock::new()];
    MADE[usize::from(is_compared)].get_or_init(|| make_replaying(is_compared)).clone()
}

fn make_replaying(is_compared: bool) -> Screen {
    let mut screen = Screen::idle();
    screen.model = Model::replaying(RunId(1), A.into(), is_compared.then(|| B.into()));
    screen.send(Msg::Found(Box::new(found())));
    let hear = |screen: &mut Screen, msg| drop(screen.hear(RunMsg::Replay(msg)));
    let mut notes = Notes::default();
    notes.mark(300.0, "pump noise").unwrap();
    hear(&mut screen, ReplayMsg::Noted(Ok(notes)));
    let mark = |t_s, severity, kind| Mark { t_s, severity, kind };
    let marks = vec![
        mark(0.5, Severity::Info, MarkKind::Event),
        mark(700.5, Severity::Watch, MarkKind::Alarm),
        mark(720.0, Severity::Info, MarkKind::Hold),
    ];
    let reel = Reel { until_s: 967.5, share: 1.0, is_whole: true, problem: None, marks };
    for side in [Side::A, Side::B] {
        hear(&mut screen, ReplayMsg::Loaded(side, reel.clone()));
    }
    let events = events();
    let (first, rest) = events.split_at(1);
    let mut run = tui::model::Run::default();
    run.fold(&first[0]);
    hear(&mut screen, ReplayMsg::At(Side::A, Box::new(run.clone())));
    hear(&mut screen, ReplayMsg::At(Side::B, Box::new(run)));
    hear(&mut screen, ReplayMsg::Moved(Side::A, rest.to_vec()));
    hear(&mut screen, ReplayMsg::Moved(Side::B, rest[..rest.len() / 2].to_vec()));
    for (side, summary) in [(Side::A, summary(0.969, 1931.0)), (Side::B, summary(0.942, 2214.0))] {
        hear(&mut screen, ReplayMsg::Reported(side, summary, "run kept in logs".into()));
    }
    screen
}

fn seeks(effects: &[Effect]) -> Vec<f64> {
    let seek = |effect: &Effect| match effect {
        Effect::Transport(Transport::Seek(t_s)) => Some(*t_s),
        _ => None,
    };
    effects.iter().filter_map(seek).collect()
}

fn store(name: &str, screen: &mut Screen) {
    for (width, height) in [(120, 36), (80, 24), (60, 16)] {
        screen.send(Msg::Resize { width, height });
        let shown = text(&drawn(&screen.model, RICH, (width, height)));
        insta::assert_snapshot!(format!("{name}_{width}x{height}"), shown);
    }
}

#[test]
fn the_list_of_runs() {
    let mut screen = Screen::idle();
    screen.send(Msg::Found(Box::new(found())));
    screen.type_text("6");
    let known = tui::model::Glimpse::of(replaying(false).model.live.run, Some(summary(0.969, 1931.0)), None);
    screen.send(Msg::Glimpsed((A.into(), "complete".into()), Ok(Box::new(known))));
    sizes::store("review", &mut screen, |part| part.contains('●'));
}

#[test]
fn a_large_screen_shows_missed_areas_and_curves_of_the_selected_run() {
    let mut screen = Screen::idle();
    screen.send(Msg::Found(Box::new(found())));
    screen.type_text("6");
    let (run, summary) = (replaying(false).model.live.run, crate::panes::missed_summary());
    let known = tui::model::Glimpse::of(run, Some(Box::new(summary)), None);
    screen.send(Msg::Glimpsed((A.into(), "complete".into()), Ok(Box::new(known))));
    screen.send(Msg::Resize { width: 200, height: 60 });
    let shown = text(&drawn(&screen.model, RICH, (200, 60)));
    for wanted in ["Missed areas  1", "0.75 m²    1.00, 2.00 m", "95 % error, m"] {
        assert!(shown.contains(wanted), "{wanted}\n{shown}");
    }
}

#[test]
fn a_run_is_played_back_on_the_mission_screen() {
    let mut screen = replaying(false);
    store("replay", &mut screen);
}

#[test]
fn two_runs_are_compared() {
    let mut screen = replaying(true);
    screen.type_text("D");
    store("difference", &mut screen);
    screen.type_text("6");
    let known = tui::model::Glimpse::of(screen.model.live.run.clone(), Some(summary(0.969, 1931.0)), None);
    screen.send(Msg::Glimpsed((A.into(), "complete".into()), Ok(Box::new(known))));
    sizes::store("compare", &mut screen, |part| part.contains('●'));
}

#[test]
fn the_list_is_filtered_while_one_types_and_sorted() {
    let mut screen = Screen::idle();
    screen.send(Msg::Found(Box::new(found())));
    screen.type_text("6/apf");
    assert_eq!(screen.model.review.run(&screen.model.home).map(|run| run.name.as_str()), Some(B));
    screen.press([Key::Esc]);
    screen.type_text("/cleaning tank");
    assert_eq!(screen.model.review.runs(&screen.model.home).len(), 1, "remarks are searched, too");
    screen.press([Key::Esc]);
    screen.type_text("ss");
    let planners: Vec<&str> =
        screen.model.review.runs(&screen.model.home).iter().map(|run| run.planner.as_str()).collect();
    assert_eq!(planners, ["apf", "rpf", "spiral-tangent"]);
}

#[test]
fn a_run_is_chosen_and_takes_the_place_of_a_mission_that_was_not_started() {
    let mut screen = Screen::idle();
    screen.send(Msg::Found(Box::new(found())));
    let effects = screen.press([Key::Char('6'), Key::Down, Key::Enter]);
    assert!(effects.contains(&Effect::Replay { id: RunId(2), run: B.into() }), "{effects:?}");
    assert!(screen.model.live.is_replay() && screen.model.ui.screen == Name::Mission);

    let mut screen = Screen::running();
    screen.send(Msg::Found(Box::new(found())));
    screen.press([Key::Char('6'), Key::Enter]);
    assert!(!screen.model.live.is_replay(), "not while a mission is in progress");
}

#[test]
fn space_plays_and_pauses_and_the_keys_go_to_moments() {
    let mut screen = replaying(false);
    let play = |plays| Effect::Transport(Transport::Play(plays));
    assert_eq!(screen.press([SPACE, SPACE]), [play(true), play(false)]);
    let now_s = screen.model.live.run.clock.t_s;
    assert!((700.5..967.5).contains(&now_s), "{now_s}");
    let mut went = |keys: &str| seeks(&screen.type_text(keys));
    assert_eq!((went("{"), went("["), went("N")), (vec![700.5], vec![720.0], vec![300.0]));
    assert_eq!((went("^"), went("$"), went("n")), (vec![0.0], vec![967.5], vec![]));
    assert_eq!((went(","), went(")")), (vec![now_s - 0.5], vec![now_s + 60.0]));
    screen.type_text(":seek 12:30");
    assert_eq!(seeks(&screen.press([Key::Enter])), [750.0]);
    assert_eq!(screen.type_text(">"), [Effect::Speed(tui::Speed::Times(2.0))]);
}

#[test]
fn looking_for_an_event_pauses() {
    let mut screen = replaying(false);
    let effects = screen.press([SPACE, Key::Char('[')]);
    let play = |plays| Effect::Transport(Transport::Play(plays));
    assert_eq!(effects, [play(true), play(false), Effect::Transport(Transport::Seek(720.0))]);
}

#[test]
fn bookmarks_and_remarks_are_kept_and_unreadable_notes_are_left_alone() {
    let mut screen = replaying(false);
    screen.type_text("bvalve open");
    let effects = screen.press([Key::Enter]);
    let Some(Effect::Transport(Transport::Keep(notes))) = effects.first() else { panic!("{effects:?}") };
    let texts: Vec<&str> = notes.bookmarks.iter().map(|mark| mark.text.as_str()).collect();
    assert_eq!(texts, ["pump noise", "valve open"]);
    assert!(matches!(screen.type_text("B")[..], [Effect::Transport(Transport::Keep(_)), Effect::Look]));
    screen.type_text(":remark \"second pass\"");
    screen.press([Key::Enter]);
    assert_eq!(
        screen.model.live.replay.as_ref().map(|replay| replay.notes.remark.as_str()),
        Some("second pass")
    );

    screen.hear(RunMsg::Replay(ReplayMsg::Noted(Err("notes.json:2:13: invalid type".into()))));
    assert_eq!(screen.type_text("b"), []);
    assert_eq!(
        screen.model.notice().map(|notice| notice.text.as_str()),
        Some("notes.json:2:13: invalid type")
    );
}

#[test]
fn a_second_run_is_taken_and_taken_away_and_aligned() {
    let mut screen = replaying(false);
    let compare = |run: Option<&str>| Effect::Transport(Transport::Compare(run.map(Into::into)));
    assert!(screen.press([Key::Char('6'), Key::Down, Key::Char('c')]).contains(&compare(Some(B))));
    assert!(screen.type_text("c").contains(&compare(None)));
    let mut screen = replaying(true);
    let effects = screen.type_text("T");
    assert!(matches!(effects[..], [Effect::Transport(Transport::Align(_))]), "{effects:?}");
}

#[test]
fn a_replay_gives_no_order_whatever_is_done_and_is_left_without_a_question() {
    for name in Name::ALL {
        for action in ACTIONS.iter() {
            let mut screen = replaying(true);
            screen.model.ui.go(name);
            let mut effects = act(&mut screen.model, action.id);
            effects.extend(screen.press([Key::Enter, Key::Char('y'), Key::Enter, SPACE]));
            let order = effects.iter().find(|effect| matches!(effect, Effect::Order(_)));
            let is_scenario = screen.model.live.access == tui::model::Access::Control;
            assert!(order.is_none() || is_scenario, "{} on {}: {effects:?}", action.name, name.name());
        }
    }
    let mut screen = replaying(false);
    screen.type_text("S");
    let said = screen.model.notice().map(|notice| notice.text.clone()).unwrap_or_default();
    assert!(said.contains("S does nothing here"), "{said}");
    screen.type_text(":start");
    screen.press([Key::Enter]);
    let said = screen.model.notice().map(|notice| notice.text.clone()).unwrap_or_default();
    assert!(said.starts_with("replay, no robot connected"), "{said}");
    screen.type_text("1");
    assert_eq!(screen.type_text("q"), [Effect::Quit { signal: None }]);
}

#[test]
fn the_recording_is_opened_at_the_moment() {
    let mut screen = replaying(false);
    let effects = screen.type_text("o");
    assert!(
        matches!(&effects[..], [Effect::Do(Job::ViewAt(run, at))] if run == A && at.starts_with("T+00:1")),
        "{effects:?}"
    );
}

#[test]
fn a_paused_replay_is_not_silent_and_does_not_wake_the_screen() {
    let mut screen = replaying(false);
    screen.pass(60.0);
    assert_eq!((screen.model.silent_s(), screen.model.wakes_at_mono_s()), (None, None));
}

#[test]
fn no_text_of_a_replay_or_of_the_review_is_cut() {
    for (is_compared, keys) in [(false, ""), (true, ""), (true, "D"), (false, "6"), (true, "6")] {
        for size in [(80, 24), (100, 30), (120, 36), (160, 45), (200, 60)] {
            let mut screen = replaying(is_compared);
            screen.send(Msg::Resize { width: size.0, height: size.1 });
            screen.type_text(keys);
            let shown = text(&drawn(&screen.model, RICH, size));
            // Names, remarks and reasons are of any length.
            let free = ["second pass", "tank-07", "last event:", "killed", "B-20"];
            let cut =
                shown.lines().find(|line| line.contains('…') && !free.iter().any(|word| line.contains(word)));
            assert_eq!(cut, None, "{keys} at {size:?}\n{shown}");
        }
    }
}
