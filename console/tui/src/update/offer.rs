//! What can be done now, and why not otherwise. Footer and keys ask the same question.

use crate::actions::ActionId;
use crate::model::{Model, Speed, ui::MAX_ZOOM};
use mission::{Order, Phase, PlannerChoice, Refusal};

/// Whether an action can be done now.
///
/// # Errors
/// Why not, and what would be right, as a sentence.
pub fn offered(model: &Model, id: ActionId) -> Result<(), String> {
    match id {
        ActionId::Hold => hold(model),
        ActionId::Start => start(model),
        ActionId::Resume => accepted(model, &Order::Resume),
        ActionId::FlyUncertified => accepted(model, &Order::FlyUncertified),
        ActionId::Step => accepted(model, &Order::Step),
        ActionId::Abort => abort(model),
        ActionId::ChoosePlanner => swap(model),
        ActionId::Parameters => parameters(model),
        ActionId::Acknowledge => {
            let waiting = model.alarms.list().iter().any(|alarm| !alarm.acknowledged);
            demand(waiting, "no unacknowledged alarm")
        }
        ActionId::Slower => speed(model, false),
        ActionId::Faster => speed(model, true),
        ActionId::ZoomIn => map(model).and(demand(model.ui.map.zoom < MAX_ZOOM, "maximum zoom")),
        ActionId::ZoomOut => map(model).and(demand(model.ui.map.zoom > 0, "the whole tank is already shown")),
        ActionId::WholeTank | ActionId::Layers => map(model),
        ActionId::Follow => map(model)
            .and(demand(model.position.pose.is_some(), "the position of the robot is not known yet")),
        ActionId::PanLeft | ActionId::PanRight | ActionId::PanUp | ActionId::PanDown => {
            map(model).and(demand(model.ui.map.zoom > 0, "the whole tank is shown; z: zoom in first"))
        }
        ActionId::Severity
        | ActionId::Filter
        | ActionId::Newer
        | ActionId::Older
        | ActionId::PageNewer
        | ActionId::PageOlder
        | ActionId::Newest
        | ActionId::Oldest => {
            demand(model.ui.shows_events(), "the events are not shown; Tab: next pane (needs 60x16)")
        }
        ActionId::NextPane | ActionId::PreviousPane => {
            demand(!model.ui.panes().is_empty(), "panes need at least 60x16")
        }
        ActionId::Interrupt
        | ActionId::Redraw
        | ActionId::Suspend
        | ActionId::Commands
        | ActionId::Help
        | ActionId::Leave
        | ActionId::Accept
        | ActionId::Cancel
        | ActionId::Up
        | ActionId::Down
        | ActionId::Edit => Ok(()),
    }
}

fn demand(met: bool, otherwise: &str) -> Result<(), String> {
    if met { Ok(()) } else { Err(otherwise.to_owned()) }
}

/// Whether the mission would accept an order, by its own table.
pub(super) fn accepted(model: &Model, order: &Order) -> Result<(), String> {
    model.standing.standing().allows(order).map_err(|why| match remedy(&why, model.phase()) {
        Some(remedy) => format!("{why}; {remedy}"),
        None => why.to_string(),
    })
}

fn hold(model: &Model) -> Result<(), String> {
    if model.console.asked.is_some() { Ok(()) } else { accepted(model, &Order::Hold) }
}

fn start(model: &Model) -> Result<(), String> {
    demand(model.run.is_some(), "no mission loaded yet")?;
    accepted(model, &Order::Start)?;
    demand(model.console.asked.is_none(), "start already requested; space: HOLD")
}

/// Ending a mission that was never started would leave a run of nothing.
fn abort(model: &Model) -> Result<(), String> {
    let is_waiting = *model.phase() == Phase::Waiting && !model.may_move();
    demand(!is_waiting, "the mission has not been started; q: leave")?;
    accepted(model, &Order::Abort)
}

fn swap(model: &Model) -> Result<(), String> {
    let choice = PlannerChoice::default();
    // Orders are obeyed in order: after HOLD was sent the list may open without waiting for the answer.
    if !model.console.hold_asked {
        accepted(model, &Order::ChoosePlanner(choice))?;
    }
    demand(!model.console.planners.is_empty(), "no planner found yet")
}

fn parameters(model: &Model) -> Result<(), String> {
    match model.planner() {
        None => Err("the planner is not known yet".into()),
        Some(info) => demand(!info.parameters.is_empty(), &format!("planner {} has no parameters", info.id)),
    }
}

fn speed(model: &Model, faster: bool) -> Result<(), String> {
    demand(!model.has_ended(), "the mission has ended")?;
    let end = if faster { "Maximum speed" } else { "Minimum speed" };
    demand(model.console.speed.stepped(faster).is_some_and(|next: Speed| next != model.console.speed), end)
}

fn map(model: &Model) -> Result<(), String> {
    demand(model.ui.shows_map(), "the map is not shown; Tab: next pane (needs 60x16)")
}

/// What would be right, in keys.
fn remedy(why: &Refusal, phase: &Phase) -> Option<&'static str> {
    match why {
        Refusal::NotStarted => Some("S: start"),
        // Space asks to resume then.
        Refusal::AlreadyStarted if matches!(phase, Phase::Held(_)) => None,
        Refusal::AlreadyStarted
        | Refusal::AlreadyMoving
        | Refusal::StepNeedsHold
        | Refusal::SwapNeedsHold => Some("space: HOLD"),
        Refusal::Ended(_) => Some("q: leave"),
        // These say themselves what would be right, as far as there is anything.
        Refusal::NotLive { .. }
        | Refusal::PositionLost { .. }
        | Refusal::RangesInconsistent
        | Refusal::NoPlanRefused => None,
    }
}
