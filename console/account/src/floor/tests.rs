//! The account of a small round tank: shares that add up, missed areas with their reasons, plates, and the zone along
//! the shell.

use super::*;
use crate::{passes::Margins, samples::round_tank};
use nalgebra::Matrix2;
use proptest::prelude::*;
use std::sync::LazyLock;
use world::{CellRun, CoverageGrid, Point, Pose, Tool, coverage::runs_of};

/// The account of a grid whose scanned cells are all guaranteed.
fn account(run: &RunOpened, grid: &CoverageGrid, evidence: &Evidence) -> Account {
    let mut scanned = Scanned::new(run.floor.clone(), run.mission.tool(), run.mission.start);
    scanned.believe(&runs_of((0..run.floor.len()).filter(|index| grid.is_covered(*index))));
    super::account(run, &scanned, evidence)
}

/// Lanes from west to east and back, as a plan.
fn lanes() -> Vec<Point> {
    let lane = |k: usize| {
        let y = -3.9 + 0.6 * k as f64;
        let half_m = (4.5_f64.powi(2) - y * y).max(0.0).sqrt();
        let east_m = if k.is_multiple_of(2) { half_m } else { -half_m };
        [Point::new(-east_m, y), Point::new(east_m, y)]
    };
    (0..14).flat_map(lane).collect()
}

/// A run for which all lanes were planned, and that drove the first `flown` of them.
fn scanned(run: &RunOpened, flown: usize) -> (CoverageGrid, Evidence) {
    let (mut grid, mut evidence) = (CoverageGrid::new(run.floor.clone()), Evidence::new(run));
    let path = lanes();
    evidence.plan(&path, &[], true);
    for (k, lane) in path.chunks(2).take(flown).enumerate() {
        let heading_rad = if k.is_multiple_of(2) { 0.0 } else { std::f64::consts::PI };
        let [from, to] = [lane[0], lane[1]].map(|position| Pose { position, heading_rad });
        grid.mark(Tool::Bar { swath_m: 0.6 }, from, to);
        for k in 0..=100 {
            let position = lane[0] + (lane[1] - lane[0]) * f64::from(k) / 100.0;
            evidence.visit(Pose { position, heading_rad }, if k > 0 { 0.1 } else { 1.0 }, k > 0);
        }
        evidence.fly(world::polyline::length_m(&path[..2 * k + 2]));
    }
    (grid, evidence)
}

fn sum(shares: &Shares) -> f64 {
    shares.scanned + shares.missed + shares.unreachable + shares.margin + shares.untestable
}

#[test]
fn both_bases_and_every_plate_sum_to_the_whole() {
    let run = round_tank(0.05);
    let (grid, evidence) = scanned(&run, 9);
    let account = account(&run, &grid, &evidence);
    assert!((sum(&account.whole) - 1.0).abs() < 1e-12 && (sum(&account.reachable) - 1.0).abs() < 1e-12);
    assert!(account.reachable.unreachable + account.reachable.margin < 1e-12);
    assert!(account.whole.margin > 0.02, "{:?}", account.whole);
    let plates_m2: f64 = account.plates.iter().map(|plate| plate.shares.area_m2).sum();
    assert!((plates_m2 - account.whole.area_m2).abs() < 1e-9);
    assert!(account.plates.iter().all(|plate| (sum(&plate.shares) - 1.0).abs() < 1e-12));
    assert!(
        account.plates.iter().any(|plate| plate.shares.scanned == 0.0),
        "plates on which nothing was scanned are listed, too"
    );
    let listed_m2: f64 = account.missed.iter().map(|area| area.area_m2).sum();
    let missed_m2 = account.reachable.missed * account.reachable.area_m2;
    assert!((listed_m2 + account.slivers.area_m2 - missed_m2).abs() < 1e-9);
}

#[test]
fn floor_beside_a_weld_is_untestable_wherever_the_robot_drove_and_all_sums_stay_whole() {
    let plain = round_tank(0.05);
    let bands = world::DeadBands { plates: plain.plates.clone().unwrap(), band_m: 0.05, square_m: 0.2 };
    let maker = world::FloorMaker::new(&plain.world, 0.05, 0.45, 0.6, Point::origin());
    let floor = maker.with_dead_bands(&bands, &plain.world.boundary).into_floor();
    let run = RunOpened { floor, ..plain.clone() };
    let account = |run: &RunOpened| {
        let (grid, evidence) = scanned(run, 14);
        account(run, &grid, &evidence)
    };
    let (with, without) = (account(&run), account(&plain));
    assert!((sum(&with.whole) - 1.0).abs() < 1e-12 && (sum(&with.reachable) - 1.0).abs() < 1e-12);
    assert!(with.plates.iter().all(|plate| (sum(&plate.shares) - 1.0).abs() < 1e-12));
    let percent = with.whole.percent;
    let parts = [percent.scanned, percent.missed, percent.unreachable, percent.margin, percent.untestable];
    assert!((parts.iter().sum::<f64>() - 100.0).abs() < 1e-9, "{parts:?}");
    let untestable = (0..run.floor.len()).filter(|cell| run.floor.kind(*cell) == Cell::Untestable);
    let share = untestable.count() as f64 * run.floor.cell_m2() / with.whole.area_m2;
    assert!(share > 0.05 && (with.whole.untestable - share).abs() < 1e-12, "{share}");
    assert!(
        with.reachable.untestable <= 0.0 && with.plates.iter().all(|plate| plate.shares.untestable > 0.0)
    );
    // What is taken out was scanned, missed or out of reach before.
    assert!((with.whole.area_m2 - without.whole.area_m2).abs() < 1e-9);
    assert!(with.whole.scanned < without.whole.scanned && with.whole.margin < without.whole.margin);
    let written = serde_json::to_string(&without).unwrap();
    assert!(!written.contains("untestable"), "{written}");
}

#[test]
fn lanes_that_were_not_flown_are_reported_with_place_plate_and_reason() {
    let run = round_tank(0.05);
    let (grid, evidence) = scanned(&run, 9);
    let account = account(&run, &grid, &evidence);
    let north = &account.missed[0];
    assert_eq!(north.reason, MissReason::NotReached);
    assert!(north.area_m2 > 2.0 && north.high.y > 4.0 && north.plate.is_some(), "{north:?}");
    // Floor that was not planned touches this area, so they form one area with a cause for each part.
    let reasons: Vec<MissReason> = north.causes.iter().map(|cause| cause.reason).collect();
    assert!(
        reasons.contains(&MissReason::NoLaneBeside) && reasons.contains(&MissReason::NotPlanned),
        "{north:?}"
    );
    let parts_m2: f64 = north.causes.iter().map(|cause| cause.area_m2).sum();
    assert!((parts_m2 - north.area_m2).abs() < 1e-9);
}

fn why_missed(evidence: &Evidence, run: &RunOpened, x: f64, y: f64) -> MissReason {
    let index = run.floor.cell_at(Point::new(x, y)).expect("a place on the floor");
    evidence.reasons(run).why_missed(run.floor.center(index), index)
}

#[test]
fn floor_ahead_of_a_run_that_was_cut_short_was_not_passed_however_near_the_robot_came() {
    let run = round_tank(0.05);
    let (grid, evidence) = scanned(&run, 1);
    let account = account(&run, &grid, &evidence);
    assert!(
        account.missed.iter().all(|area| area.reason != MissReason::PassedBeside),
        "{:?}",
        account.missed
    );
    // The lane beside the only lane that was driven, half a swath away.
    assert_eq!(why_missed(&evidence, &run, 0.0, -3.45), MissReason::NotReached);
}

#[test]
fn a_lane_that_was_flown_beside_its_place_is_reported_as_passed_and_those_ahead_are_not() {
    let run = round_tank(0.05);
    let mut evidence = Evidence::new(&run);
    evidence.plan(&lanes(), &[], true);
    evidence.fly(world::polyline::length_m(&lanes()[..2]));
    assert_eq!(why_missed(&evidence, &run, 0.0, -4.15), MissReason::PassedBeside);
    assert_eq!(why_missed(&evidence, &run, 0.0, -3.45), MissReason::NotReached);
}

#[test]
fn floor_at_the_end_of_the_plan_of_a_complete_run_was_passed_and_not_cut_off() {
    let run = round_tank(0.05);
    let mut evidence = Evidence::new(&run);
    evidence.plan(&lanes(), &[], true);
    evidence.fly_share(0.95);
    let [x, y] = [lanes()[lanes().len() - 1].x, lanes()[lanes().len() - 1].y];
    assert_eq!(why_missed(&evidence, &run, x, y), MissReason::NotReached);
    evidence.complete();
    assert_eq!(why_missed(&evidence, &run, x, y), MissReason::PassedBeside);
}

#[test]
fn a_new_plan_takes_the_place_of_the_one_before_unless_it_is_refused() {
    let run = round_tank(0.05);
    let path = lanes();
    let [first_m, second_m] = [&path[..2], &path[2..8]].map(world::polyline::length_m);
    for (is_refused, north) in [(false, MissReason::NotPlanned), (true, MissReason::NotReached)] {
        let mut evidence = Evidence::new(&run);
        evidence.plan(&path, &[], true);
        evidence.fly(first_m);
        evidence.plan(&path[2..8], &[], true);
        if is_refused {
            evidence.refuse_plan();
        }
        let why = |evidence: &Evidence, x, y| why_missed(evidence, &run, x, y);
        assert_eq!(why(&evidence, 0.0, -3.9), MissReason::PassedBeside);
        assert_eq!(why(&evidence, 0.0, -2.7), MissReason::NotReached);
        assert_eq!(why(&evidence, 2.0, 2.1), north, "refused: {is_refused}");
        if !is_refused {
            evidence.fly_share((first_m + 0.999 * second_m) / (first_m + second_m));
            assert_eq!(why(&evidence, 0.0, -2.7), MissReason::PassedBeside);
        }
    }
}

/// A tether with its anchor in the south and 6.6 m on the reel.
fn tether() -> mission::TetherConfig {
    mission::TetherConfig {
        anchor: Point::new(0.0, -4.5),
        limits: world::tether::Limits { reel_length_m: 6.6, wrap_max_rad: 9.0, wrap_total_max_rad: 9.0 },
        friction: 0.3,
        reel: None,
        allow_uncertified: false,
    }
}

#[test]
fn floor_that_the_cable_does_not_lead_to_is_reported_as_beyond_the_reel_only_if_the_plan_left_it_out() {
    let mut run = round_tank(0.05);
    run.mission.tether = Some(tether());
    for (is_whole, north) in [(true, MissReason::NotPlanned), (false, MissReason::BeyondReel)] {
        let mut evidence = Evidence::new(&run);
        evidence.plan(&lanes()[..16], &[], is_whole);
        assert_eq!(why_missed(&evidence, &run, 0.0, 2.0), north);
        assert_eq!(why_missed(&evidence, &run, 0.0, 1.0), MissReason::NotPlanned, "5.5 m from the anchor");
        assert_eq!(why_missed(&evidence, &run, 0.0, -3.0), MissReason::NotReached);
    }
}

/// The reason for the only missed area.
fn why(run: &RunOpened, evidence: &Evidence, is_missed: impl Fn(Point) -> bool) -> String {
    let mut grid = CoverageGrid::new(run.floor.clone());
    grid.apply(&runs_of((0..run.floor.len()).filter(|index| !is_missed(run.floor.center(*index)))));
    let account = account(run, &grid, evidence);
    let [area] = &account.missed[..] else { panic!("one area: {:?}", account.missed) };
    area.why()
}

#[test]
fn every_gap_has_a_cause_with_its_number() {
    let mut run = round_tank(0.05);
    run.mission.scan.overlap_m = 0.2;
    run.mission.tether = Some(tether());
    let mut evidence = Evidence::new(&run);
    let cut = [Point::new(-1.0, 0.0), Point::new(1.0, 0.0)];
    evidence.plan(&lanes()[..2], &[cut.to_vec()], true);
    let square = |x: f64, y: f64| move |p: Point| (p.x - x).abs() < 0.1 && (p.y - y).abs() < 0.1;
    let says = |text: String, expected: &str| assert!(text.contains(expected), "{text}, not {expected}");
    says(
        why(&run, &evidence, |p| p.x > 4.0 && p.coords.norm() > 4.77 && p.y.abs() < 0.3),
        "m (lane width 0.40 m)",
    );
    says(why(&run, &evidence, square(0.0, 3.4)), "m from column, and no lane of the plan runs along it here");
    says(why(&run, &evidence, square(0.0, 0.2)), "not planned: would wind the tether");
    let untethered =
        RunOpened { mission: mission::MissionConfig { tether: None, ..run.mission.clone() }, ..run.clone() };
    says(why(&untethered, &evidence, square(0.0, 0.2)), "m from the planned lanes (lanes are 0.40 m wide)");
    says(why(&run, &Evidence::new(&run), square(0.0, 0.2)), "the run had no plan when it ended");
    says(why(&run, &evidence, square(0.0, -1.0)), "m from the planned lanes (lanes are 0.40 m wide)");
    says(why(&run, &evidence, square(0.0, -3.9)), "planned, not reached: mission ended up to");
    evidence.fly(1e3);
    says(why(&run, &evidence, square(0.0, -3.9)), "planned, but the robot passed 0.10 m to one side");
}

#[test]
fn guaranteed_is_what_the_tool_passed_wherever_the_robot_stood_within_its_error() {
    let run = round_tank(0.05);
    let mut scanned = Scanned::new(run.floor.clone(), run.mission.tool(), run.mission.start);
    let mut believed = CoverageGrid::new(run.floor.clone());
    // The position is accurate across the heading and inaccurate along it; for the second pass, it is the other way
    // round.
    for (x_m, covariance_m2) in [(-2.0, [0.01, 0.0, 0.0, 0.0001]), (2.0, [0.0001, 0.0, 0.0, 0.01])] {
        let at = |y_m: f64| Pose::new(y_m, x_m, 0.0);
        let covariance = Matrix2::from_row_slice(&covariance_m2);
        scanned.visit(at(-1.0), None);
        let margin_m = scanned.across_m(at(1.0), &covariance);
        scanned.visit(at(1.0), Some(Margins { error_m: 0.25, margin_m, t_s: 0.0 }));
        believed.mark(run.mission.tool(), at(-1.0), at(1.0));
    }
    scanned.believe(&runs_of((0..run.floor.len()).filter(|index| believed.is_covered(*index))));
    let width_m = |y_m: f64| {
        let cells = (0..run.floor.len()).filter(|index| scanned.passes().is_guaranteed(*index));
        let beside = cells.filter(|index| (run.floor.center(*index).y - y_m).abs() < 1.0);
        beside.count() as f64 * run.floor.cell_m2() / 2.0
    };
    // 0.6 m minus twice 2.45 standard deviations across the heading.
    assert!((width_m(-2.0) - 0.55).abs() < 0.051, "{}", width_m(-2.0));
    assert!((width_m(2.0) - 0.11).abs() < 0.051, "{}", width_m(2.0));
    let whole = super::account(&run, &scanned, &Evidence::new(&run)).whole;
    assert!(whole.guaranteed < Some(whole.scanned) && whole.percent.guaranteed.is_some(), "{whole:?}");
}

#[test]
fn floor_passed_without_a_position_says_so() {
    let run = round_tank(0.05);
    let (grid, mut evidence) = scanned(&run, 0);
    for error_m in [0.74, 0.64, 0.9] {
        evidence.visit(run.mission.start, error_m, error_m <= 0.5);
        evidence.leave_uncounted(&[CellRun(0, run.floor.len() as u32)]);
    }
    let account = account(&run, &grid, &evidence);
    let [area] = &account.missed[..] else { panic!("one area over all plates: {:?}", account.missed) };
    assert_eq!(area.why(), "passed with position error 0.64 m, limit 0.50 m");
    assert!(area.plates.len() >= account.plates.len() - 2 && area.plate.as_ref() == area.plates.first());
}

#[test]
fn the_critical_zone_is_named_as_not_done_with_the_reason() {
    let run = round_tank(0.05);
    let (grid, evidence) = scanned(&run, 14);
    let zone = account(&run, &grid, &evidence).critical_zone;
    assert!(!zone.done && zone.scanned.is_some_and(|share| share < 0.05), "{zone:?}");
    assert_eq!(zone.why.as_deref(), Some("not scanned"));
    let arcs_m: f64 = zone.arcs.iter().map(|arc| arc.not_done_m).sum();
    let by_plate_m: f64 = zone.plates.iter().map(|plate| plate.length_m).sum();
    assert!(
        (arcs_m - (zone.length_m - zone.done_m)).abs() < 0.2 && (by_plate_m - zone.length_m).abs() < 1e-9
    );
    let names: Vec<&str> = zone.plates.iter().map(|plate| plate.plate.as_str()).collect();
    assert!(names.len() >= 2 && names[0] == "A-01" && names[1] == "A-02", "{names:?}");
}

#[test]
fn an_arc_over_the_beginning_of_the_shell_is_one_arc() {
    let run = round_tank(0.2);
    let mut evidence = Evidence::new(&run);
    for k in 100..=1900 {
        let angle = std::f64::consts::TAU * f64::from(k) / 2000.0;
        let pose = Pose::new(4.7 * angle.cos(), 4.7 * angle.sin(), angle + std::f64::consts::FRAC_PI_2);
        evidence.visit(pose, if k > 100 { 0.1 } else { 1.0 }, k > 100);
    }
    let zone = account(&run, &CoverageGrid::new(run.floor.clone()), &evidence).critical_zone;
    let [arc] = &zone.arcs[..] else { panic!("one arc: {:?}", zone.arcs) };
    assert!(
        (arc.not_done_m - std::f64::consts::PI).abs() < 0.1 && arc.from.y < 0.0 && arc.to.y > 0.0,
        "{arc:?}"
    );
    assert!((arc.to_m - arc.from_m - arc.not_done_m).abs() < 1e-6, "{arc:?}");
}

#[test]
fn a_tool_that_goes_along_the_shell_does_the_critical_zone_however_coarse_the_cells() {
    let run = round_tank(0.2);
    for (off_m, is_done, gap_mm) in [(0.0, true, 0.0), (0.02, false, 20.0)] {
        let mut evidence = Evidence::new(&run);
        for k in 0..=2000 {
            let angle = std::f64::consts::TAU * f64::from(k) / 2000.0;
            let radius_m = 4.7 - off_m;
            let heading_rad = angle + std::f64::consts::FRAC_PI_2;
            let pose = Pose::new(radius_m * angle.cos(), radius_m * angle.sin(), heading_rad);
            evidence.visit(pose, if k > 0 { 0.1 } else { 1.0 }, k > 0);
        }
        let zone = account(&run, &CoverageGrid::new(run.floor.clone()), &evidence).critical_zone;
        assert!(zone.done == is_done && (zone.gap_m - gap_mm / 1000.0).abs() < 1e-9, "{zone:?}");
        assert!((zone.length_m - 31.4).abs() < 0.1 && zone.done_m <= zone.length_m);
    }
}

#[test]
fn out_of_reach_is_listed_with_the_reason() {
    let run = round_tank(0.05);
    let (grid, evidence) = scanned(&run, 0);
    let account = account(&run, &grid, &evidence);
    let reasons: Vec<OutOfReach> = account.unreachable.iter().map(|area| area.reason).collect();
    assert!(reasons.contains(&OutOfReach::ShellMargin) && reasons.contains(&OutOfReach::BesideObstacle));
    let all_m2 = (account.whole.unreachable + account.whole.margin) * account.whole.area_m2;
    let listed_m2: f64 = account.unreachable.iter().map(|area| area.area_m2).sum();
    let reported_m2 = listed_m2 + account.unreachable_slivers.area_m2;
    assert!((reported_m2 - all_m2).abs() < 1e-9, "no floor is lost: {reported_m2} of {all_m2}");
}

#[test]
fn the_figures_converge_as_the_cells_get_smaller() {
    let shares = [0.2, 0.1, 0.05, 0.025].map(|cell_m| {
        let run = round_tank(cell_m);
        let (grid, evidence) = scanned(&run, 9);
        account(&run, &grid, &evidence).whole
    });
    let finest = shares[3];
    for (coarse, allowed) in shares[..3].iter().zip([0.02, 0.01, 0.004]) {
        let figures = |s: &Shares| [s.scanned, s.missed, s.margin];
        let off =
            figures(coarse).iter().zip(figures(&finest)).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(off < allowed, "{off} off, {coarse:?} against {finest:?}");
    }
}

proptest! {
    #[test]
    fn whatever_was_scanned_the_shares_sum_to_one(runs in prop::collection::vec((0_u32..12_000, 1_u32..400), 0..30)) {
        static TANK: LazyLock<RunOpened> = LazyLock::new(|| round_tank(0.1));
        let run = &*TANK;
        let mut grid = CoverageGrid::new(run.floor.clone());
        grid.apply(&runs.iter().map(|(first, count)| CellRun(*first, *count)).collect::<Vec<_>>());
        let account = account(run, &grid, &Evidence::new(run));
        prop_assert!((sum(&account.whole) - 1.0).abs() < 1e-12 && (sum(&account.reachable) - 1.0).abs() < 1e-12);
        let printed = |percent: Percent| {
            let Percent { scanned, missed, unreachable, margin, .. } = percent;
            [scanned, missed, unreachable, margin].map(|value| (10.0 * value).round() as u32).iter().sum::<u32>()
        };
        let floors = account.plates.iter().map(|plate| plate.shares).chain([account.whole, account.reachable]);
        for shares in floors {
            prop_assert_eq!(printed(shares.percent), 1000);
        }
    }
}

#[test]
fn a_plan_without_a_path_or_with_one_that_cannot_be_leads_to_no_floor() {
    let run = round_tank(0.2);
    for path in [vec![], vec![Point::origin()], vec![Point::origin(), Point::new(1e12, 0.0)]] {
        let (grid, mut evidence) = (CoverageGrid::new(run.floor.clone()), Evidence::new(&run));
        evidence.plan(&path, &[], true);
        evidence.fly_share(0.5);
        let account = account(&run, &grid, &evidence);
        assert!((account.reachable.missed - 1.0).abs() < 1e-12, "{path:?}");
    }
}

#[test]
fn what_another_run_did_not_get_to_keeps_its_number() {
    let run = round_tank(0.1);
    let (_, early) = scanned(&run, 3);
    let ahead: Vec<(usize, f64)> =
        (0..run.floor.len()).filter_map(|cell| Some((cell, early.ahead_m(cell)?))).collect();
    assert!(!ahead.is_empty());
    let mut all = Evidence::new(&run);
    all.join(&early);
    for (cell, ahead_m) in ahead {
        assert!((all.ahead_m(cell).unwrap() - ahead_m).abs() < 1e-3, "cell {cell}");
    }
}

#[test]
fn floor_that_was_not_requested_or_lies_in_a_no_go_zone_is_listed_with_a_distance() {
    let mut run = round_tank(0.05);
    let regions = vec![world::coverage::regions::square(Point::new(0.0, -2.0), 2.0)];
    run.mission.task = mission::TaskConfig::Cover { anchor: Point::origin(), regions, tolerance_m: 0.3 };
    let is_zone = |place: Point| place.x.abs() < 1.0 && (0.4..1.4).contains(&place.y);
    let zone = (0..run.floor.len()).filter(|cell| is_zone(run.floor.center(*cell)));
    let kinds: Vec<_> = zone.map(|cell| world::KindRun(Cell::NoGo, cell as u32, 1)).collect();
    run.floor.change(&kinds);
    let account = account(&run, &CoverageGrid::new(run.floor.clone()), &Evidence::new(&run));
    let all: Vec<String> = account.missed.iter().map(ToString::to_string).collect();
    // The bar reaches up to 4.83 m in the north, and the first cells of the square are 1.03 m south of the centre: that
    // makes 5.85 m. The actual distance is slightly larger, because the zone lies between them.
    assert!(all[0].contains("not requested, up to 5.93 m outside"), "{all:?}");
    let out = account.unreachable.iter().find(|area| area.reason == OutOfReach::NoGo).expect("the zone");
    assert_eq!(out.why(), "in a no-go zone, up to 0.50 m from reachable floor");
}

#[test]
fn floor_that_was_not_requested_is_never_one_area_with_floor_that_was() {
    let mut run = round_tank(0.05);
    let regions = vec![world::coverage::regions::square(Point::new(0.0, -2.0), 2.0)];
    run.mission.task = mission::TaskConfig::Cover { anchor: Point::origin(), regions, tolerance_m: 0.3 };
    let account = account(&run, &CoverageGrid::new(run.floor.clone()), &Evidence::new(&run));
    let asked_m2: f64 = account
        .missed
        .iter()
        .filter(|area| area.reason != MissReason::NotAsked)
        .map(|area| area.area_m2)
        .sum();
    for area in &account.missed {
        let not_asked = area.causes.iter().filter(|cause| cause.reason == MissReason::NotAsked).count();
        assert!(not_asked == 0 || area.causes.len() == 1, "{area:?}");
    }
    assert!((asked_m2 - 4.0).abs() < 0.3, "{asked_m2} m² of a square of 2 m");
    let reachable_m2 = account.reachable.area_m2;
    assert!((account.not_asked_m2() + asked_m2 - reachable_m2).abs() < 0.02, "{:?}", account.missed);
}

#[test]
fn shares_of_the_requested_floor_do_not_count_floor_beside_it() {
    let mut run = round_tank(0.05);
    let whole = account(&run, &CoverageGrid::new(run.floor.clone()), &Evidence::new(&run));
    assert!(whole.requested.is_none() && whole.due() == &whole.reachable, "all of it was requested");
    let regions = vec![world::coverage::regions::square(Point::new(0.0, -2.0), 2.0)];
    run.mission.task = mission::TaskConfig::Cover { anchor: Point::origin(), regions, tolerance_m: 0.3 };
    let within = |place: Point| place.x.abs() < 1.0 && (place.y + 2.0).abs() < 1.0;
    let evidence = Evidence::new(&run);
    let of = |is_scanned: &dyn Fn(usize) -> bool| {
        let mut grid = CoverageGrid::new(run.floor.clone());
        grid.apply(&runs_of((0..run.floor.len()).filter(|cell| is_scanned(*cell))));
        account(&run, &grid, &evidence).requested.expect("a part was requested")
    };
    // Everything north of the square, and its western half.
    let half = of(&|cell| {
        let place = run.floor.center(cell);
        place.y > -1.0 || within(place) && place.x < 0.0
    });
    assert!((half.area_m2 - 4.0).abs() < 1e-9 && (half.scanned - 0.5).abs() < 1e-9, "{half:?}");
    assert!((half.percent.scanned, half.percent.missed) == (50.0, 50.0), "{half:?}");
    // All of the square but one cell of 1600: 100.0 is stated only if nothing is left.
    let first = (0..run.floor.len()).find(|cell| within(run.floor.center(*cell)));
    let left = of(&|cell| Some(cell) != first);
    assert!((left.percent.scanned, left.percent.missed) == (99.9, 0.1), "{left:?}");
    assert!(of(&|_| true).percent.scanned >= 100.0);
}

/// The unreachable areas of a floor after a box has been closed as a no-go zone.
fn out_of_reach_with(run: &RunOpened, zone: &world::Shape) -> Vec<Area<OutOfReach>> {
    let mut evidence = Evidence::new(run);
    let mut maker = world::FloorMaker::new(&run.world, 0.05, 0.45, 0.6, Point::origin());
    let changes = maker.forbid(&run.world, zone);
    evidence.forbid("no-go zone no-go 1, drawn by the operator at 12.0 s".into(), zone);
    evidence.shut(&changes);
    let mut run = run.clone();
    run.floor.change(&changes);
    account(&run, &CoverageGrid::new(run.floor.clone()), &evidence).unreachable
}

fn rectangle(low: (f64, f64), high: (f64, f64)) -> world::Shape {
    let corners = [low, (high.0, low.1), high, (low.0, high.1)];
    world::Shape::Polygon { vertices: corners.map(|(x, y)| Point::new(x, y)).to_vec() }
}

#[test]
fn floor_in_a_drawn_zone_names_it_and_so_does_floor_that_it_closes_off() {
    let run = round_tank(0.05);
    let words = "no-go zone no-go 1, drawn by the operator at 12.0 s";
    let within = out_of_reach_with(&run, &rectangle((1.0, -1.0), (2.5, 0.5)));
    let named = within.iter().find(|area| area.reason == OutOfReach::NoGo).expect("the zone");
    assert!(named.why().starts_with(&format!("in {words}, up to ")), "{}", named.why());
    // A bar across the tank closes off the floor east of it.
    let across = out_of_reach_with(&run, &rectangle((2.0, -6.0), (2.2, 6.0)));
    let closed: Vec<String> = across.iter().map(Area::why).collect();
    assert!(
        closed.iter().any(|why| why.contains(&format!("closed off by {words}: no passage"))),
        "{closed:?}"
    );
}

#[test]
fn floor_beside_a_drawn_zone_is_missed_for_its_clearance_only_where_no_lane_has_room() {
    let run = round_tank(0.05);
    let mut evidence = Evidence::new(&run);
    let zone = rectangle((1.0, -1.0), (2.5, 0.5));
    evidence.plan(&lanes()[..2], &[], true);
    evidence.forbid("no-go zone no-go 1, drawn by the operator at 12.0 s".into(), &zone);
    assert_eq!(why_missed(&evidence, &run, 0.72, 0.0), MissReason::NoLaneBeside);
    assert_eq!(why_missed(&evidence, &run, -2.0, 0.0), MissReason::NotPlanned);
    // Between two zones, 0.8 m apart, hull and clearance (0.9 m) do not fit.
    evidence.forbid("no-go zone no-go 2".into(), &rectangle((0.0, -1.0), (0.2, 0.5)));
    assert_eq!(why_missed(&evidence, &run, 0.62, -0.22), MissReason::Clearance);
    let reasons = evidence.reasons(&run);
    let cell = run.floor.cell_at(Point::new(0.72, 0.0)).expect("a place on the floor");
    let measure = reasons.measure(&CoverageGrid::new(run.floor.clone()), MissReason::Clearance, &[cell]);
    assert!(measure.expect("a number").near.expect("a name").contains("no-go 1"));
}

#[test]
fn listed_areas_leave_out_what_was_not_requested_and_end_with_what_was_not_reached() {
    let run = round_tank(0.05);
    let mut account = account(&run, &CoverageGrid::new(run.floor.clone()), &Evidence::new(&run));
    let area = |reason, area_m2| Area { area_m2, reason, ..account.missed[0].clone() };
    let missed = vec![
        area(MissReason::NotReached, 9.0),
        area(MissReason::NotAsked, 8.0),
        area(MissReason::Clearance, 7.0),
        area(MissReason::NotReached, 6.0),
        area(MissReason::Wrap, 5.0),
    ];
    account.missed = missed;
    let listed: Vec<f64> = account.listed().iter().map(|area| area.area_m2).collect();
    assert_eq!(listed, [7.0, 5.0, 9.0, 6.0]);
}
