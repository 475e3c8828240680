//! A campaign on a real Slurm of one node, started for the test. If slurmctld is not installed, or the test does not
//! run as root, the test is skipped with a message.

use crate::{
    bench::{Bench, passed_over},
    campaign::{campaign, plan, table},
    engines::{line_of_the_guide, with_tankops_on_the_path},
};
use std::{
    fs,
    net::TcpListener,
    path::{Path, PathBuf},
    process::{Command, Output},
    time::{Duration, Instant},
};
use tempfile::TempDir;

/// Longer than any step here takes, even on a busy machine.
const LONG: Duration = Duration::from_mins(3);
const DAEMONS: [&str; 3] = ["slurmd", "slurmctld", "munged"];

/// Slurm and munge on loopback, without systemd; ended when dropped.
struct Slurm {
    folder: TempDir,
}

impl Slurm {
    /// `None` if Slurm is not installed.
    fn start() -> Option<Self> {
        let is_there =
            |program: &&str| Command::new("which").arg(program).output().is_ok_and(|o| o.status.success());
        if !DAEMONS.iter().all(is_there) || !rustix::process::getuid().is_root() {
            return None;
        }
        let slurm = Self { folder: tempfile::tempdir().unwrap() };
        let at = slurm.folder.path();
        for folder in ["run", "state", "spool", "log"] {
            fs::create_dir(at.join(folder)).unwrap();
        }
        open_to_all(at);
        let port = || TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port().to_string();
        let conf = include_str!("slurm/slurm.conf").replace("@DIR@", at.to_str().unwrap());
        let conf = conf.replace("@CTLD@", &port()).replace("@D@", &port());
        fs::write(slurm.conf(), conf).unwrap();
        slurm.munge();
        let conf = slurm.conf();
        let conf = conf.to_str().unwrap();
        slurm.succeeds("slurmctld", &["-c", "-f", conf]);
        slurm.succeeds("slurmd", &["-c", "-f", conf, "-N", "localhost"]);
        slurm.wait("the node", |slurm| text(&slurm.call("sinfo", &["-h", "-o", "%T"])).starts_with("idle"));
        Some(slurm)
    }

    fn munge(&self) {
        let at = |name: &str| self.folder.path().join(name).display().to_string();
        let key: Vec<u8> = (0..1024_u32).map(|n| (n * 7 % 251) as u8).collect();
        fs::write(at("munge.key"), key).unwrap();
        Command::new("chmod").args(["400", &at("munge.key")]).status().unwrap();
        let options = [
            format!("--key-file={}", at("munge.key")),
            format!("--socket={}", at("run/munge.sock")),
            format!("--pid-file={}", at("run/munged.pid")),
            format!("--log-file={}", at("log/munged.log")),
            format!("--seed-file={}", at("munge.seed")),
        ];
        let options: Vec<&str> = options.iter().map(String::as_str).collect();
        self.succeeds("munged", &[&["--force", "--num-threads=2"], &options[..]].concat());
    }

    fn conf(&self) -> PathBuf {
        self.folder.path().join("slurm.conf")
    }

    fn call(&self, program: &str, arguments: &[&str]) -> Output {
        Command::new(program).args(arguments).env("SLURM_CONF", self.conf()).output().unwrap()
    }

    fn succeeds(&self, program: &str, arguments: &[&str]) {
        let output = self.call(program, arguments);
        assert!(output.status.success(), "{program}: {output:?}");
    }

    fn wait(&self, what: &str, is_there: impl Fn(&Self) -> bool) {
        let began = Instant::now();
        while !is_there(self) {
            let queue = self.call("squeue", &["-r"]);
            assert!(began.elapsed() < LONG, "{what} does not come: {}", text(&queue));
            std::thread::sleep(Duration::from_millis(100));
        }
    }

    /// State of a task, such as PENDING; empty when the task has left the queue.
    fn state(&self, task: &str) -> String {
        text(&self.call("squeue", &["-h", "-r", "-j", task, "-o", "%T"])).trim().to_owned()
    }

    /// Waits until the queue is empty; requeued tasks would otherwise wait two minutes.
    fn drain(&self) {
        self.wait("the end of the array", |slurm| {
            for task in text(&slurm.call("squeue", &["-h", "-r", "-t", "PENDING", "-o", "%A"])).lines() {
                slurm.call("scontrol", &["update", &format!("JobId={task}"), "StartTime=now"]);
            }
            text(&slurm.call("squeue", &["-h", "-r"])).trim().is_empty()
        });
    }
}

impl Drop for Slurm {
    /// Ends the daemons by the process ids in their files, after checking that the ids are still theirs.
    fn drop(&mut self) {
        self.call("scancel", &["--me"]);
        for daemon in DAEMONS {
            let file = self.folder.path().join(format!("run/{daemon}.pid"));
            let pid = fs::read_to_string(file).ok().and_then(|pid| pid.trim().parse::<u32>().ok());
            let Some(pid) = pid.filter(|pid| *pid > 1) else { continue };
            let is_it =
                || fs::read_to_string(format!("/proc/{pid}/comm")).is_ok_and(|name| name.trim() == daemon);
            if is_it() {
                let _ = Command::new("kill").arg(pid.to_string()).status();
            }
            let began = Instant::now();
            while is_it() && began.elapsed() < Duration::from_secs(20) {
                std::thread::sleep(Duration::from_millis(100));
            }
        }
    }
}

/// munge requires a folder that everybody can enter.
fn open_to_all(folder: &Path) {
    for folder in ["", "run", "state", "spool", "log"].map(|name| folder.join(name)) {
        Command::new("chmod").arg("755").arg(folder).status().unwrap();
    }
}

fn text(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}

#[test]
fn an_array_with_a_task_requeued_and_a_task_killed_gives_the_same_table() {
    let Some(slurm) = Slurm::start() else {
        passed_over("slurmctld, slurmd and munged are not installed, or this is not root");
        return;
    };
    let bench = Bench::new();
    let plan = plan(&bench, "plan.toml", "block = 60", 30);
    assert_eq!(campaign(&bench, "run --out local", &[&plan]).code, Some(0));
    let submit = || {
        let mut command = bench.command();
        command.args(["campaign", "run", "--engine", "slurm", "--out", "slurm"]).arg(&plan);
        let output = command.env("SLURM_CONF", slurm.conf()).output().unwrap();
        assert!(output.status.success(), "{output:?}");
        let said = text(&output);
        let job = said.split_whitespace().nth(3).unwrap().trim_end_matches(';').to_owned();
        assert!(job.parse::<u32>().is_ok(), "{said}");
        job
    };
    let job = submit();
    let (requeued, killed) = (format!("{job}_0"), format!("{job}_1"));
    slurm.wait("the first task", |slurm| slurm.state(&requeued) == "RUNNING");
    slurm.succeeds("scontrol", &["requeue", &requeued]);
    slurm.wait("the second task", |slurm| slurm.state(&killed) == "RUNNING");
    slurm.succeeds("scancel", &["--signal=KILL", "--full", &killed]);
    slurm.drain();
    let status = campaign(&bench, "status", &[Path::new("slurm")]);
    assert!(status.code == Some(1) && status.out.contains("missing: 1\n"), "{status:?}");
    submit();
    slurm.drain();
    assert!(table(&bench, "slurm") == table(&bench, "local"), "by Slurm and here");
}

#[test]
fn a_study_is_shared_by_the_tasks_of_an_array_by_the_line_of_the_guide() {
    let Some(slurm) = Slurm::start() else {
        passed_over("slurmctld, slurmd and munged are not installed, or this is not root");
        return;
    };
    let bench = Bench::new();
    let asked = "trap-suite --layouts 3 --case u --method shortest";
    let line = line_of_the_guide("sbatch --array").replace("coverage-suite --layouts 1000", asked);
    let line = line.replace("0-7", "0-3");
    let mut submit = with_tankops_on_the_path(&bench, "sh");
    let submitted = submit.args(["-c", &line]).env("SLURM_CONF", slurm.conf()).output().unwrap();
    assert!(submitted.status.success(), "{line}: {submitted:?}");
    slurm.drain();
    let rows = |rows: serde_json::Value| -> Vec<serde_json::Value> {
        let all = rows.as_array().unwrap().iter();
        all.filter(|row| !row["metric"].as_str().unwrap().contains("time")).cloned().collect()
    };
    let alone: Vec<&str> = asked.split_whitespace().collect();
    let alone = bench.tankops(&[&["reproduce"], &alone[..], &["--json"]].concat()).json();
    let shared = fs::read(bench.path().join("DIR/result.json")).unwrap();
    assert_eq!(rows(serde_json::from_slice(&shared).unwrap()), rows(alone));
}
