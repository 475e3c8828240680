//! The table `[vehicle]` of a settings file, from which the adapter makes its `hello`.

use crate::message::{Has, Hello, Limits, Motion};
use serde::{Deserialize, de::DeserializeOwned};
use std::{fs, path::Path};

/// Version of the protocol on the wire.
const PROTOCOL: u32 = 1;

/// The description of the vehicle. The keys are those of `hello`.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Vehicle {
    /// Human-readable name, 1 to 64 characters.
    pub name: String,
    /// How it moves.
    #[serde(default = "unicycle")]
    pub motion: Motion,
    /// Largest speed, metres per second.
    pub speed_m_per_s: f64,
    /// Largest turn rate, radians per second.
    pub turn_rad_per_s: f64,
    /// Largest acceleration, metres per second squared.
    pub acceleration_m_per_s2: f64,
    /// Radius of a disc about the origin of the robot frame that contains the hull, metres.
    pub radius_m: f64,
    /// Time between two readings, seconds.
    pub period_s: f64,
    /// Measured time from the arrival of a `stop` at full speed until the vehicle stands still, seconds.
    pub stop_time_s: f64,
    /// Longest lease that the vehicle honours, seconds.
    pub lease_max_s: f64,
}

fn unicycle() -> Motion {
    Motion::Unicycle
}

impl Vehicle {
    /// Checks the bounds that the console also checks.
    ///
    /// # Errors
    /// Names the first key that is out of bounds.
    pub fn check(&self) -> Result<(), String> {
        let length = self.name.chars().count();
        if !(1..=64).contains(&length) || self.name.chars().any(char::is_control) {
            return Err("vehicle.name: 1 to 64 printable characters are needed".to_owned());
        }
        above_zero("vehicle.speed_m_per_s", self.speed_m_per_s, 10.0)?;
        above_zero("vehicle.turn_rad_per_s", self.turn_rad_per_s, 20.0)?;
        above_zero("vehicle.acceleration_m_per_s2", self.acceleration_m_per_s2, 50.0)?;
        above_zero("vehicle.radius_m", self.radius_m, 10.0)?;
        above_zero("vehicle.period_s", self.period_s, 1.0)?;
        above_zero("vehicle.stop_time_s", self.stop_time_s, 60.0)?;
        above_zero("vehicle.lease_max_s", self.lease_max_s, 5.0)
    }

    /// The limits of its motion.
    pub fn limits(&self) -> Limits {
        Limits {
            speed_m_per_s: self.speed_m_per_s,
            turn_rad_per_s: self.turn_rad_per_s,
            acceleration_m_per_s2: self.acceleration_m_per_s2,
            radius_m: self.radius_m,
        }
    }

    /// The introduction of the vehicle.
    pub fn hello(&self, has: Has) -> Hello {
        Hello {
            protocol: PROTOCOL,
            name: self.name.clone(),
            motion: self.motion,
            limits: self.limits(),
            has,
            period_s: self.period_s,
            stop_time_s: self.stop_time_s,
            lease_max_s: self.lease_max_s,
        }
    }
}

/// Checks that a value is greater than 0 and at most `most`.
///
/// # Errors
/// Names `key` if it is not.
pub fn above_zero(key: &str, value: f64, most: f64) -> Result<(), String> {
    if value > 0.0 && value <= most {
        return Ok(());
    }
    Err(format!("{key}: {value} is out of range: greater than 0 and at most {most} is allowed"))
}

/// The settings of an adapter.
pub trait Settings: DeserializeOwned {
    /// Checks the conditions that the types do not express.
    ///
    /// # Errors
    /// Names the first key that is wrong.
    fn check(&self) -> Result<(), String>;

    /// Reads and checks the text of a file.
    ///
    /// # Errors
    /// The wrong key and the reason; if the text cannot be parsed, also the line.
    fn parse(text: &str) -> Result<Self, String> {
        let settings: Self = toml::from_str(text).map_err(|error| error.to_string())?;
        settings.check().map(|()| settings)
    }

    /// Reads and checks a file.
    ///
    /// # Errors
    /// The file, and why it cannot be used.
    fn read(path: &Path) -> Result<Self, String> {
        let text = fs::read_to_string(path).map_err(|error| error.to_string());
        text.and_then(|text| Self::parse(&text)).map_err(|why| format!("{}: {why}", path.display()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "name = \"crawler\"\nspeed_m_per_s = 0.4\nturn_rad_per_s = 1.0\n\
        acceleration_m_per_s2 = 0.5\nradius_m = 0.2\nperiod_s = 0.05\nstop_time_s = 0.9\nlease_max_s = 0.5\n";

    #[test]
    fn the_introduction_has_the_values_of_the_file() {
        let vehicle: Vehicle = toml::from_str(TEXT).unwrap();
        vehicle.check().unwrap();
        let hello = vehicle.hello(Has { pose: true, ..Has::default() });
        let json = serde_json::to_value(&hello).unwrap();
        assert_eq!(json["motion"], "unicycle");
        assert_eq!(json["limits"]["turn_rad_per_s"], 1.0);
        assert_eq!(json["has"]["pose"], true);
    }

    #[test]
    fn a_value_out_of_bounds_is_named() {
        for (from, to, why) in [
            ("lease_max_s = 0.5", "lease_max_s = 9.0", "vehicle.lease_max_s: 9 is out of range"),
            ("radius_m = 0.2", "radius_m = 0.0", "vehicle.radius_m: 0 is out of range"),
            ("speed_m_per_s = 0.4", "speed_m_per_s = nan", "vehicle.speed_m_per_s: NaN is out of range"),
            ("\"crawler\"", "\"\"", "vehicle.name: 1 to 64"),
        ] {
            let vehicle: Vehicle = toml::from_str(&TEXT.replace(from, to)).unwrap();
            let error = vehicle.check().unwrap_err();
            assert!(error.starts_with(why), "{error}");
        }
        let unknown = toml::from_str::<Vehicle>(&TEXT.replace("radius_m", "radius")).unwrap_err();
        assert!(unknown.to_string().contains("unknown field `radius`"), "{unknown}");
    }
}
