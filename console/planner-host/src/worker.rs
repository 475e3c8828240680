//! The worker process: it loads one plugin, and its only connection to the console is one socket.

mod confine;
mod deadline;
mod progress_reporter;
mod session;

use crate::wire::frame::{Incoming, Received};
use crate::wire::{CHANNEL_LOST, answer::BAD_OUTPUT, answer::Refusal, body::Writer, kind};
pub(crate) use confine::check_descriptors;
pub use confine::check_limits;
use deadline::Deadline;
use rustix::event::{PollFd, PollFlags, poll};
use rustix::process::{getpid, kill_process};
use session::{Session, Trouble};
use std::io::{self, Read, Write};
use std::os::unix::net::UnixStream;
use std::process::ExitCode;
use std::sync::Arc;

/// The only descriptor of the socket; all users of the socket share it.
type Socket = Arc<UnixStream>;

/// Runs a worker: takes the socket that was passed as standard input and answers requests until the console hangs up.
pub fn worker_main() -> ExitCode {
    if confine::take_socket().and_then(|socket| serve(&Arc::new(socket))).is_ok() {
        return ExitCode::SUCCESS;
    }
    let _ = kill_process(getpid(), CHANNEL_LOST);
    ExitCode::FAILURE
}

/// Reads from a socket only when data is available. A blocking read would also be woken, in vain, whenever the other
/// side has read what was written to it, which happens on every step.
struct Patient<'a>(&'a UnixStream);

impl Read for Patient<'_> {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        poll(&mut [PollFd::new(self.0, PollFlags::IN)], None)?;
        self.0.read(bytes)
    }
}

fn serve(socket: &Socket) -> io::Result<()> {
    confine::confine();
    let mut stream = &**socket;
    let deadline = Deadline::new(socket);
    let (mut incoming, mut writer, mut session) =
        (Incoming::default(), Writer::default(), Session::new(&deadline, socket));
    loop {
        match incoming.receive(&mut Patient(socket)) {
            Received::Frame => {}
            Received::Closed => return Ok(()),
            Received::Broken => return Err(io::ErrorKind::InvalidData.into()),
        }
        if incoming.kind() != kind::CANCEL {
            deadline.begin(&incoming);
            answer(&mut session, &incoming, &mut writer)?;
            stream.write_all(finished(&mut writer, incoming.sequence()))?;
        }
    }
}

fn answer(session: &mut Session<'_>, incoming: &Incoming, writer: &mut Writer) -> io::Result<()> {
    let sequence = incoming.sequence();
    writer.begin(kind::DONE, sequence, 0);
    match session.obey(incoming, writer) {
        Ok(()) => {}
        Err(Trouble::Failed(refusal)) => {
            writer.begin(kind::FAILED, sequence, 0).put(&refusal);
        }
        Err(Trouble::Refused(why)) => {
            writer.begin(kind::REFUSED, sequence, 0).put(&why);
        }
        Err(Trouble::Unable(why)) => {
            writer.begin(kind::UNABLE, sequence, 0).put(&why);
        }
        // The console sent something that a console of the same build never sends.
        Err(Trouble::Malformed) => return Err(io::ErrorKind::InvalidData.into()),
    }
    Ok(())
}

fn finished(writer: &mut Writer, sequence: u32) -> &[u8] {
    if writer.finish().is_err() {
        let message = "gave an answer that is too large".to_owned();
        let refusal = Refusal { code: BAD_OUTPUT, message, partial: Vec::new() };
        writer.begin(kind::FAILED, sequence, 0).put(&refusal);
    }
    writer.finish().expect("a sentence fits into a frame")
}
