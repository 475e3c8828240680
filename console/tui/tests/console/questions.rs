//! Every question, with its keys, at the smallest size of a whole screen.

use crate::fixture::{RICH, Screen, choice};
use crate::screens::{drawn, text};
use mission::{HoldReason, ParamValue, PlannerChoice};
use tui::model::Overlay;
use tui::model::ui::Ask;
use tui::{Msg, RunMsg};

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
