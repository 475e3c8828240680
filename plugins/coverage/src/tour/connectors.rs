//! Connectors between lanes: shortest paths in the slit domain, computed when first needed.

use crate::lanes::Lane;
use crate::plane::Course;
use crate::slit_domain::{SlitDomain, Spot};
use crate::tour::costs::{Costs, End};
use std::cell::RefCell;
use world::{Point, Vector};

/// Connectors between the ends of lanes, home and start, and their costs in metres and turns.
pub(crate) struct Connectors<'a> {
    domain: &'a SlitDomain<'a>,
    ends: Vec<LaneEnd>,
    turn_m_per_rad: f64,
    costs: RefCell<Costs>,
}

struct LaneEnd {
    at: Point,
    spot: Option<Spot>,
    /// The heading at which the robot leaves the lane at this end; `None` at home and start.
    out: Option<Vector>,
}

impl<'a> Connectors<'a> {
    /// Creates the connectors between some lanes. Known costs may come from earlier connectors between the first of
    /// these lanes, with the same home and start.
    pub(crate) fn new(
        domain: &'a SlitDomain<'a>,
        lanes: &[Lane],
        (home, start): (Point, Point),
        turn_m_per_rad: f64,
        known: Costs,
    ) -> Self {
        let end = |at: Point, out: Option<Vector>| LaneEnd { at, spot: domain.spot(at), out };
        let leaving = |at: Point, before: Point| end(at, (at - before).try_normalize(1e-9));
        let of_lane = |p: &Lane| [leaving(p[0], p[1]), leaving(p[p.len() - 1], p[p.len() - 2])];
        let ends: Vec<LaneEnd> =
            lanes.iter().flat_map(of_lane).chain([end(home, None), end(start, None)]).collect();
        let costs = RefCell::new(known.with_ends(ends.len()));
        Self { domain, ends, turn_m_per_rad, costs }
    }

    pub(crate) fn into_costs(self) -> Costs {
        self.costs.into_inner()
    }

    pub(super) fn len(&self) -> usize {
        self.ends.len()
    }

    pub(super) fn at(&self, end: End) -> Point {
        self.ends[end].at
    }

    /// The path from one end to another.
    pub(crate) fn path(&self, u: End, v: End) -> Vec<Point> {
        match (self.ends[u].spot, self.ends[v].spot) {
            (Some(from), Some(to)) => self.domain.path_between(from, to),
            _ => vec![self.at(u), self.at(v)],
        }
    }

    /// A lower bound for the cost of a connector.
    pub(super) fn least(&self, u: End, v: End) -> f64 {
        (self.at(u) - self.at(v)).norm()
    }

    /// The cost of leaving a lane at `u` and entering another at `v`, metres; the same in both directions.
    pub(super) fn cost(&self, u: End, v: End) -> f64 {
        let (u, v) = (u.min(v), u.max(v));
        let known = self.costs.borrow().get(u, v);
        f64::from(known.unwrap_or_else(|| {
            let entering = self.ends[v].out.map(|out| -out);
            let course = Course::of(self.ends[u].out, &self.path(u, v), entering);
            let cost = (course.length_m + self.turn_m_per_rad * course.turn_rad) as f32;
            self.costs.borrow_mut().set(u, v, cost);
            cost
        }))
    }
}
