//! Makes a path from lanes: first a tour that is good enough to estimate the value of a candidate, then the finished
//! path.

use crate::floor::{Grain, ReachableFloor, SweptFloor};
use crate::jobs::Job;
use crate::lanes::{Lane, lanes, wanted_pieces};
use crate::pattern::Pattern;
use crate::polish::{Terms, Track, polish, settle};
use crate::scan::{Piece, Scan};
use crate::scope::Scope;
use crate::slit_domain::SlitDomain;
use crate::touch_up::touch_up;
use crate::tour::{Connectors, Costs, Effort, tour};
use crate::tuning;
use planner_api::Result;
use std::f64::consts::TAU;
use world::{Point, polyline};

/// A candidate with its first tour.
pub(crate) struct Draft<'a> {
    scope: Scope<'a>,
    effort: Effort,
    domain: SlitDomain<'a>,
    /// The floor to scan, without sweep counts, which take many megabytes for a large floor.
    floor: ReachableFloor,
    lanes: Vec<Lane>,
    /// The known costs of connectors between lane ends.
    costs: Costs,
    pieces: Vec<Piece>,
    /// Length of the path plus the estimated length of touch-ups, metres.
    length_m: f64,
    turns: f64,
}

impl<'a> Draft<'a> {
    /// Creates a candidate with its first tour.
    pub(crate) fn new(
        pattern: &Pattern,
        domain: SlitDomain<'a>,
        scope: Scope<'a>,
        effort: Effort,
        job: &Job,
    ) -> Result<Self> {
        job.stage(0.5);
        let all = lanes(&domain, pattern, domain.workspace.swath_m / tuning::lanes::LEAST_IN_SWATH);
        let floor = ReachableFloor::new(&domain, rough_m(&scope)).within(scope.regions);
        let (lanes, costs, pieces) = (Vec::new(), Costs::default(), Vec::new());
        let mut draft =
            Self { scope, effort, domain, floor, lanes, costs, pieces, length_m: 0.0, turns: 0.0 };
        draft.lanes = draft.wanted(all);
        job.stage(0.95);
        draft.pieces = draft.toured(tuning::tour::DRAFT_SHARE, job)?;
        job.stage(1.0);
        let mut swept = SweptFloor::new(draft.floor.clone());
        swept.sweep(&joined(&draft.pieces));
        draft.measure(&swept);
        Ok(draft)
    }

    pub(crate) fn domain(&self) -> &SlitDomain<'a> {
        &self.domain
    }

    /// The path of the first tour.
    pub(crate) fn path(&self) -> Vec<Point> {
        joined(&self.pieces)
    }

    /// The estimated cost of the finished path, metres, at this price per whole turn.
    pub(crate) fn estimate_m(&self, turn_m: f64) -> f64 {
        self.length_m + turn_m * self.turns
    }

    /// The lanes in a good order, with the connectors between them.
    fn toured(&mut self, share_of_kicks: f64, job: &Job) -> Result<Vec<Piece>> {
        let effort = self.effort;
        let effort = Effort { kicks_per_lane: effort.kicks_per_lane * share_of_kicks, ..effort };
        let ends = (self.domain.workspace.home, self.domain.start(self.scope.start));
        let known = std::mem::take(&mut self.costs);
        let connectors = Connectors::new(&self.domain, &self.lanes, ends, effort.turn_m_per_rad, known);
        let order = tour(&connectors, &effort, job)?;
        let mut pieces = Vec::new();
        for (entry, next) in order.iter().zip(order.iter().cycle().skip(1)) {
            if let Some(lane) = self.lanes.get(entry / 2) {
                let mut points = lane.clone();
                if entry % 2 == 1 {
                    points.reverse();
                }
                pieces.push(Piece { points, is_lane: true });
            }
            pieces.push(Piece { points: connectors.path(entry ^ 1, *next), is_lane: false });
        }
        self.costs = connectors.into_costs();
        Ok(pieces)
    }

    /// The pieces of lanes that are within reach and have floor to scan.
    fn wanted(&self, lanes: Vec<Lane>) -> Vec<Lane> {
        let Scope { reel_length_m, regions, .. } = self.scope;
        if reel_length_m.is_infinite() && regions.is_empty() {
            return lanes;
        }
        let is_wanted = |at: Point| {
            self.scope.is_in_reach(&self.domain, at) && (regions.is_empty() || self.floor.is_near(at))
        };
        lanes.iter().flat_map(|lane| wanted_pieces(lane, is_wanted)).collect()
    }

    /// Adds lanes over large missed areas, then polishes the path in coarse cells.
    pub(crate) fn roughed(mut self, job: &Job) -> Result<Self> {
        job.stage(0.02);
        let swath_m = self.domain.workspace.swath_m;
        let mut swept = SweptFloor::new(self.floor.clone());
        swept.sweep(&joined(&self.pieces));
        let least = (tuning::touch_ups::LEAST * swath_m * swath_m / swept.raster().cell_m2()) as usize;
        let missed = swept.missed();
        let large = missed.iter().take_while(|group| group.len() > least);
        let fresh = large.flat_map(|group| touch_up(&self.domain, &swept, group)).collect();
        self.lanes.extend(self.wanted(fresh));
        // The first tour used little effort; from here on, the order matters.
        job.stage(0.4);
        let pieces = self.toured(1.0, job)?;
        job.stage(0.5);
        let is_wanted = |at| self.scope.is_in_reach(&self.domain, at);
        let terms = Terms::of(&self.scope, self.effort, swath_m, &is_wanted, job);
        let mut track = Track::new(&self.domain, &pieces, |_| true, swept.floor);
        polish(&mut track, &terms, self.scope.regions.is_empty(), 0.5..1.0)?;
        let (pieces, swept) = track.into_pieces();
        self.pieces = pieces;
        self.measure(&swept);
        Ok(self)
    }

    /// Polishes a candidate in fine cells, after it has been polished in coarse cells.
    pub(crate) fn finished(self, job: &Job) -> Result<Scan<'a>> {
        let is_wanted = |at| self.scope.is_in_reach(&self.domain, at);
        let terms = Terms::of(&self.scope, self.effort, self.domain.workspace.swath_m, &is_wanted, job);
        let floor = |grain| ReachableFloor::in_cells(&self.domain, grain).within(self.scope.regions);
        let cell_m = self.scope.cell_m;
        let mut track = Track::new(&self.domain, &self.pieces, |_| true, floor(Grain::of(cell_m)));
        polish(&mut track, &terms, self.scope.regions.is_empty(), 0.1..0.8)?;
        settle(&mut track, &terms, &floor(Grain::other(cell_m)))?;
        let (pieces, swept) = track.into_pieces();
        Ok(Scan { pieces, domain: self.domain, swept })
    }

    /// Measures the length and the turns of the current path, with an allowance for the floor that it misses.
    fn measure(&mut self, swept: &SweptFloor) {
        let path = joined(&self.pieces);
        let missed_m2 = (self.scope.enough - swept.coverage()).max(0.0) * swept.floor.area_m2();
        let touch_ups_m = tuning::touch_ups::MISSED * missed_m2 / self.domain.workspace.swath_m;
        self.length_m = polyline::length_m(&path) + touch_ups_m;
        self.turns = rotation_turns(&path);
    }
}

/// Edge length of the cells used until a candidate is finished, metres.
fn rough_m(scope: &Scope<'_>) -> f64 {
    scope.cell_m * tuning::polish::ROUGH
}

fn joined(pieces: &[Piece]) -> Vec<Point> {
    pieces.iter().flat_map(|piece| piece.points.iter().copied()).collect()
}

/// The sum of the changes of heading along a path, in whole turns.
pub(crate) fn rotation_turns(path: &[Point]) -> f64 {
    polyline::turns_rad(path).sum::<f64>() / TAU
}
