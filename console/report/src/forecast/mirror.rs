//! Floor that stations on a line leave with a mirror image, and what decides between the two.

use mission::MissionConfig;
use positioning::{Accuracy, AccuracyMap};
use serde::Serialize;
use world::{Point, Station, Vector, World};

/// Standard deviations by which the start has to be nearer to one place than to the other.
const DECIDES_SIGMAS: f64 = 3.72;
/// The 95 % error of a plane normal distribution in its standard deviations.
const SIGMAS_95: f64 = 2.448;
/// Less floor than this share with a mirror image is not worth a word.
const WORTH_A_WORD: f64 = 0.005;
/// Names of stations that people are shown.
const MOST_NAMES: usize = 6;

/// Which floor has a mirror image that the ranges do not tell from it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Mirrored {
    /// Share of the floor.
    pub share: f64,
    /// Share of the floor whose image lies behind the wall, so that the wall decides.
    pub by_walls_share: f64,
    /// Distance of the start from the line on which the stations nearly are, metres.
    pub start_to_line_m: f64,
    /// Whether the start decides on which side the robot begins.
    pub start_decides: bool,
    #[serde(skip)]
    line: String,
}

impl Mirrored {
    /// What a map says; `None` if no floor worth a word has an image.
    pub(super) fn of(mission: &MissionConfig, drawing: &World, map: &AccuracyMap) -> Option<Self> {
        let floor = map.floor().count().max(1) as f64;
        let (through, across) = line(&drawing.stations)?;
        // Two stations have no fix of their own, but always an image.
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
            // The ranges themselves decide.
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

    /// For people: what there is, and what decides.
    pub(super) fn sentences(&self) -> [String; 2] {
        let (percent, by_walls) = (self.share * 100.0, self.by_walls_share * 100.0);
        let open = percent - by_walls;
        let walls = if by_walls > 0.0 {
            format!("; for {by_walls:.1} % the wall decides, because the image lies behind it")
        } else {
            String::new()
        };
        let first = format!(
            "{percent:.1} % of the floor has a mirror image on the other side of {}, which the ranges do not tell from it{walls}",
            self.line
        );
        let start_m = self.start_to_line_m;
        let second = if open < WORTH_A_WORD * 100.0 {
            "there the side is always known".to_owned()
        } else if self.start_decides {
            format!(
                "for {open:.1} % robot.start_m decides, {start_m:.2} m from that line, and the track keeps the side while its error is \
                 smaller than its distance from the line; after an outage or with a wrong start it cannot be decided: add a station \
                 off the line"
            )
        } else {
            format!(
                "for {open:.1} % it cannot be decided: robot.start_m lies {start_m:.2} m from that line, no further than its own error; \
                 add a station off the line, or start further from it"
            )
        };
        [first, second]
    }
}

/// The line that stations are nearest to: a point of it, and the direction across.
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

/// The line of some stations, by their names.
pub fn line_of_stations(stations: &[Station]) -> String {
    let names: Vec<&str> = stations.iter().map(|station| station.name.as_str()).collect();
    match names.as_slice() {
        [rest @ .., last] if !rest.is_empty() && names.len() <= MOST_NAMES => {
            format!("the line of stations {} and {last}", rest.join(", "))
        }
        _ => "the line of the stations".into(),
    }
}
