//! The events of a run in progress, for other programs.

use crate::{
    bench::{Bench, Ended},
    killed::slow_scenario,
};
use std::{
    io::{BufRead, BufReader, Read},
    net::TcpStream,
    path::PathBuf,
    process::{Child, Command, Stdio},
    time::{Duration, Instant},
};

const PATIENCE: Duration = Duration::from_mins(5);

/// A run in progress, which is ended if the test fails.
struct Running {
    child: Child,
    folder: PathBuf,
}

impl Running {
    fn begin(bench: &Bench) -> Self {
        let slow = slow_scenario(bench);
        let mut command = bench.command();
        let child = command.arg("run").arg(slow).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
        let mut run = Self { child, folder: PathBuf::new() };
        let until = Instant::now() + PATIENCE;
        let begun = || bench.runs().pop().filter(|run| run.join("events.jsonl.zst").exists());
        while run.folder.as_os_str().is_empty() {
            assert!(Instant::now() < until, "the run never began");
            std::thread::sleep(Duration::from_millis(10));
            run.folder = begun().unwrap_or_default();
        }
        run
    }

    fn name(&self) -> &str {
        self.folder.to_str().unwrap()
    }

    fn signal(&self, name: &str) {
        assert!(Command::new("kill").arg(name).arg(self.child.id().to_string()).status().unwrap().success());
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// The events among the lines of a stream.
fn without_heartbeats(lines: &str) -> String {
    let events = lines.lines().filter(|line| !line.starts_with(r#"{"event":"heartbeat""#));
    events.map(|line| line.to_owned() + "\n").collect()
}

#[test]
fn a_followed_run_gives_the_lines_of_its_journal() {
    let bench = Bench::new();
    let mut run = Running::begin(&bench);
    let followed = bench.tankops(&["events", run.name(), "--follow", "--heartbeat", "0.1"]);
    assert!(run.child.wait().unwrap().success());
    let past = bench.tankops(&["events", run.name()]);
    assert_eq!((followed.code, followed.err.as_str()), (Some(0), ""));
    assert!(past.out.lines().count() > 1000);
    assert!(without_heartbeats(&followed.out) == past.out, "the lines differ");
}

#[test]
fn a_run_that_stands_still_gives_heartbeats() {
    let bench = Bench::new();
    let run = Running::begin(&bench);
    run.signal("-STOP");
    let mut command = bench.command();
    command.args(["events", run.name(), "--follow", "--heartbeat", "0.1", "--kind", "ended"]);
    let mut follower = command.stdout(Stdio::piped()).spawn().unwrap();
    let mut lines = BufReader::new(follower.stdout.take().unwrap()).lines();
    for _ in 0..3 {
        let line: serde_json::Value = serde_json::from_str(&lines.next().unwrap().unwrap()).unwrap();
        assert!(line["event"] == "heartbeat" && line["tick"].is_u64() && line["t_s"].is_f64(), "{line}");
    }
    run.signal("-CONT");
    let last = lines.map(Result::unwrap).last().unwrap();
    assert!(last.contains(r#""event":"ended""#), "{last}");
    assert!(follower.wait().unwrap().success());
}

#[test]
fn a_killed_run_ends_its_stream_with_the_reason() {
    let bench = Bench::new();
    let mut run = Running::begin(&bench);
    let mut command = bench.command();
    command.args(["events", run.name(), "--follow"]).stdout(Stdio::null()).stderr(Stdio::piped());
    let follower = command.spawn().unwrap();
    run.child.kill().unwrap();
    run.child.wait().unwrap();
    let followed = Ended::from(follower.wait_with_output().unwrap());
    assert!(followed.err.contains("journal"), "{followed:?}");
}

#[test]
fn each_client_of_a_socket_gets_the_whole_run() {
    let bench = Bench::new();
    let mut run = Running::begin(&bench);
    let mut command = bench.command();
    command.args(["events", run.name(), "--socket", "127.0.0.1:0"]).stdout(Stdio::piped());
    let mut server = command.spawn().unwrap();
    let mut said = String::new();
    BufReader::new(server.stdout.take().unwrap()).read_line(&mut said).unwrap();
    let at = said.trim().rsplit_once("tcp:").unwrap().1;
    // One client leaves early; this must not affect the others.
    let mut leaver = BufReader::new(TcpStream::connect(at).unwrap());
    leaver.read_line(&mut String::new()).unwrap();
    drop(leaver);
    let read = |at: &str| {
        let mut client = TcpStream::connect(at).unwrap();
        std::thread::spawn(move || {
            let mut lines = String::new();
            client.read_to_string(&mut lines).unwrap();
            lines
        })
    };
    let clients = [read(at), read(at)];
    assert!(run.child.wait().unwrap().success());
    assert!(server.wait().unwrap().success());
    let past = bench.tankops(&["events", run.name()]).out;
    for client in clients {
        assert!(without_heartbeats(&client.join().unwrap()) == past, "the lines differ");
    }
}

#[test]
fn a_socket_is_refused_on_the_network_and_for_a_run_that_has_ended() {
    let bench = Bench::new();
    let mut run = Running::begin(&bench);
    let network = bench.tankops(&["events", run.name(), "--socket", "0.0.0.0:0"]);
    assert!(network.code == Some(2) && network.err.contains("`--socket-network` allows this"), "{network:?}");
    let nowhere = bench.tankops(&["events", run.name(), "--socket", "4720"]);
    assert!(nowhere.code == Some(2) && nowhere.err.contains("--socket 4720"), "{nowhere:?}");
    run.child.wait().unwrap();
    let ended = bench.tankops(&["events", run.name(), "--socket", "127.0.0.1:0"]);
    assert!(ended.code == Some(2) && ended.err.contains("the run has ended"), "{ended:?}");
}
