//! The console: engine, keys, signals and screen, each in a thread of its own; this one draws.

mod checking;
mod comparing;
mod crash;
mod desk;
mod engine;
mod forecasting;
mod inbox;
mod jobs;
mod line;
mod look;
mod measure;
mod pace;
mod screen;
mod watch;

use crate::{
    cli::{ConsoleArgs, Drill, GlyphSet},
    failure::bad_input,
    planners::surveyed,
    scenarios,
};
use desk::{Desk, DeskHandle, Known, Request, Tools};
use inbox::{Inbox, Outbox, inbox};
use line::Current;
use planner_host::PluginDirs;
use runs::check_logs;
use screen::{Left, Screen};
use std::{
    io::IsTerminal,
    panic::{AssertUnwindSafe, catch_unwind},
    path::Path,
    process::ExitCode,
};
use tui::{Caps, Model, Msg, RunId, Source, terminal};

/// Opens the console on a scenario, or on the demo; returns when the operator leaves.
pub(crate) fn open(args: &ConsoleArgs, plugins: &PluginDirs) -> anyhow::Result<ExitCode> {
    check_terminal()?;
    let ConsoleArgs { changes, speed, glyphs, drill, .. } = args;
    let logs = &args.logs.logs;
    let (source, scenario) = match &args.scenario {
        Some(path) => (Source::File(path.display().to_string()), scenarios::read(path, changes)?),
        None => (Source::Demo, scenarios::demo_with(changes)?),
    };
    let (found, refused) = surveyed(plugins);
    check_logs(logs)?;
    let (outbox, inbox) = inbox();
    let tools = Tools {
        logs: logs.clone(),
        plugins: plugins.clone(),
        planners: Known::default(),
        outbox: outbox.clone(),
    };
    tools.planners.set(found.clone());
    let mut desk = Desk::new(tools, changes.clone(), *speed, *drill);
    let run = RunId(1);
    // Before the screen opens, so that its first frame shows the scenario and every key counts.
    desk.open(run, &scenario)?;
    outbox.send(Msg::Planners { found, refused });
    let current = desk.current();
    let (desk, thread) = desk.start()?;
    desk.request(Request::Look);
    let left = show(
        &Model::opened(run, source, *speed),
        logs,
        (outbox, inbox),
        (current, desk.clone()),
        (*glyphs, *drill),
    );
    // Whatever happened to the screen, the run is closed cleanly.
    desk.request(Request::Leave { hurry: left.as_ref().is_ok_and(|left| left.signal.is_some()) });
    let closed = thread.join().map_err(|_| anyhow::anyhow!("the thread that closes the run panicked"))?;
    Ok(left?.report_end(closed?.as_ref()))
}

fn check_terminal() -> anyhow::Result<()> {
    if !std::io::stdout().is_terminal() || !std::io::stdin().is_terminal() {
        return Err(bad_input(
            "the console needs a terminal on stdin and stdout; without one use `tankops run SCENARIO`",
        ));
    }
    if std::env::var("TERM").is_ok_and(|term| term == "dumb") {
        return Err(bad_input("the console cannot draw on TERM=dumb; use `tankops run SCENARIO`"));
    }
    Ok(())
}

fn show(
    model: &Model,
    logs: &Path,
    (outbox, inbox): (Outbox, Inbox),
    (current, desk): (Current, DeskHandle),
    (glyphs, drill): (Option<GlyphSet>, Option<Drill>),
) -> anyhow::Result<Left> {
    let mut caps = Caps::from_env(|name| std::env::var(name).ok());
    caps.glyphs = glyphs.map_or(caps.glyphs, Into::into);
    let panic_outbox = outbox.clone();
    terminal::install_panic_hook(move |thread, message| {
        let panicked = Msg::ThreadPanicked { thread: thread.into(), message: message.into() };
        panic_outbox.send_urgent(panicked);
    });
    let places = watch::SharedPlaces::default();
    let line = (current.clone(), desk);
    let mut screen = Screen::open(caps, model.clone(), inbox, line, places.clone(), drill)?;
    watch::keys(&outbox, current.clone(), places)?;
    watch::signals(&outbox, current.clone())?;
    watch::terminal(&outbox, current.clone())?;
    watch::disk(&outbox, logs)?;
    drop(outbox);
    let ran = catch_unwind(AssertUnwindSafe(|| screen.run()));
    ran.unwrap_or_else(|_| Err(crash::report(logs, screen.model())))
}
