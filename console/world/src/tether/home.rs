//! The way home: back along the cable, with room for the hull.

use super::{cable::Cable, ground::Ground};
use crate::{geometry::Point, obstacles::ObstacleMap};
use std::sync::Arc;

/// Room that a way home may lack, metres: chords of arcs, and a robot that stands nearer than its hull allows.
const SPARE_M: f64 = 0.02;

impl Cable {
    /// The shortest way back to the anchor on which the cable is only reeled in, from the robot to the anchor.
    ///
    /// `roomy` is the same ground grown by the hull's radius, `map` the obstacles, `hull_m` the hull's radius. `None`
    /// if the hull does not fit along the cable: there is no way home that unwinds it.
    pub fn way_home(&self, roomy: &Arc<Ground>, map: &ObstacleMap, hull_m: f64) -> Option<Vec<Point>> {
        let mut hull = Self::on(roomy.sidestep.outside(self.anchor()), Arc::clone(roomy)).ok()?;
        hull.drag_along(&self.taut_line());
        let mut way = hull.taut_line();
        way[0] = self.anchor();
        way.push(self.tip());
        way.reverse();
        way.dedup_by(|a, b| (*a - *b).norm() < 1e-9);
        // The first and the last piece lead out of and into places that may be tight already.
        let tight_m = (map.clearance_m(self.tip()).min(map.clearance_m(self.anchor())) - SPARE_M).max(0.0);
        let need_m = (hull_m - SPARE_M).min(tight_m.max(0.5 * hull_m));
        let fits = way.windows(2).all(|pair| map.segment_clearance_m(pair[0], pair[1]) >= need_m);
        fits.then_some(way)
    }
}
