//! Signing reports: the earlier signed reports on the same runs, the conditions for a signature, and sealing.

use ::locate::Again;
use flight::failure::bad_input;
use planner_host::PluginDirs;
use recording::sha256_of;
use report::{
    Document, PastRun,
    document::{Revision, Signature, SignedRun},
    print::{say_line, warn_line},
};
use review::register;
use runs::{
    Register, SIGNED_FILE, Signatures, add_signed, signatures, signed_under_another_name, utc_minute,
};
use std::{
    fs,
    path::{Path, PathBuf},
    time::SystemTime,
};

/// The signed reports on a set of runs.
#[derive(Debug, Default, PartialEq)]
pub(crate) struct Chain {
    /// The revisions without duplicates, earliest first.
    pub revisions: Vec<Revision>,
    /// Doubts about the revisions: a report was changed, moved or lost, or is about a different run with the same name.
    pub doubts: Vec<String>,
}

impl Chain {
    /// The chain of the runs in these folders.
    pub(crate) fn of(folders: &[PathBuf], register: &Register) -> Self {
        let mut chain = Self::default();
        for folder in folders {
            let Signatures { revisions, doubts, .. } = signatures(folder, register);
            for revision in revisions {
                if !chain.revisions.contains(&revision) {
                    chain.revisions.push(revision);
                }
            }
            chain.doubt(doubts);
        }
        chain.revisions.sort_by(|a, b| a.signature.at.cmp(&b.signature.at));
        chain
    }

    /// Adds doubts about runs that differ from the signed ones or were signed under another name.
    pub(crate) fn compare(&mut self, folders: &[PathBuf], past: &[PastRun], register: &Register) {
        let now: Vec<SignedRun> = past.iter().flat_map(SignedRun::names_of).collect();
        let doubts =
            self.revisions.iter().flat_map(|revision| now.iter().filter_map(|run| revision.doubt(run)));
        let renamed = folders
            .iter()
            .zip(past)
            .filter_map(|(folder, past)| signed_under_another_name(folder, register, &SignedRun::of(past)));
        let doubts = doubts.chain(renamed).collect();
        self.doubt(doubts);
    }

    fn doubt(&mut self, doubts: Vec<String>) {
        let more: Vec<String> = doubts.into_iter().filter(|doubt| !self.doubts.contains(doubt)).collect();
        self.doubts.extend(more);
    }
}

/// A signature by this person, dated to the current minute in UTC.
pub(crate) fn signature(by: &str) -> Signature {
    Signature { by: by.to_owned(), at: utc_minute(SystemTime::now()) }
}

/// Refuses to extend a chain that has a doubt.
pub(crate) fn refuse_doubts(chain: &Chain) -> anyhow::Result<()> {
    match chain.doubts.first() {
        Some(doubt) => Err(bad_input(format!(
            "not signed: {doubt}; restore the files to the state in which they were signed"
        ))),
        None => Ok(()),
    }
}

/// Refuses a signer other than the inspector whose certificate is stated. A missing inspector is an open item of the
/// gate, not an error here.
pub(crate) fn refuse_other_signer(by: &str, inspector: Option<&str>) -> anyhow::Result<()> {
    match inspector {
        Some(inspector) if inspector.trim() != by.trim() => Err(bad_input(format!(
            "not signed: --sign names {by}, but inspection.inspector is {inspector}, whose certificate the \
             report states; either {inspector} must sign, or the --inspection file must name {by} \
             as inspector and give an inspector_certificate"
        ))),
        _ => Ok(()),
    }
}

/// Refuses a report with open items.
pub(crate) fn refuse_open_items(document: &Document) -> anyhow::Result<()> {
    let open: Vec<String> = document
        .open_items()
        .map(|item| format!("  {} {}: {}", item.number, item.what, item.missing.join(", ")))
        .collect();
    if open.is_empty() {
        return Ok(());
    }
    let (count, are) = (open.len(), if open.len() == 1 { "is" } else { "are" });
    Err(bad_input(format!(
        "not signed: {count} of {} items {are} open (state the keys of [inspection] in a file for --inspection):\n{}",
        document.gate.len(),
        open.join("\n")
    )))
}

/// Refuses a run if recomputing it does not reproduce its journal: the digests alone prove nothing, because
/// `report.json` can be rewritten. `folders` contains no located runs, because their readings do not come from the
/// simulator.
pub(crate) fn refuse_not_recomputed(folders: &[PathBuf], plugins: &PluginDirs) -> anyhow::Result<()> {
    for folder in folders {
        let name = folder.file_name().unwrap_or_default().to_string_lossy();
        warn_line(&format!("recomputing run {name} ..."));
        let verified = review::verify(folder, plugins, true)?;
        if !verified.is_equal {
            return Err(bad_input(format!("not signed: run {name}: {}", verified.lines.join("\n"))));
        }
    }
    Ok(())
}

/// Refuses a located run if its readings do not reproduce its positions. `folders` contains only located runs.
pub(crate) fn refuse_not_located_again(folders: &[PathBuf]) -> anyhow::Result<()> {
    for folder in folders {
        let name = folder.file_name().unwrap_or_default().to_string_lossy();
        warn_line(&format!("locating the robot again from the readings of run {name} ..."));
        let why = match ::locate::again(folder)? {
            Again::Equal(_) => continue,
            Again::Different { line, .. } => {
                format!("the positions computed from them differ from the run's journal from line {line} on")
            }
            Again::NoReadings(why) => format!("{why}; restore the original readings"),
        };
        return Err(bad_input(format!("not signed: the readings of run {name}: {why}")));
    }
    Ok(())
}

/// Lists a signed report in the folders of its runs and in the register, and makes it read-only. If the report cannot
/// be listed, it is removed, because later changes to it could not be detected. Returns its entry in the lists.
pub(crate) fn seal(
    (file, text): (&Path, &str),
    document: &Document,
    signature: &Signature,
    (folders, past): (&[PathBuf], &[PastRun]),
) -> anyhow::Result<Revision> {
    let (revision, sha256) = (document.revision.clone(), sha256_of(text.as_bytes()));
    let said = format!("signed as revision {revision} by {}, sha256 {sha256}", signature.by);
    let signed = Revision {
        number: document.number.clone(),
        revision,
        signature: signature.clone(),
        file: fs::canonicalize(file).unwrap_or_else(|_| file.to_owned()).display().to_string(),
        sha256,
        runs: past.iter().map(SignedRun::of).collect(),
    };
    add_signed(folders, &register(), &signed).inspect_err(|_| drop(fs::remove_file(file)))?;
    make_read_only(file)?;
    say_line(&said)?;
    Ok(signed)
}

fn make_read_only(file: &Path) -> anyhow::Result<()> {
    let mut permissions = fs::metadata(file)?.permissions();
    permissions.set_readonly(true);
    fs::set_permissions(file, permissions).map_err(|error| {
        bad_input(format!("cannot make {} read-only: {error}; see {SIGNED_FILE}", file.display()))
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]

    use super::*;

    #[test]
    fn only_the_inspector_whose_certificate_is_stated_signs() {
        assert!(refuse_other_signer("L. Kern", Some(" L. Kern ")).is_ok());
        // A missing inspector is an open item of the gate.
        assert!(refuse_other_signer("L. Kern", None).is_ok());
        let refused = refuse_other_signer("A. Other", Some("L. Kern")).unwrap_err().to_string();
        assert!(
            refused.starts_with("not signed: --sign names A. Other, but inspection.inspector is L. Kern")
        );
    }

    fn signed(folder: &Path, revision: &str, at: &str) -> Revision {
        let file = folder.join(format!("{revision}.html"));
        fs::write(&file, revision).unwrap();
        let signature = Signature { by: "L. Kern".into(), at: at.into() };
        let (number, revision) = ("1-1".to_owned(), revision.to_owned());
        let file = file.display().to_string();
        Revision { number, sha256: sha256_of(revision.as_bytes()), revision, signature, file, runs: vec![] }
    }

    #[test]
    fn the_chain_of_several_runs_has_each_signed_report_once_and_a_changed_one_is_a_doubt_of_all() {
        let [one, other] = [(), ()].map(|()| tempfile::tempdir().unwrap());
        let both = signed(one.path(), "B", "2026-11-22 05:00");
        let first = signed(one.path(), "A", "2026-11-22 04:00");
        let of_other = signed(other.path(), "C", "2026-11-22 04:30");
        let folders = [one.path().to_owned(), other.path().to_owned()];
        let register = Register::at(None);
        add_signed(&folders[..1], &register, &first).unwrap();
        add_signed(&folders[1..], &register, &of_other).unwrap();
        add_signed(&folders, &register, &both).unwrap();
        let chain = Chain { revisions: vec![first, of_other, both.clone()], doubts: vec![] };
        assert_eq!(Chain::of(&folders, &register), chain);
        assert!(refuse_doubts(&chain).is_ok());
        fs::write(&both.file, "forged").unwrap();
        for folders in [&folders[..], &folders[..1], &folders[1..]] {
            let chain = Chain::of(folders, &register);
            let refused = refuse_doubts(&chain).unwrap_err().to_string();
            assert!(
                chain.doubts.len() == 1 && refused.starts_with("not signed: signed revision B was changed"),
                "{chain:?}"
            );
        }
    }
}
