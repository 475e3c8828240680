//! Lists, input lines and questions.

use crate::actions::action::{Action, action};
use crate::actions::context::Context;
use crate::actions::{ActionId, Risk};
use crate::keys::Key;
use crate::update::act::{PAGE, select};
use crate::update::offer::accepted;
use crate::update::{act, offer, overlay, typing};
use mission::{Order, StepTo};

#[rustfmt::skip]
pub(super) const ROWS: &[Action] = &[
    action(ActionId::Edit, "edit", "Edit the value", &[Key::Char('e')], &[Context::Parameters]).label("edit").does(overlay::edit),
    action(ActionId::Complete, "complete", "Complete the word", &[Key::Tab], &[Context::Text]).label("complete").when(typing::can_complete).looks(typing::complete),
    action(ActionId::Remedy(1), "first-action", "Run action 1 of the alarm", &[Key::Char('1')], &[Context::Remedies]),
    action(ActionId::Remedy(2), "second-action", "Run action 2 of the alarm", &[Key::Char('2')], &[Context::Remedies]),
    action(ActionId::Remedy(3), "third-action", "Run action 3 of the alarm", &[Key::Char('3')], &[Context::Remedies]),
    action(ActionId::Remedy(4), "fourth-action", "Run action 4 of the alarm", &[Key::Char('4')], &[Context::Remedies]),
    action(ActionId::Remedy(5), "fifth-action", "Run action 5 of the alarm", &[Key::Char('5')], &[Context::Remedies]),
    action(ActionId::Accept, "accept", "Confirm, or select the line", &[Key::Enter], &[Context::Rows, Context::Text, Context::Confirm, Context::Stepping, Context::WhatIf, Context::Drawing]).label("yes")
        .when(offer::accept).does(overlay::accept),
    action(ActionId::Step, "step", "Move for one more tick", &[Key::Char('.')], &[Context::Stepping]).label("step").risk(Risk::Moves)
        .when(|m| accepted(m, &Order::Step)).does(|m| act::step(m, Order::Step)),
    action(ActionId::StepLane, "step-lane", "Move to the end of the lane", &[Key::Char('}')], &[Context::Stepping]).label("lane").risk(Risk::Moves)
        .when(|m| accepted(m, &Order::StepTo(StepTo::LaneEnd))).does(|m| act::step(m, Order::StepTo(StepTo::LaneEnd))),
    action(ActionId::StepEvent, "step-event", "Move to the next event", &[Key::Char(']')], &[Context::Stepping]).label("event").risk(Risk::Moves)
        .when(|m| accepted(m, &Order::StepTo(StepTo::Event))).does(|m| act::step(m, Order::StepTo(StepTo::Event))),
    action(ActionId::Cancel, "cancel", "Cancel", &[Key::Esc], &[Context::Text, Context::Stepping, Context::Cursor]).label("cancel").does(act::cancel),
    action(ActionId::Cancel, "cancel", "Cancel", &[Key::Esc, Key::Char('q')], &[Context::List, Context::Confirm, Context::WhatIf, Context::Drawing]).label("cancel").does(act::cancel),
    action(ActionId::Up, "up", "Select the line above", &[Key::Up, Key::Char('k')], &[Context::Rows]).repeats().looks(|m| select(m, -1)),
    action(ActionId::Down, "down", "Select the line below", &[Key::Down, Key::Char('j')], &[Context::Rows]).repeats().looks(|m| select(m, 1)),
    action(ActionId::PageUp, "page-up", "Ten lines up", &[Key::PageUp, Key::Ctrl('u')], &[Context::Rows]).repeats().looks(|m| select(m, -PAGE)),
    action(ActionId::PageDown, "page-down", "Ten lines down", &[Key::PageDown, Key::Ctrl('d')], &[Context::Rows]).repeats().looks(|m| select(m, PAGE)),
    action(ActionId::First, "first", "Go to the first line", &[Key::Home, Key::Char('g')], &[Context::Rows]).looks(|m| select(m, isize::MIN)),
    action(ActionId::Last, "last", "Go to the last line", &[Key::End, Key::Char('G')], &[Context::Rows]).looks(|m| select(m, isize::MAX)),
    action(ActionId::Up, "up", "Select the line above", &[Key::Up], &[Context::Commands]).repeats().looks(|m| select(m, -1)),
    action(ActionId::Down, "down", "Select the line below", &[Key::Down], &[Context::Commands]).repeats().looks(|m| select(m, 1)),
    action(ActionId::PageUp, "page-up", "Ten lines up", &[Key::PageUp], &[Context::Commands]).repeats().looks(|m| select(m, -PAGE)),
    action(ActionId::PageDown, "page-down", "Ten lines down", &[Key::PageDown], &[Context::Commands]).repeats().looks(|m| select(m, PAGE)),
    action(ActionId::First, "first", "Go to the first line", &[Key::Home], &[Context::Commands]).looks(|m| select(m, isize::MIN)),
    action(ActionId::Last, "last", "Go to the last line", &[Key::End], &[Context::Commands]).looks(|m| select(m, isize::MAX)),
];
