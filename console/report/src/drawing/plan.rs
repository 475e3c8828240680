//! A picture of a plan: tank; obstacles with the clearance of the robot's centre; preset and planned path; lanes
//! coloured by purpose; the cuts, which a tethered robot never crosses; and the cable at its greatest length.

use super::{
    frame::Fixtures,
    sheet::{Sheet, colour},
};
use crate::leg::Leg;
use world::{Point, Shape, World};

/// Width of the picture, millimetres.
const WIDTH_MM: f64 = 180.0;

/// The contents of the picture.
#[derive(Debug, Clone, Copy)]
pub struct Drawn<'a> {
    /// Tank, obstacles and stations.
    pub world: &'a World,
    /// Distance that the centre of the hull keeps from solid objects, metres.
    pub room_m: f64,
    /// Width of the floor scanned in one pass, metres.
    pub swath_m: f64,
    /// The preset path, if the task is to follow one.
    pub preset: Option<&'a [Point]>,
    /// The anchor of the tether, if there is a tether.
    pub anchor: Option<Point>,
    /// The planned path.
    pub path: &'a [Point],
    /// The purposes of its stretches.
    pub legs: &'a [Leg],
    /// Lines that the robot never crosses.
    pub cuts: &'a [Vec<Point>],
    /// The cable at its greatest length.
    pub cable: &'a [Point],
}

/// The tags of plan stretches, with colour and legend text.
const STRETCHES: [(&str, &str, &str); 5] = [
    ("swath", colour::TRACK, "lane"),
    ("path", colour::TRACK, "path"),
    ("connector", "#C77700", "connector"),
    ("retract", colour::TETHER, "retract"),
    ("travel", "#2A9D4A", "travel"),
];

/// The picture as an SVG document; north is up.
pub fn svg(drawn: &Drawn<'_>) -> String {
    let Drawn { world, path, legs, swath_m, .. } = drawn;
    let mut sheet = Sheet::new(&world.boundary, "p", WIDTH_MM, 8.0);
    sheet.wall(&world.boundary, r##"fill="#fff""##);
    // The tool also scans between two lanes.
    let band_mm = swath_m * sheet.scale;
    for leg in legs.iter().filter(|leg| leg.tag != "path") {
        let style = format!(
            r#"class="band" stroke="{}" stroke-width="{band_mm:.2}" stroke-linejoin="round""#,
            colour::ONCE
        );
        sheet.line(&path[leg.first..=leg.last], &style);
    }
    if let Some(path) = drawn.preset {
        sheet.line(path, &format!(r#"class="preset" stroke="{}" stroke-width=".25""#, colour::OUT));
    }
    for leg in *legs {
        let stroke = STRETCHES
            .iter()
            .find(|(tag, ..)| *tag == leg.tag)
            .map_or(colour::TRACK, |(_, stroke, _)| *stroke);
        let style =
            format!(r#"class="{}" stroke="{stroke}" stroke-width=".25" stroke-linejoin="round""#, leg.tag);
        sheet.line(&path[leg.first..=leg.last], &style);
    }
    let margin = format!(
        r#"class="margin" fill="none" stroke="{}" stroke-width=".2" stroke-dasharray=".8 .6""#,
        colour::MISSED
    );
    for obstacle in &world.obstacles {
        if let Shape::Disc { center, radius_m } = &obstacle.shape {
            sheet.circle(*center, (radius_m + drawn.room_m) * sheet.scale, &margin);
        }
    }
    let fixtures = Fixtures::of(world, drawn.anchor);
    sheet.obstacles(&fixtures);
    for cut in drawn.cuts {
        let style = format!(
            r#"class="cut" stroke="{}" stroke-width=".35" stroke-dasharray="1.4 .8""#,
            colour::MISSED
        );
        sheet.line(cut, &style);
    }
    if drawn.cable.len() > 1 {
        let style =
            format!(r#"class="cable" stroke="{}" stroke-width=".5" stroke-linecap="round""#, colour::INK);
        sheet.line(drawn.cable, &style);
    }
    sheet.frame(&fixtures, 2.4);
    sheet.key(&key(drawn));
    sheet.into_document("Plan")
}

/// The legend of the colours that occur in the picture.
fn key(drawn: &Drawn<'_>) -> Vec<(&'static str, &'static str)> {
    let is_there = |tag: &str| drawn.legs.iter().any(|leg| leg.tag == tag);
    let stretches =
        STRETCHES.iter().filter(|(tag, ..)| is_there(tag)).map(|(_, stroke, word)| (*stroke, *word));
    let others = [
        (drawn.preset.is_some(), colour::OUT, "preset path"),
        (!drawn.cuts.is_empty(), colour::MISSED, "line not to be crossed"),
        (drawn.cable.len() > 1, colour::INK, "tether at its greatest length"),
        (!drawn.world.obstacles.is_empty(), colour::SOLID, "obstacle"),
    ];
    stretches
        .chain(others.into_iter().filter(|(there, ..)| *there).map(|(_, stroke, word)| (stroke, word)))
        .collect()
}
