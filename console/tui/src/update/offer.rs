//! What can be done now, and why not otherwise. Footer and keys ask the same question.

use crate::actions::ActionId;
use crate::model::{Model, Phase, Speed, ui::MAX_ZOOM};
use mission::HoldReason;

/// Whether an action can be done now.
///
/// # Errors
/// Why not, and what would be right, as a sentence.
pub fn offered(model: &Model, id: ActionId) -> Result<(), String> {
    match id {
        ActionId::Hold => hold(model),
        ActionId::Start => start(model),
        ActionId::Resume => held(model, "there is nothing to resume"),
        ActionId::FlyUncertified => refused(model),
        ActionId::Step => held(model, "a single step needs HOLD first (space)"),
        ActionId::Abort => under_way(model),
        ActionId::ChoosePlanner => swap(model),
        ActionId::Parameters => parameters(model),
        ActionId::Acknowledge => {
            let waiting = model.alarms.list().iter().any(|alarm| !alarm.acknowledged);
            demand(waiting, "no alarm waits to be acknowledged")
        }
        ActionId::Slower => speed(model, false),
        ActionId::Faster => speed(model, true),
        ActionId::ZoomIn => map(model).and(demand(model.ui.map.zoom < MAX_ZOOM, "the map is at its largest")),
        ActionId::ZoomOut => map(model).and(demand(model.ui.map.zoom > 0, "the whole tank is shown already")),
        ActionId::WholeTank | ActionId::Layers => map(model),
        ActionId::Follow => {
            map(model).and(demand(model.position.pose.is_some(), "the robot's place is not known yet"))
        }
        ActionId::PanLeft | ActionId::PanRight | ActionId::PanUp | ActionId::PanDown => {
            map(model).and(demand(model.ui.map.zoom > 0, "the whole tank is shown; z enlarges the map first"))
        }
        ActionId::Severity
        | ActionId::Filter
        | ActionId::Newer
        | ActionId::Older
        | ActionId::PageNewer
        | ActionId::PageOlder
        | ActionId::Newest
        | ActionId::Oldest => {
            demand(model.ui.shows_events(), "the events are not shown here; Tab, or 60x16 and more")
        }
        ActionId::NextPane | ActionId::PreviousPane => {
            demand(!model.ui.panes().is_empty(), "panes need 60 columns and 16 rows")
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

fn hold(model: &Model) -> Result<(), String> {
    match model.phase {
        _ if model.may_move() => Ok(()),
        Phase::Idle => Err("nothing moves: the mission has not started; S starts it".into()),
        Phase::Ended { .. } => Err("nothing moves: the mission has ended".into()),
        Phase::Running | Phase::Held(_) => Ok(()),
    }
}

fn start(model: &Model) -> Result<(), String> {
    match model.phase {
        Phase::Idle if model.run.is_none() => Err("there is no mission yet".into()),
        Phase::Idle if model.console.asked.is_some() => Err("the start is on its way; space holds".into()),
        Phase::Idle => Ok(()),
        Phase::Running => Err("the mission runs already".into()),
        Phase::Held(_) => Err("the mission is held; space asks to go on".into()),
        Phase::Ended { .. } => Err("the mission has ended; run it again from the command line".into()),
    }
}

fn held(model: &Model, otherwise: &str) -> Result<(), String> {
    match model.phase {
        Phase::Held(_) if model.position.lost => {
            Err("the position is lost; wait until it is regained".into())
        }
        Phase::Held(_) => Ok(()),
        Phase::Idle => Err("the mission has not started; S starts it".into()),
        Phase::Running => Err(otherwise.into()),
        Phase::Ended { .. } => Err("the mission has ended".into()),
    }
}

fn refused(model: &Model) -> Result<(), String> {
    let is_refused = matches!(model.phase, Phase::Held(HoldReason::PlanRefused { .. }));
    demand(is_refused, "no plan has been refused because of the tether")
}

fn under_way(model: &Model) -> Result<(), String> {
    match model.phase {
        Phase::Idle if !model.may_move() => Err("the mission has not started; q leaves".into()),
        Phase::Ended { .. } => Err("the mission has ended already; q leaves".into()),
        _ => Ok(()),
    }
}

fn swap(model: &Model) -> Result<(), String> {
    match model.phase {
        // Orders are obeyed in order: after HOLD was sent the list may open without waiting for the answer.
        Phase::Running if !model.console.hold_asked => Err("another planner needs HOLD first (space)".into()),
        Phase::Ended { .. } => Err("the mission has ended; no planner drives any more".into()),
        Phase::Idle | Phase::Running | Phase::Held(_) => {
            demand(!model.console.planners.is_empty(), "no planner was found yet")
        }
    }
}

fn parameters(model: &Model) -> Result<(), String> {
    match model.planner() {
        None => Err("the planner is not known yet".into()),
        Some(info) => demand(!info.parameters.is_empty(), &format!("planner {} has no parameters", info.id)),
    }
}

fn speed(model: &Model, faster: bool) -> Result<(), String> {
    demand(!model.has_ended(), "the mission has ended; its pace does not matter any more")?;
    let end = if faster { "this is as fast as it goes" } else { "this is the slowest" };
    demand(model.console.speed.stepped(faster).is_some_and(|next: Speed| next != model.console.speed), end)
}

fn map(model: &Model) -> Result<(), String> {
    demand(model.ui.shows_map(), "the map is not shown here; Tab, or 60x16 and more")
}
