//! Runs missions from which only the report is needed: nothing is written or displayed.

use crate::{Flight, answers::InOrder};
use account::{Fold, Summary};
use mission::{Order, Phase};
use scenario::Scenario;

/// Runs a scenario to its end, answering every ask before mission time advances; returns `None` if it was stopped early.
/// The summary has no wall-clock figures, no file hashes and no account of the floor, so equal missions have equal
/// summaries.
pub fn fly(scenario: &Scenario, answers: &mut InOrder, is_stopped: impl Fn() -> bool) -> Option<Summary> {
    let mut flight = Flight::prepare(scenario, false);
    let mut fold = Fold::of_figures();
    fold.apply(&flight.opened());
    let mut orders: &[Order] = &[Order::Start];
    while !matches!(flight.phase(), Phase::Ended(_)) {
        if is_stopped() {
            return None;
        }
        flight.tick(orders, answers).iter().for_each(|event| fold.apply(event));
        orders = &[];
    }
    Some(scenario.expect.evaluated(fold.summary()))
}
