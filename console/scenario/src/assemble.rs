//! Builds a checked scenario from the parsed TOML.

use super::{
    Scenario,
    checks::{Site, cell_m, check_lanes, check_period, check_position_limit, check_pressure, check_ticks},
    expect, floor, inspection, instrument, layout,
    problem::{Complaint, Problem},
    ranging,
    robot::{self, Robot},
    schema,
    section::Section,
    source::Source,
    task, tether, vehicle, wear,
};
use mission::{BetterPlan, Guarantee, Locating, MissionConfig, ScanConfig, Sensor, TaskConfig, TetherConfig};
use planner_api::Limits;
use positioning::Risk;
use sim::{AeConfig, Mover, NoiseModel, PhysicalCable, RobotConfig, SimConfig};
use toml::de::DeTable;
use world::{Boundary, Obstacle, Point, Pose, Station, World};

/// The smallest clearance used when ranges scatter, in metres. A robot locates the shell only from its own estimated
/// position. With 0.05, one of 1,293 robots in random scenarios therefore touched the shell: its 95 % error was 0.047
/// m, but its actual error was 0.063 m.
const LEAST_CLEARANCE_M: f64 = 0.08;

/// Distance, in metres, by which the scanner of a survey must see beyond the room that the hull keeps: the robot drives to
/// places from which it sees new floor, and places closer together than 0.3 m count as one.
const SURVEY_SIGHT_M: f64 = 0.5;

/// Distance, in metres, within which a start counts as being at the first path point.
const ON_PATH_M: f64 = 1e-3;

/// Reads every section and checks that they fit together. Returns the scenario or all problems. `also` runs an
/// additional check.
pub(crate) fn assemble(
    text: &str,
    shown_name: &str,
    table: &DeTable<'_>,
    also: fn(&Source<'_>, &DeTable<'_>),
) -> Result<Scenario, Vec<Problem>> {
    let source = Source::new(text);
    let scenario = read(&Section::root(&source, table, schema::ROOT), text, shown_name);
    also(&source, table);
    let problems = source.into_problems();
    match scenario {
        Some(scenario) if problems.is_empty() => Ok(scenario),
        _ => Err(problems),
    }
}

/// The sections that are used more than once.
struct Sections<'a> {
    root: &'a Section<'a>,
    robot: Option<Section<'a>>,
    ae: Option<Section<'a>>,
    mission: Option<Section<'a>>,
}

/// Everything on the floor and everything that moves there; `None` for parts that could not be read.
struct Floor {
    boundary: Option<Boundary>,
    obstacles: Vec<Obstacle>,
    movers: Vec<Mover>,
    zones: Vec<world::Zone>,
    robot: Option<Robot>,
    stations: Vec<Station>,
    ae: Option<AeConfig>,
    locating: Option<Locating>,
}

fn read(root: &Section<'_>, text: &str, shown_name: &str) -> Option<Scenario> {
    let name = root.slug("name");
    let about = if root.has("about") { root.text("about") } else { Some(String::new()) };
    let seed = root.whole("seed").map(|seed| seed as u64);
    let sections = Sections {
        root,
        robot: root.table_or_empty("robot"),
        ae: root.table("ae"),
        mission: root.table("mission"),
    };
    let mut floor = Floor::read(&sections);
    let radius_m = floor.robot.as_ref().map(|robot| robot.limits.radius_m);
    let put_down = floor.robot.as_ref().and_then(|robot| robot.start);
    let task =
        sections.mission.as_ref().and_then(|s| task::task(s, floor.boundary.as_ref(), radius_m, put_down));
    let is_survey = check_kind(&sections);
    let start = start(floor.robot.as_ref(), task.as_ref());
    scatter(root, &mut floor, seed, start, task.as_ref());
    check_places(&sections, &floor, start, task.as_ref());
    let (tether, physical) = tether_of(&sections, &floor, start, task.as_ref()).unzip();
    let task = task.map(|task| back_to_the_anchor(task, tether.as_ref()));
    let planner = task::planners(root, is_survey);
    let plates = if root.has("plates") { floor::plates(root, floor.boundary.as_ref()) } else { None };
    let wear = wear::wear(root, floor.boundary.as_ref(), seed);
    let checklist = checklist(root);
    let vehicle = vehicle::vehicle(root);
    let expect = expect::expect(root, is_survey);
    let inspection = inspection::section(root);
    let rest = Rest::read(&sections, &floor);
    check_scanner_range(&sections, &floor, rest.as_ref().filter(|_| is_survey));
    let (instrument, channel_faults) =
        instrument::instrument(root, plates.as_ref(), rest.as_ref().map(|rest| rest.cell_m)).unzip();

    let (planner, fallback) = planner?;
    let (robot, rest, start, ae, mut locating) = (floor.robot?, rest?, start?, floor.ae?, floor.locating?);
    protect(&mut locating, rest.scan.guarantee, &sections, &floor.stations);
    let mission = MissionConfig {
        task: task?,
        tether,
        pressure: robot.pressure,
        start,
        start_sigma_m: robot.start_sigma_m,
        tick_s: rest.tick_s,
        time_limit_s: rest.time_limit_s,
        limits: Limits { tick_s: rest.tick_s, ..robot.limits },
        swath_m: rest.swath_m,
        scan: rest.scan,
        clearance_m: kept_clearance_m(rest.clearance_m, &robot, &ae),
        cell_m: rest.cell_m,
        position_limit_m: rest.position_limit_m,
        position_lost_hold_s: rest.position_lost_hold_s,
        stuck_s: rest.stuck_s,
        start_heading_sigma_rad: robot.start_heading_sigma_rad,
        odometry_sigma_per_m: robot.odometry_sigma_per_m(),
        odometry_turn_sigma_per_rad: robot.turn_sigma_per_rad(),
        gyro_sigma_rad_per_s: robot.gyro_sigma_rad_per_s(),
        range_sigma_ratio: ranging::range_sigma_ratio(ae.noise),
        locating,
        planner: planner?,
        fallback,
        // Whether an operator attends depends on the caller, not on the scenario.
        attended: false,
        start_names_plan: false,
        live: false,
        guard_reaction_s: robot.scanner.map(|_| 0.0),
        sensor: sensor(&robot),
        better_plan: rest.better_plan,
        instrument,
    };
    let world = World {
        boundary: floor.boundary?,
        obstacles: floor.obstacles,
        stations: floor.stations,
        zones: floor.zones,
    };
    let sim = SimConfig {
        world,
        robot: truth(&robot, start),
        ae: Some(ae),
        tick_s: rest.tick_s,
        movers: floor.movers,
        tether_anchor: mission.tether.as_ref().map(|tether| tether.anchor),
        reel_length_m: mission.tether.as_ref().map(|tether| tether.limits.reel_length_m),
        physical: physical.flatten(),
        channel_faults: channel_faults.unwrap_or_default(),
    };
    Some(Scenario {
        name: name?,
        about: about?,
        shown_name: shown_name.to_owned(),
        text: text.to_owned(),
        seed: seed?,
        sim,
        mission,
        plates,
        wear,
        vehicle: vehicle?,
        checklist: checklist?,
        expect: expect?,
        inspection: inspection?,
    })
}

fn checklist(root: &Section<'_>) -> Option<Vec<String>> {
    if root.has("checklist") { root.table("checklist")?.texts("items") } else { Some(Vec::new()) }
}

/// Checks what a kind of mission requires and rules out; returns whether it is a survey.
fn check_kind(sections: &Sections<'_>) -> bool {
    require_start(sections);
    let is_survey = is_survey(sections);
    check_continued(sections.root, is_survey);
    require_scanner(sections, is_survey);
    is_survey
}

fn is_survey(sections: &Sections<'_>) -> bool {
    let mission = sections.mission.as_ref();
    mission.is_some_and(|mission| mission.has("kind") && mission.word("kind") == Some("survey"))
}

/// Adds the risk that the guarantee needs. Complains if the stations do not suffice for a protection level.
fn protect(locating: &mut Locating, guarantee: Guarantee, sections: &Sections<'_>, stations: &[Station]) {
    // A guarantee by the protection level needs one, even if the scenario leaves the risk to its defaults.
    let needed = (guarantee == Guarantee::Protection).then(Risk::default);
    locating.risk = locating.risk.or(needed);
    if let Some(section) = &sections.ae {
        ranging::check_protection(section, locating, stations);
    }
}

fn sensor(robot: &Robot) -> Option<Sensor> {
    let scanner = robot.scanner.as_ref()?;
    Some(Sensor { locates: robot.scanner_locates, ..Sensor::of(scanner) })
}

/// Checks the digests of the runs that a re-scan continues. Only reports use these digests.
fn check_continued(root: &Section<'_>, is_survey: bool) {
    if is_survey {
        root.refuse(
            &["continues_sha256"],
            "mission.kind = \"survey\", because only a re-scan continues runs",
        );
    }
    let digests = if root.has("continues_sha256") { root.texts("continues_sha256") } else { None };
    let is_digest = |text: &String| {
        text.len() == 64 && text.bytes().all(|byte| matches!(byte, b'0'..=b'9' | b'a'..=b'f'))
    };
    if digests.is_some_and(|digests| !digests.iter().all(is_digest)) {
        let wanted = "SHA-256 of journals, 64 hexadecimal digits each, as written by `tankops rescan`";
        root.complain("continues_sha256", Complaint::OutOfRange(wanted.to_owned()));
    }
}

impl Floor {
    fn read(sections: &Sections<'_>) -> Self {
        let boundary = floor::tank(sections.root);
        let ae = sections.ae.as_ref();
        let (obstacles, movers) = floor::obstacles(sections.root, boundary.as_ref());
        let stations = ae.map(|section| ranging::stations(section, boundary.as_ref())).unwrap_or_default();
        let mut heard = ae.and_then(ranging::ae);
        if let (Some(section), Some(heard)) = (ae, &mut heard) {
            heard.disturbances.faults = ranging::faults(section, &stations);
        }
        let locating =
            ae.zip(heard.as_ref()).and_then(|(section, heard)| ranging::locating(section, heard, &stations));
        Self {
            obstacles,
            movers,
            zones: floor::zones(sections.root),
            robot: sections.robot.as_ref().and_then(robot::robot),
            stations,
            locating,
            ae: heard,
            boundary,
        }
    }
}

/// Complains if the start is missing from a mission that does not determine it itself.
fn require_start(sections: &Sections<'_>) {
    let (Some(mission), Some(robot)) = (&sections.mission, &sections.robot) else { return };
    if mission.has("kind")
        && matches!(mission.word("kind"), Some("goto" | "cover" | "survey"))
        && !robot.has("start_m")
    {
        robot.require("start_m", "add start_m = [x, y] to [robot]: the place where the robot is put down");
    }
}

/// Complains if a survey has no scanner to make its map with.
fn require_scanner(sections: &Sections<'_>, is_survey: bool) {
    if let Some(robot) = sections.robot.as_ref().filter(|_| is_survey) {
        robot.require(
            "scanner",
            "add a section [robot.scanner]: a survey makes its map from the scans of a scanner",
        );
    }
}

/// Complains about a scanner that sees hardly farther than the room that the hull keeps: a survey would not progress.
fn check_scanner_range(sections: &Sections<'_>, floor: &Floor, rest: Option<&Rest>) {
    let (Some(section), Some(robot), Some(rest)) = (&sections.robot, &floor.robot, rest) else { return };
    let Some(scanner) = &robot.scanner else { return };
    let least_m = robot.limits.radius_m + rest.clearance_m + SURVEY_SIGHT_M;
    if scanner.range_m < least_m {
        let must_be = format!(
            "a scanner with range_m = {least_m:.3} or more in a survey (now {}): radius_m + clearance_m + \
             {SURVEY_SIGHT_M} m, so that the robot sees floor beyond the room of its hull",
            scanner.range_m
        );
        section.complain("scanner", Complaint::OutOfRange(must_be));
    }
}

/// The pose at the start: as given, or at the beginning of the path and in its direction.
fn start(robot: Option<&Robot>, task: Option<&TaskConfig>) -> Option<Pose> {
    let (robot, task) = (robot?, task?);
    let (position, ahead) = match (robot.start, task) {
        (Some(start), TaskConfig::Goto { goal, .. }) => (start, *goal - start),
        (Some(start), TaskConfig::Cover { .. } | TaskConfig::Survey { .. }) => {
            (start, world::Vector::zeros())
        }
        (None, TaskConfig::Goto { .. } | TaskConfig::Cover { .. } | TaskConfig::Survey { .. }) => {
            return None;
        }
        (start, TaskConfig::Follow { path, .. }) => {
            let (first, second) = (*path.first()?, *path.get(1)?);
            let position = start.unwrap_or(first);
            let is_on_path = (position - first).norm() < ON_PATH_M;
            (position, if is_on_path { second - first } else { first - position })
        }
    };
    let along = if ahead.norm() > 0.0 { ahead.y.atan2(ahead.x) } else { 0.0 };
    Some(Pose { position, heading_rad: robot.start_heading_rad.unwrap_or(along) })
}

/// The clearance to keep. Without one, a robot that only estimates its position would touch objects as it passes them.
fn kept_clearance_m(clearance_m: f64, robot: &Robot, ae: &AeConfig) -> f64 {
    let is_exact = robot.limits.radius_m == 0.0 || ae.noise == NoiseModel::None;
    if is_exact { clearance_m } else { clearance_m.max(LEAST_CLEARANCE_M) }
}

/// The end point of the mission.
fn end_of(task: &TaskConfig) -> Option<Point> {
    match task {
        TaskConfig::Goto { goal, .. } => Some(*goal),
        TaskConfig::Follow { path, .. } => path.last().copied(),
        TaskConfig::Cover { anchor, .. } | TaskConfig::Survey { anchor, .. } => Some(*anchor),
    }
}

/// Adds the random obstacles to the floor.
fn scatter(
    root: &Section<'_>,
    floor: &mut Floor,
    seed: Option<u64>,
    start: Option<Pose>,
    task: Option<&TaskConfig>,
) {
    if !root.has("random_obstacles") {
        return;
    }
    let Some(section) = root.table("random_obstacles") else { return };
    let random = layout::random_obstacles(&section, seed);
    let (Some(random), Some(boundary)) = (random, &floor.boundary) else { return };
    let free: Vec<Point> = start.map(|pose| pose.position).into_iter().chain(task.and_then(end_of)).collect();
    let placed = random.place(boundary, &free, &mut floor.obstacles);
    if placed < random.count {
        section.complain("count", Complaint::NoRoom { placed });
    }
}

fn check_places(sections: &Sections<'_>, floor: &Floor, start: Option<Pose>, task: Option<&TaskConfig>) {
    let (Some(boundary), Some(robot)) = (&floor.boundary, &floor.robot) else { return };
    let radius_m = robot.limits.radius_m;
    let site = Site { boundary, obstacles: &floor.obstacles, zones: &floor.zones, radius_m };
    let complain = |section: &Option<Section<'_>>, name: &str, what: Option<Complaint>| {
        if let (Some(section), Some(what)) = (section, what) {
            section.complain(name, what);
        }
    };
    if let Some(Pose { position, .. }) = start {
        let is_chosen = sections.robot.as_ref().is_some_and(|robot| robot.has("start_m"));
        let too_near = || site.objection_to_start(position).filter(|_| is_chosen);
        complain(&sections.robot, "start_m", site.objection(position).or_else(too_near));
    }
    if let Some(TaskConfig::Goto { goal, .. }) = task {
        complain(&sections.mission, "goal_m", site.objection(*goal));
    }
}

/// The tether, if there is one. Complains about an impossible tether.
fn tether_of(
    sections: &Sections<'_>,
    floor: &Floor,
    start: Option<Pose>,
    task: Option<&TaskConfig>,
) -> Option<(TetherConfig, Option<PhysicalCable>)> {
    if !sections.root.has("tether") {
        return None;
    }
    let section = sections.root.table("tether")?;
    let start = start.map(|pose| pose.position);
    let tether = tether::tether(&section, start)?;
    if let Some(robot) = &floor.robot {
        tether::check_speed(&section, robot.limits.v_max_m_per_s);
    }
    let v_max_m_per_s = floor.robot.as_ref().map_or(0.0, |robot| robot.limits.v_max_m_per_s);
    let physical = tether::physical(&section, &tether, v_max_m_per_s);
    let Some(boundary) = &floor.boundary else { return Some((tether, physical)) };
    let site = Site { boundary, obstacles: &floor.obstacles, zones: &[], radius_m: 0.0 };
    if let Some(start) = start {
        tether::check(&section, &tether, &site, start);
    }
    let clearance_m = sections.mission.as_ref().and_then(|mission| mission.number("clearance_m"));
    if let (
        Some(TaskConfig::Cover { tolerance_m, .. } | TaskConfig::Survey { tolerance_m, .. }),
        Some(robot),
        Some(clearance_m),
    ) = (task, &floor.robot, clearance_m)
    {
        let site = Site { radius_m: robot.limits.radius_m, ..site };
        // Without anchor_m, the anchor is the robot's start.
        let place = sections.robot.as_ref().filter(|_| !section.has("anchor_m"));
        let place = place.map_or((&section, "anchor_m"), |robot| (robot, "start_m"));
        tether::check_room(place, &tether, &site, (clearance_m, *tolerance_m));
    }
    Some((tether, physical))
}

/// A robot that scans the floor on a tether returns to the anchor.
fn back_to_the_anchor(task: TaskConfig, tether: Option<&TetherConfig>) -> TaskConfig {
    match (task, tether) {
        (TaskConfig::Cover { regions, tolerance_m, .. }, Some(tether)) => {
            TaskConfig::Cover { anchor: tether.anchor, regions, tolerance_m }
        }
        (TaskConfig::Survey { tolerance_m, .. }, Some(tether)) => {
            TaskConfig::Survey { anchor: tether.anchor, tolerance_m }
        }
        (task, _) => task,
    }
}

/// The keys of `[mission]` that are independent of the task.
struct Rest {
    tick_s: f64,
    time_limit_s: f64,
    swath_m: f64,
    scan: ScanConfig,
    clearance_m: f64,
    cell_m: f64,
    position_limit_m: f64,
    position_lost_hold_s: f64,
    stuck_s: f64,
    better_plan: BetterPlan,
}

impl Rest {
    fn read(sections: &Sections<'_>, floor: &Floor) -> Option<Self> {
        let mission = sections.mission.as_ref()?;
        let (tick, limit) = (mission.number("tick_s"), mission.number("time_limit_s"));
        if let (Some(tick_s), Some(time_limit_s)) = (tick, limit) {
            check_ticks(mission, tick_s, time_limit_s);
        }
        if let (Some(tick_s), Some(section), Some(ae)) = (tick, &sections.ae, &floor.ae) {
            check_period(section, tick_s, ae.period_s);
        }
        if let (Some(tick_s), Some(section), Some(robot)) = (tick, &sections.robot, &floor.robot) {
            check_pressure(section, tick_s, robot.pressure);
        }
        let cell_m = cell_m(mission, floor.boundary.as_ref());
        let (swath_m, clearance_m) = (mission.number("swath_m"), mission.number("clearance_m"));
        let position_limit_m = mission.number("position_limit_m");
        if let (Some(boundary), Some(limit_m)) = (&floor.boundary, position_limit_m) {
            check_position_limit(mission, boundary, limit_m);
        }
        let scan = scan(mission, swath_m);
        if let (Some(boundary), Some(swath_m), Some(scan), Some("cover")) =
            (&floor.boundary, swath_m, &scan, mission.word("kind"))
        {
            check_lanes(mission, boundary, swath_m, scan.overlap_m);
        }
        let (position_lost_hold_s, stuck_s) =
            (mission.number("position_lost_hold_s"), mission.number("stuck_s"));
        Some(Self {
            tick_s: tick?,
            time_limit_s: limit?,
            swath_m: swath_m?,
            scan: scan?,
            clearance_m: clearance_m?,
            cell_m: cell_m?,
            position_limit_m: position_limit_m?,
            position_lost_hold_s: position_lost_hold_s?,
            stuck_s: stuck_s?,
            better_plan: better_plan(mission.word("better_plan")?),
        })
    }
}

fn better_plan(word: &str) -> BetterPlan {
    match word {
        "take" => BetterPlan::Take,
        "off" => BetterPlan::Off,
        _ => BetterPlan::Offer,
    }
}

/// The conditions for floor to count as scanned; the overlap must be less than the swath.
fn scan(mission: &Section<'_>, swath_m: Option<f64>) -> Option<ScanConfig> {
    let (overlap_m, limit_m) = (mission.number("overlap_m"), mission.number("scan_position_limit_m"));
    let (overlap_m, swath_m) = (overlap_m?, swath_m?);
    if overlap_m >= swath_m {
        mission.complain("overlap_m", Complaint::OutOfRange(format!("less than swath_m, {swath_m} m")));
        return None;
    }
    if mission.has("scan_position_limit_m") && limit_m.is_none() {
        return None;
    }
    let guarantee = match mission.word("guarantee")? {
        "protection" => Guarantee::Protection,
        _ => Guarantee::Ellipse,
    };
    Some(ScanConfig { overlap_m, position_limit_m: limit_m, guarantee })
}

fn truth(robot: &Robot, start: Pose) -> RobotConfig {
    RobotConfig {
        start,
        radius_m: robot.limits.radius_m,
        v_max_m_per_s: robot.limits.v_max_m_per_s,
        w_max_rad_per_s: robot.limits.w_max_rad_per_s,
        acceleration_m_per_s2: robot.limits.acceleration_m_per_s2,
        sensing_range_m: robot.limits.sensing_range_m,
        slip_mean: robot.slip_mean,
        slip_sigma: robot.slip_sigma,
        odometry_sigma_ratio: robot.odometry_sigma_ratio,
        gyro_bias_rad_per_s: robot.gyro_bias_rad_per_s,
        amphibious: robot.limits.amphibious,
        pressure: robot.pressure,
        scanner: robot.scanner,
    }
}
