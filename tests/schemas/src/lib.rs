//! The JSON Schemas of reports and journals, made of the types in the sources: their fields, their serde attributes and their
//! documentation.
//!
//! Nothing of it is in the program. `SCHEMA_UPDATE=1 cargo test --release -p schemas` renews the files in `console/docs`.

mod attributes;
mod schema;
mod sources;

pub use schema::{Document, Root};
pub use sources::Sources;
