use super::*;
use crate::bench;
use trials::tanks::{CELL_M, Known};

#[test]
fn with_backtracking_through_the_tree_the_cable_comes_in() {
    for known in [Known::E1, Known::E3] {
        let tank = known.tank(6);
        let plan = bench::plan::<HullPartition>(&tank, &[], None).0.unwrap();
        let scan = tank.score(&plan.path, &[], CELL_M).unwrap();
        assert_eq!(scan.certificate.collisions, 0, "{}: {:?}", known.id(), scan.certificate.reasons);
        assert!(
            scan.certificate.end_length_m.unwrap() < 0.5,
            "{}: {:?}",
            known.id(),
            scan.certificate.reasons
        );
        assert!(scan.coverage_reachable > 0.88, "{}: {}", known.id(), scan.coverage_reachable);
    }
}

#[test]
fn the_reported_progress_never_goes_back() {
    bench::assert_progress_rises(&bench::plan::<HullPartition>(&Known::E2.tank(6), &[], None).1);
}

#[test]
fn a_way_round_a_column_that_the_cells_leave_is_closed() {
    let tank = Known::E2.tank(6);
    let (plan, bench) = bench::plan::<HullPartition>(&tank, &[], None);
    let plan = plan.unwrap();
    let scan = tank.score(&plan.path, &plan.cuts, CELL_M).unwrap();
    assert!(scan.certificate.certified, "{:?}", scan.certificate.reasons);
    assert!(bench.logs().iter().any(|(_, said)| said.contains("an added cut")), "{:?}", bench.logs());
}

#[test]
fn a_part_of_a_cell_that_discs_cut_off_gets_a_gate_of_its_own() {
    for (known, seed) in [(Known::E2, 901), (Known::E2, 7), (Known::E1, 907), (Known::E3, 907)] {
        let tank = known.tank(seed);
        let (plan, bench) = bench::plan::<HullPartition>(&tank, &[], None);
        let plan = plan.unwrap();
        let scan = tank.score(&plan.path, &plan.cuts, CELL_M).unwrap();
        assert!(plan.complete, "{} {seed}: {:?}", known.id(), bench.logs());
        assert!(scan.certificate.certified, "{} {seed}: {:?}", known.id(), scan.certificate.reasons);
        assert!(scan.coverage_reachable > 0.88, "{} {seed}: {}", known.id(), scan.coverage_reachable);
    }
}

#[test]
fn a_way_from_where_there_is_no_room_to_spare_leads_through_no_column() {
    let tank = Known::E2.tank(922);
    let plan = bench::plan::<HullPartition>(&tank, &[("backtracking", 1.0)], None).0.unwrap();
    assert_eq!(tank.score(&plan.path, &[], CELL_M).unwrap().certificate.collisions, 0);
}

#[test]
fn moved_directly_from_cell_to_cell_the_way_is_shorter_and_the_cable_is_not() {
    let tank = Known::E2.tank(1);
    let [tree, direct] = [0.0, 1.0].map(|reading| {
        let plan = bench::plan::<HullPartition>(&tank, &[("backtracking", reading)], None).0.unwrap();
        tank.score(&plan.path, &[], CELL_M).unwrap()
    });
    assert!(direct.length_m < tree.length_m, "{} {}", direct.length_m, tree.length_m);
    assert!(direct.certificate.tether_length_max_m > tree.certificate.tether_length_max_m);
}

#[test]
fn a_floor_without_columns_is_one_cell() {
    let tank = trials::tanks::Tank { columns: Vec::new(), ..Known::E3.tank(0) };
    let plan = bench::plan::<HullPartition>(&tank, &[], None).0.unwrap();
    assert!(plan.cuts.is_empty());
    assert!(tank.score(&plan.path, &[], CELL_M).unwrap().coverage_reachable > 0.98);
}

#[test]
fn a_change_of_live_parameters_acts_like_a_new_planner() {
    let changed = trials::changed::<HullPartition>(&[], &[("slow_m", 3.0)]);
    assert!(changed.after == changed.fresh && changed.after != changed.before, "{changed:?}");
}
