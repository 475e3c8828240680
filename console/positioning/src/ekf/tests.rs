use super::*;
use crate::draws::Draws;
use proptest::prelude::*;
use world::Odometry;

fn ahead(forward_m: f64, turn_rad: f64) -> Odometry {
    Odometry { forward_m, sideways_m: 0.0, turn_rad }
}

#[test]
fn without_fixes_the_error_grows_with_the_way() {
    let mut filter = Ekf::new(Pose::new(0.0, 0.0, 0.0), 0.0, 0.0, MotionNoise::default());
    for _ in 0..100 {
        filter.predict(&ahead(0.1, 0.0));
    }
    assert!((filter.pose().position - Point::new(10.0, 0.0)).norm() < 1e-9);
    let sigma = filter.covariance()[(0, 0)].sqrt();
    assert!((0.5..0.52).contains(&sigma), "{sigma}");
}

#[test]
fn motion_makes_the_heading_known() {
    let truth = Pose::new(0.0, 0.0, 0.4);
    let mut filter = Ekf::new(Pose::new(0.0, 0.0, 0.0), 0.05, 0.5, MotionNoise::default());
    let before = filter.covariance()[(2, 2)];
    for k in 1..=20 {
        filter.predict(&ahead(0.3, 0.0));
        let fix = truth.moved(0.3 * f64::from(k), 0.0, 0.0).position;
        assert!(filter.update_position(fix, &(Matrix2::identity() * 0.03_f64.powi(2))).accepted);
    }
    assert!((filter.pose().heading_rad - 0.4).abs() < 0.03, "{}", filter.pose().heading_rad);
    assert!(filter.covariance()[(2, 2)] < before / 50.0);
}

#[test]
fn lasting_slip_is_learnt() {
    let mut filter = Ekf::new(Pose::new(0.0, 0.0, 0.0), 0.05, 0.05, MotionNoise::default());
    let fix_covariance = Matrix2::identity() * 0.03_f64.powi(2);
    for k in 1..=60 {
        filter.predict(&ahead(0.5, 0.0));
        filter.update_position(Point::new(0.5 * 0.92 * f64::from(k), 0.0), &fix_covariance);
    }
    let before = filter.pose().position.x;
    filter.predict(&ahead(1.0, 0.0));
    assert!((filter.pose().position.x - before - 0.92).abs() < 0.01);
}

#[test]
fn a_fix_far_away_is_refused_and_changes_nothing() {
    let mut filter = Ekf::new(Pose::new(1.0, 1.0, 0.0), 0.05, 0.05, MotionNoise::default());
    let before = filter.clone();
    let update = filter.update_position(Point::new(3.0, 1.0), &(Matrix2::identity() * 0.01));
    assert!(!update.accepted && update.nis > 100.0);
    assert_eq!(filter, before);
}

#[test]
fn a_single_range_narrows_the_direction_it_was_measured_in() {
    let mut filter = Ekf::new(Pose::new(0.0, 0.0, 0.0), 0.5, 0.05, MotionNoise::default());
    assert!(filter.update_range(Point::new(5.0, 0.0), 5.2, 0.03).accepted);
    assert!((filter.pose().position.x + 0.2).abs() < 0.01);
    assert!(filter.covariance()[(0, 0)].sqrt() < 0.031);
    assert!((filter.covariance()[(1, 1)].sqrt() - 0.5).abs() < 1e-6);
    assert!((filter.error_95_m() - 0.5 * 2.448).abs() < 1e-3);
}

/// Drives an arc with slip, odometry noise and gyro bias; fixes of 5 cm once a second. Returns the mean error after the
/// first 20 s and the share of ticks with the truth inside the 95 % ellipse.
fn driven_arc(slip: f64, gyro_bias_rad_per_s: f64, seed: u64) -> (f64, f64) {
    let (dt, sigma_m, mut draws) = (0.1, 0.05, Draws::new(0.0, 1, seed));
    let mut truth = Pose::new(4.0, 0.0, 1.5);
    let mut filter = Ekf::new(truth, 0.05, 0.05, MotionNoise::default());
    let (mut error, mut inside, mut counted) = (0.0, 0.0, 0.0);
    for tick in 1..=3000 {
        let (way, turn) = (0.3 * dt, 0.08 * dt);
        truth = truth.moved(way * (1.0 - slip * (1.0 + 0.5 * draws.bell())), 0.0, turn);
        let odometry = ahead(
            way * (1.0 + 0.02 * draws.bell()),
            turn * (1.0 + 0.02 * draws.bell()) + gyro_bias_rad_per_s * dt,
        );
        filter.predict(&odometry);
        if tick % 10 == 0 {
            let at = truth.position + world::Vector::new(draws.bell(), draws.bell()) * sigma_m;
            filter.update_position(at, &(Matrix2::identity() * sigma_m.powi(2)));
        }
        if tick > 200 {
            let off = filter.pose().position - truth.position;
            let inverse = filter.position_covariance().try_inverse().expect("a covariance has an inverse");
            error += off.norm();
            inside += f64::from(u8::from(off.dot(&(inverse * off)) < 5.991));
            counted += 1.0;
        }
    }
    (error / counted, inside / counted)
}

#[test]
fn on_a_driven_arc_the_truth_stays_within_the_ellipse() {
    for (slip, bias) in [(0.0, 0.0), (0.03, 0.001), (0.05, 0.003)] {
        let runs: Vec<(f64, f64)> = (0..10).map(|seed| driven_arc(slip, bias, seed)).collect();
        let error = runs.iter().map(|r| r.0).sum::<f64>() / 10.0;
        let inside = runs.iter().map(|r| r.1).sum::<f64>() / 10.0;
        // A single fix is off by 0.063 m on average.
        assert!(error < 0.045, "slip {slip}, bias {bias}: error {error}, inside {inside}");
        assert!((0.93..=0.999).contains(&inside), "slip {slip}, bias {bias}: error {error}, inside {inside}");
    }
}

fn any_number() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => -10.0..10.0_f64,
        1 => prop::num::f64::ANY,
        1 => prop_oneof![Just(f64::NAN), Just(f64::INFINITY), Just(1e300), Just(-1e300), Just(0.0), Just(1e-300)],
    ]
}

proptest! {
    #[test]
    fn whatever_comes_in_the_state_stays_sound(
        steps in prop::collection::vec((any_number(), any_number(), any_number(), any_number(), 0..4_u8), 1..40),
    ) {
        let mut filter = Ekf::new(Pose::new(0.0, 0.0, 0.0), 0.1, 0.1, MotionNoise::default());
        for (a, b, c, d, what) in steps {
            let covariance = Matrix2::new(c.abs(), d, d, c.abs());
            match what {
                0 => filter.predict(&Odometry { forward_m: a, sideways_m: b, turn_rad: c }),
                1 => { filter.update_position(Point::new(a, b), &covariance); }
                2 => { filter.update_range(Point::new(a, b), c, d); }
                _ => filter.restart_at(Point::new(a, b), &covariance, 0.0, c),
            }
            let numbers = filter.covariance();
            prop_assert!(numbers.iter().all(|n| n.is_finite()));
            prop_assert!((0..3).all(|i| numbers[(i, i)] > 0.0));
            prop_assert!(filter.pose().position.iter().all(|n| n.is_finite()));
            prop_assert!(filter.pose().heading_rad.abs() <= PI);
            prop_assert!(filter.error_95_m().is_finite());
        }
    }

    #[test]
    fn honest_input_keeps_the_covariance_positive(
        steps in prop::collection::vec((-0.5..0.5_f64, -0.5..0.5_f64, 1e-3..1.0_f64), 1..200),
    ) {
        let mut filter = Ekf::new(Pose::new(0.0, 0.0, 0.0), 0.1, 0.1, MotionNoise::default());
        for (forward, turn, sigma) in steps {
            filter.predict(&ahead(forward, turn));
            filter.update_position(filter.pose().position, &(Matrix2::identity() * sigma * sigma));
            let least = filter.covariance().symmetric_eigenvalues().min();
            prop_assert!(least > 0.0, "{least}");
        }
    }
}

#[test]
fn after_an_unmeasured_motion_the_error_is_at_least_as_long_however_long_it_was() {
    for (most_m, at_least_m) in
        [(0.4, 0.4), (40.0, 40.0), (1e3, 1e3), (1440.0, 1e3), (f64::INFINITY, 1e3), (f64::NAN, 1e3)]
    {
        let mut filter = Ekf::new(Pose::new(0.0, 0.0, 0.0), 0.01, 0.01, MotionNoise::default());
        filter.wander(most_m, most_m);
        assert!(filter.error_95_m() >= at_least_m, "{most_m}: {}", filter.error_95_m());
        assert!(filter.covariance().iter().all(|value| value.is_finite()));
    }
}
