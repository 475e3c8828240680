//! Which messages change what is seen, and how soon it is worth a frame.

use super::{Msg, RunMsg};
use crate::model::{Health, Model};
use mission::EventKind;

/// How soon a message is worth a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Redraw {
    /// Nothing that is seen changes.
    No,
    /// Values of a robot that stands still: within a second.
    Calm,
    /// As soon as there may be a frame.
    Soon,
}

/// How soon a message is worth a frame, before it is taken in.
pub fn redraw(model: &Model, msg: &Msg) -> Redraw {
    match msg {
        // What is measured of the console shows only in its alarms.
        Msg::Time(_) | Msg::Measured(_) => Redraw::No,
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

/// The speed that is reached is measured all the time and shown nowhere.
fn is_same(one: &Health, other: &Health) -> bool {
    one.recording == other.recording
}

/// What comes tick by tick whether anything happens or not.
fn is_telemetry(kind: &EventKind) -> bool {
    matches!(
        kind,
        EventKind::Estimated { .. }
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
    )
}
