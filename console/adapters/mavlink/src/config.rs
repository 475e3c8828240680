//! The settings file: addresses, numbers and names. Everything in it is checked before the first message.

#[cfg(test)]
mod tests;

use serde::Deserialize;
use tankops_adapter::{
    message::{Has, Motion},
    settings::{Settings, Vehicle, above_zero},
};

/// Number of values in a `DEBUG_FLOAT_ARRAY`.
const VALUES_MAX: usize = 58;
/// Maximum length of a name in MAVLink.
const NAME_MAX: usize = 10;

/// All settings.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Config {
    /// `udpin:HOST:PORT` to wait for the rover, or `udpout:HOST:PORT` to call it.
    pub(crate) connection: String,
    /// System and component number of the adapter: a ground station.
    #[serde(default = "ground_station")]
    pub(crate) own: Number,
    /// System and component number of the rover's autopilot.
    #[serde(default = "autopilot")]
    pub(crate) rover: Number,
    /// The messages that contain the poses.
    #[serde(default)]
    pub(crate) pose: PoseFrom,
    /// Time after which a command is sent again, seconds.
    #[serde(default = "command_period")]
    pub(crate) command_period_s: f64,
    /// The description of the vehicle, for `hello`.
    pub(crate) vehicle: Vehicle,
    /// Whether the scan is taken from `OBSTACLE_DISTANCE`.
    #[serde(default)]
    pub(crate) scan: bool,
    /// Ranges to stations, in a `DEBUG_FLOAT_ARRAY`.
    pub(crate) ae: Option<Ranging>,
    /// Name of the `NAMED_VALUE_FLOAT` with the length of tether paid out, metres.
    pub(crate) tether: Option<String>,
    /// Name of the `NAMED_VALUE_FLOAT` of the bumper: pressed if it is not 0.
    pub(crate) contact: Option<String>,
}

/// The numbers of a participant.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Number {
    /// The number of the system.
    pub(crate) system: u8,
    /// The number of the component in the system.
    pub(crate) component: u8,
}

fn ground_station() -> Number {
    Number { system: 255, component: 190 }
}

fn autopilot() -> Number {
    Number { system: 1, component: 1 }
}

fn command_period() -> f64 {
    0.05
}

/// The messages that contain the poses.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum PoseFrom {
    /// `LOCAL_POSITION_NED` and `ATTITUDE`.
    #[default]
    LocalPosition,
    /// `ODOMETRY`.
    Odometry,
}

/// Ranges to stations: `repetitions` values per station, station by station, metres; 0 for a range that is missing.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Ranging {
    /// Name of the array.
    pub(crate) name: String,
    /// Names of the stations, as in the scenario.
    pub(crate) stations: Vec<String>,
    /// Ranges to each station.
    #[serde(default = "once")]
    pub(crate) repetitions: usize,
}

fn once() -> usize {
    1
}

impl Settings for Config {
    fn check(&self) -> Result<(), String> {
        check_connection(&self.connection)?;
        for (key, number) in [("own", self.own), ("rover", self.rover)] {
            if number.system == 0 || number.component == 0 {
                return Err(format!("{key}: system and component are 1 to 255; 0 means all"));
            }
        }
        if self.own.system == self.rover.system {
            return Err(format!("own.system: {} is the system number of the rover", self.own.system));
        }
        above_zero("command_period_s", self.command_period_s, self.vehicle.lease_max_s)?;
        self.vehicle.check()?;
        if self.vehicle.motion == Motion::Omni {
            return Err("vehicle.motion: a rover is a unicycle".to_owned());
        }
        self.ae.as_ref().map_or(Ok(()), Ranging::check)?;
        self.tether.as_ref().map_or(Ok(()), |name| check_name("tether", name))?;
        self.contact.as_ref().map_or(Ok(()), |name| check_name("contact", name))
    }
}

impl Config {
    /// The parts of the readings.
    pub(crate) fn has(&self) -> Has {
        Has {
            pose: true,
            scan: self.scan,
            contact: self.contact.is_some(),
            tether: self.tether.is_some(),
            ae: self.ae.is_some(),
        }
    }
}

impl Ranging {
    fn check(&self) -> Result<(), String> {
        check_name("ae.name", &self.name)?;
        if self.stations.is_empty() {
            return Err("ae.stations: at least one station is needed".to_owned());
        }
        if self.stations.iter().any(String::is_empty) {
            return Err("ae.stations: a station has an empty name".to_owned());
        }
        let (values, stations) = (self.stations.len().saturating_mul(self.repetitions), self.stations.len());
        if !(1..=VALUES_MAX).contains(&values) {
            let repetitions = self.repetitions;
            return Err(format!(
                "ae.repetitions: {repetitions} for {stations} stations are {values} values; 1 to {VALUES_MAX} fit"
            ));
        }
        Ok(())
    }
}

fn check_connection(connection: &str) -> Result<(), String> {
    let port = ["udpin:", "udpout:"]
        .iter()
        .find_map(|kind| connection.strip_prefix(kind))
        .and_then(|address| address.rsplit_once(':'))
        .filter(|(host, _)| !host.is_empty())
        .and_then(|(_, port)| port.parse::<u16>().ok());
    port.map(|_| ()).ok_or(format!("connection: `{connection}` is not udpin:HOST:PORT or udpout:HOST:PORT"))
}

fn check_name(key: &str, name: &str) -> Result<(), String> {
    if !name.is_empty() && name.len() <= NAME_MAX && name.is_ascii() {
        return Ok(());
    }
    Err(format!("{key}: `{name}` is not a name in MAVLink, which has 1 to {NAME_MAX} ASCII characters"))
}
