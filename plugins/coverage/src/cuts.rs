//! Cuts: lines from every obstacle outward, so that wall, obstacles and cuts hang together and the rest of the floor
//! is simply connected.
//!
//! A robot that never crosses a cut can take its tether back from anywhere by the way it came or by any other: they
//! are the same to the tether. The cuts form a forest that is rooted at the wall.

use crate::{
    ground::{Ground, direction, middle},
    lanes::Pattern,
};
use field::part::{Part, crossing};
use world::{Boundary, Point, Vector};

/// Beyond the distance to keep, a cut stays this far away from obstacles it does not belong to, metres.
const BERTH_M: f64 = 0.05;
/// Rays tried on either side of the ray from the anchor.
const RAYS: usize = 18;
/// Cost of a metre of cut against that of a broken lane.
const COST_PER_M: f64 = 0.08;
/// Obstacles with less room than this between them count as one, metres.
const TOUCHING_M: f64 = 4.0 * crate::ground::SLACK_M;

/// What cuts may look like.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CutRule {
    /// Largest angle between a cut and the ray from the anchor, radians.
    pub alpha_rad: f64,
    /// No cut may make the tether longer than this, as far as can be told, metres.
    pub cable_m: f64,
}

/// A cut and where it leads.
#[derive(Debug, Clone, PartialEq)]
pub struct Cut {
    /// From the middle of an obstacle to the wall or to the middle of another one.
    pub line: Vec<Point>,
    /// Obstacle it begins at: an index into the groups of [`Cuts`].
    pub from: usize,
}

/// Parts that leave no room between them.
#[derive(Debug, Clone)]
struct Group {
    parts: Vec<usize>,
    foot: Point,
    rho_m: f64,
    is_at_wall: bool,
    /// Length from the foot to the wall along the cuts, once they are made.
    chain_m: f64,
}

/// Makes the cuts of a ground.
pub fn cuts(ground: &Ground, pattern: &Pattern, rule: &CutRule) -> Vec<Cut> {
    let mut groups = groups(ground);
    let mut order: Vec<usize> = (0..groups.len()).filter(|g| !groups[*g].is_at_wall).collect();
    order.sort_by(|a, b| groups[*b].rho_m.total_cmp(&groups[*a].rho_m).then(a.cmp(b)));
    let mut made: Vec<Cut> = Vec::new();
    for from in order {
        let (line, chain_m) = best_cut(ground, pattern, rule, &groups, &made, from);
        groups[from].chain_m = chain_m;
        made.push(Cut { line, from });
    }
    made
}

fn groups(ground: &Ground) -> Vec<Group> {
    let n = ground.parts.len();
    let near_m = 2.0 * ground.keep_m + TOUCHING_M;
    let mut of: Vec<usize> = (0..n).collect();
    for a in 0..n {
        for b in 0..a {
            if of[a] != of[b] && are_near(&ground.parts[a], &ground.parts[b], near_m) {
                let (keep, drop) = (of[a].min(of[b]), of[a].max(of[b]));
                of.iter_mut().filter(|g| **g == drop).for_each(|g| *g = keep);
            }
        }
    }
    let mut groups = Vec::new();
    for first in 0..n {
        let parts: Vec<usize> = (0..n).filter(|k| of[*k] == first).collect();
        if parts.is_empty() {
            continue;
        }
        let is_at_wall = parts.iter().any(|k| wall_gap_m(&ground.wall, &ground.parts[*k]) < near_m);
        let rho = |k: &usize| (middle(&ground.parts[*k]) - ground.anchor).norm();
        let last = parts.iter().copied().max_by(|a, b| rho(a).total_cmp(&rho(b))).expect("not empty");
        let foot = middle(&ground.parts[last]);
        groups.push(Group { parts, foot, rho_m: rho(&last), is_at_wall, chain_m: 0.0 });
    }
    groups
}

fn are_near(a: &Part, b: &Part, near_m: f64) -> bool {
    let reach = |part: &Part| {
        let at = middle(part);
        part.corners().iter().map(|c| (c.0 - at).norm() + c.1).fold(0.0, f64::max)
    };
    (middle(a) - middle(b)).norm() <= reach(a) + reach(b) + near_m && a.gap(b).width_m < near_m
}

fn wall_gap_m(wall: &Boundary, part: &Part) -> f64 {
    let corners = part.corners();
    let ends = corners.iter().map(|c| wall.wall_distance_m(c.0) - c.1).fold(f64::INFINITY, f64::min);
    let Boundary::Polygon { vertices } = wall else { return ends };
    let edges = vertices.iter().zip(vertices.iter().cycle().skip(1));
    edges.map(|(a, b)| part.segment_distance_m(*a, *b)).fold(ends, f64::min)
}

/// One way to end a cut.
struct Candidate {
    end: Point,
    group: Option<usize>,
    chain_m: f64,
    cost: f64,
}

fn best_cut(
    ground: &Ground,
    pattern: &Pattern,
    rule: &CutRule,
    groups: &[Group],
    made: &[Cut],
    from: usize,
) -> (Vec<Point>, f64) {
    let own = &groups[from];
    let outward = (own.foot - ground.anchor).try_normalize(1e-9).unwrap_or_else(Vector::x);
    // Wider and wider, until something goes: a cut there must be.
    for (widen_rad, berth_m) in
        [(0.0, BERTH_M), (0.0, 0.0), (0.5, 0.0), (1.2, -ground.keep_m), (4.0, -ground.keep_m)]
    {
        let alpha_rad = (rule.alpha_rad + widen_rad).min(std::f64::consts::PI);
        let mut all = wall_ends(ground, own, outward, alpha_rad);
        all.extend(lane_end(ground, pattern, own, outward, alpha_rad));
        all.extend(group_ends(own, outward, alpha_rad, groups, from));
        for candidate in &mut all {
            let excess_m = own.rho_m + candidate.chain_m - rule.cable_m;
            candidate.cost = pattern.broken_lanes(&ground.wall, own.foot, candidate.end, ground.swath_m)
                + COST_PER_M * candidate.chain_m
                + 1e3 * excess_m.max(0.0);
        }
        all.sort_by(|a, b| a.cost.total_cmp(&b.cost));
        for candidate in &all {
            if let Some(line) = line_to(ground, pattern, groups, made, from, candidate, berth_m) {
                return (line, candidate.chain_m);
            }
        }
    }
    let end = own.foot + outward * to_wall_m(&ground.wall, own.foot, outward);
    (vec![own.foot, end], (end - own.foot).norm())
}

fn wall_ends(ground: &Ground, own: &Group, outward: Vector, alpha_rad: f64) -> Vec<Candidate> {
    let rays = if alpha_rad > 1e-6 { RAYS as i32 } else { 0 };
    (-rays..=rays)
        .map(|k| {
            let angle = alpha_rad * f64::from(k) / f64::from(rays.max(1));
            let ahead = direction(outward.y.atan2(outward.x) + angle);
            let chain_m = to_wall_m(&ground.wall, own.foot, ahead);
            Candidate { end: own.foot + ahead * chain_m, group: None, chain_m, cost: 0.0 }
        })
        .collect()
}

/// The cut along the lanes.
fn lane_end(
    ground: &Ground,
    pattern: &Pattern,
    own: &Group,
    outward: Vector,
    alpha_rad: f64,
) -> Option<Candidate> {
    let lane = pattern.ahead()?;
    let ahead = if lane.dot(&outward) < 0.0 { -lane } else { lane };
    let chain_m = to_wall_m(&ground.wall, own.foot, ahead);
    let is_near = outward.perp(&ahead).atan2(outward.dot(&ahead)).abs() <= alpha_rad;
    is_near.then_some(Candidate { end: own.foot + ahead * chain_m, group: None, chain_m, cost: 0.0 })
}

fn group_ends(own: &Group, outward: Vector, alpha_rad: f64, groups: &[Group], from: usize) -> Vec<Candidate> {
    let is_further = |(index, g): &(usize, &Group)| *index != from && (g.is_at_wall || g.rho_m > own.rho_m);
    let others = groups.iter().enumerate().filter(is_further);
    others
        .filter_map(|(index, group)| {
            let way = group.foot - own.foot;
            let angle = outward.perp(&way).atan2(outward.dot(&way)).abs();
            let chain_m = way.norm() + group.chain_m;
            (angle <= alpha_rad.max(0.09)).then_some(Candidate {
                end: group.foot,
                group: Some(index),
                chain_m,
                cost: 0.0,
            })
        })
        .collect()
}

/// The cut to an end, if nothing is in its way.
fn line_to(
    ground: &Ground,
    pattern: &Pattern,
    groups: &[Group],
    made: &[Cut],
    from: usize,
    to: &Candidate,
    berth_m: f64,
) -> Option<Vec<Point>> {
    let foot = groups[from].foot;
    let mut line = vec![foot];
    if let (None, Some(bend)) = (to.group, pattern.bend(foot, to.end)) {
        line.push(bend);
        let ahead = (to.end - foot).normalize();
        line.push(bend + ahead * to_wall_m(&ground.wall, bend, ahead));
    } else {
        line.push(to.end);
    }
    let joined = |group: usize| group == from || Some(group) == to.group;
    let others = groups.iter().enumerate().filter(|(index, _)| !joined(*index)).flat_map(|(_, g)| &g.parts);
    let parts: Vec<&Part> = others.map(|k| &ground.parts[*k]).collect();
    let keep_m = ground.keep_m + berth_m;
    let is_clear =
        |pair: &[Point]| parts.iter().all(|part| part.segment_distance_m(pair[0], pair[1]) > keep_m);
    let crosses = |pair: &[Point]| {
        made.iter().filter(|cut| Some(cut.from) != to.group).any(|cut| {
            cut.line.windows(2).any(|other| crossing(pair[0], pair[1], other[0], other[1]).is_some())
        })
    };
    line.windows(2).all(|pair| is_clear(pair) && !crosses(pair)).then_some(line)
}

/// Way from a place to the wall, metres.
pub fn to_wall_m(wall: &Boundary, from: Point, ahead: Vector) -> f64 {
    match wall {
        Boundary::Circle { radius_m } => {
            let along = from.coords.dot(&ahead);
            let square = along * along + radius_m * radius_m - from.coords.norm_squared();
            square.max(0.0).sqrt() - along
        }
        Boundary::Polygon { vertices } => {
            let (low, high) = wall.bounds();
            let far_m = (high - low).norm() * 2.0;
            let edges = vertices.iter().zip(vertices.iter().cycle().skip(1));
            let hits = edges.filter_map(|(a, b)| crossing(from, from + ahead * far_m, *a, *b));
            hits.map(|hit| (hit - from).norm()).fold(far_m, f64::min)
        }
    }
}
