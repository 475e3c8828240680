//! A small map of a tank that does not follow the robot: walls, obstacles, stations, scanned floor, a trail, and marked
//! places.

use super::look::Look;
use super::map::{Filled, Pattern, Stroke, Window, ellipse};
use crate::caps::Glyphs;
use crate::model::{Raster, Run};
use crate::theme::Role;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::symbols::Marker;
use ratatui::text::Line;
use ratatui::widgets::canvas::{Canvas, Context};
use world::{Boundary, FloorClass, Point, World, ZoneKind};

/// Margin around the tank, as a factor of its size.
const MARGIN: f64 = 1.06;
/// The number of segments in a round wall.
const WALL_PIECES: u32 = 128;
/// Smallest area in which a tank is recognisable, columns and rows.
const LEAST: (u16, u16) = (16, 6);

/// The contents of a small map.
pub(super) struct Sketch<'a> {
    pub world: &'a World,
    /// The scanned floor, and whether unscanned floor counts as missed.
    pub scanned: Option<(&'a Raster, bool)>,
    pub trail: &'a [Point],
    /// Places with the text that marks them.
    pub marks: Vec<(Point, Role, String)>,
}

impl<'a> Sketch<'a> {
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

    /// The same with a marked place.
    #[must_use]
    pub(super) fn marked(mut self, at: Point, role: Role, text: &str) -> Self {
        self.marks.push((at, role, text.to_owned()));
        self
    }
}

/// Draws a small map; draws nothing if the area is too small for one.
pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect, sketch: &Sketch) {
    let Some(window) = window(sketch.world, area) else { return };
    let marker = if look.caps.glyphs == Glyphs::Octant { Marker::Octant } else { Marker::Braille };
    let canvas = Canvas::default().marker(marker).x_bounds(window.x).y_bounds(window.y).paint(|ctx| {
        lines(look, ctx, window, sketch);
        ctx.layer();
        signs(look, ctx, sketch);
    });
    frame.render_widget(canvas, area);
    if let Some((raster, has_ended)) = sketch.scanned {
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

fn lines(look: &Look, ctx: &mut Context<'_>, window: Window, sketch: &Sketch) {
    // Without braille, each kind of line has its own character.
    let has_dots = look.caps.glyphs.has_dots();
    let take_up = |ctx: &mut Context<'_>, plain: char| {
        if !has_dots {
            ctx.marker(Marker::Custom(plain));
        }
    };
    let color = |role| look.theme.color(role);
    take_up(ctx, 'x');
    for zone in sketch.world.zones.iter().filter(|zone| zone.kind == ZoneKind::NoGo) {
        ctx.draw(&Filled { shape: &zone.shape, window, hatched: true, color: color(Role::NoGo) });
    }
    take_up(ctx, '.');
    ctx.draw(&Stroke { points: sketch.trail, window, pattern: Pattern::Solid, color: color(Role::Trail) });
    take_up(ctx, 'o');
    let wall = match &sketch.world.boundary {
        Boundary::Circle { radius_m } => ellipse(Point::origin(), (*radius_m, *radius_m), 0.0, WALL_PIECES),
        Boundary::Polygon { vertices } => vertices.iter().chain(vertices.first()).copied().collect(),
    };
    ctx.draw(&Stroke { points: &wall, window, pattern: Pattern::Solid, color: color(Role::Wall) });
    take_up(ctx, '#');
    for obstacle in &sketch.world.obstacles {
        let role = if obstacle.known { Role::Obstacle } else { Role::Found };
        ctx.draw(&Filled { shape: &obstacle.shape, window, hatched: false, color: color(role) });
    }
}

fn signs(look: &Look, ctx: &mut Context<'_>, sketch: &Sketch) {
    let mut print = |at: Point, role: Role, text: &str| {
        ctx.print(at.x, at.y, Line::styled(text.to_owned(), look.theme.style(role)));
    };
    for station in &sketch.world.stations {
        let name = if station.name.chars().count() <= 2 { &station.name } else { "S" };
        print(station.position, Role::Station, name);
    }
    for (at, role, text) in &sketch.marks {
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
