//! Many missions from one plan: the list of missions, their blocks, the table of their results, and the findings from it.
//!
//! A [`Plan`] is read from a file. A [`Campaign`] is the plan frozen together with the texts of its scenarios;
//! [`Campaign::case`] returns a mission by its number. The result of a mission is a [`Row`]; rows become a [`table`], and
//! a table becomes [`Findings`], which can be written as text or as a page. This crate uses no files, threads, clocks or
//! processes: the bytes of the table depend only on the plan.

mod columns;
mod compare;
mod design;
mod digest;
mod findings;
mod frozen;
mod grid;
mod page;
pub mod part;
mod plan;
mod plots;
mod reader;
mod row;
pub mod statistics;
pub mod table;
mod text;
mod until;
mod value;

pub use compare::{Comparison, compare};
pub use design::{Design, Seeds};
pub use findings::{Findings, findings};
pub use frozen::{Campaign, Case, Program, ScenarioText, shell};
pub use page::page;
pub use plan::{Plan, PlanKey};
pub use row::{Row, Status};
pub use table::{Table, TableError};
pub use until::{Until, Watch};
pub use value::Value;
