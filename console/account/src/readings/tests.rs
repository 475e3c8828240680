//! Readings along a track over a floor with known losses.

use super::*;
use crate::samples::round_tank;
use mission::InstrumentKind;
use nalgebra::Matrix3;
use proptest::prelude::*;
use world::{FloorWear, LossProfile, MetalLoss, PlateSide};

const SAMPLING: Sampling =
    Sampling { channels: 20, pitch_m: 0.01, thickness_mm: 8.0, sigma_mm: 0.2, threshold: 0.2 };

fn pit(x: f64, y: f64, radius_m: f64, depth_mm: f64) -> MetalLoss {
    let (at, profile, side) = (Point::new(x, y), LossProfile::Pit, PlateSide::Underside);
    MetalLoss { at, radius_m, depth_mm, profile, side }
}

fn run(losses: Vec<MetalLoss>) -> RunOpened {
    let mut run = round_tank(0.05);
    let instrument =
        InstrumentConfig { kind: InstrumentKind::Mfl, dead_bands: None, sampling: Some(SAMPLING) };
    run.mission.instrument = Some(instrument);
    run.wear = Some(FloorWear { thickness_mm: 8.0, losses });
    run
}

/// Drives along a line at 0.4 m/s. The true position is `off` from the estimated one.
fn drive(survey: &mut Survey, floor: &Floor, (from, to): (Point, Point), off: Vector) {
    let heading_rad = (to.y - from.y).atan2(to.x - from.x);
    let steps = ((to - from).norm() / 0.04).ceil() as u64;
    for k in 0..=steps {
        let position = from + (to - from) * (k as f64 / steps as f64);
        let covariance = Matrix3::from_diagonal(&nalgebra::Vector3::new(4e-4, 4e-4, 1e-4));
        let estimate = PoseEstimate { position, heading_rad, covariance };
        let truth = Pose { position: position + off, heading_rad };
        let way = Way { floor, counts: k > 0 };
        survey.visit((k, k as f64 * 0.1), &estimate, truth, way, |_| false);
    }
}

/// A lane: its ends, and how far the true position is from the estimated one.
type Lane = ((f64, f64), (f64, f64), Vector);

fn surveyed(losses: Vec<MetalLoss>, lanes: &[Lane]) -> (RunOpened, Survey) {
    let run = run(losses);
    let mut survey = Survey::new(&run).unwrap();
    for ((x, y), (to_x, to_y), off) in lanes {
        drive(&mut survey, &run.floor, (Point::new(*x, *y), Point::new(*to_x, *to_y)), *off);
    }
    (run, survey)
}

#[test]
fn a_lane_has_a_reading_of_every_channel_at_every_pitch_and_no_other() {
    let (run, survey) = surveyed(vec![], &[((-2.0, 0.0), (2.0, 0.0), Vector::zeros())]);
    let summary = survey.summary(&run.floor);
    assert_eq!((summary.count, summary.untestable, summary.indications), (400 * 20, 0, 0));
    let cell = run.floor.cell_at(Point::new(0.52, 0.12)).unwrap();
    assert!((survey.judge().mean_mm(cell).unwrap() - 8.0).abs() < 0.2);
    assert_eq!(survey.judge().mean_mm(run.floor.cell_at(Point::new(0.5, 0.4)).unwrap()), None);
}

#[test]
fn one_pit_under_two_lanes_a_better_plan_and_a_re_scan_is_one_indication() {
    let lanes = [
        ((-2.0, 0.0), (2.0, 0.0), Vector::new(0.02, -0.02)),
        ((2.0, 0.4), (-2.0, 0.4), Vector::new(-0.02, 0.02)),
        // A better plan leads over the same floor once more.
        ((-2.0, 0.2), (2.0, 0.2), Vector::new(0.0, 0.02)),
    ];
    let pits = vec![pit(0.5, 0.2, 0.05, 5.0), pit(-1.0, -0.1, 0.04, 4.0)];
    let (run, survey) = surveyed(pits.clone(), &lanes);
    let again = surveyed(pits.clone(), &lanes[..1]).1;
    let mut judge = survey.judge().clone();
    judge.join(again.judge(), 1);
    for judge in [survey.judge(), &judge] {
        let found = judge.findings(&run.floor);
        assert_eq!(found.len(), 2, "{found:?}");
        for (finding, pit) in found.iter().zip([&pits[1], &pits[0]]) {
            let off_m = (finding.at - pit.at).norm();
            assert!(off_m < 0.05 && finding.error_m > 0.01, "{finding:?}");
            assert!((finding.depth_mm - pit.depth_mm).abs() < 3.0 * SAMPLING.sigma_mm, "{finding:?}");
        }
    }
    let tested = |at: Point| judge.mean_mm(run.floor.cell_at(at).unwrap()).is_some();
    let detections = survey.detections(&judge.findings(&run.floor), tested);
    let counts: Vec<_> = detections.classes.iter().map(|class| (class.losses, class.found)).collect();
    assert_eq!((counts, detections.false_calls), (vec![(0, 0), (1, 1), (1, 1), (0, 0)], 0));
    let summary = survey.summary(&run.floor);
    assert_eq!((summary.detected, summary.false_calls), (Some(1.0), Some(0)));
}

#[test]
fn the_error_of_a_place_falls_with_the_number_of_independent_passes() {
    let lanes = [((-2.0, 0.2), (2.0, 0.2), Vector::zeros()), ((2.0, 0.2), (-2.0, 0.2), Vector::zeros())];
    let pits = vec![pit(0.5, 0.2, 0.05, 5.0)];
    let error_m = |judge: &Judge, floor: &Floor| judge.findings(floor)[0].error_m;
    let (run, once) = surveyed(pits.clone(), &lanes[..1]);
    let (_, again) = surveyed(pits.clone(), &lanes[1..]);
    let mut both = once.judge().clone();
    both.join(again.judge(), 1);
    let ratio = error_m(&both, &run.floor) / error_m(once.judge(), &run.floor);
    assert!((ratio - 0.5_f64.sqrt()).abs() < 0.01, "{ratio}");
    let mut same = once.judge().clone();
    same.join(once.judge(), 0);
    let ratio = error_m(&same, &run.floor) / error_m(once.judge(), &run.floor);
    assert!((ratio - 1.0).abs() < 1e-9, "more readings of the same pass do not reduce the error: {ratio}");
}

#[test]
fn a_reading_beside_a_weld_is_kept_but_not_judged() {
    let mut run = run(vec![pit(0.0, 0.0, 0.1, 6.0)]);
    let near = run.floor.cells_near(Point::origin(), Point::origin(), 0.3);
    let dead: Vec<_> =
        near.into_iter().map(|cell| world::KindRun(Cell::Untestable, cell as u32, 1)).collect();
    run.floor.change(&dead);
    let mut survey = Survey::new(&run).unwrap();
    let lane = (Point::new(-1.0, 0.0), Point::new(1.0, 0.0));
    drive(&mut survey, &run.floor, lane, Vector::zeros());
    let summary = survey.summary(&run.floor);
    assert_eq!((summary.count, summary.indications), (200 * 20, 0));
    assert!(summary.untestable > 500, "{summary:?}");
}

#[test]
fn the_thickness_of_a_plate_is_that_of_its_losses() {
    let thin = MetalLoss { profile: LossProfile::Thinning, ..pit(0.0, 0.0, 4.0, 1.5) };
    let (run, survey) = surveyed(vec![thin], &[((-2.0, 0.0), (2.0, 0.0), Vector::zeros())]);
    let map = crate::plate_map(&run, &run.floor).unwrap();
    let plates = survey.judge().plates(&map, run.floor.len());
    assert!(!plates.is_empty());
    assert_eq!(plates.iter().map(|plate| plate.readings).sum::<u64>(), 400 * 20);
    for plate in plates.iter().filter(|plate| plate.readings > 500) {
        assert!((plate.mean_mm - 6.5).abs() < 0.05, "{plate:?}");
        assert!(plate.least_mm < plate.p5_mm && plate.p5_mm < plate.mean_mm, "{plate:?}");
    }
}

proptest! {
    #[test]
    fn the_covariance_of_a_place_is_that_of_the_pose_seen_from_there(
        heading_rad in -3.0..3.0_f64, left_m in -0.3..0.3_f64, xy in -1e-4..1e-4_f64, turn in 1e-5..1e-3_f64,
    ) {
        let covariance3 = Matrix3::new(4e-4, xy, 0.0, xy, 9e-4, 0.0, 0.0, 0.0, turn);
        let estimate = PoseEstimate { position: Point::origin(), heading_rad, covariance: covariance3 };
        let found = covariance(&estimate, heading_rad, left_m);
        // A turn moves the place along the heading only.
        let (sin, cos) = heading_rad.sin_cos();
        let moved = left_m * left_m * turn;
        let expected = Matrix2::new(4e-4 + moved * cos * cos, xy + moved * sin * cos,
            xy + moved * sin * cos, 9e-4 + moved * sin * sin);
        prop_assert!((found - expected).norm() < 1e-12);
    }
}
