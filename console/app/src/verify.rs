//! `tankops verify`: compute a past run again and prove that its journal is equal.

use crate::{
    cli::LogsArg,
    failure::{COMPLETE, ENDED_OTHERWISE, bad_input},
    flight::{Flight, Pace},
    output::say_line,
    run_folder,
    scenario::Scenario,
};
use anyhow::Context;
use mission::{Event, EventKind, Order, PlannerInfo, RunOpened};
use planner_host::PluginDirs;
use recording::{JOURNAL_FILE, read_journal};
use std::{collections::BTreeMap, path::Path, process::ExitCode};

/// What a comparison found.
#[derive(Debug, Clone, PartialEq)]
enum Verdict {
    Equal { events: usize, last_tick: u64 },
    Different { tick: u64, recorded: String, computed: String },
}

/// `tankops verify RUN`.
pub fn verify(run: &Path, logs: &LogsArg, plugins: &PluginDirs) -> anyhow::Result<ExitCode> {
    let folder = run_folder::find(run, &logs.logs)?;
    let path = folder.join(JOURNAL_FILE);
    let journal = read_journal(&path).map_err(|error| bad_input(error.to_string()))?;
    if let Some(damage) = &journal.truncated {
        say_line(&format!("note: the journal stops early ({damage}); what it holds is compared"))?;
    }
    match compare(&journal.events, plugins)? {
        Verdict::Equal { events, last_tick } => {
            // A report counts the ticks that passed since the first one, which has the number 0.
            say_line(&format!(
                "equal: {events} events computed again, byte for byte, from tick 0 to tick {last_tick}"
            ))?;
            Ok(ExitCode::from(COMPLETE))
        }
        Verdict::Different { tick, recorded, computed } => {
            say_line(&format!(
                "different from tick {tick} on\n  recorded: {recorded}\n  computed: {computed}"
            ))?;
            for note in planner_changes(&journal.events, plugins) {
                say_line(&format!("note: {note}"))?;
            }
            Ok(ExitCode::from(ENDED_OTHERWISE))
        }
    }
}

fn compare(recorded: &[Event], plugins: &PluginDirs) -> anyhow::Result<Verdict> {
    let opened = opened(recorded)?;
    let scenario = Scenario::parse(&opened.scenario_toml, "the scenario in the journal")
        .map_err(|errors| bad_input(errors.render()))?;
    let mut flight = Flight::prepare(&scenario, opened.mission.attended, plugins, Pace::Batch);
    let orders = orders_by_tick(recorded);
    let last_tick = recorded.last().map_or(0, |event| event.tick);
    let mut position = 0;
    let mut check = |computed: &[Event]| -> anyhow::Result<Option<Verdict>> {
        for event in computed {
            let (theirs, ours) = (recorded.get(position).map(line).transpose()?, line(event)?);
            let Some(theirs) = theirs else { return Ok(None) };
            if theirs != ours {
                return Ok(Some(Verdict::Different { tick: event.tick, recorded: theirs, computed: ours }));
            }
            position += 1;
        }
        Ok(None)
    };
    if let Some(different) = check(&[flight.opened()])? {
        return Ok(different);
    }
    for tick in 0..=last_tick {
        let events = flight.tick(orders.get(&tick).map_or(&[], Vec::as_slice));
        if let Some(different) = check(&events)? {
            return Ok(different);
        }
    }
    if position < recorded.len() {
        let (tick, recorded) = (recorded[position].tick, line(&recorded[position])?);
        return Ok(Verdict::Different { tick, recorded, computed: "nothing more".into() });
    }
    Ok(Verdict::Equal { events: position, last_tick })
}

/// How the run was opened; a journal without that tells nothing.
pub fn opened(events: &[Event]) -> anyhow::Result<&RunOpened> {
    match events.first().map(|event| &event.kind) {
        Some(EventKind::RunOpened(opened)) => Ok(opened),
        _ => Err(bad_input(
            "the journal does not begin with the opening of a run, so it cannot be computed again",
        )),
    }
}

fn line(event: &Event) -> anyhow::Result<String> {
    serde_json::to_string(event).context("writing an event as JSON")
}

fn orders_by_tick(events: &[Event]) -> BTreeMap<u64, Vec<Order>> {
    let mut orders: BTreeMap<u64, Vec<Order>> = BTreeMap::new();
    for event in events {
        if let EventKind::Ordered { order } | EventKind::OrderRefused { order, .. } = &event.kind {
            orders.entry(event.tick).or_default().push(order.clone());
        }
    }
    orders
}

/// Planners of the run whose plugin is another file now.
fn planner_changes(events: &[Event], plugins: &PluginDirs) -> Vec<String> {
    let now = crate::planners::found(plugins);
    let changed = |then: &PlannerInfo| match now.iter().find(|info| info.id == then.id) {
        None => Some(format!("planner {} of the run is not installed", then.id)),
        Some(info) if info.sha256 != then.sha256 => {
            Some(format!("planner {} is another build than in the run ({} then)", then.id, then.version))
        }
        Some(_) => None,
    };
    let mut notes: Vec<String> = events
        .iter()
        .filter_map(|event| match &event.kind {
            EventKind::PlannerChosen { info, .. } => changed(info),
            _ => None,
        })
        .collect();
    notes.dedup();
    notes
}
