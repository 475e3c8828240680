//! Proves that no path leads from one place to another: finds a closed chain of solids between which the hull does not
//! fit.
//!
//! The forbidden area is the union of all solids, each grown by its clearance. Where two grown solids overlap, a line
//! from one to the other is inside the union. Two places are separated if and only if such lines form a closed curve
//! that encloses one place and not the other. A straight line between the places crosses such a curve more often in one
//! direction than in the other. Counting crossings along a spanning tree finds the curve without trying all curves.

use geometry::{convex::Part, polyline::edges};
use planner_api::Site;
use std::collections::{BTreeSet, VecDeque};
use steering::{Keep, solid_parts};
use world::{Boundary, Point, Vector};

/// Maximum number of solids of a site that is examined.
const MOST_PARTS: usize = 3000;
/// Rounding margin by which solids must overlap to close a gap, metres.
const ROUNDING_M: f64 = 1e-9;

/// The elements of a ring.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Ring {
    /// Ids of the obstacles and no-go zones in the ring, ascending.
    pub obstacles: Vec<u32>,
    /// Whether the wall is part of the ring.
    pub has_wall: bool,
}

/// A solid, grown by its clearance.
#[derive(Debug)]
enum Node {
    Obstacle {
        id: u32,
        part: Part,
    },
    /// A straight section of the wall.
    Wall {
        part: Part,
    },
    /// An entire round wall.
    RoundWall,
}

/// A line between two overlapping nodes, from the first to the second.
#[derive(Debug, Clone, Copy)]
struct Link {
    to: usize,
    /// How often the link crosses the line between the two places from left to right, minus how often from right to
    /// left.
    crossings: i32,
}

/// Returns the ring that separates two places for a hull that keeps these distances, if there is one.
///
/// The result is exact, except for solids that touch to within a billionth of a metre. With more than 3,000 parts it is
/// always `None`.
pub(crate) fn between(site: &Site<'_>, keep: Keep, a: Point, b: Point) -> Option<Ring> {
    let nodes = nodes(site);
    if nodes.len() > MOST_PARTS {
        return None;
    }
    let links = links(&nodes, keep, &site.boundary.to_owned(), (a, b));
    let chain = odd_cycle(&links)?;
    let id = |node: &usize| if let Node::Obstacle { id, .. } = nodes[*node] { Some(id) } else { None };
    let obstacles: BTreeSet<u32> = chain.iter().filter_map(id).collect();
    let has_wall = chain.iter().any(|node| id(node).is_none());
    Some(Ring { obstacles: obstacles.into_iter().collect(), has_wall })
}

fn nodes(site: &Site<'_>) -> Vec<Node> {
    let mut nodes: Vec<Node> = solid_parts(site).map(|(id, part)| Node::Obstacle { id, part }).collect();
    match site.boundary.to_owned() {
        Boundary::Circle { .. } => nodes.push(Node::RoundWall),
        Boundary::Polygon { vertices } => {
            nodes.extend(edges(&vertices).map(|(a, b)| Node::Wall { part: Part::segment(a, b) }));
        }
    }
    nodes
}

impl Node {
    fn part(&self, keep: Keep) -> Option<(&Part, f64)> {
        match self {
            Self::Obstacle { part, .. } => Some((part, keep.obstacle_m)),
            Self::Wall { part } => Some((part, keep.wall_m)),
            Self::RoundWall => None,
        }
    }
}

/// Returns the links from every node to the others.
fn links(nodes: &[Node], keep: Keep, wall: &Boundary, (a, b): (Point, Point)) -> Vec<Vec<Link>> {
    let mut links: Vec<Vec<Link>> = nodes.iter().map(|_| Vec::new()).collect();
    let mut add = |i: usize, j: usize, line: &[Point]| {
        let crossings: i32 = line.windows(2).map(|w| crossing(a, b, w[0], w[1])).sum();
        links[i].push(Link { to: j, crossings });
        links[j].push(Link { to: i, crossings: -crossings });
    };
    for (i, node) in nodes.iter().enumerate() {
        let Some((part, keep_m)) = node.part(keep) else { continue };
        for (j, other) in nodes.iter().enumerate().skip(i + 1) {
            match (other.part(keep), wall) {
                (Some((other, other_keep_m)), _) => {
                    let gap = part.gap(other);
                    if gap.width_m < keep_m + other_keep_m - ROUNDING_M {
                        add(i, j, &[part.middle(), gap.from, gap.to, other.middle()]);
                    }
                }
                (None, Boundary::Circle { radius_m }) => {
                    let (outermost, reach_m) = outermost(part);
                    if outermost.coords.norm() + reach_m + keep_m > radius_m - keep.wall_m + ROUNDING_M {
                        let out = outermost.coords.try_normalize(1e-12).unwrap_or_else(Vector::x);
                        add(i, j, &[part.middle(), outermost, Point::from(out * (radius_m * 2.0))]);
                    }
                }
                (None, Boundary::Polygon { .. }) => {}
            }
        }
    }
    links
}

/// Returns the corner or end of a part that is furthest from the centre of the tank, and how far the part extends
/// beyond that point.
fn outermost(part: &Part) -> (Point, f64) {
    let furthest = |points: &[Point]| {
        let by_radius = |p: &&Point, q: &&Point| p.coords.norm().total_cmp(&q.coords.norm());
        points.iter().max_by(by_radius).copied().unwrap_or_else(|| part.middle())
    };
    match part {
        Part::Capsule { a, b, half_width_m } => (furthest(&[*a, *b]), *half_width_m),
        Part::Polygon { vertices } => (furthest(vertices), 0.0),
    }
}

/// Whether a line segment crosses the line from `a` to `b`: 1 from left to right, -1 from right to left, otherwise 0.
fn crossing(a: Point, b: Point, from: Point, to: Point) -> i32 {
    let is_left = |p: Point, q: Point, r: Point| (q - p).perp(&(r - p)) >= 0.0;
    let sides = (is_left(a, b, from), is_left(a, b, to));
    if sides.0 == sides.1 || is_left(from, to, a) == is_left(from, to, b) {
        return 0;
    }
    if sides.0 { 1 } else { -1 }
}

/// Returns a closed chain of nodes with crossings that do not add up to zero.
fn odd_cycle(links: &[Vec<Link>]) -> Option<Vec<usize>> {
    let mut sums: Vec<Option<i32>> = vec![None; links.len()];
    let mut parents: Vec<usize> = (0..links.len()).collect();
    for root in 0..links.len() {
        if sums[root].is_some() {
            continue;
        }
        sums[root] = Some(0);
        let mut open = VecDeque::from([(root, 0)]);
        while let Some((node, sum)) = open.pop_front() {
            for link in &links[node] {
                match sums[link.to] {
                    None => {
                        sums[link.to] = Some(sum + link.crossings);
                        parents[link.to] = node;
                        open.push_back((link.to, sum + link.crossings));
                    }
                    Some(known) if known != sum + link.crossings => {
                        return Some(closed_chain(&parents, node, link.to));
                    }
                    Some(_) => {}
                }
            }
        }
    }
    None
}

/// Joins the paths from two nodes up the tree at the node where they meet.
fn closed_chain(parents: &[usize], a: usize, b: usize) -> Vec<usize> {
    let up = |node: usize| {
        std::iter::successors(Some(node), |node| Some(parents[*node]).filter(|parent| parent != node))
    };
    let of_a: Vec<usize> = up(a).collect();
    let of_b: Vec<usize> = up(b).collect();
    let meet = of_b.iter().find(|node| of_a.contains(node)).copied();
    let until =
        |way: &[usize]| way.iter().copied().take_while(|node| Some(*node) != meet).collect::<Vec<_>>();
    let mut chain = until(&of_a);
    chain.extend(meet);
    chain.extend(until(&of_b));
    chain
}

#[cfg(test)]
mod tests {
    use super::*;
    use planner_api::{Motion, Obstacle};
    use proptest::prelude::*;
    use std::f64::consts::TAU;
    use trials::spiral::Layout;

    const KEEP: Keep = Keep { obstacle_m: 0.3, wall_m: 0.0 };

    fn layout(columns: Vec<(Point, f64)>) -> Layout {
        Layout { columns, ..Layout::of_the_paper(0, 0, false) }
    }

    fn between_in(layout: &Layout, a: Point, b: Point) -> Option<Ring> {
        let obstacles: Vec<Obstacle<'_>> = layout.obstacles();
        between(&layout.site(&obstacles, Motion::Point), KEEP, a, b)
    }

    fn circle(n_points: u32, radius_m: f64) -> Vec<(Point, f64)> {
        let angles = (0..n_points).map(|k| f64::from(k) * TAU / f64::from(n_points));
        angles.map(|a| (Point::new(radius_m * a.cos(), radius_m * a.sin()), 0.0)).collect()
    }

    #[test]
    fn a_ring_keeps_inside_and_outside_apart_and_nothing_else() {
        let ring = layout(circle(44, 4.0));
        let found = between_in(&ring, Point::new(9.0, 0.0), Point::origin()).expect("a ring");
        assert!(found.obstacles.len() == 44 && !found.has_wall, "{found:?}");
        assert_eq!(between_in(&ring, Point::new(9.0, 0.0), Point::new(-9.0, 0.1)), None);
        assert_eq!(between_in(&ring, Point::new(1.0, 0.0), Point::new(-1.0, 0.1)), None);
    }

    #[test]
    fn a_ring_with_one_gap_closes_nothing_off() {
        let mut columns = circle(44, 4.0);
        columns.remove(7);
        assert_eq!(between_in(&layout(columns), Point::new(9.0, 0.0), Point::origin()), None);
    }

    #[test]
    fn columns_and_wall_close_off_a_niche() {
        let columns = vec![
            (Point::new(9.75, 0.5), 0.0),
            (Point::new(9.3, 0.3), 0.0),
            (Point::new(9.2, -0.1), 0.0),
            (Point::new(9.5, -0.5), 0.0),
            (Point::new(9.8, -0.7), 0.0),
        ];
        let niche = layout(columns);
        let found = between_in(&niche, Point::new(9.8, 0.0), Point::origin()).expect("a ring");
        assert!(found.has_wall && found.obstacles.len() >= 4, "{found:?}");
        assert_eq!(between_in(&niche, Point::new(9.0, 3.0), Point::origin()), None);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(48))]
        #[test]
        fn it_agrees_with_a_flood_of_small_cells(
            columns in prop::collection::vec((-2.0..2.0_f64, -2.0..2.0_f64), 8..30),
            at in (-1.3..1.3_f64, -1.3..1.3_f64),
        ) {
            let tank = Layout { radius_m: 2.0, ..layout(columns.iter().map(|(x, y)| (Point::new(*x, *y), 0.0)).collect()) };
            let at = Point::new(at.0, at.1);
            // For some clearances between these, the cells are too coarse to decide.
            let (reached_wide, reached_narrow) = (flood(&tank, 0.33, at), flood(&tank, 0.22, at));
            for (goal, wide, narrow) in reached_wide.into_iter().zip(reached_narrow).map(|((p, w), (_, n))| (p, w, n)) {
                let least_m = clear_m(&tank, goal).min(clear_m(&tank, at));
                if least_m < 0.33 || goal.coords.norm() > tank.radius_m {
                    continue; }
                let apart = between_in(&tank, at, goal).is_some();
                prop_assert!(!(wide && apart), "{goal} can be reached");
                prop_assert!(narrow || apart, "{goal} cannot be reached");
            }
        }
    }

    fn clear_m(tank: &Layout, at: Point) -> f64 {
        tank.columns.iter().map(|(c, _)| (at - c).norm()).fold(f64::INFINITY, f64::min)
    }

    /// Places, and whether each can be reached in moves of 2 cm that keep this distance.
    fn flood(tank: &Layout, keep_m: f64, from: Point) -> Vec<(Point, bool)> {
        const N: i32 = 100;
        let place = |(x, y): (i32, i32)| from + Vector::new(f64::from(x), f64::from(y)) * 0.04;
        let is_free = |cell: (i32, i32)| {
            place(cell).coords.norm() <= tank.radius_m && clear_m(tank, place(cell)) >= keep_m
        };
        let mut seen: BTreeSet<(i32, i32)> = BTreeSet::from([(0, 0)]);
        let mut open: Vec<(i32, i32)> = vec![(0, 0)];
        while let Some((x, y)) = open.pop() {
            for cell in [(x + 1, y), (x - 1, y), (x, y + 1), (x, y - 1)] {
                if cell.0.abs() < N && cell.1.abs() < N && is_free(cell) && seen.insert(cell) {
                    open.push(cell);
                }
            }
        }
        let goals = (-10..10).flat_map(|x| (-10..10).map(move |y| (x * 10, y * 10)));
        goals.map(|cell| (place(cell), seen.contains(&cell))).collect()
    }
}
