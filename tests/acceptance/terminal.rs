//! The console in a pseudo terminal: what the operator sees, and that the terminal comes back as it was.

use crate::bench::{Bench, journal, scenario};
use portable_pty::{Child, CommandBuilder, MasterPty, PtySize, native_pty_system};
use std::{
    io::{Read, Write},
    path::{Path, PathBuf},
    sync::{
        Arc, Mutex,
        atomic::{AtomicBool, Ordering},
    },
    time::{Duration, Instant},
};

const PATIENCE: Duration = Duration::from_mins(1);

/// A shell in a pseudo terminal that notes `stty -a` before and after `tankops`.
struct Session {
    bench: Bench,
    screen: Arc<Mutex<vt100::Parser>>,
    keys: Box<dyn Write + Send>,
    child: Box<dyn Child + Send + Sync>,
    master: Option<Box<dyn MasterPty + Send>>,
    /// Whether the terminal has been closed: its reader then lets go of it, too.
    closed: Arc<AtomicBool>,
}

fn screen_of(width: u16, height: u16) -> vt100::Parser {
    let size = |count| std::num::NonZero::new(count).unwrap();
    vt100::Parser::new(size(height), size(width), 0)
}

impl Session {
    fn open(arguments: &str, width: u16, height: u16) -> Self {
        let bench = Bench::new();
        let size = PtySize { rows: height, cols: width, pixel_width: 0, pixel_height: 0 };
        let pair = native_pty_system().openpty(size).unwrap();
        let program = PathBuf::from(env!("CARGO_BIN_EXE_tankops"));
        let deps = program.parent().unwrap().join("deps");
        let script = format!(
            "stty -a > before; {} --plugin-dir {} {arguments}; echo \"code=$?\" > code; stty -a > after; echo SHELL-AGAIN",
            program.display(),
            deps.display()
        );
        let mut command = CommandBuilder::new("bash");
        command.args(["-c", &script]);
        command.cwd(bench.path());
        command.env("TERM", "xterm-256color");
        command.env("LANG", "C.UTF-8");
        command.env_remove("NO_COLOR");
        let child = pair.slave.spawn_command(command).unwrap();
        drop(pair.slave);
        let screen = Arc::new(Mutex::new(screen_of(width, height)));
        let mut output = pair.master.try_clone_reader().unwrap();
        let shown = Arc::clone(&screen);
        let closed = Arc::new(AtomicBool::new(false));
        let is_closed = Arc::clone(&closed);
        std::thread::spawn(move || {
            let mut bytes = [0; 8192];
            while let Ok(count) = output.read(&mut bytes) {
                if count == 0 || is_closed.load(Ordering::SeqCst) {
                    return;
                }
                shown.lock().unwrap().process(&bytes[..count]);
            }
        });
        let keys = pair.master.take_writer().unwrap();
        Self { bench, screen, keys, child, master: Some(pair.master), closed }
    }

    fn text(&self) -> String {
        self.screen.lock().unwrap().screen().contents()
    }

    /// Waits until the screen shows a word.
    fn see(&self, word: &str) {
        self.until(&format!("`{word}` on the screen"), |session| session.text().contains(word));
    }

    fn until(&self, what: &str, is_so: impl Fn(&Self) -> bool) {
        let until = Instant::now() + PATIENCE;
        while !is_so(self) {
            assert!(Instant::now() < until, "waited for {what} in vain; the screen shows:\n{}", self.text());
            std::thread::sleep(Duration::from_millis(20));
        }
    }

    fn press(&mut self, keys: &str) {
        self.keys.write_all(keys.as_bytes()).unwrap();
        self.keys.flush().unwrap();
    }

    /// Presses a key until the screen shows a word; on a busy machine the planners are still being looked for.
    fn press_until(&mut self, key: &str, word: &str) {
        let until = Instant::now() + PATIENCE;
        while !self.text().contains(word) && Instant::now() < until {
            self.press(key);
            std::thread::sleep(Duration::from_millis(500));
        }
        self.see(word);
    }

    /// Goes down an open list to an entry and takes it.
    fn choose(&mut self, entry: &str) {
        let chosen = format!(">{entry} ");
        for _ in 0..60 {
            if self.text().contains(&chosen) {
                break;
            }
            self.press("\x1b[B");
            std::thread::sleep(Duration::from_millis(100));
        }
        self.see(&chosen);
        self.press("\r");
    }

    /// Waits for the shell to be back; the terminal must be as it was. Gives the exit code.
    fn back_in_the_shell(&mut self) -> String {
        self.until("the shell", |session| {
            session.bench.path().join("after").exists() && session.text().contains("SHELL-AGAIN")
        });
        let read = |name: &str| std::fs::read_to_string(self.bench.path().join(name)).unwrap();
        assert_eq!(read("before"), read("after"));
        let parser = self.screen.lock().unwrap();
        assert!(!parser.screen().alternate_screen(), "the alternate screen was left on");
        assert!(!parser.screen().hide_cursor(), "the cursor was left hidden");
        assert!(!parser.screen().bracketed_paste(), "bracketed paste was left on");
        read("code").trim().to_owned()
    }

    /// Process id of the console, from its parent shell.
    fn console_pid(&self) -> i32 {
        let shell = self.child.process_id().unwrap();
        let children = std::fs::read_to_string(format!("/proc/{shell}/task/{shell}/children")).unwrap();
        children.split_whitespace().next().unwrap().parse().unwrap()
    }

    fn signal_console(&self, signal: rustix::process::Signal) {
        let pid = rustix::process::Pid::from_raw(self.console_pid()).unwrap();
        rustix::process::kill_process(pid, signal).unwrap();
    }

    fn run(&self) -> PathBuf {
        self.bench.runs().remove(0)
    }
}

fn goto() -> String {
    format!("console {}", scenario("goto-single-obstacle.toml").display())
}

fn kinds(run: &Path) -> Vec<String> {
    journal(run).iter().map(|event| event["event"].as_str().unwrap_or_default().to_owned()).collect()
}

#[test]
fn a_mission_is_flown_held_swapped_and_finished_by_hand() {
    let mut session = Session::open("console --planner apf", 120, 36);
    session.see("IDLE");
    session.press("S");
    session.see("START?");
    session.press("\r");
    session.see("▶ RUN");
    session.press(" ");
    session.see("‖ HOLD");
    session.press_until("P", "What was scanned stays");
    session.choose("rpf");
    session.see("CHANGE TO rpf?");
    session.press("\r");
    session.until("the swap in the journal", |session| {
        kinds(&session.run()).iter().filter(|kind| *kind == "planner_chosen").count() == 2
    });
    session.press(" ");
    session.see("RESUME?");
    session.press("\r");
    session.see("▶ RUN");
    session.press(">>>>>>");
    session.see("DONE");
    session.press("q");
    assert_eq!(session.back_in_the_shell(), "code=0");
    let listed = session.bench.tankops(&["runs", "--json"]).json();
    assert_eq!(listed[0]["end"], "complete", "{listed}");
    let verified = session.bench.tankops(&["verify", session.run().to_str().unwrap()]);
    assert_eq!(verified.code, Some(0), "{verified:?}");
}

#[test]
fn a_terminated_console_holds_closes_the_run_and_gives_the_terminal_back() {
    let mut session = Session::open(&goto(), 80, 24);
    session.see("IDLE");
    session.press("S\r");
    session.see("RUN");
    session.signal_console(rustix::process::Signal::TERM);
    assert_eq!(session.back_in_the_shell(), "code=143");
    assert_eq!(kinds(&session.run()).last().map(String::as_str), Some("ended"));
}

#[test]
fn a_panic_of_the_screen_gives_the_terminal_back_and_closes_the_run() {
    let mut session = Session::open(&format!("{} --drill panic-screen", goto()), 80, 24);
    session.see("IDLE");
    session.press("S\r");
    assert_eq!(session.back_in_the_shell(), "code=3");
    assert!(session.text().contains("the run was closed"), "{}", session.text());
    assert_eq!(kinds(&session.run()).last().map(String::as_str), Some("ended"));
}

#[test]
fn a_closed_terminal_ends_the_console_and_closes_the_run() {
    let mut session = Session::open(&goto(), 80, 24);
    session.see("IDLE");
    session.press("S\r");
    session.see("RUN");
    let console = session.console_pid();
    session.closed.store(true, Ordering::SeqCst);
    drop(session.master.take());
    session.keys = Box::new(std::io::sink());
    session.until("the console to end", |_| {
        !Path::new(&format!("/proc/{console}")).exists() || is_zombie(console)
    });
    assert_eq!(kinds(&session.run()).last().map(String::as_str), Some("ended"));
}

fn is_zombie(pid: i32) -> bool {
    std::fs::read_to_string(format!("/proc/{pid}/stat")).is_ok_and(|stat| stat.contains(") Z "))
}

#[test]
fn a_small_terminal_keeps_the_controls() {
    let mut session = Session::open(&goto(), 44, 10);
    session.see("IDLE");
    session.press("S\r");
    session.see("RUN");
    session.press(" ");
    session.see("HOLD");
    session.press("q");
    session.see("Enter");
    session.press("\r");
    assert_eq!(session.back_in_the_shell(), "code=1");
}

#[test]
fn quitting_before_the_start_leaves_no_run() {
    let mut session = Session::open("console", 100, 30);
    session.see("IDLE");
    session.press("q");
    assert_eq!(session.back_in_the_shell(), "code=0");
    assert!(session.bench.runs().is_empty());
}
