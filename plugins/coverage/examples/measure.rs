use planner_api::*;
use planner_api::testing::Bench;
use planner_coverage::{ground::Ground, scan::*, cuts::CutRule, lanes::*, tour::Effort};
use rand::{RngExt, SeedableRng};
use std::time::Instant;
type P = Point2<f64>;
fn discs(seed: u64, n: usize, square: bool) -> Vec<(P, f64)> {
    let mut r = rand_pcg::Pcg64Mcg::seed_from_u64(seed);
    let mut v: Vec<(P, f64)> = vec![];
    while v.len() < n {
        let rad = r.random_range(0.15..0.3);
        let p = P::new(r.random_range(-10.0..10.0), r.random_range(-10.0..10.0));
        let wall = if square { 9.0 - p.x.abs().max(p.y.abs()) } else { 10.0 - p.coords.norm() };
        if wall < rad + 0.9 || p.coords.norm() < 1.0 { continue; }
        if v.iter().any(|(q, s)| (p - q).norm() < rad + s + 0.9) { continue; }
        v.push((p, rad));
    }
    v
}
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let num = |k: usize, d: f64| args.get(k).and_then(|s| s.parse().ok()).unwrap_or(d);
    let which = args.get(1).cloned().unwrap_or("E1".into());
    let seeds = num(2, 3.0) as u64;
    let mode = args.get(3).cloned().unwrap_or("rings".into());
    let lam = num(4, 0.1);
    let kicks = num(5, 3.0);
    let touch = num(6, 0.06);
    let cut_m = num(7, 0.3);
    let alpha = num(8, 50.0);
    let lap = num(9, 0.5);
    let (n, square) = match &which[..] { "E1" => (14, false), "E2" => (28, false), _ => (18, true) };
    let sq = [P::new(-9.0, -9.0), P::new(9.0, -9.0), P::new(9.0, 9.0), P::new(-9.0, 9.0)];
    let mut sums = [0.0; 6];
    for seed in 0..seeds {
        let cols = discs(seed + 100, n, square);
        let obs: Vec<Obstacle> = cols.iter().enumerate().map(|(i, (c, r))| Obstacle { id: i as u32, outline: Outline::Disc { center: *c, radius_m: *r }, discovered: false }).collect();
        let boundary = if square { Boundary::Polygon { vertices: &sq } } else { Boundary::Circle { radius_m: 10.0 } };
        let site = Site { revision: 0, boundary, obstacles: &obs, zones: &[], limits: Limits { motion: Motion::Unicycle, v_max_m_per_s: 0.3, w_max_rad_per_s: 1.0, radius_m: 0.25, sensing_range_m: 2.0 }, swath_m: 0.6, clearance_m: 0.05, seed: 1 };
        let bench = Bench::new();
        let t0 = Instant::now();
        let ground = Ground::new(&site, P::origin()).unwrap();
        let ecc = if square { 12.3 } else { 9.7 };
        let pats: Vec<Pattern> = match &mode[..] {
            "rings" => vec![Pattern::Contours],
            m if m.starts_with("sec") => { let k: usize = m[3..].parse().unwrap(); let t = num(10, 1.0); (0..t as usize).map(|i| Pattern::Sectors { n: k, angle_rad: std::f64::consts::TAU / k as f64 * i as f64 / t, center: P::origin(), spacing_m: 0.598, laps: num(11, 0.0) as usize }).collect() },
            m => { let laps = if m == "lap" { 1 } else { 0 };
                let half = if square { 9.0 - 0.302 } else if laps == 1 { 9.7 - 0.6 + 0.15 } else { 9.7 };
                let count = (2.0f64 * half / 0.6).ceil() ;
                let spacing = if square { 2.0 * half / count } else {0.598};
                let shift = if square { -half } else { 0.0 };
                (0..num(10, 1.0) as usize).map(|k| Pattern::Straight { angle_rad: std::f64::consts::PI * k as f64 / num(10, 1.0), shift_m: shift, spacing_m: spacing, laps }).collect() }
        };
        let mut best: Option<(f64, [f64; 6])> = None;
        for pattern in pats {
        let recipe = Recipe { pattern, rule: CutRule { alpha_rad: alpha.to_radians(), cable_m: ecc * 1.035 }, reach: Reach { cut_m, lap_share: lap, least_m: 0.2, corridor: mode == "rings" && num(11, 1.0) > 0.0, narrow: num(12, 0.0) }, effort: Effort { turn_m_per_rad: lam, kicks_per_lane: kicks, seed: 1 }, touch_m2: touch, rounds: num(13, 1.0) as usize, floor_m_per_m2: num(14, 10.0), enough: num(15, 0.9955) };
        let s = scan(&ground, &recipe, 0.05, &bench.ctx()).unwrap().unwrap();
        let path = s.path();
        let cov = s.grid.coverage();
        let ratio = length_ratio(&path, &s.grid, 0.6);
        let rot = rotation_turns(&path);
        let nl = s.pieces.iter().filter(|p| p.is_lane).count();
        let row = [cov * 100.0, ratio, rot, nl as f64, t0.elapsed().as_secs_f64() * 1e3, if s.slit.is_simple { 0.0 } else { 1.0 }];
        let lanes_m: f64 = s.pieces.iter().filter(|p| p.is_lane).map(|p| world::polyline::length_m(&p.points)).sum(); let ways_m = world::polyline::length_m(&path) - lanes_m; let lb = s.grid.area_m2() / 0.6; if std::env::var("V").is_ok() { println!("  lanes {:.3} ways {:.3} cuts {:.1}", lanes_m / lb, ways_m / lb, s.cuts.iter().map(|c| world::polyline::length_m(&c.line)).sum::<f64>()); picture(&s, &cols, &format!("/tmp/plan-{seed}.ppm")); }
 if best.is_none_or(|b| ratio + 0.002 * rot < b.0) { best = Some((ratio + 0.002 * rot, row)); }
        }
        let row = best.unwrap().1;
        println!("{seed}: cov {:.2} ratio {:.4} rot {:.1} lanes {} ms {:.0} bad {}", row[0], row[1], row[2], row[3], row[4], row[5]);
        for (s, r) in sums.iter_mut().zip(row) { *s += r / seeds as f64; }
    }
    println!("MEAN cov {:.3} ratio {:.4} rot {:.1} lanes {:.0} ms {:.0}", sums[0], sums[1], sums[2], sums[3], sums[4]);
}
pub fn picture(s: &Scan, cols: &[(P, f64)], name: &str) {
    let px = 50.0; let lo = s.grid.low; let w = ((s.grid.columns as f64) * s.grid.cell_m * px) as usize; let h = ((s.grid.rows as f64) * s.grid.cell_m * px) as usize;
    let mut img = vec![[255u8, 255, 255]; w * h];
    for y in 0..h { for x in 0..w {
        let c = ((y as f64 / px / s.grid.cell_m) as usize).min(s.grid.rows - 1) * s.grid.columns + ((x as f64 / px / s.grid.cell_m) as usize).min(s.grid.columns - 1);
        img[(h - 1 - y) * w + x] = if !s.grid.reachable[c] { [200, 200, 200] } else if s.grid.swept[c] == 0 { [255, 0, 0] } else { let v = 255 - (s.grid.swept[c].min(6) as u8) * 8; [v, v, 255] };
    } }
    let mut line = |a: P, b: P, col: [u8; 3]| { let n = ((b - a).norm() * px * 1.5) as usize + 1; for k in 0..=n { let p = a + (b - a) * (k as f64 / n as f64); let (x, y) = (((p.x - lo.x) * px) as usize, ((p.y - lo.y) * px) as usize); if x < w && y < h { img[(h - 1 - y) * w + x] = col; } } };
    for p in &s.pieces { for q in p.points.windows(2) { line(q[0], q[1], if p.is_lane { [0, 0, 0] } else { [0, 150, 0] }); } }
    for c in &s.cuts { for q in c.line.windows(2) { line(q[0], q[1], [255, 0, 255]); } }
    for (c, r) in cols { for k in 0..40 { let a = k as f64 * 0.157; let b = a + 0.157; line(c + nalgebra_v(a) * *r, c + nalgebra_v(b) * *r, [120, 60, 0]); } }
    let mut out = format!("P6\n{w} {h}\n255\n").into_bytes(); out.extend(img.iter().flatten());
    std::fs::write(name, out).unwrap();
}
fn nalgebra_v(a: f64) -> Vector2<f64> { Vector2::new(a.cos(), a.sin()) }
