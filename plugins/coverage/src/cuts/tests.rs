use super::*;
use crate::plane::direction;
use rand::{RngExt, SeedableRng};
use trials::tanks::{Known, Tank};
use world::Boundary;

/// A round tank without columns, home at its middle.
fn empty_tank() -> Workspace {
    let tank = Tank { columns: Vec::new(), ..Known::E1.tank(1) };
    let obstacles = tank.obstacles();
    Workspace::new(&tank.site(&obstacles), Point::origin()).unwrap()
}

#[test]
fn the_cut_that_seals_floor_off_is_found_wherever_it_runs() {
    let workspace = empty_tank();
    for k in 0..40 {
        let ahead = direction(0.157 * f64::from(k));
        let across = |at_m: f64| {
            let foot = Point::origin() + ahead * at_m;
            let side = direction(0.157 * f64::from(k) + 1.5);
            vec![foot - side * 30.0, foot + side * 30.0]
        };
        // The outer cut seals off nothing that the first cut does not already seal off.
        let made = [across(1.0 + 0.07 * f64::from(k)), across(5.5)];
        let domain = SlitDomain::new(&workspace, vec![made[0].clone()]).unwrap();
        assert!(domain.sealed.area_m2 > 1.0 && !domain.sealed.rim.is_empty());
        assert_eq!(last_at_rim(&made, &domain.sealed), Some(&made[0][..]), "cut {k}");
    }
}

/// Columns in rows, each slightly displaced: few gaps are wide enough for the robot.
fn crowded_tank(seed: u64) -> Tank {
    let mut rng = rand_pcg::Pcg64Mcg::seed_from_u64(seed);
    let places = (-7..=7).flat_map(|row: i32| (-7..=7).map(move |column: i32| (row, column)));
    let at = |(row, column): (i32, i32)| {
        let across_m = (f64::from(column) + 0.5 * f64::from(row % 2)) * 1.2;
        let mut aside_m = || rng.random_range(-0.2..0.2);
        Point::new(across_m + aside_m(), f64::from(row) * 0.87 * 1.2 + aside_m())
    };
    let is_clear = |at: &Point| (0.6..4.1).contains(&at.coords.norm());
    let columns = places.map(at).filter(is_clear).map(|at| (at, 0.2)).collect();
    Tank { boundary: Boundary::Circle { radius_m: 5.0 }, columns, anchor: Point::origin() }
}

#[test]
fn cuts_that_seal_floor_off_are_recomputed_until_they_do_not() {
    for (seed, alpha_rad, cable_m) in
        [(9, 0.0, 1e3), (19, 0.0, 1e3), (59, 0.0, 1e3), (5, 0.9, 7.0), (8, 0.9, 7.0)]
    {
        let tank = crowded_tank(seed);
        let obstacles = tank.obstacles();
        let workspace = Workspace::new(&tank.site(&obstacles), tank.anchor).unwrap();
        let (pattern, rule) = (Pattern::Contours, CutRule { alpha_rad, cable_m });
        let made = cuts(&workspace, &pattern, &rule, &[]);
        let first = SlitDomain::new(&workspace, made).unwrap().sealed.area_m2;
        let last = domain(&workspace, &pattern, &rule).unwrap().sealed.area_m2;
        assert!(first > SLIVER_M2, "{seed}: {first}");
        assert!(last <= SLIVER_M2, "{seed}: {last}");
    }
}
