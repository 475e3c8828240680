//! `tankops map-of`: writes the map that a survey has made, or the map of recorded scans.

mod recorded;

use crate::{
    cli::MapOfArgs,
    output::{check_free, write_file},
};
use campaign::shell;
use exploration::SurveyMap;
use flight::{
    failure::{COMPLETE, bad_input, not_written},
    planners::{self, COVERAGE_PLANNER},
};
use planner_host::PluginDirs;
use report::print::{say, say_line};
use review::{PastSurvey, past_survey};
use runs::{find, write_whole};
use scenario::{Scenario, cover_of_map};
use std::{path::Path, process::ExitCode};
use world::coverage::percent_text;

/// Runs `tankops map-of RUN -o MAP`.
pub(crate) fn map_of(args: &MapOfArgs, plugins: &PluginDirs) -> anyhow::Result<ExitCode> {
    if args.run.is_file() {
        recorded::map_of_log(args)?;
        return Ok(ExitCode::from(COMPLETE));
    }
    let folder = find(&args.run, &args.logs.folder())?;
    let survey = past_survey(&folder)?;
    let run = folder.file_name().unwrap_or_default().to_string_lossy().into_owned();
    match args.output.extension().and_then(|suffix| suffix.to_str()) {
        Some("yaml" | "yml") => ros_map(args, &survey)?,
        Some("toml") => scenario(args, &survey, &run, plugins)?,
        _ => {
            let name = args.output.display();
            let remedy = "end the name with .yaml for a ROS map, or with .toml for a scenario";
            return Err(bad_input(format!("{name}: the format of the map is not clear; {remedy}")));
        }
    }
    Ok(ExitCode::from(COMPLETE))
}

fn ros_map(args: &MapOfArgs, survey: &PastSurvey) -> anyhow::Result<()> {
    ros_files(args, &survey.map)?;
    let image = args.output.with_extension("pgm");
    say(&format!("{} and {}: {}\n", args.output.display(), image.display(), human(survey)))?;
    Ok(())
}

/// Writes a map as the two files of the ROS map server.
fn ros_files(args: &MapOfArgs, map: &SurveyMap) -> anyhow::Result<()> {
    let image = args.output.with_extension("pgm");
    for file in [&args.output, &image] {
        check_free(file, Some(args.force), &[])?;
    }
    let name = image.file_name().unwrap_or_default().to_string_lossy();
    let Some(map) = map.ros(&name) else {
        return Err(bad_input("the map in the journal is damaged; run the survey again"));
    };
    write_whole(&image, &map.pgm).map_err(|error| not_written("the image of the map", &error, &image))?;
    write_file("the map", &args.output, &map.yaml)
}

fn scenario(args: &MapOfArgs, survey: &PastSurvey, run: &str, plugins: &PluginDirs) -> anyhow::Result<()> {
    let output = &args.output;
    check_free(output, Some(args.force), &[])?;
    let found = planners::found(plugins);
    let planner = planners::suited_to_coverage(&found).map_or(COVERAGE_PLANNER, |info| &info.id);
    let shown = output.display().to_string();
    let text = cover_of_map(&survey.opened, run, (&survey.map, &survey.numbers), planner)
        .map_err(|error| bad_input(format!("{run}: {error}")))?;
    // Do not write a scenario that the scenario reader would refuse.
    Scenario::parse(&text, &shown).map_err(|errors| {
        let remedy = "change these keys in the scenario of the survey, and survey again; or write the map with the \
                      suffix .yaml";
        bad_input(format!("{shown} was not written, because it would be refused:\n{}\n{remedy}", errors.render()))
    })?;
    write_file("the scenario", output, &text)?;
    say(&format!("{shown}: {}, planner {planner}\n", human(survey)))?;
    let quoted = |path: &Path| shell(&path.display().to_string());
    Ok(say_line(&format!(
        "plan it with `tankops plan {0}`, and run it with `tankops run {0}`",
        quoted(output)
    ))?)
}

fn human(survey: &PastSurvey) -> String {
    let map = &survey.map;
    format!(
        "{} % of the floor seen, {}, {}",
        percent_text(map.explored, 1),
        counted(map.columns.len(), "column"),
        counted(map.others.len(), "other object")
    )
}

fn counted(n: usize, what: &str) -> String {
    format!("{n} {what}{}", if n == 1 { "" } else { "s" })
}
