//! Goal planners on random traps: U, triangle, spiral and double traps among free discs.
//!
//! The reference is the exact shortest way on the whole map. Known map: one plan, whose path is measured. Unknown map:
//! a flight in which discs within the sensing range are discovered, replanned on every discovery and flown by the
//! planner's own commands.

mod flight;
mod measured;
mod rows;

use crate::{
    bench::Bench,
    row::Row,
    study::{Options, Problem, Study},
};
use measured::{Measured, measure};
use mission::{ParamValue, Parameters};
use trials::traps::Kind;

/// The studies.
pub const STUDIES: &[Study] = &[Study {
    name: "trap-suite",
    about: "goal planners on random U, triangle, spiral and double traps, against the exact shortest way",
    layouts: 50,
    run: trap_suite,
}];

/// What a planner knows of the map.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Map {
    /// Everything.
    Known,
    /// What was within range so far.
    Sensed {
        /// Range, metres.
        range_m: f64,
    },
}

/// A planner set up for the suite.
#[derive(Debug, Clone, PartialEq)]
struct Method {
    id: &'static str,
    planner: &'static str,
    parameters: Parameters,
    map: Map,
    note: &'static str,
}

const UNKNOWN: &str = "unknown map: discs within 6 m are discovered, also behind others; flown by the planner's commands at 1 m/s";

fn methods() -> Vec<Method> {
    let known = |id: &'static str, planner: &'static str| Method {
        id,
        planner,
        parameters: Parameters::new(),
        map: Map::Known,
        note: "",
    };
    let with = |method: Method, key: &str, value: ParamValue| {
        let parameters = Parameters::from([(key.to_owned(), value)]);
        Method { parameters, ..method }
    };
    let mode =
        |id: &'static str, mode: &str| with(known(id, "bvo-apf"), "mode", ParamValue::Word(mode.to_owned()));
    let unknown = |method: Method| Method { map: Map::Sensed { range_m: 6.0 }, note: UNKNOWN, ..method };
    vec![
        known("shortest", "shortest"),
        with(known("navfn", "navfn"), "cells", ParamValue::Int(240)),
        known("apf", "apf"),
        known("tapf", "tapf"),
        known("apf-virtual-goals", "apf-virtual-goals"),
        known("apf-dwa", "apf-dwa"),
        mode("bvo-apf/literal", "literal"),
        mode("bvo-apf/hull", "hull"),
        mode("bvo-apf/rollout", "rollout"),
        mode("bvo-apf/pre", "pre"),
        unknown(known("shortest/unknown", "shortest")),
        unknown(with(known("navfn/unknown", "navfn"), "cells", ParamValue::Int(200))),
    ]
}

/// Every method on every kind of trap.
fn trap_suite(study: &Study, bench: &Bench<'_>, options: &Options) -> Result<Vec<Row>, Problem> {
    let methods: Vec<Method> = methods().into_iter().filter(|method| options.has_method(method.id)).collect();
    let kinds: Vec<Kind> =
        Kind::ALL.into_iter().filter(|kind| options.has_case(kind.id()) || options.has_case("all")).collect();
    let cases: Vec<(usize, Kind, u64)> = (0..methods.len())
        .flat_map(|method| kinds.iter().map(move |kind| (method, *kind)))
        .flat_map(|(method, kind)| options.seeds(study.layouts).map(move |seed| (method, kind, seed)))
        .collect();
    if cases.is_empty() {
        let known = "u, triangle, spiral, double, all";
        return Err(Problem::Nothing(format!("no case or method of that name is left; cases are {known}")));
    }
    let all = bench
        .map(&cases, |planners, (method, kind, seed)| measure(planners, &methods[*method], *kind, *seed))?;
    let mut rows = Vec::new();
    for (index, method) in methods.iter().enumerate() {
        let of = |wanted: Option<Kind>| -> Vec<&Measured> {
            let is_meant =
                |case: &(usize, Kind, u64)| case.0 == index && wanted.is_none_or(|kind| kind == case.1);
            cases.iter().zip(&all).filter(|(case, _)| is_meant(case)).map(|(_, measured)| measured).collect()
        };
        for kind in kinds.iter().filter(|kind| options.has_case(kind.id())) {
            rows.extend(rows::rows(study.name, kind.id(), method, &of(Some(*kind))));
        }
        if options.has_case("all") {
            rows.extend(rows::rows(study.name, "all", method, &of(None)));
        }
    }
    Ok(rows)
}
