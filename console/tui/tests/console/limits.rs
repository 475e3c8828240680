//! Figures beside their limits: the residuals of the stations, and the pulls of the tether.

use crate::fixture::{RICH, Screen};
use crate::screens::{drawn, text};
use mission::{Event, EventKind, event::MeasuredPull};
use nalgebra::Matrix2;
use positioning::{Fix, Integrity, Residual};
use tui::model::{Cause, Pane};
use tui::{Key, Msg, RunMsg};
use world::{Point, StationId, tether::Reel};

fn shown(screen: &mut Screen, (width, height): (u16, u16)) -> String {
    screen.send(Msg::Resize { width, height });
    text(&drawn(&screen.model, RICH, (width, height)))
}

/// A mission whose last fix uses five stations, the fifth with the given residual, metres.
fn fixed_with(residual_m: f64) -> Screen {
    let mut screen = Screen::running();
    let residual = |id, residual_m| Residual { station: StationId(id), residual_m, sigma_m: 0.05 };
    let residuals = vec![residual(1, 0.02), residual(2, -0.03), residual(3, residual_m)];
    let used = residuals.iter().map(|residual| residual.station).collect();
    let fix = Fix {
        position: Point::origin(),
        covariance: Matrix2::identity() * 1e-3,
        residuals,
        used,
        excluded: Vec::new(),
        chi2: 64.0,
        degrees_of_freedom: 1,
        gdop: 1.0,
        conditioning: 1.0,
        mirror: None,
        protection_level_m: None,
        integrity: if residual_m > 0.15 { Integrity::Alarm } else { Integrity::Ok },
    };
    let event = screen.mission.now(EventKind::Fixed { fix });
    screen.hear(RunMsg::Events(vec![event]));
    screen
}

#[test]
fn a_station_that_contradicts_the_fix_is_not_ok() {
    let wrong = shown(&mut fixed_with(0.4), (120, 36));
    assert!(wrong.contains("used, +0.40 m! (limit 0.15)"), "{wrong}");
    assert!(!wrong.contains(" ok +") && !wrong.contains(" ok -"), "{wrong}");
    let sound = shown(&mut fixed_with(0.1), (120, 36));
    assert!(sound.contains(" ok +20 mm") && !sound.contains('!'), "{sound}");
}

#[test]
fn the_figures_of_the_stations_are_reached_with_tab_at_every_size() {
    for size in [(200, 60), (120, 36), (80, 24), (60, 16)] {
        let mut screen = fixed_with(0.4);
        screen.send(Msg::Resize { width: size.0, height: size.1 });
        for _ in 0..screen.model.ui.panes().len() {
            if screen.model.ui.pane != Pane::Stations {
                screen.press([Key::Tab]);
            }
        }
        let shown = shown(&mut screen, size);
        for words in ["range", "residual", "limit", "unused", "400 mm", "150 mm", "used!"] {
            assert!(shown.contains(words), "{words} at {size:?}:\n{shown}");
        }
    }
}

/// A mission on a tether with the given limit of the pull at the robot, newtons.
fn on_reel(robot_pull_n: Option<f64>) -> Screen {
    let mut screen = Screen::tethered();
    let reel = Reel {
        mass_kg_per_m: 0.3,
        floor_friction: 0.3,
        pull_n: 17.0,
        pay_out_n: 0.5,
        robot_pull_n,
        pull_ratio_max: 0.8,
    };
    if let Some(about) = &mut screen.model.live.run.about {
        about.mission.tether.as_mut().unwrap().reel = Some(reel);
    }
    screen
}

/// The pulls for two seconds: needed at the reel, and measured at the robot, newtons.
fn pulled(screen: &mut Screen, needed_n: f64, felt_n: f64) {
    for _ in 0..20 {
        let mut events: Vec<Event> = screen.mission.drive(1);
        let mut cable = screen.mission.cable();
        if let EventKind::Tethered { pull_n, measured, .. } = &mut cable.kind {
            (*pull_n, *measured) = (Some(needed_n), Some(MeasuredPull { pull_n: felt_n, slack_m: 0.0 }));
        }
        events.push(cable);
        screen.hear(RunMsg::Events(events));
    }
}

fn is_open(screen: &Screen, word: &str) -> bool {
    let cause = Cause::Tether(word.into());
    screen.model.live.run.alarms.get(&cause).is_some_and(tui::model::Alarm::is_active)
}

#[test]
fn the_pulls_at_the_reel_and_at_the_robot_are_shown_apart() {
    let mut screen = on_reel(None);
    pulled(&mut screen, 7.5, 31.5);
    for size in [(200, 60), (120, 36), (80, 24), (60, 16)] {
        screen.send(Msg::Resize { width: size.0, height: size.1 });
        let pages = screen.model.ui.panes().len();
        let all: String = (0..pages)
            .map(|_| {
                screen.press([Key::Tab]);
                shown(&mut screen, size)
            })
            .collect();
        assert!(all.contains("robot pull") && all.contains("31.5 N (no limit given)"), "{size:?}:\n{all}");
        assert!(all.contains("reel needs") && all.contains("7.5 of 17.0 N"), "{size:?}:\n{all}");
    }
    assert!(!is_open(&screen, "robot pull") && !is_open(&screen, "reel pull"));
}

#[test]
fn a_pull_beyond_its_limit_is_an_alarm_until_it_has_returned() {
    let mut screen = on_reel(Some(25.0));
    pulled(&mut screen, 17.5, 31.5);
    assert!(is_open(&screen, "robot pull") && is_open(&screen, "reel pull"));
    let shown = shown(&mut screen, (120, 36));
    assert!(shown.contains("31.5 of 25.0 N") && shown.contains("17.5 of 17.0 N"), "{shown}");
    // Within the deadband, nothing changes.
    pulled(&mut screen, 16.5, 24.5);
    assert!(is_open(&screen, "robot pull") && is_open(&screen, "reel pull"));
    for _ in 0..3 {
        pulled(&mut screen, 10.0, 12.0);
    }
    assert!(!is_open(&screen, "robot pull") && !is_open(&screen, "reel pull"));
}
