//! `docs/keys.md`: every key and command, from the table of actions.

use tui::actions::{ACTIONS, Action, Kind, find, keymap::Keymap, keymap::PRESETS};

const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/keys.md");

const HEAD: &str = "\
# Keys and commands

<!-- Made from the rows in console/tui/src/actions/rows/. INSTA_UPDATE=always cargo test --release -p tui renews it. -->

The table gives the keys of the preset `default`; `keys.toml` changes them (see the operator guide). A *safe* command cannot make
the robot move. A command that *moves* the robot, or *ends* the mission, asks first. One that *asks* changes how the robot will move, but
does not make it move. Type a command after `:`, and its values after its name. Put a value with spaces in double quotes. Tab
completes names and values, and the up key recalls earlier lines.

## Commands

| command | keys | synonyms | what it does | risk |
|---|---|---|---|---|
";

fn cell(text: &str) -> String {
    if text.is_empty() { "–".into() } else { text.replace('|', "\\|") }
}

fn code(words: impl IntoIterator<Item = String>) -> String {
    words.into_iter().map(|word| format!("`{word}`")).collect::<Vec<_>>().join(" ")
}

fn keys(action: &Action) -> String {
    code(action.keys.iter().map(|key| key.name()))
}

fn about(action: &Action) -> String {
    Keymap::default().spelled(action.about)
}

fn command(action: &Action) -> String {
    let synonyms = code(action.synonyms.iter().map(|word| (*word).to_owned()));
    let cells = [keys(action), synonyms, about(action), action.risk.word().to_lowercase()];
    let cells = cells.map(|text| format!(" {} |", cell(&text)));
    format!("| `{}` |{}\n", action.usage(), cells.concat())
}

fn step(action: &Action) -> String {
    format!("| {} | {} | {} |\n", action.name, cell(&keys(action)), about(action))
}

fn kind(kind: Kind) -> &'static str {
    match kind {
        Kind::Speed => "0.25 to 64 times real time, or `max`",
        Kind::Planner => "id of an available planner",
        Kind::Parameter => "a parameter of the active planner and its value, such as `k_rep=2`",
        Kind::Scenario => "name of a scenario on the home screen",
        Kind::Run => "name of a past run, the beginning of a name if only one run has it, or `latest`",
        Kind::Layer => "a layer of the map, such as `robot-trail`",
        Kind::Place => "name of a station or an obstacle",
        Kind::Severity => "`info`, `watch`, `warn` or `crit`",
        Kind::Theme => "`dark`, `light` or `contrast`",
        Kind::Screen => "name of a screen",
        Kind::Preset => "name of a parameter preset",
        Kind::Duration => "a span of time: `20s`, `15m`, `1h30m`",
        Kind::Moment => "a moment of the run: `01:12:30`, `12:30` or `12m30s`",
        Kind::Alarm => "name of an alarm, as the list of alarms shows it",
        Kind::Station => "name of an AE station",
        Kind::Fault => {
            "`dead`: not heard; `offset=METRES`: ranges too long by METRES, more than 0 and at most 1000"
        }
        Kind::Corner => "x and y in metres: `-1.5,2`",
        Kind::Text => "any text",
    }
}

fn values() -> String {
    let mut args: Vec<_> = find::commands().flat_map(|action| action.args).collect();
    args.sort_by_key(|arg| arg.name);
    args.dedup();
    let mut rows: Vec<String> =
        args.iter().map(|arg| format!("| {} | {} |\n", arg.name.to_uppercase(), kind(arg.kind))).collect();
    rows.dedup();
    rows.concat()
}

fn preset((name, changes): (&str, &[(&str, &[tui::Key])])) -> String {
    let rows = changes.iter().map(|(action, keys)| {
        format!("| {name} | {action} | {} |\n", code(keys.iter().map(|key| key.name())))
    });
    rows.collect()
}

fn reference() -> String {
    let commands: String = find::commands().map(command).collect();
    let steps: String = ACTIONS.iter().filter(|action| !action.is_command()).map(step).collect();
    let presets: String = PRESETS.map(preset).concat();
    format!(
        "{HEAD}{commands}\n| value | what it is |\n|---|---|\n{}\n## In lists, text fields and questions\n\n\
         | action | keys | what it does |\n|---|---|---|\n{steps}\n\
         In a text field, letters and the space bar enter text. Left, right, home, end, Ctrl-left and Ctrl-right move the cursor;\n\
         Delete, Backspace, Ctrl-U and Ctrl-W delete text; Ctrl-C holds the robot.\n\n\
         ## Presets\n\n| preset | action | keys |\n|---|---|---|\n{presets}",
        values()
    )
}

#[test]
#[expect(clippy::disallowed_methods, reason = "the reference is a file")]
fn the_reference_of_keys_and_commands_is_current() {
    let current = reference();
    if std::env::var("INSTA_UPDATE").is_ok_and(|how| how == "always") {
        std::fs::write(FILE, &current).expect("the folder of documents");
    }
    assert_eq!(std::fs::read_to_string(FILE).unwrap_or_default(), current);
}
