//! The map, the filter and the terminal.

use crate::actions::action::{Action, action};
use crate::actions::argument::{may, must};
use crate::actions::context::Context::{self, On};
use crate::actions::{ActionId, Kind};
use crate::keys::Key;
use crate::model::ui::MapView;
use crate::model::{Overlay, Pane, Screen};
use crate::update::offer::demand;
use crate::update::overlay::open;
use crate::update::send::hold_now;
use crate::update::{Effect, act, events, map};
use world::Vector;

#[rustfmt::skip]
pub(super) const ROWS: &[Action] = &[
    action(ActionId::ZoomIn, "zoom-in", "Zoom in", &[Key::Char('z')], &[Context::Map]).repeats()
        .when(|m| map::can_zoom(m, true)).looks(|m| map::zoom_shown(m, true)),
    action(ActionId::ZoomOut, "zoom-out", "Zoom out", &[Key::Char('Z')], &[Context::Map]).repeats()
        .when(|m| map::can_zoom(m, false)).looks(|m| map::zoom_shown(m, false)),
    action(ActionId::WholeTank, "whole-tank", "Show the whole tank", &[Key::Char('0')], &[Context::Map]).when(map::is_shown).looks(|m| m.ui.map = MapView::default()),
    action(ActionId::Follow, "follow", "Keep the map centred on the robot", &[Key::Char('f')], &[Context::Map])
        .when(|m| map::is_shown(m).and(demand(m.live.run.position.pose.is_some(), "no position estimate yet"))).looks(|m| m.ui.map.follow = !m.ui.map.follow),
    action(ActionId::Layers, "layers", "Show or hide map layers", &[Key::Char('L')], &[Context::Map]).args(&[may("layer", Kind::Layer)])
        .when(map::is_shown).does(|m| open(m, Overlay::Layers { selected: 0 })),
    action(ActionId::Centre, "centre", "Centre the map on a named object", &[], &[Context::Map]).args(&[must("place", Kind::Place)]).when(map::is_shown),
    action(ActionId::Inspect, "inspect", "Inspect a map position (<cancel>: end)", &[Key::Char('i')], &[Context::Map])
        .when(|m| map::is_shown(m).and(demand(m.live.run.about.is_some(), "no tank loaded yet"))).looks(map::inspect),
    action(ActionId::Mouse, "mouse", "Mouse on or off", &[], &[Context::Screen]).does(act::toggle_mouse),
    action(ActionId::Severity, "severity", "Set the minimum severity of events shown", &[Key::Char('m')], &[On(Screen::Mission), Context::Replay]).args(&[may("severity", Kind::Severity)])
        .when(|m| demand(m.ui.shows(Pane::Events), "the events are not shown (they need 60x16); <next-pane>: next pane")).looks(events::next_severity),
    action(ActionId::Filter, "filter", "Filter the list", &[Key::Char('/')], &[On(Screen::Home), On(Screen::Mission), Context::Replay, On(Screen::Events), On(Screen::Review)]).args(&[may("text", Kind::Text)])
        .does(events::open_filter),
    action(ActionId::PanLeft, "pan-west", "Pan the map west", &[Key::Left, Key::Char('h')], &[Context::Pan]).repeats().when(map::can_pan).looks(|m| map::pan(m, Vector::new(-1.0, 0.0))),
    action(ActionId::PanRight, "pan-east", "Pan the map east", &[Key::Right, Key::Char('l')], &[Context::Pan]).repeats().when(map::can_pan).looks(|m| map::pan(m, Vector::new(1.0, 0.0))),
    action(ActionId::PanUp, "pan-north", "Pan the map north", &[Key::Up, Key::Char('k')], &[Context::Pan]).repeats().when(map::can_pan).looks(|m| map::pan(m, Vector::new(0.0, 1.0))),
    action(ActionId::PanDown, "pan-south", "Pan the map south", &[Key::Down, Key::Char('j')], &[Context::Pan]).repeats().when(map::can_pan).looks(|m| map::pan(m, Vector::new(0.0, -1.0))),
    action(ActionId::Redraw, "redraw", "Redraw the screen", &[Key::Ctrl('l')], &[Context::Anywhere]).does(|_| vec![Effect::Redraw]),
    action(ActionId::Suspend, "suspend", "HOLD, then suspend to shell (fg: back)", &[Key::Ctrl('z')], &[Context::Anywhere]).does(|m| [hold_now(m), vec![Effect::Suspend]].concat()),
];
