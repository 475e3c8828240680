//! A planner in shadow in a headless run, and its swaps with the active planner.

use crate::cli::ShadowArgs;
use flight::{planners, scenarios};
use mission::{Event, EventKind, Order, PlannerChoice, event::ShadowTally};
use planner_host::PluginDirs;
use scenario::{Scenario, Settings};
use std::path::Path;

/// Issues the orders for a planner in shadow.
pub(crate) struct Shadowing {
    /// The planner in shadow, then the active planner.
    choices: [PlannerChoice; 2],
    every_s: Option<f64>,
    tally: ShadowTally,
    /// The mission time of the next promotion, in seconds.
    due_s: f64,
}

impl Shadowing {
    /// Reads the shadow options on the command line for a scenario that was read from `file`.
    ///
    /// # Errors
    /// The planner is not available, or it does not accept its parameters.
    pub(crate) fn read(
        args: &ShadowArgs,
        file: &Path,
        scenario: &Scenario,
        plugins: &PluginDirs,
    ) -> anyhow::Result<Option<Self>> {
        let Some(planner) = &args.shadow else { return Ok(None) };
        let settings = Settings { planner: Some(planner.clone()), set: args.shadow_set.clone(), seed: None };
        let shadowed = scenarios::read(file, &settings)?;
        planners::check_installed(&shadowed, plugins)?;
        let choices = [shadowed.mission.planner, scenario.mission.planner.clone()];
        Ok(Some(Self::new(choices, args.promote_every)))
    }

    fn new(choices: [PlannerChoice; 2], every_s: Option<f64>) -> Self {
        Self { choices, every_s, tally: ShadowTally::default(), due_s: every_s.unwrap_or_default() }
    }

    /// The order that starts the planner in shadow.
    pub(crate) fn begin(&self) -> Order {
        Order::Shadow(self.choices[0].clone())
    }

    /// Returns the order for the next tick; `events` are those of the current tick.
    pub(crate) fn next(&mut self, events: &[Event]) -> Option<Order> {
        let every_s = self.every_s?;
        for event in events {
            self.tally.apply(&event.kind);
        }
        if events.iter().any(|event| matches!(event.kind, EventKind::Promoted { .. })) {
            self.tally = ShadowTally::default();
            self.choices.reverse();
            return Some(self.begin());
        }
        let is_due = self.tally.is_ready() && events.first()?.t_s >= self.due_s;
        is_due.then(|| {
            self.due_s += every_s;
            Order::Promote
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mission::AskId;
    use planner_api::{Command, Status};

    fn event(tick: u32, kind: EventKind) -> Event {
        Event { tick: tick.into(), t_s: f64::from(tick) * 0.1, kind }
    }

    fn answered(tick: u32) -> Event {
        let ask = Some(AskId::from((mission::WorkerId(2), tick)));
        let command = Command::still(Status::Waiting);
        event(tick, EventKind::Shadowed { of: Box::new(EventKind::Commanded { ask, command, asked: None }) })
    }

    #[test]
    fn two_planners_take_over_from_each_other_when_they_are_ready_and_it_is_time() {
        let choice = |id: &str| PlannerChoice { id: id.into(), ..PlannerChoice::default() };
        let mut shadowing = Shadowing::new([choice("apf"), choice("rpf")], Some(2.0));
        assert_eq!(shadowing.begin(), Order::Shadow(choice("apf")));
        let orders: Vec<u32> = (0..=20).filter(|tick| shadowing.next(&[answered(*tick)]).is_some()).collect();
        assert_eq!(orders, [20]);
        let promoted = EventKind::Promoted { planner: "apf".into(), tally: ShadowTally::default() };
        assert_eq!(shadowing.next(&[event(21, promoted)]), Some(Order::Shadow(choice("rpf"))));
        let orders: Vec<u32> =
            (22..=45).filter(|tick| shadowing.next(&[answered(*tick)]).is_some()).collect();
        assert_eq!(orders, [40]);
    }
}
