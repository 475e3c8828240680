//! The sections of the page and their order.

pub(super) mod closing;
pub(super) mod floor;
mod front;
mod missed;
pub(super) mod runs;
mod task;

use super::{
    Document,
    maps::Figure,
    page::{Block, Page, Picture, Section},
};
pub(super) use crate::human::text::counted;

/// Builds the page of a document.
pub(super) fn sections(document: &Document) -> Page {
    if let Some(located) = &document.located {
        let page = front::page(document, numbered(super::located::sections(document, located)));
        return super::located::as_located(document, located, page);
    }
    if let Some(task) = &document.task {
        return front::page(document, numbered(task::sections(document, task)));
    }
    let sections = [
        section("Scope", front::scope(document)),
        Section { is_new_sheet: true, ..section("Coverage map", floor::map(document)) },
        section("Missed and unreachable floor", missed::missed(document)),
        section("Critical zone along the shell", floor::zone(document)),
        section("Position accuracy and guaranteed coverage", floor::accuracy(document)),
        section("Plates", floor::plates(document)),
        section("Track, tether and record", runs::runs(document)),
        section("Equipment and calibration", closing::equipment(document)),
        section("Limitations", closing::limitations(document)),
        section("Gate before signing", closing::gate(document)),
        section("Signatures and revisions", closing::signatures(document)),
        section("Provenance", closing::provenance(document)),
    ];
    front::page(document, numbered(sections))
}

/// The sections of a report on a task other than scanning, given as section numbers in a scan report.
const WITHOUT_SCAN: [usize; 9] = [1, 2, 5, 7, 8, 9, 10, 11, 12];

/// Converts a section number in a scan report to the number in this report.
pub(super) fn number_of(is_to_scan: bool, section: usize) -> usize {
    let place = WITHOUT_SCAN.iter().position(|known| *known == section).map_or(section, |index| index + 1);
    if is_to_scan { section } else { place }
}

fn numbered(sections: impl IntoIterator<Item = Section>) -> Vec<Section> {
    (1..).zip(sections).map(|(number, section)| Section { number, ..section }).collect()
}

pub(super) fn section(title: &'static str, blocks: Vec<Block>) -> Section {
    Section { number: 0, title, is_new_sheet: false, blocks }
}

/// A numbered figure.
pub(super) fn picture(figure: &Figure) -> Picture {
    let Figure { caption, svg, legend } = figure;
    Picture { number: 0, caption: caption.clone(), svg: svg.clone(), legend: legend.clone() }
}

/// Formats a number with a sign and a fixed number of decimals; zero has no sign.
pub(super) fn number(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    let is_zero = text.trim_start_matches('-').chars().all(|c| c == '0' || c == '.');
    if is_zero { text.trim_start_matches('-').to_owned() } else { text.replace('-', "\u{2212}") }
}

/// Converts metres to centimetres.
pub(super) fn cm(value_m: f64) -> String {
    number(100.0 * value_m, 1)
}
