//! A second console that views the run of another console.

use crate::bench::Bench;
use std::{
    io::{BufRead, BufReader, Write},
    path::Path,
    process::{Child, Command, Stdio},
    sync::mpsc::{Receiver, channel},
    time::{Duration, Instant},
};

const PATIENCE: Duration = Duration::from_mins(5);

/// A console with `--plain`.
pub(crate) struct Console {
    child: Child,
    said: Receiver<String>,
}

impl Console {
    pub(crate) fn open(mut command: Command, arguments: &[&str]) -> Self {
        command.args(["console", "--plain"]).args(arguments);
        let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
        let lines = BufReader::new(child.stdout.take().unwrap()).lines();
        let (sender, said) = channel();
        std::thread::spawn(move || lines.map_while(Result::ok).all(|line| sender.send(line).is_ok()));
        Self { child, said }
    }

    pub(crate) fn order(&mut self, lines: &str) {
        self.child.stdin.as_mut().unwrap().write_all(lines.as_bytes()).unwrap();
    }

    /// Waits for a line with these words. The time limit is the same whether the console prints other lines or nothing.
    pub(crate) fn hear(&self, words: &str) {
        self.hear_all(&[words]);
    }

    /// Waits for lines with these words, in any order.
    pub(crate) fn hear_all(&self, words: &[&str]) {
        let mut left = words.to_vec();
        self.hear_until(|line| {
            left.retain(|words| !line.contains(words));
            left.is_empty().then_some(())
        })
        .unwrap_or_else(|heard| panic!("not all of {words:?} in {heard:#?}"));
    }

    /// Gives an order until it has been heard that it is carried out; each time it is refused for now, once more.
    pub(crate) fn order_until(&mut self, order: &str, done: &str, refused: &str) {
        loop {
            self.order(order);
            let is_done = self.hear_until(|line| {
                [(done, true), (refused, false)].into_iter().find(|(words, _)| line.contains(words))
            });
            let is_done = is_done.map(|(_, is_done)| is_done);
            if is_done.unwrap_or_else(|heard| panic!("neither {done:?} nor {refused:?} in {heard:#?}")) {
                return;
            }
            std::thread::sleep(Duration::from_millis(500));
        }
    }

    /// Hears lines until one is what is waited for; if none is, the lines.
    fn hear_until<T>(&self, mut is_it: impl FnMut(&str) -> Option<T>) -> Result<T, Vec<String>> {
        let mut heard = Vec::new();
        let until = Instant::now() + PATIENCE;
        while let Ok(line) = self.said.recv_timeout(until.saturating_duration_since(Instant::now())) {
            if let Some(found) = is_it(&line) {
                return Ok(found);
            }
            heard.push(line);
        }
        Err(heard)
    }

    /// The id of its process.
    pub(crate) fn pid(&self) -> u32 {
        self.child.id()
    }

    /// Closes its stdin: the console carries out the remaining commands and exits.
    pub(crate) fn close(&mut self) {
        drop(self.child.stdin.take());
    }

    pub(crate) fn leave(mut self) -> Option<i32> {
        self.close();
        self.child.wait().unwrap().code()
    }
}

fn view(bench: &Bench, run: &Path) -> Console {
    Console::open(bench.command(), &["--view", run.file_name().unwrap().to_str().unwrap()])
}

#[test]
fn an_onlooker_sees_a_run_under_way_and_its_end_and_cannot_stop_it() {
    let bench = Bench::new();
    let mut pilot = Console::open(bench.command(), &["--speed", "4"]);
    pilot.hear("Enter `start` to start");
    pilot.order("start\nyes\n");
    pilot.hear("Mission running");
    let run = bench.runs().remove(0);
    let mut onlooker = view(&bench, &run);
    onlooker.hear("Mission running");
    onlooker.order("hold\nend\n");
    onlooker.hear("VIEW only: give orders on the console");
    pilot.order("inject A dead 5s\n");
    onlooker.hear("fault injected: station A dead for 5 s");
    pilot.order("end\nyes\n");
    onlooker.hear("ended (aborted): ended by operator");
    onlooker.hear("Screen 7: Result.");
    assert_eq!(onlooker.leave(), Some(0));
    pilot.leave();
    bench.prove(&run);
    let past = view(&bench, &run);
    past.hear("Screen 7: Result.");
    past.leave();
}

#[test]
fn an_onlooker_is_informed_that_the_console_of_the_run_was_killed() {
    let bench = Bench::new();
    let mut pilot = Console::open(bench.command(), &["--speed", "4"]);
    pilot.hear("Enter `start` to start");
    pilot.order("start\nyes\n");
    pilot.hear("Mission running");
    let onlooker = view(&bench, &bench.runs().remove(0));
    onlooker.hear("Mission running");
    pilot.child.kill().unwrap();
    onlooker.hear("CONSOLE LOST: the run was not closed");
    onlooker.leave();
}

#[test]
fn a_run_that_is_not_there_cannot_be_looked_at_and_a_view_takes_no_script() {
    let bench = Bench::new();
    for (arguments, words) in [
        (&["console", "--plain", "--view", "nothing"][..], "no run"),
        (&["console", "--view", "nothing", "--script", "file"], "cannot be used with"),
    ] {
        let ended = bench.tankops(arguments);
        assert!(ended.code == Some(2) && ended.err.contains(words), "{ended:?}");
    }
}
