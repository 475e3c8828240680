//! The adapter without its sockets: it receives messages from the console and the rover, and returns messages to both.

mod condition;
mod joined;
#[cfg(test)]
mod tests;

use crate::{
    config::{Config, PoseFrom},
    convert,
};
use condition::Condition;
use joined::Joined;
use mavlink::{
    MavHeader,
    dialects::common::{
        COMMAND_LONG_DATA, HEARTBEAT_DATA, MavAutopilot, MavCmd, MavMessage, MavModeFlag, MavState, MavType,
        NAMED_VALUE_FLOAT_DATA,
    },
};
use tankops_adapter::{
    clock::{Clock, is_newer},
    message::{FromVehicle, Pose, Tether},
    pilot::{Order, Pilot},
    readings::{Assembly, Measured},
};

/// An input to the adapter.
#[derive(Debug, Clone)]
pub(crate) enum Input {
    /// A line from the console; `None` at the end of the connection.
    Console(Option<String>),
    /// A MAVLink message.
    Message(MavHeader, Box<MavMessage>),
    /// Only time has passed.
    Tick,
}

/// An output of the adapter, which the shell carries out.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Output {
    /// A message to the console.
    Say(FromVehicle),
    /// A message to the rover.
    Send(Box<MavMessage>),
    /// A text for standard error.
    Note(String),
    /// The adapter ends.
    End,
}

/// Time between two heartbeats of the adapter, seconds.
const HEARTBEAT_S: f64 = 1.0;
/// Number of heartbeats between two requests for the rates of messages; requests are repeated because they may get
/// lost.
const REQUEST_EVERY: u32 = 5;

/// The adapter's state.
pub(crate) struct Bridge {
    config: Config,
    pilot: Pilot,
    clock: Clock,
    readings: Assembly,
    condition: Condition,
    /// The newest pose and its time, until the pose is sent; before the introduction, no readings are sent.
    pose: Option<(Pose, Measured)>,
    joined: Joined,
    /// Stamps of the newest pose and of the newest ranges, seconds of the rover's clock.
    newest_s: Option<f64>,
    ranges_s: Option<f64>,
    beats_s: f64,
    beats: u32,
}

impl Bridge {
    /// Creates an adapter that has not received any message yet.
    pub(crate) fn new(config: Config, now_s: f64) -> Self {
        Self {
            pilot: Pilot::new(&config.vehicle, config.has(), config.command_period_s, now_s),
            clock: Clock::default(),
            readings: Assembly::new(config.vehicle.period_s),
            condition: Condition::new(config.scan),
            pose: None,
            joined: Joined::default(),
            newest_s: None,
            ranges_s: None,
            beats_s: now_s,
            beats: 0,
            config,
        }
    }

    /// The time at which the bridge must be called at the latest.
    pub(crate) fn wakes_s(&self) -> f64 {
        self.pilot.wakes_s().min(self.beats_s)
    }

    /// Processes an input, and returns the messages to send.
    pub(crate) fn take(&mut self, input: Input, now_s: f64) -> Vec<Output> {
        let mut orders = Vec::new();
        match input {
            Input::Console(line) => self.pilot.hear(line.as_deref(), now_s, &mut orders),
            Input::Message(header, message) => self.message(header, *message, now_s),
            Input::Tick => {}
        }
        self.pilot.act(self.condition.state(now_s), now_s, &mut orders);
        if let Some((pose, time)) = self.pose.take_if(|_| self.pilot.has_greeted()) {
            orders.extend(self.readings.pose(pose, time).map(FromVehicle::Readings).map(Order::Say));
        }
        let mut out: Vec<Output> = orders.into_iter().filter_map(|order| self.output(order, now_s)).collect();
        self.beat(now_s, &mut out);
        out
    }

    fn output(&self, order: Order, now_s: f64) -> Option<Output> {
        match order {
            Order::Say(message) => Some(Output::Say(message)),
            Order::Move(velocity) => {
                // The counter of milliseconds starts again after 49 days.
                let time_boot_ms = (now_s * 1e3) as u64 as u32;
                Some(Output::Send(Box::new(convert::command(velocity, &self.config, time_boot_ms))))
            }
            // In mode GUIDED, MAVLink has no way to stop except zero velocity, which is sent together with this order.
            Order::Halt => None,
            Order::Note(text) => Some(Output::Note(text)),
            Order::End => Some(Output::End),
        }
    }

    /// Sends the adapter's heartbeat. A rover can be set up to hold when its ground station falls silent.
    fn beat(&mut self, now_s: f64, out: &mut Vec<Output>) {
        if now_s < self.beats_s {
            return;
        }
        self.beats_s = now_s + HEARTBEAT_S;
        out.push(Output::Send(Box::new(MavMessage::HEARTBEAT(HEARTBEAT_DATA {
            mavtype: MavType::MAV_TYPE_GCS,
            autopilot: MavAutopilot::MAV_AUTOPILOT_INVALID,
            base_mode: MavModeFlag::empty(),
            system_status: MavState::MAV_STATE_ACTIVE,
            mavlink_version: 3,
            custom_mode: 0,
        }))));
        if self.beats.is_multiple_of(REQUEST_EVERY) {
            let requests = self.wanted().iter().map(|id| self.request(*id));
            out.extend(requests.map(Box::new).map(Output::Send));
        }
        self.beats = self.beats.wrapping_add(1);
    }

    /// The numbers of the messages that contain the poses.
    fn wanted(&self) -> &'static [f32] {
        match self.config.pose {
            PoseFrom::LocalPosition => &[32.0, 30.0],
            PoseFrom::Odometry => &[331.0],
        }
    }

    fn request(&self, id: f32) -> MavMessage {
        MavMessage::COMMAND_LONG(COMMAND_LONG_DATA {
            param1: id,
            param2: (self.config.vehicle.period_s * 1e6) as f32,
            command: MavCmd::MAV_CMD_SET_MESSAGE_INTERVAL,
            target_system: self.config.rover.system,
            target_component: self.config.rover.component,
            ..COMMAND_LONG_DATA::default()
        })
    }

    fn message(&mut self, from: MavHeader, message: MavMessage, now_s: f64) {
        let rover = self.config.rover;
        if from.system_id != u32::from(rover.system) {
            self.other(from, &message, now_s);
            return;
        }
        match message {
            MavMessage::HEARTBEAT(beat) if from.component_id == rover.component => {
                self.condition.heartbeat(&beat, now_s);
            }
            MavMessage::BATTERY_STATUS(battery) => {
                let charge = battery.battery_remaining;
                self.condition.battery = (0..=100).contains(&charge).then(|| f64::from(charge) / 100.0);
            }
            MavMessage::ATTITUDE(at) if from.component_id == rover.component => {
                let stamp_s = f64::from(at.time_boot_ms) / 1e3;
                let heading = convert::heading(at.yaw);
                let Some(heading_rad) = self.right("ATTITUDE", heading, now_s) else { return };
                self.joined.heading(heading_rad, stamp_s);
                self.join(now_s);
            }
            MavMessage::LOCAL_POSITION_NED(at) if self.config.pose == PoseFrom::LocalPosition => {
                let stamp_s = f64::from(at.time_boot_ms) / 1e3;
                let position = convert::pose(at.x, at.y, 0.0);
                let Some(position) = self.right("LOCAL_POSITION_NED", position, now_s) else { return };
                self.joined.position(position, stamp_s);
                self.join(now_s);
            }
            MavMessage::ODOMETRY(at) if self.config.pose == PoseFrom::Odometry => {
                let pose = convert::yaw(at.q).and_then(|yaw| convert::pose(at.x, at.y, yaw));
                let Some(pose) = self.right("ODOMETRY", pose, now_s) else { return };
                self.pose(pose, seconds(at.time_usec).unwrap_or(now_s), now_s);
            }
            MavMessage::OBSTACLE_DISTANCE(sectors) if self.config.scan => {
                let scan = convert::scan(&sectors);
                let Some(scan) = self.right("OBSTACLE_DISTANCE", scan, now_s) else { return };
                self.condition.scan(self.readings.scan(scan, seconds(sectors.time_usec)), now_s);
            }
            MavMessage::DEBUG_FLOAT_ARRAY(array) => {
                let Some(ranging) = &self.config.ae else { return };
                if array.name.to_str() == Ok(&ranging.name) {
                    let stamp_s = seconds(array.time_usec);
                    // A duplicate must not count twice.
                    if stamp_s.is_some_and(|stamp_s| !is_newer(stamp_s, self.ranges_s)) {
                        return;
                    }
                    self.ranges_s = stamp_s;
                    let part = convert::ranges(&array, ranging);
                    self.readings.parts.ae = self.right("DEBUG_FLOAT_ARRAY", part, now_s);
                }
            }
            MavMessage::NAMED_VALUE_FLOAT(named) => self.named(&named, now_s),
            _ => {}
        }
    }

    /// Takes a message of a third participant, which a router has passed on; only commands of another ground station
    /// matter.
    fn other(&mut self, from: MavHeader, message: &MavMessage, now_s: f64) {
        let is_command = matches!(
            message,
            MavMessage::SET_POSITION_TARGET_LOCAL_NED(_)
                | MavMessage::SET_POSITION_TARGET_GLOBAL_INT(_)
                | MavMessage::SET_ATTITUDE_TARGET(_)
                | MavMessage::MANUAL_CONTROL(_)
                | MavMessage::RC_CHANNELS_OVERRIDE(_)
        );
        if is_command && from.system_id != u32::from(self.config.own.system) {
            self.condition.other_command = Some((from.system_id, now_s));
        }
    }

    /// Takes the pose that the newest position and the newest attitude make.
    fn join(&mut self, now_s: f64) {
        if let Some((pose, stamp_s)) = self.joined.take() {
            self.pose(pose, stamp_s, now_s);
        }
    }

    fn pose(&mut self, pose: Pose, stamp_s: f64, now_s: f64) {
        // A pose that a later one has overtaken is contained in the later one.
        if !is_newer(stamp_s, self.newest_s) {
            return;
        }
        self.newest_s = Some(stamp_s);
        self.condition.pose_s = Some(now_s);
        let at_s = self.clock.measured_s(Some(stamp_s), now_s);
        self.pose = Some((pose, Measured { stamp_s, at_s }));
    }

    fn named(&mut self, named: &NAMED_VALUE_FLOAT_DATA, now_s: f64) {
        let Ok(name) = named.name.to_str() else { return };
        let value = f64::from(named.value);
        let is = |of: &Option<String>| of.as_deref() == Some(name);
        if is(&self.config.tether) {
            let part = if (0.0..=1e4).contains(&value) {
                Ok(Tether { paid_out_m: value })
            } else {
                Err(format!("{name}: {value} is not a length"))
            };
            self.readings.parts.tether = self.right("NAMED_VALUE_FLOAT", part, now_s);
        } else if is(&self.config.contact) {
            let parts = &mut self.readings.parts;
            parts.contact = Some(parts.contact.unwrap_or(false) || value != 0.0);
        }
    }

    /// The part of a message; `None` if the message is invalid.
    fn right<T>(&mut self, kind: &str, part: Result<T, String>, now_s: f64) -> Option<T> {
        part.map_err(|why| self.condition.trouble(format!("{kind}: {why}"), now_s)).ok()
    }
}

/// A stamp in microseconds as seconds; `None` for 0, which stands for a message without a stamp.
fn seconds(time_usec: u64) -> Option<f64> {
    (time_usec > 0).then(|| time_usec as f64 / 1e6)
}
