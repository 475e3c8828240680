//! `tankops tune`: better parameters, evaluated on layouts that were not used for tuning.

use crate::study_folder::StudyFolder;
use ::reproduce::{
    Parts, Runner,
    tune::{Tuned, Tuning},
};
use command::{arguments::TuneArgs, bar::shown, json::say_json};
use flight::{
    failure::{COMPLETE, bad_input},
    planners,
};
use indicatif::ProgressBar;
use mission::{ParamValue, Parameters};
use planner_host::{PluginDirs, check_parameters};
use report::print::say;
use std::process::ExitCode;
use toml_edit::Value;

/// The maximum number of parts for each set of values that is tried.
const MOST_PARTS: usize = 16;

/// `tankops tune`.
pub(crate) fn tune(args: &TuneArgs, plugins: &PluginDirs) -> anyhow::Result<ExitCode> {
    let found = planners::found(plugins);
    let planner = planners::choice_of(&args.planner, &found).map_err(bad_input)?;
    let start = start(&args.set).and_then(|start| check_parameters(planner, &start).map(|()| start));
    let start = start.map_err(bad_input)?;
    let tuning = Tuning {
        planner,
        start: &start,
        keys: &args.tune,
        on: &args.on,
        training: (args.layouts, args.first_seed),
        test: (args.test_layouts, args.test_first_seed),
        generations: args.generations,
        seed: args.seed,
    };
    let asked = || {
        serde_json::json!({
            "planner": args.planner,
            "start": start,
            "tune": args.tune,
            "on": args.on,
            "training": tuning.training,
            "test": tuning.test,
            "generations": args.generations,
            "seed": args.seed,
        })
    };
    let folder = args.out.as_ref().map(|out| StudyFolder::open(out, &asked(), plugins)).transpose()?;
    let parts = folder.as_ref().map(|folder| folder as &dyn Parts);
    let bar = if args.json { ProgressBar::hidden() } else { ProgressBar::new_spinner() };
    let bar = shown(bar, "tune", "{spinner} {prefix}  {elapsed}");
    let progress = |_: usize, _: usize| bar.tick();
    let tuned = Runner::new(plugins, args.threads, &progress)
        .and_then(|runner| tuning.search(&runner.with_parts(parts, MOST_PARTS)));
    bar.finish_and_clear();
    let tuned = tuned.map_err(bad_input)?;
    folder.map_or(Ok(()), |folder| folder.finish(&answer(args, &tuned)))?;
    if args.json {
        say_json("the result", &answer(args, &tuned))?;
    } else {
        say(&tuned.text(&tuning))?;
    }
    Ok(ExitCode::from(COMPLETE))
}

fn answer(args: &TuneArgs, tuned: &Tuned) -> serde_json::Value {
    let (before, after) = tuned.loss;
    serde_json::json!({
        "planner": args.planner,
        "on": args.on,
        "parameters": tuned.values,
        "training_loss": { "start": before, "tuned": after },
        "evaluations": tuned.evaluations,
        "rows": tuned.rows,
    })
}

/// The initial values.
fn start(set: &[String]) -> Result<Parameters, String> {
    let pair = |setting: &String| {
        let (key, written) = setting
            .split_once('=')
            .ok_or_else(|| format!("--set {setting}: must be KEY=VALUE, for example reading=gated"))?;
        Ok((key.trim().to_owned(), value(written.trim())))
    };
    set.iter().map(pair).collect()
}

/// A value that is not valid TOML is a word.
fn value(written: &str) -> ParamValue {
    match written.parse() {
        Ok(Value::Boolean(flag)) => ParamValue::Flag(flag.into_value()),
        Ok(Value::Integer(number)) => ParamValue::Int(number.into_value()),
        Ok(Value::Float(number)) if number.value().is_finite() => ParamValue::Float(number.into_value()),
        Ok(Value::String(word)) => ParamValue::Word(word.into_value()),
        _ => ParamValue::Word(written.to_owned()),
    }
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
