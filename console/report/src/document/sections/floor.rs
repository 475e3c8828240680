//! Sections on the floor: map, missed areas, critical zone, accuracy, plates.

use super::{
    super::{
        maps::{plate_bar, plate_legend},
        page::{Block, Cell, Row, Table, Value, per_cent},
    },
    Document, cm, counted, number, picture,
};
use crate::account::{Area, MissReason};
use std::collections::BTreeMap;

/// Arcs of the critical zone that are listed.
const MOST_ARCS: usize = 8;

/// The coverage map.
pub(super) fn map(document: &Document) -> Vec<Block> {
    let exact = document.floor.exact.map(|share| {
        Block::Text(format!(
            "Counted in cells, {} % of the reachable floor was scanned; by exact area, without cells, {:.2} %.",
            per_cent(document.floor.reachable.scanned),
            100.0 * share
        ))
    });
    std::iter::once(Block::Wide(picture(&document.pictures.coverage))).chain(exact).collect()
}

/// Missed areas, and what is out of reach.
pub(super) fn missed(document: &Document) -> Vec<Block> {
    let floor = &document.floor;
    let mut blocks = vec![Block::Text(
        "Cells that touch make one area, whatever plates they lie on. Every reason states its value; where an area has \
         several causes, each is listed with its part of the area."
            .into(),
    )];
    let mut table = Table::new(
        "Missed areas, the largest first",
        &[
            ("No.", "", ""),
            ("x", "m", "r nw"),
            ("y", "m", "r nw"),
            ("Extent", "m", "r nw ext"),
            ("Area", "m²", "r nw area"),
            (if floor.plates.is_empty() { "" } else { "Plates" }, "", "full"),
            ("Reason", "", "full"),
        ],
    );
    table.is_cards = true;
    for (no, area) in (1..).zip(&floor.missed) {
        let class = if document.pictures.badges.contains(&no) { "badge" } else { "badge h" };
        let badge = Cell { svg: format!(r#"<span class="{class}">{no}</span>"#), ..Cell::default() };
        let extent = area.high - area.low;
        let row = table.row(vec![
            Value::default(),
            number(area.at.x, 2).into(),
            number(area.at.y, 2).into(),
            format!("{:.2} × {:.2}", extent.x, extent.y).into(),
            format!("{:.3}", area.area_m2).into(),
            plates_of(area).into(),
            area.why().into(),
        ]);
        row.id = format!("m{no}");
        row.cells[0] = badge;
        (row.cells[1].key, row.cells[2].key) = ("x", "y");
        row.cells[5].key = if area.plates.is_empty() { "" } else { "plates" };
    }
    let missed_m2 = floor.reachable.missed * floor.reachable.area_m2;
    let listed_m2: f64 = floor.missed.iter().map(|area| area.area_m2).sum();
    let total = format!(
        "All missed floor: {missed_m2:.3} m²; {}: {listed_m2:.3} m²; {} under 0.01 m² each: {:.3} m²{}.",
        counted(floor.missed.len() as u64, "area"),
        floor.slivers.count,
        floor.slivers.area_m2,
        if floor.slivers.count > 0 { format!(", {}", floor.slivers.why()) } else { String::new() }
    );
    let is_some = !table.rows.is_empty();
    blocks.extend(is_some.then_some(Block::Table(table)));
    blocks.push(Block::Note(total));
    blocks.push(Block::Table(unreachable(document)));
    blocks.push(Block::Note(balance(document)));
    blocks
}

/// Why the whole floor is not the sum of the reachable floor and what is out of reach.
fn balance(document: &Document) -> String {
    let (whole, reachable) = (&document.floor.whole, &document.floor.reachable);
    let thousandths = |m2: f64| (1000.0 * m2).round();
    let all = thousandths(whole.area_m2 - reachable.area_m2);
    let [unreachable, margin] =
        [whole.unreachable, whole.margin].map(|share| thousandths(share * whole.area_m2));
    // The rest of what is printed, so that the line adds up to its last digit.
    let [all, unreachable, margin, scanned] =
        [all, unreachable, margin, all - unreachable - margin].map(|m2| m2 / 1000.0);
    format!(
        "Whole floor minus reachable floor: {all:.3} m² = {unreachable:.3} m² unreachable + {margin:.3} m² shell margin + {scanned:.3} m² \
         scanned although not counted as reachable: the robot came closer to the shell or to an obstacle than hull and clearance allow, \
         or the floor was reachable before an obstacle was found."
    )
}

fn plates_of(area: &Area<MissReason>) -> String {
    let more = area.plates.len().saturating_sub(2);
    let names = area.plates.iter().take(2).cloned().collect::<Vec<_>>().join(", ");
    if more > 0 { format!("{names} +{more}") } else { names }
}

fn unreachable(document: &Document) -> Table {
    let floor = &document.floor;
    let mut table = Table::new(
        "Floor out of reach of the tool",
        &[
            ("Reason", "", ""),
            ("Areas", "", "r"),
            ("Area", "m²", "r"),
            ("Largest: place in m, reason", "", ""),
        ],
    );
    let mut by_reason: BTreeMap<_, Vec<_>> = BTreeMap::new();
    for area in &floor.unreachable {
        by_reason.entry(area.reason).or_default().push(area);
    }
    for (reason, areas) in by_reason {
        let largest = areas[0];
        table.row(vec![
            reason.plainly().into(),
            areas.len().to_string().into(),
            format!("{:.3}", areas.iter().map(|area| area.area_m2).sum::<f64>()).into(),
            format!("{}, {}: {}", number(largest.at.x, 2), number(largest.at.y, 2), largest.why()).into(),
        ]);
    }
    let slivers = &floor.unreachable_slivers;
    table.row(vec![
        "each smaller than 0.01 m²".into(),
        slivers.count.to_string().into(),
        format!("{:.3}", slivers.area_m2).into(),
        slivers.why().into(),
    ]);
    table
}

/// The critical zone: unrolled, its longest arcs, and plate by plate.
pub(super) fn zone(document: &Document) -> Vec<Block> {
    let zone = &document.floor.critical_zone;
    let state = if zone.done { "Done" } else { "Not done" };
    let scanned = zone.scanned.map_or_else(|| "none".to_owned(), |share| format!("{} %", per_cent(share)));
    let mut blocks = vec![
        Block::Text(format!(
            "{state}: the full width of {:.0} mm was scanned along {:.1} of {:.1} m of shell, {scanned} of the area of the zone. The zone is \
             done when its full width is scanned along 99.5 % of the shell.",
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
        format!("{which} arcs of 0.1 m and more that are not done (arcs less than 0.1 m apart count as one)"),
        &[
            ("From x, y", "m", "r nw"),
            ("To x, y", "m", "r nw"),
            ("Along the shell", "m", "r nw"),
            ("Not done", "m", "r"),
            ("Scanned from", "mm off the shell, median", "r"),
            ("At worst", "mm", "r"),
        ],
    );
    let place = |p: world::Point| format!("{}, {}", number(p.x, 2), number(p.y, 2));
    let width_m = zone.width_m;
    let mm =
        |m: f64| if m >= width_m - 1e-9 { "whole width".to_owned() } else { format!("{:.0}", 1000.0 * m) };
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

/// Accuracy and guaranteed coverage.
pub(super) fn accuracy(document: &Document) -> Vec<Block> {
    let pictures = &document.pictures;
    let mut table = Table::new(
        "Accuracy statement",
        &[
            ("Position", "", ""),
            ("Mean", "cm", "r"),
            ("p95", "cm", "r"),
            ("Worst", "cm", "r"),
            ("Method", "", ""),
        ],
    );
    for run in &document.runs {
        let of = if document.runs.len() > 1 { format!(", {}", run.run) } else { String::new() };
        if let Some(a) = &run.accuracy {
            let stations = a.stations_mean.zip(a.stations_min).map(|(mean, least)| {
                format!("; {} fixes from {mean:.1} stations on average, {least} at least", a.fixes)
            });
            let how = format!(
                "covariance of every tick; limit {} cm, above it on {} % of the way{}",
                number(100.0 * a.limit_m, 0),
                per_cent(a.over_limit),
                stations.unwrap_or_default()
            );
            table.row(vec![
                format!("95 % error{of}").into(),
                cm(a.mean_m).into(),
                cm(a.p95_m).into(),
                cm(a.max_m).into(),
                how.into(),
            ]);
        }
        if let Some(p) = &run.positioning {
            let how = format!(
                "simulation only; truth within the 95 % ellipse in {} % of the ticks; lost for {:.1} s",
                per_cent(p.in_95_ellipse),
                p.position_lost_s
            );
            table.row(vec![
                format!("true error{of}").into(),
                cm(p.mean_error_m).into(),
                cm(p.p95_m).into(),
                cm(p.max_m).into(),
                how.into(),
            ]);
        }
    }
    let truth = document.coverage.by_truth.and_then(|truth| truth.scanned_truly.zip(truth.guaranteed_truly));
    let truth = truth.map(|(scanned, sure)| {
        Block::Text(format!(
            "{} % of the floor reported as scanned was actually scanned, {} % of the floor reported as guaranteed (simulation only).",
            per_cent(scanned),
            per_cent(sure)
        ))
    });
    let mut blocks = vec![
        Block::Text(
            "The 95 % error is the longer half axis of the 95 % ellipse of the estimated position (2.45 standard deviations). A cell is \
             guaranteed if it was scanned and lay, in one pass, under the tool narrowed on each side by 2.45 standard deviations across \
             the heading: then it was under the tool wherever the robot stood within the ellipse. Neighbouring passes are not added \
             together."
                .into(),
        ),
        Block::Pair(vec![picture(&pictures.accuracy), picture(&pictures.guaranteed)]),
        Block::Table(table),
    ];
    blocks.extend(truth);
    blocks
}

/// Every plate.
pub(super) fn plates(document: &Document) -> Vec<Block> {
    let floor = &document.floor;
    if floor.plates.is_empty() {
        let waiver = Value::fact(document.inspection.plates_waiver.as_ref(), "plates_waiver");
        return vec![
            Block::Text("The scenario has no layout of the plates ([plates]), so nothing can be stated plate by plate.".into()),
            Block::Facts(vec![("Waiver", waiver)]),
        ];
    }
    let worst =
        floor.plates.iter().map(|plate| 1.0 - plate.shares.guaranteed.unwrap_or(0.0)).fold(0.0, f64::max);
    let top = [0.02, 0.05, 0.1, 0.2, 0.5].into_iter().find(|top| worst <= *top).unwrap_or(1.0);
    let mut table = Table::new(
        format!(
            "Every plate ({}); scanned, missed, unreachable and margin sum to 100.0 % of the plate; bar: not guaranteed, 0 to {} %",
            floor.plates.len(),
            number(100.0 * top, 0)
        ),
        &[
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
        ],
    );
    let tenth = |value: f64| Value::from(format!("{value:.1}"));
    let mut add = |name: &str, kind: &str, shares: &crate::account::Shares, error: Option<f64>, bar: bool| {
        let p = &shares.percent;
        let numbers: Vec<String> = (1..)
            .zip(&floor.missed)
            .filter(|(_, area)| area.plates.iter().any(|plate| plate == name))
            .map(|(no, _): (usize, _)| no.to_string())
            .collect();
        let more = if numbers.len() > 6 { format!(" +{}", numbers.len() - 6) } else { String::new() };
        let found = document.indications.iter().filter(|found| found.plate.as_deref() == Some(name)).count();
        let row: &mut Row = table.row(vec![
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
            format!("{}{more}", numbers.iter().take(6).cloned().collect::<Vec<_>>().join(", ")).into(),
            if bar { found.to_string() } else { document.indications.len().to_string() }.into(),
        ]);
        if bar {
            row.cells[8].svg = plate_bar(shares, top);
        } else {
            row.class = "sum";
        }
    };
    for plate in &floor.plates {
        add(&plate.name, &format!("{:?}", plate.kind).to_lowercase(), &plate.shares, plate.error_p95_m, true);
    }
    add("Whole floor", "", &floor.whole, None, false);
    vec![Block::Legend(plate_legend()), Block::Table(table)]
}
