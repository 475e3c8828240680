//! The console's screens: a pure model, update and view, and the terminal shell around them.
//!
//! [`Model`] is plain data. [`update()`] folds a [`Msg`] into it and answers with [`Effect`]s for the caller to carry
//! out; [`view()`] draws it. Neither knows a clock, a file, a thread or a terminal: time arrives as a message. Only
//! [`terminal`] touches the real terminal.
//!
//! The screen shows what the mission knows. The truth that a simulator adds to the stream of events is never read.

pub mod actions;
pub mod caps;
pub mod guide;
pub mod keys;
mod layout;
pub mod model;
pub mod picture;
pub mod plain;
mod screens;
pub mod terminal;
pub mod theme;
pub mod update;
pub mod view;

pub use caps::{Caps, Colours, Glyphs};
pub use keys::{Key, KeyPress};
pub use model::{Health, Measured, Model, Recording, RunId, RunResult, Source, Speed, Times};
pub use theme::{Role, Theme, ThemeName};
pub use update::{
    Effect, Job, Mouse, Msg, Redraw, ReplayMsg, Rows, RunMsg, Signal, Target, Transport, check_line,
    is_typing, redraw, update,
};
pub use view::{Cache, Places, view, view_cached, view_with};
