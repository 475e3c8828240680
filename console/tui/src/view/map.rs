//! The map: scanned floor below, walls, obstacles, paths and forces above, in one canvas.

mod legend;
mod pen;
mod shapes;

use super::look::Look;
use super::text;
use crate::model::{Model, Pane};
use crate::theme::Role;
use pen::Pen;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::symbols::Marker;
use ratatui::text::Line;
use ratatui::widgets::canvas::Canvas;
use shapes::Window;

/// Room about the tank, as a share of its size.
const MARGIN: f64 = 1.04;

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect) {
    let block = look.pane(Pane::Map, &title(look.model), keys(area.width));
    let inner = block.inner(area);
    frame.render_widget(block, area);
    if inner.width < 4 || inner.height < 3 {
        return;
    }
    let floor = Rect { height: inner.height - 1, ..inner };
    let below = Rect { y: inner.bottom() - 1, height: 1, ..inner };
    let readout = readout(look, inner.width);
    if let Some(window) = window(look, floor) {
        draw_floor(look, frame, floor, window);
        let room = usize::from(below.width).saturating_sub(text::width(&readout.1));
        let scale = Some(scale(window)).filter(|scale| text::width(scale) < room).unwrap_or_default();
        frame.render_widget(Line::from(look.span(Role::Dim, scale)), below);
    } else {
        frame.render_widget(Line::from(look.span(Role::Dim, " no tank loaded yet")), floor);
    }
    frame.render_widget(look.line([readout]).right_aligned(), below);
    if inner.width >= 70 && inner.height >= 20 {
        legend::draw(look, frame, floor);
    }
}

fn title(model: &Model) -> String {
    let zoom =
        if model.ui.map.zoom > 0 { format!("  ×{}", 1_u32 << model.ui.map.zoom) } else { String::new() };
    let follow = if model.ui.map.follow { "  following robot" } else { "" };
    format!("Map{zoom}{follow}")
}

fn keys(width: u16) -> &'static str {
    if width >= 70 { "f follow  z Z zoom  0 whole tank  L layers" } else { "f z Z 0 L" }
}

/// What of the floor is seen in an area.
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
    let pen = Pen { look: *look, window };
    let canvas =
        Canvas::default().marker(Marker::Braille).x_bounds(window.x).y_bounds(window.y).paint(|ctx| {
            pen.scanned(ctx);
            pen.forecast(ctx);
            ctx.marker(Marker::Braille);
            pen.zones(ctx);
            pen.paths(ctx);
            pen.drawings(ctx);
            pen.solid(ctx);
            pen.tether(ctx);
            pen.robot(ctx);
            ctx.layer();
            pen.labels(ctx);
        });
    frame.render_widget(canvas, area);
}

/// The robot's place and the error of it, in words.
fn readout(look: &Look, width: u16) -> (Role, String) {
    let position = &look.run.position;
    let name = if width >= 60 { "robot " } else { "" };
    let Some(pose) = &position.pose else { return (Role::Dim, "robot: no position yet ".into()) };
    let at = text::place(pose.position);
    let error = text::number(position.error_m().unwrap_or(f64::NAN), 2);
    let stale = if position.is_fix_stale(look.run.clock.t_s) { "◌ " } else { "" };
    let role = if position.lost { Role::Crit } else { Role::Text };
    let lost = if position.lost { " LOST" } else { "" };
    (role, format!("{stale}{name}{at} ±{error} m{lost} "))
}

/// A bar of a round number of metres.
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
