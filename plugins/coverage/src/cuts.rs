//! Cuts: lines from every obstacle outward, so that wall, obstacles and cuts hang together and the rest of the floor
//! is simply connected.
//!
//! A robot that never crosses a cut can take its tether back from anywhere by the way it came or by any other: they
//! are the same to the tether. The cuts form a forest that is rooted at the wall.

use crate::{
    ground::{Ground, direction, middle},
    lanes::Pattern,
    slit::{SNAPPED_M, Slit},
};
use geometry::convex::{Part, crossing};
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
    /// No cut may make the tether longer than this, as far as can be estimated, metres.
    pub cable_m: f64,
}

/// A cut and where it leads.
#[derive(Debug, Clone, PartialEq)]
pub struct Cut {
    /// From the middle of an obstacle to the wall or to the middle of another one.
    pub line: Vec<Point>,
    /// Obstacle it begins at: an index into the groups of obstacles; no obstacle of its own if there is none of it.
    pub from: usize,
}

/// Parts that leave no room between them.
#[derive(Debug, Clone)]
struct Group {
    parts: Vec<usize>,
    foot: Point,
    rho_m: f64,
    is_at_wall: bool,
    /// How far the part at the foot reaches from it, metres.
    reach_m: f64,
    /// From the foot to the wall along the cuts, once they are made.
    chain: Vec<Point>,
}

/// A cut that must not be made: the middle of its obstacle, and where it would end.
type Banned = (Point, Point);

/// Cuts are recomputed at most this often because they sealed off floor.
const TRIES: usize = 12;
/// Floor that may be sealed off: slivers between a cut and the outline of an obstacle, square metres.
const SLIVER_M2: f64 = 0.02;

/// Cuts and what they leave.
pub type Domain = (Vec<Cut>, Slit);

/// Cuts of a ground and the domain that they leave; `None` where there is no room at `home`.
///
/// Where cuts seal floor off, the last one made of those around the pocket has to end somewhere else.
pub fn domain(ground: &Ground, pattern: &Pattern, rule: &CutRule, home: Point) -> Option<Domain> {
    let mut banned: Vec<Banned> = Vec::new();
    let mut best: Option<Domain> = None;
    for _ in 0..TRIES {
        let made = cuts(ground, pattern, rule, &banned);
        let lines: Vec<Vec<Point>> = made.iter().map(|cut| cut.line.clone()).collect();
        let slit = Slit::new(ground, &lines, home)?;
        let guilty = last_at_rim(&made, &slit).map(|cut| (cut.line[0], cut.line[cut.line.len() - 1]));
        if best.as_ref().is_none_or(|(_, other)| slit.sealed_m2 < other.sealed_m2) {
            best = Some((made, slit));
        }
        match guilty {
            Some(guilty) if best.as_ref().is_some_and(|(_, slit)| slit.sealed_m2 > SLIVER_M2) => {
                banned.push(guilty);
            }
            _ => break,
        }
    }
    let (mut made, mut slit) = best?;
    close_up(&mut made, &mut slit);
    Some((made, slit))
}

/// The last cut made of those that keep the robot out of sealed floor.
fn last_at_rim<'a>(made: &'a [Cut], slit: &Slit) -> Option<&'a Cut> {
    let is_at_rim = |cut: &&Cut| {
        let mut rim = slit.sealed_rim.iter();
        rim.any(|p| world::polyline::distance_m(&cut.line, *p) < SNAPPED_M)
    };
    made.iter().rev().find(is_at_rim)
}

/// Adds cuts until the domain is simply connected.
pub fn close_up(made: &mut Vec<Cut>, slit: &mut Slit) {
    made.extend(slit.close_up().into_iter().map(|line| Cut { line, from: usize::MAX }));
}

/// The pieces of a line between the places where it would cross a cut.
pub fn between_cuts(line: &[Point], cuts: &[Cut]) -> Vec<Vec<Point>> {
    let crosses = |a: Point, b: Point| {
        let mut sides = cuts.iter().flat_map(|cut| cut.line.windows(2));
        sides.any(|side| crossing(a, b, side[0], side[1]).is_some())
    };
    line.chunk_by(|a, b| !crosses(*a, *b)).filter(|run| run.len() > 1).map(<[Point]>::to_vec).collect()
}

fn cuts(ground: &Ground, pattern: &Pattern, rule: &CutRule, banned: &[Banned]) -> Vec<Cut> {
    let mut groups = groups(ground);
    let mut order: Vec<usize> = (0..groups.len()).filter(|g| !groups[*g].is_at_wall).collect();
    order.sort_by(|a, b| groups[*b].rho_m.total_cmp(&groups[*a].rho_m).then(a.cmp(b)));
    let mut made: Vec<Cut> = Vec::new();
    for from in order {
        let (line, to) = best_cut(ground, pattern, rule, (&groups, &made, banned), from);
        let mut chain = line.clone();
        chain.extend(to.iter().flat_map(|to| groups[*to].chain.iter().skip(1)));
        groups[from].chain = chain;
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
        let (rho_m, reach_m) = (rho(&last), reach_m(&ground.parts[last]));
        groups.push(Group { parts, foot, rho_m, is_at_wall, reach_m, chain: vec![foot] });
    }
    groups
}

fn are_near(a: &Part, b: &Part, near_m: f64) -> bool {
    (middle(a) - middle(b)).norm() <= reach_m(a) + reach_m(b) + near_m && a.gap(b).width_m < near_m
}

/// How far a part reaches from its middle, metres.
fn reach_m(part: &Part) -> f64 {
    let at = middle(part);
    part.corners().iter().map(|c| (c.0 - at).norm() + c.1).fold(0.0, f64::max)
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
    cost: f64,
}

fn best_cut(
    ground: &Ground,
    pattern: &Pattern,
    rule: &CutRule,
    (groups, made, banned): (&[Group], &[Cut], &[Banned]),
    from: usize,
) -> (Vec<Point>, Option<usize>) {
    let own = &groups[from];
    let outward = (own.foot - ground.anchor).try_normalize(1e-9).unwrap_or_else(Vector::x);
    // Wider and wider, until something goes: a cut there must be.
    for (widen_rad, berth_m) in
        [(0.0, BERTH_M), (0.0, 0.0), (0.5, 0.0), (1.2, -ground.keep_m), (4.0, -ground.keep_m)]
    {
        let alpha_rad = (rule.alpha_rad + widen_rad).min(std::f64::consts::PI);
        let mut all = wall_ends(ground, own, outward, alpha_rad);
        all.extend(lane_end(ground, pattern, own, outward, alpha_rad));
        all.extend(group_ends(ground, own, outward, alpha_rad, groups, from));
        let is_near = |a: Point, b: Point| (a - b).norm() < 0.05;
        let is_banned = |end: Point| banned.iter().any(|no| is_near(no.0, own.foot) && is_near(no.1, end));
        for candidate in &mut all {
            let beyond = candidate.group.map_or(&[][..], |to| &groups[to].chain[1..]);
            let chain: Vec<Point> =
                [own.foot, candidate.end].into_iter().chain(beyond.iter().copied()).collect();
            let excess_m = taut_m(ground.anchor, &chain) - ground.keep_m - rule.cable_m;
            candidate.cost = pattern.broken_lanes(&ground.wall, own.foot, candidate.end, ground.swath_m)
                + COST_PER_M * world::polyline::length_m(&chain)
                + 1e3 * excess_m.max(0.0);
        }
        all.sort_by(|a, b| a.cost.total_cmp(&b.cost));
        for candidate in &all {
            let line = line_to(ground, pattern, groups, made, from, candidate, berth_m);
            if let Some(line) = line.filter(|line| !is_banned(line[line.len() - 1])) {
                return (line, candidate.group);
            }
        }
    }
    let end = own.foot + outward * to_wall_m(&ground.wall, own.foot, outward);
    (vec![own.foot, end], None)
}

/// Length of a taut cable to the far end of a chain of cuts, on the side of the chain where it is longer, metres.
fn taut_m(anchor: Point, chain: &[Point]) -> f64 {
    let along = |side: f64| {
        let mut path = vec![anchor];
        for next in chain {
            // The cable bears on what it leaves on its other side only.
            while let [.., before, last] = path[..] {
                if (last - before).perp(&(next - last)) * side > 0.0 {
                    break;
                }
                path.pop();
            }
            path.push(*next);
        }
        world::polyline::length_m(&path)
    };
    along(1.0).max(along(-1.0))
}

fn wall_ends(ground: &Ground, own: &Group, outward: Vector, alpha_rad: f64) -> Vec<Candidate> {
    let rays = if alpha_rad > 1e-6 { RAYS as i32 } else { 0 };
    (-rays..=rays)
        .map(|k| {
            let angle = alpha_rad * f64::from(k) / f64::from(rays.max(1));
            let ahead = direction(outward.y.atan2(outward.x) + angle);
            let chain_m = to_wall_m(&ground.wall, own.foot, ahead);
            Candidate { end: own.foot + ahead * chain_m, group: None, cost: 0.0 }
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
    is_near.then_some(Candidate { end: own.foot + ahead * chain_m, group: None, cost: 0.0 })
}

/// Cuts to other obstacles further out: within the angle, or where a cut along the ray would come too near to them.
fn group_ends(
    ground: &Ground,
    own: &Group,
    outward: Vector,
    alpha_rad: f64,
    groups: &[Group],
    from: usize,
) -> Vec<Candidate> {
    let is_further = |(index, g): &(usize, &Group)| *index != from && (g.is_at_wall || g.rho_m > own.rho_m);
    let others = groups.iter().enumerate().filter(is_further);
    others
        .filter_map(|(index, group)| {
            let way = group.foot - own.foot;
            let angle = outward.perp(&way).atan2(outward.dot(&way)).abs();
            let beside_m = group.reach_m + ground.keep_m + BERTH_M;
            let in_the_way_rad = (beside_m / way.norm().max(beside_m)).asin();
            (angle <= alpha_rad.max(in_the_way_rad)).then_some(Candidate {
                end: group.foot,
                group: Some(index),
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

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};
    use trials::tanks::{Known, Tank};

    #[test]
    fn a_cable_to_the_end_of_a_straight_chain_is_as_long_as_the_way_there() {
        let chain = [Point::new(3.0, 0.0), Point::new(6.0, 0.0), Point::new(10.0, 0.0)];
        assert!((taut_m(Point::origin(), &chain) - 10.0).abs() < 1e-12);
    }

    /// A round tank without columns, home at its middle.
    fn empty_tank() -> Ground {
        let tank = Tank { columns: Vec::new(), ..Known::E1.tank(1) };
        let obstacles = tank.obstacles();
        Ground::new(&tank.site(&obstacles), Point::origin()).unwrap()
    }

    #[test]
    fn the_cut_that_seals_floor_off_is_found_wherever_it_runs() {
        let ground = empty_tank();
        for k in 0..40 {
            let ahead = direction(0.157 * f64::from(k));
            let across = |at_m: f64| {
                let foot = Point::origin() + ahead * at_m;
                let side = direction(0.157 * f64::from(k) + 1.5);
                Cut { line: vec![foot - side * 30.0, foot + side * 30.0], from: 0 }
            };
            // The one further out keeps nothing out that the first one lets in.
            let made = [across(1.0 + 0.07 * f64::from(k)), across(5.5)];
            let slit = Slit::new(&ground, &[made[0].line.clone()], Point::origin()).unwrap();
            assert!(slit.sealed_m2 > 1.0 && !slit.sealed_rim.is_empty());
            assert_eq!(last_at_rim(&made, &slit), Some(&made[0]), "cut {k}");
        }
    }

    /// Columns in rows, each a little out of place: few gaps are wide enough for the robot.
    fn crowded_tank(seed: u64) -> Tank {
        let mut rng = rand_pcg::Pcg64Mcg::seed_from_u64(seed);
        let places = (-7..=7).flat_map(|row: i32| (-7..=7).map(move |column: i32| (row, column)));
        let at = |(row, column): (i32, i32)| {
            let across_m = (f64::from(column) + 0.5 * f64::from(row % 2)) * 1.2;
            let mut aside_m = || rng.random_range(-0.2..0.2);
            Point::new(across_m + aside_m(), f64::from(row) * 0.87 * 1.2 + aside_m())
        };
        let is_clear = |at: &Point| (0.6..4.1).contains(&at.coords.norm());
        let columns = places.map(at).filter(is_clear).map(|at| (at, 0.2)).collect();
        Tank { boundary: Boundary::Circle { radius_m: 5.0 }, columns, anchor: Point::origin() }
    }

    #[test]
    fn cuts_that_seal_floor_off_are_recomputed_until_they_do_not() {
        for (seed, alpha_rad, cable_m) in
            [(7, 0.0, 1e3), (9, 0.0, 1e3), (11, 0.0, 1e3), (5, 0.9, 7.0), (8, 0.9, 7.0)]
        {
            let tank = crowded_tank(seed);
            let obstacles = tank.obstacles();
            let ground = Ground::new(&tank.site(&obstacles), tank.anchor).unwrap();
            let (pattern, rule) = (Pattern::Contours, CutRule { alpha_rad, cable_m });
            let made = cuts(&ground, &pattern, &rule, &[]);
            let lines: Vec<Vec<Point>> = made.into_iter().map(|cut| cut.line).collect();
            let first = Slit::new(&ground, &lines, ground.home()).unwrap();
            let (_, last) = domain(&ground, &pattern, &rule, ground.home()).unwrap();
            assert!(first.sealed_m2 > SLIVER_M2, "{seed}: {}", first.sealed_m2);
            assert!(last.sealed_m2 <= SLIVER_M2, "{seed}: {}", last.sealed_m2);
        }
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
