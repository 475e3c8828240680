//! The survey of a small tank gives a map by which the tank is known.

use super::*;
use ::scenario::Scenario;
use world::{Boundary, Point};

fn small() -> Tank {
    let columns = vec![(Point::new(1.8, 0.4), 0.2), (Point::new(-1.2, -1.5), 0.25)];
    Tank { boundary: Boundary::Circle { radius_m: 3.5 }, columns, anchor: Point::origin() }
}

#[test]
fn a_survey_finds_the_columns_and_the_scenario_of_its_map_holds_map_and_truth() {
    let tank = small();
    let (surveyed, text) = survey(&tank, 5, "tether-safe");
    assert_eq!((&surveyed.end, surveyed.columns, surveyed.unreal), (&Ok(()), [2, 2], 0), "{surveyed:?}");
    assert!(surveyed.errors_m.unwrap().iter().all(|error_m| *error_m < 0.03), "{surveyed:?}");
    let scenario = Scenario::parse(&site::with_truth(&text.unwrap(), &tank), "own map").unwrap();
    let (drawn, all) = (scenario.sim.world.as_drawn().obstacles.len(), scenario.sim.world.obstacles.len());
    assert_eq!((drawn, all), (2, 4));
}

/// In this tank, rays were lost beside the start, so that the nearest place of the only frontier was the start itself.
#[test]
fn a_frontier_that_begins_at_the_start_does_not_end_the_survey() {
    let (surveyed, _) = survey(&Known::E3.tank(43), 43, "tether-safe");
    assert!(surveyed.end == Ok(()) && surveyed.explored > 0.98, "{surveyed:?}");
    assert_eq!((surveyed.columns, surveyed.unreal), ([18, 18], 0), "{surveyed:?}");
}

#[test]
fn the_named_tanks_have_valid_scenarios() {
    for known in Known::ALL {
        let tank = known.tank(3);
        for text in [site::survey(&tank, 3), site::cover(&tank, 3, "tether-safe")] {
            let scenario =
                Scenario::parse(&text, known.id()).unwrap_or_else(|errors| panic!("{}", errors.render()));
            assert_eq!(scenario.sim.world.boundary, tank.boundary);
        }
    }
}

#[test]
fn missions_that_are_not_complete_are_named_with_the_reason() {
    let none = Measured { survey: None, cover: Err("no map".into()) };
    let block = crate::study::Block { table: "t", case: "c", method: "m", note: "" };
    let rows = rows::rows(&block, &[(4, &none)]);
    let of = |metric: &str| rows.iter().find(|row| row.metric == metric).unwrap();
    assert_eq!((of("complete_rate").ours, of("complete_rate").note.as_str()), (Some(0.0), "seed 4 (no map)"));
    assert_eq!((of("coverage_truth").ours, of("coverage_truth").n), (None, 0));
}
