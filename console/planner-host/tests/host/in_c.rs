//! The planner in plain C, and its header in C++.

use crate::stand::{
    GOAL, assert_refused, choose, compile, config, direct_c, folder_with, plan, plan_to_cover, pose, step_at,
    workspace,
};
use crate::state::COUNTER;
use mission::Cause;
use mission::planner::{ParamValue, Parameters};
use nalgebra::Point2;
use planner_api::{Drive, Leg, LegTag, PoseEstimate, Status};
use planner_host::{BlockingHost, PluginDirs};

fn host() -> (tempfile::TempDir, BlockingHost) {
    let folder = tempfile::tempdir().unwrap();
    compile(&direct_c(), folder.path(), "direct_c", &[]);
    let host = BlockingHost::new(&PluginDirs::of(vec![folder.path().to_owned()]), config());
    (folder, host)
}

#[test]
fn a_planner_in_c_plans_and_drives_to_the_goal() {
    let (_folder, mut host) = host();
    let info = choose(&mut host, "direct-c", &Parameters::new()).unwrap();
    assert_eq!((info.parameters.len(), info.parameters[0].unit.as_str()), (2, "m/s"));
    let planned = plan(&mut host).unwrap().value;
    assert_eq!((planned.path, planned.cost, planned.complete), (vec![Point2::origin(), GOAL], 5.0, true));
    assert_eq!(planned.legs, [Leg { tag: LegTag::Travel, first: 0, last: 1 }]);
    let mut robot = pose(Point2::origin());
    for tick in 0..600 {
        let reply = step_at(&mut host, tick, robot).unwrap();
        if reply.value.status == Status::Arrived {
            assert!((robot.position - GOAL).norm() < 0.1);
            return;
        }
        assert_eq!((reply.drawings.len(), reply.scalars[0].0.as_str()), (1, "heading_error"));
        robot = driven(robot, reply.value.drive);
    }
    panic!("still at {} after a minute", robot.position);
}

fn driven(from: PoseEstimate, drive: Drive) -> PoseEstimate {
    let Drive::Twist { v_m_per_s, w_rad_per_s } = drive else { panic!("it drives by twists") };
    let heading_rad = from.heading_rad + 0.1 * w_rad_per_s;
    let ahead = nalgebra::Vector2::new(heading_rad.cos(), heading_rad.sin());
    PoseEstimate { position: from.position + 0.1 * v_m_per_s * ahead, heading_rad, ..from }
}

#[test]
fn live_values_reach_a_planner_in_c() {
    let (_folder, mut host) = host();
    choose(&mut host, "direct-c", &Parameters::new()).unwrap();
    let turn_rate = |host: &mut BlockingHost, tick| match step_at(host, tick, pose(Point2::origin()))
        .unwrap()
        .value
        .drive
    {
        Drive::Twist { w_rad_per_s, .. } => w_rad_per_s,
        Drive::Velocity(_) => panic!("it drives by twists"),
    };
    assert!((turn_rate(&mut host, 0) - 1.0).abs() < 1e-12, "at the robot's limit");
    let gain = |gain| Parameters::from([("turn_gain".to_owned(), ParamValue::Float(gain))]);
    host.reconfigure(&gain(0.5)).unwrap();
    assert!((turn_rate(&mut host, 1) - 0.5 * 4.0_f64.atan2(3.0)).abs() < 1e-12);
    assert!(host.reconfigure(&gain(99.0)).unwrap_err().message.contains("takes 0.1 to 10 1/s"));
    let speed = Parameters::from([("speed".to_owned(), ParamValue::Float(0.1))]);
    assert!(host.reconfigure(&speed).unwrap_err().message.contains("cannot change during a mission"));
}

#[test]
fn a_live_value_may_change_beside_a_fixed_one_that_was_set_before() {
    let (_folder, mut host) = host();
    let values = |speed, gain| {
        let values = [("speed", speed), ("turn_gain", gain)];
        Parameters::from(values.map(|(key, value)| (key.to_owned(), ParamValue::Float(value))))
    };
    choose(&mut host, "direct-c", &values(0.1, 1.0)).unwrap();
    host.reconfigure(&values(0.1, 0.5)).expect("the fixed parameter keeps its value");
    let fault = host.reconfigure(&values(0.2, 0.5)).unwrap_err();
    assert_eq!(
        fault.message,
        "parameter `speed` of planner direct-c cannot change during a mission; its old values stay in effect"
    );
}

#[test]
fn answers_that_are_none_are_caught() {
    let spoilt = |by: &str| {
        let good = "out->drive = TP_TWIST; out->status = TP_MOVING; out->a = 0.001 * c->count; out->b = 0.0;";
        let (_folder, dirs) = folder_with("counter", &COUNTER.replace(good, &format!("(void)out; {by}")));
        let mut host = BlockingHost::new(&dirs, config());
        choose(&mut host, "counter", &Parameters::new()).unwrap();
        let fault = step_at(&mut host, 0, pose(Point2::origin())).unwrap_err();
        assert_eq!(fault.cause, Cause::BadOutput);
        fault.message
    };
    assert_eq!(spoilt(""), "planner counter gave no command during step 0");
    assert_eq!(
        spoilt("out->drive = TP_TWIST; out->status = 77; out->a = out->b = 0.0;"),
        "planner counter gave the unknown status 77 during step 0"
    );
    assert_eq!(
        spoilt("h->error(h->ctx, \"odd\", 3); return 4711;"),
        "planner counter failed with unknown code 4711 (odd) during step 0"
    );
}

/// Requests a coverage plan from a planner in C that returns the last corner of every region; the test adds `by` to its
/// source.
fn plans_to_cover(by: &str) -> Result<planner_api::Plan, mission::planner::Fault> {
    let plan = "out->cost = 0.0; out->complete = 1;";
    let covers = format!(
        "if (in->task != TP_COVER || in->n_regions != 2 || !in->has_tether || in->reel != 40.0 ||
             in->max_wrap != 1.5 || in->max_sum_wrap != 2.5 || !TP_HOST_HAS(h, cut)) return TP_E_INVALID;
         h->points(h->ctx, in->targets, 1);
         for (uint32_t i = 0; i < in->n_regions; i++) h->points(h->ctx, &in->regions[i].points[2], 1);
         {by} {plan}"
    );
    let source = COUNTER.replace(plan, &covers).replace("TP_CAP_LOCAL", "TP_CAP_COVERAGE");
    let (_folder, dirs) = folder_with("counter", &source);
    let mut host = BlockingHost::new(&dirs, config());
    choose(&mut host, "counter", &Parameters::new()).unwrap();
    plan_to_cover(&mut host).map(|reply| reply.value)
}

#[test]
fn a_planner_in_c_covers_regions_and_reports_legs_and_cuts() {
    let covering = plans_to_cover(
        "const tp_leg legs[] = {{TP_LEG_TRAVEL, 0, 1, 0}, {TP_LEG_SWATH, 1, 2, 0}};
         h->legs(h->ctx, legs, 2); h->cut(h->ctx, in->regions[0].points, 3); h->cut(h->ctx, in->targets, 1);",
    )
    .unwrap();
    let corner = Point2::new(1.0, 1.0);
    assert_eq!(covering.path, [Point2::new(0.5, 0.0), corner, corner]);
    let leg = |tag, first, last| Leg { tag, first, last };
    assert_eq!(covering.legs, [leg(LegTag::Travel, 0, 1), leg(LegTag::Swath, 1, 2)]);
    assert_eq!(covering.cuts.iter().map(Vec::len).collect::<Vec<_>>(), [3, 1]);
}

#[test]
fn a_path_that_is_too_long_is_refused_and_not_cut() {
    let many = "static tp_vec2 many[1000000];\n h->points(h->ctx, many, 1000000);";
    let fault = plans_to_cover(many).unwrap_err();
    assert_eq!(fault.cause, Cause::BadOutput);
    assert_eq!(fault.message, "planner counter gave a path of more than 1000000 points during plan");
    let cuts = "for (int i = 0; i < 10001; i++) { h->cut(h->ctx, in->targets, 1); }\n";
    let fault = plans_to_cover(cuts).unwrap_err();
    assert_eq!(fault.message, "planner counter gave more than 10000 cuts during plan");
}

#[test]
fn legs_that_are_none_are_caught() {
    let refused = |legs: &str| {
        let fault =
            plans_to_cover(&format!("const tp_leg leg = {legs}; h->legs(h->ctx, &leg, 1);")).unwrap_err();
        assert_eq!(fault.cause, Cause::BadOutput);
        fault.message
    };
    assert_eq!(refused("{9, 0, 1, 0}"), "planner counter gave a leg of unknown kind 9 during plan");
    assert_eq!(
        refused("{0, 0, 3, 0}"),
        "planner counter gave leg 0 from point 0 to 3 in a path of 3 points during plan"
    );
}

#[test]
fn a_planner_that_covers_no_floor_is_not_asked_to() {
    let (_folder, mut host) = host();
    choose(&mut host, "direct-c", &Parameters::new()).unwrap();
    assert_refused(&plan_to_cover(&mut host).unwrap_err(), &["direct-c does not support coverage missions"]);
}

#[test]
fn the_header_is_cplusplus_11_too() {
    let header = workspace().join("plugins/planner-api/include/tankops_planner.h");
    let compiler = std::process::Command::new("c++")
        .args(["-std=c++11", "-fsyntax-only", "-Wall", "-Wextra", "-pedantic", "-Werror", "-x", "c++"])
        .arg(header)
        .output();
    // Not every machine that builds tankops has a C++ compiler.
    if let Ok(compiled) = compiler {
        let errors = String::from_utf8_lossy(&compiled.stderr).replace("#pragma once in main file", "");
        assert!(compiled.status.success(), "{errors}");
    }
}
