//! Planners in shadow: starting and promoting them.

use super::message::Effect;
use super::news;
use super::offer::{accepted, has_planners};
use super::overlay::open;
use super::send::send;
use crate::model::{Cause, Model, Overlay};
use mission::{Order, PlannerChoice, PlannerInfo, Severity};

/// Checks that a planner can be started in shadow.
pub(crate) fn can_begin(model: &Model) -> Result<(), String> {
    accepted(model, &Order::Shadow(PlannerChoice::default()))?;
    has_planners(model)
}

/// Starts a planner in shadow. If it is the active planner, perhaps in a newer build, it keeps its parameters.
pub(super) fn begin(model: &mut Model, choice: PlannerChoice) -> Vec<Effect> {
    open(model, Overlay::None);
    let driving = model.live.run.planning.choice.clone().filter(|driving| driving.id == choice.id);
    send(model, Order::Shadow(driving.unwrap_or(choice)))
}

/// Tells the operator of a running mission which planners were rebuilt.
pub(super) fn tell_rebuilt(model: &mut Model, found: &[PlannerInfo]) {
    let is_rebuilt = |now: &&PlannerInfo| {
        model.console.planners.iter().any(|before| before.id == now.id && before.sha256 != now.sha256)
    };
    let ids: Vec<&str> = found.iter().filter(is_rebuilt).map(|info| info.id.as_str()).collect();
    let text = match ids[..] {
        [] => return,
        [id] => format!("planner {id} was rebuilt: :shadow {id} runs the new build in shadow"),
        _ => {
            let ids = ids.join(", ");
            format!("planners {ids} were rebuilt: :shadow NAME runs a new build in shadow")
        }
    };
    if can_begin(model).is_ok() {
        news(model, &Cause::Console, Severity::Info, text);
    }
}
