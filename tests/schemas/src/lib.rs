//! The JSON Schemas of reports and journals, generated from the types in the sources: their fields, their serde
//! attributes and their documentation.
//!
//! This crate is not part of the program. `SCHEMA_UPDATE=1 cargo test --release -p schemas` renews the files in
//! `console/docs`.

mod attributes;
mod schema;
mod sources;

pub use schema::{Document, Root};
pub use sources::Sources;
