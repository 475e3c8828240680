//! A planner in shadow on the screen: its ghost and figures, and the question before it takes over.

use crate::fixture::{RICH, Screen, choice, planners};
use crate::screens::{drawn, text};
use mission::{AskId, EventKind, Order, WorkerId, event::ShadowTally};
use planner_api::{Command, Reason};
use tui::{Effect, Key, RunMsg};
use world::Point;

fn hear(screen: &mut Screen, kind: EventKind) {
    let event = screen.mission.now(kind);
    screen.hear(RunMsg::Events(vec![event]));
}

fn shadowed(kind: EventKind) -> EventKind {
    EventKind::Shadowed { of: Box::new(kind) }
}

fn ask(n: u32) -> AskId {
    AskId { worker: WorkerId(2), n }
}

/// A running mission with a planner in shadow that has answered some steps.
fn with_shadow(n_steps: u32) -> Screen {
    let mut screen = Screen::running();
    hear(&mut screen, EventKind::Ordered { order: Order::Shadow(choice("spiral-tangent")) });
    let info = Box::new(planners().remove(2));
    hear(&mut screen, EventKind::ShadowBegan { ask: ask(1), choice: choice("spiral-tangent"), info });
    let at = screen.model.live.run.position.pose.map_or(Point::origin(), |pose| pose.position);
    let path = vec![at, at + world::Vector::new(1.5, -1.0), at + world::Vector::new(3.0, -1.0)];
    let (planner, reason) = ("spiral-tangent".into(), Reason::Swap { from: "rpf".into() });
    let (legs, cuts) = (Vec::new(), Vec::new());
    let ask_id = Some(ask(2));
    hear(
        &mut screen,
        shadowed(EventKind::Planned {
            ask: ask_id,
            return_path: 0,
            planner,
            reason,
            path,
            length_m: 3.8,
            complete: true,
            legs,
            cuts,
        }),
    );
    for n in 0..n_steps {
        let command = Command::velocity(world::Vector::new(0.3, -0.2));
        hear(&mut screen, shadowed(EventKind::Commanded { ask: Some(ask(3 + n)), command, asked: None }));
    }
    screen
}

fn shown_at(screen: &Screen, size: (u16, u16)) -> String {
    text(&drawn(&screen.model, RICH, size))
}

fn pane_rows(screen: &Screen) -> Vec<String> {
    let shown = shown_at(screen, (160, 45));
    let words = ["│ shadow ", "│ differs ", "│ clear "];
    shown.lines().filter(|line| words.iter().any(|word| line.contains(word))).map(str::to_owned).collect()
}

#[test]
fn ghost_and_figures_are_shown_beside_what_drives() {
    let mut screen = with_shadow(12);
    hear(&mut screen, EventKind::ShadowMissed { ask: ask(40), ticks: 3 });
    insta::assert_snapshot!(shown_at(&screen, (120, 36)));
    let rows = pane_rows(&screen).join("\n");
    assert!(rows.contains("0 of 10 steps, 3 missed"), "{rows}");
}

#[test]
fn a_planner_takes_over_from_shadow_only_when_it_is_ready_and_the_operator_agreed() {
    let promote = [Effect::Order(Order::Promote), Effect::StopForecasting];
    let mut screen = with_shadow(9);
    screen.type_text(":promote");
    screen.press([Key::Enter]);
    let shown = shown_at(&screen, (120, 36));
    assert!(shown.contains("9 steps in a row"), "{shown}");
    let mut screen = with_shadow(10);
    screen.type_text(":promote");
    assert!(matches!(&screen.press([Key::Enter])[..], [Effect::Forecast(both)] if both.len() == 2));
    let shown = shown_at(&screen, (120, 36));
    assert!(shown.contains("Promote spiral-tangent from shadow? Enter: promote, Esc: cancel."), "{shown}");
    assert_eq!(screen.press([Key::Enter]), promote);
    let tally = ShadowTally { answered: 10, in_row: 10, missed: 0 };
    hear(&mut screen, EventKind::Promoted { planner: "spiral-tangent".into(), tally });
    assert!(screen.model.live.run.shadow.is_none() && pane_rows(&screen).is_empty());
}

#[test]
fn a_shadow_is_chosen_by_name_or_from_the_list_and_dropped_again() {
    let shadow = |id: &str| vec![Effect::Order(Order::Shadow(choice(id)))];
    let mut screen = Screen::running();
    screen.type_text(":shadow spiral-tangent");
    assert_eq!(screen.press([Key::Enter]), shadow("spiral-tangent"));
    screen.type_text(":shadow");
    screen.press([Key::Enter]);
    assert_eq!(screen.press([Key::Down, Key::Enter]), shadow("spiral-tangent"));
    screen.type_text(":shadow-off");
    assert_eq!(screen.press([Key::Enter]), [], "there is none yet");
    let mut screen = with_shadow(1);
    screen.type_text(":shadow-off");
    assert_eq!(screen.press([Key::Enter]), [Effect::Order(Order::DropShadow)]);
}

#[test]
fn a_list_that_is_open_when_the_mission_ends_starts_no_shadow() {
    let mut screen = Screen::running();
    screen.type_text(":shadow");
    screen.press([Key::Enter, Key::Down]);
    let ended = screen.mission.ended(mission::Outcome::Complete, "task complete");
    screen.hear(RunMsg::Events(vec![ended]));
    assert_eq!(screen.press([Key::Enter]), []);
}

#[test]
fn a_rebuilt_planner_is_offered_in_shadow_while_the_mission_runs() {
    let rebuilt = || {
        let mut found = planners();
        found[1].sha256 = "another build".into();
        tui::Msg::Planners { found, refused: Vec::new() }
    };
    let id = planners()[1].id.clone();
    let mut screen = Screen::running();
    screen.send(rebuilt());
    let said = screen.model.notice().map(|notice| notice.text.clone()).unwrap_or_default();
    assert_eq!(said, format!("planner {id} was rebuilt: :shadow {id} runs the new build in shadow"));
    let mut screen = Screen::idle();
    screen.send(rebuilt());
    assert!(!screen.model.notice().is_some_and(|notice| notice.text.contains("rebuilt")));
}

#[test]
fn the_plan_of_the_shadow_stays_on_the_map_of_a_held_mission_and_its_length_is_in_the_question() {
    let mut screen = with_shadow(0);
    let held = screen.mission.held(mission::HoldReason::Operator);
    screen.hear(RunMsg::Events(vec![held]));
    let shown = shown_at(&screen, (120, 36));
    assert!(shown.contains("shadow"), "the legend names it: {shown}");
    let mut without = screen.model.clone();
    without.live.run.shadow.as_mut().expect("a shadow").path.clear();
    let map = |model: &tui::model::Model| text(&drawn(model, RICH, (120, 36)));
    assert_ne!(map(&screen.model), map(&without), "the plan is drawn");
    screen.type_text(":promote");
    screen.press([Key::Enter]);
    let shown = shown_at(&screen, (120, 36));
    let words = shown.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(words.contains("the robot stays held. Its plan: 3.8 m for the rest of the task."), "{words}");
    assert!(!words.contains("without a hold"), "{words}");
    screen.model.live.run.about.as_mut().expect("a mission").mission.tether = Some(crate::fixture::tether());
    assert!(shown_at(&screen, (120, 36)).contains("Its certificate for the tether"));
}
