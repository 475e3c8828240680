//! A group of solids as seen from a position: its widest opening and the edges of that opening.

use std::f64::consts::{FRAC_PI_2, TAU};
use steering::{KnownMap, Side};
use world::{Point, geometry::wrap_angle_rad};

/// The widest free angle in a group, as seen from a position.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    /// The width, radians; at least half a turn if the position is outside the hull of the group.
    pub gap_rad: f64,
    /// The solid and corner on the right of the opening: the leftmost of the group for a robot that faces the group.
    pub leftmost: Edge,
    /// The solid and corner on the left of the opening.
    pub rightmost: Edge,
}

/// An end of a group.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Edge {
    /// Index of the solid.
    pub index: usize,
    /// The corner at that end: centre and radius, metres.
    pub corner: (Point, f64),
}

struct Span {
    from_rad: f64,
    to_rad: f64,
    from: Edge,
    to: Edge,
}

impl View {
    /// Views some solids, grown by a margin; `None` if there are none.
    pub fn of(at: Point, map: &KnownMap, members: &[usize], margin_m: f64) -> Option<Self> {
        let mut spans: Vec<Span> = members.iter().map(|index| span(at, map, *index, margin_m)).collect();
        spans.sort_by(|a, b| a.from_rad.total_cmp(&b.from_rad));
        let first = spans.first()?;
        // A span may extend across the western direction and overlap the first spans.
        let wrapped = spans.iter().map(|span| (span.to_rad - TAU, span.to));
        let later = |a: (f64, Edge), b: (f64, Edge)| if b.0 > a.0 { b } else { a };
        let mut end = wrapped.fold((first.to_rad, first.to), later);
        let mut widest: Option<Self> = None;
        let again =
            Span { from_rad: first.from_rad + TAU, to_rad: f64::INFINITY, from: first.from, to: first.to };
        for next in spans[1..].iter().chain([&again]) {
            let gap_rad = next.from_rad - end.0;
            if widest.is_none_or(|view| gap_rad > view.gap_rad) {
                widest = Some(Self { gap_rad, leftmost: end.1, rightmost: next.from });
            }
            end = later(end, (next.to_rad, next.to));
        }
        widest.map(|view| Self { gap_rad: view.gap_rad.max(0.0), ..view })
    }

    /// The edge on a side, as seen by a robot that faces the group.
    pub fn edge(&self, side: Side) -> Edge {
        if side == Side::Left { self.leftmost } else { self.rightmost }
    }
}

fn span(at: Point, map: &KnownMap, index: usize, margin_m: f64) -> Span {
    let solid = &map.solids[index];
    let middle = solid.center - at;
    let middle_rad = middle.y.atan2(middle.x);
    let edge = |corner| Edge { index, corner };
    let corner = solid.corners()[0];
    let mut span =
        Span { from_rad: f64::INFINITY, to_rad: f64::NEG_INFINITY, from: edge(corner), to: edge(corner) };
    for corner in solid.corners() {
        let there = corner.0 - at;
        let distance_m = there.norm();
        let half_rad = if distance_m > corner.1 + margin_m {
            ((corner.1 + margin_m) / distance_m).asin()
        } else {
            FRAC_PI_2
        };
        let off_rad = wrap_angle_rad(there.y.atan2(there.x) - middle_rad);
        if off_rad - half_rad < span.from_rad {
            (span.from_rad, span.from) = (off_rad - half_rad, edge(*corner));
        }
        if off_rad + half_rad > span.to_rad {
            (span.to_rad, span.to) = (off_rad + half_rad, edge(*corner));
        }
    }
    // Every span begins within one turn, so sorting by the beginning gives the order around the position.
    let width_rad = (span.to_rad - span.from_rad).min(TAU);
    let from_rad = wrap_angle_rad(middle_rad + span.from_rad);
    Span { from_rad, to_rad: from_rad + width_rad, ..span }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;
    use steering::Solid;
    use world::Boundary;

    fn look(at: (f64, f64), discs: &[(f64, f64)]) -> View {
        let disc = |(id, (x, y)): (usize, &(f64, f64))| Solid::disc(id as u32, Point::new(*x, *y), 0.5);
        let solids: Vec<Solid> = discs.iter().enumerate().map(disc).collect();
        let members: Vec<usize> = (0..solids.len()).collect();
        let map = KnownMap { solids, wall: Boundary::Circle { radius_m: 90.0 }, hull_m: 0.0 };
        View::of(Point::new(at.0, at.1), &map, &members, 0.0).expect("there are discs")
    }

    #[test]
    fn from_within_a_cup_the_mouth_is_seen_between_its_lips() {
        // A cup that is open to the west.
        let cup = [(-1.0, 2.0), (0.5, 2.0), (2.0, 0.7), (2.0, -0.7), (0.5, -2.0), (-1.0, -2.0)];
        let inside = look((0.5, 0.0), &cup);
        assert!(inside.gap_rad < PI);
        assert_eq!((inside.leftmost.index, inside.rightmost.index), (0, 5));
        let outside = look((-4.0, 0.0), &cup);
        assert!(outside.gap_rad > PI);
        assert_eq!((outside.leftmost.index, outside.rightmost.index), (0, 5));
    }

    #[test]
    fn one_disc_leaves_all_but_its_own_width() {
        let view = look((-2.0, 0.0), &[(0.0, 0.0)]);
        assert!((view.gap_rad - (TAU - 2.0 * 0.25_f64.asin())).abs() < 1e-9);
    }

    #[test]
    fn a_group_across_the_western_direction_is_one_group() {
        let view = look((0.0, 0.0), &[(-3.0, 0.4), (-3.0, -0.4)]);
        assert!(view.gap_rad > PI);
        assert_eq!((view.leftmost.index, view.rightmost.index), (1, 0));
    }
}
