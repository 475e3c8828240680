//! Reads the facts that only people know about an inspection: `[inspection]`, in a scenario or in a separate file.

use super::{
    problem::{Complaint, ScenarioErrors},
    readable, schema,
    section::Section,
    source::Source,
    syntax_error,
};
use account::{Date, Inspection, is_placeholder};
use toml::de::DeTable;

/// The largest number of characters in a fact: more than a page.
const MOST_LETTERS: usize = 4000;

/// Reads `[inspection]`; without this section all facts are unknown.
pub(crate) fn section(root: &Section<'_>) -> Option<Inspection> {
    let section = root.table_or_empty("inspection")?;
    let text = |key: &str| fact(&section, key);
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
        inspector_certificate_expires: day(&section, "inspector_certificate_expires"),
        operator: text("operator"),
        approver: text("approver"),
        robot: text("robot"),
        instrument: text("instrument"),
        calibration_before: text("calibration_before"),
        calibration_after: text("calibration_after"),
        station_check: text("station_check"),
        sound_speed: text("sound_speed"),
        indications: text("indications"),
        indications_explained: text("indications_explained"),
        through_accepted: text("through_accepted"),
        events_reviewed_by: text("events_reviewed_by"),
        inspected_on: day(&section, "inspected_on"),
        coverage_waiver: text("coverage_waiver"),
        identity_corrected: text("identity_corrected"),
        plates_waiver: text("plates_waiver"),
        partial_scope_accepted: text("partial_scope_accepted"),
        critical_zone_accepted: text("critical_zone_accepted"),
        missed_accepted: text("missed_accepted"),
        remarks: text("remarks"),
        datum_crs: text("datum_crs"),
        datum_m: section.has("datum_m").then(|| section.pair("datum_m")).flatten(),
        datum_north_deg: section.number("datum_north_deg"),
    })
}

/// A fact; `None` if the text is empty. A placeholder such as "TBD" is refused.
fn fact(section: &Section<'_>, key: &str) -> Option<String> {
    // An empty text means an unknown fact.
    let text = section.text(key).filter(|text| !text.trim().is_empty())?;
    if is_placeholder(&text) {
        let wanted =
            "the fact itself; leave out the key if the fact is unknown, because a placeholder cannot be signed"
                .to_owned();
        section.complain(key, Complaint::OutOfRange(wanted));
    }
    if text.chars().count() > MOST_LETTERS {
        section.complain(key, Complaint::OutOfRange(format!("at most {MOST_LETTERS} characters")));
    }
    Some(text)
}

/// A date as text.
fn day(section: &Section<'_>, key: &str) -> Option<String> {
    let text = fact(section, key)?;
    if Date::read(&text).is_none() {
        let wanted = "a date that exists, for example \"2027-03-31\", or a month, for example \"2027-03\", \
                      which means its last day";
        section.complain(key, Complaint::OutOfRange(wanted.to_owned()));
    }
    Some(text)
}

/// Reads a separate file with `[inspection]`: facts that become known only after the run.
///
/// # Errors
/// All problems of the file.
pub fn inspection(text: &str, shown_name: &str) -> Result<Inspection, ScenarioErrors> {
    let table = DeTable::parse(text).map_err(|error| syntax_error(text, shown_name, &error))?;
    let source = Source::new(text);
    let read = section(&Section::root(&source, table.get_ref(), schema::INSPECTION_FILE));
    readable::check(&source, table.get_ref());
    let problems = source.into_problems();
    match read {
        Some(read) if problems.is_empty() => Ok(read),
        _ => Err(ScenarioErrors { shown_name: shown_name.to_owned(), text: text.to_owned(), problems }),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]

    use super::*;

    #[test]
    fn a_placeholder_is_no_fact() {
        for text in ["TBD", "todo: ask the client", "xxx", "...", "-", "?", "Lorem ipsum dolor"] {
            let error = refused(&format!("client = \"{text}\""));
            assert!(error.contains("2:10: inspection.client") && error.contains("a placeholder"), "{error}");
        }
        for text in ["none", "A", "7", "Todor Ivanov", "X-12", "Tbcom Ltd"] {
            let read = inspection(&format!("[inspection]\nclient = \"{text}\"\n"), "facts.toml");
            assert_eq!(read.unwrap().client.as_deref(), Some(text));
        }
    }

    #[test]
    fn a_day_is_one_of_the_calendar() {
        let read = |day: &str| {
            inspection(&format!("[inspection]\ninspector_certificate_expires = \"{day}\"\n"), "facts.toml")
        };
        assert_eq!(read("2027-03").unwrap().inspector_certificate_expires.as_deref(), Some("2027-03"));
        for day in ["2027-02-30", "31.3.2027", "next year", "2027"] {
            let error = read(day).unwrap_err().render();
            assert!(error.contains("facts.toml:2:33: inspection.inspector_certificate_expires"), "{error}");
            assert!(error.contains("2027-03-31"), "{error}");
        }
    }

    fn refused(line: &str) -> String {
        inspection(&format!("[inspection]\n{line}\n"), "facts.toml").unwrap_err().render()
    }

    #[test]
    fn a_datum_may_lie_anywhere_on_earth() {
        let read = inspection(
            "[inspection]\ndatum_crs = \"EPSG:25832\"\ndatum_m = [691608.2, 5334760.4]\n",
            "facts.toml",
        );
        assert_eq!(read.unwrap().datum_m, Some([691_608.2, 5_334_760.4]));
        assert!(refused("datum_m = [1e300, 0.0]").contains("facts.toml:2:12: inspection.datum_m"));
    }

    #[test]
    fn a_fact_that_cannot_be_read_as_it_is_written_is_refused_with_its_line() {
        let kept = inspection(
            "[inspection]\nremarks = \"one\\n\\ttwo <b> \\\"three\\\"\"\nsite = \" \"\n",
            "facts.toml",
        )
        .unwrap();
        assert_eq!((kept.remarks.as_deref(), kept.site), (Some("one\n\ttwo <b> \"three\""), None));
        for (letter, code) in
            [("\\u0000", "U+0000"), ("\\f", "U+000C"), ("\\u202e", "U+202E"), ("\\u200b", "U+200B")]
        {
            let error = refused(&format!("tank_id = \"T-07{letter}\""));
            assert!(error.contains("facts.toml:2:11: inspection.tank_id") && error.contains(code), "{error}");
        }
        assert!(
            refused(&format!("remarks = \"{}\"", "x".repeat(MOST_LETTERS + 1)))
                .contains("at most 4000 characters")
        );
    }
}
