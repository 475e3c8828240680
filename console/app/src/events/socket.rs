//! `tankops events --socket`: the events of a run for other programs, over TCP.

use anyhow::Context;
use flight::failure::{COMPLETE, bad_input};
use remote::address::resolved;
use report::print::{say_line, warn_line};
use review::{Selection, StreamEnd, stream};
use runs::{Standing, standing};
use std::{
    io::ErrorKind,
    net::{SocketAddr, TcpListener, TcpStream},
    path::Path,
    process::ExitCode,
    thread,
    time::Duration,
};

/// The largest number of clients at a time.
const MOST_CLIENTS: usize = 16;
/// A client that takes no data for this time is disconnected.
const PATIENCE: Duration = Duration::from_secs(30);
/// The interval at which new clients and the end of the run are noticed.
const LOOK_AGAIN: Duration = Duration::from_millis(50);

/// Sends the selected events to each client until the run has ended and each client has received them.
pub(super) fn serve(
    (at, is_network_allowed): (&str, bool),
    folder: &Path,
    selection: &Selection,
    heartbeat: Duration,
) -> anyhow::Result<ExitCode> {
    if standing(folder) != Standing::Running {
        return Err(bad_input(format!(
            "{}: the run has ended; leave out --socket to print its events",
            folder.display()
        )));
    }
    let wrong = |error| bad_input(format!("--socket {}: {error}", foreign::plain(at)));
    let address = resolved(at, is_network_allowed, "--socket-network").map_err(wrong)?;
    let listener = TcpListener::bind(address).map_err(wrong)?;
    listener.set_nonblocking(true).context("preparing the socket")?;
    say_line(&format!("events of {} at tcp:{}", folder.display(), listener.local_addr()?))?;
    let to_client = |(client, from): (TcpStream, SocketAddr)| {
        let folder = folder.to_owned();
        let selection = selection.clone();
        let send = move || send(client, from, &folder, &selection, heartbeat);
        thread::Builder::new().name("client".into()).spawn(send).context("starting the thread of a client")
    };
    let mut clients = Vec::new();
    loop {
        let is_running = standing(folder) == Standing::Running;
        clients.retain(|client: &thread::JoinHandle<()>| !client.is_finished());
        match listener.accept() {
            Ok((_, from)) if clients.len() >= MOST_CLIENTS => {
                warn_line(&format!("{from}: refused, {MOST_CLIENTS} clients are connected"));
            }
            Ok(client) => clients.push(to_client(client)?),
            Err(error) if error.kind() != ErrorKind::WouldBlock => {
                warn_line(&format!("a client could not connect: {error}"));
            }
            Err(_) if !is_running && clients.is_empty() => return Ok(ExitCode::from(COMPLETE)),
            Err(_) => thread::sleep(LOOK_AGAIN),
        }
    }
}

/// Sends the events to one client.
fn send(client: TcpStream, from: SocketAddr, folder: &Path, selection: &Selection, heartbeat: Duration) {
    let prepared = client.set_nonblocking(false).and_then(|()| client.set_write_timeout(Some(PATIENCE)));
    let sent = match prepared {
        Ok(()) => stream(folder, selection, heartbeat, client).map_err(|error| error.to_string()),
        Err(error) => Err(error.to_string()),
    };
    match sent {
        // A client may leave at any time.
        Ok(StreamEnd::Closed(error))
            if matches!(error.kind(), ErrorKind::BrokenPipe | ErrorKind::ConnectionReset) => {}
        Ok(StreamEnd::Closed(error))
            if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) =>
        {
            warn_line(&format!("{from}: disconnected, it took no data for {} s", PATIENCE.as_secs()));
        }
        Ok(StreamEnd::Closed(error)) => warn_line(&format!("{from}: disconnected: {error}")),
        Ok(StreamEnd::Complete | StreamEnd::Incomplete(_)) => {}
        Err(why) => warn_line(&format!("{from}: disconnected: {why}")),
    }
}
