//! The map of a report on located readings: the track and, if known, the floor that the tool passed over.

use super::super::{
    indications::Indication,
    layers::Layers,
    maps::{FULL_MM, Figure, drawn_track, filled, legend, swatch},
    marks,
};
use crate::{
    drawing::sheet::{Sheet, colour},
    past_run::PastRun,
};

/// Draws the map; `tool_is_known` tells whether the readings show when the tool was on.
pub(in crate::document) fn map(
    layers: &Layers<'_>,
    past: &[PastRun],
    indications: &[Indication],
    tool_is_known: bool,
) -> Figure {
    let (floor, fixtures) = (layers.floor(), layers.fixtures());
    let mut sheet = Sheet::new(fixtures.boundary, "c", FULL_MM, 8.0);
    sheet.define_patterns(floor.cell_m);
    sheet.wall(fixtures.boundary, r##"fill="#fff""##);
    let is_scanned = |cell: usize| tool_is_known && layers.is_scanned(cell);
    sheet.cells(floor, is_scanned, 0.75, &format!(r#"fill="{}""#, colour::TWICE));
    sheet.plates(layers.plates.as_ref());
    for past in past {
        let track = drawn_track(&sheet, &past.record);
        sheet.draw(format_args!(
            r#"<path d="{track}" fill="none" stroke="{}" stroke-width=".3" stroke-linejoin="round"/>"#,
            colour::TRACK
        ));
    }
    sheet.obstacles(&fixtures);
    sheet.frame(&fixtures, 2.4);
    let names = sheet.plate_names(layers.plates.as_ref(), 2.1);
    marks::draw(&mut sheet, indications, &names);
    let line = swatch(&format!(r#"<path d="M.5 2H6.5" stroke="{}" stroke-width=".5"/>"#, colour::TRACK));
    let mut entries = vec![legend(line, "estimated track", String::new())];
    if tool_is_known {
        let cells = (0..floor.len()).filter(|cell| is_scanned(*cell)).count();
        let m2 = format!("{:.2} m²", cells as f64 * floor.cell_m2());
        entries.push(legend(filled(colour::TWICE), "under the tool while it was on", m2));
        entries.push(legend(filled("#fff"), "not under the tool, or position not known", String::new()));
    }
    if !indications.is_empty() {
        let mark = swatch(&format!(
            r#"<circle cx="3.5" cy="2" r="1.3" {} stroke="{}"/>"#,
            marks::STYLE,
            colour::TETHER
        ));
        entries.push(legend(mark, "indication (I and its number)", indications.len().to_string()));
    }
    let caption = if tool_is_known {
        "Track of the instrument according to the readings, and the floor under the tool while it was on"
    } else {
        "Track of the instrument according to the readings; it is not known when the tool was on"
    };
    Figure { caption: caption.into(), svg: sheet.svg("Map of the located track", "full"), legend: entries }
}
