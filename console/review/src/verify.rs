//! Compute a past run again and prove that its journal is equal.
//!
//! Two proofs are made in one pass. *Mission*: simulator and mission are given the recorded orders and the recorded answers
//! of the planners in the ticks in which they arrived, and every line must come out again, byte for byte. This is always
//! possible, whatever the machine did to the planners while the run was flown. *Planners*: each ask also goes to a planner,
//! and its answer must be the recorded one. When a planner is killed, stopped, too late, or disturbed by a thread that it left
//! behind, is decided by the machine and not by what it is asked: such faults are taken from the journal and counted, and one
//! that comes in another tick than then is the same fault.
//!
//! The journal is read tick by tick; memory does not grow with it.

pub(crate) mod planners;

use crate::register;
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
use runs::{Past, Signatures, end_is_missing, signatures, signed_under_another_name};
use scenario::Scenario;
use std::{
    collections::BTreeMap,
    path::Path,
    sync::mpsc::sync_channel,
    thread::{self, ScopedJoinHandle},
};

/// Ticks that are read together, and after so many bytes of lines no more.
const BATCH: usize = 64;
const BATCH_BYTES: u64 = 1 << 18;
/// What is read ahead, bytes of lines.
const AHEAD_BYTES: u64 = 1 << 20;

/// What was found.
#[derive(Debug, Default)]
struct Findings {
    /// The first line that is not recomputed.
    difference: Option<Difference>,
    /// What speaks against the file as a whole.
    doubt: Option<String>,
    /// Whether a report names the digests of journal and recording.
    is_reported: bool,
    /// How the run was closed if its writer was killed.
    recovered: Option<Recovered>,
    /// Why the journal has no end; what it holds up to there is compared.
    no_end: Option<String>,
    /// What the planners did when they were asked again; `None` if they were not.
    planners: Option<Asked>,
    /// The signed reports on the run, as lines.
    signed: Vec<String>,
    /// What speaks against them.
    not_as_signed: Vec<String>,
    /// The planners of the run, by id.
    builds: BTreeMap<String, PlannerInfo>,
    events: usize,
    last_tick: u64,
}

/// What a verification says.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Verified {
    /// Whether everything was recomputed as it is recorded.
    pub is_equal: bool,
    /// Whether nothing was flown, so that nothing was recomputed: readings were located.
    pub is_located: bool,
    /// What was found, in lines for people.
    pub lines: Vec<String>,
}

/// Verifies the run in a folder; with plugins, the planners are asked, too.
///
/// Costs about as much as flying the mission did, without waiting for the clock.
///
/// # Errors
/// Its journal cannot be read, or is of another version.
pub fn verify(folder: &Path, plugins: &PluginDirs, from_journal: bool) -> anyhow::Result<Verified> {
    if let Some(measured) = Ticks::open(&journal_of(folder))?.opened()?.measured.clone() {
        return verify_located(folder, &measured);
    }
    let findings = findings(folder, (!from_journal).then_some(plugins))?;
    Ok(Verified { is_equal: findings.are_equal(), is_located: false, lines: lines(&findings, plugins) })
}

/// Verifies readings that were located: nothing was flown, so that only files and signed reports are compared.
fn verify_located(folder: &Path, Measured { file, sha256, .. }: &Measured) -> anyhow::Result<Verified> {
    let past = Past::read(folder)?.run;
    let (signed, not_as_signed) = signed(folder, &SignedRun::names_of(&past));
    let is_equal = past.files.doubts.is_empty() && not_as_signed.is_empty();
    let mut lines: Vec<String> =
        past.files.doubts.iter().map(|doubt| format!("different: {doubt}")).collect();
    if past.files.are_as_reported == Some(true) {
        lines.push("equal: journal and recording have the SHA-256 that report.json names".into());
    }
    if past.files.are_as_reported.is_none() {
        lines.push(
            "note: no report.json names the digests of journal and recording, so they are not checked".into(),
        );
    }
    lines.push(format!("note: nothing was flown: the readings of {file} were located (SHA-256 {sha256})"));
    lines.extend(signed);
    lines.extend(not_as_signed.iter().map(|doubt| format!("NOT AS SIGNED: {doubt}")));
    Ok(Verified { is_equal, is_located: true, lines })
}

/// What is found of the run in a folder, in one line.
///
/// # Errors
/// Its journal cannot be read, or the run is different.
pub fn verdict(folder: &Path, plugins: &PluginDirs) -> anyhow::Result<String> {
    let Verified { is_equal, lines, .. } = verify(folder, plugins, false)?;
    let text = lines.join("; ");
    if is_equal { Ok(text) } else { anyhow::bail!(text) }
}

fn findings(folder: &Path, plugins: Option<&PluginDirs>) -> anyhow::Result<Findings> {
    thread::scope(|scope| {
        let files =
            scope.spawn(|| Past::read(folder).map(|past| (SignedRun::names_of(&past.run), past.run.files)));
        let findings = compare(&journal_of(folder), plugins)?;
        let (now, files) =
            files.join().map_err(|_| anyhow::anyhow!("reading the files of the run panicked"))??;
        let (signed, not_as_signed) = signed(folder, &now);
        let missing_end = || findings.no_end.as_ref().and_then(|_| end_is_missing(folder));
        let doubt = files.doubts.into_iter().next().or_else(missing_end);
        let is_reported = files.are_as_reported.is_some();
        let recovered = files.recovered;
        Ok(Findings { doubt, is_reported, recovered, signed, not_as_signed, ..findings })
    })
}

/// The signed reports on a run as lines, and everything that speaks against them or against the run being the one that was
/// signed.
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
    /// How the first planner that answers otherwise does.
    fn other_answer(&self) -> Option<&String> {
        self.planners.as_ref().and_then(|asked| asked.difference.as_ref())
    }

    /// Where a planner failed from outside or by the clock that did not fail in the run.
    fn unproven(&self) -> Option<&String> {
        self.planners.as_ref().and_then(|asked| asked.unproven.as_ref())
    }

    fn are_equal(&self) -> bool {
        self.is_run_equal() && self.not_as_signed.is_empty()
    }

    /// Whether everything but the signed reports is as it was.
    fn is_run_equal(&self) -> bool {
        self.difference.is_none()
            && self.doubt.is_none()
            && self.other_answer().is_none()
            && self.unproven().is_none()
    }
}

/// What was found, in lines for people.
fn lines(findings: &Findings, plugins: &PluginDirs) -> Vec<String> {
    let Findings { difference, doubt, no_end, planners, events, last_tick, .. } = findings;
    let mut lines = Vec::new();
    if !findings.is_reported && no_end.is_none() {
        lines.push(
            "note: no report.json names the digests of journal and recording, so the recording is not checked".into(),
        );
    }
    if let Some(recovered) = &findings.recovered {
        lines.push(format!("note: the run was killed, and recovered {recovered}"));
    }
    if let Some(why) = no_end {
        lines.push(format!("note: the journal is incomplete ({why}); what it holds before is compared"));
    }
    if let Some(Difference { tick, recorded, computed }) = difference {
        lines.push(format!("different from tick {tick} on\n  recorded: {recorded}\n  computed: {computed}"));
    } else if let Some(doubt) = doubt {
        lines.push(format!("different: {doubt}; its {events} events up to tick {last_tick} are recomputed"));
    }
    lines.extend(planners.iter().flat_map(|asked| &asked.external).map(|(planner, count)| {
        format!(
            "note: faults of planner {planner} from outside or by the clock, taken from the journal: {count}"
        )
    }));
    if let Some(why) = findings.unproven().filter(|_| findings.other_answer().is_none()) {
        lines.push(format!(
            "not proven: a planner fails from outside or by the clock at {why}, and did not fail in the run: verify once more; \
             the mission repeats from the recorded answers"
        ));
    }
    if let Some(why) = findings.other_answer() {
        lines.push(format!("different: {why}; the mission repeats from the recorded answers"));
    }
    if difference.is_some() || findings.other_answer().is_some() {
        lines.extend(planner_changes(&findings.builds, plugins).iter().map(|note| format!("note: {note}")));
    }
    if findings.is_run_equal() {
        // A report counts the ticks that passed since the first one, which has the number 0.
        let how = if planners.is_some() { "" } else { " from the recorded answers" };
        lines.push(format!(
            "equal: {events} events recomputed{how}, byte for byte, from tick 0 to tick {last_tick}; {}",
            proven(planners.as_ref())
        ));
    }
    lines.extend(findings.signed.iter().cloned());
    lines.extend(findings.not_as_signed.iter().map(|doubt| format!("NOT AS SIGNED: {doubt}")));
    lines
}

/// What is proven of the planners of a run that is equal.
fn proven(planners: Option<&Asked>) -> String {
    let Some(Asked { same, not_comparable, too_early, .. }) = planners else {
        return "the planners were not asked (--from-journal): what they answered, drew and logged is not proven"
            .into();
    };
    let refused = match not_comparable {
        0 => String::new(),
        n => format!(", {n} that the mission refused or did not use cannot be compared"),
    };
    let failed = match too_early {
        0 => String::new(),
        n => format!(", {n} of a planner that failed earlier than in the run cannot be compared"),
    };
    format!("{same} planner answers are the same{refused}{failed}")
}

/// The run of a journal, ready to be flown again.
pub(crate) fn prepared(path: &Path, ticks: &mut Ticks) -> anyhow::Result<(Scenario, Flight)> {
    let opened = ticks.opened()?.clone();
    if let Some(Measured { file, .. }) = &opened.measured {
        return Err(bad_input(format!(
            "nothing was flown: the readings of {file} were located; `tankops locate` computes them again: {}",
            path.display()
        )));
    }
    let mut scenario = Scenario::recorded(&opened.scenario_toml, "the scenario in the journal")
        .map_err(|errors| bad_input(errors.render()))?;
    // Only an operator at the console sees the plan before the start.
    scenario.mission.start_names_plan = opened.mission.start_names_plan;
    let flight = Flight::prepare(&scenario, opened.mission.attended);
    Ok((scenario, flight))
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
        let no_end = reading.join().map_err(|_| anyhow::anyhow!("reading the journal panicked"))?;
        let asked = asking.map(ScopedJoinHandle::join).transpose();
        let planners = asked.map_err(|_| anyhow::anyhow!("asking the planners panicked"))?;
        Ok(Findings { no_end, planners, ..findings? })
    })
}

/// Reads a journal ahead of who compares it, up to its end, an error, or the first difference; why it has no end.
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

/// Flies the mission again beside its journal, up to the first difference.
fn recompute(
    mut flight: Flight,
    mut replayed: Replayed,
    read: impl Iterator<Item = Result<RecordedTick, JournalError>>,
) -> anyhow::Result<Findings> {
    let mut findings = Findings::default();
    let mut head = vec![flight.opened()];
    for recorded in read {
        let recorded = recorded?;
        replayed.begin_tick(&recorded);
        findings.builds.extend(recorded.opened_planners().map(|info| (info.id.clone(), info.clone())));
        let mut computed = std::mem::take(&mut head);
        computed.extend(flight.tick(&recorded.orders(), &mut replayed));
        findings.difference = recorded.difference(&computed).context("writing an event as JSON")?;
        findings.events += recorded.n_compared();
        findings.last_tick = recorded.tick;
        if findings.difference.is_some() {
            break;
        }
    }
    Ok(findings)
}

/// Planners of the run whose plugin is another file now.
fn planner_changes(builds: &BTreeMap<String, PlannerInfo>, plugins: &PluginDirs) -> Vec<String> {
    let now = found(plugins).planners;
    let changed = |(id, then): (&String, &PlannerInfo)| match now.iter().find(|info| info.id == *id) {
        None => Some(format!("planner {id} of the run is not installed; --from-journal does without it")),
        Some(info) if info.sha256 != then.sha256 => Some(format!(
            "planner {id} is another build than in the run ({} then); --from-journal does without it",
            then.version
        )),
        Some(_) => None,
    };
    builds.iter().filter_map(changed).collect()
}
