//! The section on missed and unreachable floor.

use super::super::{
    model::Document,
    page::{Block, Cell, Table, Value},
    words::number,
};
use crate::human::text::counted;
use account::{Area, Cause, MissReason, OutOfReach};
use std::collections::{BTreeMap, BTreeSet};

/// Number of missed areas above which small ones are listed in short form.
const MOST_ROWS: usize = 40;
/// Area, square metres, below which a missed area is small.
const SMALL_M2: f64 = 0.05;

/// Lists missed areas and unreachable floor.
pub(super) fn missed(document: &Document) -> Vec<Block> {
    let floor = &document.floor;
    let mut blocks = vec![Block::Text(
        "Cells that touch form one area, even across plates. Each reason is given with its value. If an \
         area has several causes, each cause is given with its part of the area."
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
    let (listed, small) = floor.missed.split_at(listed_one_by_one(&floor.missed));
    for (no, area) in (1..).zip(listed) {
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
    let areas_m2: f64 = floor.missed.iter().map(|area| area.area_m2).sum();
    let total = format!(
        "All missed floor: {missed_m2:.3} m²; {}: {areas_m2:.3} m²; {} smaller than 0.01 m² each: {:.3} m²{}.",
        counted(floor.missed.len() as u64, "area"),
        floor.slivers.count,
        floor.slivers.area_m2,
        if floor.slivers.count > 0 { format!(", {}", floor.slivers.why()) } else { String::new() }
    );
    let others = floor.requested.as_ref().map(|requested| {
        let requested_m2 = requested.missed * requested.area_m2;
        Block::Note(format!(
            "Of this floor, {requested_m2:.3} m² was requested. The other {:.3} m² was not requested, so the mission did \
             not have to scan it.",
            missed_m2 - requested_m2
        ))
    });
    let is_some = !table.rows.is_empty();
    blocks.extend(is_some.then_some(Block::Table(table)));
    blocks.extend(shortly(small, listed.len() + 1));
    blocks.push(Block::Note(total));
    blocks.extend(others);
    blocks.push(Block::Table(unreachable(document)));
    blocks.push(Block::Note(balance(document)));
    blocks
}

/// The number of missed areas, counted from the largest, that have a table row of their own: all of them or, if there
/// are many, only those that are not small.
fn listed_one_by_one(missed: &[Area<MissReason>]) -> usize {
    if missed.len() > MOST_ROWS {
        missed.partition_point(|area| area.area_m2 >= SMALL_M2)
    } else {
        missed.len()
    }
}

/// Small areas in short form: a letter for each reason, with its value. `first` is the number of the first small area.
fn shortly(areas: &[Area<MissReason>], first: usize) -> Vec<Block> {
    let reasons: BTreeSet<MissReason> =
        areas.iter().flat_map(|area| &area.causes).map(|cause| cause.reason).collect();
    let letters: BTreeMap<MissReason, char> = reasons.into_iter().zip('a'..).collect();
    if letters.is_empty() {
        return Vec::new();
    }
    let cause = |cause: &Cause<MissReason>| {
        let value = cause.measure.as_ref().map(|measure| format!(" {}", measure.range())).unwrap_or_default();
        format!("{}{value}", letters[&cause.reason])
    };
    let entry = |(no, area): (usize, &Area<MissReason>)| {
        let causes = area.causes.iter().map(cause).collect::<Vec<_>>().join(", ");
        let (x, y) = (number(area.at.x, 2), number(area.at.y, 2));
        // A no-break space keeps a number and its unit on one line.
        (no, format!("{x}, {y} m; {:.3} m²; {causes}", area.area_m2).replace(" m", "\u{a0}m"))
    };
    let key = letters.iter().map(|(reason, letter)| format!("{letter}: {}", reason.plainly()));
    vec![
        Block::Heading(format!("Missed areas under {SMALL_M2} m²")),
        Block::Text(format!(
            "Number, position and area, then the letter and the value of each reason. {}. The CSV and JSON \
             files contain the reasons in full.",
            key.collect::<Vec<_>>().join("; ")
        )),
        Block::Columns((first..).zip(areas).map(entry).collect()),
    ]
}

/// Explains the difference between the whole floor and the reachable floor.
fn balance(document: &Document) -> String {
    let (whole, reachable) = (&document.floor.whole, &document.floor.reachable);
    let thousandths = |m2: f64| (1000.0 * m2).round();
    let all = thousandths(whole.area_m2 - reachable.area_m2);
    let [unreachable, margin, untestable] =
        [whole.unreachable, whole.margin, whole.untestable].map(|share| thousandths(share * whole.area_m2));
    // The remainder of the printed figures, so that the sum is exact to the last digit.
    let scanned = all - unreachable - margin - untestable;
    let [all, unreachable, margin, untestable, scanned] =
        [all, unreachable, margin, untestable, scanned].map(|m2| m2 / 1000.0);
    let welds = format!(" + {untestable:.3} m² not testable by this tool");
    let beyond = format!(
        " + {scanned:.3} m² scanned although not counted as reachable: there the robot came closer to the \
         shell or to an obstacle than hull and clearance allow, or the floor was reachable until an \
         obstacle was found"
    );
    format!(
        "Whole floor minus reachable floor: {all:.3} m² = {unreachable:.3} m² unreachable + {margin:.3} m² shell margin{}{}.",
        if untestable > 0.0 { welds } else { String::new() },
        if scanned > 0.0 { beyond } else { String::new() }
    )
}

fn plates_of(area: &Area<MissReason>) -> String {
    let more = area.plates.len().saturating_sub(2);
    let names = area.plates.iter().take(2).cloned().collect::<Vec<_>>().join(", ");
    if more > 0 { format!("{names} +{more}") } else { names }
}

/// The no-go zone that contains most of an area.
fn zone_of(area: &Area<OutOfReach>) -> Option<&str> {
    let cause = area.causes.first().filter(|cause| cause.reason == OutOfReach::NoGo)?;
    cause.measure.as_ref()?.near.as_deref()
}

fn unreachable(document: &Document) -> Table {
    let floor = &document.floor;
    let mut table = Table::new(
        "Unreachable floor",
        &[
            ("Reason", "", ""),
            ("Areas", "", "r"),
            ("Area", "m²", "r"),
            ("Largest area: position in m, reason", "", ""),
        ],
    );
    let mut by_reason: BTreeMap<_, Vec<_>> = BTreeMap::new();
    for area in &floor.unreachable {
        by_reason.entry((area.reason, zone_of(area))).or_default().push(area);
    }
    for ((reason, zone), areas) in by_reason {
        let largest = areas[0];
        let in_zone = zone.map(|zone| format!("in {zone}"));
        table.row(vec![
            in_zone.unwrap_or_else(|| reason.plainly().to_owned()).into(),
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
