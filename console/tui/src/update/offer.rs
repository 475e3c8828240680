//! What can be done now, and why not otherwise. Footer and keys ask the same question.

use super::go::named_run;
use super::look_only::{allowed, no_orders};
use super::message::Effect;
use super::replay;
use crate::actions::{ActionId, find};
use crate::model::{Model, Overlay, Screen, ui::Ask};
use mission::{Order, Phase, PlannerChoice, Refusal, Severity};

/// Whether an action can be done now.
///
/// # Errors
/// Why not, and what would be right, as a sentence.
pub fn offered(model: &Model, id: ActionId) -> Result<(), String> {
    let Some(action) = find::row(id) else { return Ok(()) };
    allowed(model, action).and_then(|()| (action.can)(model)).map_err(|why| model.console.keys.spelled(&why))
}

/// Whether there is something that Enter opens.
pub(crate) fn accept(model: &Model) -> Result<(), String> {
    if matches!(model.ui.overlay, Overlay::Preflight { .. }) {
        return demand(model.n_by_hand() > 0, "nothing is ticked by hand in this scenario");
    }
    let opens = (model.ui.screen.row().opens)(model).is_some();
    demand(model.ui.overlay != Overlay::None || opens, "nothing to open here")
}

/// Whether there is another pane to go to.
pub(crate) fn other_pane(model: &Model) -> Result<(), String> {
    let turns = model.ui.screen == Screen::Home || !model.ui.panes().is_empty();
    demand(turns, "there is one pane only")
}

/// Whether a mission is open.
pub(crate) fn is_open(model: &Model) -> Result<(), String> {
    demand(model.live.source.is_some(), "no mission is open; choose one on screen 1 (Home)")
}

/// Whether an area was missed.
pub(crate) fn missed(model: &Model) -> Result<(), String> {
    demand(!model.live.missed().is_empty(), "no area was missed")
}

/// Whether there is a run to do something with.
pub(crate) fn run(model: &Model) -> Result<(), String> {
    demand(named_run(model).is_some(), "no run is selected")
}

/// What was missed is scanned by the planner of the run.
pub(crate) fn rescan(model: &Model) -> Result<(), String> {
    let planner = model.planner().filter(|_| model.ui.screen == Screen::Result);
    match planner.and_then(|planner| Some((planner, planner.why_no_coverage()?))) {
        Some((planner, why)) => {
            let other = "`tankops rescan RUN` writes a scenario for another planner";
            Err(format!("planner {} {why}; {other}", planner.id))
        }
        None => run(model),
    }
}

/// Shows the operator why something is not done.
pub(super) fn refuse(model: &mut Model, why: String) -> Vec<Effect> {
    model.say(Severity::Watch, why);
    Vec::new()
}

pub(crate) fn demand(met: bool, otherwise: &str) -> Result<(), String> {
    if met { Ok(()) } else { Err(otherwise.to_owned()) }
}

/// Whether a screen is shown.
pub(crate) fn on_screen(model: &Model, screen: Screen) -> Result<(), String> {
    demand(model.ui.screen == screen, &format!("only on screen {} ({})", screen.digit(), screen.name()))
}

/// Whether the mission would accept an order, by its own table.
pub(crate) fn accepted(model: &Model, order: &Order) -> Result<(), String> {
    no_orders(model)?;
    model.live.run.standing.standing().allows(order).map_err(|why| {
        match remedy(&why, model.live.run.phase()) {
            Some(remedy) => model.console.keys.spelled(&format!("{why}; {remedy}")),
            None => why.to_string(),
        }
    })
}

/// Whether there is something to stop, or to resume.
pub(crate) fn hold(model: &Model) -> Result<(), String> {
    if model.live.is_replay() {
        return replay::is_loaded(model);
    }
    if model.live.may_move() { Ok(()) } else { accepted(model, &Order::Hold) }
}

/// Whether the mission can be started.
pub(crate) fn start(model: &Model) -> Result<(), String> {
    demand(model.live.failure.is_none(), "the scenario could not be opened")?;
    demand(model.live.run.about.is_some(), "no mission loaded yet")?;
    demand(!model.live.preflight.is_starting, "already checking for the start; <cancel-plan>: cancel")?;
    demand(model.live.asked.is_none(), "start already requested; <hold>: HOLD")?;
    if let Some(busy) = model.live.busy.as_ref().filter(|_| model.live.waits()) {
        return Err(format!("{}: not started; start again when the plan is ready", busy.how_far()));
    }
    let plan = model.live.run.standing.ready_plan();
    accepted(model, &Ask::Start(plan).order())?;
    match model.start_is_blocked_here() {
        Some(why) => Err(format!("{why}; <preflight>: pre-flight check")),
        None => Ok(()),
    }
}

/// Ending a mission that was never started would leave a run of nothing.
pub(crate) fn abort(model: &Model) -> Result<(), String> {
    let is_waiting = *model.live.run.phase() == Phase::Waiting && !model.live.may_move();
    demand(!is_waiting, "the mission has not been started")?;
    accepted(model, &Order::Abort)
}

/// Whether another planner can drive.
pub(crate) fn swap(model: &Model) -> Result<(), String> {
    let choice = PlannerChoice::default();
    // Orders are obeyed in order: after HOLD was sent the list may open without waiting for the answer.
    if !model.live.hold_asked {
        accepted(model, &Order::ChoosePlanner(choice))?;
    }
    has_planners(model)
}

/// Whether a planner was found.
pub(crate) fn has_planners(model: &Model) -> Result<(), String> {
    demand(!model.console.planners.is_empty(), "no planners found yet")
}

/// Whether there is planning to give up.
pub(crate) fn cancel_plan(model: &Model) -> Result<(), String> {
    let live = &model.live;
    let is_planning = live.waits() && live.busy.is_some();
    let is_open = is_planning || live.plans.ghost.is_some() || live.preflight.is_starting;
    demand(is_open, "nothing is being planned")
}

/// Whether the planner has parameters.
pub(crate) fn parameters(model: &Model) -> Result<(), String> {
    match model.planner() {
        None => Err("no planner loaded yet".into()),
        Some(info) => demand(!info.parameters.is_empty(), &format!("planner {} has no parameters", info.id)),
    }
}

/// Whether time passes whose speed can be set.
pub(crate) fn simulating(model: &Model) -> Result<(), String> {
    if model.live.is_replay() {
        return Ok(());
    }
    demand(model.live.run.about.is_some() && !model.live.run.has_ended(), "no mission is open")
}

/// One mission at a time.
pub(crate) fn nothing_under_way(model: &Model) -> Result<(), String> {
    if !model.live.is_replay() {
        no_orders(model)?;
    }
    let why = model.console.keys.spelled("a mission is in progress; <mission>: show it, <end>: end it");
    demand(!model.live.is_under_way(), &why)
}

/// Whether there is a faster speed, or a slower one.
pub(crate) fn speed(model: &Model, faster: bool) -> Result<(), String> {
    simulating(model)?;
    let end = if faster { "already at maximum speed" } else { "already at minimum speed" };
    demand(model.live.speed.stepped(faster).is_some(), end)
}

/// What would be right, in keys.
fn remedy(why: &Refusal, phase: &Phase) -> Option<&'static str> {
    match why {
        Refusal::NotStarted => Some("<start>: start"),
        Refusal::NoPlan => Some("<plan-again>: plan"),
        Refusal::PlanFailed { .. } => Some("<planner>: change planner"),
        // Space asks to resume then.
        Refusal::AlreadyStarted if matches!(phase, Phase::Held(_)) => None,
        Refusal::AlreadyStarted
        | Refusal::AlreadyMoving
        | Refusal::StepNeedsHold
        | Refusal::SwapNeedsHold => Some("<hold>: HOLD"),
        Refusal::Ended(_) => Some("<home> opens another one"),
        Refusal::NoShadow => Some(":shadow NAME flies one"),
        // These say themselves what would be right, as far as there is anything.
        Refusal::Planning
        | Refusal::OtherPlan { .. }
        | Refusal::NotLive { .. }
        | Refusal::PositionLost { .. }
        | Refusal::RangesInconsistent
        | Refusal::NoPlanRefused
        | Refusal::NoOffer
        | Refusal::ShadowNotReady { .. } => None,
    }
}
