//! The account of the floor as text.

use super::text::counted;
use crate::guarantee::Rule;
use account::{Account, Area, Percent, PlateAccount, Shares, Slivers};
use world::{Point, coverage::percent_text};

/// Maximum number of listed unreachable areas; the JSON report has all of them.
const MOST_AREAS: usize = 10;
/// Maximum number of listed arcs of the critical zone.
const MOST_ARCS: usize = 3;
/// Maximum number of listed plates.
const MOST_PLATES: usize = 30;

/// Labelled lines; every percentage states the floor to which it refers, and the percentages of one floor add up to
/// 100.0 %.
pub(crate) fn lines(account: &Account, rule: Rule) -> Vec<(&'static str, String)> {
    let mut lines = vec![
        ("floor", format!("whole floor {}", shares(&account.whole))),
        ("floor", format!("reachable floor {}", shares(&account.reachable))),
    ];
    lines.extend(account.requested.iter().map(|part| ("floor", format!("requested floor {}", shares(part)))));
    lines.extend(account.exact.map(|share| ("floor", exact(share))));
    lines.extend([("floor", critical_zone(account))]);
    lines.extend(arcs(account).into_iter().map(|line| ("floor", line)));
    lines.push(("floor", basis(account, rule)));
    lines.extend(account.missed.iter().map(|area| ("missed", area.to_string())));
    lines.extend(slivers(&account.slivers).into_iter().map(|line| ("missed", line)));
    lines.extend(areas(&account.unreachable).into_iter().map(|line| ("unreachable", line)));
    lines.extend(slivers(&account.unreachable_slivers).into_iter().map(|line| ("unreachable", line)));
    lines.extend(plates(&account.plates).into_iter().map(|line| ("plates", line)));
    lines
}

/// The plates in order; if there are many, only those with the most missed floor.
fn plates(plates: &[PlateAccount]) -> Vec<String> {
    let line = |plate: &PlateAccount| {
        let error = plate.error_p95_m.map(|m| format!(", 95 % error {m:.3} m p95")).unwrap_or_default();
        let worst = plate.error_max_m.map(|m| format!(", {m:.3} m worst")).unwrap_or_default();
        let truth = plate.true_error_p95_m.zip(plate.true_error_max_m);
        let truth = truth
            .map(|(p95_m, max_m)| format!(", true error {p95_m:.3} m p95, {max_m:.3} m worst"))
            .unwrap_or_default();
        format!("{} {}{error}{worst}{truth}", plate.name, shares(&plate.shares))
    };
    if plates.len() <= MOST_PLATES {
        return plates.iter().map(line).collect();
    }
    let whole = plates.iter().filter(|plate| plate.shares.percent.missed <= 0.0).count();
    let missed_m2 = |index: &usize| plates[*index].shares.missed * plates[*index].shares.area_m2;
    let mut worst: Vec<usize> =
        (0..plates.len()).filter(|index| plates[*index].shares.percent.missed > 0.0).collect();
    worst.sort_by(|a, b| missed_m2(b).total_cmp(&missed_m2(a)));
    let left = worst.split_off(worst.len().min(MOST_PLATES));
    worst.sort_unstable();
    let mut lines =
        vec![format!("{whole} of {} with nothing missed; the JSON report lists them all", plates.len())];
    lines.extend(worst.into_iter().map(|index| line(&plates[index])));
    if !left.is_empty() {
        let area_m2: f64 = left.iter().map(missed_m2).sum();
        lines.push(format!("{} more, each with less missed floor, {area_m2:.2} m² in total", left.len()));
    }
    lines
}

fn shares(shares: &Shares) -> String {
    let Percent { scanned, missed, unreachable, margin, untestable, guaranteed } = shares.percent;
    let guaranteed = guaranteed.map(|percent| format!(" ({percent:.1} % guaranteed)")).unwrap_or_default();
    let classes = [
        ("missed", missed),
        ("unreachable", unreachable),
        ("shell margin", margin),
        ("not testable by this tool", untestable),
    ];
    let listed = classes
        .iter()
        .filter(|(name, percent)| *percent > 0.0 || *name == "missed")
        .map(|(name, percent)| format!(", {percent:.1} % {name}"));
    format!("{:.1} m²: {scanned:.1} % scanned{guaranteed}{}", shares.area_m2, listed.collect::<String>())
}

fn exact(share: f64) -> String {
    format!("reachable floor by exact area instead of cells: {} % scanned", percent_text(share, 2))
}

fn critical_zone(account: &Account) -> String {
    let zone = &account.critical_zone;
    let state = zone.why.as_ref().map_or_else(|| "done".to_owned(), |why| format!("NOT done, {why}"));
    format!("critical zone, {:.0} mm along the shell: {state}", 1000.0 * zone.width_m)
}

/// A position to the decimetre, metres.
fn place(at: Point) -> String {
    // Adding zero turns a negative zero into a positive one.
    let [x, y] = [at.x, at.y].map(|c| (10.0 * c).round() / 10.0 + 0.0);
    format!("{x:.1}, {y:.1}")
}

/// The longest arcs of the critical zone that are not done.
fn arcs(account: &Account) -> Option<String> {
    let mut arcs: Vec<_> = account.critical_zone.arcs.iter().collect();
    arcs.sort_by(|a, b| b.not_done_m.total_cmp(&a.not_done_m));
    let listed = arcs.iter().take(MOST_ARCS).map(|arc| {
        if arc.from == arc.to {
            return format!("{:.1} m, the whole shell", arc.not_done_m);
        }
        format!("{:.1} m from {} to {}", arc.not_done_m, place(arc.from), place(arc.to))
    });
    let listed = listed.collect::<Vec<_>>().join("; ");
    let more = arcs.len().saturating_sub(MOST_ARCS);
    let more = if more > 0 { format!("; {}", counted(more as u64, "more arc")) } else { String::new() };
    (!arcs.is_empty()).then(|| format!("critical zone not done: {listed}{more}"))
}

fn basis(account: &Account, rule: Rule) -> String {
    let Account { cell_m, swath_m, position_limit_m, .. } = account;
    format!(
        "cell {cell_m} m, swath {swath_m} m; counted as scanned where the 95 % position error was within {position_limit_m} m; \
         guaranteed by the {}",
        rule.measure()
    )
}

fn slivers<R>(slivers: &Slivers<R>) -> Option<String> {
    let Slivers { count, area_m2, .. } = slivers;
    let areas = || counted(*count as u64, "area");
    (*count > 0).then(|| format!("{area_m2:.2} m² in {} under 0.01 m² each: {}", areas(), slivers.why()))
}

fn areas<R>(areas: &[Area<R>]) -> Vec<String> {
    let mut lines: Vec<String> = areas.iter().take(MOST_AREAS).map(ToString::to_string).collect();
    if let Some(rest) = areas.get(MOST_AREAS..).filter(|rest| !rest.is_empty()) {
        let area_m2: f64 = rest.iter().map(|area| area.area_m2).sum();
        lines.push(format!("{area_m2:.2} m² in {}", counted(rest.len() as u64, "more area")));
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;
    use account::{Cause, MissReason};
    use world::PlateKind;

    #[test]
    fn one_area_more_is_one_area() {
        let area = || Area {
            at: Point::origin(),
            low: Point::origin(),
            high: Point::origin(),
            area_m2: 0.02,
            plate: None,
            plates: Vec::new(),
            reason: MissReason::NotAsked,
            causes: Vec::new(),
        };
        let rest = |count: usize| areas(&(0..count).map(|_| area()).collect::<Vec<_>>()).pop();
        assert_eq!(rest(11).as_deref(), Some("0.02 m² in 1 more area"));
        assert_eq!(rest(12).as_deref(), Some("0.04 m² in 2 more areas"));
        let text = "planned, but the robot passed 0.02 m to one side".to_owned();
        let cause = Cause { reason: MissReason::PassedBeside, area_m2: 0.001, measure: None, text };
        let sliver = slivers(&Slivers { count: 1, area_m2: 0.001, causes: vec![cause] });
        let said = "0.00 m² in 1 area under 0.01 m² each: planned, but the robot passed 0.02 m to one side";
        assert_eq!(sliver.as_deref(), Some(said));
    }

    #[test]
    fn of_many_plates_those_with_most_missed_are_listed_in_their_order() {
        let plate = |k: usize| {
            let missed = if k.is_multiple_of(2) { 0.0 } else { k as f64 / 100.0 };
            let percent =
                Percent { scanned: 100.0 - 100.0 * missed, missed: 100.0 * missed, ..Percent::default() };
            let shares = Shares { area_m2: 1.0, scanned: 1.0 - missed, missed, percent, ..Shares::default() };
            PlateAccount {
                name: format!("R-{k:02}"),
                kind: PlateKind::Rectangular,
                error_p95_m: None,
                error_max_m: None,
                true_error_p95_m: None,
                true_error_max_m: None,
                shares,
            }
        };
        let few: Vec<PlateAccount> = (0..30).map(plate).collect();
        assert_eq!(plates(&few).len(), 30);
        let many: Vec<PlateAccount> = (0..90).map(plate).collect();
        let lines = plates(&many);
        assert!(lines.len() == 32 && lines[0].starts_with("45 of 90 with nothing missed"), "{lines:?}");
        assert!(lines[1].starts_with("R-31") && lines[30].starts_with("R-89"), "{lines:?}");
        assert!(lines[31].starts_with("15 more, each with less missed floor, 2.25 m²"), "{lines:?}");
    }
}
