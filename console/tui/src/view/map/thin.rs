//! Thins a path whose lanes would merge on the map: draws every n-th lane, and straight links between the lanes drawn.

use super::crowd::Crowd;
use super::shapes::Window;
use crate::model::Lane;
use std::collections::BTreeMap;
use world::{Point, polyline};

/// Lanes that are at least this many columns apart are all drawn. Closer lanes that lead from west to east would be on
/// neighbouring rows, which are two columns high.
const APART_COLUMNS: f64 = 2.2;
/// The distance between the lanes drawn if not all are, columns.
const THINNED_COLUMNS: f64 = 3.0;
/// Lines of a thinned path that are closer than this share of the distance between the lanes drawn merge.
const MERGE: f64 = 0.8;
/// Maximum number n if only every n-th lane is drawn.
const MOST: usize = 99;
/// A way between two lanes that is longer than this many lane widths leads to a different part of the floor.
const TRANSIT_LANES: f64 = 8.0;
/// If the directions of two lanes differ by less than this, radians, they count as one line that an obstacle
/// interrupts.
const SAME_LINE_RAD: f64 = 0.3;
/// A link spans at most this many times the distance between the lanes drawn.
const LINK: f64 = 2.5;

/// A path passes its places again if more than this share of it runs beside an earlier part.
const AGAIN: f64 = 0.3;
/// The distance within which one part of a path runs beside another, lane widths.
const BESIDE_LANES: f64 = 1.5;

/// Whether most of a path runs beside an earlier part of it, as the turns of a spiral do. The lanes are `lane_m` metres
/// apart.
pub(super) fn passes_again(path: &[Point], lane_m: f64) -> bool {
    let length_m = polyline::length_m(path);
    if lane_m <= 0.0 || length_m <= 0.0 {
        return false;
    }
    let alone = joined(apart(path, BESIDE_LANES * lane_m));
    let alone_m: f64 = alone.iter().map(|(from, to)| polyline::length_m(&path[*from..=*to])).sum();
    length_m - alone_m > AGAIN * length_m
}

/// Which lanes of a path are drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Thinning {
    /// One lane in this many is drawn. The number is odd, so that the lanes drawn alternate in direction as all lanes
    /// do.
    pub every: usize,
    /// The index of the first lane drawn in each part of the floor.
    first: usize,
    /// Distance between lanes, metres.
    lane_m: f64,
    /// Lines that are closer than this merge, metres.
    merge_m: f64,
}

impl Thinning {
    /// The thinning of the path with the index `which`, one of `paths` paths that are on the map together. Their lanes
    /// are `lane_m` metres apart. Equal paths are drawn on different lanes.
    pub(super) fn new(lane_m: f64, window: Window, (which, paths): (usize, usize)) -> Self {
        let lane_columns = lane_m / window.column_m / paths.max(1) as f64;
        let is_apart = !lane_columns.is_finite() || lane_columns <= 0.0 || lane_columns >= APART_COLUMNS;
        let enough = |every: &usize| *every as f64 * lane_columns >= THINNED_COLUMNS;
        let every = if is_apart { 1 } else { (3..MOST).step_by(2).find(enough).unwrap_or(MOST) };
        let merge_m = MERGE * THINNED_COLUMNS * window.column_m;
        Self { every, first: (which * every / paths.max(1)).min(every - 1), lane_m, merge_m }
    }
}

/// A piece of a thinned path, from one index of its points to another.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Piece {
    from: usize,
    to: usize,
    /// Whether the piece is a straight line instead of the points between its ends.
    is_link: bool,
}

/// The part of a path that is drawn.
pub(super) struct Thin<'a> {
    path: &'a [Point],
    pieces: Vec<Piece>,
    /// The indices of the lanes that are drawn.
    pub lanes: Vec<usize>,
}

impl<'a> Thin<'a> {
    /// Thins a path. A path without lanes loses the stretches that are close to a stretch drawn before.
    pub(super) fn new(path: &'a [Point], lanes: &[Lane], thinning: Thinning) -> Self {
        let end = path.len().saturating_sub(1);
        if thinning.every == 1 {
            let whole = Piece { from: 0, to: end, is_link: false };
            return Self { path, pieces: vec![whole], lanes: (0..lanes.len()).collect() };
        }
        let gap_m = thinning.every as f64 * thinning.lane_m;
        let (kept, lanes) = if lanes.is_empty() {
            (apart(path, gap_m - 0.5 * thinning.lane_m), Vec::new())
        } else {
            let (ways, drawn) = every_nth(path, lanes, thinning);
            uncrowded(path, lanes, (&ways, drawn), thinning.merge_m)
        };
        Self { path, pieces: linked(path, &joined(kept), LINK * gap_m), lanes }
    }

    /// The lines to be drawn from one index of the path to another.
    pub(super) fn lines(&self, (from, to): (usize, usize)) -> impl Iterator<Item = Vec<Point>> {
        let clipped = move |piece: &Piece| (piece.from.max(from), piece.to.min(to));
        let seen = self.pieces.iter().filter(move |piece| clipped(piece).0 < clipped(piece).1);
        seen.map(move |piece| {
            let (from, to) = clipped(piece);
            if piece.is_link { vec![self.path[from], self.path[to]] } else { self.path[from..=to].to_vec() }
        })
    }
}

/// The ways of a path that lead to lanes drawn, and the indices of every n-th lane.
fn every_nth(path: &[Point], lanes: &[Lane], thinning: Thinning) -> (Vec<Lane>, Vec<usize>) {
    let (mut ways, mut drawn): (Vec<Lane>, Vec<usize>) = (vec![(0, lanes[0].0)], Vec::new());
    let mut row = 0;
    for (index, lane) in lanes.iter().enumerate() {
        let before = index.checked_sub(1).map(|before| lanes[before]);
        if let Some(before) = before {
            let way = (before.1, lane.0.max(before.1));
            let is_same_line = is_continued(path, before, *lane, thinning.lane_m);
            if is_same_line && drawn.last() == Some(&(index - 1)) {
                ways.push(way);
            } else if is_same_line {
            } else if is_transit(path, way, thinning.lane_m) {
                ways.push(way);
                row = 0;
            } else {
                row += 1;
            }
        }
        if row % thinning.every == thinning.first {
            drawn.push(index);
        }
    }
    ways.extend(lanes.last().map(|lane| (lane.1, path.len() - 1)));
    (ways, drawn)
}

/// The stretches on lanes and ways that do not merge with others, in the order of the path, and the lanes drawn. Ways
/// give way to lanes.
fn uncrowded(
    path: &[Point],
    lanes: &[Lane],
    (ways, drawn): (&[Lane], Vec<usize>),
    merge_m: f64,
) -> (Vec<Lane>, Vec<usize>) {
    let mut crowd = Crowd::new(merge_m);
    let is_kept = |stretch: &Lane, end_m: f64, crowd: &mut Crowd| {
        let points = polyline::resampled(&path[stretch.0..=stretch.1], 0.5 * merge_m);
        let is_free = !crowd.merges(&polyline::without_ends(&points, end_m));
        is_free.then(|| crowd.add(points)).is_some()
    };
    let drawn: Vec<usize> =
        drawn.into_iter().filter(|lane| is_kept(&lanes[*lane], 0.0, &mut crowd)).collect();
    // A way begins and ends at a lane.
    let ways = ways.iter().filter(|way| way.0 < way.1 && is_kept(way, merge_m, &mut crowd));
    let mut stretches: Vec<Lane> = ways.copied().chain(drawn.iter().map(|lane| lanes[*lane])).collect();
    stretches.sort_unstable();
    (stretches, drawn)
}

/// The parts of a path, each with whether it is a way to a different part of the floor. `part` is the part of the path to
/// be divided.
pub(super) fn divided(path: &[Point], lanes: &[Lane], lane_m: f64, part: Lane) -> Vec<(Lane, bool)> {
    let ways = lanes.windows(2).filter(|pair| !is_continued(path, pair[0], pair[1], lane_m));
    let ways = ways.map(|pair| (pair[0].1, pair[1].0.max(pair[0].1)));
    let (mut parts, mut at) = (Vec::new(), part.0);
    for (from, to) in ways.filter(|way| is_transit(path, *way, lane_m)) {
        let (from, to) = (from.clamp(at, part.1.max(at)), to.clamp(at, part.1.max(at)));
        parts.extend([((at, from), false), ((from, to), true)]);
        at = to;
    }
    parts.push(((at, part.1), false));
    parts.retain(|((from, to), _)| from < to);
    parts
}

/// Whether a way between two lanes leads to a different part of the floor.
fn is_transit(path: &[Point], way: Lane, lane_m: f64) -> bool {
    lane_m > 0.0 && polyline::length_m(&path[way.0..=way.1]) > TRANSIT_LANES * lane_m
}

/// Whether a lane continues the one before on the same line.
fn is_continued(path: &[Point], before: Lane, lane: Lane, lane_m: f64) -> bool {
    let way = |lane: Lane| path[lane.1] - path[lane.0];
    let (one, other) = (way(before), way(lane));
    let aside_m = one.perp(&(path[lane.0] - path[before.0])).abs() / one.norm();
    one.angle(&other) < SAME_LINE_RAD && aside_m < 0.5 * lane_m
}

/// The stretches of a path that are at least `gap_m` from those before them.
fn apart(path: &[Point], gap_m: f64) -> Vec<Lane> {
    let along_m = polyline::stations_m(path);
    let tile = |at: &Point| ((at.x / gap_m).floor() as i64, (at.y / gap_m).floor() as i64);
    let mut drawn: BTreeMap<(i64, i64), Vec<usize>> = BTreeMap::new();
    let mut stretches: Vec<Lane> = Vec::new();
    for (index, at) in path.iter().enumerate() {
        let (x, y) = tile(at);
        let around = (-1..=1).flat_map(|right| (-1..=1).map(move |up| (x + right, y + up)));
        let mut near = around.filter_map(|tile| drawn.get(&tile)).flatten();
        // The stretch that leads to this point does not count.
        let is_near = |other: &usize| {
            (path[*other] - at).norm() < gap_m && along_m[index] - along_m[*other] > 3.0 * gap_m
        };
        if near.any(is_near) {
            continue;
        }
        drawn.entry((x, y)).or_default().push(index);
        match stretches.last_mut() {
            Some((_, last)) if *last + 1 == index => *last = index,
            _ => stretches.push((index, index)),
        }
    }
    stretches
}

/// The stretches, joined where they touch, without stretches of a single point.
fn joined(stretches: Vec<Lane>) -> Vec<Lane> {
    let mut joined: Vec<Lane> = Vec::new();
    for (from, to) in stretches {
        match joined.last_mut() {
            Some((_, last)) if *last >= from => *last = to.max(*last),
            _ => joined.push((from, to)),
        }
    }
    joined.retain(|(from, to)| from < to);
    joined
}

/// The pieces of stretches, with a straight link where one begins close to the end of the one before.
fn linked(path: &[Point], stretches: &[Lane], most_m: f64) -> Vec<Piece> {
    let mut pieces: Vec<Piece> = Vec::new();
    for (from, to) in stretches {
        if let Some(before) = pieces.last().filter(|before| (path[*from] - path[before.to]).norm() <= most_m)
        {
            pieces.push(Piece { from: before.to, to: *from, is_link: true });
        }
        pieces.push(Piece { from: *from, to: *to, is_link: false });
    }
    pieces
}

#[cfg(test)]
mod tests {
    use super::*;

    fn window(column_m: f64) -> Window {
        Window::new(Point::origin(), column_m, (60, 20))
    }

    /// Lanes of 20 m, 0.5 m apart, each of 21 points.
    fn meander(lanes: usize) -> (Vec<Point>, Vec<Lane>) {
        let path = (0..lanes).flat_map(|row| {
            let x = move |step: usize| if row % 2 == 0 { step } else { 20 - step } as f64;
            (0..=20).map(move |step| Point::new(x(step), 0.5 * row as f64))
        });
        (path.collect(), (0..lanes).map(|row| (21 * row, 21 * row + 20)).collect())
    }

    #[test]
    fn lanes_that_are_apart_are_all_drawn() {
        let (path, lanes) = meander(6);
        let thin = Thin::new(&path, &lanes, Thinning::new(0.5, window(0.2), (0, 1)));
        assert_eq!(thin.lanes.len(), 6);
        assert_eq!(thin.lines((0, 125)).collect::<Vec<_>>(), std::slice::from_ref(&path));
    }

    #[test]
    fn every_third_lane_is_drawn_in_alternating_directions_with_links_between() {
        let (path, lanes) = meander(10);
        let thinning = Thinning::new(0.5, window(0.5), (0, 1));
        let thin = Thin::new(&path, &lanes, thinning);
        assert_eq!((thinning.every, thin.lanes.as_slice()), (3, &[0, 3, 6, 9][..]));
        let lines: Vec<Vec<Point>> = thin.lines((0, path.len() - 1)).collect();
        assert!(lines.windows(2).all(|pair| pair[0].last() == pair[1].first()), "one line: {lines:?}");
        assert_eq!(lines.len(), 7);
        // The part ahead of the middle of lane 4 begins with a link from there.
        let ahead: Vec<Vec<Point>> = thin.lines((lanes[4].0 + 10, path.len() - 1)).collect();
        assert_eq!(ahead[0], [path[lanes[4].0 + 10], path[lanes[6].0]]);
    }

    #[test]
    fn each_part_of_the_floor_keeps_its_first_lane_and_the_way_to_it() {
        let (mut path, mut lanes) = meander(2);
        let (far, _) = meander(2);
        let n = path.len();
        path.extend(far.iter().map(|at| at + world::Vector::new(0.0, 30.0)));
        lanes.extend([(n, n + 20), (n + 21, n + 41)]);
        let thin = Thin::new(&path, &lanes, Thinning::new(0.5, window(0.5), (0, 1)));
        assert_eq!(thin.lanes, [0, 2]);
        assert!(
            thin.lines((0, path.len() - 1))
                .any(|line| line.contains(&path[n - 1]) && line.contains(&path[n]))
        );
    }

    #[test]
    fn ways_between_parts_of_the_floor_are_told_from_lanes() {
        let (mut path, mut lanes) = meander(2);
        let n = path.len();
        path.extend(meander(2).0.iter().map(|at| at + world::Vector::new(0.0, 30.0)));
        lanes.extend([(n, n + 20), (n + 21, n + 41)]);
        let end = path.len() - 1;
        let whole = [((0, n - 1), false), ((n - 1, n), true), ((n, end), false)];
        assert_eq!(divided(&path, &lanes, 0.5, (0, end)), whole);
        assert_eq!(divided(&path, &lanes, 0.5, (n + 3, end)), [((n + 3, end), false)]);
        assert_eq!(divided(&path, &[], 0.5, (2, 9)), [((2, 9), false)]);
    }

    #[test]
    fn a_lane_behind_an_obstacle_belongs_to_the_line_before_it() {
        let (path, _) = meander(4);
        let lanes = [(0, 8), (12, 20), (21, 41), (42, 62), (63, 83)];
        let thin = Thin::new(&path, &lanes, Thinning::new(0.5, window(0.5), (0, 1)));
        assert_eq!(thin.lanes, [0, 1, 4]);
    }

    #[test]
    fn two_equal_paths_are_drawn_on_different_lanes() {
        let (path, lanes) = meander(14);
        let [one, other] =
            [0, 1].map(|which| Thin::new(&path, &lanes, Thinning::new(0.5, window(0.5), (which, 2))).lanes);
        assert!(one.len() > 1 && other.len() > 1 && one.iter().all(|lane| !other.contains(lane)));
    }

    #[test]
    fn a_path_that_passes_its_places_once_is_told_from_a_spiral_and_from_lanes() {
        let spiral =
            world::spiral::Spiral { outer_radius_m: 9.0, inner_radius_m: 0.5, pitch_m: 0.5, step_rad: 0.05 };
        assert!(passes_again(&spiral.points(), 0.5));
        assert!(passes_again(&meander(8).0, 0.5));
        // Around two columns and on, as a path to a goal leads.
        let once: Vec<Point> = (0..400)
            .map(|step| {
                let along = 0.05 * f64::from(step);
                Point::new(along, (0.7 * along).sin())
            })
            .collect();
        assert!(!passes_again(&once, 0.5));
        assert!(!passes_again(&[], 0.5));
    }

    #[test]
    fn a_spiral_keeps_turns_that_can_be_told_apart() {
        let spiral =
            world::spiral::Spiral { outer_radius_m: 9.0, inner_radius_m: 0.5, pitch_m: 0.5, step_rad: 0.05 };
        let path = spiral.points();
        let thin = Thin::new(&path, &[], Thinning::new(0.5, window(0.5), (0, 1)));
        let lines: Vec<Vec<Point>> = thin.lines((0, path.len() - 1)).collect();
        let drawn_m: f64 = lines.iter().map(|line| polyline::length_m(line)).sum();
        let share = drawn_m / polyline::length_m(&path);
        assert!((0.2..0.6).contains(&share), "{share}");
    }
}
