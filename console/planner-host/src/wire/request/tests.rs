#![allow(clippy::unwrap_used, reason = "tests")]

use super::*;
use crate::wire::body::Malformed;
use mission::ask::{PlanAsk, Site as OwnSite, StepAsk};
use nalgebra::{Matrix3, Point2};
use planner_api::geometry::Amphibious;
use planner_api::{
    Boundary, Limits, Motion, Obstacle, Outline, Plan, PlanRequest, PoseEstimate, Reason, Sensed, Site, Task,
    TetherLimits, Zone, ZoneKind,
};
use proptest::prelude::*;

fn written(write: impl FnOnce(&mut Writer)) -> Vec<u8> {
    let mut writer = Writer::default();
    write(writer.begin(1, 0, 0));
    writer.finish().unwrap()[13..].to_vec()
}

const CORNERS: [Point2<f64>; 3] = [Point2::new(0.0, 0.0), Point2::new(1.0, 0.0), Point2::new(0.0, 1.0)];

fn with_site<R>(
    obstacles: &[Obstacle<'_>],
    amphibious: Option<Amphibious>,
    call: impl FnOnce(&Site<'_>) -> R,
) -> R {
    let zones = [Zone { kind: ZoneKind::Underwater, outline: Outline::Polygon { vertices: &CORNERS } }];
    let limits = Limits {
        motion: Motion::Point,
        v_max_m_per_s: 0.3,
        w_max_rad_per_s: 1.0,
        radius_m: 0.25,
        sensing_range_m: 2.0,
        acceleration_m_per_s2: 0.5,
        tick_s: 0.1,
        amphibious,
    };
    let boundary = Boundary::Polygon { vertices: &CORNERS };
    let site = Site {
        revision: 3,
        boundary,
        obstacles,
        zones: &zones,
        limits,
        swath_m: 0.4,
        clearance_m: 0.1,
        seed: 9,
    };
    call(&site)
}

fn pose(x: f64) -> PoseEstimate {
    let covariance = Matrix3::new(1.0, 2.0, 3.0, 2.0, 4.0, 5.0, 3.0, 5.0, 6.0);
    PoseEstimate { position: Point2::new(x, -0.5), heading_rad: 0.1, covariance }
}

fn obstacles() -> [Obstacle<'static>; 3] {
    let disc = Outline::Disc { center: Point2::new(1.0, 2.0), radius_m: 0.5 };
    let line = Outline::Polyline { points: &CORNERS, half_width_m: 0.1 };
    [
        Obstacle {
            id: 7,
            outline: disc,
            discovered: true,
            velocity_m_per_s: planner_api::Vector2::new(0.5, -0.25),
        },
        Obstacle {
            id: 8,
            outline: Outline::Polygon { vertices: &CORNERS },
            discovered: false,
            velocity_m_per_s: planner_api::Vector2::zeros(),
        },
        Obstacle { id: 9, outline: line, discovered: false, velocity_m_per_s: planner_api::Vector2::zeros() },
    ]
}

#[test]
fn a_site_arrives_as_it_was_sent() {
    for amphibious in [None, Some(Amphibious::YANG_2021)] {
        with_site(&obstacles(), amphibious, |site| {
            let bytes = written(|w| {
                w.put(site);
            });
            whole::<OwnSite>(Body(&bytes)).unwrap().lend(|arrived| assert_eq!(arrived, site));
        });
    }
}

#[test]
fn every_request_arrives_as_it_was_sent() {
    let reasons = [
        Reason::Start,
        Reason::Blocked,
        Reason::MapChanged,
        Reason::Operator,
        Reason::Swap { from: "apf".into() },
        Reason::Recover,
    ];
    let tasks = [
        Task::Goto { goal: CORNERS[1], tolerance_m: 0.1 },
        Task::Follow { targets: &CORNERS, tolerance_m: 0.2 },
        Task::Cover { anchor: CORNERS[2], regions: &[], tether: None, tolerance_m: 0.3 },
        Task::Cover {
            anchor: CORNERS[2],
            regions: &[&CORNERS, &CORNERS[..1]],
            tether: Some(TetherLimits {
                reel_length_m: 30.0,
                wrap_max_rad: 1.0,
                wrap_total_max_rad: f64::INFINITY,
                pull: None,
            }),
            tolerance_m: 0.3,
        },
    ];
    with_site(&[], None, |site| {
        for (reason, task) in reasons.iter().flat_map(|reason| tasks.iter().map(move |task| (reason, *task)))
        {
            let way = Plan { path: CORNERS.to_vec(), cuts: vec![CORNERS.to_vec()], ..Plan::default() };
            for under_way in [None, Some(&way)] {
                let request =
                    PlanRequest { reason, start: pose(0.5), task, site, previous: &CORNERS, under_way };
                let bytes = written(|w| {
                    w.put(&request);
                });
                whole::<PlanAsk>(Body(&bytes)).unwrap().lend(|arrived| assert_eq!(*arrived, request));
            }
        }
    });
}

#[test]
fn a_load_of_another_build_is_known_as_one_whatever_follows() {
    let load = Load::of(Path::new("/a/b.so"), "apf", 1 << 40, true);
    let bytes = written(|w| load.write(w));
    assert_eq!(Load::read(Body(&bytes)), Ok(Some(load)));
    for other in [[VERSION as u8 - 1, 0, 0, 0], [VERSION as u8 + 1, 255, 255, 255]] {
        assert_eq!(Load::read(Body(&other)), Ok(None));
    }
}

fn sensed<'a>(x: f64, obstacles: &'a [Obstacle<'a>], points: &'a [Point2<f64>]) -> Sensed<'a> {
    Sensed {
        tick: u64::MAX,
        t_s: 1.2,
        dt_s: 0.1,
        pose: pose(x),
        v_m_per_s: 0.2,
        w_rad_per_s: -0.1,
        target: Point2::new(3.0, 4.0),
        targets_ahead: points,
        path_ahead: &points[points.len() / 2..],
        obstacles,
    }
}

proptest! {
    #[test]
    fn what_is_sensed_arrives_as_it_was_sent(x in -1e9..1e9_f64, raw in prop::collection::vec(-9.0..9.0_f64, 0..40)) {
        let points: Vec<_> = raw.windows(2).map(|w| Point2::new(w[0], w[1])).collect();
        let obstacles = obstacles();
        let sensed = sensed(x, &obstacles, &points);
        let bytes = written(|w| { w.put(&sensed); });
        let arrived = whole::<StepAsk>(Body(&bytes)).unwrap();
        prop_assert!(arrived.lend(|arrived| *arrived == sensed));
    }

    #[test]
    fn a_cut_message_is_malformed_and_nothing_worse(cut in 0_usize..300) {
        let obstacles = obstacles();
        let bytes = written(|w| { w.put(&sensed(0.0, &obstacles, &CORNERS)); });
        prop_assume!(cut < bytes.len());
        prop_assert_eq!(whole::<StepAsk>(Body(&bytes[..cut])).err(), Some(Malformed));
    }

    #[test]
    fn noise_is_malformed_and_nothing_worse(noise in prop::collection::vec(any::<u8>(), 0..400)) {
        let _ = whole::<StepAsk>(Body(&noise));
        let _ = whole::<PlanAsk>(Body(&noise));
        let _ = whole::<Values>(Body(&noise));
        let _ = Load::read(Body(&noise));
    }
}
