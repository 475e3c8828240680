//! Recomputes a located run from its readings.

use crate::Task;
use anyhow::Context;
use flight::failure::bad_input;
use mission::{Event, EventKind};
use recording::{JournalReader, journal_of, sha256};
use scenario::Scenario;
use std::path::Path;

/// The result of recomputing a located run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Again {
    /// Byte for byte the same journal, with this many events.
    Equal(usize),
    /// A journal that differs from this line on.
    Different {
        /// The number of the line, from 1.
        line: usize,
        /// The recorded line.
        recorded: String,
        /// The computed line.
        computed: String,
    },
    /// Nothing was recomputed, because the readings are missing or have changed; this is the reason.
    NoReadings(String),
}

/// Recomputes the located run in a folder from its readings, if the file of readings is still where it was.
///
/// # Errors
/// The journal cannot be read, has a different version, or belongs to a mission.
pub fn again(folder: &Path) -> anyhow::Result<Again> {
    let path = journal_of(folder);
    let mut reader = JournalReader::open(&path)?;
    let Some(EventKind::RunOpened(opened)) = reader.next_line()?.map(|line| line.event.kind) else {
        return Err(reader.not_opened().into());
    };
    let measured = opened.measured.context("the run is a mission, not located readings")?;
    let file = Path::new(&measured.file);
    match sha256(file) {
        Ok(now) if now == measured.sha256 => {}
        Ok(now) => {
            let (file, then) = (&measured.file, &measured.sha256);
            return Ok(Again::NoReadings(format!(
                "{file} has a different SHA-256: expected {then}, found {now}"
            )));
        }
        Err(error) => return Ok(Again::NoReadings(format!("{}: {error}", measured.file))),
    }
    let scenario = Scenario::parse(&opened.scenario_toml, "the scenario in the journal")
        .map_err(|errors| bad_input(errors.render()))?;
    let asked = &measured.asked;
    let task = Task {
        file,
        shown: &measured.file,
        scenario: &scenario,
        sound_speed_m_s: asked.sound_speed_m_per_s,
        finds_sound_speed: asked.finds_sound_speed,
        finds_clock_offset: asked.finds_clock_offset,
        skips_bad_rows: asked.skips_bad_rows,
        tool_on: None,
    };
    let mut survey = task.survey()?;
    survey.tool_on_s.clone_from(&measured.tool_on_s);
    let mut compared = Compared { reader: JournalReader::open(&path)?, lines: 0, found: None };
    task.locate(&survey, |events| events.iter().for_each(|event| compared.take(event)))?;
    compared.finish()
}

/// Compares a journal with the computed events.
struct Compared {
    reader: JournalReader,
    lines: usize,
    found: Option<anyhow::Result<Again>>,
}

impl Compared {
    fn take(&mut self, event: &Event) {
        if self.found.is_none() {
            self.found = self.difference(event).transpose();
        }
    }

    fn difference(&mut self, event: &Event) -> anyhow::Result<Option<Again>> {
        let computed = serde_json::to_string(event).context("writing an event as JSON")?;
        let recorded = self.reader.next_line()?.map(|line| String::from_utf8_lossy(line.raw).into_owned());
        self.lines += 1;
        let recorded = recorded.unwrap_or_else(|| "no further event".to_owned());
        Ok((recorded != computed).then_some(Again::Different { line: self.lines, recorded, computed }))
    }

    fn finish(mut self) -> anyhow::Result<Again> {
        if let Some(found) = self.found {
            return found;
        }
        let more = self.reader.next_line()?.map(|line| String::from_utf8_lossy(line.raw).into_owned());
        Ok(match more {
            Some(recorded) => {
                Again::Different { line: self.lines + 1, recorded, computed: "no further event".to_owned() }
            }
            None => Again::Equal(self.lines),
        })
    }
}
