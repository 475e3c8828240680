//! The model onto the screen.

mod ascii;
mod confirm;
mod coverage;
mod events;
mod field;
mod footer;
mod home;
mod lists;
mod look;
mod map;
mod next;
mod plan;
mod planner;
mod position;
mod result;
mod strip;
mod table;
mod tether;
mod text;
mod top;

pub(crate) use confirm::question;
pub(crate) use events::log_line;
pub(crate) use next::standing;

use crate::caps::{Caps, Glyphs};
use crate::model::{Model, Pane, Screen, ui::Arrangement};
use crate::theme::Theme;
use look::Look;
use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};

/// Draws the model.
///
/// Pure: the same model, caps and size give the same cells.
pub fn view(model: &Model, caps: &Caps, frame: &mut Frame) {
    view_with(model, caps, &Theme::new(model.ui.theme, caps), frame);
}

/// Draws the model with a theme of the caller's choice.
pub fn view_with(model: &Model, caps: &Caps, theme: &Theme, frame: &mut Frame) {
    let look = Look { model, run: &model.live.run, caps: *caps, theme };
    let area = frame.area();
    if area.is_empty() {
        return;
    }
    let arrangement = Arrangement::of(area.width, area.height);
    if arrangement == Arrangement::Strip {
        strip::draw(&look, frame, area);
    } else {
        framed(&look, frame, area, arrangement);
    }
    lists::draw(&look, frame, area);
    if caps.glyphs == Glyphs::Ascii {
        ascii::reduce(frame.buffer_mut());
    }
}

/// Sizes of the parts of a whole screen.
struct Sizes {
    side: u16,
    events: u16,
    /// Heights of the panes at the side; the last one takes the rest.
    panes: [u16; 2],
    wide: bool,
}

const WIDE: Sizes = Sizes { side: 44, events: 6, panes: [10, 8], wide: true };
const NARROW: Sizes = Sizes { side: 30, events: 4, panes: [6, 5], wide: false };

/// Draws a screen between the line on top and the two lines at the foot, which every screen has.
fn framed(look: &Look, frame: &mut Frame, area: Rect, arrangement: Arrangement) {
    let [top, body, next, keys] = Layout::vertical([
        Constraint::Length(1),
        Constraint::Fill(1),
        Constraint::Length(1),
        Constraint::Length(1),
    ])
    .areas(area);
    top::draw(look, frame, top);
    match (look.model.ui.screen, arrangement) {
        (Screen::Home, _) => home::draw(look, frame, body, arrangement),
        (Screen::Plan, _) => plan::draw(look, frame, body, arrangement),
        (Screen::Result, _) => result::draw(look, frame, body, arrangement),
        (Screen::Mission, Arrangement::Wide) => whole(look, frame, body, &WIDE),
        (Screen::Mission, Arrangement::Narrow) => whole(look, frame, body, &NARROW),
        (Screen::Mission, Arrangement::Paged | Arrangement::Strip) => page(look, frame, body),
    }
    confirm::draw(look, frame, next);
    footer::draw(look, frame, keys);
}

fn whole(look: &Look, frame: &mut Frame, area: Rect, sizes: &Sizes) {
    let [middle, events] =
        Layout::vertical([Constraint::Fill(1), Constraint::Length(sizes.events)]).areas(area);
    let [map, side] = Layout::horizontal([Constraint::Fill(1), Constraint::Length(sizes.side)]).areas(middle);
    let [coverage, position, planner] = Layout::vertical([
        Constraint::Length(sizes.panes[0]),
        Constraint::Length(sizes.panes[1]),
        Constraint::Fill(1),
    ])
    .areas(side);
    map::draw(look, frame, map);
    coverage::draw(look, frame, coverage, sizes.wide);
    position::draw(look, frame, position, sizes.wide);
    let planner = above_tether(look, frame, planner, sizes.wide);
    planner::draw(look, frame, planner, sizes.wide);
    events::draw(look, frame, events);
}

fn page(look: &Look, frame: &mut Frame, area: Rect) {
    match look.model.ui.pane {
        Pane::Map => map::draw(look, frame, area),
        Pane::Coverage => coverage::draw(look, frame, area, true),
        Pane::Position => position::draw(look, frame, area, true),
        Pane::Planner => {
            let area = above_tether(look, frame, area, true);
            planner::draw(look, frame, area, true);
        }
        Pane::Events => events::draw(look, frame, area),
    }
}

/// Draws the tether at the foot of an area, if there is one, in as many words as fit; what is left above it.
///
/// Where there is no room for both, the tether takes it: what it shows can end a mission.
fn above_tether(look: &Look, frame: &mut Frame, area: Rect, wide: bool) -> Rect {
    if look.run.tether.is_none() {
        return area;
    }
    // The planner keeps a row of its own.
    let wide = wide && area.height >= tether::ROWS.0 + 3;
    let rows = if wide { tether::ROWS.0 } else { tether::ROWS.1 };
    let rows = if area.height >= rows + 3 { rows } else { area.height };
    let [above, below] = Layout::vertical([Constraint::Fill(1), Constraint::Length(rows)]).areas(area);
    tether::draw(look, frame, below, wide);
    above
}
