//! Writes a synthetic run into a folder for inspection in the viewer: `synthetic_run FOLDER [TICKS]`.

#[path = "../tests/recording/synthetic.rs"]
mod synthetic;

use recording::{Options, RunRecorder};
use std::{error::Error, path::PathBuf, time::Duration};

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let folder = PathBuf::from(arguments.next().ok_or("usage: synthetic_run FOLDER [TICKS]")?);
    let ticks = arguments.next().map_or(Ok(2000), |ticks| ticks.parse())?;
    std::fs::create_dir_all(&folder)?;
    let recorder = RunRecorder::start(&folder, Options::default())?;
    for events in synthetic::run(ticks) {
        recorder.send(events);
    }
    let finished = recorder.finish(Duration::from_secs(10));
    finished.error.map_or(Ok(()), |error| Err(error.into()))
}
