//! Repair of the current plan: it changes only around the obstacles found during the mission.
//!
//! The cuts stay. An obstacle not connected by any cut gets a new cut, placed where it crosses the rest of the path as
//! rarely as possible. Parts of the path that can still be driven are kept as sections: long sections far away, single
//! lanes near the change. The sections are reordered, starting from their planned order. The connectors between them
//! are polished like those of any path.

mod current;

use crate::cuts::{Extension, cuts_up_to_found};
use crate::floor::{ReachableFloor, SweptFloor};
use crate::jobs::Job;
use crate::polish::{Terms, Track, polish_again};
use crate::scan::{Piece, Scan};
use crate::scope::Scope;
use crate::slit_domain::SlitDomain;
use crate::tour::{Connectors, Costs, Effort, tour_from};
use crate::tuning::{self, cuts::SLIVER_M2, repair as tuned};
use crate::workspace::Workspace;
pub(crate) use current::{CurrentPlan, Side};
use planner_api::Result;
use world::{Point, polyline};

/// The input of a repair.
pub(crate) struct Repair<'a, 'f> {
    pub workspace: &'a Workspace,
    pub scope: Scope<'a>,
    pub effort: Effort,
    pub current: &'f CurrentPlan,
    /// The tether as it lies.
    pub tether: Vec<Point>,
}

/// The domain of the current plan with additional cuts for the found obstacles.
pub(crate) struct Extended<'a> {
    domain: SlitDomain<'a>,
    new_cuts: Vec<Vec<Point>>,
}

/// A repaired path.
pub(crate) struct Repaired<'a> {
    pub scan: Scan<'a>,
    /// The required coverage of the remaining floor: the lower of the requested coverage and what the current plan
    /// would have achieved, less a small allowance for the found obstacles.
    pub enough: f64,
}

/// A repaired path before polishing.
pub(crate) struct Laid<'a> {
    pub domain: SlitDomain<'a>,
    /// The pieces of the path, each with a flag for new pieces.
    pieces: Vec<(Piece, bool)>,
    /// Total length of the previous plan's lanes that are missing from this path, metres.
    lost_m: f64,
}

impl Laid<'_> {
    /// The whole path.
    pub(crate) fn path(&self) -> Vec<Point> {
        self.pieces.iter().flat_map(|(piece, _)| piece.points.iter().copied()).collect()
    }

    /// The estimated length once missed floor has been tied in, metres.
    pub(crate) fn estimate_m(&self) -> f64 {
        polyline::length_m(&self.path()) + tuning::touch_ups::MISSED * self.lost_m
    }
}

impl<'a> Repair<'a, '_> {
    /// The repaired path in a domain, before polishing; `None` if the robot is outside the domain.
    pub(crate) fn laid(
        &self,
        Extended { domain, new_cuts }: Extended<'a>,
        job: &Job,
    ) -> Result<Option<Laid<'a>>> {
        let Some(start) = domain.beside(self.scope.start) else { return Ok(None) };
        let sections = sections(&domain, self.current.sides(), &new_cuts);
        job.stage(0.5);
        let pieces = self.joined(&domain, &sections, start, job)?;
        let lost_m = lanes_m(self.current.sides()) - sections.iter().map(|kept| lanes_m(kept)).sum::<f64>();
        Ok(Some(Laid { domain, pieces, lost_m }))
    }

    /// Polishes a repaired path to its final form.
    pub(crate) fn polished(&self, laid: Laid<'a>, job: &Job) -> Result<Repaired<'a>> {
        let Laid { domain, pieces, .. } = laid;
        let scope = &self.scope;
        let floor = ReachableFloor::new(&domain, scope.cell_m).within(scope.regions);
        // Floor that the previous plan would have missed anyway need not be scanned.
        let mut as_before = SweptFloor::new(floor.clone());
        as_before.sweep(&self.current.path());
        let enough = scope.enough.min(as_before.coverage()) - scope.whole * tuned::MORE_LEFT;
        let (pieces, is_new): (Vec<Piece>, Vec<bool>) = pieces.into_iter().unzip();
        let is_wanted = |at| scope.is_in_reach(&domain, at);
        let terms = Terms::of(scope, self.effort, domain.workspace.swath_m, &is_wanted, job);
        let mut track = Track::new(&domain, &pieces, |piece| is_new[piece], floor);
        polish_again(&mut track, &terms)?;
        let (pieces, swept) = track.into_pieces();
        Ok(Repaired { scan: Scan { pieces, domain, swept }, enough })
    }

    /// The domains that a repair may use, with different cuts for the found obstacles. Empty if all of these domains
    /// seal off floor.
    pub(crate) fn domains(&self) -> Vec<Extended<'a>> {
        let cuts = &self.current.cuts;
        let domains = self.domains_between(cuts);
        if !domains.is_empty() {
            return domains;
        }
        // An obstacle found in the line of a cut may plug the passage to another cut or to the wall. In that case the
        // cut ends at the obstacle.
        let shortened = cuts_up_to_found(self.workspace, cuts).into_iter();
        shortened.flat_map(|cuts| self.domains_between(&cuts)).collect()
    }

    /// The domains between some cuts, with different additional cuts for unconnected obstacles.
    fn domains_between(&self, cuts: &[Vec<Point>]) -> Vec<Extended<'a>> {
        let path: Vec<(Point, Point)> =
            self.current.sides().iter().map(|side| (side.from, side.to)).collect();
        let extension = Extension { workspace: self.workspace, cuts, tether: &self.tether, path: &path };
        let mut all: Vec<Vec<Vec<Point>>> =
            tuned::ANGLES_RAD.into_iter().filter_map(|angle_rad| extension.new_cuts(angle_rad)).collect();
        all.dedup();
        all.into_iter().filter_map(|new_cuts| self.domain(cuts, new_cuts)).collect()
    }

    fn domain(&self, cuts: &[Vec<Point>], new_cuts: Vec<Vec<Point>>) -> Option<Extended<'a>> {
        let mut domain = SlitDomain::new(self.workspace, [cuts, &new_cuts].concat())?;
        domain.close_up();
        (domain.sealed.area_m2 <= SLIVER_M2).then_some(Extended { domain, new_cuts })
    }

    /// Sections and connectors in a good order, from the start to home, each with a flag for new pieces.
    fn joined(
        &self,
        domain: &SlitDomain<'_>,
        sections: &[Vec<Side>],
        start: Point,
        job: &Job,
    ) -> Result<Vec<(Piece, bool)>> {
        let lanes: Vec<Vec<Point>> = sections.iter().map(|section| points(section)).collect();
        let ends = (self.workspace.home, start);
        let effort = Effort { kicks_per_lane: tuned::KICKS, ..self.effort };
        let connectors = Connectors::new(domain, &lanes, ends, effort.turn_m_per_rad, Costs::default());
        let as_before = std::iter::once(lanes.len()).chain(0..lanes.len()).map(|lane| 2 * lane).collect();
        let order = tour_from(as_before, &connectors, &effort, job)?;
        let mut laid = Vec::new();
        for (entry, next) in order.iter().zip(order.iter().cycle().skip(1)) {
            if let Some(section) = sections.get(entry / 2) {
                laid.extend(pieces(section, entry % 2 == 1).into_iter().map(|piece| (piece, false)));
            }
            laid.push((Piece { points: connectors.path(entry ^ 1, *next), is_lane: false }, true));
        }
        Ok(laid)
    }
}

/// The sections of a path that can still be driven, without connectors near the change.
fn sections(domain: &SlitDomain<'_>, rest: &[Side], new_cuts: &[Vec<Point>]) -> Vec<Vec<Side>> {
    let mut bits: Vec<(Side, bool)> = Vec::with_capacity(rest.len());
    for side in rest {
        if domain.sees(side.from, side.to) {
            bits.push((*side, true));
        } else {
            bits.extend(side.divided(tuned::BIT_M).map(|bit| (bit, domain.sees(bit.from, bit.to))));
        }
    }
    let broken: Vec<Point> = bits.iter().filter(|(_, is_open)| !is_open).map(|(bit, _)| bit.from).collect();
    let near_m = tuned::NEAR * domain.workspace.swath_m;
    let is_near = |at: Point| {
        broken.iter().any(|place| (place - at).norm() < near_m)
            || new_cuts.iter().any(|cut| polyline::distance_m(cut, at) < near_m)
    };
    let is_kept = |(bit, is_open): &(Side, bool)| *is_open && (bit.is_lane || !is_near(bit.from));
    let least_m = domain.workspace.swath_m / tuning::lanes::LEAST_IN_SWATH;
    let runs = bits.chunk_by(|a, b| is_kept(a) && is_kept(b));
    let runs = runs.filter(|run| is_kept(&run[0])).map(|run| run.iter().map(|(bit, _)| *bit).collect());
    runs.filter(|section: &Vec<Side>| polyline::length_m(&points(section)) >= least_m).collect()
}

/// The length of the lanes among some sides, metres.
fn lanes_m(sides: &[Side]) -> f64 {
    sides.iter().filter(|side| side.is_lane).map(|side| (side.to - side.from).norm()).sum()
}

fn points(section: &[Side]) -> Vec<Point> {
    section.first().map(|side| side.from).into_iter().chain(section.iter().map(|side| side.to)).collect()
}

/// The pieces of a section, reversed if required.
fn pieces(section: &[Side], is_reversed: bool) -> Vec<Piece> {
    let piece = |run: &[Side]| Piece { points: points(run), is_lane: run[0].is_lane };
    let mut pieces: Vec<Piece> = section.chunk_by(|a, b| a.is_lane == b.is_lane).map(piece).collect();
    if is_reversed {
        pieces.reverse();
        for piece in &mut pieces {
            piece.points.reverse();
        }
    }
    pieces
}
