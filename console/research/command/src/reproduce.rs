//! `tankops reproduce`: the papers' tables, with our values beside the printed ones.

use crate::study_folder::StudyFolder;
use ::reproduce::{
    Gallery, Options, Parts, Runner,
    account::{PAPERS, Paper},
    csv, gallery, studies, study, table,
};
use command::{arguments::ReproduceArgs, bar::shown, json::say_json};
use flight::failure::{COMPLETE, bad_input};
use indicatif::ProgressBar;
use planner_host::PluginDirs;
use report::print::say;
use std::process::ExitCode;

/// Maximum number of parts of a list of cases: few enough files, but enough parts for many machines.
const MOST_PARTS: usize = 256;

/// `tankops reproduce`.
pub(crate) fn reproduce(args: &ReproduceArgs, plugins: &PluginDirs) -> anyhow::Result<ExitCode> {
    let Some(name) = args.name.as_ref().filter(|_| !args.list) else {
        list(args.json)?;
        return Ok(ExitCode::from(COMPLETE));
    };
    let study = study(name).map_err(bad_input)?;
    let options = Options {
        layouts: args.layouts,
        first_seed: args.first_seed,
        cases: args.case.clone(),
        methods: args.method.clone(),
    };
    let asked = || {
        serde_json::json!({
            "study": study.name,
            "layouts": args.layouts.unwrap_or(study.layouts),
            "first_seed": args.first_seed,
            "cases": args.case,
            "methods": args.method,
        })
    };
    let folder = args.out.as_ref().map(|out| StudyFolder::open(out, &asked(), plugins)).transpose()?;
    let parts = folder.as_ref().map(|folder| folder as &dyn Parts);
    let gallery = args.svg.as_ref().map(|folder| gallery(study, folder)).transpose().map_err(bad_input)?;
    let template = "{prefix}  {wide_bar} {pos}/{len}  {elapsed} of about {duration}";
    let bar = shown(ProgressBar::new(0), study.name, template);
    let progress = |done: usize, of: usize| {
        bar.set_length(of as u64);
        bar.set_position(done as u64);
    };
    let rows = Runner::new(plugins, args.threads, &progress)
        .map(|runner| runner.with_gallery(gallery.as_ref()).with_parts(parts, MOST_PARTS))
        .and_then(|runner| study.rows(&runner, &options));
    bar.finish_and_clear();
    let rows = rows.map_err(bad_input)?;
    gallery.map_or(Ok(()), Gallery::finish).map_err(bad_input)?;
    folder.map_or(Ok(()), |folder| folder.finish(&serde_json::to_value(&rows)?))?;
    if args.json {
        say_json("the rows", &rows)?;
    } else if args.csv {
        say(&csv(&rows))?;
    } else {
        say(&table(&rows))?;
    }
    Ok(ExitCode::from(COMPLETE))
}

fn list(json: bool) -> anyhow::Result<()> {
    if !json {
        return Ok(say(&::reproduce::list())?);
    }
    let studies = studies().map(
        |s| serde_json::json!({ "kind": "study", "name": s.name, "about": s.about, "layouts": s.layouts }),
    );
    let of_paper = |paper: &'static Paper| {
        paper.items.iter().map(|item| {
            serde_json::json!({
                "kind": "item",
                "paper": paper.name,
                "place": item.place,
                "what": item.what,
                "state": item.state.words(),
                "command": (!item.command.is_empty()).then_some(item.command),
                "why": item.why,
            })
        })
    };
    let all: Vec<serde_json::Value> = studies.chain(PAPERS.iter().flat_map(of_paper)).collect();
    say_json("the list", &all)
}
