//! A pseudo terminal with a shell that starts `tankops`.

use crate::bench::Bench;
use portable_pty::{Child, CommandBuilder, MasterPty, PtySize, native_pty_system};
use std::{
    io::{Read, Write},
    path::PathBuf,
    sync::{
        Arc, Mutex,
        atomic::{AtomicBool, Ordering},
    },
    time::{Duration, Instant},
};

const PATIENCE: Duration = Duration::from_mins(1);
/// What a slow terminal takes at a time, bytes, and how often.
const SLOW_PART: usize = 100;
const SLOW_PART_EVERY: Duration = Duration::from_millis(50);
/// After this time, a key that had no effect is pressed again.
const AGAIN: Duration = Duration::from_secs(5);

/// A shell in a pseudo terminal that notes `stty -a` before and after `tankops`.
pub(crate) struct Session {
    pub bench: Bench,
    screen: Arc<Mutex<vt100::Parser>>,
    /// All output to the terminal so far.
    written: Arc<Mutex<Vec<u8>>>,
    keys: Box<dyn Write + Send>,
    child: Box<dyn Child + Send + Sync>,
    master: Option<Box<dyn MasterPty + Send>>,
    /// Whether the terminal has been closed; its reader then closes it, too.
    closed: Arc<AtomicBool>,
    /// Whether the terminal takes bytes only slowly.
    is_slow: Arc<AtomicBool>,
}

fn screen_of(width: u16, height: u16) -> vt100::Parser {
    let size = |count| std::num::NonZero::new(count).unwrap();
    vt100::Parser::new(size(height), size(width), 0)
}

impl Session {
    pub(crate) fn open(arguments: &str, width: u16, height: u16) -> Self {
        Self::open_after("", arguments, width, height)
    }

    /// Opens a session in which the shell runs another command before the console; `$TANKOPS` is the program.
    pub(crate) fn open_after(before: &str, arguments: &str, width: u16, height: u16) -> Self {
        let bench = Bench::new();
        let size = PtySize { rows: height, cols: width, pixel_width: 0, pixel_height: 0 };
        let pair = native_pty_system().openpty(size).unwrap();
        let program = PathBuf::from(env!("CARGO_BIN_EXE_tankops"));
        let deps = program.parent().unwrap().join("deps");
        let script = format!(
            "{before} stty -a > before; {} --plugin-dir {} {arguments}; echo \"code=$?\" > code; stty -a > after; echo SHELL-AGAIN",
            program.display(),
            deps.display()
        );
        let mut command = CommandBuilder::new("bash");
        command.args(["-c", &script]);
        command.cwd(bench.path());
        command.env("XDG_CONFIG_HOME", bench.path());
        command.env("XDG_STATE_HOME", bench.path());
        command.env("TERM", "xterm-256color");
        command.env("TANKOPS", &program);
        command.env("LANG", "C.UTF-8");
        command.env_remove("NO_COLOR");
        let child = pair.slave.spawn_command(command).unwrap();
        drop(pair.slave);
        let screen = Arc::new(Mutex::new(screen_of(width, height)));
        let mut output = pair.master.try_clone_reader().unwrap();
        let shown = Arc::clone(&screen);
        let written = Arc::new(Mutex::new(Vec::new()));
        let kept = Arc::clone(&written);
        let closed = Arc::new(AtomicBool::new(false));
        let is_closed = Arc::clone(&closed);
        let is_slow = Arc::new(AtomicBool::new(false));
        let slow = Arc::clone(&is_slow);
        std::thread::spawn(move || {
            let mut bytes = [0; 8192];
            loop {
                let most = if slow.load(Ordering::SeqCst) {
                    std::thread::sleep(SLOW_PART_EVERY);
                    SLOW_PART
                } else {
                    bytes.len()
                };
                let Ok(count) = output.read(&mut bytes[..most]) else { return };
                if count == 0 || is_closed.load(Ordering::SeqCst) {
                    return;
                }
                kept.lock().unwrap().extend_from_slice(&bytes[..count]);
                shown.lock().unwrap().process(&bytes[..count]);
            }
        });
        let keys = pair.master.take_writer().unwrap();
        Self { bench, screen, written, keys, child, master: Some(pair.master), closed, is_slow }
    }

    /// Lets the terminal take only [`SLOW_PART`] bytes at a time from now on: 2 kB/s.
    pub(crate) fn slow_down(&self) {
        self.is_slow.store(true, Ordering::SeqCst);
    }

    pub(crate) fn text(&self) -> String {
        self.screen.lock().unwrap().screen().contents()
    }

    /// Waits until the screen shows a word.
    pub(crate) fn see(&self, word: &str) {
        self.until(&format!("`{word}` on the screen"), |session| session.text().contains(word));
    }

    pub(crate) fn until(&self, what: &str, is_so: impl Fn(&Self) -> bool) {
        let is_so = self.is_within(PATIENCE, is_so);
        assert!(is_so, "timed out waiting for {what}; the screen shows:\n{}", self.text());
    }

    /// Waits until a condition holds, at most for `patience`; returns whether it holds.
    fn is_within(&self, patience: Duration, is_so: impl Fn(&Self) -> bool) -> bool {
        let until = Instant::now() + patience;
        while !is_so(self) {
            if Instant::now() >= until {
                return false;
            }
            std::thread::sleep(Duration::from_millis(20));
        }
        true
    }

    pub(crate) fn press(&mut self, keys: &str) {
        self.send(keys.as_bytes());
    }

    /// Sends bytes in one write.
    pub(crate) fn send(&mut self, bytes: &[u8]) {
        self.keys.write_all(bytes).unwrap();
        self.keys.flush().unwrap();
    }

    /// Answers a question that is on the screen with Enter. A question must be read before it can be answered, and
    /// Enter immediately after Enter would count as a key that is held down.
    pub(crate) fn agree(&mut self) {
        let text = self.text();
        let asked = text.lines().rev().find_map(|line| Some(&line[line.find("Enter:")?..]));
        // The text after `Esc` may contain figures that change.
        let asked = asked.and_then(|asked| asked.split("Esc").next()).expect("a question is on the screen");
        self.agree_until("the answer", |session| !session.text().contains(asked));
    }

    /// Like [`Self::agree`], for a question that stays on the screen after the answer. A busy console may treat an Enter
    /// as pressed too early; then Enter is pressed again.
    pub(crate) fn agree_until(&mut self, what: &str, is_answered: impl Fn(&Self) -> bool) {
        let until = Instant::now() + PATIENCE;
        while Instant::now() < until {
            std::thread::sleep(Duration::from_millis(400));
            self.press("\r");
            if self.is_within(AGAIN, &is_answered) {
                return;
            }
        }
        self.until(what, is_answered);
    }

    /// Presses a key until the screen shows a word; on a busy machine the search for planners may still be running.
    pub(crate) fn press_until(&mut self, key: &str, word: &str) {
        let until = Instant::now() + PATIENCE;
        while !self.text().contains(word) && Instant::now() < until {
            self.press(key);
            self.is_within(AGAIN, |session| session.text().contains(word));
        }
        self.see(word);
    }

    /// Moves down an open list to an entry and selects it.
    pub(crate) fn choose(&mut self, entry: &str) {
        let chosen = format!(">{entry} ");
        for _ in 0..60 {
            if self.text().contains(&chosen) {
                break;
            }
            let marked = |session: &Self| -> Vec<String> {
                session.text().lines().filter(|line| line.contains('>')).map(str::to_owned).collect()
            };
            let before = marked(self);
            self.press("\x1b[B");
            self.until("the next entry", |session| marked(session) != before);
        }
        self.see(&chosen);
        self.press("\r");
    }

    /// Starts the mission and confirms it, once its plan is ready.
    pub(crate) fn start(&mut self) {
        self.see("Press S to start");
        self.press("S");
        self.see("Enter: start, Esc: cancel.");
        self.agree();
    }

    /// Holds the robot.
    pub(crate) fn hold(&mut self) {
        self.press(" ");
        self.see("‖ HOLD");
    }

    /// Resumes a held robot.
    pub(crate) fn resume(&mut self) {
        self.press(" ");
        self.see("Resume?");
        self.agree();
        self.see("▶ RUN");
    }

    /// Chooses another planner for a held robot.
    pub(crate) fn change_planner(&mut self, id: &str) {
        self.press_until("P", "coverage is kept");
        self.choose(id);
        self.see(&format!("Change to {id}?"));
        self.agree();
    }

    /// Runs the rest of the mission at high speed, and leaves the console.
    pub(crate) fn finish(&mut self) {
        self.press(">>>>>>");
        self.see("DONE");
        self.see("[7 Result]");
        // Goes back, screen by screen, and leaves the console.
        self.press("1");
        self.see("[1 Home]");
        self.press("q");
        assert_eq!(self.back_in_the_shell(), "code=0");
    }

    /// Confirms quitting a mission in progress, and returns the exit code.
    pub(crate) fn agree_to_leave(&mut self) -> String {
        self.see("Enter: quit");
        self.agree();
        self.back_in_the_shell()
    }

    /// Waits until the shell is back and checks that the terminal is restored. Returns the exit code.
    pub(crate) fn back_in_the_shell(&mut self) -> String {
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
    pub(crate) fn console_pid(&self) -> i32 {
        let shell = self.child.process_id().unwrap();
        let children = std::fs::read_to_string(format!("/proc/{shell}/task/{shell}/children")).unwrap();
        children.split_whitespace().next().unwrap().parse().unwrap()
    }

    pub(crate) fn signal_console(&self, signal: rustix::process::Signal) {
        let pid = rustix::process::Pid::from_raw(self.console_pid()).unwrap();
        rustix::process::kill_process(pid, signal).unwrap();
    }

    /// Closes the terminal while the console runs, as if its window were closed.
    pub(crate) fn hang_up(&mut self) {
        self.closed.store(true, Ordering::SeqCst);
        drop(self.master.take());
        self.keys = Box::new(std::io::sink());
    }

    /// Everything written to the terminal so far.
    pub(crate) fn written(&self) -> Vec<u8> {
        self.written.lock().unwrap().clone()
    }

    /// Whether the console took the whole screen at any time.
    pub(crate) fn took_the_screen(&self) -> bool {
        let written = self.written.lock().unwrap();
        written.windows(8).any(|bytes| bytes == b"\x1b[?1049h")
    }

    /// The folder of the run.
    pub(crate) fn run(&self) -> PathBuf {
        self.bench.runs().remove(0)
    }
}
