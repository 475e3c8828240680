//! The maps of a report.

use super::{indications::Indication, layers::Layers, marks, words::number_of};
use crate::{
    drawing::{
        badges::{self, Numbered},
        sheet::{Sheet, colour, element},
        trace::thinned,
    },
    human::text::counted,
    record::{Lay, Record},
};
use mission::MissionConfig;
use serde::Serialize;
use std::fmt::Write;
use world::{FloorClass, Point, coverage::percent_text};

/// Widths of maps, millimetres on paper.
pub(super) const FULL_MM: f64 = 180.0;
const HALF_MM: f64 = 88.0;
/// The name of floor that the tool cannot test because of the welds.
const NOT_TESTABLE: &str = "not testable by this tool";
/// Maximum number of badges on a map.
const MOST_BADGES: usize = 60;

/// A picture with its legend.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Figure {
    /// The caption.
    pub caption: String,
    /// The picture, as an SVG element.
    #[serde(skip)]
    pub svg: String,
    /// The meaning of its colours and symbols.
    #[serde(skip)]
    pub legend: Vec<Legend>,
}

/// A line of a legend.
#[derive(Debug, Clone, PartialEq)]
pub struct Legend {
    /// A sample of the colour or symbol, as an SVG element.
    pub swatch: String,
    /// The meaning of the sample.
    pub text: String,
    /// The amount, such as an area or a share.
    pub value: String,
}

pub(super) fn swatch(inside: &str) -> String {
    format!(r#"<svg class="sw" viewBox="0 0 7 4" aria-hidden="true">{inside}</svg>"#)
}

pub(super) fn filled(fill: &str) -> String {
    swatch(&format!(
        r##"<rect x=".2" y=".2" width="6.6" height="3.6" fill="{fill}" stroke="#7D8A93" stroke-width=".2"/>"##
    ))
}

pub(super) fn legend(swatch: String, text: &str, value: String) -> Legend {
    Legend { swatch, text: text.to_owned(), value }
}

/// Draws scanned and unscanned floor with numbered areas; also returns the numbers that have a badge.
pub(super) fn coverage(layers: &Layers<'_>, indications: &[Indication]) -> (Figure, Vec<usize>) {
    let (floor, fixtures) = (layers.floor(), layers.fixtures());
    let mut sheet = Sheet::new(fixtures.boundary, "c", FULL_MM, 8.0);
    let (missed, margin, out) = (sheet.pattern("missed"), sheet.pattern("margin"), sheet.pattern("out"));
    sheet.define_patterns(floor.cell_m);
    // A cell that was not scanned must never be drawn as scanned.
    sheet.wall(fixtures.boundary, r##"fill="#fff""##);
    sheet.cells(floor, |cell| layers.is_scanned(cell), 0.75, &format!(r#"fill="{}""#, colour::ONCE));
    {
        let twice = layers.smoothed_twice();
        sheet.cells(floor, |cell| twice[cell], 1.0, &format!(r#"fill="{}""#, colour::TWICE));
    }
    sheet.plates(layers.plates.as_ref());
    let line = |fill: &str, stroke: &str| format!(r#"fill="{fill}" stroke="{stroke}" stroke-width=".2""#);
    sheet.cells(floor, |cell| layers.is(cell, FloorClass::Margin), 0.0, &line(&margin, colour::MARGIN));
    sheet.cells(floor, |cell| layers.is(cell, FloorClass::Unreachable), 0.0, &line(&out, colour::OUT));
    sheet.untestable(floor, |cell| layers.is(cell, FloorClass::Untestable));
    let style = format!(
        r#"fill="{missed}" stroke="{}" stroke-width=".25" stroke-linejoin="round""#,
        colour::MISSED_LINE
    );
    sheet.cells(floor, |cell| layers.is(cell, FloorClass::Missed), 0.0, &style);
    sheet.obstacles(&fixtures);
    sheet.frame(&fixtures, 2.4);
    let mut names = sheet.plate_names(layers.plates.as_ref(), 2.1);
    let marks = marks::draw(&mut sheet, indications, &names);
    names.extend(marks.boxes);
    let numbered: Vec<Numbered<'_>> = layers
        .gaps
        .iter()
        .enumerate()
        .map(|(index, (at, cells))| Numbered { number: index + 1, at: *at, cells })
        .collect();
    let most = &numbered[..numbered.len().min(MOST_BADGES)];
    let shown = badges::draw(&mut sheet, (floor, &fixtures), most, &names);
    let cells_of = |class: FloorClass| (0..floor.len()).filter(|cell| layers.is(*cell, class)).count();
    let m2_of = |class: FloorClass| format!("{:.2} m²", cells_of(class) as f64 * floor.cell_m2());
    let solid = colour::SOLID;
    let dot = |attributes: &str| swatch(&format!(r#"<circle cx="3.5" cy="2" r="1.3" {attributes}/>"#));
    let station = concat!(
        r##"<circle cx="3.5" cy="2" r="1" fill="#fff" stroke="#1C2731" stroke-width=".35"/>"##,
        r#"<circle cx="3.5" cy="2" r=".35"/>"#
    );
    let found = format!(r#"fill="url(#cfound)" stroke="{solid}" stroke-width=".3""#);
    let mut entries = vec![
        legend(filled(colour::ONCE), "scanned once", m2_of(FloorClass::Scanned)),
        legend(filled(colour::TWICE), "scanned more than once", m2_of(FloorClass::Again)),
        legend(filled("url(#cmissedL)"), "missed", m2_of(FloorClass::Missed)),
        legend(filled("url(#cmarginL)"), "shell margin", m2_of(FloorClass::Margin)),
        legend(filled("url(#coutL)"), "unreachable", m2_of(FloorClass::Unreachable)),
        legend(dot(&format!(r#"fill="{solid}""#)), "obstacle on the drawing", String::new()),
        legend(dot(&found), "obstacle found during the run", String::new()),
        legend(swatch(station), "station of the position system", String::new()),
        start_or_anchor(&layers.run.mission),
    ];
    if layers.has_untestable() {
        let area = m2_of(FloorClass::Untestable);
        entries.insert(5, legend(filled(colour::UNTESTABLE), NOT_TESTABLE, area));
    }
    if !layers.is_to_scan {
        entries.retain(|entry| !["missed", "shell margin", "unreachable"].contains(&entry.text.as_str()));
    }
    if !layers.run.world.zones.is_empty() {
        let zone = dot(&format!(r#"fill="none" stroke="{solid}" stroke-width=".3" stroke-dasharray="1 .7""#));
        entries.push(legend(zone, "zone", String::new()));
    }
    if !indications.is_empty() {
        let mark = dot(&format!("{} stroke=\"{}\"", marks::STYLE, colour::TETHER));
        entries.push(legend(mark, "indication (I and its number)", indications.len().to_string()));
    }
    let hidden = numbered.len() - shown.len();
    let mut note = String::new();
    if hidden > 0 {
        let _ = write!(note, " Areas without a badge: {hidden}; section 3 lists their positions.");
    }
    if marks.unnumbered > 0 {
        let unnumbered = counted(marks.unnumbered, "indication");
        let section = number_of(layers.is_to_scan, 7);
        let _ = write!(
            note,
            " Without a number on the map: {unnumbered}; section {section} lists the positions."
        );
    }
    let (once, again) = (cells_of(FloorClass::Scanned), cells_of(FloorClass::Again));
    let overlap = percent_text(again as f64 / (once + again).max(1) as f64, 1);
    let missed = if layers.is_to_scan {
        " Missed cells have an outline of 0.25 mm so that they stay visible."
    } else {
        ""
    };
    let caption = format!(
        "Floor scanned, according to the estimated position; {overlap} % of it more than once.{missed}{note}"
    );
    (Figure { caption, svg: sheet.svg("Coverage map", "full"), legend: entries }, shown)
}

/// The legend of the mark of the anchor or, without a tether, of the start.
pub(super) fn start_or_anchor(mission: &MissionConfig) -> Legend {
    let mark = r##"<path d="M2.2,3L4.8,3L3.5,.7z" fill="#fff" stroke="#1C2731" stroke-width=".35"/>"##;
    legend(swatch(mark), anchor_words(mission), String::new())
}

/// The label of the anchor mark; without a tether the mark shows the start.
fn anchor_words(mission: &MissionConfig) -> &'static str {
    match &mission.tether {
        None => "start",
        Some(tether) if (tether.anchor - mission.start.position).norm() < 1.0 => "start and anchor",
        Some(_) => "anchor",
    }
}

/// Draws the accuracy of the position on the scanned floor.
pub(super) fn accuracy(layers: &Layers<'_>) -> Figure {
    let (floor, fixtures) = (layers.floor(), layers.fixtures());
    let (edges_m, classes) = layers.error_classes();
    let mut sheet = Sheet::new(fixtures.boundary, "a", HALF_MM, 5.5);
    let missed = sheet.pattern("missed");
    sheet.define_patterns(floor.cell_m);
    sheet.wall(fixtures.boundary, r##"fill="#fff""##);
    for (class, colour) in (0_u8..).zip(colour::ERROR) {
        let is_in = |cell: usize| classes[cell] != u8::MAX && classes[cell] >= class;
        sheet.cells(floor, is_in, 0.9, &format!(r#"fill="{colour}""#));
    }
    let style = format!(r#"fill="{missed}" stroke="{}" stroke-width=".15""#, colour::MISSED_LINE);
    sheet.cells(floor, |cell| layers.is(cell, FloorClass::Missed), 0.0, &style);
    sheet.obstacles(&fixtures);
    sheet.frame(&fixtures, 2.2);
    let scanned = classes.iter().filter(|class| **class != u8::MAX).count().max(1);
    let cm = |m: f64| 100.0 * m;
    let text = |class: usize| match class {
        0 => format!("up to {:.1} cm", cm(edges_m[0])),
        4 => format!("above {:.1} cm", cm(edges_m[3])),
        _ => format!("{:.1} to {:.1} cm", cm(edges_m[class - 1]), cm(edges_m[class])),
    };
    let share = |class: usize| {
        classes.iter().filter(|other| usize::from(**other) == class).count() as f64 / scanned as f64
    };
    let percents = world::coverage::percents([0, 1, 2, 3, 4].map(share));
    let entry = |(class, colour): (usize, &str)| {
        legend(filled(colour), &text(class), format!("{:.1} %", percents[class]))
    };
    Figure {
        caption: "95 % error of the best pass over each place; the error of a pass is the largest error \
             within a ranging period. Percentages are of the scanned floor."
            .into(),
        svg: sheet.svg("Position accuracy map", "half"),
        legend: colour::ERROR.into_iter().enumerate().map(entry).collect(),
    }
}

/// Draws guaranteed floor, and floor that was scanned only if the estimated position was correct.
pub(super) fn guaranteed(layers: &Layers<'_>, whole: &account::Shares) -> Figure {
    let (floor, fixtures) = (layers.floor(), layers.fixtures());
    let mut sheet = Sheet::new(fixtures.boundary, "g", HALF_MM, 5.5);
    let missed = sheet.pattern("missed");
    sheet.define_patterns(floor.cell_m);
    sheet.wall(fixtures.boundary, r##"fill="#fff""##);
    let sure = |cell: usize| layers.is_guaranteed(cell);
    sheet.cells(floor, sure, 0.9, &format!(r#"fill="{}""#, colour::ONCE));
    let thin = format!(r#"fill="{}" stroke="{}" stroke-width=".12""#, colour::THIN, colour::THIN_LINE);
    sheet.cells(floor, |cell| layers.is_scanned(cell) && !sure(cell), 0.6, &thin);
    let out = |cell: usize| layers.is(cell, FloorClass::Unreachable) || layers.is(cell, FloorClass::Margin);
    sheet.cells(floor, out, 0.0, &format!(r#"fill="{}""#, colour::OUT));
    sheet.untestable(floor, |cell| layers.is(cell, FloorClass::Untestable));
    let style = format!(r#"fill="{missed}" stroke="{}" stroke-width=".15""#, colour::MISSED_LINE);
    sheet.cells(floor, |cell| layers.is(cell, FloorClass::Missed), 0.0, &style);
    sheet.obstacles(&fixtures);
    sheet.frame(&fixtures, 2.2);
    let percent = whole.percent;
    let sure = percent.guaranteed.unwrap_or(0.0);
    let per_cent = |value: f64| format!("{value:.1} %");
    let mut entries = vec![
        legend(filled(colour::ONCE), "guaranteed", per_cent(sure)),
        legend(filled(colour::THIN), "scanned, not guaranteed", per_cent(percent.scanned - sure)),
        legend(filled("url(#gmissedL)"), "missed", per_cent(percent.missed)),
        legend(
            filled(colour::OUT),
            "unreachable or shell margin",
            per_cent(percent.unreachable + percent.margin),
        ),
    ];
    if layers.has_untestable() {
        entries.push(legend(filled(colour::UNTESTABLE), NOT_TESTABLE, per_cent(percent.untestable)));
    }
    Figure {
        caption: "Guaranteed floor; percentages are of the whole floor".into(),
        svg: sheet.svg("Guaranteed coverage map", "half"),
        legend: entries,
    }
}

/// Draws the estimated track.
pub(super) fn track(layers: &Layers<'_>, record: &Record) -> Option<Figure> {
    let fixtures = layers.fixtures();
    let mut sheet = Sheet::new(fixtures.boundary, "t", HALF_MM, 5.5);
    sheet.define_patterns(layers.floor().cell_m);
    sheet.wall(fixtures.boundary, r##"fill="#fff""##);
    sheet.plates(layers.plates.as_ref());
    let line = track_line(&sheet, record);
    let end = *line.last()?;
    let path = path_of(&line);
    sheet.draw(format_args!(
        r#"<path d="{path}" fill="none" stroke="{}" stroke-width=".22" stroke-linejoin="round"/>"#,
        colour::TRACK
    ));
    sheet.obstacles(&fixtures);
    sheet.draw(format_args!(r#"<path d="{}" fill="{}"/>"#, arrows(&line), colour::INK));
    sheet.frame(&fixtures, 2.2);
    sheet.draw(format_args!(
        r##"<circle cx="{:.2}" cy="{:.2}" r=".9" fill="{}" stroke="#fff" stroke-width=".3"/>"##,
        end.x,
        end.y,
        colour::INK
    ));
    let caption = "Estimated track; the dot marks its end".into();
    Some(Figure { caption, svg: sheet.svg("Track of the robot", "half"), legend: Vec::new() })
}

/// Adds the track to a sheet.
fn track_line(sheet: &Sheet, record: &Record) -> Vec<Point> {
    let places: Vec<Point> = record.track.iter().map(|point| sheet.at(point.position())).collect();
    thinned(&places, 0.06)
}

/// A line on the paper as SVG path data.
fn path_of(line: &[Point]) -> String {
    let mut path = String::new();
    for (index, point) in line.iter().enumerate() {
        // Writing to a String cannot fail.
        let _ = write!(path, "{}{:.2} {:.2}", if index == 0 { "M" } else { "L" }, point.x, point.y);
    }
    path
}

/// The track on a sheet as SVG path data.
pub(super) fn drawn_track(sheet: &Sheet, record: &Record) -> String {
    path_of(&track_line(sheet, record))
}

/// Evenly spaced arrowheads along a line on the paper.
fn arrows(line: &[Point]) -> String {
    let stations = world::polyline::stations_m(line);
    let length_mm = stations.last().copied().unwrap_or(0.0);
    let count = if length_mm < 4000.0 { 26 } else { 44 };
    let head = |k: usize| {
        let along = length_mm * (k as f64 + 0.5) / count as f64;
        let next = stations.partition_point(|station| *station < along).clamp(1, line.len().max(2) - 1);
        let (a, b) = (*line.get(next - 1)?, *line.get(next)?);
        let ahead = (b - a).try_normalize(1e-9)?;
        let at = a + ahead * (along - stations[next - 1]);
        let left = world::Vector::new(-ahead.y, ahead.x);
        let (tip, one, other) =
            (at + ahead * 0.9, at - ahead * 0.6 + left * 0.6, at - ahead * 0.6 - left * 0.6);
        Some(format!("M{:.2} {:.2}L{:.2} {:.2}L{:.2} {:.2}Z", tip.x, tip.y, one.x, one.y, other.x, other.y))
    };
    (0..count).filter_map(head).collect()
}

/// Draws the course of the tether; `None` for a robot without one.
pub(super) fn tether(layers: &Layers<'_>, record: &Record) -> Option<Figure> {
    let tether = record.tether.as_ref().filter(|tether| !tether.points.is_empty())?;
    let fixtures = layers.fixtures();
    let mut sheet = Sheet::new(fixtures.boundary, "w", HALF_MM, 5.5);
    sheet.define_patterns(layers.floor().cell_m);
    sheet.wall(fixtures.boundary, r##"fill="#fff""##);
    let style = format!(r#"stroke="{}" stroke-width=".13" opacity=".32""#, colour::TETHER);
    for line in &tether.lines {
        sheet.line(line, &style);
    }
    sheet.obstacles(&fixtures);
    sheet.frame(&fixtures, 2.2);
    for (letter, lay, dash) in
        [("L", &tether.longest, ""), ("W", &tether.most_wrapped, r#"stroke-dasharray="1.6 .8""#)]
    {
        mark_lay(&mut sheet, letter, lay, dash);
    }
    let caption = "Course of the tether; L: greatest length paid out, W: largest total wrap".into();
    Some(Figure { caption, svg: sheet.svg("Tether on the floor", "half"), legend: Vec::new() })
}

fn mark_lay(sheet: &mut Sheet, letter: &str, lay: &Lay, dash: &str) {
    let Some(end) = lay.line.last() else { return };
    let tether = colour::TETHER;
    sheet.line(&lay.line, r##"stroke="#fff" stroke-width="1.1""##);
    sheet.line(&lay.line, &format!(r#"stroke="{tether}" stroke-width=".5" {dash}"#));
    let at = sheet.at(*end);
    sheet.draw(format_args!(
        r##"<circle cx="{x:.2}" cy="{y:.2}" r="1.75" fill="#fff" stroke="{tether}" stroke-width=".35"/><text x="{x:.2}" y="{y:.2}" dy=".36em" text-anchor="middle" font-size="2.3" font-weight="700" fill="{tether}">{letter}</text>"##,
        x = at.x,
        y = at.y
    ));
}

/// A small bar that shows the share of a plate that is not guaranteed; `top` is the share at full width.
pub(super) fn plate_bar(shares: &account::Shares, top: f64) -> String {
    let not_guaranteed = (1.0 - shares.guaranteed.unwrap_or(0.0)).max(0.0);
    let others = shares.missed + shares.unreachable + shares.margin + shares.untestable;
    let thin = (not_guaranteed - others).max(0.0);
    let parts = [
        (shares.missed, colour::MISSED),
        (shares.unreachable, colour::OUT),
        (shares.margin, colour::MARGIN),
        (shares.untestable, colour::UNTESTABLE),
        (thin, colour::THIN),
    ];
    let (mut x, mut body) =
        (0.0_f64, format!(r#"<path d="M0 3.2H26" stroke="{}" stroke-width=".25"/>"#, colour::RULE));
    for (share, fill) in parts.into_iter().filter(|(share, _)| *share > 0.0) {
        let width = (26.0 * share / top).clamp(0.12, (26.0 - x).max(0.12));
        let _ = write!(body, r#"<rect x="{x:.2}" y=".4" width="{width:.2}" height="2.6" fill="{fill}"/>"#);
        x += width;
    }
    format!(
        r#"<svg class="pb" viewBox="0 0 26 3.4" preserveAspectRatio="none" aria-hidden="true">{body}</svg>"#
    )
}

/// The legend of the bars of plates.
pub(super) fn plate_legend(has_untestable: bool) -> Vec<Legend> {
    let entry = |(fill, text): (&str, &str)| legend(filled(fill), text, String::new());
    let classes = [
        (colour::MISSED, "missed"),
        (colour::OUT, "unreachable"),
        (colour::MARGIN, "shell margin"),
        (colour::THIN, "scanned, not guaranteed"),
    ];
    let untestable = has_untestable.then_some((colour::UNTESTABLE, NOT_TESTABLE));
    classes.into_iter().chain(untestable).map(entry).collect()
}

/// A picture made of text and lines only, without a tank.
pub(super) fn chart(width_mm: f64, height_mm: f64, body: &str, label: &str) -> String {
    let ink = colour::INK;
    element(
        width_mm,
        height_mm,
        &format!(r#"<g font-size="2.3" fill="{ink}">{body}</g>"#),
        &foreign::markup(label),
        "",
    )
}
