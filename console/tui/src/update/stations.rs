//! The operator's actions on AE stations: excluding a station, using it again, making a simulated one fail.

use super::command::Value;
use super::message::Effect;
use super::offer::{accepted, demand, refuse};
use crate::actions::ActionId;
use crate::model::{Model, Overlay, Palette, Pane};
use mission::{Injection, Order, RangeFault};
use positioning::Exclusion;
use world::{Station, StationId};

/// Checks that an action on a station is possible now.
///
/// # Errors
/// Returns the reason why not, as a sentence.
pub(crate) fn can(model: &Model, id: ActionId) -> Result<(), String> {
    demand(model.live.run.about.is_some(), "no mission loaded yet")?;
    let station = model.live.run.stations().first().ok_or("this mission has no AE stations")?.id;
    let order = match id {
        ActionId::Inject => {
            Order::Inject(Injection { station, fault: RangeFault::Dead, for_s: 1.0, by: None })
        }
        _ => Order::UseStation { station, used: true, by: None },
    };
    accepted(model, &order)
}

/// The station selected in the table, if the arrow keys apply to the table.
fn selected(model: &Model) -> Option<&Station> {
    let stations = model.live.run.stations();
    let last = stations.len().checked_sub(1)?;
    stations.get(model.ui.station.min(last)).filter(|_| model.ui.focus() == Pane::Stations)
}

/// Moves the selection down by `by` stations.
pub(crate) fn select(model: &mut Model, by: isize) {
    let last = model.live.run.stations().len().saturating_sub(1);
    model.ui.station = model.ui.station.min(last).saturating_add_signed(by).min(last);
}

/// The command that Enter offers for the selected station: to exclude it or, if it is excluded, to use it again; `None` if
/// the mission accepts neither.
pub(crate) fn opens(model: &Model) -> Option<&'static str> {
    let station = selected(model)?;
    let fix = model.live.run.position.fix.as_ref();
    let is_excluded = fix.is_some_and(|fix| fix.excluded.contains(&(station.id, Exclusion::ByOrder)));
    let (id, word) =
        if is_excluded { (ActionId::Include, "include") } else { (ActionId::Exclude, "exclude") };
    can(model, id).ok().map(|()| word)
}

/// Opens the command line with the command for the selected station; Enter there runs it.
pub(crate) fn open(model: &mut Model) -> Vec<Effect> {
    let (Some(word), Some(station)) = (opens(model), selected(model)) else {
        return refuse(model, "no station is selected".into());
    };
    let line = format!("{} {}", word, station.name);
    super::overlay::open(model, Overlay::Commands(Palette::begun(&line)))
}

/// The order for a command about a station; `None` if a value is missing.
pub(super) fn order(
    model: &Model,
    id: ActionId,
    station: StationId,
    values: impl Iterator<Item = Value>,
) -> Option<Order> {
    let by = model.console.preferences.operator.clone();
    if id != ActionId::Inject {
        return Some(Order::UseStation { station, used: id == ActionId::Include, by });
    }
    let (mut fault, mut for_s) = (None, None);
    for value in values {
        match value {
            Value::Fault(found) => fault = Some(found),
            Value::Duration(seconds) => for_s = Some(seconds),
            _ => {}
        }
    }
    Some(Order::Inject(Injection { station, fault: fault?, for_s: for_s?, by }))
}
