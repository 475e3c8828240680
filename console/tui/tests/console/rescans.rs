//! A re-scan: the floor that earlier runs have scanned, on the map, in the shares, on the handover page and in a replay.

use crate::fixture::{RICH, Screen};
use crate::panes::missed_summary;
use crate::replay::replaying;
use crate::screens::{drawn, text};
use tui::RunMsg;
use tui::handover::page;
use tui::model::{Combination, Continued};
use world::CellRun;

const BEFORE: &str = "20261122T030000Z-tank-07-rpf-42";

/// Tells the screen that its run is a re-scan, and that the run before it has scanned some share of the cells.
fn as_rescan(mut screen: Screen, share: f64) -> Screen {
    let cells = screen.model.live.run.coverage.as_ref().unwrap().floor().len();
    let scanned = vec![CellRun(0, (share * cells as f64) as u32)];
    let earlier = vec![BEFORE.to_owned()];
    screen.hear(RunMsg::Continues(Ok(Continued { runs: earlier.clone(), left_at: None })));
    let floor = missed_summary().floor.unwrap();
    let read = Combination {
        earlier,
        floor,
        kinds: Vec::new(),
        taken_back: None,
        scanned,
        not_requested: Vec::new(),
    };
    screen.hear(RunMsg::ScannedBefore(Ok(Box::new(read))));
    screen
}

fn shown(screen: &Screen, size: (u16, u16)) -> String {
    text(&drawn(&screen.model, RICH, size))
}

#[test]
fn the_map_shows_what_an_earlier_run_has_scanned_apart_from_what_this_run_scans() {
    let alone = Screen::running();
    assert!(!shown(&alone, (120, 36)).contains("scanned before"));
    let screen = as_rescan(alone.clone(), 0.5);
    for size in [(80, 24), (120, 36), (200, 60)] {
        let (map, without) = (shown(&screen, size), shown(&alone, size));
        assert!(map.contains("scanned before") && map != without, "{size:?}\n{map}");
    }
    // The sign of the legend is on the map, and only there where the other run was.
    let map = shown(&screen, (200, 60));
    let sign = map.lines().find_map(|line| line.split("scanned before").next().filter(|rest| *rest != line));
    let sign = sign.and_then(|before| before.trim_end().chars().last()).unwrap();
    let count = |text: &str| text.matches(sign).count();
    assert!(count(&map) > count(&shown(&alone, (200, 60))) + 50, "{sign}\n{map}");
    let all = as_rescan(alone, 1.0);
    assert!(count(&shown(&all, (200, 60))) > count(&map), "more floor was scanned before");
}

#[test]
fn the_shares_of_a_re_scan_refer_to_its_own_task_and_to_all_runs() {
    let share = |screen: &Screen| {
        let text = shown(screen, (120, 36));
        let line =
            text.lines().find(|line| line.contains(" scanned ") && line.contains('%')).unwrap().to_owned();
        let figures = line
            .split('%')
            .map(|part| part.rsplit(' ').find(|word| !word.is_empty()).unwrap_or_default().parse());
        figures.filter_map(Result::ok).collect::<Vec<f64>>()
    };
    let (half, all) = (as_rescan(Screen::running(), 0.5), as_rescan(Screen::running(), 1.0));
    assert!(shown(&half, (120, 36)).contains("all runs"));
    let (half, all) = (share(&half), share(&all));
    assert!((all[1] - 100.0).abs() < 1e-9 && half[1] > 40.0 && half[1] < 100.0, "{half:?} {all:?}");
    assert!((half[0] - all[0]).abs() < 1e-9, "the task is the same: {half:?} {all:?}");
}

#[test]
fn the_handover_page_of_a_re_scan_names_the_run_before_it_and_both_shares() {
    let page = page(&as_rescan(Screen::held(), 1.0).model);
    assert!(page.contains(&format!("- Re-scan of what {BEFORE} left\n")), "{page}");
    let line = page.lines().find(|line| line.starts_with("- Scanned: ")).unwrap_or_default();
    let (requested, all) = line.split_once(" % of the requested floor, ").expect(line);
    assert!(requested.rsplit(' ').next().is_some_and(|share| share.parse::<f64>().is_ok()), "{line}");
    assert_eq!(all, "100.0 % of the floor requested of all runs");
    let alone = tui::handover::page(&Screen::held().model);
    assert!(!alone.contains("Re-scan of"), "{alone}");
}

#[test]
fn a_replay_of_a_re_scan_shows_what_was_scanned_before_it() {
    let mut screen = as_rescan(replaying(false), 0.5);
    screen.type_text("3");
    let map = shown(&screen, (120, 36));
    assert!(map.contains("scanned before") && map.contains("all runs"), "{map}");
    // It also does if the earlier runs are read before the replayed run is.
    let mut early = replaying(false);
    let coverage = early.model.live.run.coverage.take();
    let floor = missed_summary().floor.unwrap();
    let scanned = vec![CellRun(0, 1000)];
    let read = Combination {
        earlier: vec![BEFORE.into()],
        floor,
        kinds: Vec::new(),
        taken_back: None,
        scanned,
        not_requested: Vec::new(),
    };
    early.hear(RunMsg::ScannedBefore(Ok(Box::new(read))));
    assert!(early.model.live.scanned_before.is_none(), "its own floor is not known yet");
    early.model.live.run.coverage = coverage;
    let run = early.model.live.run.clone();
    early.hear(RunMsg::Replay(tui::ReplayMsg::At(tui::model::replay::Side::A, Box::new(run))));
    assert!(early.model.live.scanned_before.is_some());
}
