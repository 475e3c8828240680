//! Charts of recent minutes, with the limit drawn as a line.

use super::look::Look;
use super::map::{Pattern, Stroke, Window};
use super::text;
use crate::model::history::SLOT_S;
use crate::model::{History, Pane, Tether, ui::Chart};
use crate::theme::Role;
use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::symbols::Marker;
use ratatui::text::Line;
use ratatui::widgets::Block;
use ratatui::widgets::canvas::Canvas;
use world::Point;

/// Width of the labels beside a curve, columns.
const LABELS: u16 = 6;
/// The smallest plot that has a time axis, columns and rows.
const AXIS: (u16, u16) = (26, 4);
/// The dots of a curve in the height of a character.
const DOTS: u16 = 4;
/// The width of a mission time, and of an axis with three of them, columns.
const CLOCK: u16 = 10;
const MIDDLE: u16 = 3 * CLOCK + 4;
/// Space above the limit or the largest value, as a factor.
const HEADROOM: f64 = 1.15;

/// The contents of a chart.
pub(super) struct Series<'a> {
    pub title: &'static str,
    pub values: &'a History,
    /// The value now or at the end of the run; `None` for the last one of the history, which is the largest of a few seconds.
    pub now: Option<f64>,
    pub limit: Option<f64>,
    pub decimals: usize,
}

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect, chart: Chart) {
    let Some(series) = series(look, chart) else { return };
    let block = look.pane(Pane::Chart(chart), series.title, &note(look, &series, area));
    framed(look, frame, area, block, &series);
}

/// The value now or at the end of the run, the limit and the time that a chart covers, as far as they fit above the chart.
fn note(look: &Look, series: &Series, area: Rect) -> String {
    let room = usize::from(area.width).saturating_sub(text::width(series.title) + 8);
    let said = |value: f64| text::number(value, series.decimals);
    let when = if look.run.has_ended() { "end" } else { "now" };
    let last = series.now.or_else(|| series.values.last(SLOT_S).last());
    let now = last.map_or_else(String::new, |last| format!("{when} {}, ", said(last)));
    let limit = series.limit.map_or_else(String::new, |limit| format!("limit {}, ", said(limit)));
    let minutes = text::minutes(series.values, look.model.ui.span_s);
    text::wording([format!("{now}{limit}{minutes}"), format!("{limit}{minutes}"), minutes], room)
}

/// Draws a chart of a figure that no pane of the mission screen shows.
pub(super) fn figure(look: &Look, frame: &mut Frame, area: Rect, series: &Series) {
    let block = look.block(Role::Border, series.title, &note(look, series, area));
    framed(look, frame, area, block, series);
}

fn framed(look: &Look, frame: &mut Frame, area: Rect, block: Block<'_>, series: &Series) {
    let inner = block.inner(area);
    frame.render_widget(block, area);
    if inner.width > LABELS && inner.height >= 2 {
        plot(look, frame, inner, series);
    }
}

fn series<'a>(look: &Look<'a>, chart: Chart) -> Option<Series<'a>> {
    let (run, about) = (look.run, look.run.about.as_ref()?);
    let limits = about.mission.tether.as_ref().map(|tether| tether.limits);
    Some(match chart {
        Chart::Error => Series {
            title: "95 % error, m",
            values: &run.position.history_m,
            now: run.position.error_m(),
            limit: Some(about.mission.position_limit_m),
            decimals: 2,
        },
        Chart::Residual => Series {
            title: "Residual RMS, mm",
            values: &run.position.residual_history_mm,
            now: None,
            limit: None,
            decimals: 0,
        },
        Chart::TetherOut => Series {
            title: "Tether out, m",
            values: &run.tether.as_ref()?.length_history_m,
            now: run.tether.as_ref().map(|tether| tether.length_m),
            limit: limits.map(|limits| limits.reel_length_m),
            decimals: 1,
        },
        Chart::Wrap => Series {
            title: "Largest wrap, °",
            values: &run.tether.as_ref()?.wrap_history_deg,
            now: run.tether.as_ref().map(Tether::largest_deg),
            limit: limits.map(|limits| limits.wrap_max_rad.to_degrees()),
            decimals: 0,
        },
        Chart::Scanned => Series {
            title: "Scanned, % of reachable",
            values: &run.scanned_history,
            now: None,
            limit: None,
            decimals: 1,
        },
    })
}

fn plot(look: &Look, frame: &mut Frame, area: Rect, series: &Series<'_>) {
    let x = series.values.span_s(look.model.ui.span_s);
    let slots: Vec<_> =
        series.values.since(x[0]).map(|(t_s, value)| value.map(|value| Point::new(t_s, value))).collect();
    let stretches = slots.split(Option::is_none).map(|points| points.iter().flatten().copied().collect());
    let stretches = stretches.filter(|points: &Vec<Point>| !points.is_empty()).collect();
    let has_axis = area.width >= AXIS.0 + LABELS && area.height >= AXIS.1;
    let [area, below] =
        Layout::vertical([Constraint::Fill(1), Constraint::Length(has_axis.into())]).areas(area);
    curve(look, frame, area, &Curve { stretches, x, limit: series.limit, decimals: series.decimals });
    if has_axis {
        axis(look, frame, Rect { x: below.x + LABELS, width: below.width - LABELS, ..below }, x);
    }
}

/// Writes the mission time at the left edge, in the middle if there is room, and at the right edge.
fn axis(look: &Look, frame: &mut Frame, area: Rect, [from_s, to_s]: [f64; 2]) {
    let at = |t_s: f64| look.span(Role::Dim, format!("T+{}", text::clock(t_s)));
    if area.width >= MIDDLE {
        frame.render_widget(Line::from(at(f64::midpoint(from_s, to_s))).centered(), area);
    }
    let [left, right] = Layout::horizontal([Constraint::Fill(1); 2]).areas(area);
    frame.render_widget(Line::from(at(from_s)), Rect { width: left.width.min(CLOCK), ..left });
    frame.render_widget(Line::from(at(to_s)).right_aligned(), right);
}

/// A curve with its limit.
pub(super) struct Curve {
    /// The points of each stretch without a gap: the abscissa, and the value.
    pub stretches: Vec<Vec<Point>>,
    /// The abscissas at the left and at the right edge.
    pub x: [f64; 2],
    pub limit: Option<f64>,
    pub decimals: usize,
}

/// Draws a curve with the largest value and the limit beside it.
pub(super) fn curve(look: &Look, frame: &mut Frame, area: Rect, curve: &Curve) {
    let values = curve.stretches.iter().flatten().map(|at| at.y);
    let largest = values.filter(|value| value.is_finite()).fold(0.0, f64::max);
    let limit = curve.limit.filter(|limit| limit.is_finite() && *limit > 0.0);
    let top = HEADROOM * largest.max(limit.unwrap_or(0.0));
    let top = if top > 0.0 && top.is_finite() { top } else { 1.0 };
    let plot = Rect { x: area.x + LABELS, width: area.width - LABELS, ..area };
    let window = Window { x: curve.x, y: [0.0, top], column_m: 1.0, size: (plot.width, plot.height) };
    let marker = if look.caps.glyphs.has_dots() { Marker::Braille } else { Marker::Custom('*') };
    let canvas = Canvas::default().marker(marker).x_bounds(window.x).y_bounds(window.y).paint(|ctx| {
        let mut stroke = |points: &[Point], role, pattern| {
            ctx.draw(&Stroke { points, window, pattern, color: look.theme.color(role) });
        };
        if let Some(limit) = limit {
            stroke(
                &[Point::new(window.x[0], limit), Point::new(window.x[1], limit)],
                Role::Warn,
                Pattern::Dotted,
            );
        }
        for points in &curve.stretches {
            stroke(points, Role::Watch, Pattern::Solid);
            if let [point] = points[..] {
                stroke(&[point; 2], Role::Watch, Pattern::Solid);
            }
        }
    });
    frame.render_widget(canvas, plot);
    let mut label = |value: f64| label(look, frame, area, (value, curve.decimals), top);
    label(0.0);
    if limit.is_some() {
        label(largest);
    }
    label(limit.unwrap_or(largest));
}

/// Writes a value with its decimals beside the curve, at its height.
fn label(look: &Look, frame: &mut Frame, area: Rect, (value, decimals): (f64, usize), top: f64) {
    let share = (value / top).clamp(0.0, 1.0);
    // The row of the curve's dot, which need not be the nearest row.
    let dots = if look.caps.glyphs.has_dots() { DOTS } else { 1 };
    let down = ((1.0 - share) * f64::from(dots * area.height - 1)).round() as u16 / dots;
    let place = Rect { y: area.y + down, height: 1, width: LABELS - 1, ..area };
    let value = text::number(value, decimals);
    frame.render_widget(Line::from(look.span(Role::Dim, value)).right_aligned(), place);
}
