//! The certificate of a plan against a cable with weight and friction, in random tanks.
//!
//! Each plan is driven with a simulated cable on a reel whose pull is the pull that the plan needs, divided by the ratio
//! of the case. The rules of the mission watch the drive with the true positions: the figures show what the cable does,
//! not what the position error adds. Pull of the reel, weight and friction enter only as ratios.

mod drive;
mod reeling;
mod rows;

use crate::{
    coverage::{is_result, plan},
    study::{Job, Method, Result, Row, Study, StudyError},
};
use drive::{Drive, drive};
use reeling::{Reeling, reeling};
use serde::{Deserialize, Serialize};
use trials::tanks::Tank;
use world::tether::Reel;

/// The studies.
pub(crate) const STUDIES: &[Study] = &[Study {
    name: "tether-physics",
    about: "random tanks of radius 5 to 12 m: the certificate against a cable with weight and friction, at five ratios \
            of the pull that a plan needs to the pull of its reel, and with a reel that stops",
    layouts: 8,
    run,
}];

/// The pull that a plan needs, as a share of the pull of the reel.
const RATIOS: [f64; 5] = [0.5, 0.8, 1.0, 1.5, 3.0];
/// The ratio of the cases with a reel that stops, and the shares of the path after which it does.
const STOPPED_RATIO: f64 = 0.5;
const STOPS_AT: [f64; 3] = [0.25, 0.5, 0.75];
/// The id of the case that compares the needed pull with that of the simulated cable.
const PULL: &str = "pull";
/// Coefficient of friction on columns and walls.
const FRICTION: f64 = 0.3;

/// What is measured in one tank.
#[derive(Debug, Clone, Copy)]
enum Case {
    Ratio(f64),
    /// The reel stops taking cable up after this share of the path.
    Stopped(f64),
    Pull,
}

impl Case {
    fn id(self) -> String {
        match self {
            Self::Ratio(ratio) => format!("ratio-{ratio:.1}"),
            Self::Stopped(share) => format!("stopped-{share:.2}"),
            Self::Pull => PULL.into(),
        }
    }
}

/// The result in one tank.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
enum Measured {
    /// The planner gave no path.
    NoPath(String),
    Drive(Drive),
    Reeling(Vec<Reeling>),
}

fn run(job: &Job<'_>) -> Result<Vec<Row>> {
    let all = RATIOS.map(Case::Ratio).into_iter().chain(STOPS_AT.map(Case::Stopped)).chain([Case::Pull]);
    let cases = job.cases(all, |case| case.id())?;
    let methods = ["tether-safe", "hull-partition"].map(|id| Method::new(id, id, ""));
    let methods = job.methods(methods, |method| method.id.clone())?;
    let pairs: Vec<(&Case, &Method)> =
        cases.iter().flat_map(|case| methods.iter().map(move |method| (case, method))).collect();
    let seeds = job.seeds();
    let all = job.runner.grid(&pairs, &seeds, |planners, (case, method), seed| {
        let tank = Tank::of_radius(5.0..12.0, *seed);
        let path = match plan(planners, method, &tank) {
            Ok(planned) if planned.has_path() => planned.plan.path,
            Ok(planned) => return Ok(Measured::NoPath(planned.reason.unwrap_or_default())),
            Err(StudyError::Planner { fault, .. }) if is_result(&fault) => {
                return Ok(Measured::NoPath(fault.message));
            }
            Err(error) => return Err(error.in_case(format!("{} seed {seed}", case.id()))),
        };
        Ok(match case {
            Case::Ratio(ratio) => Measured::Drive(drive(&tank, &path, *ratio, None)),
            Case::Stopped(share) => Measured::Drive(drive(&tank, &path, STOPPED_RATIO, Some(*share))),
            Case::Pull => Measured::Reeling(reeling(&tank, &path)),
        })
    })?;
    let of_pair = |((case, method), measured): (&(&Case, &Method), &Vec<Measured>)| {
        let id = case.id();
        let block = job.block(&id, &method.id, "");
        rows::rows(&block, &seeds.iter().copied().zip(measured).collect::<Vec<_>>())
    };
    Ok(pairs.iter().zip(&all).flat_map(of_pair).collect())
}

/// A reel with a given pull, newtons, and a cable of 100 g per metre on steel.
fn reel(pull_n: f64) -> Reel {
    Reel {
        mass_kg_per_m: 0.1,
        floor_friction: 0.3,
        pull_n,
        pay_out_n: 0.5,
        robot_pull_n: None,
        pull_ratio_max: 0.8,
    }
}

#[cfg(test)]
mod tests;
