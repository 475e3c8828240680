//! The account of the floor as lines for people.

use crate::account::{Account, Area, Shares};
use std::fmt::Display;

/// Areas that are listed; the report as JSON has all of them.
const MOST_AREAS: usize = 10;

/// Lines with their labels; every percentage names its floor, and those of one floor sum to 100.0 %.
pub fn lines(account: &Account) -> Vec<(&'static str, String)> {
    let mut lines = vec![
        ("floor", format!("whole floor {}", shares(&account.whole))),
        ("floor", format!("reachable floor {}", shares(&account.reachable))),
        ("floor", critical_zone(account)),
        ("floor", basis(account)),
    ];
    lines.extend(areas(&account.missed).into_iter().map(|line| ("missed", line)));
    if account.slivers.count > 0 {
        let (count, area_m2) = (account.slivers.count, account.slivers.area_m2);
        lines.push(("missed", format!("{area_m2:.2} m² in {count} places too small to be listed")));
    }
    lines.extend(areas(&account.unreachable).into_iter().map(|line| ("out of reach", line)));
    let plates = account.plates.iter().map(|plate| format!("{} {}", plate.name, shares(&plate.shares)));
    lines.extend(plates.map(|line| ("plates", line)));
    lines
}

fn shares(shares: &Shares) -> String {
    let classes = [
        ("scanned", shares.scanned),
        ("missed", shares.missed),
        ("unreachable", shares.unreachable),
        ("shell margin", shares.margin),
    ];
    let rounded = percents(&classes.map(|(_, share)| share));
    let told = classes
        .iter()
        .zip(rounded)
        .filter(|((name, _), percent)| *percent > 0.0 || matches!(*name, "scanned" | "missed"))
        .map(|((name, _), percent)| format!("{percent:.1} % {name}"));
    format!("{:.1} m²: {}", shares.area_m2, told.collect::<Vec<_>>().join(", "))
}

/// Shares as per cent with one decimal that sum to 100.0 if the shares sum to 1: what rounding down leaves goes to
/// those that it hurt most.
pub fn percents(shares: &[f64]) -> Vec<f64> {
    let exact: Vec<f64> = shares.iter().map(|share| share * 1000.0).collect();
    let mut parts: Vec<f64> = exact.iter().map(|part| (part + 1e-9).floor()).collect();
    let lacking = (exact.iter().sum::<f64>().round() - parts.iter().sum::<f64>()).max(0.0) as usize;
    let mut order: Vec<usize> = (0..shares.len()).collect();
    order.sort_by(|a, b| (exact[*b] - parts[*b]).total_cmp(&(exact[*a] - parts[*a])));
    order.into_iter().take(lacking).for_each(|index| parts[index] += 1.0);
    parts.iter().map(|part| part / 10.0).collect()
}

fn critical_zone(account: &Account) -> String {
    let zone = &account.critical_zone;
    let state = match &zone.why {
        None => "done".to_owned(),
        Some(why) => format!("NOT done: {why}"),
    };
    format!("critical zone of {:.0} mm at the shell {state}", 1000.0 * zone.width_m)
}

fn basis(account: &Account) -> String {
    let Account { cell_m, swath_m, position_limit_m, .. } = account;
    format!(
        "cells of {cell_m} m, swath {swath_m} m; counted where the 95 % position error was within {position_limit_m} m"
    )
}

fn areas<R: Display>(areas: &[Area<R>]) -> Vec<String> {
    let mut lines: Vec<String> = areas.iter().take(MOST_AREAS).map(area).collect();
    if let Some(rest) = areas.get(MOST_AREAS..).filter(|rest| !rest.is_empty()) {
        let area_m2: f64 = rest.iter().map(|area| area.area_m2).sum();
        lines.push(format!("{area_m2:.2} m² in {} more places", rest.len()));
    }
    lines
}

fn area<R: Display>(area: &Area<R>) -> String {
    let plate = area.plate.as_ref().map(|name| format!(", plate {name}")).unwrap_or_default();
    format!("{:.2} m² at {:.1}, {:.1} m{plate}: {}", area.area_m2, area.at.x, area.at.y, area.reason)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn thirds_sum_to_a_hundred() {
        let rounded = percents(&[1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0]);
        assert!((rounded.iter().sum::<f64>() - 100.0).abs() < 1e-9, "{rounded:?}");
        assert!(percents(&[1.0, 0.0]).iter().zip([100.0, 0.0]).all(|(a, b)| (a - b).abs() < 1e-9));
    }

    proptest! {
        #[test]
        fn whatever_is_divided_sums_to_a_hundred(parts in prop::collection::vec(0_u32..5000, 2..6)) {
            let whole: u32 = parts.iter().sum();
            prop_assume!(whole > 0);
            let shares: Vec<f64> = parts.iter().map(|part| f64::from(*part) / f64::from(whole)).collect();
            let rounded = percents(&shares);
            prop_assert!((rounded.iter().sum::<f64>() - 100.0).abs() < 1e-6, "{:?}", rounded);
            for (share, percent) in shares.iter().zip(&rounded) {
                prop_assert!((percent - 100.0 * share).abs() < 0.1 + 1e-6);
            }
        }
    }
}
