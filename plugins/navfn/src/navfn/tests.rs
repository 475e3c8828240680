use super::*;
use crate::{
    shortest::Shortest,
    trial::{clearance_m, known, newly_seen, plan, plan_trap, planner},
};
use planner_api::{Boundary, Code, Limits, Motion, Obstacle, Outline, Point2, Vector2};
use proptest::prelude::*;
use trials::traps::{Kind, Trap};
use world::polyline;

#[test]
fn it_leaves_every_trap_and_is_never_shorter_than_the_shortest() {
    let mut ratios = Vec::new();
    for trap in (100..112).flat_map(|seed| Kind::ALL.map(|kind| Trap::random(kind, seed))) {
        let ours = plan_trap::<Navfn>(&trap).unwrap();
        let shortest = plan_trap::<Shortest>(&trap).unwrap();
        assert!(ours.complete && clearance_m(&ours.path, &trap) >= 0.0);
        assert!(ours.cost >= shortest.cost - 1e-9);
        ratios.push(polyline::length_m(&ours.path) / shortest.cost);
    }
    let mean = ratios.iter().sum::<f64>() / ratios.len() as f64;
    assert!(mean <= 1.002 && ratios.iter().all(|ratio| *ratio <= 1.03), "{mean}");
}

#[test]
fn on_an_unknown_map_it_arrives_without_a_touch() {
    for trap in (200..204).flat_map(|seed| Kind::ALL.map(|kind| Trap::random(kind, seed))) {
        let (corners, all) = (Trap::corners(), trap.obstacles(true));
        let mut navfn: Navfn = planner(&[("cells", 200.0)], &Trap::site(&corners, &[], 6.0));
        let mut seen = vec![false; all.len()];
        let mut flown = vec![trap.start];
        while flown[flown.len() - 1] != trap.goal {
            let here = flown[flown.len() - 1];
            newly_seen(&trap, &mut seen, here, 6.0);
            let found = known(&all, &seen);
            let path = plan(&mut navfn, here, trap.goal, &Trap::site(&corners, &found, 6.0)).unwrap().path;
            // Drives on along the plan until something new is seen.
            let fresh = path[1..].iter().position(|p| newly_seen(&trap, &mut seen, *p, 6.0));
            flown.extend(&path[1..fresh.map_or(path.len(), |k| k + 2)]);
        }
        assert!(clearance_m(&flown, &trap) >= 0.0);
    }
}

#[test]
fn a_passage_that_the_cells_do_not_show_is_found_all_the_same() {
    // A wall from edge to edge with a slit a little wider than the robot, and cells as wide as the robot.
    let walls =
        [[Point2::new(0.0, -9.0), Point2::new(0.0, 0.0)], [Point2::new(0.0, 0.72), Point2::new(0.0, 9.0)]];
    let obstacles: Vec<Obstacle<'_>> = walls
        .iter()
        .zip(0..)
        .map(|(points, id)| Obstacle {
            id,
            outline: Outline::Polyline { points, half_width_m: 0.05 },
            discovered: false,
            velocity_m_per_s: Vector2::zeros(),
        })
        .collect();
    let corners = [(-8.0, -8.0), (8.0, -8.0), (8.0, 8.0), (-8.0, 8.0)].map(|(x, y)| Point2::new(x, y));
    let limits = Limits {
        motion: Motion::Point,
        v_max_m_per_s: 1.0,
        w_max_rad_per_s: 1.0,
        radius_m: 0.3,
        sensing_range_m: 3.0,
        acceleration_m_per_s2: 0.5,
        tick_s: 0.1,
        amphibious: None,
    };
    let site = |clearance_m| Site {
        revision: 0,
        boundary: Boundary::Polygon { vertices: &corners },
        obstacles: &obstacles,
        zones: &[],
        limits,
        swath_m: 1.0,
        clearance_m,
        seed: 0,
    };
    let (from, to) = (Point2::new(-4.0, 3.0), Point2::new(4.0, -3.0));
    let ask = |clearance_m| {
        let site = site(clearance_m);
        plan(&mut planner::<Navfn>(&[("cells", 20.0)], &site), from, to, &site)
    };
    assert!(ask(0.0).unwrap().complete);
    let error = ask(0.02).unwrap_err();
    assert!(error.code == Code::NoPath && error.message.starts_with("proved"), "{error}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn a_kept_field_leads_to_the_same_plan_as_a_new_one(
        seed in 0..10_000_u64,
        moves in prop::collection::vec((0..60_usize, -2.0..2.0_f64, -2.0..2.0_f64), 1..6),
    ) {
        let trap = Trap::random(Kind::ALL[seed as usize % 4], seed);
        let corners = Trap::corners();
        let mut obstacles = trap.obstacles(true);
        let mut kept: Navfn = planner(&[], &Trap::site(&corners, &[], 6.0));
        for (index, x, y) in moves {
            let index = index % obstacles.len();
            if let Outline::Disc { center, .. } = &mut obstacles[index].outline {
                *center += Vector2::new(x, y);
            }
            let site = Trap::site(&corners, &obstacles, 6.0);
            let ours = plan(&mut kept, trap.start, trap.goal, &site);
            let fresh = plan(&mut planner::<Navfn>(&[], &site), trap.start, trap.goal, &site);
            match (ours, fresh) {
                (Ok(ours), Ok(fresh)) => prop_assert!((ours.cost / fresh.cost - 1.0).abs() < 0.02),
                (ours, fresh) => prop_assert_eq!(ours.is_err(), fresh.is_err()),
            }
        }
    }
}
