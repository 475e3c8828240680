//! The signed reports on a run, and whether all of them are unchanged.

use crate::{error::RunError, register::Register, report_file::Reported, whole::write_whole};
use foreign::read_json;
use recording::sha256;
use report::{
    Difference,
    document::{Revision, SignedRun},
    first_difference,
};
use std::{
    io,
    path::{Path, PathBuf},
};

/// File name of the list of signed reports in the folder of a run.
pub const SIGNED_FILE: &str = "signed.json";
/// Maximum size of the list, bytes: ten thousand signatures.
const MOST_BYTES: u64 = 8 << 20;

/// Reads the list of signed reports on the run in a folder, in order.
///
/// # Errors
/// The list cannot be read.
pub fn signed_list(folder: &Path) -> Result<Vec<Revision>, RunError> {
    let path = folder.join(SIGNED_FILE);
    let reading = || RunError::during(format!("reading the list of signed reports: {}", path.display()));
    let text = match read_json(&path, MOST_BYTES) {
        Ok(text) => text,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Vec::new()),
        Err(error) => return Err(reading()(error)),
    };
    serde_json::from_str(&text).map_err(|error| RunError::Damaged { file: path, why: error.to_string() })
}

/// The signed reports on a run.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Signatures {
    /// The reports in the order of the list.
    pub revisions: Vec<Revision>,
    /// Problems with them, as sentences that name the file.
    pub doubts: Vec<String>,
    /// Points that only another user's register could settle, as sentences.
    pub notes: Vec<String>,
}

/// Reads the signed reports on the run in a folder, and checks them. It is a problem if a file has changed since it was
/// signed or is no longer where it was written, or if a list is missing, damaged, or different from the register.
pub fn signatures(folder: &Path, register: &Register) -> Signatures {
    let mut found = Signatures::default();
    match signed_list(folder) {
        Ok(revisions) => found.revisions = revisions,
        Err(why) => found.doubts.push(why.to_string()),
    }
    let registered = register.of(&names_of(folder)).unwrap_or_else(|why| {
        found.doubts.push(why.to_string());
        Vec::new()
    });
    let entry = |revision: &Revision| registered.iter().find(|entry| is_same_report(entry, revision));
    let changed = |revision| list_change(revision, entry(revision)?, register);
    found.doubts.extend(found.revisions.iter().filter_map(changed));
    found.doubts.extend(found.revisions.iter().filter_map(|revision| file_doubt(revision, entry(revision))));
    found.doubts.extend(found.revisions.iter().find_map(|revision| renamed(revision, folder)));
    let is_listed =
        |entry: &&Revision| found.revisions.iter().any(|revision| is_same_report(entry, revision));
    let lost = registered.iter().filter(|entry| !is_listed(entry)).map(|entry| lost(entry, folder, register));
    let lost: Vec<String> = lost.collect();
    found.doubts.extend(lost);
    for revision in found.revisions.iter().filter(|revision| entry(revision).is_none()) {
        // The owner of this register has signed reports on this run, but not this report.
        let is_invented = registered.iter().any(|entry| entry.signature.by == revision.signature.by);
        let to = if is_invented { &mut found.doubts } else { &mut found.notes };
        to.push(unregistered(revision, is_invented, register));
    }
    found
}

/// Searches the register for a signed report on exactly these files under a different name than that of the run in this
/// folder. Returns a message if there is such a report.
///
/// Both digests must match: equal runs have equal journals, but each recording contains the time of day at which it was
/// made.
pub fn signed_under_another_name(folder: &Path, register: &Register, now: &SignedRun) -> Option<String> {
    now.recording_sha256.as_ref()?;
    let names = names_of(folder);
    let is_it = |then: &SignedRun| {
        let files = |run: &SignedRun| (run.journal_sha256.clone(), run.recording_sha256.clone());
        !names.contains(&then.run) && files(then) == files(now)
    };
    let entry = register.about(is_it).ok()?.into_iter().next()?;
    let then = entry.runs.iter().find(|then| is_it(then))?;
    Some(format!(
        "run {} has the files of run {}, which was signed as revision {} by {} at {} UTC, according to {}; rename the folder back to that name",
        names[0],
        then.run,
        entry.revision,
        entry.signature.by,
        entry.signature.at,
        register.shown()
    ))
}

/// The names of a run: the current name of its folder, and the name that the folder had when the run was closed.
fn names_of(folder: &Path) -> Vec<String> {
    let name = folder.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let closed_as =
        Reported::read(folder).ok().flatten().and_then(|read| read.closed_as().map(str::to_owned));
    std::iter::once(name).chain(closed_as).collect()
}

fn is_same_report(one: &Revision, other: &Revision) -> bool {
    (&one.number, &one.revision) == (&other.number, &other.revision)
}

/// The difference between a signed report in the list and its entry in the register, which is never changed.
fn list_change(listed: &Revision, entry: &Revision, register: &Register) -> Option<String> {
    let [now, then] = [listed, entry].map(|revision| serde_json::to_value(revision).ok());
    let Difference { key, one, other } = first_difference(&now?, &then?)?;
    Some(format!(
        "{SIGNED_FILE} was changed: {key} of revision {} is {one}, but {other} in {}",
        listed.revision,
        register.shown()
    ))
}

/// The problem with the file of a signed report, or `None`. `entry` is the report's entry in the register, if it has one.
fn file_doubt(listed: &Revision, entry: Option<&Revision>) -> Option<String> {
    let Revision { revision: letter, file, sha256: then, .. } = entry.unwrap_or(listed);
    match sha256(&PathBuf::from(file)) {
        Ok(now) if now == *then => None,
        Ok(now) => {
            let or_list = match entry {
                Some(_) => String::new(),
                None => format!(
                    ", or {SIGNED_FILE} was changed; the register of {}, who signed it, shows which",
                    listed.signature.by
                ),
            };
            Some(format!(
                "signed revision {letter} was changed after it was signed{or_list}: {file}: expected SHA-256 {then}, found {now}"
            ))
        }
        Err(error) => Some(format!(
            "signed revision {letter} cannot be read: {file}: {error}; expected a file with SHA-256 {then}"
        )),
    }
}

/// The problem with a folder if the signed report names runs, but not this folder: the folder was renamed or copied.
fn renamed(listed: &Revision, folder: &Path) -> Option<String> {
    let name = folder.file_name()?.to_string_lossy();
    let signed: Vec<&str> = listed.runs.iter().map(|run| run.run.as_str()).collect();
    (!signed.is_empty() && !signed.contains(&&*name)).then(|| {
        format!(
            "the folder is called {name}, but revision {} was signed on {}; rename the folder back to \
             that name",
            listed.revision,
            signed.join(" and ")
        )
    })
}

/// A listed report that is not in the register.
fn unregistered(listed: &Revision, is_invented: bool, register: &Register) -> String {
    let Revision { revision: letter, signature, .. } = listed;
    let of = register.shown();
    if is_invented {
        format!(
            "{SIGNED_FILE} lists revision {letter} by {}, {} UTC; {of} contains other reports on this run signed by {}, but not this one",
            signature.by, signature.at, signature.by
        )
    } else {
        format!(
            "only the register of {} shows whether {} signed revision {letter}; your own register does \
             not list it ({of})",
            signature.by, signature.by
        )
    }
}

/// A report in the register that is missing from the list of a run.
fn lost(entry: &Revision, folder: &Path, register: &Register) -> String {
    let list = folder.join(SIGNED_FILE);
    let why = if list.exists() { "does not list it" } else { "is missing" };
    format!(
        "run {} was signed as revision {} by {} at {} UTC (SHA-256 {}), according to {}, but its {SIGNED_FILE} {why}: {}",
        names_of(folder)[0],
        entry.revision,
        entry.signature.by,
        entry.signature.at,
        entry.sha256,
        register.shown(),
        list.display()
    )
}

/// Adds a signed report to the register and to the lists of all runs that it covers, or to none of them.
///
/// # Errors
/// A list cannot be read or written.
pub fn add_signed(folders: &[PathBuf], register: &Register, revision: &Revision) -> Result<(), RunError> {
    let add = |folder: &PathBuf| {
        let mut revisions = signed_list(folder)?;
        revisions.push(revision.clone());
        write_list(folder, &revisions)
    };
    let mut added = 0;
    let all = folders.iter().try_for_each(|folder| add(folder).inspect(|()| added += 1));
    all.and_then(|()| register.add(revision))
        .inspect_err(|_| folders[..added].iter().for_each(|folder| take_back(folder, revision)))
}

/// Removes a report from the list again, if the system permits that.
fn take_back(folder: &Path, revision: &Revision) {
    if let Ok(mut revisions) = signed_list(folder) {
        revisions.retain(|listed| listed != revision);
        let _ = write_list(folder, &revisions);
    }
}

fn write_list(folder: &Path, revisions: &[Revision]) -> Result<(), RunError> {
    let path = folder.join(SIGNED_FILE);
    let text = serde_json::to_string_pretty(revisions).map_err(io::Error::from);
    text.and_then(|text| write_whole(&path, (text + "\n").as_bytes()))
        .map_err(RunError::during(format!("writing the list of signed reports: {}", path.display())))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]

    use super::*;
    use recording::sha256_of;
    use report::document::Signature;
    use std::fs;

    /// A run with one signed report, which the register has, too.
    struct Signed {
        folder: tempfile::TempDir,
        file: PathBuf,
        register: Register,
    }

    impl Signed {
        fn new() -> Self {
            let folder = tempfile::tempdir().unwrap();
            let file = folder.path().join("a.html");
            fs::write(&file, "signed").unwrap();
            let register = Register::at(Some(folder.path().join("signatures")));
            let signed = Self { folder, file, register };
            add_signed(&[signed.run()], &signed.register, &signed.revision()).unwrap();
            signed
        }

        fn run(&self) -> PathBuf {
            self.folder.path().to_owned()
        }

        fn revision(&self) -> Revision {
            let run = self.run().file_name().unwrap().to_string_lossy().into_owned();
            Revision {
                number: "1-1".into(),
                revision: "A".into(),
                signature: Signature { by: "L. Kern".into(), at: "2026-11-22 04:01".into() },
                file: self.file.display().to_string(),
                sha256: sha256_of(b"signed"),
                runs: vec![SignedRun { run, journal_sha256: None, recording_sha256: None }],
            }
        }

        /// The only doubt, by the register or without one.
        fn doubt(&self, register: &Register) -> String {
            let Signatures { doubts, .. } = signatures(&self.run(), register);
            let [doubt] = &doubts[..] else { panic!("{doubts:?}") };
            doubt.clone()
        }

        fn change_list(&self, from: &str, to: &str) {
            let list = self.run().join(SIGNED_FILE);
            let text = fs::read_to_string(&list).unwrap();
            assert!(text.contains(from));
            fs::write(list, text.replace(from, to)).unwrap();
        }
    }

    #[test]
    fn a_signed_report_that_was_changed_or_moved_is_named() {
        let (signed, none) = (Signed::new(), Register::at(None));
        let clean = Signatures { revisions: vec![signed.revision()], ..Signatures::default() };
        assert_eq!(signatures(&signed.run(), &signed.register), clean);
        // Another user's register cannot contain this report.
        let Signatures { doubts, notes, .. } = signatures(&signed.run(), &none);
        assert!(
            doubts.is_empty()
                && notes[0]
                    .starts_with("only the register of L. Kern shows whether L. Kern signed revision A"),
            "{notes:?}"
        );
        fs::write(&signed.file, "forged").unwrap();
        let doubt = signed.doubt(&signed.register);
        assert!(doubt.starts_with("signed revision A was changed after it was signed: "), "{doubt}");
        assert!(doubt.contains("expected SHA-256") && doubt.contains("a.html"), "{doubt}");
        assert!(signed.doubt(&none).contains(", or signed.json was changed; the register of L. Kern"));
        fs::remove_file(&signed.file).unwrap();
        let doubt = signed.doubt(&signed.register);
        assert!(doubt.starts_with("signed revision A cannot be read"), "{doubt}");
    }

    #[test]
    fn a_list_that_was_changed_is_blamed_where_the_register_shows_that_it_was() {
        let signed = Signed::new();
        let digest = sha256_of(b"signed");
        let other = digest.replace(&digest[..1], "x");
        signed.change_list(&digest, &other);
        let doubt = signed.doubt(&signed.register);
        let wanted = format!("signed.json was changed: sha256 of revision A is \"{other}\"");
        assert!(doubt.starts_with(&wanted) && doubt.contains(&format!(", but \"{digest}\" in ")), "{doubt}");
        signed.change_list(&other, &digest);
        signed.change_list("L. Kern", "A. Other");
        assert!(signed.doubt(&signed.register).starts_with("signed.json was changed: by of revision A"));
        // Both changed, so that they agree with each other.
        signed.change_list("A. Other", "L. Kern");
        signed.change_list(&digest, &sha256_of(b"forged"));
        fs::write(&signed.file, "forged").unwrap();
        let Signatures { doubts, .. } = signatures(&signed.run(), &signed.register);
        assert!(doubts.len() == 2 && doubts[1].starts_with("signed revision A was changed"), "{doubts:?}");
    }

    #[test]
    fn a_signed_run_under_another_name_is_named() {
        let (signed, copy) = (Signed::new(), tempfile::tempdir().unwrap());
        fs::copy(signed.run().join(SIGNED_FILE), copy.path().join(SIGNED_FILE)).unwrap();
        let Signatures { doubts, .. } = signatures(copy.path(), &signed.register);
        assert!(doubts.len() == 1 && doubts[0].starts_with("the folder is called "), "{doubts:?}");
    }

    #[test]
    fn a_report_that_its_signer_never_signed_is_named() {
        let signed = Signed::new();
        let mut list = signed_list(&signed.run()).unwrap();
        list.push(Revision { revision: "B".into(), ..signed.revision() });
        write_list(&signed.run(), &list).unwrap();
        let doubt = signed.doubt(&signed.register);
        assert!(
            doubt.starts_with("signed.json lists revision B by L. Kern")
                && doubt.ends_with("but not this one"),
            "{doubt}"
        );
    }

    #[test]
    fn a_list_that_is_missing_short_or_damaged_is_named() {
        let signed = Signed::new();
        let list = signed.run().join(SIGNED_FILE);
        fs::write(&list, "[]").unwrap();
        assert!(signed.doubt(&signed.register).contains("its signed.json does not list it"));
        fs::remove_file(&list).unwrap();
        let doubt = signed.doubt(&signed.register);
        assert!(
            doubt.contains("was signed as revision A by L. Kern") && doubt.contains("signed.json is missing")
        );
        fs::write(&list, "[{").unwrap();
        let Signatures { doubts, .. } = signatures(&signed.run(), &signed.register);
        assert!(doubts[0].contains("signed.json is damaged: ") && doubts[0].contains("line 1"), "{doubts:?}");
        // The name that the run had when it was closed counts, not the current name of its folder.
        fs::remove_file(&list).unwrap();
        let [then] = &names_of(&signed.run())[..] else { panic!("no report names it") };
        let renamed = tempfile::tempdir().unwrap();
        let report = format!("{{\"run\": \"{then}\", \"events_sha256\": null}}");
        fs::write(renamed.path().join("report.json"), report).unwrap();
        let Signatures { doubts, .. } = signatures(renamed.path(), &signed.register);
        assert!(doubts.len() == 1 && doubts[0].contains("signed.json is missing"), "{doubts:?}");
    }

    #[test]
    fn the_files_of_a_signed_run_are_known_under_any_name() {
        let signed = Signed::new();
        let files = |recording: &str| SignedRun {
            run: "renamed".into(),
            journal_sha256: Some("5a".into()),
            recording_sha256: Some(recording.into()),
        };
        let entry =
            Revision { runs: vec![SignedRun { run: "a".into(), ..files("6b") }], ..signed.revision() };
        signed.register.add(&entry).unwrap();
        let doubt = |now: &SignedRun| signed_under_another_name(&signed.run(), &signed.register, now);
        let found = doubt(&files("6b")).unwrap();
        assert!(
            found.contains("has the files of run a, which was signed as revision A by L. Kern"),
            "{found}"
        );
        // If a mission is run again, it has the same journal, but a different recording.
        assert_eq!(doubt(&files("7c")), None);
        assert_eq!(doubt(&SignedRun { recording_sha256: None, ..files("6b") }), None);
    }

    #[test]
    fn a_report_is_in_all_lists_or_in_none() {
        let (one, other) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
        fs::write(one.path().join(SIGNED_FILE), "[{").unwrap();
        let (signed, none) = (Signed::new(), Register::at(None));
        let both = [other.path().to_owned(), one.path().to_owned()];
        let unwritable = Register::at(Some("/proc/self/none/signatures".into()));
        for (folders, register) in [(&both[..], &none), (&both[..1], &unwritable)] {
            assert!(add_signed(folders, register, &signed.revision()).is_err());
            assert_eq!(signatures(other.path(), &none), Signatures::default());
        }
    }
}
