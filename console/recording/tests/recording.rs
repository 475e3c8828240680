//! Journal and recording, written and read back.

#[path = "recording/content.rs"]
mod content;
#[path = "recording/damaged.rs"]
mod damaged;
#[path = "recording/disk.rs"]
mod disk;
#[path = "recording/hostile.rs"]
mod hostile;
#[path = "recording/journal.rs"]
mod journal;
#[path = "recording/recorder.rs"]
mod recorder;
#[path = "recording/surveys.rs"]
mod surveys;
#[path = "recording/synthetic.rs"]
mod synthetic;
#[path = "recording/thread.rs"]
mod thread;

/// All events of a made-up run with this number of ticks, in one list.
fn events(ticks: u64) -> Vec<mission::Event> {
    synthetic::run(ticks).into_iter().flatten().collect()
}
