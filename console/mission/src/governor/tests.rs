#![allow(clippy::unwrap_used, reason = "tests")]

use super::*;
use proptest::prelude::*;
use world::{Boundary, Shape};

fn limits(motion: Motion, v: f64, w: f64, acceleration_m_per_s2: f64, tick_s: f64) -> Limits {
    Limits {
        motion,
        v_max_m_per_s: v,
        w_max_rad_per_s: w,
        radius_m: 0.2,
        sensing_range_m: 4.0,
        acceleration_m_per_s2,
        tick_s,
        amphibious: None,
    }
}

fn here(pose: Pose, limits: Limits) -> Here {
    Here { pose, error_m: 0.0, limits }
}

/// A room of 8 m by 6 m with a column and a bar in it.
fn room() -> (Boundary, [Shape; 2]) {
    let corners = [(-4.0, -3.0), (4.0, -3.0), (4.0, 3.0), (-4.0, 3.0)];
    let wall = Boundary::Polygon { vertices: corners.map(|(x, y)| Point::new(x, y)).to_vec() };
    let bar =
        Shape::Polyline { points: vec![Point::new(-2.0, -1.5), Point::new(0.5, -1.5)], half_width_m: 0.05 };
    (wall, [Shape::Disc { center: Point::new(1.5, 1.0), radius_m: 0.4 }, bar])
}

fn room_left_m((wall, shapes): &(Boundary, [Shape; 2]), at: Point) -> f64 {
    shapes.iter().map(|shape| shape.distance_m(at)).fold(wall.wall_distance_m(at), f64::min) - 0.2
}

fn solids((wall, shapes): &(Boundary, [Shape; 2])) -> Vec<Solid<'_>> {
    let shapes = shapes.iter().map(|shape| Solid { outline: Outline::Shape(shape), is_seen: true });
    shapes.chain([Solid { outline: Outline::Wall(wall), is_seen: false }]).collect()
}

fn any_drive(motion: Motion) -> impl Strategy<Value = Drive> {
    (-2.0..2.0_f64, -3.0..3.0_f64).prop_map(move |(a, b)| match motion {
        Motion::Point => Drive::Velocity(Vector::new(a, b)),
        // Mostly ahead, like the commands of planners.
        Motion::Unicycle => Drive::Twist { v_m_per_s: a.abs() * a.signum().max(-0.3), w_rad_per_s: b },
    })
}

fn any_motion() -> impl Strategy<Value = Motion> {
    prop_oneof![Just(Motion::Point), Just(Motion::Unicycle)]
}

proptest! {
    #[test]
    fn whatever_is_asked_for_nothing_is_touched(
        (motion, drives) in any_motion().prop_flat_map(|motion| {
            (Just(motion), prop::collection::vec((any_drive(motion), 1..12_usize), 5..40))
        }),
        v in 0.1..1.5_f64, w in 0.17..2.1_f64, acceleration in 0.05..2.0_f64, tick_s in 0.05..0.5_f64,
        heading_rad in -3.1..3.1_f64,
    ) {
        let tank = room();
        let limits = limits(motion, v, w, acceleration, tick_s);
        let mut pose = Pose { position: Point::new(-1.0, 0.5), heading_rad };
        let mut momentum = Momentum::NONE;
        for (drive, ticks) in drives {
            for _ in 0..ticks {
                let here = here(pose, limits);
                let around = Surroundings::of(&solids(&tank), &here);
                let sent = governed(&momentum, drive, &here, &around);
                let motions = momentum.motions(sent, &here);
                (pose, momentum) = (motions.end, motions.after);
                prop_assert!(room_left_m(&tank, pose.position) > 0.0, "{} at {}", momentum.speed_m_per_s(), pose.position);
            }
        }
        // The operator's HOLD.
        while momentum.speed_m_per_s().abs() > 1e-9 {
            let motions = momentum.motions(Drive::STILL, &here(pose, limits));
            (pose, momentum) = (motions.end, motions.after);
            prop_assert!(room_left_m(&tank, pose.position) > 0.0);
        }
    }
}

fn sent(momentum: &Momentum, drive: Drive, here: &Here) -> Drive {
    let tank = room();
    governed(momentum, drive, here, &Surroundings::of(&solids(&tank), here))
}

#[test]
fn far_from_everything_a_command_stays_as_it_is() {
    let here = here(Pose::new(-1.0, 0.5, 0.0), limits(Motion::Unicycle, 0.4, 1.0, 0.5, 0.1));
    let drive = Drive::Twist { v_m_per_s: 0.4, w_rad_per_s: 0.2 };
    assert_eq!(sent(&Momentum::NONE, drive, &here), drive);
}

#[test]
fn a_robot_before_a_wall_still_turns() {
    let here = here(Pose::new(3.789, 0.0, 0.0), limits(Motion::Unicycle, 0.4, 1.0, 0.5, 0.1));
    let drive = sent(&Momentum::NONE, Drive::Twist { v_m_per_s: 0.4, w_rad_per_s: 1.0 }, &here);
    let Drive::Twist { v_m_per_s, w_rad_per_s } = drive else { panic!("a unicycle receives twists") };
    assert!(v_m_per_s < 0.05 && (w_rad_per_s - 1.0).abs() < 1e-12, "{drive:?}");
}

#[test]
fn a_robot_that_touches_something_may_leave_it_and_not_go_on() {
    let limits = limits(Motion::Unicycle, 0.4, 1.0, 0.5, 0.1);
    let into = here(Pose::new(3.81, 0.0, 0.0), limits);
    let away = here(Pose::new(3.81, 0.0, 3.0), limits);
    let drive = Drive::Twist { v_m_per_s: 0.4, w_rad_per_s: 0.0 };
    assert_eq!(sent(&Momentum::NONE, drive, &away), drive);
    let Drive::Twist { v_m_per_s, .. } = sent(&Momentum::NONE, drive, &into) else { panic!("a twist") };
    assert!(v_m_per_s < 0.005, "{v_m_per_s}");
}

#[test]
fn no_robot_is_faster_than_it_can_stop_within_what_it_sees() {
    let short_sighted = Limits { sensing_range_m: 0.5, ..limits(Motion::Unicycle, 1.5, 1.0, 0.2, 0.1) };
    let open = Surroundings { solids: Vec::new() };
    let mut momentum = Momentum::NONE;
    for _ in 0..200 {
        let here = here(Pose::new(0.0, 0.0, 0.0), short_sighted);
        let drive = governed(&momentum, Drive::Twist { v_m_per_s: 1.5, w_rad_per_s: 0.0 }, &here, &open);
        momentum = momentum.after(drive, &here);
        assert!(Braking::of(&short_sighted).distance_m(momentum.speed_m_per_s()) <= 0.5);
    }
    assert!((momentum.speed_m_per_s() - Braking::of(&short_sighted).speed_within(0.5)).abs() < 0.02);
}
