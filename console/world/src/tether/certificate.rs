//! What a whole path does to the cable: the certificate, computed on the final polyline and on nothing else.

use super::{
    cable::{Bearing, Cable, TetherError},
    cuts,
    geodesic::Geodesic,
    ground::{Ground, solids_of},
    pocket,
    solid::Solid,
};
use crate::{
    Boundary,
    geometry::Point,
    obstacles::{Boxes, wall_clearance_m},
    tank::Obstacle,
};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Room that a path may lack before that is a collision, metres: chords of arcs.
const SPARE_M: f64 = 0.005;
/// Distance from the anchor at which a path has come back, metres.
const BACK_M: f64 = 0.3;

/// Steps in which a piece of a path is searched for its narrowest place.
const NARROW_STEPS: u32 = 200;

/// What a cable may do.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Limits {
    /// Cable on the reel, metres.
    pub reel_length_m: f64,
    /// Largest wrap on one obstacle, radians.
    pub wrap_max_rad: f64,
    /// Largest sum of all wraps, radians.
    pub wrap_total_max_rad: f64,
}

/// A path to be certified.
#[derive(Debug, Clone, Copy)]
pub struct Case<'a> {
    /// The whole path, tank frame.
    pub path: &'a [Point],
    /// Where the cable comes out.
    pub anchor: Point,
    /// The cable as it lies at the path's beginning; without one it runs straight to the first point.
    pub cable: Option<&'a Cable>,
    /// The wall.
    pub boundary: &'a Boundary,
    /// Obstacles, known and found.
    pub obstacles: &'a [Obstacle],
    /// Room that the middle of the hull needs, metres: hull radius plus clearance.
    pub room_m: f64,
    /// What the cable may do.
    pub limits: Limits,
    /// Whether the path is to end at the anchor with the cable reeled in.
    pub returns: bool,
    /// Lines that the path must not cross.
    pub cuts: &'a [Vec<Point>],
}

/// The result of certifying a path.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Certificate {
    /// Whether the path may be flown with a tether.
    pub certified: bool,
    /// Why not, in words; empty when certified.
    pub reasons: Vec<String>,
    /// Longest cable on the way, metres.
    pub tether_length_max_m: f64,
    /// Largest shortest distance from the anchor to a point of the path, metres: the least reel that would do.
    pub eccentricity_m: f64,
    /// Largest wrap on one obstacle at any time, radians.
    pub wrap_max_rad: f64,
    /// Largest sum of wraps at any time, radians.
    pub wrap_total_max_rad: f64,
    /// Cable left out after the return to the anchor, metres; absent for a path that need not return.
    pub end_length_m: Option<f64>,
    /// Crossings that were not undone on return; 0 means that the cable comes in.
    pub crossings_left: usize,
    /// Pieces of the path that are nearer to something solid than the hull allows.
    pub collisions: usize,
    /// Least distance from the path to anything solid, metres; as far as it is below the room needed.
    pub clearance_min_m: f64,
    /// Crossings of cuts.
    pub cut_crossings: usize,
    /// Floor sealed off by cuts, square metres.
    pub sealed_m2: f64,
}

impl Certificate {
    /// The certificate of a path that could not be evaluated at all.
    pub fn refused(reason: String) -> Self {
        Self {
            certified: false,
            reasons: vec![reason],
            tether_length_max_m: 0.0,
            eccentricity_m: 0.0,
            wrap_max_rad: 0.0,
            wrap_total_max_rad: 0.0,
            end_length_m: None,
            crossings_left: 0,
            collisions: 0,
            clearance_min_m: 0.0,
            cut_crossings: 0,
            sealed_m2: 0.0,
        }
    }
}

/// Certifies a path: replays the cable and checks for collisions, crossings of cuts and sealed floor.
///
/// Knows no planner. Without cuts the last two are empty.
///
/// # Errors
/// The anchor lies inside an obstacle or nowhere.
pub fn certify(case: &Case<'_>) -> Result<Certificate, TetherError> {
    let shapes: Vec<_> = case.obstacles.iter().map(|o| o.shape.clone()).collect();
    let ground = Arc::new(Ground::new(case.boundary, &shapes));
    let mut replay = Replay::new(case, &ground)?;
    case.path.iter().for_each(|point| replay.take(*point));
    let clearance = clearance(case);
    let pocket = if case.cuts.is_empty() { None } else { pocket::sealed(case) };
    let left = replay.cable_on_return(case.anchor);
    let mut certificate = Certificate {
        certified: false,
        reasons: Vec::new(),
        tether_length_max_m: replay.max_cable.0,
        eccentricity_m: replay.eccentricity_m(case.anchor, ground),
        wrap_max_rad: replay.max_wrap.0,
        wrap_total_max_rad: replay.max_sum.0,
        end_length_m: case.returns.then(|| left.length_m()),
        crossings_left: if case.returns { left.word().letters().len() } else { 0 },
        collisions: clearance.collisions,
        clearance_min_m: clearance.least_m,
        cut_crossings: cuts::crossings(case.path, case.cuts),
        sealed_m2: pocket.map_or(0.0, |p| p.area_m2),
    };
    let reasons = Reasons { case, replay: &replay, left: &left, clearance: &clearance, pocket };
    certificate.reasons = reasons.of(&certificate);
    certificate.certified = certificate.reasons.is_empty();
    Ok(certificate)
}

/// The cable along the path, with what was worst and where.
struct Replay {
    cable: Cable,
    lengths: Vec<(Point, f64)>,
    max_cable: (f64, Point),
    max_wrap: (f64, Option<Bearing>),
    max_sum: (f64, Point),
}

impl Replay {
    fn new(case: &Case<'_>, ground: &Arc<Ground>) -> Result<Self, TetherError> {
        let cable = match case.cable {
            Some(cable) => cable.clone(),
            None => Cable::on(case.anchor, Arc::clone(ground))?,
        };
        let (anchor, none) = (case.anchor, (0.0, None));
        Ok(Self {
            cable,
            lengths: Vec::with_capacity(case.path.len()),
            max_cable: (0.0, anchor),
            max_wrap: none,
            max_sum: (0.0, anchor),
        })
    }

    fn take(&mut self, point: Point) {
        self.cable.drag_to(point);
        let length_m = self.cable.length_m();
        self.lengths.push((point, length_m));
        if length_m > self.max_cable.0 {
            self.max_cable = (length_m, point);
        }
        let wrap_rad = self.cable.wrap_max_rad();
        if wrap_rad > self.max_wrap.0 {
            let contacts = self.cable.contacts();
            let on =
                contacts.iter().max_by(|a, b| a.wrap_rad.abs().total_cmp(&b.wrap_rad.abs())).map(|c| c.on);
            self.max_wrap = (wrap_rad, on);
        }
        let sum_rad = self.cable.wrap_total_rad();
        if sum_rad > self.max_sum.0 {
            self.max_sum = (sum_rad, point);
        }
    }

    /// Between the largest straight distance and the longest cable; searched for only if these differ.
    fn eccentricity_m(&self, anchor: Point, ground: Arc<Ground>) -> f64 {
        let straight_m = self.lengths.iter().map(|(point, _)| (point - anchor).norm()).fold(0.0, f64::max);
        if self.max_cable.0 <= straight_m + 1e-3 {
            return straight_m;
        }
        Geodesic::new(anchor, ground).farthest_m(self.lengths.iter().copied())
    }

    fn cable_on_return(&self, anchor: Point) -> Cable {
        let mut cable = self.cable.clone();
        cable.drag_to(anchor);
        cable
    }
}

struct Clearance {
    collisions: usize,
    least_m: f64,
    /// Where the first piece without room is nearest to something, and to what.
    first: Option<(Point, String)>,
}

fn clearance(case: &Case<'_>) -> Clearance {
    let solids: Vec<(usize, Solid)> = case
        .obstacles
        .iter()
        .enumerate()
        .flat_map(|(k, o)| solids_of(&o.shape, 0.0).into_iter().map(move |solid| (k, solid)))
        .collect();
    let boxes = Boxes::new(solids.iter().map(|(_, solid)| solid.bounds()));
    let mut found = Clearance { collisions: 0, least_m: case.room_m, first: None };
    for pair in pieces(case.path) {
        let near = boxes.near(pair.0, pair.1, case.room_m).map(|index| &solids[index]);
        let nearest = near
            .map(|(k, solid)| (solid.distance_m(pair.0, pair.1), Some(*k)))
            .min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let wall = (wall_clearance_m(case.boundary, pair.0, pair.1), None);
        let (least_m, by) = nearest.filter(|(distance_m, _)| *distance_m < wall.0).unwrap_or(wall);
        found.least_m = found.least_m.min(least_m);
        if least_m < case.room_m - SPARE_M {
            found.collisions += 1;
            let name = by.map_or_else(|| "the wall".to_owned(), |k| case.obstacles[k].name.clone());
            found.first.get_or_insert_with(|| (narrowest(case, &solids, pair, by), name));
        }
    }
    found
}

/// The place on a piece of the path that is nearest to an obstacle, or to the wall.
///
/// Pieces lead past long walls and through solids, so the least distance is looked for in even steps.
fn narrowest(case: &Case<'_>, solids: &[(usize, Solid)], (a, b): (Point, Point), by: Option<usize>) -> Point {
    let distance_m = |at: Point| match by {
        Some(k) => {
            let of_it = solids.iter().filter(|(index, _)| *index == k);
            of_it.map(|(_, solid)| solid.distance_m(at, at)).fold(f64::INFINITY, f64::min)
        }
        None => wall_clearance_m(case.boundary, at, at),
    };
    let places = (0..=NARROW_STEPS).map(|k| a + (b - a) * (f64::from(k) / f64::from(NARROW_STEPS)));
    places.min_by(|p, q| distance_m(*p).total_cmp(&distance_m(*q))).unwrap_or(a)
}

fn pieces(path: &[Point]) -> impl Iterator<Item = (Point, Point)> + '_ {
    let single = (path.len() == 1).then(|| (path[0], path[0]));
    path.windows(2).map(|pair| (pair[0], pair[1])).chain(single)
}

/// Puts what is wrong into words.
struct Reasons<'a> {
    case: &'a Case<'a>,
    replay: &'a Replay,
    left: &'a Cable,
    clearance: &'a Clearance,
    pocket: Option<pocket::Sealed>,
}

impl Reasons<'_> {
    fn of(&self, certificate: &Certificate) -> Vec<String> {
        let limits = &self.case.limits;
        let mut reasons: Vec<String> = Vec::new();
        if self.case.path.is_empty() {
            reasons.push("the plan has no path".into());
        }
        if self.case.path.iter().any(|p| !(p.x.is_finite() && p.y.is_finite())) {
            reasons.push("the path has a coordinate that is not a finite number".into());
        }
        if self.case.cuts.iter().flatten().any(|p| !(p.x.is_finite() && p.y.is_finite())) {
            reasons.push("a cut has a coordinate that is not a finite number".into());
        }
        if [self.case.room_m, limits.reel_length_m, limits.wrap_max_rad, limits.wrap_total_max_rad]
            .iter()
            .any(|m| m.is_nan())
        {
            reasons.push("the room that the hull needs, or a limit of the tether, is not a number".into());
        }
        reasons.extend(self.collision(certificate));
        if certificate.tether_length_max_m > limits.reel_length_m {
            let (most_m, at) = self.replay.max_cable;
            let place = place(at);
            reasons.push(format!(
                "{most_m:.1} m of cable are out at {place}, the reel holds {:.1} m",
                limits.reel_length_m
            ));
        }
        if certificate.wrap_max_rad > limits.wrap_max_rad {
            let (most, allowed) = (self.replay.max_wrap.0.to_degrees(), limits.wrap_max_rad.to_degrees());
            let on = self.name_of(self.replay.max_wrap.1);
            reasons.push(format!("the cable wraps {most:.0} deg round {on}, allowed are {allowed:.0} deg"));
        }
        if certificate.wrap_total_max_rad > limits.wrap_total_max_rad {
            let (most, at) = self.replay.max_sum;
            let (most, allowed) = (most.to_degrees(), limits.wrap_total_max_rad.to_degrees());
            reasons.push(format!(
                "all wraps together reach {most:.0} deg at {}, allowed are {allowed:.0} deg",
                place(at)
            ));
        }
        reasons.extend(self.left_out(certificate));
        if certificate.cut_crossings > 0 {
            reasons.push(format!("the path crosses cuts {} times", certificate.cut_crossings));
        }
        if let Some(pocket) = self.pocket {
            reasons.push(format!("cuts seal off {:.2} m2 of floor at {}", pocket.area_m2, place(pocket.at)));
        }
        reasons
    }

    fn collision(&self, certificate: &Certificate) -> Option<String> {
        let (at, name) = self.clearance.first.as_ref()?;
        let lack = match certificate.collisions {
            1 => "1 piece of the path lacks room,".to_owned(),
            n => format!("{n} pieces of the path lack room, the first"),
        };
        Some(format!(
            "{lack} at {} by {name}: least room {:.3} m, needed {:.3} m",
            place(*at),
            certificate.clearance_min_m,
            self.case.room_m
        ))
    }

    fn left_out(&self, certificate: &Certificate) -> Option<String> {
        let last = self.case.path.last().filter(|_| self.case.returns)?;
        let away_m = (last - self.case.anchor).norm();
        if away_m > BACK_M {
            return Some(format!("the path ends {away_m:.2} m away from the anchor"));
        }
        let end_length_m = certificate.end_length_m.unwrap_or(0.0);
        if self.left.word().is_empty() && end_length_m <= BACK_M {
            return None;
        }
        let mut round: Vec<String> = self.left.contacts().iter().map(|c| self.name_of(Some(c.on))).collect();
        round.dedup();
        let round = if round.len() > 3 {
            format!("{} obstacles, {} first", round.len(), round[0])
        } else {
            round.join(", ")
        };
        Some(format!("{end_length_m:.1} m of cable stay out on return, hooked round {round}"))
    }

    fn name_of(&self, on: Option<Bearing>) -> String {
        match on {
            Some(Bearing::Obstacle(k)) => {
                let obstacle = self.case.obstacles.get(k);
                obstacle.map_or_else(|| format!("obstacle {k}"), |o| o.name.clone())
            }
            Some(Bearing::Wall) | None => "a corner of the wall".into(),
        }
    }
}

fn place(at: Point) -> String {
    format!("{:.2}, {:.2} m", at.x, at.y)
}

#[cfg(test)]
mod tests;
