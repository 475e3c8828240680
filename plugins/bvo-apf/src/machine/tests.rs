#![allow(clippy::unwrap_used, reason = "tests")]

use super::*;
use crate::{
    ahead::of_traps,
    settings::Mode,
    thought::{Walked, walk},
};
use field::{GoalLaw, NearLaw, Pull, PushForm, TangentUse};
use proptest::prelude::*;
use steering::Solid;
use trials::traps::{HULL_M, Kind, Trap};
use world::{Boundary, polyline};

const MODES: [Mode; 4] = [Mode::Literal, Mode::Hull, Mode::Rollout, Mode::Pre];

pub(crate) fn settings(mode: Mode) -> MachineSettings {
    let pull =
        Pull::Logarithm { m: 10.0, trip_m: 40.0, k: None, n: None, rho_1_m: 1.0, near: NearLaw::Corrected };
    let (tangent, tangent_weight) = (TangentUse::Blocking, 1.0);
    MachineSettings {
        mode,
        law: GoalLaw {
            pull,
            k_rep: 10.0,
            push: PushForm::Khatib,
            rho_m: 2.0,
            tangent,
            tangent_weight,
            wall_gain: 0.1,
        },
        step_m: 0.05,
        margin_m: 0.14,
        taut_margin_m: 0.05,
        keep_m: 0.02,
        window_m: 2.0,
        escapes_max: 12,
    }
}

fn map(discs: &[(Point, f64)]) -> KnownMap {
    let disc = |(id, (center, radius_m)): (usize, &(Point, f64))| Solid::disc(id as u32, *center, *radius_m);
    KnownMap {
        solids: discs.iter().enumerate().map(disc).collect(),
        wall: Boundary::Polygon { vertices: Trap::corners() },
        hull_m: HULL_M,
    }
}

/// A cup of discs, open to the west.
fn cup() -> Vec<(Point, f64)> {
    let corners = [(-4.0, 4.0), (4.0, 4.0), (4.0, -4.0), (-4.0, -4.0)].map(|(x, y)| Point::new(x, y));
    polyline::resampled(&corners, 1.0).into_iter().map(|at| (at, 0.7)).collect()
}

fn walked(machine: &mut Machine, start: Point, goal: Point) -> Walked {
    if machine.settings.mode == Mode::Pre {
        return of_traps::<()>(machine, start, goal, 0.1, || Ok(())).unwrap().walked;
    }
    walk::<()>(machine, start, goal, 0.1, || Ok(())).unwrap()
}

fn least_clearance_m(path: &[Point], discs: &[(Point, f64)]) -> f64 {
    let distances = discs.iter().map(|(at, radius_m)| polyline::distance_m(path, *at) - radius_m);
    distances.fold(f64::INFINITY, f64::min) - HULL_M
}

#[test]
fn in_a_cup_it_retreats_seals_the_mouth_goes_round_and_arrives() {
    let mut machine = Machine::new(settings(Mode::Literal), map(&cup()));
    let walked = walked(&mut machine, Point::new(-15.0, 0.3), Point::new(15.0, 0.0));
    assert!(walked.arrived && least_clearance_m(&walked.path, &cup()) > 0.0);
    let [News::Retreats { at }, News::Sealed { circles }, News::Escapes { side, .. }, News::Resumes { .. }] =
        machine.news[..]
    else {
        panic!("{:?}", machine.news)
    };
    assert!(at.x > 0.0 && at.x < 4.0 && circles > 8 && side == Side::Left);
    assert_eq!(machine.virtual_circles().count(), circles);
    // The robot does not enter the cup twice.
    assert!(walked.path.iter().skip_while(|p| p.y < 4.0).all(|p| p.x > 4.0 || p.y.abs() > 4.0));
}

#[test]
fn begun_inside_a_trap_it_finds_the_way_out_without_shutting_itself_in() {
    for mode in MODES {
        let mut machine = Machine::new(settings(mode), map(&cup()));
        let walked = walked(&mut machine, Point::new(1.0, 0.2), Point::new(15.0, 0.0));
        assert!(walked.arrived, "{mode:?} {:?}", machine.news);
        assert!(least_clearance_m(&walked.path, &cup()) > 0.0);
    }
}

#[test]
fn a_goal_within_a_trap_is_not_sealed_off() {
    for mode in MODES {
        let mut machine = Machine::new(settings(mode), map(&cup()));
        let walked = walked(&mut machine, Point::new(15.0, 0.4), Point::new(1.0, 0.0));
        assert!(walked.arrived, "{mode:?} {:?}", machine.news);
        assert!(least_clearance_m(&walked.path, &cup()) > 0.0);
    }
}

#[test]
fn where_there_is_no_way_it_gives_up_instead_of_walking_for_ever() {
    let ring = (0..24).map(|k| f64::from(k) * std::f64::consts::TAU / 24.0);
    let ring: Vec<(Point, f64)> = ring.map(|a| (Point::new(5.0 * a.cos(), 5.0 * a.sin()), 0.7)).collect();
    for mode in MODES {
        let mut machine = Machine::new(settings(mode), map(&ring));
        let walked = walked(&mut machine, Point::new(-15.0, 0.4), Point::origin());
        assert!(!walked.arrived && least_clearance_m(&walked.path, &ring) > 0.0);
    }
}

#[test]
fn every_mode_leaves_random_traps_without_a_touch_and_pre_is_nearly_the_shortest() {
    for mode in MODES {
        let mut ratios = Vec::new();
        for trap in (0..10).flat_map(|seed| Kind::ALL.map(|kind| Trap::random(kind, 4_000 + seed))) {
            let mut machine = Machine::new(settings(mode), map(&trap.discs));
            let walked = walked(&mut machine, trap.start, trap.goal);
            assert!(walked.arrived, "{mode:?} {:?}", machine.news);
            assert!(least_clearance_m(&walked.path, &trap.discs) > 0.0);
            ratios.push(polyline::length_m(&walked.path) / trap.shortest_path().unwrap().length_m);
        }
        let mean = ratios.iter().sum::<f64>() / ratios.len() as f64;
        assert!(mean < if mode == Mode::Pre { 1.05 } else { 2.0 }, "{mode:?} {mean}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]
    #[test]
    fn wherever_discs_lie_no_step_touches_one_and_every_place_is_a_number(
        discs in prop::collection::vec((-8.0..8.0_f64, -8.0..8.0_f64, 0.0..1.5_f64), 0..12),
        goal in (-12.0..12.0_f64, -12.0..12.0_f64),
        mode in 0..4_usize,
    ) {
        let (start, goal) = (Point::new(-20.0, 0.0), Point::new(goal.0, goal.1));
        let discs: Vec<(Point, f64)> = discs.into_iter().map(|(x, y, r)| (Point::new(x, y), r)).collect();
        let mut machine = Machine::new(settings(MODES[mode]), map(&discs));
        let walked = walked(&mut machine, start, goal);
        prop_assert!(walked.path.iter().all(|p| p.x.is_finite() && p.y.is_finite()));
        prop_assert!(least_clearance_m(&walked.path, &discs) > -1e-9 || MODES[mode] == Mode::Pre && !walked.arrived);
    }
}
