//! The study on paths that need no planner.

use super::{drive::Home, *};
use crate::study::Block;
use trials::tanks::Known;
use world::Point;

fn tank() -> Tank {
    Tank { columns: vec![(Point::new(3.0, 0.0), 0.3)], ..Known::E1.tank(0) }
}

/// Out on one side of the column, across behind it, back towards the anchor and home on the way out.
fn path() -> Vec<Point> {
    [
        (0.0, 0.0),
        (2.0, 4.0),
        (7.0, 2.0),
        (7.0, -3.0),
        (4.0, -2.5),
        (7.0, -3.0),
        (7.0, 2.0),
        (2.0, 4.0),
        (0.0, 0.0),
    ]
    .map(|(x, y)| Point::new(x, y))
    .to_vec()
}

#[test]
fn a_strong_reel_keeps_the_certificate_and_a_weak_one_is_held_before_the_robot_meets_its_cable() {
    let strong = drive(&tank(), &path(), 0.8, None);
    assert!(strong.excess_max_m <= 0.3 && strong.times_over == 0 && strong.snags == 0, "{strong:?}");
    assert!(!strong.is_held && strong.end_excess_m < 0.3, "{strong:?}");
    let weak = drive(&tank(), &path(), 3.0, None);
    assert!(weak.excess_max_m > 1.0 && weak.is_held && weak.times_over_before_hold == 0, "{weak:?}");
    assert_eq!(weak.is_freed, Some(true), "{weak:?}");
}

#[test]
fn the_way_home_after_slack_leads_beside_the_cable_that_lies_on_the_floor() {
    let weak = drive(&tank(), &path(), 1.5, None);
    let Some((times, on_line)) = weak.times_over_home else { panic!("not held: {weak:?}") };
    assert!(times == 0 && on_line > 0 && weak.home == Some(Home::There), "{weak:?}");
}

#[test]
fn with_a_reel_that_has_stopped_the_robot_drives_home_beside_its_cable() {
    for share in [0.3, 0.45, 0.6, 0.75] {
        let dead = drive(&tank(), &path(), 0.5, Some(share));
        let Some((times, _)) = dead.times_over_home else { panic!("refused or not held: {share} {dead:?}") };
        assert!(dead.is_held && times == 0 && dead.home == Some(Home::There), "{share} {dead:?}");
    }
}

#[test]
fn the_pull_of_the_certificate_takes_up_the_simulated_cable() {
    let found = reeling(&tank(), &path());
    assert!(found.len() >= 5, "{found:?}");
    for Reeling { certified_n, simulated_n } in found {
        assert!((simulated_n / certified_n - 1.0).abs() < 0.1, "{certified_n} N, simulated {simulated_n} N");
    }
}

#[test]
fn tanks_without_a_path_are_named_and_lower_the_rate() {
    let block = Block { table: "tether-physics", case: "ratio-0.8", method: "m", note: "" };
    let good = Measured::Drive(Drive { excess_max_m: 0.1, longest_m: 5.0, ..Drive::default() });
    let loose =
        Measured::Drive(Drive { excess_max_m: 0.4, longest_m: 9.0, times_over: 2, ..Drive::default() });
    let none = Measured::NoPath("no room".into());
    let rows = rows::rows(&block, &[(3, &good), (4, &loose), (5, &none)]);
    let of = |metric: &str| rows.iter().find(|row| row.metric == metric).unwrap();
    assert_eq!((of("path_rate").n, of("path_rate").note.as_str()), (3, "seed 5 (no room)"));
    assert_eq!((of("within_margin_rate").ours, of("excess_m_max").note.as_str()), (Some(0.5), "seed 4"));
    assert_eq!((of("held_before_own_cable_rate").ours, of("held_before_own_cable_rate").n), (Some(0.0), 1));
    assert_eq!(of("freed_rate").ours, None);
}
