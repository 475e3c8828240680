//! `tankops events`: the lines of a journal, for `grep` and `jq`.

use crate::cli::EventsArgs;
use flight::failure::COMPLETE;
use foreign::plain_json;
use mission::EventKind;
use recording::{JournalLine, JournalReader, journal_of};
use report::print::warn_line;
use runs::find;
use serde::Deserialize;
use std::{
    io::{self, BufWriter, ErrorKind, Write},
    process::ExitCode,
};

/// The only part of a line that is parsed.
#[derive(Deserialize)]
struct Name<'a> {
    event: &'a str,
}

/// Prints the events of a run exactly as stored in its journal, one JSON object per line.
pub(crate) fn events(args: &EventsArgs) -> anyhow::Result<ExitCode> {
    let folder = find(&args.run, &args.logs.folder())?;
    let from_s = args.from.unwrap_or(0.0);
    let mut reader = JournalReader::open_near(&journal_of(&folder), from_s)?;
    let mut out = BufWriter::new(io::stdout().lock());
    let mut is_opened = false;
    // A journal can also be cut off exactly between two events.
    let mut stops_in = None;
    while let Some(line) = reader.next_line()? {
        is_opened = true;
        let t_s = line.event.t_s;
        let is_end = matches!(line.event.kind, EventKind::Ended { .. });
        stops_in = (!is_end).then_some(line.event.tick);
        if args.to.is_some_and(|to_s| t_s > to_s) {
            stops_in = None;
            break;
        }
        if t_s < from_s || !is_wanted(&line, &args.kind) {
            continue;
        }
        // The values stay the same; control characters are escaped.
        let text = String::from_utf8_lossy(line.raw);
        if let Err(error) = out.write_all(plain_json(&text).as_bytes()).and_then(|()| out.write_all(b"\n")) {
            return ended(&error);
        }
    }
    if let Err(error) = out.flush() {
        return ended(&error);
    }
    if !is_opened {
        return Err(reader.not_opened().into());
    }
    let stop = || stops_in.map(|tick| format!("it ends in tick {tick}"));
    if let Some(why) = reader.truncated().map(str::to_owned).or_else(stop) {
        warn_line(&format!("note: the journal is incomplete: {why}"));
    }
    Ok(ExitCode::from(COMPLETE))
}

fn is_wanted(JournalLine { raw, .. }: &JournalLine, kinds: &[String]) -> bool {
    let is_one = |name: Name| kinds.iter().any(|kind| kind == name.event);
    kinds.is_empty() || serde_json::from_slice(raw).is_ok_and(is_one)
}

/// A closed pipe (as with `head`) is not a fault.
fn ended(error: &io::Error) -> anyhow::Result<ExitCode> {
    match error.kind() {
        ErrorKind::BrokenPipe => Ok(ExitCode::from(COMPLETE)),
        kind => Err(io::Error::new(kind, format!("writing to stdout: {error}")).into()),
    }
}
