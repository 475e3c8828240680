//! How long a frame of the mission screen takes: 30 000 scanned cells, 10 000 points of path.
#![allow(missing_docs, reason = "criterion writes a function without docs")]
#![allow(
    clippy::print_stderr,
    clippy::disallowed_methods,
    reason = "a bench reads the clock and prints times"
)]

#[path = "../tests/console/fixture.rs"]
#[allow(dead_code, reason = "the tests use all of it")]
mod fixture;

use criterion::{Criterion, criterion_group, criterion_main};
use fixture::{RICH, Screen};
use mission::{Event, EventKind};
use ratatui::Terminal;
use ratatui::backend::TestBackend;
use std::time::{Duration, Instant};
use tui::{Cache, Msg, RunMsg, view_cached};
use world::{CellRun, Point};

/// The number of frames from which the percentiles are computed.
const FRAMES: usize = 2000;

/// A mission in which the robot has already driven a long way.
fn long_mission() -> Screen {
    let mut screen = Screen::running();
    let path: Vec<Point> = (0..10_000)
        .map(|i| {
            let (turn, radius_m) = (f64::from(i) * 0.02, 9.5 * (1.0 - f64::from(i) / 10_000.0));
            Point::new(radius_m * turn.cos(), radius_m * turn.sin())
        })
        .collect();
    let planned = EventKind::Planned {
        ask: None,
        return_path: 0,
        planner: "rpf".into(),
        reason: planner_api::Reason::Operator,
        length_m: world::polyline::length_m(&path),
        path: path.clone(),
        complete: true,
        legs: vec![],
        cuts: vec![],
    };
    let covered = EventKind::Covered { runs: vec![CellRun(0, 34_000)] };
    let mut events: Vec<Event> = [planned, covered].map(|kind| screen.mission.now(kind)).into();
    let pose = screen.model.live.run.position.pose.expect("the fixture has driven");
    events.extend(path.into_iter().map(|position| {
        screen.mission.now(EventKind::Estimated { pose: planner_api::PoseEstimate { position, ..pose } })
    }));
    screen.hear(RunMsg::Events(events));
    screen
}

fn frame(criterion: &mut Criterion) {
    for (width, height) in [(80, 24), (120, 36), (200, 60), (300, 100)] {
        let mut screen = long_mission();
        screen.send(Msg::Resize { width, height });
        let scanned = screen.model.live.run.coverage.as_ref().map_or(0, |raster| raster.counts().covered);
        let mut terminal = Terminal::new(TestBackend::new(width, height)).expect("a screen in memory");
        let mut cache = Cache::default();
        let mut draw = || {
            let drawn = terminal.draw(|frame| view_cached(&screen.model, &RICH, &mut cache, frame));
            drawn.map(drop).expect("memory");
        };
        let mut times: Vec<Duration> = (0..FRAMES)
            .map(|_| {
                let before = Instant::now();
                draw();
                before.elapsed()
            })
            .collect();
        times.sort();
        let (p50, p99) = (times[FRAMES / 2], times[FRAMES * 99 / 100]);
        eprintln!("{width}x{height}: {scanned} cells, p50 {p50:?}, p99 {p99:?}");
        criterion.bench_function(&format!("frame_{width}x{height}"), |bencher| bencher.iter(&mut draw));
    }
}

fn fold(criterion: &mut Criterion) {
    let mut screen = long_mission();
    criterion.bench_function("update_with_one_tick_of_events", |bencher| {
        bencher.iter(|| {
            let events = screen.mission.drive(1);
            screen.hear(RunMsg::Events(events))
        });
    });
}

criterion_group!(benches, frame, fold);
criterion_main!(benches);
