//! Cost of a tick with 40 m of cable round columns.

use cable::{Chain, Law, Surfaces};
use criterion::{Criterion, criterion_group, criterion_main};
use geometry::{Boundary, Point, Shape, polyline};
use std::hint::black_box;
use world::{Obstacle, ObstacleId};

const TICK_S: f64 = 0.1;

fn bench(criterion: &mut Criterion) {
    let columns: Vec<Obstacle> = (0..16)
        .map(|k| {
            let center = Point::new(f64::from(k % 4) * 8.0 - 12.0, f64::from(k / 4) * 8.0 - 12.0);
            let shape = Shape::Disc { center, radius_m: 0.3 };
            Obstacle { id: ObstacleId(k as u32), name: format!("C{k}"), shape, known: true }
        })
        .collect();
    let law = Law {
        floor_n_per_m: 0.3,
        friction: 0.3,
        pull_n: 40.0,
        pay_out_n: 0.5,
        speed_m_per_s: 1.0,
        length_m: 60.0,
    };
    let surfaces = Surfaces::new(&Boundary::Circle { radius_m: 30.0 }, &columns, Chain::link_m(60.0));
    let line = [Point::new(-20.0, -9.0), Point::new(16.0, -9.0), Point::new(16.0, -4.0)];
    let chain = Chain::along(&line, law).expect("a line of several points");
    let way = polyline::resampled(&[line[2], Point::new(16.0, 6.0), Point::new(6.0, 6.0)], 0.4 * TICK_S);
    criterion.bench_function(
        &format!("{} ticks, {:.0} m of cable", way.len(), chain.paid_out_m()),
        |bencher| {
            bencher.iter(|| {
                let mut chain = chain.clone();
                for at in &way {
                    chain.step(*at, &surfaces, TICK_S);
                }
                black_box(chain.paid_out_m())
            });
        },
    );
}

criterion_group! { name = benches; config = Criterion::default().sample_size(10); targets = bench }
criterion_main!(benches);
