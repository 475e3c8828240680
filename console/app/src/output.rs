//! Writes results to files.

use anyhow::Context;
use flight::failure::{bad_input, not_written};
use foreign::{plain_json, plain_lines};
use report::document::Revision;
use review::register;
use runs::is_run;
use std::{
    borrow::Cow,
    fs::{self, File, OpenOptions},
    io,
    os::unix::fs::MetadataExt,
    path::Path,
};

/// Checks that an output file named by the user may be written. An existing file, or the target of a link, is
/// overwritten only if `force` is `Some(true)`; `force` is `None` for a command without `--force`. The command's own
/// `inputs`, signed reports and the files of runs are never overwritten. Pipes and devices are written to directly.
///
/// # Errors
/// The file, or a link with this name, exists and may not be overwritten.
pub(crate) fn check_free(file: &Path, force: Option<bool>, inputs: &[&Path]) -> anyhow::Result<()> {
    let is_free = match fs::symlink_metadata(file) {
        Err(_) => true,
        Ok(_) => fs::metadata(file).is_ok_and(|there| !there.is_file() && !there.is_dir()),
    };
    if let Some(why) = never_replaced(file, inputs).filter(|_| !is_free) {
        return Err(bad_input(format!("{} {why}; choose another name", file.display())));
    }
    if is_free || force == Some(true) {
        return Ok(());
    }
    let instead = if force.is_some() { "choose another name, or use --force" } else { "choose another name" };
    Err(bad_input(format!("{} already exists; {instead}", file.display())))
}

/// The reason why an existing file must not be overwritten, even with `--force`.
fn never_replaced(file: &Path, inputs: &[&Path]) -> Option<String> {
    let path = fs::canonicalize(file).ok()?;
    if inputs.iter().any(|input| is_same(&path, input)) {
        return Some("is an input of this command".into());
    }
    if let Some(Revision { revision, .. }) = register().signed_as(&path) {
        return Some(format!("is the signed revision {revision}, which must not be changed"));
    }
    let is_page = path.extension().is_some_and(|suffix| suffix == "html");
    (!is_page && path.parent().is_some_and(is_run)).then(|| "is part of a run".into())
}

/// Whether two paths refer to the same file, following links.
fn is_same(one: &Path, other: &Path) -> bool {
    let id = |path: &Path| fs::metadata(path).map(|file| (file.dev(), file.ino())).ok();
    id(one).is_some_and(|one| id(other) == Some(one))
}

/// Writes an output file named by the user (see [`check_free`]), completely or not at all; error messages call it
/// `name`.
pub(crate) fn write_file(name: &str, file: &Path, text: &str) -> anyhow::Result<()> {
    runs::write_whole(file, in_plain(file, text).as_bytes()).map_err(|error| not_written(name, &error, file))
}

/// Like [`write_file`], for a file that is too long for the memory: `write` fills it. Returns what `write` returns.
pub(crate) fn fill_file<T>(
    name: &str,
    file: &Path,
    write: impl FnOnce(&mut File) -> anyhow::Result<T>,
) -> anyhow::Result<T> {
    let mut made = None;
    let fill = |out: &mut File| -> anyhow::Result<()> {
        made = Some(write(out)?);
        Ok(())
    };
    let is_pipe_or_device = fs::metadata(file).is_ok_and(|there| !there.is_file() && !there.is_dir());
    let filled = if is_pipe_or_device {
        OpenOptions::new()
            .write(true)
            .open(file)
            .map_err(anyhow::Error::from)
            .and_then(|mut out| fill(&mut out))
    } else {
        runs::write_whole_with(file, fill)
    };
    filled.map_err(|error| match error.downcast::<io::Error>() {
        Ok(error) => not_written(name, &error, file),
        Err(other) => other,
    })?;
    made.with_context(|| format!("{} was not written", file.display()))
}

/// The text with unsafe characters replaced. An HTML page is left as it is: its characters were replaced when the page
/// was generated, and the page may be signed.
fn in_plain<'a>(file: &Path, text: &'a str) -> Cow<'a, str> {
    match file.extension().unwrap_or_default().to_string_lossy().to_lowercase().as_str() {
        "json" | "geojson" => plain_json(text),
        "html" => text.into(),
        _ => plain_lines(text),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]

    use super::*;
    use flight::failure::is_input;
    use std::os::unix::fs::symlink;

    #[test]
    fn nothing_is_written_over_unless_it_is_asked_for() {
        let folder = tempfile::tempdir().unwrap();
        let [file, link, nowhere] = ["file", "link", "nowhere"].map(|name| folder.path().join(name));
        fs::write(&file, "kept").unwrap();
        symlink(&file, &link).unwrap();
        symlink(folder.path().join("none"), &nowhere).unwrap();
        for there in [file.as_path(), &link, &nowhere, folder.path()] {
            let refused = check_free(there, Some(false), &[]).unwrap_err().to_string();
            assert!(refused.ends_with("already exists; choose another name, or use --force"), "{refused}");
            assert!(check_free(there, None, &[]).unwrap_err().to_string().ends_with("choose another name"));
            assert!(check_free(there, Some(true), &[]).is_ok());
        }
        assert!(check_free(Path::new("/dev/null"), None, &[]).is_ok());
        assert!(check_free(&folder.path().join("new"), None, &[]).is_ok());
    }

    #[test]
    fn what_a_command_reads_and_the_files_of_runs_are_never_written_over() {
        let folder = tempfile::tempdir().unwrap();
        let [file, linked, journal, page] =
            ["readings.csv", "linked.csv", recording::JOURNAL_FILE, "page.html"]
                .map(|name| folder.path().join(name));
        fs::write(&file, "readings").unwrap();
        fs::hard_link(&file, &linked).unwrap();
        for there in [&file, &linked] {
            let refused = check_free(there, Some(true), &[&file]).unwrap_err().to_string();
            assert!(refused.ends_with("is an input of this command; choose another name"), "{refused}");
        }
        assert!(check_free(&file, Some(true), &[&page]).is_ok());
        fs::write(&journal, "").unwrap();
        let refused = check_free(&journal, Some(true), &[]).unwrap_err().to_string();
        assert!(refused.ends_with("is part of a run; choose another name"), "{refused}");
        // The page is neither an input nor part of a run.
        fs::write(&page, "").unwrap();
        assert!(check_free(&page, Some(true), &[]).is_ok());
    }

    #[test]
    fn a_file_that_a_full_disk_cuts_off_is_not_left_behind() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("fixes.csv");
        let fill = |kind: io::ErrorKind| {
            fill_file("the fixes", &file, |out| {
                io::Write::write_all(out, b"t_s\n")?;
                Err::<(), _>(io::Error::from(kind).into())
            })
        };
        let full = fill(io::ErrorKind::StorageFull).unwrap_err();
        assert!(!is_input(&full) && full.to_string().starts_with("cannot write the fixes: "), "{full}");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
        fs::write(&file, "kept").unwrap();
        assert!(is_input(&fill(io::ErrorKind::PermissionDenied).unwrap_err()));
        assert_eq!(fs::read_to_string(&file).unwrap(), "kept");
        assert_eq!(fill_file("the fixes", &file, |_| Ok(7)).unwrap(), 7);
        assert_eq!(fs::read_to_string(&file).unwrap(), "");
    }

    #[test]
    fn files_are_in_plain_characters() {
        let plain = |file: &str, text| in_plain(Path::new(file), text).into_owned();
        assert_eq!(plain("a.geojson", "{\"a\": \"\u{9b}\"}\n"), "{\"a\": \"\\u009b\"}\n");
        assert_eq!(plain("a.dxf", "0\nTEXT\n\u{202e}"), "0\nTEXT\n�");
    }
}
