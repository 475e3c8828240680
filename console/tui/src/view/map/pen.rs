//! Draws the model on the map's canvas.

use super::drawn;
use super::plates::{self, Outlines};
use super::shapes::{Filled, Stroke, Window, ellipse};
use crate::caps::Glyphs;
use crate::model::{Overlay, Screen, WhatIf, position, ui::MapLayer};
use crate::theme::Role;
use crate::view::look::Look;
use planner_api::Drawing;
use ratatui::symbols::Marker;
use ratatui::text::Line;
use ratatui::widgets::canvas::Context;
use world::{Boundary, Point, ZoneKind};

/// The maximum number of missed areas that are numbered on the map: first when the whole tank is shown, then when only
/// a part of it is.
const MISSED: (usize, usize) = (9, 99);
/// The number of segments in a round wall.
const WALL_PIECES: u32 = 256;
/// All passes are drawn if a pass of the tool is at least this many columns wide.
const PASS_COLUMNS: f64 = 2.0;
/// How much of the trail and of the plan is drawn if they are not drawn completely, columns.
const REACH_COLUMNS: f64 = 40.0;
/// Dots per character.
pub(super) const DOTS: (u16, u16) = (2, 4);

/// Draws the model on the canvas.
pub(super) struct Pen<'a> {
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

    pub(super) fn stroke(&self, ctx: &mut Context<'_>, points: &[Point], role: Role, dotted: bool) {
        let color = self.look.theme.color(role);
        ctx.draw(&Stroke { points, window: self.window, dotted, color });
    }

    /// The markers of the map: dots if the terminal has them.
    pub(super) fn marker(&self) -> Marker {
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

    pub(super) fn zones(&self, ctx: &mut Context<'_>) {
        let Some(about) = &self.look.run.about else { return };
        self.take_up(ctx, 'x');
        for zone in about.world.zones.iter().filter(|zone| zone.kind == ZoneKind::NoGo) {
            let color = self.look.theme.color(Role::NoGo);
            ctx.draw(&Filled { shape: &zone.shape, window: self.window, hatched: true, color });
        }
    }

    pub(super) fn paths(&self, ctx: &mut Context<'_>) {
        let (run, ui) = (self.look.run, &self.look.model.ui);
        let reach_m = self.reach_m().filter(|_| ui.screen != Screen::Plan);
        self.ghost(ctx);
        if let Some(plan) = run.planning.plan.as_ref().filter(|_| ui.layers.shows(MapLayer::Plan)) {
            self.take_up(ctx, ',');
            let from = run.progress.as_ref().map_or(0, |progress| nearest(&plan.path, progress.target));
            let ahead = reach_m.map_or(plan.path.as_slice(), |reach_m| within(&plan.path[from..], reach_m));
            self.stroke(ctx, ahead, Role::Plan, true);
        }
        if ui.layers.shows(MapLayer::Trail) {
            self.take_up(ctx, '.');
            let newest: Vec<Point> = run.trail.points().iter().rev().copied().collect();
            let behind = reach_m.map_or(newest.as_slice(), |reach_m| within(&newest, reach_m));
            self.stroke(ctx, behind, Role::Trail, false);
        }
    }

    /// The plan or forecast of a different planner, for comparison.
    fn ghost(&self, ctx: &mut Context<'_>) {
        self.other(ctx);
        let (live, ui) = (&self.look.model.live, &self.look.model.ui);
        let made = match (&ui.overlay, ui.screen) {
            (Overlay::WhatIf, _) => {
                let candidate = live.what_if.as_ref().and_then(WhatIf::candidate);
                candidate.and_then(|candidate| Some(&candidate.made.as_ref()?.as_ref().ok()?.path))
            }
            (_, Screen::Plan) => {
                let ghost = live.plans.ghost.as_ref();
                ghost.and_then(|ghost| Some(&ghost.made.as_ref()?.as_ref().ok()?.path))
            }
            _ => None,
        };
        if let Some(path) = made {
            self.take_up(ctx, ';');
            self.stroke(ctx, path, Role::Ghost, true);
        }
    }

    /// The run with which the replay is compared.
    fn other(&self, ctx: &mut Context<'_>) {
        let other = self.look.model.live.replay.as_ref().and_then(|replay| replay.other.as_ref());
        let Some(other) = other.filter(|_| self.look.model.ui.screen == Screen::Mission) else { return };
        self.take_up(ctx, ';');
        let newest: Vec<Point> = other.run.trail.points().iter().rev().copied().collect();
        let behind = self.reach_m().map_or(newest.as_slice(), |reach_m| within(&newest, reach_m));
        self.stroke(ctx, behind, Role::Ghost, false);
    }

    /// How much of the plan and of the trail is drawn, metres; `None` if they are drawn completely. Where neighbouring
    /// passes would merge on the map, only the stretch close to the robot is drawn; the scanned cells show the rest.
    fn reach_m(&self) -> Option<f64> {
        let swath_m = self.look.run.about.as_ref()?.mission.swath_m;
        (swath_m < PASS_COLUMNS * self.window.column_m).then_some(REACH_COLUMNS * self.window.column_m)
    }

    pub(super) fn drawings(&self, ctx: &mut Context<'_>) {
        self.take_up(ctx, '\'');
        for drawing in drawn::shown(&self.look) {
            let points = match *drawing {
                Drawing::Arrow { at, vector, .. } => vec![at, at + vector],
                Drawing::Line { from, to, .. } => vec![from, to],
                Drawing::Circle { center, radius_m, .. } => ellipse(center, (radius_m, radius_m), 0.0, 32),
            };
            self.stroke(ctx, &points, drawn::role(drawing), false);
        }
    }

    pub(super) fn solid(&self, ctx: &mut Context<'_>) {
        let Some(about) = &self.look.run.about else { return };
        self.take_up(ctx, 'o');
        let wall = match &about.world.boundary {
            Boundary::Circle { radius_m } => {
                ellipse(Point::origin(), (*radius_m, *radius_m), 0.0, WALL_PIECES)
            }
            Boundary::Polygon { vertices } => vertices.iter().chain(vertices.first()).copied().collect(),
        };
        self.stroke(ctx, &wall, Role::Wall, false);
        self.take_up(ctx, '#');
        for obstacle in &about.world.obstacles {
            let color = self.look.theme.color(if obstacle.known { Role::Obstacle } else { Role::Found });
            ctx.draw(&Filled { shape: &obstacle.shape, window: self.window, hatched: false, color });
        }
    }

    /// The taut cable, on top of everything else that does not move.
    pub(super) fn tether(&self, ctx: &mut Context<'_>) {
        if let Some(tether) = &self.look.run.tether {
            self.take_up(ctx, '~');
            self.stroke(ctx, &tether.line, Role::Tether, false);
        }
    }

    /// The hull and the 95 % error, if they are large enough to be visible.
    pub(super) fn robot(&self, ctx: &mut Context<'_>) {
        let Some(pose) = &self.look.run.position.pose else { return };
        self.take_up(ctx, '+');
        let radius_m = self.look.run.about.as_ref().map_or(0.0, |run| run.mission.limits.radius_m);
        if radius_m > self.window.column_m {
            self.stroke(ctx, &ellipse(pose.position, (radius_m, radius_m), 0.0, 48), Role::Robot, false);
        }
        let (long_m, short_m, turned_rad) = position::ellipse_95(pose);
        if long_m > self.window.column_m {
            self.stroke(ctx, &ellipse(pose.position, (long_m, short_m), turned_rad, 64), Role::Warn, false);
        }
    }

    pub(super) fn labels(&self, ctx: &mut Context<'_>) {
        let (run, ui) = (self.look.run, &self.look.model.ui);
        let mut print = |at: Point, role: Role, text: String| {
            ctx.print(at.x, at.y, Line::styled(text, self.look.theme.style(role)));
        };
        let Some(about) = &run.about else { return };
        for obstacle in &about.world.obstacles {
            let (role, mark) = if obstacle.known { (Role::Obstacle, "#") } else { (Role::Found, "?") };
            print(obstacle.shape.center(), role, mark.into());
        }
        for station in about.world.stations.iter().filter(|_| ui.layers.shows(MapLayer::Stations)) {
            let named = ui.map.zoom > 0 && station.name.len() <= 4;
            print(station.position, Role::Station, if named { station.name.clone() } else { "S".into() });
        }
        if ui.screen == Screen::Result {
            let most = if ui.map.zoom > 0 { MISSED.1 } else { MISSED.0 };
            for (index, area) in self.look.model.live.missed().iter().enumerate().take(most) {
                let role = if index == ui.missed { Role::Selected } else { Role::Missed };
                print(area.at, role, (index + 1).to_string());
            }
        }
        if let Some(progress) = run.progress.as_ref().filter(|_| !run.has_ended()) {
            print(progress.target, Role::Target, "×".into());
        }
        let start = &about.mission.start;
        let estimated = run.position.pose.as_ref().map(|pose| (pose.position, pose.heading_rad));
        let (at, heading_rad) = estimated.unwrap_or((start.position, start.heading_rad));
        let role = if run.position.lost { Role::Crit } else { Role::Robot };
        print(at, role, arrow(self.look.caps.glyphs, heading_rad).into());
        let other = self.look.model.live.replay.as_ref().and_then(|replay| replay.other.as_ref());
        if let Some(pose) = other.and_then(|other| other.run.position.pose.as_ref()) {
            print(pose.position, Role::Ghost, "B".into());
        }
        if let Some(cursor) = ui.cursor {
            print(cursor, Role::Selected, "┼".into());
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
pub(super) fn nearest(path: &[Point], place: Point) -> usize {
    let distance = |point: &Point| (point - place).norm_squared();
    let best = path.iter().enumerate().min_by(|one, other| distance(one.1).total_cmp(&distance(other.1)));
    best.map_or(0, |(index, _)| index)
}

/// The robot's arrow, pointing along its heading.
fn arrow(glyphs: Glyphs, heading_rad: f64) -> &'static str {
    const ARROWS: [&str; 8] = ["→", "↗", "↑", "↖", "←", "↙", "↓", "↘"];
    if glyphs == Glyphs::Ascii || !heading_rad.is_finite() {
        return "@";
    }
    let eighth = (heading_rad / std::f64::consts::FRAC_PI_4).round().rem_euclid(8.0);
    ARROWS[(eighth as usize) % 8]
}
