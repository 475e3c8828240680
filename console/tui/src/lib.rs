//! The console's screens: a pure model, update function and view, and the terminal shell around them.
//!
//! [`Model`] is plain data. [`update()`] folds a [`Msg`] into it and returns [`Effect`]s for the caller to carry out;
//! [`view()`] draws the model. Neither function uses a clock, file, thread or terminal: time arrives as a message.
//! Only [`terminal`] touches the real terminal.
//!
//! The screen shows the mission's own state. The ground truth that a simulator adds to the event stream is never
//! read.

pub mod actions;
pub mod caps;
pub mod guide;
pub mod handover;
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
    Effect, Job, Mouse, Msg, Query, Redraw, ReplayMsg, Rows, RunMsg, Signal, Target, Transport, check_line,
    is_typing, redraw, update,
};
pub use view::{Cache, Places, view, view_cached, view_with};
