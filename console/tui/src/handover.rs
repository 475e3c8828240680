//! The handover page, which an operator writes for the next one: the state, the reasons and the next steps.

use crate::actions::ActionId;
use crate::guide;
use crate::model::{
    Alarm, Model,
    alarms::State,
    log::{Entry, What, clock, severity_word},
};
use crate::update::offered;
use crate::view::{Bases, by_command};
use account::{Area, MissReason};
use mission::{EventKind, Order, Phase, TaskConfig, event::SLACK_M};
use world::ZoneKind;

/// The page as Markdown, from the state of the console; it ends with a line break.
pub fn page(model: &Model) -> String {
    let run = &model.live.run;
    let scenario = run.about.as_ref().map_or("no mission", |about| about.scenario.as_str());
    let mut page = format!("# Handover: {}, T+{}\n", plain(scenario), clock(run.clock.t_s));
    let sections = [
        ("State", state(model)),
        ("Next steps", next(model)),
        ("Open alarms", alarms(model, Alarm::is_open)),
        ("Shelved alarms", alarms(model, |alarm| matches!(alarm.state, State::Shelved(_)))),
        ("No-go zones", zones(model)),
        ("Tether", tether(model)),
        ("Clearance", clearance(model)),
        ("Work done", done(model)),
        ("Floor missed or left out", floor(model)),
        ("Starts, holds and ends", holds(model)),
        ("Decisions of the operator", decisions(model)),
    ];
    let has_tether = run.about.as_ref().is_some_and(|about| about.mission.tether.is_some());
    for (title, lines) in sections.into_iter().filter(|(title, _)| has_tether || *title != "Tether") {
        page.extend(["\n## ", title, "\n\n"]);
        let lines = if lines.is_empty() { vec!["None.".into()] } else { lines };
        page.extend(lines.iter().map(|line| format!("- {}\n", plain(line))));
    }
    page
}

/// Text that Markdown shows as it is, on one line.
fn plain(text: &str) -> String {
    let one_line = text.replace(|letter: char| letter.is_control(), " ");
    one_line.chars().fold(String::new(), |mut line, letter| {
        if matches!(letter, '<' | '>' | '*' | '_' | '[' | ']' | '\\' | '#') {
            line.push('\\');
        }
        line.push(letter);
        line
    })
}

fn state(model: &Model) -> Vec<String> {
    let live = &model.live;
    let run = &live.run;
    let mut lines: Vec<String> = clauses(model, false);
    let operator =
        model.console.preferences.operator.as_deref().unwrap_or("not named (`operator` in config.toml)");
    lines.push(format!("Operator: {operator}"));
    let seed = run.about.as_ref().map_or_else(|| "unknown".into(), |about| about.seed.to_string());
    lines.push(format!("Planner {}, seed {seed}", run.planner_id().unwrap_or("unknown")));
    if let (Some(pose), Some(error_m)) = (&run.position.pose, run.position.error_m()) {
        let at = pose.position;
        lines.push(format!("Robot at {:.2}, {:.2} m, 95 % error {error_m:.2} m", at.x, at.y));
    }
    let recording = match (&live.health.recording, &live.result) {
        (_, Some(result)) => result.kept.clone(),
        (crate::model::Recording::On, None) if run.has_ended() => "The run is being closed and kept".into(),
        (crate::model::Recording::On, None) => "Recording is on".into(),
        (crate::model::Recording::Off, None) => "Nothing is being recorded".into(),
        (crate::model::Recording::Failed(why), None) => format!("RECORDING FAILED: {why}"),
    };
    lines.push(recording);
    lines
}

/// The next steps. While the robot is held, these are the ways on: resume, drive back, end.
fn next(model: &Model) -> Vec<String> {
    let ways = ways_on(model);
    // The state line names some of the ways as keys.
    let named = ["`resume`", "`return`", "`end`"];
    let is_way = |clause: &String| !ways.is_empty() && named.iter().any(|name| clause.contains(name));
    let others = clauses(model, true).into_iter().filter(|clause| !is_way(clause));
    let others: Vec<String> = others.collect();
    ways.into_iter().chain(others).collect()
}

/// What a held robot can do next, with the commands; empty while it is not held.
fn ways_on(model: &Model) -> Vec<String> {
    let run = &model.live.run;
    if !matches!(run.phase(), Phase::Held(_)) {
        return Vec::new();
    }
    let can = |id: ActionId| offered(model, id).is_ok();
    let rest_m = run.planning.plan.as_ref().zip(run.progress.as_ref()).zip(run.position.pose);
    let rest = rest_m.map(|((plan, progress), pose)| plan.rest_m(pose.position, progress.done));
    let rest =
        rest.filter(|m| m.is_finite()).map_or_else(String::new, |m| format!(", {m:.1} m of the plan left"));
    let back_m = run.tether.as_ref().and_then(|tether| tether.return_length_m);
    let back = back_m.map_or_else(String::new, |m| format!(", {m:.1} m along the tether"));
    let ways = [
        (ActionId::Resume, format!("Resume the task (`resume`){rest}")),
        (ActionId::DriveBack, format!("Drive back and end there (`return`){back}")),
        (ActionId::Abort, "End the mission here (`end`)".to_owned()),
    ];
    ways.into_iter().filter(|(id, _)| can(*id)).map(|(_, words)| words).collect()
}

/// The clauses of the state line that name a command, as the next steps do, or the others: the state and its reason.
fn clauses(model: &Model, with_command: bool) -> Vec<String> {
    let clauses = by_command(model).into_iter().enumerate();
    let named = clauses.filter(|(index, clause)| (*index > 0 && clause.contains('`')) == with_command);
    named.map(|(_, clause)| clause).collect()
}

/// The tether as it is now: the length out, the wrap, the pulls, the slack and the way back.
fn tether(model: &Model) -> Vec<String> {
    let run = &model.live.run;
    let Some(tether) = &run.tether else { return vec!["Not known yet".into()] };
    let limits = run.about.as_ref().and_then(|about| Some(about.mission.tether.as_ref()?.limits));
    if tether.is_broken {
        let noticed =
            tether.broke_out_m.map_or_else(String::new, |m| format!(", {m:.1} m when it was noticed"));
        return vec![
            format!("TORN: {:.1} m off the reel now{noticed}", tether.length_m),
            "The rest lies on the floor; the robot may drive over it".into(),
        ];
    }
    let of_reel = limits.map_or_else(String::new, |limits| format!(" of {:.1} m", limits.reel_length_m));
    let out = format!("Out: {:.1}{of_reel}, {:.1} m left on the reel", tether.length_m, tether.free_m);
    let wrap = match tether.largest() {
        _ if tether.is_snagged => "SNAGGED: wrap and way back are not known".to_owned(),
        None => "Wrap: none, the tether is straight".to_owned(),
        Some(most) => {
            let limit = limits.map_or_else(String::new, |limits| {
                format!(" (limit {:.0}°)", limits.wrap_max_rad.to_degrees())
            });
            let total_deg = tether.wrap_total_rad.to_degrees();
            format!("Wrap: {:.0}° on {}{limit}, {total_deg:.0}° in total", tether.largest_deg(), most.on)
        }
    };
    let needed = tether.pull_n.zip(run.reel());
    let needed = needed.map(|(n, reel)| format!("Reel needs: {n:.1} of {:.1} N", reel.pull_n));
    let felt = tether.measured.map(|measured| {
        let most = run.robot_pull_most_n().filter(|_| !run.is_live());
        let most = most.map_or_else(String::new, |most_n| format!(" of {most_n:.1}"));
        let place = if run.is_live() { "Pull at the reel" } else { "Robot pull" };
        format!("{place}: {:.1}{most} N, slack {:.2} of {SLACK_M:.2} m", measured.pull_n, measured.slack_m)
    });
    let back = match tether.return_length_m {
        _ if tether.is_snagged => None,
        Some(way_m) => Some(format!("Way back along the tether: clear, {way_m:.1} m")),
        None => Some("Way back along the tether: BLOCKED, the hull does not fit".to_owned()),
    };
    [Some(out), Some(wrap), needed, felt, back].into_iter().flatten().collect()
}

fn alarms(model: &Model, is_listed: impl Fn(&Alarm) -> bool) -> Vec<String> {
    let run = &model.live.run;
    let line = |alarm: &&Alarm| {
        let state = match &alarm.state {
            State::Unacknowledged => "not acknowledged".to_owned(),
            State::Acknowledged => "acknowledged".to_owned(),
            State::Returned => "cleared, not acknowledged".to_owned(),
            State::Cleared => "cleared".to_owned(),
            State::Shelved(shelf) => {
                format!("until T+{}, reason: {}", clock(shelf.until_s), or_none(&shelf.reason))
            }
        };
        let name = guide::name(&alarm.cause, run);
        let severity = severity_word(alarm.severity);
        // Some alarm texts already begin with the name of the alarm.
        let text = alarm.text.strip_prefix(&format!("{name}: ")).unwrap_or(&alarm.text);
        format!("{severity} {name}, since T+{}, {state}: {text}", clock(alarm.since_s))
    };
    run.alarms.table().iter().filter(|alarm| is_listed(alarm)).map(line).collect()
}

fn or_none(reason: &str) -> &str {
    if reason.is_empty() { "none given" } else { reason }
}

fn zones(model: &Model) -> Vec<String> {
    let about = model.live.run.about.iter();
    let zones = about.flat_map(|about| &about.world.zones).filter(|zone| zone.kind == ZoneKind::NoGo);
    let line = |zone: &world::Zone| format!("{}: {}", zone.name, mission::outline::of(&zone.shape));
    zones.map(line).collect()
}

fn clearance(model: &Model) -> Vec<String> {
    let demanded = model.live.run.about.as_ref().map(|about| about.mission.clearance_m);
    let planned = model.live.estimate().and_then(|estimate| estimate.clearance_min);
    let lines = [
        demanded.map(|clearance_m| format!("Required by the scenario: {clearance_m:.2} m")),
        planned.map(|least| {
            format!(
                "Least clearance of the plan: {:.2} m at {:.2}, {:.2} m",
                least.value, least.at.x, least.at.y
            )
        }),
    ];
    lines.into_iter().flatten().collect()
}

fn done(model: &Model) -> Vec<String> {
    let run = &model.live.run;
    let task = run.about.as_ref().map(|about| match about.mission.task {
        TaskConfig::Goto { .. } => "Task: drive to the goal",
        TaskConfig::Follow { .. } => "Task: follow the preset path",
        TaskConfig::Cover { .. } => "Task: scan the floor",
        TaskConfig::Survey { .. } => "Task: make a map of the floor",
    });
    let bases = Bases::of(&model.live);
    let ([first, second], [floor, other]) = (bases.scanned(), bases.floors);
    let scanned = run
        .coverage
        .is_some()
        .then(|| format!("Scanned: {first} % of the {floor}, {second} % of the {other}"));
    let earlier = &model.live.earlier;
    let before = (!earlier.is_empty()).then(|| format!("Re-scan of what {} left", earlier.join(" and ")));
    let in_doubt = model.live.in_doubt().into_iter().map(|doubt| {
        let at = doubt.at.map_or_else(String::new, |at| format!(", around {:.2}, {:.2} m", at.x, at.y));
        format!("In doubt: {}{at}", doubt.floor)
    });
    let moving = format!("Mission time {}, under way {}", clock(run.clock.t_s), clock(run.clock.moving_s));
    let path = run.progress.as_ref().map(|progress| format!("Path {:.0} % done", 100.0 * progress.done));
    let is_on_task = !run.phase().is_return();
    let left_s = model.live.left_s().filter(|_| is_on_task && !run.has_ended());
    let left = left_s.map(|left_s| format!("About {} of mission time left", clock(left_s)));
    let taken_back = model.live.together().and_then(|all| all.taken_back);
    let regained = taken_back.map(|floor| format!("All runs: {floor}"));
    let floor = before.into_iter().chain(scanned).chain(in_doubt).chain(regained);
    task.map(str::to_owned).into_iter().chain(path).chain(floor).chain([moving]).chain(left).collect()
}

/// What the operator decided: the decisions in the journal, then the acknowledgements after the end of the mission, which
/// no journal contains.
fn decisions(model: &Model) -> Vec<String> {
    let run = &model.live.run;
    let after = run.alarms.list().iter().filter_map(|alarm| {
        let acknowledged =
            alarm.acknowledged.as_ref().filter(|ack| run.has_ended() && ack.t_s >= run.clock.t_s)?;
        let by = acknowledged.by.as_ref().map_or_else(String::new, |by| format!(" by {by}"));
        Some(format!("After the end: acknowledged{by}: {}", alarm.text))
    });
    entries(model, is_decision).into_iter().chain(after).collect()
}

/// Every area that was missed or, before the end, that the plan leaves out, each with its reason.
fn floor(model: &Model) -> Vec<String> {
    let line = |area: &Area<MissReason>| {
        format!("{:.2} m² at {:.2}, {:.2} m: {}", area.area_m2, area.at.x, area.at.y, area.why())
    };
    let live = &model.live;
    match (live.floor(), live.left_out()) {
        (Some(account), _) => {
            let slivers = &account.slivers;
            let small = (slivers.count > 0).then(|| {
                format!("{} areas under 0.01 m²: together {:.2} m²", slivers.count, slivers.area_m2)
            });
            live.missed().into_iter().map(line).chain(small).collect()
        }
        (None, Some(left_out)) => {
            left_out.areas.iter().map(|area| format!("Left out by the plan: {}", line(area))).collect()
        }
        (None, None) => Vec::new(),
    }
}

/// The log lines about certain events, oldest first.
fn entries(model: &Model, is_listed: fn(&EventKind) -> bool) -> Vec<String> {
    listed(model, is_listed).map(line).collect()
}

fn listed(model: &Model, is_listed: fn(&EventKind) -> bool) -> impl Iterator<Item = &Entry> {
    let log = &model.live.run.log;
    let lines = (log.oldest()..log.end()).filter_map(|number| log.get(number));
    lines.filter(move |entry| entry.what.event().is_some_and(|event| is_listed(&event.kind)))
}

fn line(entry: &Entry) -> String {
    format!("T+{} {}", clock(entry.t_s), entry.text)
}

/// The starts, holds and ends. A drive back is listed by its order, and not as a resumption of the task.
fn holds(model: &Model) -> Vec<String> {
    let back: Vec<u64> = listed(model, |kind| matches!(kind, EventKind::Ordered { order: Order::DriveBack }))
        .map(|entry| entry.tick)
        .collect();
    let is_of_drive_back = |entry: &&Entry| {
        let is_resumed = |what: &What| what.event().is_some_and(|event| event.kind == EventKind::Resumed);
        back.contains(&entry.tick) && is_resumed(&entry.what)
    };
    listed(model, is_hold).filter(|entry| !is_of_drive_back(entry)).map(line).collect()
}

fn is_hold(kind: &EventKind) -> bool {
    match kind {
        EventKind::Held { .. }
        | EventKind::Resumed
        | EventKind::ReturnBegan { .. }
        | EventKind::Ended { .. } => true,
        EventKind::Ordered { order } => order.is_start() || *order == Order::DriveBack,
        _ => false,
    }
}

/// Whether an event records who decided what: alarms, stations, zones, planners and parameters.
fn is_decision(kind: &EventKind) -> bool {
    match kind {
        EventKind::ZoneDrawn { .. } => true,
        EventKind::Ordered { order } => matches!(
            order,
            Order::Note(_)
                | Order::UseStation { .. }
                | Order::Inject(_)
                | Order::ChoosePlanner(_)
                | Order::SetParameter { .. }
                | Order::Shadow(_)
                | Order::Promote
                | Order::TakePlan
                | Order::FlyUncertified
        ),
        _ => false,
    }
}
