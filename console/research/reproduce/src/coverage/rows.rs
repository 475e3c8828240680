//! Rows of one planner on the tanks of one case.

use super::measured::Measured;
use crate::study::{Block, Row, Sample};
use trials::{Entanglement, Scan};
use world::tether::capstan_factor;

/// Coefficient of friction between cable and column, for the pull.
const FRICTION: f64 = 0.3;
/// Required coverage of the reachable floor.
const GOAL: f64 = 0.995;
/// The cable counts as reeled in if at most this length is still out on return, metres.
const IN_M: f64 = 0.3;
/// Maximum number of layouts named in a note.
const NAMED_MAX: usize = 12;

/// A figure of a plan, and whether its smallest or its largest value is the worst one, if either is.
struct Figure {
    metric: &'static str,
    unit: &'static str,
    worst: Worst,
    of: fn(&Scan, &Entanglement) -> f64,
}

#[derive(Clone, Copy, PartialEq)]
enum Worst {
    Min,
    Max,
    Omitted,
}

const fn figure(
    metric: &'static str,
    unit: &'static str,
    worst: Worst,
    of: fn(&Scan, &Entanglement) -> f64,
) -> Figure {
    Figure { metric, unit, worst, of }
}

const FIGURES: &[Figure] = &[
    figure("coverage_reachable", "", Worst::Min, |scan, _| scan.coverage_reachable),
    figure("coverage_exact", "", Worst::Min, |scan, _| scan.coverage_exact),
    figure("coverage_whole", "", Worst::Omitted, |scan, _| scan.coverage_whole),
    figure("critical_zone", "", Worst::Min, |scan, _| scan.critical_zone),
    figure("critical_zone_possible", "", Worst::Omitted, |scan, _| scan.critical_zone_possible),
    figure("length_over_lower_bound", "", Worst::Max, |scan, _| scan.length_over_lower_bound),
    figure("length_m", "m", Worst::Omitted, |scan, _| scan.length_m),
    figure("turns", "", Worst::Max, |scan, _| scan.turns as f64),
    figure("rotation_turns", "", Worst::Max, |scan, _| scan.rotation_turns),
    figure("time_over_lower_bound", "", Worst::Max, |scan, _| scan.time_over_lower_bound),
    figure("tether_length_max_m", "m", Worst::Omitted, |scan, _| scan.certificate.tether_length_max_m),
    figure("max_cable_over_eccentricity", "", Worst::Max, |scan, _| {
        scan.certificate.tether_length_max_m / scan.certificate.eccentricity_m.max(1e-9)
    }),
    figure("max_excess_m", "m", Worst::Max, |_, tether| tether.max_excess_m),
    figure("wrap_max_deg", "deg", Worst::Max, |scan, _| scan.certificate.wrap_max_rad.to_degrees()),
    figure("wrap_total_deg", "deg", Worst::Max, |scan, _| scan.certificate.wrap_total_max_rad.to_degrees()),
    figure("capstan_pull", "", Worst::Max, |scan, _| {
        capstan_factor(FRICTION, scan.certificate.wrap_total_max_rad)
    }),
    figure("max_contacts", "", Worst::Max, |_, tether| tether.max_contacts as f64),
    figure("contact_share", "", Worst::Omitted, |_, tether| tether.contact_share),
    figure("detour_share", "", Worst::Max, |_, tether| tether.detour_share),
    figure("hook_share", "", Worst::Max, |_, tether| tether.hook_share),
    figure("own_cable_share", "", Worst::Omitted, |_, tether| tether.own_cable_share),
    figure("end_length_m", "m", Worst::Max, |scan, _| scan.certificate.end_length_m.unwrap_or(0.0)),
    figure("collisions", "", Worst::Max, |scan, _| scan.certificate.collisions as f64),
    figure("cut_crossings", "", Worst::Max, |scan, _| scan.certificate.cut_crossings as f64),
];

/// A rate that should be 1: the share of layouts that meet a condition.
struct Rate {
    metric: &'static str,
    is_met: fn(&Measured) -> bool,
}

const RATES: &[Rate] = &[
    Rate { metric: "path_rate", is_met: |one| one.figures.is_some() },
    Rate { metric: "complete_rate", is_met: |one| one.figures.is_some() && one.reason.is_none() },
    Rate {
        metric: "coverage_goal_rate",
        is_met: |one| one.figures.as_ref().is_some_and(|(scan, _)| scan.coverage_reachable >= GOAL),
    },
    Rate { metric: "reeled_in_rate", is_met: is_reeled_in },
    Rate {
        metric: "certified_rate",
        is_met: |one| one.figures.as_ref().is_some_and(|(scan, _)| scan.certificate.certified),
    },
];

fn is_reeled_in(one: &Measured) -> bool {
    one.figures.as_ref().is_some_and(|(scan, _)| {
        let certificate = &scan.certificate;
        certificate.crossings_left == 0 && certificate.end_length_m.is_some_and(|left_m| left_m <= IN_M)
    })
}

/// The rows for measurements on the layouts of these seeds.
///
/// Rates are shares of all layouts. All other figures are computed from the layouts with a path, and their rows state
/// the number of these layouts.
pub(super) fn rows(block: &Block<'_>, all: &[(u64, &Measured)]) -> Vec<Row> {
    let mut rows: Vec<Row> = RATES.iter().map(|rate| rate.row(block, all)).collect();
    rows.extend(FIGURES.iter().flat_map(|figure| figure.rows(block, all)));
    let times: Sample = all.iter().filter_map(|(_, one)| one.plan_time_ms).collect();
    rows.extend(block.mean_and_median("plan_time_ms", &times, "ms"));
    rows.push(block.row("plan_time_ms_max", times.max(), "ms", times.len()));
    rows
}

impl Rate {
    fn row(&self, block: &Block<'_>, all: &[(u64, &Measured)]) -> Row {
        let missed: Vec<&(u64, &Measured)> = all.iter().filter(|(_, one)| !(self.is_met)(one)).collect();
        let share = 1.0 - missed.len() as f64 / all.len().max(1) as f64;
        block.row(self.metric, share, "", all.len()).note(named(self.metric, &missed))
    }
}

impl Figure {
    /// The mean, and the worst value with its seed.
    fn rows(&self, block: &Block<'_>, all: &[(u64, &Measured)]) -> Vec<Row> {
        let value = |(scan, tether): &(Scan, Entanglement)| (self.of)(scan, tether);
        let values: Vec<(u64, f64)> =
            all.iter().filter_map(|(seed, one)| Some((*seed, value(one.figures.as_ref()?)))).collect();
        let mean = values.iter().map(|(_, value)| *value).collect::<Sample>().mean();
        let mut rows = vec![block.row(self.metric, mean, self.unit, values.len())];
        let by_value = |a: &&(u64, f64), b: &&(u64, f64)| a.1.total_cmp(&b.1);
        let (end, worst) = match self.worst {
            Worst::Min => ("min", values.iter().min_by(by_value)),
            Worst::Max => ("max", values.iter().max_by(by_value)),
            Worst::Omitted => return rows,
        };
        let seed = worst.map_or_else(String::new, |(seed, _)| format!("seed {seed}"));
        let metric = format!("{}_{end}", self.metric);
        rows.push(block.row(&metric, worst.map(|w| w.1), self.unit, values.len()).note(seed));
        rows
    }
}

/// Lists the layouts that do not meet a condition: the first few with the reason, then the number of all others.
fn named(metric: &str, missed: &[&(u64, &Measured)]) -> String {
    let listed: Vec<String> =
        missed.iter().take(NAMED_MAX).map(|(seed, one)| named_one(metric, *seed, one)).collect();
    let rest = missed.len().saturating_sub(NAMED_MAX);
    let more = if rest > 0 { format!("; {rest} more") } else { String::new() };
    format!("{}{more}", listed.join("; "))
}

fn named_one(metric: &str, seed: u64, one: &Measured) -> String {
    let scan = one.figures.as_ref().map(|(scan, _)| scan);
    let why = match (metric, scan) {
        ("coverage_goal_rate", Some(scan)) => Some(format!("{:.2} %", 100.0 * scan.coverage_reachable)),
        ("reeled_in_rate", Some(scan)) => {
            Some(format!("{:.1} m of tether out", scan.certificate.end_length_m.unwrap_or(0.0)))
        }
        ("certified_rate", Some(scan)) => scan.certificate.reasons.first().cloned(),
        _ => one.reason.clone(),
    };
    format!("seed {seed} ({})", why.unwrap_or_else(|| "no reason given".into()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use trials::tanks::Known;
    use world::Point;

    const BLOCK: Block<'_> = Block { table: "coverage-suite", case: "random", method: "m", note: "" };

    fn flown(path: &[(f64, f64)]) -> Measured {
        let tank = trials::tanks::Tank { columns: vec![(Point::new(4.0, 0.0), 0.3)], ..Known::E1.tank(0) };
        let path: Vec<Point> = path.iter().map(|(x, y)| Point::new(*x, *y)).collect();
        let scan = tank.score(&path, &[], 0.2).unwrap();
        let tether = tank.entanglement(&path).unwrap();
        Measured { figures: Some((scan, tether)), reason: None, plan_time_ms: Some(4.0) }
    }

    #[test]
    fn every_layout_counts_and_those_without_a_path_are_named_with_the_reason() {
        let good = flown(&[(0.0, 0.0), (0.0, 8.0), (0.0, 0.0)]);
        let hooked = flown(&[(0.0, 0.0), (4.0, 2.0), (8.0, 0.0), (4.0, -2.0), (0.0, 0.0)]);
        let none = Measured { reason: Some("it panicked".into()), ..Measured::default() };
        let rows = rows(&BLOCK, &[(7, &good), (8, &hooked), (9, &none)]);
        let of = |metric: &str| rows.iter().find(|row| row.metric == metric).unwrap();
        let (path, reeled) = (of("path_rate"), of("reeled_in_rate"));
        assert_eq!((path.n, path.note.as_str()), (3, "seed 9 (it panicked)"));
        assert!(
            (path.ours.unwrap() - 2.0 / 3.0).abs() < 1e-9 && (reeled.ours.unwrap() - 1.0 / 3.0).abs() < 1e-9
        );
        assert!(reeled.note.contains("seed 8 (9.0 m of tether out)"), "{}", reeled.note);
        assert!(of("certified_rate").note.contains("still out on return"), "{}", of("certified_rate").note);
        assert_eq!((of("end_length_m").n, of("end_length_m_max").note.as_str()), (2, "seed 8"));
        assert_eq!((of("plan_time_ms").n, of("max_contacts_max").ours), (2, Some(1.0)));
        assert!(of("capstan_pull").ours.unwrap() > 1.0 && of("own_cable_share").ours.unwrap() > 0.0);
    }

    #[test]
    fn many_layouts_are_counted_where_they_are_not_named() {
        let none = Measured { reason: Some("no room".into()), ..Measured::default() };
        let all: Vec<(u64, &Measured)> = (0..20).map(|seed| (seed, &none)).collect();
        let rows = rows(&BLOCK, &all);
        assert!(rows[0].note.ends_with("seed 11 (no room); 8 more"), "{}", rows[0].note);
        assert!(rows.iter().any(|row| row.metric == "length_m" && row.ours.is_none() && row.n == 0));
    }
}
