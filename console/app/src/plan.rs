//! `tankops plan`: a plan on the known map, without flying.

mod drawing;

use crate::{
    cli::PlanArgs,
    failure::{COMPLETE, ENDED_OTHERWISE, bad_input},
    output::{say, say_line},
    scenario::Scenario,
};
use anyhow::Context;
use mission::{Cause, Fault, Parameters, preview};
use planner_api::{Code, Plan};
use planner_host::{Host, HostConfig, PluginDirs};
use serde::Serialize;
use std::{
    process::ExitCode,
    time::{Duration, Instant},
};
use world::{Point, polyline};

/// A plan as scripts read it.
#[derive(Debug, Serialize)]
struct Planned {
    planner: String,
    parameters: Parameters,
    path: Vec<Point>,
    legs: Vec<Leg>,
    length_m: f64,
    plan_time_ms: f64,
    complete: bool,
    /// Why it is not complete.
    reason: Option<String>,
    /// Proof about the tether; absent without one.
    certificate: Option<()>,
}

/// Some points of the path that serve one purpose: index of the first and of the last.
#[derive(Debug, Serialize)]
struct Leg {
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
        let picture = drawing::svg(&scenario, &planned.path);
        std::fs::write(file, picture).map_err(|error| {
            bad_input(format!("the drawing cannot be written: {error}: {}", file.display()))
        })?;
    }
    Ok(ExitCode::from(if planned.complete { COMPLETE } else { ENDED_OTHERWISE }))
}

fn make_plan(scenario: &Scenario, plugins: &PluginDirs) -> anyhow::Result<Planned> {
    let mut host = Host::new(plugins, HostConfig::new(Duration::from_secs(1)));
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
        legs: legs(&plan.path),
        length_m: polyline::length_m(&plan.path),
        path: plan.path,
        plan_time_ms,
        complete: plan.complete,
        reason,
        certificate: None,
    })
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

fn legs(path: &[Point]) -> Vec<Leg> {
    if path.is_empty() { vec![] } else { vec![Leg { tag: "path", first: 0, last: path.len() - 1 }] }
}

fn tell(planned: &Planned, json: bool) -> anyhow::Result<()> {
    if json {
        return say_line(&serde_json::to_string(planned).context("writing the plan as JSON")?);
    }
    let reason = planned.reason.as_ref().map(|reason| format!("reason    {reason}\n")).unwrap_or_default();
    say(&format!(
        "planner   {}\nlength    {:.2} m, {} points\ntime      {:.2} ms\ncomplete  {}\n{reason}",
        planned.planner,
        planned.length_m,
        planned.path.len(),
        planned.plan_time_ms,
        if planned.complete { "yes" } else { "no" },
    ))
}
