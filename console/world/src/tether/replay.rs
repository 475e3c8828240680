//! Replays a cable along a path and records its extremes.

use super::{
    cable::{Cable, TetherError},
    cable_obstacles::Bearing,
    case::Case,
    geodesic::Geodesic,
    ground::Ground,
    pull::{Pull, Pulling},
};
use geometry::Point;
use std::sync::Arc;

/// The cable after a path, and its extremes on the path.
pub(super) struct Replay {
    cable: Cable,
    lengths: Vec<(Point, f64)>,
    /// Longest cable, metres, and where the robot was.
    pub max_cable: (f64, Point),
    /// Largest wrap, radians, and the object that was wrapped.
    pub max_wrap: (f64, Option<Bearing>),
    /// Largest total wrap, radians, and where the robot was.
    pub max_sum: (f64, Point),
    pulling: Option<Pulling>,
}

impl Replay {
    pub(super) fn new(case: &Case<'_>, ground: &Ground) -> Result<Self, TetherError> {
        let cable = match case.cable {
            Some(cable) => cable.clone(),
            None => Cable::on(case.anchor, Arc::clone(&ground.obstacles))?,
        };
        let mut replay = Self {
            cable,
            lengths: Vec::with_capacity(case.path.len()),
            max_cable: (0.0, case.anchor),
            max_wrap: (0.0, None),
            max_sum: (0.0, case.anchor),
            pulling: case.pull.map(|limits| Pulling::new(&limits, case.anchor)),
        };
        case.path.iter().for_each(|point| replay.drag_to(*point));
        Ok(replay)
    }

    fn drag_to(&mut self, point: Point) {
        self.cable.drag_to(point);
        let length_m = self.cable.length_m();
        self.lengths.push((point, length_m));
        if length_m > self.max_cable.0 {
            self.max_cable = (length_m, point);
        }
        let wrap_rad = self.cable.wrap_max_rad();
        if wrap_rad > self.max_wrap.0 {
            let contacts = self.cable.contacts();
            let largest = contacts.iter().max_by(|a, b| a.wrap_rad.abs().total_cmp(&b.wrap_rad.abs()));
            self.max_wrap = (wrap_rad, largest.map(|contact| contact.on));
        }
        let sum_rad = self.cable.wrap_total_rad();
        if sum_rad > self.max_sum.0 {
            self.max_sum = (sum_rad, point);
        }
        if let Some(pulling) = &mut self.pulling {
            pulling.look_at(&self.cable, point);
        }
    }

    /// Returns the largest distance from the anchor to any point of the path, measured along the shortest path, metres.
    ///
    /// The result lies between the largest straight distance and the longest cable, so a search is needed only if these
    /// differ.
    pub(super) fn eccentricity_m(&self, ground: &Ground) -> f64 {
        let from_anchor_m = |(point, _): &(Point, f64)| (point - ground.anchor).norm();
        let straight_m = self.lengths.iter().map(from_anchor_m).fold(0.0, f64::max);
        if self.max_cable.0 <= straight_m + 1e-3 {
            return straight_m;
        }
        Geodesic::farthest_m(ground.anchor, Arc::clone(&ground.obstacles), &self.lengths)
    }

    /// Returns the pull that the path needs; `None` if it is not checked.
    pub(super) fn pull(&self) -> Option<Pull> {
        self.pulling.map(Pulling::most)
    }

    /// Returns the cable after a straight return to the anchor.
    pub(super) fn cable_on_return(&self, anchor: Point) -> Cable {
        let mut cable = self.cable.clone();
        cable.drag_to(anchor);
        cable
    }
}
