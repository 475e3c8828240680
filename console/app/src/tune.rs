//! `tankops tune`: better parameters, evaluated on layouts that they were not tuned on.

use crate::{
    cli::TuneArgs,
    failure::{COMPLETE, bad_input},
    output::{say, say_line},
    planners, reproduce,
};
use ::reproduce::{
    Bench,
    spiral::Group,
    tune::{Tuned, Tuning, tune as search},
};
use anyhow::Context;
use mission::{ParamKind, ParamValue, Parameters, PlannerInfo};
use planner_host::{PluginDirs, check_parameters};
use std::process::ExitCode;
use toml_edit::Value;

/// Parameters of this group are tuned if none is named.
const GROUP: &str = "Field";

/// `tankops tune`.
pub(crate) fn tune(args: &TuneArgs, plugins: &PluginDirs) -> anyhow::Result<ExitCode> {
    let known = planners::found(plugins);
    let planner = planners::choice_of(&args.planner, &known).map_err(bad_input)?;
    let group = Group::named(&args.on).ok_or_else(|| bad_input(no_such_layouts(&args.on)))?;
    let start = start(&args.set).and_then(|start| check_parameters(planner, &start).map(|()| start));
    let start = start.map_err(bad_input)?;
    for (name, number) in
        [("layouts", args.layouts), ("test-layouts", args.test_layouts), ("generations", args.generations)]
    {
        if number == 0 {
            return Err(bad_input(format!("--{name} 0 tunes nothing; give at least 1")));
        }
    }
    let keys = if args.tune.is_empty() { keys_of_the_field(planner) } else { args.tune.clone() };
    let tuning = Tuning {
        planner,
        start: &start,
        keys: &keys,
        group,
        training: (args.layouts, args.first_seed),
        test: (args.test_layouts, args.test_first_seed),
        generations: args.generations,
        seed: args.seed,
    };
    let bar = reproduce::spinner("tune", args.json);
    let progress = |_: usize, _: usize| bar.tick();
    let tuned = Bench::new(plugins, args.threads, &progress).and_then(|bench| search(&tuning, &bench));
    let tuned = tuned.map_err(|problem| bad_input(problem.to_string()))?;
    bar.finish_and_clear();
    print_result(&tuned, args)?;
    Ok(ExitCode::from(COMPLETE))
}

fn no_such_layouts(name: &str) -> String {
    format!("there are no layouts `{name}`; there are wang-d1, wang-d2, wang-d3, and the same with -square")
}

fn keys_of_the_field(planner: &PlannerInfo) -> Vec<String> {
    let is_real = |kind: &ParamKind| matches!(kind, ParamKind::Float { .. });
    let of_field = planner.parameters.iter().filter(|info| info.group == GROUP && is_real(&info.kind));
    of_field.map(|info| info.key.clone()).collect()
}

/// The values to start from.
fn start(set: &[String]) -> Result<Parameters, String> {
    let pair = |setting: &String| {
        let (key, written) = setting
            .split_once('=')
            .ok_or_else(|| format!("--set {setting}: must be KEY=VALUE, for example reading=gated"))?;
        Ok((key.trim().to_owned(), value(written.trim())))
    };
    set.iter().map(pair).collect()
}

/// What is no TOML value is a word.
fn value(written: &str) -> ParamValue {
    match written.parse() {
        Ok(Value::Boolean(flag)) => ParamValue::Flag(flag.into_value()),
        Ok(Value::Integer(number)) => ParamValue::Int(number.into_value()),
        Ok(Value::Float(number)) => ParamValue::Float(number.into_value()),
        Ok(Value::String(word)) => ParamValue::Word(word.into_value()),
        _ => ParamValue::Word(written.to_owned()),
    }
}

fn print_result(tuned: &Tuned, args: &TuneArgs) -> anyhow::Result<()> {
    let (before, after) = tuned.loss;
    if args.json {
        let answer = serde_json::json!({
            "planner": args.planner,
            "on": args.on,
            "parameters": tuned.values,
            "training_loss": { "start": before, "tuned": after },
            "evaluations": tuned.evaluations,
            "rows": tuned.rows,
        });
        return say_line(&serde_json::to_string(&answer).context("writing the result as JSON")?);
    }
    let values: Vec<String> = tuned.values.iter().map(|(key, value)| format!("{key} = {value}")).collect();
    say(&format!(
        "Loss on {} training layouts (cross-track error in m, lost clearance, 1 for each that does not arrive): \
         {before:.4} at the start, {after:.4} tuned; {} sets of values tried.\n\n[planner.parameters]\n{}\n\n\
         On {} test layouts:\n\n{}",
        args.layouts,
        tuned.evaluations,
        values.join("\n"),
        args.test_layouts,
        reproduce::table(&tuned.rows),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_read_as_scenarios_have_them() {
        let set = ["k_att=2.5", "reading=gated", "flexible_step=true", "word = \"a b\""].map(String::from);
        let start = start(&set).expect("all are pairs");
        assert_eq!(start["k_att"], ParamValue::Float(2.5));
        assert_eq!(start["reading"], ParamValue::Word("gated".into()));
        assert_eq!(start["flexible_step"], ParamValue::Flag(true));
        assert_eq!(start["word"], ParamValue::Word("a b".into()));
    }

    #[test]
    fn a_setting_without_value_is_refused_with_an_example() {
        assert!(start(&["k_att".into()]).expect_err("no value").contains("reading=gated"));
    }
}
