//! Checks which actions are possible now, with the reason if one is not. The footer and the keys use the
//! same checks.

use super::go::{self, named_run};
use super::look_only::{allowed, no_orders};
use super::message::Effect;
use super::{place, replay};
use crate::actions::{ActionId, find};
use crate::model::home::HomeList;
use crate::model::ui::{Arrangement, Ask};
use crate::model::{Model, Overlay, Pane, PastRun, Screen};
use mission::{Order, Phase, PlannerChoice, Refusal, Severity};

/// Checks that an action is possible now.
///
/// # Errors
/// Returns the reason why not, and how to proceed, as a sentence.
pub fn offered(model: &Model, id: ActionId) -> Result<(), String> {
    let Some(action) = find::row(id) else { return Ok(()) };
    allowed(model, action).and_then(|()| (action.can)(model)).map_err(|why| model.console.keys.spelled(&why))
}

/// Checks that Enter has something to open.
pub(crate) fn accept(model: &Model) -> Result<(), String> {
    if matches!(model.ui.overlay, Overlay::Preflight { .. }) {
        return demand(model.n_by_hand() > 0, "this scenario has no manual checks");
    }
    let opens = (model.ui.screen.row().opens)(model).is_some();
    let why = why_nothing_opens(model).unwrap_or_else(|| "nothing to open here".into());
    demand(model.ui.overlay != Overlay::None || opens, &why)
}

/// Why Enter opens nothing on a screen where it sometimes does, as a clause.
pub(super) fn why_nothing_opens(model: &Model) -> Option<String> {
    match model.ui.screen {
        Screen::Home => go::why_not_open(model),
        Screen::Review => offered(model, ActionId::Replay).err(),
        Screen::Plan => Some(place::why_no_area(model).into()),
        Screen::Mission => Some("nothing to open in this pane; <next-pane>: next pane, to the events".into()),
        _ => None,
    }
}

/// Checks that there is another pane to switch to.
pub(crate) fn other_pane(model: &Model) -> Result<(), String> {
    let turns = model.ui.screen == Screen::Home || !model.ui.panes().is_empty();
    demand(turns, "only one pane is shown at this size")?;
    let has_detail = model.ui.focus() != Pane::List || (model.ui.screen.row().has_selection)(model);
    demand(has_detail, "nothing is selected, so only the list responds to keys")
}

/// Checks that the screen shows numbered panes, and that one of them has this number.
pub(crate) fn pane(model: &Model, number: u8) -> Result<(), String> {
    let is_wide = model.ui.arrangement() == Arrangement::Wide;
    let panes = match model.ui.screen {
        Screen::Home if is_wide => HomeList::ALL.len(),
        _ => model.ui.numbered_panes().len(),
    };
    demand(panes > 0, "panes have keys of their own only from 120x30; <next-pane>: next pane")?;
    demand(usize::from(number) <= panes, "this screen has fewer panes; <next-pane> goes through them")?;
    other_pane(model)
}

/// Checks that a mission is open.
pub(crate) fn is_open(model: &Model) -> Result<(), String> {
    demand(model.live.source.is_some(), "no mission is open; choose one on screen 1 (Home)")
}

/// Checks that there is a missed area.
pub(crate) fn missed(model: &Model) -> Result<(), String> {
    demand(!model.live.missed().is_empty(), "no missed areas")
}

/// Checks that a run is selected.
pub(crate) fn run(model: &Model) -> Result<(), String> {
    demand(named_run(model).is_some(), "no run is selected")
}

/// Checks that a run is selected, and that no console is still writing it.
pub(crate) fn written_run(model: &Model) -> Result<(), String> {
    run(model)?;
    let name = named_run(model);
    let listed = model.home.found.iter().flat_map(|found| &found.runs);
    let is_running = |run: &PastRun| Some(&run.name) == name.as_ref() && run.end == "RUNNING";
    // The list may not have been read again since the end of the run whose result is shown.
    let is_result = model.ui.screen == Screen::Result;
    demand(is_result || !listed.into_iter().any(is_running), "the run has not ended")
}

/// Checks that the run's own planner, which the re-scan uses, can scan.
pub(crate) fn rescan(model: &Model) -> Result<(), String> {
    let is_result = model.ui.screen == Screen::Result;
    let planner = model.planner().filter(|_| is_result);
    match planner.and_then(|planner| Some((planner, planner.why_no_coverage()?))) {
        Some((planner, why)) => {
            let other = "`tankops rescan RUN` writes a scenario for another planner";
            Err(format!("planner {} {why}; {other}", planner.id))
        }
        None => written_run(model),
    }
}

/// Shows the operator why an action is refused.
pub(super) fn refuse(model: &mut Model, why: String) -> Vec<Effect> {
    model.say(Severity::Watch, why);
    Vec::new()
}

pub(crate) fn demand(met: bool, otherwise: &str) -> Result<(), String> {
    if met { Ok(()) } else { Err(otherwise.to_owned()) }
}

/// The reason why the run has not produced a result.
pub(crate) fn no_result(model: &Model) -> &'static str {
    if model.live.is_replay() { "this run had not ended when it was loaded" } else { "no run has ended yet" }
}

/// Checks that a screen is shown.
pub(crate) fn on_screen(model: &Model, screen: Screen) -> Result<(), String> {
    demand(model.ui.screen == screen, &format!("only on screen {} ({})", screen.digit(), screen.name()))
}

/// Checks that the mission would accept an order, according to the mission's own rules.
pub(crate) fn accepted(model: &Model, order: &Order) -> Result<(), String> {
    no_orders(model)?;
    model.live.run.standing.standing().allows(order).map_err(|why| {
        match remedy(&why, model.live.run.phase()) {
            Some(remedy) => model.console.keys.spelled(&format!("{why}; {remedy}")),
            None => why.to_string(),
        }
    })
}

/// Checks that there is something to stop or resume.
pub(crate) fn hold(model: &Model) -> Result<(), String> {
    if model.live.is_replay() {
        return replay::is_loaded(model);
    }
    if model.live.may_move() { Ok(()) } else { accepted(model, &Order::Hold) }
}

/// Checks that the mission can start.
pub(crate) fn start(model: &Model) -> Result<(), String> {
    demand(model.live.failure.is_none(), "the scenario could not be opened")?;
    demand(!model.live.is_loading(), "the scenario is loading; start when the plan is ready")?;
    demand(model.live.run.about.is_some(), "no mission loaded yet")?;
    demand(!model.live.preflight.is_starting, "start checks already running; <cancel-plan>: cancel")?;
    demand(model.live.asked.is_none(), "start already requested; <hold>: HOLD")?;
    if let Some(busy) = model.live.busy.as_ref().filter(|_| model.live.waits()) {
        return Err(format!("{}: not started; start again when the plan is ready", busy.how_far()));
    }
    demand(!model.live.awaits_plan(), "the plan follows; start when it is ready")?;
    let plan = model.live.run.standing.ready_plan();
    accepted(model, &Ask::Start(plan).order())?;
    match model.start_is_blocked_here() {
        Some(why) => Err(format!("{why}; <preflight>: pre-flight check")),
        None => Ok(()),
    }
}

/// Checks that the mission has been started: ending it earlier would leave an empty run.
pub(crate) fn abort(model: &Model) -> Result<(), String> {
    let is_waiting = *model.live.run.phase() == Phase::Waiting && !model.live.may_move();
    demand(!is_waiting, "the mission has not been started")?;
    accepted(model, &Order::Abort)
}

/// Checks that a plan which was refused because of the tether can be run.
pub(crate) fn uncertified(model: &Model) -> Result<(), String> {
    let is_refused = model.live.run.tether.as_ref().and_then(|tether| tether.certified) == Some(false);
    let why = "the mission cannot start with an uncertified plan; <planner>: change planner, or set \
        tether.allow_uncertified in the scenario";
    demand(!(model.live.waits() && is_refused), why)?;
    accepted(model, &Order::FlyUncertified)
}

/// Checks that the planner can be changed.
pub(crate) fn swap(model: &Model) -> Result<(), String> {
    let choice = PlannerChoice::default();
    // Orders are carried out in sequence, so the list may open after HOLD without waiting for the answer.
    if !model.live.hold_asked {
        accepted(model, &Order::ChoosePlanner(choice))?;
    }
    has_planners(model)
}

/// Checks that the mission follows a plan.
pub(crate) fn has_plan(model: &Model) -> Result<(), String> {
    demand(!model.live.run.is_survey(), "a survey drives without a planner; start it as it is")
}

/// Checks that any planner was found.
pub(crate) fn has_planners(model: &Model) -> Result<(), String> {
    demand(!model.console.planners.is_empty(), "no planners found yet")
}

/// Checks that a mission or a past run is open.
pub(crate) fn has_mission(model: &Model) -> Result<(), String> {
    demand(model.live.run.about.is_some(), "no mission is open")
}

/// Checks that there is planning to cancel.
pub(crate) fn cancel_plan(model: &Model) -> Result<(), String> {
    let live = &model.live;
    let is_planning = live.waits() && live.busy.is_some();
    let is_open = is_planning || live.plans.ghost.is_some() || live.preflight.is_starting;
    demand(is_open, "nothing is being planned")
}

/// Checks that the planner has parameters.
pub(crate) fn parameters(model: &Model) -> Result<(), String> {
    match model.planner() {
        None => Err("no planner loaded yet".into()),
        Some(info) => demand(!info.parameters.is_empty(), &format!("planner {} has no parameters", info.id)),
    }
}

/// Checks that the planner has parameters that can still be changed.
pub(crate) fn changeable_parameters(model: &Model) -> Result<(), String> {
    let why = "the mission has ended: its parameters cannot be changed; <home> opens another scenario";
    demand(!model.live.run.has_ended(), why)?;
    parameters(model)
}

/// Checks that time is passing, at a speed that can be set.
pub(crate) fn simulating(model: &Model) -> Result<(), String> {
    if model.live.is_replay() {
        return Ok(());
    }
    demand(model.live.run.about.is_some() && !model.live.run.has_ended(), "no mission is open")?;
    demand(!model.live.run.is_live(), "a real vehicle runs in real time; its speed is always 1")
}

/// Checks that no mission is in progress: only one is allowed at a time.
pub(crate) fn nothing_under_way(model: &Model) -> Result<(), String> {
    if !model.live.is_replay() {
        no_orders(model)?;
    }
    let why = model.console.keys.spelled("a mission is in progress; <mission>: show it, <end>: end it");
    demand(!model.live.is_under_way(), &why)
}

/// Checks that there is a faster or slower speed.
pub(crate) fn speed(model: &Model, faster: bool) -> Result<(), String> {
    simulating(model)?;
    let end = if faster { "already at maximum speed" } else { "already at minimum speed" };
    demand(model.live.speed.stepped(faster).is_some(), end)
}

/// How to proceed, as keys.
fn remedy(why: &Refusal, phase: &Phase) -> Option<&'static str> {
    match why {
        Refusal::NotStarted => Some("<start>: start"),
        Refusal::NoPlan | Refusal::PlanElsewhere { .. } => Some("<plan-again>: plan"),
        Refusal::PlanFailed { .. } => Some("<planner>: change planner"),
        // Space asks to resume in this case.
        Refusal::AlreadyStarted if matches!(phase, Phase::Held(_)) => None,
        Refusal::AlreadyStarted
        | Refusal::AlreadyMoving
        | Refusal::StepNeedsHold
        | Refusal::BackNeedsHold
        | Refusal::SwapNeedsHold => Some("<hold>: HOLD"),
        Refusal::Ended(_) => Some("<home> opens another scenario"),
        Refusal::NoShadow => Some(":shadow NAME runs one"),
        // If the operator can do anything, these messages already say what.
        Refusal::Planning
        | Refusal::DrivingBack
        | Refusal::OfferAccepted
        | Refusal::OtherPlan { .. }
        | Refusal::NotLive { .. }
        | Refusal::PositionLost { .. }
        | Refusal::RangesInconsistent
        | Refusal::NoPlanRefused
        | Refusal::NoOffer
        | Refusal::Vehicle { .. }
        | Refusal::NoPlannerInSurvey
        | Refusal::StepOfVehicle
        | Refusal::FaultOfVehicle
        | Refusal::ShadowHasNoPlan
        | Refusal::ShadowNotReady { .. } => None,
    }
}
