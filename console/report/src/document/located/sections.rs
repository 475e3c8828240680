//! The sections of a report on readings. They have the numbers of those of a mission, so that every reference holds.

use super::{
    super::{
        Document,
        page::{Block, Section, Table, Value},
        sections::{closing, cm, counted, floor, number, picture, runs, section},
    },
    Located,
};
use account::clock;

const NOT_KNOWN: &str = "The readings do not say when the tool was on (column tool_on, or --tool-on FILE of tankops locate), so that \
    nothing is stated about scanned floor.";

/// All of them.
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
            "Scenario {}: {}, over {}. Tool: swath {} m. Cells of {} cm.",
            document.scenario,
            super::scope(located),
            clock(located.time_s),
            floor.swath_m,
            number(100.0 * floor.cell_m, 1)
        )),
        Block::Heading("Definitions".into()),
        Block::Words(vec![
            ("Located", "the position was computed from ranges to the stations, and from the motion if that was measured".into()),
            ("95 % error", "the longer half axis of the 95 % ellipse of the estimated position".into()),
            ("Whole floor", "all floor within the shell, excluding the footprint of obstacles on the drawing".into()),
            (
                "Scanned",
                format!(
                    "the tool was on, the centre of the cell came under it, and its 95 % position error was at most {} m; between two \
                     readings only where the robot cannot have strayed further from the straight line",
                    floor.position_limit_m
                ),
            ),
            ("Guaranteed", "scanned wherever the robot was within its 95 % position error".into()),
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
        "The tool was on for {} of {}. Meanwhile {:.2} of {:.2} m² of floor came under it with a known position, {:.1} %. The rest was \
         not to be scanned by this program, so that no floor counts as missed and no reasons are given.",
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
            format!("{:?}", plate.kind).to_lowercase().into(),
            format!("{:.2}", plate.shares.area_m2).into(),
            known(p.scanned),
            known(p.guaranteed.unwrap_or(0.0)),
            plate.error_p95_m.map_or_else(none, |m| cm(m).into()),
            found.count().to_string().into(),
        ]);
    }
    let note = match located.tool_on_s {
        Some(_) => "Scanned: while the tool was on, with a known position.",
        None => NOT_KNOWN,
    };
    vec![Block::Table(table), Block::Note(note.into())]
}

fn limitations(document: &Document) -> Vec<Block> {
    let has_truth = document.runs.iter().any(|run| run.positioning.is_some());
    let runs = counted(document.runs.len() as u64, "run");
    let mut items = vec![
        format!("The positions of {runs} were computed from readings that others measured. This program neither moved nor saw the robot."),
        "The readings are taken as they were exported: their clock, their stations and the state of the tool are not checked.".to_owned(),
        "Only obstacles on the drawing are shown.".to_owned(),
        "\u{201c}Scanned\u{201d} does not say that a defect would have been detected; that rests on the instrument, its calibration and the \
         surface."
            .to_owned(),
        "The 95 % error is by the covariance: errors of the survey of the stations and of the speed of sound, and the offset of the tool \
         on the robot are not in it."
            .to_owned(),
        "Nothing here replaces the inspector's own assessment of completeness under the code that applies.".to_owned(),
    ];
    if has_truth {
        items.push(
            "The readings hold true places. If these come from a simulator, so do the readings.".to_owned(),
        );
    }
    let code = Value::fact(document.inspection.code.as_ref(), "code");
    vec![Block::List(items), Block::Facts(vec![("Code and edition", code)])]
}
