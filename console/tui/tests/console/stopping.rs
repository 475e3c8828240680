//! Every way to stop the robot, in every situation.

use crate::fixture::{RICH, Screen, choice};
use crate::screens::{drawn, text};
use mission::{Event, EventKind, Gait, Hold, HoldReason, Order, Outcome, ParamValue, Phase, Resumes};
use tui::actions::keymap::{Binding, Keymap};
use tui::model::ui::{Ask, Edit, Purpose, Shelving};
use tui::model::{Cause, Overlay, Palette, Pane};
use tui::{Effect, Key, Model, Msg, RunMsg, Signal, Speed, update};

const HOLD: Effect = Effect::Order(Order::Hold);

fn phases() -> Vec<Phase> {
    let held = HoldReason::every("why").into_iter().flat_map(|by| {
        [Resumes::Never, Resumes::WhenCleared, Resumes::ByFallback]
            .map(|resumes| Phase::Held(Hold { by: by.clone(), resumes }))
    });
    let outcomes = [
        Outcome::Complete,
        Outcome::Stuck,
        Outcome::Collision,
        Outcome::TimeLimit,
        Outcome::Entangled,
        Outcome::Aborted,
    ];
    [
        Phase::Waiting,
        Phase::Running(Gait::Steady),
        Phase::Running(Gait::OneTick),
        Phase::Running(Gait::To(mission::StepTo::LaneEnd)),
        Phase::Running(Gait::Back),
    ]
    .into_iter()
    .chain(held)
    .chain(outcomes.map(Phase::Ended))
    .collect()
}

fn positions(screen: &Screen) -> [Option<Event>; 3] {
    let lost = EventKind::PositionLost { error_m: 0.5, limit_m: 0.15 };
    let alarmed = EventKind::RangesInconsistent { chi2: 90.0, degrees_of_freedom: 2 };
    [None, Some(screen.mission.now(lost)), Some(screen.mission.now(alarmed))]
}

fn overlays() -> Vec<Overlay> {
    let commands = |help| Overlay::Commands(Palette { help, ..Palette::begun("resume") });
    let edit = Some(Edit { line: "1".into(), refusal: None });
    let all = vec![
        Overlay::None,
        Overlay::Confirm(Ask::Start(None)),
        Overlay::Confirm(Ask::Resume),
        Overlay::Confirm(Ask::FlyUncertified),
        Overlay::Confirm(Ask::Swap(choice("apf"))),
        Overlay::Confirm(Ask::Promote),
        Overlay::Confirm(Ask::TakePlan),
        Overlay::Confirm(Ask::DriveBack),
        Overlay::Confirm(Ask::DrawZone(Vec::new())),
        Overlay::Confirm(Ask::Set { key: "order".into(), value: ParamValue::Int(1), list: None }),
        Overlay::Finish { selected: 0 },
        Overlay::Finish { selected: 1 },
        Overlay::ZoneDraft(tui::model::ZoneDraft::begun(world::Point::origin())),
        Overlay::Messages { selected: 0 },
        Overlay::Stepping,
        Overlay::Quit,
        commands(false),
        commands(true),
        Overlay::Planners { purpose: Purpose::Drive, selected: 0, is_unfolded: false },
        Overlay::Parameters { selected: 0, edit: None },
        Overlay::Parameters { selected: 0, edit },
        Overlay::Layers { selected: 0 },
        Overlay::Preset {
            name: "soft".into(),
            choice: choice("apf"),
            selected: 0,
            left: std::collections::BTreeSet::new(),
        },
        Overlay::Preflight { selected: 0 },
        Overlay::WhatIf,
        Overlay::Filter("a".into()),
        Overlay::Remedies { cause: Cause::PositionLost, steps: Vec::new(), selected: 0 },
        Overlay::Shelve(Shelving { cause: Cause::Stuck, line: "15".into(), refusal: None }),
        Overlay::Bookmark("pump".into()),
    ];
    // A new overlay does not compile until it is in the list above.
    for overlay in &all {
        match overlay {
            Overlay::None
            | Overlay::Confirm(
                Ask::Start(_)
                | Ask::Resume
                | Ask::FlyUncertified
                | Ask::Swap(_)
                | Ask::Promote
                | Ask::TakePlan
                | Ask::DriveBack
                | Ask::DrawZone(_)
                | Ask::Set { .. },
            )
            | Overlay::Finish { .. }
            | Overlay::ZoneDraft(_)
            | Overlay::Messages { .. }
            | Overlay::Stepping
            | Overlay::Quit
            | Overlay::Commands(_)
            | Overlay::Planners { .. }
            | Overlay::Parameters { .. }
            | Overlay::Layers { .. }
            | Overlay::Preset { .. }
            | Overlay::Preflight { .. }
            | Overlay::WhatIf
            | Overlay::Remedies { .. }
            | Overlay::Shelve(_)
            | Overlay::Bookmark(_)
            | Overlay::Filter(_) => {}
        }
    }
    all
}

/// The situations in which a way to stop the robot works.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Where {
    /// On the screens with nothing over them.
    Screens,
    /// Everywhere but in a line of text, where the key is typed.
    NotInText,
    /// Everywhere.
    Everywhere,
}

impl Where {
    /// Computed without the code under test.
    fn includes(self, overlay: &Overlay) -> bool {
        let is_text = matches!(
            overlay,
            Overlay::Commands(_)
                | Overlay::Filter(_)
                | Overlay::Shelve(_)
                | Overlay::Bookmark(_)
                | Overlay::Parameters { edit: Some(_), .. }
        );
        match self {
            Self::Screens => *overlay == Overlay::None,
            Self::NotInText => !is_text,
            Self::Everywhere => true,
        }
    }
}

/// The ways to stop the robot, and where each one works. `X` works on the screens. In a line of text, `X` and the space
/// are typed; there Ctrl-C stops the robot, and the line above the keys says so.
fn ways() -> Vec<(Msg, Where)> {
    let key = |key: Key, place: Where| (Msg::Key(key.into()), place);
    let panicked = Msg::ThreadPanicked { thread: "recorder".into(), message: "out of bounds".into() };
    let signals = [Signal::Interrupt, Signal::Terminate, Signal::Hangup, Signal::End(3), Signal::Stop];
    [
        key(Key::Char(' '), Where::NotInText),
        key(Key::Ctrl('c'), Where::Everywhere),
        key(Key::Ctrl('z'), Where::Everywhere),
        key(Key::Char('X'), Where::Screens),
        (Msg::Line("hold".into()), Where::Everywhere),
        (Msg::Line("end".into()), Where::Everywhere),
        (panicked, Where::Everywhere),
    ]
    .into_iter()
    .chain(signals.map(|signal| (Msg::Signal(signal), Where::Everywhere)))
    .collect()
}

fn moves(effect: &Effect) -> bool {
    matches!(
        effect,
        Effect::Order(
            Order::Start
                | Order::StartPlan(_)
                | Order::Resume
                | Order::Step
                | Order::DriveBack
                | Order::FlyUncertified
        )
    )
}

/// A screen in a phase that its events have led to.
fn screen_in(phase: &Phase) -> Screen {
    let mut screen = if *phase == Phase::Waiting { Screen::idle() } else { Screen::running() };
    let mission = &screen.mission;
    let events = match phase {
        Phase::Waiting | Phase::Running(Gait::Steady) => Vec::new(),
        Phase::Running(Gait::Back) => {
            [mission.obeyed(Order::Hold), mission.obeyed(Order::DriveBack)].concat()
        }
        Phase::Running(Gait::OneTick) => [mission.obeyed(Order::Hold), mission.obeyed(Order::Step)].concat(),
        Phase::Running(Gait::To(to)) => {
            [mission.obeyed(Order::Hold), mission.obeyed(Order::StepTo(*to))].concat()
        }
        Phase::Held(hold) => vec![mission.held_until(hold.by.clone(), hold.resumes)],
        Phase::Ended(outcome) => vec![mission.ended(*outcome, "why")],
    };
    screen.hear(RunMsg::Events(events));
    assert_eq!(screen.model.live.run.phase(), phase);
    // Data that is only drawn is not needed here, and is slow to copy.
    (screen.model.live.run.coverage, screen.model.live.run.accuracy) = (None, None);
    (screen.model.live.run.trail, screen.model.live.run.log) = Default::default();
    screen.model.live.run.planning.plan = None;
    screen.model.live.run.about = None;
    screen
}

/// Every phase with every hold reason, position, planner's work and order that was sent and not answered yet.
fn situations() -> Vec<Model> {
    let orders = [Order::Start, Order::Resume, Order::Step, Order::DriveBack, Order::FlyUncertified];
    let asked: Vec<Option<Order>> = orders.into_iter().map(Some).chain([None]).collect();
    let mut all = Vec::new();
    for phase in phases() {
        let screen = screen_in(&phase);
        for position in positions(&screen) {
            let mut screen = screen.clone();
            screen.hear(RunMsg::Events(position.into_iter().collect()));
            for (asked, is_busy) in asked.iter().flat_map(|asked| [(asked, false), (asked, true)]) {
                // No order is on its way to a mission that has ended.
                if asked.is_some() && matches!(phase, Phase::Ended(_)) {
                    continue;
                }
                let mut screen = screen.clone();
                screen.model.live.asked.clone_from(asked);
                if is_busy {
                    screen.hear(RunMsg::Busy(Some(("Planning (tether-safe)".into(), Some(60.0)))));
                }
                all.push(screen.model);
            }
        }
    }
    all
}

/// Whether the robot moves or may move without a further order, said without the code under test.
fn is_loose(model: &Model) -> bool {
    let by_itself = match model.live.run.phase() {
        Phase::Running(_) => true,
        Phase::Held(hold) => hold.resumes != Resumes::Never,
        Phase::Waiting | Phase::Ended(_) => false,
    };
    by_itself || model.live.asked.is_some()
}

/// Whether the console is about to exit, so that it reads no more keys.
fn is_farewell(way: &Msg) -> bool {
    matches!(way, Msg::Signal(Signal::Terminate | Signal::Hangup | Signal::End(_)))
}

/// Whether Enter would make the robot move.
fn asks_to_move(overlay: &Overlay) -> bool {
    matches!(overlay, Overlay::Stepping | Overlay::Confirm(Ask::Start(_) | Ask::Resume | Ask::FlyUncertified))
}

fn is_held_for_good(phase: &Phase) -> bool {
    matches!(phase, Phase::Held(hold) if hold.resumes == Resumes::Never)
}

#[test]
fn every_way_to_stop_holds_whenever_the_robot_may_move_and_never_makes_it_move() {
    let mut held = 0;
    for situation in situations() {
        for overlay in overlays() {
            for (way, place) in ways() {
                let mut model = situation.clone();
                model.ui.overlay = overlay.clone();
                let effects = update(&mut model, way.clone());
                let about = || {
                    let asked = &situation.live.asked;
                    format!("{way:?} in {:?}, {asked:?} sent, {overlay:?}", situation.live.run.phase())
                };
                assert!(!effects.iter().any(moves), "{} gave {effects:?}", about());
                if is_loose(&situation) && place.includes(&overlay) {
                    assert_eq!(effects.first(), Some(&HOLD), "{}", about());
                    held += 1;
                }
                let opened = model.ui.overlay == Overlay::Confirm(Ask::Resume) && overlay != model.ui.overlay;
                if opened {
                    let is_space = way == Msg::Key(Key::Char(' ').into());
                    let may_ask = is_held_for_good(situation.live.run.phase()) && !is_loose(&situation);
                    assert!(is_space && may_ask, "{} asks to resume", about());
                } else if asks_to_move(&overlay) && !is_farewell(&way) {
                    let effects = update(&mut model, Msg::Key(Key::Enter.into()));
                    assert!(!effects.iter().any(moves), "Enter after {} gave {effects:?}", about());
                }
            }
        }
    }
    assert!(held > 10_000, "only {held} cases");
}

#[test]
fn the_line_for_steps_is_left_with_a_robot_that_stands_still() {
    for mut model in situations() {
        model.ui.overlay = Overlay::Stepping;
        for key in [Key::Esc, Key::Char('x'), Key::F(5)] {
            let mut model = model.clone();
            let effects = update(&mut model, Msg::Key(key.into()));
            assert_eq!(model.ui.overlay, Overlay::None);
            let expected = if is_loose(&model) { &[HOLD][..] } else { &[] };
            assert_eq!(effects, expected, "{key} in {:?}", model.live.run.phase());
        }
    }
}

#[test]
fn a_space_in_a_line_of_text_is_typed_and_the_footer_names_the_key_that_holds() {
    let mut screen = Screen::running();
    screen.send(Msg::Resize { width: 80, height: 24 });
    screen.type_text("/position lost");
    assert_eq!(screen.model.ui.overlay, Overlay::Filter("position lost".into()));
    for size in [(80, 24), (120, 36)] {
        let shown = text(&drawn(&screen.model, RICH, size));
        assert!(shown.lines().last().is_some_and(|footer| footer.contains("Ctrl-C HOLD")), "{shown}");
    }
    assert_eq!(screen.press([Key::Ctrl('c')]), [HOLD]);
}

#[test]
fn a_key_of_the_operator_that_holds_does_so_in_a_line_of_text_too() {
    let own = Binding { action: "hold".into(), keys: vec![Key::F(12)] };
    let mut screen = Screen::running();
    screen.model.console.keys = Keymap::new(&[], &[own]).0;
    screen.type_text("/a");
    assert_eq!(screen.press([Key::F(12)]), [HOLD]);
    let shown = text(&drawn(&screen.model, RICH, (80, 24)));
    assert!(shown.contains("F12 Ctrl-C HOLD"), "{shown}");
}

#[test]
fn a_hold_that_was_sent_can_be_sent_again() {
    for situation in situations().into_iter().filter(is_loose) {
        for (first, _) in ways() {
            for (second, place) in ways() {
                let mut model = situation.clone();
                assert_eq!(update(&mut model, first.clone()).first(), Some(&HOLD));
                let overlay = model.ui.overlay.clone();
                let effects = update(&mut model, second.clone());
                assert!(!effects.iter().any(moves), "{second:?} after {first:?}");
                if place.includes(&overlay) {
                    assert_eq!(effects.first(), Some(&HOLD), "{second:?} after {first:?}");
                }
            }
        }
    }
}

#[test]
fn every_way_to_stop_works_on_every_size_and_in_every_pane() {
    for (width, height) in [(120, 36), (80, 24), (60, 16), (44, 10), (1, 1), (0, 0)] {
        for pane in Pane::PAGES {
            for (way, _) in ways() {
                let mut screen = Screen::running();
                screen.send(Msg::Resize { width, height });
                screen.model.ui.pane = pane;
                assert_eq!(screen.send(way.clone()).first(), Some(&HOLD), "{way:?} at {width}x{height}");
            }
        }
    }
}

#[test]
fn leaving_ends_what_was_asked_to_start() {
    let mut screen = Screen::idle();
    screen.start();
    screen.type_text("1");
    assert_eq!(screen.type_text("q"), [HOLD]);
    let leave = [Effect::Order(Order::Abort), Effect::Quit { signal: None }];
    assert_eq!(screen.press([Key::Enter]), leave);
}

#[test]
fn a_parameter_that_was_sent_does_not_count_as_a_robot_that_may_move() {
    let mut screen = Screen::held();
    let key = "rpf_gain".to_owned();
    let sent = Effect::Order(Order::SetParameter { key, value: ParamValue::Float(1.25) });
    screen.press([Key::Char('p'), Key::Enter, Key::Char('5'), Key::Enter]);
    assert_eq!(screen.press([Key::Enter]), [sent, Effect::StopForecasting]);
    screen.press([Key::Esc]);
    assert_eq!(screen.press([Key::Char(' ')]), []);
    assert_eq!(screen.model.ui.overlay, Overlay::Confirm(Ask::Resume));
}

#[test]
fn a_space_holds_until_text_is_typed_in_a_line() {
    for help in [false, true] {
        let mut screen = Screen::running();
        screen.press([Key::Char(if help { '?' } else { ':' })]);
        let shown = |screen: &mut Screen| text(&drawn(&screen.model, RICH, (120, 36)));
        assert!(shown(&mut screen).contains("space Ctrl-C HOLD"), "{}", shown(&mut screen));
        screen.press([Key::Char('x'), Key::Char(' ')]);
        assert!(
            matches!(&screen.model.ui.overlay, Overlay::Commands(palette) if palette.line.text() == "x ")
        );
        assert!(!screen.model.live.hold_asked && !shown(&mut screen).contains("space Ctrl-C HOLD"));
        screen.press([Key::Backspace, Key::Backspace]);
        assert!(screen.press([Key::Char(' ')]).contains(&HOLD));
        assert_eq!(screen.press([Key::Char(' ')]), [], "HOLD was ordered");
    }
    // A robot that stands is not held a second time.
    let mut screen = Screen::held();
    screen.press([Key::Char('?')]);
    assert_eq!(screen.press([Key::Char(' ')]), []);
}

#[test]
fn an_automatic_hold_that_only_an_order_ends_slows_a_fast_simulation() {
    let slowed = |by: HoldReason, resumes| {
        let mut screen = Screen::running();
        screen.model.live.speed = Speed::Times(16.0);
        let held = screen.mission.held_until(by, resumes);
        let effects = screen.hear(RunMsg::Events(vec![held]));
        (effects.contains(&Effect::Speed(Speed::default())), screen.model.live.speed == Speed::default())
    };
    for by in HoldReason::every("why") {
        let is_automatic =
            !matches!(by, HoldReason::Operator | HoldReason::Stepped | HoldReason::PlannerReplaced);
        assert_eq!(slowed(by.clone(), Resumes::Never), (is_automatic, is_automatic), "{by}");
        assert_eq!(slowed(by, Resumes::WhenCleared), (false, false), "the mission goes on by itself");
    }
}
