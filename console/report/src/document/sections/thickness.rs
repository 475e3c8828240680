//! The thickness of the floor: how it was read, the corrosion map, and each plate.

use super::super::{
    follow_up::FollowUp,
    model::Document,
    page::{Block, Table, Value, picture},
    thickness::Thickness,
    words::{grouped, number},
};
use crate::past_run::ImportedReadings;
use account::{Detection, Detections};

/// Title of the list of places for another method, and the largest number of them in a table.
const FOLLOW_UPS: &str = "Places that need a test with another method, in order of travel: untestable floor by plate, and indications";
const MOST_ROWS: usize = 100;

/// How the thickness was read, the corrosion map, the plates, and the places that need a test with another method;
/// nothing for a report without an instrument.
pub(super) fn thickness(document: &Document) -> Vec<Block> {
    let follow_ups = follow_ups(document);
    let Some(thickness) = &document.thickness else { return follow_ups };
    let mut blocks = vec![
        Block::Heading("Thickness".into()),
        Block::Facts(facts(document, thickness)),
        Block::Wide(picture(&document.pictures.corrosion)),
    ];
    blocks.extend((!thickness.plates.is_empty()).then(|| Block::Table(plates(thickness))));
    blocks.extend(thickness.detections.as_ref().map(|found| Block::Table(detections(thickness, found))));
    blocks.extend(follow_ups);
    blocks
}

fn facts(document: &Document, thickness: &Thickness) -> Vec<(&'static str, Value)> {
    let sampling = &thickness.sampling;
    let how = format!(
        "{}; {} channels, a reading every {} mm, standard deviation of a reading {} mm",
        thickness.kind,
        sampling.channels,
        number(1000.0 * sampling.pitch_m, 0),
        sampling.sigma_mm
    );
    let why = if thickness.imported.is_empty() { "beside welds" } else { "beside welds or outside the scan" };
    let unread = match thickness.unread_m2 {
        0.0 => String::new(),
        m2 => format!("; {} m² scanned without a reading", number(m2, 2)),
    };
    let count = format!(
        "{}, of which {} {why} are not judged; {} m² tested{unread}",
        grouped(thickness.readings),
        grouped(thickness.untestable),
        number(thickness.tested_m2, 2)
    );
    let losses = format!(
        "{} with a loss of at least {} mm ({} % of {} mm)",
        thickness.losses.len(),
        number(sampling.threshold_mm(), 1),
        number(100.0 * sampling.threshold, 0),
        sampling.thickness_mm
    );
    let of_file = |import: &ImportedReadings| {
        let what = format!("{}, SHA-256 {}", import.file, import.file_sha256);
        import.notes.iter().fold(what, |what, note| format!("{what}; {note}"))
    };
    let imported = thickness.imported.iter().map(of_file);
    let digest = |run: &super::super::run_part::RunPart| {
        let sha256 = run.files.readings_sha256.as_deref().unwrap_or("no file");
        if document.runs.len() > 1 { format!("{}: {sha256}", run.run) } else { sha256.to_owned() }
    };
    let digests: Vec<String> = document.runs.iter().map(digest).collect();
    let mut facts = vec![
        ("Instrument", how.into()),
        ("Readings", count.into()),
        ("Indications", losses.into()),
        ("SHA-256 of readings.parquet", digests.join("; ").into()),
    ];
    facts.extend(imported.map(|text| ("Imported from", text.into())));
    facts
}

fn plates(thickness: &Thickness) -> Table {
    let mut table = Table::new(
        "Thickness of each plate where it was tested: the smallest reading, the thickness that 95 % of the cells \
         exceed (mean of the readings in a cell), and the mean of all readings",
        &[
            ("Plate", "", "nw"),
            ("Readings", "", "r"),
            ("Least", "mm", "r"),
            ("p5", "mm", "r"),
            ("Mean", "mm", "r"),
        ],
    );
    table.is_slim = true;
    for plate in &thickness.plates {
        table.row(vec![
            plate.plate.clone().into(),
            grouped(plate.readings).into(),
            number(plate.least_mm, 1).into(),
            number(plate.p5_mm, 1).into(),
            number(plate.mean_mm, 1).into(),
        ]);
    }
    table
}

/// The places that need a test with another method; a long list has columns.
fn follow_ups(document: &Document) -> Vec<Block> {
    let places = &document.follow_ups;
    match places.len() {
        0 => Vec::new(),
        1..=MOST_ROWS => vec![Block::Table(table_of(places))],
        _ => vec![
            Block::Note(format!("{FOLLOW_UPS}. Plate; x, y in m; area or depth")),
            Block::Places(places.iter().map(|place| (place.number, line_of(place))).collect()),
        ],
    }
}

/// A place as one line.
fn line_of(place: &FollowUp) -> String {
    let depth = place.depth_mm.map(|mm| format!("{} mm", number(mm, 1)));
    let size = depth.or_else(|| Some(format!("{} m²", area(place.area_m2?)))).unwrap_or_default();
    let plate = place.plate.as_deref().unwrap_or_default();
    let [x, y] = [place.at.x, place.at.y].map(|m| number(m, 2));
    format!("{}: {plate}; {x}, {y}; {size}", place.what)
}

/// An area in square metres; a small one is not 0.
fn area(m2: f64) -> String {
    if m2 > 0.0 && m2 < 0.005 { "below 0.01".to_owned() } else { number(m2, 2) }
}

fn table_of(places: &[FollowUp]) -> Table {
    let mut table = Table::new(
        FOLLOW_UPS,
        &[
            ("No.", "", "r"),
            ("What", "", ""),
            ("Plate", "", "nw"),
            ("x", "m", "r nw"),
            ("y", "m", "r nw"),
            ("Area", "m²", "r"),
            ("Depth", "mm", "r"),
        ],
    );
    table.is_slim = true;
    let or_dash = |text: Option<String>| text.unwrap_or_else(|| "\u{2013}".to_owned());
    for place in places {
        table.row(vec![
            place.number.to_string().into(),
            place.what.clone().into(),
            place.plate.clone().unwrap_or_default().into(),
            number(place.at.x, 2).into(),
            number(place.at.y, 2).into(),
            or_dash(place.area_m2.map(area)).into(),
            or_dash(place.depth_mm.map(|mm| number(mm, 1))).into(),
        ]);
    }
    table
}

/// In a simulation, the true losses are known.
fn detections(thickness: &Thickness, found: &Detections) -> Table {
    let mut table = Table::new(
        format!(
            "Simulated floor: true losses whose deepest place was tested, and how many of them are in an \
             indication. Indications where no metal is lost: {} ({} per m²)",
            found.false_calls,
            number(found.false_calls as f64 / thickness.tested_m2.max(f64::MIN_POSITIVE), 3)
        ),
        &[("Depth", "% of thickness", "r nw"), ("Losses", "", "r"), ("Found", "", "r"), ("Share", "%", "r")],
    );
    table.is_slim = true;
    for (index, Detection { from, losses, found: hits }) in found.classes.iter().enumerate() {
        let to = found.classes.get(index + 1).map_or(1.0, |next| next.from);
        let share = (*losses > 0).then(|| number(100.0 * *hits as f64 / *losses as f64, 1));
        table.row(vec![
            format!("{:.0} to {:.0}", 100.0 * from, 100.0 * to).into(),
            losses.to_string().into(),
            hits.to_string().into(),
            share.unwrap_or_else(|| "\u{2013}".to_owned()).into(),
        ]);
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_small_area_is_not_shown_as_none() {
        assert_eq!([0.0004, 0.0, 0.006, 1.234].map(area), ["below 0.01", "0.00", "0.01", "1.23"]);
    }
}
