//! Helpers shared by the tests of our own planners: they make plans for the paper's layouts, and compute the figures of
//! these plans over many seeds.

use planner_api::{Motion, Plan, PlanRequest, Planner, Reason, Result, Task, testing::Bench};
use std::time::Duration;
use trials::{Distribution, Layout, Safety, Sampling, Score, exact_pose, floor_rmse_m, safety, score};

/// The clearance that our tests use in the paper's layouts, metres.
pub(crate) const CLEARANCE_M: f64 = 0.3;

/// Plans a path through a layout.
pub(crate) fn plan<P: Planner>(layout: &Layout, values: &[(&str, f64)]) -> Result<Plan> {
    let bench = Bench::new();
    let obstacles = layout.obstacles();
    let site = layout.site(&obstacles, Motion::Point);
    let mut planner: P = bench.configure(values, &site)?;
    let task = Task::Follow { targets: &layout.path, tolerance_m: 0.2 };
    let start = exact_pose(layout.path[0]);
    let request = PlanRequest::new(&Reason::Start, start, task, &site);
    planner.plan(&request, &bench.ctx())
}

/// Returns the CPU time of this thread, so that figures are valid even on a busy machine; zero where the system does
/// not report it.
fn on_cpu() -> Duration {
    let stat = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    let nanoseconds = stat.split_whitespace().next().and_then(|word| word.parse().ok());
    Duration::from_nanos(nanoseconds.unwrap_or_default())
}

/// The figures of many plans.
#[derive(Debug, Default)]
pub(crate) struct Figures {
    pub n_layouts: usize,
    pub scores: Vec<Score>,
    pub safeties: Vec<Safety>,
    pub floors_m: Vec<f64>,
    pub refusals: Vec<(u64, String)>,
    pub times: Vec<Duration>,
}

impl Figures {
    pub(crate) fn of<P: Planner>(
        distribution: Distribution,
        seeds: std::ops::Range<u64>,
        values: &[(&str, f64)],
    ) -> Self {
        let mut figures = Self::default();
        for seed in seeds {
            let layout = distribution.layout(Sampling::Disk, seed, CLEARANCE_M);
            let began = on_cpu();
            let plan = plan::<P>(&layout, values);
            figures.times.push(on_cpu().saturating_sub(began));
            figures.n_layouts += 1;
            match plan {
                Ok(plan) => {
                    figures.scores.push(score(&plan.path, &layout.path));
                    figures.safeties.push(safety(&plan.path, &layout.path, &layout.columns, layout.radius_m));
                    figures.floors_m.push(floor_rmse_m(&layout.path, &layout.columns, CLEARANCE_M));
                    if !figures.safeties[figures.safeties.len() - 1].is_ok(CLEARANCE_M) {
                        let safety = figures.safeties[figures.safeties.len() - 1];
                        figures.refusals.push((seed, format!("not ok: {safety:?}")));
                    }
                }
                Err(error) => figures.refusals.push((seed, error.message)),
            }
        }
        figures
    }

    pub(crate) fn ok_rate(&self) -> f64 {
        self.safeties.iter().filter(|s| s.is_ok(CLEARANCE_M)).count() as f64 / self.n_layouts as f64
    }

    pub(crate) fn mean(&self, figure: fn(&Score) -> f64) -> f64 {
        self.scores.iter().map(figure).sum::<f64>() / self.scores.len() as f64
    }

    pub(crate) fn floor_m(&self) -> f64 {
        self.floors_m.iter().sum::<f64>() / self.floors_m.len() as f64
    }

    pub(crate) fn least(&self, figure: fn(&Safety) -> f64) -> f64 {
        self.safeties.iter().map(figure).fold(f64::INFINITY, f64::min)
    }

    pub(crate) fn most(&self, figure: fn(&Safety) -> f64) -> f64 {
        self.safeties.iter().map(figure).fold(f64::NEG_INFINITY, f64::max)
    }

    pub(crate) fn time_ms(&self, share: f64) -> f64 {
        let mut times = self.times.clone();
        times.sort();
        times[((times.len() - 1) as f64 * share) as usize].as_secs_f64() * 1e3
    }

    pub(crate) fn summary(&self) -> String {
        format!(
            "n {} ok {:.4} rmse {:.4} floor {:.4} ratio {:.3} P {:.4} R {:.4} cov {:.4} ct {:.4} Pct {:.4} worst {:.2} \
             clearance {:.4} wall {:.4} turn {:.1} (mean of most {:.1}) ms p50 {:.1} p99 {:.1} max {:.1}\n  refusals {} {:?}",
            self.n_layouts,
            self.ok_rate(),
            self.mean(|s| s.rmse_m),
            self.floor_m(),
            self.mean(|s| s.rmse_m) / self.floor_m(),
            self.mean(|s| s.precision),
            self.mean(|s| s.recall),
            self.mean(|s| s.covered),
            self.mean(|s| s.cross_track_rmse_m),
            self.mean(|s| s.cross_track_precision),
            self.scores.iter().map(|s| s.worst_m).fold(0.0, f64::max),
            self.least(|s| s.clearance_m),
            self.least(|s| s.wall_m),
            self.most(|s| s.heading_step_rad).to_degrees(),
            self.safeties.iter().map(|s| s.heading_step_rad).sum::<f64>().to_degrees()
                / self.safeties.len() as f64,
            self.time_ms(0.5),
            self.time_ms(0.99),
            self.time_ms(1.0),
            self.refusals.len(),
            &self.refusals[..self.refusals.len().min(6)],
        )
    }
}

/// Tests that every planner on a preset path refuses invalid input, with a reason.
mod bad_input {
    use super::*;
    use crate::{
        escapes::{Iapf, Vt},
        rpf::Rpf,
        spiral_lattice::SpiralLattice,
        spiral_tangent::SpiralTangent,
    };
    use planner_api::Code;
    use world::{Point, Vector};

    fn empty() -> Layout {
        Layout { columns: Vec::new(), clearance_m: CLEARANCE_M, ..Layout::of_the_paper(0, 0, false) }
    }

    fn code<P: Planner>(layout: &Layout, values: &[(&str, f64)]) -> Option<Code> {
        let refused = plan::<P>(layout, values).err();
        refused.inspect(|error| assert!(error.message.len() > 10)).map(|error| error.code)
    }

    fn refuses_all_of_it<P: Planner>() {
        let start = empty().path[0];
        let on_start = Layout { columns: vec![(start - Vector::new(0.2, 0.0), 0.3)], ..empty() };
        assert_eq!(code::<P>(&on_start, &[]), Some(Code::StartOccupied), "{}", P::ID);
        let angles = (0..2000).map(|k| 0.02 * f64::from(k));
        let no_pitch = angles.map(|a| Point::new(5.0 * a.cos(), 5.0 * a.sin())).collect();
        let no_number = vec![Point::new(9.0, 0.0), Point::new(f64::NAN, 0.0)];
        for path in [no_pitch, no_number, vec![start; 40]] {
            assert_eq!(code::<P>(&Layout { path, ..empty() }, &[]), Some(Code::Invalid), "{}", P::ID);
        }
        assert_eq!(code::<P>(&Layout { clearance_m: 1.4, ..empty() }, &[]), Some(Code::Config), "{}", P::ID);
        for spec in P::PARAMS {
            for value in [f64::NAN, f64::INFINITY, -1.0] {
                let refused = code::<P>(&empty(), &[(spec.key, value)]);
                assert_eq!(refused, Some(Code::Config), "{} {} {value}", P::ID, spec.key);
            }
        }
    }

    #[test]
    fn is_refused_by_every_planner() {
        refuses_all_of_it::<SpiralLattice>();
        refuses_all_of_it::<SpiralTangent>();
        refuses_all_of_it::<Rpf>();
        refuses_all_of_it::<Vt>();
        refuses_all_of_it::<Iapf>();
    }
}
