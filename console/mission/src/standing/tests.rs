use super::*;
use crate::{
    order::{Injection, Note, Noted, RangeFault},
    phase::{Gait, Outcome, Resumes, StepTo},
    planner::{ParamValue, Parameters, PlannerChoice},
};
use world::StationId;

fn phases() -> Vec<Phase> {
    let held = HoldReason::every("m").into_iter().flat_map(|by| {
        [Resumes::Never, Resumes::WhenCleared, Resumes::ByFallback]
            .map(|resumes| Phase::Held(Hold { by: by.clone(), resumes }))
    });
    let others = [
        Phase::Waiting,
        Phase::Running(Gait::Steady),
        Phase::Running(Gait::OneTick),
        Phase::Running(Gait::Back),
        Phase::Ended(Outcome::Complete),
    ];
    others.into_iter().chain(held).collect()
}

fn orders() -> Vec<Order> {
    let choice = PlannerChoice { id: "apf".into(), parameters: Parameters::new() };
    vec![
        Order::Plan,
        Order::NoteOutlooks(Vec::new()),
        Order::NoteChecks(Vec::new()),
        Order::Start,
        Order::Hold,
        Order::Resume,
        Order::Step,
        Order::StepTo(StepTo::LaneEnd),
        Order::DriveBack,
        Order::FlyUncertified,
        Order::Abort,
        Order::CheckPlanner,
        Order::ChoosePlanner(choice.clone()),
        Order::Shadow(choice),
        Order::Promote,
        Order::DropShadow,
        Order::TakePlan,
        Order::SetParameter { key: "gain".into(), value: ParamValue::Flag(true) },
        Order::Inject(Injection { station: StationId(1), fault: RangeFault::Dead, for_s: 20.0, by: None }),
        Order::UseStation { station: StationId(1), used: false, by: None },
        Order::Note(Note {
            what: Noted::Acknowledged { alarm: "no_fix".into(), text: "no fix".into() },
            by: None,
        }),
    ]
}

fn standing(phase: &Phase, position: PositionTrust) -> Standing<'_> {
    let shadow = ShadowTally { answered: 40, in_row: READY_AFTER, missed: 2 };
    Standing {
        phase,
        position,
        planner: None,
        shadow: Some(InShadow { tally: shadow, has_planned: true }),
        offer: Some(OfferStage::Offered),
        readiness: Readiness::Unseen,
        trouble: None,
        from_plan_m: None,
        is_live: false,
        is_survey: false,
    }
}

#[test]
fn hold_and_abort_are_accepted_in_every_phase_that_has_anything_to_stop() {
    let lost = PositionTrust::Lost { limit_m: 0.3 };
    for position in [PositionTrust::Good, lost, PositionTrust::Alarmed] {
        for phase in phases() {
            let standing = standing(&phase, position);
            let under_way = matches!(phase, Phase::Running(_) | Phase::Held(_));
            assert_eq!(standing.allows(&Order::Hold).is_ok(), under_way, "{phase:?}");
            assert_eq!(standing.allows(&Order::Abort).is_ok(), !matches!(phase, Phase::Ended(_)));
            assert!(!phase.may_move() || standing.allows(&Order::Hold).is_ok(), "{phase:?}");
        }
    }
}

#[test]
fn nothing_that_moves_the_robot_is_accepted_without_a_position() {
    let lost = PositionTrust::Lost { limit_m: 0.3 };
    for position in [lost, PositionTrust::Alarmed] {
        for phase in phases() {
            let moves = [
                Order::Resume,
                Order::Step,
                Order::StepTo(StepTo::Event),
                Order::DriveBack,
                Order::FlyUncertified,
            ];
            for order in moves {
                assert!(standing(&phase, position).allows(&order).is_err(), "{phase:?} {order:?}");
            }
        }
    }
}

#[test]
fn the_whole_table() {
    let word = |text: &str| text.split(['(', ' ', '{']).next().unwrap_or_default().to_owned();
    let mut table = Vec::new();
    for phase in phases().iter().filter(|phase| !matches!(phase, Phase::Held(h) if !h.resumes.is_never())) {
        for order in orders() {
            let answer = match standing(phase, PositionTrust::Good).allows(&order) {
                Ok(()) => "accepted".to_owned(),
                Err(why) => why.to_string(),
            };
            let (order, phase) = (format!("{order:?}"), format!("{phase:?}"));
            let by = phase.split("by: ").nth(1).map(|by| format!(" {}", word(by))).unwrap_or_default();
            let (phase, by) = (word(&phase), by.trim_end_matches(','));
            table.push(format!("{phase}{by}: {}: {answer}", word(&order)));
        }
    }
    insta::assert_snapshot!(table.join("\n"));
}

#[test]
fn a_planner_takes_over_from_shadow_only_after_it_has_answered_some_steps_in_a_row() {
    let running = Phase::Running(Gait::Steady);
    let promote = |tally: Option<ShadowTally>| {
        let shadow = tally.map(|tally| InShadow { tally, has_planned: true });
        Standing { shadow, ..standing(&running, PositionTrust::Good) }.allows(&Order::Promote)
    };
    assert_eq!(promote(None), Err(Refusal::NoShadow));
    let fresh = ShadowTally { in_row: READY_AFTER - 1, ..ShadowTally::default() };
    assert_eq!(promote(Some(fresh)), Err(Refusal::ShadowNotReady { in_row: READY_AFTER - 1 }));
    assert_eq!(promote(Some(ShadowTally { in_row: READY_AFTER, ..fresh })), Ok(()));
}

#[test]
fn while_the_robot_is_held_a_planner_takes_over_from_shadow_as_soon_as_it_has_a_plan() {
    let held = Phase::Held(Hold { by: HoldReason::Operator, resumes: Resumes::Never });
    let promote = |has_planned, position| {
        let shadow = Some(InShadow { has_planned, ..InShadow::default() });
        Standing { shadow, ..standing(&held, position) }.allows(&Order::Promote)
    };
    assert_eq!(promote(false, PositionTrust::Good), Err(Refusal::ShadowHasNoPlan));
    assert_eq!(promote(true, PositionTrust::Good), Ok(()));
    assert_eq!(promote(true, PositionTrust::Alarmed), Err(Refusal::RangesInconsistent));
}
