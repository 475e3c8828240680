//! Measures the cost of the cable: the update in one tick, and the certificate of a whole plan.

use criterion::{BatchSize, Criterion, criterion_group, criterion_main};
use std::hint::black_box;
use world::{
    Boundary, Obstacle, ObstacleId, Point, Shape,
    tether::{Cable, Case, Limits, Reel, certify},
};

const RADIUS_M: f64 = 50.0;

/// Columns on rings about the centre.
fn columns(count: u32) -> Vec<Obstacle> {
    (0..count)
        .map(|k| {
            // Golden angle: an even scatter over the disc.
            let (angle, far) =
                (2.399_963 * f64::from(k), 0.9 * RADIUS_M * ((f64::from(k) + 1.0) / f64::from(count)).sqrt());
            let center = Point::new(far * angle.cos(), far * angle.sin());
            let shape = Shape::Disc { center, radius_m: 0.3 };
            Obstacle { id: ObstacleId(k), name: format!("C{k}"), shape, known: true }
        })
        .collect()
}

/// Lanes from west to east and back, over the whole floor.
fn lanes(spacing_m: f64, step_m: f64) -> Vec<Point> {
    let mut path = vec![Point::origin()];
    let rows = (2.0 * 0.95 * RADIUS_M / spacing_m) as u32;
    for row in 0..rows {
        let y = 0.95 * RADIUS_M - f64::from(row) * spacing_m;
        let half = ((0.95 * RADIUS_M).powi(2) - y * y).max(0.0).sqrt();
        let steps = (2.0 * half / step_m).ceil().max(1.0) as u32;
        let along = |k: u32| -half + 2.0 * half * f64::from(k) / f64::from(steps);
        let sense = if row % 2 == 0 { 1.0 } else { -1.0 };
        path.extend((0..=steps).map(|k| Point::new(sense * along(k), y)));
    }
    path.push(Point::origin());
    path
}

fn one_tick(c: &mut Criterion) {
    let wall = Boundary::Circle { radius_m: RADIUS_M };
    for count in [0, 16, 120] {
        let shapes: Vec<Shape> = columns(count).into_iter().map(|o| o.shape).collect();
        let mut cable = Cable::new(Point::new(0.0, 0.05), &wall, &shapes).expect("the middle is free");
        let path = lanes(0.6, 0.02);
        let mut at = path.iter().cycle();
        c.bench_function(&format!("one tick of cable, {count} columns"), |b| {
            b.iter(|| {
                cable.drag_to(*at.next().expect("a cycle has no end"));
                black_box((cable.length_m(), cable.wrap_total_rad()))
            });
        });
    }
}

fn certificate(c: &mut Criterion) {
    let boundary = Boundary::Circle { radius_m: RADIUS_M };
    let reel = Reel {
        mass_kg_per_m: 0.1,
        floor_friction: 0.3,
        pull_n: 60.0,
        pay_out_n: 0.5,
        robot_pull_n: None,
        pull_ratio_max: 0.8,
    };
    for (count, pull) in
        [0, 16, 120].into_iter().flat_map(|count| [(count, None), (count, Some(reel.limits(0.3)))])
    {
        let (obstacles, path) = (columns(count), lanes(0.6, 0.4));
        let anchor = Point::new(0.0, 0.05);
        let cuts: Vec<Vec<Point>> = obstacles
            .iter()
            .map(|o| vec![o.shape.center(), Point::from(o.shape.center().coords.normalize() * RADIUS_M)])
            .collect();
        let limits = Limits { reel_length_m: 60.0, wrap_max_rad: 3.0, wrap_total_max_rad: 6.0 };
        let with = if pull.is_some() { ", with pull" } else { "" };
        c.bench_function(&format!("certificate of {} points, {count} columns{with}", path.len()), |b| {
            b.iter_batched(
                || Case {
                    path: &path,
                    anchor,
                    cable: None,
                    boundary: &boundary,
                    obstacles: &obstacles,
                    room_m: 0.3,
                    limits,
                    pull,
                    returns: true,
                    cuts: &cuts,
                },
                |case| black_box(certify(&case)),
                BatchSize::SmallInput,
            );
        });
    }
}

criterion_group!(benches, one_tick, certificate);
criterion_main!(benches);
