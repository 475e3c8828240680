use super::*;
use crate::config::{Mover, Track};
use crate::{
    AeConfig, ChannelFault, Clocks, Disturbances, NoiseModel, PhysicalCable, RobotConfig, TimingErrors,
};
use proptest::prelude::*;
use world::{
    Amphibious, Boundary, Medium, Obstacle, ObstacleId, Point, PressureSensor, Scanner, Shape, Station,
    StationId, Vector, World, Zone, ZoneKind, geometry::wrap_angle_rad,
};

fn robot() -> RobotConfig {
    RobotConfig {
        start: Pose::new(-6.0, 0.0, 0.0),
        radius_m: 0.3,
        v_max_m_per_s: 0.5,
        w_max_rad_per_s: 1.0,
        acceleration_m_per_s2: 1.0,
        sensing_range_m: 3.0,
        slip_mean: 0.03,
        slip_sigma: 0.01,
        odometry_sigma_ratio: 0.02,
        gyro_bias_rad_per_s: 0.001,
        amphibious: None,
        pressure: None,
        scanner: None,
    }
}

fn exact(robot: &RobotConfig) -> RobotConfig {
    RobotConfig {
        slip_mean: 0.0,
        slip_sigma: 0.0,
        odometry_sigma_ratio: 0.0,
        gyro_bias_rad_per_s: 0.0,
        ..robot.clone()
    }
}

fn obstacles() -> Vec<Obstacle> {
    let corner = |x: f64, y: f64| Point::new(x, y);
    let shapes = [
        Shape::Disc { center: corner(-3.0, 0.0), radius_m: 0.5 },
        Shape::Disc { center: corner(0.0, 4.0), radius_m: 0.0 },
        Shape::Polygon { vertices: vec![corner(1.0, -1.0), corner(2.5, -1.0), corner(2.0, 1.0)] },
        Shape::Polyline {
            points: vec![corner(-4.0, -4.0), corner(0.0, -5.0), corner(4.0, -4.5)],
            half_width_m: 0.05,
        },
    ];
    (1..)
        .zip(shapes)
        .map(|(id, shape)| Obstacle { id: ObstacleId(id), name: format!("O{id}"), shape, known: id > 1 })
        .collect()
}

fn config() -> SimConfig {
    let station =
        |id, x, y| Station { id: StationId(id), name: format!("S{id}"), position: Point::new(x, y) };
    SimConfig {
        world: World {
            boundary: Boundary::Circle { radius_m: 10.0 },
            obstacles: obstacles(),
            stations: vec![station(1, 7.5, 0.0), station(2, -7.5, 0.0), station(3, 0.0, 7.5)],
            zones: vec![],
        },
        robot: robot(),
        ae: Some(AeConfig {
            period_s: 1.0,
            repetitions: 5,
            noise: NoiseModel::Uniform { ratio: 0.05 },
            timing: TimingErrors::default(),
            clocks: Clocks::default(),
            pulse_rest_s: None,
            dropout_probability: 0.1,
            outages_s: vec![(3.0, 4.0)],
            disturbances: Disturbances::default(),
        }),
        tick_s: 0.1,
        movers: vec![],
        tether_anchor: None,
        reel_length_m: None,
        physical: None,
        channel_faults: vec![],
    }
}

fn any_drive() -> impl Strategy<Value = Drive> {
    let number = || prop_oneof![9 => -2.0..2.0_f64, 1 => prop::num::f64::ANY];
    prop_oneof![
        (number(), number()).prop_map(|(v_m_per_s, w_rad_per_s)| Drive::Twist { v_m_per_s, w_rad_per_s }),
        (number(), number()).prop_map(|(x, y)| Drive::Velocity(Vector::new(x, y))),
    ]
}

fn numbers_of(readings: &Readings) -> Vec<f64> {
    let Odometry { forward_m, sideways_m, turn_rad } = readings.odometry;
    let ranges = readings.ranges.iter().flat_map(|set| set.ranges_m.clone());
    let centers = readings.sightings.iter().map(|s| s.shape_in_robot.center()).flat_map(|c| [c.x, c.y]);
    ranges.chain(centers).chain([forward_m, sideways_m, turn_rad]).collect()
}

fn ahead(v_m_per_s: f64) -> Drive {
    Drive::Twist { v_m_per_s, w_rad_per_s: 0.0 }
}

proptest! {
    #[test]
    fn the_robot_never_is_faster_than_it_can_nor_inside_an_obstacle(
        drives in prop::collection::vec((any_drive(), 1..20_usize), 1..30), seed in any::<u64>(),
    ) {
        let mut sim = Simulator::new(config(), seed);
        for drive in drives.iter().flat_map(|(drive, ticks)| std::iter::repeat_n(*drive, *ticks)) {
            let before = sim.truth().pose;
            let readings = sim.sense();
            sim.act(drive);
            let truth = sim.truth();
            prop_assert!(truth.clearance_m >= 0.0, "{truth:?}");
            prop_assert!((truth.pose.position - before.position).norm() <= 0.05 + 1e-9);
            if matches!(drive, Drive::Twist { .. }) {
                prop_assert!(wrap_angle_rad(truth.pose.heading_rad - before.heading_rad).abs() <= 0.1 + 1e-9);
            }
            prop_assert!(numbers_of(&readings).iter().all(|n| n.is_finite()));
            prop_assert!(readings.ranges.iter().flat_map(|set| &set.ranges_m).all(|r| *r > 0.0));
        }
    }

    #[test]
    fn the_same_seed_gives_the_same_readings(
        drives in prop::collection::vec(any_drive(), 1..60), seed in any::<u64>(),
    ) {
        let run = |seed: u64| {
            let mut sim = Simulator::new(config(), seed);
            drives.iter().map(|drive| { let readings = sim.sense(); sim.act(*drive); readings }).collect::<Vec<_>>()
        };
        prop_assert_eq!(run(seed), run(seed));
    }

    #[test]
    fn any_finite_numbers_in_the_robot_are_survived(
        numbers in prop::collection::vec(prop_oneof![-3.0..3.0_f64, prop::num::f64::NORMAL, Just(0.0)], 14),
        drives in prop::collection::vec(any_drive(), 1..6),
    ) {
        let n = |i: usize| numbers[i];
        let mut config = config();
        config.robot = RobotConfig {
            start: Pose::new(-6.0, 0.0, 0.0), radius_m: n(0), v_max_m_per_s: n(1), w_max_rad_per_s: n(2),
            acceleration_m_per_s2: n(3), sensing_range_m: n(4), slip_mean: n(5), slip_sigma: n(6),
            odometry_sigma_ratio: n(7), gyro_bias_rad_per_s: n(8),
            amphibious: None,
            pressure: Some(PressureSensor { depth_m: n(1), sigma_pa: n(2) }),
            scanner: Some(Scanner {
                rays: 9, field_of_view_rad: n(3), range_m: n(4), rate_hz: n(5), sigma_m: n(6), lost_share: n(7),
                offset_m: [n(8), n(9)], heading_rad: n(10),
            }),
        };
        config.tick_s = n(9);
        config.ae = Some(AeConfig {
            period_s: n(10), repetitions: 2, noise: NoiseModel::Gaussian { sigma_ratio: n(11) },
            timing: TimingErrors { jitter_m: n(12), resolution_m: n(13) }, dropout_probability: n(5),
            clocks: Clocks { is_emission_unknown: true, offset_sigma_m: n(12), drift_sigma_m_per_h: n(13) },
            pulse_rest_s: None,
            outages_s: vec![(n(6), n(7))],
            disturbances: Disturbances {
                outlier_probability: n(8), outlier_factor: n(9), excess_range_mean_m: n(10), nlos_probability: n(11),
                survey_sigma_m: n(3), sound_speed_error_ratio: n(4), ..Disturbances::default()
            },
        });
        let mut sim = Simulator::new(config, 1);
        for drive in drives {
            let readings = sim.sense();
            prop_assert!(numbers_of(&readings).iter().all(|n| !n.is_nan()), "{readings:?}");
            sim.act(drive);
            let pose = sim.truth().pose;
            prop_assert!(pose.position.iter().all(|c| c.is_finite()) && pose.heading_rad.is_finite(), "{pose:?}");
        }
    }
}

/// The readings of a drive without contacts.
fn free_run(config: SimConfig) -> Vec<Readings> {
    let mut sim = Simulator::new(config, 42);
    let drive = Drive::Twist { v_m_per_s: 0.3, w_rad_per_s: 0.3 };
    let step = |sim: &mut Simulator| {
        let readings = sim.sense();
        sim.act(drive);
        readings
    };
    (0..100).map(|_| step(&mut sim)).collect()
}

#[test]
fn turning_one_noise_off_does_not_change_the_others() {
    let whole = free_run(config());
    let mut without_ranging_noise = config();
    without_ranging_noise.ae = None;
    let odometry = |run: &[Readings]| run.iter().map(|r| r.odometry).collect::<Vec<_>>();
    assert_eq!(odometry(&free_run(without_ranging_noise)), odometry(&whole));
    let mut without_odometry_noise = config();
    without_odometry_noise.robot.odometry_sigma_ratio = 0.0;
    let ranges = |run: &[Readings]| run.iter().map(|r| r.ranges.clone()).collect::<Vec<_>>();
    let exact_odometry = free_run(without_odometry_noise);
    assert_eq!(ranges(&exact_odometry), ranges(&whole));
    assert_ne!(odometry(&exact_odometry), odometry(&whole));
}

#[test]
fn another_seed_gives_other_readings() {
    let readings = |seed| {
        let mut sim = Simulator::new(config(), seed);
        sim.act(ahead(0.5));
        sim.sense().odometry
    };
    assert_ne!(readings(1), readings(2));
}

#[test]
fn a_circle_is_driven_exactly() {
    let mut config = SimConfig { robot: exact(&robot()), tick_s: 0.1, ..config() };
    config.robot.acceleration_m_per_s2 = 1e3;
    let start = Pose::new(6.0, 0.0, std::f64::consts::FRAC_PI_2);
    config.robot.start = start;
    let mut sim = Simulator::new(config, 1);
    let mut reckoned = start;
    // A quarter of a circle of radius 1 about (5, 0) in 50 ticks.
    let w_rad_per_s = std::f64::consts::FRAC_PI_2 / 5.0;
    for _ in 0..50 {
        sim.act(Drive::Twist { v_m_per_s: w_rad_per_s, w_rad_per_s });
        let Odometry { forward_m, sideways_m, turn_rad } = sim.sense().odometry;
        reckoned = reckoned.moved(forward_m, sideways_m, turn_rad);
    }
    let pose = sim.truth().pose;
    assert!((pose.position - Point::new(5.0, 1.0)).norm() < 1e-9, "{pose:?}");
    assert!((reckoned.position - pose.position).norm() < 1e-9);
    assert_eq!(sim.tick(), 50);
}

#[test]
fn exact_odometry_of_a_point_robot_adds_up_to_the_truth() {
    let mut sim = Simulator::new(SimConfig { robot: exact(&robot()), ..config() }, 1);
    let mut reckoned = robot().start;
    for k in 0..120 {
        let angle = f64::from(k) * 0.2;
        sim.act(Drive::Velocity(Vector::new(angle.cos(), angle.sin()) * 0.4));
        let Odometry { forward_m, sideways_m, turn_rad } = sim.sense().odometry;
        reckoned = reckoned.moved(forward_m, sideways_m, turn_rad);
    }
    let truth = sim.truth().pose;
    assert!((truth.position - robot().start.position).norm() > 0.1);
    assert!((reckoned.position - truth.position).norm() < 1e-9);
    assert!(wrap_angle_rad(reckoned.heading_rad - truth.heading_rad).abs() < 1e-9);
}

#[test]
fn slip_shortens_the_way_and_odometry_does_not_feel_it() {
    let mut config = SimConfig { robot: RobotConfig { slip_mean: 0.1, ..exact(&robot()) }, ..config() };
    config.robot.start = Pose::new(-6.0, 2.0, 0.0);
    let mut sim = Simulator::new(config, 1);
    let mut measured = 0.0;
    for _ in 0..100 {
        sim.act(ahead(0.5));
        measured += sim.sense().odometry.forward_m;
    }
    let driven = sim.truth().pose.position.x + 6.0;
    assert!((driven / measured - 0.9).abs() < 1e-9, "{driven} {measured}");
}

#[test]
fn a_robot_that_runs_into_a_column_stops_at_it_and_collides_once() {
    let mut sim = Simulator::new(SimConfig { robot: exact(&robot()), ..config() }, 1);
    let mut collisions = Vec::new();
    for tick in 1..=100 {
        sim.act(ahead(0.5));
        if sim.truth().collided {
            collisions.push(tick);
        }
    }
    assert_eq!(collisions.len(), 1, "{collisions:?}");
    assert!(sim.sense().contact);
    assert!((sim.truth().pose.position.x - -3.8).abs() < 2e-4);
    for _ in 0..10 {
        sim.act(ahead(-0.5));
    }
    assert!(!sim.sense().contact && !sim.truth().collided);
}

#[test]
fn the_start_is_sensed_at_rest_without_a_cycle() {
    let mut sim = Simulator::new(config(), 1);
    let readings = sim.sense();
    assert_eq!(readings.odometry, Odometry::default());
    assert!(!readings.ranging_cycle && !readings.contact);
    assert_eq!(readings.sightings.iter().map(|s| s.id.0).collect::<Vec<_>>(), [1]);
}

#[test]
fn a_cycle_without_an_answer_is_reported() {
    let run = free_run(config());
    assert!(run[30].ranging_cycle && run[30].ranges.is_empty());
    assert!(run[10].ranging_cycle && !run[10].ranges.is_empty());
}

/// The positions and speeds of a robot that drives from the flooded west to the dry east at the maximum speed allowed.
fn speeds_across_the_waterline(transition_steps: u32) -> Vec<(f64, f64)> {
    let amphibious = Amphibious { transition_steps, ..Amphibious::YANG_2021 };
    let water =
        vec![Point::new(-9.0, -9.0), Point::new(0.0, -9.0), Point::new(0.0, 9.0), Point::new(-9.0, 9.0)];
    let mut config = config();
    config.world.obstacles.clear();
    config.world.zones = vec![Zone {
        name: "basin".into(),
        kind: ZoneKind::Underwater,
        shape: Shape::Polygon { vertices: water },
    }];
    let start = Pose::new(-1.0, 0.0, 0.0);
    config.robot =
        RobotConfig { start, acceleration_m_per_s2: 0.1, amphibious: Some(amphibious), ..exact(&robot()) };
    let mut simulator = Simulator::new(config, 1);
    let mut speeds = Vec::new();
    for _ in 0..200 {
        let before = simulator.truth().pose.position;
        simulator.act(Drive::Twist { v_m_per_s: 0.23, w_rad_per_s: 0.0 });
        let after = simulator.truth().pose.position;
        speeds.push((before.x, (after - before).norm() / 0.1));
    }
    speeds
}

#[test]
fn an_amphibious_robot_swims_faster_than_it_walks_and_brakes_at_the_waterline() {
    let speeds = speeds_across_the_waterline(20);
    assert!(speeds.iter().any(|(x, speed)| *x < 0.0 && (speed - 0.23).abs() < 1e-9));
    assert!((speeds[199].1 - 0.13).abs() < 1e-9);
    // In each of the 20 steps, the limit falls by 0.005 m/s, half of what the brakes can achieve.
    let falls = speeds.windows(2).map(|w| w[0].1 - w[1].1).fold(0.0, f64::max);
    assert!((falls - 0.005).abs() < 1e-9, "{falls}");
    let instant = speeds_across_the_waterline(0);
    let first = instant.iter().find(|(x, _)| *x > 0.0).map(|(_, speed)| speed - 0.13);
    assert!(first.is_some_and(|over| over > 0.08), "{first:?}");
}

#[test]
fn a_pressure_sensor_reads_the_medium_under_the_true_place() {
    let sensor = PressureSensor { depth_m: 0.5, sigma_pa: 100.0 };
    let mut config = config();
    let shape = Shape::Disc { center: Point::origin(), radius_m: 2.0 };
    config.world.zones = vec![Zone { name: "sump".into(), kind: ZoneKind::Underwater, shape }];
    let mean_pa = |x: f64| {
        let robot = RobotConfig { start: Pose::new(x, 0.0, 0.0), pressure: Some(sensor), ..robot() };
        let mut simulator = Simulator::new(SimConfig { robot, ..config.clone() }, 3);
        (0..400).filter_map(|_| simulator.sense().pressure_pa).sum::<f64>() / 400.0
    };
    // Four standard deviations of a mean of 400.
    assert!((mean_pa(0.0) - sensor.expected_pa(Medium::Underwater)).abs() < 20.0, "{}", mean_pa(0.0));
    assert!(mean_pa(4.0).abs() < 20.0, "{}", mean_pa(4.0));
    assert_eq!(Simulator::new(config.clone(), 3).sense().pressure_pa, None);
}

#[test]
fn what_runs_into_a_robot_that_stands_still_is_a_collision() {
    let shape = Shape::Disc { center: Point::new(3.0, 0.0), radius_m: 0.5 };
    let world = World {
        obstacles: vec![Obstacle { id: ObstacleId(9), name: "M".into(), shape, known: false }],
        ..config().world
    };
    let track = Track::Straight { velocity_m_per_s: nalgebra::Vector2::new(-0.5, 0.0) };
    let movers = vec![Mover { id: ObstacleId(9), track }];
    let robot = RobotConfig { start: Pose::new(0.0, 0.0, 0.0), ..exact(&robot()) };
    let mut sim = Simulator::new(SimConfig { world, robot, movers, tick_s: 0.1, ..config() }, 1);
    let collided = (0..80).find(|_| {
        sim.act(Drive::Twist { v_m_per_s: 0.0, w_rad_per_s: 0.0 });
        sim.truth().collided
    });
    assert!(collided.is_some_and(|tick| (35..60).contains(&tick)), "{collided:?}");
    assert!(sim.sense().contact && sim.sense().sightings.len() == 1);
}

/// A robot on a tether from (-6, 0), in a tank without columns.
fn tethered(reel_length_m: f64) -> Simulator {
    let mut config = config();
    config.world.obstacles.clear();
    config.robot.start = Pose::new(-6.0, 0.0, 0.0);
    (config.tether_anchor, config.reel_length_m) = (Some(Point::new(-6.0, 0.0)), Some(reel_length_m));
    Simulator::new(config, 1)
}

#[test]
fn the_reel_reports_what_it_has_paid_out() {
    let mut sim = tethered(9.0);
    for _ in 0..50 {
        sim.act(ahead(0.4));
        let out_m = (sim.truth().pose.position - Point::new(-6.0, 0.0)).norm();
        assert!(sim.sense().paid_out_m.is_some_and(|reported_m| (reported_m - out_m).abs() < 1e-9));
    }
    assert_eq!(Simulator::new(config(), 1).sense().paid_out_m, None);
}

#[test]
fn at_the_end_of_the_reel_a_robot_pulls_in_vain_but_can_turn_and_come_back() {
    let mut sim = tethered(1.0);
    (0..100).for_each(|_| sim.act(ahead(0.4)));
    let end = sim.truth();
    assert!((end.pose.position.x + 5.0).abs() < 0.06 && !end.collided, "{end:?}");
    (0..20).for_each(|_| sim.act(Drive::Twist { v_m_per_s: 0.0, w_rad_per_s: 0.5 }));
    assert!((sim.truth().pose.heading_rad - end.pose.heading_rad).abs() > 0.5);
    (0..20).for_each(|_| sim.act(ahead(-0.4)));
    assert!((sim.truth().pose.position - end.pose.position).norm() > 0.2);
}

/// A robot on a cable with weight, which drives out for 10 s and back for 8 s; the readings and how the cable lay.
fn out_and_back(pull_n: f64, fails_at_s: Option<f64>) -> Vec<(Readings, world::CableLies)> {
    driven_out_and_back(PhysicalCable { fails_at_s, ..on_reel(pull_n) })
}

fn on_reel(pull_n: f64) -> PhysicalCable {
    let law = crate::CableLaw {
        floor_n_per_m: 0.3,
        friction: 0.3,
        pull_n,
        pay_out_n: 0.5,
        speed_m_per_s: 1.0,
        length_m: 20.0,
    };
    PhysicalCable { law, fails_at_s: None, breaks_at_s: None, breaks_at_n: None }
}

fn driven_out_and_back(physical: PhysicalCable) -> Vec<(Readings, world::CableLies)> {
    let physical = Some(physical);
    let mut sim = Simulator::new(SimConfig { physical, ..tethered(20.0).config }, 1);
    let drives = (0..180).map(|tick| if tick < 100 { 0.5 } else { -0.5 });
    let tick = |v_m_per_s| {
        let (readings, truth) = (sim.sense(), sim.truth());
        sim.act(Drive::Twist { v_m_per_s, w_rad_per_s: 0.0 });
        (readings, truth.tether.unwrap().lies.unwrap())
    };
    drives.map(tick).collect()
}

#[test]
fn a_cable_with_weight_is_slack_behind_a_robot_whose_reel_has_stopped() {
    let paid_out_m = |of: &[(Readings, world::CableLies)], tick: usize| of[tick].0.paid_out_m.unwrap();
    let robot_n = |of: &[(Readings, world::CableLies)], tick: usize| of[tick].0.robot_pull_n.unwrap();
    let taken_up = out_and_back(6.0, None);
    assert!(robot_n(&taken_up, 90) > 6.0 && robot_n(&taken_up, 170) > 1.0);
    assert!(paid_out_m(&taken_up, 179) < paid_out_m(&taken_up, 100) - 3.0);
    assert!(taken_up.iter().all(|(_, lies)| !lies.under_hull));
    let left = out_and_back(6.0, Some(8.0));
    assert_eq!(left[79].0.paid_out_m, taken_up[79].0.paid_out_m, "the reel has not stopped yet");
    assert!(robot_n(&left, 115) < 0.1 && left[170].0.reel_pull_n.unwrap() < 0.1);
    assert!(robot_n(&left, 170) < 0.3 * 2.5, "the robot drags a loop behind itself");
    assert!(paid_out_m(&left, 179) > paid_out_m(&left, 100) - 0.1);
    assert!(left[179].1.under_hull, "the robot is over its own cable");
    assert!(left.iter().filter(|(_, lies)| !lies.line.is_empty()).count() == 18, "one line a second");
    assert_eq!(left, out_and_back(6.0, Some(8.0)), "the same again");
}

#[test]
fn a_cable_that_tears_leaves_the_readings_of_a_loose_end() {
    let whole = out_and_back(6.0, None);
    for torn in [
        driven_out_and_back(PhysicalCable { breaks_at_s: Some(5.0), ..on_reel(6.0) }),
        driven_out_and_back(PhysicalCable { breaks_at_n: Some(6.5), ..on_reel(6.0) }),
    ] {
        let first = torn.iter().position(|(_, lies)| lies.torn).unwrap();
        assert!((20..=51).contains(&first), "{first}");
        assert_eq!(torn[..first], whole[..first], "whole until it tears");
        let (readings, lies) = &torn[first + 40];
        assert!(readings.paid_out_m.unwrap() < 0.01 && readings.reel_pull_n.unwrap() < 0.01, "{readings:?}");
        assert!(readings.robot_pull_n.unwrap() < 0.1 && lies.torn, "{readings:?}");
    }
    assert!(!whole.last().unwrap().1.torn);
}

#[test]
fn a_channel_is_dead_in_every_tick_that_its_fault_touches() {
    let channel_faults = vec![ChannelFault { channel: 3, from_s: 0.25, to_s: 0.5 }];
    let mut sim = Simulator::new(SimConfig { tick_s: 0.1, channel_faults, ..config() }, 1);
    let mut dead = Vec::new();
    for tick in 0..8 {
        if sim.sense().dead_channels.unwrap() == [3] {
            dead.push(tick);
        }
        sim.act(Drive::STILL);
    }
    // The readings of tick 3 are about the time from 0.2 to 0.3 s.
    assert_eq!(dead, [3, 4, 5]);
    assert_eq!(Simulator::new(config(), 1).sense().dead_channels, None);
}
