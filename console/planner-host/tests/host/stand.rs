//! A tank, a robot, a host, and plugins compiled from a few lines of C.

use mission::planner::{ParamValue, Parameters, PlannerInfo};
use mission::{Cause, Fault};
use nalgebra::{Matrix3, Point2};
use planner_api::{
    Boundary, Command, Limits, Motion, Obstacle, Outline, Plan, PlanRequest, PoseEstimate, Reason, Sensed,
    Site, Task, TetherLimits,
};
use planner_host::{BlockingHost, HostConfig, PluginDirs, Reply, WorkerCommand};
use std::path::{Path, PathBuf};
use std::process::Command as Run;
use std::time::Duration;
use tempfile::TempDir;

pub(crate) const GOAL: Point2<f64> = Point2::new(3.0, 4.0);
const TICK_S: f64 = 0.1;

pub(crate) fn worker() -> WorkerCommand {
    WorkerCommand::new(env!("CARGO_BIN_EXE_planner-worker"))
}

/// Budgets that are large enough for a busy machine.
pub(crate) fn config() -> HostConfig {
    HostConfig { worker_command: worker(), ..HostConfig::new(Duration::from_secs(3)) }
}

/// Budgets for tests of planners that are late on purpose.
pub(crate) fn impatient() -> HostConfig {
    HostConfig {
        configure_deadline: Duration::from_millis(150),
        plan_deadline: Duration::from_millis(150),
        step_deadline: Duration::from_millis(150),
        ..config()
    }
}

/// A host for the plugins that were built with this test.
pub(crate) fn host(config: HostConfig) -> BlockingHost {
    BlockingHost::new(&built(), config)
}

/// The folder that contains the plugins built with this test.
pub(crate) fn built() -> PluginDirs {
    let deps = std::env::current_exe().unwrap().parent().unwrap().to_owned();
    PluginDirs::of(vec![deps])
}

pub(crate) fn pose(position: Point2<f64>) -> PoseEstimate {
    PoseEstimate { position, heading_rad: 0.0, covariance: Matrix3::identity() * 1e-4 }
}

pub(crate) fn with_site<R>(call: impl FnOnce(&Site<'_>) -> R) -> R {
    let column = Outline::Disc { center: Point2::new(5.0, 0.0), radius_m: 0.3 };
    let obstacles = [Obstacle {
        id: 1,
        outline: column,
        discovered: false,
        velocity_m_per_s: planner_api::Vector2::zeros(),
    }];
    let limits = Limits {
        motion: Motion::Unicycle,
        v_max_m_per_s: 0.3,
        w_max_rad_per_s: 1.0,
        radius_m: 0.2,
        sensing_range_m: 3.0,
        acceleration_m_per_s2: 0.5,
        tick_s: 0.1,
        amphibious: None,
    };
    let boundary = Boundary::Circle { radius_m: 10.0 };
    call(&Site {
        revision: 0,
        boundary,
        obstacles: &obstacles,
        zones: &[],
        limits,
        swath_m: 0.4,
        clearance_m: 0.1,
        seed: 1,
    })
}

pub(crate) fn words(pairs: &[(&str, &str)]) -> Parameters {
    pairs.iter().map(|(key, word)| ((*key).to_owned(), ParamValue::Word((*word).to_owned()))).collect()
}

pub(crate) fn choose(
    host: &mut BlockingHost,
    id: &str,
    parameters: &Parameters,
) -> Result<PlannerInfo, Fault> {
    with_site(|site| host.choose(id, parameters, site))
}

pub(crate) fn plan(host: &mut BlockingHost) -> Result<Reply<Plan>, Fault> {
    plan_for(host, Task::Goto { goal: GOAL, tolerance_m: 0.1 })
}

/// Requests a plan that covers two triangles with a tethered robot.
pub(crate) fn plan_to_cover(host: &mut BlockingHost) -> Result<Reply<Plan>, Fault> {
    let triangle = [Point2::new(1.0, 0.0), Point2::new(2.0, 0.0), Point2::new(1.0, 1.0)];
    let tether = TetherLimits { reel_length_m: 40.0, wrap_max_rad: 1.5, wrap_total_max_rad: 2.5, pull: None };
    let regions: [&[_]; 2] = [&triangle, &triangle];
    let (anchor, tether) = (Point2::new(0.5, 0.0), Some(tether));
    plan_for(host, Task::Cover { anchor, regions: &regions, tether, tolerance_m: 0.1 })
}

fn plan_for(host: &mut BlockingHost, task: Task<'_>) -> Result<Reply<Plan>, Fault> {
    with_site(|site| {
        let start = pose(Point2::origin());
        host.plan(&PlanRequest::new(&Reason::Start, start, task, site))
    })
}

/// A step from the origin.
pub(crate) fn step(host: &mut BlockingHost, tick: u64) -> Result<Reply<Command>, Fault> {
    step_at(host, tick, pose(Point2::origin()))
}

pub(crate) fn step_at(
    host: &mut BlockingHost,
    tick: u64,
    pose: PoseEstimate,
) -> Result<Reply<Command>, Fault> {
    sensed(tick, |sensed| host.step(&Sensed { pose, ..*sensed }))
}

/// The view of the tick at the origin.
pub(crate) fn sensed<R>(tick: u64, call: impl FnOnce(&Sensed<'_>) -> R) -> R {
    let far = Outline::Disc { center: Point2::new(5.0, 0.0), radius_m: 0.3 };
    let obstacles = [Obstacle {
        id: 1,
        outline: far,
        discovered: false,
        velocity_m_per_s: planner_api::Vector2::zeros(),
    }];
    let at_rest = Sensed::new(tick, TICK_S, pose(Point2::origin()), GOAL);
    call(&Sensed { targets_ahead: &[GOAL], obstacles: &obstacles, ..at_rest })
}

/// Steps until the first fault, ten at most.
pub(crate) fn fly(host: &mut BlockingHost) -> Result<(), Fault> {
    (0..10).try_for_each(|tick| step(host, tick).map(|_| ()))
}

/// Asserts that another planner can take over, whatever happened before.
pub(crate) fn assert_another_drives(host: &mut BlockingHost) {
    choose(host, "faulty", &Parameters::new()).unwrap();
    assert!(plan(host).unwrap().value.complete);
    fly(host).unwrap();
}

pub(crate) fn assert_refused(fault: &Fault, words: &[&str]) {
    assert_eq!(fault.cause, Cause::Refused, "{fault}");
    for word in words {
        assert!(fault.message.contains(word), "`{word}` in: {fault}");
    }
}

pub(crate) fn workspace() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Compiles C into a plugin of this name in a folder.
pub(crate) fn compile(source: &Path, folder: &Path, name: &str, defines: &[&str]) {
    compile_with(source, folder, name, defines, &[]);
}

/// Compiles C and links it with other objects.
pub(crate) fn compile_with(
    source: &Path,
    folder: &Path,
    name: &str,
    defines: &[&str],
    objects: &[&std::ffi::OsStr],
) {
    let include = workspace().join("plugins/planner-api/include");
    let compiled = Run::new("cc")
        .args(["-std=c11", "-O1", "-shared", "-fPIC", "-Wall", "-Wextra", "-Werror", "-pedantic"])
        .args(defines.iter().map(|define| format!("-D{define}")))
        .arg("-I")
        .arg(include)
        .arg("-o")
        .args([&folder.join(format!("libplanner_{name}.so")), source])
        .args(objects)
        .arg("-lm")
        .output()
        .unwrap();
    assert!(compiled.status.success(), "{}", String::from_utf8_lossy(&compiled.stderr));
}

pub(crate) fn direct_c() -> PathBuf {
    workspace().join("plugins/examples/direct-c/direct.c")
}

/// A folder with one plugin compiled from these lines.
pub(crate) fn folder_with(name: &str, source: &str) -> (TempDir, PluginDirs) {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join(format!("{name}.c"));
    std::fs::write(&file, source).unwrap();
    compile(&file, folder.path(), name, &[]);
    let dirs = PluginDirs::of(vec![folder.path().to_owned()]);
    (folder, dirs)
}
