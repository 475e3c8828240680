#![allow(clippy::unwrap_used, reason = "tests")]

use super::*;
use crate::{guide::GuideBy, window::Weights};
use field::{GoalLaw, Pull, PushForm, TangentUse, virtual_goals::SquareLaw};
use trials::amphibious::{AmphibiousLayout, Group, HULL_M};
use world::{Shape, ZoneKind, polyline};

const KEEP_M: f64 = HULL_M + 0.12;

fn settings(by: GuideBy, transition_steps: u32) -> HybridSettings {
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
    HybridSettings {
        robot: Amphibious { transition_steps, ..Amphibious::YANG_2021 },
        window: Window {
            acceleration_m_per_s2: 0.1,
            turn_acceleration_rad_per_s2: 0.4,
            weights: Weights { heading: 0.2, distance: 0.1, velocity: 0.1 },
            keep_m: KEEP_M,
            dt_s: 0.1,
        },
        field: Field { square, push, by, keep_m: KEEP_M },
        steps_max: 0,
    }
}

fn runs(group: Group, seed: u64, settings: &HybridSettings) -> (AmphibiousLayout, Run) {
    let layout = AmphibiousLayout::random(group, seed);
    let (corners, obstacles, water) =
        (AmphibiousLayout::corners(), layout.obstacles(), AmphibiousLayout::water());
    let zones = AmphibiousLayout::zones(&water);
    let map = KnownMap::new(&AmphibiousLayout::site(&corners, &obstacles, &zones));
    let flooded = Zone {
        name: String::new(),
        kind: ZoneKind::Underwater,
        shape: Shape::Polygon { vertices: water.clone() },
    };
    let mut hybrid = Hybrid::new(*settings, vec![flooded], HULL_M);
    let start = Pose { position: layout.start, heading_rad: std::f64::consts::FRAC_PI_4 };
    let run = run::<()>(&mut hybrid, start, layout.goal, 0.15, 4000, &map, || Ok(())).unwrap();
    (layout, run)
}

#[test]
fn on_random_layouts_it_arrives_on_nearly_the_shortest_path_and_keeps_clear() {
    for group in Group::ALL {
        let mut ratios = Vec::new();
        for seed in 500..515 {
            let (layout, run) = runs(group, seed, &settings(GuideBy::Corners, 20));
            assert!(run.arrived, "{group:?} {seed} {:?}", run.path.last());
            assert!(run.path.iter().all(|p| layout.hull_clearance_m(*p) >= 0.1));
            ratios.push(polyline::length_m(&run.path) / layout.shortest_path().unwrap().length_m);
        }
        assert!(ratios.iter().sum::<f64>() / 15.0 < 1.1, "{ratios:?}");
    }
}

#[test]
fn changing_over_in_twenty_steps_it_never_exceeds_its_limit_and_at_once_it_does() {
    let over = |steps: u32| runs(Group::Free, 3, &settings(GuideBy::Corners, steps)).1.overspeed_m_per_s;
    assert!(over(20) < 1e-9);
    assert!((over(0) - 0.09).abs() < 1e-6);
}

#[test]
fn the_published_square_passes_most_free_floors_and_never_touches_anything() {
    let all: Vec<(AmphibiousLayout, Run)> =
        (700..715).map(|seed| runs(Group::Free, seed, &settings(GuideBy::Square, 20))).collect();
    assert!(all.iter().filter(|(_, run)| run.arrived).count() >= 12);
    for (layout, run) in &all {
        assert!(run.path.iter().all(|p| layout.hull_clearance_m(*p) >= 0.1));
    }
}
