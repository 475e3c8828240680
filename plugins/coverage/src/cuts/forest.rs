//! The forest of cuts: one cut from every cluster of obstacles, starting with the outermost.

use crate::cuts::cluster::Cluster;
use crate::pattern::Pattern;
use crate::plane::{direction, meets};
use crate::tuning::cuts::{BERTH_M, COST_PER_M, EXCESS_COST_PER_M, RAYS};
use crate::workspace::Workspace;
use geometry::convex::{Part, crossing};
use std::f64::consts::PI;
use world::{Boundary, Point, Vector, polyline};

/// Limits on cuts.
pub(crate) struct CutRule {
    /// Largest angle between a cut and the ray from the anchor, radians.
    pub alpha_rad: f64,
    /// Maximum estimated tether length that a cut may cause, metres.
    pub cable_m: f64,
}

/// A cut that must not be made: its start and its end.
pub(super) struct Ban(Point, Point);

impl Ban {
    pub(super) fn of(cut: &[Point]) -> Self {
        Self(cut[0], cut[cut.len() - 1])
    }

    fn hits(&self, foot: Point, end: Point) -> bool {
        (self.0 - foot).norm() < 0.05 && (self.1 - end).norm() < 0.05
    }
}

/// The cuts of a workspace, outermost first; each begins at the foot of its cluster.
pub(super) fn cuts(
    workspace: &Workspace,
    pattern: &Pattern,
    rule: &CutRule,
    bans: &[Ban],
) -> Vec<Vec<Point>> {
    let clusters = Cluster::all(workspace);
    let mut order: Vec<usize> = (0..clusters.len()).filter(|k| !clusters[*k].is_at_wall).collect();
    order.sort_by(|a, b| clusters[*b].rho_m.total_cmp(&clusters[*a].rho_m).then(a.cmp(b)));
    let mut forest = Forest { workspace, pattern, rule, bans, clusters, made: Vec::new() };
    for from in order {
        forest.grow(from);
    }
    forest.made.into_iter().map(|(_, line)| line).collect()
}

struct Forest<'a> {
    workspace: &'a Workspace,
    pattern: &'a Pattern,
    rule: &'a CutRule,
    bans: &'a [Ban],
    clusters: Vec<Cluster>,
    /// The cuts made so far, each with the cluster where it begins.
    made: Vec<(usize, Vec<Point>)>,
}

/// A possible end of a cut: at the wall, or at the foot of another cluster.
struct Target {
    end: Point,
    cluster: Option<usize>,
    /// Cost, expressed as a number of broken lanes: the lanes that the cut breaks, plus a price for the length of the
    /// cuts to the wall and for the excess cable that they cause.
    cost: f64,
}

impl Forest<'_> {
    /// Makes the cut for a cluster.
    fn grow(&mut self, from: usize) {
        let (line, to) = self.best_cut(from);
        let beyond = to.map_or(&[][..], |to| &self.clusters[to].chain[1..]);
        self.clusters[from].chain = [&line, beyond].concat();
        self.made.push((from, line));
    }

    /// The cut of lowest cost, and the cluster at its end; `None` if it ends at the wall.
    fn best_cut(&self, from: usize) -> (Vec<Point>, Option<usize>) {
        let foot = self.clusters[from].foot;
        let outward = (foot - self.workspace.anchor).try_normalize(1e-9).unwrap_or_else(Vector::x);
        // Try wider and wider angles and, finally, lines too close to other obstacles: every cluster must get a cut.
        let keep_m = self.workspace.keep_m;
        for (widen_rad, berth_m) in [(0.0, BERTH_M), (0.0, 0.0), (0.5, 0.0), (1.2, -keep_m), (4.0, -keep_m)] {
            let alpha_rad = (self.rule.alpha_rad + widen_rad).min(PI);
            let mut targets = self.targets(from, outward, alpha_rad);
            targets.sort_by(|a, b| a.cost.total_cmp(&b.cost));
            for to in targets {
                let line = self.line_to(from, &to, berth_m);
                let is_banned = |end: Point| self.bans.iter().any(|ban| ban.hits(foot, end));
                if let Some(line) = line.filter(|line| !is_banned(line[line.len() - 1])) {
                    return (line, to.cluster);
                }
            }
        }
        (vec![foot, self.at_wall(foot, outward)], None)
    }

    fn at_wall(&self, foot: Point, ahead: Vector) -> Point {
        foot + ahead * to_wall_m(&self.workspace.wall, foot, ahead)
    }

    fn target(&self, foot: Point, end: Point, cluster: Option<usize>) -> Target {
        let beyond = cluster.map_or(&[][..], |to| &self.clusters[to].chain[1..]);
        let chain = [&[foot, end], beyond].concat();
        let Workspace { wall, anchor, keep_m, swath_m, .. } = self.workspace;
        let excess_m = taut_m(*anchor, &chain) - keep_m - self.rule.cable_m;
        let cost = self.pattern.broken_lanes(wall, foot, end, *swath_m)
            + COST_PER_M * polyline::length_m(&chain)
            + EXCESS_COST_PER_M * excess_m.max(0.0);
        Target { end, cluster, cost }
    }

    /// The possible ends of a cut within an angle of the outward ray: at the wall, along the lanes, and at other
    /// clusters.
    fn targets(&self, from: usize, outward: Vector, alpha_rad: f64) -> Vec<Target> {
        let foot = self.clusters[from].foot;
        let off_rad = |way: Vector| outward.perp(&way).atan2(outward.dot(&way)).abs();
        let rays = if alpha_rad > 1e-6 { RAYS as i32 } else { 0 };
        let angle_rad = |k: i32| alpha_rad * f64::from(k) / f64::from(rays.max(1));
        let fan = (-rays..=rays).map(|k| direction(outward.y.atan2(outward.x) + angle_rad(k)));
        let outward_along = |lane: Vector| if lane.dot(&outward) < 0.0 { -lane } else { lane };
        let along_lanes =
            self.pattern.ahead().map(outward_along).filter(|ahead| off_rad(*ahead) <= alpha_rad);
        let at_wall = |ahead: Vector| self.target(foot, self.at_wall(foot, ahead), None);
        let mut targets: Vec<Target> = fan.chain(along_lanes).map(at_wall).collect();
        for (k, other) in self.clusters_further_out(from) {
            let way = other.foot - foot;
            // A larger angle is allowed if a cut along the ray would pass too close to the other cluster.
            let beside_m = other.reach_m + self.workspace.keep_m + BERTH_M;
            let in_the_way_rad = (beside_m / way.norm().max(beside_m)).asin();
            if off_rad(way) <= alpha_rad.max(in_the_way_rad) {
                targets.push(self.target(foot, other.foot, Some(k)));
            }
        }
        targets
    }

    fn clusters_further_out(&self, from: usize) -> impl Iterator<Item = (usize, &Cluster)> {
        let rho_m = self.clusters[from].rho_m;
        let others = self.clusters.iter().enumerate().filter(move |(k, _)| *k != from);
        others.filter(move |(_, other)| other.is_at_wall || other.rho_m > rho_m)
    }

    /// The cut to a target, if nothing is in its way.
    fn line_to(&self, from: usize, to: &Target, berth_m: f64) -> Option<Vec<Point>> {
        let foot = self.clusters[from].foot;
        let line = match self.pattern.bend(foot, to.end).filter(|_| to.cluster.is_none()) {
            Some(bend) => vec![foot, bend, self.at_wall(bend, (to.end - foot).normalize())],
            None => vec![foot, to.end],
        };
        let is_joined = |cluster: usize| cluster == from || Some(cluster) == to.cluster;
        let others = self.clusters.iter().enumerate().filter(|(k, _)| !is_joined(*k));
        let parts: Vec<&Part> =
            others.flat_map(|(_, other)| &other.parts).map(|k| &self.workspace.parts[*k]).collect();
        let far_m = self.workspace.keep_m + berth_m;
        let is_clear = |a: Point, b: Point| parts.iter().all(|part| part.segment_distance_m(a, b) > far_m);
        let is_crossed =
            |(cluster, cut): &(usize, Vec<Point>), a, b| Some(*cluster) != to.cluster && meets(cut, a, b);
        let crosses = |a: Point, b: Point| self.made.iter().any(|made| is_crossed(made, a, b));
        line.windows(2).all(|side| is_clear(side[0], side[1]) && !crosses(side[0], side[1])).then_some(line)
    }
}

/// The distance from a point to the wall straight ahead, metres.
pub(super) fn to_wall_m(wall: &Boundary, from: Point, ahead: Vector) -> f64 {
    match wall {
        Boundary::Circle { radius_m } => {
            let along = from.coords.dot(&ahead);
            let square = along * along + radius_m * radius_m - from.coords.norm_squared();
            square.max(0.0).sqrt() - along
        }
        Boundary::Polygon { vertices } => {
            let (low, high) = wall.bounds();
            let far_m = (high - low).norm() * 2.0;
            let hits =
                polyline::edges(vertices).filter_map(|(a, b)| crossing(from, from + ahead * far_m, a, b));
            hits.map(|hit| (hit - from).norm()).fold(far_m, f64::min)
        }
    }
}

/// The length of a taut cable to the far end of a chain of cuts, along the longer side of the chain, metres.
///
/// The sum of the links would be too long: at bends, the cable takes the short cut on the open side.
pub(super) fn taut_m(anchor: Point, chain: &[Point]) -> f64 {
    let along = |side: f64| {
        let mut path = vec![anchor];
        for next in chain {
            // The cable bears on an obstacle only where the chain bends towards this side.
            while let [.., before, last] = path[..] {
                if (last - before).perp(&(next - last)) * side > 0.0 {
                    break;
                }
                path.pop();
            }
            path.push(*next);
        }
        polyline::length_m(&path)
    };
    along(1.0).max(along(-1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cable_to_the_end_of_a_straight_chain_is_as_long_as_the_way_there() {
        let chain = [Point::new(3.0, 0.0), Point::new(6.0, 0.0), Point::new(10.0, 0.0)];
        assert!((taut_m(Point::origin(), &chain) - 10.0).abs() < 1e-12);
    }

    #[test]
    fn a_cable_bears_on_the_inner_obstacle_only_where_the_chain_bends_once() {
        let chain = [Point::new(3.0, 0.0), Point::new(4.0, 2.0), Point::new(8.0, 6.0)];
        let expected = 3.0 + 5.0_f64.sqrt() + 32.0_f64.sqrt();
        assert!(taut_m(Point::origin(), &chain) <= expected);
        let straight = 3.0 + (chain[2] - chain[0]).norm();
        assert!((taut_m(Point::origin(), &chain) - straight).abs() < 1e-9);
    }
}
