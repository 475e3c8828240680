//! Converts MAVLink's frames and units to those of the wire, and back. MAVLink has x ahead or north, y right or east,
//! and angles clockwise; the wire has y left, and angles counter-clockwise.

use crate::config::{Config, Ranging};
use mavlink::dialects::common::{
    DEBUG_FLOAT_ARRAY_DATA, MavFrame, MavMessage, OBSTACLE_DISTANCE_DATA, PositionTargetTypemask,
    SET_POSITION_TARGET_LOCAL_NED_DATA,
};
use std::f64::consts::FRAC_PI_2;
use tankops_adapter::{
    commands::Velocity,
    message::{Ae, Pose, Scan, StationRanges},
};

#[cfg(test)]
mod tests;

/// Largest coordinate of a pose, metres.
const POSE_MAX_M: f64 = 1e5;
/// Longest distance to a station, metres.
const STATION_MAX_M: f64 = 1000.0;

/// The frame of commands; ArduRover does not accept the frame that replaces this one in MAVLink.
#[allow(deprecated)]
const AHEAD: MavFrame = MavFrame::MAV_FRAME_BODY_NED;

/// Converts a yaw, clockwise from north, to a heading, counter-clockwise from east.
pub(crate) fn heading(yaw: f32) -> Result<f64, String> {
    let yaw = f64::from(yaw);
    if !(yaw.abs() <= POSE_MAX_M) {
        return Err(format!("yaw: {yaw} is not an angle"));
    }
    Ok(FRAC_PI_2 - yaw)
}

/// Converts a pose from x north and y east to x east and y north.
pub(crate) fn pose(north: f32, east: f32, yaw: f64) -> Result<Pose, String> {
    for (field, value) in [("x", f64::from(north)), ("y", f64::from(east)), ("yaw", yaw)] {
        if !(value.abs() <= POSE_MAX_M) {
            return Err(format!("{field}: {value} is not between -{POSE_MAX_M} and {POSE_MAX_M}"));
        }
    }
    Ok(Pose { x_m: f64::from(east), y_m: f64::from(north), heading_rad: FRAC_PI_2 - yaw })
}

/// The yaw of a quaternion, w first.
pub(crate) fn yaw(q: [f32; 4]) -> Result<f64, String> {
    let [w, x, y, z] = q.map(f64::from);
    let norm = w * w + x * x + y * y + z * z;
    if !(norm.is_finite() && norm > 1e-6) {
        return Err(format!("q: {w}, {x}, {y}, {z} is not a rotation"));
    }
    Ok((2.0 * (w * z + x * y)).atan2(w * w + x * x - y * y - z * z))
}

/// The command that a rover in mode GUIDED obeys: speed ahead and turn rate.
pub(crate) fn command(velocity: Velocity, config: &Config, time_boot_ms: u32) -> MavMessage {
    use PositionTargetTypemask as Ignore;
    let type_mask = Ignore::POSITION_TARGET_TYPEMASK_X_IGNORE
        | Ignore::POSITION_TARGET_TYPEMASK_Y_IGNORE
        | Ignore::POSITION_TARGET_TYPEMASK_Z_IGNORE
        | Ignore::POSITION_TARGET_TYPEMASK_AX_IGNORE
        | Ignore::POSITION_TARGET_TYPEMASK_AY_IGNORE
        | Ignore::POSITION_TARGET_TYPEMASK_AZ_IGNORE
        | Ignore::POSITION_TARGET_TYPEMASK_YAW_IGNORE;
    MavMessage::SET_POSITION_TARGET_LOCAL_NED(SET_POSITION_TARGET_LOCAL_NED_DATA {
        time_boot_ms,
        vx: velocity.forward_m_per_s as f32,
        // Clockwise; a zero stays one without a sign.
        yaw_rate: (0.0 - velocity.turn_rad_per_s) as f32,
        type_mask,
        target_system: config.rover.system,
        target_component: config.rover.component,
        coordinate_frame: AHEAD,
        ..SET_POSITION_TARGET_LOCAL_NED_DATA::default()
    })
}

/// Converts the sectors of `OBSTACLE_DISTANCE` to a scan. An obstacle nearer than the least distance is too near to be
/// measured.
pub(crate) fn scan(sectors: &OBSTACLE_DISTANCE_DATA) -> Result<Scan, String> {
    let increment_deg = if sectors.increment_f == 0.0 {
        f64::from(sectors.increment)
    } else {
        f64::from(sectors.increment_f)
    };
    let offset_deg = f64::from(sectors.angle_offset);
    if !(increment_deg.abs() <= 360.0 && increment_deg != 0.0 && offset_deg.abs() <= 360.0) {
        return Err(format!(
            "increment: {increment_deg} and angle_offset: {offset_deg} are not angles of a scan"
        ));
    }
    if sectors.max_distance == 0 {
        return Err("max_distance: is 0".to_owned());
    }
    if sectors.frame != MavFrame::MAV_FRAME_BODY_FRD {
        return Err(format!("frame: {:?} is not MAV_FRAME_BODY_FRD", sectors.frame));
    }
    let echo = |cm: &u16| match *cm {
        near if near < sectors.min_distance => Some(0.0),
        cm => (cm <= sectors.max_distance).then(|| metres(cm)),
    };
    let used = (360.0 / increment_deg.abs()).floor().min(72.0) as usize;
    Ok(Scan {
        first_rad: -offset_deg.to_radians(),
        step_rad: -increment_deg.to_radians(),
        range_max_m: metres(sectors.max_distance),
        sensor_m: [0.0, 0.0],
        ranges_m: sectors.distances[..used].iter().map(echo).collect(),
    })
}

fn metres(cm: u16) -> f64 {
    f64::from(cm) / 100.0
}

/// Converts the values of an array to ranges to stations.
pub(crate) fn ranges(array: &DEBUG_FLOAT_ARRAY_DATA, ranging: &Ranging) -> Result<Ae, String> {
    let mut ranges = Vec::with_capacity(ranging.stations.len());
    for (station, values) in ranging.stations.iter().zip(array.data.chunks(ranging.repetitions)) {
        let is_wrong = |value: &&f32| !(**value >= 0.0 && f64::from(**value) <= STATION_MAX_M);
        if let Some(bad) = values.iter().find(is_wrong) {
            return Err(format!("data: {bad} is not a distance to station {station}"));
        }
        let ranges_m: Vec<f64> = values.iter().filter(|m| **m > 0.0).map(|m| f64::from(*m)).collect();
        if !ranges_m.is_empty() {
            ranges.push(StationRanges { station: station.clone(), ranges_m });
        }
    }
    Ok(Ae { ranges })
}
