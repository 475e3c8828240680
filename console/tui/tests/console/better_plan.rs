//! A better plan on the screen: its saving, the key that takes it, and the question that comes
//! first.

use crate::fixture::{RICH, Screen};
use crate::screens::{drawn, text};
use mission::event::{Effort, OfferEnd, OfferStage, PlanDropped, PlanMade, PlanScan, PlanScans, PlanTaken};
use mission::{AskId, BetterPlan, EventKind, Order, WorkerId};
use tui::{Effect, Key, RunMsg, Speed};
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
    EventKind::BetterPlanned(PlanMade {
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
    })
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
    EventKind::BetterPlanDropped(PlanDropped { planner: "rpf".into(), why, stage, reason: Some(reason) })
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
            "Better plan: 3.7 min less (of 41.0 remaining), 68 m shorter. It scans 99.5 % (now 99.6 %).";
        let flat = shown.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(flat.contains(offer), "{shown}");
        assert_eq!(screen.press([Key::Enter]), [Effect::Order(Order::TakePlan)]);
        hear(&mut screen, EventKind::Ordered { order: Order::TakePlan });
        let shown = shown_at(&screen, (120, 36));
        assert!(shown.contains("Better plan accepted"), "{shown}");
        hear(
            &mut screen,
            EventKind::BetterPlanTaken(PlanTaken { planner: "rpf".into(), flown: FLOWN, better: BETTER }),
        );
        assert!(screen.model.live.run.planning.offer.is_none());
    }
}

#[test]
fn where_the_scenario_takes_better_plans_nobody_is_asked() {
    let mut screen = Screen::running();
    screen.model.live.run.about.as_mut().unwrap().mission.better_plan = BetterPlan::Take;
    hear(&mut screen, better_plan(None));
    let shown = shown_at(&screen, (120, 36));
    assert!(shown.contains("Better plan accepted") && !shown.contains("T: take"), "{shown}");
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

fn fast() -> Screen {
    let mut screen = Screen::running();
    screen.type_text(":speed 32");
    assert_eq!(screen.press([Key::Enter]), [Effect::Speed(Speed::Times(32.0))]);
    screen
}

fn hear_effects(screen: &mut Screen, kind: EventKind) -> Vec<Effect> {
    let event = screen.mission.now(kind);
    screen.hear(RunMsg::Events(vec![event]))
}

#[test]
fn an_offer_slows_a_fast_simulation_until_it_ends() {
    let mut screen = fast();
    assert_eq!(hear_effects(&mut screen, better_plan(None)), [Effect::Speed(Speed::Times(1.0))]);
    let said = screen.model.notice().unwrap().text.clone();
    assert!(said.ends_with("T: take; simulation slowed to real time"), "{said}");
    assert_eq!(hear_effects(&mut screen, dropped()), [Effect::Speed(Speed::Times(32.0))]);
    let said = screen.model.notice().unwrap().text.clone();
    assert!(
        said.to_lowercase().contains("offer ended") && said.ends_with("simulation speed is ×32 again"),
        "{said}"
    );
    assert_eq!(screen.model.live.speed, Speed::Times(32.0));
}

#[test]
fn an_offer_slows_the_simulation_until_it_is_taken() {
    let mut screen = fast();
    hear(&mut screen, better_plan(None));
    let taken = hear_effects(&mut screen, EventKind::Ordered { order: Order::TakePlan });
    assert_eq!(taken, [Effect::Speed(Speed::Times(32.0))]);
}

#[test]
fn a_speed_that_the_operator_chose_meanwhile_and_a_hold_stay() {
    for way in [":speed 4", ":hold"] {
        let mut screen = fast();
        hear(&mut screen, better_plan(None));
        screen.type_text(way);
        screen.press([Key::Enter]);
        let speed = screen.model.live.speed;
        assert_eq!(hear_effects(&mut screen, dropped()), [], "{way}");
        assert_eq!(screen.model.live.speed, speed, "{way}");
    }
}

#[test]
fn a_simulation_in_real_time_and_one_run_by_a_script_keep_their_speed() {
    assert_eq!(hear_effects(&mut Screen::running(), better_plan(None)), []);
    let mut scripted = fast();
    scripted.model.console.preferences.slows_for_offers = false;
    assert_eq!(hear_effects(&mut scripted, better_plan(None)), []);
}
