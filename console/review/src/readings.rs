//! The sensor readings of a past run: the run is recomputed from its journal.

use crate::verify::{planners::Replayed, prepared};
use anyhow::Context;
use flight::failure::bad_input;
use mission::EventKind;
use recording::{Ticks, journal_of};
use std::{io, path::Path};
use world::{Pose, Readings};

/// Writes the sensor readings tick by tick, each with its time, seconds, and, for a simulated run, the true pose of the
/// robot.
///
/// # Errors
/// The journal of the run in the folder cannot be read, this build recomputes a different run from it, or the
/// readings cannot be written.
pub fn readings(
    folder: &Path,
    mut take: impl FnMut(f64, &Readings, Option<Pose>) -> io::Result<()>,
) -> anyhow::Result<()> {
    let path = journal_of(folder);
    let mut ticks = Ticks::open(&path)?;
    let (_, mut flight) = prepared(&path, &mut ticks)?;
    let mut replayed = Replayed::from_journal();
    let mut head = vec![flight.opened()];
    while let Some(recorded) = ticks.next_tick()? {
        replayed.begin_tick(&recorded);
        let mut computed = std::mem::take(&mut head);
        computed.extend(flight.tick(&recorded, &mut replayed));
        if recorded.difference(&computed).context("writing an event as JSON")?.is_some() {
            return Err(bad_input(format!(
                "from tick {} on, this version of tankops computes a different run, so its readings would not be \
                 those of the recorded run; `tankops verify` shows the difference: {}",
                recorded.tick,
                path.display()
            )));
        }
        let truth = computed.iter().find_map(|event| match event.kind {
            EventKind::Truth { pose, .. } => Some(pose),
            _ => None,
        });
        if let Some(first) = computed.first() {
            take(first.t_s, flight.readings(), truth).context("writing the readings")?;
        }
    }
    Ok(())
}
