//! Named parameter presets, and drafts of parameters for forecasts.

use crate::fixture::{RICH, Screen, choice};
use crate::screens::{drawn, text};
use mission::{Note, Noted, Order, ParamValue, PlannerChoice};
use tui::model::{Overlay, Preset};
use tui::{Effect, Key, Msg, RunMsg};

fn with(id: &str, parameters: &[(&str, ParamValue)]) -> PlannerChoice {
    let parameters = parameters.iter().map(|(key, value)| ((*key).to_owned(), value.clone())).collect();
    PlannerChoice { parameters, ..choice(id) }
}

fn offered(mut screen: Screen) -> Screen {
    let soft = with("rpf", &[("rpf_gain", ParamValue::Float(0.8)), ("order", ParamValue::Int(2))]);
    let presets = vec![
        Preset { name: "bad".into(), choice: Err("bad.toml:3:9: k: no such parameter".into()) },
        Preset { name: "other".into(), choice: Ok(choice("apf")) },
        Preset { name: "plain".into(), choice: Ok(choice("rpf")) },
        Preset { name: "soft".into(), choice: Ok(soft) },
    ];
    screen.send(Msg::Presets(presets));
    screen
}

fn run(screen: &mut Screen, line: &str) -> Vec<Effect> {
    screen.model.console.notice = None;
    screen.type_text(&format!(":{line}"));
    screen.press([Key::Enter])
}

fn notice(screen: &Screen) -> &str {
    screen.model.notice().map_or("", |notice| notice.text.as_str())
}

#[test]
fn a_preset_is_taken_after_a_look_at_what_it_changes() {
    let taken = with("rpf", &[("rpf_gain", ParamValue::Float(0.8))]);
    let what = Noted::PresetTaken { preset: "soft".into(), planner: "rpf".into() };
    let note = Effect::Order(Order::Note(Note { what, by: None }));
    let order = Effect::Order(Order::ChoosePlanner(taken));
    let cases = vec![
        (offered(Screen::held()), vec![note.clone(), order.clone()]),
        (offered(Screen::idle()), vec![note, order, Effect::Order(Order::Plan)]),
    ];
    for (mut screen, effects) in cases {
        let estimated = run(&mut screen, "preset-load soft");
        assert!(matches!(&estimated[..], [Effect::Compare(_) | Effect::Forecast(_)]), "{estimated:?}");
        let shown = text(&drawn(&screen.model, RICH, (80, 24)));
        for words in [
            "Preset soft (rpf)",
            "[x] rpf_gain",
            "1 of 1 changes taken",
            "Enter: apply them",
            "Nothing moves",
        ] {
            assert!(shown.contains(words), "{words}: {shown}");
        }
        let taken = screen.press([Key::Enter]);
        assert_eq!(taken[..effects.len()], effects);
        assert!(matches!(taken.last(), Some(Effect::StopComparing | Effect::StopForecasting)), "{taken:?}");
        assert_eq!(screen.model.ui.overlay, Overlay::None);
    }
    let mut screen = offered(Screen::held());
    run(&mut screen, "preset-load other");
    assert!(text(&drawn(&screen.model, RICH, (80, 24))).contains("Enter: change planner to apf"));
    let closed = screen.press([Key::Esc, Key::Enter]);
    assert!(
        !closed.iter().any(|effect| matches!(effect, Effect::Order(_))),
        "Esc leaves everything as it is"
    );
}

#[test]
fn what_cannot_be_taken_says_why() {
    let cases = [
        ("bad", "preset bad is refused: bad.toml:3:9: k: no such parameter"),
        ("plain", "preset plain changes nothing"),
    ];
    for (name, why) in cases {
        let mut screen = offered(Screen::held());
        assert_eq!((run(&mut screen, &format!("preset-load {name}")), notice(&screen)), (vec![], why));
    }
    let mut screen = offered(Screen::running());
    assert_eq!(run(&mut screen, "preset-load soft"), []);
    assert_eq!(notice(&screen), "a preset cannot be loaded while the robot moves; space: HOLD");
    let mut screen = offered(Screen::held());
    run(&mut screen, "preset-load soft");
    let resumed = screen.mission.obeyed(Order::Resume);
    screen.hear(RunMsg::Events(resumed));
    assert_eq!(screen.press([Key::Enter]), [], "checked again when it is taken");
}

#[test]
fn the_values_of_a_preset_are_chosen_one_by_one_and_their_effect_is_estimated() {
    let two = [("rpf_gain", ParamValue::Float(0.8)), ("order", ParamValue::Int(3))];
    let mut screen = offered(Screen::idle());
    screen.model.console.presets.push(Preset { name: "two".into(), choice: Ok(with("rpf", &two)) });
    assert_eq!(run(&mut screen, "preset-load two"), [Effect::Compare(with("rpf", &two))]);
    // The second value is left as it is: the estimate is made again without it.
    assert_eq!(
        screen.press([Key::Down, Key::Char('t')]),
        [Effect::StopComparing, Effect::Compare(with("rpf", &two[..1]))]
    );
    for size in crate::sizes::SIZES {
        screen.send(Msg::Resize { width: size.0, height: size.1 });
        let shown = text(&drawn(&screen.model, RICH, size));
        for words in ["[x] rpf_gain", "[ ] order", "Computing the effect", "1 of 2 changes taken"] {
            assert!(shown.contains(words), "{size:?}: {words}\n{shown}");
        }
    }
    let taken = screen.press([Key::Enter]);
    assert!(taken.contains(&Effect::Order(Order::ChoosePlanner(with("rpf", &two[..1])))), "{taken:?}");
    // Without any value, there is nothing to send.
    run(&mut screen, "preset-load two");
    assert_eq!(
        screen.press([Key::Char('t'), Key::Down, Key::Char('t')]).last(),
        Some(&Effect::StopComparing)
    );
    let sent = screen.press([Key::Enter]);
    assert!(!sent.iter().any(|effect| matches!(effect, Effect::Order(_))), "{sent:?}");
    assert_eq!(notice(&screen), "nothing was sent: no value of preset two is ticked");
}

#[test]
fn the_parameters_are_kept_whole_under_a_new_name() {
    let mut screen = offered(Screen::idle());
    let saved = run(&mut screen, "preset-save mine");
    let [Effect::SavePreset { name, choice }] = &saved[..] else { panic!("{saved:?}") };
    assert_eq!((name.as_str(), choice.id.as_str(), choice.parameters.len()), ("mine", "rpf", 5));
    for (name, why) in [
        ("soft", "preset soft already exists; choose another name"),
        ("../x", "invalid preset name `../x`; use 1 to 40 letters, digits, - or _"),
    ] {
        assert_eq!((run(&mut screen, &format!("preset-save {name}")), notice(&screen)), (vec![], why));
    }
}

#[test]
fn a_draft_is_forecast_and_moves_nothing() {
    let mut screen = Screen::held();
    screen.type_text("w");
    assert_eq!(screen.press([Key::Char('p'), Key::Enter]), []);
    screen.press([Key::Ctrl('u')]);
    screen.type_text("0.8");
    assert_eq!(screen.press([Key::Enter]), [], "a draft is not an order");
    assert!(text(&drawn(&screen.model, RICH, (120, 36))).contains("Forecast with parameters of rpf"));
    let draft = with("rpf", &[("rpf_gain", ParamValue::Float(0.8))]);
    let forecast = screen.type_text("w");
    let [Effect::Forecast(choices)] = &forecast[..] else { panic!("{forecast:?}") };
    assert_eq!(choices.last(), Some(&draft));
    assert_eq!(screen.model.ui.overlay, Overlay::WhatIf);
    assert!(text(&drawn(&screen.model, RICH, (120, 36))).contains("rpf with rpf_gain = 0.8."));
    // The same draft once more, and a draft that is given up.
    assert_eq!(screen.type_text("pw"), []);
    assert_eq!(notice(&screen), "planner rpf is already in the comparison");
    screen.press([Key::Char('p'), Key::Esc]);
    assert_eq!(screen.model.ui.overlay, Overlay::WhatIf);
    screen.press([Key::Esc, Key::Char('p')]);
    assert!(text(&drawn(&screen.model, RICH, (120, 36))).contains("Parameters of rpf"), "those that drive");
}

#[test]
fn a_draft_is_forgotten_when_the_robot_moves_again() {
    let mut screen = Screen::held();
    screen.type_text("wp");
    let resumed = screen.mission.obeyed(Order::Resume);
    assert_eq!(screen.hear(RunMsg::Events(resumed)), [Effect::StopForecasting]);
    assert_eq!(screen.model.ui.overlay, Overlay::None);
}

#[test]
fn a_preset_waits_for_a_hold_even_if_there_is_none_yet() {
    let screens: [fn() -> Screen; 2] = [Screen::running, || offered(Screen::running())];
    for screen in screens.map(|screen| Box::new(screen())) {
        let why = tui::update::offered(&screen.model, tui::actions::ActionId::PresetLoad);
        assert_eq!(why, Err("a preset cannot be loaded while the robot moves; space: HOLD".into()));
    }
}

#[test]
fn long_texts_of_a_parameter_are_wrapped_and_none_is_lost() {
    let help = "The reach of the field around an obstacle, measured from its outline. ".repeat(4);
    for size in [(120, 36), (80, 24)] {
        let mut screen = Screen::held();
        let info = screen.model.live.run.planning.info.as_mut().expect("a planner");
        info.parameters[3].help.clone_from(&help);
        if let mission::ParamKind::Choice { options, .. } = &mut info.parameters[3].kind {
            options.extend((0..12).map(|n| format!("an-option-with-a-long-name-{n}")));
        }
        for planner in &mut screen.model.console.planners {
            planner
                .parameters
                .clone_from(&screen.model.live.run.planning.info.as_ref().expect("it").parameters);
        }
        screen.press([Key::Char('p'), Key::Down, Key::Down, Key::Down]);
        for _ in 0..2 {
            let shown = text(&drawn(&screen.model, RICH, size));
            let words = shown.replace('│', " ").split_whitespace().collect::<Vec<_>>().join(" ");
            assert!(words.contains(help.trim()), "{size:?}: {shown}");
            assert!(words.contains("an-option-with-a-long-name-11"), "{size:?}: {shown}");
            screen.press([Key::Enter]);
        }
    }
}
