//! Closed outlines: the shell, and objects on the floor.

use super::{entities::Outline, rings};
use crate::plan::{MOST_CORNERS, round};
use std::f64::consts::{PI, TAU};
use world::{
    Boundary, Point, Shape, Vector,
    shape::{convex_hull, ring_area_m2},
};

/// The largest distance in metres between the two sides of a shell, if both are drawn.
const PLATE_M: f64 = 0.25;
/// Tolerances in metres for the floor that may be lost when corners of the shell are removed; tried in this order.
const TOLERANCES_M: [f64; 4] = [1e-3, 2e-3, 5e-3, 1e-2];
/// Difference, in metres, below which two discs count as one disc drawn twice; applies to positions and radii.
const TWICE_M: f64 = 5e-3;
/// Radius, in metres, below which an outline encloses nothing.
const SMALLEST_M: f64 = 1e-3;
/// The number of corners of the polygon that replaces the round tip of a wide line.
const N_TIP: usize = 16;

/// A closed outline.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Area {
    /// The corners; empty for a circle.
    points: Vec<Point>,
    /// The centre, and the smallest and largest radius, if the outline is round.
    round: Option<(Point, f64, f64)>,
    /// Half the width of the line in metres.
    half_width_m: f64,
}

/// Finds the closed outlines; also returns the lines that do not close an outline.
pub(super) fn areas(outlines: impl Iterator<Item = Outline>) -> (Vec<Area>, Vec<Vec<Point>>) {
    let (mut areas, mut chains) = (Vec::new(), Vec::new());
    for outline in outlines {
        match outline {
            Outline::Circle { center, radius_m } => {
                let round = Some((center, radius_m, radius_m));
                areas.push(Area { points: Vec::new(), round, half_width_m: 0.0 });
            }
            Outline::Chain { points, is_closed: true, width_m } if width_m > 0.0 => {
                areas.push(Area::new(points, width_m / 2.0));
            }
            Outline::Chain { points, is_closed, .. } => chains.push((points, is_closed)),
        }
    }
    let (rings, open) = rings::closed(chains);
    areas.extend(rings.into_iter().map(|ring| Area::new(ring, 0.0)));
    // Remove outlines that enclose nothing.
    areas.retain(|area| area.size_m() + area.half_width_m > SMALLEST_M);
    (areas, open)
}

impl Area {
    fn new(points: Vec<Point>, half_width_m: f64) -> Self {
        Self { round: round(&points), points, half_width_m }
    }

    /// The corners; empty for a circle.
    pub(super) fn corners(&self) -> &[Point] {
        &self.points
    }

    /// The larger extent in metres.
    pub(super) fn across_m(&self) -> f64 {
        let of_corners = || {
            let (low, high) = world::shape::bounds_of(&self.points);
            (high - low).amax()
        };
        self.round.map_or_else(of_corners, |(_, _, largest_m)| 2.0 * largest_m)
    }

    /// The radius in metres of a circle with the same area as the inner side.
    fn size_m(&self) -> f64 {
        let middle_m = self
            .round
            .map_or_else(|| (ring_area_m2(&self.points).abs() / PI).sqrt(), |(_, least_m, _)| least_m);
        middle_m - self.half_width_m
    }

    /// The convex shape of the area, and whether it is larger than the area.
    pub(super) fn convex(&self) -> (Shape, bool) {
        if let Some((center, _, largest_m)) = self.round {
            return (Shape::Disc { center, radius_m: largest_m + self.half_width_m }, false);
        }
        let tip = |k: usize| {
            let angle = TAU * k as f64 / N_TIP as f64;
            Vector::new(angle.cos(), angle.sin()) * (self.half_width_m / (PI / N_TIP as f64).cos())
        };
        let n_tip = if self.half_width_m > 0.0 { N_TIP } else { 1 };
        let wide: Vec<Point> =
            self.points.iter().flat_map(|at| (0..n_tip).map(move |k| at + tip(k))).collect();
        let vertices = of_few_corners(convex_hull(&wide));
        let plain_m2 = ring_area_m2(&convex_hull(&self.points));
        let grew = plain_m2 > ring_area_m2(&self.points).abs() * (1.0 + 1e-6);
        (Shape::Polygon { vertices }, grew)
    }
}

/// A convex polygon that contains the given one but has fewer corners. Its sides touch the given polygon in evenly
/// spread directions.
fn of_few_corners(ring: Vec<Point>) -> Vec<Point> {
    const N_SIDES: usize = 96;
    if ring.len() <= MOST_CORNERS {
        return ring;
    }
    let toward = |k: usize| {
        let angle = TAU * k as f64 / N_SIDES as f64;
        Vector::new(angle.cos(), angle.sin())
    };
    let reach = |way: &Vector| ring.iter().map(|at| at.coords.dot(way)).fold(f64::NEG_INFINITY, f64::max);
    let corner = |k: usize| {
        let (a, b) = (toward(k), toward(k + 1));
        let (p, q) = (reach(&a), reach(&b));
        Point::new(p * b.y - q * a.y, q * a.x - p * b.x) / a.perp(&b)
    };
    convex_hull(&(0..N_SIDES).map(corner).collect::<Vec<_>>())
}

/// The convex shapes of all areas without duplicates, and the numbers, counted from 1, of those that were not convex.
pub(super) fn shapes(areas: &[Area]) -> (Vec<Shape>, Vec<usize>) {
    let (mut shapes, mut grown): (Vec<Shape>, Vec<usize>) = (Vec::new(), Vec::new());
    for area in areas {
        let (shape, grew) = area.convex();
        if !shapes.iter().any(|known| is_twice(known, &shape)) {
            shapes.push(shape);
            grown.extend(grew.then_some(shapes.len()));
        }
    }
    (shapes, grown)
}

/// Whether two shapes are the same object drawn twice, for example a column and its hatching.
fn is_twice(one: &Shape, other: &Shape) -> bool {
    match (one, other) {
        (Shape::Disc { center: a, radius_m: r }, Shape::Disc { center: b, radius_m: s }) => {
            (a - b).norm() < TWICE_M && (r - s).abs() < TWICE_M
        }
        _ => one == other,
    }
}

/// Finds the shell: the largest area, or the inner side if both sides are drawn. Also returns the remaining areas.
pub(super) fn shell(mut areas: Vec<Area>, notes: &mut Vec<String>) -> Option<(Area, Vec<Area>)> {
    areas.sort_by(|a, b| b.size_m().total_cmp(&a.size_m()));
    let largest_m = areas.first()?.size_m();
    let n_sides = areas.iter().take_while(|area| largest_m - area.size_m() <= PLATE_M).count();
    let rest = areas.split_off(n_sides);
    if n_sides > 1 {
        notes.push(format!(
            "SHELL: {n_sides} outlines within {PLATE_M} m of each other; the innermost was taken as the shell"
        ));
    }
    Some((areas.pop()?, rest))
}

/// The floor inside the shell, and the shell's centre if it is round. If there are more than [`MOST_CORNERS`] corners,
/// some are removed if this loses hardly any floor. The scenario reader refuses a shell that still has too many.
pub(super) fn boundary(shell: &Area, notes: &mut Vec<String>) -> (Boundary, Option<Point>) {
    if let Some((center, least_m, _)) = shell.round {
        return (Boundary::Circle { radius_m: least_m - shell.half_width_m }, Some(center));
    }
    if shell.half_width_m > 0.0 {
        let width_m = 2.0 * shell.half_width_m;
        notes.push(format!(
            "SHELL: the line is {width_m:.3} m wide; the floor was taken to extend to the middle of the line"
        ));
    }
    let mut ring = shell.points.clone();
    if ring_area_m2(&ring) < 0.0 {
        ring.reverse();
    }
    let n = ring.len();
    if n <= MOST_CORNERS {
        return (Boundary::Polygon { vertices: ring }, None);
    }
    let fits = |vertices: &[Point]| vertices.len() <= MOST_CORNERS;
    let spared = TOLERANCES_M.map(|tolerance_m| (thinned(&ring, tolerance_m), tolerance_m));
    let least = spared.iter().find(|(vertices, _)| fits(vertices)).unwrap_or(&spared[spared.len() - 1]);
    let (vertices, lost_m) = least.clone();
    notes.push(format!(
        "SHELL: {n} corners were reduced to {}; this loses at most {lost_m} m of floor along the shell",
        vertices.len()
    ));
    (Boundary::Polygon { vertices }, None)
}

/// Removes corners of a counter-clockwise ring if the chord that replaces them stays on the floor and within a
/// tolerance.
fn thinned(ring: &[Point], tolerance_m: f64) -> Vec<Point> {
    /// The largest number of corners that one chord may replace.
    const LONGEST: usize = 1000;
    let n = ring.len();
    let mut kept = Vec::new();
    let mut at = 0;
    while at < n {
        kept.push(ring[at]);
        let is_spared = |to: usize| {
            let (from, end) = (ring[at], ring[to % n]);
            let way = (end - from).normalize();
            ring[at + 1..to].iter().all(|corner| {
                let off_m = way.perp(&(corner - from));
                (-tolerance_m..=1e-9).contains(&off_m) && way.dot(&(corner - from)) >= 0.0
            })
        };
        let last = (at + LONGEST).min(n);
        at = (at + 2..=last).take_while(|to| is_spared(*to)).last().unwrap_or(at + 1);
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    fn oval(n: usize) -> Vec<Point> {
        let at = |k: usize| TAU * k as f64 / n as f64;
        (0..n).map(|k| Point::new(12.0 * at(k).cos(), 8.0 * at(k).sin())).collect()
    }

    fn circle(radius_m: f64) -> Outline {
        Outline::Circle { center: Point::new(1.0, 2.0), radius_m }
    }

    #[test]
    fn a_shell_of_many_corners_keeps_some_and_gains_no_floor() {
        let mut notes = Vec::new();
        let (floor, center) = boundary(&Area::new(oval(5000), 0.0), &mut notes);
        let Boundary::Polygon { vertices } = &floor else { panic!("{floor:?}") };
        assert!(vertices.len() <= MOST_CORNERS && center.is_none(), "{}", vertices.len());
        let lost_m2 = 96.0 * PI - floor.area_m2();
        assert!((0.0..0.6).contains(&lost_m2), "{lost_m2}");
        assert!(notes[0].starts_with("SHELL: 5000 corners were reduced to "), "{notes:?}");
    }

    #[test]
    fn of_both_sides_of_a_shell_the_inner_one_counts() {
        let mut notes = Vec::new();
        let (all, _) = areas([circle(0.3), circle(10.02), circle(10.0)].into_iter());
        let (shell, rest) = shell(all, &mut notes).unwrap();
        assert_eq!(boundary(&shell, &mut notes).0, Boundary::Circle { radius_m: 10.0 });
        assert_eq!((rest.len(), notes.len()), (1, 1));
    }

    #[test]
    fn the_width_of_a_line_belongs_to_the_column_and_not_to_the_floor() {
        let chain = |points: Vec<Point>| Outline::Chain { points, is_closed: true, width_m: 0.2 };
        let round: Vec<Point> =
            (0..64).map(|k| TAU * f64::from(k) / 64.0).map(|at| Point::new(at.cos(), at.sin())).collect();
        let square = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(x, y)| Point::new(x, y)).to_vec();
        let (all, open) = areas([chain(round), chain(square)].into_iter());
        assert!(open.is_empty());
        let Boundary::Circle { radius_m } = boundary(&all[0], &mut Vec::new()).0 else { panic!() };
        assert!((radius_m - 0.9).abs() < 1e-9);
        let (shapes, grown) = shapes(&all);
        assert!(grown.is_empty());
        let Shape::Disc { radius_m, .. } = shapes[0] else { panic!("{shapes:?}") };
        assert!((radius_m - 1.1).abs() < 1e-9);
        let (low, high) = shapes[1].bounds();
        assert!(low.x <= -0.1 && high.y >= 1.1 && high.x < 1.105, "{low} {high}");
    }

    #[test]
    fn a_column_of_many_corners_gets_fewer_around_it() {
        let (shape, grew) = Area::new(oval(3000), 0.0).convex();
        let Shape::Polygon { vertices } = &shape else { panic!("{shape:?}") };
        assert!(!grew && vertices.len() <= MOST_CORNERS, "{}", vertices.len());
        assert!(oval(3000).iter().all(|at| shape.distance_m(*at) < 1e-9));
        assert!(ring_area_m2(vertices) < 96.0 * PI * 1.002);
        let line = Outline::Chain {
            points: [0.0, 1.0, 2.0].map(|x| Point::new(x, x)).to_vec(),
            is_closed: true,
            width_m: 0.0,
        };
        assert_eq!(areas([line].into_iter()).0.len(), 0, "it encloses nothing");
    }

    #[test]
    fn a_column_and_its_hatching_are_one() {
        let (all, _) = areas([circle(0.4), circle(0.401), circle(0.3)].into_iter());
        assert_eq!(shapes(&all).0.len(), 2);
    }
}
