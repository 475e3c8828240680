//! Whether the parts of a package state the same. Whoever changes one part and renews the list of digests must not get away
//! with it.

use super::{Line, Manifest, PAGE, PackedRun, SIGNATURES, VERSION, signed_name};
use package::SUMS;
use report::document::{Revision, stated_files};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};

/// The folder of the pages of earlier signed reports.
const SIGNED: &str = "signed/";

/// Checks that the page states each earlier signed report, and that each page in `signed/` belongs to a signature.
pub(super) fn earlier_pages(
    (manifest, signed): (&Manifest, &[Revision]),
    page: &str,
    digests: &BTreeMap<String, String>,
) -> Vec<Line> {
    let page: String = page.split_whitespace().collect();
    let earlier = || signed.iter().filter(|revision| !manifest.is(revision));
    let unstated = earlier().filter(|revision| !page.contains(&revision.sha256)).map(|revision| {
        format!("{PAGE} does not state the SHA-256 of the signed revision {}", revision.revision)
    });
    let names: BTreeSet<String> = earlier().map(signed_name).collect();
    let extra = digests.keys().filter(|name| name.starts_with(SIGNED) && !names.contains(*name));
    let extra = extra.map(|name| format!("{name} belongs to none of the signatures in {SIGNATURES}"));
    unstated.chain(extra).map(|what| Line::Different(format!("different: {what}"))).collect()
}

/// The parts of a package that name the report and its runs.
pub(super) struct Parts<'a> {
    pub manifest: &'a Manifest,
    /// The report for programs, `report.json`.
    pub report: &'a Value,
    /// The page of the report.
    pub page: &'a str,
    /// SHA-256 of each file, by name.
    pub digests: &'a BTreeMap<String, String>,
}

impl Parts<'_> {
    /// Compares the parts; a finding for each contradiction, or one that states that they agree.
    pub(super) fn compare(&self) -> Vec<Line> {
        let version = self.manifest.package_version;
        if version != VERSION {
            return vec![Line::Different(format!(
                "different: package.json has version {version}; this program reads version {VERSION}"
            ))];
        }
        let found: Vec<String> =
            [self.report_of_manifest(), self.on_page(), self.readings(), self.files()].concat();
        if found.is_empty() {
            let runs = self.manifest.runs.len();
            let runs = if runs == 1 { "its run".to_owned() } else { format!("its {runs} runs") };
            let files = stated_files(self.page).len();
            return vec![
                Line::Fine(format!("equal: page, report.json and package.json name one report and {runs}")),
                Line::Fine(format!("equal: {files} files have the SHA-256 that {PAGE} states")),
            ];
        }
        found.into_iter().map(|what| Line::Different(format!("different: {what}"))).collect()
    }

    /// Compares `report.json` with the list of the runs.
    fn report_of_manifest(&self) -> Vec<String> {
        let Manifest { number, revision, signature, runs, .. } = self.manifest;
        let of_manifest = [("number", number), ("revision", revision)];
        let mut found: Vec<String> = of_manifest
            .into_iter()
            .filter(|(key, value)| self.report[*key].as_str() != Some(value))
            .map(|(key, value)| format!("the {key} in report.json is not {value}, as in package.json"))
            .collect();
        if serde_json::to_value(signature).ok().as_ref() != Some(&self.report["signature"]) {
            found.push("report.json and package.json state different signatures".into());
        }
        let of_report = self.report["runs"].as_array().map(Vec::as_slice).unwrap_or_default();
        if of_report.len() != runs.len() || runs.is_empty() {
            found.push(format!(
                "report.json has {} runs, but package.json has {}",
                of_report.len(),
                runs.len()
            ));
        }
        for (run, of_report) in runs.iter().zip(of_report) {
            let doubts = of_report["files"]["doubts"].as_array().map(Vec::as_slice).unwrap_or_default();
            let doubts = doubts.iter().filter_map(Value::as_str).map(foreign::plain);
            found
                .extend(doubts.map(|doubt| {
                    format!("run {} was already in doubt when it was packed: {doubt}", run.run)
                }));
            let PackedRun { run: name, journal_sha256, recording_sha256, readings_sha256, .. } = run;
            let files = &of_report["files"];
            let digests = [
                ("journal", journal_sha256, &files["journal_sha256"]),
                ("recording", recording_sha256, &files["recording_sha256"]),
                ("readings", readings_sha256, &files["readings_sha256"]),
            ];
            if of_report["run"].as_str() != Some(name) {
                found.push(format!("report.json does not have run {name} where package.json has it"));
            }
            let others = digests.into_iter().filter(|(_, own, other)| own.as_deref() != other.as_str());
            found.extend(others.map(|(of, ..)| {
                format!("report.json and package.json state different digests of the {of} of run {name}")
            }));
        }
        found
    }

    /// Looks for the report and its runs on the page.
    fn on_page(&self) -> Vec<String> {
        // The page divides long digests by spaces.
        let page: String = self.page.split_whitespace().collect();
        let states = |text: &str| page.contains(&text.split_whitespace().collect::<String>());
        let Manifest { number, runs, .. } = self.manifest;
        let mut found = Vec::new();
        if !states(number) {
            found.push(format!("{PAGE} is not the page of report {number}"));
        }
        let missing =
            runs.iter().filter(|run| run.journal_sha256.as_deref().is_some_and(|sha256| !states(sha256)));
        found.extend(
            missing.map(|run| format!("{PAGE} does not state the SHA-256 of the journal of run {}", run.run)),
        );
        found
    }

    /// Compares the other files with the list on the page, which is the only part that a signature covers.
    fn files(&self) -> Vec<String> {
        let stated = stated_files(self.page);
        if stated.is_empty() {
            return vec![format!(
                "{PAGE} does not state the SHA-256 of the other files, so nothing vouches for them; make the package again \
                 from the runs"
            )];
        }
        let is_other = |name: &str| ![PAGE, SIGNATURES, SUMS].contains(&name) && !name.starts_with(SIGNED);
        let others = self.digests.iter().filter(|(name, _)| is_other(name));
        let found = others.filter_map(|(name, now)| match stated.get(name) {
            Some(then) if then == now => None,
            Some(then) => Some(format!(
                "{name} is not the file that belongs to {PAGE}: the page states SHA-256 {then}, found {now}"
            )),
            None => Some(format!("{name} does not belong to the report: {PAGE} does not state it")),
        });
        let missing = stated.keys().filter(|name| !self.digests.contains_key(*name));
        let missing = missing.map(|name| format!("{name} is missing, but {PAGE} states it"));
        found.chain(missing).collect()
    }

    /// Checks that each file of readings belongs to one run, and that each run with readings has its file.
    fn readings(&self) -> Vec<String> {
        let runs = &self.manifest.runs;
        let of_file = |name: &str| runs.iter().filter(|run| run.readings.as_deref() == Some(name)).count();
        let files = self.digests.keys().filter(|name| name.starts_with("readings/"));
        let shared = files.filter_map(|name| match of_file(name) {
            1 => None,
            0 => Some(format!("{name} belongs to none of the runs in package.json")),
            count => Some(format!("{count} runs in package.json claim {name}")),
        });
        let without = runs.iter().filter(|run| run.readings.is_none() && run.readings_sha256.is_some());
        let without =
            without.map(|run| format!("package.json names no file with the readings of run {}", run.run));
        shared.chain(without).collect()
    }
}
