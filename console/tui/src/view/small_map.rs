//! A small map of a tank that does not follow the robot: walls, obstacles, stations, scanned floor, a trail, and marked
//! places.

use super::look::Look;
use super::map::{self, Pen, TRAIL, Window};
use crate::model::{Run, Together};
use crate::theme::Role;
use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::text::Line;
use ratatui::widgets::canvas::{Canvas, Context};
use world::{Point, World};

/// Margin around the tank, as a factor of its size.
const MARGIN: f64 = 1.06;
/// Smallest area in which a tank is recognisable, columns and rows.
const LEAST: (u16, u16) = (16, 6);
/// Columns beside the tank for a legend that is wider than it.
const LEGEND_MARGIN: u16 = 24;
/// Rows of the map for each line of its legend.
const ROWS_PER_LINE: u16 = 4;

/// The contents of a small map.
pub(super) struct SmallMap<'a> {
    pub world: &'a World,
    /// The run whose floor is shown, and the scan of all runs if it is a re-scan.
    pub floor: Option<(&'a Run, Option<&'a Together>)>,
    pub trail: &'a [Point],
    /// Places with the text that marks them.
    pub marks: Vec<(Point, Role, String)>,
}

impl<'a> SmallMap<'a> {
    /// The tank alone.
    pub(super) fn of(world: &'a World) -> Self {
        Self { world, floor: None, trail: &[], marks: Vec::new() }
    }

    /// The tank of a run with its floor and trail; `None` until the run is opened.
    pub(super) fn of_run(run: &'a Run, together: Option<&'a Together>) -> Option<Self> {
        let world = &run.about.as_ref()?.world;
        Some(Self { world, floor: Some((run, together)), trail: run.trail.points(), marks: Vec::new() })
    }

    /// Width of the floor that a pass of the tool scans, metres; 0 without a run.
    fn swath_m(&self) -> f64 {
        let about = self.floor.and_then(|(run, _)| run.about.as_ref());
        about.map_or(0.0, |about| about.mission.swath_m)
    }

    /// The number of missed areas that are numbered on the map.
    fn n_missed(&self) -> usize {
        let is_number = |text: &str| text.chars().all(|letter| letter.is_ascii_digit());
        self.marks.iter().filter(|(.., text)| is_number(text)).count()
    }

    /// The columns that the tank fills in a number of rows, with a margin for its legend.
    pub(super) fn columns(&self, rows: u16) -> u16 {
        let (low, high) = self.world.boundary.bounds();
        // A cell is twice as high as it is wide.
        let columns = 2.0 * f64::from(rows) * (high.x - low.x) / (high.y - low.y);
        if columns.is_finite() {
            (columns.ceil() as u16).saturating_add(LEGEND_MARGIN).max(LEAST.0)
        } else {
            LEAST.0
        }
    }

    /// The same map with a marked place.
    #[must_use]
    pub(super) fn marked(mut self, at: Point, role: Role, text: &str) -> Self {
        self.marks.push((at, role, text.to_owned()));
        self
    }
}

/// Draws a small map with its legend below it; draws nothing if the area is too small for a map.
pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect, map: &SmallMap) {
    if window(map.world, area).is_none() {
        return;
    }
    let columns = usize::from(area.width).saturating_sub(1);
    let settled = map::with_legend(area, |floor, _| {
        let window = window(map.world, floor)?;
        let shades = map.floor.and_then(|floor| map::shades_of_run(look, floor, window));
        let marks = (!map.trail.is_empty(), map.n_missed());
        let legend = map::floor_legend(look, shades.clone(), marks, columns);
        let rows = (legend.len() as u16).min(area.height / ROWS_PER_LINE);
        Some(((window, shades, legend), rows))
    });
    let Some(((window, shades, legend), rows)) = settled else { return };
    let [area, below] = Layout::vertical([Constraint::Fill(1), Constraint::Length(rows)]).areas(area);
    let pen = Pen { look: *look, window };
    let canvas = Canvas::default().marker(pen.marker()).x_bounds(window.x).y_bounds(window.y).paint(|ctx| {
        pen.no_go(ctx, map.world);
        pen.trail(ctx, map.trail, TRAIL, map.swath_m());
        pen.solids(ctx, map.world);
        ctx.layer();
        signs(look, ctx, map);
    });
    frame.render_widget(canvas, area);
    if let Some(shades) = shades {
        map::lay(look, &shades, area, frame.buffer_mut());
    }
    for (line, place) in legend.into_iter().zip(below.rows()) {
        let indented = std::iter::once((Role::Text, " ".to_owned())).chain(line);
        frame.render_widget(look.line(indented), place);
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
