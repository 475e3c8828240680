//! Every question, with its keys, at the smallest size of a whole screen.

use crate::fixture::{RICH, Screen, choice};
use crate::screens::{drawn, roles, text};
use crate::sizes::SIZES;
use mission::{HoldReason, ParamValue, PlannerChoice, ZoneCost};
use tui::model::ui::Ask;
use tui::model::{Continued, Overlay};
use tui::{Msg, RunMsg};
use world::Point;

/// The longest id of a shipped planner, with parameters that are not the default.
fn long_choice() -> PlannerChoice {
    let parameters = choice("rpf").parameters;
    let more = (0..12).map(|n| (format!("parameter_{n}"), ParamValue::Float(1.0)));
    PlannerChoice { id: "apf-virtual-goals".into(), parameters: parameters.into_iter().chain(more).collect() }
}

fn questions() -> Vec<Overlay> {
    let asks = [
        Ask::Start(None),
        Ask::Resume,
        Ask::FlyUncertified,
        Ask::Swap(choice("tether-safe")),
        Ask::Swap(long_choice()),
        Ask::Promote,
        Ask::TakePlan,
        Ask::DriveBack,
        Ask::DrawZone(Vec::new()),
        Ask::Set { key: "k_att".into(), value: ParamValue::Float(2.5), list: None },
    ];
    let asks = asks.map(Overlay::Confirm);
    asks.into_iter().chain([Overlay::Quit, Overlay::Stepping]).collect()
}

#[test]
fn no_question_is_cut_at_60x16() {
    for make in [Screen::held, Screen::tethered, Screen::idle] {
        let mut screen = make();
        screen.send(Msg::Resize { width: 60, height: 16 });
        // The question about a planner that is active already names its parameters.
        if let Some(active) = &mut screen.model.live.run.planning.choice {
            active.id = long_choice().id;
        }
        for question in questions() {
            screen.model.ui.overlay = question.clone();
            let shown = text(&drawn(&screen.model, RICH, (60, 16)));
            let lines: Vec<&str> = shown.lines().collect();
            let from = lines.iter().rposition(|line| line.contains('?') && line.contains(' ')).unwrap_or(0);
            let asked = lines[from.saturating_sub(1)..].join("\n");
            assert!(asked.contains("Esc: "), "{question:?}\n{shown}");
            assert!(!lines[lines.len() - 4..].iter().any(|line| line.contains('…')), "{question:?}\n{shown}");
        }
    }
}

/// The words of the open question: those of the rows that have its colour, without the state and the keys.
fn asked(screen: &mut Screen, size: (u16, u16)) -> String {
    screen.send(Msg::Resize { width: size.0, height: size.1 });
    let (shown, roles) = (text(&drawn(&screen.model, RICH, size)), roles(&screen.model, RICH, size));
    let rows = shown.lines().zip(roles.lines()).filter(|(_, roles)| roles.trim_matches('_').starts_with('c'));
    rows.flat_map(|(row, _)| row.split_whitespace()).collect::<Vec<_>>().join(" ")
}

/// A re-scan that waits for its start away from where the earlier run left the robot.
fn rescan() -> Screen {
    let mut screen = crate::maps::rescan();
    let left_at = Some(Point::new(-2.0, 3.0));
    screen.hear(RunMsg::Continues(Ok(Continued { runs: vec!["first".into()], left_at })));
    screen
}

#[test]
fn every_question_says_the_same_at_every_size() {
    let cost = ZoneCost {
        path_m: 12.4,
        closed_m2: 3.21,
        lost_m2: 1.05,
        holds: true,
        drops_offer: true,
        blocks_way_back: true,
    };
    for make in [Screen::held, Screen::tethered, Screen::idle, rescan] {
        let mut screen = make();
        screen.model.live.zone_cost = Some(cost);
        for question in questions() {
            screen.model.ui.overlay = question.clone();
            let whole = asked(&mut screen, SIZES[3]);
            assert!(whole.contains("Esc: "), "{question:?}: {whole}");
            for size in SIZES {
                assert_eq!(asked(&mut screen, size), whole, "{question:?} at {size:?}");
            }
        }
    }
}

#[test]
fn the_question_before_a_re_scan_says_where_the_robot_must_stand_at_every_size() {
    let mut screen = rescan();
    screen.model.ui.overlay = Overlay::Confirm(Ask::Start(None));
    for size in SIZES {
        let question = asked(&mut screen, size);
        for words in ["must stand at 9.40, 0.00 m", "it was left ", "The scan resumes at ", "a second time."]
        {
            assert!(question.contains(words), "{size:?}: {words}: {question}");
        }
    }
}

#[test]
fn every_hold_of_a_planner_or_the_operator_names_a_key_at_60x16() {
    let message = || "the certificate was refused: 31.2 m of tether out at 2.0, 3.0 m".to_owned();
    let holds = [
        HoldReason::Operator,
        HoldReason::PlannerReplaced,
        HoldReason::PlanRefused { message: message() },
        HoldReason::PlannerFault { message: message() },
        HoldReason::PlannerSilent { message: message() },
        HoldReason::Stuck { message: message() },
        HoldReason::Stepped,
    ];
    for by in holds {
        let mut screen = Screen::running();
        screen.send(Msg::Resize { width: 60, height: 16 });
        let held = screen.mission.held(by.clone());
        screen.hear(RunMsg::Events(vec![held]));
        // A fault of the planner that drives comes with the hold.
        for faulty in [false, true] {
            if faulty {
                let events = screen.mission.planner_fails();
                screen.hear(RunMsg::Events(events[..1].to_vec()));
            }
            let shown = text(&drawn(&screen.model, RICH, (60, 16)));
            let line = shown.lines().find(|line| line.contains("HELD") && line.contains(". ")).unwrap_or("");
            let (_, rest) = line.split_once(". ").unwrap_or_default();
            assert!(rest.contains(": "), "{by:?} {faulty}\n{shown}");
        }
    }
}
