//! Curves over one axis as a picture for people.

use super::sheet::{colour, element, escaped};
use std::fmt::Write;

/// Width and height of the picture, millimetres.
const SIZE_MM: (f64, f64) = (180.0, 90.0);
/// Left, right, top and bottom end of the plot, millimetres.
const PLOT_MM: [f64; 4] = [16.0, 174.0, 14.0, 78.0];
/// Most points that draw a curve; each shows the largest value of its stretch.
const MOST_POINTS: usize = 600;
/// The axis ends above this share of all values: the others are peaks, and are cut off.
const SHOWN: f64 = 0.98;
/// Marks on an axis.
const MARKS: usize = 5;
/// Colours of curves, in their order; more curves begin again.
const COLOURS: [&str; 6] = [colour::TRACK, colour::MISSED, "#C77700", "#2A9D4A", colour::TETHER, colour::OUT];

/// A curve.
#[derive(Debug, Clone, Copy)]
pub struct Curve<'a> {
    /// Its name in the legend.
    pub name: &'a str,
    /// Places along the axis and values, in order.
    pub points: &'a [(f64, f64)],
}

/// Curves over one axis.
#[derive(Debug, Clone, Copy)]
pub struct Curves<'a> {
    /// What they show.
    pub title: &'a str,
    /// What is along the axis, with its unit.
    pub along: &'a str,
    /// What the values are, with their unit.
    pub values: &'a str,
    /// The curves.
    pub curves: &'a [Curve<'a>],
}

/// The picture as an SVG document; values above most others are cut off at the top.
pub fn svg(curves: &Curves<'_>) -> String {
    let [left, right, top, bottom] = PLOT_MM;
    let end = largest(curves.curves.iter().filter_map(|curve| curve.points.last()).map(|point| point.0));
    let high = 1.05 * quantile(curves.curves.iter().flat_map(|curve| curve.points).map(|point| point.1));
    let high = if high > 0.0 { high } else { 1.0 };
    let x = |along: f64| left + (right - left) * along / end;
    let y = |value: f64| bottom - (bottom - top) * (value / high).clamp(0.0, 1.0);
    let mut body = format!(r##"<rect width="{}" height="{}" fill="#fff"/>"##, SIZE_MM.0, SIZE_MM.1);
    body += &axes(end, high);
    for (index, curve) in curves.curves.iter().enumerate() {
        let stroke = COLOURS[index % COLOURS.len()];
        let points: Vec<String> =
            peaks(curve.points).map(|(along, value)| format!("{:.2},{:.2}", x(along), y(value))).collect();
        // Writing to a String cannot fail.
        let _ = write!(
            body,
            r#"<polyline class="curve" points="{}" fill="none" stroke="{stroke}" stroke-width=".3" stroke-linejoin="round"/>"#,
            points.join(" ")
        );
        let place = left + 28.0 * (index % 6) as f64;
        let row = 86.0 + 3.6 * (index / 6) as f64;
        let _ = write!(
            body,
            r#"<rect x="{place}" y="{:.1}" width="5" height="2" fill="{stroke}"/><text x="{:.1}" y="{row:.1}" font-size="2" fill="{}">{}</text>"#,
            row - 2.0,
            place + 6.0,
            colour::SOFT,
            escaped(curve.name)
        );
    }
    let text = |x: f64, y: f64, size: f64, text: &str| {
        format!(r#"<text x="{x}" y="{y}" font-size="{size}" fill="{}">{}</text>"#, colour::INK, escaped(text))
    };
    body += &text(left, 6.0, 3.4, curves.title);
    body += &text(left, 11.0, 2.6, curves.values);
    body += &text(right - 30.0, 83.0, 2.6, curves.along);
    format!("{}\n", element(SIZE_MM.0, SIZE_MM.1, &body, curves.title, "curves"))
}

/// The axes with their marks, up to these ends.
fn axes(end: f64, high: f64) -> String {
    let [left, right, top, bottom] = PLOT_MM;
    let mut body = String::new();
    for mark in 0..=MARKS {
        let share = mark as f64 / MARKS as f64;
        let (x, y) = (left + (right - left) * share, bottom - (bottom - top) * share);
        // Writing to a String cannot fail.
        let _ = write!(
            body,
            r#"<path d="M{left},{y:.2}H{right}" stroke="{}" stroke-width=".15"/><text x="{:.1}" y="{:.2}" font-size="2.4" text-anchor="end" fill="{soft}">{}</text><text x="{x:.2}" y="{:.1}" font-size="2.4" text-anchor="middle" fill="{soft}">{}</text>"#,
            colour::HAIR,
            left - 1.0,
            y + 0.8,
            plain(high * share),
            bottom + 3.4,
            plain(end * share),
            soft = colour::SOFT,
        );
    }
    body
}

/// The largest value of every stretch of a long curve.
fn peaks(points: &[(f64, f64)]) -> impl Iterator<Item = (f64, f64)> + '_ {
    let stretch = points.len().div_ceil(MOST_POINTS).max(1);
    points.chunks(stretch).filter_map(|points| points.iter().copied().max_by(|a, b| a.1.total_cmp(&b.1)))
}

fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(f64::MIN_POSITIVE, f64::max)
}

fn quantile(values: impl Iterator<Item = f64>) -> f64 {
    let mut sorted: Vec<f64> = values.filter(|value| value.is_finite()).collect();
    sorted.sort_by(f64::total_cmp);
    let at = (sorted.len() as f64 * SHOWN) as usize;
    sorted.get(at.min(sorted.len().saturating_sub(1))).copied().unwrap_or(0.0)
}

/// A mark of an axis.
fn plain(value: f64) -> String {
    if value >= 100.0 { format!("{value:.0}") } else { format!("{value:.2}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_curve_is_there_and_peaks_are_cut_off() {
        let flat: Vec<(f64, f64)> = (0..2000).map(|k| (f64::from(k) * 0.1, 1.0)).collect();
        let mut peaked = flat.clone();
        peaked[1000].1 = 1e6;
        let curves = [Curve { name: "pull", points: &flat }, Curve { name: "push & more", points: &peaked }];
        let drawn = svg(&Curves { title: "forces", along: "way, m", values: "N", curves: &curves });
        assert_eq!(drawn.matches(r#"class="curve""#).count(), 2);
        assert!(drawn.contains("push &amp; more") && drawn.contains(">1.05<"), "{drawn}");
        assert!(!drawn.contains("NaN") && drawn.len() < 30_000);
    }

    #[test]
    fn nothing_is_drawn_as_an_empty_plot() {
        let drawn = svg(&Curves { title: "none", along: "m", values: "N", curves: &[] });
        assert!(drawn.contains("<svg") && !drawn.contains("NaN"));
    }
}
