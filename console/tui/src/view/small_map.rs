//! A small map of a tank that does not follow the robot: walls, obstacles, stations, scanned floor, a trail, and marked
//! places.

use super::look::Look;
use super::map::{Pen, TRAIL, Window};
use crate::model::{Raster, Run};
use crate::theme::Role;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::Line;
use ratatui::widgets::canvas::{Canvas, Context};
use world::{FloorClass, Point, World};

/// Margin around the tank, as a factor of its size.
const MARGIN: f64 = 1.06;
/// Smallest area in which a tank is recognisable, columns and rows.
const LEAST: (u16, u16) = (16, 6);

/// The contents of a small map.
pub(super) struct SmallMap<'a> {
    pub world: &'a World,
    /// The scanned floor, and whether unscanned floor counts as missed.
    pub scanned: Option<(&'a Raster, bool)>,
    pub trail: &'a [Point],
    /// Places with the text that marks them.
    pub marks: Vec<(Point, Role, String)>,
}

impl<'a> SmallMap<'a> {
    /// The tank alone.
    pub(super) fn of(world: &'a World) -> Self {
        Self { world, scanned: None, trail: &[], marks: Vec::new() }
    }

    /// The tank of a run with its floor and trail; `None` until the run is opened.
    pub(super) fn of_run(run: &'a Run) -> Option<Self> {
        let world = &run.about.as_ref()?.world;
        let scanned = run.coverage.as_ref().map(|raster| (raster, run.has_missed()));
        Some(Self { world, scanned, trail: run.trail.points(), marks: Vec::new() })
    }

    /// The same map with a marked place.
    #[must_use]
    pub(super) fn marked(mut self, at: Point, role: Role, text: &str) -> Self {
        self.marks.push((at, role, text.to_owned()));
        self
    }
}

/// Draws a small map; draws nothing if the area is too small for one.
pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect, map: &SmallMap) {
    let Some(window) = window(map.world, area) else { return };
    let pen = Pen { look: *look, window };
    let canvas = Canvas::default().marker(pen.marker()).x_bounds(window.x).y_bounds(window.y).paint(|ctx| {
        pen.no_go(ctx, map.world);
        pen.draw(ctx, map.trail, TRAIL);
        pen.solids(ctx, map.world);
        ctx.layer();
        signs(look, ctx, map);
    });
    frame.render_widget(canvas, area);
    if let Some((raster, has_ended)) = map.scanned {
        shade(look, frame, area, (window, raster, has_ended));
    }
}

fn window(world: &World, area: Rect) -> Option<Window> {
    let (low, high) = world.boundary.bounds();
    let span = high - low;
    let column_m = (span.x / f64::from(area.width)).max(span.y / (2.0 * f64::from(area.height))) * MARGIN;
    let fits = area.width >= LEAST.0 && area.height >= LEAST.1;
    let is_sound = column_m.is_finite() && column_m > 0.0 && low.x.is_finite() && low.y.is_finite();
    (fits && is_sound)
        .then(|| Window::new(nalgebra::center(&low, &high), column_m, (area.width, area.height)))
}

fn signs(look: &Look, ctx: &mut Context<'_>, map: &SmallMap) {
    let mut print = |at: Point, role: Role, text: &str| {
        ctx.print(at.x, at.y, Line::styled(text.to_owned(), look.theme.style(role)));
    };
    for station in &map.world.stations {
        let name = if station.name.chars().count() <= 2 { &station.name } else { "S" };
        print(station.position, Role::Station, name);
    }
    for (at, role, text) in &map.marks {
        print(*at, *role, text);
    }
}

/// Shades the floor where nothing else is drawn.
fn shade(look: &Look, frame: &mut Frame, area: Rect, (window, raster, has_ended): (Window, &Raster, bool)) {
    let cells = (0..area.height).flat_map(|row| (0..area.width).map(move |column| (column, row)));
    for (column, row) in cells {
        let cell = &mut frame.buffer_mut()[(area.x + column, area.y + row)];
        if cell.symbol() != " " {
            continue;
        }
        let class = raster.class_in(window.middle_of(column, row), 1.5 * window.column_m, has_ended);
        let (sign, role) = match class {
            Some(FloorClass::Scanned | FloorClass::Again) => ('▒', Role::Scanned),
            Some(FloorClass::Partial) => ('░', Role::Partly),
            Some(FloorClass::Missed) => ('▓', Role::Missed),
            _ => continue,
        };
        cell.set_char(sign).set_fg(look.theme.color(role));
    }
}
