//! The lines of the guide that run a campaign with a different engine, exactly as printed there.

use crate::{
    bench::{Bench, passed_over, workspace},
    campaign::{campaign, plan, table},
};
use std::{
    os::unix::fs::PermissionsExt,
    path::Path,
    process::{Command, Output},
};

/// The line of the campaign guide that begins with this text.
pub(crate) fn line_of_the_guide(beginning: &str) -> String {
    let guide = std::fs::read_to_string(workspace().join("console/docs/campaigns.md")).unwrap();
    let line = guide.lines().map(str::trim).find(|line| line.starts_with(beginning));
    line.unwrap_or_else(|| panic!("no line of the guide begins with `{beginning}`")).to_owned()
}

/// Puts the program under test on the path as `tankops`, and returns a command with that path.
pub(crate) fn with_tankops_on_the_path(bench: &Bench, program: &str) -> Command {
    let tankops = bench.command();
    let words = std::iter::once(tankops.get_program()).chain(tankops.get_args());
    let words: Vec<String> = words.map(|word| format!("'{}'", word.display())).collect();
    let bin = bench.path().join("bin");
    std::fs::create_dir_all(&bin).unwrap();
    std::fs::write(bin.join("tankops"), format!("#!/bin/sh\nexec {} \"$@\"\n", words.join(" "))).unwrap();
    std::fs::set_permissions(bin.join("tankops"), std::fs::Permissions::from_mode(0o755)).unwrap();
    let mut command = Command::new(program);
    let envs = tankops.get_envs().filter_map(|(name, value)| Some((name, value?)));
    command.current_dir(bench.path()).envs(envs);
    command.env("PATH", format!("{}:{}", bin.display(), std::env::var("PATH").unwrap()));
    command
}

fn shell(bench: &Bench, line: &str, environment: &[(&str, String)]) -> Output {
    let mut command = with_tankops_on_the_path(bench, "sh");
    command.args(["-c", line]).envs(environment.iter().cloned()).output().unwrap()
}

fn is_there(program: &str, says: &str) -> bool {
    let version = Command::new(program).arg("--version").output();
    version.is_ok_and(|version| String::from_utf8_lossy(&version.stdout).contains(says))
}

/// Prepares a campaign of seven blocks in `DIR`, and returns its expected table.
fn prepared(bench: &Bench) -> Vec<u8> {
    let plan = plan(bench, "plan.toml", "block = 5", 4);
    assert_eq!(campaign(bench, "run --out local", &[&plan]).code, Some(0));
    assert_eq!(campaign(bench, "prepare --out DIR", &[&plan]).code, Some(0));
    table(bench, "local")
}

#[test]
fn gnu_parallel_flies_a_campaign_by_the_line_of_the_guide() {
    if !is_there("parallel", "GNU parallel") {
        passed_over("GNU parallel is not installed");
        return;
    }
    let bench = Bench::new();
    let expected = prepared(&bench);
    let line = line_of_the_guide("seq 0 N | parallel").replace(" N ", " 6 ");
    let flown = shell(&bench, &line, &[("HOME", bench.path().display().to_string())]);
    assert!(flown.status.success(), "{line}: {flown:?}");
    assert!(table(&bench, "DIR") == expected, "by GNU parallel and here");
}

#[test]
fn every_pod_of_the_kubernetes_job_of_the_guide_flies_its_block() {
    let bench = Bench::new();
    let expected = prepared(&bench);
    let line = line_of_the_guide("command: [");
    let words: Vec<String> = serde_json::from_str(line.trim_start_matches("command: ")).unwrap();
    for index in (0..7).rev() {
        let mut pod = with_tankops_on_the_path(&bench, &words[0]);
        let ended = pod.args(&words[1..]).env("JOB_COMPLETION_INDEX", index.to_string()).output().unwrap();
        assert!(ended.status.success(), "{index}: {ended:?}");
    }
    assert_eq!(campaign(&bench, "status", &[Path::new("DIR")]).code, Some(0));
    assert!(table(&bench, "DIR") == expected, "by pods and here");
}

#[test]
fn hyperqueue_flies_a_campaign_by_the_line_of_the_guide() {
    if !is_there("hq", "hq") {
        passed_over("HyperQueue is not installed");
        return;
    }
    let bench = Bench::new();
    let expected = prepared(&bench);
    let server = [("HQ_SERVER_DIR", bench.path().join("hq").display().to_string())];
    let line = line_of_the_guide("hq submit").replace("0-N", "0-6").replace("hq submit", "hq submit --wait");
    let script = format!(
        "hq server start >server.log 2>&1 & server=$!\n\
         until hq server info >/dev/null 2>&1; do sleep 0.1; done\n\
         hq worker start --cpus 2 >worker.log 2>&1 & worker=$!\n\
         {line}; flown=$?\n\
         hq server stop; wait $server $worker; exit $flown"
    );
    let flown = shell(&bench, &script, &server);
    assert!(flown.status.success(), "{line}: {flown:?}");
    assert!(table(&bench, "DIR") == expected, "by HyperQueue and here");
}
