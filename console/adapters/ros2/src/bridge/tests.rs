use super::*;
use crate::types::{Header, PoseWithCovariance, Quaternion, TransformStamped, TwistWithCovariance, Vector3};
use tankops_adapter::message::{Commander, Mode, Readings, State};

fn config() -> Config {
    toml::from_str(include_str!("../../trial/robot.toml")).unwrap()
}

fn at(x: f64) -> Pose {
    Pose {
        position: Vector3 { x, ..Vector3::default() },
        orientation: Quaternion { w: 1.0, ..Quaternion::default() },
    }
}

fn header(frame: &str, stamp_s: f64) -> Header {
    let nanosec = ((stamp_s.fract() * 1e9).round()) as u32;
    Header { stamp: Time { sec: stamp_s as i32, nanosec }, frame_id: frame.to_owned() }
}

fn odometry(x: f64, stamp_s: f64) -> Input {
    Input::Odometry(Box::new(Odometry {
        header: header("odom", stamp_s),
        child_frame_id: "base_link".to_owned(),
        pose: PoseWithCovariance { pose: at(x), covariance: Default::default() },
        twist: TwistWithCovariance::default(),
    }))
}

fn drive(seq: u64) -> Input {
    Input::Console(Some(format!(
        r#"{{"type": "drive", "seq": {seq}, "stamp_s": 1, "lease_s": 0.25, "forward_m_per_s": 0.3, "turn_rad_per_s": 0.1}}"#
    )))
}

fn matched(subscriptions: usize, publishers: usize) -> Input {
    Input::Matched { subscriptions, publishers, wrong_type: None }
}

fn scan() -> Input {
    scan_at(1000.0)
}

fn scan_at(stamp_s: f64) -> Input {
    Input::Scan(Box::new(LaserScan {
        header: header("base_link", stamp_s),
        angle_increment: 0.1,
        range_max: 5.0,
        ranges: vec![1.0],
        ..LaserScan::default()
    }))
}

/// A bridge whose robot is there, at time 0.
fn ready() -> Bridge {
    let mut bridge = Bridge::new(config(), 0.0);
    bridge.take(matched(1, 0), 0.0);
    bridge.take(scan(), 0.0);
    bridge.take(odometry(0.0, 1000.0), 0.0);
    bridge
}

fn published(out: &[Order]) -> Vec<f64> {
    let forward = |of: &Order| match of {
        Order::Move(velocity) => Some(velocity.forward_m_per_s),
        _ => None,
    };
    out.iter().filter_map(forward).collect()
}

fn readings(out: &[Order]) -> Option<&Readings> {
    let readings = |of| match of {
        &Order::Say(FromVehicle::Readings(ref readings)) => Some(readings),
        _ => None,
    };
    out.iter().find_map(readings)
}

fn state(out: &[Order]) -> Option<&State> {
    let state = |of| if let &Order::Say(FromVehicle::State(ref state)) = of { Some(state) } else { None };
    out.iter().rev().find_map(state)
}

#[test]
fn without_a_robot_the_introduction_says_what_is_missing() {
    let mut bridge = Bridge::new(config(), 0.0);
    assert_eq!(state(&bridge.take(Input::Tick, 4.9)), None);
    let out = bridge.take(Input::Tick, 5.0);
    assert!(matches!(out[0], Order::Say(FromVehicle::Hello(_))));
    let said = state(&out).unwrap();
    assert_eq!(said.mode, Mode::Fault);
    assert_eq!(said.text.as_deref(), Some("no pose is arriving on /odom: check topic, type and QoS"));
    let out = bridge.take(odometry(0.0, 1.0), 5.1);
    let text = state(&out).unwrap().text.clone();
    assert_eq!(text.as_deref(), Some("no scan is arriving on /scan: check topic, type and QoS"));
    let out = bridge.take(scan(), 5.2);
    let text = state(&out).unwrap().text.clone();
    assert_eq!(text.as_deref(), Some("the robot does not subscribe to /cmd_vel: check topic, type and QoS"));
}

#[test]
fn readings_carry_what_was_measured_since_the_last_ones() {
    let mut bridge = ready();
    bridge.take(odometry(0.0, 1000.1), 0.1);
    bridge.take(Input::Tether(3.5), 0.11);
    bridge.take(Input::Contact(true), 0.12);
    bridge.take(Input::Contact(false), 0.13);
    bridge.take(scan_at(1000.1), 0.14);
    let out = bridge.take(odometry(0.02, 1000.2), 0.25);
    let readings = readings(&out).unwrap();
    assert!((readings.stamp_s - 0.2).abs() < 1e-6, "measured before it arrived: {}", readings.stamp_s);
    assert_eq!(readings.pose.unwrap().x_m, 0.02);
    assert_eq!(readings.tether.unwrap().paid_out_m, 3.5);
    assert_eq!(readings.contact, Some(true), "a short contact is not lost");
    assert_eq!(readings.scan.as_ref().unwrap().ranges_m, [Some(1.0)]);
}

#[test]
fn a_scan_is_sent_as_seen_from_the_pose_of_the_readings() {
    let mut bridge = ready();
    bridge.take(odometry(0.0, 1000.1), 0.1);
    bridge.take(scan_at(1000.15), 0.18);
    let out = bridge.take(odometry(0.02, 1000.2), 0.2);
    let scan = readings(&out).unwrap().scan.clone().unwrap();
    assert!((scan.sensor_m[0] + 0.01).abs() < 1e-9, "the robot has driven 0.01 m since: {scan:?}");
}

#[test]
fn the_introduction_is_followed_by_readings_with_a_scan() {
    let mut bridge = Bridge::new(config(), 0.0);
    bridge.take(odometry(0.5, 1000.0), 0.0);
    bridge.take(scan(), 0.1);
    let out = bridge.take(matched(1, 0), 0.2);
    assert!(matches!(out[0], Order::Say(FromVehicle::Hello(_))));
    let readings = readings(&out).unwrap();
    assert!(readings.scan.is_some() && readings.stamp_s == 0.0, "{readings:?}");
}

#[test]
fn poses_can_come_from_transforms() {
    let mut config = config();
    config.tf = Some(toml::from_str("frame = \"odom\"\nchild_frame = \"base_link\"").unwrap());
    config.odometry = None;
    let mut bridge = Bridge::new(config, 0.0);
    bridge.take(matched(1, 0), 0.0);
    bridge.take(scan(), 0.0);
    let transform = |frame: &str, child: &str, x| TransformStamped {
        header: header(frame, 1000.0),
        child_frame_id: child.to_owned(),
        transform: at(x),
    };
    let transforms = vec![transform("odom", "base_link", 1.5), transform("base_link", "laser", 9.0)];
    let out = bridge.take(Input::Tf(TFMessage { transforms }), 0.1);
    let readings = readings(&out).unwrap();
    assert_eq!(readings.pose.unwrap().x_m, 1.5);
}

#[test]
fn another_commander_is_a_fault_that_stops_the_robot() {
    let mut bridge = ready();
    bridge.take(drive(1), 0.01);
    let out = bridge.take(Input::OtherCommand, 0.02);
    let said = state(&out).unwrap();
    assert_eq!((said.mode, said.commander), (Mode::Fault, Commander::OtherProgram));
    assert_eq!(said.text.as_deref(), Some("another program is publishing commands on /cmd_vel"));
    assert_eq!(published(&out), [0.0]);
    assert_eq!(published(&bridge.take(drive(2), 0.05)), [0.0]);
    bridge.take(scan(), 2.0);
    bridge.take(odometry(0.0, 1002.0), 2.0);
    assert_eq!(state(&bridge.take(Input::Tick, 2.1)).unwrap().mode, Mode::Ready);
}

#[test]
fn a_robot_that_expects_another_type_of_command_is_named() {
    let mut bridge = ready();
    let kind = "geometry_msgs::msg::dds_::TwistStamped_".to_owned();
    let out = bridge.take(Input::Matched { subscriptions: 0, publishers: 0, wrong_type: Some(kind) }, 0.1);
    let text = state(&out).unwrap().text.clone().unwrap();
    assert_eq!(
        text,
        "the robot expects geometry_msgs::msg::dds_::TwistStamped_ on /cmd_vel: change command.type"
    );
}

#[test]
fn a_silent_publisher_is_mentioned() {
    let mut bridge = ready();
    let out = bridge.take(matched(1, 1), 0.1);
    let said = state(&out).unwrap();
    assert_eq!(said.mode, Mode::Ready);
    assert_eq!(said.text.as_deref(), Some("another program could publish on /cmd_vel"));
}

#[test]
fn messages_that_cannot_be_right_are_named_and_stop_the_robot() {
    let wrong_frame = || {
        let Input::Odometry(mut odometry) = odometry(0.0, 1000.1) else { unreachable!() };
        odometry.child_frame_id = "wheel".to_owned();
        Input::Odometry(odometry)
    };
    let array = Float64MultiArray { data: vec![1.0], ..Float64MultiArray::default() };
    let cases = [
        (odometry(f64::NAN, 1000.1), "/odom: position.x: NaN is not between"),
        (
            wrong_frame(),
            "/odom: child_frame_id: the messages are in frame `wheel`, but the settings state `base_link`",
        ),
        (Input::Scan(Box::default()), "/scan: header.frame_id: the messages are in frame ``, but"),
        (Input::Ranges(array), "/ae/ranges: data: ranges beyond the sizes of the stations: 1"),
        (Input::Tether(f64::NAN), "/tether/paid_out: data: NaN is not a length"),
    ];
    for (input, why) in cases {
        let mut bridge = ready();
        bridge.take(drive(1), 0.05);
        let out = bridge.take(input, 0.1);
        let said = state(&out).unwrap();
        assert!(said.mode == Mode::Fault && said.text.as_ref().unwrap().starts_with(why), "{said:?}");
        assert_eq!(published(&out), [0.0]);
    }
}

#[test]
fn switches_of_the_robot_are_modes_and_its_battery_is_said() {
    let mut bridge = ready();
    bridge.take(Input::Battery(Box::new(BatteryState { percentage: 0.5, ..Default::default() })), 0.1);
    let out = bridge.take(Input::Manual(true), 0.2);
    assert_eq!((state(&out).unwrap().mode, state(&out).unwrap().battery), (Mode::Manual, Some(0.5)));
    let out = bridge.take(Input::EmergencyStop(true), 0.3);
    assert_eq!(state(&out).unwrap().mode, Mode::EmergencyStop);
    assert_eq!(published(&bridge.take(drive(1), 0.4)), [0.0]);
    bridge.take(Input::Battery(Box::new(BatteryState { percentage: f32::NAN, ..Default::default() })), 0.5);
    let out = bridge.take(Input::EmergencyStop(false), 0.6);
    assert_eq!((state(&out).unwrap().mode, state(&out).unwrap().battery), (Mode::Manual, None));
}

#[test]
fn a_pose_that_is_too_old_stops_the_robot() {
    let mut bridge = ready();
    bridge.take(drive(1), 0.9);
    let out = bridge.take(Input::Tick, 1.1);
    assert_eq!(
        state(&out).unwrap().text.as_deref(),
        Some("no pose is arriving on /odom: check topic, type and QoS")
    );
    assert_eq!(published(&out), [0.0]);
}
