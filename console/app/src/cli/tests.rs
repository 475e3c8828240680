use super::*;
use clap::CommandFactory;

#[test]
fn the_command_line_is_consistent() {
    Cli::command().debug_assert();
}

#[test]
fn the_help_of_every_command_is_as_reviewed() {
    let mut command = Cli::command().term_width(100);
    let mut help = vec![command.render_long_help().to_string()];
    for name in [
        "console",
        "run",
        "plan",
        "accuracy",
        "map",
        "import",
        "locate",
        "new-planner",
        "planners",
        "check",
        "reproduce",
        "tune",
        "runs",
        "verify",
        "events",
        "export",
        "report",
        "rescan",
        "replay-worker",
        "completions",
        "man",
    ] {
        let sub = command.find_subcommand_mut(name).expect("a command of ours");
        help.push(format!("===== {name}\n{}", sub.render_long_help()));
    }
    insta::assert_snapshot!(help.join("\n"));
}
