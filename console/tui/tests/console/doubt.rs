//! Floor in doubt: what the console shows of the floor that a biased station takes back.

use crate::fixture::{PLAIN, RICH, Screen};
use crate::overviews::ended;
use crate::panes::missed_summary;
use crate::screens::{drawn, text};
use crate::sizes::SIZES;
use account::{InDoubt, TakenBack};
use mission::EventKind;
use tui::model::{Cause, Pane};
use tui::{Key, Msg, RunMsg};
use world::{CellRun, Point, StationId};

fn in_doubt() -> InDoubt {
    let station = "S2".into();
    let floor = TakenBack {
        station,
        bias_m: 0.15,
        bias_sigma_m: Some(0.02),
        since_s: 540.0,
        until_s: 633.0,
        area_m2: 41.87,
        left_m2: None,
    };
    InDoubt { floor, at: Some(Point::new(3.2, -1.5)), cells: Vec::new() }
}

/// Tells a screen that station S2 is biased, and which floor is therefore in doubt.
fn doubted(mut screen: Screen) -> Screen {
    let bias_m = positioning::Estimated { value: 0.15, sigma: 0.02 };
    let biased =
        EventKind::StationBiased { station: StationId(2), bias_m, since_s: 540.0, is_corrected: false };
    let event = screen.mission.now(biased);
    screen.hear(RunMsg::Events(vec![event]));
    screen.hear(RunMsg::InDoubt(vec![in_doubt()]));
    screen
}

fn shown(screen: &mut Screen, size: (u16, u16)) -> String {
    screen.send(Msg::Resize { width: size.0, height: size.1 });
    text(&drawn(&screen.model, RICH, size))
}

/// The text without line breaks and frames.
fn flat(text: &str) -> String {
    text.replace(['│', '█'], " ").split_whitespace().collect::<Vec<_>>().join(" ")
}

#[test]
fn the_mission_screen_shows_the_floor_in_doubt_at_every_size() {
    let mut screen = doubted(Screen::running());
    screen.type_text("3");
    for size in SIZES {
        screen.send(Msg::Resize { width: size.0, height: size.1 });
        if size == (60, 16) {
            screen.press([Key::Tab]);
            assert_eq!(screen.model.ui.pane, Pane::Coverage);
        }
        let shown = shown(&mut screen, size);
        assert!(shown.contains("in doubt") && shown.contains("41.9 m², S2"), "{size:?}\n{shown}");
        screen.model.ui.pane = Pane::Map;
    }
    let mut sound = Screen::running();
    assert!(!shown(&mut sound, (120, 36)).contains("in doubt"));
}

#[test]
fn the_alarm_of_a_biased_station_lists_the_floor_in_doubt_and_its_remedy() {
    let mut screen = doubted(Screen::running());
    screen.type_text("4");
    screen.model.ui.alarm = Some(Cause::Bias(StationId(2)));
    let shown = flat(&shown(&mut screen, (120, 36)));
    for words in
        ["station S2 biased", "41.9 m², scanned T+00:09:00 to T+00:10:33, around 3.20, -1.50 m", "r on the"]
    {
        assert!(shown.contains(words), "{words}\n{shown}");
    }
}

#[test]
fn the_result_lists_the_floor_in_doubt_and_how_to_scan_it_again() {
    let (mut screen, mut closed) = ended();
    closed.summary.floor = missed_summary().floor;
    screen.hear(RunMsg::InDoubt(vec![in_doubt()]));
    screen.hear(RunMsg::Closed(Box::new(closed.clone())));
    for size in SIZES {
        screen.send(Msg::Resize { width: size.0, height: size.1 });
        while screen.model.ui.pane != Pane::Coverage {
            screen.press([Key::Tab]);
        }
        let shown = shown(&mut screen, size);
        assert!(shown.contains("IN DOUBT: 41.9 m²"), "{size:?}\n{shown}");
        // Only at the smallest size does the pane have the rows for itself.
        let whole = "IN DOUBT: 41.9 m² scanned from T+00:09:00 to T+00:10:33: the ranges of station S2 were wrong by +0.15 ± 0.04 m, around \
                     3.20, -1.50 m. r: re-scan it.";
        assert!(size != SIZES[0] || flat(&shown).contains(whole), "{shown}");
    }
    let page = tui::handover::page(&screen.model);
    assert!(page.contains("- In doubt: 41.9 m² scanned from T+00:09:00"), "{page}");
    // Of a replayed run, the report states the floor; it is in doubt from the moment on at which the bias was found.
    let (mut replayed, mut closed) = ended();
    closed.summary.taken_back = vec![TakenBack { until_s: 100.0, ..in_doubt().floor }, in_doubt().floor];
    replayed.hear(RunMsg::Closed(Box::new(closed)));
    replayed.model.live.run.clock.t_s = 300.0;
    assert_eq!(replayed.model.live.in_doubt().len(), 1);
}

/// A run that has ended, with floor in doubt around a place that was scanned.
fn ended_in_doubt() -> Screen {
    let (mut screen, mut closed) = ended();
    closed.summary.floor = missed_summary().floor;
    let floor = screen.model.live.run.coverage.as_ref().expect("a floor").floor();
    let is_beside_wall = |cell: &usize| {
        let at = floor.center(*cell);
        at.x > 6.0 && at.y.abs() < 3.0
    };
    let cells = (0..floor.len()).filter(is_beside_wall).map(|cell| CellRun(cell as u32, 1)).collect();
    screen.hear(RunMsg::InDoubt(vec![InDoubt { cells, ..in_doubt() }]));
    screen.hear(RunMsg::Closed(Box::new(closed)));
    screen
}

#[test]
fn floor_in_doubt_leads_the_result_and_is_a_kind_of_its_own_on_the_map() {
    for caps in [RICH, PLAIN] {
        let mut screen = ended_in_doubt();
        for size in SIZES {
            screen.send(Msg::Resize { width: size.0, height: size.1 });
            screen.model.ui.pane = Pane::Figures;
            let first = text(&drawn(&screen.model, caps, size));
            assert!(first.contains(", 41.9 m² IN DOUBT"), "{size:?}\n{first}");
            assert!(first.contains("IN DOUBT: 41.9 m², scanned while"), "{size:?}\n{first}");
            screen.model.ui.pane = Pane::Map;
            let map = text(&drawn(&screen.model, caps, size));
            assert!(size.0 < 80 || map.contains("in doubt"), "{size:?}\n{map}");
            assert!(
                caps == RICH || map.matches("dd").count() > usize::from(size.0 >= 120),
                "{size:?}\n{map}"
            );
        }
    }
    let sound = text(&drawn(&ended().0.model, PLAIN, (120, 36)));
    assert!(!sound.to_lowercase().contains("in doubt"), "{sound}");
}
