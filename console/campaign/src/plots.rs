//! Plots findings as SVG.

use crate::{findings::Findings, table::more_is_better};
use std::fmt::Write;

/// Width of a plot, and of the names to its left, in drawing units.
const WIDTH: f64 = 720.0;
const NAMES: f64 = 240.0;
/// Height of a line of text.
const LINE: f64 = 20.0;
/// Height of a plot with two axes.
const HEIGHT: f64 = 300.0;
/// Colours for the arms, used in turn; they do not rely on telling red from green.
const COLOURS: [&str; 6] = ["#2C5F7C", "#B26A00", "#7A3E8C", "#39444E", "#C23B1E", "#5A8DA6"];
/// Maximum number of curves that can be told apart.
const MOST_CURVES: usize = 6;

fn colour(arm: usize) -> &'static str {
    COLOURS[arm % COLOURS.len()]
}

struct Plot {
    height: f64,
    body: String,
}

impl Plot {
    fn new(height: f64) -> Self {
        Self { height, body: String::new() }
    }

    fn text(&mut self, x: f64, y: f64, anchor: &str, text: &str) {
        let text = foreign::markup(text);
        self.draw(format_args!(r#"<text x="{x:.1}" y="{y:.1}" text-anchor="{anchor}">{text}</text>"#));
    }

    fn line(&mut self, (x, y): (f64, f64), (to_x, to_y): (f64, f64), colour: &str) {
        self.draw(format_args!(
            r#"<path d="M{x:.1} {y:.1}L{to_x:.1} {to_y:.1}" stroke="{colour}" fill="none"/>"#
        ));
    }

    fn dot(&mut self, x: f64, y: f64, colour: &str) {
        self.draw(format_args!(r#"<circle cx="{x:.1}" cy="{y:.1}" r="3.5" fill="{colour}"/>"#));
    }

    fn ring(&mut self, x: f64, y: f64, colour: &str) {
        self.draw(format_args!(r#"<circle cx="{x:.1}" cy="{y:.1}" r="3.5" fill="none" stroke="{colour}"/>"#));
    }

    fn draw(&mut self, svg: std::fmt::Arguments<'_>) {
        // Writing to a String cannot fail.
        let _ = self.body.write_fmt(svg);
    }

    fn svg(self, name: &str) -> String {
        format!(
            r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {}" role="img" aria-label="{}" font-size="12">{}</svg>"#,
            self.height,
            foreign::markup(name),
            self.body
        )
    }
}

/// An axis that maps values from low to high to a range of positions in the drawing.
struct Axis {
    values: (f64, f64),
    places: (f64, f64),
}

impl Axis {
    fn over(values: impl Iterator<Item = f64>, places: (f64, f64)) -> Self {
        let (low, high) =
            values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
        let rim = if high > low { 0.05 * (high - low) } else { 0.5 };
        Self { values: (low - rim, high + rim), places }
    }

    fn at(&self, value: f64) -> f64 {
        let (low, high) = self.values;
        self.places.0 + (self.places.1 - self.places.0) * (value - low) / (high - low)
    }

    /// Round numbers for the ticks of the axis, within its range.
    fn ticks(&self) -> Vec<f64> {
        let (low, high) = self.values;
        let raw = (high - low) / 5.0;
        let power = 10_f64.powf(raw.log10().floor());
        let step =
            [1.0, 2.0, 5.0, 10.0].map(|k| k * power).into_iter().find(|step| *step >= raw).unwrap_or(raw);
        let (first, last) = ((low / step).ceil() as i64, (high / step).floor() as i64);
        (first..=last).map(|k| k as f64 * step).collect()
    }
}

/// Formats a number without superfluous digits.
fn number(value: f64) -> String {
    format!("{}", (value * 1e6).round() / 1e6)
}

fn axes(plot: &mut Plot, across: (&Axis, &str), up: (&Axis, &str)) {
    for tick in across.0.ticks() {
        let x = across.0.at(tick);
        plot.line((x, up.0.places.0), (x, up.0.places.1), "#DDE3E7");
        plot.text(x, up.0.places.0 + 16.0, "middle", &number(tick));
    }
    for tick in up.0.ticks() {
        let y = up.0.at(tick);
        plot.line((across.0.places.0, y), (across.0.places.1, y), "#DDE3E7");
        plot.text(across.0.places.0 - 6.0, y + 4.0, "end", &number(tick));
    }
    plot.text(across.0.places.1, up.0.places.0 + 34.0, "end", across.1);
    plot.text(across.0.places.0, up.0.places.1 - 8.0, "start", up.1);
}

/// The success of every arm, with its interval.
pub(crate) fn success(findings: &Findings) -> String {
    let axis = Axis { values: (0.0, 1.0), places: (NAMES, WIDTH - 20.0) };
    let foot = findings.arms.len() as f64 * LINE + 8.0;
    let mut plot = Plot::new(foot + 22.0);
    for share in [0.0, 0.25, 0.5, 0.75, 1.0] {
        plot.line((axis.at(share), 4.0), (axis.at(share), foot), "#DDE3E7");
        plot.text(axis.at(share), foot + 16.0, "middle", &format!("{} %", 100.0 * share));
    }
    for (at, arm) in findings.arms.iter().enumerate() {
        let y = (at as f64 + 0.5) * LINE + 4.0;
        plot.text(NAMES - 10.0, y + 4.0, "end", &arm.name.chars().take(38).collect::<String>());
        if let Some(share) = arm.success.share() {
            plot.line((axis.at(arm.success.low), y), (axis.at(arm.success.high), y), colour(at));
            plot.dot(axis.at(share), y, colour(at));
        }
    }
    plot.svg("Success with 95 % intervals")
}

/// Curves for the first arms: the share of all missions run that are complete with at most a given value of the first
/// metric. Each curve ends at the arm's share of complete missions.
pub(crate) fn distribution(findings: &Findings) -> Option<String> {
    let metric = findings.metrics.first()?;
    let curves =
        || findings.arms.iter().enumerate().take(MOST_CURVES).filter(|(_, arm)| arm.quantiles.len() > 1);
    curves().next()?;
    let across =
        Axis::over(curves().flat_map(|(_, arm)| arm.quantiles.iter().copied()), (60.0, WIDTH - 20.0));
    let up = Axis { values: (0.0, 1.0), places: (HEIGHT - 40.0, 30.0) };
    let mut plot = Plot::new(HEIGHT + LINE * curves().count() as f64);
    axes(&mut plot, (&across, metric), (&up, "complete, as a share of the missions run"));
    for (line, (at, arm)) in curves().enumerate() {
        let (last, most) = ((arm.quantiles.len() - 1) as f64, arm.complete.share().unwrap_or(0.0));
        let point = |(k, value): (usize, &f64)| {
            format!("{:.1},{:.1} ", across.at(*value), up.at(most * k as f64 / last))
        };
        let points: String = arm.quantiles.iter().enumerate().map(point).collect();
        let (ink, y) = (colour(at), HEIGHT + 4.0 + LINE * line as f64);
        plot.draw(format_args!(
            r#"<polyline points="{points}" fill="none" stroke="{ink}" stroke-width="1.6"/>"#
        ));
        plot.line((60.0, y), (84.0, y), ink);
        plot.text(92.0, y + 4.0, "start", &arm.name);
    }
    Some(plot.svg("Distribution of the first metric"))
}

/// The means of the first two metrics over complete missions. Arms that no other arm beats in both metrics are named and
/// joined by a line. Arms that complete clearly fewer missions than another arm are drawn hollow and not ranked.
pub(crate) fn pareto(findings: &Findings) -> Option<String> {
    let [one, two, ..] = &findings.metrics[..] else { return None };
    let value = |mean: &Option<crate::statistics::Mean>| mean.as_ref().map(|mean| mean.mean);
    let point =
        |(at, arm): (usize, &crate::findings::Arm)| Some((at, value(&arm.means[0])?, value(&arm.means[1])?));
    let points: Vec<(usize, f64, f64)> = findings.arms.iter().enumerate().filter_map(point).collect();
    if points.len() < 2 {
        return None;
    }
    let across = Axis::over(points.iter().map(|point| point.1), (60.0, WIDTH - 20.0));
    let up = Axis::over(points.iter().map(|point| point.2), (HEIGHT - 40.0, 30.0));
    let mut plot = Plot::new(HEIGHT);
    axes(&mut plot, (&across, one), (&up, two));
    let ranked = findings.ranked();
    let (points, unranked): (Vec<_>, Vec<_>) = points.into_iter().partition(|point| ranked[point.0]);
    let front = front(&points, [more_is_better(one), more_is_better(two)]);
    let place = |(_, x, y): &(usize, f64, f64)| format!("{:.1},{:.1} ", across.at(*x), up.at(*y));
    let line: String = front.iter().map(place).collect();
    plot.draw(format_args!(
        r##"<polyline points="{line}" fill="none" stroke="#53616C" stroke-dasharray="4 3"/>"##
    ));
    for (at, x, y) in &points {
        plot.dot(across.at(*x), up.at(*y), colour(*at));
    }
    for (at, x, y) in &unranked {
        plot.ring(across.at(*x), up.at(*y), colour(*at));
    }
    for (at, x, y) in front.iter().chain(&unranked).take(12) {
        let (place, anchor) = if across.at(*x) > WIDTH / 2.0 { (-8.0, "end") } else { (8.0, "start") };
        let arm = &findings.arms[*at];
        let name = if ranked[*at] {
            arm.name.clone()
        } else {
            format!("{}, completes {} of {}", arm.name, arm.complete.hits, arm.complete.n)
        };
        plot.text(across.at(*x) + place, up.at(*y) - 6.0, anchor, &name);
    }
    Some(plot.svg("Pareto front of two metrics"))
}

/// The points that no other point beats in both figures, from left to right.
fn front(points: &[(usize, f64, f64)], more: [bool; 2]) -> Vec<(usize, f64, f64)> {
    let cost = |point: &(usize, f64, f64)| {
        let sign = |more: bool| if more { -1.0 } else { 1.0 };
        (sign(more[0]) * point.1, sign(more[1]) * point.2)
    };
    let surpassed = |point: &(usize, f64, f64)| {
        let (a, b) = cost(point);
        points.iter().map(cost).any(|(c, d)| c <= a && d <= b && (c < a || d < b))
    };
    let mut front: Vec<_> = points.iter().filter(|point| !surpassed(point)).copied().collect();
    front.sort_by(|a, b| a.1.total_cmp(&b.1));
    front
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_front_holds_what_no_other_surpasses() {
        let points = [(0, 1.0, 5.0), (1, 2.0, 3.0), (2, 3.0, 4.0), (3, 4.0, 1.0)];
        let of = |more| front(&points, more).iter().map(|point| point.0).collect::<Vec<_>>();
        assert_eq!(of([false, false]), [0, 1, 3]);
        assert_eq!(of([false, true]), [0]);
        assert_eq!(of([true, true]), [0, 2, 3]);
    }

    #[test]
    fn ticks_are_round_and_within() {
        let axis = Axis::over([0.13, 0.87].into_iter(), (0.0, 1.0));
        assert_eq!(
            axis.ticks().iter().map(|tick| number(*tick)).collect::<Vec<_>>(),
            ["0.2", "0.4", "0.6", "0.8"]
        );
    }
}
