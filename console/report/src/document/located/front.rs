//! The first sheet of a report on located readings.

use super::super::{
    model::Document,
    page::{Page, Share, Table, Value, Verdict},
    readings::Located,
    run_part::rule,
    words::number,
};
use account::clock;

/// Turns the first sheet of a mission into that of located readings.
pub(in crate::document) fn as_located(document: &Document, located: &Located, mut page: Page) -> Page {
    let date = Value::fact(document.inspection.inspected_on.as_ref(), "inspected_on");
    for field in &mut page.fields {
        match field.label {
            "Date of the run (UTC)" => {
                field.label = "Date of the inspection";
                field.value = date.clone();
            }
            "Mission time" => {
                field.label = "Time of the readings";
                field.value = clock(located.time_s).into();
            }
            _ => {}
        }
    }
    Page {
        title: format!("Located readings: {}", page.title),
        heading: "Tank floor: positions located from readings",
        mark: "LOCATED FROM READINGS",
        banner: format!(
            "Positions were computed from the readings in {}; this program did not run a mission. Nothing \
             was planned, and no floor counts as missed.",
            located.files()
        ),
        is_simulation: false,
        verdict: verdict(document, located),
        shares: shares(document, located),
        bases: Some(bases(document, located)),
        ..page
    }
}

fn p95_cm(document: &Document) -> Option<f64> {
    document.runs.iter().filter_map(|run| run.accuracy).map(|a| 100.0 * a.p95_m).reduce(f64::max)
}

fn verdict(document: &Document, located: &Located) -> Verdict {
    let error = p95_cm(document).map_or_else(
        || "The position error is not known.".to_owned(),
        |p95_cm| {
            format!("The 95 % error of the position was at most {p95_cm:.1} cm during 95 % of the time.")
        },
    );
    let floor = match located.tool_on_s {
        Some(on_s) => format!(
            "The tool was on for {}. While it was on and the position was known, it passed over {:.1} % of \
             the whole floor; {:.1} % is guaranteed, allowing for {}.",
            clock(on_s),
            document.floor.whole.percent.scanned,
            document.floor.whole.percent.guaranteed.unwrap_or(0.0),
            rule(document).allowance()
        ),
        None => "No coverage is stated because the readings do not show when the tool was on.".to_owned(),
    };
    Verdict {
        class: "part",
        lead: format!("Positions located from readings; not a mission. {error}"),
        cause: floor,
    }
}

fn shares(document: &Document, located: &Located) -> Vec<Share> {
    let fixes: u64 = document.runs.iter().filter_map(|run| run.accuracy).map(|a| a.fixes).sum();
    let error = Share {
        value: p95_cm(document).map_or_else(|| "\u{2013}".into(), |cm| format!("{cm:.1}")),
        unit: "cm",
        of: "95 % position error",
        about: "not exceeded during 95 % of the time, according to the covariance".into(),
    };
    let count = Share {
        value: fixes.to_string(),
        unit: "",
        of: "positions from ranges",
        about: format!(
            "in {}; the track has {} estimated positions",
            clock(located.time_s),
            located.positions
        ),
    };
    let whole = &document.floor.whole;
    let scanned = match located.tool_on_s {
        Some(_) => Share {
            value: format!("{:.1}", whole.percent.scanned),
            unit: "%",
            of: "of the whole floor scanned",
            about: format!(
                "{:.1} of {:.1} m² within the shell, excluding the footprint of obstacles, while the tool was on",
                whole.scanned * whole.area_m2,
                whole.area_m2
            ),
        },
        None => Share {
            value: "\u{2013}".into(),
            unit: "",
            of: "coverage not stated",
            about: "the readings do not show when the tool was on".into(),
        },
    };
    vec![error, count, scanned]
}

fn bases(document: &Document, located: &Located) -> Table {
    let mut table = Table::new(
        "",
        &[
            ("Base", "", ""),
            ("Area", "m²", "r"),
            ("Scanned", "%", "r"),
            ("Guaranteed part", "%", "r"),
            ("Tool on", "h:m:s", "r"),
        ],
    );
    let whole = &document.floor.whole;
    let known = |text: String| if located.tool_on_s.is_some() { text } else { "not known".into() };
    table.row(vec![
        "Whole floor".into(),
        number(whole.area_m2, 1).into(),
        known(number(whole.percent.scanned, 1)).into(),
        known(number(whole.percent.guaranteed.unwrap_or(0.0), 1)).into(),
        known(clock(located.tool_on_s.unwrap_or(0.0))).into(),
    ]);
    table
}
