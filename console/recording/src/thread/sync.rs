//! Syncs the journal to disk, as protection against loss of power.

use super::shared::Shared;
use std::{
    fs::File,
    io,
    sync::{Arc, Weak, atomic::Ordering},
    thread,
    time::Duration,
};

/// Longest time for which written data may be missing from the disk.
const PERIOD: Duration = Duration::from_secs(1);

/// Starts a thread that syncs the written journal to disk every [`PERIOD`], as long as `shared` has another owner.
pub(super) fn begin(file: File, shared: &Arc<Shared>) -> io::Result<()> {
    let shared = Arc::downgrade(shared);
    thread::Builder::new().name("journal on disk".into()).spawn(move || keep(&file, &shared)).map(drop)
}

fn keep(file: &File, shared: &Weak<Shared>) {
    let mut synced = 0;
    loop {
        thread::sleep(PERIOD);
        // The last sync comes after the end, so that it includes all data.
        let bytes = shared.upgrade().map(|shared| shared.journal_bytes.load(Ordering::Relaxed));
        if bytes != Some(synced) {
            // If the disk refuses the data, the next write also fails, and that is reported.
            let _ = file.sync_data();
        }
        match bytes {
            Some(bytes) => synced = bytes,
            None => return,
        }
    }
}
