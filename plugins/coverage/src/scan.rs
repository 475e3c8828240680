//! A path over the floor, and the plan made from it.

use crate::floor::{ReachableFloor, SweptFloor};
use crate::scope::Scope;
use crate::slit_domain::SlitDomain;
use crate::tuning::lanes::COMPLETE_WITH_SLIVERS;
use crate::unreachable;
use planner_api::{Ctx, Leg, LegTag, LogLevel, Plan};
use world::{Point, coverage::percent_text, polyline};

/// A piece of a path.
pub(crate) struct Piece {
    pub points: Vec<Point>,
    /// Whether the piece is a lane; otherwise it is a connector.
    pub is_lane: bool,
}

/// A path over the floor.
pub(crate) struct Scan<'a> {
    /// Lanes and connectors in turn.
    pub pieces: Vec<Piece>,
    /// The domain within which the path stays, with the cuts that the path does not cross.
    pub domain: SlitDomain<'a>,
    /// The floor that the path sweeps.
    pub swept: SweptFloor,
}

impl<'a> Scan<'a> {
    /// Creates the scan of a path.
    pub(crate) fn new(pieces: Vec<Piece>, domain: SlitDomain<'a>, floor: ReachableFloor) -> Self {
        let mut scan = Self { pieces, domain, swept: SweptFloor::new(floor) };
        scan.swept.sweep(&scan.path());
        scan
    }

    /// Logs what a plan without touch-ups leaves out. Returns whether the plan is complete except for slivers.
    pub(crate) fn reports_all(&self, scope: &Scope<'_>, ctx: &Ctx<'_>) -> bool {
        let is_all_in_reach = unreachable::report(self, scope, ctx);
        let share = self.swept.coverage_of(&self.swept.floor.clone().within(scope.regions));
        let is_enough = share >= COMPLETE_WITH_SLIVERS;
        if !is_enough {
            let scanned = format!("the plan scans {} % of the requested floor", percent_text(share, 1));
            ctx.log(LogLevel::Warn, &format!("{scanned}: its lanes miss the rest; choose tether-safe"));
        }
        is_enough && is_all_in_reach
    }

    /// The whole path.
    pub(crate) fn path(&self) -> Vec<Point> {
        let mut path: Vec<Point> = Vec::new();
        for point in self.pieces.iter().flat_map(|piece| &piece.points) {
            if path.last().is_none_or(|last| (point - last).norm() > 1e-6) {
                path.push(*point);
            }
        }
        path
    }

    /// The plan from the robot's position. It begins with `retract`, a return path along the cable, which may be empty.
    pub(crate) fn plan(&self, start: Point, retract: &[Point]) -> Plan {
        let mut plan = Plan { path: vec![start], complete: true, ..Plan::default() };
        add_leg(&mut plan, LegTag::Retract, retract);
        let last = self.pieces.len().saturating_sub(1);
        for (k, piece) in self.pieces.iter().enumerate() {
            let tag = match (piece.is_lane, k == 0 || k == last) {
                (true, _) => LegTag::Swath,
                (false, true) => LegTag::Travel,
                (false, false) => LegTag::Connector,
            };
            add_leg(&mut plan, tag, &piece.points);
        }
        plan.cost = polyline::length_m(&plan.path);
        plan.cuts.clone_from(&self.domain.cuts);
        plan
    }
}

fn add_leg(plan: &mut Plan, tag: LegTag, points: &[Point]) {
    let first = plan.path.len() - 1;
    for point in points {
        if (point - plan.path[plan.path.len() - 1]).norm() > 1e-6 {
            plan.path.push(*point);
        }
    }
    let last = plan.path.len() - 1;
    if last > first {
        plan.legs.push(Leg { tag, first, last });
    }
}
