//! Writes draws and our fixes as CSV for `compare_scipy.py`: truth, one mean range for each station, our fix, our time.

use positioning::{Aggregation, Nls, PositionSolver, RangeNoise};
use rand::{RngExt, SeedableRng};
use std::{io::Write, time::Instant};
use world::{Point, RangeSet, Station, StationId};

const NOISE: RangeNoise = RangeNoise::Uniform { ratio: 0.05 };
const PLACES: [(f64, f64); 3] = [(7.5, 0.0), (-7.5, 0.0), (0.0, 7.5)];
const DRAWS: usize = 5_000;

fn main() -> std::io::Result<()> {
    let station =
        |(id, (x, y))| Station { id: StationId(id), name: String::new(), position: Point::new(x, y) };
    let stations: Vec<Station> = (1..).zip(PLACES).map(station).collect();
    let mut rng = rand_pcg::Pcg64::seed_from_u64(2026);
    let mut out = std::io::stdout().lock();
    writeln!(out, "truth_x,truth_y,range_1,range_2,range_3,fix_x,fix_y,time_us")?;
    for _ in 0..DRAWS {
        let angle = rng.random_range(0.0..std::f64::consts::TAU);
        let radius = 10.0 * rng.random::<f64>().sqrt();
        let truth = Point::new(radius * angle.cos(), radius * angle.sin());
        let mut set = |s: &Station| {
            let distance = (truth - s.position).norm();
            let ranges_m = (0..20).map(|_| distance * (1.0 + 0.05 * rng.random_range(-1.0..=1.0))).collect();
            RangeSet { station: s.id, ranges_m }
        };
        let sets: Vec<RangeSet> = stations.iter().map(&mut set).collect();
        let began = Instant::now();
        let ranges = Aggregation::Mean.aggregate(&sets, &NOISE).expect("usable ranges");
        let fix = Nls.solve(&ranges, &stations, None).expect("a fix");
        let time_us = began.elapsed().as_secs_f64() * 1e6;
        writeln!(
            out,
            "{},{},{},{},{},{},{},{time_us}",
            truth.x,
            truth.y,
            ranges[0].range_m,
            ranges[1].range_m,
            ranges[2].range_m,
            fix.position.x,
            fix.position.y
        )?;
    }
    Ok(())
}
