//! The streams to an adapter: its two byte streams, and the handle that ends them.

use crate::{
    address::{Address, OPTION, resolved},
    said::Said,
};
use rustix::{
    event::{PollFd, PollFlags, Timespec, poll},
    net::sockopt::set_socket_send_buffer_size,
    pipe::fcntl_setpipe_size,
};
use std::{
    io::{self, Read, Write},
    net::{TcpStream, UdpSocket},
    os::{
        fd::{AsFd, BorrowedFd},
        unix::{net::UnixStream, process::CommandExt},
    },
    process::{Child, Command, Stdio},
    thread,
    time::{Duration, Instant},
};

/// The largest datagram, bytes.
const DATAGRAM_BYTES: usize = 65_536;
/// Interval at which a reader of datagrams checks whether it should end.
const LOOK_AGAIN: Duration = Duration::from_millis(100);
/// Time that an adapter that was started here may take to end on its own.
const PATIENCE: Duration = Duration::from_secs(1);

/// Maximum number of bytes that wait on this machine for an adapter, so that a stop does not wait behind many drives.
const WAITING_BYTES: usize = 4096;

/// The commands to an adapter.
pub(crate) trait Outgoing: Write + Send {
    /// Whether the stream has room for a motion. A pipe has room if the adapter has read everything, a Unix socket if
    /// only a few messages are unread, and a TCP socket if the other machine accepts bytes.
    fn has_room(&self) -> bool;
}

impl<T: Write + AsFd + Send> Outgoing for T {
    fn has_room(&self) -> bool {
        let now = Timespec { tv_sec: 0, tv_nsec: 0 };
        // A failed stream reports its failure when it is written to.
        poll(&mut [PollFd::new(self, PollFlags::OUT)], Some(&now)).is_ok_and(|ready| ready > 0)
    }
}

/// A stream to an adapter.
pub(crate) struct Stream {
    pub read: Box<dyn Read + Send>,
    pub write: Box<dyn Outgoing>,
    /// The last lines on the standard error of an adapter that was started here.
    pub said: Said,
    pub end: End,
}

/// The handle that ends a stream; the reader and the writer then fail.
pub(crate) enum End {
    Unix(UnixStream),
    Tcp(TcpStream),
    Datagrams,
    Process(Child),
}

impl Stream {
    pub(crate) fn open(address: &Address, network: bool) -> io::Result<Self> {
        match address {
            Address::Unix(path) => {
                let stream = UnixStream::connect(path)?;
                set_socket_send_buffer_size(&stream, WAITING_BYTES)?;
                let (read, write) = (stream.try_clone()?, stream.try_clone()?);
                Ok(Self {
                    read: Box::new(read),
                    write: Box::new(write),
                    said: Said::default(),
                    end: End::Unix(stream),
                })
            }
            Address::Tcp(at) => {
                let stream =
                    TcpStream::connect_timeout(&resolved(at, network, OPTION)?, Duration::from_secs(5))?;
                stream.set_nodelay(true)?;
                set_socket_send_buffer_size(&stream, WAITING_BYTES)?;
                let (read, write) = (stream.try_clone()?, stream.try_clone()?);
                Ok(Self {
                    read: Box::new(read),
                    write: Box::new(write),
                    said: Said::default(),
                    end: End::Tcp(stream),
                })
            }
            Address::Udp(at) => {
                let peer = resolved(at, network, OPTION)?;
                let own = if peer.is_ipv4() { "0.0.0.0:0" } else { "[::]:0" };
                let socket = UdpSocket::bind(own)?;
                socket.connect(peer)?;
                socket.set_read_timeout(Some(LOOK_AGAIN))?;
                let write = Datagrams::new(socket.try_clone()?);
                Ok(Self {
                    read: Box::new(Datagrams::new(socket)),
                    write: Box::new(write),
                    said: Said::default(),
                    end: End::Datagrams,
                })
            }
            Address::Loopback => Err(io::Error::other("the simulator in this process has no stream")),
            Address::Run(command) => {
                // A group of its own, so that the keys of the terminal do not reach the adapter.
                let mut child = Command::new("/bin/sh")
                    .args(["-c", command])
                    .stdin(Stdio::piped())
                    .stdout(Stdio::piped())
                    .stderr(Stdio::piped())
                    .process_group(0)
                    .spawn()?;
                let missing = || io::Error::other("the adapter has no standard streams");
                let write = child.stdin.take().ok_or_else(missing)?;
                fcntl_setpipe_size(&write, WAITING_BYTES)?;
                let read = child.stdout.take().ok_or_else(missing)?;
                let said = Said::listen(child.stderr.take().ok_or_else(missing)?)?;
                Ok(Self { read: Box::new(read), write: Box::new(write), said, end: End::Process(child) })
            }
        }
    }
}

impl End {
    /// Sends a signal to an adapter that was started here and to its children; other adapters do not get it.
    pub(crate) fn signal(&self, signal: rustix::process::Signal) {
        let Self::Process(child) = self else { return };
        if let Some(group) = i32::try_from(child.id()).ok().and_then(rustix::process::Pid::from_raw) {
            // The group may have ended in the meantime.
            let _ = rustix::process::kill_process_group(group, signal);
        }
    }
}

impl Drop for End {
    fn drop(&mut self) {
        match self {
            // The other side may have closed the socket already.
            Self::Unix(stream) => drop(stream.shutdown(std::net::Shutdown::Both)),
            Self::Tcp(stream) => drop(stream.shutdown(std::net::Shutdown::Both)),
            Self::Datagrams => {}
            Self::Process(child) => {
                if !has_ended(child) {
                    self.signal(rustix::process::Signal::KILL);
                }
                if let Self::Process(child) = self {
                    let _ = child.wait();
                }
            }
        }
    }
}

/// Waits for an adapter to end after its stdin was closed; returns whether it has.
fn has_ended(child: &mut Child) -> bool {
    let began = Instant::now();
    while began.elapsed() < PATIENCE {
        if !matches!(child.try_wait(), Ok(None)) {
            return true;
        }
        thread::sleep(Duration::from_millis(10));
    }
    false
}

/// A socket for datagrams as a stream of lines.
pub(crate) struct Datagrams {
    socket: UdpSocket,
    buffer: Vec<u8>,
    /// The part of the last datagram that has not been read.
    left: std::ops::Range<usize>,
}

impl Datagrams {
    fn new(socket: UdpSocket) -> Self {
        Self { socket, buffer: vec![0; DATAGRAM_BYTES + 1], left: 0..0 }
    }
}

impl AsFd for Datagrams {
    fn as_fd(&self) -> BorrowedFd<'_> {
        self.socket.as_fd()
    }
}

impl Read for Datagrams {
    fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
        if self.left.is_empty() {
            let n = match self.socket.recv(&mut self.buffer[..DATAGRAM_BYTES]) {
                // The port is closed for now: a datagram was answered by an error.
                Err(error) if error.kind() == io::ErrorKind::ConnectionRefused => {
                    thread::sleep(LOOK_AGAIN);
                    return Err(io::ErrorKind::WouldBlock.into());
                }
                received => received?,
            };
            self.buffer[n] = b'\n';
            self.left = 0..n + 1;
        }
        let n = self.left.len().min(out.len());
        out[..n].copy_from_slice(&self.buffer[self.left.start..self.left.start + n]);
        self.left.start += n;
        Ok(n)
    }
}

impl Write for Datagrams {
    fn write(&mut self, line: &[u8]) -> io::Result<usize> {
        match self.socket.send(line) {
            // The port is closed for now. The effect is that of a lost datagram.
            Err(error) if error.kind() == io::ErrorKind::ConnectionRefused => Ok(line.len()),
            sent => sent,
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn motions_find_no_room_behind_others_but_a_stop_does() {
        let path = std::env::temp_dir().join(format!("tankops-room-{}", std::process::id()));
        let listener = std::os::unix::net::UnixListener::bind(&path).unwrap();
        let to_socket = Stream::open(&Address::Unix(path.clone()), false).unwrap();
        let (mut adapter, _) = listener.accept().unwrap();
        let to_pipe = Stream::open(&Address::Run("exec sleep 600".into()), false).unwrap();
        let line = [b'x'; 150];
        for mut write in [to_socket.write, to_pipe.write] {
            let mut motions = 0;
            while write.has_room() {
                write.write_all(&line).unwrap();
                motions += 1;
            }
            assert!((1..10).contains(&motions), "{motions} motions wait");
            // Does not block.
            write.write_all(&line).unwrap();
        }
        adapter.read_exact(&mut [0; 300]).unwrap();
        std::fs::remove_file(path).unwrap();
    }
}
