//! `tankops import`: a scenario from a drawing or a list of columns.

use crate::{
    cli::ImportArgs,
    output::{check_free, write_file},
};
use ::import::{FloorPlan, ImportError, columns, drawing};
use flight::failure::{COMPLETE, bad_input};
use report::print::{say, say_line};
use scenario::Scenario;
use std::process::ExitCode;
use world::Boundary;

/// Bad rows that an error lists.
const LISTED: usize = 10;

/// `tankops import FILE -o SCENARIO`.
pub(crate) fn import(args: &ImportArgs) -> anyhow::Result<ExitCode> {
    let output = &args.output;
    for file in [Some(output), args.svg.as_ref()].into_iter().flatten() {
        check_free(file, Some(args.force))?;
    }
    let plan = read(args)?;
    let stem = output.file_stem().unwrap_or_default().to_string_lossy();
    let source = args.file.file_name().unwrap_or_default().to_string_lossy();
    let text = plan.scenario(&stem.replace(|c: char| !c.is_alphanumeric() && c != '_', "-"), &source);
    // A scenario that its reader refuses helps nobody.
    Scenario::parse(&text, &output.display().to_string()).map_err(|errors| bad_input(errors.render()))?;
    write_file("the scenario", output, &text)?;
    if let Some(file) = &args.svg {
        write_file("the drawing", file, &report::drawing::floor(&plan.world(), &plan.plates))?;
    }
    for note in &plan.notes {
        say_line(&format!("note: {note}"))?;
    }
    say(&format!("{}: {}\n", output.display(), human(&plan)))?;
    Ok(ExitCode::from(COMPLETE))
}

fn read(args: &ImportArgs) -> anyhow::Result<FloorPlan> {
    let suffix = args.file.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    let read = |plan: Result<FloorPlan, ImportError>| plan.map_err(|error| bad_input(error.to_string()));
    match suffix.as_str() {
        "csv" => {
            let radius_m = args.tank_radius.ok_or_else(|| {
                bad_input("a list of columns does not state the tank: add --tank-radius with its inner radius in metres")
            })?;
            columns::read(&args.file, radius_m).map_err(|errors| bad_input(listed(&errors)))
        }
        "dxf" => {
            let unit_m = args.units.map(Into::into);
            let layers = drawing::Layers::new(args.layer.clone());
            read(drawing::read(
                &args.file,
                &drawing::Assumed { unit_m, pipe_width_m: args.pipe_width, layers },
            ))
        }
        _ => Err(bad_input(format!("{}: import reads .dxf and .csv files", args.file.display()))),
    }
}

/// What is wrong with a file, line by line.
fn listed(errors: &[ImportError]) -> String {
    let mut lines: Vec<String> = errors.iter().take(LISTED).map(ImportError::to_string).collect();
    let more = errors.len() - lines.len();
    lines.extend((more > 0).then(|| format!("and {more} more")));
    lines.join("\n")
}

fn human(plan: &FloorPlan) -> String {
    let tank = match &plan.boundary {
        Boundary::Circle { radius_m } => format!("round tank of {radius_m:.3} m radius"),
        Boundary::Polygon { vertices } => format!("tank with {} straight walls", vertices.len()),
    };
    let (obstacles, no_go) = (plan.obstacles.len(), plan.no_go.len());
    let plates = match plan.plates.len() {
        0 => String::new(),
        n => format!(", {n} plates"),
    };
    format!("{tank}, {obstacles} obstacles, {no_go} no-go areas{plates}")
}
