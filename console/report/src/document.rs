//! The report that an inspector signs: one model, written as HTML, JSON, CSV, `GeoJSON` and DXF.

mod build;
mod certificate;
mod charts;
pub mod csv;
mod decision;
mod decisions;
pub mod dxf;
mod follow_up;
mod found;
mod gate;
pub mod geojson;
pub mod grid;
mod html;
mod indications;
pub(crate) mod layers;
mod located;
mod maps;
mod marks;
mod model;
mod packed;
mod page;
mod readings;
mod run_part;
mod sections;
mod shapes;
mod signed;
mod survey;
mod task;
mod thickness;
mod two_surveys;
mod words;

pub use build::Context;
pub use html::html;
pub use indications::Indication;
pub use located::located_json;
pub use maps::Figure;
pub use model::{Document, GateItem};
pub use packed::stated_files;
pub use readings::{Located, Readings};
pub use run_part::{Driver, Files, Recovered, RunPart, TetherPart};
pub use signed::{Revision, Signature, SignedRun};
pub use survey::{ColumnPart, DrawnAs, Instead, MapPart, NotDrawn, NotFound};
pub use task::TaskPart;
pub use two_surveys::{
    Due, Grown, Single, SurveyPart, Surveyed, TWO_SURVEYS_SUFFIXES, TwoSurveys, two_surveys_html,
    two_surveys_tables,
};

#[cfg(test)]
mod tests;
