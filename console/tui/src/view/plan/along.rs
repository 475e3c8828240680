//! The expected position error along the path of a plan, below the promised figures if there is room.

use crate::theme::Role;
use crate::view::charts::{self, Curve};
use crate::view::look::Look;
use crate::view::text;
use positioning::AccuracyMap;
use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use world::{Point, polyline};

/// The smallest curve that can be read, with the line above it, columns and rows.
const LEAST: (u16, u16) = (30, 5);
/// Points of the curve in each column.
const PER_COLUMN: f64 = 2.0;

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect) {
    let (run, fits) = (look.run, area.width >= LEAST.0 && area.height >= LEAST.1);
    let Some(plan) = run.planning.plan.as_ref().filter(|plan| fits && plan.path.len() > 1) else { return };
    let Some((map, about)) = run.accuracy.as_ref().zip(run.about.as_ref()) else { return };
    // The points that are drawn cut corners; the axis has the length that every screen states.
    let (drawn_m, length_m) = (polyline::length_m(&plan.path), plan.length_m);
    let mut points = errors(map, &plan.path, drawn_m / (PER_COLUMN * f64::from(area.width)));
    for point in &mut points {
        point.x *= length_m / drawn_m;
    }
    if points.len() < 2 {
        return;
    }
    let [title, below] = Layout::vertical([Constraint::Length(1), Constraint::Fill(1)]).areas(area);
    let words = format!(" AE error along the path, m, start to end ({} m)", text::number(length_m, 1));
    frame.render_widget(look.line([(Role::Dim, words)]), title);
    let limit = Some(about.mission.position_limit_m);
    charts::curve(
        look,
        frame,
        below,
        &Curve { stretches: vec![points], x: [0.0, length_m], limit, decimals: 2 },
    );
}

/// The distance along a path and the error expected there, metres, at points `every_m` apart that get a fix.
fn errors(map: &AccuracyMap, path: &[Point], every_m: f64) -> Vec<Point> {
    let fine = polyline::resampled(path, every_m);
    let along_m = polyline::stations_m(&fine);
    let error_m = |at: &Point| map.at(*at).and_then(|forecast| forecast.error_95_m);
    let errors = fine.iter().zip(along_m).map(|(at, along_m)| Some(Point::new(along_m, error_m(at)?)));
    errors.flatten().collect()
}
