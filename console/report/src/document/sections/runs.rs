//! The section on each run: track, tether, chart, incidents, indications.

use super::super::{
    charts::is_marked,
    model::Document,
    page::{Block, Table, Value, picture},
    run_part::{RunPart, TetherPart},
    words::number,
};
use crate::human::text::counted;
use account::clock;
use mission::Severity;
use world::coverage::percent_text;

/// Maximum number of incidents listed for a run; plans and orders are omitted first.
const MOST_INCIDENTS: usize = 120;

/// All runs, then the indications.
pub(in crate::document) fn runs(document: &Document) -> Vec<Block> {
    let mut blocks = Vec::new();
    for ((number, run), figures) in (1..).zip(&document.runs).zip(&document.pictures.runs) {
        let number: usize = number;
        if document.runs.len() > 1 {
            blocks.push(Block::Heading(format!("Run {number}: {}", run.run)));
        }
        let way = run.path_length_m.map(|m| format!(", path {m:.1} m")).unwrap_or_default();
        let collisions = run.collisions.map(|n| format!(", {}", counted(n, "collision"))).unwrap_or_default();
        blocks.push(Block::Text(format!(
            "Duration {}{way}{}{collisions}.",
            clock(run.mission_time_s),
            clearance(run)
        )));
        blocks.extend(
            run.pre_flight.as_ref().map(|checks| Block::Text(format!("Before the start: {checks}."))),
        );
        let [track, tether, over_time] = figures;
        blocks.push(Block::Pair(track.iter().chain(tether).map(picture).collect()));
        blocks.extend(run.tether.as_ref().map(|tether| Block::Table(tether_table(tether))));
        blocks.extend(over_time.as_ref().map(|figure| Block::Wide(picture(figure))));
        blocks.extend(incidents(document, run));
    }
    blocks.extend(indications(document));
    blocks
}

/// The minimum clearance, flagged if it is below the required one.
fn clearance(run: &RunPart) -> String {
    let (Some(least_m), limit_m) = (run.clearance_min_m, run.clearance_m) else { return String::new() };
    let flag = if least_m < limit_m { "BELOW the required" } else { "required:" };
    format!(", minimum clearance {least_m:.3} m ({flag} {limit_m:.3} m)")
}

fn tether_table(tether: &TetherPart) -> Table {
    let mut table = Table::new(
        "Tether record",
        &[
            ("Tether", "", ""),
            ("Record", "estimated", "r"),
            ("When", "h:m:s", "r"),
            ("Limit", "", "r"),
            ("Share", "of the limit", "r"),
            ("Truth", "simulation only", "r"),
        ],
    );
    let truth = tether.truth;
    let mut row =
        |name: &str, value: f64, at_s: Option<f64>, limit: Option<f64>, unit: &str, truth: Option<f64>| {
            let decimals = usize::from(unit != "°");
            let text = |value: f64| format!("{}{unit}", number(value, decimals));
            let share = limit.map(|limit| {
                if value > limit { "over".into() } else { format!("{} %", percent_text(value / limit, 0)) }
            });
            table.row(vec![
                name.into(),
                text(value).into(),
                at_s.map(clock).unwrap_or_default().into(),
                limit.map(text).unwrap_or_default().into(),
                share.unwrap_or_default().into(),
                truth.map(text).unwrap_or_default().into(),
            ]);
        };
    let degrees = f64::to_degrees;
    row(
        "Greatest length paid out",
        tether.length_max_m,
        Some(tether.length_max_at_s),
        Some(tether.reel_length_m),
        " m",
        truth.map(|truth| truth.tether_length_max_m),
    );
    row(
        "Largest wrap on one obstacle",
        degrees(tether.wrap_max_rad),
        None,
        Some(degrees(tether.wrap_limit_rad)),
        "°",
        truth.map(|truth| degrees(truth.wrap_max_rad)),
    );
    row(
        "Total wrap",
        degrees(tether.wrap_total_max_rad),
        Some(tether.wrap_total_max_at_s),
        Some(degrees(tether.wrap_total_limit_rad)),
        "°",
        truth.map(|truth| degrees(truth.wrap_total_max_rad)),
    );
    row(
        "Length paid out at the end",
        tether.end_length_m,
        None,
        None,
        " m",
        truth.map(|truth| truth.end_length_m),
    );
    if let Some(pull) = tether.pull {
        row("Largest pull to reel in", pull.max_n, Some(pull.max_at_s), Some(pull.reel_n), " N", None);
    }
    if let Some(off_m) = tether.reel_off_max_m {
        row("Largest difference between reel and map", off_m, None, None, " m", None);
    }
    if tether.pull.is_none() {
        let cells = ["Largest pull to reel in", "not checked", "", "", "", ""];
        table.row(cells.map(Into::into).to_vec());
    }
    if let Some(own_gap) = tether.own_gap {
        let cells =
            ["Least gap between hull and own taut tether, planned way in".into(), own_gap.text().into()];
        table.row(cells.into_iter().chain((0..4).map(|_| "".into())).collect());
    }
    let pull = format!("×{:.2}", tether.pull_factor_max);
    let name = format!("Largest capstan factor (friction {})", tether.friction);
    table.row(vec![name.into(), pull.into(), "".into(), "".into(), "".into(), "".into()]);
    let snags = truth.map_or(0, |truth| truth.snags);
    table.row(vec!["Snags".into(), snags.to_string().into(), "".into(), "".into(), "".into(), "".into()]);
    if let Some(at_s) = truth.and_then(|truth| truth.broken_at_s) {
        let name = "Tether found broken";
        table.row(vec![name.into(), "".into(), clock(at_s).into(), "".into(), "".into(), "".into()]);
    }
    if truth.is_some_and(|truth| truth.torn_at_end && truth.broken_at_s.is_none()) {
        let name = "Tether truly torn when the run ended";
        table.row(vec![name.into(), "".into(), "".into(), "".into(), "".into(), "yes".into()]);
    }
    if let Some(times) = truth.and_then(|truth| truth.over_own) {
        let name = "Times that the hull came over its own tether";
        table.row(vec![name.into(), "".into(), "".into(), "".into(), "".into(), times.to_string().into()]);
    }
    table
}

fn incidents(document: &Document, run: &RunPart) -> Option<Block> {
    let mut table = Table::new(
        "Alarms, holds, faults, obstacles, drawn zones, plans and stations",
        &[
            ("Time", "h:m:s", "r nw"),
            ("No.", "on the chart", "c"),
            ("What", "", ""),
            ("Detail", "", ""),
            ("Until", "h:m:s", "r nw"),
            ("Reviewed by", "", "nw"),
        ],
    );
    let is_many = run.incidents.len() > MOST_INCIDENTS;
    let is_listed = |severity: Severity, is_marked: bool| !is_many || is_marked || severity > Severity::Watch;
    let mut left_out = 0;
    for (index, incident) in run.incidents.iter().enumerate() {
        let mark = is_marked(incident);
        if !is_listed(incident.severity, mark) {
            left_out += 1;
            continue;
        }
        let until = match incident.until_s {
            Some(until_s) => clock(until_s),
            None if matches!(incident.kind, "alarm" | "hold") => "to the end".into(),
            None => String::new(),
        };
        let reviewed = if incident.needs_review() {
            Value::fact(document.inspection.events_reviewed_by.as_ref(), "events_reviewed_by")
        } else {
            Value::default()
        };
        table.row(vec![
            clock(incident.t_s).into(),
            if mark { (index + 1).to_string() } else { String::new() }.into(),
            incident.kind.into(),
            incident.text.clone().into(),
            until.into(),
            reviewed,
        ]);
    }
    if left_out > 0 {
        let caption = format!("{}; minor entries omitted: {left_out}", table.caption);
        table.caption = caption;
    }
    (!table.rows.is_empty()).then_some(Block::Table(table))
}

fn indications(document: &Document) -> Vec<Block> {
    let stated = Value::fact(document.inspection.indications.as_ref(), "indications");
    if document.indications.is_empty() {
        return vec![Block::Heading("Indications".into()), Block::Facts(vec![("Statement", stated)])];
    }
    let mut table = Table::new(
        "Indications from the instrument, placed on the track by time, or at the position given by the \
         instrument",
        &[
            ("No.", "", "r"),
            (if document.runs.len() > 1 { "Run" } else { "" }, "", "c"),
            ("Time", "h:m:s", "r nw"),
            ("x", "m", "r nw"),
            ("y", "m", "r nw"),
            ("±", "m, 95 %", "r nw"),
            ("Plate", "", "nw"),
            ("Kind", "", ""),
            ("Size", "mm", "r"),
            ("Depth", "mm", "r"),
            ("Note", "", ""),
        ],
    );
    let optional = |value: Option<f64>| value.map_or_else(|| "\u{2013}".to_owned(), |value| number(value, 1));
    let run_of = |name: &str| {
        let number =
            document.runs.iter().position(|run| run.run == name).map(|index| (index + 1).to_string());
        number.filter(|_| document.runs.len() > 1).unwrap_or_default()
    };
    for found in &document.indications {
        table.row(vec![
            format!("I{}", found.number).into(),
            found.run.as_deref().map(run_of).unwrap_or_default().into(),
            found.t_s.map_or_else(|| "\u{2013}".to_owned(), clock).into(),
            number(found.at.x, 2).into(),
            number(found.at.y, 2).into(),
            found.error_m.map_or_else(|| "\u{2013}".to_owned(), |m| number(m, 2)).into(),
            found.plate.clone().unwrap_or_default().into(),
            found.kind.clone().into(),
            optional(found.size_mm).into(),
            optional(found.depth_mm).into(),
            found.note.clone().into(),
        ]);
    }
    vec![Block::Heading("Indications".into()), Block::Table(table)]
}
