//! The console: its commands, panes and screens.

use crate::actions::action::{Action, action};
use crate::actions::argument::must;
use crate::actions::context::Context;
use crate::actions::{ActionId, Kind};
use crate::keys::Key;
use crate::model::{Overlay, Palette, Screen};
use crate::update::overlay::open;
use crate::update::{Effect, act, go, offer};

#[rustfmt::skip]
pub(super) const ROWS: &[Action] = &[
    action(ActionId::Commands, "commands", "Find a command by name", &[Key::Char(':'), Key::Ctrl('p')], &[Context::Screen]).label("command")
        .does(|m| open(m, Overlay::Commands(Palette::default()))),
    action(ActionId::Help, "help", "Show keys and commands", &[Key::Char('?'), Key::F(1)], &[Context::Screen]).label("keys")
        .does(|m| open(m, Overlay::Commands(Palette { help: true, ..Palette::default() }))),
    action(ActionId::NextPane, "next-pane", "Go to the next pane", &[Key::Tab], &[Context::Screen]).label("pane").repeats()
        .when(offer::other_pane).looks(|m| act::turn_to(m, 1)),
    action(ActionId::PreviousPane, "previous-pane", "Go to the previous pane", &[Key::BackTab], &[Context::Screen]).repeats()
        .when(offer::other_pane).looks(|m| act::turn_to(m, -1)),
    action(ActionId::GoTo, "goto", "Show a screen", &[], &[Context::Screen]).args(&[must("screen", Kind::Screen)]),
    action(ActionId::GoHome, "home", "Screen 1: scenarios and past runs", &[Key::Char('1')], &[Context::Screen])
        .does(|m| go::go(m, Screen::Home)),
    action(ActionId::GoPlan, "plan", "Screen 2: the plan before it moves", &[Key::Char('2')], &[Context::Screen])
        .when(offer::is_open).does(|m| go::go(m, Screen::Plan)),
    action(ActionId::GoMission, "mission", "Screen 3: the mission", &[Key::Char('3')], &[Context::Screen])
        .when(offer::is_open).does(|m| go::go(m, Screen::Mission)),
    action(ActionId::GoAlarms, "alarms", "Screen 4: what is wrong, what to do", &[Key::Char('4')], &[Context::Screen])
        .does(|m| go::go(m, Screen::Alarms)),
    action(ActionId::GoEvents, "events", "Screen 5: what happened", &[Key::Char('5')], &[Context::Screen])
        .does(|m| go::go(m, Screen::Events)),
    action(ActionId::GoReview, "review", "Screen 6: past runs: replay, compare", &[Key::Char('6')], &[Context::Screen])
        .does(|m| go::go(m, Screen::Review)),
    action(ActionId::GoResult, "result", "Screen 7: what was achieved", &[Key::Char('7')], &[Context::Screen])
        .when(offer::has_result).does(|m| go::go(m, Screen::Result)),
    action(ActionId::GoPlugins, "plugins", "Screen 8: plugins and their planners", &[Key::Char('8')], &[Context::Screen])
        .does(|m| go::go(m, Screen::Plugins)),
    action(ActionId::Reload, "reload", "Look at the plugins again", &[Key::Char('r')], &[Context::Plugins]).label("reload").orders()
        .when(offer::reload).does(|_| vec![Effect::Survey]),
    action(ActionId::Back, "back", "Go back; the mission goes on", &[Key::Char('q')], &[Context::Screen]).label("back")
        .does(act::back),
    action(ActionId::Leave, "leave", "Quit; a running mission is held first", &[], &[Context::Screen]).also(&["quit", "exit"])
        .does(act::leave),
    action(ActionId::Theme, "theme", "Choose the colours", &[], &[Context::Screen]).args(&[must("theme", Kind::Theme)]),
];
