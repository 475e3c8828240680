//! Before a worker loads anything, drops the privileges and resources that it does not need.

use super::Socket;
use crate::discovery::{MOST_BYTES, PluginDirs, too_large_for_machine};
use crate::loader::File;
use crate::sandbox::{ClosedOff, MAY_RESERVE, PLUGIN_AT, close_all_but, seal};
use crate::wire::answer::Sealed;
use crate::wire::body::Writer;
use crate::wire::{SHUT_DOWN_WITHIN, kind};
use mission::Sandbox;
use rustix::event::{PollFd, PollFlags, poll};
use rustix::net::{SendAncillaryBuffer, SendAncillaryMessage, SendFlags, sendmsg};
use rustix::process::{Resource, Rlimit, Signal, getpid, getrlimit, kill_process, setrlimit, setsid};
use std::io::{self, IoSlice};
use std::mem::MaybeUninit;
use std::os::fd::AsFd;
use std::os::unix::net::UnixStream;
use std::sync::{Arc, Barrier};

/// The only descriptor of the socket. Its number is higher than those that careless plugins close.
const SOCKET_AT: i32 = 200;
const MOST_FILES: u64 = 256;
/// Maximum size of the first thread's stack, bytes, which is not counted as writable memory.
const LARGEST_STACK: u64 = 16 << 20;

/// Checks, before a worker is started, that it can have its two descriptors and that the system allows a copy of every
/// plugin in these folders.
///
/// # Errors
/// A sentence that names the limit that is too low.
pub fn check_limits(plugins: &PluginDirs) -> Result<(), String> {
    check_descriptors()?;
    plugins.candidates().iter().find_map(|path| too_large_for_machine(path)).map_or(Ok(()), Err)
}

/// Checks that a worker can have its socket and its plugin at their descriptors.
///
/// # Errors
/// A sentence that names the limit that is too low.
pub(crate) fn check_descriptors() -> Result<(), String> {
    let last = SOCKET_AT.max(PLUGIN_AT) as u64;
    match getrlimit(Resource::Nofile).current.filter(|limit| *limit <= last) {
        Some(limit) => Err(format!(
            "a process may open only {limit} files, but a planner needs {MOST_FILES}; try `ulimit -n {MOST_FILES}`"
        )),
        None => Ok(()),
    }
}

/// Takes the socket that was passed as standard input and replaces it with an empty input.
pub(super) fn take_socket() -> io::Result<UnixStream> {
    let socket = rustix::io::fcntl_dupfd_cloexec(io::stdin().as_fd(), SOCKET_AT)?;
    let nothing = std::fs::File::open("/dev/null")?;
    rustix::stdio::dup2_stdin(&nothing)?;
    drop(nothing);
    close_all_but(socket.as_fd());
    Ok(socket.into())
}

/// Drops what a planner does not need, above all the terminal. If the system refuses a limit, the refusal is ignored:
/// these limits only guard against accidents, and the deadlines are enforced without them.
pub(super) fn confine() {
    let _ = setsid();
    limit(Resource::Core, 0);
    limit(Resource::Nofile, MOST_FILES);
    limit(Resource::Fsize, MOST_BYTES);
    limit(Resource::Stack, LARGEST_STACK);
    #[cfg(target_os = "linux")]
    {
        let _ = rustix::thread::set_no_new_privs(true);
        let _ = std::fs::write("/proc/self/oom_score_adj", "1000");
    }
}

/// Enters the sandbox and reports the sandbox's extent and the file to the console, before any code of the plugin runs.
///
/// # Errors
/// The console cannot be informed, so nothing may be loaded.
pub(super) fn close_off(
    socket: &Socket,
    sequence: u32,
    file: &File,
    memory_limit_bytes: u64,
) -> io::Result<(Sandbox, bool)> {
    let ClosedOff { sandbox, listener, reads_libraries } = seal();
    if listener.is_none() {
        limit_space(memory_limit_bytes);
    }
    let sealed = Sealed { sandbox, sha256: file.sha256.clone(), abi: file.abi };
    let mut frame = Writer::default();
    let frame = frame.begin(kind::SEALED, sequence, 0).put(&sealed).finish().expect("the report is short");
    let mut space = [MaybeUninit::uninit(); rustix::cmsg_space!(ScmRights(1))];
    let mut descriptors = SendAncillaryBuffer::new(&mut space);
    let listener = listener.as_ref().map(AsFd::as_fd);
    if let Some(listener) = &listener {
        descriptors.push(SendAncillaryMessage::ScmRights(std::slice::from_ref(listener)));
    }
    let sent = sendmsg(socket, &[IoSlice::new(frame)], &mut descriptors, SendFlags::empty())?;
    if sent < frame.len() {
        return Err(io::ErrorKind::WriteZero.into());
    }
    Ok((sealed.sandbox, reads_libraries))
}

/// Limits the planner's memory to `bytes` in addition to what the worker itself uses. The system counts private
/// writable memory; the console decides on the rest ([`crate::sandbox::Uncounted`]).
pub(super) fn limit_memory(bytes: u64) {
    let (_, own_data) = own_memory();
    limit(Resource::Data, own_data.saturating_add(bytes));
}

/// Limits address space on systems where the console cannot decide on it. On other systems, this limit would do harm:
/// once it is reached, the system makes memory writable without counting it.
fn limit_space(bytes: u64) {
    let (own_space, _) = own_memory();
    limit(Resource::As, own_space.saturating_add(bytes).saturating_add(MAY_RESERVE));
}

/// Returns the address space of this process and its private memory, bytes; zero where the system does not report it.
fn own_memory() -> (u64, u64) {
    let pages = std::fs::read_to_string("/proc/self/statm").unwrap_or_default();
    let bytes_at = |at| {
        let pages: Option<u64> = pages.split_ascii_whitespace().nth(at).and_then(|pages| pages.parse().ok());
        pages.unwrap_or_default() * rustix::param::page_size() as u64
    };
    (bytes_at(0), bytes_at(5))
}

/// Lowers a limit, but never raises it: the guard page that detects a stack overflow was placed according to the limit
/// at the start.
fn limit(resource: Resource, most: u64) {
    let before = getrlimit(resource);
    let most = before.current.into_iter().chain(before.maximum).fold(most, u64::min);
    let _ = setrlimit(resource, Rlimit { current: Some(most), maximum: Some(most) });
}

/// Starts a thread that ends this process when the console has exited, or when the process ignores a request to shut
/// down. This works even if the planner is in an endless loop.
///
/// Returns once that thread is watching. Starting the thread reserves memory, which the console must allow, and a
/// console that has already asked the worker to shut down may no longer answer.
pub(super) fn die_with_the_console(socket: Socket) -> io::Result<()> {
    let watches = Arc::new(Barrier::new(2));
    let begun = Arc::clone(&watches);
    std::thread::Builder::new().name("watchdog".into()).stack_size(64 << 10).spawn(move || {
        begun.wait();
        loop {
            let mut sockets = [PollFd::new(&socket, SHUTDOWN_REQUESTED)];
            let happened = poll(&mut sockets, None).map_or(PollFlags::empty(), |_| sockets[0].revents());
            if happened.contains(PollFlags::NVAL) {
                // The planner closed the worker's descriptor; the main thread notices that, too, and exits with its own
                // code.
                return;
            }
            if happened == SHUTDOWN_REQUESTED {
                std::thread::sleep(SHUT_DOWN_WITHIN);
            }
            if !happened.is_empty() {
                let _ = kill_process(getpid(), Signal::KILL);
            }
        }
    })?;
    watches.wait();
    Ok(())
}

/// The event that reports that the console sends nothing more. A full hang-up and errors are always reported.
#[cfg(target_os = "linux")]
const SHUTDOWN_REQUESTED: PollFlags = PollFlags::RDHUP;
/// Other systems report only a full hang-up or an error, and the console must kill a worker that does not exit.
#[cfg(not(target_os = "linux"))]
const SHUTDOWN_REQUESTED: PollFlags = PollFlags::empty();
