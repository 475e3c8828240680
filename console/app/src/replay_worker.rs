//! `tankops replay-worker`: a plugin alone, asked once more what it was asked before it failed.

use flight::failure::{COMPLETE, ENDED_OTHERWISE, bad_input};
use planner_host::{Replayed, WorkerCommand};
use report::print::{say, say_line};
use std::{env, fs, path::Path, process::ExitCode};

/// `tankops replay-worker BUNDLE`.
pub(crate) fn replay(bundle: &Path, gdb: bool) -> anyhow::Result<ExitCode> {
    let file = bundle.join("frames.bin");
    let frames = fs::read(&file)
        .map_err(|error| bad_input(format!("{}: {error}; name a folder crash-N of a run", file.display())))?;
    if let Ok(about) = fs::read_to_string(bundle.join("crash.txt")) {
        say(&about)?;
    }
    let worker = if gdb { in_gdb()? } else { WorkerCommand::default() };
    let mut say_each = |line: &str| {
        let _ = say_line(line);
    };
    let replayed = planner_host::replay(&frames, &worker, gdb, &mut say_each);
    let replayed = replayed.map_err(|why| bad_input(format!("{}: {why}", file.display())))?;
    let (code, end) = match replayed {
        Replayed::ToTheEnd => (COMPLETE, "every request was answered: it does not fail again".to_owned()),
        Replayed::Failed(how) => (ENDED_OTHERWISE, format!("failed again at {how}")),
    };
    say_line(&end)?;
    Ok(ExitCode::from(code))
}

/// A worker inside gdb, which has the terminal; the worker's socket is kept at descriptor 3 for it.
fn in_gdb() -> anyhow::Result<WorkerCommand> {
    let program = env::current_exe()?;
    let script = "exec 3<&0 </dev/tty >/dev/tty 2>&1; export TERM=xterm HOME=/nonexistent; \
                  exec gdb -q -nx -ex 'set confirm off' -ex 'run worker <&3' \"$0\"";
    Ok(WorkerCommand {
        program: "/bin/sh".into(),
        arguments: vec!["-c".into(), script.into(), program.into()],
    })
}
