//! Writes fixes and track as a table, with one line for each moment that has ranges.

use crate::columns::Kind;
use mission::{Event, EventKind};
use positioning::{
    Fix, Integrity,
    fix::{ellipse_95, position_covariance},
};
use report::document::csv::cell;
use std::io::{self, Write};
use world::{Point, Pose, Station};

const HEADER: &str = "t_s,fix_x_m,fix_y_m,fix_xx_m2,fix_xy_m2,fix_yy_m2,fix_95_m,integrity,stations,left_out,chi2,gdop,\
    protection_m,why_none,x_m,y_m,heading_rad,xx_m2,xy_m2,yy_m2,error_95_m,pose_protection_m,true_x_m,true_y_m\n";

/// Writes the table from the events of each moment.
pub struct Fixes<W: Write> {
    out: W,
    stations: Vec<Station>,
}

impl<W: Write> Fixes<W> {
    /// Begins a table and writes its header line.
    ///
    /// # Errors
    /// The table cannot be written.
    pub fn new(mut out: W, stations: &[Station]) -> io::Result<Self> {
        out.write_all(HEADER.as_bytes())?;
        Ok(Self { out, stations: stations.to_vec() })
    }

    /// Writes a line if the moment had ranges.
    ///
    /// # Errors
    /// The table cannot be written.
    pub fn take(&mut self, events: &[Event]) -> io::Result<()> {
        let (mut fix, mut truth, mut estimate, mut level) = (None, None, None, None);
        for event in events {
            match &event.kind {
                EventKind::Fixed { fix: found } => fix = Some((event.t_s, Ok(found))),
                EventKind::FixFailed { error, .. } => fix = Some((event.t_s, Err(error.to_string()))),
                EventKind::Truth { pose, .. } => truth = Some(*pose),
                EventKind::Estimated { pose } => estimate = Some(pose),
                EventKind::Protected { level_m } => level = *level_m,
                _ => {}
            }
        }
        let (Some((t_s, fix)), Some(pose)) = (fix, estimate) else { return Ok(()) };
        write!(self.out, "{t_s},")?;
        match fix {
            Ok(fix) => self.fix(fix)?,
            Err(why) => write!(self.out, ",,,,,,none,0,,,,,\"{why}\"")?,
        }
        let Point { coords: at } = pose.position;
        let [xx, xy, yy] = [(0, 0), (0, 1), (1, 1)].map(|at| pose.covariance[at]);
        let error_m = ellipse_95(&position_covariance(&pose.covariance)).0;
        let level = level.map(|level_m| level_m.to_string()).unwrap_or_default();
        write!(self.out, ",{},{},{},{xx},{xy},{yy},{error_m},{level}", at.x, at.y, pose.heading_rad)?;
        match truth {
            Some(Pose { position, .. }) => writeln!(self.out, ",{},{}", position.x, position.y),
            None => writeln!(self.out, ",,"),
        }
    }

    fn fix(&mut self, fix: &Fix) -> io::Result<()> {
        let name = |id| self.stations.iter().find(|station| station.id == id).map_or("", |s| s.name.as_str());
        let out: Vec<&str> = fix.excluded.iter().map(|(id, _)| name(*id)).collect();
        let out = cell(&out.join(" ")).replace('"', "\"\"");
        let [xx, xy, yy] = [(0, 0), (0, 1), (1, 1)].map(|at| fix.covariance[at]);
        let protection = fix.protection_level_m.map(|level_m| level_m.to_string()).unwrap_or_default();
        write!(
            self.out,
            "{},{},{xx},{xy},{yy},{},{},{},\"{out}\",{},{},{protection},",
            fix.position.x,
            fix.position.y,
            fix.ellipse_95().0,
            word(fix.integrity),
            fix.used.len(),
            fix.chi2,
            fix.gdop,
        )
    }

    /// Writes any buffered data.
    ///
    /// # Errors
    /// The table cannot be written.
    pub fn finish(mut self) -> io::Result<()> {
        self.out.flush()
    }
}

/// Returns the word to show to people.
pub(crate) fn word(integrity: Integrity) -> &'static str {
    match integrity {
        Integrity::Ok => "ok",
        Integrity::Suspect => "suspect",
        Integrity::Untestable => "untestable",
        Integrity::Alarm => "alarm",
    }
}

impl Kind {
    /// Returns the words to show to people.
    pub fn word(self) -> &'static str {
        match self {
            Self::Ranges => "ranges",
            Self::Differences => "differences of arrival times",
        }
    }
}
