//! The console: engine, keys, signals and screen, each in a thread of its own; this one draws.

mod crash;
mod engine;
mod inbox;
mod line;
mod pace;
mod screen;
mod watch;

use crate::{
    cli::{Drill, LogsArg},
    failure::bad_input,
    planners::{check_choices, surveyed},
};
use engine::Engine;
use inbox::{Inbox, Outbox, inbox};
use line::EngineHandle;
use planner_host::PluginDirs;
use runs::check_logs;
use scenario::Scenario;
use screen::{Left, Screen};
use std::{
    io::IsTerminal,
    panic::{AssertUnwindSafe, catch_unwind},
    path::Path,
    process::ExitCode,
};
use tui::{Caps, Msg, Refused, terminal};

/// Opens the console on a scenario; returns when the operator leaves.
pub(crate) fn open(
    scenario: &Scenario,
    logs: &LogsArg,
    plugins: &PluginDirs,
    drill: Option<Drill>,
) -> anyhow::Result<ExitCode> {
    check_terminal()?;
    let (found, refused) = surveyed(plugins);
    check_choices(scenario, &found)?;
    check_logs(&logs.logs)?;
    let (outbox, inbox) = inbox();
    let engine = Engine::start(scenario, &logs.logs, plugins, outbox.clone(), drill)?;
    let refused = refused.into_iter().map(|(plugin, reason)| Refused { plugin, reason }).collect();
    outbox.send(Msg::Planners { found, refused });
    let left = show(&engine.handle(), &logs.logs, (outbox, inbox), drill);
    // Whatever happened to the screen, the run is closed cleanly.
    let closed = engine.close(left.as_ref().is_ok_and(|left| left.signal.is_some()));
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
    engine: &EngineHandle,
    logs: &Path,
    (outbox, inbox): (Outbox, Inbox),
    drill: Option<Drill>,
) -> anyhow::Result<Left> {
    let caps = Caps::from_env(|name| std::env::var(name).ok());
    let panic_outbox = outbox.clone();
    terminal::install_panic_hook(move |thread, message| {
        let panicked = Msg::ThreadPanicked { thread: thread.into(), message: message.into() };
        panic_outbox.send_urgent(panicked);
    });
    let mut screen = Screen::open(caps, inbox, engine.clone(), drill)?;
    watch::keys(&outbox, engine.clone())?;
    watch::signals(&outbox, engine.clone())?;
    watch::terminal(&outbox, engine.clone())?;
    drop(outbox);
    let ran = catch_unwind(AssertUnwindSafe(|| screen.run()));
    ran.unwrap_or_else(|_| Err(crash::report(logs, screen.model())))
}
