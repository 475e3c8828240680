//! An adapter with a small simulated robot: `--vehicle "run:target/release/disc"`. Replace `Disc` with your robot. The
//! robot runs in a separate process and keeps the lease, so it stops even if this adapter hangs or dies
//! (vehicle-protocol.md).

use serde_json::{Value, json};
use std::{
    error::Error,
    fs::File,
    io::{self, BufRead, BufReader, Read, Write},
    os::unix::process::CommandExt,
    process::{Command, Stdio, exit},
    sync::mpsc::{Receiver, RecvTimeoutError, channel, sync_channel},
    thread,
    time::{Duration, Instant},
};

const SPEED_M_PER_S: f64 = 0.4;
const TURN_RAD_PER_S: f64 = 1.0;
const ACCELERATION_M_PER_S2: f64 = 0.5;
const TURN_ACCELERATION_RAD_PER_S2: f64 = 2.0;
const RADIUS_M: f64 = 0.2;
const PERIOD: Duration = Duration::from_millis(20);
const LEASE_MAX_S: f64 = 0.5;
/// Maximum length of a line, bytes; a longer line stops the robot.
const LINE_MAX: u64 = 1 << 16;

fn hello() -> Value {
    json!({
        "type": "hello", "protocol": 1, "name": "disc", "motion": "unicycle",
        "limits": {
            "speed_m_per_s": SPEED_M_PER_S, "turn_rad_per_s": TURN_RAD_PER_S,
            "acceleration_m_per_s2": ACCELERATION_M_PER_S2, "radius_m": RADIUS_M
        },
        "has": {"odometry": true}, "period_s": PERIOD.as_secs_f64(), "stop_time_s": 0.9, "lease_max_s": LEASE_MAX_S
    })
}

/// The robot. Its motors follow the speeds exactly; a real robot must measure its motion instead of repeating the
/// speeds.
struct Disc;

impl Disc {
    /// Moves with a speed ahead and a turn rate for `dt_s` seconds; returns the measurements.
    fn measure(&mut self, v: f64, w: f64, dt_s: f64) -> Value {
        json!({"odometry": {"over_s": dt_s, "forward_m": v * dt_s, "turn_rad": w * dt_s}})
    }
}

/// A line to the robot's process.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Order {
    /// Speed ahead, turn rate, and duration in seconds.
    Drive(f64, f64, f64),
    /// The stamp of a ping; the robot answers, because its clock stamps the readings.
    Ping(f64),
}

const STAND: Order = Order::Drive(0.0, 0.0, 0.0);

impl Order {
    fn line(self) -> String {
        match self {
            Self::Drive(v, w, lease_s) => format!("drive {v} {w} {lease_s}\n"),
            Self::Ping(stamp_s) => format!("ping {stamp_s}\n"),
        }
    }

    /// A line that is not a valid order stops the robot.
    fn of(line: &str) -> Self {
        let (kind, values) = line.split_once(' ').unwrap_or_default();
        let values: Vec<f64> = values.split(' ').filter_map(|value| value.parse().ok()).collect();
        match (kind, &values[..]) {
            ("drive", [v, w, lease_s]) => Self::Drive(*v, *w, *lease_s),
            ("ping", [stamp_s]) => Self::Ping(*stamp_s),
            _ => STAND,
        }
    }
}

/// The robot's process: orders in, readings out. If the adapter dies, it runs until the robot stands still.
fn robot(orders: &Receiver<Order>, say: impl Fn(Value), mut log: Option<File>) {
    let began = Instant::now();
    let now_s = || began.elapsed().as_secs_f64();
    let (mut body, mut wanted, mut until) = (Disc, (0.0, 0.0), began);
    let (mut v, mut w, mut seq, mut has_adapter) = (0.0_f64, 0.0_f64, 0_u64, true);
    let mut before = began;
    while has_adapter || v != 0.0 || w != 0.0 {
        let wait = (before + PERIOD).saturating_duration_since(Instant::now());
        if has_adapter {
            match orders.recv_timeout(wait) {
                Ok(Order::Drive(v, w, lease_s)) => {
                    let lease = Duration::from_secs_f64(lease_s.clamp(0.0, LEASE_MAX_S));
                    (wanted, until) = ((v, w), Instant::now() + lease);
                }
                Ok(Order::Ping(echo_s)) => say(json!({"type": "pong", "echo_s": echo_s, "stamp_s": now_s()})),
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => (has_adapter, wanted) = (false, (0.0, 0.0)),
            }
        } else {
            thread::sleep(wait);
        }
        let now = Instant::now();
        if now < before + PERIOD {
            continue;
        }
        if now > until {
            wanted = (0.0, 0.0); // the lease has lapsed
        }
        let dt_s = (now - before).as_secs_f64();
        (before, seq) = (now, seq + 1);
        let toward = |speed: f64, to: f64, most: f64| speed + (to - speed).clamp(-most * dt_s, most * dt_s);
        v = toward(v, wanted.0, ACCELERATION_M_PER_S2);
        w = toward(w, wanted.1, TURN_ACCELERATION_RAD_PER_S2);
        let stamp_s = now_s();
        let mut readings = body.measure(v, w, dt_s);
        readings["type"] = json!("readings");
        readings["seq"] = json!(seq);
        readings["stamp_s"] = json!(stamp_s);
        say(readings);
        if let Some(log) = &mut log {
            let _ = writeln!(log, "{stamp_s} {v} {w}");
        }
        if seq % 25 == 0 {
            say(json!({"type": "state", "stamp_s": stamp_s, "mode": "ready"}));
        }
    }
}

fn robot_process() {
    let (tell, orders) = channel();
    thread::spawn(move || {
        for line in io::stdin().lines().map_while(Result::ok) {
            if tell.send(Order::of(&line)).is_err() {
                return;
            }
        }
    });
    // A separate thread writes, so that an adapter that reads nothing cannot keep the robot from checking its lease.
    let (lines, waiting) = sync_channel::<String>(256);
    thread::spawn(move || {
        for line in waiting {
            let mut out = io::stdout().lock();
            let _ = out.write_all(line.as_bytes()).and_then(|()| out.flush());
        }
    });
    let log = std::env::var_os("ROBOT_LOG")
        .and_then(|path| File::options().append(true).create(true).open(path).ok());
    robot(&orders, |message| drop(lines.try_send(format!("{message}\n"))), log);
}

/// The messages of the console so far.
struct Console {
    /// Greatest number of a command so far.
    newest: i64,
    /// Least time from a stamp to its arrival: the offset of the console's clock plus the shortest delay, seconds.
    least_s: f64,
}

/// Increase of the least time per message, seconds, so that it follows clocks that drift.
const DRIFT_S: f64 = 1e-4;

impl Console {
    fn new() -> Self {
        Self { newest: -1, least_s: f64::INFINITY }
    }

    /// Takes a line that arrives at a time of the adapter's clock; returns its order for the robot, if it has one. An
    /// error for a command that the robot must not carry out.
    fn take(&mut self, line: &str, now_s: f64) -> Result<Option<Order>, Box<dyn Error>> {
        let message: Value = serde_json::from_str(line)?;
        let number = |key: &str| message[key].as_f64().ok_or_else(|| format!("{key} is not a number"));
        let late_s = number("stamp_s").map(|stamp_s| now_s - stamp_s);
        if let Ok(late_s) = late_s {
            self.least_s = late_s.min(self.least_s + DRIFT_S);
        }
        match message["type"].as_str() {
            Some("ping") => return Ok(Some(Order::Ping(number("stamp_s")?))),
            Some("bye") => return Ok(Some(STAND)),
            Some("drive" | "stop") => {}
            Some(_) => return Ok(None),
            None => return Err("type is missing".into()),
        }
        let seq = message["seq"].as_i64().ok_or("seq is not a number")?;
        if seq <= self.newest {
            return Ok(None);
        }
        self.newest = seq;
        if message["type"] == "stop" {
            return Ok(Some(STAND));
        }
        let (v, w, lease_s) = (number("forward_m_per_s")?, number("turn_rad_per_s")?, number("lease_s")?);
        let sideways = message["sideways_m_per_s"].as_f64().unwrap_or(0.0);
        let fits = v.abs() <= SPEED_M_PER_S + 1e-9 && w.abs() <= TURN_RAD_PER_S + 1e-9 && sideways == 0.0;
        if !fits || lease_s <= 0.0 || lease_s > LEASE_MAX_S {
            return Err("beyond the limits".into());
        }
        // A command that waited while this adapter was stopped is older than its lease: the console may be gone.
        let is_current = late_s? - self.least_s <= lease_s;
        Ok(is_current.then_some(Order::Drive(v, w, lease_s)))
    }
}

fn say(message: &Value) {
    let mut out = io::stdout().lock();
    if out.write_all(format!("{message}\n").as_bytes()).and_then(|()| out.flush()).is_err() {
        exit(0); // the console has left; the robot stops when it reads the end of its orders
    }
}

/// The adapter: between the console (stdin, stdout) and the robot's process.
fn adapter() -> io::Result<()> {
    let mut robot = Command::new(std::env::current_exe()?)
        .arg("robot")
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .process_group(0)
        .spawn()?;
    let (Some(mut orders), Some(readings)) = (robot.stdin.take(), robot.stdout.take()) else {
        return Err(io::Error::other("the robot process has no stdin or stdout"));
    };
    say(&hello());
    thread::spawn(move || {
        let mut readings = BufReader::new(readings);
        let mut line = String::new();
        while readings.read_line(&mut line).is_ok_and(|n| n > 0) {
            let mut out = io::stdout().lock();
            if out.write_all(line.as_bytes()).and_then(|()| out.flush()).is_err() {
                exit(0);
            }
            line.clear();
        }
        eprintln!("the robot process has ended");
        exit(1);
    });
    let (began, mut console) = (Instant::now(), Console::new());
    let (mut input, mut line) = (BufReader::new(io::stdin()), Vec::new());
    while input.by_ref().take(LINE_MAX).read_until(b'\n', &mut line)? > 0 {
        let text = String::from_utf8_lossy(&line);
        let order = match console.take(text.trim(), began.elapsed().as_secs_f64()) {
            _ if text.trim().is_empty() => None,
            Ok(order) => order,
            Err(why) => {
                eprintln!("stopped by a bad line: {why}");
                Some(STAND)
            }
        };
        if let Some(order) = order {
            orders.write_all(order.line().as_bytes())?;
        }
        line.clear();
    }
    Ok(())
}

fn main() -> io::Result<()> {
    if std::env::args().nth(1).as_deref() == Some("robot") {
        robot_process();
        return Ok(());
    }
    adapter()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drive(seq: i64, v: f64) -> String {
        format!(
            r#"{{"type": "drive", "seq": {seq}, "stamp_s": {seq}, "lease_s": 0.25, "forward_m_per_s": {v}, "turn_rad_per_s": 0}}"#
        )
    }

    #[test]
    fn orders_are_read_as_they_are_written() {
        for order in [STAND, Order::Drive(-0.1, 0.25, 0.2), Order::Ping(1207.35)] {
            assert_eq!(Order::of(order.line().trim()), order);
        }
        assert_eq!(Order::of("drive 1 2"), STAND);
    }

    const DRIVE: Option<Order> = Some(Order::Drive(0.1, 0.0, 0.25));

    #[test]
    fn a_delayed_drive_does_not_undo_a_stop() {
        let mut console = Console::new();
        assert_eq!(console.take(r#"{"type": "stop", "seq": 7}"#, 7.0).unwrap(), Some(STAND));
        assert_eq!(console.take(&drive(7, 0.1), 7.0).unwrap(), None);
        assert_eq!(console.take(&drive(8, 0.1), 8.0).unwrap(), DRIVE);
    }

    #[test]
    fn a_drive_that_is_older_than_its_lease_is_ignored() {
        let mut console = Console::new();
        assert_eq!(console.take(&drive(1, 0.1), 501.0).unwrap(), DRIVE);
        assert_eq!(console.take(&drive(2, 0.1), 502.2).unwrap(), DRIVE, "0.2 s late");
        assert_eq!(console.take(&drive(3, 0.1), 530.0).unwrap(), None);
        assert_eq!(console.take(&drive(30, 0.1), 530.0).unwrap(), DRIVE);
    }

    #[test]
    fn a_command_that_is_none_is_an_error() {
        for bad in
            [drive(1, 0.5), drive(1, -0.5), "{}".into(), "[]".into(), drive(1, 0.1).replace("0.25", "9")]
        {
            assert!(Console::new().take(&bad, 0.0).is_err(), "{bad}");
        }
        let unstamped = drive(1, 0.1).replace("\"stamp_s\": 1, ", "");
        let why = Console::new().take(&unstamped, 0.0).unwrap_err();
        assert_eq!(why.to_string(), "stamp_s is not a number");
    }

    #[test]
    fn the_robot_stands_when_the_lease_lapses_and_ends_without_an_adapter() {
        let (tell, orders) = channel();
        let (said, readings) = channel();
        let robot = thread::spawn(move || robot(&orders, |message| drop(said.send(message)), None));
        tell.send(Order::Drive(0.2, 0.0, 0.1)).unwrap();
        let speed = |message: Value| message["odometry"]["forward_m"].as_f64();
        let mut speeds = readings.iter().filter_map(speed);
        assert!(speeds.any(|way_m| way_m > 0.0), "it moves");
        assert!(speeds.any(|way_m| way_m == 0.0), "it stands without another order");
        drop(tell);
        robot.join().unwrap();
    }
}
