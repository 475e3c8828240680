//! The process of a worker: started, seen off, killed, and never waited for longer than a blink.

use super::WorkerCommand;
use super::ending::{how_it_ended, last_line};
use rustix::process::Signal;
use std::collections::VecDeque;
use std::io::{self, PipeReader, Read};
use std::os::fd::OwnedFd;
use std::os::unix::net::UnixStream;
use std::os::unix::process::{CommandExt, ExitStatusExt};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// A process whose socket is closed has ended or is about to.
const EXIT_WITHIN: Duration = Duration::from_millis(80);
/// A killed process is gone at once unless the system is stuck.
const DIE_WITHIN: Duration = Duration::from_millis(30);
/// What a dead process printed is in the pipe already.
const OUTPUT_WITHIN: Duration = Duration::from_millis(30);
/// A planner may take this long to be dropped.
const FAREWELL_WITHIN: Duration = Duration::from_millis(100);
/// So much of the output is kept, bytes.
const TAIL: usize = 4096;

/// A child process and the end of what it printed.
pub(super) struct Supervised {
    child: Option<Child>,
    output: Output,
}

struct Output {
    tail: Arc<Mutex<VecDeque<u8>>>,
    /// Hangs up when the process has closed its output.
    end: Receiver<()>,
}

impl Supervised {
    /// Starts a worker with this socket as its standard input, without environment, in a process group of its own.
    pub(super) fn spawn(command: &WorkerCommand, socket: UnixStream) -> io::Result<Self> {
        let (reader, writer) = io::pipe()?;
        let mut start = Command::new(&command.program);
        start
            .args(&command.arguments)
            .env_clear()
            .process_group(0)
            .stdin(Stdio::from(OwnedFd::from(socket)))
            .stdout(writer.try_clone()?)
            .stderr(writer);
        let child = start.spawn()?;
        // Dropping the command closes our copies of the pipe, so that its end can be seen.
        drop(start);
        Ok(Self { child: Some(child), output: Output::follow(reader)? })
    }

    /// How the process ended, and its last line of output. Kills it if it has not ended yet.
    pub(super) fn obituary(&mut self) -> (String, String) {
        let ended = self.child.as_mut().and_then(|child| wait(child, EXIT_WITHIN));
        // A process that was slow to end keeps its own reason; only one that lives on is ended by our signal.
        let status =
            ended.or_else(|| self.kill().filter(|status| status.signal() != Some(Signal::KILL.as_raw())));
        (how_it_ended(status), last_line(&self.output.finish()))
    }

    /// Kills the process, and tells how it ended if that is known at once.
    pub(super) fn kill(&mut self) -> Option<ExitStatus> {
        let mut child = self.child.take()?;
        // It may have ended by itself.
        let _ = child.kill();
        let status = wait(&mut child, DIE_WITHIN);
        if status.is_none() {
            reap_later(child);
        }
        status
    }

    /// Leaves the process to end by itself, and kills it if it does not; keeps `socket` open meanwhile.
    pub(super) fn see_off(&mut self, socket: UnixStream) {
        if let Some(mut child) = self.child.take() {
            in_background(move || {
                if wait(&mut child, FAREWELL_WITHIN).is_none() {
                    let _ = child.kill();
                    let _ = child.wait();
                }
                drop(socket);
            });
        }
    }
}

impl Drop for Supervised {
    fn drop(&mut self) {
        self.kill();
    }
}

fn wait(child: &mut Child, within: Duration) -> Option<ExitStatus> {
    let until = Instant::now() + within;
    loop {
        match child.try_wait() {
            Ok(Some(status)) => return Some(status),
            Ok(None) if Instant::now() < until => std::thread::sleep(Duration::from_micros(200)),
            Ok(None) | Err(_) => return None,
        }
    }
}

fn reap_later(mut child: Child) {
    in_background(move || {
        let _ = child.wait();
    });
}

fn in_background(work: impl FnOnce() + Send + 'static) {
    // Without threads the process stays a zombie until the console ends; nothing else is lost.
    let _ = std::thread::Builder::new().name("worker farewell".into()).spawn(work);
}

impl Output {
    fn follow(mut reader: PipeReader) -> io::Result<Self> {
        let tail = Arc::new(Mutex::new(VecDeque::new()));
        let (alive, end) = channel();
        let kept = Arc::clone(&tail);
        std::thread::Builder::new().name("worker output".into()).spawn(move || {
            let mut piece = [0; TAIL];
            while let Ok(n @ 1..) = reader.read(&mut piece) {
                let mut kept = kept.lock().unwrap_or_else(PoisonError::into_inner);
                kept.extend(&piece[..n]);
                let surplus = kept.len().saturating_sub(TAIL);
                kept.drain(..surplus);
            }
            drop(alive);
        })?;
        Ok(Self { tail, end })
    }

    fn finish(&self) -> Vec<u8> {
        // Nothing is ever sent: it returns when the other end is dropped, or when time is up.
        let _ = self.end.recv_timeout(OUTPUT_WITHIN);
        self.tail.lock().unwrap_or_else(PoisonError::into_inner).iter().copied().collect()
    }
}
