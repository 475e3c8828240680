//! The command line: what it finds, completes, refuses and runs.

use crate::fixture::{RICH, Screen, choice, listed};
use crate::screens::{drawn, text};
use mission::{Injection, Order, ParamValue, RangeFault, Severity, ZoneCost};
use ratatui::Terminal;
use ratatui::backend::TestBackend;
use tui::model::ui::{Ask, MapLayer};
use tui::model::{Overlay, Palette, Pane, PastRun, Screen as Name, home::Found};
use tui::update::{Choice, choices};
use tui::{Effect, Job, Key, Msg, Query, RunId, RunMsg, Source, Speed, ThemeName};
use world::{Point, StationId};

/// A screen with scenarios and runs.
fn with_home(mut screen: Screen) -> Screen {
    let run = |name: &str| PastRun {
        name: name.into(),
        began: String::new(),
        scenario: "demo".into(),
        planner: String::new(),
        end: "complete".into(),
        began_unix_s: None,
        verified: None,
        mission_time_s: None,
        reachable: None,
        note: None,
        remark: None,
        bookmarks: 0,
    };
    let found = Found {
        scenarios: vec![
            listed("cover-circle", None),
            listed("demo", None),
            listed("two words", None),
            listed("bad", Some("no")),
        ],
        runs: vec![run("20261122T1-demo"), run("20261121T2-demo"), run("20261121T1-demo")],
        ..Found::default()
    };
    screen.send(Msg::Found(Box::new(found)));
    screen
}

fn offers(screen: &mut Screen, typed: &str) -> Vec<String> {
    screen.press([Key::Esc, Key::Char(':')]);
    screen.type_text(typed);
    let Overlay::Commands(palette) = &screen.model.ui.overlay else { panic!("the line is open") };
    let name = |choice| match choice {
        Choice::Command(action) => action.name.to_owned(),
        Choice::Alias(name, _) | Choice::Value(name) => name,
    };
    choices(&screen.model, palette).into_iter().map(name).collect()
}

/// The effects of a command line, which must be accepted.
fn run(screen: &mut Screen, line: &str) -> Vec<Effect> {
    screen.press([Key::Esc, Key::Char(':')]);
    screen.type_text(line);
    let effects = screen.press([Key::Enter]);
    assert_eq!(fault(screen), None, "{line}");
    effects
}

fn fault(screen: &Screen) -> Option<(String, String)> {
    let Overlay::Commands(palette) = &screen.model.ui.overlay else { return None };
    let fault = palette.fault.as_ref()?;
    Some((palette.line.text().get(fault.at.clone()).unwrap_or_default().to_owned(), fault.what.clone()))
}

#[test]
fn what_is_typed_finds_what_is_meant_first() {
    let running = [
        ("stop", "hold"),
        ("pause", "hold"),
        ("halt", "hold"),
        ("quit", "leave"),
        ("exit", "leave"),
        ("abort", "end"),
        ("finish", "end"),
        ("rate", "speed"),
        ("pace", "speed"),
        ("silence", "acknowledge"),
        ("h", "hold"),
        ("z", "zoom-in"),
        ("zo", "zoom-in"),
        ("zoom out", "zoom-out"),
        ("pan e", "pan-east"),
        ("events", "events"),
        ("sp", "speed"),
    ];
    for (typed, first) in running {
        assert_eq!(offers(&mut Screen::running(), typed).first().map(String::as_str), Some(first), "{typed}");
    }
    assert_eq!(offers(&mut Screen::held(), "continue").first().map(String::as_str), Some("resume"));
}

#[test]
fn what_moves_the_robot_is_found_by_its_names_only_and_after_what_is_safe() {
    for typed in ["mission", "robot", "certified", "tether", "uncert"] {
        for name in offers(&mut Screen::held(), typed) {
            let action = tui::actions::find::named(&name).expect("a command");
            assert_eq!(action.risk, tui::actions::Risk::Safe, "{name} for {typed}");
        }
    }
    let found = offers(&mut Screen::held(), "re");
    let place = |name: &str| found.iter().position(|other| other == name).unwrap_or_else(|| panic!("{name}"));
    assert!(place("redraw") < place("resume"), "{found:?}");
}

#[test]
fn a_command_that_was_used_comes_before_its_like() {
    let mut screen = Screen::running();
    assert_eq!(offers(&mut screen, "pan")[0], "pan-west");
    screen.type_text("z");
    screen.press([Key::Esc, Key::Char('z')]);
    run(&mut screen, "pan-south");
    assert_eq!(offers(&mut screen, "pan")[0], "pan-south");
}

#[test]
fn commands_take_values() {
    let speed = |factor| vec![Effect::Speed(Speed::Times(factor))];
    assert_eq!(run(&mut Screen::running(), "speed 8"), speed(8.0));
    assert_eq!(run(&mut Screen::running(), "pace x0.5"), speed(0.5));
    assert_eq!(run(&mut Screen::running(), "speed max"), [Effect::Speed(Speed::Max)]);
    let key = "rpf_gain".to_owned();
    let set = Effect::Order(Order::SetParameter { key, value: ParamValue::Float(1.5) });
    let mut screen = Screen::held();
    assert!(
        matches!(run(&mut screen, "set rpf_gain=1.5")[..], [Effect::Forecast(_)]),
        "its effect comes first"
    );
    assert_eq!(screen.press([Key::Enter]), [set, Effect::StopForecasting]);
    let open = |planner| {
        vec![Effect::Open {
            id: RunId(2),
            source: Source::File("cover-circle.toml".into()),
            planner,
            speed: Speed::default(),
        }]
    };
    assert_eq!(run(&mut with_home(Screen::idle()), "open cover-circle"), open(None));
    assert_eq!(
        run(&mut with_home(Screen::idle()), "open cover-circle planner=apf"),
        open(Some(choice("apf")))
    );
    let verify = |name: &str| vec![Effect::Do(Job::Verify(name.into()))];
    assert_eq!(run(&mut with_home(Screen::running()), "verify latest"), verify("20261122T1-demo"));
    assert_eq!(run(&mut with_home(Screen::running()), "verify 20261121T2"), verify("20261121T2-demo"));
    let mut screen = Screen::held();
    let both = vec![choice("rpf"), choice("apf")];
    assert_eq!(run(&mut screen, "planner apf"), [Effect::Forecast(both)], "its effect is shown");
    assert_eq!(screen.model.ui.overlay, Overlay::Confirm(Ask::Swap(choice("apf"))), "it asks first");
    let mut screen = Screen::held();
    run(&mut screen, "theme light");
    assert_eq!(screen.model.ui.theme, ThemeName::Light);
    run(&mut screen, "layers robot-trail");
    assert!(!screen.model.ui.layers.shows(MapLayer::Trail));
    run(&mut screen, "centre C2");
    assert_eq!(screen.model.ui.map.offset, world::Vector::new(-4.0, 3.0));
    run(&mut screen, "severity warn");
    assert_eq!(screen.model.ui.events.matches.filter().least(), Severity::Warn);
    run(&mut screen, "filter \"position lost\"");
    assert_eq!(screen.model.ui.needle, "position lost");
    run(&mut screen, "goto plan");
    assert_eq!(screen.model.ui.screen, Name::Plan);
}

#[test]
fn a_wrong_value_is_underlined_with_what_would_be_right() {
    let cases = [
        ("speed 900", "900", "must be 0.25 to 64, or max"),
        ("speed", " ", "usage: speed FACTOR"),
        ("set rpf_gain=9", "rpf_gain=9", "9 is out of range; allowed: 0.2 to 4 m3/s"),
        ("set rpf_gian=1", "rpf_gian=1", "no parameter `rpf_gian`; did you mean rpf_gain?"),
        ("set 3", "3", "write KEY=VALUE, such as k_rep=2"),
        ("planner rfp", "rfp", "no planner `rfp`; did you mean rpf?"),
        ("theme pink", "pink", "no theme `pink`; choose from: dark, light, contrast"),
        ("goto misson", "misson", "no screen `misson`; did you mean mission?"),
        ("open demmo", "demmo", "no scenario `demmo`; did you mean demo?"),
        ("open demo seed=3", "seed=3", "no planner `seed=3`; choose from: apf, rpf, spiral-tangent"),
        ("open demo planner=x", "planner=x", "no planner `x`; choose from: apf, rpf, spiral-tangent"),
        ("verify 20261121", "20261121", "2 runs match: 20261121T2-demo, 20261121T1-demo..."),
        ("verify 1999", "1999", "no run begins with `1999`"),
        ("filter \"lost", "\"lost", "missing closing quote"),
        ("shelve 15", "15", "invalid duration `15`; write 20s, 15m or 1h30m"),
        (
            "shelve 15m noise alarm=pump",
            "alarm=pump",
            "no alarm `pump`; choose from: \"new obstacle, not on drawing\", \"station S4 rejected\"",
        ),
        ("inject S9 dead 20s", "S9", "no station `S9`; did you mean S1?"),
        ("inject S3 dead", "", "usage: inject STATION FAULT TIME"),
        ("no-go 1,2", "", "usage: no-go CORNER OPPOSITE"),
        ("no-go 1,2 3", "3", "invalid corner `3`; write x and y in metres, such as -1.5,2"),
        (
            "inject S3 noise 20s",
            "noise",
            "unknown fault `noise`; write dead (silent) or offset=2.5 (ranges 2.5 m too long; at most 1000)",
        ),
        ("hodl", "hodl", "no such command; did you mean hold?"),
    ];
    for (line, at, what) in cases {
        let mut screen = with_home(Screen::held());
        screen.press([Key::Char(':')]);
        screen.type_text(line);
        let effects = screen.press([Key::Enter]);
        if line == "speed" {
            // A command that needs a value waits for it first.
            assert_eq!(fault(&screen), None);
            screen.press([Key::Enter]);
        }
        assert_eq!((effects, fault(&screen)), (vec![], Some((at.into(), what.into()))), "{line}");
        screen.press([Key::Ctrl('u')]);
        assert_eq!(fault(&screen), None, "a new line is begun");
    }
    let mut screen = Screen::held();
    screen.type_text(":speed 900");
    screen.press([Key::Enter]);
    let shown = text(&drawn(&screen.model, RICH, (80, 24)));
    let lines: Vec<&str> = shown.lines().collect();
    let at = lines.iter().position(|line| line.contains("> speed 900")).expect("the line");
    assert_eq!(lines[at].find("900"), lines[at + 1].find("^^^"), "{shown}");
    assert!(lines[at + 2].contains("Must be 0.25 to 64, or max"), "{shown}");
}

#[test]
fn tab_completes_names_and_values() {
    let cases = [
        ("spe", "speed "),
        ("thm", "thm"),
        ("theme l", "theme light"),
        ("planner sp", "planner spiral-tangent"),
        ("set rpf_g", "set rpf_gain="),
        ("set mode=l", "set mode=literal"),
        ("open c", "open cover-circle"),
        ("open two", "open \"two words\""),
        ("open demo planner=a", "open demo planner=apf"),
        ("verify l", "verify latest"),
        ("goto p", "goto plan"),
        ("inject S", "inject S1"),
        ("inject S1 d", "inject S1 dead"),
        ("inject S1 dead 2", "inject S1 dead 20s"),
        ("shelve 15m noise alarm=\"st", "shelve 15m noise alarm=\"station S4 rejected\""),
        ("exclude S", "exclude S1"),
    ];
    for (typed, completed) in cases {
        let mut screen = with_home(Screen::held());
        screen.press([Key::Char(':')]);
        screen.type_text(typed);
        screen.press([Key::Tab]);
        let Overlay::Commands(palette) = &screen.model.ui.overlay else { panic!("the line is open") };
        assert_eq!(palette.line.text(), completed, "{typed}");
    }
}

#[test]
fn a_no_go_zone_is_a_box_between_two_corners() {
    let mut screen = Screen::running();
    let corners = [(-1.5, 0.5), (2.0, 0.5), (2.0, 3.0), (-1.5, 3.0)].map(|(x, y)| Point::new(x, y));
    let asked = run(&mut screen, "no-go 2,0.5 -1.5,3");
    assert_eq!(asked, [Effect::Ask(Query::ZoneCost(corners.to_vec()))], "its cost comes first");
    assert_eq!(screen.press([Key::Enter]), [], "the cost is not known yet");
    run(&mut screen, "no-go 2,0.5 -1.5,3");
    let cost = ZoneCost { path_m: 12.34, closed_m2: 6.1, lost_m2: 4.2, ..ZoneCost::default() };
    screen.hear(RunMsg::ZoneCost(corners.to_vec(), Ok(cost)));
    let shown = text(&drawn(&screen.model, RICH, (120, 36)));
    assert!(shown.contains("Close this floor?") && shown.contains("12.3 m of the plan"), "{shown}");
    assert_eq!(screen.press([Key::Enter]), [Effect::Order(Order::DrawZone(corners.to_vec()))]);
}

#[test]
fn a_station_of_the_simulation_fails_on_order_with_the_name_of_who_ordered_it() {
    let mut screen = Screen::running();
    screen.model.console.preferences.operator = Some("lk".into());
    let inject = |station, fault, for_s| {
        let by = Some("lk".into());
        vec![Effect::Order(Order::Inject(Injection { station: StationId(station), fault, for_s, by }))]
    };
    assert_eq!(run(&mut screen, "inject ae.S3 dead 20s"), inject(3, RangeFault::Dead, 20.0));
    assert_eq!(run(&mut screen, "inject S2 offset=2.5 1m"), inject(2, RangeFault::Offset(2.5), 60.0));
    let mut waiting = Screen::idle();
    assert_eq!(run(&mut waiting, "inject S3 dead 20s"), []);
    let said = waiting.model.notice().expect("a refusal").text.clone();
    assert_eq!(said, "the mission has not been started; S: start");
}

#[test]
fn a_station_is_excluded_and_taken_back() {
    let order = |used| vec![Effect::Order(Order::UseStation { station: StationId(4), used, by: None })];
    for state in [Screen::running, Screen::held] {
        let mut screen = state();
        assert_eq!(run(&mut screen, "exclude S4"), order(false));
        assert_eq!(run(&mut screen, "include S4"), order(true));
    }
}

#[test]
fn a_wrong_value_is_explained_while_it_is_typed_and_a_value_that_may_become_right_is_not() {
    let mut screen = with_home(Screen::held());
    let mut typed = |line: &str| {
        screen.press([Key::Esc, Key::Char(':')]);
        screen.type_text(line);
        fault(&screen).map(|(word, _)| word)
    };
    let wrong = [
        ("speed 99", "99"),
        ("planner xyz", "xyz"),
        ("no-go 1,1 x", "x"),
        ("no-go a 2,2", "a"),
        ("inject S2 offset=x", "offset=x"),
        ("inject S9 dead 20s", "S9"),
        ("goto nowhere", "nowhere"),
        ("theme dork ", "dork"),
    ];
    for (line, word) in wrong {
        assert_eq!(typed(line).as_deref(), Some(word), "{line}");
    }
    let may_be_right = [
        "speed",
        "speed ",
        "speed 0",
        "speed 0.",
        "speed 1",
        "speed m",
        "no-go ",
        "no-go -",
        "no-go 1",
        "no-go 1,",
        "no-go 1,1",
        "no-go 1,1 2,",
        "inject S2 off",
        "inject S2 offset=",
        "inject S2 offset=2.5",
        "inject S2 dead 2",
        "open cov",
        "verify 2026",
        "theme d",
        "filter \"position",
        "seek 0:",
        "spede 9",
    ];
    for line in may_be_right {
        assert_eq!(typed(line), None, "{line}");
    }
    // The values that are missing are named below the line.
    screen.press([Key::Esc, Key::Char(':')]);
    screen.type_text("no-go 1,1");
    for size in [(60, 16), (80, 24), (120, 36), (200, 60)] {
        screen.send(Msg::Resize { width: size.0, height: size.1 });
        let shown = text(&drawn(&screen.model, RICH, size));
        assert!(shown.contains("no-go CORNER OPPOSITE."), "{size:?}\n{shown}");
    }
    assert_eq!(screen.press([Key::Enter]), [], "Enter does nothing until the line is whole");
    assert!(fault(&screen).is_some_and(|(_, what)| what == "usage: no-go CORNER OPPOSITE"));
}

#[test]
fn enter_in_the_pane_of_the_stations_offers_the_command_for_the_selected_station() {
    let order = |used| vec![Effect::Order(Order::UseStation { station: StationId(2), used, by: None })];
    for size in [(60, 16), (80, 24), (120, 36), (200, 60)] {
        let mut screen = Screen::held();
        screen.send(Msg::Resize { width: size.0, height: size.1 });
        screen.press([Key::Char('3')]);
        for _ in 0..8 {
            if screen.model.ui.pane != Pane::Stations {
                screen.press([Key::Tab]);
            }
        }
        screen.press([Key::Down]);
        let shown = text(&drawn(&screen.model, RICH, size));
        assert!(shown.contains(">S2 ") && shown.contains("Enter exclude"), "{size:?}\n{shown}");
        assert_eq!(screen.press([Key::Enter]), [], "the first Enter gives no order");
        let Overlay::Commands(palette) = &screen.model.ui.overlay else { panic!("the line is open") };
        assert_eq!(palette.line.text(), "exclude S2");
        assert_eq!(screen.press([Key::Enter]), order(false), "{size:?}");
        let fix = screen.model.live.run.position.fix.as_mut().expect("a fix");
        fix.excluded = vec![(StationId(2), positioning::Exclusion::ByOrder)];
        screen.press([Key::Enter]);
        assert_eq!(screen.press([Key::Enter]), order(true), "{size:?}");
    }
}

#[test]
fn a_value_is_taken_from_the_list() {
    let mut screen = Screen::held();
    screen.type_text(":theme ");
    screen.press([Key::Down, Key::Enter]);
    assert_eq!((screen.model.ui.theme, &screen.model.ui.overlay), (ThemeName::Light, &Overlay::None));
}

#[test]
fn up_and_down_recall_what_was_run() {
    let mut screen = Screen::running();
    run(&mut screen, "speed 2");
    run(&mut screen, "speed 4");
    run(&mut screen, "speed 2");
    screen.press([Key::Char(':')]);
    let recalled = |screen: &mut Screen, key| {
        screen.press([key]);
        let Overlay::Commands(Palette { line, .. }) = &screen.model.ui.overlay else { panic!("open") };
        line.text().to_owned()
    };
    assert_eq!(recalled(&mut screen, Key::Up), "speed 2");
    assert_eq!(recalled(&mut screen, Key::Up), "speed 4", "each line once");
    assert_eq!(recalled(&mut screen, Key::Up), "speed 4", "there is nothing before");
    assert_eq!(recalled(&mut screen, Key::Down), "speed 2");
    assert_eq!(recalled(&mut screen, Key::Down), "");
    assert_eq!(recalled(&mut screen, Key::Down), "", "now it selects in the list");
}

#[test]
fn a_short_name_stands_for_its_line() {
    let mut screen = Screen::held();
    screen.model.console.keys.aliases.insert("night".into(), "theme dark".into());
    screen.model.ui.theme = ThemeName::Light;
    assert_eq!(offers(&mut screen, "nig"), ["night"]);
    run(&mut screen, "night");
    assert_eq!(screen.model.ui.theme, ThemeName::Dark);
}

#[test]
fn the_terminal_s_cursor_is_where_text_is_typed() {
    let cursor = |screen: &Screen| {
        let mut terminal = Terminal::new(TestBackend::new(80, 24)).expect("memory");
        terminal.draw(|frame| tui::view(&screen.model, &RICH, frame)).expect("memory");
        let at = terminal.get_cursor_position().expect("memory");
        let buffer = terminal.backend().buffer();
        let before: String = (0..at.x).map(|x| buffer[(x, at.y)].symbol()).collect();
        (terminal.backend().cursor_position() == at, before)
    };
    let mut screen = Screen::held();
    screen.type_text(":speed 8");
    assert!(cursor(&screen).1.ends_with("> speed 8"));
    screen.press([Key::Left]);
    assert!(cursor(&screen).1.ends_with("> speed "));
    screen.press([Key::Esc, Key::Char('/'), Key::Char('x')]);
    assert!(cursor(&screen).1.ends_with("Filter: x"));
    screen.press([Key::Enter, Key::Char('p'), Key::Enter, Key::End]);
    assert!(cursor(&screen).1.ends_with("rpf_gain = 1.2"), "{}", cursor(&screen).1);
}

#[test]
fn the_list_of_keys_counts_commands_and_not_headings() {
    let mut screen = Screen::running();
    screen.type_text("?");
    let n = choices(&screen.model, &Palette { help: true, ..Palette::default() }).len();
    let shown = text(&drawn(&screen.model, RICH, (120, 36)));
    let counts = shown.lines().filter(|line| line.contains(&format!(" of {n}"))).count();
    assert_eq!(counts, 1, "{n}: {shown}");
    let title = shown.lines().find(|line| line.contains("Keys and commands")).expect("a title");
    assert!(title.contains(&format!("of {n} ")), "{title}");
}

#[test]
fn a_planner_that_would_be_refused_is_not_offered_as_a_value() {
    let mut screen = Screen::held();
    let mut task = screen.model.live.run.about.take().expect("a mission");
    task.mission.task =
        mission::TaskConfig::Cover { anchor: Point::new(9.4, 0.0), regions: Vec::new(), tolerance_m: 0.2 };
    screen.model.live.run.about = Some(task);
    screen.model.console.planners[0].covers = true;
    let covers = screen.model.console.planners[0].id.clone();
    for command in ["planner", "shadow"] {
        let action = tui::actions::find::named(command).expect("a command");
        assert_eq!(tui::update::values(&screen.model, action), std::slice::from_ref(&covers), "{command}");
    }
}

#[test]
fn the_list_of_keys_says_why_a_command_is_not_possible_now() {
    let mut screen = Screen::running();
    screen.send(Msg::Resize { width: 120, height: 36 });
    screen.type_text(":start");
    let shown = text(&drawn(&screen.model, RICH, (120, 36)));
    let why = tui::update::offered(&screen.model, tui::actions::ActionId::Start).unwrap_err();
    assert!(
        shown.contains(&format!("Not now: {}", why.split(';').next().unwrap_or_default())),
        "{why}\n{shown}"
    );
}
