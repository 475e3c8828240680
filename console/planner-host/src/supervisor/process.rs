//! The process of a worker: starts, watches, kills and reaps it, without ever waiting for it.

use super::WorkerCommand;
use super::lines::Lines;
use rustix::process::{Pid, Signal, WaitId, WaitIdOptions, kill_process_group, waitid};
use std::collections::VecDeque;
use std::io::{self, PipeReader, Read};
use std::os::fd::{AsFd, BorrowedFd, OwnedFd};
use std::os::unix::net::UnixStream;
use std::process::{Child, Command, ExitStatus, Stdio};

/// The end of the output is kept up to this length, bytes; a panic's backtrace takes a few kilobytes.
const TAIL: usize = 16 << 10;
/// The only variables that a worker inherits from the console's environment. They decide whether a panic prints its
/// backtrace.
const ENVIRONMENT: [&str; 2] = ["RUST_BACKTRACE", "RUST_LIB_BACKTRACE"];
/// The maximum number of consecutive reads of the output, so that a planner that prints endlessly does not delay the
/// others.
const MOST_READS: usize = 16;

/// A child process and the end of its output.
pub(super) struct Process {
    child: Child,
    /// A descriptor that becomes readable when the process ends; `None` where the system has no such descriptor.
    pidfd: Option<OwnedFd>,
    /// The exit status, once the process has been reaped.
    status: Option<ExitStatus>,
    output: Option<PipeReader>,
    tail: VecDeque<u8>,
    lines: Lines,
}

impl Process {
    /// Starts a worker with this socket as its standard input and almost no environment. The worker itself leaves the
    /// console's session.
    pub(super) fn spawn(command: &WorkerCommand, socket: UnixStream) -> io::Result<Self> {
        let (reader, writer) = io::pipe()?;
        rustix::io::ioctl_fionbio(&reader, true)?;
        let mut start = Command::new(&command.program);
        start
            .args(&command.arguments)
            .env_clear()
            .envs(ENVIRONMENT.into_iter().filter_map(|name| Some((name, std::env::var_os(name)?))))
            .stdin(Stdio::from(OwnedFd::from(socket)))
            .stdout(writer.try_clone()?)
            .stderr(writer);
        let child = start.spawn()?;
        // Dropping the command closes the console's copies of the pipe, so that the end of the output can be detected.
        drop(start);
        let pidfd = pidfd_of(&child);
        Ok(Self {
            child,
            pidfd,
            status: None,
            output: Some(reader),
            tail: VecDeque::new(),
            lines: Lines::default(),
        })
    }

    /// Returns the process id; the system does not reuse it before this process is reaped.
    pub(super) fn pid(&self) -> Pid {
        Pid::from_child(&self.child)
    }

    /// Returns the descriptor that becomes readable when the process ends, if the system has one.
    pub(super) fn pidfd(&self) -> Option<BorrowedFd<'_>> {
        self.pidfd.as_ref().map(AsFd::as_fd)
    }

    /// Returns the pipe with the process's output; `None` once it is closed.
    pub(super) fn output(&self) -> Option<BorrowedFd<'_>> {
        self.output.as_ref().map(AsFd::as_fd)
    }

    /// Reaps the process if it has ended, and returns its exit status.
    pub(super) fn reap(&mut self) -> Option<ExitStatus> {
        if self.status.is_none() && self.has_ended() {
            // Until the process is reaped, its id cannot belong to a different process group.
            self.kill_group();
            self.status = self.child.try_wait().ok().flatten();
        }
        self.status
    }

    fn has_ended(&self) -> bool {
        let look = WaitIdOptions::EXITED | WaitIdOptions::NOHANG | WaitIdOptions::NOWAIT;
        waitid(WaitId::Pid(self.pid()), look).is_ok_and(|status| status.is_some())
    }

    /// Kills any processes that the worker may have started; a sandboxed worker cannot start any.
    fn kill_group(&self) {
        // A worker that has not yet left the console's session has no process group of its own.
        let _ = kill_process_group(self.pid(), Signal::KILL);
    }

    /// Whether the process has been reaped.
    pub(super) fn is_reaped(&self) -> bool {
        self.status.is_some()
    }

    /// Kills the process unless it has been reaped.
    pub(super) fn kill(&mut self) {
        if self.status.is_none() {
            self.kill_group();
            // The process may already have ended.
            let _ = self.child.kill();
        }
    }

    /// Reads new output, and keeps the end of the output.
    pub(super) fn read_output(&mut self) {
        let mut piece = [0; TAIL];
        for _ in 0..MOST_READS {
            let Some(output) = &mut self.output else { return };
            match output.read(&mut piece) {
                Ok(n @ 1..) => {
                    self.lines.extend(&piece[..n]);
                    self.tail.extend(&piece[..n]);
                    let surplus = self.tail.len().saturating_sub(TAIL);
                    self.tail.drain(..surplus);
                }
                Err(error) if error.kind() == io::ErrorKind::WouldBlock => return,
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Ok(_) | Err(_) => self.output = None,
            }
        }
    }

    /// Takes the lines printed since the last call.
    pub(super) fn take_lines(&mut self) -> Vec<String> {
        if self.output.is_some() { self.lines.take() } else { self.lines.take_rest() }
    }

    /// Returns the end of the output.
    pub(super) fn tail(&mut self) -> &[u8] {
        self.tail.make_contiguous()
    }
}

#[cfg(target_os = "linux")]
fn pidfd_of(child: &Child) -> Option<OwnedFd> {
    rustix::process::pidfd_open(Pid::from_child(child), rustix::process::PidfdFlags::empty()).ok()
}

/// Other systems have no such descriptor; there, the process is polled.
#[cfg(not(target_os = "linux"))]
fn pidfd_of(_: &Child) -> Option<OwnedFd> {
    None
}
