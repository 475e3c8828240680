//! The achieved figures alongside the plan's estimate.

use super::{plates, role, title};
use crate::model::{Model, Pane, RunResult};
use crate::theme::Role;
use crate::view::look::{Look, Parts};
use crate::view::text;
use account::{FigureId, Shares, Summary};
use ratatui::Frame;
use ratatui::layout::Rect;

/// Width of the names in the table, columns.
const LABEL: usize = 17;
/// Minimum width of the names, columns.
const NARROWEST: usize = 8;
/// Width of a clock and the blank before it, columns.
const CLOCK: usize = 9;
/// Width from which the worst plate, and the worst values with time and place, are shown, columns.
pub(super) const WORST: usize = 52;
/// The figures whose worst values are shown, and the width of their names, columns.
const SHOWN: [FigureId; 4] =
    [FigureId::PositionError, FigureId::Clearance, FigureId::TetherOut, FigureId::WrapLargest];
const NAME: usize = 16;

/// A figure: its name, the estimate, the achieved value, the limit, and whether the limit was exceeded.
struct Figure {
    cells: [String; 4],
    is_beyond: bool,
}

impl Figure {
    /// Whether the mission has the figure: a row without an estimate, a value and a limit says nothing.
    fn applies(&self) -> bool {
        self.cells[1..].iter().any(|cell| *cell != dash())
    }
}

/// The rows that the pane needs.
pub(super) fn rows(model: &Model, result: &RunResult, columns: u16) -> u16 {
    lines(model, result, columns.into()).len() as u16
}

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect, result: &RunResult) {
    let lines = lines(look.model, result, usize::from(area.width.saturating_sub(2)));
    super::scrolled(look, frame, (Pane::Figures, area), (role(result), &title(look.model, result)), lines);
}

/// The reason for the end, unmet expectations, the figures, the errors against the true position, and the worst values;
/// most important first.
fn lines(model: &Model, result: &RunResult, columns: usize) -> Vec<Parts> {
    let wrapped = |role: Role, words: &str| {
        let lines = text::wrap(&text::capitalized(words), columns.saturating_sub(1)).into_iter();
        lines.map(|line| vec![(role, format!(" {line}"))]).collect::<Vec<Parts>>()
    };
    let reason = result.summary.reason.as_deref().unwrap_or("cut off");
    let doubt = doubt(model);
    let mut lines: Vec<Parts> = doubt.iter().flat_map(|words| wrapped(Role::Warn, words)).collect();
    lines.extend(wrapped(role(result), reason));
    if model.ui.parts.without_scan {
        lines.extend(wrapped(Role::Text, super::floor::no_scan(model)));
    }
    lines.extend(torn(result).iter().flat_map(|words| wrapped(Role::Warn, words)));
    lines.extend(requested(model).iter().flat_map(|words| wrapped(Role::Text, words)));
    lines.extend(guaranteed(model, result).iter().flat_map(|words| wrapped(Role::Text, words)));
    for violation in result.summary.violations.iter().flatten() {
        lines.extend(wrapped(Role::Warn, &format!("! {violation}")));
    }
    lines.extend(table(model, result, columns));
    lines.extend(level(result).iter().flat_map(|words| wrapped(Role::Text, words)));
    lines.extend(trouble(model, result, columns));
    let notes = true_error(model, result).into_iter().chain(scan_limit(model, result));
    lines.extend(notes.flat_map(|words| wrapped(Role::Text, &words)));
    // On a narrower screen, the shares of the floor have the line about the plate.
    lines.extend(plates::worst(model, columns).filter(|_| columns >= WORST));
    lines.extend(worst(result, columns));
    if model.live.is_replay() && model.live.plans.estimate.is_none() && !model.live.run.is_survey() {
        lines
            .extend(wrapped(Role::Dim, "No predictions: the run did not start with a plan that has a path."));
    }
    lines
}

/// The floor in doubt, and how to scan it again; `None` if no floor is in doubt.
fn doubt(model: &Model) -> Option<String> {
    let (area_m2, stations) = model.live.doubt()?;
    let area_m2 = text::number(area_m2, 1);
    // A re-scan of a re-scan is worth it only for areas of some size, which the list of missed areas has.
    let words = match model.live.together() {
        Some(_) => format!("IN DOUBT after all runs: {area_m2} m², scanned while {stations} was wrong."),
        None => format!("IN DOUBT: {area_m2} m², scanned while {stations} was wrong. <rescan>: re-scan it."),
    };
    Some(model.console.keys.spelled(&words))
}

/// The table of the figures with its heading.
fn table(model: &Model, result: &RunResult, columns: usize) -> impl Iterator<Item = Parts> {
    let (label, width) = widths(columns);
    let head = ["", "predicted", "actual", "limit"].map(str::to_owned);
    let rows = figures(model, result).into_iter().map(|row| {
        let role = if row.is_beyond { Role::Warn } else { Role::Text };
        (role, row.cells)
    });
    std::iter::once((Role::Dim, head)).chain(rows).map(move |(role, [what, predicted, actual, limit])| {
        // Without colours, the mark shows that a limit has been exceeded.
        let mark = if role == Role::Warn { "!" } else { " " };
        // A narrow table omits the words after a value that state what the value refers to.
        let name = what.split(" (").next().unwrap_or_default().to_owned();
        let what = text::wording([what, name], label);
        vec![
            (Role::Dim, format!(" {}", text::column(&what, label))),
            (Role::Dim, format!("{predicted:>width$}")),
            (role, format!("{actual:>width$}{mark}")),
            (Role::Dim, format!("{limit:>width$}", width = width.saturating_sub(1))),
        ]
    })
}

/// The widths of a label and of a value, which has room for a clock.
fn widths(columns: usize) -> (usize, usize) {
    let label = LABEL.min(columns.saturating_sub(2 + 3 * CLOCK)).max(NARROWEST);
    (label, columns.saturating_sub(label + 2) / 3)
}

/// The worst values with time and, as far as it fits, place.
fn worst(result: &RunResult, columns: usize) -> Vec<Parts> {
    if columns < WORST {
        return Vec::new();
    }
    let row = |figure: &account::Figure| -> Option<Parts> {
        let (id, worst) = (figure.id, figure.worst?);
        let blank = if id.unit() == "°" { "" } else { " " };
        let value = format!("{}{blank}{}", text::number(worst.value, id.decimals()), id.unit());
        let when = format!("T+{}", text::clock(worst.t_s));
        let words = [format!("{when} at {}", text::place(worst.at)), when];
        Some(vec![
            (Role::Dim, format!(" {}", text::column(id.name(), NAME))),
            (Role::Text, format!("{value:>9}")),
            (Role::Dim, format!("  {}", text::wording(words, columns.saturating_sub(NAME + 12)))),
        ])
    };
    let rows = result.summary.extremes.iter().filter(|figure| SHOWN.contains(&figure.id)).filter_map(row);
    let mut rows: Vec<Parts> = rows.collect();
    if !rows.is_empty() {
        rows.insert(0, vec![(Role::Dim, " Worst values, by estimated position:".into())]);
    }
    rows
}

fn figures(model: &Model, result: &RunResult) -> Vec<Figure> {
    let (run, summary) = (&model.live.run, &result.summary);
    let promised = model.live.plans.estimate.as_ref().map(|(_, estimate)| estimate);
    let mission = run.about.as_ref().map(|about| &about.mission);
    let metres = |decimals| move |m: f64| format!("{} m", text::number(m, decimals));
    let degrees = |rad: f64| format!("{}°", text::number(rad.to_degrees(), 0));
    let clearance = promised.and_then(|p| p.clearance_min).map(|worst| worst.value);
    let promised_m = promised.map(|p| p.length_m);
    let trail = run.trail.points();
    let driven_m = (trail.len() > 1).then(|| world::polyline::length_m(trail));
    // A replay knows the path and the time moving only up to its moment, but the other figures are those of the whole run.
    let is_replay = model.live.is_replay();
    let driven_m = driven_m.filter(|_| !is_replay);
    // The estimate and the limit do not include the time during which the mission waits.
    let (time, took_s, limit_s) = if is_replay {
        ("mission time", summary.mission_time_s, None)
    } else {
        ("time moving", Some(run.clock.moving_s), mission.map(|mission| mission.time_limit_s))
    };
    let mut figures = vec![
        at_most(time, text::clock, [promised.map(|p| p.time_s), took_s, limit_s]),
        match summary.path_length_m {
            Some(_) => at_most("path", metres(1), [promised_m, summary.path_length_m, None]),
            // Without a true position, the length is that of the estimated one.
            None => at_most("path (est.)", metres(1), [promised_m, driven_m, None]),
        },
    ];
    let required = mission.map(|mission| mission.clearance_m);
    figures.push(match summary.clearance_min_m {
        Some(true_m) => at_least("clearance (true)", metres(2), [clearance, Some(true_m), required]),
        None => at_least("clearance (est.)", metres(2), [clearance, estimated_clearance(summary), required]),
    });
    if let Some(tether) = &summary.tether {
        let estimate = promised.and_then(|p| p.tether.as_ref());
        let limits = mission.and_then(|m| m.tether.as_ref()).map(|tether| tether.limits);
        figures.push(at_most(
            "tether out (true)",
            metres(1),
            [
                estimate.map(|t| t.length_max.value),
                Some(tether.tether_length_max_m),
                limits.map(|limits| limits.reel_length_m),
            ],
        ));
        figures.push(at_most(
            "wrap (true)",
            degrees,
            [
                estimate.map(|t| t.wrap_max.value),
                Some(tether.wrap_max_rad),
                limits.map(|limits| limits.wrap_max_rad),
            ],
        ));
    }
    let accuracy = summary.accuracy.as_ref();
    figures.push(at_most(
        "95 % error",
        metres(2),
        [
            promised.and_then(|p| p.accuracy_worst).map(|worst| worst.value),
            accuracy.map(|accuracy| accuracy.max_m),
            mission.map(|mission| mission.position_limit_m),
        ],
    ));
    figures.retain(Figure::applies);
    figures
}

/// The break of the tether: when the mission found it or, in a simulation, that the mission did not find it.
fn torn(result: &RunResult) -> Option<String> {
    let tether = result.summary.tether.as_ref()?;
    match tether.broken_at_s {
        Some(at_s) => Some(format!("! tether found broken at T+{}", text::clock(at_s))),
        None => tether.torn_at_end.then(|| "! tether truly torn at the end; not found broken".to_owned()),
    }
}

/// The smallest clearance at the estimated position, metres.
fn estimated_clearance(summary: &Summary) -> Option<f64> {
    let figure = summary.extremes.iter().find(|figure| figure.id == FigureId::Clearance)?;
    figure.worst.map(|worst| worst.value)
}

/// The scanned share of the requested floor, and why the share of the whole is smaller; for a re-scan, also what all runs
/// have scanned.
fn requested(model: &Model) -> Vec<String> {
    let live = &model.live;
    let own = live.result.as_ref().and_then(|result| result.summary.floor.as_ref());
    let own = live.requested().zip(own).map(|(requested, own)| {
        let scanned = text::number(requested.percent.scanned, 1);
        let area_m2 = text::number(requested.area_m2, 1);
        match live.together() {
            Some(_) => format!("This run scanned {scanned} % of the requested {area_m2} m²."),
            None => format!(
                "Scanned {scanned} % of the requested {area_m2} m². That is {} % of all reachable floor; the rest was \
                 not requested.",
                text::percent(own.reachable.scanned)
            ),
        }
    });
    let all = live.together().map(|all| {
        let of = |shares: &Shares| text::number(shares.percent.scanned, 1);
        format!(
            "With {}: {} % of reachable floor, {} % of the whole floor.",
            all.before(),
            of(&all.floor.reachable),
            of(&all.floor.whole)
        )
    });
    own.into_iter().chain(all).collect()
}

/// The guaranteed share of the reachable floor with the rule by which it counts; for a re-scan, also the share over all runs,
/// and what became of the floor that lost its guarantee.
fn guaranteed(model: &Model, result: &RunResult) -> Vec<String> {
    let level = result.summary.accuracy.and_then(|accuracy| accuracy.protection);
    let rule = if level.is_some_and(|level| level.guarantees) { "protection level" } else { "95 % ellipse" };
    let share = |shares: &Shares| Some(text::number(shares.percent.guaranteed?, 1));
    let own = result.summary.floor.as_ref().and_then(|floor| share(&floor.reachable));
    let own = own.map(|own| format!("Guaranteed by the {rule}: {own} % of reachable floor."));
    let all = model.live.together().and_then(|all| {
        let shared = share(&all.floor.reachable).map(|share| format!("{share} % guaranteed"));
        let regained = all.taken_back.map(|floor| floor.to_string());
        let parts: Vec<String> = shared.into_iter().chain(regained).collect();
        (!parts.is_empty()).then(|| format!("All runs: {}.", parts.join("; ")))
    });
    own.into_iter().chain(all).collect()
}

/// The protection level of the run; `None` if its scenario states no risk.
fn level(result: &RunResult) -> Option<String> {
    let level = result.summary.accuracy?.protection?;
    let Some((median_m, max_m)) = level.p50_m.zip(level.max_m) else {
        return Some("Protection level: none; the position was never protected.".to_owned());
    };
    Some(format!(
        "Protection level: median {} m, largest {} m; none for {} % of the time.",
        text::number(median_m, 2),
        text::number(max_m, 2),
        text::percent(level.unprotected)
    ))
}

/// The error against the true position.
fn true_error(model: &Model, result: &RunResult) -> Option<String> {
    let error = result.summary.positioning.as_ref()?;
    let worst = result.summary.extremes.iter().find(|figure| figure.id == FigureId::TrueError);
    let at = worst.and_then(|figure| figure.worst);
    let at = at.map_or_else(String::new, |worst| format!(" at {}", text::place(worst.at)));
    let plate = plates::worst_true(model).map_or_else(String::new, |words| format!("; {words}"));
    let metres = |m: f64| text::number(m, 3);
    Some(format!(
        "Error against the true position: mean {}, median {}, p95 {}, worst {} m{at}{plate}.",
        metres(error.mean_error_m),
        metres(error.p50_m),
        metres(error.p95_m),
        metres(error.max_m)
    ))
}

/// The limit above which floor does not count as scanned, if it is not the limit of the position, and where it was
/// exceeded.
fn scan_limit(model: &Model, result: &RunResult) -> Option<String> {
    let mission = &model.live.run.about.as_ref()?.mission;
    let (accuracy, _) = (result.summary.accuracy.as_ref()?, result.summary.floor.as_ref()?);
    let limit_m = mission.scan_limit_m();
    (limit_m < mission.position_limit_m).then(|| {
        format!(
            "Floor counts as scanned up to a 95 % error of {} m; the error was above it on {} % of the path.",
            text::number(limit_m, 2),
            text::percent(accuracy.over_limit)
        )
    })
}

/// A figure that must not exceed its limit; `values` are the estimate, the achieved value and the limit.
fn at_most(what: &str, written: impl Fn(f64) -> String, values: [Option<f64>; 3]) -> Figure {
    figure(what, written, values, |actual, limit| actual > limit)
}

/// A figure that must not fall below its limit; `values` are the estimate, the achieved value and the limit.
fn at_least(what: &str, written: impl Fn(f64) -> String, values: [Option<f64>; 3]) -> Figure {
    figure(what, written, values, |actual, limit| actual < limit)
}

fn figure(
    what: &str,
    written: impl Fn(f64) -> String,
    values: [Option<f64>; 3],
    is_beyond: impl Fn(f64, f64) -> bool,
) -> Figure {
    let [_, actual, limit] = values;
    let [predicted, came, most] = values.map(|value| value.map_or_else(dash, &written));
    // Values that print the same are treated as equal.
    let is_beyond = came != most && actual.zip(limit).is_some_and(|(actual, limit)| is_beyond(actual, limit));
    Figure { cells: [what.to_owned(), predicted, came, most], is_beyond }
}

fn dash() -> String {
    "-".to_owned()
}

/// The holds, collisions, faults and alarms, in lines.
fn trouble(model: &Model, result: &RunResult, columns: usize) -> Vec<Parts> {
    let summary = &result.summary;
    // In a replay, the open alarms are those of its moment.
    let alarms = (!model.live.is_replay()).then(|| model.live.run.alarms.open().count());
    let alarms = alarms.map_or_else(String::new, |n| format!(", alarms open {n}"));
    let words = format!(
        "Holds {}, {}planner faults {}{alarms}.{}",
        summary.holds,
        summary.collisions.map_or_else(String::new, |n| format!("collisions {n}, ")),
        summary.planner_faults,
        if summary.collisions.is_none() { " Collisions are not known: no true position." } else { "" },
    );
    let lines = text::wrap(&words, columns.saturating_sub(1)).into_iter();
    lines.map(|line| vec![(Role::Text, format!(" {line}"))]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clocks_beside_each_other_never_touch() {
        for columns in 40..120 {
            let (label, width) = widths(columns);
            assert!(width > text::clock(3599.0).len(), "{columns}");
            assert!(label >= NARROWEST && 1 + label + 3 * width < columns, "{columns}");
        }
    }
}
