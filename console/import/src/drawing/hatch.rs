//! The edges of hatched areas.

use super::{
    curves::{Spline, arc, chain, ellipse, spline},
    rings,
};
use world::Point;

/// Groups `code value` in file order.
struct Groups<'a> {
    all: &'a [(i32, String)],
    at: usize,
}

impl Groups<'_> {
    /// Skips to the next group with this code and returns its number.
    fn number(&mut self, code: i32) -> Option<f64> {
        let step = self.all[self.at..].iter().position(|(known, _)| *known == code)?;
        self.at += step + 1;
        self.all[self.at - 1].1.parse().ok().filter(|number: &f64| number.is_finite())
    }

    /// The number of the next group, if it has this code.
    fn next_number(&mut self, code: i32) -> Option<f64> {
        (self.all.get(self.at)?.0 == code).then(|| self.number(code)).flatten()
    }

    fn point(&mut self, x: i32) -> Option<Point> {
        Some(Point::new(self.number(x)?, self.number(x + 10)?))
    }

    /// The number of items that follow, limited by the number of groups.
    fn count(&mut self, code: i32) -> Option<usize> {
        Some((self.number(code)?.max(0.0) as usize).min(self.all.len()))
    }
}

/// The closed edges of a hatched area. An unreadable edge and everything after it are left out.
pub(super) fn rings(groups: &[(i32, String)]) -> Vec<Vec<Point>> {
    let mut groups = Groups { all: groups, at: 0 };
    let mut rings = Vec::new();
    let n = groups.count(91).unwrap_or_default();
    for _ in 0..n {
        match path(&mut groups) {
            Some(found) => rings.extend(found),
            None => break,
        }
    }
    rings.retain(|ring| ring.len() > 2);
    rings
}

fn path(groups: &mut Groups<'_>) -> Option<Vec<Vec<Point>>> {
    /// The flag of a path that is a single polyline.
    const POLYLINE: u32 = 2;
    let flags = groups.number(92)? as u32;
    if flags & POLYLINE != 0 {
        let has_bulges = groups.number(72)? > 0.5;
        let n = groups.count(93)?;
        let vertex = |_| {
            let at = groups.point(10)?;
            let bulge = if has_bulges { groups.next_number(42).unwrap_or_default() } else { 0.0 };
            Some((at, bulge))
        };
        let vertices: Option<Vec<(Point, f64)>> = (0..n).map(vertex).collect();
        return Some(vec![chain(&vertices?, true)]);
    }
    let n = groups.count(93)?;
    let edges: Option<Vec<Vec<Point>>> = (0..n).map(|_| edge(groups)).collect();
    // An edge ends where the next begins; a whole circle closes on itself.
    Some(rings::closed(edges?.into_iter().map(|points| (points, false)).collect()).0)
}

fn edge(groups: &mut Groups<'_>) -> Option<Vec<Point>> {
    match groups.number(72)? as i32 {
        1 => Some(vec![groups.point(10)?, groups.point(11)?]),
        2 => {
            let (center, radius) = (groups.point(10)?, groups.number(40)?);
            let [from, to] = [groups.number(50)?, groups.number(51)?];
            let is_left = groups.number(73)? > 0.5;
            Some(arc(center, radius, if is_left { [from, to] } else { [-to, -from] }))
        }
        3 => {
            let (center, long) = (groups.point(10)?, groups.point(11)?);
            let (share, from, to) = (groups.number(40)?, groups.number(50)?, groups.number(51)?);
            let is_left = groups.number(73)? > 0.5;
            let ends = if is_left { [from, to] } else { [-to, -from] }.map(f64::to_radians);
            let (mut points, is_closed) = ellipse(center, long.coords, share, ends);
            points.extend(points.last().copied().filter(|_| is_closed));
            points.rotate_right(usize::from(is_closed));
            Some(points)
        }
        4 => {
            let degree = groups.number(94)?.max(0.0) as usize;
            let (is_rational, n_knots, n) = (groups.number(73)? > 0.5, groups.count(95)?, groups.count(96)?);
            let knots: Option<Vec<f64>> = (0..n_knots).map(|_| groups.number(40)).collect();
            let (mut controls, mut weights) = (Vec::new(), Vec::new());
            for _ in 0..n {
                controls.push(groups.point(10)?);
                weights.extend(groups.next_number(42).filter(|_| is_rational));
            }
            spline(&Spline { degree, knots: knots?, controls, weights })
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn groups(text: &str) -> Vec<(i32, String)> {
        let pair = |pair: &str| {
            pair.trim().split_once(' ').map(|(code, value)| (code.parse().unwrap(), value.into()))
        };
        text.split(',').filter_map(pair).collect()
    }

    #[test]
    fn polylines_and_edges_of_every_kind_close_areas() {
        let square = "92 7,72 0,73 1,93 4,10 0,20 0,10 2,20 0,10 2,20 2,10 0,20 2,97 0,";
        let round = "92 7,72 1,73 1,93 2,10 5,20 0,42 1,10 7,20 0,42 1,97 0,";
        let half_moon = "92 1,93 2,72 2,10 0,20 9,40 1,50 0,51 180,73 1,72 1,10 -1,20 9,11 1,21 9,97 0,";
        let circle = "92 1,93 1,72 2,10 0,20 0,40 3,50 0,51 360,73 1,97 0,";
        let oval = "92 1,93 1,72 3,10 0,20 0,11 2,21 0,40 0.5,50 0,51 360,73 1,97 0";
        let text = format!("10 0,20 0,30 0,2 SOLID,70 1,91 5,{square}{round}{half_moon}{circle}{oval}");
        let areas: Vec<f64> =
            rings(&groups(&text)).iter().map(|ring| world::shape::ring_area_m2(ring).abs()).collect();
        let pi = std::f64::consts::PI;
        for (area, true_area) in areas.iter().zip([4.0, pi, pi / 2.0, 9.0 * pi, 2.0 * pi]) {
            assert!((area - true_area).abs() < 2e-3 * true_area, "{areas:?}");
        }
        assert_eq!(areas.len(), 5);
    }

    #[test]
    fn counts_beyond_what_is_there_end_the_reading() {
        assert!(rings(&groups("91 999999999,92 2,72 0,93 999999999,10 0,20 0")).is_empty());
        assert!(rings(&groups("91 -3")).is_empty());
    }
}
