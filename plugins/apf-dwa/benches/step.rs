//! Measures one choice of the dynamic window (147 arcs) with ten discs nearby, and one step of the whole loop.

use criterion::{Criterion, criterion_group, criterion_main};
use field::{GoalLaw, Pull, PushForm, TangentUse, virtual_goals::SquareLaw};
use planner_apf_dwa::{
    Hybrid, HybridSettings, State, Twist, Weights, Window,
    guide::{Field, GuideBy},
    near::NearThings,
    surroundings::Surroundings,
};
use steering::KnownMap;
use trials::amphibious::{AmphibiousLayout, Group, HULL_M};
use world::{Amphibious, Pose, Vector};

const KEEP_M: f64 = HULL_M + 0.12;

fn settings() -> HybridSettings {
    let square = SquareLaw { k_att: 15.0, d_0_m: 3.0, square_m: 4.0, improved: true, hold_steps: 300 };
    let push = GoalLaw {
        pull: Pull::Linear { k: 15.0 },
        k_rep: 5.0,
        push: PushForm::Khatib,
        rho_m: 1.0,
        tangent: TangentUse::Off,
        tangent_weight: 0.0,
        wall_gain: 0.1,
    };
    let weights = Weights { heading: 0.2, distance: 0.1, velocity: 0.1 };
    HybridSettings {
        robot: Amphibious::YANG_2021,
        window: Window {
            acceleration_m_per_s2: 0.1,
            turn_acceleration_rad_per_s2: 0.4,
            weights,
            keep_m: KEEP_M,
            dt_s: 0.1,
        },
        field: Field { square, push, by: GuideBy::Corners, keep_m: KEEP_M },
        steps_max: 0,
    }
}

fn step(criterion: &mut Criterion) {
    let layout = AmphibiousLayout::random(Group::Block, 5);
    let (corners, obstacles, water) =
        (AmphibiousLayout::corners(), layout.obstacles(), AmphibiousLayout::water());
    let zones = AmphibiousLayout::zones(&water);
    let map = KnownMap::new(&AmphibiousLayout::site(&corners, &obstacles, &zones));
    let pose = Pose::new(-1.0, -2.4, 0.8);
    let twist = Twist { v_m_per_s: 0.2, w_rad_per_s: 0.0 };
    let near = NearThings::of(&map, pose.position, 20.0);
    let (window, pace) = (settings().window, Amphibious::YANG_2021.underwater);
    criterion.bench_function("dwa_window", |bencher| {
        bencher.iter(|| window.choose(&pose, twist, pace, Vector::new(1.0, 1.0), &near));
    });
    let mut hybrid = Hybrid::new(settings(), Vec::new(), HULL_M);
    criterion.bench_function("dwa_step", |bencher| {
        let state = State { pose, twist };
        let mut around = Surroundings::new(map.clone());
        around.look(pose.position, 3.0, &[], |_| false);
        bencher.iter(|| hybrid.decide(&state, layout.goal, &[], &around));
    });
}

criterion_group!(benches, step);
criterion_main!(benches);
