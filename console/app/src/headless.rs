//! Runs a mission without a terminal: `tankops run`, and `tankops` without a terminal.

use crate::{
    accuracy::warn_of_positions,
    cli::{LogsArg, RunArgs},
    planners::warn_of_shadowed,
    progress,
    shadowing::Shadowing,
    stop_signal::{self, StopSignal},
};
use command::json::pretty_json;
use flight::{
    Flight,
    answers::{InOrder, Window, Windowed},
    failure::{exit_code, mission_code},
    hosts::{self, host},
    plan_watch::{PlanWatch, Watched},
    planners, remains, scenarios,
};
use indicatif::{ProgressBar, ProgressStyle};
use mission::{Event, EventKind, Order, Phase};
use planner_api::LogLevel;
use planner_host::{Host, PluginDirs};
use remote::Wanted;
use report::print::{say, say_line, warn_line};
use runs::{CLOSE_TIMEOUT, Closed, RunLog};
use scenario::Scenario;
use std::{
    io::IsTerminal,
    process::ExitCode,
    thread,
    time::{Duration, Instant},
};
use world::{Station, coverage::percent_text};

/// Time between two looks at the recorder after the end of a mission.
const RECORDER_POLL: Duration = Duration::from_millis(20);

/// The options of a headless run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct RunOptions {
    /// Print the report as JSON on stdout, and nothing else.
    pub json: bool,
    /// Write a journal and a recording.
    pub record: bool,
    /// Apply the console's answer windows: an answer after its window counts as late.
    pub live_deadlines: bool,
}

/// Runs `tankops run`.
pub(crate) fn run(args: &RunArgs, plugins: &PluginDirs) -> anyhow::Result<ExitCode> {
    let scenario = scenarios::read(&args.scenario, &(&args.changes).into())?;
    let (json, record, live_deadlines) = (args.json, !args.no_record, args.live_deadlines);
    let shadowing = Shadowing::read(&args.shadow, &args.scenario, &scenario, plugins)?;
    let options = RunOptions { json, record, live_deadlines };
    fly_beside(&scenario, plugins, &args.logs, options, shadowing, args.vehicle.wanted().as_ref())
}

/// Runs a scenario to its end and prints the result.
pub(crate) fn fly(
    scenario: &Scenario,
    plugins: &PluginDirs,
    logs: &LogsArg,
    options: RunOptions,
) -> anyhow::Result<ExitCode> {
    fly_beside(scenario, plugins, logs, options, None, None)
}

/// Runs a scenario to its end, optionally with a planner in shadow, and prints the result.
fn fly_beside(
    scenario: &Scenario,
    plugins: &PluginDirs,
    logs: &LogsArg,
    options: RunOptions,
    shadowing: Option<Shadowing>,
    vehicle: Option<&Wanted>,
) -> anyhow::Result<ExitCode> {
    planners::check_installed(scenario, plugins)?;
    warn_of_shadowed(scenario, plugins);
    warn_of_positions(scenario);
    let flight = remote::connected(Flight::prepare(scenario, false), scenario, vehicle)?;
    // Until now, a signal ends the process at once: nothing has begun.
    let stop = stop_signal::listen();
    let mut log = if options.record {
        RunLog::create(&logs.folder(), &scenario.name, &scenario.mission.planner.id, scenario.seed)?
    } else {
        RunLog::unwritten()?
    };
    let bar = progress_bar(scenario, options);
    let mut trouble = None;
    let mut now = (0, 0.0);
    let mut take = |events: Vec<Event>, host: Option<&mut Host>| {
        now = events.last().map_or((0, 0.0), |event| (event.tick, event.t_s));
        show_progress(&bar, &events, scenario);
        log.keep(events);
        if let Some(host) = host {
            remains::keep(host, Some(&mut log), now);
        }
        report_trouble(&mut trouble, log.health().error);
    };
    take(vec![flight.opened()], None);
    let live_deadlines = options.live_deadlines;
    let mut host =
        fly_to_end((flight, shadowing), host(scenario, plugins), take, (&bar, &stop), live_deadlines);
    bar.finish_and_clear();
    host.finish();
    for event in remains::keep(&mut host, Some(&mut log), now) {
        if let EventKind::PlannerLogged { level: LogLevel::Warn, message, .. } = event.kind {
            warn_line(&format!("warning: {message}"));
        }
    }
    wait_for_recorder(&log, &stop);
    let Closed { summary, kept } = log.close(CLOSE_TIMEOUT, hosts::calls(&host), None, &scenario.expect);
    say(&if options.json { pretty_json("the report", &summary)? } else { report::human(&summary) })?;
    match &kept {
        Some(kept) if kept.problem().is_some() => warn_line(&kept.text()),
        Some(kept) if !options.json => say_line(&kept.text())?,
        _ => {}
    }
    Ok(ExitCode::from(exit_code(mission_code(&summary), kept.as_ref())))
}

/// Waits for the recorder as long as it makes progress: at full speed, a mission can be far ahead of it, above all if
/// its instrument takes many readings. Closing the log has a time limit that does not depend on this distance.
fn wait_for_recorder(log: &RunLog, stop: &StopSignal) {
    let (mut lag, mut since) = (log.health().lag, Instant::now());
    while lag > 0 && since.elapsed() < CLOSE_TIMEOUT && !stop.requested() {
        thread::sleep(RECORDER_POLL);
        let now = log.health().lag;
        if now < lag {
            (lag, since) = (now, Instant::now());
        }
    }
}

/// Reports on stderr, once each, that recording has failed and that it has resumed.
fn report_trouble(reported: &mut Option<String>, trouble: Option<String>) {
    match (&reported, &trouble) {
        (None, Some(error)) => warn_line(&format!("warning: recording failed: {error}")),
        (Some(_), None) => warn_line("recording resumed; nothing was lost"),
        _ => {}
    }
    *reported = trouble;
}

/// Runs to the end. Every ask is answered before time advances, unless the console's answer windows apply. With a real
/// vehicle, ticks follow the clock, and these windows apply.
fn fly_to_end(
    (mut flight, mut shadowing): (Flight, Option<Shadowing>),
    host: Host,
    mut take: impl FnMut(Vec<Event>, Option<&mut Host>),
    (bar, stop): (&ProgressBar, &StopSignal),
    live_deadlines: bool,
) -> Host {
    let mut answers = InOrder::new(host);
    let (on_work, on_progress) = progress::shown_in(bar);
    answers.host().set_on_progress(on_progress);
    stop_signal::wake_on_signal(answers.host().waker());
    let mut watch = PlanWatch::new(answers.host().plan_budget(), Some(on_work));
    let mut orders: Vec<Order> =
        std::iter::once(Order::Start).chain(shadowing.as_ref().map(Shadowing::begin)).collect();
    let mut clock = flight.brake().map(|_| Clock::starting(flight.tick_length()));
    while !matches!(flight.phase(), Phase::Ended(_)) {
        clock.iter_mut().for_each(Clock::wait_for_tick);
        if stop.requested() {
            orders.push(Order::Terminate);
        }
        // The start waits until the vehicle is known to stand; it may send its first readings only after a command.
        let is_early = matches!(flight.phase(), Phase::Waiting) && !flight.can_decide_start();
        let later = if is_early && !stop.requested() { std::mem::take(&mut orders) } else { Vec::new() };
        let events = if clock.is_some() {
            let mut windowed = Windowed::new(answers.host(), Window::real_time(flight.tick_length()));
            flight.tick(&orders, &mut Watched::new(&mut windowed, &mut watch))
        } else if live_deadlines {
            // No clock paces the ticks here, so the planner in shadow gets the time that it would have in the console.
            let tick = flight.tick_length();
            let window = Window { shadow: tick, ..Window::real_time(tick) };
            let mut windowed = Windowed::new(answers.host(), window);
            flight.tick(&orders, &mut Watched::new(&mut windowed, &mut watch))
        } else {
            flight.tick(&orders, &mut Watched::new(&mut answers, &mut watch))
        };
        orders = later;
        orders.extend(shadowing.as_mut().and_then(|shadowing| shadowing.next(&events)));
        take(events, Some(answers.host()));
    }
    answers.into_host()
}

/// The clock of a real vehicle: one tick of the mission per tick of time. Lost time is not made up.
struct Clock {
    due: Instant,
    tick: Duration,
}

impl Clock {
    fn starting(tick: Duration) -> Self {
        Self { due: Instant::now(), tick }
    }

    fn wait_for_tick(&mut self) {
        let now = Instant::now();
        thread::sleep(self.due.saturating_duration_since(now));
        self.due = self.due.max(now) + self.tick;
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

/// Shows the progress of a run. Without a progress bar, only a wait that may last until the time limit is reported.
fn show_progress(bar: &ProgressBar, events: &[Event], scenario: &Scenario) {
    let stations: &[Station] = &scenario.sim.world.stations;
    if bar.is_hidden() {
        let awaited = events.iter().filter(|event| matches!(event.kind, EventKind::PositionAwaited { .. }));
        for (event, line) in awaited.filter_map(|event| Some((event, event.log_line(stations)?))) {
            warn_line(&format!("T+{:.1} s  {}  {}", event.t_s, line.source, line.text));
        }
        return;
    }
    for event in events {
        match event.kind {
            EventKind::PositionAwaited { ends_t_s, .. } => {
                let ends = mission::clock(ends_t_s);
                bar.set_prefix(format!("{}  HELD: position lost, ends at T+{ends}", scenario.name));
            }
            EventKind::Resumed => bar.set_prefix(scenario.name.clone()),
            _ => {}
        }
        if let EventKind::Progressed { done, covered_reachable, .. } = event.kind {
            bar.set_position((done * 1000.0) as u64);
            bar.set_message(format!(
                "T+{:.0} s, {} % of reachable floor",
                event.t_s,
                percent_text(covered_reachable, 1)
            ));
        }
        if let Some(line) = event.log_line(stations).filter(|line| line.severity >= mission::Severity::Warn) {
            bar.println(format!("T+{:.1} s  {}  {}", event.t_s, line.source, line.text));
        }
    }
}
