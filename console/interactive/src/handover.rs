//! Writes handover pages.

use super::inbox::Outbox;
use anyhow::{Context, bail};
use mission::Severity;
use std::{fs::File, io::Read, path::Path, thread, time::SystemTime};
use tui::Msg;

/// The first line of every page; only a file with this line is ever replaced.
const MARK: &str = "<!-- tankops handover page -->\n";

/// Writes a page on a separate thread, because a disk can be slow, and tells the operator the result.
pub(super) fn begin(file: &str, page: String, overwrite: bool, outbox: &Outbox) {
    let (told, fallback) = (outbox.clone(), outbox.clone());
    let tell = |outbox: &Outbox, written: anyhow::Result<()>, file: &str| {
        let (severity, text) = match written {
            Ok(()) => (Severity::Info, format!("handover page written: {file}")),
            Err(error) => (Severity::Warn, format!("handover page not written: {error:#}")),
        };
        outbox.send(Msg::Notice { severity, text });
    };
    let began = thread::Builder::new().name("handover".into()).spawn({
        let file = file.to_owned();
        move || tell(&told, write(Path::new(&file), &page, overwrite), &file)
    });
    if let Err(error) = began {
        tell(&fallback, Err(error.into()), file);
    }
}

fn write(file: &Path, page: &str, overwrite: bool) -> anyhow::Result<()> {
    let shown = file.display();
    match file.symlink_metadata() {
        Ok(_) if !is_page(file) => bail!("{shown} exists and is not a handover page; choose another file"),
        Ok(_) if !overwrite => {
            bail!("{shown} exists; choose another file, or `handover {shown} overwrite` to replace the page")
        }
        // The file does not exist, or the operator has agreed to replace the page.
        _ => {}
    }
    let written = format!("{MARK}{page}\nWritten {}.\n", runs::utc_minute(SystemTime::now()));
    runs::write_whole(file, written.as_bytes()).with_context(|| shown.to_string())
}

/// Whether a file is a handover page. A device or a pipe is not read.
fn is_page(file: &Path) -> bool {
    let begins = |file: File| {
        let mut begin = vec![0; MARK.len()];
        file.take(MARK.len() as u64).read_exact(&mut begin).map(|()| begin == MARK.as_bytes())
    };
    foreign::open_regular(file).and_then(begins).unwrap_or(false)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]

    use super::*;

    #[test]
    fn a_page_is_written_and_replaced_only_if_that_is_said() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("handover.md");
        write(&file, "# one\n", false).unwrap();
        let error = write(&file, "# two\n", false).unwrap_err().to_string();
        assert!(error.contains("overwrite"), "{error}");
        assert!(std::fs::read_to_string(&file).unwrap().contains("# one"));
        write(&file, "# two\n", true).unwrap();
        let text = std::fs::read_to_string(&file).unwrap();
        assert!(text.starts_with(MARK) && text.contains("# two\n") && text.contains("Written 20"), "{text}");
    }

    #[test]
    fn nothing_but_a_page_is_ever_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let program = folder.path().join("tankops");
        std::fs::write(&program, "\x7fELF").unwrap();
        let empty = folder.path().join("empty");
        std::fs::write(&empty, "").unwrap();
        let pipe = folder.path().join("pipe");
        rustix::fs::mkfifoat(rustix::fs::CWD, &pipe, rustix::fs::Mode::RWXU).unwrap();
        let link = folder.path().join("link");
        std::os::unix::fs::symlink(&program, &link).unwrap();
        let nowhere = folder.path().join("nowhere");
        std::os::unix::fs::symlink(folder.path().join("gone"), &nowhere).unwrap();
        for file in [&program, &empty, &pipe, &link, &nowhere, &folder.path().to_owned()] {
            let error = write(file, "# page\n", true).unwrap_err().to_string();
            assert!(error.contains("is not a handover page"), "{error}");
        }
        assert_eq!(std::fs::read_to_string(&program).unwrap(), "\x7fELF");
    }

    #[test]
    fn a_folder_that_is_not_there_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let error = write(&folder.path().join("none/page.md"), "# page\n", false).unwrap_err();
        assert!(format!("{error:#}").contains("none/page.md"), "{error:#}");
    }
}
