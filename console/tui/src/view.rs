//! Draws the model on the screen.

pub(crate) mod alarm_screen;
mod alarms;
mod ascii;
mod cache;
mod charts;
mod confirm;
mod coverage;
mod event_detail;
pub(crate) mod events;
mod field;
mod fields;
mod footer;
pub(crate) mod home;
mod lists;
pub(crate) mod look;
mod map;
mod missed;
mod next;
mod notice;
mod past_run;
pub(crate) mod plan;
mod planner;
pub(crate) mod plugins;
mod position;
mod readable;
pub(crate) mod result;
pub(crate) mod review;
mod run_details;
pub(crate) mod scroll;
mod setting;
mod shadow;
mod small_map;
mod stations;
mod strip;
mod survey;
pub(crate) mod table;
mod tabs;
mod tether;
pub(crate) mod text;
mod timeline;
mod top;
mod what_if;

pub use cache::{Cache, Places};

pub(crate) use confirm::question;
pub(crate) use coverage::Bases;
pub(crate) use next::{by_command, standing};

use crate::caps::{Caps, Colours, Glyphs};
use crate::layout::{self, Shown};
use crate::model::{Model, Overlay, Pane, ui::Arrangement};
use crate::theme::Theme;
use look::Look;
use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use std::cell::RefCell;

/// Draws the model.
///
/// Pure: the same model, caps and size give the same cells.
pub fn view(model: &Model, caps: &Caps, frame: &mut Frame) {
    view_cached(model, caps, &mut Cache::default(), frame);
}

/// Draws the model using the cache of the previous frame; the cells are the same as without a cache.
pub fn view_cached(model: &Model, caps: &Caps, cache: &mut Cache, frame: &mut Frame) {
    draw(model, *caps, &Theme::new(model.ui.theme, caps), cache, frame);
}

/// Draws the model with the given theme.
pub fn view_with(model: &Model, caps: &Caps, theme: &Theme, frame: &mut Frame) {
    draw(model, *caps, theme, &mut Cache::default(), frame);
}

fn draw(model: &Model, caps: Caps, theme: &Theme, cache: &mut Cache, frame: &mut Frame) {
    let area = frame.area();
    if area.is_empty() {
        return;
    }
    cache.clear_places();
    let shared = RefCell::new(std::mem::take(cache));
    let look = Look { model, run: &model.live.run, caps, theme, cache: &shared };
    let arrangement = Arrangement::of(area.width, area.height);
    let notice = if arrangement == Arrangement::Strip {
        strip::draw(&look, frame, area);
        0
    } else {
        framed(&look, frame, area, arrangement)
    };
    // A list leaves the notice visible.
    lists::draw(&look, frame, Rect { height: area.height.saturating_sub(notice), ..area });
    readable::make(frame.buffer_mut());
    if caps.glyphs == Glyphs::Ascii {
        ascii::reduce(frame.buffer_mut());
    }
    *cache = shared.into_inner();
}

/// The parts of the terminal on every screen, from top to bottom: the top line, the line of screens, the screen itself, the
/// notice, the state with the open question, and the keys.
fn parts(model: &Model, area: Rect) -> [Rect; 6] {
    let has_tabs = tabs::has_row(area);
    let state = confirm::rows(model, area.width);
    let free = area.height.saturating_sub(2 + u16::from(has_tabs) + state);
    Layout::vertical([
        Constraint::Length(1),
        Constraint::Length(has_tabs.into()),
        Constraint::Fill(1),
        Constraint::Length(notice::rows(model, area.width, free)),
        Constraint::Length(state),
        Constraint::Length(1),
    ])
    .areas(area)
}

/// The area of the screen itself, between the lines that every screen has.
pub(crate) fn body(model: &Model, area: Rect) -> Rect {
    parts(model, area)[2]
}

/// How many rows the details of the selected row can be scrolled at most, at the size of the screen.
pub(crate) fn most_scrolled(model: &Model) -> usize {
    let caps = Caps { colours: Colours::True, glyphs: Glyphs::Braille, ssh: false };
    let (theme, cache) = (Theme::new(model.ui.theme, &caps), RefCell::default());
    let look = Look { model, run: &model.live.run, caps, theme: &theme, cache: &cache };
    let area = body(model, Rect::new(0, 0, model.ui.width, model.ui.height));
    (model.ui.screen.row().detail)(&look, area).map_or(0, scroll::Extent::most)
}

/// Draws a screen between the top lines and the two bottom lines, which every screen has. Returns the rows of the notice.
fn framed(look: &Look, frame: &mut Frame, area: Rect, arrangement: Arrangement) -> u16 {
    let [top, screens, body, notice, next, keys] = parts(look.model, area);
    top::draw(look, frame, top);
    if tabs::has_row(area) {
        tabs::draw(look, frame, screens);
    }
    notice::draw(look, frame, notice);
    if look.model.ui.overlay == Overlay::WhatIf {
        what_if::draw(look, frame, body, arrangement);
    } else {
        (look.model.ui.screen.row().draw)(look, frame, body, arrangement);
    }
    confirm::draw(look, frame, next);
    footer::draw(look, frame, keys);
    notice.height
}

/// Draws the mission screen: the panes that fit, and below them the timeline of a replay.
pub(crate) fn mission(look: &Look, frame: &mut Frame, area: Rect, arrangement: Arrangement) {
    let size = (frame.area().width, frame.area().height);
    let area = timeline::draw(look, frame, area, arrangement);
    let turned = Some(look.model.ui.pane)
        .filter(|pane| matches!(pane, Pane::Stations | Pane::Tether | Pane::Coverage));
    let shown = Shown { turned, ..Shown::of(look.run, missed::account(look).is_some()) };
    let mut panes = layout::mission(area, size, shown);
    if look.model.ui.shows_one() {
        panes = vec![(look.model.ui.pane, area)];
    }
    if panes.is_empty() {
        panes = layout::page(area, look.model.ui.pane, shown);
    }
    for (pane, area) in panes {
        draw_pane(look, frame, area, pane);
    }
}

fn draw_pane(look: &Look, frame: &mut Frame, area: Rect, pane: Pane) {
    match pane {
        Pane::Map => map::draw(look, frame, area),
        Pane::Coverage => match &look.run.survey {
            Some(survey) => survey::draw(look, survey, frame, area),
            None => coverage::draw(look, frame, area),
        },
        Pane::Position => position::draw(look, frame, area),
        Pane::Tether => tether::draw(look, frame, area),
        Pane::Planner => planner::draw(look, frame, area),
        Pane::Events => events::draw(look, frame, area),
        Pane::Alarms => alarms::draw(look, frame, area),
        Pane::Stations => stations::draw(look, frame, area),
        Pane::Missed => missed::draw(look, frame, area),
        Pane::Chart(chart) => charts::draw(look, frame, area, chart),
        // Panes of the plan and result screens.
        Pane::Plan
        | Pane::Promise
        | Pane::LeftOut
        | Pane::Parameters
        | Pane::Checks
        | Pane::Figures
        | Pane::Plates
        | Pane::List
        | Pane::Detail => {}
    }
}
