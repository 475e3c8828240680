//! The vehicle's end of the wire: connections of consoles, and their messages.

use crate::address::{Address, OPTION, resolved};
use std::{
    collections::BTreeMap,
    io::{self, Read, Write},
    net::{SocketAddr, TcpListener, UdpSocket},
    os::unix::{fs::FileTypeExt, net::UnixListener},
    path::Path,
    sync::{
        Arc,
        atomic::{AtomicUsize, Ordering},
        mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel},
    },
    thread,
    time::{Duration, Instant},
};
use vehicle::wire::{
    FromSession, FromVehicle, Heard, Misfit, Reader, ToSession, ToVehicle, Writer,
    message::{Commander, Hello, Mode, State},
};

/// Maximum number of messages that wait for a console; a console that is farther behind misses messages.
const MOST_WAITING: usize = 64;
/// Maximum number of messages that wait for the vehicle; further messages wait in the sockets.
const MOST_ASKED: usize = 256;
/// Maximum number of connections at a time: the console that the vehicle obeys, and consoles that only watch.
const MOST_CLIENTS: usize = 8;
/// Time without a datagram after which a console that uses datagrams counts as having left.
const SILENT: Duration = Duration::from_secs(3);
const LOOK_AGAIN: Duration = Duration::from_millis(200);

/// A connection; connections are numbered in the order in which they begin.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct ClientId(u64);

/// An event on a connection.
#[derive(Debug)]
pub enum Did {
    /// It began.
    Joined(Client),
    /// It sent a message.
    Said(ToVehicle),
    /// It sent a line that is not a valid message.
    SaidWrong(Misfit),
    /// It ended.
    Left,
}

/// The sending end of a connection.
#[derive(Debug)]
pub struct Client {
    lines: SyncSender<Vec<u8>>,
    writer: Writer<FromVehicle>,
}

impl Client {
    fn new(lines: SyncSender<Vec<u8>>) -> Self {
        Self { lines, writer: Writer::new(FromSession::default()) }
    }

    /// Sends a message, unless the console is far behind.
    ///
    /// # Errors
    /// A value of the message is out of bounds.
    pub fn send(&mut self, message: &FromVehicle) -> Result<(), Misfit> {
        let mut line = Vec::new();
        self.writer.write(message, &mut line)?;
        // A console that has left or is behind misses this message.
        let _ = self.lines.try_send(line);
        Ok(())
    }
}

/// Offers a vehicle at an address.
pub struct Server {
    did: Receiver<(ClientId, Did)>,
    at: Address,
}

impl Server {
    /// Begins to listen; a port of 0 becomes any free one.
    ///
    /// # Errors
    /// The address is taken, is not allowed, or is a command.
    pub fn listen(address: &Address, hello: Hello, network: bool) -> io::Result<Self> {
        let (tell, did) = sync_channel(MOST_ASKED);
        let hello = Arc::new(hello);
        let at = match address {
            Address::Unix(path) => {
                accept_unix(unix(path)?, tell, hello)?;
                address.clone()
            }
            Address::Tcp(at) => {
                let listener = TcpListener::bind(resolved(at, network, OPTION)?)?;
                let at = Address::Tcp(listener.local_addr()?.to_string());
                accept_tcp(listener, tell, hello)?;
                at
            }
            Address::Udp(at) => {
                let socket = UdpSocket::bind(resolved(at, network, OPTION)?)?;
                socket.set_read_timeout(Some(LOOK_AGAIN))?;
                let at = Address::Udp(socket.local_addr()?.to_string());
                let datagrams = Datagrams { socket: Arc::new(socket), tell, hello, clients: BTreeMap::new() };
                thread::Builder::new().name("datagrams".into()).spawn(move || datagrams.receive())?;
                at
            }
            Address::Run(_) | Address::Loopback => {
                return Err(io::Error::new(
                    io::ErrorKind::InvalidInput,
                    "a vehicle listens on a socket; write unix:PATH, tcp:HOST:PORT or udp:HOST:PORT",
                ));
            }
        };
        Ok(Self { did, at })
    }

    /// The address at which the server listens.
    pub fn at(&self) -> &Address {
        &self.at
    }

    /// The next event on a connection; `None` if none occurs before `until`.
    pub fn next(&self, until: Instant) -> Option<(ClientId, Did)> {
        match self.did.recv_timeout(until.saturating_duration_since(Instant::now())) {
            Ok(did) => Some(did),
            Err(RecvTimeoutError::Timeout) => None,
            Err(RecvTimeoutError::Disconnected) => {
                // All threads of the server have failed; without them, only time passes.
                thread::sleep(until.saturating_duration_since(Instant::now()));
                None
            }
        }
    }
}

/// A Unix socket; one that a dead process has left behind is replaced.
fn unix(path: &Path) -> io::Result<UnixListener> {
    match UnixListener::bind(path) {
        Err(error) if error.kind() == io::ErrorKind::AddrInUse => {
            if !std::fs::symlink_metadata(path)?.file_type().is_socket() {
                return Err(io::Error::new(
                    io::ErrorKind::AlreadyExists,
                    "the file exists and is not a socket",
                ));
            }
            let is_dead = std::os::unix::net::UnixStream::connect(path)
                .is_err_and(|error| error.kind() == io::ErrorKind::ConnectionRefused);
            if !is_dead {
                return Err(error);
            }
            std::fs::remove_file(path)?;
            UnixListener::bind(path)
        }
        bound => bound,
    }
}

type Tell = SyncSender<(ClientId, Did)>;

fn accept_unix(listener: UnixListener, tell: Tell, hello: Arc<Hello>) -> io::Result<()> {
    let accept = move || {
        let open = Arc::default();
        for (number, stream) in (0..).zip(listener.incoming()) {
            let Ok(stream) = stream else { continue };
            let Ok(write) = stream.try_clone() else { continue };
            connected(ClientId(number), (stream, write), (&tell, &open), &hello);
        }
    };
    thread::Builder::new().name("accept".into()).spawn(accept).map(|_| ())
}

fn accept_tcp(listener: TcpListener, tell: Tell, hello: Arc<Hello>) -> io::Result<()> {
    let accept = move || {
        let open = Arc::default();
        for (number, stream) in (0..).zip(listener.incoming()) {
            let Ok(stream) = stream else { continue };
            // Without this, a command may wait for a confirmation of the one before it.
            let _ = stream.set_nodelay(true);
            let Ok(write) = stream.try_clone() else { continue };
            connected(ClientId(number), (stream, write), (&tell, &open), &hello);
        }
    };
    thread::Builder::new().name("accept".into()).spawn(accept).map(|_| ())
}

/// An open connection, which counts towards the maximum.
struct Open(Arc<AtomicUsize>);

impl Open {
    /// Counts a connection; `None` if it is one too many.
    fn of(count: &Arc<AtomicUsize>) -> Option<Self> {
        // Only the thread that accepts connections adds to the count.
        let is_free = count.load(Ordering::Acquire) < MOST_CLIENTS;
        is_free.then(|| {
            count.fetch_add(1, Ordering::AcqRel);
            Self(count.clone())
        })
    }
}

impl Drop for Open {
    fn drop(&mut self) {
        self.0.fetch_sub(1, Ordering::AcqRel);
    }
}

/// Introduces the vehicle to a console that cannot be served, and states the reason.
fn refuse(mut write: impl Write, hello: &Hello) {
    let mut client = Writer::<FromVehicle>::new(FromSession::default());
    let text = Some(format!("{MOST_CLIENTS} consoles are already connected; close one of them"));
    let commander = Commander::OtherConsole;
    let state = State { stamp_s: 0.0, mode: Mode::Fault, text, battery: None, commander };
    let mut lines = Vec::new();
    for message in [FromVehicle::Hello(Box::new(hello.clone())), FromVehicle::State(state)] {
        if client.write(&message, &mut lines).is_err() {
            return;
        }
    }
    // The console may have left.
    let _ = write.write_all(&lines);
}

/// Serves one connection with two threads, which end with it.
fn connected(
    id: ClientId,
    (mut read, mut write): (impl Read + Send + 'static, impl Write + Send + 'static),
    (tell, count): (&Tell, &Arc<AtomicUsize>),
    hello: &Arc<Hello>,
) {
    let Some(open) = Open::of(count) else { return refuse(write, hello) };
    let (lines, waiting) = sync_channel::<Vec<u8>>(MOST_WAITING);
    let (tell, hello) = (tell.clone(), hello.clone());
    let writing = move || {
        for line in waiting {
            if write.write_all(&line).and_then(|()| write.flush()).is_err() {
                return;
            }
        }
    };
    let reading = move || {
        let _open = open;
        let mut reader = Reader::<ToVehicle>::new(ToSession::of((*hello).clone()));
        let mut buffer = vec![0; 1 << 14];
        if tell.send((id, Did::Joined(Client::new(lines)))).is_err() {
            return;
        }
        loop {
            let n = match read.read(&mut buffer) {
                Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
                Ok(0) | Err(_) => break,
                Ok(n) => n,
            };
            for heard in reader.read(&buffer[..n]) {
                if did(heard).is_some_and(|did| tell.send((id, did)).is_err()) {
                    return;
                }
            }
        }
        // The server may have ended.
        let _ = tell.send((id, Did::Left));
    };
    // A connection without its threads ends at once.
    if thread::Builder::new().name("write".into()).spawn(writing).is_ok() {
        let _ = thread::Builder::new().name("read".into()).spawn(reading);
    }
}

fn did(heard: Heard<ToVehicle>) -> Option<Did> {
    match heard {
        Heard::Message(message) => Some(Did::Said(message)),
        Heard::Malformed(misfit) => Some(Did::SaidWrong(misfit)),
        Heard::Unknown(_) => None,
    }
}

/// Consoles that use datagrams.
struct Datagrams {
    socket: Arc<UdpSocket>,
    tell: Tell,
    hello: Arc<Hello>,
    clients: BTreeMap<SocketAddr, Speaker>,
}

struct Speaker {
    id: ClientId,
    reader: Reader<ToVehicle>,
    heard_at: Instant,
    /// Whether it has given a command, and so has received the introduction.
    is_greeted: bool,
}

impl Datagrams {
    fn receive(mut self) {
        let (mut buffer, mut number) = (vec![0; 1 << 16], 0);
        loop {
            let received = self.socket.recv_from(&mut buffer);
            if self.drop_silent().is_none() {
                return;
            }
            let Ok((n, from)) = received else { continue };
            if !self.clients.contains_key(&from) {
                if self.clients.len() >= MOST_CLIENTS {
                    continue;
                }
                number += 1;
                let Some(()) = self.join(from, ClientId(number)) else { return };
            }
            let Some(()) = self.take(from, &buffer[..n]) else { return };
        }
    }

    /// Ends the connections that have been silent for long; `None` if the server has ended.
    fn drop_silent(&mut self) -> Option<()> {
        let silent = |speaker: &Speaker| speaker.heard_at.elapsed() > SILENT;
        for (_, speaker) in self.clients.extract_if(.., |_, speaker| silent(speaker)) {
            self.tell.send((speaker.id, Did::Left)).ok()?;
        }
        Some(())
    }

    fn join(&mut self, from: SocketAddr, id: ClientId) -> Option<()> {
        let (lines, waiting) = sync_channel::<Vec<u8>>(MOST_WAITING);
        let socket = self.socket.clone();
        let writing = move || {
            for line in waiting {
                // A datagram may get lost in any case.
                let _ = socket.send_to(&line, from);
            }
        };
        thread::Builder::new().name("write".into()).spawn(writing).ok()?;
        let reader = Reader::new(ToSession::of((*self.hello).clone()));
        self.clients.insert(from, Speaker { id, reader, heard_at: Instant::now(), is_greeted: false });
        self.tell.send((id, Did::Joined(Client::new(lines)))).ok()
    }

    /// Takes a datagram. Until the first command, each one is answered by the introduction, which may have got lost.
    fn take(&mut self, from: SocketAddr, bytes: &[u8]) -> Option<()> {
        let speaker = self.clients.get_mut(&from)?;
        speaker.heard_at = Instant::now();
        let mut heard = speaker.reader.read(bytes);
        if bytes.last() != Some(&b'\n') {
            heard.extend(speaker.reader.read(b"\n"));
        }
        for heard in heard {
            let is_command = matches!(heard, Heard::Message(ToVehicle::Drive(_) | ToVehicle::Stop(_)));
            speaker.is_greeted |= is_command;
            if !speaker.is_greeted {
                let mut line = Vec::new();
                let hello = FromVehicle::Hello(Box::new((*self.hello).clone()));
                if Writer::new(FromSession::default()).write(&hello, &mut line).is_ok() {
                    let _ = self.socket.send_to(&line, from);
                }
            }
            if let Some(did) = did(heard) {
                self.tell.send((speaker.id, did)).ok()?;
            }
        }
        Some(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::{BufRead, BufReader};

    #[test]
    fn a_file_that_is_not_a_socket_is_never_replaced() {
        let path = std::env::temp_dir().join(format!("tankops-server-{}", std::process::id()));
        std::fs::write(&path, "precious").unwrap();
        let why = unix(&path).unwrap_err().to_string();
        assert!(why.contains("not a socket"), "{why}");
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "precious");
        std::fs::remove_file(path).unwrap();
    }

    #[test]
    fn one_console_too_many_is_refused_with_the_reason() {
        let hello = r#"{"protocol": 1, "name": "robot", "motion": "unicycle", "limits": {"speed_m_per_s": 1, "turn_rad_per_s": 1, "acceleration_m_per_s2": 1, "radius_m": 0.2}, "period_s": 0.1, "stop_time_s": 0.5, "lease_max_s": 1}"#;
        let address = "tcp:127.0.0.1:0".parse().unwrap();
        let server = Server::listen(&address, serde_json::from_str(hello).unwrap(), false).unwrap();
        let Address::Tcp(at) = server.at() else { panic!("{}", server.at()) };
        let joined = || {
            let console = std::net::TcpStream::connect(at).unwrap();
            let (_, Did::Joined(client)) = server.next(Instant::now() + Duration::from_mins(2)).unwrap()
            else {
                panic!("it did not join")
            };
            (console, client)
        };
        let mut consoles: Vec<_> = (0..MOST_CLIENTS).map(|_| joined()).collect();
        let refused = BufReader::new(std::net::TcpStream::connect(at).unwrap());
        let lines: Vec<String> = refused.lines().map(Result::unwrap).collect();
        assert!(lines.len() == 2 && lines[1].contains("8 consoles are already connected"), "{lines:?}");
        consoles.pop();
        assert!(matches!(server.next(Instant::now() + Duration::from_mins(2)), Some((_, Did::Left))));
    }
}
