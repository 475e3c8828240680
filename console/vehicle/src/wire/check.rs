//! The bounds of single values on the wire.

use super::{
    PROTOCOL,
    message::{
        Ae, Channel, Drive, Hello, Limits, Odometry, Outline, Pong, Pose, PulseLengths, Readings, Scan,
        State, Tether,
    },
};
use std::{fmt, ops::RangeInclusive};

/// Largest stamp, seconds: a clock that counts from 1970 fits.
const STAMP_MAX_S: f64 = 1e11;
const NAME_MAX: usize = 64;
const TEXT_MAX: usize = 200;
const ENTRIES_MAX: usize = 64;
const RANGES_MAX: usize = 1000;
/// Each of 64 stations sends, and the others hear.
const PULSES_MAX: usize = ENTRIES_MAX * (ENTRIES_MAX - 1);
const RAYS_MAX: usize = 4096;
const OUTLINES_MAX: usize = 1000;
/// The most channels of an instrument.
const CHANNELS_MAX: usize = 512;
const POINTS_MAX: usize = 1000;

/// A field with a value that is out of bounds.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Misfit {
    /// The field, such as `readings.scan.ranges_m[3]`; empty if the fault concerns the whole line.
    pub field: String,
    /// The fault and the allowed values, as a clause that does not name the field.
    pub what: String,
}

impl fmt::Display for Misfit {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let colon = if self.field.is_empty() { "" } else { ": " };
        write!(out, "{}{colon}{}", self.field, self.what)
    }
}

impl std::error::Error for Misfit {}

pub(super) type Checked = Result<(), Misfit>;

pub(super) fn misfit<T>(field: impl Into<String>, what: impl Into<String>) -> Result<T, Misfit> {
    Err(Misfit { field: field.into(), what: what.into() })
}

pub(super) fn within(field: &str, value: f64, range: RangeInclusive<f64>) -> Checked {
    // Also false for a value that is not a number.
    if range.contains(&value) {
        return Ok(());
    }
    misfit(field, format!("{} is not between {} and {}", short(value), range.start(), range.end()))
}

fn above_zero(field: &str, value: f64, most: f64) -> Checked {
    if value > 0.0 && value <= most {
        return Ok(());
    }
    misfit(field, format!("{} is out of range: greater than 0 and at most {most} is allowed", short(value)))
}

/// A number as short text: very large and very small ones with an exponent.
fn short(value: f64) -> String {
    let is_plain = value == 0.0 || (1e-6..1e9).contains(&value.abs());
    if is_plain { format!("{value}") } else { format!("{value:e}") }
}

fn at_most(field: &str, n: usize, most: usize) -> Checked {
    if n <= most { Ok(()) } else { misfit(field, format!("{n} entries; at most {most} are allowed")) }
}

fn readable(field: &str, text: &str, most: usize) -> Checked {
    if text.chars().any(char::is_control) {
        return misfit(field, "contains a control character");
    }
    match text.chars().count() {
        n if n <= most => Ok(()),
        n => misfit(field, format!("{n} characters; at most {most} are allowed")),
    }
}

fn name(field: &str, text: &str) -> Checked {
    if text.is_empty() { misfit(field, "is empty") } else { readable(field, text, NAME_MAX) }
}

pub(super) fn stamp(field: &str, stamp_s: f64) -> Checked {
    within(field, stamp_s, -STAMP_MAX_S..=STAMP_MAX_S)
}

impl Hello {
    pub(super) fn check(&self) -> Checked {
        if self.protocol != PROTOCOL {
            let what = format!("version {}, but this console uses version {PROTOCOL}", self.protocol);
            return misfit("hello.protocol", what);
        }
        name("hello.name", &self.name)?;
        self.limits.check()?;
        above_zero("hello.period_s", self.period_s, 1.0)?;
        above_zero("hello.stop_time_s", self.stop_time_s, 60.0)?;
        above_zero("hello.lease_max_s", self.lease_max_s, 5.0)
    }
}

impl Limits {
    fn check(&self) -> Checked {
        above_zero("hello.limits.speed_m_per_s", self.speed_m_per_s, 10.0)?;
        above_zero("hello.limits.turn_rad_per_s", self.turn_rad_per_s, 20.0)?;
        above_zero("hello.limits.acceleration_m_per_s2", self.acceleration_m_per_s2, 50.0)?;
        above_zero("hello.limits.radius_m", self.radius_m, 10.0)
    }
}

impl Readings {
    pub(super) fn check(&self) -> Checked {
        stamp("readings.stamp_s", self.stamp_s)?;
        self.odometry.as_ref().map_or(Ok(()), Odometry::check)?;
        self.pose.as_ref().map_or(Ok(()), Pose::check)?;
        self.ae.as_ref().map_or(Ok(()), Ae::check)?;
        at_most("readings.pulses", self.pulses.len(), PULSES_MAX)?;
        self.pulses.iter().enumerate().try_for_each(|(at, pulses)| pulses.check(at))?;
        self.scan.as_ref().map_or(Ok(()), Scan::check)?;
        self.tether.as_ref().map_or(Ok(()), Tether::check)?;
        self.pressure_pa.map_or(Ok(()), |pascals| within("readings.pressure_pa", pascals, -1e8..=1e8))?;
        let dead = self.dead_channels.as_deref().unwrap_or_default();
        at_most("readings.dead_channels", dead.len(), CHANNELS_MAX)?;
        for channel in dead {
            let most = (CHANNELS_MAX - 1) as f64;
            within("readings.dead_channels", f64::from(*channel), 0.0..=most)?;
        }
        at_most("readings.outlines", self.outlines.len(), OUTLINES_MAX)?;
        self.outlines.iter().enumerate().try_for_each(|(at, outline)| outline.check(at))?;
        at_most("readings.channels", self.channels.len(), ENTRIES_MAX)?;
        self.channels.iter().enumerate().try_for_each(|(at, channel)| channel.check(at))
    }
}

impl Odometry {
    fn check(&self) -> Checked {
        above_zero("readings.odometry.over_s", self.over_s, 10.0)?;
        within("readings.odometry.forward_m", self.forward_m, -100.0..=100.0)?;
        within("readings.odometry.sideways_m", self.sideways_m, -100.0..=100.0)?;
        within("readings.odometry.turn_rad", self.turn_rad, -200.0..=200.0)
    }
}

impl Pose {
    fn check(&self) -> Checked {
        within("readings.pose.x_m", self.x_m, -1e5..=1e5)?;
        within("readings.pose.y_m", self.y_m, -1e5..=1e5)?;
        within("readings.pose.heading_rad", self.heading_rad, -1e6..=1e6)
    }
}

impl Ae {
    fn check(&self) -> Checked {
        at_most("readings.ae.ranges", self.ranges.len(), ENTRIES_MAX)?;
        at_most("readings.ae.arrivals", self.arrivals.len(), ENTRIES_MAX)?;
        at_most("readings.ae.differences", self.differences.len(), ENTRIES_MAX)?;
        for (at, of) in self.ranges.iter().enumerate() {
            let field = |part: &str| format!("readings.ae.ranges[{at}].{part}");
            name(&field("station"), &of.station)?;
            at_most(&field("ranges_m"), of.ranges_m.len(), RANGES_MAX)?;
            for (k, range_m) in of.ranges_m.iter().enumerate() {
                above_zero(&field(&format!("ranges_m[{k}]")), *range_m, 1000.0)?;
            }
        }
        for (at, of) in self.arrivals.iter().enumerate() {
            let field = |part: &str| format!("readings.ae.arrivals[{at}].{part}");
            name(&field("station"), &of.station)?;
            stamp(&field("arrival_s"), of.arrival_s)?;
            of.emitted_s.map_or(Ok(()), |emitted_s| stamp(&field("emitted_s"), emitted_s))?;
        }
        for (at, of) in self.differences.iter().enumerate() {
            let field = |part: &str| format!("readings.ae.differences[{at}].{part}");
            name(&field("station"), &of.station)?;
            name(&field("reference"), &of.reference)?;
            within(&field("tdoa_s"), of.tdoa_s, -1.0..=1.0)?;
        }
        Ok(())
    }
}

impl PulseLengths {
    fn check(&self, at: usize) -> Checked {
        let field = |part: &str| format!("readings.pulses[{at}].{part}");
        name(&field("sender"), &self.sender)?;
        name(&field("receiver"), &self.receiver)?;
        if self.sender == self.receiver {
            return misfit(field("receiver"), format!("station {} cannot hear itself", self.sender));
        }
        at_most(&field("lengths_m"), self.lengths_m.len(), RANGES_MAX)?;
        for (k, length_m) in self.lengths_m.iter().enumerate() {
            within(&field(&format!("lengths_m[{k}]")), *length_m, -1000.0..=1000.0)?;
        }
        Ok(())
    }
}

impl Scan {
    fn check(&self) -> Checked {
        within("readings.scan.first_rad", self.first_rad, -7.0..=7.0)?;
        within("readings.scan.step_rad", self.step_rad, -7.0..=7.0)?;
        if self.step_rad == 0.0 {
            return misfit("readings.scan.step_rad", "is 0");
        }
        above_zero("readings.scan.range_max_m", self.range_max_m, 1000.0)?;
        for (axis, place_m) in self.sensor_m.iter().enumerate() {
            within(&format!("readings.scan.sensor_m[{axis}]"), *place_m, -10.0..=10.0)?;
        }
        if self.ranges_m.is_empty() {
            return misfit("readings.scan.ranges_m", "is empty; a ray without an echo is null");
        }
        at_most("readings.scan.ranges_m", self.ranges_m.len(), RAYS_MAX)?;
        for (at, range_m) in self.ranges_m.iter().enumerate() {
            let Some(range_m) = range_m else { continue };
            within(&format!("readings.scan.ranges_m[{at}]"), *range_m, 0.0..=self.range_max_m)?;
        }
        Ok(())
    }
}

impl Tether {
    fn check(&self) -> Checked {
        within("readings.tether.paid_out_m", self.paid_out_m, 0.0..=1e4)?;
        self.pull_n.map_or(Ok(()), |newtons| within("readings.tether.pull_n", newtons, 0.0..=1e6))
    }
}

impl Outline {
    fn check(&self, at: usize) -> Checked {
        let field = |part: &str| format!("readings.outlines[{at}].{part}");
        at_most(&field("points_m"), self.points_m.len(), POINTS_MAX)?;
        let least = if self.closed { 3 } else { 1 };
        if self.points_m.len() < least {
            return misfit(
                field("points_m"),
                format!("number of points: {}; required: {least} or more", self.points_m.len()),
            );
        }
        for (k, point) in self.points_m.iter().enumerate() {
            for value in point {
                within(&field(&format!("points_m[{k}]")), *value, -1000.0..=1000.0)?;
            }
        }
        within(&field("radius_m"), self.radius_m, 0.0..=1000.0)
    }
}

impl Channel {
    fn check(&self, at: usize) -> Checked {
        name(&format!("readings.channels[{at}].name"), &self.name)?;
        within(&format!("readings.channels[{at}].value"), self.value, f64::MIN..=f64::MAX)
    }
}

impl State {
    pub(super) fn check(&self) -> Checked {
        stamp("state.stamp_s", self.stamp_s)?;
        self.text.as_ref().map_or(Ok(()), |text| readable("state.text", text, TEXT_MAX))?;
        self.battery.map_or(Ok(()), |share| within("state.battery", share, 0.0..=1.0))
    }
}

impl Pong {
    pub(super) fn check(&self) -> Checked {
        stamp("pong.echo_s", self.echo_s)?;
        stamp("pong.stamp_s", self.stamp_s)
    }
}

impl Drive {
    pub(super) fn check(&self) -> Checked {
        stamp("drive.stamp_s", self.stamp_s)?;
        above_zero("drive.lease_s", self.lease_s, 5.0)?;
        within("drive.forward_m_per_s", self.forward_m_per_s, -10.0..=10.0)?;
        within("drive.sideways_m_per_s", self.sideways_m_per_s, -10.0..=10.0)?;
        within("drive.turn_rad_per_s", self.turn_rad_per_s, -20.0..=20.0)
    }
}
