use super::*;
use crate::bench;
use planner_api::{Code, testing::Bench};
use trials::tanks::{CELL_M, Known, Tank};

fn plan(tank: &Tank, values: &[(&str, f64)], tether: Option<TetherLimits>) -> (Result<Plan>, Bench) {
    bench::plan::<TetherSafe>(tank, values, tether)
}

#[test]
fn every_known_tank_is_covered_and_the_cable_comes_in() {
    for known in Known::ALL {
        let tank = known.tank(11);
        let (plan, bench) = plan(&tank, &[("pattern", 1.0)], None);
        let plan = plan.unwrap();
        let scan = tank.score(&plan.path, &plan.cuts, CELL_M).unwrap();
        assert!(scan.certificate.certified, "{}: {:?}", known.id(), scan.certificate.reasons);
        assert!(scan.coverage_reachable >= 0.995, "{}: {}", known.id(), scan.coverage_reachable);
        assert!(scan.length_over_lower_bound < 1.25, "{}: {}", known.id(), scan.length_over_lower_bound);
        assert!(plan.complete && !bench.logs().is_empty());
    }
}

#[test]
fn legs_name_the_whole_path_in_order() {
    let (plan, _) = plan(&Known::E1.tank(3), &[("pattern", 1.0), ("kicks", 1.0)], None);
    let plan = plan.unwrap();
    assert_eq!(plan.legs.first().map(|leg| leg.first), Some(0));
    assert_eq!(plan.legs.last().map(|leg| leg.last), Some(plan.path.len() - 1));
    assert!(plan.legs.windows(2).all(|w| w[0].last == w[1].first));
}

#[test]
fn the_same_question_gets_the_same_answer() {
    let tank = Known::E3.tank(5);
    let quick = [("pattern", 1.0), ("kicks", 1.0)];
    assert_eq!(plan(&tank, &quick, None).0, plan(&tank, &quick, None).0);
}

#[test]
fn a_short_reel_gives_a_partial_plan_that_says_what_is_left() {
    let tank = Known::E1.tank(4);
    let tether = TetherLimits { reel_m: 6.0, max_wrap_rad: f64::INFINITY, max_sum_wrap_rad: f64::INFINITY };
    let (plan, bench) = plan(&tank, &[], Some(tether));
    let plan = plan.unwrap();
    let scan = tank.score(&plan.path, &plan.cuts, CELL_M).unwrap();
    assert!(!plan.complete && scan.certificate.max_cable_m <= 6.0, "{}", scan.certificate.max_cable_m);
    assert!(bench.logs().iter().any(|(_, said)| said.contains("beyond the reel")), "{:?}", bench.logs());
}

#[test]
fn an_anchor_in_a_column_or_outside_is_refused_with_a_reason() {
    let tank = Known::E1.tank(4);
    let in_column = Tank { anchor: tank.columns[0].0, ..tank.clone() };
    let error = plan(&in_column, &[], None).0.unwrap_err();
    assert!(error.code == Code::StartOccupied && error.message.contains("inside the obstacle"), "{error}");
    let outside = Tank { anchor: Point::new(20.0, 0.0), ..tank };
    assert_eq!(plan(&outside, &[], None).0.unwrap_err().code, Code::StartOutside);
}

#[test]
fn overlapping_columns_and_gaps_too_narrow_are_told_not_dropped() {
    let mut tank = Known::E1.tank(4);
    // A ring of columns that leave no gap: what they enclose cannot be reached.
    let ring = |k: i32| {
        let angle = f64::from(k) * std::f64::consts::TAU / 8.0;
        (Point::new(5.0 + 1.2 * angle.cos(), 1.2 * angle.sin()), 0.4)
    };
    tank.columns = (0..8).map(ring).collect();
    let (plan, bench) = plan(&tank, &[], None);
    let plan = plan.unwrap();
    let scan = tank.score(&plan.path, &plan.cuts, CELL_M).unwrap();
    assert!(scan.coverage_reachable > 0.99, "{}", scan.coverage_reachable);
    assert!(bench.logs().iter().any(|(_, said)| said.contains("cannot be reached")), "{:?}", bench.logs());
}

#[test]
fn an_empty_tank_needs_no_cuts() {
    let tank = Tank { columns: Vec::new(), ..Known::E1.tank(0) };
    let plan = plan(&tank, &[], None).0.unwrap();
    assert!(plan.cuts.is_empty());
    assert!(tank.score(&plan.path, &[], CELL_M).unwrap().coverage_reachable > 0.995);
}
