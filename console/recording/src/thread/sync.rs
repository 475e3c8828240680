//! The journal on disk, whatever happens to the power.

use super::shared::Shared;
use std::{
    fs::File,
    io,
    sync::{Arc, Weak, atomic::Ordering},
    thread,
    time::Duration,
};

/// How long what the system has got may be missing on the disk.
const PERIOD: Duration = Duration::from_secs(1);

/// Begins a thread that puts what was written to the journal on disk every [`PERIOD`], as long as somebody else shares `shared`.
pub(super) fn begin(file: File, shared: &Arc<Shared>) -> io::Result<()> {
    let shared = Arc::downgrade(shared);
    thread::Builder::new().name("journal on disk".into()).spawn(move || keep(&file, &shared)).map(drop)
}

fn keep(file: &File, shared: &Weak<Shared>) {
    let mut synced = 0;
    loop {
        thread::sleep(PERIOD);
        // The last look comes after the end, so that nothing is left out.
        let bytes = shared.upgrade().map(|shared| shared.journal_bytes.load(Ordering::Relaxed));
        if bytes != Some(synced) {
            // A disk that does not take it also fails the next write, which is reported.
            let _ = file.sync_data();
        }
        match bytes {
            Some(bytes) => synced = bytes,
            None => return,
        }
    }
}
