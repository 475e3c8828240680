//! The lanes of a pattern, not yet ordered: broken at the cuts and where the hull does not fit.

use crate::inflation::SLACK_M;
use crate::pattern::Pattern;
use crate::plane::left_of;
use crate::slit_domain::{SlitDomain, Spot};
use crate::tuning::lanes as tuning;
use std::ops::Range;
use world::{Point, Vector, polyline, shape::bounds_of};

/// Sampling step along lanes, metres.
const STEP_M: f64 = 0.04;
/// Number of samples examined together: only a few fences are close to such a group.
const STRETCH: usize = 64;

/// A lane in the direction in which it was created: at least two points.
pub(crate) type Lane = Vec<Point>;

/// The lanes of a pattern, and a corridor beside every cut across them. Lanes shorter than the minimum are left out.
pub(crate) fn lanes(domain: &SlitDomain<'_>, pattern: &Pattern, least_m: f64) -> Vec<Lane> {
    let (mut lanes, rows) = laps_and_rows(domain, pattern, least_m);
    lanes.extend(rows);
    lanes
}

/// The lanes that `lanes` returns, with those along walls and cuts separate from the straight rows.
pub(crate) fn laps_and_rows(
    domain: &SlitDomain<'_>,
    pattern: &Pattern,
    least_m: f64,
) -> (Vec<Lane>, Vec<Lane>) {
    let swath_m = domain.workspace.swath_m;
    let corridors = corridors(domain, pattern, swath_m);
    let spare_m = SLACK_M / 2.0;
    let clip =
        |line: &[Point], fences: &[Fence], spare_m: f64| clipped(domain, line, fences, (least_m, spare_m));
    let mut along = Vec::new();
    for (k, corridor) in corridors.iter().enumerate() {
        let before = fences(&corridors[..k], tuning::CORRIDOR_TO_CORRIDOR * swath_m);
        let fences = [fences(&domain.cuts, tuning::CORRIDOR_TO_CUT * swath_m), before].concat();
        along.extend(clip(corridor, &fences, spare_m));
    }
    let to_cut = if pattern.ahead().is_some() { tuning::STRAIGHT_TO_CUT } else { tuning::CONTOUR_TO_CUT };
    let beside_cuts = fences(&domain.cuts, to_cut * swath_m);
    let fences = [beside_cuts, fences(&corridors, tuning::CORRIDOR_TO_LANE * swath_m)].concat();
    let (laps, rows) = pattern.lines(domain);
    along.extend(laps.iter().flat_map(|line| clip(line, &fences, spare_m)));
    let spare_m = if domain.workspace.is_room { pattern.within_laps_m(swath_m) } else { spare_m };
    (along, rows.iter().flat_map(|line| clip(line, &fences, spare_m)).collect())
}

/// A line along every cut that crosses the lanes, always on the cut's left as seen from its start. A cut that runs with
/// the lanes already has a lane beside it.
fn corridors(domain: &SlitDomain<'_>, pattern: &Pattern, swath_m: f64) -> Vec<Vec<Point>> {
    let corridor = |cut: &Vec<Point>| {
        let (a, b) = (cut[cut.len() - 2], cut[cut.len() - 1]);
        let ahead = (b - a).try_normalize(1e-9)?;
        let is_across = pattern.ahead().is_none_or(|lane| lane.perp(&ahead).abs() >= tuning::ACROSS);
        let aside = left_of(ahead) * (tuning::CORRIDOR * swath_m);
        is_across.then(|| vec![a + aside, b + aside])
    };
    domain.cuts.iter().filter_map(corridor).collect()
}

/// A line with the distance that lanes keep from it, and the bounding box of everything that may be too close to it.
#[derive(Clone, Copy)]
struct Fence<'a> {
    line: &'a [Point],
    far_m: f64,
    low: Point,
    high: Point,
}

impl<'a> Fence<'a> {
    fn new(line: &'a [Point], far_m: f64) -> Self {
        let (low, high) = bounds_of(line);
        let far = Vector::new(far_m, far_m).add_scalar(1e-9);
        Self { line, far_m, low: low - far, high: high + far }
    }

    /// Whether anything inside a box may be too close.
    fn may_bar(&self, (low, high): (Point, Point)) -> bool {
        self.low.x < high.x && self.high.x > low.x && self.low.y < high.y && self.high.y > low.y
    }

    fn bars(&self, at: Point) -> bool {
        self.may_bar((at, at)) && polyline::distance_m(self.line, at) < self.far_m
    }
}

fn fences(lines: &[Vec<Point>], far_m: f64) -> Vec<Fence<'_>> {
    lines.iter().map(|line| Fence::new(line, far_m)).collect()
}

/// The pieces of a line that can be driven with some clearance to spare and that keep away from the fences; short
/// pieces are left out.
fn clipped(
    domain: &SlitDomain<'_>,
    line: &[Point],
    fences: &[Fence<'_>],
    (least_m, spare_m): (f64, f64),
) -> Vec<Lane> {
    let around = bounds_of(line);
    let near: Vec<&Fence<'_>> = fences.iter().filter(|fence| fence.may_bar(around)).collect();
    let spot_among = |fences: &[&Fence<'_>], at: Point| {
        let is_open =
            !fences.iter().any(|fence| fence.bars(at)) && domain.workspace.room.spare_m(at) >= spare_m;
        is_open.then(|| domain.spot(at)).flatten()
    };
    let mut points = polyline::resampled(line, STEP_M);
    let mut spots = Vec::with_capacity(points.len());
    for stretch in points.chunks(STRETCH) {
        let around = bounds_of(stretch);
        let near: Vec<&Fence<'_>> = near.iter().copied().filter(|fence| fence.may_bar(around)).collect();
        spots.extend(stretch.iter().map(|p| spot_among(&near, *p)));
    }
    let is_ring = line.len() > 2 && (line[0] - line[line.len() - 1]).norm() < 1e-9;
    if is_ring {
        begin_behind_a_break(&mut points, &mut spots);
    }
    // Two samples may both be open even though the passage between them is blocked at its narrowest point.
    let sees = |a: Spot, b: Option<Spot>| b.is_some_and(|b| domain.sees_between(a, b));
    let last_open =
        |open: Spot, closed: Point| last_open(open.at, closed, &|at| sees(open, spot_among(&near, at)));
    let piece = |run: Range<usize>| {
        let (first, last) = (spots[run.start]?, spots[run.end - 1]?);
        let before = run.start.checked_sub(1).map(|k| points[k]);
        // A ring that is open all the way around ends slightly beyond its beginning.
        let after = points.get(run.end).or(is_ring.then(|| &points[1]));
        let mut lane: Vec<Point> = before.map(|out| last_open(first, out)).into_iter().collect();
        lane.extend(&points[run]);
        lane.extend(after.map(|out| last_open(last, *out)));
        Some(thinned(&lane))
    };
    let lanes = runs(&spots, |a, b| a.is_some_and(|a| sees(a, *b))).filter_map(piece);
    lanes.filter(|lane| polyline::length_m(lane) >= least_m).collect()
}

/// Rotates a closed ring so that no lane is broken at the ring's closing point.
fn begin_behind_a_break(points: &mut Vec<Point>, spots: &mut Vec<Option<Spot>>) {
    points.pop();
    spots.pop();
    let start = spots.iter().position(Option::is_none).unwrap_or(0);
    points.rotate_left(start);
    spots.rotate_left(start);
    points.push(points[0]);
    spots.push(spots[0]);
}

/// The last open position on the way from an open position to a closed one.
fn last_open(open: Point, closed: Point, is_open: &dyn Fn(Point) -> bool) -> Point {
    let (mut from, mut to) = (0.0, 1.0);
    for _ in 0..7 {
        let middle = f64::midpoint(from, to);
        if is_open(open + (closed - open) * middle) {
            from = middle;
        } else {
            to = middle;
        }
    }
    open + (closed - open) * from
}

/// The wanted pieces of a lane.
pub(crate) fn wanted_pieces(lane: &Lane, is_wanted: impl Fn(Point) -> bool) -> Vec<Lane> {
    let fine = polyline::resampled(lane, 0.1);
    let wanted: Vec<bool> = fine.iter().map(|p| is_wanted(*p)).collect();
    if wanted.iter().all(|w| *w) {
        return vec![lane.clone()];
    }
    let is_wanted = |run: &Range<usize>| wanted[run.start] && run.len() > 1;
    runs(&wanted, |a, b| a == b).filter(is_wanted).map(|run| thinned(&fine[run])).collect()
}

/// The ranges of consecutive items that belong together.
fn runs<T>(items: &[T], is_together: impl Fn(&T, &T) -> bool) -> impl Iterator<Item = Range<usize>> {
    let mut past = 0;
    items.chunk_by(is_together).map(move |run| {
        let first = past;
        past += run.len();
        first..past
    })
}

/// The same line with fewer points; it passes within a millimetre of the points left out.
pub(crate) fn thinned(points: &[Point]) -> Lane {
    if points.len() < 3 {
        return points.to_vec();
    }
    let mut kept = vec![points[0]];
    let mut from = 0;
    while from + 1 < points.len() {
        let mut to = from + 1;
        while to + 1 < points.len() && to + 1 - from < 40 && is_straight(&points[from..=to + 1]) {
            to += 1;
        }
        kept.push(points[to]);
        from = to;
    }
    kept
}

fn is_straight(run: &[Point]) -> bool {
    let (a, b) = (run[0], run[run.len() - 1]);
    let (along, near_m) = (b - a, 1e-3);
    let squared = along.norm_squared();
    run.iter().all(|p| {
        let offset = p - a;
        let (ahead, aside) = (along.dot(&offset), along.perp(&offset));
        // For most points a check without a division shows that they are close.
        let is_clear = (0.0..=squared).contains(&ahead) && aside * aside < 0.99 * near_m * near_m * squared;
        is_clear || (p - polyline::nearest_on_segment(a, b, *p)).norm() < near_m
    })
}
