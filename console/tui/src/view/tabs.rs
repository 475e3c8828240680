//! The line of screens: which screen is shown, and the digit that shows each of the others.

use super::look::Look;
use super::text;
use crate::actions::ActionId;
use crate::model::{Model, Screen, ui::Arrangement};
use crate::theme::Role;
use crate::update::offered;
use ratatui::Frame;
use ratatui::layout::Rect;

/// One screen in the line.
struct Tab {
    id: ActionId,
    role: Role,
    text: String,
}

/// Whether the terminal is large enough for the line of screens.
pub(super) fn has_row(area: Rect) -> bool {
    matches!(Arrangement::of(area.width, area.height), Arrangement::Wide | Arrangement::Narrow)
}

/// Draws the line; a click on a screen shows it.
pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect) {
    let tabs = Screen::ALL.map(|screen| tab(look.model, screen));
    let mut x = area.x;
    for tab in &tabs {
        let width = text::width(&tab.text) as u16;
        let place = Rect { x, width, ..area }.intersection(area);
        look.cache.borrow_mut().place_key(place, tab.id);
        x = x.saturating_add(width);
    }
    frame.render_widget(look.line(tabs.into_iter().map(|tab| (tab.role, tab.text))), area);
}

/// Brackets mark the current screen, because not every terminal has colours.
fn tab(model: &Model, screen: Screen) -> Tab {
    let id = ActionId::Go(screen);
    let name = format!("{} {}", screen.digit(), screen.name());
    let is_current = screen == model.ui.screen;
    let text = if is_current { format!("[{name}]") } else { format!(" {name} ") };
    let role = match offered(model, id) {
        Err(_) => Role::Dim,
        Ok(()) if is_current => Role::Title,
        Ok(()) => Role::Text,
    };
    Tab { id, role, text }
}
