//! The map of recorded scans.

use super::{counted, ros_files};
use crate::{
    cli::MapOfArgs,
    output::{check_free, write_file},
};
use ::import::{Input, InputKind, scan_log};
use flight::failure::bad_input;
use locate::scan_log::{Recorded, Shown, shown};
use report::print::{say, say_line};
use world::coverage::percent_text;

/// Writes the map of a log of scans, and its picture if one is requested.
pub(super) fn map_of_log(args: &MapOfArgs) -> anyhow::Result<()> {
    let refused = |what: &str| bad_input(format!("{}: {what}", args.run.display()));
    let image = args.output.with_extension("pgm");
    if let Some(picture) = args.svg.as_ref().filter(|picture| [&args.output, &image].contains(picture)) {
        let why = "the map or its image has this name; choose another name for the picture";
        return Err(bad_input(format!("{}: {why}", picture.display())));
    }
    check_free(&args.output, Some(args.force), &[&args.run])?;
    check_free(&image, Some(args.force), &[&args.run])?;
    if let Some(picture) = &args.svg {
        check_free(picture, Some(args.force), &[&args.run])?;
    }
    let input = Input::read(&args.run).map_err(|error| bad_input(error.to_string()))?;
    if input.kind() != InputKind::Scans {
        return Err(refused(
            "not a log of scans; make a scenario of a drawing or list with `tankops import`",
        ));
    }
    if !args.output.extension().is_some_and(|suffix| suffix == "yaml" || suffix == "yml") {
        let remedy = "a log has neither robot nor stations, so it gives only a map; end the name with .yaml";
        return Err(bad_input(format!("{}: {remedy}", args.output.display())));
    }
    let recorded = Recorded { sigma_m: args.sigma, range_m: args.range, hull_m: args.hull };
    let log = scan_log::read(&input, recorded.range_m).map_err(|error| bad_input(error.to_string()))?;
    let shown = shown(&log, &recorded).map_err(|error| refused(&error.to_string()))?;
    ros_files(args, &shown.map)?;
    if let Some(file) = &args.svg {
        let shapes = shown.found.iter().map(|found| (&found.shape, found.sigma_m));
        let picture = report::drawing::scanned(&shown.boundary, &shown.map, shapes, &shown.way);
        let picture = picture.ok_or_else(|| refused("the map could not be drawn"))?;
        write_file("the picture", file, &picture)?;
    }
    for note in &log.notes {
        say_line(&format!("note: {note}"))?;
    }
    Ok(say(&format!("{}: {}\n", args.output.display(), human(log.scans.len(), &shown)))?)
}

fn human(n_scans: usize, shown: &Shown) -> String {
    let gone = match shown.gone {
        0 => String::new(),
        n => format!(" that stayed, and {n} that did not"),
    };
    let unusable = match &shown.unusable {
        (n @ 1.., Some(reason)) => {
            format!("; {} could not be used, the first because {reason}", counted(*n, "scan"))
        }
        _ => String::new(),
    };
    format!(
        "{}, {} % of the rectangle seen, {}, {} on the map; the tracker found {}{gone}{unusable}",
        counted(n_scans, "scan"),
        percent_text(shown.map.explored, 1),
        counted(shown.map.columns.len(), "column"),
        counted(shown.map.others.len(), "other object"),
        counted(shown.found.len(), "obstacle"),
    )
}
