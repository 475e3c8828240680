//! The condition of the rover, which determines whether it can be driven.

use mavlink::dialects::common::{HEARTBEAT_DATA, MavModeFlag, MavState};
use tankops_adapter::message::{Commander, Mode, State};

/// Longest time between two heartbeats, seconds: three in a row may be lost.
const HEARTBEAT_MAX_AGE_S: f64 = 4.5;
/// Age of the newest pose, seconds, above which the vehicle is in the mode `fault`.
const POSE_MAX_AGE_S: f64 = 1.0;
/// Age of the newest scan, seconds, above which a rover that scans is in the mode `fault`.
const SCAN_MAX_AGE_S: f64 = 1.0;
/// Time for which an invalid message, or a command of another ground station, counts as a fault, seconds.
const FAULT_FOR_S: f64 = 2.0;

/// The mode in which ArduRover obeys velocities.
const GUIDED: u32 = 15;
/// The other modes of ArduRover.
const MODES: [(u32, &str); 15] = [
    (0, "MANUAL"),
    (1, "ACRO"),
    (3, "STEERING"),
    (4, "HOLD"),
    (5, "LOITER"),
    (6, "FOLLOW"),
    (7, "SIMPLE"),
    (8, "DOCK"),
    (9, "CIRCLE"),
    (10, "AUTO"),
    (11, "RTL"),
    (12, "SMART_RTL"),
    (GUIDED, "GUIDED"),
    (16, "INITIALISING"),
    (2, "LEARNING"),
];
/// The modes in which a person drives.
const MANUAL: [u32; 4] = [0, 1, 3, 7];

/// The condition of the rover.
#[derive(Debug, Clone, Default)]
pub(super) struct Condition {
    /// Arrival of the newest pose.
    pub(super) pose_s: Option<f64>,
    /// Whether the rover is expected to scan.
    has_scan: bool,
    /// Arrival of the newest scan, and why a later one could not be used.
    scan_s: Option<f64>,
    scan_trouble: Option<String>,
    /// Charge, 0 to 1.
    pub(super) battery: Option<f64>,
    /// System number and time of the newest command of another ground station.
    pub(super) other_command: Option<(u32, f64)>,
    heartbeat: Option<Heartbeat>,
    /// The fault of the last invalid message, and the time until which it counts.
    trouble: Option<(String, f64)>,
}

#[derive(Debug, Clone, Copy)]
struct Heartbeat {
    arrived_s: f64,
    mode: u32,
    is_armed: bool,
    system: MavState,
}

impl Condition {
    /// The condition before any message has arrived.
    pub(super) fn new(has_scan: bool) -> Self {
        Self { has_scan, ..Self::default() }
    }

    /// Takes a heartbeat of the rover's autopilot.
    pub(super) fn heartbeat(&mut self, beat: &HEARTBEAT_DATA, now_s: f64) {
        self.heartbeat = Some(Heartbeat {
            arrived_s: now_s,
            mode: beat.custom_mode,
            is_armed: beat.base_mode.contains(MavModeFlag::MAV_MODE_FLAG_SAFETY_ARMED),
            system: beat.system_status,
        });
    }

    /// Takes the fault of an invalid message.
    pub(super) fn trouble(&mut self, why: String, now_s: f64) {
        self.trouble = Some((why, now_s + FAULT_FOR_S));
    }

    /// Takes the arrival of a scan, or the reason why it could not be used.
    pub(super) fn scan(&mut self, taken: Result<(), String>, now_s: f64) {
        if taken.is_ok() {
            self.scan_s = Some(now_s);
        }
        self.scan_trouble = taken.err();
    }

    /// The state to send.
    pub(super) fn state(&self, now_s: f64) -> State {
        let other = self.other_command.filter(|(_, at_s)| now_s - at_s < FAULT_FOR_S);
        let (mode, text) = match self.mode(other.map(|(system, _)| system), now_s) {
            Ok(()) => (Mode::Ready, None),
            Err((mode, why)) => (mode, Some(why)),
        };
        let commander = if other.is_some() { Commander::OtherProgram } else { Commander::You };
        State { stamp_s: now_s, mode, text, battery: self.battery, commander }
    }

    fn mode(&self, other: Option<u32>, now_s: f64) -> Result<(), (Mode, String)> {
        let fault = |why: String| Err((Mode::Fault, why));
        let is_alive = |beat: &Heartbeat| now_s - beat.arrived_s <= HEARTBEAT_MAX_AGE_S;
        let Some(beat) = self.heartbeat.filter(is_alive) else {
            return fault(
                "no heartbeat of the rover is arriving: check the address and the system number".to_owned(),
            );
        };
        if MANUAL.contains(&beat.mode) {
            return Err((Mode::Manual, format!("mode {}", name(beat.mode))));
        }
        if let Some(system) = other {
            return fault(format!("ground station {system} is commanding the rover, too"));
        }
        if beat.mode != GUIDED {
            return fault(format!("the rover is in mode {}; switch it to GUIDED", name(beat.mode)));
        }
        if !beat.is_armed {
            return fault("the rover is disarmed; arm it".to_owned());
        }
        if !matches!(beat.system, MavState::MAV_STATE_ACTIVE | MavState::MAV_STATE_STANDBY) {
            return fault(format!("the autopilot reports {:?}", beat.system));
        }
        if let Some((why, _)) = self.trouble.as_ref().filter(|(_, until_s)| now_s < *until_s) {
            return fault(why.clone());
        }
        if self.pose_s.is_none_or(|pose_s| now_s - pose_s > POSE_MAX_AGE_S) {
            return fault("no pose is arriving: check the rates of its messages".to_owned());
        }
        if self.has_scan && self.scan_s.is_none_or(|scan_s| now_s - scan_s > SCAN_MAX_AGE_S) {
            let unused = self.scan_trouble.as_ref().map(|why| format!("OBSTACLE_DISTANCE: {why}"));
            return fault(unused.unwrap_or("no scan is arriving: check OBSTACLE_DISTANCE".to_owned()));
        }
        Ok(())
    }
}

fn name(mode: u32) -> String {
    let known = MODES.iter().find(|(number, _)| *number == mode);
    known.map_or(format!("{mode}"), |(_, name)| (*name).to_owned())
}
