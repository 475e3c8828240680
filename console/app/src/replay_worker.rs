//! `tankops replay-worker`: sends a plugin, on its own, the requests that it received before it failed.

use crate::cli::ReplayWorkerArgs;
use anyhow::anyhow;
use flight::failure::{COMPLETE, ENDED_OTHERWISE, bad_input};
use flight::remains::{CRASH_FILE, FRAMES_FILE, check_frames};
use planner_host::{NotReplayed, Replayed, WorkerCommand, plugin_of};
use report::print::{say, say_line};
use std::{
    env, fs, io,
    path::{Path, PathBuf},
    process::{self, ExitCode},
};

/// The worker's descriptor for its copy of the plugin; gdb identifies the plugin by this number.
const KNOWN_TO_GDB_AS: &str = "201";
/// The files that gdb writes into a bundle.
const CORE: &str = "core";
const TRACE: &str = "backtrace.txt";

/// Runs `tankops replay-worker BUNDLE`.
pub(crate) fn replay(args: &ReplayWorkerArgs) -> anyhow::Result<ExitCode> {
    let bundle = &args.bundle;
    let kept = |name: &str| {
        let file = bundle.join(name);
        let read = fs::read(&file).map_err(|error| {
            bad_input(format!("{}: {error}; name a complete folder crash-N of a run", file.display()))
        });
        read.map(|bytes| (file, bytes))
    };
    let ((file, frames), (_, about)) = (kept(FRAMES_FILE)?, kept(CRASH_FILE)?);
    let about = String::from_utf8_lossy(&about);
    check_frames(&about, &frames).map_err(|why| bad_input(format!("{} {why}", file.display())))?;
    say(&about)?;
    let gdb = (args.gdb || args.core).then(|| Gdb::for_plugin(plugin_of(&frames).as_deref())).transpose()?;
    let worker = match &gdb {
        Some(gdb) if args.core => gdb.leaving_core(bundle)?,
        Some(gdb) => gdb.at_terminal()?,
        None => WorkerCommand::default(),
    };
    let mut say_each = |line: &str| {
        let _ = say_line(line);
    };
    let replayed = planner_host::replay(&frames, &worker, gdb.is_some(), &mut say_each);
    let replayed = replayed.map_err(|why| match why {
        NotReplayed::Damaged(why) => bad_input(format!("{} {why}", file.display())),
        NotReplayed::Machine(why) => anyhow!(why),
    });
    let (code, end) = match replayed? {
        Replayed::ToTheEnd { requests } => {
            (COMPLETE, format!("all {requests} answers were accepted: the plugin did not fail again"))
        }
        Replayed::Failed(how) => (ENDED_OTHERWISE, format!("failed again at {how}")),
    };
    say_line(&end)?;
    if args.core {
        say_line(&left_in(bundle))?;
    }
    Ok(ExitCode::from(code))
}

fn left_in(bundle: &Path) -> String {
    let is_there = |name: &&str| bundle.join(name).is_file();
    let left: Vec<String> = [CORE, TRACE]
        .iter()
        .filter(|name| is_there(name))
        .map(|name| bundle.join(name).display().to_string())
        .collect();
    if left.is_empty() {
        "gdb wrote neither a core dump nor a backtrace; is gdb installed?".to_owned()
    } else {
        left.join("\n")
    }
}

/// Runs gdb around a worker, keeping the worker's socket at descriptor 3. The worker loads the plugin from memory; a
/// link to the plugin's file is placed where gdb looks for it.
struct Gdb {
    /// The folder with the link; removed on drop.
    libraries: PathBuf,
}

impl Gdb {
    fn for_plugin(plugin: Option<&Path>) -> io::Result<Self> {
        let libraries = env::temp_dir().join(format!("tankops-gdb-{}", process::id()));
        fs::create_dir(&libraries)?;
        let gdb = Self { libraries };
        if let Some(plugin) = plugin {
            std::os::unix::fs::symlink(std::path::absolute(plugin)?, gdb.libraries.join(KNOWN_TO_GDB_AS))?;
        }
        Ok(gdb)
    }

    /// A command that runs gdb interactively in the terminal.
    fn at_terminal(&self) -> io::Result<WorkerCommand> {
        let then = r"-ex 'echo Set breakpoints in your planner if you like, then type: run\n'";
        self.command("</dev/tty >/dev/tty 2>&1", then, Path::new(""))
    }

    /// A command that runs gdb unattended and writes a core dump and a backtrace into a folder.
    fn leaving_core(&self, folder: &Path) -> io::Result<WorkerCommand> {
        let then = format!(
            "-batch -ex run -ex \"generate-core-file $2/{CORE}\" -ex 'thread apply all backtrace full'"
        );
        self.command(&format!("</dev/null >\"$2/{TRACE}\" 2>&1"), &then, folder)
    }

    fn command(&self, streams: &str, then: &str, folder: &Path) -> io::Result<WorkerCommand> {
        let script = format!(
            "exec 3<&0 {streams}; export TERM=xterm HOME=/nonexistent; \
             exec gdb -q -nx -ex 'set confirm off' -ex \"set solib-search-path $1\" -ex 'set breakpoint pending on' \
             -ex 'set args worker <&3' {then} \"$0\""
        );
        let (program, libraries) = (env::current_exe()?, self.libraries.clone());
        let arguments = ["-c".into(), script.into(), program.into(), libraries.into(), folder.into()];
        Ok(WorkerCommand { program: "/bin/sh".into(), arguments: arguments.into() })
    }
}

impl Drop for Gdb {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.libraries);
    }
}
