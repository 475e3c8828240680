use super::*;
use std::f64::consts::PI;

#[test]
fn north_is_up_and_clockwise_becomes_counter_clockwise() {
    let facing_north = pose(3.0, 2.0, 0.0).unwrap();
    assert_eq!((facing_north.x_m, facing_north.y_m, facing_north.heading_rad), (2.0, 3.0, FRAC_PI_2));
    assert_eq!(pose(0.0, 0.0, FRAC_PI_2).unwrap().heading_rad, 0.0, "east is along x");
    assert!(pose(f32::NAN, 0.0, 0.0).unwrap_err().starts_with("x: NaN"));
    assert!(pose(0.0, 0.0, f64::INFINITY).unwrap_err().starts_with("yaw: inf"));
}

#[test]
fn a_yaw_comes_from_its_quaternion() {
    for angle in [0.0, 1.0, -2.5] {
        let q = [(angle / 2.0_f32).cos(), 0.0, 0.0, (angle / 2.0).sin()];
        assert!((yaw(q).unwrap() - f64::from(angle)).abs() < 1e-6);
    }
    assert!(yaw([0.0; 4]).is_err());
}

fn config() -> Config {
    toml::from_str(include_str!("../../trial/rover.toml")).unwrap()
}

#[test]
fn a_command_is_a_speed_ahead_and_a_clockwise_turn_rate() {
    let velocity = Velocity { forward_m_per_s: 0.5, sideways_m_per_s: 0.0, turn_rad_per_s: 0.25 };
    let MavMessage::SET_POSITION_TARGET_LOCAL_NED(sent) = command(velocity, &config(), 7) else { panic!() };
    assert_eq!((sent.vx, sent.yaw_rate, sent.time_boot_ms), (0.5, -0.25, 7));
    assert_eq!(sent.type_mask.bits(), 0x05C7, "velocity and yaw rate, as ArduRover documents it");
    assert_eq!((sent.target_system, sent.target_component), (1, 1));
    assert_eq!(sent.coordinate_frame, AHEAD);
    let MavMessage::SET_POSITION_TARGET_LOCAL_NED(zero) = command(Velocity::ZERO, &config(), 7) else {
        panic!()
    };
    assert!(zero.yaw_rate.is_sign_positive());
}

fn sectors() -> OBSTACLE_DISTANCE_DATA {
    let mut distances = [u16::MAX; 72];
    distances[..3].copy_from_slice(&[150, 10, 801]);
    OBSTACLE_DISTANCE_DATA {
        distances,
        min_distance: 20,
        max_distance: 800,
        increment: 5,
        frame: MavFrame::MAV_FRAME_BODY_FRD,
        ..OBSTACLE_DISTANCE_DATA::default()
    }
}

#[test]
fn sectors_are_a_clockwise_scan() {
    let scan = scan(&OBSTACLE_DISTANCE_DATA { angle_offset: 10.0, ..sectors() }).unwrap();
    assert!((scan.first_rad + PI / 18.0).abs() < 1e-9 && (scan.step_rad + PI / 36.0).abs() < 1e-9);
    assert_eq!((scan.range_max_m, scan.ranges_m.len()), (8.0, 72));
    assert_eq!(scan.ranges_m[..4], [Some(1.5), Some(0.0), None, None]);
    let wide = OBSTACLE_DISTANCE_DATA { increment_f: 22.5, ..sectors() };
    assert_eq!(super::scan(&wide).unwrap().ranges_m.len(), 16, "once around");
}

#[test]
fn sectors_that_are_none_are_named() {
    let cases = [
        (OBSTACLE_DISTANCE_DATA { increment: 0, ..sectors() }, "increment: 0"),
        (OBSTACLE_DISTANCE_DATA { max_distance: 0, ..sectors() }, "max_distance"),
        (
            OBSTACLE_DISTANCE_DATA { angle_offset: f32::NAN, ..sectors() },
            "increment: 5 and angle_offset: NaN",
        ),
        (
            OBSTACLE_DISTANCE_DATA { frame: MavFrame::MAV_FRAME_GLOBAL, ..sectors() },
            "frame: MAV_FRAME_GLOBAL",
        ),
    ];
    for (sectors, why) in cases {
        let error = scan(&sectors).unwrap_err();
        assert!(error.starts_with(why), "{error}");
    }
}

#[test]
fn an_array_holds_the_ranges_station_by_station() {
    let ranging =
        Ranging { name: "ae".into(), stations: vec!["A".into(), "B".into(), "C".into()], repetitions: 2 };
    let mut array = DEBUG_FLOAT_ARRAY_DATA::default();
    array.data[..6].copy_from_slice(&[4.5, 4.25, 0.0, 0.0, 0.0, 7.5]);
    let ae = ranges(&array, &ranging).unwrap();
    let heard: Vec<_> = ae.ranges.iter().map(|of| (of.station.as_str(), of.ranges_m.clone())).collect();
    assert_eq!(heard, [("A", vec![4.5, 4.25]), ("C", vec![7.5])]);
    array.data[3] = f32::NAN;
    assert_eq!(ranges(&array, &ranging).unwrap_err(), "data: NaN is not a distance to station B");
}
