//! A connection for a trial: every message with the time of its arrival, and commands that are sent one by one.

use super::log::RobotLog;
use crate::{
    address::Address,
    remote::ConnectError,
    stream::{End, Stream},
};
use std::{
    io::{ErrorKind, Read, Write},
    sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel},
    thread,
    time::{Duration, Instant},
};
use vehicle::{
    link::{Clock, Motions, Sequence},
    port::LEASE_S,
    trial::{Listened, Sample},
    wire::{
        FromSession, FromVehicle, Heard, Misfit, Reader, ToSession, ToVehicle, Unknown, Writer,
        message::{Bye, Drive, Hello, Odometry, Ping, Pose, Readings, Stop},
    },
};

/// Longest time that an adapter may take to introduce the vehicle.
const HELLO_WITHIN: Duration = Duration::from_secs(10);
/// Interval at which an awaited condition is checked.
const LOOK_AGAIN: Duration = Duration::from_millis(50);
const PING_EVERY: Duration = Duration::from_millis(250);
/// Maximum number of pieces of input that wait to be processed; a faster adapter must wait.
const MOST_WAITING: usize = 4096;
/// Maximum number of readings kept.
const MOST_KEPT: usize = 100_000;

/// Input from the adapter with its time of arrival, seconds; `Err` at the end of the stream. A reader of datagrams
/// sends empty pieces, too, to notice when the connection has been dropped.
type Piece = (f64, Result<Vec<Heard<FromVehicle>>, String>);

/// A connection to an adapter.
pub(super) struct Connection {
    hello: Hello,
    write: Option<(Box<dyn Write + Send>, Writer<ToVehicle>)>,
    pieces: Receiver<Piece>,
    began: Instant,
    ping_due: Instant,
    seq: u64,
    clock: Clock,
    motions: Motions,
    sequence: Sequence,
    /// The motion since [`Connection::forget`], by odometry and by pose separately.
    pub odometry: Vec<Odometry>,
    pub poses: Vec<Pose>,
    pub heard: Listened,
    closed: Option<String>,
    pub end: End,
    /// The log of a robot whose adapter was started here; `None` if no log can be written.
    pub log: Option<RobotLog>,
}

impl Connection {
    /// Connects, and waits for the introduction. An adapter that is started here receives the name of its log.
    pub(super) fn open(address: &Address, network: bool) -> Result<Self, ConnectError> {
        let log = RobotLog::new().ok();
        let failed = |why: String| ConnectError::at(address, &why);
        let address = &log.as_ref().map_or_else(|| address.clone(), |log| log.named_to(address));
        let Stream { read, mut write, said, end } =
            Stream::open(address, network).map_err(|error| failed(error.to_string()))?;
        let (tell, pieces) = sync_channel(MOST_WAITING);
        let began = Instant::now();
        let spawned =
            thread::Builder::new().name("vehicle in".into()).spawn(move || read_all(read, began, &tell));
        spawned.map_err(|error| failed(error.to_string()))?;
        let mut fault = String::new();
        while began.elapsed() < HELLO_WITHIN {
            if matches!(address, Address::Udp(_)) {
                // Over datagrams, a ping announces this console to the adapter.
                let _ = write.write_all(b"{\"type\": \"ping\", \"stamp_s\": 0}\n");
            }
            match pieces.recv_timeout(LOOK_AGAIN) {
                Ok((arrival_s, Ok(heard))) => {
                    let mut heard = heard.into_iter();
                    while let Some(one) = heard.next() {
                        match one {
                            Heard::Message(FromVehicle::Hello(hello)) => {
                                let mut connection = Self::of(*hello, write, pieces, began, end);
                                connection.log = log;
                                heard.for_each(|more| connection.take(arrival_s, more));
                                return Ok(connection);
                            }
                            Heard::Malformed(misfit) => fault = format!("; it sent a faulty line: {misfit}"),
                            Heard::Message(_) | Heard::Unknown(_) => {}
                        }
                    }
                }
                Ok((_, Err(why))) => {
                    let wrote = said.at_end().map(|text| format!("; it wrote: {text}")).unwrap_or_default();
                    return Err(failed(format!("it did not introduce the vehicle: {why}{fault}{wrote}")));
                }
                Err(_) => {}
            }
        }
        Err(failed(format!("it did not introduce the vehicle within {} s{fault}", HELLO_WITHIN.as_secs())))
    }

    fn of(
        hello: Hello,
        write: Box<dyn Write + Send>,
        pieces: Receiver<Piece>,
        began: Instant,
        end: End,
    ) -> Self {
        Self {
            write: Some((write, Writer::new(ToSession::of(hello.clone())))),
            hello,
            pieces,
            began,
            ping_due: Instant::now(),
            seq: 0,
            clock: Clock::default(),
            motions: Motions::default(),
            sequence: Sequence::default(),
            odometry: Vec::new(),
            poses: Vec::new(),
            heard: Listened::default(),
            closed: None,
            end,
            log: None,
        }
    }

    pub(super) fn hello(&self) -> &Hello {
        &self.hello
    }

    pub(super) fn now_s(&self) -> f64 {
        self.began.elapsed().as_secs_f64()
    }

    /// The reason why the connection ended, once it has.
    pub(super) fn closed(&self) -> Option<&str> {
        self.closed.as_deref()
    }

    /// The current time on the vehicle's clock; `None` until the offset of that clock is known.
    pub(super) fn vehicle_now_s(&self) -> Option<f64> {
        let now_s = self.now_s();
        let by_pings = self.clock.at(now_s).map(|offset| now_s + offset.offset_s);
        by_pings.or_else(|| {
            let (arrival_s, readings) = self.heard.readings.last()?;
            Some(readings.stamp_s + now_s - arrival_s)
        })
    }

    /// Greatest error of [`Connection::vehicle_now_s`], seconds.
    pub(super) fn clock_error_s(&self) -> f64 {
        self.clock.at(self.now_s()).map_or(self.hello.period_s, |offset| offset.bound_s)
    }

    /// Waits for the first readings: a robot may start slowly.
    pub(super) fn await_readings(&mut self, is_stopped: &dyn Fn() -> bool) {
        let until = Instant::now() + HELLO_WITHIN;
        while self.heard.readings.is_empty() && Instant::now() < until && !is_stopped() {
            self.take_until(Instant::now() + LOOK_AGAIN);
            if self.closed.is_some() {
                return;
            }
        }
    }

    /// Listens without commanding the vehicle.
    pub(super) fn listen(&mut self, time: Duration, is_stopped: &dyn Fn() -> bool) -> Listened {
        let until = Instant::now() + time;
        while Instant::now() < until && self.closed.is_none() && !is_stopped() {
            self.take_until((Instant::now() + PING_EVERY).min(until));
        }
        self.heard.offset = self.clock.at(self.now_s());
        self.heard.rates = self.clock.rates().clone();
        self.heard.clone()
    }

    /// Drops all readings received so far.
    pub(super) fn forget(&mut self) {
        let (state, lines) = (self.heard.state.take(), std::mem::take(&mut self.heard.lines));
        self.heard = Listened { state, lines, ..Listened::default() };
        (self.odometry, self.poses) = (Vec::new(), self.poses.last().copied().into_iter().collect());
    }

    /// Takes the messages that arrive until a moment, and sends the pings that are due.
    pub(super) fn take_until(&mut self, until: Instant) {
        loop {
            if Instant::now() >= self.ping_due {
                self.ping_due = Instant::now() + PING_EVERY;
                self.heard.pings += 1;
                self.send(&ToVehicle::Ping(Ping { stamp_s: self.now_s() }));
            }
            let wait = until.min(self.ping_due).saturating_duration_since(Instant::now());
            match self.pieces.recv_timeout(wait) {
                Ok((arrival_s, Ok(heard))) => heard.into_iter().for_each(|one| self.take(arrival_s, one)),
                Ok((_, Err(why))) => {
                    self.closed.get_or_insert(why);
                }
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => thread::sleep(wait),
            }
            if Instant::now() >= until {
                return;
            }
        }
    }

    fn take(&mut self, arrival_s: f64, heard: Heard<FromVehicle>) {
        match heard {
            Heard::Message(FromVehicle::Readings(readings)) => self.read(arrival_s, &readings),
            Heard::Message(FromVehicle::State(state)) => self.heard.state = Some(state),
            Heard::Message(FromVehicle::Pong(pong)) => match self.clock.pong(&pong, arrival_s) {
                Ok(()) => self.heard.trips_s.push((arrival_s - pong.echo_s).max(0.0)),
                Err(misfit) => self.malformed(&misfit),
            },
            Heard::Message(FromVehicle::Hello(_)) => {}
            Heard::Unknown(Unknown::Kind(name) | Unknown::Key { key: name, .. }) => {
                self.heard.lines.unknown.push(foreign::plain(&name).into_owned());
            }
            Heard::Malformed(misfit) => self.malformed(&misfit),
        }
    }

    fn malformed(&mut self, misfit: &Misfit) {
        self.heard.lines.malformed += 1;
        self.heard.lines.fault.get_or_insert_with(|| foreign::plain(&misfit.to_string()).into_owned());
    }

    fn read(&mut self, arrival_s: f64, readings: &Readings) {
        if self.heard.readings.len() >= MOST_KEPT {
            return;
        }
        self.heard.readings.push((arrival_s, readings.clone()));
        if !self.sequence.add(readings.seq) {
            return;
        }
        self.clock.stamp(arrival_s, readings.stamp_s);
        self.odometry.extend(readings.odometry);
        self.poses.extend(readings.pose);
        if let Some(Odometry { over_s, forward_m, sideways_m, turn_rad }) = self.motions.take(readings) {
            let way_m = forward_m.hypot(sideways_m);
            self.heard.samples.push(Sample { t_s: readings.stamp_s, over_s, way_m, turn_rad });
        }
    }

    /// Sends a motion with the lease that a mission uses.
    pub(super) fn drive(&mut self, forward_m_per_s: f64, turn_rad_per_s: f64) {
        self.seq += 1;
        let lease_s = LEASE_S.min(self.hello.lease_max_s);
        let (seq, stamp_s) = (self.seq, self.now_s());
        let drive = Drive { seq, stamp_s, lease_s, forward_m_per_s, sideways_m_per_s: 0.0, turn_rad_per_s };
        self.send(&ToVehicle::Drive(drive));
    }

    pub(super) fn stop(&mut self) {
        self.seq += 1;
        self.send(&ToVehicle::Stop(Stop { seq: self.seq, stamp_s: self.now_s() }));
    }

    /// Closes the direction to the adapter. A process then reads the end of its stdin.
    pub(super) fn close_write(&mut self) {
        self.write = None;
    }

    fn send(&mut self, message: &ToVehicle) {
        let Some((write, writer)) = &mut self.write else { return };
        let mut line = Vec::new();
        let sent = match writer.write(message, &mut line) {
            Ok(()) => write.write_all(&line).and_then(|()| write.flush()).map_err(|error| error.to_string()),
            Err(misfit) => Err(misfit.to_string()),
        };
        if let Err(why) = sent {
            self.closed.get_or_insert(why);
        }
    }

    /// Stops the vehicle and ends the connection.
    pub(super) fn leave(mut self) {
        self.stop();
        self.send(&ToVehicle::Bye(Bye::default()));
    }
}

fn read_all(mut read: Box<dyn Read + Send>, began: Instant, tell: &SyncSender<Piece>) {
    let mut reader = Reader::<FromVehicle>::new(FromSession::default());
    let mut chunk = vec![0; 1 << 16];
    loop {
        let piece = match read.read(&mut chunk) {
            Ok(0) => Err("the adapter ended the connection".to_owned()),
            Ok(n) => Ok(reader.read(&chunk[..n])),
            Err(error) => match error.kind() {
                ErrorKind::Interrupted | ErrorKind::WouldBlock | ErrorKind::TimedOut => Ok(Vec::new()),
                _ => Err(format!("the link failed: {error}")),
            },
        };
        let is_end = piece.is_err();
        // If the connection was dropped, the receiver is gone.
        if tell.send((began.elapsed().as_secs_f64(), piece)).is_err() || is_end {
            return;
        }
    }
}
