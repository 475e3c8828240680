//! The plan of a campaign: a TOML file.

use crate::{
    design::{Design, Seeds},
    grid::{Axis, latin_hypercube, product},
    reader::{Placed, Reader},
    table::is_metric,
    until::Until,
    value::Value,
};
use mission::spelling::nearest;
use scenario::{Complaint, Problem, ScenarioErrors};
use std::{cell::RefCell, ops::Range};
use toml::de::{DeTable, DeValue};

const KEYS: [&str; 11] = [
    "name",
    "scenarios",
    "planners",
    "grid",
    "samples",
    "seeds",
    "metrics",
    "until",
    "expect",
    "block",
    "about",
];
/// Metrics that are used if the plan names none.
const METRICS: [&str; 4] = ["mission_time_s", "path_length_m", "clearance_min_m", "coverage.reachable"];
/// Maximum number of points; more are probably a mistake.
const MOST_POINTS: usize = 100_000;
/// Maximum number of missions; more are probably a mistake.
pub(crate) const MOST_CASES: u64 = 100_000_000;
/// The range of seeds; they are limited because scenarios store them as TOML numbers.
pub(crate) const SEEDS: Range<u64> = 0..(1 << 62);

/// A plan, checked as far as that is possible without its scenarios and planners.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// The values that vary between missions, and the metrics.
    pub design: Design,
    /// Paths of the scenario files as written, relative to the folder of the plan.
    pub scenarios: Vec<String>,
    /// Number of missions per block, if the plan sets it.
    pub block: Option<u64>,
    shown_name: String,
    text: String,
    places: Vec<(PlanKey, Range<usize>)>,
}

/// A value in a plan that only the scenarios and planners can check.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PlanKey {
    /// A scenario, by its index.
    Scenario(usize),
    /// A planner, by its index.
    Planner(usize),
    /// A key of the grid, by its index.
    Grid(usize),
    /// The bounds.
    Expect,
}

impl Plan {
    /// Reads a plan from its text. `shown_name` is the name of the file as used in messages; `name` is the name of the
    /// campaign if the plan does not set one.
    ///
    /// # Errors
    /// Everything that is wrong with the plan, with line, key and remedy.
    pub fn parse(text: &str, shown_name: &str, name: &str) -> Result<Self, ScenarioErrors> {
        let errors =
            |problems| ScenarioErrors { shown_name: shown_name.to_owned(), text: text.to_owned(), problems };
        let table = DeTable::parse(text).map_err(|error| {
            let what = Complaint::NotToml(error.message().lines().next().unwrap_or_default().to_owned());
            errors(vec![Problem { key: String::new(), value: None, at: error.span(), what }])
        })?;
        let problems = RefCell::default();
        let plan = read(&Reader::new(text, table.get_ref(), "", &KEYS, &problems), shown_name, text, name);
        let mut problems = problems.into_inner();
        problems.sort_by_key(|problem: &Problem| problem.at.as_ref().map(|at| at.start));
        if problems.is_empty() { Ok(plan) } else { Err(errors(problems)) }
    }

    /// The objections that scenarios or planners raise to a value in the plan.
    pub fn refused(&self, key: PlanKey, why: &str) -> ScenarioErrors {
        let at = self.places.iter().find(|(placed, _)| *placed == key).map(|(_, at)| at.clone());
        let name = match key {
            PlanKey::Scenario(at) => format!("scenarios.{at}"),
            PlanKey::Planner(at) => format!("planners.{at}"),
            PlanKey::Grid(at) => format!("grid.{}", self.design.keys[at]),
            PlanKey::Expect => "expect".to_owned(),
        };
        let value = at.clone().and_then(|at| self.text.get(at)).map(str::to_owned);
        let problem = Problem { key: name, value, at, what: Complaint::Planner(why.to_owned()) };
        ScenarioErrors {
            shown_name: self.shown_name.clone(),
            text: self.text.clone(),
            problems: vec![problem],
        }
    }
}

fn read(root: &Reader<'_>, shown_name: &str, text: &str, name: &str) -> Plan {
    root.require(
        "scenarios",
        "write scenarios = [\"demo.toml\"]; paths are relative to the folder of the plan",
    );
    root.require("seeds", "write seeds = { first = 0, count = 100 }");
    let (scenarios, planners) = (root.words("scenarios"), root.words("planners"));
    let grid = axes(root);
    let points = points(root, &grid);
    let seeds = seeds(root);
    let cases = scenarios.len().max(1) * planners.len().max(1) * points.len();
    if (cases as u64).saturating_mul(seeds.count) > MOST_CASES {
        let what = Complaint::OutOfRange(format!("fewer: at most {MOST_CASES} missions in total"));
        root.complain("seeds", root.place("seeds"), what);
    }
    let placed = |of: &[(String, Range<usize>)], key: fn(usize) -> PlanKey| -> Vec<(PlanKey, Range<usize>)> {
        of.iter().enumerate().map(|(at, (_, place))| (key(at), place.clone())).collect()
    };
    let mut places = placed(&scenarios, PlanKey::Scenario);
    places.extend(placed(&planners, PlanKey::Planner));
    places.extend(grid.iter().enumerate().map(|(at, (_, _, place))| (PlanKey::Grid(at), place.clone())));
    places.extend(root.get("expect").map(|value| (PlanKey::Expect, value.span())));
    let design = Design {
        name: root.word("name").unwrap_or_else(|| name.to_owned()),
        planners: planners.into_iter().map(|(word, _)| word).collect(),
        keys: grid.into_iter().map(|(key, ..)| key).collect(),
        points,
        expect: expect(root),
        seeds,
        metrics: metrics(root),
        until: until(root),
    };
    Plan {
        design,
        scenarios: scenarios.into_iter().map(|(word, _)| word).collect(),
        block: root.whole("block", 1..1_000_001),
        shown_name: shown_name.to_owned(),
        text: text.to_owned(),
        places,
    }
}

fn seeds(root: &Reader<'_>) -> Seeds {
    let table = root.table("seeds", &["first", "count"]);
    let of = |name, range| table.as_ref().and_then(|table| table.whole(name, range));
    if let Some(table) = &table {
        table.require("count", "write seeds = { first = 0, count = 100 }");
    }
    Seeds { first: of("first", SEEDS).unwrap_or(0), count: of("count", 1..MOST_CASES + 1).unwrap_or(1) }
}

fn metrics(root: &Reader<'_>) -> Vec<String> {
    if root.get("metrics").is_none() {
        return METRICS.map(str::to_owned).to_vec();
    }
    let named = root.words("metrics");
    for (name, at) in named.iter().filter(|(name, _)| !is_metric(name)) {
        root.complain("metrics", at.clone(), unknown_metric(name));
    }
    named.into_iter().map(|(name, _)| name).collect()
}

/// The message about an unknown metric.
fn unknown_metric(name: &str) -> Complaint {
    let known = crate::table::metrics().collect::<Vec<_>>();
    let remedy = match nearest(name, known.iter().copied()) {
        Some(key) => format!("did you mean \"{key}\"?"),
        None => format!("known: {}", known.join(", ")),
    };
    Complaint::WrongType { wanted: "the name of a figure in the report".into(), remedy }
}

fn until(root: &Reader<'_>) -> Option<Until> {
    let until = root.table("until", &["ci95", "seeds_min"])?;
    until.require("ci95", "write ci95 = { metric = \"success\", below = 0.02 }");
    let ci95 = until.table("ci95", &["metric", "below"])?;
    ci95.require("metric", "name the figure whose 95 % interval decides");
    ci95.require("below", "set the half width below which the campaign stops");
    let metric = ci95.word("metric")?;
    if metric != "success" && !is_metric(&metric) {
        ci95.complain("metric", ci95.place("metric"), unknown_metric(&metric));
    }
    let seeds_min = until.whole("seeds_min", 2..1_000_000).unwrap_or(Until::SEEDS_MIN);
    Some(Until { metric, below: ci95.number("below")?, seeds_min })
}

/// Reads the bounds in `[expect]`; the scenarios check their keys.
fn expect(root: &Reader<'_>) -> Vec<(String, Value)> {
    let Some(table) = root.table("expect", &[]) else { return Vec::new() };
    let bound = |(name, value): (String, &Placed<'_>)| {
        let bound = Value::read(value.get_ref());
        if bound.is_none() {
            let wanted = "a number or a word".into();
            table.complain(
                &name,
                value.span(),
                Complaint::WrongType { wanted, remedy: "as in a scenario".into() },
            );
        }
        Some((name, bound?))
    };
    table.entries().into_iter().filter_map(bound).collect()
}

type Axes = Vec<(String, Axis, Range<usize>)>;

fn axes(root: &Reader<'_>) -> Axes {
    let Some(grid) = root.table("grid", &[]) else { return Vec::new() };
    let axis =
        |(name, value): (String, &Placed<'_>)| Some((name.clone(), axis(&grid, &name, value)?, value.span()));
    grid.entries().into_iter().filter_map(axis).collect()
}

fn axis(grid: &Reader<'_>, name: &str, value: &Placed<'_>) -> Option<Axis> {
    match value.get_ref() {
        DeValue::Array(list) => {
            let values: Option<Vec<Value>> = list.iter().map(|entry| Value::read(entry.get_ref())).collect();
            let values = values.filter(|values| !values.is_empty());
            if values.is_none() {
                let remedy = "write [0.1, 0.2], or { from = 0.1, to = 0.9, steps = 5 }".to_owned();
                let wanted = "a list of numbers, words or flags".to_owned();
                grid.complain(name, value.span(), Complaint::WrongType { wanted, remedy });
            }
            values.map(Axis::List)
        }
        DeValue::Table(_) => {
            let range = grid.table(name, &["from", "to", "steps", "log"])?;
            for end in ["from", "to"] {
                range.require(end, "a range needs both ends: { from = 0.1, to = 0.9, steps = 5 }");
            }
            let steps = range.whole("steps", 2..100_001).map(|steps| steps as usize);
            let (from, to, log) = (range.number("from")?, range.number("to")?, range.flag("log"));
            if !(from < to && (!log || from > 0.0)) {
                let must_be = if log { "0 < from < to" } else { "from < to" };
                range.complain(
                    "to",
                    range.place("to"),
                    Complaint::OutOfRange(format!("such that {must_be}")),
                );
            }
            Some(Axis::Range { from, to, steps, log })
        }
        _ => {
            let remedy =
                "write a list, or { from = 0.1, to = 0.9, steps = 5 }; for a single value, write [value]"
                    .to_owned();
            grid.complain(
                name,
                value.span(),
                Complaint::WrongType { wanted: "a list or a range".into(), remedy },
            );
            None
        }
    }
}

fn points(root: &Reader<'_>, axes: &Axes) -> Vec<Vec<Value>> {
    let named: Vec<(String, Axis)> =
        axes.iter().map(|(name, axis, _)| (name.clone(), axis.clone())).collect();
    if let Some(samples) = root.whole("samples", 1..MOST_POINTS as u64 + 1) {
        if named.is_empty() {
            root.complain(
                "samples",
                root.place("samples"),
                Complaint::OutOfPlace { beside: "an empty [grid]".into() },
            );
        }
        return latin_hypercube(&named, samples as usize, 0);
    }
    let grid = root.table("grid", &[]);
    for (name, axis, at) in axes {
        if let (Axis::Range { steps: None, .. }, Some(grid)) = (axis, &grid) {
            let wanted = "a range with steps, or `samples` at the top of the plan".to_owned();
            grid.complain(name, at.clone(), Complaint::WrongType { wanted, remedy: "add steps = 5".into() });
        }
    }
    let count: f64 = named.iter().map(|(_, axis)| axis.values().len() as f64).product();
    if count > MOST_POINTS as f64 {
        let what = Complaint::OutOfRange(format!(
            "smaller: it has {count} combinations, and at most {MOST_POINTS} are allowed; set `samples` \
             to use only some of them"
        ));
        root.complain("grid", root.place("grid"), what);
        return vec![Vec::new()];
    }
    product(&named)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(text: &str) -> String {
        Plan::parse(text, "plan.toml", "plan").expect_err("something is wrong").render()
    }

    #[test]
    fn a_plan_is_read_whole() {
        let text = "scenarios = [\"a.toml\"]\nplanners = [\"rpf\", \"apf\"]\nseeds = { first = 7, count = 3 }\nmetrics = [\"turns\"]\n\
                    [grid]\nk_rep = [0.5, 1]\n\"mission.swath_m\" = { from = 0.4, to = 0.8, steps = 3 }\n\
                    [until]\nci95 = { metric = \"success\", below = 0.1 }\n[expect]\ncollisions_max = 0\n";
        let plan = Plan::parse(text, "plan.toml", "plan").expect("nothing is wrong");
        assert_eq!(
            (plan.design.name.as_str(), plan.design.points.len(), plan.design.seeds.first),
            ("plan", 6, 7)
        );
        assert_eq!(plan.design.keys, ["k_rep", "mission.swath_m"]);
        assert_eq!(plan.design.points[5], [Value::Whole(1), Value::Number(0.8)]);
        assert_eq!(plan.design.expect, [("collisions_max".to_owned(), Value::Whole(0))]);
        assert_eq!(plan.design.until.map(|until| until.metric).as_deref(), Some("success"));
    }

    #[test]
    fn what_is_wrong_is_said_with_line_key_and_remedy() {
        let text = "scenarios = \"a.toml\"\nseed = { first = 0, count = 2 }\nmetrics = [\"turnz\"]\nseeds = { count = 0 }\n\
                    [grid]\nk_rep = 3\nx = { from = 2, to = 1 }\n[until]\nci95 = { metric = \"sucess\", below = \"a\" }\n";
        insta::assert_snapshot!(refused(text));
    }

    #[test]
    fn what_only_a_scenario_can_judge_is_shown_at_its_place() {
        let plan = Plan::parse(
            "scenarios = [\"a.toml\"]\nseeds = { count = 1 }\n[grid]\nk = [1]\n",
            "plan.toml",
            "plan",
        );
        let errors =
            plan.expect("nothing is wrong").refused(PlanKey::Grid(0), "planner rpf has no parameter `k`");
        assert!(
            errors.render().starts_with("error: plan.toml:4:5: grid.k = [1]: planner rpf has"),
            "{}",
            errors.render()
        );
    }
}
