use planner_api::{testing::Bench, *};
use planner_coverage::tether_safe::TetherSafe;
use trials::tanks::*;
use std::time::Instant;
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let which = args[1].clone(); let n: u64 = args[2].parse().unwrap(); let first: u64 = args[3].parse().unwrap();
    let values: Vec<(&str, f64)> = args[4..].iter().map(|a| { let (k, v) = a.split_once('=').unwrap(); (k, v.parse().unwrap()) }).collect();
    let mut sum = [0.0; 9]; let mut worst = [1e9, 0.0, 0.0, 0.0, 0.0, 0.0f64]; let mut bad = 0;
    for seed in first..first + n {
        let tank = match &which[..] { "E1" => Known::E1.tank(seed), "E2" => Known::E2.tank(seed), "E3" => Known::E3.tank(seed), _ => Tank::random(seed) };
        let bench = Bench::new(); let obstacles = tank.obstacles(); let site = tank.site(&obstacles);
        let t = Instant::now();
        let mut p: TetherSafe = bench.configure(&values, &site).unwrap();
        let start = PoseEstimate { position: tank.anchor, heading_rad: 0.0, covariance: Default::default() };
        let req = PlanRequest { reason: &Reason::Start, start, task: Task::Cover { anchor: tank.anchor, regions: &[], tether: None, tolerance_m: 0.3 }, site: &site, previous: &[] };
        let plan = match p.plan(&req, &bench.ctx()) { Ok(p) => p, Err(e) => { println!("{seed}: ERR {e}"); bad += 1; continue } };
        let ms = t.elapsed().as_secs_f64() * 1e3;
        let s = tank.score(&plan.path, &plan.cuts, CELL_M).unwrap();
        let c = &s.certificate;
        let row = [100.0 * s.coverage_reachable, s.length_over_lower_bound, s.rotation_turns, c.max_cable_m / c.eccentricity_m, c.max_wrap_rad.to_degrees(), c.max_sum_wrap_rad.to_degrees(), c.left_out_m.unwrap_or(99.0), ms, tank.columns.len() as f64];
        for (a, b) in sum.iter_mut().zip(row) { *a += b / n as f64; }
        worst[0] = f64::min(worst[0], row[0]); for k in 1..6 { worst[k] = worst[k].max(row[k]); }
        if !c.certified { bad += 1; println!("{seed}: {:?}", c.reasons); }
        if std::env::var("V").is_ok() { println!("{seed}: {:.2} {:.4} {:.1} cable {:.3} wrap {:.0}/{:.0} out {:.2} ms {:.0} n {}", row[0], row[1], row[2], row[3], row[4], row[5], row[6], row[7], row[8]); for l in bench.logs() { println!("      {}", l.1); } }
    }
    println!("{which} MEAN cov {:.2} len {:.4} rot {:.1} cable {:.3} wrap {:.0}/{:.0} ms {:.0} | WORST cov {:.2} len {:.3} rot {:.0} cable {:.3} wrap {:.0}/{:.0} bad {bad}", sum[0], sum[1], sum[2], sum[3], sum[4], sum[5], sum[7], worst[0], worst[1], worst[2], worst[3], worst[4], worst[5]);
}
