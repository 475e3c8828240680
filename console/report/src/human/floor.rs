//! The account of the floor as lines for people.

use crate::account::{Account, Area, Percent, Shares, Slivers};
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
    lines.extend(slivers(account.slivers).into_iter().map(|line| ("missed", line)));
    lines.extend(areas(&account.unreachable).into_iter().map(|line| ("out of reach", line)));
    lines.extend(slivers(account.unreachable_slivers).into_iter().map(|line| ("out of reach", line)));
    let plates = account.plates.iter().map(|plate| format!("{} {}", plate.name, shares(&plate.shares)));
    lines.extend(plates.map(|line| ("plates", line)));
    lines
}

fn shares(shares: &Shares) -> String {
    let Percent { scanned, missed, unreachable, margin } = shares.percent;
    let classes =
        [("scanned", scanned), ("missed", missed), ("unreachable", unreachable), ("shell margin", margin)];
    let told = classes
        .iter()
        .filter(|(name, percent)| *percent > 0.0 || matches!(*name, "scanned" | "missed"))
        .map(|(name, percent)| format!("{percent:.1} % {name}"));
    format!("{:.1} m²: {}", shares.area_m2, told.collect::<Vec<_>>().join(", "))
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

fn slivers(slivers: Slivers) -> Option<String> {
    let Slivers { count, area_m2 } = slivers;
    (count > 0).then(|| format!("{area_m2:.2} m² in {count} places too small to be listed"))
}

fn areas<R: Display>(areas: &[Area<R>]) -> Vec<String> {
    let mut lines: Vec<String> = areas.iter().take(MOST_AREAS).map(ToString::to_string).collect();
    if let Some(rest) = areas.get(MOST_AREAS..).filter(|rest| !rest.is_empty()) {
        let area_m2: f64 = rest.iter().map(|area| area.area_m2).sum();
        lines.push(format!("{area_m2:.2} m² in {} more places", rest.len()));
    }
    lines
}
