//! The faces enclosed by lines that cross or meet.
//!
//! Lines are cut where other lines cross them or end at them, loose ends are removed, and each face is traced along its
//! half edges.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use world::{
    Point,
    shape::{bounds_of, ring_area_m2},
};

/// Distance, in metres, below which points are merged: in a drawing, a seam may end slightly short of another seam, or
/// slightly beyond it.
const SAME_M: f64 = 5e-3;
/// The largest number of straight pieces that are compared with each other.
const MOST_PIECES: usize = 20_000;
/// Length, in metres, above which the remainder of a line beyond the last line that it meets counts as a loose line.
const LOOSE_M: f64 = 0.1;

type Piece = [Point; 2];

/// The faces that lines enclose.
#[derive(Debug, PartialEq, Default)]
pub(super) struct Faces {
    /// Counter-clockwise outlines. If a face has an island, its outline ignores the hole.
    pub rings: Vec<Vec<Point>>,
    /// The number of straight pieces that do not end at another line, and so divide no floor.
    pub n_loose: usize,
}

/// Finds the faces that lines enclose; `None` if the lines have more than [`MOST_PIECES`] pieces.
pub(super) fn faces(lines: &[Vec<Point>]) -> Option<Faces> {
    let pieces: Vec<Piece> =
        lines.iter().flat_map(|line| line.windows(2)).map(|ends| [ends[0], ends[1]]).collect();
    if pieces.len() > MOST_PIECES {
        return None;
    }
    let cuts = cuts(&pieces);
    let mut nodes = Nodes::default();
    // Register drawn points before computed ones, so that they take precedence.
    let ends: Vec<[usize; 2]> = pieces.iter().map(|piece| piece.map(|end| nodes.at(end))).collect();
    let mut graph = Graph::default();
    for (([from, to], piece), cuts) in ends.iter().zip(&pieces).zip(cuts) {
        let inner = cuts.iter().map(|share| nodes.at(piece[0] + (piece[1] - piece[0]) * *share));
        let path: Vec<usize> = std::iter::once(*from).chain(inner).chain([*to]).collect();
        path.windows(2).for_each(|ends| graph.join(ends[0], ends[1]));
    }
    let n_loose = graph.prune(&nodes.places);
    Some(Faces { rings: graph.rings(&nodes.places), n_loose })
}

/// The positions at which each piece is cut, as shares of the piece's length, ascending.
fn cuts(pieces: &[Piece]) -> Vec<Vec<f64>> {
    let boxes: Vec<(Point, Point)> = pieces.iter().map(|piece| bounds_of(piece)).collect();
    let mut from_west: Vec<usize> = (0..pieces.len()).collect();
    from_west.sort_by(|a, b| boxes[*a].0.x.total_cmp(&boxes[*b].0.x));
    let mut cuts = vec![Vec::new(); pieces.len()];
    for (k, one) in from_west.iter().enumerate() {
        let (low, high) = boxes[*one];
        let near = from_west[k + 1..].iter().take_while(|other| boxes[**other].0.x <= high.x + SAME_M);
        for other in near {
            if boxes[*other].0.y <= high.y + SAME_M && boxes[*other].1.y >= low.y - SAME_M {
                let (a, b) = (pieces[*one], pieces[*other]);
                cuts[*one].extend(b.iter().filter_map(|end| foot(a, *end)));
                cuts[*other].extend(a.iter().filter_map(|end| foot(b, *end)));
                if let Some((on_one, on_other)) = crossing(a, b) {
                    cuts[*one].push(on_one);
                    cuts[*other].push(on_other);
                }
            }
        }
    }
    for shares in &mut cuts {
        shares.sort_unstable_by(f64::total_cmp);
    }
    cuts
}

/// The position of a point on a piece, as a share of the piece's length, if the point is on the piece.
fn foot([a, b]: Piece, place: Point) -> Option<f64> {
    let along = b - a;
    let share = (place - a).dot(&along) / along.norm_squared();
    let is_on = share > 0.0 && share < 1.0 && (a + along * share - place).norm() < SAME_M;
    is_on.then_some(share)
}

/// The position on each of two pieces, as a share of that piece's length, at which they cross.
fn crossing([a, b]: Piece, [c, d]: Piece) -> Option<(f64, f64)> {
    let (one, other, between) = (b - a, d - c, c - a);
    let turn = one.perp(&other);
    if turn.abs() < 1e-9 * one.norm() * other.norm() {
        return None;
    }
    let (s, t) = (between.perp(&other) / turn, between.perp(&one) / turn);
    ((0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&t)).then_some((s, t))
}

/// Points without duplicates.
#[derive(Default)]
struct Nodes {
    places: Vec<Point>,
    by_cell: HashMap<(i64, i64), Vec<usize>>,
}

impl Nodes {
    /// The node at a point: the nearest known node or, if none is close enough, a new one.
    fn at(&mut self, place: Point) -> usize {
        let cell = |v: f64| (v / SAME_M).floor() as i64;
        let (x, y) = (cell(place.x), cell(place.y));
        let around = (-1..=1).flat_map(|dx| (-1..=1).map(move |dy| (x + dx, y + dy)));
        let known = around.filter_map(|cell| self.by_cell.get(&cell)).flatten();
        let off_m = |node: &usize| (self.places[*node] - place).norm();
        let nearest = known
            .copied()
            .filter(|node| off_m(node) < SAME_M)
            .min_by(|a, b| off_m(a).total_cmp(&off_m(b)).then(a.cmp(b)));
        nearest.unwrap_or_else(|| {
            self.places.push(place);
            self.by_cell.entry((x, y)).or_default().push(self.places.len() - 1);
            self.places.len() - 1
        })
    }
}

/// The nodes, and which of them are joined by a line.
#[derive(Default)]
struct Graph {
    beside: BTreeMap<usize, BTreeSet<usize>>,
}

impl Graph {
    fn join(&mut self, a: usize, b: usize) {
        if a != b {
            self.beside.entry(a).or_default().insert(b);
            self.beside.entry(b).or_default().insert(a);
        }
    }

    /// Removes loose ends; returns how many of the removed pieces were longer than [`LOOSE_M`].
    fn prune(&mut self, places: &[Point]) -> usize {
        let mut ends: Vec<usize> =
            self.beside.iter().filter(|(_, others)| others.len() == 1).map(|(node, _)| *node).collect();
        let mut n_loose = 0;
        while let Some(end) = ends.pop() {
            let Some(other) = self.beside.get_mut(&end).and_then(BTreeSet::pop_first) else { continue };
            n_loose += usize::from((places[end] - places[other]).norm() > LOOSE_M);
            if let Some(others) = self.beside.get_mut(&other) {
                others.remove(&end);
                if others.len() == 1 {
                    ends.push(other);
                }
            }
        }
        n_loose
    }

    /// The enclosed faces, in the order of their first nodes.
    fn rings(&self, places: &[Point]) -> Vec<Vec<Point>> {
        // Neighbours of each node, counter-clockwise.
        let angle = |from: usize, to: usize| {
            let way = places[to] - places[from];
            way.y.atan2(way.x)
        };
        let around: BTreeMap<usize, Vec<usize>> = self
            .beside
            .iter()
            .map(|(node, others)| {
                let mut others: Vec<usize> = others.iter().copied().collect();
                others.sort_by(|a, b| angle(*node, *a).total_cmp(&angle(*node, *b)));
                (*node, others)
            })
            .collect();
        let mut walked: BTreeSet<(usize, usize)> = BTreeSet::new();
        let mut rings = Vec::new();
        for (start, others) in &around {
            for first in others {
                let (mut from, mut to, mut ring) = (*start, *first, Vec::new());
                while walked.insert((from, to)) {
                    ring.push(places[from]);
                    let ways = &around[&to];
                    // The face is to the left: continue with the next line clockwise.
                    let back = ways.iter().position(|way| *way == from).expect("every line goes both ways");
                    (from, to) = (to, ways[(back + ways.len() - 1) % ways.len()]);
                }
                if ring.len() > 2 && ring_area_m2(&ring) > 0.0 {
                    rings.push(ring);
                }
            }
        }
        rings
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(ends: &[(f64, f64)]) -> Vec<Point> {
        ends.iter().map(|(x, y)| Point::new(*x, *y)).collect()
    }

    fn areas_m2(lines: &[Vec<Point>]) -> (Vec<f64>, usize) {
        let faces = faces(lines).unwrap();
        let mut areas: Vec<f64> = faces.rings.iter().map(|ring| ring_area_m2(ring)).collect();
        areas.sort_unstable_by(f64::total_cmp);
        (areas, faces.n_loose)
    }

    const WALL: [(f64, f64); 5] = [(0.0, 0.0), (6.0, 0.0), (6.0, 4.0), (0.0, 4.0), (0.0, 0.0)];

    fn are(areas: &[f64], wanted: &[f64]) {
        let is_near = |(a, b): (&f64, &f64)| (a - b).abs() < 0.05;
        assert!(areas.len() == wanted.len() && areas.iter().zip(wanted).all(is_near), "{areas:?}");
    }

    #[test]
    fn seams_that_end_short_of_or_beyond_others_divide_a_floor() {
        let seams = [line(&WALL), line(&[(0.004, 1.0), (5.997, 1.0)]), line(&[(2.0, -0.03), (2.0, 0.998)])];
        let (areas, n_loose) = areas_m2(&seams);
        are(&areas, &[2.0, 4.0, 18.0]);
        assert_eq!(n_loose, 0);
        let total_m2: f64 = areas.iter().sum();
        assert!((total_m2 - 24.0).abs() < 0.03, "{total_m2}");
    }

    #[test]
    fn a_seam_that_ends_on_a_plate_divides_nothing_and_one_drawn_twice_does_so_once() {
        let across = [(3.0, 0.0), (3.0, 4.0)];
        let seams = [line(&WALL), line(&across), line(&across), line(&[(3.0, 2.0), (4.5, 2.0)])];
        let (areas, n_loose) = areas_m2(&seams);
        are(&areas, &[12.0, 12.0]);
        assert_eq!(n_loose, 1);
    }

    #[test]
    fn an_island_is_a_face_of_its_own() {
        let (areas, _) =
            areas_m2(&[line(&WALL), line(&[(1.0, 1.0), (2.0, 1.0), (2.0, 2.0), (1.0, 2.0), (1.0, 1.0)])]);
        are(&areas, &[1.0, 24.0]);
    }

    #[test]
    fn a_lattice_of_crossing_lines_has_all_its_meshes() {
        let rows = (0..=20).map(|k| line(&[(-0.01, f64::from(k)), (30.01, f64::from(k))]));
        let columns = (0..=30).map(|k| line(&[(f64::from(k), -0.01), (f64::from(k), 20.01)]));
        let (areas, n_loose) = areas_m2(&rows.chain(columns).collect::<Vec<_>>());
        assert_eq!((areas.len(), n_loose), (600, 0));
    }
}
