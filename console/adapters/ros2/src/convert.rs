//! Converts ROS messages to parts of readings. An invalid value is refused, and the error names its field.

use crate::{
    config::ScanSource,
    types::{self, Float64MultiArray, LaserScan},
};
use std::f64::consts::TAU;
use tankops_adapter::message::{Ae, Pose, Scan, StationRanges};

/// Maximum number of rays of a scan on the wire.
const RAYS_MAX: usize = 4096;
/// Longest distance to a station, metres.
const STATION_MAX_M: f64 = 1000.0;
/// Maximum number of stations, and maximum number of distances to each station.
const STATIONS_MAX: usize = 64;
const REPETITIONS_MAX: usize = 1000;
/// Largest coordinate of a pose, metres.
const POSE_MAX_M: f64 = 1e5;
/// Largest range of a scan, metres.
const RANGE_MAX_M: f64 = 1000.0;

/// A pose on the floor.
pub(crate) fn pose(pose: &types::Pose) -> Result<Pose, String> {
    for (field, value) in [("position.x", pose.position.x), ("position.y", pose.position.y)] {
        if !(value.abs() <= POSE_MAX_M) {
            return Err(format!("{field}: {value} is not between -{POSE_MAX_M} and {POSE_MAX_M}"));
        }
    }
    let q = pose.orientation;
    let norm = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
    if !(norm.is_finite() && norm > 1e-6) {
        return Err(format!("orientation: {}, {}, {}, {} is not a rotation", q.x, q.y, q.z, q.w));
    }
    let heading_rad = (2.0 * (q.w * q.z + q.x * q.y)).atan2(q.w * q.w + q.x * q.x - q.y * q.y - q.z * q.z);
    Ok(Pose { x_m: pose.position.x, y_m: pose.position.y, heading_rad })
}

/// A scan. A range of minus infinity is something too near to be measured (REP 117).
pub(crate) fn scan(scan: &LaserScan, mounted: &ScanSource) -> Result<Scan, String> {
    let (first, step) = (f64::from(scan.angle_min), f64::from(scan.angle_increment));
    let range_max_m = f64::from(scan.range_max);
    if !(first.abs() <= TAU && step.abs() <= TAU && step != 0.0) {
        return Err(format!("angle_min: {first} and angle_increment: {step} are not angles of a scan"));
    }
    if !(range_max_m > 0.0 && range_max_m <= RANGE_MAX_M) {
        return Err(format!(
            "range_max: {range_max_m} is out of range: greater than 0 and at most {RANGE_MAX_M} is allowed"
        ));
    }
    if !(1..=RAYS_MAX).contains(&scan.ranges.len()) {
        return Err(format!("ranges: {} rays; 1 to {RAYS_MAX} are allowed", scan.ranges.len()));
    }
    let sign = if mounted.upside_down { -1.0 } else { 1.0 };
    let (first_rad, step_rad) = (sign * first + mounted.turned_deg.to_radians(), sign * step);
    let millimetres = |range: f32| ((f64::from(range) * 1e3).round() / 1e3).min(range_max_m);
    let echo = |range: &f32| match *range {
        f32::NEG_INFINITY => Some(0.0),
        range => {
            (range > 0.0 && range >= scan.range_min && range <= scan.range_max).then(|| millimetres(range))
        }
    };
    Ok(Scan {
        first_rad: first_rad - (first_rad / TAU).trunc() * TAU,
        step_rad,
        range_max_m,
        sensor_m: [mounted.ahead_m, mounted.left_m],
        ranges_m: scan.ranges.iter().map(echo).collect(),
    })
}

/// Reads ranges to stations. Each station has one dimension, with the name of the station as its label and the number
/// of ranges as its size; the ranges are stored in the order of the stations.
pub(crate) fn ranges(array: &Float64MultiArray) -> Result<Ae, String> {
    let stations = &array.layout.dim;
    if stations.len() > STATIONS_MAX {
        return Err(format!("layout.dim: {} stations; at most {STATIONS_MAX} are allowed", stations.len()));
    }
    let mut rest = array.data.get(array.layout.data_offset as usize..).unwrap_or_default();
    let mut ranges = Vec::with_capacity(stations.len());
    for station in stations {
        let (label, size) = (&station.label, station.size as usize);
        if label.is_empty() || label.chars().count() > 64 || label.chars().any(char::is_control) {
            return Err(
                "layout.dim.label: the name of a station must have 1 to 64 printable characters".to_owned()
            );
        }
        if size > REPETITIONS_MAX || size > rest.len() {
            let there = rest.len();
            return Err(format!(
                "layout.dim.size: {size} ranges to station {label} are announced; ranges in the message: {there}"
            ));
        }
        let (ranges_m, after) = rest.split_at(size);
        if let Some(bad) = ranges_m.iter().find(|range_m| !(**range_m > 0.0 && **range_m <= STATION_MAX_M)) {
            return Err(format!("data: {bad} is not a distance to station {label}"));
        }
        ranges.push(StationRanges { station: label.clone(), ranges_m: ranges_m.to_vec() });
        rest = after;
    }
    if !rest.is_empty() {
        return Err(format!("data: ranges beyond the sizes of the stations: {}", rest.len()));
    }
    Ok(Ae { ranges })
}

#[cfg(test)]
mod tests;
