//! The port to a vehicle behind an adapter.

use crate::{
    address::Address,
    began::Began,
    inbox::Inbox,
    outbox::Outbox,
    said::Said,
    stream::{End, Outgoing, Stream},
};
use geometry::Drive;
use std::{
    fmt,
    io::{self, Read},
    sync::{
        Arc, Mutex, MutexGuard, PoisonError,
        atomic::{AtomicBool, Ordering},
    },
    thread,
    time::{Duration, Instant},
};
use vehicle::{
    port::{Brake, CannotInject, Command, Live, Sensed, StationFault, Vehicle},
    wire::{FromSession, FromVehicle, Reader, ToSession, ToVehicle, Writer, message::Hello, message::Ping},
};
use world::{Station, Truth};

/// Longest time that an adapter may take to introduce the vehicle.
const HELLO_WITHIN: Duration = Duration::from_secs(10);
/// Interval at which the console checks for the introduction and, over datagrams, requests it.
const LOOK_AGAIN: Duration = Duration::from_millis(50);
/// Time limit for sending the last commands.
const LEAVE_WITHIN: Duration = Duration::from_millis(300);
/// Maximum number of bytes read at once.
const CHUNK_BYTES: usize = 1 << 16;

/// A vehicle behind an adapter process.
pub struct Remote {
    shared: Arc<Shared>,
    is_omni: bool,
    /// Ends the stream and, with it, both threads.
    _end: End,
}

struct Shared {
    inbox: Mutex<Inbox>,
    outbox: Outbox,
    began: Began,
    is_closing: AtomicBool,
    has_left: AtomicBool,
}

/// The reason why an adapter cannot be reached.
#[derive(Debug)]
pub struct ConnectError(String);

impl ConnectError {
    pub(crate) fn at(address: &Address, why: &dyn fmt::Display) -> Self {
        Self(format!("cannot drive the vehicle at {address}: {why}"))
    }
}

impl fmt::Display for ConnectError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for ConnectError {}

impl Shared {
    fn now_s(&self) -> f64 {
        self.began.elapsed_s()
    }

    fn inbox(&self) -> MutexGuard<'_, Inbox> {
        self.inbox.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Remote {
    /// Connects to an adapter, and waits for the introduction of its vehicle.
    ///
    /// # Errors
    /// The adapter cannot be reached, or does not introduce a vehicle that speaks this version of the protocol.
    pub fn connect(
        address: &Address,
        network: bool,
        stations: &[Station],
    ) -> Result<(Self, Hello), ConnectError> {
        let failed = |why: &dyn fmt::Display| ConnectError::at(address, why);
        let Stream { read, write, said, end } =
            Stream::open(address, network).map_err(|error| failed(&error))?;
        let stations = stations.iter().map(|station| (station.name.clone(), station.id)).collect();
        let shared = Arc::new(Shared {
            inbox: Mutex::new(Inbox::new(stations, address.to_string())),
            outbox: Outbox::default(),
            began: Began::now(),
            is_closing: AtomicBool::new(false),
            has_left: AtomicBool::new(false),
        });
        let (reading, is_of_datagrams) = (Arc::clone(&shared), matches!(address, Address::Udp(_)));
        let session = if is_of_datagrams { FromSession::of_datagrams() } else { FromSession::default() };
        let spawned = thread::Builder::new()
            .name("vehicle in".into())
            .spawn(move || read_all(read, session, &said, &reading));
        spawned.map_err(|error| failed(&error))?;
        let (hello, write) = greeted(&shared, address, write).map_err(|why| {
            // The thread that reads datagrams does not end by itself.
            shared.is_closing.store(true, Ordering::Release);
            failed(&why)
        })?;
        let (writing, session) = (Arc::clone(&shared), ToSession::of(hello.clone()));
        let spawned = thread::Builder::new()
            .name("vehicle out".into())
            .spawn(move || write_all(write, session, &writing));
        spawned.map_err(|error| failed(&error))?;
        let is_omni = hello.motion == vehicle::wire::message::MotionKind::Omni;
        Ok((Self { shared, is_omni, _end: end }, hello))
    }

    /// The number of readings that have arrived.
    pub fn heard(&self) -> u64 {
        self.shared.inbox().heard()
    }
}

/// A drive as speeds in the robot frame: metres per second ahead and to the left, radians per second.
pub(crate) fn motion(drive: Drive, heading_rad: f64, is_omni: bool) -> [f64; 3] {
    match drive {
        Drive::Twist { v_m_per_s, w_rad_per_s } => [v_m_per_s, 0.0, w_rad_per_s],
        Drive::Velocity(velocity) => {
            let (sin, cos) = heading_rad.sin_cos();
            let (ahead, left) = (velocity.x * cos + velocity.y * sin, velocity.y * cos - velocity.x * sin);
            [ahead, if is_omni { left } else { 0.0 }, 0.0]
        }
    }
}

impl Vehicle for Remote {
    fn sense(&mut self) -> Sensed {
        let now_s = self.shared.now_s();
        self.shared.inbox().sense(now_s)
    }

    fn act(&mut self, Command { drive, heading_rad, braking_orders }: Command) {
        let now_s = self.shared.now_s();
        let mut inbox = self.shared.inbox();
        inbox.awake(now_s);
        let drive = drive.filter(|_| inbox.may_drive());
        inbox.commanded(drive.is_some(), now_s);
        drop(inbox);
        let motion = drive.map(|drive| motion(drive, heading_rad, self.is_omni));
        self.shared.outbox.command(motion, braking_orders, now_s);
    }

    fn truth(&self) -> Option<Truth> {
        None
    }

    fn inject(&mut self, _: StationFault) -> Result<(), CannotInject> {
        Err(CannotInject)
    }

    fn is_standstill_known(&self) -> bool {
        self.shared.inbox().is_standstill_known()
    }

    fn settle(&mut self, waits: bool) -> Option<Live> {
        let is_open = || self.shared.inbox().closed().is_none();
        while waits && is_open() && self.shared.inbox().is_stopping(self.shared.now_s()) {
            // A datagram may get lost.
            self.shared.outbox.command(None, 0, self.shared.now_s());
            thread::sleep(LOOK_AGAIN);
        }
        let now_s = self.shared.now_s();
        Some(self.shared.inbox().settled(now_s))
    }

    fn brake(&self) -> Option<Brake> {
        let (shared, released) = (Arc::clone(&self.shared), Arc::clone(&self.shared));
        let pull = move || {
            // The stop leaves first: another thread may use the inbox.
            shared.outbox.brake();
            let now_s = shared.now_s();
            shared.inbox().commanded(false, now_s);
        };
        Some(Brake::new(pull, move || released.outbox.release()))
    }
}

impl Drop for Remote {
    /// Stops the vehicle and tells the adapter that the console leaves. If the adapter reads nothing, the vehicle stops
    /// when its lease lapses.
    fn drop(&mut self) {
        self.shared.outbox.command(None, 0, self.shared.now_s());
        self.shared.outbox.close();
        let began = Instant::now();
        while !self.shared.has_left.load(Ordering::Acquire) && began.elapsed() < LEAVE_WITHIN {
            thread::sleep(Duration::from_millis(2));
        }
        self.shared.is_closing.store(true, Ordering::Release);
    }
}

/// Waits for the introduction. Over datagrams, a ping announces the console to the adapter; the ping may get lost.
fn greeted(
    shared: &Shared,
    address: &Address,
    mut write: Box<dyn Outgoing>,
) -> Result<(Hello, Box<dyn Outgoing>), String> {
    let began = Instant::now();
    while began.elapsed() < HELLO_WITHIN {
        if matches!(address, Address::Udp(_)) {
            let ping = ToVehicle::Ping(Ping { stamp_s: shared.now_s() });
            if let Ok(line) = serde_json::to_vec(&ping) {
                // Before the introduction, the limits that a message must keep to are not known.
                let _ = write.write_all(&[line, b"\n".to_vec()].concat());
            }
        }
        let inbox = shared.inbox();
        if let Some(hello) = inbox.hello() {
            return Ok((hello.clone(), write));
        }
        if let Some(fault) = inbox.bad_hello() {
            return Err(format!("its introduction is malformed: {fault}"));
        }
        if let Some(why) = inbox.closed() {
            let fault = inbox.fault();
            let fault =
                if fault.is_empty() { String::new() } else { format!("; it sent a faulty line: {fault}") };
            return Err(format!("it did not introduce the vehicle: {why}{fault}"));
        }
        drop(inbox);
        thread::sleep(LOOK_AGAIN);
    }
    let inbox = shared.inbox();
    Err(match inbox.fault() {
        "" => format!("it did not introduce the vehicle within {} s", HELLO_WITHIN.as_secs()),
        fault => format!("it did not introduce the vehicle: {fault}"),
    })
}

fn read_all(mut read: Box<dyn Read + Send>, session: FromSession, said: &Said, shared: &Shared) {
    let mut reader = Reader::<FromVehicle>::new(session);
    let mut chunk = vec![0; CHUNK_BYTES];
    let why = loop {
        if shared.is_closing.load(Ordering::Acquire) {
            return;
        }
        match read.read(&mut chunk) {
            Ok(0) => break "the adapter ended the connection".to_owned(),
            Ok(n) => {
                let heard = reader.read(&chunk[..n]);
                let now_s = shared.now_s();
                let mut inbox = shared.inbox();
                for heard in heard {
                    inbox.take(heard, now_s);
                }
                inbox.stopped_in(reader.unfinished());
            }
            Err(error) => match error.kind() {
                io::ErrorKind::Interrupted | io::ErrorKind::WouldBlock | io::ErrorKind::TimedOut => {}
                _ => break format!("the link failed: {error}"),
            },
        }
    };
    if let Some(cut) = reader.finish() {
        shared.inbox().take(cut, shared.now_s());
    }
    let why = said.at_end().map_or(why.clone(), |text| format!("{why}; it wrote: {text}"));
    shared.inbox().close(why);
}

fn write_all(mut write: Box<dyn Outgoing>, session: ToSession, shared: &Shared) {
    let mut writer = Writer::<ToVehicle>::new(session);
    let (mut line, mut last_ping_s) = (Vec::new(), f64::NEG_INFINITY);
    loop {
        let message = shared.outbox.next(|| shared.now_s(), &mut last_ping_s);
        if matches!(message, ToVehicle::Drive(_)) && !write.has_room() {
            // The adapter has not read the motions before this one. A stop must not wait behind more of them.
            continue;
        }
        line.clear();
        if let Err(misfit) = writer.write(&message, &mut line) {
            // A command that does not fit the vehicle must not leave the one before it in effect.
            shared.inbox().close(format!("a command does not fit the vehicle: {misfit}"));
            shared.outbox.command(None, 0, shared.now_s());
            continue;
        }
        shared.inbox().sent(&message, shared.now_s());
        let is_last = matches!(message, ToVehicle::Bye(_));
        if let Err(error) = write.write_all(&line).and_then(|()| write.flush()) {
            shared.inbox().close(format!("the link failed: {error}"));
            break;
        }
        if is_last {
            break;
        }
    }
    shared.has_left.store(true, Ordering::Release);
}
