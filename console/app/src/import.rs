//! `tankops import`: creates a scenario from a drawing or a list of columns.

use crate::{
    cli::ImportArgs,
    output::{check_free, write_file},
};
use ::import::{FloorPlan, ImportError, Input, InputKind, columns, drawing};
use flight::{
    failure::{COMPLETE, bad_input},
    planners::{self, COVERAGE_PLANNER},
};
use planner_host::PluginDirs;
use report::print::{say, say_line};
use scenario::{Scenario, ScenarioErrors, is_stdin};
use std::process::ExitCode;
use world::Boundary;

/// The number of bad rows that an error message lists.
const LISTED: usize = 10;

/// Runs `tankops import FILE -o SCENARIO`.
pub(crate) fn import(args: &ImportArgs, plugins: &PluginDirs) -> anyhow::Result<ExitCode> {
    let output = &args.output;
    for file in [Some(output), args.svg.as_ref()].into_iter().flatten() {
        check_free(file, Some(args.force), &[&args.file])?;
    }
    let input = Input::read(&args.file).map_err(|error| bad_input(error.to_string()))?;
    let plan = read(args, &input)?;
    let stem = output.file_stem().unwrap_or_default().to_string_lossy();
    let name = stem.replace(|c: char| !c.is_alphanumeric() && c != '_', "-");
    let source = args.file.file_name().unwrap_or_default().to_string_lossy();
    let source = if is_stdin(&args.file) { "standard input".into() } else { source };
    let found = planners::found(plugins);
    let planner = planners::suited_to_coverage(&found).map_or(COVERAGE_PLANNER, |info| &info.id);
    let text = plan.scenario(&name, &source, planner);
    // Do not write a scenario that the scenario reader would refuse.
    Scenario::parse(&text, &input.name).map_err(|errors| bad_input(no_scenario(&errors)))?;
    write_file("the scenario", output, &text)?;
    if let Some(file) = &args.svg {
        write_file("the drawing", file, &report::drawing::floor(&plan.world(), &plan.plates))?;
    }
    for note in &plan.notes {
        say_line(&format!("note: {note}"))?;
    }
    say(&format!("{}: {}, planner {planner}\n", output.display(), human(&plan)))?;
    Ok(ExitCode::from(COMPLETE))
}

fn read(args: &ImportArgs, input: &Input) -> anyhow::Result<FloorPlan> {
    match input.kind() {
        InputKind::List => {
            let radius_m = args.tank_radius.ok_or_else(|| {
                bad_input(
                    "a list of columns does not state the tank's size: add --tank-radius with the tank's inner \
                     radius in metres",
                )
            })?;
            columns::read(input, radius_m).map_err(|errors| bad_input(listed(&errors)))
        }
        InputKind::Scans => Err(bad_input(format!(
            "{}: a log of scans is not a drawing; make a map of it with `tankops map-of`",
            input.name
        ))),
        InputKind::Drawing => {
            let unit_m = args.units.map(Into::into);
            let layers = drawing::Layers::new(args.layer.clone());
            let assumed = drawing::Assumed { unit_m, pipe_width_m: args.pipe_width, layers };
            drawing::read(input, &assumed).map_err(|error| bad_input(error.to_string()))
        }
    }
}

/// Explains why a floor does not make a valid scenario. Line numbers are left out, because they refer to scenario text that is
/// never written to a file.
fn no_scenario(errors: &ScenarioErrors) -> String {
    let told = errors.problems.iter().take(LISTED).map(|problem| {
        let help = problem.what.help().map(|help| format!("; {help}")).unwrap_or_default();
        format!(
            "{}: nothing was written, because the floor does not make a valid scenario: {problem}{help}",
            errors.shown_name
        )
    });
    told.collect::<Vec<_>>().join("\n")
}

/// The problems of a file, line by line.
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
    let counted = |n: usize, what: &str| format!("{n} {what}{}", if n == 1 { "" } else { "s" });
    format!("{tank}, {}, {}{plates}", counted(obstacles, "obstacle"), counted(no_go, "no-go zone"))
}
