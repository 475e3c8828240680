//! Joins lines into closed outlines where one line begins at the end of another.

use std::collections::HashMap;
use world::Point;

/// Distance, in metres, below which two ends are joined.
pub(super) const SAME_M: f64 = 2e-3;

/// Points, and whether the last is joined to the first.
pub(super) type Chain = (Vec<Point>, bool);

/// Chains, indexed by their ends so that a drawing of a hundred thousand lines is joined quickly.
struct Ends {
    chains: Vec<Option<Vec<Point>>>,
    by_cell: HashMap<(i64, i64), Vec<usize>>,
}

impl Ends {
    fn new(chains: Vec<Vec<Point>>) -> Self {
        let mut by_cell: HashMap<_, Vec<usize>> = HashMap::new();
        for (index, chain) in chains.iter().enumerate() {
            for end in chain.first().into_iter().chain(chain.last()) {
                by_cell.entry(cell(*end)).or_default().push(index);
            }
        }
        Self { chains: chains.into_iter().map(Some).collect(), by_cell }
    }

    /// Removes and returns a chain that begins or ends at a point, reversed if necessary, so that it begins there.
    fn take_at(&mut self, place: Point) -> Option<Vec<Point>> {
        let (x, y) = cell(place);
        let around =
            (-1..=1).flat_map(|dx| (-1..=1).map(move |dy| (x.saturating_add(dx), y.saturating_add(dy))));
        let mut candidates = Vec::new();
        for cell in around {
            if let Some(here) = self.by_cell.get_mut(&cell) {
                here.retain(|index| self.chains[*index].is_some());
                candidates.extend_from_slice(here);
            }
        }
        candidates.sort_unstable();
        let ends_here = |index: &usize| {
            let chain = self.chains[*index].as_ref();
            chain.is_some_and(|c| is_same(c.first(), Some(&place)) || is_same(c.last(), Some(&place)))
        };
        let index = candidates.into_iter().find(ends_here)?;
        let mut chain = self.chains[index].take()?;
        if !is_same(chain.first(), Some(&place)) {
            chain.reverse();
        }
        Some(chain)
    }
}

fn cell(at: Point) -> (i64, i64) {
    // Points far beyond any tank share a cell.
    ((at.x / SAME_M) as i64, (at.y / SAME_M) as i64)
}

fn is_same(a: Option<&Point>, b: Option<&Point>) -> bool {
    a.zip(b).is_some_and(|(a, b)| (a - b).norm() < SAME_M)
}

/// Joins chains, each with a flag for closed chains, into closed rings. Also returns the chains that close no ring.
pub(super) fn closed(chains: Vec<Chain>) -> (Vec<Vec<Point>>, Vec<Vec<Point>>) {
    let (mut rings, mut open, mut loose) = (Vec::new(), Vec::new(), Vec::new());
    for (points, is_closed) in chains {
        if is_closed { rings.push(points) } else { loose.push(points) }
    }
    let mut ends = Ends::new(loose);
    for index in (0..ends.chains.len()).rev() {
        let Some(mut chain) = ends.chains[index].take() else { continue };
        while !is_same(chain.first(), chain.last()) {
            let Some(next) = chain.last().and_then(|end| ends.take_at(*end)) else { break };
            chain.extend(next.into_iter().skip(1));
        }
        if chain.len() > 3 && is_same(chain.first(), chain.last()) {
            rings.push(chain);
        } else {
            open.push(chain);
        }
    }
    for ring in &mut rings {
        ring.dedup_by(|a, b| (*a - *b).norm() < SAME_M / 10.0);
        while ring.len() > 1 && is_same(ring.first(), ring.last()) {
            ring.pop();
        }
    }
    rings.retain(|ring| ring.len() > 2);
    (rings, open)
}
