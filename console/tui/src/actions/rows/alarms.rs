//! Alarms, events, zones and stations, and the actions on them.

use crate::actions::action::{Action, Reach, action};
use crate::actions::argument::{may, must};
use crate::actions::context::Context::{self, On};
use crate::actions::{ActionId, Kind};
use crate::keys::Key;
use crate::model::Screen;
use crate::screens::EACH;
use crate::update::offer::demand;
use crate::update::{alarms, events, stations, zones};

#[rustfmt::skip]
pub(super) const ROWS: &[Action] = &[
    action(ActionId::Acknowledge, "acknowledge", "Acknowledge the most severe alarm", &[Key::Char('a')], EACH).label("ack").also(&["silence"]).reaches(Reach::Mission)
        .when(alarms::can_acknowledge).does(alarms::acknowledge),
    action(ActionId::AcknowledgeAll, "acknowledge-all", "Acknowledge every alarm", &[Key::Char('*')], &[On(Screen::Alarms)]).label("ack all").reaches(Reach::Mission)
        .when(alarms::can_acknowledge_all).does(alarms::acknowledge_all),
    action(ActionId::Shelve, "shelve", "Shelve or unshelve the alarm", &[Key::Char('d')], &[On(Screen::Alarms)]).label("shelve").args(&[may("time", Kind::Duration), may("reason", Kind::Text), may("alarm", Kind::Alarm)]).reaches(Reach::Mission)
        .when(alarms::can_shelve).does(alarms::shelve),
    action(ActionId::Inject, "inject", "Inject a station fault (training)", &[], &[Context::Screen]).args(&[must("station", Kind::Station), must("fault", Kind::Fault), must("time", Kind::Duration)]).reaches(Reach::Mission)
        .when(|m| stations::can(m, ActionId::Inject)),
    action(ActionId::DrawZone, "no-go", "Draw a no-go zone between two corners", &[], &[Context::Screen]).args(&[must("corner", Kind::Corner), must("opposite", Kind::Corner)]).reaches(Reach::Mission)
        .when(zones::can),
    action(ActionId::Draw, "draw-zone", "Draw a no-go zone from the cursor", &[Key::Char('d')], &[Context::Cursor]).label("no-go").reaches(Reach::Mission)
        .when(zones::can_draw).does(zones::draw),
    action(ActionId::DrawnForm, "drawn-form", "Box, circle or polygon", &[Key::Char('s')], &[Context::Drawing]).label("shape").looks(zones::reshape),
    action(ActionId::DrawnUndo, "drawn-undo", "Remove the last corner", &[Key::Backspace], &[Context::Drawing]).label("undo").when(zones::can_undo).looks(zones::undo),
    action(ActionId::DrawnClose, "drawn-close", "Close the polygon", &[Key::Char('c')], &[Context::Drawing]).label("close").when(zones::can_close).does(zones::close),
    action(ActionId::Exclude, "exclude", "Exclude a station from the position fix", &[], &[Context::Screen]).args(&[must("station", Kind::Station)]).reaches(Reach::Mission)
        .when(|m| stations::can(m, ActionId::Exclude)),
    action(ActionId::Include, "include", "Use an excluded station again", &[], &[Context::Screen]).args(&[must("station", Kind::Station)]).reaches(Reach::Mission).when(|m| stations::can(m, ActionId::Include)),
    action(ActionId::ShowPlace, "show-place", "Show the place on the map", &[Key::Char('m')], &[On(Screen::Alarms), On(Screen::Events)]).label("map")
        .when(|m| demand(matches!(m.ui.screen, Screen::Alarms | Screen::Events), "select an alarm (<alarms>) or an event (<events>) first")).does(|m| if m.ui.screen == Screen::Events { events::show_place(m) } else { alarms::show_place(m) }),
    action(ActionId::NextLike, "next-like", "Next event of the same kind", &[Key::Char('n')], &[On(Screen::Events)]).label("same kind").when(events::is_selected).does(|m| events::next_like(m, false)),
    action(ActionId::PreviousLike, "previous-like", "Previous event of the same kind", &[Key::Char('N')], &[On(Screen::Events)]).label("same kind")
        .when(events::is_selected).does(|m| events::next_like(m, true)),
    action(ActionId::PlannerMessages, "planner-messages", "Show or hide planner messages", &[Key::Char('d')], &[On(Screen::Events)]).label("planner messages").looks(events::toggle_debug),
    action(ActionId::Copy, "copy", "Copy the event's line", &[Key::Char('y')], &[On(Screen::Events)]).label("copy").when(events::is_selected).does(events::copy),
];
