use crate::bench;
use crate::tether_safe::TetherSafe;
use planner_api::testing::Bench;
use planner_api::{Drive, Obstacle, Outline, Planner, PoseEstimate, Sensed, Status};
use trials::tanks::{HULL_M, Known, Tank};
use world::{Point, Vector};

const TICK_S: f64 = 0.1;

fn sensed<'a>(
    tick: u64,
    position: Point,
    heading_rad: f64,
    path: &'a [Point],
    obstacles: &'a [Obstacle<'a>],
) -> Sensed<'a> {
    let end = path.len() - 1;
    let pose = PoseEstimate { position, heading_rad, covariance: nalgebra::Matrix3::zeros() };
    Sensed {
        targets_ahead: &path[end..],
        path_ahead: path,
        obstacles,
        ..Sensed::new(tick, TICK_S, pose, path[end])
    }
}

/// A planner that has made a plan of the tank.
fn ready(tank: &Tank) -> (TetherSafe, Bench, Vec<Point>, Vec<Vec<Point>>) {
    let (planner, plan, bench) = bench::planned::<TetherSafe>(tank, &[("pattern", 1.0), ("kicks", 0.0)]);
    (planner, bench, plan.path, plan.cuts)
}

#[test]
fn the_path_is_flown_closely() {
    let tank = Known::E1.tank(21);
    let (mut planner, bench, path, _) = ready(&tank);
    let path = world::polyline::resampled(&path, 0.1);
    let obstacles = tank.obstacles();
    let (mut at, mut heading_rad, mut next, mut worst_m) = (tank.anchor, 0.0_f64, 1, 0.0_f64);
    for tick in 0..3000 {
        while next + 1 < path.len() && (path[next] - at).norm() < 0.12 {
            next += 1;
        }
        let sensed = sensed(tick, at, heading_rad, &path[next..], &obstacles);
        let command = planner.step(&sensed, &bench.ctx()).unwrap();
        let Drive::Twist { v_m_per_s, w_rad_per_s } = command.drive else { panic!("{:?}", command.drive) };
        assert_ne!(command.status, Status::Stuck, "tick {tick}: {:?}", bench.logs());
        heading_rad += 0.5 * w_rad_per_s * TICK_S;
        at += Vector::new(heading_rad.cos(), heading_rad.sin()) * v_m_per_s * TICK_S;
        heading_rad += 0.5 * w_rad_per_s * TICK_S;
        worst_m = worst_m.max(world::polyline::distance_m(&path[..=next], at));
    }
    assert!(next > 500, "it came no further than point {next}");
    assert!(worst_m < 0.12, "{worst_m}");
}

#[test]
fn it_stops_in_front_of_what_stands_on_the_path() {
    let tank = Known::E1.tank(22);
    let (mut planner, bench, ..) = ready(&tank);
    let path = [Point::new(0.1, 0.0), Point::new(0.8, 0.0)];
    let found = |x: f64| Obstacle {
        id: 90,
        outline: Outline::Disc { center: Point::new(x, 0.0), radius_m: 0.1 },
        discovered: true,
        velocity_m_per_s: Vector::zeros(),
    };
    let status = |planner: &mut TetherSafe, obstacles: &[Obstacle<'_>]| {
        planner.step(&sensed(0, tank.anchor, 0.0, &path, obstacles), &bench.ctx()).unwrap().status
    };
    assert_ne!(status(&mut planner, &[]), Status::Stuck);
    assert_eq!(status(&mut planner, &[found(0.8 + HULL_M)]), Status::Stuck);
    assert!(bench.logs().iter().any(|(_, said)| said.contains("obstacle blocks the path")));
}

/// Places on both sides of a cut; no cut lies between the anchor and the first place.
fn beside_a_cut(anchor: Point, cuts: &[Vec<Point>]) -> (Point, Point) {
    let pairs = cuts.iter().flat_map(|cut| {
        let (foot, end) = (cut[cut.len() - 2], cut[cut.len() - 1]);
        let ahead = (end - foot).normalize();
        let aside = Vector::new(-ahead.y, ahead.x) * 0.1;
        let middle = foot + (end - foot) / 2.0;
        [(middle + aside, middle - aside), (middle - aside, middle + aside)]
    });
    let mut pairs = pairs.filter(|(here, _)| world::tether::crossings(&[anchor, *here], cuts) == 0);
    pairs.next().expect("the anchor sees a cut")
}

#[test]
fn it_never_goes_back_to_the_path_across_a_cut() {
    let tank = Known::E1.tank(23);
    let (mut planner, bench, _, cuts) = ready(&tank);
    let (here, there) = beside_a_cut(tank.anchor, &cuts);
    let mut status = |tick, at, path: &[Point]| {
        planner.step(&sensed(tick, at, 0.0, path, &[]), &bench.ctx()).unwrap().status
    };
    assert_ne!(status(0, tank.anchor, &[here]), Status::Stuck);
    assert_eq!(status(1, here, &[there]), Status::Stuck);
    assert!(bench.logs().iter().any(|(_, said)| said.contains("crosses a cut")), "{:?}", bench.logs());
}

#[test]
fn a_robot_that_scatters_across_a_cut_comes_back_the_way_it_went() {
    let tank = Known::E1.tank(23);
    let (mut planner, bench, _, cuts) = ready(&tank);
    let (here, there) = beside_a_cut(tank.anchor, &cuts);
    let path = [here + (here - there)];
    let mut status =
        |tick, at| planner.step(&sensed(tick, at, 0.0, &path, &[]), &bench.ctx()).unwrap().status;
    status(0, tank.anchor);
    for tick in 1..20 {
        assert_ne!(status(tick, if tick % 2 == 0 { there } else { here }), Status::Stuck, "{tick}");
    }
}

#[test]
fn the_cuts_hold_from_the_end_of_the_way_home_on() {
    let tank = Known::E1.tank(23);
    let (mut planner, bench, _, cuts) = ready(&tank);
    let (here, there) = beside_a_cut(tank.anchor, &cuts);
    let mut status =
        |tick, at, target| planner.step(&sensed(tick, at, 0.0, &[target], &[]), &bench.ctx()).unwrap().status;
    // The task begins at the anchor, but the cable lies across a cut: the return path comes first.
    for (tick, (at, target)) in
        [(here, there), (there, tank.anchor), (tank.anchor, here)].into_iter().enumerate()
    {
        assert_ne!(status(tick as u64, at, target), Status::Stuck, "{tick}");
    }
    assert_ne!(status(3, here, here), Status::Stuck);
    assert_eq!(status(4, here, there), Status::Stuck);
}

#[test]
fn a_change_of_live_parameters_acts_like_a_new_planner() {
    for values in [[("slow_m", 3.0), ("min_share", 0.1)], [("slow_m", 3.0), ("guard_m", 1.0)]] {
        let changed = trials::changed::<TetherSafe>(&[], &values);
        assert!(changed.after == changed.fresh && changed.after != changed.before, "{changed:?}");
    }
}
