//! Packages of reports: what they state, and their verification without the folder of the runs.

mod agreement;

use crate::{Verified, register};
use agreement::Parts;
use package::{Package, PackageError};
use report::{
    Document, PastRun,
    document::{Revision, Signature},
};
use runs::Register;
use serde::{Deserialize, Serialize, de::DeserializeOwned};
use serde_json::Value;
use std::{
    collections::BTreeMap,
    fs::File,
    io::{Read, Seek},
    path::Path,
};

/// Name of the page in a package.
pub const PAGE: &str = "report.html";
/// Name of the list of the runs.
pub const MANIFEST: &str = "package.json";
/// Name of the list of the signed reports.
pub const SIGNATURES: &str = "signatures.json";
/// Version of the list of the runs.
const VERSION: u32 = 1;
/// The longest list, bytes.
const MOST_BYTES: u64 = 8 << 20;
/// The longest page, and the longest `report.json`, bytes.
const MOST_PAGE_BYTES: u64 = 128 << 20;
/// Name of the report for programs.
const REPORT: &str = "report.json";

/// Name of the readings of a run in a package.
pub fn readings_name(run: &str) -> String {
    format!("readings/{run}.parquet")
}

/// Name of the page of an earlier signed report in a package.
pub fn signed_name(revision: &Revision) -> String {
    format!("signed/{}-{}.html", revision.number, revision.revision)
}

/// The list of the runs in a package.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Manifest {
    /// Version of this list.
    pub package_version: u32,
    /// Name and version of the program that packed the files.
    pub made_by: String,
    /// Document number of the report.
    pub number: String,
    /// Letter of its revision.
    pub revision: String,
    /// The signature of the report; absent for a draft.
    pub signature: Option<Signature>,
    /// The runs.
    pub runs: Vec<PackedRun>,
}

/// A run in a package.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct PackedRun {
    /// Name of the run's folder.
    pub run: String,
    /// Name of its readings in the package; absent without readings.
    pub readings: Option<String>,
    /// SHA-256 of the journal, hexadecimal.
    pub journal_sha256: Option<String>,
    /// SHA-256 of the recording, hexadecimal.
    pub recording_sha256: Option<String>,
    /// SHA-256 of the readings, hexadecimal.
    pub readings_sha256: Option<String>,
}

impl Manifest {
    /// The list of a report on some runs; `names` are the names that the runs have in the package.
    pub fn new(document: &Document, past: &[PastRun], names: &[String]) -> Self {
        let run = |(past, name): (&PastRun, &String)| PackedRun {
            run: past.name.clone(),
            readings: past.files.readings_sha256.as_ref().map(|_| readings_name(name)),
            journal_sha256: past.files.journal_sha256.clone(),
            recording_sha256: past.files.recording_sha256.clone(),
            readings_sha256: past.files.readings_sha256.clone(),
        };
        Self {
            package_version: VERSION,
            made_by: document.made_by.clone(),
            number: document.number.clone(),
            revision: document.revision.clone(),
            signature: document.signature.clone(),
            runs: past.iter().zip(names).map(run).collect(),
        }
    }

    /// Whether a signed report is the report of the package.
    pub fn is(&self, revision: &Revision) -> bool {
        self.signature.as_ref() == Some(&revision.signature)
            && (&self.number, &self.revision) == (&revision.number, &revision.revision)
    }
}

/// Verifies a package. It is equal if every file is as `SHA256SUMS` and the page list it, the readings are those of the
/// runs, the parts name one report, and the pages are those that were signed.
///
/// # Errors
/// The file cannot be read.
pub fn verify_package(file: &Path) -> anyhow::Result<Verified> {
    let input =
        File::open(file).map_err(|error| anyhow::anyhow!("cannot read {}: {error}", file.display()))?;
    let lines = match checked(input, &register()) {
        Ok(lines) => lines,
        Err(PackageError::Io(error)) => anyhow::bail!("cannot read {}: {error}", file.display()),
        Err(error) => vec![Line::Different(format!("refused: {error}"))],
    };
    let is_equal = lines.iter().all(|line| matches!(line, Line::Fine(_)));
    let mut lines: Vec<String> = lines.into_iter().map(Line::text).collect();
    if is_equal {
        let sha256 = recording::sha256(file)?;
        lines.push(format!(
            "note: whoever changes a package can also change its SHA256SUMS; compare the SHA-256 of the package with the \
             one that the sender states: {sha256}"
        ));
    }
    let brief = lines.join("; ");
    Ok(Verified { is_equal, is_located: false, lines, brief })
}

/// A finding.
enum Line {
    Fine(String),
    Different(String),
}

impl Line {
    fn text(self) -> String {
        match self {
            Self::Fine(text) | Self::Different(text) => text,
        }
    }
}

fn checked(input: impl Read + Seek, register: &Register) -> Result<Vec<Line>, PackageError> {
    let mut package = Package::open(input)?;
    let digests = package.digests()?;
    let faults = package.faults(&digests)?;
    let mut lines: Vec<Line> =
        faults.iter().map(|fault| Line::Different(format!("different: {fault}"))).collect();
    if faults.is_empty() {
        lines.push(Line::Fine(format!("equal: {} files have the SHA-256 in SHA256SUMS", digests.len() - 1)));
    }
    let manifest = json::<Manifest>(&mut package, MANIFEST, MOST_BYTES)?;
    let signed = json::<Vec<Revision>>(&mut package, SIGNATURES, MOST_BYTES)?;
    let report = json::<Value>(&mut package, REPORT, MOST_PAGE_BYTES)?;
    let page = content(&mut package, PAGE, MOST_PAGE_BYTES)?;
    if let (Ok(manifest), Ok(report), Ok(page)) = (&manifest, &report, &page) {
        let page = String::from_utf8_lossy(page);
        lines.extend(Parts { manifest, report, page: &page, digests: &digests }.compare());
    }
    if let (Ok(manifest), Ok(signed)) = (&manifest, &signed) {
        lines.extend(readings(manifest, &digests));
        lines.extend(signatures(manifest, signed, &digests, register));
        if let Ok(page) = &page {
            let page = String::from_utf8_lossy(page);
            lines.extend(agreement::earlier_pages((manifest, signed), &page, &digests));
        }
    }
    let why = [manifest.err(), signed.err(), report.err(), page.err()];
    lines.extend(why.into_iter().flatten().map(Line::Different));
    Ok(lines)
}

/// The content of a file that every package has; the inner error is a sentence.
fn content(
    package: &mut Package<impl Read + Seek>,
    name: &str,
    most_bytes: u64,
) -> Result<Result<Vec<u8>, String>, PackageError> {
    let content = package.content(name, most_bytes)?;
    Ok(content.ok_or_else(|| format!("different: {name} is missing, which every package has")))
}

/// Reads a file of a package as JSON; the inner error is a sentence about its content.
fn json<T: DeserializeOwned>(
    package: &mut Package<impl Read + Seek>,
    name: &str,
    most_bytes: u64,
) -> Result<Result<T, String>, PackageError> {
    let read = |content: Vec<u8>| {
        serde_json::from_slice(&content).map_err(|error| format!("different: {name} cannot be read: {error}"))
    };
    Ok(content(package, name, most_bytes)?.and_then(read))
}

/// Compares the readings with the digests of the runs.
fn readings(manifest: &Manifest, digests: &BTreeMap<String, String>) -> Vec<Line> {
    let of_run = |run: &PackedRun| {
        let name = run.readings.as_ref()?;
        let (then, now) = (run.readings_sha256.as_ref()?, digests.get(name));
        Some(match now {
            Some(now) if now == then => {
                Line::Fine(format!("equal: {name} has the SHA-256 that run {} states", run.run))
            }
            Some(now) => Line::Different(format!(
                "different: {name} is not the file of run {}: expected SHA-256 {then}, found {now}",
                run.run
            )),
            None => Line::Different(format!("different: {name} of run {} is missing", run.run)),
        })
    };
    manifest.runs.iter().filter_map(of_run).collect()
}

/// Compares the pages with the signatures, and the signatures with the register of this user.
fn signatures(
    manifest: &Manifest,
    signed: &[Revision],
    digests: &BTreeMap<String, String>,
    register: &Register,
) -> Vec<Line> {
    let mut lines = Vec::new();
    for revision in signed {
        let name = if manifest.is(revision) { PAGE.to_owned() } else { signed_name(revision) };
        let (letter, by, at) = (&revision.revision, &revision.signature.by, &revision.signature.at);
        let now = digests.get(&name);
        match now {
            Some(now) if *now == revision.sha256 => {
                lines.push(Line::Fine(format!("signed: revision {letter} by {by}, {at} UTC: {name}")));
            }
            Some(now) => lines.push(Line::Different(format!(
                "NOT AS SIGNED: {name} was changed after {by} signed it as revision {letter}: expected SHA-256 {}, \
                 found {now}",
                revision.sha256
            ))),
            None => lines.push(Line::Different(format!("NOT AS SIGNED: {name}, revision {letter} by {by}, is missing"))),
        }
        lines.push(match register.numbered(&revision.number, letter) {
            Some(entry) if entry.sha256 == revision.sha256 && Some(&entry.sha256) == now => {
                Line::Fine(format!("signed: your register lists revision {letter} with the same SHA-256"))
            }
            Some(entry) => Line::Different(format!(
                "NOT AS SIGNED: your register lists revision {letter} by {}, {} UTC, with SHA-256 {}, not that of {name} \
                 in this package",
                entry.signature.by, entry.signature.at, entry.sha256
            )),
            None => Line::Fine(format!(
                "note: only the register of {by} shows whether {by} signed revision {letter}; yours does not list it"
            )),
        });
    }
    let is_listed = signed.iter().any(|revision| manifest.is(revision));
    match &manifest.signature {
        Some(signature) if !is_listed => lines.push(Line::Different(format!(
            "NOT AS SIGNED: {SIGNATURES} does not list the signature of {}",
            signature.by
        ))),
        Some(_) => {}
        None => lines.push(Line::Fine("note: the report is a draft, not signed".into())),
    }
    lines
}
