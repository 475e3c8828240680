//! Charts of a run over mission time, and the unrolled critical zone.

use super::maps::{Figure, chart};
use crate::{
    drawing::{sheet::colour, trace::thinned},
    record::{Incident, Record, Span},
};
use account::{Account, clock};
use mission::{RunOpened, TaskConfig};
use std::fmt::Write;
use world::{Boundary, Point, ShellStretch};

/// Left and right ends of the time axis, millimetres.
const AXIS_MM: (f64, f64) = (20.0, 159.0);
/// Width of a chart, millimetres.
const WIDTH_MM: f64 = 180.0;
/// Number of columns in a curve; each column shows the largest value within it.
const COLUMNS: usize = 440;
/// Depth at which the critical zone is drawn, millimetres on paper.
const ZONE_MM: f64 = 9.0;
/// Left end and length of the unrolled shell, millimetres on paper.
const SHELL_MM: (f64, f64) = (8.0, 164.0);

/// A chart, drawn from the top down.
struct Chart {
    end_s: f64,
    step_s: f64,
    y: f64,
    body: String,
}

/// A limit line of a chart.
struct Limit<'a> {
    value: f64,
    text: String,
    colour: &'a str,
    dash: &'a str,
}

/// A curve: time and value.
type Curve<'a> = (&'a [(f64, f64)], &'a str, f64);

impl Chart {
    fn x(&self, t_s: f64) -> f64 {
        AXIS_MM.0 + (AXIS_MM.1 - AXIS_MM.0) * (t_s / self.end_s).clamp(0.0, 1.0)
    }

    fn draw(&mut self, svg: std::fmt::Arguments<'_>) {
        // Writing to a String cannot fail.
        let _ = self.body.write_fmt(svg);
    }

    fn ticks(&self) -> impl Iterator<Item = f64> + use<> {
        let (step_s, end_s) = (self.step_s, self.end_s);
        (0..).map(move |k| f64::from(k) * step_s).take_while(move |t_s| *t_s <= end_s + 1.0)
    }

    fn grid(&mut self, height: f64) {
        let (y, hair) = (self.y, colour::HAIR);
        for t_s in self.ticks() {
            let x = self.x(t_s);
            self.draw(format_args!(
                r#"<path d="M{x:.2} {y:.2}v{height}" stroke="{hair}" stroke-width=".13"/>"#
            ));
        }
    }

    fn label(&mut self, y: f64, text: &str, style: &str) {
        let x = AXIS_MM.0 - 1.4;
        self.draw(format_args!(r#"<text x="{x}" y="{y:.2}" text-anchor="end" {style}>{text}</text>"#));
    }

    /// A row of bars that show when something was active.
    fn lane(&mut self, name: &str, spans: &[Span], fill: &str) {
        let (y, hair, soft) = (self.y, colour::HAIR, colour::SOFT);
        self.label(y + 2.6, name, r#"font-weight="600""#);
        let (x0, x1) = AXIS_MM;
        self.draw(format_args!(
            r#"<path d="M{x0} {:.2}H{x1}" stroke="{hair}" stroke-width=".18"/>"#,
            y + 3.6
        ));
        for (from_s, to_s) in spans {
            let (x, width) = (self.x(*from_s), (self.x(*to_s) - self.x(*from_s)).max(0.35));
            self.draw(format_args!(
                r#"<rect x="{x:.2}" y="{:.2}" width="{width:.2}" height="2.8" fill="{fill}"/>"#,
                y + 0.4
            ));
        }
        if spans.is_empty() {
            self.draw(format_args!(
                r#"<text x="{:.2}" y="{:.2}" fill="{soft}">none</text>"#,
                x0 + 1.2,
                y + 2.6
            ));
        }
        self.y += 4.1;
    }

    /// Curves and their limits, on an axis from 0 to `top`.
    fn panel(
        &mut self,
        (title, unit): (&str, &str),
        height: f64,
        top: f64,
        curves: &[Curve<'_>],
        limits: &[Limit<'_>],
    ) {
        let (y, (x0, x1)) = (self.y, AXIS_MM);
        let (rule, soft) = (colour::RULE, colour::SOFT);
        let at = |value: f64| y + height - height * (value / top).clamp(0.0, 1.0);
        self.draw(format_args!(
            r##"<rect x="{x0}" y="{y:.2}" width="{}" height="{height}" fill="#fff" stroke="{rule}" stroke-width=".18"/>"##,
            x1 - x0
        ));
        self.grid(height);
        self.label(y + height / 2.0 - 1.2, title, r#"font-weight="600""#);
        self.label(y + height / 2.0 + 1.7, unit, &format!(r#"fill="{soft}""#));
        self.draw(format_args!(
            r#"<text x="{:.2}" y="{:.2}" fill="{soft}">0</text>"#,
            x1 + 1.2,
            y + height + 0.8
        ));
        for (points, stroke, width) in curves {
            let line: Vec<Point> = gathered(points, self.end_s)
                .into_iter()
                .map(|(t_s, v)| Point::new(self.x(t_s), at(v)))
                .collect();
            let pairs: Vec<String> =
                thinned(&line, 0.04).iter().map(|p| format!("{:.2},{:.2}", p.x, p.y)).collect();
            self.draw(format_args!(
                r#"<polyline points="{}" fill="none" stroke="{stroke}" stroke-width="{width}" stroke-linejoin="round"/>"#,
                pairs.join(" ")
            ));
        }
        // The name goes in the margin, never on the curve.
        for Limit { value, text, colour, dash } in limits {
            let line = at(*value);
            self.draw(format_args!(
                r#"<path d="M{x0} {line:.2}H{x1}" stroke="{colour}" stroke-width=".3" stroke-dasharray="{dash}"/><text x="{:.2}" y="{:.2}" fill="{colour}">{text}</text>"#,
                x1 + 1.2,
                line + 0.8
            ));
        }
        self.y += height + 3.0;
    }
}

/// The largest value in each column of a curve.
fn gathered(points: &[(f64, f64)], end_s: f64) -> Vec<(f64, f64)> {
    let mut columns: Vec<Option<f64>> = vec![None; COLUMNS];
    for (t_s, value) in points.iter().filter(|(_, value)| value.is_finite()) {
        let column = ((t_s / end_s * COLUMNS as f64).max(0.0) as usize).min(COLUMNS - 1);
        columns[column] = Some(columns[column].map_or(*value, |most| most.max(*value)));
    }
    let middle = |k: usize| (k as f64 + 0.5) / COLUMNS as f64 * end_s;
    columns.into_iter().enumerate().filter_map(|(k, value)| Some((middle(k), value?))).collect()
}

/// The time spans of incidents of a kind; an incident without an end lasts to the end of the run.
fn spans(incidents: &[Incident], kind: &str, end_s: f64) -> Vec<Span> {
    let of_kind = incidents.iter().filter(|incident| incident.kind == kind);
    of_kind.map(|incident| (incident.t_s, incident.until_s.unwrap_or(end_s))).collect()
}

/// Draws the values recorded over the mission time; `marks` are the numbered incidents. `None` for a run without a
/// tick.
pub(super) fn over_time(run: &RunOpened, record: &Record, marks: &[(usize, f64)]) -> Option<Figure> {
    let end_s = record.track.last().map(|point| f64::from(point.t_s)).filter(|end_s| *end_s > 0.0)?;
    let steps = [10.0, 30.0, 60.0, 120.0, 300.0, 600.0, 900.0, 1200.0, 1800.0, 3600.0, 7200.0];
    let step_s = steps.into_iter().find(|step| end_s / step <= 10.0).unwrap_or(14_400.0);
    let mut chart = Chart { end_s, step_s, y: 3.0, body: String::new() };
    chart.grid(16.4);
    let [scanning, driving] = &record.scanning;
    chart.lane("Scanning", scanning, colour::TRACK);
    chart.lane("Driving", driving, "#9FB4C0");
    chart.lane("Alarm", &spans(&record.incidents(), "alarm", end_s), colour::WARNING);
    chart.lane("Hold", &spans(&record.incidents(), "hold", end_s), colour::MISSED);
    draw_marks(&mut chart, marks);
    let scanned: Vec<(f64, f64)> = record.progress.iter().map(|(t_s, share)| (*t_s, 100.0 * share)).collect();
    let top = Limit { value: 100.0, text: "100".into(), colour: colour::SOFT, dash: "" };
    if matches!(run.mission.task, TaskConfig::Cover { .. }) {
        chart.panel(("Scanned", "% of reachable"), 14.0, 100.0, &[(&scanned, colour::TRACK, 0.4)], &[top]);
    }
    position_panel(&mut chart, run, record);
    if let Some(tether) = &record.tether {
        let curve = |of: fn(&crate::record::TetherPoint) -> f32| -> Vec<(f64, f64)> {
            tether.points.iter().map(|point| (f64::from(point.t_s), f64::from(of(point)))).collect()
        };
        let reel_m = tether.limits.reel_length_m;
        let limits = [
            Limit { value: reel_m, text: format!("{reel_m:.1} reel"), colour: colour::MISSED, dash: "" },
            Limit {
                value: 0.8 * reel_m,
                text: format!("{:.1} warning", 0.8 * reel_m),
                colour: colour::WARNING,
                dash: "1.2 .8",
            },
        ];
        let out = curve(|point| point.length_m);
        chart.panel(("Tether out", "m"), 18.0, 1.1 * reel_m, &[(&out, colour::TETHER, 0.4)], &limits);
        let degrees = |rad: f64| rad.to_degrees();
        let (one, all) = (degrees(tether.limits.wrap_max_rad), degrees(tether.limits.wrap_total_max_rad));
        let limits = [
            Limit { value: all, text: format!("{all:.0} in total"), colour: colour::MISSED, dash: "" },
            Limit {
                value: one,
                text: format!("{one:.0} per obstacle"),
                colour: colour::MISSED,
                dash: "1.2 .8",
            },
        ];
        let (total, largest) = (
            curve(|point| point.wrap_total_rad.to_degrees()),
            curve(|point| point.wrap_max_rad.to_degrees()),
        );
        let curves = [(&total[..], "#B58CC2", 0.35), (&largest[..], colour::TETHER, 0.4)];
        chart.panel(("Wraps", "degrees"), 18.0, 1.1 * all.max(one), &curves, &limits);
    }
    for t_s in chart.ticks() {
        let (x, y, text) = (chart.x(t_s), chart.y, clock(t_s));
        chart.draw(format_args!(r#"<text x="{x:.2}" y="{y:.2}" text-anchor="middle">{text}</text>"#));
    }
    let (y, soft) = (chart.y, colour::SOFT);
    chart.draw(format_args!(r#"<text x="{:.2}" y="{y:.2}" fill="{soft}">h:m:s</text>"#, AXIS_MM.1 + 10.0));
    Some(Figure {
        caption: "Values recorded during the mission. Numbers refer to the incidents in the table below. Position: \
                  dark line, 95 % error; light line, true error (simulation only). Wraps: dark line, \
                  largest wrap on one obstacle; light line, total wrap."
            .into(),
        svg: self::chart(WIDTH_MM, chart.y + 1.5, &chart.body, "Values over time"),
        legend: Vec::new(),
    })
}

fn draw_marks(chart: &mut Chart, marks: &[(usize, f64)]) {
    let (y, soft) = (chart.y, colour::SOFT);
    chart.label(y + 3.2, "Incident", r#"font-weight="600""#);
    // There are three rows; a number that fits in none of them appears only in the table.
    let mut ends = [f64::NEG_INFINITY; 3];
    for (number, t_s) in marks {
        let x = chart.x(*t_s);
        let Some(row) = ends.iter().position(|end| x - end >= 3.8) else { continue };
        ends[row] = x;
        let at = y + 2.7 + 3.6 * row as f64;
        chart.draw(format_args!(
            r##"<path d="M{x:.2} {y:.2}V{:.2}" stroke="{soft}" stroke-width=".18"/><circle cx="{x:.2}" cy="{at:.2}" r="1.75" fill="#fff" stroke="{soft}" stroke-width=".2"/><text x="{x:.2}" y="{at:.2}" dy=".35em" text-anchor="middle" font-size="2">{number}</text>"##,
            at - 1.7
        ));
    }
    chart.y += 13.0;
}

fn position_panel(chart: &mut Chart, run: &RunOpened, record: &Record) {
    let cm = |of: fn(&crate::record::TrackPoint) -> f32| -> Vec<(f64, f64)> {
        record.track.iter().map(|point| (f64::from(point.t_s), 100.0 * f64::from(of(point)))).collect()
    };
    let (claimed, truth) = (cm(|point| point.error_m), cm(|point| point.true_error_m));
    let limit_cm = 100.0 * run.mission.scan_limit_m();
    let curves = [(&truth[..], "#B7C2C9", 0.25), (&claimed[..], colour::TRACK, 0.35)];
    let limit = Limit {
        value: limit_cm,
        text: format!("{limit_cm:.0} scan limit"),
        colour: colour::MISSED,
        dash: "",
    };
    chart.panel(("Position", "95 % error, cm"), 16.0, 1.12 * limit_cm, &curves, &[limit]);
}

/// The critical zone unrolled, with the shell as the upper edge.
pub(super) fn zone(run: &RunOpened, account: &Account, shell: &[ShellStretch]) -> Figure {
    let boundary = &run.world.boundary;
    let width_m = account.critical_zone.width_m;
    let total_m = shell.last().map_or(1.0, |stretch| stretch.along_m + stretch.length_m).max(1e-6);
    let ((left, length), top) = (SHELL_MM, 9.0);
    let scale = length / total_m;
    let (ink, soft, missed) = (colour::INK, colour::SOFT, colour::MISSED);
    let mut body = format!(
        r#"<rect x="{left}" y="{top}" width="{length}" height="{ZONE_MM}" fill="{}"/>"#,
        colour::ONCE
    );
    for stretch in shell {
        let Some(gap_m) = stretch.gap_m else { continue };
        let (x, width) = (left + stretch.along_m * scale, (stretch.length_m * scale).max(0.08));
        let depth = if gap_m > 0.0 {
            ZONE_MM * gap_m / width_m
        } else {
            ZONE_MM * (1.0 - stretch.scanned / stretch.free)
        };
        let _ = write!(
            body,
            r#"<rect x="{x:.2}" y="{top}" width="{width:.2}" height="{depth:.2}" fill="{missed}"/>"#
        );
    }
    let _ = write!(
        body,
        r#"<rect x="{left}" y="{top}" width="{length}" height="{ZONE_MM}" fill="none" stroke="{ink}" stroke-width=".25"/><path d="M{left} {top}h{length}" stroke="{ink}" stroke-width=".6"/>"#
    );
    let foot = top + ZONE_MM;
    for (along, text, bold) in marks_along(boundary, total_m) {
        let x = left + along * length;
        let (y, weight) = if bold { (foot + 7.2, 600) } else { (foot + 4.2, 400) };
        let _ = write!(
            body,
            r#"<path d="M{x:.2} {foot}v1.2" stroke="{ink}" stroke-width=".18"/><text x="{x:.2}" y="{y}" text-anchor="middle" font-weight="{weight}">{text}</text>"#
        );
    }
    let mut at = 0.0;
    let plates = &account.critical_zone.plates;
    for (index, plate) in plates.iter().enumerate().filter(|_| matches!(boundary, Boundary::Circle { .. })) {
        let room = plate.length_m * scale;
        let x = left + at * scale;
        let _ = write!(body, r#"<path d="M{x:.2} {}v3.4" stroke="{soft}" stroke-width=".13"/>"#, top - 3.4);
        if room > 7.0 || (room > 2.0 && index % 5 == 0) {
            let name = if room > 7.0 { plate.plate.as_str() } else { plate.plate.trim_start_matches("A-") };
            let _ = write!(
                body,
                r#"<text x="{:.2}" y="{}" text-anchor="middle">{name}</text>"#,
                x + room / 2.0,
                top - 1.2
            );
        }
        at += plate.length_m;
    }
    let _ = write!(
        body,
        r#"<text x="{0}" y="{1}" text-anchor="end">0</text><text x="{0}" y="{foot}" text-anchor="end">{2:.0}</text><text x="{3}" y="{4}">mm</text>"#,
        left - 1.0,
        top + 2.2,
        1000.0 * width_m,
        left + length + 1.2,
        top + 5.2
    );
    let from = match boundary {
        Boundary::Circle { .. } => "counter-clockwise from east",
        Boundary::Polygon { .. } => "from the first corner of the drawing",
    };
    let times = ZONE_MM / width_m / (length / total_m);
    Figure {
        caption: format!(
            "The zone unrolled, {from}; the upper edge, 0 mm, is the shell. Filled: not scanned. The depth \
             scale is {times:.0} times the length scale."
        ),
        svg: chart(WIDTH_MM, foot + 8.4, &body, "Critical zone along the shell, unrolled"),
        legend: Vec::new(),
    }
}

/// Marks along the shell: position as a share of its length, text, and whether the text goes in the lower row.
fn marks_along(boundary: &Boundary, total_m: f64) -> Vec<(f64, String, bool)> {
    match boundary {
        Boundary::Circle { .. } => {
            let degrees = (0..=8).map(|k| (f64::from(k) / 8.0, format!("{}°", 45 * k), false));
            let names = ["E", "N", "W", "S", "E"].into_iter().zip(0..);
            degrees.chain(names.map(|(name, k)| (f64::from(k) / 4.0, name.to_owned(), true))).collect()
        }
        Boundary::Polygon { vertices } => {
            let mut along_m = 0.0;
            let corners = world::polyline::edges(vertices).map(|(a, b)| {
                let mark = (along_m / total_m, format!("{:.1}, {:.1}", a.x, a.y), false);
                along_m += (b - a).norm();
                mark
            });
            corners.collect()
        }
    }
}

/// Whether an incident has a number on the chart.
pub(super) fn is_marked(incident: &Incident) -> bool {
    incident.needs_review() || matches!(incident.kind, "obstacle" | "zone" | "end")
}
