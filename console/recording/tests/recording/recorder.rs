//! The content of a recording.

use crate::{
    content::{Content, content},
    events, synthetic,
};
use account::{Fold, Summary};
use mission::{Event, EventKind};
use recording::{Identity, Recorder, RecordingError, export, inspect};
use std::{
    path::Path,
    time::{Duration, Instant},
};
use tempfile::tempdir;

const TICKS: u64 = 600;

fn record(path: &Path, events: &[Event], step: Duration) {
    record_and_merge(path, events, step, None);
}

fn record_and_merge(path: &Path, events: &[Event], step: Duration, until: Option<Instant>) {
    let mut now = Instant::now();
    let mut recorder = Recorder::create(path, &Identity::of_run("test"), now).expect("a new file");
    let mut account = Fold::new();
    for event in events {
        recorder.push(event, &account, now).expect("room on the disk");
        account.apply(event);
        now += step;
    }
    recorder.finish(&account.summary(), until).expect("room on the disk");
}

pub(crate) fn recorded(events: &[Event]) -> Content {
    let folder = tempdir().expect("a folder");
    let path = folder.path().join("recording.rrd");
    record(&path, events, Duration::ZERO);
    content(&path)
}

fn count(events: &[Event], wanted: fn(&EventKind) -> bool) -> usize {
    events.iter().filter(|event| wanted(&event.kind)).count()
}

pub(crate) fn rows<'a>(
    content: &'a Content,
    entity: &str,
    component: &str,
) -> &'a [(Vec<(String, i64)>, String)] {
    let key = (entity.to_owned(), component.to_owned());
    content.get(&key).unwrap_or_else(|| panic!("no {component} at {entity}")).as_slice()
}

#[test]
fn every_tick_has_its_row_of_truth_estimate_and_figures() {
    let events = events(TICKS);
    let content = recorded(&events);
    let commands = count(&events, |kind| matches!(kind, EventKind::Commanded { .. }));
    for (entity, component, wanted) in [
        ("map/world/robot/true", "Transform3D:translation", TICKS as usize),
        ("map/world/robot/est", "Transform3D:translation", TICKS as usize),
        ("map/world/robot/est", "Ellipses2D:half_sizes", TICKS as usize),
        ("scalars/planner/potential", "Scalars:scalars", commands),
        ("map/world/ae/ranges", "LineStrips2D:strips", TICKS as usize / 10),
        ("map/world/ae/fix", "Points2D:positions", TICKS as usize / 10),
    ] {
        assert_eq!(rows(&content, entity, component).len(), wanted, "{entity}");
    }
}

/// The value of a figure in every tick, including the ticks without a row, in which the figure did not change.
fn by_tick(content: &Content, figure: &str) -> Vec<Option<String>> {
    let mut rows = rows(content, figure, "Scalars:scalars").iter().peekable();
    let mut last = None;
    let of_tick = |tick| {
        let is_due = |(times, _): &&(Vec<(String, i64)>, String)| {
            times.iter().any(|(name, t)| name == "tick" && *t <= tick)
        };
        while let Some((_, value)) = rows.next_if(is_due) {
            last = Some(value.clone());
        }
        last.clone()
    };
    (0..TICKS as i64).map(of_tick).collect()
}

#[test]
fn a_figure_is_known_in_every_tick_and_equal_values_have_a_first_and_a_last_row() {
    let events = events(TICKS);
    let content = recorded(&events);
    let wanted = |of: fn(&EventKind) -> Option<f64>| {
        let mut last = None;
        let mut by_tick = vec![None; TICKS as usize];
        let mut events = events.iter().peekable();
        for (tick, value) in by_tick.iter_mut().enumerate() {
            while let Some(event) = events.next_if(|event| event.tick <= tick as u64) {
                last = of(&event.kind).map(|value| value.to_string()).or(last);
            }
            value.clone_from(&last);
        }
        by_tick
    };
    let clearance = wanted(|kind| match kind {
        EventKind::Truth { clearance_m, .. } => Some(*clearance_m),
        _ => None,
    });
    let cross_track = wanted(|kind| match kind {
        EventKind::Progressed { cross_track_m, .. } => *cross_track_m,
        _ => None,
    });
    for (figure, wanted) in [("scalars/clearance", clearance), ("scalars/cross_track", cross_track)] {
        assert_eq!(by_tick(&content, figure), wanted, "{figure}");
    }
    for figure in ["scalars/clearance", "scalars/cross_track"] {
        let rows = rows(&content, figure, "Scalars:scalars");
        assert!(
            rows.windows(3).all(|three| three[0].1 != three[1].1 || three[1].1 != three[2].1),
            "{figure}"
        );
    }
}

#[test]
fn a_tethered_run_has_the_cable_in_every_tick_and_its_figures() {
    let mut events = events(20);
    let limits = world::tether::Limits { reel_length_m: 30.0, wrap_max_rad: 3.0, wrap_total_max_rad: 6.0 };
    let anchor = world::Point::origin();
    let reel = world::tether::Reel {
        mass_kg_per_m: 0.1,
        floor_friction: 0.3,
        pull_n: 6.0,
        pay_out_n: 0.5,
        robot_pull_n: None,
        pull_ratio_max: 0.8,
    };
    let tether =
        mission::TetherConfig { anchor, limits, friction: 0.3, reel: Some(reel), allow_uncertified: false };
    if let EventKind::RunOpened(run) = &mut events[0].kind {
        run.mission.tether = Some(tether);
    }
    let tether_events: Vec<Event> = events
        .iter()
        .filter_map(|event| match &event.kind {
            EventKind::Truth { pose, .. } => Some((event.clone(), pose.position)),
            _ => None,
        })
        .flat_map(|(event, at)| {
            let length_m = (at - anchor).norm();
            // Every other tick has neither a return path nor a contact.
            let bears = event.tick % 2 == 0;
            let contact = mission::event::TetherContact { on: "C1".into(), wrap_rad: 1.0, at };
            let kind = EventKind::Tethered {
                length_m,
                paid_out_m: None,
                free_m: 30.0 - length_m,
                contacts: if bears { vec![contact] } else { vec![] },
                wrap_max_rad: 1.0,
                wrap_total_rad: 1.0,
                pull_factor: 1.3,
                pull_n: Some(1.2 + 0.01 * length_m),
                measured: None,
                return_length_m: bears.then_some(length_m),
                bends: vec![],
            };
            let truth = EventKind::TetherTruth {
                length_m,
                wrap_max_rad: 1.0,
                wrap_total_rad: 1.0,
                detour_m: 0.0,
                lies: None,
            };
            [Event { kind: truth, ..event.clone() }, Event { kind, ..event }]
        })
        .collect();
    events.extend(tether_events);
    events.sort_by_key(|event| event.tick);
    let content = recorded(&events);
    for (entity, component, wanted) in [
        ("map/world/tether", "LineStrips2D:strips", 20),
        ("map/world/tether/contacts", "Points2D:positions", 20),
        ("scalars/tether/return_path", "Scalars:scalars", 10),
        // This figure does not change, so only its first and its last row are recorded.
        ("scalars/tether_wrap/largest", "Scalars:scalars", 2),
    ] {
        assert_eq!(rows(&content, entity, component).len(), wanted, "{entity}");
    }
    // The pull changes with the length.
    let changes = |entity| rows(&content, entity, "Scalars:scalars").len();
    assert_eq!(changes("scalars/tether_pull/needed"), changes("scalars/tether/out"));
    assert!(changes("scalars/tether_pull/needed") > 2);
}

#[test]
fn the_last_row_is_the_last_tick_on_both_timelines() {
    let events = events(TICKS);
    let content = recorded(&events);
    let (times, value) =
        rows(&content, "map/world/robot/true", "Transform3D:translation").last().expect("rows");
    let last = TICKS as i64 - 1;
    assert_eq!(times, &[("sim_time".to_owned(), last * 100_000_000), ("tick".to_owned(), last)]);
    let truth = events.iter().rev().find_map(|event| match &event.kind {
        EventKind::Truth { pose, .. } => Some(pose.position),
        _ => None,
    });
    let truth = truth.expect("the run has a truth");
    assert_eq!(value, &format!("[{:?}, {:?}, 0.0]", truth.x as f32, truth.y as f32));
}

#[test]
fn a_layer_that_is_not_drawn_any_more_is_cleared() {
    let events = events(TICKS);
    let content = recorded(&events);
    let repulsion = rows(&content, "map/world/forces/repulsion", "Arrows2D:vectors");
    assert!(repulsion.iter().any(|row| !row.1.is_empty()), "it is drawn near an obstacle");
    assert!(repulsion.iter().any(|row| row.1.is_empty()), "and cleared behind it");
    // While the robot is held, nothing is drawn: this gives one empty row, not one for every tick.
    let empty = repulsion.windows(2).filter(|pair| pair[0].1.is_empty() && pair[1].1.is_empty()).count();
    assert_eq!(empty, 0);
}

#[test]
fn the_log_has_a_line_for_every_event_that_people_read() {
    let events = events(TICKS);
    let content = recorded(&events);
    let lines: usize = content
        .iter()
        .filter(|((_, component), _)| component == "TextLog:text")
        .map(|(_, rows)| rows.len())
        .sum();
    assert_eq!(lines, events.iter().filter(|event| event.log_line(&[]).is_some()).count());
}

#[test]
fn the_timeline_of_states_shows_who_drove_and_what_the_mission_did() {
    let content = recorded(&events(TICKS));
    let states = |entity| {
        let rows = rows(&content, entity, "StateChange:state");
        rows.iter().map(|(times, state)| (times[1].1, state.clone())).collect::<Vec<_>>()
    };
    let half = TICKS as i64 / 2;
    assert_eq!(states("state/planner"), [(0, "rpf".to_owned()), (half + 19, "apf".to_owned())]);
    let mission = [(0, "moving"), (0, "waiting"), (half, "held by the operator"), (half + 19, "moving")];
    let last = (TICKS as i64 - 1, "complete");
    let expected: Vec<_> =
        mission.iter().chain([&last]).map(|(tick, state)| (*tick, (*state).to_owned())).collect();
    assert_eq!(states("state/mission"), expected);
}

#[test]
fn the_last_picture_of_the_floor_holds_every_scanned_cell() {
    let events = events(TICKS);
    let content = recorded(&events);
    let pictures = rows(&content, "map/world/coverage", "SegmentationImage:buffer");
    let scanned: u32 = events
        .iter()
        .filter_map(|event| match &event.kind {
            EventKind::Covered { runs } => Some(runs.iter().map(|run| run.1).sum::<u32>()),
            _ => None,
        })
        .sum();
    let (times, last) = pictures.last().expect("a picture");
    assert_eq!(last.matches('2').count() as u32, scanned, "class 2 is scanned");
    assert_eq!(times[1].1, TICKS as i64 - 1, "the end of the run is pictured whenever the last picture was");
}

#[test]
fn a_run_with_a_date_in_its_name_has_a_calendar() {
    let folder = tempdir().expect("a folder");
    let path = folder.path().join("recording.rrd");
    let now = Instant::now();
    let identity = Identity::of_run("20261122T040132Z-demo-rpf-1");
    let mut recorder = Recorder::create(&path, &identity, now).expect("a new file");
    for event in &events(20) {
        recorder.push(event, &Fold::new(), now).expect("room on the disk");
    }
    recorder.finish(&Summary::default(), None).expect("room on the disk");
    let content = content(&path);
    let began_ns = 1_795_320_092_000_000_000_i64;
    let (times, _) = rows(&content, "map/world/robot/true", "Transform3D:translation").last().expect("rows");
    assert_eq!(times.last(), Some(&("utc".to_owned(), began_ns + 1_900_000_000)));
    let (_, start) = rows(&content, "__properties", "RecordingInfo:start_time").last().expect("a property");
    assert_eq!(start, &began_ns.to_string());
}

#[test]
fn stations_have_their_residuals_also_those_that_were_rejected() {
    let content = recorded(&events(TICKS));
    let fixes = TICKS as usize / 10;
    let of = |station: &str| rows(&content, &format!("scalars/residual/{station}"), "Scalars:scalars");
    assert!(
        of("AE0").len() == fixes && of("AE0").iter().all(|(_, value)| value == "0.01"),
        "{:?}",
        of("AE0")
    );
    assert!(
        of("AE2").len() == fixes && of("AE2").iter().any(|(_, value)| value == "0.61"),
        "{:?}",
        of("AE2")
    );
}

#[test]
fn a_closed_recording_has_few_chunks() {
    let folder = tempdir().expect("a folder");
    let path = folder.path().join("recording.rrd");
    record(&path, &events(TICKS), Duration::from_millis(700));
    let kinds: std::collections::BTreeSet<_> = content(&path).into_keys().map(|(entity, _)| entity).collect();
    let chunks = crate::content::chunks(&path);
    assert!(chunks <= 2 * kinds.len(), "{chunks} chunks of {} entities", kinds.len());
    assert_eq!(std::fs::read_dir(folder.path()).expect("readable").count(), 1, "nothing else is left");
}

#[test]
fn a_recording_that_somebody_writes_into_is_not_whole() {
    let folder = tempdir().expect("a folder");
    let path = folder.path().join("recording.rrd");
    let now = Instant::now();
    let mut recorder = Recorder::create(&path, &Identity::of_run("test"), now).expect("a new file");
    let mut account = Fold::new();
    for event in events(TICKS) {
        recorder.push(&event, &account, now).expect("room on the disk");
        account.apply(&event);
    }
    let file = std::fs::File::options().write(true).open(&path).expect("ours");
    std::os::unix::fs::FileExt::write_all_at(&file, b"other", 200).expect("within the file");
    let error = recorder.finish(&account.summary(), None).expect_err("changed");
    assert!(error.to_string().contains("the file was changed by another program"), "{error}");
}

#[test]
fn a_recording_that_cannot_be_merged_in_time_stays_as_it_was_written() {
    let folder = tempdir().expect("a folder");
    let (whole, long) = (folder.path().join("whole.rrd"), folder.path().join("long.rrd"));
    let step = Duration::from_millis(700);
    record(&whole, &events(TICKS), step);
    record_and_merge(&long, &events(TICKS), step, Some(Instant::now()));
    assert!(crate::content::chunks(&long) > 2 * crate::content::chunks(&whole));
    // Data for the whole run is written again after each change; only the last value counts.
    let timed = |mut content: Content| {
        for rows in content.values_mut() {
            rows.retain(|(times, _)| !times.is_empty());
        }
        content
    };
    assert!(timed(content(&whole)) == timed(content(&long)), "each moment is as it was");
    assert_eq!(std::fs::read_dir(folder.path()).expect("readable").count(), 2, "nothing else is left");
}

#[test]
fn a_recording_whose_writer_is_killed_says_the_same_up_to_there() {
    let folder = tempdir().expect("a folder");
    let (path, whole) = (folder.path().join("killed.rrd"), folder.path().join("whole.rrd"));
    let events = events(2 * TICKS);
    let mut now = Instant::now();
    let mut recorder = Recorder::create(&path, &Identity::of_run("test"), now).expect("a new file");
    let mut account = Fold::new();
    for event in &events {
        recorder.push(event, &account, now).expect("room on the disk");
        account.apply(event);
        now += Duration::from_millis(700);
    }
    recorder.idle(now + Duration::from_secs(6)).expect("room on the disk");
    // A recorder that is dropped must not write the data that marks the end of a complete recording.
    drop(recorder);
    let killed = content(&path);
    record(&whole, &events, Duration::ZERO);
    let whole = content(&whole);
    let kinds = |content: &Content| content.keys().cloned().collect::<Vec<_>>();
    assert_eq!(kinds(&killed), kinds(&whole), "nothing is written only at the end");
    let states = |content: &Content| rows(content, "state/mission", "StateChange:state").to_vec();
    assert_eq!(states(&killed), states(&whole));
}

#[test]
fn chunks_do_not_change_what_is_recorded() {
    let folder = tempdir().expect("a folder");
    let events = events(TICKS);
    let (fast, slow) = (folder.path().join("fast.rrd"), folder.path().join("slow.rrd"));
    record(&fast, &events, Duration::ZERO);
    record(&slow, &events, Duration::from_millis(700));
    assert_eq!(content(&fast), content(&slow));
    let (fast, slow) = (inspect(&fast).expect("readable"), inspect(&slow).expect("readable"));
    assert_eq!(fast, slow);
}

#[test]
fn a_recording_regenerated_from_the_journal_is_the_same() {
    let folder = tempdir().expect("a folder");
    let recorder =
        recording::RunRecorder::start(folder.path(), recording::Options::default()).expect("new files");
    for events in synthetic::run(TICKS) {
        recorder.send(events);
    }
    let finished = recorder.finish(Duration::from_secs(20));
    assert_eq!(finished.error, None);
    let regenerated = folder.path().join("regenerated.rrd");
    let journal = folder.path().join("events.jsonl.zst");
    assert_eq!(export(&journal, &regenerated).expect("a whole journal"), None);
    // The run has no instrument.
    let parquet = folder.path().join("readings.parquet");
    assert!(matches!(recording::export_readings(&journal, &parquet), Err(RecordingError::NoReadings)));
    assert!(!parquet.exists());
    let first = finished.recording.expect("a recording was asked for");
    assert_eq!(content(&first), content(&regenerated));
    assert_eq!(inspect(&first).expect("readable"), inspect(&regenerated).expect("readable"));
}

#[test]
fn the_summary_gives_run_ticks_coverage_and_end() {
    let folder = tempdir().expect("a folder");
    let path = folder.path().join("recording.rrd");
    let events = events(TICKS);
    record(&path, &events, Duration::ZERO);
    let summary = inspect(&path).expect("readable");
    let covered = events.iter().rev().find_map(|event| match event.kind {
        EventKind::Progressed { covered_reachable, .. } => Some(100.0 * covered_reachable),
        _ => None,
    });
    assert_eq!(summary.last_coverage_percent, covered);
    assert_eq!(summary.ticks, Some((0, TICKS as i64 - 1)));
    assert_eq!(summary.name.as_deref(), Some("test"));
    assert_eq!(summary.recording_id, Identity::of_run("test").recording_id);
    assert_eq!(summary.outcome.as_deref(), Some("complete"));
    assert!(summary.has_layout);
    assert!(summary.is_complete());
}

#[test]
fn a_recording_that_is_cut_off_is_read_up_to_there() {
    let folder = tempdir().expect("a folder");
    let path = folder.path().join("recording.rrd");
    record(&path, &events(TICKS), Duration::from_millis(700));
    let bytes = std::fs::read(&path).expect("readable");
    std::fs::write(&path, &bytes[..bytes.len() * 6 / 10]).expect("writable");
    let summary = inspect(&path).expect("readable");
    assert!(summary.ticks.expect("some ticks").1 > 100);
    assert!(!summary.is_complete());
}

#[test]
fn a_recording_without_a_world_is_refused() {
    let events = events(2);
    let mut recorder =
        Recorder::writing_to(Box::new(std::io::sink()), &Identity::of_run("test"), Instant::now())
            .expect("opens");
    let error =
        recorder.push(&events[1], &Fold::new(), Instant::now()).expect_err("the first event is missing");
    assert!(matches!(&error, RecordingError::NotOpened { got } if got == "planner_chosen"), "{error}");
    recorder.push(&events[2], &Fold::new(), Instant::now()).expect("an error is reported once");
}

#[test]
fn a_tick_takes_no_more_than_600_bytes() {
    let folder = tempdir().expect("a folder");
    let size = |ticks| {
        let path = folder.path().join(format!("{ticks}.rrd"));
        record(&path, &events(ticks), Duration::ZERO);
        std::fs::metadata(&path).expect("it is there").len()
    };
    // Layout, scene and footer are written once, so the difference between the sizes is due to the ticks.
    let (short, long) = (size(1000), size(3000));
    assert!(long - short <= 600 * 2000, "{} bytes a tick", (long - short) / 2000);
    assert!(short < 1_200_000, "{short} bytes for 1000 ticks");
}
