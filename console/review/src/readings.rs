//! What the sensors of a past run measured: the run is computed again from its journal.

use crate::verify::{planners::Replayed, prepared};
use anyhow::Context;
use flight::failure::bad_input;
use mission::EventKind;
use recording::{Ticks, journal_of};
use std::{io, path::Path};
use world::{Pose, Readings};

/// Gives, tick by tick, what was sensed at a time, seconds, and where the robot truly was.
///
/// # Errors
/// The journal of the run in the folder cannot be read, this build computes another run from it, or the readings cannot be
/// taken.
pub fn readings(
    folder: &Path,
    mut take: impl FnMut(f64, &Readings, Pose) -> io::Result<()>,
) -> anyhow::Result<()> {
    let path = journal_of(folder);
    let mut ticks = Ticks::open(&path)?;
    let (_, mut flight) = prepared(&path, &mut ticks)?;
    let mut replayed = Replayed::from_journal();
    let mut head = vec![flight.opened()];
    while let Some(recorded) = ticks.next_tick()? {
        replayed.begin_tick(&recorded);
        let mut computed = std::mem::take(&mut head);
        computed.extend(flight.tick(&recorded.orders(), &mut replayed));
        if recorded.difference(&computed).context("writing an event as JSON")?.is_some() {
            return Err(bad_input(format!(
                "this tankops computes another run from tick {} on, so that its readings are not those of the run; `tankops \
                 verify` shows the difference: {}",
                recorded.tick,
                path.display()
            )));
        }
        let truth = computed.iter().find_map(|event| match event.kind {
            EventKind::Truth { pose, .. } => Some((event.t_s, pose)),
            _ => None,
        });
        if let Some((t_s, truth)) = truth {
            take(t_s, flight.readings(), truth).context("writing the readings")?;
        }
    }
    Ok(())
}
