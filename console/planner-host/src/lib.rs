//! Planner plugins: discovery, checks before loading, the loader, the worker process and the supervisor.
//!
//! A plugin is a shared library from a third party. The console never loads one itself: it starts a copy of itself as a
//! worker process, which enters a sandbox, loads one plugin and answers requests over a socket. Any failure there (the
//! plugin crashes, hangs, exhausts memory, or tries to reach files or other processes) becomes a [`mission::Fault`]
//! with one sentence, within the budget of the request.
//!
//! [`Host`] answers the asks of a mission and waits only where the caller requests it. [`BlockingHost`] is for callers
//! that only wait for answers. [`survey`] lists the plugins found. The hidden command `worker` runs
//! [`worker_main`]. This crate needs a Unix system.
//!
//! Coordinate frames and units are those of `planner_api`.

#![deny(unsafe_code)]

mod blocking;
mod checks;
pub mod discovery;
#[cfg(test)]
mod fixture;
mod host;
mod loader;
mod parameters;
mod progress;
mod remains;
mod replay;
mod sandbox;
pub mod stamp;
mod stats;
mod supervisor;
mod survey;
mod user_folder;
mod wire;
mod worker;

pub use blocking::{BlockingHost, Reply};
pub use discovery::PluginDirs;
pub use host::{Host, HostConfig};
pub use parameters::{check_parameters, parameter_problems};
pub use progress::{OnProgress, Progress};
pub use remains::{BadEnd, Crash, Printed};
pub use replay::{NotReplayed, Replayed, digest_of, plugin_of, replay};
pub use stats::{CallStats, HostStats, Memory};
pub use supervisor::{Waker, WorkerCommand};
pub use survey::{Survey, SurveyedPlugin, Surveyor, check_plugin, survey};
pub use user_folder::user_folder;
pub use worker::{check_limits, worker_main};
