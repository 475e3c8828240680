#![allow(clippy::unwrap_used, clippy::borrow_as_ptr, clippy::float_cmp, reason = "tests")]

use super::*;
use crate::abi::lend::{self, PlanParts};
use crate::abi::{Draw, Entry, Host, Param, PlanOut, StepOut, Vec2};
use crate::{Boundary, Limits, Obstacle, Zone, ZoneKind, choice, float};
use crate::{
    Caps, Command, Layer, Leg, LegTag, Motion, Outline, Plan, PlanRequest, PoseEstimate, Reason, Sensed,
    Site, Task, TetherLimits, TetherPull,
};
use nalgebra::{Matrix3, Point2, Vector2};

/// Records how it was created, and does what its parameter `act` says.
struct Probe {
    act: &'static str,
    gain: f64,
    seen: String,
}

impl Drop for Probe {
    fn drop(&mut self) {
        assert!(self.act != "drop", "dropped with a bang");
    }
}

impl Planner for Probe {
    const ID: &'static str = "probe";
    const NAME: &'static str = "Probe";
    const CAPS: Caps = Caps::LOCAL;
    const PARAMS: &'static [ParamSpec] = &[
        float("gain", "Gain", "1/s", 0.0, 2.0, 0.5).live(),
        choice("act", "Act", &["well", "panic", "refuse", "drop", "partial", "panic elsewhere"], 0),
    ];

    fn configure(config: &Config<'_>, site: &Site<'_>, _: &Ctx<'_>) -> Result<Self> {
        let seen = format!("{site:?}");
        Ok(Self { act: config.choice("act"), gain: config.float("gain"), seen })
    }

    fn reconfigure(&mut self, config: &Config<'_>, _: &Ctx<'_>) -> Result<()> {
        self.gain = config.float("gain");
        Ok(())
    }

    fn plan(&mut self, request: &PlanRequest<'_>, ctx: &Ctx<'_>) -> Result<Plan> {
        let path = vec![request.start.position, Point2::new(9.0, 9.0)];
        if self.act == "partial" {
            return Err(PlannerError::no_path_but("walled in", path));
        }
        ctx.progress(0.25, "candidate 1 of 4");
        ctx.log(crate::LogLevel::Info, &format!("{request:?}"));
        let legs = vec![Leg { tag: LegTag::Swath, first: 0, last: 1 }];
        Ok(Plan {
            path,
            cost: 3.5,
            complete: true,
            legs,
            cuts: vec![CORNERS.to_vec(), CORNERS[..2].to_vec()],
        })
    }

    fn step(&mut self, sensed: &Sensed<'_>, ctx: &Ctx<'_>) -> Result<Command> {
        match self.act {
            "panic" => panic!("no such thing"),
            "panic elsewhere" => std::thread::scope(|scope| {
                let elsewhere = scope.spawn(|| on_own_thread(|| panic!("no such item")));
                elsewhere.join().unwrap()
            }),
            "refuse" => Err(PlannerError::new(Code::Stuck, "a local minimum")),
            _ => {
                ctx.check()?;
                ctx.arrow(Layer::Repulsion, sensed.target, Vector2::new(self.gain, 0.0));
                ctx.scalar("near", sensed.obstacles.len() as f64, "1");
                ctx.log(crate::LogLevel::Warn, &format!("{sensed:?}"));
                Ok(Command::velocity(Vector2::new(self.gain, -1.0)))
            }
        }
    }

    fn stopping(&mut self, _: &Ctx<'_>) -> Stopping {
        Stopping::NeedsSteps
    }

    fn snapshot(&self) -> Result<Vec<u8>> {
        Ok(self.seen.as_bytes()[..4].to_vec())
    }

    fn restore(&mut self, version: u32, state: &[u8]) -> Result<()> {
        self.seen = format!("{version} {state:?}");
        Ok(())
    }
}

/// What the console collects during a call.
#[derive(Default)]
struct Sink {
    error: String,
    logs: Vec<String>,
    keys: Vec<String>,
    points: Vec<Vec2>,
    legs: Vec<abi::Leg>,
    cuts: Vec<usize>,
    draws: Vec<Draw>,
    scalars: Vec<(String, f64)>,
    progress: Vec<(f64, String)>,
    bytes: Vec<u8>,
}

unsafe fn sink<'a>(ctx: *mut c_void) -> &'a mut Sink {
    unsafe { &mut *ctx.cast() }
}

unsafe fn text(ptr: *const u8, len: usize) -> String {
    unsafe { Str { ptr, len }.to_text(4096) }
}

unsafe extern "C" fn stop(_: *mut c_void) -> u32 {
    0
}
unsafe extern "C" fn time_left(_: *mut c_void) -> f64 {
    1.5
}
unsafe extern "C" fn error(ctx: *mut c_void, ptr: *const u8, len: usize) {
    unsafe { sink(ctx).error = text(ptr, len) }
}
unsafe extern "C" fn log(ctx: *mut c_void, _: u32, ptr: *const u8, len: usize) {
    unsafe { sink(ctx).logs.push(text(ptr, len)) }
}
unsafe extern "C" fn param(ctx: *mut c_void, param: *const Param) {
    unsafe { sink(ctx).keys.push(format!("{}={}", (*param).key.to_text(99), (*param).options.to_text(99))) }
}
unsafe extern "C" fn points(ctx: *mut c_void, ptr: *const Vec2, n: usize) {
    unsafe { sink(ctx).points.extend_from_slice(abi::slice(ptr, n)) }
}
unsafe extern "C" fn legs(ctx: *mut c_void, ptr: *const abi::Leg, n: usize) {
    unsafe { sink(ctx).legs.extend_from_slice(abi::slice(ptr, n)) }
}
unsafe extern "C" fn cut(ctx: *mut c_void, _: *const Vec2, n: usize) {
    unsafe { sink(ctx).cuts.push(n) }
}
unsafe extern "C" fn draw(ctx: *mut c_void, ptr: *const Draw, n: usize) {
    unsafe { sink(ctx).draws.extend_from_slice(abi::slice(ptr, n)) }
}
unsafe extern "C" fn scalar(ctx: *mut c_void, name: Str, value: f64, _: Str) {
    unsafe { sink(ctx).scalars.push((name.to_text(99), value)) }
}
unsafe extern "C" fn progress(ctx: *mut c_void, share: f64, ptr: *const u8, len: usize) {
    unsafe { sink(ctx).progress.push((share, text(ptr, len))) }
}
unsafe extern "C" fn bytes(ctx: *mut c_void, ptr: *const u8, n: usize) {
    unsafe { sink(ctx).bytes.extend_from_slice(abi::slice(ptr, n)) }
}

fn host(sink: &mut Sink) -> Host {
    Host {
        size: size_of::<Host>() as u32,
        abi_minor: 0,
        ctx: (&raw mut *sink).cast(),
        should_stop: Some(stop),
        time_left_s: Some(time_left),
        wants_drawing: Some(stop),
        error: Some(error),
        log: Some(log),
        param: Some(param),
        points: Some(points),
        draw: Some(draw),
        scalar: Some(scalar),
        bytes: Some(bytes),
        legs: Some(legs),
        cut: Some(cut),
        progress: Some(progress),
    }
}

const CORNERS: [Point2<f64>; 3] = [Point2::new(0.0, 0.0), Point2::new(1.0, 0.0), Point2::new(0.0, 1.0)];

fn obstacles() -> [Obstacle<'static>; 3] {
    let disc = Outline::Disc { center: Point2::new(1.0, 2.0), radius_m: 0.5 };
    let line = Outline::Polyline { points: &CORNERS, half_width_m: 0.1 };
    [
        Obstacle { id: 7, outline: disc, discovered: true, velocity_m_per_s: Vector2::new(0.5, -0.25) },
        Obstacle {
            id: 8,
            outline: Outline::Polygon { vertices: &CORNERS },
            discovered: false,
            velocity_m_per_s: Vector2::zeros(),
        },
        Obstacle { id: 9, outline: line, discovered: false, velocity_m_per_s: Vector2::zeros() },
    ]
}

fn site<'a>(obstacles: &'a [Obstacle<'a>], zones: &'a [Zone<'a>]) -> Site<'a> {
    let limits = Limits {
        motion: Motion::Unicycle,
        v_max_m_per_s: 0.3,
        w_max_rad_per_s: 1.0,
        radius_m: 0.25,
        sensing_range_m: 2.0,
        acceleration_m_per_s2: 0.5,
        tick_s: 0.1,
        amphibious: None,
    };
    let boundary = Boundary::Circle { radius_m: 10.0 };
    Site { revision: 3, boundary, obstacles, zones, limits, swath_m: 0.4, clearance_m: 0.1, seed: 42 }
}

fn pose() -> PoseEstimate {
    let covariance = Matrix3::new(1.0, 2.0, 3.0, 2.0, 4.0, 5.0, 3.0, 5.0, 6.0);
    PoseEstimate { position: Point2::new(0.5, -0.5), heading_rad: 0.1, covariance }
}

fn zones() -> [Zone<'static>; 1] {
    [Zone { kind: ZoneKind::Underwater, outline: Outline::Polygon { vertices: &CORNERS } }]
}

/// An instance, created through the table, that behaves as `act` says.
fn instance(sink: &mut Sink, act: f64) -> *mut c_void {
    let (obstacles, zones) = (obstacles(), zones());
    let site = site(&obstacles, &zones);
    let (lent_obstacles, lent_zones) = (lend::obstacles(site.obstacles), lend::zones(site.zones));
    let raw = lend::site(&site, &lent_obstacles, &lent_zones);
    let values = [abi::Value { key: Str::of("act"), number: act }];
    let mut made = std::ptr::null_mut();
    let code = unsafe { create::<Probe>(&host(sink), &raw, values.as_ptr(), 1, &mut made) };
    assert_eq!((code, made.is_null()), (0, false));
    made
}

fn sensed<'a>(obstacles: &'a [Obstacle<'a>]) -> Sensed<'a> {
    Sensed {
        tick: 12,
        t_s: 1.2,
        dt_s: 0.1,
        pose: pose(),
        v_m_per_s: 0.2,
        w_rad_per_s: -0.1,
        target: Point2::new(3.0, 4.0),
        targets_ahead: &CORNERS,
        path_ahead: &CORNERS[1..],
        obstacles,
    }
}

fn do_step(sink: &mut Sink, planner: *mut c_void, sensed: &Sensed<'_>) -> (i32, StepOut) {
    let lent = lend::obstacles(sensed.obstacles);
    let mut out = StepOut::UNSET;
    let code = unsafe { step::<Probe>(planner, &host(sink), &lend::step(sensed, &lent), &mut out) };
    (code, out)
}

#[test]
fn parameters_are_declared_with_their_words() {
    let mut sink = Sink::default();
    assert_eq!(unsafe { describe::<Probe>(&host(&mut sink)) }, 0);
    assert_eq!(sink.keys, ["gain=", "act=well|panic|refuse|drop|partial|panic elsewhere"]);
}

#[test]
fn a_planner_sees_the_site_as_the_console_has_it() {
    let mut sink = Sink::default();
    let planner = instance(&mut sink, 0.0);
    let (obstacles, zones) = (obstacles(), zones());
    let slot = unsafe { &*planner.cast::<Slot<Probe>>() };
    assert_eq!(slot.planner.seen, format!("{:?}", site(&obstacles, &zones)));
    unsafe { destroy::<Probe>(planner) };
}

#[test]
fn a_planner_sees_what_is_sensed_and_its_answer_comes_back() {
    let mut sink = Sink::default();
    let planner = instance(&mut sink, 0.0);
    let obstacles = obstacles();
    let sensed = sensed(&obstacles);
    let (code, out) = do_step(&mut sink, planner, &sensed);
    assert_eq!((code, out.get()), (0, Ok(Command::velocity(Vector2::new(0.5, -1.0)))));
    assert_eq!(sink.logs, [format!("{sensed:?}")]);
    assert_eq!(sink.scalars, [("near".to_owned(), 3.0)]);
    let arrow =
        crate::Drawing::Arrow { layer: Layer::Repulsion, at: sensed.target, vector: Vector2::new(0.5, 0.0) };
    assert_eq!(sink.draws[0].get(), Some(arrow));
    unsafe { destroy::<Probe>(planner) };
}

#[test]
fn a_request_for_a_plan_arrives_whole() {
    let mut sink = Sink::default();
    let planner = instance(&mut sink, 0.0);
    let (obstacles, zones) = (obstacles(), zones());
    let site = site(&obstacles, &zones);
    let (lent, lent_zones) = (lend::obstacles(&obstacles), lend::zones(&zones));
    let raw = lend::site(&site, &lent, &lent_zones);
    let reason = Reason::Swap { from: "apf".to_owned() };
    let task = Task::Follow { targets: &CORNERS, tolerance_m: 0.2 };
    let request = PlanRequest {
        reason: &reason,
        start: pose(),
        task,
        site: &site,
        previous: &CORNERS[..1],
        under_way: None,
    };
    let mut out = PlanOut::UNSET;
    let code = unsafe {
        plan::<Probe>(
            planner,
            &host(&mut sink),
            &lend::plan(&request, &raw, &PlanParts::of(&request)),
            &mut out,
        )
    };
    assert_eq!((code, out.complete, out.cost), (0, 1, 3.5));
    assert_eq!(sink.points, [Vec2 { x: 0.5, y: -0.5 }, Vec2 { x: 9.0, y: 9.0 }]);
    assert_eq!(sink.legs, [abi::Leg { tag: 0, first: 0, last: 1, reserved: 0 }]);
    assert_eq!(sink.cuts, [3, 2]);
    assert_eq!(sink.progress, [(0.25, "candidate 1 of 4".to_owned())]);
    assert_eq!(sink.logs, [format!("{request:?}")]);
    unsafe { destroy::<Probe>(planner) };
}

#[test]
fn a_request_to_cover_arrives_with_its_regions_and_the_limits_of_the_tether() {
    let mut sink = Sink::default();
    let planner = instance(&mut sink, 0.0);
    let site = site(&[], &[]);
    let raw = lend::site(&site, &[], &[]);
    let tethers = [
        None,
        Some(TetherLimits {
            reel_length_m: 40.0,
            wrap_max_rad: 1.5,
            wrap_total_max_rad: f64::INFINITY,
            pull: Some(TetherPull { floor_n_per_m: 0.3, friction: 0.2, reel_n: 6.0, preferred_n: 4.8 }),
        }),
    ];
    for (tether, regions) in tethers.into_iter().zip([&[] as &[&[_]], &[&CORNERS, &CORNERS[1..]]]) {
        let task = Task::Cover { anchor: CORNERS[1], regions, tether, tolerance_m: 0.2 };
        let request = PlanRequest::new(&Reason::Start, pose(), task, &site);
        let parts = PlanParts::of(&request);
        let input = lend::plan(&request, &raw, &parts);
        let code = unsafe { plan::<Probe>(planner, &host(&mut sink), &input, &mut { PlanOut::UNSET }) };
        assert_eq!((code, sink.logs.pop()), (0, Some(format!("{request:?}"))));
    }
    unsafe { destroy::<Probe>(planner) };
}

#[test]
fn a_plan_to_keep_to_arrives_whole_and_not_from_an_older_console() {
    let mut sink = Sink::default();
    let planner = instance(&mut sink, 0.0);
    let site = site(&[], &[]);
    let raw = lend::site(&site, &[], &[]);
    let task = Task::Cover { anchor: CORNERS[1], regions: &[], tether: None, tolerance_m: 0.2 };
    let legs =
        vec![Leg { tag: LegTag::Travel, first: 0, last: 1 }, Leg { tag: LegTag::Swath, first: 1, last: 2 }];
    let cuts = vec![CORNERS.to_vec(), CORNERS[..2].to_vec()];
    let way = Plan { path: CORNERS.to_vec(), legs, cuts, complete: true, cost: 0.0 };
    let reason = Reason::MapChanged;
    let request = PlanRequest {
        reason: &reason,
        start: pose(),
        task,
        site: &site,
        previous: &[],
        under_way: Some(&way),
    };
    let parts = PlanParts::of(&request);
    let input = lend::plan(&request, &raw, &parts);
    let older = abi::PlanIn { size: std::mem::offset_of!(abi::PlanIn, way) as u32, ..input };
    for (input, seen) in [(input, request), (older, PlanRequest { under_way: None, ..request })] {
        let code = unsafe { plan::<Probe>(planner, &host(&mut sink), &input, &mut { PlanOut::UNSET }) };
        assert_eq!((code, sink.logs.pop()), (0, Some(format!("{seen:?}"))));
    }
    unsafe { destroy::<Probe>(planner) };
}

#[test]
fn a_region_that_is_no_polygon_is_refused() {
    let mut sink = Sink::default();
    let planner = instance(&mut sink, 0.0);
    let site = site(&[], &[]);
    let raw = lend::site(&site, &[], &[]);
    let task = Task::Cover { anchor: CORNERS[1], regions: &[&CORNERS], tether: None, tolerance_m: 0.2 };
    let request = PlanRequest::new(&Reason::Start, pose(), task, &site);
    let parts = PlanParts::of(&request);
    let mut input = lend::plan(&request, &raw, &parts);
    let line = abi::Outline { kind: abi::input::OUTLINE_POLYLINE, ..unsafe { *input.regions } };
    input.regions = &raw const line;
    let code = unsafe { plan::<Probe>(planner, &host(&mut sink), &input, &mut { PlanOut::UNSET }) };
    assert_eq!((code, sink.error.contains("not a polygon")), (Code::Invalid as i32, true));
    unsafe { destroy::<Probe>(planner) };
}

#[test]
fn a_console_of_version_1_0_gets_a_plan_without_legs_and_cuts() {
    let mut sink = Sink::default();
    let planner = instance(&mut sink, 0.0);
    let site = site(&[], &[]);
    let raw = lend::site(&site, &[], &[]);
    let task = Task::Goto { goal: CORNERS[1], tolerance_m: 0.2 };
    let request = PlanRequest::new(&Reason::Start, pose(), task, &site);
    let older = Host { size: std::mem::offset_of!(Host, legs) as u32, ..host(&mut sink) };
    let parts = PlanParts::of(&request);
    let size = std::mem::offset_of!(abi::PlanIn, regions) as u32;
    let input = abi::PlanIn { size, ..lend::plan(&request, &raw, &parts) };
    let code = unsafe { plan::<Probe>(planner, &older, &input, &mut { PlanOut::UNSET }) };
    assert_eq!((code, sink.points.len(), sink.legs.len(), sink.cuts.len()), (0, 2, 0, 0));
    assert_eq!(sink.logs, [format!("{request:?}")]);
    unsafe { destroy::<Probe>(planner) };
}

#[test]
fn a_console_of_version_1_1_gets_the_same_plan_and_no_progress() {
    let mut sink = Sink::default();
    let planner = instance(&mut sink, 0.0);
    let site = site(&[], &[]);
    let raw = lend::site(&site, &[], &[]);
    let task = Task::Goto { goal: CORNERS[1], tolerance_m: 0.2 };
    let request = PlanRequest::new(&Reason::Start, pose(), task, &site);
    let older = Host { size: std::mem::offset_of!(Host, progress) as u32, ..host(&mut sink) };
    let parts = PlanParts::of(&request);
    let input = lend::plan(&request, &raw, &parts);
    let code = unsafe { plan::<Probe>(planner, &older, &input, &mut { PlanOut::UNSET }) };
    assert_eq!((code, sink.points.len(), sink.legs.len(), sink.cuts.len()), (0, 2, 1, 2));
    assert_eq!(sink.progress, []);
    unsafe { destroy::<Probe>(planner) };
}

#[test]
fn a_plan_that_got_part_of_the_way_hands_that_part_over() {
    let mut sink = Sink::default();
    let planner = instance(&mut sink, 4.0);
    let site = site(&[], &[]);
    let task = Task::Goto { goal: CORNERS[1], tolerance_m: 0.2 };
    let request = PlanRequest::new(&Reason::Start, pose(), task, &site);
    let raw = lend::site(&site, &[], &[]);
    let mut out = PlanOut::UNSET;
    let code = unsafe {
        plan::<Probe>(
            planner,
            &host(&mut sink),
            &lend::plan(&request, &raw, &PlanParts::of(&request)),
            &mut out,
        )
    };
    assert_eq!((code, sink.error.as_str(), sink.points.len()), (Code::NoPath as i32, "walled in", 2));
    unsafe { destroy::<Probe>(planner) };
}

#[test]
fn a_panic_on_a_thread_of_the_planner_is_reported_with_its_place_too() {
    let mut sink = Sink::default();
    let planner = instance(&mut sink, 5.0);
    assert_eq!(do_step(&mut sink, planner, &sensed(&[])).0, Code::Panic as i32);
    assert!(
        sink.error.contains("glue/tests.rs:") && sink.error.ends_with(": no such item"),
        "{}",
        sink.error
    );
    assert_eq!(do_step(&mut sink, planner, &sensed(&[])).0, Code::Poisoned as i32);
    unsafe { destroy::<Probe>(planner) };
}

#[test]
fn a_panic_is_reported_with_its_place_and_poisons_the_instance() {
    let mut sink = Sink::default();
    let planner = instance(&mut sink, 1.0);
    let (code, out) = do_step(&mut sink, planner, &sensed(&[]));
    assert_eq!((code, out.get()), (Code::Panic as i32, Err("gave no command".to_owned())));
    assert!(
        sink.error.contains("glue/tests.rs:") && sink.error.ends_with(": no such thing"),
        "{}",
        sink.error
    );
    assert_eq!(do_step(&mut sink, planner, &sensed(&[])).0, Code::Poisoned as i32);
    unsafe { destroy::<Probe>(planner) };
}

#[test]
fn a_refusal_carries_code_and_sentence_and_poisons_nothing() {
    let mut sink = Sink::default();
    let planner = instance(&mut sink, 2.0);
    for _ in 0..2 {
        assert_eq!(do_step(&mut sink, planner, &sensed(&[])).0, Code::Stuck as i32);
        assert_eq!(sink.error, "a local minimum");
    }
    unsafe { destroy::<Probe>(planner) };
}

#[test]
fn a_drop_that_panics_is_survived() {
    let planner = instance(&mut Sink::default(), 3.0);
    unsafe { destroy::<Probe>(planner) };
}

#[test]
fn live_values_stopping_and_state_go_through_the_table() {
    let mut sink = Sink::default();
    let planner = instance(&mut sink, 0.0);
    let values = [abi::Value { key: Str::of("gain"), number: 2.0 }];
    assert_eq!(unsafe { reconfigure::<Probe>(planner, &host(&mut sink), values.as_ptr(), 1) }, 0);
    assert_eq!(do_step(&mut sink, planner, &sensed(&[])).1.a, 2.0);
    assert_eq!(unsafe { stopping::<Probe>(planner, &host(&mut sink)) }, 1);
    assert_eq!(unsafe { snapshot::<Probe>(planner, &host(&mut sink)) }, 0);
    assert_eq!(sink.bytes, b"Site");
    assert_eq!(unsafe { restore::<Probe>(planner, &host(&mut sink), 7, [1, 2].as_ptr(), 2) }, 0);
    assert_eq!(unsafe { &*planner.cast::<Slot<Probe>>() }.planner.seen, "7 [1, 2]");
    unsafe { destroy::<Probe>(planner) };
}

#[test]
fn a_null_instance_is_refused() {
    let mut sink = Sink::default();
    assert_eq!(do_step(&mut sink, std::ptr::null_mut(), &sensed(&[])).0, Code::State as i32);
    assert_eq!(sink.error, "called without an instance");
}

#[test]
fn an_older_console_has_services_that_are_absent() {
    let mut sink = Sink::default();
    // A console that knows the table only up to `error`.
    let older = Host { size: std::mem::offset_of!(Host, log) as u32, ..host(&mut sink) };
    let services = unsafe { HostServices::read(&older) };
    crate::Services::log(&services, crate::LogLevel::Info, "unheard");
    services.error("heard");
    assert_eq!((sink.error.as_str(), sink.logs.len()), ("heard", 0));
}

#[test]
fn arrays_of_a_newer_console_are_read_by_their_stride() {
    /// An obstacle of a later minor version.
    #[repr(C)]
    struct Grown {
        known: abi::Obstacle,
        later: f64,
    }
    let grown: Vec<Grown> =
        lend::obstacles(&obstacles()).into_iter().map(|known| Grown { known, later: f64::NAN }).collect();
    let plain = sensed(&[]);
    let mut raw = lend::step(&plain, &[]);
    raw.obstacles = grown.as_ptr().cast();
    (raw.n_obstacles, raw.obstacle_stride) = (3, size_of::<Grown>() as u32);
    let parts = unsafe { SensedParts::read(&raw) }.unwrap();
    assert_eq!(parts.sensed().obstacles, obstacles());
}

#[test]
fn the_entry_lists_the_planners_of_the_macro() {
    static TABLE: abi::Planner = crate::export::table::<Probe>("1.2.3");
    static LIST: abi::PlannerList<1> = abi::PlannerList([&raw const TABLE]);
    let entry: Entry = LIST.entry();
    assert_eq!((entry.magic, entry.n_planners), (abi::MAGIC, 1));
    let first = unsafe { &**entry.planners };
    assert_eq!(
        unsafe { (first.id.to_text(99), first.version.to_text(99)) },
        ("probe".into(), "1.2.3".into())
    );
}

#[test]
fn ids_are_lower_case_words() {
    assert!(crate::export::is_id("apf-virtual_goals2"));
    for bad in ["", "Apf", "a b", "ä", &"x".repeat(33)] {
        assert!(!crate::export::is_id(bad), "{bad}");
    }
}

#[test]
fn an_unknown_outline_is_refused() {
    let mut lent = lend::obstacles(&obstacles()[..1]);
    lent[0].outline.kind = 77;
    let plain = sensed(&[]);
    let refused = unsafe { SensedParts::read(&lend::step(&plain, &lent)) }.map(|_| ()).unwrap_err();
    assert_eq!((refused.code, refused.message.contains("77")), (Code::Invalid, true));
}

#[test]
fn a_polygon_tank_stays_a_polygon() {
    let polygon = Site { boundary: Boundary::Polygon { vertices: &CORNERS }, ..site(&[], &[]) };
    let raw = lend::site(&polygon, &[], &[]);
    assert_eq!(unsafe { SiteParts::read(&raw) }.unwrap().site(), Ok(polygon));
}
