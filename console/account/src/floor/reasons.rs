//! Finds the reasons why cells were missed or are unreachable, with the values behind them.

use super::{
    evidence::{Evidence, Solid},
    measure::{Measure, apart_m, depth_m},
    reason::{MissReason, OutOfReach},
};
use std::collections::{BTreeMap, BTreeSet};
use world::{Cell, CoverageGrid, Point, Vector, polyline, tether::Reach};

/// The names of the zones of some cells, the zone with the most cells first; `None` without zones.
fn named<'a>(zones: impl Iterator<Item = &'a Solid>) -> Option<String> {
    let mut cells: BTreeMap<&str, usize> = BTreeMap::new();
    zones.for_each(|zone| *cells.entry(&zone.name).or_default() += 1);
    let mut names: Vec<(&str, usize)> = cells.into_iter().collect();
    names.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    let names: Vec<&str> = names.into_iter().map(|(name, _)| name).collect();
    (!names.is_empty()).then(|| names.join(" and "))
}

/// The number of directions in which room for a lane is looked for.
const DIRECTIONS: u32 = 24;
/// The loss of room because of the few directions in which it is looked for, metres.
const ROOM_SLACK_M: f64 = 0.01;

/// One of [`DIRECTIONS`] unit vectors.
fn direction(k: u32) -> Vector {
    let angle_rad = std::f64::consts::TAU * f64::from(k) / f64::from(DIRECTIONS);
    Vector::new(angle_rad.cos(), angle_rad.sin())
}

/// The largest number of channels that are named one by one.
const MOST_NAMED: usize = 3;

/// The names of channels, or their number if there are many.
fn channels_text(channels: &BTreeSet<u16>) -> String {
    if channels.len() > MOST_NAMED {
        return format!("each of {} channels", channels.len());
    }
    let names: Vec<String> = channels.iter().map(|channel| format!("channel {channel}")).collect();
    names.join(" or ")
}

/// Finds the reasons for missed floor.
pub struct Reasons<'a> {
    pub(super) evidence: &'a Evidence,
    /// The floor within reach of the cable; `None` if no plan omitted floor that is out of reach.
    pub(super) reach: Option<Reach>,
    /// Whether the robot drags a tether.
    pub(super) has_tether: bool,
    /// Width of lanes: the swath less the overlap, metres.
    pub(super) lane_m: f64,
    /// Radius of the hull plus clearance, metres.
    pub(super) room_m: f64,
    /// Limit of the 95 % error above which nothing counts as scanned, metres.
    pub(super) limit_m: f64,
}

impl Reasons<'_> {
    /// The reason why a cell was missed.
    pub fn why_missed(&self, center: Point, index: usize) -> MissReason {
        let evidence = self.evidence;
        if evidence.dead_channel(index).is_some() {
            MissReason::DeadChannel
        } else if evidence.uncertain_m(index).is_some() {
            MissReason::PositionUncertain
        } else if self.is_left_beyond_reel(index, center) {
            MissReason::BeyondReel
        } else if evidence.is_beside_found(center) {
            MissReason::FoundObstacle
        } else if !evidence.is_asked(index) {
            MissReason::NotAsked
        } else if evidence.is_passed(index) {
            MissReason::PassedBeside
        } else if evidence.is_ahead(index) {
            MissReason::NotReached
        } else {
            self.why_not_planned(center)
        }
    }

    /// The distance by which a position is beyond every lane, given that lanes keep hull and clearance from solid
    /// objects, metres; negative within reach of a lane.
    pub fn beyond_lanes_m(&self, place: Point) -> f64 {
        let (_, solid_m) = self.evidence.nearest_kept_from(place);
        self.room_m - solid_m - self.lane_m / 2.0
    }

    /// The reason why no plan led to a position.
    fn why_not_planned(&self, place: Point) -> MissReason {
        let (_, solid_m) = self.evidence.nearest_kept_from(place);
        if !self.evidence.has_plan() {
            MissReason::NoPlan
        } else if self.beyond_lanes_m(place) > 0.0 {
            MissReason::Narrow
        } else if solid_m < self.room_m {
            let has_room = self.has_room_for_lane(place, self.room_m - solid_m);
            if has_room { MissReason::NoLaneBeside } else { MissReason::Clearance }
        } else if self.has_tether && self.cut_m(place).is_some_and(|cut_m| cut_m <= self.lane_m) {
            MissReason::Wrap
        } else {
            MissReason::NotPlanned
        }
    }

    /// Whether the robot can stand near enough to a position that a lane there scans the position, and yet keep hull
    /// and clearance from every solid object; the position lies `short_m` too near to the nearest one, metres.
    fn has_room_for_lane(&self, place: Point, short_m: f64) -> bool {
        let stands = |at: Point| self.evidence.nearest_kept_from(at).1 >= self.room_m - ROOM_SLACK_M;
        let around = |away_m: f64| (0..DIRECTIONS).map(move |k| place + away_m * direction(k));
        around(short_m).chain(around(self.lane_m / 2.0)).any(stands)
    }

    /// The value behind a reason, computed over the cells to which the reason applies.
    pub fn measure(&self, grid: &CoverageGrid, reason: MissReason, cells: &[usize]) -> Option<Measure> {
        let (floor, evidence) = (grid.floor(), self.evidence);
        let most =
            |of: &dyn Fn(usize) -> Option<f64>| cells.iter().filter_map(|cell| of(*cell)).reduce(f64::max);
        let least =
            |of: &dyn Fn(usize) -> Option<f64>| cells.iter().filter_map(|cell| of(*cell)).reduce(f64::min);
        let solid = |cell: usize| evidence.nearest_kept_from(floor.center(cell));
        let depth =
            |is_other: &dyn Fn(usize) -> bool| Some(depth_m(floor, cells, is_other).unwrap_or(floor.cell_m));
        match reason {
            MissReason::PositionUncertain => {
                most(&|cell| evidence.uncertain_m(cell)).map(|m| Measure::of(m).against(self.limit_m))
            }
            MissReason::DeadChannel => {
                let channels: BTreeSet<u16> =
                    cells.iter().filter_map(|cell| evidence.dead_channel(*cell)).collect();
                depth(&|cell| grid.is_covered(cell)).map(|m| Measure::of(m).beside(&channels_text(&channels)))
            }
            MissReason::FoundObstacle => {
                Measure::off(cells.iter().filter_map(|cell| evidence.nearest_found(floor.center(*cell))))
            }
            MissReason::NotAsked => {
                let is_asked = |cell| evidence.is_asked(cell);
                // Between the area and the requested floor, there may be floor with another reason.
                let depth_m = depth_m(floor, cells, is_asked).or_else(|| apart_m(floor, cells, is_asked));
                depth_m.map(Measure::of)
            }
            // In a corner, a cell may be near enough to the nearest wall, and yet no lane can reach it.
            MissReason::Narrow => most(&|cell| Some(self.beyond_lanes_m(floor.center(cell))))
                .filter(|beyond_m| *beyond_m > 0.0)
                .map(|m| Measure::of(m).against(self.lane_m)),
            MissReason::Clearance | MissReason::NoLaneBeside => {
                Measure::off(cells.iter().map(|cell| solid(*cell))).map(|m| m.against(self.room_m))
            }
            MissReason::Wrap => least(&|cell| self.cut_m(floor.center(cell))).map(Measure::of),
            MissReason::NotPlanned => depth(&|cell| evidence.is_passed(cell) || evidence.is_ahead(cell))
                .map(|m| Measure::of(m).against(self.lane_m)),
            MissReason::NoPlan | MissReason::InDoubt => None,
            MissReason::BeyondReel => {
                let reach = self.reach.as_ref()?;
                most(&|cell| reach.beyond_m(floor.center(cell)))
                    .map(|m| Measure::of(m).against(reach.within_m()))
            }
            MissReason::NotReached => most(&|cell| evidence.ahead_m(cell)).map(Measure::of),
            MissReason::PassedBeside => depth(&|cell| grid.is_covered(cell)).map(Measure::of),
        }
    }

    /// The value behind the reason why some cells are unreachable.
    pub(crate) fn measure_out_of_reach(
        &self,
        grid: &CoverageGrid,
        reason: OutOfReach,
        cells: &[usize],
    ) -> Option<Measure> {
        let floor = grid.floor();
        let solid = |cell: &usize| self.evidence.nearest_solid(floor.center(*cell));
        match reason {
            OutOfReach::ShellMargin | OutOfReach::BesideObstacle => {
                Measure::off(cells.iter().map(solid)).map(|m| m.against(self.room_m))
            }
            OutOfReach::ClosedOff => {
                let by = cells.iter().filter_map(|cell| self.evidence.shut_by(*cell));
                Some(Measure { near: named(by), ..Measure::of(2.0 * self.room_m) })
            }
            OutOfReach::NoGo => {
                let zone = |cell: &usize| Some(self.evidence.nearest_no_go(floor.center(*cell))?.0);
                let depth_m = depth_m(floor, cells, |cell| floor.kind(cell) == Cell::Reachable)?;
                Some(Measure { near: named(cells.iter().filter_map(zone)), ..Measure::of(depth_m) })
            }
        }
    }

    /// Distance from the nearest cut, metres; `None` without cuts.
    fn cut_m(&self, place: Point) -> Option<f64> {
        let edges = self.evidence.cuts().iter().flat_map(|cut| cut.windows(2));
        edges
            .map(|edge| (place - polyline::nearest_on_segment(edge[0], edge[1], place)).norm())
            .reduce(f64::min)
    }

    /// Whether a cell had to be scanned, but no plan led there because the cell is beyond the reach of the tether.
    fn is_left_beyond_reel(&self, index: usize, center: Point) -> bool {
        let evidence = self.evidence;
        let is_left = evidence.is_asked(index) && !evidence.is_passed(index) && !evidence.is_ahead(index);
        is_left && self.reach.as_ref().is_some_and(|reach| reach.is_beyond(center))
    }
}
