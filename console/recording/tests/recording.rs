//! Journal and recording, written and read back.

#[path = "recording/content.rs"]
mod content;
#[path = "recording/disk.rs"]
mod disk;
#[path = "recording/journal.rs"]
mod journal;
#[path = "recording/recorder.rs"]
mod recorder;
#[path = "recording/synthetic.rs"]
mod synthetic;
#[path = "recording/thread.rs"]
mod thread;
