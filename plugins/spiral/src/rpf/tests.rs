use super::*;
use field::trial::{Layout, Robot, fly, score};
use planner_api::{Motion, testing::Bench, Task, Reason, PoseEstimate};

#[test]
#[ignore]
fn measure() {
    let values: Vec<(String, f64)> = std::env::var("V").unwrap_or_default().split(',').filter(|s| !s.is_empty())
        .map(|s| { let (k, v) = s.split_once('=').unwrap(); (k.to_owned(), v.parse().unwrap()) }).collect();
    let values: Vec<(&str, f64)> = values.iter().map(|(k, v)| (k.as_str(), *v)).collect();
    let n: u64 = std::env::var("N").unwrap_or("50".into()).parse().unwrap();
    let first: u64 = std::env::var("S").unwrap_or("0".into()).parse().unwrap();
    for motion in [Motion::Point, Motion::Unicycle] {
        let (mut done, mut coll, mut stuck, mut minc, mut ct, mut passed, mut time) = (0, 0, 0, f64::INFINITY, 0.0, 0.0, 0.0);
        for seed in first..first + n {
            let layout = Layout::random(seed);
            let o = fly::<Rpf>(&values, &layout, Robot { motion, sigma_m: 0.03 }, seed).unwrap();
            done += u32::from(o.completed); coll += u32::from(o.clearance_m < 0.0); stuck += u32::from(o.said_stuck);
            minc = minc.min(o.clearance_m);
            ct += o.cross_track_m / n as f64; passed += o.passed / n as f64;
            time += o.time_s / (world::polyline::length_m(&layout.path) / 0.35) / n as f64;
            if !o.completed && std::env::var("L").is_ok() { println!("  seed {seed} R {:.1} n {} end {:?} due {:?} passed {:.2} t {:.0}", layout.radius_m, layout.columns.len(), o.end, o.due, o.passed, o.time_s); }
        }
        println!("{motion:?}: done {done}/{n} coll {coll} stuck {stuck} min {minc:.3} ct {ct:.3} passed {passed:.3} time ratio {time:.2}");
    }
}

#[test]
#[ignore]
fn measure_plan() {
    let values: Vec<(String, f64)> = std::env::var("V").unwrap_or_default().split(',').filter(|s| !s.is_empty())
        .map(|s| { let (k, v) = s.split_once('=').unwrap(); (k.to_owned(), v.parse().unwrap()) }).collect();
    let values: Vec<(&str, f64)> = values.iter().map(|(k, v)| (k.as_str(), *v)).collect();
    let n: u64 = std::env::var("N").unwrap_or("100".into()).parse().unwrap();
    let square = std::env::var("SQ").is_ok();
    for (m, rho) in [(39, 1.5), (36, 1.0), (20, 0.8)] {
        let (mut p, mut rmse, mut trap, mut ok) = (0.0, 0.0, 0, 0);
        let t0 = std::time::Instant::now();
        for seed in 0..n {
            let layout = Layout::of_the_paper(seed, m, square);
            let obstacles = layout.obstacles();
            let site = layout.site(&obstacles, Motion::Point);
            let bench = Bench::new();
            let mut all = values.clone(); all.push(("rho_0_m", rho)); 
            for (k, v) in [("wall_gain", 0.0), ("k_att", 200.0), ("k_rep", 200.0), ("k_rot", 200.0)] { if !values.iter().any(|(q, _)| *q == k) { all.push((k, v)); } }
            let mut planner: Rpf = bench.configure(&all, &site).unwrap();
            let start = PoseEstimate { position: layout.path[0], heading_rad: 0.0, covariance: Default::default() };
            let plan = planner.plan(&PlanRequest { reason: &Reason::Start, start, task: Task::Follow { targets: &layout.path, tolerance_m: 0.2 }, site: &site, previous: &[] }, &bench.ctx()).unwrap();
            let s = score(&plan.path, &layout.path);
            p += s.precision / n as f64; rmse += s.rmse_m / n as f64;
            let logs = bench.logs();
            let t = logs.iter().any(|l| l.1.contains("trapped"));
            trap += u32::from(t);
            let arrived = (plan.path.last().unwrap().coords.norm()) < 0.4;
            ok += u32::from(arrived && !t && s.worst_m <= 1.2567);
        }
        println!("m {m}: P {:.1} rmse {:.2} trap {trap}/{n} ok {ok} time/plan {:.1} ms", p * 100.0, rmse, t0.elapsed().as_secs_f64() * 1e3 / n as f64);
    }
}

#[test]
#[ignore]
fn dump() {
    let seed: u64 = std::env::var("S").unwrap().parse().unwrap();
    let l = Layout::random(seed);
    println!("{} {} {}", l.radius_m, l.hull_m, l.clearance_m);
    for (c, r) in &l.columns { println!("c {} {} {}", c.x, c.y, r); }
    for p in &l.path { println!("p {} {}", p.x, p.y); }
}
