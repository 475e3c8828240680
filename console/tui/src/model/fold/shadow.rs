//! Folds events about the planner in shadow into a run.

use crate::model::{Change, Run, Shadow, planning};
use mission::{Event, EventKind, Order, Severity};

impl Run {
    /// Folds in an event from the planner in shadow, or an order about it.
    pub(super) fn shadowed(&mut self, event: &Event, change: &mut Change) {
        match &event.kind {
            EventKind::Ordered { order: Order::Shadow(choice) } => {
                self.shadow = Some(Shadow::new(choice.clone()));
            }
            EventKind::Promoted { planner, .. } => {
                self.shadow = None;
                change.say(Severity::Info, format!("planner {planner} promoted from shadow"));
            }
            EventKind::ShadowEnded { planner, why } => {
                self.shadow = None;
                change.say(Severity::Watch, format!("planner {planner} no longer runs in shadow: {why}"));
            }
            EventKind::PromotionRefused { planner, why } => {
                change.say(Severity::Warn, format!("planner {planner} stays in shadow: {why}"));
            }
            _ => {}
        }
        let least_lane_m = self.least_lane_m();
        let Some(shadow) = &mut self.shadow else { return };
        shadow.tally.apply(&event.kind);
        match &event.kind {
            EventKind::Ordered { order: Order::Promote } => shadow.is_promoted = true,
            EventKind::PromotionRefused { .. } => shadow.is_promoted = false,
            EventKind::ShadowBegan { info, .. } => shadow.info = Some((**info).clone()),
            EventKind::Shadowed { of } => match &**of {
                EventKind::Planned { path, legs, length_m, complete, .. } => {
                    (shadow.path, shadow.lanes) = planning::shown(path, legs, least_lane_m);
                    (shadow.length_m, shadow.complete) = (*length_m, *complete);
                }
                EventKind::Commanded { command, .. } => shadow.command = Some((event.t_s, *command)),
                _ => {}
            },
            _ => {}
        }
    }
}
