use super::*;
use clap::CommandFactory;

#[test]
fn the_command_line_is_consistent() {
    Cli::command().debug_assert();
}

#[test]
fn a_person_has_a_name_on_one_line() {
    assert_eq!(person(" L. O'Brien-Söns ").as_deref(), Ok("L. O'Brien-Söns"));
    for nobody in ["", " ", "a\nb", "a\tb", "\u{1b}[31mred", "\u{202e}name", "-"] {
        assert!(person(nobody).is_err(), "{nobody:?}");
    }
}

#[test]
fn the_help_of_every_command_is_as_reviewed() {
    let mut command = Cli::command().term_width(100);
    let mut help = vec![command.render_long_help().to_string()];
    gather(&mut command, "", &mut help);
    insta::assert_snapshot!(help.join("\n"));
}

/// The help texts of a command and of all its subcommands, in order.
fn gather(command: &mut clap::Command, above: &str, help: &mut Vec<String>) {
    for sub in command.get_subcommands_mut().filter(|sub| !sub.is_hide_set()) {
        let name = format!("{above}{}", sub.get_name());
        help.push(format!("===== {name}\n{}", sub.render_long_help()));
        gather(sub, &format!("{name} "), help);
    }
}
