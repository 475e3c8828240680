//! Measures the cost of one evaluation of the forces for different numbers of obstacles: only obstacles within reach
//! may add to the cost.

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use field::{Law, PushForm, Repulsion, RotationForm, Scene, law::Beside};
use planner_api::{Boundary, Limits, Motion, Obstacle, Outline, Point2, Site};
use std::hint::black_box;
use steering::Side;

/// The density of obstacles stays the same, so the number within reach does not depend on the total number.
const AREA_PER_OBSTACLE_M2: f64 = 4.0;

fn columns(n_obstacles: u32) -> (f64, Vec<Obstacle<'static>>) {
    let radius_m = (f64::from(n_obstacles) * AREA_PER_OBSTACLE_M2 / std::f64::consts::PI).sqrt();
    let golden_rad = 2.399_963;
    let columns = (0..n_obstacles).map(|id| {
        let (from_center_m, angle_rad) =
            (radius_m * (f64::from(id) / f64::from(n_obstacles)).sqrt(), f64::from(id) * golden_rad);
        let center = Point2::new(from_center_m * angle_rad.cos(), from_center_m * angle_rad.sin());
        Obstacle {
            id,
            outline: Outline::Disc { center, radius_m: 0.2 },
            discovered: false,
            velocity_m_per_s: planner_api::Vector2::zeros(),
        }
    });
    (radius_m, columns.collect())
}

fn forces(criterion: &mut Criterion) {
    let law = Law {
        k_att: 1.0,
        k_rep: 0.02,
        k_rot: 1.0,
        rho_0_m: 1.5,
        wall_gain: 0.1,
        repulsion: Repulsion::Improved { exponent: 2.0 },
        form: PushForm::Khatib,
        nearest_only: false,
        rotation: RotationForm::Smooth,
        beside: Beside::All,
    };
    let mut group = criterion.benchmark_group("forces");
    for n_obstacles in [20, 200, 2_000, 20_000] {
        let (radius_m, obstacles) = columns(n_obstacles);
        let site = Site {
            revision: 0,
            boundary: Boundary::Circle { radius_m },
            obstacles: &obstacles,
            zones: &[],
            limits: Limits {
                motion: Motion::Point,
                v_max_m_per_s: 0.4,
                w_max_rad_per_s: 1.0,
                radius_m: 0.25,
                sensing_range_m: 3.0,
                acceleration_m_per_s2: 0.5,
                tick_s: 0.1,
                amphibious: None,
            },
            swath_m: 0.5,
            clearance_m: 0.1,
            seed: 0,
        };
        let scene = Scene::new(&site);
        let (at, goal) = (Point2::new(0.31 * radius_m, 0.17 * radius_m), Point2::origin());
        group.bench_function(BenchmarkId::from_parameter(n_obstacles), |bencher| {
            bencher.iter(|| {
                let contacts = scene.contacts(black_box(at), &law);
                law.forces(at, goal, &contacts, |_| Some(Side::Left)).resultant()
            });
        });
    }
    group.finish();
}

criterion_group!(benches, forces);
criterion_main!(benches);
