//! Lines that end where others begin, joined to closed outlines.

use world::Point;

/// Ends nearer than this are one, metres.
const SAME_M: f64 = 2e-3;

/// Points, and whether the last is joined to the first.
pub(super) type Chain = (Vec<Point>, bool);

/// Closed rings of chains, each with whether it is closed already, and the chains that close nothing.
pub(super) fn closed(chains: Vec<Chain>) -> (Vec<Vec<Point>>, Vec<Vec<Point>>) {
    let is_same =
        |a: Option<&Point>, b: Option<&Point>| a.zip(b).is_some_and(|(a, b)| (a - b).norm() < SAME_M);
    let (mut rings, mut open, mut loose) = (Vec::new(), Vec::new(), Vec::new());
    for (points, is_closed) in chains {
        if is_closed { rings.push(points) } else { loose.push(points) }
    }
    while let Some(mut chain) = loose.pop() {
        while !is_same(chain.first(), chain.last()) {
            let end = chain.last().copied();
            let next = loose.iter().position(|other| {
                is_same(other.first(), end.as_ref()) || is_same(other.last(), end.as_ref())
            });
            let Some(next) = next else { break };
            let mut other = loose.swap_remove(next);
            if !is_same(other.first(), end.as_ref()) {
                other.reverse();
            }
            chain.extend(other.into_iter().skip(1));
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
