//! Outlines that are nearly closed: finds their gaps, and finds where outlines cross themselves.

use world::{Point, shape::bounds_of};

/// The largest number of lines whose ends are compared with each other; the longest lines are taken.
const MOST_LINES: usize = 400;
/// Width of a gap, as a share of the outline, above which the gap is obvious to the user and is not reported.
const WIDEST_SHARE: f64 = 0.25;
/// The largest number of sides that are compared with each other.
const MOST_SIDES: usize = 5_000;

/// An outline that is closed except for gaps.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct NearMiss {
    /// The larger extent in metres.
    pub across_m: f64,
    /// The number of gaps.
    pub n_gaps: usize,
    /// The ends of the widest gap, in metres.
    pub widest: [Point; 2],
}

impl NearMiss {
    /// A description, with positions in the drawing's units.
    pub(super) fn told(&self, unit_m: f64) -> String {
        let [a, b] = self.widest;
        let gap = match self.n_gaps {
            1 => "one gap".into(),
            n => format!("{n} gaps, the widest"),
        };
        format!(
            "an outline {:.3} m across is nearly closed: {gap} of {:.1} mm, from {} to {} in the drawing",
            self.across_m,
            (b - a).norm() * 1000.0,
            place(a, unit_m),
            place(b, unit_m)
        )
    }
}

/// Formats a position in the coordinates of a drawing.
pub(super) fn place(at: Point, unit_m: f64) -> String {
    // Resolves at least a thousandth of a millimetre, in any unit.
    let digits = if unit_m > 0.1 { 6 } else { 3 };
    let shown = |v: f64| {
        let text = format!("{:.digits$}", v / unit_m + 0.0);
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    };
    format!("({}, {})", shown(at.x), shown(at.y))
}

/// The end of a line.
#[derive(Clone, Copy)]
struct End {
    line: usize,
    at: Point,
}

/// Lines that are joined across gaps.
struct Joined {
    lines: Vec<usize>,
    gaps: Vec<[Point; 2]>,
}

/// The largest outline that lines would form if gaps were closed; ends are joined in pairs, nearest first.
pub(super) fn nearest(open: &[Vec<Point>]) -> Option<NearMiss> {
    let extent = |lines: &[usize]| {
        let corners: Vec<Point> =
            lines.iter().flat_map(|line| <[Point; 2]>::from(bounds_of(&open[*line]))).collect();
        let (low, high) = bounds_of(&corners);
        (high - low).amax()
    };
    let mut longest: Vec<usize> = (0..open.len()).filter(|line| open[*line].len() > 1).collect();
    longest.sort_by(|a, b| extent(&[*b]).total_cmp(&extent(&[*a])));
    longest.truncate(MOST_LINES);
    let ends: Vec<End> = longest
        .iter()
        .flat_map(|line| {
            [open[*line][0], open[*line][open[*line].len() - 1]].map(|at| End { line: *line, at })
        })
        .collect();
    let mut pairs: Vec<(f64, usize, usize)> = (0..ends.len())
        .flat_map(|a| (a + 1..ends.len()).map(move |b| (a, b)))
        .map(|(a, b)| ((ends[a].at - ends[b].at).norm(), a, b))
        .collect();
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut group_of: Vec<usize> = (0..open.len()).collect();
    let mut groups: Vec<Joined> =
        (0..open.len()).map(|line| Joined { lines: vec![line], gaps: Vec::new() }).collect();
    let mut is_used = vec![false; ends.len()];
    let mut best: Option<NearMiss> = None;
    for (_, a, b) in pairs {
        if is_used[a] || is_used[b] {
            continue;
        }
        (is_used[a], is_used[b]) = (true, true);
        // From left to right, regardless of which line was drawn first.
        let mut gap = [ends[a].at, ends[b].at];
        gap.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
        let (one, other) = (group_of[ends[a].line], group_of[ends[b].line]);
        groups[one].gaps.push(gap);
        if one != other {
            let Joined { lines, gaps } =
                std::mem::replace(&mut groups[other], Joined { lines: Vec::new(), gaps: Vec::new() });
            for line in &lines {
                group_of[*line] = one;
            }
            groups[one].lines.extend(lines);
            groups[one].gaps.extend(gaps);
            continue;
        }
        let closed = miss(&groups[one], extent(&groups[one].lines));
        let is_larger = |miss: &NearMiss| best.as_ref().is_none_or(|best| miss.across_m > best.across_m);
        best = closed.filter(is_larger).or(best);
    }
    best
}

/// The ring of joined lines, if the gaps are small compared with the ring.
fn miss(joined: &Joined, across_m: f64) -> Option<NearMiss> {
    let width_m = |gap: &[Point; 2]| (gap[1] - gap[0]).norm();
    let widest = *joined.gaps.iter().max_by(|a, b| width_m(a).total_cmp(&width_m(b)))?;
    // Joined ends closer than this belong to adjacent lines and are not gaps.
    let n_gaps = joined.gaps.iter().filter(|gap| width_m(gap) > super::rings::SAME_M).count().max(1);
    let is_near = width_m(&widest) <= WIDEST_SHARE * across_m;
    is_near.then_some(NearMiss { across_m, n_gaps, widest })
}

/// The point at which a closed outline crosses itself, if any; also `None` if the outline has more sides than
/// [`MOST_SIDES`].
pub(super) fn crossing(ring: &[Point]) -> Option<Point> {
    let n = ring.len();
    if n > MOST_SIDES {
        return None;
    }
    let side = |k: usize| (ring[k], ring[(k + 1) % n]);
    let apart = |i: usize, j: usize| j > i + 1 && !(i == 0 && j == n - 1);
    (0..n).flat_map(|i| (i + 2..n).map(move |j| (i, j))).filter(|(i, j)| apart(*i, *j)).find_map(|(i, j)| {
        let ((a, b), (c, d)) = (side(i), side(j));
        let (one, other) = (b - a, d - c);
        let turn = one.perp(&other);
        let (s, t) = ((c - a).perp(&other) / turn, (c - a).perp(&one) / turn);
        // An outline whose sides only touch still encloses a floor.
        let is_within = |share: f64| share > 1e-9 && share < 1.0 - 1e-9;
        (is_within(s) && is_within(t)).then(|| a + one * s)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(ends: &[(f64, f64)]) -> Vec<Point> {
        ends.iter().map(|(x, y)| Point::new(*x, *y)).collect()
    }

    #[test]
    fn the_widest_gap_of_the_largest_outline_is_told_in_units_of_the_drawing() {
        let small = line(&[(1.0, 1.0), (2.0, 1.0), (2.0, 2.0), (1.01, 1.02)]);
        let large =
            [line(&[(0.0, 0.0), (9.98, 0.0)]), line(&[(10.0, 0.0), (10.0, 8.0), (0.0, 8.0), (0.0, 0.005)])];
        let miss = nearest(&[std::slice::from_ref(&small), &large[..]].concat()).unwrap();
        assert_eq!(
            miss.told(0.001),
            "an outline 10.000 m across is nearly closed: 2 gaps, the widest of 20.0 mm, from (9980, 0) to \
             (10000, 0) in the drawing"
        );
        assert!(
            nearest(&[small])
                .unwrap()
                .told(1.0)
                .contains("an outline 1.000 m across is nearly closed: one gap of")
        );
        assert_eq!(nearest(&[line(&[(0.0, 0.0), (5.0, 0.0)])]), None, "a line is not an outline");
        assert_eq!(nearest(&[]), None);
    }

    #[test]
    fn an_outline_that_crosses_itself_does_so_at_a_place() {
        let bow = line(&[(0.0, 0.0), (4.0, 4.0), (4.0, 0.0), (0.0, 4.0)]);
        assert!((crossing(&bow).unwrap() - Point::new(2.0, 2.0)).norm() < 1e-9);
        assert_eq!(crossing(&line(&[(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)])), None);
        // Two rooms that touch at a corner.
        let touching = [(0.0, 0.0), (2.0, 2.0), (4.0, 2.0), (4.0, 4.0), (2.0, 4.0), (2.0, 2.0), (0.0, 2.0)];
        assert_eq!(crossing(&line(&touching)), None);
    }
}
