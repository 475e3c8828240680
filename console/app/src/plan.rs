//! `tankops plan`: a plan on the known map, without flying.

use crate::{
    cli::PlanArgs,
    drawing::planned::{Drawn, svg},
    failure::{COMPLETE, ENDED_OTHERWISE, bad_input},
    output::{say, say_line},
    progress,
};
use anyhow::Context;
use mission::{Cause, Fault, MissionConfig, Parameters, TaskConfig, preview, tether::certify_from_start};
use planner_api::{Code, LogLevel, Plan};
use planner_host::{BlockingHost, HostConfig, PluginDirs, Reply};
use scenario::Scenario;
use serde::Serialize;
use std::{
    process::ExitCode,
    sync::Arc,
    time::{Duration, Instant},
};
use world::{
    Cell, Floor, Point, Shape, World, polyline,
    tether::{Cable, Case, Certificate, Limits, certify},
};

/// Time that a planner may take for a plan of the whole floor.
const COVER_WITHIN: Duration = Duration::from_mins(1);
/// Memory that it may use for it: large floors have many cells.
const COVER_MEMORY_BYTES: u64 = 1 << 30;

/// A plan as scripts read it.
#[derive(Debug, Serialize)]
struct Planned {
    planner: String,
    parameters: Parameters,
    path: Vec<Point>,
    legs: Vec<Leg>,
    /// Lines that the tethered robot never crosses.
    cuts: Vec<Vec<Point>>,
    length_m: f64,
    plan_time_ms: f64,
    complete: bool,
    /// Why it is not complete.
    reason: Option<String>,
    /// What the planner warned of: floor that it leaves out and why, ways of its own where the method has none.
    warnings: Vec<String>,
    /// The floor that is to be scanned as reports count it; absent for other missions.
    floor: Option<PlannedFloor>,
    /// What the path does to the tether, or, without one, to a tether that would run from the anchor of a coverage
    /// mission; absent for other missions.
    certificate: Option<Certificate>,
}

/// A floor as reports count it: by the whole swath, what lanes overlap included.
#[derive(Debug, Serialize)]
struct PlannedFloor {
    /// Width of floor scanned in one pass, metres.
    swath_m: f64,
    /// Floor that the tool can reach, square metres.
    reachable_m2: f64,
    /// Floor along the shell that it cannot reach, square metres.
    shell_margin_m2: f64,
}

/// Some points of the path that serve one purpose: index of the first and of the last.
#[derive(Debug, Serialize)]
pub(crate) struct Leg {
    /// What the stretch is for.
    pub tag: &'static str,
    /// Index of its first point.
    pub first: usize,
    /// Index of its last point.
    pub last: usize,
}

/// `tankops plan`.
pub(crate) fn plan(args: &PlanArgs, plugins: &PluginDirs) -> anyhow::Result<ExitCode> {
    let scenario = crate::read_scenario(&args.scenario, &args.changes)?;
    let planned = make_plan(&scenario, plugins)?;
    print_plan(&planned, args.json)?;
    if let Some(file) = &args.svg {
        std::fs::write(file, picture(&scenario, &planned)).map_err(|error| {
            bad_input(format!("the drawing cannot be written: {error}: {}", file.display()))
        })?;
    }
    let flies = planned.complete && !is_refused(&scenario, planned.certificate.as_ref());
    Ok(ExitCode::from(if flies { COMPLETE } else { ENDED_OTHERWISE }))
}

/// Whether a mission would refuse the plan for what it does to the tether.
fn is_refused(scenario: &Scenario, certificate: Option<&Certificate>) -> bool {
    let must_be_certified = scenario.mission.tether.as_ref().is_some_and(|tether| !tether.allow_uncertified);
    must_be_certified && certificate.is_none_or(|certificate| !certificate.certified)
}

fn make_plan(scenario: &Scenario, plugins: &PluginDirs) -> anyhow::Result<Planned> {
    let mut host = BlockingHost::new(plugins, patient(HostConfig::default(), &scenario.mission));
    let work = format!("Planning ({})", scenario.mission.planner.id);
    let spinner = progress::spinner(&work, patience(&scenario.mission));
    let shown = spinner.clone();
    host.set_on_progress(Arc::new(move |_, progress| progress::show_share(&shown, &work, progress)));
    let began = Instant::now();
    let answer = ask_for_plan(scenario, &mut host);
    spinner.finish_and_clear();
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
                (!reply.value.complete).then(|| said.unwrap_or_else(|| "the planner did not say why".into()));
            (reply.value, reason)
        }
        Err(fault) => (partial_plan(&fault)?, Some(fault.message)),
    };
    let certificate = certificate(scenario, &plan);
    Ok(Planned {
        planner: scenario.mission.planner.id.clone(),
        parameters: scenario.mission.planner.parameters.clone(),
        legs: legs(&plan),
        length_m: polyline::length_m(&plan.path),
        plan_time_ms,
        complete: plan.complete,
        reason,
        warnings,
        floor: planned_floor(&scenario.mission, &scenario.sim.world.as_drawn()),
        certificate,
        cuts: plan.cuts,
        path: plan.path,
    })
}

/// Asks the mission's planner for a plan of the whole task, from the start, on the drawing.
fn ask_for_plan(scenario: &Scenario, host: &mut BlockingHost) -> Result<Reply<Plan>, Fault> {
    let ask = preview(&scenario.mission, &scenario.sim.world.as_drawn(), scenario.seed);
    let planner = &scenario.mission.planner;
    ask.site.lend(|site| host.choose(&planner.id, &planner.parameters, site))?;
    ask.lend(|request| host.plan(request))
}

fn planned_floor(mission: &MissionConfig, drawing: &World) -> Option<PlannedFloor> {
    let TaskConfig::Cover { .. } = &mission.task else { return None };
    let (start, swath_m) = (mission.start.position, mission.swath_m);
    let floor = Floor::new(drawing, mission.cell_m, mission.room_m(), swath_m, start);
    let area_m2 = |kind: Cell| {
        (0..floor.len()).filter(|index| floor.kind(*index) == kind).count() as f64 * floor.cell_m2()
    };
    let (reachable_m2, shell_margin_m2) = (area_m2(Cell::Reachable), area_m2(Cell::Margin));
    Some(PlannedFloor { swath_m, reachable_m2, shell_margin_m2 })
}

/// How long a plan for a mission may take.
fn patience(mission: &MissionConfig) -> Duration {
    patient(HostConfig::default(), mission).plan_deadline
}

/// A plan for a whole floor takes longer than a way to a point, and more memory.
pub(crate) fn patient(config: HostConfig, mission: &MissionConfig) -> HostConfig {
    match mission.task {
        TaskConfig::Cover { .. } => {
            HostConfig { plan_deadline: COVER_WITHIN, memory_limit_bytes: COVER_MEMORY_BYTES, ..config }
        }
        TaskConfig::Goto { .. } | TaskConfig::Follow { .. } => config,
    }
}

/// A planner that refuses returns its partial path; any other fault is for the user to fix.
fn partial_plan(fault: &Fault) -> anyhow::Result<Plan> {
    match fault.cause {
        Cause::Planner(code) if code != Code::Config => {
            Ok(Plan { path: fault.partial.clone(), ..Plan::default() })
        }
        _ => Err(bad_input(fault.message.clone())),
    }
}

/// What the path does to the tether, certified independently of its planner; without a tether, what it would do to one of
/// unlimited length.
fn certificate(scenario: &Scenario, plan: &Plan) -> Option<Certificate> {
    if plan.path.is_empty() {
        return None;
    }
    let drawing = scenario.sim.world.as_drawn();
    if let Some(tether) = &scenario.mission.tether {
        return Some(certify_from_start(tether, &scenario.mission, &plan.path, &plan.cuts, &drawing));
    }
    let TaskConfig::Cover { anchor, .. } = &scenario.mission.task else { return None };
    let case = Case {
        path: &plan.path,
        anchor: *anchor,
        cable: None,
        boundary: &drawing.boundary,
        obstacles: &drawing.obstacles,
        room_m: scenario.mission.room_m(),
        limits: Limits {
            reel_length_m: f64::INFINITY,
            wrap_max_rad: f64::INFINITY,
            wrap_total_max_rad: f64::INFINITY,
        },
        returns: true,
        cuts: &plan.cuts,
    };
    certify(&case).ok()
}

fn picture(scenario: &Scenario, planned: &Planned) -> String {
    let world = scenario.sim.world.as_drawn();
    let preset = match &scenario.mission.task {
        TaskConfig::Follow { path, .. } => Some(path.as_slice()),
        TaskConfig::Cover { .. } | TaskConfig::Goto { .. } => None,
    };
    let anchor = anchor(&scenario.mission);
    let cable = anchor.and_then(|anchor| longest_cable(anchor, &world, &planned.path)).unwrap_or_default();
    svg(&Drawn {
        world: &world,
        room_m: scenario.mission.room_m(),
        swath_m: scenario.mission.swath_m,
        preset,
        anchor,
        path: &planned.path,
        legs: &planned.legs,
        cuts: &planned.cuts,
        cable: &cable,
    })
}

/// Where the tether comes in, or would.
fn anchor(mission: &MissionConfig) -> Option<Point> {
    match (&mission.tether, &mission.task) {
        (Some(tether), _) => Some(tether.anchor),
        (None, TaskConfig::Cover { anchor, .. }) => Some(*anchor),
        (None, TaskConfig::Goto { .. } | TaskConfig::Follow { .. }) => None,
    }
}

fn longest_cable(anchor: Point, world: &World, path: &[Point]) -> Option<Vec<Point>> {
    let shapes: Vec<Shape> = world.obstacles.iter().map(|obstacle| obstacle.shape.clone()).collect();
    let cable = Cable::new(anchor, &world.boundary, &shapes).ok()?;
    Some(cable.at_longest(path).taut_line())
}

/// The legs as reported by the planner; a plan without legs has a single one.
pub(crate) fn legs(plan: &Plan) -> Vec<Leg> {
    let reported = plan.legs.iter().map(|leg| Leg { tag: leg.tag.word(), first: leg.first, last: leg.last });
    match plan.path.len() {
        0 => vec![],
        n if plan.legs.is_empty() => vec![Leg { tag: "path", first: 0, last: n - 1 }],
        _ => reported.collect(),
    }
}

/// Lengths by tag, for people.
fn lengths(planned: &Planned) -> String {
    let length_m = |tag| -> f64 {
        let legs = planned.legs.iter().filter(|leg| leg.tag == tag);
        legs.map(|leg| polyline::length_m(&planned.path[leg.first..=leg.last])).sum()
    };
    let by_tag = ["swath", "connector", "retract", "travel"].map(|tag| (tag, length_m(tag)));
    let parts: Vec<String> = by_tag
        .iter()
        .filter(|(_, length_m)| *length_m > 0.0)
        .map(|(tag, length_m)| format!("{tag} {length_m:.1} m"))
        .collect();
    if parts.is_empty() { String::new() } else { format!("legs      {}\n", parts.join(", ")) }
}

/// The warnings, for people, except the one already printed as the reason.
fn warnings(planned: &Planned) -> String {
    let fresh = planned.warnings.iter().filter(|warning| Some(*warning) != planned.reason.as_ref());
    fresh.map(|warning| format!("warning   {warning}\n")).collect::<Vec<_>>().concat()
}

/// The floor, for people.
fn floor(floor: &PlannedFloor) -> String {
    let PlannedFloor { swath_m, reachable_m2, shell_margin_m2 } = floor;
    format!(
        "floor     {reachable_m2:.1} m² reachable, {shell_margin_m2:.2} m² shell margin by the whole swath of {swath_m} m, as reports count\n"
    )
}

/// The certificate, for people.
fn certified(certificate: &Certificate) -> String {
    let Certificate { tether_length_max_m, eccentricity_m, wrap_max_rad, wrap_total_max_rad, .. } =
        certificate;
    let reasons: Vec<String> = certificate.reasons.iter().map(|why| format!("          {why}\n")).collect();
    format!(
        "tether    {}, cable {tether_length_max_m:.2} m at most ({eccentricity_m:.2} m the least possible), wrap {:.0} deg on one obstacle, {:.0} deg in sum\n{}",
        if certificate.certified { "certified" } else { "NOT certified" },
        wrap_max_rad.to_degrees(),
        wrap_total_max_rad.to_degrees(),
        reasons.concat(),
    )
}

fn print_plan(planned: &Planned, json: bool) -> anyhow::Result<()> {
    if json {
        return say_line(&serde_json::to_string(planned).context("writing the plan as JSON")?);
    }
    let reason = planned.reason.as_ref().map(|reason| format!("reason    {reason}\n")).unwrap_or_default();
    say(&format!(
        "planner   {}\nlength    {:.2} m, {} points\n{}time      {:.2} ms\ncomplete  {}\n{reason}{}{}{}",
        planned.planner,
        planned.length_m,
        planned.path.len(),
        lengths(planned),
        planned.plan_time_ms,
        if planned.complete { "yes" } else { "no" },
        warnings(planned),
        planned.floor.as_ref().map(floor).unwrap_or_default(),
        planned.certificate.as_ref().map(certified).unwrap_or_default(),
    ))
}
