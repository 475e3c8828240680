//! Flying a mission without a terminal: `tankops run`, and `tankops` where there is no terminal.

use crate::{
    accuracy::warn_of_clearance,
    answers::{InOrder, Window, Windowed},
    cli::{LogsArg, RunArgs},
    failure::{COMPLETE, ENDED_OTHERWISE},
    flight::Flight,
    output::{say, say_line, warn_line},
    plan::patient,
    plan_watch::{PlanWatch, Watched},
    progress,
    run_log::{Closed, RunLog},
    stop_signal::{self, StopSignal},
};
use anyhow::Context;
use indicatif::{ProgressBar, ProgressStyle};
use mission::{Event, EventKind, Order, Outcome, Phase};
use planner_host::{Host, HostConfig, PluginDirs};
use report::{PlannerCalls, Summary};
use scenario::Scenario;
use std::{io::IsTerminal, process::ExitCode, time::Duration};

/// How long closing the recording may take before it is abandoned with a message.
pub(crate) const CLOSE_TIMEOUT: Duration = Duration::from_secs(10);

/// Options of a headless run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct RunOptions {
    /// Print the report as JSON on stdout, and nothing else there.
    pub json: bool,
    /// Write a journal and a recording.
    pub record: bool,
    /// Apply the console's answer windows: an answer that comes later counts as late.
    pub live_deadlines: bool,
}

/// `tankops run`.
pub(crate) fn run(args: &RunArgs, plugins: &PluginDirs) -> anyhow::Result<ExitCode> {
    let scenario = crate::read_scenario(&args.scenario, &args.changes)?;
    let (json, record, live_deadlines) = (args.json, !args.no_record, args.live_deadlines);
    fly(&scenario, plugins, &args.logs, RunOptions { json, record, live_deadlines })
}

/// Flies a scenario to its end and prints the result.
pub(crate) fn fly(
    scenario: &Scenario,
    plugins: &PluginDirs,
    logs: &LogsArg,
    options: RunOptions,
) -> anyhow::Result<ExitCode> {
    let stop = stop_signal::listen();
    crate::planners::check_choices(scenario, &crate::planners::found(plugins))?;
    warn_of_clearance(scenario);
    let flight = Flight::prepare(scenario, false);
    let mut log = if options.record {
        RunLog::create(&logs.logs, scenario, &scenario.mission.planner.id)?
    } else {
        RunLog::unwritten()?
    };
    let bar = progress_bar(scenario, options);
    let mut trouble = None;
    let mut take = |events: Vec<Event>| {
        log.keep(&events);
        show_progress(&bar, &events);
        report_trouble(&mut trouble, log.health().error);
    };
    take(vec![flight.opened()]);
    let host = fly_to_end(flight, host(scenario, plugins), take, (&bar, &stop), options.live_deadlines);
    bar.finish_and_clear();
    let Closed { summary, kept } = log.close(CLOSE_TIMEOUT, scenario, &host, None);
    print_summary(&summary, options)?;
    match &kept {
        Some(kept) if kept.problem().is_some() => warn_line(&kept.text()),
        Some(kept) if !options.json => say_line(&kept.text())?,
        _ => {}
    }
    let code = exit_code(&summary);
    Ok(ExitCode::from(kept.map_or(code, |kept| kept.exit_code(code))))
}

/// Reports on stderr, once each, that recording fails and that it has resumed.
fn report_trouble(reported: &mut Option<String>, trouble: Option<String>) {
    match (&reported, &trouble) {
        (None, Some(error)) => warn_line(&format!("warning: recording fails: {error}")),
        (Some(_), None) => warn_line("recording resumed, nothing was lost"),
        _ => {}
    }
    *reported = trouble;
}

/// Flies to the end; every ask is answered before time moves on, or within the console's windows.
fn fly_to_end(
    mut flight: Flight,
    host: Host,
    mut take: impl FnMut(Vec<Event>),
    (bar, stop): (&ProgressBar, &StopSignal),
    live_deadlines: bool,
) -> Host {
    let mut answers = InOrder::new(host);
    let (on_work, on_progress) = progress::shown_in(bar);
    answers.host().set_on_progress(on_progress);
    stop_signal::wake_on_signal(answers.host().waker());
    let mut watch = PlanWatch::new(answers.host().plan_budget(), Some(on_work));
    let mut orders = vec![Order::Start];
    while !matches!(flight.phase(), Phase::Ended(_)) {
        if stop.requested() {
            orders.push(Order::Abort);
        }
        take(if live_deadlines {
            let window = Window::real_time(flight.tick_length());
            let mut windowed = Windowed::new(answers.host(), window);
            flight.tick(&orders, &mut Watched::new(&mut windowed, &mut watch))
        } else {
            flight.tick(&orders, &mut Watched::new(&mut answers, &mut watch))
        });
        orders.clear();
    }
    answers.into_host()
}

/// A host for the planners of a scenario.
pub(crate) fn host(scenario: &Scenario, plugins: &PluginDirs) -> Host {
    Host::new(plugins, patient(HostConfig::default(), &scenario.mission))
}

/// Figures about the planners' calls, by the wall clock.
pub(crate) fn planner_calls(host: &Host) -> PlannerCalls {
    let stats = host.stats();
    PlannerCalls {
        plan: stats.plan.calls,
        step: stats.step.calls,
        p50_us: stats.step.p50_us,
        p99_us: stats.step.p99_us,
        faults: stats.faults,
    }
}

fn progress_bar(scenario: &Scenario, options: RunOptions) -> ProgressBar {
    if options.json || !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(1000).with_prefix(scenario.name.clone());
    let style = ProgressStyle::with_template("{prefix}  {wide_bar} {percent:>3} %  {msg}  {elapsed}");
    bar.with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
}

fn show_progress(bar: &ProgressBar, events: &[Event]) {
    if bar.is_hidden() {
        return;
    }
    for event in events {
        if let EventKind::Progressed { done, covered_reachable, .. } = event.kind {
            bar.set_position((done * 1000.0) as u64);
            bar.set_message(format!(
                "T+{:.0} s, {:.1} % of reachable floor",
                event.t_s,
                covered_reachable * 100.0
            ));
        }
        if let Some(line) = event.log_line().filter(|line| line.severity >= mission::Severity::Warn) {
            bar.println(format!("T+{:.1} s  {}  {}", event.t_s, line.source, line.text));
        }
    }
}

fn print_summary(summary: &Summary, options: RunOptions) -> anyhow::Result<()> {
    if options.json {
        say_line(&serde_json::to_string_pretty(summary).context("writing the report as JSON")?)
    } else {
        say(&report::human(summary))
    }
}

fn exit_code(summary: &Summary) -> u8 {
    if summary.outcome == Some(Outcome::Complete) { COMPLETE } else { ENDED_OTHERWISE }
}
