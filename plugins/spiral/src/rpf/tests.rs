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
            let o = fly::<Rpf>(&values, &layout, Robot { motion, sigma_m: std::env::var("SIG").map_or(0.03, |s| s.parse().unwrap()) }, seed).unwrap();
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
        let (mut p, mut rmse, mut trap, mut ok, mut plan_ms, mut close) = (0.0, 0.0, 0, 0, 0.0, 0);
        for seed in 0..n {
            let layout = Layout::of_the_paper(seed, m, square);
            let obstacles = layout.obstacles();
            let site = layout.site(&obstacles, Motion::Point);
            let bench = Bench::new();
            let mut all = values.clone(); all.push(("rho_0_m", rho)); 
            for (k, v) in [("wall_gain", 0.0), ("k_att", 200.0), ("k_rep", 200.0), ("k_rot", 200.0)] { if !values.iter().any(|(q, _)| *q == k) { all.push((k, v)); } }
            let mut planner: Rpf = bench.configure(&all, &site).unwrap();
            let start = PoseEstimate { position: layout.path[0], heading_rad: 0.0, covariance: Default::default() };
            let t1 = std::time::Instant::now();
            let plan = planner.plan(&PlanRequest { reason: &Reason::Start, start, task: Task::Follow { targets: &layout.path, tolerance_m: 0.2 }, site: &site, previous: &[] }, &bench.ctx()).unwrap();
            plan_ms += t1.elapsed().as_secs_f64() * 1e3 / n as f64;
            let s = score(&plan.path, &layout.path);
            p += s.precision / n as f64; rmse += s.rmse_m / n as f64;
            let logs = bench.logs();
            let t = logs.iter().any(|l| l.1.contains("trapped"));
            trap += u32::from(t); close += u32::from(plan.complete);
            let arrived = (plan.path.last().unwrap().coords.norm()) < 0.4;
            ok += u32::from(arrived && !t && s.worst_m <= 1.2567);
        }
        println!("m {m}: P {:.1} rmse {:.2} trap {trap}/{n} ok {ok} complete {close} time/plan {:.1} ms", p * 100.0, rmse, plan_ms);
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

#[test]
#[ignore]
fn measure_robot_plan() {
    let values: Vec<(String, f64)> = std::env::var("V").unwrap_or_default().split(',').filter(|s| !s.is_empty())
        .map(|s| { let (k, v) = s.split_once('=').unwrap(); (k.to_owned(), v.parse().unwrap()) }).collect();
    let values: Vec<(&str, f64)> = values.iter().map(|(k, v)| (k.as_str(), *v)).collect();
    let n = 60;
    let mut why = std::collections::BTreeMap::new();
    for seed in 0..n {
        let layout = Layout::random(seed);
        let obstacles = layout.obstacles();
        let site = layout.site(&obstacles, Motion::Point);
        let bench = Bench::new();
        let mut planner: Rpf = bench.configure(&values, &site).unwrap();
        let start = PoseEstimate { position: layout.path[0], heading_rad: 0.0, covariance: Default::default() };
        let plan = planner.plan(&PlanRequest { reason: &Reason::Start, start, task: Task::Follow { targets: &layout.path, tolerance_m: 0.3 }, site: &site, previous: &[] }, &bench.ctx()).unwrap();
        let log = bench.logs().last().map(|l| l.1.clone()).unwrap_or_default();
        let word = ["trapped", "short of", "lags", "run", "pass"].iter().find(|w| log.contains(**w)).unwrap_or(&"complete");
        assert_eq!(plan.complete, *word == "complete");
        *why.entry(*word).or_insert(0) += 1;
    }
    println!("{why:?}");
}
