use super::*;

/// The example settings that are shipped with the adapter.
const EXAMPLE: &str = include_str!("../../trial/robot.toml");

#[test]
fn the_example_is_valid() {
    let config = Config::parse(EXAMPLE).unwrap();
    assert_eq!(config.command.kind, CommandType::Twist);
    assert_eq!(config.command.qos, Qos { depth: 1, ..config.command.qos });
    assert_eq!(config.pose_topic(), "/odom");
    let all = Has { pose: true, scan: true, contact: true, tether: true, ae: true };
    assert_eq!(config.has(), all);
}

#[test]
fn a_wrong_setting_is_named() {
    let cases = [
        ("type = \"Twist\"", "type = \"Twst\"", "unknown variant `Twst`, expected `Twist` or `TwistStamped`"),
        ("topic = \"/cmd_vel\"", "topic = \"cmd_vel\"", "command.topic: `cmd_vel` does not start with `/`"),
        ("topic = \"/odom\"", "topic = \"/odom-1\"", "odometry.topic: `odom-1` contains `-`"),
        ("topic = \"/odom\"", "topic = \"/a/2b\"", "odometry.topic: `2b` starts with a digit, in `/a/2b`"),
        ("topic = \"/odom\"", "topic = \"/a//b\"", "odometry.topic: a part of the name is empty, in `/a//b`"),
        ("[odometry]", "[odometri]", "unknown field `odometri`"),
        (
            "[odometry]",
            "[tf]\nframe = \"a\"\nchild_frame = \"b\"\n[odometry]",
            "tf: [odometry] is also given",
        ),
        ("radius_m = 0.2", "radius_m = -1.0", "vehicle.radius_m: -1 is out of range"),
        ("ahead_m = 0.0", "ahead_m = 20.0", "scan.ahead_m: 20 is not between -10 and 10"),
        ("depth = 5", "depth = 0", "scan.qos.depth: 0 samples"),
        ("\"best_effort\"", "\"sometimes\"", "unknown variant `sometimes`"),
        ("service = \"/stop\"", "service = \"stop\"", "stop.service: `stop` does not start with `/`"),
        ("domain = 0", "domain = 300", "domain: 300 is out of range"),
    ];
    for (from, to, why) in cases {
        assert!(EXAMPLE.contains(from), "{from}");
        let error = Config::parse(&EXAMPLE.replacen(from, to, 1)).expect_err(to);
        assert!(error.contains(why), "{to}: {error}");
    }
}

#[test]
fn without_a_source_of_poses_the_settings_are_refused() {
    let start = EXAMPLE.find("[odometry]").unwrap();
    let end = start + EXAMPLE[start..].find("\n\n").unwrap();
    let error = Config::parse(&[&EXAMPLE[..start], &EXAMPLE[end..]].concat()).unwrap_err();
    assert_eq!(error, "odometry: missing; the console needs [odometry] or [tf]");
}
