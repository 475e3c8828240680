//! Planner plugins: discovery, checks before loading, loader, worker process, supervisor.
//!
//! A plugin is a shared library of strangers. The console never loads one: it starts itself again as a worker
//! process, which closes itself off, loads one plugin and answers requests over a socket. Whatever the plugin does there
//! (crash, hang, eat memory, print, reach for files or other processes) ends as a [`mission::Fault`] with one sentence, within the budget of what it was asked.
//!
//! [`Host`] answers what the mission asks and waits only where the caller requests it; [`BlockingHost`] is for callers with
//! nothing else to do than wait; [`survey`] lists what was found; [`worker_main`] is what the hidden
//! command `worker` runs. All of it needs a Unix system.
//!
//! Frames and units are those of `planner_api`.

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
