//! Measures one step of the state machine in a random trap, averaged over the whole walk.

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use field::{GoalLaw, NearLaw, Pull, PushForm, TangentUse};
use planner_bvo_apf::{Machine, MachineSettings, Mode, Next};
use steering::KnownMap;
use trials::traps::{Kind, Trap};

fn step(criterion: &mut Criterion) {
    let trap = Trap::random(Kind::U, 7);
    let (corners, obstacles) = (Trap::corners(), trap.obstacles(false));
    let map = KnownMap::new(&Trap::site(&corners, &obstacles, 6.0));
    let mut group = criterion.benchmark_group("bvo_step");
    for (name, mode) in [("literal", Mode::Literal), ("rollout", Mode::Rollout)] {
        let settings = MachineSettings {
            mode,
            law: GoalLaw {
                pull: Pull::Logarithm {
                    m: 10.0,
                    trip_m: (trap.goal - trap.start).norm(),
                    k: None,
                    n: None,
                    rho_1_m: 1.0,
                    near: NearLaw::Corrected,
                },
                k_rep: 10.0,
                push: PushForm::Khatib,
                rho_m: 2.0,
                tangent: TangentUse::Blocking,
                tangent_weight: 1.0,
                wall_gain: 0.1,
            },
            step_m: 0.05,
            margin_m: 0.14,
            taut_margin_m: 0.05,
            keep_m: 0.02,
            window_m: 2.0,
            escapes_max: 12,
        };
        group.bench_function(BenchmarkId::from_parameter(name), |bencher| {
            let fresh = || (Machine::new(settings, map.clone()), trap.start);
            let (mut machine, mut at) = fresh();
            bencher.iter(|| {
                if (trap.goal - at).norm() < 0.1 {
                    (machine, at) = fresh();
                }
                match machine.next(at, trap.goal) {
                    Next::By(way) => at += way,
                    Next::Back(place) => at = place,
                    Next::Nowhere => (machine, at) = fresh(),
                }
            });
        });
    }
    group.finish();
}

criterion_group!(benches, step);
criterion_main!(benches);
