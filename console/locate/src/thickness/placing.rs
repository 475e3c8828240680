//! Places the readings of a file.

use super::{
    Options, Placed, Scanned, Sink,
    clock::{Clock, Known},
    columns::{Cell, Columns, Kind},
    faults::Faults,
    order::{Misplaced, Order},
};
use crate::{clock::Written, problem::Problem, rows::Rows};
use account::{Imported, Whereabouts};
use csv::StringRecord;
use std::path::Path;

/// Seconds in a day and in half an hour.
const DAY_S: f64 = 86_400.0;
const HALF_HOUR_S: f64 = 1800.0;
/// Largest distance of a clock error from a number of half hours that a time zone would explain, seconds.
const NEAR_ZONE_S: f64 = 600.0;
/// Kinds of faults about the clock.
const BEFORE: Kind = "before the start";
const AFTER: Kind = "after the end";

/// Reads a file and hands each reading to the sink with its place. A faulty reading is refused and named; the others are
/// placed.
///
/// # Errors
/// The file cannot be read, its columns are not understood, no reading could be placed, or the sink fails. The text has
/// no file name.
pub fn place(
    file: &Path,
    run: &Scanned<'_>,
    options: &Options<'_>,
    sink: &mut dyn Sink,
) -> anyhow::Result<Placed> {
    let mut rows = Rows::open(file).map_err(anyhow::Error::msg)?;
    let has_commas = rows.has_commas();
    let columns = Columns::new(rows.header(), options.unit, (run.sampling.thickness_mm, has_commas));
    let mut columns = columns.map_err(anyhow::Error::msg)?;
    let (mut placing, mut cells) = (Placing::new(run, options), StringRecord::new());
    loop {
        match rows.next(&mut cells) {
            Ok(None) => break,
            Ok(Some(line)) => {
                placing.rows += 1;
                placing.row(&mut columns, (&cells, line), sink)?;
            }
            Err(problem) if problem.is_end => return Err(anyhow::Error::msg(problem.to_string())),
            Err(mut problem) => {
                placing.rows += 1;
                if !has_commas && problem.what.contains("cells") {
                    problem.what += " (decimal commas need columns separated by ; or a tab)";
                }
                placing.faults.note("rows", &problem);
                sink.refuse(&problem, &cells.iter().collect::<Vec<_>>())?;
            }
        }
    }
    placing.finish(&columns)
}

/// The state while a file is read.
struct Placing<'a> {
    run: &'a Scanned<'a>,
    options: &'a Options<'a>,
    clock: Option<Clock>,
    order: Order,
    imported: Imported,
    faults: Faults,
    rows: u64,
    uncounted: u64,
    sum_mm: f64,
    /// The earliest and the latest time that is not on the track, as mission time, seconds.
    beyond_s: Option<(f64, f64)>,
}

impl<'a> Placing<'a> {
    fn new(run: &'a Scanned<'a>, options: &'a Options<'a>) -> Self {
        Self {
            run,
            options,
            clock: None,
            order: Order::new(run.sampling.pitch_m),
            imported: Imported::new(run.sampling, run.floor),
            faults: Faults::default(),
            rows: 0,
            uncounted: 0,
            sum_mm: 0.0,
            beyond_s: None,
        }
    }

    /// Places the readings of a row.
    fn row(
        &mut self,
        columns: &mut Columns,
        (cells, line): (&StringRecord, u64),
        sink: &mut dyn Sink,
    ) -> anyhow::Result<()> {
        let run = self.run;
        let of_time = |what: String| {
            let column = Some(columns.name(columns.time_index()).to_owned());
            Problem { line, column, what, is_end: false }
        };
        let file_s = match columns.time_s(columns.time_text(cells)) {
            Ok(file_s) => file_s,
            Err(what) => return self.refuse("times", &of_time(what), cells, sink),
        };
        let clock = match self.clock {
            Some(clock) => clock,
            None => *self.clock.insert(self.clock(columns, columns.time_text(cells))?),
        };
        let t_s = clock.mission_s(file_s);
        let Some(here) = run.track.at(t_s) else {
            let (kind, what) = self.beyond(t_s);
            let problem = of_time(format!("{}: {what}", columns.time_text(cells)));
            return self.refuse(kind, &problem, cells, sink);
        };
        for cell in columns.cells(cells, line) {
            let placed = match cell {
                Ok(cell) => self.take((&here, t_s, clock.sigma_s), cell, line).map_err(|(kind, what)| {
                    let column = Some(columns.name(cell.index).to_owned());
                    (kind, Problem { line, column, what, is_end: false })
                }),
                Err(fault) => Err(fault),
            };
            match placed {
                Ok(reading) => sink.take(&reading)?,
                Err((kind, problem)) => self.refuse(kind, &problem, cells, sink)?,
            }
        }
        Ok(())
    }

    fn refuse(
        &mut self,
        kind: Kind,
        problem: &Problem,
        cells: &StringRecord,
        sink: &mut dyn Sink,
    ) -> anyhow::Result<()> {
        self.faults.note(kind, problem);
        sink.refuse(problem, &cells.iter().collect::<Vec<_>>())
    }

    /// Places a reading.
    fn take(
        &mut self,
        (here, t_s, sigma_s): (&Whereabouts<'_>, f64, f64),
        cell: Cell,
        line: u64,
    ) -> Result<account::Reading, (Kind, String)> {
        let Options { first_channel, from_left, .. } = *self.options;
        let count = self.run.sampling.channels;
        let channel = cell.channel.checked_sub(first_channel).filter(|channel| *channel < count);
        let Some(channel) = channel else {
            let last = first_channel + (count - 1);
            let from_1 = first_channel == 0 && cell.channel == count;
            let remedy = if from_1 { "; if the file counts from 1, add --first-channel 1" } else { "" };
            let what = format!(
                "channel {}: the instrument has channels {first_channel} to {last} (instrument.channels){remedy}",
                cell.channel
            );
            return Err(("channels", what));
        };
        let channel = if from_left { count - 1 - channel } else { channel };
        self.order.take(line, channel, t_s, here.way_m).map_err(|misplaced| match misplaced {
            Misplaced::Duplicate => {
                ("duplicated times", format!("channel {} has a reading at the same time already", cell.channel))
            }
            Misplaced::TooLate => (
                "far out of order",
                format!(
                    "channel {}: earlier than the 256 readings before it; sort the file by time, and see whether a part \
                     occurs twice",
                    cell.channel
                ),
            ),
        })?;
        let left_m = self.run.sampling.offset_m(channel, self.run.swath_m);
        let reading = here.reading(channel, left_m, sigma_s, cell.thickness_mm);
        self.uncounted += u64::from(!here.counts);
        self.sum_mm += cell.thickness_mm;
        let reading = account::Reading { is_testable: here.counts, ..reading };
        Ok(self.imported.add(self.run.floor, reading))
    }

    /// What is wrong with a time that is not on the track.
    fn beyond(&mut self, t_s: f64) -> (Kind, String) {
        let (from_s, to_s) = self.run.track.span_s().unwrap_or_default();
        let (least, most) = self.beyond_s.unwrap_or((t_s, t_s));
        self.beyond_s = Some((least.min(t_s), most.max(t_s)));
        // A time that is only just outside has no tenths.
        let shown = |by_s: f64| if by_s < 0.1 { format!("{by_s:.4} s") } else { format!("{by_s:.1} s") };
        if t_s < from_s {
            (BEFORE, format!("{} before the start of the run", shown(from_s - t_s)))
        } else {
            (AFTER, format!("{} after the end of the run", shown(t_s - to_s)))
        }
    }

    /// The clock of the file, whose first time is given.
    fn clock(&self, columns: &Columns, first: &str) -> anyhow::Result<Clock> {
        let written = Written::of(first);
        let marks: Vec<(f64, f64)> = self
            .options
            .marks
            .iter()
            .map(|(text, mission_s)| match columns.time_s(text) {
                Ok(file_s) => Ok((file_s, *mission_s)),
                Err(what) => Err(anyhow::Error::msg(format!("--mark {text}: {what}"))),
            })
            .collect::<Result<_, _>>()?;
        let began_s = match (written, self.run.began_s, marks.is_empty()) {
            (Written::Number, ..) | (_, _, false) => None,
            (Written::Dated, Some(began_s), true) => Some(began_s),
            (Written::OfDay, Some(began_s), true) => Some(began_s.rem_euclid(DAY_S)),
            (_, None, true) => {
                return Err(anyhow::Error::msg(
                    "the name of the run does not contain its start time, so dates cannot be matched; give a moment by \
                     both clocks: --mark TIME=MISSION_S",
                ));
            }
        };
        let known = Known {
            marks: &marks,
            offset_s: self.options.clock_offset_s,
            began_s,
            is_of_day: written == Written::OfDay,
            sigma_s: self.options.clock_sigma_s,
        };
        Clock::new(known).map_err(anyhow::Error::msg)
    }

    fn finish(self, columns: &Columns) -> anyhow::Result<Placed> {
        let readings = self.imported.summary(self.run.floor);
        if readings.count == 0 {
            return Err(anyhow::Error::msg(self.nothing_placed()));
        }
        self.check_unit(readings.count)?;
        let (order, channels) = (self.order, self.run.sampling.channels);
        let (out_of_order, first_out_of_order) = (order.late, order.first_late);
        let (lost, gaps) = order.finish(self.run.track, channels);
        Ok(Placed {
            rows: self.rows,
            readings,
            uncounted: self.uncounted,
            faults: self.faults,
            lost,
            gaps,
            out_of_order,
            first_out_of_order,
            ignored_columns: columns.ignored(),
            clock_offset_s: self.clock.map_or(0.0, |clock| clock.offset_s()),
            clock_drift_s_per_h: self.clock.map_or(0.0, |clock| clock.drift_s_per_h()),
            clock_sigma_s: self.clock.map_or(0.0, |clock| clock.sigma_s),
        })
    }

    /// Why no reading was placed.
    fn nothing_placed(&self) -> String {
        let Some((least_s, most_s)) = self
            .beyond_s
            .filter(|_| self.faults.kinds.keys().all(|kind| [BEFORE, AFTER].contains(kind)) && self.rows > 0)
        else {
            return match self.faults.listed.as_slice() {
                [] => "no readings".to_owned(),
                listed => format!("no reading could be used\n{}", listed.join("\n")),
            };
        };
        let (from_s, to_s) = self.run.track.span_s().unwrap_or_default();
        // The shift that would put the middle of the readings in the middle of the run.
        let off_s = f64::midpoint(from_s, to_s) - f64::midpoint(least_s, most_s);
        let zone_s = (off_s / HALF_HOUR_S).round() * HALF_HOUR_S;
        let is_zone = zone_s.abs() > 1.0 && (off_s - zone_s).abs() < NEAR_ZONE_S;
        let zone = format!(
            "; a clock in another time zone would be off by {} h: add --clock-offset {zone_s}",
            zone_s / 3600.0
        );
        format!(
            "all {} rows are outside the run: by the clock of the run, they are from {least_s:.1} to {most_s:.1} s, and \
             the run is from {from_s:.1} to {to_s:.1} s{}; or give a moment by both clocks: --mark TIME=MISSION_S",
            self.rows,
            if is_zone { zone.as_str() } else { "; add --clock-offset with the seconds to add" }
        )
    }

    /// Refuses readings whose mean would be near the nominal thickness in another unit.
    fn check_unit(&self, count: u64) -> anyhow::Result<()> {
        let nominal_mm = self.run.sampling.thickness_mm;
        let mean_mm = self.sum_mm / count as f64;
        let is_near = |mm: f64| (0.7..1.3).contains(&(mm / nominal_mm));
        let others =
            [("inches", 25.4), ("centimetres", 10.0), ("metres", 1e3), ("hundredths of an inch", 0.254)];
        let other =
            others.into_iter().find(|(_, factor)| is_near(mean_mm * factor)).filter(|_| !is_near(mean_mm));
        other.map_or(Ok(()), |(name, _)| {
            Err(anyhow::Error::msg(format!(
                "the readings are {mean_mm:.3} mm on average, and the floor is {nominal_mm} mm thick \
                 (instrument.thickness_mm): they seem to be in {name}; correct the unit"
            )))
        })
    }
}
