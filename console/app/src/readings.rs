//! `tankops readings RUN FILE`: places the readings of an instrument on the track of a run.

mod words;

use crate::{cli::ReadingsArgs, input};
use ::locate::{
    Problem,
    thickness::{Gap, Options, Placed, Scanned, Sink, place},
};
use account::{Reading, Silence};
use anyhow::Context;
use command::json::say_json;
use flight::failure::{COMPLETE, bad_input};
use recording::{READINGS_FILE, ReadingsWriter, sha256};
use report::{
    ImportedReadings,
    document::csv::cell,
    print::{say, say_line, warn_line},
};
use runs::{IMPORT_FILE, find, write_import};
use std::{
    fs::{self, File},
    io::{BufWriter, Write},
    path::{Path, PathBuf},
    process::ExitCode,
    time::UNIX_EPOCH,
};

/// The rows that were refused, in the folder of the run.
const REFUSED_FILE: &str = "readings-refused.csv";

/// Runs `tankops readings RUN FILE`.
pub(crate) fn readings(args: &ReadingsArgs) -> anyhow::Result<ExitCode> {
    let folder = find(&args.run, &args.logs.folder())?;
    let file = input::file(&args.file)?;
    refuse_existing(&folder, args.force)?;
    let (fold, track, cut) = review::track(&folder)?;
    if fold.survey().is_some() {
        return Err(bad_input(format!(
            "{}: the floor of this run was simulated ([wear]), and so were its readings; real ones belong to a run without \
             [wear]",
            folder.display()
        )));
    }
    let run = fold.run().zip(fold.scanned());
    let sampled =
        run.and_then(|(run, scanned)| Some((run.mission.instrument.as_ref()?.sampling?, run, scanned)));
    let Some((sampling, run, scanned)) = sampled else {
        return Err(bad_input(format!(
            "{}: the scenario of this run does not state how the instrument reads; add channels, pitch_m, thickness_mm, \
             sigma_mm and threshold to [instrument] before the run",
            folder.display()
        )));
    };
    let name = folder.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let began = runs::began(&name).and_then(|began| began.duration_since(UNIX_EPOCH).ok());
    let scanned = Scanned {
        track: &track,
        floor: scanned.believed().floor(),
        sampling,
        swath_m: run.mission.swath_m,
        began_s: began.map(|began| began.as_secs_f64().floor()),
    };
    let options = Options {
        unit: args.unit,
        clock_offset_s: args.clock_offset,
        marks: &args.mark,
        clock_sigma_s: args.clock_sigma,
        first_channel: args.first_channel,
        from_left: args.from_left,
    };
    let mut files = Files::create(&folder)?;
    let placed = place(file.path(), &scanned, &options, &mut files);
    let placed = placed.map_err(|error| bad_input(format!("{}: {error}", file.shown())))?;
    if placed.faults.count() > 0 && !args.skip_bad_rows {
        return Err(bad_input(words::refused(file.shown(), &placed)));
    }
    let readings_sha256 = files.keep(&folder, placed.faults.count() > 0)?;
    let import = ImportedReadings {
        file: cell(&args.file.file_name().unwrap_or_default().to_string_lossy()),
        file_sha256: sha256(file.path()).with_context(|| format!("reading {}", file.shown()))?,
        readings_sha256,
        by: format!("tankops {}", env!("CARGO_PKG_VERSION")),
        silences: placed.gaps.iter().map(silence).collect(),
        notes: words::notes(&placed),
    };
    write_import(&folder, &import)
        .with_context(|| format!("writing {}", folder.join(IMPORT_FILE).display()))?;
    if let Some(cut) = cut {
        warn_line(&format!(
            "the journal ends early ({cut}); readings after that point are after the end of the run"
        ));
    }
    said(args, &folder, &placed)?;
    Ok(ExitCode::from(COMPLETE))
}

/// A gap as the account of the floor needs it.
fn silence(gap: &Gap) -> Silence {
    Silence { channels: gap.channels.clone(), from_s: gap.from_s, to_s: gap.to_s }
}

fn said(args: &ReadingsArgs, folder: &Path, placed: &Placed) -> anyhow::Result<()> {
    if args.json {
        return say_json("the results", placed);
    }
    say(&words::human(placed))?;
    Ok(say_line(&format!(
        "readings kept in {}; `tankops report` shows them",
        folder.join(READINGS_FILE).display()
    ))?)
}

fn refuse_existing(folder: &Path, force: bool) -> anyhow::Result<()> {
    let file = folder.join(READINGS_FILE);
    if !force && fs::exists(&file).unwrap_or(false) {
        return Err(bad_input(format!(
            "the run has readings already; --force replaces them: {}",
            file.display()
        )));
    }
    Ok(())
}

/// The files with the readings and with the refused rows, under names of drafts until they are complete.
struct Files {
    readings: Option<ReadingsWriter>,
    refused: BufWriter<File>,
    drafts: [PathBuf; 2],
}

impl Files {
    fn create(folder: &Path) -> anyhow::Result<Self> {
        let drafts = [READINGS_FILE, REFUSED_FILE].map(|name| folder.join(format!("{name}.part")));
        for draft in &drafts {
            // What an interrupted import left behind.
            let _ = fs::remove_file(draft);
        }
        let refused = File::create_new(&drafts[1]);
        let refused = refused.with_context(|| format!("writing {}", drafts[1].display()))?;
        let mut files = Self {
            readings: Some(ReadingsWriter::create(&drafts[0])?),
            refused: BufWriter::new(refused),
            drafts,
        };
        writeln!(files.refused, "line,column,fault,row")?;
        Ok(files)
    }

    /// Gives the files their names; returns the SHA-256 of the readings.
    fn keep(mut self, folder: &Path, has_refused: bool) -> anyhow::Result<String> {
        let sha256 = self.readings.take().map(ReadingsWriter::finish).transpose()?.unwrap_or_default();
        self.refused.flush()?;
        let _ = fs::remove_file(folder.join(REFUSED_FILE));
        if has_refused {
            fs::rename(&self.drafts[1], folder.join(REFUSED_FILE))?;
        }
        fs::rename(&self.drafts[0], folder.join(READINGS_FILE))?;
        Ok(sha256)
    }
}

impl Drop for Files {
    fn drop(&mut self) {
        self.drafts.iter().for_each(|draft| {
            let _ = fs::remove_file(draft);
        });
    }
}

impl Sink for Files {
    fn take(&mut self, reading: &Reading) -> anyhow::Result<()> {
        self.readings.as_mut().map_or(Ok(()), |readings| Ok(readings.write(std::slice::from_ref(reading))?))
    }

    fn refuse(&mut self, problem: &Problem, row: &[&str]) -> anyhow::Result<()> {
        let quoted = |text: &str| format!("\"{}\"", cell(text).replace('"', "\"\""));
        let column = problem.column.as_deref().unwrap_or_default();
        let row = row.join(";");
        let texts = [column, &problem.what, &row].map(quoted);
        Ok(writeln!(self.refused, "{},{}", problem.line, texts.join(","))?)
    }
}
