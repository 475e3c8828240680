//! Laws that hold for every screen.

use crate::fixture::{ASCII, PLAIN, RICH, Screen, choice, of_run, planner};
use crate::replay::replaying;
use crate::screens::{drawn_as_is as drawn, text};
use mission::{AskId, Event, EventKind, HoldReason, Order, Outcome, Resumes, Severity, WorkerId};
use proptest::prelude::*;
use ratatui::Terminal;
use ratatui::backend::TestBackend;
use ratatui::style::Style;
use tui::actions::ACTIONS;
use tui::{
    Cache, Caps, Effect, Health, Key, KeyPress, Measured, Model, Mouse, Msg, Recording, RunMsg, Signal,
    Target, Times, view_cached,
};
use world::Point;

fn key() -> impl Strategy<Value = Key> {
    prop_oneof![
        6 => prop::sample::select(" SX.P<>pa:?qzZ0ifLm/hjklgGeq1369xyz[]{}(),^$bBnNDTcs\u{7}é漢".chars().collect::<Vec<_>>()).prop_map(Key::Char),
        2 => prop::sample::select(vec![Key::Enter, Key::Esc, Key::Tab, Key::BackTab, Key::Backspace, Key::Delete]),
        2 => prop::sample::select(vec![Key::Up, Key::Down, Key::Left, Key::Right, Key::CtrlLeft, Key::CtrlRight, Key::PageUp, Key::PageDown, Key::Home, Key::End]),
        1 => prop::sample::select("cpzudlw".chars().collect::<Vec<_>>()).prop_map(Key::Ctrl),
        1 => (1..13_u8).prop_map(Key::F),
    ]
}

/// Events of a whole mission in any order, with wild times.
fn event() -> impl Strategy<Value = Event> {
    let events: Vec<Event> = {
        let mut screen = Screen::idle();
        let mission = &mut screen.mission;
        let mut events = mission.opening();
        events.extend(mission.start());
        events.extend(mission.drive(40));
        events.push(mission.excluded());
        events.extend(mission.planner_fails());
        for by in [HoldReason::Operator, HoldReason::Stepped, HoldReason::PositionLost] {
            events.push(mission.held(by));
        }
        let message = || "no return path".to_owned();
        events.extend([
            mission.held_until(HoldReason::PositionLost, Resumes::WhenCleared),
            mission.held_until(HoldReason::Tether { message: message() }, Resumes::WhenCleared),
            mission.held_until(HoldReason::PlanRefused { message: message() }, Resumes::Never),
            mission.held_until(HoldReason::PlannerFault { message: message() }, Resumes::ByFallback),
        ]);
        for order in [Order::Hold, Order::Resume, Order::Step, Order::Abort, Order::FlyUncertified] {
            events.extend(mission.obeyed(order));
        }
        let ask = AskId { worker: WorkerId(3), n: 7 };
        let lone = [
            EventKind::Resumed,
            EventKind::PositionLost { error_m: f64::NAN, limit_m: 0.0 },
            EventKind::PositionRegained { error_m: f64::INFINITY },
            EventKind::ObstacleFound { obstacle: crate::fixture::found() },
            EventKind::Scalars { scalars: vec![("x".into(), f64::NAN, String::new()); 40] },
            EventKind::Covered { runs: vec![world::CellRun(u32::MAX, u32::MAX), world::CellRun(0, 900)] },
            EventKind::OrderRefused { order: Order::Resume, why: "no".repeat(200) },
            EventKind::OrderRefused { order: Order::Hold, why: "no".into() },
            EventKind::RangesInconsistent { chi2: f64::NAN, degrees_of_freedom: 0 },
            EventKind::RangesConsistent,
            EventKind::PlannerPrepared {
                ask,
                choice: choice("apf"),
                info: Box::new(planner("apf", "1.2", "of no use")),
            },
            EventKind::PlannerRejected { planner: "漢字".repeat(40), why: "no".repeat(200) },
            EventKind::PlannerLate { planner: "rpf".into(), ticks: u64::MAX },
            EventKind::Snapshotted { ask, bytes: u64::MAX },
            EventKind::Discarded { ask, plan: None },
        ];
        events.extend(lone.into_iter().map(|kind| mission.now(kind)));
        events.push(mission.ended(Outcome::Stuck, "漢字".repeat(40).as_str()));
        events
    };
    (prop::sample::select(events), prop_oneof![0.0..1e4_f64, Just(f64::NAN), Just(f64::INFINITY), Just(-5.0)])
        .prop_map(|(event, t_s)| Event { t_s, ..event })
}

fn msg() -> impl Strategy<Value = Msg> {
    let recording =
        prop::sample::select(vec![Recording::On, Recording::Off, Recording::Failed("full".into())]);
    let signal = prop::sample::select(vec![
        Signal::Interrupt,
        Signal::Terminate,
        Signal::Hangup,
        Signal::End(3),
        Signal::Stop,
        Signal::Continue,
    ]);
    prop_oneof![
        8 => (key(), any::<bool>(), prop::option::of(0..9_u64))
            .prop_map(|(key, repeat, seen)| Msg::Key(KeyPress { repeat, seen, ..key.into() })),
        1 => Just(Msg::Stop),
        1 => (0..9_u64).prop_map(Msg::Drawn),
        4 => prop::collection::vec(event(), 0..6).prop_map(|events| of_run(RunMsg::Events(events))),
        1 => (0..300_u16, 0..100_u16).prop_map(|(width, height)| Msg::Resize { width, height }),
        1 => any::<f64>().prop_map(|mono_s| Msg::Time(Times { mono_s, wall_unix_s: mono_s })),
        1 => "\\PC{0,90}".prop_map(Msg::Paste),
        1 => (recording, prop::option::of(any::<f64>()), any::<u64>())
            .prop_map(|(recording, reached_speed, recorder_lag)| of_run(RunMsg::Health(Health { recording, reached_speed, recorder_lag }))),
        1 => (prop::option::of(any::<f64>()), any::<u32>())
            .prop_map(|(response_ms, skipped)| Msg::Measured(Measured::Screen { response_ms, skipped })),
        1 => any::<u64>().prop_map(|bytes| Msg::Measured(Measured::Disk(bytes))),
        1 => "\\PC{0,90}".prop_map(|text| Msg::Notice { severity: Severity::Crit, text }),
        1 => prop::option::of(("[a-z]{0,9}", prop::option::of(0.0..99.0_f64))).prop_map(|busy| of_run(RunMsg::Busy(busy))),
        1 => (any::<f64>(), "\\PC{0,90}").prop_map(|(share, what)| of_run(RunMsg::BusyAt { share, what })),
        1 => prop::sample::select(vec![Order::Start, Order::Hold, Order::Resume])
            .prop_map(|order| of_run(RunMsg::OrderFailed { order, why: "the engine has ended".into() })),
        1 => signal.prop_map(Msg::Signal),
        2 => mouse().prop_map(Msg::Mouse),
    ]
}

fn mouse() -> impl Strategy<Value = Mouse> {
    let place = || {
        (-20.0..20.0_f64, prop_oneof![4 => -20.0..20.0_f64, 1 => Just(f64::NAN)])
            .prop_map(|(x, y)| Point::new(x, y))
    };
    let key = prop::sample::select(ACTIONS.to_vec()).prop_map(|action| Target::Key(action.id));
    let target = || prop_oneof![place().prop_map(Target::Map), Just(Target::Else)];
    prop_oneof![
        2 => prop_oneof![target(), key].prop_map(Mouse::Click),
        1 => (place(), place()).prop_map(|(from, to)| Mouse::Drag { from, to }),
        1 => (any::<bool>(), target()).prop_map(|(up, on)| Mouse::Wheel { up, on }),
    ]
}

/// What most changes which orders are accepted.
fn turn() -> impl Strategy<Value = Msg> {
    let mission = Screen::idle().mission;
    let tether = || HoldReason::Tether { message: "no return path".into() };
    let refused = || HoldReason::PlanRefused { message: "not certified".into() };
    let one = |kind| vec![mission.now(kind)];
    let turns = vec![
        one(EventKind::Resumed),
        one(EventKind::PositionLost { error_m: 0.5, limit_m: 0.15 }),
        one(EventKind::PositionRegained { error_m: 0.1 }),
        vec![mission.held_until(tether(), Resumes::WhenCleared)],
        vec![mission.held_until(refused(), Resumes::ByFallback)],
        vec![mission.held(refused())],
        mission.obeyed(Order::Hold),
        mission.obeyed(Order::Resume),
        vec![mission.ended(Outcome::Complete, "task complete")],
    ];
    prop::sample::select(turns).prop_map(|events| of_run(RunMsg::Events(events)))
}

/// Messages from an operator who tries every action and often confirms.
fn deed() -> impl Strategy<Value = Vec<Msg>> {
    let press = |key: Key| Msg::Key(key.into());
    let keys = prop::sample::select(vec![
        "S",
        " ",
        ".",
        "P",
        "p",
        "X",
        "q",
        ":resume",
        ":fly-unc",
        ":step",
        ":start",
        "e",
        "1",
        "2",
        "3",
        "4",
        ":planner apf",
        ":set rpf_gain=1",
        ":speed 4",
        ":goto plan",
        ":open demo",
    ]);
    prop_oneof![
        4 => keys.prop_map(move |keys| keys.chars().map(Key::Char).map(press).collect()),
        4 => Just(vec![press(Key::Enter)]),
        1 => Just(vec![press(Key::Esc)]),
        2 => prop::sample::select(vec![Key::Up, Key::Down]).prop_map(move |key| vec![press(key)]),
        1 => Just(vec![press(Key::Char('p')), press(Key::Down), press(Key::Down), press(Key::Down), press(Key::Enter)]),
        1 => msg().prop_map(|msg| vec![msg]),
        4 => turn().prop_map(|msg| vec![msg]),
    ]
}

/// Whether the mission answered HOLD in these events.
fn answers_hold(msg: &Msg) -> bool {
    let kind = |event: &Event| match &event.kind {
        EventKind::Ordered { order } | EventKind::OrderRefused { order, .. } => *order == Order::Hold,
        EventKind::Ended { .. } => true,
        _ => false,
    };
    match msg {
        Msg::Run(_, RunMsg::Events(events)) => events.iter().any(kind),
        Msg::Run(_, RunMsg::OrderFailed { order, .. }) => *order == Order::Hold,
        _ => false,
    }
}

/// Whether a robot that is held stays held, whatever else the order changes.
fn is_harmless(order: &Order) -> bool {
    matches!(
        order,
        Order::Hold
            | Order::SetParameter { .. }
            | Order::UseStation { .. }
            | Order::Note(_)
            | Order::Shadow(_)
            | Order::DropShadow
    )
}

fn caps() -> impl Strategy<Value = Caps> {
    prop::sample::select(vec![RICH, PLAIN, ASCII])
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(160))]

    #[test]
    fn no_messages_and_no_size_make_the_screen_fail(
        msgs in prop::collection::vec(msg(), 0..40),
        start in 0..5_u8,
        caps in caps(),
        size in (0..300_u16, 0..100_u16),
    ) {
        let mut screen = if start == 1 { Screen::held() } else { Screen::idle() };
        match start {
            2 => screen.model = Model::default(),
            3 | 4 => screen = replaying(start == 4),
            _ => {}
        }
        for msg in msgs {
            screen.send(msg);
        }
        let buffer = drawn(&screen.model, caps, size);
        prop_assert_eq!((buffer.area.width, buffer.area.height), size);
        prop_assert!(caps != ASCII || buffer.content.iter().all(|cell| cell.symbol().is_ascii()));
    }

    #[test]
    fn every_order_is_one_that_the_mission_accepts_or_that_follows_a_hold(
        deeds in prop::collection::vec(deed(), 0..60),
        start in 0..3_u8,
    ) {
        let mut screen = match start {
            0 => Screen::idle(),
            1 => Screen::held(),
            _ => Screen::running(),
        };
        let mut follows_hold = false;
        for msg in deeds.into_iter().flatten() {
            follows_hold &= !answers_hold(&msg);
            let effects = screen.send(msg);
            // No key changes it, and what events lead to follows from what they changed.
            let standing = screen.model.live.run.standing.clone();
            for effect in effects {
                let Effect::Order(order) = effect else { continue };
                match order {
                    Order::Hold => follows_hold = true,
                    Order::Abort => {}
                    // While a HOLD has not been answered, no order that moves the robot is sent in the
                    // belief that the robot is held.
                    Order::ChoosePlanner(_) if follows_hold => {}
                    order => {
                        prop_assert_eq!(standing.standing().allows(&order), Ok(()), "{:?} in {:?}", order, standing.phase);
                        // Orders are carried out in sequence: after an order that does not move the
                        // robot, the robot stays held.
                        follows_hold &= is_harmless(&order);
                    }
                }
            }
        }
    }

    #[test]
    fn no_click_makes_a_robot_move_or_ends_its_mission(
        did in prop::collection::vec((mouse(), prop::option::of(turn())), 0..60),
        start in 0..3_u8,
    ) {
        let mut screen = match start {
            0 => Screen::idle(),
            1 => Screen::held(),
            _ => Screen::running(),
        };
        screen.model.ui.mouse = true;
        for (mouse, turn) in did {
            if let Some(turn) = turn {
                screen.send(turn);
            }
            for effect in screen.send(Msg::Mouse(mouse)) {
                let Effect::Order(order) = &effect else { continue };
                // A planner that is opened or that plans before the start moves nothing.
                let waits = screen.model.live.waits() && matches!(order, Order::Plan | Order::ChoosePlanner(_));
                let moves = !waits && !is_harmless(order);
                prop_assert!(!moves, "{mouse:?}: {effect:?}");
            }
            screen.model.ui.mouse = true;
        }
    }

    #[test]
    fn a_warm_cache_draws_the_same_cells_as_a_cold_one(
        msgs in prop::collection::vec(msg(), 0..24),
        size in (60..220_u16, 16..70_u16),
    ) {
        let mut screen = Screen::plated();
        screen.type_text("zz");
        let mut cache = Cache::default();
        for msg in msgs {
            screen.send(msg);
            let mut terminal = Terminal::new(TestBackend::new(size.0, size.1)).unwrap();
            terminal.draw(|frame| view_cached(&screen.model, &RICH, &mut cache, frame)).unwrap();
            prop_assert_eq!(terminal.backend().buffer(), &drawn(&screen.model, RICH, size));
        }
    }

    #[test]
    fn no_key_but_enter_or_a_step_in_its_line_makes_a_held_robot_move(
        keys in prop::collection::vec(key().prop_filter("agrees", |key| !matches!(key, Key::Enter | Key::Char('.'))), 0..30),
    ) {
        let mut screen = Screen::held();
        for key in keys {
            let moves = screen.press([key]).into_iter().any(|effect| {
                matches!(effect, Effect::Order(Order::Start | Order::StartPlan(_) | Order::Resume | Order::Step | Order::ChoosePlanner(_)))
            });
            prop_assert!(!moves, "{key} moved the robot");
        }
    }
}

#[test]
fn the_smallest_and_largest_screens_are_drawn() {
    for (width, height) in
        [(0, 0), (1, 1), (0, 9), (9, 0), (3, 2), (24, 7), (59, 16), (60, 15), (80, 24), (300, 100)]
    {
        let screens: [fn() -> Screen; 4] =
            [Screen::idle, Screen::running, || replaying(false), || replaying(true)];
        for make in screens {
            let mut screen = make();
            for keys in [
                "",
                "6",
                "3D",
                "b",
                "?",
                ":z",
                "P",
                "p",
                "L",
                "/x",
                "q",
                "S",
                "X",
                "4",
                "4d15;x",
                "5",
                "5/sevv>=x",
            ] {
                screen.type_text(keys);
                drawn(&screen.model, RICH, (width, height));
                screen.press([Key::Esc]);
            }
        }
    }
}

#[test]
fn nothing_but_style_is_lost_without_colour() {
    let mut lost = Screen::running();
    let event = lost.mission.now(EventKind::PositionLost { error_m: 0.5, limit_m: 0.15 });
    let held = lost.mission.held(HoldReason::PositionLost);
    lost.hear(RunMsg::Events(vec![event, held]));
    let mut failed = Screen::running();
    let events = failed.mission.planner_fails();
    failed.hear(RunMsg::Events(events));
    let mut unrecorded = Screen::running();
    unrecorded
        .hear(RunMsg::Health(Health { recording: Recording::Failed("full".into()), ..Health::default() }));
    let cases: Vec<(&str, Screen, &[&str])> = vec![
        ("idle", Screen::idle(), &["■ IDLE", "REC●", "Press S"]),
        ("running", Screen::running(), &["▶ RUN", "2 watch", "rejected: 0.42", "found"]),
        ("held", Screen::held(), &["‖ HOLD", "HELD by operator"]),
        ("lost", lost, &["‖ HOLD", "LOST", "1 crit", "CRIT"]),
        ("failed", failed, &["‖ HOLD", "FAILED", "1 crit", "CRIT"]),
        ("unrecorded", unrecorded, &["REC✗", "1 crit", "recording failed"]),
    ];
    for (name, screen, words) in cases {
        for size in [(80, 24), (120, 36)] {
            let mut buffer = drawn(&screen.model, PLAIN, size);
            let area = buffer.area;
            buffer.set_style(area, Style::reset());
            let text = text(&buffer);
            for word in words {
                let wide = size.0 >= 120;
                let word = match *word {
                    "found" if !wide => "?",
                    word => word,
                };
                assert!(text.contains(word), "{word} is missing on {name} at {size:?}\n{text}");
            }
        }
    }
}

#[test]
fn what_is_drawn_does_not_grow_with_the_mission() {
    let mut screen = Screen::running();
    let events = screen.mission.wait(200_000);
    screen.hear(RunMsg::Events(events));
    assert!(screen.model.live.run.trail.points().len() <= 2048);
    let seconds = tui::model::history::HISTORY_S;
    assert!(screen.model.live.run.position.history_m.since(0.0).count() <= seconds);
    for i in 0..120_000 {
        screen.send(Msg::Notice { severity: Severity::Info, text: format!("line {i}") });
    }
    assert!(screen.model.live.run.log.len() < tui::model::log::MAX_LINES + 1024);
}
