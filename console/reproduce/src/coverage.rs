//! Coverage planners and the tether: tanks of the make of the study behind them, and random ones.
//!
//! Pan 2025 prints no figures of its own; nothing is beside ours. Figures are those of `trials::tanks`: a flat bar
//! across the heading, cells of 0.05 m, swath 0.6 m, hull and clearance 0.3 m together, the return included.

mod measured;
mod picture;
mod rows;

pub use picture::Picture;

use crate::{
    bench::Bench,
    row::Row,
    study::{Options, Problem, Study},
};
use measured::{Measured, measure};
use mission::{ParamValue, Parameters};
use trials::tanks::{Known, Tank};

/// The studies.
pub const STUDIES: &[Study] = &[
    Study {
        name: "pan-maps",
        about: "after Pan 2025: round tanks with 14 and 28 columns and a square with 18, every coverage planner",
        layouts: 10,
        run: pan_maps,
    },
    Study {
        name: "coverage-suite",
        about: "random tanks of radius 5 to 50 m with 0 to 120 columns, every coverage planner and its tether",
        layouts: 20,
        run: suite,
    },
];

/// The case of the random tanks.
const RANDOM: &str = "random";

/// A planner with its parameters, and the metric ids' method.
struct Method {
    id: &'static str,
    planner: &'static str,
    parameters: &'static [(&'static str, Setting)],
}

/// A value of a parameter.
#[derive(Clone, Copy)]
enum Setting {
    Number(f64),
    Word(&'static str),
}

impl Method {
    fn parameters(&self) -> Parameters {
        let value = |setting: Setting| match setting {
            Setting::Number(number) => ParamValue::Float(number),
            Setting::Word(word) => ParamValue::Word(word.to_owned()),
        };
        self.parameters.iter().map(|(key, setting)| ((*key).to_owned(), value(*setting))).collect()
    }
}

const METHODS: &[Method] = &[
    Method { id: "boustrophedon", planner: "boustrophedon", parameters: &[] },
    Method {
        id: "hull-partition/direct",
        planner: "hull-partition",
        parameters: &[("backtracking", Setting::Word("direct"))],
    },
    Method {
        id: "hull-partition/tree",
        planner: "hull-partition",
        parameters: &[("backtracking", Setting::Word("tree"))],
    },
    Method { id: "tether-safe", planner: "tether-safe", parameters: &[] },
    Method {
        id: "tether-safe/alpha-0",
        planner: "tether-safe",
        parameters: &[("alpha_deg", Setting::Number(0.0))],
    },
    Method {
        id: "tether-safe/fewest-turns",
        planner: "tether-safe",
        parameters: &[("choose", Setting::Word("fewest-turns"))],
    },
];

/// One planner on one tank.
struct Trial {
    case: &'static str,
    seed: u64,
    tank: Tank,
    method: &'static Method,
}

fn pan_maps(study: &Study, bench: &Bench<'_>, options: &Options) -> Result<Vec<Row>, Problem> {
    let known = Known::ALL.into_iter().filter(|known| options.has_case(known.id()));
    let tanks = known.flat_map(|known| {
        let seeds = options.seeds(study.layouts);
        seeds.map(move |seed| (known.id(), seed, known.tank(seed)))
    });
    measured(study, bench, options, tanks.collect(), &Known::ALL.map(Known::id))
}

fn suite(study: &Study, bench: &Bench<'_>, options: &Options) -> Result<Vec<Row>, Problem> {
    let seeds = options.seeds(study.layouts).filter(|_| options.has_case(RANDOM));
    let tanks = seeds.map(|seed| (RANDOM, seed, Tank::random(seed)));
    measured(study, bench, options, tanks.collect(), &[RANDOM])
}

/// Every planner on every tank, tank by tank, so that the progress is that of the study.
fn measured(
    study: &Study,
    bench: &Bench<'_>,
    options: &Options,
    tanks: Vec<(&'static str, u64, Tank)>,
    cases: &[&str],
) -> Result<Vec<Row>, Problem> {
    let methods: Vec<&Method> = METHODS.iter().filter(|method| options.has_method(method.id)).collect();
    if tanks.is_empty() || methods.is_empty() {
        return Err(options.nothing_left(study, cases, &METHODS.iter().map(|m| m.id).collect::<Vec<_>>()));
    }
    let trials: Vec<Trial> = tanks
        .into_iter()
        .flat_map(|(case, seed, tank)| {
            methods.iter().map(move |method| Trial { case, seed, tank: tank.clone(), method })
        })
        .collect();
    let all = bench.map(&trials, |planners, trial| measure(planners, trial, bench.gallery()))?;
    let of = |case: &str, method: &str| -> Vec<(u64, &Measured)> {
        let is_meant = |trial: &Trial| trial.case == case && trial.method.id == method;
        let both = trials.iter().zip(&all).filter(|(trial, _)| is_meant(trial));
        both.map(|(trial, measured)| (trial.seed, measured)).collect()
    };
    let cases = cases.iter().filter(|case| options.has_case(case));
    let blocks = cases.flat_map(|case| methods.iter().map(move |method| (*case, method.id)));
    Ok(blocks.flat_map(|(case, method)| rows::rows(study.name, case, method, &of(case, method))).collect())
}
