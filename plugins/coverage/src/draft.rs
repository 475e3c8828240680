//! From lanes to a path: a first tour, enough to estimate what a candidate will be worth, and the finished path.

use crate::floor::{ReachableFloor, SweptFloor};
use crate::jobs::Job;
use crate::lanes::{Lane, lanes, wanted_pieces};
use crate::pattern::Pattern;
use crate::plane::angle_rad;
use crate::polish::{Terms, Track, polish};
use crate::scan::{Piece, Scan};
use crate::scope::Scope;
use crate::slit_domain::SlitDomain;
use crate::touch_up::touch_up;
use crate::tour::{Connectors, Costs, Effort, tour};
use crate::tuning;
use planner_api::Result;
use std::f64::consts::TAU;
use world::{Point, Vector, polyline};

/// A candidate as far as the first tour.
pub(crate) struct Draft<'a> {
    scope: Scope<'a>,
    effort: Effort,
    domain: SlitDomain<'a>,
    /// The floor to scan, without what was swept: with it a large one takes many megabytes.
    floor: ReachableFloor,
    lanes: Vec<Lane>,
    /// What connectors between their ends cost, as far as it is known.
    costs: Costs,
    pieces: Vec<Piece>,
    /// Length, with what is still to scan, metres.
    length_m: f64,
    turns: f64,
}

impl<'a> Draft<'a> {
    /// The first tour of a candidate.
    pub(crate) fn new(
        pattern: &Pattern,
        domain: SlitDomain<'a>,
        scope: Scope<'a>,
        effort: Effort,
        job: &Job,
    ) -> Result<Self> {
        job.stage(0.5);
        let all = lanes(&domain, pattern, domain.workspace.swath_m / tuning::lanes::LEAST_IN_SWATH);
        let floor = ReachableFloor::new(&domain, scope.cell_m).within(scope.regions);
        let (lanes, costs, pieces) = (Vec::new(), Costs::default(), Vec::new());
        let mut draft =
            Self { scope, effort, domain, floor, lanes, costs, pieces, length_m: 0.0, turns: 0.0 };
        draft.lanes = draft.wanted(all);
        job.stage(0.95);
        draft.pieces = draft.toured(tuning::tour::DRAFT_SHARE, job)?;
        job.stage(1.0);
        let path = joined(&draft.pieces);
        let mut swept = SweptFloor::new(draft.floor);
        swept.sweep(&path);
        let missed_m2 = (1.0 - swept.coverage()) * swept.floor.area_m2();
        draft.floor = swept.floor;
        draft.length_m = polyline::length_m(&path)
            + tuning::touch_ups::MISSED * missed_m2 / draft.domain.workspace.swath_m;
        draft.turns = rotation_turns(&path);
        Ok(draft)
    }

    pub(crate) fn domain(&self) -> &SlitDomain<'a> {
        &self.domain
    }

    /// The first tour.
    pub(crate) fn path(&self) -> Vec<Point> {
        joined(&self.pieces)
    }

    /// Estimated cost of the finished path, metres, at this price of a whole turn.
    pub(crate) fn estimate_m(&self, turn_m: f64) -> f64 {
        self.length_m + turn_m * self.turns
    }

    /// The lanes in a good order, with the ways between.
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

    /// The pieces of lanes that are in reach and have floor to scan.
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

    /// The candidate with lanes over large missed places, shortened wherever that pays.
    pub(crate) fn finished(mut self, job: &Job) -> Result<Scan<'a>> {
        job.stage(0.02);
        let swath_m = self.domain.workspace.swath_m;
        let mut swept = SweptFloor::new(self.floor.clone());
        swept.sweep(&joined(&self.pieces));
        let least = (tuning::touch_ups::LEAST * swath_m * swath_m / swept.raster().cell_m2()) as usize;
        let missed = swept.missed();
        let large = missed.iter().take_while(|group| group.len() > least);
        let fresh = large.flat_map(|group| touch_up(&self.domain, &swept, group)).collect();
        self.lanes.extend(self.wanted(fresh));
        // The draft was quick; from here on the order matters.
        job.stage(0.27);
        let pieces = self.toured(1.0, job)?;
        job.stage(0.32);
        let is_wanted = |at| self.scope.is_in_reach(&self.domain, at);
        let terms = Terms::of(&self.scope, self.effort, swath_m, &is_wanted, job);
        let mut track = Track::new(&self.domain, &pieces, |_| true, swept.floor);
        polish(&mut track, &terms, self.scope.regions.is_empty())?;
        let (pieces, swept) = track.into_pieces();
        Ok(Scan { pieces, domain: self.domain, swept })
    }
}

fn joined(pieces: &[Piece]) -> Vec<Point> {
    pieces.iter().flat_map(|piece| piece.points.iter().copied()).collect()
}

/// Sum of the changes of heading along a path, in whole turns.
pub(crate) fn rotation_turns(path: &[Point]) -> f64 {
    let headings: Vec<Vector> = path.windows(2).filter_map(|w| (w[1] - w[0]).try_normalize(1e-9)).collect();
    headings.windows(2).map(|w| angle_rad(w[0], w[1])).sum::<f64>() / TAU
}
