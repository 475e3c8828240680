//! How long it takes to count the shares of a re-scan in a tank of radius 40 m, with cells of 5 cm.
#![allow(missing_docs, reason = "criterion writes a function without docs")]

#[path = "../tests/console/fixture.rs"]
#[allow(dead_code, reason = "the tests use all of it")]
mod fixture;

use criterion::{Criterion, criterion_group, criterion_main};
use fixture::config;
use mission::MissionConfig;
use tui::model::{Combination, Earlier, Raster};
use world::{Boundary, CellRun, Floor, Point, World};

fn combination(cells: usize) -> Combination {
    let shares = serde_json::json!({
        "area_m2": 5026.5, "scanned": 1.0, "missed": 0.0, "unreachable": 0.0, "margin": 0.0
    });
    let floor = serde_json::json!({
        "cell_m": 0.05, "swath_m": 0.6, "position_limit_m": 0.15, "whole": shares, "reachable": shares,
        "critical_zone": { "width_m": 0.075, "length_m": 251.0, "done_m": 0.0, "scanned": 0.0, "done": false, "why": null },
        "plates": [], "missed": [], "slivers": { "count": 0, "area_m2": 0.0 }, "unreachable": [],
    });
    Combination {
        earlier: vec!["before".into()],
        floor: serde_json::from_value(floor).expect("an account"),
        kinds: Vec::new(),
        taken_back: None,
        scanned: vec![CellRun(0, (cells / 2) as u32)],
        not_requested: Vec::new(),
    }
}

fn shares(criterion: &mut Criterion) {
    let boundary = Boundary::Circle { radius_m: 40.0 };
    let tank = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
    let floor = Floor::new(&tank, 0.05, 0.3, 0.6, Point::origin());
    let cells = floor.len();
    let mut own = Raster::new(floor);
    let mission = MissionConfig { swath_m: 0.6, ..config() };
    let earlier = Earlier::new(&combination(cells), &own, &mission);
    let reachable = (0..cells).filter(|cell| own.floor().kind(*cell) == world::Cell::Reachable);
    let reachable: Vec<usize> = reachable.collect();
    let mut next = reachable.iter().cycle();
    criterion.bench_function("shares_of_a_rescan", |bencher| {
        bencher.iter(|| {
            own.apply(&[CellRun(*next.next().unwrap_or(&0) as u32, 1)]);
            earlier.shares(&own)
        });
    });
}

criterion_group!(benches, shares);
criterion_main!(benches);
