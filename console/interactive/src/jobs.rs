//! Background jobs on past runs, each on a separate thread.

use super::{desk::Tools, inbox::Outbox};
use anyhow::{Context, bail};
use mission::Severity;
use recording::RECORDING_FILE;
use review::{report_page, verdict};
use std::{
    io,
    path::Path,
    process::{Command, Stdio},
    thread,
};
use tui::{Job, Msg};

/// The file name of the report in a run folder.
const PAGE: &str = "report.html";

/// Starts a job; its result is reported to the screen.
pub(super) fn begin(job: Job, tools: &Tools) {
    let (tools, outbox) = (tools.clone(), tools.outbox.clone());
    let began = thread::Builder::new().name("job".into()).spawn(move || {
        let done = carry_out(&job, &tools).map_err(|error| format!("{error:#}"));
        tools.outbox.send(Msg::Done(job, done));
    });
    if let Err(error) = began {
        report(&outbox, &format!("job failed to start: {error}"));
    }
}

/// Notifies the operator that background work failed.
pub(super) fn report(outbox: &Outbox, text: &str) {
    outbox.send(Msg::Notice { severity: Severity::Warn, text: text.to_owned() });
}

fn carry_out(job: &Job, Tools { logs, plugins, .. }: &Tools) -> anyhow::Result<String> {
    let folder = runs::find(job.run().as_ref(), logs)?;
    match job {
        Job::Verify(_) => verdict(&folder, plugins),
        Job::Report(_) => {
            let (file, text) = (folder.join(PAGE), report_page(&folder)?);
            runs::write_whole(&file, text.as_bytes()).context("writing the report")?;
            Ok(format!("draft report written: {}", file.display()))
        }
        Job::View(_) => view(&folder.join(RECORDING_FILE)),
        // The viewer accepts a start time only with the address of a server, not with a file.
        Job::ViewAt(_, at) => {
            let opened = view(&folder.join(RECORDING_FILE)).with_context(|| format!("at {at}"))?;
            Ok(format!("{opened}; go to {at} there"))
        }
    }
}

/// Opens a recording in the viewer, which stays open when the operator leaves the console.
fn view(recording: &Path) -> anyhow::Result<String> {
    if !recording.is_file() {
        bail!("no recording: {}", recording.display());
    }
    let viewer = Command::new("rerun")
        .arg(recording)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn();
    match viewer {
        Ok(mut viewer) => {
            thread::spawn(move || viewer.wait());
            Ok(format!("opened in rerun: {}", recording.display()))
        }
        Err(error) => {
            let why = match error.kind() {
                io::ErrorKind::NotFound => {
                    "rerun is not on the PATH; install it with `pip install rerun-sdk==0.36.3`".to_owned()
                }
                _ => format!("cannot start rerun: {error}"),
            };
            bail!("{why}; the recording is at {}", recording.display())
        }
    }
}
