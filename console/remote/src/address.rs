//! The address of an adapter: `unix:PATH`, `tcp:HOST:PORT`, `udp:HOST:PORT`, `run:COMMAND`.

use std::{
    fmt, io,
    net::{SocketAddr, ToSocketAddrs},
    path::PathBuf,
    str::FromStr,
};

/// The address at which an adapter is reached, or at which a vehicle is offered.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Address {
    /// A Unix socket.
    Unix(PathBuf),
    /// A TCP connection.
    Tcp(String),
    /// UDP, with one message per datagram.
    Udp(String),
    /// A command, started by the shell, that speaks on its stdin and stdout.
    Run(String),
    /// The simulator behind the wire, in this process and without waiting; for tests.
    Loopback,
}

/// A text that is not an address.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NoAddress(String);

impl fmt::Display for NoAddress {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "`{}` is not a vehicle address; write unix:PATH, tcp:HOST:PORT, udp:HOST:PORT or run:COMMAND",
            self.0
        )
    }
}

impl std::error::Error for NoAddress {}

impl FromStr for Address {
    type Err = NoAddress;

    fn from_str(text: &str) -> Result<Self, NoAddress> {
        if text == "loopback" {
            return Ok(Self::Loopback);
        }
        let wrong = || NoAddress(foreign::plain(text).into_owned());
        let (kind, rest) = text.split_once(':').ok_or_else(wrong)?;
        let has_port = || {
            rest.rsplit_once(':').is_some_and(|(host, port)| !host.is_empty() && port.parse::<u16>().is_ok())
        };
        match kind {
            _ if rest.trim().is_empty() || foreign::unplain(rest).is_some() => Err(wrong()),
            "unix" => Ok(Self::Unix(rest.into())),
            "tcp" if has_port() => Ok(Self::Tcp(rest.into())),
            "udp" if has_port() => Ok(Self::Udp(rest.into())),
            "run" => Ok(Self::Run(rest.into())),
            _ => Err(wrong()),
        }
    }
}

impl fmt::Display for Address {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unix(path) => write!(f, "unix:{}", path.display()),
            Self::Tcp(at) => write!(f, "tcp:{at}"),
            Self::Udp(at) => write!(f, "udp:{at}"),
            Self::Run(command) => write!(f, "run:{command}"),
            Self::Loopback => f.write_str("loopback"),
        }
    }
}

/// The option that allows a vehicle on another machine.
pub(crate) const OPTION: &str = "--vehicle-network";

/// The socket address of a host and port. The wire has no protection of its own, so only addresses of this machine are
/// accepted, unless the whole network is allowed.
///
/// # Errors
/// The host is unknown, or is another machine; the error names the `option` that allows this.
pub fn resolved(at: &str, network: bool, option: &str) -> io::Result<SocketAddr> {
    let found = at.to_socket_addrs()?.next();
    let found = found.ok_or_else(|| io::Error::new(io::ErrorKind::NotFound, "the host has no address"))?;
    if network || found.ip().is_loopback() {
        return Ok(found);
    }
    Err(io::Error::new(
        io::ErrorKind::PermissionDenied,
        format!("the address is on another machine, and the wire is not protected; `{option}` allows this"),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_are_read_as_they_are_written() {
        for text in
            ["loopback", "unix:robot.sock", "tcp:localhost:4710", "udp:127.0.0.1:1", "run:python3 adapter.py"]
        {
            assert_eq!(text.parse::<Address>().unwrap().to_string(), text);
        }
        for text in
            ["", "tcp:", "tcp:localhost", "tcp:localhost:70000", "serial:/dev/tty", "run: ", "unix:a\u{1b}b"]
        {
            assert!(text.parse::<Address>().is_err(), "{text}");
        }
    }

    #[test]
    fn other_machines_need_the_option() {
        assert!(resolved("127.0.0.1:9", false, "--on").is_ok());
        assert_eq!(
            resolved("192.0.2.1:9", false, "--on").unwrap_err().kind(),
            io::ErrorKind::PermissionDenied
        );
        assert!(resolved("192.0.2.1:9", true, "--on").is_ok());
    }
}
