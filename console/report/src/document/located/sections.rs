//! The sections of a report on located readings. They keep the section numbers of a mission report, so that
//! references stay valid.

use super::super::{
    model::Document,
    page::{Block, Section, Table, Value, picture, section},
    readings::Located,
    run_part::{calibrations, is_pulse_tested, is_sound_known, rule, survey_warnings},
    sections::{closing, floor, runs},
    words::{cm, number},
};
use crate::human::text::counted;
use account::clock;

const NOT_KNOWN: &str = "The readings do not show when the tool was on (column tool_on, or --tool-on FILE \
    of tankops locate), so this report makes no statement about scanned floor.";

/// Returns all sections.
pub(in crate::document) fn sections(document: &Document, located: &Located) -> [Section; 12] {
    [
        section("Scope", scope(document, located)),
        Section { is_new_sheet: true, ..section("Map of the located track", map(document)) },
        section("Floor under the tool", under_tool(document, located)),
        section("Critical zone along the shell", zone(document, located)),
        section("Position accuracy", accuracy(document, located)),
        section("Plates", plates(document, located)),
        section("Track and record", runs::runs(document)),
        section("Equipment and calibration", closing::equipment(document)),
        section("Limitations", limitations(document)),
        section("Gate before signing", closing::gate(document)),
        section("Signatures and revisions", closing::signatures(document)),
        section("Provenance", closing::provenance(document)),
    ]
}

fn scope(document: &Document, located: &Located) -> Vec<Block> {
    let floor = &document.floor;
    vec![
        Block::Text(format!(
            "Scenario {}: {}. Duration: {}. Tool: swath {} m. Cell size: {} cm.",
            document.scenario,
            super::gate::scope(located),
            clock(located.time_s),
            floor.swath_m,
            number(100.0 * floor.cell_m, 1)
        )),
        Block::Heading("Definitions".into()),
        Block::Words(vec![
            (
                "Located",
                "the position was computed from ranges to the stations and from the motion, where that was \
                measured"
                    .into(),
            ),
            ("95 % error", "the longer semi-axis of the 95 % ellipse of the estimated position".into()),
            (
                "Whole floor",
                "all floor within the shell, excluding the footprint of obstacles on the drawing".into(),
            ),
            (
                "Scanned",
                format!(
                    "the tool was on and passed over the centre of the cell while the 95 % position error \
                     was at most {} m. Between two readings, this counts only where the robot cannot have \
                     strayed from the straight line by more than that error",
                    floor.position_limit_m
                ),
            ),
            ("Guaranteed", rule(document).definition().into()),
        ]),
    ]
}

fn map(document: &Document) -> Vec<Block> {
    vec![Block::Wide(picture(&document.pictures.coverage))]
}

fn under_tool(document: &Document, located: &Located) -> Vec<Block> {
    let Some(on_s) = located.tool_on_s else { return vec![Block::Text(NOT_KNOWN.into())] };
    let whole = &document.floor.whole;
    vec![Block::Text(format!(
        "The tool was on for {} of {}. During that time, while the position was known, it passed over \
         {:.2} of {:.2} m² of floor ({:.1} %). No scan of the remaining floor was planned, so no floor counts as missed and no \
         reasons are given.",
        clock(on_s),
        clock(located.time_s),
        whole.scanned * whole.area_m2,
        whole.area_m2,
        whole.percent.scanned
    ))]
}

fn zone(document: &Document, located: &Located) -> Vec<Block> {
    match located.tool_on_s {
        Some(_) => floor::zone(document),
        None => vec![Block::Text(NOT_KNOWN.into())],
    }
}

fn accuracy(document: &Document, located: &Located) -> Vec<Block> {
    let mut blocks = vec![Block::Table(floor::accuracy_statement(document))];
    blocks.extend(survey_warnings(document).chain(calibrations(document)).map(Block::Text));
    if located.tool_on_s.is_some() {
        let pictures = &document.pictures;
        blocks.push(Block::Pair(vec![picture(&pictures.accuracy), picture(&pictures.guaranteed)]));
    }
    blocks
}

fn plates(document: &Document, located: &Located) -> Vec<Block> {
    let floor = &document.floor;
    if floor.plates.is_empty() {
        return floor::plates(document);
    }
    let mut table = Table::new(
        format!("Every plate ({})", floor.plates.len()),
        &[
            ("Plate", "", "nw"),
            ("Kind", "", ""),
            ("Area", "m²", "r"),
            ("Scanned", "%", "r"),
            ("Guaranteed", "%", "r"),
            ("95 % error", "p95, cm", "r"),
            ("Indic.", "", "r"),
        ],
    );
    let none = || Value::from("\u{2013}");
    let known = |value: f64| located.tool_on_s.map_or_else(none, |_| format!("{value:.1}").into());
    for plate in &floor.plates {
        let p = &plate.shares.percent;
        let found = document.indications.iter().filter(|found| found.plate.as_ref() == Some(&plate.name));
        table.row(vec![
            plate.name.clone().into(),
            plate.kind.to_string().into(),
            format!("{:.2}", plate.shares.area_m2).into(),
            known(p.scanned),
            known(p.guaranteed.unwrap_or(0.0)),
            plate.error_p95_m.map_or_else(none, |m| cm(m).into()),
            found.count().to_string().into(),
        ]);
    }
    let note = match located.tool_on_s {
        Some(_) => "Scanned: passed over by the tool while it was on and the position was known.",
        None => NOT_KNOWN,
    };
    vec![Block::Table(table), Block::Note(note.into())]
}

fn limitations(document: &Document) -> Vec<Block> {
    let has_truth = document.runs.iter().any(|run| run.positioning.is_some());
    let runs = counted(document.runs.len() as u64, "run");
    let mut items = vec![
        format!(
            "The positions in {runs} were computed from readings that other equipment recorded. This \
            program neither controlled nor observed the robot."
        ),
        if is_pulse_tested(document) {
            "The readings are used as they were exported: the clock of the readings and the state of the tool were not \
             checked. Pulses between the stations checked their survey and their clocks (section 8)."
        } else {
            "The readings are used as they were exported: the clock, the stations and the state of the tool \
             were not checked."
        }
        .to_owned(),
        "Only obstacles on the drawing are shown.".to_owned(),
        "\u{201c}Scanned\u{201d} does not mean that a defect would have been detected; that depends on the \
         instrument, its calibration and the surface."
            .to_owned(),
        format!(
            "The 95 % error is computed from the covariance; it does not include errors in the station survey,{} or in \
             the tool's offset on the robot.",
            if is_sound_known(document) { "" } else { " in the speed of sound," }
        ),
        "Nothing here replaces the inspector's own assessment of completeness under the applicable code."
            .to_owned(),
    ];
    items.extend(survey_warnings(document));
    if has_truth {
        items.push(
            "The readings contain true positions. If these come from a simulator, so do the readings."
                .to_owned(),
        );
    }
    let code = Value::fact(document.inspection.code.as_ref(), "code");
    vec![Block::List(items), Block::Facts(vec![("Code and edition", code)])]
}
