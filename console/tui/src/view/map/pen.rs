//! Draws everything on the map's canvas except paths and letters.

use super::drawn;
use super::ink::{self, Ink};
use super::pattern::Pattern;
use super::plates::{self, Outlines};
use super::shapes::{Filled, Stroke, Window, ellipse};
use crate::caps::Glyphs;
use crate::model::position;
use crate::theme::Role;
use crate::view::look::Look;
use ratatui::symbols::Marker;
use ratatui::text::Line;
use ratatui::widgets::canvas::Context;
use world::{Boundary, Point, World, ZoneKind};

/// The number of segments in a round wall.
const WALL_PIECES: u32 = 256;
/// Dots per character.
pub(super) const DOTS: (u16, u16) = (2, 4);

/// Draws the model on the canvas.
pub(in crate::view) struct Pen<'a> {
    pub look: Look<'a>,
    pub window: Window,
}

impl Pen<'_> {
    /// Without braille, each kind of line has its own character and layer.
    pub(super) fn take_up(&self, ctx: &mut Context<'_>, plain: char) {
        if !self.look.caps.glyphs.has_dots() {
            ctx.marker(Marker::Custom(plain));
        }
    }

    /// Draws a line of a kind. Letters tell the kinds apart, so that a line of letters is one letter wide.
    pub(in crate::view) fn draw(&self, ctx: &mut Context<'_>, points: &[Point], ink: Ink) {
        self.take_up(ctx, ink.letter);
        let pattern = if self.look.caps.glyphs.has_dots() { ink.pattern } else { ink.pattern.in_letters() };
        self.stroke(ctx, points, ink.role, pattern);
    }

    pub(super) fn stroke(&self, ctx: &mut Context<'_>, points: &[Point], role: Role, pattern: Pattern) {
        let color = self.look.theme.color(role);
        ctx.draw(&Stroke { points, window: self.window, pattern, color });
    }

    /// The markers of the map: dots if the terminal has them.
    pub(in crate::view) fn marker(&self) -> Marker {
        if self.look.caps.glyphs == Glyphs::Octant { Marker::Octant } else { Marker::Braille }
    }

    pub(super) fn plates(&self, ctx: &mut Context<'_>) {
        let Some(drawing) = plates::plates(&self.look, self.window) else { return };
        self.take_up(ctx, '`');
        ctx.draw(&Outlines(&drawing, self.look.theme.color(Role::Plate)));
        for (at, name) in &drawing.names {
            ctx.print(at.x, at.y, Line::styled(name.clone(), self.look.theme.style(Role::Plate)));
        }
    }

    /// The no-go zones of a tank.
    pub(in crate::view) fn no_go(&self, ctx: &mut Context<'_>, world: &World) {
        self.take_up(ctx, 'x');
        for zone in world.zones.iter().filter(|zone| zone.kind == ZoneKind::NoGo) {
            let color = self.look.theme.color(Role::NoGo);
            ctx.draw(&Filled { shape: &zone.shape, window: self.window, hatched: true, color });
        }
    }

    pub(super) fn drawings(&self, ctx: &mut Context<'_>) {
        for drawing in drawn::shown(&self.look) {
            self.draw(ctx, &drawn::points(drawing), drawn::ink(drawing));
        }
    }

    /// The wall and the obstacles of a tank.
    pub(in crate::view) fn solids(&self, ctx: &mut Context<'_>, world: &World) {
        let wall = match &world.boundary {
            Boundary::Circle { radius_m } => {
                ellipse(Point::origin(), (*radius_m, *radius_m), 0.0, WALL_PIECES)
            }
            Boundary::Polygon { vertices } => vertices.iter().chain(vertices.first()).copied().collect(),
        };
        self.draw(ctx, &wall, ink::WALL);
        self.take_up(ctx, '#');
        for obstacle in &world.obstacles {
            let color = self.look.theme.color(if obstacle.known { Role::Obstacle } else { Role::Found });
            ctx.draw(&Filled { shape: &obstacle.shape, window: self.window, hatched: false, color });
        }
    }

    /// The taut cable, on top of everything else that does not move.
    pub(super) fn tether(&self, ctx: &mut Context<'_>) {
        if let Some(tether) = &self.look.run.tether {
            self.draw(ctx, &tether.lies, ink::CABLE);
            self.draw(ctx, &tether.line, ink::TETHER);
        }
    }

    /// The hull and the 95 % error, if they are large enough to be visible.
    pub(super) fn robot(&self, ctx: &mut Context<'_>) {
        let Some(pose) = &self.look.run.position.pose else { return };
        self.take_up(ctx, '+');
        let radius_m = self.look.run.about.as_ref().map_or(0.0, |run| run.mission.limits.radius_m);
        if radius_m > self.window.column_m {
            self.stroke(
                ctx,
                &ellipse(pose.position, (radius_m, radius_m), 0.0, 48),
                Role::Robot,
                Pattern::Solid,
            );
        }
        let (long_m, short_m, turned_rad) = position::ellipse_95(pose);
        if long_m > self.window.column_m {
            self.stroke(
                ctx,
                &ellipse(pose.position, (long_m, short_m), turned_rad, 64),
                Role::Warn,
                Pattern::Dotted,
            );
        }
    }
}

/// The points of a path, up to a given length.
pub(super) fn within(path: &[Point], length_m: f64) -> &[Point] {
    let mut walked_m = 0.0;
    let steps = path.windows(2).take_while(|pair| {
        walked_m += (pair[1] - pair[0]).norm();
        walked_m <= length_m
    });
    let last = steps.count();
    path.get(..=last).unwrap_or(path)
}

/// The index of the path point nearest to a place; 0 if the path is empty.
pub(in crate::view) fn nearest(path: &[Point], place: Point) -> usize {
    let distance = |point: &Point| (point - place).norm_squared();
    let best = path.iter().enumerate().min_by(|one, other| distance(one.1).total_cmp(&distance(other.1)));
    best.map_or(0, |(index, _)| index)
}
