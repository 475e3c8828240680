use super::*;
use tui::{Key, model::console::Bell};

fn said(read: Read, name: &str, text: &str) -> (Config, Vec<String>) {
    let mut config = Config::default();
    let faults = read(&mut config, text);
    let lines = faults.iter().map(|fault| fault.text(Place { name, text })).collect();
    (config, lines)
}

fn keys_of(config: &Config, name: &str) -> Vec<Key> {
    let action = tui::actions::ACTIONS.iter().find(|action| action.name == name).expect("an action");
    config.keys.of(action).to_vec()
}

#[test]
fn the_files_of_the_guide_are_taken() {
    let (config, lines) = said(
        settings::read,
        SETTINGS,
        r#"
operator = "lk"
[screen]
theme = "light"
colours = "256"
mouse = true
[start]
scenarios = ["scenarios", "/srv/tanks"]
speed = 4.0
[alarms]
bell = "warn"
shelve_max_min = 30
"#,
    );
    assert_eq!(lines, [""; 0]);
    let preferences = Preferences {
        operator: Some("lk".into()),
        mouse: true,
        bell: Bell(Some(Severity::Warn)),
        shelve_max_min: 30,
        slows_for_offers: true,
    };
    let expected = Config {
        theme: Some(ThemeName::Light),
        colours: Some(Colours::Indexed),
        scenarios: vec!["scenarios".into(), "/srv/tanks".into()],
        speed: Speed::Times(4.0),
        preferences,
        ..Config::default()
    };
    assert_eq!(config, expected);
    let (config, lines) = said(
        keys::read,
        KEYS,
        "preset = \"arrows\"\n[keys]\nhold = [\"F12\"]\nzoom-in = [\"x\"]\nfollow = []\n[alias]\nnight = \"theme dark\"\n",
    );
    assert_eq!(lines, [""; 0]);
    assert_eq!(keys_of(&config, "hold"), [Key::Char(' '), Key::F(12)]);
    assert_eq!(keys_of(&config, "zoom-in"), [Key::Char('x')]);
    assert_eq!(keys_of(&config, "follow"), []);
    assert_eq!(keys_of(&config, "pan-west"), [Key::Left]);
    assert_eq!(config.keys.aliases.get("night").map(String::as_str), Some("theme dark"));
}

#[test]
fn a_faulty_setting_names_its_place_and_leaves_its_default() {
    let cases = [
        ("[screen\ntheme = 1", "config.toml:1:8: invalid TOML: "),
        (
            "oprator = \"lk\"",
            "config.toml:1:1: unknown key \"oprator\"; did you mean operator?; the line is ignored",
        ),
        (
            "[screen]\nthem = \"dark\"",
            "config.toml:2:1: unknown key \"them\"; did you mean theme?; the line is ignored",
        ),
        (
            "[screen]\ntheme = \"pink\"",
            "config.toml:2:9: theme must be auto, dark, light or contrast; the line is ignored",
        ),
        ("[screen]\nmouse = 1", "config.toml:2:9: mouse must be true or false; the line is ignored"),
        ("[start]\nspeed = 90", "config.toml:2:9: speed must be 0.25 to 64, or max; the line is ignored"),
        (
            "[start]\nscenarios = \"x\"",
            "config.toml:2:13: scenarios must be a list of folders; the line is ignored",
        ),
        (
            "[alarms]\nbell = \"info\"",
            "config.toml:2:8: bell must be crit, warn, watch or none; the line is ignored",
        ),
        (
            "[alarms]\nshelve_max_min = 0",
            "config.toml:2:18: shelve_max_min must be 1 to 1440 minutes; the line is ignored",
        ),
        ("screen = 3", "config.toml:1:10: screen must be a section; the line is ignored"),
    ];
    for (text, line) in cases {
        let (config, lines) = said(settings::read, SETTINGS, text);
        assert!(matches!(lines.as_slice(), [one] if one.starts_with(line)), "{lines:?}");
        assert_eq!(config, Config::default(), "{text}");
    }
    let (config, lines) = said(settings::read, SETTINGS, "[screen]\ntheme = \"pink\"\ncolours = \"16\"\n");
    assert_eq!((lines.len(), config.colours), (1, Some(Colours::Sixteen)), "the other lines count");
}

#[test]
fn a_faulty_binding_names_both_places_and_keeps_the_key() {
    let ignored = "the line is ignored";
    let cases = [
        (
            "preset = \"default\"\n\n[keys]\nhold = [\"F12\"]\nzoom-in = [\"f\"]\n",
            "keys.toml:5:12: \"f\" is already follow (Plan, Mission, Replay, Result); zoom-in keeps \"z\"".to_owned(),
        ),
        (
            "[keys]\nzoom-in = [\"F5\"]\nzoom-out = [\"F6\", \"F5\"]\n",
            "keys.toml:3:19: \"F5\" is already zoom-in (Plan, Mission, Replay, Result), keys.toml:2:1; zoom-out keeps \"Z\""
                .to_owned(),
        ),
        ("[keys]\nzoomin = [\"f\"]\n", "keys.toml:2:1: unknown action \"zoomin\"; did you mean zoom-in?".to_owned()),
        (
            "[keys]\nzoom-in = \"f\"\n",
            format!("keys.toml:2:11: keys must be a list, such as [\"f\", \"F5\"]; {ignored}"),
        ),
        (
            "[keys]\nzoom-in = [\"F55\"]\n",
            format!("keys.toml:2:12: unknown key \"F55\"; write a character, space, enter, up, F5 or Ctrl-L; {ignored}"),
        ),
        (
            "[keys]\nstart = [\"s\"]\n",
            "keys.toml:2:10: \"s\" is too easy to press by accident for an action that moves the robot; use a capital letter, F key or \
             Ctrl; start keeps \"S\""
                .to_owned(),
        ),
        ("[keys]\nredraw = [\"Ctrl-B\"]\n", "keys.toml:2:11: \"Ctrl-B\" may never reach tankops: tmux intercepts it".to_owned()),
        ("preset = \"emacs\"\n", format!("keys.toml:1:10: preset must be default, arrows or vim; {ignored}")),
        ("[alias]\nnight = \"them dark\"\n", format!("keys.toml:2:9: unknown command \"them\"; did you mean theme?; {ignored}")),
        ("[alias]\nhold = \"theme dark\"\n", format!("keys.toml:2:8: \"hold\" is already the command hold; {ignored}")),
    ];
    for (text, line) in cases {
        assert_eq!(said(keys::read, KEYS, text).1, [line], "{text}");
    }
}

#[test]
fn a_folder_without_files_is_the_default() {
    let mut config = Config::default();
    assert_eq!(config.take(Path::new("/nonexistent/keys.toml"), keys::read), []);
    assert_eq!(config, Config::default());
}
