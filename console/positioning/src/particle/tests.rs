#![allow(clippy::unwrap_used, reason = "tests")]

use super::*;
use crate::{
    Aggregation, Ekf,
    draws::{Draws, paper_stations},
};

fn config(seed: u64) -> ParticlesConfig {
    ParticlesConfig { count: 1_000, ratio: 0.05, odometry: MotionNoise::default(), slip_chance: 0.02, seed }
}

/// Mean errors of particles and of the Kalman filter on a circle; at step 50 the robot is carried by `carried_m`.
fn errors(seed: u64, carried_m: f64) -> (f64, f64) {
    let (stations, mut draws) = (paper_stations(), Draws::new(0.05, 20, seed));
    let mut truth = Pose::new(6.0, 0.0, std::f64::consts::FRAC_PI_2);
    let mut particles = Particles::new(truth, 0.05, 0.05, config(seed));
    let mut ekf = Ekf::new(truth, 0.05, 0.05, MotionNoise::default());
    let (mut by_particles, mut by_filter) = (0.0, 0.0);
    for k in 0..100 {
        truth = truth.moved(0.3, 0.0, 0.05);
        if k == 50 {
            truth.position.x -= carried_m;
        }
        let odometry = Odometry {
            forward_m: 0.3 / 0.97 * (1.0 + 0.02 * draws.bell()),
            sideways_m: 0.0,
            turn_rad: 0.05 + 0.002 * draws.bell(),
        };
        particles.predict(&odometry);
        ekf.predict(&odometry);
        let ranges = draws.rangings(&stations, truth.position, Aggregation::Mean);
        particles.update(&ranges, &stations).unwrap();
        by_particles += (particles.estimate().0.position - truth.position).norm() / 100.0;
        particles.renew(&ranges, &stations);
        ekf.update_ranges(&ranges, &stations);
        by_filter += (ekf.pose().position - truth.position).norm() / 100.0;
    }
    (by_particles, by_filter)
}

#[test]
fn bounds_with_a_memory_beat_the_kalman_filter() {
    let all: Vec<(f64, f64)> = (0..6).map(|seed| errors(seed, 0.0)).collect();
    let particles: f64 = all.iter().map(|(p, _)| p / 6.0).sum();
    let filter: f64 = all.iter().map(|(_, f)| f / 6.0).sum();
    assert!(particles < 0.7 * filter && particles < 0.02, "{particles} {filter}");
}

#[test]
fn a_robot_that_was_carried_away_is_found_again() {
    let (carried, _) = errors(3, 2.0);
    assert!(carried < 0.05, "{carried}");
}

#[test]
fn equal_seeds_give_equal_estimates() {
    assert_eq!(errors(4, 0.0), errors(4, 0.0));
}

#[test]
fn ranges_that_no_place_explains_change_nothing() {
    let stations = paper_stations();
    let mut particles = Particles::new(Pose::new(1.0, 1.0, 0.0), 0.05, 0.05, config(1));
    let before = particles.estimate();
    let nonsense: Vec<Ranging> = stations.iter().map(|s| Ranging::single(s.id, 0.01, 0.001)).collect();
    assert!(particles.update(&nonsense, &stations).is_err());
    assert_eq!(particles.estimate(), before);
    particles.predict(&Odometry { forward_m: f64::NAN, sideways_m: 0.0, turn_rad: f64::INFINITY });
    assert_eq!(particles.estimate(), before);
}
