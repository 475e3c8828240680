//! The map: scanned floor below, walls, obstacles, paths and forces above, in one canvas.

use super::shapes::{Filled, Forecast, Scanned, Stroke, Window, ellipse};
use super::{Look, text};
use crate::caps::{Colours, Glyphs};
use crate::model::{Model, Pane, position, ui::MapLayer};
use crate::theme::Role;
use planner_api::{Drawing, Layer};
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::symbols::Marker;
use ratatui::text::Line;
use ratatui::widgets::Clear;
use ratatui::widgets::canvas::{Canvas, Context};
use world::{Boundary, Point, Pose, ZoneKind};

/// Room about the tank, as a share of its size.
const MARGIN: f64 = 1.04;
/// Pieces of a round wall.
const WALL_PIECES: u32 = 256;
/// Columns that a pass of the tool must be wide for all passes to be drawn.
const PASS_COLUMNS: f64 = 2.0;
/// Length of trail and plan where not all of it is drawn, in columns.
const REACH_COLUMNS: f64 = 40.0;
/// Columns and rows of the legend.
const LEGEND: (u16, u16) = (12, 9);

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
    if let Some(window) = window(look.model, floor) {
        draw_floor(look, frame, floor, window);
        let room = usize::from(below.width).saturating_sub(text::width(&readout.1));
        let scale = Some(scale(window)).filter(|scale| text::width(scale) < room).unwrap_or_default();
        frame.render_widget(Line::from(look.span(Role::Dim, scale)), below);
    } else {
        frame.render_widget(Line::from(look.span(Role::Dim, " the tank is not known yet")), floor);
    }
    frame.render_widget(look.line([readout]).right_aligned(), below);
    if inner.width >= 70 && inner.height >= 20 {
        draw_legend(look, frame, floor);
    }
}

fn title(model: &Model) -> String {
    let zoom =
        if model.ui.map.zoom > 0 { format!("  ×{}", 1_u32 << model.ui.map.zoom) } else { String::new() };
    let follow = if model.ui.map.follow { "  follows the robot" } else { "" };
    format!("Map{zoom}{follow}")
}

fn keys(width: u16) -> &'static str {
    if width >= 70 { "f follow  z Z zoom  0 whole tank  L layers" } else { "f z Z 0 L" }
}

/// What of the floor is seen in an area.
fn window(model: &Model, area: Rect) -> Option<Window> {
    let (low, high) = model.run.as_ref()?.world.boundary.bounds();
    let (middle, span) = (nalgebra::center(&low, &high), high - low);
    let wide_m = span.x / f64::from(area.width);
    let high_m = span.y / (2.0 * f64::from(area.height));
    let column_m = wide_m.max(high_m) * MARGIN / f64::from(1_u32 << model.ui.map.zoom);
    let robot = model.position.pose.as_ref().map(|pose| pose.position);
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

/// Draws on the canvas what the model has.
struct Pen<'a> {
    look: Look<'a>,
    window: Window,
}

impl Pen<'_> {
    fn model(&self) -> &Model {
        self.look.model
    }

    /// Without braille each kind of line has a character of its own, on a layer of its own.
    fn take_up(&self, ctx: &mut Context<'_>, plain: char) {
        if self.look.caps.glyphs != Glyphs::Braille {
            ctx.marker(Marker::Custom(plain));
        }
    }

    fn stroke(&self, ctx: &mut Context<'_>, points: &[Point], role: Role, dotted: bool) {
        let color = self.look.theme.color(role);
        ctx.draw(&Stroke { points, window: self.window, dotted, color });
    }

    fn scanned(&self, ctx: &mut Context<'_>) {
        let Some(raster) =
            self.model().coverage.as_ref().filter(|_| self.model().ui.layers.shows(MapLayer::Scanned))
        else {
            return;
        };
        let (whole, partly) = (self.look.theme.color(Role::Scanned), self.look.theme.color(Role::Partly));
        let plain = self.look.caps.colours == Colours::None || self.look.caps.glyphs == Glyphs::Ascii;
        let dots = |rows_per_row, whole, partly| Scanned {
            raster,
            window: self.window,
            rows_per_row,
            whole,
            partly,
        };
        if plain {
            ctx.marker(Marker::Custom('▒'));
            ctx.draw(&dots(1, Some(whole), None));
            ctx.marker(Marker::Custom('░'));
            ctx.draw(&dots(1, None, Some(partly)));
        } else {
            ctx.marker(Marker::HalfBlock);
            ctx.draw(&dots(2, Some(whole), Some(partly)));
        }
        ctx.layer();
    }

    /// Where the stations are forecast to locate badly: beyond the limit, and beyond half of it.
    fn forecast(&self, ctx: &mut Context<'_>) {
        let model = self.model();
        let shown = model.ui.layers.shows(MapLayer::Accuracy);
        let (Some(map), Some(run)) = (model.accuracy.as_ref().filter(|_| shown), &model.run) else { return };
        let (beyond, near) = (self.look.theme.color(Role::Crit), self.look.theme.color(Role::Warn));
        let plain = self.look.caps.colours == Colours::None || self.look.caps.glyphs == Glyphs::Ascii;
        let limit_m = run.mission.position_limit_m;
        let dots = |rows_per_row, beyond, near| Forecast {
            map,
            limit_m,
            window: self.window,
            rows_per_row,
            beyond,
            near,
        };
        if plain {
            ctx.marker(Marker::Custom('%'));
            ctx.draw(&dots(1, Some(beyond), None));
            ctx.marker(Marker::Custom(':'));
            ctx.draw(&dots(1, None, Some(near)));
        } else {
            ctx.marker(Marker::HalfBlock);
            ctx.draw(&dots(2, Some(beyond), Some(near)));
        }
        ctx.layer();
    }

    fn zones(&self, ctx: &mut Context<'_>) {
        let Some(run) = &self.model().run else { return };
        self.take_up(ctx, 'x');
        for zone in run.world.zones.iter().filter(|zone| zone.kind == ZoneKind::NoGo) {
            let color = self.look.theme.color(Role::NoGo);
            ctx.draw(&Filled { shape: &zone.shape, window: self.window, hatched: true, color });
        }
    }

    fn paths(&self, ctx: &mut Context<'_>) {
        let model = self.model();
        let reach_m = self.reach_m();
        if let Some(plan) = model.planning.plan.as_ref().filter(|_| model.ui.layers.shows(MapLayer::Plan)) {
            self.take_up(ctx, ',');
            let from = model.progress.as_ref().map_or(0, |progress| nearest(&plan.path, progress.target));
            let ahead = reach_m.map_or(plan.path.as_slice(), |reach_m| within(&plan.path[from..], reach_m));
            self.stroke(ctx, ahead, Role::Plan, true);
        }
        if model.ui.layers.shows(MapLayer::Trail) {
            self.take_up(ctx, '.');
            let newest: Vec<Point> = model.trail.points().iter().rev().copied().collect();
            let behind = reach_m.map_or(newest.as_slice(), |reach_m| within(&newest, reach_m));
            self.stroke(ctx, behind, Role::Trail, false);
        }
    }

    /// How much of plan and trail is drawn, metres: where neighbouring passes would merge on the map, only what lies
    /// close before and behind the robot. The scanned cells show the rest.
    fn reach_m(&self) -> Option<f64> {
        let swath_m = self.model().run.as_ref()?.mission.swath_m;
        (swath_m < PASS_COLUMNS * self.window.column_m).then_some(REACH_COLUMNS * self.window.column_m)
    }

    fn drawings(&self, ctx: &mut Context<'_>) {
        let planning = &self.model().planning;
        let old = self.model().clock.tick.saturating_sub(planning.drawings_tick) > 10;
        if old || !self.model().ui.layers.shows(MapLayer::Drawings) {
            return;
        }
        self.take_up(ctx, '\'');
        for drawing in &planning.drawings {
            let (layer, points) = match *drawing {
                Drawing::Arrow { layer, at, vector } => (layer, vec![at, at + vector]),
                Drawing::Line { layer, from, to } => (layer, vec![from, to]),
                Drawing::Circle { layer, center, radius_m } => {
                    (layer, ellipse(center, (radius_m, radius_m), 0.0, 32))
                }
            };
            let role = match layer {
                Layer::Attraction => Role::Pull,
                Layer::Repulsion => Role::Push,
                _ => Role::Drawn,
            };
            self.stroke(ctx, &points, role, false);
        }
    }

    fn solid(&self, ctx: &mut Context<'_>) {
        let Some(run) = &self.model().run else { return };
        self.take_up(ctx, 'o');
        let wall = match &run.world.boundary {
            Boundary::Circle { radius_m } => {
                ellipse(Point::origin(), (*radius_m, *radius_m), 0.0, WALL_PIECES)
            }
            Boundary::Polygon { vertices } => vertices.iter().chain(vertices.first()).copied().collect(),
        };
        self.stroke(ctx, &wall, Role::Wall, false);
        self.take_up(ctx, '#');
        for obstacle in &run.world.obstacles {
            let color = self.look.theme.color(if obstacle.known { Role::Obstacle } else { Role::Found });
            ctx.draw(&Filled { shape: &obstacle.shape, window: self.window, hatched: false, color });
        }
    }

    /// The taut cable, above all else that does not move.
    fn tether(&self, ctx: &mut Context<'_>) {
        if let Some(tether) = &self.model().tether {
            self.take_up(ctx, '~');
            self.stroke(ctx, &tether.line, Role::Tether, false);
        }
    }

    /// The hull and the 95 % error, where they are large enough to be seen.
    fn robot(&self, ctx: &mut Context<'_>) {
        let Some(pose) = &self.model().position.pose else { return };
        self.take_up(ctx, '+');
        let radius_m = self.model().run.as_ref().map_or(0.0, |run| run.mission.limits.radius_m);
        if radius_m > self.window.column_m {
            self.stroke(ctx, &ellipse(pose.position, (radius_m, radius_m), 0.0, 48), Role::Robot, false);
        }
        let (long_m, short_m, turned_rad) = position::ellipse_95(pose);
        if long_m > self.window.column_m {
            self.stroke(ctx, &ellipse(pose.position, (long_m, short_m), turned_rad, 64), Role::Warn, false);
        }
    }

    fn labels(&self, ctx: &mut Context<'_>) {
        let model = self.model();
        let mut print = |at: Point, role: Role, text: String| {
            ctx.print(at.x, at.y, Line::styled(text, self.look.theme.style(role)));
        };
        let Some(run) = &model.run else { return };
        for obstacle in &run.world.obstacles {
            let (role, mark) = if obstacle.known { (Role::Obstacle, "#") } else { (Role::Found, "?") };
            print(obstacle.shape.center(), role, mark.into());
        }
        for station in run.world.stations.iter().filter(|_| model.ui.layers.shows(MapLayer::Stations)) {
            let named = model.ui.map.zoom > 0 && station.name.len() <= 4;
            print(station.position, Role::Station, if named { station.name.clone() } else { "S".into() });
        }
        if let Some(progress) = model.progress.as_ref().filter(|_| !model.has_ended()) {
            print(progress.target, Role::Target, "×".into());
        }
        if let Some(pose) = &model.position.pose {
            let role = if model.position.lost { Role::Crit } else { Role::Robot };
            print(pose.position, role, arrow(self.look.caps.glyphs, pose.heading_rad).into());
        } else {
            print(
                run.mission.start.position,
                Role::Robot,
                arrow_of(&run.mission.start, self.look.caps.glyphs).into(),
            );
        }
    }
}

/// The first points of a path up to some length.
fn within(path: &[Point], length_m: f64) -> &[Point] {
    let mut walked_m = 0.0;
    let steps = path.windows(2).take_while(|pair| {
        walked_m += (pair[1] - pair[0]).norm();
        walked_m <= length_m
    });
    let last = steps.count();
    path.get(..=last).unwrap_or(path)
}

/// Index of the point of a path that is nearest to a place; 0 for an empty path.
fn nearest(path: &[Point], place: Point) -> usize {
    let distance = |point: &Point| (point - place).norm_squared();
    let best = path.iter().enumerate().min_by(|one, other| distance(one.1).total_cmp(&distance(other.1)));
    best.map_or(0, |(index, _)| index)
}

fn arrow_of(pose: &Pose, glyphs: Glyphs) -> &'static str {
    arrow(glyphs, pose.heading_rad)
}

/// The robot, looking where it looks.
fn arrow(glyphs: Glyphs, heading_rad: f64) -> &'static str {
    const ARROWS: [&str; 8] = ["→", "↗", "↑", "↖", "←", "↙", "↓", "↘"];
    if glyphs == Glyphs::Ascii || !heading_rad.is_finite() {
        return "@";
    }
    let eighth = (heading_rad / std::f64::consts::FRAC_PI_4).round().rem_euclid(8.0);
    ARROWS[(eighth as usize) % 8]
}

/// The robot's place and the error of it, in words.
fn readout(look: &Look, width: u16) -> (Role, String) {
    let position = &look.model.position;
    let name = if width >= 60 { "robot " } else { "" };
    let Some(pose) = &position.pose else { return (Role::Dim, "robot: no position yet ".into()) };
    let at = format!("{}, {} m", text::number(pose.position.x, 2), text::number(pose.position.y, 2));
    let error = text::number(position.error_m().unwrap_or(f64::NAN), 2);
    let stale = if position.is_fix_stale(look.model.clock.t_s) { "◌ " } else { "" };
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

fn draw_legend(look: &Look, frame: &mut Frame, area: Rect) {
    let layers = look.model.ui.layers;
    let plain = look.caps.colours == Colours::None || look.caps.glyphs == Glyphs::Ascii;
    let braille = look.caps.glyphs == Glyphs::Braille;
    let swatch = |filled: &'static str| if plain { filled } else { "██" };
    let line = |dots: &'static str, letters: &'static str| if braille { dots } else { letters };
    let found = look.model.run.iter().flat_map(|run| &run.world.obstacles).any(|obstacle| !obstacle.known);
    let entries = [
        (layers.shows(MapLayer::Scanned), Role::Scanned, swatch("▒▒"), "scanned"),
        (layers.shows(MapLayer::Scanned), Role::Partly, swatch("░░"), "partial"),
        (layers.shows(MapLayer::Accuracy), Role::Crit, if plain { "%%" } else { "██" }, "bad fixes"),
        (layers.shows(MapLayer::Trail), Role::Trail, line("⠤⠤", ".."), "trail"),
        (layers.shows(MapLayer::Plan), Role::Plan, line("⠄⠠", ",,"), "plan"),
        (look.model.tether.is_some(), Role::Tether, line("⠤⠤", "~~"), "tether"),
        (true, Role::Obstacle, "# ", "obstacle"),
        (found, Role::Found, "? ", "found"),
        (layers.shows(MapLayer::Stations), Role::Station, "S ", "station"),
        (true, Role::Target, "× ", "target"),
    ];
    let lines: Vec<Line> = entries
        .into_iter()
        .filter(|(shown, ..)| *shown)
        .map(|(_, role, mark, word)| {
            Line::from(vec![look.span(role, mark), look.span(Role::Dim, format!(" {word}"))])
        })
        .collect();
    let area = Rect { x: area.x, width: LEGEND.0 + 1, height: LEGEND.1.min(lines.len() as u16), ..area };
    frame.render_widget(Clear, area);
    let area = Rect { x: area.x + 1, width: LEGEND.0, ..area };
    for (line, row) in lines.into_iter().zip(area.rows()) {
        frame.render_widget(line, row);
    }
}
