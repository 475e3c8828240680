//! Recomputes a past run and proves that the result equals its journal.
//!
//! One pass makes two proofs. *Mission*: the simulator and the mission receive the recorded orders, and the recorded
//! answers of the planners in the ticks in which the answers arrived. Every line must then be reproduced, byte for
//! byte. This is always possible, whatever happened to the planners during the run. *Planners*: each ask also goes to a
//! planner, whose answer must equal the recorded one. Some faults depend on the machine and not on the ask: a planner
//! is killed or stopped, answers too late, or is disturbed by a thread that it left behind. Such faults are taken from
//! the journal and counted. A fault that occurs again in a different tick counts as the same fault.
//!
//! The journal is read tick by tick; memory use does not grow with its length.

mod difference;
pub(crate) mod planners;

use crate::{flown::Flown, register};
use anyhow::Context;
use flight::{Flight, failure::bad_input, hosts::host, planners::found};
use mission::{PlannerInfo, event::Measured};
use planner_host::PluginDirs;
use planners::{Asked, BEHIND, Replayed};
use recording::{
    Difference, JournalError, RecordedTick, Ticks,
    ahead::{self, Giver},
    journal_of,
};
use report::document::{Recovered, Revision, SignedRun};
use runs::{Past, Proof, Signatures, end_is_missing, signatures, signed_under_another_name};
use scenario::Scenario;
use std::{
    collections::{BTreeMap, BTreeSet},
    path::Path,
    sync::mpsc::sync_channel,
    thread::{self, ScopedJoinHandle},
    time::SystemTime,
};

/// Maximum number of ticks in a batch, and the number of bytes of lines that ends a batch earlier.
const BATCH: usize = 64;
const BATCH_BYTES: u64 = 1 << 18;
/// Size of the read-ahead queue, bytes of lines.
const AHEAD_BYTES: u64 = 1 << 20;

/// The findings of a verification.
#[derive(Debug, Default)]
struct Findings {
    /// The first line that differs when recomputed.
    difference: Option<Difference>,
    /// Values that events lack because an earlier build, which did not record them, wrote the journal; as `tethered.measured`.
    unrecorded: BTreeSet<String>,
    /// A doubt about the files as a whole.
    doubt: Option<String>,
    /// Whether a report contains the digests of the journal and the recording.
    is_reported: bool,
    /// The recovery of the run, if its recording process was killed.
    recovered: Option<Recovered>,
    /// The reason why the journal has no end; the journal is compared up to that point.
    no_end: Option<String>,
    /// The result of asking the planners again; `None` if they were not asked.
    planners: Option<Asked>,
    /// The signed reports on the run, as lines.
    signed: Vec<String>,
    /// The doubts about the signed reports.
    not_as_signed: Vec<String>,
    /// The planners of the run, by id.
    builds: BTreeMap<String, PlannerInfo>,
    events: usize,
    last_tick: u64,
    /// Whether the run was live; its readings are then taken from the journal.
    is_live: bool,
}

/// The result of a verification.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Verified {
    /// Whether the whole run was recomputed and equals its record.
    pub is_equal: bool,
    /// Whether the run consists of located readings, so that nothing was recomputed.
    pub is_located: bool,
    /// The findings as lines for people.
    pub lines: Vec<String>,
    /// The findings in one line, for a message that names the run.
    pub brief: String,
}

/// Verifies the run in a folder. With plugins, the planners are also asked again; an equal run is then marked
/// as verified in its folder.
///
/// Takes about as long as computing the mission took, without waiting for the clock.
///
/// # Errors
/// Its journal cannot be read, or has a different version.
pub fn verify(folder: &Path, plugins: &PluginDirs, from_journal: bool) -> anyhow::Result<Verified> {
    if let Some(measured) = Ticks::open(&journal_of(folder))?.opened()?.measured.clone() {
        return verify_located(folder, &measured);
    }
    // If the journal cannot be read, the code below reports the error and its position.
    let proof = (!from_journal).then(|| Proof::begin(folder)).transpose();
    let findings = findings(folder, (!from_journal).then_some(plugins))?;
    let (is_equal, mut lines) = (findings.are_equal(), lines(&findings, plugins));
    let mut brief = brief(&findings, &lines);
    if is_equal && let Some(proof) = proof? {
        let not_kept = proof.keep(folder, SystemTime::now()).err();
        let not_kept =
            not_kept.map(|error| format!("note: the run could not be marked as verified: {error}"));
        brief.extend(not_kept.iter().map(|note| format!("; {note}")));
        lines.extend(not_kept);
    }
    Ok(Verified { is_equal, is_located: false, lines, brief })
}

/// Verifies located readings: there is no mission to recompute, so only files and signed reports are compared.
fn verify_located(folder: &Path, Measured { file, sha256, .. }: &Measured) -> anyhow::Result<Verified> {
    let past = Past::read(folder)?.run;
    let (signed, not_as_signed) = signed(folder, &SignedRun::names_of(&past));
    let is_equal = past.files.doubts.is_empty() && not_as_signed.is_empty();
    let mut lines: Vec<String> =
        past.files.doubts.iter().map(|doubt| format!("different: {doubt}")).collect();
    if past.files.are_as_reported == Some(true) {
        lines.push("equal: the journal and the recording have the SHA-256 stated in report.json".into());
    }
    if past.files.are_as_reported.is_none() {
        lines.push(
            "note: report.json is missing or does not state the digests of the journal and the recording, \
             so the files were not checked"
                .into(),
        );
    }
    lines.push(format!("note: not a mission: the readings in {file} were located (SHA-256 {sha256})"));
    lines.extend(signed);
    lines.extend(not_as_signed.iter().map(|doubt| format!("NOT AS SIGNED: {doubt}")));
    let brief = lines.join("; ");
    Ok(Verified { is_equal, is_located: true, lines, brief })
}

/// Verifies the run in a folder and returns the finding in one line.
///
/// # Errors
/// Its journal cannot be read, or the recomputed run differs.
pub fn verdict(folder: &Path, plugins: &PluginDirs) -> anyhow::Result<String> {
    let Verified { is_equal, brief, .. } = verify(folder, plugins, false)?;
    if is_equal { Ok(brief) } else { anyhow::bail!(brief) }
}

fn findings(folder: &Path, plugins: Option<&PluginDirs>) -> anyhow::Result<Findings> {
    thread::scope(|scope| {
        let files =
            scope.spawn(|| Past::read(folder).map(|past| (SignedRun::names_of(&past.run), past.run.files)));
        let findings = compare(&journal_of(folder), plugins)?;
        let (now, files) =
            files.join().map_err(|_| anyhow::anyhow!("panicked while reading the files of the run"))??;
        let (signed, not_as_signed) = signed(folder, &now);
        let missing_end = || findings.no_end.as_ref().and_then(|_| end_is_missing(folder));
        let doubt = files.doubts.into_iter().next().or_else(missing_end);
        let is_reported = files.are_as_reported.is_some();
        let recovered = files.recovered;
        Ok(Findings { doubt, is_reported, recovered, signed, not_as_signed, ..findings })
    })
}

/// The signed reports on a run as lines, and all doubts: about these reports, and about whether this run is the one
/// that was signed.
fn signed(folder: &Path, now: &[SignedRun]) -> (Vec<String>, Vec<String>) {
    let Signatures { revisions, mut doubts, notes } = signatures(folder, &register());
    doubts.extend(revisions.iter().filter_map(|revision| now.iter().find_map(|run| revision.doubt(run))));
    doubts.extend(now.iter().find_map(|run| signed_under_another_name(folder, &register(), run)));
    let line = |revision: &Revision| {
        let (letter, signature) = (&revision.revision, &revision.signature);
        format!("signed: revision {letter} by {}, {} UTC: {}", signature.by, signature.at, revision.file)
    };
    let notes = notes.into_iter().map(|note| format!("note: {note}"));
    (revisions.iter().map(line).chain(notes).collect(), doubts)
}

impl Findings {
    /// The first difference in a planner's answers.
    fn other_answer(&self) -> Option<&String> {
        self.planners.as_ref().and_then(|asked| asked.difference.as_ref())
    }

    /// The place and the fault, if a planner had an external or timing fault although it did not fail in the run.
    fn unproven(&self) -> Option<&String> {
        self.planners.as_ref().and_then(|asked| asked.unproven.as_ref())
    }

    fn are_equal(&self) -> bool {
        self.is_run_equal() && self.not_as_signed.is_empty()
    }

    /// Whether everything except the signed reports is unchanged.
    fn is_run_equal(&self) -> bool {
        self.difference.is_none()
            && self.unrecorded.is_empty()
            && self.doubt.is_none()
            && self.other_answer().is_none()
            && self.unproven().is_none()
    }
}

/// The findings as lines for people.
fn lines(findings: &Findings, plugins: &PluginDirs) -> Vec<String> {
    let Findings { difference, doubt, no_end, planners, events, last_tick, .. } = findings;
    let mut lines = Vec::new();
    if !findings.is_reported && no_end.is_none() {
        lines.push(
            "note: report.json is missing or does not state the digests of the journal and the recording, \
             so the recording was not checked"
                .into(),
        );
    }
    if let Some(recovered) = &findings.recovered {
        lines
            .push(format!("note: the run was not closed when it ended, and was later recovered {recovered}"));
    }
    if let Some(why) = no_end {
        lines
            .push(format!("note: the journal is incomplete ({why}); only the part that exists was compared"));
    }
    if let Some(difference) = difference {
        lines.push(difference::text(difference));
    } else if let Some(doubt) = doubt {
        lines.push(format!("different: {doubt}; the {events} events up to tick {last_tick} were recomputed"));
    }
    if !findings.unrecorded.is_empty() && difference.is_none() {
        let missing = findings.unrecorded.iter().map(String::as_str).collect::<Vec<_>>().join(", ");
        lines.push(format!(
            "different: written by an earlier build, which did not record {missing}; all else is identical in the {events} \
             events from tick 0 to tick {last_tick}"
        ));
    }
    lines.extend(planners.iter().flat_map(|asked| &asked.external).map(|(planner, count)| {
        format!("note: external or timing faults of planner {planner}, taken from the journal: {count}")
    }));
    if let Some(why) = findings.unproven().filter(|_| findings.other_answer().is_none()) {
        lines.push(format!(
            "not proven: at {why}, a planner had an external or timing fault that did not occur in the run \
             (verify again); the mission itself was reproduced from the recorded answers"
        ));
    }
    if let Some(why) = findings.other_answer() {
        lines.push(format!("different: {why}; the mission itself was reproduced from the recorded answers"));
    }
    if difference.is_some() || !findings.unrecorded.is_empty() || findings.other_answer().is_some() {
        lines.extend(planner_changes(&findings.builds, plugins).iter().map(|note| format!("note: {note}")));
    }
    if findings.is_live {
        lines.push(
            "note: live run: the readings of the vehicle were taken from the journal; every decision was recomputed from them"
                .into(),
        );
    }
    if findings.is_run_equal() {
        // A report counts the ticks after the first one, which has the number 0.
        let how = match (planners.is_some(), findings.is_live) {
            (true, false) => "",
            (true, true) => " from the recorded readings",
            (false, false) => " from the recorded answers",
            (false, true) => " from the recorded readings and answers",
        };
        lines.push(format!(
            "equal: all {events} events identical when recomputed{how}, from tick 0 to tick {last_tick}; {}",
            proven(planners.as_ref())
        ));
    }
    lines.extend(findings.signed.iter().cloned());
    lines.extend(findings.not_as_signed.iter().map(|doubt| format!("NOT AS SIGNED: {doubt}")));
    lines
}

/// The findings in one line: of an equal run, how much is identical, and the notes.
fn brief(findings: &Findings, lines: &[String]) -> String {
    if !findings.are_equal() {
        return lines.join("; ");
    }
    let events = findings.events;
    let first = match &findings.planners {
        Some(Asked { same, .. }) => {
            format!("verified: all {events} events and {same} planner answers identical")
        }
        None => format!("verified: all {events} events identical; the planners were not asked"),
    };
    let notes = lines.iter().filter(|line| line.starts_with("note:")).cloned();
    std::iter::once(first).chain(notes).collect::<Vec<_>>().join("; ")
}

/// The statement on the planners of a run that was reproduced.
fn proven(planners: Option<&Asked>) -> String {
    let Some(Asked { same, not_comparable, too_early, .. }) = planners else {
        return "the planners were not asked (--from-journal): their answers, drawings and log lines are not \
            proven"
            .into();
    };
    let refused = match not_comparable {
        0 => String::new(),
        n => format!(", {n} that the mission refused or did not use cannot be compared"),
    };
    let failed = match too_early {
        0 => String::new(),
        n => format!(", {n} from a planner that failed earlier than it did in the run cannot be compared"),
    };
    format!("{same} planner answers identical{refused}{failed}")
}

/// The run in a journal, ready to be recomputed.
pub(crate) fn prepared(path: &Path, ticks: &mut Ticks) -> anyhow::Result<(Scenario, Flown)> {
    let opened = ticks.opened()?.clone();
    if let Some(Measured { file, .. }) = &opened.measured {
        return Err(bad_input(format!(
            "not a mission: the readings in {file} were located; `tankops locate` computes them again: {}",
            path.display()
        )));
    }
    let mut scenario = Scenario::recorded(&opened.scenario_toml, "the scenario in the journal")
        .map_err(|errors| bad_input(errors.render()))?;
    // Only an operator at the console sees the plan before the start.
    scenario.mission.start_names_plan = opened.mission.start_names_plan;
    let flight = Flight::prepare(&scenario, opened.mission.attended);
    let flown = Flown::of(flight, &scenario, opened.vehicle.as_deref());
    Ok((scenario, flown))
}

fn compare(path: &Path, plugins: Option<&PluginDirs>) -> anyhow::Result<Findings> {
    let mut ticks = Ticks::open(path)?;
    let (scenario, flight) = prepared(path, &mut ticks)?;
    let (giver, read) = ahead::queue(AHEAD_BYTES);
    thread::scope(|scope| {
        let reading = scope.spawn(move || read_ahead(ticks, &giver));
        let (again, asking) = plugins
            .map(|plugins| {
                let ((again, updates), scenario) = (sync_channel(BEHIND), &scenario);
                (again, scope.spawn(move || Asked::of(host(scenario, plugins), &updates)))
            })
            .unzip();
        let findings = recompute(flight, Replayed::sending_to(again), read.flatten());
        let no_end = reading.join().map_err(|_| anyhow::anyhow!("panicked while reading the journal"))?;
        let asked = asking.map(ScopedJoinHandle::join).transpose();
        let planners = asked.map_err(|_| anyhow::anyhow!("panicked while asking the planners"))?;
        Ok(Findings { no_end, planners, ..findings? })
    })
}

/// Reads a journal ahead of the comparison, up to its end, an error, or the first difference; returns the reason why
/// it has no end.
fn read_ahead(mut ticks: Ticks, giver: &Giver<Vec<Result<RecordedTick, JournalError>>>) -> Option<String> {
    loop {
        let (mut batch, mut bytes, mut is_last) = (Vec::new(), 0, false);
        while !is_last && batch.len() < BATCH && bytes < BATCH_BYTES {
            let tick = ticks.next_tick().transpose();
            is_last = tick.as_ref().is_none_or(Result::is_err);
            bytes += tick.iter().flatten().map(RecordedTick::bytes).sum::<u64>();
            batch.extend(tick);
        }
        if !giver.give(batch, bytes) || is_last {
            return ticks.no_end();
        }
    }
}

/// Recomputes the mission alongside its journal, up to the first difference. An event that only lacks values which an
/// earlier build did not record does not end the comparison.
fn recompute(
    mut flight: Flown,
    mut replayed: Replayed,
    read: impl Iterator<Item = Result<RecordedTick, JournalError>>,
) -> anyhow::Result<Findings> {
    let mut findings = Findings { is_live: flight.is_live(), ..Findings::default() };
    let mut head = vec![flight.opened()];
    for recorded in read {
        let recorded = recorded?;
        replayed.begin_tick(&recorded);
        findings.builds.extend(recorded.opened_planners().map(|info| (info.id.clone(), info.clone())));
        let mut computed = std::mem::take(&mut head);
        computed.extend(flight.tick(&recorded, &mut replayed));
        for difference in recorded.differences(&computed) {
            let difference = difference.context("writing an event as JSON")?;
            if let Some(missing) = difference::unrecorded(&difference) {
                findings.unrecorded.extend(missing);
            } else {
                findings.difference = Some(difference);
                break;
            }
        }
        findings.events += recorded.n_compared();
        findings.last_tick = recorded.tick;
        if findings.difference.is_some() {
            break;
        }
    }
    Ok(findings)
}

/// Planners of the run whose plugin file is missing or has changed.
fn planner_changes(builds: &BTreeMap<String, PlannerInfo>, plugins: &PluginDirs) -> Vec<String> {
    let now = found(plugins).planners;
    let changed = |(id, then): (&String, &PlannerInfo)| match now.iter().find(|info| info.id == *id) {
        None => Some(format!("planner {id} of the run is not installed; --from-journal does not need it")),
        Some(info) if info.sha256 != then.sha256 => Some(format!(
            "planner {id} is not the build used in the run (version {}); --from-journal does not need it",
            then.version
        )),
        Some(_) => None,
    };
    builds.iter().filter_map(changed).collect()
}

#[cfg(test)]
mod tests;
