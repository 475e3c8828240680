//! After Pan 2025: the robot first makes the map of the floor, then a planner covers the floor by that map.
//!
//! Tanks like those of the original study, with the columns at random places. The robot knows only the wall. It surveys the
//! floor with a simulated scanner and positions from acoustic-emission ranges, and the map becomes the drawing of a coverage
//! mission. The columns of the tank stay where they are, so the robot covers the floor by a map with the errors of its
//! survey. The same mission with the true drawing stands beside it.

mod cover;
mod rows;
mod site;
mod survey;

use crate::study::{Job, Method, Planners, Result, Row, Study};
use cover::{Covered, cover};
use serde::{Deserialize, Serialize};
use survey::{Surveyed, survey};
use trials::tanks::{Known, Tank};

/// The studies.
pub(crate) const STUDIES: &[Study] = &[Study {
    name: "pan-own-map",
    about: "after Pan 2025: the tanks of pan-maps, surveyed by the robot and covered by its own map; beside it, the \
            same missions with the true drawing",
    layouts: 3,
    run,
}];

/// The drawing of the coverage mission.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Source {
    /// The map of a survey.
    OwnMap,
    /// The true drawing.
    Drawing,
}

impl Source {
    const ALL: [Self; 2] = [Self::OwnMap, Self::Drawing];

    const fn id(self) -> &'static str {
        match self {
            Self::OwnMap => "own-map",
            Self::Drawing => "drawing",
        }
    }
}

/// The result in one tank.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Measured {
    /// The survey; `None` with the true drawing.
    survey: Option<Surveyed>,
    /// The coverage mission, or the reason why the map gives none.
    cover: std::result::Result<Covered, String>,
}

fn run(job: &Job<'_>) -> Result<Vec<Row>> {
    let cases = job.cases(Known::ALL, |known| known.id().into())?;
    let all = ["tether-safe", "hull-partition"].into_iter().flat_map(|planner| {
        Source::ALL.map(|source| (Method::new(format!("{planner}/{}", source.id()), planner, ""), source))
    });
    let methods = job.methods(all, |(method, _)| method.id.clone())?;
    let pairs: Vec<_> =
        cases.iter().flat_map(|known| methods.iter().map(move |method| (*known, method))).collect();
    let seeds = job.seeds();
    let all = job.runner.grid(&pairs, &seeds, |planners, (known, (method, source)), seed| {
        Ok(measure(planners, &known.tank(*seed), *seed, &method.planner, *source))
    })?;
    let of_pair = |((known, (method, _)), measured): (&(Known, &(Method, Source)), &Vec<Measured>)| {
        let block = job.block(known.id(), &method.id, "");
        rows::rows(&block, &seeds.iter().copied().zip(measured).collect::<Vec<_>>())
    };
    Ok(pairs.iter().zip(&all).flat_map(of_pair).collect())
}

fn measure(planners: &Planners, tank: &Tank, seed: u64, planner: &str, source: Source) -> Measured {
    match source {
        Source::Drawing => {
            let text = site::cover(tank, seed, planner);
            Measured { survey: None, cover: cover(planners, &text, tank) }
        }
        Source::OwnMap => {
            let (survey, text) = survey(tank, seed, planner);
            let cover = text.and_then(|text| cover(planners, &site::with_truth(&text, tank), tank));
            Measured { survey: Some(survey), cover }
        }
    }
}

#[cfg(test)]
mod tests;
