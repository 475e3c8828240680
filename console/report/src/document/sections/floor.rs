//! Sections on the floor: map, critical zone, accuracy, plates.

use super::super::{
    located::gate::accuracy_how,
    maps::{plate_bar, plate_legend},
    model::Document,
    page::{Block, Row, Table, Value, per_cent, picture},
    run_part::{calibrations, rule, survey_warnings},
    words::{cm, number},
};
use crate::guarantee::{Rule, risk_text};
use account::{Accuracy, Protection};
use world::coverage::percent_text;

/// Maximum number of listed arcs of the critical zone.
const MOST_ARCS: usize = 8;
/// The column of the table of plates before which the untestable floor is inserted.
const UNTESTABLE_COLUMN: usize = 8;
/// Maximum number of missed areas listed for a plate.
const MOST_NUMBERS: usize = 3;

/// The coverage map.
pub(super) fn map(document: &Document) -> Vec<Block> {
    let exact = document.floor.exact.map(|share| {
        Block::Text(format!(
            "Counted in cells, {} % of the reachable floor was scanned; by exact area instead of cells, {} %.",
            per_cent(document.floor.reachable.scanned),
            percent_text(share, 2)
        ))
    });
    std::iter::once(Block::Wide(picture(&document.pictures.coverage))).chain(exact).collect()
}

/// The critical zone: unrolled, its longest arcs, and plate by plate.
pub(in crate::document) fn zone(document: &Document) -> Vec<Block> {
    let zone = &document.floor.critical_zone;
    let state = if zone.done { "Done" } else { "Not done" };
    let scanned = zone.scanned.map_or_else(|| "none".to_owned(), |share| format!("{} %", per_cent(share)));
    let mut blocks = vec![
        Block::Text(format!(
            "{state}: the full width of {:.0} mm was scanned along {:.1} of {:.1} m of shell, and {scanned} \
             of the area of the zone was scanned. The zone is done when its full width is scanned along \
             99.5 % of the shell.",
            1000.0 * zone.width_m,
            zone.done_m,
            zone.length_m
        )),
        Block::Wide(picture(&document.pictures.zone)),
    ];
    let mut arcs: Vec<_> = zone.arcs.iter().collect();
    arcs.sort_by(|a, b| b.not_done_m.total_cmp(&a.not_done_m));
    let all = arcs.len();
    arcs.truncate(MOST_ARCS);
    let which =
        if all > MOST_ARCS { format!("The {MOST_ARCS} longest of {all}") } else { format!("All {all}") };
    let mut table = Table::new(
        format!("{which} arcs of at least 0.1 m that are not done (arcs less than 0.1 m apart count as one)"),
        &[
            ("From x, y", "m", "r nw"),
            ("To x, y", "m", "r nw"),
            ("Along the shell", "m", "r nw"),
            ("Not done", "m", "r"),
            ("Scanned from", "mm from the shell, median", "r"),
            ("Worst", "mm", "r"),
        ],
    );
    let place = |p: world::Point| format!("{}, {}", number(p.x, 2), number(p.y, 2));
    let width_m = zone.width_m;
    let mm =
        |m: f64| if m >= width_m - 1e-9 { "full width".to_owned() } else { format!("{:.0}", 1000.0 * m) };
    for arc in &arcs {
        table.row(vec![
            place(arc.from).into(),
            place(arc.to).into(),
            format!("{:.2} to {:.2}", arc.from_m, arc.to_m).into(),
            format!("{:.2}", arc.not_done_m).into(),
            mm(arc.gap_m).into(),
            mm(arc.gap_max_m).into(),
        ]);
    }
    blocks.extend((!arcs.is_empty()).then_some(Block::Table(table)));
    if !zone.plates.is_empty() {
        let mut table = Table::new(
            "Critical zone plate by plate",
            &[
                ("Plate", "", "nw"),
                ("Shell", "m", "r"),
                ("Done", "m", "r"),
                ("Done", "% of its shell", "r"),
                ("Scanned from", "mm, median", "r"),
            ],
        );
        for plate in &zone.plates {
            let share = if plate.length_m > 0.0 { plate.done_m / plate.length_m } else { 0.0 };
            table.row(vec![
                plate.plate.clone().into(),
                format!("{:.2}", plate.length_m).into(),
                format!("{:.2}", plate.done_m).into(),
                per_cent(share).into(),
                mm(plate.gap_m).into(),
            ]);
        }
        blocks.push(Block::Table(table));
    }
    blocks
}

/// The accuracy of the position, run by run. Only protection levels have a median, so the column of medians needs a run
/// with levels.
pub(in crate::document) fn accuracy_statement(document: &Document) -> Table {
    let has_levels = document.runs.iter().any(|run| run.accuracy.is_some_and(|a| a.protection.is_some()));
    let mut columns = vec![
        ("Position", "", ""),
        ("Mean", "cm", "r"),
        ("p95", "cm", "r"),
        ("Worst", "cm", "r"),
        ("Method", "", ""),
    ];
    if has_levels {
        columns.insert(2, ("Median", "cm", "r"));
    }
    let mut table = Table::new("Accuracy statement", &columns);
    let mut add = |what: String, [mean, median, p95, worst]: [Option<f64>; 4], how: String| {
        let known = |length_m: Option<f64>| length_m.map_or_else(|| "\u{2013}".to_owned(), cm);
        let mut row: Vec<Value> =
            vec![what.into(), known(mean).into(), known(p95).into(), known(worst).into(), how.into()];
        if has_levels {
            row.insert(2, known(median).into());
        }
        table.row(row);
    };
    for run in &document.runs {
        let of = if document.runs.len() > 1 { format!(", {}", run.run) } else { String::new() };
        if let Some(a) = &run.accuracy {
            let errors = [Some(a.mean_m), None, Some(a.p95_m), Some(a.max_m)];
            add(format!("95 % error{of}"), errors, error_how(a));
            if let Some(p) = &a.protection {
                add(format!("Protection level{of}"), [None, p.p50_m, p.p95_m, p.max_m], level_how(p));
            }
        }
        if let Some(p) = &run.positioning {
            let inside = per_cent(p.in_95_ellipse);
            let how = if document.located.is_some() {
                accuracy_how(&inside)
            } else {
                format!(
                    "simulation only; true position within the 95 % ellipse in {inside} % of the ticks; \
                     position lost for {:.1} s",
                    p.position_lost_s
                )
            };
            let errors = [p.mean_error_m, p.p50_m, p.p95_m, p.max_m].map(Some);
            add(format!("true error{of}"), errors, how);
        }
    }
    table
}

/// How the 95 % error was found.
fn error_how(accuracy: &Accuracy) -> String {
    let stations = accuracy.stations_mean.zip(accuracy.stations_min).map(|(mean, least)| {
        format!("; {} fixes from {mean:.1} stations on average, at least {least}", accuracy.fixes)
    });
    format!(
        "covariance of every tick; limit {} cm, exceeded on {} % of the path{}",
        number(100.0 * accuracy.limit_m, 0),
        per_cent(accuracy.over_limit),
        stations.unwrap_or_default()
    )
}

/// What a protection level covers, with which risk.
fn level_how(protection: &Protection) -> String {
    let risk = protection.risk.as_ref().map(|risk| format!("{}; ", risk_text(risk))).unwrap_or_default();
    let levels = if protection.p50_m.is_none() { "the position was never protected; " } else { "" };
    format!(
        "covers one wrong station; {levels}{risk}not protected in {} % of the ticks",
        per_cent(protection.unprotected)
    )
}

const GUARANTEED_BY_ELLIPSE: &str = "A cell is guaranteed if a single pass would have scanned it even with a tool \
    that is narrower on each side by 2.45 standard deviations of the position across the heading. Such a cell was \
    under the tool for every position of the robot within the ellipse.";
const GUARANTEED_BY_PROTECTION: &str = "A cell is guaranteed if a single pass would have scanned it even with a tool \
    that is narrower on each side by the protection level. Such a cell was under the tool for every position of the \
    robot within the level, which also covers one wrong station; where the position was not protected, nothing is \
    guaranteed.";

/// Accuracy and guaranteed coverage.
pub(super) fn accuracy(document: &Document) -> Vec<Block> {
    let pictures = &document.pictures;
    let truth = document.coverage.by_truth.and_then(|truth| truth.scanned_truly.zip(truth.guaranteed_truly));
    let truth = truth.map(|(scanned, sure)| {
        Block::Text(format!(
            "Of the floor reported as scanned, {} % was truly scanned; of the floor reported as guaranteed, \
             {} % was (simulation only).",
            per_cent(scanned),
            percent_text(sure, 2)
        ))
    });
    if !document.is_to_scan {
        let what = "The 95 % error is the longer semi-axis of the 95 % ellipse of the estimated position \
            (2.45 standard deviations).";
        let mut blocks = vec![Block::Text(what.into()), Block::Table(accuracy_statement(document))];
        blocks.extend(survey_warnings(document).chain(calibrations(document)).map(Block::Text));
        return blocks;
    }
    let rule = match rule(document) {
        Rule::Ellipse => GUARANTEED_BY_ELLIPSE.to_owned(),
        Rule::Protection => GUARANTEED_BY_PROTECTION.to_owned(),
        Rule::Both => format!(
            "The runs use two rules. By the 95 % ellipse: {GUARANTEED_BY_ELLIPSE} By the protection level: \
             {GUARANTEED_BY_PROTECTION}"
        ),
    };
    let mut blocks = vec![
        Block::Text(format!(
            "The 95 % error is the longer semi-axis of the 95 % ellipse of the estimated position (2.45 \
             standard deviations). {rule} Adjacent passes are not combined."
        )),
        Block::Pair(vec![picture(&pictures.accuracy), picture(&pictures.guaranteed)]),
        Block::Table(accuracy_statement(document)),
    ];
    blocks.extend(survey_warnings(document).chain(calibrations(document)).map(Block::Text));
    let taken_back = document.runs.iter().flat_map(|run| &run.taken_back);
    blocks.extend(taken_back.map(|floor| Block::Text(format!("Guarantee taken back: {floor}."))));
    // The text above states the share of a single run.
    let all_runs = document.coverage.taken_back.filter(|_| document.runs.len() > 1);
    blocks.extend(all_runs.map(|floor| Block::Text(format!("All runs together: {floor}."))));
    blocks.extend(truth);
    blocks
}

/// The table of all plates.
pub(in crate::document) fn plates(document: &Document) -> Vec<Block> {
    let floor = &document.floor;
    if floor.plates.is_empty() {
        let waiver = Value::fact(document.inspection.plates_waiver.as_ref(), "plates_waiver");
        return vec![
            Block::Text(
                "The scenario has no plate layout ([plates]), so nothing can be stated plate by \
                plate."
                    .into(),
            ),
            Block::Facts(vec![("Waiver", waiver)]),
        ];
    }
    let worst =
        floor.plates.iter().map(|plate| 1.0 - plate.shares.guaranteed.unwrap_or(0.0)).fold(0.0, f64::max);
    let top = [0.02, 0.05, 0.1, 0.2, 0.5].into_iter().find(|top| worst <= *top).unwrap_or(1.0);
    let has_untestable = floor.whole.untestable > 0.0;
    let mut columns = vec![
        ("Plate", "", "nw"),
        ("Kind", "", ""),
        ("Area", "m²", "r"),
        ("Scanned", "%", "r"),
        ("Guaranteed", "%", "r"),
        ("Missed", "%", "r"),
        ("Unreach.", "%", "r"),
        ("Margin", "%", "r"),
        ("Not guaranteed", "", "nw"),
        ("95 % error", "p95, cm", "r"),
        ("Missed", "no.", "no"),
        ("Indic.", "", "r"),
    ];
    if has_untestable {
        columns.insert(UNTESTABLE_COLUMN, ("Not testable", "%", "r"));
    }
    let bar_column = UNTESTABLE_COLUMN + usize::from(has_untestable);
    let mut table = Table::new(
        format!(
            "Every plate ({}). Scanned, missed, unreachable{} add up to 100.0 % of the plate. The \
             bar shows the share that is not guaranteed, from 0 to {} %",
            floor.plates.len(),
            if has_untestable { ", margin and not testable by this tool" } else { " and margin" },
            number(100.0 * top, 0)
        ),
        &columns,
    );
    let tenth = |value: f64| Value::from(format!("{value:.1}"));
    let mut add = |name: &str, kind: &str, shares: &account::Shares, error: Option<f64>, bar: bool| {
        let p = &shares.percent;
        let numbers: Vec<String> = (1..)
            .zip(&floor.missed)
            .filter(|(_, area)| area.plates.iter().any(|plate| plate == name))
            .map(|(no, _): (usize, _)| no.to_string())
            .collect();
        let more = if numbers.len() > MOST_NUMBERS {
            format!(" +{}", numbers.len() - MOST_NUMBERS)
        } else {
            String::new()
        };
        let found = document.indications.iter().filter(|found| found.plate.as_deref() == Some(name)).count();
        let mut cells = vec![
            name.into(),
            kind.into(),
            format!("{:.2}", shares.area_m2).into(),
            tenth(p.scanned),
            tenth(p.guaranteed.unwrap_or(0.0)),
            tenth(p.missed),
            tenth(p.unreachable),
            tenth(p.margin),
            Value::default(),
            error.map_or_else(|| "\u{2013}".to_owned(), cm).into(),
            format!("{}{more}", numbers.iter().take(MOST_NUMBERS).cloned().collect::<Vec<_>>().join(", "))
                .into(),
            if bar { found.to_string() } else { document.indications.len().to_string() }.into(),
        ];
        if has_untestable {
            cells.insert(UNTESTABLE_COLUMN, tenth(p.untestable));
        }
        let row: &mut Row = table.row(cells);
        if bar {
            row.cells[bar_column].svg = plate_bar(shares, top);
        } else {
            row.class = "sum";
        }
    };
    for plate in &floor.plates {
        add(&plate.name, &plate.kind.to_string(), &plate.shares, plate.error_p95_m, true);
    }
    add("Whole floor", "", &floor.whole, None, false);
    vec![Block::Legend(plate_legend(has_untestable)), Block::Table(table)]
}
