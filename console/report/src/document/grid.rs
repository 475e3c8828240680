//! The grid of the plates: the thickness in each cell that was tested, as a table for other programs.

use super::{layers::Layers, thickness::thickness};
use crate::{joined::joined_or_located, past_run::PastRun};
use csv::Writer;
use std::io::{self, Write};

/// The columns of the grid.
const HEAD: [&str; 11] = [
    "plate",
    "x_m",
    "y_m",
    "error_95_m",
    "thickness_mean_mm",
    "thickness_least_mm",
    "readings",
    "tool",
    "run",
    "t_s",
    "journal_sha256",
];

/// Writes the grid: for the centre of each cell with readings, the plate, the place in the tank frame, the 95 % error of
/// the position, the thickness, the tool, and the run and the mission time of the latest reading.
///
/// # Errors
/// The runs cannot be combined, have no readings, or the system refuses to write.
pub fn plate_grid(past: &[PastRun], out: impl Write) -> Result<(), String> {
    let all = joined_or_located(past)?;
    let layers = Layers::new(all.run, &all.scanned, &all.evidence, &[]);
    let (read, judge) = thickness(past, &layers).ok_or("the runs have no readings of thickness")?;
    let (floor, passes) = (layers.floor(), layers.scanned.passes());
    let tool = read.kind.to_string();
    let mut table = Writer::from_writer(out);
    let mut write = || -> io::Result<()> {
        table.write_record(HEAD)?;
        for cell in 0..floor.len() {
            let Some((run, t_s)) = judge.last_read(cell) else { continue };
            let at = floor.center(cell);
            let plate = layers.plate_at(at).map(|name| super::csv::cell(&name)).unwrap_or_default();
            let mm = |value: Option<f64>| value.map(|mm| format!("{mm:.2}")).unwrap_or_default();
            let error_m = passes.error_mm(cell).map(|mm| format!("{:.3}", f64::from(mm) / 1000.0));
            let past = past.get(run);
            table.write_record([
                plate,
                format!("{:.3}", at.x),
                format!("{:.3}", at.y),
                error_m.unwrap_or_default(),
                mm(judge.mean_mm(cell)),
                mm(judge.least_mm(cell)),
                judge.count(cell).to_string(),
                tool.clone(),
                past.map(|past| past.name.clone()).unwrap_or_default(),
                format!("{t_s:.1}"),
                past.and_then(|past| past.files.journal_sha256.clone()).unwrap_or_default(),
            ])?;
        }
        table.flush()
    };
    write().map_err(|error| format!("cannot write the grid of the plates: {error}"))
}
