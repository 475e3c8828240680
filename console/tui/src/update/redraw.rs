//! Which messages change the screen, and how soon they need a frame.

use super::{Msg, RunMsg};
use crate::model::{Health, Model};
use mission::EventKind;

/// How soon a message needs a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Redraw {
    /// Nothing visible changes.
    No,
    /// Only the values of a stationary robot change: draw within a second.
    Calm,
    /// Draw as soon as possible.
    Soon,
}

/// How soon a message needs a frame; called before the message is applied.
pub fn redraw(model: &Model, msg: &Msg) -> Redraw {
    match msg {
        // Measurements of the console are visible only through its alarms.
        Msg::Time(_) | Msg::Measured(_) | Msg::Drawn(_) => Redraw::No,
        Msg::Found(found) if model.home.found.as_ref() == Some(found) => Redraw::No,
        Msg::Presets(presets) if model.console.presets == *presets => Redraw::No,
        Msg::Run(id, _) if *id != model.live.id => Redraw::No,
        Msg::Run(_, RunMsg::Health(health)) if is_same(&model.live.health, health) => Redraw::No,
        Msg::Run(_, RunMsg::Events(events)) => {
            let stands = !model.live.run.is_running() && !model.live.may_move();
            if stands && events.iter().all(|event| is_telemetry(&event.kind)) {
                Redraw::Calm
            } else {
                Redraw::Soon
            }
        }
        _ => Redraw::Soon,
    }
}

/// Compares everything except the speed reached, which is measured continuously but shown nowhere.
fn is_same(one: &Health, other: &Health) -> bool {
    one.recording == other.recording
}

/// Whether an event arrives with every tick, even if nothing happens.
fn is_telemetry(kind: &EventKind) -> bool {
    matches!(
        kind,
        EventKind::Estimated { .. }
            | EventKind::Protected { .. }
            | EventKind::SessionCalibrated { .. }
            | EventKind::ClocksEstimated { .. }
            | EventKind::PulsesTested { .. }
            | EventKind::PulsesFailed { .. }
            | EventKind::Ranged { .. }
            | EventKind::Fixed { .. }
            | EventKind::Tethered { .. }
            | EventKind::Progressed { .. }
            | EventKind::Commanded { .. }
            | EventKind::Drawn { .. }
            | EventKind::Scalars { .. }
            | EventKind::Truth { .. }
            | EventKind::TetherTruth { .. }
            | EventKind::Uncounted { .. }
            | EventKind::Sensed { .. }
            | EventKind::Scanned { .. }
            | EventKind::Sent { .. }
    )
}
