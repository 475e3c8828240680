//! The console: its commands, panes and screens.

use crate::actions::action::{Action, Reach, action};
use crate::actions::argument::must;
use crate::actions::context::Context::{self, On};
use crate::actions::{ActionId, Kind};
use crate::keys::Key;
use crate::model::{Overlay, Palette, Screen};
use crate::update::offer::{self, demand};
use crate::update::overlay::open;
use crate::update::{Effect, act, go};

#[rustfmt::skip]
pub(super) const ROWS: &[Action] = &[
    action(ActionId::Commands, "commands", "Find a command by name", &[Key::Char(':'), Key::Ctrl('p')], &[Context::Screen]).label("command").does(|m| open(m, Overlay::Commands(Palette::default()))),
    action(ActionId::Help, "help", "Show keys and commands", &[Key::Char('?'), Key::F(1)], &[Context::Screen]).label("keys")
        .does(|m| open(m, Overlay::Commands(Palette { help: true, ..Palette::default() }))),
    action(ActionId::Messages, "messages", "Show the latest messages", &[], &[Context::Screen]).does(|m| open(m, Overlay::Messages { selected: 0 })),
    action(ActionId::NextPane, "next-pane", "Go to the next pane", &[Key::Tab], &[Context::Screen]).label("pane").repeats().when(offer::other_pane).looks(|m| act::turn_to(m, 1)),
    action(ActionId::PreviousPane, "previous-pane", "Go to the previous pane", &[Key::BackTab], &[Context::Screen]).repeats().when(offer::other_pane).looks(|m| act::turn_to(m, -1)),
    action(ActionId::FullPane, "full-pane", "Show one pane alone, or all panes", &[Key::Char('F')], &[On(Screen::Mission), Context::Replay])
        .when(|m| offer::on_screen(m, Screen::Mission)).looks(act::show_alone),
    action(ActionId::Pane(1), "first-pane", "Go to the first pane", &[Key::F(2)], &[Context::Screen]).when(|m| offer::pane(m, 1)).looks(|m| act::turn_to_number(m, 1)),
    action(ActionId::Pane(2), "second-pane", "Go to the second pane", &[Key::F(3)], &[Context::Screen]).when(|m| offer::pane(m, 2)).looks(|m| act::turn_to_number(m, 2)),
    action(ActionId::Pane(3), "third-pane", "Go to the third pane", &[Key::F(4)], &[Context::Screen]).when(|m| offer::pane(m, 3)).looks(|m| act::turn_to_number(m, 3)),
    action(ActionId::GoTo, "goto", "Show a screen", &[], &[Context::Screen]).args(&[must("screen", Kind::Screen)]),
];

/// Actions that leave a screen or the console.
#[rustfmt::skip]
pub(super) const LEAVING: &[Action] = &[
    action(ActionId::Reload, "reload", "Reload plugins", &[Key::Char('r')], &[On(Screen::Plugins)]).label("reload").reaches(Reach::Mission)
        .when(|m| demand(!m.live.run.is_running(), "hold the robot to rescan plugins; <hold>: HOLD")).does(|_| vec![Effect::Survey]),
    action(ActionId::Back, "back", "Go back; the mission continues", &[Key::Char('q')], &[Context::Screen]).label("back").does(|m| go::back(m).unwrap_or_else(|| act::leave(m))),
    action(ActionId::Leave, "leave", "Quit; a running mission is held first", &[], &[Context::Screen]).also(&["quit", "exit"]).does(act::leave),
    action(ActionId::Theme, "theme", "Choose the colours", &[], &[Context::Screen]).args(&[must("theme", Kind::Theme)]),
];
