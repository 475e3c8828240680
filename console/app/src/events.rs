//! `tankops events`: the lines of a journal, for `grep`, `jq` and programs that watch a run.

mod socket;

use crate::cli::EventsArgs;
use flight::failure::{COMPLETE, bad_input};
use mission::EventKind;
use recording::{JournalReader, journal_of};
use report::print::warn_line;
use review::{Selection, StreamEnd, printed, stream};
use runs::find;
use std::{
    io::{self, BufWriter, ErrorKind, Write},
    process::ExitCode,
    time::Duration,
};

/// Prints the events of a run exactly as stored in its journal, one JSON object per line.
pub(crate) fn events(args: &EventsArgs) -> anyhow::Result<ExitCode> {
    check_kinds(&args.kind)?;
    let folder = find(&args.run, &args.logs.folder())?;
    let selection = Selection { kinds: args.kind.clone(), from_s: args.from.unwrap_or(0.0), to_s: args.to };
    let heartbeat = Duration::from_secs_f64(args.heartbeat);
    if let Some(at) = &args.socket {
        return socket::serve((at, args.socket_network), &folder, &selection, heartbeat);
    }
    if args.follow {
        return match stream(&folder, &selection, heartbeat, io::stdout())? {
            StreamEnd::Complete => Ok(ExitCode::from(COMPLETE)),
            StreamEnd::Incomplete(None) => {
                Err(JournalReader::open(&journal_of(&folder))?.not_opened().into())
            }
            StreamEnd::Incomplete(Some(tick)) => Ok(incomplete(&format!("it ends in tick {tick}"))),
            StreamEnd::Closed(error) => ended(&error),
        };
    }
    past(JournalReader::open_near(&journal_of(&folder), selection.from_s)?, &selection)
}

/// Refuses kinds of event that no journal contains.
fn check_kinds(kinds: &[String]) -> anyhow::Result<()> {
    let known = EventKind::names();
    match kinds.iter().find(|kind| !known.contains(&kind.as_str())) {
        None => Ok(()),
        Some(kind) => Err(bad_input(format!(
            "--kind {kind}: unknown kind of event; the known kinds are {}",
            known.join(", ")
        ))),
    }
}

/// Prints the events that are in the journal now.
fn past(mut reader: JournalReader, selection: &Selection) -> anyhow::Result<ExitCode> {
    let mut out = BufWriter::new(io::stdout().lock());
    let mut is_opened = false;
    // A journal can also be cut off exactly between two events.
    let mut stops_in = None;
    while let Some(line) = reader.next_line()? {
        is_opened = true;
        let is_end = matches!(line.event.kind, EventKind::Ended { .. });
        stops_in = (!is_end).then_some(line.event.tick);
        if selection.is_past(line.event.t_s) {
            stops_in = None;
            break;
        }
        if !selection.contains(&line) {
            continue;
        }
        if let Err(error) = out.write_all(printed(&line).as_bytes()) {
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
    let why = reader.truncated().map(str::to_owned).or_else(stop);
    Ok(why.map_or(ExitCode::from(COMPLETE), |why| incomplete(&why)))
}

fn incomplete(why: &str) -> ExitCode {
    warn_line(&format!("note: the journal is incomplete: {why}"));
    ExitCode::from(COMPLETE)
}

/// A closed pipe (as with `head`) is not a fault.
fn ended(error: &io::Error) -> anyhow::Result<ExitCode> {
    match error.kind() {
        ErrorKind::BrokenPipe => Ok(ExitCode::from(COMPLETE)),
        kind => Err(io::Error::new(kind, format!("writing to stdout: {error}")).into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_unknown_kind_is_refused_with_the_known_ones() {
        assert!(check_kinds(&["held".to_owned(), "ended".to_owned()]).is_ok());
        let refused =
            check_kinds(&["held".to_owned(), "nosuch".to_owned()]).expect_err("unknown").to_string();
        assert!(
            refused.starts_with("--kind nosuch: unknown kind of event; the known kinds are "),
            "{refused}"
        );
        assert!(refused.contains(", held, ") && refused.contains("planner_chosen"), "{refused}");
    }
}
