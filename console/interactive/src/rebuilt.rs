//! Watches for plugins that are rebuilt while the console is open, and surveys them again once their files stop
//! changing.

use super::desk::{DeskHandle, Request};
use anyhow::Context;
use planner_host::{PluginDirs, discovery::Stamps};
use std::{thread, time::Duration};

/// The interval at which the files are checked; a build is noticed within two intervals.
const PERIOD: Duration = Duration::from_secs(1);

/// Makes the desk survey the plugins whenever their files have changed and have then stayed unchanged for one interval.
///
/// # Errors
/// The thread cannot be started.
pub(super) fn watch(desk: DeskHandle, plugins: PluginDirs) -> anyhow::Result<()> {
    let watching = thread::Builder::new().name("plugins".into()).spawn(move || {
        let mut stamps = Stamps::of(&plugins);
        let mut known = stamps.look();
        let mut before = known.clone();
        loop {
            thread::sleep(PERIOD);
            let now = stamps.look();
            if now == before && now != known {
                desk.request(Request::Survey);
                known.clone_from(&now);
            }
            before = now;
        }
    });
    watching.map(drop).context("starting the thread that watches the plugins")
}
