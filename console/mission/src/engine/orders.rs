//! What each order does in each phase, and why it may be refused.

use super::{Mission, Phase};
use crate::{
    config::PlannerChoice,
    event::{EventKind, HoldReason, Outcome},
    order::Order,
    planner::{Cause, ParamValue, PlannerLink},
};
use planner_api::{Code, Reason};

impl Mission {
    pub(super) fn obey(&mut self, order: &Order, planner: &mut dyn PlannerLink) {
        // The order stands in the journal before its effects.
        let slot = self.happened.len();
        let order_event = match self.follow(order, planner) {
            Ok(()) => EventKind::Ordered { order: order.clone() },
            Err(why) => EventKind::OrderRefused { order: order.clone(), why },
        };
        self.happened.insert(slot, order_event);
    }

    fn follow(&mut self, order: &Order, planner: &mut dyn PlannerLink) -> Result<(), String> {
        match (order, self.phase.clone()) {
            (_, Phase::Ended(outcome)) => Err(format!("the mission has ended {}", outcome.word())),
            (Order::Start, Phase::Waiting) => {
                self.start(planner);
                Ok(())
            }
            (Order::Start, _) => Err("the mission has been started already".into()),
            (Order::Hold, Phase::Held(HoldReason::Operator)) => Ok(()),
            (Order::Hold, Phase::Running | Phase::Stepping | Phase::Held(_)) => {
                self.hold(HoldReason::Operator);
                Ok(())
            }
            (Order::Resume, Phase::Held(_)) => self.resume(Phase::Running, planner),
            (Order::Resume, Phase::Running | Phase::Stepping) => Err("the robot is moving".into()),
            (Order::Step, Phase::Held(_)) => self.resume(Phase::Stepping, planner),
            (Order::Step, Phase::Running | Phase::Stepping) => Err("a single step needs a hold first".into()),
            (Order::Abort, _) => {
                self.end(Outcome::Aborted, "ended by the operator");
                Ok(())
            }
            (Order::ChoosePlanner(_), Phase::Running | Phase::Stepping) => {
                Err("a planner is changed while the robot is held".into())
            }
            (Order::ChoosePlanner(choice), _) => self.choose_by_order(choice, planner),
            (Order::SetParameter { key, value }, _) => self.set_parameter(key, value, planner),
            (Order::FlyUncertified, Phase::Held(HoldReason::PlanRefused { .. })) => {
                self.fly_uncertified(true);
                self.resume(Phase::Running, planner).inspect_err(|_| self.fly_uncertified(false))
            }
            (Order::FlyUncertified, _) => Err("no plan has been refused because of the tether".into()),
            (Order::Hold | Order::Resume | Order::Step, Phase::Waiting) => {
                Err("the mission has not been started".into())
            }
        }
    }

    fn fly_uncertified(&mut self, fly: bool) {
        if let Some(tether) = &mut self.tether {
            tether.fly_uncertified(fly);
        }
    }

    fn start(&mut self, planner: &mut dyn PlannerLink) {
        self.phase = Phase::Running;
        if let Err(message) = self.make_planner_fit(planner) {
            self.hold_for_planner(message);
        }
    }

    /// Lets the robot move again, for good or for one tick.
    fn resume(&mut self, how: Phase, planner: &mut dyn PlannerLink) -> Result<(), String> {
        if self.locator.is_alarmed() {
            return Err("the ranges contradict each other; going on needs a fix that holds together".into());
        }
        if self.locator.is_lost() {
            return Err(format!(
                "the position is lost: 95 % error {:.2} m, limit {:.2} m",
                self.locator.error_95_m(),
                self.config.position_limit_m
            ));
        }
        self.make_planner_fit(planner)?;
        self.go_on(how);
        Ok(())
    }

    fn choose_by_order(
        &mut self,
        choice: &PlannerChoice,
        planner: &mut dyn PlannerLink,
    ) -> Result<(), String> {
        let from = self.planner.choice.id.clone();
        self.seat_by_order(choice, planner)?;
        if self.phase != Phase::Waiting {
            self.planner.plan_due = Some(Reason::Swap { from });
            self.plan_if_due(planner)?;
            if matches!(
                self.phase,
                Phase::Held(
                    HoldReason::PlannerFault { .. }
                        | HoldReason::PlanRefused { .. }
                        | HoldReason::Stuck { .. }
                )
            ) {
                // The reason is gone with the planner; now it is the operator who lets the robot go on.
                self.hold(HoldReason::Operator);
            }
        }
        Ok(())
    }

    fn set_parameter(
        &mut self,
        key: &str,
        value: &ParamValue,
        planner: &mut dyn PlannerLink,
    ) -> Result<(), String> {
        let mut choice = self.planner.choice.clone();
        choice.parameters.insert(key.into(), value.clone());
        let live = self
            .planner
            .info
            .as_ref()
            .is_some_and(|info| info.parameters.iter().any(|p| p.key == key && p.live));
        if live && self.planner.fit {
            match planner.reconfigure(&choice.parameters) {
                Ok(()) => {
                    self.planner.choice = choice.clone();
                    self.happened.push(EventKind::ParametersChanged { choice });
                    return Ok(());
                }
                // It takes them as a new instance, like those that are not live.
                Err(fault) if fault.cause == Cause::Planner(Code::Unsupported) => {}
                Err(fault) => return Err(fault.message),
            }
        }
        if self.phase == Phase::Running {
            return Err(format!("`{key}` cannot change while the robot moves: hold first"));
        }
        self.seat(choice, planner)?;
        if self.phase != Phase::Waiting {
            self.planner.plan_due = Some(Reason::Operator);
            self.plan_if_due(planner)?;
        }
        Ok(())
    }
}
