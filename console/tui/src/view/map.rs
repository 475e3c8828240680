//! The map, on one canvas: scanned floor at the bottom; walls, obstacles, paths and forces on top.

mod course;
mod crowd;
mod drawn;
mod ink;
mod labels;
mod legend;
mod pattern;
mod pen;
mod plates;
mod readout;
mod scan;
mod shade;
mod shadow;
mod shapes;
mod survey;
mod thin;
mod zone;

pub(super) use ink::TRAIL;
pub(super) use legend::of_floor as floor_legend;
pub(super) use pattern::Pattern;
pub(super) use pen::{Pen, nearest};
pub(super) use plates::{Key as PlateKey, PlateDrawing};
pub(super) use shade::{Key as ShadeKey, Shades, lay, of_run as shades_of_run};
pub(super) use shapes::{Stroke, Window};

use super::look::{Look, Parts};
use super::text;
use crate::model::{Model, Overlay, Pane, Screen};
use crate::theme::Role;
use mission::Severity;
use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::text::Line;
use ratatui::widgets::canvas::Canvas;

/// Margin around the tank, as a factor of its size.
const MARGIN: f64 = 1.04;
pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect) {
    let ui = &look.model.ui;
    let title = title(look.model);
    let titled = text::width(&title) + text::width(&look.pane_key(Pane::Map));
    let mut block = look.pane(Pane::Map, &title, &keys(look, usize::from(area.width), titled));
    if let Some(at) = ui.cursor {
        block = block.title_bottom(look.span(Role::Title, format!("─ {} ", readout::floor(look, at))));
    }
    let inner = block.inner(area);
    frame.render_widget(block, area);
    if inner.width < 4 || inner.height < 3 {
        return;
    }
    let [floor, alarm, below] = Layout::vertical([
        Constraint::Fill(1),
        Constraint::Length(u16::from(critical(look).is_some())),
        Constraint::Length(1),
    ])
    .areas(inner);
    if look.run.about.is_some() {
        floor_and_legend(look, frame, floor);
    } else {
        frame.render_widget(Line::from(look.span(Role::Dim, " no tank loaded yet")), floor);
    }
    if let Some(text) = critical(look) {
        let columns = usize::from(alarm.width);
        let text = text::clauses(text, columns.saturating_sub(7));
        let text = text::column(&format!(" CRIT {text}"), columns);
        frame.render_widget(Line::from(look.span(Role::Crit, text)), alarm);
    }
    let window = look.cache.borrow().places().window();
    let robot = readout::robot(look, inner.width);
    let left = readout::cursor(look, ui, inner.width)
        .or_else(|| window.map(|window| (Role::Dim, scale(window))))
        .unwrap_or((Role::Dim, String::new()));
    // The operator asked for the cursor, so the scale is dropped if space is short.
    let room = usize::from(below.width).saturating_sub(text::width(&robot.1));
    let fits = text::width(&left.1) < room;
    if fits || ui.cursor.is_some() {
        frame.render_widget(look.line([left]), below);
    }
    if fits || ui.cursor.is_none() {
        frame.render_widget(look.line([robot]).right_aligned(), below);
    }
}

/// The text of the worst alarm if it is critical; it has its own line under the map of a mission.
fn critical<'a>(look: &Look<'a>) -> Option<&'a str> {
    let worst =
        look.run.alarms.worst().filter(|alarm| alarm.severity == Severity::Crit && alarm.is_active())?;
    (look.model.ui.screen == Screen::Mission && look.model.ui.overlay != Overlay::WhatIf)
        .then_some(&worst.text)
}

/// Draws the floor with its legend in one place: where the map is blank beside the floor or, if it does not fit there, in
/// lines below the floor, which is then drawn smaller.
fn floor_and_legend(look: &Look, frame: &mut Frame, area: Rect) {
    let Some((window, placed, rows)) = settled(look, area) else { return };
    let [floor, lines] = Layout::vertical([Constraint::Fill(1), Constraint::Length(rows)]).areas(area);
    draw_floor(look, frame, floor, window);
    legend::draw(look, frame, floor, &placed);
    let below = legend::fitting(look, &placed.below, (rows, usize::from(lines.width)));
    legend::draw_lines(look, frame, lines, &below);
    look.cache.borrow_mut().place_map(floor, window);
}

/// The part of the floor that is drawn, its legend, and the number of lines of the legend below the floor.
fn settled(look: &Look, area: Rect) -> Option<(Window, legend::Placed, u16)> {
    let ((window, placed), rows) = with_legend(area, |floor, is_whole| {
        let window = window(look, floor)?;
        let entries = legend::entries(look, window);
        let placed = if is_whole {
            legend::Placed::new(look, window, entries)
        } else {
            legend::Placed::below(entries)
        };
        let needed = legend::rows(&placed.below, area);
        Some(((window, placed), needed))
    })?;
    Some((window, placed, rows))
}

/// Shrinks a map until its legend fits in lines below it. A smaller map can need a longer legend, because it shows fewer
/// lanes, so the legend is always that of the map that is drawn. `made` makes the legend of a map in an area, which may
/// be the whole of `area`, and the number of its lines. Returns the last legend, and the number of lines kept free for
/// it.
pub(super) fn with_legend<L>(area: Rect, made: impl Fn(Rect, bool) -> Option<(L, u16)>) -> Option<(L, u16)> {
    let mut rows = 0;
    loop {
        let (legend, needed) = made(Rect { height: area.height - rows, ..area }, rows == 0)?;
        let needed = needed.min(area.height);
        if needed <= rows {
            return Some((legend, rows));
        }
        rows = needed;
    }
}

/// The legend of the map that has been drawn in this frame, in lines of a given width; empty without a map.
pub(super) fn legend(look: &Look, columns: usize) -> Vec<Parts> {
    let window = look.cache.borrow().places().window();
    window.map_or_else(Vec::new, |window| legend::in_lines(look, window, columns))
}

fn title(model: &Model) -> String {
    let zoom =
        if model.ui.map.zoom > 0 { format!("  ×{}", 1_u32 << model.ui.map.zoom) } else { String::new() };
    let follow = if model.ui.map.follow { "  following robot" } else { "" };
    format!("Map{zoom}{follow}")
}

/// As many keys as fit next to the title.
fn keys(look: &Look, width: usize, title: usize) -> String {
    const KEYS: [&str; 2] = [
        "<zoom-in> <zoom-out> zoom  <follow> follow  <whole-tank> whole tank  <layers> layers  <inspect> read",
        "<zoom-in> <zoom-out> <follow> <whole-tank> <layers> <inspect>",
    ];
    let mut spelled = KEYS.into_iter().map(|keys| look.keys(keys));
    spelled.find(|keys| text::width(keys) + title + 9 <= width).unwrap_or_default()
}

/// The part of the floor that is visible in an area.
fn window(look: &Look, area: Rect) -> Option<Window> {
    let (model, run) = (look.model, look.run);
    let (low, high) = run.about.as_ref()?.world.boundary.bounds();
    let (middle, span) = (nalgebra::center(&low, &high), high - low);
    let wide_m = span.x / f64::from(area.width);
    let high_m = span.y / (2.0 * f64::from(area.height));
    let column_m = wide_m.max(high_m) * MARGIN / f64::from(1_u32 << model.ui.map.zoom);
    let robot = run.position.pose.as_ref().map(|pose| pose.position);
    let center = model.ui.map_center(middle, robot);
    let sound = column_m.is_finite() && column_m > 0.0 && center.x.is_finite() && center.y.is_finite();
    sound.then(|| Window::new(center, column_m, (area.width, area.height)))
}

fn draw_floor(look: &Look, frame: &mut Frame, area: Rect, window: Window) {
    let Some(world) = look.run.about.as_ref().map(|about| &about.world) else { return };
    let pen = Pen { look: *look, window };
    let marker = pen.marker();
    let canvas = Canvas::default().marker(marker).x_bounds(window.x).y_bounds(window.y).paint(|ctx| {
        pen.plates(ctx);
        pen.no_go(ctx, world);
        pen.paths(ctx);
        pen.blocked(ctx);
        pen.drawings(ctx);
        pen.survey(ctx);
        pen.scan(ctx);
        pen.solids(ctx, world);
        pen.tether(ctx);
        pen.shadow(ctx);
        pen.zone(ctx);
        pen.robot(ctx);
    });
    frame.render_widget(canvas, area);
    labels::draw(look, window, area, frame.buffer_mut());
    shade::paint(look, window, area, frame.buffer_mut());
}

/// A scale bar for a round number of metres.
fn scale(window: Window) -> String {
    let longest_m = window.column_m * 16.0;
    let decade = 10.0_f64.powf(longest_m.log10().floor());
    let length_m =
        [5.0, 2.0, 1.0].into_iter().map(|step| step * decade).find(|m| *m <= longest_m).unwrap_or(decade);
    let columns = (length_m / window.column_m).round() as usize;
    let decimals = if length_m < 1.0 { 1 + usize::from(length_m < 0.1) } else { 0 };
    let label = format!(" {} m ", text::number(length_m, decimals));
    let dashes = columns.saturating_sub(text::width(&label) + 2);
    let (left, right) = (dashes / 2, dashes - dashes / 2);
    format!(" ├{}{label}{}┤", "─".repeat(left), "─".repeat(right))
}
