//! Missions of which only the report is wanted: nothing is written, and nobody looks on.

use crate::{Flight, answers::InOrder};
use account::{Fold, Summary};
use mission::{Order, Phase};
use scenario::Scenario;

/// Flies a scenario to its end, every ask answered before time moves on; `None` if it was stopped before. Figures by the wall
/// clock, hashes of files and the account of the floor are absent: equal missions have equal summaries.
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
