use super::*;
use crate::types::{Dimension, Layout, Quaternion, Vector3};
use std::f64::consts::FRAC_PI_2;

fn mounted(text: &str) -> ScanSource {
    toml::from_str(&format!("topic = \"/scan\"\n{text}")).unwrap()
}

fn laser() -> LaserScan {
    LaserScan {
        angle_min: -1.0,
        angle_increment: 0.5,
        range_min: 0.1,
        range_max: 8.0,
        ranges: vec![1.0, f32::INFINITY, 0.05, f32::NAN, 9.0, f32::NEG_INFINITY],
        ..LaserScan::default()
    }
}

#[test]
fn a_heading_comes_from_its_quaternion() {
    let at = |heading: f64| types::Pose {
        position: Vector3 { x: 1.0, y: -2.0, z: 0.3 },
        orientation: Quaternion {
            z: (heading / 2.0).sin(),
            w: (heading / 2.0).cos(),
            ..Quaternion::default()
        },
    };
    for heading in [0.0, 1.0, -2.0, 3.1] {
        let pose = pose(&at(heading)).unwrap();
        assert!((pose.heading_rad - heading).abs() < 1e-12 && pose.x_m == 1.0 && pose.y_m == -2.0);
    }
}

#[test]
fn a_pose_that_is_none_is_named() {
    let none = types::Pose::default();
    assert_eq!(pose(&none).unwrap_err(), "orientation: 0, 0, 0, 0 is not a rotation");
    let position = Vector3 { y: f64::NAN, ..Vector3::default() };
    assert!(pose(&types::Pose { position, ..none }).unwrap_err().starts_with("position.y: NaN"));
}

#[test]
fn rays_without_an_echo_are_none_and_something_too_near_is_0() {
    let scan = scan(&laser(), &mounted("")).unwrap();
    assert_eq!((scan.first_rad, scan.step_rad, scan.range_max_m), (-1.0, 0.5, 8.0));
    assert_eq!(scan.ranges_m, [Some(1.0), None, None, None, None, Some(0.0)]);
}

#[test]
fn a_sensor_ahead_one_that_is_turned_and_one_upside_down() {
    let ahead = scan(&laser(), &mounted("ahead_m = 0.5")).unwrap();
    assert_eq!(ahead.sensor_m, [0.5, 0.0]);
    let turned = scan(&laser(), &mounted("turned_deg = 90.0")).unwrap();
    assert!((turned.first_rad - (FRAC_PI_2 - 1.0)).abs() < 1e-12 && turned.step_rad == 0.5);
    let hanging = scan(&laser(), &mounted("upside_down = true")).unwrap();
    assert_eq!((hanging.first_rad, hanging.step_rad), (1.0, -0.5));
}

#[test]
fn a_scan_that_is_none_is_named() {
    let still = LaserScan { angle_increment: 0.0, ..laser() };
    assert!(scan(&still, &mounted("")).unwrap_err().contains("angle_increment: 0"));
    let blind = LaserScan { range_max: f32::NAN, ..laser() };
    assert!(scan(&blind, &mounted("")).unwrap_err().starts_with("range_max: NaN"));
    let many = LaserScan { ranges: vec![1.0; 5000], ..laser() };
    assert!(scan(&many, &mounted("")).unwrap_err().starts_with("ranges: 5000 rays"));
    let none = LaserScan { ranges: vec![], ..laser() };
    assert!(scan(&none, &mounted("")).unwrap_err().starts_with("ranges: 0 rays"));
}

fn array(stations: &[(&str, u32)], data: &[f64]) -> Float64MultiArray {
    let dim = stations
        .iter()
        .map(|(label, size)| Dimension { label: (*label).to_owned(), size: *size, stride: *size })
        .collect();
    Float64MultiArray { layout: Layout { dim, data_offset: 0 }, data: data.to_vec() }
}

#[test]
fn ranges_follow_each_other_station_by_station() {
    let ae = ranges(&array(&[("A", 2), ("B", 0), ("C", 1)], &[4.2, 4.3, 7.0])).unwrap();
    let of = |n: usize| (ae.ranges[n].station.as_str(), ae.ranges[n].ranges_m.as_slice());
    assert_eq!((of(0), of(1), of(2)), (("A", &[4.2, 4.3][..]), ("B", &[][..]), ("C", &[7.0][..])));
    assert_eq!(ranges(&array(&[], &[])).unwrap().ranges, []);
}

#[test]
fn ranges_that_are_none_are_named() {
    let cases = [
        (
            array(&[("A", 2)], &[1.0]),
            "layout.dim.size: 2 ranges to station A are announced; ranges in the message: 1",
        ),
        (array(&[("A", 1)], &[1.0, 2.0]), "data: ranges beyond the sizes of the stations: 1"),
        (array(&[("A", 1)], &[f64::NAN]), "data: NaN is not a distance to station A"),
        (array(&[("A", 1)], &[-1.0]), "data: -1 is not a distance"),
        (array(&[("", 1)], &[1.0]), "layout.dim.label"),
        (array(&[("A", u32::MAX)], &[1.0]), "layout.dim.size"),
    ];
    for (array, why) in cases {
        let error = ranges(&array).unwrap_err();
        assert!(error.starts_with(why), "{error}");
    }
    let beyond = Float64MultiArray {
        layout: Layout { data_offset: 9, ..array(&[("A", 1)], &[]).layout },
        data: vec![1.0],
    };
    assert!(ranges(&beyond).is_err());
}
