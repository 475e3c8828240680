use super::*;

/// The example settings that are shipped with the adapter.
const EXAMPLE: &str = include_str!("../../trial/rover.toml");

#[test]
fn the_example_is_valid() {
    let config = Config::parse(EXAMPLE).unwrap();
    assert_eq!(config.pose, PoseFrom::LocalPosition);
    assert_eq!(config.has(), Has { pose: true, scan: true, contact: true, tether: true, ae: true });
}

#[test]
fn a_wrong_setting_is_named() {
    let cases = [
        ("udpin:", "udp:", "connection: `udp:127.0.0.1:14550` is not udpin:HOST:PORT"),
        (":14550", ":99999", "connection: `udpin:127.0.0.1:99999` is not"),
        ("system = 255", "system = 1", "own.system: 1 is the system number of the rover"),
        ("system = 255", "system = 0", "own: system and component are 1 to 255"),
        ("\"local_position\"", "\"gps\"", "unknown variant `gps`"),
        ("command_period_s = 0.05", "command_period_s = 2.0", "command_period_s: 2 is out of range"),
        ("tether = \"tether\"", "tether = \"length of tether\"", "tether: `length of tether` is not a name"),
        ("repetitions = 11", "repetitions = 12", "ae.repetitions: 12 for 5 stations are 60 values"),
        ("\"A\"", "\"\"", "ae.stations: a station has an empty name"),
        ("radius_m = 0.2", "radius_m = 0.2\nmotion = \"omni\"", "vehicle.motion: a rover is a unicycle"),
        ("scan = true", "lidar = true", "unknown field `lidar`"),
    ];
    for (from, to, why) in cases {
        assert!(EXAMPLE.contains(from), "{from}");
        let error = Config::parse(&EXAMPLE.replacen(from, to, 1)).expect_err(to);
        assert!(error.contains(why), "{to}: {error}");
    }
}
