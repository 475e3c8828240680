//! A better plan on the screen: what it saves, which key takes it, and the question before.

use crate::fixture::{RICH, Screen};
use crate::screens::{drawn, text};
use mission::event::{Effort, OfferEnd, OfferStage, PlanScan, PlanScans};
use mission::{AskId, BetterPlan, EventKind, Order, WorkerId};
use tui::{Effect, Key, RunMsg};
use world::Point;

const FLOWN: Effort = Effort { length_m: 860.0, rotation_rad: 190.0, time_s: 2460.0 };
const BETTER: Effort = Effort { length_m: 792.0, rotation_rad: 150.0, time_s: 2238.0 };

const SCANS: PlanScans = PlanScans {
    flown: PlanScan { left_m2: 0.4, covered_reachable: 0.996 },
    better: PlanScan { left_m2: 0.5, covered_reachable: 0.995 },
};

fn hear(screen: &mut Screen, kind: EventKind) {
    let event = screen.mission.now(kind);
    screen.hear(RunMsg::Events(vec![event]));
}

fn better_plan(objection: Option<String>) -> EventKind {
    EventKind::BetterPlanned {
        ask: AskId { worker: WorkerId(2), n: 2 },
        planner: "rpf".into(),
        path: vec![Point::new(2.0, 1.5), Point::new(4.0, 1.5)],
        complete: true,
        legs: Vec::new(),
        cuts: Vec::new(),
        flown: FLOWN,
        better: BETTER,
        scans: objection.is_none().then_some(SCANS),
        objection,
    }
}

fn with_offer() -> Screen {
    let mut screen = Screen::running();
    hear(&mut screen, better_plan(None));
    screen
}

fn shown_at(screen: &Screen, size: (u16, u16)) -> String {
    text(&drawn(&screen.model, RICH, size))
}

fn dropped() -> EventKind {
    let reason = OfferEnd::Passed;
    let (why, stage) = (reason.to_string(), Some(OfferStage::Offered));
    EventKind::BetterPlanDropped { planner: "rpf".into(), why, stage, reason: Some(reason) }
}

#[test]
fn what_a_better_plan_saves_and_the_key_that_takes_it_are_shown() {
    insta::assert_snapshot!(shown_at(&with_offer(), (120, 36)));
}

#[test]
fn a_better_plan_is_taken_by_its_key_or_by_its_command_after_a_question() {
    for by_key in [true, false] {
        let mut screen = with_offer();
        if by_key {
            assert_eq!(screen.press([Key::Char('T')]), []);
        } else {
            screen.type_text(":take-plan");
            assert_eq!(screen.press([Key::Enter]), []);
        }
        let shown = shown_at(&screen, (120, 36));
        assert!(shown.contains("Take the better plan? Enter: take, Esc: cancel."), "{shown}");
        let offer =
            "Better plan: 3.7 min shorter (of 41.0 from there), 68 m less. It scans 99.5 % (now 99.6 %).";
        let flat = shown.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(flat.contains(offer), "{shown}");
        assert_eq!(screen.press([Key::Enter]), [Effect::Order(Order::TakePlan)]);
        hear(&mut screen, EventKind::Ordered { order: Order::TakePlan });
        let shown = shown_at(&screen, (120, 36));
        assert!(shown.contains("saves 3.7 of 41.0 min; taken"), "{shown}");
        hear(&mut screen, EventKind::BetterPlanTaken { planner: "rpf".into(), flown: FLOWN, better: BETTER });
        assert!(screen.model.live.run.planning.offer.is_none());
    }
}

#[test]
fn where_the_scenario_takes_better_plans_nobody_is_asked() {
    let mut screen = Screen::running();
    screen.model.live.run.about.as_mut().unwrap().mission.better_plan = BetterPlan::Take;
    hear(&mut screen, better_plan(None));
    let shown = shown_at(&screen, (120, 36));
    assert!(shown.contains("saves 3.7 of 41.0 min; taken") && !shown.contains("T: take"), "{shown}");
}

#[test]
fn without_an_offer_the_key_says_that_there_is_none() {
    for gone in [better_plan(Some("it saves too little".into())), dropped()] {
        let mut screen = if gone == dropped() { with_offer() } else { Screen::running() };
        hear(&mut screen, gone);
        assert_eq!(screen.press([Key::Char('T')]), []);
        let shown = shown_at(&screen, (120, 36));
        assert!(shown.contains("No better plan is offered"), "{shown}");
    }
}

#[test]
fn a_question_that_is_open_when_the_offer_ends_takes_nothing() {
    let mut screen = with_offer();
    screen.press([Key::Char('T')]);
    hear(&mut screen, dropped());
    assert_eq!(screen.press([Key::Enter]), []);
}
