//! Shapes that the map draws dot by dot.

use super::pattern::Pattern;
use super::pen::DOTS;
use ratatui::style::Color;
use ratatui::widgets::canvas::{Painter, Shape};
use world::{Point, Vector};

/// The visible part of the floor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Window {
    /// The west and east edges, metres.
    pub x: [f64; 2],
    /// The south and north edges, metres.
    pub y: [f64; 2],
    /// The width of a column, metres; a row is twice as high.
    pub column_m: f64,
    /// The number of columns and rows.
    pub size: (u16, u16),
}

impl Window {
    /// Creates a window around a point.
    pub(in crate::view) fn new(center: Point, column_m: f64, size: (u16, u16)) -> Self {
        let half_x = f64::from(size.0) * column_m / 2.0;
        let half_y = f64::from(size.1) * column_m;
        Self {
            x: [center.x - half_x, center.x + half_x],
            y: [center.y - half_y, center.y + half_y],
            column_m,
            size,
        }
    }

    /// The centre of a character cell; cells are counted from the north-west.
    pub(crate) fn middle_of(&self, column: u16, row: u16) -> Point {
        let x = self.x[0] + (f64::from(column) + 0.5) * self.column_m;
        Point::new(x, self.y[1] - (2.0 * f64::from(row) + 1.0) * self.column_m)
    }

    /// The centres of the dots, one per character or half-block, row by row from the north-west, and the width of a
    /// dot, metres.
    pub(super) fn dots(self, rows_per_row: u16) -> impl Iterator<Item = (Point, f64)> {
        let (columns, rows) = (self.size.0, self.size.1 * rows_per_row);
        let row_m = 2.0 * self.column_m / f64::from(rows_per_row);
        (0..rows).flat_map(move |row| {
            let y = self.y[1] - (f64::from(row) + 0.5) * row_m;
            (0..columns).map(move |column| {
                let x = self.x[0] + (f64::from(column) + 0.5) * self.column_m;
                (Point::new(x, y), f64::midpoint(self.column_m, row_m))
            })
        })
    }

    /// The character cell at a point, counted from the north-west; `None` outside the window.
    pub(super) fn cell_of(&self, at: Point) -> Option<(u16, u16)> {
        let column = ((at.x - self.x[0]) / self.column_m).floor();
        let row = ((self.y[1] - at.y) / (2.0 * self.column_m)).floor();
        let is_inside =
            (0.0..f64::from(self.size.0)).contains(&column) && (0.0..f64::from(self.size.1)).contains(&row);
        is_inside.then_some((column as u16, row as u16))
    }

    /// The part of a segment inside the window.
    fn clipped(&self, from: Point, to: Point) -> Option<(Point, Point)> {
        let way = to - from;
        let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
        let sides = [
            (-way.x, from.x - self.x[0]),
            (way.x, self.x[1] - from.x),
            (-way.y, from.y - self.y[0]),
            (way.y, self.y[1] - from.y),
        ];
        for (speed, room) in sides {
            if speed == 0.0 && room < 0.0 {
                return None;
            }
            match room / speed {
                at if speed < 0.0 => enter = enter.max(at),
                at if speed > 0.0 => leave = leave.min(at),
                _ => {}
            }
        }
        (enter <= leave).then(|| (from + way * enter, from + way * leave))
    }
}

/// A line through points.
pub(in crate::view) struct Stroke<'a> {
    pub points: &'a [Point],
    pub window: Window,
    pub pattern: Pattern,
    pub color: Color,
}

impl Shape for Stroke<'_> {
    fn draw(&self, painter: &mut Painter) {
        let mut walked = 0_usize;
        for pair in self.points.windows(2) {
            let Some((from, to)) = self.window.clipped(pair[0], pair[1]) else { continue };
            let (Some(a), Some(b)) = (painter.get_point(from.x, from.y), painter.get_point(to.x, to.y))
            else {
                continue;
            };
            let (dx, dy) = (b.0 as f64 - a.0 as f64, b.1 as f64 - a.1 as f64);
            let steps = dx.abs().max(dy.abs());
            let is_flat = dx.abs() >= dy.abs();
            for step in 0..=(steps as usize) {
                let share = if steps > 0.0 { step as f64 / steps } else { 0.0 };
                if self.pattern.is_on(walked + step) {
                    let x = (a.0 as f64 + dx * share).round() as usize;
                    let y = (a.1 as f64 + dy * share).round() as usize;
                    self.pattern.dots((x, y), (walked + step, is_flat), |x, y| {
                        // A dot beyond the edge would appear in the next row.
                        if x < usize::from(DOTS.0 * self.window.size.0) {
                            painter.paint(x, y, self.color);
                        }
                    });
                }
            }
            walked += steps as usize;
        }
    }
}

/// The inside of an outline, solid or hatched.
pub(in crate::view) struct Filled<'a> {
    pub shape: &'a world::Shape,
    pub window: Window,
    pub hatched: bool,
    pub color: Color,
}

impl Shape for Filled<'_> {
    fn draw(&self, painter: &mut Painter) {
        let Window { x, y, .. } = self.window;
        let (low, high) = self.shape.bounds();
        let (low, high) = (
            Point::new(low.x.clamp(x[0], x[1]), low.y.clamp(y[0], y[1])),
            Point::new(high.x.clamp(x[0], x[1]), high.y.clamp(y[0], y[1])),
        );
        let corners = (painter.get_point(low.x, high.y), painter.get_point(high.x, low.y));
        let (Some(first), Some(last)) = corners else { return };
        let span = Vector::new((last.0 - first.0).max(1) as f64, (last.1 - first.1).max(1) as f64);
        for row in first.1..=last.1 {
            for column in first.0..=last.0 {
                let share = Vector::new((column - first.0) as f64 / span.x, (row - first.1) as f64 / span.y);
                let at = Point::new(low.x + share.x * (high.x - low.x), high.y - share.y * (high.y - low.y));
                let thin = self.hatched && !(row + column).is_multiple_of(4);
                if !thin && self.shape.distance_m(at) <= 0.0 {
                    painter.paint(column, row, self.color);
                }
            }
        }
        self.draw_thin(painter);
    }
}

impl Filled<'_> {
    /// Draws what the dots may have missed: an outline that is thinner than a dot must still be visible along its length.
    fn draw_thin(&self, painter: &mut Painter) {
        let stroke = |painter: &mut Painter, points: &[Point]| {
            let (window, color) = (self.window, self.color);
            Stroke { points, window, pattern: Pattern::Solid, color }.draw(painter);
        };
        let dot_m = self.window.column_m / f64::from(DOTS.0);
        match self.shape {
            world::Shape::Polyline { points, .. } if !self.hatched => stroke(painter, points),
            world::Shape::Polygon { vertices } if !self.hatched && thickness_m(vertices) < dot_m => {
                let ring: Vec<Point> = vertices.iter().chain(vertices.first()).copied().collect();
                stroke(painter, &ring);
            }
            _ => {
                let middle = self.shape.center();
                if let Some((column, row)) = painter.get_point(middle.x, middle.y) {
                    painter.paint(column, row, self.color);
                }
            }
        }
    }
}

/// The thickness of a long polygon, metres: its area over half of its outline.
fn thickness_m(vertices: &[Point]) -> f64 {
    let ring = vertices.iter().chain(vertices.first()).copied().collect::<Vec<_>>();
    let half_m = world::polyline::length_m(&ring) / 2.0;
    if half_m > 0.0 { world::shape::ring_area_m2(vertices).abs() / half_m } else { 0.0 }
}

/// The points of a closed ellipse around a centre.
pub(in crate::view) fn ellipse(
    center: Point,
    half_m: (f64, f64),
    turned_rad: f64,
    pieces: u32,
) -> Vec<Point> {
    let (sin, cos) = turned_rad.sin_cos();
    (0..=pieces)
        .map(|piece| {
            let (up, right) = (std::f64::consts::TAU * f64::from(piece) / f64::from(pieces)).sin_cos();
            let (along, across) = (right * half_m.0, up * half_m.1);
            center + Vector::new(along * cos - across * sin, along * sin + across * cos)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_segment_is_cut_at_the_edges_of_the_window() {
        let window = Window::new(Point::origin(), 0.5, (20, 10));
        let cut = window.clipped(Point::new(-100.0, 1.0), Point::new(100.0, 1.0));
        assert_eq!(cut, Some((Point::new(-5.0, 1.0), Point::new(5.0, 1.0))));
        assert_eq!(window.clipped(Point::new(-100.0, 6.0), Point::new(100.0, 6.0)), None);
        let inside = (Point::new(1.0, 1.0), Point::new(2.0, -3.0));
        assert_eq!(window.clipped(inside.0, inside.1), Some(inside));
    }

    /// The dots of a filled shape in a window of 20 by 10 characters of half a metre.
    fn dots(shape: &world::Shape) -> Vec<(usize, usize)> {
        let window = Window::new(Point::origin(), 0.5, (20, 10));
        let area = ratatui::layout::Rect::new(0, 0, 20, 10);
        let mut buffer = ratatui::buffer::Buffer::empty(area);
        let canvas = ratatui::widgets::canvas::Canvas::default()
            .x_bounds(window.x)
            .y_bounds(window.y)
            .marker(ratatui::symbols::Marker::Braille)
            .paint(|ctx| ctx.draw(&Filled { shape, window, hatched: false, color: Color::Red }));
        ratatui::widgets::Widget::render(canvas, area, &mut buffer);
        let is_drawn = |(x, y): &(u16, u16)| !matches!(buffer[(*x, *y)].symbol(), " " | "\u{2800}");
        let cells = (0..10).flat_map(|y| (0..20).map(move |x| (x, y))).filter(is_drawn);
        cells.map(|(x, y)| (usize::from(x), usize::from(y))).collect()
    }

    #[test]
    fn a_wall_thinner_than_a_dot_is_drawn_along_its_whole_length() {
        let (north, south) = (Point::new(0.3, 4.9), Point::new(0.3, -4.9));
        let wall = world::Shape::Polyline { points: vec![north, south], half_width_m: 0.01 };
        let side = Vector::new(0.01, 0.0);
        let plank =
            world::Shape::Polygon { vertices: vec![north - side, south - side, south + side, north + side] };
        for shape in [wall, plank] {
            let rows: std::collections::BTreeSet<usize> =
                dots(&shape).into_iter().map(|(_, row)| row).collect();
            assert_eq!(rows.len(), 10, "{shape:?}");
        }
    }

    #[test]
    fn an_ellipse_is_closed_and_has_its_half_axes() {
        let ring = ellipse(Point::new(1.0, 2.0), (3.0, 1.0), std::f64::consts::FRAC_PI_2, 64);
        assert!((ring[0] - ring[64]).norm() < 1e-9);
        assert!((ring[0] - Point::new(1.0, 5.0)).norm() < 1e-9);
        assert!((ring[16] - Point::new(0.0, 2.0)).norm() < 1e-9);
    }
}
