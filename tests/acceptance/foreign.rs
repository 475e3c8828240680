//! Foreign files and names: no file in a logs folder uses up memory, no hidden characters of a name reach a terminal
//! or a file, and no file is overwritten.

use crate::bench::{Bench, Ended, change_journal, journal_text, scenario};
use recording::JOURNAL_FILE;
use std::{
    ffi::OsStr,
    fs,
    io::{BufRead, BufReader, Write},
    os::unix::fs::symlink,
    path::{Path, PathBuf},
    process::{Command, Stdio},
};

/// A command run under limits set by the shell.
fn limited(bench: &Bench, limits: &str, arguments: &[&str]) -> Ended {
    let tankops = bench.command();
    let mut command = Command::new("sh");
    command
        .args(["-c", &format!("{limits}; exec \"$@\""), "sh"])
        .arg(tankops.get_program())
        .args(tankops.get_args());
    let envs = tankops.get_envs().filter_map(|(name, value)| Some((name, value?)));
    Ended::from(command.envs(envs).current_dir(bench.path()).args(arguments).output().unwrap())
}

fn flown(bench: &Bench) -> PathBuf {
    assert_eq!(bench.fly(&scenario("demo.toml"), &[]).code, Some(0));
    bench.runs().pop().unwrap()
}

/// A small compressed file that expands to gigabytes of zeros.
fn packed_zeros(head: &str) -> Vec<u8> {
    let mut packed = zstd::encode_all(head.as_bytes(), 1).unwrap();
    let zeros = zstd::encode_all(&vec![0; 64 << 20][..], 1).unwrap();
    (0..64).for_each(|_| packed.extend_from_slice(&zeros));
    packed
}

#[test]
fn no_command_runs_out_of_memory_by_what_is_in_a_logs_folder() {
    let bench = Bench::new();
    let run = flown(&bench);
    let (name, text) = (run.file_name().and_then(OsStr::to_str).unwrap().to_owned(), journal_text(&run));
    let head = text.split_inclusive('\n').next().unwrap();
    let spoils: [&dyn Fn(); 5] = [
        &|| fs::write(run.join(JOURNAL_FILE), packed_zeros("")).unwrap(),
        &|| fs::write(run.join(JOURNAL_FILE), packed_zeros(head)).unwrap(),
        &|| {
            let again = "{\"tick\":0,\"t_s\":0.0,\"event\":\"resumed\"}\n".repeat(100_000);
            let packed = zstd::encode_all((head.to_owned() + &again).as_bytes(), 1).unwrap();
            fs::write(run.join(JOURNAL_FILE), packed).unwrap();
        },
        &|| fs::write(run.join("report.json"), "[".to_owned() + &"[],".repeat(2_500_000) + "[]]").unwrap(),
        &|| fs::write(run.join("signed.json"), "[".to_owned() + &"[],".repeat(2_500_000) + "[]]").unwrap(),
    ];
    for (index, spoil) in spoils.iter().enumerate() {
        spoil();
        for command in
            [&["runs"][..], &["events", &name], &["report", &name], &["verify", "--from-journal", &name]]
        {
            let ended = limited(&bench, "ulimit -v 1100000", command);
            assert!(matches!(ended.code, Some(0..=2)), "{index}, {command:?}: {ended:?}");
            let is_damage_said =
                ["damaged", "no journal", "more values", "lines"].iter().any(|word| ended.err.contains(word));
            assert!(ended.code != Some(2) || is_damage_said, "{index}, {command:?}: {}", ended.err);
        }
    }
}

#[test]
fn pipes_and_devices_in_place_of_the_files_of_a_run_are_not_waited_for() {
    for file in ["run.lock", "report.json", JOURNAL_FILE, "notes.json", "signed.json", "recording-failed.txt"]
    {
        let bench = Bench::new();
        let run = flown(&bench);
        let place = run.join(file);
        let _ = fs::remove_file(&place);
        if file != "report.json" {
            fs::remove_file(run.join("report.json")).unwrap();
        }
        assert!(Command::new("mkfifo").arg(&place).status().unwrap().success());
        for _ in 0..2 {
            assert_eq!(bench.tankops(&["runs"]).code, Some(0), "{file}");
            let _ = bench.tankops(&["report", "latest"]);
            fs::remove_file(&place).unwrap();
            symlink("/dev/zero", &place).unwrap();
        }
    }
}

/// A name with all the characters that must not reach a terminal or a file.
const ODD: &str = "od\u{1b}]0;x\u{7}\u{9b}2J\u{202e}\u{2066}\u{61c}\u{ad}\u{e0041}d";

fn assert_plain(what: &str, bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes);
    let odd = text.chars().find(|c| !foreign::is_plain(*c) && !matches!(c, '\n' | '\t' | '\r'));
    let around = || {
        let at = odd.and_then(|odd| text.find(odd)).unwrap_or_default();
        String::from_utf8_lossy(&text.as_bytes()[at.saturating_sub(80)..text.len().min(at + 20)]).into_owned()
    };
    assert_eq!(odd, None, "{what}: {:?}", around());
}

#[test]
fn hidden_characters_in_names_reach_neither_the_terminal_nor_a_file() {
    let bench = Bench::new();
    let run = flown(&bench);
    let odd = serde_json::to_string(ODD).unwrap();
    let odd = odd.trim_matches('"');
    let text = journal_text(&run);
    let (head, rest) = text.split_once('\n').unwrap();
    let mut opened: serde_json::Value = serde_json::from_str(head).unwrap();
    for list in ["stations", "obstacles", "zones"] {
        for entry in opened["world"][list].as_array_mut().unwrap() {
            let name = format!("{}{ODD}", entry["name"].as_str().unwrap());
            entry["name"] = name.into();
        }
    }
    opened["scenario"] = format!("demo{ODD}").into();
    // Only this reason is free text; the others are fixed words of the format.
    let rest = rest.replace("\"reason\":\"task", &format!("\"reason\":\"{odd}task"));
    change_journal(&run, &format!("{opened}\n{rest}"));
    fs::remove_file(run.join("report.json")).unwrap();
    let moved = run.with_file_name(format!("20261125T100000Z-{ODD}-1"));
    fs::rename(&run, &moved).unwrap();
    let run = moved.to_str().unwrap();
    let out = bench.path().join("out");
    fs::create_dir(&out).unwrap();
    let file = |name: &str| out.join(name).to_str().unwrap().to_owned();
    let files: Vec<String> = ["r.html", "r.json", "r.csv", "r.geojson", "r.dxf"].map(file).to_vec();
    let mut commands: Vec<Vec<&str>> =
        vec![vec!["runs"], vec!["runs", "--json"], vec!["events", run], vec!["report", run]];
    commands.extend([vec!["report", run, "--json"], vec!["verify", run, "--from-journal"]]);
    commands.extend(files.iter().map(|file| vec!["report", run, "-o", file]));
    let (rescan, ranges) = (file("rescan.toml"), file("ranges.csv"));
    commands.extend([vec!["rescan", run, "-o", &rescan], vec!["export", run, "--ranges", &ranges]]);
    for command in &commands {
        let ended = bench.tankops(command);
        assert!(matches!(ended.code, Some(0..=2)), "{command:?}: {ended:?}");
        assert_plain(&format!("{command:?}"), ended.out.as_bytes());
        assert_plain(&format!("{command:?}"), ended.err.as_bytes());
    }
    let written: Vec<PathBuf> = fs::read_dir(&out).unwrap().map(|entry| entry.unwrap().path()).collect();
    assert!(written.len() >= 10, "{written:?}");
    for path in written {
        assert_plain(&path.display().to_string(), &fs::read(&path).unwrap());
    }
}

#[test]
fn hidden_characters_in_a_scenario_are_refused_with_line_and_key() {
    let bench = Bench::new();
    let text = fs::read_to_string(scenario("demo.toml")).unwrap();
    let spoiled = text.replacen("about = \"", "about = \"\\u202E", 1)
        + "\n[[zones]]\nname = \"a\u{ad}b\"\nkind = \"polygon\"\n";
    let file = bench.file("odd.toml", format!("# comments may: \u{202e}\n{spoiled}"));
    let ended = bench.tankops(&["check", file.to_str().unwrap()]);
    assert_eq!(ended.code, Some(2), "{ended:?}");
    let shown = ended.out + &ended.err;
    assert!(
        shown.contains("about")
            && shown.contains("text without control or invisible characters; contains U+202E"),
        "{shown}"
    );
    assert!(shown.contains("zones.0.name") && shown.contains("contains U+00AD"), "{shown}");
    assert_plain("the message", shown.as_bytes());
}

#[test]
fn nothing_is_written_over_without_being_asked_to_also_not_behind_a_link() {
    let bench = Bench::new();
    let tank = scenario("demo.toml");
    let tank = tank.to_str().unwrap();
    let precious = bench.file("precious", "precious");
    for (command, option, name) in
        [("plan", "--svg", "p.svg"), ("plan", "-o", "p.csv"), ("accuracy", "--svg", "a.svg")]
    {
        let link = bench.path().join(name);
        symlink(&precious, &link).unwrap();
        let refused = bench.tankops(&[command, tank, option, link.to_str().unwrap()]);
        assert!(
            refused.code == Some(2)
                && refused.err.contains("already exists; choose another name, or use --force"),
            "{refused:?}"
        );
        assert_eq!(fs::read(&precious).unwrap(), b"precious", "{command} {option}");
        fs::remove_file(&link).unwrap();
        bench.file(name, "old");
        let forced = bench.tankops(&[command, tank, option, link.to_str().unwrap(), "--force"]);
        assert!(forced.code != Some(2) && fs::read(&link).unwrap() != b"old", "{forced:?}");
    }
}

#[test]
fn limits_of_the_machine_are_named() {
    let bench = Bench::new();
    let tank = scenario("demo.toml");
    let run = ["run", tank.to_str().unwrap()];
    for (limit, said) in [
        ("ulimit -v 200000", "`ulimit -v"),
        ("ulimit -s 64", "`ulimit -s"),
        ("ulimit -n 201", "`ulimit -n 256`"),
        ("ulimit -f 100", "`ulimit -f"),
    ] {
        let ended = limited(&bench, limit, &run);
        assert!(ended.code == Some(3) && ended.err.contains(said), "{limit}: {ended:?}");
        assert!(bench.runs().is_empty(), "{limit}");
    }
}

#[test]
fn a_scenario_out_of_a_pipe_is_waited_for_and_the_user_is_told() {
    let bench = Bench::new();
    let pipe = bench.path().join("pipe.toml");
    assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    let mut command = bench.command();
    let mut waiting =
        command.arg("check").arg(&pipe).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let mut said = String::new();
    BufReader::new(waiting.stderr.as_mut().unwrap()).read_line(&mut said).unwrap();
    assert!(said.contains("note: waiting for data from the pipe") && said.contains("pipe.toml"), "{said}");
    write(&pipe, &fs::read(scenario("demo.toml")).unwrap());
    let ended = Ended::from(waiting.wait_with_output().unwrap());
    assert_eq!(ended.code, Some(0), "{ended:?}");
}

fn write(pipe: &Path, bytes: &[u8]) {
    let mut pipe = fs::OpenOptions::new().write(true).open(pipe).unwrap();
    pipe.write_all(bytes).unwrap();
}
