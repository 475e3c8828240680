use super::*;
use crate::bench;
use trials::tanks::{CELL_M, CLEARANCE_M, HULL_M, Known};

#[test]
fn the_traditional_way_covers_most_and_leaves_the_cable_entangled() {
    let tank = Known::E1.tank(2);
    let plan = bench::plan::<Boustrophedon>(&tank, &[], None).0.unwrap();
    let scan = tank.score(&plan.path, &[], CELL_M).unwrap();
    assert!(scan.coverage_reachable > 0.96, "{}", scan.coverage_reachable);
    assert!(scan.length_over_lower_bound < 1.10, "{}", scan.length_over_lower_bound);
    assert_eq!(scan.certificate.collisions, 0, "{:?}", scan.certificate.reasons);
    assert!(scan.certificate.end_length_m.unwrap() > 10.0, "{:?}", scan.certificate.end_length_m);
}

#[test]
fn a_shell_lap_scans_what_the_ends_of_lanes_leave_along_the_shell() {
    let tank = Known::E1.tank(2);
    let coverage = |set: &[(&str, f64)]| {
        let plan = bench::plan::<Boustrophedon>(&tank, set, None).0.unwrap();
        let scan = tank.score(&plan.path, &[], CELL_M).unwrap();
        assert_eq!(scan.certificate.collisions, 0, "{:?}", scan.certificate.reasons);
        scan.coverage_reachable
    };
    let (without, with) = (coverage(&[]), coverage(&[("shell_lap", 1.0)]));
    assert!(with > 0.99 && with > without + 0.01, "{without} {with}");
}

#[test]
fn the_reported_progress_never_goes_back() {
    bench::assert_progress_rises(&bench::plan::<Boustrophedon>(&Known::E1.tank(2), &[], None).1);
}

#[test]
fn an_empty_square_is_swept_row_by_row() {
    let tank = trials::tanks::Tank { columns: Vec::new(), ..Known::E3.tank(0) };
    let plan = bench::plan::<Boustrophedon>(&tank, &[], None).0.unwrap();
    let scan = tank.score(&plan.path, &[], CELL_M).unwrap();
    assert!(scan.coverage_reachable > 0.99 && scan.certificate.certified, "{scan:?}");
    assert!(scan.length_over_lower_bound < 1.07, "{}", scan.length_over_lower_bound);
}

#[test]
fn a_robot_a_little_too_near_to_a_column_goes_on_from_beside_it() {
    let tank = Known::E1.tank(2);
    let (column, radius_m) = tank.columns[0];
    let start = column + world::Vector::new(radius_m + HULL_M + CLEARANCE_M - 0.03, 0.0);
    let path = bench::plan_from::<Boustrophedon>(&tank, start).unwrap().path;
    assert!((path[0] - start).norm() < 1e-9 && (path[1] - start).norm() < 0.1, "{} {}", path[0], path[1]);
}

#[test]
fn between_walls_a_lap_is_driven_along_all_of_them() {
    let corners = [(0.0, 0.0), (9.0, 0.0), (9.0, 4.0), (4.0, 4.0), (4.0, 9.0), (0.0, 9.0)];
    let vertices = corners.map(|(x, y)| Point::new(x, y)).to_vec();
    let tank = trials::tanks::Tank {
        boundary: world::Boundary::Polygon { vertices },
        columns: vec![(Point::new(2.0, 5.0), 0.3)],
        anchor: Point::new(0.8, 0.8),
    };
    let plan = bench::plan::<Boustrophedon>(&tank, &[], None).0.unwrap();
    let scan = tank.score(&plan.path, &[], CELL_M).unwrap();
    assert!(plan.complete && scan.coverage_reachable > 0.99, "{}", scan.coverage_reachable);
    assert_eq!(scan.certificate.collisions, 0, "{:?}", scan.certificate.reasons);
}

#[test]
fn a_change_of_live_parameters_acts_like_a_new_planner() {
    let changed = trials::changed::<Boustrophedon>(&[], &[("slow_m", 3.0)]);
    assert!(changed.after == changed.fresh && changed.after != changed.before, "{changed:?}");
}
