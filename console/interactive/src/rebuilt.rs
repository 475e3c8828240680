//! Plugins that are rebuilt while the console is open: they are looked at again once their files rest.

use super::desk::{DeskHandle, Request};
use anyhow::Context;
use planner_host::{PluginDirs, discovery::Stamps};
use std::{thread, time::Duration};

/// How often the files are looked at: a build is noticed within two of these.
const PERIOD: Duration = Duration::from_secs(1);

/// Has the desk look at the plugins whenever their files have changed and have not changed again for a period.
///
/// # Errors
/// The system gives no thread.
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
