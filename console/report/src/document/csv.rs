//! The report as tables for spreadsheets.

use super::{model::Document, survey::on_map, thickness::Thickness};
use crate::{geojson::rounded, past_run::PastRun};
use account::{Shares, ZoneArc};
use csv::Writer;
use world::Shape;

/// Suffixes of the file names: each table has the name of the first table with its own suffix.
pub const SUFFIXES: [&str; 7] =
    ["", "-missed", "-zone", "-obstacles", "-indications", "-track", "-follow-up"];

/// Writes the tables in the order of [`SUFFIXES`]: plates with the whole and the reachable floor, missed areas, arcs
/// of the critical zone that are not done, obstacles found, indications, and the track of every run with its 95 %
/// error.
pub fn tables(document: &Document, past: &[PastRun]) -> [String; SUFFIXES.len()] {
    [
        plates(document),
        missed(document),
        zone(document),
        obstacles(past),
        indications(document),
        track(past),
        follow_ups(document),
    ]
}

/// Writes rows under a header; writing to memory cannot fail.
pub(super) fn table(head: &[&str], rows: impl IntoIterator<Item = Vec<String>>) -> String {
    let mut writer = Writer::from_writer(Vec::new());
    let _ = writer.write_record(head);
    for row in rows {
        let _ = writer.write_record(row.into_iter().map(|text| cell(&text)));
    }
    String::from_utf8(writer.into_inner().unwrap_or_default()).unwrap_or_default()
}

/// A cell in plain characters that no spreadsheet evaluates: text that begins like a formula gets a leading
/// apostrophe.
pub fn cell(text: &str) -> String {
    let cell = foreign::plain_lines(text);
    let is_formula =
        cell.starts_with(['=', '+', '-', '@', '|', '%', '\t', '\r']) && cell.parse::<f64>().is_err();
    if is_formula { format!("'{cell}") } else { cell.into_owned() }
}

fn plates(document: &Document) -> String {
    if let Some(task) = &document.task {
        let row = |(name, value): (&str, f64)| vec![name.to_owned(), rounded(value).to_string()];
        return table(&["figure", "value"], task.figures(document.runs.last()).into_iter().map(row));
    }
    let floor = &document.floor;
    let is_located = document.located.is_some();
    let is_known = document.located.as_ref().is_none_or(|located| located.tool_on_s.is_some());
    let has_untestable = floor.whole.untestable > 0.0;
    let row = |name: &str, kind: &str, shares: &Shares, error_m: Option<f64>| {
        let p = &shares.percent;
        let mut row = vec![name.to_owned(), kind.to_owned(), format!("{:.4}", shares.area_m2)];
        let guaranteed = p.guaranteed.unwrap_or(0.0);
        let of_mission = [p.missed, p.unreachable, p.margin].map(|value| (value, !is_located));
        let of_tool = [p.scanned, guaranteed].map(|value| (value, is_known));
        // An unknown value is an empty cell, not zero.
        let cell =
            |(value, is_stated): (f64, bool)| if is_stated { format!("{value:.1}") } else { String::new() };
        row.extend(of_tool.into_iter().chain(of_mission).map(cell));
        row.push(error_m.map(|m| format!("{m:.3}")).unwrap_or_default());
        row.extend(has_untestable.then(|| format!("{:.1}", p.untestable)));
        row.extend(document.thickness.iter().flat_map(|thickness| of_thickness(thickness, name)));
        row
    };
    let bases = [("whole floor", &floor.whole), ("reachable floor", &floor.reachable)];
    let bases = bases
        .into_iter()
        .take(if is_located { 1 } else { 2 })
        .map(|(name, shares)| row(name, "base", shares, None));
    let plates = floor
        .plates
        .iter()
        .map(|plate| row(&plate.name, &plate.kind.to_string(), &plate.shares, plate.error_p95_m));
    let mut head = vec![
        "floor",
        "kind",
        "area_m2",
        "scanned_percent",
        "guaranteed_percent",
        "missed_percent",
        "unreachable_percent",
        "margin_percent",
        "error_p95_m",
    ];
    head.extend(has_untestable.then_some("untestable_percent"));
    if document.thickness.is_some() {
        head.extend(["readings", "thickness_least_mm", "thickness_p5_mm", "thickness_mean_mm"]);
    }
    table(&head, bases.into_iter().chain(plates))
}

/// The thickness of a plate; empty cells for a floor that is not a plate, and for a plate without readings.
fn of_thickness(thickness: &Thickness, name: &str) -> [String; 4] {
    let plate = thickness.plates.iter().find(|plate| plate.plate == name);
    plate.map_or_else(Default::default, |plate| {
        let [least, p5, mean] = [plate.least_mm, plate.p5_mm, plate.mean_mm].map(|mm| format!("{mm:.2}"));
        [plate.readings.to_string(), least, p5, mean]
    })
}

fn missed(document: &Document) -> String {
    let rows = (1..).zip(&document.floor.missed).map(|(number, area): (usize, _)| {
        let mut row = vec![number.to_string()];
        let places = [area.at, area.low, area.high];
        row.extend(places.iter().flat_map(|place| [place.x, place.y]).map(|m| format!("{m:.3}")));
        row.extend([format!("{:.4}", area.area_m2), area.plates.join(" "), area.why()]);
        row
    });
    let small = Some(&document.floor.slivers).filter(|slivers| slivers.count > 0).map(|slivers| {
        let mut row = vec![format!("{} smaller areas", slivers.count)];
        row.extend(std::iter::repeat_n(String::new(), 6));
        row.extend([format!("{:.4}", slivers.area_m2), String::new(), slivers.why()]);
        row
    });
    let rows = rows.chain(small);
    let head =
        ["number", "x_m", "y_m", "west_m", "south_m", "east_m", "north_m", "area_m2", "plates", "reason"];
    table(&head, rows)
}

fn zone(document: &Document) -> String {
    let row = |arc: &ZoneArc| {
        let values = [arc.from.x, arc.from.y, arc.to.x, arc.to.y, arc.from_m, arc.to_m];
        let gaps = [arc.not_done_m, arc.gap_m, arc.gap_max_m];
        values.iter().chain(&gaps).map(|m| format!("{m:.3}")).collect()
    };
    let head = [
        "from_x_m",
        "from_y_m",
        "to_x_m",
        "to_y_m",
        "from_m",
        "to_m",
        "not_done_m",
        "gap_median_m",
        "gap_max_m",
    ];
    table(&head, document.floor.critical_zone.arcs.iter().map(row))
}

/// The obstacles that were found; for a survey, those on its map, with the 95 % errors of the columns.
fn obstacles(past: &[PastRun]) -> String {
    let run = past.last().map_or("", |past| past.name.as_str());
    if let Some(objects) = on_map(past) {
        let rows = objects.into_iter().map(|object| {
            let errors =
                object.errors_95_m.map(|errors| errors.map(|m| format!("{m:.3}"))).unwrap_or_default();
            obstacle(run, &object.name, &object.shape).into_iter().chain(errors).collect()
        });
        let more = ["center_95_m", "radius_95_m"];
        return table(&[&OBSTACLE[..], &more[..]].concat(), rows);
    }
    let rows = past
        .iter()
        .flat_map(|past| past.fold.found().map(|solid| obstacle(&past.name, &solid.name, &solid.shape)));
    table(&OBSTACLE, rows)
}

/// The columns of the table of obstacles.
const OBSTACLE: [&str; 6] = ["run", "name", "x_m", "y_m", "extent_x_m", "extent_y_m"];

fn obstacle(run: &str, name: &str, shape: &Shape) -> Vec<String> {
    let ((low, high), center) = (shape.bounds(), shape.center());
    let values = [center.x, center.y, high.x - low.x, high.y - low.y].map(|m| format!("{m:.3}"));
    [run.to_owned(), name.to_owned()].into_iter().chain(values).collect()
}

fn indications(document: &Document) -> String {
    let optional = |value: Option<f64>| value.map(|value| rounded(value).to_string()).unwrap_or_default();
    let fixed = |value: Option<f64>, decimals: usize| {
        value.map(|value| format!("{value:.decimals$}")).unwrap_or_default()
    };
    let rows = document.indications.iter().map(|found| {
        vec![
            found.number.to_string(),
            found.run.clone().unwrap_or_default(),
            fixed(found.t_s, 1),
            format!("{:.3}", found.at.x),
            format!("{:.3}", found.at.y),
            fixed(found.error_m, 3),
            found.plate.clone().unwrap_or_default(),
            found.kind.clone(),
            optional(found.size_mm),
            optional(found.depth_mm),
            found.note.clone(),
        ]
    });
    let head =
        ["number", "run", "t_s", "x_m", "y_m", "error_95_m", "plate", "kind", "size_mm", "depth_mm", "note"];
    table(&head, rows)
}

fn follow_ups(document: &Document) -> String {
    let fixed = |value: Option<f64>, decimals: usize| {
        value.map(|value| format!("{value:.decimals$}")).unwrap_or_default()
    };
    let rows = document.follow_ups.iter().map(|place| {
        vec![
            place.number.to_string(),
            place.what.clone(),
            place.plate.clone().unwrap_or_default(),
            format!("{:.3}", place.at.x),
            format!("{:.3}", place.at.y),
            fixed(place.area_m2, 4),
            fixed(place.depth_mm, 2),
        ]
    });
    table(&["number", "what", "plate", "x_m", "y_m", "area_m2", "depth_mm"], rows)
}

fn track(past: &[PastRun]) -> String {
    let rows = past.iter().flat_map(|past| {
        past.record.track.iter().map(|point| {
            vec![
                past.name.clone(),
                format!("{:.1}", point.t_s),
                format!("{:.3}", point.x_m),
                format!("{:.3}", point.y_m),
                format!("{:.4}", point.heading_rad),
                format!("{:.3}", point.error_m),
            ]
        })
    });
    table(&["run", "t_s", "x_m", "y_m", "heading_rad", "error_95_m"], rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_that_a_spreadsheet_would_compute_is_kept_as_a_text() {
        let cells = [
            "|calc",
            "a\u{202e}b\u{9b}",
            "=HYPERLINK(\"http://x\")",
            "@SUM(A1)",
            "+1+2",
            "-1.5",
            "-pit",
            "pit",
            "\tpit",
            "",
        ];
        let kept = [
            "'|calc",
            "a�b�",
            "'=HYPERLINK(\"http://x\")",
            "'@SUM(A1)",
            "'+1+2",
            "-1.5",
            "'-pit",
            "pit",
            "'\tpit",
            "",
        ];
        assert_eq!(cells.map(cell), kept);
    }
}
