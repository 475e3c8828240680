//! What only people know of an inspection: `[inspection]`, in a scenario or in a file of its own.

use super::{problem::ScenarioErrors, schema, section::Section, source::Source, syntax_error};
use report::Inspection;
use toml::de::DeTable;

/// Reads `[inspection]`; nothing is known if it is not there.
pub(crate) fn section(root: &Section<'_>) -> Option<Inspection> {
    let section = root.table_or_empty("inspection")?;
    // What is empty is not known.
    let text = |key: &str| section.text(key).filter(|text| !text.trim().is_empty());
    Some(Inspection {
        client: text("client"),
        site: text("site"),
        tank_id: text("tank_id"),
        drawing: text("drawing"),
        nominal_thickness_mm: section.number("nominal_thickness_mm"),
        order: text("order"),
        procedure: text("procedure"),
        code: text("code"),
        inspector: text("inspector"),
        inspector_certificate: text("inspector_certificate"),
        operator: text("operator"),
        approver: text("approver"),
        robot: text("robot"),
        instrument: text("instrument"),
        calibration_before: text("calibration_before"),
        calibration_after: text("calibration_after"),
        station_check: text("station_check"),
        sound_speed: text("sound_speed"),
        indications: text("indications"),
        events_reviewed_by: text("events_reviewed_by"),
        plates_waiver: text("plates_waiver"),
        partial_scope_accepted: text("partial_scope_accepted"),
        critical_zone_accepted: text("critical_zone_accepted"),
        missed_accepted: text("missed_accepted"),
        remarks: text("remarks"),
        datum_crs: text("datum_crs"),
        datum_m: if section.has("datum_m") { section.point("datum_m").map(|p| [p.x, p.y]) } else { None },
        datum_north_deg: section.number("datum_north_deg"),
    })
}

/// Reads a file with `[inspection]`: what is known only after the run.
///
/// # Errors
/// Everything that is wrong with it.
pub fn inspection(text: &str, shown_name: &str) -> Result<Inspection, ScenarioErrors> {
    let table = DeTable::parse(text).map_err(|error| syntax_error(text, shown_name, &error))?;
    let source = Source::new(text);
    let read = section(&Section::root(&source, table.get_ref(), schema::INSPECTION_FILE));
    let problems = source.into_problems();
    match read {
        Some(read) if problems.is_empty() => Ok(read),
        _ => Err(ScenarioErrors { shown_name: shown_name.to_owned(), text: text.to_owned(), problems }),
    }
}
