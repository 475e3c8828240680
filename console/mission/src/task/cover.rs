//! Scanning the floor along the legs of a plan, and returning to the anchor.

use super::{CornerPatience, rest_of};
use crate::ask::TaskLeft;
use geometry::PathFollower;
use planner_api::{self as api, LegTag, Plan};
use std::{collections::HashSet, sync::Arc};
use world::{CoverageGrid, ObstacleMap, Point, Shape, coverage::regions, polyline};

/// Size of the blocks of floor that planners receive, as a multiple of the lane width.
const BLOCK_LANES: f64 = 0.25;

/// Progress of a coverage mission. The scanned floor is recorded in the mission's grid, so any planner can continue from
/// the current state.
#[derive(Clone)]
pub(crate) struct Cover {
    anchor: Point,
    /// The areas to scan; empty for the whole floor.
    regions: Vec<Vec<Point>>,
    tolerance_m: f64,
    position: Point,
    lanes: Option<Lanes>,
    /// Distance driven along earlier plans, metres.
    before_m: f64,
    at_corner: CornerPatience,
}

/// A place on the plan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Joint {
    /// The place.
    pub at: Point,
    /// Distance along the plan to that place, metres.
    pub station_m: f64,
}

/// A plan in progress.
#[derive(Clone)]
struct Lanes {
    plan: Arc<Plan>,
    follower: PathFollower,
    /// Distances along the plan at which its stretches end, metres.
    ends_m: Vec<f64>,
}

impl Cover {
    /// A task without a plan yet.
    pub(crate) fn new(anchor: Point, regions: Vec<Vec<Point>>, tolerance_m: f64, start: Point) -> Self {
        Self {
            anchor,
            regions,
            tolerance_m,
            position: start,
            lanes: None,
            before_m: 0.0,
            at_corner: CornerPatience::default(),
        }
    }

    /// Takes a plan for the remaining floor.
    pub(crate) fn take_plan(&mut self, plan: &Plan) {
        self.before_m += self.lanes.as_ref().map_or(0.0, |lanes| lanes.follower.along_m());
        let stations_m = polyline::stations_m(&plan.path);
        let ends_m = plan.legs.iter().map(|leg| stations_m[leg.last]).collect();
        self.at_corner = CornerPatience::default();
        self.lanes = (!plan.path.is_empty()).then(|| Lanes {
            plan: Arc::new(plan.clone()),
            follower: PathFollower::exact(&plan.path),
            ends_m,
        });
    }

    /// Updates the robot's position.
    pub(crate) fn advance(&mut self, position: Point, map: &ObstacleMap) {
        self.position = position;
        if let Some(lanes) = &mut self.lanes {
            lanes.follower.advance(position, |at| map.clearance_m(at) >= 0.0);
        }
    }

    /// Counts time during which the robot was free to move; a corner that the robot cannot reach is given up.
    pub(crate) fn wait(&mut self, passed_s: f64) {
        if let Some(lanes) = &mut self.lanes {
            self.at_corner.wait(&mut lanes.follower, self.position, passed_s);
        }
    }

    /// The next target; the anchor if there is no plan.
    pub(crate) fn target(&self) -> Point {
        self.lanes.as_ref().map_or(self.anchor, |lanes| lanes.follower.target())
    }

    /// The plan from the target on.
    pub(crate) fn ahead(&self, length_m: f64) -> &[Point] {
        let home = || std::slice::from_ref(&self.anchor);
        self.lanes.as_ref().map_or_else(home, |lanes| lanes.follower.ahead(length_m))
    }

    /// Whether only a part of the floor is to be scanned.
    pub(crate) fn is_in_part(&self) -> bool {
        !self.regions.is_empty()
    }

    /// The rest of the plan, from the point nearest to the robot on.
    pub(crate) fn lanes_left(&self) -> Option<&[Point]> {
        self.lanes.as_ref().map(|lanes| lanes.follower.remaining())
    }

    /// The rest of the plan from the target on, without its cost.
    pub(crate) fn under_way(&self) -> Option<Plan> {
        let Lanes { plan, follower, .. } = self.lanes.as_ref()?;
        let rest = rest_of(plan, follower.target_m(), &[follower.target()]);
        Some(Plan { cost: 0.0, ..rest })
    }

    /// Whether at least half of the points of a plan are also points of the current plan. A plan made from scratch shares
    /// about a tenth of them; a repaired plan shares more than seven tenths.
    pub(crate) fn keeps_to(&self, plan: &Plan) -> bool {
        let bits = |point: &Point| [point.x.to_bits(), point.y.to_bits()];
        let flown: HashSet<_> = self.lanes.iter().flat_map(|lanes| &lanes.plan.path).map(bits).collect();
        let kept = plan.path.iter().filter(|point| flown.contains(&bits(point))).count();
        2 * kept >= plan.path.len()
    }

    /// The first place at least `lead_m` ahead of the robot at which a stretch of the plan ends. If that place is more
    /// than twice as far away, this is the first point of the path at least `lead_m` ahead instead. `None` if the plan
    /// ends before then.
    pub(crate) fn joint(&self, lead_m: f64) -> Option<Joint> {
        let Lanes { plan, follower, .. } = self.lanes.as_ref()?;
        let stations_m = polyline::stations_m(&plan.path);
        let least_m = follower.along_m() + lead_m;
        let after = |at_m: f64| stations_m.partition_point(|station_m| *station_m < at_m);
        let (first, end) = (after(least_m), plan.path.len().saturating_sub(1));
        let near = first..after(least_m + lead_m).min(end);
        let leg_ends = plan.legs.iter().map(|leg| leg.last);
        let index = leg_ends.filter(|last| near.contains(last)).min().unwrap_or(first);
        if index >= end {
            return None;
        }
        Some(Joint { at: plan.path[index], station_m: stations_m[index] })
    }

    /// The path along the plan from the robot to a place on the plan.
    pub(crate) fn way_to(&self, joint: &Joint) -> Vec<Point> {
        let between = self.lanes.iter().flat_map(|Lanes { plan, follower, .. }| {
            let stations_m = polyline::stations_m(&plan.path);
            let at = |m: f64| stations_m.partition_point(|at_m| *at_m <= m);
            plan.path[at(follower.along_m())..at(joint.station_m)].to_vec()
        });
        std::iter::once(self.position).chain(between).collect()
    }

    /// The rest of the path, from a place on the plan.
    pub(crate) fn path_from(&self, joint: &Joint) -> Vec<Point> {
        self.lanes
            .as_ref()
            .map_or_else(Vec::new, |lanes| rest_of(&lanes.plan, joint.station_m, &[joint.at]).path)
    }

    /// Progress along the plan.
    pub(crate) fn lanes(&self) -> Option<&PathFollower> {
        self.lanes.as_ref().map(|lanes| &lanes.follower)
    }

    /// Purpose of the stretch that the robot is on.
    pub(crate) fn leg(&self) -> Option<LegTag> {
        let lanes = self.lanes.as_ref()?;
        lanes.plan.legs.get(self.leg_index()?).map(|leg| leg.tag)
    }

    /// Index of the stretch that the robot is on; at the end of the plan, the last stretch.
    pub(crate) fn leg_index(&self) -> Option<usize> {
        let lanes = self.lanes.as_ref()?;
        let along_m = lanes.follower.along_m();
        // The ends of the stretches are in ascending order.
        let here = lanes.ends_m.partition_point(|end_m| *end_m <= along_m);
        Some(here.min(lanes.ends_m.len().checked_sub(1)?))
    }

    /// Whether the rest of the plan comes closer than `room_m` to an outline.
    pub(crate) fn is_in_the_way(&self, shape: &Shape, room_m: f64) -> bool {
        let (low, high) = shape.bounds();
        let reach = world::Vector::new(room_m, room_m);
        let (low, high) = (low - reach, high + reach);
        let is_near = |p: &Point| p.x >= low.x && p.x <= high.x && p.y >= low.y && p.y <= high.y;
        // The follower's points are close enough together to represent the path.
        let is_in_the_way = |p: &Point| is_near(p) && shape.distance_m(*p) < room_m;
        self.lanes.as_ref().is_none_or(|lanes| lanes.follower.remaining().iter().any(is_in_the_way))
    }

    /// The floor left to scan, as boxes. If no floor is left, returns one cell at the anchor, because an empty list
    /// would mean the whole floor.
    fn regions_left(&self, coverage: &CoverageGrid, lane_m: f64) -> Vec<Vec<Point>> {
        // Before the first plan, the tool has only passed over the start, which it will pass over again.
        if self.regions.is_empty() && self.lanes.is_none() {
            return Vec::new();
        }
        let floor = coverage.floor();
        let wanted = regions::cells_within(floor, &self.regions);
        let is_left = |index: usize| {
            floor.is_reachable(index)
                && !coverage.is_covered(index)
                && wanted.as_ref().is_none_or(|w| w[index])
        };
        // Requested areas that are narrower than a lane could be missed if the blocks were larger than a cell.
        let is_narrow = |region: &Vec<Point>| {
            let (low, high) = world::shape::bounds_of(region);
            (high - low).min() < lane_m
        };
        let block_m = if self.regions.iter().any(is_narrow) { 0.0 } else { BLOCK_LANES * lane_m };
        let block = ((block_m / floor.cell_m).round() as usize).max(1);
        let left = regions::boxes(floor, block, is_left);
        let left = if left.is_empty() { vec![regions::square(self.anchor, floor.cell_m)] } else { left };
        left.into_iter().chain(self.regions_out_of_reach(coverage)).collect()
    }

    /// Requested areas that contain no reachable floor, exactly as requested: planners report them, and the plans count
    /// as incomplete.
    pub(crate) fn regions_out_of_reach(&self, coverage: &CoverageGrid) -> impl Iterator<Item = Vec<Point>> {
        let floor = coverage.floor();
        let holds_floor = move |region: &Vec<Point>| {
            let within = regions::cells_within(floor, std::slice::from_ref(region));
            within.is_some_and(|within| (0..floor.len()).any(|k| within[k] && floor.is_reachable(k)))
        };
        self.regions.iter().filter(move |region| !holds_floor(region)).cloned()
    }

    /// Reachable cells left to scan.
    pub(crate) fn floor_left(&self, coverage: &CoverageGrid) -> Vec<usize> {
        let floor = coverage.floor();
        let wanted = regions::cells_within(floor, &self.regions);
        let is_wanted = |index: usize| wanted.as_ref().is_none_or(|w| w[index]);
        (0..floor.len())
            .filter(|index| floor.is_reachable(*index) && !coverage.is_covered(*index) && is_wanted(*index))
            .collect()
    }

    /// The remaining task, in the form that planners receive.
    pub(crate) fn left(
        &self,
        coverage: &CoverageGrid,
        lane_m: f64,
        tether: Option<api::TetherLimits>,
    ) -> TaskLeft {
        let regions = self.regions_left(coverage, lane_m);
        TaskLeft::Cover { anchor: self.anchor, regions, tether, tolerance_m: self.tolerance_m }
    }

    /// Share of the distance that is done, 0 to 1: the distance driven along this plan and earlier ones, divided by that
    /// distance plus the rest of this plan.
    pub(crate) fn done(&self) -> f64 {
        let flown_m = self.before_m + self.lanes.as_ref().map_or(0.0, |lanes| lanes.follower.along_m());
        let whole_m = flown_m + self.left_m();
        if self.lanes.is_none() || whole_m <= 0.0 { 0.0 } else { flown_m / whole_m }
    }

    /// Distance left along the plan, metres.
    pub(crate) fn left_m(&self) -> f64 {
        let left_m = |lanes: &Lanes| lanes.follower.length_m() - lanes.follower.along_m();
        self.lanes.as_ref().map_or_else(|| (self.anchor - self.position).norm(), left_m)
    }

    /// Distance from the plan, metres.
    pub(crate) fn cross_track_m(&self, position: Point) -> Option<f64> {
        self.lanes.as_ref().map(|lanes| lanes.follower.cross_track_m(position))
    }

    /// Whether the robot has reached the end of the plan and is back at the anchor.
    pub(crate) fn is_done(&self, position: Point) -> bool {
        let is_back = (self.anchor - position).norm() <= self.tolerance_m;
        is_back && self.lanes.as_ref().is_some_and(|l| l.follower.is_done(position, self.tolerance_m))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use planner_api::Leg;
    use world::{Boundary, Floor, World};

    fn floor() -> Floor {
        let boundary = Boundary::Circle { radius_m: 3.0 };
        let world = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
        Floor::new(&world, 0.1, 0.3, 0.6, Point::origin())
    }

    /// A tank in which a column leaves no room at (2.9, 0).
    fn narrow_world() -> World {
        let column = world::Obstacle {
            id: world::ObstacleId(0),
            name: "C".into(),
            shape: Shape::Disc { center: Point::new(2.8, 0.0), radius_m: 0.3 },
            known: true,
        };
        let boundary = Boundary::Circle { radius_m: 3.0 };
        World { boundary, obstacles: vec![column], stations: vec![], zones: vec![] }
    }

    fn area_m2(regions: &[Vec<Point>]) -> f64 {
        regions.iter().map(|vertices| world::shape::ring_area_m2(vertices)).sum()
    }

    fn plan() -> Plan {
        let path = [(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (0.0, 0.0)].map(|(x, y)| Point::new(x, y)).to_vec();
        let leg = |tag, first, last| Leg { tag, first, last };
        let legs = vec![leg(LegTag::Swath, 0, 1), leg(LegTag::Connector, 1, 2), leg(LegTag::Travel, 2, 3)];
        Plan { path, complete: true, legs, ..Plan::default() }
    }

    #[test]
    fn what_is_left_shrinks_by_what_was_scanned_and_nothing_left_is_not_everything() {
        let mut cover = Cover::new(Point::origin(), vec![], 0.2, Point::origin());
        let mut grid = CoverageGrid::new(floor());
        assert_eq!(cover.regions_left(&grid, 0.6), Vec::<Vec<Point>>::new());
        cover.take_plan(&plan());
        grid.mark_swath(Point::new(-3.0, 0.0), Point::new(3.0, 0.0), 2.0);
        let left_m2 = area_m2(&cover.regions_left(&grid, 0.6));
        let expected_m2 = (grid.counts().reachable - grid.counts().covered_reachable) as f64 * 0.01;
        assert!((left_m2 - expected_m2).abs() < 1.5, "{left_m2} of {expected_m2}");
        grid.mark_swath(Point::new(0.0, 0.0), Point::new(0.0, 0.0), 20.0);
        let left = cover.regions_left(&grid, 0.6);
        assert!(left.len() == 1 && area_m2(&left) < 0.011, "{left:?}");
    }

    #[test]
    fn a_mission_for_some_regions_asks_for_no_more() {
        let region = regions::square(Point::new(1.0, 1.0), 1.0);
        let cover = Cover::new(Point::origin(), vec![region], 0.2, Point::origin());
        let left_m2 = area_m2(&cover.regions_left(&CoverageGrid::new(floor()), 0.6));
        assert!((left_m2 - 1.0).abs() < 0.3, "{left_m2}");
    }

    #[test]
    fn a_region_without_floor_in_reach_is_asked_for_as_it_is() {
        let outside = regions::square(Point::new(2.9, 0.0), 0.1);
        let regions = vec![regions::square(Point::new(1.0, 1.0), 1.0), outside.clone()];
        let cover = Cover::new(Point::origin(), regions, 0.2, Point::origin());
        let mut grid = CoverageGrid::new(Floor::new(&narrow_world(), 0.1, 0.5, 0.6, Point::origin()));
        let left = cover.regions_left(&grid, 0.6);
        assert!(left.len() > 1 && left.last() == Some(&outside), "{left:?}");
        grid.mark_swath(Point::new(0.0, 0.0), Point::new(0.0, 0.0), 20.0);
        assert_eq!(
            cover.regions_left(&grid, 0.6).len(),
            2,
            "a cell at the anchor, and the area out of reach"
        );
    }

    #[test]
    fn regions_narrower_than_a_lane_are_asked_for_all_the_same() {
        let row =
            |x: i32| (0..6).map(move |y| Point::new(0.3 * f64::from(x) - 0.95, 0.3 * f64::from(y) - 0.75));
        let boxes: Vec<Vec<Point>> = (0..6).flat_map(row).map(|at| regions::square(at, 0.1)).collect();
        let cover = Cover::new(Point::origin(), boxes, 0.2, Point::origin());
        let boundary = Boundary::Circle { radius_m: 3.0 };
        let world = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
        let grid = CoverageGrid::new(Floor::new(&world, 0.05, 0.3, 0.6, Point::origin()));
        let left_m2 = area_m2(&cover.regions_left(&grid, 0.5));
        assert!((left_m2 - 0.36).abs() < 0.04, "{left_m2}");
    }

    #[test]
    fn the_leg_under_the_robot_is_known_and_the_end_is_at_the_anchor() {
        let map = ObstacleMap::new(&Boundary::Circle { radius_m: 3.0 }, &[]);
        let mut cover = Cover::new(Point::origin(), vec![], 0.2, Point::origin());
        cover.take_plan(&plan());
        let mut legs = Vec::new();
        let flown = [(0.0, 0.0), (0.9, 0.0), (1.9, 0.0), (2.0, 0.3), (2.0, 0.98), (1.2, 0.6), (0.3, 0.15)];
        let flown = flown.map(|(x, y)| Point::new(x, y));
        for at in polyline::resampled(&flown, 0.1) {
            assert!(!cover.is_done(at));
            cover.advance(at, &map);
            legs.extend(cover.leg().map(LegTag::word));
        }
        legs.dedup();
        assert_eq!(legs, ["swath", "connector", "travel"]);
        cover.advance(Point::new(0.02, 0.0), &map);
        assert!(cover.is_done(Point::origin()) && cover.done() > 0.99);
    }

    #[test]
    fn a_corner_that_cannot_be_reached_is_given_up_after_a_while() {
        let map = ObstacleMap::new(&Boundary::Circle { radius_m: 3.0 }, &[]);
        let mut cover = Cover::new(Point::origin(), vec![], 0.2, Point::origin());
        cover.take_plan(&plan());
        for x in [0.0, 0.7, 1.4, 1.9] {
            cover.advance(Point::new(x, 0.0), &map);
        }
        let given_up = (0..100).find(|_| {
            cover.wait(0.1);
            cover.advance(Point::new(1.9, 0.0), &map);
            cover.target().y > 0.1
        });
        assert!(given_up.is_some_and(|tick| (55..65).contains(&tick)), "{given_up:?}");
    }

    #[test]
    fn only_what_stands_beside_the_rest_of_the_way_is_in_the_way() {
        let map = ObstacleMap::new(&Boundary::Circle { radius_m: 3.0 }, &[]);
        let mut cover = Cover::new(Point::origin(), vec![], 0.2, Point::origin());
        cover.take_plan(&plan());
        let column = |x, y| Shape::Disc { center: Point::new(x, y), radius_m: 0.1 };
        assert!(cover.is_in_the_way(&column(1.0, 0.3), 0.3));
        assert!(!cover.is_in_the_way(&column(1.0, -1.0), 0.3));
        for x in [0.0, 0.7, 1.4, 2.0] {
            cover.advance(Point::new(x, 0.0), &map);
        }
        assert!(
            !cover.is_in_the_way(&column(1.0, -0.3), 0.3),
            "the lane beside the column is behind the robot"
        );
    }
}
