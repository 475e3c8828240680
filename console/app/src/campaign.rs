//! `tankops campaign`: many missions, on this machine or a cluster.

mod folder;
mod pilot;
mod prepare;
mod results;
mod slurm;
mod work;

use crate::{
    cli::{CampaignCommand, CompareArgs, Engine, OutArgs, RunCampaignArgs, WorkArgs},
    stop_signal::{self, StopSignal},
};
use ::campaign::{Campaign, Row, Status, compare};
use command::{bar::shown, here::Here, json::say_json};
use flight::failure::{COMPLETE, ENDED_OTHERWISE, bad_input};
use folder::Folder;
use indicatif::ProgressBar;
use planner_host::PluginDirs;
use prepare::freeze;
use report::print::{say, say_line, warn_line};
use std::{path::Path, process::ExitCode, thread::available_parallelism};
use work::Work;

/// Runs `tankops campaign`.
pub(crate) fn campaign(command: &CampaignCommand, plugins: &PluginDirs) -> anyhow::Result<ExitCode> {
    match command {
        CampaignCommand::Run(args) => run(args, plugins),
        CampaignCommand::Prepare(args) => {
            let (folder, campaign) = prepare(args, &Here::survey(plugins)?)?;
            say_line(&shape(&folder, &campaign))?;
            Ok(ExitCode::from(COMPLETE))
        }
        CampaignCommand::Work(args) => work(args, plugins),
        CampaignCommand::Status { dir } => status(&Folder::new(dir)),
        CampaignCommand::Merge { dir, partial } => merge(&Folder::new(dir), *partial),
        CampaignCommand::Compare(args) => compare_tables(args),
    }
}

fn prepare(args: &OutArgs, here: &Here) -> anyhow::Result<(Folder, Campaign)> {
    let campaign = freeze(&args.plan, here)?;
    let out = args.out.clone().unwrap_or_else(|| Path::new("campaigns").join(&campaign.design.name));
    let folder = Folder::new(&out);
    let campaign = folder.freeze(campaign)?;
    Ok((folder, campaign))
}

fn shape(folder: &Folder, campaign: &Campaign) -> String {
    let (cases, blocks) = (campaign.cases(), campaign.blocks());
    format!("missions: {cases}, blocks: {blocks}, folder: {}", folder.path().display())
}

fn run(args: &RunCampaignArgs, plugins: &PluginDirs) -> anyhow::Result<ExitCode> {
    let stop = stop_signal::listen();
    let here = Here::survey(plugins)?;
    let (folder, campaign) = prepare(&args.out, &here)?;
    warn_line(&shape(&folder, &campaign));
    let blocks = results::missing(&folder, &campaign)?;
    if args.engine == Engine::Slurm && !blocks.is_empty() {
        return submit(args, &folder, &campaign, &blocks, plugins);
    }
    let threads = threads(args.jobs);
    fly(
        &folder,
        &campaign,
        plugins,
        &here,
        &stop,
        Share { blocks, threads, pulls: false, budget_s: args.budget },
    )?;
    let left = results::missing(&folder, &campaign)?;
    if stop.requested() {
        return Ok(incomplete(&left, "stopped"));
    }
    let code = merge(&folder, !left.is_empty())?;
    Ok(if left.is_empty() { code } else { incomplete(&left, "budget used up") })
}

fn submit(
    args: &RunCampaignArgs,
    folder: &Folder,
    campaign: &Campaign,
    blocks: &[u64],
    plugins: &PluginDirs,
) -> anyhow::Result<ExitCode> {
    let script = slurm::script(folder, &campaign.design.name, blocks, plugins)?;
    if args.print {
        say_line(&format!("sbatch {}", script.display()))?;
    } else {
        let job = slurm::submit(&script)?;
        say_line(&format!(
            "submitted as job {job}; `tankops campaign status {}` shows the progress",
            folder.path().display()
        ))?;
    }
    Ok(ExitCode::from(COMPLETE))
}

fn incomplete(missing: &[u64], why: &str) -> ExitCode {
    let missing = match missing.len() {
        1 => "1 block is".to_owned(),
        n => format!("{n} blocks are"),
    };
    warn_line(&format!("{why}; {missing} missing; run the command again to resume"));
    ExitCode::from(ENDED_OTHERWISE)
}

/// The share of a campaign that one process runs.
struct Share {
    blocks: Vec<u64>,
    threads: usize,
    pulls: bool,
    budget_s: Option<f64>,
}

fn threads(wanted: usize) -> usize {
    if wanted > 0 { wanted } else { available_parallelism().map_or(1, usize::from) }
}

fn fly(
    folder: &Folder,
    campaign: &Campaign,
    plugins: &PluginDirs,
    here: &Here,
    stop: &StopSignal,
    share: Share,
) -> anyhow::Result<()> {
    let Share { blocks, threads, pulls, budget_s } = share;
    let left: u64 =
        blocks.iter().map(|block| campaign.block(*block)).map(|cases| cases.end - cases.start).sum();
    let bar = shown(
        ProgressBar::new(left),
        "campaign",
        "{prefix}  {wide_bar} {pos}/{len}  {elapsed}, {eta} left  {msg}",
    );
    let on_row = |row: &Row| {
        bar.inc(1);
        if row.status != Status::Flown {
            let why = row.error.as_deref().unwrap_or_default();
            bar.println(format!("{}: {why}\n  {}", row.word(), campaign.command(&campaign.case(row.case))));
        }
    };
    let (found, on_row) = (&here.found, &on_row);
    let flown =
        Work { campaign, folder, plugins, found, blocks, threads, pulls, budget_s, stop, on_row }.fly();
    bar.finish_and_clear();
    flown
}

fn work(args: &WorkArgs, plugins: &PluginDirs) -> anyhow::Result<ExitCode> {
    let stop = stop_signal::listen();
    let folder = Folder::new(&args.dir);
    let campaign = folder.campaign()?;
    let last = campaign.blocks() - 1;
    let blocks: Vec<u64> = match (args.block, args.shard) {
        (Some(block), _) if block > last => {
            return Err(bad_input(format!("--block {block}: out of range; the blocks are 0 to {last}")));
        }
        (Some(block), _) => vec![block],
        (None, Some((at, of))) => (at..=last).step_by(of as usize).collect(),
        (None, None) => (0..=last).collect(),
    };
    let (missing, damaged) = folder.missing(&campaign);
    for why in &damaged {
        warn_line(why);
    }
    let blocks: Vec<u64> = blocks.into_iter().filter(|block| missing.contains(block)).collect();
    if blocks.is_empty() {
        return Ok(ExitCode::from(COMPLETE));
    }
    let here = Here::survey(plugins)?;
    here.check(&campaign)?;
    let share =
        Share { blocks: blocks.clone(), threads: threads(args.threads), pulls: args.pull, budget_s: None };
    fly(&folder, &campaign, plugins, &here, &stop, share)?;
    let left: Vec<u64> = blocks.into_iter().filter(|block| !folder.has_part(&campaign, *block)).collect();
    match (left.is_empty(), stop.requested()) {
        (true, _) => Ok(ExitCode::from(COMPLETE)),
        (false, true) => Ok(incomplete(&left, "stopped")),
        (false, false) if results::missing(&folder, &campaign)?.is_empty() => Ok(ExitCode::from(COMPLETE)),
        (false, false) => Ok(incomplete(&left, "other workers are still running")),
    }
}

fn status(folder: &Folder) -> anyhow::Result<ExitCode> {
    let campaign = folder.campaign()?;
    let missing = results::missing(folder, &campaign)?;
    let (blocks, there) = (campaign.blocks(), campaign.blocks() - folder.missing(&campaign).0.len() as u64);
    let hours = folder.core_seconds() / 3600.0;
    say_line(&format!(
        "{there} of {blocks} blocks complete, {} missions in total; {hours:.3} core hours so far",
        campaign.cases()
    ))?;
    if missing.is_empty() {
        say_line("complete; run `tankops campaign merge` to combine the blocks")?;
        return Ok(ExitCode::from(COMPLETE));
    }
    say_line(&format!("missing: {}", results::list(&missing)))?;
    Ok(ExitCode::from(ENDED_OTHERWISE))
}

fn merge(folder: &Folder, partial: bool) -> anyhow::Result<ExitCode> {
    let results = results::merge(folder, &folder.campaign()?, partial)?;
    say(&results.findings.to_string())?;
    let out = folder.path().display();
    say_line(&format!("\n{out}/results.parquet  SHA-256 {}\n{out}/summary.html", results.sha256))?;
    Ok(ExitCode::from(COMPLETE))
}

fn compare_tables(args: &CompareArgs) -> anyhow::Result<ExitCode> {
    let (first, second) = (results::read(&args.first)?, results::read(&args.second)?);
    let comparison = compare(&first, &second, &args.metric, args.by.as_deref()).map_err(bad_input)?;
    if args.json {
        say_json("the comparison", &comparison)?;
    } else {
        say(&comparison.to_string())?;
    }
    Ok(ExitCode::from(COMPLETE))
}
