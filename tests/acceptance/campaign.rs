//! Campaigns: the table is the same, whichever worker runs which part, and however often workers are killed.

use crate::bench::{Bench, Ended, scenario};
use std::{
    os::unix::fs::PermissionsExt,
    path::{Path, PathBuf},
    process::Stdio,
    time::Duration,
};

/// Two scenarios, two planners, two values, some seeds: about 0.1 s per mission.
pub(crate) fn plan(bench: &Bench, name: &str, head: &str, seeds: u32) -> PathBuf {
    let of = |name: &str| format!("\"{}\"", scenario(name).display());
    let scenarios = [of("goto-single-obstacle.toml"), of("papers/yang-case3.toml")].join(", ");
    let text = format!(
        "name = \"mixed\"\nscenarios = [{scenarios}]\nplanners = [\"apf\", \"navfn\"]\n\
         metrics = [\"mission_time_s\", \"clearance_min_m\"]\nseeds = {{ first = 3, count = {seeds} }}\n{head}\n\
         [grid]\n\"robot.speed_max_m_per_s\" = [0.25, 0.3]\n[expect]\ncollisions_max = 0\n"
    );
    bench.file(name, text)
}

/// Runs `tankops campaign` with words and paths.
pub(crate) fn campaign(bench: &Bench, words: &str, paths: &[&Path]) -> Ended {
    let mut command = bench.command();
    command.arg("campaign").args(words.split_whitespace()).args(paths);
    Ended::from(command.output().unwrap())
}

/// Merges a campaign and returns the bytes of its table.
pub(crate) fn table(bench: &Bench, folder: &str) -> Vec<u8> {
    let merged = campaign(bench, "merge", &[Path::new(folder)]);
    assert_eq!(merged.code, Some(0), "{merged:?}");
    std::fs::read(bench.path().join(folder).join("results.parquet")).unwrap()
}

fn works(bench: &Bench, words: &str, folder: &str) {
    let worked = campaign(bench, &format!("work {words}"), &[Path::new(folder)]);
    assert_eq!(worked.code, Some(0), "{words}: {worked:?}");
}

#[test]
fn the_table_does_not_depend_on_who_flew_what() {
    let bench = Bench::new();
    let (one, other) =
        (plan(&bench, "one.toml", "block = 5", 4), plan(&bench, "other.toml", "block = 13", 4));
    let ran = campaign(&bench, "run --out local --jobs 2", &[&one]);
    assert_eq!(ran.code, Some(0), "{ran:?}");
    assert!(ran.out.contains("mixed: 32 of 32 missions") && ran.out.contains("± "), "{}", ran.out);
    let expected = table(&bench, "local");

    campaign(&bench, "prepare --out two", &[&other]);
    for shard in ["1/2", "0/2"] {
        works(&bench, &format!("--threads 1 --shard {shard}"), "two");
    }
    assert!(table(&bench, "two") == expected, "two shards and another block size");

    campaign(&bench, "prepare --out three", &[&one]);
    let status = campaign(&bench, "status", &[Path::new("three")]);
    assert!(status.code == Some(1) && status.out.contains("missing: 0-6"), "{status:?}");
    let early = campaign(&bench, "merge", &[Path::new("three")]);
    assert!(early.code == Some(2) && early.err.contains("--partial"), "{early:?}");
    for shard in ["2/3", "0/3", "1/3"] {
        works(&bench, &format!("--shard {shard}"), "three");
    }
    assert_eq!(campaign(&bench, "status", &[Path::new("three")]).code, Some(0));
    assert!(table(&bench, "three") == expected, "three shards");

    let compared =
        campaign(&bench, "compare --by planner --metric mission_time_s", &["local", "two"].map(Path::new));
    assert!(compared.code == Some(0) && compared.out.matches("equal").count() == 2, "{compared:?}");
    let page = std::fs::read_to_string(bench.path().join("two/summary.html")).unwrap();
    assert!(
        page.contains("Paired differences") && page.contains("Nothing: every mission succeeded"),
        "{page}"
    );
}

#[test]
fn whoever_is_killed_loses_only_the_blocks_that_were_open() {
    let bench = Bench::new();
    let plan = plan(&bench, "plan.toml", "block = 4", 8);
    assert_eq!(campaign(&bench, "run --out quiet", &[&plan]).code, Some(0));
    let spawn = |words: &str, path: &Path| {
        let mut command = bench.command();
        command.arg("campaign").args(words.split_whitespace()).arg(path);
        command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap()
    };
    for wait_ms in [300, 900, 1400] {
        let mut run = spawn("run --out killed", &plan);
        std::thread::sleep(Duration::from_millis(wait_ms));
        run.kill().unwrap();
        run.wait().unwrap();
    }
    let resumed = campaign(&bench, "run --out killed", &[&plan]);
    assert_eq!(resumed.code, Some(0), "{resumed:?}");
    assert!(table(&bench, "killed") == table(&bench, "quiet"), "killed and run again");

    campaign(&bench, "prepare --out pulled", &[&plan]);
    let mut killed = spawn("work --pull --threads 1", Path::new("pulled"));
    let mut other = spawn("work --pull --threads 1", Path::new("pulled"));
    std::thread::sleep(Duration::from_millis(700));
    killed.kill().unwrap();
    killed.wait().unwrap();
    other.wait().unwrap();
    // The claim of the killed worker is void after ten minutes; a worker that is given a block number ignores claims.
    works(&bench, "--threads 2", "pulled");
    assert!(table(&bench, "pulled") == table(&bench, "quiet"), "pulled by two of which one was killed");
}

#[test]
fn a_campaign_ends_when_enough_is_known_or_the_budget_is_spent() {
    let bench = Bench::new();
    let until = "block = 3\n[until]\nci95 = { metric = \"mission_time_s\", below = 1e9 }\nseeds_min = 2";
    let (small, large) =
        (plan(&bench, "a.toml", until, 40), plan(&bench, "b.toml", &until.replace('3', "20"), 40));
    for (out, plan) in [("small", &small), ("large", &large)] {
        let ran = campaign(&bench, &format!("run --out {out}"), &[plan]);
        assert!(ran.code == Some(0) && ran.out.contains("16 of 320 missions"), "{ran:?}");
    }
    assert!(table(&bench, "small") == table(&bench, "large"), "the end does not depend on the blocks");
    let dear = plan(&bench, "c.toml", "block = 4", 4);
    let ran = campaign(&bench, "run --out dear --budget 0.00001ch", &[&dear]);
    assert!(ran.code == Some(1) && ran.err.contains("budget used up"), "{ran:?}");
    assert_eq!(campaign(&bench, "run --out dear", &[&dear]).code, Some(0));
}

#[test]
fn a_slip_in_a_plan_is_refused_with_its_place() {
    let bench = Bench::new();
    for (from, to, line, why) in [
        ("navfn", "navfm", ":3:20: planners.1", "there is no planner `navfm`"),
        ("yang-case3", "yang-case33", ":2:", "cannot be read"),
        ("speed_max_m_per_s", "speed_mix", ":8:21: grid.robot.speed_mix", "unknown key"),
        ("collisions_max", "colisions_max", ":9:", "expect"),
        ("count", "cuont", ":5:", "did you mean `count`?"),
    ] {
        let plan = plan(&bench, "plan.toml", "", 1);
        let text = std::fs::read_to_string(&plan).unwrap().replace(from, to);
        let refused = campaign(&bench, "prepare --out out", &[&bench.file("plan.toml", text)]);
        let says = refused.code == Some(2) && refused.err.contains(why) && refused.err.contains(line);
        assert!(says, "{to}: {refused:?}");
    }
    let plan = plan(&bench, "plan.toml", "", 1);
    assert_eq!(campaign(&bench, "prepare --out out", &[&plan]).code, Some(0));
    let text = std::fs::read_to_string(&plan).unwrap().replace("0.25", "0.2");
    let other = campaign(&bench, "run --out out", &[&bench.file("plan.toml", text)]);
    assert!(other.code == Some(2) && other.err.contains("contains a different campaign"), "{other:?}");
}

#[test]
fn a_mission_of_the_table_is_flown_again_by_its_command() {
    let bench = Bench::new();
    let plan = plan(&bench, "plan.toml", "", 1);
    let text = std::fs::read_to_string(&plan).unwrap();
    let plan = bench.file("plan.toml", text.replace("collisions_max = 0", "mission_time_max_s = 1.0"));
    assert_eq!(campaign(&bench, "run --out out", &[&plan]).code, Some(0));
    let summary = std::fs::read_to_string(bench.path().join("out/summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_str(&summary).unwrap();
    let worst = &summary["worst"][0];
    let words: Vec<&str> = worst["command"].as_str().unwrap().split_whitespace().skip(1).collect();
    let again = bench.tankops(&[&words[..], &["--json", "--no-record"]].concat()).json();
    let what = format!(
        "{}, mission_time_s {:.2}",
        again["outcome"].as_str().unwrap(),
        again["mission_time_s"].as_f64().unwrap()
    );
    assert!(worst["what"].as_str().unwrap().starts_with(&what), "{worst} but {what}");
}

/// A copy of the program that acts as a different build: different bytes, same behaviour.
fn other_build(bench: &Bench) -> PathBuf {
    let program = bench.path().join("tankops");
    let mut bytes = std::fs::read(env!("CARGO_BIN_EXE_tankops")).unwrap();
    bytes.push(0);
    std::fs::write(&program, bytes).unwrap();
    std::fs::set_permissions(&program, std::fs::Permissions::from_mode(0o755)).unwrap();
    program
}

#[test]
fn what_changes_between_prepare_and_work_changes_nothing_or_is_refused() {
    let bench = Bench::new();
    let text = std::fs::read_to_string(scenario("goto-single-obstacle.toml")).unwrap();
    let own = bench.file("own.toml", &text);
    let plan = bench.file("plan.toml", "scenarios = [\"own.toml\"]\nseeds = { count = 6 }\nblock = 2\n");
    assert_eq!(campaign(&bench, "run --out quiet", &[&plan]).code, Some(0));
    assert_eq!(campaign(&bench, "prepare --out out", &[&plan]).code, Some(0));
    std::fs::write(&own, text.replace("speed_max_m_per_s = ", "speed_max_m_per_s = 0.1 # ")).unwrap();
    works(&bench, "--block 1", "out");
    let other = campaign(&bench, "run --out out", &[&plan]);
    assert!(other.code == Some(2) && other.err.contains("contains a different campaign"), "{other:?}");
    works(&bench, "", "out");
    assert!(table(&bench, "out") == table(&bench, "quiet"), "the text of the scenario is frozen");

    let frozen = bench.path().join("out/campaign.json");
    let json = std::fs::read_to_string(&frozen).unwrap();
    let worked = |json: &str| {
        std::fs::write(&frozen, json).unwrap();
        let _ = std::fs::remove_file(bench.path().join("out/parts/part-00000.parquet"));
        campaign(&bench, "work", &[Path::new("out")])
    };
    let value: serde_json::Value = serde_json::from_str(&json).unwrap();
    let sha256 = value["program"]["tankops_sha256"].as_str().unwrap();
    for (changed, why) in [
        (json.replace(sha256, &"0".repeat(64)), "its SHA-256 does not match"),
        (json.replace("\"count\": 6", "\"count\": 0"), "was changed or damaged: there are no missions"),
        (json.replace("radius_m", "radius_n"), "does not match its SHA-256"),
        (json[..json.len() / 2].to_owned(), "is not a campaign"),
        (String::new(), "is not a campaign"),
    ] {
        let refused = worked(&changed);
        let is_named = refused.err.contains("campaign.json");
        assert!(refused.code == Some(2) && refused.err.contains(why) && is_named, "{why}: {refused:?}");
    }
    std::fs::write(&frozen, &json).unwrap();
    let mut other_build = bench.command_of(&other_build(&bench));
    let refused = Ended::from(other_build.args(["campaign", "work", "out"]).output().unwrap());
    let why = "tankops differs from the one that the campaign was prepared with";
    assert!(refused.code == Some(2) && refused.err.contains(why), "{refused:?}");
    works(&bench, "", "out");

    let part = bench.path().join("out/parts/part-00001.parquet");
    let whole = std::fs::read(&part).unwrap();
    std::fs::write(&part, &whole[..whole.len() - 9]).unwrap();
    let damaged = campaign(&bench, "merge", &[Path::new("out")]);
    let says = damaged.err.contains("part-00001.parquet") && damaged.err.contains("run block 1 again");
    assert!(damaged.code == Some(2) && says, "{damaged:?}");
    std::fs::remove_file(&part).unwrap();
    for pipe in [&part, &frozen] {
        let _ = std::fs::remove_file(pipe);
        assert!(std::process::Command::new("mkfifo").arg(pipe).status().unwrap().success());
        let refused = campaign(&bench, "merge", &[Path::new("out")]);
        assert!(refused.code.is_some_and(|code| code > 1) && refused.err.contains("not a regular file"));
    }
}

#[test]
fn a_worker_that_is_asked_to_stop_leaves_no_part_of_the_block_that_it_was_in() {
    let bench = Bench::new();
    let plan = plan(&bench, "plan.toml", "block = 1000", 8);
    assert_eq!(campaign(&bench, "run --out quiet", &[&plan]).code, Some(0));
    assert_eq!(campaign(&bench, "prepare --out out", &[&plan]).code, Some(0));
    let mut command = bench.command();
    command.args(["campaign", "work", "--pull", "--threads", "1", "out"]);
    let working = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let claim = bench.path().join("out/claims/00000");
    while !claim.exists() {
        std::thread::sleep(Duration::from_millis(5));
    }
    std::thread::sleep(Duration::from_millis(200));
    let pid = rustix::process::Pid::from_child(&working);
    rustix::process::kill_process(pid, rustix::process::Signal::TERM).unwrap();
    let stopped = Ended::from(working.wait_with_output().unwrap());
    assert!(stopped.code == Some(1) && stopped.err.contains("stopped; 1 block is missing"), "{stopped:?}");
    let left = |folder: &str| std::fs::read_dir(bench.path().join(folder)).unwrap().count();
    assert_eq!([left("out/parts"), left("out/cost"), left("out/claims")], [0; 3]);
    works(&bench, "--pull", "out");
    assert!(table(&bench, "out") == table(&bench, "quiet"), "stopped and flown again");
}

#[test]
fn a_part_that_was_damaged_or_is_empty_is_not_done_and_never_merges() {
    let bench = Bench::new();
    let plan = plan(&bench, "plan.toml", "block = 4", 2);
    assert_eq!(campaign(&bench, "run --out out", &[&plan]).code, Some(0));
    let expected = table(&bench, "out");
    let folder = bench.path().join("out/parts");
    let whole = std::fs::read(folder.join("part-00002.parquet")).unwrap();
    let mut flipped = whole.clone();
    flipped[whole.len() / 3] ^= 4;
    let other = std::fs::read(folder.join("part-00001.parquet")).unwrap();
    for bytes in [&[][..], &flipped, &whole[..whole.len() / 2], &other] {
        std::fs::write(folder.join("part-00002.parquet"), bytes).unwrap();
        let status = campaign(&bench, "status", &[Path::new("out")]);
        assert!(status.code == Some(1) && status.out.contains("missing: 2"), "{status:?}");
        assert!(
            status.err.contains("part-00002.parquet is ") || status.err.contains("comes from"),
            "{status:?}"
        );
        let merged = campaign(&bench, "merge", &[Path::new("out")]);
        assert!(merged.code == Some(2) && merged.err.contains("blocks are missing: 2"), "{merged:?}");
        works(&bench, "--pull --threads 1", "out");
        assert!(table(&bench, "out") == expected, "{} bytes", bytes.len());
    }
}

#[test]
fn damage_to_a_table_is_named_by_whoever_compares_it() {
    let bench = Bench::new();
    let plan = plan(&bench, "plan.toml", "", 1);
    assert_eq!(campaign(&bench, "run --out out", &[&plan]).code, Some(0));
    let mut bytes = std::fs::read(bench.path().join("out/results.parquet")).unwrap();
    let at = bytes.len() / 2;
    bytes[at] ^= 1;
    let damaged = bench.file("damaged.parquet", bytes);
    let compare =
        |file: &Path| campaign(&bench, "compare --metric mission_time_s", &[Path::new("out"), file]);
    let refused = compare(&damaged);
    assert!(refused.code == Some(2) && refused.err.contains("damaged.parquet is damaged"), "{refused:?}");
    let sound = compare(Path::new("out"));
    assert!(sound.code == Some(0) && sound.err.is_empty(), "{sound:?}");
}

#[test]
fn a_campaign_of_which_a_value_was_changed_is_refused() {
    let bench = Bench::new();
    let plan = plan(&bench, "plan.toml", "", 1);
    assert_eq!(campaign(&bench, "prepare --out out", &[&plan]).code, Some(0));
    let file = bench.path().join("out/campaign.json");
    let text = std::fs::read_to_string(&file).unwrap();
    let changed = text.replace("0.25", "0.24");
    assert_ne!(changed, text);
    std::fs::write(&file, changed).unwrap();
    let refused = campaign(&bench, "status", &[Path::new("out")]);
    assert!(refused.code == Some(2) && refused.err.contains("does not match its SHA-256"), "{refused:?}");
}
