//! `tankops compare-surveys A B -o FILE`: two surveys of one floor, years apart.

use crate::{
    cli::CompareSurveysArgs,
    output::{check_free, write_file},
};
use account::Inspection;
use command::json::pretty_json;
use flight::{
    failure::{COMPLETE, bad_input},
    texts,
};
use recording::READINGS_FILE;
use report::{
    document::{Surveyed, TWO_SURVEYS_SUFFIXES, TwoSurveys, two_surveys_html, two_surveys_tables},
    print::{say_line, warn_line},
};
use runs::Past;
use std::{
    path::{Path, PathBuf},
    process::ExitCode,
};

/// Runs `tankops compare-surveys`.
pub(crate) fn compare(args: &CompareSurveysArgs) -> anyhow::Result<ExitCode> {
    let format = args.output.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    if !["html", "json", "csv"].contains(&format.as_str()) {
        return Err(bad_input(format!(
            "{}: unknown format of a comparison; use .html, .json or .csv",
            args.output.display()
        )));
    }
    let names = names(&args.output, &format);
    let inputs: Vec<&Path> = [&args.inspection_first, &args.inspection_second]
        .into_iter()
        .flatten()
        .map(PathBuf::as_path)
        .collect();
    for name in &names {
        check_free(name, Some(args.force), &inputs)?;
    }
    let runs = [args.first.clone(), args.second.clone()];
    let past = review::read_all(&runs, &args.logs.folder())?;
    let [first, second] = &past[..] else { return Err(bad_input("give two runs")) };
    refuse_doubts([first, second])?;
    for past in [first, second] {
        if let Some(why) = past.run.cut_off() {
            warn_line(&format!(
                "note: run {}: {why}; only floor that both surveys tested is compared",
                past.run.name
            ));
        }
    }
    let surveyed = [
        Surveyed { past: &first.run, inspection: inspection(first, args.inspection_first.as_deref())? },
        Surveyed { past: &second.run, inspection: inspection(second, args.inspection_second.as_deref())? },
    ];
    let comparison =
        TwoSurveys::new(&surveyed, args.minimum_mm, env!("CARGO_PKG_VERSION")).map_err(bad_input)?;
    for run in
        [&comparison.first, &comparison.second].into_iter().filter(|part| part.readings_sha256.is_none())
    {
        say_line(&format!(
            "note: {READINGS_FILE} of run {name} is missing; the comparison was computed from the journal; `tankops export \
             {name} --readings FILE` makes the file again",
            name = run.run
        ))?;
    }
    let texts: Vec<String> = match format.as_str() {
        "html" => vec![two_surveys_html(&comparison)],
        "json" => vec![pretty_json("the comparison", &comparison)?],
        _ => two_surveys_tables(&comparison).to_vec(),
    };
    for (name, text) in names.iter().zip(&texts) {
        write_file("the comparison", name, text)?;
        say_line(&name.display().to_string())?;
    }
    Ok(ExitCode::from(COMPLETE))
}

/// Refuses runs that were not closed, and runs with files that were changed: a comparison would lack losses that were
/// measured, or state losses that were not.
fn refuse_doubts(past: [&Past; 2]) -> anyhow::Result<()> {
    let open = past.into_iter().map(|past| &past.run).find(|run| {
        run.files.are_as_reported.is_none() && run.files.recovered.is_none() && run.files.doubts.is_empty()
    });
    if let Some(run) = open {
        return Err(bad_input(format!(
            "not compared: the report.json of run {name} is missing or states no digests, so readings could be missing \
             without a trace; `tankops recover {name} --by NAME` closes the run and names what is missing",
            name = run.name
        )));
    }
    let doubts = past.into_iter().flat_map(|past| {
        past.run.files.doubts.iter().map(move |doubt| format!("run {}: {doubt}", past.run.name))
    });
    let doubts: Vec<String> = doubts.collect();
    if doubts.is_empty() {
        return Ok(());
    }
    Err(bad_input(format!("not compared: {}; restore the original files", doubts.join("; "))))
}

/// The files of a comparison in a format.
fn names(output: &Path, format: &str) -> Vec<PathBuf> {
    if format != "csv" {
        return vec![output.to_owned()];
    }
    let stem = output.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    TWO_SURVEYS_SUFFIXES.iter().map(|suffix| output.with_file_name(format!("{stem}{suffix}.csv"))).collect()
}

/// The facts of the scenario of a run, overridden by those of a file.
fn inspection(past: &Past, file: Option<&Path>) -> anyhow::Result<Inspection> {
    let known = review::inspection(past)?;
    let Some(file) = file else { return Ok(known) };
    let later = scenario::inspection(&texts::read(file)?, &file.display().to_string());
    Ok(known.updated(later.map_err(|errors| bad_input(errors.render()))?))
}
