//! The part of the map that matters to the next steps: as many parts as a step has time for, whatever the size of the
//! map.
//!
//! A map of a building has thousands of parts. The parts of the drawing near the robot are looked up again after a
//! metre, and sensed obstacles stay where they are sensed. A step therefore costs as much as on a floor of a few
//! hundred parts.

use geometry::polyline::{edges, nearest_on_segment};
use planner_api::Site;
use std::collections::HashSet;
use steering::{Body, KnownMap, Solid};
use world::{Boundary, Point, Shape, shortest::GrownFloor};

/// Maximum number of parts of the drawing that are kept, unless more are within reach of the window.
const PARTS_MOST: usize = 100;
/// Distance after which the nearby parts are looked up again, metres.
const SLACK_M: f64 = 1.0;
/// Radius of a round wall so far away that it has no effect, metres.
const FAR_M: f64 = 1e6;

/// The map around a robot.
#[derive(Debug, Clone)]
pub struct Surroundings {
    /// The map as drawn, or as on the console's chart when it requested a plan.
    charted: KnownMap,
    charted_ids: HashSet<u32>,
    /// The obstacles sensed now, and stationary obstacles found earlier that are not on the drawing.
    sensed: Vec<Sensed>,
    here: KnownMap,
    cut: Option<Cut>,
}

#[derive(Debug, Clone)]
struct Sensed {
    body: Body,
    moves: bool,
}

/// The part of the drawing near the robot.
#[derive(Debug, Clone)]
struct Cut {
    from: Point,
    reach_m: f64,
    indices: Vec<usize>,
}

/// Changes found by [`Surroundings::look`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Changed {
    /// Whether parts of the map were added, removed or moved.
    pub parts: bool,
    /// Whether a path that was free may now be blocked.
    pub ways: bool,
}

impl Surroundings {
    /// Creates the surroundings of a robot on a map; call [`Surroundings::look`] before use.
    pub fn new(charted: KnownMap) -> Self {
        let here = KnownMap { solids: Vec::new(), ..charted.clone() };
        let charted_ids = charted.solids.iter().map(|solid| solid.id).collect();
        Self { charted, charted_ids, sensed: Vec::new(), here, cut: None }
    }

    /// Whether a map is small enough to be kept whole.
    pub fn is_small(map: &KnownMap) -> bool {
        map.solids.len() <= PARTS_MOST
    }

    /// Creates the surroundings of a robot at a site. Moving obstacles count only while they are sensed.
    pub fn of_site(site: &Site<'_>) -> Self {
        Self::new(KnownMap::standing(site))
    }

    /// Creates surroundings that contain a whole map, for a search without a time limit per step.
    pub fn whole(charted: KnownMap) -> Self {
        let mut whole = Self::new(charted);
        let indices = (0..whole.charted.solids.len()).collect();
        whole.cut = Some(Cut { from: Point::origin(), reach_m: f64::INFINITY, indices });
        whole.fill_here();
        whole
    }

    /// The map near the robot.
    pub fn map(&self) -> &KnownMap {
        &self.here
    }

    /// The whole drawing.
    pub fn charted(&self) -> &KnownMap {
        &self.charted
    }

    /// Whether the map near the robot is the whole map.
    pub fn is_everything(&self) -> bool {
        self.cut.as_ref().is_some_and(|cut| cut.reach_m.is_infinite())
    }

    /// Updates the surroundings for a position, at least as far as the window reaches. An obstacle that moves, or is on
    /// the drawing, is forgotten once it is no longer sensed. One that seemed stationary is forgotten as soon as it is
    /// known to move.
    pub fn look(&mut self, at: Point, least_m: f64, sensed: &[Body], moves: impl Fn(u32) -> bool) -> Changed {
        let ways = sensed.iter().any(|body| self.is_news(body));
        let is_cut = self.update_cut(at, least_m);
        let passes =
            |known: &Sensed| known.moves || moves(known.body.id) || self.charted_ids.contains(&known.body.id);
        if !is_cut && sensed.is_empty() && !self.sensed.iter().any(passes) {
            return Changed { parts: false, ways };
        }
        let kept = |known: &Sensed| !passes(known) && sensed.iter().all(|body| body.id != known.body.id);
        let mut all: Vec<Sensed> = self.sensed.iter().filter(|known| kept(known)).cloned().collect();
        all.extend(sensed.iter().map(|body| Sensed { moves: moves(body.id), body: body.clone() }));
        self.sensed = all;
        self.fill_here();
        Changed { parts: true, ways }
    }

    /// The nearby floor for a robot whose centre keeps this distance from solids, metres.
    pub fn floor(&self, keep_m: f64) -> GrownFloor {
        let mut shapes: Vec<Shape> = self.here.solids.iter().map(|solid| solid.part.to_shape()).collect();
        let (Some(cut), Boundary::Polygon { vertices }) = (&self.cut, &self.here.wall) else {
            return grown(&self.here.wall, &shapes, keep_m);
        };
        if cut.reach_m.is_infinite() {
            return grown(&self.here.wall, &shapes, keep_m);
        }
        let is_near =
            |a: Point, b: Point| (nearest_on_segment(a, b, cut.from) - cut.from).norm() < cut.reach_m;
        let piece = |(a, b): (Point, Point)| Shape::Polyline { points: vec![a, b], half_width_m: 0.0 };
        shapes.extend(edges(vertices).filter(|(a, b)| is_near(*a, *b)).map(piece));
        grown(&Boundary::Circle { radius_m: FAR_M }, &shapes, keep_m)
    }

    fn is_news(&self, body: &Body) -> bool {
        !self.charted_ids.contains(&body.id) && self.sensed.iter().all(|known| known.body.id != body.id)
    }

    /// Looks up the nearby parts of the drawing again if necessary. Returns whether it did.
    fn update_cut(&mut self, at: Point, least_m: f64) -> bool {
        let still_holds =
            |cut: &Cut| cut.reach_m.is_infinite() || (cut.from - at).norm_squared() < SLACK_M * SLACK_M;
        if self.cut.as_ref().is_some_and(still_holds) {
            return false;
        }
        let reach_m = self.affordable_m(at).max(least_m + SLACK_M);
        let is_near = |index: &usize| !self.charted.solids[*index].is_beyond(at, reach_m);
        let indices = (0..self.charted.solids.len()).filter(is_near).collect();
        self.cut = Some(Cut { from: at, reach_m, indices });
        true
    }

    /// The distance within which there are as many parts as a step has time for, metres; infinite for a small map.
    fn affordable_m(&self, at: Point) -> f64 {
        if Self::is_small(&self.charted) {
            return f64::INFINITY;
        }
        let distance_m = |solid: &Solid| (solid.center - at).norm() - solid.radius_m;
        let mut all: Vec<f64> = self.charted.solids.iter().map(distance_m).collect();
        *all.select_nth_unstable_by(PARTS_MOST, f64::total_cmp).1
    }

    fn fill_here(&mut self) {
        let cut = self.cut.as_ref().expect("the update created it");
        let is_sensed = |id: u32| self.sensed.iter().any(|known| known.body.id == id);
        let drawn = cut.indices.iter().map(|index| &self.charted.solids[*index]);
        self.here.solids.clear();
        self.here.solids.extend(drawn.filter(|solid| !is_sensed(solid.id)).cloned());
        let is_near = |solid: &Solid| !solid.is_beyond(cut.from, cut.reach_m);
        let parts =
            self.sensed.iter().flat_map(|known| known.body.parts.iter().map(|part| (known.body.id, part)));
        self.here.solids.extend(parts.map(|(id, part)| Solid::new(id, part.clone())).filter(is_near));
    }
}

fn grown(wall: &Boundary, shapes: &[Shape], keep_m: f64) -> GrownFloor {
    GrownFloor::new(wall, keep_m, shapes.iter().map(|shape| (shape, keep_m)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::convex::Part;
    use world::Vector;

    /// A floor of columns a metre apart in a square tank.
    fn columns(per_side: u32) -> KnownMap {
        let side_m = f64::from(per_side);
        let column = |k: u32| {
            let center = Point::new(f64::from(k % per_side) + 0.5, f64::from(k / per_side) + 0.5);
            Solid::disc(k, center, 0.1)
        };
        let corners = [(0.0, 0.0), (side_m, 0.0), (side_m, side_m), (0.0, side_m)];
        KnownMap {
            solids: (0..per_side * per_side).map(column).collect(),
            wall: Boundary::Polygon { vertices: corners.map(|(x, y)| Point::new(x, y)).to_vec() },
            hull_m: 0.2,
        }
    }

    fn body(id: u32, x: f64, y: f64) -> Body {
        Body { id, parts: vec![Part::disc(Point::new(x, y), 0.3)] }
    }

    #[test]
    fn a_step_looks_at_as_many_parts_however_large_the_map() {
        for per_side in [20, 60] {
            let map = columns(per_side);
            let at = Point::new(10.0, 10.0);
            let mut around = Surroundings::new(map.clone());
            around.look(at, 2.0, &[], |_| false);
            assert!(!around.is_everything());
            assert!((PARTS_MOST..PARTS_MOST + 20).contains(&around.map().solids.len()));
            let seen = around.map().clearance_m(at);
            assert!((seen - map.clearance_m(at)).abs() < 1e-12);
        }
        let mut small = Surroundings::new(columns(9));
        small.look(Point::new(1.0, 1.0), 2.0, &[], |_| false);
        assert!(small.is_everything() && small.map().solids.len() == 81);
    }

    #[test]
    fn the_window_sees_all_that_it_reaches_until_the_next_look() {
        let map = columns(40);
        let mut around = Surroundings::new(map.clone());
        for k in 0..200 {
            let at = Point::new(20.0, 20.0) + Vector::new(0.1, 0.05) * f64::from(k) * 0.5;
            around.look(at, 8.0, &[], |_| false);
            let n_near = |map: &KnownMap| map.solids.iter().filter(|s| !s.is_beyond(at, 8.0)).count();
            assert_eq!(n_near(around.map()), n_near(&map));
        }
    }

    #[test]
    fn what_is_sensed_stands_where_it_is_sensed_and_what_moves_is_forgotten_out_of_sight() {
        let mut around = Surroundings::new(columns(9));
        let at = Point::new(4.0, 4.0);
        let (known, found, mover) = (body(0, 0.7, 0.5), body(500, 3.0, 4.0), body(501, 5.0, 4.0));
        let is_mover = |id: u32| id == 501;
        let changed = around.look(at, 2.0, &[known, found, mover], is_mover);
        assert!(changed.parts && changed.ways);
        assert_eq!(around.map().solids.len(), 83);
        around.look(at, 2.0, &[], is_mover);
        let ids: Vec<u32> = around.map().solids.iter().map(|s| s.id).filter(|id| *id > 400).collect();
        assert_eq!(ids, [500]);
        let drawn = around.map().solids.iter().find(|s| s.id == 0).map(|s| s.center);
        assert_eq!(drawn, Some(Point::new(0.5, 0.5)), "out of sight it stands where it is drawn");
        assert!(!around.look(at, 2.0, &[body(500, 3.0, 4.0)], is_mover).ways);
    }

    #[test]
    fn a_way_on_a_part_of_the_map_keeps_off_the_wall() {
        let mut around = Surroundings::new(columns(40));
        around.look(Point::new(1.0, 20.0), 2.0, &[], |_| false);
        let floor = around.floor(0.3);
        assert!(!floor.is_free(Point::new(1.0, 20.0), Point::new(-1.0, 20.0)));
        assert!(floor.is_free(Point::new(1.0, 18.0), Point::new(1.0, 21.0)));
    }
}
