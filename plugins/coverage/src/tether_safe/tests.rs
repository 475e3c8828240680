use super::*;
use crate::bench;
use crate::polish::shell::open_lanes;
use crate::slit_domain::SlitDomain;
use planner_api::testing::Bench;
use planner_api::{PoseEstimate, TetherLimits, TetherPull};
use proptest::prelude::*;
use trials::tanks::{CELL_M, Known, Tank};
use world::{
    Shape, Vector, polyline,
    tether::{Cable, Drag},
};

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
fn the_floor_is_covered_by_whatever_cells_it_is_counted() {
    for known in Known::ALL {
        let tank = known.tank(12);
        let plan = plan(&tank, &[], None).0.unwrap();
        for cell_m in [0.043, CELL_M, 0.02] {
            let share = tank.score(&plan.path, &plan.cuts, cell_m).unwrap().coverage_reachable;
            assert!(share >= 0.995, "{} by cells of {cell_m} m: {share}", known.id());
        }
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
fn the_reported_progress_never_goes_back() {
    for tank in [Known::E2.tank(3), Tank { columns: Vec::new(), ..Known::E3.tank(0) }] {
        let bench = plan(&tank, &[], None).1;
        bench::assert_progress_rises(&bench);
        assert_eq!(bench.progress().last().map(|(_, what)| what.as_str()), Some("unreachable floor"));
    }
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
    let tether = TetherLimits {
        reel_length_m: 6.0,
        wrap_max_rad: f64::INFINITY,
        wrap_total_max_rad: f64::INFINITY,
        pull: None,
    };
    let (plan, bench) = plan(&tank, &[], Some(tether));
    let plan = plan.unwrap();
    let scan = tank.score(&plan.path, &plan.cuts, CELL_M).unwrap();
    assert!(
        !plan.complete && scan.certificate.tether_length_max_m <= 6.0,
        "{}",
        scan.certificate.tether_length_max_m
    );
    assert!(bench.logs().iter().any(|(_, said)| said.contains("reach of the reel")), "{:?}", bench.logs());
    let logs = bench.logs();
    let (_, why) = logs.iter().rfind(|(level, _)| matches!(level, LogLevel::Warn)).unwrap();
    assert!(why.contains("reel of 6.0 m is too short"), "{why}");
}

#[test]
fn a_reel_that_just_does_is_not_called_too_short() {
    let tank = Known::E1.tank(4);
    let free = plan(&tank, &[], None).0.unwrap();
    let needed_m = tank.score(&free.path, &free.cuts, CELL_M).unwrap().certificate.tether_length_max_m;
    let tether = TetherLimits {
        reel_length_m: needed_m + 0.01,
        wrap_max_rad: f64::INFINITY,
        wrap_total_max_rad: f64::INFINITY,
        pull: None,
    };
    let (plan, bench) = plan(&tank, &[], Some(tether));
    assert!(plan.unwrap().complete, "{:?}", bench.logs());
    assert!(bench.logs().iter().all(|(_, said)| !said.contains("too short")), "{:?}", bench.logs());
}

/// A reel of a given pull, newtons, of which 80 % are preferred.
fn pulled(reel_n: f64) -> TetherLimits {
    let unlimited = f64::INFINITY;
    let pull = TetherPull { floor_n_per_m: 0.3, friction: 0.3, reel_n, preferred_n: 0.8 * reel_n };
    TetherLimits {
        reel_length_m: unlimited,
        wrap_max_rad: unlimited,
        wrap_total_max_rad: unlimited,
        pull: Some(pull),
    }
}

/// The pull that a plan needs, newtons.
fn needed_n(tank: &Tank, plan: &Plan) -> f64 {
    let shapes: Vec<_> =
        tank.columns.iter().map(|(at, radius_m)| Shape::Disc { center: *at, radius_m: *radius_m }).collect();
    let mut cable = Cable::new(tank.anchor, &tank.boundary, &shapes).unwrap();
    let drag = Drag { floor_n_per_m: 0.3, friction: 0.3 };
    let pulls = plan.path.iter().map(|point| {
        cable.drag_to(*point);
        cable.pull_at_anchor_n(drag)
    });
    pulls.fold(0.0, f64::max)
}

#[test]
fn the_pull_of_the_reel_limits_the_plan() {
    let tank = Known::E1.tank(4);
    let (free, _) =
        plan(&tank, &[("cable_share", 3.0), ("wrap_deg", 720.0), ("wrap_total_deg", 720.0)], None);
    let free_n = needed_n(&tank, &free.unwrap());
    let values = [("cable_share", 3.0), ("wrap_deg", 720.0), ("wrap_total_deg", 720.0)];
    let (limited, bench) = plan(&tank, &values, Some(pulled(0.97 * free_n / 0.8)));
    let limited = limited.unwrap();
    assert!(limited.complete, "{:?}", bench.logs());
    let limited_n = needed_n(&tank, &limited);
    assert!(limited_n <= 0.97 * free_n, "{limited_n} N, without a limit {free_n} N");
    let (weak, bench) = plan(&tank, &values, Some(pulled(0.5 * free_n)));
    assert!(!weak.unwrap().complete);
    assert!(bench.logs().iter().any(|(_, said)| said.contains("reeling in needs")), "{:?}", bench.logs());
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
fn overlapping_columns_and_gaps_too_narrow_are_reported_not_dropped() {
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
fn a_little_floor_far_away_is_scanned_if_nothing_else_is_asked_for() {
    let tank = Known::E1.tank(4);
    let (whole, _) = plan(&tank, &[("pattern", 1.0), ("kicks", 0.0)], None);
    let off_m = |point: &Point| (point - tank.anchor).norm();
    let farthest = whole.unwrap().path.into_iter().max_by(|a, b| off_m(a).total_cmp(&off_m(b))).unwrap();
    let obstacles = tank.obstacles();
    let site = tank.site(&obstacles);
    let bench = Bench::new();
    let mut planner: TetherSafe = bench.configure(&[("pattern", 1.0), ("kicks", 0.0)], &site).unwrap();
    let (position, covariance) = (tank.anchor, nalgebra::Matrix3::zeros());
    let start = PoseEstimate { position, heading_rad: 0.0, covariance };
    let little = world::coverage::regions::square(farthest, 0.2);
    let task =
        planner_api::Task::Cover { anchor: tank.anchor, regions: &[&little], tether: None, tolerance_m: 0.3 };
    let reason = planner_api::Reason::Start;
    let request = PlanRequest::new(&reason, start, task, &site);
    let path = planner.plan(&request, &bench.ctx()).unwrap().path;
    let nearest_m = polyline::distance_m(&path, farthest);
    assert!(nearest_m < site.swath_m / 2.0, "{nearest_m} m off, {} m from the anchor", off_m(&farthest));
}

#[test]
fn the_ring_along_the_shell_that_the_tool_does_not_reach_is_margin_and_no_gap() {
    let tank = Tank { columns: Vec::new(), ..Known::E1.tank(4) };
    let obstacles = tank.obstacles();
    let site = tank.site(&obstacles);
    let site = Site { swath_m: 1.4 * (site.clearance_m + site.limits.radius_m), ..site };
    let bench = Bench::new();
    let mut planner: TetherSafe = bench.configure(&[("pattern", 1.0), ("kicks", 0.0)], &site).unwrap();
    let start =
        PoseEstimate { position: tank.anchor, heading_rad: 0.0, covariance: nalgebra::Matrix3::zeros() };
    let task = planner_api::Task::Cover { anchor: tank.anchor, regions: &[], tether: None, tolerance_m: 0.3 };
    let reason = planner_api::Reason::Start;
    planner.plan(&PlanRequest::new(&reason, start, task, &site), &bench.ctx()).unwrap();
    let logs = bench.logs();
    let said: Vec<&String> = logs.iter().map(|(_, said)| said).collect();
    assert!(said.iter().any(|said| said.contains("along the shell is out of reach of lanes")), "{said:?}");
    assert!(!said.iter().any(|said| said.contains("gaps")), "{said:?}");
    let shell = "shell: a rim of 0.09 m along it cannot be reached: hull radius 0.25 m + clearance 0.05 m - half the lane width of 0.42 m";
    assert!(said.iter().any(|said| said.starts_with(shell)), "{said:?}");
}

#[test]
fn the_shell_is_passed_as_near_as_hull_and_clearance_allow() {
    for seed in 0..4 {
        let tank = Known::ALL[seed as usize % 3].tank(seed);
        let (plan, bench) = plan(&tank, &[], None);
        let plan = plan.unwrap();
        let obstacles = tank.obstacles();
        let workspace = Workspace::new(&tank.site(&obstacles), tank.anchor).unwrap();
        let domain = SlitDomain::new(&workspace, plan.cuts.clone()).unwrap();
        let open_m: f64 = open_lanes(&domain, &plan.path).iter().map(|lane| polyline::length_m(lane)).sum();
        assert!(open_m < 0.3, "seed {seed}: {open_m} m left: {:?}", bench.logs());
        let scan = tank.score(&plan.path, &plan.cuts, CELL_M).unwrap();
        assert!(scan.critical_zone > 0.94, "seed {seed}: {}", scan.critical_zone);
    }
}

#[test]
fn a_swath_wider_than_the_floor_and_a_reel_too_short_for_a_lane_are_distinguished() {
    let workspace = |swath_m: f64| {
        let tank = Known::E1.tank(4);
        let obstacles = tank.obstacles();
        Workspace::new(&Site { swath_m, ..tank.site(&obstacles) }, tank.anchor).unwrap()
    };
    let why = |swath_m: f64, reel_length_m: f64| {
        let workspace = workspace(swath_m);
        no_lane(&workspace, reel_length_m)
    };
    assert!(why(50.0, 13.0).is_some_and(|why| why.contains("the swath of 50.00 m is wider than the floor")));
    assert!(why(0.6, 0.5).is_some_and(|why| why.contains("need 0.60 m")));
    assert_eq!(why(0.6, 13.0), None);
}

#[test]
fn cuts_that_would_seal_floor_off_end_somewhere_else() {
    let tank = Known::E3.tank(200);
    let plan = plan(&tank, &[("alpha_deg", 0.0), ("pattern", 1.0)], None).0.unwrap();
    let scan = tank.score(&plan.path, &plan.cuts, CELL_M).unwrap();
    assert!(scan.certificate.certified, "{:?}", scan.certificate.reasons);
}

#[test]
fn a_swath_wider_than_the_gaps_still_gives_a_certified_plan() {
    let tank = Known::E1.tank(6);
    let obstacles = tank.obstacles();
    let site = Site { swath_m: 1.6, ..tank.site(&obstacles) };
    let bench = Bench::new();
    let mut planner: TetherSafe = bench.configure(&[("pattern", 1.0)], &site).unwrap();
    let start =
        PoseEstimate { position: tank.anchor, heading_rad: 0.0, covariance: nalgebra::Matrix3::zeros() };
    let task = planner_api::Task::Cover { anchor: tank.anchor, regions: &[], tether: None, tolerance_m: 0.3 };
    let reason = planner_api::Reason::Start;
    let request = PlanRequest::new(&reason, start, task, &site);
    let plan = planner.plan(&request, &bench.ctx()).unwrap();
    let scan = tank.score(&plan.path, &plan.cuts, CELL_M).unwrap();
    assert!(scan.certificate.certified, "{:?}", scan.certificate.reasons);
    assert!(plan.complete, "{:?}", bench.logs());
}

#[test]
fn a_reel_with_next_to_nothing_on_it_is_refused_with_what_is_needed() {
    let tether = TetherLimits { reel_length_m: 0.2, wrap_max_rad: 9.0, wrap_total_max_rad: 9.0, pull: None };
    let error = plan(&Known::E1.tank(4), &[], Some(tether)).0.unwrap_err();
    assert_eq!(error.code, Code::Config);
    assert!(error.message.contains("9.7 m from the anchor"), "{error}");
}

#[test]
fn an_empty_tank_needs_no_cuts() {
    let tank = Tank { columns: Vec::new(), ..Known::E1.tank(0) };
    let plan = plan(&tank, &[], None).0.unwrap();
    assert!(plan.cuts.is_empty());
    assert!(tank.score(&plan.path, &[], CELL_M).unwrap().coverage_reachable > 0.995);
}

/// Columns anywhere, overlapping or at the wall, but not at the anchor.
fn any_columns() -> impl Strategy<Value = Vec<(Point, f64)>> {
    let column = ((-4.6..4.6, -4.6..4.6), 0.1..0.5);
    let columns = proptest::collection::vec(column, 0..14);
    columns.prop_map(|all| {
        let all = all.into_iter().map(|((x, y), radius_m)| (Point::new(x, y), radius_m));
        all.filter(|(at, radius_m)| at.coords.norm() > radius_m + 0.7).collect()
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    #[test]
    fn a_small_tank_of_any_make_is_covered_certified_and_without_collision(seed in 0_u64..100_000) {
        let mut tank = Tank::random(seed);
        tank.boundary = world::Boundary::Circle { radius_m: 7.0 };
        tank.anchor = Point::origin();
        let fits = |(at, r): &(Point, f64)| at.coords.norm() < 7.0 - r - 0.8 && at.coords.norm() > r + 0.8;
        tank.columns.retain(fits);
        let plan = plan(&tank, &[], None).0.unwrap();
        let scan = tank.score(&plan.path, &plan.cuts, CELL_M).unwrap();
        prop_assert!(scan.certificate.certified, "{:?}", scan.certificate.reasons);
        prop_assert_eq!(scan.certificate.collisions, 0);
        prop_assert!(scan.coverage_reachable >= 0.995, "{}", scan.coverage_reachable);
    }

    #[test]
    fn however_the_columns_stand_the_cable_comes_in(columns in any_columns()) {
        let tank = Tank { boundary: world::Boundary::Circle { radius_m: 5.0 }, columns, anchor: Point::origin() };
        let plan = plan(&tank, &[("pattern", 1.0), ("kicks", 0.5)], None).0.unwrap();
        let scan = tank.score(&plan.path, &plan.cuts, CELL_M).unwrap();
        prop_assert_eq!(scan.certificate.collisions, 0);
        prop_assert!(scan.certificate.end_length_m.is_some_and(|m| m < 1e-6), "{:?}", scan.certificate.reasons);
        prop_assert_eq!(scan.certificate.cut_crossings, 0);
    }
}

fn room(columns: Vec<(Point, f64)>, scale: f64) -> Tank {
    let corners = [(0.0, 0.0), (9.0, 0.0), (9.0, 4.0), (4.0, 4.0), (4.0, 9.0), (0.0, 9.0)];
    let vertices = corners.map(|(x, y)| Point::new(x, y) * scale).to_vec();
    Tank { boundary: world::Boundary::Polygon { vertices }, columns, anchor: Point::new(0.8, 0.8) }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]
    #[test]
    fn a_room_with_a_corner_is_covered_and_the_cable_comes_in_whatever_stands_in_it(
        columns in prop::collection::vec((1.5..8.5_f64, 1.5..8.5_f64, 0.1..0.6_f64), 0..6),
    ) {
        let columns = columns.into_iter().map(|(x, y, radius_m)| (Point::new(x, y), radius_m));
        let tank = room(columns.filter(|(at, _)| at.x < 4.0 || at.y < 4.0).collect(), 1.0);
        let plan = plan(&tank, &[], None).0.unwrap();
        let scan = tank.score(&plan.path, &plan.cuts, CELL_M).unwrap();
        prop_assert!(scan.certificate.certified, "{:?}", scan.certificate.reasons);
        prop_assert!(plan.complete && scan.coverage_reachable >= 0.98, "{}", scan.coverage_reachable);
    }
}

#[test]
fn a_column_before_the_inward_corner_of_a_room_winds_no_tether() {
    let columns = [
        (Point::new(7.865_112_734_388_367, 3.162_433_162_050_592_5), 0.371_145_097_714_142_4),
        (Point::new(2.741_911_319_557_168, 4.939_657_407_848_728_5), 0.366_453_180_126_761_87),
        (Point::new(4.537_906_044_504_924, 3.134_513_433_726_221_3), 0.144_740_636_238_325_98),
    ];
    let tank = room(columns.to_vec(), 1.0);
    let plan = plan(&tank, &[], None).0.unwrap();
    let scan = tank.score(&plan.path, &plan.cuts, CELL_M).unwrap();
    assert!(scan.certificate.certified, "{:?}", scan.certificate.reasons);
}

#[test]
fn no_lane_leads_through_a_gap_that_counts_as_closed() {
    // Between column and wall, the hull with its clearance has 5 mm to spare: a cut there would be as wide as the gap.
    let columns = vec![(Point::new(3.861_788_049_049_917_7, 1.482_762_455_154_961), 0.258_261_250_103_515_4)];
    let tank = Tank { boundary: world::Boundary::Circle { radius_m: 5.0 }, columns, anchor: Point::origin() };
    let plan = plan(&tank, &[("pattern", 1.0), ("kicks", 0.5)], None).0.unwrap();
    let scan = tank.score(&plan.path, &plan.cuts, CELL_M).unwrap();
    assert!(scan.certificate.certified, "{:?}", scan.certificate.reasons);
}

#[test]
fn a_room_that_is_too_large_is_refused_with_the_size_that_can_be_planned() {
    let (plan, bench) = plan(&room(Vec::new(), 12.0), &[], None);
    let error = plan.unwrap_err();
    let message = "the floor of 8064 m² between walls is too large: with lanes of 0.60 m at most 4800 m² can be planned";
    assert!(error.code == Code::Config && error.message.starts_with(message), "{error}");
    assert!(bench.progress().is_empty(), "before any work");
}

#[test]
fn a_robot_millimetres_beyond_a_cut_goes_round_its_end_at_an_obstacle() {
    // A passage between a column and a straight wall, closed by a cut that begins at the edge of the space to keep
    // around the column.
    let square = world::shape::rectangle(Point::new(-3.0, -3.0), Point::new(3.0, 3.0));
    let tank = Tank {
        boundary: world::Boundary::Polygon { vertices: square },
        columns: vec![(Point::new(2.0, 0.0), 0.3)],
        anchor: Point::new(-2.0, 0.0),
    };
    let (bench, obstacles) = (Bench::new(), tank.obstacles());
    let workspace = Workspace::new(&tank.site(&obstacles), tank.anchor).unwrap();
    let keep_m = workspace.keep_m + 0.3;
    let at = |bearing_rad: f64, far_m: f64| {
        Point::new(2.0, 0.0) + Vector::new(bearing_rad.cos(), bearing_rad.sin()) * (keep_m + far_m)
    };
    let cut = vec![at(0.0, 0.005), Point::new(2.6999, -2.69)];
    let plan = Plan { cuts: vec![cut.clone()], path: vec![at(-0.15, 0.02)], ..Default::default() };
    let mut planner: TetherSafe = bench.configure(&[], &tank.site(&obstacles)).unwrap();
    planner.follow.take(&plan, &workspace);
    // The robot is on the side of the wall and continues along an arc around the column; the chord of the arc passes
    // inside the end of the cut.
    let (here, aim) = (Point::new(2.612, -0.09), at(0.3, 0.005));
    assert_eq!(
        world::tether::crossings(&[here, aim], &[cut]),
        1,
        "the chord crosses what the plan calls the cut"
    );
    let pose = PoseEstimate { position: here, heading_rad: 1.5, covariance: nalgebra::Matrix3::zeros() };
    let sensed = Sensed { targets_ahead: &[aim], path_ahead: &[aim], ..Sensed::new(0, 0.1, pose, aim) };
    let command = planner.step(&sensed, &bench.ctx()).unwrap();
    assert_ne!(command.status, planner_api::Status::Stuck, "{:?}", bench.logs());
}
