//! The comparison as one HTML file.

use super::{TwoSurveys, sections::sections};
use crate::document::{
    html::{CSS, number},
    page::{Block, Field, Section, Share, Verdict},
};
use askama::Template;

/// The page of a comparison.
#[derive(Template)]
#[template(path = "surveys.html", whitespace = "preserve")]
pub(super) struct SurveysPage {
    pub(super) title: String,
    pub(super) css: &'static str,
    pub(super) head: String,
    pub(super) foot: String,
    pub(super) is_simulation: bool,
    pub(super) fields: Vec<Field>,
    pub(super) verdict: Verdict,
    pub(super) shares: Vec<Share>,
    pub(super) sections: Vec<Section>,
}

/// Renders the comparison as one self-contained HTML file without network access or scripts; it prints on A4.
pub fn two_surveys_html(comparison: &TwoSurveys) -> String {
    let mut page = sections(comparison);
    page.css = CSS;
    number(&mut page.sections);
    // Rendering this template cannot fail.
    let html = page.render().unwrap_or_default();
    foreign::plain_lines(&html).into_owned()
}
