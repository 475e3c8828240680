use super::*;
use mavlink::dialects::common::{
    ATTITUDE_DATA, BATTERY_STATUS_DATA, DEBUG_FLOAT_ARRAY_DATA, LOCAL_POSITION_NED_DATA, MANUAL_CONTROL_DATA,
    MavFrame, OBSTACLE_DISTANCE_DATA, ODOMETRY_DATA,
};
use tankops_adapter::message::{Commander, Mode, Readings, State};

fn config() -> Config {
    toml::from_str(include_str!("../../trial/rover.toml")).unwrap()
}

fn from(system: u32, message: MavMessage) -> Input {
    Input::Message(MavHeader { system_id: system, component_id: 1, sequence: 0 }, Box::new(message))
}

fn beat(mode: u32, base_mode: MavModeFlag) -> Input {
    let system_status = MavState::MAV_STATE_ACTIVE;
    from(
        1,
        MavMessage::HEARTBEAT(HEARTBEAT_DATA {
            custom_mode: mode,
            base_mode,
            system_status,
            ..HEARTBEAT_DATA::default()
        }),
    )
}

fn armed(mode: u32) -> Input {
    beat(mode, MavModeFlag::MAV_MODE_FLAG_SAFETY_ARMED)
}

fn attitude(ms: u32, yaw: f32, yawspeed: f32) -> Input {
    from(
        1,
        MavMessage::ATTITUDE(ATTITUDE_DATA { time_boot_ms: ms, yaw, yawspeed, ..ATTITUDE_DATA::default() }),
    )
}

fn position(ms: u32, north: f32) -> Input {
    let at = LOCAL_POSITION_NED_DATA { time_boot_ms: ms, x: north, ..LOCAL_POSITION_NED_DATA::default() };
    from(1, MavMessage::LOCAL_POSITION_NED(at))
}

fn drive(seq: u64) -> Input {
    Input::Console(Some(format!(
        r#"{{"type": "drive", "seq": {seq}, "stamp_s": 0, "lease_s": 0.25, "forward_m_per_s": 0.25, "turn_rad_per_s": 0.5}}"#
    )))
}

fn sectors() -> Input {
    sectors_at(0)
}

fn sectors_at(time_usec: u64) -> Input {
    from(
        1,
        MavMessage::OBSTACLE_DISTANCE(OBSTACLE_DISTANCE_DATA {
            time_usec,
            distances: [150; 72],
            max_distance: 800,
            increment: 5,
            frame: MavFrame::MAV_FRAME_BODY_FRD,
            ..OBSTACLE_DISTANCE_DATA::default()
        }),
    )
}

/// A bridge whose rover is ready, at time 0.
fn ready() -> Bridge {
    let mut bridge = Bridge::new(config(), 0.0);
    for input in [armed(15), sectors(), attitude(5000, 0.0, 0.0), position(5000, 0.0)] {
        bridge.take(input, 0.0);
    }
    bridge
}

fn speeds(out: &[Output]) -> Vec<(f32, f32)> {
    let speed = |of: &Output| match of {
        Output::Send(message) => match message.as_ref() {
            MavMessage::SET_POSITION_TARGET_LOCAL_NED(sent) => Some((sent.vx, sent.yaw_rate)),
            _ => None,
        },
        _ => None,
    };
    out.iter().filter_map(speed).collect()
}

fn state(out: &[Output]) -> State {
    let state = |of: &Output| match of {
        Output::Say(FromVehicle::State(state)) => Some(state.clone()),
        _ => None,
    };
    out.iter().rev().find_map(state).unwrap_or_else(|| panic!("{out:?}"))
}

fn readings(out: &[Output]) -> Option<&Readings> {
    out.iter().find_map(|of| {
        if let Output::Say(FromVehicle::Readings(readings)) = of { Some(readings) } else { None }
    })
}

#[test]
fn drives_and_lapsed_leases_reach_the_rover() {
    let mut bridge = ready();
    assert_eq!(speeds(&bridge.take(drive(1), 0.01)), [(0.25, -0.5)]);
    bridge.take(attitude(5200, 0.0, 0.0), 0.2);
    bridge.take(position(5200, 0.0), 0.2);
    assert_eq!(speeds(&bridge.take(Input::Tick, 0.27)), [(0.0, 0.0)]);
    assert_eq!(speeds(&bridge.take(Input::Tick, 0.33)), [(0.0, 0.0)]);
}

#[test]
fn the_modes_of_the_rover_are_states() {
    let cases = [
        (armed(0), Mode::Manual, "mode MANUAL"),
        (armed(4), Mode::Fault, "the rover is in mode HOLD; switch it to GUIDED"),
        (armed(99), Mode::Fault, "the rover is in mode 99; switch it to GUIDED"),
        (beat(15, MavModeFlag::empty()), Mode::Fault, "the rover is disarmed; arm it"),
    ];
    for (input, mode, text) in cases {
        let mut bridge = ready();
        bridge.take(drive(1), 0.01);
        let out = bridge.take(input, 0.02);
        assert_eq!((state(&out).mode, state(&out).text.as_deref()), (mode, Some(text)));
        assert_eq!(speeds(&out), [(0.0, 0.0)], "{text}");
    }
}

#[test]
fn a_silent_rover_is_named() {
    let mut bridge = Bridge::new(config(), 0.0);
    let out = bridge.take(Input::Tick, 5.0);
    assert!(matches!(out[0], Output::Say(FromVehicle::Hello(_))));
    assert!(state(&out).text.unwrap().starts_with("no heartbeat of the rover"));
    let mut bridge = ready();
    let out = bridge.take(Input::Tick, 1.2);
    assert!(state(&out).text.unwrap().starts_with("no pose is arriving"));
    let out = bridge.take(attitude(6200, 0.0, 0.0), 1.21);
    assert!(out.is_empty());
    let out = bridge.take(position(6200, 0.0), 1.21);
    assert!(state(&out).text.unwrap().starts_with("no scan is arriving"));
}

#[test]
fn poses_are_those_of_east_and_north_with_the_yaw_of_their_time() {
    let mut bridge = ready();
    bridge.take(attitude(5100, 0.1, 0.0), 0.12);
    let out = bridge.take(position(5100, 2.0), 0.12);
    let readings = readings(&out).unwrap();
    let pose = readings.pose.unwrap();
    assert_eq!((pose.x_m, pose.y_m), (0.0, 2.0));
    assert!((pose.heading_rad - (std::f64::consts::FRAC_PI_2 - 0.1)).abs() < 1e-6);
    assert!((readings.stamp_s - 0.1).abs() < 1e-9, "when it was measured");
}

/// A robot that begins to turn between two attitudes must not seem to have turned since the older one.
#[test]
fn a_position_waits_for_the_attitude_of_its_time() {
    let mut bridge = ready();
    assert!(readings(&bridge.take(position(5200, 2.0), 0.2)).is_none());
    let out = bridge.take(attitude(5100, 0.2, 9.0), 0.21);
    let pose = readings(&out).unwrap().pose.unwrap();
    assert!((pose.y_m - 1.0).abs() < 1e-6, "between two positions: {pose:?}");
    let out = bridge.take(attitude(5300, 0.4, 9.0), 0.31);
    let pose = readings(&out).unwrap().pose.unwrap();
    assert!((pose.heading_rad - (std::f64::consts::FRAC_PI_2 - 0.3)).abs() < 1e-6 && pose.y_m == 2.0);
    assert!(readings(&bridge.take(attitude(5250, 3.0, 0.0), 0.4)).is_none(), "overtaken");
}

#[test]
fn doubled_and_overtaken_poses_are_dropped_and_a_restart_is_not() {
    let mut bridge = ready();
    bridge.take(attitude(5100, 0.0, 0.0), 0.1);
    assert!(readings(&bridge.take(position(5100, 0.1), 0.1)).is_some());
    assert!(readings(&bridge.take(position(5100, 0.1), 0.2)).is_none());
    assert!(readings(&bridge.take(position(4950, 0.0), 0.2)).is_none());
    bridge.take(attitude(100, 0.0, 0.0), 0.3);
    assert!(readings(&bridge.take(position(100, 0.0), 0.3)).is_some());
}

#[test]
fn a_late_scan_is_sent_as_seen_from_the_pose_of_the_readings() {
    let mut bridge = ready();
    bridge.take(attitude(5100, 0.0, 0.0), 0.1);
    bridge.take(position(5100, 1.0), 0.1);
    bridge.take(sectors_at(5_050_000), 0.15);
    bridge.take(attitude(5200, 0.5, 0.0), 0.2);
    let scan = readings(&bridge.take(position(5200, 2.0), 0.2)).unwrap().scan.clone().unwrap();
    assert!((scan.first_rad - 0.5).abs() < 1e-6, "the robot has turned clockwise since: {scan:?}");
    assert!((scan.sensor_m[0] + 1.5 * 0.5_f64.cos()).abs() < 1e-6, "1.5 m behind: {scan:?}");
    bridge.take(sectors_at(5_040_000), 0.25);
    bridge.take(attitude(5300, 0.5, 0.0), 0.3);
    assert_eq!(readings(&bridge.take(position(5300, 2.0), 0.3)).unwrap().scan, None, "overtaken");
}

#[test]
fn scans_that_are_too_old_are_named() {
    let mut bridge = ready();
    for tick in 1..30_u32 {
        let (ms, now_s) = (5000 + 100 * tick, 0.1 * f64::from(tick));
        bridge.take(attitude(ms, 0.0, 0.0), now_s);
        bridge.take(position(ms, 0.0), now_s);
        bridge.take(sectors_at(u64::from(ms) * 1000 - 800_000), now_s);
    }
    let out = bridge.take(Input::Tick, 3.5);
    let text = state(&out).text.unwrap();
    assert_eq!(text, "OBSTACLE_DISTANCE: the scan is 0.8 s older than the newest pose; compare their clocks");
}

#[test]
fn doubled_ranges_count_once() {
    let mut bridge = ready();
    let ranges = |time_usec| {
        let mut array =
            DEBUG_FLOAT_ARRAY_DATA { name: "ae".into(), time_usec, ..DEBUG_FLOAT_ARRAY_DATA::default() };
        array.data[0] = 4.5;
        from(1, MavMessage::DEBUG_FLOAT_ARRAY(array))
    };
    let mut heard = |time_usec, ms: u32| {
        bridge.take(ranges(time_usec), f64::from(ms - 5000) / 1e3);
        bridge.take(attitude(ms, 0.0, 0.0), f64::from(ms - 5000) / 1e3);
        let out = bridge.take(position(ms, 0.0), f64::from(ms - 5000) / 1e3);
        readings(&out).unwrap().ae.is_some()
    };
    assert_eq!(
        [heard(5_050_000, 5100), heard(5_050_000, 5200), heard(4_900_000, 5300)],
        [true, false, false]
    );
    assert!(heard(5_400_000, 5450));
}

#[test]
fn poses_can_come_from_odometry() {
    let mut bridge = Bridge::new(Config { pose: PoseFrom::Odometry, scan: false, ..config() }, 0.0);
    bridge.take(armed(15), 0.0);
    let odometry = |usec, x| {
        let at = ODOMETRY_DATA { time_usec: usec, x, q: [1.0, 0.0, 0.0, 0.0], ..ODOMETRY_DATA::default() };
        from(1, MavMessage::ODOMETRY(at))
    };
    bridge.take(odometry(5_000_000, 0.0), 0.1);
    let out = bridge.take(odometry(5_100_000, 1.5), 0.2);
    assert_eq!(readings(&out).unwrap().pose.unwrap().y_m, 1.5);
}

#[test]
fn readings_carry_ranges_and_named_values() {
    let mut bridge = ready();
    let mut array = DEBUG_FLOAT_ARRAY_DATA { name: "ae".into(), ..DEBUG_FLOAT_ARRAY_DATA::default() };
    array.data[0] = 4.5;
    bridge.take(from(1, MavMessage::DEBUG_FLOAT_ARRAY(array)), 0.05);
    for (name, value) in [("tether", 3.5), ("bumper", 1.0), ("bumper", 0.0), ("other", 9.0)] {
        let named = NAMED_VALUE_FLOAT_DATA { name: name.into(), value, ..NAMED_VALUE_FLOAT_DATA::default() };
        bridge.take(from(1, MavMessage::NAMED_VALUE_FLOAT(named)), 0.06);
    }
    bridge.take(attitude(5100, 0.0, 0.0), 0.1);
    let out = bridge.take(position(5100, 0.0), 0.1);
    let readings = readings(&out).unwrap();
    assert_eq!(readings.ae.as_ref().unwrap().ranges[0].ranges_m, [4.5]);
    assert_eq!(readings.tether.unwrap().paid_out_m, 3.5);
    assert_eq!(readings.contact, Some(true), "a short contact is not lost");
}

#[test]
fn commands_of_another_ground_station_are_a_fault() {
    let mut bridge = ready();
    bridge.take(drive(1), 0.01);
    let manual = || MavMessage::MANUAL_CONTROL(MANUAL_CONTROL_DATA::default());
    let out = bridge.take(from(254, manual()), 0.02);
    assert_eq!((state(&out).mode, state(&out).commander), (Mode::Fault, Commander::OtherProgram));
    assert_eq!(state(&out).text.as_deref(), Some("ground station 254 is commanding the rover, too"));
    assert_eq!(speeds(&out), [(0.0, 0.0)]);
    let out = ready().take(from(255, manual()), 0.6);
    assert_eq!(state(&out).mode, Mode::Ready, "an echo of the adapter itself");
}

#[test]
fn messages_of_other_systems_and_bad_values_do_not_pass() {
    let mut bridge = ready();
    let at = LOCAL_POSITION_NED_DATA { time_boot_ms: 5100, ..LOCAL_POSITION_NED_DATA::default() };
    assert!(readings(&bridge.take(from(7, MavMessage::LOCAL_POSITION_NED(at)), 0.1)).is_none());
    let out = bridge.take(position(5100, f32::NAN), 0.1);
    assert!(readings(&out).is_none());
    assert!(state(&out).text.unwrap().starts_with("LOCAL_POSITION_NED: x: NaN"));
    let out = ready().take(attitude(5100, f32::NAN, 0.0), 0.1);
    assert!(state(&out).text.unwrap().starts_with("ATTITUDE: yaw: NaN"));
}

#[test]
fn the_battery_is_said() {
    let mut bridge = ready();
    let battery =
        |battery_remaining| BATTERY_STATUS_DATA { battery_remaining, ..BATTERY_STATUS_DATA::default() };
    bridge.take(from(1, MavMessage::BATTERY_STATUS(battery(87))), 0.1);
    assert_eq!(state(&bridge.take(Input::Tick, 0.6)).battery, Some(0.87));
    bridge.take(from(1, MavMessage::BATTERY_STATUS(battery(-1))), 0.7);
    assert_eq!(state(&bridge.take(Input::Tick, 1.2)).battery, None);
}

#[test]
fn the_adapter_beats_and_asks_for_poses() {
    let mut bridge = Bridge::new(config(), 0.0);
    let sent = |out: Vec<Output>| -> (usize, Vec<f32>) {
        let messages: Vec<_> = out
            .into_iter()
            .filter_map(|of| if let Output::Send(message) = of { Some(*message) } else { None })
            .collect();
        let beats = messages.iter().filter(|of| matches!(of, MavMessage::HEARTBEAT(_))).count();
        let ids = messages.iter().filter_map(|of| match of {
            MavMessage::COMMAND_LONG(command) => Some(command.param1),
            _ => None,
        });
        (beats, ids.collect())
    };
    assert_eq!(sent(bridge.take(Input::Tick, 0.0)), (1, vec![32.0, 30.0]));
    assert_eq!(sent(bridge.take(Input::Tick, 0.5)), (0, vec![]));
    assert_eq!(sent(bridge.take(Input::Tick, 1.0)), (1, vec![]));
}
