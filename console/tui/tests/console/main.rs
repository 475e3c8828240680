//! The console from outside: scripts of messages, stored screens, and laws that hold for every screen.
#![allow(clippy::unwrap_used, reason = "tests")]

mod alarms;
mod better_plan;
mod commands;
mod cuts;
mod drawing;
mod ending;
mod events;
mod fixture;
mod footers;
mod frame;
mod handover;
mod held_keys;
mod laws;
mod look_only;
mod maps;
mod mouse;
mod notices;
mod overviews;
mod panes;
mod presets;
mod printed_keys;
mod reference;
mod replay;
mod rescans;
mod scanned;
mod screens;
mod scripts;
mod settings;
mod shadow;
mod sizes;
mod start;
mod state_line;
mod stopping;
mod unseen;
mod vehicle;
