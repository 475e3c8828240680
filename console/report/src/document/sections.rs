//! The sections of the page and their order.

pub(super) mod closing;
pub(super) mod floor;
mod front;
mod missed;
pub(super) mod runs;
mod survey;
mod task;
mod thickness;

use super::{
    found, located,
    model::Document,
    page::{Page, Section, section},
};

/// Builds the page of a document.
pub(super) fn sections(document: &Document) -> Page {
    if let Some(located) = &document.located {
        let page = front::page(document, numbered(located::sections(document, located)));
        return found::on_first_sheet(document, located::as_located(document, located, page));
    }
    if let Some(task) = &document.task {
        let page = front::page(document, numbered(task::sections(document, task)));
        return found::on_first_sheet(document, page);
    }
    let sections = [
        section("Scope", front::scope(document)),
        Section { is_new_sheet: true, ..section("Coverage map", floor::map(document)) },
        section("Missed and unreachable floor", missed::missed(document)),
        section("Critical zone along the shell", floor::zone(document)),
        section("Position accuracy and guaranteed coverage", floor::accuracy(document)),
        section(
            "Plates",
            [floor::plates(document), thickness::thickness(document)].into_iter().flatten().collect(),
        ),
        section("Track, tether and record", runs::runs(document)),
        section("Equipment and calibration", closing::equipment(document)),
        section("Limitations", closing::limitations(document)),
        section("Gate before signing", closing::gate(document)),
        section("Signatures and revisions", closing::signatures(document)),
        section("Provenance", closing::provenance(document)),
    ];
    found::on_first_sheet(document, front::page(document, numbered(sections)))
}

fn numbered(sections: impl IntoIterator<Item = Section>) -> Vec<Section> {
    (1..).zip(sections).map(|(number, section)| Section { number, ..section }).collect()
}
