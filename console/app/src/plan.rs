//! `tankops plan`: plans a mission on the known map without running it.

use crate::{
    cli::PlanArgs,
    output::{check_free, write_file},
    progress,
};
use command::json::say_json;
use flight::{
    Flight,
    failure::{COMPLETE, ENDED_OTHERWISE, bad_input},
    hosts, planners, scenarios,
};
use mission::{Cause, EventKind, Fault, Parameters, PlannerChoice, TaskConfig, check_extent, preview};
use planner_api::{Code, LogLevel, Plan};
use planner_host::{BlockingHost, PluginDirs, Reply};
use report::{
    plan::{Made, Planned},
    print::{say, warn_line},
};
use scenario::Scenario;
use serde::Serialize;
use std::{path::Path, process::ExitCode, sync::Arc, time::Instant};
use world::Point;

/// Runs `tankops plan`.
pub(crate) fn plan(args: &PlanArgs, plugins: &PluginDirs) -> anyhow::Result<ExitCode> {
    let scenario = scenarios::read(&args.scenario, &(&args.changes).into())?;
    if scenario.mission.task.is_survey() {
        let why = "a survey has no plan, because the robot chooses its way on the map that it makes";
        return Err(bad_input(format!("{}: {why}; run it with `tankops run`", scenario.shown_name)));
    }
    if let Some(vehicle) = args.vehicle.wanted() {
        let info = remote::fitting(&scenario, &vehicle)?;
        warn_line(&format!(
            "vehicle   {} at {}: limits, hull, sensors, lease and stop time in its `hello` fit the scenario; its motion is not \
             checked",
            info.name, info.at
        ));
    }
    let format = args.output.as_deref().map(format_of).transpose()?;
    for file in [&args.output, &args.svg].into_iter().flatten() {
        check_free(file, Some(args.force), &[&args.scenario])?;
    }
    let (mission, drawing) = (&scenario.mission, scenario.sim.world.as_drawn());
    let planned = plan_of(&scenario, plugins)?;
    let better = better(&scenario, &planned, plugins);
    if args.json {
        say_json("the plan", &WithAdvice { planned: &planned, better: better.as_ref() })?;
    } else {
        say(&planned.human())?;
        if let Some(better) = &better {
            say(&better.human(&planned))?;
        }
    }
    if let Some(file) = &args.svg {
        write_file("the drawing", file, &planned.svg(mission, &drawing))?;
    }
    if let (Some(file), Some(format)) = (&args.output, format) {
        let text = match format {
            Format::Csv => planned.csv(),
            Format::GeoJson => planned.geojson(&drawing, &scenario.inspection),
            Format::Dxf => planned.dxf(&drawing),
        };
        write_file("the plan", file, &text)?;
    }
    Ok(ExitCode::from(if planned.flies(mission) { COMPLETE } else { ENDED_OTHERWISE }))
}

/// A plan and, if there is one, a far better plan by another planner.
#[derive(Serialize)]
struct WithAdvice<'a> {
    #[serde(flatten)]
    planned: &'a Planned,
    better: Option<&'a Better>,
}

/// A far better plan for the same task by another planner.
#[derive(Serialize)]
struct Better {
    /// The planner's id.
    planner: String,
    /// The mission time of the plan, in seconds.
    mission_time_s: f64,
    /// The path length of the plan, in metres.
    path_length_m: f64,
}

impl Better {
    fn human(&self, planned: &Planned) -> String {
        let Self { planner, mission_time_s, path_length_m } = self;
        let (own_m, own_s) = planned.effort();
        format!(
            "advice    {planner} is far better: {mission_time_s:.0} s instead of {own_s:.0} s, \
             {path_length_m:.0} m instead of {own_m:.0} m; use it with --planner {planner}\n"
        )
    }
}

/// The plan of the planner best suited to coverage, if this plan takes far less time, or if the given plan cannot be
/// run completely.
fn better(scenario: &Scenario, planned: &Planned, plugins: &PluginDirs) -> Option<Better> {
    /// The largest share of the given plan's time that still counts as far less.
    const FAR: f64 = 0.7;
    if !matches!(scenario.mission.task, TaskConfig::Cover { .. }) {
        return None;
    }
    let found = planners::found(plugins);
    let suited =
        planners::suited_to_coverage(&found).filter(|info| info.id != scenario.mission.planner.id)?;
    let mut other = scenario.clone();
    other.mission.planner = PlannerChoice { id: suited.id.clone(), parameters: Parameters::default() };
    let plan = plan_of(&other, plugins).ok()?;
    let ((_, own_s), (path_length_m, mission_time_s)) = (planned.effort(), plan.effort());
    let is_far = !planned.flies(&scenario.mission) || mission_time_s <= FAR * own_s;
    let planner = suited.id.clone();
    (is_far && plan.flies(&other.mission)).then_some(Better { planner, mission_time_s, path_length_m })
}

/// The file format of a plan.
#[derive(Clone, Copy)]
enum Format {
    Csv,
    GeoJson,
    Dxf,
}

fn format_of(file: &Path) -> anyhow::Result<Format> {
    match file.extension().unwrap_or_default().to_string_lossy().to_lowercase().as_str() {
        "csv" => Ok(Format::Csv),
        "geojson" => Ok(Format::GeoJson),
        "dxf" => Ok(Format::Dxf),
        _ => Err(bad_input(format!("{}: unknown plan format; use .csv, .geojson or .dxf", file.display()))),
    }
}

/// Plans the mission of a scenario; returns the path, which has at least two points, metres.
pub(crate) fn planned_path(scenario: &Scenario, plugins: &PluginDirs) -> anyhow::Result<Vec<Point>> {
    let made = make_plan(scenario, plugins)?;
    let why = made.reason.unwrap_or_else(|| "the planner gave no path".into());
    if made.plan.path.len() < 2 { Err(bad_input(format!("--plan: {why}"))) } else { Ok(made.plan.path) }
}

/// The plan of a scenario's mission, with its figures.
fn plan_of(scenario: &Scenario, plugins: &PluginDirs) -> anyhow::Result<Planned> {
    let made = make_plan(scenario, plugins)?;
    let EventKind::RunOpened(run) = Flight::prepare(scenario, false).opened().kind else {
        unreachable!("a flight begins with the event that opens it")
    };
    Ok(Planned::new(&run, made))
}

fn make_plan(scenario: &Scenario, plugins: &PluginDirs) -> anyhow::Result<Made> {
    let config = hosts::config(&scenario.mission);
    let limit = config.plan_deadline;
    let mut host = BlockingHost::new(plugins, config);
    let work = format!("Planning ({})", scenario.mission.planner.id);
    let spinner = progress::spinner(&work, limit);
    let shown = spinner.clone();
    host.set_on_progress(Arc::new(move |_, progress| progress::show_share(&shown, &work, progress)));
    let began = Instant::now();
    let answer = ask_for_plan(scenario, &mut host);
    spinner.finish_and_clear();
    if let Ok(reply) = &answer {
        let (mission, boundary) = (&scenario.mission, &scenario.sim.world.boundary);
        check_extent(&reply.value, boundary, mission.lane_m())
            .map_err(|what| bad_input(format!("planner {} {what}", mission.planner.id)))?;
    }
    let plan_time_ms = host.stats().plan.p50_us.unwrap_or(began.elapsed().as_secs_f64() * 1e6) / 1e3;
    let mut warnings = Vec::new();
    let (plan, reason) = match answer {
        Ok(reply) => {
            let is_warning = |(level, _): &&(LogLevel, String)| matches!(level, LogLevel::Warn);
            warnings.extend(reply.logs.iter().filter(is_warning).map(|(_, message)| message.clone()));
            let said = warnings
                .last()
                .cloned()
                .or_else(|| reply.logs.into_iter().map(|(_, message)| message).next_back());
            let reason =
                (!reply.value.complete).then(|| said.unwrap_or_else(|| "the planner gave no reason".into()));
            (reply.value, reason)
        }
        Err(fault) => (partial_plan(&fault)?, Some(fault.message)),
    };
    Ok(Made { plan, plan_time_ms, reason, warnings })
}

/// Asks the mission's planner to plan the whole task, from the start, in the tank as drawn.
fn ask_for_plan(scenario: &Scenario, host: &mut BlockingHost) -> Result<Reply<Plan>, Fault> {
    let ask = preview(&scenario.mission, &scenario.sim.world.as_drawn(), scenario.seed);
    let planner = &scenario.mission.planner;
    ask.site.lend(|site| host.choose(&planner.id, &planner.parameters, site))?;
    ask.lend(|request| host.plan(request))
}

/// The partial path of a planner that refused; any other fault is returned as an error that the user can correct.
fn partial_plan(fault: &Fault) -> anyhow::Result<Plan> {
    match fault.cause {
        Cause::Planner(code) if code != Code::Config => {
            Ok(Plan { path: fault.partial.clone(), ..Plan::default() })
        }
        _ => Err(bad_input(fault.message.clone())),
    }
}
