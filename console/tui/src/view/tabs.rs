//! The line of screens: which screen is shown, and the digit that shows each of the others.

use super::look::Look;
use super::text;
use crate::actions::ActionId;
use crate::model::{Model, Screen, ui::Arrangement};
use crate::theme::Role;
use crate::update::offered;
use ratatui::Frame;
use ratatui::layout::Rect;

/// The minimum number of rows of a terminal at which the line of screens has its own row.
const OWN_ROW: u16 = 36;

/// How much of the line is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Form {
    /// Every screen with its name.
    Names,
    /// Every digit, and the name of the current screen.
    Digits,
    /// The current screen only.
    Current,
}

/// One screen in the line.
struct Tab {
    id: ActionId,
    role: Role,
    text: String,
}

/// Whether the line of screens has its own row below the top line.
pub(super) fn has_row(area: Rect) -> bool {
    Arrangement::of(area.width, area.height) == Arrangement::Wide && area.height >= OWN_ROW
}

/// The width of the line, columns.
pub(super) fn width(model: &Model, form: Form) -> usize {
    tabs(model, form).iter().map(|tab| text::width(&tab.text)).sum()
}

/// Draws the line at the left end of an area; a click on a screen shows it.
pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect, form: Form) {
    let tabs = tabs(look.model, form);
    let mut x = area.x;
    for tab in &tabs {
        let width = text::width(&tab.text) as u16;
        let place = Rect { x, width, ..area }.intersection(area);
        look.cache.borrow_mut().place_key(place, tab.id);
        x = x.saturating_add(width);
    }
    frame.render_widget(look.line(tabs.into_iter().map(|tab| (tab.role, tab.text))), area);
}

fn tabs(model: &Model, form: Form) -> Vec<Tab> {
    let all = Screen::ALL.into_iter();
    let shown = all.filter(|screen| form != Form::Current || *screen == model.ui.screen);
    shown.map(|screen| tab(model, screen, form)).collect()
}

/// Brackets mark the current screen, because not every terminal has colours.
fn tab(model: &Model, screen: Screen, form: Form) -> Tab {
    let id = ActionId::Go(screen);
    let name = format!("{} {}", screen.digit(), screen.name());
    let (role, text) = match form {
        _ if screen == model.ui.screen => (Role::Title, format!("[{name}]")),
        Form::Names => (Role::Text, format!(" {name} ")),
        Form::Digits | Form::Current if screen < model.ui.screen => {
            (Role::Text, format!("{} ", screen.digit()))
        }
        Form::Digits | Form::Current => (Role::Text, format!(" {}", screen.digit())),
    };
    let role = if offered(model, id).is_ok() { role } else { Role::Dim };
    Tab { id, role, text }
}
