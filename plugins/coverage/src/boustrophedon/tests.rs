use super::*;
use crate::bench;
use trials::tanks::{CELL_M, Known};

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
