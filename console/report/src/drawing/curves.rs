//! A chart of curves over one axis.

use super::sheet::{colour, element};
use std::fmt::Write;

/// Width and height of the picture, millimetres.
const SIZE_MM: (f64, f64) = (180.0, 90.0);
/// Left, right, top and bottom ends of the plot, millimetres.
const PLOT_MM: [f64; 4] = [16.0, 174.0, 14.0, 78.0];
/// Number of columns in the legend, and their width, millimetres.
const LEGEND: (usize, f64) = (6, 26.5);
/// Maximum number of points in a drawn curve; each shows the largest value of its stretch.
const MOST_POINTS: usize = 600;
/// Share of the values that are not peaks. Peaks are cut off if the largest peak is more than `PEAK` times the largest
/// value that is not a peak.
const SHOWN: f64 = 0.98;
const PEAK: f64 = 2.0;
/// The minimum number of ticks on an axis.
const MARKS: f64 = 4.0;
/// Colours of the curves in order; further curves reuse them with dashes.
const COLOURS: [&str; 6] = [colour::TRACK, colour::MISSED, "#C77700", "#2A9D4A", colour::TETHER, colour::OUT];

/// A curve.
#[derive(Debug, Clone, Copy)]
pub struct Curve<'a> {
    /// Name of the curve in the legend.
    pub name: &'a str,
    /// Positions along the axis and values, in order.
    pub points: &'a [(f64, f64)],
}

/// Curves over one axis.
#[derive(Debug, Clone, Copy)]
pub struct Curves<'a> {
    /// The title.
    pub title: &'a str,
    /// The label of the horizontal axis, with its unit.
    pub along: &'a str,
    /// The label of the vertical axis, with its unit.
    pub values: &'a str,
    /// The curves.
    pub curves: &'a [Curve<'a>],
}

/// The chart as an SVG document; peaks far above the other values are cut off at the top.
pub fn svg(curves: &Curves<'_>) -> String {
    let [left, right, top, bottom] = PLOT_MM;
    let end = largest(curves.curves.iter().filter_map(|curve| curve.points.last()).map(|point| point.0));
    let high = highest(curves.curves.iter().flat_map(|curve| curve.points).map(|point| point.1));
    let x = |along: f64| left + (right - left) * along / end;
    let y = |value: f64| bottom - (bottom - top) * (value / high).clamp(0.0, 1.0);
    let mut body = format!(r##"<rect width="{}" height="{}" fill="#fff"/>"##, SIZE_MM.0, SIZE_MM.1);
    body += &axes(end, high);
    for (index, curve) in curves.curves.iter().enumerate() {
        let stroke = COLOURS[index % COLOURS.len()];
        let dash = if index < COLOURS.len() { "none" } else { "1.6 .8" };
        let points: Vec<String> =
            peaks(curve.points).map(|(along, value)| format!("{:.2},{:.2}", x(along), y(value))).collect();
        // Writing to a String cannot fail.
        let _ = write!(
            body,
            r#"<polyline class="curve" points="{}" fill="none" stroke="{stroke}" stroke-width=".3" stroke-dasharray="{dash}" stroke-linejoin="round"/>"#,
            points.join(" ")
        );
        let place = left + LEGEND.1 * (index % LEGEND.0) as f64;
        let row = 88.0 + 3.6 * (index / LEGEND.0) as f64;
        let _ = write!(
            body,
            r#"<path d="M{place} {:.1}h5" stroke="{stroke}" stroke-width=".6" stroke-dasharray="{dash}"/><text x="{:.1}" y="{row:.1}" font-size="2" fill="{}">{}</text>"#,
            row - 0.7,
            place + 6.0,
            colour::SOFT,
            foreign::markup(curve.name)
        );
    }
    let text = |x: f64, y: f64, size: f64, text: &str| {
        format!(
            r#"<text x="{x}" y="{y}" font-size="{size}" fill="{}">{}</text>"#,
            colour::INK,
            foreign::markup(text)
        )
    };
    body += &text(left, 6.0, 3.4, curves.title);
    body += &text(left, 11.0, 2.6, curves.values);
    body += &text(f64::midpoint(left, right) - 5.0, 84.6, 2.6, curves.along);
    format!("{}\n", element(SIZE_MM.0, SIZE_MM.1, &body, curves.title, "curves"))
}

/// The axes with their ticks, up to the given ends.
fn axes(end: f64, high: f64) -> String {
    let [left, right, top, bottom] = PLOT_MM;
    let (soft, hair) = (colour::SOFT, colour::HAIR);
    let mut body = String::new();
    // Writing to a String cannot fail.
    for mark in marks(high) {
        let y = bottom - (bottom - top) * mark / high;
        let _ = write!(
            body,
            r#"<path d="M{left},{y:.2}H{right}" stroke="{hair}" stroke-width=".15"/><text x="{:.1}" y="{:.2}" font-size="2.4" text-anchor="end" fill="{soft}">{mark}</text>"#,
            left - 1.0,
            y + 0.8,
        );
    }
    for mark in marks(end) {
        let x = left + (right - left) * mark / end;
        let _ = write!(
            body,
            r#"<text x="{x:.2}" y="{:.1}" font-size="2.4" text-anchor="middle" fill="{soft}">{mark}</text>"#,
            bottom + 3.4,
        );
    }
    body
}

/// Round numbers for the ticks of an axis, from 0 to its end, spaced by 1, 2 or 5 times a power of ten.
fn marks(end: f64) -> impl Iterator<Item = f64> {
    let most = (end / MARKS).max(f64::MIN_POSITIVE);
    let power = most.log10().floor() as i32;
    let scale = 10.0_f64.powi(power);
    let step = [5.0, 2.0, 1.0].into_iter().find(|step| step * scale <= most * (1.0 + 1e-9)).unwrap_or(1.0);
    // For steps below one we divide instead of multiplying: 3 / 10 is 0.3, but 3 * 0.1 is not.
    let mark = move |k: u32| match power {
        ..0 => f64::from(k) * step / 10.0_f64.powi(-power),
        _ => f64::from(k) * step * scale,
    };
    (0..).map(mark).take_while(move |mark| *mark <= end * (1.0 + 1e-9))
}

/// The largest value in every stretch of a long curve.
fn peaks(points: &[(f64, f64)]) -> impl Iterator<Item = (f64, f64)> + '_ {
    let stretch = points.len().div_ceil(MOST_POINTS).max(1);
    points.chunks(stretch).filter_map(|points| points.iter().copied().max_by(|a, b| a.1.total_cmp(&b.1)))
}

fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(f64::MIN_POSITIVE, f64::max)
}

/// The upper end of the value axis: a little above the largest value or, if the largest are peaks, a little above
/// most values.
fn highest(values: impl Iterator<Item = f64>) -> f64 {
    let mut sorted: Vec<f64> = values.filter(|value| value.is_finite()).collect();
    sorted.sort_by(f64::total_cmp);
    let Some(largest) = sorted.last().filter(|largest| **largest > 0.0) else { return 1.0 };
    let at = (sorted.len() as f64 * SHOWN) as usize;
    let most = sorted[at.min(sorted.len() - 1)];
    1.05 * if most > 0.0 && *largest > PEAK * most { most } else { *largest }
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
        assert!(
            drawn.contains("push &amp; more") && drawn.contains(">0.8<") && !drawn.contains(">2<"),
            "{drawn}"
        );
        assert!(!drawn.contains("NaN") && drawn.len() < 30_000);
    }

    #[test]
    fn marks_are_round_numbers_up_to_the_end() {
        let marks = |end: f64| marks(end).collect::<Vec<_>>();
        assert_eq!(marks(107.0), [0.0, 20.0, 40.0, 60.0, 80.0, 100.0]);
        assert_eq!(marks(1.2), [0.0, 0.2, 0.4, 0.6, 0.8, 1.0, 1.2]);
        assert_eq!(marks(4.0), [0.0, 1.0, 2.0, 3.0, 4.0]);
    }

    #[test]
    fn more_curves_than_colours_are_told_apart_by_dashes() {
        let points = [(0.0, 1.0), (1.0, 2.0)];
        let curves = [Curve { name: "distance", points: &points }; 8];
        let drawn = svg(&Curves { title: "distances", along: "time, s", values: "m", curves: &curves });
        assert_eq!(drawn.matches(r#"class="curve""#).count(), 8);
        assert_eq!(drawn.matches(r#"stroke-dasharray="1.6 .8" stroke-linejoin"#).count(), 2);
    }

    #[test]
    fn nothing_is_drawn_as_an_empty_plot() {
        let drawn = svg(&Curves { title: "none", along: "m", values: "N", curves: &[] });
        assert!(drawn.contains("<svg") && !drawn.contains("NaN"));
    }
}
