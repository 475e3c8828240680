//! Files of a run that are beside the journal and the recording: the output of planners, and the crash files of planners
//! that failed. The run is complete without these files, so write errors are ignored.

use std::{
    fs::{self, File, OpenOptions},
    io::Write,
    path::{Path, PathBuf},
};

/// File name of the planners' output.
const OUTPUT_FILE: &str = "planner.log";
/// Maximum size of the planners' output, bytes.
const MOST_OUTPUT: usize = 4 << 20;
/// Maximum number of crashes saved per run.
const MOST_CRASHES: usize = 10;

/// The files of a run beside its journal.
#[derive(Debug)]
pub(crate) struct Beside {
    folder: PathBuf,
    output: Option<File>,
    written: usize,
    n_crashes: usize,
}

impl Beside {
    /// No files have been written yet.
    pub(crate) fn new(folder: &Path) -> Self {
        Self { folder: folder.to_owned(), output: None, written: 0, n_crashes: 0 }
    }

    /// Appends to the output of planners.
    pub(crate) fn keep_output(&mut self, text: &str) {
        if text.is_empty() || self.written > MOST_OUTPUT {
            return;
        }
        self.written += text.len();
        let last = if self.written > MOST_OUTPUT { "(further output is not kept)\n" } else { "" };
        if self.output.is_none() {
            let file = self.folder.join(OUTPUT_FILE);
            self.output = OpenOptions::new().create(true).append(true).open(file).ok();
        }
        if let Some(output) = &mut self.output {
            let _ = output.write_all(text.as_bytes()).and_then(|()| output.write_all(last.as_bytes()));
        }
    }

    /// Saves the crash files of a planner that failed, in a separate folder.
    pub(crate) fn keep_crash(&mut self, files: &[(&str, Vec<u8>)]) {
        if self.n_crashes == MOST_CRASHES {
            return;
        }
        self.n_crashes += 1;
        let folder = self.folder.join(format!("crash-{}", self.n_crashes));
        let write = |(name, bytes): &(&str, Vec<u8>)| fs::write(folder.join(name), bytes);
        let _ = fs::create_dir(&folder).and_then(|()| files.iter().try_for_each(write));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_written_before_there_is_something() {
        let folder = tempfile::tempdir().unwrap();
        let mut beside = Beside::new(folder.path());
        beside.keep_output("");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
        beside.keep_output("one\n");
        beside.keep_output("two\n");
        assert_eq!(fs::read_to_string(folder.path().join(OUTPUT_FILE)).unwrap(), "one\ntwo\n");
    }

    #[test]
    fn output_and_crashes_are_limited() {
        let folder = tempfile::tempdir().unwrap();
        let mut beside = Beside::new(folder.path());
        for _ in 0..20 {
            beside.keep_output(&"x".repeat(1 << 20));
            beside.keep_crash(&[("a", vec![1])]);
        }
        let output = fs::read_to_string(folder.path().join(OUTPUT_FILE)).unwrap();
        assert!(output.len() < MOST_OUTPUT + (2 << 20) && output.ends_with("(further output is not kept)\n"));
        assert_eq!(fs::read(folder.path().join("crash-10/a")).unwrap(), [1]);
        assert!(!folder.path().join("crash-11").exists());
    }
}
