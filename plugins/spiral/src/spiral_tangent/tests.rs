#![allow(clippy::unwrap_used, reason = "tests")]

use super::*;
use crate::bench::{CLEARANCE_M, Figures, plan};
use crate::spiral_lattice::SpiralLattice;
use crate::tangent::Around;
use planner_api::{Drive, Motion, Obstacle, Outline, testing::Bench};
use proptest::prelude::*;
use steering::{Keep, Side};
use trials::{Distribution, Layout};
use trials::{Outcome, Robot, exact_pose, fly};
use world::{Boundary, Point, Vector};

#[test]
fn a_free_spiral_is_followed_exactly() {
    let layout = Layout { columns: Vec::new(), ..Distribution::D1.layout(trials::Sampling::Disk, 0, 0.3) };
    let plan = plan::<SpiralTangent>(&layout, &[]).unwrap();
    let score = trials::score(&plan.path, &layout.path);
    assert!(
        plan.complete && score.cross_track_worst_m < 0.02,
        "{} {}",
        plan.complete,
        score.cross_track_worst_m
    );
}

#[test]
fn on_layouts_of_the_paper_it_keeps_clear_and_near() {
    for (distribution, ok, cross_track_m, precision) in bounds() {
        // The figures of a few layouts scatter.
        let figures = Figures::of::<SpiralTangent>(distribution, 100..120, &[]);
        hold(&figures, ok - 0.02, cross_track_m, precision);
    }
}

fn bounds() -> [(Distribution, f64, f64, f64); 3] {
    [
        (Distribution::D1, 0.98, 0.055, 0.97),
        (Distribution::D2, 0.99, 0.055, 0.97),
        (Distribution::D3, 0.99, 0.040, 0.985),
    ]
}

fn hold(figures: &Figures, ok: f64, cross_track_m: f64, precision: f64) {
    let summary = figures.summary();
    assert!(figures.ok_rate() >= ok, "{summary}");
    assert!(figures.least(|s| s.clearance_m) >= CLEARANCE_M - 1e-6, "{summary}");
    assert!(figures.least(|s| s.wall_m) >= -1e-6, "{summary}");
    assert!(figures.mean(|s| s.cross_track_rmse_m) <= cross_track_m, "{summary}");
    assert!(figures.mean(|s| s.cross_track_precision) >= precision, "{summary}");
}

#[test]
fn what_lies_beyond_its_range_changes_nothing() {
    let spiral = Distribution::D1.layout(trials::Sampling::Disk, 0, CLEARANCE_M);
    let near = spiral.path[700];
    let short = |columns: Vec<(Point, f64)>| {
        let path = spiral.path[600..760].to_vec();
        plan::<SpiralTangent>(&Layout { columns, path, ..spiral.clone() }, &[]).unwrap().path
    };
    let alone = short(vec![(near, 0.0)]);
    let outward = near.coords.normalize();
    assert_eq!(alone, short(vec![(near, 0.0), (Point::from(-outward * 5.0), 0.0)]));
    assert_ne!(alone, short(vec![(near, 0.0), (near + outward * 0.35, 0.0), (near - outward * 0.35, 0.0)]));
}

#[test]
fn a_ring_of_columns_is_refused_with_the_station() {
    let ring = (0..60).map(|k| f64::from(k) * std::f64::consts::TAU / 60.0);
    let columns = ring.map(|a| (Point::new(4.0 * a.cos(), 4.0 * a.sin()), 0.0)).collect();
    let layout = Layout { columns, ..Distribution::D1.layout(trials::Sampling::Disk, 0, CLEARANCE_M) };
    let error = plan::<SpiralTangent>(&layout, &[]).unwrap_err();
    assert!(error.code == Code::NoPath && error.message.contains("proved"), "{}", error.message);
    assert!(error.partial.iter().all(|p| p.coords.norm() > 4.0));
}

#[test]
fn out_of_a_pocket_it_comes_by_what_it_has_seen() {
    let spiral = Distribution::D1.layout(trials::Sampling::Disk, 0, CLEARANCE_M);
    let middle = spiral.path[500];
    let along = (spiral.path[501] - middle).normalize();
    let left = Vector::new(-along.y, along.x);
    // A dead end twice as deep as the robot can see.
    let arms =
        (0..13).flat_map(|k| [-0.6, 0.6].map(|side| middle - along * (0.2 * f64::from(k)) + left * side));
    let back = (-2..=2).map(|k| middle + left * (0.3 * f64::from(k)));
    let dead_end = arms.chain(back).map(|at| (at, 0.0)).collect();
    // Columns that, together with the wall, leave no way on from the start except backwards.
    let by_wall = vec![(Point::new(9.143, 0.332), 0.0), (Point::new(9.683, 0.508), 0.0)];
    for columns in [dead_end, by_wall] {
        let layout = Layout { columns, ..spiral.clone() };
        let plan = plan::<SpiralTangent>(&layout, &[]).unwrap();
        let safety = trials::safety(&plan.path, &layout.path, &layout.columns, layout.radius_m);
        let score = trials::score(&plan.path, &layout.path);
        assert!(plan.complete && safety.is_ok(CLEARANCE_M), "{safety:?}");
        assert!(score.covered > 0.95, "{score:?}");
    }
}

#[test]
fn a_range_shorter_than_the_clearance_is_refused() {
    let layout = Layout::random(0);
    let obstacles = layout.obstacles();
    let site = layout.site(&obstacles, Motion::Point);
    let refused = Bench::new().configure::<SpiralTangent>(&[("range_m", 0.5)], &site);
    assert_eq!(refused.err().map(|error| error.code), Some(Code::Config));
}

fn flights(motion: Motion) -> Vec<Outcome> {
    let robot = Robot { motion, sigma_m: 0.03 };
    (0..6).map(|seed| fly::<SpiralTangent>(&[], &Layout::random(seed), robot, seed).unwrap()).collect()
}

#[test]
fn in_random_tanks_it_touches_nothing_and_arrives() {
    for motion in [Motion::Point, Motion::Unicycle] {
        let flights = flights(motion);
        let arrived = flights.iter().filter(|flight| flight.completed).count();
        let least_m = flights.iter().map(|flight| flight.clearance_m).fold(f64::INFINITY, f64::min);
        assert!(least_m > 0.0, "{least_m}");
        assert!(arrived == 6, "{arrived}");
    }
}

#[test]
fn a_plan_is_followed_round_an_obstacle_that_it_does_not_know() {
    let layout = Layout { columns: Vec::new(), ..Layout::random(1) };
    let site = layout.site(&[], Motion::Point);
    let bench = Bench::new();
    let mut planner: SpiralTangent = bench.configure(&[], &site).unwrap();
    let outline = Outline::Disc { center: Point::new(1.0, 0.05), radius_m: 0.2 };
    let discovered =
        [Obstacle { id: 7, outline, discovered: true, velocity_m_per_s: planner_api::Vector2::zeros() }];
    let mut at = Point::new(0.0, 0.0);
    let plan: Vec<Point> = (0..40).map(|k| Point::new(f64::from(k) * 0.1, 0.0)).collect();
    let mut least_m = f64::INFINITY;
    for tick in 0..200_u32 {
        let from = plan.partition_point(|p| p.x < at.x + 0.5).min(plan.len() - 1);
        let sensed = Sensed {
            t_s: f64::from(tick) * 0.1,
            pose: exact_pose(at),
            path_ahead: &plan[from..],
            ..trials::sensed_at_rest(at, &plan[from..], &discovered)
        };
        let command = planner.step(&sensed, &bench.ctx()).unwrap();
        let Drive::Velocity(velocity) = command.drive else { panic!("a velocity") };
        at += velocity * 0.1;
        least_m = least_m.min((at - Point::new(1.0, 0.05)).norm() - 0.2 - layout.hull_m);
    }
    assert!(at.x > 3.0 && at.y.abs() < 0.1, "{at}");
    assert!(least_m >= layout.clearance_m, "{least_m}");
}

/// Flights along plans of the lattice that know two of three columns.
fn flights_along_plans(motion: Motion, seeds: std::ops::Range<u64>) -> Vec<Outcome> {
    let robot = Robot { motion, sigma_m: 0.03 };
    let mut flights = Vec::new();
    for seed in seeds {
        let layout = Layout::random(seed);
        let known = layout.columns.iter().enumerate().filter(|(k, _)| k % 3 != 0).map(|(_, column)| *column);
        let known = Layout { columns: known.collect(), ..layout.clone() };
        let Ok(path) = plan::<SpiralLattice>(&known, &[]).map(|plan| plan.path) else { continue };
        flights.push(fly::<SpiralTangent>(&[], &Layout { path, ..layout }, robot, seed).unwrap());
    }
    flights
}

#[test]
fn plans_that_do_not_know_every_third_column_are_flown_without_touching_any() {
    for motion in [Motion::Point, Motion::Unicycle] {
        let flights = flights_along_plans(motion, 300..305);
        let arrived = flights.iter().filter(|flight| flight.completed).count();
        assert!(flights.iter().all(|flight| flight.clearance_m > 0.0));
        assert!(flights.len() >= 4 && arrived + 1 >= flights.len(), "{arrived} of {}", flights.len());
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn every_plan_keeps_its_distance_and_its_wall(seed in 0..100_000_u64, square in any::<bool>()) {
        let sampling = if square { trials::Sampling::Square } else { trials::Sampling::Disk };
        let layout = Distribution::D1.layout(sampling, seed, CLEARANCE_M);
        if let Ok(plan) = plan::<SpiralTangent>(&layout, &[]) {
            let safety = trials::safety(&plan.path, &layout.path, &layout.columns, layout.radius_m);
            prop_assert!(safety.clearance_m >= CLEARANCE_M - 1e-6 && safety.wall_m >= -1e-6);
        }
    }

    #[test]
    fn a_tangent_never_leads_nearer_than_allowed(
        columns in prop::collection::vec((-1.0..1.0_f64, -1.0..1.0_f64), 1..5),
        wanted_rad in 0.0..6.3_f64,
        passes_left in any::<bool>(),
    ) {
        let keep = Keep { obstacle_m: 0.3, wall_m: 0.0 };
        let parts: Vec<Part> = columns
            .iter()
            .map(|(x, y)| Part::disc(Point::new(*x, *y), 0.0))
            .collect();
        let around = Around { wall: &Boundary::Circle { radius_m: 0.95 }, parts: parts.iter().collect(), keep };
        let at = Point::new(0.0, 0.9);
        let side = if passes_left { Side::Left } else { Side::Right };
        let wanted = Vector::new(wanted_rad.cos(), wanted_rad.sin());
        if around.spare_m(at) >= 0.0 && let Some(heading) = around.tangent(at, wanted, 0.1, side) {
            prop_assert!(around.spare_m(at + heading * 0.1) >= -1e-6);
        }
    }
}

#[test]
fn a_change_of_live_parameters_acts_like_a_new_planner() {
    let changed = trials::changed::<SpiralTangent>(&[], &[("slow_m", 3.0)]);
    assert!(changed.after == changed.fresh && changed.after != changed.before, "{changed:?}");
}
