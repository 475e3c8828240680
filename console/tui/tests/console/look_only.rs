//! A view-only console gives no order, whichever keys are pressed.

use crate::fixture::{RICH, Screen};
use crate::screens::{drawn, text};
use mission::Outcome;
use tui::actions::ACTIONS;
use tui::model::{Access, Screen as Name};
use tui::update::act;
use tui::{Effect, Job, Key, RunMsg};

fn onlookers() -> Vec<Screen> {
    let mut ended = Screen::held();
    let events = vec![ended.mission.ended(Outcome::Aborted, "ended by operator")];
    ended.hear(RunMsg::Events(events));
    let mut all = vec![Screen::running(), Screen::held(), ended];
    for screen in &mut all {
        screen.model.live.access = Access::LookOnly;
    }
    all
}

/// Whether an effect concerns only this console, its configuration, and runs that have already been written.
fn looks(effect: &Effect) -> bool {
    use Effect::{Bell, Copy, Do, Look, Mouse, Quit, Redraw, SavePreset, Suspend};
    match effect {
        Do(job) => !matches!(job, Job::Report(_)),
        other => matches!(
            other,
            Look | Redraw | Suspend | Bell | Mouse(_) | Copy(_) | Quit { .. } | SavePreset { .. }
        ),
    }
}

#[test]
fn no_action_on_any_screen_gives_an_order() {
    for onlooker in onlookers() {
        for name in Name::ALL {
            for action in ACTIONS.iter() {
                let mut screen = onlooker.clone();
                screen.model.ui.go(name);
                let mut effects = act(&mut screen.model, action.id);
                effects.extend(screen.press([Key::Enter, Key::Char('y'), Key::Enter]));
                effects.retain(|effect| !looks(effect));
                assert_eq!(effects, [], "{} on {}", action.name, name.name());
            }
        }
    }
}

#[test]
fn what_would_act_says_who_may() {
    for line in
        ["hold", "start", "end", "speed 4", "inject S1 dead 20s", "shelve 15m noise", "set rpf_gain=1"]
    {
        let mut screen = onlookers().remove(0);
        screen.type_text(&format!(":{line}"));
        screen.press([Key::Enter]);
        let said = screen.model.notice().map(|notice| notice.text.clone()).unwrap_or_default();
        assert!(said.starts_with("VIEW only: give orders on the console"), "{line}: {said}");
    }
}

#[test]
fn who_looks_on_sees_it_and_leaves_without_a_question() {
    for size in [(120, 36), (80, 24), (44, 10)] {
        let mut screen = onlookers().remove(0);
        let shown = text(&drawn(&screen.model, RICH, size));
        assert!(shown.contains("VIEW ▶ RUN") && !shown.contains("HOLD "), "{shown}");
        screen.type_text("1");
        assert_eq!(screen.type_text("q"), [Effect::Quit { signal: None }]);
    }
}

#[test]
fn the_line_of_keys_of_an_onlooker_offers_no_order() {
    for (onlooker, state) in onlookers().into_iter().zip(["running", "held", "ended"]) {
        for name in Name::ALL {
            for size in [(60, 16), (80, 24), (120, 36), (200, 60)] {
                let mut screen = onlooker.clone();
                screen.model.ui.go(name);
                screen.send(tui::Msg::Resize { width: size.0, height: size.1 });
                let shown = text(&drawn(&screen.model, RICH, size));
                let line = shown.lines().last().unwrap_or_default();
                let place = format!("{state}, {} at {size:?}: {line}", name.name());
                assert!(line.contains("? keys") || line.contains("? help"), "{place}");
                let words =
                    ["HOLD", "resume", "start", "end", "step", "parameters", "acknowledge", "shelve", "take"];
                let labels: Vec<&str> = line.split("  ").map(str::trim).collect();
                let orders = labels.iter().filter(|label| {
                    words.iter().any(|word| label.split(' ').any(|w| w.trim_end_matches('…') == *word))
                });
                assert_eq!(orders.collect::<Vec<_>>(), Vec::<&&str>::new(), "{place}");
            }
        }
    }
}
