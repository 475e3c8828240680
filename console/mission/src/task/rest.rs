//! The rest of a plan, from a place on its path.

use planner_api::{Leg, LegTag, Plan};
use world::{Point, polyline};

/// The part of a plan from a distance `from_m` along its path on, preceded by an approach that begins at the robot.
pub(crate) fn rest_of(plan: &Plan, along_m: f64, approach: &[Point]) -> Plan {
    let (Some(end), Some(joined)) = (plan.path.len().checked_sub(1), approach.len().checked_sub(1)) else {
        return plan.clone();
    };
    let first = polyline::stations_m(&plan.path).partition_point(|at_m| *at_m <= along_m).min(end);
    let shifted = |index: usize| index - first + approach.len();
    let cut = |leg: &Leg| {
        // The leg that the robot is on now begins where the approach ends.
        let begin = if leg.first < first { joined } else { shifted(leg.first) };
        (leg.last >= first).then(|| Leg { first: begin, last: shifted(leg.last), ..*leg })
    };
    let to_plan = Leg { tag: LegTag::Travel, first: 0, last: joined };
    let to_plan = (joined > 0 && !plan.legs.is_empty()).then_some(to_plan);
    Plan {
        path: approach.iter().chain(&plan.path[first..]).copied().collect(),
        legs: to_plan.into_iter().chain(plan.legs.iter().filter_map(cut)).collect(),
        ..plan.clone()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn lanes() -> Plan {
        let path = (0..5).map(|k| Point::new(f64::from(k), 0.0)).collect();
        let leg = |tag, first, last| Leg { tag, first, last };
        let legs = vec![leg(LegTag::Swath, 0, 2), leg(LegTag::Connector, 2, 3), leg(LegTag::Swath, 3, 4)];
        Plan { path, legs, complete: true, ..Plan::default() }
    }

    fn words(plan: &Plan) -> Vec<(&'static str, usize, usize)> {
        plan.legs.iter().map(|leg| (leg.tag.word(), leg.first, leg.last)).collect()
    }

    #[test]
    fn the_leg_under_the_robot_is_cut_and_those_behind_it_are_gone() {
        let rest = rest_of(&lanes(), 1.3, &[Point::new(1.4, 0.2)]);
        assert_eq!(rest.path.iter().map(|p| p.x).collect::<Vec<_>>(), [1.4, 2.0, 3.0, 4.0]);
        assert_eq!(words(&rest), [("swath", 0, 1), ("connector", 1, 2), ("swath", 2, 3)]);
        let rest = rest_of(&lanes(), 2.5, &[Point::new(2.5, 0.0)]);
        assert_eq!(words(&rest), [("connector", 0, 1), ("swath", 1, 2)]);
    }

    #[test]
    fn an_approach_is_a_leg_of_its_own() {
        let rest = rest_of(&lanes(), 0.0, &[Point::new(0.0, 2.0), Point::new(0.0, 1.0)]);
        assert_eq!(words(&rest), [("travel", 0, 1), ("swath", 1, 3), ("connector", 3, 4), ("swath", 4, 5)]);
    }

    proptest! {
        #[test]
        fn the_rest_of_a_sound_plan_is_sound_and_ends_where_it_did(along_m in -1.0..9.0_f64, n in 1..4_usize) {
            let lanes = lanes();
            let rest = rest_of(&lanes, along_m, &vec![Point::new(1.0, 1.0); n]);
            prop_assert!(rest.check().is_ok());
            prop_assert_eq!(rest.path.last(), lanes.path.last());
            prop_assert_eq!(rest.path[0], Point::new(1.0, 1.0));
        }
    }
}
