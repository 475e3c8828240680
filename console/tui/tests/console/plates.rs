//! The plates of a result: all of them can be reached at every size, with the true error on each.

use crate::fixture::{RICH, Screen};
use crate::overviews::ended;
use crate::panes::missed_summary;
use crate::screens::{drawn, text};
use crate::sizes;
use mission::Outcome;
use tui::model::Pane;
use tui::{Key, Msg, RunMsg, RunResult};

/// A result with 30 plates; the true error is largest on the last one, of which nothing is missed.
fn plated() -> Screen {
    let (mut screen, closed) = ended();
    let mut summary = missed_summary();
    let plates = (0..30).map(|index| {
        let missed = f64::from(29 - index) / 100.0;
        let true_m = 0.02 + 0.001 * f64::from(index);
        serde_json::json!({
            "name": format!("R-{index:02}"), "kind": "rectangular", "error_p95_m": 0.11, "error_max_m": 0.14,
            "true_error_p95_m": true_m, "true_error_max_m": 2.0 * true_m, "area_m2": 6.4,
            "scanned": 1.0 - missed, "missed": missed, "unreachable": 0.0, "margin": 0.0,
            "percent": { "scanned": 100.0 * (1.0 - missed), "missed": 100.0 * missed, "unreachable": 0.0, "margin": 0.0 },
        })
    });
    let floor = summary.floor.as_mut().unwrap();
    floor.plates = serde_json::from_value(plates.collect()).unwrap();
    summary.outcome = Some(Outcome::Complete);
    summary.positioning = serde_json::from_value(serde_json::json!({
        "mean_error_m": 0.03, "p50_m": 0.028, "p95_m": 0.07, "max_m": 0.098, "in_95_ellipse": 0.97,
        "position_lost_s": 0.0,
    }))
    .unwrap();
    screen.hear(RunMsg::Closed(Box::new(RunResult { summary: Box::new(summary), ..closed })));
    screen
}

fn shown(screen: &Screen, size: (u16, u16)) -> String {
    text(&drawn(&screen.model, RICH, size))
}

#[test]
fn every_plate_can_be_reached_at_every_size() {
    for (width, height) in [(200, 60), (120, 36), (80, 24), (60, 16)] {
        let mut screen = plated();
        screen.send(Msg::Resize { width, height });
        // No size has more panes than this.
        for _ in 0..5 {
            if screen.model.ui.pane != Pane::Plates {
                screen.press([Key::Tab]);
            }
        }
        assert_eq!(screen.model.ui.pane, Pane::Plates, "{width}x{height}");
        let top = shown(&screen, (width, height));
        assert!(top.contains("Plates  ") && top.contains("R-00 "), "{width}x{height}\n{top}");
        assert!(top.contains("true worst"), "{width}x{height}\n{top}");
        screen.press([Key::End]);
        let end = shown(&screen, (width, height));
        assert!(end.contains("R-29 ") && end.contains("0.098 m"), "{width}x{height}\n{end}");
    }
}

#[test]
fn a_large_screen_shows_the_plates_beside_the_map() {
    let mut screen = plated();
    screen.send(Msg::Resize { width: 200, height: 60 });
    let beside = shown(&screen, (200, 60));
    let rows = beside.lines().filter(|line| line.contains(" R-")).count();
    assert!(rows >= 15, "{rows}\n{beside}");
}

#[test]
fn the_true_error_is_stated_with_its_plate_at_every_size() {
    let mut screen = plated();
    sizes::store("result_plates", &mut screen, sizes::is_log);
    for (width, height) in [(200, 60), (120, 36), (80, 24)] {
        screen.send(Msg::Resize { width, height });
        let shown = shown(&screen, (width, height));
        assert!(shown.contains("R-29"), "{width}x{height}\n{shown}");
    }
}

#[test]
fn a_mission_without_a_scan_says_so() {
    let (mut screen, _) = ended();
    for (width, height) in [(120, 36), (200, 60)] {
        screen.send(Msg::Resize { width, height });
        let shown = shown(&screen, (width, height));
        assert!(
            shown.contains("Result  COMPLETE, not a scan") && !shown.contains("Missed: no area"),
            "{shown}"
        );
    }
}

/// The text of a pane of the result, scrolled from its first to its last row.
fn scrolled(screen: &mut Screen, pane: Pane, size: (u16, u16)) -> String {
    screen.send(Msg::Resize { width: size.0, height: size.1 });
    for _ in 0..5 {
        if screen.model.ui.pane != pane {
            screen.press([Key::Tab]);
        }
    }
    assert_eq!(screen.model.ui.pane, pane, "{size:?}");
    let mut pages = String::new();
    for _ in 0..60 {
        pages += &shown(screen, size);
        screen.press([Key::Down]);
    }
    let end = shown(screen, size);
    // The list does not run away from its end: the first key up moves it.
    screen.press([Key::Up]);
    assert!(screen.model.ui.scrolled == 0 || shown(screen, size) != end, "{size:?}\n{end}");
    pages
}

#[test]
fn every_figure_of_a_result_can_be_reached_at_every_size() {
    for size in sizes::SIZES {
        let mut screen = plated();
        screen.model.live.result.as_mut().unwrap().summary.violations =
            Some((0..12).map(|n| format!("expected figure {n}, actual none")).collect());
        let pages = scrolled(&mut screen, Pane::Figures, size);
        for words in
            ["Error against the true position", "worst 0.098 m", "p95 0.070", "actual none", "95 % error"]
        {
            assert!(pages.contains(words), "{size:?}: {words}\n{pages}");
        }
        assert!(size.1 > 36 || pages.contains("↓ ↑"), "{size:?}: the title names the keys\n{pages}");
    }
}

#[test]
fn every_share_of_the_floor_can_be_reached_at_every_size() {
    for size in sizes::SIZES {
        let mut screen = plated();
        let floor = screen.model.live.result.as_mut().unwrap().summary.floor.as_mut().unwrap();
        (floor.whole.untestable, floor.whole.percent.untestable) = (0.173, 17.3);
        let pages = scrolled(&mut screen, Pane::Coverage, size);
        for words in ["reachable", "whole floor", "Critical zone", "% missed on 2 of 30", "17.3"] {
            assert!(pages.contains(words), "{size:?}: {words}\n{pages}");
        }
        assert!(pages.contains("untestable") || pages.contains("not testable"), "{size:?}\n{pages}");
    }
}

#[test]
fn the_plates_have_all_true_errors_at_80x24() {
    let mut screen = plated();
    screen.send(Msg::Resize { width: 80, height: 24 });
    while screen.model.ui.pane != Pane::Plates {
        screen.press([Key::Tab]);
    }
    let shown = shown(&screen, (80, 24));
    for head in ["scanned", "missed", "error p95", "true p95", "true worst"] {
        assert!(shown.contains(head), "{head}\n{shown}");
    }
}

#[test]
fn every_reason_of_a_missed_area_can_be_read_at_every_size() {
    for size in sizes::SIZES {
        let mut screen = plated();
        screen.send(Msg::Resize { width: size.0, height: size.1 });
        while screen.model.ui.pane != Pane::Missed {
            screen.press([Key::Tab]);
        }
        let shown = shown(&screen, size);
        assert!(!shown.contains("more reason"), "{size:?}\n{shown}");
    }
}

#[test]
fn the_arrow_keys_choose_a_missed_area_only_in_its_list_and_n_does_so_everywhere() {
    let mut screen = plated();
    let area = screen.model.live.result.as_ref().unwrap().summary.floor.as_ref().unwrap().missed[0].clone();
    screen.model.live.result.as_mut().unwrap().summary.floor.as_mut().unwrap().missed.push(area);
    screen.press([Key::Down]);
    assert_eq!((screen.model.ui.pane, screen.model.ui.missed), (Pane::Figures, 0));
    screen.type_text("n");
    assert_eq!(screen.model.ui.missed, 1);
    while screen.model.ui.pane != Pane::Missed {
        screen.press([Key::Tab]);
    }
    screen.press([Key::Up]);
    assert_eq!(screen.model.ui.missed, 0);
}
