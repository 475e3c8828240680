//! `tankops reproduce`: the papers' tables, ours beside the printed values.

mod gallery;

use crate::{
    cli::ReproduceArgs,
    failure::{COMPLETE, bad_input},
    output::{say, say_line},
};
use ::reproduce::{Bench, Options, Picture, Problem, Row, STUDIES, Study};
use anyhow::Context;
use gallery::Gallery;
use indicatif::{ProgressBar, ProgressStyle};
use planner_host::PluginDirs;
use std::{fmt::Write, io::IsTerminal, process::ExitCode};

/// `tankops reproduce`.
pub(crate) fn reproduce(args: &ReproduceArgs, plugins: &PluginDirs) -> anyhow::Result<ExitCode> {
    let Some(name) = args.name.as_ref().filter(|_| !args.list) else {
        list(args.json)?;
        return Ok(ExitCode::from(COMPLETE));
    };
    let study = ::reproduce::study(name).ok_or_else(|| bad_input(unknown(name)))?;
    if args.layouts == Some(0) {
        return Err(bad_input("--layouts 0 measures nothing; give at least 1"));
    }
    let options = Options {
        layouts: args.layouts,
        first_seed: args.first_seed,
        cases: args.case.clone(),
        methods: args.method.clone(),
    };
    let gallery = args.svg.as_ref().map(|folder| Gallery::new(study, folder)).transpose()?;
    let show = |picture: &Picture<'_>| gallery.iter().for_each(|gallery| gallery.hang(picture));
    let bar = progress_bar(study.name);
    let progress = |done: usize, of: usize| {
        bar.set_length(of as u64);
        bar.set_position(done as u64);
    };
    let rows = Bench::new(plugins, args.threads, &progress)
        .and_then(|bench| {
            let bench = if gallery.is_some() { bench.with_gallery(&show) } else { bench };
            (study.run)(study, &bench, &options)
        })
        .map_err(|problem| explained(study, &problem));
    bar.finish_and_clear();
    let rows = rows?;
    gallery.map_or(Ok(()), Gallery::close)?;
    if args.json {
        say_line(&serde_json::to_string(&rows).context("writing the rows as JSON")?)?;
    } else {
        say(&table(&rows))?;
    }
    Ok(ExitCode::from(COMPLETE))
}

fn explained(study: &Study, problem: &Problem) -> anyhow::Error {
    match problem {
        Problem::Planner { .. } => bad_input(format!("{}: {problem}", study.name)),
        Problem::Nothing(why) => bad_input(why.clone()),
    }
}

fn studies() -> impl Iterator<Item = &'static Study> {
    STUDIES.iter().flat_map(|studies| studies.iter())
}

fn unknown(name: &str) -> String {
    let near = studies().map(|study| (strsim::jaro_winkler(name, study.name), study.name));
    let nearest = near.max_by(|a, b| a.0.total_cmp(&b.0)).filter(|(likeness, _)| *likeness > 0.8);
    let hint = nearest.map(|(_, known)| format!("; did you mean `{known}`?")).unwrap_or_default();
    format!("there is nothing named `{name}` to reproduce{hint}; `tankops reproduce --list` names everything")
}

fn list(json: bool) -> anyhow::Result<()> {
    if json {
        let all: Vec<serde_json::Value> = studies()
            .map(|s| serde_json::json!({ "name": s.name, "about": s.about, "layouts": s.layouts }))
            .collect();
        return say_line(&serde_json::to_string(&all).context("writing the list as JSON")?);
    }
    let width = studies().map(|study| study.name.len()).max().unwrap_or_default();
    let line = |study: &Study| format!("{:width$}  {} ({})\n", study.name, study.about, study.layouts);
    let lines: String = studies().map(line).collect();
    say(&format!("{lines}\nIn brackets: layouts or draws of each case unless --layouts says otherwise.\n"))
}

/// The bar is on stderr: rows on stdout, for people or as JSON, do not suffer from it.
fn progress_bar(name: &'static str) -> ProgressBar {
    if !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let style =
        ProgressStyle::with_template("{prefix}  {wide_bar} {pos}/{len}  {elapsed} of about {duration}");
    let bar = ProgressBar::new(0).with_prefix(name);
    bar.with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
}

/// Shows that work of unknown length is in progress.
pub(crate) fn spinner(name: &'static str, json: bool) -> ProgressBar {
    if json || !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let style = ProgressStyle::with_template("{spinner} {prefix}  {elapsed}");
    let bar = ProgressBar::new_spinner().with_prefix(name);
    bar.with_style(style.unwrap_or_else(|_| ProgressStyle::default_spinner()))
}

/// The rows for people: a block for each case and method, its notes below.
pub(crate) fn table(rows: &[Row]) -> String {
    let mut text = String::new();
    for block in rows.chunk_by(|a, b| (&a.case, &a.method) == (&b.case, &b.method)) {
        // Writing to a String cannot fail.
        let _ = writeln!(text, "{}  {}", block[0].case, block[0].method);
        let _ = writeln!(text, "  {:<32} {:>12} {:>12}  {:<8} {:>6}", "", "paper", "ours", "", "n");
        for row in block {
            let (paper, ours) = (number(row.paper), number(row.ours));
            let _ =
                writeln!(text, "  {:<32} {paper:>12} {ours:>12}  {:<8} {:>6}", row.metric, row.unit, row.n);
        }
        for note in notes(block) {
            let _ = writeln!(text, "  {note}");
        }
        text.push('\n');
    }
    text
}

/// Every note of a block once, with the metric it belongs to if it is not of all.
fn notes(block: &[Row]) -> Vec<String> {
    let mut notes: Vec<String> = Vec::new();
    for row in block.iter().filter(|row| !row.note.is_empty()) {
        let is_of_all = block.iter().all(|other| other.note == row.note);
        let note = if is_of_all { row.note.clone() } else { format!("{}: {}", row.metric, row.note) };
        let is_printed =
            block.iter().take_while(|other| !std::ptr::eq(*other, row)).any(|o| o.note == row.note);
        if !is_printed {
            notes.push(note);
        }
    }
    notes
}

fn number(value: Option<f64>) -> String {
    match value {
        None => "-".into(),
        Some(0.0) => "0".into(),
        Some(value) if value.abs() < 1e-3 => format!("{value:.2e}"),
        Some(value) => format!("{value:.4}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_misspelt_name_is_answered_with_the_nearest() {
        assert!(unknown("wang-tabel1").contains("did you mean `wang-table1`"));
        assert!(!unknown("zzz").contains("did you mean"));
    }

    #[test]
    fn rows_are_printed_in_blocks_with_their_notes_once() {
        let row = |metric: &str, ours| Row::new("t", "d1/disk", "rpf", metric, ours, "m").of(3);
        let rows = [
            row("rmse", Some(0.25)).printed(0.266).note("gated"),
            row("rmse_median", None).note("gated"),
            row("collisions", Some(0.0)).note("at 0.3 m"),
        ];
        insta::assert_snapshot!(table(&rows));
    }
}
