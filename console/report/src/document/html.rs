//! The report as one HTML file.

use super::{
    model::Document,
    page::{Block, Page, Section},
    sections::sections,
};
use askama::Template;

/// Style sheet of the page.
pub(super) const CSS: &str = include_str!("../../templates/report.css");

/// The page.
#[derive(Template)]
#[template(path = "report.html", whitespace = "preserve")]
struct Html<'a> {
    page: &'a Page,
}

/// Renders the report as one self-contained HTML file without network access or scripts; it prints on A4.
pub fn html(document: &Document) -> String {
    let mut page = sections(document);
    page.css = CSS;
    number(&mut page.sections);
    // Rendering this template cannot fail.
    let html = Html { page: &page }.render().unwrap_or_default();
    foreign::plain_lines(&html).into_owned()
}

/// Numbers figures and tables in order.
pub(super) fn number(sections: &mut [Section]) {
    let (mut figures, mut tables) = (0, 0);
    let next = |count: &mut usize| {
        *count += 1;
        *count
    };
    for block in sections.iter_mut().flat_map(|section| &mut section.blocks) {
        match block {
            Block::Table(table) if !table.caption.is_empty() => table.number = next(&mut tables),
            Block::Wide(picture) => picture.number = next(&mut figures),
            Block::Pair(pictures) => {
                for picture in pictures {
                    picture.number = next(&mut figures);
                }
            }
            _ => {}
        }
    }
}
