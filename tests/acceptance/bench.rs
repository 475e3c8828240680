//! Starting `tankops` and reading its output and files.

use recording::{JOURNAL_FILE, PLAIN_JOURNAL_FILE};
use serde_json::Value;
use std::{
    io::{Read, Write},
    path::{Path, PathBuf},
    process::{Command, Output},
};
use tempfile::TempDir;

/// The workspace's folder.
pub(crate) fn workspace() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize().unwrap()
}

/// A shipped scenario.
pub(crate) fn scenario(name: &str) -> PathBuf {
    workspace().join("scenarios").join(name)
}

/// Reports that a test is skipped, with the reason; `.ci/run` lists these lines at its end.
#[allow(clippy::print_stderr, reason = "a test that is passed over says so")]
pub(crate) fn passed_over(why: &str) {
    let line = format!("passed over: {why}");
    eprintln!("{line}");
    let Some(list) = std::env::var_os("TANKOPS_PASSED_OVER") else { return };
    let list = std::fs::OpenOptions::new().create(true).append(true).open(list);
    writeln!(list.unwrap(), "{line}").unwrap();
}

/// A new folder for runs and files, and the command to work in it.
pub(crate) struct Bench {
    folder: TempDir,
}

impl Bench {
    pub(crate) fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join("logs")).unwrap();
        Self { folder }
    }

    pub(crate) fn path(&self) -> &Path {
        self.folder.path()
    }

    /// Writes a file and returns its path.
    pub(crate) fn file(&self, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
        let path = self.path().join(name);
        std::fs::write(&path, content).unwrap();
        path
    }

    /// `tankops` in this folder; test-only plugins are in `deps` beside the program.
    pub(crate) fn command(&self) -> Command {
        self.command_of(Path::new(env!("CARGO_BIN_EXE_tankops")))
    }

    /// The same command with a different build of `tankops`.
    pub(crate) fn command_of(&self, program: &Path) -> Command {
        let mut command = Command::new(program);
        command.current_dir(self.path()).env_remove("TANKOPS_PLUGIN_PATH");
        // Keeps the developer's own settings from affecting the tests.
        command.env("XDG_CONFIG_HOME", self.path()).env("XDG_STATE_HOME", self.path());
        command.env("XDG_CACHE_HOME", env!("CARGO_TARGET_TMPDIR"));
        command.arg("--plugin-dir").arg(Path::new(env!("CARGO_BIN_EXE_tankops")).with_file_name("deps"));
        command
    }

    /// Runs `tankops` with arguments.
    pub(crate) fn tankops(&self, arguments: &[&str]) -> Ended {
        Ended::from(self.command().args(arguments).output().unwrap())
    }

    /// Runs a scenario headless and returns the report.
    pub(crate) fn fly(&self, scenario: &Path, more: &[&str]) -> Ended {
        let mut command = self.command();
        command.arg("run").arg(scenario).arg("--json").args(more);
        Ended::from(command.output().unwrap())
    }

    /// Verifies a run.
    pub(crate) fn verify(&self, run: &Path, more: &[&str]) -> Ended {
        Ended::from(self.command().arg("verify").arg(run).args(more).output().unwrap())
    }

    /// Checks that recomputing a run gives the same journal, with and without asking the planners again.
    pub(crate) fn prove(&self, run: &Path) {
        self.prove_with(run, &[]);
    }

    /// The same check, with more options.
    pub(crate) fn prove_with(&self, run: &Path, options: &[&str]) {
        for more in [&[][..], &["--from-journal"]] {
            let verified = self.verify(run, &[more, options].concat());
            assert!(verified.code == Some(0) && verified.out.contains("equal: "), "{more:?}: {verified:?}");
        }
    }

    /// Folders of runs, oldest first.
    pub(crate) fn runs(&self) -> Vec<PathBuf> {
        let mut runs: Vec<PathBuf> = std::fs::read_dir(self.path().join("logs"))
            .map(|entries| entries.map(|entry| entry.unwrap().path()).filter(|path| path.is_dir()).collect())
            .unwrap_or_default();
        runs.sort();
        runs
    }
}

/// The output of a finished `tankops`.
#[derive(Debug)]
pub(crate) struct Ended {
    pub code: Option<i32>,
    pub out: String,
    pub err: String,
}

impl From<Output> for Ended {
    fn from(output: Output) -> Self {
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
        Self { code: output.status.code(), out: text(output.stdout), err: text(output.stderr) }
    }
}

impl Ended {
    /// Stdout as JSON.
    pub(crate) fn json(&self) -> Value {
        serde_json::from_str(&self.out).unwrap_or_else(|error| panic!("{error} in {self:?}"))
    }
}

/// The lines of a journal as text.
pub(crate) fn journal_text(run: &Path) -> String {
    let file = std::fs::File::open(run.join(JOURNAL_FILE));
    let Ok(file) = file else { return std::fs::read_to_string(run.join(PLAIN_JOURNAL_FILE)).unwrap() };
    let mut bytes = Vec::new();
    // The journal of a killed writer ends within a frame, which is an error after the readable part.
    let _ = zstd::Decoder::new(file).unwrap().read_to_end(&mut bytes);
    String::from_utf8(bytes).unwrap()
}

/// Replaces the journal of a run with an uncompressed one.
pub(crate) fn change_journal(run: &Path, text: &str) {
    let _ = std::fs::remove_file(run.join(JOURNAL_FILE));
    std::fs::write(run.join(PLAIN_JOURNAL_FILE), text).unwrap();
}

/// The lines of a journal.
pub(crate) fn journal(run: &Path) -> Vec<Value> {
    journal_text(run).lines().filter_map(|line| serde_json::from_str(line).ok()).collect()
}

/// The events of one kind.
pub(crate) fn of_kind<'a>(events: &'a [Value], kind: &str) -> Vec<&'a Value> {
    events.iter().filter(|event| event["event"] == kind).collect()
}

/// The index of the first event of a kind in a journal.
pub(crate) fn first_of(events: &[Value], kind: &str) -> Option<usize> {
    events.iter().position(|event| event["event"] == kind)
}
