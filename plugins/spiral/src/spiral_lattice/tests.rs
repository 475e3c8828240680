#![allow(clippy::unwrap_used, reason = "tests")]

use super::*;
use crate::bench::{CLEARANCE_M, Figures, plan};
use planner_api::{Code, Motion, PlannerError, Reason, Task, testing::Bench};
use proptest::prelude::*;
use trials::{Distribution, Layout, Robot, Sampling, exact_pose, fly, score};
use world::{Point, Vector, spiral::Spiral};

fn tank(points: &[Point]) -> Layout {
    let columns = points.iter().map(|p| (*p, 0.0)).collect();
    Layout { columns, clearance_m: CLEARANCE_M, ..Layout::of_the_paper(0, 0, false) }
}

fn refusal(layout: &Layout, values: &[(&str, f64)]) -> PlannerError {
    plan::<SpiralLattice>(layout, values).unwrap_err()
}

/// Largest change of heading at any point of a path, radians.
fn sharpest_rad(path: &[Point]) -> f64 {
    let moves: Vec<Vector> = path.windows(2).map(|w| w[1] - w[0]).filter(|m| m.norm() > 1e-9).collect();
    moves.windows(2).map(|w| w[0].perp(&w[1]).atan2(w[0].dot(&w[1])).abs()).fold(0.0, f64::max)
}

#[test]
fn a_free_spiral_is_its_own_plan() {
    let layout = tank(&[]);
    let plan = plan::<SpiralLattice>(&layout, &[]).unwrap();
    assert!(plan.complete && plan.path == layout.path);
}

#[test]
fn a_point_on_the_way_is_passed_at_the_clearance_and_without_a_kink() {
    let layout = tank(&[Spiral::WANG_2023.points()[700]]);
    let plan = plan::<SpiralLattice>(&layout, &[]).unwrap();
    let clearance_m = polyline::distance_m(&plan.path, layout.columns[0].0);
    assert!((CLEARANCE_M..CLEARANCE_M + 0.03).contains(&clearance_m), "{clearance_m}");
    assert!(sharpest_rad(&plan.path[..2000]) <= 30.1_f64.to_radians());
    assert!(score(&plan.path, &layout.path).worst_m < 0.4);
}

#[test]
fn without_a_turn_limit_it_stays_nearer() {
    let free = Figures::of::<SpiralLattice>(Distribution::D1, 0..4, &[("turn_deg", 0.0)]);
    let limited = Figures::of::<SpiralLattice>(Distribution::D1, 0..4, &[]);
    assert!(free.mean(|s| s.rmse_m) < limited.mean(|s| s.rmse_m));
}

#[test]
fn on_layouts_of_the_paper_it_keeps_clear_and_near() {
    for (distribution, rmse_m, precision) in bounds() {
        let figures = Figures::of::<SpiralLattice>(distribution, 100..120, &[]);
        // The figures of a few layouts scatter.
        hold(&figures, rmse_m * 1.1, precision - 0.005);
    }
}

fn bounds() -> [(Distribution, f64, f64); 3] {
    [(Distribution::D1, 0.040, 0.985), (Distribution::D2, 0.040, 0.985), (Distribution::D3, 0.028, 0.993)]
}

fn hold(figures: &Figures, rmse_m: f64, precision: f64) {
    let summary = figures.summary();
    assert!(figures.ok_rate() >= 0.995, "{summary}");
    assert!(figures.least(|s| s.clearance_m) >= CLEARANCE_M - 1e-6, "{summary}");
    assert!(figures.least(|s| s.wall_m) >= -1e-6, "{summary}");
    assert!(figures.mean(|s| s.rmse_m) <= rmse_m, "{summary}");
    assert!(figures.mean(|s| s.precision) >= precision, "{summary}");
    assert!(figures.refusals.iter().all(|(_, reason)| reason.contains("proved")), "{summary}");
    // In a few layouts, the only path turns faster, and the planner says so.
    let slow = figures.safeties.iter().filter(|s| s.heading_step_rad <= 30.1_f64.to_radians());
    assert!(slow.count() * 10 >= figures.safeties.len() * 9, "{summary}");
}

#[test]
fn a_ring_of_columns_is_refused_with_the_station_and_the_proof() {
    let ring: Vec<Point> = (0..60)
        .map(|k| f64::from(k) * std::f64::consts::TAU / 60.0)
        .map(|angle| Point::new(4.0 * angle.cos(), 4.0 * angle.sin()))
        .collect();
    let error = refusal(&tank(&ring), &[]);
    assert_eq!(error.code, Code::NoPath);
    assert!(
        error.message.contains("blocked at point") && error.message.contains("proved"),
        "{}",
        error.message
    );
    let end = error.partial.last().unwrap();
    assert!(end.coords.norm() > 4.2 && error.partial.len() > 1000, "{end} {}", error.partial.len());
}

#[test]
fn input_that_makes_no_sense_is_refused_with_a_reason() {
    let start = tank(&[]).path[0];
    let blocked = Layout { columns: vec![(start - Vector::new(0.2, 0.0), 0.3)], ..tank(&[]) };
    assert_eq!(refusal(&blocked, &[]).code, Code::StartOccupied);
    assert_eq!(refusal(&tank(&[]), &[("clearance_m", 1.3)]).code, Code::Config);
    assert_eq!(refusal(&tank(&[]), &[("clearance_m", f64::NAN)]).code, Code::Config);
    let circle = (0..2000).map(|k| 0.02 * f64::from(k)).map(|a| Point::new(5.0 * a.cos(), 5.0 * a.sin()));
    assert_eq!(refusal(&Layout { path: circle.collect(), ..tank(&[]) }, &[]).code, Code::Invalid);
    let path = vec![Point::new(9.0, 0.0), Point::new(f64::NAN, 0.0)];
    assert_eq!(refusal(&Layout { path, ..tank(&[]) }, &[]).code, Code::Invalid);
}

#[test]
fn a_start_in_the_clearance_zone_begins_beside_it() {
    let start = tank(&[]).path[0];
    let layout = tank(&[start - Vector::new(0.1, 0.1)]);
    let plan = plan::<SpiralLattice>(&layout, &[]).unwrap();
    assert!(plan.complete && (plan.path[0] - start).norm() < 0.5);
    assert!(polyline::distance_m(&plan.path, layout.columns[0].0) >= CLEARANCE_M - 1e-6);
}

#[test]
fn a_robot_off_its_path_is_led_back_to_it() {
    let layout = tank(&[]);
    let bench = Bench::new();
    let site = layout.site(&[], Motion::Point);
    let mut planner: SpiralLattice = bench.configure(&[], &site).unwrap();
    let task = Task::Follow { targets: &layout.path[1000..], tolerance_m: 0.2 };
    let start = exact_pose(layout.path[990] + Vector::new(0.3, 0.3));
    let request = PlanRequest::new(&Reason::Start, start, task, &site);
    let plan = planner.plan(&request, &bench.ctx()).unwrap();
    assert_eq!(plan.path[0], start.position);
    assert!(plan.complete && polyline::distance_m(&plan.path, layout.path[1100]) < 1e-9);
}

#[test]
fn a_plan_for_a_robot_with_a_hull_keeps_the_mission_clearance() {
    let complete = (0..10).filter(|seed| {
        let layout = Layout::random(*seed);
        let Ok(plan) = plan::<SpiralLattice>(&layout, &[]) else { return false };
        let clear_m = plan.path.iter().map(|p| layout.hull_clearance_m(*p)).fold(f64::INFINITY, f64::min);
        assert!(clear_m >= layout.clearance_m - 1e-6, "{seed} {clear_m}");
        plan.complete
    });
    assert!(complete.count() >= 8);
}

#[test]
fn without_a_plan_it_arrives_by_what_it_senses() {
    let robot = Robot { motion: Motion::Unicycle, sigma_m: 0.03 };
    let flights = (0..6).map(|seed| fly::<SpiralLattice>(&[], &Layout::random(seed), robot, seed).unwrap());
    let arrived =
        flights.inspect(|flight| assert!(flight.clearance_m > 0.0)).filter(|flight| flight.completed);
    assert!(arrived.count() == 6);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]
    #[test]
    fn every_plan_keeps_its_distance_and_its_wall(seed in 0..100_000_u64, square in any::<bool>()) {
        let sampling = if square { Sampling::Square } else { Sampling::Disk };
        let layout = Distribution::D1.layout(sampling, seed, CLEARANCE_M);
        if let Ok(plan) = plan::<SpiralLattice>(&layout, &[]) {
            let safety = trials::safety(&plan.path, &layout.path, &layout.columns, layout.radius_m);
            prop_assert!(safety.clearance_m >= CLEARANCE_M - 1e-6 && safety.wall_m >= -1e-6);
            prop_assert_eq!(plan.path.len(), layout.path.len());
        }
    }
}
