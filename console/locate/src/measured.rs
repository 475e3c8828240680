//! Writes the readings of a run in the format that this crate reads.

use report::document::csv::cell;
use std::io::{self, Write};
use world::{Odometry, Pose, RangeSet, Readings, Station};

const HEADER: &str = "t_s,station,range_m,forward_m,sideways_m,turn_rad,true_x_m,true_y_m,true_heading_rad\n";

/// Writes readings tick by tick.
pub struct MeasuredWriter<W: Write> {
    out: W,
    stations: Vec<Station>,
}

impl<W: Write> MeasuredWriter<W> {
    /// Begins a file and writes its header line.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn new(mut out: W, stations: &[Station]) -> io::Result<Self> {
        out.write_all(HEADER.as_bytes())?;
        Ok(Self { out, stations: stations.to_vec() })
    }

    /// Writes the readings of one tick: one row for the motion and the truth, and one row for each range.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write(&mut self, t_s: f64, readings: &Readings, truth: Option<Pose>) -> io::Result<()> {
        let Odometry { forward_m, sideways_m, turn_rad } = readings.odometry;
        let truth = truth.map_or_else(
            || ",,".to_owned(),
            |Pose { position, heading_rad }| format!("{},{},{heading_rad}", position.x, position.y),
        );
        writeln!(self.out, "{t_s},,,{forward_m},{sideways_m},{turn_rad},{truth}")?;
        for RangeSet { station, ranges_m } in &readings.ranges {
            let name = self.stations.iter().find(|s| s.id == *station).map_or("", |s| s.name.as_str());
            let name = quoted(&cell(name));
            for range_m in ranges_m {
                writeln!(self.out, "{t_s},{name},{range_m},,,,,,")?;
            }
        }
        Ok(())
    }

    /// Returns the underlying writer.
    pub fn into_inner(self) -> W {
        self.out
    }
}

/// Returns a name as a cell.
fn quoted(name: &str) -> String {
    if name.contains(['"', ',', ';', '\n', '#']) {
        format!("\"{}\"", name.replace('"', "\"\""))
    } else {
        name.into()
    }
}
