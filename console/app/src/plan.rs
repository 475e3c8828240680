//! `tankops plan`: a plan on the known map, without flying.

mod drawing;

use crate::{
    cli::PlanArgs,
    failure::{COMPLETE, ENDED_OTHERWISE, bad_input},
    output::{say, say_line},
    scenario::Scenario,
};
use anyhow::Context;
use mission::{Cause, Fault, MissionConfig, Parameters, TaskConfig, preview, tether::judge_from_start};
use planner_api::{Code, Plan};
use planner_host::{Host, HostConfig, PluginDirs};
use serde::Serialize;
use std::{
    process::ExitCode,
    time::{Duration, Instant},
};
use world::{Point, polyline, tether::Certificate};

/// Time that a planner may take for a plan of the whole floor.
const COVER_WITHIN: Duration = Duration::from_secs(60);

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
    /// Proof about the tether; absent without one.
    certificate: Option<Certificate>,
}

/// Some points of the path that serve one purpose: index of the first and of the last.
#[derive(Debug, Serialize)]
pub struct Leg {
    tag: &'static str,
    first: usize,
    last: usize,
}

/// `tankops plan`.
pub fn plan(args: &PlanArgs, plugins: &PluginDirs) -> anyhow::Result<ExitCode> {
    let scenario = crate::read_scenario(&args.scenario, &args.changes)?;
    let planned = make_plan(&scenario, plugins)?;
    tell(&planned, args.json)?;
    if let Some(file) = &args.svg {
        let picture = drawing::svg(&scenario, &planned.path, &planned.legs, &planned.cuts);
        std::fs::write(file, picture).map_err(|error| {
            bad_input(format!("the drawing cannot be written: {error}: {}", file.display()))
        })?;
    }
    Ok(ExitCode::from(if planned.complete { COMPLETE } else { ENDED_OTHERWISE }))
}

fn make_plan(scenario: &Scenario, plugins: &PluginDirs) -> anyhow::Result<Planned> {
    let mut host = Host::new(plugins, patient(HostConfig::new(Duration::from_secs(1)), &scenario.mission));
    let began = Instant::now();
    let answer = preview(&scenario.mission, &scenario.sim.world.as_drawn(), scenario.seed, &mut host);
    let plan_time_ms = host.stats().plan.p50_us.unwrap_or(began.elapsed().as_secs_f64() * 1e6) / 1e3;
    let (plan, reason) = match answer {
        Ok((_, reply)) => {
            let said = reply.logs.into_iter().map(|(_, message)| message).next_back();
            let reason =
                (!reply.value.complete).then(|| said.unwrap_or_else(|| "the planner did not say why".into()));
            (reply.value, reason)
        }
        Err(fault) => (partial_plan(&fault)?, Some(fault.message)),
    };
    Ok(Planned {
        planner: scenario.mission.planner.id.clone(),
        parameters: scenario.mission.planner.parameters.clone(),
        legs: legs(&plan),
        length_m: polyline::length_m(&plan.path),
        plan_time_ms,
        complete: plan.complete,
        reason,
        certificate: certificate(scenario, &plan.path, &plan.cuts),
        cuts: plan.cuts,
        path: plan.path,
    })
}

/// What the plan does to the tether, judged on its path alone.
fn certificate(scenario: &Scenario, path: &[Point], cuts: &[Vec<Point>]) -> Option<Certificate> {
    let tether = scenario.mission.tether.as_ref()?;
    Some(judge_from_start(tether, &scenario.mission, path, cuts, &scenario.sim.world.as_drawn()))
}

/// A plan for a whole floor takes longer than a way to a point.
pub fn patient(config: HostConfig, mission: &MissionConfig) -> HostConfig {
    match mission.task {
        TaskConfig::Cover { .. } => HostConfig { plan_deadline: COVER_WITHIN, ..config },
        TaskConfig::Goto { .. } | TaskConfig::Follow { .. } => config,
    }
}

/// A planner that says no by itself gives as much as it has; any other fault is the user's to mend.
fn partial_plan(fault: &Fault) -> anyhow::Result<Plan> {
    match fault.cause {
        Cause::Planner(code) if code != Code::Config => {
            Ok(Plan { path: fault.partial.clone(), ..Plan::default() })
        }
        _ => Err(bad_input(fault.message.clone())),
    }
}

/// The legs as the planner told them; a planner that told none has a single one.
fn legs(plan: &Plan) -> Vec<Leg> {
    let told = plan.legs.iter().map(|leg| Leg { tag: leg.tag.word(), first: leg.first, last: leg.last });
    match plan.path.len() {
        0 => vec![],
        n if plan.legs.is_empty() => vec![Leg { tag: "path", first: 0, last: n - 1 }],
        _ => told.collect(),
    }
}

/// Lengths by tag, for people.
fn lengths(planned: &Planned) -> String {
    let length_m = |tag| -> f64 {
        let legs = planned.legs.iter().filter(|leg| leg.tag == tag);
        legs.map(|leg| polyline::length_m(&planned.path[leg.first..=leg.last])).sum()
    };
    let told = ["swath", "connector", "retract", "travel"].map(|tag| (tag, length_m(tag)));
    let parts: Vec<String> = told
        .iter()
        .filter(|(_, length_m)| *length_m > 0.0)
        .map(|(tag, length_m)| format!("{tag} {length_m:.1} m"))
        .collect();
    if parts.is_empty() { String::new() } else { format!("legs      {}\n", parts.join(", ")) }
}

fn tether_line(certificate: &Certificate) -> String {
    let Certificate { max_cable_m, max_wrap_rad, .. } = certificate;
    let wrap_deg = max_wrap_rad.to_degrees();
    let verdict = if certificate.certified { "certified".to_owned() } else { certificate.reasons.join("; ") };
    format!(
        "tether    {verdict}\ncable     {max_cable_m:.1} m at most, {wrap_deg:.0} deg round one obstacle at most\n"
    )
}

fn tell(planned: &Planned, json: bool) -> anyhow::Result<()> {
    if json {
        return say_line(&serde_json::to_string(planned).context("writing the plan as JSON")?);
    }
    let reason = planned.reason.as_ref().map(|reason| format!("reason    {reason}\n")).unwrap_or_default();
    let tether = planned.certificate.as_ref().map(tether_line).unwrap_or_default();
    say(&format!(
        "planner   {}\nlength    {:.2} m, {} points\n{}time      {:.2} ms\ncomplete  {}\n{reason}{tether}",
        planned.planner,
        planned.length_m,
        planned.path.len(),
        lengths(planned),
        planned.plan_time_ms,
        if planned.complete { "yes" } else { "no" },
    ))
}
