//! The parts of the screen around the panes: the line of screens, the state, the keys, questions
//! and lists.

use crate::drawing;
use crate::ending::{driving_back, ending};
use crate::fixture::{PLAIN, RICH, Screen};
use crate::overviews::ended;
use crate::screens::{drawn, store_at, text};
use mission::{EventKind, Severity};
use tui::model::Screen as Name;
use tui::{Key, Msg, RunMsg};

const SIZES: [(u16, u16); 4] = [(60, 16), (80, 24), (120, 36), (200, 60)];

fn top(screen: &Screen, size: (u16, u16)) -> String {
    text(&drawn(&screen.model, PLAIN, size)).lines().take(2).collect::<Vec<_>>().join("\n")
}

#[test]
fn dialogs() {
    store_at("end", &mut ending(), &SIZES);
    store_at("zone", &mut drawing::asked(), &SIZES);
}

#[test]
fn drive_back() {
    store_at("drive_back", &mut driving_back(), &SIZES);
}

#[test]
fn lists() {
    let mut screen = Screen::held();
    screen.type_text("?");
    store_at("frame_help", &mut screen, &SIZES);
    let mut screen = Screen::held();
    screen.type_text(":sp");
    store_at("frame_commands", &mut screen, &SIZES);
}

#[test]
fn messages() {
    let mut screen = Screen::held();
    screen.type_text("a");
    screen.pass(65.0);
    let text = "written: logs/20261125-195244_tank-07/report.html".to_owned();
    screen.send(Msg::Notice { severity: Severity::Info, text });
    screen.type_text(":messages");
    screen.press([Key::Enter]);
    store_at("messages", &mut screen, &SIZES);
}

#[test]
fn every_size_says_which_screen_it_is_and_the_name_of_the_scenario() {
    for size in SIZES {
        for name in Name::ALL {
            let mut screen = Screen::running();
            screen.send(Msg::Resize { width: size.0, height: size.1 });
            screen.model.ui.go(name);
            let top = top(&screen, size);
            let named = format!("{} {}", name.digit(), name.name());
            // A small screen has no line of screens; its title names it.
            let named = if size.0 < 80 { named } else { format!("[{named}]") };
            assert!(top.contains(&named), "{size:?}\n{top}");
            assert!(top.contains("tank-07"), "{size:?}\n{top}");
        }
    }
}

#[test]
fn a_long_name_is_whole_and_the_alarms_are_short_before_it_is_cut() {
    let mut screen = Screen::running();
    screen.model.live.run.about.as_mut().expect("a run").scenario = "cover-unknown-columns".into();
    let lost = screen.mission.now(EventKind::PositionLost { error_m: 0.5, limit_m: 0.15 });
    screen.hear(RunMsg::Events(vec![lost]));
    let wait = screen.mission.wait(3);
    screen.hear(RunMsg::Events(wait));
    for size in [(80, 24), (120, 36), (200, 60)] {
        let top = top(&screen, size);
        assert!(top.contains("cover-unknown-columns"), "{size:?}\n{top}");
        let alarms = if size.0 < 160 { "1 crit 2 watch unack" } else { "1 crit (1 unacknowledged)" };
        assert!(top.contains(alarms), "{size:?}\n{top}");
    }
}

#[test]
fn a_notice_stands_beside_the_keys_if_it_fits_and_is_kept() {
    let mut screen = Screen::held();
    screen.send(Msg::Notice { severity: Severity::Info, text: "preset saved".into() });
    for size in SIZES {
        screen.send(Msg::Resize { width: size.0, height: size.1 });
        let shown = text(&drawn(&screen.model, RICH, size));
        let last = shown.lines().last().unwrap_or_default();
        assert!(last.contains("space resume…") && last.trim_end().ends_with("Preset saved"), "{last}");
    }
    screen.pass(3.5);
    assert_eq!(screen.model.notice(), None);
    let kept = screen.model.console.messages.back().map(|message| message.text.as_str());
    assert_eq!(kept, Some("preset saved"));
}

#[test]
fn the_screens_own_key_comes_first_and_nothing_is_offered_that_is_pointless() {
    let keys = |screen: &Screen| {
        let shown = text(&drawn(&screen.model, PLAIN, (120, 36)));
        shown.lines().last().unwrap_or_default().to_owned()
    };
    let mut screen = Screen::idle();
    screen.model.ui.go(Name::Plan);
    assert!(keys(&screen).starts_with(" S start"), "{}", keys(&screen));
    screen.model.ui.go(Name::Home);
    assert!(!keys(&screen).contains('<'), "{}", keys(&screen));
    let mut screen = Screen::running();
    screen.model.ui.go(Name::Alarms);
    assert!(keys(&screen).starts_with(" space HOLD  a ack"), "{}", keys(&screen));
}

#[test]
fn the_pane_with_the_focus_is_marked_without_colour() {
    let mut screen = Screen::running();
    let marked = |screen: &Screen| {
        let shown = text(&drawn(&screen.model, PLAIN, (120, 36)));
        shown.lines().filter(|line| line.contains('▸')).map(str::to_owned).collect::<Vec<_>>()
    };
    assert!(marked(&screen)[0].contains("▸ Map"), "{:?}", marked(&screen));
    screen.press([Key::Tab]);
    assert!(marked(&screen)[0].contains("▸ Events") && marked(&screen).len() == 1, "{:?}", marked(&screen));
}

#[test]
fn the_name_of_the_scenario_is_whole_and_the_unused_station_is_marked_at_every_size() {
    for begun in [Screen::running, Screen::held, || ended().0] {
        let mut screen = begun();
        let name = "cover-unknown-columns";
        if let Some(about) = &mut screen.model.live.run.about {
            name.clone_into(&mut about.scenario);
        }
        for size in SIZES {
            screen.send(Msg::Resize { width: size.0, height: size.1 });
            for caps in [RICH, PLAIN] {
                let shown = text(&drawn(&screen.model, caps, size));
                let top = shown.lines().next().unwrap_or_default();
                assert!(
                    top.contains(name) && top.contains("T+00:16:07") && top.contains('2'),
                    "{size:?}\n{top}"
                );
                let is_map = screen.model.ui.screen == Name::Mission;
                assert!(!is_map || shown.contains("S4!") && !shown.contains("S1!"), "{size:?}\n{shown}");
            }
        }
    }
}
