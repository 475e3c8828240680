//! Floor that has a mirror image because the stations are on a line, and the criterion that decides between the two
//! positions.

use mission::MissionConfig;
use positioning::{Accuracy, AccuracyMap};
use serde::Serialize;
use world::{Point, Station, Vector, World};

/// Number of standard deviations by which the start must be closer to one position than to the other.
const DECIDES_SIGMAS: f64 = 3.72;
/// The 95 % error of a two-dimensional normal distribution, in standard deviations.
const SIGMAS_95: f64 = 2.448;
/// Share of the floor that must have a mirror image before a report mentions it.
const WORTH_A_WORD: f64 = 0.005;
/// Maximum number of station names in a message.
const MOST_NAMES: usize = 6;

/// The floor that the ranges cannot distinguish from its mirror image.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Mirrored {
    /// Share of the floor.
    pub share: f64,
    /// Share of the floor whose image is behind the wall, so that the wall decides.
    pub by_walls_share: f64,
    /// Distance of the start from the line that the stations are nearly on, metres.
    pub start_to_line_m: f64,
    /// Whether the start decides on which side of the line the robot is.
    pub start_decides: bool,
    #[serde(skip)]
    line: String,
}

impl Mirrored {
    /// Evaluates a map; `None` if too little floor has an image.
    pub(super) fn of(mission: &MissionConfig, drawing: &World, map: &AccuracyMap) -> Option<Self> {
        let floor = map.floor().count().max(1) as f64;
        let (through, across) = line(&drawing.stations)?;
        // Two stations give no fix on their own, but always an image.
        let is_pair = drawing.stations.len() == 2;
        let image = |at: Point, cell: Accuracy| {
            let reflected = at - across * (2.0 * across.dot(&(at - through)));
            cell.mirror.or(is_pair.then_some(reflected))
        };
        let images = || map.floor().filter_map(|(at, cell)| Some((cell, image(at, cell)?)));
        let behind = |(cell, image): &(Accuracy, Point)| {
            -drawing.boundary.wall_distance_m(*image) > cell.error_95_m.unwrap_or_default()
        };
        let (all, behind) = (images().count() as f64, images().filter(behind).count() as f64);
        let start = mission.start;
        let start_to_line_m = across.dot(&(start.position - through)).abs();
        let cell = map.at(start.position);
        let fix_sigma_m = cell.and_then(|cell| cell.error_95_m).unwrap_or_default() / SIGMAS_95;
        let apart_m = match cell.map(|cell| image(start.position, cell)) {
            Some(Some(image)) => (image - start.position).norm(),
            // The ranges alone decide.
            Some(None) if start_to_line_m > 0.0 => f64::INFINITY,
            _ => 2.0 * start_to_line_m,
        };
        let is_worth_it = all / floor > WORTH_A_WORD;
        is_worth_it.then(|| Self {
            share: all / floor,
            by_walls_share: behind / floor,
            start_to_line_m,
            start_decides: apart_m > DECIDES_SIGMAS * mission.start_sigma_m.hypot(fix_sigma_m),
            line: line_of_stations(&drawing.stations),
        })
    }

    /// The floor with an image, and the criterion that decides, as text.
    pub(super) fn sentences(&self) -> [String; 2] {
        let (percent, by_walls) = (self.share * 100.0, self.by_walls_share * 100.0);
        let open = percent - by_walls;
        let walls = if by_walls > 0.0 {
            format!("; for {by_walls:.1} % the image can be ruled out because it is behind the wall")
        } else {
            String::new()
        };
        let first = format!(
            "{percent:.1} % of the floor has a mirror image on the other side of {}, and the ranges cannot \
             tell the two apart{walls}",
            self.line
        );
        let start_m = self.start_to_line_m;
        let second = if open < WORTH_A_WORD * 100.0 {
            "the side is always known there".to_owned()
        } else if self.start_decides {
            format!(
                "for {open:.1} % the side follows from robot.start_m, {start_m:.2} m from that line, as \
                 long as the position error is smaller than the robot's distance from the line; after an \
                 outage or with a wrong start the side is ambiguous: add a station off the line"
            )
        } else {
            format!(
                "for {open:.1} % the side is ambiguous: robot.start_m is {start_m:.2} m from that line, \
                 which is within the error of the start; add a station off the line, or start further from \
                 it"
            )
        };
        [first, second]
    }
}

/// The line nearest to the stations: a point on it, and the direction across it.
fn line(stations: &[Station]) -> Option<(Point, Vector)> {
    let n = stations.len() as f64;
    (n > 0.0).then(|| {
        let middle = Point::from(stations.iter().map(|s| s.position.coords).sum::<Vector>() / n);
        let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
        for away in stations.iter().map(|s| s.position - middle) {
            (xx, xy, yy) = (xx + away.x * away.x, xy + away.x * away.y, yy + away.y * away.y);
        }
        let angle = 0.5 * (2.0 * xy).atan2(xx - yy);
        (middle, Vector::new(-angle.sin(), angle.cos()))
    })
}

/// A text that names the line through some stations.
pub fn line_of_stations(stations: &[Station]) -> String {
    let names: Vec<&str> = stations.iter().map(|station| station.name.as_str()).collect();
    match names.as_slice() {
        [rest @ .., last] if !rest.is_empty() && names.len() <= MOST_NAMES => {
            format!("the line of stations {} and {last}", rest.join(", "))
        }
        _ => "the line of the stations".into(),
    }
}
